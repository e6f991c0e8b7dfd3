//! Failing scripts: the message of `enfilade replay` for each is in a file beside it.

use std::path::Path;

use libtest_mimic::Trial;

use crate::command::replay;
use crate::support::assert_text;
use crate::tests;

pub fn trials() -> Vec<Trial> {
    let mut scripts: Vec<_> = std::fs::read_dir(tests("errors"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "replay"))
        .collect();
    scripts.sort();
    let beside = scripts.into_iter().map(|script| {
        let name = format!("errors/{}", script.file_stem().unwrap().to_string_lossy());
        Trial::test(name, move || {
            is_told(&script);
            Ok(())
        })
    });
    beside
        .chain([Trial::test("errors/no_script_at_all", || {
            no_script();
            Ok(())
        })])
        .collect()
}

fn is_told(script: &Path) {
    let (code, out, err) = replay(&[&script.to_string_lossy()]);
    assert_eq!(code, 1, "{out}{err}");
    let folder = format!("{}/", tests("errors").display());
    assert_text(&script.with_extension("txt"), &format!("{out}{err}").replace(&folder, ""));
    for left in ["out.png", "diff.png"] {
        let _ = std::fs::remove_file(script.with_file_name("picture").with_extension(left));
    }
}

/// Scripts that would not be kept well in a repository.
fn no_script() {
    let folder = tempfile::tempdir().unwrap();
    let long = "expect rooms 1\n".repeat(400_000);
    let lines = "what is this\n".repeat(1000);
    for (name, bytes, words) in [
        ("binary", &[0u8, 159, 146, 150, 255, 0, 1][..], "no text"),
        ("png", b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR", "no text"),
        ("huge", long.as_bytes(), "at most 4 MiB"),
        ("line", "x".repeat(1 << 20).as_bytes(), "neither a verb nor a command"),
        ("lines", lines.as_bytes(), ":10:"),
    ] {
        let path = folder.path().join(format!("{name}.replay"));
        std::fs::write(&path, bytes).unwrap();
        let (code, _, err) = replay(&[&path.to_string_lossy()]);
        assert_eq!(code, 1, "{name}: {err}");
        assert!(err.contains(words) && err.len() < 5000, "{name}: {err}");
    }
}
