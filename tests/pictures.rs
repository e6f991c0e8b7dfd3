//! Pictures of plans: one small picture a behaviour, compared pixel for pixel with its reference under
//! `tests/pictures/`; what must hold for every plan; the command.
#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

#[path = "pictures/cases.rs"]
mod cases;
#[path = "pictures/command.rs"]
mod command;
#[path = "pictures/every_plan.rs"]
mod every_plan;
#[path = "pictures/sketch.rs"]
mod sketch;
mod support;
