use std::collections::BTreeMap;
use std::io::Write as _;
use std::path::PathBuf;

use serde_json::json;

use super::collect::{FoldsFrom, fold_table, grouping, read_plans, report_left_out};
use super::features::FeatureOptions;
use super::manifest;
use super::outputs::{Care, Outputs};
use super::{CliError, Outcome, Subcommand, Terminal, inputs};
use crate::dataset::folds::Grouping;
use crate::dataset::{Collection, Row, Statistics, csv, edges, fold_table, schema};
use crate::gather::dataset::{edges_table, told_of};
use crate::gather::json_bytes;
use crate::labels::Typology;

/// `enfilade dataset`: the labelled rooms of many plans.
#[derive(clap::Args)]
pub struct DatasetCommand {
    /// Folders of plans, or plans, of any known format
    #[arg(required = true, value_name = "DIR")]
    plans: Vec<PathBuf>,
    /// Write the dataset here instead of to stdout, with a table of the ways between the rooms (.edges.csv), and a
    /// description of the columns (.schema.json) and of the making (.manifest.json)
    #[arg(short, long, value_name = "FILE.csv")]
    output: Option<PathBuf>,
    /// Print the paper's Table 2 for these rooms: for each label its share, mean and deviation of a and d, and mean
    /// rt; without --output the dataset itself is not printed
    #[arg(long)]
    stats: bool,
    /// Folds for the column 'fold': their number, the same as in 'evaluate', or a table (.csv) with the columns file,
    /// id, fold
    #[arg(long, value_name = "N|FILE", default_value = "10", value_parser = FoldsFrom::read)]
    folds: FoldsFrom,
    /// Assign whole buildings ('building') or single rooms ('room') to folds
    #[arg(long, value_name = "UNIT", default_value = "building", value_parser = grouping)]
    by: Grouping,
    /// Seed of the folds
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Keep rooms that are read twice
    #[arg(long)]
    keep_repeats: bool,
    /// Put an apostrophe before texts that begin with = + - @, so that spreadsheets do not run them as formulas
    #[arg(long)]
    guard_formulas: bool,
    #[command(flatten)]
    shared: FeatureOptions,
}

impl Subcommand for DatasetCommand {
    const NAME: &'static str = "dataset";
    const ABOUT: &'static str = "Collect the labelled rooms of many plans";
    const EXAMPLE: &'static str = "enfilade dataset plans -o rooms.csv --stats";

    fn run(self, terminal: &mut Terminal) -> Result<Outcome, CliError> {
        let schemes = inputs::schemes(&self.shared.scheme)?;
        let given = match &self.folds {
            FoldsFrom::File(file) => Some(fold_table(file)?),
            FoldsFrom::Count(_) => None,
        };
        let mut read = read_plans(&self.plans, &schemes, false, self.keep_repeats, terminal)?;
        let (left_out, ways) = (read.left_out(), read.edges());
        report_left_out(&left_out, terminal)?;
        let plans = Collection::Plans(std::mem::take(&mut read.networks));
        let mut rows = plans.rows(self.shared.neighbours).unwrap_or_default();
        match given {
            Some(table) => rows.iter_mut().for_each(|row| row.fold = table.fold_of(&row.file, &row.id)),
            None => {
                // Said in the manifest: who asked for no folds need not hear of few buildings.
                fold_table::deal(&mut rows, self.by, self.folds.count(), self.seed);
            }
        }
        if self.output.is_some() || !self.stats {
            let mut bytes = Vec::new();
            let guard = if self.guard_formulas { csv::Guard::On } else { csv::Guard::Off };
            csv::write_guarded(&mut bytes, &rows, guard)?;
            let mut outputs = Outputs::new(terminal);
            outputs.result(self.output.as_deref(), &bytes, terminal)?;
            if let Some(path) = self.output.as_deref().filter(|path| manifest::is_file(path)) {
                let folds = match &self.folds {
                    FoldsFrom::Count(count) => json!({ "count": count, "by": self.by.name(), "seed": self.seed }),
                    FoldsFrom::File(file) => json!({ "file": file.display().to_string() }),
                };
                let table = manifest::of_table(path, &bytes, rows.len());
                let edges_bytes = edges_table(&ways, guard)?;
                outputs.save(&manifest::beside(path, "edges.csv"), &edges_bytes, Care::Flushed, terminal)?;
                let edges_schema = json_bytes(&edges::schema());
                outputs.save(&manifest::beside(path, "edges.schema.json"), &edges_schema, Care::Flushed, terminal)?;
                let told = table.with("folds", folds).with("neighbours", json!(self.shared.neighbours.name()));
                let told = told.with_edges(path, &edges_bytes, ways.len());
                let told = told_of(told, &rows, &read, &left_out).with_schemes(&schemes, &self.shared.scheme);
                manifest::save(told, path, Some(schema()), &mut outputs, terminal)?;
            }
        }
        if self.stats {
            terminal.out.write_all(statistics(&rows).as_bytes())?;
        }
        Ok(if read.failed == 0 { Outcome::Done } else { Outcome::InputWrong })
    }
}

/// Table 2 for each typology and, where there are several, for all.
pub fn statistics(rows: &[Row]) -> String {
    let mut by_typology: BTreeMap<Option<&Typology>, Vec<&Row>> = BTreeMap::new();
    for row in rows {
        by_typology.entry(row.typology.as_ref()).or_default().push(row);
    }
    let mut tables: Vec<String> = by_typology
        .iter()
        .map(|(typology, rows)| {
            let title = typology.map_or_else(|| "No typology".to_owned(), Typology::title);
            Statistics::of(rows.iter().copied()).table(&title)
        })
        .collect();
    if by_typology.len() != 1 {
        tables.push(Statistics::of(rows).table("All"));
    }
    tables.join("\n")
}
