use std::path::Path;

use super::{SaveError, save_bytes};
use crate::formats::{self, FileError, plan_json};
use crate::plan::Plan;

/// Loads a plan from its own file (`*.plan.json`), exactly as it was saved.
///
/// For other formats use [`formats::read_file`], which also names a plan without a name after its file.
///
/// # Errors
/// When the file cannot be read or is not a plan file of a known version.
pub fn load_plan(path: &Path) -> Result<Plan, FileError> {
    let bytes = formats::read_bytes(path)?;
    plan_json::from_bytes(&bytes).map_err(|error| FileError { path: path.to_owned(), error })
}

/// Saves a plan in Enfilade's own format, see [`save_bytes`]. The bytes are parsed again before the old
/// file is replaced.
///
/// # Errors
/// As [`save_bytes`]; also when the plan breaks an invariant, so that the file could not be opened again.
pub fn save_plan(path: &Path, plan: &Plan) -> Result<(), SaveError> {
    save_bytes(path, &checked_bytes(path, plan)?)
}

/// The bytes of a plan's file for `path`, verified to read back as the same plan.
///
/// # Errors
/// When the plan breaks an invariant, so that the file could not be opened again.
pub fn checked_bytes(path: &Path, plan: &Plan) -> Result<Vec<u8>, SaveError> {
    let bytes = plan_json::to_bytes(plan);
    let undo = "undo the last step and save again, and please report this";
    match plan_json::from_bytes(&bytes) {
        Ok(read) if read == *plan => Ok(bytes),
        Ok(_) => Err(SaveError::new(path, "the plan would read back differently", undo)),
        Err(error) => Err(SaveError::new(path, format!("the plan could not be opened again: {error}"), undo)),
    }
}
