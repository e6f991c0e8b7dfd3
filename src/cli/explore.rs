use crate::classify::models::Models;
use std::fmt::Write as _;
use std::path::PathBuf;
use std::sync::Arc;

use clap::builder::PossibleValuesParser;
use serde_json::json;

use super::inputs::{from_stdin, stem};
use super::outputs::{Outputs, must_be_folder};
use super::progress::with_progress;
use super::{CliError, Outcome, Subcommand, Terminal, numbers};
use crate::base::units::parse_number;
use crate::base::work::{Cancelled, Work};
use crate::draw::line_map::LineMapDrawing;
use crate::draw::scene::Scene;
use crate::draw::sheet::{self, Furniture, PageSize};
use crate::draw::{Drawing, Fill, Layers, Style, Theme, png, svg};
use crate::features::{NeighbourLabels, RoomStatus, analyse};
use crate::formats;
use crate::geometry::areas::{self, Shapes};
use crate::geometry::{Point, Segment, trim_m};
use crate::labels::{Label, Schemes};
use crate::plan::Plan;
use crate::predict::Predictor;
use crate::predict::explored::{explored_meta, labelled};
use crate::robot::doorways::DoorwayOptions;
use crate::robot::explore::{Activity, Exploration, RobotOptions};
use crate::robot::explored_plan::ExploredPlan;
use crate::robot::frontiers::Frontier;
use crate::robot::odometry::OdometryNoise;
use crate::robot::rooms::{FoundRooms, RoomOptions};
use crate::robot::score::{Fate, Score, score};
use crate::robot::{Pose, Scanner, World, WorldOptions};

/// `enfilade explore`: a simulated robot in a plan.
#[derive(clap::Args)]
pub struct ExploreCommand {
    /// The plan to explore, of any known format
    #[arg(value_name = "PLAN")]
    plan: PathBuf,
    /// The folder to write to
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Noise of scanners and odometry, as a multiple of the usual; 0 for none
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, value_parser = numbers::share)]
    noise: f64,
    /// Standard deviation of a range reading, instead of the usual 0.005
    #[arg(long, value_name = "METRES", value_parser = numbers::metres)]
    range_noise: Option<f64>,
    /// Share of lost range readings, instead of the usual 0.001
    #[arg(long, value_name = "SHARE", value_parser = numbers::share)]
    drop_out: Option<f64>,
    /// Range of the scanners
    #[arg(long, value_name = "METRES", default_value_t = 20.0, value_parser = numbers::metres)]
    range: f64,
    /// Angle between beams
    #[arg(long, value_name = "DEGREES", default_value_t = 0.5, value_parser = numbers::degrees)]
    resolution: f64,
    /// Noise of the odometry: alpha 1 to 4 of the standard motion model
    #[arg(long, value_name = "A1,A2,A3,A4", value_parser = alphas)]
    odometry: Option<OdometryNoise>,
    /// Pieces of furniture per room
    #[arg(long, value_name = "N", default_value_t = 0)]
    furniture: usize,
    /// Share of the inner doors that are closed
    #[arg(long, value_name = "SHARE", default_value_t = 0.0, value_parser = numbers::share)]
    closed: f64,
    /// Share of the inner doors that are ajar: the robot sees through but cannot pass
    #[arg(long, value_name = "SHARE", default_value_t = 0.0, value_parser = numbers::share)]
    ajar: f64,
    /// Leave the doors to the outside open
    #[arg(long)]
    outer_doors_open: bool,
    /// Seed for the start, the noise, the furniture and the doors
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Find doorways by the paper's rule only
    #[arg(long)]
    paper: bool,
    /// Dark on light, or light on dark
    #[arg(long, value_name = "THEME", default_value = "light",
          value_parser = PossibleValuesParser::new(Theme::ALL.map(Theme::name)))]
    theme: String,
}

impl Subcommand for ExploreCommand {
    const NAME: &'static str = "explore";
    const ABOUT: &'static str = "Let a simulated robot explore a plan and find its rooms";
    const EXAMPLE: &'static str =
        "enfilade explore plans/office.plan.json --furniture 3 -o explored   # map, plan, score";

    fn run(self, terminal: &mut Terminal) -> Result<Outcome, CliError> {
        self.check()?;
        must_be_folder(&self.output)?;
        let import = formats::read_file(&from_stdin(&self.plan))?;
        let Some(truth) = import.plans.first() else {
            return Err(CliError::new(format!("{}: holds no plan", self.plan.display())));
        };
        let world = Arc::new(World::new(truth, &self.world_options()));
        let robot = self.robot_options();
        // Half the robot's width plus its clearance.
        let reach_m = robot.radius_m + robot.margin_m;
        let Some(start) = world.start(reach_m, self.seed) else {
            return Err(CliError::new(format!(
                "{}: no room has space for the robot, {:.1} m wide; check the plan's scale",
                self.plan.display(),
                2.0 * robot.radius_m
            )));
        };
        let mut exploration = Exploration::new(world.clone(), Pose::new(start.x, start.y, 0.0), robot);
        with_progress("exploring", Some(1), terminal, |work| drive(&mut exploration, &world, work))?;

        let options = RoomOptions { seed: self.seed, ..self.room_options() };
        let map = Map {
            segments: exploration.walls(),
            frontiers: exploration.frontiers(),
            found: exploration.rooms(&options),
            poses: exploration.poses(),
        };
        let (predictor, models) = (Predictor::default(), Models::bundled());
        let meta = explored_meta(truth.meta());
        let made = labelled(&map.found, &map.frontiers, exploration.world_from_map, meta, &predictor, &models);
        let explored = made.map_err(|error| CliError::new(error.to_string()))?.explored;
        let areas: Vec<Shapes> = map.found.rooms.iter().map(|room| moved(&room.shapes(), &exploration)).collect();
        let edges: Vec<(usize, usize)> =
            map.found.sides.iter().filter_map(|sides| Some((sides[0]?, sides[1]?))).collect();
        let score = score(&world, start, reach_m, &areas, &edges);
        let labels = labels_right(truth, &score, &explored);
        self.write(&exploration, &map, &explored, &score, labels, terminal)?;

        let ended = if exploration.activity == Activity::GaveUp { ", gave up" } else { "" };
        terminal.report(format!(
            "{}: {} of {} rooms found ({} split, {} merged, {} missed, {} invented, {} out of reach); \
             {} of {} edges right, {} wrong; {} of {} labels right; {:.0} m driven{ended}",
            self.output.display(),
            score.count(Fate::Found),
            score.rooms.len(),
            score.count(Fate::Split),
            score.count(Fate::Merged),
            score.count(Fate::Missed),
            score.invented.len(),
            score.unreachable.len(),
            score.right_edges.len(),
            score.true_edges.len(),
            score.wrong_edges,
            labels.0,
            labels.1,
            driven_m(&exploration),
        ))?;
        Ok(Outcome::Done)
    }
}

/// What the robot knows at the end, in the map's frame.
struct Map {
    segments: Vec<Segment>,
    frontiers: Vec<Frontier>,
    found: FoundRooms,
    poses: Vec<Pose>,
}

impl ExploreCommand {
    fn check(&self) -> Result<(), CliError> {
        let shares = [("--closed", self.closed), ("--ajar", self.ajar), ("--drop-out", self.drop_out.unwrap_or(0.0))];
        for (name, share) in shares {
            if !(0.0..=1.0).contains(&share) {
                return Err(CliError::call(format!("{name} {share}: must be between 0 and 1")));
            }
        }
        let limits = [
            ("--noise", self.noise, 0.0, 100.0),
            ("--range-noise", self.range_noise.unwrap_or(0.0), 0.0, 10.0),
            ("--range", self.range, 0.5, 1_000.0),
            ("--resolution", self.resolution, 0.05, 10.0),
        ];
        for (name, value, least, most) in limits {
            if !(least..=most).contains(&value) {
                return Err(CliError::call(format!("{name} {value}: use {least} to {most}")));
            }
        }
        Ok(())
    }

    fn world_options(&self) -> WorldOptions {
        WorldOptions {
            closed_share: self.closed,
            ajar_share: self.ajar,
            outer_doors_open: self.outer_doors_open,
            furniture: self.furniture,
            seed: self.seed,
        }
    }

    fn robot_options(&self) -> RobotOptions {
        let mut robot = RobotOptions { seed: self.seed, ..RobotOptions::default() };
        if self.noise == 0.0 {
            robot = robot.exact();
        }
        robot.odometry = self.odometry.unwrap_or_else(|| robot.odometry.times(self.noise));
        let tuned = |scanner: &Scanner| Scanner {
            noise_m: self.range_noise.unwrap_or(scanner.noise_m * self.noise),
            drop_out: self.drop_out.unwrap_or((scanner.drop_out * self.noise).min(1.0)),
            max_range_m: self.range,
            step_rad: self.resolution.to_radians(),
            ..scanner.clone()
        };
        robot.scanners = robot.scanners.iter().map(tuned).collect();
        robot
    }

    fn room_options(&self) -> RoomOptions {
        let doorways = if self.paper { DoorwayOptions::PAPER } else { DoorwayOptions::default() };
        RoomOptions { doorways, ..RoomOptions::default() }
    }

    fn write(
        &self,
        exploration: &Exploration,
        map: &Map,
        explored: &ExploredPlan,
        score: &Score,
        labels: (usize, usize),
        terminal: &mut Terminal,
    ) -> Result<(), CliError> {
        let name = stem(&from_stdin(&self.plan));
        let mut outputs = Outputs::new(terminal);
        outputs.folder(&self.output)?;
        let mut write = |name: &str, bytes: &[u8]| outputs.save_in(&self.output, name, bytes, terminal);
        write("poses.csv", poses_csv(exploration, map).as_bytes())?;
        write("map.json", map_json(exploration, map).as_bytes())?;
        write("score.json", score_json(score, explored, labels).as_bytes())?;
        write(&format!("{name}.plan.json"), &formats::plan_json::to_bytes(&explored.plan))?;

        // The parser only accepts names of the table.
        let theme = Theme::ALL.into_iter().find(|theme| theme.name() == self.theme).unwrap_or_default();
        let world_from_map = exploration.world_from_map;
        let to_world =
            |segment: &Segment| Segment::new(world_from_map.apply(segment.a), world_from_map.apply(segment.b));
        let segments: Vec<Segment> = map.segments.iter().map(to_world).collect();
        let path: Vec<Point> = map.poses.iter().map(|pose| world_from_map.apply(pose.position())).collect();
        let free = moved(exploration.free.shapes(), exploration);
        let scene =
            LineMapDrawing { segments: &segments, free: &free, path: &path }.page(theme, PICTURE_SIDE_PX, &name);
        write(&format!("{name}.map.png"), &png::png(&scene)?)?;
        write(&format!("{name}.map.svg"), svg::svg(&scene).as_bytes())?;

        let scene = rooms_scene(&explored.plan, theme, PICTURE_SIDE_PX);
        write(&format!("{name}.rooms.png"), &png::png(&scene)?)?;
        Ok(())
    }
}

/// The picture of a robot's plan: rooms coloured by their predicted labels, and the graph.
pub(super) fn rooms_scene(plan: &Plan, theme: Theme, longest_px: f64) -> Scene {
    let analysis = analyse(plan, &Schemes::bundled(), NeighbourLabels::True);
    let said = plan.rooms().filter_map(|(id, room)| Some((id, room.label?.label))).collect();
    let drawing = Drawing::new(plan, &analysis).with_predictions(&said);
    let layers = Layers { graph: true, ..Layers::default() };
    let style = Style { theme, fill: Fill::Prediction, layers, ..Style::default() };
    sheet::page(&drawing, &style, PageSize::Longest(longest_px), Furniture::default())
}

/// Reads the four alphas of the motion model.
fn alphas(text: &str) -> Result<OdometryNoise, String> {
    let numbers: Result<Vec<f64>, _> = text.split(',').map(parse_number).collect();
    let numbers = numbers.unwrap_or_default();
    match numbers[..] {
        [alpha_1, alpha_2, alpha_3, alpha_4] if numbers.iter().all(|alpha| (0.0..=10.0).contains(alpha)) => {
            Ok(OdometryNoise { alpha_1, alpha_2, alpha_3, alpha_4 })
        }
        _ => {
            Err("give four numbers from 0 to 10 with commas between them, such as 0.01,0.0025,0.0025,0.0001".to_owned())
        }
    }
}

/// The longer side of a picture, in pixels.
const PICTURE_SIDE_PX: f64 = 1600.0;

/// Runs to the end, reporting how much of the floor has been seen.
fn drive(exploration: &mut Exploration, world: &World, work: &Work<'_>) -> Result<(), Cancelled> {
    let all = areas::area_m2(world.free()).ceil().max(1.0) as usize;
    while !exploration.is_over() {
        exploration.step();
        if exploration.has_new_look() {
            let seen = areas::area_m2(exploration.free.shapes()) as usize;
            work.step(seen.min(all - 1), all)?;
        }
    }
    Ok(())
}

fn driven_m(exploration: &Exploration) -> f64 {
    let at = |step: &crate::robot::explore::PathStep| step.true_pose.position();
    exploration.path.windows(2).map(|pair| at(&pair[0]).distance(at(&pair[1]))).sum()
}

/// An area of the map in the world's frame.
fn moved(shapes: &Shapes, exploration: &Exploration) -> Shapes {
    let ring = |ring: &areas::Ring| -> areas::Ring {
        let points = areas::points(ring).into_iter().map(|point| exploration.world_from_map.apply(point));
        points.map(|point| [point.x, point.y]).collect()
    };
    shapes.iter().map(|shape| shape.iter().map(ring).collect()).collect()
}

/// The number of found rooms whose true label is known that are labelled correctly, and their total.
fn labels_right(truth: &Plan, score: &Score, explored: &ExploredPlan) -> (usize, usize) {
    let schemes = Schemes::bundled();
    let pairs: Vec<(Label, Option<Label>)> = score
        .rooms
        .iter()
        .filter(|room| room.fate == Fate::Found)
        .filter_map(|room| {
            let known = RoomStatus::of(truth, &schemes, truth.room(room.id)?).label()?;
            let said = explored.plan.room(*explored.rooms.get(room.best?)?)?.label.map(|said| said.label);
            Some((known, said))
        })
        .collect();
    (pairs.iter().filter(|(known, said)| *said == Some(*known)).count(), pairs.len())
}

/// Each step's true pose, the final estimate of it, and the odometry's, all in the plan's frame.
fn poses_csv(exploration: &Exploration, map: &Map) -> String {
    let mut csv = String::from(
        "step,true_x,true_y,true_theta,estimated_x,estimated_y,estimated_theta,odometry_x,odometry_y,odometry_theta\n",
    );
    let world_from_map = exploration.world_from_map;
    for (step, (path, estimate)) in exploration.path.iter().zip(&map.poses).enumerate() {
        let _ = write!(csv, "{step}");
        for pose in [path.true_pose, world_from_map.compose(*estimate), world_from_map.compose(path.odometry)] {
            let heading = (pose.heading_rad * 1e5).round() / 1e5 + 0.0;
            let _ = write!(csv, ",{},{},{heading}", trim_m(pose.x_m), trim_m(pose.y_m));
        }
        csv.push('\n');
    }
    csv
}

/// The map in the plan's frame: lines, free space, frontiers, doorways.
fn map_json(exploration: &Exploration, map: &Map) -> String {
    let at = |point: Point| {
        let point = exploration.world_from_map.apply(point).trimmed();
        [point.x, point.y]
    };
    let line = |segment: &Segment| [at(segment.a), at(segment.b)];
    let lines: Vec<_> = map.segments.iter().map(line).collect();
    let free: Vec<Vec<Vec<[f64; 2]>>> = exploration
        .free
        .shapes()
        .iter()
        .map(|shape| shape.iter().map(|ring| areas::points(ring).into_iter().map(at).collect()).collect())
        .collect();
    let frontiers: Vec<Vec<_>> =
        map.frontiers.iter().map(|frontier| frontier.line.iter().map(|&point| at(point)).collect()).collect();
    let doorways: Vec<_> = map.found.doorways.iter().map(|doorway| line(&doorway.segment)).collect();
    let value = json!({
        "enfilade_robot_map": 1,
        "frame": "the plan's: metres, y up",
        "lines": lines,
        "free_space": free,
        "frontiers": frontiers,
        "doorways": doorways,
    });
    format!("{value}\n")
}

fn score_json(score: &Score, explored: &ExploredPlan, labels: (usize, usize)) -> String {
    let rooms: Vec<_> = score
        .rooms
        .iter()
        .map(|room| {
            json!({
                "true": room.id.to_string(),
                "found": room.best.and_then(|best| explored.rooms.get(best)).map(ToString::to_string),
                "iou": (1e4 * room.iou).round() / 1e4,
                "fate": room.fate.name(),
            })
        })
        .collect();
    let value = json!({
        "version": 1,
        "rooms": {
            "reachable": score.rooms.len(),
            "found": score.count(Fate::Found),
            "split": score.count(Fate::Split),
            "merged": score.count(Fate::Merged),
            "missed": score.count(Fate::Missed),
            "invented": score.invented.len(),
            "unreachable": score.unreachable.len(),
        },
        "edges": {
            "true": score.true_edges.len(),
            "right": score.right_edges.len(),
            "wrong": score.wrong_edges,
        },
        "labels": { "known": labels.1, "right": labels.0 },
        "each_room": rooms,
    });
    format!("{value:#}\n")
}
