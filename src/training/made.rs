//! Models as files: what they learned from, and blends of them.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::{Made, Order, TrainError, Trained, wrong};
use crate::classify::blend::{self, Blend, By, Part};
use crate::classify::learned::Learned;
use crate::classify::model_file::{self, About, DataSummary, Parts, ScoreSummary};
use crate::classify::models::StoredModel;
use crate::classify::{Classifier, Distribution, Method, Scores};
use crate::dataset::fingerprint::RoomPrint;
use crate::dataset::folds::Grouping;
use crate::dataset::sets::set_name;
use crate::dataset::table::Table;
use crate::dataset::{Collection, Row};
use crate::features::NeighbourLabels;
use crate::labels::{Label, Typology};
use crate::study::predictions::Prediction;

/// A model from its file's bytes.
pub(super) fn made(
    set: &str,
    method: Method,
    bytes: Vec<u8>,
    scores: Vec<(Grouping, Scores)>,
    parts: Parts<'_>,
) -> Result<Made, TrainError> {
    let (classifier, about, checksum) = model_file::from_bytes(&bytes, parts).map_err(wrong)?;
    let name = format!("{set}-{}", method.name());
    let model = Arc::new(StoredModel { name, path: None, classifier, about, checksum });
    Ok(Made { set: set.to_owned(), method, bytes, scores, model })
}

/// What tells the rooms of a part again, and which of them were right out of fold: on buildings never seen, or else by room. `None` for
/// rows of a file.
pub(super) fn learned(part: &Collection, method: Method, predictions: &[Prediction]) -> Option<Learned> {
    let prints = prints(part);
    let rows = part.rows(NeighbourLabels::True)?;
    let right_by = |by: Grouping| {
        let mut right: Vec<Option<bool>> = vec![None; rows.len()];
        for it in predictions.iter().filter(|it| it.method == method && it.condition.by == by) {
            right[it.row] = Some(it.said.label() == rows[it.row].label);
        }
        Some((right.into_iter().collect::<Option<Vec<bool>>>()?, by.name()))
    };
    let right = [Grouping::Building, Grouping::Room].into_iter().find_map(right_by);
    let right = right.as_ref().map(|(right, by)| (right.as_slice(), *by));
    (!prints.is_empty()).then(|| Learned::new(prints, right))
}

fn prints(part: &Collection) -> Vec<&RoomPrint> {
    let print = |place: crate::dataset::RoomPlace| &part.networks()[place.network].rooms[place.room].print;
    part.places().into_iter().map(print).collect()
}

impl Trained {
    /// What was said of some rooms of a set by classifiers that had not seen their building, and the folds. Shorter than the
    /// list of rooms where something is missing.
    fn by_building(&self, set: &str, method: Method, rooms: &[usize]) -> (Vec<Distribution>, Vec<usize>) {
        let said = if matches!(method, Method::Each(_)) { &self.by_committees } else { &self.said };
        let told = said.get(set).into_iter().flatten();
        let told = told.filter(|it| it.method == method && it.condition.by == Grouping::Building);
        let of_row: BTreeMap<usize, (Distribution, usize)> = told.map(|it| (it.row, (it.said, it.fold))).collect();
        rooms.iter().filter_map(|room| of_row.get(room).copied()).unzip()
    }

    /// The blend of a set's models and of the standard ones. `None` where there is nothing to blend.
    pub(super) fn blend(
        &self,
        typology: Option<&Typology>,
        part: &Collection,
        all: &Collection,
        committee: Option<Classifier>,
        order: &Order,
    ) -> Result<Option<Made>, TrainError> {
        let set = set_name(typology);
        let rows = part.rows(NeighbourLabels::Predicted).unwrap_or_default();
        let labels: Vec<Label> = rows.iter().map(|row| row.label).collect();
        // The set's rooms among all rooms, by which the standard models were validated.
        let all_rows: Vec<Row> = all.rows(NeighbourLabels::Predicted).unwrap_or_default();
        let among_all: Vec<usize> = (0..all_rows.len())
            .filter(|&row| typology.is_none() || all_rows[row].typology.as_ref() == typology)
            .collect();
        let among_own: Vec<usize> = (0..rows.len()).collect();
        let (mut parts, mut unseen, mut folds) = (Vec::new(), Vec::new(), Vec::new());
        for (of, method, weight) in blend::recipe(set) {
            let by = match method {
                Method::Joint => self.joints.get(of).map(|model| By::Model(model.clone())),
                // The recipe asks for no perceptrons of another set.
                _ => committee.clone().map(|classifier| By::Committee { set: of.to_owned(), classifier }),
            };
            let Some(by) = by else { continue };
            parts.push(Part { weight, by });
            let (said, of_folds) = self.by_building(of, method, if of == set { &among_own } else { &among_all });
            unseen.push((weight, said));
            if folds.is_empty() {
                folds = of_folds;
            }
        }
        let tested = blend::blend_unseen(&unseen, &labels, &folds);
        let temperature = tested.as_ref().map_or(1.0, |tested| tested.temperature);
        let Some(blend) = Blend::new(parts, temperature) else { return Ok(None) };
        let right: Option<Vec<bool>> = tested
            .as_ref()
            .map(|tested| tested.said.iter().zip(&labels).map(|(said, label)| said.label() == *label).collect());
        let right = right.as_ref().map(|right| (right.as_slice(), Grouping::Building.name()));
        let scores: Vec<(Grouping, Scores)> = tested
            .iter()
            .map(|tested| {
                let of_rooms = folds.iter().zip(&tested.said).zip(&labels);
                (Grouping::Building, Scores::of(of_rooms.map(|((&fold, said), &label)| (fold, said, label))))
            })
            .collect();
        let about = About {
            typology: typology.cloned(),
            neighbours: NeighbourLabels::Predicted,
            command: order.command_line(typology, Method::Blend, NeighbourLabels::Predicted),
            program: format!("enfilade {}", env!("CARGO_PKG_VERSION")),
            seed: order.seed,
            licence: order.licence.clone(),
            data: DataSummary::of(&rows, &Table::from_rows(&rows).map_err(wrong)?),
            scores: scores.iter().map(|(by, scores)| ScoreSummary::of(scores, *by, order.seed)).collect(),
            learned: Some(Learned::new(prints(part), right)),
        };
        let bytes = model_file::to_bytes(&blend.into(), &about);
        let parts = |name: &str| {
            let part = self.joints.values().find(|model| model.name == name)?;
            let part: Arc<dyn blend::Member> = part.clone();
            Some(part)
        };
        made(set, Method::Blend, bytes, scores, &parts).map(Some)
    }
}
