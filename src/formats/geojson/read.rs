use std::collections::{BTreeMap, HashSet};
use std::sync::Arc;

use serde_json::{Map, Value};

use super::KEPT;
use super::disk::{DiskHost, DiskMeta};
use super::edges::{Edges, HOST_TOLERANCE_M};
use super::item::{DAMAGED, Item, LEFT_OUT, Parts, Role, beyond, is_within, note_on_file, parts};
use super::properties::Properties;
use super::shapes::{Shapes, is_closed};
use super::units::{self, AS_SIZES_SUGGEST};
use super::words::{FROM_SCHEME, opening_kind, opening_word};
use crate::formats::{Import, Note, NoteKind, Place, Preview, ReadError, json_text::decode, plan_json::DiskHinge};
use crate::geometry::{Bounds, COORDINATE_LIMIT_M, Point, Segment, polygon, trim_m};
use crate::labels::{Label, Typology};
use crate::plan::{
    Builder, CornerId, DEFAULT_DOOR_WIDTH_M, DEFAULT_WALL_THICKNESS_M, Extra, Joint, LabelOrigin, Meta, Opening,
    OpeningKind, Place as OpeningPlace, Room, RoomId, RoomLabel, Scale, ScaleOrigin, Swing, THICKEST_WALL_M, Wall,
};

/// Reads a FeatureCollection in metres. `in_metres`: also where it names no units, whatever its sizes.
pub(super) fn read(bytes: &[u8], stem: &str, in_metres: bool) -> Result<Import, ReadError> {
    let text = decode(bytes)?;
    let Parts { collection, mut items, unreadable } = parts(text)?;
    let units = units::of(&collection, &items, in_metres)?;
    let mut notes: Vec<Note> = units.words.into_iter().map(|what| note_on_file(NoteKind::Healed, what)).collect();
    notes.extend(units::move_near(&mut items));
    // Where no feature could be read, the file is refused, with the first reason.
    if items.is_empty()
        && let Some(first) = unreadable.first()
    {
        let what = first.what.strip_suffix(LEFT_OUT).unwrap_or(&first.what).to_owned();
        return Err(ReadError { place: first.place.clone(), what, hint: DAMAGED.to_owned() });
    }
    notes.extend(unreadable);
    let builder = Builder::new(meta_of(&collection.meta, stem));
    let mut reader = Reader { builder, notes, rooms: BTreeMap::new() };
    reader.add_all(items);
    let Reader { builder, mut notes, .. } = reader;
    let mut plan = builder.finish().map_err(|violations| ReadError {
        place: Place {
            line: None,
            element: violations.first().map(|violation| violation.element.to_string()).unwrap_or_default(),
        },
        what: violations.into_iter().next().map(|violation| violation.what).unwrap_or_default(),
        hint: DAMAGED.to_owned(),
    })?;
    if let Some(doubt) = units::doubt(&plan, units.are_stated) {
        // In place of 'as the sizes suggest': they do not.
        notes.retain(|note| !(note.place == Place::default() && note.what.contains(AS_SIZES_SUGGEST)));
        notes.insert(0, note_on_file(NoteKind::Healed, doubt));
    }
    plan.extra = kept(collection.meta.other);
    Ok(Import { plans: vec![plan], notes })
}

/// What is in a file, by its features.
pub(super) fn preview(bytes: &[u8]) -> Result<Preview, ReadError> {
    let Parts { collection, items, unreadable } = parts(decode(bytes)?)?;
    let units = collection.units.as_ref().map(|units| units.as_str().to_owned()).filter(|units| !units.is_empty());
    let mut preview = Preview { plans: 1, units, ..Preview::default() };
    let mut bounds = Bounds::EMPTY;
    for item in &items {
        let kind = match item.role() {
            Role::Room => "room",
            Role::Opening => "opening",
            Role::Wall => "wall",
            Role::Other => "other",
        };
        *preview.layers.entry(kind.to_owned()).or_default() += 1;
        bounds = bounds.union(item.shapes.bounds());
    }
    if !unreadable.is_empty() {
        preview.layers.insert("unreadable".to_owned(), unreadable.len());
    }
    let count = |kind: &str| preview.layers.get(kind).copied().unwrap_or_default();
    (preview.rooms, preview.openings, preview.walls) = (count("room"), count("opening"), count("wall"));
    preview.size = (!bounds.is_empty()).then(|| (bounds.width(), bounds.height()));
    Ok(preview)
}

/// What a file says of the plan as a whole.
fn meta_of(disk: &DiskMeta, stem: &str) -> Meta {
    let sentence = disk.scale.as_str();
    let stated = ScaleOrigin::ALL.into_iter().find(|origin| origin.name() == disk.scale_origin.0);
    let lower = sentence.trim_start().to_lowercase();
    let opening_word = ScaleOrigin::ALL.into_iter().find(|origin| lower.starts_with(origin.name()));
    // Metres without a word on how they came about are still the file's statement.
    let origin = stated.or(opening_word).unwrap_or(ScaleOrigin::Imported);
    Meta {
        name: if disk.name.is_empty() { stem.to_owned() } else { disk.name.0.clone() },
        building: disk.building.0.clone(),
        storey: disk.storey.0.clone(),
        typology: Typology::new(disk.typology.as_str()),
        scale: Scale {
            origin,
            metres_per_unit: disk.metres_per_unit.map(|number| number.0),
            note: sentence.to_owned(),
        },
        source: disk.source.0.clone(),
        licence: disk.licence.0.clone(),
        extra: None,
    }
}

fn kept(other: Map<String, Value>) -> Extra {
    (!other.is_empty()).then(|| Arc::new(Map::from_iter([(KEPT.to_owned(), Value::Object(other))])))
}

struct Reader {
    builder: Builder,
    notes: Vec<Note>,
    /// Rooms by their feature's id, and by the id among their properties where that is another.
    rooms: BTreeMap<String, RoomId>,
}

impl Reader {
    fn note(&mut self, kind: NoteKind, place: &Place, what: impl Into<String>) {
        self.notes.push(Note { kind, place: place.clone(), what: what.into() });
    }

    /// A feature that is not in the plan.
    fn leave_out(&mut self, place: &Place, what: &str) {
        self.note(NoteKind::Skipped, place, format!("{what}{LEFT_OUT}"));
    }

    /// Adds rooms and walls first: openings refer to both, and may come before them.
    fn add_all(&mut self, items: Vec<Item>) {
        let mut openings = Vec::new();
        let mut seen: HashSet<(u8, String)> = HashSet::new();
        let mut aliases: Vec<(String, RoomId)> = Vec::new();
        for mut item in items {
            let role = item.role();
            let place = item.place();
            if role != Role::Other {
                for what in std::mem::take(&mut item.properties.passed_over) {
                    self.note(NoteKind::Healed, &place, what);
                }
                if !item.id.is_empty() && !seen.insert((role as u8, item.id.clone())) {
                    self.note(NoteKind::Healed, &place, "its id is in the file twice; kept under one of its own");
                }
            }
            match role {
                Role::Room => {
                    let alias = item.properties.id.clone();
                    if let Some(room) = self.add_room(item).filter(|_| !alias.is_empty()) {
                        aliases.push((alias, room));
                    }
                }
                Role::Wall => self.add_wall(&item),
                Role::Opening => openings.push(item),
                Role::Other => {
                    let what = match item.properties.kind.as_str() {
                        "" => format!("says not what it is (geometry {:?})", item.geometry_kind),
                        kind => format!("kind '{kind}' is not part of a plan"),
                    };
                    self.note(NoteKind::Skipped, &place, what);
                }
            }
        }
        for (alias, room) in aliases {
            self.rooms.entry(alias).or_insert(room);
        }
        if !openings.is_empty() {
            let edges = Edges::new(&self.builder);
            for item in openings {
                self.add_opening(item, &edges);
            }
        }
        // Openings came last above; notes follow the file.
        self.notes.sort_by_key(|note| note.place.line);
    }

    /// Adds a room, each of its parts as one; the largest.
    fn add_room(&mut self, item: Item) -> Option<RoomId> {
        let place = item.place();
        if let Some(what) = beyond(item.shapes.positions()) {
            self.leave_out(&place, &what);
            return None;
        }
        let geometry = item.geometry();
        let Shapes { points, lines, areas } = &item.shapes;
        let areas = if !areas.is_empty() {
            if points.len() + lines.len() > 0 {
                let what = format!("its geometry is {geometry}; the area is taken, the rest left out");
                self.note(NoteKind::Healed, &place, what);
            }
            areas.clone()
        } else if let Some(areas) = item.shapes.areas_of_lines() {
            self.note(
                NoteKind::Healed,
                &place,
                format!("its boundary is {geometry}; taken as the area that it bounds"),
            );
            areas
        } else if let [line] = item.shapes.joined_lines().as_slice()
            && line.len() > 2
        {
            vec![vec![line.clone()]]
        } else {
            Vec::new()
        };
        let mut parts: Vec<Room> = Vec::new();
        for rings in &areas {
            let mut rings = rings.iter();
            let outer = rings.next().map(Vec::as_slice).unwrap_or_default();
            let Some(outer) = self.ring(outer, "boundary", &place) else { continue };
            let holes = rings.filter_map(|hole| self.ring(hole, "hole", &place)).collect();
            parts.push(Room { outer, holes, ..Room::default() });
        }
        if parts.is_empty() {
            let what = match (areas.is_empty(), item.shapes.words().is_empty()) {
                (true, false) => format!("its geometry is {geometry}, which bounds no area; kept without a boundary"),
                _ => "has no boundary; kept without one".to_owned(),
            };
            self.note(NoteKind::Healed, &place, what);
            parts.push(Room::default());
        } else if parts.len() > 1 {
            let what = format!("has {} parts; each becomes a room, openings lead to the largest", parts.len());
            self.note(NoteKind::Healed, &place, what);
            let area = |part: &Room| polygon::signed_area(&self.builder.plan().ring_points(&part.outer)).abs();
            parts.sort_by(|p, q| area(q).total_cmp(&area(p)));
        }
        let room = self.room_of(item.properties, &place);
        let id = item.id.as_str();
        let mut largest = None;
        for (number, part) in (1..).zip(parts) {
            let key = key_of_part(id, number);
            let room = self.builder.room(&key, Room { outer: part.outer, holes: part.holes, ..room.clone() });
            if number == 1 {
                largest = Some(room);
                if !id.is_empty() {
                    self.rooms.entry(key).or_insert(room);
                }
            }
        }
        largest
    }

    /// A room with everything but its boundary.
    fn room_of(&mut self, properties: Properties, place: &Place) -> Room {
        // A label that follows from the function is there for other readers.
        let own_label = !properties.label.is_empty() && properties.label_origin != FROM_SCHEME;
        let label = own_label.then(|| properties.label.parse::<Label>());
        if let Some(Err(unknown)) = &label {
            self.note(NoteKind::Skipped, place, format!("{unknown}; left unlabelled"));
        }
        let origin = LabelOrigin::ALL.into_iter().find(|origin| origin.name() == properties.label_origin);
        Room {
            function: properties.function,
            label: label
                .and_then(Result::ok)
                .map(|label| RoomLabel { label, origin: origin.unwrap_or(LabelOrigin::Imported) }),
            name: properties.name,
            note: properties.note,
            source_id: properties.source_id,
            extra: kept(properties.other),
            ..Room::default()
        }
    }

    /// A ring's corners; `None` with a note when it has fewer than three.
    fn ring(&mut self, points: &[Point], what: &str, place: &Place) -> Option<Arc<[CornerId]>> {
        let mut points: Vec<Point> = points.iter().map(|point| point.trimmed()).collect();
        points.dedup();
        let closed = points.len() > 1 && points.first() == points.last();
        if closed {
            points.pop();
        }
        if points.len() < 3 {
            let what = format!("its {what} has {} corners, at least 3 are needed{LEFT_OUT}", points.len());
            self.note(NoteKind::Skipped, place, what);
            return None;
        }
        if !closed {
            self.note(NoteKind::Healed, place, format!("its {what} is not closed; closed"));
        }
        Some(self.builder.ring(points))
    }

    fn add_wall(&mut self, item: &Item) {
        let place = item.place();
        if let Some(what) = beyond(item.shapes.positions()) {
            self.leave_out(&place, &what);
            return;
        }
        let lines = &item.shapes.lines;
        if lines.is_empty() {
            self.leave_out(&place, &format!("a wall is a line, and this has {}", item.geometry()));
            return;
        }
        if item.shapes.points.len() + item.shapes.areas.len() > 0 {
            let what = format!("its geometry is {}; the lines are taken, the rest left out", item.geometry());
            self.note(NoteKind::Healed, &place, what);
        }
        let trimmed = lines.iter().map(|line| {
            let mut points: Vec<Point> = line.iter().map(|point| point.trimmed()).collect();
            points.dedup();
            points
        });
        let lines: Vec<Vec<Point>> = trimmed.filter(|points| points.len() > 1).collect();
        if lines.is_empty() {
            self.leave_out(&place, "the wall has no length");
            return;
        }
        let stated_m = item.properties.thickness_m;
        let thickness_m = stated_m.filter(|thickness_m| (0.0..=10.0).contains(thickness_m));
        if thickness_m.is_none() {
            let found = stated_m.map_or("no thickness".to_owned(), |stated_m| format!("the thickness {stated_m} m"));
            self.note(NoteKind::Healed, &place, format!("the wall has {found}; taken as {DEFAULT_WALL_THICKNESS_M} m"));
        }
        let extra = kept(item.properties.other.clone());
        for points in lines {
            let corners: Vec<CornerId> = points.iter().map(|&point| self.builder.corner(point)).collect();
            for pair in corners.windows(2) {
                let wall = Wall {
                    from: pair[0],
                    to: pair[1],
                    thickness_m: thickness_m.unwrap_or(DEFAULT_WALL_THICKNESS_M),
                    extra: extra.clone(),
                };
                self.builder.wall_as(item.id.parse().ok(), wall);
            }
        }
    }

    fn add_opening(&mut self, mut item: Item, edges: &Edges) {
        let place = item.place();
        let is_point = |line: &[Point]| line.first() == line.last();
        let mut lines = item.shapes.joined_lines();
        if item.shapes.lines.is_empty() {
            lines = item.shapes.points.iter().map(|point| vec![point.trimmed()]).collect();
        }
        if lines.is_empty() {
            self.leave_out(&place, &format!("an opening is a line or a point, and this has {}", item.geometry()));
            return;
        }
        if lines.iter().any(|line| is_closed(line)) {
            self.leave_out(&place, "an opening is a line from one end to the other, and this one ends where it starts");
            return;
        }
        let properties = &mut item.properties;
        let host = properties.host.take();
        let is_free = properties.free == Some(true);
        let stated_host = |reader: &mut Self, line: &[Point]| {
            reader.stated_host(host.as_ref().filter(|_| !is_free)?, *line.first()?, *line.last()?)
        };
        // An opening at the edge of the drawing area may reach beyond it, as long as its wall does not.
        let hosts: Vec<Option<OpeningPlace>> = lines.iter().map(|line| stated_host(self, line)).collect();
        let unhosted = lines.iter().zip(&hosts).filter(|(_, host)| host.is_none()).flat_map(|(line, _)| line);
        if let Some(what) = beyond(unhosted.copied()) {
            self.leave_out(&place, &what);
            return;
        }
        let kind = match opening_kind(&properties.opening) {
            Some(kind) => kind,
            None => {
                let what = match properties.opening.as_str() {
                    "" => "says not what it is; taken as a door".to_owned(),
                    other => format!("'{other}' is no known opening; taken as a door"),
                };
                self.note(NoteKind::Healed, &place, what);
                OpeningKind::Door
            }
        };
        // The source's own word ('sliding_door') is kept where ours says less.
        if !properties.opening.is_empty() && properties.opening != opening_word(kind) {
            properties.other.insert("opening".to_owned(), Value::String(properties.opening.clone()));
        }
        let pinned = match properties.rooms.take() {
            Some(rooms) if properties.pinned != Some(false) => self.joints(&rooms, &place),
            _ => None,
        };
        if lines.len() > 1 {
            self.note(NoteKind::Healed, &place, format!("has {} parts; each becomes an opening", lines.len()));
        }
        let swing = properties
            .hinge
            .zip(properties.opens)
            .map(|(hinge, side)| Swing { hinge_at_start: hinge == DiskHinge::Start, side: side.into() });
        let (source_id, extra) = (properties.source_id.clone(), kept(std::mem::take(&mut properties.other)));
        for ((number, line), hosted) in (1..).zip(&lines).zip(hosts) {
            let (Some(&a), Some(&b)) = (line.first(), line.last()) else { continue };
            let on = match hosted {
                Some(hosted) => hosted,
                None if is_point(line) => self.place_of_point(a, pinned.as_ref(), is_free, edges, &place),
                None if is_free => OpeningPlace::Free { from: a, to: b },
                None => edges.host(a, b).unwrap_or(OpeningPlace::Free { from: a, to: b }),
            };
            let opening =
                Opening { kind, place: on, swing, pinned, source_id: source_id.clone(), extra: extra.clone() };
            self.builder.opening(&key_of_part(&item.id, number), opening);
        }
    }

    /// The place of an opening of which the file gives one point only.
    fn place_of_point(
        &mut self,
        point: Point,
        pinned: Option<&[Joint; 2]>,
        is_free: bool,
        edges: &Edges,
        place: &Place,
    ) -> OpeningPlace {
        let joins: Vec<RoomId> = pinned.into_iter().flatten().filter_map(|joint| joint.room()).collect();
        let found = if is_free { None } else { edges.of_point(&self.builder, point, &joins) };
        let width = format!("has no width; taken as {DEFAULT_DOOR_WIDTH_M} m");
        match found {
            Some(door) => {
                let mut what = width;
                if door.off_m > THICKEST_WALL_M {
                    what.push_str(&format!(", put on the nearest wall of its rooms, {:.1} m away", door.off_m));
                } else if door.off_m > HOST_TOLERANCE_M {
                    what.push_str(&format!(", put on its wall, {:.3} m away", door.off_m));
                }
                if door.moved_m > HOST_TOLERANCE_M {
                    what.push_str(&format!(", moved {:.2} m along its wall to fit", door.moved_m));
                }
                self.note(NoteKind::Healed, place, what);
                door.place
            }
            None => {
                self.note(NoteKind::Healed, place, width);
                let within = |value: f64| value.clamp(-COORDINATE_LIMIT_M, COORDINATE_LIMIT_M);
                let (a, b) = edges.widened(point);
                let [from, to] = [a, b].map(|end| Point::new(within(end.x), within(end.y)));
                OpeningPlace::Free { from, to }
            }
        }
    }

    /// The sides that a file states; `None` with a note when they cannot be resolved.
    fn joints(&mut self, rooms: &[Option<String>], place: &Place) -> Option<[Joint; 2]> {
        let [first, second] = rooms else {
            let what = format!("joins {} rooms, not 2; they follow from its place instead", rooms.len());
            self.note(NoteKind::Healed, place, what);
            return None;
        };
        let mut joint = |room: &Option<String>| match room {
            None => Some(Joint::Outside),
            Some(key) => match self.rooms.get(key) {
                Some(&id) => Some(Joint::Room(id)),
                None => {
                    let what = format!(
                        "joins the room '{key}', which is not in the file; the rooms follow from its place instead"
                    );
                    self.notes.push(Note { kind: NoteKind::Healed, place: place.clone(), what });
                    None
                }
            },
        };
        Some([joint(first)?, joint(second)?])
    }

    /// The place that the property `host` states, when it agrees with the line from `a` to `b`: where
    /// another program moved the line, the line counts.
    fn stated_host(&mut self, host: &DiskHost, a: Point, b: Point) -> Option<OpeningPlace> {
        let edge = Segment::new(host.from.0.trimmed(), host.to.0.trimmed());
        let (at_m, width_m) = (trim_m(host.at_m.0), trim_m(host.width_m.0));
        let direction = edge.vector().unit()?;
        let middle = edge.a + direction * at_m;
        let half = direction * (width_m / 2.0);
        // The length of an edge off the axes is not on the grid, as `at_m` is.
        let agrees = is_within(edge.a)
            && is_within(edge.b)
            && (0.0..=edge.length() + crate::geometry::GRID_M).contains(&at_m)
            && width_m > 0.0
            && (middle - half).distance(a) <= HOST_TOLERANCE_M
            && (middle + half).distance(b) <= HOST_TOLERANCE_M;
        agrees.then(|| OpeningPlace::Hosted {
            from: self.builder.corner(edge.a),
            to: self.builder.corner(edge.b),
            at_m,
            width_m,
        })
    }
}

/// The identity of a feature's part in the source; without an id, its place makes the identity.
fn key_of_part(id: &str, number: usize) -> String {
    if number == 1 || id.is_empty() { id.to_owned() } else { format!("{id} part {number}") }
}
