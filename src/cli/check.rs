use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use serde_json::{Map, Value, json};

use super::batch::{self, Input};
use super::door::{Paint, one_line};
use super::repeats::repeats_in_words;
use super::{CliError, Outcome, Subcommand, Terminal, inputs};
use crate::check::{Finding, Severity, check};
use crate::dataset::repeats::{Likeness, Pair, Repeats, Sighting};
use crate::features::Analysis;
use crate::formats::{FileError, Import, Note, NoteKind};
use crate::geometry::Point;
use crate::labels::Schemes;
use crate::pipeline::Pipeline;
use crate::plan::Plan;
use crate::store;

/// `enfilade check`: everything that is wrong with plans.
#[derive(clap::Args)]
pub struct CheckCommand {
    /// Plans, or folders of plans, of any known format
    #[arg(required = true, value_name = "PLAN")]
    plans: Vec<PathBuf>,
    /// List all findings, not only the first three of each kind in a plan
    #[arg(long)]
    all: bool,
    /// Hide findings less severe than this
    #[arg(long, value_name = "SEVERITY", default_value = "info", value_parser = severity)]
    least: Severity,
    /// Exit with 1 for warnings too
    #[arg(long)]
    strict: bool,
    /// Print JSON (docs/json/check.md describes it)
    #[arg(long)]
    json: bool,
    /// Label scheme to add to the bundled ones (can be repeated)
    #[arg(long, value_name = "FILE.scheme.toml")]
    scheme: Vec<PathBuf>,
}

fn severity(word: &str) -> Result<Severity, String> {
    Severity::ALL.into_iter().find(|severity| severity.name() == word).ok_or_else(|| {
        let words: Vec<&str> = Severity::ALL.into_iter().map(Severity::name).collect();
        format!("use one of {}", words.join(", "))
    })
}

/// What came of one file.
type Checked = (Import, Vec<(Found, Sighting)>);

/// What was found in a plan: what is to be done, and what the plan says to ignore, with the reason.
#[derive(Default)]
struct Found {
    open: Vec<Finding>,
    ignored: Vec<(Finding, String)>,
}

/// So many plans that are read twice are listed without `--all`.
const LISTED_PAIRS: usize = 10;

/// So many findings of a kind in a plan are listed without `--all`: enough to see what is meant.
const LISTED: usize = 3;

impl Subcommand for CheckCommand {
    const NAME: &'static str = "check";
    const ABOUT: &'static str = "List what is wrong with plans, where, and what to do";
    const EXAMPLE: &'static str = "enfilade check plans";

    fn run(self, terminal: &mut Terminal) -> Result<Outcome, CliError> {
        let schemes = inputs::schemes(&self.scheme)?;
        let files = batch::inputs(&self.plans);
        let mut totals = Totals::default();
        let mut json_files = Vec::new();
        let mut sightings: Vec<Sighting> = Vec::new();
        let work = |input: &Input| {
            let import = input.read()?;
            let (file, content) = (input.path.display().to_string(), store::content_of(&input.path));
            let each = |(storey, plan): (usize, &Plan)| {
                let pipeline = Pipeline::new(plan, &schemes);
                let seen = Sighting::of(plan, pipeline.analysis(), &file, &content, storey);
                (self.findings(plan, pipeline.analysis(), &schemes), seen)
            };
            let found: Vec<(Found, Sighting)> = import.plans.iter().enumerate().map(each).collect();
            Ok((import, found))
        };
        let take = |input: &Input, result: Result<Checked, FileError>, terminal: &mut Terminal| {
            totals.files += 1;
            let (import, found) = match result {
                Ok(result) => result,
                Err(error) => {
                    totals.unreadable += 1;
                    if self.json {
                        let file = input.path.display().to_string();
                        json_files
                            .push(json!({ "file": file, "error": error.error.to_string(), "notes": [], "plans": [] }));
                    } else {
                        terminal.error(error)?;
                    }
                    return Ok(());
                }
            };
            let (found, seen): (Vec<Found>, Vec<Sighting>) = found.into_iter().unzip();
            sightings.extend(seen);
            let checked: Vec<(&Plan, Found)> = import.plans.iter().zip(found).collect();
            totals.add(&checked, &import.notes, self.least);
            if self.json {
                json_files.push(json_file(&input.path, &import, &checked));
            } else {
                let text = self.text(&input.path, &import, &checked);
                terminal.out.write_all(text.as_bytes())?;
            }
            Ok(())
        };
        batch::for_each(&files, "checking", terminal, work, take)?;
        let repeats = Repeats::find(&sightings);
        totals.repeats = repeats.pairs.iter().filter(|pair| pair.likeness == Likeness::Same).count();
        if self.json {
            let pairs: Vec<Value> = repeats.pairs.iter().map(|pair| json_pair(&sightings, pair)).collect();
            let report = json!({ "version": 1, "files": json_files, "repeats": pairs, "totals": totals.json() });
            serde_json::to_writer_pretty(&mut terminal.out, &report)?;
            writeln!(terminal.out)?;
        } else {
            let listed = if self.all { usize::MAX } else { LISTED_PAIRS };
            let lines = repeats_in_words(&sightings, &repeats, false, listed);
            for line in lines.iter().filter(|_| self.least <= Severity::Warning) {
                writeln!(terminal.out, "{line}")?;
            }
            if !lines.is_empty() && self.least <= Severity::Warning {
                writeln!(terminal.out)?;
            }
            terminal.out.write_all(totals.text().as_bytes())?;
        }
        let worst = if self.strict { Severity::Warning } else { Severity::Error };
        let wrong = totals.unreadable > 0 || totals.by_severity(worst) + totals.by_severity(Severity::Error) > 0;
        Ok(if wrong { Outcome::InputWrong } else { Outcome::Done })
    }
}

impl CheckCommand {
    fn findings(&self, plan: &Plan, analysis: &Analysis, schemes: &Schemes) -> Found {
        let mut found = Found::default();
        for finding in check(plan, analysis, schemes) {
            if finding.severity() < self.least {
                continue;
            }
            match finding.ignored_in(plan).map(|ignored| ignored.reason.clone()) {
                Some(reason) => found.ignored.push((finding, reason)),
                None => found.open.push(finding),
            }
        }
        found
    }

    /// The findings of one file, for people; empty if there are none.
    fn text(&self, path: &Path, import: &Import, checked: &[(&Plan, Found)]) -> String {
        let mut text = String::new();
        let notes = note_groups(&import.notes, self.least);
        for (place, (plan, found)) in checked.iter().enumerate() {
            let mut groups: Vec<Group> = if place == 0 { notes.clone() } else { Vec::new() };
            for finding in &found.open {
                let kind = finding.kind();
                let item = (finding.place().at, finding.what());
                match groups.last_mut() {
                    Some(group) if group.title == kind.title && group.severity == finding.severity() => {
                        group.items.push(item);
                    }
                    _ => groups.push(Group {
                        severity: finding.severity(),
                        title: kind.title,
                        remedy: kind.remedy,
                        items: vec![item],
                    }),
                }
            }
            if groups.is_empty() && found.ignored.is_empty() {
                continue;
            }
            // Stable: the reader's notes come first within their severity.
            groups.sort_by_key(|group| std::cmp::Reverse(group.severity));
            let _ = writeln!(text, "{}", one_line(&heading(path, plan, checked.len())));
            for group in &groups {
                group.write(&mut text, if self.all { usize::MAX } else { LISTED });
            }
            let listed = if self.all { usize::MAX } else { LISTED };
            for (finding, reason) in found.ignored.iter().take(listed) {
                let (what, reason) = (one_line(&finding.what()), one_line(reason));
                let _ = writeln!(text, "  ignored  {}: {what} (because: {reason})", finding.kind().title);
            }
            if found.ignored.len() > listed {
                let _ =
                    writeln!(text, "           and {} more ignored: --all lists them", found.ignored.len() - listed);
            }
            text.push('\n');
        }
        text
    }
}

/// 'school.xml: school, 31 rooms, 40 openings'
fn heading(path: &Path, plan: &Plan, plans_in_file: usize) -> String {
    let mut heading = path.display().to_string();
    if plans_in_file > 1 {
        let _ = write!(heading, " [{}]", plan.meta().name);
    }
    let typology = plan.meta().typology.as_ref().map_or("no typology", |typology| typology.as_str());
    let (rooms, openings) = (plan.rooms().len(), plan.openings().len());
    let _ = write!(heading, ": {typology}, {}, {}", counted(rooms, "room"), counted(openings, "opening"));
    heading
}

/// A severity in its colour, as wide as the longest.
fn painted(severity: Severity) -> String {
    let paint = match severity {
        Severity::Error => Paint::Error,
        Severity::Warning => Paint::Warning,
        Severity::Info => Paint::Info,
    };
    paint.on(&format!("{:<7}", severity.name()))
}

fn counted(count: usize, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}

/// Findings of a kind in a plan.
#[derive(Clone)]
struct Group {
    severity: Severity,
    title: &'static str,
    remedy: &'static str,
    items: Vec<(Option<Point>, String)>,
}

impl Group {
    fn write(&self, text: &mut String, listed: usize) {
        let count = if self.items.len() > 1 { format!(" ({})", self.items.len()) } else { String::new() };
        let severity = painted(self.severity);
        let _ = writeln!(text, "  {severity}  {}{count}: {}", self.title, self.remedy);
        // All in one column: the widest coordinates of those shown decide.
        let shown = &self.items[..listed.min(self.items.len())];
        let places: Vec<Option<(String, String)>> =
            shown.iter().map(|(at, _)| at.map(|at| (format!("{:.2}", at.x), format!("{:.2}", at.y)))).collect();
        let wide = |of: fn(&(String, String)) -> usize| places.iter().flatten().map(of).max().unwrap_or(0);
        let (x_wide, y_wide) = (wide(|place| place.0.len()), wide(|place| place.1.len()));
        for ((_, what), place) in shown.iter().zip(&places) {
            let place = match place {
                Some((x, y)) => format!("({x:>x_wide$}, {y:>y_wide$})  "),
                None if x_wide > 0 => " ".repeat(x_wide + y_wide + 6),
                None => String::new(),
            };
            let what = one_line(what);
            let _ = writeln!(text, "           {place}{what}");
        }
        if shown.len() < self.items.len() {
            let _ = writeln!(text, "           and {} more: --all lists them", self.items.len() - shown.len());
        }
    }
}

/// Something a reader skipped is a warning; something it repaired is for information.
const fn note_severity(kind: NoteKind) -> Severity {
    match kind {
        NoteKind::Skipped => Severity::Warning,
        NoteKind::Healed => Severity::Info,
    }
}

const fn note_title(kind: NoteKind) -> &'static str {
    match kind {
        NoteKind::Skipped => "Left out when reading the file",
        NoteKind::Healed => "Repaired when reading the file",
    }
}

fn note_groups(notes: &[Note], least: Severity) -> Vec<Group> {
    [(NoteKind::Skipped, "fix it in the source, or draw it here"), (NoteKind::Healed, "check that it is right")]
        .into_iter()
        .filter_map(|(kind, remedy)| {
            let of_kind = notes.iter().filter(|note| note.kind == kind);
            let items: Vec<_> = of_kind.map(|note| (None, format!("{}: {}", note.place, note.what))).collect();
            let shown = !items.is_empty() && note_severity(kind) >= least;
            shown.then_some(Group { severity: note_severity(kind), title: note_title(kind), remedy, items })
        })
        .collect()
}

/// The totals of all files.
#[derive(Default)]
struct Totals {
    files: usize,
    unreadable: usize,
    plans: usize,
    plans_without_findings: usize,
    /// Findings that plans say to ignore; they count nowhere else.
    ignored: usize,
    /// Plans that are read again.
    repeats: usize,
    /// Findings, and plans with such, by severity (the worst first), place in the list of kinds, and
    /// title.
    kinds: BTreeMap<(std::cmp::Reverse<Severity>, usize, &'static str), (usize, usize)>,
}

impl Totals {
    fn add(&mut self, checked: &[(&Plan, Found)], notes: &[Note], least: Severity) {
        for group in note_groups(notes, least) {
            let total = self.kinds.entry((std::cmp::Reverse(group.severity), 0, group.title)).or_default();
            total.0 += group.items.len();
            total.1 += 1;
        }
        for (_, Found { open: findings, ignored }) in checked {
            self.plans += 1;
            self.ignored += ignored.len();
            self.plans_without_findings += usize::from(findings.is_empty());
            let mut in_plan: BTreeMap<_, usize> = BTreeMap::new();
            for finding in findings {
                let kind = finding.kind();
                let place = Finding::KINDS.iter().position(|known| known.name == kind.name).unwrap_or(usize::MAX - 1);
                *in_plan.entry((std::cmp::Reverse(finding.severity()), place + 1, kind.title)).or_default() += 1;
            }
            for (key, count) in in_plan {
                let total = self.kinds.entry(key).or_default();
                total.0 += count;
                total.1 += 1;
            }
        }
    }

    fn by_severity(&self, severity: Severity) -> usize {
        let of_plans: usize =
            self.kinds.iter().filter(|((key, ..), _)| key.0 == severity).map(|(_, (findings, _))| findings).sum();
        of_plans + if severity == Severity::Warning { self.repeats } else { 0 }
    }

    fn json(&self) -> Value {
        let mut totals = Map::new();
        for (name, count) in [("files", self.files), ("unreadable", self.unreadable), ("plans", self.plans)] {
            totals.insert(name.to_owned(), count.into());
        }
        for severity in Severity::ALL {
            totals.insert(severity.name().to_owned(), self.by_severity(severity).into());
        }
        totals.insert("ignored".to_owned(), self.ignored.into());
        totals.into()
    }

    fn text(&self) -> String {
        let mut text = String::new();
        if !self.kinds.is_empty() {
            let wide = self.kinds.keys().map(|(.., title)| title.chars().count()).max().unwrap_or(0);
            let _ = writeln!(text, "  {:<7}  {:<wide$}  findings  plans", "", "");
            for ((severity, _, title), (findings, plans)) in &self.kinds {
                let severity = painted(severity.0);
                let _ = writeln!(text, "  {severity}  {title:<wide$}  {findings:>8}  {plans:>5}");
            }
            text.push('\n');
        }
        let _ = write!(
            text,
            "{} checked: {}, {}, {}",
            counted(self.plans, "plan"),
            counted(self.by_severity(Severity::Error), "error"),
            counted(self.by_severity(Severity::Warning), "warning"),
            counted(self.by_severity(Severity::Info), "remark"),
        );
        let _ = write!(text, "; {} without findings", self.plans_without_findings);
        if self.ignored > 0 {
            let _ = write!(text, "; {} ignored", counted(self.ignored, "finding"));
        }
        if self.unreadable > 0 {
            let _ = write!(text, "; {} unreadable", counted(self.unreadable, "file"));
        }
        text.push('\n');
        text
    }
}

fn json_file(path: &Path, import: &Import, checked: &[(&Plan, Found)]) -> Value {
    let notes: Vec<Value> = import
        .notes
        .iter()
        .map(|note| {
            json!({ "kind": note.kind.name(), "line": note.place.line, "element": note.place.element, "what": note.what })
        })
        .collect();
    let plans: Vec<Value> = checked
        .iter()
        .map(|(plan, found)| {
            let ignored = |(finding, reason): &(Finding, String)| {
                let mut told = json_finding(finding);
                if let Some(told) = told.as_object_mut() {
                    told.insert("reason".to_owned(), reason.as_str().into());
                }
                told
            };
            json!({
                "name": plan.meta().name,
                "typology": plan.meta().typology.as_ref().map(|typology| typology.as_str()),
                "rooms": plan.rooms().len(),
                "openings": plan.openings().len(),
                "findings": found.open.iter().map(json_finding).collect::<Vec<_>>(),
                "ignored": found.ignored.iter().map(ignored).collect::<Vec<_>>(),
            })
        })
        .collect();
    json!({ "file": path.display().to_string(), "error": null, "notes": notes, "plans": plans })
}

/// Two readings that have rooms in common.
fn json_pair(sightings: &[Sighting], pair: &Pair) -> Value {
    let of = |index: usize| json!({ "file": sightings[index].file, "plan": sightings[index].plan });
    let kind = if pair.likeness == Likeness::Same { "same" } else { "near_twins" };
    json!({ "kind": kind, "first": of(pair.first), "second": of(pair.second), "rooms": pair.rooms.len() })
}

fn json_finding(finding: &Finding) -> Value {
    let place = finding.place();
    let rooms: Vec<Value> = place
        .rooms
        .iter()
        .map(|room| {
            json!({
                "id": room.id.to_string(),
                "source_id": room.source_id,
                "name": room.name,
                "function": room.function,
            })
        })
        .collect();
    let figures: Map<String, Value> =
        finding.figures().into_iter().map(|(name, value)| (name.to_owned(), rounded(value))).collect();
    json!({
        "kind": finding.kind().name,
        "severity": finding.severity().name(),
        "what": finding.what(),
        "remedy": finding.remedy(),
        "at": place.at.map(|at| json!({ "x": rounded(at.x), "y": rounded(at.y) })),
        "elements": place.elements.iter().map(ToString::to_string).collect::<Vec<_>>(),
        "rooms": rooms,
        "figures": figures,
    })
}

/// A figure for machines: at most four decimals, integers without a decimal point.
fn rounded(value: f64) -> Value {
    let value = crate::geometry::trim_m(value);
    if value.fract() == 0.0 && value.abs() < 1e15 { (value as i64).into() } else { value.into() }
}
