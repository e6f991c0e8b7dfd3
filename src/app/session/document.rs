//! The plan that is open: its history, where it came from, and what follows from it.

use crate::app::session::origin::Origin;
use crate::app::session::origin::bundled;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use rstar::{AABB, PointDistance, RTree, RTreeObject};

use crate::app::session::plan_list;
use crate::classify::models::Models;
use crate::dataset::RoomNetwork;
use crate::draw::Drawing;
use crate::edit;
use crate::features::{Analysis, NeighbourLabels, analyse};
use crate::formats::{self, FileError, Note, Place, ReadError};
use crate::geometry::{Bounds, Point, Segment};
use crate::labels::{Schemes, normalised_function};
use crate::plan::{ElementId, History, Meta, OpeningId, Plan, RoomId, Scale, ScaleOrigin};
use crate::predict::{Predictions, Predictor};
use crate::snapping::PlanIndex;
use crate::store::{self, Stamp};
use crate::topology::{self, Gap};

/// What follows from a bundled plan without predictions, which its picture does not show: worked out once.
pub(crate) fn derived_sample(index: usize, plan: &Plan) -> Arc<Derived> {
    static DERIVED: Mutex<BTreeMap<usize, Arc<Derived>>> = Mutex::new(BTreeMap::new());
    // A poisoned map only lacks an entry.
    let mut derived = DERIVED.lock().unwrap_or_else(PoisonError::into_inner);
    derived.entry(index).or_insert_with(|| Arc::new(Derived::new(plan, &Schemes::bundled(), None))).clone()
}

/// What a file or a bundled plan gave.
#[derive(Debug)]
pub(crate) struct Opened {
    pub origin: Origin,
    /// All plans of the file; `origin` says which is shown.
    pub storeys: Vec<Plan>,
    pub notes: Vec<Note>,
    /// What the file held when it was read; `None` for what cannot be saved in place.
    pub stamp: Option<Stamp>,
    /// The first step of a plan that begins as something else.
    pub begun: Option<Box<Begun>>,
}

/// How a plan begins.
#[derive(Debug)]
pub(crate) struct Begun {
    /// What was done, as in the history.
    pub title: String,
    pub plan: Plan,
    /// The storey it came from.
    pub below: Plan,
}

impl Opened {
    /// A plan on which nothing is drawn yet, of a typology yet unknown.
    pub(crate) fn untitled() -> Self {
        let scale = Scale { origin: ScaleOrigin::Drawn, ..Scale::default() };
        let plan = edit::set_meta(&Plan::default(), Meta { scale, ..Meta::default() });
        Self { origin: Origin::Untitled, storeys: vec![plan], notes: Vec::new(), stamp: None, begun: None }
    }
}

/// Reads a plan from where it is.
///
/// # Errors
/// When the file cannot be read; an error names the path.
pub(crate) fn open(origin: Origin) -> Result<Opened, FileError> {
    let (storeys, notes, stamp) = match &origin {
        Origin::Bundled(index) => {
            let plan = bundled().get(*index).map(|(_, plan)| plan.clone()).unwrap_or_default();
            (vec![plan], Vec::new(), None)
        }
        Origin::Untitled => return Ok(Opened::untitled()),
        Origin::File { path, storey } if path.is_dir() => {
            let first = plan_list::plans_in(path).into_iter().next();
            let Some(path) = first else {
                let what = "there is no plan in this folder".to_owned();
                let hint = "open a plan file, the authors' XML, or GeoJSON".to_owned();
                let error = ReadError { place: Place::default(), what, hint };
                return Err(FileError { path: path.clone(), error });
            };
            return open(Origin::File { path, storey: *storey });
        }
        Origin::File { path, .. } => {
            // Before the plan: a change between the two is then noticed when saving, not lost.
            let stamp = is_own_file(path).then(|| Stamp::of(path)).flatten();
            let import = formats::read_file(path)?;
            (import.plans, import.notes, stamp)
        }
    };
    Ok(Opened { origin, storeys, notes, stamp, begun: None })
}

/// Whether a path names a file of Enfilade's own, which can be saved in place.
pub(crate) fn is_own_file(path: &Path) -> bool {
    path.to_string_lossy().to_lowercase().ends_with(".plan.json")
}

/// The open plan.
pub(crate) struct Document {
    /// Tells documents apart that were open one after the other.
    pub number: u64,
    pub history: History,
    pub origin: Origin,
    /// All plans of the file it came from, as they were read.
    pub storeys: Vec<Plan>,
    pub notes: Vec<Note>,
    /// What its file held when it was last read or written.
    pub stamp: Option<Stamp>,
    /// The plan as it is on the disk, or as it came; `None` when it is in no file.
    saved: Option<Plan>,
    /// Whether its file was removed.
    pub is_gone: bool,
    derived: Option<(Plan, Arc<Derived>)>,
    /// What is being worked out.
    awaited: Option<Awaited>,
    /// Which models predict.
    predictor: Predictor,
}

/// The plan for which a job is at work, and the models it uses.
struct Awaited {
    plan: Plan,
    predictor: Predictor,
    /// Tells the job that nobody waits for it any more.
    outdated: Arc<AtomicBool>,
}

impl Drop for Awaited {
    fn drop(&mut self) {
        self.outdated.store(true, Ordering::Relaxed);
    }
}

impl Document {
    pub(crate) fn new(number: u64, opened: Opened) -> Self {
        let Opened { origin, storeys, notes, stamp, begun } = opened;
        let storey = match origin {
            Origin::Bundled(_) | Origin::Untitled => 0,
            Origin::File { storey, .. } => storey,
        };
        let plan = storeys.get(storey).or(storeys.first()).cloned().unwrap_or_default();
        let mut history = History::new("Open", plan.clone());
        if let Some(begun) = begun {
            history.push(begun.title, begun.plan);
        }
        let (derived, awaited, predictor) = (None, None, Predictor::default());
        let (saved, is_gone) = (Some(plan), false);
        Self { number, history, origin, storeys, notes, stamp, saved, is_gone, derived, awaited, predictor }
    }

    pub(crate) fn plan(&self) -> &Plan {
        self.history.plan()
    }

    /// The plan's name, or its file's.
    pub(crate) fn title(&self) -> String {
        let name = &self.plan().meta().name;
        if name.is_empty() { self.origin.title() } else { name.clone() }
    }

    /// Whether something would be lost by closing.
    pub(crate) fn is_changed(&self) -> bool {
        let is_saved = |saved: &Plan| self.plan().is_same_value(saved) || self.plan() == saved;
        self.is_gone || !self.saved.as_ref().is_some_and(is_saved)
    }

    /// The plan as it is on the disk, or as it came.
    pub(crate) fn saved(&self) -> Option<&Plan> {
        self.saved.as_ref()
    }

    /// Takes note of what the file holds now: a plan, if it is one.
    pub(crate) fn stands_in_file(&mut self, plan: Option<Plan>, stamp: Option<Stamp>) {
        self.saved = plan;
        self.stamp = stamp;
        self.is_gone = false;
    }

    /// The step of the history whose plan is the one on the disk, counted from 0; the last of several.
    pub(crate) fn saved_step(&self) -> Option<usize> {
        let saved = self.saved.as_ref()?;
        self.history.steps().iter().rposition(|step| step.plan.is_same_value(saved))
    }

    /// Notes that `plan` now stands in a file.
    pub(crate) fn was_saved(&mut self, plan: Plan, path: PathBuf, stamp: Option<Stamp>) {
        self.stands_in_file(Some(plan), stamp);
        if self.origin.path() != Some(&path) {
            self.origin = Origin::File { path, storey: 0 };
            self.storeys.clear();
        }
    }

    /// What follows from the plan as it is now; `None` while that is being worked out.
    pub(crate) fn derived(&self) -> Option<&Arc<Derived>> {
        let is_fresh = |(plan, derived): &&(Plan, Arc<Derived>)| {
            plan.is_same_value(self.plan()) && derived.predictor.as_ref() == Some(&self.predictor)
        };
        self.derived.as_ref().filter(is_fresh).map(|(_, derived)| derived)
    }

    /// Lets these models predict.
    pub(crate) fn predict_by(&mut self, predictor: &Predictor) {
        if self.predictor != *predictor {
            self.predictor.clone_from(predictor);
        }
    }

    /// The last plan for which everything was worked out, perhaps an earlier one: to be drawn in the
    /// meantime, and never shown as fresh.
    pub(crate) fn last_derived(&self) -> Option<&(Plan, Arc<Derived>)> {
        self.derived.as_ref()
    }

    /// Whether what follows from the plan is neither known nor being worked out.
    pub(crate) fn needs_deriving(&self) -> bool {
        let is_awaited = self
            .awaited
            .as_ref()
            .is_some_and(|awaited| awaited.plan.is_same_value(self.plan()) && awaited.predictor == self.predictor);
        self.derived().is_none() && !is_awaited
    }

    /// Notes that a job is at work for the plan. One that is for an earlier plan is told to give up. Gives
    /// what will tell this one.
    pub(crate) fn await_derived(&mut self) -> Arc<AtomicBool> {
        let outdated = Arc::new(AtomicBool::new(false));
        let (plan, predictor) = (self.plan().clone(), self.predictor.clone());
        self.awaited = Some(Awaited { plan, predictor, outdated: outdated.clone() });
        outdated
    }

    /// Takes over what was worked out for a plan; dropped when the plan or the models are others by now.
    pub(crate) fn set_derived(&mut self, plan: Plan, derived: Arc<Derived>) {
        if plan.is_same_value(self.plan()) && derived.predictor.as_ref() == Some(&self.predictor) {
            self.derived = Some((plan, derived));
            self.awaited = None;
        }
    }

    /// The box around something.
    pub(crate) fn bounds_of(&self, picked: ElementId) -> Option<Bounds> {
        let plan = self.plan();
        let bounds = match picked {
            ElementId::Room(id) => Bounds::of(plan.ring_points(&plan.room(id)?.outer)),
            ElementId::Opening(id) => plan.opening_segment(plan.opening(id)?)?.bounds(),
            ElementId::Wall(id) => plan.wall_segment(plan.wall(id)?)?.bounds(),
            ElementId::Corner(id) => Bounds::of([plan.position(id)?]),
        };
        (!bounds.is_empty()).then_some(bounds)
    }
}

/// What follows from a plan.
pub(crate) struct Derived {
    pub analysis: Analysis,
    pub drawing: Drawing,
    /// What a classifier says of the rooms; `None` where none was asked, and where there is no model of the
    /// method that is asked for.
    pub predictions: Option<Predictions>,
    predictor: Option<Predictor>,
    /// Why a room got its label, as asked for last.
    reason: Mutex<Option<(RoomId, Option<String>)>>,
    /// Corners, walls and boundaries by place: to snap to, and to select.
    pub index: PlanIndex,
    /// Doorways left open in walls.
    pub gaps: Vec<Gap>,
    openings: RTree<OpeningPlace>,
    reading_order: Vec<RoomId>,
    /// How many rooms have each function, as [`normalised_function`] writes it.
    pub functions: BTreeMap<String, usize>,
}

#[derive(Debug)]
struct OpeningPlace {
    id: OpeningId,
    segment: Segment,
}

impl RTreeObject for OpeningPlace {
    type Envelope = AABB<[f64; 2]>;

    fn envelope(&self) -> Self::Envelope {
        let Segment { a, b } = self.segment;
        AABB::from_corners([a.x.min(b.x), a.y.min(b.y)], [a.x.max(b.x), a.y.max(b.y)])
    }
}

impl PointDistance for OpeningPlace {
    fn distance_2(&self, point: &[f64; 2]) -> f64 {
        self.segment.distance(Point::new(point[0], point[1])).powi(2)
    }
}

impl Derived {
    /// Works out all that follows from a plan; without a predictor all but predictions.
    pub(crate) fn new(plan: &Plan, schemes: &Schemes, predictor: Option<(Predictor, Models)>) -> Self {
        let (predictor, models) = predictor.unzip();
        let analysis = analyse(plan, schemes, NeighbourLabels::True);
        let predictions = Self::predicted(plan, &analysis, predictor.as_ref(), models.as_ref());
        let drawing = Drawing::in_tiles(plan, &analysis);
        Self::of(plan, analysis, predictions, predictor, drawing)
    }

    /// The same, given up between its steps when it turns out that a later plan is worked out.
    pub(crate) fn unless_outdated(
        plan: &Plan,
        schemes: &Schemes,
        predictor: Option<(Predictor, Models)>,
        outdated: &AtomicBool,
    ) -> Option<Self> {
        let (predictor, models) = predictor.unzip();
        let goes_on = || (!outdated.load(Ordering::Relaxed)).then_some(());
        goes_on()?;
        let analysis = analyse(plan, schemes, NeighbourLabels::True);
        goes_on()?;
        let predictions = Self::predicted(plan, &analysis, predictor.as_ref(), models.as_ref());
        goes_on()?;
        let drawing = Drawing::in_tiles(plan, &analysis);
        goes_on()?;
        Some(Self::of(plan, analysis, predictions, predictor, drawing))
    }

    fn predicted(
        plan: &Plan,
        analysis: &Analysis,
        predictor: Option<&Predictor>,
        models: Option<&Models>,
    ) -> Option<Predictions> {
        let (predictor, models) = (predictor?, models?);
        let network = RoomNetwork::of(plan, analysis);
        let known = network.known_labels();
        predictor.predict(network, &known, None, models).ok()
    }

    fn of(
        plan: &Plan,
        analysis: Analysis,
        predictions: Option<Predictions>,
        predictor: Option<Predictor>,
        drawing: Drawing,
    ) -> Self {
        let openings = plan
            .openings()
            .filter_map(|(id, opening)| Some(OpeningPlace { id, segment: plan.opening_segment(opening)? }))
            .collect();
        let labels = predictions.as_ref().map(Predictions::labels).unwrap_or_default();
        let drawing = drawing.with_predictions(&labels);
        let reading_order = reading_order(&analysis);
        let openings = RTree::bulk_load(openings);
        let index = PlanIndex::new(plan);
        let mut functions: BTreeMap<String, usize> = BTreeMap::new();
        for (_, room) in plan.rooms() {
            *functions.entry(normalised_function(&room.function)).or_default() += 1;
        }
        let gaps = topology::gaps(plan);
        let reason = Mutex::default();
        Self { analysis, drawing, predictions, predictor, reason, index, gaps, openings, reading_order, functions }
    }

    /// The rooms with a boundary as one reads: from the top left, line by line.
    pub(crate) fn reading_order(&self) -> &[RoomId] {
        &self.reading_order
    }

    /// The rooms with a boundary from the top left, column by column.
    pub(crate) fn column_order(&self) -> Vec<RoomId> {
        in_lines(&self.analysis, |bounds| (bounds.min.x, bounds.width()), |bounds| -bounds.max.y)
    }

    /// Why a room got the label that is predicted, in words; `None` where none is. Worked out when asked
    /// for another room.
    pub(crate) fn reason(&self, room: RoomId) -> Option<String> {
        let predictions = self.predictions.as_ref()?;
        // A poisoned one holds what was there before, which is right.
        let mut last = self.reason.lock().unwrap_or_else(PoisonError::into_inner);
        if last.as_ref().is_none_or(|(of, _)| *of != room) {
            *last = Some((room, predictions.reason(room)));
        }
        last.as_ref().and_then(|(_, reason)| reason.clone())
    }

    /// What can be picked at a point: openings within `reach_m` metres, then walls, the nearest first, then
    /// rooms, the smallest first. A wall is reached half as far beside it as an opening.
    pub(crate) fn at(&self, point: Point, reach_m: f64) -> Vec<ElementId> {
        let place = [point.x, point.y];
        let mut near: Vec<(f64, OpeningId)> = self
            .openings
            .locate_within_distance(place, reach_m * reach_m)
            .map(|opening| (opening.distance_2(&place), opening.id))
            .collect();
        near.sort_by(|p, q| p.0.total_cmp(&q.0).then(p.1.cmp(&q.1)));
        let openings = near.into_iter().map(|(_, id)| ElementId::Opening(id));
        let shapes = &self.analysis.shapes;
        let rooms = shapes.at(point).into_iter().map(|index| ElementId::Room(shapes.all()[index].id));
        let walls =
            self.index.edges_near(point, reach_m / 2.0).into_iter().filter_map(|edge| edge.wall).map(ElementId::Wall);
        openings.chain(walls).chain(rooms).collect()
    }
}

/// Rooms from the top left, line by line.
fn reading_order(analysis: &Analysis) -> Vec<RoomId> {
    in_lines(analysis, |bounds| (-bounds.max.y, bounds.height()), |bounds| bounds.min.x)
}

/// Rooms in lines, and in order within each. `across` tells where a room begins across the lines and how
/// far it extends: a line is as wide as half a typical room.
fn in_lines(
    analysis: &Analysis,
    across: impl Fn(&Bounds) -> (f64, f64),
    along: impl Fn(&Bounds) -> f64,
) -> Vec<RoomId> {
    let mut rooms: Vec<(RoomId, Bounds)> = analysis
        .shapes
        .all()
        .iter()
        .filter(|shape| !shape.bounds.is_empty())
        .map(|shape| (shape.id, shape.bounds))
        .collect();
    let mut extents: Vec<f64> = rooms.iter().map(|(_, bounds)| across(bounds).1).collect();
    extents.sort_by(f64::total_cmp);
    let line_m = extents.get(extents.len() / 2).map_or(1.0, |extent| (extent / 2.0).max(0.1));
    let line = |bounds: &Bounds| (across(bounds).0 / line_m).ceil() as i64;
    rooms.sort_by(|(p, a), (q, b)| {
        let within = along(a).total_cmp(&along(b)).then(across(a).0.total_cmp(&across(b).0));
        line(a).cmp(&line(b)).then(within).then(p.cmp(q))
    });
    rooms.into_iter().map(|(id, _)| id).collect()
}

/// Saves a plan to a path and gives the file's stamp.
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
    // Not read from the disk: somebody may have changed the file by now.
    Ok(Some(Stamp::of_bytes(&bytes)))
}

/// What stands at the path that a plan is saved to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Expected {
    /// The file as it was last seen; `None` for no file.
    Seen(Option<Stamp>),
    /// Whatever: the person chose the path, or agreed to overwrite.
    Anything,
}

/// Why a plan was not saved.
#[derive(Debug)]
pub(crate) enum SaveFailure {
    ChangedOnDisk,
    Store(store::SaveError),
}
