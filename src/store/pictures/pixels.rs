//! What decoders of all kinds share: a page as pixels in eight bits a channel, upright, within the limits.

use std::io::Cursor;

use image::codecs::tiff::TiffDecoder;
use image::metadata::Orientation;
use image::{DynamicImage, ImageDecoder, ImageError, ImageResult, Limits};

use super::{DECODER_BYTES, LONGEST_SIDE_PX, MOST_PIXELS, PictureError, check_size};
use crate::picture::{Level, Samples};

/// A page as it was decoded.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Decoded {
    pub full: Level,
    /// How many pages the file has.
    pub pages: u32,
}

/// Told how many bytes a picture will have decoded, before it is.
pub(super) type Announce<'a> = &'a mut dyn FnMut(u64);

/// What to do about a page that is not there.
pub(super) const CHOOSE_PAGE: &str = "choose another page";

/// Refuses a page that is not there.
pub(super) fn check_page(page: u32, pages: u32) -> Result<(), PictureError> {
    if (1..=pages).contains(&page) {
        return Ok(());
    }
    let has = if pages == 1 { "has one page".to_owned() } else { format!("has {pages} pages") };
    Err(PictureError::new(format!("{has}, and none with the number {page}"), CHOOSE_PAGE))
}

pub(super) fn limits() -> Limits {
    let mut limits = Limits::default();
    limits.max_alloc = Some(DECODER_BYTES);
    limits.max_image_width = Some(LONGEST_SIDE_PX);
    limits.max_image_height = Some(LONGEST_SIDE_PX);
    limits
}

/// A TIFF's first page.
pub(super) fn first_of_tiff(
    bytes: &[u8],
    depth: impl FnOnce(&DynamicImage) -> Depth,
    announce: Announce<'_>,
) -> Result<Level, PictureError> {
    let decoder = TiffDecoder::new(Cursor::new(bytes)).and_then(|mut decoder| {
        decoder.set_limits(limits())?;
        Ok(decoder)
    });
    upright(decoder, announce, depth)
}

/// What a decoder gives, turned as its metadata say, in eight bits a channel.
pub(super) fn upright<D: ImageDecoder>(
    decoder: ImageResult<D>,
    announce: Announce<'_>,
    depth: impl FnOnce(&DynamicImage) -> Depth,
) -> Result<Level, PictureError> {
    let mut decoder = decoder.map_err(|error| refused(&error))?;
    let (width_px, height_px) = decoder.dimensions();
    check_size(width_px, height_px)?;
    if decoder.total_bytes() > DECODER_BYTES * 2 {
        return Err(PictureError::new("needs more memory than it may", "save it with 8 bits a channel"));
    }
    announce(decoder.total_bytes());
    // Damaged metadata are no reason to refuse a picture.
    let orientation = decoder.orientation().unwrap_or(Orientation::NoTransforms);
    let mut image = DynamicImage::from_decoder(decoder).map_err(|error| refused(&error))?;
    depth(&image).stretch(&mut image);
    Ok(level(image, orientation))
}

/// An image turned upright, in eight bits a channel and no more channels than it needs.
pub(super) fn level(mut image: DynamicImage, orientation: Orientation) -> Level {
    image.apply_orientation(orientation);
    let (width_px, height_px) = (image.width(), image.height());
    let has_alpha = image.color().has_alpha();
    let (samples, data) = if !image.color().has_color() && !has_alpha {
        (Samples::Grey, image.into_luma8().into_raw())
    } else if has_alpha {
        (Samples::Rgba, image.into_rgba8().into_raw())
    } else {
        (Samples::Rgb, image.into_rgb8().into_raw())
    };
    Level { width_px, height_px, samples, data }.simplified()
}

/// How many of a channel's 16 bits a picture uses: scanners of 10, 12 or 14 bits leave the upper ones
/// empty, and the sheet would be black.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Depth {
    /// Black is 0.
    Bits(u32),
    /// White is 0 in the file, and its values have been turned round.
    BitsFromWhite(u32),
}

impl Depth {
    /// As many bits as the brightest colour needs; 16 for pictures of other depths, and for one all in
    /// black.
    pub(super) fn of_values(image: &DynamicImage) -> Self {
        Self::Bits(bits_for(brightest(image, false)))
    }

    /// As [`Self::of_values`], for values that have been turned round.
    pub(super) fn of_values_from_white(image: &DynamicImage) -> Self {
        Self::BitsFromWhite(bits_for(brightest(image, true)))
    }

    /// Stretches the colours over all 16 bits.
    fn stretch(self, image: &mut DynamicImage) {
        let (bits, from_white) = match self {
            Self::Bits(bits) => (bits, false),
            Self::BitsFromWhite(bits) => (bits, true),
        };
        if bits >= 16 {
            return;
        }
        let most = (1u32 << bits) - 1;
        let stretched = |value: u16| {
            let value = if from_white { u16::MAX - value } else { value };
            let value = ((u32::from(value).min(most) * u32::from(u16::MAX) + most / 2) / most) as u16;
            if from_white { u16::MAX - value } else { value }
        };
        // An alpha of as few bits as the colours is one of the same scale.
        let alpha = |value: u16| if u32::from(value) <= most { stretched(value) } else { value };
        match image {
            DynamicImage::ImageLuma16(image) => image.iter_mut().for_each(|value| *value = stretched(*value)),
            DynamicImage::ImageRgb16(image) => image.iter_mut().for_each(|value| *value = stretched(*value)),
            DynamicImage::ImageLumaA16(image) => image.pixels_mut().for_each(|pixel| {
                pixel.0 = [stretched(pixel.0[0]), alpha(pixel.0[1])];
            }),
            DynamicImage::ImageRgba16(image) => image.pixels_mut().for_each(|pixel| {
                let [red, green, blue, opacity] = pixel.0;
                pixel.0 = [stretched(red), stretched(green), stretched(blue), alpha(opacity)];
            }),
            _ => {}
        }
    }
}

/// The largest value of a colour in 16 bits, alpha not counted; `None` for other depths.
fn brightest(image: &DynamicImage, from_white: bool) -> Option<u16> {
    let read = |value: u16| if from_white { u16::MAX - value } else { value };
    match image {
        DynamicImage::ImageLuma16(image) => image.iter().map(|&value| read(value)).max(),
        DynamicImage::ImageRgb16(image) => image.iter().map(|&value| read(value)).max(),
        DynamicImage::ImageLumaA16(image) => image.pixels().map(|pixel| read(pixel.0[0])).max(),
        DynamicImage::ImageRgba16(image) => {
            image.pixels().flat_map(|pixel| pixel.0.into_iter().take(3)).map(read).max()
        }
        _ => None,
    }
}

fn bits_for(brightest: Option<u16>) -> u32 {
    let depths = [8, 10, 12, 14];
    match brightest {
        None | Some(0) => 16,
        Some(value) => depths.into_iter().find(|bits| u32::from(value) < 1 << bits).unwrap_or(16),
    }
}

/// What a decoder says, in words for people.
pub(super) fn refused(error: &ImageError) -> PictureError {
    match error {
        ImageError::Limits(_) => PictureError::new(
            "has more pixels than can be held",
            format!(
                "make it smaller: at most {LONGEST_SIDE_PX} pixels a side and {} million in all",
                MOST_PIXELS / 1_000_000
            ),
        ),
        ImageError::Unsupported(_) => {
            PictureError::new(format!("is of a kind that is not supported ({error})"), "save it as PNG or JPEG")
        }
        _ => PictureError::new(format!("is damaged ({error})"), "scan it or save it again"),
    }
}
