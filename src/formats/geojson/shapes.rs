//! A feature's geometry as what it is made of: points, lines and areas, whatever it is wrapped in. QGIS
//! writes every line as a MultiLineString and every area as a MultiPolygon, other programs wrap them in a
//! GeometryCollection.

use super::coordinates::{Coordinates, Position};
use super::disk::DiskGeometry;
use crate::geometry::{Bounds, Point, polygon};

/// What a geometry is made of; lengths and places as in the file.
#[derive(Debug, Default)]
pub(super) struct Shapes {
    pub points: Vec<Point>,
    pub lines: Vec<Vec<Point>>,
    /// Each the outer ring, then the holes.
    pub areas: Vec<Vec<Vec<Point>>>,
}

impl Shapes {
    /// What a geometry is made of.
    ///
    /// # Errors
    /// When its type is unknown, or its coordinates are not those of its type.
    pub(super) fn of(geometry: Option<&DiskGeometry>) -> Result<Self, String> {
        let mut shapes = Self::default();
        if let Some(geometry) = geometry {
            shapes.add(geometry)?;
        }
        Ok(shapes)
    }

    fn add(&mut self, geometry: &DiskGeometry) -> Result<(), String> {
        let points = |line: &[Position]| line.iter().map(|position| position.0).collect::<Vec<Point>>();
        let lines = |rings: &[Vec<Position>]| rings.iter().map(|ring| points(ring)).collect::<Vec<_>>();
        let kind = geometry.kind.as_str();
        let coordinates = geometry.coordinates.as_ref().unwrap_or(&Coordinates::Empty);
        match (kind, coordinates) {
            // The depth of geometries in each other is limited by the reader of JSON.
            ("GeometryCollection", _) => {
                return geometry.geometries.iter().flatten().try_for_each(|geometry| self.add(geometry));
            }
            ("Point" | "MultiPoint" | "LineString" | "MultiLineString" | "Polygon" | "MultiPolygon", coordinates) => {
                match (kind, coordinates) {
                    (_, Coordinates::Empty) => {}
                    ("Point", Coordinates::Position(position)) => self.points.push(position.0),
                    ("MultiPoint", Coordinates::Line(line)) => self.points.extend(points(line)),
                    ("LineString", Coordinates::Line(line)) => self.lines.push(points(line)),
                    ("MultiLineString", Coordinates::Rings(rings)) => self.lines.extend(lines(rings)),
                    ("Polygon", Coordinates::Rings(rings)) => self.areas.push(lines(rings)),
                    ("MultiPolygon", Coordinates::Polygons(polygons)) => {
                        self.areas.extend(polygons.iter().map(|rings| lines(rings)));
                    }
                    _ => return Err(format!("its coordinates are not those of a {kind}")),
                }
            }
            ("", Coordinates::Empty) => {}
            _ => return Err(format!("its geometry is of the type '{kind}', which GeoJSON does not have")),
        }
        Ok(())
    }

    /// What is in it, for people: '1 line and 2 points'.
    pub(super) fn words(&self) -> String {
        let counted = [(self.areas.len(), "area"), (self.lines.len(), "line"), (self.points.len(), "point")]
            .map(|(count, thing)| (count > 0).then(|| crate::base::wording::count(count, thing)));
        counted.into_iter().flatten().collect::<Vec<_>>().join(" and ")
    }

    /// All its positions.
    pub(super) fn positions(&self) -> impl Iterator<Item = Point> + '_ {
        let in_areas = self.areas.iter().flatten().flatten();
        self.points.iter().chain(self.lines.iter().flatten()).chain(in_areas).copied()
    }

    /// The same with every position moved.
    pub(super) fn map(&mut self, place: impl Fn(Point) -> Point) {
        let in_areas = self.areas.iter_mut().flatten().flatten();
        for point in self.points.iter_mut().chain(self.lines.iter_mut().flatten()).chain(in_areas) {
            *point = place(*point);
        }
    }

    pub(super) fn bounds(&self) -> Bounds {
        Bounds::of(self.positions())
    }

    /// Lines that meet end to end, as one line each: a GIS cuts them in pieces.
    pub(super) fn joined_lines(&self) -> Vec<Vec<Point>> {
        let pieces = self.lines.iter().filter_map(|line| {
            let mut points: Vec<Point> = line.iter().map(|point| point.trimmed()).collect();
            points.dedup();
            (!points.is_empty()).then_some(points)
        });
        let mut joined: Vec<Vec<Point>> = Vec::new();
        for piece in pieces {
            // Pieces come in order: each is joined to the line before it only.
            let is_joined =
                joined.last_mut().is_some_and(|line| !is_closed(line) && !is_closed(&piece) && join(line, &piece));
            if !is_joined {
                joined.push(piece);
            }
        }
        joined
    }

    /// The areas that closed lines bound: a line within another is a hole of it. `None` where a line is not
    /// closed.
    pub(super) fn areas_of_lines(&self) -> Option<Vec<Vec<Vec<Point>>>> {
        // The search for holes compares each ring's corners with each other ring: beyond this it would take
        // seconds, and no room has so many.
        const MOST_CORNERS: usize = 10_000;
        let mut rings = self.joined_lines();
        let corners: usize = rings.iter().map(Vec::len).sum();
        let is_too_much = rings.len() > 1 && corners > MOST_CORNERS;
        if rings.is_empty() || is_too_much || rings.iter().any(|ring| !is_closed(ring)) {
            return None;
        }
        rings.sort_by(|p, q| polygon::signed_area(q).abs().total_cmp(&polygon::signed_area(p).abs()));
        let mut areas: Vec<Vec<Vec<Point>>> = Vec::new();
        for ring in rings {
            let is_in = |outer: &[Point]| {
                let corners = &outer[..outer.len() - 1];
                ring.iter().all(|&point| polygon::locate_in_ring(corners, point) != polygon::Location::Outside)
            };
            match areas.iter_mut().find(|area| is_in(&area[0])) {
                Some(area) => area.push(ring),
                None => areas.push(vec![ring]),
            }
        }
        Some(areas)
    }
}

/// Whether a line comes back to where it starts, around something.
pub(super) fn is_closed(line: &[Point]) -> bool {
    line.len() > 3 && line.first() == line.last()
}

/// Joins a piece to a line that it meets at an end; false where it does not.
fn join(line: &mut Vec<Point>, piece: &[Point]) -> bool {
    let (Some(&start), Some(&end)) = (line.first(), line.last()) else { return false };
    let (Some(&from), Some(&to)) = (piece.first(), piece.last()) else { return false };
    if end == from {
        line.extend(&piece[1..]);
    } else if end == to {
        line.extend(piece.iter().rev().skip(1));
    } else if start == to || start == from {
        line.reverse();
        return join(line, piece);
    } else {
        return false;
    }
    true
}
