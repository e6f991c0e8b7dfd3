use std::path::{Path, PathBuf};

use crate::support;

/// A file beside this one.
pub fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/check").join(name)
}

/// Compares a text with the file of this name beside this one, see [`support::assert_text`].
pub fn assert_golden(name: &str, actual: &str) {
    support::assert_text(&fixture(name), actual);
}
