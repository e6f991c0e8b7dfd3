//! What a person decided about rooms of the queue, and its file: JSON with a room a line, so that it reads well, also in the
//! difference of two versions.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::labels::Label;

/// The name of the file of decisions, in the folder whose plans are reviewed. Its ending is no plan's: no list takes it for one.
pub const FILE_NAME: &str = "review.json";

/// The newest version of the file that this program reads.
const VERSION: u64 = 1;

/// What was decided about a room.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// The label is right.
    Accepted,
    /// It was wrong, and was changed.
    Corrected,
    /// Left for later.
    Skipped,
}

impl Verdict {
    pub const fn name(self) -> &'static str {
        match self {
            Self::Accepted => "accepted",
            Self::Corrected => "corrected",
            Self::Skipped => "skipped",
        }
    }
}

/// Which room: its plan's file from the folder reviewed, with `/` between names, and its id there.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Key {
    pub file: String,
    pub room: String,
}

/// A decision about one room.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Decision {
    /// `None` for a note alone.
    pub verdict: Option<Verdict>,
    /// The label that the room had then: after the correction, where there was one.
    pub label: Option<Label>,
    /// What the person wrote; empty for nothing.
    pub note: String,
}

impl Decision {
    /// What it says of the room as it is labelled now: nothing once the label is another.
    pub fn verdict_on(&self, label: Label) -> Option<Verdict> {
        self.verdict.filter(|_| self.label == Some(label))
    }

    fn is_empty(&self) -> bool {
        self.verdict.is_none() && self.note.is_empty()
    }
}

/// The decisions about the rooms of a folder.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Decisions(BTreeMap<Key, Decision>);

/// Decisions as they were read.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReadDecisions {
    pub decisions: Decisions,
    /// What was wrong with the file, in words, without a full stop; what could be read of it is among the decisions. Keep the
    /// file before it is written over.
    pub broken: Option<String>,
}

/// A line of the file.
#[derive(Serialize, Deserialize)]
struct Line {
    file: String,
    room: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    decision: Option<Verdict>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    label: Option<String>,
    #[serde(default, skip_serializing_if = "String::is_empty")]
    note: String,
}

impl Line {
    fn live(self) -> Result<(Key, Decision), String> {
        let label = match self.label.as_deref().map(str::parse::<Label>) {
            None => None,
            Some(Ok(label)) => Some(label),
            Some(Err(_)) => return Err(format!("the room {} has a label that does not exist", self.room)),
        };
        let decision = Decision { verdict: self.decision, label, note: self.note };
        Ok((Key { file: self.file, room: self.room }, decision))
    }
}

#[derive(Deserialize)]
struct Disk {
    version: u64,
    decisions: Vec<Line>,
}

impl Decisions {
    /// Reads a file of decisions. Of a broken one, cut off in the middle or merged with marks of a conflict, every whole line
    /// is kept.
    pub fn read(bytes: &[u8]) -> ReadDecisions {
        let text = String::from_utf8_lossy(bytes);
        let (lines, mut broken): (Vec<Line>, Option<String>) = match serde_json::from_str::<Disk>(&text) {
            Ok(disk) if disk.version > VERSION => {
                let what = format!(
                    "its version is {}, and this program knows {VERSION}: update Enfilade, or use another file",
                    disk.version
                );
                return ReadDecisions { decisions: Self::default(), broken: Some(what) };
            }
            Ok(disk) => (disk.decisions, None),
            Err(error) => {
                let whole = |line: &str| serde_json::from_str(line.trim().trim_end_matches(',')).ok();
                let lines: Vec<Line> = text.lines().filter_map(whole).collect();
                let what = format!("it is not whole ({error}); {} of its decisions could be read", lines.len());
                (lines, Some(what))
            }
        };
        let mut decisions = Self::default();
        for line in lines {
            match line.live() {
                Ok((key, decision)) => decisions.set(key, decision),
                Err(what) => broken = broken.or(Some(what)),
            }
        }
        ReadDecisions { decisions, broken }
    }

    /// The file of these decisions, sorted by file and room.
    pub fn to_bytes(&self) -> Vec<u8> {
        let line = |(key, decision): (&Key, &Decision)| {
            let line = Line {
                file: key.file.clone(),
                room: key.room.clone(),
                decision: decision.verdict,
                label: decision.label.map(|label| label.letter().to_owned()),
                note: decision.note.clone(),
            };
            // Texts and letters alone: nothing in it can fail to be written.
            serde_json::to_string(&line).unwrap_or_default()
        };
        let lines: Vec<String> = self.0.iter().map(line).collect();
        let lines = if lines.is_empty() { String::new() } else { format!("\n{}\n", lines.join(",\n")) };
        format!("{{\"version\":{VERSION},\"decisions\":[{lines}]}}\n").into_bytes()
    }

    pub fn of(&self, key: &Key) -> Option<&Decision> {
        self.0.get(key)
    }

    /// Sets a decision; one that says nothing is none.
    pub fn set(&mut self, key: Key, decision: Decision) {
        if decision.is_empty() {
            self.0.remove(&key);
        } else {
            self.0.insert(key, decision);
        }
    }

    pub fn iter(&self) -> impl Iterator<Item = (&Key, &Decision)> {
        self.0.iter()
    }

    pub fn len(&self) -> usize {
        self.0.len()
    }

    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn some() -> Decisions {
        let mut decisions = Decisions::default();
        let key = |room: &str| Key { file: "a \"b\"/c.plan.json".to_owned(), room: room.to_owned() };
        let decision =
            |verdict, note: &str| Decision { verdict: Some(verdict), label: Some(Label::Hall), note: note.to_owned() };
        decisions.set(key("2"), decision(Verdict::Accepted, ""));
        decisions.set(key("1"), decision(Verdict::Corrected, "line one\nline two, }"));
        decisions.set(key("3"), Decision { note: "ask".to_owned(), ..Decision::default() });
        decisions.set(key("4"), Decision::default());
        decisions
    }

    #[test]
    fn what_is_written_is_read_again() {
        let decisions = some();
        assert_eq!(decisions.len(), 3);
        let bytes = decisions.to_bytes();
        assert_eq!(Decisions::read(&bytes), ReadDecisions { decisions, broken: None });
        let text = String::from_utf8(bytes).unwrap();
        assert_eq!(text.lines().count(), 5, "{text}");
        assert_eq!(Decisions::read(&Decisions::default().to_bytes()), ReadDecisions::default());
    }

    #[test]
    fn of_a_broken_file_every_whole_line_is_kept() {
        let bytes = some().to_bytes();
        let whole_lines = |text: &[u8]| text.iter().filter(|&&byte| byte == b'\n').count();
        for cut in 0..bytes.len() {
            let read = Decisions::read(&bytes[..cut]);
            let least = whole_lines(&bytes[..cut]).saturating_sub(1).min(3);
            assert!(read.decisions.len() >= least, "{cut}: {read:?}");
            assert!(read.broken.is_some() || cut + 1 >= bytes.len(), "{cut}");
        }
        let conflict = String::from_utf8(bytes).unwrap().replace(",\n", ",\n<<<<<<< ours\n");
        assert_eq!(Decisions::read(conflict.as_bytes()).decisions, some());
        let newer = Decisions::read(br#"{"version":2,"decisions":[]}"#);
        assert!(newer.broken.unwrap().contains("update"), "a newer file is not written over");
        let unknown = br#"{"version":1,"decisions":[{"file":"a","room":"1","decision":"accepted","label":"Q"}]}"#;
        assert!(Decisions::read(unknown).broken.is_some());
    }

    #[test]
    fn a_decision_holds_while_the_label_does() {
        let decision = Decision { verdict: Some(Verdict::Accepted), label: Some(Label::Hall), note: String::new() };
        assert_eq!(decision.verdict_on(Label::Hall), Some(Verdict::Accepted));
        assert_eq!(decision.verdict_on(Label::Corridor), None);
    }
}
