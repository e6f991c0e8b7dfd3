//! What holds of every format in the list, and how the list finds the one that is meant.

use std::path::Path;

use enfilade::edit::set_meta;
use enfilade::formats::registry::{Ambiguous, find, foreign_kind};
use enfilade::formats::{
    self, DiskFolder, FORMATS, Files, Format, Head, Holds, Import, Importer, NamedPlan, Options, ReadError, Reading,
    Recognition, Source, manual,
};
use enfilade::labels::Schemes;
use enfilade::plan::{Meta, Plan};
use enfilade::store::bundled_plans;

use crate::support::enfilade;

#[test]
#[expect(clippy::disallowed_methods, reason = "a test's output is no user's file")]
fn the_manual_is_up_to_date() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/formats.md");
    let page = manual::page();
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        std::fs::write(&path, &page).unwrap();
    }
    let written = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(page == written, "docs/formats.md is stale: run with UPDATE_GOLDEN=1");
}

#[test]
fn ids_options_and_texts_are_in_order() {
    let mut ids: Vec<&str> = FORMATS.iter().map(|format| format.id).collect();
    ids.sort_unstable();
    ids.dedup();
    assert_eq!(ids.len(), FORMATS.len(), "two formats have one id");
    for format in FORMATS {
        assert!(format.importer.is_some() || format.exporter.is_some(), "{}", format.id);
        assert!(formats::known_formats().contains(format.name) || format.importer.is_none(), "{}", format.id);
        for option in manual::import_options(format).iter().chain(manual::export_options(format)) {
            assert!(option.name().chars().all(|letter| letter.is_ascii_lowercase() || letter == '-'));
            assert!(!option.help().is_empty() && !option.help().ends_with('.'), "{}", option.name());
        }
    }
}

/// Whatever a format writes it knows again, previews as it reads, and reads with all rooms.
#[test]
fn every_format_knows_what_it_wrote() {
    let schemes = Schemes::bundled();
    for (name, plan) in bundled_plans().unwrap() {
        for format in FORMATS {
            let (Some(importer), Some(exporter)) = (format.importer, format.exporter) else { continue };
            let export =
                exporter.write(&[NamedPlan { stem: "x", plan: &plan }], &schemes, &Options::default()).unwrap();
            for file in &export.files {
                let head = Head::File { name: "without ending", start: &file.bytes[..file.bytes.len().min(4096)] };
                assert_eq!(importer.recognises(&head), Recognition::Yes, "{} {name}", format.id);
                let source = Source::File { stem: "x", bytes: &file.bytes };
                let preview = importer.preview(&source, &Options::default()).unwrap();
                let plans = importer.read(&source, &Options::default()).unwrap().plans;
                let rooms: usize = plans.iter().map(|plan| plan.rooms().len()).sum();
                let openings: usize = plans.iter().map(|plan| plan.openings().len()).sum();
                assert_eq!((preview.plans, preview.rooms, preview.openings), (plans.len(), rooms, openings));
                assert_eq!(rooms, plan.rooms().len(), "{} {name}", format.id);
            }
            assert_eq!(exporter.holds(), Holds::OnePlan);
        }
    }
}

/// A format that is sure of what starts with its mark, and takes what ends in '.rooms' for possible.
struct Toy(&'static str);

impl Importer for Toy {
    fn recognises(&self, head: &Head<'_>) -> Recognition {
        match head {
            Head::File { start, .. } if start.starts_with(self.0.as_bytes()) => Recognition::Yes,
            Head::File { start, .. } if start.starts_with(b"%PDF") && head.ends_with(&["rooms"]) => {
                Recognition::Foreign("a PDF".to_owned())
            }
            Head::File { .. } if head.ends_with(&["rooms"]) => Recognition::Perhaps,
            Head::Folder { files } if files.iter().any(|name| name == self.0) => Recognition::Yes,
            _ => Recognition::No,
        }
    }

    fn read(&self, source: &Source<'_>, _options: &Options) -> Result<Import, ReadError> {
        let bytes = match source {
            Source::File { bytes, .. } => bytes.to_vec(),
            Source::Folder { files, .. } => files.read(self.0)?,
        };
        let name = format!("{} bytes", bytes.len());
        let plan = set_meta(&Plan::default(), Meta { name, ..Meta::default() });
        Ok(Import { plans: vec![plan], notes: Vec::new() })
    }
}

const fn toy(id: &'static str, importer: &'static Toy) -> Format {
    Format { id, name: "Toy", endings: &["rooms"], about: "", importer: Some(importer), exporter: None }
}

static A: Format = toy("a", &Toy("aaa"));
static B: Format = toy("b", &Toy("bbb"));

fn found(formats: &[&Format], name: &str, start: &[u8]) -> Result<Option<&'static str>, Ambiguous> {
    find(formats, &Head::File { name, start }).map(|found| found.map(|(format, _)| format.id))
}

#[test]
fn the_name_never_decides_between_two() {
    let both = &[&A, &B];
    assert_eq!(found(both, "x.rooms", b"bbb"), Ok(Some("b")));
    assert_eq!(found(both, "x.txt", b"bbb"), Ok(Some("b")));
    assert_eq!(found(both, "x.rooms", b"???"), Err(Ambiguous(vec!["a", "b"])));
    assert_eq!(found(&[&A], "x.rooms", b"???"), Ok(Some("a")));
    assert_eq!(found(both, "x.txt", b"???"), Ok(None));
    assert_eq!(found(both, "x.rooms", b"%PDF"), Ok(None));
    let pdf = Head::File { name: "x.rooms", start: b"%PDF" };
    assert_eq!(foreign_kind(both, &pdf).as_deref(), Some("a PDF"));
    // Another format may know what one takes for foreign.
    let known = Head::File { name: "x.rooms", start: b"aaa" };
    assert_eq!(foreign_kind(both, &known), None);
}

#[test]
#[expect(clippy::disallowed_methods, reason = "a test's output is no user's file")]
fn a_folder_can_be_a_plan() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::File::create(folder.path().join("bbb")).unwrap().set_len(7).unwrap();
    let files = DiskFolder::open(folder.path()).unwrap();
    let (format, importer) = find(&[&A, &B], &Head::Folder { files: files.names() }).unwrap().unwrap();
    assert_eq!(format.id, "b");
    let import = importer.read(&Source::Folder { stem: "x", files: &files }, &Options::default()).unwrap();
    assert_eq!(import.plans[0].meta().name, "7 bytes");
    for outside in ["../secret", "/etc/passwd", "missing"] {
        assert!(files.read(outside).unwrap_err().to_string().contains("is not in the folder"), "{outside}");
    }
}

#[test]
fn options_reach_the_readers() {
    let xml = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/import/cases/no_scale.xml");
    let width = |options: &[&str]| {
        let reading = Reading { from: None, options: options.iter().map(ToString::to_string).collect() };
        reading.check().unwrap();
        let (_, preview) = reading.preview(&xml).unwrap();
        let plan = &reading.file(&xml).unwrap().plans[0];
        let xs: Vec<f64> = plan.corners().map(|(_, corner)| corner.position.x).collect();
        let read = xs.iter().copied().fold(f64::MIN, f64::max) - xs.iter().copied().fold(f64::MAX, f64::min);
        assert!((preview.size.unwrap().0 - read).abs() < 1e-3, "{preview:?} {read}");
        read
    };
    let (small, large) = (width(&["metres-per-pixel=0.01"]), width(&["metres-per-pixel=0.02"]));
    assert!((large / small - 2.0).abs() < 0.01, "{small} {large}");
    assert!((width(&[]) - small).abs() > 0.01);
}

#[test]
fn the_command_line_says_what_is_there_and_what_is_lost() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).display().to_string();
    let xml = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/import/cases/plain.xml");
    let (code, out, _) = enfilade(["import", "--preview", xml]);
    assert_eq!(code, 0);
    assert!(out.contains("plain.xml: XML of the paper's authors: 1 plan, 2 rooms, 1 opening, 0 walls, "), "{out}");
    let plan = concat!(env!("CARGO_MANIFEST_DIR"), "/plans/office.plan.json");
    let (code, _, err) = enfilade(["export", plan, "-o", &at("all.geojson")]);
    assert_eq!((code, err.as_str()), (0, ""));
    let (code, _, err) = enfilade(["export", plan, "-o", &at("rooms.geojson"), "--option", "rooms-only=yes"]);
    assert_eq!(code, 0);
    assert!(err.starts_with("rooms: GeoJSON does not keep ") && err.contains(" openings"), "{err}");
    let features = |name: &str| {
        let text = std::fs::read_to_string(at(name)).unwrap();
        serde_json::from_str::<serde_json::Value>(&text).unwrap()["features"].as_array().unwrap().len()
    };
    assert!(features("rooms.geojson") < features("all.geojson"));
    for (arguments, expected) in [
        (vec!["export", plan, "-o", &at("x.geojson"), "--option", "colour=red"], "there is no option 'colour'"),
        (vec!["export", plan, "-o", &at("x.geojson"), "--option", "rooms-only=2"], "use yes or no"),
        (vec!["export", plan, "-o", &at("x.dwg")], "not a folder and not a file with a known ending"),
        (vec!["export", plan, "-o", &at("x"), "--format", "dwg"], "cannot write '.dwg'; known endings: .plan.json"),
        (vec!["import", xml, "-o", &at("out"), "--from", "dwg"], "use one of enfilade, authors-xml, kth-xml, geojson"),
        (vec!["import", xml, "-o", &at("out"), "--from", "geojson"], "is no JSON object: it starts with '<'"),
        (vec!["import", xml, "-o", &at("out"), "--option", "metres=1"], "'metres' cannot be '1'; use yes or no"),
    ] {
        let (code, _, err) = enfilade(&arguments);
        assert!(code != 0 && err.contains(expected), "{arguments:?}: {err}");
    }
    for command in ["import", "export"] {
        let (_, help, _) = enfilade([command, "--help"]);
        for format in FORMATS {
            let is_listed = if command == "import" { format.importer.is_some() } else { format.exporter.is_some() };
            assert_eq!(help.contains(&format!("  {}", format.id)), is_listed, "{command} {}", format.id);
        }
    }
}
