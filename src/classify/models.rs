//! The models at hand: those that come with the program, and what is known of each.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use serde_json::Value;

use crate::classify::model_file::{self, About, ModelFileError};
use crate::classify::typology::TypologyModel;
use crate::classify::unknown::Unknown;
use crate::classify::{Algorithm, Method, PlanClassifier};

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

/// What tells typologies apart, as it comes with the program; `None` if it does not read, which the tests
/// exclude.
pub fn bundled_typologies() -> Option<&'static TypologyModel> {
    static READ: OnceLock<Option<TypologyModel>> = OnceLock::new();
    let read = || {
        let text = include_str!("../../assets/models/typologies.json");
        TypologyModel::from_value(&serde_json::from_str(text).ok()?).ok()
    };
    READ.get_or_init(read).as_ref()
}

/// What predicts the labels behind openings into unexplored space, of a set (a typology, or `standard`), as
/// it comes with the program; `None` for a set without.
pub fn bundled_unknown(set: &str) -> Option<&'static Unknown> {
    static READ: OnceLock<BTreeMap<String, Unknown>> = OnceLock::new();
    let read = || {
        let value: Value = serde_json::from_str(include_str!("../../assets/models/unknown.json")).unwrap_or_default();
        let sets = value.as_object().into_iter().flatten();
        sets.filter_map(|(set, value)| Some((set.clone(), serde_json::from_value(value.clone()).ok()?))).collect()
    };
    READ.get_or_init(read).get(set)
}
