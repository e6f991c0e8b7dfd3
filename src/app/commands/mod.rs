//! The one table of commands: menus, tool bar, palette, tooltips, shortcuts, the manual's list and the
//! verbs of scripts come from it.
//!
//! To add a command, add an entry. Scripts call it by its id, which never changes.

mod argument;
mod given;
mod manual;
mod pressed;
mod run;
mod table;
mod tools;

use egui::{Context, KeyboardShortcut};

pub use crate::app::look::keys::{Keys, NoKeys};
pub use crate::app::session::executed::Executed;
pub use crate::app::session::words::Choice;
pub use argument::{Argument, ArgumentKind};
pub use manual::{keys_of, manual};
pub use run::CommandError;
pub(super) use run::keyed;
pub use table::COMMANDS;

pub(super) use crate::app::value::{elements_word, room_word, sample_word};
use given::Run;
pub(crate) use pressed::{is_shortcut, take_pressed};

use crate::app::look::icons::Icon;
use crate::app::state::App;
use crate::app::tools::Entry;

/// A command: something the user can do.
#[derive(Clone, Copy)]
pub struct Command {
    /// Its id, in lower case with hyphens.
    pub id: &'static str,
    /// Its title in menus. Ends in '…' if it asks for something first.
    pub title: &'static str,
    /// A sentence for tooltips and the manual.
    pub help: &'static str,
    /// Its arguments, the optional ones last. It asks for missing ones.
    pub arguments: &'static [Argument],
    /// Its default shortcuts. The first one is shown.
    pub shortcuts: &'static [KeyboardShortcut],
    /// Its menu and the section in it; `None` if only for scripts.
    pub menu: Option<(Menu, u8)>,
    /// The things whose context menus show it.
    pub on: &'static [On],
    /// Its icon and group in the tool bar; `None` if not there.
    pub tool: Option<(Icon, u8)>,
    /// Its icon and group in the strip of drawing tools; `None` if not there.
    pub strip: Option<(Icon, u8)>,
    /// Whether the palette lets its path be typed, though a dialog would ask for it elsewhere.
    types_path: bool,
    availability: fn(&App) -> Availability,
    /// When it can be called with all its arguments, if that requires less.
    complete_availability: Option<fn(&App) -> Availability>,
    action: Action,
}

/// Whether a command is available; if not, what to do first.
type Availability = Result<(), &'static str>;

#[derive(Clone, Copy)]
enum Action {
    Plain(fn(&mut App, &Context)),
    /// Turns something on or off; without an argument, toggles it.
    Switch {
        is_on: fn(&App) -> bool,
        set: fn(&mut App, bool),
    },
    /// Chooses one of several alternatives.
    Choose {
        is_on: fn(&App) -> bool,
        run: fn(&mut App, &Context),
    },
    /// Activates a tool.
    TakeUp(&'static Entry),
    With {
        run: &'static dyn Run,
        /// Asks for missing arguments; not used by the palette.
        ask: Option<fn(&mut App, &Context)>,
        /// For something on or off: its state.
        is_on: Option<fn(&App) -> bool>,
    },
}

/// The outcome of a command.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Outcome {
    Done,
    /// It was done, and repeating it with these arguments does the same.
    DoneWith(Vec<String>),
    /// It asks for something, or shows it; the answer is a separate command.
    Asks,
    /// Nothing was done; the text says why.
    Refused(String),
}

/// A thing that has a context menu.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum On {
    Room,
    Wall,
    Opening,
    Corner,
    /// A dimension chain.
    Dimension,
    /// A guide line; commands get its direction and its place first.
    Guide,
    /// The picture under the plan, where nothing is drawn.
    Picture,
    /// Several elements that are selected.
    Several,
    /// A place of the plan where nothing is.
    FreeSpace,
    /// The open plan in the list of plans.
    ListedPlan,
}

impl On {
    pub const ALL: [Self; 10] = [
        Self::Room,
        Self::Wall,
        Self::Opening,
        Self::Corner,
        Self::Dimension,
        Self::Guide,
        Self::Picture,
        Self::Several,
        Self::FreeSpace,
        Self::ListedPlan,
    ];
}

/// A menu of the menu bar, in order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Menu {
    File,
    Edit,
    Draw,
    Modify,
    Room,
    Picture,
    Predict,
    Dataset,
    Robot,
    View,
    Help,
}

impl Menu {
    pub const ALL: [Self; 11] = [
        Self::File,
        Self::Edit,
        Self::Draw,
        Self::Modify,
        Self::Room,
        Self::Picture,
        Self::Predict,
        Self::Dataset,
        Self::Robot,
        Self::View,
        Self::Help,
    ];

    pub const fn title(self) -> &'static str {
        match self {
            Self::File => "File",
            Self::Edit => "Edit",
            Self::Draw => "Draw",
            Self::Modify => "Modify",
            Self::Room => "Room",
            Self::Picture => "Picture",
            Self::Predict => "Predict",
            Self::Dataset => "Dataset",
            Self::Robot => "Robot",
            Self::View => "View",
            Self::Help => "Help",
        }
    }
}

impl Command {
    /// Why it is unavailable, as something to do: 'pick a room first'; `None` if it is available.
    pub fn why_not(&self, app: &App) -> Option<&'static str> {
        (self.availability)(app).err()
    }

    /// For something on or off: its state.
    pub fn is_on(&self, app: &App) -> Option<bool> {
        match self.action {
            Action::Switch { is_on, .. } | Action::Choose { is_on, .. } => Some(is_on(app)),
            Action::TakeUp(tool) => Some(app.tools.is(tool.id)),
            Action::With { is_on, .. } => is_on.map(|is_on| is_on(app)),
            Action::Plain(_) => None,
        }
    }

    /// Its title without the ellipsis.
    pub(super) fn plain_title(&self) -> &'static str {
        self.title.trim_end_matches('…')
    }

    /// The required argument after those given, if the palette asks for it.
    pub(super) fn asked_in_palette(&self, given: usize) -> Option<&'static Argument> {
        let asks_itself = matches!(self.action, Action::With { ask: Some(_), .. }) && !self.types_path;
        self.arguments.get(given).filter(|argument| !argument.is_optional && !asks_itself)
    }

    /// Its choices and the current one: for a setting whose choices menus show instead of the command,
    /// one per row.
    pub(super) fn settings<'a>(&self, app: &'a App) -> Option<(Vec<Choice>, &'a str)> {
        let [argument] = self.arguments else { return None };
        Some((argument.kind.choices(app)?, argument.kind.current(app)?))
    }

    /// The rows that menus show instead of it, each with whether it is on; `None` if they show the
    /// command itself.
    pub(super) fn rows(&self, app: &App) -> Option<Vec<(Choice, bool)>> {
        let with = |is_on: &dyn Fn(&str) -> bool, choices: Vec<Choice>| {
            let ticked = choices.into_iter().map(|choice| {
                let is_on = is_on(&choice.word);
                (choice, is_on)
            });
            ticked.collect()
        };
        if let [Argument { kind: ArgumentKind::SidePanel, .. }, ..] = self.arguments {
            return Some(with(&|word| app.panels.is_shown(word), ArgumentKind::SidePanel.choices(app)?));
        }
        let (choices, current) = self.settings(app)?;
        Some(with(&|word| word == current, choices))
    }

    /// Its usage: `open PATH [STOREY]`. Arguments in brackets are optional.
    pub fn usage(&self) -> String {
        let mut usage = self.id.to_owned();
        for argument in self.arguments {
            usage.push_str(&if argument.is_optional {
                format!(" [{}]", argument.name)
            } else {
                format!(" {}", argument.name)
            });
        }
        usage
    }
}

/// The command with an id.
pub fn find(id: &str) -> Option<&'static Command> {
    COMMANDS.iter().find(|command| command.id == id)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;
    use crate::app::tools::ToolOption;

    #[test]
    fn no_shortcut_and_no_id_is_used_twice() {
        let mut by_key: BTreeMap<String, &str> = BTreeMap::new();
        let mut by_id: BTreeMap<&str, &str> = BTreeMap::new();
        for command in COMMANDS.iter() {
            assert_eq!(by_id.insert(command.id, command.title), None, "two commands have the id {}", command.id);
            for shortcut in command.shortcuts {
                let keys = shortcut.format(&egui::ModifierNames::NAMES, false);
                let before = by_key.insert(keys.clone(), command.id);
                assert_eq!(before, None, "{keys} is the shortcut of {} too", command.id);
            }
        }
    }

    #[test]
    fn every_tool_has_its_command_and_those_of_its_options() {
        for tool in crate::app::tools::TOOLS {
            assert!(find(tool.id).is_some_and(|command| command.title == tool.title), "{}", tool.id);
            for option in tool.options {
                let (id, kind) = match option {
                    ToolOption::Switch { command, .. } => (*command, ArgumentKind::Switch),
                    // Without a word it goes on to the next, which is what a click in the bar does.
                    ToolOption::Choice { command, .. } => {
                        let arguments = find(command).map_or(&[][..], |command| command.arguments);
                        assert!(matches!(arguments, [argument] if argument.is_optional), "{command}");
                        continue;
                    }
                    ToolOption::Length { command, least_m, most_m, .. } => {
                        (*command, ArgumentKind::Length { least_m: *least_m, most_m: *most_m })
                    }
                };
                let command = find(id).unwrap_or_else(|| panic!("{} asks for {id}", tool.id));
                assert_eq!(command.arguments.iter().map(|argument| argument.kind).collect::<Vec<_>>(), [kind], "{id}");
            }
        }
    }

    /// A new argument that is a length, an angle or a share is one by its kind: by its kind it is read.
    #[test]
    fn every_argument_with_a_number_has_the_kind_of_what_it_counts() {
        let arguments = || COMMANDS.iter().flat_map(|command| command.arguments.iter().map(move |it| (command.id, it)));
        for (id, argument) in arguments() {
            let Argument { name, kind, help, .. } = argument;
            let is_length = matches!(
                kind,
                ArgumentKind::Length { .. } | ArgumentKind::Coordinate { .. } | ArgumentKind::Points { .. }
            );
            let is_named_so =
                ["THICKNESS", "WIDTH", "HEIGHT", "LENGTH", "DISTANCE", "TOLERANCE", "POSITION", "DX", "DY"];
            let says = |words: &[&str]| words.iter().any(|word| help.contains(word));
            if is_named_so.contains(name)
                || (says(&["metre", "feet", "how far", "how wide", "how thick"]) && *name != "ANGLE")
            {
                // Of the scale and of the size of a tile, say, a number is no length.
                let is_other = matches!(kind, ArgumentKind::Number { unit: " of pixels to the metre", .. });
                assert!(is_length || is_other, "{name} of {id} is a length by its name or its help");
            }
            let is_angle = matches!(kind, ArgumentKind::Angle { .. });
            assert_eq!(*name == "ANGLE" || says(&["degree"]), is_angle, "{name} of {id}");
            let is_number = matches!(kind, ArgumentKind::Number { .. });
            // A length, an angle, a factor and a percentage are no bare numbers.
            assert_eq!(is_number, (id, *name) == ("view", "SCALE"), "{name} of {id}");
        }
        let lengths = arguments().filter(|(_, argument)| matches!(argument.kind, ArgumentKind::Length { .. })).count();
        assert!(lengths >= 16, "{lengths}");
    }

    #[test]
    fn every_argument_with_a_number_is_read_by_the_one_reader() {
        let mut window = crate::app::Offscreen::new(crate::app::OffscreenOptions::default());
        let read = |window: &crate::app::Offscreen, kind: ArgumentKind, text: &str| match kind.read(window.app(), text)
        {
            Ok(crate::app::value::Value::Number(number)) => Some(number),
            _ => None,
        };
        for units in ["units-metric", "units-imperial"] {
            window.run_command(units);
            let unit_m = if units == "units-metric" { 1.0 } else { crate::base::units::METRES_PER_FOOT };
            for (id, argument) in
                COMMANDS.iter().flat_map(|command| command.arguments.iter().map(move |it| (command.id, it)))
            {
                let kind = argument.kind;
                let cases: &[(&str, f64)] = match kind {
                    ArgumentKind::Length { .. } => &[
                        ("2 1/2\"", 0.0635),
                        ("1'3-1/2\"", 0.3937),
                        ("1’ 3½”", 0.3937),
                        ("0,3 METRES", 0.3),
                        ("3*(60cm+12mm)", 1.836),
                        ("2.5", 2.5 * unit_m),
                        ("2,5", 2.5 * unit_m),
                    ],
                    ArgumentKind::Coordinate { .. } => &[("2,5", 2.5), ("1'3-1/2\"", 0.3937), ("3 - 1/2", 2.5)],
                    ArgumentKind::Angle { .. } => &[("22,5°", 22.5), ("90/4", 22.5), ("(10 + 12.5) deg", f64::NAN)],
                    ArgumentKind::Ratio { .. } => &[("1,5", 1.5), ("3/2", 1.5), ("150 %", 1.5)],
                    ArgumentKind::Percent => &[("12,5", 12.5), ("12.5 %", 12.5), ("100/8", 12.5)],
                    ArgumentKind::Number { .. } => &[("12,5", 12.5), ("100/8", 12.5)],
                    _ => continue,
                };
                let what = |text: &str| format!("{} of {id} in {units}: {text}", argument.name);
                for &(text, expected) in cases {
                    match read(&window, kind, text) {
                        // Beyond the argument's limits, or a spelling that is refused.
                        None => {
                            let said = kind.read(window.app(), text).unwrap_err();
                            let is_limit = said.starts_with("expected ") && !said.contains("is not understood");
                            assert!(is_limit || expected.is_nan(), "{}: {said}", what(text));
                        }
                        Some(number) => assert!((number - expected).abs() < 1e-4, "{}: {number}", what(text)),
                    }
                }
                for wrong in ["", "wide", "3 parsec", "1.2.3", "1e3", "NaN", "3m²", "2x3"] {
                    assert!(kind.read(window.app(), wrong).is_err(), "{}", what(wrong));
                }
            }
        }
    }

    #[test]
    fn every_command_is_well_described() {
        for command in COMMANDS.iter() {
            let id_is_word = command.id.chars().all(|c| c.is_ascii_lowercase() || c == '-');
            assert!(id_is_word, "{}", command.id);
            assert!(command.title.starts_with(char::is_uppercase) && !command.title.ends_with('.'), "{}", command.id);
            assert!(command.help.starts_with(char::is_uppercase) && !command.help.ends_with('.'), "{}", command.id);
            // Commands only for scripts are listed in the manual.
            assert!(command.menu.is_some() || command.shortcuts.is_empty(), "{} has keys and no menu", command.id);
            let first_optional = command.arguments.iter().position(|argument| argument.is_optional);
            let after = command.arguments.iter().skip(first_optional.unwrap_or(command.arguments.len()));
            assert!(after.clone().all(|argument| argument.is_optional), "{}: optional arguments come last", command.id);
            let mut names: Vec<&str> = command.arguments.iter().map(|argument| argument.name).collect();
            names.dedup();
            assert_eq!(names.len(), command.arguments.len(), "{}", command.id);
        }
        // Every kind of thing has a menu, of what stands in the menus of the bar too.
        for thing in On::ALL {
            let of_thing: Vec<&Command> = COMMANDS.iter().filter(|command| command.on.contains(&thing)).collect();
            assert!((3..=28).contains(&of_thing.len()), "{thing:?}: {}", of_thing.len());
            assert!(of_thing.iter().all(|command| command.menu.is_some()), "{thing:?}");
        }
        // Sections of a menu are contiguous.
        for menu in Menu::ALL {
            let sections: Vec<u8> =
                COMMANDS.iter().filter_map(|command| command.menu).filter(|m| m.0 == menu).map(|m| m.1).collect();
            assert!(sections.is_sorted(), "{menu:?} {sections:?}");
        }
    }
}
