//! Two people's labels of the same plan: which rooms are the same, where the labels differ, and one plan made of both.

use std::collections::{BTreeMap, BTreeSet};

use crate::edit::{self, EditError};
use crate::features::RoomStatus;
use crate::geometry::{Point, polygon};
use crate::labels::{Label, Schemes, normalised_function};
use crate::plan::{Plan, Room, RoomId};

/// A room in two plans.
#[derive(Clone, Debug, PartialEq)]
pub struct Pair {
    /// Its id in the first plan and in the second.
    pub ids: [RoomId; 2],
    /// What it is called, in the first plan if it has a name there.
    pub name: String,
    /// Its labels, its own or those of its functions; `None` for a room without one.
    pub labels: [Option<Label>; 2],
    pub functions: [String; 2],
}

impl Pair {
    /// Whether both labelled it, and differently.
    pub fn is_contradicted(&self) -> bool {
        matches!(self.labels, [Some(first), Some(second)] if first != second)
    }

    /// Whether it has another label, or another function, in the second plan.
    pub fn differs(&self) -> bool {
        self.labels[0] != self.labels[1]
            || normalised_function(&self.functions[0]) != normalised_function(&self.functions[1])
    }
}

/// Two plans side by side.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Compared {
    /// Rooms that both have, in the order of their ids in the first.
    pub pairs: Vec<Pair>,
    /// Rooms that only one of them has.
    pub alone: [Vec<RoomId>; 2],
}

impl Compared {
    /// The labels of rooms that both labelled.
    pub fn labels(&self) -> impl Iterator<Item = (Label, Label)> + '_ {
        self.pairs.iter().filter_map(|pair| pair.labels[0].zip(pair.labels[1]))
    }
}

/// Rooms whose centres are nearer than this...
const NEAR_M: f64 = 0.25;

/// ...and whose areas differ by less than this share are one room, also if their ids differ.
const ALIKE: f64 = 0.05;

/// Which rooms two plans have in common, and how they are labelled. Rooms with the same id are the same; of the others those with
/// the same outline in the same place.
pub fn compare(first: &Plan, second: &Plan, schemes: &Schemes) -> Compared {
    let mut partner: BTreeMap<RoomId, RoomId> =
        first.rooms().map(|(id, _)| id).filter(|&id| second.room(id).is_some()).map(|id| (id, id)).collect();
    let mut free: BTreeMap<RoomId, (Point, f64)> = second
        .rooms()
        .filter(|(id, _)| !partner.contains_key(id))
        .filter_map(|(id, room)| Some((id, place_of(second, room)?)))
        .collect();
    for (id, room) in first.rooms() {
        if partner.contains_key(&id) {
            continue;
        }
        let Some((centre, area_m2)) = place_of(first, room) else { continue };
        let is_it = |place: &(Point, f64)| {
            place.0.distance(centre) <= NEAR_M && (place.1 - area_m2).abs() <= ALIKE * area_m2.max(place.1)
        };
        let nearest = free
            .iter()
            .filter(|(_, place)| is_it(place))
            .min_by(|p, q| p.1.0.distance(centre).total_cmp(&q.1.0.distance(centre)));
        if let Some((&other, _)) = nearest {
            free.remove(&other);
            partner.insert(id, other);
        }
    }
    let pair = |(&one, &other): (&RoomId, &RoomId)| {
        let rooms = [first.room(one)?, second.room(other)?];
        let name = rooms.map(|room| if room.name.is_empty() { room.source_id.clone() } else { room.name.clone() });
        Some(Pair {
            ids: [one, other],
            name: name.into_iter().find(|name| !name.is_empty()).unwrap_or_default(),
            labels: [
                RoomStatus::of(first, schemes, rooms[0]).label(),
                RoomStatus::of(second, schemes, rooms[1]).label(),
            ],
            functions: rooms.map(|room| room.function.clone()),
        })
    };
    let taken: BTreeSet<RoomId> = partner.values().copied().collect();
    Compared {
        pairs: partner.iter().filter_map(pair).collect(),
        alone: [
            first.rooms().map(|(id, _)| id).filter(|id| !partner.contains_key(id)).collect(),
            second.rooms().map(|(id, _)| id).filter(|id| !taken.contains(id)).collect(),
        ],
    }
}

/// The middle and the area of a room; `None` for one that encloses nothing.
fn place_of(plan: &Plan, room: &Room) -> Option<(Point, f64)> {
    let outer = plan.ring_points(&room.outer);
    let holes: Vec<Vec<Point>> = room.holes.iter().map(|ring| plan.ring_points(ring)).collect();
    let area_m2 = polygon::area(&outer, &holes);
    (area_m2 > 0.0).then(|| (polygon::centroid(&outer), area_m2))
}

/// Whose word counts where two people differ.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Prefer {
    First,
    Second,
    /// Nobody's: the room is left without a function and a label, for a third person.
    Neither,
}

impl Prefer {
    pub const ALL: [Self; 3] = [Self::First, Self::Second, Self::Neither];

    pub const fn name(self) -> &'static str {
        match self {
            Self::First => "first",
            Self::Second => "second",
            Self::Neither => "neither",
        }
    }
}

/// The first plan with what the second says of the rooms they have in common: a label or a function that only one of them gives
/// is kept; where they differ, `prefer` decides.
///
/// # Errors
/// When the pairs are of other plans.
pub fn merged(first: &Plan, second: &Plan, compared: &Compared, prefer: Prefer) -> Result<Plan, EditError> {
    let mut plan = first.clone();
    for pair in compared.pairs.iter().filter(|pair| pair.differs()) {
        plan = match said_by(pair, prefer) {
            Some(Side::First) => plan,
            Some(Side::Second) => with_word_of(&plan, pair, second)?,
            None => edit::change_room(&plan, pair.ids[0], |room| {
                room.function.clear();
                room.label = None;
            })?,
        };
    }
    Ok(plan)
}

enum Side {
    First,
    Second,
}

fn said_by(pair: &Pair, prefer: Prefer) -> Option<Side> {
    match (pair.labels, prefer) {
        ([Some(_), None], _) => Some(Side::First),
        ([None, Some(_)], _) => Some(Side::Second),
        (_, Prefer::First) => Some(Side::First),
        (_, Prefer::Second) => Some(Side::Second),
        (_, Prefer::Neither) => None,
    }
}

/// A plan whose room says what its pair in the second plan does.
///
/// # Errors
/// When the room does not exist.
pub fn with_word_of(plan: &Plan, pair: &Pair, second: &Plan) -> Result<Plan, EditError> {
    let Some(theirs) = second.room(pair.ids[1]) else { return Ok(plan.clone()) };
    edit::change_room(plan, pair.ids[0], |room| {
        room.function.clone_from(&theirs.function);
        room.label = theirs.label;
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::{ElementId, LabelOrigin, RoomLabel};

    fn office() -> Plan {
        let plans = crate::store::bundled_plans().unwrap();
        plans.into_iter().find(|(name, _)| *name == "office.plan.json").unwrap().1
    }

    fn relabelled(plan: &Plan, id: RoomId, label: Label) -> Plan {
        edit::set_label(plan, id, Some(RoomLabel { label, origin: LabelOrigin::Person })).unwrap()
    }

    #[test]
    fn rooms_are_paired_by_id_or_by_outline_and_merged() {
        let schemes = Schemes::bundled();
        let first = office();
        let ids: Vec<RoomId> = first.rooms().map(|(id, _)| id).collect();
        // The second person drew a room anew, so that it has another id, and labelled two otherwise.
        let room = first.room(ids[0]).unwrap().clone();
        let (both, anew) = edit::add_room(&first, room).unwrap();
        let second = edit::remove(&both, &[ElementId::Room(ids[0])]).unwrap();
        assert_ne!(anew, ids[0]);
        let second = relabelled(&relabelled(&second, anew, Label::Hall), ids[1], Label::BigRoom);
        let compared = compare(&first, &second, &schemes);
        assert_eq!(compared.pairs.len(), first.rooms().len());
        assert!(compared.alone.iter().all(Vec::is_empty));
        let differ: Vec<[RoomId; 2]> =
            compared.pairs.iter().filter(|pair| pair.is_contradicted()).map(|pair| pair.ids).collect();
        assert_eq!(differ, [[ids[0], anew], [ids[1], ids[1]]]);
        let label = |plan: &Plan, id| RoomStatus::of(plan, &schemes, plan.room(id).unwrap()).label();
        assert_eq!(merged(&first, &second, &compared, Prefer::First).unwrap(), first);
        let theirs = merged(&first, &second, &compared, Prefer::Second).unwrap();
        assert_eq!((label(&theirs, ids[0]), label(&theirs, ids[1])), (Some(Label::Hall), Some(Label::BigRoom)));
        assert!(compare(&theirs, &second, &schemes).pairs.iter().all(|pair| !pair.differs()));
        let open = merged(&first, &second, &compared, Prefer::Neither).unwrap();
        assert_eq!((label(&open, ids[0]), label(&open, ids[1])), (None, None));
        assert_eq!(label(&open, ids[2]), label(&first, ids[2]));
    }
}
