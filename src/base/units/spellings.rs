//! Spellings of lengths, angles and numbers, each with what it means.

use proptest::prelude::*;

use crate::base::units::*;

const FOOT: f64 = METRES_PER_FOOT;
const INCH: f64 = METRES_PER_INCH;

/// As architects write feet and inches; the same whatever is set.
#[test]
fn feet_and_inches_are_read_as_architects_mean_them() {
    for (inches, spellings) in [
        (
            66.5,
            &[
                "5'6-1/2\"",
                "5'-6-1/2\"",
                "5'-6 1/2\"",
                "5' 6 1/2\"",
                "5' 6-1/2\"",
                "5'6 1/2",
                "5'6-1/2",
                "5'6½\"",
                "5'6½",
                "5'-6½\"",
                "5' 6 ½\"",
                "5’ 6½”",
                "5′6½″",
                "5'6½''",
                "5’-6 1/2’’",
                "5‘6½“",
                "5'‑6‑1/2\"",
                "5'–6½\"",
                "5 ft 6 1/2 in",
                "5ft6½in",
                "5 FEET 6-1/2 INCHES",
                "5 foot 6.5 inch",
                "5 ft. 6½ in.",
                "5 feet, 6½ inches",
                "5 feet and 6½ inches",
                "66.5\"",
                "66½\"",
                "66-1/2\"",
                "66 1/2 inches",
                "66,5 in",
                "5' 6 1⁄2\"",
                "(5'6-1/2\")",
                "+5'6-1/2\"",
                "5'6\" + 1/2\"",
                "5' + 6½\"",
                "133/2\"",
                "5' 13/2\"",
            ][..],
        ),
        (
            36.625,
            &["3'5/8", "3'5/8\"", "3' 5/8\"", "3'-5/8\"", "3'0-5/8\"", "3'⅝", "3' ⅝\"", "3 ft 5/8", "3 ft 5/8 in"],
        ),
        (6.5, &["6-1/2\"", "6 1/2\"", "6½\"", "6½ in", "6-½\"", "6-1/2''", "6.5”", "13/2 in", "6 ½ inch", "6½″"]),
        (
            128.0,
            &[
                "10’ 8”",
                "10′ 8″",
                "10' 8\"",
                "10'8",
                "10' 8''",
                "10´8˝",
                "10`8\"",
                "10'-8\"",
                "10 ft 8",
                "3.5 yd + 2\"",
            ],
        ),
        (0.5, &["1/2\"", "½\"", ".5\"", "0,5 in", "4/8 inch"]),
        (18.0, &["1.5'", "1½'", "1 1/2'", "1-1/2'", "1-1/2 ft", "3/2'", "½ yd", "1 foot 6", "18 in"]),
        // With blanks about it, or as a true minus, a hyphen takes away.
        (65.5, &["5'6 - 1/2\"", "5'6\" - 1/2\"", "5'6\"-1/2\"", "5' + 6\" - ½\"", "5'6\"−½\""]),
        (112.0, &["10' - 8\"", "10'−8\"", "10' -8\""]),
        (-66.5, &["-5'6-1/2\"", "−5'6½\"", "-(5' 6 1/2\")"]),
        (
            60.0,
            &[
                "10'/2", "10' / 2", "5'", "5’", "5 ft", "5 foot", "5 feet", "5 FEET", "5 Feet", "5ft.", "60\"", "60''",
                "60 in.",
            ],
        ),
    ] {
        for spelling in spellings {
            for units in Units::ALL {
                let read = units.parse_length(spelling).map(|length_m| length_m / INCH);
                assert!(
                    read.as_ref().is_ok_and(|read| (read - inches).abs() < 1e-9),
                    "{spelling} in {units}: {read:?}, not {inches}"
                );
            }
        }
    }
}

#[test]
fn metric_lengths_are_read_in_every_spelling() {
    for (length_m, spellings) in [
        (
            3.25,
            &[
                "325 CM",
                "325cm",
                "325 Centimetres",
                "325 centimeters",
                "3250 MM",
                "3250 millimetres",
                "3250 millimeter",
                "3.25 M",
                "3,25 m",
                "3.25 metres",
                "3.25 METERS",
                "3,25 meter",
                "32.5 dm",
                "0.00325 km",
                "3 m + 25 cm",
                "3.25 m.",
                "(3.25m)",
                "13/4 m",
                "3¼ m",
                "3 1/4 m",
                "6.5m/2",
                "2*(1.5 m + 125mm)",
                "3\u{a0}m + 25\u{202f}cm",
            ][..],
        ),
        (1.836, &["3*(60cm+12mm)", "3 × (60 cm + 12 mm)", "(60cm+12mm)*3", "3·(60cm+12mm)"]),
        (3.0, &["3 metres", "3 m", "3m", "3 METRE", "300 cm", "+3m", "3.0m", "3,m", "3.m"]),
    ] {
        for spelling in spellings {
            for units in Units::ALL {
                let read = units.parse_length(spelling);
                assert!(
                    read.as_ref().is_ok_and(|read| (read - length_m).abs() < 1e-9),
                    "{spelling} in {units}: {read:?}"
                );
            }
        }
    }
}

#[test]
fn angles_and_numbers_are_read_in_every_spelling() {
    for (text, degrees) in [
        ("45", 45.0),
        ("45°", 45.0),
        ("45º", 45.0),
        ("45,5 deg", 45.5),
        ("45 DEGREES", 45.0),
        ("90/4", 22.5),
        ("22½°", 22.5),
        ("180° - 30", 150.0),
        ("-45", -45.0),
        ("2*(10+12.5)", 45.0),
        ("0.1°", 0.1),
    ] {
        assert_eq!(parse_angle_deg(text), Ok(degrees), "{text}");
    }
    assert!((parse_angle_rad("0.5 rad").unwrap() - 0.5).abs() < 1e-12);
    for (text, number) in [("2", 2.0), ("1,5", 1.5), ("3/4", 0.75), ("½", 0.5), ("-3", -3.0), ("2*(1+3)", 8.0)] {
        assert_eq!(parse_number(text), Ok(number), "{text}");
        assert_eq!(parse_ratio(text), Ok(number), "{text}");
        assert_eq!(parse_percent(text), Ok(number), "{text}");
    }
    assert_eq!(parse_ratio("25 %"), Ok(0.25));
    assert_eq!(parse_percent("12,5 %"), Ok(12.5));
    for (text, read) in [
        ("3 m", parse_angle_deg as fn(&str) -> Result<f64, NotUnderstood>),
        ("3 m", parse_number),
        ("25%", parse_number),
        ("45°", parse_ratio),
        ("1e3", parse_number),
        ("NaN", parse_number),
        ("inf", parse_ratio),
        ("45°30'", parse_angle_deg),
        ("", parse_percent),
    ] {
        assert!(read(text).is_err(), "{text}");
    }
}

#[test]
fn what_can_be_read_in_two_ways_is_refused_where_it_can() {
    // Six and a half feet, or five and a half?
    let error = Units::Imperial.parse_length("6-1/2").unwrap_err().to_string();
    assert!(error.starts_with("'6-1/2' can be read in two ways: type '6 1/2' or '6 - 1/2'; a length is"), "{error}");
    assert!(Units::Imperial.parse_length("6‑½").is_err());
    assert!((Units::Imperial.parse_length("6 - 1/2").unwrap() - 5.5 * FOOT).abs() < 1e-9);
    assert!((Units::Imperial.parse_length("6 1/2").unwrap() - 6.5 * FOOT).abs() < 1e-9);
    // Nobody writes metres so: it is a sum.
    assert_eq!(Units::Metric.parse_length("6-1/2"), Ok(5.5));
}

/// One of some spellings.
fn one(of: &'static [&'static str]) -> impl Strategy<Value = &'static str> {
    proptest::sample::select(of)
}

const FEET_SPELT: &[&str] = &["'", "’", "′", "‘", "´", " '", "ft", " ft", " FT", " ft.", " feet", " Foot", "foot"];
const INCHES_SPELT: &[&str] =
    &["\"", "”", "″", "''", "’’", "′′", " \"", "in", " in", " IN", " in.", " inch", " Inches", "inches", ""];
const FRACTION_SIGNS: &[(u32, u32, &str)] =
    &[(1, 2, "½"), (1, 4, "¼"), (3, 4, "¾"), (1, 8, "⅛"), (3, 8, "⅜"), (5, 8, "⅝"), (7, 8, "⅞")];

proptest! {
    /// Feet, inches and parts of an inch in every way in which they are written together.
    #[test]
    fn every_spelling_of_feet_and_inches_reads_back(
        feet in 0u32..400,
        inches in 0u32..12,
        of in proptest::sample::select(&[2u32, 4, 8, 16, 32, 64][..]),
        parts in 1u32..64,
        feet_spelt in one(FEET_SPELT),
        inches_spelt in one(INCHES_SPELT),
        between in one(&["", " ", "-", "‐", "–", "  "]),
        within in one(&[" ", "-", "‑", "sign"]),
        is_signed in any::<bool>(),
    ) {
        let parts = parts % of;
        let sign = FRACTION_SIGNS.iter().find(|(a, b, _)| parts > 0 && a * of == b * parts).map(|(.., sign)| *sign);
        let part = match (parts, within, sign) {
            (0, ..) => String::new(),
            (_, "sign", Some(sign)) => sign.to_owned(),
            (_, "sign", None) => format!(" {parts}/{of}"),
            _ => format!("{within}{parts}/{of}"),
        };
        let minus = if is_signed { "-" } else { "" };
        let value_m = (f64::from(feet) * 12.0 + f64::from(inches) + f64::from(parts) / f64::from(of)) * INCH;
        let value_m = if is_signed { -value_m } else { value_m };
        let text = format!("{minus}{feet}{feet_spelt}{between}{inches}{part}{inches_spelt}");
        // A full stop before a digit could be a decimal point.
        let is_unclear = feet_spelt.ends_with('.') && between.is_empty();
        for units in Units::ALL {
            let read = units.parse_length(&text);
            let is_right = read.as_ref().is_ok_and(|read| (read - value_m).abs() < 1e-9);
            prop_assert!(if is_unclear { read.is_err() } else { is_right }, "{text}: {read:?}, not {value_m}");
        }
    }

    /// A decimal number with each unit, capitals and blanks.
    #[test]
    fn every_spelling_of_a_metric_length_reads_back(
        hundredths in -100_000i64..100_000,
        comma in any::<bool>(),
        blank in one(&["", " ", "\u{a0}"]),
        unit in proptest::sample::select(&[("m", 1.0), ("metres", 1.0), ("meter", 1.0), ("cm", 0.01), ("centimetre", 0.01), ("mm", 0.001), ("millimeters", 0.001), ("dm", 0.1), ("km", 1000.0)][..]),
        capitals in any::<bool>(),
    ) {
        let (word, size) = unit;
        let number = format!("{}", hundredths as f64 / 100.0);
        let number = if comma { number.replace('.', ",") } else { number };
        let word = if capitals { word.to_uppercase() } else { word.to_owned() };
        let text = format!("{number}{blank}{word}");
        for units in Units::ALL {
            let read = units.parse_length(&text).unwrap();
            prop_assert!((read - hundredths as f64 / 100.0 * size).abs() < 1e-9, "{text}: {read}");
        }
    }

    /// No character is passed over: one more that means nothing is refused, wherever it stands.
    #[test]
    fn a_character_that_means_nothing_is_never_passed_over(
        spelling in one(&["3.25", "325 cm", "10' 8 1/2\"", "5'6-1/2\"", "3*(60cm+12mm)", "5 feet 6 inches"]),
        at in 0usize..20,
        strange in proptest::sample::select(&['?', '!', 'q', 'ß', '$', '²', '_', '#', '\u{7}', '٣', '=', '<', '%', '°'][..]),
    ) {
        let at = spelling.char_indices().map(|(at, _)| at).nth(at).unwrap_or(spelling.len());
        let text = format!("{}{strange}{}", &spelling[..at], &spelling[at..]);
        for units in Units::ALL {
            prop_assert!(units.parse_length(&text).is_err(), "{text}");
        }
    }
}

#[test]
fn lengths_are_understood_as_people_type_them() {
    let foot = METRES_PER_FOOT;
    let inch = METRES_PER_INCH;
    for (text, metric, imperial) in [
        ("3.25", 3.25, 3.25 * foot),
        ("3,25", 3.25, 3.25 * foot),
        (".5", 0.5, 0.5 * foot),
        ("3.25m", 3.25, 3.25),
        ("325cm", 3.25, 3.25),
        ("3250 mm", 3.25, 3.25),
        ("0.003 km", 3.0, 3.0),
        ("10'", 10.0 * foot, 10.0 * foot),
        ("10' 8\"", 128.0 * inch, 128.0 * inch),
        ("10'8 1/2\"", 128.5 * inch, 128.5 * inch),
        ("10'-8 1/2\"", 128.5 * inch, 128.5 * inch),
        ("10' - 8\"", 112.0 * inch, 112.0 * inch),
        ("10 ft 8 in", 128.0 * inch, 128.0 * inch),
        ("10' 8", 128.0 * inch, 128.0 * inch),
        ("10′ 8″", 128.0 * inch, 128.0 * inch),
        ("10’ 8”", 128.0 * inch, 128.0 * inch),
        ("10' 8''", 128.0 * inch, 128.0 * inch),
        ("8.5\"", 8.5 * inch, 8.5 * inch),
        ("1/2\"", 0.5 * inch, 0.5 * inch),
        ("8 1/2 inches", 8.5 * inch, 8.5 * inch),
        ("2 1/2 feet", 2.5 * foot, 2.5 * foot),
        ("10'/2", 5.0 * foot, 5.0 * foot),
        ("12m/4", 3.0, 3.0),
        ("2*3", 6.0, 6.0 * foot),
        ("3 + 20cm", 3.2, 3.0 * foot + 0.2),
        ("3*(60cm+12 mm)", 1.836, 1.836),
        ("6 × 2", 12.0, 12.0 * foot),
        ("-4", -4.0, -4.0 * foot),
        ("2 - -1", 3.0, 3.0 * foot),
        ("7/2", 3.5, 3.5 * foot),
    ] {
        let (read_metric, read_imperial) = (Units::Metric.parse_length(text), Units::Imperial.parse_length(text));
        assert!((read_metric.unwrap() - metric).abs() < 1e-9, "{text}");
        assert!((read_imperial.unwrap() - imperial).abs() < 1e-9, "{text}");
    }
}

#[test]
fn what_is_not_understood_is_told() {
    for (text, words) in [
        ("", "nothing is typed"),
        ("  ", "nothing is typed"),
        ("wide", "'wide'"),
        ("3 parsec", "'parsec'"),
        ("3 m 4", "'4'"),
        ("3..2", "'3..2'"),
        ("1,234.5", "'1,234.5'"),
        ("3+", "ends too early"),
        ("(3", "')'"),
        ("3)", "')'"),
        ("3m*2m", "an area"),
        ("6m/2m", "no length"),
        ("1/2m+1/0", "by zero"),
        ("2.5/3m", "divides by a length"),
        ("1e400", "'e400'"),
        ("45°", "'°'"),
    ] {
        let error = Units::Metric.parse_length(text).unwrap_err().to_string();
        assert!(error.contains(words), "{text:?} gave {error:?}");
    }
    let deep = "(".repeat(500);
    assert!(Units::Metric.parse_length(&deep).is_err());
    assert!(Units::Metric.parse_length(&"9".repeat(400)).is_err());
    let angles = [("45", 45.0), ("45°", 45.0), ("45,5 deg", 45.5), ("90/4", 22.5), ("180° - 30", 150.0)];
    for (text, degrees) in angles {
        assert!((parse_angle_rad(text).unwrap().to_degrees() - degrees).abs() < 1e-9, "{text}");
    }
    assert!((parse_angle_rad("0.5 rad").unwrap() - 0.5).abs() < 1e-12);
    assert!(parse_angle_rad("3 m").unwrap_err().to_string().contains("an angle is"));
}
