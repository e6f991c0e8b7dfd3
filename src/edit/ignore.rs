//! Leaving findings of the check as they are, with a reason that is kept in the plan.

use super::{EditError, fail};
use crate::plan::Plan;
use crate::plan::ignored::{Ignored, MOST_IGNORED};

/// The longest reason, in letters.
const LONGEST_REASON: usize = 500;

/// Ignores a finding from now on, instead of what was said of it before. Those about elements that are no longer there
/// go on the occasion.
///
/// # Errors
/// Without a reason, with one that is too long, or when the plan ignores too many already.
pub fn ignore_finding(plan: &Plan, ignored: Ignored) -> Result<Plan, EditError> {
    let reason = ignored.reason.trim();
    if reason.is_empty() {
        return fail("give a reason; it is kept in the plan".to_owned());
    }
    if reason.chars().count() > LONGEST_REASON || reason.chars().any(char::is_control) {
        return fail(format!("a reason is one line of at most {LONGEST_REASON} letters"));
    }
    let is_there =
        |other: &&Ignored| !other.is_about(&ignored) && other.elements.iter().all(|&element| plan.has(element));
    let kept: Vec<Ignored> = plan.ignored().iter().filter(is_there).cloned().collect();
    if kept.len() >= MOST_IGNORED {
        return fail(format!("a plan ignores at most {MOST_IGNORED} findings"));
    }
    Ok(plan.with_ignored(kept.into_iter().chain([ignored])))
}

/// No longer ignores a finding.
///
/// # Errors
/// When it is not ignored.
pub fn heed_finding(plan: &Plan, ignored: &Ignored) -> Result<Plan, EditError> {
    if !plan.ignored().iter().any(|other| other.is_about(ignored)) {
        return fail("the finding is not ignored".to_owned());
    }
    Ok(plan.with_ignored(plan.ignored().iter().filter(|other| !other.is_about(ignored)).cloned()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_finding_is_ignored_once_with_the_last_reason() {
        let plan = Plan::default();
        let of = |reason: &str| Ignored::new("plan_has_no_rooms", [], reason);
        let once = ignore_finding(&plan, of("a site plan")).unwrap();
        let twice = ignore_finding(&once, of(" a sketch ")).unwrap();
        assert_eq!(twice.ignored().iter().map(|it| it.reason.as_str()).collect::<Vec<_>>(), ["a sketch"]);
        assert_eq!(heed_finding(&twice, &of("")).unwrap().ignored(), []);
        assert!(heed_finding(&plan, &of("")).is_err());
        for reason in [" ", "two\nlines", &"long".repeat(200)] {
            assert!(ignore_finding(&plan, of(reason)).is_err(), "{reason}");
        }
    }
}
