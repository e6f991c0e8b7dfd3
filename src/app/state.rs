//! The window's state, apart from any display.

use crate::app::canvas::Canvas;
use crate::app::canvas::guides;
use crate::app::commands::Executed;
use crate::app::look::theme::ThemeChoice;
use crate::app::paint::backdrop;
use crate::app::panels::Panels;
use crate::app::panels::welcome::Samples;
use crate::app::replay::Recorder;
use crate::app::replay::Recording;
use crate::app::session::document::Derived;
use crate::app::session::document::Document;
use crate::app::session::document::Opened;
use crate::app::session::document::SaveFailure;
use crate::app::session::file_dialogs::Answer;
use crate::app::session::file_dialogs::Dialogs;
use crate::app::session::ghost;
use crate::app::session::jobs::Background;
use crate::app::session::layers::LayerSettings;
use crate::app::session::messages::Message;
use crate::app::session::messages::Severity;
use crate::app::session::origin::Origin;
use crate::app::session::plan_list::PlanList;
use crate::app::session::questions::Intent;
use crate::app::session::questions::Question;
use crate::app::session::recovery::Looked;
use crate::app::session::recovery::Offered;
use crate::app::session::recovery::Safety;
use crate::app::session::selection::Selection;
use crate::app::session::settings::Settings;
use crate::app::session::tracing::PictureUse;
use crate::app::tools::DrawOptions;
use crate::app::tools::Toolbox;
use crate::classify::models::Models;
use crate::draw;
use crate::draw::Palette;
use crate::formats::FileError;
use crate::labels::Schemes;
use crate::plan::ElementId;
use crate::plan::Plan;
use crate::predict::Predictor;
use crate::store::SaveError;
use crate::store::Stamp;
use crate::store::pictures::LoadedPicture;
use crate::store::pictures::PictureError;
use egui::Context;
use egui::Ui;
use std::path::Path;
use std::path::PathBuf;
use std::sync::Arc;
/// The window's state, apart from any display.
pub struct App {
    pub(crate) schemes: Arc<Schemes>,
    pub(crate) document: Option<Document>,
    /// What is being read to be opened.
    pub(crate) opening: Option<Origin>,
    pub(crate) list: PlanList,
    pub(crate) canvas: Canvas,
    pub(crate) selection: Selection,
    pub(crate) tools: Toolbox,
    pub(crate) draw_options: DrawOptions,
    /// What was copied: a part of a plan.
    pub(crate) copied: Option<Plan>,
    pub(crate) layers: LayerSettings,
    /// The storey drawn faintly under the plan.
    pub(crate) ghost: Option<ghost::Ghost>,
    /// A guide that is being dragged.
    pub(crate) guide_drag: Option<guides::Drag>,
    /// The models at hand.
    pub(crate) models: Models,
    /// Which of them predict.
    pub(crate) predictor: Predictor,
    pub(crate) theme: ThemeChoice,
    pub(crate) settings: Settings,
    pub(crate) panels: Panels,
    pub(crate) samples: Samples,
    pub(crate) messages: Vec<Message>,
    /// What was just done, for the status line.
    pub(crate) status: String,
    pub(crate) question: Option<Question>,
    /// What a person wants once a question is answered, or a file saved.
    pub(crate) waiting: Option<Intent>,
    /// How many files are being saved.
    pub(crate) saving: usize,
    /// The journal that is to be opened.
    pub(crate) recovering: Option<PathBuf>,
    pub(crate) safety: Safety,
    pub(crate) background: Background<Done>,
    pub(crate) dialogs: Dialogs,
    /// Whether a text field had the keyboard when the last frame ended.
    pub(crate) was_typing: bool,
    pub(crate) quitting: bool,
    pub(crate) is_close_sent: bool,
    pub(crate) shown_title: String,
    /// Where scripts work: paths below are shown from here.
    pub(crate) named_from: Option<PathBuf>,
    /// How many documents have been shown.
    pub(crate) documents: u64,
    /// The commands that were done, where a recorder wants them.
    pub(crate) executed: Option<Vec<Executed>>,
    /// What is being recorded.
    pub(crate) recorder: Option<Recorder>,
    /// A recording is to begin.
    pub(crate) wants_recording: bool,
    /// The name of a picture that is being read to lie under the plan.
    pub(crate) reading_picture: Option<String>,
}

/// What a background job brought.
pub(crate) enum Done {
    Opened(Origin, Box<Result<Opened, FileError>>),
    /// `None` where it was given up for a later plan's.
    Derived(Plan, Option<Arc<Derived>>),
    Listed(PathBuf, Vec<PathBuf>),
    Chosen(Answer),
    Saved {
        document: u64,
        path: PathBuf,
        plan: Plan,
        result: Result<Option<Stamp>, SaveFailure>,
        then: Option<Intent>,
    },
    Backdrop(backdrop::Wanted, backdrop::Read),
    PictureRead {
        document: u64,
        use_: PictureUse,
        path: PathBuf,
        page: u32,
        result: Result<Box<LoadedPicture>, PictureError>,
    },
    RecordingSaved {
        path: PathBuf,
        recording: Box<Recording>,
        result: Result<(), SaveError>,
        then: Option<Intent>,
    },
    Leftovers(Vec<Offered>),
    Looked(Looked),
    Ghost(Origin, Box<Result<ghost::Ghost, FileError>>),
}

impl App {
    /// The open plan.
    pub fn plan(&self) -> Option<&Plan> {
        self.document.as_ref().map(Document::plan)
    }

    /// What is selected.
    pub fn selection(&self) -> &Selection {
        &self.selection
    }

    /// The element that is selected, where it is exactly one.
    pub fn picked(&self) -> Option<ElementId> {
        self.selection.one()
    }

    /// What stands above the canvas: messages, the oldest first, then what stays as long as it is so.
    pub fn messages(&self) -> Vec<Message> {
        let mut messages = self.messages.clone();
        messages.extend(self.bars());
        messages
    }

    /// Whether the plan has changes that are in no file.
    pub fn has_unsaved_changes(&self) -> bool {
        self.document.as_ref().is_some_and(Document::is_changed)
    }

    /// Where a point of the plan (in metres) is on the screen, in egui's points; `None` before the
    /// first frame and without a plan.
    pub fn screen_position(&self, x_m: f64, y_m: f64) -> Option<egui::Pos2> {
        self.canvas.screen_position(crate::geometry::Point::new(x_m, y_m))
    }

    /// A path as it is shown.
    pub(crate) fn shown_path(&self, path: &Path) -> String {
        let folder = self.named_from.as_deref().unwrap_or(Path::new(""));
        path.strip_prefix(folder).unwrap_or(path).display().to_string()
    }

    pub(crate) fn say(&mut self, severity: Severity, text: impl Into<String>, detail: impl Into<String>) {
        self.add_message(Message {
            severity,
            text: text.into(),
            detail: detail.into(),
            remedies: Vec::new(),
            stays: false,
        });
    }

    pub(crate) fn add_message(&mut self, message: Message) {
        // The same thing said again moves to the end.
        self.messages.retain(|other| *other != message);
        self.messages.push(message);
    }

    /// The colours of the plan, in the window's theme.
    pub(crate) fn palette(&self, ui: &Ui) -> &'static Palette {
        let theme = if ui.visuals().dark_mode { draw::Theme::Dark } else { draw::Theme::Light };
        Palette::of(theme, self.layers.colours)
    }

    pub(crate) fn set_theme(&mut self, theme: ThemeChoice, context: &Context) {
        self.theme = theme;
        theme.apply(context);
    }
}
