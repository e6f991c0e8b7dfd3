use super::explain::Explanation;
use std::sync::Arc;

use super::learner::{Model, Trained};
use super::{Algorithm, Distribution};
use crate::base::work::{Cancelled, Work};
use crate::dataset::table::{Table, Values};

/// A trained classifier: from `F_r` to a distribution over the labels.
#[derive(Clone, Debug)]
pub struct Classifier {
    algorithm: Algorithm,
    model: Arc<dyn Model>,
    temperature: f64,
}

impl Classifier {
    /// Learns from labelled rooms. The same table and seed give the same classifier.
    ///
    /// # Errors
    /// When the work is cancelled.
    pub fn train(algorithm: Algorithm, table: &Table, seed: u64, work: &Work<'_>) -> Result<Self, Cancelled> {
        let Trained { model, temperature } = algorithm.learner().train(table, seed, work)?;
        Ok(Self::from_parts(algorithm, model, temperature))
    }

    /// A classifier from its parts. A temperature that is not a positive number counts as 1.
    pub fn from_parts(algorithm: Algorithm, model: Arc<dyn Model>, temperature: f64) -> Self {
        let temperature = if temperature.is_finite() && temperature > 0.0 { temperature } else { 1.0 };
        Self { algorithm, model, temperature }
    }

    pub fn algorithm(&self) -> Algorithm {
        self.algorithm
    }

    pub fn model(&self) -> &dyn Model {
        &*self.model
    }

    /// See [`Distribution::at_temperature`].
    pub fn temperature(&self) -> f64 {
        self.temperature
    }

    /// The distribution over the labels for a room. Any values get an answer.
    pub fn predict(&self, values: &Values) -> Distribution {
        self.model.predict(values).at_temperature(self.temperature)
    }
}

impl Classifier {
    /// The prediction for a room and the reason for it.
    pub fn explain(&self, values: &Values) -> Explanation {
        let distribution = self.predict(values);
        let label = distribution.label();
        let reason = self.model().explain(values, label, &|values| self.predict(values));
        Explanation { label, distribution, values: *values, reason }
    }
}
