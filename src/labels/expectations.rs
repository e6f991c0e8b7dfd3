//! What to expect of rooms before their functions are known: temporary labels, usual sizes.

use std::collections::BTreeMap;

use serde::Deserialize;

use super::Label;

/// A rule of the naive classifier (paper, section 3.2): if all conditions hold, it gives the label.
#[derive(Clone, Debug, PartialEq)]
pub struct TemporaryRule {
    pub label: Label,
    /// Minimum area in m².
    pub area_at_least_m2: f64,
    /// Area in m² must be below this; infinite for no bound.
    pub area_below_m2: f64,
    /// Minimum axes ratio.
    pub axes_ratio_at_least: f64,
    /// Minimum number of openings.
    pub doors_at_least: u32,
    /// Why: the source of the thresholds.
    pub reason: String,
}

/// A rule in a scheme file: conditions left out always hold.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct DiskRule {
    label: String,
    area_at_least_m2: Option<f64>,
    area_below_m2: Option<f64>,
    axes_ratio_at_least: Option<f64>,
    doors_at_least: Option<u32>,
    #[serde(default)]
    reason: String,
}

impl DiskRule {
    fn live(self) -> Result<TemporaryRule, String> {
        let rule = TemporaryRule {
            label: self.label.parse().map_err(|error: super::label::UnknownLabel| error.to_string())?,
            area_at_least_m2: self.area_at_least_m2.unwrap_or(0.0),
            area_below_m2: self.area_below_m2.unwrap_or(f64::INFINITY),
            axes_ratio_at_least: self.axes_ratio_at_least.unwrap_or(0.0),
            doors_at_least: self.doors_at_least.unwrap_or(0),
            reason: self.reason,
        };
        let bounds = [rule.area_at_least_m2, rule.area_below_m2, rule.axes_ratio_at_least];
        if bounds.iter().all(|bound| *bound >= 0.0) {
            Ok(rule)
        } else {
            Err("a bound of a temporary rule is not a number from 0 up".to_owned())
        }
    }
}

impl TemporaryRule {
    /// Whether it holds for a room with this area in m², axes ratio and number of openings.
    pub fn holds(&self, area_m2: f64, axes_ratio: f64, doors: u32) -> bool {
        area_m2 >= self.area_at_least_m2
            && area_m2 < self.area_below_m2
            && axes_ratio >= self.axes_ratio_at_least
            && doors >= self.doors_at_least
    }

    fn takes_all(&self) -> bool {
        self.area_at_least_m2 <= 0.0
            && self.area_below_m2 == f64::INFINITY
            && self.axes_ratio_at_least <= 0.0
            && self.doors_at_least == 0
    }
}

/// The rules of a file. Every room must match one: the last must be unconditional, or the bounds on areas
/// must leave no gap.
pub(super) fn rules(disk: Vec<DiskRule>) -> Result<Vec<TemporaryRule>, String> {
    let rules: Vec<TemporaryRule> = disk.into_iter().map(DiskRule::live).collect::<Result<_, _>>()?;
    // Rooms of any size, however shaped and without an opening: the area bounds must cover them.
    let mut reached = 0.0;
    for rule in rules.iter().filter(|rule| rule.axes_ratio_at_least <= 0.0 && rule.doors_at_least == 0) {
        if rule.area_at_least_m2 <= reached && rule.area_below_m2 > reached {
            reached = rule.area_below_m2;
        }
    }
    match rules.last() {
        Some(last) if !last.takes_all() && reached < f64::INFINITY => {
            Err("the temporary rules leave rooms without a label; end with a rule of a label alone".to_owned())
        }
        _ => Ok(rules),
    }
}

/// The range, over the sources, of the median area in m² of rooms with a label.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UsualArea {
    pub from_m2: f64,
    pub to_m2: f64,
}

impl UsualArea {
    /// How many times larger (above 1) or smaller (below 1) than usual an area is; 1 if within the range.
    pub fn factor(self, area_m2: f64) -> f64 {
        if area_m2 > self.to_m2 {
            area_m2 / self.to_m2
        } else if area_m2 < self.from_m2 {
            area_m2 / self.from_m2
        } else {
            1.0
        }
    }
}

/// The usual areas in a file: `S = [10.0, 18.3]`.
pub(super) fn usual_areas(disk: BTreeMap<String, [f64; 2]>) -> Result<BTreeMap<Label, UsualArea>, String> {
    let area = |(word, [from_m2, to_m2]): (String, [f64; 2])| {
        let label: Label = word.parse().map_err(|error: super::label::UnknownLabel| error.to_string())?;
        if from_m2 > 0.0 && from_m2 <= to_m2 && to_m2.is_finite() {
            Ok((label, UsualArea { from_m2, to_m2 }))
        } else {
            Err(format!("the usual area of {word} is no pair of areas above 0, the smaller first"))
        }
    };
    disk.into_iter().map(area).collect()
}
