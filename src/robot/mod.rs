//! The robot: from laser scans to a plan (section 3.3 of the paper).
//!
//! Scans become line segments ([`split_and_merge`]), segments a [`line_map`], a line map rooms.
//! The frame of a map is that of the robot's first pose; metres and radians throughout.

pub mod bridges;
pub mod calibration;
pub mod carmen;
pub mod correlation;
pub mod doorways;
pub mod explore;
pub mod explored_plan;
pub mod free_space;
pub mod frontiers;
pub mod furniture;
pub mod grid_map;
pub mod grid_plan;
pub mod grid_rooms;
pub mod line_map;
pub mod lines;
pub mod log_map;
pub mod log_replay;
pub mod loop_closing;
pub mod map_server;
pub mod mapper;
pub mod matching;
pub mod occupancy;
pub mod odometry;
pub mod pose;
pub mod pose_graph;
pub mod quadrilaterals;
pub mod ray_grid;
pub mod rooms;
pub mod route;
pub mod scan;
pub mod scanner;
pub mod score;
pub mod segment;
pub mod semantics;
pub mod split_and_merge;
mod width_changes;
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
