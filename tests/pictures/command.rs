//! `enfilade render`.

use std::path::{Path, PathBuf};

use crate::support::{self, Picture};

/// Runs `enfilade render` and gives its exit code, stdout and stderr.
fn render(arguments: &[&Path]) -> (u8, String, String) {
    support::enfilade([Path::new("render")].iter().chain(arguments))
}

fn plan(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("plans").join(name)
}

#[test]
fn a_plan_becomes_a_png_of_the_size_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("office.png");
    let (office, size) = (plan("office.plan.json"), Path::new("400x300"));
    let (code, out, err) = render(&[&office, Path::new("-o"), &file, Path::new("--size"), size]);
    assert_eq!((code, err.as_str()), (0, ""));
    assert!(out.contains("office.png"), "{out}");
    let picture = Picture::decode(&std::fs::read(&file).unwrap());
    assert_eq!((picture.width, picture.height), (400, 300));
    let flags = ["--graph", "--grid", "--theme", "dark", "--colour", "function", "--size", "400x300"];
    let other = folder.path().join("other.png");
    let mut call: Vec<&Path> = vec![&office, Path::new("-o"), &other];
    call.extend(flags.map(Path::new));
    assert_eq!(render(&call).0, 0);
    assert_ne!(Picture::decode(&std::fs::read(&other).unwrap()).rgba, picture.rgba);
}

#[test]
fn a_folder_of_plans_becomes_a_folder_of_svg() {
    let folder = tempfile::tempdir().unwrap();
    let (code, out, _) =
        render(&[&plan(""), Path::new("-o"), &folder.path().join("pictures"), Path::new("--format"), Path::new("svg")]);
    assert_eq!((code, out.lines().count()), (0, 3), "{out}");
    let text = std::fs::read_to_string(folder.path().join("pictures/school.svg")).unwrap();
    assert!(text.starts_with("<svg ") && text.contains("Library"));
}

#[test]
fn wrong_calls_and_wrong_input_say_what_to_do() {
    let folder = tempfile::tempdir().unwrap();
    let out = |name: &str| folder.path().join(name);
    let office = plan("office.plan.json");
    let cases: [(&[&Path], u8, &str); 5] = [
        (&[&office, Path::new("-o"), &out("a.png"), Path::new("--size"), Path::new("100000")], 2, "outside 16 to 8192"),
        (&[&office, Path::new("-o"), &out("a.png"), Path::new("--size"), Path::new("big")], 2, "no number of pixels"),
        (&[&office, Path::new("-o"), &out("a.bmp")], 1, "pictures end in .png or .svg"),
        (&[&out("missing.plan.json"), Path::new("-o"), &out("a.png")], 1, "missing.plan.json"),
        (&[&office, &office, Path::new("-o"), &out("a.png")], 1, "written twice"),
    ];
    for (arguments, expected, word) in cases {
        let (code, _, err) = render(arguments);
        assert_eq!(code, expected, "{err}");
        assert!(err.contains(word), "{err:?} misses {word:?}");
    }
}
