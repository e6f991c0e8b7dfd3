//! The window: canvas, commands, tools, panels, theme.

pub mod raster;
