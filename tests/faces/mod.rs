//! Faces of arrangements, and rooms from walls.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot go on fails")]

mod arrangements;
mod families;
mod rooms;
mod sums;
