use std::path::{Path, PathBuf};

/// A file or folder beside this one.
pub fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/import").join(name)
}

/// Compares a text with a golden file; `None` when there must be no such file. On a difference the
/// text is written beside it as `….out.txt` and the difference told; with `UPDATE_GOLDEN=1` in the
/// environment it becomes the golden file.
#[expect(clippy::disallowed_methods, reason = "a test's output is no user's file")]
pub fn compare(golden: &Path, actual: Option<&str>) -> Result<(), String> {
    let out = golden.with_extension("out.txt");
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        match actual {
            Some(actual) => std::fs::write(golden, actual).unwrap(),
            None => drop(std::fs::remove_file(golden)),
        }
    }
    let expected = std::fs::read_to_string(golden).ok();
    if expected.as_deref() == actual {
        let _ = std::fs::remove_file(&out);
        return Ok(());
    }
    std::fs::write(&out, actual.unwrap_or_default()).unwrap();
    Err(format!(
        "{} differs from {}; look at the difference, then run with UPDATE_GOLDEN=1",
        out.display(),
        golden.display()
    ))
}
