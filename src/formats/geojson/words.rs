//! The words that both reading and writing use.

use crate::labels::normalised_function;
use crate::plan::OpeningKind;

/// The origin of a label that the scheme gives for the room's function.
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

/// The meanings of the property `opening`. An opening to the outside that may be a door or a window
/// (`exterior_opening`) counts as a window: it must not count in `d`.
pub(super) fn opening_kind(word: &str) -> Option<OpeningKind> {
    match normalised_function(word).as_str() {
        "door" | "entrance door" | "sliding door" => Some(OpeningKind::Door),
        "double door" => Some(OpeningKind::DoubleDoor),
        "passage" | "open" => Some(OpeningKind::Passage),
        "window" | "exterior opening" => Some(OpeningKind::Window),
        _ => None,
    }
}
