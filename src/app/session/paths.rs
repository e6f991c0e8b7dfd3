//! Paths that are typed: completed from what is on the disk, so that files can be chosen without the system's dialogs.

use std::path::{MAIN_SEPARATOR, Path, PathBuf};

use super::Session;
use super::origin::absolute;
use crate::app::session::file_dialogs::{Answer, Purpose};
use crate::app::session::wishes::Wish;
use crate::base::natural_order::NaturalKey;
use crate::formats;
use crate::store::pictures;

/// What a typed path is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PathUse {
    /// A plan that is opened, or a folder of them.
    Plan,
    /// A robot's laser log that is replayed.
    Log,
    /// A picture that is opened.
    Picture,
    /// A file that is written.
    New,
}

impl PathUse {
    /// Whether a file's name is offered.
    fn fits(self, name: &str) -> bool {
        match self {
            Self::Plan => {
                let name = name.to_lowercase();
                formats::dialog_endings().iter().any(|ending| name.ends_with(&format!(".{ending}")))
            }
            Self::Log => {
                let name = name.to_lowercase();
                [".log", ".log.gz"].iter().any(|ending| name.ends_with(ending))
            }
            Self::Picture => pictures::is_picture_name(Path::new(name)),
            Self::New => true,
        }
    }
}

/// Something in a folder.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct InFolder {
    pub name: String,
    pub is_folder: bool,
}

/// The most that is listed of a folder: it is narrowed by typing.
const LISTED: usize = 20_000;

/// A typed path in two: the folder up to its last separator, and what is typed of a name in it.
pub(crate) fn split_typed(text: &str) -> (&str, &str) {
    let end = text.rfind(['/', MAIN_SEPARATOR]).map_or(0, |at| at + 1);
    text.split_at(end)
}

/// What is offered of a folder, folders first, in natural order. Names that begin with a dot are hidden unless
/// `is_dotted`; nothing is offered of a folder that cannot be read.
pub(crate) fn listed(folder: &Path, use_: PathUse, is_dotted: bool) -> Vec<InFolder> {
    let entries = std::fs::read_dir(if folder.as_os_str().is_empty() { Path::new(".") } else { folder });
    let entries = entries.into_iter().flatten().flatten().take(LISTED);
    let mut found: Vec<InFolder> = entries
        .filter_map(|entry| {
            let name = entry.file_name().into_string().ok()?;
            if name.starts_with('.') && !is_dotted {
                return None;
            }
            let kind = entry.file_type().ok()?;
            // Links stand for what they lead to.
            let is_folder = kind.is_dir() || (kind.is_symlink() && entry.path().is_dir());
            (is_folder || use_.fits(&name)).then_some(InFolder { name, is_folder })
        })
        .collect();
    found.sort_by_cached_key(|entry| (!entry.is_folder, NaturalKey::of(&entry.name)));
    found
}

impl Session {
    /// The path meant by a typed text: `~` is the person's own folder, and what does not begin at the root begins in
    /// the folder of the plan, or the one used last.
    pub(crate) fn typed_path(&self, text: &str) -> PathBuf {
        let text = text.trim();
        let home = || etcetera::home_dir().ok();
        if let Some(home) = home().filter(|_| text == "~") {
            return home;
        }
        if let Some((home, rest)) = home().zip(text.strip_prefix("~/")) {
            return home.join(rest);
        }
        match &self.named_from {
            Some(folder) => folder.join(text),
            None => self.first_folder().join(text),
        }
    }

    /// Where a person begins to look for files: where the plan lies, or the folder used last, or the person's own.
    pub(crate) fn first_folder(&self) -> PathBuf {
        let own = self.document.as_ref().and_then(|document| document.origin.folder());
        let own = own.map(absolute);
        let last = || self.settings.folder().filter(|folder| self.named_from.is_none() && folder.is_dir());
        let home = || self.named_from.clone().or_else(|| etcetera::home_dir().ok()).unwrap_or_default();
        own.or_else(last).unwrap_or_else(home)
    }

    /// The text that a path begins with where it is typed: a folder, and the name of a new file.
    pub(crate) fn first_text(&self, folder: Option<PathBuf>, name: &str) -> String {
        let mut folder = self.shown_path(&folder.unwrap_or_else(|| self.first_folder()));
        if !folder.is_empty() && !folder.ends_with(['/', MAIN_SEPARATOR]) {
            folder.push(MAIN_SEPARATOR);
        }
        folder + name
    }

    /// The name that a new file of the plan is offered.
    pub(crate) fn offered_name(&self) -> String {
        let stem = self.document.as_ref().map_or_else(|| "untitled".to_owned(), |document| document.origin.stem());
        format!("{stem}.plan.json")
    }

    /// Asks for a file by the system's dialog or, where it has none, for a typed path.
    pub(crate) fn ask_for_file(&mut self, purpose: Purpose, folder: Option<PathBuf>, name: String) {
        let folder = folder.or_else(|| self.settings.folder().filter(|_| self.named_from.is_none()));
        if self.dialogs.are_missing() {
            self.type_path(purpose, folder, &name);
        } else {
            self.dialogs.ask(purpose, folder, name, &mut self.jobs);
        }
    }

    /// Asks for a path to be typed.
    pub(super) fn type_path(&mut self, purpose: Purpose, folder: Option<PathBuf>, name: &str) {
        let (command, text) = (purpose.command(), self.first_text(folder, name));
        self.typed_for = Some(purpose);
        self.wishes.push(Wish::TypePath { command, text });
    }

    /// Goes on with a path that was typed for a purpose.
    pub(crate) fn was_typed(&mut self, purpose: Purpose, path: PathBuf, context: &egui::Context) {
        let (path, was_shown, folder, name) = (Some(path), true, None, String::new());
        self.was_chosen(Answer { purpose, path, was_shown, folder, name }, context);
    }

    /// Saves in a path, then does what was to follow if it was asked for. Returns whether it answered a question.
    pub(crate) fn save_as(&mut self, path: PathBuf) -> bool {
        let Some(Purpose::Save { then, answering }) = self.typed_for.take() else {
            self.save_in(path, None);
            return false;
        };
        if let Some(answer) = answering {
            self.note_executed("answer", vec![answer.to_owned(), path.to_string_lossy().into_owned()]);
        }
        self.save_in(path, then);
        answering.is_some()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_typed_path_is_a_folder_and_the_beginning_of_a_name() {
        assert_eq!(split_typed("plans/house/gr"), ("plans/house/", "gr"));
        assert_eq!(split_typed("/"), ("/", ""));
        assert_eq!(split_typed("gr"), ("", "gr"));
        assert_eq!(split_typed(""), ("", ""));
    }

    #[test]
    #[expect(clippy::disallowed_methods, reason = "a test's files are no user's")]
    fn a_folder_offers_folders_and_what_fits() {
        let folder = tempfile::tempdir().expect("a folder");
        for name in ["b10.plan.json", "b9.plan.json", "scan.png", "notes.txt", ".hidden.plan.json"] {
            std::fs::write(folder.path().join(name), "").expect("a file");
        }
        std::fs::create_dir(folder.path().join("west")).expect("a folder");
        let names = |use_, is_dotted| -> Vec<String> {
            listed(folder.path(), use_, is_dotted).into_iter().map(|entry| entry.name).collect()
        };
        assert_eq!(names(PathUse::Plan, false), ["west", "b9.plan.json", "b10.plan.json"]);
        assert_eq!(names(PathUse::Plan, true), ["west", ".hidden.plan.json", "b9.plan.json", "b10.plan.json"]);
        assert_eq!(names(PathUse::Picture, false), ["west", "scan.png"]);
        assert_eq!(names(PathUse::New, false).len(), 5);
        assert_eq!(listed(&folder.path().join("nowhere"), PathUse::New, false), []);
    }
}
