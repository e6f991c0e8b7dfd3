//! The library and its subcommands, without a window: one module per subject, with its files beside it.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test fails by panicking")]
#![allow(clippy::disallowed_methods, reason = "a test's files are no user's")]
#![allow(clippy::print_stdout, reason = "a test says what it skips and measures")]

mod backdrop;
mod bundled_plans;
mod check;
mod classify;
mod commandline;
mod edits;
mod faces;
mod features;
mod formats;
mod house;
mod import;
mod joint;
mod pictures;
mod pipeline;
mod review;
mod robot;
mod study;
mod support;
mod workspace;
