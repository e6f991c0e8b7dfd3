//! Where each room lies among the others: how near it is to them, and how many shortest paths pass through it.
//!
//! Buildings fall apart at many rooms: without its corridor every classroom stands alone. So the graph is cut at such rooms into
//! blocks (Hopcroft and Tarjan 1973: no block falls apart without one of its rooms), each block is searched from each of its
//! rooms, and what hangs at a room counts there. That finds what a search of the whole graph from every room finds, in time
//! that grows with the squares of the blocks instead of the square of the plan.

use crate::base::lists::Lists;

/// In a block of up to this many rooms all are searched from; in a larger one so many, evenly spaced: time stays proportional
/// to the plan.
const MOST_SEARCHES: usize = 1000;

/// Where a room lies in the graph.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Place {
    /// Share of the shortest paths between other rooms that pass through it (Freeman 1977), 0..=1.
    pub betweenness: f64,
    /// One over the mean number of steps to the reachable rooms; 0 if there is none.
    pub closeness: f64,
    /// Steps to the farthest reachable room.
    pub farthest: f64,
    /// Share of all rooms that are reachable, itself included.
    pub reach: f64,
}

const NONE: u32 = u32::MAX;

/// The blocks of a graph, each after those that hang below it.
struct Blocks {
    /// The rooms of each block, ascending.
    rooms: Lists,
    /// For each block the room that it hangs from.
    tops: Vec<u32>,
    /// For each room the block in which it is not the top; [`NONE`] for the room that a part of the plan was searched from.
    home: Vec<u32>,
    /// For each block the room that its part of the plan was searched from.
    roots: Vec<u32>,
}

impl Blocks {
    fn new(joined: &Lists) -> Self {
        let count = joined.len();
        let mut blocks = Self { rooms: Lists::default(), tops: Vec::new(), home: vec![NONE; count], roots: Vec::new() };
        // In the order of a search in depth, from 1, and the earliest room that can be reached from what comes below.
        let (mut turn, mut earliest) = (vec![0_u32; count], vec![0_u32; count]);
        let mut turns = 0;
        // The way from the root: the room, and how many of those it joins were looked at.
        let mut way: Vec<(u32, u32)> = Vec::new();
        let mut waiting: Vec<u32> = Vec::new();
        let mut block: Vec<u32> = Vec::new();
        for root in 0..count as u32 {
            if turn[root as usize] > 0 {
                continue;
            }
            way.push((root, 0));
            turns += 1;
            (turn[root as usize], earliest[root as usize]) = (turns, turns);
            while let Some(&(room, looked)) = way.last() {
                let at = room as usize;
                if let Some(&other) = joined.of(at).get(looked as usize) {
                    if let Some(last) = way.last_mut() {
                        last.1 += 1;
                    }
                    let other_turn = turn[other as usize];
                    if other_turn == 0 {
                        turns += 1;
                        (turn[other as usize], earliest[other as usize]) = (turns, turns);
                        waiting.push(other);
                        way.push((other, 0));
                    } else {
                        // The room it was reached from does no harm here: its turn decides nothing below.
                        earliest[at] = earliest[at].min(other_turn);
                    }
                    continue;
                }
                way.pop();
                let Some(&(top, _)) = way.last() else { continue };
                earliest[top as usize] = earliest[top as usize].min(earliest[at]);
                if earliest[at] < turn[top as usize] {
                    continue;
                }
                let number = blocks.tops.len() as u32;
                block.clear();
                block.push(top);
                while let Some(below) = waiting.pop() {
                    block.push(below);
                    blocks.home[below as usize] = number;
                    if below == room {
                        break;
                    }
                }
                block.sort_unstable();
                blocks.rooms.push(block.iter().copied());
                blocks.tops.push(top);
                blocks.roots.push(root);
            }
        }
        blocks
    }
}

/// What hangs at a room: on the far side, seen from a block.
#[derive(Clone, Copy, Default)]
struct Hanging {
    /// Rooms, the room itself included.
    rooms: u64,
    /// The sum of the steps to them.
    steps: u64,
    /// Steps to the farthest.
    farthest: u64,
}

/// Steps to the farthest room in each of the two blocks where that is farthest.
#[derive(Clone, Copy)]
struct Farthest([(u64, u32); 2]);

impl Farthest {
    fn add(&mut self, steps: u64, block: u32) {
        if steps > self.0[0].0 {
            self.0 = [(steps, block), self.0[0]];
        } else if steps > self.0[1].0 {
            self.0[1] = (steps, block);
        }
    }

    const fn without(&self, block: u32) -> u64 {
        if self.0[0].1 == block { self.0[1].0 } else { self.0[0].0 }
    }
}

/// A block laid out to be searched, with what hangs at its rooms.
#[derive(Default)]
struct Search {
    joined: Lists,
    hanging: Vec<Hanging>,
    /// Of the last search: steps to each room, numbers of shortest paths, and the share of the paths on from it.
    steps: Vec<u32>,
    ways: Vec<f64>,
    onward: Vec<f64>,
    order: Vec<u32>,
}

impl Search {
    fn lay_out(&mut self, block: usize, blocks: &Blocks, joined: &Lists, place_in: &mut [u32]) {
        let rooms = blocks.rooms.of(block);
        for (place, &room) in rooms.iter().enumerate() {
            place_in[room as usize] = place as u32;
        }
        let top = blocks.tops[block];
        self.joined.clear();
        for &room in rooms {
            let within = joined.of(room as usize).iter().filter(|&&other| {
                // Two rooms that are joined are in one block only.
                blocks.home[other as usize] == block as u32 || (other == top && room != top)
            });
            self.joined.push(within.map(|&other| place_in[other as usize]));
        }
        self.steps.clear();
        self.steps.resize(rooms.len(), NONE);
        self.ways.clear();
        self.ways.resize(rooms.len(), 0.0);
        self.onward.clear();
        self.onward.resize(rooms.len(), 0.0);
        self.order.clear();
    }

    /// Searches in breadth.
    fn from(&mut self, start: usize) {
        for &room in &self.order {
            (self.steps[room as usize], self.ways[room as usize], self.onward[room as usize]) = (NONE, 0.0, 0.0);
        }
        self.order.clear();
        self.order.push(start as u32);
        (self.steps[start], self.ways[start]) = (0, 1.0);
        let mut at = 0;
        while let Some(&room) = self.order.get(at) {
            at += 1;
            let (next, ways_here) = (self.steps[room as usize] + 1, self.ways[room as usize]);
            for &other in self.joined.of(room as usize) {
                let other_at = other as usize;
                if self.steps[other_at] == NONE {
                    self.steps[other_at] = next;
                    self.order.push(other);
                }
                if self.steps[other_at] == next {
                    self.ways[other_at] += ways_here;
                }
            }
        }
    }

    /// The sum of the steps to all that hangs at the other rooms, and the most.
    fn beyond(&self, start: usize) -> (u64, u64) {
        let mut beyond = (0, 0);
        for &room in self.order.iter().filter(|&&room| room as usize != start) {
            let (steps, hanging) = (u64::from(self.steps[room as usize]), self.hanging[room as usize]);
            beyond.0 += steps * hanging.rooms + hanging.steps;
            beyond.1 = beyond.1.max(steps + hanging.farthest);
        }
        beyond
    }

    /// Adds to `betweenness` the shares of the paths from the start to all that hangs at other rooms that pass through each room
    /// (Brandes 2001), `times` over.
    fn pass(&mut self, start: usize, times: f64, mut add: impl FnMut(usize, f64)) {
        for &room in self.order.iter().rev() {
            let at = room as usize;
            if at == start {
                continue;
            }
            let before = self.steps[at] - 1;
            let each = (self.hanging[at].rooms as f64 + self.onward[at]) / self.ways[at];
            for &other in self.joined.of(at) {
                let other = other as usize;
                if self.steps[other] == before {
                    self.onward[other] += self.ways[other] * each;
                }
            }
            add(at, times * self.onward[at]);
        }
    }
}

/// The place of each room, `joined` being the rooms it is joined with: each in the other's list, none in its own.
pub(super) fn places(joined: &Lists) -> Vec<Place> {
    let count = joined.len();
    let blocks = Blocks::new(joined);
    let numbers = 0..blocks.tops.len();
    let mut place_in = vec![0_u32; count];
    let mut search = Search::default();

    // From below: what hangs below each room, and for each block what is below its top.
    let mut below = vec![Hanging { rooms: 1, ..Hanging::default() }; count];
    let mut farthest = vec![Farthest([(0, NONE); 2]); count];
    let mut of_blocks: Vec<Hanging> = Vec::with_capacity(numbers.len());
    // The sum of the squares of how many rooms are on each side of a room.
    let mut squares = vec![0.0; count];
    for block in numbers.clone() {
        let rooms = blocks.rooms.of(block);
        let top = blocks.tops[block] as usize;
        search.hanging.clear();
        search.hanging.extend(rooms.iter().map(|&room| below[room as usize]));
        for (hanging, &room) in search.hanging.iter_mut().zip(rooms) {
            hanging.farthest = farthest[room as usize].0[0].0;
        }
        let hanging: u64 = rooms.iter().map(|&room| below[room as usize].rooms).sum();
        let hanging = hanging - below[top].rooms;
        let (steps, most) = match *rooms {
            [one, other] => {
                let end = if one as usize == top { other } else { one } as usize;
                (below[end].rooms + below[end].steps, 1 + farthest[end].0[0].0)
            }
            _ => {
                search.lay_out(block, &blocks, joined, &mut place_in);
                search.from(place_in[top] as usize);
                search.beyond(place_in[top] as usize)
            }
        };
        below[top].rooms += hanging;
        below[top].steps += steps;
        farthest[top].add(most, block as u32);
        squares[top] += (hanging as f64).powi(2);
        of_blocks.push(Hanging { rooms: hanging, steps, farthest: most });
    }

    // From above: what hangs at the top of each block is known before the block.
    let mut steps: Vec<u64> = below.iter().map(|below| below.steps).collect();
    let mut all: Vec<u64> = below.iter().map(|below| below.rooms).collect();
    let mut betweenness = vec![0.0; count];
    for block in numbers.rev() {
        let rooms = blocks.rooms.of(block);
        let (top, root) = (blocks.tops[block] as usize, blocks.roots[block] as usize);
        let number = block as u32;
        let above = Hanging {
            rooms: below[root].rooms - of_blocks[block].rooms,
            steps: steps[top] - of_blocks[block].steps,
            farthest: farthest[top].without(number),
        };
        if let [one, other] = *rooms {
            let end = if one as usize == top { other } else { one } as usize;
            all[end] = below[root].rooms;
            steps[end] += above.rooms + above.steps;
            farthest[end].add(1 + above.farthest, number);
            continue;
        }
        search.hanging.clear();
        search.hanging.extend(rooms.iter().map(|&room| match room as usize == top {
            true => above,
            false => Hanging { farthest: farthest[room as usize].0[0].0, ..below[room as usize] },
        }));
        search.lay_out(block, &blocks, joined, &mut place_in);
        let stride = rooms.len().div_ceil(MOST_SEARCHES);
        for start in (0..rooms.len()).step_by(stride) {
            search.from(start);
            let (to_all, most) = search.beyond(start);
            // A search stands for the rooms up to the next one.
            let stands_for = start..(start + stride).min(rooms.len());
            let times: u64 = search.hanging[stands_for.clone()].iter().map(|hanging| hanging.rooms).sum();
            search.pass(start, times as f64, |place, shares| betweenness[rooms[place] as usize] += shares);
            for &room in rooms[stands_for].iter().filter(|&&room| room as usize != top) {
                let room = room as usize;
                all[room] = below[root].rooms;
                steps[room] += to_all;
                farthest[room].add(most, number);
            }
        }
    }
    let place = |room: usize| {
        let (reached, others) = (all[room] as f64, (all[room] - 1) as f64);
        // Pairs of rooms on different sides of the room: all ways between them pass through it.
        let above = (all[room] - below[room].rooms) as f64;
        let apart = others.powi(2) - squares[room] - above.powi(2);
        Place {
            betweenness: (betweenness[room] + apart) / (others * (others - 1.0)).max(1.0),
            closeness: if steps[room] > 0 { others / steps[room] as f64 } else { 0.0 },
            farthest: farthest[room].0[0].0 as f64,
            reach: reached / count as f64,
        }
    };
    (0..count).map(place).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::random::Random;

    /// The same by searching the whole graph from every room.
    fn by_searching(joined: &Lists) -> Vec<Place> {
        let joined: Vec<Vec<usize>> =
            joined.iter().map(|of_room| of_room.iter().map(|&other| other as usize).collect()).collect();
        let count = joined.len();
        let mut places = vec![Place::default(); count];
        for start in 0..count {
            let mut steps = vec![usize::MAX; count];
            let mut ways = vec![0.0; count];
            (steps[start], ways[start]) = (0, 1.0);
            let mut order = vec![start];
            let mut at = 0;
            while at < order.len() {
                let room = order[at];
                at += 1;
                for &other in &joined[room] {
                    if steps[other] == usize::MAX {
                        steps[other] = steps[room] + 1;
                        order.push(other);
                    }
                    if steps[other] == steps[room] + 1 {
                        ways[other] += ways[room];
                    }
                }
            }
            let reached = order.len() as f64;
            let sum: usize = order.iter().map(|&room| steps[room]).sum();
            let place = &mut places[start];
            place.closeness = if sum > 0 { (reached - 1.0) / sum as f64 } else { 0.0 };
            place.farthest = order.last().map_or(0.0, |&room| steps[room] as f64);
            place.reach = reached / count as f64;
            let mut onward = vec![0.0; count];
            for &room in order.iter().skip(1).rev() {
                for &other in joined[room].iter().filter(|&&other| steps[other] + 1 == steps[room]) {
                    onward[other] += ways[other] / ways[room] * (1.0 + onward[room]);
                }
                places[room].betweenness += onward[room] / ((reached - 1.0) * (reached - 2.0)).max(1.0);
            }
        }
        places
    }

    fn joined(rooms: usize, doors: &[(usize, usize)]) -> Lists {
        let mut joined = vec![Vec::new(); rooms];
        for &(one, other) in doors.iter().filter(|(one, other)| one != other) {
            joined[one].push(other as u32);
            joined[other].push(one as u32);
        }
        let mut lists = Lists::default();
        joined.into_iter().for_each(|of_room| lists.push_distinct(of_room));
        lists
    }

    #[test]
    fn the_places_are_those_that_searching_from_every_room_finds() {
        let mut random = Random::new(3);
        for turn in 0..400 {
            let rooms = 1 + random.below(24);
            // From few doors, so that the plan falls into parts, to many.
            let doors = random.below(3 * rooms);
            let doors: Vec<(usize, usize)> = (0..doors).map(|_| (random.below(rooms), random.below(rooms))).collect();
            let joined = joined(rooms, &doors);
            for (room, (found, wanted)) in places(&joined).iter().zip(by_searching(&joined)).enumerate() {
                assert!((found.betweenness - wanted.betweenness).abs() < 1e-12, "{turn} {room}: {found:?} {wanted:?}");
                let exact = |place: Place| Place { betweenness: 0.0, ..place };
                assert_eq!(exact(*found), exact(wanted), "{turn} {room}: {joined:?}");
            }
        }
    }

    #[test]
    fn a_large_block_is_searched_from_some_rooms() {
        // A grid of 50 by 60 rooms with a corridor of ten rooms hanging at one corner.
        let mut doors = Vec::new();
        for (x, y) in (0..50).flat_map(|x| (0..60).map(move |y| (x, y))) {
            let room = 60 * x + y;
            if x > 0 {
                doors.push((room, room - 60));
            }
            if y > 0 {
                doors.push((room, room - 1));
            }
        }
        doors.extend((0..10).map(|step| (2999 + step, 3000 + step)));
        let joined = joined(3010, &doors);
        let (found, wanted) = (places(&joined), by_searching(&joined));
        for (found, wanted) in found.iter().zip(wanted) {
            assert!((found.closeness - wanted.closeness).abs() < 0.08 * wanted.closeness, "{found:?} {wanted:?}");
            assert!((found.farthest - wanted.farthest).abs() <= 4.0, "{found:?} {wanted:?}");
            assert!((found.betweenness - wanted.betweenness).abs() < 0.02, "{found:?} {wanted:?}");
        }
        assert_eq!(found[0].reach, 1.0);
    }
}
