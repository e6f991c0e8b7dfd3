//! Faces of arrangements, and rooms from walls.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot go on fails")]

#[path = "faces/arrangements.rs"]
mod arrangements;
#[path = "faces/families.rs"]
mod families;
#[path = "faces/rooms.rs"]
mod rooms;
#[path = "faces/sums.rs"]
mod sums;
