//! What follows from predictions beyond the labels themselves: a second opinion beside them, labels while something is
//! dragged, the kind of building, and how a label would change with a room's features.

use std::sync::Arc;

use super::Session;
use super::deriving::is_large;
use super::kept::{Kept, Same, SamePlan};
use crate::app::session::document::{Document, Labelled, LabelledBy};
use crate::classify::{Classifier, Distribution, Method, PlanClassifier};
use crate::dataset::table::Values;
use crate::draw::Fill;
use crate::features::{Features, NeighbourLabels};
use crate::labels::Label;
use crate::pipeline::SecondOpinion;
use crate::plan::{Plan, RoomId};
use crate::predict::{Choice, infer};

/// Probabilities differ visibly from this on.
const VISIBLE: f64 = 0.05;

/// A room of which the second opinion is another: both labels with their probabilities, the second opinion last.
pub(crate) type Disagreement = (RoomId, (Label, f64), (Label, f64));

/// The state of the live labels.
pub(crate) struct Live {
    /// Whether the panel is shown.
    pub is_shown: bool,
    /// The second opinion.
    pub second: Option<SecondOpinion>,
    /// Predictions so sure, 0..=1, are accepted together.
    pub least: f64,
    pub what_if: WhatIf,
    kind: Kept<Same<Labelled>, Arc<Choice>>,
    dragged: Kept<(SamePlan, Same<Labelled>), Option<Arc<Labelled>>>,
    regions: Kept<RegionsKey, Option<Arc<Regions>>>,
}

impl Default for Live {
    fn default() -> Self {
        Self {
            is_shown: false,
            second: None,
            least: 0.8,
            what_if: WhatIf::default(),
            kind: Kept::default(),
            dragged: Kept::default(),
            regions: Kept::default(),
        }
    }
}

/// What would change of a room's label.
#[derive(Clone, Debug)]
pub(crate) struct Changed {
    pub room: RoomId,
    /// The label before and after, each with its probability.
    pub before: (Label, f64),
    pub after: (Label, f64),
}

impl Changed {
    /// Whether it is another label, not only a surer or a less sure one.
    pub(crate) fn is_flip(&self) -> bool {
        self.before.0 != self.after.0
    }
}

/// How labels differ between two states of a plan: flips first, then the largest changes of what is thought.
pub(crate) fn changes(before: &Labelled, after: &Labelled) -> Vec<Changed> {
    let Some((earlier, later)) = before.predictions.as_ref().zip(after.predictions.as_ref()) else {
        return Vec::new();
    };
    let mut changes: Vec<Changed> = later
        .network
        .rooms
        .iter()
        .zip(&later.result.distributions)
        .filter_map(|(room, distribution)| {
            let changed = Changed {
                room: room.id,
                before: earlier.distribution(room.id)?.likeliest(),
                after: distribution.likeliest(),
            };
            let is_seen = changed.is_flip() || (changed.before.1 - changed.after.1).abs() >= VISIBLE;
            is_seen.then_some(changed)
        })
        .collect();
    let size = |changed: &Changed| (changed.before.1 - changed.after.1).abs();
    changes.sort_by(|p, q| q.is_flip().cmp(&p.is_flip()).then(size(q).total_cmp(&size(p))).then(p.room.cmp(&q.room)));
    changes
}

impl Session {
    /// Whether labels are being watched: then they are also shown while something is dragged.
    pub(crate) fn watches_labels(&self) -> bool {
        self.live.is_shown || self.layers.fill == Fill::Prediction
    }

    /// The labels that the rooms would get if the plan became this one; `None` for a large plan, where they would take longer
    /// than a frame.
    pub(crate) fn labels_if(&self, plan: &Plan) -> Option<Arc<Labelled>> {
        let labelled = self.document.as_ref()?.labelled()?;
        if is_large(plan) {
            return None;
        }
        let key = (SamePlan::of(plan), Same::of(labelled));
        self.live.dragged.or_work_out(key, || {
            let by = LabelledBy { predictor: self.predictor.clone(), second: None };
            Some(Arc::new(Labelled::new(plan, &self.schemes, Some((&by, &self.models)), Some(labelled))))
        })
    }

    /// What kind of building the plan looks like, whatever it states.
    pub(crate) fn kind_of_building(&self) -> Option<Arc<Choice>> {
        let labelled = self.document.as_ref().and_then(Document::labelled)?;
        let predictions = labelled.predictions.as_ref()?;
        let work = || match predictions.choice.posterior.is_empty() {
            true => Arc::new(infer(&predictions.network)),
            false => Arc::new(predictions.choice.clone()),
        };
        Some(self.live.kind.or_work_out(Same::of(labelled), work))
    }

    /// The rooms of which the second opinion is another, with both labels and their probabilities.
    pub(crate) fn disagreements(&self) -> Vec<Disagreement> {
        let Some((one, other)) = self.predictions().zip(self.second_opinion()) else { return Vec::new() };
        let rooms = one.network.rooms.iter().zip(&one.result.distributions);
        rooms
            .filter_map(|(room, distribution)| {
                let (one, other) = (distribution.likeliest(), other.distribution(room.id)?.likeliest());
                (one.0 != other.0).then_some((room.id, one, other))
            })
            .collect()
    }

    /// Whether Enter accepts the prediction for the picked room: labels are watched, and it has none.
    pub(crate) fn accepts_by_enter(&self) -> bool {
        let is_unlabelled = |id: RoomId| {
            let predictions = self.predictions()?;
            predictions.network.rooms.iter().find(|room| room.id == id).map(|room| room.label.is_none())
        };
        self.watches_labels() && self.picked_room().is_some_and(|(id, _)| is_unlabelled(id) == Some(true))
    }
}

// What if.

/// Features of a room that a person has changed to see what its label would be.
#[derive(Clone, Debug)]
pub(crate) struct WhatIf {
    /// The room, and what its features would be; `None` as long as none was changed.
    pub changed: Option<(RoomId, Features)>,
    /// The features along the two axes of the picture, by their index in [`Features::NAMES`].
    pub axes: [usize; 2],
    /// The method, where it looks at each room by itself; otherwise the decision tree.
    pub method: Option<Method>,
}

impl Default for WhatIf {
    fn default() -> Self {
        Self { changed: None, axes: [0, 2], method: None }
    }
}

/// A room as what-if sees it.
#[derive(Clone)]
pub(crate) struct Tried {
    pub room: RoomId,
    /// Its features as they are, and as they would be.
    pub now: Features,
    pub then: Features,
    /// The model that is asked.
    pub model: Arc<crate::classify::models::StoredModel>,
    /// What it says of both.
    pub said_now: Distribution,
    pub said_then: Distribution,
}

impl Tried {
    fn classifier(&self) -> Option<&Classifier> {
        classifier_of(&self.model)
    }
}

fn classifier_of(model: &crate::classify::models::StoredModel) -> Option<&Classifier> {
    match &model.classifier {
        PlanClassifier::Each(classifier) => Some(classifier),
        PlanClassifier::Joint(_) | PlanClassifier::Blend(_) => None,
    }
}

/// The labels over two features, with the others as they are.
pub(crate) struct Regions {
    /// What the axes run over, as [`Scale`] measures it.
    pub scales: [Scale; 2],
    /// Row by row from the lower left: the label and its probability.
    pub cells: Vec<(Label, f64)>,
    /// The plan's rooms: where, and the label that the model gives them.
    pub rooms: Vec<(RoomId, [f64; 2], Label)>,
    /// Where the room in question is.
    pub tried: [f64; 2],
}

/// Cells of the picture of regions, across and up.
pub(crate) const CELLS: [usize; 2] = [72, 48];

/// How a feature lies along an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Scale {
    pub feature: usize,
    pub low: f64,
    pub high: f64,
}

impl Scale {
    /// An axis over values: areas and ratios by their logarithms, numbers of openings evenly.
    fn over(feature: usize, values: impl Iterator<Item = f64>) -> Self {
        let (low, high) =
            values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
        let (low, high) = if low <= high { (low, high) } else { (0.0, 1.0) };
        match feature {
            0 => Self { feature, low: (low * 0.7).max(0.5), high: (high * 1.4).max(4.0) },
            1 => Self { feature, low: 1.0, high: (high * 1.2).max(2.0) },
            _ => Self { feature, low: -0.5, high: high.max(3.0) + 0.5 },
        }
    }

    const fn is_logarithmic(&self) -> bool {
        self.feature < 2
    }

    /// Where a value lies, 0 at the low end and 1 at the high one.
    pub(crate) fn place(&self, value: f64) -> f64 {
        let measure = |value: f64| if self.is_logarithmic() { value.max(1e-6).ln() } else { value };
        (measure(value) - measure(self.low)) / (measure(self.high) - measure(self.low))
    }

    /// The value at a place: the nearest whole number, for a number of openings.
    fn value(&self, place: f64) -> f64 {
        if self.is_logarithmic() {
            return (self.low.ln() + (self.high.ln() - self.low.ln()) * place).exp();
        }
        (self.low + (self.high - self.low) * place).round().max(0.0)
    }

    /// Round values along it, to be written beside it.
    pub(crate) fn ticks(&self) -> Vec<f64> {
        let round: &[f64] = match self.feature {
            0 => &[1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0, 2000.0, 5000.0],
            1 => &[1.0, 1.5, 2.0, 3.0, 5.0, 10.0, 20.0],
            _ => &[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 15.0, 20.0, 30.0, 40.0, 60.0],
        };
        let mut ticks: Vec<f64> = Vec::new();
        for &value in round.iter().filter(|value| (self.low..=self.high).contains(*value)) {
            // Far enough from the one before.
            if ticks.last().is_none_or(|&last| self.place(value) - self.place(last) > 0.09) {
                ticks.push(value);
            }
        }
        ticks
    }
}

#[derive(PartialEq)]
struct RegionsKey {
    labelled: Same<Labelled>,
    model: String,
    room: RoomId,
    then: Features,
    axes: [usize; 2],
}

impl Session {
    /// The picked room with its features as they are, and as they would be; an error says why there is no answer.
    pub(crate) fn tried(&self) -> Result<Tried, &'static str> {
        let Some((room, _)) = self.picked_room() else { return Err("Pick a room to see what its label depends on.") };
        let Some(predictions) = self.predictions() else { return Err("Being worked out…") };
        let Some(index) = predictions.network.rooms.iter().position(|it| it.id == room) else {
            return Err("This room is not classified: it has no area, or the label scheme leaves it out.");
        };
        let now = predictions.result.features[index];
        let then = self.live.what_if.changed.filter(|(of, _)| *of == room).map_or(now, |(_, features)| features);
        let own = Some(predictions.model.clone()).filter(|model| classifier_of(model).is_some());
        let own = own.filter(|model| self.live.what_if.method.is_none_or(|method| model.method() == method));
        let tree = Method::Each(crate::classify::Algorithm::TREE);
        let method = self.live.what_if.method.unwrap_or(tree);
        let model = match own {
            Some(model) => model,
            None => {
                self.models.find(&predictions.choice.set, method).map_err(|_| "There is no model of this method.")?
            }
        };
        let Some(classifier) = classifier_of(&model) else { return Err("This model looks at all rooms together.") };
        let (said_now, said_then) = (classifier.predict(&now.values()), classifier.predict(&then.values()));
        Ok(Tried { room, now, then, said_now, said_then, model })
    }

    /// Sets one feature of the picked room for what-if. A room has at least as many openings as lead to labelled rooms.
    pub(crate) fn try_feature(&mut self, feature: usize, value: f64) {
        let Ok(Tried { room, mut then, .. }) = self.tried() else { return };
        let whole = |value: f64| value.round().clamp(0.0, 1000.0) as u32;
        match feature {
            0 => then.area_m2 = value.clamp(0.1, 1e6),
            1 => then.axes_ratio = value.clamp(1.0, 1e3),
            2 => then.doors = whole(value).max(then.doors_to.iter().sum()),
            label if label < 8 => {
                then.doors_to[label - 3] = whole(value);
                then.doors = then.doors.max(then.doors_to.iter().sum());
            }
            _ => return,
        }
        self.live.what_if.changed = Some((room, then));
    }

    /// The picture of the regions over the two features.
    pub(crate) fn regions(&self, tried: &Tried) -> Option<Arc<Regions>> {
        let labelled = self.document.as_ref()?.labelled()?;
        let axes = self.live.what_if.axes;
        let key = RegionsKey {
            labelled: Same::of(labelled),
            model: tried.model.checksum.clone(),
            room: tried.room,
            then: tried.then,
            axes,
        };
        self.live.regions.or_work_out(key, || regions(labelled, tried, axes).map(Arc::new))
    }
}

fn regions(labelled: &Labelled, tried: &Tried, axes: [usize; 2]) -> Option<Regions> {
    let predictions = labelled.predictions.as_ref()?;
    let classifier = tried.classifier()?;
    let then = tried.then.values();
    let of_rooms: Vec<Values> = predictions.result.features.iter().map(Features::values).collect();
    let scales = axes.map(|axis| {
        let values = of_rooms.iter().map(|values| values[axis]).chain([then[axis]]);
        Scale::over(axis, values)
    });
    let mut cells = Vec::with_capacity(CELLS[0] * CELLS[1]);
    // Numbers of openings give the same values in many cells.
    let mut last: Option<(Values, (Label, f64))> = None;
    for up in 0..CELLS[1] {
        for across in 0..CELLS[0] {
            let mut values = then;
            let place = |cell: usize, of: usize| (cell as f64 + 0.5) / of as f64;
            values[axes[0]] = scales[0].value(place(across, CELLS[0]));
            values[axes[1]] = scales[1].value(place(up, CELLS[1]));
            let said = match &last {
                Some((of, said)) if *of == values => *said,
                _ => classifier.predict(&values).likeliest(),
            };
            last = Some((values, said));
            cells.push(said);
        }
    }
    let rooms = predictions.network.rooms.iter().zip(&of_rooms);
    let rooms =
        rooms.map(|(room, values)| (room.id, axes.map(|axis| values[axis]), classifier.predict(values).label()));
    Some(Regions { scales, cells, rooms: rooms.collect(), tried: axes.map(|axis| then[axis]) })
}

/// The neighbours' labels that a second opinion counts, by their word.
pub(crate) const NEIGHBOURS: [(&str, Option<NeighbourLabels>); 4] = [
    ("trained", None),
    ("true", Some(NeighbourLabels::True)),
    ("temporary", Some(NeighbourLabels::Temporary)),
    ("predicted", Some(NeighbourLabels::Predicted)),
];
