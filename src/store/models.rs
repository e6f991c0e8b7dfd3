use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use etcetera::BaseStrategy as _;

use crate::classify::model_file::{self, About, ModelFileError};
use crate::classify::{Algorithm, Method, PlanClassifier};
use crate::labels::Typology;

/// The ending of model files.
pub const MODEL_ENDING: &str = ".model.json";

/// A model and where it comes from.
#[derive(Clone, Debug)]
pub struct StoredModel {
    /// Its file's name without the ending: 'school-tree'.
    pub name: String,
    /// Its file; `None` for one that comes with the program.
    pub path: Option<PathBuf>,
    pub classifier: PlanClassifier,
    pub about: About,
}

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

/// The name of the set that a model learned from, as in its file's name: a typology, or `standard`.
pub fn set_name(typology: Option<&Typology>) -> &str {
    typology.map_or(crate::study::STANDARD, Typology::as_str)
}

/// Reads a model file. At most [`LARGEST_BYTES`] are read.
///
/// # Errors
/// When the file cannot be read, is too large, or is no model that can be used.
pub fn load_model(path: &Path) -> Result<StoredModel, ModelError> {
    let fail = |what: String| ModelError { path: path.to_owned(), what };
    let size = std::fs::metadata(path).map_err(|error| fail(error.to_string()))?.len();
    if size > LARGEST_BYTES {
        return Err(fail(format!("{} MB are more than any model has; is it another file?", size / 1_000_000)));
    }
    let bytes = std::fs::read(path).map_err(|error| fail(error.to_string()))?;
    let (classifier, about) = model_file::from_bytes(&bytes).map_err(|error| fail(error.to_string()))?;
    let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let name = name.strip_suffix(MODEL_ENDING).unwrap_or(&name).to_owned();
    Ok(StoredModel { name, path: Some(path.to_owned()), classifier, about })
}

/// A model of a million rooms that keeps them all has less.
pub const LARGEST_BYTES: u64 = 1 << 28;

macro_rules! bundled {
    ($($set:literal),+) => {
        /// The models that come with the program: typology (or `standard`), method, and the file's text.
        /// See `assets/models/NOTICE`.
        const BUNDLED: &[(&str, Method, &str)] = &[$(
            ($set, Method::Each(Algorithm::Rules), include_str!(concat!("../../assets/models/", $set, "-rules.model.json"))),
            ($set, Method::Each(Algorithm::Tree), include_str!(concat!("../../assets/models/", $set, "-tree.model.json"))),
            ($set, Method::Each(Algorithm::Knn), include_str!(concat!("../../assets/models/", $set, "-knn.model.json"))),
            ($set, Method::Each(Algorithm::Mlp), include_str!(concat!("../../assets/models/", $set, "-mlp.model.json"))),
            ($set, Method::Joint, include_str!(concat!("../../assets/models/", $set, "-joint.model.json"))),
        )+];
    };
}

bundled!("house", "school", "office", "standard");

/// The sets of which there are bundled models, `standard` last.
pub fn bundled_sets() -> impl Iterator<Item = &'static str> {
    BUNDLED.iter().step_by(Method::ALL.len()).map(|(set, _, _)| *set)
}

/// The bundled model of a set (a typology, or `standard`) and a method, read once.
///
/// # Errors
/// When there is none for the set, or it cannot be read, which the tests exclude.
pub fn bundled_model(set: &str, method: Method) -> Result<Arc<StoredModel>, ModelFileError> {
    static READ: Mutex<BTreeMap<(&str, Method), Arc<StoredModel>>> = Mutex::new(BTreeMap::new());
    let found = BUNDLED.iter().find(|(of, by, _)| *of == set && *by == method);
    let Some(&(set, method, text)) = found else {
        let sets: Vec<&str> = bundled_sets().collect();
        return Err(ModelFileError {
            line: None,
            what: format!("there is no bundled model for the typology '{set}'"),
            hint: format!("use one of {}, or train one with 'enfilade train'", sets.join(", ")),
        });
    };
    // A poisoned map only lacks an entry.
    let mut read = READ.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(model) = read.get(&(set, method)) {
        return Ok(model.clone());
    }
    let (classifier, about) = model_file::from_bytes(text.as_bytes())?;
    let name = format!("{set}-{}", method.name());
    let model = Arc::new(StoredModel { name, path: None, classifier, about });
    read.insert((set, method), model.clone());
    Ok(model)
}

/// The environment variable that names another folder of the user's models.
pub const MODELS_VARIABLE: &str = "ENFILADE_MODELS";

/// The folder of the user's own models; `None` where the system tells of no home.
pub fn models_folder() -> Option<PathBuf> {
    match std::env::var_os(MODELS_VARIABLE) {
        Some(folder) => Some(folder.into()),
        None => Some(etcetera::choose_base_strategy().ok()?.data_dir().join("enfilade").join("models")),
    }
}

/// The models in a folder, by name, and those that cannot be used. A folder that does not exist holds
/// none.
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
