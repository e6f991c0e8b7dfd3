//! Naming and changing many rooms at once, with a preview.

use crate::app::state::dialogs;
use crate::app::value::{Call, Value};
use egui::{
    Align2, ComboBox, FontId, Id, Key, Modal, RichText, Role, ScrollArea, Sense, TextEdit, Ui, WidgetInfo, vec2,
};

use crate::app::commands::Choice;
use crate::app::look::{
    theme,
    widgets::{
        Lead, Row, Segment, caption, colours, dialog_frame, focus_ring, put_line, right, segmented, strong, swatch,
        text_button,
    },
};
use crate::app::session::bulk::{Change, Names, Order, Which};
use crate::app::state::App;
use crate::app::state::{After, Dialog, Entry, Purpose};
use crate::base::wording::{count, sentence};
use crate::draw::Palette;
use crate::edit::naming::{PARTS, PatternError};
use crate::features::RoomStatus;
use crate::labels::Label;
use crate::plan::titles::room_title;

/// Width of the dialogs, in points.
const WIDTH: f32 = 460.0;

/// Width of the captions before the controls.
const NAMES: f32 = 76.0;

/// A dialog for many rooms, while it is open.
pub(crate) enum Bulk {
    Name(NameForm),
    Change(ChangeForm),
}

/// The form for naming rooms.
pub(crate) struct NameForm {
    pattern: String,
    start: String,
    which: Which,
    order: Order,
    /// The rooms along a drawn line, with what they are called here.
    along: Option<(String, Which)>,
    /// Whether it has been shown: the first time, the pattern gets the keyboard.
    is_shown: bool,
}

/// The form for changing rooms.
pub(crate) struct ChangeForm {
    which: Which,
    /// The last function chosen for [`Which::Function`], and the last label for [`Which::Label`].
    from_function: String,
    from_label: Option<Label>,
    change: Change,
    to_function: String,
    to_label: Option<Label>,
    is_shown: bool,
}

/// How a dialog was closed.
enum End {
    Cancel,
    Do(Call),
}

impl Bulk {
    fn new(app: &App, purpose: Purpose) -> Self {
        match purpose {
            Purpose::NameRooms(which) => Self::naming_these(app, which),
            Purpose::ChangeRooms => Self::changing(app),
            Purpose::Usual | Purpose::Argument(_) | Purpose::Print => Self::naming(app),
        }
    }

    /// Names the selected rooms; if none, those without a name, or all.
    fn naming(app: &App) -> Self {
        let has = |which: &Which| !app.session.rooms_of(which).is_empty();
        let which = [Which::Selected, Which::Unnamed].into_iter().find(has).unwrap_or(Which::All);
        Self::naming_these(app, which)
    }

    /// Names rooms of one kind.
    fn naming_these(app: &App, which: Which) -> Self {
        let pattern = app.panels.pattern.clone().unwrap_or_else(|| "{function} {n}".to_owned());
        Self::Name(NameForm { pattern, start: "1".to_owned(), which, order: Order::Rows, along: None, is_shown: false })
    }

    /// Changes the selected rooms; if none, those with the most common function.
    fn changing(app: &App) -> Self {
        let from_function =
            app.session.function_choices().into_iter().next().map(|choice| choice.word).unwrap_or_default();
        let is_selected = !app.session.rooms_of(&Which::Selected).is_empty();
        let which = if is_selected { Which::Selected } else { Which::Function(from_function.clone()) };
        Self::Change(ChangeForm {
            which,
            from_function,
            from_label: Some(Label::MediumRoom),
            change: Change::Function(String::new()),
            to_function: String::new(),
            to_label: Some(Label::BigRoom),
            is_shown: false,
        })
    }
}

pub(super) const ENTRY: Entry =
    Entry { id: ID, make: |app, purpose| Box::new(Bulk::new(app, purpose)), is_of_plan: true };

pub(crate) const ID: &str = dialogs::BULK;

impl Dialog for Bulk {
    fn show(&mut self, app: &mut App, ui: &mut Ui) -> After {
        if app.session.question.is_some() || app.session.document.is_none() {
            return After::Close;
        }
        let response = Modal::new(Id::unique("many rooms")).frame(dialog_frame(ui)).show(ui.ctx(), |ui| {
            ui.set_width(WIDTH.min(ui.ctx().content_rect().width() - 80.0).max(0.0));
            match self {
                Self::Name(form) => form.show(app, ui),
                Self::Change(form) => form.show(app, ui),
            }
        });
        let is_closed = response.should_close();
        match response.inner.or(is_closed.then_some(End::Cancel)) {
            None => After::Stay,
            Some(End::Cancel) => After::Close,
            Some(End::Do(call)) => {
                if let Self::Name(form) = self {
                    app.panels.pattern = Some(form.pattern.clone());
                }
                app.act_on(call, ui.ctx());
                After::Close
            }
        }
    }
}

impl NameForm {
    fn show(&mut self, app: &App, ui: &mut Ui) -> Option<End> {
        ui.label(strong("Name rooms", theme::TITLE));
        ui.add_space(6.0);
        let numbers =
            [Which::Selected, Which::Unnamed, Which::All].map(|which| (app.session.rooms_of(&which).len(), which));
        let texts = numbers.each_ref().map(|(number, which)| match which {
            Which::Selected => format!("Selected ({number})"),
            Which::Unnamed => format!("Unnamed ({number})"),
            _ => format!("All ({number})"),
        });
        let along = match &self.which {
            Which::Along(_) => {
                Some((format!("Line ({})", app.session.rooms_of(&self.which).len()), self.which.clone()))
            }
            _ => self.along.take(),
        };
        let options: Vec<(&str, Which)> =
            texts.iter().map(String::as_str).zip(numbers.iter().map(|(_, which)| which.clone())).collect();
        let drawn = along.iter().map(|(text, which)| (text.as_str(), which.clone()));
        let options: Vec<(&str, Which)> = drawn.chain(options).collect();
        line(ui, "Rooms", |ui| choose(ui, &mut self.which, &options));
        self.along = along;
        if !matches!(self.which, Which::Along(_)) {
            line(ui, "Order", |ui| {
                choose(ui, &mut self.order, &[("Row by row", Order::Rows), ("Column by column", Order::Columns)]);
            });
        }
        let mut is_typed = false;
        line(ui, "Pattern", |ui| {
            is_typed = text(ui, "Pattern", &mut self.pattern, ui.available_width(), !self.is_shown)
        });
        self.is_shown = true;
        line(ui, "", |ui| {
            ui.spacing_mut().item_spacing = vec2(4.0, 4.0);
            ui.horizontal_wrapped(|ui| {
                for (part, help) in PARTS {
                    let chip = egui::Button::new(RichText::new(part).size(theme::SMALL)).min_size(vec2(0.0, 22.0));
                    let response = ui.add(chip);
                    focus_ring(ui, response.rect, &response);
                    if response.on_hover_text(help).clicked() {
                        self.pattern.push_str(part);
                    }
                }
            });
        });
        line(ui, "Start at", |ui| {
            is_typed |= text(ui, "Start at", &mut self.start, 64.0, false);
        });
        let start: Option<u32> = self.start.trim().parse().ok();
        let names = app.session.names_by(&self.pattern, &self.which, self.order, start.unwrap_or(1));
        ui.add_space(8.0);
        self.preview(app, ui, &names);
        let number = names.as_ref().map_or(0, |names| names.changed.len());
        let said = match (&names, start) {
            (Err(error), _) => Err(error.to_string()),
            (_, None) => Err("start with a whole number: 0, 1, 2, …".to_owned()),
            (Ok(names), _) => Ok(said_of_names(names, self.which == Which::Unnamed)),
        };
        let can = said.is_ok() && number > 0;
        let is_done = foot(ui, &said, &format!("Name {}", count(number, "room")), can);
        let is_done = is_done.or((is_typed && enter(ui) && can).then_some(true));
        is_done.map(|is_done| {
            if !is_done {
                return End::Cancel;
            }
            let start = Value::Count(start.unwrap_or(1) as usize);
            let (pattern, which) = (Value::Text(self.pattern.clone()), Value::Text(self.which.word()));
            End::Do(Call::new("name-rooms", [pattern, which, Value::word(self.order), start]))
        })
    }

    /// The current and new name of each room.
    fn preview(&self, app: &App, ui: &mut Ui, names: &Result<Names, PatternError>) {
        const ROW: f32 = 24.0;
        let Some(plan) = app.plan() else { return };
        let palette = app.session.palette(ui);
        let changed = names.as_ref().map(|names| names.changed.as_slice()).unwrap_or_default();
        egui::Frame::new().fill(colours(ui).field).corner_radius(theme::RADIUS).inner_margin(6).show(ui, |ui| {
            ui.spacing_mut().item_spacing.y = 0.0;
            let most = (ui.ctx().content_rect().height() - 420.0).clamp(3.0 * ROW, 8.0 * ROW);
            let area = ScrollArea::vertical().id_salt("names").auto_shrink(false).max_height(most);
            area.min_scrolled_height(most).show_rows(ui, ROW, changed.len().max(1), |ui, range| {
                if changed.is_empty() {
                    caption(ui, "No name would change.");
                }
                for (id, name) in changed.get(range).unwrap_or_default() {
                    let Some(room) = plan.room(*id) else { continue };
                    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), ROW), Sense::hover());
                    let status = RoomStatus::of(plan, &app.session.schemes, room);
                    swatch(ui, rect.left_center() + vec2(12.0, 0.0), theme::colour(palette.status(status)));
                    let body = FontId::proportional(theme::BODY);
                    let strong = FontId::new(theme::BODY, theme::semibold());
                    let before = room_title(room);
                    let middle = rect.left() + 26.0 + (rect.width() - 26.0) * 0.48;
                    let left = rect.with_min_x(rect.left() + 26.0).with_max_x(middle - 26.0);
                    put_line(ui, &before, body.clone(), colours(ui).text_weak, left);
                    let arrow = rect.with_min_x(middle - 20.0);
                    put_line(ui, "→", body, colours(ui).text_weak, arrow);
                    put_line(ui, name, strong, colours(ui).text, rect.with_min_x(middle + 4.0));
                    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, format!("{before} becomes {name}")));
                }
            });
        });
    }
}

impl ChangeForm {
    fn show(&mut self, app: &App, ui: &mut Ui) -> Option<End> {
        ui.label(strong("Change rooms", theme::TITLE));
        ui.add_space(6.0);
        let palette = app.session.palette(ui);
        let selected = app.session.rooms_of(&Which::Selected).len();
        let selected = format!("Selected ({selected})");
        let kinds = [
            (selected.as_str(), Which::Selected),
            ("With function", Which::Function(self.from_function.clone())),
            ("With label", Which::Label(self.from_label)),
            ("All", Which::All),
        ];
        line(ui, "Rooms", |ui| choose(ui, &mut self.which, &kinds));
        match self.which {
            Which::Function(_) => {
                line(ui, "", |ui| functions_of_plan(app, ui, &mut self.from_function));
                self.which = Which::Function(self.from_function.clone());
            }
            Which::Label(_) => {
                line(ui, "", |ui| labels(ui, palette, &mut self.from_label, "None", "Rooms without a label"));
                self.which = Which::Label(self.from_label);
            }
            _ => {}
        }
        let kinds = [("Function", Change::Function(self.to_function.clone())), ("Label", Change::Label(self.to_label))];
        line(ui, "Become", |ui| choose(ui, &mut self.change, &kinds));
        let mut is_typed = false;
        match self.change {
            Change::Function(_) => {
                is_typed = self.function(app, ui, palette);
                self.change = Change::Function(self.to_function.clone());
            }
            Change::Label(_) => {
                let by = "By function";
                line(ui, "", |ui| labels(ui, palette, &mut self.to_label, by, "The label of its function"));
                self.change = Change::Label(self.to_label);
            }
        }
        self.is_shown = true;
        ui.add_space(8.0);
        let (said, number) = app.session.said_of_change(&self.which, &self.change);
        let is_complete = self.change != Change::Function(String::new());
        let said =
            if is_complete { Ok(said) } else { Ok(format!("{}…", said.trim_end_matches("‘’").trim_end())) };
        let can = is_complete && number > 0;
        let is_done = foot(ui, &said, &format!("Change {}", count(number, "room")), can);
        let is_done = is_done.or((is_typed && enter(ui) && can).then_some(true));
        is_done.map(|is_done| match is_done {
            true => {
                let values = [Value::Text(self.which.word()), Value::Text(self.change.word())];
                End::Do(Call::new("change-rooms", values))
            }
            false => End::Cancel,
        })
    }

    /// The function to give rooms: typed, or chosen from a list. Returns whether the field has the
    /// keyboard.
    fn function(&mut self, app: &App, ui: &mut Ui, palette: &Palette) -> bool {
        let mut is_typed = false;
        line(ui, "", |ui| {
            is_typed = text(ui, "New function", &mut self.to_function, ui.available_width(), !self.is_shown);
        });
        let mut search = crate::app::look::search::Search::new(&self.to_function);
        let is_chosen = |choice: &Choice| choice.word.eq_ignore_ascii_case(self.to_function.trim());
        let choices: Vec<Choice> = app.session.function_choices();
        let is_known = choices.iter().any(is_chosen);
        let shown: Vec<&Choice> =
            choices.iter().filter(|choice| is_known || search.hit(&choice.title).is_some()).collect();
        let mut chosen = None;
        line(ui, "", |ui| {
            ui.spacing_mut().item_spacing.y = 0.0;
            let height = 4.5 * crate::app::look::widgets::ROW;
            let area = ScrollArea::vertical().id_salt("functions").auto_shrink(false).max_height(height);
            area.min_scrolled_height(height).show_rows(
                ui,
                crate::app::look::widgets::ROW,
                shown.len().max(1),
                |ui, range| {
                    if shown.is_empty() {
                        caption(ui, "The label scheme does not know this function.");
                    }
                    for choice in shown.get(range).unwrap_or_default() {
                        let status = choice.status.unwrap_or(RoomStatus::Unlabelled);
                        let lead = Lead::Swatch(theme::colour(palette.status(status)));
                        let row = Row::new(lead, &choice.title).trail(&choice.trail).selected(is_chosen(choice));
                        if row.button(ui, Role::ListBoxOption).clicked() {
                            chosen = Some(choice.word.clone());
                        }
                    }
                },
            );
        });
        if let Some(chosen) = chosen {
            self.to_function = chosen;
        }
        is_typed
    }
}

/// A summary of the naming, in a sentence without its full stop.
fn said_of_names(Names { changed, kept }: &Names, are_unnamed: bool) -> String {
    let verb = if changed.len() == 1 { "gets" } else { "get" };
    let what = if are_unnamed { "a name" } else { "another name" };
    let keep = match kept {
        0 => String::new(),
        1 => ", 1 keeps its name".to_owned(),
        kept => format!(", {kept} keep theirs"),
    };
    format!("{} {verb} {what}{keep}", count(changed.len(), "room"))
}

/// A line of the form: a caption, and the control in the rest.
fn line(ui: &mut Ui, name: &str, control: impl FnOnce(&mut Ui)) {
    ui.horizontal_top(|ui| {
        let (rect, _) = ui.allocate_exact_size(vec2(NAMES, 28.0), Sense::hover());
        let font = FontId::proportional(theme::BODY);
        ui.painter().text(rect.left_center(), Align2::LEFT_CENTER, name, font, colours(ui).text_weak);
        ui.vertical(control);
    });
}

/// A choice of one of several, by name.
fn choose<T: Clone + PartialEq>(ui: &mut Ui, value: &mut T, options: &[(&str, T)]) {
    let segments: Vec<Segment<'_>> = options
        .iter()
        .map(|(text, option)| Segment { text, name: text, help: text, is_on: value == option, colour: None })
        .collect();
    if let Some(index) = segmented(ui, &segments) {
        *value = options[index].1.clone();
    }
}

/// The five labels, and an option for none of them.
fn labels(ui: &mut Ui, palette: &Palette, value: &mut Option<Label>, none: &str, none_help: &str) {
    let mut segments: Vec<Segment<'_>> = Label::ALL
        .into_iter()
        .map(|label| Segment {
            text: label.letter(),
            name: label.name(),
            help: label.name(),
            is_on: *value == Some(label),
            colour: Some(theme::colour(palette.label(label))),
        })
        .collect();
    segments.push(Segment { text: none, name: none, help: none_help, is_on: value.is_none(), colour: None });
    // Two of them may be in one form.
    if let Some(index) = ui.push_id(none, |ui| segmented(ui, &segments)).inner {
        *value = Label::ALL.get(index).copied();
    }
}

/// A text field; returns whether it has, or had until Enter, the keyboard.
fn text(ui: &mut Ui, name: &str, value: &mut String, width: f32, takes_focus: bool) -> bool {
    let edit = TextEdit::singleline(value).id(Id::unique(("many rooms", name))).desired_width(width);
    let response = ui.add(edit.align(Align2::LEFT_CENTER)).accessible_name(name);
    if takes_focus {
        response.request_focus();
    }
    response.has_focus() || response.lost_focus()
}

/// The functions of the plan's rooms, with their counts.
fn functions_of_plan(app: &App, ui: &mut Ui, function: &mut String) {
    let number = app.session.rooms_of(&Which::Function(String::new())).len();
    let none = Choice {
        word: String::new(),
        title: "No function".to_owned(),
        detail: String::new(),
        trail: count(number, "room"),
        status: None,
    };
    let mut choices: Vec<Choice> =
        app.session.function_choices().into_iter().filter(|choice| !choice.trail.is_empty()).collect();
    if number > 0 {
        choices.push(none);
    }
    let current = choices.iter().find(|choice| choice.word == *function);
    let current = current.map_or_else(|| sentence(function), |choice| format!("{} ({})", choice.title, choice.trail));
    let list = ComboBox::from_id_salt("functions of the plan").width(ui.available_width());
    let shown = list.selected_text(&current).show_ui(ui, |ui| {
        for choice in &choices {
            let text = format!("{} ({})", choice.title, choice.trail);
            if ui.selectable_label(choice.word == *function, text).clicked() {
                function.clone_from(&choice.word);
            }
        }
    });
    focus_ring(ui, shown.response.rect, &shown.response);
    shown.response.widget_info(|| WidgetInfo::labeled(Role::ComboBox, true, format!("Function: {current}")));
}

/// The summary and the buttons. Returns `true` for the main one, `false` for the other.
fn foot(ui: &mut Ui, said: &Result<String, String>, title: &str, can: bool) -> Option<bool> {
    let (text, colour) = match said {
        Ok(said) => (format!("{said}."), colours(ui).text),
        Err(error) => (sentence(&format!("{error}.")), colours(ui).error),
    };
    ui.add(egui::Label::new(strong(text, theme::BODY).color(colour)).wrap());
    ui.add_space(12.0);
    let mut act = None;
    ui.horizontal(|ui| {
        right(ui, |ui| {
            if ui.add_enabled_ui(can, |ui| text_button(ui, title, true)).inner.clicked() {
                act = Some(true);
            }
            if text_button(ui, "Cancel", false).clicked() {
                act = Some(false);
            }
        });
    });
    act
}

fn enter(ui: &Ui) -> bool {
    ui.input(|input| input.key_pressed(Key::Enter))
}
