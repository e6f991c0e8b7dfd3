//! The manual lists every verb, place and expectation, as the program does.

use std::path::Path;

use crate::support::assert_text;

/// Where the lists begin in the manual.
const HEAD: &str = "as it stands there.\n\n";

pub fn is_complete() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/replay.md");
    let text = std::fs::read_to_string(&path).unwrap();
    let (own, _) = text.split_once(HEAD).expect("the manual has its lists");
    assert_text(&path, &format!("{own}{HEAD}{}\n", enfilade::app::replay::guide().trim_end()));
}
