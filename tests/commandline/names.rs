//! Names in files as attacks: on the terminal, and on the folders around.

use std::path::Path;

use super::{CALLS, Workshop};
use crate::support::enfilade;

/// Whether a text would do something to a terminal.
fn moves_the_terminal(text: &str) -> Option<char> {
    text.chars().find(|&c| (c.is_control() && c != '\n' && c != '\t') || matches!(c, '\u{202a}'..='\u{202e}'))
}

/// A plan all of whose names hold escape sequences.
const HOSTILE: &str = include_str!("escape-sequences.plan.json");

#[test]
fn control_characters_of_names_are_shown_not_sent() {
    for call in CALLS {
        for more in [&[][..], &["-v"], &["--json"]] {
            let workshop = Workshop::new();
            std::fs::write(workshop.path("plan.plan.json"), HOSTILE).unwrap();
            std::fs::write(workshop.path("plans/a/x.plan.json"), HOSTILE).unwrap();
            let rows = std::fs::read_to_string(workshop.path("rooms.csv")).unwrap();
            std::fs::write(workshop.path("rooms.csv"), rows.replace("school", "\u{1b}[31mred\u{7}")).unwrap();
            let words = workshop.words(call, &workshop.out(call), None);
            let words: Vec<String> = words.into_iter().chain(more.iter().map(|&word| word.to_owned())).collect();
            let (_, text, err) = enfilade(&words);
            assert_eq!(moves_the_terminal(&text), None, "{words:?}: {text:?}");
            assert_eq!(moves_the_terminal(&err), None, "{words:?}: {err:?}");
            // To stdout as well.
            let mut words = workshop.words(call, Path::new("-"), None);
            if call.name == "render" {
                words.extend(["--format", "svg"].map(str::to_owned));
            }
            let (_, text, err) = enfilade(&words);
            assert_eq!(moves_the_terminal(&text), None, "{words:?}");
            assert_eq!(moves_the_terminal(&err), None, "{words:?}");
        }
        // Names of files, known or not.
        let workshop = Workshop::new();
        let words = workshop.words(call, &workshop.out(call), Some("\u{1b}[2J.plan.json"));
        let (_, text, err) = enfilade(&words);
        assert_eq!(moves_the_terminal(&(text + &err)), None, "{words:?}");
    }
    let (code, _, err) = enfilade(["\u{1b}[2Jfeautres"]);
    assert!(code == 2 && moves_the_terminal(&err).is_none(), "{err:?}");
}

#[test]
fn a_name_on_several_lines_is_one_line() {
    let workshop = Workshop::new();
    let plan = std::fs::read_to_string(workshop.path("plan.plan.json")).unwrap();
    let plan = plan.replace("\"plan\"", "\"x\\nenfilade: all is well\"");
    std::fs::write(workshop.path("plan.plan.json"), plan).unwrap();
    for call in CALLS.iter().filter(|call| matches!(call.name, "check" | "classify")) {
        let (_, text, err) = enfilade(workshop.words(call, &workshop.out(call), Some("plan.plan.json")));
        assert!(!(text + &err).lines().any(|line| line == "enfilade: all is well"), "{}", call.name);
    }
}

#[test]
fn a_name_that_becomes_a_path_stays_in_its_folder() {
    let workshop = Workshop::new();
    let rows = std::fs::read_to_string(workshop.path("rooms.csv")).unwrap();
    let plan = std::fs::read_to_string(workshop.path("plan.plan.json")).unwrap();
    for typology in ["../up/x", "/etc/x", "a/b", "..", "a\\\\b"] {
        let mixed: String = rows
            .lines()
            .enumerate()
            .map(|(i, line)| if i % 2 == 1 { line.replace("school", typology) } else { line.to_owned() } + "\n")
            .collect();
        std::fs::write(workshop.path("rooms.csv"), mixed).unwrap();
        let out = workshop.path("models/here");
        let words = ["train", "--algorithm", "tree", "--folds", "0", "-o"].map(str::to_owned);
        let words: Vec<String> = words
            .into_iter()
            .chain([out.display().to_string(), workshop.path("rooms.csv").display().to_string()])
            .collect();
        let (code, text, err) = enfilade(&words);
        assert!(code == 1 && err.contains("cannot be the name of a file"), "{typology}: {text}{err}");
        assert!(!workshop.path("models").exists(), "{typology}: models were written");
        // The same in a plan's own names, for whatever makes files of them.
        let hostile = plan.replace("school", typology).replace("\"plan\"", &format!("\"{typology}\""));
        std::fs::write(workshop.path("plan.plan.json"), hostile).unwrap();
        let one_is_enough = typology != "../up/x";
        for call in CALLS.iter().filter(|_| !one_is_enough) {
            let out = workshop.out(call);
            enfilade(workshop.words(call, &out, None));
            let allowed = |name: &str| name.starts_with("out-");
            for entry in std::fs::read_dir(workshop.0.path()).unwrap() {
                let name = entry.unwrap().file_name().to_string_lossy().into_owned();
                let known = [
                    "plan.plan.json",
                    "plans",
                    "labelled",
                    "empty",
                    "rooms.csv",
                    "fixes.csv",
                    "robot.log",
                    "map.png",
                    "s.replay",
                ];
                let is_known = known.contains(&name.as_str());
                assert!(is_known || allowed(&name), "{typology}: {} wrote {name}", call.name);
            }
        }
    }
}
