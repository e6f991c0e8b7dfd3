//! Every script in the folders of `tests/replay` is a test of its own: a new case is a new folder with a
//! `script.replay`, its pictures and what else it needs. And what a script cannot say of itself: how
//! wrong scripts end, that recordings replay, that the manual is complete.
//!
//! `UPDATE_GOLDEN=1 cargo test --test replay` makes what comes out the new references.
#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use enfilade::app::replay::{ReplayOptions, ScriptFile, find_scripts, replay};
use libtest_mimic::{Arguments, Failed, Trial};

fn main() -> ExitCode {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/replay/cases");
    let scripts = find_scripts(&[folder]).expect("there are scripts");
    let trials = scripts.into_iter().map(|script| Trial::test(script.title.clone(), move || run(&script)));
    libtest_mimic::run(&Arguments::from_args(), trials.collect()).exit_code()
}

/// Runs a script; fails with all that went wrong in it.
fn run(script: &ScriptFile) -> Result<(), Failed> {
    let options = ReplayOptions { update: std::env::var_os("UPDATE_GOLDEN").is_some(), ..ReplayOptions::default() };
    let report = replay(script, &options);
    if report.is_passed() {
        return Ok(());
    }
    let lines = report.failures.iter().map(|failure| {
        let files: Vec<String> =
            failure.files.iter().map(|file: &PathBuf| format!("\n    {}", file.display())).collect();
        format!("{}:{}: {failure}{}", script.path.display(), failure.line, files.concat())
    });
    Err(lines.collect::<Vec<_>>().join("\n").into())
}
