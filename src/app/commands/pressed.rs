//! The commands for the keys that were pressed.

use egui::{Event, InputState, Key, Modifiers};

use super::{COMMANDS, Command};
use crate::app::look::keys::Keys;
use crate::app::session::settings::Settings;

/// Whether a command has these keys.
pub(crate) fn is_shortcut(settings: &Settings, key: Key, modifiers: Modifiers) -> bool {
    let has = |command: &Command| settings.keys_of(command.id).iter().any(|keys| keys.is_pressed(key, modifiers));
    COMMANDS.iter().any(has)
}

/// Takes the shortcuts pressed since the last frame out of the input and returns their commands.
/// `is_typing`: a text field has the keyboard and keeps the keys it needs.
pub(crate) fn take_pressed(input: &mut InputState, settings: &Settings, is_typing: bool) -> Vec<&'static Command> {
    let mut pressed = Vec::new();
    input.events.retain(|event| {
        let Event::Key { key, pressed: true, modifiers, .. } = event else { return true };
        let hit = COMMANDS.iter().find(|command| {
            let is_it = |keys: &Keys| keys.is_pressed(*key, *modifiers) && !(is_typing && keys.belongs_to_text());
            settings.keys_of(command.id).iter().any(is_it)
        });
        pressed.extend(hit);
        hit.is_none()
    });
    pressed
}
