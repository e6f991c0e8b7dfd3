//! Reading the XML of the KTH campus: two floors of our own with their notes and plans beside them, files that cannot
//! be read, and the real ones where they are.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use enfilade::formats::{self, Import, ReadError, kth_xml, plan_json};
use enfilade::geometry::polygon;
use enfilade::labels::{Schemes, Typology};
use enfilade::plan::{Joint, OpeningKind, Place, Plan, ScaleOrigin};
use proptest::prelude::*;

use super::broken::{assert_sound, mutation};
use super::golden::{compare, fixture};

fn read(bytes: &[u8]) -> Result<Import, ReadError> {
    kth_xml::from_bytes(bytes, "file")
}

fn case(name: &str) -> String {
    std::fs::read_to_string(fixture("kth").join(name)).unwrap()
}

#[test]
fn floors_of_our_own_give_their_plans_and_notes() {
    let mut wrong = Vec::new();
    for name in ["floor.xml", "mended.xml"] {
        let path = fixture("kth").join(name);
        let import = formats::read_file(&path).unwrap_or_else(|error| panic!("{error}"));
        let notes: String = import.notes.iter().map(|note| format!("{note}\n")).collect();
        let notes = Some(notes.as_str()).filter(|notes| !notes.is_empty());
        wrong.extend(compare(&path.with_extension("notes.txt"), notes).err());
        let bytes = plan_json::to_bytes(&import.plans[0]);
        wrong.extend(compare(&path.with_extension("plan.json"), Some(std::str::from_utf8(&bytes).unwrap())).err());
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// What stands in the file, said again by hand.
#[test]
fn a_floor_is_read_at_its_true_scale() {
    let import = read(case("floor.xml").as_bytes()).unwrap();
    assert_eq!(import.notes, []);
    let plan = &import.plans[0];
    let (meta, scale) = (plan.meta(), &plan.meta().scale);
    assert_eq!((meta.building.as_str(), meta.storey.as_str()), ("B1", "4711_PLAN2"));
    assert_eq!(meta.typology, Typology::new("university"));
    assert_eq!((scale.origin, scale.metres_per_unit), (ScaleOrigin::Imported, Some(0.01)));
    let room = |name: &str| plan.rooms().find(|(_, room)| room.name == name).unwrap();
    let area = |name: &str| {
        let rings: Vec<_> =
            room(name).1.rings().map(|ring| polygon::signed_area(&plan.ring_points(ring)).abs()).collect();
        rings[0] - rings[1..].iter().sum::<f64>()
    };
    assert!((area("201") - 3.0 * 3.85).abs() < 1e-9);
    assert!((area("205") - (12.0 * 7.85 - 1.0)).abs() < 1e-9, "a pillar is a hole");
    assert_eq!(room("201").1.outer.len(), 4, "corners that only end an opening are left out");
    let mut widths: Vec<(OpeningKind, i64)> = plan
        .openings()
        .map(|(_, opening)| {
            let Place::Hosted { width_m, .. } = opening.place else { panic!("{opening:?} lies on no wall") };
            (opening.kind, (width_m * 100.0).round() as i64)
        })
        .collect();
    widths.sort();
    let (door, double, passage, window) =
        (OpeningKind::Door, OpeningKind::DoubleDoor, OpeningKind::Passage, OpeningKind::Window);
    assert_eq!(
        widths,
        [(door, 85), (door, 90), (door, 120), (double, 140), (passage, 400), (window, 200), (window, 300)]
    );
    let corridor = Joint::Room(room("200").0);
    let doors = plan.openings().filter(|(_, opening)| opening.kind.is_passable());
    assert!(doors.into_iter().all(|(_, opening)| opening.pinned.unwrap().contains(&corridor)));
}

#[test]
fn broken_files_say_what_where_and_what_to_do() {
    let floor = case("floor.xml");
    let with = |from: &str, to: &str| {
        assert!(floor.contains(from), "{from}");
        floor.replacen(from, to, 1)
    };
    let lines: String = (0..10_001).map(|i| format!("<linesegment x1='{i}' y1='0' x2='{}' y2='0'/>", i + 1)).collect();
    let portals: String =
        (0..6000).map(|i| format!("<linesegment x1='{i}' y1='0' x2='{i}' y2='1' type='Portal' target='N'/>")).collect();
    let space = |name: &str| {
        format!(
            "<space name='{name}'><contour>{}</contour></space>",
            portals.replace('N', if name == "A" { "B" } else { "A" })
        )
    };
    for (name, text, expected) in [
        ("empty", String::new(), "is empty; restore it from a copy"),
        (
            "another root",
            "<svg/>".to_owned(),
            "line 1: is XML, but no floor of the KTH campus: its root is <svg>; a plan starts with <floor>",
        ),
        ("no rooms", "<floor BuildingName='B'/>".to_owned(), "holds no room; check that this is the whole file"),
        ("cut off", floor[..floor.len() / 2].to_owned(), "restore it from a complete copy"),
        (
            "NaN",
            with("x1=\"0\"", "x1=\"NaN\""),
            "line 8, space B1_200: x1=\"NaN\" of a line is no number within ±1000000",
        ),
        ("infinite", with("y2=\"400\"", "y2=\"inf\""), "space B1_200: y2=\"inf\" of a line is no number"),
        (
            "no x2",
            with(" x2=\"100\"", ""),
            "line 8, space B1_200: a line lacks one of x1, y1, x2 and y2; correct it by hand",
        ),
        (
            "too large",
            with("PixelDistance=\"2000\"", "PixelDistance=\"3\"").replacen("x1=\"0\"", "x1=\"999999\"", 1),
            "m from the origin; correct the scale",
        ),
        (
            "too many lines",
            format!("<floor><space><contour>{lines}</contour></space></floor>"),
            "the contour has more than 10000 lines",
        ),
        (
            "too many portals",
            format!("<floor BuildingName=''>{}{}</floor>", space("A"), space("B")),
            "has too many portals in rooms with too many corners",
        ),
        ("tags crossed", with("</contour>", "</space>"), "is not well-formed XML"),
    ] {
        let found =
            read(text.as_bytes()).map_or_else(|error| error.to_string(), |import| format!("{:?}", import.notes));
        assert!(found.contains(expected), "{name}: {found:?} lacks {expected:?}");
    }
}

#[test]
fn a_floor_is_told_from_other_xml_by_what_it_holds() {
    let name = |text: &str| formats::find_format(Path::new("a.xml"), text.as_bytes()).map(|(format, _)| format.id);
    assert_eq!(name(&case("floor.xml")).unwrap(), "kth-xml");
    assert_eq!(name("<building id='b'/>").unwrap(), "authors-xml");
    let foreign = name("<floor level='3'><tile/></floor>").unwrap_err().to_string();
    assert!(foreign.contains("is no plan but XML with the root <floor>"), "{foreign}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn mutated_floors_are_read_soundly_or_refused(
        mended in any::<bool>(),
        mutations in proptest::collection::vec(mutation(), 1..6),
    ) {
        let mut bytes = case(if mended { "mended.xml" } else { "floor.xml" }).into_bytes();
        for mutation in mutations {
            mutation.apply(&mut bytes);
        }
        assert_sound(&bytes, read);
    }
}

/// The real floors by path; none where they are not there.
#[expect(clippy::print_stdout, reason = "tells why the tests have nothing to do")]
fn files() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/kth");
    let files = walkdir::WalkDir::new(root).sort_by_file_name().into_iter().flatten().map(|entry| entry.into_path());
    let files: Vec<PathBuf> = files.filter(|path| path.extension().is_some_and(|ending| ending == "xml")).collect();
    if files.is_empty() {
        println!("skipped: ../shared/data/kth is not there");
    }
    files
}

/// Counted beside by plain text search.
#[test]
fn every_real_floor_is_read_whole() {
    let files = files();
    if files.is_empty() {
        return;
    }
    let schemes = Schemes::bundled();
    let (mut rooms, mut openings, mut hosted, mut without, mut named, mut known) = (0, 0, 0, 0, 0, 0);
    let mut buildings = BTreeSet::new();
    for path in &files {
        let text = std::fs::read_to_string(path).unwrap();
        let import = formats::read_file(path).unwrap_or_else(|error| panic!("{error}"));
        let plan: &Plan = &import.plans[0];
        assert_eq!(plan.rooms().len(), text.matches("<space ").count(), "{}", path.display());
        assert_eq!(plan.meta().scale.origin, ScaleOrigin::Imported);
        buildings.insert(plan.meta().building.clone());
        rooms += plan.rooms().len();
        without += plan.rooms().filter(|(_, room)| !room.has_boundary()).count();
        let doors = || plan.openings().filter(|(_, opening)| opening.kind.is_passable());
        openings += doors().count();
        hosted += doors().filter(|(_, opening)| matches!(opening.place, Place::Hosted { .. })).count();
        let windows = text.matches("type=\"Window\"").count();
        let narrow = import.notes.iter().filter(|note| note.what.starts_with("a window has no width")).count();
        assert_eq!(plan.openings().len() - doors().count() + narrow, windows, "{}", path.display());
        let functions = plan.rooms().map(|(_, room)| &room.function).filter(|function| !function.is_empty());
        for function in functions {
            named += 1;
            known += usize::from(schemes.meaning(plan.meta().typology.as_ref(), function).is_some());
        }
    }
    assert_eq!((files.len(), buildings.len(), rooms), (95, 19, 3732));
    assert!(without <= 62, "{without} rooms have no boundary; 59 have no contour");
    assert!(
        (4000..4400).contains(&openings),
        "{openings} openings of 7,983 portals, of which nearly all stand in two rooms"
    );
    assert!(100 * hosted >= 99 * openings, "{hosted} of {openings} openings lie on a wall");
    assert!(100 * known >= 93 * named, "the scheme knows {known} of {named} rooms with a function");
}
