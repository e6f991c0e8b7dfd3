//! What the command line writes beside a table: what its columns mean, and its manifest.

use std::path::Path;

use serde_json::Value;

use super::call::command;
use super::outputs::{Care, Outputs, is_stdout};
use super::{CliError, Terminal};
use crate::gather::json_bytes;
pub use crate::gather::{Manifest, beside};

/// The manifest of a table that the call that is being served wrote as these bytes.
pub fn of_table(path: &Path, bytes: &[u8], rows: usize) -> Manifest {
    Manifest::of_table(path, &command(), bytes, rows)
}

/// Writes a manifest beside its table, and the schema of the table's columns where there is one.
///
/// # Errors
/// As [`Outputs::save`].
pub fn save(
    manifest: Manifest,
    table: &Path,
    schema: Option<Value>,
    outputs: &mut Outputs,
    terminal: &mut Terminal,
) -> Result<(), CliError> {
    if let Some(schema) = schema {
        outputs.save(&beside(table, "schema.json"), &json_bytes(&schema), Care::Flushed, terminal)?;
    }
    outputs.save(&beside(table, "manifest.json"), &manifest.bytes(), Care::Flushed, terminal)
}

/// Whether something may stand beside it: not beside a pipe or a device.
pub fn is_file(table: &Path) -> bool {
    !is_stdout(table) && std::fs::metadata(table).map_or(true, |data| data.is_file())
}
