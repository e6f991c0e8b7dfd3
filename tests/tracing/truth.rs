//! The true plan of an office, and how far a traced plan is from it.

use std::collections::BTreeMap;

use enfilade::geometry::{Bounds, Point, polygon};
use enfilade::plan::{Joint, OpeningKind, Plan};
use enfilade::topology::{Graph, RoomShapes};

/// A room as it is in truth.
pub struct Room {
    pub outer: Vec<Point>,
    pub area_m2: f64,
    pub bounds: Bounds,
}

/// A door or a free passage between two rooms, or a room and the outside (`None`).
pub struct Door {
    pub at: Point,
    pub kind: OpeningKind,
    pub sides: [Option<usize>; 2],
}

/// An office in the metres of the plan that is traced.
pub struct Truth {
    pub rooms: Vec<Room>,
    pub doors: Vec<Door>,
    /// Corners of all polygons.
    pub corners: usize,
}

impl Truth {
    /// The truth of an imported plan, its points placed by `place`.
    pub fn new(plan: &Plan, place: impl Fn(Point) -> Point) -> Self {
        let shapes = RoomShapes::new(plan);
        let rooms: Vec<Room> = shapes
            .all()
            .iter()
            .map(|shape| {
                let outer: Vec<Point> = shape.outer.iter().map(|&point| place(point)).collect();
                Room { area_m2: shape.area_m2(), bounds: polygon::bounds(&outer), outer }
            })
            .collect();
        let graph = Graph::new(plan, &shapes);
        let side = |joint: Joint| joint.room().and_then(|id| shapes.index_of(id));
        let doors = graph
            .connections()
            .iter()
            .filter_map(|connection| {
                let opening = plan.opening(connection.opening)?;
                let at = place(plan.opening_segment(opening)?.midpoint());
                Some(Door { at, kind: opening.kind, sides: connection.sides.map(side) })
            })
            .collect();
        let corners = rooms.iter().map(|room| room.outer.len()).sum();
        Self { rooms, doors, corners }
    }

    pub fn bounds(&self) -> Bounds {
        self.rooms.iter().fold(Bounds::EMPTY, |all, room| all.union(room.bounds))
    }
}

/// Squares of this side, in metres, count where areas overlap.
pub const CELL_M: f64 = 0.125;

/// A grid of squares over an office.
pub struct Grid {
    origin: Point,
    columns: usize,
    rows: usize,
    /// The room of each square in truth.
    pub room: Vec<Option<u16>>,
}

impl Grid {
    pub fn new(truth: &Truth) -> Self {
        let bounds = truth.bounds().inflated(2.0);
        let columns = (bounds.width() / CELL_M).ceil() as usize;
        let rows = (bounds.height() / CELL_M).ceil() as usize;
        let mut grid = Self { origin: bounds.min, columns, rows, room: vec![None; columns * rows] };
        for (index, room) in truth.rooms.iter().enumerate() {
            for cell in grid.cells(&[&room.outer]) {
                grid.room[cell] = u16::try_from(index).ok();
            }
        }
        grid
    }

    /// The squares whose middles rings enclose.
    pub fn cells(&self, rings: &[&Vec<Point>]) -> Vec<usize> {
        let bounds = rings.iter().fold(Bounds::EMPTY, |all, ring| all.union(polygon::bounds(ring)));
        let row = |y: f64| ((y - self.origin.y) / CELL_M).floor().clamp(0.0, self.rows as f64) as usize;
        let mut cells = Vec::new();
        let mut crossings = Vec::new();
        for row in row(bounds.min.y)..(row(bounds.max.y) + 1).min(self.rows) {
            let y = self.origin.y + (row as f64 + 0.5) * CELL_M;
            crossings.clear();
            for edge in rings.iter().flat_map(|ring| polygon::edges(ring)) {
                if (edge.a.y <= y) != (edge.b.y <= y) {
                    crossings.push(edge.a.x + (y - edge.a.y) / (edge.b.y - edge.a.y) * (edge.b.x - edge.a.x));
                }
            }
            crossings.sort_by(f64::total_cmp);
            for pair in crossings.chunks_exact(2) {
                let column = |x: f64| ((x - self.origin.x) / CELL_M - 0.5).ceil().clamp(0.0, self.columns as f64);
                cells.extend((column(pair[0]) as usize..column(pair[1]) as usize).map(|c| row * self.columns + c));
            }
        }
        cells
    }

    /// The squares within `reach` of a square, itself included.
    pub fn around(&self, cell: usize, reach: usize) -> impl Iterator<Item = usize> + '_ {
        let (row, column) = (cell / self.columns, cell % self.columns);
        let rows = row.saturating_sub(reach)..(row + reach + 1).min(self.rows);
        rows.flat_map(move |row| {
            let columns = column.saturating_sub(reach)..(column + reach + 1).min(self.columns);
            columns.map(move |column| row * self.columns + column)
        })
    }
}

/// How far a traced plan is from the truth.
#[derive(Debug, Default)]
pub struct Judged {
    /// For each room of the truth the error of its area, as a share; 1 where none was traced.
    pub errors: Vec<f64>,
    /// Connections that are missing or too many.
    pub wrong: Vec<String>,
    /// Traced rooms that are no room of the truth.
    pub surplus: usize,
}

impl Judged {
    pub fn worst(&self) -> f64 {
        self.errors.iter().copied().fold(0.0, f64::max)
    }
}

/// Compares a traced plan with the truth: rooms by the largest overlap, connections by the rooms they
/// join and their number.
pub fn judge(truth: &Truth, grid: &Grid, plan: &Plan) -> Judged {
    let shapes = RoomShapes::new(plan);
    let mut overlaps: Vec<(usize, usize, usize)> = Vec::new();
    for (traced, shape) in shapes.all().iter().enumerate() {
        let mut shares: BTreeMap<u16, usize> = BTreeMap::new();
        for room in grid.cells(&shape.rings().collect::<Vec<_>>()).into_iter().filter_map(|cell| grid.room[cell]) {
            *shares.entry(room).or_default() += 1;
        }
        overlaps.extend(shares.into_iter().map(|(room, count)| (count, traced, usize::from(room))));
    }
    overlaps.sort_by(|p, q| q.cmp(p));
    let mut room_of: Vec<Option<usize>> = vec![None; shapes.all().len()];
    let mut traced_of: Vec<Option<usize>> = vec![None; truth.rooms.len()];
    for (_, traced, room) in overlaps {
        if room_of[traced].is_none() && traced_of[room].is_none() {
            (room_of[traced], traced_of[room]) = (Some(room), Some(traced));
        }
    }
    let error = |(room, traced): (&Room, &Option<usize>)| {
        traced.map_or(1.0, |traced| (shapes.all()[traced].area_m2() / room.area_m2 - 1.0).abs())
    };
    let errors = truth.rooms.iter().zip(&traced_of).map(error).collect();
    let surplus = room_of.iter().filter(|room| room.is_none()).count();

    let pair = |mut sides: [Option<usize>; 2]| {
        sides.sort_unstable();
        sides
    };
    let mut balance: BTreeMap<[Option<usize>; 2], isize> = BTreeMap::new();
    for door in &truth.doors {
        *balance.entry(pair(door.sides)).or_default() += 1;
    }
    for connection in Graph::new(plan, &shapes).connections() {
        let side = |joint: Joint| joint.room().and_then(|id| shapes.index_of(id)).and_then(|traced| room_of[traced]);
        *balance.entry(pair(connection.sides.map(side))).or_default() -= 1;
    }
    let wrong = balance.iter().filter(|(_, count)| **count != 0);
    let wrong = wrong.map(|(sides, count)| format!("{sides:?} {:+}", -count)).collect();
    Judged { errors, wrong, surplus }
}
