//! One case for each behaviour of the reader: `cases/<behaviour>.xml` with its notes in `….notes.txt` and
//! the plan in `….plan.json` beside it.

use std::path::PathBuf;

use enfilade::formats::{self, plan_json};

use super::golden::{compare, fixture};

/// The cases' files, in the order of their names.
pub fn cases() -> Vec<PathBuf> {
    let mut cases: Vec<PathBuf> = std::fs::read_dir(fixture("cases"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "xml"))
        .collect();
    cases.sort();
    cases
}

#[test]
fn each_case_gives_its_plan_and_notes() {
    let mut wrong = Vec::new();
    for case in cases() {
        let import = formats::read_file(&case).unwrap_or_else(|error| panic!("{error}"));
        let mut notes = String::new();
        for note in &import.notes {
            notes.push_str(&format!("{note}\n"));
        }
        wrong.extend(
            compare(
                &case.with_extension("notes.txt"),
                Some(&notes).filter(|notes| !notes.is_empty()).map(String::as_str),
            )
            .err(),
        );
        for (index, plan) in import.plans.iter().enumerate() {
            let name =
                if import.plans.len() == 1 { "plan.json".to_owned() } else { format!("{}.plan.json", index + 1) };
            let bytes = plan_json::to_bytes(plan);
            wrong.extend(compare(&case.with_extension(name), Some(std::str::from_utf8(&bytes).unwrap())).err());
            assert_eq!(plan_json::from_bytes(&bytes).as_ref(), Ok(plan), "{}", case.display());
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
