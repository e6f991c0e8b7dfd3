//! What doors and rooms say about the scales of plans, a line a plan: `enfilade features --scale`.

use serde_json::{Map, Value};

use super::numbers::rounded;
use crate::check::Context;
use crate::check::likely_scale::likely_scale;
use crate::dataset::csv::cell;
use crate::features::{NeighbourLabels, analyse};
use crate::labels::{Schemes, Typology};
use crate::plan::Plan;

/// The columns that identify a plan.
const HEAD: [&str; 6] = ["file", "building", "typology", "storey", "plan", "scale_origin"];

/// The columns of what is measured: numbers of doors and rooms that tell, the doors' median width, how many times
/// too long lengths seem by the rooms, and on all evidence with the range that holds it with 90 % probability.
const MEASURES: [&str; 7] = ["doors", "door_width_m", "rooms", "rooms_factor", "factor", "factor_least", "factor_most"];

/// A plan's line.
pub(super) struct PlanScale {
    texts: [String; 6],
    measures: [Option<f64>; 7],
}

impl PlanScale {
    /// The names of the columns.
    pub(super) fn head() -> impl Iterator<Item = &'static str> {
        HEAD.into_iter().chain(MEASURES)
    }

    /// What a plan says.
    pub(super) fn of(plan: &Plan, file: &str, schemes: &Schemes) -> Self {
        let analysis = analyse(plan, schemes, NeighbourLabels::True);
        let likely = likely_scale(&Context::new(plan, &analysis, schemes));
        let meta = plan.meta();
        let typology = meta.typology.as_ref().map(Typology::as_str).unwrap_or_default();
        let (building, origin) = (meta.building_or_name(), meta.scale.origin.name());
        let doors = likely.and_then(|likely| likely.doors);
        let rooms = likely.and_then(|likely| likely.rooms);
        let range = likely.map(|likely| likely.range());
        Self {
            texts: [file, building, typology, &meta.storey, &meta.name, origin].map(str::to_owned),
            measures: [
                doors.map(|doors| doors.count as f64),
                doors.map(|doors| doors.median_width_m),
                rooms.map(|rooms| rooms.count as f64),
                rooms.map(|rooms| rooms.factor),
                likely.map(|likely| likely.factor()),
                range.map(|(least, _)| least),
                range.map(|(_, most)| most),
            ],
        }
    }

    pub(super) fn cells(self) -> impl Iterator<Item = String> {
        let measures = self.measures.map(|measure| measure.map(cell).unwrap_or_default());
        self.texts.into_iter().chain(measures)
    }

    pub(super) fn json(self) -> Value {
        let texts = HEAD.into_iter().zip(self.texts);
        let texts = texts.map(|(name, text)| (name, if text.is_empty() { Value::Null } else { text.into() }));
        let measures = MEASURES.into_iter().zip(self.measures);
        let measures = measures.map(|(name, measure)| (name, measure.map(rounded).into()));
        texts.chain(measures).map(|(name, value)| (name.to_owned(), value)).collect::<Map<_, _>>().into()
    }
}
