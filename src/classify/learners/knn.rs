//! k nearest neighbours on standardised features; scaling, metric, k and distance weighting are chosen by
//! leave-one-out on the training set.

use std::collections::BTreeMap;
use std::sync::Arc;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::base::random::Random;
use crate::base::work::{Cancelled, Work};
use crate::classify::Distribution;
use crate::classify::calibration::{brier, fitted_temperature};
use crate::classify::explain::{NearRoom, NeighboursReason, Reason};
use crate::classify::learner::{Learner, Model, Trained};
use crate::classify::neighbours::{Found, KdTree, Metric, Point};
use crate::classify::scale::{Scale, Transform};
use crate::dataset::table::{RoomSource, Table, Values};
use crate::labels::Label;

/// Numbers of neighbours tried.
const NUMBERS: [usize; 8] = [1, 3, 5, 7, 9, 12, 16, 20];
const MOST: usize = NUMBERS[NUMBERS.len() - 1];

/// How many rooms, chosen at random, are left out in turn to choose settings; all if there are fewer.
const LEFT_OUT: usize = 400;

/// Strength of Laplace's correction: the labels' shares in training count as much as this many
/// neighbours.
const PRIOR_ROOMS: f64 = 1.0;

/// Weighted by distance, a neighbour counts 1 / (distance + this), so that two nearly identical rooms do
/// not outvote everyone. In standard deviations.
const CLOSEST: f64 = 0.05;

/// The learner.
pub struct NearestNeighbours;

impl Learner for NearestNeighbours {
    fn id(&self) -> &'static str {
        "knn"
    }

    fn title(&self) -> &'static str {
        "k-nearest neighbours"
    }

    fn short_title(&self) -> &'static str {
        "Nearest neighbours"
    }

    fn help(&self) -> &'static str {
        "the most similar rooms that the model learned from, each room by itself"
    }

    fn train(&self, table: &Table, seed: u64, work: &Work<'_>) -> Result<Trained<Arc<dyn Model>>, Cancelled> {
        Ok(Neighbours::train(table, seed, work)?.shared())
    }

    fn from_json(&self, model: Value) -> Option<Arc<dyn Model>> {
        let disk: DiskNeighbours = serde_json::from_value(model).ok()?;
        let plans: Vec<Arc<str>> = disk.plans.into_iter().map(Arc::from).collect();
        let (mut values, mut labels, mut sources) = (Vec::new(), Vec::new(), Vec::new());
        for (room_values, label, plan, room) in disk.rooms {
            values.push(room_values);
            labels.push(label.parse().ok()?);
            sources.push(RoomSource { plan: plans.get(plan)?.clone(), room: room.into() });
        }
        let settings = Settings {
            transform: Transform::from_name(&disk.transform)?,
            metric: Metric::from_name(&disk.metric)?,
            k: disk.k,
            by_distance: disk.by_distance,
        };
        Some(Arc::new(Neighbours::new(Table::from_columns(values, labels, sources).ok()?, settings)))
    }
}

impl Model for Neighbours {
    fn predict(&self, values: &Values) -> Distribution {
        self.predict(values)
    }

    fn explain(&self, values: &Values, _: Label, _: &dyn Fn(&Values) -> Distribution) -> Reason {
        let near = |neighbour: Neighbour| NearRoom {
            source: self.table.sources()[neighbour.row].clone(),
            label: self.table.labels()[neighbour.row],
            values: self.table.values()[neighbour.row],
            distance: neighbour.distance,
        };
        Reason::Neighbours(NeighboursReason { neighbours: self.nearest(values).into_iter().map(near).collect() })
    }

    fn to_json(&self) -> Value {
        let Settings { transform, metric, k, by_distance } = self.settings;
        let mut index_of: BTreeMap<&Arc<str>, usize> = BTreeMap::new();
        let mut plans = Vec::new();
        let rooms = self.table.values().iter().zip(self.table.labels()).zip(self.table.sources());
        let rooms = rooms.map(|((values, label), source)| {
            let plan = *index_of.entry(&source.plan).or_insert_with(|| {
                plans.push(source.plan.to_string());
                plans.len() - 1
            });
            (*values, label.letter().to_owned(), plan, source.room.to_string())
        });
        let rooms = rooms.collect();
        let (metric, transform) = (metric.name().to_owned(), transform.name().to_owned());
        // Plain structs of numbers and texts can always be written.
        serde_json::to_value(DiskNeighbours { k, metric, by_distance, transform, plans, rooms }).unwrap_or_default()
    }
}

#[derive(Serialize, Deserialize)]
struct DiskNeighbours {
    k: usize,
    metric: String,
    by_distance: bool,
    transform: String,
    plans: Vec<String>,
    rooms: Vec<DiskRoom>,
}

/// The values, the label, the index of the plan, and the room's name.
type DiskRoom = (Values, String, usize, String);

/// How neighbours vote.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Settings {
    pub transform: Transform,
    pub metric: Metric,
    /// Number of neighbours.
    pub k: usize,
    /// Whether nearer neighbours count more.
    pub by_distance: bool,
}

/// The training rooms, ready to be searched.
#[derive(Clone, Debug)]
pub struct Neighbours {
    settings: Settings,
    scale: Scale,
    tree: KdTree,
    table: Table,
    prior: Distribution,
}

/// A training room near the one in question.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Neighbour {
    /// Its row in [`Neighbours::table`].
    pub row: usize,
    /// How far, in standard deviations.
    pub distance: f64,
}

impl Neighbours {
    /// Chooses settings and stores the rooms. The same seed gives the same choice.
    ///
    /// # Errors
    /// When the work is cancelled.
    pub fn train(table: &Table, seed: u64, work: &Work<'_>) -> Result<Trained<Self>, Cancelled> {
        let mut left_out: Vec<usize> = (0..table.len()).collect();
        Random::new(seed).shuffle(&mut left_out);
        left_out.truncate(LEFT_OUT);
        let prior = prior_of(table);
        let mut best: Option<Trial> = None;
        for transform in [Transform::Identity, Transform::LightRatio, Transform::Logarithm] {
            let (points, tree) = arranged(table, &Scale::of(table.values(), transform));
            for metric in Metric::ALL {
                work.goes_on()?;
                let neighbours: Vec<Vec<Found>> = left_out
                    .iter()
                    .map(|&row| {
                        let mut found = Vec::with_capacity(MOST);
                        tree.nearest(&points[row], MOST, metric, Some(row as u32), &mut found);
                        found
                    })
                    .collect();
                for (k, by_distance) in NUMBERS.into_iter().flat_map(|k| [(k, false), (k, true)]) {
                    let settings = Settings { transform, metric, k, by_distance };
                    let predictions: Vec<Distribution> =
                        neighbours.iter().map(|found| vote(found, table, &prior, &settings)).collect();
                    // The proper score that follows accuracy most closely.
                    let loss =
                        predictions.iter().zip(&left_out).map(|(p, &row)| brier(p, table.labels()[row])).sum::<f64>();
                    if best.as_ref().is_none_or(|best| loss < best.loss) {
                        best = Some(Trial { loss, settings, predictions });
                    }
                }
            }
        }
        let Trial { settings, predictions, .. } = best.unwrap_or(Trial {
            loss: 0.0,
            settings: Settings { transform: Transform::Logarithm, metric: Metric::Euclidean, k: 5, by_distance: true },
            predictions: Vec::new(),
        });
        let truths = left_out.iter().map(|&row| table.labels()[row]);
        let temperature = fitted_temperature(predictions.into_iter().zip(truths));
        Ok(Trained { model: Self::new(table.clone(), settings), temperature })
    }

    /// These rooms with these settings; `k` is clamped to 1 and their number.
    pub fn new(table: Table, settings: Settings) -> Self {
        let scale = Scale::of(table.values(), settings.transform);
        let tree = arranged(&table, &scale).1;
        let prior = prior_of(&table);
        Self { settings: Settings { k: settings.k.clamp(1, table.len()), ..settings }, scale, tree, table, prior }
    }

    pub fn settings(&self) -> Settings {
        self.settings
    }

    /// The training rooms.
    pub fn table(&self) -> &Table {
        &self.table
    }

    /// The nearest training rooms, nearest first.
    pub fn nearest(&self, values: &Values) -> Vec<Neighbour> {
        let neighbour = |found: &Found| Neighbour { row: found.index as usize, distance: f64::from(found.distance) };
        self.found(values).iter().map(neighbour).collect()
    }

    fn found(&self, values: &Values) -> Vec<Found> {
        let mut found = Vec::with_capacity(self.settings.k);
        self.tree.nearest(&self.scale.apply(values), self.settings.k, self.settings.metric, None, &mut found);
        found
    }

    /// The votes of the nearest training rooms, with Laplace's correction towards the labels' shares.
    pub fn predict(&self, values: &Values) -> Distribution {
        vote(&self.found(values), &self.table, &self.prior, &self.settings)
    }
}

/// Settings that were tried.
struct Trial {
    loss: f64,
    settings: Settings,
    predictions: Vec<Distribution>,
}

fn prior_of(table: &Table) -> Distribution {
    Distribution::from_weights(table.label_counts().map(|count| count as f64))
}

fn arranged(table: &Table, scale: &Scale) -> (Vec<Point>, KdTree) {
    let points: Vec<Point> = table.values().iter().map(|values| scale.apply(values)).collect();
    let tree = KdTree::new(&points);
    (points, tree)
}

/// The votes of the first `k` found. Weights by distance are scaled to the sum `k`.
fn vote(found: &[Found], table: &Table, prior: &Distribution, settings: &Settings) -> Distribution {
    let found = &found[..settings.k.min(found.len())];
    let mut votes = [0.0; 5];
    let mut sum = 0.0;
    for found in found {
        let weight = if settings.by_distance { 1.0 / (f64::from(found.distance) + CLOSEST) } else { 1.0 };
        votes[table.labels()[found.index as usize].index()] += weight;
        sum += weight;
    }
    let share = if sum > 0.0 { found.len() as f64 / sum } else { 0.0 };
    Distribution::smoothed(votes.map(|vote| vote * share), prior, PRIOR_ROOMS)
}
