//! Why a room got its label, as people read it: what was seen, which label it speaks for, and how strongly.

use crate::base::units::Units;
use crate::base::wording::sentence;
use crate::labels::Label;

/// Why a room got its label.
#[derive(Clone, Debug, PartialEq)]
pub struct Why {
    /// The predicted label.
    pub label: Label,
    /// What was seen: first what speaks for the label, strongest first, then what speaks for another.
    pub points: Vec<Point>,
    /// What follows, in sentences; empty if the points say it all.
    pub conclusion: String,
}

/// One thing that was seen.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// In words, without a full stop: `42.1 m², the largest of 12 rooms`.
    pub seen: String,
    /// What it speaks for by itself; `None` where only all points together decide.
    pub speaks: Option<Speaks>,
    /// Where to look on the plan.
    pub on_plan: OnPlan,
}

/// Which label a point speaks for, and how strongly.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Speaks {
    pub label: Label,
    pub strength: Strength,
}

/// How strongly a point speaks for a label: by how much less likely the label would be without it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Strength {
    /// By 30 percentage points or more.
    Strong,
    /// By 10 or more.
    Clear,
    /// By less.
    Slight,
}

impl Strength {
    /// The strength of a change of probability.
    pub fn of(change: f64) -> Self {
        match change {
            strong if strong >= 0.3 => Self::Strong,
            clear if clear >= 0.1 => Self::Clear,
            _ => Self::Slight,
        }
    }

    /// Its name in sentences and files.
    pub const fn name(self) -> &'static str {
        ["strong", "clear", "slight"][self as usize]
    }
}

/// Where on the plan a point can be seen.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum OnPlan {
    /// The room's area.
    Area,
    /// Its axes, `M` and `m`.
    Axes,
    /// Its openings; of these only the ones to rooms of a label, if one is named.
    Openings(Option<Label>),
    /// Rooms, by their index in the network.
    Rooms(Vec<usize>),
}

impl OnPlan {
    /// Where a feature of `F_r` can be seen.
    pub fn of_feature(feature: usize) -> Self {
        match feature {
            0 => Self::Area,
            1 => Self::Axes,
            _ => Self::Openings(feature.checked_sub(3).and_then(|label| Label::ALL.get(label)).copied()),
        }
    }
}

/// Points that speak alike.
#[derive(Clone, Debug, PartialEq)]
pub struct Group<'a> {
    /// `Strong signs of a medium room`.
    pub title: String,
    pub points: &'a [Point],
}

impl Why {
    /// The points by what they speak for and how strongly, in their order.
    pub fn groups(&self) -> Vec<Group<'_>> {
        let alike = self.points.chunk_by(|p, q| p.speaks == q.speaks);
        alike.map(|points| Group { title: self.title(points[0].speaks, points.len()), points }).collect()
    }

    /// Adds a point behind those that speak for the same label as strongly.
    pub(super) fn add(&mut self, point: Point) {
        let label = self.label;
        let rank = |point: &Point| {
            let speaks = point.speaks.map(|speaks| (speaks.label != label, speaks.label, speaks.strength));
            speaks.map(|(is_other, other, strength)| (is_other, is_other.then_some(other), strength))
        };
        let place = self.points.iter().position(|other| rank(other) > rank(&point)).unwrap_or(self.points.len());
        self.points.insert(place, point);
    }

    fn title(&self, speaks: Option<Speaks>, points: usize) -> String {
        let Some(Speaks { label, strength }) = speaks else { return "What was seen".to_owned() };
        let (strength, is_for_it) = (strength.name(), label == self.label);
        match (points, is_for_it) {
            (1, true) => sentence(&format!("{strength} sign of a {label}")),
            (_, true) => sentence(&format!("{strength} signs of a {label}")),
            (1, false) => format!("But a {strength} sign of a {label}"),
            (_, false) => format!("But {strength} signs of a {label}"),
        }
    }

    /// The points for a JSON file: what was seen, the label it speaks for, and how strongly.
    pub fn to_value(&self) -> serde_json::Value {
        let point = |point: &Point| {
            serde_json::json!({
                "seen": point.seen,
                "for": point.speaks.map(|speaks| speaks.label.letter()),
                "strength": point.speaks.map(|speaks| speaks.strength.name()),
            })
        };
        self.points.iter().map(point).collect()
    }

    /// All of it in a few sentences.
    pub fn sentences(&self) -> String {
        let mut sentences: Vec<String> = self
            .groups()
            .iter()
            .map(|group| {
                let seen: Vec<&str> = group.points.iter().map(|point| point.seen.as_str()).collect();
                format!("{}: {}.", group.title, seen.join("; "))
            })
            .collect();
        if !self.conclusion.is_empty() {
            sentences.push(self.conclusion.clone());
        }
        sentences.join(" ")
    }
}

/// What a change of each label's probability speaks for: for the predicted label, or else for the label that gains
/// most. `None` if it changes too little to be mentioned.
pub(super) fn speaks(label: Label, gain: impl Fn(Label) -> f64) -> Option<(Speaks, f64)> {
    if gain(label) >= MATTERS {
        return Some((Speaks { label, strength: Strength::of(gain(label)) }, gain(label)));
    }
    if gain(label) > -MATTERS_AGAINST {
        return None;
    }
    let others = Label::ALL.into_iter().filter(|&other| other != label);
    let most = others.max_by(|&p, &q| gain(p).total_cmp(&gain(q)))?;
    (gain(most) >= MATTERS_AGAINST).then(|| (Speaks { label: most, strength: Strength::of(gain(most)) }, gain(most)))
}

/// Smaller changes of probability are not worth mentioning...
const MATTERS: f64 = 0.02;

/// ...nor smaller ones of what speaks for another label.
const MATTERS_AGAINST: f64 = 0.05;

/// The most points named for the label, and for others.
const NAMED: usize = 4;
const NAMED_AGAINST: usize = 2;

/// The points worth mentioning, each with the change it makes, in order.
pub(super) fn sorted(label: Label, mut points: Vec<(Point, f64)>) -> Vec<Point> {
    points.sort_by(|(_, p), (_, q)| q.total_cmp(p));
    let (for_it, against): (Vec<Point>, Vec<Point>) = points
        .into_iter()
        .map(|(point, _)| point)
        .partition(|point| point.speaks.is_some_and(|speaks| speaks.label == label));
    // Those that speak for one label stand together.
    let mut against: Vec<Point> = against.into_iter().take(NAMED_AGAINST).collect();
    against.sort_by_key(|point| point.speaks.map(|speaks| (speaks.label, speaks.strength)));
    for_it.into_iter().take(NAMED).chain(against).collect()
}

/// An area with few digits: `12.4 m²`, `133 sq ft`.
pub(super) fn area(area_m2: f64, units: Units) -> String {
    match units {
        Units::Metric => format!("{} m²", super::numbers::rounded(area_m2)),
        Units::Imperial => units.area(area_m2),
    }
}

/// `a, b and c`.
pub(super) fn and_list(parts: &[String]) -> String {
    match parts {
        [all @ .., last] if !all.is_empty() => format!("{} and {last}", all.join(", ")),
        parts => parts.concat(),
    }
}

/// A sentence that says no point stands out.
pub(super) fn nothing_stands_out(label: Label) -> String {
    format!("Nothing stands out: no single trait makes it a {label}.")
}
