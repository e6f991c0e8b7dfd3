use std::fs::Metadata;
use std::path::Path;
use std::time::{Duration, SystemTime};

/// How a file stands on the disk, to tell without reading it whether it is still the same.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FileState {
    /// When it was last changed, in nanoseconds since 1970; 0 where the system does not say.
    pub modified_ns: u64,
    /// Its size in bytes; of a folder that is a plan, of all files in it.
    pub size: u64,
    /// Whether it had not been changed for a while: otherwise a later change may leave the same time, and its content has
    /// to be compared.
    pub is_settled: bool,
}

/// Clocks of file systems are this coarse at worst (FAT).
const COARSEST_CLOCK: Duration = Duration::from_secs(2);

impl FileState {
    /// The state of a file, or of a folder that is a plan, in which the latest change of a file counts; `None` when there
    /// is none.
    pub fn of(path: &Path) -> Option<Self> {
        let metadata = std::fs::metadata(path).ok()?;
        let mut latest = metadata.modified().ok();
        let mut size = metadata.len();
        if metadata.is_dir() {
            size = 0;
            let entries = std::fs::read_dir(path).ok()?.filter_map(|entry| entry.ok()?.metadata().ok());
            for file in entries.filter(Metadata::is_file) {
                size += file.len();
                latest = latest.max(file.modified().ok());
            }
        }
        let since = latest.and_then(|latest| latest.duration_since(SystemTime::UNIX_EPOCH).ok());
        let modified_ns = since.map_or(0, |since| u64::try_from(since.as_nanos()).unwrap_or(u64::MAX));
        let is_settled =
            latest.is_some_and(|latest| now().duration_since(latest).is_ok_and(|age| age > COARSEST_CLOCK));
        Some(Self { modified_ns, size, is_settled })
    }

    /// Whether a file of this state is for certain the one that was in that state.
    pub fn is_surely(&self, before: &Self) -> bool {
        before.is_settled && self.modified_ns == before.modified_ns && self.size == before.size
    }
}

#[expect(clippy::disallowed_methods, reason = "tells whether a file was changed just now")]
fn now() -> SystemTime {
    SystemTime::now()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_that_was_just_written_is_not_settled() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.plan.json");
        crate::store::save_bytes(&path, b"1234").unwrap();
        let state = FileState::of(&path).unwrap();
        assert_eq!((state.size, state.is_settled), (4, false));
        assert!(!state.is_surely(&state));
        let past = SystemTime::UNIX_EPOCH + Duration::from_secs(1_000_000);
        std::fs::File::open(&path).unwrap().set_modified(past).unwrap();
        let state = FileState::of(&path).unwrap();
        assert_eq!((state.modified_ns, state.is_settled), (1_000_000_000_000_000, true));
        assert!(state.is_surely(&state));
        assert!(!FileState { size: 5, ..state }.is_surely(&state));
        assert_eq!(FileState::of(&folder.path().join("none")), None);
    }
}
