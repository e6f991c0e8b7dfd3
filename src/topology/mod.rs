//! Which rooms an opening joins, the graph of rooms that follows, and the faces that walls enclose.

mod across;
mod arrangement;
mod draw;
mod exact;
mod faces;
mod fill;
mod free_space;
mod gaps;
mod graph;
mod merge;
mod offset;
mod shapes;
mod snap;

pub use across::{Across, room_around, split_rooms, straight_across};
pub use arrangement::{Arrangement, ArrangementError, NodeIndex};
pub use draw::{Drawn, cut_out, draw_room, draw_walls, split_room};
pub use faces::{Face, faces};
pub use fill::{Filled, PlanFace, PlanFaces, SLIVER_WIDTH_M, fill_all, fill_at};
pub use free_space::{GAP_BETWEEN_ROOMS_M, draw_room_in_free_space};
pub use gaps::{DOORWAY_WIDTH_M, Gap, bridge_gaps, gaps};
pub use graph::{Connection, Graph, OpeningPreview, opening_preview, sides_by_geometry};
pub use merge::merge_rooms;
pub use offset::{offset_room, offset_walls};
pub use shapes::{RoomShape, RoomShapes};
pub use snap::{PASSINGS_LIMIT, TESTS_LIMIT};
