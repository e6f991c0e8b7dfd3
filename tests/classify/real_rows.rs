//! Rows of the real plans, which are not part of this repository: `enfilade dataset` of each folder. For
//! tests/classify/mod.rs and benches/classify.rs.

use std::path::{Path, PathBuf};

use enfilade::cli::{Terminal, run};
use enfilade::dataset::{Row, csv};

/// The four data sets: name and folders.
pub const SETS: [(&str, &[&str]); 4] = [
    ("house", &["houses/r2v", "houses/archilyse"]),
    ("school", &["authors/school"]),
    ("office", &["authors/office"]),
    ("all", &["houses/r2v", "houses/archilyse", "authors/school", "authors/office"]),
];

/// The labelled rooms of a data set with true neighbour labels; `None` where the plans are not there.
pub fn real_rows(folders: &[&str]) -> Option<Vec<Row>> {
    let data = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/data"));
    let folders: Vec<PathBuf> = folders.iter().map(|folder| data.join(folder)).collect();
    if folders.iter().any(|folder| !folder.is_dir()) {
        return None;
    }
    let scratch = tempfile::tempdir().unwrap();
    let file = scratch.path().join("rows.csv");
    let arguments = ["enfilade".into(), "dataset".into(), "-o".into(), file.clone().into_os_string()];
    let mut terminal = Terminal::new(std::io::sink(), std::io::sink());
    let exit = run(arguments.into_iter().chain(folders.into_iter().map(PathBuf::into_os_string)), &mut terminal);
    assert_eq!(exit, 0, "enfilade dataset");
    Some(csv::read(std::fs::read(file).unwrap().as_slice()).unwrap())
}
