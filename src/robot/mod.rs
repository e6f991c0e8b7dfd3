//! The robot: from laser scans to a plan (section 3.3 of the paper).
//!
//! Scans become line segments ([`split_and_merge`]), segments a [`line_map`], a line map rooms.
//! The frame of a map is that of the robot's first pose; metres and radians throughout.

pub mod furniture;
pub mod lines;
pub mod odometry;
pub mod pose;
pub mod ray_grid;
pub mod scan;
pub mod scanner;
pub mod world;

pub use lines::{LineSegment, Moments};
pub use pose::Pose;
pub use scan::Scan;
pub use scanner::Scanner;
pub use world::{World, WorldOptions};
