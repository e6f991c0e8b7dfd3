//! Enfilade: draw and label floor plans, classify their rooms by building typology, export datasets.
//!
//! The pipeline is a pure function from a [`plan::Plan`] to rooms, openings, a graph and the
//! features `F_r` of every room. Arrows point up: `geometry` knows nothing, `plan` knows geometry,
//! and so on to `app` and `cli`, which know everything.

#[cfg(feature = "gui")]
pub mod app;
pub mod base;
pub mod check;
pub mod classify;
#[cfg(feature = "cli")]
pub mod cli;
pub mod dataset;
pub mod draw;
pub mod edit;
pub mod features;
pub mod formats;
pub mod geometry;
pub mod labels;
pub mod picture;
pub mod pipeline;
pub mod plan;
pub mod predict;
pub mod robot;
pub mod snapping;
pub mod store;
pub mod study;
pub mod topology;
