//! What drives beside the frames: a simulated robot or a log, step by step, and what is shown after each.

use std::sync::Arc;

use super::compared::Compared;
use super::vehicle::Vehicle;
use crate::app::paint::robot::{FanSeen, Filled, FrontierSeen, MapSeen, RoomSeen, RoomsSeen};
use crate::base::work::{Cancelled, Work};
use crate::classify::models::Models;
use crate::geometry::areas::{self, Shapes};
use crate::geometry::polygon::{self, Location};
use crate::geometry::{Point, Segment};
use crate::plan::{Meta, Plan};
use crate::predict::Predictor;
use crate::predict::explored::{LabelledMap, labelled};
use crate::robot::frontiers::Frontier;
use crate::robot::mapper::View;
use crate::robot::rooms::FoundRooms;
use crate::robot::score::score;
use crate::robot::split_and_merge::SplitOptions;
use crate::robot::{Pose, RayGrid, Scan};

/// The line map is put together again once its looks have grown by this share, the rooms are found again once by
/// that: both take longer as the map grows, and so all of them together stay in proportion to it.
const LINES_AFTER: f64 = 0.025;
const ROOMS_AFTER: f64 = 0.06;

/// A label moves only to a place that is so much further from the walls.
const STAYS: f64 = 0.7;

/// What is shown after a step.
#[derive(Clone, Debug)]
pub(crate) struct Step {
    /// As estimated, in the plan's frame, as are the others.
    pub pose: Pose,
    /// `None` where only the log knows.
    pub true_pose: Option<Pose>,
    pub odometry: Pose,
    /// How long it took, in the robot's seconds.
    pub secs: f64,
    /// The way driven by then, in metres.
    pub driven_m: f64,
    pub fans: Arc<Vec<FanSeen>>,
    /// The rest of the route.
    pub way: Arc<Vec<Point>>,
    /// The map, where it is another.
    pub map: Option<MapSeen>,
    /// The path as it is now estimated, where closing a loop has moved it.
    pub path: Option<Arc<Vec<Point>>>,
    pub closures: usize,
}

/// What stands at the end, or so far.
#[derive(Clone)]
pub(crate) struct Result {
    pub labelled: Arc<LabelledMap>,
    /// With a true plan, and at the end.
    pub compared: Option<Arc<Compared>>,
}

/// Several steps, and how the drive stands after them.
pub(crate) struct Batch {
    pub steps: Vec<Step>,
    pub is_over: bool,
    pub gave_up: bool,
    /// The rooms found last.
    pub result: Option<Result>,
    /// How much of a log is done.
    pub progress: Option<(usize, usize)>,
    /// Why the rooms found make no plan.
    pub trouble: Option<String>,
}

/// The true plan that a drive is compared with, and where the robot started.
pub(super) struct Truth {
    pub plan: Plan,
    pub world: Arc<crate::robot::World>,
    pub start: Point,
    /// Half the robot's width and its clearance, in metres.
    pub reach_m: f64,
}

/// A drive: what drives, and what is known of it for the eye.
pub(crate) struct Drive {
    vehicle: Box<dyn Vehicle>,
    world_from_map: Pose,
    meta: Meta,
    predictor: Predictor,
    models: Models,
    seed: u64,
    truth: Option<Truth>,
    driven_m: f64,
    looks: usize,
    lines_at: usize,
    rooms_at: usize,
    closures: usize,
    map: MapSeen,
    behind: Vec<(Point, (crate::labels::Label, f64))>,
    result: Option<Result>,
    is_begun: bool,
    is_ended: bool,
    trouble: Option<String>,
}

impl Drive {
    pub(super) fn new(
        vehicle: Box<dyn Vehicle>,
        world_from_map: Pose,
        meta: Meta,
        (predictor, models): (Predictor, Models),
        seed: u64,
        truth: Option<Truth>,
    ) -> Self {
        Self {
            vehicle,
            world_from_map,
            meta,
            predictor,
            models,
            seed,
            truth,
            driven_m: 0.0,
            looks: 0,
            lines_at: 0,
            rooms_at: 0,
            closures: 0,
            map: MapSeen::default(),
            behind: Vec::new(),
            result: None,
            is_begun: false,
            is_ended: false,
            trouble: None,
        }
    }

    /// Up to so many steps, or until so many metres have been driven in all.
    ///
    /// # Errors
    /// When cancelled.
    pub(crate) fn batch(
        &mut self,
        most: usize,
        until_m: Option<f64>,
        work: &Work<'_>,
    ) -> std::result::Result<Batch, Cancelled> {
        let mut steps = Vec::new();
        if !self.is_begun {
            self.is_begun = true;
            // A simulated robot has looked around where it starts; a log has not begun.
            if !self.vehicle.scans().is_empty() {
                steps.push(self.shown(0.0, true));
            }
        }
        while steps.len() < most && !self.is_ended {
            work.goes_on()?;
            if until_m.is_some_and(|until_m| self.driven_m >= until_m) && !steps.is_empty() {
                break;
            }
            let before = self.vehicle.pose().position();
            let Some(secs) = self.vehicle.step() else {
                self.is_ended = true;
                break;
            };
            self.driven_m += before.distance(self.vehicle.pose().position());
            let is_over = self.vehicle.is_over();
            steps.push(self.shown(secs, self.vehicle.has_new_look() || is_over));
            self.is_ended = is_over;
        }
        Ok(Batch {
            steps,
            is_over: self.is_ended,
            gave_up: self.vehicle.gave_up(),
            result: self.result.clone(),
            progress: self.vehicle.progress(),
            trouble: self.trouble.clone(),
        })
    }

    /// What is shown now.
    fn shown(&mut self, secs: f64, has_new_look: bool) -> Step {
        let place = |point: &Point| self.world_from_map.apply(*point);
        let closures = self.vehicle.closures();
        let path = (closures != self.closures || self.vehicle.is_over())
            .then(|| Arc::new(self.vehicle.poses().iter().map(|pose| place(&pose.position())).collect()));
        self.closures = closures;
        let way = Arc::new(self.vehicle.way().iter().map(place).collect());
        if has_new_look {
            self.look();
        }
        Step {
            pose: self.world_from_map.compose(self.vehicle.pose()),
            true_pose: self.vehicle.true_pose(),
            odometry: self.world_from_map.compose(self.vehicle.odometry()),
            secs,
            driven_m: self.driven_m,
            fans: Arc::new(fans(self.vehicle.scans(), self.world_from_map.compose(self.vehicle.pose()))),
            way,
            map: has_new_look.then(|| self.map.clone()),
            path,
            closures,
        }
    }

    /// Takes in what is new.
    fn look(&mut self) {
        self.looks += 1;
        let is_over = self.vehicle.is_over();
        let is_due = |at: usize, share: f64| is_over || (self.looks - at) as f64 >= 1.0 + share * self.looks as f64;
        let (lines_due, rooms_due) = (is_due(self.lines_at, LINES_AFTER), is_due(self.rooms_at, ROOMS_AFTER));
        let seen = rooms_due.then(|| self.vehicle.surroundings(self.seed));
        // On the way what the vehicle knows at once, at the end what the rooms were found in.
        let last = seen.as_ref().filter(|_| is_over);
        let free = last.map_or_else(|| self.vehicle.free(), |seen| seen.free.shapes());
        self.map.free = Arc::new(Filled::parts(free, self.world_from_map));
        self.map.known_m2 = areas::area_m2(free);
        let frontiers = last.map_or_else(|| self.vehicle.frontiers(), |seen| seen.frontiers.clone());
        if lines_due || rooms_due {
            self.lines_at = self.looks;
            let segments = last.map_or_else(|| self.vehicle.segments(), |seen| seen.segments.clone());
            self.map.lines = Arc::new(segments.iter().map(|&segment| self.placed(segment)).collect());
            self.map.fresh = Arc::default();
            if let Some(seen) = &seen {
                self.rooms_at = self.looks;
                self.find(&seen.found, &segments, &frontiers, is_over);
            }
        } else {
            let view = View::of(self.vehicle.scans(), &SplitOptions::default());
            let pose = self.world_from_map.compose(self.vehicle.pose());
            let seen = view.segments.iter().map(|line| line.moved(pose).segment());
            self.map.fresh = Arc::new(self.map.fresh.iter().copied().chain(seen).collect());
        }
        self.map.frontiers = Arc::new(frontiers.iter().map(|frontier| self.frontier(frontier)).collect());
    }

    fn placed(&self, segment: Segment) -> Segment {
        Segment::new(self.world_from_map.apply(segment.a), self.world_from_map.apply(segment.b))
    }

    /// A frontier with what was predicted for it when rooms were last found.
    fn frontier(&self, frontier: &Frontier) -> FrontierSeen {
        /// One whose middle has moved further, in metres, is another.
        const SAME_M: f64 = 0.8;
        let near = self.behind.iter().map(|(middle, said)| (middle.distance(frontier.middle), said));
        let said = near.filter(|(distance_m, _)| *distance_m < SAME_M).min_by(|p, q| p.0.total_cmp(&q.0));
        FrontierSeen {
            line: frontier.line.iter().map(|&point| self.world_from_map.apply(point)).collect(),
            middle: self.world_from_map.apply(frontier.middle),
            outward: self.world_from_map.rotate(frontier.outward),
            length_m: frontier.length_m,
            behind: said.map(|(_, said)| *said),
        }
    }

    /// Labels the rooms found, and compares them with the true plan at the end.
    fn find(&mut self, found: &FoundRooms, segments: &[Segment], frontiers: &[Frontier], is_over: bool) {
        let label = |predictor: &Predictor, models: &Models| {
            labelled(found, frontiers, self.world_from_map, self.meta.clone(), predictor, models)
        };
        // A method without a model for this kind of building is no reason to stop: the usual one has all.
        let made = label(&self.predictor, &self.models)
            .or_else(|_| label(&Predictor::default(), &Models::bundled()))
            .map_err(|error| error.to_string());
        let labels = made.as_ref().map(|made| made.labels.clone()).unwrap_or_default();
        self.map.rooms = Arc::new(self.rooms_seen(found, &labels, segments));
        match made {
            Ok(made) => {
                let said = frontiers.iter().zip(&made.behind);
                self.behind = said.filter_map(|(frontier, said)| Some((frontier.middle, (*said)?))).collect();
                let compared = self.truth.as_ref().filter(|_| is_over).map(|truth| {
                    let areas: Vec<Shapes> =
                        found.rooms.iter().map(|room| moved(&room.shapes(), self.world_from_map)).collect();
                    let edges: Vec<(usize, usize)> =
                        found.sides.iter().filter_map(|sides| Some((sides[0]?, sides[1]?))).collect();
                    let score = score(&truth.world, truth.start, truth.reach_m, &areas, &edges);
                    Arc::new(Compared::new(&truth.plan, &score, &self.map.rooms))
                });
                self.result = Some(Result { labelled: Arc::new(made), compared });
                self.trouble = None;
            }
            Err(error) => self.trouble = Some(error),
        }
    }

    fn rooms_seen(
        &self,
        found: &FoundRooms,
        labels: &[Option<crate::labels::Label>],
        segments: &[Segment],
    ) -> RoomsSeen {
        let place = |point: Point| self.world_from_map.apply(point);
        let ring = |ring: &[Point]| -> Vec<Point> { ring.iter().map(|&point| place(point)).collect() };
        let before: Vec<Point> = self.map.rooms.rooms.iter().map(|room| room.at).collect();
        let mut room_of: Vec<Option<usize>> = vec![None; found.points.len()];
        let mut rooms = Vec::new();
        for (index, room) in found.rooms.iter().enumerate() {
            for &point in &room.points {
                room_of[point] = Some(index);
            }
            let (outer, holes) = (ring(&room.outer), room.holes.iter().map(|hole| ring(hole)).collect::<Vec<_>>());
            let points = room.points.iter().filter_map(|&point| found.points.get(point)).map(|&point| place(point));
            let at = label_place(&outer, &holes, points, &before);
            rooms.push(RoomSeen {
                floor: Filled::new(outer, holes),
                label: labels.get(index).copied().flatten(),
                area_m2: room.area_m2,
                at,
            });
        }
        let doorways: Vec<Segment> = found.doorways.iter().map(|doorway| self.placed(doorway.segment)).collect();
        let lines = segments.iter().map(|&segment| self.placed(segment));
        let walls = RayGrid::new(lines.chain(doorways.iter().copied()).collect());
        let sight = |pair: &[usize; 2]| {
            let [a, b] = pair.map(|point| found.points.get(point).copied());
            Some(Segment::new(place(a?), place(b?)))
        };
        RoomsSeen {
            rooms,
            doorways,
            points: found.points.iter().map(|&point| place(point)).zip(room_of).collect(),
            sights: found.sights.iter().filter_map(sight).collect(),
            walls: Some(walls),
        }
    }
}

/// An area moved by a pose.
fn moved(shapes: &Shapes, pose: Pose) -> Shapes {
    let ring = |ring: &areas::Ring| -> areas::Ring {
        let points = areas::points(ring).into_iter().map(|point| pose.apply(point));
        points.map(|point| [point.x, point.y]).collect()
    };
    shapes.iter().map(|shape| shape.iter().map(ring).collect()).collect()
}

/// The point furthest from a room's walls, of those in it; one from before that is nearly as good stays.
fn label_place(outer: &[Point], holes: &[Vec<Point>], points: impl Iterator<Item = Point>, before: &[Point]) -> Point {
    let clear_m = |point: Point| {
        let rings = std::iter::once(outer).chain(holes.iter().map(Vec::as_slice));
        let edges = rings.flat_map(|ring| polygon::edges(ring).collect::<Vec<_>>());
        edges.map(|edge| edge.distance(point)).fold(f64::INFINITY, f64::min)
    };
    let is_inside = |point: Point| polygon::locate(outer, holes, point) == Location::Inside;
    let middle = Some(polygon::centroid(outer)).filter(|&point| is_inside(point));
    let own = points.filter(|&point| is_inside(point)).chain(middle).map(|point| (clear_m(point), point));
    let Some((best_m, best)) = own.max_by(|p, q| p.0.total_cmp(&q.0)) else { return polygon::centroid(outer) };
    let stays = before.iter().copied().find(|&point| is_inside(point) && clear_m(point) >= STAYS * best_m);
    stays.unwrap_or(best)
}

/// Where the beams of each scanner ended.
fn fans(scans: &[Scan], world_from_robot: Pose) -> Vec<FanSeen> {
    let fan = |scan: &Scan| {
        let world_from_scanner = world_from_robot.compose(scan.robot_from_scanner);
        let ends = (0..scan.ranges_m.len()).map(|beam| scan.point(beam).map(|point| world_from_scanner.apply(point)));
        FanSeen { ends: ends.collect() }
    };
    scans.iter().map(fan).collect()
}
