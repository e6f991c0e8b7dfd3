//! Lengths, sizes and angles typed while drawing.

use egui::Key;

use crate::base::units::{Units, parse_angle_rad};

/// What can be typed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Typing {
    /// A length, or a length and an angle: '3.2', '3.2<45'.
    Length,
    /// Two sides: '4x3'.
    Size,
    /// A width.
    Width,
}

/// Typed text, parsed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Typed {
    /// In metres; with an angle in radians, counter-clockwise from the last line.
    Length { length_m: f64, angle_rad: Option<f64> },
    /// Both in metres.
    Size { width_m: f64, height_m: f64 },
}

/// Whether a text goes on with what was typed.
pub(super) fn is_part(typed: &str, text: &str) -> bool {
    let is_first = typed.is_empty();
    !text.is_empty()
        && text.chars().all(|c| {
            c.is_ascii_digit()
                || matches!(c, '.' | ',')
                || (!is_first && matches!(c, '\'' | '"' | '<' | 'x' | '*' | ' ' | '/' | '+' | '-' | '°'))
                || (!is_first && "mcftin".contains(c))
        })
}

/// Whether a key writes such a text.
pub(super) fn is_key(typed: &str, key: Key) -> bool {
    let is_digit = (Key::Num0..=Key::Num9).contains(&key) || matches!(key, Key::Period | Key::Comma);
    is_digit
        || (!typed.is_empty()
            && matches!(
                key,
                Key::Quote
                    | Key::Minus
                    | Key::Plus
                    | Key::Slash
                    | Key::Space
                    | Key::X
                    | Key::M
                    | Key::C
                    | Key::F
                    | Key::T
                    | Key::I
                    | Key::N
            ))
}

/// Reads what was typed; `None` where it means nothing.
pub(super) fn read(typing: Typing, typed: &str, units: Units) -> Option<Typed> {
    let length_m = |text: &str| units.parse_length(text).ok().filter(|length_m| *length_m > 0.0);
    match typing {
        Typing::Length => {
            let (length, angle) = match typed.split_once('<') {
                Some((length, angle)) => (length, Some(angle)),
                None => (typed, None),
            };
            let length_m = length_m(length)?;
            let angle_rad = match angle {
                None => None,
                Some(text) => Some(parse_angle_rad(text).ok()?),
            };
            Some(Typed::Length { length_m, angle_rad })
        }
        Typing::Width => Some(Typed::Length { length_m: length_m(typed)?, angle_rad: None }),
        Typing::Size => {
            let (width, height) = typed.split_once(['x', '*'])?;
            Some(Typed::Size { width_m: length_m(width)?, height_m: length_m(height)? })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_angles_and_sizes() {
        let length = |text: &str| read(Typing::Length, text, Units::Metric);
        assert_eq!(length("3.2"), Some(Typed::Length { length_m: 3.2, angle_rad: None }));
        assert_eq!(
            length("3,2<90"),
            Some(Typed::Length { length_m: 3.2, angle_rad: Some(std::f64::consts::FRAC_PI_2) })
        );
        assert_eq!(read(Typing::Size, "4x3", Units::Metric), Some(Typed::Size { width_m: 4.0, height_m: 3.0 }));
        for wrong in ["", "<", "x", "3<", "-2", "0", "1e999"] {
            assert_eq!(length(wrong), None, "{wrong}");
        }
        assert_eq!(read(Typing::Size, "4", Units::Metric), None);
    }

    #[test]
    fn letters_start_nothing() {
        assert!(!is_part("", "m") && is_part("3", "m") && is_part("", "3") && !is_part("3", "q"));
    }
}
