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

/// The table of everyday jobs holds what the script that does them counts.
pub fn counts_gestures_as_they_are() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let script = std::fs::read_to_string(root.join("tests/replay/cases/gestures/script.replay")).unwrap();
    let page = std::fs::read_to_string(root.join("docs/gestures.md")).unwrap();
    let mut job = String::new();
    let mut jobs = 0;
    for line in script.lines() {
        let numbered = line.strip_prefix("# ").and_then(|line| line.split_once(". "));
        if let Some((number, title)) = numbered.filter(|(number, _)| number.parse::<u32>().is_ok()) {
            job = format!("| {number} | {title} | ");
        } else if let Some(counted) = line.strip_prefix("expect gestures ") {
            let counts: Vec<u32> = counted.split(' ').map(|count| count.parse().unwrap()).collect();
            let row = format!("{job}{} ({} + {}) |", counts[0] + counts[1], counts[0], counts[1]);
            assert!(page.contains(&row), "docs/gestures.md lacks the row {row}");
            jobs += 1;
        }
    }
    assert_eq!(jobs, 20);
}
