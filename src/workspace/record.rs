//! A file's entry as an index keeps it: JSON, so that what an older version left out or a newer one adds is seen as
//! another recipe and found out anew.

use std::sync::Arc;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD_NO_PAD as BASE64;
use serde::{Deserialize, Serialize};

use super::{Content, Outlines, PlanEntry, PlanFile, Problems, RoomEntry};
use crate::features::RoomStatus;
use crate::labels::{Label, Typology};
use crate::plan::{LabelOrigin, RoomId};
use crate::store::FileState;

#[derive(Serialize, Deserialize)]
struct Record {
    recipe: u64,
    modified_ns: u64,
    size: u64,
    settled: bool,
    hash: u64,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    broken: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    foreign: Option<String>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    plans: Vec<PlanRecord>,
}

#[derive(Serialize, Deserialize)]
struct PlanRecord {
    name: String,
    building: String,
    storey: String,
    typology: String,
    openings: usize,
    to_label: usize,
    labelled: usize,
    problems: [u32; 3],
    size_m: [f32; 2],
    predicted: bool,
    outlines: String,
    rooms: Vec<RoomRecord>,
}

/// Id, name, function, status (a label's index, 5: not classified, 6: none), the label's origin (its index, 9: none),
/// area, centre, the predicted label's index (9: none), its probability.
#[derive(Serialize, Deserialize)]
struct RoomRecord(String, String, String, u8, u8, f32, f32, f32, u8, f32);

const NOT_CLASSIFIED: u8 = 5;
const UNLABELLED: u8 = 6;
const NONE: u8 = 9;

/// A file as bytes. `recipe` says how its entries were made.
pub fn to_bytes(file: &PlanFile, recipe: u64) -> Vec<u8> {
    let (mut broken, mut foreign, mut plans) = (None, None, Vec::new());
    match &file.content {
        Content::Pending => {}
        Content::Broken(what) => broken = Some(what.clone()),
        Content::Foreign(kind) => foreign = Some(kind.clone()),
        Content::Plans(entries) => plans = entries.iter().map(plan_record).collect(),
    }
    let FileState { modified_ns, size, is_settled } = file.state;
    let record = Record { recipe, modified_ns, size, settled: is_settled, hash: file.hash, broken, foreign, plans };
    serde_json::to_vec(&record).unwrap_or_default()
}

/// A file of its bytes, if they were made by this recipe.
pub fn from_bytes(path: &str, bytes: &[u8], recipe: u64) -> Option<PlanFile> {
    let record: Record = serde_json::from_slice(bytes).ok().filter(|record: &Record| record.recipe == recipe)?;
    let content = match (record.broken, record.foreign) {
        (Some(what), _) => Content::Broken(what),
        (None, Some(kind)) => Content::Foreign(kind),
        (None, None) if record.plans.is_empty() => return None,
        (None, None) => Content::Plans(record.plans.into_iter().map(plan_entry).collect::<Option<_>>()?),
    };
    let state = FileState { modified_ns: record.modified_ns, size: record.size, is_settled: record.settled };
    Some(PlanFile { path: path.into(), state, hash: record.hash, content })
}

fn plan_record(plan: &PlanEntry) -> PlanRecord {
    let Problems { errors, warnings, infos } = plan.problems;
    PlanRecord {
        name: plan.name.to_string(),
        building: plan.building.to_string(),
        storey: plan.storey.to_string(),
        typology: plan.typology.as_ref().map(ToString::to_string).unwrap_or_default(),
        openings: plan.openings,
        to_label: plan.to_label,
        labelled: plan.labelled,
        problems: [errors, warnings, infos],
        size_m: plan.size_m,
        predicted: plan.is_predicted,
        outlines: BASE64.encode(plan.outlines.bytes()),
        rooms: plan.rooms.iter().map(room_record).collect(),
    }
}

fn room_record(room: &RoomEntry) -> RoomRecord {
    let status = match room.status {
        RoomStatus::Labelled(label) => label.index() as u8,
        RoomStatus::NotClassified => NOT_CLASSIFIED,
        RoomStatus::Unlabelled => UNLABELLED,
    };
    let origin = room.origin.and_then(|origin| LabelOrigin::ALL.iter().position(|it| *it == origin));
    let origin = origin.map_or(NONE, |at| at as u8);
    let (predicted, probability) = room.prediction.map_or((NONE, 0.0), |(label, it)| (label.index() as u8, it));
    let [x, y] = room.centre_m;
    let (id, name, function) = (room.id.to_string(), room.name.to_string(), room.function.to_string());
    RoomRecord(id, name, function, status, origin, room.area_m2, x, y, predicted, probability)
}

fn plan_entry(record: PlanRecord) -> Option<PlanEntry> {
    let [errors, warnings, infos] = record.problems;
    let mut rooms: Vec<RoomEntry> = Vec::with_capacity(record.rooms.len());
    for room in record.rooms {
        // Most rooms of a plan share a few functions.
        let known = rooms.iter().rev().take(40).map(|room| &room.function).find(|it| ***it == room.2).cloned();
        rooms.push(room_entry(room, known)?);
    }
    Some(PlanEntry {
        name: record.name.into(),
        building: record.building.into(),
        storey: record.storey.into(),
        typology: Typology::new(&record.typology),
        rooms,
        openings: record.openings,
        to_label: record.to_label,
        labelled: record.labelled,
        problems: Problems { errors, warnings, infos },
        size_m: record.size_m,
        outlines: Outlines::of_bytes(BASE64.decode(record.outlines).ok()?),
        is_predicted: record.predicted,
    })
}

fn room_entry(record: RoomRecord, known_function: Option<Arc<str>>) -> Option<RoomEntry> {
    let RoomRecord(id, name, function, status, origin, area_m2, x, y, predicted, probability) = record;
    let status = match status {
        NOT_CLASSIFIED => RoomStatus::NotClassified,
        UNLABELLED => RoomStatus::Unlabelled,
        label => RoomStatus::Labelled(*Label::ALL.get(usize::from(label))?),
    };
    Some(RoomEntry {
        id: id.parse::<RoomId>().ok()?,
        name: name.into(),
        function: known_function.unwrap_or_else(|| function.into()),
        status,
        origin: LabelOrigin::ALL.get(usize::from(origin)).copied(),
        area_m2,
        centre_m: [x, y],
        prediction: Label::ALL.get(usize::from(predicted)).map(|label| (*label, probability)),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::classify::models::Models;
    use crate::labels::Schemes;

    #[test]
    fn what_is_kept_of_a_file_reads_back_the_same() {
        let plans = crate::store::bundled_plans().unwrap();
        let (schemes, models) = (Schemes::bundled(), Models::bundled());
        let entries =
            vec![PlanEntry::of(&plans[0].1, &schemes, Some(&models)), PlanEntry::of(&plans[1].1, &schemes, None)];
        assert!(entries[0].rooms.iter().any(|room| room.prediction.is_some()));
        let state = FileState { modified_ns: 17, size: 4, is_settled: true };
        let contents =
            [Content::Plans(entries), Content::Broken("not closed".to_owned()), Content::Foreign("SVG".to_owned())];
        for content in contents {
            let file = PlanFile { path: "a/b.plan.json".into(), state, hash: u64::MAX, content };
            let bytes = to_bytes(&file, 3);
            assert_eq!(from_bytes("a/b.plan.json", &bytes, 3), Some(file));
            assert_eq!(from_bytes("a/b.plan.json", &bytes, 4), None);
            assert_eq!(from_bytes("a/b.plan.json", &bytes[..bytes.len() / 2], 3), None);
        }
        assert_eq!(from_bytes("a", b"{}", 3), None);
    }
}
