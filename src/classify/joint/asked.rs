//! A forest laid out to be asked about many rooms, again and again.
//!
//! Its nodes lie one after the other, and rooms are asked about tree by tree, so that a tree is fetched once for many rooms.
//! What was said of a room is kept with how far each of its features may go before a question on the way is answered
//! otherwise: as long as none goes further, the answer is the same to the last bit, and nothing is asked.

use std::sync::Arc;

use super::trees::{Node, Tree};
use crate::classify::Distribution;

/// The nodes of all trees of a forest.
#[derive(Clone, Debug, Default)]
pub(super) struct Asked {
    roots: Vec<u32>,
    nodes: Vec<Step>,
    /// For each leaf the share of each label.
    leaves: Vec<[f64; 5]>,
}

/// A question, or a leaf.
#[derive(Clone, Copy, Debug)]
struct Step {
    at_most: f32,
    /// [`LEAF`] for a leaf.
    feature: u32,
    /// The node after no; the place among the leaves.
    no: u32,
}

const LEAF: u32 = u32::MAX;

/// Rooms asked about together: what is kept of them while they are stays in the processor's nearest memory.
const TOGETHER: usize = 32;

/// Each feature is above the first number and at most the second as long as all questions on the way are answered alike.
type Bounds = (Box<[f32]>, Box<[f32]>);

/// What a forest said of a room, and for which features it still says so.
#[derive(Debug)]
pub(super) struct Held {
    /// Each feature is above this...
    low: Box<[f32]>,
    /// ...and at most this.
    high: Box<[f32]>,
    pub said: Distribution,
}

impl Held {
    fn holds(&self, values: &[f32]) -> bool {
        // Without a branch for each feature, so that several are compared at once.
        let bounds = self.low.iter().zip(&self.high);
        values.len() == self.low.len()
            && values.iter().zip(bounds).fold(true, |all, (value, (low, high))| all & (low < value) & (value <= high))
    }
}

impl Asked {
    pub fn new(trees: &[Tree]) -> Self {
        let mut asked = Self::default();
        for tree in trees {
            let root = asked.nodes.len() as u32;
            asked.roots.push(root);
            for node in &tree.nodes {
                let step = match *node {
                    Node::Question { feature, at_most, no } => {
                        Step { at_most, feature: feature as u32, no: root + no as u32 }
                    }
                    Node::Leaf(counts) => {
                        let counts = counts.map(f64::from);
                        let all: f64 = counts.iter().sum();
                        asked.leaves.push(counts.map(|count| count / all));
                        Step { at_most: 0.0, feature: LEAF, no: asked.leaves.len() as u32 - 1 }
                    }
                };
                asked.nodes.push(step);
            }
        }
        asked
    }

    /// The leaf of a tree; `hear` is told each question on the way: the feature, the number, and whether it is at most that.
    fn leaf(&self, root: u32, values: &[f32], mut hear: impl FnMut(usize, f32, bool)) -> &[f64; 5] {
        let mut at = root as usize;
        loop {
            let Step { at_most, feature, no } = self.nodes[at];
            if feature == LEAF {
                return &self.leaves[no as usize];
            }
            let is_at_most = values[feature as usize] <= at_most;
            hear(feature as usize, at_most, is_at_most);
            at = if is_at_most { at + 1 } else { no as usize };
        }
    }

    /// The mean of the trees' answers.
    pub fn predict(&self, values: &[f32]) -> Distribution {
        let mut sums = [0.0; 5];
        for &root in &self.roots {
            let shares = self.leaf(root, values, |_, _, _| ());
            sums.iter_mut().zip(shares).for_each(|(sum, share)| *sum += share);
        }
        Distribution::from_weights(sums)
    }

    /// The same for rooms that were asked about before, with another result of which `finish` makes what is said: `before`
    /// holds what was said of each then, if it was.
    pub fn predict_held(
        &self,
        rooms: &[Vec<f32>],
        before: &[Option<&Arc<Held>>],
        finish: impl Fn(Distribution) -> Distribution,
    ) -> Vec<Arc<Held>> {
        let mut held: Vec<Option<Arc<Held>>> = rooms
            .iter()
            .enumerate()
            .map(|(room, values)| before.get(room).copied().flatten().filter(|held| held.holds(values)).cloned())
            .collect();
        let missing: Vec<usize> = (0..rooms.len()).filter(|&room| held[room].is_none()).collect();
        for together in missing.chunks(TOGETHER) {
            let mut bounds: Vec<Bounds> = together
                .iter()
                .map(|&room| {
                    let width = rooms[room].len();
                    (vec![f32::NEG_INFINITY; width].into(), vec![f32::INFINITY; width].into())
                })
                .collect();
            let mut sums = [[0.0; 5]; TOGETHER];
            for &root in &self.roots {
                for ((&room, (low, high)), sums) in together.iter().zip(&mut bounds).zip(&mut sums) {
                    let hear = |feature: usize, at_most: f32, is_at_most: bool| {
                        if is_at_most {
                            high[feature] = high[feature].min(at_most);
                        } else {
                            low[feature] = low[feature].max(at_most);
                        }
                    };
                    let shares = self.leaf(root, &rooms[room], hear);
                    sums.iter_mut().zip(shares).for_each(|(sum, share)| *sum += share);
                }
            }
            for ((&room, (low, high)), sums) in together.iter().zip(bounds).zip(sums) {
                held[room] = Some(Arc::new(Held { low, high, said: finish(Distribution::from_weights(sums)) }));
            }
        }
        held.into_iter().flatten().collect()
    }
}

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

    #[test]
    fn what_is_held_is_what_would_be_said() {
        let mut random = Random::new(11);
        let trees: Vec<Tree> = (0..20).map(|_| tree(6, 5, &mut random)).collect();
        let asked = Asked::new(&trees);
        let mut rooms: Vec<Vec<f32>> = (0..70).map(|_| (0..6).map(|_| random.unit() as f32).collect()).collect();
        let mut held = asked.predict_held(&rooms, &[], |said| said);
        let mut kept = 0;
        for _ in 0..50 {
            for room in &mut rooms {
                room[random.below(6)] += 0.02 * (random.unit() as f32 - 0.5);
            }
            let before: Vec<Option<&Arc<Held>>> = held.iter().map(Some).collect();
            let after = asked.predict_held(&rooms, &before, |said| said);
            kept += after.iter().zip(&held).filter(|(after, before)| Arc::ptr_eq(after, before)).count();
            for (room, held) in rooms.iter().zip(&after) {
                assert_eq!(held.said, asked.predict(room));
            }
            held = after;
        }
        assert!((300..3400).contains(&kept), "{kept} of 3500 answers held");
    }
}
