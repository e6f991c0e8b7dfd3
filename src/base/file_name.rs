//! Names that become a part of a path: the one place where they are checked.

use std::fmt;
use std::path::PathBuf;

/// No file system in use takes longer names, in bytes (ext4, APFS and NTFS all stop near here).
const LONGEST_BYTES: usize = 255;

/// Why a name cannot be that of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NotAFileName {
    pub name: String,
    pub why: &'static str,
}

impl fmt::Display for NotAFileName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Quoted as Rust does it, so that control characters are seen.
        write!(f, "{:?} cannot be the name of a file: it {}", self.name, self.why)
    }
}

impl std::error::Error for NotAFileName {}

/// The name itself if, put behind a folder's path, it names a file in that folder and nowhere else, on every system.
///
/// # Errors
/// When it is empty, leads elsewhere, holds control characters, or is too long.
pub fn component(name: &str) -> Result<&str, NotAFileName> {
    let why = if name.is_empty() {
        "is empty"
    } else if name == "." || name == ".." {
        "names a folder"
    } else if name.contains(['/', '\\']) {
        "leads into another folder"
    } else if name.contains(':') {
        // 'C:x' on Windows is a file on another drive, 'x:y' a hidden stream of x.
        "holds a colon, which leads to another drive on some systems"
    } else if name.contains(char::is_control) {
        "holds control characters"
    } else if name.len() > LONGEST_BYTES {
        "is longer than 255 bytes"
    } else {
        return Ok(name);
    };
    Err(NotAFileName { name: name.to_owned(), why })
}

/// A relative path whose every part is a [`component`], so that put behind a folder's it stays inside; `./` in front
/// may stand. Parts are separated by `/` on every system.
///
/// # Errors
/// When one of the parts is none.
pub fn inner_path(path: &str) -> Result<PathBuf, NotAFileName> {
    let mut inner = PathBuf::new();
    for part in path.split('/').filter(|part| *part != ".") {
        inner.push(component(part)?);
    }
    // Of '.' alone nothing is left.
    component(path.split('/').next_back().unwrap_or_default())?;
    Ok(inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_stays_in_its_folder() {
        for name in ["school", "Bürogebäude 2", "..x", "a.b", ".hidden", "-"] {
            assert_eq!(component(name), Ok(name));
        }
        let long = "x".repeat(256);
        for name in ["", ".", "..", "../up", "/etc/passwd", "a/b", "a\\b", "C:x", "a\u{1b}[2J", "a\nb", "a\0", &long] {
            let error = component(name).expect_err(name).to_string();
            assert!(!error.contains(char::is_control), "{error}");
        }
    }

    #[test]
    fn inner_paths_stay_inside() {
        assert_eq!(inner_path("./a/b.json"), Ok(PathBuf::from("a/b.json")));
        for path in ["", ".", "/a", "a/../b", "../a", "a//b", "a/", "a/..", "a\\..\\b"] {
            inner_path(path).expect_err(path);
        }
    }
}
