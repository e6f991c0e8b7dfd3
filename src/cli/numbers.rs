//! Lengths, angles and shares as options take them: read as everywhere else, a number without a unit in metres. And
//! numbers as JSON prints them.

use crate::base::units::{NotUnderstood, Units, parse_angle_deg, parse_ratio};

/// What options with a number call their value, and what reads it.
#[cfg(test)]
const KINDS: [(&str, &str); 4] = [("METRES", "1 1/2\""), ("DEGREES", "22,5°"), ("SHARE", "12,5 %"), ("FACTOR", "1/2")];

/// A length in metres: `0.05`, `0,05`, `5 cm`, `2"`.
///
/// # Errors
/// What is not understood, and what would be.
pub fn metres(text: &str) -> Result<f64, NotUnderstood> {
    Units::Metric.parse_length(text)
}

/// An angle in degrees: `0.5`, `0.5°`, `1/2`.
///
/// # Errors
/// What is not understood, and what would be.
pub fn degrees(text: &str) -> Result<f64, NotUnderstood> {
    parse_angle_deg(text)
}

/// A share or a factor: `0.25`, `1/4`, `25 %`.
///
/// # Errors
/// What is not understood, and what would be.
pub fn share(text: &str) -> Result<f64, NotUnderstood> {
    parse_ratio(text)
}

/// A number as JSON: an integer without a decimal point, otherwise at most six decimals.
pub fn rounded(value: f64) -> serde_json::Value {
    let value = (value * 1e6).round() / 1e6;
    if value.fract() == 0.0 && value.abs() < 1e15 { (value as i64).into() } else { value.into() }
}

#[cfg(test)]
mod tests {
    use clap::error::ErrorKind;

    use super::*;
    use crate::cli::SUBCOMMANDS;

    /// Every option of every subcommand whose value is a length, an angle, a share or a factor.
    #[test]
    fn every_option_with_a_number_reads_it_as_everywhere_else() {
        let mut seen = 0;
        for entry in SUBCOMMANDS {
            let command = (entry.command)().mut_args(|argument| argument.required(false));
            for option in command.get_arguments() {
                let names = option.get_value_names().unwrap_or_default();
                let name = names.first().map(|name| name.as_str()).unwrap_or_default();
                let is_number =
                    ["METRES", "METERS", "FEET", "LENGTH", "DEGREES", "ANGLE", "SHARE", "FACTOR"].contains(&name);
                let Some(long) = option.get_long().filter(|_| is_number) else { continue };
                let kind = KINDS.iter().find(|(kind, _)| *kind == name);
                let Some((_, spelling)) = kind else {
                    panic!("--{long} of {}: {name} is no kind of number", entry.name)
                };
                let read = |text: &str| {
                    command.clone().try_get_matches_from([entry.name, &format!("--{long}={text}")]).map(drop)
                };
                assert!(read(spelling).is_ok(), "{} --{long} '{spelling}': {:?}", entry.name, read(spelling));
                let error = read("wide").unwrap_err();
                assert_eq!(error.kind(), ErrorKind::ValueValidation, "{} --{long}", entry.name);
                assert!(error.to_string().contains("'wide' is not understood"), "{error}");
                seen += 1;
            }
        }
        assert!(seen >= 8, "{seen}");
    }

    #[test]
    fn numbers_are_metres_degrees_and_parts_of_one() {
        assert_eq!(metres("5 cm"), Ok(0.05));
        assert_eq!(metres("0,05"), Ok(0.05));
        assert_eq!(degrees("1/2"), Ok(0.5));
        assert_eq!(share("25 %"), Ok(0.25));
        assert!(metres("1e-2").is_err() && share("NaN").is_err());
    }
}
