//! Units for people: lengths and areas as they are shown and typed, metric or in feet and inches.
//!
//! Inside, everything is metres, square metres and radians. What is shown is rounded:
//!
//! | | metric | feet and inches |
//! | --- | --- | --- |
//! | length | `3.25 m`, to the centimetre | `10' 8 1/8"`, to the eighth of an inch |
//! | length in a field | `0.1155 m`, to the 0.1 mm of the model | `4.547"`, to the thousandth of an inch, which is finer |
//! | area | `42.1 m²`, to 0.1; from 1000 m² on to 1 | `453 sq ft`, to 1 |
//! | angle | `45.5°`, to 0.1 | the same |
//!
//! The nearest value of the last place is shown. What is shown can be typed: see [`Units::parse_length`].

#[cfg(test)]
mod spellings;
mod typed;

use std::fmt;

pub use crate::base::units::typed::{
    METRES_PER_FOOT, METRES_PER_INCH, NotUnderstood, parse_angle_deg, parse_angle_rad, parse_number, parse_percent,
    parse_ratio,
};

/// Eighths of an inch in a foot.
const EIGHTHS_PER_FOOT: u64 = 96;

/// The units lengths and areas are shown in, and the default for typed numbers without a unit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Units {
    /// Metres and square metres.
    #[default]
    Metric,
    /// Feet and inches, square feet.
    Imperial,
}

impl fmt::Display for Units {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl Units {
    pub const ALL: [Self; 2] = [Self::Metric, Self::Imperial];

    /// Its name in files and in the interface.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Metric => "metric",
            Self::Imperial => "imperial",
        }
    }

    /// The units with this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|units| units.name() == name)
    }

    /// The unit of rulers and of numbers typed without one: 'm' or 'ft'.
    pub const fn symbol(self) -> &'static str {
        match self {
            Self::Metric => "m",
            Self::Imperial => "ft",
        }
    }

    /// Metres in the default unit of typed numbers.
    const fn metres_per_unit(self) -> f64 {
        match self {
            Self::Metric => 1.0,
            Self::Imperial => METRES_PER_FOOT,
        }
    }

    /// A length: '3.25 m', `10' 8 1/2"`. To the centimetre, or the eighth of an inch.
    pub fn length(self, length_m: f64) -> String {
        if !length_m.is_finite() {
            return "–".to_owned();
        }
        match self {
            Self::Metric => format!("{} m", fixed(length_m, 2)),
            Self::Imperial => {
                let eighths = (length_m.abs() / METRES_PER_INCH * 8.0).round() as u64;
                let sign = if length_m < 0.0 && eighths > 0 { "-" } else { "" };
                let (feet, rest) = (eighths / EIGHTHS_PER_FOOT, eighths % EIGHTHS_PER_FOOT);
                let inches = inches_text(rest);
                if feet == 0 { format!("{sign}{inches}") } else { format!("{sign}{feet}' {inches}") }
            }
        }
    }

    /// A length as the figure of a dimension line: in metres without the unit, to the centimetre, or to the millimetre
    /// where there is one: '3.25', '3.115'; in feet and inches as anywhere.
    pub fn dimension(self, length_m: f64) -> String {
        match self {
            Self::Metric if length_m.is_finite() => {
                let to_the_centimetre = (length_m * 1000.0).round() % 10.0 == 0.0;
                fixed(length_m, if to_the_centimetre { 2 } else { 3 })
            }
            _ => self.length(length_m),
        }
    }

    /// A length for an editable field: parsed again, it gives the same length on the model's 0.1 mm grid.
    pub fn exact_length(self, length_m: f64) -> String {
        if !length_m.is_finite() {
            return "–".to_owned();
        }
        match self {
            Self::Metric => format!("{} m", trimmed(length_m, 4)),
            Self::Imperial => {
                let thousandths = (length_m.abs() / METRES_PER_INCH * 1000.0).round() as u64;
                let sign = if length_m < 0.0 && thousandths > 0 { "-" } else { "" };
                let (feet, rest) = (thousandths / 12_000, thousandths % 12_000);
                let inches = trimmed(rest as f64 / 1000.0, 3);
                if feet == 0 { format!("{sign}{inches}\"") } else { format!("{sign}{feet}' {inches}\"") }
            }
        }
    }

    /// An area: '42.1 m²', '453 sq ft'. One decimal in m², as on architects' plans, none from 1000 m² on.
    pub fn area(self, area_m2: f64) -> String {
        if !area_m2.is_finite() {
            return "–".to_owned();
        }
        match self {
            Self::Metric if area_m2 >= 999.95 => format!("{} m²", fixed(area_m2, 0)),
            Self::Metric => format!("{} m²", fixed(area_m2, 1)),
            Self::Imperial => format!("{} sq ft", fixed(area_m2 / (METRES_PER_FOOT * METRES_PER_FOOT), 0)),
        }
    }

    /// Parses a typed length, in metres. Accepts:
    ///
    /// - a number with a decimal point or comma, in metres or in feet as these units are: `3.25`, `3,25`
    /// - a number with its unit, whatever these units are: `325 cm`, `3250mm`, `3.25 metres`, `10'`, `10 FT`,
    ///   `8.5"`, `8 1/2 in`, `8-1/2"`, `8½"`
    /// - feet and inches: `10' 8"`, `10'8 1/2"`, `10 ft 8 in`, `10' 8`, and as architects write them `10'-8"`,
    ///   `5'6-1/2"`, `3'5/8`; with the marks of typewriters, word processors and books
    /// - sums with + - * / and parentheses: `3.2+0.4`, `10'/2`, `3*(60cm+12mm)`. Numbers without a unit are
    ///   lengths in the sum's end, factors in its products.
    ///
    /// A hyphen between feet and inches, or between inches and their fraction, joins them where no blank stands
    /// beside it; else it takes away. Behind feet, `5/8` are parts of an inch; elsewhere a slash without a unit behind
    /// the number divides.
    ///
    /// # Errors
    /// What is not understood, and what would be. Also for what is no length: `3m*2m`, `6m/2m`; and in feet for
    /// `6-1/2`, which can be read in two ways.
    pub fn parse_length(self, text: &str) -> Result<f64, NotUnderstood> {
        typed::length_m(text, self.metres_per_unit(), self == Self::Imperial)
    }

    /// The longest round length that is at most `most_m`: from the 1-2-5 series of metres, or of inches
    /// and feet.
    pub fn round_length_at_most(self, most_m: f64) -> f64 {
        let most_m = most_m.clamp(SHORTEST_ROUND_M, LONGEST_ROUND_M) * (1.0 + 1e-9);
        self.round_lengths(most_m).filter(|length| *length <= most_m).fold(0.0, f64::max)
    }

    /// The shortest round length that is at least `least_m`.
    pub fn round_length_at_least(self, least_m: f64) -> f64 {
        let least_m = least_m.clamp(SHORTEST_ROUND_M, LONGEST_ROUND_M) * (1.0 - 1e-9);
        self.round_lengths(least_m).filter(|length| *length >= least_m).fold(f64::INFINITY, f64::min)
    }

    /// The shortest round length of at least `least_m` that divides a round length evenly; the length
    /// itself if no shorter one does.
    pub fn division(self, length_m: f64, least_m: f64) -> f64 {
        let divides = |part: &f64| {
            let times = length_m / part;
            times > 1.5 && (times - times.round()).abs() < 1e-6
        };
        let parts = [length_m, length_m / 10.0, length_m / 100.0];
        let parts = parts.into_iter().flat_map(|about| self.round_lengths(about));
        parts.filter(divides).filter(|part| *part >= least_m * (1.0 - 1e-9)).fold(length_m, f64::min)
    }

    /// Round lengths around a length; some may repeat.
    fn round_lengths(self, about_m: f64) -> impl Iterator<Item = f64> {
        let unit_m = self.metres_per_unit();
        let decade = 10f64.powf((about_m / unit_m).log10().floor());
        let least_m = match self {
            Self::Metric => 0.0,
            // Below a foot, fractions of it.
            Self::Imperial => unit_m * (1.0 - 1e-9),
        };
        let series = [0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0]
            .map(move |step| rounded_binary(step * decade) * unit_m)
            .into_iter()
            .filter(move |length| *length >= least_m);
        let inches: &[f64] = match self {
            Self::Metric => &[],
            Self::Imperial => &[0.125, 0.25, 0.5, 1.0, 3.0, 6.0],
        };
        series.chain(inches.iter().map(|inches| inches * METRES_PER_INCH))
    }

    /// A round length: '5 m', '50 cm', '2 km', '10 ft', '6 in'.
    pub fn round_length(self, length_m: f64) -> String {
        match self {
            Self::Metric if length_m >= 1000.0 => format!("{} km", trimmed(length_m / 1000.0, 3)),
            Self::Metric if length_m >= 1.0 => format!("{} m", trimmed(length_m, 3)),
            Self::Metric if length_m >= 0.01 => format!("{} cm", trimmed(length_m * 100.0, 1)),
            Self::Metric => format!("{} mm", trimmed(length_m * 1000.0, 1)),
            Self::Imperial if length_m >= METRES_PER_FOOT * 0.999 => {
                format!("{} ft", trimmed(length_m / METRES_PER_FOOT, 2))
            }
            Self::Imperial => {
                let eighths = (length_m / METRES_PER_INCH * 8.0).round() as u64;
                format!("{} in", inches_text(eighths).trim_end_matches('"'))
            }
        }
    }

    /// A position on a ruler, without its unit: '2.5', `8' 6"`.
    pub fn tick(self, place_m: f64) -> String {
        match self {
            Self::Metric => trimmed(place_m, 4),
            Self::Imperial => {
                let text = self.length(place_m);
                if text == "0\"" { "0".to_owned() } else { text.strip_suffix(" 0\"").unwrap_or(&text).to_owned() }
            }
        }
    }
}

/// The shortest round length: about an eighth of an inch.
const SHORTEST_ROUND_M: f64 = 0.0032;

/// The longest round length: beyond any drawing area.
const LONGEST_ROUND_M: f64 = 1e7;

/// An angle: '45.5°', to a tenth of a degree; whole degrees have no decimal.
pub fn angle(angle_rad: f64) -> String {
    format!("{}°", trimmed(angle_rad.to_degrees(), 1))
}

/// A number with a fixed number of decimals, never '-0'.
fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(number) if number.bytes().all(|digit| matches!(digit, b'0' | b'.')) => number.to_owned(),
        _ => text,
    }
}

/// A number with at most this many decimals, trailing zeros removed.
fn trimmed(value: f64, decimals: usize) -> String {
    let text = fixed(value, decimals);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// Less than a foot, in eighths of an inch: `8 1/2"`.
fn inches_text(eighths: u64) -> String {
    let (whole, mut part, mut of) = (eighths / 8, eighths % 8, 8);
    while part > 0 && part.is_multiple_of(2) {
        (part, of) = (part / 2, of / 2);
    }
    match (whole, part) {
        (whole, 0) => format!("{whole}\""),
        (0, part) if eighths < 8 => format!("{part}/{of}\""),
        (whole, part) => format!("{whole} {part}/{of}\""),
    }
}

/// The float nearest to a decimal fraction: 0.1 * 10^-1 is not quite 0.01.
fn rounded_binary(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use crate::base::units::*;

    #[test]
    fn lengths_read_as_on_a_drawing() {
        for (length_m, metric, imperial) in [
            (3.25, "3.25 m", "10' 8\""),
            (3.2639, "3.26 m", "10' 8 1/2\""),
            (0.0, "0.00 m", "0\""),
            (-0.001, "0.00 m", "0\""),
            (-3.2639, "-3.26 m", "-10' 8 1/2\""),
            (0.115, "0.12 m", "4 1/2\""),
            (0.0127, "0.01 m", "1/2\""),
            (3.0607, "3.06 m", "10' 1/2\""),
            (METRES_PER_FOOT * 10.0, "3.05 m", "10' 0\""),
            (f64::NAN, "–", "–"),
        ] {
            assert_eq!(Units::Metric.length(length_m), metric);
            assert_eq!(Units::Imperial.length(length_m), imperial);
        }
        assert_eq!(Units::Metric.exact_length(0.1155), "0.1155 m");
        assert_eq!(Units::Metric.exact_length(3.0), "3 m");
        assert_eq!(Units::Imperial.exact_length(3.25), "10' 7.953\"");
        assert_eq!(Units::Imperial.exact_length(0.0254), "1\"");
    }

    #[test]
    fn areas_and_angles_read_well() {
        assert_eq!(Units::Metric.area(42.11), "42.1 m²");
        assert_eq!(Units::Metric.area(1234.6), "1235 m²");
        assert_eq!(Units::Imperial.area(42.11), "453 sq ft");
        assert_eq!(angle(std::f64::consts::FRAC_PI_4), "45°");
        assert_eq!(angle(0.7941), "45.5°");
        assert_eq!(angle(-1e-9), "0°");
    }

    #[test]
    fn scale_bars_and_rulers_have_round_steps() {
        for (most_m, metric, imperial) in [
            (7.0, "5 m", "20 ft"),
            (1.0, "1 m", "2 ft"),
            (0.6, "50 cm", "1 ft"),
            (0.25, "20 cm", "6 in"),
            (0.02, "2 cm", "1/2 in"),
            (0.004, "2 mm", "1/8 in"),
            (2500.0, "2 km", "5000 ft"),
        ] {
            assert_eq!(Units::Metric.round_length(Units::Metric.round_length_at_most(most_m)), metric);
            assert_eq!(Units::Imperial.round_length(Units::Imperial.round_length_at_most(most_m)), imperial);
        }
        assert_eq!(Units::Metric.round_length_at_least(0.21), 0.5);
        assert_eq!(Units::Metric.division(1.0, 0.09), 0.1);
        assert_eq!(Units::Metric.division(5.0, 0.3), 0.5);
        assert_eq!(Units::Metric.division(2.0, 0.3), 0.5);
        assert_eq!(Units::Metric.division(2.0, 1.5), 2.0);
        let foot = |feet: f64| feet * METRES_PER_FOOT;
        assert_eq!(Units::Imperial.division(foot(1.0), 0.05), 3.0 * METRES_PER_INCH);
        assert!((Units::Imperial.division(foot(5.0), 0.1) - foot(0.5)).abs() < 1e-9);
        assert_eq!(Units::Metric.tick(2.5), "2.5");
        assert_eq!(Units::Imperial.tick(foot(8.5)), "8' 6\"");
        assert_eq!(Units::Imperial.tick(foot(8.0)), "8'");
        assert_eq!(Units::Imperial.tick(0.0), "0");
    }

    proptest! {
        #[test]
        fn what_is_shown_can_be_typed(length_m in -2000.0..2000.0f64, exact in any::<bool>()) {
            for (units, half_m) in [(Units::Metric, 0.005), (Units::Imperial, METRES_PER_INCH / 16.0)] {
                let (text, half_m) = match (exact, units) {
                    (false, _) => (units.length(length_m), half_m),
                    (true, Units::Metric) => (units.exact_length(length_m), 0.000_05),
                    (true, Units::Imperial) => (units.exact_length(length_m), METRES_PER_INCH / 2000.0),
                };
                // Also where the default unit is the other one.
                for reader in Units::ALL {
                    let read = reader.parse_length(&text).unwrap();
                    prop_assert!((read - length_m).abs() <= half_m * (1.0 + 1e-9) + 1e-9, "{length_m} {text} {read}");
                }
            }
        }

        #[test]
        fn an_exact_length_typed_again_stays_on_the_grid(tenths_mm in -20_000_000i64..20_000_000) {
            let length_m = crate::geometry::trim_m(tenths_mm as f64 / 1e4);
            for units in Units::ALL {
                let read = units.parse_length(&units.exact_length(length_m)).unwrap();
                prop_assert_eq!(crate::geometry::trim_m(read), length_m);
            }
        }

        #[test]
        fn angles_can_be_typed(degrees in -720.0..720.0f64) {
            let read = parse_angle_rad(&angle(degrees.to_radians())).unwrap();
            prop_assert!((read.to_degrees() - degrees).abs() <= 0.05 + 1e-9);
        }

        #[test]
        fn anything_typed_is_a_finite_length_or_refused(text in ".{0,40}") {
            for units in Units::ALL {
                if let Ok(length_m) = units.parse_length(&text) {
                    prop_assert!(length_m.is_finite());
                }
            }
            prop_assert!(parse_angle_rad(&text).is_ok_and(f64::is_finite) || parse_angle_rad(&text).is_err());
        }

        #[test]
        fn sums_come_to_what_they_should(a in 0.1..50.0f64, b in 0.1..50.0f64, n in 1u32..9) {
            let (a, b) = (crate::geometry::trim_m(a), crate::geometry::trim_m(b));
            for (text, expected) in [
                (format!("{a} + {b}"), a + b),
                (format!("{a}m-{}cm", b * 100.0), a - b),
                (format!("{n}*({a} + {b}m)"), f64::from(n) * (a + b)),
                (format!("{a}/{n}"), a / f64::from(n)),
                (format!("-({a} - {b})*{n}"), -(a - b) * f64::from(n)),
            ] {
                let read = Units::Metric.parse_length(&text).unwrap();
                prop_assert!((read - expected).abs() < 1e-6, "{text} gave {read}, not {expected}");
            }
        }
    }
}
