//! Faces of arrangements, and rooms from walls.

#[path = "faces/arrangements.rs"]
mod arrangements;
#[path = "faces/families.rs"]
mod families;
#[path = "faces/rooms.rs"]
mod rooms;
#[path = "faces/sums.rs"]
mod sums;
