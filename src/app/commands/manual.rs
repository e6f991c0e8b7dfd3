//! The table as a page of the manual.

use std::fmt::Write as _;

use super::{Argument, ArgumentKind, COMMANDS, Command, Menu};
use crate::app::look::keys::Keys;

/// The text above the tables.
const INTRODUCTION: &str = "\
# Commands

Everything Enfilade's window does is a command. Each stands in a menu, in the palette (Ctrl+Shift+P: type a few
letters of its name), in the sheet of shortcuts (?), and is a verb of scripts (`enfilade replay`). What a command needs and
is not given it asks for: by a dialog, a text field, or in the palette.

This page is written from the table of commands (`src/app/commands/table/`) by `enfilade commands --markdown`.

## Shortcuts of your own

In the sheet of shortcuts, click the keys of a command and press others. Keys that another command has are refused,
and the command is named; so are keys that move the keyboard from control to control, leave what is open, or belong
to text. Backspace leaves a command without keys; the arrow beside changed keys brings back those it comes with.

They are kept in `enfilade/settings.json` in the system's folder for settings (`~/.config` on Linux). The environment
variable `ENFILADE_SETTINGS` names another file; when it is empty, nothing is read or kept. What this version does not
know in the file stays in it. A damaged file is kept aside as `settings.damaged.json` and said, and so are shortcuts in
it that cannot be. Letters without Ctrl go to a text field when one has the keyboard.
";

/// What stands above the table of arguments.
const LENGTHS: &str = "\
A length may have a unit, such as `90cm` or `3'`; without one it is in metres or in feet, as is
set. Numbers of points and coordinates are metres, whatever is set, unless they have a unit: `0,0 4m,3ft`. Numbers may be
sums, and have a decimal comma where no comma stands between them (see [naming](naming.md#units)).

";

/// The page.
pub fn manual() -> String {
    let mut page = INTRODUCTION.to_owned();
    for menu in Menu::ALL {
        let of_menu = |command: &&Command| command.menu.is_some_and(|(of, _)| of == menu);
        section(&mut page, menu.title(), true, COMMANDS.iter().filter(of_menu));
    }
    section(&mut page, "Only in scripts", false, COMMANDS.iter().filter(|command| command.menu.is_none()));
    page.push_str("\n## Arguments\n\nWhat stands in brackets may be left out. ");
    page.push_str(LENGTHS);
    page.push_str("| Argument | Of | What it is |\n| --- | --- | --- |\n");
    let mut told: Vec<&Argument> = Vec::new();
    for argument in COMMANDS.iter().flat_map(|command| command.arguments) {
        if told.contains(&argument) {
            continue;
        }
        told.push(argument);
        let has = |command: &&Command| command.arguments.contains(argument);
        let of: Vec<String> = COMMANDS.iter().filter(has).map(|command| format!("`{}`", command.id)).collect();
        let Argument { name, help, kind, .. } = argument;
        let limits = match kind {
            ArgumentKind::Number { least, most, .. } | ArgumentKind::Ratio { least, most } => {
                format!(", from {least} to {most}")
            }
            ArgumentKind::Coordinate { least_m: least, most_m: most }
            | ArgumentKind::Angle { least_deg: least, most_deg: most } => format!(", from {least} to {most}"),
            ArgumentKind::Percent => ", from 0 to 100".to_owned(),
            ArgumentKind::Length { .. } | ArgumentKind::Whole { .. } => format!(": {}", kind.expected()),
            _ => String::new(),
        };
        let _ = writeln!(page, "| {name} | {} | {help}{limits} |", of.join(", "));
    }
    page
}

fn section<'a>(page: &mut String, title: &str, has_keys: bool, commands: impl Iterator<Item = &'a Command>) {
    let _ = writeln!(page, "\n## {title}\n");
    page.push_str(if has_keys {
        "| Command | Keys | What it does | In scripts |\n| --- | --- | --- | --- |\n"
    } else {
        "| Command | What it does | In scripts |\n| --- | --- | --- |\n"
    });
    for command in commands {
        let Command { title, help, .. } = command;
        let keys = keys_of(command).join(", ");
        let keys = if has_keys { format!(" {keys} |") } else { String::new() };
        let _ = writeln!(page, "| {title} |{keys} {help} | `{}` |", command.usage());
    }
}

/// The default keys of a command, in readable form.
pub fn keys_of(command: &Command) -> Vec<String> {
    command.shortcuts.iter().map(|&shortcut| Keys::from(shortcut).readable()).collect()
}
