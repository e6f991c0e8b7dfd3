//! What the check finds in the open plan, in the background: never shown for a plan that has changed since.

use std::collections::BTreeSet;

use egui::Context;

use super::Session;
use super::deriving::is_large;
use super::wishes::Wish;
use crate::app::session::document::Document;
use crate::app::session::jobs::Kind;
use crate::app::session::selection::SelectMode;
use crate::base::wording::count;
use crate::check::{Finding, Severity, check};
use crate::edit::ignore::{heed_finding, ignore_finding};
use crate::geometry::Bounds;
use crate::plan::{ElementId, Ignored, Plan};

/// What was found in a plan.
pub(crate) struct Checked {
    plan: Plan,
    /// What is to be looked at, worst first.
    pub open: Vec<Finding>,
    /// What the plan says to ignore, with the reason.
    pub ignored: Vec<(Finding, String)>,
}

impl Checked {
    fn new(plan: Plan, found: Vec<Finding>) -> Self {
        let (mut open, mut ignored) = (Vec::new(), Vec::new());
        for finding in found {
            match finding.ignored_in(&plan).map(|ignored| ignored.reason.clone()) {
                Some(reason) => ignored.push((finding, reason)),
                None => open.push(finding),
            }
        }
        Self { plan, open, ignored }
    }

    /// How many findings to be looked at have a severity.
    pub(crate) fn count(&self, severity: Severity) -> usize {
        self.open.iter().filter(|finding| finding.severity() == severity).count()
    }

    /// The numbers in words: '1 error, 2 warnings'.
    pub(crate) fn in_words(&self) -> String {
        let named = [(Severity::Error, "error"), (Severity::Warning, "warning"), (Severity::Info, "remark")];
        let counts = named.map(|(severity, name)| (self.count(severity), name));
        let told: Vec<String> =
            counts.iter().filter(|(number, _)| *number > 0).map(|(number, name)| count(*number, name)).collect();
        if told.is_empty() { "nothing found".to_owned() } else { told.join(", ") }
    }

    /// A finding by its place in the list: those to be looked at, then the ignored ones; and whether it is ignored.
    pub(crate) fn get(&self, index: usize) -> Option<(&Finding, bool)> {
        let behind = || self.ignored.get(index.checked_sub(self.open.len())?).map(|(finding, _)| (finding, true));
        self.open.get(index).map(|finding| (finding, false)).or_else(behind)
    }
}

/// The state of the check.
#[derive(Default)]
pub(crate) struct Findings {
    checked: Option<Checked>,
    /// The plan being checked, or that made the check panic.
    begun: Option<Plan>,
    is_running: bool,
    /// The last plan seen, and when it was first seen, in seconds of the window's clock.
    seen: Option<(Plan, f64)>,
    /// The finding that was gone to last, by its place in the list.
    pub current: Option<usize>,
}

/// A large plan is checked once it has not changed for so long, in seconds.
const SETTLED_S: f64 = 0.6;

/// The least size of what is shown around a finding, in metres.
const AROUND_M: f64 = 4.0;

impl Session {
    /// Checks the plan, unless that is done or in progress. One check runs at a time.
    pub(crate) fn check_findings(&mut self, context: &Context) {
        let Some(document) = &self.document else {
            self.findings = Findings::default();
            return;
        };
        let plan = document.plan();
        if self.findings().is_some() || self.findings.is_running {
            return;
        }
        if self.findings.begun.as_ref().is_some_and(|begun| begun.is_same_value(plan)) {
            return;
        }
        let Some(derived) = document.derived() else { return };
        if is_large(plan) && !self.jobs.is_inline() {
            let now = context.input(|input| input.time);
            let since = match &self.findings.seen {
                Some((seen, since)) if seen.is_same_value(plan) => *since,
                _ => now,
            };
            self.findings.seen = Some((plan.clone(), since));
            if now - since < SETTLED_S {
                context.request_repaint_after_secs(SETTLED_S as f32);
                return;
            }
        }
        let (plan, derived, schemes) = (plan.clone(), derived.clone(), self.schemes.clone());
        self.findings.begun = Some(plan.clone());
        self.findings.is_running = true;
        self.findings.current = None;
        let kind = Kind::new("check the plan").if_broken(|session| session.findings.is_running = false);
        self.jobs.start(kind, move |_| {
            let found = check(&plan, &derived.analysis, &schemes);
            let checked = Checked::new(plan, found);
            move |session: &mut Session, context: &Context| {
                session.findings.is_running = false;
                session.findings.checked = Some(checked);
                context.request_repaint();
            }
        });
    }

    /// What was found in the plan as it is now; `None` while it is being checked.
    pub(crate) fn findings(&self) -> Option<&Checked> {
        let plan = self.plan()?;
        self.findings.checked.as_ref().filter(|checked| checked.plan.is_same_value(plan))
    }

    fn finding(&self, number: usize) -> Result<(&Finding, bool), String> {
        let checked = self.findings().ok_or("the plan is still being checked")?;
        let all = checked.open.len() + checked.ignored.len();
        checked.get(number.wrapping_sub(1)).ok_or_else(|| format!("there are {}", count(all, "finding")))
    }

    /// Selects what a finding is about, and brings it into view. Findings count from 1.
    pub(crate) fn go_to_finding(&mut self, number: usize) -> Result<(), String> {
        let (finding, _) = self.finding(number)?;
        let place = finding.place();
        let said = finding.what();
        let Some(document) = &self.document else { return Ok(()) };
        let elements: BTreeSet<ElementId> =
            place.elements.iter().copied().filter(|&element| document.plan().has(element)).collect();
        // Corners only where they are all that it is about.
        let is_corner = |element: &ElementId| matches!(element, ElementId::Corner(_));
        let others: BTreeSet<ElementId> = elements.iter().copied().filter(|element| !is_corner(element)).collect();
        let elements = if others.is_empty() { elements } else { others };
        let bounds = elements.iter().filter_map(|&element| document.bounds_of(element));
        let bounds = bounds.chain(place.at.map(|at| Bounds::of([at]))).fold(Bounds::EMPTY, Bounds::union);
        self.select(elements, SelectMode::Replace);
        if !bounds.is_empty() {
            let short = (AROUND_M - bounds.width().max(bounds.height())).max(0.0) / 2.0;
            self.wishes.push(Wish::ZoomTo(bounds.inflated(short.max(0.5))));
        }
        self.status = said;
        self.findings.current = Some(number - 1);
        Ok(())
    }

    /// Goes to the next finding to be looked at, or a step back.
    pub(crate) fn step_finding(&mut self, step: isize) -> Result<(), String> {
        let checked = self.findings().ok_or("the plan is still being checked")?;
        let number = checked.open.len();
        if number == 0 {
            return Err("there are no findings".to_owned());
        }
        let next = match self.findings.current {
            Some(current) => (current as isize + step).rem_euclid(number as isize) as usize,
            None if step > 0 => 0,
            None => number - 1,
        };
        self.go_to_finding(next + 1)
    }

    /// Does what is right for certain about a finding.
    pub(crate) fn fix_finding(&mut self, number: usize) -> Result<(), String> {
        let (finding, _) = self.finding(number)?;
        let title = finding.fix_title().ok_or("there is no safe fix; see what it says to do")?;
        let finding = finding.clone();
        self.try_edit(title, |plan| finding.fixed(plan)).map_err(|error| error.to_string())?;
        self.status = title.to_owned();
        Ok(())
    }

    /// Ignores a finding from now on, for a reason that the plan keeps.
    pub(crate) fn ignore_finding(&mut self, number: usize, reason: &str) -> Result<(), String> {
        let (finding, _) = self.finding(number)?;
        let (ignored, title) = (finding.as_ignored(reason), finding.kind().title);
        self.try_edit(&format!("Ignore: {title}"), |plan| ignore_finding(plan, ignored))
            .map_err(|error| error.to_string())
    }

    /// No longer ignores a finding.
    pub(crate) fn heed_finding(&mut self, number: usize) -> Result<(), String> {
        let (finding, is_ignored) = self.finding(number)?;
        if !is_ignored {
            return Err("the finding is not ignored".to_owned());
        }
        let (ignored, title): (Ignored, _) = (finding.as_ignored(""), finding.kind().title);
        self.try_edit(&format!("Heed: {title}"), |plan| heed_finding(plan, &ignored)).map_err(|error| error.to_string())
    }

    /// Whether the check of the current plan broke, so that there is nothing to wait for.
    pub(crate) fn is_check_broken(&self) -> bool {
        let is_it = |document: &Document| {
            self.findings.begun.as_ref().is_some_and(|begun| begun.is_same_value(document.plan()))
        };
        self.findings().is_none() && !self.findings.is_running && self.document.as_ref().is_some_and(is_it)
    }
}
