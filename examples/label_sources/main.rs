//! What classifiers say of buildings they have not seen: of another source than they learned from, and of the same one, by folds that
//! never split a building. Writes a line for each room and part of the blend, for whatever is to be computed from it. With `--only
//! given` it prints what given labels are worth to the blend instead.
//!
//!     cargo run --release --example label_sources -- [--seed 1] [--folds 4] [--copies 3 --as-drawn 0.5 --scale 0.15 --left-out 0.4]
//!         [--perceptron] [--only source|building|given|typology] DATA > said.csv
//!
//! `--perceptron` adds single perceptrons (`mlp`), and the committee of them that takes part in the blend.
//!
//! DATA is the folder of real plans, with `authors/school`, `authors/office`, `houses/r2v`, `houses/archilyse` and `kth`.

#![allow(clippy::print_stdout, reason = "an example talks to its user")]

mod half_known;

use std::collections::BTreeSet;
use std::error::Error;
use std::io::Write;
use std::path::{Path, PathBuf};

use enfilade::base::random::{Random, seed_of_part};
use enfilade::base::work::Work;
use enfilade::classify::joint::{Alterations, Joint};
use enfilade::classify::typology::{TypologyModel, cross_validate};
use enfilade::classify::{Algorithm, Classifier, Distribution, committee, in_plan};
use enfilade::dataset::folds::{Folds, Grouping};
use enfilade::dataset::table::Table;
use enfilade::dataset::{Collection, RoomNetwork};
use enfilade::features::NeighbourLabels;
use enfilade::gather::{FileRead, PlansRead};
use enfilade::labels::{Label, Schemes};

struct Options {
    seed: u64,
    folds: usize,
    alterations: Alterations,
    only: String,
    perceptron: bool,
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut options = Options {
        seed: 1,
        folds: 4,
        alterations: Alterations { copies: 3, as_drawn: 0.5, scale: 0.15, left_out: 0.4 },
        only: String::new(),
        perceptron: false,
    };
    let mut data = PathBuf::new();
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let mut value = || words.next().ok_or(format!("{word} needs a value"));
        match word.as_str() {
            "--seed" => options.seed = value()?.parse()?,
            "--folds" => options.folds = value()?.parse()?,
            "--copies" => options.alterations.copies = value()?.parse()?,
            "--as-drawn" => options.alterations.as_drawn = value()?.parse()?,
            "--scale" => options.alterations.scale = value()?.parse()?,
            "--left-out" => options.alterations.left_out = value()?.parse()?,
            "--only" => options.only = value()?,
            "--perceptron" => options.perceptron = true,
            _ => data = PathBuf::from(word),
        }
    }
    if options.only == "typology" {
        return typologies(&data);
    }
    let read = |folder: &str| Ok::<_, Box<dyn Error>>(plans(&data.join(folder))?.networks);
    let own: Vec<(&str, Vec<RoomNetwork>)> = vec![
        ("school", read("authors/school")?),
        ("office", read("authors/office")?),
        ("house", Collection::Plans(read("houses/r2v")?).at_most(2000, 1).networks().to_vec()),
    ];
    if options.only == "given" {
        return half_known::print(&own, &read("houses/archilyse")?, &read("kth")?, &options);
    }
    println!("way,seed,set,plan,room,label,function,area_m2,length_m,width_m,doors,joined,flat,part,known,s,m,b,c,h");
    if options.only != "building" {
        by_source(&own, &read("houses/archilyse")?, &read("kth")?, &options)?;
    }
    if options.only != "source" {
        by_building(&own, &options)?;
    }
    Ok(())
}

/// The plans of a folder, each room once.
fn plans(folder: &Path) -> Result<PlansRead, Box<dyn Error>> {
    let mut files = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder)? {
            let path = entry?.path();
            match path.is_dir() {
                true => folders.push(path),
                false => files.push(path),
            }
        }
    }
    files.sort();
    let (schemes, mut read) = (Schemes::bundled(), PlansRead::default());
    for file in files {
        let Ok(import) = enfilade::formats::read_file(&file) else { continue };
        read.add(FileRead::new(&file.to_string_lossy(), String::new(), &import.plans, &schemes, true));
    }
    read.put_together();
    read.leave_out_repeats();
    Ok(read)
}

/// The posterior of typologies: of the Swiss storeys and the bundled plans, by what was learned from all the other plans, and of
/// these by folds that never split a building.
fn typologies(data: &Path) -> Result<(), Box<dyn Error>> {
    let mut own: Vec<RoomNetwork> = Vec::new();
    for folder in ["authors/school", "authors/office"] {
        own.extend(plans(&data.join(folder))?.blind);
    }
    let houses = plans(&data.join("houses/r2v"))?;
    let kept = Collection::Plans(houses.networks.clone()).at_most(2000, 1);
    let groups: BTreeSet<&str> = kept.networks().iter().map(|network| network.group.as_str()).collect();
    own.extend(houses.blind.into_iter().filter(|network| groups.contains(network.group.as_str())));
    let own: Vec<&RoomNetwork> = own.iter().collect();
    let model = TypologyModel::train(&own)?;
    println!("temperature {}", model.to_value()["temperature"]);
    for network in own.iter().filter(|network| network.flats().is_some()) {
        println!("taken for flats: {:?} {} {:?}", network.typology, network.plan, model.posterior(network, &[]));
    }
    for network in plans(&data.join("houses/archilyse"))?.blind {
        println!("{} {:?}", network.plan, model.posterior(&network, &[]));
    }
    for (name, plan) in enfilade::store::bundled_plans()? {
        let network = RoomNetwork::without_typology(&plan, &Schemes::bundled());
        println!("bundled {name:?} {:?} {:?}", network.typology, model.posterior(&network, &[]));
    }
    for seed in 1..=5 {
        let mut of: std::collections::BTreeMap<String, (f64, f64, f64)> = Default::default();
        for inferred in cross_validate(&own, &BTreeSet::new(), 10, seed) {
            let right = inferred.posterior.first().is_some_and(|(best, _)| *best == inferred.truth);
            let truth = inferred.posterior.iter().find(|(of, _)| *of == inferred.truth).map_or(0.0, |(_, p)| *p);
            let of = of.entry(inferred.truth.as_str().to_owned()).or_default();
            *of = (of.0 + 1.0, of.1 + f64::from(u8::from(right)), of.2 - truth.max(1e-9).ln());
        }
        let told: Vec<String> = of
            .iter()
            .map(|(of, (all, right, loss))| format!("{of} {:.1} % log loss {:.3}", 100.0 * right / all, loss / all))
            .collect();
        println!("seed {seed}: {}", told.join(", "));
    }
    Ok(())
}

/// Joint classifiers that learned from dwellings of one source, or from that and the authors' buildings, asked about another source.
fn by_source(
    own: &[(&str, Vec<RoomNetwork>)],
    swiss: &[RoomNetwork],
    kth: &[RoomNetwork],
    options: &Options,
) -> Result<(), Box<dyn Error>> {
    let work = Work::quiet();
    let flats: Vec<RoomNetwork> = swiss
        .iter()
        .flat_map(|storey| {
            storey.flats().map(|of| of.flats.clone()).unwrap_or_default().into_iter().map(|flat| storey.part(&flat))
        })
        .collect();
    let all: Vec<&RoomNetwork> = own.iter().flat_map(|(_, of)| of).collect();
    let house: Vec<&RoomNetwork> = own[2].1.iter().collect();
    let of_own = Joint::train_altered(&house, &options.alterations, options.seed, &work)?;
    let of_all = Joint::train_altered(&all, &options.alterations, options.seed, &work)?;
    for (set, tested) in [("swiss", swiss), ("flats", &flats), ("kth", kth)] {
        for (plan, network) in tested.iter().enumerate() {
            tell("source", set, plan, network, "own", options.seed, &|known| of_own.predict(network, known))?;
            tell("source", set, plan, network, "all", options.seed, &|known| of_all.predict(network, known))?;
        }
    }
    if options.perceptron {
        let everything: Vec<RoomNetwork> = own.iter().flat_map(|(_, of)| of.clone()).collect();
        for (taught, one, together) in [(&own[2].1, "mlp", "committee"), (&everything, "mlp-all", "committee-all")] {
            let table = table(taught, options.seed)?;
            let single = Classifier::train(Algorithm::PERCEPTRON, &table, options.seed, &work)?;
            let several = committee_of(taught, options.seed)?;
            for (set, tested) in [("swiss", swiss), ("flats", &flats), ("kth", kth)] {
                for (plan, network) in tested.iter().enumerate() {
                    tell("source", set, plan, network, one, options.seed, &|known| classify(&single, network, known))?;
                    tell("source", set, plan, network, together, options.seed, &|known| {
                        classify(&several, network, known)
                    })?;
                }
            }
        }
    }
    Ok(())
}

/// What perceptrons learn from.
fn table(networks: &[RoomNetwork], seed: u64) -> Result<Table, Box<dyn Error>> {
    let collection = Collection::Plans(networks.to_vec());
    let rows = collection.rows(NeighbourLabels::Predicted).unwrap_or_default();
    let all: Vec<usize> = (0..rows.len()).collect();
    let rows = in_plan::rows_with_predicted_neighbours(
        networks,
        &rows,
        &collection.places(),
        &all,
        Algorithm::PERCEPTRON,
        Grouping::Building,
        seed,
        &Work::quiet(),
    )?;
    Ok(Table::from_rows(&rows)?)
}

/// The committee of perceptrons that takes part in the blend.
fn committee_of(networks: &[RoomNetwork], seed: u64) -> Result<Classifier, Box<dyn Error>> {
    let collection = Collection::Plans(networks.to_vec());
    let rows = collection.rows(NeighbourLabels::Predicted).unwrap_or_default();
    let all: Vec<usize> = (0..rows.len()).collect();
    let places = collection.places();
    let trained = committee::train(networks, &rows, &places, &all, seed, &Work::quiet())?;
    trained.ok_or_else(|| "there are no labelled rooms to learn from".into())
}

fn classify(by: &Classifier, network: &RoomNetwork, known: &[Option<Label>]) -> Vec<Distribution> {
    in_plan::classify(by, network, known, NeighbourLabels::Predicted).distributions
}

/// Folds by building: what is said of a typology's buildings by classifiers of the others of it, and of the others of all.
fn by_building(own: &[(&str, Vec<RoomNetwork>)], options: &Options) -> Result<(), Box<dyn Error>> {
    let fold_of: Vec<Vec<usize>> =
        own.iter().map(|(_, networks)| folds(networks, options.folds, options.seed)).collect::<Result<_, _>>()?;
    let work = Work::quiet();
    for fold in 0..options.folds {
        let seed = seed_of_part(options.seed, fold);
        let split = |set: usize, is_tested: bool| -> Vec<&RoomNetwork> {
            let of = own[set].1.iter().zip(&fold_of[set]).filter(|(_, of)| (**of == fold) == is_tested);
            of.map(|(network, _)| network).collect()
        };
        let all: Vec<&RoomNetwork> = (0..own.len()).flat_map(|set| split(set, false)).collect();
        let of_all = Joint::train_altered(&all, &options.alterations, seed, &work)?;
        for (set, (name, _)) in own.iter().enumerate() {
            let of_own = Joint::train_altered(&split(set, false), &options.alterations, seed, &work)?;
            let taught: Vec<RoomNetwork> = split(set, false).into_iter().cloned().collect();
            let perceptrons = match options.perceptron {
                true => {
                    let table = table(&taught, seed)?;
                    let single = Classifier::train(Algorithm::PERCEPTRON, &table, seed, &work)?;
                    vec![("mlp", single), ("committee", committee_of(&taught, seed)?)]
                }
                false => Vec::new(),
            };
            for (index, (network, of)) in own[set].1.iter().zip(&fold_of[set]).enumerate() {
                if *of == fold {
                    tell("building", name, index, network, "own", seed, &|known| of_own.predict(network, known))?;
                    tell("building", name, index, network, "all", seed, &|known| of_all.predict(network, known))?;
                    for (part, by) in &perceptrons {
                        tell("building", name, index, network, part, seed, &|known| classify(by, network, known))?;
                    }
                }
            }
        }
    }
    Ok(())
}

/// The fold of each network.
fn folds(networks: &[RoomNetwork], count: usize, seed: u64) -> Result<Vec<usize>, Box<dyn Error>> {
    let labelled: Vec<(usize, Label, &str)> = networks
        .iter()
        .enumerate()
        .flat_map(|(index, network)| {
            network.labelled().filter_map(move |room| Some((index, network.rooms[room].label?, network.group.as_str())))
        })
        .collect();
    let labels: Vec<Label> = labelled.iter().map(|(_, label, _)| *label).collect();
    let groups: Vec<&str> = labelled.iter().map(|(.., group)| *group).collect();
    let folds = Folds::grouped(&labels, &groups, count, seed)?;
    let mut of = vec![usize::MAX; networks.len()];
    for ((network, ..), &fold) in labelled.iter().zip(folds.of_rows()) {
        of[*network] = fold;
    }
    Ok(of)
}

/// What is said with nothing known, and with half of the rooms known.
fn tell(
    way: &str,
    set: &str,
    plan: usize,
    network: &RoomNetwork,
    part: &str,
    seed: u64,
    predict: &dyn Fn(&[Option<Label>]) -> Vec<Distribution>,
) -> Result<(), Box<dyn Error>> {
    let mut out = std::io::stdout().lock();
    let labelled: BTreeSet<usize> = network.labelled().collect();
    let joined = network.joined();
    let flats = network.flats().map(|of| of.flats.clone()).unwrap_or_default();
    let mut random = Random::new(seed_of_part(77, plan));
    let half: Vec<Option<Label>> =
        network.rooms.iter().map(|room| room.label.filter(|_| random.unit() < 0.5)).collect();
    for (known, said) in [(None, predict(&[])), (Some(&half), predict(&half))] {
        for (room, said) in said.iter().enumerate() {
            let of = &network.rooms[room];
            let label = of.label.filter(|_| labelled.contains(&room)).map_or("", Label::letter);
            let known =
                known.map_or("none", |known: &Vec<Option<Label>>| if known[room].is_some() { "given" } else { "half" });
            let others: Vec<String> = joined[room].iter().map(usize::to_string).collect();
            let flat = flats.iter().position(|flat| flat.contains(&room)).map_or(-1, |flat| flat as i32);
            let [s, m, b, c, h] = said.probabilities();
            writeln!(
                out,
                "{way},{seed},{set},{plan},{room},{label},{},{},{},{},{},{},{flat},{part},{known},{s:.5},{m:.5},{b:.5},{c:.5},{h:.5}",
                of.function.replace(',', " "),
                of.area_m2,
                of.form.length_m,
                of.form.width_m,
                of.doors.len(),
                others.join(" "),
            )?;
        }
    }
    Ok(())
}
