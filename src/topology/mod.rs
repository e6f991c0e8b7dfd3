//! Which rooms an opening joins, and the graph of rooms that follows.

mod graph;
mod shapes;

pub use graph::{Connection, Graph, sides_by_geometry};
pub use shapes::{RoomShape, RoomShapes};
