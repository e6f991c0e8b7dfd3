//! Areas made of several pieces with holes: union, difference, offsetting.

use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::simplify::SimplifyShape as _;
use i_overlay::float::single::SingleFloatOverlay as _;
use i_overlay::mesh::float::outline::offset::OutlineOffset as _;
use i_overlay::mesh::float::style::{LineJoin, OutlineStyle};

use super::{Point, polygon};

/// A ring in the polygon library's format.
pub type Ring = Vec<[f64; 2]>;
/// Polygons, each an outer ring (counter-clockwise) and its holes (clockwise).
pub type Shapes = Vec<Vec<Ring>>;

/// Joints are mitred down to this angle in radians (30 degrees); sharper ones are cut off.
pub const SHARPEST_RAD: f64 = std::f64::consts::PI / 6.0;

/// `shapes` minus the given rings: counter-clockwise ones are areas, clockwise ones holes in them.
pub fn without(shapes: Shapes, cuts: &[Ring]) -> Shapes {
    if cuts.is_empty() || shapes.is_empty() {
        return shapes;
    }
    shapes.overlay(&cuts, OverlayRule::Difference, FillRule::NonZero)
}

/// Points as a counter-clockwise ring.
pub fn ring(points: &[Point]) -> Ring {
    directed(points, true)
}

/// Points as a ring with the given orientation.
pub fn directed(points: &[Point], counter_clockwise: bool) -> Ring {
    let ring = points.iter().map(|point| [point.x, point.y]);
    if (polygon::signed_area(points) >= 0.0) == counter_clockwise { ring.collect() } else { ring.rev().collect() }
}

/// A ring as points.
pub fn points(ring: &Ring) -> Vec<Point> {
    ring.iter().map(|&[x, y]| Point::new(x, y)).collect()
}

/// Offsets shapes by a distance in metres: outwards, or inwards when negative.
pub fn offset(shapes: &Shapes, by_m: f64) -> Shapes {
    without_slivers(&shapes.outline(&OutlineStyle::new(by_m).line_join(LineJoin::Miter(SHARPEST_RAD))))
}

/// Morphological opening: shapes without parts narrower than twice a distance in metres (shrunk, then
/// grown back).
pub fn opening(shapes: &Shapes, by_m: f64) -> Shapes {
    offset(&offset(&without_slivers(shapes), -by_m), by_m)
}

/// A room's rings inset by a distance in metres: pieces with their holes, none if nothing is left.
pub fn inset(outer: &[Point], holes: &[Vec<Point>], by_m: f64) -> Vec<(Vec<Point>, Vec<Vec<Point>>)> {
    let ring = |ring: &Vec<Point>| -> Ring { ring.iter().map(|point| [point.x, point.y]).collect() };
    let shape: Vec<Ring> = std::iter::once(&outer.to_vec()).chain(holes).map(ring).collect();
    let shapes = shape.simplify_shape(FillRule::EvenOdd);
    pieces(&offset(&shapes, -by_m))
}

/// The pieces of shapes as points: outer rings, each with its holes.
pub fn pieces(shapes: &Shapes) -> Vec<(Vec<Point>, Vec<Vec<Point>>)> {
    let piece = |shape: &Vec<Ring>| {
        let (outer, holes) = shape.split_first()?;
        Some((points(outer), holes.iter().map(points).collect()))
    };
    shapes.iter().filter_map(piece).collect()
}

/// Removes rounding slivers: points within a millimetre of the previous one, and rings under 10 cm².
/// Grown again, such a sliver would become a spur as long as its mitre.
pub fn without_slivers(shapes: &Shapes) -> Shapes {
    let clean_ring = |ring: &Ring| {
        let mut kept = points(ring);
        kept.dedup_by(|next, point| next.distance(*point) < 1e-3);
        while kept.len() > 2 && kept[0].distance(kept[kept.len() - 1]) < 1e-3 {
            kept.pop();
        }
        let is_kept = kept.len() >= 3 && polygon::signed_area(&kept).abs() >= 1e-3;
        is_kept.then(|| kept.iter().map(|point| [point.x, point.y]).collect::<Ring>())
    };
    let clean_shape = |shape: &Vec<Ring>| {
        let (outer, holes) = shape.split_first()?;
        Some(std::iter::once(clean_ring(outer)?).chain(holes.iter().filter_map(clean_ring)).collect())
    };
    shapes.iter().filter_map(clean_shape).collect()
}

/// Area of all pieces in m².
pub fn area_m2(shapes: &Shapes) -> f64 {
    shapes.iter().flatten().map(|ring| polygon::signed_area(&points(ring))).sum::<f64>().abs()
}
