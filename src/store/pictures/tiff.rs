//! Pages of TIFF files. What the decoder reads is handed to it as it is; what it does not (palettes, depths
//! other than 8 and 16 bits, fax group 3) is handed to it as rows of bytes and put together here, or decoded
//! as a fax. Tags and values are those of TIFF 6.0; BigTIFF differs in the width of its numbers.

mod directory;
mod fax;

use std::io::Cursor;

use image::metadata::Orientation;
use image::{DynamicImage, GrayImage, ImageBuffer, Rgb, RgbImage};
use tiff::decoder::{Decoder, DecodingResult, Limits};

use super::pixels::{Announce, Decoded, Depth, check_page, first_of_tiff, level};
use super::{DECODER_BYTES, PictureError, check_size};
use crate::picture::Level;
use directory::{Directory, directories, first_offset_set};

pub(super) use directory::is_tiff;

const NEW_SUBFILE_TYPE: u16 = 254;
const IMAGE_WIDTH: u16 = 256;
const IMAGE_LENGTH: u16 = 257;
const BITS_PER_SAMPLE: u16 = 258;
const COMPRESSION: u16 = 259;
const PHOTOMETRIC: u16 = 262;
const FILL_ORDER: u16 = 266;
const STRIP_OFFSETS: u16 = 273;
const ORIENTATION: u16 = 274;
const SAMPLES_PER_PIXEL: u16 = 277;
const ROWS_PER_STRIP: u16 = 278;
const STRIP_BYTE_COUNTS: u16 = 279;
const PLANAR_CONFIGURATION: u16 = 284;
const T4_OPTIONS: u16 = 292;
const PREDICTOR: u16 = 317;
const COLOR_MAP: u16 = 320;
const TILE_WIDTH: u16 = 322;
const EXTRA_SAMPLES: u16 = 338;
const SAMPLE_FORMAT: u16 = 339;

/// PhotometricInterpretation.
const WHITE_IS_ZERO: u32 = 0;
const BLACK_IS_ZERO: u32 = 1;
const RGB: u32 = 2;
const PALETTE: u32 = 3;

pub(super) fn damaged(what: &str) -> PictureError {
    PictureError::new(format!("is damaged ({what})"), "scan it or save it again")
}

fn unsupported(what: &str) -> PictureError {
    PictureError::new(format!("is a TIFF of a kind that is not supported ({what})"), "save it as PNG or JPEG")
}

/// A page as pixels, and how many pages there are.
///
/// # Errors
/// When the file is damaged, of a kind that cannot be read, too large, or lacks the page.
pub(super) fn page(bytes: &[u8], number: u32, announce: Announce<'_>) -> Result<Decoded, PictureError> {
    let all = directories(bytes)?;
    // Small copies for previews, and masks, are no pages (NewSubfileType, bits 0 and 2).
    let is_page = |directory: &&Directory<'_>| directory.number(NEW_SUBFILE_TYPE).unwrap_or(0) & 0b101 == 0;
    let mut pages: Vec<&Directory<'_>> = all.iter().filter(is_page).collect();
    if pages.is_empty() {
        pages = all.iter().collect();
    }
    let count = pages.len() as u32;
    check_page(number, count)?;
    let Some(directory) = pages.get(number as usize - 1) else { return Err(damaged("it has no pages")) };
    Ok(Decoded { full: one(bytes, directory, announce)?, pages: count })
}

fn one(bytes: &[u8], directory: &Directory<'_>, announce: Announce<'_>) -> Result<Level, PictureError> {
    let number = |tag: u16, usual: u32| directory.number(tag).unwrap_or(usual);
    let (width, height) = (number(IMAGE_WIDTH, 0), number(IMAGE_LENGTH, 0));
    check_size(width, height)?;
    let (compression, photometric) = (number(COMPRESSION, 1), number(PHOTOMETRIC, u32::MAX));
    let (bits, samples) = (number(BITS_PER_SAMPLE, 1), number(SAMPLES_PER_PIXEL, 1));
    let orientation = || {
        let stated = u8::try_from(number(ORIENTATION, 1)).unwrap_or(1);
        Orientation::from_exif(stated).unwrap_or(Orientation::NoTransforms)
    };
    if fax::is_ours(compression, number(FILL_ORDER, 1)) {
        if (bits, samples) != (1, 1) {
            return Err(damaged("a fax of more than one bit a pixel"));
        }
        announce(u64::from(width) * u64::from(height));
        let grey = fax::decode(bytes, directory, width, height)?;
        return Ok(level(DynamicImage::ImageLuma8(grey), orientation()));
    }
    let is_plain = match photometric {
        PALETTE => false,
        WHITE_IS_ZERO | BLACK_IS_ZERO => matches!(bits, 1 | 8 | 16) || bits >= 32,
        RGB => matches!(bits, 8 | 16) || bits >= 32,
        _ => true,
    };
    if is_plain {
        let mut first = std::borrow::Cow::Borrowed(bytes);
        if directory.is_not_first {
            first_offset_set(first.to_mut(), directory.offset);
        }
        let depth = if photometric == WHITE_IS_ZERO { Depth::of_values_from_white } else { Depth::of_values };
        return first_of_tiff(&first, depth, announce);
    }
    let what = Unusual { width, height, bits, samples, photometric };
    let image = what.image(bytes, directory, announce)?;
    Ok(level(image, orientation()))
}

/// A picture whose samples the decoder does not know.
struct Unusual {
    width: u32,
    height: u32,
    /// Of a sample, 1 to 16.
    bits: u32,
    samples: u32,
    photometric: u32,
}

impl Unusual {
    fn image(
        &self,
        bytes: &[u8],
        directory: &Directory<'_>,
        announce: Announce<'_>,
    ) -> Result<DynamicImage, PictureError> {
        let Self { width, height, bits, samples, photometric } = *self;
        if !(1..=16).contains(&bits) || !(1..=8).contains(&samples) {
            return Err(unsupported(&format!("{samples} samples of {bits} bits a pixel")));
        }
        if directory.number(SAMPLE_FORMAT).is_some_and(|format| format != 1) {
            return Err(unsupported("its samples are no whole numbers"));
        }
        if samples > 1 && directory.number(PLANAR_CONFIGURATION) == Some(2) {
            return Err(unsupported("its channels lie apart"));
        }
        announce(u64::from(width) * u64::from(height) * 4);
        let row_bytes = (u64::from(width) * u64::from(bits * samples)).div_ceil(8) as usize;
        let rows = self.rows(bytes, directory, row_bytes)?;
        let most = (1u32 << bits) - 1;
        let pixels = rows.chunks_exact(row_bytes).flat_map(|row| {
            (0..width as usize).map(move |x| [0, 1, 2].map(|channel| sample(row, bits, samples, x, channel)))
        });
        Ok(match photometric {
            PALETTE => {
                let colours = palette(directory, bits)?;
                let mut data = Vec::with_capacity(width as usize * height as usize * 3);
                for [index, ..] in pixels {
                    let colour = colours.get(index as usize);
                    let colour = colour.ok_or_else(|| damaged("a pixel has a colour that the palette lacks"))?;
                    data.extend_from_slice(colour);
                }
                DynamicImage::ImageRgb8(whole(RgbImage::from_raw(width, height, data))?)
            }
            WHITE_IS_ZERO | BLACK_IS_ZERO => {
                let grey = pixels.map(|[value, ..]| {
                    let value = if photometric == WHITE_IS_ZERO { most - value } else { value };
                    eight_bits(value, most)
                });
                DynamicImage::ImageLuma8(whole(GrayImage::from_raw(width, height, grey.collect()))?)
            }
            RGB if samples >= 3 => {
                let data = pixels.flat_map(|pixel| pixel.map(|value| eight_bits(value, most))).collect();
                DynamicImage::ImageRgb8(whole(ImageBuffer::<Rgb<u8>, _>::from_raw(width, height, data))?)
            }
            _ => return Err(unsupported(&format!("colours of kind {photometric} with {bits} bits"))),
        })
    }

    /// The rows of the picture as bytes: for the decoder a picture of one grey channel of 8 bits, as wide
    /// as a row has bytes.
    fn rows(&self, bytes: &[u8], directory: &Directory<'_>, row_bytes: usize) -> Result<Vec<u8>, PictureError> {
        let Self { bits, samples, .. } = *self;
        let is_predicted = directory.number(PREDICTOR).unwrap_or(1) != 1;
        if is_predicted && (bits != 8 || samples != 1) {
            return Err(unsupported("predicted samples of this depth"));
        }
        let row_bytes_of = |pixels: u32| (u64::from(pixels) * u64::from(bits * samples)).div_ceil(8);
        let mut grey = bytes.to_vec();
        if directory.is_not_first {
            first_offset_set(&mut grey, directory.offset);
        }
        directory.set(&mut grey, IMAGE_WIDTH, row_bytes as u64);
        directory.set(&mut grey, PHOTOMETRIC, u64::from(BLACK_IS_ZERO));
        directory.set(&mut grey, BITS_PER_SAMPLE, 8);
        directory.set(&mut grey, SAMPLES_PER_PIXEL, 1);
        if let Some(tile) = directory.number(TILE_WIDTH) {
            directory.set(&mut grey, TILE_WIDTH, row_bytes_of(tile));
        }
        directory.hide(&mut grey, EXTRA_SAMPLES);
        directory.hide(&mut grey, SAMPLE_FORMAT);
        let mut limits = Limits::default();
        limits.decoding_buffer_size = DECODER_BYTES as usize;
        limits.intermediate_buffer_size = DECODER_BYTES as usize;
        limits.ifd_value_size = DECODER_BYTES as usize;
        let read =
            Decoder::new(Cursor::new(grey)).map(|decoder| decoder.with_limits(limits)).and_then(|mut decoder| {
                let mut rows = DecodingResult::U8(Vec::new());
                decoder.read_image_to_buffer(&mut rows)?;
                Ok(rows)
            });
        match read {
            Ok(DecodingResult::U8(rows)) if rows.len() == row_bytes * self.height as usize => Ok(rows),
            Ok(_) => Err(damaged("its rows are incomplete")),
            Err(error @ tiff::TiffError::UnsupportedError(_)) => Err(unsupported(&error.to_string())),
            Err(error) => Err(damaged(&error.to_string())),
        }
    }
}

fn whole<T>(image: Option<T>) -> Result<T, PictureError> {
    image.ok_or_else(|| damaged("its rows are incomplete"))
}

/// A value of so many as most, in 8 bits.
fn eight_bits(value: u32, most: u32) -> u8 {
    ((value * 255 + most / 2) / most) as u8
}

/// A sample of a pixel in a row: samples follow one another without a gap, the highest bit first. A
/// channel that there is not is 0.
fn sample(row: &[u8], bits: u32, samples: u32, x: usize, channel: u32) -> u32 {
    if channel >= samples {
        return 0;
    }
    let start = (x * samples as usize + channel as usize) * bits as usize;
    let byte = |at: usize| u32::from(row.get(at).copied().unwrap_or(0));
    // At most 16 bits, which begin anywhere in the first of three bytes.
    let three = byte(start / 8) << 16 | byte(start / 8 + 1) << 8 | byte(start / 8 + 2);
    (three >> (24 - bits as usize - start % 8)) & ((1 << bits) - 1)
}

/// The colours of a palette: all reds, all greens, all blues, in 16 bits (TIFF 6.0, section 5).
fn palette(directory: &Directory<'_>, bits: u32) -> Result<Vec<[u8; 3]>, PictureError> {
    let count = 1usize << bits;
    let values = directory.numbers(COLOR_MAP, 3 * count);
    if values.len() < 3 * count {
        return Err(damaged("its palette is incomplete"));
    }
    // Some programs write 8 bits, though 16 are meant: then no value is larger (as libtiff takes them).
    let is_short = values.iter().all(|&value| value < 256);
    let level = |at: usize| if is_short { values[at] as u8 } else { (values[at] >> 8) as u8 };
    Ok((0..count).map(|i| [level(i), level(count + i), level(2 * count + i)]).collect())
}
