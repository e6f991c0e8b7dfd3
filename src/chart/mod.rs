//! Charts: data, axes, marks and a legend, without any window. A chart becomes a scene ([`Chart::scene`]), which the window
//! paints and [`crate::draw`] writes as PNG and SVG, and a table ([`Chart::csv`]).

mod layout;
pub mod rooms;
mod table;
mod ticks;

pub use layout::Layout;
pub use ticks::{Tick, ticks};

use crate::draw::{Palette, Rgba};
use crate::labels::Label;

/// A chart: what it shows, and how it is to be read.
#[derive(Clone, Debug, PartialEq)]
pub struct Chart {
    pub title: String,
    /// What is good to know of it, in a sentence; may be empty.
    pub note: String,
    pub across: Axis,
    pub up: Axis,
    pub series: Vec<Series>,
    /// Whether the series are named above the chart.
    pub has_legend: bool,
}

/// An axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// What it counts, with its unit; empty where the names along it say enough.
    pub title: String,
    pub scale: Scale,
    /// Its ends, if they do not follow from the data.
    pub range: Option<[f64; 2]>,
}

/// How values lie along an axis.
#[derive(Clone, Debug, PartialEq)]
pub enum Scale {
    Linear,
    /// Shares, 0..=1, told as percentages.
    Share,
    /// Counts: marks are spread a little about each whole number, since many would cover each other.
    Whole,
    /// Values above 0, equal ratios equally far apart.
    Log,
    /// One name at each whole number from 0.
    Named(Vec<String>),
}

impl Axis {
    pub fn new(title: &str, scale: Scale) -> Self {
        Self { title: title.to_owned(), scale, range: None }
    }

    /// With these ends.
    #[must_use]
    pub fn from_to(self, from: f64, to: f64) -> Self {
        Self { range: Some([from, to]), ..self }
    }
}

/// Marks of one colour.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    pub name: String,
    pub ink: Ink,
    pub marks: Marks,
}

/// The colour of a series, by what it shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ink {
    /// That of a label.
    Label(Label),
    Accent,
    Muted,
    /// One of several that have no colour of their own.
    Number(usize),
}

impl Ink {
    /// The colour for dots, lines and bars.
    pub fn colour(self, palette: &Palette) -> Rgba {
        match self {
            Self::Label(label) => palette.label_strong(label),
            Self::Accent => palette.selection,
            Self::Muted => palette.boundary,
            Self::Number(number) => {
                let inks = [
                    palette.selection,
                    palette.labels_strong[2],
                    palette.labels_strong[3],
                    palette.labels_strong[0],
                    palette.graph_edge,
                    palette.labels_strong[1],
                ];
                inks[number % inks.len()]
            }
        }
    }
}

/// How a series is drawn.
#[derive(Clone, Debug, PartialEq)]
pub enum Marks {
    Bars(Vec<Bar>),
    Dots(Vec<Dot>),
    Line(Vec<Point>),
    /// Short lines across, such as a reference for each bar.
    Levels(Vec<Bar>),
}

/// A bar: a rectangle on both axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Bar {
    pub across: [f64; 2],
    pub up: [f64; 2],
    /// What it says, for people who point at it or cannot see it.
    pub said: String,
}

/// One thing with a value on each axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Dot {
    pub across: f64,
    pub up: f64,
    /// What it is: an index that its owner knows.
    pub key: usize,
}

/// A point of a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    pub across: f64,
    pub up: f64,
    /// Drawn as a whisker up and down; 0 for none.
    pub deviation: f64,
}

impl Chart {
    /// Whether there is nothing to draw.
    pub fn is_empty(&self) -> bool {
        self.series.iter().all(|series| match &series.marks {
            Marks::Bars(bars) | Marks::Levels(bars) => bars.is_empty(),
            Marks::Dots(dots) => dots.is_empty(),
            Marks::Line(points) => points.is_empty(),
        })
    }

    /// What it shows, in words, for people who cannot see it.
    pub fn said(&self) -> String {
        let bars = self.series.iter().filter_map(|series| match &series.marks {
            Marks::Bars(bars) => Some(bars),
            Marks::Dots(_) | Marks::Line(_) | Marks::Levels(_) => None,
        });
        // A long list is no description: the table has it.
        let told: Vec<&str> =
            bars.flatten().map(|bar| bar.said.as_str()).filter(|said| !said.is_empty()).take(12).collect();
        let told = if told.is_empty() { self.note.clone() } else { told.join("; ") };
        if told.is_empty() { self.title.clone() } else { format!("{}. {told}", self.title) }
    }
}
