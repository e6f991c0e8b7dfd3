//! Lengths, sizes and angles typed while drawing.

use egui::Key;

use crate::base::units::{Units, angle, parse_angle_rad, parse_ratio};
use crate::geometry::{Vector, trim_m};

/// What can be typed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Typing {
    /// A length, one at an angle, or one after a turn: '3.2', '3.2<45', '3.2<<30'.
    Length,
    /// Two sides: '4x3'.
    Size,
    /// A width.
    Width,
    /// An angle: '45', counter-clockwise.
    Angle,
    /// A factor: '1.5', '150 %'.
    Factor,
    /// Columns and rows, and how far apart they are: '4x2', '4x2 3.5,4'.
    Grid,
    /// How many around a point, and the angle from one to the next: '6', '6<30'.
    Polar,
}

/// Typed text, parsed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Typed {
    /// In metres; without a direction, it goes towards the pointer.
    Length {
        length_m: f64,
        towards: Option<Towards>,
    },
    /// Both in metres.
    Size {
        width_m: f64,
        height_m: f64,
    },
    /// In radians, counter-clockwise.
    Angle {
        angle_rad: f64,
    },
    Factor(f64),
    /// The step in metres: across from column to column, up from row to row.
    Grid {
        columns: usize,
        rows: usize,
        step: Option<Vector>,
    },
    /// The angle in radians from one to the next.
    Polar {
        count: usize,
        angle_rad: Option<f64>,
    },
}

/// A typed direction, in radians counter-clockwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Towards {
    /// From the right, as everybody's angles.
    Angle(f64),
    /// From the last line on: a turn to the left, or to the right where it is negative.
    Turn(f64),
}

/// Whether a text begins a length where nothing is drawn or typed yet: letters are shortcuts there.
pub(super) fn begins(text: &str) -> bool {
    text.starts_with(|c: char| c.is_numeric() || matches!(c, '.' | ',' | '('))
}

/// Whether a key may write such a text.
pub(super) fn begins_by(key: Key) -> bool {
    (Key::Num0..=Key::Num9).contains(&key) || matches!(key, Key::Period | Key::Comma)
}

/// Whether a key writes a letter, a figure or a sign: its text is taken, and a shortcut it is not.
pub(super) fn writes(key: Key) -> bool {
    matches!(key, Key::Space | Key::Quote) || (key.symbol_or_name().chars().count() == 1 && !is_arrow(key))
}

/// Whether a key writes a letter or a figure.
pub(super) fn writes_letter(key: Key) -> bool {
    let mut letters = key.symbol_or_name().chars();
    letters.next().is_some_and(char::is_alphanumeric) && letters.next().is_none()
}

fn is_arrow(key: Key) -> bool {
    matches!(key, Key::ArrowDown | Key::ArrowLeft | Key::ArrowRight | Key::ArrowUp)
}

/// A side of a rectangle is at least so long, in metres: shorter ones are a slip of the hand, half of the smallest
/// shaft.
pub(super) const LEAST_SIDE_M: f64 = 0.1;

/// Reads what was typed.
///
/// # Errors
/// What is not understood, and what would be.
pub(super) fn read(typing: Typing, typed: &str, units: Units) -> Result<Typed, String> {
    let length_m = |text: &str| {
        let length_m = units.parse_length(text).map_err(|error| error.to_string())?;
        if trim_m(length_m) > 0.0 { Ok(length_m) } else { Err("a length is at least 0.1 mm".to_owned()) }
    };
    match typing {
        Typing::Length => {
            type Direction = fn(f64) -> Towards;
            let turn = typed.split_once("<<").map(|(length, turn)| (length, turn, Towards::Turn as Direction));
            let angle =
                || typed.split_once(['<', '∠']).map(|(length, angle)| (length, angle, Towards::Angle as Direction));
            let Some((length, angle, direction)) = turn.or_else(angle) else {
                return Ok(Typed::Length { length_m: length_m(typed)?, towards: None });
            };
            let length_m = length_m(length)?;
            let angle_rad = parse_angle_rad(angle).map_err(|error| error.to_string())?;
            Ok(Typed::Length { length_m, towards: Some(direction(angle_rad)) })
        }
        Typing::Width => Ok(Typed::Length { length_m: length_m(typed)?, towards: None }),
        Typing::Angle => {
            let angle_rad = parse_angle_rad(typed.trim_start_matches(['<', '∠'])).map_err(|error| error.to_string())?;
            Ok(Typed::Angle { angle_rad })
        }
        Typing::Factor => {
            let factor = parse_ratio(typed).map_err(|error| error.to_string())?;
            if (0.001..=1000.0).contains(&factor) {
                Ok(Typed::Factor(factor))
            } else {
                Err("a factor is from 0.001 to 1000".to_owned())
            }
        }
        Typing::Grid => read_grid(typed, units),
        Typing::Polar => {
            let (count, angle) = match typed.split_once(['<', '∠']) {
                Some((count, angle)) => (count, Some(angle)),
                None => (typed, None),
            };
            let count = whole(count).filter(|count| *count > 1).ok_or("type a whole number from 2 up")?;
            let angle_rad = angle.map(parse_angle_rad).transpose().map_err(|error| error.to_string())?;
            Ok(Typed::Polar { count, angle_rad })
        }
        Typing::Size => {
            let Some((width, height)) = sides(typed) else {
                return Err("type both sides with an x between them, such as 4x3".to_owned());
            };
            let (width_m, height_m) = (length_m(width)?, length_m(height)?);
            if width_m.min(height_m) < LEAST_SIDE_M {
                return Err(format!("a side is at least {}", units.length(LEAST_SIDE_M)));
            }
            Ok(Typed::Size { width_m, height_m })
        }
    }
}

/// Columns and rows, perhaps with their steps behind a blank: '4x2 3.5,4'.
fn read_grid(typed: &str, units: Units) -> Result<Typed, String> {
    const WRONG: &str = "type columns and rows as whole numbers with an x between, such as 4x2";
    let typed = typed.trim();
    let (counts, steps) = match typed.split_once(char::is_whitespace) {
        Some((counts, steps)) => (counts, Some(steps.trim())),
        None => (typed, None),
    };
    let (columns, rows) = sides(counts).unwrap_or((counts, "1"));
    let (columns, rows) = (whole(columns).ok_or(WRONG)?, whole(rows).ok_or(WRONG)?);
    if columns.saturating_mul(rows) < 2 {
        return Err(WRONG.to_owned());
    }
    let way = |text: &str| match text.trim() {
        "" | "0" => Ok(0.0),
        text => match text.strip_prefix('-') {
            Some(text) => units.parse_length(text).map(|length_m| -length_m),
            None => units.parse_length(text),
        },
    };
    let step = match steps {
        None => None,
        Some(steps) => {
            let (across, up) = steps.split_once([',', ';']).unwrap_or((steps, if rows > 1 { steps } else { "0" }));
            let read = |text| way(text).map_err(|error| error.to_string());
            Some(Vector::new(read(across)?, read(up)?))
        }
    };
    Ok(Typed::Grid { columns, rows, step })
}

fn whole(text: &str) -> Option<usize> {
    text.trim().parse().ok().filter(|number| (1..=1000).contains(number))
}

/// The two sides: what stands before and behind an x, or a star where there is no x.
fn sides(typed: &str) -> Option<(&str, &str)> {
    const TIMES: [char; 3] = ['x', 'X', '×'];
    let sides = typed.split_once(TIMES).or_else(|| typed.split_once('*'));
    sides.filter(|(_, height)| !height.contains(TIMES))
}

/// Whether the second side can still be begun: Tab goes on to it.
pub(super) fn needs_other_side(typing: Typing, typed: &str) -> bool {
    typing == Typing::Size && sides(typed).is_none()
}

/// What is understood so far, as lengths are shown; empty where that is nothing yet.
pub(super) fn understood(typing: Typing, typed: &str, units: Units) -> String {
    match read(typing, typed, units) {
        Ok(Typed::Length { length_m, towards }) => {
            let length = units.length(length_m);
            match towards {
                None => length,
                Some(Towards::Angle(angle_rad)) => format!("{length} at {}", angle(angle_rad)),
                Some(Towards::Turn(turn_rad)) => {
                    let side = if turn_rad < 0.0 { "right" } else { "left" };
                    format!("{length} after a turn of {} {side}", angle(turn_rad.abs()))
                }
            }
        }
        Ok(Typed::Size { width_m, height_m }) => format!("{} x {}", units.length(width_m), units.length(height_m)),
        Ok(Typed::Angle { angle_rad }) => crate::base::units::angle(angle_rad),
        Ok(Typed::Factor(factor)) => format!("x {factor}"),
        Ok(Typed::Grid { columns, rows, step: None }) => format!("{columns} x {rows}"),
        Ok(Typed::Grid { columns, rows, step: Some(step) }) => {
            let [across, up] = [step.x, step.y].map(|way_m| {
                let sign = if way_m < 0.0 { "-" } else { "" };
                format!("{sign}{}", units.length(way_m.abs()))
            });
            format!("{columns} x {rows}, every {across} and {up}")
        }
        Ok(Typed::Polar { count, angle_rad: None }) => format!("{count} all around"),
        Ok(Typed::Polar { count, angle_rad: Some(angle_rad) }) => {
            format!("{count}, {} apart", crate::base::units::angle(angle_rad))
        }
        Err(_) => String::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_angles_and_sizes() {
        let length = |text: &str| read(Typing::Length, text, Units::Metric).ok();
        assert_eq!(length("3.2"), Some(Typed::Length { length_m: 3.2, towards: None }));
        assert_eq!(
            length("3,2<90"),
            Some(Typed::Length { length_m: 3.2, towards: Some(Towards::Angle(std::f64::consts::FRAC_PI_2)) })
        );
        assert_eq!(length("3.2 m < 22.5° * 4"), length("320 CM∠90"));
        assert_eq!(
            length("3<<-90"),
            Some(Typed::Length { length_m: 3.0, towards: Some(Towards::Turn(-std::f64::consts::FRAC_PI_2)) })
        );
        assert_eq!(understood(Typing::Length, "3<<-30", Units::Metric), "3.00 m after a turn of 30° right");
        for wrong in ["", "<", "3<<", "3<<1<2", "x", "3<", "-2", "0", "1e999", "4x3", "3<45<45", "0.00001"] {
            assert_eq!(length(wrong), None, "{wrong}");
        }
        let size = |text: &str| read(Typing::Size, text, Units::Metric);
        for text in ["4x3", "4 X 3", "4×3", "4*3", "400 cm x 3000 mm", "2*2x3", "4x(1+2)", "4 metres x 3 metres"] {
            assert_eq!(size(text), Ok(Typed::Size { width_m: 4.0, height_m: 3.0 }), "{text}");
        }
        for wrong in ["4", "4x", "x3", "4x3x2", "4x0.05", "-4x3", "4y3"] {
            assert!(size(wrong).is_err(), "{wrong}");
        }
        assert_eq!(understood(Typing::Length, "5'6-1/2\"<45", Units::Imperial), "5' 6 1/2\" at 45°");
        assert_eq!(understood(Typing::Size, "4x3", Units::Metric), "4.00 m x 3.00 m");
        assert_eq!(understood(Typing::Size, "4x", Units::Metric), "");
        assert_eq!(understood(Typing::Grid, "4x2 3.5,-4", Units::Metric), "4 x 2, every 3.50 m and -4.00 m");
        assert_eq!(understood(Typing::Grid, "3", Units::Metric), "3 x 1");
        assert_eq!(understood(Typing::Polar, "6<30", Units::Metric), "6, 30° apart");
        for wrong in ["1", "0x3", "x", "4x2 wide", "-3", "4x2x2"] {
            assert!(read(Typing::Grid, wrong, Units::Metric).is_err(), "{wrong}");
        }
        assert!(read(Typing::Polar, "1", Units::Metric).is_err() && read(Typing::Factor, "0", Units::Metric).is_err());
        assert_eq!(read(Typing::Factor, "150 %", Units::Metric), Ok(Typed::Factor(1.5)));
    }

    #[test]
    fn letters_begin_nothing() {
        assert!(
            !begins("m") && !begins("-") && !begins(" ") && begins("3") && begins(".5") && begins("½") && begins("(")
        );
        for key in Key::ALL {
            let is_name_of_one = key.symbol_or_name().chars().count() == 1;
            assert!(!writes(*key) || is_name_of_one || matches!(key, Key::Space | Key::Quote), "{key:?}");
        }
        for key in [Key::M, Key::Num3, Key::Comma, Key::Minus, Key::Plus, Key::Questionmark, Key::Quote, Key::Space] {
            assert!(writes(key), "{key:?}");
        }
        for key in
            [Key::Enter, Key::Tab, Key::Backspace, Key::Delete, Key::F2, Key::ArrowLeft, Key::Escape, Key::PageUp]
        {
            assert!(!writes(key) && !writes_letter(key), "{key:?}");
        }
        assert!(writes_letter(Key::M) && writes_letter(Key::Num3) && !writes_letter(Key::Minus));
    }
}
