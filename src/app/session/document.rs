//! The open plan: its history, its origin, and its analysis.

use crate::app::session::origin::Origin;
use crate::app::session::origin::bundled;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use crate::app::session::jobs::Wanted;
use crate::app::session::plan_list::{self, Depth};
use crate::edit;
use crate::formats::{self, FileError, Note, Place, ReadError};
use crate::geometry::Bounds;
use crate::labels::Schemes;
pub(crate) use crate::pipeline::{Derived, Labelled, LabelledBy};
use crate::plan::{CornerId, Difference, ElementId, History, Meta, Plan, Scale, ScaleOrigin};
use crate::store::{self, Stamp};

/// The analysis of a bundled plan, without predictions, which its thumbnail does not show: computed once.
pub(crate) fn derived_sample(index: usize, plan: &Plan) -> Arc<Derived> {
    static DERIVED: Mutex<BTreeMap<usize, Arc<Derived>>> = Mutex::new(BTreeMap::new());
    // A poisoned map at worst lacks an entry.
    let mut derived = DERIVED.lock().unwrap_or_else(PoisonError::into_inner);
    derived.entry(index).or_insert_with(|| Arc::new(Derived::new(plan, &Schemes::bundled(), None))).clone()
}

/// The result of opening a file or a bundled plan.
#[derive(Debug)]
pub(crate) struct Opened {
    pub origin: Origin,
    /// All plans of the file; `origin` says which is shown.
    pub storeys: Vec<Plan>,
    pub notes: Vec<Note>,
    /// The state of the file when it was read; `None` if it cannot be saved in place.
    pub stamp: Option<Stamp>,
    /// The folder that was opened, all of whose plans are listed; without it those beside the file are.
    pub listed: Option<PathBuf>,
    /// The first step of a plan that begins as something else.
    pub begun: Option<Box<Begun>>,
}

/// How such a plan starts.
#[derive(Debug)]
pub(crate) struct Begun {
    /// The title of the step in the history.
    pub title: String,
    pub plan: Plan,
    /// The storey it was copied from, if it was.
    pub below: Option<Plan>,
}

impl Opened {
    /// An empty plan, its typology still unknown.
    pub(crate) fn untitled() -> Self {
        let scale = Scale { origin: ScaleOrigin::Drawn, ..Scale::default() };
        let plan = edit::set_meta(&Plan::default(), Meta { scale, ..Meta::default() });
        Self {
            origin: Origin::Untitled,
            storeys: vec![plan],
            notes: Vec::new(),
            stamp: None,
            listed: None,
            begun: None,
        }
    }
}

/// Reads a plan from its origin.
///
/// # Errors
/// When the file cannot be read; the error names the path.
pub(crate) fn open(origin: Origin) -> Result<Opened, FileError> {
    let (storeys, notes, stamp) = match &origin {
        Origin::Bundled(index) => {
            let plan = bundled().get(*index).map(|(_, plan)| plan.clone()).unwrap_or_default();
            (vec![plan], Vec::new(), None)
        }
        Origin::Untitled => return Ok(Opened::untitled()),
        Origin::File { path, storey } if path.is_dir() => {
            let folder = path.clone();
            let first = plan_list::plans_in(path, Depth::All).into_iter().next();
            let Some(path) = first else {
                let what = "this folder contains no plan".to_owned();
                let hint = format!("open a plan file; {}", formats::known_formats());
                let error = ReadError { place: Place::default(), what, hint };
                return Err(FileError { path: path.clone(), error });
            };
            let opened = open(Origin::File { path, storey: *storey })?;
            // With all its plans, not those beside the first only.
            return Ok(Opened { listed: Some(folder), ..opened });
        }
        Origin::File { path, .. } => {
            // Before reading the plan: a change in between is then noticed when saving, not lost.
            let stamp = is_own_file(path).then(|| Stamp::of(path)).flatten();
            let import = formats::read_file(path)?;
            (import.plans, import.notes, stamp)
        }
    };
    Ok(Opened { origin, storeys, notes, stamp, listed: None, begun: None })
}

/// Whether a path is a file in Enfilade's own format, which can be saved in place.
pub(crate) fn is_own_file(path: &Path) -> bool {
    path.to_string_lossy().to_lowercase().ends_with(".plan.json")
}

/// In a plan of fewer elements looking at each takes no time.
const FEW_ELEMENTS: usize = 2000;

/// The open plan.
pub(crate) struct Document {
    /// Distinguishes documents opened one after the other.
    pub number: u64,
    pub history: History,
    pub origin: Origin,
    /// All plans of its file, as they were read.
    pub storeys: Vec<Plan>,
    pub notes: Vec<Note>,
    /// The state of its file when last read or written.
    pub stamp: Option<Stamp>,
    /// The plan as on disk, or as it was opened; `None` if it is in no file.
    saved: Option<Plan>,
    /// Whether its file has been removed.
    pub is_gone: bool,
    /// Whether what walls close becomes a room: at first where the plan was begun here.
    pub closes_rooms: bool,
    derived: Option<(Plan, Arc<Derived>)>,
    /// The labels last worked out, perhaps of an earlier plan: the next are worked out from them.
    labelled: Option<Arc<Labelled>>,
    /// The analysis in progress.
    awaited: Option<Awaited>,
    /// Which models predict.
    by: LabelledBy,
}

/// The plan that a job is analysing, and the models it uses.
struct Awaited {
    plan: Plan,
    by: LabelledBy,
    /// The job; `None` if it panicked, as it would again.
    job: Option<Wanted>,
}

impl Document {
    pub(crate) fn new(number: u64, opened: Opened) -> Self {
        let Opened { origin, storeys, notes, stamp, begun, listed: _ } = opened;
        let storey = match origin {
            Origin::Bundled(_) | Origin::Untitled => 0,
            Origin::File { storey, .. } => storey,
        };
        let plan = storeys.get(storey).or(storeys.first()).cloned().unwrap_or_default();
        let mut history = History::new("Open", plan.clone());
        if let Some(begun) = begun {
            history.push(begun.title, begun.plan);
        }
        let (derived, labelled, awaited, by) = (None, None, None, LabelledBy::default());
        let (saved, is_gone) = (Some(plan), false);
        let closes_rooms = origin == Origin::Untitled;
        Self {
            number,
            history,
            origin,
            storeys,
            notes,
            stamp,
            saved,
            is_gone,
            closes_rooms,
            derived,
            labelled,
            awaited,
            by,
        }
    }

    pub(crate) fn plan(&self) -> &Plan {
        self.history.plan()
    }

    /// The plan's name or, without one, its file's.
    pub(crate) fn title(&self) -> String {
        let name = &self.plan().meta().name;
        if name.is_empty() { self.origin.title() } else { name.clone() }
    }

    /// Whether closing would lose anything.
    pub(crate) fn is_changed(&self) -> bool {
        let is_saved = |saved: &Plan| self.plan().is_same_value(saved) || self.plan() == saved;
        self.is_gone || !self.saved.as_ref().is_some_and(is_saved)
    }

    /// The plan as on disk, or as it was opened.
    pub(crate) fn saved(&self) -> Option<&Plan> {
        self.saved.as_ref()
    }

    /// Records the current state of the file: its plan, if it has one.
    pub(crate) fn stands_in_file(&mut self, plan: Option<Plan>, stamp: Option<Stamp>) {
        self.saved = plan;
        self.stamp = stamp;
        self.is_gone = false;
    }

    /// The index of the history step whose plan is on disk; the last, if several are.
    pub(crate) fn saved_step(&self) -> Option<usize> {
        let saved = self.saved.as_ref()?;
        self.history.steps().iter().rposition(|step| step.plan.is_same_value(saved))
    }

    /// Records that `plan` is now in a file.
    pub(crate) fn was_saved(&mut self, plan: Plan, path: PathBuf, stamp: Option<Stamp>) {
        self.stands_in_file(Some(plan), stamp);
        if self.origin.path() != Some(&path) {
            self.origin = Origin::File { path, storey: 0 };
            self.storeys.clear();
        }
    }

    /// The analysis of the current plan; `None` while it is in progress.
    pub(crate) fn derived(&self) -> Option<&Arc<Derived>> {
        let is_fresh = |(plan, derived): &&(Plan, Arc<Derived>)| {
            plan.is_same_value(self.plan()) && derived.labelled.by.as_ref() == Some(&self.by)
        };
        self.derived.as_ref().filter(is_fresh).map(|(_, derived)| derived)
    }

    /// Sets which models predict.
    pub(crate) fn label_by(&mut self, by: &LabelledBy) {
        if self.by != *by {
            self.by.clone_from(by);
        }
    }

    /// The labels of the current plan, which are there before the rest of its analysis; `None` while they are worked out.
    pub(crate) fn labelled(&self) -> Option<&Arc<Labelled>> {
        let is_fresh = |labelled: &&Arc<Labelled>| {
            labelled.plan().is_same_value(self.plan()) && labelled.by.as_ref() == Some(&self.by)
        };
        self.labelled.as_ref().filter(is_fresh)
    }

    /// The labels last worked out, perhaps of an earlier plan or by other models: never shown as current.
    pub(crate) fn last_labelled(&self) -> Option<&Arc<Labelled>> {
        self.labelled.as_ref()
    }

    /// Takes the labels of a plan; those of an earlier one are dropped.
    pub(crate) fn set_labelled(&mut self, labelled: Arc<Labelled>) {
        if labelled.plan().is_same_value(self.plan()) && labelled.by.as_ref() == Some(&self.by) {
            self.labelled = Some(labelled);
            // What is still to come is another job's.
            self.awaited = None;
        }
    }

    /// The last plan analysed, perhaps an earlier one: to be drawn in the meantime, but never shown as
    /// current.
    pub(crate) fn last_derived(&self) -> Option<&(Plan, Arc<Derived>)> {
        self.derived.as_ref()
    }

    /// The analysis of the current plan, or of an earlier one while it is in progress; and whether it is the current one.
    pub(crate) fn derived_or_last(&self) -> Option<(&Arc<Derived>, bool)> {
        let is_fresh = self.derived().is_some();
        self.derived.as_ref().map(|(_, derived)| (derived, is_fresh))
    }

    /// Whether the current plan is neither analysed nor being analysed, and can be.
    pub(crate) fn needs_deriving(&self) -> bool {
        let is_awaited = self
            .awaited
            .as_ref()
            .is_some_and(|awaited| awaited.plan.is_same_value(self.plan()) && awaited.by == self.by);
        self.derived().is_none() && !is_awaited
    }

    /// Records that a job is analysing the plan. One for an earlier plan is cancelled.
    pub(crate) fn await_derived(&mut self, job: Wanted) {
        let (plan, by) = (self.plan().clone(), self.by.clone());
        self.awaited = Some(Awaited { plan, by, job: Some(job) });
    }

    /// Records that the job for a plan panicked: it is not restarted until the plan or the models change.
    pub(crate) fn could_not_be_derived(&mut self, plan: &Plan) {
        if let Some(awaited) = self.awaited.as_mut().filter(|awaited| awaited.plan.is_same_value(plan)) {
            awaited.job = None;
        }
    }

    /// Models or label schemes have changed: the plan is to be analysed anew.
    pub(crate) fn forget_derived(&mut self) {
        (self.derived, self.labelled, self.awaited) = (None, None, None);
    }

    /// The plan is out of sight: it is not analysed any more.
    pub(crate) fn rests(&mut self) {
        self.awaited = None;
    }

    /// Whether a job is analysing the plan.
    pub(crate) fn is_awaited(&self) -> bool {
        self.awaited.as_ref().is_some_and(|awaited| awaited.job.is_some())
    }

    /// Takes the analysis of a plan; dropped if the plan or the models have changed since.
    pub(crate) fn set_derived(&mut self, plan: Plan, derived: Arc<Derived>) {
        if plan.is_same_value(self.plan()) && derived.labelled.by.as_ref() == Some(&self.by) {
            self.labelled = Some(derived.labelled.clone());
            self.derived = Some((plan, derived));
            self.awaited = None;
        }
    }

    /// The elements that meet a box, or more, found without looking at every one: from the last analysis, and what was
    /// changed since. `None` where the plan is small, or not analysed yet.
    pub(crate) fn near(&self, bounds: Bounds) -> Option<BTreeSet<ElementId>> {
        let (plan, (earlier, derived)) = (self.plan(), self.derived.as_ref()?);
        if plan.walls().len() + plan.rooms().len() < FEW_ELEMENTS {
            return None;
        }
        let mut near = derived.near(bounds)?;
        if !earlier.is_same_value(plan) {
            let difference = Difference::between(earlier, plan);
            if difference.elements.len() > FEW_ELEMENTS {
                return None;
            }
            near.extend(difference.seen(earlier, plan).into_keys());
            near.extend(difference.elements.into_keys());
            near.retain(|&element| plan.has(element));
        }
        Some(near)
    }

    /// The bounding box of all that uses a corner, and of what else is there.
    pub(crate) fn around(&self, corner: CornerId) -> Bounds {
        let Some(place) = self.plan().position(corner).map(|place| Bounds::of([place])) else { return Bounds::EMPTY };
        let near = self.near(place).unwrap_or_default();
        near.into_iter().filter_map(|element| self.bounds_of(element)).fold(place, Bounds::union)
    }

    /// The bounding box of an element.
    pub(crate) fn bounds_of(&self, picked: ElementId) -> Option<Bounds> {
        let plan = self.plan();
        let bounds = match picked {
            ElementId::Room(id) => Bounds::of(plan.ring_points(&plan.room(id)?.outer)),
            ElementId::Opening(id) => plan.opening_segment(plan.opening(id)?)?.bounds(),
            ElementId::Wall(id) => plan.wall_segment(plan.wall(id)?)?.bounds(),
            ElementId::Corner(id) => Bounds::of([plan.position(id)?]),
            ElementId::Dimension(id) => {
                let line = plan.dimension_line(plan.dimension(id)?)?;
                Bounds::of(line.ticks.iter().flat_map(|&(measured, on_line)| [measured, on_line]))
            }
        };
        (!bounds.is_empty()).then_some(bounds)
    }
}

/// Saves a plan to a path and returns the file's stamp.
///
/// # Errors
/// As [`store::save_plan`]; [`SaveFailure::ChangedOnDisk`] when the file there is not the one that
/// `expected` stamps.
pub(crate) fn save(path: &Path, plan: &Plan, expected: Expected) -> Result<Option<Stamp>, SaveFailure> {
    if let Expected::Seen(stamp) = expected
        && path.exists()
        && Stamp::of(path) != stamp
    {
        return Err(SaveFailure::ChangedOnDisk);
    }
    let bytes = store::checked_bytes(path, plan).map_err(SaveFailure::Store)?;
    store::save_bytes(path, &bytes).map_err(SaveFailure::Store)?;
    // Not read back from disk: somebody may already have changed the file.
    Ok(Some(Stamp::of_bytes(&bytes)))
}

/// The expected state of the file at the path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Expected {
    /// The file as last seen; `None` for no file.
    Seen(Option<Stamp>),
    /// Any: the user chose the path, or agreed to overwrite.
    Anything,
}

/// Why a plan was not saved.
#[derive(Debug)]
pub(crate) enum SaveFailure {
    ChangedOnDisk,
    Store(store::SaveError),
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::classify::models::Models;

    #[test]
    fn labels_that_are_no_longer_true_are_not_current() {
        let mut document = Document::new(0, open(Origin::Bundled(0)).unwrap());
        let (schemes, models, by) = (Schemes::bundled(), Models::bundled(), LabelledBy::default());
        let labels_of = |plan: &Plan| Arc::new(Labelled::new(plan, &schemes, Some((&by, &models)), None));
        let before = document.plan().clone();
        document.set_labelled(labels_of(&before));
        assert!(document.labelled().is_some());
        document.forget_derived();
        assert!(document.labelled().is_none(), "models or label schemes have changed");
        document.set_labelled(labels_of(&before));
        let after = edit::set_meta(&before, Meta { name: "Another".to_owned(), ..before.meta().clone() });
        document.history.push("Rename".to_owned(), after);
        assert!(document.labelled().is_none(), "the plan has changed");
        document.set_labelled(labels_of(&before));
        assert!(document.labelled().is_none(), "they come too late");
    }
}
