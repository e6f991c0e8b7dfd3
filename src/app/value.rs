//! What commands take, as values: what tools, the canvas and panels hand over, and what scripts, the palette
//! and recordings write as words.

use std::path::PathBuf;

use crate::app::look::keys::Keys;
use crate::app::session::{bulk::Order, origin::bundled, selection::SelectMode};
use crate::classify::Method;
use crate::edit::{Alignment, DrawingMoves, storey::Keep};
use crate::formats;
use crate::geometry::{COORDINATE_LIMIT_M, Point};
use crate::labels::Typology;
use crate::plan::{ElementId, GuideAxis, OpeningId, OpeningKind, Plan, Room, RoomId};
use crate::predict::ModelSet;

/// An argument that was read.
#[derive(Clone, Debug)]
pub(crate) enum Value {
    Path(PathBuf),
    Text(String),
    Number(f64),
    Count(usize),
    Room(RoomId),
    Opening(OpeningId),
    Elements(Vec<ElementId>),
    Points(Vec<Point>),
    Typology(Option<Typology>),
    ModelSet(ModelSet),
    Method(Method),
    /// Its index.
    Sample(usize),
    Switch(bool),
    Word(&'static str),
    /// A command's id.
    Command(&'static str),
    Keys(Keys),
}

/// The arguments of a call, read. Those left out are missing at the end.
#[derive(Clone, Debug, Default)]
pub(crate) struct Values(pub(crate) Vec<Value>);

/// A command to run: its id, and its arguments in the order in which it takes them.
#[derive(Clone, Debug)]
pub(crate) struct Call {
    pub id: &'static str,
    pub values: Vec<Value>,
}

impl Call {
    pub(crate) fn new(id: &'static str, values: impl IntoIterator<Item = Value>) -> Self {
        Self { id, values: values.into_iter().collect() }
    }
}

impl Value {
    /// Points on the 0.1 mm grid, as their words have them.
    pub(crate) fn points(points: &[Point]) -> Self {
        Self::Points(points.iter().map(|point| point.trimmed()).collect())
    }

    /// One point on the 0.1 mm grid.
    pub(crate) fn point(point: Point) -> Self {
        Self::points(&[point])
    }

    /// One of several things that have words.
    pub(crate) fn word<T: Worded + PartialEq>(thing: T) -> Self {
        let index = T::ALL.iter().position(|one| *one == thing);
        Self::Word(index.and_then(|index| T::WORDS.get(index)).map_or("", |(word, _)| word))
    }
}

/// One of several things, each with a word.
pub(crate) trait Worded: Copy + 'static {
    /// Each with its word and its title, in the order in which they are offered.
    const WORDS: &'static [(&'static str, &'static str)];
    /// The things, in the same order.
    const ALL: &'static [Self];

    /// The thing that a word means.
    fn of_its_word(word: &str) -> Option<Self> {
        let index = Self::WORDS.iter().position(|(own, _)| *own == word)?;
        Self::ALL.get(index).copied()
    }
}

impl Worded for OpeningKind {
    const WORDS: &'static [(&'static str, &'static str)] =
        &[("door", "Door"), ("double-door", "Double door"), ("passage", "Passage"), ("window", "Window")];
    const ALL: &'static [Self] = &[Self::Door, Self::DoubleDoor, Self::Passage, Self::Window];
}

impl Worded for SelectMode {
    const WORDS: &'static [(&'static str, &'static str)] =
        &[("replace", "Instead of what is selected"), ("add", "Besides"), ("toggle", "Take out what is in")];
    const ALL: &'static [Self] = &[Self::Replace, Self::Add, Self::Toggle];
}

impl Worded for GuideAxis {
    const WORDS: &'static [(&'static str, &'static str)] = &[("horizontal", "Horizontal"), ("vertical", "Vertical")];
    const ALL: &'static [Self] = &[Self::Horizontal, Self::Vertical];
}

impl Worded for Keep {
    const WORDS: &'static [(&'static str, &'static str)] = Keep::WORDS;
    const ALL: &'static [Self] = &[Self::Functions, Self::All, Self::Outlines];
}

impl Worded for DrawingMoves {
    const WORDS: &'static [(&'static str, &'static str)] = DrawingMoves::WORDS;
    const ALL: &'static [Self] = &[Self::Along, Self::Stays];
}

impl Worded for Order {
    const WORDS: &'static [(&'static str, &'static str)] = Order::WORDS;
    const ALL: &'static [Self] = &[Self::Rows, Self::Columns];
}

impl Worded for Alignment {
    const WORDS: &'static [(&'static str, &'static str)] = &[
        ("left", "Left sides"),
        ("right", "Right sides"),
        ("top", "Upper sides"),
        ("bottom", "Lower sides"),
        ("centre", "Middles, on an upright line"),
        ("middle", "Middles, on a level line"),
    ];
    const ALL: &'static [Self] = &[Self::Left, Self::Right, Self::Top, Self::Bottom, Self::Center, Self::Middle];
}

/// What a new room takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Space {
    /// All within its boundary.
    Exact,
    /// What no room covers of it.
    Free,
}

impl Worded for Space {
    const WORDS: &'static [(&'static str, &'static str)] =
        &[("exact", "This boundary"), ("free", "What no room covers of it")];
    const ALL: &'static [Self] = &[Self::Exact, Self::Free];
}

/// What a box selects.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Boxed {
    /// What lies within it.
    Inside,
    /// Also what it touches.
    Touching,
}

impl Worded for Boxed {
    const WORDS: &'static [(&'static str, &'static str)] = &[("inside", "Inside"), ("touching", "Touching")];
    const ALL: &'static [Self] = &[Self::Inside, Self::Touching];
}

/// A direction on the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Direction {
    Left,
    Right,
    Up,
    Down,
}

impl Worded for Direction {
    const WORDS: &'static [(&'static str, &'static str)] =
        &[("left", "Left"), ("right", "Right"), ("up", "Up"), ("down", "Down")];
    const ALL: &'static [Self] = &[Self::Left, Self::Right, Self::Up, Self::Down];
}

// Words.

/// Of rooms that have the same name not more are told.
const MOST_TOLD: usize = 3;

/// The word for a plan without a typology.
pub(crate) const UNKNOWN: &str = "unknown";

pub(crate) const fn switch_word(is_on: bool) -> &'static str {
    if is_on { "on" } else { "off" }
}

/// The word for a plan that comes with the program.
pub(crate) fn sample_word(index: usize) -> &'static str {
    bundled().get(index).map_or("", |(name, _)| formats::file_stem(name))
}

/// The room that a word means. `Err(Some(…))` says why a word that names several rooms means none.
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
            Err(Some(format!("an id, for {} rooms have this name: {}{more}", several.len(), ids.join(", "))))
        }
    }
}

/// The element that a word means.
pub(crate) fn element(plan: &Plan, word: &str) -> Option<ElementId> {
    let id = match word.chars().next()? {
        'c' => word.parse().ok().map(ElementId::Corner),
        'w' => word.parse().ok().map(ElementId::Wall),
        'o' => word.parse().ok().map(ElementId::Opening),
        _ => None,
    };
    id.or_else(|| room(plan, word).ok().map(ElementId::Room)).filter(|&element| plan.has(element))
}

/// The word for some elements.
pub(crate) fn elements_word(elements: impl IntoIterator<Item = ElementId>) -> String {
    let words: Vec<String> = elements.into_iter().map(|element| element.to_string()).collect();
    words.join(" ")
}

/// The point that a word means.
pub(crate) fn point(word: &str) -> Option<Point> {
    let (x, y) = word.split_once(',')?;
    let point = Point::new(x.parse().ok()?, y.parse().ok()?);
    (point.is_finite() && point.x.abs() <= COORDINATE_LIMIT_M && point.y.abs() <= COORDINATE_LIMIT_M).then_some(point)
}

/// The word for some points, on the 0.1 mm grid.
pub(crate) fn points_word(points: &[Point]) -> String {
    let words: Vec<String> = points.iter().map(|point| point.trimmed()).map(|p| format!("{},{}", p.x, p.y)).collect();
    words.join(" ")
}

/// The word for a room: its name, where that means no other room, or its id.
pub(crate) fn room_word(plan: &Plan, id: RoomId) -> String {
    let name = plan.room(id).map_or("", |room| room.name.as_str());
    if room(plan, name) == Ok(id) && is_own_word(name) { name.to_owned() } else { id.to_string() }
}

/// Whether a name is read as a name, and whole.
pub(crate) fn is_own_word(name: &str) -> bool {
    name.trim() == name && name.parse::<RoomId>().is_err()
}
