//! What a robot found, beside the true plan: each difference in words, and its place.

use std::collections::BTreeMap;

use crate::app::paint::robot::{MarkSeen, RoomsSeen, Tone};
use crate::features::RoomStatus;
use crate::geometry::{Bounds, Point};
use crate::labels::Schemes;
use crate::plan::{Plan, RoomId, titles::room_title};
use crate::robot::score::{Fate, Score};
use crate::topology::RoomShapes;

/// A kind of difference, or of agreement, in the order of the list.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Verdict {
    Missed,
    Split,
    Merged,
    Invented,
    NoDoor,
    WrongDoor,
    WrongLabel,
    Found,
    OutOfReach,
}

impl Verdict {
    pub(crate) const ALL: [Self; 9] = [
        Self::Missed,
        Self::Split,
        Self::Merged,
        Self::Invented,
        Self::NoDoor,
        Self::WrongDoor,
        Self::WrongLabel,
        Self::Found,
        Self::OutOfReach,
    ];

    /// The title of its rows.
    pub(crate) const fn title(self) -> &'static str {
        match self {
            Self::Missed => "Missed",
            Self::Split => "Split",
            Self::Merged => "Merged",
            Self::Invented => "No such room",
            Self::NoDoor => "Connection not found",
            Self::WrongDoor => "No such connection",
            Self::WrongLabel => "Wrong label",
            Self::Found => "Found",
            Self::OutOfReach => "Out of reach",
        }
    }

    /// The sign that tells it without colours.
    pub(crate) const fn sign(self) -> &'static str {
        match self {
            Self::Missed | Self::NoDoor => "−",
            Self::Split => "÷",
            Self::Merged => "+",
            Self::Invented | Self::WrongDoor => "×",
            Self::WrongLabel => "≠",
            Self::Found => "✓",
            Self::OutOfReach => "○",
        }
    }

    pub(crate) const fn tone(self) -> Tone {
        match self {
            Self::Found => Tone::Good,
            Self::OutOfReach => Tone::Weak,
            _ => Tone::Bad,
        }
    }
}

/// One line of the list.
#[derive(Clone, Debug)]
pub(crate) struct Difference {
    pub verdict: Verdict,
    pub text: String,
    pub bounds: Bounds,
}

/// All of them, differences first, and how the whole stands.
#[derive(Clone, Debug, Default)]
pub(crate) struct Compared {
    pub list: Vec<Difference>,
    /// Of each line.
    pub marks: Vec<MarkSeen>,
    /// The figures of rooms, connections and labels.
    pub figures: Vec<String>,
}

impl Compared {
    /// Compares the rooms found with those of the plan.
    pub(super) fn new(plan: &Plan, score: &Score, found: &RoomsSeen) -> Self {
        let (shapes, schemes) = (RoomShapes::new(plan), Schemes::bundled());
        let title = |id: RoomId| plan.room(id).map(room_title).unwrap_or_default();
        let rings_of = |id: RoomId| -> Vec<Vec<Point>> {
            shapes.get(id).map(|shape| shape.rings().cloned().collect()).unwrap_or_default()
        };
        // The true room of each one found: that which it covers best.
        let mut true_of: BTreeMap<usize, (f64, RoomId)> = BTreeMap::new();
        for room in &score.rooms {
            if let Some(best) = room.best
                && true_of.get(&best).is_none_or(|(iou, _)| room.iou > *iou)
            {
                true_of.insert(best, (room.iou, room.id));
            }
        }
        let middle = |rings: &[Vec<Point>]| Bounds::of(rings.iter().flatten().copied()).center();
        let found_at = |index: usize| found.rooms.get(index).map(|room| room.at);
        let place_of = |id: RoomId| {
            let best = score.rooms.iter().find(|room| room.id == id).and_then(|room| room.best);
            best.and_then(found_at).unwrap_or_else(|| middle(&rings_of(id)))
        };
        let mut lines: Vec<(Difference, MarkSeen)> = Vec::new();
        let mut add = |verdict: Verdict, text: String, rings: Vec<Vec<Point>>, link: Option<[Point; 2]>, at: Point| {
            let bounds = Bounds::of(rings.iter().flatten().copied().chain(link.into_iter().flatten()).chain([at]));
            let mark = MarkSeen { rings, link, at, sign: verdict.sign(), tone: verdict.tone() };
            lines.push((Difference { verdict, text, bounds }, mark));
        };
        let (mut known, mut right) = (0, 0);
        for room in &score.rooms {
            let (verdict, text) = match room.fate {
                Fate::Found => (Verdict::Found, title(room.id)),
                Fate::Split => (Verdict::Split, format!("{} was found as several rooms", title(room.id))),
                Fate::Merged => (Verdict::Merged, format!("{} was found as one with a neighbour", title(room.id))),
                Fate::Missed => (Verdict::Missed, format!("{} was not found", title(room.id))),
            };
            let rings = rings_of(room.id);
            let at = room.best.and_then(found_at).filter(|_| room.fate == Fate::Found);
            let at = at.unwrap_or_else(|| middle(&rings));
            add(verdict, text, rings.clone(), None, at);
            if room.fate == Fate::Found
                && let Some(true_label) =
                    plan.room(room.id).and_then(|room| RoomStatus::of(plan, &schemes, room).label())
            {
                known += 1;
                let said = room.best.and_then(|best| found.rooms.get(best)).and_then(|room| room.label);
                match said {
                    Some(said) if said == true_label => right += 1,
                    Some(said) => {
                        let text =
                            format!("{}: {} in the plan, predicted {}", title(room.id), true_label.name(), said.name());
                        add(Verdict::WrongLabel, text, rings, None, at);
                    }
                    None => {}
                }
            }
        }
        for &index in &score.invented {
            let Some(room) = found.rooms.get(index) else { continue };
            let text = "A room was found that is not in the plan".to_owned();
            add(Verdict::Invented, text, vec![room.floor.outer.clone()], None, room.at);
        }
        for pair in score.true_edges.difference(&score.right_edges) {
            let ends = [place_of(pair.0), place_of(pair.1)];
            let text = format!("{} and {}", title(pair.0), title(pair.1));
            add(Verdict::NoDoor, text, Vec::new(), Some(ends), ends[0].lerp(ends[1], 0.5));
        }
        for &(i, j) in &score.wrong_pairs {
            let (Some(from), Some(to)) = (found_at(i), found_at(j)) else { continue };
            let text = match [true_of.get(&i), true_of.get(&j)] {
                [None, Some((_, id))] | [Some((_, id)), None] => {
                    format!("{} and a room that is not in the plan", title(*id))
                }
                [None, None] => "Two rooms that are not in the plan".to_owned(),
                [Some((_, one)), Some((_, other))] => format!("{} and {}", title(*one), title(*other)),
            };
            add(Verdict::WrongDoor, text, Vec::new(), Some([from, to]), from.lerp(to, 0.5));
        }
        for &id in &score.unreachable {
            let rings = rings_of(id);
            let at = middle(&rings);
            add(Verdict::OutOfReach, title(id), rings, None, at);
        }
        lines.sort_by_key(|(line, _)| line.verdict);
        let (list, marks) = lines.into_iter().unzip();
        let doors = score.wrong_edges;
        let figures = vec![
            format!("{} of {} found", score.count(Fate::Found), score.rooms.len()),
            format!("{} of {} right, {doors} wrong", score.right_edges.len(), score.true_edges.len()),
            format!("{right} of {known} right"),
        ];
        Self { list, marks, figures }
    }

    /// How many lines there are of a kind.
    pub(crate) fn count(&self, verdict: Verdict) -> usize {
        self.list.iter().filter(|line| line.verdict == verdict).count()
    }
}
