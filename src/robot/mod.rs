//! The robot: from laser scans to a plan (section 3.3 of the paper).
//!
//! Scans become line segments ([`split_and_merge`]), segments a [`line_map`], a line map rooms.
//! The frame of a map is that of the robot's first pose; metres and radians throughout.

pub mod calibration;
pub mod correlation;
pub mod explore;
pub mod free_space;
pub mod frontiers;
pub mod furniture;
pub mod line_map;
pub mod lines;
pub mod loop_closing;
pub mod mapper;
pub mod matching;
pub mod odometry;
pub mod pose;
pub mod pose_graph;
pub mod ray_grid;
pub mod route;
pub mod scan;
pub mod scanner;
pub mod split_and_merge;
pub mod world;

pub use explore::{Exploration, RobotOptions};
pub use free_space::FreeSpace;
pub use line_map::{LineMap, MapLine};
pub use lines::{LineSegment, Moments};
pub use mapper::{Mapper, MapperOptions};
pub use pose::Pose;
pub use ray_grid::RayGrid;
pub use scan::Scan;
pub use scanner::Scanner;
pub use world::{World, WorldOptions};
