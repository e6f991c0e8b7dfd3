use std::io::Cursor;
use std::path::{Path, PathBuf};

use enfilade::picture::Picture;

/// A file beside this one.
pub fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/commands").join(name)
}

/// No golden picture is larger: they stay in the repository for good.
const MOST_BYTES: usize = 200_000;

/// Compares a picture with the golden one of this name, pixel by pixel. On a difference the picture
/// is written beside it as `….out.png`, and what differs as `….diff.png`; with `UPDATE_GOLDEN=1` in
/// the environment the picture becomes the golden one.
#[expect(clippy::disallowed_methods, reason = "a test's output is no user's file")]
pub fn assert_picture(name: &str, actual: &Picture) {
    let golden = fixture(&format!("{name}.png"));
    let (out, diff) = (golden.with_extension("out.png"), golden.with_extension("diff.png"));
    for stale in [&out, &diff] {
        let _ = std::fs::remove_file(stale);
    }
    let expected = std::fs::read(&golden).ok().map(|bytes| Picture::from_png(Cursor::new(bytes), 1 << 24).unwrap());
    let difference = match &expected {
        Some(expected) => match expected.difference(actual) {
            None => return,
            difference => difference,
        },
        None => None,
    };
    let bytes = actual.to_png().unwrap();
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        assert!(bytes.len() <= MOST_BYTES, "{name}: {} bytes are too many", bytes.len());
        std::fs::write(&golden, bytes).unwrap();
        return;
    }
    std::fs::write(&out, bytes).unwrap();
    let what = match difference {
        None => "there is no golden picture".to_owned(),
        Some(difference) => {
            std::fs::write(&diff, difference.picture.to_png().unwrap()).unwrap();
            format!("{} pixels differ, by up to {} (see {})", difference.pixels, difference.largest, diff.display())
        }
    };
    panic!("{}: {what}; look at it, then run with UPDATE_GOLDEN=1", out.display());
}
