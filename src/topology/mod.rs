//! What a plan's geometry implies: the shapes of its rooms, the graph of rooms joined by openings, gaps
//! in walls, and the faces enclosed by walls.

mod gaps;
mod graph;
pub(crate) mod plan_faces;
mod shapes;

pub use gaps::{DOORWAY_WIDTH_M, Gap, gaps};
pub use graph::{Connection, Graph, sides_by_geometry};
pub use plan_faces::{PlanFace, PlanFaces, SLIVER_WIDTH_M};
pub use shapes::{RoomShape, RoomShapes};
