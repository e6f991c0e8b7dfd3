//! What a plan's doors and rooms say about its scale: a posterior over how many times too long its lengths are.
//!
//! People are of one size, so doors are: in 167 floors of the KTH campus, drawn to scale, 10, 50 and 90 % of the
//! doorways are narrower than 0.67, 0.85 and 1.48 m. The median of a plan's doors is therefore close to 0.85 m whatever
//! the building, and a plan where it is not has probably another scale than it says. The areas of rooms say
//! the same less sharply. Both are put together on the logarithm of the factor as normal distributions, each by the
//! inverse of its variance; before any evidence every factor is as likely.

use super::Context;
use super::sizes::ROOM_SPREAD;
use crate::base::numbers::lower_median;
use crate::plan::{DEFAULT_DOOR_WIDTH_M, MEDIAN_DOOR_M, OpeningKind};

/// Fewer doors than this say nothing: a small flat may have double doors only.
const DOORS_FOR_SCALE: usize = 6;

/// By how much the median door differs from plan to plan, as the standard deviation of its logarithm: 0.07 in 77 floors
/// of the KTH campus with at least six doors (68 % of their medians lie from 0.79 to 0.89 m), 0.22 in 604 Japanese
/// dwellings, some of which have sliding doors of twice the width.
const BETWEEN_PLANS: f64 = 0.2;

/// The standard deviation of the logarithm of doorways' widths, by the quartiles 0.79, 0.86 and 1.01 m of 86 of these
/// floors: narrower than the tails say, which are gates and niches.
const DOOR_SPREAD: f64 = 0.19;

/// By how much what rooms say of the scale differs from building to building: of the authors' 40 schools, those with
/// classrooms of a usual size are up to 1.45 times off, taken as two standard deviations.
const BETWEEN_BUILDINGS: f64 = 0.19;

/// The median of n values has the deviation of their mean times √(π/2), if they are normal.
const OF_MEDIAN: f64 = 1.2533;

/// What a plan's doors and rooms say about its scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LikelyScale {
    /// The doorways, if their widths are known.
    pub doors: Option<Doors>,
    /// The rooms, if enough have a label whose usual area is known.
    pub rooms: Option<Rooms>,
    /// Mean and standard deviation of the logarithm of the factor by which lengths are too long.
    mean: f64,
    deviation: f64,
}

/// The doorways of a plan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Doors {
    pub count: usize,
    /// Their median width in metres.
    pub median_width_m: f64,
}

/// The rooms of a plan, beside the usual areas of their labels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rooms {
    pub count: usize,
    /// How many times too long lengths seem.
    pub factor: f64,
}

impl Doors {
    /// Of widths in metres; `None` if there are too few.
    pub fn of(mut widths_m: Vec<f64>) -> Option<Self> {
        widths_m.retain(|width_m| width_m.is_finite() && *width_m > 0.0);
        let count = widths_m.len();
        let median_width_m = lower_median(&mut widths_m).filter(|_| count >= DOORS_FOR_SCALE)?;
        Some(Self { count, median_width_m })
    }

    /// What they say, as mean and variance of the logarithm of the factor.
    fn evidence(self) -> (f64, f64) {
        let of_sample = (OF_MEDIAN * DOOR_SPREAD).powi(2) / self.count as f64;
        ((self.median_width_m / MEDIAN_DOOR_M).ln(), BETWEEN_PLANS.powi(2) + of_sample)
    }
}

impl Rooms {
    fn evidence(self) -> (f64, f64) {
        // A length goes with the root of an area.
        let of_sample = (OF_MEDIAN * ROOM_SPREAD / 2.0).powi(2) / self.count.max(1) as f64;
        (self.factor.ln(), BETWEEN_BUILDINGS.powi(2) + of_sample)
    }
}

impl LikelyScale {
    /// Puts together what is known; `None` if nothing is.
    pub fn of(doors: Option<Doors>, rooms: Option<Rooms>) -> Option<Self> {
        let evidence = doors.map(Doors::evidence).into_iter().chain(rooms.map(Rooms::evidence));
        let (weighted, weight) = evidence
            .fold((0.0, 0.0), |(sum, weight), (mean, variance)| (sum + mean / variance, weight + 1.0 / variance));
        let (mean, deviation) = (weighted / weight, (1.0 / weight).sqrt());
        (mean.is_finite() && deviation.is_finite()).then_some(Self { doors, rooms, mean, deviation })
    }

    /// How many times too long the plan's lengths most probably are, above 0; 1 if its scale is right.
    pub fn factor(&self) -> f64 {
        self.mean.exp()
    }

    /// The factors between which the true one lies with a probability of 90 %.
    pub fn range(&self) -> (f64, f64) {
        // The normal distribution's 95 % quantile.
        let reach = 1.6449 * self.deviation;
        ((self.mean - reach).exp(), (self.mean + reach).exp())
    }

    /// Whether doors and rooms contradict each other: what they say differs by more than one and a half standard
    /// deviations.
    pub fn is_contradictory(&self) -> bool {
        let (Some(doors), Some(rooms)) = (self.doors, self.rooms) else { return false };
        let ((one, one_variance), (other, other_variance)) = (doors.evidence(), rooms.evidence());
        (one - other).abs() > 1.5 * (one_variance + other_variance).sqrt()
    }
}

/// What the doors and rooms of a plan say about its scale; `None` if they say nothing.
pub fn likely_scale(context: &Context) -> Option<LikelyScale> {
    let rooms = context.length_factor.map(|(factor, count)| Rooms { count, factor });
    LikelyScale::of(doors(context), rooms)
}

/// The doors with one leaf whose widths the source gives: passages and double doors have no usual width. One of exactly the default width may have been given it by an import:
/// if most are, they say nothing (and if they are real, nothing is wrong).
fn doors(context: &Context) -> Option<Doors> {
    let doors = context.openings.iter().filter(|placed| placed.opening.kind == OpeningKind::Door);
    let widths_m: Vec<f64> = doors.map(|placed| placed.segment.length()).collect();
    let is_given = |width_m: &f64| (width_m - DEFAULT_DOOR_WIDTH_M).abs() > crate::geometry::GRID_M;
    let given: Vec<f64> = widths_m.iter().copied().filter(is_given).collect();
    if 2 * given.len() < widths_m.len() { None } else { Doors::of(given) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_doors_say_it_more_surely() {
        let of = |count: usize, width_m: f64| LikelyScale::of(Doors::of(vec![width_m; count]), None).expect("doors");
        let (few, many) = (of(6, 0.425), of(300, 0.425));
        assert!((few.factor() - 0.5).abs() < 1e-12 && (many.factor() - 0.5).abs() < 1e-12);
        let width = |likely: LikelyScale| likely.range().1 / likely.range().0;
        assert!(width(few) > width(many) && width(many) > 1.9, "plans differ however many doors they have");
        assert!(many.range().1 < 0.75, "it is surely wrong");
        assert!(LikelyScale::of(Doors::of(vec![0.9; 5]), None).is_none());
        assert!(Doors::of(vec![f64::NAN, f64::INFINITY, -1.0, 0.9]).is_none());
    }

    #[test]
    fn doors_and_rooms_are_weighed() {
        let doors = Doors::of(vec![1.7; 20]);
        let rooms = |factor| Some(Rooms { count: 20, factor });
        let both = LikelyScale::of(doors, rooms(2.0)).expect("evidence");
        assert!((both.factor() - 2.0).abs() < 1e-12 && !both.is_contradictory());
        let disagree = LikelyScale::of(doors, rooms(0.5)).expect("evidence");
        assert!(disagree.is_contradictory());
        assert!(disagree.factor() > 1.0 && disagree.factor() < 2.0, "doors weigh more: {}", disagree.factor());
        let alone = LikelyScale::of(None, rooms(1.7)).expect("evidence");
        assert!((alone.factor() - 1.7).abs() < 1e-12);
        assert_eq!(LikelyScale::of(None, None), None);
    }
}
