//! A CPU rasteriser of egui's tessellated output, so that the window can be seen without a display:
//! in tests, in replay scripts, in pictures for the manual.
//!
//! It does what egui's OpenGL shader does: triangles with colours interpolated between their
//! corners, times a texture, blended premultiplied in gamma space. All arithmetic behind the corner
//! positions is in whole numbers, so that the picture is the same on every machine.

use std::collections::BTreeMap;

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

/// A finished picture, opaque, rows from the top.
#[derive(Clone, PartialEq, Eq)]
pub struct Picture {
    pub width_px: u32,
    pub height_px: u32,
    /// Red, green, blue, alpha of each pixel.
    pub rgba: Vec<u8>,
}

impl std::fmt::Debug for Picture {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Picture({}x{})", self.width_px, self.height_px)
    }
}

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
        let place = |value: f32| (value * pixels_per_point * SUBPIXELS as f32).round().clamp(-FAR, FAR) as i64;
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
    (subpixels - CENTRE).div_euclid(SUBPIXELS) + i64::from((subpixels - CENTRE).rem_euclid(SUBPIXELS) != 0)
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
        if a.u == d.u && a.v == d.v {
            let source = tint(a.color, texture.at(a.u, a.v));
            for y in top..bottom {
                self.solid_span(y, left, right, source);
            }
            return;
        }
        // Both sides have a length here: at least one pixel centre lies between them.
        let step_u = texture.fixed(d.u - a.u, texture.width) / (d.x - a.x) as f64;
        let step_v = texture.fixed(d.v - a.v, texture.height) / (d.y - a.y) as f64;
        let start_u = texture.fixed(a.u, texture.width);
        let start_v = texture.fixed(a.v, texture.height);
        let color = a.color.map(|channel| i64::from(channel) << FRACTION_BITS);
        for y in top..bottom {
            let across = (left * SUBPIXELS + CENTRE - a.x) as f64;
            let down = (y * SUBPIXELS + CENTRE - a.y) as f64;
            let from = Sample {
                color,
                u: (start_u + step_u * across).round() as i64,
                v: (start_v + step_v * down).round() as i64,
            };
            let step = Sample { color: [0; 4], u: (step_u * SUBPIXELS as f64).round() as i64, v: 0 };
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
        let edges = [Edge::new(&a, &b), Edge::new(&b, &c), Edge::new(&c, &a)];
        let same_texel = a.u == b.u && a.v == b.v && a.u == c.u && a.v == c.v;
        let same_color = a.color == b.color && a.color == c.color;
        let solid = (same_texel && same_color).then(|| tint(a.color, texture.at(a.u, a.v)));
        let planes = match solid {
            Some(_) => None,
            None => Some(Planes::new(texture, &a, &b, &c, twice_area)),
        };
        for y in top..bottom {
            let (mut from, mut to) = (left, right);
            for edge in &edges {
                edge.narrow(y, &mut from, &mut to);
            }
            if from >= to {
                continue;
            }
            match (solid, &planes) {
                (Some(source), _) => self.solid_span(y, from, to, source),
                (None, Some(planes)) => {
                    let start = planes.sample(from, y);
                    if same_texel {
                        self.shaded_span(y, from, to, texture.at(a.u, a.v), start.color, planes.step.color);
                    } else {
                        self.textured_span(texture, y, from, to, start, planes.step);
                    }
                }
                (None, None) => {}
            }
        }
    }

    fn span(&mut self, y: i64, from: i64, to: i64) -> &mut [[u8; 4]] {
        let start = y as usize * self.width;
        &mut self.pixels[start + from as usize..start + to as usize]
    }

    /// Pixels of one colour, given in 1/256 of a level.
    fn solid_span(&mut self, y: i64, from: i64, to: i64, source: [u32; 4]) {
        let span = self.span(y, from, to);
        if source[3] == OPAQUE {
            span.fill(source.map(|channel| ((channel + 128) >> 8).min(255) as u8));
        } else if source != [0; 4] {
            for pixel in span {
                blend(pixel, source);
            }
        }
    }

    /// Pixels with an interpolated colour times one texel.
    fn shaded_span(&mut self, y: i64, from: i64, to: i64, texel: [u32; 4], mut color: [i64; 4], step: [i64; 4]) {
        for pixel in self.span(y, from, to) {
            let source = std::array::from_fn(|i| channel(color[i]) * texel[i] / OPAQUE);
            blend(pixel, source);
            for i in 0..4 {
                color[i] += step[i];
            }
        }
    }

    /// Pixels with an interpolated colour times a texture.
    fn textured_span(&mut self, texture: &Texture, y: i64, from: i64, to: i64, mut at: Sample, step: Sample) {
        for pixel in self.span(y, from, to) {
            let texel = texture.sample(at.u, at.v);
            if texel != [0; 4] {
                let source = std::array::from_fn(|i| channel(at.color[i]) * texel[i] / OPAQUE);
                blend(pixel, source);
            }
            at.advance(step);
        }
    }
}

/// A full channel in 1/256 of a level.
const OPAQUE: u32 = 255 * 256;

/// An interpolated colour channel in 1/256 of a level; rounding may have carried it out of range.
fn channel(value: i64) -> u32 {
    (value >> (FRACTION_BITS - 8)).clamp(0, i64::from(OPAQUE)) as u32
}

/// A vertex colour times a texel, in 1/256 of a level.
fn tint(color: [u8; 4], texel: [u32; 4]) -> [u32; 4] {
    std::array::from_fn(|i| u32::from(color[i]) * texel[i] / 255)
}

/// Puts a premultiplied colour, in 1/256 of a level, over a pixel.
#[inline]
fn blend(pixel: &mut [u8; 4], source: [u32; 4]) {
    let rest = OPAQUE - source[3].min(OPAQUE);
    for i in 0..3 {
        let value = source[i] + u32::from(pixel[i]) * rest / 255;
        pixel[i] = ((value + 128) >> 8).min(255) as u8;
    }
    // The picture stays opaque.
}

/// One side of a triangle: which pixels of a row lie on its inner side.
struct Edge {
    /// A corner on the edge.
    x: i64,
    y: i64,
    dx: i64,
    dy: i64,
    /// 0 when a centre exactly on the edge counts as inside, else -1.
    bias: i64,
}

impl Edge {
    fn new(from: &Corner, to: &Corner) -> Self {
        let (dx, dy) = (to.x - from.x, to.y - from.y);
        // Going round clockwise with y down, left edges go up and top edges go right.
        let top_left = dy < 0 || (dy == 0 && dx > 0);
        Self { x: from.x, y: from.y, dx, dy, bias: if top_left { 0 } else { -1 } }
    }

    /// Narrows a row's pixels `from..to` to those inside the edge.
    fn narrow(&self, row: i64, from: &mut i64, to: &mut i64) {
        // Inside: dx * (Y - y) - dy * (X - x) + bias >= 0, with X and Y the pixel's centre.
        let constant = self.dx * (row * SUBPIXELS + CENTRE - self.y) - self.dy * (CENTRE - self.x) + self.bias;
        let slope = self.dy * SUBPIXELS;
        match slope.signum() {
            0 if constant < 0 => *to = *from,
            0 => {}
            1 => *to = (*to).min(constant.div_euclid(slope) + 1),
            // -slope * column >= -constant, rounded up.
            _ => *from = (*from).max(-constant.div_euclid(-slope)),
        }
    }
}

/// What is interpolated: colour channels in levels and texture coordinates in texels, all with
/// [`FRACTION_BITS`] behind the point.
#[derive(Clone, Copy)]
struct Sample {
    color: [i64; 4],
    u: i64,
    v: i64,
}

impl Sample {
    fn advance(&mut self, step: Self) {
        for i in 0..4 {
            self.color[i] += step.color[i];
        }
        self.u += step.u;
        self.v += step.v;
    }
}

/// The planes through a triangle's values over the picture.
struct Planes {
    origin: (i64, i64),
    /// At the origin, then per subpixel to the right, then per subpixel down: four colours, u, v.
    values: [[f64; 6]; 3],
    /// Per pixel to the right.
    step: Sample,
}

impl Planes {
    fn new(texture: &Texture, a: &Corner, b: &Corner, c: &Corner, twice_area: i64) -> Self {
        let values = |corner: &Corner| -> [f64; 6] {
            let color = corner.color.map(|channel| f64::from(channel) * f64::from(1 << FRACTION_BITS));
            let u = texture.fixed(corner.u, texture.width);
            let v = texture.fixed(corner.v, texture.height);
            [color[0], color[1], color[2], color[3], u, v]
        };
        let (at_a, at_b, at_c) = (values(a), values(b), values(c));
        let area = twice_area as f64;
        let (bx, by) = ((b.x - a.x) as f64, (b.y - a.y) as f64);
        let (cx, cy) = ((c.x - a.x) as f64, (c.y - a.y) as f64);
        let right: [f64; 6] = std::array::from_fn(|i| ((at_b[i] - at_a[i]) * cy - (at_c[i] - at_a[i]) * by) / area);
        let down: [f64; 6] = std::array::from_fn(|i| ((at_c[i] - at_a[i]) * bx - (at_b[i] - at_a[i]) * cx) / area);
        let step = fixed_sample(right.map(|value| value * SUBPIXELS as f64));
        Self { origin: (a.x, a.y), values: [at_a, right, down], step }
    }

    /// The values at a pixel's centre.
    fn sample(&self, x: i64, y: i64) -> Sample {
        let across = (x * SUBPIXELS + CENTRE - self.origin.0) as f64;
        let down = (y * SUBPIXELS + CENTRE - self.origin.1) as f64;
        let [start, right, below] = &self.values;
        fixed_sample(std::array::from_fn(|i| start[i] + right[i] * across + below[i] * down))
    }
}

fn fixed_sample(values: [f64; 6]) -> Sample {
    // The steps of a sliver may be huge; its spans are then a pixel long and never use them.
    let whole = values.map(|value| value.round().clamp(-1e15, 1e15) as i64);
    Sample { color: [whole[0], whole[1], whole[2], whole[3]], u: whole[4], v: whole[5] }
}

impl Texture {
    /// A normalised texture coordinate in texels, scaled by [`FRACTION_BITS`].
    fn fixed(&self, coordinate: f32, side: usize) -> f64 {
        f64::from(coordinate) * side as f64 * f64::from(1 << FRACTION_BITS)
    }

    /// The colour at normalised coordinates, each channel in 1/256 of a level.
    fn at(&self, u: f32, v: f32) -> [u32; 4] {
        self.sample(self.fixed(u, self.width).round() as i64, self.fixed(v, self.height).round() as i64)
    }

    /// The colour at coordinates in texels (with [`FRACTION_BITS`]), each channel in 1/256 of a
    /// level.
    #[inline]
    fn sample(&self, u: i64, v: i64) -> [u32; 4] {
        if self.texels.is_empty() {
            return [0; 4];
        }
        if self.filter == TextureFilter::Nearest {
            let texel = self.texel(u >> FRACTION_BITS, v >> FRACTION_BITS);
            return texel.map(|channel| u32::from(channel) << 8);
        }
        // Texel centres lie at halves; weights of 8 bits, as GPUs have.
        let half = 1 << (FRACTION_BITS - 1);
        let rounding = 1 << (FRACTION_BITS - 9);
        let u = (u - half + rounding) >> (FRACTION_BITS - 8);
        let v = (v - half + rounding) >> (FRACTION_BITS - 8);
        let (x, y) = (u >> 8, v >> 8);
        let (right, below) = ((u & 255) as u32, (v & 255) as u32);
        if right == 0 && below == 0 {
            return self.texel(x, y).map(|channel| u32::from(channel) << 8);
        }
        let near = [self.texel(x, y), self.texel(x + 1, y)];
        let far = [self.texel(x, y + 1), self.texel(x + 1, y + 1)];
        std::array::from_fn(|i| {
            let mix = |pair: &[[u8; 4]; 2]| u32::from(pair[0][i]) * (256 - right) + u32::from(pair[1][i]) * right;
            (mix(&near) * (256 - below) + mix(&far) * below) >> 8
        })
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
    use super::*;
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
