//! The interface of a learner: an algorithm that learns labels from a table of rooms, and the model it
//! learned.
//!
//! To add a learner, write a file below `learners/`, its `mod` line and one line in the list of
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
    /// Its name in files and on the command line; never changes.
    fn id(&self) -> &'static str;

    /// The name for people.
    fn title(&self) -> &'static str;

    /// A short name, as for menus; starts with a capital letter.
    fn short_title(&self) -> &'static str;

    /// What it predicts by: completes the sentence 'Predict by …'.
    fn help(&self) -> &'static str;

    /// Learns from labelled rooms. The same table and seed give the same model on any number of threads.
    ///
    /// # Errors
    /// When the work is cancelled.
    fn train(&self, table: &Table, seed: u64, work: &Work<'_>) -> Result<Trained<Arc<dyn Model>>, Cancelled>;

    /// Reads the model that [`Model::to_json`] wrote; `None` if the data are not a valid one.
    #[expect(clippy::wrong_self_convention, reason = "the learner reads a model of its own, the pair of `to_json`")]
    fn from_json(&self, model: Value) -> Option<Arc<dyn Model>>;
}

/// What a learner learned.
pub trait Model: fmt::Debug + Send + Sync {
    /// The distribution over the labels for a room. Any values get an answer.
    fn predict(&self, values: &Values) -> Distribution;

    /// The reason for predicting this label for a room. `predict` predicts at the classifier's
    /// temperature, for models that are explained by querying them again.
    fn explain(&self, values: &Values, label: Label, predict: &dyn Fn(&Values) -> Distribution) -> Reason;

    /// The model for its file: an object whose members [`Learner::from_json`] reads. A list of objects or
    /// lists is written one element per line.
    fn to_json(&self) -> Value;
}

/// A model and the temperature that calibrates its probabilities.
#[derive(Clone, Debug)]
pub struct Trained<M> {
    pub model: M,
    /// See [`Distribution::at_temperature`].
    pub temperature: f64,
}

impl<M: Model + 'static> Trained<M> {
    /// The same, with the type of the model erased.
    pub fn shared(self) -> Trained<Arc<dyn Model>> {
        Trained { model: Arc::new(self.model), temperature: self.temperature }
    }
}
