//! Many plans at once: nothing wrong with one ends the rest, and the order of results is that of the paths.
#![cfg(unix)]
#![allow(clippy::disallowed_methods, reason = "a test's output is no user's file")]

use std::os::unix::fs::symlink;
use std::path::Path;

use crate::support::enfilade;

const OFFICE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/plans/office.plan.json");

/// A folder with two good plans among everything that can be wrong.
fn mixed() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join("in").join(name);
    std::fs::create_dir_all(at("deep/.hidden")).unwrap();
    std::fs::copy(OFFICE, at("a.plan.json")).unwrap();
    std::fs::copy(OFFICE, at("deep/z.plan.json")).unwrap();
    std::fs::copy(OFFICE, at("deep/.hidden/h.plan.json")).unwrap();
    std::fs::write(at("broken.plan.json"), b"{").unwrap();
    std::fs::write(at("drawing.xml"), b"<svg></svg>").unwrap();
    symlink("nowhere", at("dangling.plan.json")).unwrap();
    symlink("nowhere", at("dangling")).unwrap();
    symlink("..", at("deep/round")).unwrap();
    folder
}

#[test]
fn one_bad_file_never_ends_the_rest() {
    let folder = mixed();
    let at = |name: &str| folder.path().join(name).display().to_string();
    let input = at("in");
    for (subcommand, more) in [
        ("features", vec![]),
        ("check", vec![]),
        ("classify", vec![]),
        ("dataset", vec![]),
        ("export", vec!["-o".to_owned(), at("exported")]),
        ("render", vec!["-o".to_owned(), at("drawn"), "--size".to_owned(), "64".to_owned()]),
        ("import", vec!["-o".to_owned(), at("imported")]),
    ] {
        let words = [subcommand.to_owned(), input.clone()].into_iter().chain(more);
        let (code, out, err) = enfilade(words);
        assert_eq!(code, 1, "{subcommand}: {err}");
        for problem in ["broken.plan.json", "dangling.plan.json: No such file", "round: leads back to"] {
            assert!(err.contains(problem), "{subcommand}: {err}");
        }
        let problems: Vec<&str> = err.lines().filter(|line| line.starts_with("enfilade: ")).collect();
        assert_eq!(problems.len(), 3, "{subcommand}: {err}");
        assert!(!out.is_empty() && !err.contains("hidden"), "{subcommand}");
    }
    let names = |name: &str| -> Vec<String> {
        let files = walkdir::WalkDir::new(at(name)).sort_by_file_name().into_iter().flatten();
        files.filter(|it| it.file_type().is_file()).map(|it| it.file_name().to_string_lossy().into_owned()).collect()
    };
    assert_eq!(names("exported"), ["a.geojson", "z.geojson"]);
    assert_eq!(names("drawn"), ["a.png", "z.png"]);
    assert_eq!(names("imported"), ["a.plan.json", "z.plan.json"]);
}

#[test]
fn results_are_those_of_each_file_in_the_order_of_paths() {
    let folder = tempfile::tempdir().unwrap();
    let office = std::fs::read_to_string(OFFICE).unwrap();
    let mut paths = Vec::new();
    for number in 10..40 {
        let path = folder.path().join(format!("{number}.plan.json"));
        // Each with a name of its own.
        std::fs::write(&path, office.replacen("\"name\": \"", &format!("\"name\": \"{number} "), 1)).unwrap();
        paths.push(path);
    }
    let features = |path: &Path| {
        let (code, out, err) = enfilade(["features".as_ref(), path.as_os_str()]);
        assert_eq!((code, err.as_str()), (0, ""));
        out
    };
    let all = features(folder.path());
    let (head, _) = all.split_once('\n').unwrap();
    let each = paths.iter().map(|path| features(path).split_once('\n').unwrap().1.to_owned());
    assert!(all == format!("{head}\n{}", each.collect::<String>()));
    let out = folder.path().join("out");
    let (_, printed, _) = enfilade(["export".as_ref(), folder.path().as_os_str(), "-o".as_ref(), out.as_os_str()]);
    let expected: String =
        (10..40).map(|number| format!("{}\n", out.join(format!("{number}.geojson")).display())).collect();
    assert_eq!(printed, expected);
}
