//! Recording: user actions, written as a script that repeats them.
//!
//! A recording holds the commands that ran, however they were called: by key, by menu, by a click on the
//! plan, by typing into a field, by a dialog. The files it starts from and opens are included, and so is
//! the final plan, so that it can be replayed anywhere and checks whether the result is the same.

mod files;

use crate::app::session::origin::file_name;
use std::any::Any;
use std::path::{Path, PathBuf};

use egui::Context;

use super::folders::inner;
use super::words::written;
use crate::app::commands::{self, ArgumentKind, COMMANDS, Executed, Menu, elements_word, room_word, sample_word};
use crate::app::look::theme::Motion;
use crate::app::session::{
    Session,
    file_dialogs::{Dialogs, Given, Purpose},
    jobs::{Kind, Mode},
    messages::Severity,
    origin::Origin,
    plan_list::{self, Depth},
    questions::Intent,
    wishes::Wish,
};
use crate::app::state::App;
use crate::formats::{self, plan_json};
use crate::geometry::Point;
use crate::plan::{ElementId, Plan};
use crate::store::{SaveError, save_bytes};
use files::Files;

/// The window's recorder, which the window stores without knowing its type.
fn recorder_in(kept: &mut Option<Box<dyn Any>>) -> Option<&mut Recorder> {
    kept.as_mut()?.downcast_mut()
}

/// Messages to the recorder, passed through the session, which cannot read them.
enum News {
    /// Where to save a recording; `then` follows.
    Chosen { recording: Recording, path: PathBuf, then: Option<Intent> },
    /// Whether it was saved.
    Saved { recording: Recording, path: PathBuf, result: Result<(), SaveError>, then: Option<Intent> },
}

/// A recording in progress.
pub(crate) struct Recorder {
    /// The script's lines so far.
    lines: Vec<Line>,
    files: Files,
    /// The window's size, scale and theme when last written down.
    frame: Frame,
    /// The document open at the start, and the length of its history then.
    start: Option<(u64, usize)>,
    /// A view not written down yet.
    view: Option<View>,
    /// Whether the view moved in this frame.
    is_moving: bool,
}

/// The words of a line, before quoting.
#[derive(Clone, Debug)]
struct Line(Vec<String>);

impl Line {
    fn new(words: &[&str]) -> Self {
        Self(words.iter().map(|word| (*word).to_owned()).collect())
    }

    fn starts_with(&self, word: &str) -> bool {
        self.0.first().is_some_and(|first| first == word)
    }
}

/// A view of the plan: the arguments of the command of that name.
#[derive(Clone, Copy, Debug, PartialEq)]
struct View {
    x_m: f64,
    y_m: f64,
    px_per_m: f64,
}

/// A finished recording: a script, and the files that belong to it.
#[derive(Clone, Debug)]
pub(crate) struct Recording {
    lines: Vec<Line>,
    files: Files,
}

/// The extension of recordings.
const ENDING: &str = ".replay";

/// Placeholder in a script's words for the folder of its files, whose name is known only when it is
/// saved. No other word contains this character.
const FOLDER: &str = "\0";

/// The recorder's own commands, which are not recorded.
const OWN: [&str; 1] = ["record-script"];

/// The window's size, scale and theme.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Frame {
    width: u32,
    height: u32,
    scale: f32,
    is_dark: bool,
}

impl Frame {
    fn of(context: &Context) -> Self {
        let size = context.input(egui::InputState::content_rect).size();
        let side = |side: f32| side.round().clamp(1.0, 8192.0) as u32;
        Self {
            width: side(size.x),
            height: side(size.y),
            scale: context.pixels_per_point().clamp(0.5, 4.0),
            is_dark: context.system_theme() == Some(egui::Theme::Dark),
        }
    }

    /// The steps that lead here from another.
    fn lines(self, from: Self) -> Vec<Line> {
        let mut lines = Vec::new();
        if (self.width, self.height) != (from.width, from.height) {
            lines.push(Line::new(&["size", &format!("{}x{}", self.width, self.height)]));
        }
        if self.scale != from.scale {
            lines.push(Line::new(&["scale", &self.scale.to_string()]));
        }
        if self.is_dark != from.is_dark {
            lines.push(Line::new(&["theme", if self.is_dark { "dark" } else { "light" }]));
        }
        lines
    }
}

/// The initial window of a script.
const FIRST_FRAME: Frame = Frame { width: 1280, height: 800, scale: 1.0, is_dark: false };

impl View {
    /// The same rounded to read well: by less than a twentieth of a pixel.
    fn rounded(self) -> Self {
        // The next power of ten below a hundredth of a pixel.
        let digits = 10f64.powi((100.0 * self.px_per_m).log10().ceil().clamp(0.0, 12.0) as i32);
        let round = |value: f64| (value * digits).round() / digits;
        // A ten-thousandth, over half of a canvas of a thousand pixels.
        let scale_digits = 10f64.powi((4.0 - self.px_per_m.log10()).floor().clamp(0.0, 9.0) as i32);
        Self {
            x_m: round(self.x_m),
            y_m: round(self.y_m),
            px_per_m: (self.px_per_m * scale_digits).round() / scale_digits,
        }
    }

    fn line(self) -> Line {
        let [x, y, scale] = [self.x_m, self.y_m, self.px_per_m].map(|number| number.to_string());
        Line::new(&["view", &x, &y, &scale])
    }
}

impl Recorder {
    fn note(&mut self, executed: &Executed, target: Option<&Origin>) {
        let Executed { id, arguments } = executed;
        let Some(command) = commands::find(id).filter(|_| !OWN.contains(id)) else { return };
        if *id == "view" {
            let number = |index: usize| arguments.get(index).and_then(|word| word.parse().ok());
            if let (Some(x_m), Some(y_m), Some(px_per_m)) = (number(0), number(1), number(2)) {
                self.view = Some(View { x_m, y_m, px_per_m });
                self.is_moving = true;
            }
            return;
        }
        // Files beside a plan are not included: the list of plans differs in the replay.
        if matches!(*id, "previous-plan" | "next-plan") {
            if let Some(origin) = target {
                let line = self.open(origin);
                self.lines.push(line);
            }
            return;
        }
        if *id == "open" {
            let word = arguments.first().map_or("", String::as_str);
            let storey = arguments.get(1).and_then(|word| word.parse::<usize>().ok()).unwrap_or(1);
            let line = self.open(&Origin::File { path: PathBuf::from(word), storey: storey.saturating_sub(1) });
            self.lines.push(line);
            return;
        }
        let files = &mut self.files;
        let words = arguments.iter().zip(command.arguments).map(|(word, argument)| match argument.kind {
            ArgumentKind::NewPlanFile | ArgumentKind::NewFile => file_name(Path::new(word)),
            ArgumentKind::PictureFile => {
                let path = Path::new(word);
                // One that cannot be read could not be used either.
                let bytes = crate::store::pictures::read_picture_bytes(path).unwrap_or_default();
                files.add(&file_name(path), bytes)
            }
            ArgumentKind::PlanFile => {
                let path = Path::new(word);
                files.add_file(path).unwrap_or_else(|| file_name(path))
            }
            _ => word.clone(),
        });
        let line = Line(std::iter::once((*id).to_owned()).chain(words).collect());
        self.lines.push(line);
    }

    /// Writes down a view, or the pending one. Of several in a row only the last counts.
    fn write_view(&mut self, view: Option<View>) {
        let Some(view) = view.or(self.view.take()) else { return };
        if self.lines.last().is_some_and(|last| last.starts_with("view")) {
            self.lines.pop();
        }
        self.lines.push(view.line());
    }

    /// The step that opens a plan.
    fn open(&mut self, origin: &Origin) -> Line {
        match origin {
            Origin::Bundled(index) => Line::new(&["open-sample", sample_word(*index)]),
            Origin::Untitled => Line::new(&["new-plan"]),
            Origin::File { path, storey } => match self.files.add_file(path) {
                None => Line::new(&["open-missing", &file_name(path)]),
                Some(word) if *storey == 0 => Line::new(&["open", &word]),
                Some(word) => Line::new(&["open", &word, &(storey + 1).to_string()]),
            },
        }
    }
}

impl Recorder {
    /// The recording up to now, with the resulting plan.
    fn recording(&self, plan: Option<&Plan>) -> Recording {
        let (mut lines, mut files) = (self.lines.clone(), self.files.clone());
        if let Some(plan) = plan {
            let path = files.add("end.plan.json", plan_json::to_bytes(plan));
            lines.push(Line::new(&["expect", "plan", "equals", &path]));
        }
        Recording { lines, files }
    }
}

impl Recording {
    /// Saves the script, and beside it the folder of its files.
    ///
    /// # Errors
    /// When something cannot be written.
    pub(crate) fn save(&self, path: &Path) -> Result<(), SaveError> {
        let name = file_name(path);
        let folder_name = format!("{}.files", name.strip_suffix(ENDING).unwrap_or(&name));
        let folder = path.with_file_name(&folder_name);
        for (name, bytes) in &self.files.0 {
            let file = folder.join(name);
            if let Some(folder) = file.parent() {
                // If this fails, saving will say so.
                let _ = std::fs::create_dir_all(folder);
            }
            save_bytes(&file, bytes)?;
        }
        let mut text = format!("# Recorded by Enfilade {}.\n", env!("CARGO_PKG_VERSION"));
        for Line(words) in &self.lines {
            let words: Vec<String> = words.iter().map(|word| written(&word.replace(FOLDER, &folder_name))).collect();
            text.push_str(&words.join(" "));
            text.push('\n');
        }
        save_bytes(path, text.as_bytes())
    }
}

impl App {
    /// Whether a recording is in progress.
    pub fn is_recording(&self) -> bool {
        self.recorder.is_some()
    }

    /// Starts recording.
    fn start_recording(&mut self, context: &Context) {
        let frame = Frame::of(context);
        let mut recorder = Recorder {
            lines: frame.lines(FIRST_FRAME),
            files: Files::default(),
            frame,
            start: None,
            view: None,
            is_moving: false,
        };
        if let Some(document) = &self.session.document {
            recorder.start = Some((document.number, document.history.position()));
            let line = recorder.open(&document.origin);
            recorder.lines.push(line);
            if document.closes_rooms != (document.origin == Origin::Untitled) {
                let word = if document.closes_rooms { "on" } else { "off" };
                recorder.lines.push(Line::new(&["rooms-from-walls", word]));
            }
        }
        if let Some(Origin::File { path, storey }) = self.session.ghost.as_ref().and_then(|ghost| ghost.origin.as_ref())
            && let Some(word) = recorder.files.add_file(path)
        {
            recorder.lines.push(Line::new(&["ghost", &word, &(storey + 1).to_string()]));
        }
        recorder.lines.extend(self.lines_of_state());
        if let Some((centre, px_per_m)) = self.canvas.free_view() {
            recorder.view = Some(View { x_m: centre.x, y_m: centre.y, px_per_m });
        }
        self.recorder = Some(Box::new(recorder));
        self.session.is_recording = true;
        self.round_view();
        self.watch_commands(true);
        self.session.status = "Recording".to_owned();
    }

    /// The steps from the program's initial state to the current view and selection.
    fn lines_of_state(&self) -> Vec<Line> {
        let first = Self::new(&Context::default(), Mode::Inline, Dialogs::Given(Given::default()), Motion::Still);
        let mut lines: Vec<Line> = COMMANDS
            .iter()
            .filter(|command| {
                command.menu.is_some_and(|(menu, _)| menu == Menu::View) && command.why_not(self).is_none()
            })
            .filter_map(|command| {
                let is_on = command.is_on(self).filter(|is_on| Some(*is_on) != command.is_on(&first))?;
                match (command.arguments.is_empty(), is_on) {
                    (true, true) => Some(Line::new(&[command.id])),
                    (true, false) => None,
                    (false, is_on) => Some(Line::new(&[command.id, if is_on { "on" } else { "off" }])),
                }
            })
            .collect();
        if self.session.selection.len() > 1 {
            lines.push(Line::new(&["select", &elements_word(self.session.selection.iter())]));
        }
        match (self.picked(), self.plan()) {
            (Some(ElementId::Room(id)), Some(plan)) => lines.push(Line::new(&["pick", &room_word(plan, id)])),
            (Some(ElementId::Opening(id)), Some(_)) => lines.push(Line::new(&["pick-opening", &id.to_string()])),
            (Some(_), Some(_)) => lines.push(Line::new(&["select", &elements_word(self.session.selection.iter())])),
            _ => {}
        }
        lines
    }

    /// Records what was done in the frame that ends.
    pub(crate) fn record(&mut self, context: &Context) {
        if std::mem::take(&mut self.wants_recording) {
            self.start_recording(context);
        }
        let Some(recorder) = recorder_in(&mut self.recorder) else { return };
        let frame = Frame::of(context);
        if frame != recorder.frame {
            let lines = frame.lines(recorder.frame);
            recorder.frame = frame;
            // While the window is being resized, only the final size counts.
            if lines.len() == 1 && recorder.lines.last().is_some_and(|last| last.starts_with("size")) {
                recorder.lines.pop();
            }
            recorder.lines.extend(lines);
        }
        self.write_executed();
        let is_moving = recorder_in(&mut self.recorder).is_some_and(|recorder| std::mem::take(&mut recorder.is_moving));
        if !is_moving {
            self.round_view();
        }
        let start = recorder_in(&mut self.recorder).and_then(|recorder| recorder.start);
        let before_start = self.session.document.as_ref().zip(start).and_then(|(document, (number, position))| {
            let is_before = document.number == number && document.history.position() < position;
            is_before.then(|| document.history.steps().get(position).map(|step| step.plan.clone()))
        });
        if let Some(plan_before) = before_start {
            self.session.say(
                Severity::Warning,
                "The recording ends before this step",
                "What is undone now was done before the recording began.",
            );
            if let Some(recorder) = recorder_in(&mut self.recorder) {
                recorder.lines.pop();
            }
            let recording = recorder_in(&mut self.recorder).map(|recorder| recorder.recording(plan_before.as_ref()));
            self.recorder = None;
            self.session.is_recording = false;
            self.watch_commands(false);
            self.ask_where_to_save_recording(recording, None);
        }
    }

    /// Writes down the commands that ran.
    pub(crate) fn write_executed(&mut self) {
        // Without a recorder they are left for other observers.
        let executed = if self.recorder.is_some() { self.take_executed() } else { return };
        let Some(recorder) = recorder_in(&mut self.recorder) else { return };
        for executed in &executed {
            if executed.id != "view" {
                // What follows was done from this very view.
                recorder.write_view(None);
            }
            recorder.note(executed, self.session.opening.as_ref());
        }
    }

    /// Writes down the current view, rounded, and shows it as written.
    fn round_view(&mut self) {
        let Some(recorder) = recorder_in(&mut self.recorder) else { return };
        if let Some(view) = recorder.view.take() {
            let view = view.rounded();
            self.canvas.set_view(Point::new(view.x_m, view.y_m), view.px_per_m);
            recorder.write_view(Some(view));
        }
    }

    /// Asks where to save the recording. It ends once saved, and continues if the dialog is cancelled;
    /// then does what was to follow.
    pub(crate) fn stop_recording(&mut self, then: Option<Intent>) {
        self.session.commit_field();
        self.write_executed();
        self.round_view();
        let recording = recorder_in(&mut self.recorder).map(|recorder| recorder.recording(self.session.plan()));
        self.ask_where_to_save_recording(recording, then);
    }

    fn ask_where_to_save_recording(&mut self, recording: Option<Recording>, then: Option<Intent>) {
        let Some(recording) = recording else { return };
        let purpose = Purpose::Recording(Box::new(move |path| Box::new(News::Chosen { recording, path, then })));
        self.session.ask_for_file(purpose, None, "recording.replay".to_owned());
    }

    /// Receives the messages passed through the session.
    pub(crate) fn hear_of_recording(&mut self, news: Box<dyn Any + Send>) {
        match news.downcast::<News>().map(|news| *news) {
            Ok(News::Chosen { recording, path, then }) => self.save_recording(recording, path, then),
            Ok(News::Saved { recording, path, result, then }) => {
                self.recording_was_saved(&path, recording, result, then);
            }
            // There are no other senders.
            Err(_) => {}
        }
    }

    /// Saves a recording, adding the extension if it is missing.
    pub(crate) fn save_recording(&mut self, recording: Recording, mut path: PathBuf, then: Option<Intent>) {
        if !path.to_string_lossy().ends_with(ENDING) {
            path.as_mut_os_string().push(ENDING);
        }
        self.session.jobs.start(Kind::new("save the recording"), move |_| {
            let result = recording.save(&path);
            move |session: &mut Session, _: &Context| {
                session.wishes.push(Wish::Recording(Box::new(News::Saved { recording, path, result, then })));
            }
        });
    }

    /// Handles a recording that was saved, or could not be.
    pub(crate) fn recording_was_saved(
        &mut self,
        path: &Path,
        recording: Recording,
        result: Result<(), SaveError>,
        then: Option<Intent>,
    ) {
        match result {
            Ok(()) => {
                self.recorder = None;
                self.session.is_recording = false;
                self.watch_commands(false);
                self.session.status = format!("Recorded in {}", file_name(path));
                if let Some(intent) = then {
                    self.session.request(intent);
                }
            }
            Err(error) => {
                let text = format!("{} is not saved: {}", file_name(path), error.what);
                let detail = format!("{}.\n{}", error.hint, self.session.shown_path(path));
                self.session.say(Severity::Error, text, detail);
                // Elsewhere, perhaps.
                self.ask_where_to_save_recording(Some(recording), then);
            }
        }
    }
}
