//! Scan matching: finds the pose that places the segments of a scan on the lines of a map.
//!
//! Segments are matched to segments as in the paper's reference 18 (Lakaemper, Latecki and Wolter 2005):
//! each segment of the scan looks for a nearby, nearly parallel line of the map seen from the same side.
//! It leaves open how the pose follows from the matches; here that is the point-to-line metric of Censi
//! (2008, PLICP) over the points of the matched segments: Gauss-Newton with weights that fall with
//! distance, and the odometry as a prior (Lu and Milios 1997 weigh both by their covariances in the same
//! way), so that directions not constrained by any wall follow the odometry.

use nalgebra::{Matrix3, Vector3};

use super::pose::wrapped_rad;
use super::{LineSegment, Pose};
use crate::geometry::{Bounds, Point, Vector};

/// A hit on a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    pub at: Point,
    /// Along its segment, a unit vector; the observer was to the left.
    pub along: Vector,
}

/// A pose with its uncertainty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoseEstimate {
    pub pose: Pose,
    /// Inverse covariance of the displacement ahead, to the left, and of the heading, in the pose's own
    /// frame: 1/m², 1/(m rad), 1/rad².
    pub information: Matrix3<f64>,
}

/// Matching parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MatchOptions {
    /// The maximum distance of a point from its line in the first iteration, in metres.
    pub first_reach_m: f64,
    /// And in the last.
    pub last_reach_m: f64,
    /// The maximum angle between a segment of the scan and its line.
    pub angle_rad: f64,
    /// Standard deviation of a point across its line, in metres: noise of the readings and of the world.
    pub sigma_m: f64,
    /// How many points of a scan carry as much information as one independent one: neighbours share
    /// errors.
    pub points_per_measurement: f64,
}

impl Default for MatchOptions {
    fn default() -> Self {
        Self {
            first_reach_m: 0.5,
            last_reach_m: 0.12,
            angle_rad: 25_f64.to_radians(),
            sigma_m: 0.02,
            points_per_measurement: 20.0,
        }
    }
}

/// The result of matching.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Match {
    /// The information is that of the lines alone, without the prior.
    pub estimate: PoseEstimate,
    /// The share of points within the last reach of a line, in 0..=1.
    pub explained: f64,
    /// Root mean square distance of these from their lines, in metres.
    pub residual_m: f64,
}

impl Match {
    /// The log likelihood of `count` points given the lines: each explained point is more likely by the
    /// factor that the kernel of the last iteration gives.
    pub fn log_likelihood(&self, count: usize, options: &MatchOptions) -> f64 {
        let scale = 0.5 * options.last_reach_m / options.sigma_m;
        self.explained * count as f64 / options.points_per_measurement * 0.5 * scale * scale
    }
}

/// A line to match with.
#[derive(Clone, Copy, Debug)]
struct Target {
    start: Point,
    along: Vector,
    length_m: f64,
    /// The position along the line of its points' centroid.
    centroid_m: f64,
    /// 1/n and 1/Σs²: the line's covariance in units of a point's variance.
    offset_variance: f64,
    angle_variance: f64,
}

impl Target {
    fn new(line: &LineSegment) -> Self {
        let along = line.direction();
        let covariance = line.covariance(1.0);
        Self {
            start: line.start,
            along,
            length_m: line.length(),
            centroid_m: (line.moments.centroid - line.start).dot(along),
            offset_variance: covariance[(0, 0)],
            angle_variance: covariance[(1, 1)],
        }
    }

    /// Squared distance to the segment, signed distance to its line, and position along it, in metres.
    fn place(&self, point: Point) -> (f64, f64, f64) {
        let way = point - self.start;
        let (at, off) = (way.dot(self.along), self.along.cross(way));
        let beyond = (at - at.clamp(0.0, self.length_m)).abs();
        (off * off + beyond * beyond, off, at)
    }
}

/// The lines of a neighbourhood, in a grid of cells, for fast lookup near a point.
#[derive(Clone, Debug)]
pub struct Reference {
    targets: Vec<Target>,
    origin: Point,
    columns: usize,
    rows: usize,
    /// The targets of cell c are `of_cell[starts[c]..starts[c + 1]]`.
    starts: Vec<usize>,
    of_cell: Vec<u32>,
}

/// Side of a cell in metres: about the first reach.
const CELL_M: f64 = 0.5;
/// Maximum width of a neighbourhood: the longest range of common scanners in both directions.
const WIDEST_M: f64 = 200.0;

impl Reference {
    /// The lines within `bounds`; a point up to `reach_m` from a line will find it.
    pub fn new<'a>(lines: impl IntoIterator<Item = &'a LineSegment>, bounds: Bounds, reach_m: f64) -> Self {
        let targets: Vec<Target> = lines.into_iter().map(Target::new).collect();
        let side = |length: f64| (length.min(WIDEST_M) / CELL_M).ceil().max(1.0) as usize;
        let (columns, rows) = (side(bounds.width()), side(bounds.height()));
        let mut reference = Self {
            targets,
            origin: bounds.min,
            columns,
            rows,
            starts: vec![0; columns * rows + 1],
            of_cell: Vec::new(),
        };
        let mut pairs: Vec<(usize, u32)> = Vec::new();
        for (id, target) in reference.targets.iter().enumerate() {
            reference.cells_near(target, reach_m, |cell| pairs.push((cell, id as u32)));
        }
        pairs.sort_unstable();
        for (cell, _) in &pairs {
            reference.starts[cell + 1] += 1;
        }
        for cell in 0..columns * rows {
            reference.starts[cell + 1] += reference.starts[cell];
        }
        reference.of_cell = pairs.into_iter().map(|(_, id)| id).collect();
        reference
    }

    /// Calls `found` with each cell that contains points within `reach_m` of the target (and a few more).
    fn cells_near(&self, target: &Target, reach_m: f64, mut found: impl FnMut(usize)) {
        let end = target.start + target.along * target.length_m;
        let bounds = Bounds::of([target.start, end]).inflated(reach_m);
        let index = |at: f64, count: usize| ((at / CELL_M).floor().max(0.0) as usize).min(count);
        let columns = index(bounds.min.x - self.origin.x, self.columns)
            ..index(bounds.max.x - self.origin.x + CELL_M, self.columns);
        let rows =
            index(bounds.min.y - self.origin.y, self.rows)..index(bounds.max.y - self.origin.y + CELL_M, self.rows);
        let most = reach_m + CELL_M * std::f64::consts::FRAC_1_SQRT_2;
        for row in rows {
            for column in columns.clone() {
                let middle = self.origin + Vector::new(column as f64 + 0.5, row as f64 + 0.5) * CELL_M;
                if target.place(middle).0 <= most * most {
                    found(row * self.columns + column);
                }
            }
        }
    }

    fn near(&self, point: Point) -> &[u32] {
        let (column, row) = ((point.x - self.origin.x) / CELL_M, (point.y - self.origin.y) / CELL_M);
        if !(column >= 0.0 && row >= 0.0 && column < self.columns as f64 && row < self.rows as f64) {
            return &[];
        }
        let cell = row as usize * self.columns + column as usize;
        &self.of_cell[self.starts[cell]..self.starts[cell + 1]]
    }

    /// The nearest line within reach with a similar direction, with signed distance and position along
    /// it.
    fn nearest(&self, point: Point, along: Vector, reach_m: f64, least_cos: f64) -> Option<(&Target, f64, f64)> {
        let mut best: Option<(&Target, f64, f64)> = None;
        let mut least = reach_m * reach_m;
        for id in self.near(point) {
            let target = &self.targets[*id as usize];
            if target.along.dot(along) < least_cos {
                continue;
            }
            let (squared, off, at) = target.place(point);
            if squared < least {
                least = squared;
                best = Some((target, off, at));
            }
        }
        best
    }

    /// The share of points within `reach_m` of a line with a similar direction.
    pub fn explained(&self, points: &[SurfacePoint], pose: Pose, reach_m: f64, angle_rad: f64) -> f64 {
        let least_cos = angle_rad.cos();
        let found = points
            .iter()
            .filter(|point| self.nearest(pose.apply(point.at), pose.rotate(point.along), reach_m, least_cos).is_some())
            .count();
        found as f64 / points.len().max(1) as f64
    }
}

/// Maximum Gauss-Newton iterations.
const MOST_STEPS: usize = 40;
/// The reach shrinks by this factor in each iteration.
const SHRINKING: f64 = 0.75;

/// The pose near `guess` that puts the points, given in the robot's frame, on the reference's lines;
/// `prior` determines what the lines leave free. `None` if no line is near.
pub fn match_points(
    reference: &Reference,
    points: &[SurfacePoint],
    guess: Pose,
    prior: Option<&PoseEstimate>,
    options: &MatchOptions,
) -> Option<Match> {
    let mut pose = guess;
    let mut reach_m = options.first_reach_m.max(options.last_reach_m);
    for _ in 0..MOST_STEPS {
        let lines = pull(reference, points, pose, reach_m, options);
        let (mut matrix, mut vector) = (lines.matrix, lines.vector);
        if let Some(prior) = prior {
            let (prior_matrix, prior_vector) = pull_of_prior(prior, pose);
            matrix += prior_matrix;
            vector += prior_vector;
        }
        // Slight damping: with one wall and no prior the system is singular.
        matrix += Matrix3::from_diagonal(&Vector3::new(1e-3, 1e-3, 1e-3));
        let step = matrix.cholesky()?.solve(&vector);
        pose = Pose::new(pose.x_m + step.x, pose.y_m + step.y, pose.heading_rad + step.z);
        let is_settled = step.x.hypot(step.y) < 1e-4 && step.z.abs() < 1e-5;
        if is_settled && reach_m <= options.last_reach_m {
            break;
        }
        reach_m = (reach_m * SHRINKING).max(options.last_reach_m);
    }
    let lines = pull(reference, points, pose, options.last_reach_m, options);
    if lines.count == 0 || !pose.is_finite() {
        return None;
    }
    let own = turned(&lines.matrix, -pose.heading_rad);
    Some(Match {
        estimate: PoseEstimate { pose, information: own },
        explained: lines.count as f64 / points.len().max(1) as f64,
        residual_m: (lines.squares_m2 / lines.count as f64).sqrt(),
    })
}

/// Normal equations of a small displacement in the world's frame, turning about the robot.
struct Pull {
    matrix: Matrix3<f64>,
    vector: Vector3<f64>,
    count: usize,
    squares_m2: f64,
}

fn pull(reference: &Reference, points: &[SurfacePoint], pose: Pose, reach_m: f64, options: &MatchOptions) -> Pull {
    let least_cos = options.angle_rad.cos();
    let (sin, cos) = pose.heading_rad.sin_cos();
    let turn = |v: Vector| Vector::new(v.x * cos - v.y * sin, v.x * sin + v.y * cos);
    let scale = 0.5 * reach_m;
    let mut pull = Pull { matrix: Matrix3::zeros(), vector: Vector3::zeros(), count: 0, squares_m2: 0.0 };
    for point in points {
        let arm = turn(Vector::new(point.at.x, point.at.y));
        let at = pose.position() + arm;
        let Some((target, off, place)) = reference.nearest(at, turn(point.along), reach_m, least_cos) else { continue };
        let lever = place - target.centroid_m;
        let variance = options.sigma_m
            * options.sigma_m
            * options.points_per_measurement
            * (1.0 + target.offset_variance + lever * lever * target.angle_variance);
        // Geman-McClure weights: distant points count little.
        let doubt = 1.0 + (off / scale).powi(2);
        let weight = 1.0 / (variance * doubt * doubt);
        let normal = target.along.left();
        let row = Vector3::new(normal.x, normal.y, normal.dot(arm.left()));
        pull.matrix += row * row.transpose() * weight;
        pull.vector -= row * (off * weight);
        pull.count += 1;
        pull.squares_m2 += off * off;
    }
    pull
}

/// How unlikely a pose is under a prior: the negative log density relative to the mode, for Student's t
/// distribution in three dimensions.
pub fn surprise(prior: &PoseEstimate, pose: Pose) -> f64 {
    let off = prior.pose.between(pose);
    let off = Vector3::new(off.x_m, off.y_m, off.heading_rad);
    0.5 * (PRIOR_TAIL + 3.0) * (off.dot(&(prior.information * off)) / PRIOR_TAIL).ln_1p()
}

/// Degrees of freedom of the prior's distribution.
const PRIOR_TAIL: f64 = 4.0;

/// The pull of the prior towards its own pose.
fn pull_of_prior(prior: &PoseEstimate, pose: Pose) -> (Matrix3<f64>, Vector3<f64>) {
    let matrix = turned(&prior.information, prior.pose.heading_rad);
    let off = Vector3::new(
        prior.pose.x_m - pose.x_m,
        prior.pose.y_m - pose.y_m,
        wrapped_rad(prior.pose.heading_rad - pose.heading_rad),
    );
    // Heavy tails (Student's t): wheels slip, and some robots report reversing as driving ahead.
    let doubt = 1.0 + (off.dot(&(matrix * off))) / PRIOR_TAIL;
    (matrix / doubt, matrix * off / doubt)
}

/// An information matrix over (x, y, heading) in a frame rotated by `angle_rad`.
fn turned(information: &Matrix3<f64>, angle_rad: f64) -> Matrix3<f64> {
    let (sin, cos) = angle_rad.sin_cos();
    let turn = Matrix3::new(cos, -sin, 0.0, sin, cos, 0.0, 0.0, 0.0, 1.0);
    turn * information * turn.transpose()
}
