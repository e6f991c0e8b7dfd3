//! Sheets in the compression of fax machines, ITU-T T.4 and T.6 (TIFF 6.0, sections 10 and 11).

use hayro_ccitt::{DecodeSettings, Decoder, DecoderContext, EncodingMode, decode as decode_strip};
use image::GrayImage;

use super::directory::Directory;
use super::{
    BLACK_IS_ZERO, COMPRESSION, FILL_ORDER, PHOTOMETRIC, PictureError, ROWS_PER_STRIP, STRIP_BYTE_COUNTS,
    STRIP_OFFSETS, T4_OPTIONS, damaged,
};

/// Compression: rows of runs; group 3; group 4.
const RUNS: u32 = 2;
const GROUP_3: u32 = 3;
const GROUP_4: u32 = 4;

/// FillOrder: the first pixel is the lowest bit of a byte.
const LOWEST_FIRST: u32 = 2;

/// Whether a picture is a fax that the decoder of TIFFs does not read.
pub(super) fn is_ours(compression: u32, fill_order: u32) -> bool {
    matches!(compression, RUNS | GROUP_3) || (compression == GROUP_4 && fill_order == LOWEST_FIRST)
}

/// The rows of a sheet, 0 white and 1 black.
struct Rows {
    width: usize,
    ink: u8,
    paper: u8,
    data: Vec<u8>,
}

impl Decoder for Rows {
    fn push_row(&mut self, changes: &[u32]) {
        let start = self.data.len();
        self.data.resize(start + self.width, self.paper);
        for black in changes.chunks(2) {
            let from = (black[0] as usize).min(self.width);
            let to = black.get(1).map_or(self.width, |&to| to as usize).clamp(from, self.width);
            self.data[start + from..start + to].fill(self.ink);
        }
    }
}

/// Decodes a sheet: black on white, unless it says otherwise.
pub(super) fn decode(
    bytes: &[u8],
    directory: &Directory<'_>,
    width: u32,
    height: u32,
) -> Result<GrayImage, PictureError> {
    let number = |tag: u16, usual: u32| directory.number(tag).unwrap_or(usual);
    let rows_a_strip = number(ROWS_PER_STRIP, height).clamp(1, height);
    let strips = height.div_ceil(rows_a_strip) as usize;
    let (offsets, lengths) = (directory.numbers(STRIP_OFFSETS, strips), directory.numbers(STRIP_BYTE_COUNTS, strips));
    if offsets.len() != strips || lengths.len() != strips {
        return Err(damaged("it does not say where its rows are"));
    }
    // T4Options, bit 0: rows may refer to the row above.
    let encoding = match number(COMPRESSION, 1) {
        GROUP_4 => EncodingMode::Group4,
        GROUP_3 if number(T4_OPTIONS, 0) & 1 == 1 => EncodingMode::Group3_2D,
        _ => EncodingMode::Group3_1D,
    };
    let is_runs = number(COMPRESSION, 1) == RUNS;
    let is_negative = number(PHOTOMETRIC, 0) == BLACK_IS_ZERO;
    let (ink, paper) = if is_negative { (255, 0) } else { (0, 255) };
    let mut rows = Rows { width: width as usize, ink, paper, data: Vec::with_capacity((width * height) as usize) };
    for (strip, (&offset, &length)) in offsets.iter().zip(&lengths).enumerate() {
        let start = usize::try_from(offset).unwrap_or(usize::MAX).min(bytes.len());
        let end = start.saturating_add(usize::try_from(length).unwrap_or(usize::MAX)).min(bytes.len());
        let mut data = std::borrow::Cow::Borrowed(&bytes[start..end]);
        if number(FILL_ORDER, 1) == LOWEST_FIRST {
            data.to_mut().iter_mut().for_each(|byte| *byte = byte.reverse_bits());
        }
        let wanted = rows_a_strip.min(height - strip as u32 * rows_a_strip);
        let settings = DecodeSettings {
            columns: width,
            rows: wanted,
            end_of_block: !is_runs,
            end_of_line: encoding != EncodingMode::Group4 && !is_runs,
            rows_are_byte_aligned: is_runs,
            encoding,
            strict: false,
        };
        let before = rows.data.len();
        // What could be decoded of a damaged strip has been pushed all the same; its rows are counted.
        let _ = decode_strip(&data, &mut rows, &mut DecoderContext::new(settings));
        let whole = before + wanted as usize * width as usize;
        if rows.data.len() < whole {
            let missing = (whole - rows.data.len()) / width as usize;
            return Err(damaged(&format!("{missing} of its {height} rows are missing")));
        }
        rows.data.truncate(whole);
    }
    GrayImage::from_raw(width, height, rows.data).ok_or_else(|| damaged("its rows are incomplete"))
}
