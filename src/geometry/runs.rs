//! Wall runs: maximal chains of collinear boundary pieces (the paper's walls of a room), and the axes
//! ratio derived from them (paper, section 3.3).

use super::{GRID_M, Point, Vector, polygon};

/// Directions within this angle count as parallel or perpendicular: the paper's threshold for collinear
/// line segments (section 3.3).
pub const ANGLE_TOLERANCE_RAD: f64 = 10.0 * std::f64::consts::PI / 180.0;

/// Boundary pieces shorter than this are digitising noise (a notch of a fraction of a millimetre where
/// two polygons were joined), not corners of a room. One centimetre is less than a layer of plaster and
/// more than any rounding seen in real files.
pub const NOTCH_M: f64 = 0.01;

/// A jog of up to this length does not end a run that continues in the same direction after it: two
/// centimetres are a pixel of a traced plan or a layer of plaster, and nobody would call the two parts
/// two walls.
pub const JOG_M: f64 = 0.02;

/// A run shorter than this is not a wall of the room: partitions are about that thick. It keeps a bedroom's
/// clipped corner of 2.2 cm from being its minor axis. Of 7,392 real rooms only that one changes: in all
/// others the shortest run used as `m` is 0.16 m long.
pub const SHORTEST_WALL_M: f64 = 0.1;

/// A wall of a room in the paper's sense.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Run {
    /// Where the run starts, following its ring.
    pub start: Point,
    /// Where it ends.
    pub end: Point,
}

impl Run {
    pub fn vector(self) -> Vector {
        self.end - self.start
    }

    /// Straight length from start to end in metres.
    pub fn length_m(self) -> f64 {
        self.vector().length()
    }
}

/// The wall runs of a ring, in its order.
///
/// A piece joins the run as long as it stays within [`ANGLE_TOLERANCE_RAD`] of the run's direction, which
/// is that of its chord: so a circle drawn with many short pieces does not become one run. A jog of up to
/// [`JOG_M`] is skipped if the run continues after it. The walk starts after the sharpest turn, which makes
/// the result independent of where the ring begins.
pub fn runs(ring: &[Point]) -> Vec<Run> {
    let ring = without_notches(ring);
    let n = ring.len();
    if n < 2 {
        return Vec::new();
    }
    let corner = |i: usize| ring[i % n];
    let piece = |i: usize| corner(i + 1) - corner(i);
    let is_long = |i: usize| !is_jog(piece(i));
    // Turns that differ only by rounding must not decide: compare on a grid of a microradian, and break
    // ties by the longest following piece. The walk must not start at a jog, which turns sharply too.
    let sharpness = |i: usize| {
        let turn = turn_rad(piece(i + n - 1), piece(i));
        let is_between_walls = is_long(i) && is_long(i + n - 1);
        let (turn, length) = ((turn * 1e6).round() as i64, (piece(i).length() * 1e6).round() as i64);
        (is_between_walls, turn, length, std::cmp::Reverse(i))
    };
    let start = (0..n).max_by_key(|&i| sharpness(i)).unwrap_or(0);
    let mut runs: Vec<Run> = Vec::new();
    let mut i = 0;
    while i < n {
        let first = start + i;
        let mut run = Run { start: corner(first), end: corner(first + 1) };
        let goes_on = |run: Run, i: usize| i < n && turn_rad(run.vector(), piece(start + i)) <= ANGLE_TOLERANCE_RAD;
        i += 1;
        loop {
            if !goes_on(run, i) {
                if !is_long(first) {
                    break;
                }
                let behind = (i..n).find(|&next| !is_jog(corner(start + next + 1) - run.end)).unwrap_or(n);
                if behind == i || !goes_on(run, behind) || !is_long(start + behind) {
                    break;
                }
                i = behind;
            }
            run.end = corner(start + i + 1);
            i += 1;
        }
        runs.push(run);
    }
    runs
}

/// Whether a piece of a boundary is too short to end a run.
fn is_jog(piece: Vector) -> bool {
    // Rounding to the grid moves both its ends.
    piece.length() <= JOG_M + GRID_M / 2.0
}

/// The angle in radians between two directions, in 0..=π.
fn turn_rad(from: Vector, to: Vector) -> f64 {
    from.cross(to).abs().atan2(from.dot(to))
}

/// The ring without points closer than [`NOTCH_M`] to the last one kept.
pub fn without_notches(ring: &[Point]) -> Vec<Point> {
    let mut kept: Vec<Point> = Vec::with_capacity(ring.len());
    for &point in ring {
        if kept.last().is_none_or(|last| last.distance(point) >= NOTCH_M) {
            kept.push(point);
        }
    }
    while kept.len() > 1 && kept[0].distance(kept[kept.len() - 1]) < NOTCH_M {
        kept.pop();
    }
    kept
}

/// The major and minor axes of a room and where they came from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axes {
    /// `M`: the longest wall run in metres.
    pub major_m: f64,
    /// `m`: the longest wall run perpendicular to it, or the room's extent in that direction.
    pub minor_m: f64,
    /// Whether `m` is an extent, because no run is perpendicular to `M`.
    pub minor_is_extent: bool,
    /// The run that is as long as `M`.
    pub major: Run,
    /// The run that is as long as `m`, or a line across the room where `m` is an extent.
    pub minor: Run,
}

impl Axes {
    /// `rt = M / m` (paper, section 3.2); above zero, may be below 1.
    pub fn ratio(self) -> f64 {
        self.major_m / self.minor_m
    }
}

/// The axes of a room from its rings (outer first): `M` is the longest wall run, `m` the longest run
/// perpendicular to `M` within [`ANGLE_TOLERANCE_RAD`] and at least [`SHORTEST_WALL_M`] long, or else the
/// extent of the outer ring perpendicular to `M`. `None` if the rings enclose no area.
///
/// When several runs tie for `M` (a square with one clipped corner, say), the one with the longest `m` is
/// taken, so that the result does not depend on the ring's first corner.
pub fn axes<R: AsRef<[Point]>>(outer: &[Point], holes: &[R]) -> Option<Axes> {
    if polygon::signed_area(outer).abs() < 1e-9 {
        return None;
    }
    let mut all = runs(outer);
    for hole in holes {
        all.extend(runs(hole.as_ref()));
    }
    let longest = all.iter().map(|run| run.length_m()).fold(0.0, f64::max);
    if longest <= 0.0 {
        return None;
    }
    // Equal to within a millimetre: the 0.1 mm grid moves both ends of a rotated wall a little.
    let candidates = all.iter().filter(|run| run.length_m() >= longest - 1e-3);
    candidates
        .map(|run| {
            let perpendicular = all
                .iter()
                .filter(|other| {
                    let turn = turn_rad(run.vector(), other.vector());
                    (turn - std::f64::consts::FRAC_PI_2).abs() <= ANGLE_TOLERANCE_RAD
                })
                .reduce(|longest, other| if other.length_m() > longest.length_m() { other } else { longest });
            let axes = |minor: Run, minor_m: f64, minor_is_extent: bool| Axes {
                major_m: run.length_m(),
                minor_m,
                minor_is_extent,
                major: *run,
                minor,
            };
            match perpendicular.filter(|minor| minor.length_m() >= SHORTEST_WALL_M) {
                Some(minor) => axes(*minor, minor.length_m(), false),
                None => {
                    let across = run.vector().left();
                    axes(across_ring(outer, across), extent_m(outer, across), true)
                }
            }
        })
        .filter(|axes| axes.minor_m > 0.0)
        .max_by(|p, q| {
            (!p.minor_is_extent, p.minor_m)
                .partial_cmp(&(!q.minor_is_extent, q.minor_m))
                .unwrap_or(std::cmp::Ordering::Equal)
        })
}

/// How far a ring extends along a direction, in metres.
fn extent_m(ring: &[Point], direction: Vector) -> f64 {
    let Some(unit) = direction.unit() else { return 0.0 };
    let Some(&origin) = ring.first() else { return 0.0 };
    let (mut least, mut most) = (0.0_f64, 0.0_f64);
    for &point in ring {
        let along = (point - origin).dot(unit);
        least = least.min(along);
        most = most.max(along);
    }
    most - least
}

/// The line along a direction, from the point of a ring that lies first in it, as long as the ring extends.
fn across_ring(ring: &[Point], direction: Vector) -> Run {
    let along = |unit: Vector, point: Point| (point - Point::default()).dot(unit);
    let (Some(unit), Some(&first)) = (direction.unit(), ring.first()) else {
        return Run { start: Point::default(), end: Point::default() };
    };
    let start = ring.iter().copied().fold(first, |p, q| if along(unit, q) < along(unit, p) { q } else { p });
    Run { start, end: start + unit * extent_m(ring, direction) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring(points: &[(f64, f64)]) -> Vec<Point> {
        points.iter().map(|&(x, y)| Point::new(x, y)).collect()
    }

    const NO_HOLES: [Vec<Point>; 0] = [];

    #[test]
    fn extra_points_on_a_wall_do_not_end_a_run() {
        let plain = ring(&[(0.0, 0.0), (6.0, 0.0), (6.0, 3.0), (0.0, 3.0)]);
        let split = ring(&[(2.0, 0.0), (4.0, 0.0), (6.0, 0.0), (6.0, 1.0), (6.0, 3.0), (0.0, 3.0), (0.0, 0.0)]);
        for outer in [plain, split] {
            let axes = axes(&outer, &NO_HOLES).expect("a rectangle has axes");
            assert_eq!((axes.major_m, axes.minor_m, axes.minor_is_extent), (6.0, 3.0, false));
            assert_eq!(axes.ratio(), 2.0);
            assert_eq!(runs(&outer).len(), 4);
        }
    }

    #[test]
    fn triangle_without_perpendicular_takes_the_extent() {
        let outer = ring(&[(0.0, 0.0), (4.0, 0.0), (2.0, 3.0)]);
        let axes = axes(&outer, &NO_HOLES).expect("a triangle has axes");
        assert_eq!((axes.major_m, axes.minor_m, axes.minor_is_extent), (4.0, 3.0, true));
    }

    #[test]
    fn a_round_room_is_many_runs() {
        let circle: Vec<Point> = (0..72)
            .map(|i| Point::default() + Vector::new(5.0, 0.0).rotated(f64::from(i) * std::f64::consts::TAU / 72.0))
            .collect();
        let runs = runs(&circle);
        assert!(runs.len() > 8, "{}", runs.len());
    }

    #[test]
    fn a_notch_below_a_centimetre_is_not_a_corner() {
        let outer =
            ring(&[(0.0, 0.0), (3.0, 0.0), (3.0004, -0.0004), (3.0008, 0.0), (8.0, 0.0), (8.0, 4.0), (0.0, 4.0)]);
        assert_eq!(axes(&outer, &NO_HOLES).expect("has axes").major_m, 8.0);
    }

    #[test]
    fn a_step_of_two_centimetres_does_not_end_a_wall() {
        // Both long walls have one, so that neither tells the room's length alone.
        for step_m in [0.02, -0.02, 0.005] {
            let outer = ring(&[
                (0.0, 0.0),
                (2.5, 0.0),
                (2.5, step_m),
                (6.0, step_m),
                (6.0, 4.0),
                (3.0, 4.0),
                (3.0, 4.0 - step_m),
                (0.0, 4.0 - step_m),
            ]);
            for first in 0..outer.len() {
                let mut outer = outer.clone();
                outer.rotate_left(first);
                let axes = axes(&outer, &NO_HOLES).expect("has axes");
                assert!((axes.major_m - 6.0).abs() < 1e-3, "{axes:?} from corner {first}, {step_m} m");
                assert!((axes.minor_m - 4.0).abs() < 0.03, "{axes:?} from corner {first}, {step_m} m");
                assert_eq!(runs(&outer).len(), 4);
            }
        }
        // A pier of 20 cm does.
        let pier = ring(&[(0.0, 0.0), (2.5, 0.0), (2.5, 0.2), (6.0, 0.2), (6.0, 4.0), (0.0, 4.0)]);
        assert_eq!(runs(&pier).len(), 6);
    }

    /// A real bedroom (turned into round numbers) with one slanted wall, to which nothing but a cut corner of
    /// 2.2 cm is perpendicular.
    #[test]
    fn a_cut_corner_is_no_axis() {
        let outer = ring(&[
            (4.48, 3.36),
            (4.48, 4.46),
            (0.892, 4.46),
            (0.8733, 4.449),
            (2.4311, 0.845),
            (2.8638, 0.845),
            (2.8638, 1.41),
            (4.48, 1.41),
        ]);
        let axes = axes(&outer, &NO_HOLES).expect("has axes");
        assert!(axes.minor_is_extent, "{axes:?}");
        assert!((1.1..1.3).contains(&axes.ratio()), "{axes:?}");
        // A small room, drawn in another unit, keeps its sides: the extent is its side.
        let small = ring(&[(0.0, 0.0), (0.09, 0.0), (0.09, 0.06), (0.0, 0.06)]);
        let small = super::axes(&small, &NO_HOLES).expect("has axes");
        assert!((small.ratio() - 1.5).abs() < 1e-9, "{small:?}");
    }

    #[test]
    fn what_encloses_nothing_has_no_axes() {
        assert_eq!(axes(&[], &NO_HOLES), None);
        assert_eq!(axes(&ring(&[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0)]), &NO_HOLES), None);
    }
}
