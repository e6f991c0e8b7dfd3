//! Paints the scene of a plan with egui: triangles made once a zoom level, moved while panning.

use crate::app::paint::places::on_screen;
use std::collections::{BTreeMap, HashMap};
use std::hash::Hasher as _;
use std::sync::Arc;

use egui::epaint::{CircleShape, Mesh, TessellationOptions, Tessellator, TextShape, Vertex, WHITE_UV};
use egui::{Color32, FontFamily, FontId, Painter, Pos2, Rect, Shape, Stroke, Vec2, pos2, vec2};

use crate::app::look::theme;
use crate::app::session::document::Derived;
use crate::draw::scene::arc_points;
use crate::draw::{Anchor, Group, Item, Layer, Length, Rgba, Style, Text, View, Weight};
use crate::geometry::Point;

/// The layers that only move while panning, in their order.
const SHAPE_LAYERS: [Layer; 5] = [Layer::Rooms, Layer::Boundaries, Layer::Walls, Layer::Openings, Layer::Graph];

/// A piece of the scene is passed over as a whole when it lies outside the view.
const CHUNK_VERTICES: usize = 20_000;

/// A scene with more corners is not made anew for every frame of a zoom but scaled until the zoom
/// rests: making it would take longer than a frame.
const HEAVY_VERTICES: usize = 60_000;

/// The cosine of the turn, 120 degrees, up to which corners of lines are mitred.
const SHARPEST_MITRE: f32 = -0.5;

/// With more rooms, names are not placed anew for every frame of a gesture.
const MANY_NAMES: usize = 60;

/// Of a large plan so many names are placed in a frame, the others in the next ones.
const NAMES_A_FRAME: usize = 80;

/// Zooming further than this from where the triangles were made shows the scaled edges' blur.
const SCALED_AT_MOST: f64 = 1.6;

/// When more elements of a large plan are in sight, it is drawn as seen from afar.
const MOST_IN_DETAIL: usize = 7000;

/// Triangles start so many points from where the view was at most: further off, numbers of 32 bits are
/// not exact to a hundredth of a pixel.
const FAR_PX: f64 = 60_000.0;

/// Tiles out of sight are kept while all have no more corners than this: 60 MB.
const KEPT_VERTICES: usize = 1_500_000;

/// Tiles are made this many points before they come into sight.
const AHEAD_PX: f64 = 8.0;

/// Paints a plan, keeping what can be used again.
#[derive(Default)]
pub(crate) struct ScenePainter {
    shapes: Option<Shapes>,
    names: Option<Names>,
    /// Triangles of each polygon, by a hash of its points: they do not change with zoom and style.
    triangles: HashMap<u64, Vec<u32>>,
    last_view: Option<View>,
}

/// The triangles of everything but names at a zoom level.
struct Shapes {
    derived: Arc<Derived>,
    style: Style,
    fills: Vec<Rgba>,
    /// The view they were made for; its centre is where the triangles' coordinates start.
    view: View,
    is_from_afar: bool,
    /// By tile, as far as they have been in sight.
    tiles: BTreeMap<usize, TileShapes>,
    vertices: usize,
    /// Where they were put last.
    placed: Option<Placed>,
}

/// A tile's triangles, by layer and level of rooms.
#[derive(Default)]
struct TileShapes {
    parts: BTreeMap<(usize, usize), Vec<Chunk>>,
    vertices: usize,
}

struct Chunk {
    mesh: Mesh,
    bounds: Rect,
}

struct Placed {
    origin: Pos2,
    scale: f32,
    clip: Rect,
    shapes: Vec<Shape>,
}

struct Names {
    derived: Arc<Derived>,
    style: Style,
    view: View,
    fills: Vec<Rgba>,
    /// The rooms in sight.
    rooms: Vec<usize>,
    /// What was placed at this zoom, by room.
    placed: HashMap<usize, Option<Group>>,
}

impl Names {
    /// The texts in sight.
    fn texts(&self) -> impl Iterator<Item = &Text> + '_ {
        let groups = self.rooms.iter().filter_map(|room| self.placed.get(room)?.as_ref());
        groups
            .flat_map(|group| &group.items)
            .filter_map(|item| if let Item::Text(text) = item { Some(text) } else { None })
    }
}

impl ScenePainter {
    /// Paints a plan in `rect`, whose view is `view`. Asks for another frame when it has put off
    /// something.
    pub(crate) fn paint(&mut self, painter: &Painter, rect: Rect, derived: &Arc<Derived>, style: &Style, view: &View) {
        let is_moving = self.last_view.is_some_and(|last| last != *view);
        self.last_view = Some(*view);
        if is_moving {
            painter.ctx().request_repaint();
        }
        self.update_shapes(derived, style, view, is_moving);
        if self.update_names(derived, style, view, is_moving) {
            painter.ctx().request_repaint();
        }
        for group in derived.drawing.layer(Layer::Grid, style, view) {
            paint_grid(painter, rect, view, &group);
        }
        if let Some(shapes) = &mut self.shapes {
            painter.extend(shapes.placed_in(rect, view, painter.clip_rect()).iter().cloned());
        }
        if let Some(names) = &self.names {
            for text in names.texts() {
                paint_text(painter, rect, view, text);
            }
        }
    }

    /// Where the names stand on the screen.
    pub(crate) fn text_boxes(&self, rect: Rect, view: &View) -> Vec<Rect> {
        let boxed = |text: &Text| {
            let width = crate::draw::font::Font::of(text.weight).width_px(&text.content, text.size_px) as f32;
            let height = text.size_px as f32;
            let at = on_screen(rect, view, text.at) + vec2(text.offset_px.x as f32, text.offset_px.y as f32);
            // From the baseline up.
            if text.upright {
                Rect::from_min_max(at - vec2(height, width / 2.0), at + vec2(0.0, width / 2.0))
            } else {
                Rect::from_min_max(at - vec2(width / 2.0, height), at + vec2(width / 2.0, 0.0))
            }
        };
        self.names.iter().flat_map(Names::texts).map(boxed).collect()
    }

    fn update_shapes(&mut self, derived: &Arc<Derived>, style: &Style, view: &View, is_moving: bool) {
        let drawing = &derived.drawing;
        let seen =
            View { width_px: view.width_px + 2.0 * AHEAD_PX, height_px: view.height_px + 2.0 * AHEAD_PX, ..*view };
        let seen = drawing.tiles_in(seen.bounds());
        let elements: usize = seen.iter().map(|&tile| drawing.elements_in(tile)).sum();
        let is_usable = |shapes: &Shapes| {
            let scale = view.px_per_m / shapes.view.px_per_m;
            let is_near = (1.0 / SCALED_AT_MOST..=SCALED_AT_MOST).contains(&scale);
            // What is seen from afar has no edges to blur.
            let can_wait = is_near && (shapes.is_from_afar || (is_moving && shapes.vertices > HEAVY_VERTICES));
            let same_zoom = scale == 1.0 || can_wait;
            let same_pixels = shapes.view.pixel_ratio == view.pixel_ratio;
            // Neither flickers to and fro at the limit.
            let same_detail = if shapes.is_from_afar {
                elements * 5 > MOST_IN_DETAIL * 4
            } else {
                elements * 4 <= MOST_IN_DETAIL * 5
            };
            let offset = (shapes.view.centre - view.centre) * shapes.view.px_per_m;
            let is_exact = !drawing.is_in_tiles() || offset.length() < FAR_PX;
            Arc::ptr_eq(&shapes.derived, derived)
                && shapes.style == *style
                && same_zoom
                && same_pixels
                && (same_detail || !drawing.is_in_tiles())
                && is_exact
        };
        if !self.shapes.as_ref().is_some_and(is_usable) {
            if self.shapes.as_ref().is_some_and(|shapes| !Arc::ptr_eq(&shapes.derived, derived)) {
                self.triangles.clear();
            }
            self.shapes = Some(Shapes {
                derived: derived.clone(),
                style: style.clone(),
                fills: drawing.fills(style),
                view: *view,
                is_from_afar: drawing.is_in_tiles() && elements > MOST_IN_DETAIL,
                tiles: BTreeMap::new(),
                vertices: 0,
                placed: None,
            });
        }
        let Some(shapes) = &mut self.shapes else { return };
        if shapes.vertices > KEPT_VERTICES && seen.iter().any(|tile| !shapes.tiles.contains_key(tile)) {
            shapes.tiles.retain(|tile, _| seen.binary_search(tile).is_ok());
            shapes.vertices = shapes.tiles.values().map(|tile| tile.vertices).sum();
            self.triangles.clear();
        }
        for tile in seen {
            if !shapes.tiles.contains_key(&tile) {
                let made = shapes.make(tile, &mut self.triangles);
                shapes.vertices += made.vertices;
                shapes.tiles.insert(tile, made);
                shapes.placed = None;
            }
        }
    }

    /// Gives whether some names are still to be placed.
    fn update_names(&mut self, derived: &Arc<Derived>, style: &Style, view: &View, is_moving: bool) -> bool {
        if !style.layers.names && !style.layers.areas {
            self.names = None;
            return false;
        }
        let drawing = &derived.drawing;
        let same_plan = |names: &&mut Names| Arc::ptr_eq(&names.derived, derived) && names.style == *style;
        let same_zoom =
            |names: &Names| names.view.px_per_m == view.px_per_m && names.view.pixel_ratio == view.pixel_ratio;
        let names = match self.names.as_mut().filter(same_plan) {
            Some(names) => {
                if !same_zoom(names) {
                    if is_moving && derived.analysis.rooms.len() > MANY_NAMES {
                        return false;
                    }
                    names.placed.clear();
                }
                names
            }
            None => self.names.insert(Names {
                derived: derived.clone(),
                style: style.clone(),
                view: *view,
                fills: drawing.fills(style),
                rooms: Vec::new(),
                placed: HashMap::new(),
            }),
        };
        names.view = *view;
        names.rooms = drawing.rooms_to_name(view);
        let most = if drawing.is_in_tiles() { NAMES_A_FRAME } else { usize::MAX };
        let missing: Vec<usize> = names.rooms.iter().copied().filter(|room| !names.placed.contains_key(room)).collect();
        for &room in missing.iter().take(most) {
            let group = drawing.name(room, names.fills[room], style, view);
            names.placed.insert(room, group);
        }
        missing.len() > most
    }
}

impl Shapes {
    /// The triangles of a tile.
    fn make(&self, tile: usize, triangles: &mut HashMap<u64, Vec<u32>>) -> TileShapes {
        let drawing = &self.derived.drawing;
        let mut made = TileShapes::default();
        for (place, layer) in SHAPE_LAYERS.into_iter().enumerate() {
            let levels = if layer == Layer::Rooms { drawing.levels() } else { 1 };
            for level in 0..levels {
                let mut writer = Writer::new(&self.view);
                if self.is_from_afar {
                    for item in drawing.tile_from_afar(tile, layer, level, &self.fills, &self.style, &self.view) {
                        writer.item_from_afar(&item);
                    }
                } else {
                    let is_cut = |a: Point, b: Point| layer == Layer::Walls && drawing.is_cut(a, b);
                    for group in drawing.tile_layer(tile, layer, level, &self.fills, &self.style, &self.view) {
                        for item in &group.items {
                            if let Item::Polygon { outer, holes, colour } = item {
                                let key = hash(outer, holes);
                                let triangles = triangles.entry(key).or_insert_with(|| earcut(outer, holes));
                                writer.polygon_cut(outer, holes, triangles, theme::colour(*colour), &is_cut);
                            } else {
                                writer.item(item);
                            }
                        }
                    }
                }
                let chunks = writer.finish();
                made.vertices += chunks.iter().map(|chunk| chunk.mesh.vertices.len()).sum::<usize>();
                if !chunks.is_empty() {
                    made.parts.insert((place, level), chunks);
                }
            }
        }
        made
    }

    /// The triangles at their place for a view.
    fn placed_in(&mut self, rect: Rect, view: &View, clip: Rect) -> &[Shape] {
        let origin = on_screen(rect, view, self.view.centre);
        let scale = (view.px_per_m / self.view.px_per_m) as f32;
        let is_there = self
            .placed
            .as_ref()
            .is_some_and(|placed| placed.origin == origin && placed.scale == scale && placed.clip == clip);
        if !is_there {
            let mut shapes = Vec::new();
            for (place, layer) in SHAPE_LAYERS.into_iter().enumerate() {
                let levels = if layer == Layer::Rooms { self.derived.drawing.levels() } else { 1 };
                for part in (0..levels).map(|level| (place, level)) {
                    let chunks = self.tiles.values().filter_map(|tile| tile.parts.get(&part)).flatten();
                    shapes.extend(chunks.filter_map(|chunk| chunk.placed(origin, scale, clip)));
                }
            }
            self.placed = Some(Placed { origin, scale, clip, shapes });
        }
        self.placed.as_ref().map(|placed| placed.shapes.as_slice()).unwrap_or_default()
    }
}

impl Chunk {
    /// The triangles moved and scaled; `None` where they are out of sight.
    fn placed(&self, origin: Pos2, scale: f32, clip: Rect) -> Option<Shape> {
        let bounds =
            Rect::from_min_max(origin + self.bounds.min.to_vec2() * scale, origin + self.bounds.max.to_vec2() * scale);
        if !bounds.intersects(clip) {
            return None;
        }
        let moved = |vertex: &Vertex| Vertex { pos: origin + vertex.pos.to_vec2() * scale, ..*vertex };
        let vertices = self.mesh.vertices.iter().map(moved).collect();
        Some(Shape::mesh(Mesh { indices: self.mesh.indices.clone(), vertices, texture_id: self.mesh.texture_id }))
    }
}

/// The corners of a polygon's triangles, as indices into its points, rings one after the other.
pub(crate) fn earcut(outer: &[Point], holes: &[Vec<Point>]) -> Vec<u32> {
    let mut starts: Vec<u32> = Vec::new();
    let mut count = outer.len();
    for hole in holes {
        starts.push(count as u32);
        count += hole.len();
    }
    let points = outer.iter().chain(holes.iter().flatten()).map(|point| [point.x, point.y]);
    let mut triangles = Vec::new();
    earcut::Earcut::new().earcut(points, &starts, &mut triangles);
    triangles
}

/// A number that tells polygons apart.
fn hash(outer: &[Point], holes: &[Vec<Point>]) -> u64 {
    // SipHash with fixed keys: the same on every run, and two polygons of a plan never meet.
    let mut hasher = std::collections::hash_map::DefaultHasher::new();
    for ring in std::iter::once(outer).chain(holes.iter().map(Vec::as_slice)) {
        hasher.write_usize(ring.len());
        for point in ring {
            hasher.write_u64(point.x.to_bits());
            hasher.write_u64(point.y.to_bits());
        }
    }
    hasher.finish()
}

/// A polygon with holes as a mesh with soft edges, for marks over the plan.
pub(crate) fn polygon_mesh(
    rect: Rect,
    view: &View,
    outer: &[Point],
    holes: &[Vec<Point>],
    triangles: &[u32],
    colour: Color32,
) -> Mesh {
    let mut writer = Writer::new(view);
    writer.polygon(outer, holes, triangles, colour);
    let mut mesh = Mesh::default();
    for chunk in writer.finish() {
        mesh.append(chunk.mesh);
    }
    mesh.translate(on_screen(rect, view, view.centre).to_vec2());
    mesh
}

/// The outline of a ring as a mesh, for marks over the plan.
pub(crate) fn outline_mesh(rect: Rect, view: &View, ring: &[Point], stroke: Stroke) -> Mesh {
    let mut writer = Writer::new(view);
    let points = ring.iter().map(|&point| writer.place(point)).collect();
    writer.path(points, true, stroke);
    let mut mesh = writer.mesh;
    mesh.translate(on_screen(rect, view, view.centre).to_vec2());
    mesh
}

/// Writes shapes as triangles with feathered edges. Coordinates are egui's points from the view's
/// centre.
struct Writer<'a> {
    view: &'a View,
    tessellator: Tessellator,
    /// Width of the soft rim along edges: a physical pixel.
    feather: f32,
    mesh: Mesh,
    chunks: Vec<Chunk>,
}

impl<'a> Writer<'a> {
    fn new(view: &'a View) -> Self {
        let pixels_per_point = view.pixel_ratio as f32;
        let options = TessellationOptions {
            // The place on the screen is not known yet.
            round_line_segments_to_pixels: false,
            round_rects_to_pixels: false,
            prerasterized_discs: false,
            coarse_tessellation_culling: false,
            ..TessellationOptions::default()
        };
        let tessellator = Tessellator::new(pixels_per_point, options, [1, 1], Vec::new());
        Self { view, tessellator, feather: 1.0 / pixels_per_point, mesh: Mesh::default(), chunks: Vec::new() }
    }

    fn finish(mut self) -> Vec<Chunk> {
        self.end_chunk();
        self.chunks
    }

    fn end_chunk(&mut self) {
        let mesh = std::mem::take(&mut self.mesh);
        if !mesh.is_empty() {
            self.chunks.push(Chunk { bounds: mesh.calc_bounds(), mesh });
        }
    }

    fn place(&self, point: Point) -> Pos2 {
        let from_centre = (point - self.view.centre) * self.view.px_per_m;
        pos2(from_centre.x as f32, -from_centre.y as f32)
    }

    fn stroke(&self, width: Length, colour: Rgba) -> Stroke {
        Stroke::new(self.view.px(width) as f32, theme::colour(colour))
    }

    fn item(&mut self, item: &Item) {
        match item {
            // Polygons come with their triangles, texts are painted for each frame.
            // The window has the picture in tiles of its own.
            Item::Polygon { .. } | Item::Text(_) | Item::Picture(_) => {}
            Item::Line { points, closed, colour, width, dash } => {
                let mut points: Vec<Pos2> = points.iter().map(|&point| self.place(point)).collect();
                let stroke = self.stroke(*width, *colour);
                match dash {
                    None => self.path(points, *closed, stroke),
                    Some(dash) => {
                        if *closed {
                            points.extend(points.first().copied());
                        }
                        let (length, gap) = (self.view.px(dash.dash) as f32, self.view.px(dash.gap) as f32);
                        // Dashes shorter than a pixel are a line, not a million dashes.
                        if length < self.feather {
                            self.path(points, false, stroke);
                        } else {
                            for shape in Shape::dashed_line(&points, stroke, length, gap.max(self.feather)) {
                                if let Shape::LineSegment { points, stroke } = shape {
                                    self.path(points.to_vec(), false, stroke);
                                }
                            }
                        }
                    }
                }
            }
            Item::Arc { centre, from, to, colour, width } => {
                let radius_px = centre.distance(*from) * self.view.px_per_m;
                // Chords that stay within a tenth of a pixel of the arc: their number grows with the
                // root of the radius.
                let halvings = ((radius_px.max(1.0).sqrt() * 4.0).log2().ceil() as u32).clamp(2, 7);
                let points = arc_points(*centre, *from, *to, halvings);
                let points = points.into_iter().map(|point| self.place(point)).collect();
                let stroke = self.stroke(*width, *colour);
                self.path(points, false, stroke);
            }
            Item::Disc { centre, radius, fill, outline } => {
                let shape = CircleShape {
                    center: self.place(*centre),
                    radius: self.view.px(*radius) as f32,
                    fill: fill.map_or(Color32::TRANSPARENT, theme::colour),
                    stroke: outline.map_or(Stroke::NONE, |(colour, width)| self.stroke(width, colour)),
                };
                self.tessellator.tessellate_circle(shape, &mut self.mesh);
            }
        }
        if self.mesh.vertices.len() > CHUNK_VERTICES {
            self.end_chunk();
        }
    }

    /// A line along points, with soft sides. Corners are mitred; sharp ones, and the hairpins that
    /// joined walls may have, are cut off.
    fn path(&mut self, mut points: Vec<Pos2>, closed: bool, stroke: Stroke) {
        if stroke.width <= 0.0 || stroke.color == Color32::TRANSPARENT {
            return;
        }
        // Points closer than a hundredth of a pixel give no direction.
        points.dedup_by(|p, q| p.distance(*q) < self.feather * 0.01);
        let closed = closed && points.len() > 2;
        if closed && points.first().zip(points.last()).is_some_and(|(p, q)| p.distance(*q) < self.feather * 0.01) {
            points.pop();
        }
        let n = points.len();
        if n < 2 {
            return;
        }
        // What is thinner than a pixel is as wide and fainter.
        let colour = stroke.color.gamma_multiply((stroke.width / self.feather).min(1.0));
        let outer = stroke.width.max(self.feather) / 2.0 + self.feather / 2.0;
        let inner = outer - self.feather;
        let normal = |i: usize| (points[(i + 1) % n] - points[i % n]).normalized().rot90();
        let first = self.mesh.vertices.len() as u32;
        let mut stations = 0;
        let mut station = |mesh: &mut Mesh, at: Pos2, across: Vec2| {
            for (distance, color) in
                [(-outer, Color32::TRANSPARENT), (-inner, colour), (inner, colour), (outer, Color32::TRANSPARENT)]
            {
                mesh.vertices.push(Vertex { pos: at + across * distance, uv: WHITE_UV, color });
            }
            stations += 1;
        };
        for (i, &point) in points.iter().enumerate() {
            let (before, after) = match (closed, i) {
                (false, 0) => (normal(0), normal(0)),
                (false, i) if i == n - 1 => (normal(i - 1), normal(i - 1)),
                (_, i) => (normal(i + n - 1), normal(i)),
            };
            let cosine = before.dot(after);
            if cosine > SHARPEST_MITRE {
                station(&mut self.mesh, point, (before + after) / (1.0 + cosine));
            } else {
                station(&mut self.mesh, point, before);
                station(&mut self.mesh, point, after);
            }
        }
        let pieces = if closed { stations } else { stations - 1 };
        for piece in 0..pieces {
            let (p, q) = (first + 4 * piece, first + 4 * ((piece + 1) % stations));
            for strip in 0..3 {
                let (a, b) = (p + strip, q + strip);
                self.mesh.indices.extend([a, b, a + 1, a + 1, b, b + 1]);
            }
        }
    }

    /// A part of what is seen from afar: fills without soft edges, which walls cover, and lines.
    fn item_from_afar(&mut self, item: &Item) {
        match item {
            Item::Polygon { outer, holes, colour } => {
                let first = self.mesh.vertices.len() as u32;
                let color = theme::colour(*colour);
                for &point in outer.iter().chain(holes.iter().flatten()) {
                    self.mesh.vertices.push(Vertex { pos: self.place(point), uv: WHITE_UV, color });
                }
                // Nearly all rooms are.
                if outer.len() == 4 && holes.is_empty() && is_convex(outer) {
                    self.mesh.indices.extend([0, 1, 2, 0, 2, 3].map(|corner| first + corner));
                } else {
                    self.mesh.indices.extend(earcut(outer, holes).into_iter().map(|corner| first + corner));
                }
            }
            Item::Line { points, colour, width, .. } => {
                let stroke = self.stroke(*width, *colour);
                for ends in points.windows(2) {
                    self.line_from_afar(self.place(ends[0]), self.place(ends[1]), stroke);
                }
            }
            Item::Arc { .. } | Item::Disc { .. } | Item::Text(_) | Item::Picture(_) => {}
        }
    }

    /// A line that fades from its middle to both sides, with two thirds of the corners of a whole one; as
    /// much of it as its width says is seen.
    fn line_from_afar(&mut self, from: Pos2, to: Pos2, stroke: Stroke) {
        let across = (to - from).normalized().rot90() * stroke.width.max(self.feather);
        let color = stroke.color.gamma_multiply((stroke.width / self.feather).min(1.0));
        let first = self.mesh.vertices.len() as u32;
        for at in [from, to] {
            for (side, color) in [(-1.0, Color32::TRANSPARENT), (0.0, color), (1.0, Color32::TRANSPARENT)] {
                self.mesh.vertices.push(Vertex { pos: at + across * side, uv: WHITE_UV, color });
            }
        }
        self.mesh.indices.extend([0, 3, 1, 1, 3, 4, 1, 4, 2, 2, 4, 5].map(|corner| first + corner));
    }

    /// A filled polygon: its triangles, drawn half a pixel in, and a rim that fades out.
    fn polygon(&mut self, outer: &[Point], holes: &[Vec<Point>], triangles: &[u32], colour: Color32) {
        self.polygon_cut(outer, holes, triangles, colour, &|_, _| false);
    }

    /// The same for a piece of a polygon, without a rim where it `is_cut` from the next piece.
    fn polygon_cut(
        &mut self,
        outer: &[Point],
        holes: &[Vec<Point>],
        triangles: &[u32],
        colour: Color32,
        is_cut: &dyn Fn(Point, Point) -> bool,
    ) {
        if colour == Color32::TRANSPARENT {
            return;
        }
        let first = self.mesh.vertices.len() as u32;
        let rings = std::iter::once(outer).chain(holes.iter().map(Vec::as_slice));
        // Inner and outer rim of a corner follow each other.
        for (index, ring) in rings.enumerate() {
            let points: Vec<Pos2> = ring.iter().map(|&point| self.place(point)).collect();
            let cut: Vec<bool> = (0..ring.len()).map(|i| is_cut(ring[i], ring[(i + 1) % ring.len()])).collect();
            let mut outward = outward_normals(&points, index > 0);
            if cut.contains(&true) {
                keep_on_cuts(&mut outward, &points, &cut);
            }
            let start = self.mesh.vertices.len() as u32;
            for (&point, normal) in points.iter().zip(outward) {
                let half = normal * (self.feather / 2.0);
                self.mesh.vertices.push(Vertex { pos: point - half, uv: WHITE_UV, color: colour });
                self.mesh.vertices.push(Vertex { pos: point + half, uv: WHITE_UV, color: Color32::TRANSPARENT });
            }
            let count = points.len() as u32;
            for i in (0..count).filter(|&i| !cut[i as usize]) {
                let (a, b) = (start + 2 * i, start + 2 * ((i + 1) % count));
                self.mesh.indices.extend([a, b, a + 1, a + 1, b, b + 1]);
            }
        }
        self.mesh.indices.extend(triangles.iter().map(|corner| first + 2 * corner));
        if self.mesh.vertices.len() > CHUNK_VERTICES {
            self.end_chunk();
        }
    }
}

/// For each corner of a ring the direction out of the polygon, as long as keeps the rim a pixel wide
/// along both edges; at sharp corners at most twice that.
fn outward_normals(ring: &[Pos2], is_hole: bool) -> Vec<Vec2> {
    let n = ring.len();
    let twice_area: f32 = (0..n).map(|i| cross(ring[i].to_vec2(), ring[(i + 1) % n].to_vec2())).sum();
    // With y down, a positive area is clockwise: outside is on the left.
    let side = if (twice_area > 0.0) == is_hole { -1.0 } else { 1.0 };
    let edge_normal = |i: usize| {
        let edge = ring[(i + 1) % n] - ring[i % n];
        let length = edge.length();
        if length > 0.0 { vec2(edge.y, -edge.x) * (side / length) } else { Vec2::ZERO }
    };
    (0..n)
        .map(|i| {
            let (before, after) = (edge_normal(i + n - 1), edge_normal(i));
            // An edge without length has no direction: the other decides.
            if before == Vec2::ZERO || after == Vec2::ZERO {
                return before + after;
            }
            let sum = before + after;
            sum / (1.0 + before.dot(after)).max(0.5)
        })
        .collect()
}

/// Turns the directions out of a polygon at corners where it was cut along the cut, so that both pieces
/// end at the same place: half a pixel from the edge that is none of a cut.
fn keep_on_cuts(outward: &mut [Vec2], ring: &[Pos2], cut: &[bool]) {
    let n = ring.len();
    for i in 0..n {
        let (before, after) = ((i + n - 1) % n, i);
        let along = match (cut[before], cut[after]) {
            (false, false) => continue,
            (true, true) => {
                outward[i] = Vec2::ZERO;
                continue;
            }
            (true, false) => ring[i] - ring[before],
            (false, true) => ring[(i + 1) % n] - ring[i],
        };
        let edge = if cut[before] { ring[(i + 1) % n] - ring[i] } else { ring[i] - ring[before] };
        let (along, edge) = (along.normalized(), edge.normalized());
        let sine = cross(edge, along);
        // The side of the edge that the direction was on before is out.
        let side = if cross(edge, outward[i]) < 0.0 { -1.0 } else { 1.0 };
        outward[i] = if sine.abs() < 0.1 { Vec2::ZERO } else { along * (side / sine) };
    }
}

/// Whether a ring turns one way only.
fn is_convex(ring: &[Point]) -> bool {
    let n = ring.len();
    let turn = |i: usize| (ring[(i + 1) % n] - ring[i]).cross(ring[(i + 2) % n] - ring[(i + 1) % n]);
    (0..n).all(|i| turn(i) >= 0.0) || (0..n).all(|i| turn(i) <= 0.0)
}

fn cross(p: Vec2, q: Vec2) -> f32 {
    p.x * q.y - p.y * q.x
}

/// The grid's lines go along the screen's: egui puts them on whole pixels.
fn paint_grid(painter: &Painter, rect: Rect, view: &View, group: &Group) {
    for item in &group.items {
        if let Item::Line { points, colour, width, .. } = item
            && let [from, to] = points.as_slice()
        {
            let ends = [on_screen(rect, view, *from), on_screen(rect, view, *to)];
            painter.line_segment(ends, Stroke::new(view.px(*width) as f32, theme::colour(*colour)));
        }
    }
}

fn paint_text(painter: &Painter, rect: Rect, view: &View, text: &Text) {
    let family = match text.weight {
        Weight::Regular => FontFamily::Proportional,
        Weight::SemiBold => theme::semibold(),
    };
    let font = FontId::new(text.size_px as f32, family);
    let galley = painter.layout_no_wrap(text.content.clone(), font, theme::colour(text.colour));
    let baseline =
        galley.rows.first().and_then(|row| row.glyphs.first().map(|glyph| row.pos.y + glyph.pos.y)).unwrap_or_default();
    let width = galley.rect.width();
    let shift = match text.anchor {
        Anchor::Start => 0.0,
        Anchor::Middle => width / 2.0,
        Anchor::End => width,
    };
    let at = on_screen(rect, view, text.at) + vec2(text.offset_px.x as f32, text.offset_px.y as f32);
    let pixels_per_point = view.pixel_ratio as f32;
    let on_pixel = |value: f32| (value * pixels_per_point).round() / pixels_per_point;
    let (corner, angle) = if text.upright {
        (pos2(on_pixel(at.x) - baseline, at.y + shift), -std::f32::consts::FRAC_PI_2)
    } else {
        (pos2(at.x - shift, on_pixel(at.y) - baseline), 0.0)
    };
    if !painter.clip_rect().expand(width).contains(corner) {
        return;
    }
    if let Some(halo) = text.halo {
        let halo = theme::colour(halo);
        for (x, y) in
            [(-1.0, 0.0), (1.0, 0.0), (0.0, -1.0), (0.0, 1.0), (-0.7, -0.7), (0.7, -0.7), (-0.7, 0.7), (0.7, 0.7)]
        {
            let shape = TextShape::new(corner + vec2(x, y) * HALO_PX, galley.clone(), halo);
            painter.add(shape.with_override_text_color(halo).with_angle(angle));
        }
    }
    painter.add(TextShape::new(corner, galley, Color32::PLACEHOLDER).with_angle(angle));
}

/// How far the halo of a text reaches, in points.
const HALO_PX: f32 = 1.6;

#[cfg(test)]
mod tests {
    use crate::app::paint::scene_painter::*;

    fn view() -> View {
        View { width_px: 100.0, height_px: 100.0, px_per_m: 10.0, centre: Point::default(), pixel_ratio: 1.0 }
    }

    /// Twice the area of a mesh's opaque triangles.
    fn twice_solid_area(mesh: &Mesh) -> f32 {
        let solid = |corner: &u32| mesh.vertices[*corner as usize].color == Color32::WHITE;
        mesh.triangles()
            .filter(|triangle| triangle.iter().all(solid))
            .map(|triangle| {
                let [a, b, c] = triangle.map(|corner| mesh.vertices[corner as usize].pos);
                cross(b - a, c - a).abs()
            })
            .sum()
    }

    #[test]
    fn a_polygon_with_a_hole_is_half_a_pixel_smaller_inside_its_soft_rim() {
        let square =
            |side: f64| [(0.0, 0.0), (side, 0.0), (side, side), (0.0, side)].map(|(x, y)| Point::new(x, y)).to_vec();
        let outer = square(4.0);
        for reversed in [false, true] {
            let mut hole: Vec<Point> = square(2.0).iter().map(|p| Point::new(p.x + 1.0, p.y + 1.0)).collect();
            if reversed {
                hole.reverse();
            }
            let holes = vec![hole];
            let triangles = earcut(&outer, &holes);
            let view = view();
            let mut writer = Writer::new(&view);
            writer.polygon(&outer, &holes, &triangles, Color32::WHITE);
            let chunks = writer.finish();
            // 40 by 40 points less 20 by 20, each side drawn in by half a point.
            let expected = 39.0 * 39.0 - 21.0 * 21.0;
            assert_eq!(twice_solid_area(&chunks[0].mesh) / 2.0, expected, "{reversed}");
        }
    }

    #[test]
    fn lines_are_as_wide_as_they_say_and_hairpins_do_not_shoot_out() {
        let view = view();
        let mut writer = Writer::new(&view);
        writer.path(vec![pos2(0.0, 0.0), pos2(10.0, 0.0)], false, Stroke::new(3.0, Color32::WHITE));
        // The solid core is a pixel less wide than the line with its two soft sides.
        assert_eq!(twice_solid_area(&writer.mesh) / 2.0, 10.0 * 2.0);
        let mut writer = Writer::new(&view);
        let hairpin = vec![pos2(0.0, 0.0), pos2(10.0, 0.0), pos2(0.0, 1e-4), pos2(0.0, 5.0)];
        writer.path(hairpin, true, Stroke::new(2.0, Color32::WHITE));
        assert!(Rect::from_min_max(pos2(-3.0, -3.0), pos2(13.0, 8.0)).contains_rect(writer.mesh.calc_bounds()));
        writer.path(vec![pos2(1.0, 1.0); 5], true, Stroke::new(2.0, Color32::WHITE));
        assert!(writer.mesh.vertices.iter().all(|vertex| vertex.pos.is_finite()));
    }

    #[test]
    fn rings_with_repeated_points_stay_finite() {
        let ring = [pos2(0.0, 0.0), pos2(0.0, 0.0), pos2(9.0, 0.0), pos2(9.0, 9.0), pos2(0.0, 0.0)];
        assert!(outward_normals(&ring, false).iter().all(|normal| normal.is_finite() && normal.length() < 3.0));
        assert!(outward_normals(&[], false).is_empty());
    }
}
