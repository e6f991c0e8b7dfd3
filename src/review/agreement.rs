//! How far two people who labelled the same rooms agree: the share of rooms, and Cohen's kappa, which leaves out the agreement
//! that chance alone would give.

use crate::classify::Confusion;
use crate::labels::Label;

/// The agreement of two sets of labels, rows the first's, columns the second's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Agreement {
    /// Rooms that both labelled.
    pub rooms: usize,
    /// Rooms to which both gave the same label.
    pub same: usize,
    /// `None` where chance alone would make them agree always: both used one label, and the same; or no room has two labels.
    pub kappa: Option<Kappa>,
}

/// Cohen's kappa with an interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kappa {
    /// 1 for full agreement, 0 for as much as by chance, below 0 for less.
    pub value: f64,
    /// Its standard error.
    pub error: f64,
    /// The ends of the interval that holds the true value in 95 of 100 samples of this size, cut at -1 and 1.
    pub low: f64,
    pub high: f64,
}

/// Ninety-five of a hundred values of a normal distribution lie within so many standard deviations of the middle.
const WITHIN_95: f64 = 1.959_963_984_540_054;

impl Agreement {
    /// Of a table of rooms by the first's label (rows) and the second's (columns).
    pub fn of(table: &Confusion) -> Self {
        let rooms: usize = table.0.iter().flatten().sum();
        let same: usize = (0..5).map(|label| table.0[label][label]).sum();
        Self { rooms, same, kappa: Kappa::of(table) }
    }

    /// The share of rooms with the same label, 0..=1; `None` without rooms.
    pub fn share(&self) -> Option<f64> {
        (self.rooms > 0).then(|| self.same as f64 / self.rooms as f64)
    }
}

impl Kappa {
    /// Cohen (1960), 'A coefficient of agreement for nominal scales'; its standard error for large samples after Fleiss, Cohen and
    /// Everitt (1969), 'Large sample standard errors of kappa and weighted kappa', equation 13. With fewer than some thirty rooms
    /// the interval is rough.
    pub fn of(table: &Confusion) -> Option<Self> {
        let rooms = table.0.iter().flatten().sum::<usize>() as f64;
        if rooms == 0.0 {
            return None;
        }
        let share = |row: usize, column: usize| table.0[row][column] as f64 / rooms;
        let rows: [f64; 5] = std::array::from_fn(|row| (0..5).map(|column| share(row, column)).sum());
        let columns: [f64; 5] = std::array::from_fn(|column| (0..5).map(|row| share(row, column)).sum());
        let observed: f64 = (0..5).map(|label| share(label, label)).sum();
        let by_chance: f64 = rows.iter().zip(&columns).map(|(row, column)| row * column).sum();
        let spare = 1.0 - by_chance;
        if spare < 1e-12 {
            return None;
        }
        let value = (observed - by_chance) / spare;
        let mut variance = 0.0;
        for row in 0..5 {
            for column in 0..5 {
                variance += if row == column {
                    share(row, column) * (1.0 - (rows[row] + columns[row]) * (1.0 - value)).powi(2)
                } else {
                    share(row, column) * ((columns[row] + rows[column]) * (1.0 - value)).powi(2)
                };
            }
        }
        variance -= (value - by_chance * (1.0 - value)).powi(2);
        // Rounding may leave a little less than nothing where all agree.
        let error = variance.max(0.0).sqrt() / (spare * rooms.sqrt());
        let reach = WITHIN_95 * error;
        Some(Self { value, error, low: (value - reach).max(-1.0), high: (value + reach).min(1.0) })
    }

    /// What the value means, after Landis and Koch (1977), 'The measurement of observer agreement for categorical data'.
    pub fn in_words(&self) -> &'static str {
        match self.value {
            value if value < 0.0 => "poor",
            value if value <= 0.2 => "slight",
            value if value <= 0.4 => "fair",
            value if value <= 0.6 => "moderate",
            value if value <= 0.8 => "substantial",
            _ => "almost perfect",
        }
    }
}

/// A table of rooms by two labels.
pub fn table_of(pairs: impl Iterator<Item = (Label, Label)>) -> Confusion {
    let mut table = Confusion::default();
    for (first, second) in pairs {
        table.0[first.index()][second.index()] += 1;
    }
    table
}
