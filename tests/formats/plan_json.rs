use proptest::prelude::*;

use super::generated::plans;
use super::golden::assert_golden;
use enfilade::edit::draw_dimension;
use enfilade::edit::guides::add_guide;
use enfilade::formats::plan_json::{from_bytes, to_bytes};
use enfilade::geometry::{Point, Vector};
use enfilade::labels::{Label, Typology};
use enfilade::plan::{
    Backdrop, Builder, DimensionAlong, GuideAxis, Joint, LabelOrigin, LeafSide, Measurement, Meta, Opening,
    OpeningKind, Place, Plan, Room, RoomLabel, Scale, ScaleOrigin, Swing,
};

/// A plan that uses every field of the model.
pub fn full_plan() -> Plan {
    let mut builder = Builder::new(Meta {
        name: "Ground floor \"A\"".to_owned(),
        building: "Villa Ö".to_owned(),
        storey: "0".to_owned(),
        typology: Typology::new("House"),
        scale: Scale {
            origin: ScaleOrigin::Measured,
            metres_per_unit: Some(0.027_680_000_000_000_003),
            note: "three doors".to_owned(),
        },
        source: "survey".to_owned(),
        licence: "CC0".to_owned(),
        extra: None,
    });
    builder.set_backdrop(Backdrop {
        path: "scans/ground.png".to_owned(),
        content_hash: "ab12".to_owned(),
        origin: Point::new(-0.1, 2.0),
        metres_per_pixel: 1.0 / 300.0,
        rotation_rad: 0.1,
        opacity: 0.5,
        page: 2,
        measurements: vec![Measurement { from: Point::new(10.5, 20.0), to: Point::new(910.5, 20.25), length_m: 3.0 }],
        rectification: None,
        extra: None,
    });
    let rectangle = |x0: f64, y0: f64, x1: f64, y1: f64| {
        [Point::new(x0, y0), Point::new(x1, y0), Point::new(x1, y1), Point::new(x0, y1)]
    };
    let outer = builder.ring(rectangle(0.0, 0.0, 6.0, 4.0));
    let hole = builder.ring(rectangle(1.0, 1.0, 2.000_04, 2.0));
    let (a, b) = (outer[0], outer[1]);
    let hall = builder.room(
        "hall",
        Room {
            outer,
            holes: vec![hole],
            function: "living_room".to_owned(),
            label: Some(RoomLabel { label: Label::Hall, origin: LabelOrigin::AcceptedPrediction }),
            name: "Salon\n1".to_owned(),
            note: "fireplace".to_owned(),
            text_offset: Some(Vector::new(1.5, -0.5)),
            source_id: String::new(),
            extra: None,
        },
    );
    builder.room("named only", Room { function: "cellar".to_owned(), ..Room::default() });
    builder.wall(a, b, 0.24);
    let place = Place::Hosted { from: a, to: b, at_m: 1.5, width_m: 0.9 };
    let mut door = Opening::new(OpeningKind::Door, place);
    door.swing = Some(Swing { hinge_at_start: false, side: LeafSide::Right });
    builder.opening("", door);
    let place = Place::Free { from: Point::new(6.0, 1.0), to: Point::new(6.0, 2.0) };
    let mut passage = Opening::new(OpeningKind::Passage, place);
    passage.pinned = Some([Joint::Room(hall), Joint::Outside]);
    builder.opening("", passage);
    let plan = add_guide(&builder.finish().unwrap(), GuideAxis::Vertical, -3.0).unwrap();
    let plan = add_guide(&plan, GuideAxis::Horizontal, 1.25).unwrap();
    // On a face and on nothing; on an edge of the door and on a corner.
    let upright = [Point::new(3.0, -0.12), Point::new(3.0, 3.0)];
    let (plan, _) = draw_dimension(&plan, &upright, DimensionAlong::Vertical, Point::new(7.0, 0.0)).unwrap();
    let oblique = [Point::new(1.05, 0.0), Point::new(6.0, 4.0)];
    let (plan, _) = draw_dimension(&plan, &oblique, DimensionAlong::Aligned, Point::new(0.0, 1.0)).unwrap();
    let on: Vec<bool> =
        plan.dimensions().flat_map(|(_, chain)| chain.points.iter().map(|point| point.on.is_some())).collect();
    assert_eq!(on.iter().filter(|is_on| **is_on).count(), 3, "{on:?}");
    plan
}

#[test]
fn a_plan_reads_back_as_it_was() {
    for plan in [Plan::default(), full_plan()] {
        let bytes = to_bytes(&plan);
        let read = from_bytes(&bytes).map_err(|error| error.to_string()).unwrap();
        assert_eq!(read, plan);
        assert_eq!(String::from_utf8(to_bytes(&read)).unwrap(), String::from_utf8(bytes).unwrap());
    }
}

#[test]
fn the_file_looks_as_documented() {
    let text = String::from_utf8(to_bytes(&full_plan())).unwrap();
    assert_golden("every_field.plan.json", &text);
}

/// Every object of the file, and the file itself, with fields that this version does not know.
#[test]
fn unknown_fields_survive_in_their_order() {
    let text = String::from_utf8(to_bytes(&full_plan())).unwrap();
    let unknown = r#""zebra":{"b":1.50001,"a":[null,-0.0,1e-7]},"aardvark":18446744073709551615"#;
    let lines: Vec<String> = text
        .lines()
        .map(|line| match line.strip_suffix("},").or_else(|| line.strip_suffix('}')) {
            Some(object) if line.starts_with(['{', '"']) && object.len() > 1 => {
                format!("{object},{unknown}{}", &line[object.len()..])
            }
            _ => line.to_owned(),
        })
        .collect();
    let text = lines.join("\n");
    let text = text.replace("\"CC0\"\n}", "\"CC0\",\n\"wing\": \"north\",\n\"annex\": [1,2]\n}");
    let text = text.strip_suffix("\n}").unwrap().to_owned() + ",\n\"zones\": [{\"id\":\"z1\"}],\n\"authors\": []\n}\n";
    let plan = from_bytes(text.as_bytes()).map_err(|error| error.to_string()).unwrap();
    assert_eq!(String::from_utf8(to_bytes(&plan)).unwrap(), text);
    assert_eq!(
        text.matches("aardvark").count(),
        18,
        "2 guides, 8 corners, a wall, 2 rooms, 2 openings, a backdrop, 2 dimensions"
    );
}

#[test]
fn lengths_are_rounded_to_a_tenth_of_a_millimetre() {
    let text = String::from_utf8(to_bytes(&full_plan())).unwrap();
    let (before, after) = text.split_once("\"x\":6,").unwrap();
    for (written, read) in
        [("6.00004", "6"), ("6.00006", "6.0001"), ("60000e-4", "6"), ("-0.00001", "0"), ("-0.0", "0")]
    {
        let plan = from_bytes(format!("{before}\"x\":{written},{after}").as_bytes()).unwrap();
        let expected = format!("{before}\"x\":{read},{after}");
        assert_eq!(String::from_utf8(to_bytes(&plan)).unwrap(), expected, "{written}");
    }
}

#[test]
fn line_ends_and_order_of_other_systems_and_tools_are_read() {
    let plan = full_plan();
    let text = String::from_utf8(to_bytes(&plan)).unwrap();
    let windows = format!("\u{feff}{}", text.replace('\n', "\r\n"));
    assert_eq!(from_bytes(windows.as_bytes()).unwrap(), plan);
    let mut value: serde_json::Value = serde_json::from_str(&text).unwrap();
    for list in ["corners", "rooms", "openings"] {
        value[list].as_array_mut().unwrap().reverse();
    }
    assert_eq!(from_bytes(serde_json::to_string_pretty(&value).unwrap().as_bytes()).unwrap(), plan);
}

proptest! {
    #[test]
    fn any_plan_reads_back_as_it_was(plan in plans()) {
        let bytes = to_bytes(&plan);
        let read = from_bytes(&bytes).map_err(|error| TestCaseError::fail(error.to_string()))?;
        prop_assert_eq!(&read, &plan);
        prop_assert_eq!(to_bytes(&read), bytes);
    }

    #[test]
    fn one_object_a_line_sorted_and_short_numbers(plan in plans()) {
        let text = String::from_utf8(to_bytes(&plan)).unwrap();
        let ids: Vec<&str> = text.lines().filter_map(|line| line.strip_prefix("{\"id\":\"")?.get(..13)).collect();
        prop_assert_eq!(ids.len(), plan.corners().len() + plan.walls().len() + plan.rooms().len() + plan.openings().len());
        for kind in ['c', 'w', 'r', 'o'] {
            let of_kind: Vec<&&str> = ids.iter().filter(|id| id.starts_with(kind)).collect();
            prop_assert!(of_kind.is_sorted());
        }
        for line in text.lines().filter(|line| line.starts_with("{\"id\":\"c")) {
            for number in line.split(['"', ':', ',', '}']).filter(|part| part.starts_with(|c: char| c == '-' || c.is_ascii_digit())) {
                let decimals = number.split_once('.').map_or("1", |(_, decimals)| decimals);
                prop_assert!(decimals.len() <= 4 && !decimals.ends_with('0') && !number.contains('e'), "{}", number);
            }
        }
    }
}
