//! Backdrops: reading and hashing their files, and finding one that has moved.

mod find;
mod path;
mod pdf;

use std::fmt;
use std::io::{Cursor, Read as _};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use image::metadata::Orientation;
use image::{DynamicImage, ImageDecoder as _, ImageError, ImageReader, Limits};
use sha2::{Digest as _, Sha256};

use crate::picture::{Level, PictureLevels, Samples};
pub use find::{Found, find_picture};
pub use path::{relative_path, relocated, resolved_path};
pub use pdf::DOTS_PER_INCH;

/// Extensions of the files read as pictures, in lower case.
pub const PICTURE_ENDINGS: &[&str] = &["png", "jpg", "jpeg", "tif", "tiff", "webp", "bmp", "gif", "pdf"];

/// The largest file read: 512 MB. The largest sheet, A0 at 600 dpi, is smaller in any compressed format.
const LARGEST_FILE_BYTES: u64 = 512 << 20;

/// The most pixels read: 16384 by 16384, A0 at 400 dpi.
const MOST_PIXELS: u64 = 1 << 28;

/// The longest side read.
const LONGEST_SIDE_PX: u32 = 65_535;

/// The memory limit of decoders: the most pixels at four bytes each.
const DECODER_BYTES: u64 = MOST_PIXELS * 4;

/// Why a picture cannot be shown, and what to do about it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PictureError {
    /// Completes 'the picture …': 'has too many pixels'.
    pub what: String,
    pub hint: String,
}

impl PictureError {
    fn new(what: impl Into<String>, hint: impl Into<String>) -> Self {
        Self { what: what.into(), hint: hint.into() }
    }
}

impl fmt::Display for PictureError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the picture {}; {}", self.what, self.hint)
    }
}

impl std::error::Error for PictureError {}

/// A picture that was read.
#[derive(Clone, Debug)]
pub struct LoadedPicture {
    pub levels: PictureLevels,
    /// As [`content_hash`].
    pub content_hash: String,
    /// How many pages the file has; 1 for anything but a PDF.
    pub pages: u32,
}

/// The hash that identifies a picture: `sha256:` and the output of `sha256sum`.
pub fn content_hash(bytes: &[u8]) -> String {
    use fmt::Write as _;
    Sha256::digest(bytes).iter().fold("sha256:".to_owned(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}

/// Whether a file's name is that of a picture.
pub fn is_picture_name(path: &Path) -> bool {
    let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
    ending.is_some_and(|ending| PICTURE_ENDINGS.contains(&ending.as_str()))
}

/// The bytes of a picture's file.
///
/// # Errors
/// When it does not exist, may not be read, or is too large.
pub fn read_picture_bytes(path: &Path) -> Result<Vec<u8>, PictureError> {
    let fail = |error: &std::io::Error| match error.kind() {
        std::io::ErrorKind::NotFound => PictureError::new("is not there", "find it, or link another"),
        _ => PictureError::new(format!("cannot be opened: {error}"), "check the file"),
    };
    let file = std::fs::File::open(path).map_err(|error| fail(&error))?;
    if file.metadata().is_ok_and(|meta| meta.is_dir()) {
        return Err(PictureError::new("is a folder", "choose a picture's file"));
    }
    let mut bytes = Vec::new();
    file.take(LARGEST_FILE_BYTES + 1).read_to_end(&mut bytes).map_err(|error| fail(&error))?;
    if bytes.len() as u64 > LARGEST_FILE_BYTES {
        let what = format!("is a file of more than {} MB", LARGEST_FILE_BYTES >> 20);
        return Err(PictureError::new(what, "compress it, as PNG or JPEG"));
    }
    Ok(bytes)
}

/// Reads a picture: PNG, JPEG, TIFF, WebP, BMP, GIF (the first frame), or a page of a PDF. The kind
/// follows from the content, not the name. Photographs are turned upright as their EXIF orientation
/// says; whatever the depth, eight bits a channel are kept.
///
/// # Errors
/// When there is no such file, it is none of these, damaged or too large, or lacks the page.
pub fn load_picture(path: &Path, page: u32) -> Result<LoadedPicture, PictureError> {
    decode_picture(&read_picture_bytes(path)?, page)
}

/// Reads a picture from a file's bytes, like [`load_picture`].
///
/// # Errors
/// As [`load_picture`].
pub fn decode_picture(bytes: &[u8], page: u32) -> Result<LoadedPicture, PictureError> {
    // Decoders are others' work and files are of any making: should one break, only this picture does.
    let read = catch_unwind(AssertUnwindSafe(|| {
        let (full, pages) = if pdf::is_pdf(bytes) { pdf::page(bytes, page)? } else { (raster(bytes)?, 1) };
        Ok(LoadedPicture { levels: PictureLevels::new(full), content_hash: content_hash(bytes), pages })
    }));
    read.unwrap_or_else(|_| Err(PictureError::new("cannot be read", "save it anew, as PNG or JPEG")))
}

/// Rejects sizes that would not fit into memory.
fn check_size(width_px: u32, height_px: u32) -> Result<(), PictureError> {
    let is_too_large =
        u64::from(width_px) * u64::from(height_px) > MOST_PIXELS || width_px.max(height_px) > LONGEST_SIDE_PX;
    if is_too_large {
        return Err(PictureError::new(
            format!("has {width_px} x {height_px} pixels, more than can be held"),
            format!(
                "make it smaller: at most {LONGEST_SIDE_PX} pixels a side and {} million in all",
                MOST_PIXELS / 1_000_000
            ),
        ));
    }
    if width_px == 0 || height_px == 0 {
        return Err(PictureError::new("has no pixels", "choose another file"));
    }
    Ok(())
}

fn raster(bytes: &[u8]) -> Result<Level, PictureError> {
    let mut reader = ImageReader::new(Cursor::new(bytes))
        .with_guessed_format()
        .map_err(|error| PictureError::new(format!("cannot be read: {error}"), "check the file"))?;
    if reader.format().is_none() {
        return Err(PictureError::new("is of no known kind", "choose a PNG, JPEG, TIFF, WebP, BMP, GIF or PDF"));
    }
    let mut limits = Limits::default();
    limits.max_alloc = Some(DECODER_BYTES);
    limits.max_image_width = Some(LONGEST_SIDE_PX);
    limits.max_image_height = Some(LONGEST_SIDE_PX);
    reader.limits(limits);
    let mut decoder = reader.into_decoder().map_err(|error| refused(&error))?;
    let (width_px, height_px) = decoder.dimensions();
    check_size(width_px, height_px)?;
    if decoder.total_bytes() > DECODER_BYTES * 2 {
        return Err(PictureError::new("needs more memory than it may", "save it with 8 bits a channel"));
    }
    // Damaged metadata are no reason to refuse a picture.
    let orientation = decoder.orientation().unwrap_or(Orientation::NoTransforms);
    let mut image = DynamicImage::from_decoder(decoder).map_err(|error| refused(&error))?;
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
    Ok(Level { width_px, height_px, samples, data }.simplified())
}

/// What a decoder says, in words for people.
fn refused(error: &ImageError) -> PictureError {
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
