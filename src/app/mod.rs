//! The window: canvas, commands, panels, theme.
//!
//! [`App`] is the whole window apart from any display: it takes egui's input and gives shapes.
//! [`run_window`] shows it on a screen; [`Offscreen`] drives the same one without.

mod backdrop;
mod background;
mod bulk;
mod canvas;
pub mod commands;
mod controls;
mod dialogs;
mod dimensions;
mod document;
mod files;
mod ghost;
mod guides;
mod icons;
mod labelling;
mod offscreen;
mod panels;
mod pending;
mod plan_list;
mod raster;
mod recovery;
pub mod replay;
mod rulers;
mod scene_painter;
mod search;
mod selection;
mod settings;
mod theme;
mod tools;
mod widgets;
mod window;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use egui::{Context, Ui};

pub use commands::{CommandError, Executed};
pub use controls::Control;
pub use icons::Icon;
pub use offscreen::{NotSettled, Offscreen, OffscreenOptions};
pub use raster::Raster;
pub use selection::{SelectMode, Selection};
pub use theme::ThemeChoice;
pub use window::{WindowError, WindowOptions, run_window};

use backdrop::PictureChange;
use background::{Background, Mode};
use canvas::Canvas;
use dialogs::{Answer, Dialogs};
use document::{Derived, Document, Opened, Origin, SaveFailure};
use panels::welcome::Samples;
use panels::{Field, FieldKind, Panels};
use plan_list::PlanList;
use recovery::{Looked, Offered, Safety};
use replay::{Recorder, Recording};
use settings::Settings;
use tools::{DrawOptions, TakenBack, Toolbox};

use crate::classify::models::Models;
use crate::draw::{self, Fill, LabelColours, Palette};
use crate::edit::{self, EditError};
use crate::formats::FileError;
use crate::geometry::{Segment, Vector};
use crate::labels::{Label, Schemes};
use crate::plan::{ElementId, LabelOrigin, Meta, Plan, Room, RoomId, RoomLabel};
use crate::predict::{Predictions, Predictor};
use crate::store::pictures::{LoadedPicture, PictureError};
use crate::store::{self, SaveError, Stamp};

/// The window's state, apart from any display.
pub struct App {
    schemes: Arc<Schemes>,
    document: Option<Document>,
    /// What is being read to be opened.
    opening: Option<Origin>,
    list: PlanList,
    canvas: Canvas,
    selection: Selection,
    tools: Toolbox,
    draw_options: DrawOptions,
    /// What was copied: a part of a plan.
    copied: Option<Plan>,
    layers: LayerSettings,
    /// The storey drawn faintly under the plan.
    ghost: Option<ghost::Ghost>,
    /// A guide that is being dragged.
    guide_drag: Option<guides::Drag>,
    /// Which models predict.
    /// The models at hand.
    models: Models,
    predictor: Predictor,
    theme: ThemeChoice,
    settings: Settings,
    panels: Panels,
    samples: Samples,
    messages: Vec<Message>,
    /// What was just done, for the status line.
    status: String,
    question: Option<Question>,
    /// What a person wants once a question is answered, or a file saved.
    waiting: Option<Intent>,
    /// How many files are being saved.
    saving: usize,
    /// The journal that is to be opened.
    recovering: Option<PathBuf>,
    safety: Safety,
    background: Background<Done>,
    dialogs: Dialogs,
    /// Whether a text field had the keyboard when the last frame ended.
    was_typing: bool,
    quitting: bool,
    is_close_sent: bool,
    shown_title: String,
    /// Where scripts work: paths below are shown from here.
    named_from: Option<PathBuf>,
    /// How many documents have been shown.
    documents: u64,
    /// The commands that were done, where a recorder wants them.
    executed: Option<Vec<Executed>>,
    /// What is being recorded.
    recorder: Option<Recorder>,
    /// A recording is to begin.
    wants_recording: bool,
    /// The name of a picture that is being read to lie under the plan.
    reading_picture: Option<String>,
}

/// What is shown of a plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct LayerSettings {
    fill: Fill,
    colours: LabelColours,
    graph: bool,
    names: bool,
    backdrop: bool,
    grid: bool,
    guides: bool,
    /// Lengths and area of what is selected.
    dimensions: bool,
    /// The storey that lies below.
    ghost: bool,
    rulers: bool,
    /// Rooms, walls and openings that cannot be selected or moved with the pointer.
    locked: Locked,
}

/// What the pointer leaves alone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Locked {
    rooms: bool,
    walls: bool,
    openings: bool,
}

impl LayerSettings {
    fn is_locked(&self, element: ElementId) -> bool {
        match element {
            ElementId::Room(_) => self.locked.rooms,
            ElementId::Wall(_) => self.locked.walls,
            ElementId::Opening(_) => self.locked.openings,
            ElementId::Corner(_) => false,
        }
    }
}

impl Default for LayerSettings {
    fn default() -> Self {
        Self {
            fill: Fill::Label,
            colours: LabelColours::Standard,
            graph: false,
            names: true,
            backdrop: true,
            grid: true,
            guides: true,
            dimensions: true,
            ghost: true,
            rulers: false,
            locked: Locked::default(),
        }
    }
}

/// A message that stays until it is dismissed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Message {
    pub severity: Severity,
    /// What happened, in a sentence.
    pub text: String,
    /// Where, and what to do; may be empty.
    pub detail: String,
    /// What can be done about it.
    pub remedies: Vec<Remedy>,
    /// Whether it stays as long as what it says is so; else a person can dismiss it.
    pub stays: bool,
}

/// What a message offers to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Remedy {
    /// Show what an import mended or left out.
    ShowNotes,
    /// Show how the plan and its file differ.
    ShowDifferences,
    /// Make the plan what its file holds.
    LoadTheirs,
    /// Go on with the plan as it is here.
    KeepMine,
    /// Save the plan in its file.
    Save,
    /// Save it in another.
    SaveElsewhere,
    /// Say where the picture under the plan is.
    RelinkPicture,
    /// Take the picture that is shown as the one that the plan means.
    KeepPicture,
}

impl Remedy {
    const fn title(self) -> &'static str {
        match self {
            Self::ShowNotes => "Show notes",
            Self::ShowDifferences => "Show differences",
            Self::LoadTheirs => "Load the file",
            Self::KeepMine => "Keep mine",
            Self::Save => "Save",
            Self::SaveElsewhere => "Save in another place…",
            Self::RelinkPicture => "Relink…",
            Self::KeepPicture => "Keep this picture",
        }
    }
}

/// How bad a message is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    Info,
    Warning,
    Error,
}

/// What a person wants to do that would lose unsaved work.
#[derive(Debug)]
enum Intent {
    /// Show another plan, which was read meanwhile.
    Show(Box<Opened>),
    /// Show what a journal keeps.
    Recover(PathBuf),
    Close,
    Quit,
}

/// A question that must be answered before anything else.
#[derive(Debug)]
enum Question {
    /// The plan has unsaved changes: save, give up, or keep working?
    Unsaved(Intent),
    /// More would go than is selected: delete it all?
    Delete { selected: Vec<ElementId>, gone: BTreeSet<ElementId> },
    /// Something large would be changed, as shown: do it?
    Change(ProposedChange),
    /// Something else stands in the file to be saved: replace it?
    Replace { path: PathBuf, is_changed_since: bool, then: Option<Intent> },
    /// Give up what a program left behind?
    Discard { path: PathBuf, title: String },
    /// The picture is about to be scaled or turned: does the drawing go along?
    Drawing(PictureChange),
}

/// A change of the plan that is shown before it is made.
#[derive(Debug)]
struct ProposedChange {
    /// What is asked, in a sentence.
    title: String,
    /// What it would do.
    text: String,
    /// The answer that makes it, and 'cancel'.
    answers: &'static [(&'static str, &'static str)],
    /// What it is called in the history.
    step: &'static str,
    /// The plan as it would be.
    plan: Plan,
    /// Where it would do something; a point is a segment without length.
    marks: Vec<Segment>,
}

/// What a background job brought.
enum Done {
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
        use_: backdrop::PictureUse,
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

/// A plan with more elements is analysed off the frame's path; below, that takes a few milliseconds.
const LARGE_PLAN_ELEMENTS: usize = 2000;

impl App {
    fn new(context: &Context, mode: Mode, dialogs: Dialogs, motion: theme::Motion) -> Self {
        theme::install(context, motion);
        Self {
            schemes: Arc::new(Schemes::bundled()),
            document: None,
            opening: None,
            list: PlanList::default(),
            canvas: Canvas::default(),
            selection: Selection::default(),
            tools: Toolbox::default(),
            draw_options: DrawOptions::default(),
            copied: None,
            layers: LayerSettings::default(),
            ghost: None,
            guide_drag: None,
            models: Models::bundled(),
            predictor: Predictor::default(),
            theme: ThemeChoice::default(),
            settings: Settings::default(),
            panels: Panels::default(),
            samples: Samples::default(),
            messages: Vec::new(),
            status: String::new(),
            question: None,
            waiting: None,
            saving: 0,
            recovering: None,
            safety: Safety::default(),
            background: Background::new(mode),
            dialogs,
            was_typing: false,
            quitting: false,
            is_close_sent: false,
            shown_title: String::new(),
            named_from: None,
            documents: 0,
            executed: None,
            recorder: None,
            wants_recording: false,
            reading_picture: None,
        }
    }

    /// One frame.
    fn frame(&mut self, ui: &mut Ui) {
        let context = ui.ctx().clone();
        // What was done since the last frame; what it opens is still known.
        self.write_executed();
        self.take_outcomes(&context);
        self.take_waiting();
        if let Some(path) = self.recovering.take() {
            self.show_recovered(&path, &context);
        }
        self.watch_file(&context);
        self.take_dropped_files(&context);
        self.take_close_request(&context);
        self.take_tool_keys(&context);
        self.take_shortcuts(&context);
        self.refresh();
        self.compare_with_theirs();
        panels::show(self, ui);
        self.was_typing = context.text_edit_focused();
        self.keep_journal(&context);
        self.update_title(&context);
        self.record(&context);
        if self.background.is_busy() {
            self.background.request_frame(&context);
        }
    }

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
    fn shown_path(&self, path: &Path) -> String {
        let folder = self.named_from.as_deref().unwrap_or(Path::new(""));
        path.strip_prefix(folder).unwrap_or(path).display().to_string()
    }

    fn say(&mut self, severity: Severity, text: impl Into<String>, detail: impl Into<String>) {
        self.add_message(Message {
            severity,
            text: text.into(),
            detail: detail.into(),
            remedies: Vec::new(),
            stays: false,
        });
    }

    fn add_message(&mut self, message: Message) {
        // The same thing said again moves to the end.
        self.messages.retain(|other| *other != message);
        self.messages.push(message);
    }

    // What happens before the panels are shown.

    fn take_outcomes(&mut self, context: &Context) {
        for outcome in self.background.take() {
            match outcome {
                None => {
                    self.saving = 0;
                    self.say(
                        Severity::Error,
                        "Something broke inside Enfilade",
                        "Your plan is untouched. Please report what you did.",
                    );
                }
                Some(Done::Opened(origin, result)) => self.was_opened(&origin, *result),
                Some(Done::Derived(plan, derived)) => {
                    if let Some((document, derived)) = self.document.as_mut().zip(derived) {
                        document.set_derived(plan, derived);
                    }
                }
                Some(Done::Leftovers(offered)) => self.were_left_over(offered),
                Some(Done::Looked(looked)) => self.was_looked_at(looked),
                Some(Done::Listed(folder, files)) => self.list.set_folder(folder, files),
                Some(Done::Chosen(answer)) => {
                    self.dialogs.answered();
                    self.was_chosen(answer, context);
                }
                Some(Done::Saved { document, path, plan, result, then }) => {
                    self.was_saved(document, path, plan, result, then, context);
                }
                Some(Done::RecordingSaved { path, recording, result, then }) => {
                    self.recording_was_saved(&path, *recording, result, then);
                }
                Some(Done::Ghost(origin, result)) => self.ghost_was_read(&origin, *result),
                Some(Done::Backdrop(wanted, read)) => self.backdrop_was_read(wanted, &read),
                Some(Done::PictureRead { document, use_, path, page, result }) => {
                    self.picture_was_read(document, use_, &path, page, result);
                }
            }
        }
    }

    fn take_shortcuts(&mut self, context: &Context) {
        // Escape has taken the keyboard from the text by now, but belongs to it all the same.
        let is_typing = std::mem::take(&mut self.was_typing) || context.text_edit_focused();
        // An open menu has the keys to itself; the list under a text field leaves them to the text.
        let is_menu_open = egui::Popup::is_any_open(context) && !is_typing;
        if self.question.is_some() || self.panels.is_dialog_open() || is_menu_open {
            return;
        }
        let pressed = context.input_mut(|input| commands::take_pressed(input, &self.settings, is_typing));
        for command in pressed {
            match self.run_command_with(command.id, &[], context) {
                // Escape with nothing picked needs no word.
                Err(CommandError::NotNow { reason, .. }) if command.id != "clear-selection" => {
                    self.status = format!("{}: {reason}", command.plain_title());
                }
                Ok(()) | Err(_) => {}
            }
        }
    }

    /// Starts what the plan on screen still needs: its analysis, its backdrop.
    fn refresh(&mut self) {
        let Some(document) = &mut self.document else { return };
        document.predict_by(&self.predictor);
        let plan = document.plan().clone();
        self.selection.keep_what_is_in(&plan);
        if document.needs_deriving() {
            let schemes = self.schemes.clone();
            let predictor = Some((self.predictor.clone(), self.models.clone()));
            if plan.rooms().len() + plan.openings().len() + plan.walls().len() <= LARGE_PLAN_ELEMENTS {
                let derived = Arc::new(Derived::new(&plan, &schemes, predictor));
                document.set_derived(plan.clone(), derived);
            } else {
                let outdated = document.await_derived();
                let plan = plan.clone();
                self.background.start(move || {
                    let derived = Derived::unless_outdated(&plan, &schemes, predictor, &outdated).map(Arc::new);
                    Done::Derived(plan, derived)
                });
            }
        }
        self.refresh_backdrop();
    }

    // Picking.

    fn pick(&mut self, picked: Option<ElementId>) {
        self.commit_field();
        self.selection = Selection::of(picked);
    }

    fn select(&mut self, elements: impl IntoIterator<Item = ElementId>, mode: SelectMode) {
        self.commit_field();
        self.selection.select(elements, mode);
    }

    /// The picked room.
    fn picked_room(&self) -> Option<(RoomId, &Room)> {
        let Some(ElementId::Room(id)) = self.picked() else { return None };
        Some((id, self.plan()?.room(id)?))
    }

    /// Picks the room that comes `step` later as one reads: from the top left, line by line. From
    /// nothing picked, the first or the last. `false` when there is no further one.
    fn pick_neighbour(&mut self, step: isize) -> bool {
        let Some(derived) = self.document.as_ref().and_then(Document::derived) else { return false };
        let order = derived.reading_order();
        let at = match self.picked() {
            Some(ElementId::Room(id)) => order.iter().position(|&room| room == id),
            _ => None,
        };
        let next = match at {
            None if step > 0 => Some(0),
            None => order.len().checked_sub(1),
            Some(at) => at.checked_add_signed(step),
        };
        let Some(&id) = next.and_then(|next| order.get(next)) else { return false };
        self.pick(Some(ElementId::Room(id)));
        self.canvas.reveal(ElementId::Room(id));
        true
    }

    /// Picks the room nearest to the picked one in a direction of the plan; the first where none is.
    fn pick_towards(&mut self, direction: Vector) {
        let Some(derived) = self.document.as_ref().and_then(Document::derived) else { return };
        let Some(ElementId::Room(picked)) = self.picked() else {
            self.pick_neighbour(1);
            return;
        };
        let shapes = &derived.analysis.shapes;
        let Some(from) = shapes.get(picked).map(|shape| shape.bounds.center()) else { return };
        let nearest = shapes
            .all()
            .iter()
            .filter(|shape| shape.id != picked && !shape.bounds.is_empty())
            .filter_map(|shape| {
                let way = shape.bounds.center() - from;
                let (along, across) = (way.dot(direction), way.cross(direction).abs());
                // Within 60 degrees of the direction; what lies aside counts double.
                (along > 0.0 && across < along * 1.75).then_some((along + 2.0 * across, shape.id))
            })
            .min_by(|p, q| p.0.total_cmp(&q.0).then(p.1.cmp(&q.1)));
        if let Some((_, id)) = nearest {
            self.pick(Some(ElementId::Room(id)));
            self.canvas.reveal(ElementId::Room(id));
        }
    }

    fn zoom_to_picked(&mut self) {
        let Some((document, picked)) = self.document.as_ref().zip(self.picked()) else { return };
        if let Some(bounds) = document.bounds_of(picked) {
            self.canvas.zoom_to(bounds);
        }
    }

    // Editing. Every change goes through here and is a step of the history.

    fn edit(&mut self, title: &str, change: impl FnOnce(&Plan) -> Result<Plan, EditError>) {
        if let Err(error) = self.try_edit(title, change) {
            self.say(Severity::Warning, format!("Nothing was changed: {error}"), "");
        }
    }

    /// As [`App::edit`], but leaves it to the caller to say why nothing was changed.
    fn try_edit(
        &mut self,
        title: &str,
        change: impl FnOnce(&Plan) -> Result<Plan, EditError>,
    ) -> Result<(), EditError> {
        let Some(document) = &mut self.document else { return Ok(()) };
        let plan = change(document.plan())?;
        document.history.push(title, plan);
        Ok(())
    }

    /// Takes the user's own label schemes and models from their folders; says what cannot be used.
    fn use_own_schemes_and_models(&mut self) {
        if let Some(folder) = store::schemes_folder() {
            let (schemes, errors) = store::schemes_in(&folder);
            self.schemes = Arc::new(schemes);
            for error in errors {
                self.say(Severity::Warning, "A label scheme cannot be used.", error.to_string());
            }
        }
        if let Some(folder) = store::models_folder() {
            let (own, errors) = store::models_in(&folder);
            self.models = Models::bundled().with(own);
            for error in errors {
                self.say(Severity::Warning, "A model cannot be used.", error.to_string());
            }
        }
    }

    // Predicting.

    /// What is said of the rooms of the plan as it is now; `None` while that is being worked out.
    pub fn predictions(&self) -> Option<&Predictions> {
        self.document.as_ref()?.derived()?.predictions.as_ref()
    }

    /// The selected rooms that are predicted, with what is said of them.
    fn predictions_of_selected(&self) -> Vec<(RoomId, Label)> {
        let Some(predictions) = self.predictions() else { return Vec::new() };
        self.selection.rooms().filter_map(|id| Some((id, predictions.label(id)?))).collect()
    }

    /// Labels the selected rooms as predicted, in one step.
    fn accept_prediction(&mut self) {
        let said = self.predictions_of_selected();
        match said.as_slice() {
            [] => {}
            [(_, label)] => self.accept(&format!("Accept {label}"), &said),
            several => self.accept(&format!("Accept {} predictions", several.len()), &said),
        }
    }

    fn accept(&mut self, title: &str, said: &[(RoomId, Label)]) {
        self.edit(title, |plan| {
            said.iter().try_fold(plan.clone(), |plan, &(id, label)| {
                let given = RoomLabel { label, origin: LabelOrigin::AcceptedPrediction };
                edit::set_label(&plan, id, Some(given))
            })
        });
    }

    /// Labels all rooms that have no label as predicted.
    fn accept_all_predictions(&mut self) {
        let Some(predictions) = self.predictions() else { return };
        let unlabelled = predictions.network.rooms.iter().filter(|room| room.label.is_none());
        let said: Vec<(RoomId, Label)> =
            unlabelled.filter_map(|room| Some((room.id, predictions.label(room.id)?))).collect();
        let title = format!("Accept {} predictions", said.len());
        self.accept(&title, &said);
        self.status = title;
    }

    /// Makes what stands in a text field part of the plan.
    fn commit_field(&mut self) {
        if let Some(field) = self.panels.take_field() {
            self.edit(field.title(), |plan| field.apply(plan));
            // The field's room is the picked one: picking another ends the typing first.
            let (id, text) = field.as_command();
            if id == "set-function" {
                self.remember_function(&text);
            }
            self.note_executed(id, vec![text]);
        }
    }

    /// Writes a text of the picked room.
    fn write_field(&mut self, kind: FieldKind, text: &str) {
        let Some((room, _)) = self.picked_room() else { return };
        let field = Field::new(room, kind, text);
        self.edit(field.title(), |plan| field.apply(plan));
    }

    /// Gives the keyboard to the inspector's field for a text of the picked room.
    fn ask_for_field(&mut self, kind: FieldKind) {
        self.panels.right = true;
        self.panels.focus = Some(kind);
    }

    /// Changes what is known of the plan as a whole.
    fn change_meta(&mut self, title: &str, change: impl FnOnce(&mut Meta)) {
        self.edit(title, |plan| {
            let mut meta = plan.meta().clone();
            change(&mut meta);
            Ok(edit::set_meta(plan, meta))
        });
    }

    /// Takes the last change back, or the last corner of what is being drawn. Gives whether the plan's
    /// last step was undone.
    fn undo(&mut self) -> bool {
        if self.tools.take_back() == TakenBack::Corner {
            return false;
        }
        if let Some(title) = self.document.as_mut().and_then(|document| document.history.undo()) {
            self.status = format!("Undone: {title}");
        }
        true
    }

    fn redo(&mut self) {
        if let Some(title) = self.document.as_mut().and_then(|document| document.history.redo()) {
            self.status = format!("Redone: {title}");
        }
    }

    /// Goes to a step of the history, counted from 0; gives why not where there is none.
    fn jump_to_step(&mut self, step: usize) -> Result<(), String> {
        let Some(document) = &mut self.document else { return Ok(()) };
        let number = document.history.steps().len();
        let Some(title) = document.history.steps().get(step).map(|step| step.title.clone()) else {
            return Err(format!("the history has {}", crate::base::wording::count(number, "step")));
        };
        document.history.jump_to(step);
        self.status = format!("Step {} of {number}: {title}", step + 1);
        Ok(())
    }

    /// The colours of the plan, in the window's theme.
    fn palette(&self, ui: &Ui) -> &'static Palette {
        let theme = if ui.visuals().dark_mode { draw::Theme::Dark } else { draw::Theme::Light };
        Palette::of(theme, self.layers.colours)
    }

    fn set_theme(&mut self, theme: ThemeChoice, context: &Context) {
        self.theme = theme;
        theme.apply(context);
    }
}
