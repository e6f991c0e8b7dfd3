use super::{Check, Context, Kind, Place, Severity};

/// A plan without a typology: no label scheme applies, so only rooms with a label of their own are
/// labelled.
#[derive(Clone, Debug, PartialEq)]
pub struct PlanHasNoTypology;

impl Check for PlanHasNoTypology {
    const KIND: Kind = Kind {
        name: "plan_has_no_typology",
        title: "The plan has no typology",
        severity: Severity::Warning,
        remedy: "choose house, school, office or a typology of your own",
    };

    fn find(context: &Context) -> Vec<Self> {
        if context.plan.meta().typology.is_none() { vec![Self] } else { Vec::new() }
    }

    fn place(&self) -> Place<'_> {
        Place::default()
    }

    fn what(&self) -> String {
        "without it, functions give rooms no labels".to_owned()
    }
}
