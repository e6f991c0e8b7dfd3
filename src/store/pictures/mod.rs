//! Backdrops: reading and hashing their files, and finding one that has moved.

mod apart;
mod decode;
mod find;
mod path;
mod pdf;
mod pixels;
mod tiff;

use std::fmt;
use std::io::Read as _;
use std::path::Path;

use sha2::{Digest as _, Sha256};

use crate::base::work::Work;
use crate::picture::{Level, PictureLevels, warped};
use crate::plan::{Backdrop, Rectification};
pub use apart::{Decoding, decode_apart};
#[cfg(feature = "cli")]
pub(crate) use apart::{answer_if_asked, decode_by_this_program};
pub use find::{Found, find_picture};
pub use path::{is_allowed, is_outside, relative_path, relocated, resolved_path};
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

    /// Whether the file lacks the page, and no more is wrong.
    pub fn lacks_page(&self) -> bool {
        self.hint == pixels::CHOOSE_PAGE
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
    /// How many pages the file has; 1 for anything but a PDF or TIFF.
    pub pages: u32,
    /// Width and height of the picture in its file, in pixels: those of the levels, unless it is made flat.
    pub source_px: [u32; 2],
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

/// Reads a picture: PNG, JPEG, TIFF, WebP, BMP, GIF (the first frame), or a page of a PDF or TIFF. The
/// kind follows from the content, not the name. Photographs are turned upright as their EXIF orientation
/// says; whatever the depth, eight bits a channel are kept. Decoded as [`decode_apart`] says.
///
/// # Errors
/// When there is no such file, it is none of these, damaged or too large, lacks the page, or takes more
/// time or memory than it may.
pub fn load_picture(path: &Path, page: u32) -> Result<LoadedPicture, PictureError> {
    load_picture_while(path, page, &Work::quiet())
}

/// As [`load_picture`], as long as it is wanted.
///
/// # Errors
/// As [`load_picture`], and when the work is cancelled.
pub fn load_picture_while(path: &Path, page: u32, work: &Work<'_>) -> Result<LoadedPicture, PictureError> {
    decode_picture_by(apart::chosen(), &read_picture_bytes(path)?, page, work)
}

/// The picture under a plan from the file at a path, made flat if the plan says so, as long as it is wanted.
///
/// # Errors
/// As [`load_picture`], and when the work is cancelled.
pub fn load_backdrop_while(
    path: &Path,
    page: u32,
    rectification: Option<&Rectification>,
    work: &Work<'_>,
) -> Result<LoadedPicture, PictureError> {
    let bytes = read_picture_bytes(path)?;
    let pixels::Decoded { full, pages } = apart::chosen().decode(&bytes, page, work)?;
    let source_px = [full.width_px, full.height_px];
    let shown = match rectification {
        None => full,
        Some(rectification) => {
            let wrong = || PictureError::new("cannot be made flat by its corners", "click the corners again");
            let [width_px, height_px] = rectification.size_px;
            check_size(width_px, height_px)?;
            let source_from_shown = rectification.source_from_shown().ok_or_else(wrong)?;
            warped(&full, &source_from_shown, rectification.size_px, work)
                .map_err(|_| PictureError::new("is not wanted any more", "look at the plan again"))?
        }
    };
    Ok(LoadedPicture { levels: PictureLevels::new(shown), content_hash: content_hash(&bytes), pages, source_px })
}

/// The picture under a plan from the file at a path, made flat if the plan says so.
///
/// # Errors
/// As [`load_picture`].
pub fn load_backdrop(path: &Path, backdrop: &Backdrop) -> Result<LoadedPicture, PictureError> {
    load_backdrop_while(path, backdrop.page, backdrop.rectification.as_ref(), &Work::quiet())
}

/// Reads a picture from a file's bytes, like [`load_picture`].
///
/// # Errors
/// As [`load_picture`].
pub fn decode_picture(bytes: &[u8], page: u32) -> Result<LoadedPicture, PictureError> {
    decode_picture_by(apart::chosen(), bytes, page, &Work::quiet())
}

/// The pixels of a picture, or of the first page, at their full size alone; read as by [`load_picture`].
///
/// # Errors
/// As [`load_picture`].
pub fn decode_pixels(bytes: &[u8]) -> Result<Level, PictureError> {
    apart::chosen().decode(bytes, 1, &Work::quiet()).map(|decoded| decoded.full)
}

/// Reads a picture from a file's bytes, as [`load_picture`], decoded here or apart.
///
/// # Errors
/// As [`load_picture`], and when the work is cancelled.
pub fn decode_picture_by(
    decoding: &Decoding,
    bytes: &[u8],
    page: u32,
    work: &Work<'_>,
) -> Result<LoadedPicture, PictureError> {
    let pixels::Decoded { full, pages } = decoding.decode(bytes, page, work)?;
    let source_px = [full.width_px, full.height_px];
    Ok(LoadedPicture { levels: PictureLevels::new(full), content_hash: content_hash(bytes), pages, source_px })
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
