use std::collections::BTreeMap;
use std::sync::{Arc, OnceLock};

use super::{Features, NeighbourLabels};
use crate::features::temporary;
use crate::geometry::runs::{self, Axes};
use crate::labels::{Colour, Label, Meaning, Schemes};
use crate::plan::{Joint, Plan, Room, RoomId};
use crate::topology::wall_bodies::WallBodies;
use crate::topology::{Graph, NetRoom, RoomShape, RoomShapes, net_rooms_between};

/// The status of a room's label.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RoomStatus {
    /// By the room's own label, or by the scheme's for its function.
    Labelled(Label),
    /// The scheme leaves its function blank (a balcony, a shaft): counts as the outside.
    NotClassified,
    /// It has no function, or one the scheme does not know; such functions are reported.
    Unlabelled,
}

impl RoomStatus {
    /// The status of a room under the schemes and the plan's typology. The room's own label comes first;
    /// a prediction that nobody has accepted does not count.
    pub fn of(plan: &Plan, schemes: &Schemes, room: &Room) -> Self {
        Self::given(room).unwrap_or_else(|| Self::by_scheme(plan, schemes, &room.function))
    }

    /// By the room's own label.
    fn given(room: &Room) -> Option<Self> {
        room.given_label().map(|given| Self::Labelled(given.label))
    }

    /// By the scheme.
    fn by_scheme(plan: &Plan, schemes: &Schemes, function: &str) -> Self {
        match schemes.meaning(plan.meta().typology.as_ref(), function) {
            Some(Meaning::Labelled(label)) => Self::Labelled(label),
            Some(Meaning::NotClassified) => Self::NotClassified,
            None => Self::Unlabelled,
        }
    }

    pub const fn label(self) -> Option<Label> {
        match self {
            Self::Labelled(label) => Some(label),
            Self::NotClassified | Self::Unlabelled => None,
        }
    }
}

/// The analysis of one room.
#[derive(Clone, Debug)]
pub struct RoomAnalysis {
    pub id: RoomId,
    pub status: RoomStatus,
    /// The major and minor axes; `None` if the room encloses no area.
    pub axes: Option<Axes>,
    /// `F_r`; `None` if the room encloses no area.
    pub features: Option<Features>,
    /// The naive classifier's label from `<a, rt, d>`; `None` for a room without features or one that is
    /// not classified.
    pub temporary: Option<Label>,
}

/// The analysis of a plan: shapes, graph, and each room's features. A pure function of the plan, the
/// schemes and the choice of neighbours' labels.
#[derive(Debug)]
pub struct Analysis {
    pub shapes: Arc<RoomShapes>,
    pub graph: Arc<Graph>,
    /// In the order of [`RoomShapes::all`], that is by room id.
    pub rooms: Vec<RoomAnalysis>,
    /// The colours that the scheme gives functions; nothing that is computed depends on them.
    pub colours: BTreeMap<String, Colour>,
    /// The plan analysed: clones share all structure.
    plan: Plan,
    net: OnceLock<Vec<Option<NetRoom>>>,
    bodies: OnceLock<WallBodies>,
}

impl Analysis {
    /// The analysis of one room.
    pub fn room(&self, id: RoomId) -> Option<&RoomAnalysis> {
        self.shapes.index_of(id).map(|index| &self.rooms[index])
    }

    /// The bodies of the walls of the plan, which must be the one analysed.
    pub fn wall_bodies(&self, plan: &Plan) -> &WallBodies {
        self.bodies.get_or_init(|| WallBodies::new(plan))
    }

    /// The clear part of each room, in the order of [`RoomShapes::all`]; `None` for a room that encloses no area. No feature
    /// and no label depends on it; computed when first asked for.
    pub fn net_rooms(&self) -> &[Option<NetRoom>] {
        self.net.get_or_init(|| match self.shapes.all() {
            [] => Vec::new(),
            _ => net_rooms_between(self.wall_bodies(&self.plan), &self.shapes),
        })
    }

    /// The clear part of one room.
    pub fn net(&self, id: RoomId) -> Option<&NetRoom> {
        self.net_rooms().get(self.shapes.index_of(id)?)?.as_ref()
    }

    /// The plan analysed.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// For each opening of a room, what is on its other side.
    pub fn neighbours(&self, id: RoomId) -> impl Iterator<Item = (crate::plan::OpeningId, Joint)> + '_ {
        let index = self.shapes.index_of(id).unwrap_or(usize::MAX);
        self.graph.of_room(index).map(move |connection| (connection.opening, other_side(connection.sides, id)))
    }
}

/// The side of a connection that is not `id`; `id` itself if both are.
fn other_side(sides: [Joint; 2], id: RoomId) -> Joint {
    if sides[0] == Joint::Room(id) { sides[1] } else { sides[0] }
}

/// Analyses a plan.
pub fn analyse(plan: &Plan, schemes: &Schemes, neighbours: NeighbourLabels) -> Analysis {
    analyse_after(plan, schemes, neighbours, None)
}

/// Analyses a plan after an edit: what the edit left as it was is taken from the analysis before it. The result does not
/// depend on it.
pub fn analyse_after(
    plan: &Plan,
    schemes: &Schemes,
    neighbours: NeighbourLabels,
    before: Option<&Analysis>,
) -> Analysis {
    let (shapes, graph) = match before {
        None => {
            let shapes = RoomShapes::new(plan);
            let graph = Graph::new(plan, &shapes);
            (Arc::new(shapes), Arc::new(graph))
        }
        Some(before) => {
            let shapes = RoomShapes::after(plan, &before.plan, &before.shapes);
            let graph = Graph::after(plan, &shapes, &before.plan, &before.shapes, &before.graph);
            (shapes, graph)
        }
    };
    let mut known = before.map(|before| before.shapes.all().iter().zip(&before.rooms).peekable());
    let mut axes_before = |shape: &RoomShape| {
        let known = known.as_mut()?;
        // Both are sorted by id.
        while known.next_if(|(earlier, _)| earlier.id < shape.id).is_some() {}
        known.next_if(|(earlier, _)| *earlier == shape).map(|(_, room)| room.axes)
    };
    // A function means the same in every room.
    let mut by_function: BTreeMap<&str, RoomStatus> = BTreeMap::new();
    let rules = schemes.temporary_rules(plan.meta().typology.as_ref());
    let mut rooms: Vec<RoomAnalysis> = plan
        .rooms()
        .enumerate()
        .map(|(index, (id, room))| {
            let shape = &shapes.all()[index];
            let status = RoomStatus::given(room).unwrap_or_else(|| {
                let by_scheme = || RoomStatus::by_scheme(plan, schemes, &room.function);
                *by_function.entry(room.function.as_str()).or_insert_with(by_scheme)
            });
            let axes = axes_before(shape).unwrap_or_else(|| runs::axes(&shape.outer, &shape.holes));
            let area_m2 = shape.area_m2();
            let features = axes.filter(|_| area_m2 > 0.0).map(|axes| Features {
                area_m2,
                axes_ratio: axes.ratio(),
                doors: graph.of_room(index).len() as u32,
                doors_to: [0; 5],
            });
            let temporary = features
                .filter(|_| status != RoomStatus::NotClassified)
                .map(|features| temporary::classify(rules, features.area_m2, features.axes_ratio, features.doors));
            RoomAnalysis { id, status, axes, features, temporary }
        })
        .collect();
    let seen: Vec<Option<Label>> = rooms
        .iter()
        .map(|room| match neighbours {
            NeighbourLabels::True | NeighbourLabels::Predicted => room.status.label().or(room.temporary),
            NeighbourLabels::Temporary => room.temporary,
        })
        .collect();
    for (index, room) in rooms.iter_mut().enumerate() {
        let Some(features) = &mut room.features else { continue };
        for (_, other) in graph.doors_of(index) {
            // An opening from a room to itself leads nowhere new: it counts only in d.
            if let Some(label) = other.and_then(|other| seen[other]) {
                features.doors_to[label.index()] += 1;
            }
        }
    }
    let colours = schemes.colours(plan.meta().typology.as_ref());
    Analysis { shapes, graph, rooms, colours, plan: plan.clone(), net: OnceLock::new(), bodies: OnceLock::new() }
}
