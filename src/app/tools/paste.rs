//! Pastes what was copied.

use super::ghost::ghost;
use super::{Call, Entry, Input, Scope, Tool, Value};
use crate::app::paint::preview::Preview;
use crate::edit::middle_of;
use crate::geometry::Transform;

pub(crate) const ENTRY: Entry = Entry {
    id: "paste",
    title: "Paste",
    help: "Paste what was copied; click to place it",
    keys: &[],
    strip: None,
    options: &[],
    make: || Box::new(Paste),
};

/// The pointer carries what was copied last.
struct Paste;

impl Tool for Paste {
    fn take(&mut self, input: Input, scope: &Scope<'_>) -> Vec<Call> {
        match input {
            Input::Click => vec![Call::new("paste-at", [Value::point(scope.at())])],
            Input::SecondaryClick => vec![Call::new("clear-selection", [])],
            _ => Vec::new(),
        }
    }

    fn hint(&self, _: &Scope<'_>) -> String {
        "Paste: click to place it, as often as you like · Esc ends".to_owned()
    }

    fn preview(&self, scope: &Scope<'_>, preview: &mut Preview) {
        let Some(copied) = scope.copied else { return };
        let by = scope.at() - middle_of(copied);
        ghost(copied, Transform::translation(by), preview);
    }
}
