//! `enfilade import`, run as a program.

use std::path::Path;
use std::process::{Command, Output};

use super::golden::{compare, fixture};

/// Runs `enfilade import` in a folder.
fn import(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_enfilade")).current_dir(folder).arg("import").args(arguments).output().unwrap()
}

fn text(bytes: &[u8]) -> &str {
    std::str::from_utf8(bytes).unwrap()
}

/// Copies a case into a folder under a path of one's own.
#[expect(clippy::disallowed_methods, reason = "a test's input is no user's file")]
fn put(folder: &Path, path: &str, content: &[u8]) {
    let path = folder.join(path);
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    std::fs::write(path, content).unwrap();
}

fn case(name: &str) -> Vec<u8> {
    std::fs::read(fixture("cases").join(name)).unwrap()
}

/// A folder with good, mendable and bad files, equal names in different folders, and files that are
/// no plans.
fn mixed() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let put = |path: &str, content: &[u8]| put(folder.path(), path, content);
    put("in/school/ground floor.xml", &case("plain.xml"));
    put("in/school/ground floor.plan.json", &case("image_scale.plan.json"));
    put("in/school/office.xml", &case("image_scale.xml"));
    put("in/school/boundary.xml", &case("boundary_of_two_corners.xml"));
    put("in/office/ground floor.xml", &case("portal_to_nowhere.xml"));
    put("in/office/storeys.xml", &case("storeys_in_one_file.xml"));
    put("in/office/cut.xml", &case("plain.xml")[..1500]);
    put("in/empty.xml", b"");
    put("in/labels.xml", b"<buildingtype><labels/></buildingtype>");
    put("in/notes.txt", b"no plan");
    put("in/.hidden/plan.xml", &case("plain.xml"));
    folder
}

/// All files below a folder with their bytes, by path.
fn tree(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let files = walkdir::WalkDir::new(folder).sort_by_file_name().into_iter().map(Result::unwrap);
    files
        .filter(|entry| entry.file_type().is_file())
        .map(|entry| {
            let path = entry.path().strip_prefix(folder).unwrap().to_string_lossy().into_owned();
            (path, std::fs::read(entry.path()).unwrap())
        })
        .collect()
}

#[test]
fn a_folder_is_imported_with_a_report_and_goes_on_after_bad_files() {
    let folder = mixed();
    let mut wrong = Vec::new();
    for (name, options) in [("summary", &[][..]), ("verbose", &["-v"]), ("report", &["--json"])] {
        let output = import(folder.path(), &[&["in", "-o", name], options].concat());
        assert_eq!(output.status.code(), Some(1), "two files are bad");
        let golden = fixture("command").join(format!("{name}.{}", if name == "report" { "json" } else { "txt" }));
        wrong.extend(compare(&golden, Some(text(&output.stdout))).err());
        wrong.extend(compare(&fixture("command/errors.txt"), Some(text(&output.stderr))).err());
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    let written = tree(&folder.path().join("summary"));
    let names: Vec<&str> = written.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(
        names,
        [
            "office/ground floor.plan.json",
            "office/storeys-1.plan.json",
            "office/storeys-2.plan.json",
            "school/boundary.plan.json",
            "school/ground floor-2.plan.json",
            "school/ground floor.plan.json",
            "school/office.plan.json",
        ]
    );
    assert_eq!(written, tree(&folder.path().join("verbose")), "the same bytes each time");
}

#[test]
fn a_plan_that_differs_is_replaced_only_by_force() {
    let folder = tempfile::tempdir().unwrap();
    put(folder.path(), "a.xml", &case("plain.xml"));
    let first = import(folder.path(), &["a.xml", "-o", "out"]);
    assert_eq!(first.status.code(), Some(0), "{}", text(&first.stderr));
    assert!(text(&first.stdout).ends_with("Plans in out: 1 written.\n"), "{}", text(&first.stdout));
    let again = import(folder.path(), &["a.xml", "-o", "out"]);
    assert!(text(&again.stdout).ends_with("Plans in out: 1 unchanged.\n"), "{}", text(&again.stdout));
    assert_eq!(again.status.code(), Some(0));

    put(folder.path(), "out/a.plan.json", b"somebody's work");
    let kept = import(folder.path(), &["a.xml", "-o", "out"]);
    assert_eq!(kept.status.code(), Some(1));
    assert_eq!(
        text(&kept.stderr),
        "enfilade: out/a.plan.json: kept, because it differs from the result of a.xml; --force overwrites it\n"
    );
    assert_eq!(tree(&folder.path().join("out"))[0].1, b"somebody's work");
    let forced = import(folder.path(), &["a.xml", "-o", "out", "--force"]);
    assert_eq!(forced.status.code(), Some(0));
    assert!(tree(&folder.path().join("out"))[0].1.starts_with(b"{"));
}

#[test]
fn equal_names_from_different_places_do_not_collide() {
    let folder = tempfile::tempdir().unwrap();
    put(folder.path(), "a/x.xml", &case("plain.xml"));
    put(folder.path(), "b/x.xml", &case("image_scale.xml"));
    let names = |output: &str| tree(&folder.path().join(output)).into_iter().map(|(name, _)| name).collect::<Vec<_>>();
    assert_eq!(import(folder.path(), &["a/x.xml", "b/x.xml", "-o", "files"]).status.code(), Some(0));
    assert_eq!(names("files"), ["x-2.plan.json", "x.plan.json"]);
    assert_eq!(import(folder.path(), &["a", "b", "-o", "folders"]).status.code(), Some(0));
    assert_eq!(names("folders"), ["a/x.plan.json", "b/x.plan.json"]);
}

#[test]
fn plans_are_not_imported_from_where_they_are_written() {
    let folder = tempfile::tempdir().unwrap();
    put(folder.path(), "x.xml", &case("plain.xml"));
    for output in [".", "out"] {
        for _ in 0..2 {
            assert_eq!(import(folder.path(), &[".", "-o", output]).status.code(), Some(0));
        }
    }
    let names: Vec<String> = tree(folder.path()).into_iter().map(|(name, _)| name).collect();
    // The plan beside its source is one of the sources of the second import.
    assert_eq!(names, ["out/x-2.plan.json", "out/x.plan.json", "x.plan.json", "x.xml"]);
}

#[test]
fn wrong_calls_say_what_is_wrong() {
    let folder = tempfile::tempdir().unwrap();
    put(folder.path(), "x.xml", &case("plain.xml"));
    put(folder.path(), "picture.png", b"\x89PNG");
    std::fs::create_dir(folder.path().join("empty")).unwrap();
    for (arguments, code, expected) in [
        (&["x.xml"][..], 2, "--output"),
        (&["empty", "-o", "out"], 1, "empty: no plan files in this folder"),
        (&["missing.xml", "-o", "out"], 1, "missing.xml: No such file"),
        (&["picture.png", "-o", "out"], 1, "picture.png: is of no known plan format; known are"),
        (&["x.xml", "-o", "x.xml"], 2, "x.xml: is a file; name a folder"),
    ] {
        let output = import(folder.path(), arguments);
        assert_eq!(output.status.code(), Some(code), "{arguments:?}");
        assert!(text(&output.stderr).contains(expected), "{arguments:?}: {}", text(&output.stderr));
    }
}

#[test]
fn the_authors_collection_is_imported_the_same_each_time() {
    let Some(first) = super::real::files().first().cloned() else { return };
    let root = first.parent().unwrap().parent().unwrap();
    let folder = tempfile::tempdir().unwrap();
    for output in ["once", "again"] {
        let result = import(folder.path(), &[root.to_str().unwrap(), "-o", output]);
        assert_eq!(result.status.code(), Some(0), "{}", text(&result.stderr));
        assert!(text(&result.stdout).contains("Skipped, not plans: 3 x XML with the root <buildingtype>."));
    }
    let (once, again) = (tree(&folder.path().join("once")), tree(&folder.path().join("again")));
    assert_eq!(once.len(), 56);
    assert_eq!(once, again);
    // Spelled with one l and with two.
    let storeys = once.iter().filter(|(_, bytes)| text(bytes).contains("\"building\": \"RomainRolland\"")).count();
    assert_eq!(storeys, 2);
}
