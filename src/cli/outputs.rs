//! Where a subcommand's results go: the one place of the command line that writes files. What stands at a path already
//! is replaced only if the same command made it and nobody changed it since (see [`MadeFiles`]), or with `--force`.

use std::collections::BTreeMap;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use super::{CliError, Terminal};
use crate::base::file_name::component;
use crate::store::{MadeFiles, save_bytes, save_bytes_fast};

/// Whether a path means stdout.
pub fn is_stdout(path: &Path) -> bool {
    ["-", "/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"].iter().any(|name| path == Path::new(name))
}

/// How careful a file is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Care {
    /// It is on the disk before the old one goes: for what took long to make.
    Flushed,
    /// The system may take its time: the source is still there.
    Fast,
}

/// What a subcommand writes.
pub struct Outputs {
    made: MadeFiles,
    force: bool,
    /// Files of which what people wrote there was read, and is written again.
    taken_over: Vec<PathBuf>,
    /// The files written by now, in lower case, since some systems do not tell them apart; and from what.
    written: BTreeMap<String, PathBuf>,
}

impl Outputs {
    /// Of the subcommand that runs.
    pub fn new(terminal: &Terminal) -> Self {
        Self {
            made: MadeFiles::by(terminal.call.command),
            force: terminal.call.force,
            taken_over: Vec::new(),
            written: BTreeMap::new(),
        }
    }

    /// Whether something was written there by this call.
    pub fn has(&self, path: &Path) -> bool {
        self.written.contains_key(&key(path))
    }

    /// Writes a file; its folder has to exist. `-` is stdout.
    ///
    /// # Errors
    /// When something stands there that is not the command's own, this call wrote there already, or it cannot be
    /// written.
    pub fn save(&mut self, path: &Path, bytes: &[u8], care: Care, terminal: &mut Terminal) -> Result<(), CliError> {
        self.save_from(path, bytes, care, Path::new(""), terminal)
    }

    /// The same, remembering from which input it came.
    ///
    /// # Errors
    /// As [`Outputs::save`].
    pub fn save_from(
        &mut self,
        path: &Path,
        bytes: &[u8],
        care: Care,
        from: &Path,
        terminal: &mut Terminal,
    ) -> Result<(), CliError> {
        if let Some(first) = self.written.get(&key(path)) {
            let of = if first.as_os_str().is_empty() { String::new() } else { format!(" by {}", first.display()) };
            return Err(CliError::new(format!(
                "{}: already written{of}; name a folder, or give each file its own name",
                path.display()
            )));
        }
        if is_stdout(path) {
            terminal.call.out_is_result = true;
            write_out(bytes, terminal)?;
        } else {
            if !self.may_replace(path, bytes) {
                return Err(CliError::new(self.refusal(path, terminal)));
            }
            self.made.note(path, bytes);
            match care {
                Care::Flushed => save_bytes(path, bytes)?,
                Care::Fast => save_bytes_fast(path, bytes)?,
            }
        }
        self.written.insert(key(path), from.to_owned());
        Ok(())
    }

    /// Whether a file may be written there.
    pub fn may_replace(&mut self, path: &Path, bytes: &[u8]) -> bool {
        self.force || self.taken_over.iter().any(|taken| taken == path) || self.made.may_replace(path, bytes)
    }

    /// Lets a file be replaced whose content the command has read and keeps.
    pub fn take_over(&mut self, path: PathBuf) {
        self.taken_over.push(path);
    }

    fn refusal(&self, path: &Path, terminal: &Terminal) -> String {
        format!(
            "{}: not written, because the file exists and 'enfilade {}' did not write it, or it was changed since; \
             choose another name, or overwrite it with --force",
            path.display(),
            terminal.call.command
        )
    }

    /// Makes the folder that results go to.
    ///
    /// # Errors
    /// When it cannot be made, or the path is stdout or a file.
    pub fn folder(&self, path: &Path) -> Result<(), CliError> {
        std::fs::create_dir_all(path)
            .map_err(|error| CliError::new(format!("{}: {error}; choose another folder", path.display())))
    }

    /// The path of a file in the folder that results go to.
    ///
    /// # Errors
    /// When the name would lead out of the folder.
    pub fn path_in(&self, folder: &Path, name: &str) -> Result<PathBuf, CliError> {
        Ok(folder.join(component(name).map_err(|error| CliError::new(format!("{}: {error}", folder.display())))?))
    }

    /// Writes a file into the folder that results go to.
    ///
    /// # Errors
    /// As [`Outputs::path_in`] and [`Outputs::save`].
    pub fn save_in(
        &mut self,
        folder: &Path,
        name: &str,
        bytes: &[u8],
        terminal: &mut Terminal,
    ) -> Result<PathBuf, CliError> {
        let path = self.path_in(folder, name)?;
        self.save(&path, bytes, Care::Flushed, terminal)?;
        Ok(path)
    }

    /// Writes a result to a file, or to stdout where none is named.
    ///
    /// # Errors
    /// As [`Outputs::save`].
    pub fn result(&mut self, output: Option<&Path>, bytes: &[u8], terminal: &mut Terminal) -> Result<(), CliError> {
        match output {
            Some(path) => self.save(path, bytes, Care::Flushed, terminal),
            None => write_out(bytes, terminal),
        }
    }
}

/// Says that a subcommand wants a folder when stdout is named.
///
/// # Errors
/// When the path means stdout.
pub fn must_be_folder(output: &Path) -> Result<(), CliError> {
    if is_stdout(output) {
        return Err(CliError::call("-o -: there are several files to write; name a folder"));
    }
    if output.is_file() {
        return Err(CliError::call(format!("-o {}: is a file; name a folder", output.display())));
    }
    Ok(())
}

/// Writes a result to stdout: text by the door, all else as it is.
fn write_out(bytes: &[u8], terminal: &mut Terminal) -> Result<(), CliError> {
    let is_text = !bytes.contains(&0) && std::str::from_utf8(bytes).is_ok();
    let written = if is_text { terminal.out.write_all(bytes) } else { terminal.out.write_binary(bytes) };
    Ok(written?)
}

fn key(path: &Path) -> String {
    path.to_string_lossy().to_lowercase()
}
