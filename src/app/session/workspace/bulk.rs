//! Changing many files of a workspace at once. An open plan gets the change as a step of its own, which its person saves;
//! all other files are written, and what stood in them is kept to undo it.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use egui::Context;

use crate::app::session::Session;
use crate::app::session::jobs::Kind;
use crate::app::session::messages::Severity;
use crate::app::session::origin::{Origin, file_name};
use crate::base::wording::{count, sentence};
use crate::base::work::Work;
use crate::formats::{self, plan_json};
use crate::plan::RoomId;
use crate::store::{Stamp, checked_bytes, save_bytes};
use crate::workspace::change::{self, Change};

/// Files that were changed together.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Changed {
    /// What was said of it.
    pub said: String,
    /// By path, what stood there before, and what stands there since.
    pub files: BTreeMap<PathBuf, (Vec<u8>, Stamp)>,
}

/// What came of changing files.
struct Written {
    changed: Changed,
    failed: Vec<String>,
}

/// The names of the jobs, by which their progress is found.
const CHANGE: &str = "change plans";
const PUT_BACK: &str = "put plans back";

/// So many files are named in a message.
const NAMED: usize = 5;

impl Session {
    /// Makes a change to all that is selected in the workspace. Returns why it cannot be made.
    ///
    /// # Errors
    /// When nothing would change, or another change is being written.
    pub(crate) fn change_in_workspace(&mut self, change: &Change) -> Result<(), String> {
        let Some(workspace) = &self.workspace else { return Err("open a folder of plans first".to_owned()) };
        if self.jobs.is_one_to_end() {
            return Err("files are still being written".to_owned());
        }
        let planned = change::planned(&workspace.now, &workspace.view.selected, change);
        if planned.changed == 0 {
            return Err("nothing would change".to_owned());
        }
        let folder = workspace.now.folder().to_owned();
        let said = planned.done(change);
        let mut files: BTreeMap<PathBuf, BTreeMap<u32, BTreeSet<RoomId>>> = BTreeMap::new();
        let (mut opened, mut refused) = (Vec::new(), Vec::new());
        for (path, plans) in planned.files {
            let at = folder.join(&*path);
            // What is open is changed where its person sees it, with what is not saved.
            match self.open_of(&Origin::File { path: at.clone(), storey: 0 }) {
                None => drop(files.insert(at, plans)),
                Some(number) => {
                    let rooms = plans.get(&0).cloned().unwrap_or_default();
                    let title = sentence(&format!("give {}", change.words()));
                    let edited = self.in_plan(number, |session| {
                        session.try_edit(&title, |plan| change::changed(plan, &rooms, change))
                    });
                    match edited {
                        Some(Err(error)) => refused.push(format!("{path}: {error}")),
                        _ => opened.push(file_name(&at)),
                    }
                }
            }
        }
        let change = change.clone();
        let kind = Kind::new(CHANGE).must_end();
        self.jobs.start(kind, move |work| {
            let mut written = write(&files, &change, work);
            written.changed.said = said;
            written.failed.extend(refused);
            move |session: &mut Session, _: &Context| session.workspace_was_changed(written, &opened)
        });
        Ok(())
    }

    /// How far writing many files is: the share that is done, 0..=1, and in words. `None` where none are being written.
    pub(crate) fn changing_shown(&self) -> Option<(f64, String)> {
        let running = self.jobs.progress().into_iter().find(|(name, _)| [CHANGE, PUT_BACK].contains(name));
        let (done, all) = running?.1.unwrap_or_default();
        let said =
            if all == 0 { "Writing files".to_owned() } else { format!("{done} of {} written", count(all, "file")) };
        Some((done as f64 / all.max(1) as f64, said))
    }

    fn workspace_was_changed(&mut self, Written { changed, failed }: Written, opened: &[String]) {
        let mut lines = Vec::new();
        let names: Vec<String> = changed.files.keys().map(|path| self.shown_path(path)).collect();
        lines.extend(named("Written", &names));
        lines.extend(named("Open, and not saved yet", opened));
        lines.extend(named("Not changed", &failed));
        let text = if failed.is_empty() { changed.said.clone() } else { "Not all could be changed".to_owned() };
        self.status.clone_from(&text);
        let severity = if failed.is_empty() { Severity::Info } else { Severity::Warning };
        self.say_of_program(severity, text, lines.join("\n"));
        let paths: Vec<PathBuf> = changed.files.keys().cloned().collect();
        if let Some(workspace) = &mut self.workspace
            && !changed.files.is_empty()
        {
            workspace.changed = Some(changed);
        }
        self.read_in_workspace_again(&paths);
        self.look_soon();
    }

    /// Puts back what stood in the files that were changed last, where nobody has changed them since.
    ///
    /// # Errors
    /// When nothing was changed.
    pub(crate) fn undo_in_workspace(&mut self) -> Result<(), String> {
        if self.jobs.is_one_to_end() {
            return Err("files are still being written".to_owned());
        }
        let changed = self.workspace.as_mut().and_then(|workspace| workspace.changed.take());
        let Some(changed) = changed else { return Err("no files were changed".to_owned()) };
        self.messages.retain(|message| message.text != changed.said);
        self.jobs.start(Kind::new(PUT_BACK).must_end(), move |work| {
            let files: Vec<(PathBuf, (Vec<u8>, Stamp))> = changed.files.into_iter().collect();
            let put_back = |at: usize| -> Result<(), String> {
                let (path, (bytes, stamp)) = &files[at];
                if Stamp::of(path) != Some(*stamp) {
                    return Err(format!("{}: somebody has changed it since", path.display()));
                }
                save_bytes(path, bytes).map_err(|error| error.to_string())
            };
            let results = work.map(files.len(), put_back).unwrap_or_default();
            let paths: Vec<PathBuf> = files.into_iter().map(|(path, _)| path).collect();
            move |session: &mut Session, _: &Context| {
                let failed: Vec<String> = results.iter().filter_map(|result| result.clone().err()).collect();
                let text = format!("{} put back as before", count(results.len() - failed.len(), "file"));
                session.status.clone_from(&text);
                if !failed.is_empty() {
                    let lines: Vec<String> = named("Not put back", &failed).into_iter().collect();
                    session.say_of_program(Severity::Warning, text, lines.join("\n"));
                }
                session.read_in_workspace_again(&paths);
                session.look_soon();
            }
        });
        Ok(())
    }
}

/// A line that names some files.
fn named(what: &str, names: &[String]) -> Option<String> {
    let more = names.len().saturating_sub(NAMED);
    let shown = names.iter().take(NAMED).cloned().collect::<Vec<_>>().join(", ");
    match (names.is_empty(), more) {
        (true, _) => None,
        (false, 0) => Some(format!("{what}: {shown}")),
        (false, more) => Some(format!("{what}: {shown} and {more} more")),
    }
}

/// Changes files one by one, each as it stands now.
fn write(files: &BTreeMap<PathBuf, BTreeMap<u32, BTreeSet<RoomId>>>, change: &Change, work: &Work<'_>) -> Written {
    let mut written = Written { changed: Changed::default(), failed: Vec::new() };
    for (done, (path, plans)) in files.iter().enumerate() {
        // What was begun is ended: half of the files changed would be worse.
        let _ = work.step(done, files.len());
        let rooms = plans.get(&0).cloned().unwrap_or_default();
        match write_one(path, &rooms, change) {
            Ok((before, stamp)) => drop(written.changed.files.insert(path.clone(), (before, stamp))),
            Err(what) => written.failed.push(what),
        }
    }
    written
}

fn write_one(path: &Path, rooms: &BTreeSet<RoomId>, change: &Change) -> Result<(Vec<u8>, Stamp), String> {
    let before = formats::read_bytes(path).map_err(|error| error.to_string())?;
    let plan = plan_json::from_bytes(&before).map_err(|error| format!("{}: {error}", path.display()))?;
    let next = change::changed(&plan, rooms, change).map_err(|error| format!("{}: {error}", path.display()))?;
    let bytes = checked_bytes(path, &next).map_err(|error| error.to_string())?;
    save_bytes(path, &bytes).map_err(|error| error.to_string())?;
    Ok((before, Stamp::of_bytes(&bytes)))
}
