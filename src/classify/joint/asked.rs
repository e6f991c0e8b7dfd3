//! A forest laid out to be asked about many rooms, again and again.
//!
//! Its nodes lie one after the other, and rooms are asked about tree by tree and several at once, so that a tree is fetched
//! once for many rooms, and the processor has something to do while it waits for a node.
//! What was said of a room is kept with how far each of its features may go before a question on the way is answered
//! otherwise: as long as none goes further, the answer is the same to the last bit, and nothing is asked.

use std::sync::Arc;

use super::rows::Rows;
use crate::base::work::Work;
use crate::classify::Distribution;

/// A node of a tree; the children of a question come after it.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Node {
    /// Is the feature at most this? Yes leads to the next node, no to the one with the index `no`.
    Question { feature: usize, at_most: f32, no: usize },
    /// How many samples of each label ended here.
    Leaf([u32; 5]),
}

#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tree {
    pub nodes: Vec<Node>,
}

/// The nodes of all trees of a forest.
#[derive(Clone, Debug, Default)]
pub(super) struct Asked {
    /// Where each tree begins among the nodes, and where the last one ends.
    starts: Vec<usize>,
    steps: Vec<Step>,
    /// For each node that is a leaf its place among the leaves.
    leaf_at: Vec<u32>,
    /// For each leaf the share of each label.
    leaves: Vec<[f64; 5]>,
}

/// A question. A leaf is one to which every number is the answer yes, and that leads to itself.
#[derive(Clone, Copy, Debug)]
struct Step {
    at_most: f32,
    /// The feature in the highest eight bits, in the others the node after yes, counted from the root; after no it is the next.
    to: u32,
}

const FEATURE_AT: u32 = 24;

/// More nodes than this are in no tree.
pub(super) const MOST_NODES: usize = 1 << FEATURE_AT;

/// Rooms whose ways through a tree are gone side by side: the processor need not wait for one before it turns to the next.
const LANES: usize = 8;

/// Rooms asked about together, a multiple of [`LANES`]: they stay in the processor's nearest memory.
const TOGETHER: usize = 64;

/// What a forest said of a room, and for which features it still says so.
#[derive(Debug)]
pub(super) struct Held {
    bounds: Bounds,
    pub said: Distribution,
}

/// How far each feature may go before a question on the way is answered otherwise: itself at most the first number, and its
/// negative below the second. All first numbers come before the second ones.
type Bounds = Box<[f32]>;

impl Held {
    fn holds(&self, values: &[f32]) -> bool {
        let (high, low) = self.bounds.split_at(self.bounds.len() / 2);
        // Without a branch for each feature, so that several are compared at once.
        let bounds = high.iter().zip(low);
        values.len() == high.len()
            && values.iter().zip(bounds).fold(true, |all, (value, (high, low))| all & (value <= high) & (-value < *low))
    }
}

/// The features of some rooms, [`LANES`] rooms after each other and of these feature by feature.
struct Lanes {
    values: Vec<f32>,
    /// Numbers of one group of rooms.
    size: usize,
}

impl Lanes {
    fn new() -> Self {
        Self { values: Vec::new(), size: 0 }
    }

    /// Lanes that are left over are zero.
    fn fill<'a>(&mut self, width: usize, rows: impl ExactSizeIterator<Item = &'a [f32]>) {
        self.size = width * LANES;
        self.values.clear();
        self.values.resize(self.size * rows.len().div_ceil(LANES), 0.0);
        for (room, row) in rows.enumerate() {
            let group = &mut self.values[room / LANES * self.size..];
            for (slot, value) in group.iter_mut().skip(room % LANES).step_by(LANES).zip(row) {
                *slot = *value;
            }
        }
    }
}

impl Asked {
    pub fn new(trees: &[Tree]) -> Self {
        let mut asked = Self { starts: vec![0], ..Self::default() };
        let mut waiting: Vec<(usize, usize)> = Vec::new();
        for tree in trees {
            let root = asked.steps.len();
            let add = |asked: &mut Self| {
                asked.steps.push(Step { at_most: 0.0, to: 0 });
                asked.leaf_at.push(0);
            };
            add(&mut asked);
            waiting.push((0, root));
            while let Some((node, place)) = waiting.pop() {
                let (at_most, feature, to) = match tree.nodes[node] {
                    Node::Question { feature, at_most, no } => {
                        let yes = asked.steps.len();
                        add(&mut asked);
                        add(&mut asked);
                        waiting.extend([(no, yes + 1), (node + 1, yes)]);
                        (at_most, feature, yes)
                    }
                    Node::Leaf(counts) => {
                        let counts = counts.map(f64::from);
                        let all: f64 = counts.iter().sum();
                        asked.leaf_at[place] = asked.leaves.len() as u32;
                        asked.leaves.push(counts.map(|count| count / all));
                        (f32::INFINITY, 0, place)
                    }
                };
                asked.steps[place] = Step { at_most, to: (feature as u32) << FEATURE_AT | (to - root) as u32 };
            }
            asked.starts.push(asked.steps.len());
        }
        asked
    }

    fn trees(&self) -> impl Iterator<Item = (&[Step], &[u32])> {
        self.starts.windows(2).map(|pair| (&self.steps[pair[0]..pair[1]], &self.leaf_at[pair[0]..pair[1]]))
    }

    /// Asks about at most [`TOGETHER`] rooms, tree by tree: the sums of the shares of each label. `hear` is told each question on
    /// the way of a room: its place in `lanes` as the index of a number there, the question's number, and whether the feature is
    /// above it. What it is told at a leaf has no meaning: nothing is above that number.
    #[inline]
    fn sums(&self, lanes: &Lanes, mut hear: impl FnMut(usize, f32, bool)) -> [[f64; 5]; TOGETHER] {
        let mut sums = [[0.0; 5]; TOGETHER];
        for (steps, leaf_at) in self.trees() {
            let groups = lanes.values.chunks_exact(lanes.size).zip(sums.chunks_exact_mut(LANES));
            for (group, (values, sums)) in groups.enumerate() {
                let mut at = [0_u32; LANES];
                loop {
                    let mut moved = 0;
                    for (lane, at) in at.iter_mut().enumerate() {
                        let Step { at_most, to } = steps[*at as usize];
                        let place = (to >> FEATURE_AT) as usize * LANES + lane;
                        let is_above = values[place] > at_most;
                        hear(group * lanes.size + place, at_most, is_above);
                        // No branch: half of all guesses would be wrong.
                        let next = (to & (MOST_NODES as u32 - 1)) + u32::from(is_above);
                        moved |= next ^ *at;
                        *at = next;
                    }
                    if moved == 0 {
                        break;
                    }
                }
                for (sums, at) in sums.iter_mut().zip(at) {
                    let shares = &self.leaves[leaf_at[at as usize] as usize];
                    sums.iter_mut().zip(shares).for_each(|(sum, share)| *sum += share);
                }
            }
        }
        sums
    }

    /// The mean of the trees' answers.
    pub fn predict(&self, values: &[f32]) -> Distribution {
        let mut sums = [0.0; 5];
        for (steps, leaf_at) in self.trees() {
            let mut at = 0;
            loop {
                let Step { at_most, to } = steps[at as usize];
                let is_above = values[(to >> FEATURE_AT) as usize] > at_most;
                let next = (to & (MOST_NODES as u32 - 1)) + u32::from(is_above);
                if next == at {
                    break;
                }
                at = next;
            }
            let shares = &self.leaves[leaf_at[at as usize] as usize];
            sums.iter_mut().zip(shares).for_each(|(sum, share)| *sum += share);
        }
        Distribution::from_weights(sums)
    }

    /// The mean of the trees' answers for each room.
    pub fn predict_all(&self, rows: &Rows) -> Vec<Distribution> {
        let said = in_parts(rows.len().div_ceil(TOGETHER), |part| {
            let together = part * TOGETHER..((part + 1) * TOGETHER).min(rows.len());
            let count = together.len();
            let mut lanes = Lanes::new();
            lanes.fill(rows.width(), together.map(|room| rows.of(room)));
            let sums = self.sums(&lanes, |_, _, _| ());
            sums.into_iter().take(count).map(Distribution::from_weights).collect::<Vec<_>>()
        });
        said.concat()
    }

    /// The same for rooms that were asked about before, with another result of which `finish` makes what is said: `before`
    /// tells what was said of each then, if it was.
    pub fn predict_held<'a>(
        &self,
        rows: &Rows,
        before: impl Fn(usize) -> Option<&'a Arc<Held>>,
        finish: impl Fn(Distribution) -> Distribution,
    ) -> Vec<Arc<Held>> {
        let mut missing: Vec<usize> = Vec::new();
        let mut held: Vec<Option<Arc<Held>>> = Vec::with_capacity(rows.len());
        for (room, values) in rows.iter().enumerate() {
            let kept = before(room).filter(|held| held.holds(values)).cloned();
            if kept.is_none() {
                missing.push(room);
            }
            held.push(kept);
        }
        let chunks: Vec<&[usize]> = missing.chunks(TOGETHER).collect();
        let asked = in_parts(chunks.len(), |part| self.hold(rows, chunks[part]));
        for (&room, (bounds, said)) in missing.iter().zip(asked.into_iter().flatten()) {
            held[room] = Some(Arc::new(Held { bounds, said: finish(said) }));
        }
        held.into_iter().flatten().collect()
    }

    /// What is said of at most [`TOGETHER`] rooms, and how long.
    fn hold(&self, rows: &Rows, rooms: &[usize]) -> Vec<(Bounds, Distribution)> {
        let mut lanes = Lanes::new();
        lanes.fill(rows.width(), rooms.iter().map(|&room| rows.of(room)));
        // For each number the lowest that it was not above, and the negative of the highest that it was.
        let mut bounds: [Vec<f32>; 2] = std::array::from_fn(|_| vec![f32::INFINITY; lanes.values.len()]);
        let sums = self.sums(&lanes, |place, at_most, is_above| {
            let bound = &mut bounds[usize::from(is_above)][place];
            // The negative, if it is above.
            let number = f32::from_bits(at_most.to_bits() ^ (u32::from(is_above) << 31));
            *bound = if number < *bound { number } else { *bound };
        });
        let of_room = |room: usize| {
            let of = |bounds: &'_ Vec<f32>| {
                let from = room / LANES * lanes.size + room % LANES;
                (0..rows.width()).map(|feature| bounds[from + feature * LANES]).collect::<Vec<f32>>()
            };
            bounds.iter().flat_map(of).collect()
        };
        let rooms = 0..rooms.len();
        rooms.zip(sums).map(|(room, sums)| (of_room(room), Distribution::from_weights(sums))).collect()
    }
}

/// The results of so many parts, in order; worked out on all threads where that is worth starting them.
fn in_parts<T: Send>(parts: usize, part: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let work = if parts < WORTH_THREADS { Work::quiet().on_threads(1) } else { Work::quiet() };
    // Nobody cancels it.
    work.map(parts, part).unwrap_or_default()
}

/// Parts of [`TOGETHER`] rooms, of which each takes a tenth of a millisecond.
const WORTH_THREADS: usize = 4;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::random::Random;

    /// A tree that asks about `features` features in turn, down to leaves of random counts.
    fn tree(features: usize, depth: usize, random: &mut Random) -> Tree {
        fn grow(nodes: &mut Vec<Node>, features: usize, depth: usize, random: &mut Random) {
            if depth == 0 {
                nodes.push(Node::Leaf(std::array::from_fn(|_| 1 + random.below(9) as u32)));
                return;
            }
            let place = nodes.len();
            nodes.push(Node::Leaf([1; 5]));
            grow(nodes, features, depth - 1, random);
            let no = nodes.len();
            let at_most = random.unit() as f32;
            nodes[place] = Node::Question { feature: random.below(features), at_most, no };
            grow(nodes, features, depth - 1, random);
        }
        let mut nodes = Vec::new();
        grow(&mut nodes, features, depth, random);
        Tree { nodes }
    }

    /// What the trees say, gone through one by one.
    fn by_walking(trees: &[Tree], values: &[f32]) -> Distribution {
        let mut sums = [0.0; 5];
        for tree in trees {
            let mut at = 0;
            let counts = loop {
                match &tree.nodes[at] {
                    Node::Leaf(counts) => break counts.map(f64::from),
                    Node::Question { feature, at_most, no } => {
                        at = if values[*feature] <= *at_most { at + 1 } else { *no };
                    }
                }
            };
            let all: f64 = counts.iter().sum();
            sums.iter_mut().zip(counts).for_each(|(sum, count)| *sum += count / all);
        }
        Distribution::from_weights(sums)
    }

    #[test]
    fn what_is_held_is_what_would_be_said() {
        let mut random = Random::new(11);
        let trees: Vec<Tree> = (0..20).map(|_| tree(6, 5, &mut random)).collect();
        let asked = Asked::new(&trees);
        let mut rooms = Rows::with_capacity(6, 70);
        (0..70).for_each(|_| rooms.push((0..6).map(|_| random.unit() as f32)));
        let mut held = asked.predict_held(&rooms, |_| None, |said| said);
        let mut kept = 0;
        for _ in 0..50 {
            for room in rooms.iter_mut() {
                room[random.below(6)] += 0.02 * (random.unit() as f32 - 0.5);
            }
            let after = asked.predict_held(&rooms, |room| held.get(room), |said| said);
            kept += after.iter().zip(&held).filter(|(after, before)| Arc::ptr_eq(after, before)).count();
            for ((room, held), said) in rooms.iter().zip(&after).zip(asked.predict_all(&rooms)) {
                assert_eq!((held.said, said), (asked.predict(room), by_walking(&trees, room)));
            }
            held = after;
        }
        assert!((300..3400).contains(&kept), "{kept} of 3500 answers held");
    }
}
