use std::collections::BTreeMap;
use std::sync::Arc;

use super::elements::{GraphEdge, NODE_RADIUS_PX, RoomDrawing, WallDrawing, painting_order};
use super::names::Around;
use super::openings::{OpeningDrawing, PlacedOpening};
use super::scene::{Frame, Group, Item, Layer, Length, PlacedPicture, Scene, View};
use super::tile_grid::TileGrid;
use super::tiles::{Contents, Tile, Tiles};
use super::walls::{self, Faces, Walls};
use super::{Fill, Grid, Palette, Rgba, Style, dimensions, names};
use crate::base::{units::Units, wording::thousands};
use crate::features::{Analysis, RoomStatus};
use crate::geometry::tangle::one_line_in;
use crate::geometry::{Bounds, Point, Segment, areas, polygon, raster};
use crate::labels::{Colour, Label, function_title, normalised_function};
use crate::picture::PictureLevels;
use crate::plan::{Backdrop, DimensionId, DimensionLine, Joint, Meta, OpeningId, Plan, RoomId, Swing, Wall};

/// A plan as shapes, before zoom and colours: made once per plan, asked for a [`Scene`] once per view.
pub struct Drawing {
    pub(super) meta: Meta,
    pub(super) rooms: Vec<RoomDrawing>,
    pub(super) walls: Vec<WallDrawing>,
    pub(super) wall_lines: Vec<Segment>,
    pub(super) boundaries: Vec<Segment>,
    pub(super) openings: Vec<OpeningDrawing>,
    pub(super) graph: Vec<GraphEdge>,
    dimensions: Vec<(DimensionId, DimensionLine)>,
    pub(super) faces: Faces,
    picture: Option<PlacedPicture>,
    tangled: usize,
    /// Whether so many rooms lie over each other that none is named.
    are_piled: bool,
    /// What to know before believing what is shown, below the title; empty for most.
    pub(super) caveat: String,
    /// The colours that the scheme gives functions.
    colours: BTreeMap<String, Colour>,
    bounds: Bounds,
    /// The same without dimension chains.
    built: Bounds,
    /// How a large plan is cut into tiles; `None` if in one piece.
    tiles: Option<Tiles>,
    /// The zoom, in pixels a metre, from which on a room can hold a name.
    named_from_px_per_m: f64,
    counts: Counts,
    predicted_counts: Counts,
}

/// The numbers of rooms with each label, without a label, and not classified.
type Counts = ([usize; 5], usize, usize);

/// A piece of a plan seen from afar.
pub enum FromAfar<'a> {
    Fill { outer: &'a [Point], holes: &'a [Vec<Point>], colour: Rgba },
    Line { segment: Segment, colour: Rgba, width_px: f64 },
}

/// Width in pixels of the lines that hatch a room whose known label differs from the predicted one.
const HATCH_LINE_PX: f64 = 1.75;

/// A prediction this sure, or less, has the faintest fill; one this sure, or more, the full colour of its label.
const FAINTEST: f64 = 0.35;
const FULL: f64 = 0.9;

/// The share of the label's colour in the faintest fill.
const LEAST_COLOUR: f64 = 0.28;

/// Rooms are piled up when more than so many lie over each other, and so many for each room: storeys drawn into
/// each other have a few.
const PILED_ROOMS: usize = 10_000;
const PILED_A_ROOM: usize = 100;

impl Drawing {
    /// Draws a plan. `analysis` must be that of the same plan.
    pub fn new(plan: &Plan, analysis: &Analysis) -> Self {
        Self::cut(plan, analysis, None)
    }

    /// The same, cut into tiles if the plan is large, so that a window works only on what it shows: see
    /// [`Drawing::tiles_in`]. Drawn as a whole, the cuts through its walls show.
    pub fn in_tiles(plan: &Plan, analysis: &Analysis) -> Self {
        let elements = plan.rooms().len() + plan.walls().len() + plan.openings().len();
        Self::cut(plan, analysis, TileGrid::of(plan.bounds(), elements))
    }

    fn cut(plan: &Plan, analysis: &Analysis, grid: Option<TileGrid>) -> Self {
        let mut rooms: Vec<RoomDrawing> = plan
            .rooms()
            .zip(&analysis.rooms)
            .zip(analysis.shapes.all().iter().zip(analysis.net_rooms()))
            .map(|(((id, room), analysed), (shape, net))| RoomDrawing {
                id,
                name: room.name.trim().to_owned(),
                function: room.function.trim().to_owned(),
                status: analysed.status,
                predicted: None,
                sureness: 1.0,
                area_m2: shape.area_m2(),
                clear_m2: net.as_ref().map_or(0.0, |net| net.area_m2),
                has_walls: net.as_ref().is_some_and(|net| net.has_walls),
                outer: shape.outer.clone(),
                holes: shape.holes.clone(),
                bounds: shape.bounds,
                centre: raster::centre(&shape.outer, &shape.holes),
                text_at: room.text_offset.map(|offset| shape.bounds.center() + offset),
                above: Vec::new(),
                openings: Vec::new(),
            })
            .collect();
        // No building piles its rooms up: what a fuzzer makes is drawn in any order and without names.
        let most_above = PILED_ROOMS + PILED_A_ROOM * rooms.len();
        let mut all_above = 0;
        for i in 0..rooms.len() {
            if all_above > most_above {
                break;
            }
            // Less a centimetre: neighbours meet at most along an edge.
            let near = analysis.shapes.near(rooms[i].bounds.inflated(-0.01));
            rooms[i].above = near.into_iter().filter(|&j| painting_order(&rooms, j, i).is_gt()).collect();
            all_above += rooms[i].above.len();
        }
        let are_piled = all_above > most_above;
        if are_piled {
            rooms.iter_mut().for_each(|room| room.above = Vec::new());
        }
        let walls = Walls::new(plan, analysis.wall_bodies(plan), &rooms, grid.as_ref());
        let faces = Faces::new(&walls.solid, grid.as_ref());
        let openings = OpeningDrawing::all(plan, analysis, &rooms, &faces);
        for (i, opening) in openings.iter().enumerate() {
            for room in analysis.shapes.near(opening.bounds()) {
                rooms[room].openings.push(i);
            }
        }
        let cuts: Vec<_> = openings.iter().filter_map(|opening| opening.cut.clone()).collect();
        let solid = walls::without(walls.solid, cuts, grid.as_ref());
        // From here on, the remaining walls bound the space for room names.
        let faces = Faces::new(&solid, grid.as_ref());
        let (wall_tiles, walls_drawn): (Vec<usize>, Vec<WallDrawing>) = solid
            .iter()
            .enumerate()
            .flat_map(|(tile, shapes)| shapes.iter().map(move |shape| (tile, shape)))
            .filter_map(|(tile, shape)| {
                let (outer, holes) = shape.split_first()?;
                let holes = holes.iter().map(areas::points).collect();
                Some((tile, WallDrawing { outer: areas::points(outer), holes }))
            })
            .unzip();
        let bounds =
            walls_drawn.iter().fold(plan.bounds(), |bounds, wall| bounds.union(Bounds::of(wall.outer.iter().copied())));
        let bounds = openings.iter().fold(bounds, |bounds, opening| bounds.union(opening.bounds()));
        let dimensions = dimensions::lines(plan);
        let built = bounds;
        let bounds = bounds.union(dimensions::bounds(&dimensions));
        let graph = graph_edges(analysis, &rooms, &openings);
        let boundaries = without_openings(walls.boundaries, &openings);
        let tiles = grid.map(|grid| {
            let axis = |wall: &Wall| Some((plan.wall_segment(wall)?, wall.thickness_m));
            let mut axes: Vec<(Segment, f64)> = plan.walls().filter_map(|(_, wall)| axis(wall)).collect();
            // Boundaries of rooms that came without walls.
            let unwalled = walls.unwalled.iter().flat_map(|&room| rooms[room].rings());
            axes.extend(unwalled.flat_map(|ring| polygon::edges(ring)).map(|edge| (edge, 0.0)));
            let contents = Contents {
                rooms: &rooms,
                walls: &walls_drawn,
                wall_tiles: &wall_tiles,
                wall_lines: &walls.lines,
                boundaries: &boundaries,
                openings: &openings,
                graph: &graph,
                axes,
            };
            Tiles::new(grid, contents)
        });
        let bounds_of_rooms = rooms.iter().filter(|room| !room.outer.is_empty()).map(|room| room.bounds);
        let named_from_px_per_m = bounds_of_rooms.map(names::fits_from_px_per_m).fold(f64::INFINITY, f64::min);
        Self {
            meta: plan.meta().clone(),
            named_from_px_per_m,
            counts: counts(rooms.iter().map(|room| room.status)),
            predicted_counts: counts(rooms.iter().map(RoomDrawing::predicted_status)),
            rooms,
            walls: walls_drawn,
            wall_lines: walls.lines,
            boundaries,
            openings,
            graph,
            dimensions,
            faces,
            picture: None,
            tangled: walls.tangled,
            are_piled,
            caveat: String::new(),
            colours: analysis.colours.clone(),
            bounds,
            built,
            tiles,
        }
    }

    /// The same with a classifier's predictions for the rooms, all of them sure.
    #[must_use]
    pub fn with_predictions(mut self, labels: &BTreeMap<RoomId, Label>) -> Self {
        for room in &mut self.rooms {
            (room.predicted, room.sureness) = (labels.get(&room.id).copied(), 1.0);
        }
        self.predicted_counts = counts(self.rooms.iter().map(RoomDrawing::predicted_status));
        self
    }

    /// The same, fainter where a prediction is unsure: how sure each is, 0..=1.
    #[must_use]
    pub fn with_sureness(mut self, sureness: &BTreeMap<RoomId, f64>) -> Self {
        for room in &mut self.rooms {
            room.sureness = sureness.get(&room.id).copied().unwrap_or(1.0);
        }
        self
    }

    /// The same with a line below the title that says what to know before believing what is shown.
    #[must_use]
    pub fn with_caveat(mut self, caveat: &str) -> Self {
        caveat.clone_into(&mut self.caveat);
        self
    }

    /// The same with its backdrop. If nothing is drawn, the backdrop is all there is to see.
    #[must_use]
    pub fn with_picture(mut self, levels: Arc<PictureLevels>, backdrop: &Backdrop) -> Self {
        let [width, height] = levels.size_px().map(f64::from);
        let corners = [(0.0, 0.0), (width, 0.0), (0.0, height)];
        let corners = corners.map(|(x, y)| backdrop.plan_from_picture(Point::new(x, y)));
        let picture = PlacedPicture { levels, corners, opacity: backdrop.opacity.clamp(0.0, 1.0) };
        if self.bounds.is_empty() {
            self.bounds = picture.bounds();
        }
        self.picture = Some(picture);
        self
    }

    /// A remark on a simplified drawing: what crosses or overlaps so often that it was not worked out.
    pub fn remark(&self) -> Option<String> {
        let number = thousands(self.tangled as u64);
        let mut lines = format!("{number} walls or rooms cross each other so often that they are drawn as lines");
        let step = one_line_in(self.tangled);
        if step > 1 {
            lines.push_str(&format!(", one in {step} of them"));
        }
        let names = "so many rooms lie over each other that they are drawn without names";
        match (self.tangled > 0, self.are_piled) {
            (true, true) => Some(format!("{lines}, and {names}")),
            (true, false) => Some(lines),
            (false, true) => Some(names.to_owned()),
            (false, false) => None,
        }
    }

    /// The bounding box of all that is drawn, in metres.
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// The bounding box of rooms, walls and openings, without the dimension chains beside them, in metres.
    pub fn built_bounds(&self) -> Bounds {
        self.built
    }

    /// How a door's leaf is drawn; `None` for openings without a leaf. Openings are sorted by id.
    pub fn swing_of(&self, id: OpeningId) -> Option<Swing> {
        let index = self.openings.binary_search_by_key(&id, |opening| opening.id).ok()?;
        self.openings[index].swing()
    }

    /// What the leaves of doors swing through: hinge, end of the closed leaf, end of the open leaf.
    pub fn sweeps(&self) -> impl Iterator<Item = (OpeningId, [Point; 3])> + '_ {
        self.openings.iter().flat_map(|opening| opening.sweeps().map(|sweep| (opening.id, sweep)))
    }

    /// The openings as they are drawn, by id.
    pub fn placed_openings(&self) -> impl ExactSizeIterator<Item = PlacedOpening> + '_ {
        self.openings.iter().map(OpeningDrawing::placed)
    }

    /// The scene in a view. Only names are culled outside the view: panning at the same zoom just moves
    /// the rest.
    pub fn scene(&self, style: &Style, view: &View) -> Scene {
        let palette = style.palette();
        let groups = Layer::ALL.into_iter().flat_map(|layer| self.layer(layer, style, view)).collect();
        Scene { view: *view, background: palette.paper, groups }
    }

    /// One layer of the scene; empty if the style omits it. [`Layer::Sheet`] belongs to the page, not the
    /// plan, see [`super::sheet`].
    pub fn layer(&self, layer: Layer, style: &Style, view: &View) -> Vec<Group> {
        let layers = &style.layers;
        match layer {
            Layer::Picture => {
                let picture = self.picture.iter().cloned().map(Item::Picture);
                picture.map(|picture| Group::new(layer, Frame::Plan, vec![picture])).collect()
            }
            Layer::Grid if layers.grid => grid(style, view.px_per_m, view.bounds()),
            Layer::Rooms if layers.rooms => self.room_fills(style, view),
            Layer::Boundaries if layers.walls => self.boundary_lines(self.boundaries.iter().copied(), style),
            Layer::Walls if layers.walls => {
                self.wall_fills(self.walls.iter(), self.wall_lines.iter().copied(), style, view)
            }
            Layer::Openings if layers.openings => {
                let floors = self.fills(style);
                self.openings.iter().map(|opening| opening.group(style, view, &floors)).collect()
            }
            Layer::Graph if layers.graph => {
                let rooms = self.rooms.iter().filter(|room| !room.outer.is_empty());
                self.graph_marks(self.graph.iter(), rooms, style)
            }
            Layer::Dimensions if layers.dimensions => dimensions::groups(&self.dimensions, style, view),
            Layer::Names if layers.names || layers.areas => self.names(style, view),
            _ => Vec::new(),
        }
    }

    /// Indices of the tiles that meet a part of the plan; for a plan in one piece, the only tile.
    pub fn tiles_in(&self, seen: Bounds) -> Vec<usize> {
        match &self.tiles {
            None => vec![0],
            Some(tiles) => (0..tiles.all.len()).filter(|&tile| tiles.all[tile].bounds.intersects(seen)).collect(),
        }
    }

    /// Whether the plan is cut into tiles.
    pub fn is_in_tiles(&self) -> bool {
        self.tiles.is_some()
    }

    /// The number of rooms, walls and openings in a tile, as a measure of drawing time.
    pub fn elements_in(&self, tile: usize) -> usize {
        self.tile(tile).map_or(0, |tile| {
            tile.rooms.iter().map(Vec::len).sum::<usize>() + tile.axes.len() + 2 * tile.openings.len()
        })
    }

    /// The number of passes in which rooms are painted: rooms of one level are painted in all tiles
    /// before those of the next.
    pub fn levels(&self) -> usize {
        self.tiles.as_ref().map_or(1, |tiles| tiles.levels)
    }

    /// Whether a piece of a wall's outline is a cut between tiles rather than a real edge.
    pub fn is_cut(&self, a: Point, b: Point) -> bool {
        self.tiles.as_ref().is_some_and(|tiles| tiles.grid.is_cut(a, b))
    }

    fn tile(&self, tile: usize) -> Option<&Tile> {
        self.tiles.as_ref().and_then(|tiles| tiles.all.get(tile))
    }

    /// One layer of a tile; for rooms, those of one level. `fills` are [`Drawing::fills`].
    pub fn tile_layer(
        &self,
        tile: usize,
        layer: Layer,
        level: usize,
        fills: &[Rgba],
        style: &Style,
        view: &View,
    ) -> Vec<Group> {
        let Some(tile) = self.tile(tile) else { return self.layer(layer, style, view) };
        let layers = &style.layers;
        match layer {
            Layer::Rooms if layers.rooms => {
                let rooms = tile.rooms.get(level).map(Vec::as_slice).unwrap_or_default();
                rooms.iter().map(|&room| self.room_fill(room, fills, style, view)).collect()
            }
            Layer::Boundaries if layers.walls => {
                self.boundary_lines(tile.boundaries.iter().map(|&index| self.boundaries[index]), style)
            }
            Layer::Walls if layers.walls => {
                let walls = tile.walls.iter().map(|&index| &self.walls[index]);
                self.wall_fills(walls, tile.wall_lines.iter().map(|&index| self.wall_lines[index]), style, view)
            }
            Layer::Openings if layers.openings => {
                tile.openings.iter().map(|&opening| self.openings[opening].group(style, view, fills)).collect()
            }
            Layer::Graph if layers.graph => {
                let rooms = tile.rooms.iter().flatten().map(|&room| &self.rooms[room]);
                self.graph_marks(tile.graph.iter().map(|&edge| &self.graph[edge]), rooms, style)
            }
            _ => Vec::new(),
        }
    }

    /// A tile seen from afar, where doors are a few pixels wide: rooms as fills, walls as axes, each handed to `paint`.
    pub fn tile_from_afar(
        &self,
        tile: usize,
        layer: Layer,
        level: usize,
        fills: &[Rgba],
        style: &Style,
        view: &View,
        mut paint: impl FnMut(FromAfar<'_>),
    ) {
        let Some(tile) = self.tile(tile) else { return };
        let (layers, palette) = (&style.layers, style.palette());
        let mut line = |segment: Segment, colour: Rgba, width_px: f64| {
            paint(FromAfar::Line { segment, colour, width_px });
        };
        match layer {
            Layer::Rooms if layers.rooms => {
                for &room in tile.rooms.get(level).map(Vec::as_slice).unwrap_or_default() {
                    let RoomDrawing { outer, holes, .. } = &self.rooms[room];
                    paint(FromAfar::Fill { outer, holes, colour: fills[room] });
                }
            }
            Layer::Boundaries if layers.walls => {
                tile.boundaries.iter().for_each(|&index| line(self.boundaries[index], palette.boundary, 1.0));
            }
            Layer::Walls if layers.walls => {
                let width_px = |thickness_m: f64| (thickness_m * view.px_per_m).max(THINNEST_WALL_PX);
                tile.axes.iter().for_each(|&(axis, thickness_m)| line(axis, palette.wall, width_px(thickness_m)));
            }
            Layer::Graph if layers.graph => {
                for edge in tile.graph.iter().map(|&index| &self.graph[index]) {
                    line(Segment::new(edge.from, edge.through), palette.graph_edge, 1.5);
                    if let Ok(to) = edge.to {
                        line(Segment::new(edge.through, to), palette.graph_edge, 1.5);
                    }
                }
            }
            _ => {}
        }
    }

    /// Indices of the rooms visible in a view that are large enough for the smallest text.
    pub fn rooms_to_name(&self, view: &View) -> Vec<usize> {
        if self.are_piled || view.px_per_m < self.named_from_px_per_m {
            return Vec::new();
        }
        let seen = view.bounds();
        let is_meant = |&index: &usize| {
            let room = &self.rooms[index];
            !room.outer.is_empty() && room.bounds.intersects(seen) && names::may_fit(room, view)
        };
        match &self.tiles {
            None => (0..self.rooms.len()).filter(is_meant).collect(),
            Some(tiles) => {
                let near = self.tiles_in(seen).into_iter().flat_map(|tile| tiles.all[tile].rooms.iter().flatten());
                near.copied().filter(is_meant).collect()
            }
        }
    }

    /// The name of a room where it fits best; `None` if it fits nowhere. `fill` is the room's entry in
    /// [`Drawing::fills`]. Only the view's zoom matters.
    pub fn name(&self, room: usize, fill: Rgba, style: &Style, view: &View) -> Option<Group> {
        let around = Around { rooms: &self.rooms, openings: &self.openings, faces: &self.faces };
        names::group(&around, room, fill, style, view)
    }

    /// The fills by function: the scheme's own, or else the palette's.
    pub fn function_colours(&self, palette: &super::Palette) -> BTreeMap<String, Rgba> {
        let mut colours = palette.functions(self.rooms.iter().map(|room| room.function.as_str()));
        for (function, colour) in &mut colours {
            if let Some(&chosen) = self.colours.get(function) {
                *colour = palette.legible(chosen);
            }
        }
        colours
    }

    /// The fill colours of the rooms.
    pub fn fills(&self, style: &Style) -> Vec<Rgba> {
        let palette = style.palette();
        let functions = match style.fill {
            Fill::Function => self.function_colours(palette),
            Fill::Label | Fill::Prediction | Fill::None => BTreeMap::new(),
        };
        let fill = |room: &RoomDrawing| match style.fill {
            Fill::None => palette.paper,
            Fill::Label => palette.status(room.status),
            Fill::Prediction => predicted_fill(palette, room.predicted_status(), room.sureness),
            Fill::Function => {
                functions.get(&normalised_function(&room.function)).copied().unwrap_or(palette.unlabelled)
            }
        };
        self.rooms.iter().map(|room| fill(room).faded(style.fill_opacity)).collect()
    }

    fn room_fills(&self, style: &Style, view: &View) -> Vec<Group> {
        let fills = self.fills(style);
        let mut order: Vec<usize> = (0..self.rooms.len()).filter(|&i| !self.rooms[i].outer.is_empty()).collect();
        order.sort_by(|&p, &q| painting_order(&self.rooms, p, q));
        order.into_iter().map(|room| self.room_fill(room, &fills, style, view)).collect()
    }

    fn room_fill(&self, index: usize, fills: &[Rgba], style: &Style, view: &View) -> Group {
        let (room, fill) = (&self.rooms[index], fills[index]);
        let polygon = Item::Polygon { outer: room.outer.clone(), holes: room.holes.clone(), colour: fill };
        let mut items = vec![polygon];
        if let Some(known) = room.missed_label().filter(|_| style.fill == Fill::Prediction) {
            let colour = style.palette().label_strong(known).faded(style.fill_opacity);
            items.extend(room.hatch(view.px_per_m).into_iter().map(|line| Item::Line {
                points: line.to_vec(),
                closed: false,
                colour,
                width: Length::Px(HATCH_LINE_PX),
                dash: None,
            }));
        }
        let title = room_title(room);
        Group { element: room.id.to_string(), title, ..Group::new(Layer::Rooms, Frame::Plan, items) }
    }

    fn boundary_lines(&self, boundaries: impl Iterator<Item = Segment>, style: &Style) -> Vec<Group> {
        let items: Vec<Item> = boundaries
            .map(|segment| Item::Line {
                points: vec![segment.a, segment.b],
                closed: false,
                colour: style.palette().boundary,
                width: Length::Px(1.0),
                dash: None,
            })
            .collect();
        if items.is_empty() { Vec::new() } else { vec![Group::new(Layer::Boundaries, Frame::Plan, items)] }
    }

    fn wall_fills<'a>(
        &self,
        walls: impl Iterator<Item = &'a WallDrawing> + Clone,
        lines: impl Iterator<Item = Segment>,
        style: &Style,
        view: &View,
    ) -> Vec<Group> {
        let colour = style.palette().wall;
        let mut items: Vec<Item> = Vec::new();
        for wall in walls.clone() {
            items.push(Item::Polygon { outer: wall.outer.clone(), holes: wall.holes.clone(), colour });
        }
        // Walls too thin to see at this zoom get a rim.
        let rim_px = THINNEST_WALL_PX - TYPICAL_WALL_M * view.px_per_m;
        if rim_px > 0.0 {
            let width = Length::Px(rim_px);
            for ring in walls.flat_map(|wall| std::iter::once(&wall.outer).chain(&wall.holes)) {
                for (points, closed) in self.uncut(ring) {
                    items.push(Item::Line { points, closed, colour, width, dash: None });
                }
            }
        }
        for segment in lines {
            items.push(Item::Line {
                points: vec![segment.a, segment.b],
                closed: false,
                colour,
                width: Length::Px(THINNEST_WALL_PX),
                dash: None,
            });
        }
        if items.is_empty() { Vec::new() } else { vec![Group::new(Layer::Walls, Frame::Plan, items)] }
    }

    /// The stretches of a wall's outline between cuts, and whether it is uncut.
    fn uncut(&self, ring: &[Point]) -> Vec<(Vec<Point>, bool)> {
        let n = ring.len();
        let is_cut = |i: usize| self.is_cut(ring[i % n], ring[(i + 1) % n]);
        let Some(first) = (0..n).find(|&i| self.tiles.is_some() && is_cut(i)) else {
            return vec![(ring.to_vec(), true)];
        };
        let mut stretches = Vec::new();
        let mut stretch = Vec::new();
        for i in first + 1..=first + n {
            stretch.push(ring[i % n]);
            if is_cut(i) {
                stretches.push((std::mem::take(&mut stretch), false));
            }
        }
        stretches.retain(|(points, _)| points.len() > 1);
        stretches
    }

    fn graph_marks<'a>(
        &self,
        edges: impl Iterator<Item = &'a GraphEdge>,
        rooms: impl Iterator<Item = &'a RoomDrawing>,
        style: &Style,
    ) -> Vec<Group> {
        let palette = style.palette();
        let mut items = Vec::new();
        let line = |points: Vec<Point>| Item::Line {
            points,
            closed: false,
            colour: palette.graph_edge,
            width: Length::Px(1.5),
            dash: None,
        };
        for edge in edges {
            match edge.to {
                Ok(to) => items.push(line(vec![edge.from, edge.through, to])),
                Err(outward) => {
                    let end = edge.through + outward * STUB_M;
                    items.push(line(vec![edge.from, edge.through, end]));
                    items.push(Item::Disc {
                        centre: end,
                        radius: Length::Px(3.5),
                        fill: Some(palette.paper),
                        outline: Some((palette.graph_edge, Length::Px(1.5))),
                    });
                }
            }
        }
        for room in rooms {
            let fill = match room.status {
                RoomStatus::Labelled(label) => palette.label_strong(label),
                RoomStatus::NotClassified | RoomStatus::Unlabelled => palette.ink_muted,
            };
            items.push(Item::Disc {
                centre: room.centre,
                radius: Length::Px(NODE_RADIUS_PX),
                fill: Some(fill),
                outline: Some((palette.paper, Length::Px(1.5))),
            });
        }
        vec![Group::new(Layer::Graph, Frame::Plan, items)]
    }

    /// The names of all visible rooms.
    fn names(&self, style: &Style, view: &View) -> Vec<Group> {
        let floors = self.fills(style);
        let around = Around { rooms: &self.rooms, openings: &self.openings, faces: &self.faces };
        let rooms = self.rooms_to_name(view).into_iter();
        rooms.filter_map(|room| names::group(&around, room, floors[room], style, view)).collect()
    }

    /// The numbers of rooms with each label, without a label, and not classified.
    pub fn counts(&self) -> ([usize; 5], usize, usize) {
        self.counts
    }

    /// The same by predicted label.
    pub fn predicted_counts(&self) -> ([usize; 5], usize, usize) {
        self.predicted_counts
    }

    /// The number of rooms whose known label differs from the predicted one.
    pub fn missed(&self) -> usize {
        self.rooms.iter().filter(|room| room.missed_label().is_some()).count()
    }
}

/// The fill of a room by its predicted label: the surer the prediction, the more of the label's colour.
pub fn predicted_fill(palette: &Palette, status: RoomStatus, sureness: f64) -> Rgba {
    let full = palette.status(status);
    match status {
        RoomStatus::Labelled(_) => {
            let share = ((sureness - FAINTEST) / (FULL - FAINTEST)).clamp(0.0, 1.0);
            palette.paper.mixed(full, LEAST_COLOUR + (1.0 - LEAST_COLOUR) * share)
        }
        RoomStatus::NotClassified | RoomStatus::Unlabelled => full,
    }
}

fn counts(statuses: impl Iterator<Item = RoomStatus>) -> Counts {
    let mut counts: Counts = ([0; 5], 0, 0);
    for status in statuses {
        match status {
            RoomStatus::Labelled(label) => counts.0[label.index()] += 1,
            RoomStatus::Unlabelled => counts.1 += 1,
            RoomStatus::NotClassified => counts.2 += 1,
        }
    }
    counts
}

/// How far an edge to the outside extends past its opening, in metres: beyond the wall.
const STUB_M: f64 = 0.9;

/// The minimum drawn thickness of a wall, in pixels.
const THINNEST_WALL_PX: f64 = 1.5;

/// A typical thin wall's thickness in metres: walls this thick are drawn true to scale.
const TYPICAL_WALL_M: f64 = 0.1;

/// The grid over part of the plan.
pub(super) fn grid(style: &Style, px_per_m: f64, seen: Bounds) -> Vec<Group> {
    let palette = style.palette();
    let Some(Grid { step_m, lines }) = style.grid(px_per_m) else { return Vec::new() };
    let mut items = Vec::new();
    let mut line = |from: Point, to: Point, index: i64| {
        let colour = if index % lines == 0 { palette.grid_major } else { palette.grid };
        items.push(Item::Line { points: vec![from, to], closed: false, colour, width: Length::Px(1.0), dash: None });
    };
    let indices = |low: f64, high: f64| (low / step_m).ceil() as i64..=(high / step_m).floor() as i64;
    for i in indices(seen.min.x, seen.max.x) {
        let x = i as f64 * step_m;
        line(Point::new(x, seen.min.y), Point::new(x, seen.max.y), i);
    }
    for i in indices(seen.min.y, seen.max.y) {
        let y = i as f64 * step_m;
        line(Point::new(seen.min.x, y), Point::new(seen.max.x, y), i);
    }
    vec![Group::new(Layer::Grid, Frame::Plan, items)]
}

/// A room in one line: 'Library: reading room, big room, 84.2 m² clear'.
fn room_title(room: &RoomDrawing) -> String {
    let label = match room.status {
        RoomStatus::Labelled(label) => label.name(),
        RoomStatus::NotClassified => "not classified",
        RoomStatus::Unlabelled => "no label",
    };
    let function = function_title(&room.function);
    let head = match (room.name.is_empty(), function.is_empty()) {
        (true, true) => "Room".to_owned(),
        (true, false) => function,
        (false, true) => room.name.clone(),
        (false, false) => format!("{}: {}", room.name, normalised_function(&room.function)),
    };
    let clear = if room.has_walls { " clear" } else { "" };
    format!("{head}, {label}, {}{clear}", Units::Metric.area(room.clear_m2))
}

/// The parts of boundaries that remain beside openings that are in no wall.
fn without_openings(mut boundaries: Vec<Segment>, openings: &[OpeningDrawing]) -> Vec<Segment> {
    // An opening given for a boundary lies on it up to rounding.
    const ON_IT_M: f64 = 0.05;
    for opening in openings.iter().filter(|opening| opening.cut.is_none()) {
        let gap = opening.segment();
        let mut left = Vec::with_capacity(boundaries.len() + 1);
        for boundary in boundaries {
            let length = boundary.length();
            let (p, q) = (boundary.nearest_fraction(gap.a), boundary.nearest_fraction(gap.b));
            let (from, to) = (p.min(q), p.max(q));
            let middle = boundary.a.lerp(boundary.b, (from + to) / 2.0);
            let along = gap.vector().cross(boundary.vector()).abs() <= ON_IT_M * gap.length() * length;
            if !along || (to - from) * length < ON_IT_M || gap.distance(middle) > ON_IT_M {
                left.push(boundary);
                continue;
            }
            if from * length > ON_IT_M {
                left.push(Segment::new(boundary.a, boundary.a.lerp(boundary.b, from)));
            }
            if (1.0 - to) * length > ON_IT_M {
                left.push(Segment::new(boundary.a.lerp(boundary.b, to), boundary.b));
            }
        }
        boundaries = left;
    }
    boundaries
}

fn graph_edges(analysis: &Analysis, rooms: &[RoomDrawing], openings: &[OpeningDrawing]) -> Vec<GraphEdge> {
    let room = |joint: Joint| rooms.get(analysis.shapes.index_of(joint.room()?)?).filter(|room| !room.outer.is_empty());
    let mut edges = Vec::new();
    for connection in analysis.graph.connections() {
        // Both are sorted by id, like the plan's openings.
        let Ok(index) = openings.binary_search_by_key(&connection.opening, |opening| opening.id) else { continue };
        let opening = &openings[index];
        let (first, second) = match connection.sides.map(room) {
            [Some(first), Some(second)] if first.id == second.id => continue,
            [Some(first), second] => (first, second),
            [None, Some(second)] => (second, None),
            [None, None] => continue,
        };
        let to = second.map(|second| second.centre).ok_or_else(|| {
            let normal = opening.normal();
            if (first.centre - opening.centre).dot(normal) > 0.0 { -normal } else { normal }
        });
        edges.push(GraphEdge { from: first.centre, through: opening.centre, to });
    }
    edges
}
