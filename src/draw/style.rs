use super::{LabelColours, Palette, Theme};
use crate::base::units::{METRES_PER_FOOT, METRES_PER_INCH, Units};

/// How a plan is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Style {
    pub theme: Theme,
    pub label_colours: LabelColours,
    pub fill: Fill,
    /// Opacity of the rooms' fills, 0 to 1: below 1 where a backdrop lies beneath.
    pub fill_opacity: f64,
    /// Whether text gets a halo: where a backdrop lies beneath.
    pub halo: bool,
    /// Font size of rooms' names in logical pixels where there is space; in tight rooms it shrinks,
    /// never below [`SMALLEST_TEXT_PX`].
    pub text_px: f64,
    /// In which areas are written.
    pub units: Units,
    /// Distance of the grid's lines in metres; `None` chooses it by the zoom.
    pub grid_m: Option<f64>,
    pub layers: Layers,
}

/// No text is drawn smaller, in logical pixels: what does not fit at this size is left out.
pub const SMALLEST_TEXT_PX: f64 = 9.0;

/// Lines of the grid are at least so many pixels apart.
const CLOSEST_GRID_PX: f64 = 12.0;

/// The lines of the grid at a zoom.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// Distance of the lines in metres.
    pub step_m: f64,
    /// Each of so many is a stronger one.
    pub lines: i64,
}

/// What a room's fill shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Fill {
    #[default]
    Label,
    Function,
    /// The label that a classifier predicts; where a known label is another, its colour rims the room.
    Prediction,
    None,
}

impl Fill {
    pub const ALL: [Self; 4] = [Self::Label, Self::Function, Self::Prediction, Self::None];

    /// The word for the command line and for people.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Label => "label",
            Self::Function => "function",
            Self::Prediction => "prediction",
            Self::None => "none",
        }
    }
}

/// Which parts are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layers {
    pub grid: bool,
    pub rooms: bool,
    pub walls: bool,
    pub openings: bool,
    pub graph: bool,
    /// Rooms' names, or their functions where they have none.
    pub names: bool,
    /// Rooms' areas, below the names.
    pub areas: bool,
}

impl Default for Layers {
    fn default() -> Self {
        Self { grid: false, rooms: true, walls: true, openings: true, graph: false, names: true, areas: true }
    }
}

impl Default for Style {
    fn default() -> Self {
        Self {
            theme: Theme::Light,
            label_colours: LabelColours::Standard,
            fill: Fill::Label,
            fill_opacity: 1.0,
            halo: false,
            text_px: 13.0,
            units: Units::Metric,
            grid_m: None,
            layers: Layers::default(),
        }
    }
}

impl Style {
    pub const fn palette(&self) -> &'static Palette {
        Palette::of(self.theme, self.label_colours)
    }

    /// The grid's lines at a zoom; `None` where they would be too close. Of a set distance, where that is
    /// too close, every tenth line.
    pub fn grid(&self, px_per_m: f64) -> Option<Grid> {
        let step = |step_m: f64, lines: i64| Grid { step_m, lines };
        let steps = match (self.grid_m, self.units) {
            (Some(set_m), _) => [1.0, 10.0, 100.0, 1000.0, 10_000.0].map(|times| step(set_m * times, 10)),
            (None, Units::Metric) => [0.1, 1.0, 10.0, 100.0, 1000.0].map(|step_m| step(step_m, 10)),
            (None, Units::Imperial) => [
                step(METRES_PER_INCH, 12),
                step(METRES_PER_FOOT, 10),
                step(10.0 * METRES_PER_FOOT, 10),
                step(100.0 * METRES_PER_FOOT, 10),
                step(1000.0 * METRES_PER_FOOT, 10),
            ],
        };
        steps.into_iter().find(|grid| grid.step_m * px_per_m >= CLOSEST_GRID_PX)
    }
}
