//! The schedule of rooms: a table with the areas of each, for spreadsheets.

use super::{Export, Exporter, Format, Holds, Lost, NamedBytes, NamedPlan, Options, Refused};
use crate::base::natural_order::NaturalKey;
use crate::dataset::BY_SCHEME;
use crate::dataset::csv::{Guard, cell};
use crate::features::{NeighbourLabels, analyse};
use crate::labels::{Label, Schemes};
use crate::plan::titles::numbers_of_unnamed;
use crate::plan::{Plan, Room, RoomId};

/// The schedule of rooms.
pub const FORMAT: Format = Format {
    id: "room-schedule",
    name: "Room schedule",
    endings: &["rooms.csv"],
    about: "A table of the rooms with their labels and who gave them, their clear area, the area along axes and the doors, for spreadsheets",
    importer: None,
    exporter: Some(&RoomSchedule),
};

/// The columns, in order. Areas in m², lengths in metres.
const COLUMNS: [&str; 10] = [
    "storey",
    "room",
    "function",
    "label",
    "label_origin",
    "clear area [m²]",
    "clear perimeter [m]",
    "area along axes, a [m²]",
    "doors and passages",
    "note",
];

struct RoomSchedule;

impl Exporter for RoomSchedule {
    fn holds(&self) -> Holds {
        Holds::OnePlan
    }

    fn write(&self, plans: &[NamedPlan<'_>], schemes: &Schemes, _: &Options) -> Result<Export, Refused> {
        let mut export = Export::default();
        for &NamedPlan { stem, plan } in plans {
            let table = table(plan, schemes);
            // Writing to memory does not fail; were it to, the table would be missing and said to be.
            match table {
                Ok(bytes) => export.files.push(NamedBytes { name: format!("{stem}.rooms.csv"), bytes }),
                Err(error) => export.lost.push(Lost { stem: stem.to_owned(), what: error.to_string() }),
            }
        }
        Ok(export)
    }
}

/// The rooms of a plan by name, those numbered in the order of their numbers.
fn table(plan: &Plan, schemes: &Schemes) -> Result<Vec<u8>, Box<dyn std::error::Error>> {
    let analysis = analyse(plan, schemes, NeighbourLabels::True);
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(COLUMNS)?;
    let row = |(id, key): (RoomId, String)| {
        let (room, analysed) = (plan.room(id)?, analysis.room(id)?);
        let label = analysed.status.label().map(Label::name).unwrap_or_default();
        // As in a dataset.
        let origin = match (analysed.status.label(), room.given_label()) {
            (None, _) => "",
            (Some(_), Some(given)) => given.origin.name(),
            (Some(_), None) => BY_SCHEME,
        };
        let texts = [&plan.meta().storey, &key, &room.function, label, origin].map(|text| Guard::On.cell(text));
        let net = analysis.net(id);
        let number = |value: Option<f64>, decimals: f64| value.map(|value| cell((value * decimals).round() / decimals));
        let numbers = [
            number(net.map(|net| net.area_m2), 1e2),
            number(net.map(|net| net.perimeter_m()), 1e2),
            number(analysis.shapes.get(id).map(|shape| shape.area_m2()).filter(|area_m2| *area_m2 > 0.0), 1e2),
            analysed.features.map(|features| features.doors.to_string()),
        ];
        let note = Guard::On.cell(&room.note);
        Some(texts.into_iter().chain(numbers.map(Option::unwrap_or_default)).chain([note]).collect::<Vec<String>>())
    };
    // As a person calls them: an id would say nothing there.
    let numbers = numbers_of_unnamed(plan, &analysis.shapes.reading_order());
    let name = |(id, room): (RoomId, &Room)| match numbers.get(&id) {
        Some(number) => (id, format!("Room {number}")),
        None => (id, room.name.clone()),
    };
    let mut names: Vec<(RoomId, String)> = plan.rooms().map(name).collect();
    names.sort_by_cached_key(|(id, name)| (NaturalKey::of(name), *id));
    for cells in names.into_iter().filter_map(row) {
        writer.write_record(cells)?;
    }
    Ok(writer.into_inner()?)
}
