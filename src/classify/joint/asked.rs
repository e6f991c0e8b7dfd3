//! A forest laid out to be asked about many rooms, again and again.
//!
//! Its nodes lie one after the other, and rooms are asked about tree by tree and all at once: each node sorts the rooms that come
//! to it by their answers. So a question is fetched once for many rooms, and nothing waits for the answer of one.
//! What was said of a room is kept with how far each of its features may go before a question on the way is answered
//! otherwise: as long as none goes further, the answer is the same to the last bit, and nothing is asked.

use std::collections::BTreeMap;
use std::ops::Range;
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
    /// For each node that is a leaf the place of its shares.
    leaf_at: Vec<u32>,
    /// The shares of the labels that leaves have, without repeats.
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

/// More rooms than this are not asked about together: what is known of them stays in the processor's second memory.
const MOST_TOGETHER: usize = 4096;

/// Fewer are not worth another thread: to ask about them takes a fraction of a millisecond.
const WORTH_A_THREAD: usize = 64;

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

/// The features of some rooms, feature by feature.
struct Columns {
    values: Vec<f32>,
    rooms: usize,
}

impl Columns {
    fn new<'a>(width: usize, rows: impl ExactSizeIterator<Item = &'a [f32]>) -> Self {
        let rooms = rows.len();
        let mut values = vec![0.0; width * rooms];
        for (room, row) in rows.enumerate() {
            for (column, &value) in values.chunks_exact_mut(rooms).zip(row) {
                column[room] = value;
            }
        }
        Self { values, rooms }
    }

    fn of(&self, feature: usize) -> &[f32] {
        &self.values[feature * self.rooms..(feature + 1) * self.rooms]
    }

    /// Lowers the numbers of some rooms to a number.
    fn lower(&mut self, feature: usize, rooms: &[u32], number: f32) {
        let column = &mut self.values[feature * self.rooms..(feature + 1) * self.rooms];
        for &room in rooms {
            let bound = &mut column[room as usize];
            *bound = if number < *bound { number } else { *bound };
        }
    }
}

/// How far each feature of some rooms may go, like [`Bounds`], but feature by feature.
struct BoundColumns {
    high: Columns,
    low: Columns,
}

impl BoundColumns {
    fn new(width: usize, rooms: usize) -> Self {
        let nothing = || Columns { values: vec![f32::INFINITY; width * rooms], rooms };
        Self { high: nothing(), low: nothing() }
    }

    fn of(&self, room: usize) -> Bounds {
        let of =
            |columns: &Columns| columns.values.iter().skip(room).step_by(columns.rooms).copied().collect::<Vec<_>>();
        [of(&self.high), of(&self.low)].concat().into_boxed_slice()
    }
}

/// Rooms that came to the same node: their range in one of two lists.
struct Come {
    node: usize,
    rooms: Range<usize>,
    list: usize,
}

impl Asked {
    pub fn new(trees: &[Tree]) -> Self {
        let mut asked = Self { starts: vec![0], ..Self::default() };
        let mut waiting: Vec<(usize, usize)> = Vec::new();
        // Many leaves hold the same counts; few of them stay in the processor's nearest memory.
        let mut leaf_of: BTreeMap<[u32; 5], u32> = BTreeMap::new();
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
                        let leaves = &mut asked.leaves;
                        asked.leaf_at[place] = *leaf_of.entry(counts).or_insert_with(|| {
                            let counts = counts.map(f64::from);
                            let all: f64 = counts.iter().sum();
                            leaves.push(counts.map(|count| count / all));
                            leaves.len() as u32 - 1
                        });
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

    /// Asks about rooms, tree by tree and node by node: the sums of the shares of each label. All rooms that come to a node are
    /// asked its question one after the other, and told apart by the answer. With `bounds`, these are lowered by each question
    /// that a room was asked.
    fn sums(&self, columns: &Columns, mut bounds: Option<&mut BoundColumns>) -> Vec<[f64; 5]> {
        let mut sums = vec![[0.0; 5]; columns.rooms];
        // What one list holds of the rooms at a node, the other takes up in the order of the answers.
        let mut lists = [vec![0_u32; columns.rooms], vec![0_u32; columns.rooms]];
        let mut waiting: Vec<Come> = Vec::new();
        for (steps, leaf_at) in self.trees() {
            lists[0].iter_mut().zip(0..).for_each(|(slot, room)| *slot = room);
            waiting.push(Come { node: 0, rooms: 0..columns.rooms, list: 0 });
            while let Some(Come { node, rooms, list }) = waiting.pop() {
                let [one, other] = &mut lists;
                let (from, into) = if list == 0 { (one, other) } else { (other, one) };
                let Step { at_most, to } = steps[node];
                let yes = to as usize & (MOST_NODES - 1);
                if yes == node {
                    let shares = &self.leaves[leaf_at[node] as usize];
                    for &room in &from[rooms] {
                        sums[room as usize].iter_mut().zip(shares).for_each(|(sum, share)| *sum += share);
                    }
                    continue;
                }
                let feature = (to >> FEATURE_AT) as usize;
                let (from, into) = (&from[rooms.clone()], &mut into[rooms.clone()]);
                let below = tell_apart(columns.of(feature), at_most, from, into);
                if let Some(bounds) = &mut bounds {
                    bounds.high.lower(feature, &into[..below], at_most);
                    bounds.low.lower(feature, &into[below..], -at_most);
                }
                let middle = rooms.start + below;
                for (node, rooms) in [(yes + 1, middle..rooms.end), (yes, rooms.start..middle)] {
                    if !rooms.is_empty() {
                        waiting.push(Come { node, rooms, list: 1 - list });
                    }
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
        let said = in_parts(rows.len(), |rooms| {
            let columns = Columns::new(rows.width(), rooms.map(|room| rows.of(room)));
            self.sums(&columns, None).into_iter().map(Distribution::from_weights).collect::<Vec<_>>()
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
        let asked = in_parts(missing.len(), |rooms| self.hold(rows, &missing[rooms]));
        for (&room, (bounds, said)) in missing.iter().zip(asked.into_iter().flatten()) {
            held[room] = Some(Arc::new(Held { bounds, said: finish(said) }));
        }
        held.into_iter().flatten().collect()
    }

    /// What is said of rooms, and how long.
    fn hold(&self, rows: &Rows, rooms: &[usize]) -> Vec<(Bounds, Distribution)> {
        let columns = Columns::new(rows.width(), rooms.iter().map(|&room| rows.of(room)));
        let mut bounds = BoundColumns::new(rows.width(), rooms.len());
        let sums = self.sums(&columns, Some(&mut bounds));
        sums.into_iter().enumerate().map(|(room, sums)| (bounds.of(room), Distribution::from_weights(sums))).collect()
    }
}

/// Sorts rooms by whether their number is at most this one: those first, whose number is returned.
fn tell_apart(column: &[f32], at_most: f32, rooms: &[u32], into: &mut [u32]) -> usize {
    let (mut below, last) = (0, rooms.len() - 1);
    for (place, &room) in rooms.iter().enumerate() {
        // Written to both ends, of which one is written again: no branch, since half of all guesses would be wrong.
        into[below] = room;
        into[last - (place - below)] = room;
        let is_above = column[room as usize] > at_most;
        below += usize::from(!is_above);
    }
    below
}

/// The results for ranges of so many rooms, in order; worked out on all threads where that is worth starting them.
fn in_parts<T: Send>(rooms: usize, part: impl Fn(Range<usize>) -> T + Sync) -> Vec<T> {
    if rooms == 0 {
        return Vec::new();
    }
    let work = Work::quiet();
    let threads = work.threads().min(rooms / WORTH_A_THREAD).max(1);
    let parts = rooms.div_ceil(MOST_TOGETHER).next_multiple_of(threads);
    let of_each = rooms.div_ceil(parts);
    let of_part = |part: usize| part * of_each..((part + 1) * of_each).min(rooms);
    // Nobody cancels it.
    work.on_threads(threads).map(rooms.div_ceil(of_each), |at| part(of_part(at))).unwrap_or_default()
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
