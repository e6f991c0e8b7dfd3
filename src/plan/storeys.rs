//! What the name of a storey says of how high it lies.

/// Which storey a text means, counted from the ground floor, 0: 'basement' is -1, '2nd floor' and 'p2' are 2, 'mezzanine'
/// is between 0 and 1; `None` if it does not say. Numbers are taken as they are written, wherever they begin.
pub fn level(storey: &str) -> Option<f64> {
    const WORDS: [(&str, f64); 33] = [
        ("sub basement", -2.0),
        ("basement", -1.0),
        ("cellar", -1.0),
        ("interrato", -1.0),
        ("seminterrato", -0.5),
        ("keller", -1.0),
        ("lower", -0.5),
        ("ground", 0.0),
        ("terra", 0.0),
        ("pt", 0.0),
        ("eg", 0.0),
        ("erdgeschoss", 0.0),
        ("main", 0.25),
        ("rialzato", 0.25),
        ("mezzanine", 0.5),
        ("middle", 0.75),
        ("first", 1.0),
        ("primo", 1.0),
        ("second", 2.0),
        ("secondo", 2.0),
        ("third", 3.0),
        ("terzo", 3.0),
        ("fourth", 4.0),
        ("quarto", 4.0),
        ("fifth", 5.0),
        ("sixth", 6.0),
        ("seventh", 7.0),
        ("eighth", 8.0),
        ("ninth", 9.0),
        ("tenth", 10.0),
        ("upper", 50.0),
        ("top", 100.0),
        ("attic", 101.0),
    ];
    let text = storey.trim().to_lowercase();
    let digits = |from: &str| {
        let end = from.find(|c: char| !c.is_ascii_digit()).unwrap_or(from.len());
        from[..end].parse::<f64>().ok()
    };
    if let Some(at) = text.find(|c: char| c.is_ascii_digit()) {
        let number = digits(&text[at..])?;
        let before = text[..at].trim_end();
        let is_below = before.ends_with(['-', '−', '–']) && before.len() <= 3
            || before.ends_with("basement")
            || before.ends_with("ug")
            || before == "b";
        return Some(if is_below { -number } else { number });
    }
    let words: Vec<&str> = text.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty()).collect();
    WORDS.iter().find(|(word, _)| words.contains(word) || text == *word).map(|(_, level)| *level)
}

/// A storey as a whole number to sort by; the highest for one that does not say.
pub fn level_key(storey: &str) -> i64 {
    level(storey).map_or(i64::MAX, |level| (level * 1000.0) as i64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn storeys_stand_from_the_lowest_up() {
        let storeys = [
            "2nd basement",
            "-1",
            "basement",
            "ground floor",
            "mezzanine",
            "first floor",
            "1",
            "p2",
            "2nd floor",
            "level 3",
            "10",
            "top",
            "attic",
            "west wing",
        ];
        let levels: Vec<Option<f64>> = storeys.iter().skip(1).map(|storey| level(storey)).collect();
        let known: Vec<f64> = levels.iter().flatten().copied().collect();
        assert!(known.is_sorted(), "{levels:?}");
        assert_eq!(known.len(), storeys.len() - 2);
        assert_eq!(level("piano terra"), Some(0.0));
        assert_eq!(level("piano secondo"), Some(2.0));
        assert_eq!(level("EG"), Some(0.0));
        assert_eq!(level(""), None);
        assert_eq!(level("terrace"), None);
    }
}
