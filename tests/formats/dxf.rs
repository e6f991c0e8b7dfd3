//! DXF: that the drawing is whole in itself, in true size, and always the same.

use std::collections::{BTreeMap, BTreeSet};

use enfilade::formats::{FORMATS, NamedPlan, Options};
use enfilade::labels::Schemes;
use enfilade::plan::{OpeningKind, Plan};
use enfilade::store::bundled_plans;

fn written(plan: &Plan, pairs: &[&str]) -> String {
    let exporter = FORMATS.iter().find(|format| format.id == "dxf").unwrap().exporter.unwrap();
    let pairs: Vec<String> = pairs.iter().map(ToString::to_string).collect();
    let options = Options::parse(exporter.options(), &pairs).unwrap();
    let export = exporter.write(&[NamedPlan { stem: "x", plan }], &Schemes::bundled(), &options).unwrap();
    String::from_utf8(export.files[0].bytes.clone()).unwrap()
}

/// An object: its kind, and its pairs of code and value.
struct Object<'a> {
    section: &'a str,
    kind: &'a str,
    pairs: Vec<(u32, &'a str)>,
}

impl<'a> Object<'a> {
    fn all(&self, code: u32) -> Vec<&'a str> {
        self.pairs.iter().filter(|(own, _)| *own == code).map(|(_, value)| *value).collect()
    }

    fn first(&self, code: u32) -> &'a str {
        self.all(code).first().copied().unwrap_or_default()
    }

    fn numbers(&self, code: u32) -> Vec<f64> {
        self.all(code).iter().map(|value| value.parse().unwrap()).collect()
    }
}

fn objects(text: &str) -> Vec<Object<'_>> {
    let mut lines = text.lines();
    let (mut objects, mut section): (Vec<Object<'_>>, &str) = (Vec::new(), "");
    while let (Some(code), Some(value)) = (lines.next(), lines.next()) {
        let code: u32 = code.trim().parse().unwrap();
        if code == 0 {
            objects.push(Object { section, kind: value, pairs: Vec::new() });
        } else if let Some(object) = objects.last_mut() {
            if object.kind == "SECTION" && code == 2 {
                section = value;
            }
            object.pairs.push((code, value));
        }
    }
    objects
}

#[test]
fn a_drawing_is_whole_in_itself() {
    for (name, plan) in bundled_plans().unwrap() {
        let text = written(&plan, &[]);
        assert!(text.is_ascii() && text.ends_with("EOF\n"), "{name}");
        assert_eq!(text, written(&plan, &[]), "{name}");
        let objects = objects(&text);
        let mut handles = BTreeSet::new();
        for object in &objects {
            let handle = object.first(if object.kind == "DIMSTYLE" { 105 } else { 5 });
            if !handle.is_empty() && object.kind != "SECTION" {
                assert!(handles.insert(u64::from_str_radix(handle, 16).unwrap()), "{name}: {handle} twice");
            }
        }
        let named = |kind: &str| -> BTreeSet<&str> {
            objects.iter().filter(|object| object.kind == kind).map(|object| object.first(2)).collect()
        };
        let (layers, blocks) = (named("LAYER"), named("BLOCK"));
        assert_eq!(blocks, named("BLOCK_RECORD"), "{name}");
        for object in objects.iter().filter(|object| ["ENTITIES", "BLOCKS"].contains(&object.section)) {
            if !["SECTION", "ENDSEC"].contains(&object.kind) {
                assert!(layers.contains(object.first(8)), "{name}: layer {}", object.first(8));
            }
            for owner in object.all(330) {
                assert!(handles.contains(&u64::from_str_radix(owner, 16).unwrap()), "{name}: owner {owner}");
            }
            if object.kind == "INSERT" {
                assert!(blocks.contains(object.first(2)), "{name}: block {}", object.first(2));
            }
        }
        let seed = text.split("$HANDSEED\n  5\n").nth(1).unwrap().lines().next().unwrap();
        assert!(u64::from_str_radix(seed, 16).unwrap() > *handles.last().unwrap(), "{name}");
    }
}

#[test]
fn rooms_walls_and_openings_are_all_there_in_true_size() {
    for (name, plan) in bundled_plans().unwrap() {
        for (unit, per_m, code) in [("units=metres", 1.0, "6"), ("units=millimetres", 1000.0, "4")] {
            let text = written(&plan, &[unit]);
            assert!(text.contains(&format!("$INSUNITS\n 70\n{code}\n")), "{name}");
            let objects = objects(&text);
            let on = |layer: &str, kind: &str| -> Vec<&Object<'_>> {
                let is_it = |object: &&Object<'_>| {
                    object.section == "ENTITIES" && object.kind == kind && object.first(8) == layer
                };
                objects.iter().filter(is_it).collect()
            };
            let rooms = on("A-AREA", "LWPOLYLINE");
            assert!(rooms.iter().chain(&on("A-WALL", "LWPOLYLINE")).all(|line| line.first(70) == "1"), "{name}");
            // The same area as the plan's rooms, holes counted against.
            let area = |line: &Object<'_>| {
                let (x, y) = (line.numbers(10), line.numbers(20));
                let next = |i: usize| (i + 1) % x.len();
                (0..x.len()).map(|i| x[i] * y[next(i)] - x[next(i)] * y[i]).sum::<f64>().abs() / 2.0
            };
            let holes: usize = plan.rooms().map(|(_, room)| room.holes.len()).sum();
            assert_eq!(rooms.len(), plan.rooms().len() + holes, "{name}");
            let drawn: f64 = rooms.iter().map(|line| area(line)).sum::<f64>() / per_m / per_m;
            let expected: f64 = plan
                .rooms()
                .map(|(_, room)| {
                    room.rings()
                        .map(|ring| enfilade::geometry::polygon::signed_area(&plan.ring_points(ring)).abs())
                        .sum::<f64>()
                })
                .sum();
            assert!((drawn - expected).abs() < 1e-3 * expected, "{name}: {drawn} for {expected}");
            let mut counts: BTreeMap<OpeningKind, usize> = BTreeMap::new();
            plan.openings().for_each(|(_, opening)| *counts.entry(opening.kind).or_default() += 1);
            let of = |kind: OpeningKind| counts.get(&kind).copied().unwrap_or_default();
            assert_eq!(on("A-GLAZ", "INSERT").len(), of(OpeningKind::Window), "{name}");
            assert_eq!(on("A-WALL-OPNG", "INSERT").len(), of(OpeningKind::Passage), "{name}");
            let doors = of(OpeningKind::Door) + of(OpeningKind::DoubleDoor);
            // A double door has two leaves, or slides.
            let inserted = on("A-DOOR", "INSERT").len();
            assert!(
                (doors..=doors + of(OpeningKind::DoubleDoor)).contains(&inserted),
                "{name}: {inserted} for {doors}"
            );
            assert!(on("A-ANNO-TEXT", "TEXT").len() >= plan.rooms().len(), "{name}");
        }
    }
}
