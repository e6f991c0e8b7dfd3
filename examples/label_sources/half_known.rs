//! What labels given to half of a plan's rooms are worth on the other half, with the blend that is the default.

use std::collections::BTreeMap;
use std::error::Error;

use enfilade::base::random::{Random, seed_of_part};
use enfilade::base::work::Work;
use enfilade::classify::blend::recipe;
use enfilade::classify::given::Given;
use enfilade::classify::joint::Joint;
use enfilade::classify::models::Models;
use enfilade::classify::{Distribution, Method, PlanClassifier};
use enfilade::dataset::RoomNetwork;
use enfilade::dataset::sets::STANDARD;
use enfilade::labels::Label;

use super::{Options, classify, committee_of, folds};

/// Random halves of each plan.
const HALVES: usize = 5;

/// Rooms, and those right without and with the labels given, for each random half.
type Counts = [[usize; 3]; HALVES];

/// Prints a line for each set: buildings of the typologies by folds, with classifiers trained here; the Swiss storeys and the floors
/// of KTH with the bundled blends.
pub fn print(
    own: &[(&str, Vec<RoomNetwork>)],
    swiss: &[RoomNetwork],
    kth: &[RoomNetwork],
    options: &Options,
) -> Result<(), Box<dyn Error>> {
    let models = Models::bundled();
    for (set, of, plans) in
        [("swiss, bundled house-blend", "house", swiss), ("kth, bundled standard-blend", STANDARD, kth)]
    {
        let model = models.find(of, Method::Blend)?;
        let PlanClassifier::Blend(blend) = &model.classifier else { continue };
        let mut counts = Counts::default();
        for (index, network) in plans.iter().enumerate() {
            count(&mut counts, network, index, |known| blend.opinions(network, known).distributions);
        }
        tell(set, &counts);
    }
    let fold_of: Vec<Vec<usize>> =
        own.iter().map(|(_, networks)| folds(networks, options.folds, options.seed)).collect::<Result<_, _>>()?;
    let work = Work::quiet();
    let mut counts: BTreeMap<&str, Counts> = BTreeMap::new();
    for fold in 0..options.folds {
        let seed = seed_of_part(options.seed, fold);
        let taught = |set: usize| -> Vec<&RoomNetwork> {
            own[set].1.iter().zip(&fold_of[set]).filter(|(_, of)| **of != fold).map(|(network, _)| network).collect()
        };
        let all: Vec<&RoomNetwork> = (0..own.len()).flat_map(taught).collect();
        let of_all = Joint::train_altered(&all, &options.alterations, seed, &work)?;
        for (set, (name, networks)) in own.iter().enumerate() {
            let taught = taught(set);
            let of_own = Joint::train_altered(&taught, &options.alterations, seed, &work)?;
            let perceptrons = committee_of(&taught.into_iter().cloned().collect::<Vec<_>>(), seed)?;
            for (index, network) in networks.iter().enumerate().filter(|(index, _)| fold_of[set][*index] == fold) {
                let (mut said, mut weights) = (Vec::new(), Vec::new());
                for (of, method, weight) in recipe(name) {
                    weights.push(weight);
                    said.push(match method {
                        Method::Joint if of == STANDARD => of_all.predict(network, &[]),
                        Method::Joint => of_own.predict(network, &[]),
                        _ => classify(&perceptrons, network, &[]),
                    });
                }
                let means: Vec<Distribution> = (0..network.rooms.len())
                    .map(|room| Distribution::mean(&said.iter().map(|of| of[room]).collect::<Vec<_>>(), &weights))
                    .collect();
                let counts = counts.entry(name).or_default();
                count(counts, network, index, |known| Given::of(network, known, &means).corrected(&means));
            }
        }
    }
    for (name, counts) in &counts {
        tell(&format!("{name}, by building"), counts);
    }
    Ok(())
}

/// Counts the rooms without a given label, for each of some random halves.
fn count(
    counts: &mut Counts,
    network: &RoomNetwork,
    index: usize,
    predict: impl Fn(&[Option<Label>]) -> Vec<Distribution>,
) {
    let without = predict(&[]);
    for (half, counts) in counts.iter_mut().enumerate() {
        let mut random = Random::new(seed_of_part(seed_of_part(half as u64, 77), index));
        let known: Vec<Option<Label>> =
            network.rooms.iter().map(|room| room.label.filter(|_| random.unit() < 0.5)).collect();
        let with = predict(&known);
        for room in network.labelled().filter(|&room| known[room].is_none()) {
            let is_right = |said: &[Distribution]| usize::from(network.rooms[room].label == Some(said[room].label()));
            counts[0] += 1;
            counts[1] += is_right(&without);
            counts[2] += is_right(&with);
        }
    }
}

#[expect(clippy::print_stdout, reason = "an example talks to its user")]
fn tell(set: &str, counts: &Counts) {
    let share = |right: usize, rooms: usize| 100.0 * right as f64 / rooms.max(1) as f64;
    let rooms: usize = counts.iter().map(|of| of[0]).sum();
    let [without, with] = [1, 2].map(|at| share(counts.iter().map(|of| of[at]).sum(), rooms));
    let gains: Vec<String> =
        counts.iter().map(|of| format!("{:+.1}", share(of[2], of[0]) - share(of[1], of[0]))).collect();
    println!(
        "{set}: {rooms} rooms in {HALVES} halves, nothing known {without:.1} %, half known {with:.1} % (gains {})",
        gains.join(" ")
    );
}
