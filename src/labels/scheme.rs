use std::collections::BTreeMap;
use std::fmt;
use std::sync::OnceLock;

use serde::Deserialize;

use super::expectations::{self, DiskRule};
use super::{Label, TemporaryRule, Typology, UsualArea};
use crate::base::wording::sentence;

/// What a scheme says about a function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Meaning {
    /// Rooms of this function carry the label.
    Labelled(Label),
    /// Kept, but not a room in the paper's sense (a balcony, a shaft): counts as the outside.
    NotClassified,
}

/// The label schemes of any number of typologies: they map functions to labels.
///
/// A scheme file is TOML: one table per typology, functions grouped by label:
///
/// ```toml
/// version = 1
/// [hospital]
/// S = ["bathroom", "linen store"]
/// C = ["corridor"]
/// not_classified = ["shaft"]
/// ```
///
/// Functions are compared by [`normalised_function`]. A later file extends an earlier one, and wins where
/// both name a function.
///
/// With `by_words = true` the words in a longer function count where it is not known as a whole: 'PLÅTVERKSTAD 2' ends
/// with 'verkstad'.
///
/// A table may also say what to expect of rooms, see [`TemporaryRule`] and [`UsualArea`]; without this, a
/// neighbour's temporary label follows the rules of `[standard]`, and no size is unusual:
///
/// ```toml
/// temporary = [
///     { label = "C", axes_ratio_at_least = 4.5, doors_at_least = 2, reason = "wards are nearly square" },
///     { label = "S", area_below_m2 = 12.0 },
///     { label = "M" },
/// ]
/// usual_area_m2 = { S = [3.0, 9.0], M = [18.0, 30.0] }
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Schemes {
    by_typology: BTreeMap<Typology, Scheme>,
    /// The rules when the typology is unknown or has none of its own.
    standard: Vec<TemporaryRule>,
}

/// What is known about a typology.
#[derive(Clone, Debug, Default, PartialEq)]
struct Scheme {
    /// By [`normalised_function`].
    functions: BTreeMap<String, Meaning>,
    /// Whether the words in a longer function count where it is not known as a whole, see [`Scheme::meaning_of_words`].
    by_words: bool,
    /// The first that holds gives the label; if empty, those of [`Schemes::standard`] apply.
    temporary: Vec<TemporaryRule>,
    usual_areas: BTreeMap<Label, UsualArea>,
    /// Colours of functions, by [`normalised_function`].
    colours: BTreeMap<String, Colour>,
}

/// A colour: red, green and blue, a byte each.
pub type Colour = [u8; 3];

/// Reads a colour as CSS writes it: '#ffd27f'.
pub(super) fn colour(text: &str) -> Option<Colour> {
    let digits = text.strip_prefix('#').filter(|digits| digits.len() == 6)?;
    let rgb = u32::from_str_radix(digits, 16).ok()?;
    Some([(rgb >> 16) as u8, (rgb >> 8) as u8, rgb as u8])
}

/// The fewest letters of a function that is found at the end of a longer word: 'förråd' in 'städförråd', but no 'el' in
/// 'hotel'.
const LEAST_ENDING: usize = 3;

impl Scheme {
    /// What the words in a function say, normalised: of 'städ/frd' the part before the stroke counts first; in a part
    /// all its words together, then its last word, then those before it; then the longest known function that one of
    /// its words ends with, since Germanic languages put what a thing is at the end ('kemikalieförråd' is a store).
    fn meaning_of_words(&self, function: &str) -> Option<Meaning> {
        let known = |word: &str| self.functions.get(word).copied();
        let ending = |word: &str| {
            let starts = word.char_indices().map(|(start, _)| start).skip(1);
            let long = starts.map(|start| &word[start..]).take_while(|end| end.chars().count() >= LEAST_ENDING);
            long.into_iter().find_map(known)
        };
        function.split(['/', '(', ')']).find_map(|part| {
            let words: Vec<&str> = part.split(|c: char| !c.is_alphabetic()).filter(|word| !word.is_empty()).collect();
            let last_first = || words.iter().rev().copied();
            known(&words.join(" ")).or_else(|| last_first().find_map(known)).or_else(|| last_first().find_map(ending))
        })
    }
}

/// The table of a scheme file that is not a typology: it applies when no typology is known.
const STANDARD: &str = "standard";

/// The schemes bundled with the program: name and text of each file.
const BUNDLED: &[(&str, &str)] = include!(concat!(env!("OUT_DIR"), "/schemes.rs"));

/// Why a scheme file cannot be used; the message says what to do.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SchemeError(String);

impl SchemeError {
    pub(super) fn new(what: String) -> Self {
        Self(what)
    }
}

impl fmt::Display for SchemeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for SchemeError {}

/// The newest scheme file version this program reads.
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
    #[serde(default)]
    by_words: bool,
    #[serde(default)]
    temporary: Vec<DiskRule>,
    #[serde(default)]
    usual_area_m2: BTreeMap<String, [f64; 2]>,
    #[serde(default)]
    colours: BTreeMap<String, String>,
}

impl Schemes {
    /// The schemes bundled with the program.
    pub fn bundled() -> Self {
        static READ: OnceLock<Schemes> = OnceLock::new();
        let read = || {
            // A broken bundled file is caught by the test below; at run time it would just be missing.
            let extend = |schemes: Self, (_, text): &(&str, &str)| schemes.clone().extended_by(text).unwrap_or(schemes);
            BUNDLED.iter().fold(Self::default(), extend)
        };
        READ.get_or_init(read).clone()
    }

    /// These schemes extended by the text of a scheme file.
    ///
    /// # Errors
    /// When the text is not TOML, has no version or a newer one, uses an unknown key, names a function
    /// under two labels of one typology, or expects the impossible.
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
                SchemeError(format!(
                    "[{name}]: {}; the keys are S, M, B, C, H, not_classified, by_words, temporary, usual_area_m2 and \
                     colours",
                    error.message()
                ))
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
            let wrong = |what: String| SchemeError(format!("[{name}]: {what}"));
            let temporary = expectations::rules(disk.temporary).map_err(wrong)?;
            let usual_areas = expectations::usual_areas(disk.usual_area_m2).map_err(wrong)?;
            if typology.as_str() == STANDARD {
                if !added.is_empty() || !usual_areas.is_empty() {
                    return Err(wrong(
                        "it is no typology, and has no functions or sizes; give yours a name".to_owned(),
                    ));
                }
                self.standard = temporary;
                continue;
            }
            let mut colours = BTreeMap::new();
            for (function, text) in disk.colours {
                let read = colour(&text).ok_or_else(|| wrong(format!("'{text}' is no colour; write it as #ffd27f")))?;
                colours.insert(normalised_function(&function), read);
            }
            let scheme = self.by_typology.entry(typology).or_default();
            scheme.colours.extend(colours);
            scheme.functions.extend(added);
            scheme.by_words |= disk.by_words;
            scheme.usual_areas.extend(usual_areas);
            if !temporary.is_empty() {
                scheme.temporary = temporary;
            }
        }
        Ok(self)
    }

    /// The typologies that have a scheme, alphabetically.
    pub fn typologies(&self) -> impl Iterator<Item = &Typology> {
        self.by_typology.keys()
    }

    /// The functions of a typology with their meaning, normalised, alphabetically.
    pub fn functions(&self, typology: &Typology) -> impl Iterator<Item = (&str, Meaning)> {
        let functions = self.by_typology.get(typology).map(|scheme| &scheme.functions);
        functions.into_iter().flatten().map(|(function, &meaning)| (function.as_str(), meaning))
    }

    /// What the scheme of a typology says about a function; `None` if it does not know it, or if the plan
    /// has no typology or one without a scheme. Never guessed.
    pub fn meaning(&self, typology: Option<&Typology>, function: &str) -> Option<Meaning> {
        let scheme = self.by_typology.get(typology?)?;
        let function = normalised_function(function);
        let of_words = || if scheme.by_words { scheme.meaning_of_words(&function) } else { None };
        scheme.functions.get(&function).copied().or_else(of_words)
    }

    /// The rules for temporary labels in a typology: its own, or else the standard ones.
    pub fn temporary_rules(&self, typology: Option<&Typology>) -> &[TemporaryRule] {
        let own = typology.and_then(|typology| self.by_typology.get(typology)).map(|scheme| &scheme.temporary);
        own.filter(|rules| !rules.is_empty()).unwrap_or(&self.standard)
    }

    /// The colours that a typology gives its functions, by [`normalised_function`]; others have those of the palette.
    pub fn colours(&self, typology: Option<&Typology>) -> BTreeMap<String, Colour> {
        let scheme = typology.and_then(|typology| self.by_typology.get(typology));
        scheme.map(|scheme| scheme.colours.clone()).unwrap_or_default()
    }

    /// The usual area of a label in a typology; `None` if unknown.
    pub fn usual_area(&self, typology: Option<&Typology>, label: Label) -> Option<UsualArea> {
        self.by_typology.get(typology?)?.usual_areas.get(&label).copied()
    }
}

/// A function as shown to people: 'LIVING_ROOM' and 'living room' become 'Living room'.
pub fn function_title(function: &str) -> String {
    sentence(&normalised_function(function))
}

/// A function's name as schemes compare it: lower case, with runs of spaces, underscores and hyphens
/// replaced by one space. `LIVING_ROOM`, `living-room` and `Living room` are the same function.
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
        assert_eq!(names, ["house", "office", "school", "university"]);
        let house = Typology::new("House");
        assert_eq!(schemes.meaning(house.as_ref(), "LIVING_room"), Some(Meaning::Labelled(Label::BigRoom)));
        assert_eq!(schemes.meaning(house.as_ref(), "balcony"), Some(Meaning::NotClassified));
        assert_eq!(schemes.meaning(house.as_ref(), "observatory"), None);
        assert_eq!(schemes.meaning(None, "balcony"), None);
    }

    #[test]
    fn words_in_a_function_count_where_a_scheme_says_so() {
        let schemes = Schemes::bundled();
        let university = Typology::new("university");
        let label = |function: &str| match schemes.meaning(university.as_ref(), function) {
            Some(Meaning::Labelled(label)) => label.letter(),
            Some(Meaning::NotClassified) => "-",
            None => "?",
        };
        for (function, expected) in [
            ("KONTOR", "M"),
            ("KONTOR 2P", "M"),
            ("KONTOR 3P", "B"),
            ("3 KONT", "B"),
            ("Lab.", "M"),
            ("LAB 2", "M"),
            ("LABHALL MT", "B"),
            ("VERKST. KONTOR", "M"),
            ("KEMIKALIE FÖRRÅD", "S"),
            ("INSTRUMENTFÖRRÅD", "S"),
            ("STÄD/FRD", "S"),
            ("PLÅTVERKSTAD", "B"),
            ("OMKL. HERRAR", "S"),
            ("KORRIDOR B", "C"),
            ("ENTRE/FOAJE", "H"),
            ("STUDIEHALL ÖVRE DEL", "B"),
            ("(NEDRE DEL)", "-"),
            ("hotel", "?"),
            ("BYGGPLATS 1", "?"),
            ("", "?"),
            ("12", "?"),
            ("/", "?"),
        ] {
            assert_eq!(label(function), expected, "{function}");
        }
        assert_eq!(schemes.meaning(Typology::new("school").as_ref(), "main corridor"), None);
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
    fn a_users_typology_may_say_what_is_expected_of_rooms() {
        let text = "version = 1\n[hospital]\ntemporary = [{ label = 'S', area_below_m2 = 12 }, { label = 'M' }]\n\
                    usual_area_m2 = { M = [18.0, 30.0] }";
        let schemes = Schemes::bundled().extended_by(text).expect("a valid scheme");
        let hospital = Typology::new("hospital");
        assert_eq!(schemes.temporary_rules(hospital.as_ref()).len(), 2);
        let usual = schemes.usual_area(hospital.as_ref(), Label::MediumRoom).expect("just said");
        assert_eq!((usual.factor(36.0), usual.factor(9.0), usual.factor(20.0)), (1.2, 0.5, 1.0));
        assert_eq!(schemes.usual_area(hospital.as_ref(), Label::Hall), None);
        assert_eq!(schemes.temporary_rules(Typology::new("castle").as_ref()), schemes.temporary_rules(None));
    }

    #[test]
    fn broken_files_say_what_is_wrong() {
        for (text, word) in [
            ("version = 2", "version 2"),
            ("[house]", "starts with"),
            ("version = 1\n[house]\nX = ['a']", "keys are"),
            ("version = 1\n[house]\nS = ['a']\nM = ['A']", "two labels"),
            ("version = 1\n[house", "not a label scheme"),
            ("version = 1\n[house]\ntemporary = [{ label = 'S', area_below_m2 = 9 }]", "leave rooms without a label"),
            ("version = 1\n[house]\ntemporary = [{ label = 'X' }]", "unknown label"),
            ("version = 1\n[house]\ntemporary = [{ label = 'S', area_at_least_m2 = nan }]", "not a number"),
            ("version = 1\n[house]\nusual_area_m2 = { S = [9.0, 3.0] }", "smaller first"),
            ("version = 1\n[house]\ncolours = { kitchen = 'red' }", "#ffd27f"),
            ("version = 1\n[standard]\nS = ['cupboard']", "no typology"),
        ] {
            let error = Schemes::default().extended_by(text).expect_err(text).to_string();
            assert!(error.contains(word), "{text:?} gave {error:?}");
        }
    }
}
