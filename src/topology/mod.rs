//! What a plan's geometry implies: the shapes of its rooms, the graph of rooms joined by openings, gaps
//! in walls, the faces enclosed by walls, the bodies of walls, and the clear areas between them.

mod gaps;
mod graph;
mod net_areas;
pub(crate) mod plan_faces;
mod shapes;
pub mod vertical;
pub mod wall_bodies;

pub use gaps::{DOORWAY_WIDTH_M, Gap, gaps};
pub use graph::{Connection, Graph, sides_by_geometry};
pub use net_areas::{NetRoom, net_of, net_rooms, net_rooms_between};
pub use plan_faces::{PlanFace, PlanFaces, SLIVER_WIDTH_M};
pub use shapes::{RoomShape, RoomShapes};
