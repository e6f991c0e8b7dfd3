use crate::golden::assert_golden;
use enfilade::formats::plan_json::{from_bytes, to_bytes};
use enfilade::geometry::Point;
use enfilade::labels::{Label, Typology};
use enfilade::plan::{
    Backdrop, Builder, Joint, LabelOrigin, LeafSide, Meta, Opening, OpeningKind, Place, Plan, Room, RoomLabel, Scale,
    ScaleOrigin, Swing,
};

/// A plan that uses every field of the model.
fn full_plan() -> Plan {
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
    builder.finish().unwrap()
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
