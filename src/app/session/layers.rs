//! What is shown of a plan, and what the pointer ignores.

use super::Session;
use crate::draw::{Fill, LabelColours};
use crate::plan::ElementId;
use crate::plan::Guide;

/// What is shown of a plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct LayerSettings {
    pub(crate) fill: Fill,
    pub(crate) colours: LabelColours,
    pub(crate) graph: bool,
    pub(crate) names: bool,
    pub(crate) backdrop: bool,
    pub(crate) grid: bool,
    pub(crate) guides: bool,
    /// Lengths and area of the selection.
    pub(crate) dimensions: bool,
    /// The storey below.
    pub(crate) ghost: bool,
    pub(crate) rulers: bool,
    /// Rooms, walls and openings that the pointer cannot select or move.
    pub(crate) locked: Locked,
}

/// What the pointer ignores.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Locked {
    pub(crate) rooms: bool,
    pub(crate) walls: bool,
    pub(crate) openings: bool,
}

impl LayerSettings {
    pub(crate) fn is_locked(&self, element: ElementId) -> bool {
        match element {
            ElementId::Room(_) => self.locked.rooms,
            ElementId::Wall(_) => self.locked.walls,
            ElementId::Opening(_) => self.locked.openings,
            ElementId::Corner(_) | ElementId::Dimension(_) => false,
        }
    }
}

impl Default for LayerSettings {
    fn default() -> Self {
        Self {
            fill: Fill::Label,
            colours: LabelColours::Standard,
            graph: false,
            names: true,
            backdrop: true,
            grid: true,
            guides: true,
            dimensions: true,
            ghost: true,
            rulers: false,
            locked: Locked::default(),
        }
    }
}

impl Session {
    /// The visible guide lines of the open plan, for snapping.
    pub(crate) fn guides(&self) -> &[Guide] {
        let plan = self.plan().filter(|_| self.layers.guides);
        plan.map_or(&[], crate::plan::Plan::guides)
    }
}
