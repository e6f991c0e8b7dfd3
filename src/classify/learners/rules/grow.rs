//! Growing and pruning a single rule.

use super::bits::Bits;
use crate::dataset::table::{FEATURES, Table};

/// A condition on the rank of a feature's value among the values that occur in training.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct RankCondition {
    pub feature: usize,
    /// Whether the rank must be at most the bound; otherwise at least.
    pub at_most: bool,
    pub rank: u32,
}

/// The training rooms, each value replaced by its rank.
pub(super) struct Ranked {
    /// For each feature the rank of each row's value.
    ranks: [Vec<u32>; FEATURES],
    /// For each feature the values that occur, ascending: rank to value.
    pub values: [Vec<f64>; FEATURES],
    /// log2 of every number up to the number of rows plus one.
    log2: Vec<f64>,
}

impl Ranked {
    pub fn new(table: &Table) -> Self {
        let mut values: [Vec<f64>; FEATURES] = Default::default();
        let mut ranks: [Vec<u32>; FEATURES] = Default::default();
        for feature in 0..FEATURES {
            let mut order: Vec<(f64, u32)> =
                table.values().iter().zip(0..).map(|(row, index)| (row[feature], index)).collect();
            order.sort_unstable_by(|p, q| p.0.total_cmp(&q.0));
            let (values, ranks) = (&mut values[feature], &mut ranks[feature]);
            ranks.resize(order.len(), 0);
            for (value, row) in order {
                if values.last() != Some(&value) {
                    values.push(value);
                }
                ranks[row as usize] = values.len() as u32 - 1;
            }
        }
        let log2 = (0..table.len() + 2).map(|n| (n.max(1) as f64).log2()).collect();
        Self { ranks, values, log2 }
    }

    pub fn rows(&self) -> usize {
        self.ranks[0].len()
    }

    pub fn meets(&self, row: u32, condition: &RankCondition) -> bool {
        let rank = self.ranks[condition.feature][row as usize];
        if condition.at_most { rank <= condition.rank } else { rank >= condition.rank }
    }

    /// All rows that meet all conditions.
    pub fn covered(&self, conditions: &[RankCondition]) -> Bits {
        Bits::of(self.rows(), |row| conditions.iter().all(|condition| self.meets(row as u32, condition)))
    }
}

/// The fewest training rooms a condition must cover correctly (Weka's default).
const LEAST_RIGHT: u32 = 2;

/// A gain must exceed rounding error.
const LEAST_GAIN: f64 = 1e-6;

/// A number of rooms and, in the upper half, the number of those with the wanted label: both add up at
/// once.
type Packed = u64;

const ONE: Packed = 1;
const ONE_WANTED: Packed = 1 << 32;

/// A feature with at most this many values (numbers of openings) is counted in several banks in turn: the
/// next row often has the same value, and the processor need not wait for the last sum.
const FEW_VALUES: usize = 32;
const BANKS: usize = 4;

const fn rooms(packed: Packed) -> u32 {
    packed as u32
}

const fn wanted(packed: Packed) -> u32 {
    (packed >> 32) as u32
}

/// Adds conditions to a rule, each the one with the best gain on the rows it still covers, until it
/// covers no row with another label or nothing helps.
pub(super) fn grow(ranked: &Ranked, label: &Bits, rows: Vec<u32>, rule: &mut Vec<RankCondition>) {
    let mut search = Search { ranked, label, rows, units: Vec::new(), bins: Vec::new(), order: Vec::new() };
    while let Some(condition) = search.best_condition() {
        rule.push(condition);
        search.rows.retain(|&row| ranked.meets(row, &condition));
    }
}

/// The rows that a growing rule still covers, and buffers for counting.
struct Search<'a> {
    ranked: &'a Ranked,
    label: &'a Bits,
    rows: Vec<u32>,
    /// What each row adds to a count.
    units: Vec<Packed>,
    bins: Vec<Packed>,
    /// A rank, and in the lowest bit whether the row has the label.
    order: Vec<u64>,
}

/// The best condition so far.
struct Best {
    condition: Option<RankCondition>,
    gain: f64,
    right: u32,
    /// All rooms.
    all: Packed,
    /// The uncertainty in bits of the rooms' label before any condition, negated.
    before: f64,
}

impl Best {
    /// Considers both conditions that split the rooms between two neighbouring values.
    fn offer(&mut self, log2: &[f64], feature: usize, below: Packed, last: u32, next: u32) {
        let at_most = RankCondition { feature, at_most: true, rank: last };
        let at_least = RankCondition { feature, at_most: false, rank: next };
        for (packed, condition) in [(below, at_most), (self.all - below, at_least)] {
            let right = wanted(packed);
            // The gain cannot exceed that of covering only correct rooms.
            if f64::from(right) * -self.before <= self.gain {
                continue;
            }
            // FOIL's gain (Quinlan 1990): the rooms covered correctly times the bits of certainty the
            // condition adds to their label. The ones are Laplace's: small numbers prove little.
            let bits = log2[right as usize + 1] - log2[rooms(packed) as usize + 1];
            let gain = f64::from(right) * (bits - self.before);
            if gain > self.gain + LEAST_GAIN {
                *self = Self { condition: Some(condition), gain, right, ..*self };
            }
        }
    }
}

impl Search<'_> {
    fn best_condition(&mut self) -> Option<RankCondition> {
        let log2 = &self.ranked.log2;
        self.units.clear();
        let unit = |&row: &u32| if self.label.contains(row) { ONE + ONE_WANTED } else { ONE };
        self.units.extend(self.rows.iter().map(unit));
        let all: Packed = self.units.iter().sum();
        if wanted(all) == rooms(all) {
            return None;
        }
        let before = log2[wanted(all) as usize + 1] - log2[rooms(all) as usize + 1];
        let mut best = Best { condition: None, gain: 0.0, right: 0, all, before };
        for feature in 0..FEATURES {
            let ranks = &self.ranked.ranks[feature];
            let distinct = self.ranked.values[feature].len();
            let (mut below, mut last) = (0, None);
            let mut step = |rank: u32, packed: Packed| {
                if let Some(last) = last {
                    best.offer(log2, feature, below, last, rank);
                }
                below += packed;
                last = Some(rank);
            };
            let units = self.rows.iter().map(|&row| ranks[row as usize]).zip(self.units.iter().copied());
            // Counting by rank beats sorting unless most ranks would be empty.
            if distinct <= FEW_VALUES {
                let mut banks = [[0; FEW_VALUES]; BANKS];
                for (index, (rank, unit)) in units.enumerate() {
                    banks[index % BANKS][rank as usize % FEW_VALUES] += unit;
                }
                for rank in 0..distinct {
                    let packed = banks.iter().map(|bank| bank[rank]).sum();
                    if packed > 0 {
                        step(rank as u32, packed);
                    }
                }
            } else if distinct <= 4 * self.rows.len() {
                self.bins.clear();
                self.bins.resize(distinct, 0);
                for (rank, unit) in units {
                    self.bins[rank as usize] += unit;
                }
                for (rank, &packed) in (0..).zip(&self.bins) {
                    if packed > 0 {
                        step(rank, packed);
                    }
                }
            } else {
                self.order.clear();
                self.order.extend(units.map(|(rank, unit)| u64::from(rank) << 1 | (unit >> 32)));
                self.order.sort_unstable();
                for same in self.order.chunk_by(|p, q| p >> 1 == q >> 1) {
                    let wanted: Packed = same.iter().map(|entry| entry & 1).sum();
                    step((same[0] >> 1) as u32, same.len() as Packed + (wanted << 32));
                }
            }
        }
        best.condition.filter(|_| best.right >= LEAST_RIGHT)
    }
}

/// The criterion for pruning a rule.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Worth {
    /// The share of the covered rows that are correct: for a rule on its own.
    OfRule,
    /// The share of all rows that are decided correctly, covered or not: for a rule within a set.
    OfSet,
}

/// Removes conditions from the end of a rule so that it does best on rows it was not grown on
/// (incremental reduced-error pruning, Fürnkranz and Widmer 1994).
pub(super) fn prune(ranked: &Ranked, label: &Bits, mut rows: Vec<u32>, rule: &mut Vec<RankCondition>, worth: Worth) {
    let total = rows.len() as f64;
    if rows.is_empty() {
        return;
    }
    let count_right = |rows: &[u32]| rows.iter().filter(|&&row| label.contains(row)).count() as f64;
    let others = total - count_right(&rows);
    // Without conditions; the ones and twos are Laplace's.
    let mut best = ((count_right(&rows) + 1.0) / (total + 2.0), 0);
    for length in 1..=rule.len() {
        rows.retain(|&row| ranked.meets(row, &rule[length - 1]));
        let (covered, right) = (rows.len() as f64, count_right(&rows));
        let share = match worth {
            Worth::OfRule => (right + 1.0) / (covered + 2.0),
            Worth::OfSet => (right + others - (covered - right)) / total,
        };
        if share > best.0 {
            best = (share, length);
        }
    }
    rule.truncate(best.1);
}
