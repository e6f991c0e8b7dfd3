//! Which rooms an opening joins, the graph of rooms that follows, and the faces that walls enclose.

mod across;
mod arrangement;
mod draw;
mod exact;
mod faces;
mod fill;
mod graph;
mod shapes;
mod snap;

pub use across::{room_around, split_rooms};
pub use arrangement::{Arrangement, ArrangementError, NodeIndex};
pub use draw::{Drawn, cut_out, draw_room, draw_walls, split_room};
pub use faces::{Face, faces};
pub use fill::{Filled, PlanFace, PlanFaces, SLIVER_WIDTH_M, fill_all, fill_at};
pub use graph::{Connection, Graph, OpeningPreview, opening_preview, sides_by_geometry};
pub use shapes::{RoomShape, RoomShapes};
pub use snap::{PASSINGS_LIMIT, TESTS_LIMIT};
