//! Plan files and GeoJSON: what is written reads back, what is broken is refused in words.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test fails by panicking")]

#[path = "formats/golden.rs"]
mod golden;
#[path = "formats/plan_json.rs"]
mod plan_json;
