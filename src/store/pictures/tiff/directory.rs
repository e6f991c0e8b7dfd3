//! What a TIFF's directories say: which pages there are and what each is like.

use std::collections::BTreeSet;

use super::{PictureError, damaged};

/// No file has more pages.
const MOST_PAGES: usize = 10_000;

/// How numbers stand in a file.
#[derive(Clone, Copy, Debug)]
struct Numbers {
    is_little: bool,
    /// With offsets and counts of 8 bytes.
    is_big: bool,
}

/// A page's directory.
pub(super) struct Directory<'a> {
    bytes: &'a [u8],
    numbers: Numbers,
    /// Where it stands in the file.
    pub offset: u64,
    pub is_not_first: bool,
    entries: Vec<Entry>,
}

/// A field of a directory.
#[derive(Clone, Copy, Debug)]
struct Entry {
    tag: u16,
    kind: u16,
    count: u64,
    /// Where the entry stands in the file.
    at: usize,
}

impl Numbers {
    fn of(bytes: &[u8]) -> Option<Self> {
        let is_little = match bytes.get(..2)? {
            b"II" => true,
            b"MM" => false,
            _ => return None,
        };
        let plain = Self { is_little, is_big: false };
        match plain.read(bytes, 2, 2)? {
            42 => Some(plain),
            43 => Some(Self { is_big: true, ..plain }),
            _ => None,
        }
    }

    /// A number of `size` bytes.
    fn read(self, bytes: &[u8], at: usize, size: usize) -> Option<u64> {
        let digits = bytes.get(at..at.checked_add(size)?)?;
        let fold = |number: u64, digit: &u8| number << 8 | u64::from(*digit);
        Some(if self.is_little { digits.iter().rev().fold(0, fold) } else { digits.iter().fold(0, fold) })
    }

    fn write(self, bytes: &mut [u8], at: usize, size: usize, number: u64) {
        let Some(digits) = at.checked_add(size).and_then(|end| bytes.get_mut(at..end)) else { return };
        for (i, digit) in digits.iter_mut().enumerate() {
            let place = if self.is_little { i } else { size - 1 - i };
            *digit = (number >> (8 * place)) as u8;
        }
    }

    /// Bytes of an offset, and of a count.
    fn wide(self) -> usize {
        if self.is_big { 8 } else { 4 }
    }

    /// Where the offset of the first directory stands.
    fn first_at(self) -> usize {
        if self.is_big { 8 } else { 4 }
    }
}

/// Bytes of a value of a kind: BYTE, SHORT, LONG, LONG8; none of the others is asked for.
fn size_of(kind: u16) -> Option<usize> {
    match kind {
        1 | 7 => Some(1),
        3 => Some(2),
        4 | 13 => Some(4),
        16 | 18 => Some(8),
        _ => None,
    }
}

impl Entry {
    /// Where its values stand: in the entry where they fit, else where it says.
    fn values_at(self, bytes: &[u8], numbers: Numbers) -> Option<usize> {
        let at = self.at + 4 + numbers.wide();
        let length = u64::try_from(size_of(self.kind)?).ok()?.checked_mul(self.count)?;
        if length <= numbers.wide() as u64 {
            return Some(at);
        }
        usize::try_from(numbers.read(bytes, at, numbers.wide())?).ok()
    }
}

impl Directory<'_> {
    fn entry(&self, tag: u16) -> Option<Entry> {
        self.entries.iter().copied().find(|entry| entry.tag == tag)
    }

    /// The first value of a field.
    pub(super) fn number(&self, tag: u16) -> Option<u32> {
        self.numbers(tag, 1).first().and_then(|&number| u32::try_from(number).ok())
    }

    /// The values of a field, at most so many; as many as the file holds.
    pub(super) fn numbers(&self, tag: u16, most: usize) -> Vec<u64> {
        let Some(entry) = self.entry(tag) else { return Vec::new() };
        let (Some(size), Some(at)) = (size_of(entry.kind), entry.values_at(self.bytes, self.numbers)) else {
            return Vec::new();
        };
        let count = usize::try_from(entry.count).unwrap_or(usize::MAX).min(most);
        (0..count).map_while(|i| self.numbers.read(self.bytes, at.checked_add(i.checked_mul(size)?)?, size)).collect()
    }

    /// Gives a field that there is one value of its own, in a copy of the file.
    pub(super) fn set(&self, copy: &mut [u8], tag: u16, value: u64) {
        const LONG: u64 = 4;
        let Some(entry) = self.entry(tag) else { return };
        let wide = self.numbers.wide();
        self.numbers.write(copy, entry.at + 2, 2, LONG);
        self.numbers.write(copy, entry.at + 4, wide, 1);
        self.numbers.write(copy, entry.at + 4 + wide, 4, value);
    }

    /// Gives a field a tag that nobody knows, in a copy of the file.
    pub(super) fn hide(&self, copy: &mut [u8], tag: u16) {
        const UNKNOWN: u64 = 65_000;
        if let Some(entry) = self.entry(tag) {
            self.numbers.write(copy, entry.at, 2, UNKNOWN + u64::from(tag) % 500);
        }
    }
}

/// Whether a file's bytes are a TIFF's, or a BigTIFF's.
pub(in super::super) fn is_tiff(bytes: &[u8]) -> bool {
    Numbers::of(bytes).is_some()
}

/// Has a file begin with the directory at an offset.
pub(super) fn first_offset_set(copy: &mut [u8], offset: u64) {
    if let Some(numbers) = Numbers::of(copy) {
        numbers.write(copy, numbers.first_at(), numbers.wide(), offset);
    }
}

/// The directories of a file, in their order. What follows a damaged one is left out.
///
/// # Errors
/// When the first is damaged.
pub(super) fn directories(bytes: &[u8]) -> Result<Vec<Directory<'_>>, PictureError> {
    let short = || damaged("it ends before its first page");
    let numbers = Numbers::of(bytes).ok_or_else(short)?;
    let mut next = numbers.read(bytes, numbers.first_at(), numbers.wide()).ok_or_else(short)?;
    let mut found: Vec<Directory<'_>> = Vec::new();
    let mut seen = BTreeSet::new();
    while next != 0 && found.len() < MOST_PAGES && seen.insert(next) {
        let Some((directory, after)) = directory(bytes, numbers, next) else { break };
        found.push(Directory { is_not_first: !found.is_empty(), ..directory });
        next = after;
    }
    if found.is_empty() { Err(short()) } else { Ok(found) }
}

/// The directory at an offset, and the offset of the next.
fn directory(bytes: &[u8], numbers: Numbers, offset: u64) -> Option<(Directory<'_>, u64)> {
    let start = usize::try_from(offset).ok()?;
    let (count_size, entry_size) = if numbers.is_big { (8, 20) } else { (2, 12) };
    let count = usize::try_from(numbers.read(bytes, start, count_size)?).ok()?;
    let first = start.checked_add(count_size)?;
    let end = first.checked_add(count.checked_mul(entry_size)?)?;
    if end > bytes.len() {
        return None;
    }
    let entries = (first..end).step_by(entry_size).map(|at| {
        Some(Entry {
            tag: numbers.read(bytes, at, 2)? as u16,
            kind: numbers.read(bytes, at + 2, 2)? as u16,
            count: numbers.read(bytes, at + 4, numbers.wide())?,
            at,
        })
    });
    let entries = entries.collect::<Option<Vec<Entry>>>()?;
    // Some files end without saying that nothing follows.
    let after = numbers.read(bytes, end, numbers.wide()).unwrap_or(0);
    Some((Directory { bytes, numbers, offset, is_not_first: false, entries }, after))
}
