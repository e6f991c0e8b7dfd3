//! The parts of painting triangles: vertices, edges in fixed point, colours and textures.

use super::*;

pub(super) struct Texture {
    pub(super) width: usize,
    pub(super) height: usize,
    /// Premultiplied, rows from the top.
    pub(super) texels: Vec<[u8; 4]>,
    pub(super) filter: TextureFilter,
    pub(super) wrap: TextureWrapMode,
}

/// A mesh's vertex in subpixels.
#[derive(Clone, Copy)]
pub(super) struct Corner {
    pub(super) x: i64,
    pub(super) y: i64,
    pub(super) u: f32,
    pub(super) v: f32,
    pub(super) color: [u8; 4],
}

impl Corner {
    pub(super) fn new(vertex: &Vertex, pixels_per_point: f32) -> Self {
        // Float to integer casts saturate, and NaN becomes 0: fine here.
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

/// Whether the vertices (top left, top right, bottom left, bottom right) form an axis-aligned rectangle
/// of one colour with an axis-aligned texture.
pub(super) fn is_rectangle(a: &Corner, b: &Corner, c: &Corner, d: &Corner) -> bool {
    let upright = a.x == c.x && b.x == d.x && a.y == b.y && c.y == d.y && a.x <= b.x && a.y <= c.y;
    let texture = a.u == c.u && b.u == d.u && a.v == b.v && c.v == d.v;
    upright && texture && a.color == b.color && a.color == c.color && a.color == d.color
}

/// A colour, premultiplied, each channel in 1/256 of a level.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) struct Colour {
    pub(super) r: u32,
    pub(super) g: u32,
    pub(super) b: u32,
    pub(super) a: u32,
}

impl Colour {
    pub(super) const NONE: Self = Self { r: 0, g: 0, b: 0, a: 0 };

    #[inline]
    pub(super) fn of_bytes(bytes: [u8; 4]) -> Self {
        let [r, g, b, a] = bytes;
        Self { r: u32::from(r) << 8, g: u32::from(g) << 8, b: u32::from(b) << 8, a: u32::from(a) << 8 }
    }

    /// Multiplies channel by channel.
    #[inline]
    pub(super) fn times(self, other: Self) -> Self {
        // Both factors are at most 65280, so the product fits.
        Self {
            r: self.r * other.r / OPAQUE,
            g: self.g * other.g / OPAQUE,
            b: self.b * other.b / OPAQUE,
            a: self.a * other.a / OPAQUE,
        }
    }

    /// Multiplies all channels by a byte as a fraction of 255.
    #[inline]
    pub(super) fn covered(self, by: u8) -> Self {
        let by = u32::from(by);
        Self { r: self.r * by / 255, g: self.g * by / 255, b: self.b * by / 255, a: self.a * by / 255 }
    }

    /// Blends it over a pixel of the picture, which stays opaque.
    #[inline]
    pub(super) fn over(self, pixel: &mut [u8; 4]) {
        let rest = OPAQUE - self.a.min(OPAQUE);
        let mix = |source: u32, below: u8| ((source + u32::from(below) * rest / 255 + 128) >> 8).min(255) as u8;
        *pixel = [mix(self.r, pixel[0]), mix(self.g, pixel[1]), mix(self.b, pixel[2]), 255];
    }
}

/// Pixels of one colour under texels that lie exactly on them: mostly text. Letters are white, so one
/// channel is enough.
pub(super) fn glyph_span(pixels: &mut [[u8; 4]], texels: &[[u8; 4]], tint: Colour) {
    for (pixel, texel) in pixels.iter_mut().zip(texels) {
        match *texel {
            [0, 0, 0, 0] => {}
            [r, g, b, a] if r == a && g == a && b == a => tint.covered(a).over(pixel),
            texel => tint.times(Colour::of_bytes(texel)).over(pixel),
        }
    }
}

/// What to paint a triangle with.
pub(super) enum Paint {
    Solid(Colour),
    /// An interpolated colour, times one texel.
    Shaded(Planes, Colour),
    Textured(Planes),
}

/// One edge of a triangle: which pixels of a row are on its inner side, row by row.
pub(super) struct Edge {
    /// The sign of the change in distance from the edge per step to the right.
    pub(super) slope: i64,
    /// The distance at column 0 divided by the slope's size: quotient and remainder.
    pub(super) quotient: i64,
    pub(super) rest: i64,
    /// The change of both per row.
    pub(super) row_quotient: i64,
    pub(super) row_rest: i64,
    /// The slope's size; 1 for a horizontal edge.
    pub(super) size: i64,
}

impl Edge {
    pub(super) fn new(from: &Corner, to: &Corner, first_row: i64) -> Self {
        let (dx, dy) = (to.x - from.x, to.y - from.y);
        // Going clockwise with y down, left edges go up and top edges go right: a centre exactly on them
        // counts as inside.
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

    /// Narrows the current row's pixels `from..to` to those inside, and advances to the next row.
    #[inline]
    pub(super) fn narrow(&mut self, from: &mut i64, to: &mut i64) {
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

/// Colour channels in levels, with [`FRACTION_BITS`] fraction bits.
#[derive(Clone, Copy)]
pub(super) struct Interpolated {
    pub(super) r: i64,
    pub(super) g: i64,
    pub(super) b: i64,
    pub(super) a: i64,
}

impl Interpolated {
    pub(super) const ZERO: Self = Self { r: 0, g: 0, b: 0, a: 0 };

    pub(super) fn constant(bytes: [u8; 4]) -> Self {
        let [r, g, b, a] = bytes.map(|channel| i64::from(channel) << FRACTION_BITS);
        Self { r, g, b, a }
    }

    /// Rounding may have moved a channel slightly out of range.
    #[inline]
    pub(super) fn colour(self) -> Colour {
        let channel = |value: i64| (value >> (FRACTION_BITS - 8)).clamp(0, i64::from(OPAQUE)) as u32;
        Colour { r: channel(self.r), g: channel(self.g), b: channel(self.b), a: channel(self.a) }
    }

    #[inline]
    pub(super) fn advance(&mut self, step: Self) {
        self.r += step.r;
        self.g += step.g;
        self.b += step.b;
        self.a += step.a;
    }
}

/// The interpolated values: a colour, and texture coordinates in texels with [`FRACTION_BITS`].
#[derive(Clone, Copy)]
pub(super) struct Sample {
    pub(super) color: Interpolated,
    pub(super) u: i64,
    pub(super) v: i64,
}

/// The planes of a triangle's values over the picture.
pub(super) struct Planes {
    pub(super) origin: (i64, i64),
    /// Four colour channels, u, v: at the origin, change per subpixel to the right, and down.
    pub(super) start: [f64; 6],
    pub(super) right: [f64; 6],
    pub(super) down: [f64; 6],
    /// Per pixel to the right.
    pub(super) step: Sample,
}

impl Planes {
    pub(super) fn new(texture: Option<&Texture>, a: &Corner, b: &Corner, c: &Corner, twice_area: i64) -> Self {
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
    pub(super) fn sample(&self, x: i64, y: i64) -> Sample {
        let across = (x * SUBPIXELS + CENTRE - self.origin.0) as f64;
        let down = (y * SUBPIXELS + CENTRE - self.origin.1) as f64;
        let mut values = [0.0; 6];
        for (i, value) in values.iter_mut().enumerate() {
            *value = self.start[i] + self.right[i] * across + self.down[i] * down;
        }
        fixed_sample(&values)
    }
}

pub(super) fn fixed_sample(values: &[f64; 6]) -> Sample {
    // The steps of a sliver may be huge, but its spans are then a pixel long and never use them.
    let fixed = |value: f64| whole(value.clamp(-1e15, 1e15));
    let [r, g, b, a, u, v] = *values;
    let color = Interpolated { r: fixed(r), g: fixed(g), b: fixed(b), a: fixed(a) };
    Sample { color, u: fixed(u), v: fixed(v) }
}

impl Texture {
    /// A normalised texture coordinate in texels, scaled by [`FRACTION_BITS`].
    #[inline]
    pub(super) fn fixed(&self, coordinate: f32, side: usize) -> f64 {
        f64::from(coordinate) * side as f64 * f64::from(1 << FRACTION_BITS)
    }

    /// The colour at normalised coordinates.
    pub(super) fn at(&self, u: f32, v: f32) -> Colour {
        self.sample(whole(self.fixed(u, self.width)), whole(self.fixed(v, self.height)))
    }

    /// The column and row of the first texel, if a rectangle's texels lie exactly on its pixels.
    pub(super) fn aligned(
        &self,
        u: i64,
        v: i64,
        step_u: i64,
        step_v: i64,
        width: i64,
        height: i64,
    ) -> Option<(usize, usize)> {
        const ONE: i64 = 1 << FRACTION_BITS;
        // The weights between texels have 8 bits: anything that rounds to zero there does not matter.
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
    pub(super) fn row(&self, row: usize, column: usize, count: usize) -> &[[u8; 4]] {
        let start = row * self.width + column;
        &self.texels[start..start + count]
    }

    /// The colour at coordinates in texels (with [`FRACTION_BITS`]).
    #[inline]
    pub(super) fn sample(&self, u: i64, v: i64) -> Colour {
        if self.texels.is_empty() {
            return Colour::NONE;
        }
        if self.filter == TextureFilter::Nearest {
            return Colour::of_bytes(self.texel(u >> FRACTION_BITS, v >> FRACTION_BITS));
        }
        // Texel centres are at halves; weights have 8 bits, as in GPUs.
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
    pub(super) fn texel(&self, x: i64, y: i64) -> [u8; 4] {
        let column = wrapped(x, self.width, self.wrap);
        let row = wrapped(y, self.height, self.wrap);
        self.texels[row * self.width + column]
    }
}

/// The index of a texel along a side, by the texture's wrapping rule.
#[inline]
pub(super) fn wrapped(index: i64, side: usize, wrap: TextureWrapMode) -> usize {
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
