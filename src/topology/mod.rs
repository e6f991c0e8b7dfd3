//! What follows from a plan by geometry: the shapes of its rooms, the graph of the rooms that openings
//! join, gaps in walls, and the faces that walls enclose.

mod gaps;
mod graph;
pub(crate) mod plan_faces;
mod shapes;

pub use gaps::{DOORWAY_WIDTH_M, Gap, gaps};
pub use graph::{Connection, Graph, sides_by_geometry};
pub use plan_faces::{PlanFace, PlanFaces, SLIVER_WIDTH_M};
pub use shapes::{RoomShape, RoomShapes};
