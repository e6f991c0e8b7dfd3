//! Determines how many metres a pixel is.

use super::super::xml::Offset;
use super::document::{Document, Length};
use crate::base::numbers::upper_median;
use crate::geometry::polygon;
use crate::plan::{Scale, ScaleOrigin};

/// The plausible range of the median room area in m². In 56 of the authors' files the medians are between
/// 2 and 140 m², while a wrong unit is off by a factor of 10,000.
const PLAUSIBLE_MEDIAN_M2: std::ops::RangeInclusive<f64> = 1.0..=1000.0;

/// The plausible range of the stated distance, a door's width, in metres: used if there are no rooms to
/// judge by.
const PLAUSIBLE_DOOR_M: std::ops::RangeInclusive<f64> = 0.3..=3.0;

/// The assumed median room area in m² if no scale is stated: that of 56 of the authors' files, rounded
/// (median of the files' medians: 33).
const MEDIAN_ROOM_M2: f64 = 30.0;

/// Metres per pixel if there is neither a scale nor a room: a door of 18 pixels.
const FALLBACK_M: f64 = 0.05;

/// The units that a distance may be in, with their length in metres; the likeliest first.
const UNITS: [(&str, f64); 7] =
    [("cm", 0.01), ("m", 1.0), ("mm", 0.001), ("in", 0.0254), ("ft", 0.3048), ("dm", 0.1), ("yd", 0.9144)];

/// Other names of [`UNITS`], in English and in the language of the program.
const UNIT_NAMES: [(&str, &[&str]); 7] = [
    ("cm", &["centimetre", "centimetres", "centimeter", "centimeters", "centimetro", "centimetri", "cms"]),
    ("m", &["metre", "metres", "meter", "meters", "metro", "metri", "mt", "mts"]),
    ("mm", &["millimetre", "millimetres", "millimeter", "millimeters", "millimetro", "millimetri", "mms"]),
    (
        "in",
        &[
            "inch", "inches", "ins", "\"", "″", "”", "''", "pollice", "pollici", "pouce", "pouces", "pulgada",
            "pulgadas", "zoll",
        ],
    ),
    ("ft", &["foot", "feet", "'", "′", "’", "piede", "piedi", "pied", "pieds", "pie", "pies", "fuß"]),
    ("dm", &["decimetre", "decimetres", "decimeter", "decimeters", "decimetro", "decimetri"]),
    ("yd", &["yard", "yards", "yds", "iarda", "iarde"]),
];

/// The unit of a name, upper or lower case, with a full stop or without.
fn unit_named(name: &str) -> Option<(&'static str, f64)> {
    let name = name.trim().trim_end_matches('.').to_lowercase();
    let short = UNIT_NAMES.iter().find(|(short, names)| *short == name || names.contains(&name.as_str()))?.0;
    UNITS.iter().copied().find(|(unit, _)| *unit == short)
}

/// A scale, and what was repaired to get it.
#[derive(Debug)]
pub struct Found {
    pub scale: Scale,
    pub metres_per_pixel: f64,
    /// What was repaired, and its position in the file.
    pub healings: Vec<(Option<Offset>, String)>,
}

/// The scale given by the user, whatever the file states.
pub fn told(metres_per_pixel: f64) -> Found {
    let note = format!("told when importing: {metres_per_pixel} m per pixel");
    let scale = Scale { origin: ScaleOrigin::Measured, metres_per_unit: Some(metres_per_pixel), note };
    Found { scale, metres_per_pixel, healings: Vec::new() }
}

/// The scale of a document.
///
/// `represented_distance` pixels stand for `real_distance`, the width of a door. Repairs: an implausible
/// unit; a scale that is missing or not a number; and the scale of files with an `<image_scale>`, which
/// is twice too large.
pub fn find(document: &Document) -> Found {
    let mut healings = Vec::new();
    let median_px2 = median_room_px2(document);
    let pixels = document.represented.as_ref().and_then(number).filter(|&pixels| pixels > 0.0);
    let real = document.real.as_ref().and_then(|real| Some((real, number(real).filter(|&value| value > 0.0)?)));
    let (Some(pixels), Some((real, value))) = (pixels, real) else {
        let at = document.represented.as_ref().or(document.real.as_ref()).map(|length| length.at);
        return estimated(median_px2, at, "the scale is missing or no number above 0");
    };
    let drawn = document.represented.as_ref().filter(|drawn| !is_pixels(&drawn.unit));
    if let Some(drawn) = drawn {
        let what = format!("the drawn distance of {pixels} is in '{}', not in pixels; taken as pixels", drawn.unit);
        healings.push((Some(drawn.at), what));
    }
    // The program that writes <image_scale> halved the pixels of the scale but not those of the
    // rooms: three pictures of known size prove it (see docs/authors-xml.md).
    let factor = if document.image_scale.is_some() { 0.5 } else { 1.0 };
    let is_plausible = |unit_m: f64| match median_px2 {
        Some(median_px2) => PLAUSIBLE_MEDIAN_M2.contains(&(median_px2 * (value * unit_m / pixels * factor).powi(2))),
        None => PLAUSIBLE_DOOR_M.contains(&(value * unit_m)),
    };
    let stated = unit_named(&real.unit);
    let likely = UNITS.iter().find(|&&(_, unit_m)| is_plausible(unit_m));
    let ((unit, unit_m), origin) = match (stated, likely) {
        (Some((name, unit_m)), _) if is_plausible(unit_m) => ((name, unit_m), ScaleOrigin::Imported),
        (_, Some(&(name, unit_m))) => {
            let size = match median_px2 {
                Some(_) => "the rooms would have implausible sizes",
                None => "it would be no door",
            };
            healings.push((
                Some(real.at),
                match stated {
                    Some(_) => format!(
                        "the scale's distance of {value} '{}' cannot be meant: {size}; taken as {name}",
                        real.unit
                    ),
                    None if real.unit.is_empty() => {
                        format!(
                            "the scale's distance of {value} has no unit; taken as {name}, by the sizes of the rooms"
                        )
                    }
                    None => format!(
                        "the unit '{}' of the scale's distance is not known; {value} taken as {name}",
                        real.unit
                    ),
                },
            ));
            ((name, unit_m), ScaleOrigin::Estimated)
        }
        _ => {
            let what =
                format!("a scale of {pixels} pixels for {value} '{}' would give rooms of implausible sizes", real.unit);
            return estimated(median_px2, Some(real.at), &what);
        }
    };
    let mut note = format!("{pixels} pixels stand for {value} {unit}");
    if unit != real.unit {
        note.push_str(&format!(", written as '{}'", real.unit));
    }
    if document.image_scale.is_some() {
        note.push_str("; halved, since files with <image_scale> state a scale twice too large");
        healings.push((
            document.represented.as_ref().map(|represented| represented.at),
            format!(
                "the scale is twice too large, as in every file with <image_scale>: {pixels} pixels taken as {}",
                2.0 * pixels
            ),
        ));
    }
    let metres_per_pixel = value * unit_m / pixels * factor;
    Found { scale: Scale { origin, metres_per_unit: Some(metres_per_pixel), note }, metres_per_pixel, healings }
}

/// Whether a drawn distance says nothing, or that it is in pixels.
fn is_pixels(unit: &str) -> bool {
    let unit = unit.trim().trim_end_matches('.').to_lowercase();
    ["", "pixel", "pixels", "px", "pix"].contains(&unit.as_str())
}

/// A scale where the file gives none that can be used.
fn estimated(median_px2: Option<f64>, at: Option<Offset>, why: &str) -> Found {
    let (metres_per_pixel, how) = match median_px2 {
        Some(median_px2) => {
            ((MEDIAN_ROOM_M2 / median_px2).sqrt(), format!("estimated so that the median room has {MEDIAN_ROOM_M2} m²"))
        }
        None => (FALLBACK_M, format!("a pixel taken as {FALLBACK_M} m")),
    };
    let scale = Scale {
        origin: ScaleOrigin::Estimated,
        metres_per_unit: Some(metres_per_pixel),
        note: format!("{why}; {how}"),
    };
    Found { scale, metres_per_pixel, healings: vec![(at, format!("{why}; {how}"))] }
}

/// The number of a length, with a decimal point or comma; `None` if it is not a number.
fn number(length: &Length) -> Option<f64> {
    length.value.replace(',', ".").parse::<f64>().ok().filter(|value| value.is_finite())
}

/// The median area of the rooms that have one, in square pixels.
fn median_room_px2(document: &Document) -> Option<f64> {
    let spaces = document.floors.iter().flat_map(|floor| &floor.spaces);
    let mut areas: Vec<f64> =
        spaces.map(|space| polygon::signed_area(&space.boundary).abs()).filter(|&area| area > 0.0).collect();
    upper_median(&mut areas)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_known_by_many_names() {
        for (name, unit) in [
            ("cm", "cm"),
            ("CM", "cm"),
            ("centimetri", "cm"),
            ("Centimeters", "cm"),
            ("inch", "in"),
            ("Inches", "in"),
            ("in.", "in"),
            ("\"", "in"),
            ("foot", "ft"),
            ("feet", "ft"),
            ("'", "ft"),
            ("metri", "m"),
            ("Meter", "m"),
            ("millimetre", "mm"),
            ("dm", "dm"),
            ("yards", "yd"),
        ] {
            assert_eq!(unit_named(name).map(|(name, _)| name), Some(unit), "{name}");
        }
        for unknown in ["", "pixel", "cubit", "c"] {
            assert_eq!(unit_named(unknown), None, "{unknown}");
        }
    }
}
