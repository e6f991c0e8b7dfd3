//! How well typologies are inferred from plans of buildings never seen: as the program does it, from measures of the plan as a whole,
//! and as the paper proposes, by the typology whose classifiers explain the rooms best.

use std::collections::{BTreeMap, BTreeSet};

use super::{Options, TypologyCount, TypologyLine, TypologyWay};
use crate::base::random::seed_of_part;
use crate::base::work::{Cancelled, Work};
use crate::classify::typology::{self, Inferred, building_folds};
use crate::classify::{Algorithm, Classifier};
use crate::dataset::table::Table;
use crate::dataset::{Collection, Moments, RoomNetwork, Row};
use crate::features::NeighbourLabels;
use crate::labels::Typology;

/// Folds in which classifiers learn how well they explain plans of their own typology.
const INNER_FOLDS: usize = 3;

/// How typologies are inferred, folds by building: in full as the program does it, and by all ways beside each other. Nothing without
/// several typologies.
pub(super) fn infer_typologies(
    collection: &Collection,
    blind: &[RoomNetwork],
    options: Options,
    work: &Work<'_>,
) -> Result<(Vec<TypologyLine>, Vec<TypologyWay>), Cancelled> {
    let typologies = collection.typologies();
    if typologies.len() < 2 || blind.is_empty() {
        return Ok((Vec::new(), Vec::new()));
    }
    let blind: Vec<&RoomNetwork> = blind.iter().collect();
    let measured = typology::cross_validate(&blind, &BTreeSet::new(), options.folds, options.seed);
    let lines = lines(&typologies, &measured);
    let (explained, relative) = explained(&typologies, &blind, options, work)?;
    let ways = [
        ("measures of the plan as a whole (what the program does)", &measured),
        ("the typology whose classifiers are surest of the rooms (the paper's proposal)", &explained),
        ("the same, against how sure they are of plans of their own typology", &relative),
    ];
    let ways = ways.map(|(way, inferred)| {
        let lines = self::lines(&typologies, inferred);
        let mean = |of: fn(&TypologyLine) -> f64| Moments::of(lines.iter().map(of)).mean;
        TypologyWay {
            way: way.to_owned(),
            plan_accuracy: mean(|line| line.plan_accuracy),
            building_accuracy: mean(|line| line.building_accuracy),
            plans_of: lines.iter().map(|line| line.plan_accuracy).collect(),
        }
    });
    Ok((lines, ways.to_vec()))
}

/// By true typology, what plans were taken for.
fn lines(typologies: &[Typology], inferred: &[Inferred]) -> Vec<TypologyLine> {
    let line = |typology: &Typology| {
        let of_truth: Vec<_> = inferred.iter().filter(|plan| plan.truth == *typology).collect();
        let best = |plan: &Inferred| plan.posterior.first().map(|(best, _)| best.clone());
        let mut buildings: BTreeMap<&str, Vec<f64>> = BTreeMap::new();
        for plan in &of_truth {
            let right = f64::from(u8::from(best(plan).as_ref() == Some(typology)));
            buildings.entry(&plan.building).or_default().push(right);
        }
        let mean = |numbers: &[f64]| Moments::of(numbers.iter().copied()).mean;
        let of_buildings: Vec<f64> = buildings.values().map(|of_plans| mean(of_plans)).collect();
        let of_plans: Vec<f64> = buildings.values().flatten().copied().collect();
        let taken_for = |other: &Typology| TypologyCount {
            taken_for: other.as_str().to_owned(),
            plans: of_truth.iter().filter(|plan| best(plan).as_ref() == Some(other)).count(),
        };
        TypologyLine {
            typology: typology.as_str().to_owned(),
            plans: typologies.iter().map(taken_for).collect(),
            plan_accuracy: mean(&of_plans),
            building_accuracy: mean(&of_buildings),
            buildings: buildings.len(),
        }
    };
    typologies.iter().map(line).collect()
}

/// The classifiers of one typology.
struct Explainers(Vec<Classifier>);

impl Explainers {
    /// Those that learn from the labelled rooms of some plans, with what can be known of a new building: temporary labels.
    fn train(networks: &[&RoomNetwork], seed: u64, work: &Work<'_>) -> Option<Self> {
        let rows: Vec<Row> =
            networks.iter().flat_map(|network| network.rows_seeing(&temporary(network)).collect::<Vec<_>>()).collect();
        let table = Table::from_rows(&rows).ok()?;
        let train = |algorithm: Algorithm| Classifier::train(algorithm, &table, seed, work).ok();
        Some(Self(Algorithm::ALL.into_iter().map(train).collect::<Option<_>>()?))
    }

    /// How well they explain a plan's rooms: the mean logarithm of the probability of what they say. `None` without rooms.
    fn explain(&self, network: &RoomNetwork) -> Option<f64> {
        let seen = temporary(network);
        let values: Vec<_> = (0..network.rooms.len()).map(|room| network.features(room, &seen).values()).collect();
        let said = values.iter().flat_map(|values| self.0.iter().map(move |classifier| classifier.predict(values)));
        let sure: Vec<f64> = said.map(|said| said.sureness().ln()).collect();
        (!sure.is_empty()).then(|| Moments::of(sure).mean)
    }
}

fn temporary(network: &RoomNetwork) -> Vec<crate::labels::Label> {
    network.seen_labels(&[], NeighbourLabels::Temporary)
}

/// Typologies by how well their classifiers explain each plan, which they did not learn from: as it is, and in relation to plans of
/// their own typology.
fn explained(
    typologies: &[Typology],
    networks: &[&RoomNetwork],
    options: Options,
    work: &Work<'_>,
) -> Result<(Vec<Inferred>, Vec<Inferred>), Cancelled> {
    let folds = options.folds.max(2);
    let fold_of = building_folds(networks, folds, options.seed);
    let told = work.map(folds, |fold| {
        let seed = seed_of_part(options.seed, fold);
        let taught = |typology: &Typology| -> Vec<&RoomNetwork> {
            let of = networks
                .iter()
                .zip(&fold_of)
                .filter(|(network, of)| **of != fold && network.typology.as_ref() == Some(typology));
            of.map(|(network, _)| *network).collect()
        };
        let alone = work.alone();
        let known: Vec<(&Typology, Explainers, Moments)> = typologies
            .iter()
            .filter_map(|typology| {
                let taught = taught(typology);
                let usual = usual(&taught, seed, &alone)?;
                Some((typology, Explainers::train(&taught, seed, &alone)?, usual))
            })
            .collect();
        let tested = networks.iter().zip(&fold_of).filter(|(_, of)| **of == fold);
        let infer = |network: &RoomNetwork| {
            let plain: Vec<(Typology, f64)> = known
                .iter()
                .filter_map(|(typology, explainers, _)| Some(((*typology).clone(), explainers.explain(network)?)))
                .collect();
            let relative = plain.iter().zip(&known).map(|((typology, score), (.., usual))| {
                (typology.clone(), -((score - usual.mean) / usual.deviation.max(1e-3)).powi(2))
            });
            let inferred = |mut posterior: Vec<(Typology, f64)>| {
                posterior.sort_by(|p, q| q.1.total_cmp(&p.1));
                Some(Inferred { building: network.building.clone(), truth: network.typology.clone()?, posterior })
            };
            Some((inferred(plain.clone())?, inferred(relative.collect())?))
        };
        tested.filter_map(|(network, _)| infer(network)).collect::<Vec<_>>()
    })?;
    Ok(told.into_iter().flatten().unzip())
}

/// How well classifiers of a typology explain plans of it that they did not learn from.
fn usual(networks: &[&RoomNetwork], seed: u64, work: &Work<'_>) -> Option<Moments> {
    let fold_of = building_folds(networks, INNER_FOLDS, seed);
    let mut scores = Vec::new();
    for fold in 0..INNER_FOLDS {
        let part = |tests: bool| {
            networks.iter().zip(&fold_of).filter(move |(_, of)| (**of == fold) == tests).map(|(of, _)| *of)
        };
        let Some(explainers) = Explainers::train(&part(false).collect::<Vec<_>>(), seed, work) else { continue };
        scores.extend(part(true).filter_map(|network| explainers.explain(network)));
    }
    if scores.is_empty() {
        // One plan teaches how its rooms look, but not how others do.
        scores.extend(Explainers::train(networks, seed, work)?.explain(networks.first()?));
    }
    Some(Moments::of(scores))
}
