//! The same window without a display: input is fed by hand, the clock stands still between frames,
//! and a picture is painted on the CPU.

use std::collections::VecDeque;
use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use egui::accesskit;
use egui::os::OperatingSystem;
use egui::{
    Context, Event, FullOutput, Key, Modifiers, MouseWheelSource, MouseWheelUnit, PointerButton, Pos2, RawInput, Rect,
    TouchPhase, Vec2, ViewportCommand, ViewportId, vec2,
};

use super::background::Mode;
use super::dialogs::Dialogs;
use super::document::{Origin, bundled};
use super::raster::Raster;
use super::theme::Motion;
use super::{App, CommandError, Executed, Picture};

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

/// A control that a screen reader would find.
#[derive(Clone, Debug, PartialEq)]
pub struct Control {
    pub name: String,
    pub role: accesskit::Role,
    /// In logical pixels.
    pub rect: Rect,
    pub is_enabled: bool,
    /// Whether it is on, where it can be.
    pub is_on: Option<bool>,
}

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
    /// What the last frame gave.
    output: Option<FullOutput>,
    tree: Option<accesskit::TreeUpdate>,
    is_closing: bool,
    is_closed: bool,
    copied: Option<String>,
}

impl Offscreen {
    /// A window with no plan.
    pub fn new(options: OffscreenOptions) -> Self {
        let context = Context::default();
        context.set_os(OperatingSystem::Nix);
        context.enable_accesskit();
        let app = App::new(&context, Mode::Inline, Dialogs::Given(VecDeque::new()), Motion::Still);
        Self {
            app,
            context,
            raster: Raster::default(),
            options,
            time_secs: 0.0,
            pointer: Pos2::ZERO,
            modifiers: Modifiers::NONE,
            hovered_files: Vec::new(),
            output: None,
            tree: None,
            is_closing: false,
            is_closed: false,
            copied: None,
        }
    }

    /// The window's state.
    pub fn app(&self) -> &App {
        &self.app
    }

    /// Opens the file at a path, as from the command line.
    pub fn open(&mut self, path: &Path) {
        self.app.open(Origin::File { path: path.to_owned(), storey: 0 });
    }

    /// Opens a plan that comes with the program, by its file's name without the ending.
    /// Gives whether there is such a plan.
    pub fn open_bundled(&mut self, stem: &str) -> bool {
        let index = bundled().iter().position(|(name, _)| crate::formats::file_stem(name) == stem);
        if let Some(index) = index {
            self.app.open(Origin::Bundled(index));
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
        if let Dialogs::Given(answers) = &mut self.app.dialogs {
            answers.push_back(path);
        }
    }

    /// Whether the window has closed.
    pub fn is_closed(&self) -> bool {
        self.is_closed
    }

    /// What was copied last.
    pub fn copied(&self) -> Option<&str> {
        self.copied.as_deref()
    }

    // Input. Each is a frame of its own, as at most one thing happens in a sixtieth of a second.

    /// Feeds an event of egui's.
    pub fn event(&mut self, event: Event) {
        self.frame(vec![event], Vec::new(), false);
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
        self.move_to(at);
        self.button(PointerButton::Primary, true);
        self.button(PointerButton::Primary, false);
        // Two clicks are a double click only when they follow within 0.3 seconds.
        self.advance(0.5);
    }

    /// Drags from a place to another.
    pub fn drag(&mut self, button: PointerButton, from: Pos2, to: Pos2) {
        self.move_to(from);
        self.button(button, true);
        self.move_to(from + (to - from) / 2.0);
        self.move_to(to);
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

    /// Presses a key and lets it go.
    pub fn key(&mut self, modifiers: Modifiers, key: Key) {
        self.modifiers = modifiers;
        for pressed in [true, false] {
            self.event(Event::Key { key, physical_key: None, pressed, repeat: false, modifiers });
        }
        self.modifiers = Modifiers::NONE;
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
        self.options = OffscreenOptions { width, height, ..self.options };
        self.frame(Vec::new(), Vec::new(), false);
    }

    // Time.

    /// Lets time pass, in seconds, frame by frame.
    pub fn advance(&mut self, secs: f64) {
        let frames = (secs / FRAME_SECS).round().max(1.0) as usize;
        for _ in 0..frames {
            self.frame(Vec::new(), Vec::new(), false);
        }
    }

    /// Runs frames until the window asks for no further one soon.
    ///
    /// # Errors
    /// When it goes on asking for ten seconds.
    pub fn settle(&mut self) -> Result<(), NotSettled> {
        for _ in 0..MOST_FRAMES {
            self.frame(Vec::new(), Vec::new(), false);
            let delay = self
                .output
                .as_ref()
                .and_then(|output| output.viewport_output.get(&ViewportId::ROOT))
                .map(|viewport| viewport.repaint_delay);
            if self.is_closed || (!self.is_closing && delay.is_none_or(|delay| delay.as_secs_f64() > FRAME_SECS)) {
                return Ok(());
            }
        }
        Err(NotSettled)
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
                self.copied = Some(text.clone());
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

    /// A picture of the last frame.
    pub fn picture(&mut self) -> Picture {
        let scale = self.options.scale;
        let size_px = [self.options.width, self.options.height].map(|side| (side as f32 * scale).round() as u32);
        let shapes = self.output.as_ref().map(|output| output.shapes.clone()).unwrap_or_default();
        let primitives = self.context.tessellate(shapes, scale);
        let background = self.context.global_style().visuals.panel_fill;
        self.raster.paint(&primitives, size_px, scale, background)
    }

    /// The controls with a name that are on the screen, in the tree's order.
    pub fn controls(&self) -> Vec<Control> {
        let Some(tree) = &self.tree else { return Vec::new() };
        let scale = self.options.scale;
        tree.nodes
            .iter()
            .filter_map(|(_, node)| {
                let bounds = node.bounds()?;
                let corner = |x: f64, y: f64| Pos2::new(x as f32 / scale, y as f32 / scale);
                Some(Control {
                    // Plain text carries what it says as its value.
                    name: node.label().or(node.value()).unwrap_or_default().to_owned(),
                    role: node.role(),
                    rect: Rect::from_min_max(corner(bounds.x0, bounds.y0), corner(bounds.x1, bounds.y1)),
                    is_enabled: !node.is_disabled(),
                    is_on: node.is_selected().or(node.toggled().map(|toggled| toggled == accesskit::Toggled::True)),
                })
            })
            .collect()
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
