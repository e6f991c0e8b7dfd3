//! Folds for cross-validation: stratified by room, or such that no building is ever split.

use std::collections::BTreeMap;
use std::fmt;

use super::Row;
use crate::base::random::Random;
use crate::labels::Label;

/// How rows are assigned to folds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Grouping {
    /// By room, as in the paper: rooms of one building are in both training and test sets, which
    /// flatters.
    #[default]
    Room,
    /// By building: the accuracy on a building never seen.
    Building,
}

impl Grouping {
    pub const ALL: [Self; 2] = [Self::Room, Self::Building];

    /// The word for files and for people.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Room => "room",
            Self::Building => "building",
        }
    }
}

/// A partition of rows into folds. Every fold that was dealt has at least one row; of folds that were given some may have none.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Folds {
    count: usize,
    of_row: Vec<usize>,
}

/// Why rows cannot be assigned to this many folds.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FoldsError {
    /// A single fold leaves nothing to test on, or nothing to learn from.
    TooFewFolds(usize),
    /// There are fewer rooms, or fewer buildings, than folds.
    TooFewRows { folds: usize, have: usize, grouping: Grouping },
}

impl fmt::Display for FoldsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooFewFolds(folds) => write!(f, "{folds} folds: cross-validation needs at least 2"),
            Self::TooFewRows { folds, have, grouping } => {
                let what = grouping.name();
                let advice = if *have >= 2 { format!("use at most {have} folds, or add") } else { "add".to_owned() };
                write!(f, "{folds} folds need at least {folds} {what}s, there are {have}; {advice} labelled rooms")?;
                if *grouping == Grouping::Building { f.write_str(" of other buildings") } else { Ok(()) }
            }
        }
    }
}

impl std::error::Error for FoldsError {}

impl Folds {
    /// Assigns rows to `count` folds. The same seed gives the same folds.
    ///
    /// # Errors
    /// With fewer than 2 folds, or fewer rooms or buildings than folds.
    pub fn new(rows: &[Row], grouping: Grouping, count: usize, seed: u64) -> Result<Self, FoldsError> {
        let labels: Vec<Label> = rows.iter().map(|row| row.label).collect();
        match grouping {
            Grouping::Room => Self::stratified(&labels, count, seed),
            Grouping::Building => {
                let buildings: Vec<&str> = rows.iter().map(group_of).collect();
                Self::grouped(&labels, &buildings, count, seed)
            }
        }
    }

    /// Assigns rows to folds so that every fold has the same share of each label and the same number of
    /// rows, each to within one row.
    ///
    /// # Errors
    /// With fewer than 2 folds or fewer rows than folds.
    pub fn stratified(labels: &[Label], count: usize, seed: u64) -> Result<Self, FoldsError> {
        check(count, labels.len(), Grouping::Room)?;
        let mut random = Random::new(seed);
        let mut order: Vec<usize> = (0..labels.len()).collect();
        random.shuffle(&mut order);
        // A stable sort keeps the random order within a label; assignment continues from one label to the
        // next.
        order.sort_by_key(|&row| labels[row]);
        let mut of_row = vec![0; labels.len()];
        for (turn, &row) in order.iter().enumerate() {
            of_row[row] = turn % count;
        }
        Ok(Self { count, of_row })
    }

    /// Assigns whole groups to folds, so that sizes and label shares are as even as the groups allow:
    /// largest groups first, each to the fold where it does the least harm, then moves and swaps of
    /// groups while they help.
    ///
    /// # Errors
    /// With fewer than 2 folds or fewer groups than folds.
    pub fn grouped<G: Ord>(labels: &[Label], groups: &[G], count: usize, seed: u64) -> Result<Self, FoldsError> {
        let mut index_of: BTreeMap<&G, usize> = groups.iter().map(|group| (group, 0)).collect();
        for (index, (_, slot)) in index_of.iter_mut().enumerate() {
            *slot = index;
        }
        check(count, index_of.len(), Grouping::Building)?;
        let mut groups_of_rows = Vec::with_capacity(labels.len());
        let mut counts = vec![[0.0; 5]; index_of.len()];
        for (label, group) in labels.iter().zip(groups) {
            let group = index_of.get(group).copied().unwrap_or_default();
            counts[group][label.index()] += 1.0;
            groups_of_rows.push(group);
        }
        let of_group = assign_groups(&counts, count, seed);
        Ok(Self { count, of_row: groups_of_rows.into_iter().map(|group| of_group[group]).collect() })
    }

    /// The folds that are given for each row, from 0.
    ///
    /// # Errors
    /// When they are fewer than two.
    pub fn given(of_row: Vec<usize>) -> Result<Self, FoldsError> {
        let count = of_row.iter().max().map_or(0, |most| most + 1);
        if count < 2 { Err(FoldsError::TooFewFolds(count)) } else { Ok(Self { count, of_row }) }
    }

    /// Number of folds, at least 2.
    pub fn count(&self) -> usize {
        self.count
    }

    /// The fold of each row.
    pub fn of_rows(&self) -> &[usize] {
        &self.of_row
    }

    /// The rows of a fold, ascending: those to test on.
    pub fn test_rows(&self, fold: usize) -> Vec<usize> {
        self.rows_where(|of_row| of_row == fold)
    }

    /// The rows of all other folds, ascending: those to learn from.
    pub fn training_rows(&self, fold: usize) -> Vec<usize> {
        self.rows_where(|of_row| of_row != fold)
    }

    fn rows_where(&self, wanted: impl Fn(usize) -> bool) -> Vec<usize> {
        self.of_row.iter().enumerate().filter(|&(_, &fold)| wanted(fold)).map(|(row, _)| row).collect()
    }
}

/// What folds never split of a row: its group where there is one, else its building.
pub fn group_of(row: &Row) -> &str {
    if row.group.is_empty() { building_of(row) } else { &row.group }
}

/// The building of a row; a plan that names none stands for itself.
pub fn building_of(row: &Row) -> &str {
    if row.building.is_empty() { &row.plan } else { &row.building }
}

fn check(folds: usize, have: usize, grouping: Grouping) -> Result<(), FoldsError> {
    if folds < 2 {
        return Err(FoldsError::TooFewFolds(folds));
    }
    if have < folds {
        return Err(FoldsError::TooFewRows { folds, have, grouping });
    }
    Ok(())
}

/// Numbers of rows by label.
type Counts = [f64; 5];

/// The unevenness of folds: for each label, and for all rows together, the sum of squares of the folds'
/// shares. Minimal when all folds are equal. Labels have equal weight, however rare; the number of rows
/// weighs as much as the five labels together.
struct Unevenness {
    /// 1 / number of rows with each label; 0 for a label that does not occur.
    weight: Counts,
    /// 1 / number of rows.
    size_weight: f64,
}

impl Unevenness {
    fn of(&self, fold: &Counts) -> f64 {
        let shares: f64 = fold.iter().zip(&self.weight).map(|(count, weight)| (count * weight).powi(2)).sum();
        shares + 5.0 * (fold.iter().sum::<f64>() * self.size_weight).powi(2)
    }

    /// The change in unevenness when `put` joins a fold and `taken` leaves it.
    fn change(&self, fold: &Counts, put: &Counts, taken: &Counts) -> f64 {
        let after: Counts = std::array::from_fn(|i| fold[i] + put[i] - taken[i]);
        self.of(&after) - self.of(fold)
    }
}

const NOTHING: Counts = [0.0; 5];

/// Passes over all groups when improving folds. A few are enough; the cap bounds the time.
const PASSES: usize = 8;

/// The most groups for which swaps are tried: with more, moves alone even out everything that matters.
const GROUPS_TO_SWAP: usize = 1000;

/// The fold of each group: the most even of several attempts. Few groups are hard to spread evenly but
/// quick to retry; many are easy.
fn assign_groups(groups: &[Counts], folds: usize, seed: u64) -> Vec<usize> {
    let mut total = NOTHING;
    for group in groups {
        for (sum, count) in total.iter_mut().zip(group) {
            *sum += count;
        }
    }
    let inverse = |count: f64| if count > 0.0 { 1.0 / count } else { 0.0 };
    let unevenness = Unevenness { weight: total.map(inverse), size_weight: inverse(total.iter().sum()) };
    let attempts = (ATTEMPTS_TIMES_PAIRS / groups.len().pow(2)).clamp(1, MOST_ATTEMPTS);
    let mut random = Random::new(seed);
    let mut best = (f64::INFINITY, Vec::new());
    for _ in 0..attempts {
        let (sums, of_group) = deal_once(groups, folds, &unevenness, &mut random);
        let left: f64 = sums.iter().map(|fold| unevenness.of(fold)).sum();
        if left < best.0 {
            best = (left, of_group);
        }
    }
    best.1
}

/// Bounds the work of all attempts, in pairs of groups examined per pass.
const ATTEMPTS_TIMES_PAIRS: usize = 50_000;

/// More attempts have not been seen to help.
const MOST_ATTEMPTS: usize = 30;

/// One attempt at assigning groups: the rows of each fold by label, and the fold of each group.
fn deal_once(
    groups: &[Counts],
    folds: usize,
    unevenness: &Unevenness,
    random: &mut Random,
) -> (Vec<Counts>, Vec<usize>) {
    let mut order: Vec<usize> = (0..groups.len()).collect();
    random.shuffle(&mut order);
    order.sort_by(|&p, &q| groups[q].iter().sum::<f64>().total_cmp(&groups[p].iter().sum()));
    let mut of_group = vec![0; groups.len()];
    let mut sums = vec![NOTHING; folds];
    let mut sizes = vec![0usize; folds];
    for (turn, &group) in order.iter().enumerate() {
        let left = groups.len() - turn;
        let empty = sizes.iter().filter(|&&size| size == 0).count();
        // When only as many groups are left as there are empty folds, each empty fold gets one.
        let open = (0..folds).filter(|&fold| left > empty || sizes[fold] == 0);
        let harm = |fold: usize| unevenness.change(&sums[fold], &groups[group], &NOTHING);
        let best = open.min_by(|&p, &q| harm(p).total_cmp(&harm(q))).unwrap_or_default();
        put(&mut sums, best, &groups[group], 1.0);
        sizes[best] += 1;
        of_group[group] = best;
    }
    for _ in 0..PASSES {
        let mut improved = false;
        for (turn, &group) in order.iter().enumerate() {
            improved |= move_group(unevenness, groups, group, &mut of_group, &mut sums, &mut sizes);
            if groups.len() <= GROUPS_TO_SWAP {
                for &other in &order[turn + 1..] {
                    improved |= swap_groups(unevenness, groups, group, other, &mut of_group, &mut sums);
                }
            }
        }
        if !improved {
            break;
        }
    }
    (sums, of_group)
}

/// A change must help by more than rounding, or the passes might never end.
const LEAST_GAIN: f64 = 1e-12;

fn put(sums: &mut [Counts], fold: usize, group: &Counts, sign: f64) {
    for (sum, count) in sums[fold].iter_mut().zip(group) {
        *sum += sign * count;
    }
}

/// Moves a group to the fold where it does the least harm; returns whether it moved.
fn move_group(
    unevenness: &Unevenness,
    groups: &[Counts],
    group: usize,
    of_group: &mut [usize],
    sums: &mut [Counts],
    sizes: &mut [usize],
) -> bool {
    let from = of_group[group];
    if sizes[from] < 2 {
        return false;
    }
    let gone = unevenness.change(&sums[from], &NOTHING, &groups[group]);
    let harm = |fold: usize| gone + unevenness.change(&sums[fold], &groups[group], &NOTHING);
    let to = (0..sums.len()).filter(|&fold| fold != from).min_by(|&p, &q| harm(p).total_cmp(&harm(q)));
    let Some(to) = to.filter(|&to| harm(to) < -LEAST_GAIN) else { return false };
    put(sums, from, &groups[group], -1.0);
    put(sums, to, &groups[group], 1.0);
    sizes[from] -= 1;
    sizes[to] += 1;
    of_group[group] = to;
    true
}

/// Swaps two groups of different folds if that helps; returns whether it did.
fn swap_groups(
    unevenness: &Unevenness,
    groups: &[Counts],
    p: usize,
    q: usize,
    of_group: &mut [usize],
    sums: &mut [Counts],
) -> bool {
    let (fold_p, fold_q) = (of_group[p], of_group[q]);
    if fold_p == fold_q {
        return false;
    }
    let gain = unevenness.change(&sums[fold_p], &groups[q], &groups[p])
        + unevenness.change(&sums[fold_q], &groups[p], &groups[q]);
    if gain >= -LEAST_GAIN {
        return false;
    }
    for (fold, comes, goes) in [(fold_p, q, p), (fold_q, p, q)] {
        put(sums, fold, &groups[comes], 1.0);
        put(sums, fold, &groups[goes], -1.0);
    }
    of_group.swap(p, q);
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    fn label(index: usize) -> Label {
        Label::ALL[index % 5]
    }

    fn shares(labels: &[Label], folds: &Folds) -> Vec<[usize; 5]> {
        let mut shares = vec![[0; 5]; folds.count()];
        for (label, &fold) in labels.iter().zip(folds.of_rows()) {
            shares[fold][label.index()] += 1;
        }
        shares
    }

    #[test]
    fn stratified_folds_share_every_label_up_to_one_row() {
        let labels: Vec<Label> = (0..137).map(|i| if i < 90 { Label::SmallRoom } else { label(i) }).collect();
        let folds = Folds::stratified(&labels, 10, 3).expect("enough rows");
        let shares = shares(&labels, &folds);
        for of_label in 0..5 {
            let column = shares.iter().map(|share| share[of_label]);
            assert!(column.clone().max().expect("folds") - column.min().expect("folds") <= 1, "{shares:?}");
        }
        let sizes = shares.iter().map(|share| share.iter().sum::<usize>());
        assert!(sizes.clone().max().expect("folds") - sizes.min().expect("folds") <= 1, "{shares:?}");
        assert_eq!(folds, Folds::stratified(&labels, 10, 3).expect("enough rows"));
        assert_ne!(folds, Folds::stratified(&labels, 10, 4).expect("enough rows"));
    }

    #[test]
    fn training_and_test_rows_make_up_all_rows() {
        let labels: Vec<Label> = (0..23).map(label).collect();
        let folds = Folds::stratified(&labels, 4, 1).expect("enough rows");
        for fold in 0..4 {
            let mut rows = folds.training_rows(fold);
            rows.extend(folds.test_rows(fold));
            rows.sort_unstable();
            assert_eq!(rows, (0..23).collect::<Vec<_>>());
        }
    }

    /// Buildings of very different sizes, each with its own mix of labels.
    fn buildings(seed: u64) -> (Vec<Label>, Vec<usize>) {
        let mut random = Random::new(seed);
        let (mut labels, mut groups) = (Vec::new(), Vec::new());
        for building in 0..40 {
            let taste = random.below(5);
            for _ in 0..3 + random.below(60) {
                labels.push(label(if random.unit() < 0.4 { taste } else { random.below(5) }));
                groups.push(building);
            }
        }
        (labels, groups)
    }

    #[test]
    fn grouped_folds_never_split_a_building_and_stay_even() {
        let (labels, groups) = buildings(11);
        let folds = Folds::grouped(&labels, &groups, 10, 5).expect("enough buildings");
        for building in 0..40 {
            let mut of_rows: Vec<usize> =
                groups.iter().zip(folds.of_rows()).filter(|(group, _)| **group == building).map(|(_, &f)| f).collect();
            of_rows.dedup();
            assert_eq!(of_rows.len(), 1, "building {building} is split");
        }
        let shares = shares(&labels, &folds);
        let even = labels.len() as f64 / 10.0;
        for share in &shares {
            let size: usize = share.iter().sum();
            assert!((size as f64 - even).abs() < 0.08 * even, "{shares:?}");
        }
        for of_label in 0..5 {
            let all: usize = shares.iter().map(|share| share[of_label]).sum();
            for share in &shares {
                let off = share[of_label] as f64 / (all as f64 / 10.0) - 1.0;
                assert!(off.abs() < 0.5, "label {of_label}: {shares:?}");
            }
        }
    }

    #[test]
    fn as_many_folds_as_buildings_gives_each_its_own() {
        let (labels, groups) = buildings(2);
        let folds = Folds::grouped(&labels, &groups, 40, 1).expect("enough buildings");
        let mut used: Vec<usize> = folds.of_rows().to_vec();
        used.sort_unstable();
        used.dedup();
        assert_eq!(used.len(), 40);
    }

    #[test]
    fn impossible_folds_say_what_is_missing() {
        let labels = [Label::Hall; 3];
        for (result, word) in [
            (Folds::stratified(&labels, 1, 0), "at least 2"),
            (Folds::stratified(&labels, 10, 0), "use at most 3 folds"),
            (Folds::stratified(&[], 2, 0), "there are 0; add labelled"),
            (Folds::grouped(&labels, &["one", "one", "two"], 3, 0), "need at least 3 buildings, there are 2"),
        ] {
            let error = result.expect_err(word).to_string();
            assert!(error.contains(word), "{error}");
        }
    }
}
