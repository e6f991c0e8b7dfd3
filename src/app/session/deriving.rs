//! Analysing the open plan: at once if that is fast, otherwise in a background job.

use std::sync::Arc;

use super::Session;
use crate::app::session::document::{Derived, Labelled, LabelledBy};
use crate::app::session::jobs::Kind;
use crate::plan::Plan;

/// The size of plan that is analysed in the background; below this, analysis takes a few milliseconds.
const LARGE_PLAN_ELEMENTS: usize = 2000;

/// Whether a plan is too large to be analysed within a frame.
pub(super) fn is_large(plan: &Plan) -> bool {
    plan.rooms().len() + plan.openings().len() + plan.walls().len() > LARGE_PLAN_ELEMENTS
}

impl Session {
    /// Analyses the current plan, unless that is done or in progress.
    pub(crate) fn derive(&mut self) {
        let Some(document) = &mut self.document else { return };
        document.label_by(&LabelledBy { predictor: self.predictor.clone(), second: self.live.second });
        let plan = document.plan().clone();
        let is_needed = document.needs_deriving();
        self.keep_selected_what_is_in(&plan);
        if !is_needed {
            return;
        }
        let Some(document) = &mut self.document else { return };
        let (schemes, models) = (self.schemes.clone(), self.models.clone());
        let by = LabelledBy { predictor: self.predictor.clone(), second: self.live.second };
        let before = document.last_labelled().cloned();
        if !is_large(&plan) {
            let labelled = Arc::new(Labelled::new(&plan, &schemes, Some((&by, &models)), before.as_deref()));
            let derived = Arc::new(Derived::from_labelled(labelled));
            document.set_derived(plan, derived);
            return;
        }
        let number = document.number;
        let broken_for = plan.clone();
        let kind = Kind::new("analyse the plan").newest_of("analysis").if_broken(move |session| {
            let document = session.document.as_mut().filter(|document| document.number == number);
            if let Some(document) = document {
                document.could_not_be_derived(&broken_for);
            }
        });
        // First the labels, which are shown at once; then the rest, which takes longer.
        let wanted = match document.labelled().cloned() {
            None => self.jobs.start_wanted(kind, move |work| {
                let is_wanted = work.goes_on().is_ok();
                let labelled =
                    is_wanted.then(|| Labelled::new(&plan, &schemes, Some((&by, &models)), before.as_deref()));
                move |session: &mut Session, _: &_| {
                    if let Some((document, labelled)) = session.document.as_mut().zip(labelled) {
                        document.set_labelled(Arc::new(labelled));
                    }
                }
            }),
            Some(labelled) => self.jobs.start_wanted(kind, move |work| {
                let derived = Derived::by_steps(labelled, work).map(Arc::new);
                move |session: &mut Session, _: &_| {
                    if let Some((document, derived)) = session.document.as_mut().zip(derived.ok()) {
                        document.set_derived(plan, derived);
                    }
                }
            }),
        };
        document.await_derived(wanted);
    }
}
