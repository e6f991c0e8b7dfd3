//! A scene of shapes with units and colours, and its painters: PNG, SVG and PDF. The window paints the same
//! scene.
//!
//! ```text
//! Plan + Analysis ─> Drawing (walls joined, openings cut, symbols; no zoom, no colours)
//!                      │ + Style + View
//!                      v
//!                    Scene ─> PNG, SVG, PDF, the window
//! ```
//!
//! A [`Drawing`] is made once per plan; a [`Scene`] once per view.

mod colour;
pub mod dimensions;
mod drawing;
mod elements;
pub mod font;
pub mod line_map;
mod names;
mod openings;
pub mod palette;
pub mod paper;
pub mod pdf;
pub mod png;
mod robot_colours;
pub mod scene;
pub mod sheet;
mod style;
pub mod svg;
mod tile_grid;
mod tiles;
mod walls;

pub use colour::Rgba;
pub use drawing::{Drawing, FromAfar, predicted_fill};
pub use openings::PlacedOpening;
pub use palette::{LabelColours, Palette, Theme};
pub use robot_colours::RobotColours;
pub use scene::{Anchor, Dash, Frame, Group, Item, Layer, Length, Scene, Text, View, Weight};
pub use style::{Fill, Grid, Layers, SMALLEST_TEXT_PX, Style};
