//! Renderings of plans: one small picture per behaviour, compared pixel for pixel with its reference
//! under `tests/pictures/`; what must hold for every plan; the command.
#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod cases;
mod command;
mod every_plan;
mod sketch;
