//! The XML of the KTH campus data set: one floor per file, each room by its contour at true scale, with doors and
//! windows as pieces of it. What is repaired and how is described for users in `docs/kth-xml.md`.

mod document;

use std::collections::BTreeMap;

use serde_json::{Map, Value};

use self::document::{Floor, Kind, Space};
use super::options::METRES_PER_PIXEL;
use super::point_openings::{self, Ring};
use super::text;
use super::xml::{Notes, Offset, root_name};
use super::{Format, FormatOption, Head, Import, Importer, NoteKind, Options, Place, ReadError, Recognition, Source};
use crate::base::numbers::upper_median;
use crate::geometry::polygon::{self, Location};
use crate::geometry::{COORDINATE_LIMIT_M, Point, Segment, trim_m};
use crate::labels::Typology;
use crate::plan::{
    Builder, CornerId, Joint, MEDIAN_DOOR_M, Meta, Opening, OpeningKind, Place as OpeningPlace, Room, RoomId, Scale,
    ScaleOrigin, THICKEST_WALL_M,
};

/// The most comparisons to find openings' partners and edges. The largest real file needs 12,000.
const WORK_LIMIT: usize = 20_000_000;

/// Two ends of lines this far apart are one corner: the files have two decimals of a pixel of about 6 mm.
const SAME_M: f64 = 1e-3;

/// An outline that misses its first corner by less than this returns to it, in metres.
const NEARLY_CLOSED_M: f64 = 0.1;

/// Two rooms' drawings of an opening lie at most this far apart, in metres: old buildings have walls of a metre, and
/// niches before doors. Of openings that both rooms draw, 99 % lie closer; beyond, they are two.
const THICKEST_OLD_WALL_M: f64 = 1.5;

/// A narrower opening, in metres, has no width worth the name.
const NARROWEST_M: f64 = 0.1;

/// The widest opening that a plan can hold, in metres.
const WIDEST_M: f64 = 1000.0;

/// From this width on, in metres, a portal is taken as a double door: single leaves are made up to 1.2 m.
const DOUBLE_DOOR_M: f64 = 1.3;

/// From this width on, in metres, a portal is taken as a passage without a door: double doors are made up to 2.4 m.
const PASSAGE_M: f64 = 2.5;

/// The median scale of 95 floors, in metres per pixel: for files with neither a scale nor a door.
const MEDIAN_SCALE_M: f64 = 0.00635;

/// The XML of the KTH campus data set.
pub const FORMAT: Format = Format {
    id: "kth-xml",
    name: "XML of the KTH campus",
    endings: &["xml"],
    about: "Floors of university buildings from the KTH campus data set (docs/kth-xml.md)",
    importer: Some(&KthXml),
    exporter: None,
};

struct KthXml;

impl Importer for KthXml {
    fn options(&self) -> &'static [FormatOption] {
        const { &[FormatOption::Number(&METRES_PER_PIXEL)] }
    }

    fn recognises(&self, head: &Head<'_>) -> Recognition {
        let Head::File { start, .. } = head else { return Recognition::No };
        if root_name(start).is_none_or(|root| root != document::ROOT) {
            return Recognition::No;
        }
        let start = String::from_utf8_lossy(start);
        let is_ours = ["BuildingName", "FloorName", "PixelDistance"].iter().any(|word| start.contains(word));
        if is_ours { Recognition::Yes } else { Recognition::No }
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
    let floor = document::parse(text)?;
    if floor.spaces.is_empty() {
        return Err(ReadError {
            place: Place::default(),
            what: "holds no room".to_owned(),
            hint: "check that this is the whole file: rooms are <space> elements in <floor>".to_owned(),
        });
    }
    let mut notes = Notes::new(text);
    notes.unknown(&floor.unknown);
    let scale = scale(&floor, metres_per_pixel, &mut notes);
    let reader = Reader { metres_per_pixel: scale.metres_per_unit.unwrap_or(MEDIAN_SCALE_M), floor: &floor, notes };
    reader.read(meta(&floor, stem, scale))
}

/// What the file says of the floor as a whole.
fn meta(floor: &Floor, stem: &str, scale: Scale) -> Meta {
    let name = if floor.name.is_empty() { stem } else { &floor.name };
    let mut extra = Map::new();
    if !floor.domain.is_empty() {
        extra.insert("kth_domain".to_owned(), Value::String(floor.domain.clone()));
    }
    Meta {
        name: name.to_owned(),
        building: floor.building.clone(),
        storey: name.to_owned(),
        // The data set holds nothing else.
        typology: Typology::new("university"),
        scale,
        extra: (!extra.is_empty()).then(|| std::sync::Arc::new(extra)),
        ..Meta::default()
    }
}

/// How many metres a pixel is: as told, as the file states, or by the widths of its doors.
fn scale(floor: &Floor, told: Option<f64>, notes: &mut Notes<'_>) -> Scale {
    let with = |origin, metres_per_unit, note| Scale { origin, metres_per_unit: Some(metres_per_unit), note };
    if let Some(metres) = told {
        return with(ScaleOrigin::Measured, metres, format!("told when importing: {metres} m per pixel"));
    }
    let stated = floor.scale.as_ref().and_then(|scale| Some((scale.pixels?, scale.metres?)));
    if let Some((pixels, metres)) = stated.filter(|&(pixels, metres)| pixels > 0.0 && metres > 0.0) {
        let metres_per_pixel = metres / pixels;
        if (METRES_PER_PIXEL.least..=METRES_PER_PIXEL.most).contains(&metres_per_pixel) {
            return with(ScaleOrigin::Imported, metres_per_pixel, format!("{pixels} pixels stand for {metres} m"));
        }
    }
    let lines = floor.spaces.iter().flat_map(|space| &space.lines);
    let portals = lines.filter(|line| line.kind == Kind::Portal).map(|line| line.from.distance(line.to));
    let mut widths_px: Vec<f64> = portals.filter(|&width_px| width_px > 0.0).collect();
    let by_doors = upper_median(&mut widths_px).map(|width_px| MEDIAN_DOOR_M / width_px);
    let (metres, how) = match by_doors.filter(|metres| metres.is_finite()) {
        Some(metres) => (metres, format!("estimated so that the median door is {MEDIAN_DOOR_M} m wide")),
        None => (MEDIAN_SCALE_M, format!("a pixel taken as {MEDIAN_SCALE_M} m, as in most such files")),
    };
    let why = match floor.scale {
        Some(_) => "the scale is no number that can be meant",
        None => "the scale is missing",
    };
    let note = format!("{why}; {how}");
    notes.push(NoteKind::Healed, floor.scale.as_ref().map(|scale| scale.at), "scale", note.as_str());
    with(ScaleOrigin::Estimated, metres, note)
}

/// A floor being turned into a plan.
struct Reader<'a> {
    floor: &'a Floor,
    metres_per_pixel: f64,
    notes: Notes<'a>,
}

/// A room in the plan: its identity, and its rings with the positions of their corners.
struct Built {
    id: RoomId,
    rings: Vec<(Vec<CornerId>, Vec<Point>)>,
}

impl Built {
    fn ring(&self) -> Option<Ring<'_>> {
        self.rings.first().map(|(corners, points)| Ring { corners, points })
    }
}

/// A portal, as one of its rooms draws it.
#[derive(Clone, Copy)]
struct Stated {
    /// Index of the room.
    room: usize,
    at: Offset,
    segment: Segment,
}

/// An opening: the portals of one or both rooms that draw it, the widest first, and its sides by the rooms' indices.
struct Joined {
    stated: Vec<Stated>,
    sides: [Option<usize>; 2],
}

impl<'a> Reader<'a> {
    fn read(mut self, meta: Meta) -> Result<Import, ReadError> {
        self.refuse_far_away()?;
        let mut builder = Builder::new(meta);
        let floor = self.floor;
        let mut rooms: Vec<Built> = Vec::new();
        for space in &floor.spaces {
            rooms.push(self.room(&mut builder, space));
        }
        let joined = self.joined(&rooms)?;
        for opening in &joined {
            self.add_opening(&mut builder, opening, &rooms);
        }
        self.add_windows(&mut builder, &rooms)?;
        let plan = builder.finish().map_err(|violations| ReadError {
            place: Place::default(),
            what: violations.first().map(ToString::to_string).unwrap_or_default(),
            hint: "please report this: the reader should have mended it".to_owned(),
        })?;
        Ok(Import { plans: vec![plan], notes: self.notes.finish() })
    }

    fn refuse_far_away(&mut self) -> Result<(), ReadError> {
        let lines = self.floor.spaces.iter().flat_map(|space| &space.lines);
        let is_far = |point: Point| point.x.abs().max(point.y.abs()) * self.metres_per_pixel >= COORDINATE_LIMIT_M;
        let Some(line) = lines.into_iter().find(|line| is_far(line.from) || is_far(line.to)) else { return Ok(()) };
        Err(ReadError {
            place: Place { line: Some(self.notes.line(line.at)), element: "linesegment".to_owned() },
            what: format!("lies more than {COORDINATE_LIMIT_M} m from the origin"),
            hint: "correct the scale, or give one with --option metres-per-pixel=NUMBER".to_owned(),
        })
    }

    /// From pixels, y down, to metres, y up; the origin is the picture's upper left corner.
    fn metres(&self, point: Point) -> Point {
        Point::new(point.x * self.metres_per_pixel, -point.y * self.metres_per_pixel).trimmed()
    }

    fn segment(&self, line: &document::Line) -> Segment {
        Segment::new(self.metres(line.from), self.metres(line.to))
    }

    fn note(&mut self, kind: NoteKind, at: Offset, space: &Space, what: &str) {
        self.notes.push(kind, Some(at), space.title(), what);
    }

    fn room(&mut self, builder: &mut Builder, space: &Space) -> Built {
        let outlines = self.outlines(space);
        let rings: Vec<_> = outlines.into_iter().map(|outline| builder.ring(outline)).collect();
        let mut rings = rings.into_iter().filter(|ring| ring.len() >= 3);
        let outer = rings.next().unwrap_or_default();
        let holes = rings.collect();
        // 'A0043012_276B' is room 276B of building A0043012.
        let own = space.name.strip_prefix(&self.floor.building).and_then(|rest| rest.strip_prefix('_'));
        let name = own.filter(|_| !self.floor.building.is_empty()).unwrap_or(&space.name).to_owned();
        let room = Room { outer, holes, function: space.function.clone(), name, ..Room::default() };
        let rings = room.rings().filter(|ring| !ring.is_empty());
        let rings = rings.map(|ring| (ring.to_vec(), builder.plan().ring_points(ring))).collect();
        Built { id: builder.room(&space.name, room), rings }
    }

    /// The outlines of a room in metres, the outer one first, then its holes. None if it has no contour.
    ///
    /// A contour is a chain of lines. Where it jumps, another outline starts.
    fn outlines(&mut self, space: &Space) -> Vec<Vec<Point>> {
        let mut closed: Vec<Vec<Point>> = Vec::new();
        let mut open: Vec<Point> = Vec::new();
        let mut gap_m: f64 = 0.0;
        let chains = space.lines.chunk_by(|a, b| a.to.distance(b.from) * self.metres_per_pixel <= SAME_M);
        for chain in chains {
            let (Some(first), Some(last)) = (chain.first(), chain.last()) else { continue };
            let missing_m = first.from.distance(last.to) * self.metres_per_pixel;
            if chain.len() >= 3 && missing_m <= NEARLY_CLOSED_M {
                closed.push(self.corners(chain));
            } else {
                gap_m = gap_m.max(missing_m);
                open.extend(self.corners(chain));
                open.push(self.metres(last.to));
            }
        }
        let area = |ring: &[Point]| polygon::signed_area(ring).abs();
        closed.retain(|ring| area(ring) > 0.0);
        if !open.is_empty() {
            if closed.is_empty() && area(&open) > 0.0 {
                let what = format!("its contour does not return to its first corner, {gap_m:.2} m are missing; closed");
                self.note(NoteKind::Healed, space.at, space, &what);
                closed.push(open);
            } else {
                let what = format!("{} of its contour bound no area; left out", pieces(open.len()));
                self.note(NoteKind::Skipped, space.at, space, &what);
            }
        }
        closed.sort_by(|p, q| area(q).total_cmp(&area(p)));
        let mut outlines = closed.into_iter();
        let Some(outer) = outlines.next() else {
            self.note(NoteKind::Healed, space.at, space, "has no contour; kept without a boundary");
            return Vec::new();
        };
        let mut rings = vec![outer];
        for outline in outlines {
            let is_inside = outline.iter().all(|&point| polygon::locate_in_ring(&rings[0], point) != Location::Outside);
            if is_inside {
                rings.push(outline);
            } else {
                let what = format!("has a second outline of {:.1} m² beside the first; left out", area(&outline));
                self.note(NoteKind::Skipped, space.at, space, &what);
            }
        }
        rings
    }

    /// The corners of a chain of lines. One that lies straight between its neighbours, at the end of an opening, is
    /// there for the opening only and left out, so that the opening lies within one edge.
    fn corners(&self, chain: &[document::Line]) -> Vec<Point> {
        let mut kept: Vec<Point> = Vec::with_capacity(chain.len());
        let mut dropped: Vec<Point> = Vec::new();
        for (index, line) in chain.iter().enumerate() {
            let here = self.metres(line.from);
            if let (Some(&before), Some(previous)) = (kept.last(), index.checked_sub(1).and_then(|i| chain.get(i))) {
                let ahead = Segment::new(before, self.metres(line.to));
                let ends_opening = line.kind != Kind::Wall || previous.kind != Kind::Wall;
                let is_straight = dropped.iter().chain([&here]).all(|&point| ahead.distance(point) <= SAME_M)
                    && (here - before).dot(ahead.b - here) > 0.0;
                if ends_opening && is_straight {
                    dropped.push(here);
                    continue;
                }
            }
            dropped.clear();
            kept.push(here);
        }
        kept
    }

    /// The openings: the portals of both rooms put together, in file order.
    fn joined(&mut self, rooms: &[Built]) -> Result<Vec<Joined>, ReadError> {
        let floor = self.floor;
        let mut by_name: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
        for (index, space) in floor.spaces.iter().enumerate() {
            let same = by_name.entry(space.name.as_str()).or_default();
            same.push(index);
            if same.len() == 2 {
                self.note(NoteKind::Healed, space.at, space, "another room has this name; portals lead to the nearer");
            }
        }
        let nearest = |name: &str, point: Option<Point>| -> Option<usize> {
            let distance = |room: &usize| match (rooms[*room].ring(), point) {
                (Some(ring), Some(point)) => ring.distance(point),
                _ => f64::INFINITY,
            };
            match by_name.get(name)?.as_slice() {
                [only] => Some(*only),
                several => several.iter().copied().min_by(|a, b| distance(a).total_cmp(&distance(b))),
            }
        };
        let mut joined: Vec<Joined> = Vec::new();
        // By the two rooms: what each of them draws.
        let mut drawn: BTreeMap<[usize; 2], [Vec<Stated>; 2]> = BTreeMap::new();
        let mut work = 0;
        for (room, space) in floor.spaces.iter().enumerate() {
            for line in space.lines.iter().filter(|line| line.kind == Kind::Portal) {
                let stated = Stated { room, at: line.at, segment: self.segment(line) };
                let same = by_name.get(line.target.as_str()).map_or(0, Vec::len);
                work += if same > 1 { same * space.lines.len() } else { 0 };
                self.refuse_endless(work, line.at)?;
                let found = nearest(&line.target, Some(stated.segment.midpoint())).filter(|&other| other != room);
                let Some(other) = found else {
                    let what = match line.target.as_str() {
                        "" => "a portal names no room that it leads to; taken as leading outside".to_owned(),
                        own if own == space.name => {
                            "a portal leads to its own room; taken as leading outside".to_owned()
                        }
                        other => {
                            format!("a portal leads to '{other}', which is not in the file; taken as leading outside")
                        }
                    };
                    self.note(NoteKind::Healed, line.at, space, &what);
                    joined.push(Joined { stated: vec![stated], sides: [Some(room), None] });
                    continue;
                };
                let (key, side) = if room < other { ([room, other], 0) } else { ([other, room], 1) };
                drawn.entry(key).or_default()[side].push(stated);
            }
        }
        for (key, [first, second]) in &drawn {
            work += first.len() * second.len() + (first.len() + second.len()).pow(2);
            self.refuse_endless(work, first.first().or(second.first()).map_or(0, |stated| stated.at))?;
            joined.extend(self.pairs(*key, first, second));
        }
        for (room, space) in floor.spaces.iter().enumerate() {
            for (target, at) in &space.targets {
                let Some(other) = nearest(target, None).filter(|&other| other != room) else { continue };
                let key = if room < other { [room, other] } else { [other, room] };
                if drawn.contains_key(&key) {
                    continue;
                }
                drawn.entry(key).or_default();
                work += rooms[room].rings.iter().map(|ring| ring.0.len()).sum::<usize>();
                self.refuse_endless(work, *at)?;
                if !self.is_beside(&rooms[room], &rooms[other]) {
                    let what = format!("a portal to '{target}' is drawn nowhere, and the rooms do not meet; left out");
                    self.note(NoteKind::Skipped, *at, space, &what);
                    continue;
                }
                let what =
                    format!("a portal to '{target}' is drawn nowhere; put where the rooms are next to each other");
                self.note(NoteKind::Healed, *at, space, &what);
                joined.push(Joined { stated: Vec::new(), sides: [Some(room), Some(other)] });
            }
        }
        joined.sort_by_key(|opening| opening.stated.first().map_or(usize::MAX, |stated| stated.at));
        Ok(joined)
    }

    fn refuse_endless(&mut self, work: usize, at: Offset) -> Result<(), ReadError> {
        if work <= WORK_LIMIT {
            return Ok(());
        }
        Err(ReadError {
            place: Place { line: Some(self.notes.line(at)), element: String::new() },
            what: "has too many portals in rooms with too many corners".to_owned(),
            hint: "simplify the contours, or split the file".to_owned(),
        })
    }

    /// Whether the likely place of an opening between two rooms is on both.
    fn is_beside(&self, one: &Built, other: &Built) -> bool {
        let rings: Vec<Ring<'_>> = [one, other].into_iter().filter_map(Built::ring).collect();
        let point = point_openings::likely_point(&rings).filter(|_| rings.len() == 2);
        point.is_some_and(|point| rings.iter().all(|ring| ring.distance(point) <= THICKEST_WALL_M))
    }

    /// Puts together what two rooms draw of the openings between them: those nearest to each other first, and what is
    /// left where it lies alongside one of these.
    fn pairs(&mut self, key: [usize; 2], first: &[Stated], second: &[Stated]) -> Vec<Joined> {
        let sides = key.map(Some);
        let mut candidates: Vec<(f64, usize, usize)> = Vec::new();
        for (i, one) in first.iter().enumerate() {
            for (j, other) in second.iter().enumerate().filter(|(_, other)| alongside(one.segment, other.segment)) {
                candidates.push((one.segment.midpoint().distance(other.segment.midpoint()), i, j));
            }
        }
        candidates.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
        let mut taken = [vec![false; first.len()], vec![false; second.len()]];
        let mut joined: Vec<Joined> = Vec::new();
        for (_, i, j) in candidates {
            if !taken[0][i] && !taken[1][j] {
                (taken[0][i], taken[1][j]) = (true, true);
                joined.push(Joined { stated: vec![first[i], second[j]], sides });
            }
        }
        for (side, all) in [first, second].into_iter().enumerate() {
            for stated in all.iter().zip(&taken[side]).filter(|(_, taken)| !**taken).map(|(stated, _)| *stated) {
                let beside = |opening: &&mut Joined| {
                    opening
                        .stated
                        .iter()
                        .any(|known| known.room != stated.room && alongside(known.segment, stated.segment))
                };
                let space = &self.floor.spaces[stated.room];
                if let Some(opening) = joined.iter_mut().find(beside) {
                    opening.stated.push(stated);
                    let what = "a portal is drawn in two pieces in one of its rooms; taken as one opening";
                    self.note(NoteKind::Healed, stated.at, space, what);
                } else {
                    let what = "a portal is drawn in one of its two rooms only; kept as joining both";
                    self.note(NoteKind::Healed, stated.at, space, what);
                    joined.push(Joined { stated: vec![stated], sides });
                }
            }
        }
        for opening in &mut joined {
            opening.stated.sort_by(|a, b| b.segment.length().total_cmp(&a.segment.length()).then(a.at.cmp(&b.at)));
        }
        joined
    }

    fn add_opening(&mut self, builder: &mut Builder, opening: &Joined, rooms: &[Built]) {
        let own: Vec<Ring<'_>> = opening.sides.iter().flatten().filter_map(|&room| rooms[room].ring()).collect();
        let drawn = opening.stated.iter().find(|stated| stated.segment.length() >= NARROWEST_M);
        let place = match (drawn, opening.stated.first()) {
            (Some(drawn), _) if drawn.segment.length() <= WIDEST_M => place(&rooms[drawn.room], drawn.segment),
            (Some(drawn), _) => {
                let what = "a portal is wider than a kilometre; left out";
                self.note(NoteKind::Skipped, drawn.at, &self.floor.spaces[drawn.room], what);
                return;
            }
            (None, stated) => {
                if let Some(stated) = stated {
                    let what = "a portal has no width; taken as an ordinary door";
                    self.note(NoteKind::Healed, stated.at, &self.floor.spaces[stated.room], what);
                }
                let point = stated.map(|stated| stated.segment.midpoint());
                let point = point.or_else(|| point_openings::likely_point(&own));
                let Some(placed) = point.and_then(|point| point_openings::place(&own, point)) else { return };
                placed.place
            }
        };
        let width_m = match place {
            OpeningPlace::Hosted { width_m, .. } => width_m,
            OpeningPlace::Free { from, to } => from.distance(to),
        };
        let kind = match width_m {
            wide if wide >= PASSAGE_M => OpeningKind::Passage,
            wide if wide >= DOUBLE_DOOR_M => OpeningKind::DoubleDoor,
            _ => OpeningKind::Door,
        };
        let mut element = Opening::new(kind, place);
        let joint = |side: Option<usize>| side.map_or(Joint::Outside, |room| Joint::Room(rooms[room].id));
        element.pinned = Some(opening.sides.map(joint));
        builder.opening("", element);
    }

    fn add_windows(&mut self, builder: &mut Builder, rooms: &[Built]) -> Result<(), ReadError> {
        let floor = self.floor;
        let mut work = 0;
        for (space, room) in floor.spaces.iter().zip(rooms) {
            for line in space.lines.iter().filter(|line| line.kind == Kind::Window) {
                work += space.lines.len();
                self.refuse_endless(work, line.at)?;
                let segment = self.segment(line);
                if (NARROWEST_M..=WIDEST_M).contains(&segment.length()) {
                    builder.opening("", Opening::new(OpeningKind::Window, place(room, segment)));
                } else {
                    self.note(NoteKind::Skipped, line.at, space, "a window has no width that can be meant; left out");
                }
            }
        }
        Ok(())
    }
}

/// The place of an opening on the edge of its room that it lies on; a segment of its own if there is none.
fn place(room: &Built, segment: Segment) -> OpeningPlace {
    let mut best: Option<(f64, OpeningPlace)> = None;
    for (corners, points) in &room.rings {
        for (index, edge) in polygon::edges(points).enumerate() {
            let off_m = edge.distance(segment.a).max(edge.distance(segment.b));
            if off_m <= 2.0 * SAME_M && best.is_none_or(|(least_m, _)| off_m < least_m) {
                let at_m = trim_m(edge.nearest_fraction(segment.midpoint()) * edge.length());
                let (from, to) = (corners[index], corners[(index + 1) % corners.len()]);
                best = Some((off_m, OpeningPlace::Hosted { from, to, at_m, width_m: trim_m(segment.length()) }));
            }
        }
    }
    best.map_or(OpeningPlace::Free { from: segment.a, to: segment.b }, |(_, place)| place)
}

/// Whether two drawings of a portal, one in each of its rooms, can be the same opening: the middle of the shorter lies
/// within the thickest old wall of the longer.
fn alongside(one: Segment, other: Segment) -> bool {
    let (short, long) = if one.length() <= other.length() { (one, other) } else { (other, one) };
    long.distance(short.midpoint()) <= THICKEST_OLD_WALL_M
}

fn pieces(count: usize) -> String {
    crate::base::wording::count(count.saturating_sub(1), "piece")
}
