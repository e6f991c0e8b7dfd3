//! Pictures as pixels: in memory, at several sizes, as PNG. It knows no plans and no files.

mod image;
mod levels;
pub mod png;

pub use image::{Difference, Picture};
pub use levels::{Level, PictureLevels, Samples};
