//! One frame of the window: events since the last one, updates the plan needs, and the panels.

use crate::app::canvas::Canvas;
use crate::app::commands;
use crate::app::commands::CommandError;
use crate::app::look::theme;
use crate::app::look::theme::ThemeChoice;
use crate::app::panels;
use crate::app::session::Pointed;
use crate::app::session::Session;
use crate::app::session::file_dialogs::Dialogs;
use crate::app::session::jobs::Mode;
use crate::app::session::memory::WindowPlace;
use crate::app::session::messages::Severity;
use crate::app::session::origin::Origin;
use crate::app::session::samples::Samples;
use crate::app::session::settings::Settings;
use crate::app::session::wishes::Wish;
use crate::app::state::App;
use crate::app::state::Arrivals;
use crate::app::state::Asked;
use crate::app::state::OpenDialogs;
use crate::app::state::Panels;
use crate::app::tools::Toolbox;
use crate::app::value::{Call, Value};
use crate::store::pictures;
use egui::{Context, Key, Modifiers, Popup, Ui, ViewportCommand};
impl App {
    pub(crate) fn new(context: &Context, mode: Mode, dialogs: Dialogs, motion: theme::Motion) -> Self {
        theme::install(context, motion);
        Self {
            session: Session { settings: Settings::new(commands::keyed()), ..Session::new(mode, dialogs) },
            canvas: Canvas::default(),
            tools: Toolbox::default(),
            theme: ThemeChoice::default(),
            panels: Panels::new(panels::SIDE_PANELS),
            dialogs: OpenDialogs::new(panels::DIALOGS),
            samples: Samples::default(),
            arrivals: Arrivals::default(),
            was_typing: false,
            is_close_sent: false,
            shown_title: String::new(),
            recorder: None,
            wants_recording: false,
        }
    }

    /// One frame.
    pub(crate) fn frame(&mut self, ui: &mut Ui) {
        let context = ui.ctx().clone();
        // What was done since the last frame; what it opened is still known.
        self.write_executed();
        self.session.take_outcomes(&context);
        self.grant_wishes(&context);
        self.session.show_awaited_room();
        self.session.show_awaited_ghost();
        self.session.take_waiting();
        if let Some(path) = self.session.recovering.take() {
            self.session.show_recovered(&path, &context);
        }
        self.grant_wishes(&context);
        self.session.watch_file(&context);
        self.take_dropped_files(&context);
        self.take_close_request(&context);
        panels::demo::take_input(self, &context);
        self.close_list_before_dialog(&context);
        self.take_menu_keys(&context);
        self.take_tool_keys(&context);
        self.take_shortcuts(&context);
        self.session.play_demo(&context);
        self.refresh();
        self.session.go_on_reviewing();
        self.session.check_findings(&context);
        self.session.compare_with_theirs();
        self.session.drop_stale_messages();
        self.session.drive_robot(&context);
        self.grant_wishes(&context);
        panels::show(self, ui);
        self.grant_wishes(&context);
        // Without a plan there is nothing to use a tool on: the next one begins with none in hand.
        if self.session.document.is_none() && !self.tools.is_selecting() {
            self.put_tool_away();
        }
        self.was_typing = context.text_edit_focused();
        self.session.view = self.canvas.free_view();
        self.session.draft = self.tools.draft();
        self.session.keep_journal(&context);
        self.update_title(&context);
        self.record(&context);
        if self.session.jobs.is_busy() {
            self.session.jobs.request_frame(&context);
        }
    }

    /// Escape closes a list that is open in a dialog, and leaves the dialog open.
    fn close_list_before_dialog(&self, context: &Context) {
        if self.dialogs.is_any_open()
            && Popup::is_any_open(context)
            && context.input_mut(|input| input.consume_key(Modifiers::NONE, Key::Escape))
        {
            Popup::close_all(context);
        }
    }

    pub(crate) fn take_shortcuts(&mut self, context: &Context) {
        // Escape has already taken the keyboard from the text field, but belongs to it all the same.
        let is_typing = std::mem::take(&mut self.was_typing) || context.text_edit_focused();
        // An open menu gets all keys; the list below a text field leaves them to the field.
        let is_menu_open = Popup::is_any_open(context) && !is_typing;
        if self.session.question.is_some() || self.dialogs.is_any_open() || is_menu_open {
            return;
        }
        let pressed = context.input_mut(|input| commands::take_pressed(input, &self.session.settings, is_typing));
        for command in pressed {
            match self.run_command_with(command.id, &[], context) {
                // Escape with nothing selected needs no message.
                Err(CommandError::NotNow { reason, .. }) if command.id != "clear-selection" => {
                    self.session.status = format!("{}: {reason}", command.plain_title());
                }
                Ok(()) | Err(_) => {}
            }
        }
    }

    /// Starts the updates the plan on screen needs: analysis, backdrop.
    pub(crate) fn refresh(&mut self) {
        self.session.derive();
        self.session.refresh_backdrop();
    }

    /// Does what the session asks for.
    pub(crate) fn grant_wishes(&mut self, context: &Context) {
        for wish in std::mem::take(&mut self.session.wishes) {
            match wish {
                Wish::ForgetPlan => {
                    self.tools.drop_work();
                    self.canvas.forget();
                    self.session.pointed = Pointed::default();
                    self.dialogs.forget_plan();
                    self.panels.focus = None;
                }
                Wish::ForgetDrawing => {
                    self.tools.drop_work();
                    self.canvas.forget();
                    self.session.pointed = Pointed::default();
                }
                Wish::Reveal(element) => self.canvas.reveal(element),
                Wish::LookAt { centre, px_per_m } => self.canvas.look_at(centre, px_per_m),
                Wish::TypePath { command, text } => self.ask_for_argument(Asked { text, ..Asked::of(command) }),
                Wish::ZoomTo(bounds) => self.canvas.zoom_to(bounds),
                Wish::Fit => self.canvas.fit(),
                Wish::ScaleView { about, factor } => self.canvas.scale_view(about, factor),
                Wish::OfferRecovery => self.set_dialog(panels::recovery::ID, true),
                Wish::CloseRecovery => self.set_dialog(panels::recovery::ID, false),
                Wish::CloseDifferences => self.set_dialog(panels::differences::ID, false),
                Wish::Run(call) => self.act_on(call, context),
                Wish::OpenListed(origin) => self.open_listed(&origin, context),
                Wish::Resume(draft) => {
                    self.session.draft = Some(draft.clone());
                    self.tools.resume(draft);
                }
                Wish::EndRecording(then) => self.stop_recording(Some(then)),
                Wish::Recording(news) => self.hear_of_recording(news),
            }
        }
    }

    pub(crate) fn take_dropped_files(&mut self, context: &Context) {
        let dropped = context.input_mut(|input| std::mem::take(&mut input.raw.dropped_files));
        let Some(first) = dropped.first() else { return };
        if dropped.len() > 1 && !pictures::is_picture_name(first.path()) {
            self.session.open_several(dropped.iter().map(|file| file.path().to_owned()).collect());
            return;
        }
        if dropped.len() > 1 {
            let text = format!("{} files were dropped; the first is now under the plan", dropped.len());
            self.session.say_of_program(Severity::Info, text, "A plan can have one picture.");
        }
        let id = if pictures::is_picture_name(first.path()) { "picture" } else { "open" };
        self.act_on(Call::new(id, [Value::Path(first.path().to_owned())]), context);
    }

    /// Opens the plan of a row in the list or of a card.
    pub(crate) fn open_listed(&mut self, origin: &Origin, context: &Context) {
        // To be looked at: from plan to plan, not all stay open.
        self.session.browses = true;
        let call = match origin {
            Origin::Bundled(index) => Call::new("open-sample", [Value::Sample(*index)]),
            Origin::Untitled => Call::new("new-plan", []),
            Origin::File { path, storey: 0 } => Call::new("open", [Value::Path(path.clone())]),
            Origin::File { path, storey } => Call::new("open", [Value::Path(path.clone()), Value::Count(storey + 1)]),
        };
        self.act_on(call, context);
        self.session.browses = false;
    }

    pub(crate) fn take_close_request(&mut self, context: &Context) {
        if context.input(|input| input.viewport().close_requested()) && !self.session.quitting {
            context.send_viewport_cmd(ViewportCommand::CancelClose);
            self.run_command("quit", context);
        }
        if self.session.quitting && !self.is_close_sent {
            self.is_close_sent = true;
            self.remember_window(context);
            context.send_viewport_cmd(ViewportCommand::Close);
        }
    }

    /// Remembers where the window is.
    fn remember_window(&mut self, context: &Context) {
        let place = context.input(|input| {
            let viewport = input.viewport();
            let is_maximized = viewport.maximized.unwrap_or_default() || viewport.fullscreen.unwrap_or_default();
            let at = viewport.outer_rect.map(|rect| [rect.min.x, rect.min.y]);
            viewport.inner_rect.map(|rect| WindowPlace { size: [rect.width(), rect.height()], at, is_maximized })
        });
        if let Some(place) = place.filter(|_| self.session.settings.is_kept()) {
            self.session.settings.set_window(place);
            self.session.keep_settings();
        }
    }

    pub(crate) fn update_title(&mut self, context: &Context) {
        let title = match &self.session.document {
            None => "Enfilade".to_owned(),
            Some(document) => {
                let mark = if document.is_changed() { "• " } else { "" };
                format!("{mark}{} – Enfilade", document.title())
            }
        };
        if title != self.shown_title {
            context.send_viewport_cmd(ViewportCommand::Title(title.clone()));
            self.shown_title = title;
        }
    }
}
