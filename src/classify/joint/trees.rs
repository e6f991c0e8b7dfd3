//! A forest of extremely randomised trees (Geurts, Ernst and Wehenkel 2006): every tree sees all samples,
//! each of its questions is the best of a few drawn at random, and the trees' answers are averaged. With
//! a few hundred rooms and many features this overfits less than choosing the best of all questions.

use std::sync::OnceLock;

pub(super) use super::asked::{Node, Tree};

use super::asked::Asked;
use super::rows::Rows;
use crate::base::random::{Random, seed_of_part};
use crate::base::work::{Cancelled, Work};
use crate::classify::Distribution;
use crate::labels::Label;

/// Trees per forest: a common number, at which the mean answer has converged.
pub(super) const TREES: usize = 100;

/// Trees that a trained classifier keeps of each forest, the first ones: the mean of seventy differs little from that of a
/// hundred, and all bundled models together stay below 6 MB.
pub(super) const KEPT: usize = 70;

/// Fewest samples in a leaf.
const LEAST_IN_LEAF: usize = 3;

/// Questions tried at a node, as a share of the features.
const TRIED: f64 = 0.4;

/// Classes that are told apart at most.
pub(super) const MOST_CLASSES: usize = 64;

/// Maximum depth: growing a tree recurses, and contrived data could make it deep.
const MOST_DEPTH: usize = 60;

/// Samples to learn from, by column.
#[derive(Clone, Debug, Default)]
pub(super) struct Samples {
    /// For each feature the value of each sample, finite.
    pub columns: Vec<Vec<f32>>,
    pub labels: Vec<Label>,
    /// What questions are to tell apart: a finer class within the label, such as the function; below [`MOST_CLASSES`].
    pub classes: Vec<u16>,
    /// The plan of each sample, and which version of it: 0 as drawn. Empty if there is but one version.
    pub versions: Vec<(usize, usize)>,
}

impl Samples {
    pub fn push(&mut self, values: &[f32], label: Label, class: u16) {
        if self.columns.is_empty() {
            self.columns = vec![Vec::new(); values.len()];
        }
        for (column, &value) in self.columns.iter_mut().zip(values) {
            column.push(value);
        }
        self.labels.push(label);
        self.classes.push(class.min(MOST_CLASSES as u16 - 1));
    }

    fn counts(&self, rows: &[u32]) -> [u32; 5] {
        let mut counts = [0; 5];
        for &row in rows {
            counts[self.labels[row as usize].index()] += 1;
        }
        counts
    }

    fn classes_of(&self, rows: &[u32]) -> [u32; MOST_CLASSES] {
        let mut counts = [0; MOST_CLASSES];
        for &row in rows {
            counts[usize::from(self.classes[row as usize])] += 1;
        }
        counts
    }
}

#[derive(Clone, Debug, Default)]
pub(super) struct Forest {
    trees: Vec<Tree>,
    /// The same to be asked; laid out when first needed.
    asked: OnceLock<Asked>,
}

impl PartialEq for Forest {
    fn eq(&self, other: &Self) -> bool {
        self.trees == other.trees
    }
}

/// A forest to grow, from these samples with this seed. `rows` must not be empty.
pub(super) struct Job<'a> {
    pub samples: &'a Samples,
    pub rows: Vec<u32>,
    pub choice: VersionChoice,
    pub seed: u64,
}

/// Which versions of plans a tree learns from: one of each plan.
#[derive(Clone, Copy, Debug)]
pub(super) struct VersionChoice {
    /// Versions of each plan, besides the one as drawn.
    pub copies: usize,
    /// Probability of the version as drawn.
    pub as_drawn: f64,
}

impl Job<'_> {
    /// What a tree learns from.
    fn rows_of(&self, seed: u64) -> Vec<u32> {
        if self.choice.copies == 0 || self.samples.versions.is_empty() {
            return self.rows.clone();
        }
        let plans = self.samples.versions.iter().map(|(plan, _)| plan + 1).max().unwrap_or_default();
        // Not the numbers that draw the questions.
        let mut random = Random::new(seed_of_part(seed, usize::MAX));
        let mut chosen = |_| match random.unit() < self.choice.as_drawn {
            true => 0,
            false => 1 + random.below(self.choice.copies),
        };
        let chosen: Vec<usize> = (0..plans).map(&mut chosen).collect();
        let is_chosen = |row: &&u32| {
            let (plan, version) = self.samples.versions[**row as usize];
            chosen[plan] == version
        };
        let rows: Vec<u32> = self.rows.iter().filter(is_chosen).copied().collect();
        if rows.is_empty() { self.rows.clone() } else { rows }
    }
}

/// Grows the forests of all jobs, tree by tree on all threads.
pub(super) fn grow(jobs: &[Job<'_>], work: &Work<'_>) -> Result<Vec<Forest>, Cancelled> {
    let mut trees = work
        .map(jobs.len() * TREES, |part| {
            let job = &jobs[part / TREES];
            let seed = seed_of_part(job.seed, part % TREES);
            Tree::grow(job.samples, job.rows_of(seed), seed)
        })?
        .into_iter();
    Ok(jobs.iter().map(|_| Forest::new(trees.by_ref().take(TREES).collect())).collect())
}

impl Forest {
    pub fn new(trees: Vec<Tree>) -> Self {
        Self { trees, asked: OnceLock::new() }
    }

    pub fn trees(&self) -> &[Tree] {
        &self.trees
    }

    /// The first trees only.
    pub fn shortened(self, trees: usize) -> Self {
        Self::new(self.trees.into_iter().take(trees).collect())
    }

    /// The forest laid out to be asked.
    pub fn asked(&self) -> &Asked {
        self.asked.get_or_init(|| Asked::new(&self.trees))
    }

    /// The mean of the trees' answers.
    pub fn predict(&self, values: &[f32]) -> Distribution {
        self.asked().predict(values)
    }

    /// The same for each row.
    pub fn predict_all(&self, rows: &Rows) -> Vec<Distribution> {
        self.asked().predict_all(rows)
    }
}

impl Tree {
    fn grow(samples: &Samples, mut rows: Vec<u32>, seed: u64) -> Self {
        let mut grower = Grower {
            samples,
            random: Random::new(seed),
            features: (0..samples.columns.len()).collect(),
            nodes: Vec::new(),
        };
        grower.grow(&mut rows, 0);
        Self { nodes: grower.nodes }
    }
}

struct Grower<'a> {
    samples: &'a Samples,
    random: Random,
    /// All features; those at the front were drawn for the current node.
    features: Vec<usize>,
    nodes: Vec<Node>,
}

impl Grower<'_> {
    fn grow(&mut self, rows: &mut [u32], depth: usize) {
        let counts = self.samples.counts(rows);
        // Rooms of one label need no further question, whatever their functions.
        let is_pure = counts.iter().filter(|&&count| count > 0).count() < 2;
        let splits = !is_pure && rows.len() >= 2 * LEAST_IN_LEAF && depth < MOST_DEPTH;
        let Some((feature, at_most)) = splits.then(|| self.question(rows)).flatten() else {
            self.nodes.push(Node::Leaf(counts));
            return;
        };
        let column = &self.samples.columns[feature];
        let mut yes = 0;
        for index in 0..rows.len() {
            if column[rows[index] as usize] <= at_most {
                rows.swap(yes, index);
                yes += 1;
            }
        }
        let (left, right) = rows.split_at_mut(yes);
        let place = self.nodes.len();
        self.nodes.push(Node::Leaf(counts));
        self.grow(left, depth + 1);
        self.nodes[place] = Node::Question { feature, at_most, no: self.nodes.len() };
        self.grow(right, depth + 1);
    }

    /// The question that separates labels best: one random threshold is tried on each of some features.
    fn question(&mut self, rows: &[u32]) -> Option<(usize, f32)> {
        let counts = self.samples.classes_of(rows);
        let wanted = (TRIED * self.features.len() as f64).ceil() as usize;
        let mut tried = 0;
        let mut best: Option<(f64, usize, f32)> = None;
        for drawn in 0..self.features.len() {
            if tried == wanted {
                break;
            }
            let other = drawn + self.random.below(self.features.len() - drawn);
            self.features.swap(drawn, other);
            let feature = self.features[drawn];
            let column = &self.samples.columns[feature];
            let values = rows.iter().map(|&row| column[row as usize]);
            let (low, high) =
                values.fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
            if low >= high {
                continue;
            }
            tried += 1;
            let at_most = short(low + (high - low) * self.random.unit() as f32);
            let mut yes = [0u32; MOST_CLASSES];
            for &row in rows {
                if column[row as usize] <= at_most {
                    yes[usize::from(self.samples.classes[row as usize])] += 1;
                }
            }
            let no: [u32; MOST_CLASSES] = std::array::from_fn(|class| counts[class] - yes[class]);
            let least = LEAST_IN_LEAF as u32;
            if yes.iter().sum::<u32>() < least || no.iter().sum::<u32>() < least {
                continue;
            }
            let quality = purity(yes) + purity(no);
            if best.is_none_or(|(best, ..)| quality > best) {
                best = Some((quality, feature, at_most));
            }
        }
        best.map(|(_, feature, at_most)| (feature, at_most))
    }
}

/// A threshold rounded to four significant digits, which is plenty: shorter in the file.
fn short(number: f32) -> f32 {
    if number == 0.0 {
        return 0.0;
    }
    let unit = 10f64.powi(3 - f64::from(number.abs()).log10().floor() as i32);
    ((f64::from(number) * unit).round() / unit) as f32
}

/// The size of a group less its Gini impurity: the sum of squares of its counts over its size.
fn purity(counts: [u32; MOST_CLASSES]) -> f64 {
    let all: f64 = counts.iter().map(|&count| f64::from(count)).sum();
    counts.iter().map(|&count| f64::from(count).powi(2)).sum::<f64>() / all
}

#[cfg(test)]
mod tests {
    use super::*;

    const AS_DRAWN: VersionChoice = VersionChoice { copies: 0, as_drawn: 1.0 };

    /// Two labels separated by the first of two features.
    fn samples() -> Samples {
        let mut samples = Samples::default();
        let mut random = Random::new(3);
        for index in 0..60 {
            let label = if index % 3 == 0 { Label::Corridor } else { Label::SmallRoom };
            let value = if index % 3 == 0 { 2.0 } else { 0.0 } + random.unit() as f32;
            samples.push(&[value, random.unit() as f32], label, label.index() as u16);
        }
        samples
    }

    #[test]
    fn a_forest_learns_and_does_not_depend_on_threads() {
        let samples = samples();
        let jobs = || [Job { samples: &samples, rows: (0..60).collect(), choice: AS_DRAWN, seed: 5 }];
        let one = grow(&jobs(), &Work::quiet().on_threads(1)).unwrap();
        assert_eq!(one, grow(&jobs(), &Work::quiet().on_threads(3)).unwrap());
        assert_eq!(one[0].predict(&[2.5, 0.5]).label(), Label::Corridor);
        assert_eq!(one[0].predict(&[0.5, 0.5]).label(), Label::SmallRoom);
    }

    #[test]
    fn what_cannot_be_told_apart_is_one_leaf() {
        let mut samples = Samples::default();
        for label in [Label::Hall, Label::Hall, Label::Hall, Label::BigRoom].repeat(5) {
            samples.push(&[1.0], label, label.index() as u16);
        }
        let job = Job { samples: &samples, rows: (0..20).collect(), choice: AS_DRAWN, seed: 0 };
        let forest = grow(&[job], &Work::quiet()).unwrap().pop().unwrap();
        assert!(forest.trees().iter().all(|tree| tree.nodes == [Node::Leaf([0, 0, 5, 0, 15])]));
        assert!((forest.predict(&[1.0]).probability(Label::Hall) - 0.75).abs() < 1e-12);
    }
}
