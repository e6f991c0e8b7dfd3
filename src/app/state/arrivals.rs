//! Input in the order in which it came, however slow the frames are.
//!
//! A window sees all that was typed and clicked since its last frame at once. Then letters that were typed behind
//! Enter would go where the keyboard was before it, and a key would mean the room on which the pointer was a frame
//! ago. So what moves the keyboard or presses something ends its frame, and what came behind it waits for the next.

use std::collections::VecDeque;

use egui::{Context, Event, Key, RawInput};

use super::App;

/// What has come and not been shown to the window yet, each with its time in seconds.
#[derive(Default)]
pub(crate) struct Arrivals {
    waiting: VecDeque<(f64, Event)>,
}

/// How an event goes with those before it in a frame.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    /// It goes with anything.
    Light,
    /// The pointer moves, or the wheel turns.
    Moves,
    /// It goes into the text that has the keyboard.
    Writes,
    /// It acts, on what has been written and pointed at before: nothing comes behind it.
    Acts,
    /// A button goes down: where the pointer is now, with the keyboard where it was.
    Presses,
    /// A button goes up: what was dragged until now is to be seen first.
    Releases,
}

fn kind(event: &Event, is_typing: bool) -> Kind {
    match event {
        Event::Text(_) | Event::Ime(_) => Kind::Writes,
        Event::Copy | Event::Cut | Event::Paste(_) if is_typing => Kind::Writes,
        Event::Copy | Event::Cut | Event::Paste(_) => Kind::Acts,
        Event::Key { pressed: true, key, modifiers, .. } => {
            // Selecting, deleting and undoing in a text take their turn there.
            let is_of_text = match key {
                Key::Enter | Key::Tab | Key::Escape => false,
                key if (Key::F1..=Key::F35).contains(key) => false,
                Key::PageUp | Key::PageDown | Key::ArrowUp | Key::ArrowDown => false,
                Key::A | Key::Y | Key::Z => !modifiers.alt,
                Key::ArrowLeft | Key::ArrowRight | Key::Backspace | Key::Delete | Key::Home | Key::End => true,
                _ => !modifiers.command && !modifiers.ctrl && !modifiers.alt,
            };
            if is_typing && is_of_text { Kind::Writes } else { Kind::Acts }
        }
        Event::PointerButton { pressed: true, .. } => Kind::Presses,
        Event::PointerButton { pressed: false, .. } => Kind::Releases,
        Event::PointerMoved(_) | Event::MouseMoved(_) | Event::MouseWheel { .. } | Event::Zoom(_) => Kind::Moves,
        _ => Kind::Light,
    }
}

/// How many of the first events make a frame.
fn first_frame(events: &VecDeque<(f64, Event)>, is_typing: bool) -> usize {
    let (mut has_moved, mut has_written) = (false, false);
    for (index, (_, event)) in events.iter().enumerate() {
        let waits = match kind(event, is_typing) {
            Kind::Light => continue,
            Kind::Moves => {
                has_moved = true;
                continue;
            }
            Kind::Writes => {
                has_written = true;
                continue;
            }
            Kind::Acts => has_moved || has_written,
            Kind::Presses => has_written,
            Kind::Releases => has_moved || has_written,
        };
        if waits {
            return index;
        }
        // The text that a key writes belongs to the key: it is none of a field that the key opens. Enter and the like
        // write none.
        let is_key = matches!(event, Event::Key { key, .. } if !matches!(key, Key::Enter | Key::Tab | Key::Escape));
        let has_text = matches!(events.get(index + 1), Some((_, Event::Text(_))));
        return index + 1 + usize::from(is_key && has_text);
    }
    events.len()
}

impl Arrivals {
    /// Leaves in `raw` what makes the next frame. Returns whether more waits.
    fn take_frame(&mut self, raw: &mut RawInput, is_typing: bool) -> bool {
        let now_secs = raw.time.unwrap_or_default();
        let is_behind = !self.waiting.is_empty();
        self.waiting.extend(std::mem::take(&mut raw.events).into_iter().map(|event| (now_secs, event)));
        let number = first_frame(&self.waiting, is_typing);
        let taken: Vec<(f64, Event)> = self.waiting.drain(..number).collect();
        // Two clicks are as far apart as they were made, not as they are shown.
        if is_behind && let Some((secs, _)) = taken.last() {
            raw.time = raw.time.map(|_| *secs);
        }
        raw.events = taken.into_iter().map(|(_, event)| event).collect();
        !self.waiting.is_empty()
    }
}

impl App {
    /// Takes the input that has come since the last frame: leaves in it what the next frame shows, and keeps the rest.
    pub(crate) fn take_arrivals(&mut self, context: &Context, raw: &mut RawInput) {
        // The dialog that gets the keyboard in a moment is another program: what is typed meanwhile is meant for it.
        if self.session.dialogs.is_open() {
            let is_typed = |event: &Event| {
                matches!(event, Event::Text(_) | Event::Ime(_) | Event::Paste(_) | Event::Cut | Event::Copy)
                    || matches!(event, Event::Key { pressed: true, .. })
            };
            self.arrivals.waiting.retain(|(_, event)| !is_typed(event));
            raw.events.retain(|event| !is_typed(event));
        }
        let is_typing = context.text_edit_focused() || !self.tools.typed.is_empty();
        if self.arrivals.take_frame(raw, is_typing) {
            context.request_repaint();
        }
    }

    /// Whether input waits for the next frame.
    pub(crate) fn has_arrivals(&self) -> bool {
        !self.arrivals.waiting.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::{Modifiers, PointerButton, Pos2};

    fn key(key: Key) -> Event {
        Event::Key { key, physical_key: None, pressed: true, repeat: false, modifiers: Modifiers::NONE }
    }

    fn text(text: &str) -> Event {
        Event::Text(text.to_owned())
    }

    fn button(pressed: bool) -> Event {
        let button = PointerButton::Primary;
        Event::PointerButton { pos: Pos2::ZERO, button, pressed, modifiers: Modifiers::NONE }
    }

    /// The sizes of the frames that events come in.
    fn frames(events: &[Event], is_typing: bool) -> Vec<usize> {
        let mut arrivals = Arrivals::default();
        let mut sizes = Vec::new();
        let mut raw = RawInput { events: events.to_vec(), time: Some(1.0), ..RawInput::default() };
        loop {
            let waits = arrivals.take_frame(&mut raw, is_typing);
            sizes.push(raw.events.len());
            if !waits {
                assert_eq!(sizes.iter().sum::<usize>(), events.len());
                return sizes;
            }
            raw = RawInput { time: Some(2.0), ..RawInput::default() };
        }
    }

    #[test]
    fn what_acts_ends_its_frame() {
        let moved = || Event::PointerMoved(Pos2::ZERO);
        assert_eq!(frames(&[key(Key::F2), text("a"), text("b"), key(Key::Enter), text("c")], true), [2, 1, 1, 1]);
        assert_eq!(frames(&[key(Key::A), text("a"), key(Key::Backspace), key(Key::Home), text("b")], true), [5]);
        // A key and its text are one; the next key may mean something else by then.
        assert_eq!(frames(&[key(Key::R), text("r"), key(Key::B), text("b")], false), [2, 2]);
        // Pointing at something, then a key; dragging, then letting go.
        assert_eq!(frames(&[moved(), key(Key::B), moved(), button(true)], false), [1, 1, 2]);
        assert_eq!(frames(&[moved(), button(true), moved(), moved(), button(false), moved()], false), [2, 2, 1, 1]);
        assert_eq!(frames(&[button(true), button(false), button(true), button(false)], false), [1, 1, 1, 1]);
        assert_eq!(frames(&[text("a"), button(true)], true), [1, 1]);
        assert_eq!(frames(&[], false), [0]);
    }
}
