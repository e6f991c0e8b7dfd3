//! Plan files and GeoJSON: written files read back the same, broken ones are rejected with a message.
#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]
#![allow(clippy::print_stdout, reason = "a skipped test says so")]

mod batch;
mod broken;
mod docs;
mod dxf;
mod generated;
mod geojson;
mod golden;
mod others;
mod plan_json;
mod real;
mod registry;
mod sheets;
mod store;
