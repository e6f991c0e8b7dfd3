use super::{Check, Context, Kind, Place, Severity};
use crate::plan::Violation;

/// The plan breaks an invariant of the model (see [`crate::plan::Plan::violations`]): a damaged file, or
/// a bug in Enfilade.
#[derive(Clone, Debug, PartialEq)]
pub struct InvariantIsBroken {
    pub violation: Violation,
}

impl Check for InvariantIsBroken {
    const KIND: Kind = Kind {
        name: "invariant_is_broken",
        title: "An invariant of the model is broken",
        severity: Severity::Error,
        remedy: "restore the file from an earlier version; if Enfilade wrote it so, report the bug",
    };

    fn find(context: &Context) -> Vec<Self> {
        context.plan.violations().into_iter().map(|violation| Self { violation }).collect()
    }

    fn place(&self) -> Place<'_> {
        Place { elements: vec![self.violation.element], ..Place::default() }
    }

    fn what(&self) -> String {
        self.violation.to_string()
    }
}
