//! Every script in the folders of `tests/replay/cases` is a test of its own: to add a case, add a folder
//! with a `script.replay`, its pictures and whatever else it needs. Also tests what a script cannot check
//! about itself: the messages of failing scripts, that recordings replay, that the manual is complete.
//!
//! `UPDATE_GOLDEN=1 cargo test --test replay` makes the results the new references.
#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]
#![allow(clippy::disallowed_methods, reason = "a test's files are no user's")]

mod command;
mod errors;
mod manual;
mod recordings;
#[path = "../support/mod.rs"]
mod support;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use enfilade::app::replay::{ReplayOptions, Report, ScriptFile, find_scripts, replay};
use libtest_mimic::{Arguments, Failed, Trial};

fn main() -> ExitCode {
    let scripts = find_scripts(&[tests("cases")]).expect("there are scripts");
    let mut trials: Vec<Trial> = scripts
        .into_iter()
        .map(|script| {
            let name = format!("cases/{}", script.title);
            Trial::test(name, move || passed(&replay(&script, &options())))
        })
        .collect();
    trials.extend(errors::trials());
    trials.extend(recordings::trials());
    trials.extend(command::trials());
    trials.push(Trial::test("the_manual_is_complete", || {
        manual::is_complete();
        Ok(())
    }));
    trials.push(Trial::test("the_gestures_are_counted", || {
        manual::counts_gestures_as_they_are();
        Ok(())
    }));
    libtest_mimic::run(&Arguments::from_args(), trials).exit_code()
}

/// A file or folder of these tests.
fn tests(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/replay").join(name)
}

fn options() -> ReplayOptions {
    ReplayOptions { update: std::env::var_os("UPDATE_GOLDEN").is_some(), ..ReplayOptions::default() }
}

/// Fails with all that went wrong in a script.
fn passed(report: &Report) -> Result<(), Failed> {
    if report.is_passed() {
        return Ok(());
    }
    let ScriptFile { path, .. } = &report.script;
    let lines = report.failures.iter().map(|failure| {
        let files: Vec<String> = failure.files.iter().map(|file| format!("\n    {}", file.display())).collect();
        format!("{}:{}: {failure}{}", path.display(), failure.line, files.concat())
    });
    Err(lines.collect::<Vec<_>>().join("\n").into())
}
