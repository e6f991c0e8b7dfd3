//! A large plan cut into tiles, so that a window works only on what it shows.

use super::elements::{GraphEdge, RoomDrawing, WallDrawing, painting_order};
use super::openings::OpeningDrawing;
use super::tile_grid::TileGrid;
use crate::geometry::{Bounds, Segment};

/// What is drawn of a plan, tile by tile.
pub(super) struct Tiles {
    pub grid: TileGrid,
    pub all: Vec<Tile>,
    /// The number of room levels: one more than the highest.
    pub levels: usize,
}

/// What is drawn in a tile: indices into the drawing's lists. Rooms, openings and connections belong to
/// the tile of their middle; walls are cut.
pub(super) struct Tile {
    /// The bounding box of its contents, which may be larger than the tile.
    pub bounds: Bounds,
    /// Rooms in painting order, by level: those of one level are painted in all tiles before those of the
    /// next.
    pub rooms: Vec<Vec<usize>>,
    pub walls: Vec<usize>,
    pub wall_lines: Vec<usize>,
    pub boundaries: Vec<usize>,
    pub openings: Vec<usize>,
    pub graph: Vec<usize>,
    /// The axes of the drawn walls and their thickness in metres, for a view from afar.
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

/// The contents to distribute over tiles.
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
        // A room over one of another tile must be painted after it, at a higher level.
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
