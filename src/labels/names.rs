//! What a room's name says of its function: `Kitchen 2` is a kitchen, and so is `Küche`. Only ever a proposal.

use std::collections::BTreeMap;
use std::sync::OnceLock;

use serde::Deserialize;

use super::{Schemes, Typology, normalised_function};

/// The lists of common names that come with the program: name and text of each file.
const BUNDLED: &[(&str, &str)] = include!(concat!(env!("OUT_DIR"), "/words.rs"));

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct DiskNames {
    #[expect(dead_code, reason = "there is one version so far")]
    version: u32,
    names: Vec<DiskName>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct DiskName {
    functions: Vec<String>,
    of: Vec<String>,
}

/// For each common name the functions it may mean, best first.
fn common() -> &'static BTreeMap<String, Vec<String>> {
    static READ: OnceLock<BTreeMap<String, Vec<String>>> = OnceLock::new();
    READ.get_or_init(|| {
        let mut functions_of: BTreeMap<String, Vec<String>> = BTreeMap::new();
        // A broken bundled file is caught by the test below; at run time it would just be missing.
        for entry in
            BUNDLED.iter().filter_map(|(_, text)| toml::from_str::<DiskNames>(text).ok()).flat_map(|of| of.names)
        {
            for name in &entry.of {
                functions_of.entry(normalised_function(name)).or_default().extend(entry.functions.iter().cloned());
            }
        }
        functions_of
    })
}

/// Functions that say nothing of a room: a name such as 'Room 3' proposes none.
const EMPTY: [&str; 4] = ["room", "small", "medium", "big"];

impl Schemes {
    /// The function that a room's name speaks for: one that the typology's scheme knows, or, without a typology, any
    /// scheme. `None` if the name says nothing of it. Numbers in the name do not matter, and of a longer name the
    /// longest part that is known counts.
    pub fn function_of_name(&self, typology: Option<&Typology>, name: &str) -> Option<String> {
        let name = normalised_function(name);
        // '1.03', '2a' and '#4' number rooms.
        let is_word = |word: &&str| word.chars().all(char::is_alphabetic);
        let words: Vec<&str> =
            name.split([' ', '/', ',', '(', ')', '+', '&']).filter(is_word).filter(|word| !word.is_empty()).collect();
        let parts = (1..=words.len()).rev().flat_map(|length| words.windows(length).map(|part| part.join(" ")));
        parts.into_iter().find_map(|part| self.function_of_words(typology, &part))
    }

    fn function_of_words(&self, typology: Option<&Typology>, words: &str) -> Option<String> {
        if EMPTY.contains(&words) {
            return None;
        }
        let is_known = |function: &str| match typology {
            Some(typology) => self.meaning(Some(typology), function).is_some(),
            None => self.typologies().any(|typology| self.meaning(Some(typology), function).is_some()),
        };
        let common = common().get(words).into_iter().flatten().map(String::as_str);
        [words].into_iter().chain(common).find(|function| is_known(function)).map(str::to_owned)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bundled_names_are_sound() {
        let schemes = Schemes::bundled();
        for (name, text) in BUNDLED {
            let names: DiskNames = toml::from_str(text).unwrap_or_else(|error| panic!("{name}: {error}"));
            for function in names.names.iter().flat_map(|names| &names.functions) {
                let is_known = |typology| schemes.meaning(Some(typology), function).is_some();
                assert!(schemes.typologies().any(is_known), "no scheme knows {function}");
                assert_eq!(*function, normalised_function(function));
            }
        }
        assert!(common().len() > 200);
    }

    #[test]
    fn a_name_speaks_for_a_function() {
        let schemes = Schemes::bundled();
        for (typology, name, function) in [
            ("house", "Kitchen", Some("kitchen")),
            ("house", "KITCHEN number 3", Some("kitchen")),
            ("house", "Master bedroom", Some("bedroom")),
            ("house", "Küche 2", Some("kitchen")),
            ("house", "Gäste-WC", Some("toilet")),
            ("house", "Camera da letto", Some("bedroom")),
            ("house", "Arbeitszimmer", Some("study")),
            ("office", "Arbeitszimmer", Some("office")),
            ("office", "Meeting 2", Some("meeting room")),
            ("school", "Aula 1.03", Some("classroom")),
            ("school", "Klassenzimmer 5b", Some("classroom")),
            ("house", "Room 3", None),
            ("house", "1.03", None),
            ("house", "", None),
            ("house", "Aquarium", None),
            ("school", "Bedroom", None),
        ] {
            let typology = Typology::new(typology);
            assert_eq!(schemes.function_of_name(typology.as_ref(), name).as_deref(), function, "{name}");
        }
        assert_eq!(schemes.function_of_name(None, "Classroom 1").as_deref(), Some("classroom"));
    }
}
