//! A file's bytes as pixels, whatever kind of picture it is.

use std::io::Cursor;
use std::panic::{AssertUnwindSafe, catch_unwind};

use image::ImageReader;

use super::pixels::{Announce, Decoded, Depth, check_page, limits, upright};
use super::{PictureError, pdf, tiff};

/// Decodes in this process.
pub(super) fn decode(bytes: &[u8], page: u32, announce: Announce<'_>) -> Result<Decoded, PictureError> {
    // Should a decoder break, only this picture does.
    let read = catch_unwind(AssertUnwindSafe(|| {
        if pdf::is_pdf(bytes) {
            pdf::page(bytes, page, announce)
        } else if tiff::is_tiff(bytes) {
            tiff::page(bytes, page, announce)
        } else {
            check_page(page, 1)?;
            let reader = ImageReader::new(Cursor::new(bytes))
                .with_guessed_format()
                .map_err(|error| PictureError::new(format!("cannot be read: {error}"), "check the file"))?;
            if reader.format().is_none() {
                let hint = "choose a PNG, JPEG, TIFF, WebP, BMP, GIF or PDF";
                return Err(PictureError::new("is of no known kind", hint));
            }
            let mut reader = reader;
            reader.limits(limits());
            Ok(Decoded { full: upright(reader.into_decoder(), announce, Depth::of_values)?, pages: 1 })
        }
    }));
    read.unwrap_or_else(|_| Err(PictureError::new("cannot be read", "save it anew, as PNG or JPEG")))
}
