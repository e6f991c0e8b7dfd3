//! What holds for every subcommand, from clap's own list: a new one needs a line in [`CALLS`], and all of this holds
//! for it, or a test says what does not.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use enfilade::cli;
use serde_json::Value;

use crate::support::enfilade;

mod names;

/// What a subcommand writes with `-o`.
#[derive(Clone, Copy, PartialEq)]
enum Output {
    None,
    /// A file of this name.
    File(&'static str),
    /// Files in a folder.
    Folder,
}

/// A call of a subcommand that works, in a folder made by [`Workshop`]; `{out}` is where it writes.
struct Call {
    name: &'static str,
    words: &'static str,
    output: Output,
    /// The word that names what is read, if anything is.
    reads: Option<&'static str>,
}

const fn call(name: &'static str, words: &'static str, reads: &'static str, output: Output) -> Call {
    Call { name, words, output, reads: if reads.is_empty() { None } else { Some(reads) } }
}

/// A line for each subcommand.
#[rustfmt::skip]
const CALLS: &[Call] = &[
    call("import", "plans -o {out}", "plans", Output::Folder),
    call("features", "plans -o {out}", "plans", Output::File("rooms.csv")),
    call("dataset", "plans -o {out}", "plans", Output::File("rooms.csv")),
    call("export", "plan.plan.json -o {out}", "plan.plan.json", Output::File("x.geojson")),
    call("check", "plans", "plans", Output::None),
    call("workspace", "plans --no-index", "plans", Output::None),
    call("render", "plan.plan.json -o {out} --size 200", "plan.plan.json", Output::File("x.png")),
    call("classify", "plan.plan.json --algorithm tree --write -o {out}", "plan.plan.json", Output::File("x.plan.json")),
    call("evaluate", "rooms.csv --folds 2 -o {out}", "rooms.csv", Output::Folder),
    call("train", "rooms.csv --algorithm tree --folds 0 --typology standard -o {out}", "rooms.csv", Output::File("x.model.json")),
    call("suspects", "labelled --folds 2 -o {out}", "labelled", Output::File("suspects.csv")),
    call("review", "labelled --folds 2", "labelled", Output::None),
    call("compare", "labelled labelled -o {out}", "labelled", Output::File("differences.csv")),
    call("label", "plans --from {fixes} --dry-run", "plans", Output::None),
    call("models", "", "", Output::None),
    call("explore", "plan.plan.json --range 5 -o {out}", "plan.plan.json", Output::Folder),
    call("map", "robot.log -o {out}", "robot.log", Output::Folder),
    call("segment", "map.png --resolution 0.1 -o {out}", "map.png", Output::Folder),
    call("robot-study", "plans --sensor-noise 1 --odometry-noise 1 --furniture 0 -o {out}", "plans", Output::Folder),
    #[cfg(feature = "gui")]
    call("replay", "s.replay -o {out}", "s.replay", Output::None),
    #[cfg(feature = "gui")]
    call("commands", "", "", Output::None),
    call("completions", "bash -o {out}", "", Output::File("enfilade.bash")),
    call("man", "-o {out}", "", Output::Folder),
];

/// A folder with something to read for every subcommand.
struct Workshop(tempfile::TempDir);

/// Two rooms of 4 x 3 m with a door between them, labelled.
fn small_plan(name: &str) -> enfilade::plan::Plan {
    let text = format!(
        r#"{{"type":"FeatureCollection","units":"m","name":"{name}","typology":"school","features":[
{{"type":"Feature","geometry":{{"type":"Polygon","coordinates":[[[0,0],[4,0],[4,3],[0,3],[0,0]]]}},"properties":{{"kind":"room","name":"{name} one","function":"classroom","label":"M"}}}},
{{"type":"Feature","geometry":{{"type":"Polygon","coordinates":[[[4,0],[8,0],[8,3],[4,3],[4,0]]]}},"properties":{{"kind":"room","name":"two","function":"corridor","label":"C"}}}},
{{"type":"Feature","geometry":{{"type":"LineString","coordinates":[[4,1],[4,2]]}},"properties":{{"kind":"opening","opening":"door"}}}}]}}"#
    );
    let import = enfilade::formats::read_from(Path::new("small.geojson"), text.as_bytes()).unwrap();
    import.plans.into_iter().next().unwrap()
}

impl Workshop {
    fn new() -> Self {
        let workshop = Self(tempfile::tempdir().unwrap());
        let folder = workshop.0.path();
        let write = |name: &str, bytes: &[u8]| {
            let path = folder.join(name);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, bytes).unwrap();
        };
        let bytes = |name: &str| enfilade::formats::plan_json::to_bytes(&small_plan(name));
        write("plan.plan.json", &bytes("plan"));
        write("plans/a/x.plan.json", &bytes("ax"));
        write("plans/b/x.plan.json", &bytes("bx"));
        for name in ["dwelling", "office", "school"] {
            let plan = Path::new(env!("CARGO_MANIFEST_DIR")).join("plans").join(format!("{name}.plan.json"));
            write(&format!("labelled/{name}.plan.json"), &std::fs::read(plan).unwrap());
        }
        std::fs::create_dir(folder.join("empty")).unwrap();
        let mut rows = String::from("typology,building,storey,plan,room,function,label,a,rt,d,l_S,l_M,l_B,l_C,l_H\n");
        for i in 0..24 {
            let (label, area, doors) = [("S", 6, 1), ("C", 30, 5), ("M", 20, 2)][i % 3];
            rows += &format!("school,b{},0,p{i},r{i},f,{label},{area}.{i},1.{i},{doors},0,0,0,1,0\n", i / 3);
        }
        write("rooms.csv", rows.as_bytes());
        let room = small_plan("ax").rooms().next().unwrap().0;
        write("fixes.csv", format!("file,id,label\nplans/a/x.plan.json,{room},B\n").as_bytes());
        let mut log = String::new();
        for i in 0..6 {
            let ranges = ["2.0"; 180].join(" ");
            let x = f64::from(i) * 0.1;
            log += &format!("FLASER 180 {ranges} {x} 0 0 {x} 0 0 {i}.0 host {i}.0\n");
        }
        write("robot.log", log.as_bytes());
        write("map.png", &map_png());
        write("s.replay", b"open-sample dwelling\n");
        workshop
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// The words of a call, files by their full paths.
    fn words(&self, call: &Call, out: &Path, instead: Option<&str>) -> Vec<String> {
        let word = |word: &str| match word {
            "{out}" => out.display().to_string(),
            "{fixes}" => self.path("fixes.csv").display().to_string(),
            word if Some(word) == call.reads => self.path(instead.unwrap_or(word)).display().to_string(),
            word => word.to_owned(),
        };
        std::iter::once(call.name.to_owned()).chain(call.words.split_whitespace().map(word)).collect()
    }

    /// Where a call writes.
    fn out(&self, call: &Call) -> PathBuf {
        match call.output {
            Output::File(name) => self.path(&format!("out-{}-{name}", call.name)),
            _ => self.path(&format!("out-{}", call.name)),
        }
    }
}

/// A room of 8 x 6 m, free within a wall.
fn map_png() -> Vec<u8> {
    let (width, height) = (90_u32, 70_u32);
    let is_free = |x: u32, y: u32| (5..85).contains(&x) && (5..65).contains(&y);
    let pixels: Vec<u8> =
        (0..height).flat_map(|y| (0..width).map(move |x| if is_free(x, y) { 255 } else { 0 })).collect();
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.write_header().unwrap().write_image_data(&pixels).unwrap();
    bytes
}

/// The files below a path, by their paths.
fn files(path: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    if path.is_file() {
        found.insert(path.to_owned(), std::fs::read(path).unwrap());
    }
    for entry in std::fs::read_dir(path).into_iter().flatten() {
        found.extend(files(&entry.unwrap().path()));
    }
    found
}

#[test]
fn every_subcommand_has_a_line() {
    let all: BTreeSet<String> = cli::command().get_subcommands().map(|sub| sub.get_name().to_owned()).collect();
    let listed: BTreeSet<String> = CALLS.iter().map(|call| call.name.to_owned()).collect();
    assert_eq!(all, listed, "tests/commandline/mod.rs: CALLS has a line for each subcommand");
}

#[test]
fn help_has_an_example_and_wrong_calls_are_told_before_any_work() {
    for call in CALLS {
        let (code, out, err) = enfilade([call.name, "--help"]);
        assert_eq!((code, err.as_str()), (0, ""), "{}", call.name);
        assert!(out.contains("Example:\n  enfilade"), "{}: no example", call.name);
        for wrong in [&["--no-such-option"][..], &["--jobs", "0"], &["--jobs", "many"], &["-q", "-v"]] {
            let workshop = Workshop::new();
            let out = workshop.out(call);
            let mut words = workshop.words(call, &out, None);
            words.extend(wrong.iter().map(|&word| word.to_owned()));
            let (code, text, err) = enfilade(&words);
            assert_eq!((code, text.as_str()), (2, ""), "{words:?}: {err}");
            assert!(!out.exists() && !err.is_empty(), "{words:?} worked");
        }
    }
}

#[test]
fn calls_that_do_not_fit_together_are_wrong_before_any_work() {
    let workshop = Workshop::new();
    let plans = workshop.path("plans").display().to_string();
    let plan = workshop.path("plan.plan.json").display().to_string();
    let out = |name: &str| workshop.path(name).display().to_string();
    for words in [
        vec!["export", &plan, "-o", &out("x.unknown")],
        vec!["export", &plan, "-o", &out("x.geojson"), "--option", "no=1"],
        vec!["export", &plans, "-o", &out("x.geojson")],
        vec!["export", &plan, "-o", &out("x"), "--format", "unknown"],
        vec!["render", &plan, "-o", &out("x.gif")],
        vec!["render", &plans, "-o", &out("x.png")],
        vec!["render", &plan, "-o", &out("x.png"), "--typology", "unknown"],
        vec!["classify", &plans, "--write", "-o", &out("x.plan.json")],
        vec!["classify", &plan, "--models", &out("nowhere")],
        vec!["explore", &plan, "-o", &out("x"), "--closed", "2"],
        vec!["segment", &out("map.png"), "-o", &out("x")],
        vec!["segment", &out("map.png"), "-o", &out("x"), "--resolution", "-1"],
        vec!["import", &plans, "-o", &out("x"), "--option", "no=1"],
        vec!["import", &plans, "-o", &plan],
        vec!["evaluate", &out("rooms.csv"), &plans, "-o", &out("x")],
        vec!["map", &out("robot.log"), "-o", &plan],
    ] {
        let before = files(workshop.0.path());
        let (code, text, err) = enfilade(&words);
        assert_eq!((code, text.as_str()), (2, ""), "{words:?}: {err}");
        assert_eq!(files(workshop.0.path()), before, "{words:?} wrote");
    }
}

#[test]
fn one_name_for_one_option() {
    let command = cli::command();
    let mut shorts: BTreeMap<String, Option<char>> = BTreeMap::new();
    for sub in command.get_subcommands() {
        let has = |long: &str| sub.get_arguments().any(|argument| argument.get_long() == Some(long));
        for common in ["quiet", "verbose", "jobs"] {
            assert!(has(common), "{} lacks --{common}", sub.get_name());
        }
        assert_eq!(has("output"), has("force"), "{}: --force goes with --output", sub.get_name());
        for argument in sub.get_arguments() {
            let Some(long) = argument.get_long() else { continue };
            let told = format!("{} --{long}", sub.get_name());
            assert!(
                !["out", "output-dir", "threads", "dest", "color"].contains(&long),
                "{told}: another name is in use"
            );
            let short = argument.get_short();
            let first = *shorts.entry(long.to_owned()).or_insert(short);
            assert_eq!(short, first, "{told} has another letter elsewhere");
            assert!(argument.get_help().is_some(), "{told} has no help");
        }
    }
    assert_eq!((shorts["output"], shorts["jobs"]), (Some('o'), Some('j')));
}

#[test]
fn results_replace_only_what_the_same_command_made() {
    for call in CALLS.iter().filter(|call| call.output != Output::None) {
        let workshop = Workshop::new();
        let out = workshop.out(call);
        let words = workshop.words(call, &out, None);
        let (code, _, err) = enfilade(&words);
        assert_eq!(code, 0, "{words:?}: {err}");
        let first = files(&out);
        assert!(!first.is_empty(), "{words:?} wrote nothing");
        let (code, _, err) = enfilade(&words);
        assert_eq!(code, 0, "again: {words:?}: {err}");

        // Somebody works on them.
        for (path, bytes) in &first {
            // A semantic map is there to be worked on: what people write into it is taken over.
            if path.to_string_lossy().ends_with("_semantics.yaml") {
                continue;
            }
            let mut changed = bytes.clone();
            changed.extend_from_slice(b"\nmine\n");
            std::fs::write(path, changed).unwrap();
        }
        let mine = files(&out);
        let (code, _, err) = enfilade(&words);
        assert_eq!(code, 1, "{words:?} replaced what somebody changed: {err}");
        assert!(err.contains("--force"), "{words:?}: {err}");
        assert!(files(&out) == mine, "{words:?} replaced what somebody changed");
        let forced = [words.clone(), vec!["--force".to_owned()]].concat();
        let (code, _, err) = enfilade(&forced);
        assert_eq!(code, 0, "{forced:?}: {err}");
        assert!(files(&out).keys().eq(first.keys()) && files(&out) != mine, "{forced:?}");

        // An input is no exception, nor is a plan.
        if let (Output::File(_), Some(reads)) = (call.output, call.reads)
            && workshop.path(reads).is_file()
        {
            let ending = call.output_ending();
            let input = workshop.path(&format!("input{ending}"));
            std::fs::write(&input, "somebody's").unwrap();
            let (code, _, _) = enfilade(workshop.words(call, &input, None));
            assert_eq!(code, 1, "{}: replaced a file of somebody's", call.name);
            assert_eq!(std::fs::read(&input).unwrap(), b"somebody's");
        }
    }
}

impl Call {
    fn output_ending(&self) -> &'static str {
        match self.output {
            Output::File(name) => &name[name.find('.').unwrap_or(0)..],
            _ => "",
        }
    }
}

#[test]
fn a_command_replaces_its_own_results() {
    let workshop = Workshop::new();
    let out = workshop.path("table.csv");
    for plans in ["plan.plan.json", "plans", "plan.plan.json"] {
        let (code, _, err) = enfilade([Path::new("features"), &workshop.path(plans), Path::new("-o"), &out]);
        assert_eq!(code, 0, "{plans}: {err}");
    }
    // Another command's is not its own.
    let (code, _, _) = enfilade([Path::new("dataset"), &workshop.path("plans"), Path::new("-o"), &out]);
    assert_eq!(code, 1);
}

#[test]
fn nothing_to_read_has_one_outcome() {
    for call in CALLS.iter().filter(|call| call.reads.is_some()) {
        for instead in ["nowhere.plan.json", "empty", "empty/none.csv"] {
            let workshop = Workshop::new();
            let out = workshop.out(call);
            let words = workshop.words(call, &out, Some(instead));
            let (code, text, err) = enfilade(&words);
            assert_eq!(code, 1, "{words:?}: {text}{err}");
            assert!(err.contains(&workshop.path(instead).display().to_string()), "{words:?}: {err}");
            assert!(err.lines().all(|line| line.starts_with("enfilade: ")), "{words:?}: {err}");
            assert!(files(&out).is_empty(), "{words:?} wrote");
        }
    }
}

#[test]
fn a_dash_and_dev_stdout_are_stdout() {
    for call in CALLS.iter().filter(|call| call.output != Output::None) {
        let workshop = Workshop::new();
        let out = workshop.out(call);
        let is_folder = call.output == Output::Folder && call.name != "man";
        if !is_folder && !matches!(call.name, "render" | "man") {
            assert_eq!(enfilade(workshop.words(call, &out, None)).0, 0);
        }
        for name in ["-", "/dev/stdout"] {
            let before = files(workshop.0.path());
            let words = workshop.words(call, Path::new(name), None);
            if call.name == "render" {
                // A picture as text.
                let words = [words, vec!["--format".to_owned(), "svg".to_owned()]].concat();
                let (code, text, err) = enfilade(&words);
                assert!(code == 0 && text.starts_with("<svg"), "{words:?}: {err}");
                continue;
            }
            let (code, text, err) = enfilade(&words);
            assert_eq!(code, if is_folder { 2 } else { 0 }, "{words:?}: {err}");
            assert_eq!(files(workshop.0.path()), before, "{words:?} wrote files");
            if let Output::File(_) = call.output {
                let file = std::fs::read_to_string(&out).unwrap();
                // Exports name the plan after the file.
                let same = |text: &str| text.replace("out-export-x", "plan");
                assert_eq!(same(&text), same(&file), "{words:?}");
            }
        }
    }
}

#[test]
fn quiet_calls_say_nothing_beside_results() {
    for call in CALLS.iter().filter(|call| call.output != Output::None && call.name != "evaluate") {
        let workshop = Workshop::new();
        let out = workshop.out(call);
        let words = [workshop.words(call, &out, None), vec!["-q".to_owned()]].concat();
        let (code, text, err) = enfilade(&words);
        let is_table = call.name == "classify";
        assert!(code == 0 && err.is_empty() && (is_table || text.is_empty()), "{words:?}: {text}{err}");
    }
}

/// The names of all members of objects.
fn keys(value: &Value, found: &mut BTreeSet<String>) {
    match value {
        Value::Object(members) => {
            for (name, value) in members {
                // Names that are data: labels, features, typologies, layers, figures.
                let is_word = name.chars().all(|c| c.is_ascii_lowercase() || c == '_') && name.len() > 1;
                if is_word {
                    found.insert(name.clone());
                }
                keys(value, found);
            }
        }
        Value::Array(items) => items.iter().for_each(|item| keys(item, found)),
        _ => {}
    }
}

#[test]
fn json_has_a_version_and_a_page_that_names_all_it_holds() {
    for sub in cli::command().get_subcommands() {
        let has_json = sub.get_arguments().any(|argument| argument.get_id() == "json");
        let name = sub.get_name();
        let page = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("docs/json/{name}.md"));
        assert_eq!(has_json, page.is_file(), "{name}: --json and docs/json/{name}.md go together");
        if !has_json {
            continue;
        }
        let call = CALLS.iter().find(|call| call.name == name).unwrap();
        let workshop = Workshop::new();
        let mut words = workshop.words(call, &workshop.out(call), None);
        // The table of 'features' goes to the output as JSON.
        if name == "features" {
            words.truncate(2);
        }
        words.push("--json".to_owned());
        let (code, text, err) = enfilade(&words);
        assert_eq!(code, 0, "{words:?}: {err}");
        let value: Value = serde_json::from_str(&text).unwrap_or_else(|error| panic!("{name}: {error}: {text:.300}"));
        assert!(value["version"].is_u64(), "{name} --json has no version");
        let mut all = BTreeSet::new();
        keys(&value, &mut all);
        let text = std::fs::read_to_string(&page).unwrap();
        let missing: Vec<&String> = all.iter().filter(|key| !text.contains(&format!("`{key}`"))).collect();
        assert!(missing.is_empty(), "docs/json/{name}.md does not tell of {missing:?}");
        let index = std::fs::read_to_string(page.with_file_name("README.md")).unwrap();
        assert!(index.contains(&format!("({name}.md)")), "docs/json/README.md leaves out {name}.md");
    }
}

#[cfg(unix)]
#[test]
fn one_bad_file_or_a_circle_of_links_never_ends_the_rest() {
    for call in [
        call("import", "plans -o {out}", "plans", Output::Folder),
        call("export", "plans -o {out}", "plans", Output::Folder),
        call("render", "plans -o {out} --size 100", "plans", Output::Folder),
        call("classify", "plans --algorithm tree --write -o {out}", "plans", Output::Folder),
    ] {
        let workshop = Workshop::new();
        std::fs::write(workshop.path("plans/a/broken.plan.json"), "{").unwrap();
        let link = |to: &str, name: &str| std::os::unix::fs::symlink(to, workshop.path(name)).unwrap();
        link("..", "plans/b/circle");
        link("nowhere", "plans/b/gone.plan.json");
        // An editor's lock: hidden, and leading nowhere on purpose.
        link("user@host.123", "plans/b/.#x.plan.json");
        let out = workshop.out(&call);
        let (code, text, err) = enfilade(workshop.words(&call, &out, None));
        assert_eq!(code, 1, "{}: {text}{err}", call.name);
        for wrong in ["broken.plan.json", "circle", "gone.plan.json"] {
            assert!(err.contains(wrong), "{}: nothing of {wrong}: {err}", call.name);
        }
        assert!(!err.contains(".#x"), "{}: {err}", call.name);
        let written: Vec<String> = files(&out)
            .keys()
            .map(|path| path.strip_prefix(&out).unwrap().display().to_string())
            .map(|path| path[..path.find('.').unwrap()].to_owned())
            .collect();
        assert_eq!(written, ["a/x", "b/x"], "{}: {err}", call.name);
    }
}

#[test]
fn a_plan_beside_its_export_gives_two_results() {
    let workshop = Workshop::new();
    let beside = workshop.path("plans/a/x.geojson");
    let words = [Path::new("export"), &workshop.path("plan.plan.json"), Path::new("-o"), &beside];
    assert_eq!(enfilade(words).0, 0);
    let out = workshop.path("pictures");
    let (code, _, err) = enfilade([Path::new("render"), &workshop.path("plans"), Path::new("-o"), &out]);
    assert_eq!(code, 0, "{err}");
    let names: Vec<PathBuf> = files(&out).into_keys().map(|path| path.strip_prefix(&out).unwrap().to_owned()).collect();
    assert_eq!(names, ["a/x.plan.json.png", "a/x.png", "b/x.png"].map(PathBuf::from));
}

#[test]
fn what_a_format_does_not_keep_is_said_once() {
    let folder = tempfile::tempdir().unwrap();
    for (name, plan) in enfilade::store::bundled_plans().unwrap() {
        let meta = enfilade::plan::Meta { source: "scan".to_owned(), ..plan.meta().clone() };
        let bytes = enfilade::formats::plan_json::to_bytes(&enfilade::edit::set_meta(&plan, meta));
        std::fs::write(folder.path().join(name), bytes).unwrap();
    }
    let out = folder.path().join("out");
    let (code, _, err) = enfilade([Path::new("export"), folder.path(), Path::new("-o"), &out]);
    assert_eq!(code, 0);
    assert!(err.lines().count() <= 1, "{err}");
}

#[test]
fn a_mistyped_subcommand_is_told_with_its_nearest_name() {
    for (word, expected) in
        [("feautres", "'features'"), ("Render", "'render'"), ("exprot", "'export'"), ("classif", "'classify'")]
    {
        for more in [&[][..], &["plans", "-o", "x"]] {
            let (code, _, err) = enfilade([&[word][..], more].concat());
            assert!(code == 2 && err.contains(expected), "{word} {more:?}: {err}");
        }
    }
    let (code, _, err) = enfilade(["zzzzzz"]);
    assert!(code == 2 && err.contains("neither a subcommand nor a file") && err.contains("render"), "{err}");
    let (code, _, err) = enfilade(["no/such.plan.json"]);
    assert!(code == 1 && err.contains("no/such.plan.json"), "{err}");
}

#[test]
fn the_version_names_the_commit_where_there_is_one() {
    let (code, text, _) = enfilade(["--version"]);
    assert_eq!(code, 0);
    assert!(text.starts_with(&format!("enfilade {}", env!("CARGO_PKG_VERSION"))), "{text}");
    let has_git = Path::new(env!("CARGO_MANIFEST_DIR")).join(".git").exists()
        && std::process::Command::new("git").arg("--version").output().is_ok();
    if has_git {
        assert!(text.contains("commit "), "{text}");
    }
}

#[test]
fn completions_and_pages_name_every_subcommand() {
    let folder = tempfile::tempdir().unwrap();
    let names: Vec<String> = cli::command().get_subcommands().map(|sub| sub.get_name().to_owned()).collect();
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let (code, text, _) = enfilade(["completions", shell]);
        assert!(code == 0 && names.iter().all(|name| text.contains(name.as_str())), "{shell}");
    }
    assert_eq!(enfilade([Path::new("man"), Path::new("-o"), folder.path()]).0, 0);
    for name in names {
        let page = std::fs::read_to_string(folder.path().join(format!("enfilade-{name}.1"))).unwrap();
        assert!(page.contains(".SH NAME") && page.contains("Example"), "{name}");
    }
}
