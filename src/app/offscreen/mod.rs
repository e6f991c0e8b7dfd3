//! The same window without a display: input is fed by hand, the clock stands still between frames,
//! and a picture is painted on the CPU.

pub(crate) mod controls;
pub(crate) mod raster;

use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use egui::accesskit;
use egui::os::OperatingSystem;
use egui::{
    Context, Event, FullOutput, Key, LayerId, Modifiers, MouseWheelSource, MouseWheelUnit, Order, PointerButton, Pos2,
    RawInput, Rect, TouchPhase, Vec2, ViewportCommand, ViewportId, vec2,
};

use crate::app::commands::{CommandError, Executed};
use crate::app::look::theme::Motion;
use crate::app::offscreen::raster::Raster;
use crate::app::session::file_dialogs::{Dialogs, Given};
use crate::app::session::jobs::{Jobs, Mode};
use crate::app::session::origin::{Origin, bundled};
use crate::app::state::App;
use crate::picture::Picture;
use controls::Control;

/// Two clicks are a double click only when they follow within 0.3 seconds.
const CLICK_GAP_SECS: f64 = 0.5;

/// Seconds from frame to frame.
const FRAME_SECS: f64 = 1.0 / 60.0;

/// A window that has not come to rest after so many frames never will.
const MOST_FRAMES: usize = 600;

/// What the window is like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OffscreenOptions {
    /// Size in logical pixels.
    pub width: u32,
    pub height: u32,
    /// Physical pixels per logical one.
    pub scale: f32,
    /// What the system asks for.
    pub is_dark: bool,
}

impl Default for OffscreenOptions {
    fn default() -> Self {
        Self { width: 1280, height: 800, scale: 1.0, is_dark: false }
    }
}

/// The window asked for frame after frame and never came to rest.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NotSettled;

impl fmt::Display for NotSettled {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the window did not come to rest within {MOST_FRAMES} frames")
    }
}

impl std::error::Error for NotSettled {}

/// The window without a display.
pub struct Offscreen {
    app: App,
    context: Context,
    raster: Raster,
    options: OffscreenOptions,
    time_secs: f64,
    pointer: Pos2,
    modifiers: Modifiers,
    hovered_files: Vec<egui::HoveredFile>,
    /// What can be pasted: the system's clipboard.
    clipboard: String,
    /// What the last frame gave.
    output: Option<FullOutput>,
    tree: Option<accesskit::TreeUpdate>,
    is_closing: bool,
    is_closed: bool,
}

impl Offscreen {
    /// A window with no plan.
    pub fn new(options: OffscreenOptions) -> Self {
        let context = Context::default();
        context.set_os(OperatingSystem::Nix);
        context.enable_accesskit();
        let app = App::new(&context, Mode::Inline, Dialogs::Given(Given::default()), Motion::Still);
        Self {
            app,
            context,
            raster: Raster::default(),
            options,
            time_secs: 0.0,
            pointer: Pos2::ZERO,
            modifiers: Modifiers::NONE,
            hovered_files: Vec::new(),
            clipboard: String::new(),
            output: None,
            tree: None,
            is_closing: false,
            is_closed: false,
        }
    }

    /// Runs as where no screen reader listens: what only it would hear is not worked out.
    pub fn without_screen_reader(self) -> Self {
        self.context.disable_accesskit();
        self
    }

    /// Works beside the frames on threads, as the window on a screen does: what is seen when then depends
    /// on how fast the machine is.
    pub fn working_beside(mut self) -> Self {
        self.app.session.jobs = Jobs::new(Mode::Threads(self.context.clone()));
        self
    }

    /// Runs a job of the work beside the frames in each of them, as where there are no threads.
    pub fn working_in_slices(mut self) -> Self {
        self.app.session.jobs = Jobs::new(Mode::Sliced);
        self
    }

    /// Holds back all work beside the frames until [`Self::end_job`] or [`Self::break_job`] is called.
    pub fn holding_jobs(mut self) -> Self {
        self.app.session.jobs = Jobs::new(Mode::Held);
        self
    }

    /// What the jobs do that are held back, the one that was started first in front.
    pub fn held_jobs(&self) -> Vec<&'static str> {
        self.app.session.jobs.held()
    }

    /// What the jobs do that somebody waits for, and how far each is: parts done, of how many, where it tells.
    pub fn jobs(&self) -> Vec<(&'static str, Option<(usize, usize)>)> {
        self.app.session.jobs.progress()
    }

    /// Runs the first job that does this and is held back; a frame takes its outcome. Gives whether there is one.
    pub fn end_job(&mut self, name: &str) -> bool {
        self.run_held(name, false)
    }

    /// As [`Self::end_job`], but the job breaks, as by a bug.
    pub fn break_job(&mut self, name: &str) -> bool {
        self.run_held(name, true)
    }

    /// As [`Self::end_job`], by its place in [`Self::held_jobs`].
    pub fn end_job_at(&mut self, index: usize) -> bool {
        self.run_held_at(index, false)
    }

    fn run_held(&mut self, name: &str, breaks: bool) -> bool {
        let index = self.held_jobs().iter().position(|held| *held == name);
        index.is_some_and(|index| self.run_held_at(index, breaks))
    }

    fn run_held_at(&mut self, index: usize, breaks: bool) -> bool {
        let is_there = self.app.session.jobs.run_held(index, breaks);
        self.frame(Vec::new(), Vec::new(), false);
        is_there
    }

    /// Whether something is being worked out beside the frames.
    pub fn is_working(&self) -> bool {
        self.app.session.jobs.is_busy()
    }

    /// The window's state.
    pub fn app(&self) -> &App {
        &self.app
    }

    /// Opens the file at a path, as from the command line.
    pub fn open(&mut self, path: &Path) {
        self.app.session.open(Origin::File { path: path.to_owned(), storey: 0 });
    }

    /// Opens a plan that comes with the program, by its file's name without the ending.
    /// Gives whether there is such a plan.
    pub fn open_bundled(&mut self, stem: &str) -> bool {
        let index = bundled().iter().position(|(name, _)| crate::formats::file_stem(name) == stem);
        if let Some(index) = index {
            self.app.session.open(Origin::Bundled(index));
        }
        index.is_some()
    }

    /// Runs a command by its id. Gives whether there is such a command and it could be done.
    pub fn run_command(&mut self, id: &str) -> bool {
        self.app.run_command(id, &self.context)
    }

    /// Runs a command by its id, with arguments; as [`App::run_command_with`].
    ///
    /// # Errors
    /// When there is no such command, when it cannot be done now, when an argument is wrong.
    pub fn run_command_with(&mut self, id: &str, arguments: &[&str]) -> Result<(), CommandError> {
        self.app.run_command_with(id, arguments, &self.context)
    }

    /// Keeps settings in a file from now on, and takes over what it holds. Without, none are read or
    /// kept.
    pub fn use_settings(&mut self, file: &Path) {
        self.app.use_settings(file.to_owned());
    }

    /// Keeps journals in a folder from now on, and offers what is left there. Without, none are kept.
    pub fn use_journal(&mut self, folder: &Path) {
        self.app.use_journal(folder.to_owned());
    }

    /// Starts or stops keeping the commands that are done; as [`App::watch_commands`].
    pub fn watch_commands(&mut self, is_watched: bool) {
        self.app.watch_commands(is_watched);
    }

    /// The commands done since the last call; as [`App::take_executed`].
    pub fn take_executed(&mut self) -> Vec<Executed> {
        self.app.take_executed()
    }

    /// The answer to the next dialog that asks for a file; `None` cancels it. A dialog without an
    /// answer is cancelled.
    pub fn answer_dialog(&mut self, path: Option<PathBuf>) {
        if let Some(given) = self.given() {
            given.answers.push_back(path);
        }
    }

    /// How many answers no dialog has asked for yet.
    pub fn answers_left(&mut self) -> usize {
        self.given().map_or(0, |given| given.answers.len())
    }

    /// Forgets the answers that no dialog has asked for.
    pub fn forget_answers(&mut self) {
        if let Some(given) = self.given() {
            given.answers.clear();
        }
    }

    /// How many dialogs had no answer since this was last asked.
    pub fn take_unanswered(&mut self) -> usize {
        self.given().map_or(0, |given| std::mem::take(&mut given.unanswered))
    }

    fn given(&mut self) -> Option<&mut Given> {
        match &mut self.app.session.dialogs {
            Dialogs::Given(given) => Some(given),
            Dialogs::System { .. } => None,
        }
    }

    /// Names paths below a folder by what comes behind it, so that what is seen does not depend on
    /// where the folder is.
    pub fn name_paths_from(&mut self, folder: &Path) {
        self.app.session.named_from = Some(folder.to_owned());
    }

    /// Whether the window has closed.
    pub fn is_closed(&self) -> bool {
        self.is_closed
    }

    /// What was copied last, or put there to be pasted.
    pub fn clipboard(&self) -> &str {
        &self.clipboard
    }

    /// Puts a text where Ctrl+V takes it from.
    pub fn set_clipboard(&mut self, text: &str) {
        text.clone_into(&mut self.clipboard);
    }

    /// What the window is like now.
    pub fn options(&self) -> OffscreenOptions {
        self.options
    }

    /// Makes it another size, scale or theme of the system.
    pub fn set_options(&mut self, options: OffscreenOptions) {
        self.options = options;
        self.frame(Vec::new(), Vec::new(), false);
    }

    // Input. Each is a frame of its own, as at most one thing happens in a sixtieth of a second.

    /// Feeds an event of egui's.
    pub fn event(&mut self, event: Event) {
        self.frame(vec![event], Vec::new(), false);
    }

    /// Where the pointer is.
    pub fn pointer(&self) -> Pos2 {
        self.pointer
    }

    /// Holds modifier keys down, in place of those held before.
    pub fn hold_modifiers(&mut self, modifiers: Modifiers) {
        if self.modifiers != modifiers {
            self.modifiers = modifiers;
            self.event(Event::ModifiersChanged(modifiers));
        }
    }

    /// The modifier keys held down.
    pub fn modifiers(&self) -> Modifiers {
        self.modifiers
    }

    /// Moves the pointer.
    pub fn move_to(&mut self, at: Pos2) {
        self.pointer = at;
        self.event(Event::PointerMoved(at));
    }

    /// Presses or lets go of a button of the pointer.
    pub fn button(&mut self, button: PointerButton, pressed: bool) {
        self.event(Event::PointerButton { pos: self.pointer, button, pressed, modifiers: self.modifiers });
    }

    /// Clicks at a place.
    pub fn click(&mut self, at: Pos2) {
        self.clicks(PointerButton::Primary, at, 1);
    }

    /// Clicks at a place so often in quick succession.
    pub fn clicks(&mut self, button: PointerButton, at: Pos2, count: usize) {
        self.move_to(at);
        for _ in 0..count {
            self.button(button, true);
            self.button(button, false);
        }
        // What is clicked next is no double click.
        self.advance(CLICK_GAP_SECS);
    }

    /// Drags from a place to another.
    pub fn drag(&mut self, button: PointerButton, from: Pos2, to: Pos2) {
        self.drag_along(button, &[from, from + (to - from) / 2.0, to]);
    }

    /// Drags from the first of some places by way of the others to the last.
    pub fn drag_along(&mut self, button: PointerButton, places: &[Pos2]) {
        for (index, &place) in places.iter().enumerate() {
            self.move_to(place);
            if index == 0 {
                self.button(button, true);
            }
        }
        self.button(button, false);
    }

    /// Turns the wheel by lines, away from the person when positive.
    pub fn wheel(&mut self, lines: f32) {
        self.scroll(MouseWheelUnit::Line, vec2(0.0, lines));
    }

    /// Scrolls with two fingers on a touch pad, in logical pixels.
    pub fn swipe(&mut self, by: Vec2) {
        self.scroll(MouseWheelUnit::Point, by);
    }

    fn scroll(&mut self, unit: MouseWheelUnit, delta: Vec2) {
        let modifiers = self.modifiers;
        let source = MouseWheelSource::Unknown;
        self.event(Event::MouseWheel { unit, delta, phase: TouchPhase::Move, source, modifiers });
    }

    /// Presses a key and lets it go, with modifiers beside those that are held down. Ctrl with C, X and
    /// V are copy, cut and paste, as window systems have it.
    pub fn key(&mut self, modifiers: Modifiers, key: Key) {
        let held = self.modifiers;
        let modifiers = held.plus(modifiers);
        self.hold_modifiers(modifiers);
        let clipboard_event = match key {
            _ if !modifiers.matches_exact(Modifiers::COMMAND) => None,
            Key::C => Some(Event::Copy),
            Key::X => Some(Event::Cut),
            Key::V => Some(Event::Paste(self.clipboard.clone())),
            _ => None,
        };
        match clipboard_event {
            Some(event) => self.event(event),
            None => {
                for pressed in [true, false] {
                    self.event(Event::Key { key, physical_key: None, pressed, repeat: false, modifiers });
                }
            }
        }
        self.hold_modifiers(held);
    }

    /// Holds a key down or lets it go.
    pub fn hold(&mut self, key: Key, pressed: bool) {
        let modifiers = self.modifiers;
        self.event(Event::Key { key, physical_key: None, pressed, repeat: false, modifiers });
    }

    /// Types a text.
    pub fn text(&mut self, text: &str) {
        self.event(Event::Text(text.to_owned()));
    }

    /// Holds a file over the window, or takes it away.
    pub fn hover_file(&mut self, path: Option<&Path>) {
        let hovered = path.map(|path| egui::HoveredFile { path: Some(path.to_owned()), ..Default::default() });
        self.hovered_files = hovered.into_iter().collect();
        self.frame(Vec::new(), Vec::new(), false);
    }

    /// Drops a file on the window.
    pub fn drop_file(&mut self, path: &Path) {
        self.hovered_files.clear();
        self.frame(Vec::new(), vec![Arc::new(Dropped(path.to_owned()))], false);
    }

    /// Asks the window to close, as its title bar's button does.
    pub fn ask_to_close(&mut self) {
        self.frame(Vec::new(), Vec::new(), true);
    }

    /// Changes the size of the window, in logical pixels.
    pub fn resize(&mut self, width: u32, height: u32) {
        self.set_options(OffscreenOptions { width, height, ..self.options });
    }

    /// Turns what the last frame painted into triangles, as a display has it done. Gives how many
    /// corners they have.
    pub fn tessellate(&self) -> usize {
        let Some(output) = &self.output else { return 0 };
        let primitives = self.context.tessellate(output.shapes.clone(), output.pixels_per_point);
        let corners = primitives.iter().map(|primitive| match &primitive.primitive {
            egui::epaint::Primitive::Mesh(mesh) => mesh.vertices.len(),
            egui::epaint::Primitive::Callback(_) => 0,
        });
        corners.sum()
    }

    // Time.

    /// Lets time pass, in seconds: a frame whenever the window asks for one, and one at the end. One
    /// that asks without end gets no more than [`NotSettled`] says, and then the last.
    pub fn advance(&mut self, secs: f64) {
        let end_secs = self.time_secs + secs.max(0.0);
        for _ in 0..MOST_FRAMES {
            self.frame(Vec::new(), Vec::new(), false);
            if self.is_closed || self.time_secs >= end_secs {
                return;
            }
            // Nothing happens until the window wants to be shown again.
            let idle_secs = self.repaint_delay_secs() - FRAME_SECS;
            self.time_secs = (self.time_secs + idle_secs.max(0.0)).min(end_secs);
        }
        self.time_secs = end_secs;
        self.frame(Vec::new(), Vec::new(), false);
    }

    /// Runs frames until the window asks for no further one soon.
    ///
    /// # Errors
    /// When it goes on asking for ten seconds.
    pub fn settle(&mut self) -> Result<(), NotSettled> {
        for _ in 0..MOST_FRAMES {
            self.frame(Vec::new(), Vec::new(), false);
            if self.is_closed || (!self.is_closing && self.repaint_delay_secs() > FRAME_SECS) {
                return Ok(());
            }
        }
        Err(NotSettled)
    }

    /// Seconds until the window wants to be shown again.
    fn repaint_delay_secs(&self) -> f64 {
        let viewport = self.output.as_ref().and_then(|output| output.viewport_output.get(&ViewportId::ROOT));
        viewport.map_or(f64::INFINITY, |viewport| viewport.repaint_delay.as_secs_f64())
    }

    fn frame(&mut self, events: Vec<Event>, dropped_files: Vec<egui::DroppedFileHandle>, close: bool) {
        if self.is_closed {
            return;
        }
        let close = close || self.is_closing;
        let size = vec2(self.options.width as f32, self.options.height as f32);
        let mut input = RawInput {
            screen_rect: Some(Rect::from_min_size(Pos2::ZERO, size)),
            max_texture_side: Some(16_384),
            time: Some(self.time_secs),
            predicted_dt: FRAME_SECS as f32,
            events,
            hovered_files: self.hovered_files.clone(),
            dropped_files,
            focused: true,
            system_theme: Some(if self.options.is_dark { egui::Theme::Dark } else { egui::Theme::Light }),
            ..RawInput::default()
        };
        if let Some(viewport) = input.viewports.get_mut(&ViewportId::ROOT) {
            viewport.native_pixels_per_point = Some(self.options.scale);
            if close {
                viewport.events.push(egui::ViewportEvent::Close);
            }
        }
        let app = &mut self.app;
        let mut output = self.context.run_ui(input, |ui| app.frame(ui));
        self.raster.update_textures(&mut output.textures_delta);
        if let Some(mut previous) = self.output.take() {
            self.raster.free_textures(&mut previous.textures_delta);
        }
        for command in &output.platform_output.commands {
            if let egui::OutputCommand::CopyText(text) = command {
                text.clone_into(&mut self.clipboard);
            }
        }
        let commands = output.viewport_output.get(&ViewportId::ROOT).map(|viewport| viewport.commands.as_slice());
        let commands = commands.unwrap_or_default();
        // As a window system does it: a wish to close can be refused in the frame that hears of it.
        self.is_closed |= close && !commands.contains(&ViewportCommand::CancelClose);
        self.is_closing = commands.contains(&ViewportCommand::Close);
        if let Some(tree) = output.platform_output.accesskit_update.take() {
            self.tree = Some(tree);
        }
        self.output = Some(output);
        self.time_secs += FRAME_SECS;
    }

    // What is seen.

    /// A picture of a part of the last frame, its sides rounded to pixels.
    pub fn picture_of(&mut self, rect: Rect) -> Picture {
        let picture = self.picture();
        let scale = self.options.scale;
        let side = |at: f32, limit: u32| (at * scale).round().clamp(0.0, limit as f32) as u32;
        let corner = |at: Pos2| [side(at.x, picture.width_px), side(at.y, picture.height_px)];
        picture.part(corner(rect.min), corner(rect.max))
    }

    /// A picture of the last frame.
    pub fn picture(&mut self) -> Picture {
        let scale = self.options.scale;
        let size_px = [self.options.width, self.options.height].map(|side| (side as f32 * scale).round() as u32);
        let shapes = self.output.as_ref().map(|output| output.shapes.clone()).unwrap_or_default();
        let primitives = self.context.tessellate(shapes, scale);
        let background = self.context.global_style().visuals.panel_fill;
        self.raster.paint(&primitives, size_px, scale, background)
    }

    /// Where the dialog, palette or menu in front is, in logical pixels; `None` where there is none.
    pub fn front_rect(&self) -> Option<Rect> {
        self.context.memory(|memory| {
            let shown = memory.areas().visible_layer_ids();
            let is_front = |layer: &LayerId| layer.order == Order::Foreground && shown.contains(layer);
            let front = memory.layer_ids().filter(is_front).last()?;
            memory.area_rect(front.id)
        })
    }

    /// The controls that are on the screen, in the tree's order.
    pub fn controls(&self) -> Vec<Control> {
        self.tree.as_ref().map(|tree| controls::of_tree(tree, self.options.scale)).unwrap_or_default()
    }

    /// The control that has the keyboard.
    pub fn focused(&self) -> Option<Control> {
        let focus = self.tree.as_ref()?.focus;
        self.controls().into_iter().find(|control| control.id == focus)
    }

    /// The first control with a name.
    pub fn control(&self, name: &str) -> Option<Control> {
        self.controls().into_iter().find(|control| control.name == name)
    }

    /// Clicks in the middle of a control. Gives whether there is one of this name.
    pub fn click_control(&mut self, name: &str) -> bool {
        let control = self.control(name);
        if let Some(control) = &control {
            self.click(control.rect.center());
        }
        control.is_some()
    }
}

#[derive(Debug)]
struct Dropped(PathBuf);

impl egui::DroppedFile for Dropped {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        std::fs::read(&self.0).map_err(|error| error.to_string())
    }
}
