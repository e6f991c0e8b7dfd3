use std::path::{Path, PathBuf};

/// A file beside this one.
pub fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/check").join(name)
}

/// Compares a text with the golden file of this name. On a difference the text is written beside it
/// as `….out.txt`; with `UPDATE_GOLDEN=1` in the environment it becomes the golden file.
#[expect(clippy::disallowed_methods, reason = "a test's output is no user's file")]
pub fn assert_golden(name: &str, actual: &str) {
    let golden = fixture(name);
    let out = golden.with_extension("out.txt");
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        std::fs::write(&golden, actual).unwrap();
    }
    if std::fs::read_to_string(&golden).unwrap_or_default() == actual {
        let _ = std::fs::remove_file(&out);
        return;
    }
    std::fs::write(&out, actual).unwrap();
    panic!(
        "{} differs from {}; look at the difference, then run with UPDATE_GOLDEN=1",
        out.display(),
        golden.display()
    );
}
