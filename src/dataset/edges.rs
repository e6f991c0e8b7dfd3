//! The edges of a building's graph: the ways from room to room, within a storey and between storeys.

use serde_json::{Value, json};

use super::RoomNetwork;
use super::csv::{Guard, cell};
use crate::labels::Typology;
use crate::plan::RoomId;
use crate::topology::vertical::VerticalLink;

/// A way between two rooms.
#[derive(Clone, Debug, PartialEq)]
pub struct Edge {
    pub building: String,
    pub typology: Option<Typology>,
    /// The kind of opening, or 'stairs' or 'lift'.
    pub kind: &'static str,
    /// Of a way between storeys the room below.
    pub from: End,
    /// Of a way between storeys the room above.
    pub to: End,
    /// Of a way between storeys, the area that both rooms cover as a share of the smaller one.
    pub overlap: Option<f64>,
}

/// A room at the end of an edge, as rows of a dataset name it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct End {
    pub file: String,
    pub storey: String,
    pub id: RoomId,
}

impl End {
    fn of(network: &RoomNetwork, id: RoomId) -> Self {
        Self { file: network.file.clone(), storey: network.storey.clone(), id }
    }
}

/// The edges within a storey: one for each opening between two rooms that are classified, in the order of the rooms.
pub fn within(network: &RoomNetwork) -> Vec<Edge> {
    let mut edges = Vec::new();
    for (from, room) in network.rooms.iter().enumerate() {
        // Each opening stands at both its rooms.
        for (door, to) in room.doors.iter().filter_map(|door| Some((door, door.to.filter(|to| *to > from)?))) {
            let other = &network.rooms[to];
            if room.is_repeat && other.is_repeat {
                continue;
            }
            edges.push(Edge {
                building: network.building.clone(),
                typology: network.typology.clone(),
                kind: door.kind.name(),
                from: End::of(network, room.id),
                to: End::of(network, other.id),
                overlap: None,
            });
        }
    }
    edges
}

/// The edge that a link between two storeys is.
pub fn between(lower: &RoomNetwork, upper: &RoomNetwork, link: &VerticalLink) -> Edge {
    Edge {
        building: lower.building.clone(),
        typology: lower.typology.clone(),
        kind: link.shaft.name(),
        from: End::of(lower, link.lower),
        to: End::of(upper, link.upper),
        overlap: Some(link.overlap),
    }
}

/// Name, type and meaning of each column, in order.
const COLUMNS: [(&str, &str, &str); 10] = [
    ("building", "string", "The building; a plan that names none stands for itself"),
    ("typology", "string", "The building's typology; empty where unknown"),
    ("kind", "string", "What joins the rooms: door, double door, passage, or between storeys stairs or lift"),
    ("from_file", "string", "The file of one room, of the lower one between storeys"),
    ("from_storey", "string", "Its storey; empty where unknown"),
    ("from_id", "string", "Its id; with the file the key of its row in the dataset, if it has one"),
    ("to_file", "string", "The file of the other room, of the upper one between storeys"),
    ("to_storey", "string", "Its storey; empty where unknown"),
    ("to_id", "string", "Its id"),
    ("overlap", "number", "Between storeys: the area that both rooms cover as a share of the smaller one; else empty"),
];

/// Writes edges as CSV with a header.
///
/// # Errors
/// When the writer fails.
pub fn write(out: impl std::io::Write, edges: &[Edge], guard: Guard) -> Result<(), ::csv::Error> {
    let mut writer = ::csv::Writer::from_writer(out);
    writer.write_record(COLUMNS.map(|(name, ..)| name))?;
    for edge in edges {
        let typology = edge.typology.as_ref().map(Typology::as_str).unwrap_or_default();
        let texts = [&edge.building, typology, edge.kind].map(|text| guard.cell(text));
        let end = |end: &End| [guard.cell(&end.file), guard.cell(&end.storey), end.id.to_string()];
        let overlap = edge.overlap.map(cell).unwrap_or_default();
        writer.write_record(texts.into_iter().chain(end(&edge.from)).chain(end(&edge.to)).chain([overlap]))?;
    }
    writer.flush()?;
    Ok(())
}

/// What the columns mean, for machines: a Table Schema, as [`super::schema()`] for the rooms.
pub fn schema() -> Value {
    let fields = COLUMNS.map(|(name, kind, description)| {
        let constraints = match name {
            "overlap" => json!({ "minimum": 0, "maximum": 1 }),
            "building" | "typology" | "from_storey" | "to_storey" => json!({}),
            _ => json!({ "required": true }),
        };
        json!({ "name": name, "type": kind, "description": description, "constraints": constraints })
    });
    json!({
        "$schema": "https://datapackage.org/profiles/2.0/tableschema.json",
        "fields": fields,
        "missingValues": [""],
    })
}
