//! A school of as many rooms as wanted: copies of the bundled one side by side, their corridors joined, so that it is one
//! building whose rooms can all be reached.

#![allow(dead_code, reason = "each user uses a part")]
#![allow(clippy::expect_used, reason = "a test fails by panicking")]

use std::collections::BTreeMap;

use enfilade::geometry::{Point, Vector};
use enfilade::labels::Typology;
use enfilade::plan::{Builder, CornerId, Joint, Meta, Opening, OpeningKind, Place, Plan, Room, RoomId};

/// The bundled school, without its labels and its typology if `is_bare`.
pub fn bundled_school(is_bare: bool) -> Plan {
    let plans = enfilade::store::bundled_plans().expect("the bundled plans can be read");
    let (_, school) = plans.into_iter().find(|(name, _)| name.starts_with("school")).expect("there is a school");
    if is_bare { copies(&school, 1, true) } else { school }
}

/// A school of at least so many rooms.
pub fn large_school(rooms: usize) -> Plan {
    let one = bundled_school(false);
    copies(&one, rooms.div_ceil(one.rooms().len()), false)
}

fn copies(one: &Plan, copies: usize, is_bare: bool) -> Plan {
    let typology = if is_bare { None } else { Typology::new("school") };
    let mut builder = Builder::new(Meta { name: "Large school".to_owned(), typology, ..one.meta().clone() });
    let bounds = one.bounds();
    let (width_m, height_m) = (bounds.max.x - bounds.min.x + 1.0, bounds.max.y - bounds.min.y + 1.0);
    let side = (copies as f64).sqrt().ceil() as usize;
    let corridor = |rooms: &BTreeMap<RoomId, RoomId>| {
        let corridors = one.rooms().filter(|(_, room)| room.function.contains("corridor"));
        corridors.map(|(id, _)| rooms[&id]).next()
    };
    let mut last: Option<RoomId> = None;
    for copy in 0..copies {
        let by = Vector::new((copy % side) as f64 * width_m, (copy / side) as f64 * height_m);
        let corners: BTreeMap<CornerId, CornerId> =
            one.corners().map(|(id, corner)| (id, builder.corner(corner.position + by))).collect();
        let of = |ring: &[CornerId]| ring.iter().map(|corner| corners[corner]).collect();
        for (_, wall) in one.walls() {
            builder.wall(corners[&wall.from], corners[&wall.to], wall.thickness_m);
        }
        let rooms: BTreeMap<RoomId, RoomId> = one
            .rooms()
            .map(|(id, room)| {
                let room = Room {
                    outer: of(&room.outer),
                    holes: room.holes.iter().map(|hole| of(hole)).collect(),
                    function: if is_bare { String::new() } else { room.function.clone() },
                    label: room.label.filter(|_| !is_bare),
                    text_offset: None,
                    source_id: String::new(),
                    ..room.clone()
                };
                (id, builder.room("", room))
            })
            .collect();
        for (_, opening) in one.openings() {
            let place = match opening.place {
                Place::Hosted { from, to, at_m, width_m } => {
                    Place::Hosted { from: corners[&from], to: corners[&to], at_m, width_m }
                }
                Place::Free { from, to } => Place::Free { from: from + by, to: to + by },
            };
            let side = |joint: Joint| joint.room().map_or(joint, |room| Joint::Room(rooms[&room]));
            let pinned = opening.pinned.map(|sides| sides.map(side));
            builder.opening("", Opening { place, pinned, source_id: String::new(), ..opening.clone() });
        }
        let here = corridor(&rooms);
        if let Some((before, here)) = last.zip(here) {
            let from = Point::new(bounds.min.x, bounds.min.y) + by;
            let place = Place::Free { from, to: from + Vector::new(0.0, 2.0) };
            let mut passage = Opening::new(OpeningKind::Passage, place);
            passage.pinned = Some([Joint::Room(before), Joint::Room(here)]);
            builder.opening("", passage);
        }
        last = here;
    }
    builder.finish().expect("copies of a sound plan are one")
}
