//! Plans of many files put together, each room once: what datasets and models are made from. Files are read elsewhere;
//! this knows what was read.

pub mod dataset;
mod manifest;

use std::collections::BTreeMap;

use crate::base::natural_order::NaturalKey;
use crate::dataset::edges::{self, Edge};
use crate::dataset::repeats::{Repeats, Sighting};
use crate::dataset::{LeftOut, RoomNetwork};
use crate::formats::building_name;
use crate::labels::{Schemes, Typology};
use crate::pipeline::Pipeline;
use crate::plan::Plan;
use crate::plan::storeys::level_key;
use crate::topology::vertical::Shafts;

pub use crate::base::hash::sha256;
pub use manifest::{Manifest, beside, json_bytes, program};

/// A file that was read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Source {
    /// As it was named.
    pub file: String,
    /// Of its bytes; empty for a folder.
    pub sha256: String,
    pub plans: usize,
    /// Rooms, with a label or without; rows of a dataset file.
    pub rooms: usize,
}

/// Plans that were read, in the order of their paths, each room once.
#[derive(Default)]
pub struct PlansRead {
    pub networks: Vec<RoomNetwork>,
    /// The same as they are seen when nobody knows their typology, if that was asked for.
    pub blind: Vec<RoomNetwork>,
    pub sources: Vec<Source>,
    /// All that was read, before anything was left out.
    pub sightings: Vec<Sighting>,
    pub repeats: Repeats,
    /// The stairs and lifts of each network's plan; none of a plan that names no building.
    pub shafts: Vec<Shafts>,
    /// Number of files that could not be read.
    pub failed: usize,
}

impl PlansRead {
    /// What the plans left out.
    pub fn left_out(&self) -> LeftOut {
        let mut left_out = LeftOut::default();
        for network in &self.networks {
            left_out.add(&network.left_out);
        }
        left_out
    }

    /// The edges of all buildings' graphs: the openings between rooms, plan by plan, then stairs and lifts that lie over each
    /// other in storeys of one building that follow each other.
    pub fn edges(&self) -> Vec<Edge> {
        let mut edges: Vec<Edge> = self.networks.iter().flat_map(edges::within).collect();
        let mut buildings: BTreeMap<(Option<&Typology>, &str), Vec<usize>> = BTreeMap::new();
        for (index, network) in self.networks.iter().enumerate() {
            buildings.entry((network.typology.as_ref(), &network.building)).or_default().push(index);
        }
        for mut storeys in buildings.into_values() {
            storeys.sort_by_cached_key(|&index| {
                let RoomNetwork { storey, plan, .. } = &self.networks[index];
                (level_key(storey), NaturalKey::of(storey), NaturalKey::of(plan), index)
            });
            for pair in storeys.windows(2) {
                let [lower, upper] = [pair[0], pair[1]];
                let links = self.shafts[lower].links_to(&self.shafts[upper]);
                let edge = |link| edges::between(&self.networks[lower], &self.networks[upper], link);
                edges.extend(links.iter().map(edge));
            }
        }
        edges
    }
}

/// What one file holds, ready to be put together with others.
pub struct FileRead {
    source: Source,
    plans: Vec<(RoomNetwork, Option<RoomNetwork>, Sighting, Shafts)>,
}

impl FileRead {
    /// The plans of a file. `sha256` is that of its bytes; `with_blind`: also as if their typology were unknown.
    pub fn new(file: &str, sha256: String, plans: &[Plan], schemes: &Schemes, with_blind: bool) -> Self {
        let each = |(storey, plan): (usize, &Plan)| {
            let pipeline = Pipeline::new(plan, schemes);
            let sighting = Sighting::of(plan, pipeline.analysis(), file, &sha256, storey);
            let network = RoomNetwork { file: file.to_owned(), ..pipeline.network().clone() };
            let blind = with_blind.then(|| RoomNetwork::without_typology(plan, schemes));
            let shafts = if plan.meta().building.is_empty() { Shafts::default() } else { Shafts::of(plan) };
            (network, blind, sighting, shafts)
        };
        let of_plans = plans.iter().enumerate().map(each).collect();
        let rooms = plans.iter().map(|plan| plan.rooms().len()).sum();
        Self { source: Source { file: file.to_owned(), sha256, plans: plans.len(), rooms }, plans: of_plans }
    }

    /// The file, as it was named.
    pub fn name(&self) -> &str {
        &self.source.file
    }
}

type BuildingKey = (Option<Typology>, String);

impl PlansRead {
    /// Adds the plans of a file, in the order of the files.
    pub fn add(&mut self, file: FileRead) {
        self.sources.push(file.source);
        for (network, blind, sighting, shafts) in file.plans {
            self.networks.push(network);
            self.shafts.push(shafts);
            self.blind.extend(blind);
            self.sightings.push(sighting);
        }
    }

    /// Once all are added: finds what was read twice, and which plans are of one building.
    pub fn put_together(&mut self) {
        // The spelling of a building's name sometimes differs between storeys; folds must not split it for
        // that.
        let mut spellings: BTreeMap<BuildingKey, String> = BTreeMap::new();
        for network in &mut self.networks {
            let key = (network.typology.clone(), building_name::key(&network.building));
            let first = spellings.entry(key).or_insert_with(|| network.building.clone());
            network.building.clone_from(first);
        }
        self.repeats = Repeats::find(&self.sightings);
        let groups = groups(self);
        for (index, group) in groups.into_iter().enumerate() {
            self.networks[index].group.clone_from(&group);
            if let Some(blind) = self.blind.get_mut(index) {
                blind.building.clone_from(&self.networks[index].building);
                blind.group = group;
            }
        }
    }

    /// Then, unless repeats are kept: each room counts once.
    pub fn leave_out_repeats(&mut self) {
        leave_out_repeats(self);
    }
}

/// What folds must not split, for each plan: its building; where plans of several are alike, these together.
fn groups(read: &PlansRead) -> Vec<String> {
    let mut group = read.repeats.groups(read.networks.len());
    let mut of_building: BTreeMap<BuildingKey, usize> = BTreeMap::new();
    for (index, network) in read.networks.iter().enumerate() {
        let key = (network.typology.clone(), network.building.clone());
        let first = *of_building.entry(key).or_insert(group[index]);
        let (from, to) = (group[index].max(group[first]), group[index].min(group[first]));
        // Few groups are ever joined.
        if from != to {
            group.iter_mut().filter(|it| **it == from).for_each(|it| *it = to);
        }
    }
    let mut names: BTreeMap<usize, Vec<&str>> = BTreeMap::new();
    for (network, &group) in read.networks.iter().zip(&group) {
        let names = names.entry(group).or_default();
        if !names.contains(&network.building.as_str()) {
            names.push(&network.building);
        }
    }
    group.iter().map(|group| names[group].join(" + ")).collect()
}

/// Marks rooms that are read twice, and takes plans away of which no other is left.
fn leave_out_repeats(read: &mut PlansRead) {
    for &(plan, room) in read.repeats.left_out.keys() {
        let id = read.sightings[plan].rooms[room].id;
        for network in [read.networks.get_mut(plan), read.blind.get_mut(plan)].into_iter().flatten() {
            if let Some(room) = network.rooms.iter_mut().find(|room| room.id == id) {
                room.is_repeat = true;
            }
        }
    }
    let is_kept = |network: &RoomNetwork| network.rooms.is_empty() || network.rooms.iter().any(|room| !room.is_repeat);
    let kept: Vec<bool> = read.networks.iter().map(is_kept).collect();
    retain(&mut read.networks, &kept);
    retain(&mut read.blind, &kept);
    retain(&mut read.shafts, &kept);
}

/// Keeps what is marked.
fn retain<T>(all: &mut Vec<T>, kept: &[bool]) {
    let mut kept = kept.iter();
    all.retain(|_| kept.next() == Some(&true));
}
