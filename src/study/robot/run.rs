//! One run: a robot explores a plan, and what it found is compared with the truth.

use std::collections::BTreeMap;
use std::sync::Arc;

use serde::{Deserialize, Serialize};
use serde_json::Value;
use sha2::{Digest as _, Sha256};

use super::RobotCondition;
use crate::base::work::{Cancelled, Work};
use crate::dataset::RoomNetwork;
use crate::features::{NeighbourLabels, analyse, temporary};
use crate::formats::plan_json;
use crate::geometry::areas::{self, Shapes};
use crate::geometry::trim_m;
use crate::labels::Schemes;
use crate::plan::{Meta, Plan};
use crate::robot::explore::{Activity, Exploration};
use crate::robot::explored_plan::{Said, plan as plan_of};
use crate::robot::rooms::RoomOptions;
use crate::robot::score::score;
use crate::robot::{Pose, World};

/// Steps after which a run counts as not ended: a school of 60 rooms takes about 5,000.
const MOST_STEPS: usize = 20_000;

/// The form of a stored record. In the first, `found_rooms` counted rooms out of reach too.
const VERSION: u32 = 2;

/// What came of a run; it can be stored, and is the same for the same plan, condition, seed and program.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    version: u32,
    /// [`run_key`] of the run.
    pub key: String,
    /// `None`: no room has space for the robot, or what it found made no plan.
    pub explored: Option<Explored>,
}

/// What a robot found, and how that compares with the truth.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Explored {
    /// Whether the exploration ended by itself.
    pub ended: bool,
    pub steps: usize,
    pub driven_m: f64,
    pub collisions: usize,
    /// Mean distance of the estimated from the true positions at the end, in metres.
    pub path_error_m: f64,
    /// The true rooms that the robot could reach.
    pub rooms: Vec<TrueRoom>,
    /// Number of true rooms out of its reach.
    pub unreachable: usize,
    /// Number of rooms it found, right or wrong, without those out of its reach that it saw through a door.
    pub found_rooms: usize,
    pub true_edges: usize,
    pub right_edges: usize,
    pub wrong_edges: usize,
    /// `a` in m² of each room it found, by the id in its plan.
    areas_m2: BTreeMap<String, f64>,
    /// Its plan, in the form of a plan file.
    plan: Value,
}

/// A true room, and what became of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TrueRoom {
    /// Its id in the true plan.
    pub id: String,
    /// The room of the robot's plan that covers the most of it, by id.
    pub best: Option<String>,
    /// Intersection over union with that, 0..=1.
    pub iou: f64,
    /// [`crate::robot::score::Fate::name`].
    pub fate: String,
}

impl TrueRoom {
    /// Whether the robot found it.
    pub fn is_found(&self) -> bool {
        self.fate == crate::robot::score::Fate::Found.name()
    }
}

/// What tells a run from all others: a hash of the program's version, the plan's bytes, the condition and the seed.
pub fn run_key(program: &str, plan: &Plan, condition: &RobotCondition, seed: u64) -> String {
    let mut hash = Sha256::new();
    let RobotCondition { sensor_noise, odometry_noise, furniture } = condition;
    hash.update(format!("{program}\n{VERSION}\n{sensor_noise} {odometry_noise} {furniture} {seed}\n"));
    hash.update(plan_json::to_bytes(plan));
    hash.finalize().iter().take(16).fold(String::new(), |text, byte| text + &format!("{byte:02x}"))
}

impl Record {
    /// Reads a stored record; `None` if the bytes are no record of the run with this key: cut off, say, when a
    /// study was killed.
    pub fn from_bytes(bytes: &[u8], key: &str) -> Option<Self> {
        let record: Self = serde_json::from_slice(bytes).ok()?;
        let is_sound = record.version == VERSION
            && record.key == key
            && record.explored.as_ref().is_none_or(|explored| explored.network(&Schemes::bundled()).is_some());
        is_sound.then_some(record)
    }

    /// The bytes to store.
    ///
    /// # Errors
    /// For lack of memory only.
    pub fn to_bytes(&self) -> Result<Vec<u8>, serde_json::Error> {
        let mut bytes = serde_json::to_vec(self)?;
        bytes.push(b'\n');
        Ok(bytes)
    }
}

/// Lets a robot explore a plan.
///
/// # Errors
/// When the work is cancelled.
pub fn explore(
    key: String,
    truth: &Plan,
    condition: &RobotCondition,
    seed: u64,
    work: &Work<'_>,
) -> Result<Record, Cancelled> {
    let record = |explored: Option<Explored>| Record { version: VERSION, key, explored };
    let world = Arc::new(World::new(truth, &condition.world_options(seed)));
    let robot = condition.robot_options(seed);
    let reach_m = robot.radius_m + robot.margin_m;
    let Some(start) = world.start(reach_m, seed) else { return Ok(record(None)) };
    let mut exploration = Exploration::new(world.clone(), Pose::new(start.x, start.y, 0.0), robot);
    while !exploration.is_over() && exploration.path.len() < MOST_STEPS {
        exploration.step();
        if exploration.has_new_look() {
            work.goes_on()?;
        }
    }
    let found = exploration.rooms(&RoomOptions { seed, ..RoomOptions::default() });
    let of = truth.meta();
    // The robot knows what kind of building it is in, as in the paper, and nothing else of the plan.
    let meta = Meta { name: of.name.clone(), typology: of.typology.clone(), ..Meta::default() };
    let Ok(explored) = plan_of(&found, &[], exploration.world_from_map, meta, &Said::default()) else {
        return Ok(record(None));
    };
    let areas: Vec<Shapes> = found.rooms.iter().map(|room| moved(&room.shapes(), exploration.world_from_map)).collect();
    let edges: Vec<(usize, usize)> = found.sides.iter().filter_map(|sides| Some((sides[0]?, sides[1]?))).collect();
    let score = score(&world, start, reach_m, &areas, &edges);
    let id = |index: usize| explored.rooms.get(index).map(ToString::to_string);
    let rooms = score.rooms.iter().map(|room| TrueRoom {
        id: room.id.to_string(),
        best: room.best.and_then(id),
        iou: (1e4 * room.iou).round() / 1e4,
        fate: room.fate.name().to_owned(),
    });
    let at = |pose: &Pose| exploration.world_from_map.apply(pose.position());
    let off_m = exploration
        .path
        .iter()
        .zip(exploration.poses())
        .map(|(step, estimate)| step.true_pose.position().distance(at(&estimate)));
    let driven =
        exploration.path.windows(2).map(|pair| pair[0].true_pose.position().distance(pair[1].true_pose.position()));
    let plan = serde_json::from_slice(&plan_json::to_bytes(&explored.plan)).unwrap_or_default();
    Ok(record(Some(Explored {
        ended: exploration.activity == Activity::Finished,
        steps: exploration.path.len(),
        driven_m: trim_m(driven.sum()),
        collisions: exploration.collisions(),
        path_error_m: trim_m(crate::base::numbers::mean(off_m).unwrap_or_default()),
        rooms: rooms.collect(),
        unreachable: score.unreachable.len(),
        found_rooms: score.counted_rooms(),
        true_edges: score.true_edges.len(),
        right_edges: score.right_edges.len(),
        wrong_edges: score.wrong_edges,
        areas_m2: explored.rooms.iter().zip(&found.rooms).map(|(id, room)| (id.to_string(), room.area_m2)).collect(),
        plan,
    })))
}

fn moved(shapes: &Shapes, by: Pose) -> Shapes {
    let ring = |ring: &areas::Ring| -> areas::Ring {
        areas::points(ring).into_iter().map(|point| by.apply(point)).map(|point| [point.x, point.y]).collect()
    };
    shapes.iter().map(|shape| shape.iter().map(ring).collect()).collect()
}

impl Explored {
    /// The rooms as classifiers see them: `a` is the mean of the two quadrilaterals that the paper takes for a
    /// robot's rooms, and the temporary labels are those of it. `None` if the stored plan cannot be read.
    pub fn network(&self, schemes: &Schemes) -> Option<RoomNetwork> {
        let plan = plan_json::from_bytes(&serde_json::to_vec(&self.plan).ok()?).ok()?;
        let mut network = RoomNetwork::of(&plan, &analyse(&plan, schemes, NeighbourLabels::True));
        let rules = schemes.temporary_rules(plan.meta().typology.as_ref());
        for room in &mut network.rooms {
            room.area_m2 = *self.areas_m2.get(&room.id.to_string())?;
            room.temporary = temporary::classify(rules, room.area_m2, room.axes_ratio, room.doors.len() as u32);
        }
        Some(network)
    }
}
