//! Names of the things in a plan as command arguments, and choices among such names.

use crate::app::session::origin::bundled;
use crate::base::units::Units;
use crate::features::RoomStatus;
use crate::formats;
use crate::geometry::{COORDINATE_LIMIT_M, Point};
use crate::plan::{ElementId, Plan, Room, RoomId};

/// A possible value of an argument.
#[derive(Clone, Debug, PartialEq)]
pub struct Choice {
    /// As written in a call.
    pub word: String,
    /// As shown.
    pub title: String,
    /// What distinguishes it from others of the same title; may be empty.
    pub detail: String,
    /// At the end: how many there are; may be empty.
    pub trail: String,
    /// A room's label, or a function's meaning: for a swatch.
    pub status: Option<RoomStatus>,
}

/// The most rooms of the same name to list.
const MOST_TOLD: usize = 3;

/// The word for a plan without a typology.
pub(crate) const UNKNOWN: &str = "unknown";

pub(crate) const fn switch_word(is_on: bool) -> &'static str {
    if is_on { "on" } else { "off" }
}

/// The word for a bundled plan.
pub(crate) fn sample_word(index: usize) -> &'static str {
    bundled().get(index).map_or("", |(name, _)| formats::file_stem(name))
}

/// The room named by a word. `Err(Some(…))` says why a word that names several rooms is ambiguous.
pub(crate) fn room(plan: &Plan, word: &str) -> Result<RoomId, Option<String>> {
    if let Ok(id) = word.parse::<RoomId>()
        && plan.room(id).is_some()
    {
        return Ok(id);
    }
    if word.is_empty() {
        return Err(None);
    }
    let named = |is_it: &dyn Fn(&Room) -> bool| -> Vec<RoomId> {
        plan.rooms().filter(|(_, room)| is_it(room)).map(|(id, _)| id).collect()
    };
    let exact = named(&|room| room.name == word);
    let lower = word.to_lowercase();
    let found = if exact.is_empty() { named(&|room| room.name.to_lowercase() == lower) } else { exact };
    match found.as_slice() {
        [] => Err(None),
        [one] => Ok(*one),
        several => {
            let ids: Vec<String> = several.iter().take(MOST_TOLD).map(RoomId::to_string).collect();
            let more = if several.len() > MOST_TOLD { ", …" } else { "" };
            Err(Some(format!("an id, because {} rooms have this name: {}{more}", several.len(), ids.join(", "))))
        }
    }
}

/// The element named by a word.
pub(crate) fn element(plan: &Plan, word: &str) -> Option<ElementId> {
    let id = match word.chars().next()? {
        'c' => word.parse().ok().map(ElementId::Corner),
        'w' => word.parse().ok().map(ElementId::Wall),
        'o' => word.parse().ok().map(ElementId::Opening),
        'd' => word.parse().ok().map(ElementId::Dimension),
        _ => None,
    };
    id.or_else(|| room(plan, word).ok().map(ElementId::Room)).filter(|&element| plan.has(element))
}

/// The words for some elements.
pub(crate) fn elements_word(elements: impl IntoIterator<Item = ElementId>) -> String {
    let words: Vec<String> = elements.into_iter().map(|element| element.to_string()).collect();
    words.join(" ")
}

/// The point that a word means: two numbers of metres, or lengths with their units.
pub(crate) fn point(word: &str) -> Option<Point> {
    point_in(word, Units::Metric)
}

/// The same with numbers without a unit in some units.
pub(crate) fn point_in(word: &str, units: Units) -> Option<Point> {
    let (x, y) = word.split_once(',')?;
    // Of more commas nobody knows which are decimal ones.
    let coordinate = |text: &str| units.parse_length(text).ok().filter(|_| !text.contains(','));
    let point = Point::new(coordinate(x)?, coordinate(y)?);
    (point.is_finite() && point.x.abs() <= COORDINATE_LIMIT_M && point.y.abs() <= COORDINATE_LIMIT_M).then_some(point)
}

/// The words for some points, on the 0.1 mm grid.
pub(crate) fn points_word(points: &[Point]) -> String {
    let words: Vec<String> = points.iter().map(|point| point.trimmed()).map(|p| format!("{},{}", p.x, p.y)).collect();
    words.join(" ")
}

/// The word for a room: its name if unique, or its id.
pub(crate) fn room_word(plan: &Plan, id: RoomId) -> String {
    let name = plan.room(id).map_or("", |room| room.name.as_str());
    if room(plan, name) == Ok(id) && is_own_word(name) { name.to_owned() } else { id.to_string() }
}

/// Whether a name parses as one whole word.
pub(crate) fn is_own_word(name: &str) -> bool {
    name.trim() == name && name.parse::<RoomId>().is_err()
}
