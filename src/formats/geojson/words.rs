//! The words that both reading and writing use.

use crate::labels::normalised_function;
use crate::plan::OpeningKind;

/// The origin of a label that follows from the room's function by the label scheme.
pub(super) const FROM_SCHEME: &str = "scheme";

/// The word for an opening's kind.
pub(super) const fn opening_word(kind: OpeningKind) -> &'static str {
    match kind {
        OpeningKind::Door => "door",
        OpeningKind::DoubleDoor => "double_door",
        OpeningKind::Passage => "passage",
        OpeningKind::Window => "window",
    }
}

/// What the words of the property `opening` mean. An opening to the outside that is a door or a
/// window, not told apart (`exterior_opening`), is a window: it must not count in `d`.
pub(super) fn opening_kind(word: &str) -> Option<OpeningKind> {
    match normalised_function(word).as_str() {
        "door" | "entrance door" | "sliding door" => Some(OpeningKind::Door),
        "double door" => Some(OpeningKind::DoubleDoor),
        "passage" | "open" => Some(OpeningKind::Passage),
        "window" | "exterior opening" => Some(OpeningKind::Window),
        _ => None,
    }
}
