//! Which rooms an opening joins, and the graph of rooms that follows.

mod graph;
mod shapes;

pub use graph::{Connection, Graph};
pub use shapes::{RoomShape, RoomShapes};
