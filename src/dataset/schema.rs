//! What a dataset's columns mean, for machines: a Table Schema (frictionlessdata.io, Data Package standard).

use serde_json::{Value, json};

use super::csv::COLUMNS;
use crate::labels::Label;

/// Name, type and meaning of each column, in any order; [`schema`] takes them in that of [`COLUMNS`].
const MEANINGS: &[(&str, &str, &str)] = &[
    ("file", "string", "The file the room was read from, as it was named; with 'id' the key of the row"),
    ("id", "string", "The room's id in its plan"),
    ("building", "string", "The building; a plan that names none stands for itself"),
    ("typology", "string", "The building's typology: house, school, office or another; empty where unknown"),
    ("storey", "string", "Which storey of the building; empty where unknown"),
    ("plan", "string", "The plan's name; not unique"),
    ("room", "string", "The room's name, else its id in the source, else its id; not unique"),
    ("function", "string", "What the room is for, as the source wrote it"),
    ("label", "string", "The label: S small room, M medium room, B big room, C corridor, H hall"),
    (
        "label_origin",
        "string",
        "Who gave the label: person, imported, accepted prediction, or scheme where it follows from the function",
    ),
    ("fold", "integer", "The fold the room is tested in, from 1; empty where there are too few rooms or buildings"),
    ("a", "number", "Area in square metres, holes taken off"),
    ("rt", "number", "Axes ratio: the longest wall by the longest one perpendicular to it"),
    ("d", "integer", "Number of openings, those to the outside included, windows not"),
    ("l_S", "integer", "Number of openings that lead to small rooms"),
    ("l_M", "integer", "Number of openings that lead to medium rooms"),
    ("l_B", "integer", "Number of openings that lead to big rooms"),
    ("l_C", "integer", "Number of openings that lead to corridors"),
    ("l_H", "integer", "Number of openings that lead to halls"),
    ("group", "string", "What folds never split: the building, with the buildings of its near twins"),
];

/// The schema of a dataset's CSV file.
pub fn schema() -> Value {
    let fields: Vec<Value> = COLUMNS
        .iter()
        .filter_map(|&column| {
            let (name, kind, description) = MEANINGS.iter().find(|(name, ..)| *name == column)?;
            let mut field = json!({ "name": name, "type": kind, "description": description });
            let constraints = match *name {
                "file" | "id" => json!({ "required": true }),
                "label" => json!({ "required": true, "enum": Label::ALL.map(Label::letter) }),
                "fold" => json!({ "minimum": 1 }),
                _ if *kind != "string" => json!({ "required": true, "minimum": 0 }),
                _ => return Some(field),
            };
            field["constraints"] = constraints;
            Some(field)
        })
        .collect();
    json!({
        "$schema": "https://datapackage.org/profiles/2.0/tableschema.json",
        "fields": fields,
        "missingValues": [""],
        "primaryKey": ["file", "id"],
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_column_is_described() {
        let fields = schema()["fields"].as_array().cloned().unwrap();
        assert_eq!(fields.iter().map(|field| field["name"].as_str().unwrap()).collect::<Vec<_>>(), COLUMNS);
        assert_eq!(MEANINGS.len(), COLUMNS.len());
    }
}
