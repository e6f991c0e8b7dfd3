//! The window, driven without a display: one module per subject, with its files beside it.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test fails by panicking")]
#![allow(clippy::disallowed_methods, reason = "a test's files are no user's")]

mod commands;
mod recovery;
mod support;
mod tracing;
mod window;
