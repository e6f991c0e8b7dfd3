//! Natural sort order: 'floor 9' before 'floor 10'.

use std::cmp::Ordering;

/// A natural sort key: runs of digits compare as numbers, letters ignore case; ties are broken by the
/// text as written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NaturalKey(String);

impl NaturalKey {
    /// The key of a text.
    pub fn of(text: &str) -> Self {
        Self(text.to_owned())
    }
}

impl PartialOrd for NaturalKey {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for NaturalKey {
    fn cmp(&self, other: &Self) -> Ordering {
        compare(&self.0, &other.0)
    }
}

/// The order of two texts, that of their [`NaturalKey`]s.
pub fn compare(text: &str, other: &str) -> Ordering {
    let (mut rest, mut other_rest) = (text, other);
    loop {
        let order = match (take_part(&mut rest), take_part(&mut other_rest)) {
            (None, None) => return text.cmp(other),
            (None, Some(_)) => Ordering::Less,
            (Some(_), None) => Ordering::Greater,
            (Some(Part::Number(_)), Some(Part::Word(_))) => Ordering::Less,
            (Some(Part::Word(_)), Some(Part::Number(_))) => Ordering::Greater,
            // Of digits without leading zeros, more are a larger number.
            (Some(Part::Number(p)), Some(Part::Number(q))) => p.len().cmp(&q.len()).then_with(|| p.cmp(q)),
            (Some(Part::Word(p)), Some(Part::Word(q))) => {
                p.chars().flat_map(char::to_lowercase).cmp(q.chars().flat_map(char::to_lowercase))
            }
        };
        if order.is_ne() {
            return order;
        }
    }
}

/// A run of digits of any length, without leading zeros; or what stands between two of them.
enum Part<'a> {
    Number(&'a str),
    Word(&'a str),
}

/// Takes the next part off a text.
fn take_part<'a>(rest: &mut &'a str) -> Option<Part<'a>> {
    let is_number = rest.as_bytes().first()?.is_ascii_digit();
    // Digits are bytes of their own in UTF-8.
    let end = rest.bytes().position(|byte| byte.is_ascii_digit() != is_number).unwrap_or(rest.len());
    let (part, after) = rest.split_at(end);
    *rest = after;
    Some(if is_number { Part::Number(part.trim_start_matches('0')) } else { Part::Word(part) })
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
        assert_eq!(sorted(vec!["é2", "É10", "É1", "e3", "é", ""]), ["", "e3", "é", "É1", "é2", "É10"]);
    }
}
