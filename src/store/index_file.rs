//! What was found out about the files of a folder, kept so that it need not be found out again: an embedded database in
//! the user's cache folder, never beside the files. It can be deleted at any time; one that is broken is made anew.

use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};

use redb::{Database, ReadableDatabase as _, ReadableTable as _, TableDefinition};

use crate::base::hash;

/// The environment variable for another folder for what can be found out again; if empty, nothing is kept.
pub const CACHE_VARIABLE: &str = "ENFILADE_CACHE";

/// The folder for what can be found out again: the one in the environment variable, or the system's; `None` if there is
/// none, or none is wanted.
pub fn cache_folder() -> Option<PathBuf> {
    use etcetera::BaseStrategy as _;
    match std::env::var_os(CACHE_VARIABLE) {
        Some(folder) => (!folder.is_empty()).then(|| PathBuf::from(folder)),
        None => Some(etcetera::choose_base_strategy().ok()?.cache_dir().join("enfilade")),
    }
}

/// By path, what is known of a file. The number is the version of what is in it: another one starts afresh.
const FILES: TableDefinition<'static, &str, &[u8]> = TableDefinition::new("files 1");

/// Before each entry stands its checksum.
const SUM_BYTES: usize = 8;

fn checksum(path: &str, value: &[u8]) -> [u8; SUM_BYTES] {
    hash::fnv1a(hash::fnv1a(hash::START, path.bytes()), value.iter().copied()).to_le_bytes()
}

/// Memory of the database itself: all of it is read once, and written seldom.
const CACHE_BYTES: usize = 4 << 20;

/// Each file's path within the folder, with what is known of it.
type KeptFiles = Vec<(String, Vec<u8>)>;

/// Why an index cannot be used; everything still works without.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum IndexError {
    /// Another program has it open.
    InUse,
    Other(String),
}

impl fmt::Display for IndexError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::InUse => f.write_str("another Enfilade has it open"),
            Self::Other(what) => f.write_str(what),
        }
    }
}

impl std::error::Error for IndexError {}

fn other(error: impl fmt::Display) -> IndexError {
    IndexError::Other(error.to_string())
}

/// The index of a folder, open: other programs have to do without it meanwhile.
pub struct IndexFile {
    database: Database,
    path: PathBuf,
}

impl fmt::Debug for IndexFile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "IndexFile({})", self.path.display())
    }
}

/// What an index knew when it was opened.
#[derive(Debug)]
pub struct Known {
    pub index: IndexFile,
    /// By path, what is known of each file, sorted.
    pub files: KeptFiles,
    /// Why the index had to be made anew, if it was broken.
    pub broken: Option<String>,
}

impl IndexFile {
    /// Where the index of a folder is kept below the cache folder.
    pub fn path(cache: &Path, of: &Path) -> PathBuf {
        let of = of.canonicalize().unwrap_or_else(|_| of.to_owned());
        let name = of.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        let name: String = name.chars().filter(|c| c.is_ascii_alphanumeric()).take(24).collect();
        let hash = hash::fnv1a(hash::START, of.to_string_lossy().bytes());
        cache.join("workspaces").join(format!("{name}-{hash:016x}.redb"))
    }

    /// Opens the index of a folder, or makes it, and reads all that is in it. A broken one is deleted and made anew.
    ///
    /// # Errors
    /// When another program has it open, or it cannot be made.
    pub fn open(cache: &Path, of: &Path) -> Result<Known, IndexError> {
        let path = Self::path(cache, of);
        std::fs::create_dir_all(path.parent().unwrap_or(cache)).map_err(other)?;
        let existed = path.exists();
        match Self::open_at(&path) {
            Ok((index, files)) => Ok(Known { index, files, broken: None }),
            Err(IndexError::Other(what)) if existed => {
                std::fs::remove_file(&path).map_err(other)?;
                let (index, files) = Self::open_at(&path)?;
                Ok(Known { index, files, broken: Some(what) })
            }
            Err(error) => Err(error),
        }
    }

    fn open_at(path: &Path) -> Result<(Self, KeptFiles), IndexError> {
        // A damaged file may trip an assertion of the database.
        let opened = catch_unwind(AssertUnwindSafe(|| {
            let database =
                Database::builder().set_cache_size(CACHE_BYTES).create(path).map_err(|error| match error {
                    redb::DatabaseError::DatabaseAlreadyOpen => IndexError::InUse,
                    error => other(error),
                })?;
            let index = Self { database, path: path.to_owned() };
            let files = index.read()?;
            Ok((index, files))
        }));
        opened.unwrap_or_else(|_| Err(other("the file is damaged")))
    }

    fn read(&self) -> Result<KeptFiles, IndexError> {
        let reading = self.database.begin_read().map_err(other)?;
        let table = match reading.open_table(FILES) {
            Ok(table) => table,
            Err(redb::TableError::TableDoesNotExist(_)) => return Ok(Vec::new()),
            Err(error) => return Err(other(error)),
        };
        let mut files = Vec::new();
        for entry in table.iter().map_err(other)? {
            let (path, value) = entry.map_err(other)?;
            let (path, value) = (path.value(), value.value());
            // The database looks at what it wrote only after a crash.
            let (sum, value) = value.split_at_checked(SUM_BYTES).ok_or_else(|| other("an entry is cut short"))?;
            if sum != checksum(path, value) {
                return Err(other("an entry is damaged"));
            }
            files.push((path.to_owned(), value.to_vec()));
        }
        Ok(files)
    }

    /// Keeps what was found out of some files, and forgets others.
    ///
    /// # Errors
    /// When it cannot be written; what was there before is still there.
    pub fn keep(&self, found: &[(String, Vec<u8>)], gone: &[String]) -> Result<(), IndexError> {
        let kept = catch_unwind(AssertUnwindSafe(|| {
            let writing = self.database.begin_write().map_err(other)?;
            {
                let mut table = writing.open_table(FILES).map_err(other)?;
                for (path, value) in found {
                    let mut summed = checksum(path, value).to_vec();
                    summed.extend(value);
                    table.insert(path.as_str(), summed.as_slice()).map_err(other)?;
                }
                for path in gone {
                    table.remove(path.as_str()).map_err(other)?;
                }
            }
            writing.commit().map_err(other)
        }));
        kept.unwrap_or_else(|_| Err(other("the file is damaged")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_kept_is_there_again_and_a_broken_file_is_made_anew() {
        let (cache, plans) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
        let open = || IndexFile::open(cache.path(), plans.path());
        let known = open().unwrap();
        assert_eq!((known.files.len(), known.broken), (0, None));
        let found: KeptFiles = (0..200u8).map(|i| (format!("{i:03}"), vec![i; 3000])).collect();
        known.index.keep(&found, &[]).unwrap();
        assert_eq!(open().unwrap_err(), IndexError::InUse);
        known.index.keep(&[], &["007".to_owned()]).unwrap();
        drop(known.index);
        let known = open().unwrap();
        assert_eq!(known.files.len(), 199);
        assert_eq!(known.files[8], ("009".to_owned(), vec![9; 3000]));
        drop(known);
        // Nothing is written beside the plans.
        assert_eq!(std::fs::read_dir(plans.path()).unwrap().count(), 0);
        let path = IndexFile::path(cache.path(), plans.path());
        let whole = std::fs::read(&path).unwrap();
        let spoil = |from: usize, to: usize, byte: u8| {
            let mut bytes = whole.clone();
            bytes[from..to].fill(byte);
            bytes
        };
        let middle = whole.len() / 2;
        for bytes in [
            b"not a database at all".to_vec(),
            Vec::new(),
            whole[..middle].to_vec(),
            whole[..5000].to_vec(),
            spoil(0, 64, 0),
            spoil(64, 400, 0xa5),
            spoil(4096, middle, 0xff),
        ] {
            crate::store::save_bytes(&path, &bytes).unwrap();
            let known = open().unwrap();
            // What is left is true; a file that cannot be read is told of, but for an empty one, which is new.
            assert!(known.files.iter().all(|(key, value)| value == &vec![key.parse::<u8>().unwrap(); 3000]));
            known.index.keep(&found, &[]).unwrap();
            drop(known);
            assert_eq!(open().unwrap().files.len(), 200);
        }
    }
}
