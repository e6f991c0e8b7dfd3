//! The XML of the paper's authors: one storey per file, drawn with their program 'floorplans'. What is
//! repaired and how is described for users in `docs/authors-xml.md`.

mod document;
mod scale;

use std::collections::{BTreeMap, BTreeSet, VecDeque};

use serde_json::{Map, Value};

use self::document::{Document, Floor, Portal, Space};
use super::options::METRES_PER_PIXEL;
use super::point_openings::{self, Ring};
use super::xml::{DAMAGED_HINT, Notes, root_name};
use super::{
    Format, FormatOption, Head, Import, Importer, NoteKind, Options, Place, Preview, ReadError, Recognition, Source,
};
use super::{building_name, text};
use crate::geometry::{Bounds, COORDINATE_LIMIT_M, Point, Segment, Vector};
use crate::labels::Typology;
use crate::plan::{
    Builder, CornerId, DEFAULT_DOOR_WIDTH_M, Extra, Joint, Meta, Opening, OpeningKind, Place as OpeningPlace, Plan,
    Room, RoomId, THICKEST_WALL_M,
};

/// The most edges examined to place all openings. The largest real file needs 4,431.
const EDGE_LIMIT: usize = 10_000_000;

/// A corner inserted for a portal lies at most this far from it, in pixels: the program rounds both to
/// whole pixels, and the two rooms may differ by one.
const PORTAL_CORNER_PX: f64 = 1.5;

/// The placeholder in `<Info>` ('insert information about the building').
const INFO_PLACEHOLDER: &str = "Inserire informazioni sull'edificio";

/// The XML of the paper's authors.
pub const FORMAT: Format = Format {
    id: "authors-xml",
    name: "XML of the paper's authors",
    endings: &["xml"],
    about: "Schools and offices annotated with the authors' program 'floorplans' (docs/authors-xml.md)",
    importer: Some(&AuthorsXml),
    exporter: None,
};

struct AuthorsXml;

impl Importer for AuthorsXml {
    fn options(&self) -> &'static [FormatOption] {
        const { &[FormatOption::Number(&METRES_PER_PIXEL)] }
    }

    fn recognises(&self, head: &Head<'_>) -> Recognition {
        let Head::File { start, .. } = head else { return Recognition::No };
        let is_named = head.ends_with(FORMAT.endings);
        match root_name(start) {
            Some(root) if root == "building" => Recognition::Yes,
            Some(root) if is_named => Recognition::Foreign(format!("XML with the root <{root}>")),
            None if is_named => Recognition::Perhaps,
            Some(_) | None => Recognition::No,
        }
    }

    fn preview(&self, source: &Source<'_>, options: &Options) -> Result<Preview, ReadError> {
        let document = document::parse(text::decode(source.bytes()?)?)?;
        let mut preview = Preview { units: Some("m".to_owned()), ..Preview::default() };
        let mut bounds = Bounds::EMPTY;
        for floor in document.floors.iter().filter(|floor| !floor.spaces.is_empty()) {
            preview.plans += 1;
            preview.rooms += floor.spaces.len();
            bounds = bounds.union(Bounds::of(floor.spaces.iter().flat_map(|space| space.boundary.iter().copied())));
            for space in &floor.spaces {
                *preview.layers.entry("space".to_owned()).or_default() += 1;
                // Each opening is stated in both its rooms.
                *preview.layers.entry("portal".to_owned()).or_default() += space.portals.len();
            }
            let places: BTreeSet<_> = floor.spaces.iter().flat_map(|space| &space.portals).map(Portal::key).collect();
            preview.openings += places.len();
        }
        let metres_per_pixel = options.number(&METRES_PER_PIXEL).unwrap_or(scale::find(&document).metres_per_pixel);
        preview.size =
            (!bounds.is_empty()).then(|| (bounds.width() * metres_per_pixel, bounds.height() * metres_per_pixel));
        Ok(preview)
    }

    fn read(&self, source: &Source<'_>, options: &Options) -> Result<Import, ReadError> {
        read(source.bytes()?, source.stem(), options.number(&METRES_PER_PIXEL))
    }
}

/// Reads a file's bytes; `stem` is the file's name without its ending.
///
/// # Errors
/// When nothing usable can be read.
pub fn from_bytes(bytes: &[u8], stem: &str) -> Result<Import, ReadError> {
    read(bytes, stem, None)
}

fn read(bytes: &[u8], stem: &str, metres_per_pixel: Option<f64>) -> Result<Import, ReadError> {
    let text = text::decode(bytes)?;
    let document = document::parse(text)?;
    import(text, &document, stem, metres_per_pixel)
}

fn import(text: &str, document: &Document, stem: &str, metres_per_pixel: Option<f64>) -> Result<Import, ReadError> {
    let mut notes = Notes::new(text);
    if document.floors.iter().all(|floor| floor.spaces.is_empty()) {
        return Err(ReadError {
            place: Place::default(),
            what: "holds no room".to_owned(),
            hint: "check that this is the whole file: rooms are <space> elements in <floor><spaces>".to_owned(),
        });
    }
    let found = metres_per_pixel.map_or_else(|| scale::find(document), scale::told);
    for (at, what) in &found.healings {
        notes.push(NoteKind::Healed, *at, "scale", what.as_str());
    }
    notes.unknown(&document.unknown);
    let mut meta = meta_of(document, stem, &mut notes);
    meta.scale = found.scale;
    let mut plans = Vec::new();
    for (index, floor) in document.floors.iter().enumerate().filter(|(_, floor)| !floor.spaces.is_empty()) {
        let mut meta = meta.clone();
        if document.floors.len() > 1 {
            meta.storey = (index + 1).to_string();
        }
        let storey = Storey { floor, metres_per_pixel: found.metres_per_pixel, notes: &mut notes };
        plans.push(storey.plan(meta)?);
    }
    Ok(Import { plans, notes: notes.finish() })
}

/// The metadata of the building.
fn meta_of(document: &Document, stem: &str, notes: &mut Notes<'_>) -> Meta {
    // A picture's path on another machine, Windows or Unix.
    let name = document.name.rsplit(['/', '\\']).find(|part| !part.trim().is_empty()).unwrap_or_default().trim();
    let by_name = building_name::split(name);
    let by_stem = building_name::split(stem);
    // The file's name tells storeys apart if the drawing's name does not ('plans' for both plans1 and
    // plans2); the drawing's name is spelt more nicely.
    let is_same = building_name::key(&by_name.building) == building_name::key(&by_stem.building);
    let (building, storey) = match () {
        () if by_stem.building.is_empty() && by_stem.storey.is_empty() => (by_name.building, by_name.storey),
        () if by_stem.building.is_empty() => (by_name.building, by_stem.storey),
        () if is_same && by_stem.storey.is_empty() => (by_name.building, by_name.storey),
        () if is_same => (by_name.building, by_stem.storey),
        () => (by_stem.building, by_stem.storey),
    };
    let mut extra = Map::new();
    keep(&mut extra, "authors_id", &document.id);
    let rooms: BTreeSet<&str> =
        document.floors.iter().flat_map(|floor| &floor.spaces).map(|space| space.id.as_str()).collect();
    let groups = document.floors.iter().flat_map(|floor| &floor.groups);
    let groups: Vec<Value> = groups.map(|group| group_value(group, &rooms, notes)).collect();
    if !groups.is_empty() {
        extra.insert("authors_groups".to_owned(), Value::Array(groups));
    }
    Meta {
        name: if name.is_empty() { stem.to_owned() } else { name.to_owned() },
        building,
        storey,
        typology: Typology::new(&document.typology),
        source: if document.info == INFO_PLACEHOLDER { String::new() } else { document.info.clone() },
        extra: extra_of(extra),
        ..Meta::default()
    }
}

/// A group with the ids of its rooms in the file, which are their [`Room::source_id`].
fn group_value(group: &document::Group, rooms: &BTreeSet<&str>, notes: &mut Notes<'_>) -> Value {
    let mut members = Vec::new();
    for space in &group.spaces {
        if rooms.contains(space.as_str()) {
            members.push(Value::String(space.clone()));
        } else {
            let what = format!("its member '{space}' is no room of the file; left out");
            notes.push(NoteKind::Skipped, Some(group.at), format!("group {}", group.id), what);
        }
    }
    let mut value = Map::new();
    keep(&mut value, "id", &group.id);
    keep(&mut value, "name", &group.name);
    keep(&mut value, "type", &group.kind);
    value.insert("rooms".to_owned(), Value::Array(members));
    Value::Object(value)
}

fn keep(map: &mut Map<String, Value>, key: &str, text: &str) {
    if !text.is_empty() {
        map.insert(key.to_owned(), Value::String(text.to_owned()));
    }
}

fn extra_of(map: Map<String, Value>) -> Extra {
    (!map.is_empty()).then(|| std::sync::Arc::new(map))
}

/// One floor being turned into a plan.
struct Storey<'a, 'n> {
    floor: &'a Floor,
    metres_per_pixel: f64,
    notes: &'n mut Notes<'a>,
}

/// An opening, assembled from the portals of both its rooms.
struct Joined<'a> {
    /// Index of the room that states it first, and of its portal there.
    by: usize,
    portal: &'a Portal,
    /// The indices of the rooms it joins; `None` is the outside.
    sides: [Option<usize>; 2],
    /// The portals that state it, one for each of its rooms unless the file is asymmetric.
    stated: Vec<(usize, &'a Portal)>,
}

impl<'a> Storey<'a, '_> {
    fn plan(mut self, meta: Meta) -> Result<Plan, ReadError> {
        let by_id = self.rooms_by_id()?;
        let joined = self.joined(&by_id);
        self.refuse_endless_work(&joined)?;
        let portal_factor = self.portal_factor();
        let points: Vec<Option<Point>> = self.opening_points(&joined, portal_factor);

        let mut builder = Builder::new(meta);
        let mut portal_points: Vec<Vec<Point>> = vec![Vec::new(); self.floor.spaces.len()];
        for (index, space) in self.floor.spaces.iter().enumerate() {
            portal_points[index]
                .extend(space.segments.iter().filter_map(|segment| scaled(segment.point?, portal_factor)));
        }
        for (opening, &point) in joined.iter().zip(&points) {
            for room in opening.sides.into_iter().flatten() {
                portal_points[room].extend(point);
            }
        }
        let mut rooms: Vec<RoomId> = Vec::new();
        let mut rings: Vec<(Vec<CornerId>, Vec<Point>)> = Vec::new();
        for (space, portals) in self.floor.spaces.iter().zip(&portal_points) {
            let boundary = self.boundary(space, portals)?;
            let outer = builder.ring(boundary);
            let mut extra = Map::new();
            keep(&mut extra, "authors_type", &space.kind);
            let function = space.function.clone();
            let room = Room { outer: outer.clone(), function, extra: extra_of(extra), ..Room::default() };
            rooms.push(builder.room(&space.id, room));
            rings.push((outer.to_vec(), builder.plan().ring_points(&outer)));
        }
        for (opening, &point) in joined.iter().zip(&points) {
            self.add_opening(&mut builder, opening, point, &rooms, &rings);
        }
        self.report_dangling();
        builder.finish().map_err(|violations| ReadError {
            place: Place::default(),
            what: violations.first().map(ToString::to_string).unwrap_or_default(),
            hint: "please report this: the reader should have mended it".to_owned(),
        })
    }

    /// The rooms' indices by their ids.
    fn rooms_by_id(&mut self) -> Result<BTreeMap<&'a str, usize>, ReadError> {
        let mut by_id = BTreeMap::new();
        for (index, space) in self.floor.spaces.iter().enumerate() {
            if let Some(first) = by_id.insert(space.id.as_str(), index) {
                let first = self.notes.line(self.floor.spaces[first].at);
                return Err(ReadError {
                    place: Place { line: Some(self.notes.line(space.at)), element: space_name(space) },
                    what: format!("two rooms have this id; the first is on line {first}"),
                    hint: "give one of them another id, there and in the portals that mean it".to_owned(),
                });
            }
        }
        Ok(by_id)
    }

    /// Rejects a file whose openings would take minutes to place.
    fn refuse_endless_work(&mut self, joined: &[Joined<'a>]) -> Result<(), ReadError> {
        let mut edges = 0;
        for opening in joined {
            let rooms = opening.sides.into_iter().flatten();
            edges += rooms.map(|room| self.floor.spaces[room].boundary.len()).sum::<usize>();
            if edges > EDGE_LIMIT {
                return Err(ReadError {
                    place: Place { line: Some(self.notes.line(opening.portal.at)), element: String::new() },
                    what: "has too many portals in rooms with too many corners".to_owned(),
                    hint: "simplify the boundaries, or split it into storeys".to_owned(),
                });
            }
        }
        Ok(())
    }

    /// The factor from portals' coordinates to those of the rooms.
    ///
    /// One version of the program wrote boundaries at half the resolution of the line segments. The scale
    /// refers to the boundaries; the portals' factor is found by testing which one brings them to the
    /// boundaries.
    fn portal_factor(&mut self) -> f64 {
        // Allows for walls that extend slightly beyond the rooms.
        const HALVED: std::ops::RangeInclusive<f64> = 1.8..=2.2;
        let rooms = Bounds::of(self.floor.spaces.iter().flat_map(|space| space.boundary.iter().copied()));
        let Some(walls) = self.floor.walls else { return 1.0 };
        let size = |bounds: Bounds| bounds.width().max(bounds.height());
        if !HALVED.contains(&(size(walls) / size(rooms))) {
            return 1.0;
        }
        let what = "the boundaries are at half the resolution of the line segments; the scale is taken as that of the boundaries";
        self.notes.push(NoteKind::Healed, None, "", what);
        let misfit = |factor: f64| -> f64 {
            let spaces = self.floor.spaces.iter().filter(|space| space.boundary.len() >= 3);
            let distances = spaces.flat_map(|space| {
                let ring = Ring { corners: &[], points: &space.boundary };
                let points = space.segments.iter().filter_map(|segment| scaled(segment.point?, factor));
                points.map(move |point| ring.distance(point))
            });
            // Enough to tell.
            distances.take(100).sum()
        };
        if misfit(0.5) < misfit(1.0) { 0.5 } else { 1.0 }
    }

    /// Combines portals of two rooms into openings, in file order.
    fn joined(&mut self, by_id: &BTreeMap<&'a str, usize>) -> Vec<Joined<'a>> {
        let mut joined: Vec<Joined<'a>> = Vec::new();
        // Keyed by line segment, sides and, where there is no line segment, a running number within the
        // room.
        let mut index_of: BTreeMap<(&str, [Option<usize>; 2], usize), usize> = BTreeMap::new();
        for (by, space) in self.floor.spaces.iter().enumerate() {
            let mut nameless: BTreeMap<[Option<usize>; 2], usize> = BTreeMap::new();
            for portal in &space.portals {
                let sides = self.sides(by, portal, by_id);
                let mut sorted = sides;
                sorted.sort_unstable();
                let nth = if portal.segment.is_empty() {
                    let count = nameless.entry(sorted).or_default();
                    *count += 1;
                    *count
                } else {
                    0
                };
                let index = *index_of.entry((&portal.segment, sorted, nth)).or_insert_with(|| {
                    joined.push(Joined { by, portal, sides, stated: Vec::new() });
                    joined.len() - 1
                });
                if joined[index].stated.iter().any(|&(room, _)| room == by) {
                    self.note_portal(NoteKind::Skipped, space, portal, "stands twice in this room; taken once");
                } else {
                    joined[index].stated.push((by, portal));
                }
            }
        }
        self.match_one_sided(joined)
    }

    /// Combines openings that both rooms state, but with different line segments; reports those that only
    /// one room states.
    fn match_one_sided(&mut self, joined: Vec<Joined<'a>>) -> Vec<Joined<'a>> {
        // Keyed by the sides and the room that states them.
        let mut waiting: BTreeMap<([Option<usize>; 2], usize), VecDeque<usize>> = BTreeMap::new();
        let mut kept: Vec<Joined<'a>> = Vec::new();
        for opening in joined {
            let mut sorted = opening.sides;
            sorted.sort_unstable();
            if let [Some(first), Some(second)] = sorted
                && opening.stated.len() == 1
                && first != second
            {
                let other = if opening.by == first { second } else { first };
                if let Some(other) = waiting.get_mut(&(sorted, other)).and_then(VecDeque::pop_front) {
                    kept[other].stated.extend(opening.stated);
                    continue;
                }
                waiting.entry((sorted, opening.by)).or_default().push_back(kept.len());
            }
            kept.push(opening);
        }
        for index in waiting.into_values().flatten() {
            let opening = &kept[index];
            let what = "only one of its two rooms states it; kept as joining both";
            self.note_portal(NoteKind::Healed, &self.floor.spaces[opening.by], opening.portal, what);
        }
        kept
    }

    /// The two sides that a portal states.
    fn sides(&mut self, by: usize, portal: &'a Portal, by_id: &BTreeMap<&'a str, usize>) -> [Option<usize>; 2] {
        let space = &self.floor.spaces[by];
        let mut side = |id: &str| -> Option<usize> {
            let found = by_id.get(id).copied();
            if found.is_none() {
                let what = format!("leads to '{id}', which is no room of the file; taken as leading outside");
                self.note_portal(NoteKind::Healed, space, portal, &what);
            }
            found
        };
        match portal.targets.as_slice() {
            [] => {
                self.note_portal(
                    NoteKind::Healed,
                    space,
                    portal,
                    "names no room that it leads to; taken as leading outside",
                );
                [Some(by), None]
            }
            [only] if *only == space.id => {
                self.note_portal(NoteKind::Healed, space, portal, "names its own room only; taken as leading outside");
                [Some(by), None]
            }
            [only] => [Some(by), side(only)],
            [first, second, rest @ ..] => {
                let sides = [side(first), side(second)];
                if !rest.is_empty() {
                    self.note_portal(
                        NoteKind::Skipped,
                        space,
                        portal,
                        "names more than two rooms; the first two are taken",
                    );
                }
                if sides == [None, None] {
                    return [Some(by), None];
                }
                if !sides.contains(&Some(by)) {
                    self.note_portal(
                        NoteKind::Healed,
                        space,
                        portal,
                        "stands in a room that it does not join; kept as joining those it names",
                    );
                }
                sides
            }
        }
    }

    fn note_portal(&mut self, kind: NoteKind, space: &Space, portal: &Portal, what: &str) {
        let element = if portal.segment.is_empty() {
            format!("portal in {}", space_name(space))
        } else {
            format!("portal {}", portal.segment)
        };
        self.notes.push(kind, Some(portal.at), element, what);
    }

    /// The positions of the openings, in pixels of the boundaries; `None` if there is no line segment.
    ///
    /// The points given by the two rooms differ by the wall's thickness or, in another version of the
    /// program, by a door's width along the wall: the midpoint is right for both.
    fn opening_points(&mut self, joined: &[Joined<'a>], portal_factor: f64) -> Vec<Option<Point>> {
        let mut in_room: BTreeMap<(usize, &str), Point> = BTreeMap::new();
        let mut anywhere: BTreeMap<&str, Point> = BTreeMap::new();
        for (index, space) in self.floor.spaces.iter().enumerate() {
            for segment in &space.segments {
                let Some(point) = segment.point.and_then(|point| scaled(point, portal_factor)) else { continue };
                in_room.entry((index, &segment.id)).or_insert(point);
                anywhere.entry(&segment.id).or_insert(point);
            }
        }
        let most_px = 2.0 * DEFAULT_DOOR_WIDTH_M / self.metres_per_pixel;
        let mut points = Vec::with_capacity(joined.len());
        for opening in joined {
            let stated: Vec<Point> = opening
                .stated
                .iter()
                .filter_map(|&(room, portal)| in_room.get(&(room, portal.segment.as_str())).copied())
                .collect();
            points.push(match stated.as_slice() {
                [] => anywhere.get(opening.portal.segment.as_str()).copied(),
                [point] => Some(*point),
                [first, second, ..] if first.distance(*second) <= most_px => Some(first.midpoint(*second)),
                [first, second, ..] => {
                    let apart_m = first.distance(*second) * self.metres_per_pixel;
                    let what = format!("its two rooms have it {apart_m:.1} m apart; put where it is nearer to both");
                    self.note_portal(NoteKind::Healed, &self.floor.spaces[opening.by], opening.portal, &what);
                    let misfit = |point: Point| -> f64 {
                        let rooms = opening.sides.into_iter().flatten();
                        let rings = rooms.map(|room| Ring { corners: &[], points: &self.floor.spaces[room].boundary });
                        rings.filter(|ring| ring.points.len() > 1).map(|ring| ring.distance(point)).sum()
                    };
                    Some(if misfit(*first) <= misfit(*second) { *first } else { *second })
                }
            });
        }
        points
    }

    /// From pixels, y down, to metres, y up; the origin is the picture's upper left corner.
    fn metres(&self, point: Point) -> Point {
        Point::new(point.x * self.metres_per_pixel, -point.y * self.metres_per_pixel).trimmed()
    }

    /// A room's boundary in metres; empty if it has fewer than three corners.
    ///
    /// A corner exactly between its neighbours and at a portal exists only for the portal: in the
    /// authors' program a door could only be at a corner. It is dropped, so that the opening lies within
    /// one edge.
    fn boundary(&mut self, space: &Space, portals: &[Point]) -> Result<Vec<Point>, ReadError> {
        let mut ring: Vec<Point> = Vec::with_capacity(space.boundary.len());
        for &point in &space.boundary {
            if ring.last() != Some(&point) {
                ring.push(point);
            }
        }
        let is_closed = ring.len() > 1 && ring.first() == ring.last();
        if is_closed {
            ring.pop();
        }
        let n = ring.len();
        let mut kept: Vec<Point> = Vec::with_capacity(n);
        for (index, &here) in ring.iter().enumerate() {
            let before = kept.last().copied().unwrap_or(ring[n - 1]);
            let after = if index + 1 < n { ring[index + 1] } else { kept.first().copied().unwrap_or(here) };
            let (to, on) = (here - before, after - here);
            let is_between = to.cross(on) == 0.0 && to.dot(on) > 0.0;
            let is_spare = kept.len() + n - index > 3;
            if !(is_between && is_spare && portals.iter().any(|portal| portal.distance(here) <= PORTAL_CORNER_PX)) {
                kept.push(here);
            }
        }
        let mut metres: Vec<Point> = Vec::with_capacity(kept.len());
        for &pixel in &kept {
            let point = self.metres(pixel);
            if !(point.x.abs() <= COORDINATE_LIMIT_M && point.y.abs() <= COORDINATE_LIMIT_M) {
                return Err(ReadError {
                    place: Place { line: Some(self.notes.line(space.at)), element: space_name(space) },
                    what: format!("its corner ({}, {}) lies more than {COORDINATE_LIMIT_M} m away", pixel.x, pixel.y),
                    hint: DAMAGED_HINT.to_owned(),
                });
            }
            if metres.last() != Some(&point) {
                metres.push(point);
            }
        }
        while metres.len() > 1 && metres.first() == metres.last() {
            metres.pop();
        }
        if metres.len() < 3 {
            let what = match metres.len() {
                0 => "the room has no boundary; kept without one".to_owned(),
                1 => "its boundary has 1 corner, and 3 are needed; the room is kept without one".to_owned(),
                n => format!("its boundary has {n} corners, and 3 are needed; the room is kept without one"),
            };
            self.notes.push(NoteKind::Skipped, Some(space.at), space_name(space), what);
            metres.clear();
        } else if !is_closed {
            let what = "its boundary does not return to its first corner; closed";
            self.notes.push(NoteKind::Healed, Some(space.at), space_name(space), what);
        }
        Ok(metres)
    }

    fn add_opening(
        &mut self,
        builder: &mut Builder,
        opening: &Joined<'a>,
        point_px: Option<Point>,
        rooms: &[RoomId],
        rings: &[(Vec<CornerId>, Vec<Point>)],
    ) {
        let space = &self.floor.spaces[opening.by];
        let mut indices: Vec<usize> = opening.sides.into_iter().flatten().collect();
        indices.dedup();
        let own: Vec<Ring<'_>> = indices
            .iter()
            .map(|&room| Ring { corners: &rings[room].0, points: &rings[room].1 })
            .filter(|ring| !ring.points.is_empty())
            .collect();
        let point = match point_px {
            Some(point) => Some(self.metres(point)),
            None => point_openings::likely_point(&own),
        };
        let Some(point) = point.filter(|point| point.x.abs().max(point.y.abs()) < COORDINATE_LIMIT_M) else {
            let what =
                "nothing tells where it is: its line segment is missing, and its rooms have no boundary; left out";
            self.note_portal(NoteKind::Skipped, space, opening.portal, what);
            return;
        };
        if point_px.is_none() {
            let what = "its line segment is missing; put where its rooms are next to each other";
            self.note_portal(NoteKind::Healed, space, opening.portal, what);
        }
        let place = match point_openings::place(&own, point) {
            Some(placed) => {
                if placed.off_m > THICKEST_WALL_M {
                    let what = format!("lies {:.1} m from the walls of its rooms; put on the nearest", placed.off_m);
                    self.note_portal(NoteKind::Healed, space, opening.portal, &what);
                }
                placed.place
            }
            None => {
                let what = "its rooms have no boundary; kept as a segment of its own";
                self.note_portal(NoteKind::Healed, space, opening.portal, what);
                let half = Vector::new(DEFAULT_DOOR_WIDTH_M / 2.0, 0.0);
                let segment = Segment::new(point - half, point + half);
                OpeningPlace::Free { from: segment.a, to: segment.b }
            }
        };
        let mut extra = Map::new();
        for (key, value, usual) in [
            ("authors_class", &opening.portal.class, "HORIZONTAL"),
            ("authors_direction", &opening.portal.direction, "BOTH"),
        ] {
            if value != usual {
                keep(&mut extra, key, value);
            }
        }
        let joint = |side: Option<usize>| side.map_or(Joint::Outside, |room| Joint::Room(rooms[room]));
        let kind = self.kind(opening);
        let mut element = Opening::new(kind, place);
        element.pinned = Some(opening.sides.map(joint));
        element.extra = extra_of(extra);
        builder.opening(&opening.portal.segment, element);
    }

    /// The kind of an opening. A door beats a passage and two leaves beat one: the program's default is a
    /// single door, so anything else was chosen.
    fn kind(&mut self, opening: &Joined<'a>) -> OpeningKind {
        let kinds: Vec<OpeningKind> = opening
            .stated
            .iter()
            .map(|(_, portal)| match (portal.kind.as_str(), portal.features.as_str()) {
                ("IMPLICIT", _) => OpeningKind::Passage,
                ("EXPLICIT_DOUBLE", _) | (_, "DOUBLE") => OpeningKind::DoubleDoor,
                _ => OpeningKind::Door,
            })
            .collect();
        let best = [OpeningKind::DoubleDoor, OpeningKind::Door].into_iter().find(|kind| kinds.contains(kind));
        let kind = best.unwrap_or(OpeningKind::Passage);
        let space = &self.floor.spaces[opening.by];
        if let Some(other) = kinds.iter().find(|&&other| other != kind) {
            let what =
                format!("its two rooms disagree, {} or {}; taken as a {}", other.name(), kind.name(), kind.name());
            self.note_portal(NoteKind::Healed, space, opening.portal, &what);
        }
        let known = ["EXPLICIT", "IMPLICIT", "EXPLICIT_DOUBLE", ""];
        if !known.contains(&opening.portal.kind.as_str()) {
            let what = format!("its type '{}' is not known; taken as a {}", opening.portal.kind, kind.name());
            self.note_portal(NoteKind::Healed, space, opening.portal, &what);
        }
        kind
    }

    /// Reports portals that are drawn, but lead nowhere.
    fn report_dangling(&mut self) {
        let spaces = &self.floor.spaces;
        let used: BTreeSet<&str> =
            spaces.iter().flat_map(|space| &space.portals).map(|portal| portal.segment.as_str()).collect();
        for space in spaces {
            for segment in space.segments.iter().filter(|segment| !used.contains(segment.id.as_str())) {
                let what = "a door is drawn here, but nothing states what it joins; left out";
                self.notes.push(NoteKind::Skipped, Some(segment.at), format!("linesegment {}", segment.id), what);
            }
        }
    }
}

fn space_name(space: &Space) -> String {
    format!("space {}", space.id)
}

/// A point in the pixels of the boundaries.
fn scaled(point: Point, factor: f64) -> Option<Point> {
    let point = Point::new(point.x * factor, point.y * factor);
    point.is_finite().then_some(point)
}
