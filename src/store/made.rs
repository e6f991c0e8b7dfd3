//! Which files the program itself made, so that it replaces those and no other without being told to.
//!
//! A file counts as made by a command while it holds, byte for byte, something that this command once wrote there:
//! what a person has changed since is a person's. The records lie beside the journals, one file for each folder that
//! was written to; a line holds the SHA-256 of the bytes, their number, the command, and the file's name. A line is
//! added before its file is written, so that a run that is killed leaves nothing that the next takes for another's.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::fs;
use std::io::{Read as _, Write as _};
use std::path::{Path, PathBuf};

use sha2::{Digest as _, Sha256};

use super::journal::journal_folder;
use super::save::{SaveError, save_bytes_fast};

/// No record of a folder is read beyond this: a hundred thousand files have some 12 MB.
const LARGEST_BYTES: u64 = 64 << 20;

/// With more records than this, those of folders that are gone are removed.
const MOST_RECORDS: usize = 1000;

/// A record is written anew with the last line of each file when it has so many times more lines than files.
const MOST_LINES_A_FILE: usize = 8;

/// The records of what one command made.
#[derive(Debug)]
pub struct MadeFiles {
    /// Where the records are; `None` where the system has no such place: then nothing counts as made.
    folder: Option<PathBuf>,
    command: String,
    read: BTreeMap<PathBuf, BTreeSet<String>>,
}

impl MadeFiles {
    /// The records of a command, by its name.
    pub fn by(command: &str) -> Self {
        let folder = journal_folder().map(|journals| journals.with_file_name("made"));
        Self { folder, command: command.to_owned(), read: BTreeMap::new() }
    }

    /// Whether what stands at the path may be replaced: there is nothing, or an empty file, or the very bytes that
    /// are to be written, or what the command made itself.
    pub fn may_replace(&mut self, path: &Path, bytes: &[u8]) -> bool {
        let Ok(data) = fs::metadata(path) else { return true };
        if !data.is_file() || data.len() == 0 {
            // A folder or a device is dealt with where it is written.
            return true;
        }
        let command = self.command.clone();
        let known = self.lines_of(path);
        let is_known_length = |line: &String| line.split('\t').nth(1) == Some(data.len().to_string().as_str());
        if data.len() != bytes.len() as u64 && !known.iter().any(is_known_length) {
            return false;
        }
        let Ok(there) = fs::read(path) else { return false };
        there == bytes || known.contains(&line(&there, &command, &name_of(path)))
    }

    /// Notes what is about to be written. Where that cannot be noted, the next run asks for `--force`.
    pub fn note(&mut self, path: &Path, bytes: &[u8]) {
        let Some((record, folder)) = self.record_of(path) else { return };
        let line = line(bytes, &self.command, &name_of(path));
        if !self.lines_of(path).contains(&line) {
            // Without a record, a file is not replaced unasked: nothing is lost.
            let _ = append(&record, &folder, &line);
            self.read.entry(record).or_default().insert(line);
        }
    }

    /// The lines of a file's folder.
    fn lines_of(&mut self, path: &Path) -> &BTreeSet<String> {
        static NONE: BTreeSet<String> = BTreeSet::new();
        let Some((record, _)) = self.record_of(path) else { return &NONE };
        self.read.entry(record).or_insert_with_key(|record| lines(record).into_iter().collect())
    }

    /// The record for a file, and the folder it lies in.
    fn record_of(&self, path: &Path) -> Option<(PathBuf, PathBuf)> {
        let target = path.canonicalize().unwrap_or_else(|_| path.to_owned());
        let parent = target.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let folder = parent.canonicalize().ok()?;
        let name = hex(&Sha256::digest(folder.as_os_str().as_encoded_bytes()));
        Some((self.folder.as_ref()?.join(format!("{}.txt", &name[..32])), folder))
    }
}

fn name_of(path: &Path) -> String {
    let target = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    let name = target.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    // One line a file, whatever its name.
    name.replace(char::is_control, "?")
}

fn line(bytes: &[u8], command: &str, name: &str) -> String {
    format!("{}\t{}\t{command}\t{name}", hex(&Sha256::digest(bytes)), bytes.len())
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}

/// The lines of a record, without the first, which names the folder.
fn lines(record: &Path) -> Vec<String> {
    let mut text = String::new();
    let read = fs::File::open(record).and_then(|file| file.take(LARGEST_BYTES).read_to_string(&mut text));
    if read.is_err() {
        return Vec::new();
    }
    text.lines().skip(1).map(str::to_owned).collect()
}

fn append(record: &Path, folder: &Path, line: &str) -> std::io::Result<()> {
    let parent = record.parent().unwrap_or(Path::new("."));
    if !record.exists() {
        fs::create_dir_all(parent)?;
        remove_stale(parent);
        let head = format!("{}\n", folder.display().to_string().replace(char::is_control, "?"));
        save_bytes_fast(record, head.as_bytes())
            .map_err(|error: SaveError| std::io::Error::other(error.to_string()))?;
    }
    let mut file = fs::File::options().append(true).open(record)?;
    if file.metadata()?.len() > LARGEST_BYTES / 2 {
        shorten(record)?;
        file = fs::File::options().append(true).open(record)?;
    }
    file.write_all(format!("{line}\n").as_bytes())
}

/// Keeps of each file the last [`MOST_LINES_A_FILE`] lines.
fn shorten(record: &Path) -> std::io::Result<()> {
    let mut text = String::new();
    fs::File::open(record)?.take(LARGEST_BYTES).read_to_string(&mut text)?;
    let head = text.lines().next().unwrap_or_default().to_owned();
    let mut seen: BTreeMap<String, usize> = BTreeMap::new();
    let mut kept: Vec<String> = Vec::new();
    for line in lines(record).into_iter().rev() {
        let name = line.splitn(3, '\t').nth(2).unwrap_or_default().to_owned();
        let count = seen.entry(name).or_default();
        *count += 1;
        if *count <= MOST_LINES_A_FILE {
            kept.push(line);
        }
    }
    kept.push(head);
    kept.reverse();
    let text = kept.join("\n") + "\n";
    save_bytes_fast(record, text.as_bytes()).map_err(|error| std::io::Error::other(error.to_string()))
}

/// Removes the records of folders that are gone, when there are many.
fn remove_stale(records: &Path) {
    let all: Vec<PathBuf> = fs::read_dir(records).into_iter().flatten().flatten().map(|entry| entry.path()).collect();
    if all.len() < MOST_RECORDS {
        return;
    }
    for record in all {
        let mut text = String::new();
        let head = fs::File::open(&record).and_then(|file| file.take(1 << 16).read_to_string(&mut text));
        let folder = text.lines().next().unwrap_or_default();
        if head.is_ok() && !folder.is_empty() && !Path::new(folder).exists() {
            let _ = fs::remove_file(&record);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_made_may_be_made_again_and_nothing_else_is_replaced() {
        let folder = tempfile::tempdir().expect("a folder");
        let made = || MadeFiles {
            folder: Some(folder.path().join("records")),
            command: "render".to_owned(),
            read: BTreeMap::new(),
        };
        let path = folder.path().join("a.png");
        let write = |bytes: &[u8]| save_bytes_fast(&path, bytes).expect("saved");
        assert!(made().may_replace(&path, b"first"), "nothing is there");
        let mut first = made();
        first.note(&path, b"first");
        write(b"first");
        assert!(made().may_replace(&path, b"second"), "it made it");
        let mut other = made();
        other.command = "features".to_owned();
        assert!(!other.may_replace(&path, b"second"), "another command made it");
        write(b"FIRST");
        assert!(!made().may_replace(&path, b"second"), "a person changed it");
        assert!(made().may_replace(&path, b"FIRST"), "nothing would change");
        write(b"");
        assert!(made().may_replace(&path, b"second"), "an empty file holds nothing");
        shorten(&made().record_of(&path).expect("a record").0).expect("shortened");
        write(b"first");
        assert!(made().may_replace(&path, b"second"), "known after shortening");
    }
}
