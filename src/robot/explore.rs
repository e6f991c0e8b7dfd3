//! Frontier-based exploration (Yamauchi 1997): drive to where the known floor ends, look, and repeat
//! until nothing reachable is unknown. Runs in small steps; the state can be inspected after each.

use std::sync::Arc;

use super::bridges::without_bridges;
use super::doorways::walls;
use super::free_space::FreeSpace;
use super::frontiers::{Frontier, frontiers};
use super::odometry::OdometryNoise;
use super::rooms::{FoundRooms, RoomOptions, boundary, find_rooms};
use super::route::Routes;
use super::scanner::{Scanner, back_to_back};
use super::split_and_merge::SplitOptions;
use super::{Mapper, MapperOptions, Pose, RayGrid, Scan, World};
use crate::base::random::{Random, seed_of_part};
use crate::geometry::{Point, Segment};

/// The robot and its exploration parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct RobotOptions {
    /// Half its width, in metres: it is assumed to be round.
    pub radius_m: f64,
    /// It passes doorways that leave this much clearance on both sides, in metres.
    pub margin_m: f64,
    /// Maximum distance between two scans, in metres.
    pub step_m: f64,
    /// Maximum turn between two scans.
    pub turn_rad: f64,
    pub scanners: Vec<Scanner>,
    pub odometry: OdometryNoise,
    pub seed: u64,
}

impl Default for RobotOptions {
    /// A Pioneer 3-AT with two SICK LMS 200 back to back (paper, section 3.3).
    ///
    /// It is 0.508 m long and 0.497 m wide (Adept MobileRobots, Pioneer 3-AT data sheet, 2011): half of
    /// that is 0.25 m; with 0.05 m on each side it passes doorways of 0.6 m. At its usual 0.4 m/s and two
    /// scans a second it scans every 0.2 m, and turns by at most 20 degrees between scans.
    fn default() -> Self {
        Self {
            radius_m: 0.25,
            margin_m: 0.05,
            step_m: 0.2,
            turn_rad: 20.0_f64.to_radians(),
            scanners: back_to_back(Scanner::lms200).to_vec(),
            odometry: OdometryNoise::default(),
            seed: 1,
        }
    }
}

impl RobotOptions {
    /// The same with error-free scanners and odometry.
    #[must_use]
    pub fn exact(self) -> Self {
        let scanners = self.scanners.into_iter().map(Scanner::exact).collect();
        Self { scanners, odometry: OdometryNoise::NONE, ..self }
    }
}

/// Scans are added to the free space after driving this many metres, or turning this far.
const LOOK_M: f64 = 0.4;
const LOOK_RAD: f64 = 0.8;

/// A frontier is viewed from within this many metres; if no such place can be reached, from further away:
/// through a doorway, say, beyond which only a wedge is known.
const VIEWS_M: [f64; 3] = [1.2, 3.0, 6.0];

/// Spacing of candidate viewpoints, in metres.
const VIEW_SPACING_M: f64 = 0.15;

/// The cost of a metre of distance from a frontier, in metres of route; higher on the second try, so that
/// the robot gets as close as it can.
const PER_METRE: [f64; 2] = [1.0, 8.0];

/// A long frontier is worth a detour of this many metres of route per metre of its length.
const PER_FRONTIER_METRE: f64 = 0.5;

/// The longest frontier length that counts, in metres.
const LONGEST_WORTH_M: f64 = 3.0;

/// Frontiers whose middles are closer than this, in metres, count as the same.
const SAME_M: f64 = 0.5;

/// A frontier is abandoned after this many visits; one that revealed nothing new counts twice.
const VISITS: usize = 6;

/// A visit revealed something if the known floor grew by this many m².
const NEWS_M2: f64 = 0.3;

/// Each view of the same frontier must be from a different place, at least this far away in metres.
const OTHER_PLACE_M: f64 = 0.3;

/// A goal is abandoned after this many collisions on the way.
const BUMPS: usize = 3;

/// A waypoint counts as reached within this distance in metres: no corner is cut by more.
const AT_PLACE_M: f64 = 0.06;

/// The free space is rebuilt when a place has moved by this much, in metres, counting a turn as the
/// movement it causes at the distance of a room's wall.
const MOVED_M: f64 = 0.05;
const LEVER_M: f64 = 3.0;

/// How far the robot backs off after a collision, in metres.
const BACK_OFF_M: f64 = 0.15;

/// Step limit of an exploration; reaching it is reported. A school of 60 rooms takes about 5,000.
const STEPS_LIMIT: usize = 100_000;

/// The robot's current activity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Activity {
    /// Choosing a frontier.
    Choosing,
    /// Driving to a frontier.
    Driving,
    /// Backing off after a collision.
    BackingOff,
    /// Nothing reachable is unknown.
    Finished,
    /// It gave up at the step limit.
    GaveUp,
}

/// The robot's destination.
#[derive(Clone, Debug, PartialEq)]
pub struct Goal {
    /// The viewpoint.
    pub place: Point,
    /// The frontier to look at.
    pub frontier: Frontier,
    /// The remaining route.
    pub way: Vec<Point>,
    bumps: usize,
    /// The area of known floor when it was chosen, in m².
    known_m2: f64,
}

/// What was seen from one place.
#[derive(Clone, Debug)]
struct Look {
    /// Index of the step.
    step: usize,
    /// The pose used for it in the free space.
    pose: Pose,
    scans: Vec<Scan>,
}

/// A frontier that was still there after a visit.
#[derive(Clone, Debug)]
struct Visited {
    middle: Point,
    visits: usize,
    places: Vec<Point>,
}

/// An exploration in progress. The map's frame is that of the robot's first pose.
pub struct Exploration {
    world: Arc<World>,
    options: RobotOptions,
    random: Random,
    /// The robot's start in the world's frame.
    pub world_from_map: Pose,
    /// The robot's true pose, in the world's frame.
    pub true_pose: Pose,
    /// The pose from odometry alone, in the map's frame.
    pub odometry: Pose,
    /// The estimated pose, in the map's frame.
    pub pose: Pose,
    /// The last scans.
    pub scans: Vec<Scan>,
    mapper: Mapper,
    /// The views that make up the free space.
    looks: Vec<Look>,
    closures: usize,
    pub free: FreeSpace,
    pub goal: Option<Goal>,
    pub activity: Activity,
    /// All poses so far: true ones in the world's frame, estimates and odometry in the map's.
    pub path: Vec<PathStep>,
    visited: Vec<Visited>,
    looked_at: Pose,
    collisions: usize,
    /// Where the robot touched something, in the map's frame.
    touched: Vec<Point>,
    has_new_look: bool,
}

/// The poses after a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathStep {
    /// In the world's frame.
    pub true_pose: Pose,
    /// In the map's frame.
    pub estimate: Pose,
    /// In the map's frame.
    pub odometry: Pose,
}

/// The number of places on a frontier that are looked for.
const PLACES: usize = 4;

/// If none of them can be seen from anywhere, places this far apart, in metres, and at most so many. A room seen through
/// its door at a glancing angle is a thin wedge: its frontier is long, and only its end at the door can be seen from
/// places within reach.
const PLACES_APART_M: f64 = 0.5;
const MOST_PLACES: usize = 24;

/// Points on the known floor just before a frontier: before the middles of its longest stretches, since its
/// own middle may lie in a corner that is seen from nowhere; if `everywhere`, all along it.
fn places_on(frontier: &Frontier, everywhere: bool) -> Vec<Point> {
    let stretches = frontier.line.windows(2).map(|pair| Segment::new(pair[0], pair[1]));
    let mut stretches: Vec<Segment> = stretches.collect();
    if everywhere {
        let apart_m = PLACES_APART_M.max(frontier.length_m / MOST_PLACES as f64);
        let pieces = |stretch: Segment| {
            let count = (stretch.length() / apart_m).ceil().max(1.0) as usize;
            let at = move |i: usize| stretch.a.lerp(stretch.b, i as f64 / count as f64);
            (0..count).map(move |i| Segment::new(at(i), at(i + 1)))
        };
        stretches = stretches.into_iter().flat_map(pieces).collect();
    }
    // The sort is stable: of equal ones the first.
    stretches.sort_by(|p, q| q.length().total_cmp(&p.length()));
    let inward = |stretch: &Segment| Some(stretch.midpoint() + stretch.vector().left().unit()? * 0.05);
    let most = if everywhere { MOST_PLACES } else { PLACES };
    stretches.iter().take(most).filter_map(inward).collect()
}

impl Exploration {
    /// A robot at its start that has looked around once.
    pub fn new(world: Arc<World>, start: Pose, options: RobotOptions) -> Self {
        let random = Random::new(seed_of_part(options.seed, 7));
        // As its data sheet says.
        let noise_m = options.scanners.iter().map(|scanner| scanner.noise_m).fold(0.0, f64::max);
        let mapper = MapperOptions { split: SplitOptions::for_noise(noise_m), ..MapperOptions::default() };
        let mut exploration = Self {
            world,
            options,
            random,
            world_from_map: start,
            true_pose: start,
            odometry: Pose::IDENTITY,
            pose: Pose::IDENTITY,
            scans: Vec::new(),
            mapper: Mapper::new(mapper),
            looks: Vec::new(),
            closures: 0,
            free: FreeSpace::for_noise(noise_m),
            goal: None,
            activity: Activity::Choosing,
            path: Vec::new(),
            visited: Vec::new(),
            looked_at: Pose::IDENTITY,
            collisions: 0,
            touched: Vec::new(),
            has_new_look: false,
        };
        exploration.sense();
        exploration.look();
        exploration
    }

    /// The world it drives through.
    pub fn world(&self) -> &Arc<World> {
        &self.world
    }

    pub fn options(&self) -> &RobotOptions {
        &self.options
    }

    /// Whether the exploration has ended.
    pub fn is_over(&self) -> bool {
        matches!(self.activity, Activity::Finished | Activity::GaveUp)
    }

    /// The number of collisions.
    pub fn collisions(&self) -> usize {
        self.collisions
    }

    /// The number of places recognised so far.
    pub fn closures(&self) -> usize {
        self.closures
    }

    /// Whether the last step added to the free space.
    pub fn has_new_look(&self) -> bool {
        self.has_new_look
    }

    /// The current frontiers, including those visited in vain.
    pub fn frontiers(&self) -> Vec<Frontier> {
        frontiers(&self.free)
    }

    /// The segments of the line map so far, in the map's frame.
    pub fn segments(&self) -> Vec<Segment> {
        self.mapper.map().lines().map(|line| line.line.segment()).collect()
    }

    /// The segments without the stretches that bridge doorways.
    pub fn walls(&self) -> Vec<Segment> {
        without_bridges(&self.segments(), &boundary(self.free.shapes()), |at| self.free.is_hit_near(at))
    }

    /// The rooms of the known part, in the map's frame. By the paper's rule alone, lines stay as they are.
    pub fn rooms(&self, options: &RoomOptions) -> FoundRooms {
        let segments = self.segments();
        if !options.doorways.must_widen {
            return find_rooms(&segments, self.free.shapes(), options);
        }
        let found = find_rooms(&self.walls(), self.free.shapes(), options);
        FoundRooms { walls: walls(&segments, &options.doorways), ..found }
    }

    /// The current best estimates of the poses after each step, in the map's frame.
    pub fn poses(&self) -> Vec<Pose> {
        self.mapper.poses()
    }

    /// One small step: a choice, a turn, or a few centimetres of driving and a scan.
    pub fn step(&mut self) -> Activity {
        self.has_new_look = false;
        if self.is_over() {
            return self.activity;
        }
        if self.path.len() >= STEPS_LIMIT {
            self.activity = Activity::GaveUp;
            return self.activity;
        }
        match self.activity {
            Activity::BackingOff => {
                self.drive(Pose::new(-BACK_OFF_M, 0.0, 0.0));
                self.replan();
            }
            _ if self.goal.is_none() => self.choose(),
            _ => self.follow(),
        }
        self.activity
    }

    /// Runs to the end.
    pub fn run(&mut self) -> Activity {
        while !self.is_over() {
            self.step();
        }
        self.activity
    }

    /// The robot radii for which routes are planned, in metres: first with the full margin; if no route
    /// leads anywhere, with a small one. The free space ends a few centimetres before the walls.
    fn planned_radii_m(&self) -> [f64; 2] {
        [self.options.radius_m + self.options.margin_m, self.options.radius_m + 0.2 * self.options.margin_m]
    }

    fn visits(&self, frontier: &Frontier) -> usize {
        let same = self.visited.iter().filter(|visited| visited.middle.distance(frontier.middle) < SAME_M);
        same.map(|visited| visited.visits).max().unwrap_or(0)
    }

    /// Whether a frontier was already viewed from about this place.
    fn was_seen_from(&self, frontier: &Frontier, place: Point) -> bool {
        let same = self.visited.iter().filter(|visited| visited.middle.distance(frontier.middle) < SAME_M);
        same.flat_map(|visited| &visited.places).any(|before| before.distance(place) < OTHER_PLACE_M)
    }

    /// Chooses the cheapest frontier, or finishes.
    fn choose(&mut self) {
        self.goal = self.next_goal();
        self.activity = if self.goal.is_some() { Activity::Driving } else { Activity::Finished };
        if self.goal.is_none() {
            self.mapper.finish();
            self.settle();
        }
    }

    /// The cheapest view of a frontier that has not been given up.
    fn next_goal(&self) -> Option<Goal> {
        let open: Vec<(Frontier, usize)> = self
            .frontiers()
            .into_iter()
            .map(|frontier| {
                let visits = self.visits(&frontier);
                (frontier, visits)
            })
            .filter(|(_, visits)| *visits < VISITS)
            .collect();
        if open.is_empty() {
            return None;
        }
        let mut routes = Routes::around(self.free.shapes(), self.pose.position(), &self.touched);
        let boundary = boundary(self.free.shapes());
        let radii_m = self.planned_radii_m();
        [false, true].into_iter().find_map(|everywhere| {
            VIEWS_M.into_iter().flat_map(|view_m| radii_m.map(|radius_m| (view_m, radius_m))).find_map(
                |(view_m, radius_m)| self.cheapest(&open, everywhere, &mut routes, &boundary, radius_m, view_m),
            )
        })
    }

    fn cheapest(
        &self,
        open: &[(Frontier, usize)],
        everywhere: bool,
        routes: &mut Routes,
        boundary: &RayGrid,
        radius_m: f64,
        view_m: f64,
    ) -> Option<Goal> {
        let spacing_m = VIEW_SPACING_M * view_m / VIEWS_M[0];
        // A lower bound on the cost of viewing from a cell, beyond the route there.
        let mut views: Vec<(usize, usize, f64)> = Vec::new();
        for (index, (frontier, visits)) in open.iter().enumerate() {
            let worth = PER_FRONTIER_METRE * frontier.length_m.min(LONGEST_WORTH_M);
            for seen in places_on(frontier, everywhere) {
                for cell in routes.cells_near(seen, view_m, spacing_m, radius_m) {
                    let from = routes.centre(cell);
                    if !boundary.blocks(from, seen) && (*visits == 0 || !self.was_seen_from(frontier, from)) {
                        let extra = PER_METRE[(*visits).min(1)] * from.distance(seen) - worth;
                        views.push((cell, index, extra));
                    }
                }
            }
        }
        if views.is_empty() {
            return None;
        }
        views.sort_by(|p, q| p.0.cmp(&q.0).then(p.2.total_cmp(&q.2)).then(p.1.cmp(&q.1)));
        let least_extra = views.iter().map(|view| view.2).fold(f64::INFINITY, f64::min);
        let mut best: Option<(f64, usize, usize)> = None;
        routes.spread(self.pose.position(), radius_m, |cell, cost| {
            if best.is_some_and(|(found, _, _)| cost + least_extra >= found) {
                return true;
            }
            let first = views.partition_point(|view| view.0 < cell);
            if let Some(&(at, index, extra)) = views.get(first)
                && at == cell
                && best.is_none_or(|(found, _, _)| cost + extra < found)
            {
                best = Some((cost + extra, cell, index));
            }
            false
        });
        let (_, cell, index) = best?;
        let place = routes.centre(cell);
        Some(Goal {
            place,
            frontier: open[index].0.clone(),
            way: routes.way(place),
            bumps: 0,
            known_m2: self.known_m2(),
        })
    }

    /// Replans the route to the goal from the current position.
    fn replan(&mut self) {
        self.activity = Activity::Driving;
        let [_, radius_m] = self.planned_radii_m();
        let Some(goal) = &mut self.goal else { return };
        let mut routes = Routes::around(self.free.shapes(), self.pose.position(), &self.touched);
        let place = goal.place;
        let to = routes.cells_near(place, 0.2, 0.01, 0.0);
        routes.spread(self.pose.position(), radius_m, |cell, _| to.contains(&cell));
        let reached = to.into_iter().filter(|&cell| routes.cost(routes.centre(cell)).is_some());
        let nearest =
            reached.min_by(|&p, &q| routes.centre(p).distance(place).total_cmp(&routes.centre(q).distance(place)));
        goal.way = nearest.map(|cell| routes.way(routes.centre(cell))).unwrap_or_default();
        if goal.way.is_empty() {
            self.leave_goal(true);
        }
    }

    fn known_m2(&self) -> f64 {
        crate::geometry::areas::area_m2(self.free.shapes())
    }

    /// Drops the goal, reached or given up; `in_vain`: its frontier is remembered as such.
    fn leave_goal(&mut self, in_vain: bool) {
        if let Some(goal) = self.goal.take()
            && in_vain
        {
            let middle = goal.frontier.middle;
            let news = self.known_m2() - goal.known_m2 > NEWS_M2;
            let visits = self.visits(&goal.frontier) + if news { 1 } else { 2 };
            match self.visited.iter_mut().find(|visited| visited.middle.distance(middle) < SAME_M / 2.0) {
                Some(visited) => {
                    visited.visits = visits;
                    visited.places.push(goal.place);
                }
                None => self.visited.push(Visited { middle, visits, places: vec![goal.place] }),
            }
        }
        self.activity = Activity::Choosing;
    }

    /// Follows the route to the goal.
    fn follow(&mut self) {
        let here = self.pose.position();
        let near_m = AT_PLACE_M;
        let Some(goal) = &mut self.goal else { return };
        while goal.way.len() > 1 && goal.way[0].distance(here) < near_m {
            goal.way.remove(0);
        }
        let Some(&next) = goal.way.first() else { return self.leave_goal(true) };
        let is_last = goal.way.len() == 1;
        if is_last && next.distance(here) < near_m {
            self.look();
            // What remains after a view cannot be seen from there.
            return self.leave_goal(true);
        }
        let to = self.pose.between(Pose::new(next.x, next.y, 0.0));
        let bearing_rad = to.y_m.atan2(to.x_m);
        if bearing_rad.abs() > self.options.turn_rad {
            let turn_rad = bearing_rad.clamp(-self.options.turn_rad, self.options.turn_rad);
            self.drive(Pose::new(0.0, 0.0, turn_rad));
        } else {
            let ahead_m = self.options.step_m.min(to.x_m.hypot(to.y_m));
            let (sin, cos) = bearing_rad.sin_cos();
            let is_free = self.drive(Pose::new(ahead_m * cos, ahead_m * sin, bearing_rad));
            if !is_free {
                self.bump();
                return;
            }
        }
        if self.is_look_due() {
            self.look();
            self.reconsider();
        }
    }

    /// Handles a collision.
    fn bump(&mut self) {
        self.collisions += 1;
        self.touched.extend(self.touch());
        self.look();
        let Some(goal) = &mut self.goal else { return };
        goal.bumps += 1;
        if goal.bumps >= BUMPS {
            self.leave_goal(true);
        }
        self.activity = Activity::BackingOff;
    }

    /// Where the robot touches something, as a ring of bumpers around it reports it, in the map's frame. The free
    /// space may be wrong there, and once seen as free it stays so: without this, the robot would try again and
    /// again.
    fn touch(&self) -> Option<Point> {
        let at = self.true_pose.position();
        let obstacles = self.world.obstacles();
        let reach_m = self.options.radius_m + self.options.step_m;
        let near = obstacles.near(crate::geometry::Bounds::of([at]).inflated(reach_m));
        let points = near.into_iter().map(|index| obstacles.segments()[index].nearest_point(at));
        let touched = points.min_by(|p, q| p.distance(at).total_cmp(&q.distance(at)))?;
        Some(self.pose.apply(self.true_pose.inverse().apply(touched)))
    }

    /// Drops a goal whose frontier has disappeared: it was seen on the way.
    fn reconsider(&mut self) {
        let Some(goal) = &self.goal else { return };
        let middle = goal.frontier.middle;
        let is_there = self.frontiers().iter().any(|frontier| {
            frontier.middle.distance(middle) < SAME_M || frontier.line.iter().any(|p| p.distance(middle) < SAME_M / 2.0)
        });
        if !is_there {
            self.leave_goal(false);
        }
    }

    fn is_look_due(&self) -> bool {
        let moved = self.looked_at.between(self.pose);
        moved.x_m.hypot(moved.y_m) >= LOOK_M || moved.heading_rad.abs() >= LOOK_RAD
    }

    /// Adds what is seen from here to the free space.
    fn look(&mut self) {
        self.free.add(self.pose, &self.scans);
        self.looks.push(Look { step: self.path.len() - 1, pose: self.pose, scans: self.scans.clone() });
        if self.mapper.closures().0 != self.closures {
            self.settle();
        }
        self.looked_at = self.pose;
        self.has_new_look = true;
    }

    /// Rebuilds the free space when closing a loop has moved the path.
    fn settle(&mut self) {
        self.closures = self.mapper.closures().0;
        let poses = self.mapper.poses();
        let off_m = |look: &Look| {
            let moved = look.pose.between(poses[look.step]);
            moved.x_m.hypot(moved.y_m) + LEVER_M * moved.heading_rad.abs()
        };
        self.pose = poses.last().copied().unwrap_or_default();
        if self.looks.iter().map(off_m).fold(0.0, f64::max) < MOVED_M {
            return;
        }
        for look in &mut self.looks {
            look.pose = poses[look.step];
        }
        self.free = self.free.again(self.looks.iter().map(|look| (look.pose, look.scans.as_slice())));
        if self.goal.is_some() {
            self.replan();
        }
    }

    /// Moves so that the odometry reports this, and scans; returns whether nothing was in the way.
    fn drive(&mut self, odometry: Pose) -> bool {
        let mut odometry = odometry;
        let mut done = self.options.odometry.sample(odometry, &mut self.random);
        let free = self.free_share(self.true_pose, self.true_pose.compose(done));
        if free < 1.0 {
            // It stops on contact; its wheels stop too.
            let stopped = |way: Pose| Pose::new(way.x_m * free, way.y_m * free, way.heading_rad);
            (odometry, done) = (stopped(odometry), stopped(done));
        }
        self.true_pose = self.true_pose.compose(done);
        self.odometry = self.odometry.compose(odometry);
        self.sense();
        free > 0.0
    }

    /// The share, 0..=1, of a straight path that the robot can drive before it touches something. If it
    /// already touches something, it may move away.
    fn free_share(&self, from: Pose, to: Pose) -> f64 {
        let radius_m = self.options.radius_m;
        let clear = |at: Point| self.world.obstacles().distance_m(at, radius_m);
        let at = |place: f64| from.position().lerp(to.position(), place);
        let now_m = clear(at(0.0));
        let mut share = 0.0;
        for place in [0.25, 0.5, 0.75, 1.0] {
            let there_m = clear(at(place));
            if (there_m < radius_m && there_m <= now_m) || self.world.obstacles().blocks(at(share), at(place)) {
                return share;
            }
            share = place;
        }
        share
    }

    /// Scans, and estimates the robot's pose.
    fn sense(&mut self) {
        let (world, pose, random) = (&self.world, self.true_pose, &mut self.random);
        self.scans = self.options.scanners.iter().map(|scanner| scanner.scan(world, pose, random)).collect();
        self.pose = self.mapper.add(self.odometry, &self.scans);
        self.path.push(PathStep { true_pose: self.true_pose, estimate: self.pose, odometry: self.odometry });
    }
}
