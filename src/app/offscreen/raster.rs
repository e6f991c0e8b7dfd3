//! A CPU rasteriser of egui's tessellated output, so that the window can be seen without a display:
//! in tests, in replay scripts, in pictures for the manual.
//!
//! It does what egui's OpenGL shader does: triangles with colours interpolated between their
//! corners, times a texture, blended premultiplied in gamma space. All arithmetic behind the corner
//! positions is in whole numbers, so that the picture is the same on every machine.

use std::collections::BTreeMap;

use crate::picture::Picture;
use egui::epaint::{ClippedPrimitive, ImageData, ImageDelta, Primitive, Vertex};
use egui::{Color32, Rect, TextureFilter, TextureId, TextureWrapMode, TexturesDelta};

/// Subpixels in a pixel along each axis: what GPUs use at least.
const SUBPIXELS: i64 = 256;

/// The centre of a pixel in subpixels, where coverage is decided.
const CENTRE: i64 = SUBPIXELS / 2;

/// Corners further out than a million pixels are pulled in to there, so that products of two
/// coordinates in subpixels fit 64 bits.
const FAR: f32 = (1 << 28) as f32;

/// Bits behind the point of an interpolated value.
const FRACTION_BITS: u32 = 16;

/// Keeps the textures that egui hands over and paints frames with them.
#[derive(Default)]
pub struct Raster {
    textures: BTreeMap<u64, Texture>,
}

struct Texture {
    width: usize,
    height: usize,
    /// Premultiplied, rows from the top.
    texels: Vec<[u8; 4]>,
    filter: TextureFilter,
    wrap: TextureWrapMode,
}

impl Raster {
    /// Takes over new and changed textures. Textures named as freed go only after the frame that
    /// came with them is painted, so they are dropped at the next call.
    pub fn update_textures(&mut self, delta: &mut TexturesDelta) {
        for (id, changes) in delta.set.drain() {
            for change in changes {
                self.set_texture(key(id), &change);
            }
        }
    }

    /// Drops textures that are no longer used; to be called after painting.
    pub fn free_textures(&mut self, delta: &mut TexturesDelta) {
        for id in delta.free.drain() {
            self.textures.remove(&key(id));
        }
    }

    fn set_texture(&mut self, key: u64, change: &ImageDelta) {
        let ImageData::Color(image) = &change.image;
        let [width, height] = image.size;
        let texel = |color: &Color32| color.to_array();
        match change.pos {
            None => {
                let texture = Texture {
                    width,
                    height,
                    texels: image.pixels.iter().map(texel).collect(),
                    filter: change.options.magnification,
                    wrap: change.options.wrap_mode,
                };
                self.textures.insert(key, texture);
            }
            Some([left, top]) => {
                let Some(texture) = self.textures.get_mut(&key) else { return };
                if left + width > texture.width || top + height > texture.height {
                    return;
                }
                for (row, source) in image.pixels.chunks_exact(width.max(1)).enumerate() {
                    let start = (top + row) * texture.width + left;
                    for (target, color) in texture.texels[start..start + width].iter_mut().zip(source) {
                        *target = texel(color);
                    }
                }
            }
        }
    }

    /// Paints a frame of `size_px` pixels on an opaque background. Meshes whose texture is not known
    /// and paint callbacks (which Enfilade does not use) are left out.
    pub fn paint(
        &self,
        primitives: &[ClippedPrimitive],
        size_px: [u32; 2],
        pixels_per_point: f32,
        background: Color32,
    ) -> Picture {
        let [width, height] = size_px.map(|side| side as usize);
        let mut target =
            Target { width, pixels: vec![background.to_opaque().to_array(); width * height], clip: Clip::default() };
        for ClippedPrimitive { clip_rect, primitive } in primitives {
            let Primitive::Mesh(mesh) = primitive else { continue };
            let Some(texture) = self.textures.get(&key(mesh.texture_id)) else { continue };
            target.clip = Clip::new(*clip_rect, pixels_per_point, width, height);
            if target.clip.is_empty() {
                continue;
            }
            let corner = |index: u32| mesh.vertices.get(index as usize).map(|v| Corner::new(v, pixels_per_point));
            let mut triangles = mesh.indices.chunks_exact(3).peekable();
            while let Some(triangle) = triangles.next() {
                let (Some(a), Some(b), Some(c)) = (corner(triangle[0]), corner(triangle[1]), corner(triangle[2]))
                else {
                    continue;
                };
                // Two triangles that egui made from one rectangle: most of a frame's area and all
                // of its text.
                if let Some(next) = triangles.peek()
                    && next[0] == triangle[2]
                    && next[1] == triangle[1]
                    && let Some(d) = corner(next[2])
                    && is_rectangle(&a, &b, &c, &d)
                {
                    triangles.next();
                    target.rectangle(texture, &a, &d);
                    continue;
                }
                target.triangle(texture, a, b, c);
            }
        }
        Picture { width_px: size_px[0], height_px: size_px[1], rgba: target.pixels.into_flattened() }
    }
}

/// Textures are kept by number: user textures apart from egui's own.
fn key(id: TextureId) -> u64 {
    match id {
        TextureId::Managed(number) => number << 1,
        TextureId::User(number) => number << 1 | 1,
    }
}

/// A mesh's corner in subpixels.
#[derive(Clone, Copy)]
struct Corner {
    x: i64,
    y: i64,
    u: f32,
    v: f32,
    color: [u8; 4],
}

impl Corner {
    fn new(vertex: &Vertex, pixels_per_point: f32) -> Self {
        // A float becomes a whole number by saturation and not-a-number becomes 0: no surprise.
        let place = |value: f32| whole(f64::from((value * pixels_per_point * SUBPIXELS as f32).clamp(-FAR, FAR)));
        Self {
            x: place(vertex.pos.x),
            y: place(vertex.pos.y),
            u: vertex.uv.x,
            v: vertex.uv.y,
            color: vertex.color.to_array(),
        }
    }
}

/// Whether the corners (left top, right top, left bottom, right bottom) are an upright rectangle of
/// one colour whose texture lies upright on it.
fn is_rectangle(a: &Corner, b: &Corner, c: &Corner, d: &Corner) -> bool {
    let upright = a.x == c.x && b.x == d.x && a.y == b.y && c.y == d.y && a.x <= b.x && a.y <= c.y;
    let texture = a.u == c.u && b.u == d.u && a.v == b.v && c.v == d.v;
    upright && texture && a.color == b.color && a.color == c.color && a.color == d.color
}

/// The part of the picture that may be painted, in pixels; the far sides are not part of it.
#[derive(Clone, Copy, Default)]
struct Clip {
    left: i64,
    top: i64,
    right: i64,
    bottom: i64,
}

impl Clip {
    fn new(rect: Rect, pixels_per_point: f32, width: usize, height: usize) -> Self {
        // As egui_glow sets its scissor: rounded to whole pixels.
        let side = |value: f32, limit: usize| ((value * pixels_per_point).round() as i64).clamp(0, limit as i64);
        Self {
            left: side(rect.min.x, width),
            top: side(rect.min.y, height),
            right: side(rect.max.x, width),
            bottom: side(rect.max.y, height),
        }
    }

    fn is_empty(self) -> bool {
        self.left >= self.right || self.top >= self.bottom
    }
}

/// The first pixel whose centre lies at or behind a place in subpixels.
fn first_pixel(subpixels: i64) -> i64 {
    (subpixels - CENTRE + SUBPIXELS - 1).div_euclid(SUBPIXELS)
}

/// The nearest whole number; half is rounded away from zero. (`f64::round` is a call into the C
/// library where the processor's baseline has no such instruction.)
fn whole(value: f64) -> i64 {
    (if value < 0.0 { value - 0.5 } else { value + 0.5 }) as i64
}

/// A colour, premultiplied, each channel in 1/256 of a level.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Colour {
    r: u32,
    g: u32,
    b: u32,
    a: u32,
}

/// A full channel.
const OPAQUE: u32 = 255 * 256;

impl Colour {
    const NONE: Self = Self { r: 0, g: 0, b: 0, a: 0 };

    #[inline]
    fn of_bytes(bytes: [u8; 4]) -> Self {
        let [r, g, b, a] = bytes;
        Self { r: u32::from(r) << 8, g: u32::from(g) << 8, b: u32::from(b) << 8, a: u32::from(a) << 8 }
    }

    /// Channel by channel.
    #[inline]
    fn times(self, other: Self) -> Self {
        // Both factors are at most 65280, so the product fits.
        Self {
            r: self.r * other.r / OPAQUE,
            g: self.g * other.g / OPAQUE,
            b: self.b * other.b / OPAQUE,
            a: self.a * other.a / OPAQUE,
        }
    }

    /// All channels times a byte as a fraction of 255.
    #[inline]
    fn covered(self, by: u8) -> Self {
        let by = u32::from(by);
        Self { r: self.r * by / 255, g: self.g * by / 255, b: self.b * by / 255, a: self.a * by / 255 }
    }

    /// Puts it over a pixel of the picture, which stays opaque.
    #[inline]
    fn over(self, pixel: &mut [u8; 4]) {
        let rest = OPAQUE - self.a.min(OPAQUE);
        let mix = |source: u32, below: u8| ((source + u32::from(below) * rest / 255 + 128) >> 8).min(255) as u8;
        *pixel = [mix(self.r, pixel[0]), mix(self.g, pixel[1]), mix(self.b, pixel[2]), 255];
    }
}

struct Target {
    width: usize,
    pixels: Vec<[u8; 4]>,
    clip: Clip,
}

impl Target {
    /// An upright rectangle between its left top and right bottom corner.
    fn rectangle(&mut self, texture: &Texture, a: &Corner, d: &Corner) {
        let left = first_pixel(a.x).max(self.clip.left);
        let right = first_pixel(d.x).min(self.clip.right);
        let top = first_pixel(a.y).max(self.clip.top);
        let bottom = first_pixel(d.y).min(self.clip.bottom);
        if left >= right || top >= bottom {
            return;
        }
        let tint = Colour::of_bytes(a.color);
        if a.u == d.u && a.v == d.v {
            let source = tint.times(texture.at(a.u, a.v));
            for y in top..bottom {
                self.solid_span(y, left, right, source);
            }
            return;
        }
        // Both sides have a length here: at least one pixel centre lies between them.
        let step_u = texture.fixed(d.u - a.u, texture.width) / (d.x - a.x) as f64;
        let step_v = texture.fixed(d.v - a.v, texture.height) / (d.y - a.y) as f64;
        let u = texture.fixed(a.u, texture.width) + step_u * (left * SUBPIXELS + CENTRE - a.x) as f64;
        let v = texture.fixed(a.v, texture.height) + step_v * (top * SUBPIXELS + CENTRE - a.y) as f64;
        let (u, v) = (whole(u), whole(v));
        let (step_u, step_v) = (whole(step_u * SUBPIXELS as f64), whole(step_v * SUBPIXELS as f64));
        if let Some((column, row)) = texture.aligned(u, v, step_u, step_v, right - left, bottom - top) {
            for y in top..bottom {
                let texels = texture.row(row + (y - top) as usize, column, (right - left) as usize);
                glyph_span(self.span(y, left, right), texels, tint);
            }
            return;
        }
        for y in top..bottom {
            let v = v + step_v * (y - top);
            let from = Sample { color: Interpolated::constant(a.color), u, v };
            let step = Sample { color: Interpolated::ZERO, u: step_u, v: 0 };
            self.textured_span(texture, y, left, right, from, step);
        }
    }

    /// A triangle by the top-left rule: a pixel whose centre lies on an edge belongs to exactly one
    /// of the two triangles that share it.
    fn triangle(&mut self, texture: &Texture, a: Corner, mut b: Corner, mut c: Corner) {
        let mut twice_area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
        if twice_area == 0 {
            return;
        }
        if twice_area < 0 {
            std::mem::swap(&mut b, &mut c);
            twice_area = -twice_area;
        }
        let top = first_pixel(a.y.min(b.y).min(c.y)).max(self.clip.top);
        let bottom = (first_pixel(a.y.max(b.y).max(c.y)) + 1).min(self.clip.bottom);
        let left = first_pixel(a.x.min(b.x).min(c.x)).max(self.clip.left);
        let right = (first_pixel(a.x.max(b.x).max(c.x)) + 1).min(self.clip.right);
        if left >= right || top >= bottom {
            return;
        }
        let same_texel = a.u == b.u && a.v == b.v && a.u == c.u && a.v == c.v;
        let same_color = a.color == b.color && a.color == c.color;
        if same_texel && same_color && a.color == [0; 4] {
            return;
        }
        let paint = if same_texel && same_color {
            Paint::Solid(Colour::of_bytes(a.color).times(texture.at(a.u, a.v)))
        } else if same_texel {
            Paint::Shaded(Planes::new(None, &a, &b, &c, twice_area), texture.at(a.u, a.v))
        } else {
            Paint::Textured(Planes::new(Some(texture), &a, &b, &c, twice_area))
        };
        let mut edges = [Edge::new(&a, &b, top), Edge::new(&b, &c, top), Edge::new(&c, &a, top)];
        for y in top..bottom {
            let (mut from, mut to) = (left, right);
            for edge in &mut edges {
                edge.narrow(&mut from, &mut to);
            }
            if from >= to {
                continue;
            }
            match &paint {
                Paint::Solid(source) => self.solid_span(y, from, to, *source),
                Paint::Shaded(planes, texel) => {
                    let start = planes.sample(from, y).color;
                    self.shaded_span(y, from, to, *texel, start, planes.step.color);
                }
                Paint::Textured(planes) => {
                    self.textured_span(texture, y, from, to, planes.sample(from, y), planes.step);
                }
            }
        }
    }

    #[inline]
    fn span(&mut self, y: i64, from: i64, to: i64) -> &mut [[u8; 4]] {
        let start = y as usize * self.width;
        &mut self.pixels[start + from as usize..start + to as usize]
    }

    /// Pixels of one colour.
    #[inline]
    fn solid_span(&mut self, y: i64, from: i64, to: i64, source: Colour) {
        let span = self.span(y, from, to);
        if source.a == OPAQUE {
            let mut pixel = [0; 4];
            source.over(&mut pixel);
            span.fill(pixel);
        } else if source != Colour::NONE {
            for pixel in span {
                source.over(pixel);
            }
        }
    }

    /// Pixels with an interpolated colour times one texel.
    #[inline]
    fn shaded_span(&mut self, y: i64, from: i64, to: i64, texel: Colour, mut color: Interpolated, step: Interpolated) {
        let is_white = texel == Colour::of_bytes([255; 4]);
        for pixel in self.span(y, from, to) {
            let source = color.colour();
            let source = if is_white { source } else { source.times(texel) };
            source.over(pixel);
            color.advance(step);
        }
    }

    /// Pixels with an interpolated colour times a texture.
    fn textured_span(&mut self, texture: &Texture, y: i64, from: i64, to: i64, mut at: Sample, step: Sample) {
        for pixel in self.span(y, from, to) {
            let texel = texture.sample(at.u, at.v);
            if texel != Colour::NONE {
                at.color.colour().times(texel).over(pixel);
            }
            at.color.advance(step.color);
            at.u += step.u;
            at.v += step.v;
        }
    }
}

/// Pixels of one colour under texels that lie exactly on them: text, mostly. Letters are white, so
/// that one channel says all.
fn glyph_span(pixels: &mut [[u8; 4]], texels: &[[u8; 4]], tint: Colour) {
    for (pixel, texel) in pixels.iter_mut().zip(texels) {
        match *texel {
            [0, 0, 0, 0] => {}
            [r, g, b, a] if r == a && g == a && b == a => tint.covered(a).over(pixel),
            texel => tint.times(Colour::of_bytes(texel)).over(pixel),
        }
    }
}

/// What a triangle is painted with.
enum Paint {
    Solid(Colour),
    /// An interpolated colour, times one texel.
    Shaded(Planes, Colour),
    Textured(Planes),
}

/// One side of a triangle: which pixels of a row lie on its inner side, from row to row.
struct Edge {
    /// The sign of what a step to the right adds to the distance from the edge.
    slope: i64,
    /// Whole steps of the slope's size in the distance at column 0, and what is left of it.
    quotient: i64,
    rest: i64,
    /// What a row adds to both.
    row_quotient: i64,
    row_rest: i64,
    /// The slope's size; for a level edge, 1.
    size: i64,
}

impl Edge {
    fn new(from: &Corner, to: &Corner, first_row: i64) -> Self {
        let (dx, dy) = (to.x - from.x, to.y - from.y);
        // Going round clockwise with y down, left edges go up and top edges go right: a centre
        // exactly on them counts as inside.
        let bias = if dy < 0 || (dy == 0 && dx > 0) { 0 } else { -1 };
        // Inside: dx * (Y - y) - dy * (X - x) + bias >= 0, with X and Y the pixel's centre.
        let constant = dx * (first_row * SUBPIXELS + CENTRE - from.y) - dy * (CENTRE - from.x) + bias;
        let slope = dy * SUBPIXELS;
        let size = slope.abs().max(1);
        Self {
            slope: slope.signum(),
            quotient: constant.div_euclid(size),
            rest: constant.rem_euclid(size),
            row_quotient: (dx * SUBPIXELS).div_euclid(size),
            row_rest: (dx * SUBPIXELS).rem_euclid(size),
            size,
        }
    }

    /// Narrows the current row's pixels `from..to` to those inside, and goes on to the next row.
    #[inline]
    fn narrow(&mut self, from: &mut i64, to: &mut i64) {
        match self.slope {
            // The quotient is the distance itself.
            0 if self.quotient < 0 => *to = *from,
            0 => {}
            1 => *to = (*to).min(self.quotient + 1),
            _ => *from = (*from).max(-self.quotient),
        }
        self.quotient += self.row_quotient;
        self.rest += self.row_rest;
        if self.rest >= self.size {
            self.rest -= self.size;
            self.quotient += 1;
        }
    }
}

/// Colour channels in levels, with [`FRACTION_BITS`] behind the point.
#[derive(Clone, Copy)]
struct Interpolated {
    r: i64,
    g: i64,
    b: i64,
    a: i64,
}

impl Interpolated {
    const ZERO: Self = Self { r: 0, g: 0, b: 0, a: 0 };

    fn constant(bytes: [u8; 4]) -> Self {
        let [r, g, b, a] = bytes.map(|channel| i64::from(channel) << FRACTION_BITS);
        Self { r, g, b, a }
    }

    /// Rounding may have carried a channel a little out of range.
    #[inline]
    fn colour(self) -> Colour {
        let channel = |value: i64| (value >> (FRACTION_BITS - 8)).clamp(0, i64::from(OPAQUE)) as u32;
        Colour { r: channel(self.r), g: channel(self.g), b: channel(self.b), a: channel(self.a) }
    }

    #[inline]
    fn advance(&mut self, step: Self) {
        self.r += step.r;
        self.g += step.g;
        self.b += step.b;
        self.a += step.a;
    }
}

/// What is interpolated: a colour, and texture coordinates in texels with [`FRACTION_BITS`].
#[derive(Clone, Copy)]
struct Sample {
    color: Interpolated,
    u: i64,
    v: i64,
}

/// The planes through a triangle's values over the picture.
struct Planes {
    origin: (i64, i64),
    /// Four colours, u, v: at the origin, what a subpixel to the right adds, and one down.
    start: [f64; 6],
    right: [f64; 6],
    down: [f64; 6],
    /// Per pixel to the right.
    step: Sample,
}

impl Planes {
    fn new(texture: Option<&Texture>, a: &Corner, b: &Corner, c: &Corner, twice_area: i64) -> Self {
        let values = |corner: &Corner| -> [f64; 6] {
            let one = f64::from(1 << FRACTION_BITS);
            let [r, g, b, a] = corner.color;
            let (u, v) = texture.map_or((0.0, 0.0), |texture| {
                (texture.fixed(corner.u, texture.width), texture.fixed(corner.v, texture.height))
            });
            [f64::from(r) * one, f64::from(g) * one, f64::from(b) * one, f64::from(a) * one, u, v]
        };
        let (start, at_b, at_c) = (values(a), values(b), values(c));
        let per_area = 1.0 / twice_area as f64;
        let (bx, by) = ((b.x - a.x) as f64, (b.y - a.y) as f64);
        let (cx, cy) = ((c.x - a.x) as f64, (c.y - a.y) as f64);
        let (mut right, mut down, mut step) = ([0.0; 6], [0.0; 6], [0.0; 6]);
        for i in 0..6 {
            let (to_b, to_c) = (at_b[i] - start[i], at_c[i] - start[i]);
            right[i] = (to_b * cy - to_c * by) * per_area;
            down[i] = (to_c * bx - to_b * cx) * per_area;
            step[i] = right[i] * SUBPIXELS as f64;
        }
        Self { origin: (a.x, a.y), start, right, down, step: fixed_sample(&step) }
    }

    /// The values at a pixel's centre.
    #[inline]
    fn sample(&self, x: i64, y: i64) -> Sample {
        let across = (x * SUBPIXELS + CENTRE - self.origin.0) as f64;
        let down = (y * SUBPIXELS + CENTRE - self.origin.1) as f64;
        let mut values = [0.0; 6];
        for (i, value) in values.iter_mut().enumerate() {
            *value = self.start[i] + self.right[i] * across + self.down[i] * down;
        }
        fixed_sample(&values)
    }
}

fn fixed_sample(values: &[f64; 6]) -> Sample {
    // The steps of a sliver may be huge; its spans are then a pixel long and never use them.
    let fixed = |value: f64| whole(value.clamp(-1e15, 1e15));
    let [r, g, b, a, u, v] = *values;
    let color = Interpolated { r: fixed(r), g: fixed(g), b: fixed(b), a: fixed(a) };
    Sample { color, u: fixed(u), v: fixed(v) }
}

impl Texture {
    /// A normalised texture coordinate in texels, scaled by [`FRACTION_BITS`].
    #[inline]
    fn fixed(&self, coordinate: f32, side: usize) -> f64 {
        f64::from(coordinate) * side as f64 * f64::from(1 << FRACTION_BITS)
    }

    /// The colour at normalised coordinates.
    fn at(&self, u: f32, v: f32) -> Colour {
        self.sample(whole(self.fixed(u, self.width)), whole(self.fixed(v, self.height)))
    }

    /// The column and row of the first texel, when a rectangle's texels lie exactly on its pixels.
    fn aligned(&self, u: i64, v: i64, step_u: i64, step_v: i64, width: i64, height: i64) -> Option<(usize, usize)> {
        const ONE: i64 = 1 << FRACTION_BITS;
        // The weights between texels have 8 bits: what rounds to nothing there is nothing.
        let slack = 1 << (FRACTION_BITS - 9);
        let place = |at: i64, step: i64, count: i64| {
            let (index, rest) = ((at + slack) >> FRACTION_BITS, (at + slack) & (ONE - 1));
            let drift = (step - ONE).abs() * count;
            let is_centre = (rest - ONE / 2 - slack).abs() + drift < slack;
            (is_centre && index >= 0).then_some(index)
        };
        let column = place(u, step_u, width)?;
        let row = place(v, step_v, height)?;
        let fits = column + width <= self.width as i64 && row + height <= self.height as i64;
        fits.then_some((column as usize, row as usize))
    }

    #[inline]
    fn row(&self, row: usize, column: usize, count: usize) -> &[[u8; 4]] {
        let start = row * self.width + column;
        &self.texels[start..start + count]
    }

    /// The colour at coordinates in texels (with [`FRACTION_BITS`]).
    #[inline]
    fn sample(&self, u: i64, v: i64) -> Colour {
        if self.texels.is_empty() {
            return Colour::NONE;
        }
        if self.filter == TextureFilter::Nearest {
            return Colour::of_bytes(self.texel(u >> FRACTION_BITS, v >> FRACTION_BITS));
        }
        // Texel centres lie at halves; weights of 8 bits, as GPUs have.
        let half = 1 << (FRACTION_BITS - 1);
        let rounding = 1 << (FRACTION_BITS - 9);
        let u = (u - half + rounding) >> (FRACTION_BITS - 8);
        let v = (v - half + rounding) >> (FRACTION_BITS - 8);
        let (x, y) = (u >> 8, v >> 8);
        let (right, below) = ((u & 255) as u32, (v & 255) as u32);
        let (p, q, r, s) = (self.texel(x, y), self.texel(x + 1, y), self.texel(x, y + 1), self.texel(x + 1, y + 1));
        let mix = |i: usize| {
            let near = u32::from(p[i]) * (256 - right) + u32::from(q[i]) * right;
            let far = u32::from(r[i]) * (256 - right) + u32::from(s[i]) * right;
            (near * (256 - below) + far * below) >> 8
        };
        Colour { r: mix(0), g: mix(1), b: mix(2), a: mix(3) }
    }

    #[inline]
    fn texel(&self, x: i64, y: i64) -> [u8; 4] {
        let column = wrapped(x, self.width, self.wrap);
        let row = wrapped(y, self.height, self.wrap);
        self.texels[row * self.width + column]
    }
}

/// A texel's index within a side, by the texture's rule for coordinates beyond it.
#[inline]
fn wrapped(index: i64, side: usize, wrap: TextureWrapMode) -> usize {
    let side = side as i64;
    let inside = match wrap {
        TextureWrapMode::ClampToEdge => index.clamp(0, side - 1),
        TextureWrapMode::Repeat => index.rem_euclid(side),
        TextureWrapMode::MirroredRepeat => {
            let there_and_back = index.rem_euclid(2 * side);
            there_and_back.min(2 * side - 1 - there_and_back)
        }
    };
    inside as usize
}

#[cfg(test)]
mod tests {
    use crate::app::offscreen::raster::*;
    use egui::epaint::Mesh;
    use egui::{ColorImage, Pos2, TextureOptions, pos2};

    fn raster(texels: ColorImage, options: TextureOptions) -> Raster {
        let mut delta = TexturesDelta::default();
        delta.push(TextureId::default(), ImageDelta::full(texels, options));
        let mut raster = Raster::default();
        raster.update_textures(&mut delta);
        raster
    }

    fn white() -> Raster {
        raster(ColorImage::filled([1, 1], Color32::WHITE), TextureOptions::LINEAR)
    }

    fn painted(raster: &Raster, mesh: Mesh, side: u32, scale: f32) -> Picture {
        let primitive = ClippedPrimitive { clip_rect: Rect::EVERYTHING, primitive: Primitive::Mesh(mesh) };
        raster.paint(&[primitive], [side, side], scale, Color32::BLACK)
    }

    fn triangle(mesh: &mut Mesh, corners: [Pos2; 3], color: Color32) {
        let first = mesh.vertices.len() as u32;
        for corner in corners {
            mesh.colored_vertex(corner, color);
        }
        mesh.add_triangle(first, first + 1, first + 2);
    }

    /// A translucent fan about a point covers each pixel exactly once, whatever the directions of
    /// its edges.
    #[test]
    fn neighbouring_triangles_share_no_pixel_and_leave_none() {
        let mut mesh = Mesh::default();
        let centre = pos2(10.5, 9.25);
        let rim =
            [pos2(0.0, 0.0), pos2(10.5, 0.0), pos2(20.0, 0.0), pos2(20.0, 20.0), pos2(3.0, 20.0), pos2(0.0, 20.0)];
        for i in 0..rim.len() {
            let (a, b) = (rim[i], rim[(i + 1) % rim.len()]);
            // Both windings.
            let corners = if i % 2 == 0 { [centre, a, b] } else { [centre, b, a] };
            triangle(&mut mesh, corners, Color32::from_white_alpha(100));
        }
        let picture = painted(&white(), mesh, 20, 1.0);
        let expected = [100, 100, 100, 255];
        assert!(picture.rgba.chunks(4).all(|pixel| pixel == expected), "{:?}", &picture.rgba[..16]);
    }

    #[test]
    fn a_rectangle_covers_the_pixels_whose_centre_it_holds() {
        let mut mesh = Mesh::default();
        mesh.add_colored_rect(Rect::from_min_max(pos2(1.0, 1.5), pos2(3.0, 2.5)), Color32::WHITE);
        let picture = painted(&white(), mesh, 4, 1.0);
        let lit: Vec<usize> = (0..16).filter(|&i| picture.rgba[4 * i] == 255).collect();
        // Centres at y = 1.5 belong to the row above by the top-left rule.
        assert_eq!(lit, [5, 6]);
    }

    #[test]
    fn colours_run_evenly_and_scale_with_the_pixels() {
        let mut mesh = Mesh::default();
        for (x, y, level) in [(0.0, 0.0, 0), (4.0, 0.0, 255), (0.0, 4.0, 0), (4.0, 4.0, 255)] {
            mesh.colored_vertex(pos2(x, y), Color32::from_gray(level));
        }
        mesh.add_triangle(0, 1, 2);
        mesh.add_triangle(2, 1, 3);
        let picture = painted(&white(), mesh, 8, 2.0);
        let row: Vec<u8> = picture.rgba.chunks(4).take(8).map(|pixel| pixel[0]).collect();
        assert_eq!(row, [16, 48, 80, 112, 143, 175, 207, 239]);
    }

    #[test]
    fn textures_are_sampled_between_texels_and_patched() {
        let image = ColorImage::new([2, 1], vec![Color32::BLACK, Color32::WHITE]);
        let mut raster = raster(image, TextureOptions::LINEAR);
        let quad = || {
            let mut mesh = Mesh::default();
            let uv = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
            mesh.add_rect_with_uv(Rect::from_min_max(pos2(0.0, 0.0), pos2(4.0, 4.0)), uv, Color32::WHITE);
            mesh
        };
        let row = |raster: &Raster| -> Vec<u8> {
            painted(raster, quad(), 4, 1.0).rgba.chunks(4).take(4).map(|pixel| pixel[0]).collect()
        };
        assert_eq!(row(&raster), [0, 64, 191, 255]);
        let patch = ColorImage::filled([1, 1], Color32::WHITE);
        let mut delta = TexturesDelta::default();
        delta.push(TextureId::default(), ImageDelta::partial([0, 0], patch, TextureOptions::LINEAR));
        raster.update_textures(&mut delta);
        assert_eq!(row(&raster), [255; 4]);
        delta.free(TextureId::default());
        raster.free_textures(&mut delta);
        assert_eq!(row(&raster), [0; 4]);
    }

    #[test]
    fn the_scissor_cuts_and_wild_corners_do_no_harm() {
        let mut mesh = Mesh::default();
        triangle(&mut mesh, [pos2(-1e30, -1e30), pos2(1e30, -5.0), pos2(-5.0, 1e30)], Color32::WHITE);
        triangle(&mut mesh, [pos2(f32::NAN, 1.0), pos2(f32::INFINITY, 5.0), pos2(0.0, 0.0)], Color32::WHITE);
        let primitive = ClippedPrimitive {
            clip_rect: Rect::from_min_max(pos2(1.0, 1.0), pos2(3.0, 2.0)),
            primitive: Primitive::Mesh(mesh),
        };
        let picture = white().paint(&[primitive], [4, 4], 1.0, Color32::BLACK);
        let lit: Vec<usize> = (0..16).filter(|&i| picture.rgba[4 * i] == 255).collect();
        assert_eq!(lit, [5, 6]);
    }
}
