//! Plan files and GeoJSON: what is written reads back, what is broken is refused in words.
#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]
#![allow(clippy::print_stdout, reason = "a skipped test says so")]

#[path = "formats/broken.rs"]
mod broken;
#[path = "formats/docs.rs"]
mod docs;
#[path = "formats/generated.rs"]
mod generated;
#[path = "formats/geojson.rs"]
mod geojson;
#[path = "formats/golden.rs"]
mod golden;
#[path = "formats/plan_json.rs"]
mod plan_json;
#[path = "formats/real.rs"]
mod real;
#[path = "formats/store.rs"]
mod store;
mod support;
