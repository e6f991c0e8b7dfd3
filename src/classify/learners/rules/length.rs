//! Description length: how many bits a set of rules and its mistakes take to encode (Cohen 1995, section
//! 3; Quinlan 1995). A rule that does not pay for itself is dropped.

/// The performance of a rule, or a set of rules, on the rooms that reach it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Tally {
    /// Rooms covered, and how many of these wrongly.
    pub covered: f64,
    pub wrong: f64,
    /// Rooms not covered, and how many of these should be.
    pub uncovered: f64,
    pub missed: f64,
}

impl Tally {
    /// Rooms covered correctly.
    pub fn right(&self) -> f64 {
        self.covered - self.wrong
    }
}

/// Cohen's factor for redundant conditions.
const REDUNDANCY: f64 = 0.5;

/// Rules are added while the total length stays within this many bits of the minimum so far (Cohen).
pub(super) const SURPLUS_BITS: f64 = 64.0;

/// Bits to identify a subset of `k` out of `t` things, each expected with probability `p`.
fn subset_bits(t: f64, k: f64, p: f64) -> f64 {
    // An expectation outside 0..1 (more mistakes than rooms covered) counts as nearly certain.
    const TINY: f64 = 1e-9;
    let named = if k > 0.0 { -k * p.max(TINY).log2() } else { 0.0 };
    let unnamed = if t > k { -(t - k) * (1.0 - p).max(TINY).log2() } else { 0.0 };
    named + unnamed
}

/// Bits for a rule of `conditions` conditions out of `possible` ones.
pub(super) fn rule_bits(conditions: usize, possible: f64) -> f64 {
    if conditions == 0 {
        return 0.0;
    }
    let k = conditions as f64;
    // The number of conditions: log2 k, and twice the log of that to say how long it is.
    let mut count_bits = k.log2();
    if k > 1.0 {
        count_bits += 2.0 * count_bits.log2();
    }
    REDUNDANCY * (count_bits + subset_bits(possible, k, k / possible))
}

/// Bits for the mistakes of a set of rules, with a `share` of the mistakes expected among the rooms
/// covered.
pub(super) fn mistake_bits(share: f64, tally: &Tally) -> f64 {
    let Tally { covered, wrong, uncovered, missed } = *tally;
    let rooms_bits = (covered + uncovered + 1.0).log2();
    let ratio = |part: f64, whole: f64| if whole > 0.0 { part / whole } else { 0.0 };
    let (of_covered, of_uncovered) = if covered > uncovered {
        (share * (wrong + missed) / covered, ratio(missed, uncovered))
    } else {
        (ratio(wrong, covered), ratio((1.0 - share) * (wrong + missed), uncovered))
    };
    rooms_bits + subset_bits(covered, wrong, of_covered) + subset_bits(uncovered, missed, of_uncovered)
}

/// The bits saved by deleting this rule from a set, if any are saved, or if the rule is wrong at least as
/// often as right. `all` becomes the tally without it.
pub(super) fn saved_by_deleting(share: f64, all: &mut Tally, rule: &Tally, rule_bits: f64) -> Option<f64> {
    let without = Tally {
        covered: all.covered - rule.covered,
        wrong: all.wrong - rule.wrong,
        uncovered: all.uncovered + rule.covered,
        missed: all.missed + rule.right(),
    };
    let saved = mistake_bits(share, all) + rule_bits - mistake_bits(share, &without);
    // A rule that covers nothing must be deleted, too.
    let useful = rule.wrong < 0.5 * rule.covered;
    if saved > 0.0 || !useful {
        *all = without;
        Some(saved)
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_follow_from_probabilities() {
        // Eight of sixteen at even odds: a bit each.
        assert_eq!(subset_bits(16.0, 8.0, 0.5), 16.0);
        assert_eq!(subset_bits(16.0, 0.0, 0.0), 0.0);
        // One condition of 1024: ten bits and the small cost of the count, halved.
        let bits = rule_bits(1, 1024.0);
        assert!((bits - 0.5 * (10.0 + std::f64::consts::LOG2_E)).abs() < 0.01, "{bits}");
        assert_eq!(rule_bits(0, 1024.0), 0.0);
    }

    #[test]
    fn fewer_mistakes_are_shorter() {
        let tally = |wrong, missed| Tally { covered: 40.0, wrong, uncovered: 60.0, missed };
        assert!(mistake_bits(0.4, &tally(1.0, 1.0)) < mistake_bits(0.4, &tally(10.0, 1.0)));
        assert!(mistake_bits(0.4, &tally(1.0, 1.0)) < mistake_bits(0.4, &tally(1.0, 10.0)));
        assert!(mistake_bits(0.4, &Tally::default()).is_finite());
    }

    #[test]
    fn a_rule_that_is_mostly_wrong_goes() {
        let mut all = Tally { covered: 50.0, wrong: 10.0, uncovered: 50.0, missed: 2.0 };
        let bad = Tally { covered: 12.0, wrong: 9.0, uncovered: 50.0, missed: 2.0 };
        let before = all;
        assert!(saved_by_deleting(0.5, &mut all, &bad, 8.0).is_some());
        assert_eq!(all, Tally { covered: 38.0, wrong: 1.0, uncovered: 62.0, missed: 5.0 });
        let mut all = before;
        let good = Tally { covered: 30.0, wrong: 0.0, uncovered: 70.0, missed: 12.0 };
        assert_eq!(saved_by_deleting(0.5, &mut all, &good, 8.0), None);
        assert_eq!(all, before);
    }
}
