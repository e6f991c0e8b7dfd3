//! The session: the open plan and all that is done with it. It knows no canvas, tool, panel or command.

pub(crate) mod at_hand;
pub(crate) mod bulk;
pub(crate) mod dataset;
pub(crate) mod demo;
pub(crate) mod deriving;
pub(crate) mod document;
pub(crate) mod executed;
pub(crate) mod exporting;
pub(crate) mod fields;
pub(crate) mod file_dialogs;
pub(crate) mod files;
pub(crate) mod findings;
pub(crate) mod fresh;
pub(crate) mod ghost;
pub(crate) mod history;
pub(crate) mod jobs;
pub(crate) mod kept;
pub(crate) mod labelling;
pub(crate) mod layers;
pub(crate) mod live;
pub(crate) mod measures;
pub(crate) mod memory;
pub(crate) mod messages;
pub(crate) mod open_plans;
pub(crate) mod origin;
pub(crate) mod paths;
pub(crate) mod picking;
pub(crate) mod picture_change;
pub(crate) mod plan_list;
pub(crate) mod predictions;
pub(crate) mod questions;
pub(crate) mod recovery;
pub(crate) mod review;
pub(crate) mod robot;
pub(crate) mod safety;
pub(crate) mod samples;
pub(crate) mod scheme_edit;
pub(crate) mod selection;
pub(crate) mod settings;
pub(crate) mod tracing;
pub(crate) mod training;
pub(crate) mod watch;
pub(crate) mod wishes;
pub(crate) mod words;
pub(crate) mod workspace;

use crate::app::paint::backdrop::BackdropView;
use crate::app::session::document::Document;
use crate::app::session::executed::Executed;
use crate::app::session::fields::Field;
use crate::app::session::file_dialogs::Dialogs;
use crate::app::session::jobs::Jobs;
use crate::app::session::jobs::Mode;
use crate::app::session::layers::LayerSettings;
use crate::app::session::messages::Message;
use crate::app::session::messages::Severity;
use crate::app::session::origin::Origin;
use crate::app::session::plan_list::PlanList;
use crate::app::session::questions::Intent;
use crate::app::session::questions::Question;
use crate::app::session::safety::Safety;
use crate::app::session::selection::Selection;
use crate::app::session::settings::Settings;
use crate::app::session::wishes::Wish;
use crate::classify::models::Models;
use crate::draw;
use crate::draw::Palette;
use crate::geometry::Point;
use crate::labels::Schemes;
use crate::plan::ElementId;
use crate::plan::Plan;
use crate::predict::Predictor;
use crate::store::Draft;
use egui::Ui;
use std::path::Path;
use std::path::PathBuf;
use std::sync::Arc;

/// The open plans, the selection, questions, recovery: everything about the window except how it is shown.
pub(crate) struct Session {
    pub(crate) schemes: Arc<Schemes>,
    /// The plan shown.
    pub(crate) document: Option<Document>,
    /// The other open plans.
    pub(crate) waiting_plans: Vec<open_plans::Waiting>,
    /// The view of the plan shown; `None` for all of it.
    pub(crate) view: Option<open_plans::PlanView>,
    /// The origin of the plan being opened.
    pub(crate) opening: Option<Origin>,
    /// Whether the next plan is opened to be looked at: one before it that was only looked at is closed.
    pub(crate) browses: bool,
    /// What a file is asked for where its path is typed.
    pub(crate) typed_for: Option<file_dialogs::Purpose>,
    /// The recently opened files that are not there.
    pub(crate) missing: std::collections::BTreeSet<PathBuf>,
    pub(crate) list: PlanList,
    pub(crate) selection: Selection,
    /// What panels show of the plan and the selection.
    pub(crate) figures: kept::Figures,
    /// The step of the history that nudged what is selected, if that was the last thing done.
    pub(crate) nudged: Option<usize>,
    /// What is being drawn and is in no plan yet.
    pub(crate) draft: Option<Draft>,
    /// What was drawn last.
    pub(crate) fresh: Option<fresh::Fresh>,
    /// The copied part of a plan.
    pub(crate) copied: Option<Plan>,
    pub(crate) layers: LayerSettings,
    /// The storey drawn faintly under the plan.
    pub(crate) ghost: Option<ghost::Ghost>,
    /// Second opinions, what-if and labels while something is dragged.
    pub(crate) live: live::Live,
    /// The demonstration, while it runs.
    pub(crate) demo: Option<demo::Demo>,
    /// Which models predict.
    pub(crate) predictor: Predictor,
    /// The available models: bundled, and the user's own.
    pub(crate) models: Models,
    pub(crate) settings: Settings,
    pub(crate) messages: Vec<Message>,
    /// The last action, for the status line.
    pub(crate) status: String,
    pub(crate) question: Option<Question>,
    /// What to do once a question is answered, or a file saved.
    pub(crate) waiting: Option<Intent>,
    /// The journal to be recovered.
    pub(crate) recovering: Option<PathBuf>,
    pub(crate) safety: Safety,
    pub(crate) jobs: Jobs,
    pub(crate) dialogs: Dialogs,
    pub(crate) quitting: bool,
    /// The folder where scripts work: paths below it are shown relative to it.
    pub(crate) named_from: Option<PathBuf>,
    /// The number of documents shown so far.
    pub(crate) documents: u64,
    /// The commands that ran, if a recorder wants them.
    pub(crate) executed: Option<Vec<Executed>>,
    /// The name of a picture being loaded as a backdrop.
    pub(crate) reading_picture: Option<String>,
    /// Pictures that a person has named, and may be read wherever they lie.
    pub(crate) pictures_allowed: Vec<PathBuf>,
    /// What the pointer points at on the canvas.
    pub(crate) pointed: Pointed,
    /// The state of the backdrop.
    pub(crate) backdrop: BackdropView,
    /// A text being edited.
    pub(crate) field: Option<Field>,
    /// Recently set functions, latest first, in the form schemes compare.
    pub(crate) recent_functions: Vec<String>,
    /// Whether a recording is in progress.
    pub(crate) is_recording: bool,
    /// What the check finds in the plan.
    pub(crate) findings: findings::Findings,
    /// What a sheet of paper will look like.
    pub(crate) preview: exporting::SheetPreview,
    /// The file that a dialog was told to write to, for the dialog that asked.
    pub(crate) chosen_file: Option<PathBuf>,
    /// The open folder of plans.
    pub(crate) workspace: Option<workspace::OpenWorkspace>,
    /// Where what was found out about plans is kept; `None` to keep nothing.
    pub(crate) cache_folder: Option<PathBuf>,
    /// A room to select once the plan of this origin is shown.
    pub(crate) awaited_room: Option<(Origin, crate::plan::RoomId)>,
    /// The storey to show below once the plan of the first origin is shown.
    pub(crate) awaited_ghost: Option<(Origin, Origin)>,
    /// The dataset being made.
    pub(crate) dataset_job: Option<jobs::Wanted>,
    /// The labelled rooms at hand, for the dashboard and for training.
    pub(crate) at_hand: at_hand::RoomsAtHand,
    /// How well classifiers tell them.
    pub(crate) measures: measures::Measures,
    /// Models being trained, and those trained last.
    pub(crate) training: training::Training,
    /// The review of the open folder's labels.
    pub(crate) review: review::Review,
    /// The simulated robot, or the log being replayed.
    pub(crate) robot: robot::Robot,
    /// Requests to the rest of the window.
    pub(crate) wishes: Vec<Wish>,
}

/// What is under the pointer.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Pointed {
    pub element: Option<ElementId>,
    /// The position in the plan; `None` off the canvas.
    pub at: Option<Point>,
    /// A few pixels, in metres: a pointer that has moved no further has stayed.
    pub near_m: f64,
}

impl Session {
    /// A session without a plan.
    pub(crate) fn new(mode: Mode, dialogs: Dialogs) -> Self {
        Self {
            schemes: Arc::new(Schemes::bundled()),
            document: None,
            waiting_plans: Vec::new(),
            view: None,
            opening: None,
            browses: false,
            typed_for: None,
            missing: std::collections::BTreeSet::new(),
            list: PlanList::default(),
            selection: Selection::default(),
            figures: kept::Figures::default(),
            nudged: None,
            draft: None,
            fresh: None,
            copied: None,
            layers: LayerSettings::default(),
            ghost: None,
            live: live::Live::default(),
            demo: None,
            predictor: Predictor::default(),
            models: Models::bundled(),
            settings: Settings::default(),
            messages: Vec::new(),
            status: String::new(),
            question: None,
            waiting: None,
            recovering: None,
            safety: Safety::default(),
            jobs: Jobs::new(mode),
            dialogs,
            quitting: false,
            named_from: None,
            documents: 0,
            executed: None,
            reading_picture: None,
            pictures_allowed: Vec::new(),
            pointed: Pointed::default(),
            backdrop: BackdropView::default(),
            field: None,
            recent_functions: Vec::new(),
            is_recording: false,
            findings: findings::Findings::default(),
            preview: exporting::SheetPreview::default(),
            chosen_file: None,
            workspace: None,
            cache_folder: None,
            awaited_room: None,
            awaited_ghost: None,
            dataset_job: None,
            at_hand: at_hand::RoomsAtHand::default(),
            measures: measures::Measures::default(),
            training: training::Training::default(),
            review: review::Review::default(),
            robot: robot::Robot::default(),
            wishes: Vec::new(),
        }
    }

    /// The open plan.
    pub(crate) fn plan(&self) -> Option<&Plan> {
        self.document.as_ref().map(Document::plan)
    }

    /// The selection.
    pub(crate) fn selection(&self) -> &Selection {
        &self.selection
    }

    /// The selected element, if there is exactly one.
    pub(crate) fn picked(&self) -> Option<ElementId> {
        self.selection.one()
    }

    /// The messages above the canvas: dismissible ones, oldest first, then those that stay as long as
    /// they are true.
    pub(crate) fn messages(&self) -> Vec<Message> {
        let shown = self.shown_messages().into_iter().filter_map(|index| self.messages.get(index).cloned());
        let mut messages: Vec<Message> = shown.collect();
        messages.extend(self.bars());
        messages
    }

    /// Whether the plan has unsaved changes.
    pub(crate) fn has_unsaved_changes(&self) -> bool {
        self.document.as_ref().is_some_and(Document::is_changed)
    }

    /// A path for display.
    pub(crate) fn shown_path(&self, path: &Path) -> String {
        let folder = self.named_from.as_deref().unwrap_or(Path::new(""));
        path.strip_prefix(folder).unwrap_or(path).display().to_string()
    }

    pub(crate) fn say(&mut self, severity: Severity, text: impl Into<String>, detail: impl Into<String>) {
        self.add_message(Message::new(severity, text, detail));
    }

    /// The colours of the plan, in the window's theme.
    pub(crate) fn palette(&self, ui: &Ui) -> &'static Palette {
        let theme = if ui.visuals().dark_mode { draw::Theme::Dark } else { draw::Theme::Light };
        Palette::of(theme, self.layers.colours)
    }
}
