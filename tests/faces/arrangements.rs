use std::collections::{BTreeMap, BTreeSet};

use enfilade::geometry::arrangement::{Arrangement, ArrangementError, Face, faces};
use enfilade::geometry::polygon::{Location, locate};
use enfilade::geometry::{Point, Segment};
use proptest::prelude::*;

use super::families::{self, Ends, FAMILIES, Random};
use super::sums::{in_metres, summary};

/// Faces as GEOS finds them, ring by ring; see the head of the file for how it was made.
#[test]
fn faces_are_those_of_geos() {
    let reference = include_str!("reference.csv");
    let mut compared = 0;
    for row in reference.lines().filter(|line| !line.starts_with(['#', 'f'])) {
        let (name, rest) = row.split_once(',').unwrap();
        let (count, expected) = rest.split_once(',').unwrap();
        let family = FAMILIES.iter().find(|family| family.name == name).unwrap();
        let ends = families::segments(family, count.parse().unwrap());
        let arrangement = Arrangement::new(&in_metres(&ends)).unwrap();
        assert_eq!(summary(&arrangement, &faces(&arrangement)), expected, "{name} {count}");
        compared += 1;
    }
    assert!(compared >= 2 * FAMILIES.len(), "{compared} rows");
}

/// The faces' areas in m², sorted, each with its number of holes.
fn areas(segments: &[Segment]) -> Vec<(f64, usize)> {
    let arrangement = Arrangement::new(segments).unwrap();
    let mut areas: Vec<(f64, usize)> =
        faces(&arrangement).iter().map(|face| (face.area_m2(&arrangement), face.holes.len())).collect();
    areas.sort_by(|p, q| p.partial_cmp(q).unwrap());
    areas
}

fn segment(ax: f64, ay: f64, bx: f64, by: f64) -> Segment {
    Segment::new(Point::new(ax, ay), Point::new(bx, by))
}

fn square(x: f64, y: f64, side: f64) -> [Segment; 4] {
    [
        segment(x, y, x + side, y),
        segment(x + side, y, x + side, y + side),
        segment(x + side, y + side, x, y + side),
        segment(x, y + side, x, y),
    ]
}

#[test]
fn nothing_encloses_nothing() {
    assert_eq!(areas(&[]), []);
    assert_eq!(areas(&[segment(1.0, 1.0, 1.0, 1.0)]), []);
    assert_eq!(areas(&[segment(0.0, 0.0, 1.0, 1.0), segment(0.0, 1.0, 1.0, 0.0)]), []);
    assert_eq!(areas(&square(0.0, 0.0, 2.0)[..3]), []);
}

#[test]
fn islands_become_holes_and_have_faces_of_their_own() {
    let mut segments = square(0.0, 0.0, 10.0).to_vec();
    // An island in an island, one that touches the outer ring in a corner, one beside a bridge, and
    // one outside of everything.
    segments.extend(square(1.0, 1.0, 4.0));
    segments.extend(square(2.0, 2.0, 1.0));
    segments.extend([
        segment(10.0, 10.0, 8.0, 9.0),
        segment(8.0, 9.0, 9.0, 8.0),
        segment(9.0, 8.0, 10.0, 10.0),
        segment(8.0, 9.0, 6.0, 9.0),
    ]);
    segments.extend(square(20.0, 3.0, 1.0));
    assert_eq!(areas(&segments), [(1.0, 0), (1.0, 0), (1.5, 0), (15.0, 1), (82.5, 2)]);
}

#[test]
fn dangling_ends_and_bridges_bound_nothing() {
    let mut segments = square(0.0, 0.0, 10.0).to_vec();
    segments.extend(square(4.0, 4.0, 2.0));
    // A bridge from the island to the outer ring, a branch of it, and an end that goes on outside.
    segments.extend([segment(6.0, 5.0, 10.0, 5.0), segment(8.0, 5.0, 8.0, 8.0), segment(0.0, 0.0, -3.0, 0.0)]);
    let arrangement = Arrangement::new(&segments).unwrap();
    let found = faces(&arrangement);
    assert_eq!(areas(&segments), [(4.0, 0), (96.0, 1)]);
    assert!(found.iter().all(|face| face.outer.len() == 5 || face.outer.len() == 4), "nodes of bridges stay on rings");
}

#[test]
fn overlapping_and_repeated_segments_count_once() {
    let mut segments = square(0.0, 0.0, 4.0).to_vec();
    segments.extend(square(4.0, 0.0, 4.0));
    segments.extend([segment(-1.0, 0.0, 9.0, 0.0), segment(4.0, 1.0, 4.0, 3.0), segment(4.0, 5.0, 4.0, 2.0)]);
    assert_eq!(areas(&segments), [(16.0, 0), (16.0, 0)]);
    let arrangement = Arrangement::new(&segments).unwrap();
    let chain = arrangement.positions(&arrangement.chain(8));
    assert_eq!(chain.iter().map(|point| point.x).collect::<Vec<_>>(), [-1.0, 0.0, 4.0, 8.0, 9.0]);
    let chain = arrangement.positions(&arrangement.chain(10));
    assert_eq!(chain.iter().map(|point| point.y).collect::<Vec<_>>(), [5.0, 4.0, 3.0, 2.0]);
}

#[test]
fn input_beyond_the_drawing_area_is_refused_with_its_place() {
    for bad in [f64::NAN, f64::INFINITY, 100_000.1, -1e300] {
        let error = Arrangement::new(&[segment(0.0, 0.0, 1.0, 1.0), segment(0.0, 0.0, bad, 0.0)]).unwrap_err();
        assert_eq!(error, ArrangementError::OutOfRange(1));
        assert!(error.to_string().contains("line 1"));
    }
    let limit = 100_000.0;
    assert_eq!(areas(&square(-limit, -limit, 2.0 * limit)), [(4e10, 0)]);
}

/// Input built to be slow: each takes well under a second even without optimisation, and would take
/// minutes if pairs were tested all with all.
#[test]
fn long_collinear_parallel_and_concurrent_lines_stay_fast() {
    let n = 20_000;
    let step = |i: i32| f64::from(i) * 1e-3;
    let end = step(n);
    let diagonal = (0..n).map(|i| segment(step(i), 0.0, 1_000.0 + step(i), 777.0)).collect::<Vec<_>>();
    let on_a_line = (0..n).map(|i| segment(step(i), 2.0 * step(i), end + step(i), 2.0 * (end + step(i)))).collect();
    let mut with_outlier: Vec<Segment> = (0..n).map(|i| segment(0.0, step(i), 300.0, step(i) + 0.01)).collect();
    with_outlier.push(segment(-99_000.0, -99_000.0, 99_000.0, -98_000.0));
    for (segments, edges) in [(diagonal, n), (on_a_line, 2 * n - 1), (with_outlier, n + 1)] {
        let arrangement = Arrangement::new(&segments).unwrap();
        assert_eq!(arrangement.edges().len(), edges as usize);
        assert_eq!(faces(&arrangement), []);
    }
    // All from one corner, and a wall around them.
    let fan = 2_000;
    let mut segments = square(-10.0, -10.0, 20.0).to_vec();
    segments.extend((0..fan).map(|i| {
        let at = f64::from(i - fan / 2) * 0.01;
        segment(0.0, 0.0, 10.0, at)
    }));
    let arrangement = Arrangement::new(&segments).unwrap();
    assert_eq!(faces(&arrangement).len(), fan as usize);
}

/// Whether a point in doubled steps lies on neither side of an edge and between its ends, both
/// excluded.
fn inside_edge([a, b]: [[i64; 2]; 2], p: [i64; 2]) -> bool {
    side([a, b], p) == 0 && p != a && p != b && (a.min(b) < p && p < a.max(b))
}

fn side([a, b]: [[i64; 2]; 2], p: [i64; 2]) -> i64 {
    ((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])).signum()
}

fn check_arrangement(segments: &[Segment], arrangement: &Arrangement) {
    let nodes: Vec<[i64; 2]> = (0..arrangement.node_count() as u32)
        .map(|node| arrangement.position(node))
        .map(|point| [point.x, point.y].map(|metres| (metres * 1e4).round() as i64))
        .collect();
    let edges: Vec<[[i64; 2]; 2]> =
        arrangement.edges().iter().map(|edge| edge.map(|node| nodes[node as usize])).collect();
    for (i, &edge) in edges.iter().enumerate() {
        assert!(!nodes.iter().any(|&node| inside_edge(edge, node)), "a node lies on an edge");
        for &other in &edges[..i] {
            let crosses =
                side(edge, other[0]) * side(edge, other[1]) < 0 && side(other, edge[0]) * side(other, edge[1]) < 0;
            assert!(!crosses, "{edge:?} crosses {other:?}");
        }
    }
    // The chains run along the segments, from end to end, and make up all edges.
    let mut covered = BTreeSet::new();
    for (i, segment) in segments.iter().enumerate() {
        let chain = arrangement.chain(i);
        covered.extend(chain.windows(2).map(|pair| [pair[0].min(pair[1]), pair[0].max(pair[1])]));
        let points = arrangement.positions(&chain);
        if segment.a == segment.b {
            assert!(chain.is_empty());
            continue;
        }
        assert_eq!((points.first(), points.last()), (Some(&segment.a), Some(&segment.b)));
        assert!(points.iter().all(|&point| segment.distance(point) < 0.75e-4), "a node strays from its segment");
    }
    assert!(covered.iter().eq(arrangement.edges()), "chains and edges differ");
}

fn check_faces(arrangement: &Arrangement, found: &[Face]) {
    // Euler: V - E + F = 1 + C, the unbounded face counted.
    let edges = arrangement.edges();
    let mut root: Vec<u32> = (0..arrangement.node_count() as u32).collect();
    let find = |root: &mut Vec<u32>, mut node: u32| {
        while root[node as usize] != node {
            root[node as usize] = root[root[node as usize] as usize];
            node = root[node as usize];
        }
        node
    };
    let mut components = arrangement.node_count();
    for &[u, v] in edges {
        let (u, v) = (find(&mut root, u), find(&mut root, v));
        if u != v {
            root[u as usize] = v;
            components -= 1;
        }
    }
    assert_eq!(arrangement.node_count() + found.len() + 1, edges.len() + 1 + components);

    let mut sides: BTreeMap<[u32; 2], usize> = BTreeMap::new();
    for (i, face) in found.iter().enumerate() {
        assert!(face.doubled_area_steps(arrangement) > 0);
        for ring in face.rings() {
            assert!(ring.len() >= 3);
            assert_eq!(ring.iter().collect::<BTreeSet<_>>().len(), ring.len(), "a ring passes a node twice");
            for j in 0..ring.len() {
                let taken = sides.insert([ring[j], ring[(j + 1) % ring.len()]], i);
                assert_eq!(taken, None, "two faces on one side of an edge");
            }
        }
    }
    for &[u, v] in edges {
        let both = [sides.get(&[u, v]), sides.get(&[v, u])];
        assert!(both[0].is_none() || both[0] != both[1], "an edge with the same face on both sides bounds it");
    }
    // Disjoint: a point inside one face is in no other. All faces together leave nothing out that
    // the outermost rings enclose, or a hole would be missing.
    let shapes: Vec<_> = found.iter().map(|face| face.positions(arrangement)).collect();
    for (i, face) in found.iter().enumerate() {
        let point = face.interior_point(arrangement);
        let around: Vec<usize> =
            (0..shapes.len()).filter(|&j| locate(&shapes[j].0, &shapes[j].1, point) == Location::Inside).collect();
        assert_eq!(around, [i], "at {point:?}");
    }
}

fn ends(reach: i32, spread: i32, most: usize) -> impl Strategy<Value = Vec<Ends>> {
    let end = move |low: i32, high: i32| (low..=high, low..=high);
    prop::collection::vec((end(0, reach), end(-spread, spread)), 0..most)
        .prop_map(|pairs| pairs.into_iter().map(|((x, y), (dx, dy))| [x, y, x + dx, y + dy]).collect())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn arrangements_are_consistent(
        ends in prop_oneof![ends(12, 12, 25), ends(60, 40, 60), ends(400_000, 100_000, 60), ends(30, 100_000, 60)],
        seed in any::<u64>(),
    ) {
        let segments = in_metres(&ends);
        let arrangement = Arrangement::new(&segments).unwrap();
        check_arrangement(&segments, &arrangement);
        let found = faces(&arrangement);
        check_faces(&arrangement, &found);

        // Shuffled, flipped and moved, the result is the same.
        let mut random = Random(seed);
        let (dx, dy) = (random.within(-90_000_000, 90_000_000), random.within(-90_000_000, 90_000_000));
        let mut changed: Vec<Ends> = ends
            .iter()
            .map(|&[ax, ay, bx, by]| if random.within(0, 1) == 0 { [ax, ay, bx, by] } else { [bx, by, ax, ay] })
            .map(|[ax, ay, bx, by]| [ax + dx, ay + dy, bx + dx, by + dy])
            .collect();
        for i in (1..changed.len()).rev() {
            changed.swap(i, random.within(0, i as i32) as usize);
        }
        let moved = Arrangement::new(&in_metres(&changed)).unwrap();
        prop_assert_eq!(moved.edges(), arrangement.edges());
        prop_assert_eq!(faces(&moved), found);
    }
}
