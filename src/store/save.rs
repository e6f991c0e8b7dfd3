use std::fmt;
use std::fs::{self, File, OpenOptions};
use std::io::{self, Read as _, Write as _};
use std::path::{Path, PathBuf};

/// Why a file was not saved, and what to do about it. The previous file at the path is untouched.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SaveError {
    pub path: PathBuf,
    pub what: String,
    /// What the user can do about it.
    pub hint: String,
}

impl SaveError {
    pub(super) fn new(path: &Path, what: impl Into<String>, hint: impl Into<String>) -> Self {
        Self { path: path.to_owned(), what: what.into(), hint: hint.into() }
    }
}

impl fmt::Display for SaveError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: not saved: {}; {}", self.path.display(), self.what, self.hint)
    }
}

impl std::error::Error for SaveError {}

/// Writes a file so that at every moment, power cuts included, the path holds either the old bytes or the
/// new ones, complete: writes a temporary file beside it, flushes it to disk, reads it back and compares,
/// copies the old file's permissions, and renames.
///
/// Symbolic links are followed. Targets that are neither files nor folders (a pipe, `/dev/stdout`) are
/// written to directly.
///
/// # Errors
/// When the folder is missing or not writable, the disk is full, or the old file is write-protected. The
/// old file is then intact, and no temporary file is left behind.
pub fn save_bytes(path: &Path, bytes: &[u8]) -> Result<(), SaveError> {
    save(path, bytes, Care::Flushed)
}

/// Writes a file like [`save_bytes`], but lets the system decide when the bytes reach the disk: for
/// exports whose source still exists. Readers still never see half a file.
///
/// # Errors
/// As [`save_bytes`].
pub fn save_bytes_fast(path: &Path, bytes: &[u8]) -> Result<(), SaveError> {
    save(path, bytes, Care::Fast)
}

#[derive(Clone, Copy, PartialEq)]
enum Care {
    /// Flushed, read back and compared before the old file is replaced.
    Flushed,
    Fast,
}

fn save(path: &Path, bytes: &[u8], care: Care) -> Result<(), SaveError> {
    let fail = |error: &io::Error| SaveError::new(path, error.to_string(), hint_for(error));
    let target = followed(path).map_err(|error| fail(&error))?;
    let old = match fs::metadata(&target) {
        Ok(old) if old.is_dir() => {
            return Err(SaveError::new(path, "is a folder", "give the name of a file"));
        }
        Ok(old) if !old.is_file() => {
            return OpenOptions::new()
                .write(true)
                .open(&target)
                .and_then(|mut device| device.write_all(bytes))
                .map_err(|error| fail(&error));
        }
        Ok(old) if old.permissions().readonly() => {
            return Err(SaveError::new(
                path,
                "the file there is write-protected",
                "allow writing to it, or save under another name",
            ));
        }
        Ok(old) => Some(old),
        Err(error) if error.kind() == io::ErrorKind::NotFound => None,
        Err(error) => return Err(fail(&error)),
    };
    replace(&target, old.as_ref(), bytes, care).map_err(|error| fail(&error))
}

/// Replaces a regular file, or creates one. Dropping the temporary file, as every error here does,
/// removes it.
fn replace(target: &Path, old: Option<&fs::Metadata>, bytes: &[u8], care: Care) -> io::Result<()> {
    let folder = folder_of(target);
    let mut builder = tempfile::Builder::new();
    // Without the file's own name, which may already be as long as the system allows.
    builder.prefix(".enfilade-").suffix(".tmp");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        // The mode of any new file, before the user's umask; the crate's own default is 0600.
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    let mut temporary = builder.tempfile_in(folder)?;
    temporary.write_all(bytes)?;
    if let Some(old) = old {
        #[cfg(unix)]
        {
            use std::os::unix::fs::MetadataExt as _;
            // Root may be saving another user's file; other users may not give files away, and need not.
            let _ = std::os::unix::fs::fchown(temporary.as_file(), Some(old.uid()), Some(old.gid()));
        }
        temporary.as_file().set_permissions(old.permissions())?;
    }
    if care == Care::Flushed {
        temporary.as_file().sync_all()?;
        let mut written = Vec::with_capacity(bytes.len());
        File::open(temporary.path())?.read_to_end(&mut written)?;
        if written != bytes {
            return Err(io::Error::other("what was written reads back differently"));
        }
    }
    temporary.persist(target).map_err(|error| error.error)?;
    #[cfg(unix)]
    if care == Care::Flushed {
        // The rename itself is on disk once the folder is flushed. Some file systems cannot flush a
        // folder; the file is in place and complete all the same, so this is not a failure.
        let _ = File::open(folder).and_then(|folder| folder.sync_all());
    }
    Ok(())
}

/// The folder containing a file.
fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}

/// The target of a path after following symbolic links, even if it does not exist yet.
fn followed(path: &Path) -> io::Result<PathBuf> {
    // The limit Linux sets for one path.
    const LINK_LIMIT: usize = 40;
    let mut target = path.to_owned();
    for _ in 0..LINK_LIMIT {
        match fs::read_link(&target) {
            Ok(link) => target = folder_of(&target).join(link),
            // Not a link, or does not exist.
            Err(_) => return Ok(target),
        }
    }
    Err(io::Error::other("a chain of symbolic links that does not end"))
}

/// What the user can do about a system error.
fn hint_for(error: &io::Error) -> &'static str {
    match error.kind() {
        io::ErrorKind::NotFound => "make the folder first, or save elsewhere",
        io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => "save in a folder you may write to",
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded | io::ErrorKind::FileTooLarge => {
            "free some space, or save on another disk"
        }
        io::ErrorKind::InvalidFilename | io::ErrorKind::InvalidInput => "choose another file name",
        _ => "try again, or save elsewhere",
    }
}
