//! One frame of the window: what happened since the last, what the plan still needs, and the panels.

use crate::app::canvas::Canvas;
use crate::app::commands;
use crate::app::commands::CommandError;
use crate::app::look::theme;
use crate::app::look::theme::ThemeChoice;
use crate::app::panels;
use crate::app::panels::Panels;
use crate::app::panels::welcome::Samples;
use crate::app::session::document::Derived;
use crate::app::session::file_dialogs::Dialogs;
use crate::app::session::jobs::Background;
use crate::app::session::jobs::Mode;
use crate::app::session::layers::LayerSettings;
use crate::app::session::messages::Severity;
use crate::app::session::plan_list::PlanList;
use crate::app::session::recovery::Safety;
use crate::app::session::selection::Selection;
use crate::app::session::settings::Settings;
use crate::app::state::App;
use crate::app::state::Done;
use crate::app::tools::DrawOptions;
use crate::app::tools::Toolbox;
use crate::labels::Schemes;
use crate::classify::models::Models;
use crate::predict::Predictor;
use egui::Context;
use egui::Ui;
use std::sync::Arc;
/// A plan with more elements is analysed off the frame's path; below, that takes a few milliseconds.
const LARGE_PLAN_ELEMENTS: usize = 2000;

impl App {
    pub(crate) fn new(context: &Context, mode: Mode, dialogs: Dialogs, motion: theme::Motion) -> Self {
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
    pub(crate) fn frame(&mut self, ui: &mut Ui) {
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

    pub(crate) fn take_outcomes(&mut self, context: &Context) {
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

    pub(crate) fn take_shortcuts(&mut self, context: &Context) {
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
    pub(crate) fn refresh(&mut self) {
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
}
