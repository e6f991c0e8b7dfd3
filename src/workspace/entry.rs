use std::sync::Arc;

use super::Outlines;
use crate::check::{Severity, check};
use crate::classify::models::Models;
use crate::features::RoomStatus;
use crate::geometry::{Point, polygon};
use crate::labels::{Label, Schemes, Typology};
use crate::pipeline::{Asked, Pipeline};
use crate::plan::{LabelOrigin, Plan, RoomId};
use crate::predict::Predictor;

/// What is known of a plan.
#[derive(Clone, Debug, PartialEq)]
pub struct PlanEntry {
    /// As the plan states it; empty if it does not.
    pub name: Box<str>,
    /// The building it states; empty if none.
    pub building: Arc<str>,
    pub storey: Box<str>,
    pub typology: Option<Typology>,
    /// By id.
    pub rooms: Vec<RoomEntry>,
    pub openings: usize,
    /// Rooms that are classified: neither without a boundary nor left blank by the scheme.
    pub to_label: usize,
    /// Those of them with a label.
    pub labelled: usize,
    pub problems: Problems,
    /// Width and height over all rooms and walls, in metres.
    pub size_m: [f32; 2],
    /// What it looks like.
    pub outlines: Outlines,
    /// Whether the rooms have been predicted.
    pub is_predicted: bool,
}

/// Findings of the check that nobody has said to ignore.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Problems {
    pub errors: u32,
    pub warnings: u32,
    /// Worth a look, not necessarily wrong.
    pub infos: u32,
}

impl Problems {
    /// Errors and warnings.
    pub const fn total(&self) -> u32 {
        self.errors + self.warnings
    }
}

/// What is known of a room.
#[derive(Clone, Debug, PartialEq)]
pub struct RoomEntry {
    pub id: RoomId,
    pub name: Box<str>,
    /// As it is written; empty when unknown.
    pub function: Arc<str>,
    pub status: RoomStatus,
    /// Who gave it its own label; `None` for one that follows from its function, or without a label.
    pub origin: Option<LabelOrigin>,
    /// 0 without a boundary.
    pub area_m2: f32,
    /// The middle of its area, in the plan's metres.
    pub centre_m: [f32; 2],
    /// The label that the bundled models and the user's own predict for it, and its probability, 0..=1.
    pub prediction: Option<(Label, f32)>,
}

impl RoomEntry {
    /// Its label, its own or by its function.
    pub const fn label(&self) -> Option<Label> {
        self.status.label()
    }

    /// Whether its label and the prediction are the same; `None` without one of them.
    pub fn agrees(&self) -> Option<bool> {
        Some(self.label()? == self.prediction?.0)
    }
}

impl PlanEntry {
    /// What is to be known of a plan; `models` predict, if there are any to.
    pub fn of(plan: &Plan, schemes: &Schemes, models: Option<&Models>) -> Self {
        let pipeline = Pipeline::new(plan, schemes);
        let analysis = pipeline.analysis();
        let mut problems = Problems::default();
        for finding in check(plan, analysis, schemes) {
            if finding.ignored_in(plan).is_none() {
                match finding.severity() {
                    Severity::Error => problems.errors += 1,
                    Severity::Warning => problems.warnings += 1,
                    Severity::Info => problems.infos += 1,
                }
            }
        }
        let predictor = Predictor::default();
        let predictions = models.and_then(|models| pipeline.predictions(&Asked::by(&predictor, models)).ok());
        let (mut to_label, mut labelled) = (0, 0);
        let rooms: Vec<RoomEntry> = plan
            .rooms()
            .map(|(id, room)| {
                let shape = analysis.shapes.index_of(id).map(|index| &analysis.shapes.all()[index]);
                let outer: &[Point] = shape.map_or(&[], |shape| &shape.outer);
                let area_m2 = shape.map_or(0.0, |shape| shape.area_m2());
                let status = RoomStatus::of(plan, schemes, room);
                if area_m2 > 0.0 && status != RoomStatus::NotClassified {
                    to_label += 1;
                    labelled += usize::from(status.label().is_some());
                }
                let centre = if outer.len() < 3 { Point::new(0.0, 0.0) } else { polygon::centroid(outer) };
                let prediction = predictions.as_ref().and_then(|predictions| {
                    let distribution = predictions.distribution(id)?;
                    let label = distribution.label();
                    Some((label, distribution.probability(label) as f32))
                });
                RoomEntry {
                    id,
                    name: room.name.as_str().into(),
                    function: room.function.as_str().into(),
                    status,
                    origin: room.label.map(|label| label.origin),
                    area_m2: area_m2 as f32,
                    centre_m: [centre.x as f32, centre.y as f32],
                    prediction,
                }
            })
            .collect();
        let meta = plan.meta();
        let bounds = plan.bounds();
        Self {
            name: meta.name.as_str().into(),
            building: meta.building.as_str().into(),
            storey: meta.storey.as_str().into(),
            typology: meta.typology.clone(),
            openings: plan.openings().len(),
            to_label,
            labelled,
            problems,
            size_m: [bounds.width() as f32, bounds.height() as f32],
            outlines: Outlines::of(&analysis.shapes),
            is_predicted: models.is_some(),
            rooms,
        }
    }

    /// The building; where none is stated, the plan is one of its own.
    pub fn building_or_name(&self) -> &str {
        if self.building.is_empty() { &self.name } else { &self.building }
    }

    /// The share of rooms to label that have one, 0..=1; `None` if there are no such rooms.
    pub fn share_labelled(&self) -> Option<f64> {
        (self.to_label > 0).then(|| self.labelled as f64 / self.to_label as f64)
    }

    /// How many rooms have the label that is predicted for them, and how many have both.
    pub fn agreement(&self) -> (usize, usize) {
        let both = self.rooms.iter().filter_map(RoomEntry::agrees);
        both.fold((0, 0), |(same, all), agrees| (same + usize::from(agrees), all + 1))
    }
}
