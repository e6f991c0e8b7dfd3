//! Natural sort order: 'floor 9' before 'floor 10'.

/// A natural sort key: runs of digits compare as numbers, letters ignore case; ties are broken by the
/// text as written.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct NaturalKey {
    parts: Vec<Part>,
    text: String,
}

#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Part {
    /// A run of digits of any length: how many without leading zeros, then those digits.
    Number(usize, String),
    Word(String),
}

impl NaturalKey {
    /// The key of a text.
    pub fn of(text: &str) -> Self {
        let mut parts = Vec::new();
        let mut rest = text;
        while let Some(first) = rest.chars().next() {
            let is_number = first.is_ascii_digit();
            let end = rest.find(|c: char| c.is_ascii_digit() != is_number).unwrap_or(rest.len());
            let (part, after) = rest.split_at(end);
            parts.push(if is_number {
                let digits = part.trim_start_matches('0');
                Part::Number(digits.len(), digits.to_owned())
            } else {
                Part::Word(part.to_lowercase())
            });
            rest = after;
        }
        Self { parts, text: text.to_owned() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_in_names_count() {
        let sorted = |mut names: Vec<&'static str>| {
            names.sort_by_cached_key(|name| NaturalKey::of(name));
            names
        };
        assert_eq!(
            sorted(vec!["b 10", "b 9", "B 2", "a", "b 010", "b", "10", "9"]),
            ["9", "10", "a", "b", "B 2", "b 9", "b 010", "b 10"]
        );
        assert_eq!(
            sorted(vec!["R10", "R2", "R1a", "R1", "Hall", "99999999999999999999999", "2.10", "2.9"]),
            ["2.9", "2.10", "99999999999999999999999", "Hall", "R1", "R1a", "R2", "R10"]
        );
    }
}
