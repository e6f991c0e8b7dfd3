//! Values of command arguments: what tools, the canvas and panels pass on, and what scripts, the palette
//! and recordings write as words.

use std::path::PathBuf;

use crate::app::look::keys::Keys;
pub(crate) use crate::app::session::words::{
    UNKNOWN, element, elements_word, is_own_word, point_in, points_word, room, room_word, sample_word, switch_word,
};
use crate::app::session::workspace::shows::Shows;
use crate::app::session::{bulk::Order, selection::SelectMode};
use crate::chart::rooms::ChartKind;
use crate::classify::Method;
use crate::edit::{Alignment, DrawingMoves, End, Lies, Reach, storey::Keep};
use crate::geometry::{Point, Vector};
use crate::labels::{Label, Typology};
use crate::plan::{DimensionAlong, ElementId, GuideAxis, LeafSide, OpeningId, OpeningKind, RoomId};
use crate::predict::ModelSet;

/// A parsed argument.
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
    /// The number of an open plan's document.
    OpenPlan(u64),
    Switch(bool),
    Word(&'static str),
    /// A command's id.
    Command(&'static str),
    /// The id of a side panel.
    SidePanel(&'static str),
    Keys(Keys),
}

/// The parsed arguments of a call. Omitted ones are missing at the end.
#[derive(Clone, Debug, Default)]
pub(crate) struct Values(pub(crate) Vec<Value>);

/// A call of a command: its id, and its arguments in order.
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
    /// Points rounded to the 0.1 mm grid, as they are written.
    pub(crate) fn points(points: &[Point]) -> Self {
        Self::Points(points.iter().map(|point| point.trimmed()).collect())
    }

    /// One point rounded to the 0.1 mm grid.
    pub(crate) fn point(point: Point) -> Self {
        Self::points(&[point])
    }

    /// One of several named things.
    pub(crate) fn word<T: Worded + PartialEq>(thing: T) -> Self {
        let index = T::ALL.iter().position(|one| *one == thing);
        Self::Word(index.and_then(|index| T::WORDS.get(index)).map_or("", |(word, _)| word))
    }
}

/// One of several things, each with a name.
pub(crate) trait Worded: Copy + 'static {
    /// The name and title of each, in the order they are offered.
    const WORDS: &'static [(&'static str, &'static str)];
    /// The things, in the same order.
    const ALL: &'static [Self];

    /// The thing with this name.
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

impl Worded for Label {
    const WORDS: &'static [(&'static str, &'static str)] = &[
        ("small", "Small room"),
        ("medium", "Medium room"),
        ("big", "Big room"),
        ("corridor", "Corridor"),
        ("hall", "Hall"),
    ];
    const ALL: &'static [Self] = &Self::ALL;
}

impl Worded for End {
    const WORDS: &'static [(&'static str, &'static str)] = &[("start", "At its start"), ("end", "At its end")];
    const ALL: &'static [Self] = &Self::BOTH;
}

impl Worded for LeafSide {
    const WORDS: &'static [(&'static str, &'static str)] =
        &[("left", "To the left of its direction"), ("right", "To the right of its direction")];
    const ALL: &'static [Self] = &[Self::Left, Self::Right];
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

impl Worded for Lies {
    const WORDS: &'static [(&'static str, &'static str)] =
        &[("left", "Left of the line"), ("centre", "Centred on the line"), ("right", "Right of the line")];
    const ALL: &'static [Self] = &Self::ALL;
}

impl Worded for DimensionAlong {
    const WORDS: &'static [(&'static str, &'static str)] =
        &[("horizontal", "Level"), ("vertical", "Upright"), ("aligned", "From the first point to the last")];
    const ALL: &'static [Self] = &Self::ALL;
}

impl Worded for ChartKind {
    const WORDS: &'static [(&'static str, &'static str)] = &[
        ("labels", "Labels and their shares"),
        ("histogram", "How often a feature's values occur"),
        ("scatter", "Rooms by two features"),
        ("learning-curve", "Learning curve"),
        ("buildings", "Accuracy by building"),
    ];
    const ALL: &'static [Self] =
        &[Self::Balance, Self::Histogram, Self::Scatter, Self::LearningCurve, Self::ByBuilding];
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

impl Worded for Reach {
    const WORDS: &'static [(&'static str, &'static str)] =
        &[("run", "The whole straight wall"), ("piece", "Only this piece of it")];
    const ALL: &'static [Self] = &[Self::Run, Self::Piece];
}

/// What mirroring, turning and scaling leave behind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum MoveOrCopy {
    Move,
    /// The original stays.
    Copy,
}

impl Worded for MoveOrCopy {
    const WORDS: &'static [(&'static str, &'static str)] =
        &[("move", "Move the selection"), ("copy", "Keep the original and make a copy")];
    const ALL: &'static [Self] = &[Self::Move, Self::Copy];
}

/// What a new room covers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Space {
    /// Everything within its boundary.
    Exact,
    /// The part of it not covered by other rooms.
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
    /// Only what lies inside it.
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

impl Direction {
    /// A step of length 1 that way in the plan.
    pub(crate) const fn vector(self) -> Vector {
        match self {
            Self::Left => Vector::new(-1.0, 0.0),
            Self::Right => Vector::new(1.0, 0.0),
            Self::Up => Vector::new(0.0, 1.0),
            Self::Down => Vector::new(0.0, -1.0),
        }
    }
}

impl Worded for Direction {
    const WORDS: &'static [(&'static str, &'static str)] =
        &[("left", "Left"), ("right", "Right"), ("up", "Up"), ("down", "Down")];
    const ALL: &'static [Self] = &[Self::Left, Self::Right, Self::Up, Self::Down];
}

impl Worded for Shows {
    const WORDS: &'static [(&'static str, &'static str)] = Shows::WORDS;
    const ALL: &'static [Self] = &[Self::Plans, Self::Grid, Self::Rooms];
}
