//! User settings, kept in a file between sessions: the shortcuts, the units, the grid; and what is remembered, which
//! `memory` reads and writes.
//!
//! The file is JSON. Entries unknown to this version are kept. A file that cannot be read is moved aside
//! and never overwritten.

use super::Session;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde_json::{Map, Value, json};

use crate::app::look::keys::Keys;
use crate::app::session::messages::{Message, Severity};
use crate::base::units::Units;
use crate::store;

/// Environment variable for another settings file; if empty, none is read or kept.
const VARIABLE: &str = "ENFILADE_SETTINGS";

/// The file version that is written.
const VERSION: u64 = 1;

/// The range of the grid spacing, in metres.
pub(crate) const GRID_RANGE_M: std::ops::RangeInclusive<f64> = 0.001..=1000.0;

/// The maximum size of a settings file.
const MOST_BYTES: u64 = 1 << 20;

/// A command and its shortcuts.
#[derive(Clone, Debug)]
pub(crate) struct Keyed {
    pub id: &'static str,
    pub title: &'static str,
    /// Its menu; `None` if it is only for scripts.
    pub menu: Option<&'static str>,
    /// Its default shortcuts.
    pub shipped: Vec<Keys>,
}

/// The user's settings.
#[derive(Debug, Default)]
pub(crate) struct Settings {
    /// All commands.
    commands: &'static [Keyed],
    /// Their file; `None` if they are not kept.
    file: Option<PathBuf>,
    /// The whole contents of the file.
    kept: Map<String, Value>,
    /// The shortcuts that differ from the defaults.
    changed: BTreeMap<&'static str, Vec<Keys>>,
    units: Units,
    /// Spacing of the grid in metres; `None` chooses it by the zoom.
    grid_m: Option<f64>,
}

/// Why a shortcut was refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Refused {
    /// The command with this title has the keys.
    Taken(&'static str),
    /// The keys are reserved; the text says why.
    Reserved(&'static str),
}

impl Refused {
    /// The reason in a sentence.
    pub(crate) fn reason(self, keys: &str) -> String {
        match self {
            Self::Taken(title) => format!("{keys} is already the shortcut of '{}'", title.trim_end_matches('…')),
            Self::Reserved(why) => format!("{keys} cannot be a shortcut: {why}"),
        }
    }
}

/// The settings file: the one in the environment variable, or in the system's location; `None` if there
/// is none.
pub(crate) fn file() -> Option<PathBuf> {
    use etcetera::BaseStrategy as _;
    match std::env::var_os(VARIABLE) {
        Some(path) => (!path.is_empty()).then(|| PathBuf::from(path)),
        None => {
            let place = etcetera::choose_base_strategy().ok()?;
            Some(place.config_dir().join("enfilade").join("settings.json"))
        }
    }
}

impl Settings {
    /// The default settings, not kept.
    pub(crate) fn new(commands: &'static [Keyed]) -> Self {
        Self { commands, ..Self::default() }
    }

    /// A value of the file.
    pub(super) fn value(&self, name: &str) -> Option<&Value> {
        self.kept.get(name)
    }

    pub(super) fn set_value(&mut self, name: &str, value: Value) {
        self.kept.insert(name.to_owned(), value);
    }

    /// Whether they are kept in a file.
    pub(crate) const fn is_kept(&self) -> bool {
        self.file.is_some()
    }

    /// All commands.
    pub(crate) const fn commands(&self) -> &'static [Keyed] {
        self.commands
    }

    /// Reads the settings from a file, or starts a new one; also returns messages about it.
    pub(crate) fn read(file: PathBuf, commands: &'static [Keyed]) -> (Self, Vec<Message>) {
        let mut problems = Vec::new();
        let text = match read_text(&file) {
            Ok(text) => text,
            Err(what) => {
                // Neither read nor ever written.
                let text = format!("Your settings cannot be read: {what}");
                let detail = format!("Changes last until you close the window.\n{}", file.display());
                return (Self::new(commands), vec![warning(text, detail)]);
            }
        };
        let kept = match text.as_deref().map(serde_json::from_str::<Map<String, Value>>) {
            None => Map::new(),
            Some(Ok(kept)) if kept.get("version").and_then(Value::as_u64).is_some_and(|version| version > VERSION) => {
                let text = "Your settings come from a newer version of Enfilade".to_owned();
                let detail =
                    format!("They are left as they are. Changes last until you close the window.\n{}", file.display());
                return (Self::new(commands), vec![warning(text, detail)]);
            }
            Some(Ok(kept)) => kept,
            Some(Err(error)) => {
                let text = "Your settings are damaged; Enfilade starts with its defaults".to_owned();
                let at = format!("line {}, column {}: {}", error.line(), error.column(), file.display());
                return match set_aside(&file) {
                    Ok(aside) => {
                        problems.push(warning(text, format!("{at}\nThe damaged file is kept as {}.", aside.display())));
                        (Self { file: Some(file), ..Self::new(commands) }, problems)
                    }
                    Err(error) => {
                        let detail = format!(
                            "{at}\nThe file cannot be moved aside ({error}), so changes to settings are not \
                                     kept."
                        );
                        (Self::new(commands), vec![warning(text, detail)])
                    }
                };
            }
        };
        // Values unknown to this version leave the defaults.
        let units = kept.get("units").and_then(Value::as_str).and_then(Units::from_name).unwrap_or_default();
        let is_grid = |grid_m: &f64| GRID_RANGE_M.contains(grid_m);
        let grid_m = kept.get("grid_m").and_then(Value::as_f64).filter(is_grid);
        let mut settings = Self { commands, file: Some(file), kept, changed: BTreeMap::new(), units, grid_m };
        problems.extend(settings.read_shortcuts());
        (settings, problems)
    }

    /// Loads the shortcuts from the file, except invalid ones.
    fn read_shortcuts(&mut self) -> Option<Message> {
        let kept = self.kept.get("shortcuts")?.as_object().cloned().unwrap_or_default();
        let mut wrong = Vec::new();
        for (id, value) in &kept {
            // A command from another version.
            let Some(command) = self.find(id) else { continue };
            let keys: Option<Vec<Keys>> =
                value.as_array().and_then(|list| list.iter().map(|keys| keys.as_str()?.parse().ok()).collect());
            match keys {
                Some(keys) => drop(self.changed.insert(command.id, keys)),
                None => wrong.push(format!("{id}: {value} is not a list of keys")),
            }
        }
        // With all changes in place, so that two commands may have swapped keys. One that is dropped gets
        // its defaults back, which another may have.
        while let Some((id, reason)) = self.changed.iter().find_map(|(id, keys)| {
            let (keys, refused) = keys.iter().find_map(|&keys| Some((keys, self.why_refused(id, keys)?)))?;
            Some((*id, refused.reason(&keys.to_string())))
        }) {
            wrong.push(format!("{id}: {reason}"));
            self.changed.remove(id);
        }
        let file = self.file.as_deref().map(Path::display);
        let place = file.map(|file| file.to_string()).unwrap_or_default();
        let text = "Some shortcuts in your settings cannot be used".to_owned();
        (!wrong.is_empty()).then(|| warning(text, format!("{}\n{place}", wrong.join("\n"))))
    }

    /// The units in which lengths and areas are shown and typed.
    pub(crate) fn units(&self) -> Units {
        self.units
    }

    pub(crate) fn set_units(&mut self, units: Units) {
        self.units = units;
        self.kept.insert("units".to_owned(), json!(units.name()));
    }

    /// Spacing of the grid in metres; `None` chooses it by the zoom.
    pub(crate) fn grid_m(&self) -> Option<f64> {
        self.grid_m
    }

    pub(crate) fn set_grid_m(&mut self, grid_m: Option<f64>) {
        self.grid_m = grid_m;
        match grid_m {
            Some(grid_m) => drop(self.kept.insert("grid_m".to_owned(), json!(grid_m))),
            None => drop(self.kept.shift_remove("grid_m")),
        }
    }

    /// The shortcuts of a command; the first one is shown.
    pub(crate) fn keys_of(&self, id: &str) -> &[Keys] {
        self.changed.get(id).map_or_else(|| self.shipped_keys(id), Vec::as_slice)
    }

    fn find(&self, id: &str) -> Option<&'static Keyed> {
        self.commands.iter().find(|command| command.id == id)
    }

    fn shipped_keys(&self, id: &str) -> &'static [Keys] {
        self.find(id).map_or(&[], |command| command.shipped.as_slice())
    }

    /// Whether a command's shortcuts differ from its defaults.
    pub(crate) fn is_changed(&self, id: &str) -> bool {
        self.changed.contains_key(id)
    }

    /// Whether any shortcut differs from its default.
    pub(crate) fn is_any_changed(&self) -> bool {
        !self.changed.is_empty()
    }

    /// Why a command cannot have a shortcut; `None` if it can.
    fn why_refused(&self, id: &str, keys: Keys) -> Option<Refused> {
        let other = self.commands.iter().find(|other| other.id != id && self.keys_of(other.id).contains(&keys));
        let reserved = keys.why_reserved().filter(|_| !self.shipped_keys(id).contains(&keys));
        reserved.map(Refused::Reserved).or(other.map(|other| Refused::Taken(other.title)))
    }

    /// Replaces a command's shortcuts by one; `None` removes them.
    ///
    /// # Errors
    /// When another command has the keys, or they are reserved.
    pub(crate) fn set_keys(&mut self, id: &'static str, keys: Option<Keys>) -> Result<(), Refused> {
        if let Some(refused) = keys.and_then(|keys| self.why_refused(id, keys)) {
            return Err(refused);
        }
        let keys: Vec<Keys> = keys.into_iter().collect();
        if self.keys_of(id) != keys {
            self.changed.insert(id, keys);
        }
        Ok(())
    }

    /// Restores a command's default shortcuts.
    ///
    /// # Errors
    /// When another command now has them: the keys and the command.
    pub(crate) fn reset_keys(&mut self, id: &str) -> Result<(), (Keys, Refused)> {
        for &keys in self.shipped_keys(id) {
            if let Some(refused) = self.why_refused(id, keys) {
                return Err((keys, refused));
            }
        }
        self.changed.remove(id);
        Ok(())
    }

    /// Restores all default shortcuts.
    pub(crate) fn reset_all_keys(&mut self) {
        self.changed.clear();
    }

    /// Writes the settings to their file, if they have one.
    ///
    /// # Errors
    /// When they could not be written: the message to show.
    pub(crate) fn write(&mut self) -> Result<(), Message> {
        let mut shortcuts = self.kept.get("shortcuts").and_then(Value::as_object).cloned().unwrap_or_default();
        // Those of commands unknown to this version stay.
        shortcuts.retain(|id, _| self.find(id).is_none());
        for (id, keys) in &self.changed {
            let keys: Vec<String> = keys.iter().map(Keys::to_string).collect();
            shortcuts.insert((*id).to_owned(), json!(keys));
        }
        shortcuts.sort_keys();
        self.kept.insert("version".to_owned(), json!(VERSION));
        self.kept.insert("shortcuts".to_owned(), Value::Object(shortcuts));
        let Some(file) = &self.file else { return Ok(()) };
        let written = serde_json::to_string_pretty(&self.kept).map_err(|error| error.to_string()).and_then(|text| {
            if let Some(folder) = file.parent() {
                std::fs::create_dir_all(folder).map_err(|error| error.to_string())?;
            }
            store::save_bytes(file, (text + "\n").as_bytes()).map_err(|error| error.to_string())
        });
        written.map_err(|what| {
            let detail = format!("{what}\nChanges last until you close the window.");
            warning("Your settings could not be saved".to_owned(), detail)
        })
    }
}

fn warning(text: String, detail: String) -> Message {
    Message::new(Severity::Warning, text, detail).of_program()
}

/// The text of a file; `None` if it does not exist.
pub(crate) fn read_text(file: &Path) -> Result<Option<String>, String> {
    match std::fs::metadata(file) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(error.to_string()),
        Ok(metadata) if !metadata.is_file() => Err("it is not a file".to_owned()),
        Ok(metadata) if metadata.len() > MOST_BYTES => Err("it is too large".to_owned()),
        // Anything that is not text is damaged, like text that is not JSON.
        Ok(_) => std::fs::read(file)
            .map(|bytes| Some(String::from_utf8_lossy(&bytes).into_owned()))
            .map_err(|error| error.to_string()),
    }
}

/// Renames a file to the first free name with 'damaged' in it.
fn set_aside(file: &Path) -> std::io::Result<PathBuf> {
    let stem = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let free = (1..)
        .map(
            |number| if number == 1 { format!("{stem}.damaged.json") } else { format!("{stem}.damaged-{number}.json") },
        )
        .map(|name| file.with_file_name(name))
        .find(|aside| !aside.exists())
        .ok_or(std::io::ErrorKind::AlreadyExists)?;
    std::fs::rename(file, &free)?;
    Ok(free)
}

impl Session {
    /// The units in which lengths and areas are shown and typed.
    pub(crate) fn units(&self) -> Units {
        self.settings.units()
    }
}
