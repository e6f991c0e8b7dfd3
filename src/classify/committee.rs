//! A committee: perceptrons, each of which learned from a random half of the buildings; what they say is averaged (Breiman 1996).
//! What a perceptron says of a building unlike those it learned from is partly chance, and the mean of several is less so.
//! `docs/blend.md` has what that is worth.

use std::sync::Arc;

use serde_json::{Value, json};

use super::explain::Reason;
use super::learner::{Model, Trained};
use super::learners::mlp::Perceptron;
use super::{Algorithm, Classifier, Distribution, in_plan};
use crate::base::random::{Random, seed_of_part};
use crate::base::work::{Cancelled, Work};
use crate::dataset::folds::{Grouping, group_of};
use crate::dataset::table::{Table, Values};
use crate::dataset::{RoomNetwork, RoomPlace, Row};
use crate::labels::Label;

/// Perceptrons of a committee: more change little.
pub const MEMBERS: usize = 10;

/// A file's committee has at most this many.
const MOST_MEMBERS: usize = 100;

/// Perceptrons, each at its own temperature, whose mean is the answer. There is at least one, and all transform features alike.
#[derive(Debug)]
struct Committee(Vec<Trained<Perceptron>>);

/// Trains a committee of [`MEMBERS`], each on half of the buildings, rounded up, with the labels of neighbours predicted as
/// [`in_plan::rows_with_predicted_neighbours`] does, whose parameters these are. The same rooms and seed give the same committee on
/// any number of threads. `None` if there is no room to learn from.
///
/// # Errors
/// When the work is cancelled.
pub fn train(
    networks: &[RoomNetwork],
    rows: &[Row],
    places: &[RoomPlace],
    training: &[usize],
    seed: u64,
    work: &Work<'_>,
) -> Result<Option<Classifier>, Cancelled> {
    let mut buildings: Vec<&str> = training.iter().map(|&row| group_of(&rows[row])).collect();
    buildings.sort_unstable();
    buildings.dedup();
    let member = |member: usize| -> Result<Option<Trained<Perceptron>>, Cancelled> {
        let (seed, work) = (seed_of_part(seed, member), work.alone());
        let mut half = buildings.clone();
        Random::new(seed).shuffle(&mut half);
        half.truncate(buildings.len().div_ceil(2));
        half.sort_unstable();
        let is_taught = |row: &usize| half.binary_search(&group_of(&rows[*row])).is_ok();
        let taught: Vec<usize> = training.iter().copied().filter(is_taught).collect();
        let (algorithm, by) = (Algorithm::PERCEPTRON, Grouping::Building);
        let taught =
            in_plan::rows_with_predicted_neighbours(networks, rows, places, &taught, algorithm, by, seed, &work)?;
        Table::from_rows(&taught).ok().map(|table| Perceptron::train(&table, seed, &work)).transpose()
    };
    let trained: Result<Vec<_>, Cancelled> = work.map(MEMBERS, member)?.into_iter().collect();
    let members: Vec<Trained<Perceptron>> = trained?.into_iter().flatten().collect();
    Ok((!members.is_empty()).then(|| together(members)))
}

fn together(members: Vec<Trained<Perceptron>>) -> Classifier {
    Classifier::from_parts(Algorithm::PERCEPTRON, Arc::new(Committee(members)), 1.0)
}

/// Reads a committee from the data that its [`Model::to_json`] gave.
///
/// # Errors
/// When they make none: what is wrong, in words.
pub fn from_value(value: &Value) -> Result<Classifier, String> {
    let listed = value.get("members").and_then(Value::as_array).ok_or("its committee lists no members")?;
    if listed.is_empty() || listed.len() > MOST_MEMBERS {
        return Err(format!("its committee has {} members, where 1 to {MOST_MEMBERS} make sense", listed.len()));
    }
    let mut members: Vec<Trained<Perceptron>> = Vec::with_capacity(listed.len());
    for (index, member) in listed.iter().enumerate() {
        let wrong = |what: &str| format!("member {} of its committee {what}", index + 1);
        let temperature = member.get("temperature").and_then(Value::as_f64).filter(|it| (1e-3..=1e3).contains(it));
        let temperature = temperature.ok_or_else(|| wrong("has no temperature between 0.001 and 1000"))?;
        let model = member.get("model").cloned().and_then(Perceptron::read);
        let model = model.ok_or_else(|| wrong("is no multilayer perceptron"))?;
        if members.first().is_some_and(|first| first.model.scale().transform != model.scale().transform) {
            return Err(wrong("transforms features otherwise than the first"));
        }
        members.push(Trained { model, temperature });
    }
    Ok(together(members))
}

impl Model for Committee {
    fn predict(&self, values: &Values) -> Distribution {
        let transformed = self.0[0].model.scale().transform.of(values);
        let mut sums = [0.0; Label::ALL.len()];
        for Trained { model, temperature } in &self.0 {
            let said = model.predict_transformed(&transformed, *temperature);
            sums.iter_mut().zip(said).for_each(|(sum, probability)| *sum += f64::from(probability));
        }
        Distribution::from_weights(sums)
    }

    fn explain(&self, values: &Values, label: Label, predict: &dyn Fn(&Values) -> Distribution) -> Reason {
        // The first one's way of explaining, by the answers of all.
        self.0[0].model.explain(values, label, predict)
    }

    fn to_json(&self) -> Value {
        let member = |of: &Trained<Perceptron>| json!({ "temperature": of.temperature, "model": of.model.to_json() });
        json!({ "members": self.0.iter().map(member).collect::<Vec<_>>() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_committee_says_the_mean_and_reads_back_the_same() {
        let networks: Vec<RoomNetwork> = crate::store::bundled_plans()
            .unwrap()
            .iter()
            .map(|(_, plan)| RoomNetwork::new(plan, &crate::labels::Schemes::bundled()))
            .collect();
        let collection = crate::dataset::Collection::Plans(networks.clone());
        let rows = collection.rows(crate::features::NeighbourLabels::Predicted).unwrap();
        let all: Vec<usize> = (0..rows.len()).collect();
        let train = |rooms: &[usize], threads: usize| {
            let (places, work) = (collection.places(), Work::quiet().on_threads(threads));
            train(&networks, &rows, &places, rooms, 3, &work).unwrap()
        };
        let committee = train(&all, 2).unwrap();
        let json = committee.model().to_json();
        assert_eq!(train(&all, 1).unwrap().model().to_json(), json);
        let read = from_value(&json).unwrap();
        let alone: Vec<Classifier> = json["members"]
            .as_array()
            .unwrap()
            .iter()
            .map(|member| {
                let model = Perceptron::read(member["model"].clone()).unwrap();
                Classifier::from_parts(Algorithm::PERCEPTRON, Arc::new(model), member["temperature"].as_f64().unwrap())
            })
            .collect();
        assert_eq!(alone.len(), MEMBERS);
        for row in &rows {
            let values = row.features.values();
            let said = committee.predict(&values);
            assert_eq!(read.predict(&values), said);
            let of_members: Vec<Distribution> = alone.iter().map(|member| member.predict(&values)).collect();
            let mean = Distribution::mean(&of_members, &[1.0; MEMBERS]);
            for label in Label::ALL {
                assert!((mean.probability(label) - said.probability(label)).abs() < 1e-5);
            }
        }
        assert!(train(&[], 1).is_none());
    }

    #[test]
    fn what_is_no_committee_is_refused_in_words() {
        let refused = |value: Value| from_value(&value).unwrap_err();
        assert_eq!(refused(json!({})), "its committee lists no members");
        assert_eq!(refused(json!({ "members": [] })), "its committee has 0 members, where 1 to 100 make sense");
        let many = vec![json!({}); 101];
        assert_eq!(refused(json!({ "members": many })), "its committee has 101 members, where 1 to 100 make sense");
        let cold = json!({ "members": [{ "temperature": 0.0 }] });
        assert_eq!(refused(cold), "member 1 of its committee has no temperature between 0.001 and 1000");
        let hollow = json!({ "members": [{ "temperature": 1.0, "model": { "units": [] } }] });
        assert_eq!(refused(hollow), "member 1 of its committee is no multilayer perceptron");
    }
}
