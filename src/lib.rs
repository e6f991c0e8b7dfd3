//! Enfilade: draw and label floor plans, classify their rooms by building typology, export datasets.
//!
//! Three lines from a file to labels:
//!
//! ```
//! let plan = enfilade::open("plans/office.plan.json")?;
//! let features = plan.analyse();
//! let labels = plan.classify()?;
//! # assert_eq!(features.rooms.len(), plan.plan().rooms().len());
//! # assert!(!labels.labels().is_empty());
//! # Ok::<(), enfilade::Error>(())
//! ```
//!
//! Below that, the pipeline is a pure function from a [`plan::Plan`] to rooms, openings, a graph and the features `F_r` of
//! every room. `geometry` knows nothing, `plan` knows geometry, and so on up to the window (`app`) and the command line
//! (`cli`), which know everything.
//!
//! Cargo features, all on by default: `cli` (the command line, which the program needs), `gui` (the window), `pictures`
//! (readers of scans to trace over; the other two bring it
//! along). `default-features = false` gives the library alone.

#[cfg(feature = "gui")]
pub mod app;
pub mod base;
pub mod chart;
pub mod check;
pub mod classify;
#[cfg(feature = "cli")]
pub mod cli;
pub mod dataset;
pub mod draw;
pub mod edit;
mod facade;
pub mod features;
pub mod formats;
pub mod gather;
pub mod geometry;
pub mod labels;
pub mod picture;
pub mod pipeline;
pub mod plan;
pub mod predict;
pub mod review;
pub mod robot;
pub mod snapping;
pub mod store;
pub mod study;
pub mod topology;
pub mod training;
pub mod workspace;

pub use facade::{Error, OpenPlan, open, open_all};
