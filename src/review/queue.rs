//! The queue: all labelled rooms, those first whose labels a person's look is likeliest to change.

use std::collections::BTreeMap;

use super::Material;
use crate::base::wording::{count, sentence};
use crate::base::work::Work;
use crate::classify::Distribution;
use crate::classify::models::Models;
use crate::dataset::folds::group_of;
use crate::dataset::{Collection, Row};
use crate::features::NeighbourLabels;
use crate::labels::{Label, Meaning, Schemes, normalised_function};
use crate::plan::RoomId;
use crate::plan::titles::{printable, with_article};
use crate::study::StudyError;
use crate::study::suspects::{Suspect, suspects_by};

/// Why a room is worth a look.
#[derive(Clone, Debug, PartialEq)]
pub enum Reason {
    /// The label scheme gives its function another label.
    AgainstFunction { function: String, by_scheme: Label },
    /// Most other rooms of its function have another label: which, how many of how many.
    AgainstPeers { function: String, label: Label, rooms: usize, of: usize },
    /// Most rooms of the building that are about as large and of the same form have another label.
    AgainstAlike { label: Label, rooms: usize, of: usize },
    /// Classifiers that did not learn from it find another label likelier: with the reason they give, which may be empty.
    Unlikely { given: f64, label: Label, probability: f64, against: usize, asked: usize, why: String },
    /// They cannot decide between its label and another.
    Doubtful { other: Label, given: f64, probability: f64 },
    /// The check finds something wrong with it.
    Finding(String),
    /// Its plan is unlike the others, so that little of what they teach holds for it.
    Unlike,
    /// Somebody else labelled it otherwise, or gave it another function.
    OtherPerson { label: Option<Label>, function: String },
}

impl Reason {
    /// Its name for machines.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::AgainstFunction { .. } => "against its function",
            Self::AgainstPeers { .. } => "against rooms of its function",
            Self::AgainstAlike { .. } => "against rooms like it",
            Self::Unlikely { .. } => "unlikely",
            Self::Doubtful { .. } => "doubtful",
            Self::Finding(_) => "finding",
            Self::Unlike => "unlike plan",
            Self::OtherPerson { .. } => "another person",
        }
    }

    /// In a sentence or two.
    pub fn words(&self) -> String {
        let percent = |share: &f64| format!("{:.0} %", 100.0 * share);
        match self {
            Self::AgainstFunction { function, by_scheme } => {
                format!("Its function, {}, makes it {}.", printable(function), with_article(by_scheme.name()))
            }
            Self::AgainstPeers { function, label, rooms, of } => {
                format!("Of {of} other rooms with the function {}, {rooms} are labelled {label}.", printable(function))
            }
            Self::AgainstAlike { label, rooms, of } => {
                format!(
                    "Of {} of the same size and form in its building, {rooms} {} labelled {label}.",
                    count(*of, "other room"),
                    if *rooms == 1 { "is" } else { "are" }
                )
            }
            Self::Unlikely { given, label, probability, against, asked, why } => {
                let who = if *asked > 1 {
                    format!("{against} of {asked} classifiers that did not learn from it say otherwise")
                } else {
                    "The model says otherwise".to_owned()
                };
                let said = format!("{who}: {label} {}, its label {}.", percent(probability), percent(given));
                if why.is_empty() { said } else { format!("{said} {why}") }
            }
            Self::Doubtful { other, given, probability } => {
                format!("Its label has {}, {other} {}: not much between them.", percent(given), percent(probability))
            }
            Self::Finding(what) => sentence(&format!("{what}.")),
            Self::Unlike => "Its plan is unlike the others, so judge it by itself.".to_owned(),
            Self::OtherPerson { label, function } => {
                let label = label.map_or("no label", Label::name);
                let function = if function.is_empty() { "no function".to_owned() } else { printable(function) };
                format!("The other person says: {label}, {function}.")
            }
        }
    }
}

/// A room of the queue.
#[derive(Clone, Debug)]
pub struct Entry {
    /// Names, label and features; `file` and `id` find it again.
    pub row: Row,
    pub room: RoomId,
    /// Which plan of its file, from 0.
    pub storey_of_file: usize,
    /// What classifiers say that did not learn from it, and rooms like it, together.
    pub said: Distribution,
    /// How likely its label is wrong by all that is known, 0..=1: what the queue is ordered by. A rank more than a probability.
    pub worth: f64,
    /// The strongest first; empty where nothing speaks against the label.
    pub reasons: Vec<Reason>,
}

impl Entry {
    /// The likeliest label but the one given.
    pub fn other(&self) -> Label {
        match self.reasons.first() {
            Some(Reason::AgainstFunction { by_scheme, .. }) => return *by_scheme,
            Some(Reason::OtherPerson { label: Some(label), .. }) => return *label,
            _ => {}
        }
        let others = Label::ALL.into_iter().filter(|&label| label != self.row.label);
        let best = others.reduce(
            |best, label| {
                if self.said.probability(label) > self.said.probability(best) { label } else { best }
            },
        );
        best.unwrap_or(self.row.label)
    }

    /// All reasons in one text.
    pub fn reasons_in_words(&self) -> String {
        self.reasons.iter().map(Reason::words).collect::<Vec<_>>().join(" ")
    }
}

/// The rooms in the order in which to look at them.
#[derive(Clone, Debug, Default)]
pub struct Queue {
    pub entries: Vec<Entry>,
    /// What to know of the whole queue, in sentences.
    pub notes: Vec<String>,
}

/// What the evidence adds to the log-odds of a wrong label, besides the probability of the label. Chosen by hand on planted errors
/// (`examples/planted_errors`): a label against its function is wrong more often than not whatever else is known; a finding or
/// a plan unlike the others only decides between rooms that are equally doubtful.
const AGAINST_FUNCTION: f64 = 5.0;
const FINDING: f64 = 0.3;
const UNLIKE: f64 = 0.2;

/// A label is in doubt if another has at least this share of its probability.
const DOUBTFUL: f64 = 0.5;

/// The order in which the labelled rooms of plans are best looked at. `models` are asked where a typology has too few rooms to
/// learn from. The same plans give the same queue, in whatever order their files were read.
///
/// # Errors
/// When no room has a label, or the work is cancelled.
pub fn queue(
    material: &Material,
    schemes: &Schemes,
    models: &Models,
    folds: usize,
    seed: u64,
    work: &Work<'_>,
) -> Result<Queue, StudyError> {
    let collection = Collection::Plans(material.networks().to_vec());
    let suspects = suspects_by(&collection, folds, seed, models, work)?;
    let networks = collection.networks();
    let unlike = unlike(&suspects, networks.len());
    let mut notes = Vec::new();
    let unlike_plans = unlike.iter().filter(|&&is_unlike| is_unlike).count();
    if unlike_plans > 0 {
        let are = if unlike_plans == 1 { "is" } else { "are" };
        notes.push(format!("{} {are} unlike the others.", count(unlike_plans, "plan")));
    }
    let mut entries: Vec<Entry> = suspects
        .into_iter()
        .map(|suspect| {
            let room = networks[suspect.place.network].rooms[suspect.place.room].id;
            let known = material.known(&suspect.row.file, room);
            let reasons = reasons(&suspect, schemes, &known.findings, unlike[suspect.place.network]);
            let mut odds = suspect.odds().ln();
            for reason in &reasons {
                odds += match reason {
                    Reason::AgainstFunction { .. } => AGAINST_FUNCTION,
                    Reason::Finding(_) => FINDING,
                    Reason::Unlike => UNLIKE,
                    // In the probability already.
                    _ => 0.0,
                };
            }
            let worth = 1.0 / (1.0 + (-odds).exp());
            let Suspect { row, said, .. } = suspect;
            Entry { row, room, storey_of_file: known.storey_of_file, said, worth, reasons }
        })
        .collect();
    entries.sort_by(|p, q| {
        let key = |entry: &Entry| (entry.row.file.clone(), entry.storey_of_file, entry.room);
        q.worth.total_cmp(&p.worth).then_with(|| key(p).cmp(&key(q)))
    });
    Ok(Queue { entries, notes })
}

/// The labelled rooms that somebody else, whose plans have files of the same names, labelled otherwise or gave another function,
/// in the order of the plans: to go through them and choose.
pub fn differences(first: &Material, second: &Material) -> Queue {
    let mut theirs: BTreeMap<(&str, RoomId), (Option<Label>, &str)> = BTreeMap::new();
    for network in second.networks() {
        for room in &network.rooms {
            theirs.entry((&network.file, room.id)).or_insert((room.label, &room.function));
        }
    }
    let mut entries = Vec::new();
    for network in first.networks() {
        let rows = network.rows_seeing(&network.seen_labels(&network.known_labels(), NeighbourLabels::True));
        let rooms: Vec<RoomId> = network.labelled().map(|room| network.rooms[room].id).collect();
        for (row, room) in rows.zip(rooms) {
            let Some(&(label, function)) = theirs.get(&(row.file.as_str(), room)) else { continue };
            if label == Some(row.label) && normalised_function(function) == normalised_function(&row.function) {
                continue;
            }
            let mut weights = [0.0; 5];
            weights[row.label.index()] += 1.0;
            if let Some(label) = label {
                weights[label.index()] += 1.0;
            }
            entries.push(Entry {
                room,
                storey_of_file: first.known(&row.file, room).storey_of_file,
                said: Distribution::from_weights(weights),
                worth: 1.0,
                reasons: vec![Reason::OtherPerson { label, function: function.to_owned() }],
                row,
            });
        }
    }
    let notes = if entries.is_empty() { vec!["No label and no function differs.".to_owned()] } else { Vec::new() };
    Queue { entries, notes }
}

/// What speaks against a label, or for looking at it all the same.
fn reasons(suspect: &Suspect, schemes: &Schemes, findings: &[String], is_unlike: bool) -> Vec<Reason> {
    let row = &suspect.row;
    let mut reasons = Vec::new();
    let function = row.function.trim().to_owned();
    if let Some(Meaning::Labelled(by_scheme)) = schemes.meaning(row.typology.as_ref(), &function)
        && by_scheme != row.label
    {
        reasons.push(Reason::AgainstFunction { function: function.clone(), by_scheme });
    }
    if let Some((label, rooms, of)) = suspect.by_function {
        reasons.push(Reason::AgainstPeers { function, label, rooms, of });
    }
    let of: usize = suspect.alike.iter().sum();
    let most =
        Label::ALL.into_iter().max_by_key(|label| (suspect.alike[label.index()], std::cmp::Reverse(label.index())));
    if let Some(label) = most.filter(|&label| label != row.label && 2 * suspect.alike[label.index()] > of) {
        reasons.push(Reason::AgainstAlike { label, rooms: suspect.alike[label.index()], of });
    }
    let said = &suspect.said;
    let (given, label) = (suspect.probability(), said.label());
    if label != row.label {
        reasons.push(Reason::Unlikely {
            given,
            label,
            probability: said.probability(label),
            against: suspect.against,
            asked: suspect.asked,
            why: suspect.reason.clone(),
        });
    } else {
        let others = Label::ALL.into_iter().filter(|&other| other != label);
        let next = others.max_by(|&p, &q| said.probability(p).total_cmp(&said.probability(q)));
        if let Some(other) = next.filter(|&other| said.probability(other) >= DOUBTFUL * given) {
            reasons.push(Reason::Doubtful { other, given, probability: said.probability(other) });
        }
    }
    reasons.extend(findings.iter().cloned().map(Reason::Finding));
    if is_unlike {
        reasons.push(Reason::Unlike);
    }
    reasons
}

/// With fewer plans none is unlike the others.
const LEAST_PLANS: usize = 8;

/// Distances are to a sample of at most so many rooms.
const SAMPLE: usize = 2000;

/// A plan is unlike the others if its rooms are so many times as far from the nearest room of another building as is usual...
const FAR: f64 = 3.0;

/// ...and at least so far: in steps of 12 % of an area and 18 % of an axes ratio, or one opening.
const LEAST_FAR: f64 = 1.5;

/// For each plan whether it is unlike the others: by the median distance of its rooms, in area, axes ratio and openings, to the
/// nearest room of another building.
fn unlike(suspects: &[Suspect], plans: usize) -> Vec<bool> {
    let place = |suspect: &Suspect| {
        let features = &suspect.row.features;
        let log = |value: f64| value.max(0.1).ln();
        [log(features.area_m2) / 0.12, log(features.axes_ratio) / 0.18, f64::from(features.doors)]
    };
    let mut by_place: Vec<&Suspect> = suspects.iter().collect();
    by_place.sort_by_key(|suspect| suspect.place);
    let step = by_place.len().div_ceil(SAMPLE).max(1);
    let sample: Vec<(&str, [f64; 3])> =
        by_place.iter().step_by(step).map(|suspect| (group_of(&suspect.row), place(suspect))).collect();
    let mut of_plans: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
    for suspect in by_place {
        let (own, at) = (group_of(&suspect.row), place(suspect));
        let distance = |other: &[f64; 3]| at.iter().zip(other).map(|(p, q)| (p - q) * (p - q)).sum::<f64>().sqrt();
        let others = sample.iter().filter(|(group, _)| *group != own);
        let nearest = others.map(|(_, other)| distance(other)).min_by(f64::total_cmp);
        of_plans.entry(suspect.place.network).or_default().extend(nearest);
    }
    let medians: BTreeMap<usize, f64> =
        of_plans.into_iter().filter_map(|(plan, distances)| Some((plan, median(distances)?))).collect();
    let usual = median(medians.values().copied().collect()).unwrap_or_default();
    let is_unlike = |plan: usize| {
        let far = medians.get(&plan).copied().unwrap_or_default();
        medians.len() >= LEAST_PLANS && far > LEAST_FAR && far > FAR * usual
    };
    (0..plans).map(is_unlike).collect()
}

fn median(mut of: Vec<f64>) -> Option<f64> {
    of.sort_by(f64::total_cmp);
    of.get(of.len() / 2).copied()
}
