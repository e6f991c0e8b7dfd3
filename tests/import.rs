//! Reading the authors' XML, and the import of files and folders.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test fails by panicking")]

#[path = "import/broken.rs"]
mod broken;
#[path = "import/cases.rs"]
mod cases;
#[path = "import/command.rs"]
mod command;
#[path = "import/golden.rs"]
mod golden;
#[path = "import/real.rs"]
mod real;
