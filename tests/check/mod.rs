//! The findings of `enfilade check`: for each, a plan that has it and one that barely does not, its
//! wording, and its independence of where and how a plan is drawn.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test fails by panicking")]
#![allow(clippy::print_stdout, reason = "a skipped test says so")]

mod cases;
mod command;
mod draft;
mod golden;
mod real_plans;

use std::collections::BTreeMap;
use std::fmt::Write as _;

use cases::{Case, cases};
use draft::Draft;
use enfilade::check::{Finding, check};
use enfilade::features::{NeighbourLabels, analyse};
use enfilade::geometry::{Point, Vector};
use enfilade::labels::Schemes;
use enfilade::plan::{Builder, Joint, Meta, Opening, OpeningKind, Place, Plan, Room};
use proptest::prelude::*;

fn findings(plan: &Plan) -> Vec<Finding> {
    let schemes = Schemes::bundled();
    let analysis = analyse(plan, &schemes, NeighbourLabels::default());
    check(plan, &analysis, &schemes)
}

fn kinds(plan: &Plan) -> BTreeMap<&'static str, usize> {
    let mut kinds = BTreeMap::new();
    for finding in findings(plan) {
        *kinds.entry(finding.kind().name).or_default() += 1;
    }
    kinds
}

#[test]
fn every_check_has_a_case() {
    let with_case: Vec<&str> = cases().iter().map(|case| case.kind).collect();
    for kind in Finding::KINDS {
        assert!(with_case.contains(&kind.name), "{} has no case in tests/check/cases.rs", kind.name);
    }
}

#[test]
fn the_sound_plan_has_no_findings() {
    assert_eq!(findings(&Draft::flat().plan()), Vec::new());
}

#[test]
fn each_check_finds_its_case_and_passes_the_one_beside_it() {
    for Case { kind, sound, wrong, .. } in cases() {
        let found = kinds(&wrong(&Draft::flat).plan());
        assert_eq!(found.get(kind), Some(&1), "{kind}: {found:?}");
        let found = kinds(&sound(&Draft::flat).plan());
        assert_eq!(found.get(kind), None, "{kind} on the sound plan: {found:?}");
    }
}

#[test]
fn findings_say_what_where_and_what_to_do() {
    let mut text = String::new();
    for Case { kind, wrong, .. } in cases() {
        for finding in findings(&wrong(&Draft::flat).plan()) {
            let _ = writeln!(text, "{kind}\n  {}: {finding}", finding.severity());
        }
    }
    golden::assert_golden("findings.txt", &text);
}

#[test]
fn names_are_those_of_the_files() {
    for kind in Finding::KINDS {
        let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("src/check/{}.rs", kind.name));
        assert!(file.exists(), "{} is not named as its file", kind.name);
    }
}

#[test]
fn every_check_is_documented() {
    let docs = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/docs/checks.md")).unwrap();
    for kind in Finding::KINDS {
        let row = format!("| `{}` | {} |", kind.name, kind.severity);
        assert!(docs.contains(&row), "docs/checks.md has no row '{row}'");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn findings_do_not_depend_on_place_and_direction(
        angle_rad in -4.0..4.0,
        x in -5000.0..5000.0,
        y in -5000.0..5000.0,
    ) {
        let placed = move |point: Point| {
            Point::default() + (point - Point::default()).rotated(angle_rad) + Vector::new(x, y)
        };
        for Case { kind, sound, wrong } in cases() {
            for draft in [sound, wrong] {
                let moved = draft(&|| Draft::flat_placed(placed)).plan();
                prop_assert_eq!(kinds(&draft(&Draft::flat).plan()), kinds(&moved), "{}", kind);
            }
        }
    }
}

/// Anything at all that the model can hold, and more: rings of any corners, holes anywhere, openings
/// pinned at random, walls over each other.
fn any_plan() -> impl Strategy<Value = Chaos> {
    let point = || (-6_i32..6, -6_i32..6);
    let ring = || proptest::collection::vec(point(), 0..9);
    let room = || (ring(), proptest::collection::vec(ring(), 0..3), 0..5_usize);
    let opening = || (point(), point(), any::<bool>(), 0..4_usize, proptest::option::of((0..6_usize, 0..6_usize)));
    (
        proptest::collection::vec(room(), 0..8),
        proptest::collection::vec(opening(), 0..8),
        proptest::collection::vec((point(), point()), 0..8),
        0..4_usize,
    )
        .prop_map(|(rooms, openings, walls, typology)| Chaos { rooms, openings, walls, typology })
}

type Lattice = (i32, i32);

type ChaosRoom = (Vec<Lattice>, Vec<Vec<Lattice>>, usize);
type ChaosOpening = (Lattice, Lattice, bool, usize, Option<(usize, usize)>);

#[derive(Clone, Debug)]
struct Chaos {
    /// Outer ring, holes, function.
    rooms: Vec<ChaosRoom>,
    /// Ends, whether free, kind, pinned rooms.
    openings: Vec<ChaosOpening>,
    walls: Vec<(Lattice, Lattice)>,
    typology: usize,
}

impl Chaos {
    fn plan(&self, placed: impl Fn(Lattice) -> Point) -> Plan {
        let typology = ["house", "school", "castle", ""][self.typology];
        let mut builder = Builder::new(Meta { typology: enfilade::labels::Typology::new(typology), ..Meta::default() });
        let functions = ["bedroom", "classroom", "balcony", "folly", ""];
        let mut ids = Vec::new();
        for (index, (outer, holes, function)) in self.rooms.iter().enumerate() {
            let outer = builder.ring(outer.iter().map(|&point| placed(point)));
            let holes = holes.iter().map(|hole| builder.ring(hole.iter().map(|&point| placed(point)))).collect();
            let function = functions[*function].to_owned();
            ids.push(builder.room(&format!("R{index}"), Room { outer, holes, function, ..Room::default() }));
        }
        for &(from, to, hosted, kind, pinned) in &self.openings {
            let place = if hosted {
                let (from, to) = (builder.corner(placed(from)), builder.corner(placed(to)));
                Place::Hosted { from, to, at_m: 0.5, width_m: 0.8 }
            } else {
                Place::Free { from: placed(from), to: placed(to) }
            };
            let joint = |room: usize| ids.get(room).map_or(Joint::Outside, |&id| Joint::Room(id));
            let pinned = pinned.map(|(one, other)| [joint(one), joint(other)]);
            builder.opening("", Opening { pinned, ..Opening::new(OpeningKind::ALL[kind], place) });
        }
        for &(from, to) in &self.walls {
            let (from, to) = (builder.corner(placed(from)), builder.corner(placed(to)));
            builder.wall(from, to, 0.1);
        }
        builder.plan().clone()
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 256, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_plan_makes_a_check_panic(chaos in any_plan(), scale in prop_oneof![Just(1.0), Just(0.001), Just(20_000.0)]) {
        let plan = chaos.plan(|(x, y)| Point::new(f64::from(x) * scale, f64::from(y) * scale));
        let found = findings(&plan);
        prop_assert_eq!(&found, &findings(&plan));
        for finding in &found {
            prop_assert!(!finding.to_string().is_empty());
            prop_assert!(finding.figures().iter().all(|(_, value)| value.is_finite()), "{:?}", finding);
        }
    }

    #[test]
    fn a_quarter_turn_changes_no_finding(
        mut chaos in any_plan(),
        turns in 0..4_u32,
        x in -50_i32..50,
        y in -50_i32..50,
    ) {
        // An opening on this lattice looks exactly along walls and through corners, where rounding
        // decides what it sees.
        chaos.openings.clear();
        let upright = chaos.plan(|(x, y)| Point::new(f64::from(x), f64::from(y)));
        let turned = chaos.plan(|point| {
            let (px, py) = (0..turns).fold(point, |(px, py), _| (-py, px));
            Point::new(f64::from(px + x), f64::from(py + y))
        });
        prop_assert_eq!(kinds(&upright), kinds(&turned));
    }
}

fn findings_of(name: &str) -> BTreeMap<&'static str, Vec<String>> {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/check").join(name);
    let import = enfilade::formats::read_file(&path).unwrap();
    let mut kinds: BTreeMap<&'static str, Vec<String>> = BTreeMap::new();
    for finding in findings(&import.plans[0]) {
        kinds.entry(finding.kind().name).or_default().push(finding.what());
    }
    kinds
}

/// A door of the usual width is measured as any other.
#[test]
fn a_door_wider_than_its_wall_is_found_whatever_its_width() {
    for (file, excess) in [
        ("door_of_90_cm_in_a_wall_of_50_cm.plan.json", "0.45 m"),
        ("door_of_91_cm_in_a_wall_of_50_cm.plan.json", "0.46 m"),
    ] {
        let found = findings_of(file);
        let [what] = &found["opening_is_wider_than_its_wall"][..] else { panic!("{file}: {found:?}") };
        assert!(what.contains(&format!("reaches {excess} beyond its wall")), "{file}: {what}");
    }
}

/// Other programs refuse such a polygon (GEOS: 'Self-intersection[2 0]').
#[test]
fn a_hole_along_the_boundary_is_found() {
    let found = findings_of("hole_along_the_edge.geojson");
    assert_eq!(
        found["room_hole_lies_along_its_boundary"],
        ["a hole of kitchen 'A' runs along its boundary for 2.00 m"]
    );
}

#[test]
fn holes_that_share_a_side_and_holes_that_touch_it_are_told_apart() {
    let hole = draft::rectangle;
    let found = |holes: &[[(f64, f64); 4]]| {
        let mut draft = Draft::flat();
        let holes: Vec<&[(f64, f64)]> = holes.iter().map(|hole| hole.as_slice()).collect();
        draft.room_with_holes("garden", &hole((12.0, 0.0), (20.0, 6.0)), &holes);
        findings(&draft.plan()).iter().map(Finding::what).filter(|what| what.contains("a hole")).collect::<Vec<_>>()
    };
    let beside = [hole((13.0, 1.0), (15.0, 3.0)), hole((15.0, 2.0), (17.0, 4.0))];
    assert_eq!(found(&beside), ["a hole of garden R6 runs along another hole for 1.00 m"]);
    let at_a_corner = [hole((13.0, 1.0), (15.0, 3.0)), hole((15.0, 3.0), (17.0, 4.0))];
    assert_eq!(found(&at_a_corner), [] as [&str; 0]);
    // Its corners lie on two sides of the room, which it cuts in two.
    let across = [[(12.0, 3.0), (16.0, 2.0), (20.0, 3.0), (16.0, 4.0)]];
    assert_eq!(found(&across), ["a hole of garden R6 touches its boundary in 2 places"]);
    let along = [hole((12.0, 0.0), (14.0, 2.0))];
    assert_eq!(found(&along), ["a hole of garden R6 runs along its boundary for 4.00 m"]);
}

/// Two rooms and a door, as of a file in millimetres: too little for what is usual, enough for what is possible.
#[test]
fn rooms_of_square_kilometres_are_found_without_labels() {
    let mut draft = Draft::empty(|point| point);
    draft.room("", &draft::rectangle((0.0, 0.0), (4000.0, 3000.0)));
    draft.room("", &draft::rectangle((4000.0, 0.0), (8000.0, 3000.0)));
    draft.door((4000.0, 1000.0), (4000.0, 1900.0));
    let found = findings(&draft.plan());
    let scale = found.iter().find(|finding| finding.kind().name == "scale_is_implausible").unwrap();
    assert!(
        scale.what().contains("lengths seem 632.5 times too long: its median room has 12\u{a0}000\u{a0}000 m²"),
        "{scale}"
    );
    assert_eq!(scale.severity(), enfilade::check::Severity::Error);
}

/// Walls that are drawn with gaps, each closed by a door, meet something.
#[test]
fn a_wall_that_ends_at_the_side_of_a_door_does_not_end_freely() {
    let mut draft = Draft::flat();
    draft.wall((14.0, 0.0), (14.0, 2.0));
    draft.wall((14.0, 2.9), (14.0, 5.0));
    draft.wall((14.0, 0.0), (18.0, 0.0));
    draft.wall((18.0, 0.0), (18.0, 5.0));
    draft.wall((18.0, 5.0), (14.0, 5.0));
    assert_eq!(kinds(&draft.plan()).get("wall_ends_freely"), Some(&2));
    draft.door((14.0, 2.0), (14.0, 2.9));
    assert_eq!(kinds(&draft.plan()).get("wall_ends_freely"), None);
}

#[test]
fn thin_partitions_are_no_gaps_in_a_plan_that_draws_its_walls() {
    let plan = |wall_m: f64| {
        let mut draft = Draft::empty(|point| point);
        for i in 0..4 {
            let left = (4.0 + wall_m) * f64::from(i);
            draft.room("garden", &draft::rectangle((left, 0.0), (left + 4.0, 4.0)));
        }
        draft.room("garden", &draft::rectangle((0.0, 4.03), (4.0, 8.0)));
        draft.plan()
    };
    assert_eq!(kinds(&plan(0.0)).get("rooms_leave_a_gap"), Some(&1));
    assert_eq!(kinds(&plan(0.15)).get("rooms_leave_a_gap"), None);
}

#[test]
fn a_room_beyond_measure_is_one_finding() {
    // 3,000 strokes back and forth across each other: 4,500,000 crossings.
    let mut draft = Draft::empty(|point| point);
    let strokes: Vec<(f64, f64)> = (0..3000_u32)
        .map(|i| {
            let angle = f64::from(i) * 3.0;
            (50.0 + 50.0 * angle.cos(), 50.0 + 50.0 * angle.sin())
        })
        .collect();
    draft.room("garden", &strokes);
    draft.room("garden", &draft::rectangle((0.0, 0.0), (4.0, 4.0)));
    let found = kinds(&draft.plan());
    assert_eq!(found.get("room_boundary_crosses_itself"), Some(&1), "{found:?}");
}

/// A finding that offers a fix is gone with it, and nothing new is found.
#[test]
fn fixes_mend_what_they_are_for() {
    let mut mended = std::collections::BTreeSet::new();
    let mut plans: Vec<(&str, Plan)> =
        cases().iter().map(|Case { kind, wrong, .. }| (*kind, wrong(&Draft::flat).plan())).collect();
    // Certain enough to be mended: a wall within another, and a door that is there already.
    let mut draft = Draft::flat();
    draft.wall((0.0, 0.0), (9.0, 0.0));
    draft.wall((3.0, 0.0), (6.0, 0.0));
    plans.push(("a wall in another", draft.plan()));
    let mut draft = Draft::flat();
    draft.door((2.38, 4.0), (1.6, 4.0));
    plans.push(("a door twice", draft.plan()));
    for (kind, plan) in plans {
        for finding in findings(&plan).iter().filter(|finding| finding.fix_title().is_some()) {
            let fixed = finding.fixed(&plan).unwrap_or_else(|error| panic!("{kind}: {error}"));
            assert_eq!(fixed.violations(), Vec::new(), "{kind}");
            let left = findings(&fixed);
            assert!(!left.iter().any(|other| other.as_ignored("") == finding.as_ignored("")), "{kind}: {finding}");
            assert!(left.len() < findings(&plan).len(), "{kind}: {finding}");
            assert_eq!(fixed.rooms().len(), plan.rooms().len(), "{kind}");
            mended.insert(finding.kind().name);
        }
        for finding in findings(&plan).iter().filter(|finding| finding.fix_title().is_none()) {
            assert!(finding.fixed(&plan).is_err(), "{kind}: {finding}");
        }
    }
    assert_eq!(
        mended.into_iter().collect::<Vec<_>>(),
        ["corners_nearly_coincide", "openings_overlap", "scale_is_implausible", "wall_has_no_length", "walls_overlap"]
    );
}
