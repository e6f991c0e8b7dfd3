//! The list of formats as text: for `--help`, and as a page of the manual.

use std::fmt::Write as _;

use super::{FORMATS, Format, FormatOption, Holds};

/// The text above the tables of the page.
const INTRODUCTION: &str = "\
# Formats

What `enfilade import` and the window read, and what `enfilade export` writes. A file's format is told by what it
holds, and by its name where that says no more. This page is written from the list of formats
(`src/formats/mod.rs`).

| Format | Word | Endings | Read | Written | |
| --- | --- | --- | --- | --- | --- |
";

/// The page of the manual, as Markdown.
pub fn page() -> String {
    let mut page = INTRODUCTION.to_owned();
    for format in FORMATS {
        let endings: Vec<String> = format.endings.iter().map(|ending| format!("`.{ending}`")).collect();
        let endings = if endings.is_empty() { "a folder".to_owned() } else { endings.join(", ") };
        let written = match format.exporter.map(|exporter| exporter.holds()) {
            None => "–",
            Some(Holds::OnePlan) => "one plan a file",
            Some(Holds::ManyPlans) => "all plans in one",
        };
        let read = if format.importer.is_some() { "yes" } else { "–" };
        let _ =
            writeln!(page, "| {} | `{}` | {endings} | {read} | {written} | {} |", format.name, format.id, format.about);
    }
    for (title, options_of) in SIDES {
        let _ = write!(page, "\n## Options for {title}\n\n");
        page.push_str("| Format | `--option` | Values | Default | |\n| --- | --- | --- | --- | --- |\n");
        for format in FORMATS {
            for option in options_of(format) {
                let (values, default) = (option.values(), option.default_in_words());
                let (name, help) = (option.name(), option.help());
                let _ = writeln!(page, "| {} | `{name}` | {values} | {default} | {help} |", format.name);
            }
        }
    }
    page
}

const SIDES: [(&str, OptionsOf); 2] = [("reading", import_options), ("writing", export_options)];

type OptionsOf = fn(&Format) -> &'static [FormatOption];

/// The options for reading a format.
pub fn import_options(format: &Format) -> &'static [FormatOption] {
    format.importer.map_or(&[], |importer| importer.options())
}

/// The options for writing a format.
pub fn export_options(format: &Format) -> &'static [FormatOption] {
    format.exporter.map_or(&[], |exporter| exporter.options())
}

/// The formats that can be read and their options, for `--help`.
pub fn import_help() -> String {
    help(|format| format.importer.is_some(), import_options)
}

/// The formats that can be written and their options, for `--help`.
pub fn export_help() -> String {
    help(|format| format.exporter.is_some(), export_options)
}

fn help(has_side: fn(&Format) -> bool, options_of: OptionsOf) -> String {
    let formats: Vec<&Format> = FORMATS.iter().copied().filter(|format| has_side(format)).collect();
    let wide = formats.iter().map(|format| format.id.len()).max().unwrap_or_default();
    let mut text = "Formats and their options (--option NAME=VALUE):\n".to_owned();
    for format in formats {
        let endings: Vec<String> = format.endings.iter().map(|ending| format!(".{ending}")).collect();
        let endings = if endings.is_empty() { "a folder".to_owned() } else { endings.join(", ") };
        let _ = writeln!(text, "  {:<wide$}  {} ({endings})", format.id, format.name);
        for option in options_of(format) {
            let (values, default) = (option.values(), option.default_in_words());
            let _ = writeln!(text, "  {:<wide$}    {}: {}", "", option.name(), option.help());
            let _ = writeln!(text, "  {:<wide$}    ({values}; default: {default})", "");
        }
    }
    text.trim_end().to_owned()
}
