use std::fmt;
use std::path::Path;

use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::base::hash;
use crate::formats;

/// The SHA-256 of a file's bytes; empty for a folder, and for what cannot be read.
pub fn content_of(path: &Path) -> String {
    let is_file = path.is_file();
    is_file.then(|| formats::read_bytes(path).ok()).flatten().map(|bytes| hash::sha256(&bytes)).unwrap_or_default()
}

/// A file's content at some time, to notice changes by others: a hash of its bytes, the same in every
/// version and on every machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stamp(u64);

impl Stamp {
    /// The stamp of a file that holds these bytes.
    pub fn of_bytes(bytes: &[u8]) -> Self {
        Self(hash::fnv1a(hash::START, bytes.iter().copied()))
    }

    /// The stamp of the file at a path; `None` when it cannot be read.
    pub fn of(path: &Path) -> Option<Self> {
        Some(Self::of_bytes(&formats::read_bytes(path).ok()?))
    }
}

impl fmt::Display for Stamp {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:016x}", self.0)
    }
}

impl Serialize for Stamp {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl<'de> Deserialize<'de> for Stamp {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = String::deserialize(deserializer)?;
        u64::from_str_radix(&text, 16).map(Self).map_err(serde::de::Error::custom)
    }
}
