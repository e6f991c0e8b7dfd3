//! Datasets as CSV (RFC 4180, UTF-8).

use std::fmt;
use std::io::{Read, Write};

use super::Row;
use super::folds::group_of;
use crate::base::separated::{Separated, SeparatedRow};
use crate::features::Features;
use crate::labels::Typology;

/// The columns of a dataset file, in order.
#[rustfmt::skip] // as they belong together
pub const COLUMNS: [&str; 20] = [
    "file", "id", "building", "typology", "storey", "plan", "room", "function", "label", "label_origin", "fold",
    "a", "rt", "d", "l_S", "l_M", "l_B", "l_C", "l_H", "group",
];

/// Whether texts that a spreadsheet would take for a formula are guarded.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Guard {
    /// Texts stand as they are: what programs expect.
    #[default]
    Off,
    /// A text that begins like a formula gets an apostrophe in front; [`read`] takes it off again.
    On,
}

impl Guard {
    /// A text as a cell.
    pub fn cell(self, text: &str) -> String {
        if self == Self::On && begins_like_a_formula(text) { format!("'{text}") } else { text.to_owned() }
    }
}

/// Whether spreadsheets may take a text for a formula (OWASP, CSV injection).
fn begins_like_a_formula(text: &str) -> bool {
    text.starts_with(['=', '+', '-', '@', '\t', '\r'])
}

/// A text without the apostrophe that [`Guard::On`] put in front.
pub fn unguarded(cell: &str) -> &str {
    cell.strip_prefix('\'').filter(|text| begins_like_a_formula(text)).unwrap_or(cell)
}

/// Writes rows with a header.
///
/// # Errors
/// When the writer fails.
pub fn write(out: impl Write, rows: &[Row]) -> Result<(), csv::Error> {
    write_guarded(out, rows, Guard::Off)
}

/// The same, with texts guarded or not.
///
/// # Errors
/// As [`write()`].
pub fn write_guarded(out: impl Write, rows: &[Row], guard: Guard) -> Result<(), csv::Error> {
    let mut writer = csv::Writer::from_writer(out);
    writer.write_record(COLUMNS)?;
    for row in rows {
        let texts = head_cells(row).into_iter().map(|cell| guard.cell(&cell));
        let cells = texts.chain(feature_cells(&row.features)).chain([guard.cell(group_of(row))]);
        writer.write_record(cells)?;
    }
    writer.flush()?;
    Ok(())
}

/// The cells of [`COLUMNS`] before the features.
fn head_cells(row: &Row) -> [String; 11] {
    let typology = row.typology.as_ref().map(Typology::as_str).unwrap_or_default();
    let fold = row.fold.map(|fold| (fold + 1).to_string()).unwrap_or_default();
    let texts = [&row.file, &row.id, &row.building, typology, &row.storey, &row.plan, &row.room, &row.function];
    let [file, id, building, typology, storey, plan, room, function] = texts.map(str::to_owned);
    let (label, origin) = (row.label.letter().to_owned(), row.label_origin.clone());
    [file, id, building, typology, storey, plan, room, function, label, origin, fold]
}

/// The eight features as cells: at most six decimals, no trailing zeros.
pub fn feature_cells(features: &Features) -> [String; 8] {
    features.values().map(cell)
}

/// A number as a cell: at most six decimals, no trailing zeros.
pub fn cell(value: f64) -> String {
    ((value * 1e6).round() / 1e6).to_string()
}

/// Why a dataset file could not be read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CsvError {
    /// Line from 1; 0 for the file as a whole.
    pub line: u64,
    pub what: String,
}

impl fmt::Display for CsvError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.line {
            0 => f.write_str(&self.what),
            line => write!(f, "line {line}: {}", self.what),
        }
    }
}

impl std::error::Error for CsvError {}

/// Reads rows written by [`write()`]; columns may come in any order and others are passed over.
/// All but the label and the features may be missing. The folds of the file are not taken: who wants them reads them as a
/// [`super::fold_table::FoldTable`].
/// Cells may be apart by semicolons or tabs too, and numbers then have a decimal comma, see [`crate::base::separated`].
///
/// # Errors
/// When it cannot be read or is no table, a needed column is missing, a label is unknown, or a number is not
/// finite or negative; with the line and column.
pub fn read(mut input: impl Read) -> Result<Vec<Row>, CsvError> {
    let fail = |line: u64, what: String| CsvError { line, what };
    let mut bytes = Vec::new();
    input.read_to_end(&mut bytes).map_err(|error| fail(0, error.to_string()))?;
    let table = Separated::read(&bytes).map_err(|error| fail(error.line, error.what))?;
    drop(bytes);
    let needed = |name: &str| {
        table
            .column(name)
            .ok_or_else(|| fail(1, format!("no column '{name}'; a dataset has the columns {}", COLUMNS.join(","))))
    };
    let texts = ["plan", "building", "typology", "room", "function"].map(|name| table.column(name));
    let more = ["file", "id", "storey", "label_origin", "group"].map(|name| table.column(name));
    let label = needed("label")?;
    let mut numbers = [0; 8];
    for (index, name) in Features::NAMES.into_iter().enumerate() {
        numbers[index] = needed(name)?;
    }
    let mut rows = Vec::new();
    for SeparatedRow { line, cells } in &table.rows {
        let line = *line;
        let text = |index: Option<usize>| {
            unguarded(index.and_then(|index| cells.get(index)).map(String::as_str).unwrap_or_default()).to_owned()
        };
        let mut values = [0.0; 8];
        for (name, (&index, value)) in Features::NAMES.into_iter().zip(numbers.iter().zip(&mut values)) {
            let cell = cells.get(index).map(String::as_str).unwrap_or_default();
            *value = table
                .number(cell)
                .filter(|number| *number >= 0.0)
                .ok_or_else(|| fail(line, format!("column '{name}': '{cell}' is not a number from 0 up")))?;
            // `d` and `l_s` are counts.
            if !matches!(name, "a" | "rt") && (value.fract() != 0.0 || *value > f64::from(u32::MAX)) {
                return Err(fail(line, format!("column '{name}': '{cell}' is not a whole number")));
            }
        }
        let count = |index: usize| values[index] as u32;
        let [file, id, storey, label_origin, group] = more.map(text);
        rows.push(Row {
            file,
            id,
            storey,
            label_origin,
            group,
            fold: None,
            plan: text(texts[0]),
            building: text(texts[1]),
            typology: Typology::new(&text(texts[2])),
            room: text(texts[3]),
            function: text(texts[4]),
            label: text(Some(label)).parse().map_err(|error| fail(line, format!("column 'label': {error}")))?,
            features: Features {
                area_m2: values[0],
                axes_ratio: values[1],
                doors: count(2),
                doors_to: [count(3), count(4), count(5), count(6), count(7)],
            },
        });
    }
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read() {
        let features = Features { area_m2: 12.25, axes_ratio: 1.333333, doors: 3, doors_to: [0, 1, 0, 2, 0] };
        let rows = vec![Row {
            file: "plans/casa.plan.json".to_owned(),
            id: "r1".to_owned(),
            plan: "Casa \"Rossi\", piano 1".to_owned(),
            building: "b".to_owned(),
            storey: "-1".to_owned(),
            typology: Typology::new("house"),
            room: "=SUM(A1)".to_owned(),
            function: "bath,room".to_owned(),
            label_origin: "person".to_owned(),
            group: "b and c".to_owned(),
            ..Row::new(crate::labels::Label::SmallRoom, features)
        }];
        for guard in [Guard::Off, Guard::On] {
            let mut bytes = Vec::new();
            write_guarded(&mut bytes, &rows, guard).expect("writing to memory");
            let text = String::from_utf8(bytes).expect("text");
            assert_eq!(text.contains(",'=SUM(A1),") && text.contains(",'-1,"), guard == Guard::On, "{text}");
            assert_eq!(read(text.as_bytes()), Ok(rows.clone()));
        }
    }

    #[test]
    fn a_spreadsheet_of_half_of_europe_is_read() {
        let plain = "plan,label,a,rt,d,l_S,l_M,l_B,l_C,l_H\np,M,12.5,1.2,1,0,0,0,1,0\n";
        let expected = read(plain.as_bytes()).expect("a table");
        assert_eq!((expected.len(), expected[0].features.area_m2), (1, 12.5));
        let semicolons = plain.replace(',', ";").replace('.', ",").replace('\n', "\r\n");
        assert_eq!(read(semicolons.as_bytes()), Ok(expected.clone()));
        assert_eq!(read(plain.replace(',', "\t").as_bytes()), Ok(expected));
        let crlf = "label,a,rt,d,l_S,l_M,l_B,l_C,l_H\r\nM,1,1,1,0,0,0,0,0\r\nQ,1,1,1,0,0,0,0,0\r\n";
        assert_eq!(read(crlf.as_bytes()).map_err(|error| error.line), Err(3));
    }

    #[test]
    fn errors_name_line_and_column() {
        let head = "label,a,rt,d,l_S,l_M,l_B,l_C,l_H\n";
        for (text, expected) in [
            ("label,a\n", "line 1: no column 'rt'"),
            (&format!("{head}S,1,1,1,0,0,0,0,0\nX,1,1,1,0,0,0,0,0\n"), "line 3: column 'label': unknown label 'X'"),
            (&format!("{head}S,NaN,1,1,0,0,0,0,0\n"), "line 2: column 'a': 'NaN' is not a number from 0 up"),
            (&format!("{head}S,1,1,1.5,0,0,0,0,0\n"), "line 2: column 'd': '1.5' is not a whole number"),
            (&format!("{head}S,1\n"), "line 2: "),
        ] {
            let error = read(text.as_bytes()).expect_err(text).to_string();
            assert!(error.starts_with(expected), "{error:?}");
        }
    }
}
