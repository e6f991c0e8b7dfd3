//! A CPU rasteriser for egui's tessellated output, so that the window can be rendered without a display:
//! in tests, in replay scripts, for the manual's pictures.
//!
//! It does what egui's OpenGL shader does: triangles with colours interpolated between their vertices,
//! times a texture, blended premultiplied in gamma space. All arithmetic after the vertex positions is in
//! integers, so that the result is the same on every machine.

mod parts;

use parts::*;
use std::collections::BTreeMap;

use crate::picture::Picture;
use egui::epaint::{ClippedPrimitive, ImageData, ImageDelta, Primitive, Vertex};
use egui::{Color32, Rect, TextureFilter, TextureId, TextureWrapMode, TexturesDelta};

/// Subpixels per pixel along each axis: the minimum of GPUs.
const SUBPIXELS: i64 = 256;

/// The centre of a pixel in subpixels, where coverage is tested.
const CENTRE: i64 = SUBPIXELS / 2;

/// Vertices further out than a million pixels are clamped, so that products of two coordinates in
/// subpixels fit 64 bits.
const FAR: f32 = (1 << 28) as f32;

/// Fraction bits of an interpolated value.
const FRACTION_BITS: u32 = 16;

/// Keeps egui's textures and renders frames with them.
#[derive(Default)]
pub struct Raster {
    textures: BTreeMap<u64, Texture>,
}

impl Raster {
    /// Applies new and changed textures. Textures to be freed may be used by the frame they came with, so
    /// they are dropped at the next call.
    pub fn update_textures(&mut self, delta: &mut TexturesDelta) {
        for (id, changes) in delta.set.drain() {
            for change in changes {
                self.set_texture(key(id), &change);
            }
        }
    }

    /// Drops textures no longer used; call it after painting.
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

    /// Paints a frame of `size_px` pixels on an opaque background. Skips meshes with an unknown texture,
    /// and paint callbacks (which Enfilade does not use).
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
                // Two triangles that egui made from one rectangle: most of a frame's area and all of its
                // text.
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

/// The key of a texture: user textures are separate from egui's own.
fn key(id: TextureId) -> u64 {
    match id {
        TextureId::Managed(number) => number << 1,
        TextureId::User(number) => number << 1 | 1,
    }
}

/// The clip rectangle in pixels; the right and bottom edges are excluded.
#[derive(Clone, Copy, Default)]
struct Clip {
    left: i64,
    top: i64,
    right: i64,
    bottom: i64,
}

impl Clip {
    fn new(rect: Rect, pixels_per_point: f32, width: usize, height: usize) -> Self {
        // Rounded to whole pixels, like egui_glow's scissor.
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

/// The first pixel whose centre is at or after a position in subpixels.
fn first_pixel(subpixels: i64) -> i64 {
    (subpixels - CENTRE + SUBPIXELS - 1).div_euclid(SUBPIXELS)
}

/// The nearest integer, with halves rounded away from zero. (`f64::round` is a call into the C library if
/// the baseline processor has no such instruction.)
fn whole(value: f64) -> i64 {
    (if value < 0.0 { value - 0.5 } else { value + 0.5 }) as i64
}

/// A full channel.
const OPAQUE: u32 = 255 * 256;

struct Target {
    width: usize,
    pixels: Vec<[u8; 4]>,
    clip: Clip,
}

impl Target {
    /// An axis-aligned rectangle between its top left and bottom right vertices.
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
        // Both sides have a length here: at least one pixel centre is between them.
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

    /// A triangle by the top-left rule: a pixel whose centre is on an edge belongs to exactly one of the
    /// two triangles that share it.
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

    /// A translucent fan around a point covers each pixel exactly once, whatever the directions of its
    /// edges.
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
        // By the top-left rule, centres at y = 1.5 belong to the row above.
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
