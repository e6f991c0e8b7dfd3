//! What the documentation says about the architecture matches the code.

use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn page(name: &str) -> String {
    std::fs::read_to_string(root().join("docs").join(name)).unwrap()
}

/// What stands between backticks.
fn quoted(text: &str) -> Vec<&str> {
    text.split('`').skip(1).step_by(2).collect()
}

/// Whether a path below the repository, or below `src`, is there.
fn exists(path: &str) -> bool {
    [root().join(path), root().join("src").join(path)].iter().any(|path| path.exists())
        || root().join("src").join(format!("{path}.rs")).exists()
}

#[test]
fn every_thing_that_can_be_added_is_added_where_the_page_says() {
    let text = page("adding.md");
    let paragraphs: Vec<&str> = text.split("\n\n").filter(|paragraph| paragraph.starts_with("**")).collect();
    assert!(paragraphs.len() >= 8, "{} paragraphs", paragraphs.len());
    for paragraph in paragraphs {
        let mut last_file = String::new();
        let words = quoted(paragraph);
        for word in words {
            let is_path = word.contains('/');
            // Files that the reader is to write.
            if is_path && word.contains("my_") {
                let folder = Path::new(word).parent().unwrap();
                assert!(root().join(folder).is_dir(), "{word}: there is no folder {}", folder.display());
            } else if is_path {
                assert!(exists(word), "docs/adding.md names {word}, which is not there");
                last_file = word.to_owned();
            }
        }
        // Lists are written in capitals.
        for list in
            quoted(paragraph).into_iter().filter(|word| word.len() > 3 && word.chars().all(|c| c.is_uppercase()))
        {
            let text = std::fs::read_to_string(root().join(&last_file)).unwrap_or_default();
            let anywhere = quoted(paragraph)
                .iter()
                .filter(|word| word.ends_with(".rs") && !word.contains("my_"))
                .any(|file| std::fs::read_to_string(root().join(file)).is_ok_and(|text| text.contains(list)));
            assert!(text.contains(list) || anywhere, "docs/adding.md names the list {list}, which is not in its file");
        }
    }
}

#[test]
fn every_place_that_the_map_names_is_there() {
    let text = page("architecture.md");
    for word in quoted(&text).into_iter().filter(|word| word.contains('/') && !word.contains("dxf")) {
        assert!(exists(word), "docs/architecture.md names {word}, which is not there");
    }
    let floors = text.split("| floor |").nth(1).unwrap().split("\n\n").next().unwrap();
    for line in floors.lines().filter(|line| line.starts_with("| ") && !line.contains("---")) {
        let rooms = line.split('|').nth(2).unwrap_or_default();
        for room in quoted(rooms) {
            assert!(exists(room), "docs/architecture.md draws the room {room}, which is not there");
        }
    }
    // Every folder and file of the top is on the map.
    for entry in std::fs::read_dir(root().join("src")).unwrap() {
        let name = entry.unwrap().path().file_stem().unwrap().to_string_lossy().into_owned();
        if !["lib", "main"].contains(&name.as_str()) {
            assert!(floors.contains(&format!("`{name}`")), "docs/architecture.md leaves out src/{name}");
        }
    }
}
