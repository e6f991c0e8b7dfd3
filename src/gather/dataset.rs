//! The dataset of labelled rooms that plans make, with what its columns mean and how it came about.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use serde_json::json;

use super::{Manifest, PlansRead, json_bytes};
use crate::dataset::edges::{self, Edge};
use crate::dataset::folds::{Grouping, building_of};
use crate::dataset::{Collection, LeftOut, Row, csv, fold_table, schema};
use crate::features::NeighbourLabels;
use crate::labels::{Label, Schemes, Typology};

/// A dataset as files.
pub struct Made {
    /// The table.
    pub csv: Vec<u8>,
    /// The ways between rooms: a table of its own.
    pub edges: Vec<u8>,
    /// What the columns of both mean, and how it came about: JSON.
    pub schema: Vec<u8>,
    pub edges_schema: Vec<u8>,
    pub manifest: Vec<u8>,
    /// Its rows, and the buildings they are of.
    pub rooms: usize,
    pub buildings: usize,
    pub left_out: LeftOut,
}

/// The folds that are dealt where nobody says otherwise: the paper's ten, which split no building.
const FOLDS: usize = 10;
const SEED: u64 = 1;

/// The dataset as `enfilade dataset` makes it without options. `table` is where it goes, `command` a call that makes
/// the same.
///
/// # Errors
/// When the table cannot be written, which no text here causes.
pub fn made(mut read: PlansRead, schemes: &Schemes, table: &Path, command: &str) -> Result<Made, String> {
    let left_out = read.left_out();
    let edges = read.edges();
    let neighbours = NeighbourLabels::True;
    let plans = Collection::Plans(std::mem::take(&mut read.networks));
    let mut rows = plans.rows(neighbours).unwrap_or_default();
    fold_table::deal(&mut rows, Grouping::Building, FOLDS, SEED);
    let mut bytes = Vec::new();
    csv::write_guarded(&mut bytes, &rows, csv::Guard::Off).map_err(|error| error.to_string())?;
    let edges_bytes = edges_table(&edges, csv::Guard::Off).map_err(|error| error.to_string())?;
    let folds = json!({ "count": FOLDS, "by": Grouping::Building.name(), "seed": SEED });
    let manifest = Manifest::of_table(table, command, &bytes, rows.len())
        .with("folds", folds)
        .with("neighbours", json!(neighbours.name()))
        .with_edges(table, &edges_bytes, edges.len());
    let manifest = told_of(manifest, &rows, &read, &left_out).with_schemes(schemes, &[]);
    Ok(Made {
        csv: bytes,
        edges: edges_bytes,
        schema: json_bytes(&schema()),
        edges_schema: json_bytes(&edges::schema()),
        manifest: manifest.bytes(),
        rooms: rows.len(),
        buildings: buildings(&rows),
        left_out,
    })
}

/// The table of edges.
///
/// # Errors
/// When it cannot be written, which no text here causes.
pub fn edges_table(edges: &[Edge], guard: csv::Guard) -> Result<Vec<u8>, ::csv::Error> {
    let mut bytes = Vec::new();
    edges::write(&mut bytes, edges, guard)?;
    Ok(bytes)
}

/// How many buildings rows are of.
fn buildings(rows: &[Row]) -> usize {
    let buildings: BTreeSet<(Option<&Typology>, &str)> =
        rows.iter().map(|row| (row.typology.as_ref(), building_of(row))).collect();
    buildings.len()
}

/// A manifest with the counts of rows, and with where they come from.
#[must_use]
pub fn told_of(manifest: Manifest, rows: &[Row], read: &PlansRead, left_out: &LeftOut) -> Manifest {
    let plans: BTreeSet<(&str, &str, &str)> =
        rows.iter().map(|row| (row.file.as_str(), row.plan.as_str(), row.storey.as_str())).collect();
    let mut labels: BTreeMap<&str, usize> = Label::ALL.iter().map(|label| (label.letter(), 0)).collect();
    let mut typologies: BTreeMap<&str, usize> = BTreeMap::new();
    for row in rows {
        *labels.entry(row.label.letter()).or_default() += 1;
        *typologies.entry(row.typology.as_ref().map(Typology::as_str).unwrap_or_default()).or_default() += 1;
    }
    manifest
        .with(
            "counts",
            json!({
                "rooms": rows.len(),
                "plans": plans.len(),
                "buildings": buildings(rows),
                "labels": labels,
                "typologies": typologies,
                "without_fold": rows.iter().filter(|row| row.fold.is_none()).count(),
                "files_not_read": read.failed,
            }),
        )
        .with_left_out(left_out)
        .with_plans(read)
}
