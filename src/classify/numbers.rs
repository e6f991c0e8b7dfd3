//! Readable numbers: thresholds with few digits, features in words.

use crate::dataset::table::FEATURES;

/// The number with the fewest decimals in `low..high`, nearest to the middle: a threshold between 12.331
/// and 12.452 becomes 12.4, and one between 2 and 3 openings becomes 2.
pub(super) fn readable_between(low: f64, high: f64) -> f64 {
    let middle = low + (high - low) / 2.0;
    // Beyond nine decimals of a square metre the two ends differ only by rounding.
    for decimals in 0..9 {
        let unit = 10f64.powi(-decimals);
        for step in [(middle / unit).round(), (middle / unit).floor()] {
            // Dividing by the inverse keeps 12.4 from becoming 12.400000000000002.
            let number = step / 10f64.powi(decimals);
            if low <= number && number < high {
                return number;
            }
        }
    }
    low
}

/// Features and values as parts of a sentence.
pub(super) mod in_words {
    use super::{FEATURES, value_in_words};

    /// What each feature is called, in the order of [`Features::NAMES`](crate::features::Features::NAMES).
    pub(in crate::classify) const NAMES: [&str; FEATURES] = [
        "area",
        "axes ratio",
        "openings",
        "openings to small rooms",
        "openings to medium rooms",
        "openings to big rooms",
        "openings to corridors",
        "openings to halls",
    ];

    /// A number of openings: `no openings to halls`, `1 opening`, `3 openings`.
    pub(in crate::classify) fn of_count(feature: usize, count: f64) -> String {
        let name = NAMES[feature];
        if count == 0.0 {
            format!("no {name}")
        } else if count == 1.0 {
            format!("1 {}", name.replacen("openings", "opening", 1))
        } else {
            format!("{count} {name}")
        }
    }

    /// A feature with its value: `an area of 12.4 m²`, `3 openings`.
    pub(in crate::classify) fn of_value(feature: usize, value: f64) -> String {
        if feature < 2 {
            format!("an {} of {}", NAMES[feature], value_in_words(feature, value))
        } else {
            of_count(feature, value)
        }
    }
}

/// A feature's value with its unit, short: `12.4 m²`, `1.9`, `3`.
pub(super) fn value_in_words(feature: usize, value: f64) -> String {
    match feature {
        0 => format!("{} m²", rounded(value)),
        1 => rounded(value),
        _ => value.to_string(),
    }
}

/// At most two decimals, fewer for large numbers, without trailing zeros.
fn rounded(value: f64) -> String {
    let unit = if value.abs() >= 100.0 {
        1.0
    } else if value.abs() >= 10.0 {
        10.0
    } else {
        100.0
    };
    ((value * unit).round() / unit).to_string()
}

/// A probability in percent: `88 %`, but never `100 %` unless certain.
pub(super) fn percent(probability: f64) -> String {
    let percent = (probability * 100.0).round();
    if percent >= 100.0 && probability < 1.0 {
        "over 99 %".to_owned()
    } else if percent <= 0.0 && probability > 0.0 {
        "under 1 %".to_owned()
    } else {
        format!("{percent} %")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thresholds_have_few_digits() {
        for (low, high, expected) in [
            (2.0, 3.0, 2.0),
            (12.331, 12.452, 12.4),
            (0.0, 1.0, 0.0),
            (9.9, 10.2, 10.0),
            (1.234_567, 1.234_568, 1.234_567),
            (99.0, 151.0, 125.0),
        ] {
            let threshold = readable_between(low, high);
            assert!(low <= threshold && threshold < high);
            assert_eq!(threshold, expected);
        }
        // Between neighbouring floating-point numbers only the lower one remains.
        assert_eq!(readable_between(1.0, 1.0 + f64::EPSILON), 1.0);
    }

    #[test]
    fn values_are_short() {
        assert_eq!(value_in_words(0, 12.4499), "12.4 m²");
        assert_eq!(value_in_words(0, 1234.5), "1235 m²");
        assert_eq!(value_in_words(1, 1.9), "1.9");
        assert_eq!(value_in_words(2, 3.0), "3");
        assert_eq!(
            (percent(0.876).as_str(), percent(0.999).as_str(), percent(1.0).as_str()),
            ("88 %", "over 99 %", "100 %")
        );
    }
}
