//! The `enfilade replay` command.

use std::path::Path;

use libtest_mimic::Trial;
use serde_json::Value;

use crate::support;
use crate::tests;

/// Calls `enfilade replay` and gives its exit code, stdout and stderr.
pub fn replay(arguments: &[&str]) -> (u8, String, String) {
    support::enfilade(["replay"].iter().chain(arguments))
}

pub fn trials() -> Vec<Trial> {
    let test = |name: &str, run: fn()| {
        Trial::test(format!("command/{name}"), move || {
            run();
            Ok(())
        })
    };
    vec![
        test("snapshots_are_made_compared_and_shown_to_differ", snapshots),
        test("what_is_saved_goes_nowhere_else", saves),
        test("many_scripts_run_at_a_time_and_are_told_in_order", many),
        test("wrong_calls_say_what_to_do", wrong_calls),
    ]
}

fn write(folder: &Path, name: &str, text: &str) -> String {
    let path = folder.join(name);
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    std::fs::write(&path, text).unwrap();
    path.to_string_lossy().into_owned()
}

fn snapshots() {
    let folder = tempfile::tempdir().unwrap();
    let script =
        write(folder.path(), "look.replay", "size 900x500\nopen-sample dwelling\nsnapshot plan --region canvas\n");
    let (code, _, err) = replay(&[&script]);
    assert_eq!(code, 1);
    assert!(err.contains("look.replay:3: snapshot plan: no reference picture plan.png"), "{err}");
    let file = |name: &str| folder.path().join(name);
    assert!(file("plan.out.png").exists());
    let (code, out, _) = replay(&[&script, "--update"]);
    assert_eq!(code, 0, "{out}");
    assert!(out.contains("written: ") && file("plan.png").exists(), "{out}");
    let (code, out, err) = replay(&[&script]);
    assert_eq!((code, err.as_str()), (0, ""), "{out}");
    assert!(out.contains("(3 steps, 1 snapshots)"), "{out}");
    assert!(!file("plan.out.png").exists(), "what an earlier run left is gone");
    // A difference.
    write(
        folder.path(),
        "look.replay",
        "size 900x500\nopen-sample dwelling\nfill-none\nsnapshot plan --region canvas\n",
    );
    let (code, _, err) = replay(&[&script]);
    assert_eq!(code, 1);
    assert!(err.contains("pixels differ, by") && err.contains("plan.diff.png"), "{err}");
    assert!(file("plan.out.png").exists() && file("plan.diff.png").exists());
    // Elsewhere.
    let elsewhere = file("elsewhere").to_string_lossy().into_owned();
    assert_eq!(replay(&[&script, "--snapshots", &elsewhere, "--update"]).0, 0);
    assert!(file("elsewhere/look/plan.png").exists());
    assert_eq!(replay(&[&script, "--snapshots", &elsewhere]).0, 0);
}

fn saves() {
    let folder = tempfile::tempdir().unwrap();
    let office = enfilade::store::BUNDLED[0].1;
    write(folder.path(), "mine.plan.json", office);
    let text = "open mine.plan.json\nnext-room\nlabel-hall\nsave\nexpect unsaved no\nsave-as \"deep/copy.plan.json\"\n\
                file-dialog save other\nsave-as\nexpect file other.plan.json exists\nexpect status \"Saved\"\n";
    let script = write(folder.path(), "save.replay", text);
    let out = folder.path().join("out").to_string_lossy().into_owned();
    let (code, _, err) = replay(&[&script, "--out", &out]);
    assert_eq!((code, err.as_str()), (0, ""));
    assert_eq!(std::fs::read_to_string(folder.path().join("mine.plan.json")).unwrap(), office, "it is the user's");
    for name in ["mine.plan.json", "deep/copy.plan.json", "other.plan.json"] {
        let path = folder.path().join("out/save").join(name);
        assert_ne!(std::fs::read_to_string(path).unwrap(), office, "{name}");
    }
    let text = format!("open mine.plan.json\nsave-as \"{}/stolen.plan.json\"\n", folder.path().display());
    let (code, _, err) = replay(&[&write(folder.path(), "away.replay", &text)]);
    assert_eq!(code, 1);
    assert!(err.contains("away.replay:2:") && err.contains("leads out of the script's own folder"), "{err}");
    assert!(!folder.path().join("stolen.plan.json").exists());
}

fn many() {
    let folder = tempfile::tempdir().unwrap();
    for index in 0..6 {
        let rooms = if index == 3 { 99 } else { 15 };
        write(
            folder.path(),
            &format!("{index}/script.replay"),
            &format!("open-sample dwelling\nexpect rooms {rooms}\n"),
        );
    }
    let path = folder.path().to_string_lossy().into_owned();
    let (code, out, err) = replay(&[&path, "-j", "3"]);
    assert_eq!(code, 1);
    assert!(out.ends_with("5 of 6 scripts passed\n"), "{out}");
    assert!(err.contains("3/script.replay:2: expected 99 rooms, found 15"), "{err}");
    assert_eq!(replay(&[&path, "-j", "1"]), (code, out, err));
    let (code, out, err) = replay(&[&path, "--json"]);
    assert_eq!((code, err.as_str()), (1, ""));
    let report: Value = serde_json::from_str(&out).unwrap();
    let scripts = report["scripts"].as_array().unwrap();
    let titles: Vec<&str> = scripts.iter().map(|script| script["title"].as_str().unwrap()).collect();
    assert_eq!(titles, ["0", "1", "2", "3", "4", "5"]);
    assert_eq!(scripts[3]["failures"][0]["what"], "expected 99 rooms, found 15");
}

fn wrong_calls() {
    let empty = tempfile::tempdir().unwrap();
    let empty = empty.path().to_string_lossy().into_owned();
    for (arguments, expected, words) in [
        (vec![], 2, "SCRIPT|DIR"),
        (vec!["no-such.replay"], 1, "no such script"),
        (vec![empty.as_str()], 1, "no script in this folder"),
        (vec!["--list", "--jobs", "many"], 2, "invalid value"),
    ] {
        let (code, _, err) = replay(&arguments);
        assert_eq!(code, expected, "{arguments:?} {err}");
        assert!(err.contains(words), "{err}");
    }
    let (code, out, _) = replay(&["--list"]);
    assert!(code == 0 && out.contains("| `snapshot NAME"), "{out}");
    assert!(tests("cases").exists());
}
