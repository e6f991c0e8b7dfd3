//! Out-of-fold predictions as a file, for 'evaluate' and 'train'.

use std::path::Path;

use super::CliError;
use super::collect::PlansRead;
use super::manifest::{self, Manifest};
use crate::dataset::Row;
use crate::dataset::csv::Guard;
use crate::study::predictions::{Prediction, csv};

/// Writes what was said of each room, with a manifest beside it.
///
/// # Errors
/// When a file cannot be written.
pub fn save_predictions(
    path: &Path,
    rows: &[Row],
    predictions: &[Prediction],
    guard: bool,
    read: &PlansRead,
) -> Result<(), CliError> {
    let bytes = csv(rows, predictions, if guard { Guard::On } else { Guard::Off })?;
    crate::store::save_bytes(path, &bytes)?;
    if manifest::is_file(path) {
        Manifest::of_table(path, &bytes, predictions.len()).with_plans(read).save(path, None)?;
    }
    Ok(())
}
