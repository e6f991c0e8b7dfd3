use std::collections::{BTreeMap, BTreeSet};
use std::io::Write as _;
use std::path::{Path, PathBuf};

use super::batch::Input;
use super::{CliError, Outcome, Subcommand, Terminal, batch, inputs};
use crate::formats::registry::ending_of;
use crate::formats::{Export, Exporter, FORMATS, Format, Holds, Import, NamedPlan, Options, manual};
use crate::labels::Schemes;
use crate::plan::Plan;
use crate::store::save_bytes;

/// The default format of files in a folder.
const DEFAULT_FORMAT: &str = "geojson";

/// `enfilade export`: plans in another format.
#[derive(clap::Args)]
pub struct ExportCommand {
    /// Plans, or folders of plans, of any known format
    #[arg(required = true, value_name = "PLAN")]
    plans: Vec<PathBuf>,
    /// The file to write, its ending telling the format; with several plans the folder to write to
    #[arg(short, long, value_name = "FILE|DIR")]
    output: PathBuf,
    /// The format to write, by its word or ending; 'geojson' where the output does not tell
    #[arg(long, value_name = "FORMAT")]
    format: Option<String>,
    /// Set an option of the format (may be given several times); the list is below
    #[arg(long, value_name = "NAME=VALUE")]
    option: Vec<String>,
    /// Label scheme that extends the bundled ones (may be given several times)
    #[arg(long, value_name = "FILE.scheme.toml")]
    scheme: Vec<PathBuf>,
}

impl Subcommand for ExportCommand {
    const NAME: &'static str = "export";
    const ABOUT: &'static str = "Write plans in another format";
    const EXAMPLE: &'static str = "enfilade export plans/office.plan.json -o office.geojson";

    fn more_help() -> String {
        manual::export_help()
    }

    fn run(self, terminal: &mut Terminal) -> Result<Outcome, CliError> {
        let schemes = inputs::schemes(&self.scheme)?;
        let target = self.target()?;
        let files = batch::inputs(&self.plans)?;
        let mut writer = Writer { target, schemes: &schemes, written: BTreeSet::new(), lost: BTreeMap::new() };
        let mut all: Vec<(String, Plan)> = Vec::new();
        let (exporter, options) = (writer.target.exporter, writer.target.options.clone());
        let stem = writer.target.stem.clone();
        let work = |file: &Input, import: Import| -> Vec<Piece> {
            let piece = |(storey, plan): (usize, Plan)| {
                let own = inputs::target_stem(&file.path, storey);
                let stem = stem.clone().unwrap_or_else(|| own.clone());
                match exporter.holds() {
                    Holds::OnePlan => {
                        let plan = NamedPlan { stem: &stem, plan: &plan };
                        Piece::Written(exporter.write(&[plan], &schemes, &options))
                    }
                    Holds::ManyPlans => Piece::Plan(own, plan),
                }
            };
            import.plans.into_iter().enumerate().map(piece).collect()
        };
        let failed = batch::for_each_import(&files, "exporting", terminal, work, |_, pieces, terminal| {
            for piece in pieces {
                match piece {
                    Piece::Written(export) => writer.save(export, terminal)?,
                    Piece::Plan(stem, plan) => all.push((stem, plan)),
                }
            }
            Ok(())
        })?;
        if !all.is_empty() {
            let plans: Vec<NamedPlan<'_>> = all.iter().map(|(stem, plan)| NamedPlan { stem, plan }).collect();
            writer.save(exporter.write(&plans, writer.schemes, &options), terminal)?;
        }
        writer.report_lost(terminal)?;
        Ok(if failed == 0 { Outcome::Done } else { Outcome::InputWrong })
    }
}

/// The result for one plan.
enum Piece {
    /// Its files.
    Written(Export),
    /// The plan itself, with its stem, to be written with the others.
    Plan(String, Plan),
}

/// The destination of an export, and its format.
struct Target {
    format: &'static Format,
    exporter: &'static dyn Exporter,
    options: Options,
    output: PathBuf,
    /// The output's name without its extension, if it is one file.
    stem: Option<String>,
}

impl ExportCommand {
    fn target(&self) -> Result<Target, CliError> {
        let output_name = self.output.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        let is_folder = self.output.is_dir();
        let named: Vec<_> =
            writable().filter(|(format, _)| ending_of(&output_name, format.endings).is_some()).collect();
        let told = self.format.as_deref().map(|word| writable_named(word)).transpose()?;
        let (format, exporter, is_single) = match (named.as_slice(), told) {
            (&[], Some((format, exporter))) => (format, exporter, false),
            (&[], None) => {
                let (format, exporter) = writable_named(DEFAULT_FORMAT)?;
                (format, exporter, false)
            }
            // Of several formats with this extension, the one that was named.
            (several, Some((format, exporter))) if several.iter().any(|(other, _)| other.id == format.id) => {
                (format, exporter, !is_folder)
            }
            (_, Some((format, exporter))) if is_folder => (format, exporter, false),
            (&[(format, exporter)], _) => (format, exporter, !is_folder),
            (several, _) => {
                let ids: Vec<&str> = several.iter().map(|(format, _)| format.id).collect();
                return Err(CliError::new(format!(
                    "{}: may be of the format {}; say which with --format",
                    self.output.display(),
                    ids.join(" or ")
                )));
            }
        };
        if !is_single && output_name.contains('.') && !is_folder {
            return Err(CliError::new(format!(
                "{}: neither a folder nor a file with a known ending ({})",
                self.output.display(),
                endings()
            )));
        }
        Options::check_names(exporter.options(), &self.option)?;
        let options = Options::parse(exporter.options(), &self.option)?;
        let ending = ending_of(&output_name, format.endings).filter(|_| is_single);
        let stem = ending.map(|ending| output_name[..output_name.len() - ending.len() - 1].to_owned());
        Ok(Target { format, exporter, options, output: self.output.clone(), stem })
    }
}

/// Writes, and remembers what was written and what was lost.
struct Writer<'a> {
    target: Target,
    schemes: &'a Schemes,
    written: BTreeSet<PathBuf>,
    /// What the format does not keep, and in how many plans.
    lost: BTreeMap<String, Vec<String>>,
}

impl Writer<'_> {
    fn save(&mut self, export: Export, terminal: &mut Terminal) -> Result<(), CliError> {
        let Target { output, stem, format, .. } = &self.target;
        let Export { files, lost } = export;
        if stem.is_some() && files.len() > 1 {
            return Err(CliError::new(format!(
                "{}: {} needs several files; name a folder",
                output.display(),
                format.name
            )));
        }
        for file in files {
            let path: &Path = &match stem {
                Some(_) => output.clone(),
                None => output.join(file.name),
            };
            if self.written.contains(path) {
                return Err(CliError::new(format!(
                    "{}: would be written twice; export into separate folders",
                    path.display()
                )));
            }
            if let (None, Some(folder)) = (stem, path.parent()) {
                std::fs::create_dir_all(folder)?;
            }
            save_bytes(path, &file.bytes)?;
            writeln!(terminal.out, "{}", path.display())?;
            self.written.insert(path.to_owned());
        }
        for lost in lost {
            self.lost.entry(lost.stem).or_default().push(lost.what);
        }
        Ok(())
    }

    /// Says on stderr what the format did not keep of each plan.
    fn report_lost(&self, terminal: &mut Terminal) -> Result<(), CliError> {
        for (stem, what) in &self.lost {
            writeln!(terminal.err, "{stem}: {} does not keep {}", self.target.format.name, what.join(", "))?;
        }
        Ok(())
    }
}

type Writable = (&'static Format, &'static dyn Exporter);

/// The formats that can be written.
fn writable() -> impl Iterator<Item = Writable> {
    FORMATS.iter().filter_map(|format| Some((*format, format.exporter?)))
}

/// The format with this name or extension.
fn writable_named(word: &str) -> Result<Writable, CliError> {
    let word = word.trim_start_matches('.').to_lowercase();
    let by_ending = |(format, _): &Writable| format.endings.contains(&word.as_str());
    let found = writable().find(|(format, _)| format.id == word).or_else(|| writable().find(by_ending));
    found.ok_or_else(|| CliError::new(format!("cannot write '.{word}'; known endings: {}", endings())))
}

fn endings() -> String {
    let all = writable().flat_map(|(format, _)| format.endings);
    all.map(|ending| format!(".{ending}")).collect::<Vec<_>>().join(", ")
}
