use std::collections::BTreeMap;
use std::io::Write as _;
use std::path::PathBuf;

use super::batch::{self, Input};
use super::features::FeatureOptions;
use super::outputs::Outputs;
use super::{CliError, Outcome, Subcommand, Terminal, inputs};
use crate::dataset::{LeftOut, Row, Statistics, csv, rows};
use crate::formats::Import;
use crate::labels::Typology;

/// `enfilade dataset`: the labelled rooms of many plans.
#[derive(clap::Args)]
pub struct DatasetCommand {
    /// Folders of plans, or plans, of any known format
    #[arg(required = true, value_name = "DIR")]
    plans: Vec<PathBuf>,
    /// Write the dataset here instead of to stdout
    #[arg(short, long, value_name = "FILE.csv")]
    output: Option<PathBuf>,
    /// Print the paper's Table 2 for the rooms: per label its share, mean and deviation of a and d,
    /// mean rt. Without --output the dataset itself is not printed
    #[arg(long)]
    stats: bool,
    #[command(flatten)]
    shared: FeatureOptions,
}

impl Subcommand for DatasetCommand {
    const NAME: &'static str = "dataset";
    const ABOUT: &'static str = "Collect the labelled rooms of many plans";
    const EXAMPLE: &'static str = "enfilade dataset plans -o rooms.csv --stats";

    fn run(self, terminal: &mut Terminal) -> Result<Outcome, CliError> {
        let schemes = inputs::schemes(&self.shared.scheme)?;
        let files = batch::inputs_into(&self.plans, self.output.as_deref());
        let mut collected: Vec<Row> = Vec::new();
        let mut left_out = LeftOut::default();
        let work = |_: &Input, import: Import| {
            let mut left_out = LeftOut::default();
            let of_plan = |plan| rows(plan, &schemes, self.shared.neighbours, &mut left_out);
            let rows: Vec<Row> = import.plans.iter().flat_map(of_plan).collect();
            (rows, left_out)
        };
        let failed = batch::for_each_import(&files, "collecting rooms", terminal, work, |_, (rows, without), _| {
            collected.extend(rows);
            left_out.add(&without);
            Ok(())
        })?;
        report_left_out(&left_out, terminal)?;
        if self.output.is_some() || !self.stats {
            let mut bytes = Vec::new();
            csv::write(&mut bytes, &collected)?;
            Outputs::new(terminal).result(self.output.as_deref(), &bytes, terminal)?;
        }
        if self.stats {
            terminal.out.write_all(statistics(&collected).as_bytes())?;
        }
        Ok(if failed == 0 { Outcome::Done } else { Outcome::InputWrong })
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
