//! Tables as text: cells apart by commas, semicolons or tabs. Spreadsheets write the separator of the country
//! they are set to: in half of Europe the comma is the decimal mark and the semicolon stands between cells.

use std::fmt;

/// A table that was read. Cells are without the spaces around them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Separated {
    /// The cells of the first line.
    pub header: Vec<String>,
    pub rows: Vec<SeparatedRow>,
    /// What stands between cells: a comma, a semicolon or a tab.
    pub separator: char,
}

/// A row of a table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SeparatedRow {
    /// The line it starts on, from 1, as editors count: cells in quotes may go over several lines.
    pub line: u64,
    /// As many as the header has.
    pub cells: Vec<String>,
}

/// Why a text is no table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SeparatedError {
    /// From 1; 0 when it is the whole file.
    pub line: u64,
    pub what: String,
}

impl fmt::Display for SeparatedError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.line {
            0 => f.write_str(&self.what),
            line => write!(f, "line {line}: {}", self.what),
        }
    }
}

impl std::error::Error for SeparatedError {}

impl Separated {
    /// Reads a table with a header. Lines may end with CR LF, LF or CR; empty ones are passed over.
    ///
    /// # Errors
    /// When the text is empty or not UTF-8, or a row has more or fewer cells than the header.
    pub fn read(bytes: &[u8]) -> Result<Self, SeparatedError> {
        let fail = |line: u64, what: String| SeparatedError { line, what };
        if bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff") || bytes.iter().take(2).any(|&b| b == 0) {
            return Err(fail(0, "is UTF-16, not UTF-8; save it again as 'CSV UTF-8'".to_owned()));
        }
        let body = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        let text = std::str::from_utf8(body).map_err(|error| {
            let line = LineCount::default().line_of(body, error.valid_up_to());
            fail(line, "is not UTF-8; save it again as 'CSV UTF-8'".to_owned())
        })?;
        if text.trim().is_empty() {
            return Err(fail(0, "is empty".to_owned()));
        }
        // Excel writes, and reads, a first line that names the separator.
        let stated = text.strip_prefix("sep=").and_then(|rest| {
            let separator = rest.chars().next().filter(|c| matches!(c, ',' | ';' | '\t'))?;
            Some((separator, 4 + separator.len_utf8()))
        });
        let (separator, skipped) = stated.unwrap_or_else(|| (likely_separator(text), 0));
        let mut reader = csv::ReaderBuilder::new()
            .has_headers(false)
            .flexible(true)
            .trim(csv::Trim::All)
            .delimiter(separator as u8)
            .from_reader(&text.as_bytes()[skipped..]);
        let mut lines = LineCount::default();
        let mut header: Option<Vec<String>> = None;
        let mut rows = Vec::new();
        for record in reader.records() {
            let record = record.map_err(|error| fail(0, error.to_string()))?;
            // The crate's own count of lines is wrong behind CR LF, and its offset may stand before the line's end.
            let offset = record.position().map_or(0, csv::Position::byte) as usize + skipped;
            let ends = text.as_bytes()[offset..].iter().take_while(|byte| matches!(byte, b'\r' | b'\n')).count();
            let line = lines.line_of(text.as_bytes(), offset + ends);
            let cells: Vec<String> = record.iter().map(str::to_owned).collect();
            match &header {
                None => header = Some(cells),
                Some(header) if cells.len() != header.len() => {
                    let what = format!("has {} cells, the header {}", cells.len(), header.len());
                    return Err(fail(line, what));
                }
                Some(_) => rows.push(SeparatedRow { line, cells }),
            }
        }
        let header = header.ok_or_else(|| fail(0, "has no header".to_owned()))?;
        Ok(Self { header, rows, separator })
    }

    /// The place of a column, from 0, by its name in the header.
    pub fn column(&self, name: &str) -> Option<usize> {
        self.header.iter().position(|header| header == name)
    }

    /// The number in a cell; with a decimal comma where cells are not apart by commas. `None` when it is none, or
    /// not finite.
    pub fn number(&self, cell: &str) -> Option<f64> {
        let has_decimal_comma = self.separator != ',' && !cell.contains('.') && cell.matches(',').count() == 1;
        let number: f64 = if has_decimal_comma { cell.replace(',', ".").parse() } else { cell.parse() }.ok()?;
        number.is_finite().then_some(number)
    }
}

/// The separator that the first line has most of outside quotes; a comma where it has none.
fn likely_separator(text: &str) -> char {
    let mut counts = [(',', 0_usize), (';', 0), ('\t', 0)];
    let mut is_quoted = false;
    for c in text.trim_start_matches(['\r', '\n']).chars() {
        match c {
            '"' => is_quoted = !is_quoted,
            '\r' | '\n' if !is_quoted => break,
            _ if !is_quoted => {
                if let Some((_, count)) = counts.iter_mut().find(|(separator, _)| *separator == c) {
                    *count += 1;
                }
            }
            _ => {}
        }
    }
    // The first of the most frequent.
    counts.into_iter().rev().max_by_key(|(_, count)| *count).map_or(',', |(separator, _)| separator)
}

/// Counts lines up to an offset, from where it was left: offsets only grow.
#[derive(Default)]
struct LineCount {
    offset: usize,
    ends: u64,
}

impl LineCount {
    fn line_of(&mut self, text: &[u8], offset: usize) -> u64 {
        let offset = offset.min(text.len());
        for at in self.offset..offset {
            // CR LF is one end.
            let is_end = text[at] == b'\n' || (text[at] == b'\r' && text.get(at + 1) != Some(&b'\n'));
            self.ends += u64::from(is_end);
        }
        self.offset = self.offset.max(offset);
        1 + self.ends
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(text: &str) -> Vec<(u64, Vec<String>)> {
        Separated::read(text.as_bytes()).unwrap().rows.into_iter().map(|row| (row.line, row.cells)).collect()
    }

    fn cells(cells: [&str; 2]) -> Vec<String> {
        cells.map(str::to_owned).to_vec()
    }

    #[test]
    fn lines_are_counted_as_editors_do() {
        for end in ["\n", "\r\n", "\r"] {
            let text = ["a,b", "1,2", "", "\"x", "y\",3", "4,5", ""].join(end);
            let expected = vec![(2, cells(["1", "2"])), (4, cells([&format!("x{end}y"), "3"])), (6, cells(["4", "5"]))];
            assert_eq!(rows(&text), expected, "{end:?}");
            let wrong = text.replace("4,5", "4,5,6");
            let error = Separated::read(wrong.as_bytes()).unwrap_err();
            assert_eq!(error.to_string(), "line 6: has 3 cells, the header 2", "{end:?}");
        }
    }

    #[test]
    fn separators_are_told_by_the_header() {
        for (text, separator) in [
            ("a;b\n1,5;2", ';'),
            ("a\tb\n1,5\t2", '\t'),
            ("a,b\n1;5,2", ','),
            ("\"a,;;;\",b\n1,2", ','),
            ("sep=;\r\na;b\r\n1;2", ';'),
            ("\u{feff}a;b\n1;2", ';'),
            ("a\n1", ','),
        ] {
            let table = Separated::read(text.as_bytes()).unwrap();
            assert_eq!(table.separator, separator, "{text:?}");
            assert_eq!(table.rows.len(), 1, "{text:?}");
        }
        let table = Separated::read(b"sep=;\r\na;b\r\n1;2").unwrap();
        assert_eq!((table.column("b"), table.rows[0].line), (Some(1), 3));
    }

    #[test]
    fn decimal_commas_stand_where_commas_do_not_part_cells() {
        let table = |text: &str| Separated::read(text.as_bytes()).unwrap();
        assert_eq!(table("a;b").number("12,5"), Some(12.5));
        assert_eq!(table("a\tb").number("12,5"), Some(12.5));
        assert_eq!(table("a;b").number("12.5"), Some(12.5));
        assert_eq!(table("a,b").number("12,5"), None);
        for wrong in ["1.234,5", "1,234,5", "NaN", "inf", "", "1e999"] {
            assert_eq!(table("a;b").number(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn what_is_no_table_is_named() {
        for (bytes, expected) in [
            (b"".as_slice(), "is empty"),
            (b"\xff\xfea\x00", "is UTF-16, not UTF-8; save it again as 'CSV UTF-8'"),
            (b"a;b\r\nk\xfcche;1", "line 2: is not UTF-8; save it again as 'CSV UTF-8'"),
        ] {
            assert_eq!(Separated::read(bytes).unwrap_err().to_string(), expected);
        }
    }
}
