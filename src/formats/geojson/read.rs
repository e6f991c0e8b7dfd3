use std::collections::{BTreeSet, HashMap, HashSet};
use std::sync::Arc;

use rstar::primitives::{GeomWithData, Line};
use rstar::{AABB, RTree};
use serde_json::{Map, Value};

use super::KEPT;
use super::coordinates::{Coordinates, Position};
use super::disk::{DiskCollection, DiskFeature, DiskHost, DiskMeta, DiskProperties, Words};
use super::words::{FROM_SCHEME, opening_kind, opening_word};
use crate::formats::{
    Import, Note, NoteKind, Place, Preview, ReadError,
    json_text::{decode, id_on_line, json_fault},
    plan_json::DiskHinge,
};
use crate::geometry::{Bounds, COORDINATE_LIMIT_M, Point, Segment, polygon, trim_m};
use crate::labels::{Label, Typology};
use crate::plan::{
    Builder, CornerId, DEFAULT_DOOR_WIDTH_M, DEFAULT_WALL_THICKNESS_M, Extra, Joint, LabelOrigin, Meta, Opening,
    OpeningKind, Place as OpeningPlace, Room, RoomId, RoomLabel, Scale, ScaleOrigin, Swing, Wall,
};

/// How far from an edge the ends of an opening may lie to be hosted by it: what rounding to four
/// decimals and a slanted edge explain, and no more. Opening and edge then are the same line in the
/// source, so that moving one must move the other; anything further off keeps its own place.
const HOST_TOLERANCE_M: f64 = 1e-3;

/// Below this size of its largest feature, a file without units is in degrees: no plan is so small
/// in metres, and half a degree is 50 km.
const SMALLEST_PLAN_M: f64 = 0.5;

const DAMAGED: &str = "correct it by hand (docs/geojson.md describes the properties), or export it again";
const NOT_METRES: &str = "project it to metres first, and say \"units\": \"m\" at the top of the file";

/// Reads a FeatureCollection in metres. `in_metres`: also where it names no units, whatever its sizes.
pub(super) fn read(bytes: &[u8], stem: &str, in_metres: bool) -> Result<Import, ReadError> {
    let text = decode(bytes)?;
    let (collection, items) = items(text)?;
    let mut notes = Vec::new();
    let assumed = check_units(&collection, &items, in_metres)?;
    notes.extend(assumed);
    for item in &items {
        item.check_coordinates()?;
    }
    let mut reader = Reader { builder: Builder::new(meta_of(&collection.meta, stem)), notes, rooms: HashMap::new() };
    reader.add_all(items)?;
    let Reader { builder, notes, .. } = reader;
    let mut plan = builder.finish().map_err(|violations| ReadError {
        place: Place {
            line: None,
            element: violations.first().map(|violation| violation.element.to_string()).unwrap_or_default(),
        },
        what: violations.into_iter().next().map(|violation| violation.what).unwrap_or_default(),
        hint: DAMAGED.to_owned(),
    })?;
    plan.extra = kept(collection.meta.other);
    Ok(Import { plans: vec![plan], notes })
}

/// What is in a file, by its features.
pub(super) fn preview(bytes: &[u8]) -> Result<Preview, ReadError> {
    let (collection, items) = items(decode(bytes)?)?;
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
        bounds = bounds.union(item.bounds());
    }
    let count = |kind: &str| preview.layers.get(kind).copied().unwrap_or_default();
    (preview.rooms, preview.openings, preview.walls) = (count("room"), count("opening"), count("wall"));
    preview.size = (!bounds.is_empty()).then(|| (bounds.width(), bounds.height()));
    Ok(preview)
}

/// The file as its parts.
fn items(text: &str) -> Result<(DiskCollection<'_>, Vec<Item>), ReadError> {
    let collection: DiskCollection = serde_json::from_str(text).map_err(|error| refuse_json(text, &error))?;
    let refuse = |what: String, hint: &str| Err(ReadError { place: Place::default(), what, hint: hint.to_owned() });
    match collection.kind.as_ref().map_or("", Words::as_str) {
        "FeatureCollection" => {}
        "" => return refuse("is JSON, but not GeoJSON: it has no type".to_owned(), "open a FeatureCollection"),
        other => return refuse(format!("is GeoJSON of the type '{other}'"), "open a FeatureCollection"),
    }
    let Some(raw_features) = &collection.features else {
        return refuse("has no features".to_owned(), "open a FeatureCollection with rooms");
    };
    let mut items = Vec::with_capacity(raw_features.len());
    let (mut line, mut counted) = (1, 0);
    for (index, raw) in raw_features.iter().enumerate() {
        let start = raw.get().as_ptr() as usize - text.as_ptr() as usize;
        line += text.as_bytes()[counted..start].iter().filter(|&&byte| byte == b'\n').count();
        counted = start;
        let feature =
            serde_json::from_str(raw.get()).map_err(|error| refuse_feature(raw.get(), line, index, &error))?;
        items.push(Item { line, index, feature });
    }
    Ok((collection, items))
}

/// A feature and where it stands.
struct Item {
    /// From 1.
    line: usize,
    /// From 0.
    index: usize,
    feature: DiskFeature,
}

/// What a feature is in a plan.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Role {
    Room,
    Opening,
    Wall,
    Other,
}

impl Item {
    fn place(&self) -> Place {
        let id = self.feature.id.as_str();
        let element =
            if id.is_empty() { format!("feature number {}", self.index + 1) } else { format!("feature {id}") };
        Place { line: Some(self.line), element }
    }

    fn refuse<T>(&self, what: impl Into<String>, hint: &str) -> Result<T, ReadError> {
        Err(ReadError { place: self.place(), what: what.into(), hint: hint.to_owned() })
    }

    fn stated_kind(&self) -> &str {
        self.feature.properties.as_ref().map_or("", |properties| properties.kind.as_str())
    }

    /// What the feature says it is; without a word, what its geometry suggests.
    fn role(&self) -> Role {
        match self.stated_kind() {
            "room" => Role::Room,
            "opening" => Role::Opening,
            "wall" => Role::Wall,
            "" => match (self.geometry_kind(), &self.feature.properties) {
                (_, Some(properties)) if !properties.opening.is_empty() => Role::Opening,
                ("Polygon" | "MultiPolygon", _) => Role::Room,
                _ => Role::Other,
            },
            _ => Role::Other,
        }
    }

    fn geometry_kind(&self) -> &str {
        self.feature.geometry.as_ref().map_or("", |geometry| geometry.kind.as_str())
    }

    fn coordinates(&self) -> Option<&Coordinates> {
        self.feature.geometry.as_ref()?.coordinates.as_ref()
    }

    fn bounds(&self) -> Bounds {
        self.coordinates().map_or(Bounds::EMPTY, |coordinates| Bounds::of(coordinates.positions()))
    }

    fn check_coordinates(&self) -> Result<(), ReadError> {
        let beyond = |point: &Point| !(point.x.abs() <= COORDINATE_LIMIT_M && point.y.abs() <= COORDINATE_LIMIT_M);
        match self.coordinates().and_then(|coordinates| coordinates.positions().find(beyond)) {
            None => Ok(()),
            Some(point) => self.refuse(
                format!("the position ({:?}, {:?}) lies beyond ±{COORDINATE_LIMIT_M} m", point.x, point.y),
                "coordinates are in metres: move the drawing near to the origin, or correct it by hand",
            ),
        }
    }
}

/// Refuses what is not in metres. A note where metres are only assumed.
fn check_units(collection: &DiskCollection<'_>, items: &[Item], in_metres: bool) -> Result<Option<Note>, ReadError> {
    let refuse = |what: String| Err(ReadError { place: Place::default(), what, hint: NOT_METRES.to_owned() });
    match collection.units.as_ref().map_or("", Words::as_str).trim().to_lowercase().as_str() {
        "m" | "metre" | "metres" | "meter" | "meters" => return Ok(None),
        "" => {}
        other => return refuse(format!("is in '{other}', not in metres")),
    }
    // The member `crs` is older than RFC 7946; these names are longitude and latitude on WGS 84.
    let crs = collection.crs.as_ref().map(Value::to_string).unwrap_or_default();
    if ["CRS84", "EPSG::4326", "EPSG:4326"].iter().any(|name| crs.contains(name)) {
        return refuse("is in longitude and latitude".to_owned());
    }
    // RFC 7946 means longitude and latitude where nothing else is said. Our properties and a
    // plausible size say something else.
    let largest_m = items
        .iter()
        .map(Item::bounds)
        .fold(0.0, |largest: f64, bounds| largest.max(bounds.width()).max(bounds.height()));
    let ours = items.iter().any(|item| matches!(item.stated_kind(), "room" | "opening" | "wall"));
    let drawn = largest_m > 0.0;
    if drawn && !in_metres && (!ours || largest_m < SMALLEST_PLAN_M) {
        return refuse("names no units, so that it is in longitude and latitude".to_owned());
    }
    Ok(drawn.then(|| Note {
        kind: NoteKind::Healed,
        place: Place::default(),
        what: "names no units; taken as metres, as the sizes suggest".to_owned(),
    }))
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
    /// Rooms by their feature's id.
    rooms: HashMap<String, RoomId>,
}

impl Reader {
    fn note(&mut self, kind: NoteKind, place: Place, what: impl Into<String>) {
        self.notes.push(Note { kind, place, what: what.into() });
    }

    /// Adds rooms and walls first: openings refer to both, and may come before them.
    fn add_all(&mut self, items: Vec<Item>) -> Result<(), ReadError> {
        let mut openings = Vec::new();
        let mut seen: HashSet<(u8, String)> = HashSet::new();
        for item in items {
            let role = item.role();
            let id = &item.feature.id;
            if role != Role::Other && !id.is_empty() && !seen.insert((role as u8, id.0.clone())) {
                return item.refuse("its id is in the file twice", "give one of the two another id");
            }
            match role {
                Role::Room => self.add_room(item)?,
                Role::Wall => self.add_wall(item),
                Role::Opening => openings.push(item),
                Role::Other => {
                    let what = match item.stated_kind() {
                        "" => format!("says not what it is (geometry {:?})", item.geometry_kind()),
                        kind => format!("kind '{kind}' is not part of a plan"),
                    };
                    self.note(NoteKind::Skipped, item.place(), what);
                }
            }
        }
        if !openings.is_empty() {
            let edges = Edges::new(&self.builder);
            for item in openings {
                self.add_opening(item, &edges);
            }
        }
        // Openings came last above; notes follow the file.
        self.notes.sort_by_key(|note| note.place.line);
        Ok(())
    }

    fn add_room(&mut self, mut item: Item) -> Result<(), ReadError> {
        let place = item.place();
        let geometry = item.feature.geometry.take();
        let kind = geometry.as_ref().map(|geometry| geometry.kind.0.clone()).unwrap_or_default();
        let coordinates = geometry.and_then(|geometry| geometry.coordinates).unwrap_or(Coordinates::Empty);
        let polygons = match (kind.as_str(), coordinates) {
            (_, Coordinates::Empty) => Vec::new(),
            ("Polygon", Coordinates::Rings(rings)) => vec![rings],
            ("MultiPolygon", Coordinates::Polygons(polygons)) => polygons,
            ("Polygon" | "MultiPolygon", _) => {
                return item.refuse(format!("its coordinates are not those of a {kind}"), DAMAGED);
            }
            _ => Vec::new(),
        };
        let mut parts: Vec<Room> = Vec::new();
        for rings in polygons {
            let mut rings = rings.into_iter();
            let outer = rings.next().unwrap_or_default();
            let Some(outer) = self.ring(&outer, "boundary", &place) else { continue };
            let holes = rings.filter_map(|hole| self.ring(&hole, "hole", &place)).collect();
            parts.push(Room { outer, holes, ..Room::default() });
        }
        let room = self.room_of(item.feature.properties.take().unwrap_or_default(), &place);
        if parts.is_empty() {
            self.note(NoteKind::Healed, place, "has no boundary; kept without one");
            parts.push(Room::default());
        } else if parts.len() > 1 {
            let what = format!("has {} parts; each becomes a room, openings lead to the largest", parts.len());
            self.note(NoteKind::Healed, place, what);
            let area = |part: &Room| polygon::signed_area(&self.builder.plan().ring_points(&part.outer)).abs();
            parts.sort_by(|p, q| area(q).total_cmp(&area(p)));
        }
        let id = item.feature.id.as_str();
        for (number, part) in (1..).zip(parts) {
            // Without an id, the boundary makes the identity.
            let key = if number == 1 || id.is_empty() { id.to_owned() } else { format!("{id} part {number}") };
            let room = self.builder.room(&key, Room { outer: part.outer, holes: part.holes, ..room.clone() });
            if number == 1 && !id.is_empty() {
                self.rooms.insert(key, room);
            }
        }
        Ok(())
    }

    /// A room with everything but its boundary.
    fn room_of(&mut self, properties: DiskProperties, place: &Place) -> Room {
        // A label that follows from the function is there for other readers.
        let own_label = !properties.label.is_empty() && properties.label_origin.0 != FROM_SCHEME;
        let label = own_label.then(|| properties.label.0.parse::<Label>());
        if let Some(Err(unknown)) = &label {
            self.note(NoteKind::Skipped, place.clone(), format!("{unknown}; left unlabelled"));
        }
        let origin = LabelOrigin::ALL.into_iter().find(|origin| origin.name() == properties.label_origin.0);
        Room {
            function: properties.function.0,
            label: label
                .and_then(Result::ok)
                .map(|label| RoomLabel { label, origin: origin.unwrap_or(LabelOrigin::Imported) }),
            name: properties.name.0,
            note: properties.note.0,
            source_id: properties.source_id.0,
            extra: kept(properties.other),
            ..Room::default()
        }
    }

    /// A ring's corners; `None` with a note when it has fewer than three.
    fn ring(&mut self, positions: &[Position], what: &str, place: &Place) -> Option<Arc<[CornerId]>> {
        let mut points: Vec<Point> = positions.iter().map(|position| position.0.trimmed()).collect();
        points.dedup();
        let closed = points.len() > 1 && points.first() == points.last();
        if closed {
            points.pop();
        }
        if points.len() < 3 {
            let what = format!("its {what} has {} corners, at least 3 are needed; left out", points.len());
            self.note(NoteKind::Skipped, place.clone(), what);
            return None;
        }
        if !closed {
            self.note(NoteKind::Healed, place.clone(), format!("its {what} is not closed; closed"));
        }
        Some(self.builder.ring(points))
    }

    fn add_wall(&mut self, item: Item) {
        let place = item.place();
        let Some(Coordinates::Line(line)) = item.coordinates() else {
            self.note(NoteKind::Skipped, place, "a wall is a LineString");
            return;
        };
        let mut points: Vec<Point> = line.iter().map(|position| position.0.trimmed()).collect();
        points.dedup();
        if points.len() < 2 {
            self.note(NoteKind::Skipped, place, "the wall has no length");
            return;
        }
        let properties = item.feature.properties.unwrap_or_default();
        let stated_m = properties.thickness_m.map(|number| number.0);
        let thickness_m = stated_m.filter(|thickness_m| (0.0..=10.0).contains(thickness_m));
        if thickness_m.is_none() {
            let found = stated_m.map_or("no thickness".to_owned(), |stated_m| format!("the thickness {stated_m} m"));
            self.note(NoteKind::Healed, place, format!("the wall has {found}; taken as {DEFAULT_WALL_THICKNESS_M} m"));
        }
        let extra = kept(properties.other);
        let corners: Vec<CornerId> = points.iter().map(|&point| self.builder.corner(point)).collect();
        for pair in corners.windows(2) {
            let wall = Wall {
                from: pair[0],
                to: pair[1],
                thickness_m: thickness_m.unwrap_or(DEFAULT_WALL_THICKNESS_M),
                extra: extra.clone(),
            };
            self.builder.wall_as(item.feature.id.0.parse().ok(), wall);
        }
    }

    fn add_opening(&mut self, item: Item, edges: &Edges) {
        let place = item.place();
        let (a, b) = match item.coordinates() {
            Some(Coordinates::Line(line)) => match (line.first(), line.last()) {
                (Some(a), Some(b)) => (a.0.trimmed(), b.0.trimmed()),
                _ => return,
            },
            Some(Coordinates::Position(point)) => (point.0.trimmed(), point.0.trimmed()),
            _ => {
                self.note(NoteKind::Skipped, place, "an opening is a LineString or a Point");
                return;
            }
        };
        let (a, b) = if a == b {
            self.note(NoteKind::Healed, place.clone(), format!("has no width; taken as {DEFAULT_DOOR_WIDTH_M} m"));
            edges.widened(a)
        } else {
            (a, b)
        };
        let mut properties = item.feature.properties.unwrap_or_default();
        let kind = match opening_kind(properties.opening.as_str()) {
            Some(kind) => kind,
            None => {
                let what = match properties.opening.as_str() {
                    "" => "says not what it is; taken as a door".to_owned(),
                    other => format!("'{other}' is no known opening; taken as a door"),
                };
                self.note(NoteKind::Healed, place.clone(), what);
                OpeningKind::Door
            }
        };
        // The source's own word ('sliding_door') is kept where ours says less.
        if !properties.opening.is_empty() && properties.opening.0 != opening_word(kind) {
            properties.other.insert("opening".to_owned(), Value::String(properties.opening.0));
        }
        let pinned = match properties.rooms {
            Some(rooms) if properties.pinned != Some(false) => self.joints(&rooms, &place),
            _ => None,
        };
        let hosted = match properties.host {
            _ if properties.free == Some(true) => None,
            Some(host) => self.stated_host(&host, a, b).or_else(|| edges.host(a, b)),
            None => edges.host(a, b),
        };
        let opening = Opening {
            kind,
            place: hosted.unwrap_or(OpeningPlace::Free { from: a, to: b }),
            swing: properties
                .hinge
                .zip(properties.opens)
                .map(|(hinge, side)| Swing { hinge_at_start: hinge == DiskHinge::Start, side: side.into() }),
            pinned,
            source_id: properties.source_id.0,
            extra: kept(properties.other),
        };
        self.builder.opening(item.feature.id.as_str(), opening);
    }

    /// The sides that a file states; `None` with a note when they cannot be resolved.
    fn joints(&mut self, rooms: &[Option<Words>], place: &Place) -> Option<[Joint; 2]> {
        let [first, second] = rooms else {
            let what = format!("joins {} rooms, not 2; they follow from its place instead", rooms.len());
            self.note(NoteKind::Healed, place.clone(), what);
            return None;
        };
        let mut joint = |room: &Option<Words>| match room {
            None => Some(Joint::Outside),
            Some(key) => match self.rooms.get(key.as_str()) {
                Some(&id) => Some(Joint::Room(id)),
                None => {
                    let what = format!(
                        "joins the room '{}', which is not in the file; the rooms follow from its place instead",
                        key.as_str()
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
        let within = |point: Point| point.x.abs() <= COORDINATE_LIMIT_M && point.y.abs() <= COORDINATE_LIMIT_M;
        let (at_m, width_m) = (trim_m(host.at_m.0), trim_m(host.width_m.0));
        let direction = edge.vector().unit()?;
        let middle = edge.a + direction * at_m;
        let half = direction * (width_m / 2.0);
        let agrees = within(edge.a)
            && within(edge.b)
            && (0.0..=edge.length()).contains(&at_m)
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

/// The edges of walls and rooms, found by place.
struct Edges {
    tree: RTree<Edge>,
}

/// An edge with its corners.
type Edge = GeomWithData<Line<[f64; 2]>, (CornerId, CornerId)>;

impl Edges {
    fn new(builder: &Builder) -> Self {
        let plan = builder.plan();
        let ordered = |a: CornerId, b: CornerId| if a < b { (a, b) } else { (b, a) };
        let mut edges: BTreeSet<(CornerId, CornerId)> = BTreeSet::new();
        for (_, wall) in plan.walls() {
            edges.insert(ordered(wall.from, wall.to));
        }
        for ring in plan.rooms().flat_map(|(_, room)| room.rings()) {
            edges.extend((0..ring.len()).map(|i| ordered(ring[i], ring[(i + 1) % ring.len()])));
        }
        let lines = edges.into_iter().filter_map(|(from, to)| {
            let (a, b) = (plan.position(from)?, plan.position(to)?);
            Some(GeomWithData::new(Line::new([a.x, a.y], [b.x, b.y]), (from, to)))
        });
        Self { tree: RTree::bulk_load(lines.collect()) }
    }

    fn segment(line: &Line<[f64; 2]>) -> Segment {
        Segment::new(Point::new(line.from[0], line.from[1]), Point::new(line.to[0], line.to[1]))
    }

    /// The place on the edge that the segment from `a` to `b` lies on; the nearest if there are
    /// several.
    fn host(&self, a: Point, b: Point) -> Option<OpeningPlace> {
        // More edges in one place than this are no plan, and which of them hosts does not matter.
        const CANDIDATES: usize = 64;
        let middle = a.midpoint(b);
        let around = Bounds::of([middle]).inflated(HOST_TOLERANCE_M);
        let envelope = AABB::from_corners([around.min.x, around.min.y], [around.max.x, around.max.y]);
        let (_, edge, (from, to)) = self
            .tree
            .locate_in_envelope_intersecting(envelope)
            .take(CANDIDATES)
            .map(|line| {
                let edge = Self::segment(line.geom());
                (edge.distance(a).max(edge.distance(b)), edge, line.data)
            })
            .filter(|&(off_m, ..)| off_m <= HOST_TOLERANCE_M)
            .min_by(|(p, _, p_ends), (q, _, q_ends)| p.total_cmp(q).then(p_ends.cmp(q_ends)))?;
        let (edge, from, to) =
            if edge.vector().dot(b - a) < 0.0 { (Segment::new(edge.b, edge.a), to, from) } else { (edge, from, to) };
        let width_m = trim_m(a.distance(b));
        let at_m = trim_m(edge.nearest_fraction(middle) * edge.length());
        (width_m > 0.0).then_some(OpeningPlace::Hosted { from, to, at_m, width_m })
    }

    /// An opening of the usual width about a point, along the edge nearest to it.
    fn widened(&self, point: Point) -> (Point, Point) {
        let nearest = self.tree.nearest_neighbor([point.x, point.y]);
        let along = nearest.and_then(|line| Self::segment(line.geom()).vector().unit());
        let half = along.unwrap_or(crate::geometry::Vector::new(1.0, 0.0)) * (DEFAULT_DOOR_WIDTH_M / 2.0);
        ((point - half).trimmed(), (point + half).trimmed())
    }
}

/// An error of the JSON reader in the file as a whole.
fn refuse_json(text: &str, error: &serde_json::Error) -> ReadError {
    let line = (error.line() > 0).then_some(error.line());
    let element = line.and_then(|line| id_on_line(text, line)).map(|id| format!("feature {id}")).unwrap_or_default();
    let fault = json_fault(text, error);
    ReadError { place: Place { line, element }, what: fault.what, hint: fault.hint.unwrap_or(DAMAGED).to_owned() }
}

/// An error of the JSON reader in a feature that starts on a line.
fn refuse_feature(raw: &str, line: usize, index: usize, error: &serde_json::Error) -> ReadError {
    let element = id_on_line(raw, error.line())
        .or_else(|| id_on_line(raw, 1))
        .map_or_else(|| format!("feature number {}", index + 1), |id| format!("feature {id}"));
    ReadError {
        place: Place { line: Some(line + error.line().saturating_sub(1)), element },
        what: json_fault(raw, error).what,
        hint: DAMAGED.to_owned(),
    }
}
