//! The files included in a recording.

use super::*;

/// The files of a recording: their names in its folder, and their contents.
#[derive(Clone, Debug, Default)]
pub(super) struct Files(pub(super) Vec<(String, Vec<u8>)>);

impl Files {
    /// Adds a file; returns its path as written in the script.
    pub(super) fn add(&mut self, name: &str, bytes: Vec<u8>) -> String {
        let (stem, ending) = name.split_once('.').unwrap_or((name, "plan.json"));
        let mut number = 1;
        let mut free = name.to_owned();
        while let Some((_, known)) = self.0.iter().find(|(known, _)| *known == free) {
            if *known == bytes {
                return format!("{FOLDER}/{free}");
            }
            number += 1;
            free = format!("{stem}-{number}.{ending}");
        }
        let path = format!("{FOLDER}/{free}");
        self.0.push((free, bytes));
        path
    }

    /// Adds the file at a path, and the backdrops of its plans.
    pub(super) fn add_file(&mut self, path: &Path) -> Option<String> {
        if path.is_dir() {
            // A folder stands for its first plan.
            return self.add_file(plan_list::plans_in(path, Depth::All).first().filter(|plan| plan.is_file())?);
        }
        let bytes = formats::read_bytes(path).ok()?;
        let folder = path.parent().unwrap_or(Path::new(""));
        let plans = formats::read_file(path).map(|import| import.plans).unwrap_or_default();
        // A backdrop stored elsewhere is missing in the replay, as it would be on another machine.
        let beside = |picture: &str| inner(picture).map(|picture| picture.to_string_lossy().into_owned());
        for picture in plans.iter().filter_map(Plan::backdrop).filter_map(|backdrop| beside(&backdrop.path)) {
            if let Ok(bytes) = formats::read_bytes(&folder.join(&picture))
                && !self.0.iter().any(|(known, _)| *known == picture)
            {
                self.0.push((picture, bytes));
            }
        }
        Some(self.add(&file_name(path), bytes))
    }
}
