//! Plans that no one would draw, to test that what is written reads back the same.

use std::sync::Arc;

use enfilade::geometry::{Point, Vector};
use enfilade::labels::{Label, Typology};
use enfilade::plan::{
    Backdrop, Builder, CornerId, Extra, Joint, LabelOrigin, LeafSide, Measurement, Meta, Opening, OpeningKind, Place,
    Plan, Rectification, Room, RoomId, RoomLabel, Scale, ScaleOrigin, Swing,
};
use proptest::collection::vec;
use proptest::option;
use proptest::prelude::*;
use proptest::sample::select;

/// A coordinate in metres: near the origin mostly, anywhere in the drawing area sometimes.
fn metre() -> impl Strategy<Value = f64> {
    prop_oneof![6 => -30.0..30.0f64, 3 => (-20i32..20).prop_map(f64::from), 1 => -100_000.0..100_000.0f64]
}

fn point() -> impl Strategy<Value = Point> {
    (metre(), metre()).prop_map(|(x, y)| Point::new(x, y))
}

fn text() -> impl Strategy<Value = String> {
    prop_oneof![Just(String::new()), "[a-z_ ]{1,12}", any::<String>()]
}

/// Fields of a file newer than this program.
fn extra() -> impl Strategy<Value = Extra> {
    let value = prop_oneof![
        any::<f64>().prop_filter("JSON has no infinities", |value| value.is_finite()).prop_map(serde_json::Value::from),
        any::<i64>().prop_map(serde_json::Value::from),
        text().prop_map(serde_json::Value::from),
        Just(serde_json::json!({"nested": [1, null, {"deeper": true}]})),
    ];
    vec(("[a-z]{1,6}".prop_map(|key| format!("future_{key}")), value), 0..3).prop_map(|fields| {
        let map: serde_json::Map<_, _> = fields.into_iter().collect();
        (!map.is_empty()).then(|| Arc::new(map))
    })
}

fn meta() -> impl Strategy<Value = Meta> {
    let scale = (select(ScaleOrigin::ALL.as_slice()), option::of(1e-9..1e3f64), text())
        .prop_map(|(origin, metres_per_unit, note)| Scale { origin, metres_per_unit, note });
    (text(), text(), text(), text(), scale, text(), extra()).prop_map(
        |(name, building, storey, typology, scale, source, extra)| Meta {
            name,
            building,
            storey,
            typology: Typology::new(&typology),
            scale,
            source: source.clone(),
            licence: source,
            extra,
        },
    )
}

fn backdrop() -> impl Strategy<Value = Backdrop> {
    (text(), point(), 1e-6..1e3f64, -4.0..4.0f64, 0.0..=1.0f64, extra()).prop_map(
        |(path, origin, metres_per_pixel, rotation_rad, opacity, extra)| Backdrop {
            content_hash: path.clone(),
            path,
            origin,
            metres_per_pixel,
            rotation_rad,
            opacity,
            page: 1,
            measurements: vec![Measurement {
                from: origin,
                to: Point::new(rotation_rad, opacity),
                length_m: metres_per_pixel,
            }],
            rectification: (opacity > 0.5).then(|| Rectification {
                corners: [(0.0, 0.0), (opacity * 100.0, 1.5), (120.25, 90.0), (-3.0, 80.0)]
                    .map(|(x, y)| Point::new(x, y)),
                rectangle: [Point::new(10.0, 20.5), Point::new(210.0, 120.0)],
                size_px: [300, 200],
            }),
            extra,
        },
    )
}

#[derive(Clone, Debug)]
struct RoomSpec {
    key: String,
    rings: Vec<Vec<Point>>,
    texts: [String; 3],
    label: Option<(Label, LabelOrigin)>,
    extra: Extra,
}

fn room(point: fn() -> BoxedStrategy<Point>) -> impl Strategy<Value = RoomSpec> {
    let rectangle = (-20i32..20, -20i32..20, 1i32..9, 1i32..9).prop_map(|(x, y, width, height)| {
        let [x0, y0, x1, y1] = [x, y, x + width, y + height].map(f64::from);
        vec![Point::new(x0, y0), Point::new(x1, y0), Point::new(x1, y1), Point::new(x0, y1)]
    });
    let ring = prop_oneof![3 => rectangle, 1 => vec(point(), 3..8)];
    let label = (select(Label::ALL.as_slice()), select(LabelOrigin::ALL.as_slice()));
    (text(), vec(ring, 0..3), [text(), text(), text()], option::of(label), extra())
        .prop_map(|(key, rings, texts, label, extra)| RoomSpec { key, rings, texts, label, extra })
}

#[derive(Clone, Debug)]
struct OpeningSpec {
    key: String,
    kind: OpeningKind,
    /// Index of the host edge and the fraction along it; else free.
    host: Option<(usize, f64, f64)>,
    free: (Point, Point),
    swing: Option<(bool, bool)>,
    /// Indices of rooms; beyond the last is the outside.
    pinned: Option<[usize; 2]>,
    extra: Extra,
}

fn opening(
    point: fn() -> BoxedStrategy<Point>,
    fraction: fn() -> BoxedStrategy<f64>,
    width_m: fn() -> BoxedStrategy<f64>,
) -> impl Strategy<Value = OpeningSpec> {
    let host = (0usize..1000, fraction(), width_m());
    (
        text(),
        select(OpeningKind::ALL.as_slice()),
        option::of(host),
        (point(), point()),
        option::of(any::<(bool, bool)>()),
        option::of([0usize..12, 0usize..12]),
        extra(),
    )
        .prop_map(|(key, kind, host, free, swing, pinned, extra)| OpeningSpec {
            key,
            kind,
            host,
            free,
            swing,
            pinned,
            extra,
        })
}

/// Any plan that keeps the invariants.
pub fn plans() -> impl Strategy<Value = Plan> {
    let point = || point().boxed();
    let opening = || opening(point, || (0.0..1.0f64).boxed(), || (0.1..3.0f64).boxed());
    let walls = vec((point(), point(), 0.0..10.0f64), 0..6);
    (meta(), option::of(backdrop()), walls, vec(room(point), 0..8), vec(opening(), 0..10))
        .prop_map(|(meta, backdrop, walls, rooms, openings)| build(meta, backdrop, &walls, rooms, openings))
}

/// Any plan at the edges of what a plan may hold: corners on the edge of the drawing area, openings of any
/// width at the very ends of their walls, walls of any thickness.
pub fn plans_at_the_limits() -> impl Strategy<Value = Plan> {
    fn metre() -> impl Strategy<Value = f64> {
        let limit = enfilade::plan::COORDINATE_LIMIT_M;
        prop_oneof![
            3 => select(vec![-limit, limit]),
            3 => (0.0..3.0f64).prop_map(move |inside| limit - inside),
            1 => (0.0..3.0f64).prop_map(move |inside| inside - limit),
            2 => -9.0..9.0f64,
        ]
    }
    let point = || (metre(), metre()).prop_map(|(x, y)| Point::new(x, y)).boxed();
    let fraction = || prop_oneof![Just(0.0), Just(1.0), 0.0..1.0f64].boxed();
    let width_m = || prop_oneof![0.1..3.0f64, Just(1e-4), Just(1000.0)].boxed();
    let walls = vec((point(), point(), prop_oneof![Just(0.0), Just(10.0), 0.0..10.0f64]), 1..6);
    (meta(), walls, vec(room(point), 0..5), vec(opening(point, fraction, width_m), 1..10))
        .prop_map(|(meta, walls, rooms, openings)| build(meta, None, &walls, rooms, openings))
}

fn build(
    meta: Meta,
    backdrop: Option<Backdrop>,
    walls: &[(Point, Point, f64)],
    rooms: Vec<RoomSpec>,
    openings: Vec<OpeningSpec>,
) -> Plan {
    let mut builder = Builder::new(meta);
    if let Some(backdrop) = backdrop {
        builder.set_backdrop(backdrop);
    }
    let mut edges: Vec<(CornerId, CornerId)> = Vec::new();
    for &(a, b, thickness_m) in walls {
        let (from, to) = (builder.corner(a), builder.corner(b));
        if from != to {
            builder.wall(from, to, thickness_m);
            edges.push((from, to));
        }
    }
    let mut ids: Vec<RoomId> = Vec::new();
    for spec in rooms {
        let rings: Vec<_> =
            spec.rings.into_iter().map(|ring| builder.ring(ring)).filter(|ring| ring.len() > 2).collect();
        for ring in &rings {
            edges.extend((0..ring.len()).map(|i| (ring[i], ring[(i + 1) % ring.len()])));
        }
        let mut rings = rings.into_iter();
        let [function, name, note] = spec.texts;
        let room = Room {
            outer: rings.next().unwrap_or_default(),
            holes: rings.collect(),
            function,
            label: spec.label.map(|(label, origin)| RoomLabel { label, origin }),
            text_offset: (note.len() % 2 == 1).then(|| Vector::new(0.5, -1.25)),
            name,
            note,
            source_id: String::new(),
            extra: spec.extra,
        };
        ids.push(builder.room(&spec.key, room));
    }
    for spec in openings {
        let (a, b) = (spec.free.0.trimmed(), spec.free.1.trimmed());
        let place = match spec.host {
            Some((index, fraction, width_m)) if !edges.is_empty() => {
                let (from, to) = edges[index % edges.len()];
                let length_m = builder.plan().position(from).unwrap().distance(builder.plan().position(to).unwrap());
                // One grid step less: the middle is rounded and must not pass the end.
                Place::Hosted { from, to, at_m: (length_m - 1e-4) * fraction, width_m }
            }
            _ if a == b => continue,
            _ => Place::Free { from: a, to: b },
        };
        let joint = |index: usize| ids.get(index).map_or(Joint::Outside, |&id| Joint::Room(id));
        let opening = Opening {
            kind: spec.kind,
            place,
            swing: spec.swing.map(|(hinge_at_start, left)| Swing {
                hinge_at_start,
                side: if left { LeafSide::Left } else { LeafSide::Right },
            }),
            pinned: spec.pinned.map(|sides| sides.map(joint)),
            source_id: String::new(),
            extra: spec.extra,
        };
        builder.opening(&spec.key, opening);
    }
    builder.finish().unwrap()
}
