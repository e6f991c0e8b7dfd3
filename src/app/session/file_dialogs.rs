//! File dialogs: the system's, or predefined answers where there is no screen.

use crate::app::session::picture_change::PictureUse;
use std::any::Any;
use std::collections::VecDeque;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use egui::Context;

use crate::app::session::{
    Session,
    jobs::{Jobs, Kind},
    questions::Intent,
};
use crate::store::pictures::PICTURE_ENDINGS;

/// The source of answers.
pub(crate) enum Dialogs {
    /// The system's dialogs, one at a time. `are_missing`: it has shown none, so that paths are typed.
    System { is_open: bool, are_missing: bool },
    /// Predefined answers.
    Given(Given),
}

/// Predefined answers, in order; `None` cancels, and so does running out.
#[derive(Default)]
pub(crate) struct Given {
    pub answers: VecDeque<Option<PathBuf>>,
    /// How many dialogs found no answer left.
    pub unanswered: usize,
    /// Whether to be as a system without dialogs.
    pub has_none: bool,
    /// Whether that was found out.
    pub are_missing: bool,
    /// Whether one is open.
    is_open: bool,
}

/// The purpose of choosing a file.
pub(crate) enum Purpose {
    Open,
    /// To open a folder of plans.
    Workspace,
    /// To replay a robot's log.
    Log,
    Picture(PictureUse),
    /// `answering`: the answer to a question that led to this.
    Save {
        then: Option<Intent>,
        answering: Option<&'static str>,
    },
    /// To export the plan; the answer is for the dialog that asked.
    Export,
    /// To write a dataset; the answer is for the dialog that asked.
    Dataset,
    /// Labelled rooms: a folder of plans, or a dataset; the answer is for the dialog that asked.
    Data {
        is_folder: bool,
    },
    /// A folder to write in; the answer is for the dialog that asked.
    Folder,
    /// To write a chart; the answer is for the dialog that asked.
    Chart,
    /// To save a recording; the closure makes the message that tells the recorder the path.
    Recording(Box<dyn FnOnce(PathBuf) -> Box<dyn Any + Send> + Send>),
}

/// A dialog's answer.
pub(crate) struct Answer {
    pub purpose: Purpose,
    /// `None` if the dialog was cancelled.
    pub path: Option<PathBuf>,
    /// Whether the user can have seen the dialog.
    pub was_shown: bool,
    /// The folder and the name that the dialog began with.
    pub folder: Option<PathBuf>,
    pub name: String,
}

/// Nobody cancels a dialog faster than this: it was never shown.
const QUICKEST_CANCEL: Duration = Duration::from_millis(250);

impl Dialogs {
    /// Asks for a file; the answer goes to [`Session::was_chosen`]. Does nothing while a dialog is open.
    pub(crate) fn ask(&mut self, purpose: Purpose, folder: Option<PathBuf>, name: String, jobs: &mut Jobs) {
        let kind = Kind::new("ask for a file").if_broken(|session| session.dialogs.answered());
        match self {
            Self::Given(Given { has_none: true, .. }) => {
                let was_shown = false;
                jobs.start(kind, move |_| answers(Answer { purpose, path: None, was_shown, folder, name }));
            }
            Self::Given(given) => {
                let answer = given.answers.pop_front();
                given.unanswered += usize::from(answer.is_none());
                given.is_open = true;
                let path = answer.flatten();
                jobs.start(kind, move |_| answers(Answer { purpose, path, was_shown: true, folder, name }));
            }
            Self::System { is_open: true, .. } => {}
            Self::System { is_open, .. } => {
                *is_open = true;
                let mut dialog = rfd::AsyncFileDialog::new();
                if let Some(folder) = folder.as_ref().filter(|folder| folder.is_dir()) {
                    dialog = dialog.set_directory(folder);
                }
                // Created here, on the window's thread, as some systems require; waited for elsewhere.
                let chosen = match purpose {
                    Purpose::Open => {
                        let dialog = dialog
                            .set_title("Open a plan")
                            .add_filter("Plans", &crate::formats::dialog_endings())
                            .add_filter("All files", &["*"]);
                        Box::pin(dialog.pick_file()) as Waiting
                    }
                    Purpose::Workspace => Box::pin(dialog.set_title("Open a folder of plans").pick_folder()),
                    Purpose::Log => {
                        let dialog = dialog
                            .set_title("Replay a laser log")
                            .add_filter("Laser logs", &["log", "log.gz", "gz"])
                            .add_filter("All files", &["*"]);
                        Box::pin(dialog.pick_file())
                    }
                    Purpose::Picture(_) => {
                        let dialog = dialog
                            .set_title("Choose a picture to trace")
                            .add_filter("Pictures", PICTURE_ENDINGS)
                            .add_filter("All files", &["*"]);
                        Box::pin(dialog.pick_file())
                    }
                    Purpose::Save { .. } => {
                        let dialog = dialog
                            .set_title("Save the plan")
                            .set_file_name(&name)
                            .add_filter("Enfilade plan", &["plan.json"]);
                        Box::pin(dialog.save_file())
                    }
                    Purpose::Export => {
                        let dialog = dialog.set_title("Export the plan").set_file_name(&name);
                        Box::pin(dialog.save_file())
                    }
                    Purpose::Dataset => {
                        let dialog =
                            dialog.set_title("Export the dataset").set_file_name(&name).add_filter("Table", &["csv"]);
                        Box::pin(dialog.save_file())
                    }
                    Purpose::Data { is_folder: true } => {
                        Box::pin(dialog.set_title("Choose a folder with plans").pick_folder())
                    }
                    Purpose::Data { is_folder: false } => {
                        let dialog = dialog.set_title("Choose a dataset").add_filter("Table", &["csv"]);
                        Box::pin(dialog.pick_file())
                    }
                    Purpose::Folder => Box::pin(dialog.set_title("Choose a folder").pick_folder()),
                    Purpose::Chart => {
                        let dialog = dialog.set_title("Export the chart").set_file_name(&name);
                        let dialog = dialog
                            .add_filter("Picture (PNG)", &["png"])
                            .add_filter("Drawing (SVG)", &["svg"])
                            .add_filter("Table (CSV)", &["csv"]);
                        Box::pin(dialog.save_file())
                    }
                    Purpose::Recording(_) => {
                        let dialog = dialog
                            .set_title("Save the recording")
                            .set_file_name(&name)
                            .add_filter("Replay scripts", &["replay"]);
                        Box::pin(dialog.save_file())
                    }
                };
                jobs.start(kind, move |_| {
                    let asked = now();
                    let path = pollster::block_on(chosen).map(|file| file.path().to_owned());
                    let was_shown = path.is_some() || asked.elapsed() >= QUICKEST_CANCEL;
                    answers(Answer { purpose, path, was_shown, folder, name })
                });
            }
        }
    }

    /// Records that the dialog has closed.
    pub(crate) fn answered(&mut self) {
        match self {
            Self::System { is_open, .. } | Self::Given(Given { is_open, .. }) => *is_open = false,
        }
    }

    /// Whether a dialog is open: it, not the window, is meant by what is typed.
    pub(crate) const fn is_open(&self) -> bool {
        match self {
            Self::System { is_open, .. } | Self::Given(Given { is_open, .. }) => *is_open,
        }
    }

    /// Whether the system shows no dialogs, as far as is known.
    pub(crate) const fn are_missing(&self) -> bool {
        match self {
            Self::System { are_missing, .. } | Self::Given(Given { are_missing, .. }) => *are_missing,
        }
    }

    /// Records that the system showed no dialog. Returns whether that is news.
    pub(crate) const fn show_nothing(&mut self) -> bool {
        match self {
            Self::System { are_missing, .. } | Self::Given(Given { are_missing, .. }) => {
                !std::mem::replace(are_missing, true)
            }
        }
    }
}

impl Purpose {
    /// The command that takes the path.
    pub(crate) const fn command(&self) -> &'static str {
        match self {
            Self::Open => "open",
            Self::Workspace => "open-workspace",
            Self::Log => "replay-log",
            Self::Picture(PictureUse::Add) => "picture",
            Self::Picture(PictureUse::Relink) => "relink-picture",
            Self::Save { .. } => "save-as",
            Self::Recording(_) | Self::Export | Self::Dataset | Self::Data { .. } | Self::Folder | Self::Chart => {
                "choose-file"
            }
        }
    }
}

fn answers(answer: Answer) -> impl FnOnce(&mut Session, &Context) {
    move |session, context| {
        session.dialogs.answered();
        session.was_chosen(answer, context);
    }
}

type Waiting = std::pin::Pin<Box<dyn Future<Output = Option<rfd::FileHandle>> + Send>>;

#[expect(clippy::disallowed_methods, reason = "tells a dialog that was never shown from one that was cancelled")]
fn now() -> Instant {
    Instant::now()
}
