//! What is painted on the canvas: scenes, backdrops, previews.

pub(crate) mod backdrop;
pub(crate) mod chart;
pub(crate) mod ghost;
pub(crate) mod pending;
pub(crate) mod places;
pub(crate) mod preview;
pub(crate) mod robot;
pub(crate) mod scene_painter;
