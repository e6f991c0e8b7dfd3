//! Labelled rooms to learn from, named on the command line: plans, folders of plans, or dataset files.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use super::batch::{self, Input};
use super::dataset::report_left_out;
use super::{CliError, Terminal, inputs};
use crate::dataset::{Collection, RoomNetwork, Row, csv};
use crate::features::NeighbourLabels;
use crate::formats::{Import, building_name};
use crate::labels::Typology;
use crate::plan::Plan;

/// Options of every subcommand that learns from labelled rooms.
#[derive(clap::Args)]
pub struct CollectOptions {
    /// Plans, folders of plans, or datasets (.csv, of which neighbours are not known; '-' reads one from stdin) with
    /// labelled rooms
    #[arg(required = true, value_name = "DATA")]
    pub data: Vec<PathBuf>,
    /// Take at most about N rooms of each typology (whole buildings; the paper has about 2000 of each)
    #[arg(long, value_name = "N")]
    pub most_rooms: Option<usize>,
    /// Label scheme that extends the bundled ones (may be given several times)
    #[arg(long, value_name = "FILE.scheme.toml")]
    pub scheme: Vec<PathBuf>,
}

/// Which labels of its neighbours a room counts, as an option's value.
pub fn neighbour_labels(word: &str) -> Result<NeighbourLabels, String> {
    inputs::one_of(word, &NeighbourLabels::ALL, NeighbourLabels::name)
}

/// Reads the collection; says on stderr what could not be read and which rooms have no label.
///
/// # Errors
/// When nothing can be learned from: no labelled room, or plans mixed with dataset files.
pub fn collect(options: &CollectOptions, seed: u64, terminal: &mut Terminal) -> Result<Collected, CliError> {
    // A plan alone is nothing to learn from: what comes by stdin is a dataset.
    let is_table = |path: &PathBuf| {
        path == Path::new("-") || path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("csv"))
    };
    let (tables, plans): (Vec<PathBuf>, Vec<PathBuf>) = options.data.iter().cloned().partition(is_table);
    let (collection, blind, failed) = match (tables.is_empty(), plans.is_empty()) {
        (false, false) => {
            return Err(CliError::call(
                "plans and datasets (.csv) cannot be mixed: a dataset does not tell which rooms are neighbours; make \
                 a dataset of the plans with 'enfilade dataset', or give the plans of the other",
            ));
        }
        (false, true) => (Collection::Rows(read_tables(&tables)?), Vec::new(), 0),
        _ => {
            let Networks { networks, blind, failed } = read_networks(&plans, &options.scheme, terminal)?;
            let keys: Vec<BuildingKey> = networks.iter().map(building_key).collect();
            (Collection::Plans(networks), keys.into_iter().zip(blind).collect(), failed)
        }
    };
    report_left_out(&collection.left_out(), terminal)?;
    let collection = match options.most_rooms {
        Some(most) => collection.at_most(most, seed),
        None => collection,
    };
    if collection.rows(NeighbourLabels::True).unwrap_or_default().is_empty() {
        return Err(CliError::new("there are no labelled rooms to learn from; label some rooms, or add plans"));
    }
    // Parts of a collection are whole buildings.
    let kept: BTreeSet<BuildingKey> = collection.networks().iter().map(building_key).collect();
    let blind: Vec<(BuildingKey, RoomNetwork)> = blind;
    let blind = blind.into_iter().filter(|(key, _)| kept.contains(key)).map(|(_, network)| network).collect();
    Ok(Collected { collection, blind, failed })
}

/// What was read.
pub struct Collected {
    pub collection: Collection,
    /// The plans of the collection, in order, as if their typology were unknown.
    pub blind: Vec<RoomNetwork>,
    /// Number of files that could not be read.
    pub failed: usize,
}

type BuildingKey = (Option<Typology>, String);

fn building_key(network: &RoomNetwork) -> BuildingKey {
    (network.typology.clone(), network.building.clone())
}

struct Networks {
    networks: Vec<RoomNetwork>,
    blind: Vec<RoomNetwork>,
    failed: usize,
}

/// The networks of plans, in the order of their paths.
fn read_networks(paths: &[PathBuf], scheme_files: &[PathBuf], terminal: &mut Terminal) -> Result<Networks, CliError> {
    let schemes = inputs::schemes(scheme_files)?;
    let files = batch::inputs(paths);
    let mut networks: Vec<RoomNetwork> = Vec::new();
    let mut blind: Vec<RoomNetwork> = Vec::new();
    let both = |plan: &Plan| (RoomNetwork::new(plan, &schemes), RoomNetwork::without_typology(plan, &schemes));
    let work = |_: &Input, import: Import| import.plans.iter().map(both).collect::<Vec<_>>();
    let failed = batch::for_each_import(&files, "collecting rooms", terminal, work, |_, plans, _| {
        for (network, without) in plans {
            networks.push(network);
            blind.push(without);
        }
        Ok(())
    })?;
    // The spelling of a building's name sometimes differs between storeys; folds must not split it for
    // that.
    let mut spellings: BTreeMap<BuildingKey, String> = BTreeMap::new();
    for network in networks.iter_mut().chain(&mut blind) {
        let key = (network.typology.clone(), building_name::key(&network.building));
        let first = spellings.entry(key).or_insert_with(|| network.building.clone());
        network.building.clone_from(first);
    }
    Ok(Networks { networks, blind, failed })
}

fn read_tables(paths: &[PathBuf]) -> Result<Vec<Row>, CliError> {
    let mut rows = Vec::new();
    for path in paths {
        let fail = |error: &dyn std::fmt::Display| CliError::new(format!("{}: {error}", path.display()));
        let file = std::fs::File::open(inputs::from_stdin(path)).map_err(|error| fail(&error))?;
        rows.extend(csv::read(std::io::BufReader::new(file)).map_err(|error| fail(&error))?);
    }
    Ok(rows)
}
