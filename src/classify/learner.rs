//! What a learner is: an algorithm that learns labels from a table of rooms, and what it learned.
//!
//! A new learner is a file below `learners/`, its `mod` line and one line in the list of
//! [`super::learners`]. Training, model files, explanations, the study and its report, the command line,
//! the window's menus and the tests read that list.

use std::fmt;
use std::sync::Arc;

use serde_json::Value;

use super::Distribution;
use super::explain::Reason;
use crate::base::work::{Cancelled, Work};
use crate::dataset::table::{Table, Values};
use crate::labels::Label;

/// An algorithm that learns to label rooms one by one from their features `F_r`.
pub trait Learner: Sync {
    /// The word for files and the command line; never changes.
    fn id(&self) -> &'static str;

    /// The name for people.
    fn title(&self) -> &'static str;

    /// The name where there is little room, as in menus; begins with a capital letter.
    fn short_title(&self) -> &'static str;

    /// What it predicts by, as the end of the sentence 'Predict by …'.
    fn help(&self) -> &'static str;

    /// Learns from labelled rooms. The same table and seed give the same model, however the work is done.
    ///
    /// # Errors
    /// When the work is cancelled.
    fn train(&self, table: &Table, seed: u64, work: &Work<'_>) -> Result<Trained<Arc<dyn Model>>, Cancelled>;

    /// The model that [`Model::to_json`] wrote; `None` if these data do not make a sound one.
    #[expect(clippy::wrong_self_convention, reason = "the learner reads a model of its own, the pair of `to_json`")]
    fn from_json(&self, model: Value) -> Option<Arc<dyn Model>>;
}

/// What a learner learned.
pub trait Model: fmt::Debug + Send + Sync {
    /// The distribution over the labels for a room. Whatever the values are, there is an answer.
    fn predict(&self, values: &Values) -> Distribution;

    /// What the prediction of this label for a room rests on. `predict` gives predictions at the
    /// classifier's temperature, for models that are explained by asking them again.
    fn explain(&self, values: &Values, label: Label, predict: &dyn Fn(&Values) -> Distribution) -> Reason;

    /// The model as its file holds it: an object whose members [`Learner::from_json`] reads. A list of
    /// objects or lists stands one element a line there.
    fn to_json(&self) -> Value;
}

/// A model and the temperature that makes its probabilities believable.
#[derive(Clone, Debug)]
pub struct Trained<M> {
    pub model: M,
    /// See [`Distribution::at_temperature`].
    pub temperature: f64,
}

impl<M: Model + 'static> Trained<M> {
    /// The same, for those who need not know whose model it is.
    pub fn shared(self) -> Trained<Arc<dyn Model>> {
        Trained { model: Arc::new(self.model), temperature: self.temperature }
    }
}
