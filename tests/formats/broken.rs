//! Bad input is normal: every broken file is refused in words that say what, where and what to do.
//! The words stand beside each file.

use std::fmt::Write as _;
use std::path::Path;

use enfilade::formats::plan_json::{from_bytes, to_bytes};
use enfilade::formats::{Import, ReadError, geojson as format, read_file, read_from};
use enfilade::labels::Schemes;
use proptest::prelude::*;
use proptest::sample::Index;

use super::golden::{assert_golden, fixture};
use super::plan_json::full_plan;
use super::{geojson, real};

/// The names of the fixtures in a folder, sorted.
fn fixtures(folder: &str) -> Vec<String> {
    let entries = std::fs::read_dir(fixture(folder)).unwrap();
    let mut names: Vec<String> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.retain(|name| !name.ends_with(".txt"));
    names.sort();
    names
}

#[test]
fn every_broken_file_is_refused_in_words() {
    let names = fixtures("broken");
    assert!(names.len() > 70);
    for name in names {
        let name = format!("broken/{name}");
        let error = read_file(&fixture(&name)).expect_err(&name).error;
        assert!(!error.hint.is_empty(), "{name}: no hint");
        assert_golden(&format!("{name}.txt"), &format!("{error}\n"));
    }
}

#[test]
fn what_is_healed_or_skipped_is_reported() {
    for name in fixtures("healed") {
        let name = format!("healed/{name}");
        let import = read_file(&fixture(&name)).unwrap();
        let mut text = String::new();
        for note in &import.notes {
            writeln!(text, "{note}").unwrap();
        }
        assert_golden(&format!("{name}.txt"), &format!("{text}{}", geojson::kept(&import.plans[0])));
    }
}

#[test]
fn a_room_of_a_hundred_thousand_corners_is_read() {
    let mut text = String::from(
        r#"{"type": "FeatureCollection", "units": "m", "features": [{"type": "Feature", "geometry": {"type": "Polygon", "coordinates": [["#,
    );
    let count = 100_000;
    for i in 0..count {
        let turn = f64::from(i) / f64::from(count) * std::f64::consts::TAU;
        write!(text, "[{:.4},{:.4}],", 50_000.0 * turn.cos(), 50_000.0 * turn.sin()).unwrap();
    }
    text.push_str(r#"[50000,0]]]}, "properties": {"kind": "room"}}]}"#);
    let plan = &geojson::read(&text).plans[0];
    assert_eq!(plan.corners().len(), 100_000);
    let bytes = to_bytes(plan);
    assert_eq!(from_bytes(&bytes).unwrap(), *plan);
}

#[test]
fn a_missing_file_and_a_folder_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    for path in [folder.path(), &folder.path().join("none.plan.json")] {
        let error = enfilade::store::load_plan(path).expect_err("nothing to load");
        assert!(error.to_string().starts_with(&path.display().to_string()), "{error}");
        assert_eq!(error.error.hint, "check the path");
    }
}

/// Something that goes wrong with a file on its way.
#[derive(Clone, Debug)]
enum Damage {
    Cut(Index),
    Flip(Index, u8),
    LineTwice(Index, Index),
    LineGone(Index),
    Number(Index, &'static str),
    Text(Index, Index),
}

fn damage() -> impl Strategy<Value = Damage> {
    let number = prop::sample::select(
        ["NaN", "Infinity", "1e999", "1e9", "-1e308", "1e-320", "null", "\"0\"", "[]", "{}", "0", "-", "4,4"]
            .as_slice(),
    );
    prop_oneof![
        1 => any::<Index>().prop_map(Damage::Cut),
        3 => (any::<Index>(), any::<u8>()).prop_map(|(at, byte)| Damage::Flip(at, byte)),
        2 => (any::<Index>(), any::<Index>()).prop_map(|(line, to)| Damage::LineTwice(line, to)),
        2 => any::<Index>().prop_map(Damage::LineGone),
        4 => (any::<Index>(), number).prop_map(|(at, number)| Damage::Number(at, number)),
        2 => (any::<Index>(), any::<Index>()).prop_map(|(from, to)| Damage::Text(from, to)),
    ]
}

/// Where the numbers (or, with a quote, the texts) of a JSON file start and end, roughly.
fn spans(bytes: &[u8], inside: impl Fn(u8) -> bool) -> Vec<std::ops::Range<usize>> {
    let mut spans = Vec::new();
    let mut start = None;
    for (i, &byte) in bytes.iter().enumerate() {
        match (inside(byte), start) {
            (true, None) => start = Some(i),
            (false, Some(from)) => {
                spans.push(from..i);
                start = None;
            }
            _ => {}
        }
    }
    spans
}

fn damaged(mut bytes: Vec<u8>, damages: &[Damage]) -> Vec<u8> {
    let is_number = |byte: u8| byte.is_ascii_digit() || byte == b'.' || byte == b'-';
    let is_text = |byte: u8| byte.is_ascii_alphanumeric() || byte == b'_';
    for damage in damages {
        if bytes.is_empty() {
            return bytes;
        }
        let lines: Vec<&[u8]> = bytes.split_inclusive(|&byte| byte == b'\n').collect();
        match damage {
            Damage::Cut(at) => bytes.truncate(at.index(bytes.len())),
            Damage::Flip(at, byte) => {
                let at = at.index(bytes.len());
                bytes[at] = *byte;
            }
            Damage::LineTwice(line, to) => {
                let mut lines = lines.clone();
                lines.insert(to.index(lines.len()), lines[line.index(lines.len())]);
                bytes = lines.concat();
            }
            Damage::LineGone(line) => {
                let mut lines = lines.clone();
                lines.remove(line.index(lines.len()));
                bytes = lines.concat();
            }
            Damage::Number(at, number) => {
                let spans = spans(&bytes, is_number);
                if !spans.is_empty() {
                    bytes.splice(at.get(&spans).clone(), number.bytes());
                }
            }
            Damage::Text(from, to) => {
                let spans = spans(&bytes, is_text);
                if !spans.is_empty() {
                    let text = bytes[from.get(&spans).clone()].to_vec();
                    bytes.splice(to.get(&spans).clone(), text);
                }
            }
        }
    }
    bytes
}

/// Files of both formats: ours, and a few real ones where they are.
fn originals() -> Vec<Vec<u8>> {
    let mut originals = vec![to_bytes(&full_plan()), geojson::written(&full_plan()).into_bytes()];
    for path in real::files("r2v").into_iter().step_by(151).chain(real::files("archilyse").into_iter().take(1)) {
        let bytes = std::fs::read(path).unwrap();
        originals.push(to_bytes(&format::from_bytes(&bytes, "").unwrap().plans[0]));
        originals.push(bytes);
    }
    originals
}

/// Whatever a reader gives is whole: a valid plan that saves and loads, or an error in words.
fn check(result: Result<Import, ReadError>) -> Result<(), TestCaseError> {
    match result {
        Err(error) => {
            prop_assert!(!error.what.trim().is_empty());
            prop_assert!(!error.hint.is_empty());
            prop_assert!(error.to_string().len() < 1000, "{}", error);
        }
        Ok(import) => {
            prop_assert_eq!(import.plans.len(), 1);
            let plan = &import.plans[0];
            prop_assert_eq!(plan.violations(), vec![]);
            let bytes = to_bytes(plan);
            let loaded = from_bytes(&bytes).map_err(|error| TestCaseError::fail(error.to_string()))?;
            prop_assert_eq!(&loaded, plan);
            prop_assert!(import.notes.iter().all(|note| !note.what.is_empty()));
            let again = format::from_bytes(&format::to_bytes(plan, &Schemes::default()), "");
            prop_assert!(again.is_ok(), "{:?}", again.err());
        }
    }
    Ok(())
}

/// Read by its name.
fn as_plan_file(bytes: &[u8]) -> Result<Import, ReadError> {
    read_from(Path::new("stem.plan.json"), bytes).map_err(|error| error.error)
}

thread_local! {
    static ORIGINALS: Vec<Vec<u8>> = originals();
}

proptest! {
    #[test]
    fn damaged_files_are_read_or_refused(which in any::<Index>(), damages in prop::collection::vec(damage(), 1..4)) {
        let bytes = ORIGINALS.with(|originals| damaged(which.get(originals).clone(), &damages));
        check(as_plan_file(&bytes))?;
        check(format::from_bytes(&bytes, "stem"))?;
        let name = if bytes.starts_with(b"{\n\"format\"") { "a.plan.json" } else { "a.geojson" };
        prop_assert!(enfilade::formats::find_format(Path::new(name), &bytes).is_ok());
    }

    #[test]
    fn arbitrary_bytes_are_refused(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        check(as_plan_file(&bytes))?;
        check(format::from_bytes(&bytes, ""))?;
    }
}
