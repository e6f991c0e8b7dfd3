//! What classifiers said of each room that they did not learn from, as a table.

use super::Condition;
use crate::classify::{Distribution, Method};
use crate::dataset::Row;
use crate::dataset::csv::Guard;
use crate::labels::{Label, Typology};

/// What was said of one room out of fold.
#[derive(Clone, Debug, PartialEq)]
pub struct Prediction {
    /// The room's index among the rows of the collection.
    pub row: usize,
    /// The set that was learned from, less the fold: a typology, or `standard`.
    pub set: String,
    pub method: Method,
    pub condition: Condition,
    /// From 0.
    pub fold: usize,
    pub said: Distribution,
}

/// The columns of the table, in order.
pub const COLUMNS: [&str; 20] = [
    "file",
    "id",
    "building",
    "typology",
    "storey",
    "plan",
    "room",
    "function",
    "set",
    "algorithm",
    "folds_by",
    "neighbours",
    "fold",
    "label",
    "predicted",
    "p_S",
    "p_M",
    "p_B",
    "p_C",
    "p_H",
];

/// The table as CSV: a line for each room, set, algorithm and condition. `rows` are those of the collection.
///
/// # Errors
/// When the table cannot be written, which lack of memory alone could bring about.
pub fn csv(rows: &[Row], predictions: &[Prediction], guard: Guard) -> Result<Vec<u8>, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(COLUMNS)?;
    for Prediction { row, set, method, condition, fold, said } in predictions {
        let Some(row) = rows.get(*row) else { continue };
        let typology = row.typology.as_ref().map(Typology::as_str).unwrap_or_default();
        let texts =
            [&row.file, &row.id, &row.building, typology, &row.storey, &row.plan, &row.room, &row.function, set];
        let words = [method.name(), condition.by.name(), condition.neighbours.name()].map(str::to_owned);
        let label = [(fold + 1).to_string(), row.label.letter().to_owned(), said.label().letter().to_owned()];
        // Six decimals: the sum stays 1 to what anybody computes with.
        let probabilities = Label::ALL.map(|label| format!("{:.6}", said.probability(label)));
        let cells = texts.into_iter().map(|text| guard.cell(text)).chain(words).chain(label).chain(probabilities);
        writer.write_record(cells)?;
    }
    writer.into_inner().map_err(|error| csv::Error::from(error.into_error()))
}
