//! What changed between two readings of the same rooms: a dataset as it was exported, and the plans as they are now.

use std::collections::BTreeMap;

use super::Row;
use super::csv::feature_cells;
use crate::labels::Label;

/// What changed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Changes {
    /// Indices in the new rows of rooms that are new.
    pub added: Vec<usize>,
    /// Indices in the old rows of rooms that are gone.
    pub removed: Vec<usize>,
    /// Rooms with another label: index in the new rows, and the label before.
    pub relabelled: Vec<(usize, Label)>,
    /// Indices in the new rows of rooms with the same label whose features changed.
    pub reshaped: Vec<usize>,
}

impl Changes {
    /// Compares rows by file and id. Folders before a file's name do not count, since a table may have been made elsewhere.
    pub fn between(old: &[Row], new: &[Row]) -> Self {
        fn key(row: &Row) -> (&str, &str, &str, &str) {
            let file = row.file.rsplit(['/', '\\']).next().unwrap_or_default();
            (file, row.plan.as_str(), row.storey.as_str(), if row.id.is_empty() { &row.room } else { &row.id })
        }
        let before: BTreeMap<_, usize> = old.iter().enumerate().map(|(index, row)| (key(row), index)).collect();
        let mut is_kept = vec![false; old.len()];
        let mut changes = Self::default();
        for (index, row) in new.iter().enumerate() {
            let Some(&at) = before.get(&key(row)) else {
                changes.added.push(index);
                continue;
            };
            is_kept[at] = true;
            let was = &old[at];
            if was.label != row.label {
                changes.relabelled.push((index, was.label));
            } else if feature_cells(&was.features) != feature_cells(&row.features) {
                changes.reshaped.push(index);
            }
        }
        changes.removed = (0..old.len()).filter(|&at| !is_kept[at]).collect();
        changes
    }

    /// Whether nothing changed.
    pub fn is_empty(&self) -> bool {
        self.added.is_empty() && self.removed.is_empty() && self.relabelled.is_empty() && self.reshaped.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::features::Features;

    fn row(file: &str, id: &str, label: Label, area_m2: f64) -> Row {
        let features = Features { area_m2, axes_ratio: 1.0, doors: 1, doors_to: [0; 5] };
        Row { file: file.to_owned(), id: id.to_owned(), ..Row::new(label, features) }
    }

    #[test]
    fn each_room_is_told_once() {
        let old = [
            row("a/x.json", "r1", Label::Hall, 50.0),
            row("a/x.json", "r2", Label::Hall, 50.0),
            row("a/x.json", "r3", Label::Hall, 50.0),
            row("a/y.json", "r1", Label::Hall, 50.0),
        ];
        let new = [
            row("x.json", "r1", Label::Hall, 50.0),
            row("x.json", "r2", Label::BigRoom, 51.0),
            row("x.json", "r3", Label::Hall, 51.0),
            row("x.json", "r4", Label::Hall, 50.0),
        ];
        let changes = Changes::between(&old, &new);
        assert_eq!((changes.added, changes.removed, changes.reshaped), (vec![3], vec![3], vec![2]));
        assert_eq!(changes.relabelled, [(1, Label::Hall)]);
        assert!(Changes::between(&old, &old).is_empty());
    }
}
