//! The command palette: finds a command by a few letters of its name, and asks for its arguments.

mod lines;
mod path_lines;

use crate::app::state::dialogs;
use egui::text::{LayoutJob, TextFormat};
use egui::{
    Align2, Color32, FontId, Id, Key, Modal, Modifiers, Rect, Response, RichText, Role, ScrollArea, Sense, TextEdit,
    Ui, UiBuilder, Vec2, WidgetInfo, pos2, vec2,
};

use self::lines::{argument_lines, command_lines, row};
use self::path_lines::{Listing, path_lines, path_problem};
use crate::app::commands::{Argument, COMMANDS, Choice, Command, find};
use crate::app::look::{
    icons::Icon,
    search::{Hit, Search},
    text::{select, select_all},
    theme,
    widgets::{ICON, ROW, colours, hairline_in, put, put_line, swatch},
};
use crate::app::session::paths::{PathUse, split_typed};
use crate::app::state::App;
use crate::app::state::{After, Dialog, Entry, Purpose};
use crate::base::units::Units;
use crate::base::wording::sentence;

/// Width of the palette, in points.
const WIDTH: f32 = 580.0;

/// Distance below the top of the window.
const TOP: f32 = 60.0;

/// Height of the line with the text field.
const HEAD: f32 = 46.0;

/// The number of rows visible at once.
const ROWS: usize = 11;

/// The number of recent commands remembered.
const RECENT: usize = 6;

/// The open palette.
#[derive(Default)]
pub(crate) struct Palette {
    query: String,
    /// The row that Enter chooses.
    at: usize,
    /// The command whose argument is being asked for.
    asking: Option<Asking>,
    /// Whether a key changed the chosen row, so that it must be scrolled into view.
    is_stepped: bool,
    /// Whether the field has been shown: the first time, its text is selected.
    is_shown: bool,
    /// Whether its text was completed: the cursor goes behind it.
    is_completed: bool,
    /// What the folder of a typed path offers.
    listing: Listing,
    /// What numbers are in that are typed without a unit.
    units: Units,
}

struct Asking {
    command: &'static Command,
    /// The arguments already given.
    given: Vec<String>,
    /// The arguments after the one being asked for.
    rest: Vec<String>,
    /// What the command applies to, shown beside its title; may be empty.
    about: String,
    /// The choices for the next argument, once known; the inner `None` means anything.
    choices: Option<Option<Vec<Choice>>>,
    /// Why the text was rejected; empty if it was not.
    error: String,
    /// The path of a file that is to be replaced, if it is entered once more.
    replaces: Option<String>,
    /// Whether the command was chosen from the list, to which Escape returns.
    is_from_list: bool,
}

impl Asking {
    fn new(command: &'static Command, given: Vec<String>) -> Self {
        let (rest, about, error) = (Vec::new(), String::new(), String::new());
        Self { command, given, rest, about, choices: None, error, replaces: None, is_from_list: false }
    }

    /// The argument being asked for.
    fn argument(&self) -> Option<&'static Argument> {
        self.command.arguments.get(self.given.len())
    }

    /// What the path that is asked for is for, if it is one that is typed.
    fn path_use(&self) -> Option<PathUse> {
        self.argument().filter(|_| !matches!(self.choices, Some(Some(_))))?.kind.path_use()
    }

    /// Whether any text is accepted.
    fn is_free(&self) -> bool {
        matches!(self.choices, Some(None))
    }
}

impl Palette {
    /// Opens with the list of commands, or with a request for an argument.
    fn new(purpose: Purpose) -> Self {
        let Purpose::Argument(asked) = purpose else { return Self::default() };
        let Some(command) = find(asked.command) else { return Self::default() };
        let (rest, about, choices) = (asked.rest, asked.about, asked.choices.map(Some));
        let asking = Asking { rest, about, choices, ..Asking::new(command, asked.given) };
        Self { query: asked.text, asking: Some(asking), ..Self::default() }
    }
}

/// A line of the list.
struct Line {
    title: String,
    /// The indices of the title's characters that matched.
    characters: Vec<u32>,
    /// Beside the title.
    detail: String,
    /// At the end.
    trail: String,
    lead: LineLead,
    is_available: bool,
    taken: Taken,
}

#[derive(Clone, Copy)]
enum LineLead {
    None,
    Tick,
    Icon(Icon),
    Swatch(Color32),
}

/// The result of choosing a line.
enum Taken {
    Command(&'static Command),
    Argument(String),
    /// The field gets this text.
    Typed(String),
}

/// A user action.
enum Act {
    Take(usize),
    /// Complete the text by a line.
    Complete(usize),
    /// Submit the text.
    TakeText,
    /// Go back one step, or close.
    Back,
    Close,
}

pub(super) const ENTRY: Entry = Entry { id: ID, make: |_, purpose| Box::new(Palette::new(purpose)), is_of_plan: false };

pub(crate) const ID: &str = dialogs::PALETTE;

impl Dialog for Palette {
    fn show(&mut self, app: &mut App, ui: &mut Ui) -> After {
        // A question takes precedence, and what was started here is dropped.
        if app.session.question.is_some() {
            app.session.typed_for = None;
            return After::Close;
        }
        self.units = app.units();
        let lines = self.lines(app, ui);
        let act = self.show_in(ui, &lines);
        let is_done = act.is_some();
        let keep = match act {
            None => true,
            Some(Act::Close) => false,
            Some(Act::Back) => self.go_back(),
            Some(Act::Take(index)) => match lines.into_iter().nth(index).map(|line| (line.is_available, line.taken)) {
                Some((true, Taken::Command(command))) => self.take_command(app, ui, command),
                Some((true, Taken::Argument(word))) => self.take_argument(app, ui, word),
                Some((true, Taken::Typed(text))) => self.complete(text),
                Some((false, _)) | None => true,
            },
            Some(Act::Complete(index)) => match lines.into_iter().nth(index).map(|line| line.taken) {
                Some(Taken::Argument(text) | Taken::Typed(text)) => self.complete(text),
                Some(Taken::Command(_)) | None => true,
            },
            Some(Act::TakeText) => {
                let text = self.query.clone();
                self.take_argument(app, ui, text)
            }
        };
        // A command may have opened a palette of its own.
        if keep && is_done && !app.dialogs.is_waiting(ID) {
            ui.request_repaint();
        }
        if keep {
            After::Stay
        } else {
            // Whatever waited for a path has it, or is dropped.
            if !app.dialogs.is_waiting(ID) {
                app.session.typed_for = None;
            }
            After::Close
        }
    }
}

impl Palette {
    // The contents of the list.

    fn lines(&mut self, app: &App, ui: &Ui) -> Vec<Line> {
        let mut search = Search::new(&self.query);
        let Some(asking) = &mut self.asking else { return command_lines(app, ui, &mut search) };
        let argument = asking.argument();
        if let Some(use_) = asking.path_use() {
            asking.choices.get_or_insert(None);
            return path_lines(app, &self.query, use_, &mut self.listing);
        }
        // Nothing changes while the palette is open.
        let choices = asking.choices.get_or_insert_with(|| argument.and_then(|argument| argument.kind.choices(app)));
        let mut lines = argument_lines(app, ui, choices.as_deref().unwrap_or_default(), &mut search);
        let typed = self.query.trim();
        let is_choice = choices.iter().flatten().any(|choice| choice.word.eq_ignore_ascii_case(typed));
        if argument.is_some_and(|argument| argument.kind.is_open()) && !typed.is_empty() && !is_choice {
            lines.push(Line {
                title: format!("‘{typed}’"),
                characters: Vec::new(),
                detail: "as typed".to_owned(),
                trail: String::new(),
                lead: LineLead::None,
                is_available: true,
                taken: Taken::Argument(typed.to_owned()),
            });
        }
        lines
    }

    // Actions. Each returns whether the palette stays open.

    /// Puts a text into the field.
    fn complete(&mut self, text: String) -> bool {
        self.query = text;
        self.at = 0;
        (self.is_completed, self.is_stepped) = (true, true);
        if let Some(asking) = &mut self.asking {
            asking.error.clear();
        }
        true
    }

    fn go_back(&mut self) -> bool {
        match self.asking.take() {
            Some(asking) if asking.is_from_list => {
                *self = Self::default();
                true
            }
            _ => false,
        }
    }

    fn take_command(&mut self, app: &mut App, ui: &Ui, command: &'static Command) -> bool {
        app.panels.recent.retain(|id| *id != command.id);
        app.panels.recent.insert(0, command.id);
        app.panels.recent.truncate(RECENT);
        if command.asked_in_palette(0).is_some() {
            let asking = Asking { is_from_list: true, ..Asking::new(command, Vec::new()) };
            let query = match asking.path_use() {
                None => String::new(),
                Some(PathUse::New) => app.session.first_text(None, &app.session.offered_name()),
                Some(_) => app.session.first_text(None, ""),
            };
            *self = Self { query, asking: Some(asking), ..Self::default() };
            return true;
        }
        app.act(command.id, &[], ui.ctx());
        false
    }

    fn take_argument(&mut self, app: &mut App, ui: &Ui, word: String) -> bool {
        let Some(asking) = &mut self.asking else { return false };
        let Some(argument) = asking.argument() else { return false };
        let mut word = word;
        if let Some(use_) = asking.path_use() {
            if let Some(what) = path_problem(app, &word, use_) {
                asking.error = sentence(&what);
                return true;
            }
            let path = app.session.typed_path(&word);
            if use_ == PathUse::New && path.is_file() && asking.replaces.as_ref() != Some(&word) {
                let (_, name) = split_typed(&word);
                asking.error = format!("{name} exists; press Enter once more to overwrite it");
                asking.replaces = Some(word);
                return true;
            }
            word = path.to_string_lossy().into_owned();
        }
        match argument.kind.read_typed(app, &word) {
            Ok(word) => asking.given.push(word),
            Err(what) => {
                asking.error = sentence(&what);
                return true;
            }
        }
        asking.choices = None;
        if asking.rest.is_empty() && asking.command.asked_in_palette(asking.given.len()).is_some() {
            self.query.clear();
            self.at = 0;
            return true;
        }
        let given: Vec<&str> = asking.given.iter().chain(&asking.rest).map(String::as_str).collect();
        app.act(asking.command.id, &given, ui.ctx());
        false
    }

    // Appearance.

    fn show_in(&mut self, ui: &mut Ui, lines: &[Line]) -> Option<Act> {
        let id = Id::unique("command palette");
        let screen = ui.ctx().content_rect();
        let area = Modal::default_area(id).anchor(Align2::CENTER_TOP, vec2(0.0, TOP.min(screen.height() * 0.08)));
        let frame = egui::Frame::window(ui.style()).inner_margin(egui::Margin::same(0));
        let backdrop = Color32::from_black_alpha(if ui.visuals().dark_mode { 90 } else { 40 });
        let modal = Modal { area, ..Modal::new(id).frame(frame).backdrop_color(backdrop) };
        let response = modal.show(ui.ctx(), |ui| {
            ui.set_width(WIDTH.min(screen.width() - 40.0).max(0.0));
            ui.spacing_mut().item_spacing = Vec2::ZERO;
            let keys = self.take_keys(ui, lines.len());
            self.show_field(ui);
            hairline_in(ui);
            let clicked = self.show_list(ui, lines, screen.height() - 200.0);
            hairline_in(ui);
            self.show_foot(ui, lines);
            clicked.or(keys)
        });
        // Escape was handled above: it goes back one step.
        response.inner.or(response.backdrop_response.clicked().then_some(Act::Close))
    }

    /// The keys not needed by the text field.
    fn take_keys(&mut self, ui: &Ui, number: usize) -> Option<Act> {
        let pressed = |key: Key| ui.input_mut(|input| input.count_and_consume_key(Modifiers::NONE, key));
        let before = self.at;
        self.at = self.at.min(number.saturating_sub(1));
        let steps =
            [(Key::ArrowDown, 1), (Key::ArrowUp, -1), (Key::PageDown, ROWS as isize), (Key::PageUp, -(ROWS as isize))];
        for (key, step) in steps {
            for _ in 0..pressed(key) {
                self.at = match self.at.checked_add_signed(step) {
                    // Single steps wrap around; pages stop at the end.
                    Some(at) if at >= number && step == 1 => 0,
                    Some(at) => at.min(number.saturating_sub(1)),
                    None if step == -1 => number.saturating_sub(1),
                    None => 0,
                };
            }
        }
        self.is_stepped = before != self.at;
        if pressed(Key::Escape) > 0 {
            return Some(Act::Back);
        }
        let path_use = self.asking.as_ref().and_then(Asking::path_use);
        if path_use.is_some() && pressed(Key::Tab) > 0 && number > 0 {
            return Some(Act::Complete(self.at));
        }
        if pressed(Key::Enter) > 0 {
            if path_use.is_some() && number > 0 {
                return Some(Act::Take(self.at));
            }
            let is_free = self.asking.as_ref().is_some_and(Asking::is_free);
            return if is_free { Some(Act::TakeText) } else { (number > 0).then_some(Act::Take(self.at)) };
        }
        None
    }

    fn show_field(&mut self, ui: &mut Ui) {
        let asked = self.asking.as_ref().and_then(|asking| Some((asking, asking.argument()?)));
        let (hint, name) = match asked {
            Some((asking, argument)) => {
                let asked = argument.asked(self.units);
                (sentence(&asked), format!("{}: {asked}", asking.command.plain_title()))
            }
            None => ("Find a command".to_owned(), "Find a command".to_owned()),
        };
        let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), HEAD), Sense::hover());
        let mut left = rect.left() + 16.0;
        let colours = colours(ui);
        if let Some(asking) = &self.asking {
            // What is being asked for: the command, and the arguments given.
            let title = FontId::new(theme::BODY, theme::semibold());
            let mut job = LayoutJob::single_section(
                asking.command.plain_title().to_owned(),
                TextFormat::simple(title, colours.accent),
            );
            for word in Some(&asking.about).filter(|about| !about.is_empty()).into_iter().chain(&asking.given) {
                job.append(word, 8.0, TextFormat::simple(FontId::proportional(theme::BODY), colours.text));
            }
            // The field keeps half of the line.
            job.wrap.max_width = rect.width() / 2.0;
            job.wrap.max_rows = 1;
            job.wrap.break_anywhere = true;
            let galley = ui.painter().layout_job(job);
            let size = galley.rect.size() + vec2(16.0, 10.0);
            let chip = Rect::from_min_size(pos2(left, (rect.center().y - size.y / 2.0).round()), size);
            ui.painter().rect_filled(chip, theme::RADIUS, colours.accent_soft);
            ui.painter().galley(chip.min + vec2(8.0, 5.0), galley, colours.text);
            left = chip.right() + 6.0;
        } else {
            let square = Rect::from_center_size(pos2(left + ICON / 2.0, rect.center().y), Vec2::splat(ICON));
            Icon::Search.paint(ui.painter(), square, colours.text_weak);
            left += ICON + 6.0;
        }
        let field = Rect::from_min_max(pos2(left, rect.top() + 8.0), pos2(rect.right() - 12.0, rect.bottom() - 8.0));
        let field_id = Id::unique("command palette's text");
        // Before it is shown: without the keyboard a field forgets what is selected.
        ui.memory_mut(|memory| memory.request_focus(field_id));
        if !std::mem::replace(&mut self.is_shown, true) {
            // The cursor may be anywhere, left from an earlier palette.
            let text = &self.query;
            match self.asking.as_ref().and_then(Asking::path_use) {
                None => select_all(ui.ctx(), field_id, text),
                // Of a new file its name without the ending; behind a folder.
                Some(_) => {
                    let (folder, name) = split_typed(text);
                    let count = |text: &str| text.chars().count();
                    let from = count(folder);
                    select(ui.ctx(), field_id, from..from + count(crate::formats::file_stem(name)));
                }
            }
        }
        if std::mem::take(&mut self.is_completed) {
            let end = self.query.chars().count();
            select(ui.ctx(), field_id, end..end);
        }
        let edit = TextEdit::singleline(&mut self.query)
            .id(field_id)
            .frame(egui::Frame::NONE)
            .margin(egui::Margin::symmetric(4, 4))
            .font(FontId::proportional(theme::TITLE))
            // Tab completes.
            .lock_focus(true)
            .hint_text(RichText::new(hint).color(colours.text_weak))
            .align(Align2::LEFT_CENTER)
            .min_size(field.size())
            .desired_width(field.width());
        let mut line = ui.new_child(UiBuilder::new().max_rect(field));
        let response = line.put(field, edit).accessible_name(name);
        // Nothing else here gets the keyboard.
        response.request_focus();
        if response.changed() {
            self.at = 0;
            self.is_stepped = true;
            if let Some(asking) = &mut self.asking {
                asking.error.clear();
                asking.replaces = None;
            }
        }
    }

    fn show_list(&self, ui: &mut Ui, lines: &[Line], most_height: f32) -> Option<Act> {
        let mut act = None;
        if lines.is_empty() {
            let query = self.query.trim();
            let text = match &self.asking {
                None => format!("No command fits ‘{query}’"),
                Some(asking) if asking.is_free() => {
                    let argument = asking.argument();
                    let name = argument.map_or("", |argument| argument.name).to_lowercase();
                    let asked = argument.map(|argument| argument.asked(self.units)).unwrap_or_default();
                    format!("{}: {asked}", sentence(&name))
                }
                Some(_) => format!("Nothing fits ‘{query}’"),
            };
            let font = FontId::proportional(theme::BODY);
            let weak = colours(ui).text_weak;
            let galley = ui.painter().layout(text.clone(), font, weak, (ui.available_width() - 32.0).max(80.0));
            let height = (galley.rect.height() + 20.0).max(2.0 * ROW);
            let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), height), Sense::hover());
            put(ui, galley, rect.left() + 16.0, rect.center().y);
            response.widget_info(|| WidgetInfo::labeled(Role::Label, true, &text));
            return None;
        }
        let rows = (lines.len().min(ROWS) as f32).min((most_height / ROW).floor()).max(3.0);
        egui::Frame::new().inner_margin(egui::Margin::symmetric(6, 6)).show(ui, |ui| {
            let area = ScrollArea::vertical().id_salt("lines").auto_shrink([false, true]);
            area.min_scrolled_height(rows * ROW).max_height(rows * ROW).show_viewport(ui, |ui, seen| {
                // Lay out only what is visible: a plan may have thousands of rooms.
                ui.set_height(lines.len() as f32 * ROW);
                let place = |index: usize| {
                    let min = ui.max_rect().min + vec2(0.0, index as f32 * ROW);
                    Rect::from_min_size(min, vec2(ui.available_width(), ROW))
                };
                if self.is_stepped {
                    ui.scroll_to_rect(place(self.at), None);
                }
                let first = (seen.top() / ROW).floor().max(0.0) as usize;
                let last = (seen.bottom() / ROW).ceil().max(0.0) as usize;
                for (index, line) in lines.iter().enumerate().take(last).skip(first) {
                    if row(ui, place(index), index, line, index == self.at).clicked() {
                        act = Some(Act::Take(index));
                    }
                }
            });
        });
        act
    }

    /// A description of the chosen line, or what is wrong.
    fn show_foot(&self, ui: &mut Ui, lines: &[Line]) {
        let error = self.asking.as_ref().map(|asking| asking.error.as_str()).filter(|error| !error.is_empty());
        let colours = colours(ui);
        let (text, colour) = match (error, lines.get(self.at), &self.asking) {
            (Some(error), _, _) => (error.to_owned(), colours.error),
            (None, Some(Line { taken: Taken::Command(command), .. }), _) => {
                (command.help.to_owned(), colours.text_weak)
            }
            (None, _, Some(asking)) if asking.path_use().is_some() => {
                ("Tab completes, Enter accepts the marked line".to_owned(), colours.text_weak)
            }
            (None, _, Some(asking)) => (asking.command.help.to_owned(), colours.text_weak),
            (None, _, None) => (String::new(), colours.text_weak),
        };
        let back =
            if self.asking.as_ref().is_some_and(|asking| asking.is_from_list) { "Esc goes back" } else { "Esc closes" };
        let small = FontId::proportional(theme::SMALL);
        let width = ui.painter().layout_no_wrap(back.to_owned(), small.clone(), colours.text_weak).rect.width();
        // As many lines as it takes: what is wrong, and what would be right, is read to its end.
        let most = (ui.available_width() - 48.0 - width).max(80.0);
        let galley = ui.painter().layout(text.clone(), small.clone(), colour, most);
        let height = (galley.rect.height() + 20.0).max(34.0);
        let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), height), Sense::hover());
        let inner = rect.shrink2(vec2(16.0, 0.0));
        let right = Rect::from_min_max(pos2(inner.right() - width, inner.top()), inner.max);
        put_line(ui, back, small.clone(), colours.text_weak, right);
        put(ui, galley, inner.left(), inner.center().y);
        let role = if error.is_some() { Role::Alert } else { Role::Status };
        response.widget_info(|| WidgetInfo::labeled(role, true, &text));
    }
}
