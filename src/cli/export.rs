use std::io::Write as _;
use std::path::PathBuf;

use super::{CliError, Outcome, Subcommand, Terminal, inputs};
use crate::formats::{FORMATS, Format};
use crate::store::save_bytes;

/// `enfilade export`: plans in another format.
#[derive(clap::Args)]
pub struct ExportCommand {
    /// Plans, or folders of plans, of any known format
    #[arg(required = true, value_name = "PLAN")]
    plans: Vec<PathBuf>,
    /// The file to write, its ending telling the format; with several plans the folder to write to
    #[arg(short, long, value_name = "FILE|DIR")]
    output: PathBuf,
    /// The ending of the files to write into a folder
    #[arg(long, value_name = "ENDING", default_value = "geojson")]
    format: String,
    /// Label scheme that extends the bundled ones (may be given several times)
    #[arg(long, value_name = "FILE.scheme.toml")]
    scheme: Vec<PathBuf>,
}

impl Subcommand for ExportCommand {
    const NAME: &'static str = "export";
    const ABOUT: &'static str = "Write plans in another format";
    const EXAMPLE: &'static str = "enfilade export plans/office.plan.json -o office.geojson";

    fn run(self, terminal: &mut Terminal) -> Result<Outcome, CliError> {
        let schemes = inputs::schemes(&self.scheme)?;
        let files = inputs::plan_files(&self.plans)?;
        let output_name = self.output.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        let single = writable_format(&output_name).filter(|_| !self.output.is_dir());
        let Some((format, ending)) = single.or_else(|| writable_format(&format!("plan.{}", self.format))) else {
            return Err(CliError::new(format!("cannot write '.{}'; known endings: {}", self.format, endings())));
        };
        if single.is_none() && output_name.contains('.') && !self.output.is_dir() {
            return Err(CliError::new(format!(
                "{}: neither a folder nor a file with a known ending ({})",
                self.output.display(),
                endings()
            )));
        }
        let mut written: Vec<PathBuf> = Vec::new();
        let failed = inputs::for_each_plan(&files, terminal, |file, import, terminal| {
            for (storey, plan) in import.plans.iter().enumerate() {
                let target = match single {
                    Some(_) => self.output.clone(),
                    None => self.output.join(inputs::target_name(file, storey, ending)),
                };
                if written.contains(&target) {
                    return Err(CliError::new(format!(
                        "{}: would be written twice; export into separate folders",
                        target.display()
                    )));
                }
                if let (None, Some(folder)) = (single, target.parent()) {
                    std::fs::create_dir_all(folder)?;
                }
                let Some(bytes) = format.write(plan, &schemes) else { continue };
                save_bytes(&target, &bytes)?;
                writeln!(terminal.out, "{}", target.display())?;
                written.push(target);
            }
            Ok(())
        })?;
        Ok(if failed == 0 { Outcome::Done } else { Outcome::InputWrong })
    }
}

/// The format that writes files of this name, and the ending it goes by.
fn writable_format(file_name: &str) -> Option<(&'static dyn Format, &'static str)> {
    let lower = file_name.to_lowercase();
    FORMATS.iter().filter(|format| format.can_write()).find_map(|format| {
        let ending = format.extensions().iter().find(|ending| lower.ends_with(&format!(".{ending}")))?;
        Some((*format, *ending))
    })
}

fn endings() -> String {
    let all = FORMATS.iter().filter(|format| format.can_write()).flat_map(|format| format.extensions());
    all.map(|ending| format!(".{ending}")).collect::<Vec<_>>().join(", ")
}
