//! Shortcuts: which command the pressed keys mean, how keys are written, and which ones users may choose.

use std::fmt;
use std::str::FromStr;

use egui::{Context, Key, KeyboardShortcut, Modifiers};

/// Keys pressed together: a command's shortcut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Keys {
    /// Only Ctrl (Cmd on a Mac), Alt and Shift count.
    modifiers: Modifiers,
    key: Key,
}

impl Keys {
    /// Keys as reported by egui.
    pub fn new(modifiers: Modifiers, key: Key) -> Self {
        let mut wanted = Modifiers::NONE;
        wanted.command = modifiers.command;
        wanted.alt = modifiers.alt;
        // '?' needs Shift on some keyboards and not on others.
        wanted.shift = modifiers.shift && !IS_TYPED_WITH_SHIFT.contains(&key);
        Self { modifiers: wanted, key }
    }

    /// As written on the user's system: 'Ctrl+Shift+S', '+'.
    pub fn text(self, context: &Context) -> String {
        let modifiers = context.format_modifiers(self.modifiers);
        let plus = if modifiers.is_empty() { "" } else { "+" };
        format!("{modifiers}{plus}{}", self.key_text())
    }

    /// As written in the manual, the same on every system.
    pub(crate) fn readable(self) -> String {
        format!("{}{}", self.modifiers_text(), self.key_text())
    }

    fn key_text(self) -> &'static str {
        match self.key {
            Key::PageUp => "Page up",
            Key::PageDown => "Page down",
            Key::Escape => "Esc",
            key => key.symbol_or_name(),
        }
    }

    /// 'Ctrl+Shift+'.
    fn modifiers_text(self) -> String {
        let Modifiers { command, alt, shift, .. } = self.modifiers;
        let held = [(command, "Ctrl+"), (alt, "Alt+"), (shift, "Shift+")];
        held.into_iter().filter(|(is_held, _)| *is_held).map(|(_, name)| name).collect()
    }

    /// Why users may not choose these keys; `None` if they may.
    pub fn why_reserved(self) -> Option<&'static str> {
        let Modifiers { command, alt, .. } = self.modifiers;
        match self.key {
            Key::Tab if command => None,
            Key::Tab | Key::Space | Key::Enter | Key::ArrowLeft | Key::ArrowRight | Key::ArrowUp | Key::ArrowDown => {
                Some("it goes from control to control and presses them")
            }
            Key::Escape => Some("it leaves whatever is open"),
            Key::Backspace | Key::Home | Key::End if !command && !alt => Some("it belongs to text"),
            Key::C | Key::V | Key::X if command && !alt => Some("it belongs to the clipboard"),
            Key::F4 if alt => Some("the system closes windows with it"),
            _ => None,
        }
    }

    pub(crate) fn is_pressed(self, key: Key, modifiers: Modifiers) -> bool {
        // Some systems report both Ctrl and Cmd.
        Self::new(modifiers, key) == self && (modifiers.command || !modifiers.ctrl)
    }

    /// Whether a text field uses these keys itself.
    pub(crate) fn belongs_to_text(self) -> bool {
        let is_function_key = self.key >= Key::F1 && self.key <= Key::F35;
        let is_plain = !self.modifiers.command && !is_function_key;
        let is_of_clipboard = matches!(self.key, Key::A | Key::C | Key::V | Key::X);
        let has_more = self.modifiers.alt || self.modifiers.shift;
        is_plain || matches!(self.key, Key::Z | Key::Y) || (is_of_clipboard && !has_more)
    }
}

impl From<KeyboardShortcut> for Keys {
    fn from(shortcut: KeyboardShortcut) -> Self {
        Self::new(shortcut.modifiers, shortcut.logical_key)
    }
}

/// Characters that most keyboards have only with Shift.
const IS_TYPED_WITH_SHIFT: [Key; 7] = [
    Key::Plus,
    Key::Questionmark,
    Key::Exclamationmark,
    Key::Colon,
    Key::Pipe,
    Key::OpenCurlyBracket,
    Key::CloseCurlyBracket,
];

/// As in settings and scripts, the same on every system: 'Ctrl+Shift+S', 'Plus'.
impl fmt::Display for Keys {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}", self.modifiers_text(), self.key.name())
    }
}

/// A text that is not a shortcut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NoKeys;

impl fmt::Display for NoKeys {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("keys such as 'Ctrl+Shift+K', 'F5' or 'Plus'")
    }
}

impl FromStr for Keys {
    type Err = NoKeys;

    fn from_str(text: &str) -> Result<Self, NoKeys> {
        let mut modifiers = Modifiers::NONE;
        let mut rest = text.trim();
        while let Some((first, behind)) = rest.split_once('+').filter(|(_, behind)| !behind.is_empty()) {
            match first.trim().to_lowercase().as_str() {
                "ctrl" | "cmd" | "command" => modifiers.command = true,
                "alt" | "option" => modifiers.alt = true,
                "shift" => modifiers.shift = true,
                _ => return Err(NoKeys),
            }
            rest = behind.trim();
        }
        let named = |name: &str| Key::from_name(name).or_else(|| Key::from_name(&name.to_uppercase()));
        named(rest).map(|key| Self::new(modifiers, key)).ok_or(NoKeys)
    }
}

#[cfg(test)]
mod tests {
    use crate::app::look::keys::*;

    #[test]
    fn exact_modifiers_decide() {
        let keys = |text: &str| text.parse::<Keys>().unwrap();
        let ctrl = Modifiers { ctrl: true, command: true, ..Modifiers::NONE };
        assert!(keys("Ctrl+Z").is_pressed(Key::Z, ctrl));
        assert!(!keys("Ctrl+Z").is_pressed(Key::Z, ctrl.plus(Modifiers::SHIFT)));
        assert!(!keys("L").is_pressed(Key::L, Modifiers::SHIFT));
        assert!(!keys("L").is_pressed(Key::L, Modifiers::CTRL));
        for modifiers in [Modifiers::NONE, Modifiers::SHIFT] {
            assert!(keys("+").is_pressed(Key::Plus, modifiers));
            assert!(keys("?").is_pressed(Key::Questionmark, modifiers));
        }
    }

    #[test]
    fn keys_are_read_as_they_are_written() {
        for text in ["Ctrl+Shift+S", "Plus", "F5", "Alt+Minus", "PageUp", "Questionmark", "Ctrl+Alt+Shift+1"] {
            assert_eq!(text.parse::<Keys>().map(|keys| keys.to_string()), Ok(text.to_owned()));
        }
        for (other, text) in
            [("ctrl + k", "Ctrl+K"), ("+", "Plus"), ("Shift+?", "Questionmark"), ("cmd++", "Ctrl+Plus")]
        {
            assert_eq!(other.parse::<Keys>().map(|keys| keys.to_string()), Ok(text.to_owned()), "{other}");
        }
        for wrong in ["", "Ctrl+", "Ctrl", "Foo+K", "KK", "Ctrl+K+"] {
            assert_eq!(wrong.parse::<Keys>(), Err(NoKeys), "{wrong}");
        }
    }

    #[test]
    fn what_moves_the_keyboard_or_belongs_to_text_is_reserved() {
        for text in ["Tab", "Shift+Tab", "Space", "Enter", "Up", "Escape", "Ctrl+C", "Alt+F4", "Backspace"] {
            assert!(text.parse::<Keys>().unwrap().why_reserved().is_some(), "{text}");
        }
        for text in ["C", "Ctrl+B", "F4", "Delete", "Ctrl+Alt+C", "Alt+Home"] {
            assert_eq!(text.parse::<Keys>().unwrap().why_reserved(), None, "{text}");
        }
    }
}
