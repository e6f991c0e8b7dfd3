//! The one PNG encoder, for all that Enfilade writes.

use std::fmt;

use tiny_skia::Pixmap;

use super::{Level, Samples};

/// Why a picture cannot be painted; the message says what to do.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PictureError(pub(crate) String);

impl fmt::Display for PictureError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for PictureError {}

/// How the bytes are compressed; the pixels are the same.
#[derive(Clone, Copy, Debug, Default)]
pub struct Packing {
    pub compression: png::Compression,
    pub filter: Option<png::Filter>,
    /// Whether to mark the file as sRGB.
    pub is_srgb: bool,
    /// The size of a pixel when printed, if it has one: so many to the metre.
    pub dots_per_m: Option<u32>,
}

/// Encodes rows of samples from the top, 8 bits a channel, as a PNG file.
///
/// # Errors
/// When there are no pixels, or `data` does not have `width_px * height_px` samples.
pub fn encode(
    width_px: u32,
    height_px: u32,
    samples: Samples,
    data: &[u8],
    packing: Packing,
) -> Result<Vec<u8>, PictureError> {
    let failed = |error: png::EncodingError| PictureError(format!("cannot encode the picture: {error}"));
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width_px, height_px);
    encoder.set_color(match samples {
        Samples::Grey => png::ColorType::Grayscale,
        Samples::Rgb => png::ColorType::Rgb,
        Samples::Rgba => png::ColorType::Rgba,
    });
    encoder.set_depth(png::BitDepth::Eight);
    if packing.is_srgb {
        encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    }
    if let Some(dots) = packing.dots_per_m {
        let unit = png::Unit::Meter;
        encoder.set_pixel_dims(Some(png::PixelDimensions { xppu: dots, yppu: dots, unit }));
    }
    encoder.set_compression(packing.compression);
    if let Some(filter) = packing.filter {
        encoder.set_filter(filter);
    }
    let mut writer = encoder.write_header().map_err(failed)?;
    writer.write_image_data(data).map_err(failed)?;
    writer.finish().map_err(failed)?;
    Ok(bytes)
}

/// Encodes pixels of straight red, green, blue and alpha as a PNG file, without alpha if all are opaque.
///
/// # Errors
/// As [`encode`].
pub fn encode_rgba(width_px: u32, height_px: u32, rgba: &[u8], packing: Packing) -> Result<Vec<u8>, PictureError> {
    if rgba.chunks_exact(4).all(|pixel| pixel[3] == 255) {
        let rgb: Vec<u8> = rgba.chunks_exact(4).flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
        encode(width_px, height_px, Samples::Rgb, &rgb, packing)
    } else {
        encode(width_px, height_px, Samples::Rgba, rgba, packing)
    }
}

/// Encodes a pixmap as a PNG file: 8 bits a channel, without alpha if all is opaque. Compressed for
/// speed: large areas of one colour shrink well anyway.
///
/// # Errors
/// When the encoder fails, which no picture made here causes.
pub fn encode_pixmap(pixmap: &Pixmap) -> Result<Vec<u8>, PictureError> {
    encode_pixmap_packed(pixmap, FAST)
}

/// Large areas of one colour shrink well, however little time is spent.
pub const FAST: Packing =
    Packing { compression: png::Compression::Fast, filter: Some(png::Filter::Up), is_srgb: true, dots_per_m: None };

/// The same, packed otherwise.
///
/// # Errors
/// As [`encode_pixmap`].
pub fn encode_pixmap_packed(pixmap: &Pixmap, packing: Packing) -> Result<Vec<u8>, PictureError> {
    let rgba: Vec<u8> = pixmap
        .pixels()
        .iter()
        .flat_map(|pixel| {
            let pixel = pixel.demultiply();
            [pixel.red(), pixel.green(), pixel.blue(), pixel.alpha()]
        })
        .collect();
    encode_rgba(pixmap.width(), pixmap.height(), &rgba, packing)
}

/// Encodes one level of a picture as a PNG file.
///
/// # Errors
/// As [`encode`].
pub fn encode_level(level: &Level) -> Result<Vec<u8>, PictureError> {
    encode(level.width_px, level.height_px, level.samples, &level.data, Packing::default())
}
