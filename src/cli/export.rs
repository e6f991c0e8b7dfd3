use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::batch::Input;
use super::outputs::{Care, Outputs, is_stdout};
use super::{CliError, Outcome, Subcommand, Terminal, batch, inputs};
use crate::formats::registry::ending_of;
use crate::formats::{
    Export, Exporter, FORMATS, Format, Holds, Import, NamedPlan, OptionError, Options, Refused, manual,
};
use crate::plan::Plan;

/// The default format of files in a folder.
const DEFAULT_FORMAT: &str = "geojson";

/// `enfilade export`: plans in another format.
#[derive(clap::Args)]
pub struct ExportCommand {
    /// Plans, or folders of plans, of any known format
    #[arg(required = true, value_name = "PLAN")]
    plans: Vec<PathBuf>,
    /// The file to write, whose ending gives the format; for several plans the folder
    #[arg(short, long, value_name = "FILE|DIR")]
    output: PathBuf,
    /// The format to write, by its word or ending [default: from the output's ending, else geojson]
    #[arg(long, value_name = "FORMAT")]
    format: Option<String>,
    /// Set an option of the format (can be repeated); see the list below
    #[arg(long, value_name = "NAME=VALUE")]
    option: Vec<String>,
    /// Label scheme to add to the bundled ones (can be repeated)
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
        let target = self.target()?;
        let schemes = inputs::schemes(&self.scheme)?;
        let folder = target.stem.is_none().then_some(self.output.as_path());
        let files = batch::inputs_into(&self.plans, folder);
        let (exporter, options) = (target.exporter, target.options.clone());
        if target.stem.is_some() && files.len() > 1 && exporter.holds() == Holds::OnePlan {
            return Err(CliError::call(format!(
                "-o {}: is a single file, but there are {} plans to write; name a folder",
                self.output.display(),
                files.len()
            )));
        }
        let outputs = Outputs::new(terminal);
        let mut writer = Writer { target, outputs, lost: BTreeMap::new() };
        let mut all: Vec<(String, Plan)> = Vec::new();
        let stem = writer.target.stem.clone();
        let work = |file: &Input, import: Import| -> Vec<Piece> {
            let piece = |(storey, plan): (usize, Plan)| {
                let own = inputs::stem(&file.path);
                let own = if storey == 0 { own } else { format!("{own}-{}", storey + 1) };
                let stem = stem.clone().unwrap_or_else(|| own.clone());
                match exporter.holds() {
                    Holds::OnePlan => {
                        let plan = NamedPlan { stem: &stem, plan: &plan };
                        match exporter.write(&[plan], &schemes, &options) {
                            Ok(export) => Piece::Written(export),
                            Err(refused) => Piece::Refused(refused),
                        }
                    }
                    Holds::ManyPlans => Piece::Plan(own, plan),
                }
            };
            import.plans.into_iter().enumerate().map(piece).collect()
        };
        let failed = batch::for_each_import(&files, "exporting", terminal, work, |file, pieces, terminal| {
            for (storey, piece) in pieces.into_iter().enumerate() {
                match piece {
                    Piece::Written(export) => writer.save(export, Some((file, storey)), terminal)?,
                    Piece::Plan(stem, plan) => all.push((stem, plan)),
                    Piece::Refused(refused) => {
                        return Err(CliError::new(format!("{}: {refused}", file.path.display())));
                    }
                }
            }
            Ok(())
        })?;
        if !all.is_empty() {
            let plans: Vec<NamedPlan<'_>> = all.iter().map(|(stem, plan)| NamedPlan { stem, plan }).collect();
            let export = exporter.write(&plans, &schemes, &options);
            writer.save(export.map_err(|refused| CliError::new(refused.to_string()))?, None, terminal)?;
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
    /// It does not suit the options.
    Refused(Refused),
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
        if is_stdout(&self.output) {
            let (format, exporter) = writable_named(self.format.as_deref().unwrap_or(DEFAULT_FORMAT))?;
            let options = self.options(exporter)?;
            // The plan's name in files that tell of one.
            let stem = Some("plan".to_owned());
            return Ok(Target { format, exporter, options, output: self.output.clone(), stem });
        }
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
                return Err(CliError::call(format!(
                    "{}: could be any of {}; choose one with --format",
                    self.output.display(),
                    ids.join(" or ")
                )));
            }
        };
        if !is_single && output_name.contains('.') && !is_folder {
            return Err(CliError::call(format!(
                "{}: not a folder and not a file with a known ending ({})",
                self.output.display(),
                endings()
            )));
        }
        let options = self.options(exporter)?;
        let ending = ending_of(&output_name, format.endings).filter(|_| is_single);
        let stem = ending.map(|ending| output_name[..output_name.len() - ending.len() - 1].to_owned());
        Ok(Target { format, exporter, options, output: self.output.clone(), stem })
    }

    fn options(&self, exporter: &dyn Exporter) -> Result<Options, CliError> {
        let wrong = |error: OptionError| CliError::call(error.to_string());
        Options::check_names(exporter.options(), &self.option).map_err(wrong)?;
        Options::parse(exporter.options(), &self.option).map_err(wrong)
    }
}

/// Writes, and remembers what was lost.
struct Writer {
    target: Target,
    outputs: Outputs,
    /// What the format does not keep, and the plans that had it.
    lost: BTreeMap<String, Vec<String>>,
}

impl Writer {
    /// Writes what one plan gave, the storey of a file, or what all gave together.
    fn save(&mut self, export: Export, of: Option<(&Input, usize)>, terminal: &mut Terminal) -> Result<(), CliError> {
        let Target { output, stem, format, .. } = &self.target;
        let Export { files, lost } = export;
        if stem.is_some() && files.len() > 1 {
            return Err(CliError::call(format!(
                "{}: {} needs several files; name a folder",
                output.display(),
                format.name
            )));
        }
        let is_one = files.len() == 1;
        for file in files {
            let path = match (stem, of) {
                (Some(_), _) => output.clone(),
                (None, Some((input, storey))) => match ending_of(&file.name, format.endings).filter(|_| is_one) {
                    Some(ending) => input.mirrored(output, storey, ending, &self.outputs),
                    // Of several files each keeps the name that the others know it by.
                    None => {
                        let folder = input.within.parent().unwrap_or(Path::new(""));
                        self.outputs.path_in(&output.join(folder), &file.name)?
                    }
                },
                (None, None) => self.outputs.path_in(output, &file.name)?,
            };
            if let (None, Some(folder)) = (stem, path.parent()) {
                self.outputs.folder(folder)?;
            }
            let from = of.map_or(Path::new(""), |(input, _)| &input.path);
            self.outputs.save_from(&path, &file.bytes, Care::Flushed, from, terminal)?;
            if !is_stdout(&path) {
                terminal.report(path.display())?;
            }
        }
        for lost in lost {
            self.lost.entry(lost.what).or_default().push(lost.stem);
        }
        Ok(())
    }

    /// Says on stderr what the format did not keep, once for each kind, with the number of plans.
    fn report_lost(&self, terminal: &mut Terminal) -> Result<(), CliError> {
        // What the same plans lack is said together.
        let mut of_plans: BTreeMap<&[String], Vec<&str>> = BTreeMap::new();
        for (what, stems) in &self.lost {
            of_plans.entry(stems).or_default().push(what);
        }
        for (stems, what) in of_plans {
            let whose = match stems {
                [stem] => stem.clone(),
                stems => format!("{} plans", stems.len()),
            };
            let format = self.target.format.name;
            terminal.remark(format!("{whose}: {format} does not keep {}", what.join(", ")))?;
            if stems.len() > 1 {
                terminal.detail(format!("  {}", stems.join(", ")))?;
            }
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
    found.ok_or_else(|| CliError::call(format!("cannot write '.{word}'; known endings: {}", endings())))
}

fn endings() -> String {
    let all = writable().flat_map(|(format, _)| format.endings);
    all.map(|ending| format!(".{ending}")).collect::<Vec<_>>().join(", ")
}
