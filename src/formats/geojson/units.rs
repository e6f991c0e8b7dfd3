//! In what units a file is, and where its origin lies.

use super::crs::{self, Crs};
use super::disk::{DiskCollection, Words};
use super::item::{Item, is_within, note_on_file};
use crate::base::numbers::lower_median;
use crate::base::wording::thousands;
use crate::formats::{Note, NoteKind, Place, ReadError};
use crate::geometry::{Bounds, Point, Vector, polygon};
use crate::plan::Plan;

/// Below this size of its largest feature, a file without units is in degrees: no plan is so small
/// in metres, and half a degree is 50 km.
const SMALLEST_PLAN_M: f64 = 0.5;

const NOT_METRES: &str = "project it to metres first, and say \"units\": \"m\" at the top of the file";
const NOT_DEGREES: &str = "project it to metres first, and say \"units\": \"m\" at the top of the file; where the \
     numbers are metres all the same, import it with --option metres=true";

/// Why a file without units is taken as metres; taken back where its sizes suggest something else.
pub(super) const AS_SIZES_SUGGEST: &str = "as the sizes suggest";

/// Brings a drawing whose middle lies beyond the limit of coordinates near to the origin: map projections
/// count from a meridian and the equator. A note on how far it was moved.
pub(super) fn move_near(items: &mut [Item]) -> Option<Note> {
    let centers = || items.iter().map(|item| item.shapes.bounds()).filter(|bounds| !bounds.is_empty());
    let mut xs: Vec<f64> = centers().map(|bounds| bounds.center().x).collect();
    let mut ys: Vec<f64> = centers().map(|bounds| bounds.center().y).collect();
    let middle = Point::new(lower_median(&mut xs)?, lower_median(&mut ys)?);
    // Further than this is no place on a map of the Earth.
    const FARTHEST_M: f64 = 1e8;
    if is_within(middle) || middle.x.abs().max(middle.y.abs()) > FARTHEST_M {
        return None;
    }
    // Whole hundreds of metres: their last digits stay those of the map.
    let round = |value: f64| (value / 100.0).floor() * 100.0;
    let shift = Vector::new(round(middle.x), round(middle.y));
    for item in items {
        item.shapes.map(|point| point - shift);
        if let Some(host) = &mut item.properties.host {
            host.from.0 = host.from.0 - shift;
            host.to.0 = host.to.0 - shift;
        }
    }
    let what = format!(
        "lies far from the origin, as in a map; moved by ({:?}, {:?}) m, so that (0, 0) is ({:?}, {:?}) there",
        -shift.x, -shift.y, shift.x, shift.y
    );
    Some(note_on_file(NoteKind::Healed, what))
}

/// What a file says of its units.
pub(super) struct Units {
    /// Whether it says that they are metres.
    pub are_stated: bool,
    /// What there is to say of them.
    pub words: Vec<String>,
}

/// Refuses what is not in metres.
pub(super) fn of(collection: &DiskCollection<'_>, items: &[Item], in_metres: bool) -> Result<Units, ReadError> {
    let refuse = |what: String, hint: &str| Err(ReadError { place: Place::default(), what, hint: hint.to_owned() });
    let crs = collection.crs.as_ref().and_then(crs::of);
    let are_stated = match collection.units.as_ref().map_or("", Words::as_str).trim().to_lowercase().as_str() {
        "m" | "metre" | "metres" | "meter" | "meters" => true,
        "" => false,
        other => return refuse(format!("is in '{other}', not in metres"), NOT_METRES),
    };
    let mut words = Vec::new();
    if are_stated || in_metres {
        let reason = if are_stated { "as it says" } else { "as told when importing" };
        match crs {
            Some(Crs::Geographic(name) | Crs::WebMercator(name)) => {
                words.push(format!("names {name}, but is in metres, {reason}; taken as metres"));
            }
            Some(Crs::Metres(name)) if !are_stated => words.push(format!("is in {name}, in metres")),
            Some(Crs::Unknown(name)) if !are_stated => {
                words.push(format!("names the coordinate reference system {name}; taken as metres, {reason}"));
            }
            None if !are_stated => words.push(format!("names no units; taken as metres, {reason}")),
            _ => {}
        }
        return Ok(Units { are_stated, words });
    }
    let unknown = match crs {
        Some(Crs::Geographic(name)) => return refuse(format!("is in {name}"), NOT_DEGREES),
        Some(Crs::WebMercator(name)) => {
            let what = format!("is in {name}, whose metres are true at the equator only");
            return refuse(what, "project it to UTM or a grid of the country first, in metres");
        }
        Some(Crs::Metres(name)) => {
            return Ok(Units { are_stated: true, words: vec![format!("is in {name}, in metres")] });
        }
        Some(Crs::Unknown(name)) => format!(", and the coordinate reference system {name}, which says nothing here"),
        None => String::new(),
    };
    // RFC 7946 means longitude and latitude where nothing else is said. Our properties and a
    // plausible size say something else.
    let largest_m = items
        .iter()
        .map(|item| item.shapes.bounds())
        .fold(0.0, |largest: f64, bounds| largest.max(bounds.width()).max(bounds.height()));
    let is_ours = |item: &Item| matches!(item.properties.kind.as_str(), "room" | "opening" | "wall");
    if largest_m > 0.0 && (!items.iter().any(is_ours) || largest_m < SMALLEST_PLAN_M) {
        let all = items.iter().fold(Bounds::EMPTY, |all, item| all.union(item.shapes.bounds()));
        let are_degrees = all.min.x >= -180.0 && all.max.x <= 180.0 && all.min.y >= -90.0 && all.max.y <= 90.0;
        if !are_degrees {
            let what = format!("names no units{unknown}, and its numbers are no longitude and latitude");
            return refuse(what, NOT_DEGREES);
        }
        if unknown.is_empty() {
            return refuse("names no units, so that it is in longitude and latitude".to_owned(), NOT_METRES);
        }
        return refuse(format!("names no units{unknown}"), NOT_DEGREES);
    }
    if largest_m > 0.0 {
        words.push(format!("names no units{unknown}; taken as metres, {AS_SIZES_SUGGEST}"));
    }
    Ok(Units { are_stated, words })
}

/// The area in m² of the median room of a plan in metres, see `authors_xml/scale.rs`: of 56 schools and
/// offices the medians lie between 2 and 140.
const PLAUSIBLE_MEDIAN_M2: std::ops::RangeInclusive<f64> = 1.0..=1000.0;

/// The width of the median door or passage of a plan in metres.
const PLAUSIBLE_DOOR_M: std::ops::RangeInclusive<f64> = 0.3..=10.0;

/// No room is larger, in m²: the largest hall there is has 0.4 km².
const LARGEST_ROOM_M2: f64 = 1e6;

/// What speaks against metres, by the sizes of rooms and doors; a file that says that it is in metres is
/// believed as far as anything is possible.
pub(super) fn doubt(plan: &Plan, are_stated: bool) -> Option<String> {
    // The likeliest first.
    const UNITS: [(&str, f64); 3] = [("millimetres", 0.001), ("centimetres", 0.01), ("kilometres", 1000.0)];
    let areas = plan.rooms().map(|(_, room)| {
        let holes: Vec<Vec<Point>> = room.holes.iter().map(|hole| plan.ring_points(hole)).collect();
        polygon::area(&plan.ring_points(&room.outer), &holes)
    });
    let mut areas: Vec<f64> = areas.filter(|&area| area > 0.0).collect();
    let mut widths: Vec<f64> =
        plan.openings().filter_map(|(_, opening)| Some(plan.opening_segment(opening)?.length())).collect();
    let largest_m2 = areas.iter().copied().fold(0.0, f64::max);
    let (median_m2, width_m) = (lower_median(&mut areas), lower_median(&mut widths));
    let (says, unlikely) = if are_stated {
        ("says that it is in metres", largest_m2 > LARGEST_ROOM_M2)
    } else {
        let rooms = median_m2.is_some_and(|area| !PLAUSIBLE_MEDIAN_M2.contains(&area));
        let doors = width_m.is_some_and(|width_m| !PLAUSIBLE_DOOR_M.contains(&width_m));
        ("names no units; taken as metres", rooms || doors)
    };
    if !unlikely {
        return None;
    }
    let mut sizes = Vec::new();
    if largest_m2 > 0.0 {
        let area = if largest_m2 < 10.0 { format!("{largest_m2:.4}") } else { thousands(largest_m2.round() as u64) };
        sizes.push(format!("its largest room would have {area} m²"));
    }
    if let Some(width_m) = width_m {
        sizes.push(format!("an opening would be {width_m} m wide"));
    }
    let is_likely = |unit_m: f64| match (median_m2, width_m) {
        (Some(area), _) => PLAUSIBLE_MEDIAN_M2.contains(&(area * unit_m * unit_m)),
        (None, width_m) => width_m.is_some_and(|width_m| PLAUSIBLE_DOOR_M.contains(&(width_m * unit_m))),
    };
    let guess = UNITS.iter().find(|(_, unit_m)| is_likely(*unit_m));
    let guess = guess.map(|(name, _)| format!("; the numbers look like {name}")).unwrap_or_default();
    Some(format!("{says}, which is doubtful: {}{guess}", sizes.join(" and ")))
}
