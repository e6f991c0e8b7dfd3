//! The plans that the figures of `docs/robot-explore.md` are of: 20 of ours and 20 real ones, by a rule.

use std::error::Error;
use std::path::{Path, PathBuf};

use enfilade::check::{Severity, check};
use enfilade::labels::Schemes;
use enfilade::plan::Plan;

use crate::layouts;

/// What a plan is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Set {
    /// Bundled, or made by a seed.
    Own,
    /// Real ones, by their places in each folder from the first: the first, third, ... were looked at while thresholds
    /// were chosen.
    RealOdd,
    RealEven,
    /// Named one by one.
    Other,
}

/// A plan to explore.
pub struct Case {
    pub name: String,
    pub set: Set,
    pub plan: Plan,
}

/// The bundled plans and the 17 that [`layouts`] makes.
pub fn own() -> Result<Vec<Case>, Box<dyn Error>> {
    let mut cases = Vec::new();
    for name in ["dwelling", "office", "school"] {
        let path = format!("{}/plans/{name}.plan.json", env!("CARGO_MANIFEST_DIR"));
        cases.push(Case { name: name.to_owned(), set: Set::Own, plan: enfilade::open(path)?.plan().clone() });
    }
    cases.extend(generated());
    Ok(cases)
}

/// The 17 plans that [`layouts`] makes.
pub fn generated() -> impl Iterator<Item = Case> {
    layouts::plans().into_iter().map(|(name, plan)| Case { name, set: Set::Own, plan })
}

/// How many plans are taken of each folder of real ones.
const REAL: [(&str, usize); 5] =
    [("houses/r2v", 6), ("houses/archilyse", 4), ("authors/office", 4), ("authors/school", 4), ("kth", 2)];

/// The first plans of each folder by name that open without a finding of severity 'error'; of `kth` the first of each
/// building. So many `rounds` of these are passed over first: with 1 the plans that come after them, with 2 those after these.
pub fn real(folder: &Path, rounds: usize) -> Result<Vec<Case>, Box<dyn Error>> {
    let mut cases = Vec::new();
    for (source, count) in REAL {
        let mut passed = 0;
        let skipped = rounds * count;
        for path in files(&folder.join(source))? {
            if passed >= skipped + count {
                break;
            }
            let name = path.strip_prefix(folder).unwrap_or(&path).display().to_string();
            let plan = match sound(&path) {
                Ok(plan) => plan,
                Err(reason) => {
                    eprintln!("{name}: left out: {reason}");
                    continue;
                }
            };
            if passed >= skipped {
                let set = if passed % 2 == 0 { Set::RealOdd } else { Set::RealEven };
                cases.push(Case { name, set, plan });
            }
            passed += 1;
        }
    }
    Ok(cases)
}

/// The files of a folder by name; of its folders the first file each.
fn files(folder: &Path) -> Result<Vec<PathBuf>, Box<dyn Error>> {
    let entries = |folder: &Path| -> Result<Vec<PathBuf>, Box<dyn Error>> {
        let read = std::fs::read_dir(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
        let mut paths = read.map(|entry| Ok(entry?.path())).collect::<Result<Vec<_>, std::io::Error>>()?;
        paths.sort();
        Ok(paths)
    };
    let mut found = Vec::new();
    for path in entries(folder)? {
        if path.is_dir() {
            found.extend(entries(&path)?.into_iter().next());
        } else if path.extension().is_some_and(|extension| extension == "xml" || extension == "geojson") {
            found.push(path);
        }
    }
    Ok(found)
}

/// The plan of a file, if it opens and nothing in it is an error.
fn sound(path: &Path) -> Result<Plan, Box<dyn Error>> {
    let open = enfilade::open(path)?;
    let findings = check(open.plan(), &open.analyse(), &Schemes::bundled());
    match findings.iter().find(|finding| finding.severity() == Severity::Error) {
        Some(finding) => Err(finding.what().into()),
        None => Ok(open.plan().clone()),
    }
}
