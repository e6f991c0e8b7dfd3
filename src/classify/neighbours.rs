//! Nearest-neighbour search: a k-d tree (Bentley 1975; search with incremental distances after Arya and
//! Mount 1993).

use crate::dataset::table::FEATURES;

/// A standardised room.
pub(super) type Point = [f32; FEATURES];

/// The distance between two rooms.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Metric {
    Euclidean,
    /// The sum of the differences: a single odd feature counts for less.
    Manhattan,
}

impl Metric {
    pub const ALL: [Self; 2] = [Self::Euclidean, Self::Manhattan];

    /// Its name in files and in the interface.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Euclidean => "euclidean",
            Self::Manhattan => "manhattan",
        }
    }

    /// The metric with this [`Metric::name`].
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|metric| metric.name() == name)
    }

    /// The contribution of one feature to the sum that is compared.
    fn part(self, difference: f32) -> f32 {
        match self {
            Self::Euclidean => difference * difference,
            Self::Manhattan => difference.abs(),
        }
    }

    /// The distance from the sum over all features.
    fn distance(self, sum: f32) -> f32 {
        match self {
            Self::Euclidean => sum.sqrt(),
            Self::Manhattan => sum,
        }
    }
}

/// The most points in a leaf: for fewer, testing all is faster than descending.
const LEAF: usize = 16;

/// Points in a k-d tree, so that the nearest are found without testing all.
#[derive(Clone, Debug)]
pub(super) struct KdTree {
    /// In the tree's order.
    points: Vec<Point>,
    /// The input index of each.
    origins: Vec<u32>,
    nodes: Vec<Node>,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    /// The bounding box of its points.
    low: Point,
    high: Point,
    /// Its points in the tree's order.
    from: u32,
    to: u32,
    /// The second child; the first comes right after its parent. 0 for a leaf.
    second: u32,
}

/// A point found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Found {
    pub distance: f32,
    /// Its index among the points given.
    pub index: u32,
}

impl KdTree {
    pub fn new(points: &[Point]) -> Self {
        let mut order: Vec<u32> = (0..points.len() as u32).collect();
        let mut nodes = Vec::new();
        divide(points, &mut order, 0, &mut nodes);
        Self { points: order.iter().map(|&index| points[index as usize]).collect(), origins: order, nodes }
    }

    /// The `k` nearest points, nearest first, or fewer if there are not that many. Skips the point at
    /// index `without`. Which of several equally distant points are returned depends only on the tree.
    pub fn nearest(&self, query: &Point, k: usize, metric: Metric, without: Option<u32>, found: &mut Vec<Found>) {
        found.clear();
        if k == 0 || self.nodes.is_empty() {
            return;
        }
        let mut search = Search { tree: self, query, k, without, found };
        // Within each arm the compiler knows the metric.
        match metric {
            Metric::Euclidean => search.visit(0, |difference| Metric::Euclidean.part(difference)),
            Metric::Manhattan => search.visit(0, |difference| Metric::Manhattan.part(difference)),
        }
        for found in found {
            found.distance = metric.distance(found.distance);
        }
    }
}

/// Appends the subtree of the points that begin at `from` in the tree's order.
fn divide(points: &[Point], order: &mut [u32], from: u32, nodes: &mut Vec<Node>) {
    let (mut low, mut high) = ([f32::INFINITY; FEATURES], [f32::NEG_INFINITY; FEATURES]);
    for &index in &*order {
        let point = &points[index as usize];
        low = std::array::from_fn(|axis| low[axis].min(point[axis]));
        high = std::array::from_fn(|axis| high[axis].max(point[axis]));
    }
    let place = nodes.len();
    nodes.push(Node { low, high, from, to: from + order.len() as u32, second: 0 });
    let extent = |axis: usize| high[axis] - low[axis];
    let axis = (1..FEATURES).fold(0, |best, axis| if extent(axis) > extent(best) { axis } else { best });
    // Identical points cannot be separated, however many.
    if order.len() <= LEAF || extent(axis) <= 0.0 {
        return;
    }
    let middle = order.len() / 2;
    let value = |index: u32| points[index as usize][axis];
    order.select_nth_unstable_by(middle, |&p, &q| value(p).total_cmp(&value(q)).then(p.cmp(&q)));
    let (first, second) = order.split_at_mut(middle);
    divide(points, first, from, nodes);
    nodes[place].second = nodes.len() as u32;
    divide(points, second, from + middle as u32, nodes);
}

/// A sum over the features, four at a time: one vector register.
fn sum_of_parts(part: impl Fn(usize) -> f32) -> f32 {
    let four: [f32; FEATURES / 2] = std::array::from_fn(|i| part(i) + part(i + FEATURES / 2));
    (four[0] + four[1]) + (four[2] + four[3])
}

/// The larger of two numbers. Unlike `f32::max` it does not check for NaN, and takes one instruction for
/// four.
fn larger(p: f32, q: f32) -> f32 {
    if p > q { p } else { q }
}

struct Search<'a> {
    tree: &'a KdTree,
    query: &'a Point,
    k: usize,
    without: Option<u32>,
    found: &'a mut Vec<Found>,
}

impl Search<'_> {
    /// Visits a node whose box is near enough.
    fn visit<F: Fn(f32) -> f32 + Copy>(&mut self, index: usize, part: F) {
        let tree = self.tree;
        let node = &tree.nodes[index];
        if node.second == 0 {
            for index in node.from as usize..node.to as usize {
                let point = &tree.points[index];
                let sum = sum_of_parts(|axis| part(point[axis] - self.query[axis]));
                if sum < self.worst_wanted() {
                    self.offer(Found { distance: sum, index: tree.origins[index] });
                }
            }
            return;
        }
        let (first, second) = (index + 1, node.second as usize);
        let (to_first, to_second) = (self.to_box(first, part), self.to_box(second, part));
        let order = if to_first <= to_second {
            [(to_first, first), (to_second, second)]
        } else {
            [(to_second, second), (to_first, first)]
        };
        for (nearest, child) in order {
            if nearest < self.worst_wanted() {
                self.visit(child, part);
            }
        }
    }

    /// The distance to the nearest point of a node's box.
    fn to_box<F: Fn(f32) -> f32>(&self, index: usize, part: F) -> f32 {
        let node = &self.tree.nodes[index];
        sum_of_parts(|axis| {
            let value = self.query[axis];
            part(larger(larger(node.low[axis] - value, value - node.high[axis]), 0.0))
        })
    }

    /// Points at least this far are of no interest.
    fn worst_wanted(&self) -> f32 {
        if self.found.len() < self.k { f32::INFINITY } else { self.found[self.k - 1].distance }
    }

    fn offer(&mut self, candidate: Found) {
        if self.without == Some(candidate.index) {
            return;
        }
        if self.found.len() < self.k {
            self.found.push(candidate);
        }
        // From the end: for so short a list this is faster than searching and moving.
        let mut place = self.found.len() - 1;
        while place > 0 && self.found[place - 1].distance > candidate.distance {
            self.found[place] = self.found[place - 1];
            place -= 1;
        }
        self.found[place] = candidate;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::random::Random;

    fn cloud(points: usize, seed: u64) -> Vec<Point> {
        let mut random = Random::new(seed);
        // Coarse values make ties and duplicates common, as with counts of openings.
        (0..points)
            .map(|_| std::array::from_fn(|axis| if axis < 2 { random.unit() as f32 } else { random.below(3) as f32 }))
            .collect()
    }

    #[test]
    fn finds_what_looking_at_all_finds() {
        let points = cloud(700, 1);
        let tree = KdTree::new(&points);
        let mut found = Vec::new();
        for metric in Metric::ALL {
            for (without, query) in cloud(200, 2).into_iter().enumerate() {
                let without = without as u32;
                tree.nearest(&query, 9, metric, Some(without), &mut found);
                let mut all: Vec<f32> = points
                    .iter()
                    .enumerate()
                    .filter(|&(index, _)| index as u32 != without)
                    .map(|(_, point)| metric.distance(sum_of_parts(|axis| metric.part(point[axis] - query[axis]))))
                    .collect();
                all.sort_by(f32::total_cmp);
                let distances: Vec<f32> = found.iter().map(|found| found.distance).collect();
                assert_eq!(distances, all[..9]);
                assert!(found.iter().all(|found| found.index != without));
            }
        }
    }

    #[test]
    fn a_heap_of_equal_points_is_no_trouble() {
        let tree = KdTree::new(&vec![[1.0; FEATURES]; 5000]);
        let mut found = Vec::new();
        tree.nearest(&[0.0; FEATURES], 3, Metric::Manhattan, None, &mut found);
        assert_eq!(found.iter().map(|found| found.distance).collect::<Vec<_>>(), [8.0; 3]);
        tree.nearest(&[0.0; FEATURES], 9000, Metric::Euclidean, None, &mut found);
        assert_eq!(found.len(), 5000);
        KdTree::new(&[]).nearest(&[0.0; FEATURES], 3, Metric::Euclidean, None, &mut found);
        assert!(found.is_empty());
    }
}
