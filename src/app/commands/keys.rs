//! Shortcuts: which command the pressed keys mean, and how keys are written.

use egui::{Context, Event, InputState, Key, KeyboardShortcut, Modifiers};

use super::{COMMANDS, Command};

/// Keys as people write them: 'Ctrl+Shift+S', '+'.
pub(super) fn text(context: &Context, shortcut: KeyboardShortcut) -> String {
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

/// Takes the shortcuts pressed since the last frame out of the input and gives their commands.
/// `is_typing`: a text field has the keyboard, which then keeps what it needs itself.
pub(in crate::app) fn take_pressed(input: &mut InputState, is_typing: bool) -> Vec<&'static Command> {
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
    use super::*;

    #[test]
    fn exact_modifiers_decide() {
        let plain = |key| KeyboardShortcut::new(Modifiers::NONE, key);
        let undo = KeyboardShortcut::new(Modifiers::COMMAND, Key::Z);
        let pressed = Modifiers { ctrl: true, command: true, ..Modifiers::NONE };
        assert!(matches(&undo, Key::Z, pressed));
        assert!(!matches(&undo, Key::Z, pressed.plus(Modifiers::SHIFT)));
        assert!(!matches(&plain(Key::L), Key::L, Modifiers::SHIFT));
        assert!(matches(&plain(Key::Plus), Key::Plus, Modifiers::SHIFT));
    }
}
