//! Keyboard actions.

use egui::{Key, Modifiers};

use super::{Group, Verb};
use crate::app::replay::act::Act;
use crate::app::replay::words::{Words, did_you_mean, told};

pub(super) const GROUP: Group = Group {
    title: "Keyboard",
    verbs: &[
        Verb {
            name: "key",
            form: "key KEY",
            help: "Presses a key and lets it go: `key Enter`, `key Ctrl+Z`, `key Shift+Tab`.",
            parse: |words| {
                let (modifiers, key) = chord(words.text("the key")?)?;
                Ok(Box::new(move |stage| {
                    stage.gestures.key(modifiers);
                    stage.window.key(modifiers, key);
                    Ok(())
                }))
            },
        },
        Verb {
            name: "type",
            form: "type TEXT",
            help: "Types a text where the keyboard is.",
            parse: |words| {
                let text = words.text("the text")?.to_owned();
                Ok(Box::new(move |stage| {
                    stage.gestures.keys += text.chars().count();
                    stage.window.text(&text);
                    Ok(())
                }))
            },
        },
        Verb {
            name: "hold",
            form: "hold KEY",
            help: "Holds a key down, or Ctrl, Shift, Alt.",
            parse: |w| hold(w, true),
        },
        Verb { name: "let-go", form: "let-go KEY", help: "Lets a held key go.", parse: |words| hold(words, false) },
        Verb {
            name: "clipboard",
            form: "clipboard TEXT",
            help: "Puts a text where `key Ctrl+V` takes it from.",
            parse: |words| {
                let text = words.text("the text")?.to_owned();
                Ok(Box::new(move |stage| {
                    stage.window.set_clipboard(&text);
                    Ok(())
                }))
            },
        },
    ],
};

/// The modifier keys and their names in scripts.
const MODIFIERS: [(&str, Modifiers); 3] = [
    // Ctrl is the key that shortcuts use on each system: a script is the same everywhere.
    ("Ctrl", Modifiers { alt: false, ctrl: true, shift: false, mac_cmd: false, command: true }),
    ("Shift", Modifiers::SHIFT),
    ("Alt", Modifiers::ALT),
];

fn modifier(name: &str) -> Option<Modifiers> {
    MODIFIERS.into_iter().find(|(known, _)| *known == name).map(|(_, modifier)| modifier)
}

/// Modifiers separated by '+'.
///
/// # Errors
/// When one is not a modifier.
pub(super) fn modifiers_of(text: &str) -> Result<Modifiers, String> {
    text.split('+').try_fold(Modifiers::NONE, |modifiers, name| match modifier(name) {
        Some(modifier) => Ok(modifiers.plus(modifier)),
        None => Err(format!("{} is no modifier key: Ctrl, Shift, Alt", told(name))),
    })
}

/// A key with preceding modifiers.
fn chord(text: &str) -> Result<(Modifiers, Key), String> {
    // 'Ctrl++' is Ctrl and '+'.
    let (modifiers, key) = match text.strip_suffix("++") {
        Some(modifiers) => (modifiers, "+"),
        None if text == "+" => ("", "+"),
        None => text.rsplit_once('+').unwrap_or(("", text)),
    };
    let modifiers = if modifiers.is_empty() { Modifiers::NONE } else { modifiers_of(modifiers)? };
    let key = key_of(key)?;
    Ok((modifiers, key))
}

fn key_of(name: &str) -> Result<Key, String> {
    Key::from_name(name).ok_or_else(|| {
        let near = did_you_mean(name, Key::ALL.iter().map(|key| key.name()));
        let near = if near.is_empty() { near } else { format!(" ({near})") };
        format!("{} is no key{near}", told(name))
    })
}

fn hold(words: &mut Words<'_>, pressed: bool) -> Result<Act, String> {
    let name = words.text("the key")?;
    if let Some(modifier) = modifier(name) {
        return Ok(Box::new(move |stage| {
            stage.gestures.keys += usize::from(pressed);
            let held = stage.window.modifiers();
            let held = if pressed { held.plus(modifier) } else { without(held, modifier) };
            stage.window.hold_modifiers(held);
            Ok(())
        }));
    }
    let key = key_of(name)?;
    Ok(Box::new(move |stage| {
        stage.gestures.keys += usize::from(pressed);
        stage.window.hold(key, pressed);
        Ok(())
    }))
}

fn without(held: Modifiers, one: Modifiers) -> Modifiers {
    Modifiers {
        alt: held.alt && !one.alt,
        ctrl: held.ctrl && !one.ctrl,
        shift: held.shift && !one.shift,
        mac_cmd: held.mac_cmd && !one.mac_cmd,
        command: held.command && !one.command,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A chord in script syntax.
    fn chord_text(modifiers: Modifiers, key: Key) -> String {
        let held: Vec<&str> =
            MODIFIERS.into_iter().filter(|(_, one)| modifiers.contains(*one)).map(|(name, _)| name).collect();
        held.into_iter().chain([key.name()]).collect::<Vec<_>>().join("+")
    }

    #[test]
    fn every_chord_reads_back() {
        for &key in Key::ALL {
            for bits in 0..8 {
                let modifiers = (0..3)
                    .filter(|bit| bits & (1 << bit) != 0)
                    .fold(Modifiers::NONE, |modifiers, bit| modifiers.plus(MODIFIERS[bit].1));
                assert_eq!(chord(&chord_text(modifiers, key)), Ok((modifiers, key)), "{}", key.name());
            }
        }
        assert_eq!(chord("Ctrl++").map(|(_, key)| key), Ok(Key::Plus));
        assert_eq!(chord("Ctl+Z"), Err("Ctl is no modifier key: Ctrl, Shift, Alt".to_owned()));
        assert_eq!(chord("Entr"), Err("Entr is no key (did you mean Enter?)".to_owned()));
    }
}
