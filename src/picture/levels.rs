//! Mipmaps: a picture at several sizes, each half the one before. Zoomed out, a smaller one is shown, so
//! that its lines stay sharp and few pixels are touched.

/// The pixel format, and its size in bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Samples {
    /// One byte, black to white.
    Grey,
    /// Red, green, blue.
    Rgb,
    /// Red, green, blue, alpha (straight).
    Rgba,
}

impl Samples {
    /// Bytes per pixel.
    pub const fn bytes(self) -> usize {
        match self {
            Self::Grey => 1,
            Self::Rgb => 3,
            Self::Rgba => 4,
        }
    }
}

/// A picture at one size, rows from top to bottom.
#[derive(Clone, PartialEq, Eq)]
pub struct Level {
    pub width_px: u32,
    pub height_px: u32,
    pub samples: Samples,
    pub data: Vec<u8>,
}

impl std::fmt::Debug for Level {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Level({} by {}, {:?})", self.width_px, self.height_px, self.samples)
    }
}

impl Level {
    /// The same picture in the smallest format that holds it: colour scans are often grey and opaque.
    pub(crate) fn simplified(self) -> Self {
        let size = self.samples.bytes();
        let is_opaque = self.samples != Samples::Rgba || self.data.chunks_exact(4).all(|pixel| pixel[3] == 255);
        if self.samples == Samples::Grey || !is_opaque {
            return self;
        }
        let is_grey = self.data.chunks_exact(size).all(|pixel| pixel[0] == pixel[1] && pixel[1] == pixel[2]);
        let kept = match (is_grey, self.samples) {
            (true, _) => Samples::Grey,
            (false, Samples::Rgba) => Samples::Rgb,
            (false, _) => return self,
        };
        let data = self.data.chunks_exact(size).flat_map(|pixel| &pixel[..kept.bytes()]).copied().collect();
        Self { samples: kept, data, ..self }
    }

    /// Red, green, blue and alpha (straight) of a pixel; outside the picture, of the nearest one.
    pub fn pixel(&self, x: i64, y: i64) -> [u8; 4] {
        let x = x.clamp(0, i64::from(self.width_px) - 1) as usize;
        let y = y.clamp(0, i64::from(self.height_px) - 1) as usize;
        let at = (y * self.width_px as usize + x) * self.samples.bytes();
        match (self.samples, self.data.get(at..at + self.samples.bytes())) {
            (Samples::Grey, Some(&[level])) => [level, level, level, 255],
            (Samples::Rgb, Some(&[r, g, b])) => [r, g, b, 255],
            (Samples::Rgba, Some(&[r, g, b, a])) => [r, g, b, a],
            _ => [0; 4],
        }
    }

    /// Half the size: each pixel is the mean of four. An odd last row or column counts for itself.
    fn halved(&self) -> Self {
        let size = self.samples.bytes();
        let (width, height) = (self.width_px as usize, self.height_px as usize);
        let (half_width, half_height) = (width.div_ceil(2), height.div_ceil(2));
        let mut data = Vec::with_capacity(half_width * half_height * size);
        for y in 0..half_height {
            let row = |y: usize| {
                let start = y.min(height - 1) * width * size;
                &self.data[start..start + width * size]
            };
            let (upper, lower) = (row(2 * y), row(2 * y + 1));
            for x in 0..half_width {
                let (left, right) = (2 * x * size, (2 * x + 1).min(width - 1) * size);
                let four = [&upper[left..], &upper[right..], &lower[left..], &lower[right..]];
                if self.samples == Samples::Rgba {
                    // Colours are weighted by their alpha.
                    let alpha: u32 = four.iter().map(|pixel| u32::from(pixel[3])).sum();
                    for channel in 0..3 {
                        let sum: u32 = four.iter().map(|pixel| u32::from(pixel[channel]) * u32::from(pixel[3])).sum();
                        data.push((sum + alpha / 2).checked_div(alpha).unwrap_or(0) as u8);
                    }
                    data.push(((alpha + 2) / 4) as u8);
                } else {
                    for channel in 0..size {
                        let sum: u32 = four.iter().map(|pixel| u32::from(pixel[channel])).sum();
                        data.push(((sum + 2) / 4) as u8);
                    }
                }
            }
        }
        Self { width_px: half_width as u32, height_px: half_height as u32, samples: self.samples, data }
    }
}

/// The largest side of the smallest level, in pixels.
const SMALLEST_SIDE_PX: u32 = 256;

/// A picture at full size, half size, and so on.
#[derive(Clone, Debug)]
pub struct PictureLevels(Vec<Level>);

impl PictureLevels {
    /// All levels of a picture, which must have at least one pixel. Uses a third more memory than the
    /// picture.
    pub fn new(full: Level) -> Self {
        let mut levels = vec![full];
        while let Some(last) = levels.last()
            && last.width_px.max(last.height_px) > SMALLEST_SIDE_PX
        {
            let half = last.halved();
            levels.push(half);
        }
        Self(levels)
    }

    /// The full size in pixels.
    pub fn size_px(&self) -> [u32; 2] {
        self.0.first().map_or([0, 0], |full| [full.width_px, full.height_px])
    }

    /// All levels, the full one first: a pixel of level `n` covers `2^n` by `2^n` pixels.
    pub fn all(&self) -> &[Level] {
        &self.0
    }

    /// The level to show when a pixel of the picture covers this many screen pixels: its pixels are
    /// scaled by at most the square root of two either way, unless the levels run out.
    pub fn index_for(&self, screen_px_per_pixel: f64) -> usize {
        let halvings = (-screen_px_per_pixel.max(1e-9).log2()).round().max(0.0);
        (halvings as usize).min(self.0.len().saturating_sub(1))
    }

    /// Bytes used by the pixels.
    pub fn bytes(&self) -> usize {
        self.0.iter().map(|level| level.data.len()).sum()
    }
}

#[cfg(test)]
mod tests {
    use crate::picture::levels::*;

    fn level(width_px: u32, samples: Samples, data: &[u8]) -> Level {
        let height_px = data.len() as u32 / width_px / samples.bytes() as u32;
        Level { width_px, height_px, samples, data: data.to_vec() }
    }

    #[test]
    fn sizes_halve_to_the_mean() {
        assert_eq!(level(2, Samples::Grey, &[0, 100, 100, 200]).halved(), level(1, Samples::Grey, &[100]));
        assert_eq!(level(3, Samples::Grey, &[0, 2, 9]).halved(), level(2, Samples::Grey, &[1, 9]));
        // Transparent pixels contribute no colour.
        let mixed = [200, 0, 0, 255, 0, 0, 0, 0];
        assert_eq!(level(2, Samples::Rgba, &mixed).halved(), level(1, Samples::Rgba, &[200, 0, 0, 128]));
        let levels = PictureLevels::new(level(1000, Samples::Grey, &vec![7; 1000 * 700]));
        let sizes: Vec<[u32; 2]> = levels.all().iter().map(|level| [level.width_px, level.height_px]).collect();
        assert_eq!(sizes, [[1000, 700], [500, 350], [250, 175]]);
        assert_eq!([2.0, 1.0, 0.6, 0.5, 0.26, 0.01].map(|scale| levels.index_for(scale)), [0, 0, 1, 1, 2, 2]);
    }

    #[test]
    fn grey_scans_in_colour_take_a_byte() {
        assert_eq!(level(1, Samples::Rgb, &[5, 5, 5]).simplified(), level(1, Samples::Grey, &[5]));
        assert_eq!(level(1, Samples::Rgba, &[5, 6, 5, 255]).simplified(), level(1, Samples::Rgb, &[5, 6, 5]));
        let seen_through = level(1, Samples::Rgba, &[5, 5, 5, 254]);
        assert_eq!(seen_through.clone().simplified(), seen_through);
        assert_eq!(seen_through.pixel(-3, 9), [5, 5, 5, 254]);
    }
}
