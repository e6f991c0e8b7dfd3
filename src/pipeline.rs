//! From a plan to all that is derived from it: analysis -> network -> labels -> drawing. The only way
//! there, for the window, every subcommand and the robot, so that they cannot disagree about a plan.
//!
//! [`Pipeline`] computes each step when it is first needed; [`Derived`] holds all of them, with what the
//! window needs for picking and snapping.

use std::cell::OnceCell;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Arc, Mutex, PoisonError};

use rstar::{AABB, PointDistance, RTree, RTreeObject};

use crate::base::units::Units;
use crate::base::work::{Cancelled, Work};
use crate::classify::Method;
use crate::classify::model_file::ModelFileError;
use crate::classify::models::{Models, StoredModel};
use crate::classify::why::Why;
use crate::dataset::sets::STANDARD;
use crate::dataset::{Measured, RoomNetwork};
use crate::draw::Drawing;
use crate::features::{Analysis, NeighbourLabels, analyse_after};
use crate::geometry::{Bounds, Point, Segment};
use crate::labels::{Schemes, Typology, normalised_function};
use crate::plan::{ElementId, OpeningId, Plan, RoomId};
use crate::predict::{After, ModelSet, Predictions, Predictor, infer};
use crate::snapping::PlanIndex;
use crate::topology::{self, Gap};

/// What is derived from a plan, each step computed when it is first needed.
pub struct Pipeline<'a> {
    plan: &'a Plan,
    schemes: &'a Schemes,
    neighbours: NeighbourLabels,
    before: Option<&'a Labelled>,
    analysis: OnceCell<Arc<Analysis>>,
    measured: OnceCell<Measured>,
    network: OnceCell<Arc<RoomNetwork>>,
}

impl<'a> Pipeline<'a> {
    /// Nothing is computed yet. Features count the known labels of neighbours.
    pub fn new(plan: &'a Plan, schemes: &'a Schemes) -> Self {
        Self::counting(plan, schemes, NeighbourLabels::True)
    }

    /// The same, with features that count these labels of neighbours. The network and the predictions do
    /// not depend on it: they count labels themselves.
    pub fn counting(plan: &'a Plan, schemes: &'a Schemes, neighbours: NeighbourLabels) -> Self {
        let (analysis, measured, network) = (OnceCell::new(), OnceCell::new(), OnceCell::new());
        Self { plan, schemes, neighbours, before: None, analysis, measured, network }
    }

    /// After an edit of the plan that this was derived from. It is only faster: the results are the same.
    fn after(self, before: Option<&'a Labelled>) -> Self {
        Self { before, ..self }
    }

    fn shared_analysis(&self) -> &Arc<Analysis> {
        self.analysis.get_or_init(|| {
            let before = self.before.map(|before| before.analysis.as_ref());
            Arc::new(analyse_after(self.plan, self.schemes, self.neighbours, before))
        })
    }

    /// Shapes, graph, and the features and status of each room.
    pub fn analysis(&self) -> &Analysis {
        self.shared_analysis()
    }

    fn measured(&self) -> &Measured {
        self.measured.get_or_init(|| match self.before {
            None => Measured::new(self.plan, self.analysis()),
            Some(before) => Measured::after(self.plan, self.analysis(), &before.analysis, &before.measured),
        })
    }

    fn shared_network(&self) -> &Arc<RoomNetwork> {
        self.network.get_or_init(|| Arc::new(RoomNetwork::of_measured(self.plan, self.analysis(), self.measured())))
    }

    /// The rooms as classifiers see them.
    pub fn network(&self) -> &RoomNetwork {
        self.shared_network()
    }

    /// A model's predictions for the rooms.
    ///
    /// # Errors
    /// When a bundled model cannot be read, which the tests rule out.
    pub fn predictions(&self, asked: &Asked) -> Result<Predictions, ModelFileError> {
        self.predictions_after(asked, After::Nothing)
    }

    fn predictions_after(&self, asked: &Asked, after: After<'_>) -> Result<Predictions, ModelFileError> {
        let (network, choice) = match (&asked.model, &asked.predictor.set) {
            (None, ModelSet::Auto) => {
                // What the plan states decides nothing: not the models, nor which rooms are classified.
                let taken_for = |typology: Option<&Typology>| {
                    let (analysis, measured) = (self.analysis(), self.measured());
                    RoomNetwork::of_analysed_taken_for(self.plan, analysis, measured, typology, self.schemes)
                };
                let choice = infer(&taken_for(None));
                let typology = Typology::new(&choice.set).filter(|_| choice.set != STANDARD);
                (Arc::new(taken_for(typology.as_ref())), Some(choice))
            }
            _ => (self.shared_network().clone(), None),
        };
        let known = if asked.hides_labels { vec![None; network.rooms.len()] } else { network.known_labels() };
        match &asked.model {
            None => asked.predictor.predict_as(network, choice, &known, asked.neighbours, &asked.models, after),
            Some(model) => Ok(Predictions::by(network, model.clone(), &known, asked.neighbours)),
        }
    }

    /// The plan as drawn, with predicted labels if there are predictions.
    pub fn drawing(&self, predictions: Option<&Predictions>) -> Drawing {
        let drawing = Drawing::new(self.plan, self.analysis());
        match predictions {
            None => drawing,
            Some(predictions) => drawing.with_predictions(&predictions.labels()).with_sureness(&predictions.sureness()),
        }
    }

    /// Takes the analysis out.
    pub fn into_analysis(self) -> Arc<Analysis> {
        self.shared_analysis().clone()
    }
}

/// Which models label a plan, and which others are asked beside them.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LabelledBy {
    pub predictor: Predictor,
    /// A second opinion, to compare.
    pub second: Option<SecondOpinion>,
}

/// Another method, or other labels of neighbours, with models of the same set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SecondOpinion {
    pub method: Method,
    /// `None`: as in the model's training.
    pub neighbours: Option<NeighbourLabels>,
}

/// A plan with the labels predicted for its rooms: what must follow an edit at once. From one the next is worked out, with the
/// same result as if there had been none before.
pub struct Labelled {
    pub analysis: Arc<Analysis>,
    measured: Measured,
    /// The predictions for the rooms; `None` if none were requested, or there is no model of the
    /// requested method.
    pub predictions: Option<Arc<Predictions>>,
    /// The second opinion, if one was asked for and there is a model for it.
    pub second: Option<Arc<Predictions>>,
    /// Which models were to predict.
    pub by: Option<LabelledBy>,
}

impl Labelled {
    /// Labels the rooms of a plan; without models, all but the predictions. `before` are the labels before an edit, under
    /// the same schemes or others.
    pub fn new(plan: &Plan, schemes: &Schemes, by: Option<(&LabelledBy, &Models)>, before: Option<&Self>) -> Self {
        let pipeline = Pipeline::new(plan, schemes).after(before);
        let of_before = before.and_then(|before| before.predictions.as_deref()).map_or(After::Start, After::Edit);
        let second_before = before.and_then(|before| before.second.as_deref()).map_or(After::Start, After::Edit);
        let predictions: Option<Arc<Predictions>> = by.and_then(|(by, models)| {
            let predicted = pipeline.predictions_after(&Asked::by(&by.predictor, models), of_before);
            predicted.ok().map(Arc::new)
        });
        let second = by.zip(predictions.as_ref()).and_then(|((by, models), first)| {
            let SecondOpinion { method, neighbours } = by.second?;
            // By models of the set that the first were chosen from.
            let predictor = Predictor { set: ModelSet::Named(first.choice.set.clone()), method };
            let known = first.network.known_labels();
            let network = first.network.clone();
            predictor.predict_as(network, None, &known, neighbours, models, second_before).ok().map(Arc::new)
        });
        Self {
            measured: pipeline.measured().clone(),
            analysis: pipeline.into_analysis(),
            predictions,
            second,
            by: by.map(|(by, _)| by.clone()),
        }
    }

    /// The plan.
    pub fn plan(&self) -> &Plan {
        self.analysis.plan()
    }
}

/// How to classify rooms.
#[derive(Clone, Debug, Default)]
pub struct Asked {
    /// Which of the available models.
    pub predictor: Predictor,
    pub models: Models,
    /// A model from a file, instead.
    pub model: Option<Arc<StoredModel>>,
    /// Which labels of neighbours count; `None`: as in the model's training.
    pub neighbours: Option<NeighbourLabels>,
    /// Whether to treat all labels as unknown, as in a new building.
    pub hides_labels: bool,
}

impl Asked {
    /// With the available models and all known labels: as the window does, and `enfilade classify`
    /// without options.
    pub fn by(predictor: &Predictor, models: &Models) -> Self {
        Self { predictor: predictor.clone(), models: models.clone(), ..Self::default() }
    }
}

/// Why a room got its label, for the last room asked about, with the units it is told in.
type Reason = ((RoomId, Units), Option<Arc<Why>>);

/// What is derived from a plan.
pub struct Derived {
    /// The plan and its labels.
    pub labelled: Arc<Labelled>,
    /// That of [`Derived::labelled`].
    pub analysis: Arc<Analysis>,
    pub drawing: Drawing,
    /// Those of [`Derived::labelled`].
    pub predictions: Option<Arc<Predictions>>,
    reason: Mutex<Option<Reason>>,
    /// A spatial index of corners, walls and boundaries: for snapping and selecting.
    pub index: PlanIndex,
    /// Doorways left open in walls.
    pub gaps: Vec<Gap>,
    openings: RTree<OpeningPlace>,
    leaves: RTree<LeafPlace>,
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

/// A door's leaf, open, and the arc of its swing.
#[derive(Debug)]
struct LeafPlace {
    id: OpeningId,
    hinge: Point,
    shut: Point,
    tip: Point,
}

impl RTreeObject for LeafPlace {
    type Envelope = AABB<[f64; 2]>;

    fn envelope(&self) -> Self::Envelope {
        let opposite = self.shut + (self.tip - self.hinge);
        let bounds = Bounds::of([self.hinge, self.shut, self.tip, opposite]);
        AABB::from_corners([bounds.min.x, bounds.min.y], [bounds.max.x, bounds.max.y])
    }
}

impl PointDistance for LeafPlace {
    /// To the leaf or to the arc, whichever is nearer: what lies between them is the room's floor.
    fn distance_2(&self, point: &[f64; 2]) -> f64 {
        let point = Point::new(point[0], point[1]);
        let leaf_m = Segment::new(self.hinge, self.tip).distance(point);
        let (from, open, shut) = (point - self.hinge, self.tip - self.hinge, self.shut - self.hinge);
        let arc_m = if from.dot(open) >= 0.0 && from.dot(shut) >= 0.0 {
            (from.length() - open.length()).abs()
        } else {
            point.distance(self.tip).min(point.distance(self.shut))
        };
        leaf_m.min(arc_m).powi(2)
    }
}

impl Derived {
    /// Computes everything derived from a plan; without a predictor, all but predictions.
    pub fn new(plan: &Plan, schemes: &Schemes, predictor: Option<(Predictor, Models)>) -> Self {
        let by = predictor.map(|(predictor, models)| (LabelledBy { predictor, second: None }, models));
        let by = by.as_ref().map(|(by, models)| (by, models));
        Self::from_labelled(Arc::new(Labelled::new(plan, schemes, by, None)))
    }

    /// Computes the rest of what is derived from a plan whose rooms are labelled.
    pub fn from_labelled(labelled: Arc<Labelled>) -> Self {
        let drawing = Drawing::in_tiles(labelled.plan(), &labelled.analysis);
        Self::of(labelled, drawing)
    }

    /// The same, stopping between steps when the work is cancelled.
    ///
    /// # Errors
    /// When cancelled.
    pub fn by_steps(labelled: Arc<Labelled>, work: &Work<'_>) -> Result<Self, Cancelled> {
        work.goes_on()?;
        labelled.analysis.net_rooms();
        work.goes_on()?;
        let drawing = Drawing::in_tiles(labelled.plan(), &labelled.analysis);
        work.goes_on()?;
        Ok(Self::of(labelled, drawing))
    }

    fn of(labelled: Arc<Labelled>, drawing: Drawing) -> Self {
        let (analysis, predictions) = (labelled.analysis.clone(), labelled.predictions.clone());
        let plan = labelled.plan();
        let openings = plan
            .openings()
            .filter_map(|(id, opening)| Some(OpeningPlace { id, segment: plan.opening_segment(opening)? }))
            .collect();
        let labels = predictions.as_deref().map(Predictions::labels).unwrap_or_default();
        // Compared here, beside the frames, for the panel that shows it.
        predictions.as_deref().map(Predictions::acquaintance);
        let sureness = predictions.as_deref().map(Predictions::sureness).unwrap_or_default();
        let drawing = drawing.with_predictions(&labels).with_sureness(&sureness);
        let reading_order = analysis.shapes.reading_order();
        let openings = RTree::bulk_load(openings);
        let leaf = |(id, [hinge, shut, tip]): (OpeningId, [Point; 3])| LeafPlace { id, hinge, shut, tip };
        let leaves = RTree::bulk_load(drawing.sweeps().map(leaf).collect());
        let index = PlanIndex::new(plan);
        let mut functions: BTreeMap<String, usize> = BTreeMap::new();
        for (_, room) in plan.rooms() {
            *functions.entry(normalised_function(&room.function)).or_default() += 1;
        }
        let gaps = topology::gaps(plan);
        let reason = Mutex::default();
        Self {
            labelled,
            analysis,
            drawing,
            predictions,
            reason,
            index,
            gaps,
            openings,
            leaves,
            reading_order,
            functions,
        }
    }

    /// The rooms with a boundary in reading order: from the top left, line by line.
    pub fn reading_order(&self) -> &[RoomId] {
        &self.reading_order
    }

    /// The rooms with a boundary from the top left, column by column.
    pub fn column_order(&self) -> Vec<RoomId> {
        self.analysis.shapes.column_order()
    }

    /// The elements of the plan whose boxes meet a box, corners included; `None` where they are not known.
    pub fn near(&self, bounds: Bounds) -> Option<BTreeSet<ElementId>> {
        let mut near: BTreeSet<ElementId> = self.index.elements_in(bounds)?.collect();
        let shapes = &self.analysis.shapes;
        near.extend(shapes.near(bounds).into_iter().map(|index| ElementId::Room(shapes.all()[index].id)));
        let envelope = AABB::from_corners([bounds.min.x, bounds.min.y], [bounds.max.x, bounds.max.y]);
        let openings = self.openings.locate_in_envelope_intersecting(envelope);
        near.extend(openings.map(|opening| ElementId::Opening(opening.id)));
        Some(near)
    }

    /// Why a room got its predicted label, with areas in these units; `None` if it has none. Computed when asked about
    /// another room.
    pub fn why(&self, room: RoomId, units: Units) -> Option<Arc<Why>> {
        let predictions = self.predictions.as_ref()?;
        // A poisoned mutex still holds the previous value, which is valid.
        let mut last = self.reason.lock().unwrap_or_else(PoisonError::into_inner);
        if last.as_ref().is_none_or(|(of, _)| *of != (room, units)) {
            *last = Some(((room, units), predictions.why(room, units).map(Arc::new)));
        }
        last.as_ref().and_then(|(_, why)| why.clone())
    }

    /// What can be picked at a point: openings within `reach_m` metres, then walls, nearest first, then doors whose
    /// leaf or arc is there, then rooms, smallest first. Walls and leaves have half the reach of openings.
    pub fn at(&self, point: Point, reach_m: f64) -> Vec<ElementId> {
        let place = [point.x, point.y];
        let mut near: Vec<(f64, OpeningId)> = self
            .openings
            .locate_within_distance(place, reach_m * reach_m)
            .map(|opening| (opening.distance_2(&place), opening.id))
            .collect();
        near.sort_by(|p, q| p.0.total_cmp(&q.0).then(p.1.cmp(&q.1)));
        let half_m = reach_m / 2.0;
        let mut swept: Vec<(f64, OpeningId)> = self
            .leaves
            .locate_within_distance(place, half_m * half_m)
            .filter(|leaf| near.iter().all(|(_, id)| *id != leaf.id))
            .map(|leaf| (leaf.distance_2(&place), leaf.id))
            .collect();
        swept.sort_by(|p, q| p.0.total_cmp(&q.0).then(p.1.cmp(&q.1)));
        swept.dedup_by_key(|(_, id)| *id);
        let openings = near.into_iter().map(|(_, id)| ElementId::Opening(id));
        let leaves = swept.into_iter().map(|(_, id)| ElementId::Opening(id));
        let shapes = &self.analysis.shapes;
        let rooms = shapes.at(point).into_iter().map(|index| ElementId::Room(shapes.all()[index].id));
        let walls =
            self.index.edges_near(point, reach_m / 2.0).into_iter().filter_map(|edge| edge.wall).map(ElementId::Wall);
        openings.chain(walls).chain(leaves).chain(rooms).collect()
    }
}
