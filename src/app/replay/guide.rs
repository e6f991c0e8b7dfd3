//! A description of the language, from the tables that define it.

use std::fmt::Write as _;

use super::place::FORMS;
use super::verbs::{VERBS, expectations};

/// Every verb, place and expectation, as Markdown tables, for `docs/replay.md`; a test keeps the two in
/// sync. The commands are in `docs/commands.md`.
pub fn guide() -> String {
    let mut text = String::new();
    for group in VERBS {
        let rows = group.verbs.iter().map(|verb| (verb.form, verb.help));
        table(&mut text, group.title, ("step", "what it does"), rows);
    }
    table(&mut text, "Places", ("place", "where it is"), FORMS.into_iter());
    table(&mut text, "Expectations", ("behind `expect`", "what must be so"), expectations());
    text
}

fn table<'a>(text: &mut String, title: &str, head: (&str, &str), rows: impl Iterator<Item = (&'a str, &'a str)>) {
    // Writing to a string cannot fail.
    let _ = write!(text, "### {title}\n\n| {} | {} |\n| --- | --- |\n", head.0, head.1);
    for (form, help) in rows {
        let _ = writeln!(text, "| `{}` | {} |", form.replace('|', "\\|"), help.replace('|', "\\|"));
    }
    text.push('\n');
}
