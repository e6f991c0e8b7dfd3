//! The one table of commands: menus, tool bar, tooltips and shortcuts come from it.
//!
//! A new command is one entry. Its id is the word by which scripts will call it, and never changes.

use egui::{Context, Event, InputState, Key, KeyboardShortcut, Modifiers};

use super::icons::Icon;
use super::theme::ThemeChoice;
use super::{App, Intent, Picked};
use crate::draw::Fill;
use crate::labels::Label;

/// Something a person can do.
pub struct Command {
    /// Its word, in lower case with hyphens.
    pub id: &'static str,
    /// As in a menu. Ends in '…' when a dialog follows.
    pub title: &'static str,
    /// A sentence for tooltips and the manual.
    pub help: &'static str,
    /// The first one is shown.
    pub shortcuts: &'static [KeyboardShortcut],
    /// Where it stands in the menus, with the section between two lines; `None` for nowhere.
    pub menu: Option<(Menu, u8)>,
    /// Its icon in the tool bar, and the group it stands in; `None` for not there.
    pub tool: Option<(Icon, u8)>,
    /// Whether it can be done now.
    pub is_available: fn(&App) -> bool,
    /// For what is on or off: which it is.
    pub is_on: Option<fn(&App) -> bool>,
    pub run: fn(&mut App, &Context),
}

/// A menu of the menu bar, in their order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Menu {
    File,
    Edit,
    Room,
    View,
}

impl Menu {
    pub const ALL: [Self; 4] = [Self::File, Self::Edit, Self::Room, Self::View];

    pub const fn title(self) -> &'static str {
        match self {
            Self::File => "File",
            Self::Edit => "Edit",
            Self::Room => "Room",
            Self::View => "View",
        }
    }
}

const fn key(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::NONE, key)
}

const fn shift(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::SHIFT, key)
}

const fn ctrl(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::COMMAND, key)
}

const fn ctrl_shift(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::COMMAND.plus(Modifiers::SHIFT), key)
}

const fn command(
    id: &'static str,
    title: &'static str,
    help: &'static str,
    is_available: fn(&App) -> bool,
    run: fn(&mut App, &Context),
) -> Command {
    Command { id, title, help, shortcuts: &[], menu: None, tool: None, is_available, is_on: None, run }
}

impl Command {
    /// Its first shortcut as people write it ('Ctrl+Shift+S', '+'); empty without one.
    pub fn keys_text(&self, context: &Context) -> String {
        let Some(shortcut) = self.shortcuts.first() else { return String::new() };
        let modifiers = context.format_modifiers(shortcut.modifiers);
        let plus = if modifiers.is_empty() { "" } else { "+" };
        let key = match shortcut.logical_key {
            Key::PageUp => "Page up",
            Key::PageDown => "Page down",
            Key::Escape => "Esc",
            key => key.symbol_or_name(),
        };
        format!("{modifiers}{plus}{key}")
    }

    const fn keys(self, shortcuts: &'static [KeyboardShortcut]) -> Self {
        Self { shortcuts, ..self }
    }

    const fn menu(self, menu: Menu, section: u8) -> Self {
        Self { menu: Some((menu, section)), ..self }
    }

    const fn tool(self, icon: Icon, group: u8) -> Self {
        Self { tool: Some((icon, group)), ..self }
    }

    const fn on(self, is_on: fn(&App) -> bool) -> Self {
        Self { is_on: Some(is_on), ..self }
    }
}

fn always(_: &App) -> bool {
    true
}

fn has_plan(app: &App) -> bool {
    app.document.is_some()
}

fn has_picked(app: &App) -> bool {
    app.picked.is_some()
}

fn has_room(app: &App) -> bool {
    matches!(app.picked, Some(Picked::Room(_)))
}

fn can_undo(app: &App) -> bool {
    app.document.as_ref().is_some_and(|document| document.history.can_undo())
}

fn can_redo(app: &App) -> bool {
    app.document.as_ref().is_some_and(|document| document.history.can_redo())
}

fn has_own_label(app: &App) -> bool {
    app.picked_room().is_some_and(|(_, room)| room.label.is_some())
}

fn has_several_plans(app: &App) -> bool {
    app.list.len() > 1
}

fn has_backdrop(app: &App) -> bool {
    app.document.as_ref().is_some_and(|document| document.plan().backdrop().is_some())
}

/// Every command, in the order of the menus.
pub const COMMANDS: &[Command] = &[
    command("open", "Open…", "Open a plan: a plan file, the authors' XML, or GeoJSON", always, |app, _| {
        app.choose_plan();
    })
    .keys(&[ctrl(Key::O)])
    .menu(Menu::File, 0),
    command("save", "Save", "Save the plan in its file", has_plan, |app, _| app.save(None))
        .keys(&[ctrl(Key::S)])
        .menu(Menu::File, 1),
    command("save-as", "Save as…", "Save the plan in another file", has_plan, |app, _| app.save_as(None))
        .keys(&[ctrl_shift(Key::S)])
        .menu(Menu::File, 1),
    command("previous-plan", "Previous plan", "Open the plan above in the list", has_several_plans, |app, _| {
        app.open_neighbour(-1);
    })
    .keys(&[key(Key::PageUp)])
    .menu(Menu::File, 2),
    command("next-plan", "Next plan", "Open the plan below in the list", has_several_plans, |app, _| {
        app.open_neighbour(1);
    })
    .keys(&[key(Key::PageDown)])
    .menu(Menu::File, 2),
    command("close", "Close plan", "Close the plan", has_plan, |app, _| app.request(Intent::Close))
        .keys(&[ctrl(Key::W)])
        .menu(Menu::File, 3),
    command("quit", "Quit", "Close the window", always, |app, _| app.request(Intent::Quit))
        .keys(&[ctrl(Key::Q)])
        .menu(Menu::File, 3),
    command("undo", "Undo", "Take the last change back", can_undo, |app, _| app.undo())
        .keys(&[ctrl(Key::Z)])
        .menu(Menu::Edit, 0)
        .tool(Icon::Undo, 0),
    command("redo", "Redo", "Do again what was taken back", can_redo, |app, _| app.redo())
        .keys(&[ctrl_shift(Key::Z), ctrl(Key::Y)])
        .menu(Menu::Edit, 0)
        .tool(Icon::Redo, 0),
    command("clear-selection", "Clear selection", "Pick nothing", has_picked, |app, _| app.pick(None))
        .keys(&[key(Key::Escape)])
        .menu(Menu::Edit, 1),
    command("rename", "Rename", "Write the picked room's name", has_room, |app, _| app.panels.focus_name = true)
        .keys(&[key(Key::F2)])
        .menu(Menu::Room, 0),
    command("label-small", "Small room", "Label the picked room as a small room", has_room, |app, _| {
        app.label_picked(Some(Label::SmallRoom));
    })
    .keys(&[key(Key::S)])
    .menu(Menu::Room, 1)
    .on(|app| app.picked_label() == Some(Label::SmallRoom)),
    command("label-medium", "Medium room", "Label the picked room as a medium room", has_room, |app, _| {
        app.label_picked(Some(Label::MediumRoom));
    })
    .keys(&[key(Key::M)])
    .menu(Menu::Room, 1)
    .on(|app| app.picked_label() == Some(Label::MediumRoom)),
    command("label-big", "Big room", "Label the picked room as a big room", has_room, |app, _| {
        app.label_picked(Some(Label::BigRoom));
    })
    .keys(&[key(Key::B)])
    .menu(Menu::Room, 1)
    .on(|app| app.picked_label() == Some(Label::BigRoom)),
    command("label-corridor", "Corridor", "Label the picked room as a corridor", has_room, |app, _| {
        app.label_picked(Some(Label::Corridor));
    })
    .keys(&[key(Key::C)])
    .menu(Menu::Room, 1)
    .on(|app| app.picked_label() == Some(Label::Corridor)),
    command("label-hall", "Hall", "Label the picked room as a hall", has_room, |app, _| {
        app.label_picked(Some(Label::Hall));
    })
    .keys(&[key(Key::H)])
    .menu(Menu::Room, 1)
    .on(|app| app.picked_label() == Some(Label::Hall)),
    command(
        "label-by-function",
        "Label by function",
        "Drop the picked room's own label: the label scheme's answer for its function counts",
        has_own_label,
        |app, _| app.label_picked(None),
    )
    .menu(Menu::Room, 1),
    command("next-room", "Next room", "Pick the next room, as one reads: from the top left", has_plan, |app, _| {
        app.pick_neighbour(1);
    })
    .keys(&[key(Key::CloseBracket)])
    .menu(Menu::Room, 2),
    command("previous-room", "Previous room", "Pick the room before", has_plan, |app, _| {
        app.pick_neighbour(-1);
    })
    .keys(&[key(Key::OpenBracket)])
    .menu(Menu::Room, 2),
    command("fit", "Zoom to fit", "Show the whole plan", has_plan, |app, _| app.canvas.fit())
        .keys(&[key(Key::F)])
        .menu(Menu::View, 0)
        .tool(Icon::Fit, 1),
    command("zoom-to-selection", "Zoom to selection", "Show what is picked as large as fits", has_picked, |app, _| {
        app.zoom_to_picked();
    })
    .keys(&[shift(Key::F)])
    .menu(Menu::View, 0)
    .tool(Icon::ZoomToSelection, 1),
    command("zoom-in", "Zoom in", "Show the plan larger", has_plan, |app, _| app.canvas.zoom_by(ZOOM_STEP))
        .keys(&[key(Key::Plus), key(Key::Equals)])
        .menu(Menu::View, 0),
    command("zoom-out", "Zoom out", "Show the plan smaller", has_plan, |app, _| app.canvas.zoom_by(1.0 / ZOOM_STEP))
        .keys(&[key(Key::Minus)])
        .menu(Menu::View, 0),
    command("fill-label", "Fill by label", "Colour each room by its label", always, |app, _| {
        app.layers.fill = Fill::Label;
    })
    .keys(&[key(Key::L)])
    .menu(Menu::View, 1)
    .on(|app| app.layers.fill == Fill::Label),
    command("fill-function", "Fill by function", "Colour each room by what it is for", always, |app, _| {
        app.layers.fill = Fill::Function;
    })
    .keys(&[shift(Key::L)])
    .menu(Menu::View, 1)
    .on(|app| app.layers.fill == Fill::Function),
    command("fill-none", "No fill", "Show walls and openings only", always, |app, _| app.layers.fill = Fill::None)
        .keys(&[key(Key::K)])
        .menu(Menu::View, 1)
        .on(|app| app.layers.fill == Fill::None),
    command("graph", "Graph", "Show which rooms the openings join", always, |app, _| {
        app.layers.graph = !app.layers.graph
    })
    .keys(&[key(Key::G)])
    .menu(Menu::View, 2)
    .tool(Icon::Graph, 2)
    .on(|app| app.layers.graph),
    command("names", "Names", "Show names and areas of rooms", always, |app, _| app.layers.names = !app.layers.names)
        .keys(&[key(Key::N)])
        .menu(Menu::View, 2)
        .tool(Icon::Names, 2)
        .on(|app| app.layers.names),
    command("backdrop", "Backdrop", "Show the picture under the plan", has_backdrop, |app, _| {
        app.layers.backdrop = !app.layers.backdrop;
    })
    .keys(&[key(Key::P)])
    .menu(Menu::View, 2)
    .tool(Icon::Backdrop, 2)
    .on(|app| app.layers.backdrop),
    command("grid", "Grid", "Show a grid of whole metres", always, |app, _| app.layers.grid = !app.layers.grid)
        .keys(&[shift(Key::G)])
        .menu(Menu::View, 2)
        .tool(Icon::Grid, 2)
        .on(|app| app.layers.grid),
    command("plan-panel", "Plans and layers", "Show the panel on the left", always, |app, _| {
        app.panels.left = !app.panels.left;
    })
    .keys(&[ctrl(Key::Num1)])
    .menu(Menu::View, 3)
    .tool(Icon::Sidebar, 3)
    .on(|app| app.panels.left),
    command("inspector", "Inspector", "Show the panel on the right", always, |app, _| {
        app.panels.right = !app.panels.right;
    })
    .keys(&[ctrl(Key::Num2)])
    .menu(Menu::View, 3)
    .tool(Icon::Inspector, 3)
    .on(|app| app.panels.right),
    command("theme-system", "Follow the system", "Light or dark as the system says", always, |app, context| {
        app.set_theme(ThemeChoice::System, context);
    })
    .menu(Menu::View, 4)
    .on(|app| app.theme == ThemeChoice::System),
    command("theme-light", "Light", "Light, whatever the system says", always, |app, context| {
        app.set_theme(ThemeChoice::Light, context);
    })
    .menu(Menu::View, 4)
    .on(|app| app.theme == ThemeChoice::Light),
    command("theme-dark", "Dark", "Dark, whatever the system says", always, |app, context| {
        app.set_theme(ThemeChoice::Dark, context);
    })
    .menu(Menu::View, 4)
    .on(|app| app.theme == ThemeChoice::Dark),
];

/// How much a step of zooming changes the size.
const ZOOM_STEP: f64 = 1.25;

/// The command with an id.
pub fn find(id: &str) -> Option<&'static Command> {
    COMMANDS.iter().find(|command| command.id == id)
}

/// Takes the shortcuts pressed since the last frame out of the input and gives their commands.
/// `is_typing`: a text field has the keyboard, which then keeps what it needs itself.
pub(super) fn take_pressed(input: &mut InputState, is_typing: bool) -> Vec<&'static Command> {
    let mut pressed = Vec::new();
    input.events.retain(|event| {
        let Event::Key { key, pressed: true, modifiers, .. } = event else { return true };
        let hit = COMMANDS.iter().find(|command| {
            command
                .shortcuts
                .iter()
                .any(|shortcut| matches(shortcut, *key, *modifiers) && !(is_typing && belongs_to_text(shortcut)))
        });
        pressed.extend(hit);
        hit.is_none()
    });
    pressed
}

fn matches(shortcut: &KeyboardShortcut, key: Key, modifiers: Modifiers) -> bool {
    if shortcut.logical_key != key {
        return false;
    }
    // On most keyboards '+' is typed with Shift.
    let modifiers = if key == Key::Plus { Modifiers { shift: false, ..modifiers } } else { modifiers };
    modifiers.matches_exact(shortcut.modifiers)
}

/// Whether a text field uses these keys itself.
fn belongs_to_text(shortcut: &KeyboardShortcut) -> bool {
    let plain = !shortcut.modifiers.command && shortcut.logical_key != Key::F2;
    plain || matches!(shortcut.logical_key, Key::Z | Key::Y)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;

    #[test]
    fn no_shortcut_and_no_id_is_used_twice() {
        let mut by_key: BTreeMap<String, &str> = BTreeMap::new();
        let mut by_id: BTreeMap<&str, &str> = BTreeMap::new();
        for command in COMMANDS {
            assert_eq!(by_id.insert(command.id, command.title), None, "two commands have the id {}", command.id);
            for shortcut in command.shortcuts {
                let keys = shortcut.format(&egui::ModifierNames::NAMES, false);
                let before = by_key.insert(keys.clone(), command.id);
                assert_eq!(before, None, "{keys} is the shortcut of {} too", command.id);
            }
        }
    }

    #[test]
    fn every_command_is_well_described() {
        for command in COMMANDS {
            let id_is_word = command.id.chars().all(|c| c.is_ascii_lowercase() || c == '-');
            assert!(id_is_word, "{}", command.id);
            assert!(command.title.starts_with(char::is_uppercase) && !command.title.ends_with('.'), "{}", command.id);
            assert!(command.help.starts_with(char::is_uppercase) && !command.help.ends_with('.'), "{}", command.id);
            assert!(command.menu.is_some(), "{} cannot be found without its shortcut", command.id);
        }
        // Sections of a menu stand together.
        for menu in Menu::ALL {
            let sections: Vec<u8> =
                COMMANDS.iter().filter_map(|command| command.menu).filter(|m| m.0 == menu).map(|m| m.1).collect();
            assert!(sections.is_sorted(), "{menu:?} {sections:?}");
        }
    }

    #[test]
    fn exact_modifiers_decide() {
        let undo = ctrl(Key::Z);
        let pressed = Modifiers { ctrl: true, command: true, ..Modifiers::NONE };
        assert!(matches(&undo, Key::Z, pressed));
        assert!(!matches(&undo, Key::Z, pressed.plus(Modifiers::SHIFT)));
        assert!(!matches(&key(Key::L), Key::L, Modifiers::SHIFT));
        assert!(matches(&key(Key::Plus), Key::Plus, Modifiers::SHIFT));
    }
}
