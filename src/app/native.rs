//! The window on a screen.

use std::fmt;
use std::path::PathBuf;

use egui::{Ui, ViewportBuilder, vec2};

use crate::app::look::theme::Motion;
use crate::app::session::{file_dialogs::Dialogs, jobs::Mode, memory::WindowPlace, origin::Origin, settings};
use crate::app::state::App;
use crate::store;

/// What to open the window with.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct WindowOptions {
    /// The plans to open, the last on top: files of any known format, or folders of them; none for the welcome page.
    pub plans: Vec<PathBuf>,
    /// Whether to start with the demonstration.
    pub demo: bool,
}

/// Why no window opened.
#[derive(Debug)]
pub enum WindowError {
    /// There is no display to open it on: neither X11 nor Wayland answers.
    NoDisplay(String),
    /// There is a display, but nothing can be drawn on it.
    Graphics(String),
}

impl fmt::Display for WindowError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoDisplay(what) => write!(f, "no display to open a window on ({what})"),
            Self::Graphics(what) => write!(f, "the display cannot show the window ({what})"),
        }
    }
}

impl std::error::Error for WindowError {}

/// Opens the window and returns when it is closed.
///
/// # Errors
/// When there is no display, or it has no OpenGL. Never panics.
pub fn run_window(options: WindowOptions) -> Result<(), WindowError> {
    let native = eframe::NativeOptions {
        viewport: placed(
            ViewportBuilder::default()
                .with_title("Enfilade")
                .with_app_id("enfilade")
                .with_min_inner_size(vec2(640.0, 420.0))
                .with_drag_and_drop(true),
        ),
        system_font_fallback: false,
        ..eframe::NativeOptions::default()
    };
    let create = |creation: &eframe::CreationContext<'_>| {
        let context = &creation.egui_ctx;
        let mode = Mode::Threads(context.clone());
        let mut app = App::new(context, mode, Dialogs::System { is_open: false, are_missing: false }, Motion::Smooth);
        if let Some(file) = settings::file() {
            app.use_settings(file, context);
        }
        app.session.use_own_schemes_and_models();
        app.session.use_clock(now);
        app.session.cache_folder = store::cache_folder();
        if let Some(folder) = store::journal_folder() {
            app.use_journal(folder);
        }
        if options.demo {
            app.session.start_demo();
        } else if let [path] = options.plans.as_slice() {
            // Nothing else is open yet.
            let _ = app.session.open(Origin::File { path: path.clone(), storey: 0 });
        } else if !options.plans.is_empty() {
            app.session.open_several(options.plans);
        }
        Ok(Box::new(Window { app }) as Box<dyn eframe::App>)
    };
    eframe::run_native("enfilade", native, Box::new(create)).map_err(|error| match error {
        eframe::Error::WinitEventLoop(error) => WindowError::NoDisplay(reason(&error.to_string())),
        eframe::Error::Winit(error) => WindowError::NoDisplay(reason(&error.to_string())),
        error => WindowError::Graphics(error.to_string()),
    })
}

#[expect(clippy::disallowed_methods, reason = "says how old is what can be recovered")]
fn now() -> std::time::SystemTime {
    std::time::SystemTime::now()
}

/// The size of the first window: it fits a screen of 1280 by 800 with the system's bars around it.
const FIRST_SIZE: egui::Vec2 = vec2(1200.0, 690.0);

/// The window where it was last, or of its first size.
fn placed(window: ViewportBuilder) -> ViewportBuilder {
    let text = settings::file().and_then(|file| settings::read_text(&file).ok().flatten());
    let Some(place) = text.as_deref().and_then(WindowPlace::of_text) else { return window.with_inner_size(FIRST_SIZE) };
    let window = window.with_inner_size(place.size).with_maximized(place.is_maximized);
    match place.at {
        Some(at) => window.with_position(at),
        None => window,
    }
}

struct Window {
    app: App,
}

impl eframe::App for Window {
    fn raw_input_hook(&mut self, context: &egui::Context, raw: &mut egui::RawInput) {
        self.app.take_arrivals(context, raw);
    }

    fn ui(&mut self, ui: &mut Ui, _frame: &mut eframe::Frame) {
        self.app.frame(ui);
    }

    fn clear_color(&self, visuals: &egui::Visuals) -> [f32; 4] {
        visuals.panel_fill.to_normalized_gamma_f32()
    }
}

/// winit's error message, without the source location that it puts in front.
fn reason(what: &str) -> String {
    let behind_place = what.split_once(".rs:").and_then(|(_, rest)| rest.split_once(": "));
    behind_place.map_or(what, |(_, reason)| reason).trim_end_matches('.').to_owned()
}
