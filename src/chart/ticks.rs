//! Ticks at round numbers: 1, 2 or 5 times a power of ten (Heckbert, 'Nice numbers for graph labels', Graphics Gems, 1990).

use super::Scale;

/// A tick of an axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Tick {
    pub at: f64,
    /// Its number or name; empty for a line without one.
    pub text: String,
}

/// About `most` ticks or fewer for an axis from `from` to `to`.
pub fn ticks(scale: &Scale, from: f64, to: f64, most: usize) -> Vec<Tick> {
    match scale {
        Scale::Named(names) => {
            names.iter().enumerate().map(|(at, name)| Tick { at: at as f64, text: name.clone() }).collect()
        }
        Scale::Log => log(from, to, most),
        Scale::Linear => linear(from, to, most, 0.0).into_iter().map(|(at, text)| Tick { at, text }).collect(),
        Scale::Whole => linear(from, to, most, 1.0).into_iter().map(|(at, text)| Tick { at, text }).collect(),
        Scale::Share => {
            let percents = linear(100.0 * from, 100.0 * to, most, 0.0);
            percents.into_iter().map(|(at, text)| Tick { at: at / 100.0, text: format!("{text} %") }).collect()
        }
    }
}

/// The smallest round step that makes at most `most` steps, at least `least`.
fn step(from: f64, to: f64, most: usize, least: f64) -> f64 {
    let rough = ((to - from) / most.max(1) as f64).max(least);
    if !(rough.is_finite() && rough > 0.0) {
        return 1.0;
    }
    let power = 10f64.powi(rough.log10().floor() as i32);
    let round = [1.0, 2.0, 5.0, 10.0].into_iter().find(|round| round * power >= rough * (1.0 - 1e-9));
    round.unwrap_or(10.0) * power
}

fn linear(from: f64, to: f64, most: usize, least: f64) -> Vec<(f64, String)> {
    if !(from.is_finite() && to.is_finite() && from < to) {
        return vec![(from, number(from, 1.0))];
    }
    let step = step(from, to, most, least);
    let (first, last) = ((from / step - 1e-9).ceil() as i64, (to / step + 1e-9).floor() as i64);
    (first..=last).map(|index| index as f64 * step).map(|at| (at, number(at, step))).collect()
}

/// A number with as many decimals as a step needs.
fn number(at: f64, step: f64) -> String {
    let decimals = (-step.log10().floor()).clamp(0.0, 9.0) as usize;
    let text = format!("{at:.decimals$}");
    if text.trim_start_matches('-').chars().all(|c| c == '0' || c == '.') { "0".to_owned() } else { text }
}

fn log(from: f64, to: f64, most: usize) -> Vec<Tick> {
    if !(from > 0.0 && to.is_finite() && from < to) {
        return vec![Tick { at: from, text: number(from, 1.0) }];
    }
    let decades = from.log10().floor() as i32..=to.log10().ceil() as i32;
    let at = |rounds: &[f64]| -> Vec<f64> {
        let of_decade = |decade: i32| rounds.iter().map(move |round| round * 10f64.powi(decade)).collect::<Vec<_>>();
        decades
            .clone()
            .flat_map(of_decade)
            .filter(|at| (from * (1.0 - 1e-9)..=to * (1.0 + 1e-9)).contains(at))
            .collect()
    };
    let choices = [at(&[1.0, 2.0, 5.0]), at(&[1.0, 3.0]), at(&[1.0])];
    let chosen = choices.iter().find(|choice| choice.len() <= most.max(2)).unwrap_or(&choices[2]);
    chosen.iter().map(|&at| Tick { at, text: number(at, 10f64.powf(at.log10().floor())) }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(scale: &Scale, from: f64, to: f64, most: usize) -> String {
        ticks(scale, from, to, most).into_iter().map(|tick| tick.text).collect::<Vec<_>>().join(" ")
    }

    #[test]
    fn ticks_are_round_numbers() {
        assert_eq!(texts(&Scale::Linear, 0.0, 100.0, 5), "0 20 40 60 80 100");
        assert_eq!(texts(&Scale::Linear, -0.3, 0.31, 4), "-0.2 0 0.2");
        assert_eq!(texts(&Scale::Share, 0.5, 1.0, 5), "50 % 60 % 70 % 80 % 90 % 100 %");
        assert_eq!(texts(&Scale::Whole, 0.0, 3.0, 12), "0 1 2 3");
        assert_eq!(texts(&Scale::Log, 0.8, 300.0, 9), "1 2 5 10 20 50 100 200");
        assert_eq!(texts(&Scale::Log, 0.8, 30_000.0, 6), "1 10 100 1000 10000");
    }

    #[test]
    fn axes_that_make_no_sense_have_a_tick_all_the_same() {
        for (from, to) in [(0.0, 0.0), (f64::NAN, 1.0), (2.0, 1.0), (0.0, f64::INFINITY), (-1.0, 5.0)] {
            for scale in [Scale::Linear, Scale::Share, Scale::Whole, Scale::Log] {
                assert!(ticks(&scale, from, to, 5).len() < 20, "{from} to {to}");
            }
        }
    }

    proptest::proptest! {
        #[test]
        fn ticks_lie_on_the_axis_and_are_few(from in -1e6..1e6f64, length in 1e-3..1e6f64, most in 2..12usize) {
            let to = from + length;
            let ticks = ticks(&Scale::Linear, from, to, most);
            proptest::prop_assert!(ticks.len() <= most + 1);
            for tick in ticks {
                proptest::prop_assert!(tick.at >= from - length * 1e-6 && tick.at <= to + length * 1e-6);
            }
        }
    }
}
