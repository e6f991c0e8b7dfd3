//! Which rooms a classifier learned from, in a few bytes a room, so that nobody takes it for a wonder when it knows them again.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD as BASE64;
use serde::{Deserialize, Serialize};

use crate::dataset::RoomNetwork;
use crate::dataset::fingerprint::RoomPrint;

/// The rooms a classifier learned from: of each a hash of its shape and surroundings ([`RoomPrint::hash`]), and whether it was
/// labelled rightly by classifiers of the same kind that did not learn from it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Learned {
    /// Sorted. Rooms of one hash stand one after the other.
    hashes: Vec<u32>,
    /// For each, whether it was right out of fold; empty where nobody tested.
    right: Vec<bool>,
    /// What was assigned to folds for that: `building` or `room`; empty where nobody tested.
    folds_by: String,
}

/// What a classifier has to do with a plan.
#[derive(Clone, Debug, PartialEq)]
pub struct Acquaintance {
    /// Rooms of the plan that it learned from.
    pub rooms: usize,
    /// Rooms of the plan.
    pub of: usize,
    /// Share of these rooms that was right out of fold, 0..=1; `None` where nobody tested.
    pub out_of_fold: Option<f64>,
    /// What was assigned to folds for that: `building` or `room`.
    pub folds_by: String,
}

/// From this share of its rooms on a plan counts as one that was learned from.
const SHARE: f64 = 0.5;

/// Fewer rooms may be alike by chance, unless they are all there are.
const LEAST: usize = 3;

impl Learned {
    /// The rooms of a training set. `right`: for each, whether it was right out of fold; `None` where nobody tested.
    pub fn new<'a>(rooms: impl IntoIterator<Item = &'a RoomPrint>, right: Option<(&[bool], &str)>) -> Self {
        let mut rooms: Vec<(u32, bool)> = rooms.into_iter().map(|print| (print.hash(), false)).collect();
        let tested = right.filter(|(right, _)| right.len() == rooms.len());
        if let Some((right, _)) = tested {
            for (room, &right) in rooms.iter_mut().zip(right) {
                room.1 = right;
            }
        }
        rooms.sort_unstable();
        let (hashes, right) = rooms.into_iter().unzip();
        match tested {
            Some((_, folds_by)) => Self { hashes, right, folds_by: folds_by.to_owned() },
            None => Self { hashes, right: Vec::new(), folds_by: String::new() },
        }
    }

    /// Number of rooms.
    pub fn len(&self) -> usize {
        self.hashes.len()
    }

    /// Whether nothing is known.
    pub fn is_empty(&self) -> bool {
        self.hashes.is_empty()
    }

    /// Whether the classifier learned from a plan, and what it would have said of it otherwise; `None` where it did not.
    pub fn acquaintance(&self, network: &RoomNetwork) -> Option<Acquaintance> {
        let of = network.rooms.len();
        let known: Vec<Vec<bool>> = network.rooms.iter().filter_map(|room| self.find(&room.print)).collect();
        let rooms = known.len();
        if rooms == 0 || (rooms as f64) < SHARE * of as f64 || rooms < LEAST.min(of) {
            return None;
        }
        // Rooms of one hash are not told apart: each counts as their mean.
        let mean = |right: &Vec<bool>| right.iter().filter(|&&right| right).count() as f64 / right.len().max(1) as f64;
        let out_of_fold = (!self.right.is_empty()).then(|| known.iter().map(mean).sum::<f64>() / rooms as f64);
        Some(Acquaintance { rooms, of, out_of_fold, folds_by: self.folds_by.clone() })
    }

    /// Whether each room of a print's hash was right; `None` where there is none. Empty where nobody tested.
    fn find(&self, print: &RoomPrint) -> Option<Vec<bool>> {
        let range = |hash: u32| {
            let start = self.hashes.partition_point(|&other| other < hash);
            start..self.hashes.partition_point(|&other| other <= hash)
        };
        let found = print.hashes().into_iter().map(range).find(|range| !range.is_empty())?;
        Some(self.right.get(found).map(<[bool]>::to_vec).unwrap_or_default())
    }
}

impl Acquaintance {
    /// The same in a few words, for where there is little room.
    pub fn short_words(&self) -> String {
        match self.out_of_fold {
            Some(share) => format!("The model learned from this plan; without it, {:.0} % are right", 100.0 * share),
            None => "The model learned from this plan".to_owned(),
        }
    }

    /// What to know before believing how well the labels agree, in words.
    pub fn words(&self) -> String {
        let rooms =
            if self.rooms == self.of { String::new() } else { format!(" ({} of {} rooms)", self.rooms, self.of) };
        let learned = format!("learned from this plan{rooms}, so agreement proves nothing");
        match self.out_of_fold {
            Some(share) if self.folds_by == "building" => {
                format!("{learned}; without this building it predicts {:.0} % of the labels correctly", 100.0 * share)
            }
            Some(share) => {
                format!("{learned}; without these rooms it predicts {:.0} % of their labels correctly", 100.0 * share)
            }
            None => learned,
        }
    }
}

/// How a model file holds it: the gaps between sorted hashes, seven bits a byte, and a bit a room, in base 64.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct DiskLearned {
    rooms: usize,
    hashes: String,
    #[serde(default)]
    right: String,
    #[serde(default)]
    folds_by: String,
}

impl DiskLearned {
    pub(super) fn of(learned: &Learned) -> Self {
        let mut bytes = Vec::new();
        let mut before = 0;
        for &hash in &learned.hashes {
            let mut gap = hash - before;
            before = hash;
            while gap >= 0x80 {
                bytes.push((gap as u8 & 0x7f) | 0x80);
                gap >>= 7;
            }
            bytes.push(gap as u8);
        }
        let bits = learned
            .right
            .chunks(8)
            .map(|eight| eight.iter().enumerate().fold(0u8, |byte, (bit, &right)| byte | (u8::from(right) << bit)));
        Self {
            rooms: learned.hashes.len(),
            hashes: BASE64.encode(bytes),
            right: BASE64.encode(bits.collect::<Vec<u8>>()),
            folds_by: learned.folds_by.clone(),
        }
    }

    /// `None` if it does not hold what it says.
    pub(super) fn live(self) -> Option<Learned> {
        let bytes = BASE64.decode(self.hashes).ok()?;
        let mut hashes = Vec::new();
        let (mut before, mut gap, mut shift) = (0u32, 0u32, 0u32);
        for byte in bytes {
            gap |= u32::from(byte & 0x7f).checked_shl(shift)?;
            if byte & 0x80 == 0 {
                before = before.checked_add(gap)?;
                hashes.push(before);
                (gap, shift) = (0, 0);
            } else {
                shift += 7;
            }
        }
        let bits = BASE64.decode(self.right).ok()?;
        let count = if self.folds_by.is_empty() { 0 } else { self.rooms };
        let right: Vec<bool> =
            (0..count).map(|room| Some(bits.get(room / 8)? >> (room % 8) & 1 == 1)).collect::<Option<_>>()?;
        (hashes.len() == self.rooms && shift == 0).then_some(Learned { hashes, right, folds_by: self.folds_by })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::labels::Schemes;

    #[test]
    fn a_model_knows_the_plans_it_learned_from_and_no_other() {
        let plans = crate::store::bundled_plans().unwrap();
        let networks: Vec<RoomNetwork> =
            plans.iter().map(|(_, plan)| RoomNetwork::new(plan, &Schemes::bundled())).collect();
        for (index, taught) in networks.iter().enumerate() {
            let prints: Vec<&RoomPrint> = taught.rooms.iter().map(|room| &room.print).collect();
            let right: Vec<bool> = (0..prints.len()).map(|room| room % 4 != 0).collect();
            let learned = Learned::new(prints.iter().copied(), Some((&right, "building")));
            let read = DiskLearned::of(&learned).live().unwrap();
            assert_eq!(read, learned);
            for (other, network) in networks.iter().enumerate() {
                let known = read.acquaintance(network);
                assert_eq!(known.is_some(), other == index, "{}: {known:?}", network.plan);
                if let Some(known) = known {
                    assert_eq!((known.rooms, known.of), (prints.len(), prints.len()));
                    let share = right.iter().filter(|&&right| right).count() as f64 / right.len() as f64;
                    assert!((known.out_of_fold.unwrap() - share).abs() < 0.1, "{known:?}");
                }
            }
            let untested = Learned::new(prints.iter().copied(), None);
            assert_eq!(DiskLearned::of(&untested).live().unwrap().acquaintance(taught).unwrap().out_of_fold, None);
        }
    }

    #[test]
    fn what_does_not_hold_what_it_says_is_refused() {
        let disk = |rooms: usize, hashes: &str| DiskLearned {
            rooms,
            hashes: hashes.to_owned(),
            right: String::new(),
            folds_by: String::new(),
        };
        assert!(disk(1, "AQ==").live().is_some());
        for (rooms, hashes) in [(2, "AQ=="), (1, "gQ=="), (1, "?"), (1, "gICAgICAgICAAQ=="), (2, "/////w//////Dw==")] {
            assert!(disk(rooms, hashes).live().is_none(), "{hashes}");
        }
    }
}
