//! Folds that others can use: dealt by typology as the study deals them, written into a dataset's column `fold`, and read back from
//! any table that names rooms by file and id.

use std::collections::BTreeMap;
use std::io::Read;

use super::Row;
use super::csv::{CsvError, unguarded};
use super::folds::{Folds, FoldsError, Grouping};
use crate::base::natural_order::NaturalKey;
use crate::labels::Typology;

/// Deals the rows of one set; to as many folds as there are rooms or buildings where these are fewer than `count`, which is noted.
///
/// # Errors
/// With fewer than 2 rooms or buildings.
pub fn deal_set(
    rows: &[Row],
    grouping: Grouping,
    count: usize,
    seed: u64,
    name: &str,
    notes: &mut Vec<String>,
) -> Result<Folds, FoldsError> {
    match Folds::new(rows, grouping, count, seed) {
        Err(FoldsError::TooFewRows { have, .. }) if have >= 2 => {
            notes.push(format!("{name}: {have} {}s give {have} folds, not {count}", grouping.name()));
            Folds::new(rows, grouping, have, seed)
        }
        folds => folds,
    }
}

/// The name of a set in notes.
pub fn set_title(typology: Option<&Typology>) -> &str {
    typology.map_or("rooms without a typology", Typology::as_str)
}

/// Deals rows typology by typology, so that the folds of each and those of all together are the same. Sets the rows' folds. Typologies
/// with fewer than two rooms or buildings are dealt together; where that makes no two either, they get none. Gives notes on what could
/// not be done as asked.
pub fn deal(rows: &mut [Row], grouping: Grouping, count: usize, seed: u64) -> Vec<String> {
    let mut notes = Vec::new();
    let mut by_typology: BTreeMap<Option<Typology>, Vec<usize>> = BTreeMap::new();
    for (index, row) in rows.iter().enumerate() {
        by_typology.entry(row.typology.clone()).or_default().push(index);
    }
    let mut alone: Vec<usize> = Vec::new();
    for (typology, of_set) in by_typology {
        let name = set_title(typology.as_ref());
        if deal_rows(rows, &of_set, grouping, count, seed, name, &mut notes).is_err() {
            alone.extend(of_set);
        }
    }
    alone.sort_unstable();
    let name = "typologies of a single building";
    if !alone.is_empty()
        && let Err(error) = deal_rows(rows, &alone, grouping, count, seed, name, &mut notes)
    {
        notes.push(format!("{name}: no folds by {}: {error}", grouping.name()));
    }
    notes
}

/// Deals some of the rows.
fn deal_rows(
    rows: &mut [Row],
    of_set: &[usize],
    grouping: Grouping,
    count: usize,
    seed: u64,
    name: &str,
    notes: &mut Vec<String>,
) -> Result<(), FoldsError> {
    let own: Vec<Row> = of_set.iter().map(|&row| rows[row].clone()).collect();
    let folds = deal_set(&own, grouping, count, seed, name, notes)?;
    for (&row, &fold) in of_set.iter().zip(folds.of_rows()) {
        rows[row].fold = Some(fold);
    }
    Ok(())
}

/// Which fold each room is tested in, as a table says.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FoldTable {
    /// By file and id.
    folds: BTreeMap<(String, String), usize>,
    /// By the file's name without its folders, and id; `None` where several files are called so.
    by_name: BTreeMap<(String, String), Option<usize>>,
    count: usize,
}

impl FoldTable {
    /// Reads a table (CSV) with the columns `file`, `id` and `fold`; others are passed over. What stands in `fold` may be any words:
    /// they are taken in their natural order.
    ///
    /// # Errors
    /// When a column is missing, a room has no fold or two, or there are fewer than two folds.
    pub fn read(input: impl Read) -> Result<Self, CsvError> {
        let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(input);
        let fail = |line: u64, what: String| CsvError { line, what };
        let headers = reader.headers().map_err(|error| fail(0, error.to_string()))?.clone();
        let column = |name: &str| {
            let place = headers.iter().position(|header| header.trim_start_matches('\u{feff}') == name);
            place.ok_or_else(|| fail(1, format!("no column '{name}'; folds are given by the columns file, id, fold")))
        };
        let (file, id, fold) = (column("file")?, column("id")?, column("fold")?);
        let mut words: Vec<(String, String, String, u64)> = Vec::new();
        for record in reader.records() {
            let record =
                record.map_err(|error| fail(error.position().map_or(0, csv::Position::line), error.to_string()))?;
            let line = record.position().map_or(0, csv::Position::line);
            let cell = |index: usize| unguarded(record.get(index).unwrap_or_default()).to_owned();
            if cell(fold).is_empty() {
                return Err(fail(line, "column 'fold' is empty".to_owned()));
            }
            words.push((slashed(&cell(file)), cell(id), cell(fold), line));
        }
        let mut names: Vec<&str> = words.iter().map(|(_, _, fold, _)| fold.as_str()).collect();
        names.sort_by_key(|name| NaturalKey::of(name));
        names.dedup();
        let mut table = Self { count: names.len(), ..Self::default() };
        if names.len() < 2 {
            return Err(fail(0, format!("{} folds: cross-validation needs at least 2", names.len())));
        }
        for (file, id, word, line) in &words {
            let fold = names.iter().position(|name| name == word).unwrap_or_default();
            let before = table.folds.insert((file.clone(), id.clone()), fold);
            if before.is_some_and(|before| before != fold) {
                return Err(fail(*line, format!("room {id} of {file} has another fold further up; give it one")));
            }
        }
        for ((file, id), &fold) in &table.folds {
            let of_name = table.by_name.entry((name_of(file).to_owned(), id.clone()));
            of_name.and_modify(|fold| *fold = None).or_insert(Some(fold));
        }
        Ok(table)
    }

    /// The fold of a room, from 0: by file and id; where the file was named from another folder, by its name, if that is the only
    /// such file.
    pub fn fold_of(&self, file: &str, id: &str) -> Option<usize> {
        let file = slashed(file);
        let by_name = || self.by_name.get(&(name_of(&file).to_owned(), id.to_owned())).copied().flatten();
        self.folds.get(&(file.clone(), id.to_owned())).copied().or_else(by_name)
    }

    /// Number of folds, at least 2.
    pub fn count(&self) -> usize {
        self.count
    }
}

/// A path as all systems write it.
fn slashed(file: &str) -> String {
    let file = file.replace('\\', "/");
    file.strip_prefix("./").map_or_else(|| file.clone(), str::to_owned)
}

fn name_of(file: &str) -> &str {
    file.rsplit('/').next().unwrap_or(file)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folds_are_found_by_file_and_id() {
        let text = "fold,id,label,file\n2,r1,S,plans/a.json\n10,r2,M,plans\\a.json\n2,r1,S,other/b.json\n";
        let table = FoldTable::read(text.as_bytes()).unwrap();
        assert_eq!((table.count(), table.fold_of("./plans/a.json", "r2")), (2, Some(1)));
        assert_eq!((table.fold_of("elsewhere/b.json", "r1"), table.fold_of("c.json", "r1")), (Some(0), None));
        for (text, expected) in [
            ("file,id\n", "line 1: no column 'fold'"),
            ("file,id,fold\na,r1,\n", "line 2: column 'fold' is empty"),
            ("file,id,fold\na,r1,1\na,r2,2\na,r1,2\n", "line 4: room r1 of a has another fold"),
            ("file,id,fold\na,r1,1\n", "1 folds: cross-validation needs"),
        ] {
            let error = FoldTable::read(text.as_bytes()).expect_err(text).to_string();
            assert!(error.starts_with(expected), "{error}");
        }
    }
}
