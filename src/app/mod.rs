//! The window: canvas, commands, panels, theme.
//!
//! [`App`] is the whole window apart from any display: it takes egui's input and returns shapes.
//! [`run_window`] shows it on a screen; [`Offscreen`] drives the same window without one.
//!
//! The floors, from the ground: `look`, `paint`, `session`, `value`, `tools`, `canvas`, `state`, `commands`, `panels`,
//! `frame`; above these `native`, `offscreen` and `replay`.

mod canvas;
pub mod commands;
mod frame;
mod look;
mod native;
mod offscreen;
mod paint;
mod panels;
pub mod replay;
mod session;
mod state;
mod tools;
mod value;

pub use commands::{CommandError, Executed};
pub use look::icons::Icon;
pub use look::theme::ThemeChoice;
pub use native::{WindowError, WindowOptions, run_window};
pub use offscreen::controls::Control;
pub use offscreen::raster::Raster;
pub use offscreen::{NotSettled, Offscreen, OffscreenOptions};
pub use session::messages::{Message, Remedy, Severity};
pub use session::selection::{SelectMode, Selection};
pub use state::App;
