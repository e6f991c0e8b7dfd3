//! A page of a PDF as pixels.

use hayro::hayro_interpret::InterpreterSettings;
use hayro::hayro_syntax::object::dict::keys::USER_UNIT;
use hayro::hayro_syntax::{DecryptionError, LoadPdfError, Pdf};
use hayro::vello_cpu::color::palette::css::WHITE;
use hayro::{PixmapSettings, RenderCache, RenderSettings, render};

use super::pixels::{Announce, Decoded, check_page};
use super::{MOST_PIXELS, PictureError};
use crate::picture::{Level, Samples};

/// The resolution at which a page is rendered; half, a quarter and so on if that would be too many
/// pixels. It depends only on the page's size, so that a tracing stays on its lines.
pub const DOTS_PER_INCH: f64 = 300.0;

/// PDF's unit of length: 72 to the inch (ISO 32000-1, 8.3.2.3).
const POINTS_PER_INCH: f64 = 72.0;

/// The renderer counts the pixels of a side in 16 bits; the total is limited to a quarter of that of
/// other pictures, since it needs several times their memory.
const MOST_PDF_PIXELS: f64 = (MOST_PIXELS / 4) as f64;
const LONGEST_PDF_SIDE_PX: f64 = 32_767.0;

/// Whether a file's bytes are a PDF; some have bytes before the header.
pub(super) fn is_pdf(bytes: &[u8]) -> bool {
    bytes[..bytes.len().min(1024)].windows(5).any(|window| window == b"%PDF-")
}

/// A page as pixels, and how many pages there are.
///
/// # Errors
/// When the file is damaged or encrypted, or lacks the page.
pub(super) fn page(bytes: &[u8], number: u32, announce: Announce<'_>) -> Result<Decoded, PictureError> {
    let pdf = Pdf::new(bytes.to_vec()).map_err(|error| refused(&error))?;
    let pages = pdf.pages();
    let count = pages.len() as u32;
    if count == 0 {
        return Err(PictureError::new("is a PDF without pages", "choose another file"));
    }
    check_page(number, count)?;
    let Some(page) = pages.get(number as usize - 1) else { return Err(refused(&LoadPdfError::Invalid)) };
    let (width_pt, height_pt) = page.render_dimensions();
    // Large sheets count in units of their own, so many points each (ISO 32000-1, 14.11.2 and table 30).
    let unit = page.raw().get::<f64>(USER_UNIT).filter(|unit| unit.is_finite() && *unit > 0.0).unwrap_or(1.0);
    let (width_pt, height_pt) = (f64::from(width_pt) * unit, f64::from(height_pt) * unit);
    if !(width_pt > 0.0 && height_pt > 0.0 && width_pt.is_finite() && height_pt.is_finite()) {
        return Err(PictureError::new("is a page without a size", "choose another page"));
    }
    let mut scale = DOTS_PER_INCH / POINTS_PER_INCH;
    while width_pt * height_pt * scale * scale > MOST_PDF_PIXELS
        || width_pt.max(height_pt) * scale > LONGEST_PDF_SIDE_PX
    {
        scale /= 2.0;
    }
    if width_pt.min(height_pt) * scale < 1.0 {
        return Err(PictureError::new("is a page that is thinner than a dot", "choose another page"));
    }
    announce((width_pt * height_pt * scale * scale) as u64 * 4);
    // The page is drawn in its own units.
    let scale = scale * unit;
    let pixmap = render(
        page,
        &RenderCache::new(),
        &InterpreterSettings::default(),
        &RenderSettings::default(),
        &PixmapSettings { x_scale: scale as f32, y_scale: scale as f32, bg_color: WHITE },
    );
    let (width_px, height_px) = (u32::from(pixmap.width()), u32::from(pixmap.height()));
    // On white paper every pixel is opaque.
    let data: Vec<u8> = pixmap.data_as_u8_slice().chunks_exact(4).flat_map(|pixel| &pixel[..3]).copied().collect();
    Ok(Decoded { full: Level { width_px, height_px, samples: Samples::Rgb, data }.simplified(), pages: count })
}

/// Why a file cannot be read, in words for people.
fn refused(error: &LoadPdfError) -> PictureError {
    let hint = "save its page as PNG";
    match error {
        LoadPdfError::Decryption(DecryptionError::PasswordProtected) => {
            PictureError::new("is a PDF that needs a password", "save it without one, or its page as PNG")
        }
        LoadPdfError::Decryption(_) => PictureError::new("is a PDF encrypted in a way that cannot be read", hint),
        LoadPdfError::Invalid => PictureError::new("is a PDF that is damaged", hint),
    }
}
