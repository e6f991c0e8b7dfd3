//! Out-of-fold predictions as a file, for 'evaluate' and 'train'.

use std::path::Path;

use super::collect::PlansRead;
use super::manifest;
use super::outputs::{Care, Outputs};
use super::{CliError, Terminal};
use crate::dataset::Row;
use crate::dataset::csv::Guard;
use crate::study::predictions::{Prediction, csv};

/// Writes what was said of each room, with a manifest beside it.
///
/// # Errors
/// As [`Outputs::save`].
pub fn save_predictions(
    path: &Path,
    rows: &[Row],
    predictions: &[Prediction],
    guard: bool,
    read: &PlansRead,
    outputs: &mut Outputs,
    terminal: &mut Terminal,
) -> Result<(), CliError> {
    let bytes = csv(rows, predictions, if guard { Guard::On } else { Guard::Off })?;
    outputs.save(path, &bytes, Care::Flushed, terminal)?;
    if manifest::is_file(path) {
        let told = manifest::of_table(path, &bytes, predictions.len()).with_plans(read);
        manifest::save(told, path, None, outputs, terminal)?;
    }
    Ok(())
}
