//! Pictures as pixels: in memory, at several sizes, as PNG. Knows nothing of plans or files.

mod image;
mod levels;
pub mod png;
mod warp;

pub use image::{Difference, Picture};
pub use levels::{Level, PictureLevels, Samples};
#[cfg(feature = "pictures")]
pub(crate) use warp::warped;
