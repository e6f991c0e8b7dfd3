//! Paints the scene of a plan with egui: triangles are made once per zoom level and moved while panning.

mod meshes;

use crate::app::paint::places::{on_screen, plan_point};
use meshes::{Chunk, Writer};
pub(crate) use meshes::{earcut, outline_mesh, polygon_mesh};
use std::collections::{BTreeMap, HashMap};
use std::hash::Hasher as _;
use std::sync::Arc;

use egui::epaint::{CircleShape, Mesh, TessellationOptions, Tessellator, TextShape, Vertex, WHITE_UV};
use egui::{Color32, FontFamily, FontId, Painter, Pos2, Rect, Shape, Stroke, Vec2, pos2, vec2};

use crate::app::look::theme;
use crate::app::session::document::Derived;
use crate::draw::scene::arc_points;
use crate::draw::{Anchor, FromAfar, Group, Item, Layer, Length, Rgba, Style, Text, View, Weight};
use crate::geometry::{Bounds, Point};
use crate::plan::RoomId;

/// The layers that just move while panning, in order.
const SHAPE_LAYERS: [Layer; 5] = [Layer::Rooms, Layer::Boundaries, Layer::Walls, Layer::Openings, Layer::Graph];

/// Size of a piece of the scene, which is culled as a whole when outside the view.
const CHUNK_VERTICES: usize = 20_000;

/// A scene with more vertices is not rebuilt for every frame of a zoom, but scaled until the zoom ends:
/// building it would take longer than a frame.
const HEAVY_VERTICES: usize = 60_000;

/// The cosine of the sharpest turn, 120 degrees, at which lines are mitred.
const SHARPEST_MITRE: f32 = -0.5;

/// With more rooms, names are not laid out again for every frame of a gesture.
const MANY_NAMES: usize = 60;

/// The most names laid out per frame in a large plan; the others follow in the next frames.
const NAMES_A_FRAME: usize = 80;

/// Zooming further than this from the zoom at which the triangles were made shows blurred edges.
const SCALED_AT_MOST: f64 = 1.6;

/// With more elements of a large plan in view, it is drawn as seen from afar.
const MOST_IN_DETAIL: usize = 7000;

/// The maximum distance of the triangles' origin from the view, in points: further away, 32-bit floats
/// are not accurate to a hundredth of a pixel.
const FAR_PX: f64 = 60_000.0;

/// Tiles out of view are kept while all together have at most this many vertices: 60 MB.
const KEPT_VERTICES: usize = 1_500_000;

/// Tiles are built this many points before they come into view.
const AHEAD_PX: f64 = 8.0;

/// Paints a plan, with caching.
#[derive(Default)]
pub(crate) struct ScenePainter {
    shapes: Option<Shapes>,
    names: Option<Names>,
    /// Triangles of each polygon, by a hash of its points: independent of zoom and style.
    triangles: HashMap<u64, Vec<u32>>,
    last_view: Option<View>,
}

/// The triangles at a zoom level, of everything except names.
struct Shapes {
    derived: Arc<Derived>,
    style: Style,
    fills: Vec<Rgba>,
    /// The view they were made for; its centre is the origin of the triangles' coordinates.
    view: View,
    is_from_afar: bool,
    /// By tile, for those that have been in view.
    tiles: BTreeMap<usize, TileShapes>,
    vertices: usize,
    /// Where they were last placed.
    placed: Option<Placed>,
}

/// A tile's triangles, by layer and level of rooms.
#[derive(Default)]
struct TileShapes {
    parts: BTreeMap<(usize, usize), Vec<Chunk>>,
    vertices: usize,
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
    /// The rooms in view.
    rooms: Vec<usize>,
    /// The names laid out at this zoom, by room.
    placed: HashMap<usize, Option<Group>>,
}

impl Names {
    /// The texts in view.
    fn texts(&self) -> impl Iterator<Item = &Text> + '_ {
        let groups = self.rooms.iter().filter_map(|room| self.placed.get(room)?.as_ref());
        groups
            .flat_map(|group| &group.items)
            .filter_map(|item| if let Item::Text(text) = item { Some(text) } else { None })
    }
}

/// The box of a text on the screen, from its baseline up.
fn boxed(text: &Text, rect: Rect, view: &View) -> Rect {
    let width = crate::draw::font::Font::of(text.weight).width_px(&text.content, text.size_px) as f32;
    let height = text.size_px as f32;
    let at = on_screen(rect, view, text.at) + vec2(text.offset_px.x as f32, text.offset_px.y as f32);
    if text.upright {
        Rect::from_min_max(at - vec2(height, width / 2.0), at + vec2(0.0, width / 2.0))
    } else {
        Rect::from_min_max(at - vec2(width / 2.0, height), at + vec2(width / 2.0, 0.0))
    }
}

impl ScenePainter {
    /// Paints a plan in `rect` with the view `view`. Asks for another frame if it has deferred something.
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

    /// The boxes of the names on the screen.
    pub(crate) fn text_boxes(&self, rect: Rect, view: &View) -> Vec<Rect> {
        self.names.iter().flat_map(Names::texts).map(|text| boxed(text, rect, view)).collect()
    }

    /// Where the name and area of a room are written, as in the last frame, and the box around them.
    pub(crate) fn text_of(&self, room: RoomId, rect: Rect, view: &View) -> Option<(Point, Bounds)> {
        let element = room.to_string();
        let names = self.names.as_ref()?;
        let mut groups = names.rooms.iter().filter_map(|room| names.placed.get(room)?.as_ref());
        let group = groups.find(|group| group.element == element)?;
        let texts = group.items.iter().filter_map(|item| if let Item::Text(text) = item { Some(text) } else { None });
        let at = texts.clone().next()?.at;
        let on_screen = texts.map(|text| boxed(text, rect, view)).reduce(Rect::union)?;
        let corners = [on_screen.min, on_screen.max].map(|corner| plan_point(view, rect, corner));
        Some((at, Bounds::of(corners)))
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
            // Seen from afar there are no edges to blur.
            let can_wait = is_near && (shapes.is_from_afar || (is_moving && shapes.vertices > HEAVY_VERTICES));
            let same_zoom = scale == 1.0 || can_wait;
            let same_pixels = shapes.view.pixel_ratio == view.pixel_ratio;
            // Hysteresis, so that it does not flicker at the limit.
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

    /// Returns whether some names are still to be laid out.
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
        if names.view != *view || names.placed.is_empty() {
            names.view = *view;
            names.rooms = drawing.rooms_to_name(view);
        }
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
                    let write = |piece: FromAfar<'_>| writer.piece_from_afar(piece);
                    drawing.tile_from_afar(tile, layer, level, &self.fills, &self.style, &self.view, write);
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

    /// The triangles placed for a view.
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

/// A hash that tells polygons apart.
fn hash(outer: &[Point], holes: &[Vec<Point>]) -> u64 {
    // SipHash with fixed keys: the same on every run, and collisions within a plan are negligible.
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

/// The grid's lines are parallel to the screen's: egui puts them on whole pixels.
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

/// Paints the lines and texts of a group that is not kept as triangles: few, or changing with each edit.
pub(crate) fn paint_group(painter: &Painter, rect: Rect, view: &View, group: &Group) {
    for item in &group.items {
        match item {
            Item::Line { points, colour, width, .. } => {
                let points: Vec<Pos2> = points.iter().map(|&point| on_screen(rect, view, point)).collect();
                painter.add(Shape::line(points, Stroke::new(view.px(*width) as f32, theme::colour(*colour))));
            }
            Item::Text(text) => paint_text(painter, rect, view, text),
            Item::Polygon { .. } | Item::Arc { .. } | Item::Disc { .. } | Item::Picture(_) => {}
        }
    }
}

fn paint_text(painter: &Painter, rect: Rect, view: &View, text: &Text) {
    paint_text_at(painter, on_screen(rect, view, text.at), view, text);
}

/// Paints a text whose point is at a place on the screen.
pub(super) fn paint_text_at(painter: &Painter, at: Pos2, view: &View, text: &Text) {
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
    let at = at + vec2(text.offset_px.x as f32, text.offset_px.y as f32);
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

/// The width of a text's halo, in points.
const HALO_PX: f32 = 1.6;
