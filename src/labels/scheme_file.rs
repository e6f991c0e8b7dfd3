//! Writing scheme files: changing what functions mean, and leaving all else in the file as it was.

use std::collections::BTreeMap;

use toml::{Table, Value};

use super::scheme::{SchemeError, colour};
use super::{Colour, Label, Meaning, Schemes, Typology, normalised_function};

/// What is to change in a typology's scheme, by function.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Changes {
    /// What functions are to mean; `None` takes one out of the file.
    pub meanings: BTreeMap<String, Option<Meaning>>,
    /// What colours they are to have; `None` for that of the palette.
    pub colours: BTreeMap<String, Option<Colour>>,
}

impl Changes {
    /// How many there are.
    pub fn len(&self) -> usize {
        self.meanings.len() + self.colours.len()
    }

    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// The key of a meaning in a scheme file.
fn key(meaning: Meaning) -> &'static str {
    match meaning {
        Meaning::Labelled(label) => label.letter(),
        Meaning::NotClassified => "not_classified",
    }
}

/// The text of a scheme file in which functions of a typology mean something else. `before` is its text, if there is
/// one. Comments are not kept.
///
/// # Errors
/// When the text is no scheme file, before or after.
pub fn with_changes(before: Option<&str>, typology: &Typology, changes: &Changes) -> Result<String, SchemeError> {
    let wrong = |what: String| SchemeError::new(what);
    let mut table: Table = match before {
        Some(text) => {
            Schemes::default().extended_by(text)?;
            toml::from_str(text).map_err(|error| wrong(error.to_string()))?
        }
        None => Table::from_iter([("version".to_owned(), Value::Integer(1))]),
    };
    // The name as it stands in the file may have capitals.
    let name = table.keys().find(|name| Typology::new(name).as_ref() == Some(typology)).cloned();
    let name = name.unwrap_or_else(|| typology.as_str().to_owned());
    let of_typology = table.entry(name).or_insert_with(|| Value::Table(Table::new()));
    let Value::Table(of_typology) = of_typology else {
        return Err(wrong(format!("'{typology}' is no table")));
    };
    let keys = Label::ALL.map(Label::letter).into_iter().chain(["not_classified"]);
    for key in keys.clone() {
        if let Some(Value::Array(functions)) = of_typology.get_mut(key) {
            functions.retain(|function| {
                function.as_str().is_none_or(|function| !changes.meanings.contains_key(&normalised_function(function)))
            });
        }
    }
    for (function, meaning) in changes.meanings.iter().filter_map(|(function, meaning)| Some((function, (*meaning)?))) {
        let functions = of_typology.entry(key(meaning)).or_insert_with(|| Value::Array(Vec::new()));
        if let Value::Array(functions) = functions {
            functions.push(Value::String(normalised_function(function)));
        }
    }
    if !changes.colours.is_empty() {
        let colours = of_typology.entry("colours").or_insert_with(|| Value::Table(Table::new()));
        if let Value::Table(colours) = colours {
            colours.retain(|function, _| !changes.colours.contains_key(&normalised_function(function)));
            for (function, [r, g, b]) in changes.colours.iter().filter_map(|(of, colour)| Some((of, (*colour)?))) {
                colours.insert(normalised_function(function), Value::String(format!("#{r:02x}{g:02x}{b:02x}")));
            }
        }
    }
    for key in keys {
        if of_typology.get(key).and_then(Value::as_array).is_some_and(Vec::is_empty) {
            of_typology.remove(key);
        }
    }
    let text = toml::to_string(&table).map_err(|error| wrong(error.to_string()))?;
    Schemes::default().extended_by(&text)?;
    Ok(text)
}

/// Reads changes as a command takes them: 'ward=M; linen store=S; shaft=-; hallway=?; ward=#ffd27f'; '=#' for the palette's colour.
///
/// # Errors
/// When one is not understood.
pub fn read_changes(words: &str) -> Result<Changes, SchemeError> {
    let mut changes = Changes::default();
    for word in words.split(';').map(str::trim).filter(|word| !word.is_empty()) {
        let wrong = || SchemeError::new(format!("'{word}' is not understood: expected FUNCTION=LABEL, such as ward=M"));
        let (function, meaning) = word.rsplit_once('=').ok_or_else(wrong)?;
        let function = normalised_function(function);
        if function.is_empty() {
            return Err(wrong());
        }
        if let Some(digits) = meaning.trim().strip_prefix('#') {
            let read = if digits.is_empty() { None } else { Some(colour(meaning.trim()).ok_or_else(wrong)?) };
            changes.colours.insert(function, read);
            continue;
        }
        let meaning = match meaning.trim() {
            "-" => Some(Meaning::NotClassified),
            "?" => None,
            letter => {
                let label = Label::ALL.into_iter().find(|label| label.letter().eq_ignore_ascii_case(letter));
                Some(Meaning::Labelled(label.ok_or_else(wrong)?))
            }
        };
        changes.meanings.insert(function, meaning);
    }
    Ok(changes)
}

/// The same as words.
pub fn changes_words(changes: &Changes) -> String {
    let word = |(function, meaning): (&String, &Option<Meaning>)| {
        let meaning = match meaning {
            Some(Meaning::Labelled(label)) => label.letter(),
            Some(Meaning::NotClassified) => "-",
            None => "?",
        };
        format!("{function}={meaning}")
    };
    let colour = |(function, colour): (&String, &Option<Colour>)| {
        let digits = colour.map(|[r, g, b]| format!("{r:02x}{g:02x}{b:02x}")).unwrap_or_default();
        format!("{function}=#{digits}")
    };
    let words = changes.meanings.iter().map(word).chain(changes.colours.iter().map(colour));
    words.collect::<Vec<_>>().join("; ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_changed_file_means_the_new_and_keeps_the_rest() {
        let before = "version = 1\n[Hospital]\nM = ['ward', 'office']\nusual_area_m2 = { M = [18.0, 30.0] }\n\
                      temporary = [{ label = 'M' }]\n[house]\nS = ['kitchen']\n";
        let hospital = Typology::new("hospital").unwrap();
        let changes = read_changes("WARD=B; office=?; linen store=S; shaft=-; ward=#FFD27f; shaft=#").unwrap();
        let text = with_changes(Some(before), &hospital, &changes).unwrap();
        let schemes = Schemes::default().extended_by(&text).unwrap();
        let meaning = |function: &str| schemes.meaning(Some(&hospital), function);
        assert_eq!(meaning("ward"), Some(Meaning::Labelled(Label::BigRoom)));
        assert_eq!(meaning("linen store"), Some(Meaning::Labelled(Label::SmallRoom)));
        assert_eq!((meaning("shaft"), meaning("office")), (Some(Meaning::NotClassified), None));
        assert_eq!(schemes.colours(Some(&hospital)).get("ward"), Some(&[0xff, 0xd2, 0x7f]));
        assert!(schemes.usual_area(Some(&hospital), Label::MediumRoom).is_some());
        let house = Typology::new("house");
        assert_eq!(schemes.meaning(house.as_ref(), "kitchen"), Some(Meaning::Labelled(Label::SmallRoom)));
        assert_eq!(read_changes(&changes_words(&changes)).unwrap(), changes);
    }

    #[test]
    fn a_new_file_is_a_scheme_and_a_broken_one_is_refused() {
        let museum = Typology::new("museum").unwrap();
        let changes = read_changes("gallery=H; a \"quoted\" = name=M").unwrap();
        let text = with_changes(None, &museum, &changes).unwrap();
        let schemes = Schemes::default().extended_by(&text).unwrap();
        assert_eq!(schemes.meaning(Some(&museum), "Gallery"), Some(Meaning::Labelled(Label::Hall)));
        assert!(with_changes(Some("version = 2"), &museum, &changes).is_err());
        for wrong in ["gallery", "=M", "gallery=X", "gallery=#12"] {
            assert!(read_changes(wrong).is_err(), "{wrong}");
        }
    }
}
