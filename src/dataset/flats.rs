//! A storey of flats, cut at the flats' entrance doors. Classifiers compare the rooms of a dwelling with each other; the twenty
//! rooms of three flats and their stairs are no dwelling, nor are they an office.

use std::sync::OnceLock;

use super::network::{Flats, RoomNetwork};

/// Fewest rooms of a flat, and most.
const LEAST_ROOMS: usize = 4;
const MOST_ROOMS: usize = 12;

/// A part of the plan with at most this many rooms is not divided further.
const WHOLE: usize = 10;

/// A flat's area in m².
const AREA_M2: std::ops::RangeInclusive<f64> = 25.0..=200.0;

/// Larger plans are not looked at: the time grows with the square of the rooms.
const MOST_OF_STOREY: usize = 150;

/// Share of the storey's rooms that must lie in flats: the rooms off an office's corridor do not.
const LEAST_SHARE: f64 = 0.75;

/// A larger room at a landing that leads nowhere else is neither a lift nor a cupboard for meters.
const SINGLE_M2: f64 = 8.0;

impl Flats {
    /// The flats of a storey; `None` for a plan that is not one.
    ///
    /// Parts of the plan that no door joins are divided at their landings: a landing is the room without which a part falls
    /// apart most evenly. What is left is a storey of flats if each has the rooms and the area of a dwelling, and if together
    /// they hold three quarters of the rooms, and if each has one entrance at most. In a school or an office most rooms end at a
    /// corridor, so that without it single rooms are left; at a landing there are more flats than those.
    fn of(network: &RoomNetwork) -> Option<Self> {
        let rooms = network.rooms.len();
        if !(2 * LEAST_ROOMS..=MOST_OF_STOREY).contains(&rooms) {
            return None;
        }
        let joined: Vec<Vec<usize>> = network.joined();
        let all: Vec<usize> = (0..rooms).collect();
        let mut waiting = large_parts(&joined, &all, None);
        let mut flats: Vec<Vec<usize>> = Vec::new();
        while let Some(part) = waiting.pop() {
            match (part.len() > WHOLE).then(|| at_landing(&joined, &part)).flatten() {
                Some(parts) => waiting.extend(parts),
                None => flats.push(part),
            }
        }
        flats.sort();
        let is_flat = |flat: &Vec<usize>| {
            let area_m2: f64 = flat.iter().map(|&room| network.rooms[room].area_m2).sum();
            flat.len() <= MOST_ROOMS && AREA_M2.contains(&area_m2)
        };
        let in_flats: usize = flats.iter().map(Vec::len).sum();
        if flats.len() < 2 || !flats.iter().all(is_flat) || (in_flats as f64) < LEAST_SHARE * rooms as f64 {
            return None;
        }
        let mut flat_of = vec![None; rooms];
        for (index, flat) in flats.iter().enumerate() {
            flat.iter().for_each(|&room| flat_of[room] = Some(index));
        }
        let entrances = |flat: usize| {
            let doors = flats[flat].iter().flat_map(|&room| &joined[room]);
            doors.filter(|&&other| flat_of[other] != Some(flat)).count()
        };
        let common: Vec<usize> = (0..rooms).filter(|&room| flat_of[room].is_none()).collect();
        let is_single = |room: &&usize| joined[**room].len() <= 1 && network.rooms[**room].area_m2 > SINGLE_M2;
        let is_storey =
            (0..flats.len()).all(|flat| entrances(flat) <= 1) && common.iter().filter(is_single).count() < flats.len();
        is_storey.then_some(Self { flats, common })
    }
}

/// The large parts that are left of some rooms without their landing; `None` if they have none.
fn at_landing(joined: &[Vec<usize>], rooms: &[usize]) -> Option<Vec<Vec<usize>>> {
    let without = |&landing: &usize| {
        let mut parts = large_parts(joined, rooms, Some(landing));
        parts.sort_by_key(|part| std::cmp::Reverse(part.len()));
        let second = parts.get(1)?.len();
        let in_parts: usize = parts.iter().map(Vec::len).sum();
        Some(((second, in_parts, std::cmp::Reverse(landing)), parts))
    };
    let candidates = rooms.iter().filter(|&&room| joined[room].len() > 1);
    candidates.filter_map(without).max_by_key(|(evenness, _)| *evenness).map(|(_, parts)| parts)
}

/// The connected parts of four rooms or more of some rooms, less one; each ascending.
fn large_parts(joined: &[Vec<usize>], rooms: &[usize], less: Option<usize>) -> Vec<Vec<usize>> {
    let mut seen = vec![true; joined.len()];
    for &room in rooms {
        seen[room] = Some(room) == less;
    }
    let mut parts = Vec::new();
    for &start in rooms {
        if seen[start] {
            continue;
        }
        seen[start] = true;
        let mut part = vec![start];
        let mut next = 0;
        while let Some(&room) = part.get(next) {
            next += 1;
            for &other in &joined[room] {
                if !seen[other] {
                    seen[other] = true;
                    part.push(other);
                }
            }
        }
        part.sort_unstable();
        if part.len() >= LEAST_ROOMS {
            parts.push(part);
        }
    }
    parts
}

impl RoomNetwork {
    /// The flats of a storey, looked for once; `None` for a plan that is not one.
    pub fn flats(&self) -> Option<&Flats> {
        self.flats.get_or_init(|| Flats::of(self)).as_ref()
    }

    /// Some of its rooms alone, in this order: doors to the others lead outside.
    pub fn part(&self, rooms: &[usize]) -> Self {
        let mut place = vec![None; self.rooms.len()];
        for (index, &room) in rooms.iter().enumerate() {
            place[room] = Some(index);
        }
        let mut of_part: Vec<_> = rooms.iter().map(|&room| self.rooms[room].clone()).collect();
        for door in of_part.iter_mut().flat_map(|room| &mut room.doors) {
            door.to = door.to.and_then(|other| place.get(other).copied().flatten());
        }
        Self { rooms: of_part, ..self.clone_without_rooms() }
    }

    fn clone_without_rooms(&self) -> Self {
        Self {
            file: self.file.clone(),
            plan: self.plan.clone(),
            building: self.building.clone(),
            group: self.group.clone(),
            storey: self.storey.clone(),
            typology: self.typology.clone(),
            rooms: Vec::new(),
            left_out: self.left_out.clone(),
            flats: OnceLock::new(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dataset::{NetworkDoor, NetworkRoom};
    use crate::labels::Schemes;
    use crate::plan::OpeningKind;

    /// A network of rooms of 12 m² with doors between some of them.
    fn network(rooms: usize, doors: &[(usize, usize)]) -> RoomNetwork {
        let plans = crate::store::bundled_plans().unwrap();
        let like = RoomNetwork::new(&plans[0].1, &Schemes::bundled());
        let opening = like.rooms.iter().flat_map(|room| &room.doors).next().unwrap().opening;
        let mut of: Vec<NetworkRoom> =
            (0..rooms).map(|_| NetworkRoom { area_m2: 12.0, doors: Vec::new(), ..like.rooms[0].clone() }).collect();
        for &(p, q) in doors {
            for (from, to) in [(p, q), (q, p)] {
                of[from].doors.push(NetworkDoor { opening, kind: OpeningKind::Door, to: Some(to) });
            }
        }
        RoomNetwork { rooms: of, flats: OnceLock::new(), ..like }
    }

    #[test]
    fn two_flats_are_cut_at_their_stairs() {
        // Stairs 0; a flat with the hall 1, another with the hall 7.
        let doors = [
            (0, 1),
            (1, 2),
            (1, 3),
            (1, 4),
            (1, 5),
            (5, 6), // one
            (0, 7),
            (7, 8),
            (7, 9),
            (7, 10),
            (10, 11), // the other
        ];
        let storey = network(12, &doors);
        let flats = storey.flats().unwrap();
        assert_eq!(flats.flats, [vec![1, 2, 3, 4, 5, 6], vec![7, 8, 9, 10, 11]]);
        assert_eq!(flats.common, [0]);
        let part = storey.part(&flats.flats[1]);
        assert_eq!((part.rooms.len(), part.rooms[0].doors.len()), (5, 4));
        assert_eq!(part.rooms[0].doors[0].to, None, "the entrance door leads outside");
    }

    #[test]
    fn a_corridor_with_rooms_and_a_single_flat_stay_whole() {
        let corridor: Vec<(usize, usize)> = (1..20).map(|room| (0, room)).collect();
        assert_eq!(network(20, &corridor).flats(), None);
        let flat = [(0, 1), (0, 2), (0, 3), (0, 4), (4, 5), (4, 6), (6, 7), (6, 8)];
        assert_eq!(network(9, &flat).flats(), None);
    }
}
