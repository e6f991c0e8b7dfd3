//! What the queue is made from: the plans of a folder, each room once, and what the check finds in them.

use std::collections::BTreeMap;

use crate::check::{Severity, check};
use crate::dataset::RoomNetwork;
use crate::gather::{FileRead, PlansRead};
use crate::labels::Schemes;
use crate::pipeline::Pipeline;
use crate::plan::{ElementId, Plan, RoomId};

/// What is known of a room besides its network.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Known {
    /// Which plan of its file it stands in, from 0.
    pub storey_of_file: usize,
    /// What the check says of it, in words, without full stops; what is ignored in the plan is not here.
    pub findings: Vec<String>,
}

/// A room by its file and its id.
type Key = (String, RoomId);

/// One file, ready to be put together with others.
pub struct FileSeen {
    read: FileRead,
    known: Vec<(Key, Known)>,
}

impl FileSeen {
    /// The plans of a file, by the name that entries of the queue will give it. `sha256` is that of its bytes; empty where there
    /// are none.
    pub fn new(file: &str, sha256: String, plans: &[Plan], schemes: &Schemes) -> Self {
        let mut known = Vec::new();
        for (storey_of_file, plan) in plans.iter().enumerate() {
            let mut of_rooms: BTreeMap<RoomId, Known> =
                plan.rooms().map(|(id, _)| (id, Known { storey_of_file, findings: Vec::new() })).collect();
            let pipeline = Pipeline::new(plan, schemes);
            for finding in check(plan, pipeline.analysis(), schemes) {
                let counts = finding.severity() != Severity::Info || ABOUT_LABELS.contains(&finding.kind().name);
                if !counts || finding.ignored_in(plan).is_some() {
                    continue;
                }
                for element in finding.place().elements {
                    if let ElementId::Room(id) = element
                        && let Some(room) = of_rooms.get_mut(&id)
                    {
                        room.findings.push(finding.what());
                    }
                }
            }
            known.extend(of_rooms.into_iter().map(|(id, known)| ((file.to_owned(), id), known)));
        }
        Self { read: FileRead::new(file, sha256, plans, schemes, false), known }
    }
}

/// Findings that are no mistakes by themselves, but go with wrong labels.
const ABOUT_LABELS: &[&str] = &["room_area_is_unusual", "axes_ratio_is_implausible"];

/// The plans of a folder.
#[derive(Default)]
pub struct Material {
    read: PlansRead,
    known: BTreeMap<Key, Known>,
}

impl Material {
    /// Files put together. Their order changes nothing.
    pub fn new(files: impl IntoIterator<Item = FileSeen>) -> Self {
        let mut material = Self::default();
        let mut files: Vec<FileSeen> = files.into_iter().collect();
        files.sort_by(|p, q| p.read.name().cmp(q.read.name()));
        for file in files {
            // Of two storeys with the same room the first counts, as everywhere.
            for (key, known) in file.known {
                material.known.entry(key).or_insert(known);
            }
            material.read.add(file.read);
        }
        material.read.put_together();
        material.read.leave_out_repeats();
        material
    }

    /// The plans' networks, without those that are another's copy.
    pub fn networks(&self) -> &[RoomNetwork] {
        &self.read.networks
    }

    pub(super) fn known(&self, file: &str, id: RoomId) -> Known {
        self.known.get(&(file.to_owned(), id)).cloned().unwrap_or_default()
    }
}
