//! The report of an import: notes, a table, and JSON for machines.

use std::collections::BTreeMap;
use std::io::Write as _;
use std::path::Path;

use serde::Serialize;

use super::super::{CliError, Terminal};
use super::file::{Content, File, State};
use crate::formats::{FileError, Note, NoteKind};

/// Every note as `path:line: kind: element: what`, then an empty line.
pub(super) fn list_notes(files: &[File], terminal: &mut Terminal) -> Result<(), CliError> {
    for file in files {
        for note in file.notes() {
            write!(terminal.out, "{}", place(file, note))?;
            write!(terminal.out, ": {}: ", note.kind.name())?;
            if !note.place.element.is_empty() {
                write!(terminal.out, "{}: ", note.place.element)?;
            }
            writeln!(terminal.out, "{}", note.what)?;
        }
        if let Content::Foreign(kind) = &file.content {
            writeln!(terminal.out, "{}: skipped: {kind}", file.job.input.path.display())?;
        }
    }
    if files.iter().any(|file| !file.notes().is_empty() || matches!(file.content, Content::Foreign(_))) {
        writeln!(terminal.out)?;
    }
    Ok(())
}

fn place(file: &File, note: &Note) -> String {
    let path = file.job.input.path.display();
    note.place.line.map_or_else(|| path.to_string(), |line| format!("{path}:{line}"))
}

/// One line for notes that differ only in names and numbers, with their number and the first of them.
pub(super) fn summarise_notes(files: &[File], terminal: &mut Terminal) -> Result<(), CliError> {
    /// Notes of one kind and text.
    struct Group<'a> {
        count: usize,
        first: (&'a File, &'a Note),
    }
    let mut groups: BTreeMap<(NoteKind, String), Group<'_>> = BTreeMap::new();
    for file in files {
        for note in file.notes() {
            let group = groups.entry((note.kind, masked(&note.what)));
            group.or_insert(Group { count: 0, first: (file, note) }).count += 1;
        }
    }
    if groups.is_empty() {
        return Ok(());
    }
    writeln!(terminal.out, "Repaired and left out, with the first place of each (-v lists all):")?;
    let mut groups: Vec<((NoteKind, String), Group<'_>)> = groups.into_iter().collect();
    groups.sort_by(|((a_kind, _), a), ((b_kind, _), b)| a_kind.cmp(b_kind).then(b.count.cmp(&a.count)));
    for ((kind, what), Group { count, first: (file, note) }) in groups {
        let what = if count == 1 { &note.what } else { &what };
        writeln!(terminal.out, "  {:7} {count:5} x  {what}", kind.name())?;
        writeln!(terminal.out, "                   {}", place(file, note))?;
    }
    writeln!(terminal.out)?;
    Ok(())
}

/// A text with '…' in place of quoted text and numbers.
fn masked(what: &str) -> String {
    let mut masked = String::new();
    let mut rest = what;
    while let Some(letter) = rest.chars().next() {
        let (length, mark) = if letter == '\'' && rest[1..].contains('\'') {
            // A quoted name ends before a space, a comma or the end, and may hold an apostrophe.
            let end = rest[1..].match_indices('\'').map(|(at, _)| at + 2);
            let closing = end.into_iter().find(|&end| !rest[end..].starts_with(char::is_alphanumeric));
            (closing.unwrap_or(1), "'…'")
        } else if letter.is_ascii_digit() {
            let end = rest.find(|c: char| !(c.is_ascii_digit() || c == '.')).unwrap_or(rest.len());
            (rest[..end].trim_end_matches('.').len(), "…")
        } else {
            (letter.len_utf8(), "")
        };
        masked.push_str(if mark.is_empty() { &rest[..length] } else { mark });
        rest = &rest[length..];
    }
    masked
}

/// The columns of the table.
#[derive(Clone, Copy, Default, Serialize)]
struct Counts {
    files: usize,
    plans: usize,
    rooms: usize,
    openings: usize,
    healed: usize,
    skipped: usize,
    failed: usize,
}

impl Counts {
    const NAMES: [&'static str; 7] = ["files", "plans", "rooms", "openings", "healed", "skipped", "failed"];

    const fn values(&self) -> [usize; 7] {
        [self.files, self.plans, self.rooms, self.openings, self.healed, self.skipped, self.failed]
    }

    fn add(&mut self, file: &File) {
        let count = |kind| file.notes().iter().filter(|note| note.kind == kind).count();
        match file.content {
            Content::Foreign(_) => return,
            Content::Failed(_) => self.failed += 1,
            Content::Plans { .. } => {}
        }
        self.files += 1;
        self.plans += file.plans().len();
        self.rooms += file.plans().iter().map(|plan| plan.plan.rooms().len()).sum::<usize>();
        self.openings += file.plans().iter().map(|plan| plan.plan.openings().len()).sum::<usize>();
        self.healed += count(NoteKind::Healed);
        self.skipped += count(NoteKind::Skipped);
    }
}

/// The counts of each folder, in the order of its first file, and their total.
fn counts(files: &[File]) -> (Vec<(String, Counts)>, Counts) {
    let mut folders: Vec<(String, Counts)> = Vec::new();
    let mut index_of: BTreeMap<&Path, usize> = BTreeMap::new();
    let mut total = Counts::default();
    for file in files {
        let index = *index_of.entry(&file.job.folder).or_insert_with(|| {
            let name = file.job.folder.display().to_string();
            folders.push((if name.is_empty() { ".".to_owned() } else { name }, Counts::default()));
            folders.len() - 1
        });
        folders[index].1.add(file);
        total.add(file);
    }
    folders.retain(|(_, counts)| counts.files > 0);
    (folders, total)
}

pub(super) fn print_table(files: &[File], terminal: &mut Terminal) -> Result<(), CliError> {
    let (folders, total) = counts(files);
    let rows = folders.iter().map(|(name, counts)| (name.as_str(), *counts));
    let rows: Vec<(&str, Counts)> = rows.chain((folders.len() != 1).then_some(("total", total))).collect();
    let width = rows.iter().map(|(name, _)| name.chars().count()).max().unwrap_or(0).max("folder".len());
    write!(terminal.out, "{:width$}", "folder")?;
    for name in Counts::NAMES {
        write!(terminal.out, " {name:>8}")?;
    }
    writeln!(terminal.out)?;
    for (name, counts) in rows {
        write!(terminal.out, "{name:width$}")?;
        for value in counts.values() {
            write!(terminal.out, " {value:>8}")?;
        }
        writeln!(terminal.out)?;
    }
    Ok(())
}

pub(super) fn print_outcome(files: &[File], output: &Path, terminal: &mut Terminal) -> Result<(), CliError> {
    let count = |name: &str| files.iter().flat_map(File::plans).filter(|plan| plan.state.name() == name).count();
    let parts: Vec<String> = ["written", "unchanged", "kept", "not saved"]
        .into_iter()
        .filter_map(|name| {
            let count = count(name);
            (count > 0).then(|| format!("{count} {name}"))
        })
        .collect();
    if !parts.is_empty() {
        writeln!(terminal.out, "Plans in {}: {}.", output.display(), parts.join(", "))?;
    }
    let mut kinds: BTreeMap<&str, usize> = BTreeMap::new();
    for file in files {
        if let Content::Foreign(kind) = &file.content {
            *kinds.entry(kind).or_default() += 1;
        }
    }
    for (kind, count) in kinds {
        writeln!(terminal.out, "Skipped, not plans: {count} x {kind}.")?;
    }
    Ok(())
}

/// The report for machines.
#[derive(Serialize)]
pub(super) struct Report {
    version: u32,
    total: Counts,
    folders: Vec<FolderReport>,
    files: Vec<FileReport>,
}

#[derive(Serialize)]
struct FolderReport {
    folder: String,
    #[serde(flatten)]
    counts: Counts,
}

#[derive(Serialize)]
struct FileReport {
    path: String,
    /// `read`, `failed` or `passed over`.
    state: &'static str,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    plans: Vec<PlanReport>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    notes: Vec<NoteReport>,
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<ErrorReport>,
    /// What a skipped file is.
    #[serde(skip_serializing_if = "Option::is_none")]
    is: Option<String>,
}

#[derive(Serialize)]
struct PlanReport {
    path: String,
    /// `written`, `unchanged`, `kept` or `not saved`.
    state: &'static str,
    name: String,
    building: String,
    storey: String,
    rooms: usize,
    openings: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    why: Option<String>,
}

#[derive(Serialize)]
struct NoteReport {
    kind: &'static str,
    line: Option<usize>,
    element: String,
    what: String,
}

#[derive(Serialize)]
struct ErrorReport {
    line: Option<usize>,
    element: String,
    what: String,
    hint: String,
}

impl Report {
    pub(super) fn new(files: &[File]) -> Self {
        let (folders, total) = counts(files);
        let folders = folders.into_iter().map(|(folder, counts)| FolderReport { folder, counts }).collect();
        Self { version: 1, total, folders, files: files.iter().map(FileReport::new).collect() }
    }
}

impl FileReport {
    fn new(file: &File) -> Self {
        let plans = file.plans().iter().map(|plan| PlanReport {
            path: plan.target.display().to_string(),
            state: plan.state.name(),
            name: plan.plan.meta().name.clone(),
            building: plan.plan.meta().building.clone(),
            storey: plan.plan.meta().storey.clone(),
            rooms: plan.plan.rooms().len(),
            openings: plan.plan.openings().len(),
            why: match &plan.state {
                State::NotSaved(why) => Some(why.clone()),
                _ => None,
            },
        });
        let notes = file.notes().iter().map(|note| NoteReport {
            kind: note.kind.name(),
            line: note.place.line,
            element: note.place.element.clone(),
            what: note.what.clone(),
        });
        let (state, error, is) = match &file.content {
            Content::Plans { .. } => ("read", None, None),
            Content::Foreign(kind) => ("passed over", None, Some(kind.clone())),
            Content::Failed(FileError { error, .. }) => {
                let report = ErrorReport {
                    line: error.place.line,
                    element: error.place.element.clone(),
                    what: error.what.clone(),
                    hint: error.hint.clone(),
                };
                ("failed", Some(report), None)
            }
        };
        Self {
            path: file.job.input.path.display().to_string(),
            state,
            plans: plans.collect(),
            notes: notes.collect(),
            error,
            is,
        }
    }
}
