//! Fuzzy search by a few letters in order: 'zts' finds 'Zoom to selection'.

use nucleo_matcher::pattern::{Atom, AtomKind, CaseMatching, Normalization, Pattern};
use nucleo_matcher::{Config, Matcher, Utf32Str};

/// A search query.
pub(crate) struct Search {
    /// All its letters in order.
    whole: Atom,
    /// Its words, in any order.
    words: Pattern,
    matcher: Matcher,
    is_empty: bool,
}

/// A bonus for matching the words in the order typed.
const IN_ORDER: u32 = 1 << 20;

/// How well a text matches.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Hit {
    /// The higher, the better.
    pub score: u32,
    /// The indices of the text's characters that matched, in order.
    pub characters: Vec<u32>,
}

impl Search {
    pub(crate) fn new(query: &str) -> Self {
        let (case, accents, kind) = (CaseMatching::Ignore, Normalization::Smart, AtomKind::Fuzzy);
        let whole = Atom::new(query.trim(), case, accents, kind, false);
        let words = Pattern::new(query, case, accents, kind);
        let mut config = Config::DEFAULT;
        config.prefer_prefix = true;
        Self { whole, words, matcher: Matcher::new(config), is_empty: query.trim().is_empty() }
    }

    /// Whether the query is empty, which matches everything.
    pub(crate) fn is_empty(&self) -> bool {
        self.is_empty
    }

    /// Whether and how well a text matches.
    pub(crate) fn hit(&mut self, text: &str) -> Option<Hit> {
        let mut buffer = Vec::new();
        let mut characters = Vec::new();
        let text = Utf32Str::new(text, &mut buffer);
        let score = match self.whole.indices(text, &mut self.matcher, &mut characters) {
            Some(score) => IN_ORDER + u32::from(score),
            None => self.words.indices(text, &mut self.matcher, &mut characters)?,
        };
        characters.sort_unstable();
        characters.dedup();
        Some(Hit { score, characters })
    }
}

#[cfg(test)]
mod tests {
    use crate::app::look::search::*;

    #[test]
    fn letters_in_order_are_found_and_told() {
        let hit = Search::new("zts").hit("Zoom to selection").unwrap();
        assert_eq!(hit.characters, [0, 5, 8]);
        assert_eq!(Search::new("stz").hit("Zoom to selection"), None);
        // Words in any order, ignoring case and accents.
        assert!(Search::new("SEL zoom").hit("Zoom to selection").is_some());
        assert_eq!(Search::new("cafe").hit("Das Café").unwrap().characters, [4, 5, 6, 7]);
        // Matches at the beginning come first.
        let mut search = Search::new("na");
        assert!(search.hit("Names").unwrap().score > search.hit("Open a plan").unwrap().score);
        assert!(Search::new(" ").is_empty());
        assert_eq!(Search::new("").hit("Names").map(|hit| hit.characters), Some(Vec::new()));
        let mut search = Search::new("fill by f");
        assert!(search.hit("Fill by function").unwrap().score > search.hit("Fill by label").unwrap().score);
    }
}
