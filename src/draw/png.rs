//! Renders a scene to pixels with tiny-skia on the CPU. The same bytes on every x86-64 machine: no
//! platform sine function or font rasteriser is involved, and tiny-skia uses the same vector instructions
//! on all of them (SSE2, unless compiled for a newer processor).

use std::collections::HashMap;

use tiny_skia::{
    Color, ColorU8, FillRule, FilterQuality, LineCap, LineJoin, Mask, Paint, Path, PathBuilder, Pattern, Pixmap, Rect,
    SpreadMode, Stroke, StrokeDash, Transform,
};

use super::Rgba;
use super::font::{Font, Step};
use super::scene::{Anchor, Dash, Frame, Group, Item, Layer, Length, PlacedPicture, Scene, Text, View, Weight};
use crate::geometry::polygon::edges;
use crate::geometry::{Bounds, Point, Vector};
use crate::picture::png::{FAST, Packing, PictureError, encode_pixmap, encode_pixmap_packed};

/// The largest side of a picture: 256 MiB of memory while painting.
pub const LARGEST_SIDE_PX: u32 = 8192;

/// Renders the scene to a PNG file.
///
/// # Errors
/// As [`paint`].
pub fn png(scene: &Scene) -> Result<Vec<u8>, PictureError> {
    encode_pixmap(&paint(scene)?)
}

/// The same, with the size of a pixel when printed: so many to the metre.
///
/// # Errors
/// As [`paint`].
pub fn png_to_print(scene: &Scene, dots_per_m: u32) -> Result<Vec<u8>, PictureError> {
    encode_pixmap_packed(&paint(scene)?, Packing { dots_per_m: Some(dots_per_m), ..FAST })
}

/// Renders the scene to pixels.
///
/// # Errors
/// When its view has no pixels, or more than [`LARGEST_SIDE_PX`] on a side.
pub fn paint(scene: &Scene) -> Result<Pixmap, PictureError> {
    let view = &scene.view;
    let side = |px: f64| {
        let px = (px * view.pixel_ratio).round();
        (px >= 1.0 && px <= f64::from(LARGEST_SIDE_PX)).then_some(px as u32)
    };
    let pixmap = side(view.width_px).zip(side(view.height_px)).and_then(|(width, height)| Pixmap::new(width, height));
    let Some(mut pixmap) = pixmap else {
        return Err(PictureError(format!(
            "a picture of {} x {} pixels cannot be painted: each side must be 1 to {LARGEST_SIDE_PX}",
            view.width_px * view.pixel_ratio,
            view.height_px * view.pixel_ratio
        )));
    };
    pixmap.fill(colour(scene.background));
    let mut painter = Painter { pixmap, view: *view, glyphs: HashMap::new() };
    for group in &scene.groups {
        painter.group(group);
    }
    Ok(painter.pixmap)
}

fn colour(rgba: Rgba) -> Color {
    Color::from_rgba8(rgba.r, rgba.g, rgba.b, rgba.a)
}

fn paint_of(rgba: Rgba) -> Paint<'static> {
    let mut paint = Paint { anti_alias: true, ..Paint::default() };
    paint.set_color(colour(rgba));
    paint
}

/// The visible part of a picture, at a suitable size.
struct SeenPart {
    pixels: Pixmap,
    /// Its upper left corner, in pixels of the full picture.
    from_px: Point,
    /// Pixels of the full picture per pixel of this one, along a side.
    stride: f64,
}

impl SeenPart {
    /// `place` maps a pixel of the full picture to the page.
    fn of(picture: &PlacedPicture, place: impl Fn(f64, f64) -> Point, page: &Pixmap) -> Option<Self> {
        let start = place(0.0, 0.0);
        let (x_way, y_way) = (place(1.0, 0.0) - start, place(0.0, 1.0) - start);
        let turn = x_way.cross(y_way);
        if !(turn.abs() > 1e-12 && turn.is_finite()) {
            return None;
        }
        let index = picture.levels.index_for(x_way.length());
        let level = picture.levels.all().get(index)?;
        let stride = (index as f64).exp2();
        // The page's corners in picture coordinates.
        let (width, height) = (f64::from(page.width()), f64::from(page.height()));
        let corners = [(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)].map(|(x, y)| {
            let from_start = Point::new(x, y) - start;
            Point::new(from_start.cross(y_way) / turn / stride, x_way.cross(from_start) / turn / stride)
        });
        let seen = Bounds::of(corners);
        // One pixel more, for interpolation.
        let range = |from: f64, to: f64, side: u32| {
            let from = (from.floor() - 1.0).clamp(0.0, f64::from(side)) as u32;
            let to = (to.ceil() + 1.0).clamp(0.0, f64::from(side)) as u32;
            (from, to.saturating_sub(from))
        };
        let (left, columns) = range(seen.min.x, seen.max.x, level.width_px);
        let (top, rows) = range(seen.min.y, seen.max.y, level.height_px);
        let mut pixels = Pixmap::new(columns, rows)?;
        let places = (0..rows).flat_map(|y| (0..columns).map(move |x| (left + x, top + y)));
        for (pixel, (x, y)) in pixels.pixels_mut().iter_mut().zip(places) {
            let [r, g, b, a] = level.pixel(i64::from(x), i64::from(y));
            *pixel = ColorU8::from_rgba(r, g, b, a).premultiply();
        }
        let from_px = Point::new(f64::from(left) * stride, f64::from(top) * stride);
        Some(Self { pixels, from_px, stride })
    }
}

struct Painter {
    pixmap: Pixmap,
    view: View,
    glyphs: HashMap<GlyphKey, Option<Glyph>>,
}

impl Painter {
    fn group(&mut self, group: &Group) {
        for item in &group.items {
            match item {
                Item::Polygon { outer, holes, colour } => self.polygon(group, outer, holes, *colour),
                Item::Line { points, closed, colour, width, dash } => {
                    self.line(group.frame, points, *closed, *colour, *width, *dash);
                }
                Item::Arc { centre, from, to, colour, width } => {
                    self.arc(group.frame, *centre, *from, *to, *colour, *width);
                }
                Item::Disc { centre, radius, fill, outline } => {
                    let (centre, radius) = (self.at(group.frame, *centre), self.px(*radius));
                    let Some(circle) = PathBuilder::from_circle(centre.x as f32, centre.y as f32, radius as f32) else {
                        continue;
                    };
                    if let Some(fill) = fill {
                        self.fill(&circle, *fill, FillRule::Winding);
                    }
                    if let Some((colour, width)) = outline {
                        let stroke = Stroke { width: self.px(*width) as f32, ..Stroke::default() };
                        self.stroke(&circle, *colour, &stroke);
                    }
                }
                Item::Text(text) => self.text(group.frame, text),
                Item::Picture(picture) => self.picture(group.frame, picture),
            }
        }
    }

    /// Paints a picture, preparing only the visible part.
    fn picture(&mut self, frame: Frame, picture: &PlacedPicture) {
        let Some(part) = SeenPart::of(picture, |x, y| self.at(frame, picture.at(x, y)), &self.pixmap) else { return };
        let SeenPart { pixels, from_px, stride } = part;
        let at = |x: f64, y: f64| self.at(frame, picture.at(from_px.x + x * stride, from_px.y + y * stride));
        let (start, right, below) = (at(0.0, 0.0), at(1.0, 0.0), at(0.0, 1.0));
        let (x_way, y_way) = (right - start, below - start);
        let transform = Transform::from_row(
            x_way.x as f32,
            x_way.y as f32,
            y_way.x as f32,
            y_way.y as f32,
            start.x as f32,
            start.y as f32,
        );
        let shader =
            Pattern::new(pixels.as_ref(), SpreadMode::Pad, FilterQuality::Bilinear, picture.opacity as f32, transform);
        let paint = Paint { shader, anti_alias: true, ..Paint::default() };
        let (width, height) = (f64::from(pixels.width()), f64::from(pixels.height()));
        let mut outline = PathBuilder::new();
        for (index, (x, y)) in [(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)].into_iter().enumerate() {
            let corner = at(x, y);
            if index == 0 {
                outline.move_to(corner.x as f32, corner.y as f32);
            } else {
                outline.line_to(corner.x as f32, corner.y as f32);
            }
        }
        outline.close();
        if let Some(outline) = outline.finish() {
            self.pixmap.fill_path(&outline, &paint, FillRule::Winding, Transform::identity(), None);
        }
    }

    /// A point in physical pixels.
    fn at(&self, frame: Frame, point: Point) -> Point {
        let screen = match frame {
            Frame::Plan => self.view.screen_from_plan(point),
            Frame::Screen => point,
        };
        Point::new(screen.x * self.view.pixel_ratio, screen.y * self.view.pixel_ratio)
    }

    /// A length in physical pixels.
    fn px(&self, length: Length) -> f64 {
        self.view.px(length) * self.view.pixel_ratio
    }

    fn fill(&mut self, path: &Path, colour: Rgba, rule: FillRule) {
        self.pixmap.fill_path(path, &paint_of(colour), rule, Transform::identity(), None);
    }

    fn stroke(&mut self, path: &Path, colour: Rgba, stroke: &Stroke) {
        self.pixmap.stroke_path(path, &paint_of(colour), stroke, Transform::identity(), None);
    }

    /// Whether a box in physical pixels, grown by `margin`, overlaps the picture.
    fn is_seen(&self, bounds: Bounds, margin: f64) -> bool {
        let page = Bounds {
            min: Point::default(),
            max: Point::new(f64::from(self.pixmap.width()), f64::from(self.pixmap.height())),
        };
        bounds.inflated(margin).intersects(page)
    }

    /// Fills a polygon. One with only horizontal and vertical sides is aligned to whole pixels: crisp,
    /// without seams between neighbours, and fast. Not so walls, whose thickness would become uneven.
    fn polygon(&mut self, group: &Group, outer: &[Point], holes: &[Vec<Point>], colour: Rgba) {
        let rings: Vec<Vec<Point>> = std::iter::once(outer)
            .chain(holes.iter().map(Vec::as_slice))
            .map(|ring| ring.iter().map(|&point| self.at(group.frame, point)).collect())
            .collect();
        if !self.is_seen(Bounds::of(rings[0].iter().copied()), 1.0) {
            return;
        }
        let is_level = group.layer != Layer::Walls
            && rings.iter().flat_map(|ring| edges(ring)).all(|edge| {
                let along = edge.vector();
                along.x.abs() < STRAIGHT_PX || along.y.abs() < STRAIGHT_PX
            });
        let place = |point: Point| if is_level { Point::new(point.x.round(), point.y.round()) } else { point };
        if is_level && holes.is_empty() && outer.len() == 4 {
            let bounds = Bounds::of(rings[0].iter().copied().map(place));
            self.rectangle(bounds, colour);
            return;
        }
        let mut builder = PathBuilder::new();
        for ring in &rings {
            for (i, &point) in ring.iter().enumerate() {
                let at = place(point);
                if i == 0 {
                    builder.move_to(at.x as f32, at.y as f32);
                } else {
                    builder.line_to(at.x as f32, at.y as f32);
                }
            }
            builder.close();
        }
        if let Some(path) = builder.finish() {
            let paint = Paint { anti_alias: !is_level, ..paint_of(colour) };
            self.pixmap.fill_path(&path, &paint, FillRule::EvenOdd, Transform::identity(), None);
        }
    }

    /// Fills a box of whole physical pixels.
    fn rectangle(&mut self, bounds: Bounds, colour: Rgba) {
        let (min, max) = (bounds.min, bounds.max);
        if let Some(rect) = Rect::from_ltrb(min.x as f32, min.y as f32, max.x as f32, max.y as f32) {
            let paint = Paint { anti_alias: false, ..paint_of(colour) };
            self.pixmap.fill_rect(rect, &paint, Transform::identity(), None);
        }
    }

    fn line(&mut self, frame: Frame, points: &[Point], closed: bool, colour: Rgba, width: Length, dash: Option<Dash>) {
        let width_px = self.px(width);
        let mut points: Vec<Point> = points.iter().map(|&point| self.at(frame, point)).collect();
        if !self.is_seen(Bounds::of(points.iter().copied()), 4.0 * width_px) {
            return;
        }
        if let (Length::Px(_), [a, b]) = (width, points.as_mut_slice())
            && sharpen(a, b, width_px)
            && dash.is_none()
            && width_px.fract() == 0.0
        {
            let half = width_px / 2.0;
            let across = if a.x == b.x { Vector::new(half, 0.0) } else { Vector::new(0.0, half) };
            let corners = [*a - across, *a + across, *b - across, *b + across];
            self.rectangle(Bounds::of(corners.map(|corner| Point::new(corner.x.round(), corner.y.round()))), colour);
            return;
        }
        let mut builder = PathBuilder::new();
        for (i, point) in points.iter().enumerate() {
            if i == 0 {
                builder.move_to(point.x as f32, point.y as f32);
            } else {
                builder.line_to(point.x as f32, point.y as f32);
            }
        }
        if closed {
            builder.close();
        }
        let Some(path) = builder.finish() else { return };
        let dash =
            dash.and_then(|dash| StrokeDash::new(vec![self.px(dash.dash) as f32, self.px(dash.gap) as f32], 0.0));
        let stroke = Stroke {
            width: width_px as f32,
            line_cap: LineCap::Butt,
            line_join: LineJoin::Miter,
            dash,
            ..Stroke::default()
        };
        self.stroke(&path, colour, &stroke);
    }

    fn arc(&mut self, frame: Frame, centre: Point, from: Point, to: Point, colour: Rgba, width: Length) {
        // Two pieces of at most a quarter turn each, for which one cubic is accurate to 0.03 %.
        let points = super::scene::arc_points(centre, from, to, 1);
        let centre = self.at(frame, centre);
        let points: Vec<Point> = points.iter().map(|&point| self.at(frame, point)).collect();
        let width_px = self.px(width);
        if !self.is_seen(Bounds::of(points.iter().copied()), width_px + centre.distance(points[0])) {
            return;
        }
        let mut builder = PathBuilder::new();
        builder.move_to(points[0].x as f32, points[0].y as f32);
        for pair in points.windows(2) {
            let (p, q) = (pair[0] - centre, pair[1] - centre);
            let (length, turn) = (p.length(), p.cross(q));
            if length <= 0.0 {
                return;
            }
            // Control points at 4/3 tan(angle/4) of the radius along the tangents; the tangent comes from
            // half-angle formulas, since square roots are the same on every machine.
            let half = ((1.0 + p.dot(q) / (length * length)) / 2.0).clamp(0.0, 1.0).sqrt();
            let reach = 4.0 / 3.0 * ((1.0 - half) / (1.0 + half)).sqrt() * turn.signum();
            let (c1, c2) = (pair[0] + p.left() * reach, pair[1] - q.left() * reach);
            builder.cubic_to(c1.x as f32, c1.y as f32, c2.x as f32, c2.y as f32, pair[1].x as f32, pair[1].y as f32);
        }
        if let Some(path) = builder.finish() {
            self.stroke(&path, colour, &Stroke { width: width_px as f32, ..Stroke::default() });
        }
    }

    fn text(&mut self, frame: Frame, text: &Text) {
        let ratio = self.view.pixel_ratio;
        let size = text.size_px * ratio;
        let font = Font::of(text.weight);
        let width = font.width_px(&text.content, size);
        let anchor = self.at(frame, text.at) + text.offset_px * ratio;
        let back = match text.anchor {
            Anchor::Start => 0.0,
            Anchor::Middle => width / 2.0,
            Anchor::End => width,
        };
        // On whole pixels: a word looks the same everywhere, and its letters stand on a pixel's edge.
        let (start_x, start_y) = if text.upright { (anchor.x, anchor.y + back) } else { (anchor.x - back, anchor.y) };
        let (start_x, start_y) = (start_x.round(), start_y.round());
        let bounds = Bounds::of([Point::new(start_x, start_y)]);
        if !self.is_seen(bounds, width + size) {
            return;
        }
        let mut pens = Vec::with_capacity(text.content.len());
        let mut pen = if text.upright { -start_y } else { start_x };
        for character in text.content.chars() {
            pens.push((character, pen));
            pen += size * f64::from(font.advance(character));
        }
        // All halos first, so that none covers the previous letter.
        let halo = text.halo.map(|halo| (halo, Some(size * HALO)));
        for (colour, halo_px) in halo.into_iter().chain([(text.colour, None)]) {
            for &(character, pen) in &pens {
                let (whole, place) = (pen.floor(), ((pen - pen.floor()) * PLACES).floor());
                let key = GlyphKey {
                    weight: text.weight,
                    character,
                    size_bits: size.to_bits(),
                    place: place as u8,
                    upright: text.upright,
                    is_halo: halo_px.is_some(),
                };
                let glyph = self.glyphs.entry(key).or_insert_with(|| key.rasterised(font, size, halo_px));
                if let Some(glyph) = glyph {
                    let (x, y) = if text.upright { (start_x, -whole) } else { (whole, start_y) };
                    glyph.blend(&mut self.pixmap, x as i64, y as i64, colour);
                }
            }
        }
    }
}

/// Width of a halo's stroke as a fraction of the font size; half of it shows around the letters.
const HALO: f64 = 0.28;

/// Subpixel positions along a line of text for cached letters: finer is invisible.
const PLACES: f64 = 4.0;

/// What determines how a rasterised letter looks.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
struct GlyphKey {
    weight: Weight,
    character: char,
    size_bits: u64,
    /// Subpixel position along the line, of [`PLACES`].
    place: u8,
    upright: bool,
    is_halo: bool,
}

/// A letter's coverage mask.
struct Glyph {
    /// From the pen's pixel to the upper left pixel of the mask.
    left: i64,
    top: i64,
    mask: Mask,
}

impl GlyphKey {
    /// Rasterises the letter; `None` if it leaves no mark.
    fn rasterised(self, font: &Font, size: f64, halo_px: Option<f64>) -> Option<Glyph> {
        let shift = ((f64::from(self.place) + 0.5) / PLACES) as f32;
        let size = size as f32;
        // Upright: along the line is up the screen, and up from the baseline is left.
        let at = |x: f32, y: f32| {
            let (along, up) = (shift + x * size, y * size);
            if self.upright { (-up, -along) } else { (along, -up) }
        };
        let mut builder = PathBuilder::new();
        for step in font.outline(self.character) {
            match step {
                Step::Move(x, y) => {
                    let (x, y) = at(x, y);
                    builder.move_to(x, y);
                }
                Step::Line(x, y) => {
                    let (x, y) = at(x, y);
                    builder.line_to(x, y);
                }
                Step::Quad(x1, y1, x, y) => {
                    let ((x1, y1), (x, y)) = (at(x1, y1), at(x, y));
                    builder.quad_to(x1, y1, x, y);
                }
                Step::Cubic(x1, y1, x2, y2, x, y) => {
                    let ((x1, y1), (x2, y2), (x, y)) = (at(x1, y1), at(x2, y2), at(x, y));
                    builder.cubic_to(x1, y1, x2, y2, x, y);
                }
                Step::Close => builder.close(),
            }
        }
        let mut path = builder.finish()?;
        if let Some(width) = halo_px {
            let stroke = Stroke { width: width as f32, line_join: LineJoin::Round, ..Stroke::default() };
            path = path.stroke(&stroke, 1.0)?;
        }
        let bounds = path.bounds();
        let (left, top) = (bounds.left().floor(), bounds.top().floor());
        let extent = |length: f32| (length.ceil() as u32).saturating_add(1);
        let mut mask = Mask::new(extent(bounds.right() - left), extent(bounds.bottom() - top))?;
        mask.fill_path(&path, FillRule::Winding, true, Transform::from_translate(-left, -top));
        Some(Glyph { left: left as i64, top: top as i64, mask })
    }
}

impl Glyph {
    /// Blends a colour over the picture through the mask, with the pen's pixel at (`x`, `y`).
    fn blend(&self, pixmap: &mut Pixmap, x: i64, y: i64, colour: Rgba) {
        let (width, height) = (i64::from(pixmap.width()), i64::from(pixmap.height()));
        let (left, top) = (x + self.left, y + self.top);
        let data = pixmap.data_mut();
        for (row, coverage) in self.mask.data().chunks_exact(self.mask.width() as usize).enumerate() {
            let y = top + row as i64;
            if y < 0 || y >= height {
                continue;
            }
            for (column, &coverage) in coverage.iter().enumerate() {
                let x = left + column as i64;
                if coverage == 0 || x < 0 || x >= width {
                    continue;
                }
                // Premultiplied 'source over' in integers, rounded.
                let alpha = u32::from(coverage) * u32::from(colour.a);
                let pixel = (y * width + x) as usize * 4;
                let sources = [colour.r, colour.g, colour.b, 255];
                for (under, source) in data[pixel..pixel + 4].iter_mut().zip(sources) {
                    let sum = u32::from(source) * alpha + u32::from(*under) * (OPAQUE - alpha);
                    *under = ((sum + OPAQUE / 2) / OPAQUE) as u8;
                }
            }
        }
    }
}

/// Full coverage in an opaque colour.
const OPAQUE: u32 = 255 * 255;

/// A line counts as horizontal or vertical up to this difference of its ends, in pixels.
const STRAIGHT_PX: f64 = 0.01;

/// Moves a horizontal or vertical line with this width in physical pixels so that its sides fall on pixel
/// edges; returns whether it is such a line.
fn sharpen(a: &mut Point, b: &mut Point, width_px: f64) -> bool {
    let middle = |place: f64| if (width_px.round() as i64) % 2 == 1 { place.floor() + 0.5 } else { place.round() };
    if (a.x - b.x).abs() < STRAIGHT_PX {
        a.x = middle(a.x);
        b.x = a.x;
        true
    } else if (a.y - b.y).abs() < STRAIGHT_PX {
        a.y = middle(a.y);
        b.y = a.y;
        true
    } else {
        false
    }
}
