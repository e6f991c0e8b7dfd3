//! Numbers that people type come through the one reader (`base/units`): the window and the command line read none by
//! themselves, and no control of the toolkit does.

use std::path::Path;

/// What reads a number past the reader.
const BANNED: &[&str] = &["parse::<f64>", "parse::<f32>", "DragValue", "from_str_radix"];

/// The files that may: and why.
const MAY: &[(&str, &str)] =
    &[("app/replay/words.rs", "scripts write pixels and seconds, which no person types in a field")];

#[test]
fn no_number_is_read_past_the_reader() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut read = 0;
    for folder in ["app", "cli"] {
        for entry in walkdir::WalkDir::new(root.join(folder)).sort_by_file_name() {
            let entry = entry.unwrap();
            if entry.path().extension().is_none_or(|ending| ending != "rs") {
                continue;
            }
            read += 1;
            let name = entry.path().strip_prefix(&root).unwrap().to_string_lossy().replace('\\', "/");
            let text = std::fs::read_to_string(entry.path()).unwrap();
            let found = BANNED.iter().find(|banned| text.contains(**banned));
            let may = MAY.iter().any(|(file, _)| *file == name);
            assert!(found.is_none() || may, "{name} has {found:?}: read what people type with base::units");
        }
    }
    assert!(read > 100, "{read}");
}
