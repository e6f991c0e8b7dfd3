//! The joint classifier and the inference of typologies: on generated plans, on damaged models, and on
//! real buildings with recorded bounds. `cargo test --release --test library joint:: -- --ignored --nocapture`
//! prints the tables of `docs/joint.md`.
#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]
#![allow(clippy::print_stdout, reason = "says why it was skipped, and what it measured")]

mod classifier;
mod generated;
mod real;
mod typology;
mod unknown;
