//! Pictures of the window: saving them as PNG and comparing them.

use std::io::{BufRead, Seek};

use super::png::{Packing, PictureError, encode_rgba};

/// A picture, rows from top to bottom.
#[derive(Clone, PartialEq, Eq)]
pub struct Picture {
    pub width_px: u32,
    pub height_px: u32,
    /// Red, green, blue, alpha (straight) of each pixel.
    pub rgba: Vec<u8>,
}

/// How two pictures of the same size differ.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Difference {
    /// The number of pixels that differ.
    pub pixels: usize,
    /// The largest difference of a channel, 1 to 255.
    pub largest: u8,
    /// The first picture, faint, with the differing pixels in red.
    pub picture: Picture,
}

impl std::fmt::Debug for Picture {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Picture({} by {})", self.width_px, self.height_px)
    }
}

impl Picture {
    /// Reads a PNG of at most `most_pixels`.
    ///
    /// # Errors
    /// When it is not a PNG, is damaged, or is too large; the message says which.
    pub fn from_png(source: impl BufRead + Seek, most_pixels: usize) -> Result<Self, String> {
        let most_bytes = most_pixels.saturating_mul(4);
        let mut decoder = png::Decoder::new_with_limits(source, png::Limits { bytes: most_bytes });
        decoder.set_transformations(png::Transformations::normalize_to_color8());
        let what = |error: png::DecodingError| match error {
            png::DecodingError::LimitsExceeded => "it has too many pixels".to_owned(),
            error => format!("it is no readable PNG ({error})"),
        };
        let mut reader = decoder.read_info().map_err(what)?;
        let (width_px, height_px) = reader.info().size();
        let bytes = reader.output_buffer_size().filter(|_| width_px as usize * height_px as usize <= most_pixels);
        let Some(bytes) = bytes else {
            return Err(format!("it has {width_px} by {height_px} pixels, which is too many"));
        };
        let mut data = vec![0; bytes];
        let frame = reader.next_frame(&mut data).map_err(what)?;
        data.truncate(frame.buffer_size());
        let rgba: Vec<u8> = match frame.color_type {
            png::ColorType::Rgba => data,
            png::ColorType::Rgb | png::ColorType::Indexed => {
                data.chunks_exact(3).flat_map(|p| [p[0], p[1], p[2], 255]).collect()
            }
            png::ColorType::Grayscale => data.iter().flat_map(|&level| [level, level, level, 255]).collect(),
            png::ColorType::GrayscaleAlpha => data.chunks_exact(2).flat_map(|p| [p[0], p[0], p[0], p[1]]).collect(),
        };
        if rgba.len() != width_px as usize * height_px as usize * 4 {
            return Err("its pixels are incomplete".to_owned());
        }
        Ok(Self { width_px, height_px, rgba })
    }

    /// The bytes of a PNG, as small as possible: no alpha channel if all is opaque.
    ///
    /// # Errors
    /// When the picture has no pixels.
    pub fn to_png(&self) -> Result<Vec<u8>, PictureError> {
        let packing = Packing { compression: png::Compression::Balanced, ..Packing::default() };
        encode_rgba(self.width_px, self.height_px, &self.rgba, packing)
    }

    /// The rectangle between two corners, in pixels; the right and bottom edges are excluded.
    pub fn part(&self, from: [u32; 2], to: [u32; 2]) -> Self {
        let [left, top] = [from[0].min(self.width_px), from[1].min(self.height_px)];
        let [right, bottom] = [to[0].clamp(left, self.width_px), to[1].clamp(top, self.height_px)];
        if (left, top, right, bottom) == (0, 0, self.width_px, self.height_px) {
            return self.clone();
        }
        let row = |y: u32| {
            let start = (y * self.width_px + left) as usize * 4;
            &self.rgba[start..start + (right - left) as usize * 4]
        };
        let rgba = (top..bottom).flat_map(row).copied().collect();
        Self { width_px: right - left, height_px: bottom - top, rgba }
    }

    /// How another picture differs from this one; `None` if it is identical. Pictures of different sizes
    /// differ in every pixel.
    pub fn difference(&self, other: &Self) -> Option<Difference> {
        if self == other {
            return None;
        }
        if (self.width_px, self.height_px) != (other.width_px, other.height_px) {
            let pixels = (other.rgba.len() / 4).max(self.rgba.len() / 4);
            return Some(Difference { pixels, largest: 255, picture: other.clone() });
        }
        let (mut pixels, mut largest) = (0, 0);
        let rgba = self
            .rgba
            .chunks_exact(4)
            .zip(other.rgba.chunks_exact(4))
            .flat_map(|(p, q)| {
                if p == q {
                    // At a quarter of its strength on white.
                    let faint = |level: u8| 191 + level / 4;
                    return [faint(p[0]), faint(p[1]), faint(p[2]), 255];
                }
                pixels += 1;
                let by = p.iter().zip(q).map(|(p, q)| p.abs_diff(*q)).max().unwrap_or(0);
                largest = largest.max(by);
                // Small differences must show too.
                let rest = 160 - (by / 2).min(160);
                [255, rest, rest, 255]
            })
            .collect();
        let picture = Self { width_px: self.width_px, height_px: self.height_px, rgba };
        Some(Difference { pixels, largest, picture })
    }
}

#[cfg(test)]
mod tests {
    use crate::picture::image::*;
    use std::io::Cursor;

    fn picture(rgba: &[u8]) -> Picture {
        Picture { width_px: rgba.len() as u32 / 4, height_px: 1, rgba: rgba.to_vec() }
    }

    #[test]
    fn a_png_holds_the_picture() {
        for rgba in [vec![1, 2, 3, 255, 4, 5, 6, 255], vec![1, 2, 3, 0, 4, 5, 6, 255]] {
            let bytes = picture(&rgba).to_png().expect("it has pixels");
            assert_eq!(Picture::from_png(Cursor::new(&bytes), 2), Ok(picture(&rgba)));
            let error = Picture::from_png(Cursor::new(&bytes), 1).expect_err("it is too large");
            assert!(error.contains("too many"), "{error}");
            let error = Picture::from_png(Cursor::new(&bytes[..bytes.len() - 20]), 2).expect_err("it is cut off");
            assert!(error.contains("PNG"), "{error}");
        }
        assert!(Picture::from_png(Cursor::new(b"GIF89a"), 100).is_err());
    }

    #[test]
    fn a_difference_counts_and_shows() {
        let (p, q) = (picture(&[0, 0, 0, 255, 8, 8, 8, 255]), picture(&[0, 0, 0, 255, 8, 9, 8, 255]));
        assert_eq!(p.difference(&p), None);
        let difference = p.difference(&q).expect("they differ");
        assert_eq!((difference.pixels, difference.largest), (1, 1));
        assert_eq!(difference.picture.rgba, [191, 191, 191, 255, 255, 160, 160, 255]);
        assert_eq!(p.difference(&picture(&[0; 4])).expect("they differ").pixels, 2);
    }
}
