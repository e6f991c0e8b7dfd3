//! Wording for people: counts, lists, shortened texts, "did you mean" suggestions.

/// Capitalises the first letter.
pub fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map(|first| first.to_uppercase().chain(letters).collect()).unwrap_or_default()
}

/// A count with its noun, pluralised.
pub fn count(number: usize, thing: &str) -> String {
    let plural = if number == 1 { "" } else { "s" };
    format!("{} {thing}{plural}", thousands(number as u64))
}

/// A number with its thousands separated.
pub fn thousands(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            // A no-break space: at the narrow one (U+202F), the window would begin a new line.
            text.push('\u{a0}');
        }
        text.push(digit);
    }
    text
}

/// A share in whole percent, as of something that goes on: '40 %', and 100 only at the end.
pub fn percent_done(share: f64) -> String {
    format!("{:.0} %", (100.0 * share).floor().clamp(0.0, 100.0))
}

/// A text in which no line begins with the unit of a number.
pub fn unbroken(text: &str) -> String {
    [" %", " m²", " sq ft"].iter().fold(text.to_owned(), |text, unit| {
        let kept = unit.replace(' ', "\u{a0}");
        text.replace(unit, &kept)
    })
}

/// The known words most similar to a misspelt one, closest first.
pub fn similar<'a>(wrong: &str, words: impl Iterator<Item = &'a str>, most: usize) -> Vec<&'a str> {
    // Below this, two words have hardly more in common than any two.
    const LEAST: f64 = 0.75;
    let wrong = wrong.trim().to_lowercase();
    let mut found: Vec<(f64, &str)> = words
        .map(|word| (strsim::jaro_winkler(&wrong, &word.to_lowercase()), word))
        .filter(|(likeness, _)| *likeness >= LEAST)
        .collect();
    found.sort_by(|p, q| q.0.total_cmp(&p.0).then(p.1.cmp(q.1)));
    // Next to a good match, poor ones only distract.
    let best = found.first().map_or(1.0, |(likeness, _)| *likeness);
    found.retain(|(likeness, _)| *likeness >= best - 0.05);
    found.into_iter().take(most).map(|(_, word)| word).collect()
}

/// 'a', 'b' or 'c'.
pub fn or_list(words: &[&str]) -> String {
    let quoted: Vec<String> = words.iter().map(|word| format!("'{word}'")).collect();
    match quoted.as_slice() {
        [all @ .., last] if !all.is_empty() => format!("{} or {last}", all.join(", ")),
        _ => quoted.concat(),
    }
}

/// a, b or c: like [`or_list`], for words that need no quotes.
pub fn or_words(words: &[&str]) -> String {
    match words {
        [all @ .., last] if !all.is_empty() => format!("{} or {last}", all.join(", ")),
        _ => words.concat(),
    }
}

/// A text cut to at most this many characters, with an ellipsis.
pub fn shortened(text: &str, most: usize) -> String {
    if text.chars().count() <= most {
        return text.to_owned();
    }
    text.chars().take(most.saturating_sub(1)).chain(['…']).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_line_begins_with_a_unit() {
        let kept = "86\u{a0}% of 16.2\u{a0}m² or 174\u{a0}sq\u{a0}ft";
        assert_eq!(unbroken("86 % of 16.2 m² or 174 sq ft"), kept);
    }

    #[test]
    fn numbers_read_well() {
        assert_eq!(count(1, "room"), "1 room");
        assert_eq!(count(0, "room"), "0 rooms");
        assert_eq!(count(1234567, "wall"), "1\u{a0}234\u{a0}567 walls");
    }
}
