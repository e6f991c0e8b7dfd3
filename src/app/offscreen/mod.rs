//! The same window without a display: input is fed by hand, the clock stands still between frames, and
//! snapshots are rendered on the CPU.

pub(crate) mod controls;
mod input;
pub(crate) mod raster;
mod work;

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

/// Time between clicks: two clicks within 0.3 seconds would be a double click.
const CLICK_GAP_SECS: f64 = 0.5;

/// Seconds from frame to frame.
const FRAME_SECS: f64 = 1.0 / 60.0;

/// The same of a slow machine.
const SLOW_FRAME_SECS: f64 = 0.5;

/// A window that has not settled after this many frames never will.
const MOST_FRAMES: usize = 600;

/// The window's properties.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OffscreenOptions {
    /// Size in logical pixels.
    pub width: u32,
    pub height: u32,
    /// Physical pixels per logical one.
    pub scale: f32,
    /// Whether the system asks for a dark theme.
    pub is_dark: bool,
}

impl Default for OffscreenOptions {
    fn default() -> Self {
        Self { width: 1280, height: 800, scale: 1.0, is_dark: false }
    }
}

/// The window kept asking for frames and never settled.
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
    /// The text that can be pasted: the system's clipboard.
    clipboard: String,
    /// Input that is held back until all of it comes at once; `None` where each comes in a frame of its own.
    gathered: Option<Vec<Event>>,
    /// How long a frame takes, in seconds.
    frame_secs: f64,
    /// The output of the last frame.
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
            gathered: None,
            frame_secs: FRAME_SECS,
            output: None,
            tree: None,
            is_closing: false,
            is_closed: false,
        }
    }

    /// Runs as if no screen reader were listening: nothing is computed for one.
    pub fn without_screen_reader(self) -> Self {
        self.context.disable_accesskit();
        self
    }

    /// The window's state.
    pub fn app(&self) -> &App {
        &self.app
    }

    /// Opens the file at a path, as from the command line.
    pub fn open(&mut self, path: &Path) {
        self.app.session.open(Origin::File { path: path.to_owned(), storey: 0 });
    }

    /// Opens a bundled plan by its file's name without the extension. Returns whether it exists.
    pub fn open_bundled(&mut self, stem: &str) -> bool {
        let index = bundled().iter().position(|(name, _)| crate::formats::file_stem(name) == stem);
        if let Some(index) = index {
            self.app.session.open(Origin::Bundled(index));
        }
        index.is_some()
    }

    /// Runs a command by its id. Returns whether the command exists and ran.
    pub fn run_command(&mut self, id: &str) -> bool {
        self.app.run_command(id, &self.context)
    }

    /// Runs a command by its id, with arguments; like [`App::run_command_with`].
    ///
    /// # Errors
    /// When the command does not exist or is unavailable, or an argument is invalid.
    pub fn run_command_with(&mut self, id: &str, arguments: &[&str]) -> Result<(), CommandError> {
        self.app.run_command_with(id, arguments, &self.context)
    }

    /// Keeps settings in a file from now on, and loads those it has. Without this, none are read or kept.
    pub fn use_settings(&mut self, file: &Path) {
        self.app.use_settings(file.to_owned(), &self.context);
    }

    /// Keeps journals in a folder from now on, and offers those left there. Without this, none are kept.
    pub fn use_journal(&mut self, folder: &Path) {
        self.app.use_journal(folder.to_owned());
    }

    /// Starts or stops recording the commands that run; like [`App::watch_commands`].
    pub fn watch_commands(&mut self, is_watched: bool) {
        self.app.watch_commands(is_watched);
    }

    /// The commands run since the last call; like [`App::take_executed`].
    pub fn take_executed(&mut self) -> Vec<Executed> {
        self.app.take_executed()
    }

    /// Sets the answer to the next file dialog; `None` cancels it. A dialog without an answer is
    /// cancelled.
    pub fn answer_dialog(&mut self, path: Option<PathBuf>) {
        if let Some(given) = self.given() {
            given.answers.push_back(path);
        }
    }

    /// From now on is as on a system without dialogs for files.
    pub fn be_without_dialogs(&mut self) {
        if let Some(given) = self.given() {
            given.has_none = true;
        }
    }

    /// The number of answers not used yet.
    pub fn answers_left(&mut self) -> usize {
        self.given().map_or(0, |given| given.answers.len())
    }

    /// Drops unused answers.
    pub fn forget_answers(&mut self) {
        if let Some(given) = self.given() {
            given.answers.clear();
        }
    }

    /// The number of dialogs without an answer since the last call.
    pub fn take_unanswered(&mut self) -> usize {
        self.given().map_or(0, |given| std::mem::take(&mut given.unanswered))
    }

    fn given(&mut self) -> Option<&mut Given> {
        match &mut self.app.session.dialogs {
            Dialogs::Given(given) => Some(given),
            Dialogs::System { .. } => None,
        }
    }

    /// Shows paths below a folder relative to it, so that what is visible does not depend on where the
    /// folder is.
    pub fn name_paths_from(&mut self, folder: &Path) {
        self.app.session.named_from = Some(folder.to_owned());
    }

    /// Whether the window has closed.
    pub fn is_closed(&self) -> bool {
        self.is_closed
    }

    /// The clipboard: what was copied last, or set to be pasted.
    pub fn clipboard(&self) -> &str {
        &self.clipboard
    }

    /// Sets the text that Ctrl+V pastes.
    pub fn set_clipboard(&mut self, text: &str) {
        text.clone_into(&mut self.clipboard);
    }

    /// The window's current properties.
    pub fn options(&self) -> OffscreenOptions {
        self.options
    }

    /// Changes its size, scale or system theme.
    pub fn set_options(&mut self, options: OffscreenOptions) {
        self.options = options;
        self.frame(Vec::new(), Vec::new(), false);
    }

    // Input. Each is a separate frame, as at most one thing happens in a sixtieth of a second.

    /// Tessellates the last frame, as a display would. Returns the number of vertices.
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

    /// Lets time pass, in seconds: runs a frame whenever the window asks for one, and one at the end. If
    /// it keeps asking, the frames are limited as for [`NotSettled`], plus the last one.
    pub fn advance(&mut self, secs: f64) {
        let end_secs = self.time_secs + secs.max(0.0);
        for _ in 0..MOST_FRAMES {
            self.frame(Vec::new(), Vec::new(), false);
            if self.is_closed || self.time_secs >= end_secs {
                return;
            }
            // Nothing happens until the window asks for a repaint.
            let idle_secs = self.repaint_delay_secs() - FRAME_SECS;
            self.time_secs = (self.time_secs + idle_secs.max(0.0)).min(end_secs);
        }
        self.time_secs = end_secs;
        self.frame(Vec::new(), Vec::new(), false);
    }

    /// Runs frames until the window asks for no more soon.
    ///
    /// # Errors
    /// When it keeps asking for ten seconds.
    pub fn settle(&mut self) -> Result<(), NotSettled> {
        for _ in 0..MOST_FRAMES {
            self.frame(Vec::new(), Vec::new(), false);
            if self.is_closed || (!self.is_closing && self.repaint_delay_secs() > FRAME_SECS) {
                return Ok(());
            }
        }
        Err(NotSettled)
    }

    /// Seconds until the window wants a repaint.
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
        self.app.take_arrivals(&self.context, &mut input);
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
        // As in a window system: a request to close can be refused in the frame that receives it.
        self.is_closed |= close && !commands.contains(&ViewportCommand::CancelClose);
        self.is_closing = commands.contains(&ViewportCommand::Close);
        if let Some(tree) = output.platform_output.accesskit_update.take() {
            self.tree = Some(tree);
        }
        self.output = Some(output);
        self.time_secs += self.frame_secs;
    }

    // What is visible.

    /// A snapshot of part of the last frame, its sides rounded to pixels.
    pub fn picture_of(&mut self, rect: Rect) -> Picture {
        let picture = self.picture();
        let scale = self.options.scale;
        let side = |at: f32, limit: u32| (at * scale).round().clamp(0.0, limit as f32) as u32;
        let corner = |at: Pos2| [side(at.x, picture.width_px), side(at.y, picture.height_px)];
        picture.part(corner(rect.min), corner(rect.max))
    }

    /// A snapshot of the last frame.
    pub fn picture(&mut self) -> Picture {
        let scale = self.options.scale;
        let size_px = [self.options.width, self.options.height].map(|side| (side as f32 * scale).round() as u32);
        let shapes = self.output.as_ref().map(|output| output.shapes.clone()).unwrap_or_default();
        let primitives = self.context.tessellate(shapes, scale);
        let background = self.context.global_style().visuals.panel_fill;
        self.raster.paint(&primitives, size_px, scale, background)
    }

    /// The rectangle of the front dialog, palette or menu, in logical pixels; `None` if there is none.
    pub fn front_rect(&self) -> Option<Rect> {
        self.context.memory(|memory| {
            let shown = memory.areas().visible_layer_ids();
            let is_front = |layer: &LayerId| layer.order == Order::Foreground && shown.contains(layer);
            let front = memory.layer_ids().filter(is_front).last()?;
            memory.area_rect(front.id)
        })
    }

    /// The controls on the screen, in tree order.
    pub fn controls(&self) -> Vec<Control> {
        self.tree.as_ref().map(|tree| controls::of_tree(tree, self.options.scale)).unwrap_or_default()
    }

    /// The control that has the keyboard.
    pub fn focused(&self) -> Option<Control> {
        let focus = self.tree.as_ref()?.focus;
        self.controls().into_iter().find(|control| control.id == focus)
    }

    /// The first control with this name.
    pub fn control(&self, name: &str) -> Option<Control> {
        self.controls().into_iter().find(|control| control.name == name)
    }

    /// Clicks the middle of a control. Returns whether one with this name exists.
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
