//! The window on a screen.

use std::fmt;
use std::path::PathBuf;

use egui::{Ui, ViewportBuilder, vec2};

use crate::app::look::theme::Motion;
use crate::app::session::{
    file_dialogs::Dialogs,
    jobs::Mode,
    origin::{Origin, bundled},
    settings,
};
use crate::app::state::App;
use crate::store;

/// What to open the window with.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct WindowOptions {
    /// The plan to show: a file of any known format, or a folder of them; `None` for a bundled one.
    pub plan: Option<PathBuf>,
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
        viewport: ViewportBuilder::default()
            .with_title("Enfilade")
            .with_app_id("enfilade")
            .with_inner_size(vec2(1280.0, 800.0))
            .with_min_inner_size(vec2(640.0, 420.0))
            .with_drag_and_drop(true),
        system_font_fallback: false,
        ..eframe::NativeOptions::default()
    };
    let create = |creation: &eframe::CreationContext<'_>| {
        let context = &creation.egui_ctx;
        let mode = Mode::Threads(context.clone());
        let mut app = App::new(context, mode, Dialogs::System { is_open: false }, Motion::Smooth);
        if let Some(file) = settings::file() {
            app.use_settings(file);
        }
        app.session.use_own_schemes_and_models();
        app.session.use_clock(now);
        if let Some(folder) = store::journal_folder() {
            app.use_journal(folder);
        }
        let first = match options.plan {
            Some(path) => Some(Origin::File { path, storey: 0 }),
            None => (!bundled().is_empty()).then_some(Origin::Bundled(0)),
        };
        if let Some(origin) = first {
            app.session.open(origin);
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
