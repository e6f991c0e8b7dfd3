use super::{LabelColours, Palette, Theme};
use crate::base::units::{METRES_PER_FOOT, METRES_PER_INCH, Units};

/// How a plan is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Style {
    pub theme: Theme,
    pub label_colours: LabelColours,
    pub fill: Fill,
    /// Opacity of the rooms' fills, 0 to 1: below 1 over a backdrop.
    pub fill_opacity: f64,
    /// Whether text gets a halo: over a backdrop.
    pub halo: bool,
    /// Font size of room names in logical pixels, if there is space; it shrinks in tight rooms, but never
    /// below [`SMALLEST_TEXT_PX`].
    pub text_px: f64,
    /// The units in which areas are shown.
    pub units: Units,
    /// Spacing of the grid in metres; `None` chooses it by the zoom.
    pub grid_m: Option<f64>,
    pub layers: Layers,
}

/// The smallest text, in logical pixels: what does not fit at this size is omitted.
pub const SMALLEST_TEXT_PX: f64 = 9.0;

/// Minimum spacing of grid lines, in pixels.
const CLOSEST_GRID_PX: f64 = 12.0;

/// The grid lines at a zoom.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// Spacing of the lines in metres.
    pub step_m: f64,
    /// Every this many lines, one is stronger.
    pub lines: i64,
}

/// What a room's fill shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Fill {
    #[default]
    Label,
    Function,
    /// The label predicted by a classifier, fainter where it is unsure; if the known label differs, the room is hatched
    /// in its colour.
    Prediction,
    None,
}

impl Fill {
    pub const ALL: [Self; 4] = [Self::Label, Self::Function, Self::Prediction, Self::None];

    /// Its name on the command line and in the interface.
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
    /// Dimension chains.
    pub dimensions: bool,
    /// Room names, or functions for rooms without a name.
    pub names: bool,
    /// Room areas, below the names.
    pub areas: bool,
}

impl Default for Layers {
    fn default() -> Self {
        Self {
            grid: false,
            rooms: true,
            walls: true,
            openings: true,
            graph: false,
            dimensions: true,
            names: true,
            areas: true,
        }
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

    /// The grid lines at a zoom; `None` if they would be too close. If a fixed spacing is too close,
    /// every tenth line.
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
