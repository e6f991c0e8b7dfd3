//! The values by which an arrangement's faces are compared: the columns of `benches/faces_geos.py`.

use enfilade::geometry::arrangement::{Arrangement, Face};
use enfilade::geometry::{Point, Segment};

use super::families::Ends;

/// The segments in metres.
pub fn in_metres(ends: &[Ends]) -> Vec<Segment> {
    let metres = |steps: i32| f64::from(steps) / 1e4;
    ends.iter()
        .map(|&[ax, ay, bx, by]| Segment::new(Point::new(metres(ax), metres(ay)), Point::new(metres(bx), metres(by))))
        .collect()
}

/// Faces, holes, doubled area in square steps, and the two sums, as in the reference.
pub fn summary(arrangement: &Arrangement, faces: &[Face]) -> String {
    let holes: usize = faces.iter().map(|face| face.holes.len()).sum();
    let areas: Vec<Vec<i64>> =
        faces.iter().map(|face| vec![i64::try_from(face.doubled_area_steps(arrangement)).unwrap()]).collect();
    let total: i64 = areas.iter().flatten().sum();
    let rings = faces
        .iter()
        .map(|face| {
            let mut holes: Vec<_> = face.holes.iter().map(|hole| bent_ring(arrangement, hole)).collect();
            holes.sort();
            std::iter::once(bent_ring(arrangement, &face.outer))
                .chain(holes)
                .flat_map(|ring| std::iter::once(ring.len() as i64).chain(ring.into_iter().flatten()))
                .collect()
        })
        .collect();
    format!("{},{holes},{total},{:016x},{:016x}", faces.len(), fnv(areas), fnv(rings))
}

/// A ring's points in steps of the grid, less those in the middle of a straight piece, from the
/// smallest.
fn bent_ring(arrangement: &Arrangement, ring: &[u32]) -> Vec<[i64; 2]> {
    let points: Vec<[i64; 2]> = arrangement
        .positions(ring)
        .iter()
        .map(|point| [point.x, point.y].map(|metres| (metres * 1e4).round() as i64))
        .collect();
    let n = points.len();
    let mut bent: Vec<[i64; 2]> = (0..n)
        .filter(|&i| {
            let ([px, py], [x, y], [nx, ny]) = (points[(i + n - 1) % n], points[i], points[(i + 1) % n]);
            (x - px) * (ny - y) != (y - py) * (nx - x)
        })
        .map(|i| points[i])
        .collect();
    let smallest = (0..bent.len()).min_by_key(|&i| bent[i]).unwrap();
    bent.rotate_left(smallest);
    bent
}

/// 64-bit FNV-1a over the sorted items.
fn fnv(mut items: Vec<Vec<i64>>) -> u64 {
    items.sort();
    items
        .iter()
        .flatten()
        .flat_map(|value| value.to_le_bytes())
        .fold(0xcbf2_9ce4_8422_2325, |sum, byte| (sum ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3))
}
