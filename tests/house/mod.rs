//! The architecture holds: imports only go down the floors, no files import each other in a circle, and
//! the core touches neither files, threads, clocks nor the window. Checked on the `use` lines and the
//! paths in the code; tests within a file may import what they like. docs/architecture.md draws the
//! floors.

mod docs;
mod numbers;

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// The floors from the ground up: a file may import from its own floor and those below. The longest prefix
/// of its path counts.
const FLOORS: &[&[&str]] = &[
    &["base", "geometry"],
    &["picture", "labels"],
    &["plan"],
    &["topology", "snapping"],
    &["edit", "features"],
    &["check", "draw", "chart", "dataset", "formats"],
    &["classify"],
    &["robot"],
    &["predict", "store", "study"],
    &["pipeline", "gather", "training", "review"],
    &["workspace"],
    &["facade"],
    &["app/look"],
    &["app/paint"],
    &["app/session", "app/value"],
    &["app/tools"],
    &["app/canvas"],
    &["app/state"],
    &["app/commands"],
    &["app/panels", "app/dialogs"],
    &["app/frame"],
    &["app"],
    &["cli"],
    &["main", "lib"],
];

/// The core: pure functions of their input.
const CORE: &[&str] = &[
    "base",
    "geometry",
    "picture",
    "labels",
    "plan",
    "topology",
    "snapping",
    "edit",
    "features",
    "check",
    "draw",
    "chart",
    "dataset",
    "formats",
    "classify",
    "predict",
    "study",
    "pipeline",
    "gather",
    "training",
    "robot",
    "workspace",
    "review",
];

/// What the core does not touch, and why.
const BANNED_IN_CORE: &[(&str, &str)] = &[
    ("std::fs", "the core reads no files: `store` and `cli` do"),
    ("std::thread", "threads start in `base/work.rs` alone"),
    ("std::env", "the core does not depend on its surroundings"),
    ("std::time::Instant", "the core looks at no clock"),
    ("std::time::SystemTime", "the core looks at no clock"),
    ("egui::", "the core knows no window"),
    ("eframe::", "the core knows no window"),
    ("clap::", "the core knows no command line"),
];

/// Files of the core that may touch something all the same: the file, what it touches, and why.
const MAY_TOUCH: &[(&str, &str, &str)] = &[
    ("base/work.rs", "std::thread", "the one door to threads"),
    ("formats/files.rs", "std::fs", "reads a plan's file or folder with a limit, for `store`, the window and `cli`"),
];

struct House {
    /// By path below `src`, the text of each without its tests.
    files: BTreeMap<String, String>,
    /// What each imports by `use`, and whether it hands it on.
    uses: BTreeMap<String, Vec<(bool, Vec<String>)>>,
}

impl House {
    fn read() -> Self {
        let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
        let mut files = BTreeMap::new();
        let mut folders = vec![src.clone()];
        while let Some(folder) = folders.pop() {
            for entry in std::fs::read_dir(&folder).unwrap() {
                let path: PathBuf = entry.unwrap().path();
                if path.is_dir() {
                    folders.push(path);
                } else if path.extension().is_some_and(|ending| ending == "rs") {
                    let name = path.strip_prefix(&src).unwrap().to_string_lossy().replace('\\', "/");
                    let text = std::fs::read_to_string(&path).unwrap();
                    files.insert(name, without_tests(&text));
                }
            }
        }
        let uses = files
            .iter()
            .map(|(file, text)| {
                let module = module_of(file);
                (file.clone(), uses(text, &module.iter().map(String::as_str).collect::<Vec<_>>()))
            })
            .collect();
        Self { files, uses }
    }

    /// The file of a module given by its names below the crate; `None` where there is none.
    fn file_of(&self, module: &[&str]) -> Option<String> {
        let path = module.join("/");
        let candidates = if path.is_empty() {
            vec!["lib.rs".to_owned()]
        } else {
            vec![format!("{path}.rs"), format!("{path}/mod.rs")]
        };
        candidates.into_iter().find(|file| self.files.contains_key(file))
    }

    /// The files that define what a path below the crate names: names that a module hands on are followed.
    fn definer(&self, path: &[&str], depth: usize) -> Option<String> {
        let length = (0..=path.len()).rev().find(|&length| self.file_of(&path[..length]).is_some())?;
        let file = self.file_of(&path[..length])?;
        let (Some(name), true) = (path.get(length), depth < 4) else { return Some(file) };
        for (public, leaf) in &self.uses[&file] {
            if *public && leaf.last().is_some_and(|last| last == name) {
                let leaf: Vec<&str> = leaf.iter().map(String::as_str).collect();
                if leaf != path {
                    return self.definer(&leaf, depth + 1);
                }
            }
        }
        Some(file)
    }

    /// Which files each file imports from.
    fn imports(&self) -> BTreeMap<&str, BTreeSet<String>> {
        let mut all = BTreeMap::new();
        for (file, text) in &self.files {
            let module = module_of(file);
            let module: Vec<&str> = module.iter().map(String::as_str).collect();
            let mut from = BTreeSet::new();
            let imported = self.uses[file].iter().filter(|(public, _)| !public).map(|(_, leaf)| leaf.clone());
            for path in imported.chain(inline_paths(text, &module)) {
                let path: Vec<&str> = path.iter().map(String::as_str).collect();
                if let Some(found) = self.definer(&path, 0)
                    && found != *file
                {
                    from.insert(found);
                }
            }
            all.insert(file.as_str(), from);
        }
        all
    }
}

/// The text before the module of tests, without comments.
fn without_tests(text: &str) -> String {
    let code = text.split("\n#[cfg(test)]\nmod tests {").next().unwrap_or_default();
    code.lines().map(|line| line.find("//").map_or(line, |at| &line[..at])).collect::<Vec<_>>().join("\n")
}

/// The names of a file's module below the crate.
fn module_of(file: &str) -> Vec<String> {
    let mut names: Vec<String> = file.trim_end_matches(".rs").split('/').map(str::to_owned).collect();
    if names.last().is_some_and(|last| last == "mod" || last == "lib" || last == "main") {
        names.pop();
    }
    names
}

/// What is imported by `use`, as paths below the crate, each with whether it is handed on (`pub use`).
fn uses(text: &str, module: &[&str]) -> Vec<(bool, Vec<String>)> {
    let children: BTreeSet<&str> = text
        .lines()
        .filter_map(|line| line.trim().strip_suffix(';'))
        .filter_map(|line| {
            line.rsplit_once("mod ").filter(|(before, _)| before.is_empty() || before.starts_with("pub"))
        })
        .map(|(_, name)| name)
        .collect();
    let mut found = Vec::new();
    let mut rest = text;
    while let Some(at) = rest.find("use ") {
        let line_start = rest[..at].rfind('\n').map_or(0, |newline| newline + 1);
        let before = rest[line_start..at].trim();
        rest = &rest[at + 4..];
        if !(before.is_empty() || before == "pub" || before.starts_with("pub(")) {
            continue;
        }
        let Some(end) = rest.find(';') else { break };
        let mut leaves = Vec::new();
        tree(&rest[..end].split_whitespace().collect::<Vec<_>>().join(" "), &[], &mut leaves);
        for leaf in leaves {
            if let Some(path) = below_crate(&leaf, module, &children) {
                found.push((!before.is_empty(), path));
            }
        }
        rest = &rest[end..];
    }
    found
}

/// The leaves of a tree of imports.
fn tree(text: &str, before: &[String], leaves: &mut Vec<Vec<String>>) {
    let mut depth = 0;
    let mut start = 0;
    let mut parts = Vec::new();
    for (at, c) in text.char_indices() {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 0 => {
                parts.push(&text[start..at]);
                start = at + 1;
            }
            _ => {}
        }
    }
    parts.push(&text[start..]);
    for part in parts.into_iter().map(str::trim).filter(|part| !part.is_empty()) {
        let (head, inner) = match part.find('{') {
            Some(open) => {
                (part[..open].trim_end_matches("::"), Some(&part[open + 1..part.rfind('}').unwrap_or(open + 1)]))
            }
            None => (part.split(" as ").next().unwrap_or_default(), None),
        };
        let names = head.split("::").map(|name| name.trim().to_owned()).filter(|name| !name.is_empty());
        let path: Vec<String> = before.iter().cloned().chain(names).collect();
        match inner {
            Some(inner) => tree(inner, &path, leaves),
            None => leaves.push(path),
        }
    }
}

/// A path as names below the crate; `None` for one of another crate.
fn below_crate(path: &[String], module: &[&str], children: &BTreeSet<&str>) -> Option<Vec<String>> {
    let owned = |names: &[&str]| names.iter().map(|&name| name.to_owned()).collect::<Vec<String>>();
    let mut rest: Vec<String> = path.iter().filter(|name| *name != "self" && *name != "*").cloned().collect();
    let first = path.first()?.as_str();
    match first {
        "crate" => Some(rest.split_off(1)),
        "self" => Some(owned(module).into_iter().chain(rest).collect()),
        "super" => {
            let ups = path.iter().take_while(|name| *name == "super").count();
            let base = owned(&module[..module.len().saturating_sub(ups)]);
            Some(base.into_iter().chain(rest.split_off(ups)).collect())
        }
        name if children.contains(name) => Some(owned(module).into_iter().chain(rest).collect()),
        _ => None,
    }
}

/// Paths that begin with `crate::` or `super::` in the code beside its imports.
fn inline_paths(text: &str, module: &[&str]) -> Vec<Vec<String>> {
    let mut found = Vec::new();
    let text: String = text.split(';').filter(|part| !is_use(part)).collect::<Vec<_>>().join(";");
    for start in ["crate::", "super::"] {
        for (at, _) in text.match_indices(start) {
            let is_word = |c: char| c.is_alphanumeric() || c == '_';
            // Not the end of another path, and not how far something is seen (`pub(in crate::app)`).
            if text[..at].chars().next_back().is_some_and(|c| is_word(c) || c == ':') || text[..at].ends_with("in ") {
                continue;
            }
            let end = text[at..].find(|c: char| !is_word(c) && c != ':').map_or(text.len(), |end| at + end);
            let names: Vec<String> = text[at..end].trim_end_matches(':').split("::").map(str::to_owned).collect();
            found.extend(below_crate(&names, module, &BTreeSet::new()));
        }
    }
    found
}

/// Whether what ends with a semicolon is an import.
fn is_use(part: &str) -> bool {
    let line = part.trim_start_matches(|c: char| c != 'u' && c != 'p' && !c.is_alphanumeric());
    line.starts_with("use ") || line.starts_with("pub use ") || (line.starts_with("pub(") && line.contains(") use "))
}

/// The floor of a file and the prefix that says so.
fn floor_of(file: &str) -> (usize, &'static str) {
    let stem = file.trim_end_matches(".rs");
    let fits = |prefix: &str| stem == prefix || stem.strip_prefix(prefix).is_some_and(|rest| rest.starts_with('/'));
    let all =
        FLOORS.iter().enumerate().flat_map(|(floor, prefixes)| prefixes.iter().map(move |prefix| (floor, *prefix)));
    all.filter(|(_, prefix)| fits(prefix))
        .max_by_key(|(_, prefix)| prefix.len())
        .unwrap_or_else(|| panic!("src/{file} is on no floor: say in tests/house/mod.rs (FLOORS) where it belongs"))
}

#[test]
fn imports_run_down() {
    let house = House::read();
    let mut wrong = Vec::new();
    for (file, from) in house.imports() {
        let (floor, room) = floor_of(file);
        for other in from {
            let (other_floor, other_room) = floor_of(&other);
            if other_floor <= floor {
                continue;
            }
            wrong.push(format!(
                "src/{file} imports from src/{other}, but `{other_room}` stands above `{room}`: hand in what is needed, \
                 or move it down"
            ));
        }
    }
    assert!(wrong.is_empty(), "imports run up:\n{}", wrong.join("\n"));
}

#[test]
fn no_files_import_each_other_in_a_circle() {
    let house = House::read();
    let mut imports = house.imports();
    // A module and the files below it are one: methods of its types may stand in a file each.
    for (file, from) in &mut imports {
        let module = module_of(file);
        let parent: Vec<&str> = module[..module.len().saturating_sub(1)].iter().map(String::as_str).collect();
        if let Some(parent) = house.file_of(&parent) {
            from.remove(&parent);
        }
    }
    // What a file reaches, and whether that is itself.
    let mut circles = Vec::new();
    let mut told: BTreeSet<&str> = BTreeSet::new();
    for &start in imports.keys() {
        let mut came_from: BTreeMap<&str, &str> = BTreeMap::new();
        let mut queue = vec![start];
        while let Some(file) = queue.pop() {
            for next in &imports[file] {
                let (next, _) = imports.get_key_value(next.as_str()).unwrap();
                if *next == start && !told.contains(start) {
                    let mut circle = vec![file];
                    while *circle.last().unwrap() != start {
                        circle.push(came_from[circle.last().unwrap()]);
                    }
                    circle.reverse();
                    told.extend(circle.iter().copied());
                    circles.push(format!("{} -> {start}", circle.join(" -> ")));
                }
                if !came_from.contains_key(next) && *next != start {
                    came_from.insert(next, file);
                    queue.push(next);
                }
            }
        }
    }
    assert!(
        circles.is_empty(),
        "files import each other in a circle; take out of one what the others need:\n{}",
        circles.join("\n")
    );
}

#[test]
fn the_core_is_pure() {
    let house = House::read();
    let mut known = BTreeSet::new();
    let mut wrong = Vec::new();
    for (file, text) in &house.files {
        let (_, room) = floor_of(file);
        if !CORE.contains(&room) {
            continue;
        }
        for (banned, why) in BANNED_IN_CORE {
            if !text.contains(banned) {
                continue;
            }
            match MAY_TOUCH.iter().find(|(of, what, _)| of == file && what == banned) {
                Some(exception) => drop(known.insert(exception)),
                None => wrong.push(format!("src/{file} uses {banned}: {why}")),
            }
        }
    }
    assert!(wrong.is_empty(), "the core is not pure:\n{}", wrong.join("\n"));
    let stale: Vec<_> = MAY_TOUCH.iter().filter(|exception| !known.contains(exception)).collect();
    assert!(stale.is_empty(), "no longer needed, take them out of MAY_TOUCH: {stale:?}");
}

#[test]
fn the_reader_of_imports_reads() {
    let leaves =
        uses("pub use a::B;\nuse crate::{plan::{self, Plan}, edit::*};\nuse super::x::Y as Z;\nmod a;", &["m", "n"]);
    let texts: Vec<String> = leaves.iter().map(|(public, path)| format!("{public} {}", path.join("::"))).collect();
    assert_eq!(texts, ["true m::n::a::B", "false plan", "false plan::Plan", "false edit", "false m::x::Y"]);
    assert_eq!(inline_paths("let x = crate::plan::Plan::default();", &["m"]), [["plan", "Plan", "default"]]);
    assert_eq!(floor_of("app/session/files.rs").1, "app/session");
}
