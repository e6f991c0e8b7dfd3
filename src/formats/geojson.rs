//! GeoJSON in metres: a FeatureCollection of rooms, openings and walls. `docs/geojson.md` describes
//! the properties for outsiders.

mod coordinates;
mod disk;
mod read;
mod words;
mod write;

use super::{Format, Import, ReadError};
use crate::labels::Schemes;
use crate::plan::Plan;

/// GeoJSON in metres.
pub struct GeoJson;

impl Format for GeoJson {
    fn name(&self) -> &'static str {
        "GeoJSON"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["geojson"]
    }

    fn recognises(&self, head: &[u8]) -> bool {
        let head = String::from_utf8_lossy(head);
        head.trim_start_matches('\u{feff}').trim_start().starts_with('{') && head.contains("\"FeatureCollection\"")
    }

    fn read(&self, bytes: &[u8], stem: &str) -> Result<Import, ReadError> {
        read::read(bytes, stem)
    }

    fn write(&self, plan: &Plan, schemes: &Schemes) -> Option<Vec<u8>> {
        Some(write::write(plan, schemes))
    }
}

/// The field of an element's or plan's [`crate::plan::Extra`] that keeps GeoJSON properties which
/// Enfilade has no place for, so that writing GeoJSON again gives them back.
const KEPT: &str = "geojson";
