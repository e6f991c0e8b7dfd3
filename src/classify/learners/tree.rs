//! A decision tree after Quinlan's C4.5 (1993): gain ratio, numeric splits, pessimistic pruning with
//! subtree raising, Laplace probabilities.

use std::sync::Arc;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::base::work::{Cancelled, Work};
use crate::classify::Distribution;
use crate::classify::condition::{Bound, Condition};
use crate::classify::explain::{PathReason, Reason, Step};
use crate::classify::learner::{Learner, Model, Trained};
use crate::classify::numbers::readable_between;
use crate::dataset::table::{FEATURES, Table, Values};
use crate::features::Features;
use crate::labels::Label;

/// Fewest training rooms on a side of a split (C4.5's default).
const LEAST_ROOMS: f64 = 2.0;

/// Confidence for pruning: a leaf's errors are taken at the upper end of a one-sided confidence interval
/// (C4.5's default).
const CONFIDENCE: f64 = 0.25;

/// The normal quantile of 1 - [`CONFIDENCE`].
const DEVIATIONS: f64 = 0.674_489_750_196_081_7;

/// Maximum depth. Trees on real rooms stay below 30; the cap bounds recursion on contrived data.
const DEEPEST: usize = 120;

/// The learner.
pub struct C45;

impl Learner for C45 {
    fn id(&self) -> &'static str {
        "tree"
    }

    fn title(&self) -> &'static str {
        "decision tree"
    }

    fn short_title(&self) -> &'static str {
        "Decision tree"
    }

    fn help(&self) -> &'static str {
        "a decision tree, each room by itself"
    }

    fn train(&self, table: &Table, _: u64, work: &Work<'_>) -> Result<Trained<Arc<dyn Model>>, Cancelled> {
        work.goes_on()?;
        // Laplace's correction alone calibrates it as well as a temperature would: see the rules.
        Ok(Trained { model: Tree::train(table), temperature: 1.0 }.shared())
    }

    fn from_json(&self, model: Value) -> Option<Arc<dyn Model>> {
        let disk: DiskTree = serde_json::from_value(model).ok()?;
        let nodes = disk.nodes.into_iter().map(DiskNode::live).collect::<Option<_>>()?;
        Some(Arc::new(Tree::from_nodes(nodes)?))
    }
}

impl Model for Tree {
    fn predict(&self, values: &Values) -> Distribution {
        self.predict(values)
    }

    fn explain(&self, values: &Values, label: Label, _: &dyn Fn(&Values) -> Distribution) -> Reason {
        let path = self.path(values);
        let steps: Vec<Step> = path
            .iter()
            .filter_map(|node| node.split)
            .map(|split| Step {
                feature: split.feature,
                at_most: split.at_most,
                yes: values[split.feature] <= split.at_most,
            })
            .collect();
        let counts = path.last().map(|leaf| leaf.counts).unwrap_or_default();
        Reason::Path(PathReason {
            conditions: tightest(&steps),
            steps,
            rooms: counts.iter().sum(),
            right: counts[label.index()],
        })
    }

    fn to_json(&self) -> Value {
        let nodes = self.nodes.iter().map(DiskNode::of).collect();
        // Plain structs of numbers and texts can always be written.
        serde_json::to_value(DiskTree { nodes }).unwrap_or_default()
    }
}

#[derive(Serialize, Deserialize)]
struct DiskTree {
    nodes: Vec<DiskNode>,
}

#[derive(Serialize, Deserialize)]
struct DiskNode {
    #[serde(skip_serializing_if = "Option::is_none")]
    feature: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    at_most: Option<f64>,
    /// Indices of the nodes for yes and no.
    #[serde(skip_serializing_if = "Option::is_none")]
    then: Option<[usize; 2]>,
    rooms: Counts,
}

impl DiskNode {
    fn of(node: &Node) -> Self {
        Self {
            feature: node.split.map(|split| Features::NAMES[split.feature].to_owned()),
            at_most: node.split.map(|split| split.at_most),
            then: node.split.map(|split| [split.yes, split.no]),
            rooms: node.counts,
        }
    }

    fn live(self) -> Option<Node> {
        let split = match (self.feature, self.at_most, self.then) {
            (None, None, None) => None,
            (Some(feature), Some(at_most), Some([yes, no])) => {
                Some(Split { feature: Features::index(&feature)?, at_most, yes, no })
            }
            _ => return None,
        };
        Some(Node { counts: self.rooms, split })
    }
}

/// The combined bounds of the answers, in feature order; 'no' means 'over'.
fn tightest(steps: &[Step]) -> Vec<Condition> {
    let mut conditions = Vec::new();
    for feature in 0..FEATURES {
        let answers = |yes: bool| {
            steps.iter().filter(move |step| step.feature == feature && step.yes == yes).map(|step| step.at_most)
        };
        if let Some(bound) = answers(false).reduce(f64::max) {
            conditions.push(Condition { feature, bound: Bound::Over(bound) });
        }
        if let Some(bound) = answers(true).reduce(f64::min) {
            conditions.push(Condition { feature, bound: Bound::AtMost(bound) });
        }
    }
    conditions
}

/// Numbers of rooms of each label, in the order of the labels.
pub type Counts = [u32; 5];

/// A trained tree.
#[derive(Clone, Debug, PartialEq)]
pub struct Tree {
    /// The root first; children come after their parent.
    nodes: Vec<Node>,
}

/// A node of a tree: a question, or a leaf.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Node {
    /// Training rooms that reach it.
    pub counts: Counts,
    /// The question; `None` for a leaf.
    pub split: Option<Split>,
}

/// The question of a node: is the feature at most the threshold?
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Split {
    /// Index of the feature.
    pub feature: usize,
    pub at_most: f64,
    /// Index of the node for rooms where it is.
    pub yes: usize,
    /// Index of the node for the others.
    pub no: usize,
}

impl Split {
    fn follow(&self, values: &Values) -> usize {
        if values[self.feature] <= self.at_most { self.yes } else { self.no }
    }
}

impl Tree {
    /// Learns a tree. Deterministic: uses no random numbers.
    pub fn train(table: &Table) -> Self {
        let mut nodes = Grower::new(table).grow();
        collapse(&mut nodes);
        let mut rows: Vec<u32> = (0..table.len() as u32).collect();
        prune(&mut nodes, 0, &mut rows, table);
        Self { nodes: compacted(&nodes) }
    }

    /// A tree from its nodes; `None` unless every path from the first ends in a leaf.
    pub fn from_nodes(nodes: Vec<Node>) -> Option<Self> {
        let fits = |(index, node): (usize, &Node)| {
            node.split.is_none_or(|split| {
                let behind = index + 1..nodes.len();
                split.feature < FEATURES
                    && split.at_most.is_finite()
                    && behind.contains(&split.yes)
                    && behind.contains(&split.no)
            })
        };
        let counts_fit =
            |node: &Node| node.counts.iter().map(|&count| u64::from(count)).sum::<u64>() <= u32::MAX.into();
        let sound = !nodes.is_empty() && nodes.iter().all(counts_fit) && nodes.iter().enumerate().all(fits);
        sound.then_some(Self { nodes })
    }

    /// All nodes, the root first, children after their parent.
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// The leaf's share of each label, with Laplace's correction.
    pub fn predict(&self, values: &Values) -> Distribution {
        let mut node = &self.nodes[0];
        while let Some(split) = &node.split {
            node = &self.nodes[split.follow(values)];
        }
        distribution(&node.counts)
    }

    /// The nodes a room passes through, from the root to its leaf.
    pub fn path(&self, values: &Values) -> Vec<&Node> {
        let mut node = &self.nodes[0];
        let mut path = vec![node];
        while let Some(split) = &node.split {
            node = &self.nodes[split.follow(values)];
            path.push(node);
        }
        path
    }
}

fn distribution(counts: &Counts) -> Distribution {
    // One for each label: Laplace's rule of succession.
    Distribution::smoothed(counts.map(f64::from), &Distribution::UNIFORM, 5.0)
}

fn total(counts: &Counts) -> u32 {
    counts.iter().sum()
}

/// Rooms that do not have the most frequent label.
fn errors(counts: &Counts) -> u32 {
    total(counts) - counts.iter().max().copied().unwrap_or_default()
}

/// A room in one feature's order.
#[derive(Clone, Copy)]
struct Entry {
    value: f64,
    row: u32,
    label: u8,
}

/// A node whose rooms are still to be split.
struct Open {
    node: usize,
    /// Its part of every column.
    from: usize,
    to: usize,
    depth: usize,
}

/// The best split on one feature.
struct Candidate {
    feature: usize,
    at_most: f64,
    /// In bits, minus the cost of choosing among thresholds.
    gain: f64,
    gain_ratio: f64,
}

struct Grower {
    /// For each feature the rooms sorted by its value. A node's rooms are contiguous, at the same range
    /// in every column.
    columns: Vec<Vec<Entry>>,
    /// n log2 n for every number of rooms.
    n_log_n: Vec<f64>,
    goes_left: Vec<bool>,
    scratch: Vec<Entry>,
}

impl Grower {
    fn new(table: &Table) -> Self {
        let columns = (0..FEATURES)
            .map(|feature| {
                let rows = table.values().iter().zip(table.labels()).enumerate();
                let mut column: Vec<Entry> = rows
                    .map(|(row, (values, label))| Entry {
                        value: values[feature],
                        row: row as u32,
                        label: label.index() as u8,
                    })
                    .collect();
                column.sort_unstable_by(|p, q| p.value.total_cmp(&q.value).then(p.row.cmp(&q.row)));
                column
            })
            .collect();
        let n_log_n = (0..=table.len()).map(|n| if n < 2 { 0.0 } else { n as f64 * (n as f64).log2() }).collect();
        Self { columns, n_log_n, goes_left: vec![false; table.len()], scratch: Vec::with_capacity(table.len()) }
    }

    fn grow(mut self) -> Vec<Node> {
        let count = |column: &[Entry]| {
            let mut counts = [0; 5];
            for entry in column {
                counts[usize::from(entry.label)] += 1;
            }
            counts
        };
        let rows = self.goes_left.len();
        let mut nodes = vec![Node { counts: count(&self.columns[0]), split: None }];
        let mut open = vec![Open { node: 0, from: 0, to: rows, depth: 0 }];
        while let Some(Open { node, from, to, depth }) = open.pop() {
            let Some(best) = self.best_split(from, to, &nodes[node].counts).filter(|_| depth < DEEPEST) else {
                continue;
            };
            let middle = self.partition(from, to, &best);
            let (yes, no) = (nodes.len(), nodes.len() + 1);
            nodes[node].split = Some(Split { feature: best.feature, at_most: best.at_most, yes, no });
            for (node, from, to) in [(yes, from, middle), (no, middle, to)] {
                nodes.push(Node { counts: count(&self.columns[0][from..to]), split: None });
                open.push(Open { node, from, to, depth: depth + 1 });
            }
        }
        nodes
    }

    /// The split with the best gain ratio among those whose gain is at least average (C4.5's guard
    /// against splits that cut off next to nothing).
    fn best_split(&self, from: usize, to: usize, counts: &Counts) -> Option<Candidate> {
        if ((to - from) as f64) < 2.0 * LEAST_ROOMS || errors(counts) == 0 {
            return None;
        }
        let candidates: Vec<Candidate> =
            (0..FEATURES).filter_map(|feature| self.best_threshold(feature, from, to, counts)).collect();
        let average = candidates.iter().map(|candidate| candidate.gain).sum::<f64>() / candidates.len() as f64;
        let mut best: Option<Candidate> = None;
        for candidate in candidates {
            // C4.5 itself compares to a thousandth of a bit.
            if candidate.gain >= average - 1e-3
                && candidate.gain_ratio > best.as_ref().map_or(0.0, |best| best.gain_ratio)
            {
                best = Some(candidate);
            }
        }
        best
    }

    fn best_threshold(&self, feature: usize, from: usize, to: usize, counts: &Counts) -> Option<Candidate> {
        let column = &self.columns[feature][from..to];
        let rooms = column.len();
        // C4.5: a tenth of an even share of the node's rooms, within 2..=25.
        let least = (0.1 * rooms as f64 / 5.0).clamp(LEAST_ROOMS, 25.0).ceil() as usize;
        if rooms < 2 * least || column[0].value == column[rooms - 1].value {
            return None;
        }
        let n_log_n = &self.n_log_n;
        let disorder = |counts: &Counts, total: usize| {
            n_log_n[total] - counts.iter().map(|&count| n_log_n[count as usize]).sum::<f64>()
        };
        let before = disorder(counts, rooms);
        let mut left: Counts = [0; 5];
        let mut right = *counts;
        let (mut thresholds, mut best_after, mut best_at) = (0u32, f64::INFINITY, 0);
        for at in 1..rooms {
            let label = usize::from(column[at - 1].label);
            left[label] += 1;
            right[label] -= 1;
            if column[at - 1].value == column[at].value || at < least || rooms - at < least {
                continue;
            }
            thresholds += 1;
            let after = disorder(&left, at) + disorder(&right, rooms - at);
            if after < best_after {
                (best_after, best_at) = (after, at);
            }
        }
        if thresholds == 0 {
            return None;
        }
        // Quinlan (1996): choosing among thresholds costs log2 of their number.
        let gain = (before - best_after - f64::from(thresholds).log2()) / rooms as f64;
        if gain <= 0.0 {
            return None;
        }
        let split_bits = (n_log_n[rooms] - n_log_n[best_at] - n_log_n[rooms - best_at]) / rooms as f64;
        let at_most = readable_between(column[best_at - 1].value, column[best_at].value);
        Some(Candidate { feature, at_most, gain, gain_ratio: gain / split_bits })
    }

    /// Moves the rooms of a node that answer yes before the others in every column, keeping order.
    fn partition(&mut self, from: usize, to: usize, split: &Candidate) -> usize {
        let mut middle = from;
        for entry in &self.columns[split.feature][from..to] {
            let left = entry.value <= split.at_most;
            self.goes_left[entry.row as usize] = left;
            middle += usize::from(left);
        }
        for (feature, column) in self.columns.iter_mut().enumerate() {
            if feature == split.feature {
                continue;
            }
            self.scratch.clear();
            let mut kept = from;
            for at in from..to {
                let entry = column[at];
                if self.goes_left[entry.row as usize] {
                    column[kept] = entry;
                    kept += 1;
                } else {
                    self.scratch.push(entry);
                }
            }
            column[kept..to].copy_from_slice(&self.scratch);
        }
        middle
    }
}

/// Removes splits that do not reduce the number of training errors.
fn collapse(nodes: &mut [Node]) {
    // Children come after their parent: going backwards, a node's subtree is already done.
    let mut subtree_errors: Vec<u32> = nodes.iter().map(|node| errors(&node.counts)).collect();
    for index in (0..nodes.len()).rev() {
        if let Some(split) = nodes[index].split {
            let below = subtree_errors[split.yes] + subtree_errors[split.no];
            if below >= subtree_errors[index] {
                nodes[index].split = None;
            } else {
                subtree_errors[index] = below;
            }
        }
    }
}

/// Expected errors of a leaf on unseen rooms: its own plus those added by the upper end of the confidence
/// interval (C4.5, with the binomial's normal approximation).
fn expected_errors(counts: &Counts) -> f64 {
    let (n, e) = (f64::from(total(counts)), f64::from(errors(counts)));
    if n == 0.0 {
        return 0.0;
    }
    e + added_errors(n, e)
}

fn added_errors(n: f64, e: f64) -> f64 {
    if e == 0.0 {
        // The binomial solved exactly: (1 - p)^n = confidence.
        return n * (1.0 - CONFIDENCE.powf(1.0 / n));
    }
    if e + 0.5 >= n {
        return (n - e).max(0.0);
    }
    let z = DEVIATIONS;
    let f = (e + 0.5) / n;
    let upper = (f + z * z / (2.0 * n) + z * (f / n - f * f / n + z * z / (4.0 * n * n)).sqrt()) / (1.0 + z * z / n);
    upper * n - e
}

/// How many more errors a simpler tree may be expected to make and still be preferred, in rooms (C4.5).
const SLACK: f64 = 0.1;

/// Prunes the subtree at `index`, which `rows` reach: replaces it by a leaf, or by its larger branch, if
/// that is not expected to make more errors.
fn prune(nodes: &mut [Node], index: usize, rows: &mut [u32], table: &Table) {
    // Raising a branch prunes it again with more rooms; the subtree shrinks each time.
    while let Some(split) = nodes[index].split {
        let (yes_rows, no_rows) = parted(rows, &split, table);
        let larger = if yes_rows.len() >= no_rows.len() { split.yes } else { split.no };
        prune(nodes, split.yes, yes_rows, table);
        prune(nodes, split.no, no_rows, table);

        let as_leaf = expected_errors(&nodes[index].counts);
        let as_is = expected_errors_below(nodes, index);
        let as_branch = expected_errors_with(nodes, larger, rows, table);
        if as_leaf <= as_is + SLACK && as_leaf <= as_branch + SLACK {
            nodes[index].split = None;
        } else if as_branch <= as_is + SLACK {
            nodes[index].split = nodes[larger].split;
            recount(nodes, index, rows, table);
        } else {
            return;
        }
    }
}

/// Moves the rows that answer yes before the others, and returns both parts.
fn parted<'a>(rows: &'a mut [u32], split: &Split, table: &Table) -> (&'a mut [u32], &'a mut [u32]) {
    let mut middle = 0;
    for at in 0..rows.len() {
        if table.values()[rows[at] as usize][split.feature] <= split.at_most {
            rows.swap(at, middle);
            middle += 1;
        }
    }
    rows.split_at_mut(middle)
}

fn expected_errors_below(nodes: &[Node], index: usize) -> f64 {
    match nodes[index].split {
        Some(split) => expected_errors_below(nodes, split.yes) + expected_errors_below(nodes, split.no),
        None => expected_errors(&nodes[index].counts),
    }
}

/// Expected errors of the subtree at `index` if `rows` reached it.
fn expected_errors_with(nodes: &[Node], index: usize, rows: &mut [u32], table: &Table) -> f64 {
    match nodes[index].split {
        Some(split) => {
            let (yes, no) = parted(rows, &split, table);
            expected_errors_with(nodes, split.yes, yes, table) + expected_errors_with(nodes, split.no, no, table)
        }
        None => expected_errors(&counts_of(rows, table)),
    }
}

fn counts_of(rows: &[u32], table: &Table) -> Counts {
    let mut counts = [0; 5];
    for &row in rows {
        counts[table.labels()[row as usize].index()] += 1;
    }
    counts
}

/// Recounts the rooms of the subtree at `index`. A split that no longer separates them is removed.
fn recount(nodes: &mut [Node], index: usize, rows: &mut [u32], table: &Table) {
    nodes[index].counts = counts_of(rows, table);
    while let Some(split) = nodes[index].split {
        let (yes, no) = parted(rows, &split, table);
        match (yes.is_empty(), no.is_empty()) {
            (true, true) => nodes[index].split = None,
            (true, false) => nodes[index].split = nodes[split.no].split,
            (false, true) => nodes[index].split = nodes[split.yes].split,
            (false, false) => {
                recount(nodes, split.yes, yes, table);
                recount(nodes, split.no, no, table);
                return;
            }
        }
    }
}

/// The reachable nodes, in reading order: each node, all of its yes side, then its no side.
fn compacted(nodes: &[Node]) -> Vec<Node> {
    let mut kept: Vec<Node> = Vec::new();
    // The parent's reference to this node: its index and whether it is the `yes` child.
    let mut open: Vec<(usize, Option<(usize, bool)>)> = vec![(0, None)];
    while let Some((index, referrer)) = open.pop() {
        let place = kept.len();
        if let Some((parent, as_yes)) = referrer
            && let Some(split) = &mut kept[parent].split
        {
            *(if as_yes { &mut split.yes } else { &mut split.no }) = place;
        }
        kept.push(nodes[index]);
        if let Some(split) = nodes[index].split {
            open.push((split.no, Some((place, false))));
            open.push((split.yes, Some((place, true))));
        }
    }
    kept
}
