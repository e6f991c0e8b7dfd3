//! Saving never loses the previous file: not to a full disk, a mistake, or a concurrent reader.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use enfilade::plan::{Builder, Meta, Plan, Room};
use enfilade::store::{load_plan, save_bytes, save_bytes_fast, save_plan};

use super::plan_json::full_plan;

/// The names in a folder, sorted: what is there besides is litter.
fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).unwrap();
    let mut names: Vec<String> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn a_saved_plan_loads_as_it_was() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.plan.json");
    for plan in [full_plan(), Plan::default()] {
        save_plan(&path, &plan).unwrap();
        assert_eq!(load_plan(&path).unwrap(), plan);
    }
    assert_eq!(names(folder.path()), ["a.plan.json"]);
}

#[test]
fn a_plan_that_would_not_open_again_is_not_saved() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.plan.json");
    save_plan(&path, &full_plan()).unwrap();
    let clash = serde_json::Map::from_iter([("id".to_owned(), serde_json::Value::Null)]);
    let mut builder = Builder::new(Meta::default());
    builder.room("R1", Room { extra: Some(Arc::new(clash)), ..Room::default() });
    let error = save_plan(&path, builder.plan()).unwrap_err().to_string();
    assert!(error.contains("could not be opened again") && error.contains("undo the last step"), "{error}");
    assert_eq!(load_plan(&path).unwrap(), full_plan());
}

#[test]
fn a_folder_that_is_missing_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("none/a.plan.json");
    let error = save_bytes(&path, b"new").unwrap_err();
    assert_eq!(error.hint, "make the folder first, or save elsewhere");
    assert!(error.to_string().starts_with(&path.display().to_string()));
    assert_eq!(save_bytes(folder.path(), b"new").unwrap_err().what, "is a folder");
    assert!(names(folder.path()).is_empty());
}

#[test]
fn any_file_name_the_system_allows_will_do() {
    let folder = tempfile::tempdir().unwrap();
    let longest = "ä".repeat(127);
    for name in [longest.as_str(), "a b'\"\n.plan.json", "-"] {
        save_bytes(&folder.path().join(name), b"new").unwrap();
        assert_eq!(std::fs::read(folder.path().join(name)).unwrap(), b"new");
    }
    let too_long = save_bytes(&folder.path().join("a".repeat(300)), b"new").unwrap_err();
    assert_eq!(too_long.hint, "choose another file name");
    assert_eq!(names(folder.path()).len(), 3);
}

/// A reader that looks while a file is replaced sees the old bytes or the new, never a part.
#[test]
fn a_reader_never_sees_half_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a");
    let versions = [vec![b'a'; 300_000], vec![b'b'; 500_000]];
    save_bytes(&path, &versions[0]).unwrap();
    let done = AtomicBool::new(false);
    std::thread::scope(|scope| {
        let reader = scope.spawn(|| {
            let mut seen = 0;
            while !done.load(Ordering::Relaxed) || seen == 0 {
                let bytes = std::fs::read(&path).unwrap();
                assert!(versions.contains(&bytes), "half a file of {} bytes", bytes.len());
                seen += 1;
            }
        });
        for round in 0..40 {
            let save = if round % 2 == 0 { save_bytes } else { save_bytes_fast };
            save(&path, &versions[round % 2]).unwrap();
        }
        done.store(true, Ordering::Relaxed);
        reader.join().unwrap();
    });
    assert_eq!(names(folder.path()), ["a"]);
}

#[cfg(unix)]
mod unix {
    use std::fs::{self, Permissions};
    use std::os::unix::fs::{PermissionsExt as _, symlink};

    use super::*;

    fn mode(path: &Path) -> u32 {
        fs::metadata(path).unwrap().permissions().mode() & 0o777
    }

    #[test]
    fn permissions_stay_and_new_files_get_the_usual_ones() {
        let folder = tempfile::tempdir().unwrap();
        let (new, usual) = (folder.path().join("new"), folder.path().join("usual"));
        save_bytes(&new, b"1").unwrap();
        fs::OpenOptions::new().write(true).create_new(true).open(&usual).unwrap();
        assert_eq!(mode(&new), mode(&usual));
        fs::set_permissions(&new, Permissions::from_mode(0o640)).unwrap();
        for save in [save_bytes, save_bytes_fast] {
            save(&new, b"2").unwrap();
            assert_eq!(mode(&new), 0o640);
        }
    }

    #[test]
    fn a_write_protected_file_stays_as_it_is() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        save_bytes(&path, b"old").unwrap();
        fs::set_permissions(&path, Permissions::from_mode(0o444)).unwrap();
        let error = save_bytes(&path, b"new").unwrap_err();
        assert_eq!(error.what, "the file there is write-protected");
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(names(folder.path()), ["a"]);
    }

    #[test]
    fn links_are_followed() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::create_dir(at("plans")).unwrap();
        save_bytes(&at("plans/real"), b"old").unwrap();
        symlink("plans/real", at("link")).unwrap();
        symlink("link", at("link of link")).unwrap();
        symlink("plans/later", at("dangling")).unwrap();
        symlink("loop", at("loop")).unwrap();
        save_bytes(&at("link of link"), b"new").unwrap();
        save_bytes(&at("dangling"), b"later").unwrap();
        assert_eq!(fs::read(at("plans/real")).unwrap(), b"new");
        assert_eq!(fs::read(at("plans/later")).unwrap(), b"later");
        assert!(fs::symlink_metadata(at("link")).unwrap().is_symlink());
        let error = save_bytes(&at("loop"), b"x").unwrap_err();
        assert!(error.what.contains("does not end"), "{error}");
        assert_eq!(names(folder.path()), ["dangling", "link", "link of link", "loop", "plans"]);
        assert_eq!(names(&at("plans")), ["later", "real"]);
    }

    /// The device that is always full, where the system has one.
    #[test]
    fn a_full_disk_says_so() {
        let full = Path::new("/dev/full");
        if !full.exists() {
            println!("skipped: no /dev/full");
            return;
        }
        let error = save_bytes(full, b"new").unwrap_err();
        assert_eq!(error.hint, "free some space, or save on another disk");
        assert!(full.exists(), "a device is written to, never replaced");
        save_bytes(Path::new("/dev/null"), b"new").unwrap();
    }

    #[test]
    fn a_folder_that_may_not_be_written_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let inner = folder.path().join("inner");
        fs::create_dir(&inner).unwrap();
        save_bytes(&inner.join("a"), b"old").unwrap();
        fs::set_permissions(&inner, Permissions::from_mode(0o555)).unwrap();
        let saved = save_bytes(&inner.join("a"), b"new");
        fs::set_permissions(&inner, Permissions::from_mode(0o755)).unwrap();
        match saved {
            Err(error) => {
                assert_eq!(error.hint, "save in a folder you may write to");
                assert_eq!(fs::read(inner.join("a")).unwrap(), b"old");
            }
            Ok(()) => println!("skipped: the superuser may write anywhere"),
        }
        assert_eq!(names(&inner), ["a"]);
    }
}
