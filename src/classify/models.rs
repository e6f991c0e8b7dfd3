//! The available models, by name: those bundled with the program, and the user's own.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use miniz_oxide::inflate::decompress_to_vec_zlib;
use serde_json::Value;

use super::blend::{Kind, Member};
use super::model_file::{self, About, ModelFileError};
use super::typology::TypologyModel;
use super::unknown::Unknown;
use super::{Method, PlanClassifier};
use crate::base::wording::or_words;
use crate::dataset::sets::{STANDARD, set_name};

/// A model and its origin.
#[derive(Clone, Debug)]
pub struct StoredModel {
    /// Its file's name without the extension: 'school-tree'.
    pub name: String,
    /// Its file; `None` if it is bundled.
    pub path: Option<PathBuf>,
    pub classifier: PlanClassifier,
    pub about: About,
    /// The checksum of its file, which tells it from another model of its name.
    pub checksum: String,
}

impl StoredModel {
    /// The set it learned from: a typology, or [`STANDARD`].
    pub fn set(&self) -> &str {
        set_name(self.about.typology.as_ref())
    }

    pub fn method(&self) -> Method {
        self.classifier.method()
    }
}

impl Member for StoredModel {
    fn name(&self) -> &str {
        &self.name
    }

    fn checksum(&self) -> &str {
        &self.checksum
    }

    fn set(&self) -> &str {
        self.set()
    }

    fn method(&self) -> Method {
        self.method()
    }

    fn kind(&self) -> Option<Kind<'_>> {
        match &self.classifier {
            PlanClassifier::Each(classifier) => Some(Kind::Each(classifier)),
            PlanClassifier::Joint(joint) => Some(Kind::Joint(joint)),
            PlanClassifier::Blend(_) => None,
        }
    }
}

/// The bundled models by name (a set and a method: 'school-tree'), and their files, compressed by
/// `build.rs` to a quarter of their size. See `assets/models/NOTICE`.
const BUNDLED: &[(&str, &[u8])] = include!(concat!(env!("OUT_DIR"), "/models.rs"));

/// Set and method of a bundled model, from its name.
fn parts_of(name: &str) -> Option<(&str, Method)> {
    let (set, method) = name.rsplit_once('-')?;
    Some((set, method.parse().ok()?))
}

/// The name of the model for a set and a method.
fn name_of(set: &str, method: Method) -> String {
    format!("{set}-{}", method.name())
}

/// The available models. Cheap to clone.
#[derive(Clone, Debug, Default)]
pub struct Models {
    /// Sorted by name.
    own: Arc<[Arc<StoredModel>]>,
    /// The names of the models that predict where nobody asks for a method, by set.
    defaults: Arc<BTreeMap<String, String>>,
}

impl Models {
    /// The bundled models.
    pub fn bundled() -> Self {
        Self::default()
    }

    /// Adds the user's own models. One with the name of another, bundled or not, replaces it.
    #[must_use]
    pub fn with(&self, own: impl IntoIterator<Item = StoredModel>) -> Self {
        let before = self.own.iter().map(|model| (model.name.clone(), model.clone()));
        let added = own.into_iter().map(|model| (model.name.clone(), Arc::new(model)));
        let by_name: BTreeMap<String, Arc<StoredModel>> = before.chain(added).collect();
        Self { own: by_name.into_values().collect(), ..self.clone() }
    }

    /// With models, by name, that predict for a set (a typology, or [`STANDARD`]) where nobody asks for a method.
    #[must_use]
    pub fn with_defaults(&self, defaults: BTreeMap<String, String>) -> Self {
        Self { defaults: Arc::new(defaults), ..self.clone() }
    }

    /// The names of the models chosen as defaults, by set.
    pub fn defaults(&self) -> &BTreeMap<String, String> {
        &self.defaults
    }

    /// The model chosen as the default of a set; `None` where none is, or it is not there.
    pub fn default_of(&self, set: &str) -> Option<Arc<StoredModel>> {
        self.named(self.defaults.get(set)?)?.ok()
    }

    /// The user's own models, by name.
    pub fn own(&self) -> &[Arc<StoredModel>] {
        &self.own
    }

    /// The sets that have models: typologies alphabetically, then [`STANDARD`].
    pub fn sets(&self) -> Vec<&str> {
        let bundled = BUNDLED.iter().filter_map(|(name, _)| Some(parts_of(name)?.0));
        let own = self.own.iter().map(|model| model.set());
        let sets: BTreeSet<&str> = bundled.chain(own).collect();
        let (last, mut typologies): (Vec<&str>, Vec<&str>) = sets.into_iter().partition(|set| *set == STANDARD);
        typologies.extend(last);
        typologies
    }

    /// The methods that have a model for a set.
    pub fn methods(&self, set: &str) -> Vec<Method> {
        let has = |method: &Method| {
            let is_bundled = || BUNDLED.iter().any(|(name, _)| parts_of(name) == Some((set, *method)));
            self.own_of(set, *method).is_some() || is_bundled()
        };
        Method::ALL.into_iter().filter(has).collect()
    }

    /// The user's own model for a set and a method: the one named like a bundled model or, if none is
    /// bundled, the first by name.
    fn own_of(&self, set: &str, method: Method) -> Option<&Arc<StoredModel>> {
        let usual = name_of(set, method);
        let fits = |model: &&Arc<StoredModel>| model.set() == set && model.method() == method;
        let has_name = |model: &&Arc<StoredModel>| model.name == usual;
        let is_bundled = BUNDLED.iter().any(|(name, _)| *name == usual);
        let any = || self.own.iter().find(fits).filter(|_| !is_bundled);
        self.own.iter().filter(fits).find(has_name).or_else(any)
    }

    /// The model of a set (a typology, or [`STANDARD`]) and a method.
    ///
    /// # Errors
    /// When there is none, or a bundled one cannot be read.
    pub fn find(&self, set: &str, method: Method) -> Result<Arc<StoredModel>, ModelFileError> {
        if let Some(own) = self.own_of(set, method) {
            return Ok(own.clone());
        }
        if let Some(bundled) = bundled(&name_of(set, method)) {
            return bundled;
        }
        let methods: Vec<&str> = self.methods(set).into_iter().map(Method::name).collect();
        let (what, there_are) = if methods.is_empty() {
            (format!("there is no model of the typology '{set}'"), self.sets().join(", "))
        } else {
            (format!("there is no model of {set} by {method}"), or_words(&methods))
        };
        let command = format!("enfilade train --algorithm {}", method.name());
        Err(ModelFileError { line: None, what, hint: format!("use {there_are}, or train one with '{command}'") })
    }

    /// The methods to fall back on, in turn, where a set has none of the one asked for.
    fn instead_of(method: Method) -> &'static [Method] {
        if method == Method::Blend { &[Method::Blend, Method::Joint] } else { &[] }
    }

    /// The method by which a set's rooms are predicted where this one is asked for: itself, or for a set whose models were
    /// trained before there were blends, the joint classifier. `None` if the set has neither.
    pub fn method_for(&self, set: &str, method: Method) -> Option<Method> {
        let methods = self.methods(set);
        let turn = std::iter::once(&method).chain(Self::instead_of(method));
        turn.copied().find(|method| methods.contains(method))
    }

    /// The model with a name, the user's own before a bundled one.
    ///
    /// # Errors
    /// When a bundled model cannot be read, which the tests rule out.
    pub fn named(&self, name: &str) -> Option<Result<Arc<StoredModel>, ModelFileError>> {
        let own = self.own.iter().find(|model| model.name == name);
        own.map(|model| Ok(model.clone())).or_else(|| bundled(name))
    }

    /// All models: the bundled ones by set and method, then the user's own.
    ///
    /// # Errors
    /// When a bundled model cannot be read, which the tests rule out.
    pub fn all(&self) -> Result<Vec<Arc<StoredModel>>, ModelFileError> {
        let of_set = |set| Method::ALL.into_iter().filter_map(move |method| bundled(&name_of(set, method)));
        let bundled: Result<Vec<_>, _> = self.sets().into_iter().flat_map(of_set).collect();
        Ok(bundled?.into_iter().chain(self.own.iter().cloned()).collect())
    }
}

/// The bundled model with a name; read once.
fn bundled(name: &str) -> Option<Result<Arc<StoredModel>, ModelFileError>> {
    static READ: Mutex<BTreeMap<&str, Arc<StoredModel>>> = Mutex::new(BTreeMap::new());
    let &(name, packed) = BUNDLED.iter().find(|(of, _)| *of == name)?;
    // A poisoned map at worst lacks an entry.
    let read = READ.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(model) = read.get(name) {
        return Some(Ok(model.clone()));
    }
    // One that cannot be decompressed is rejected like any invalid model file.
    let text = decompress_to_vec_zlib(packed).unwrap_or_default();
    // The lock is free while a blend's parts are read.
    drop(read);
    let model =
        model_file::from_bytes(&text, &|part| Some(bundled(part)?.ok()?)).map(|(classifier, about, checksum)| {
            let model = Arc::new(StoredModel { name: name.to_owned(), path: None, classifier, about, checksum });
            READ.lock().unwrap_or_else(PoisonError::into_inner).entry(name).or_insert(model).clone()
        });
    Some(model)
}

/// The bundled model that tells typologies apart; `None` if it cannot be read, which the tests rule out.
pub fn bundled_typologies() -> Option<&'static TypologyModel> {
    static READ: OnceLock<Option<TypologyModel>> = OnceLock::new();
    let read = || {
        let text = include_str!("../../assets/models/typologies.json");
        TypologyModel::from_value(&serde_json::from_str(text).ok()?).ok()
    };
    READ.get_or_init(read).as_ref()
}

/// The bundled model of a set (a typology, or `standard`) that predicts the labels behind openings into
/// unexplored space; `None` if the set has none.
pub fn bundled_unknown(set: &str) -> Option<&'static Unknown> {
    static READ: OnceLock<BTreeMap<String, Unknown>> = OnceLock::new();
    let read = || {
        let value: Value = serde_json::from_str(include_str!("../../assets/models/unknown.json")).unwrap_or_default();
        let sets = value.as_object().into_iter().flatten();
        sets.filter_map(|(set, value)| Some((set.clone(), serde_json::from_value(value.clone()).ok()?))).collect()
    };
    READ.get_or_init(read).get(set)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn own_models_are_found_by_set_and_by_name() {
        let tree: Method = "tree".parse().expect("a method");
        let bundled = Models::bundled();
        assert_eq!(bundled.sets(), ["house", "office", "school", STANDARD]);
        let own = |name: &str, typology: &str| {
            let mut model = (*bundled.find("house", tree).expect("bundled")).clone();
            model.name = name.to_owned();
            model.about.typology = crate::labels::Typology::new(typology);
            model
        };
        let models = bundled.with([own("wards", "hospital"), own("school-tree", "school"), own("other", "office")]);
        assert_eq!(models.sets(), ["hospital", "house", "office", "school", STANDARD]);
        assert_eq!(models.methods("hospital"), [tree]);
        assert_eq!(models.find("hospital", tree).expect("own").name, "wards");
        assert_eq!(models.find("school", tree).expect("own").set(), "school");
        assert_eq!(models.find("office", tree).expect("bundled").name, "office-tree");
        assert_eq!(models.named("other").expect("own").expect("sound").name, "other");
        let said = models.find("hospital", Method::Joint).expect_err("none").to_string();
        assert_eq!(
            said,
            "there is no model of hospital by joint classifier; use tree, or train one with 'enfilade train \
             --algorithm joint'"
        );
        let said = models.find("castle", tree).expect_err("none").to_string();
        assert!(said.starts_with("there is no model of the typology 'castle'; use hospital, house"), "{said}");
    }
}
