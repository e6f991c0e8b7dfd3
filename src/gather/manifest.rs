//! What stands beside a table: what its columns mean, and a manifest that tells how it came about and whether it is still the same.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::{PlansRead, Source, sha256};
use crate::dataset::LeftOut;
use crate::dataset::repeats::Likeness;
use crate::labels::Schemes;

/// A manifest: how a table came about. The same input, call and version give the same bytes; no date stands in it.
pub struct Manifest(serde_json::Map<String, Value>);

impl Manifest {
    /// The manifest of a table that was written as these bytes by a call, as one would type it.
    pub fn of_table(path: &Path, command: &str, bytes: &[u8], rows: usize) -> Self {
        let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        let mut manifest = serde_json::Map::new();
        manifest.insert("format".to_owned(), json!("enfilade manifest"));
        manifest.insert("version".to_owned(), json!(1));
        manifest.insert("program".to_owned(), json!(program()));
        manifest.insert("command".to_owned(), json!(command));
        manifest.insert("table".to_owned(), json!({ "file": name, "sha256": sha256(bytes), "rows": rows }));
        Self(manifest)
    }

    /// The manifest of several files that were written: name and bytes of each.
    pub fn of_folder<'a>(files: impl IntoIterator<Item = (&'a str, &'a [u8])>) -> Self {
        let files = files.into_iter().map(|(name, bytes)| json!({ "file": name, "sha256": sha256(bytes) }));
        let files: Vec<Value> = files.collect();
        let manifest = json!({ "format": "enfilade manifest", "version": 1, "program": program(), "files": files });
        Self(manifest.as_object().cloned().unwrap_or_default())
    }

    #[must_use]
    pub fn with(mut self, name: &str, value: Value) -> Self {
        self.0.insert(name.to_owned(), value);
        self
    }

    /// With the table of the ways between rooms, which stands beside the table of rooms.
    #[must_use]
    pub fn with_edges(self, table: &Path, bytes: &[u8], edges: usize) -> Self {
        let path = beside(table, "edges.csv");
        let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        self.with("edges", json!({ "file": name, "sha256": sha256(bytes), "rows": edges }))
    }

    /// With the files that were read, and what was read twice.
    #[must_use]
    pub fn with_plans(self, plans: &PlansRead) -> Self {
        let title = |index: usize| plans.sightings[index].title();
        let pairs = |likeness: Likeness| -> Vec<Value> {
            let of = plans.repeats.pairs.iter().filter(|pair| pair.likeness == likeness);
            of.map(
                |pair| json!({ "first": title(pair.first), "second": title(pair.second), "rooms": pair.rooms.len() }),
            )
            .collect()
        };
        self.with("sources", sources(&plans.sources))
            .with("repeats", json!(pairs(Likeness::Same)))
            .with("near_twins", json!(pairs(Likeness::Twins)))
            .with("rooms_read_twice", json!(plans.repeats.left_out.len()))
    }

    /// With the label schemes: the files named, and a hash of all that holds.
    #[must_use]
    pub fn with_schemes(self, schemes: &Schemes, files: &[PathBuf]) -> Self {
        let files: Vec<String> = files.iter().map(|file| file.display().to_string()).collect();
        self.with("schemes", json!({ "files": files, "sha256": sha256(format!("{schemes:?}").as_bytes()) }))
    }

    /// With the rooms that did not become rows.
    #[must_use]
    pub fn with_left_out(self, left_out: &LeftOut) -> Self {
        let unknown: Vec<Value> = left_out
            .unknown_functions
            .iter()
            .map(|((typology, function), rooms)| json!({ "typology": typology, "function": function, "rooms": rooms }))
            .collect();
        self.with(
            "left_out",
            json!({
                "not_classified": left_out.not_classified,
                "without_function": left_out.without_function,
                "without_area": left_out.without_area,
                "unknown_functions": unknown,
            }),
        )
    }

    /// The file.
    pub fn bytes(self) -> Vec<u8> {
        json_bytes(&Value::Object(self.0))
    }
}

pub fn sources(sources: &[Source]) -> Value {
    let of = |source: &Source| json!({ "file": source.file, "sha256": source.sha256, "plans": source.plans, "rooms": source.rooms });
    sources.iter().map(of).collect()
}

/// The program and its version.
pub fn program() -> String {
    format!("enfilade {}", env!("CARGO_PKG_VERSION"))
}

/// JSON as it is written in files of its own.
pub fn json_bytes(value: &Value) -> Vec<u8> {
    format!("{value:#}\n").into_bytes()
}

/// The path of what stands beside a table: 'rooms.csv', 'rooms.schema.json'.
pub fn beside(table: &Path, ending: &str) -> PathBuf {
    let name = table.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let stem = name.strip_suffix(".csv").or_else(|| name.strip_suffix(".CSV")).unwrap_or(&name);
    table.with_file_name(format!("{stem}.{ending}"))
}
