//! A pose graph: measurements between poses, and the poses that fit them best.
//!
//! The Levenberg-Marquardt method on the sparse normal equations (Grisetti et al. 2010, 'A tutorial on
//! graph-based SLAM'). Loop closures may be wrong: each is down-weighted according to its disagreement
//! with the rest, by dynamic covariance scaling (Agarwal et al. 2013).

use std::collections::{BTreeMap, BTreeSet};

use nalgebra::{Matrix3, Vector3};

use super::Pose;
use super::matching::PoseEstimate;

/// One measurement between two poses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Edge {
    pub from: usize,
    pub to: usize,
    /// The pose of `to` relative to `from`, with its information in its own frame.
    pub measured: PoseEstimate,
    /// A closure may be wrong; a step of the path is not.
    pub is_closure: bool,
}

/// Poses and the measurements between them. The first pose is fixed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PoseGraph {
    pub poses: Vec<Pose>,
    pub edges: Vec<Edge>,
}

/// Squared error, in deviations, up to which a closure has full weight (Φ of Agarwal et al., who use 1 to
/// 10).
const DOUBTED_FROM: f64 = 5.0;
const MOST_STEPS: usize = 25;
/// Iteration stops at steps smaller than this, in metres and radians: a hundredth of a scanner's
/// resolution.
const SETTLED: f64 = 1e-4;

impl PoseGraph {
    /// Minimises the weighted sum of squared errors over the poses, starting from their current values.
    /// Edges to poses that do not exist are ignored.
    pub fn optimise(&mut self) {
        let count = self.poses.len();
        let mut damping = 1e-6;
        let mut cost = self.cost();
        let order = elimination_order(count, &self.edges);
        for _ in 0..MOST_STEPS {
            let (blocks, pull) = self.normal_equations();
            let Some(step) = solve(&blocks, &pull, damping, &order) else {
                damping = (damping * 10.0).max(1e-6);
                if damping > 1e6 {
                    return;
                }
                continue;
            };
            let before = self.poses.clone();
            for (pose, step) in self.poses.iter_mut().zip(&step) {
                *pose = Pose::new(pose.x_m + step.x, pose.y_m + step.y, pose.heading_rad + step.z);
            }
            let after = self.cost();
            // NaN is no improvement either.
            if after.is_nan() || cost.is_nan() || after > cost {
                self.poses = before;
                damping *= 10.0;
                if damping > 1e6 {
                    return;
                }
                continue;
            }
            cost = after;
            damping = (damping * 0.1).max(1e-9);
            if step.iter().all(|step| step.amax() < SETTLED) {
                return;
            }
        }
    }

    /// The squared error of an edge, in squared deviations.
    pub fn squared_error(&self, edge: &Edge) -> f64 {
        let Some((error, ..)) = self.error(edge) else { return 0.0 };
        error.dot(&(edge.measured.information * error))
    }

    /// The weight of an edge, 0 to 1.
    pub fn weight(&self, edge: &Edge) -> f64 {
        if !edge.is_closure {
            return 1.0;
        }
        let scale = (2.0 * DOUBTED_FROM / (DOUBTED_FROM + self.squared_error(edge))).min(1.0);
        scale * scale
    }

    fn cost(&self) -> f64 {
        self.edges
            .iter()
            .map(|edge| {
                let squared = self.squared_error(edge);
                if edge.is_closure && squared > DOUBTED_FROM {
                    // The kernel whose weight is that of dynamic covariance scaling.
                    DOUBTED_FROM * (3.0 * squared - DOUBTED_FROM) / (squared + DOUBTED_FROM)
                } else {
                    squared
                }
            })
            .sum()
    }

    /// The error of an edge in the frame of its measurement, and its derivatives with respect to both
    /// poses.
    fn error(&self, edge: &Edge) -> Option<(Vector3<f64>, Matrix3<f64>, Matrix3<f64>)> {
        let (from, to) = (*self.poses.get(edge.from)?, *self.poses.get(edge.to)?);
        let measured = edge.measured.pose;
        let off = measured.between(from.between(to));
        let (sin, cos) = (-(from.heading_rad + measured.heading_rad)).sin_cos();
        let way = to.position() - from.position();
        // d/dθ of a rotation by -θ is itself rotated by -90 degrees.
        let (swing_x, swing_y) = (sin * way.x + cos * way.y, -cos * way.x + sin * way.y);
        let by_to = Matrix3::new(cos, -sin, 0.0, sin, cos, 0.0, 0.0, 0.0, 1.0);
        let by_from = Matrix3::new(-cos, sin, swing_x, -sin, -cos, swing_y, 0.0, 0.0, -1.0);
        Some((Vector3::new(off.x_m, off.y_m, off.heading_rad), by_from, by_to))
    }

    fn normal_equations(&self) -> (Blocks, Vec<Vector3<f64>>) {
        let mut blocks = Blocks::new();
        let mut pull = vec![Vector3::zeros(); self.poses.len()];
        for pose in 0..self.poses.len() {
            blocks.insert((pose, pose), Matrix3::zeros());
        }
        for edge in &self.edges {
            let Some((error, by_from, by_to)) = self.error(edge) else { continue };
            if edge.from == edge.to {
                continue;
            }
            let information = edge.measured.information * self.weight(edge);
            *blocks.entry((edge.from, edge.from)).or_default() += by_from.transpose() * information * by_from;
            *blocks.entry((edge.to, edge.to)).or_default() += by_to.transpose() * information * by_to;
            let (row, column, block) = if edge.from > edge.to {
                (edge.from, edge.to, by_from.transpose() * information * by_to)
            } else {
                (edge.to, edge.from, by_to.transpose() * information * by_from)
            };
            *blocks.entry((row, column)).or_default() += block;
            pull[edge.from] -= by_from.transpose() * (information * error);
            pull[edge.to] -= by_to.transpose() * (information * error);
        }
        (blocks, pull)
    }
}

/// The blocks on and below the diagonal of a symmetric matrix, by row and column.
type Blocks = BTreeMap<(usize, usize), Matrix3<f64>>;

/// Weight that fixes the first pose.
const FIXED: f64 = 1e12;

/// An elimination order with little fill-in: always the pose with the fewest remaining neighbours.
/// Returns each pose's place in the order.
fn elimination_order(count: usize, edges: &[Edge]) -> Vec<usize> {
    let mut neighbours: Vec<BTreeSet<usize>> = vec![BTreeSet::new(); count];
    for edge in edges.iter().filter(|edge| edge.from != edge.to && edge.from.max(edge.to) < count) {
        neighbours[edge.from].insert(edge.to);
        neighbours[edge.to].insert(edge.from);
    }
    let mut waiting: BTreeSet<(usize, usize)> =
        neighbours.iter().enumerate().map(|(pose, around)| (around.len(), pose)).collect();
    let mut place = vec![0; count];
    let mut next = 0;
    while let Some((_, pose)) = waiting.pop_first() {
        place[pose] = next;
        next += 1;
        let around: Vec<usize> = std::mem::take(&mut neighbours[pose]).into_iter().collect();
        for one in &around {
            waiting.remove(&(neighbours[*one].len(), *one));
            neighbours[*one].remove(&pose);
            neighbours[*one].extend(around.iter().filter(|other| *other != one));
            waiting.insert((neighbours[*one].len(), *one));
        }
    }
    place
}

/// Solves the damped normal equations by a block Cholesky factorisation in the given order.
fn solve(blocks: &Blocks, pull: &[Vector3<f64>], damping: f64, place: &[usize]) -> Option<Vec<Vector3<f64>>> {
    let count = pull.len();
    let mut diagonal = vec![Matrix3::zeros(); count];
    let mut columns: Vec<BTreeMap<usize, Matrix3<f64>>> = vec![BTreeMap::new(); count];
    for ((row, column), block) in blocks {
        let (row_at, column_at) = (place[*row], place[*column]);
        if row == column {
            let mut block = *block;
            for i in 0..3 {
                block[(i, i)] += damping * block[(i, i)] + 1e-9 + if *row == 0 { FIXED } else { 0.0 };
            }
            diagonal[row_at] = block;
        } else if row_at > column_at {
            columns[column_at].insert(row_at, *block);
        } else {
            columns[row_at].insert(column_at, block.transpose());
        }
    }
    // Right-looking: each finished column is subtracted from the columns it affects.
    let mut inverses = Vec::with_capacity(count);
    for at in 0..count {
        let inverse = diagonal[at].cholesky()?.inverse();
        let column: Vec<(usize, Matrix3<f64>)> = columns[at].iter().map(|(row, block)| (*row, *block)).collect();
        for (i, (row, block)) in column.iter().enumerate() {
            let scaled = block * inverse;
            diagonal[*row] -= scaled * block.transpose();
            for (lower, lower_block) in &column[i + 1..] {
                *columns[*row].entry(*lower).or_default() -= lower_block * scaled.transpose();
            }
        }
        inverses.push(inverse);
    }
    let mut solution = vec![Vector3::zeros(); count];
    for (pose, pull) in pull.iter().enumerate() {
        solution[place[pose]] = *pull;
    }
    for at in 0..count {
        let known = inverses[at] * solution[at];
        for (row, block) in &columns[at] {
            solution[*row] -= block * known;
        }
    }
    for at in (0..count).rev() {
        let below: Vector3<f64> = columns[at]
            .iter()
            .map(|(row, block)| block.transpose() * solution[*row])
            .fold(Vector3::zeros(), |a, b| a + b);
        solution[at] = inverses[at] * (solution[at] - below);
    }
    Some(place.iter().map(|at| solution[*at]).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn edge(from: usize, to: usize, pose: Pose, is_closure: bool) -> Edge {
        let information = Matrix3::from_diagonal(&Vector3::new(400.0, 400.0, 2500.0));
        Edge { from, to, measured: PoseEstimate { pose, information }, is_closure }
    }

    /// A drive around a square of 10 m in steps of 1 m, with odometry that bends it.
    fn square() -> (Vec<Pose>, PoseGraph) {
        let step = |i: usize| Pose::new(1.0, 0.0, if i % 10 == 9 { std::f64::consts::FRAC_PI_2 } else { 0.0 });
        let bent = |i: usize| Pose::new(1.02, 0.01, step(i).heading_rad + 0.01);
        let mut truth = vec![Pose::IDENTITY];
        let mut graph = PoseGraph { poses: vec![Pose::IDENTITY], edges: Vec::new() };
        for i in 0..80 {
            truth.push(truth[i].compose(step(i)));
            graph.poses.push(graph.poses[i].compose(bent(i)));
            graph.edges.push(edge(i, i + 1, bent(i), false));
        }
        for i in 0..40 {
            graph.edges.push(edge(i, i + 40, Pose::IDENTITY, true));
        }
        (truth, graph)
    }

    fn worst_m(truth: &[Pose], graph: &PoseGraph) -> f64 {
        truth.iter().zip(&graph.poses).map(|(a, b)| a.position().distance(b.position())).fold(0.0, f64::max)
    }

    #[test]
    fn closures_straighten_a_bent_path() {
        let (truth, mut graph) = square();
        let before = worst_m(&truth, &graph);
        graph.optimise();
        let after = worst_m(&truth, &graph);
        assert!(before > 2.0 && after < 0.8, "{before} m before, {after} m after");
    }

    #[test]
    fn wrong_closures_are_ignored() {
        let (truth, mut graph) = square();
        let (_, mut right) = square();
        right.optimise();
        for i in [3, 17, 29] {
            graph.edges.push(edge(i, 2 * i + 9, Pose::new(0.3, 0.1, 0.0), true));
        }
        graph.optimise();
        assert!(worst_m(&truth, &graph) < worst_m(&truth, &right) + 0.1);
        assert!(graph.edges[graph.edges.len() - 3..].iter().all(|wrong| graph.weight(wrong) < 0.05));
        assert!(graph.edges[80..120].iter().all(|closure| graph.weight(closure) > 0.5));
    }

    #[test]
    fn the_solution_is_that_of_the_dense_system() {
        let (_, graph) = square();
        let (blocks, pull) = graph.normal_equations();
        let order = elimination_order(pull.len(), &graph.edges);
        let solution = solve(&blocks, &pull, 0.0, &order).unwrap();
        for (pose, &pulled) in pull.iter().enumerate().skip(1) {
            let mut left = Vector3::zeros();
            for (other, &part) in solution.iter().enumerate() {
                left += match blocks.get(&(pose, other)) {
                    Some(block) => block * part,
                    None => blocks.get(&(other, pose)).map_or(Vector3::zeros(), |block| block.transpose() * part),
                };
            }
            assert!((left - pulled).amax() < 1e-5 * (1.0 + pulled.amax()), "{pose}");
        }
    }
}
