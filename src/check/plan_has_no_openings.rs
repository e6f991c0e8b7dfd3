use super::{Check, Context, Kind, Place, Severity};

/// A plan of several rooms without a door or passage: every room's features lack its connections.
#[derive(Clone, Debug, PartialEq)]
pub struct PlanHasNoOpenings {
    pub rooms: usize,
}

/// Whether a plan has this finding.
pub(super) fn has_no_openings(context: &Context) -> bool {
    context.shapes().len() > 1 && context.analysis.graph.connections().is_empty()
}

impl Check for PlanHasNoOpenings {
    const KIND: Kind = Kind {
        name: "plan_has_no_openings",
        title: "The plan has no doors or passages",
        severity: Severity::Warning,
        remedy: "draw the doors and passages between the rooms",
    };

    fn find(context: &Context) -> Vec<Self> {
        if has_no_openings(context) { vec![Self { rooms: context.shapes().len() }] } else { Vec::new() }
    }

    fn place(&self) -> Place<'_> {
        Place::default()
    }

    fn what(&self) -> String {
        format!("nothing leads from any of its {} rooms to another", self.rooms)
    }

    fn figures(&self) -> Vec<(&'static str, f64)> {
        vec![("rooms", self.rooms as f64)]
    }
}
