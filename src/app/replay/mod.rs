//! Replay scripts: user actions in the window, written down line by line, repeated without a display, and
//! checked.
//!
//! A script drives the same [`App`](crate::app::state::App) that users see, through
//! [`Offscreen`](crate::app::offscreen::Offscreen): the same input events, a clock of its own, dialogs
//! answered in advance. [`find_scripts`] finds scripts, [`replay`] runs one, [`guide`] describes the
//! language from the table of verbs.

mod act;
mod fault;
mod folders;
mod guide;
mod place;
mod record;
mod run;
mod script;
mod seen;
mod snapshot;
mod stage;
mod verbs;
mod words;

pub use guide::guide;
pub use run::{Failure, FindError, ReplayOptions, Report, ScriptFile, find_scripts, replay, replay_telling};
pub use script::{LARGEST_BYTES, Script, SyntaxError};
