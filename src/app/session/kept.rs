//! What panels show in each frame, worked out once for each plan and selection: looking at every element of a large
//! plan takes longer than a frame.

use std::cell::RefCell;
use std::sync::Arc;

use super::Session;
use super::selection::Selection;
use crate::edit::{Beside, beside_opening};
use crate::geometry::{Bounds, trim_m};
use crate::labels::{Label, Schemes};
use crate::pipeline::Derived;
use crate::plan::{OpeningId, Plan};
use crate::topology::RoomShape;

/// A value and what it was worked out from.
pub(crate) struct Kept<K, V>(RefCell<Option<(K, V)>>);

impl<K, V> Default for Kept<K, V> {
    fn default() -> Self {
        Self(RefCell::new(None))
    }
}

impl<K: PartialEq, V: Clone> Kept<K, V> {
    /// The value for this key, worked out unless it is the one kept.
    pub(crate) fn or_work_out(&self, key: K, work: impl FnOnce() -> V) -> V {
        if let Some((known, value)) = &*self.0.borrow()
            && *known == key
        {
            return value.clone();
        }
        let value = work();
        *self.0.borrow_mut() = Some((key, value.clone()));
        value
    }
}

/// A plan, equal only to the same value in memory.
pub(crate) struct SamePlan(Plan);

impl SamePlan {
    pub(crate) fn of(plan: &Plan) -> Self {
        Self(plan.clone())
    }
}

impl PartialEq for SamePlan {
    fn eq(&self, other: &Self) -> bool {
        self.0.is_same_value(&other.0)
    }
}

/// A shared value, equal only to itself.
pub(crate) struct Same<T>(Arc<T>);

impl<T> Same<T> {
    pub(crate) fn of(shared: &Arc<T>) -> Self {
        Self(shared.clone())
    }
}

impl<T> PartialEq for Same<T> {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

/// What a plan holds, in numbers.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Contents {
    /// Openings that one can pass.
    pub passable: usize,
    pub windows: usize,
}

/// The areas of all rooms together, in m².
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Areas {
    pub clear_m2: f64,
    /// Within the boundaries.
    pub along_m2: f64,
}

/// What several selected elements have in common.
#[derive(Clone, Debug, Default)]
pub(crate) struct InCommon {
    pub rooms: usize,
    pub walls: usize,
    pub openings: usize,
    pub corners: usize,
    pub dimensions: usize,
    /// The label of all selected rooms.
    pub label: Option<Label>,
    /// The lengths of all selected walls together.
    pub walls_m: f64,
    /// The thickness of every selected wall.
    pub thickness_m: Option<f64>,
    /// The width of every selected opening.
    pub width_m: Option<f64>,
}

/// The selected rooms together.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Together {
    pub rooms: usize,
    /// Their clear areas, in m².
    pub clear_m2: f64,
    /// Whether walls take any of their areas.
    pub has_walls: bool,
    /// The box around them and their walls.
    pub bounds: Bounds,
}

/// The figures of the open plan.
#[derive(Default)]
pub(crate) struct Figures {
    contents: Kept<SamePlan, Contents>,
    areas: Kept<Same<Derived>, Areas>,
    beside: Kept<(SamePlan, OpeningId), Option<[Beside; 2]>>,
    in_common: Kept<(SamePlan, Same<Schemes>, Selection), InCommon>,
    together: Kept<(Same<Derived>, Selection), Option<Together>>,
    /// The plan and the selection that was last found to lie in it.
    checked: Option<(SamePlan, Selection)>,
}

impl Session {
    /// What the plan holds.
    pub(crate) fn contents(&self) -> Contents {
        let Some(plan) = self.plan() else { return Contents::default() };
        self.figures.contents.or_work_out(SamePlan(plan.clone()), || {
            let passable = plan.openings().filter(|(_, opening)| opening.kind.is_passable()).count();
            Contents { passable, windows: plan.openings().len() - passable }
        })
    }

    /// The areas of all rooms together.
    pub(crate) fn areas(&self, derived: &Arc<Derived>) -> Areas {
        self.figures.areas.or_work_out(Same(derived.clone()), || {
            // An empty sum is minus zero.
            let sum_m2 = |areas_m2: &mut dyn Iterator<Item = f64>| areas_m2.fold(0.0, |sum, area_m2| sum + area_m2);
            Areas {
                clear_m2: sum_m2(&mut derived.analysis.net_rooms().iter().flatten().map(|net| net.area_m2)),
                along_m2: sum_m2(&mut derived.analysis.shapes.all().iter().map(RoomShape::area_m2)),
            }
        })
    }

    /// What lies beside an opening, as [`beside_opening`] tells.
    pub(crate) fn beside_opening(&self, id: OpeningId) -> Option<[Beside; 2]> {
        let plan = self.plan()?;
        self.figures.beside.or_work_out((SamePlan(plan.clone()), id), || beside_opening(plan, id))
    }

    /// What the selected elements have in common.
    pub(crate) fn in_common(&self) -> InCommon {
        let Some(plan) = self.plan() else { return InCommon::default() };
        let selection = &self.selection;
        let key = (SamePlan(plan.clone()), Same(self.schemes.clone()), selection.clone());
        self.figures.in_common.or_work_out(key, || {
            let walls: Vec<(f64, f64)> = selection
                .walls()
                .filter_map(|id| plan.wall(id))
                .filter_map(|wall| Some((plan.wall_segment(wall)?.length(), wall.thickness_m)))
                .collect();
            let thicknesses_m = walls.iter().map(|&(_, thickness_m)| thickness_m);
            let widths_m =
                selection.openings().filter_map(|id| Some(trim_m(plan.opening_segment(plan.opening(id)?)?.length())));
            InCommon {
                rooms: selection.rooms().count(),
                walls: selection.walls().count(),
                openings: selection.openings().count(),
                corners: selection.corners().count(),
                dimensions: selection.dimensions().count(),
                label: self.selected_label(),
                walls_m: walls.iter().map(|(length_m, _)| length_m).sum(),
                thickness_m: shared(thicknesses_m),
                width_m: shared(widths_m),
            }
        })
    }

    /// The selected rooms together; `None` if there are none.
    pub(crate) fn rooms_together(&self, derived: &Arc<Derived>) -> Option<Together> {
        let key = (Same(derived.clone()), self.selection.clone());
        self.figures.together.or_work_out(key, || {
            let mut together: Option<Together> = None;
            for id in self.selection.rooms() {
                let (Some(shape), Some(net)) = (derived.analysis.shapes.get(id), derived.analysis.net(id)) else {
                    continue;
                };
                // With its walls, which are about as thick outside as inside.
                let clear = Bounds::of(net.rings().flatten().copied());
                let half_m = if clear.is_empty() { 0.0 } else { (shape.bounds.width() - clear.width()) / 2.0 };
                let bounds = shape.bounds.inflated(half_m.max(0.0));
                let so_far =
                    together.unwrap_or(Together { rooms: 0, clear_m2: 0.0, has_walls: false, bounds: Bounds::EMPTY });
                together = Some(Together {
                    rooms: so_far.rooms + 1,
                    clear_m2: so_far.clear_m2 + net.area_m2,
                    has_walls: so_far.has_walls || net.has_walls,
                    bounds: so_far.bounds.union(bounds),
                });
            }
            together
        })
    }

    /// Deselects what is not in the plan.
    pub(crate) fn keep_selected_what_is_in(&mut self, plan: &Plan) {
        let is_checked = |(checked, selection): &(SamePlan, Selection)| {
            checked.0.is_same_value(plan) && *selection == self.selection
        };
        if !self.figures.checked.as_ref().is_some_and(is_checked) {
            self.selection.keep_what_is_in(plan);
            self.figures.checked = Some((SamePlan(plan.clone()), self.selection.clone()));
        }
    }
}

/// The value that all have, if they have one.
fn shared(values: impl Iterator<Item = f64>) -> Option<f64> {
    let mut values = values;
    let first = values.next()?;
    values.all(|other| other == first).then_some(first)
}
