//! PNG files: one encoder for all that Enfilade writes.

use std::fmt;

use tiny_skia::Pixmap;

use super::{Level, Samples};

/// A picture that cannot be painted, in words that say what to do.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PictureError(pub(crate) String);

impl fmt::Display for PictureError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for PictureError {}

/// How the bytes are packed; the pixels are the same.
#[derive(Clone, Copy, Debug, Default)]
pub struct Packing {
    pub compression: png::Compression,
    pub filter: Option<png::Filter>,
    /// Whether the file says that its colours are sRGB.
    pub is_srgb: bool,
}

/// Rows of samples from the top, 8 bits a channel, as a PNG file's bytes.
///
/// # Errors
/// When there are no pixels, or `data` has not `width_px * height_px` samples.
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
    encoder.set_compression(packing.compression);
    if let Some(filter) = packing.filter {
        encoder.set_filter(filter);
    }
    let mut writer = encoder.write_header().map_err(failed)?;
    writer.write_image_data(data).map_err(failed)?;
    writer.finish().map_err(failed)?;
    Ok(bytes)
}

/// Pixels of straight red, green, blue and alpha as a PNG file's bytes, without alpha where all is
/// opaque.
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

/// A pixmap as a PNG file's bytes: 8 bits a channel, without alpha where all is opaque. Compressed for
/// speed: large areas of one colour shrink well anyway.
///
/// # Errors
/// When the encoder fails, which it does for no picture made here.
pub fn encode_pixmap(pixmap: &Pixmap) -> Result<Vec<u8>, PictureError> {
    let packing = Packing { compression: png::Compression::Fast, filter: Some(png::Filter::Up), is_srgb: true };
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

/// A picture at one size as a PNG file's bytes.
///
/// # Errors
/// As [`encode`].
pub fn encode_level(level: &Level) -> Result<Vec<u8>, PictureError> {
    encode(level.width_px, level.height_px, level.samples, &level.data, Packing::default())
}
