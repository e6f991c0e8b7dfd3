//! Labelled rooms to learn from, named on the command line: plans, folders of plans, or dataset files. What is read twice counts
//! once, whatever it is called.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use super::batch::{self, Input};
use super::call::quoted;
use super::repeats::report_repeats;
use super::{CliError, Terminal, inputs};
use crate::base::wording::count;
use crate::dataset::fold_table::FoldTable;
use crate::dataset::folds::{Grouping, building_of, group_of};
use crate::dataset::{Collection, LeftOut, RoomNetwork, Row, csv};
use crate::features::NeighbourLabels;
use crate::formats::Import;
pub use crate::gather::PlansRead;
use crate::gather::{FileRead, Source, sha256};
use crate::labels::{Schemes, Typology};
use crate::plan::titles::first_of;
use crate::store;

/// Options of every subcommand that learns from labelled rooms.
#[derive(clap::Args)]
pub struct CollectOptions {
    /// Plans, folders of plans, or datasets (.csv, without neighbours; '-' reads one from stdin) with labelled rooms
    #[arg(required = true, value_name = "DATA")]
    pub data: Vec<PathBuf>,
    /// Use at most about N rooms of each typology, in whole buildings (the paper has about 2000 of each)
    #[arg(long, value_name = "N")]
    pub most_rooms: Option<usize>,
    /// Keep rooms that are read twice, which makes test results look better than they are
    #[arg(long)]
    pub keep_repeats: bool,
    /// Label scheme to add to the bundled ones (can be repeated)
    #[arg(long, value_name = "FILE.scheme.toml")]
    pub scheme: Vec<PathBuf>,
}

impl CollectOptions {
    /// The words of a call that reads the same, without the program and the subcommand.
    pub fn words(&self) -> Vec<String> {
        let path = |path: &PathBuf| quoted(&path.to_string_lossy());
        let mut words: Vec<String> = self.data.iter().map(path).collect();
        words.extend(self.most_rooms.map(|most| format!("--most-rooms {most}")));
        words.extend(self.keep_repeats.then(|| "--keep-repeats".to_owned()));
        words.extend(self.scheme.iter().map(|file| format!("--scheme {}", path(file))));
        words
    }
}

/// Where folds come from, as an option's value: a number of folds, or a table that gives each room its fold.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FoldsFrom {
    Count(usize),
    File(PathBuf),
}

impl FoldsFrom {
    /// Reads a number, or else the path of a table.
    ///
    /// # Errors
    /// For fewer than two folds.
    pub fn read(word: &str) -> Result<Self, String> {
        match word.parse() {
            Ok(folds) if folds >= 2 => Ok(Self::Count(folds)),
            Ok(_) => Err("use a whole number from 2 up, or a table (.csv) with the columns file, id, fold".to_owned()),
            Err(_) => Ok(Self::File(word.into())),
        }
    }

    /// The same, where 0 stands for no validation.
    ///
    /// # Errors
    /// For one fold.
    pub fn read_or_none(word: &str) -> Result<Self, String> {
        if word == "0" { Ok(Self::Count(0)) } else { Self::read(word) }
    }

    /// The number of folds that is asked for; the paper's ten where a table says.
    pub fn count(&self) -> usize {
        match self {
            Self::Count(count) => *count,
            Self::File(_) => 10,
        }
    }
}

/// Which labels of its neighbours a room counts, as an option's value.
pub fn neighbour_labels(word: &str) -> Result<NeighbourLabels, String> {
    inputs::one_of(word, &NeighbourLabels::ALL, NeighbourLabels::name)
}

/// What is assigned to folds, as an option's value.
pub fn grouping(word: &str) -> Result<Grouping, String> {
    inputs::one_of(word, &Grouping::ALL, Grouping::name)
}

/// Reads the collection; says on stderr what could not be read, what was read twice, and which rooms have no label.
///
/// # Errors
/// When nothing can be learned from: no labelled room, or plans mixed with dataset files.
pub fn collect(options: &CollectOptions, seed: u64, terminal: &mut Terminal) -> Result<Collected, CliError> {
    // A plan alone is nothing to learn from: what comes by stdin is a dataset.
    let is_table = |path: &PathBuf| {
        path == Path::new("-") || path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("csv"))
    };
    let (tables, plans): (Vec<PathBuf>, Vec<PathBuf>) = options.data.iter().cloned().partition(is_table);
    let (collection, read) = match (tables.is_empty(), plans.is_empty()) {
        (false, false) => {
            return Err(CliError::call(
                "plans and datasets (.csv) cannot be mixed, because a dataset does not say which rooms are \
                 neighbours; make a dataset of the plans with 'enfilade dataset', or give the plans behind the \
                 dataset",
            ));
        }
        (false, true) => {
            let (rows, sources) = read_tables(&tables, options.keep_repeats, terminal)?;
            (Collection::Rows(rows), PlansRead { sources, ..PlansRead::default() })
        }
        _ => {
            let schemes = inputs::schemes(&options.scheme)?;
            let mut read = read_plans(&plans, &schemes, true, options.keep_repeats, terminal)?;
            (Collection::Plans(std::mem::take(&mut read.networks)), read)
        }
    };
    report_left_out(&collection.left_out(), terminal)?;
    let collection = match options.most_rooms {
        Some(most) => collection.at_most(most, seed),
        None => collection,
    };
    if collection.rows(NeighbourLabels::True).unwrap_or_default().is_empty() {
        return Err(CliError::new("there are no labelled rooms to learn from; label some rooms, or add plans"));
    }
    // Parts of a collection are whole groups of buildings.
    let group = |network: &RoomNetwork| (network.typology.clone(), network.group.clone());
    let kept: BTreeSet<_> = collection.networks().iter().map(group).collect();
    let mut read = read;
    read.blind.retain(|network| kept.contains(&group(network)));
    let blind = std::mem::take(&mut read.blind);
    Ok(Collected { collection, blind, failed: read.failed, read })
}

/// What was read.
pub struct Collected {
    pub collection: Collection,
    /// The plans of the collection, in order, as if their typology were unknown.
    pub blind: Vec<RoomNetwork>,
    /// Number of files that could not be read.
    pub failed: usize,
    /// The files, and what was read twice; its networks are in the collection.
    pub read: PlansRead,
}

impl Collected {
    /// Takes the folds of a table, where folds come from one, and says what they do not split. `by` is what was asked for.
    /// `None` where folds are dealt.
    ///
    /// # Errors
    /// When the table cannot be read, lacks a room, or splits a building although none should be.
    pub fn folds_of(
        &mut self,
        folds: &FoldsFrom,
        by: Option<Grouping>,
        terminal: &mut Terminal,
    ) -> Result<Option<Grouping>, CliError> {
        let FoldsFrom::File(file) = folds else { return Ok(None) };
        let given = self.take_folds(file)?;
        if (given, by) == (Grouping::Room, Some(Grouping::Building)) {
            let what =
                "splits a building, or near twins, between folds; leave out --by, or give each building one fold";
            return Err(CliError::new(format!("{}: {what}", file.display())));
        }
        let split = if given == Grouping::Room { "buildings are split" } else { "no building is split" };
        terminal.remark(format!("folds of {}: {split}", file.display()))?;
        Ok(Some(by.unwrap_or(given)))
    }

    /// Gives each labelled room the fold that a table says. Gives what the table does not split: a building, or else a room.
    ///
    /// # Errors
    /// When the table cannot be read, or lacks a room.
    pub fn take_folds(&mut self, file: &Path) -> Result<Grouping, CliError> {
        let table = fold_table(file)?;
        let mut missing: Vec<String> = Vec::new();
        let mut fold_of = |path: &str, id: &str, name: &str| {
            let fold = table.fold_of(path, id);
            if fold.is_none() {
                missing.push(format!("{name} ({id}) of {path}"));
            }
            fold
        };
        match &mut self.collection {
            Collection::Plans(networks) => {
                for network in networks {
                    for room in network.labelled().collect::<Vec<_>>() {
                        let of = &mut network.rooms[room];
                        of.fold = fold_of(&network.file, &of.id.to_string(), &of.key);
                    }
                }
            }
            Collection::Rows(rows) => {
                for row in rows {
                    row.fold = fold_of(&row.file, &row.id, &row.room);
                }
            }
        }
        if !missing.is_empty() {
            return Err(CliError::new(format!(
                "{}: no fold for {}: {}; give every labelled room one",
                file.display(),
                count(missing.len(), "room"),
                first_of(&missing)
            )));
        }
        let mut fold_of_group: BTreeMap<(Option<Typology>, String), usize> = BTreeMap::new();
        let rows = self.collection.rows(NeighbourLabels::True).unwrap_or_default();
        let is_split = rows.iter().any(|row| {
            let fold = row.fold.unwrap_or_default();
            *fold_of_group.entry((row.typology.clone(), group_of(row).to_owned())).or_insert(fold) != fold
        });
        Ok(if is_split { Grouping::Room } else { Grouping::Building })
    }
}

/// Reads a table of folds.
///
/// # Errors
/// When it cannot be read.
pub fn fold_table(file: &Path) -> Result<FoldTable, CliError> {
    let fail = |error: &dyn std::fmt::Display| CliError::new(format!("{}: {error}", file.display()));
    let opened = std::fs::File::open(file).map_err(|error| fail(&error))?;
    FoldTable::read(std::io::BufReader::new(opened)).map_err(|error| fail(&error))
}

/// Reads plans; says on stderr what could not be read and what was read twice.
///
/// # Errors
/// When a folder holds no plan.
pub fn read_plans(
    paths: &[PathBuf],
    schemes: &Schemes,
    with_blind: bool,
    keep_repeats: bool,
    terminal: &mut Terminal,
) -> Result<PlansRead, CliError> {
    let files = batch::inputs(paths);
    let mut read = PlansRead::default();
    let work = |input: &Input, import: Import| {
        let file = input.path.display().to_string();
        FileRead::new(&file, store::content_of(&input.path), &import.plans, schemes, with_blind)
    };
    read.failed = batch::for_each_import(&files, "collecting rooms", terminal, work, |_, file, _| {
        read.add(file);
        Ok(())
    })?;
    read.put_together();
    report_repeats(&read.sightings, &read.repeats, keep_repeats, terminal)?;
    if !keep_repeats {
        read.leave_out_repeats();
    }
    Ok(read)
}

/// The rows of dataset files, each room once.
fn read_tables(
    paths: &[PathBuf],
    keep_repeats: bool,
    terminal: &mut Terminal,
) -> Result<(Vec<Row>, Vec<Source>), CliError> {
    let mut rows: Vec<Row> = Vec::new();
    let mut sources: Vec<Source> = Vec::new();
    let mut seen: BTreeSet<Vec<String>> = BTreeSet::new();
    for path in paths {
        let fail = |error: &dyn std::fmt::Display| CliError::new(format!("{}: {error}", path.display()));
        let bytes = std::fs::read(inputs::from_stdin(path)).map_err(|error| fail(&error))?;
        let of_file = csv::read(bytes.as_slice()).map_err(|error| fail(&error))?;
        let file = path.display().to_string();
        let source = Source { file, sha256: sha256(&bytes), plans: 0, rooms: of_file.len() };
        let before = sources.iter().find(|other: &&Source| other.sha256 == source.sha256);
        if let Some(before) = before.filter(|_| !keep_repeats) {
            terminal.remark(format!("{}: left out: it is {} again", source.file, before.file))?;
            sources.push(source);
            continue;
        }
        sources.push(source);
        let all = of_file.len();
        let is_new = |row: &Row| keep_repeats || key_of(row).is_none_or(|key| seen.insert(key));
        let kept: Vec<Row> = of_file.into_iter().filter(is_new).collect();
        if kept.len() < all {
            let rooms = count(all - kept.len(), "room");
            terminal.remark(format!("{}: {rooms} left out, already read", path.display()))?;
        }
        rows.extend(kept);
    }
    Ok((rows, sources))
}

/// What tells that two rows are of one room: file and id; without these all that is known, if the room has a name.
fn key_of(row: &Row) -> Option<Vec<String>> {
    if !row.file.is_empty() && !row.id.is_empty() {
        return Some(vec![row.file.clone(), row.id.clone()]);
    }
    let named = !row.plan.is_empty() && !row.room.is_empty();
    let features = csv::feature_cells(&row.features);
    let texts = [building_of(row), &row.plan, &row.room, row.label.letter()].map(str::to_owned);
    named.then(|| texts.into_iter().chain(features).collect())
}

/// Says which rooms did not become rows, and which functions no scheme knows.
pub fn report_left_out(left_out: &LeftOut, terminal: &mut Terminal) -> Result<(), CliError> {
    if left_out.total() == 0 {
        return Ok(());
    }
    terminal.remark(format!("left out {} rooms:", left_out.total()))?;
    let lines = [
        (left_out.not_classified, "not classified (balconies, shafts and the like)"),
        (left_out.without_function, "without a label or a function"),
        (left_out.without_area, "without a boundary"),
    ];
    for (rooms, why) in lines.into_iter().filter(|&(rooms, _)| rooms > 0) {
        terminal.remark(format!("{rooms:>6}  {why}"))?;
    }
    for ((typology, function), rooms) in &left_out.unknown_functions {
        let scheme = if typology.is_empty() {
            "the plan has no typology".to_owned()
        } else {
            format!("not in the scheme of {typology}")
        };
        terminal.remark(format!("{rooms:>6}  function '{function}' ({scheme}; add it with --scheme)"))?;
    }
    Ok(())
}
