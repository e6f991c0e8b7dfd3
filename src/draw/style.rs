use super::{LabelColours, Palette, Theme};

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
    pub layers: Layers,
}

/// No text is drawn smaller, in logical pixels: what does not fit at this size is left out.
pub const SMALLEST_TEXT_PX: f64 = 9.0;

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
            layers: Layers::default(),
        }
    }
}

impl Style {
    pub const fn palette(&self) -> &'static Palette {
        Palette::of(self.theme, self.label_colours)
    }
}
