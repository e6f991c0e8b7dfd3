//! The plan of a robot's map with predicted labels: of each room it found, and of the undiscovered room
//! behind each frontier (paper, section 3.3).

use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;

use serde_json::json;

use super::{Choice, Predictor};
use crate::classify::model_file::ModelFileError;
use crate::classify::models::Models;
use crate::dataset::RoomNetwork;
use crate::features::{NeighbourLabels, analyse};
use crate::labels::{Label, Schemes};
use crate::plan::{LabelOrigin, Meta, OpeningId, RoomLabel, Scale, ScaleOrigin, Violation};
use crate::robot::Pose;
use crate::robot::explored_plan::{ExploredPlan, Said, plan as plan_of};
use crate::robot::frontiers::Frontier;
use crate::robot::rooms::FoundRooms;

/// The plan of a map, and what is predicted of it.
#[derive(Clone, Debug)]
pub struct LabelledMap {
    pub explored: ExploredPlan,
    /// The label of each room found.
    pub labels: Vec<Option<Label>>,
    /// For each frontier, the most likely label of the room behind it, and its probability.
    pub behind: Vec<Option<(Label, f64)>>,
    /// Which models predicted, and why; `None` without rooms.
    pub choice: Option<Choice>,
}

/// Why there is no labelled plan.
#[derive(Debug)]
pub enum MapError {
    /// The rooms found do not make a plan.
    Plan(Vec<Violation>),
    /// There is no model.
    Model(ModelFileError),
}

impl fmt::Display for MapError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Plan(violations) => {
                let first = violations.first().map(ToString::to_string).unwrap_or_default();
                write!(f, "the rooms found do not make a plan: {first}; please report this with the seed")
            }
            Self::Model(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for MapError {}

/// The metadata of an explored plan: those of the plan the robot drove in.
pub fn explored_meta(of: &Meta) -> Meta {
    Meta {
        name: of.name.clone(),
        building: of.building.clone(),
        storey: of.storey.clone(),
        typology: of.typology.clone(),
        scale: Scale {
            origin: ScaleOrigin::Measured,
            note: "explored by a simulated robot".to_owned(),
            ..Scale::default()
        },
        source: "explored by a simulated robot".to_owned(),
        licence: of.licence.clone(),
        ..Meta::default()
    }
}

/// The plan of a map with predicted labels. The typology is that of `meta`, or inferred, as the predictor
/// is set.
///
/// # Errors
/// When the rooms do not make a plan, or there is no model.
pub fn labelled(
    found: &FoundRooms,
    frontiers: &[Frontier],
    world_from_map: Pose,
    meta: Meta,
    predictor: &Predictor,
    models: &Models,
) -> Result<LabelledMap, MapError> {
    let make = |said: &Said| plan_of(found, frontiers, world_from_map, meta.clone(), said).map_err(MapError::Plan);
    let bare = make(&Said::default())?;
    if found.rooms.is_empty() {
        return Ok(LabelledMap {
            explored: bare,
            labels: Vec::new(),
            behind: vec![None; frontiers.len()],
            choice: None,
        });
    }
    let analysis = analyse(&bare.plan, &Schemes::bundled(), NeighbourLabels::True);
    let mut network = RoomNetwork::of(&bare.plan, &analysis);
    // A robot's `a` is the mean of two quadrilaterals, not the polygon's area.
    let measured: BTreeMap<_, _> = bare.rooms.iter().zip(&found.rooms).map(|(id, room)| (*id, room)).collect();
    for room in &mut network.rooms {
        if let Some(found) = measured.get(&room.id) {
            room.area_m2 = found.area_m2;
        }
    }
    let known = vec![None; network.rooms.len()];
    let predictions = predictor.predict(network, &known, None, models).map_err(MapError::Model)?;
    let said_of = predictions.labels();
    let labels: Vec<Option<Label>> = bare.rooms.iter().map(|id| said_of.get(id).copied()).collect();
    let unknown: BTreeMap<OpeningId, (Label, f64)> =
        predictions.unknown().into_iter().map(|(_, opening, said)| (opening, said.likeliest())).collect();
    let behind: Vec<Option<(Label, f64)>> =
        bare.frontiers.iter().map(|opening| unknown.get(opening.as_ref()?).copied()).collect();
    let extra = |behind: &Option<(Label, f64)>| {
        let (likely, probability) = (*behind)?;
        let value = json!({ "behind": likely.name(), "probability": (1e4 * probability).round() / 1e4 });
        Some(Arc::new(serde_json::Map::from_iter([("frontier".to_owned(), value)])))
    };
    let origin = LabelOrigin::Prediction;
    let said = Said {
        labels: labels.iter().map(|label| label.map(|label| RoomLabel { label, origin })).collect(),
        behind: behind.iter().map(extra).collect(),
    };
    Ok(LabelledMap { explored: make(&said)?, labels, behind, choice: Some(predictions.choice) })
}
