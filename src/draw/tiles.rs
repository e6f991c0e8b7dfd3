//! A large plan cut into tiles, so that a window works only on what it shows.

use super::drawing::{GraphEdge, RoomDrawing, WallDrawing, painting_order};
use super::openings::OpeningDrawing;
use crate::geometry::{Bounds, Point, Segment, Vector};

/// Squares of equal size, row by row from the lower left.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct TileGrid {
    origin: Point,
    side_m: f64,
    columns: usize,
    rows: usize,
}

/// A plan with fewer rooms, walls and openings is a single tile.
const LEAST_ELEMENTS: usize = 6000;

/// Rooms, walls and openings in a tile, about.
const ELEMENTS_A_TILE: f64 = 160.0;

/// No more tiles than this side by side.
const MOST_IN_LINE: f64 = 128.0;

/// Tiles start this far outside of the plan and no wall is likely to stand on a border: coordinates of
/// plans are round numbers, these are not.
const OFF_GRID_M: Vector = Vector { x: 0.137_035_99, y: 0.160_217_66 };

/// Points closer than this to a border, in metres, are on it: the raster of the polygon library is finer
/// in any building.
const ON_BORDER_M: f64 = 1e-4;

impl TileGrid {
    /// The tiles of a plan of this extent; `None` where it is too small to be cut.
    pub fn of(bounds: Bounds, elements: usize) -> Option<Self> {
        if elements < LEAST_ELEMENTS || bounds.is_empty() {
            return None;
        }
        let tiles = elements as f64 / ELEMENTS_A_TILE;
        let (width_m, height_m) = (bounds.width().max(1.0), bounds.height().max(1.0));
        let side_m = (width_m * height_m / tiles).sqrt().max(width_m.max(height_m) / MOST_IN_LINE);
        let count = |length_m: f64| (length_m / side_m).ceil().max(1.0) as usize + 1;
        let (columns, rows) = (count(width_m), count(height_m));
        Some(Self { origin: bounds.min + -OFF_GRID_M, side_m, columns, rows })
    }

    pub fn count(&self) -> usize {
        self.columns * self.rows
    }

    fn column(&self, x: f64) -> usize {
        (((x - self.origin.x) / self.side_m).floor().max(0.0) as usize).min(self.columns - 1)
    }

    fn row(&self, y: f64) -> usize {
        (((y - self.origin.y) / self.side_m).floor().max(0.0) as usize).min(self.rows - 1)
    }

    /// The tile a point is in; what lies outside belongs to the nearest.
    pub fn at(&self, point: Point) -> usize {
        self.row(point.y) * self.columns + self.column(point.x)
    }

    /// The tiles a box meets.
    pub fn meeting(&self, bounds: Bounds) -> impl Iterator<Item = usize> + '_ {
        let (left, right) = (self.column(bounds.min.x), self.column(bounds.max.x));
        let end = if bounds.is_empty() { 0 } else { self.row(bounds.max.y) + 1 };
        (self.row(bounds.min.y)..end).flat_map(move |row| (left..=right).map(move |column| row * self.columns + column))
    }

    /// The square itself. Those at the rim reach as far as anything is drawn.
    pub fn bounds(&self, tile: usize) -> Bounds {
        // A hundred kilometres, the whole drawing area.
        const FAR_M: f64 = 1e5;
        let (column, row) = (tile % self.columns, tile / self.columns);
        let low = |index: usize, start: f64| start + index as f64 * self.side_m;
        let far = |index: usize, count: usize| if index + 1 == count { FAR_M } else { 0.0 };
        let near = |index: usize| if index == 0 { FAR_M } else { 0.0 };
        Bounds {
            min: Point::new(low(column, self.origin.x) - near(column), low(row, self.origin.y) - near(row)),
            max: Point::new(
                low(column + 1, self.origin.x) + far(column, self.columns),
                low(row + 1, self.origin.y) + far(row, self.rows),
            ),
        }
    }

    /// Whether a piece of a polygon's boundary is where the polygon was cut.
    pub fn is_cut(&self, a: Point, b: Point) -> bool {
        let on = |p: f64, q: f64, start: f64| {
            let border = start + ((p - start) / self.side_m).round() * self.side_m;
            (p - border).abs() <= ON_BORDER_M && (q - border).abs() <= ON_BORDER_M
        };
        on(a.x, b.x, self.origin.x) || on(a.y, b.y, self.origin.y)
    }
}

/// What is drawn of a plan, tile by tile.
pub(super) struct Tiles {
    pub grid: TileGrid,
    pub all: Vec<Tile>,
    /// One more than the highest level of a room.
    pub levels: usize,
}

/// What is drawn in a tile: indices into the drawing's lists. Rooms, openings and ways belong to the tile
/// they have their middle in, walls are cut.
pub(super) struct Tile {
    /// The box of all that is in it, which may be larger than the tile.
    pub bounds: Bounds,
    /// Rooms in the order of painting, by level: those of a level are painted in all tiles before those
    /// of the next.
    pub rooms: Vec<Vec<usize>>,
    pub walls: Vec<usize>,
    pub wall_lines: Vec<usize>,
    pub boundaries: Vec<usize>,
    pub openings: Vec<usize>,
    pub graph: Vec<usize>,
    /// The drawn walls' axes with their thickness in metres, for a view from afar.
    pub axes: Vec<(Segment, f64)>,
}

impl Tile {
    fn empty() -> Self {
        Self {
            bounds: Bounds::EMPTY,
            rooms: Vec::new(),
            walls: Vec::new(),
            wall_lines: Vec::new(),
            boundaries: Vec::new(),
            openings: Vec::new(),
            graph: Vec::new(),
            axes: Vec::new(),
        }
    }
}

/// What is put into tiles.
pub(super) struct Contents<'a> {
    pub rooms: &'a [RoomDrawing],
    /// Pieces of wall, each with its tile.
    pub walls: &'a [WallDrawing],
    pub wall_tiles: &'a [usize],
    pub wall_lines: &'a [Segment],
    pub boundaries: &'a [Segment],
    pub openings: &'a [OpeningDrawing],
    pub graph: &'a [GraphEdge],
    pub axes: Vec<(Segment, f64)>,
}

impl Tiles {
    pub fn new(grid: TileGrid, contents: Contents<'_>) -> Self {
        let mut all: Vec<Tile> = (0..grid.count()).map(|_| Tile::empty()).collect();
        let rooms = contents.rooms;
        let home: Vec<usize> = rooms.iter().map(|room| grid.at(room.bounds.center())).collect();
        let mut order: Vec<usize> = (0..rooms.len()).filter(|&room| !rooms[room].outer.is_empty()).collect();
        order.sort_by(|&p, &q| painting_order(rooms, p, q));
        // A room over one of another tile is painted when that tile's is.
        let mut level = vec![0; rooms.len()];
        for &room in &order {
            for &above in &rooms[room].above {
                let least = level[room] + usize::from(home[above] != home[room]);
                level[above] = least.max(level[above]);
            }
        }
        let levels = level.iter().max().map_or(1, |highest| highest + 1);
        for room in order {
            let tile = &mut all[home[room]];
            if tile.rooms.len() <= level[room] {
                tile.rooms.resize(level[room] + 1, Vec::new());
            }
            tile.rooms[level[room]].push(room);
            tile.bounds = tile.bounds.union(rooms[room].bounds);
        }
        for (wall, (&tile, drawn)) in contents.wall_tiles.iter().zip(contents.walls).enumerate() {
            all[tile].walls.push(wall);
            all[tile].bounds = all[tile].bounds.union(Bounds::of(drawn.outer.iter().copied()));
        }
        let mut put = |bounds: Bounds, add: &mut dyn FnMut(&mut Tile)| {
            let tile = &mut all[grid.at(bounds.center())];
            tile.bounds = tile.bounds.union(bounds);
            add(tile);
        };
        for (index, line) in contents.wall_lines.iter().enumerate() {
            put(line.bounds(), &mut |tile| tile.wall_lines.push(index));
        }
        for (index, line) in contents.boundaries.iter().enumerate() {
            put(line.bounds(), &mut |tile| tile.boundaries.push(index));
        }
        for (index, opening) in contents.openings.iter().enumerate() {
            put(opening.bounds(), &mut |tile| tile.openings.push(index));
        }
        for (index, edge) in contents.graph.iter().enumerate() {
            let ends = [edge.from, edge.through].into_iter().chain(edge.to.ok());
            put(Bounds::of(ends), &mut |tile| tile.graph.push(index));
        }
        for axis in contents.axes {
            put(axis.0.bounds(), &mut |tile| tile.axes.push(axis));
        }
        Self { grid, all, levels }
    }
}
