//! Full disks: a real one of 64 kB if the system allows.

use std::path::Path;
use std::process::Command;

use enfilade::edit;
use enfilade::plan::{History, Meta};
use enfilade::store::{Journal, JournalStart, leftovers, load_plan, save_plan};

use super::house;

/// A disk that is unmounted at the end.
struct Disk(tempfile::TempDir);

impl Disk {
    /// A disk of 64 kB; `None` where that takes rights that are not there.
    fn new() -> Option<Self> {
        let folder = tempfile::tempdir().unwrap();
        let options = ["-t", "tmpfs", "-o", "size=64k", "enfilade-test"];
        let done = Command::new("mount").args(options).arg(folder.path()).output();
        if done.is_ok_and(|done| done.status.success()) {
            return Some(Self(folder));
        }
        println!("skipped: no disk of 64 kB can be mounted here");
        None
    }

    fn path(&self) -> &Path {
        self.0.path()
    }
}

impl Drop for Disk {
    fn drop(&mut self) {
        let _ = Command::new("umount").arg(self.0.path()).output();
    }
}

#[test]
fn a_save_on_a_full_disk_leaves_the_old_file_whole() {
    let Some(disk) = Disk::new() else { return };
    let path = disk.path().join("house.plan.json");
    save_plan(&path, &house()).unwrap();
    std::fs::write(disk.path().join("filler"), vec![0; 40_000]).unwrap();
    let note = "x".repeat(20_000);
    let longer = edit::set_meta(&house(), Meta { source: note, ..house().meta().clone() });
    let error = save_plan(&path, &longer).unwrap_err();
    assert!(error.what.contains("No space left") && error.hint.contains("free some space"), "{error}");
    assert_eq!(load_plan(&path).unwrap(), house());
    assert_eq!(std::fs::read_dir(disk.path()).unwrap().count(), 2, "no temporary file stays behind");
    std::fs::remove_file(disk.path().join("filler")).unwrap();
    save_plan(&path, &longer).unwrap();
    assert_eq!(load_plan(&path).unwrap(), longer);
}

#[test]
fn a_journal_on_a_full_disk_says_so_and_goes_on_when_there_is_space() {
    let Some(disk) = Disk::new() else { return };
    let folder = disk.path().join("journal");
    let mut history = History::new("Open", house());
    let mut journal = Journal::begin(&folder, JournalStart::default(), house(), None, || {});
    let mut number = 0;
    let mut change = |history: &mut History, journal: &mut Journal| {
        number += 1;
        let meta = Meta { source: format!("{number} {}", "x".repeat(3000)), ..history.plan().meta().clone() };
        let plan = edit::set_meta(history.plan(), meta);
        history.push("Write source", plan);
        journal.note(history);
        journal.wait()
    };
    assert_eq!(change(&mut history, &mut journal), Ok(()));
    let filler = disk.path().join("filler");
    std::fs::write(&filler, vec![0; 36_000]).unwrap();
    let failure = (0..20).find_map(|_| change(&mut history, &mut journal).err()).unwrap();
    assert!(failure.what.contains("No space left"), "{failure:?}");
    let _ = change(&mut history, &mut journal);
    std::fs::remove_file(&filler).unwrap();
    let _ = change(&mut history, &mut journal);
    for _ in 0..500 {
        if journal.failure().is_none() && journal.wait().is_ok() {
            break;
        }
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    assert_eq!(journal.failure(), None);
    drop(journal);
    let [leftover] = leftovers(&folder).try_into().unwrap();
    let recovered = leftover.content.as_ref().unwrap();
    assert!(recovered.history.plan() == history.plan() && !recovered.is_cut);
    assert_eq!(recovered.history.position(), history.position(), "no step is missing");
}
