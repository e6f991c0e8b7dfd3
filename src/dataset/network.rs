use std::collections::BTreeMap;
use std::sync::{Arc, OnceLock};

use imbl::ordmap::DiffItem;

use super::fingerprint::{Prints, RoomPrint};
use super::{BY_SCHEME, LeftOut, Row};
use crate::edit;
use crate::features::{Analysis, Features, NeighbourLabels, RoomAnalysis, RoomStatus, analyse, analyse_after};
use crate::geometry::{hull, polygon, runs};
use crate::labels::{Label, Schemes, Typology};
use crate::plan::titles::room_keys;
use crate::plan::{LabelOrigin, Meta, OpeningId, OpeningKind, Plan, Room, RoomId};
use crate::topology::{Connection, RoomShape};

/// The flats of a storey, and what they share. Rooms by their index in the network, ascending. See `flats`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Flats {
    /// At least two.
    pub flats: Vec<Vec<usize>>,
    /// Stairs, lifts and the passages between them, and rooms too few to be a flat.
    pub common: Vec<usize>,
}

/// The rooms of one plan as classifiers see them: each room's own properties, its label if known, and
/// where each of its openings leads. Features can be computed from it for any labels of the neighbours,
/// without going back to the plan's geometry.
#[derive(Clone, Debug)]
pub struct RoomNetwork {
    /// The file it was read from, as it was named; empty where unknown.
    pub file: String,
    /// Name of the plan.
    pub plan: String,
    /// Its building; if the plan names none, the plan alone.
    pub building: String,
    /// What folds never split: the building, unless it has near twins elsewhere.
    pub group: String,
    /// Which storey of the building; empty where unknown.
    pub storey: String,
    pub typology: Option<Typology>,
    /// The rooms to classify, in the order of [`room_keys`]: those with an area whose function the scheme
    /// does not leave blank. All others count as the outside.
    pub rooms: Vec<NetworkRoom>,
    /// Why other rooms are missing here, and which of the rooms here have no label.
    pub left_out: LeftOut,
    /// See [`RoomNetwork::flats`]; empty until somebody asks. Whoever changes areas or doors of the rooms empties it.
    pub flats: OnceLock<Option<Flats>>,
}

/// For each of these rooms its place among those `before`; `None` for one that is new. Quick where few have come or gone.
pub fn places_among(before: &[RoomId], rooms: &[RoomId]) -> Vec<Option<usize>> {
    let mut all: BTreeMap<RoomId, usize> = BTreeMap::new();
    let mut next = 0;
    let place = |room: &RoomId| {
        // Most rooms follow each other as before, but for some that have gone.
        let near = before.iter().skip(next).take(8).position(|other| other == room).map(|ahead| next + ahead);
        let place = near.or_else(|| {
            if all.is_empty() {
                all = before.iter().enumerate().map(|(place, &room)| (room, place)).collect();
            }
            all.get(room).copied()
        });
        next = place.map_or(next, |place| place + 1);
        place
    };
    rooms.iter().map(place).collect()
}

/// A room of a [`RoomNetwork`].
#[derive(Clone, Debug, PartialEq)]
pub struct NetworkRoom {
    pub id: RoomId,
    /// Its key in tables, see [`room_keys`].
    pub key: String,
    /// Its name; empty if it has none.
    pub name: String,
    pub function: String,
    /// Its label, if known: its own, or the scheme's for its function.
    pub label: Option<Label>,
    /// Who gave the label; `None` for one that follows from the function, or without a label.
    pub label_origin: Option<LabelOrigin>,
    /// Whether it is a second reading of a room that counts elsewhere: then it is a neighbour only, never a row.
    pub is_repeat: bool,
    /// The fold it is tested in, from 0, where folds were given.
    pub fold: Option<usize>,
    /// What tells it again.
    pub print: RoomPrint,
    /// The naive classifier's label.
    pub temporary: Label,
    /// `a` in m².
    pub area_m2: f64,
    /// `rt`.
    pub axes_ratio: f64,
    /// Other properties of its shape; the paper's features do not use them.
    pub form: Form,
    /// Every opening of the room, and where it leads.
    pub doors: Vec<NetworkDoor>,
}

/// Measures of a room's shape, invariant under moving, rotating and mirroring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Form {
    /// Length of the outer boundary and of the holes.
    pub perimeter_m: f64,
    /// Number of walls ([`runs::runs`]) around the outside: 4 for a rectangle.
    pub walls: u32,
    /// The longer side of the smallest enclosing rectangle, at any angle.
    pub length_m: f64,
    /// The shorter side.
    pub width_m: f64,
    /// Area as a share of the convex hull's, 0..=1: below 1 if a corner points inwards.
    pub convexity: f64,
}

impl Form {
    /// The measures of a shape with this area in m².
    pub fn new(shape: &RoomShape, area_m2: f64) -> Self {
        let (length_m, width_m) = hull::smallest_rectangle(&shape.outer);
        let hull_m2 = polygon::area(&hull::convex_hull(&shape.outer), &[[]; 0]);
        Self {
            perimeter_m: shape.rings().map(|ring| polygon::perimeter(ring)).sum(),
            walls: runs::runs(&shape.outer).len() as u32,
            length_m,
            width_m,
            convexity: if hull_m2 > 0.0 { (area_m2 / hull_m2).min(1.0) } else { 1.0 },
        }
    }

    /// Area as a share of the smallest rectangle's, 0..=1.
    pub fn fill(&self, area_m2: f64) -> f64 {
        let rectangle_m2 = self.length_m * self.width_m;
        if rectangle_m2 > 0.0 { (area_m2 / rectangle_m2).min(1.0) } else { 1.0 }
    }
}

/// An opening of a [`NetworkRoom`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NetworkDoor {
    pub opening: OpeningId,
    pub kind: OpeningKind,
    /// The index in [`RoomNetwork::rooms`] of the room it leads to; `None` for the outside, a room that
    /// is not classified, or the room itself.
    pub to: Option<usize>,
}

/// What is measured of a plan's rooms besides their features: it depends on their shapes and names, and on no label.
#[derive(Clone, Debug)]
pub struct Measured {
    /// The rooms in the order of [`room_keys`].
    keys: Arc<Vec<(RoomId, String)>>,
    /// For each of these its index in the analysed shapes.
    places: Arc<Vec<Option<u32>>>,
    prints: Arc<Prints>,
    /// In the order of the analysed shapes; `None` for a room that encloses no area.
    forms: Arc<Vec<Option<Form>>>,
}

impl Measured {
    /// Measures the rooms of an analysed plan.
    pub fn new(plan: &Plan, analysis: &Analysis) -> Self {
        let forms = analysis.shapes.all().iter().zip(&analysis.rooms).map(|(shape, room)| form_of(shape, room));
        let keys = room_keys(plan);
        Self {
            places: Arc::new(places_of(&keys, analysis)),
            keys: Arc::new(keys),
            prints: Arc::new(Prints::new(&analysis.shapes)),
            forms: Arc::new(forms.collect()),
        }
    }

    /// The same after an edit, from what was measured before it: only what has changed is measured again.
    pub fn after(plan: &Plan, analysis: &Analysis, before: &Analysis, measured: &Self) -> Self {
        // Keys follow from names and ids alone.
        let is_key_kept = |item: DiffItem<'_, '_, RoomId, Arc<Room>>| match item {
            DiffItem::Update { old: (_, old), new: (_, new) } => old.name == new.name && old.source_id == new.source_id,
            DiffItem::Add(..) | DiffItem::Remove(..) => false,
        };
        let earlier = &before.plan().rooms;
        let (keys, places) = match plan.rooms.ptr_eq(earlier) || plan.rooms.diff(earlier).all(is_key_kept) {
            true => (measured.keys.clone(), measured.places.clone()),
            false => {
                let keys = room_keys(plan);
                let places = places_of(&keys, analysis);
                (Arc::new(keys), Arc::new(places))
            }
        };
        if Arc::ptr_eq(&analysis.shapes, &before.shapes) {
            return Self { keys, places, ..measured.clone() };
        }
        let mut known = before.shapes.all().iter().zip(measured.forms.iter()).peekable();
        let forms = analysis.shapes.all().iter().zip(&analysis.rooms).map(|(shape, room)| {
            // Both are sorted by id.
            while known.next_if(|(earlier, _)| earlier.id < shape.id).is_some() {}
            known.next_if(|(earlier, _)| *earlier == shape).map_or_else(|| form_of(shape, room), |(_, form)| *form)
        });
        let forms = Arc::new(forms.collect());
        let prints = Arc::new(Prints::after(&analysis.shapes, &before.shapes, &measured.prints));
        Self { keys, places, prints, forms }
    }
}

fn places_of(keys: &[(RoomId, String)], analysis: &Analysis) -> Vec<Option<u32>> {
    keys.iter().map(|(id, _)| Some(analysis.shapes.index_of(*id)? as u32)).collect()
}

fn form_of(shape: &RoomShape, room: &RoomAnalysis) -> Option<Form> {
    room.features.map(|features| Form::new(shape, features.area_m2))
}

/// Who gave a room its own label.
fn origin_of(room: &Room) -> Option<LabelOrigin> {
    room.given_label().map(|given| given.origin)
}

impl RoomNetwork {
    /// For each room the rooms its openings lead to, without repeats, ascending.
    pub fn joined(&self) -> Vec<Vec<usize>> {
        let of_room = |room: &NetworkRoom| {
            let mut joined: Vec<usize> = room.doors.iter().filter_map(|door| door.to).collect();
            joined.sort_unstable();
            joined.dedup();
            joined
        };
        self.rooms.iter().map(of_room).collect()
    }

    /// The network of a plan.
    pub fn new(plan: &Plan, schemes: &Schemes) -> Self {
        Self::of(plan, &analyse(plan, schemes, NeighbourLabels::True))
    }

    /// The network of an analysed plan, whichever neighbours' labels the analysis used.
    pub fn of(plan: &Plan, analysis: &Analysis) -> Self {
        Self::of_measured(plan, analysis, &Measured::new(plan, analysis))
    }

    /// The same from what was measured of the plan.
    pub fn of_measured(plan: &Plan, analysis: &Analysis, measured: &Measured) -> Self {
        let typology = plan.meta().typology.as_ref();
        let mut left_out = LeftOut::default();
        let mut rooms: Vec<NetworkRoom> = Vec::with_capacity(analysis.rooms.len());
        // By the index of the shape.
        let mut place_of: Vec<Option<usize>> = vec![None; analysis.rooms.len()];
        let mut shapes: Vec<usize> = Vec::with_capacity(analysis.rooms.len());
        let by_index: Vec<&Arc<Room>> = plan.rooms.values().collect();
        for ((id, key), index) in measured.keys.iter().zip(measured.places.iter()) {
            let (id, Some(index)) = (*id, index.map(|index| index as usize)) else { continue };
            let Some(&room) = by_index.get(index) else { continue };
            let result = &analysis.rooms[index];
            match result.status {
                RoomStatus::NotClassified => {
                    left_out.not_classified += 1;
                    continue;
                }
                RoomStatus::Unlabelled if room.function.is_empty() => left_out.without_function += 1,
                RoomStatus::Unlabelled => {
                    let typology = typology.map(Typology::as_str).unwrap_or_default().to_owned();
                    *left_out.unknown_functions.entry((typology, room.function.clone())).or_default() += 1;
                }
                RoomStatus::Labelled(_) if result.features.is_none() => left_out.without_area += 1,
                RoomStatus::Labelled(_) => {}
            }
            let (Some(features), Some(temporary)) = (result.features, result.temporary) else { continue };
            let (Some(&print), Some(form)) = (measured.prints.of(index), measured.forms[index]) else { continue };
            place_of[index] = Some(rooms.len());
            shapes.push(index);
            rooms.push(NetworkRoom {
                id,
                key: key.clone(),
                name: room.name.clone(),
                function: room.function.clone(),
                label: result.status.label(),
                label_origin: origin_of(room),
                is_repeat: false,
                fold: None,
                print,
                temporary,
                area_m2: features.area_m2,
                axes_ratio: features.axes_ratio,
                form,
                doors: Vec::new(),
            });
        }
        for (room, index) in rooms.iter_mut().zip(shapes) {
            let door = |(connection, other): (&Connection, Option<usize>)| NetworkDoor {
                opening: connection.opening,
                kind: connection.kind,
                to: other.and_then(|other| place_of[other]),
            };
            room.doors = analysis.graph.doors_of(index).map(door).collect();
        }
        let meta = plan.meta();
        let building = meta.building_or_name().to_owned();
        let (group, storey) = (building.clone(), meta.storey.clone());
        let (file, plan) = (String::new(), meta.name.clone());
        let flats = OnceLock::new();
        Self { file, plan, building, group, storey, typology: typology.cloned(), rooms, left_out, flats }
    }

    /// The network of a plan as if its typology were unknown: no label scheme says which rooms are not
    /// classified, so all are included. Typology and labels are the true ones, to learn from.
    pub fn without_typology(plan: &Plan, schemes: &Schemes) -> Self {
        Self::taken_for(plan, None, schemes)
    }

    /// The network of a plan taken for one of a typology, or of none, whatever it states: that typology's label scheme says which
    /// rooms are classified. Typology and labels are still those that the plan states.
    pub fn taken_for(plan: &Plan, typology: Option<&Typology>, schemes: &Schemes) -> Self {
        let analysis = analyse(plan, schemes, NeighbourLabels::True);
        Self::of_analysed_taken_for(plan, &analysis, &Measured::new(plan, &analysis), typology, schemes)
    }

    /// The same of a plan that is analysed and measured.
    pub fn of_analysed_taken_for(
        plan: &Plan,
        analysis: &Analysis,
        measured: &Measured,
        typology: Option<&Typology>,
        schemes: &Schemes,
    ) -> Self {
        let stated = plan.meta().typology.clone();
        if stated.as_ref() == typology {
            return Self::of_measured(plan, analysis, measured);
        }
        let unknown = edit::set_meta(plan, Meta { typology: typology.cloned(), ..plan.meta().clone() });
        // A typology changes no shape.
        let analysis = analyse_after(&unknown, schemes, NeighbourLabels::True, Some(analysis));
        let mut network = Self { typology: stated, ..Self::of_measured(&unknown, &analysis, measured) };
        for it in &mut network.rooms {
            it.label_origin = plan.room(it.id).and_then(origin_of);
            it.label = plan.room(it.id).and_then(|room| RoomStatus::of(plan, schemes, room).label());
        }
        network
    }

    /// Whether its rooms are those of another, and look the same to a classifier that knows no labels.
    pub fn looks_like(&self, other: &Self) -> bool {
        let is_same = |room: &NetworkRoom, other: &NetworkRoom| {
            let doors = room.doors.iter().zip(&other.doors);
            room.id == other.id
                && room.temporary == other.temporary
                && room.area_m2 == other.area_m2
                && room.axes_ratio == other.axes_ratio
                && room.form == other.form
                && room.doors.len() == other.doors.len()
                && doors.fold(true, |all, (door, other)| all & (door.kind == other.kind && door.to == other.to))
        };
        self.rooms.len() == other.rooms.len()
            && self.rooms.iter().zip(&other.rooms).all(|(room, other)| is_same(room, other))
    }

    /// The labels that are known, one for each room.
    pub fn known_labels(&self) -> Vec<Option<Label>> {
        self.rooms.iter().map(|room| room.label).collect()
    }

    /// The labels that neighbours are assumed to have before any prediction. `known` holds a label for
    /// each room whose label may be used; [`NeighbourLabels::Predicted`] starts like
    /// [`NeighbourLabels::True`].
    pub fn seen_labels(&self, known: &[Option<Label>], neighbours: NeighbourLabels) -> Vec<Label> {
        let known = |index: usize| match neighbours {
            NeighbourLabels::True | NeighbourLabels::Predicted => known.get(index).copied().flatten(),
            NeighbourLabels::Temporary => None,
        };
        self.rooms.iter().enumerate().map(|(index, room)| known(index).unwrap_or(room.temporary)).collect()
    }

    /// `F_r` of a room, given the labels `seen`, one per room of the network.
    pub fn features(&self, room: usize, seen: &[Label]) -> Features {
        let NetworkRoom { area_m2, axes_ratio, doors, .. } = &self.rooms[room];
        let mut doors_to = [0; 5];
        for label in doors.iter().filter_map(|door| seen.get(door.to?)) {
            doors_to[label.index()] += 1;
        }
        Features { area_m2: *area_m2, axes_ratio: *axes_ratio, doors: doors.len() as u32, doors_to }
    }

    /// The rooms to learn from and to test on: those with a label that are no second reading.
    pub fn labelled(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.rooms.len()).filter(|&room| self.rooms[room].label.is_some() && !self.rooms[room].is_repeat)
    }

    /// The labelled rooms as rows of a dataset, when the rooms carry the labels `seen`.
    pub fn rows_seeing(&self, seen: &[Label]) -> impl Iterator<Item = Row> + '_ {
        let rows: Vec<(usize, Features)> = self.labelled().map(|room| (room, self.features(room, seen))).collect();
        rows.into_iter().filter_map(|(room, features)| {
            let room = &self.rooms[room];
            Some(Row {
                file: self.file.clone(),
                id: room.id.to_string(),
                plan: self.plan.clone(),
                building: self.building.clone(),
                storey: self.storey.clone(),
                typology: self.typology.clone(),
                room: room.key.clone(),
                function: room.function.clone(),
                label_origin: room.label_origin.map_or(BY_SCHEME, LabelOrigin::name).to_owned(),
                fold: room.fold,
                group: self.group.clone(),
                ..Row::new(room.label?, features)
            })
        })
    }
}
