use std::io::Write as _;
use std::path::PathBuf;

use serde_json::{Value, json};

use super::{CliError, Outcome, Subcommand, Terminal};
use crate::app::replay::{self, Failure, ReplayOptions, Report, ScriptFile};
use crate::base::work::Work;

/// `enfilade replay`: scripts that drive the window without a display.
#[derive(clap::Args)]
pub struct ReplayCommand {
    /// Scripts, or folders of scripts (*.replay)
    #[arg(required_unless_present = "list", value_name = "SCRIPT|DIR")]
    scripts: Vec<PathBuf>,
    /// Folder of the reference pictures, with a folder per script [default: beside each script]
    #[arg(long, value_name = "DIR")]
    snapshots: Option<PathBuf>,
    /// Make the results the new references
    #[arg(long)]
    update: bool,
    /// Keep every picture and what the scripts save, in a folder per script
    #[arg(short, long, alias = "out", value_name = "DIR")]
    output: Option<PathBuf>,
    /// Report each step as soon as it is done; runs the scripts one by one
    #[arg(long, conflicts_with = "json")]
    steps: bool,
    /// Print JSON (docs/json/replay.md describes it)
    #[arg(long)]
    json: bool,
    /// List all steps, places and expectations of scripts; every command of the window is a step too
    #[arg(long)]
    list: bool,
}

impl Subcommand for ReplayCommand {
    const NAME: &'static str = "replay";
    const ABOUT: &'static str = "Run scripts in the window without a display, and compare pictures";
    const EXAMPLE: &'static str = "enfilade replay tests/replay -o pictures";

    fn run(self, terminal: &mut Terminal) -> Result<Outcome, CliError> {
        if self.list {
            write!(terminal.out, "{}", replay::guide())?;
            return Ok(Outcome::Done);
        }
        let scripts = replay::find_scripts(&self.scripts)?;
        let options = ReplayOptions { snapshots: self.snapshots, out: self.output, update: self.update };
        let work = match terminal.call.jobs {
            Some(threads) => Work::quiet().on_threads(threads),
            None => Work::quiet(),
        };
        let reports = match self.steps {
            true => scripts.iter().map(|script| told_by_step(script, &options, terminal)).collect::<Result<_, _>>()?,
            false => work.map(scripts.len(), |index| replay::replay(&scripts[index], &options))?,
        };
        if self.json {
            let scripts: Vec<Value> = reports.iter().map(as_json).collect();
            serde_json::to_writer_pretty(&mut terminal.out, &json!({ "version": 1, "scripts": scripts }))?;
            writeln!(terminal.out)?;
        } else {
            for report in &reports {
                tell(report, terminal)?;
            }
            if let [_, _, ..] = reports.as_slice() {
                let passed = reports.iter().filter(|report| report.is_passed()).count();
                writeln!(terminal.out, "{passed} of {} scripts passed", reports.len())?;
            }
        }
        let is_passed = reports.iter().all(Report::is_passed);
        Ok(if is_passed { Outcome::Done } else { Outcome::InputWrong })
    }
}

/// Runs a script and prints the line of each step when it is done.
fn told_by_step(script: &ScriptFile, options: &ReplayOptions, terminal: &mut Terminal) -> Result<Report, CliError> {
    let mut written = Ok(());
    let report = replay::replay_telling(script, options, &mut |line| {
        if written.is_ok() {
            written = writeln!(terminal.out, "done {line}").and_then(|()| terminal.out.flush());
        }
    });
    written?;
    Ok(report)
}

/// Prints the result of a script, and on stderr its failures.
fn tell(report: &Report, terminal: &mut Terminal) -> Result<(), CliError> {
    let path = report.script.path.display();
    for Failure { line, what, hint, files } in &report.failures {
        let place = if *line == 0 { String::new() } else { format!(":{line}") };
        writeln!(terminal.err, "{path}{place}: {what}")?;
        if !hint.is_empty() {
            writeln!(terminal.err, "    {hint}")?;
        }
        for file in files {
            writeln!(terminal.err, "    {}", file.display())?;
        }
    }
    for file in &report.updated {
        writeln!(terminal.out, "written: {}", file.display())?;
    }
    let verdict = if report.is_passed() { "passed" } else { "failed" };
    let (steps, snapshots) = (report.steps, report.snapshots);
    writeln!(terminal.out, "{verdict}: {path} ({steps} steps, {snapshots} snapshots)")?;
    Ok(())
}

fn as_json(report: &Report) -> Value {
    let failures: Vec<Value> = report
        .failures
        .iter()
        .map(|failure| {
            json!({
                "line": (failure.line > 0).then_some(failure.line),
                "what": failure.what,
                "hint": failure.hint,
                "files": failure.files,
            })
        })
        .collect();
    json!({
        "script": report.script.path,
        "title": report.script.title,
        "passed": report.is_passed(),
        "steps": report.steps,
        "snapshots": report.snapshots,
        "failures": failures,
        "updated": report.updated,
    })
}
