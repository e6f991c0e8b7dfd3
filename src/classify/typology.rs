//! Infers the typology of a plan from the plan itself: the paper's future work. Described for readers in
//! `docs/joint.md`.
//!
//! Eight measures of the whole plan ([`Measure`]) are compared with those of known plans by Fisher's
//! linear discriminant (1936): each typology has a mean, and all share one covariance, so that correlated
//! measures are not counted twice. If labels of rooms are known, their frequencies count too. Before any
//! evidence all typologies are equally likely, however many training plans each had.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

use nalgebra::{Cholesky, Const, SMatrix, SVector};
use serde_json::{Value, json};

use crate::base::random::Random;
use crate::base::units::Units;
use crate::dataset::RoomNetwork;
use crate::labels::{Label, Typology};
use crate::plan::OpeningKind;

/// A measure of a plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Measure {
    /// Number of rooms.
    Rooms,
    /// Median area of the rooms.
    MedianArea,
    /// Variation of areas: the standard deviation of their logarithms.
    Spread,
    /// The largest room's area as a multiple of the median.
    Largest,
    /// Mean number of openings of a room.
    Openings,
    /// Share of rooms connected to at most one other room.
    Ends,
    /// Share of rooms more than 2.7 times as long as wide.
    Long,
    /// Free passages as a share of openings.
    Passages,
}

const MEASURES: usize = 8;

type Measures = SVector<f64, MEASURES>;

type Covariance = SMatrix<f64, MEASURES, MEASURES>;

impl Measure {
    pub const ALL: [Self; MEASURES] = [
        Self::Rooms,
        Self::MedianArea,
        Self::Spread,
        Self::Largest,
        Self::Openings,
        Self::Ends,
        Self::Long,
        Self::Passages,
    ];

    /// Its name in files.
    pub const fn name(self) -> &'static str {
        ["rooms", "median_area", "spread", "largest", "openings", "ends", "long", "passages"][self as usize]
    }

    /// A value with its unit. Counts, areas and ratios are measured as logarithms.
    fn value(self, value: f64, units: Units) -> String {
        match self {
            Self::Rooms => format!("{:.0}", value.exp()),
            Self::MedianArea => units.area(value.exp()),
            Self::Spread | Self::Largest | Self::Openings => format!("{:.1}", value.exp()),
            Self::Ends | Self::Long | Self::Passages => format!("{:.0} %", value * 100.0),
        }
    }

    /// A sentence about a value with its unit.
    fn words(self, value: &str) -> String {
        match self {
            Self::Rooms => format!("it has {value} rooms"),
            Self::MedianArea => format!("half of its rooms are over {value}"),
            Self::Spread => format!("its rooms differ in area by a factor of {value}"),
            Self::Largest => format!("its largest room is {value} times the median"),
            Self::Openings => format!("its rooms have {value} openings on average"),
            Self::Ends => format!("{value} of its rooms open to at most one other"),
            Self::Long => format!("{value} of its rooms are long and narrow"),
            Self::Passages => format!("{value} of its openings have no door"),
        }
    }
}

/// Smaller areas and ratios are raised to this.
const LEAST: f64 = 1e-6;

/// The measures of a plan with at least one room; all finite. Of a storey of flats the mean of its flats' measures: three
/// dwellings beside each other have as many rooms as an office.
fn measures(network: &RoomNetwork) -> Option<Measures> {
    let Some(flats) = network.flats() else { return measures_of(network) };
    let of_flats: Option<Vec<Measures>> = flats.flats.iter().map(|flat| measures_of(&network.part(flat))).collect();
    let of_flats = of_flats.filter(|of_flats| !of_flats.is_empty())?;
    Some(of_flats.iter().sum::<Measures>() / of_flats.len() as f64)
}

/// The measures of a plan as it is drawn: what is learned from.
fn measures_of(network: &RoomNetwork) -> Option<Measures> {
    if network.rooms.is_empty() {
        return None;
    }
    let rooms = network.rooms.len() as f64;
    let mut areas: Vec<f64> = network.rooms.iter().map(|room| room.area_m2.max(LEAST).ln()).collect();
    areas.sort_by(f64::total_cmp);
    let median = (areas[(areas.len() - 1) / 2] + areas[areas.len() / 2]) / 2.0;
    let mean = areas.iter().sum::<f64>() / rooms;
    let variance = areas.iter().map(|area| (area - mean).powi(2)).sum::<f64>() / rooms;
    let share = |is: &dyn Fn(&crate::dataset::NetworkRoom) -> bool| {
        network.rooms.iter().filter(|room| is(room)).count() as f64 / rooms
    };
    let openings: usize = network.rooms.iter().map(|room| room.doors.len()).sum();
    let doors = network.rooms.iter().flat_map(|room| &room.doors);
    let passages = doors.filter(|door| door.kind == OpeningKind::Passage).count();
    let ends = share(&|room| {
        let mut joined = room.doors.iter().filter_map(|door| door.to);
        joined.next().is_none_or(|first| joined.all(|other| other == first))
    });
    let largest = areas.last().map_or(0.0, |largest| largest - median);
    let measures = Measures::from([
        rooms.ln(),
        median,
        variance.sqrt(),
        largest,
        (openings as f64 / rooms).max(0.1).ln(),
        ends,
        share(&|room| room.axes_ratio > std::f64::consts::E),
        passages as f64 / (openings.max(1)) as f64,
    ]);
    measures.iter().all(|measure| measure.is_finite()).then_some(measures)
}

/// What was learned of one typology.
#[derive(Clone, Debug, PartialEq)]
struct Known {
    typology: Typology,
    plans: usize,
    mean: Measures,
    /// Label shares among its labelled rooms, each above 0.
    labels: [f64; 5],
}

/// Infers typologies.
#[derive(Clone, Debug, PartialEq)]
pub struct TypologyModel {
    /// By typology, at least one.
    known: Vec<Known>,
    /// The shared covariance, shrunk, positive definite.
    covariance: Covariance,
    left_out: BTreeSet<Measure>,
    /// The evidence is divided by this, to calibrate the posterior.
    temperature: f64,
}

/// No plan with rooms has a typology.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NoTypologies;

impl fmt::Display for NoTypologies {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("there are no plans of a known typology to learn from; set the typology of some plans")
    }
}

impl std::error::Error for NoTypologies {}

/// Shrinkage of the covariance towards its diagonal: 16 plans of a kind do not determine 28 numbers well.
const SHRINKAGE: f64 = 0.1;

/// The least variance of a measure, so that one that never varied does not decide alone.
const LEAST_VARIANCE: f64 = 1e-3;

/// How strongly labels within a building are correlated, as the number of rooms of prior belief in
/// Pólya's urn: with it a plan's third bathroom says less than its first.
const URN: f64 = 10.0;

/// Folds for finding the temperature.
const INNER_FOLDS: usize = 5;

/// Temperatures tried.
const TEMPERATURES: std::ops::RangeInclusive<u32> = 5..=40;

impl TypologyModel {
    /// Learns from the plans whose typology is known, best given as if it were not:
    /// [`RoomNetwork::without_typology`].
    ///
    /// # Errors
    /// When there are none with rooms.
    pub fn train(networks: &[&RoomNetwork]) -> Result<Self, NoTypologies> {
        Self::train_without(networks, &BTreeSet::new())
    }

    /// The same without some measures, to see their effect.
    ///
    /// # Errors
    /// As [`TypologyModel::train`].
    pub fn train_without(networks: &[&RoomNetwork], left_out: &BTreeSet<Measure>) -> Result<Self, NoTypologies> {
        let mut model = Self::fit(networks, left_out)?;
        let fold_of = building_folds(networks, INNER_FOLDS, 0);
        let mut unseen: Vec<(Vec<f64>, usize, f64)> = Vec::new();
        for fold in 0..INNER_FOLDS {
            let part = |tests: bool| networks.iter().zip(&fold_of).filter(move |(_, of)| (**of == fold) == tests);
            let taught: Vec<&RoomNetwork> = part(false).map(|(network, _)| *network).collect();
            let Ok(part_model) = Self::fit(&taught, left_out) else { continue };
            for (network, _) in part(true) {
                let position = |typology: &Typology| part_model.known.iter().position(|it| it.typology == *typology);
                let Some(truth) = network.typology.as_ref().and_then(position) else { continue };
                let Some(of_all) = model.known.iter().find(|it| Some(&it.typology) == network.typology.as_ref()) else {
                    continue;
                };
                // All typologies have equal weight, however many plans they have.
                unseen.push((part_model.evidence(network, &[]), truth, 1.0 / of_all.plans as f64));
            }
        }
        let loss = |temperature: f64| -> f64 {
            let surprise = |(evidence, truth, weight): &(Vec<f64>, usize, f64)| {
                -weight * softmax(evidence, temperature)[*truth].max(1e-9).ln()
            };
            unseen.iter().map(surprise).sum()
        };
        let temperatures = TEMPERATURES.map(|tenths| f64::from(tenths) / 10.0);
        if !unseen.is_empty() {
            model.temperature = temperatures.min_by(|&p, &q| loss(p).total_cmp(&loss(q))).unwrap_or(1.0);
        }
        Ok(model)
    }

    fn fit(networks: &[&RoomNetwork], left_out: &BTreeSet<Measure>) -> Result<Self, NoTypologies> {
        let mut plans: BTreeMap<&Typology, Vec<(Measures, [f64; 5])>> = BTreeMap::new();
        for network in networks {
            let (Some(typology), Some(measures)) = (&network.typology, measures_of(network)) else { continue };
            let mut labels = [0.0; 5];
            for label in network.rooms.iter().filter_map(|room| room.label) {
                labels[label.index()] += 1.0;
            }
            plans.entry(typology).or_default().push((measures, labels));
        }
        if plans.is_empty() {
            return Err(NoTypologies);
        }
        let mut known = Vec::new();
        let mut covariance = Covariance::zeros();
        for (&typology, plans) in &plans {
            let count = plans.len() as f64;
            let mean: Measures = plans.iter().map(|(measures, _)| measures).sum::<Measures>() / count;
            for (measures, _) in plans {
                let off = measures - mean;
                covariance += off * off.transpose() / count;
            }
            let counts: [f64; 5] =
                std::array::from_fn(|label| 1.0 + plans.iter().map(|(_, of)| of[label]).sum::<f64>());
            let all: f64 = counts.iter().sum();
            known.push(Known { typology: typology.clone(), plans: plans.len(), mean, labels: counts.map(|n| n / all) });
        }
        covariance /= known.len() as f64;
        let is_used = |measure: usize| !left_out.contains(&Measure::ALL[measure]);
        let covariance = Covariance::from_fn(|i, j| match (i == j, is_used(i) && is_used(j)) {
            (true, _) => covariance[(i, j)].max(LEAST_VARIANCE),
            (false, true) => covariance[(i, j)] * (1.0 - SHRINKAGE),
            (false, false) => 0.0,
        });
        Ok(Self { known, covariance, left_out: left_out.clone(), temperature: 1.0 })
    }

    /// Probabilities of the typologies, most probable first. `known` holds the labels of the network's
    /// rooms that are known without knowing the typology; in a list that is too short, the remaining
    /// rooms are unknown. Without rooms all are equally likely.
    pub fn posterior(&self, network: &RoomNetwork, known: &[Option<Label>]) -> Vec<(Typology, f64)> {
        let probabilities = softmax(&self.evidence(network, known), self.temperature);
        let mut posterior: Vec<(Typology, f64)> =
            self.known.iter().map(|known| known.typology.clone()).zip(probabilities).collect();
        posterior.sort_by(|p, q| q.1.total_cmp(&p.1));
        posterior
    }

    /// The evidence for the most probable typology against the runner-up, strongest first. Empty if there is only one
    /// typology, or no room.
    pub fn reasons(&self, network: &RoomNetwork, known: &[Option<Label>]) -> Vec<TypologyReason> {
        let posterior = self.posterior(network, known);
        let find = |rank: usize| {
            let (typology, _) = posterior.get(rank)?;
            self.known.iter().find(|known| known.typology == *typology)
        };
        let (Some(best), Some(next), Some(measured)) = (find(0), find(1), measures(network)) else {
            return Vec::new();
        };
        let weights = self.solver().solve(&self.used(best.mean - next.mean));
        let mut reasons: Vec<(f64, TypologyReason)> = Measure::ALL
            .iter()
            .enumerate()
            .map(|(i, measure)| {
                let evidence = weights[i] * (measured[i] - (best.mean[i] + next.mean[i]) / 2.0);
                let usual = [best, next].map(|known| (known.typology.clone(), known.mean[i]));
                (evidence, TypologyReason::Measure { measure: *measure, value: measured[i], usual })
            })
            .collect();
        let counts = counts_of(known);
        let labels = urn(&counts, &best.labels) - urn(&counts, &next.labels);
        match counts.iter().sum::<u32>() {
            0 => {}
            rooms => reasons.push((labels, TypologyReason::KnownLabels { rooms })),
        }
        reasons.retain(|(evidence, _)| *evidence > SPEAKS);
        reasons.sort_by(|p, q| q.0.total_cmp(&p.0));
        reasons.into_iter().map(|(_, reason)| reason).collect()
    }

    /// The measures with the omitted ones set to zero.
    fn used(&self, measures: Measures) -> Measures {
        Measures::from_fn(|i, _| if self.left_out.contains(&Measure::ALL[i]) { 0.0 } else { measures[i] })
    }

    /// The Cholesky factor of the covariance; of its diagonal alone if it is not positive definite, which
    /// one learned from ordinary plans always is.
    fn solver(&self) -> Cholesky<f64, Const<MEASURES>> {
        let diagonal = || {
            let variances = self.covariance.diagonal().map(|variance| variance.max(LEAST_VARIANCE));
            Cholesky::new_unchecked(Covariance::from_diagonal(&variances))
        };
        Cholesky::new(self.covariance).unwrap_or_else(diagonal)
    }

    /// The log likelihood of the observations under each typology, up to a constant.
    fn evidence(&self, network: &RoomNetwork, known: &[Option<Label>]) -> Vec<f64> {
        let counts = counts_of(known);
        let measured = measures(network);
        let solver = self.solver();
        let of_typology = |of: &Known| {
            // Half the squared Mahalanobis distance.
            let shape = measured.map_or(0.0, |measured| {
                let off = self.used(measured - of.mean);
                -0.5 * off.dot(&solver.solve(&off))
            });
            shape + urn(&counts, &of.labels)
        };
        self.known.iter().map(of_typology).collect()
    }

    /// The model as plain data.
    pub fn to_value(&self) -> Value {
        let named = |measures: &Measures| -> Value {
            Measure::ALL
                .iter()
                .zip(measures)
                .map(|(measure, &value)| (measure.name().to_owned(), json!(value)))
                .collect()
        };
        let typologies = self.known.iter().map(|known| {
            json!({
                "typology": known.typology.as_str(),
                "plans": known.plans,
                "mean": named(&known.mean),
                "labels": known.labels,
            })
        });
        json!({
            "typologies": typologies.collect::<Vec<_>>(),
            "covariance": self.covariance.row_iter().map(|row| named(&row.transpose())).collect::<Vec<_>>(),
            "without": self.left_out.iter().map(|measure| measure.name()).collect::<Vec<_>>(),
            "temperature": self.temperature,
        })
    }

    /// Reads the model from such data.
    ///
    /// # Errors
    /// When something is missing or invalid; the error says what.
    pub fn from_value(value: &Value) -> Result<Self, TypologyModelError> {
        let refuse = |what: &'static str| TypologyModelError(what);
        let list = |name: &str| value.get(name).and_then(Value::as_array);
        let number = |value: Option<&Value>| value.and_then(Value::as_f64).filter(|number| number.is_finite());
        let named = |value: Option<&Value>| -> Option<Measures> {
            let mut measures = Measures::zeros();
            for (measure, slot) in Measure::ALL.iter().zip(measures.iter_mut()) {
                *slot = number(value?.get(measure.name()))?;
            }
            Some(measures)
        };
        let mut known: Vec<Known> = Vec::new();
        for entry in list("typologies").ok_or(refuse("'typologies' is missing"))? {
            let typology = entry.get("typology").and_then(Value::as_str).and_then(Typology::new);
            let typology = typology.ok_or(refuse("a typology has no name"))?;
            if known.iter().any(|other| other.typology == typology) {
                return Err(refuse("a typology is named twice"));
            }
            let plans = entry.get("plans").and_then(Value::as_u64).and_then(|plans| usize::try_from(plans).ok());
            let mut labels = [0.0; 5];
            let shares = entry.get("labels").and_then(Value::as_array).filter(|shares| shares.len() == 5);
            for (share, slot) in shares.ok_or(refuse("'labels' does not hold five shares"))?.iter().zip(&mut labels) {
                let share = number(Some(share)).filter(|share| *share > 0.0 && *share <= 1.0);
                *slot = share.ok_or(refuse("a share of 'labels' is not above 0 and at most 1"))?;
            }
            known.push(Known {
                typology,
                plans: plans.filter(|&plans| plans > 0).ok_or(refuse("'plans' is not a positive number"))?,
                mean: named(entry.get("mean")).ok_or(refuse("'mean' does not hold a number for each measure"))?,
                labels,
            });
        }
        if known.is_empty() {
            return Err(refuse("it knows no typology"));
        }
        let rows = list("covariance").filter(|rows| rows.len() == MEASURES);
        let mut covariance = Covariance::zeros();
        for (row, mut slot) in rows.ok_or(refuse("'covariance' is no square"))?.iter().zip(covariance.row_iter_mut()) {
            let row = named(Some(row)).ok_or(refuse("'covariance' does not hold a number for each pair"))?;
            slot.copy_from(&row.transpose());
        }
        if Cholesky::new(covariance).is_none() {
            return Err(refuse("'covariance' is not positive definite"));
        }
        let mut left_out = BTreeSet::new();
        for name in list("without").ok_or(refuse("'without' is missing"))? {
            let measure = Measure::ALL.into_iter().find(|measure| name.as_str() == Some(measure.name()));
            left_out.insert(measure.ok_or(refuse("'without' names an unknown measure"))?);
        }
        let temperature = number(value.get("temperature")).filter(|temperature| *temperature > 0.0);
        let temperature = temperature.ok_or(refuse("'temperature' is no positive number"))?;
        Ok(Self { known, covariance, left_out, temperature })
    }
}

/// What speaks for the typology of a plan.
#[derive(Clone, Debug, PartialEq)]
pub enum TypologyReason {
    /// A measure of the plan, and what is usual in the most probable typology and in the next.
    Measure { measure: Measure, value: f64, usual: [(Typology, f64); 2] },
    /// The labels that are known of so many rooms.
    KnownLabels { rooms: u32 },
}

impl TypologyReason {
    /// A clause: `it has 48 rooms (usual: school 41, office 33)`.
    pub fn words(&self, units: Units) -> String {
        match self {
            Self::Measure { measure, value, usual } => {
                let usual: Vec<String> = usual
                    .iter()
                    .map(|(typology, value)| format!("{typology} {}", measure.value(*value, units)))
                    .collect();
                format!("{} (usual: {})", measure.words(&measure.value(*value, units)), usual.join(", "))
            }
            Self::KnownLabels { rooms: 1 } => "one of its rooms has a label that fits".to_owned(),
            Self::KnownLabels { rooms } => format!("{rooms} of its rooms have labels that fit"),
        }
    }
}

/// Evidence below this (in nats, before dividing by the temperature) is not worth mentioning.
const SPEAKS: f64 = 0.1;

/// Why data are not a valid typology model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TypologyModelError(pub &'static str);

impl fmt::Display for TypologyModelError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}; restore the file from a copy, or train it again", self.0)
    }
}

impl std::error::Error for TypologyModelError {}

fn softmax(evidence: &[f64], temperature: f64) -> Vec<f64> {
    let most = evidence.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let weights: Vec<f64> = evidence.iter().map(|evidence| ((evidence - most) / temperature).exp()).collect();
    let sum: f64 = weights.iter().sum();
    weights.into_iter().map(|weight| weight / sum).collect()
}

fn counts_of(known: &[Option<Label>]) -> [u32; 5] {
    let mut counts = [0; 5];
    for label in known.iter().flatten() {
        counts[label.index()] += 1;
    }
    counts
}

/// The log probability of labels in some order, drawn from Pólya's urn.
fn urn(counts: &[u32; 5], shares: &[f64; 5]) -> f64 {
    let mut drawn = 0;
    let mut sum = 0.0;
    for (&count, share) in counts.iter().zip(shares) {
        for before in 0..count {
            sum += ((URN * share + f64::from(before)) / (URN + f64::from(drawn))).ln();
            drawn += 1;
        }
    }
    sum
}

/// The fold of each network: the buildings of each typology are assigned in random order.
pub fn building_folds(networks: &[&RoomNetwork], folds: usize, seed: u64) -> Vec<usize> {
    let building = |network: &RoomNetwork| (network.typology.clone(), network.group.clone());
    let mut buildings: Vec<_> = networks.iter().map(|network| building(network)).collect();
    buildings.sort_unstable();
    buildings.dedup();
    Random::new(seed).shuffle(&mut buildings);
    buildings.sort_by(|p, q| p.0.cmp(&q.0));
    let fold_of: BTreeMap<_, usize> =
        buildings.into_iter().enumerate().map(|(turn, key)| (key, turn % folds)).collect();
    networks.iter().map(|network| fold_of.get(&building(network)).copied().unwrap_or_default()).collect()
}

/// A plan's true typology, and the posterior from a model that had not seen its building.
#[derive(Clone, Debug, PartialEq)]
pub struct Inferred {
    pub building: String,
    pub truth: Typology,
    pub posterior: Vec<(Typology, f64)>,
}

/// Cross-validates with folds that never split a building, with no labels given for the test plans. The
/// networks are those of [`RoomNetwork::without_typology`].
pub fn cross_validate(
    networks: &[&RoomNetwork],
    left_out: &BTreeSet<Measure>,
    folds: usize,
    seed: u64,
) -> Vec<Inferred> {
    let folds = folds.max(2);
    let fold_of = building_folds(networks, folds, seed);
    let mut inferred = Vec::new();
    for fold in 0..folds {
        let taught = networks.iter().zip(&fold_of).filter(|(_, of)| **of != fold).map(|(network, _)| *network);
        let Ok(model) = TypologyModel::train_without(&taught.collect::<Vec<_>>(), left_out) else { continue };
        let tested = networks.iter().zip(&fold_of).filter(|(_, of)| **of == fold);
        inferred.extend(tested.filter_map(|(network, _)| {
            Some(Inferred {
                building: network.building.clone(),
                truth: network.typology.clone()?,
                posterior: model.posterior(network, &[]),
            })
        }));
    }
    inferred
}
