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
        (
            &[&office, Path::new("-o"), &out("a.png"), Path::new("--size"), Path::new("100000")],
            2,
            "not between 16 and 8192",
        ),
        (
            &[&office, Path::new("-o"), &out("a.png"), Path::new("--size"), Path::new("big")],
            2,
            "not a number of pixels",
        ),
        (&[&office, Path::new("-o"), &out("a.bmp")], 2, "pictures end in .png or .svg"),
        (&[&out("missing.plan.json"), Path::new("-o"), &out("a.png")], 1, "missing.plan.json"),
        (&[&office, &office, Path::new("-o"), &out("a.png")], 2, "is a single picture, but there are 2 plans"),
    ];
    for (arguments, expected, word) in cases {
        let (code, _, err) = render(arguments);
        assert_eq!(code, expected, "{err}");
        assert!(err.contains(word), "{err:?} misses {word:?}");
    }
}

/// A plan file of walls `from` `to`, in metres, or of one room with these corners.
fn written(folder: &Path, name: &str, corners: &[(f64, f64)], is_room: bool) -> PathBuf {
    let id = |letter: char, index: usize| format!("{letter}{:012}", index + 1);
    let listed: Vec<_> = corners
        .iter()
        .enumerate()
        .map(|(index, (x, y))| serde_json::json!({ "id": id('c', index), "x": x, "y": y }))
        .collect();
    let all: Vec<String> = (0..corners.len()).map(|index| id('c', index)).collect();
    let mut plan = serde_json::json!({ "format": "enfilade plan", "version": 1, "corners": listed });
    if is_room {
        plan["rooms"] = serde_json::json!([{ "id": id('r', 0), "name": "a", "outer": all }]);
    } else {
        let wall = |(index, ends): (usize, &[String])| serde_json::json!({ "id": id('w', index), "from": ends[0], "to": ends[1], "thickness": 0.1 });
        plan["walls"] = all.chunks(2).enumerate().map(wall).collect();
    }
    let path = folder.join(name);
    std::fs::write(&path, plan.to_string()).unwrap();
    path
}

/// Joining 160,000 crossings takes minutes: they are drawn as lines, and that is said.
#[test]
fn walls_and_rooms_that_cross_out_of_all_proportion_are_drawn_as_lines() {
    let folder = tempfile::tempdir().unwrap();
    let spoke = |index: usize| {
        let angle_rad = std::f64::consts::PI * index as f64 / 400.0;
        let (x, y) = (200.0 * angle_rad.cos(), 200.0 * angle_rad.sin());
        let to_grid = |value: f64| (value * 1e4).round() / 1e4;
        [(to_grid(x), to_grid(y)), (to_grid(-x), to_grid(-y))]
    };
    let star: Vec<(f64, f64)> = (0..400).flat_map(spoke).collect();
    let comb: Vec<(f64, f64)> =
        (0..1000).map(|index| ((index * 7919 % 1009) as f64 / 10.0, (index * 104_729 % 1013) as f64 / 10.0)).collect();
    for (name, corners, is_room, number) in [("star", star, false, "400"), ("comb", comb, true, "1")] {
        let file = written(folder.path(), &format!("{name}.plan.json"), &corners, is_room);
        let picture = folder.path().join(format!("{name}.png"));
        let (code, _, err) = render(&[&file, Path::new("-o"), &picture, Path::new("--size"), Path::new("400x300")]);
        assert_eq!(code, 0, "{err}");
        assert!(err.contains(&format!("{number} walls or rooms cross each other")), "{name}: {err}");
        let rgba = Picture::decode(&std::fs::read(&picture).unwrap()).rgba;
        assert!(rgba.chunks(4).any(|pixel| pixel[0] < 200), "{name}: nothing is drawn");
    }
}
