use std::collections::BTreeMap;
use std::fmt;

use serde::Deserialize;

use super::{Label, Typology};
use crate::base::wording::sentence;

/// What a scheme says of a function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Meaning {
    /// Rooms of this function carry the label.
    Labelled(Label),
    /// Kept, but not a room in the sense of the paper (a balcony, a shaft): counts like the outside.
    NotClassified,
}

/// The label schemes of any number of typologies: functions to labels.
///
/// A scheme file is TOML, one table a typology, functions grouped by label:
///
/// ```toml
/// version = 1
/// [hospital]
/// S = ["bathroom", "linen store"]
/// C = ["corridor"]
/// not_classified = ["shaft"]
/// ```
///
/// Functions compare by [`normalised_function`]. A later file extends an earlier one and wins where
/// both name a function.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Schemes {
    by_typology: BTreeMap<Typology, BTreeMap<String, Meaning>>,
}

/// A scheme file that cannot be used, in words that say what to do.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SchemeError(String);

impl fmt::Display for SchemeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for SchemeError {}

/// The newest version of the scheme file this program reads.
const VERSION: i64 = 1;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case, reason = "the labels' letters are the file's keys")]
struct DiskScheme {
    #[serde(default)]
    S: Vec<String>,
    #[serde(default)]
    M: Vec<String>,
    #[serde(default)]
    B: Vec<String>,
    #[serde(default)]
    C: Vec<String>,
    #[serde(default)]
    H: Vec<String>,
    #[serde(default)]
    not_classified: Vec<String>,
}

impl Schemes {
    /// The schemes of house, school and office that come with the program.
    pub fn bundled() -> Self {
        let mut schemes = Self::default();
        for text in [
            include_str!("../../assets/schemes/house.scheme.toml"),
            include_str!("../../assets/schemes/school.scheme.toml"),
            include_str!("../../assets/schemes/office.scheme.toml"),
        ] {
            // A broken bundled file is caught by the test below; at run time it would only be missing.
            schemes = schemes.clone().extended_by(text).unwrap_or(schemes);
        }
        schemes
    }

    /// These schemes extended by the text of a scheme file.
    ///
    /// # Errors
    /// When the text is not TOML, misses its version or has a newer one, uses a key that is neither
    /// a label's letter nor `not_classified`, or names a function under two labels of one typology.
    pub fn extended_by(mut self, text: &str) -> Result<Self, SchemeError> {
        let mut table: toml::Table = toml::from_str(text)
            .map_err(|error| SchemeError(format!("not a label scheme: {}", error.to_string().trim())))?;
        match table.remove("version").and_then(|version| version.as_integer()) {
            Some(1..=VERSION) => {}
            Some(newer) => {
                return Err(SchemeError(format!(
                    "label scheme version {newer} is not known (this program reads up to {VERSION}): update Enfilade"
                )));
            }
            None => return Err(SchemeError(format!("a label scheme starts with 'version = {VERSION}'"))),
        }
        for (name, value) in table {
            let typology = Typology::new(&name).ok_or_else(|| SchemeError("a typology needs a name".to_owned()))?;
            let disk: DiskScheme = value.try_into().map_err(|error: toml::de::Error| {
                SchemeError(format!("[{name}]: {}; the keys are S, M, B, C, H and not_classified", error.message()))
            })?;
            let groups = [
                (Meaning::Labelled(Label::SmallRoom), disk.S),
                (Meaning::Labelled(Label::MediumRoom), disk.M),
                (Meaning::Labelled(Label::BigRoom), disk.B),
                (Meaning::Labelled(Label::Corridor), disk.C),
                (Meaning::Labelled(Label::Hall), disk.H),
                (Meaning::NotClassified, disk.not_classified),
            ];
            let mut added: BTreeMap<String, Meaning> = BTreeMap::new();
            for (meaning, functions) in groups {
                for function in functions {
                    let key = normalised_function(&function);
                    if added.insert(key, meaning).is_some_and(|before| before != meaning) {
                        return Err(SchemeError(format!("[{name}]: '{function}' stands under two labels; keep one")));
                    }
                }
            }
            self.by_typology.entry(typology).or_default().extend(added);
        }
        Ok(self)
    }

    /// The typologies that have a scheme, in alphabetical order.
    pub fn typologies(&self) -> impl Iterator<Item = &Typology> {
        self.by_typology.keys()
    }

    /// The functions of a typology with their meaning, in alphabetical order, normalised.
    pub fn functions(&self, typology: &Typology) -> impl Iterator<Item = (&str, Meaning)> {
        self.by_typology.get(typology).into_iter().flatten().map(|(function, &meaning)| (function.as_str(), meaning))
    }

    /// What the scheme of a typology says of a function; `None` when it does not know it, or when
    /// the plan has no typology or one without a scheme. Never guessed.
    pub fn meaning(&self, typology: Option<&Typology>, function: &str) -> Option<Meaning> {
        self.by_typology.get(typology?)?.get(&normalised_function(function)).copied()
    }
}

/// A function as written in a file, for people: 'LIVING_ROOM' and 'living room' become 'Living room'.
pub fn function_title(function: &str) -> String {
    sentence(&normalised_function(function))
}

/// A function's name as schemes compare it: lower case, runs of spaces, underscores and hyphens
/// one space. `LIVING_ROOM`, `living-room` and `Living room` are the same function.
pub fn normalised_function(function: &str) -> String {
    let lower = function.to_lowercase();
    let words: Vec<&str> =
        lower.split(|c: char| c.is_whitespace() || c == '_' || c == '-').filter(|word| !word.is_empty()).collect();
    words.join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bundled_schemes_are_complete() {
        let schemes = Schemes::bundled();
        let names: Vec<&str> = schemes.typologies().map(Typology::as_str).collect();
        assert_eq!(names, ["house", "office", "school"]);
        let house = Typology::new("House");
        assert_eq!(schemes.meaning(house.as_ref(), "LIVING_room"), Some(Meaning::Labelled(Label::BigRoom)));
        assert_eq!(schemes.meaning(house.as_ref(), "balcony"), Some(Meaning::NotClassified));
        assert_eq!(schemes.meaning(house.as_ref(), "observatory"), None);
        assert_eq!(schemes.meaning(None, "balcony"), None);
    }

    #[test]
    fn a_users_file_adds_a_typology_and_overrides() {
        let schemes = Schemes::bundled()
            .extended_by("version = 1\n[hospital]\nM = ['ward']\n[house]\nS = ['kitchen']")
            .expect("a valid scheme");
        assert_eq!(
            schemes.meaning(Typology::new("hospital").as_ref(), "Ward"),
            Some(Meaning::Labelled(Label::MediumRoom))
        );
        assert_eq!(
            schemes.meaning(Typology::new("house").as_ref(), "kitchen"),
            Some(Meaning::Labelled(Label::SmallRoom))
        );
    }

    #[test]
    fn broken_files_say_what_is_wrong() {
        for (text, word) in [
            ("version = 2", "version 2"),
            ("[house]", "starts with"),
            ("version = 1\n[house]\nX = ['a']", "keys are"),
            ("version = 1\n[house]\nS = ['a']\nM = ['A']", "two labels"),
            ("version = 1\n[house", "not a label scheme"),
        ] {
            let error = Schemes::default().extended_by(text).expect_err(text).to_string();
            assert!(error.contains(word), "{text:?} gave {error:?}");
        }
    }
}
