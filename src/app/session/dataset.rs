//! The dataset of the open folder's plans, made in the background.

use std::path::{Path, PathBuf};

use egui::Context;

use super::Session;
use crate::app::session::at_hand::read_files;
use crate::app::session::file_dialogs::Purpose;
use crate::app::session::jobs::Kind;
use crate::app::session::messages::Severity;
use crate::app::session::origin::file_name;
use crate::base::wording::count;
use crate::base::work::{Cancelled, Work};
use crate::formats::FileError;
use crate::gather::beside;
use crate::gather::dataset::{Made, made};
use crate::labels::Schemes;
use crate::store;

/// The name of the job, by which its progress is found.
const JOB: &str = "make the dataset";

/// What was made.
struct Finished {
    made: Made,
    plans: usize,
    unreadable: Vec<FileError>,
}

impl Session {
    /// The folder whose plans make the dataset, and its plans: those in the list.
    pub(crate) fn dataset_source(&self) -> Option<(&Path, &[PathBuf])> {
        let folder = self.list.folder.as_deref()?;
        (!self.list.files.is_empty()).then_some((folder, self.list.files.as_slice()))
    }

    /// Where a dataset goes unless told otherwise: into the folder of its plans.
    pub(crate) fn dataset_path(&self) -> PathBuf {
        let folder = self.list.folder.clone().unwrap_or_default();
        let name = folder.file_name().map_or_else(|| "rooms".to_owned(), |name| name.to_string_lossy().into_owned());
        folder.join(format!("{name}.csv"))
    }

    /// Asks where a dataset goes.
    pub(crate) fn ask_where_to_put_dataset(&mut self, path: &Path) {
        let folder = path.parent().map(Path::to_owned).filter(|folder| folder.is_dir());
        self.ask_for_file(Purpose::Dataset, folder, file_name(path));
    }

    /// Makes the dataset of the plans in the list, as `enfilade dataset` does, and writes it.
    ///
    /// # Errors
    /// When no folder is open, or a dataset is being made already.
    pub(crate) fn export_dataset(&mut self, mut path: PathBuf) -> Result<(), String> {
        if self.is_making_dataset() {
            return Err("a dataset is already being made".to_owned());
        }
        let Some((folder, files)) = self.dataset_source() else {
            return Err("open a folder with plans first, or save the plan".to_owned());
        };
        if !path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("csv")) {
            path.as_mut_os_string().push(".csv");
        }
        let (folder, files, schemes) = (folder.to_owned(), files.to_vec(), self.schemes.clone());
        let names: Vec<String> = files.iter().map(|file| self.shown_path(file)).collect();
        let command =
            format!("enfilade dataset {} -o {}", quoted(&self.shown_path(&folder)), quoted(&file_name(&path)));
        let kind = Kind::new(JOB).if_broken(|session| session.dataset_job = None);
        let job = self.jobs.start_wanted(kind, move |work| {
            let finished = make(&files, &names, &schemes, &path, &command, work);
            move |session: &mut Session, _: &Context| {
                session.dataset_job = None;
                session.dataset_was_made(&path, finished);
            }
        });
        // Inline the job has ended already, and says so in the next frame.
        self.dataset_job = Some(job);
        Ok(())
    }

    /// Whether a dataset is being made.
    pub(crate) fn is_making_dataset(&self) -> bool {
        self.dataset_job.is_some()
    }

    /// How many of how many plans have been read.
    pub(crate) fn dataset_progress(&self) -> Option<(usize, usize)> {
        self.jobs.progress_of(JOB)
    }

    /// Gives up making the dataset: nothing is written.
    pub(crate) fn cancel_dataset(&mut self) {
        if self.dataset_job.take().is_some() {
            self.status = "The dataset was cancelled; nothing was written".to_owned();
        }
    }

    fn dataset_was_made(&mut self, path: &Path, finished: Result<Finished, String>) {
        match finished {
            Err(error) => self.say(Severity::Error, "The dataset was not written", error),
            Ok(Finished { made, plans, unreadable }) => {
                let text = format!(
                    "{}: {} of {}, {}",
                    file_name(path),
                    count(made.rooms, "labelled room"),
                    count(plans, "plan"),
                    count(made.buildings, "building")
                );
                self.status = text.clone();
                let left_out = made.left_out.total();
                let mut details = vec![self.shown_path(path)];
                if left_out > 0 {
                    details.push(format!(
                        "{} left out: without a label, a function or a boundary, or not classified",
                        count(left_out, "room")
                    ));
                }
                details.extend(unreadable.iter().take(3).map(|error| format!("not read: {error}")));
                if unreadable.len() > 3 {
                    details.push(format!("and {} more files that could not be read", unreadable.len() - 3));
                }
                let severity = if unreadable.is_empty() { Severity::Info } else { Severity::Warning };
                self.say(severity, text, details.join("\n"));
            }
        }
    }
}

/// A word as a shell takes it.
fn quoted(word: &str) -> String {
    let is_plain = !word.is_empty() && word.chars().all(|c| c.is_alphanumeric() || "/._-".contains(c));
    if is_plain { word.to_owned() } else { format!("'{}'", word.replace('\'', "'\\''")) }
}

/// Reads the plans and writes the files.
fn make(
    files: &[PathBuf],
    names: &[String],
    schemes: &Schemes,
    path: &Path,
    command: &str,
    work: &Work<'_>,
) -> Result<Finished, String> {
    let cancelled = |_: Cancelled| "it was cancelled".to_owned();
    let files: Vec<(PathBuf, String)> = files.iter().cloned().zip(names.iter().cloned()).collect();
    let (read, _, unreadable) = read_files(&files, schemes, work, |_, _| ())?;
    let plans = read.networks.len();
    if plans == 0 {
        return Err("no plan could be read".to_owned());
    }
    work.goes_on().map_err(cancelled)?;
    let made = made(read, schemes, path, command)?;
    if made.rooms == 0 {
        return Err("no room of these plans has a label; label some first".to_owned());
    }
    // From here on it is written to the end, so that the files belong together.
    work.goes_on().map_err(cancelled)?;
    let parts = [
        (path.to_owned(), &made.csv),
        (beside(path, "edges.csv"), &made.edges),
        (beside(path, "schema.json"), &made.schema),
        (beside(path, "edges.schema.json"), &made.edges_schema),
        (beside(path, "manifest.json"), &made.manifest),
    ];
    for (path, bytes) in parts {
        store::save_bytes(&path, bytes).map_err(|error| error.to_string())?;
    }
    Ok(Finished { made, plans, unreadable })
}
