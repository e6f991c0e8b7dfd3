//! Backdrops: reading any kind of file, bad ones included; their position, scale and path; how they are
//! shown in the window and by `enfilade render`.
#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]
#![allow(clippy::print_stdout, reason = "says why it was skipped")]
#![allow(clippy::disallowed_methods, reason = "a test's files are no user's")]

mod apart;
mod files;
mod mutated;
mod outside;
mod pdf;
mod read;
mod real;
mod render;
mod scan;
mod tiff;
#[cfg(feature = "gui")]
mod window;
