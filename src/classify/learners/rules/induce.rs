//! Learns the rules for one label against all labels later in the list.

use super::bits::Bits;
use super::grow::{RankCondition, Ranked, Worth, grow, prune};
use super::length::{SURPLUS_BITS, Tally, mistake_bits, rule_bits, saved_by_deleting};
use crate::base::random::Random;
use crate::dataset::table::FEATURES;
use crate::labels::Label;

/// One in this many rooms is kept for pruning, the others are for growing (Cohen 1995).
const PARTS: usize = 3;

/// Passes that replace or revise each rule given the others (Cohen's RIPPER2).
const OPTIMISATIONS: usize = 2;

/// A rule in the making.
#[derive(Clone)]
pub(super) struct Draft {
    pub conditions: Vec<RankCondition>,
    /// All training rooms it covers, including those decided by earlier rules.
    pub covers: Bits,
}

/// The learning task for one label.
pub(super) struct Task<'a> {
    pub ranked: &'a Ranked,
    pub labels: &'a [Label],
    /// The rooms with this label.
    pub label: Bits,
    /// The rooms still undecided.
    pub rooms: Bits,
    /// The expected share of mistakes among the rooms covered: the label's share of the undecided rooms.
    pub share: f64,
    /// Number of possible conditions.
    pub possible_conditions: f64,
}

impl Task<'_> {
    /// The rules for the label, in order.
    pub fn rules(&self, random: &mut Random) -> Vec<Draft> {
        let mut rules = self.build(random);
        for _ in 0..OPTIMISATIONS {
            rules = self.optimise(rules, random);
        }
        rules
    }

    /// Bits for an empty rule set: every room with the label is missed.
    fn bits_of_nothing(&self) -> f64 {
        let missed = f64::from(self.rooms.count_and(&self.label));
        mistake_bits(self.share, &Tally { covered: 0.0, wrong: 0.0, uncovered: f64::from(self.rooms.count()), missed })
    }

    /// Grows and prunes rules one by one, each on the rooms the previous ones leave.
    fn build(&self, random: &mut Random) -> Vec<Draft> {
        let mut rules = Vec::new();
        let mut left = self.rooms.clone();
        let mut bits = self.bits_of_nothing();
        let mut least_bits = bits;
        while left.count_and(&self.label) > 0 {
            rules.push(self.new_rule(&left, random));
            if !self.last_pays(&mut rules, &mut left, &mut bits, &mut least_bits) {
                break;
            }
        }
        rules
    }

    /// Whether the last rule of a list is worth keeping: if so its rooms are removed from those left,
    /// otherwise the rule is removed.
    fn last_pays(&self, rules: &mut Vec<Draft>, left: &mut Bits, bits: &mut f64, least_bits: &mut f64) -> bool {
        let index = rules.len() - 1;
        *bits += self.relative_bits(rules, index);
        *least_bits = least_bits.min(*bits);
        let tally = self.tally(left, &rules[index]);
        let stays = *bits <= *least_bits + SURPLUS_BITS && tally.wrong < 0.5 * tally.covered;
        if stays {
            left.subtract(&rules[index].covers);
        } else {
            rules.pop();
        }
        stays
    }

    /// One pass over the rules: each may be replaced by a new one, or by one that adds conditions to it,
    /// both pruned for the benefit of the whole set, whichever gives the shortest description. Further
    /// rules cover what remains; then rules that do not pay are deleted.
    fn optimise(&self, mut rules: Vec<Draft>, random: &mut Random) -> Vec<Draft> {
        let mut left = self.rooms.clone();
        let mut bits = self.bits_of_nothing();
        let mut least_bits = bits;
        let mut position = 0;
        while left.count_and(&self.label) > 0 {
            if position < rules.len() {
                if left.count_and(&rules[position].covers) > 0 {
                    self.improve(&mut rules, position, &left, random);
                }
                left.subtract(&rules[position].covers);
            } else {
                rules.push(self.new_rule(&left, random));
                if !self.last_pays(&mut rules, &mut left, &mut bits, &mut least_bits) {
                    break;
                }
            }
            position += 1;
        }
        // With no room of the label left, later rules can only do harm.
        rules.truncate(position);
        self.delete_what_does_not_pay(&mut rules);
        rules
    }

    fn improve(&self, rules: &mut [Draft], position: usize, left: &Bits, random: &mut Random) {
        let (growing, pruning) = self.parts(left, random);
        let decided_later = |row: u32| rules[position + 1..].iter().any(|rule| rule.covers.contains(row));
        let pruning: Vec<u32> = pruning.into_iter().filter(|&row| !decided_later(row)).collect();
        let old = rules[position].clone();

        let mut revision = old.conditions.clone();
        let covered: Vec<u32> = growing.iter().copied().filter(|&row| old.covers.contains(row)).collect();
        grow(self.ranked, &self.label, covered, &mut revision);
        prune(self.ranked, &self.label, pruning.clone(), &mut revision, Worth::OfSet);

        let mut replacement = Vec::new();
        grow(self.ranked, &self.label, growing, &mut replacement);
        prune(self.ranked, &self.label, pruning, &mut replacement, Worth::OfSet);

        let mut best = (self.relative_bits(rules, position), old);
        for conditions in [revision, replacement] {
            rules[position] = self.draft(conditions);
            let bits = self.relative_bits(rules, position);
            if bits < best.0 {
                best = (bits, rules[position].clone());
            }
        }
        rules[position] = best.1;
    }

    fn new_rule(&self, left: &Bits, random: &mut Random) -> Draft {
        let (growing, pruning) = self.parts(left, random);
        let mut conditions = Vec::new();
        grow(self.ranked, &self.label, growing, &mut conditions);
        prune(self.ranked, &self.label, pruning, &mut conditions, Worth::OfRule);
        self.draft(conditions)
    }

    fn draft(&self, conditions: Vec<RankCondition>) -> Draft {
        let covers = self.ranked.covered(&conditions);
        Draft { conditions, covers }
    }

    /// The rooms to grow on and those to prune on, stratified by label.
    fn parts(&self, left: &Bits, random: &mut Random) -> (Vec<u32>, Vec<u32>) {
        let mut by_label: [Vec<u32>; 5] = Default::default();
        for row in left.rows() {
            by_label[self.labels[row as usize].index()].push(row);
        }
        let (mut growing, mut pruning) = (Vec::new(), Vec::new());
        let mut turn = 0;
        for rows in &mut by_label {
            random.shuffle(rows);
            for &row in &*rows {
                turn += 1;
                if turn % PARTS == 0 { pruning.push(row) } else { growing.push(row) }
            }
        }
        (growing, pruning)
    }

    /// The tally of a rule on rooms.
    fn tally(&self, rooms: &Bits, rule: &Draft) -> Tally {
        let covered = f64::from(rooms.count_and(&rule.covers));
        let right = f64::from(rooms.count_and_and(&rule.covers, &self.label));
        let all = f64::from(rooms.count());
        let all_right = f64::from(rooms.count_and(&self.label));
        Tally { covered, wrong: covered - right, uncovered: all - covered, missed: all_right - right }
    }

    /// The tally of each rule on those of `rooms` that the rules before it leave.
    fn tallies<'r>(&self, rooms: &Bits, rules: impl Iterator<Item = &'r Draft>) -> Vec<Tally> {
        let mut left = rooms.clone();
        let (mut all, mut all_right) = (rooms.count(), rooms.count_and(&self.label));
        rules
            .map(|rule| {
                let (covered, right) = left.take(&rule.covers, &self.label);
                all -= covered;
                all_right -= right;
                Tally {
                    covered: covered.into(),
                    wrong: (covered - right).into(),
                    uncovered: all.into(),
                    missed: all_right.into(),
                }
            })
            .collect()
    }

    /// The combined tally of a list of rules.
    fn sum(&self, tallies: &[Tally]) -> Tally {
        let covered: f64 = tallies.iter().map(|tally| tally.covered).sum();
        let wrong: f64 = tallies.iter().map(|tally| tally.wrong).sum();
        let all = f64::from(self.rooms.count());
        let all_right = f64::from(self.rooms.count_and(&self.label));
        Tally { covered, wrong, uncovered: all - covered, missed: all_right - (covered - wrong) }
    }

    fn rule_bits(&self, rule: &Draft) -> f64 {
        rule_bits(rule.conditions.len(), self.possible_conditions)
    }

    /// Bits for the mistakes of rules, minus the saving from deleting those from `from` on.
    fn bits_if_later_may_go(&self, rules: &[&Draft], tallies: &[Tally], from: usize) -> f64 {
        let mut all = self.sum(tallies);
        let bits = mistake_bits(self.share, &all);
        let saved: f64 = (from..rules.len())
            .filter_map(|k| saved_by_deleting(self.share, &mut all, &tallies[k], self.rule_bits(rules[k])))
            .sum();
        bits - saved
    }

    /// How many bits a rule adds to the whole (negative: saves), assuming each later rule is deleted if
    /// that helps.
    fn relative_bits(&self, rules: &[Draft], index: usize) -> f64 {
        let with: Vec<&Draft> = rules.iter().collect();
        let bits_with = self.bits_if_later_may_go(&with, &self.tallies(&self.rooms, rules.iter()), index + 1);
        let mut without = with;
        without.remove(index);
        let tallies = self.tallies(&self.rooms, without.iter().copied());
        let bits_without = self.bits_if_later_may_go(&without, &tallies, index);
        bits_with + self.rule_bits(&rules[index]) - bits_without
    }

    fn delete_what_does_not_pay(&self, rules: &mut Vec<Draft>) {
        let tallies = self.tallies(&self.rooms, rules.iter());
        let mut all = self.sum(&tallies);
        for index in (0..rules.len()).rev() {
            if saved_by_deleting(self.share, &mut all, &tallies[index], self.rule_bits(&rules[index])).is_some() {
                rules.remove(index);
            }
        }
    }
}

/// Number of possible conditions: at most and at least, for every value of every feature.
pub(super) fn possible_conditions(ranked: &Ranked) -> f64 {
    (0..FEATURES).map(|feature| 2.0 * ranked.values[feature].len() as f64).sum()
}
