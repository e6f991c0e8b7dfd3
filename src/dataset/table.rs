//! Labelled rooms as plain numbers: what the classifiers learn from.

use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;

use super::Row;
use crate::base::hash;
use crate::features::Features;
use crate::labels::Label;

/// Number of features in `F_r`.
pub const FEATURES: usize = Features::NAMES.len();

/// The values of `F_r` in the order of [`Features::NAMES`].
pub type Values = [f64; FEATURES];

/// The origin of a row, so that an explanation can name it.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct RoomSource {
    /// Name of the plan.
    pub plan: Arc<str>,
    /// What the room is for; if unknown, its name or id in its plan.
    pub room: Arc<str>,
}

impl fmt::Display for RoomSource {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} in {}", self.room, self.plan)
    }
}

/// Features and labels of rooms, validated: at least one row, every feature finite and not negative.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    values: Vec<Values>,
    labels: Vec<Label>,
    sources: Vec<RoomSource>,
}

/// Why rows cannot be learned from, and what to do about it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum TableError {
    /// There is no row.
    Empty,
    /// A feature is NaN, infinite or negative: the first such value, and how many rows have one.
    BadValue { source: RoomSource, feature: &'static str, value: String, rows: usize },
}

impl fmt::Display for TableError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty => f.write_str("there are no labelled rooms to learn from; label some rooms, or add plans"),
            Self::BadValue { source, feature, value, rows: 1 } => write!(
                f,
                "1 row has a feature that is not a number of at least 0: {source}, where {feature} is {value}; correct \
                 or remove it"
            ),
            Self::BadValue { source, feature, value, rows } => write!(
                f,
                "{rows} rows have a feature that is not a number of at least 0; the first is {source}, where {feature} \
                 is {value}; correct or remove them"
            ),
        }
    }
}

impl std::error::Error for TableError {}

impl Table {
    /// The table of a dataset's rows, in their order.
    ///
    /// # Errors
    /// When there is no row, or a feature is NaN, infinite or negative.
    pub fn from_rows<'a>(rows: impl IntoIterator<Item = &'a Row>) -> Result<Self, TableError> {
        let mut names: BTreeMap<&str, Arc<str>> = BTreeMap::new();
        let mut table = Self { values: Vec::new(), labels: Vec::new(), sources: Vec::new() };
        for row in rows {
            let plan = names.entry(&row.plan).or_insert_with(|| row.plan.as_str().into()).clone();
            table.values.push(row.features.values());
            table.labels.push(row.label);
            // What a room is for tells a reader more than its number.
            let room = if row.function.is_empty() { &row.room } else { &row.function };
            table.sources.push(RoomSource { plan, room: room.as_str().into() });
        }
        table.checked()
    }

    /// A table from its columns, which must be equally long; longer ones are truncated.
    ///
    /// # Errors
    /// As [`Table::from_rows`].
    pub fn from_columns(
        mut values: Vec<Values>,
        mut labels: Vec<Label>,
        mut sources: Vec<RoomSource>,
    ) -> Result<Self, TableError> {
        let rows = values.len().min(labels.len()).min(sources.len());
        values.truncate(rows);
        labels.truncate(rows);
        sources.truncate(rows);
        Self { values, labels, sources }.checked()
    }

    fn checked(self) -> Result<Self, TableError> {
        if self.values.is_empty() {
            return Err(TableError::Empty);
        }
        let bad = |values: &Values| values.iter().position(|value| !(value.is_finite() && *value >= 0.0));
        let rows = self.values.iter().filter(|values| bad(values).is_some()).count();
        let first = self.values.iter().enumerate().find_map(|(row, values)| Some((row, bad(values)?)));
        match first {
            None => Ok(self),
            Some((row, feature)) => Err(TableError::BadValue {
                source: self.sources[row].clone(),
                feature: Features::NAMES[feature],
                value: self.values[row][feature].to_string(),
                rows,
            }),
        }
    }

    /// Number of rows, at least 1.
    pub fn len(&self) -> usize {
        self.values.len()
    }

    /// Never: a table has at least one row.
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// The features of each row.
    pub fn values(&self) -> &[Values] {
        &self.values
    }

    /// The true label of each row.
    pub fn labels(&self) -> &[Label] {
        &self.labels
    }

    /// The origin of each row.
    pub fn sources(&self) -> &[RoomSource] {
        &self.sources
    }

    /// How many rows carry each label, in the order of [`Label::ALL`].
    pub fn label_counts(&self) -> [usize; 5] {
        let mut counts = [0; 5];
        for label in &self.labels {
            counts[label.index()] += 1;
        }
        counts
    }

    /// The rows at these indices, in order; `None` if there are none, or one does not exist.
    pub fn subset(&self, rows: &[usize]) -> Option<Self> {
        if rows.is_empty() || rows.iter().any(|&row| row >= self.len()) {
            return None;
        }
        Some(Self {
            values: rows.iter().map(|&row| self.values[row]).collect(),
            labels: rows.iter().map(|&row| self.labels[row]).collect(),
            sources: rows.iter().map(|&row| self.sources[row].clone()).collect(),
        })
    }

    /// A fingerprint of features and labels in order: FNV-1a, 64 bits. It tells data sets apart and shows
    /// which data a model was trained on; it does not guard against forgery.
    pub fn fingerprint(&self) -> u64 {
        let numbers = self.values.iter().flatten().flat_map(|value| value.to_bits().to_le_bytes());
        let labels = self.labels.iter().map(|&label| label.index() as u8);
        hash::fnv1a(hash::START, numbers.chain(labels))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(area_m2: f64) -> Row {
        let features = Features { area_m2, axes_ratio: 1.0, doors: 0, doors_to: [0; 5] };
        Row { plan: "p".to_owned(), building: "b".to_owned(), room: "r".to_owned(), ..Row::new(Label::Hall, features) }
    }

    #[test]
    fn rows_that_teach_nothing_are_named() {
        assert_eq!(Table::from_rows(&[]), Err(TableError::Empty));
        for (area_m2, word) in [(f64::NAN, "NaN"), (f64::INFINITY, "inf"), (-1.0, "-1")] {
            let error = Table::from_rows(&[row(1.0), row(area_m2), row(f64::NAN)]).expect_err(word).to_string();
            assert!(
                error.starts_with("2 rows have") && error.contains(&format!("r in p, where a is {word};")),
                "{error}"
            );
        }
    }

    #[test]
    fn the_fingerprint_follows_values_and_labels() {
        // The published test vector of FNV-1a.
        assert_eq!(hash::fnv1a(hash::START, *b"foobar"), 0x8594_4171_f739_67e8);
        let table = |rows: &[Row]| Table::from_rows(rows).expect("good rows").fingerprint();
        let mut other = row(1.0);
        other.label = Label::Corridor;
        assert_eq!(table(&[row(1.0)]), table(&[row(1.0)]));
        assert_ne!(table(&[row(1.0)]), table(&[row(1.5)]));
        assert_ne!(table(&[row(1.0)]), table(&[other]));
    }
}
