//! Menus: their rows, which come from the table of commands, the context menus, and how the keyboard opens them.

use egui::{
    Context, Event, Id, Key, Modifiers, Popup, PopupCloseBehavior, PopupKind, RectAlign, Response, Role, ScrollArea, Ui,
};

use crate::app::commands::{self, COMMANDS, Command, Menu, On};
use crate::app::look::widgets::{Lead, Row, put_line};
use crate::app::look::{theme, widgets::colours};
use crate::app::paint::places::canvas_id;
use crate::app::state::{App, Thing};
use crate::app::value::{Call, Value};
use crate::base::wording::sentence;
use crate::plan::{ElementId, GuideAxis, Plan, titles::title_of};

/// Width of a menu, in points.
const WIDTH: f32 = 260.0;

/// What a menu keeps free below it, in points: its frame, and a little of the window.
const EDGE: f32 = 20.0;

/// A menu is never lower, in points.
const LEAST_HEIGHT: f32 = 100.0;

/// Shows the entries of a menu in a popup that begins below `top`, no higher than the window, so that all can be
/// reached.
pub(super) fn menu(app: &mut App, ui: &mut Ui, menu: Menu, top: f32) {
    let commands = COMMANDS.iter().filter(|command| command.menu.is_some_and(|(of, _)| of == menu));
    let height = ui.ctx().content_rect().bottom() - top - EDGE;
    list(app, ui, commands, height, &[]);
}

/// Shows commands as the rows of a menu. `about` says what the menu is about, for those that take it first.
fn list<'a>(app: &mut App, ui: &mut Ui, commands: impl Iterator<Item = &'a Command>, height: f32, about: &[Value]) {
    ui.set_width(WIDTH);
    let height = height.max(LEAST_HEIGHT);
    let area = ScrollArea::vertical().min_scrolled_height(height).max_height(height).auto_shrink([false, true]);
    area.show(ui, |ui| {
        ui.set_width(WIDTH);
        ui.spacing_mut().item_spacing.y = 0.0;
        let mut section = None;
        let mut shown: Vec<(Response, String)> = Vec::new();
        for command in commands {
            let rows = command.rows(app);
            if rows.as_ref().is_some_and(Vec::is_empty) {
                continue;
            }
            if section.is_some_and(|section| section != command.menu) {
                ui.separator();
            }
            section = Some(command.menu);
            if let Some(rows) = rows {
                for (choice, is_on) in rows {
                    let response = Row::new(Lead::Tick(is_on), &choice.title).button(ui, Role::MenuItem);
                    let response = response.on_hover_text(&choice.detail);
                    if response.clicked() {
                        let context = ui.ctx().clone();
                        app.act(command.id, &[&choice.word], &context);
                        ui.close();
                    }
                    shown.push((response, choice.title));
                }
                continue;
            }
            let response = row(app, ui, command, about);
            if response.enabled() {
                shown.push((response, command.title.to_owned()));
            }
        }
        // Opened by a key, the menu has the keyboard on its first entry; a letter goes to the next that begins so.
        if !ui.is_sizing_pass() {
            if std::mem::take(&mut app.panels.menu_takes_keyboard)
                && let Some((first, _)) = shown.first()
            {
                first.request_focus();
            }
            go_to_letter(ui, &shown);
        }
    });
}

fn row(app: &mut App, ui: &mut Ui, command: &Command, about: &[Value]) -> Response {
    let why_not = command.why_not(app);
    let shortcut = app.keys_text(command, ui.ctx());
    let is_on = command.is_on(app) == Some(true);
    let row = Row::new(Lead::Tick(is_on), command.title).trail(&shortcut);
    let response = ui.add_enabled_ui(why_not.is_none(), |ui| row.button(ui, Role::MenuItem)).inner;
    ui.ctx().accesskit_node_builder(response.id, |node| {
        if !shortcut.is_empty() {
            node.set_keyboard_shortcut(shortcut.as_str());
        }
    });
    let response = match why_not {
        Some(why_not) => response.on_disabled_hover_text(sentence(why_not)),
        None => response,
    };
    if response.clicked() {
        let context = ui.ctx().clone();
        match about {
            // Those that take less, such as a switch, are not about this one thing.
            [_, ..] if command.arguments.len() >= about.len() => {
                app.act_on(Call { id: command.id, values: about.to_vec() }, &context);
            }
            _ => drop(app.run_command(command.id, &context)),
        }
        ui.close();
    }
    response
}

fn go_to_letter(ui: &Ui, rows: &[(Response, String)]) {
    let typed = ui.input(|input| {
        input.events.iter().find_map(|event| match event {
            Event::Text(text) if !input.modifiers.any() || input.modifiers.shift_only() => text.chars().next(),
            _ => None,
        })
    });
    let Some(letter) = typed.and_then(|letter| letter.to_lowercase().next()) else { return };
    let begins = |title: &str| title.chars().next().is_some_and(|first| first.to_lowercase().next() == Some(letter));
    let after = rows.iter().position(|(row, _)| row.has_focus()).map_or(0, |at| at + 1);
    let round = rows.iter().skip(after).chain(rows.iter().take(after));
    if let Some((row, _)) = round.into_iter().find(|(_, title)| begins(title)) {
        row.request_focus();
    }
}

// Context menus.

impl App {
    /// Opens the menu of what can be done with a thing, at a place of the window.
    pub(super) fn open_context_menu(&mut self, thing: Thing, at: egui::Pos2, context: &Context) {
        if let Thing::Element(element) = thing
            && !self.selection().contains(element)
        {
            // What the menu is about is what its commands are about.
            self.act_on(Call::new("select", [Value::Elements(vec![element])]), context);
        }
        // Each is a popup of its own: the press that opens it closes the one before.
        let number = self.panels.context_menu.as_ref().map_or(0, |(_, _, number)| number + 1);
        self.panels.context_menu = Some((thing, at, number));
        self.panels.menu_takes_keyboard = false;
        Popup::open_id(context, context_menu_id(number));
    }

    /// What a thing is in the table of commands.
    fn kind_of(&self, thing: &Thing) -> On {
        match thing {
            Thing::Free => On::FreeSpace,
            Thing::Guide(..) => On::Guide,
            Thing::Picture => On::Picture,
            Thing::Listed(_) => On::ListedPlan,
            Thing::Element(_) if self.selection().len() > 1 => On::Several,
            Thing::Element(ElementId::Room(_)) => On::Room,
            Thing::Element(ElementId::Wall(_)) => On::Wall,
            Thing::Element(ElementId::Opening(_)) => On::Opening,
            Thing::Element(ElementId::Corner(_)) => On::Corner,
            Thing::Element(ElementId::Dimension(_)) => On::Dimension,
        }
    }
}

/// The commands of a kind of thing: first those of the menu that is about it, and of a menu's sections those first that
/// are for few other things.
fn of_thing(kind: On) -> Vec<&'static Command> {
    let own = match kind {
        On::Room | On::Several => Menu::Room,
        On::Wall | On::Opening | On::Corner | On::Dimension => Menu::Modify,
        On::Guide => Menu::View,
        On::Picture => Menu::Picture,
        On::FreeSpace => Menu::Edit,
        On::ListedPlan => Menu::File,
    };
    let mut commands: Vec<&Command> = COMMANDS.iter().filter(|command| command.on.contains(&kind)).collect();
    let others = |section: Option<(Menu, u8)>| {
        commands.iter().filter(|command| command.menu == section).map(|command| command.on.len()).min()
    };
    let keys: Vec<_> = commands
        .iter()
        .map(|command| (command.menu.is_none_or(|(menu, _)| menu != own), others(command.menu), command.id))
        .collect();
    // Sections keep together: all of one have the same key but for the id.
    let key = |command: &Command| {
        let found = keys.iter().position(|(_, _, id)| *id == command.id).unwrap_or_default();
        keys.get(found).map(|(is_other, others, _)| (*is_other, *others))
    };
    let order: Vec<Option<(Menu, u8)>> = commands.iter().map(|command| command.menu).collect();
    let place = |command: &Command| order.iter().position(|section| *section == command.menu);
    commands.sort_by_key(|command| (key(command), place(command)));
    commands
}

fn context_menu_id(number: usize) -> Id {
    Id::unique(("context menu", number))
}

/// Shows the context menu, if one is open.
pub(super) fn show_context_menu(app: &mut App, ui: &Ui) {
    let Some((thing, at, number)) = app.panels.context_menu.clone() else { return };
    let id = context_menu_id(number);
    if !Popup::is_id_open(ui.ctx(), id) {
        app.panels.context_menu = None;
        return;
    }
    let kind = app.kind_of(&thing);
    let title = match &thing {
        Thing::Element(element) if app.selection().len() == 1 => {
            app.plan().map(|plan| title_of(plan, *element)).unwrap_or_default()
        }
        Thing::Element(_) => crate::base::wording::count(app.selection().len(), "element"),
        Thing::Free => app.session.document.as_ref().map(|document| document.title()).unwrap_or_default(),
        Thing::Guide(axis, at_m) => {
            let name = if *axis == GuideAxis::Vertical { "x" } else { "y" };
            format!("{} guide, {name} {}", sentence(axis.name()), app.units().length(*at_m))
        }
        Thing::Picture => {
            let path = app.plan().and_then(Plan::backdrop).map_or("", |backdrop| backdrop.path.as_str());
            path.rsplit(['/', '\\']).next().unwrap_or_default().to_owned()
        }
        Thing::Listed(origin) => origin.title(),
    };
    let is_current = match &thing {
        Thing::Listed(origin) => app.session.document.as_ref().is_some_and(|document| document.origin == *origin),
        _ => true,
    };
    let screen = ui.ctx().content_rect();
    // Below the pointer or above it, wherever there is more space; never under it.
    let (below, above) = (screen.bottom() - at.y, at.y - screen.top());
    let aligns = [RectAlign::TOP_START, RectAlign::BOTTOM_END, RectAlign::TOP_END];
    Popup::new(id, ui.ctx().clone(), at, ui.layer_id())
        .open_memory(None)
        .kind(PopupKind::Menu)
        .align(if below >= above { RectAlign::BOTTOM_START } else { RectAlign::TOP_START })
        .align_alternatives(&aligns)
        .layout(egui::Layout::top_down_justified(egui::Align::Min))
        .style(egui::containers::menu::menu_style)
        .gap(2.0)
        .close_behavior(PopupCloseBehavior::CloseOnClick)
        .accessible_name(format!("Menu of {title}"))
        .show(|ui| {
            ui.set_width(WIDTH);
            let (rect, _) = ui.allocate_exact_size(egui::vec2(WIDTH, 24.0), egui::Sense::hover());
            let font = egui::FontId::new(theme::SMALL, theme::semibold());
            put_line(ui, &title, font, colours(ui).text_weak, rect.shrink2(egui::vec2(8.0, 0.0)));
            if let Thing::Listed(origin) = &thing
                && !is_current
            {
                // It is no file that `open` could be given, or only with its storey.
                if Row::new(Lead::Tick(false), "Open").button(ui, Role::MenuItem).clicked() {
                    let context = ui.ctx().clone();
                    app.open_listed(origin, &context);
                    ui.close();
                }
                return;
            }
            let about = match thing {
                Thing::Guide(axis, at_m) => vec![Value::word(axis), Value::Number(at_m)],
                _ => Vec::new(),
            };
            list(app, ui, of_thing(kind).into_iter(), below.max(above) - EDGE - 24.0, &about);
        });
}

// By the keyboard.

/// Remembers the button of a menu, so that keys can open it.
pub(super) fn remember_button(app: &mut App, menu: Menu, button: &Response) {
    let index = Menu::ALL.iter().position(|other| *other == menu).unwrap_or_default();
    app.panels.menu_buttons.insert(index, button.id);
}

/// The letter that opens a menu together with Alt.
pub(super) const fn letter(menu: Menu) -> (char, Key) {
    match menu {
        Menu::File => ('F', Key::F),
        Menu::Edit => ('E', Key::E),
        Menu::Draw => ('D', Key::D),
        Menu::Modify => ('M', Key::M),
        Menu::Room => ('R', Key::R),
        Menu::Picture => ('P', Key::P),
        Menu::Predict => ('t', Key::T),
        Menu::Dataset => ('s', Key::S),
        Menu::Robot => ('b', Key::B),
        Menu::View => ('V', Key::V),
        Menu::Help => ('H', Key::H),
    }
}

impl App {
    /// Takes the keys that open menus and go from one to the next: F10, Alt alone, Alt with a letter, the menu key.
    pub(crate) fn take_menu_keys(&mut self, context: &Context) {
        if self.session.question.is_some() || self.dialogs.is_any_open() {
            self.panels.alt_is_alone = false;
            return;
        }
        let popup = |id: Id| id.with("popup");
        let open = self
            .panels
            .menu_buttons
            .iter()
            .find(|(_, id)| Popup::is_id_open(context, popup(**id)))
            .map(|(index, _)| *index);
        let mut wanted = None;
        let mut wants_bar = false;
        let mut wants_context = false;
        context.input_mut(|input| {
            let settings = &self.session.settings;
            let mut drops_text = false;
            let events = std::mem::take(&mut input.events);
            for event in events {
                let taken = match &event {
                    Event::Key { key: Key::AltLeft, pressed, .. } => {
                        wants_bar = !pressed && std::mem::take(&mut self.panels.alt_is_alone);
                        self.panels.alt_is_alone = *pressed;
                        false
                    }
                    Event::Key { key: Key::F10, pressed: true, modifiers, .. } => {
                        if modifiers.shift {
                            wants_context = true
                        } else {
                            wanted = Some(open.is_none().then_some(0))
                        }
                        true
                    }
                    Event::Key { key, pressed: true, modifiers, .. } => {
                        self.panels.alt_is_alone = false;
                        let is_alt = modifiers.alt && !modifiers.command && !modifiers.shift;
                        let is_own = || !commands::is_shortcut(settings, *key, *modifiers);
                        let step = match key {
                            Key::ArrowRight => 1,
                            Key::ArrowLeft => Menu::ALL.len() - 1,
                            _ => 0,
                        };
                        if let Some(menu) = Menu::ALL.iter().position(|menu| letter(*menu).1 == *key).filter(|_| is_alt)
                            && is_own()
                        {
                            wanted = Some(Some(menu));
                            drops_text = true;
                            true
                        } else if let Some(open) = open.filter(|_| step > 0 && modifiers.is_none()) {
                            wanted = Some(Some((open + step) % Menu::ALL.len()));
                            true
                        } else {
                            false
                        }
                    }
                    Event::Text(_) => std::mem::take(&mut drops_text),
                    Event::PointerButton { .. } | Event::WindowFocused(_) => {
                        self.panels.alt_is_alone = false;
                        false
                    }
                    _ => false,
                };
                if !taken {
                    input.events.push(event);
                }
            }
        });
        let buttons = self.panels.menu_buttons.clone();
        let button = |index: usize| buttons.get(&index).copied();
        match wanted {
            None => {}
            // Closed by the key that opens it.
            Some(None) => Popup::close_all(context),
            Some(Some(index)) => {
                if let Some(id) = button(index) {
                    Popup::open_id(context, popup(id));
                    // The arrows go through the bar, not from control to control.
                    context.memory_mut(|memory| memory.move_focus(egui::FocusDirection::None));
                    self.panels.menu_takes_keyboard = true;
                }
            }
        }
        if wants_bar && let Some(id) = button(0) {
            if open.is_some() {
                Popup::close_all(context);
            }
            context.memory_mut(|memory| memory.request_focus(id));
        }
        if wants_context {
            self.open_context_menu_by_key(context);
        }
    }

    /// The menu of what is selected, or of the plan.
    fn open_context_menu_by_key(&mut self, context: &Context) {
        let Some(canvas) = self.canvas.seen_rect().filter(|_| self.session.document.is_some()) else { return };
        let first = self.selection().iter().next();
        let middle = first.and_then(|element| self.session.document.as_ref()?.bounds_of(element)).map(|it| it.center());
        let at = middle.and_then(|middle| self.canvas.screen_position(middle)).filter(|at| canvas.contains(*at));
        let thing = first.map_or(Thing::Free, Thing::Element);
        context.memory_mut(|memory| memory.request_focus(canvas_id()));
        self.open_context_menu(thing, at.unwrap_or(canvas.center()), context);
        self.panels.menu_takes_keyboard = true;
    }
}

/// Whether the letters of menus are underlined: while Alt is held alone.
pub(super) fn shows_letters(ui: &Ui) -> bool {
    ui.input(|input| input.modifiers == Modifiers::ALT)
}
