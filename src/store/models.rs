use std::collections::BTreeMap;
use std::sync::Arc;

use super::save::{SaveError, save_bytes};

use crate::base::file_name::component;
use crate::classify::blend::Member;
use crate::classify::models::{Models, StoredModel};
use std::path::{Path, PathBuf};

use etcetera::BaseStrategy as _;

use crate::classify::model_file::{self, Parts};

/// The extension of model files.
pub const MODEL_ENDING: &str = ".model.json";

/// Why a model's file cannot be used.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ModelError {
    pub path: PathBuf,
    pub what: String,
}

impl std::fmt::Display for ModelError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}: {}", self.path.display(), self.what)
    }
}

impl std::error::Error for ModelError {}

/// Reads a model file; the parts of a blend are the models of their names beside it, or else bundled ones. At most
/// [`LARGEST_BYTES`] are read.
///
/// # Errors
/// When the file cannot be read, is too large, or is not a usable model.
pub fn load_model(path: &Path) -> Result<StoredModel, ModelError> {
    load(path, &|part| part_of(path, part))
}

fn load(path: &Path, parts: Parts<'_>) -> Result<StoredModel, ModelError> {
    let fail = |what: String| ModelError { path: path.to_owned(), what };
    let size = std::fs::metadata(path).map_err(|error| fail(error.to_string()))?.len();
    if size > LARGEST_BYTES {
        return Err(fail(format!("{} MB are more than any model has; is it another file?", size / 1_000_000)));
    }
    let bytes = std::fs::read(path).map_err(|error| fail(error.to_string()))?;
    let (classifier, about, checksum) =
        model_file::from_bytes(&bytes, parts).map_err(|error| fail(error.to_string()))?;
    let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let name = name.strip_suffix(MODEL_ENDING).unwrap_or(&name).to_owned();
    Ok(StoredModel { name, path: Some(path.to_owned()), classifier, about, checksum })
}

/// A part of the blend in a file: the model of that name beside it, or else the bundled one. Only a plain name is looked up,
/// and a blend is no part of another.
fn part_of(blend: &Path, part: &str) -> Option<Arc<dyn Member>> {
    let beside = component(part).ok().and_then(|part| {
        let path = blend.parent()?.join(format!("{part}{MODEL_ENDING}"));
        if path == blend || !path.exists() { None } else { load(&path, &|_| None).ok().map(Arc::new) }
    });
    let model: Arc<StoredModel> = beside.or_else(|| Models::bundled().named(part)?.ok())?;
    Some(model)
}

/// The maximum size: even a model that stores a million rooms is smaller.
pub const LARGEST_BYTES: u64 = 1 << 28;

/// The environment variable for another folder of the user's models.
pub const MODELS_VARIABLE: &str = "ENFILADE_MODELS";

/// The folder of the user's own models; `None` if the system has no home folder.
pub fn models_folder() -> Option<PathBuf> {
    match std::env::var_os(MODELS_VARIABLE) {
        Some(folder) => Some(folder.into()),
        None => Some(etcetera::choose_base_strategy().ok()?.data_dir().join("enfilade").join("models")),
    }
}

/// The models in a folder, by name, and the errors of those that cannot be used. Empty if the folder does
/// not exist.
pub fn models_in(folder: &Path) -> (Vec<StoredModel>, Vec<ModelError>) {
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder)
        .map(|entries| entries.flatten().map(|entry| entry.path()).collect())
        .unwrap_or_default();
    files.retain(|path| path.file_name().is_some_and(|name| name.to_string_lossy().ends_with(MODEL_ENDING)));
    files.sort();
    let (mut models, mut errors) = (Vec::new(), Vec::new());
    for file in files {
        match load_model(&file) {
            Ok(model) => models.push(model),
            Err(error) => errors.push(error),
        }
    }
    (models, errors)
}

/// The file in a folder of models that names the defaults: an object of sets (typologies, or `standard`) and models' names.
const DEFAULTS: &str = "defaults.json";

/// The models in a folder that predict where nobody asks for a method, by set. None where the folder names none, or
/// its file cannot be read.
pub fn default_models(folder: &Path) -> BTreeMap<String, String> {
    let path = folder.join(DEFAULTS);
    let is_small = std::fs::metadata(&path).is_ok_and(|file| file.len() < (1 << 20));
    let text = if is_small { std::fs::read_to_string(&path).unwrap_or_default() } else { String::new() };
    serde_json::from_str(&text).unwrap_or_default()
}

/// Makes a model in a folder the default of a set; `None` for the one that comes with the program.
///
/// # Errors
/// When the file cannot be written.
pub fn set_default_model(folder: &Path, set: &str, model: Option<&str>) -> Result<(), SaveError> {
    let mut defaults = default_models(folder);
    match model {
        Some(model) => drop(defaults.insert(set.to_owned(), model.to_owned())),
        None => drop(defaults.remove(set)),
    }
    let mut bytes = serde_json::to_vec_pretty(&defaults).unwrap_or_default();
    bytes.push(b'\n');
    save_bytes(&folder.join(DEFAULTS), &bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn defaults_are_kept_beside_the_models() {
        let folder = tempfile::tempdir().expect("a folder");
        assert_eq!(default_models(folder.path()), BTreeMap::new());
        for (set, model) in [("house", Some("mine")), ("school", Some("other")), ("house", None)] {
            set_default_model(folder.path(), set, model).expect("written");
        }
        assert_eq!(default_models(folder.path()), BTreeMap::from([("school".to_owned(), "other".to_owned())]));
        crate::store::save_bytes(&folder.path().join(DEFAULTS), b"{").expect("written");
        assert_eq!(default_models(folder.path()), BTreeMap::new());
    }
}
