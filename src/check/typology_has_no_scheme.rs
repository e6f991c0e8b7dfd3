use super::{Check, Context, Kind, Place, Severity};
use crate::labels::Typology;
use crate::plan::titles::{printable, with_article};

/// A plan whose typology has no label scheme.
#[derive(Clone, Debug, PartialEq)]
pub struct TypologyHasNoScheme {
    pub typology: Typology,
}

/// The plan's typology, if it has no scheme.
pub(super) fn typology_without_scheme<'a>(context: &Context<'a>) -> Option<&'a Typology> {
    let typology = context.plan.meta().typology.as_ref()?;
    context.schemes.typologies().all(|known| known != typology).then_some(typology)
}

impl Check for TypologyHasNoScheme {
    const KIND: Kind = Kind {
        name: "typology_has_no_scheme",
        title: "There is no label scheme for the plan's typology",
        severity: Severity::Warning,
        remedy: "correct the typology, or give a label scheme for it (--scheme)",
    };

    fn find(context: &Context) -> Vec<Self> {
        typology_without_scheme(context).map(|typology| Self { typology: typology.clone() }).into_iter().collect()
    }

    fn place(&self) -> Place<'_> {
        Place::default()
    }

    fn what(&self) -> String {
        format!("no label scheme covers {}", with_article(&printable(self.typology.as_str())))
    }
}
