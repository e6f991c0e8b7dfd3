//! Reading the authors' XML and that of the KTH campus, and the import of files and folders.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test fails by panicking")]

mod broken;
mod cases;
mod command;
mod golden;
mod kth;
mod real;
