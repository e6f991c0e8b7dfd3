//! The sheet of shortcuts: all of them by menu, with a way to change each.

use crate::app::state::dialogs;
use egui::epaint::StrokeKind;
use egui::{
    Color32, Event, EventFilter, FontId, Id, Key, Modal, Rect, Response, RichText, Role, ScrollArea, Sense, Stroke,
    TextEdit, Ui, UiBuilder, Vec2, WidgetInfo, pos2, vec2,
};

use crate::app::commands::{self, COMMANDS, Command, CommandError, Menu};
use crate::app::look::{
    icons::Icon,
    keys::Keys,
    search::Search,
    theme,
    widgets::{
        ICON, caption, colours, dialog_frame, focus_ring, follow_focus, icon_button, put_line, right, strong,
        text_button,
    },
};
use crate::app::state::App;
use crate::app::state::{After, Dialog, Entry};

/// The open sheet.
#[derive(Default)]
pub(crate) struct Sheet {
    query: String,
    /// The command that is waiting for its new keys.
    changing: Option<&'static str>,
    /// The result of the last change, or why it was refused.
    said: Option<Said>,
    /// Whether it has been shown: the first time, the search gets the keyboard.
    is_shown: bool,
}

struct Said {
    text: String,
    is_error: bool,
}

/// A user action.
enum Act {
    Change(&'static Command),
    Set(&'static Command, Option<Keys>),
    /// Stop waiting for keys.
    GiveUp,
    Reset(&'static Command),
    ResetAll,
    Close,
}

/// Height of a line of the sheet, in points.
const LINE: f32 = 25.0;

/// Space between two menus in a column.
const BETWEEN: f32 = 10.0;

/// Commands of a menu.
type Group = (Menu, Vec<&'static Command>);

/// Width of a column, and the space between columns.
const COLUMN: f32 = 300.0;
const GAP: f32 = 28.0;

/// The menus in each column, by the number of columns: about as many lines in each.
const COLUMNS: [&[&[Menu]]; 3] = [
    &[&Menu::ALL],
    &[
        &[Menu::File, Menu::Edit, Menu::Draw, Menu::Modify, Menu::Help],
        &[Menu::Room, Menu::Picture, Menu::Predict, Menu::Dataset, Menu::Robot, Menu::View],
    ],
    &[
        &[Menu::File, Menu::Edit, Menu::Draw, Menu::Help],
        &[Menu::Modify, Menu::Room, Menu::Picture],
        &[Menu::Predict, Menu::Dataset, Menu::Robot, Menu::View],
    ],
];

pub(super) const ENTRY: Entry = Entry { id: ID, make: |_, _| Box::new(Sheet::default()), is_of_plan: false };

pub(crate) const ID: &str = dialogs::SHORTCUTS;

impl Dialog for Sheet {
    fn show(&mut self, app: &mut App, ui: &mut Ui) -> After {
        if app.session.question.is_some() {
            return After::Close;
        }
        let Some(act) = self.show_in(app, ui) else { return After::Stay };
        let after = self.take(app, ui, act);
        ui.request_repaint();
        after
    }
}

fn said(ran: Result<(), CommandError>, done: String) -> Said {
    match ran {
        Ok(()) => Said { text: done, is_error: false },
        Err(CommandError::NotNow { reason, .. }) => Said { text: reason, is_error: true },
        Err(error) => Said { text: error.to_string(), is_error: true },
    }
}

impl Sheet {
    /// Performs a user action, by commands, as a script does.
    fn take(&mut self, app: &mut App, ui: &Ui, act: Act) -> After {
        let (said, changing) = match act {
            Act::Close => return After::Close,
            Act::Change(command) => (None, Some(command.id)),
            Act::GiveUp => (None, None),
            Act::Set(command, keys) => {
                let word = keys.map(|keys| keys.to_string());
                let ran = match &word {
                    Some(keys) => app.run_command_with("set-shortcut", &[command.id, keys], ui.ctx()),
                    None => app.run_command_with("remove-shortcut", &[command.id], ui.ctx()),
                };
                let done = match keys {
                    Some(keys) => format!("{} is now the shortcut of '{}'", keys.text(ui.ctx()), command.plain_title()),
                    None => format!("'{}' no longer has a shortcut", command.plain_title()),
                };
                let waits = ran.is_err().then_some(command.id);
                (Some(said(ran, done)), waits)
            }
            Act::Reset(command) => {
                let ran = app.run_command_with("reset-shortcut", &[command.id], ui.ctx());
                (Some(said(ran, format!("'{}' has its original shortcut again", command.plain_title()))), None)
            }
            Act::ResetAll => {
                let ran = app.run_command_with("reset-shortcuts", &[], ui.ctx());
                (Some(said(ran, "All commands have their original shortcuts".to_owned())), None)
            }
        };
        (self.said, self.changing) = (said, changing);
        After::Stay
    }

    fn show_in(&mut self, app: &App, ui: &mut Ui) -> Option<Act> {
        let screen = ui.ctx().content_rect();
        let frame = dialog_frame(ui);
        let outer = screen.width() - 80.0 - 2.0 * 22.0;
        let columns = (((outer + GAP) / (COLUMN + GAP)).floor() as usize).clamp(1, COLUMNS.len());
        let width = (columns as f32 * (COLUMN + GAP) - GAP).min(outer);
        let response = Modal::new(Id::unique("shortcuts")).frame(frame).show(ui.ctx(), |ui| {
            ui.set_width(width);
            let mut act = self.take_keys(ui);
            ui.horizontal(|ui| {
                ui.label(strong("Shortcuts", theme::TITLE));
                right(ui, |ui| {
                    if icon_button(ui, Icon::Close, "Close", None).clicked() {
                        act = Some(Act::Close);
                    }
                    self.show_search(ui);
                });
            });
            ui.add_space(2.0);
            self.show_said(ui);
            ui.add_space(8.0);
            let height = (screen.height() - 190.0).max(120.0);
            let columns = self.columns(app, ui, COLUMNS[columns - 1]);
            let wanted = columns.iter().map(|column| height_of(column)).fold(LINE, f32::max);
            let area = ScrollArea::vertical().min_scrolled_height(wanted.min(height)).max_height(height);
            area.auto_shrink([false, true]).show(ui, |ui| {
                // The scroll bar lies over the contents.
                let bar = if wanted > height { 14.0 } else { 0.0 };
                act = self.show_columns(app, ui, &columns, wanted, bar).or(act.take());
            });
            ui.add_space(10.0);
            ui.horizontal(|ui| {
                let is_any = app.session.settings.is_any_changed();
                let reset = ui.add_enabled_ui(is_any, |ui| text_button(ui, "Reset all", false)).inner;
                if reset.clicked() {
                    act = Some(Act::ResetAll);
                }
                right(ui, |ui| {
                    if text_button(ui, "Done", true).clicked() {
                        act = Some(Act::Close);
                    }
                });
            });
            act
        });
        self.is_shown = true;
        let leaves = self.changing.is_none() && response.should_close();
        response.inner.or(leaves.then_some(Act::Close))
    }

    fn show_search(&mut self, ui: &mut Ui) {
        let edit = TextEdit::singleline(&mut self.query)
            .id(Id::unique("search of shortcuts"))
            .hint_text(RichText::new("Search").color(colours(ui).text_weak))
            .align(egui::Align2::LEFT_CENTER)
            .desired_width(180.0);
        let response = ui.add(edit).accessible_name("Search shortcuts");
        if !self.is_shown {
            response.request_focus();
        }
    }

    /// How to change a shortcut, or the result of changing it.
    fn show_said(&self, ui: &mut Ui) {
        match &self.said {
            Some(Said { text, is_error }) => {
                let colours = colours(ui);
                let (ground, ink) =
                    if *is_error { (colours.error_soft, colours.error) } else { (colours.info_soft, colours.text) };
                let frame = egui::Frame::new().fill(ground).corner_radius(theme::RADIUS);
                let shown = frame.inner_margin(egui::Margin::symmetric(10, 6)).show(ui, |ui| {
                    ui.set_width(ui.available_width().max(0.0));
                    let text = if *is_error { format!("{text}. Press other keys, or Esc.") } else { text.clone() };
                    ui.label(RichText::new(text).color(ink));
                });
                let role = if *is_error { Role::Alert } else { Role::Status };
                shown.response.widget_info(|| WidgetInfo::labeled(role, true, text));
            }
            None => {
                caption(ui, "Click the keys of a command to change them. Backspace removes them.");
            }
        }
    }

    /// The keys being waited for.
    fn take_keys(&self, ui: &Ui) -> Option<Act> {
        let command = commands::find(self.changing?)?;
        ui.input_mut(|input| {
            let mut act = None;
            input.events.retain(|event| {
                let (key, modifiers) = match event {
                    Event::Key { key, pressed: true, modifiers, .. } => (*key, *modifiers),
                    // The system reports these as events of their own.
                    Event::Copy => (Key::C, egui::Modifiers::COMMAND),
                    Event::Cut => (Key::X, egui::Modifiers::COMMAND),
                    Event::Paste(_) => (Key::V, egui::Modifiers::COMMAND),
                    _ => return true,
                };
                act = act.take().or(match Keys::new(modifiers, key) {
                    _ if is_modifier(key) => None,
                    _ if key == Key::Escape => Some(Act::GiveUp),
                    _ if key == Key::Backspace && modifiers.is_none() => Some(Act::Set(command, None)),
                    keys => Some(Act::Set(command, Some(keys))),
                });
                false
            });
            act
        })
    }

    /// The matching commands, by column and menu.
    fn columns(&self, app: &App, ui: &Ui, columns: &[&[Menu]]) -> Vec<Vec<Group>> {
        let mut search = Search::new(&self.query);
        let mut group = |menu: &Menu| -> Option<Group> {
            let mut is_wanted = |command: &&Command| {
                // By its title, or its menu and keys.
                let elsewhere = format!("{} {}", menu.title(), app.keys_text(command, ui.ctx()));
                search.hit(command.plain_title()).is_some() || search.hit(&elsewhere).is_some()
            };
            let commands = COMMANDS.iter().filter(|command| command.menu.is_some_and(|(of, _)| of == *menu));
            let commands: Vec<&'static Command> = commands.filter(|command| is_wanted(command)).collect();
            (!commands.is_empty()).then_some((*menu, commands))
        };
        columns.iter().map(|menus| menus.iter().filter_map(&mut group).collect()).collect()
    }

    fn show_columns(&self, app: &App, ui: &mut Ui, columns: &[Vec<Group>], height: f32, bar: f32) -> Option<Act> {
        let mut act = None;
        let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), height), Sense::hover());
        let width = (rect.width() - bar + GAP) / columns.len() as f32 - GAP;
        for (index, groups) in columns.iter().enumerate() {
            let min = pos2((rect.left() + index as f32 * (width + GAP)).round(), rect.top());
            let place = Rect::from_min_size(min, vec2(width, height));
            let mut column = ui.new_child(UiBuilder::new().max_rect(place).id_salt(("column", index)));
            column.spacing_mut().item_spacing = Vec2::ZERO;
            for (position, (menu, commands)) in groups.iter().enumerate() {
                if position > 0 {
                    column.add_space(BETWEEN);
                }
                let (title, response) = column.allocate_exact_size(vec2(width, LINE), Sense::hover());
                let font = FontId::new(theme::SMALL, theme::semibold());
                put_line(&column, menu.title(), font, colours(&column).text_weak, title);
                response.widget_info(|| WidgetInfo::labeled(Role::Label, true, menu.title()));
                for command in commands {
                    act = self.line(app, &mut column, command).or(act.take());
                }
            }
        }
        if columns.iter().all(Vec::is_empty) {
            let text = format!("No command fits ‘{}’", self.query.trim());
            put_line(ui, &text, FontId::proportional(theme::BODY), colours(ui).text_weak, rect);
        }
        act
    }

    /// A command with its keys, which are a button.
    fn line(&self, app: &App, ui: &mut Ui, command: &'static Command) -> Option<Act> {
        let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), LINE), Sense::hover());
        let is_changing = self.changing == Some(command.id);
        let is_changed = app.session.settings.is_changed(command.id);
        let texts: Vec<String> =
            app.session.settings.keys_of(command.id).iter().map(|keys| keys.text(ui.ctx())).collect();
        let mut act = None;
        let shown = if is_changing { "Press keys…".to_owned() } else { texts.first().cloned().unwrap_or_default() };
        let chip = self.chip(ui, rect, command, &shown, &texts.join(" or "), is_changing);
        if chip.clicked() && !is_changing {
            act = Some(Act::Change(command));
        }
        let mut left_of_chip = chip.rect.left();
        if is_changed && !is_changing {
            let square = Rect::from_center_size(pos2(left_of_chip - 14.0, rect.center().y), Vec2::splat(22.0));
            let id = ui.scope_id().with(("reset", command.id));
            let reset = ui.interact(square, id, Sense::click());
            let ground = if reset.hovered() { colours(ui).hover } else { Color32::TRANSPARENT };
            ui.painter().rect_filled(square, theme::RADIUS, ground);
            let icon = Rect::from_center_size(square.center(), Vec2::splat(ICON - 2.0));
            Icon::Undo.paint(ui.painter(), icon, colours(ui).text_weak);
            focus_ring(ui, square, &reset);
            follow_focus(&reset);
            let name = format!("Reset the shortcut of {}", command.plain_title());
            reset.widget_info(|| WidgetInfo::labeled(Role::Button, true, &name));
            if reset.on_hover_text("Restore the original keys").clicked() {
                act = Some(Act::Reset(command));
            }
            left_of_chip = square.left();
        }
        let title = Rect::from_min_max(rect.min, pos2(left_of_chip - 8.0, rect.bottom()));
        put_line(ui, command.plain_title(), FontId::proportional(theme::BODY), colours(ui).text, title);
        response.on_hover_text(command.help);
        act
    }

    /// The keys of a command at the end of its line.
    fn chip(
        &self,
        ui: &Ui,
        line: Rect,
        command: &'static Command,
        shown: &str,
        all: &str,
        is_changing: bool,
    ) -> Response {
        let colours = colours(ui);
        let font = FontId::proportional(theme::SMALL);
        let text = if shown.is_empty() { "–" } else { shown };
        let ink = if is_changing {
            colours.accent
        } else if shown.is_empty() {
            colours.text_weak
        } else {
            colours.text
        };
        let galley = ui.painter().layout_no_wrap(text.to_owned(), font, ink);
        let size = vec2((galley.rect.width() + 16.0).max(28.0), 20.0);
        let rect = Rect::from_min_size(pos2(line.right() - size.x, line.center().y - size.y / 2.0), size);
        let id = ui.scope_id().with(("keys", command.id));
        let response = ui.interact(rect.expand2(vec2(0.0, 2.0)), id, Sense::click());
        let (ground, rim) = match (is_changing, response.hovered() || response.has_focus()) {
            (true, _) => (colours.accent_soft, colours.accent),
            (false, true) => (colours.hover, colours.outline),
            (false, false) if shown.is_empty() => (Color32::TRANSPARENT, Color32::TRANSPARENT),
            (false, false) => (colours.field, colours.outline),
        };
        ui.painter().rect_filled(rect, 5.0, ground);
        ui.painter().rect_stroke(rect, 5.0, Stroke::new(1.0, rim), StrokeKind::Inside);
        let at = (rect.center() - galley.rect.size() / 2.0).round();
        ui.painter().galley(at, galley, ink);
        focus_ring(ui, rect.expand(2.0), &response);
        follow_focus(&response);
        if is_changing {
            // Tab and arrows now count as ordinary keys; Escape ends the waiting, not the sheet.
            let filter = EventFilter { tab: true, horizontal_arrows: true, vertical_arrows: true, escape: true };
            response.request_focus();
            ui.memory_mut(|memory| memory.set_focus_lock_filter(id, filter));
        }
        let keys = match (is_changing, all) {
            (true, _) => "press keys",
            (false, "") => "none",
            (false, all) => all,
        };
        let name = format!("Shortcut of {}: {keys}", command.plain_title());
        response.widget_info(|| WidgetInfo::labeled(Role::Button, true, &name));
        response
    }
}

/// Height of a column, in points.
fn height_of(groups: &[Group]) -> f32 {
    let lines = groups.iter().map(|(_, commands)| commands.len() + 1).sum::<usize>();
    lines as f32 * LINE + groups.len().saturating_sub(1) as f32 * BETWEEN
}

fn is_modifier(key: Key) -> bool {
    (Key::ShiftLeft..=Key::SuperRight).contains(&key)
}
