//! Handing a file to the desktop: where it is put, and the program that shows it.

use std::io;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use etcetera::BaseStrategy as _;

/// The folder for files to be printed: the desktop's viewer reads them there. `None` where the system has no place for
/// such files.
pub fn print_folder() -> Option<PathBuf> {
    Some(etcetera::choose_base_strategy().ok()?.cache_dir().join("enfilade").join("print"))
}

/// What opens a file with the program that the desktop keeps for it.
const OPENER: &str = if cfg!(target_os = "macos") { "open" } else { "xdg-open" };

/// So long the opener is waited for, in steps: some stay until the viewer is closed, which is no failure.
const STEP: Duration = Duration::from_millis(50);
const STEPS: usize = 60;

/// Opens a file with the program that the desktop keeps for it.
///
/// # Errors
/// When there is no such program; the text says what to do.
pub fn show_in_viewer(path: &Path) -> Result<(), String> {
    show_with(OPENER, path)
}

fn show_with(opener: &str, path: &Path) -> Result<(), String> {
    let quiet = || Stdio::null();
    let started = Command::new(opener).arg(path).stdin(quiet()).stdout(quiet()).stderr(quiet()).spawn();
    let by_hand = "open the file yourself";
    match started {
        Err(error) if error.kind() == io::ErrorKind::NotFound => {
            Err(format!("this system has no {opener}, which opens files with the desktop's programs; {by_hand}"))
        }
        Err(error) => Err(format!("{opener} could not be started ({error}); {by_hand}")),
        Ok(child) => match ended(child) {
            Some(false) => Err(format!("{opener} found no program that shows PDF files; {by_hand}")),
            Some(true) | None => Ok(()),
        },
    }
}

/// Whether a program succeeded; `None` if it still runs.
fn ended(mut child: Child) -> Option<bool> {
    for _ in 0..STEPS {
        match child.try_wait() {
            Ok(Some(status)) => return Some(status.success()),
            Ok(None) => std::thread::sleep(STEP),
            Err(_) => return None,
        }
    }
    // Waited for elsewhere, so that it leaves nothing behind.
    std::thread::spawn(move || drop(child.wait()));
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_does_not_open_says_what_to_do() {
        let file = Path::new("plan.pdf");
        let why = show_with("enfilade-has-no-such-opener", file).unwrap_err();
        assert!(why.contains("has no enfilade-has-no-such-opener") && why.ends_with("open the file yourself"), "{why}");
        if cfg!(unix) {
            let why = show_with("false", file).unwrap_err();
            assert!(why.contains("found no program that shows PDF files"), "{why}");
            assert_eq!(show_with("true", file), Ok(()));
        }
    }
}
