//! The intersection and difference of two areas.

use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay::Overlay;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::i_float::int::point::IntPoint;

use crate::geometry::COORDINATE_LIMIT_M;
use crate::geometry::{Bounds, Point, polygon};

/// An area, summarised by the thickness and position of its thickest piece and the total area.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Region {
    pub area_m2: f64,
    /// Thickness in metres of the thickest piece, see [`thickness_m`].
    pub depth_m: f64,
    /// The middle of that piece.
    pub at: Point,
}

/// The intersection of two areas, given by their rings; `None` if it is empty or too complex to compute
/// (see [`CROSSINGS_LIMIT`]). Neither area may cross itself excessively.
pub fn shared<'a>(
    one: impl IntoIterator<Item = &'a Vec<Point>>,
    other: impl IntoIterator<Item = &'a Vec<Point>>,
) -> Option<Region> {
    overlay(one, other, OverlayRule::Intersect)
}

/// The part of the first area outside the second; `None` as for [`shared`].
pub fn outside<'a>(
    one: impl IntoIterator<Item = &'a Vec<Point>>,
    other: impl IntoIterator<Item = &'a Vec<Point>>,
) -> Option<Region> {
    overlay(one, other, OverlayRule::Difference)
}

/// Grid steps per metre for clipping areas: a hundred to each step of the corners' 0.1 mm grid, so that
/// rounding the corners of what is cut out does not show.
const STEPS_PER_M: f64 = 1e6;

/// The furthest two points of a plan can be apart, in metres: a plan reaches [`COORDINATE_LIMIT_M`] in
/// each direction.
const FARTHEST_M: f64 = 2.0 * COORDINATE_LIMIT_M;

fn overlay<'a>(
    one: impl IntoIterator<Item = &'a Vec<Point>>,
    other: impl IntoIterator<Item = &'a Vec<Point>>,
    rule: OverlayRule,
) -> Option<Region> {
    let (one, other): (Vec<_>, Vec<_>) = (one.into_iter().collect(), other.into_iter().collect());
    let origin = *one.first()?.first()?;
    if crossings_bound(&one, &other) > CROSSINGS_LIMIT {
        return None;
    }
    let (one, other) = (on_grid(&one, origin)?, on_grid(&other, origin)?);
    let mut all: Option<Region> = None;
    for shape in Overlay::<i64>::from_subj_and_clip(&one, &other).overlay(rule, FillRule::EvenOdd) {
        let point = |point: &IntPoint<i64>| {
            Point::new(origin.x + point.x as f64 / STEPS_PER_M, origin.y + point.y as f64 / STEPS_PER_M)
        };
        let rings: Vec<Vec<Point>> = shape.iter().map(|ring| ring.iter().map(point).collect()).collect();
        let Some((outer, holes)) = rings.split_first() else { continue };
        let area_m2 = polygon::area(outer, holes);
        let depth_m = thickness_m(area_m2, rings.iter().map(|ring| polygon::perimeter(ring)).sum());
        let region = all.get_or_insert(Region { area_m2: 0.0, depth_m: -1.0, at: Point::default() });
        region.area_m2 += area_m2;
        if depth_m > region.depth_m {
            (region.depth_m, region.at) = (depth_m, polygon::centroid(outer));
        }
    }
    all
}

/// Areas whose edges may cross more often than this are not clipped: two combs of 50,000 teeth would give
/// more pieces than fit in memory. Rooms have at most a few hundred edges, so stay below 10^5.
const CROSSINGS_LIMIT: usize = 10_000_000;

/// An upper bound on how often the edges of two areas cross: only edges within both bounding boxes can.
fn crossings_bound(one: &[&Vec<Point>], other: &[&Vec<Point>]) -> usize {
    let bounds =
        |rings: &[&Vec<Point>]| rings.iter().fold(Bounds::EMPTY, |bounds, ring| bounds.union(polygon::bounds(ring)));
    let (bounds_one, bounds_other) = (bounds(one), bounds(other));
    let within = |rings: &[&Vec<Point>], other: Bounds| {
        let edges = rings.iter().flat_map(|ring| polygon::edges(ring));
        edges.filter(|edge| edge.bounds().intersects(other)).count()
    };
    within(one, bounds_other).saturating_mul(within(other, bounds_one))
}

/// Rings in grid steps from `origin`; `None` if a point is not within [`FARTHEST_M`] of it, which the
/// invariants rule out.
fn on_grid(rings: &[&Vec<Point>], origin: Point) -> Option<Vec<Vec<IntPoint<i64>>>> {
    let step = |length_m: f64| (length_m.abs() <= FARTHEST_M).then(|| (length_m * STEPS_PER_M).round() as i64);
    let point = |point: &Point| Some(IntPoint::new(step(point.x - origin.x)?, step(point.y - origin.y)?));
    rings.iter().map(|ring| ring.iter().map(point).collect()).collect()
}

/// The thickness of a piece in metres: the shorter side of the rectangle with its area and perimeter. For
/// a strip along several walls of a room this is the strip's width, whereas the width of its hull would
/// be the room's; for a compact piece that no rectangle matches, the square's side.
pub fn thickness_m(area_m2: f64, perimeter_m: f64) -> f64 {
    let half = perimeter_m / 2.0;
    let discriminant = half * half - 4.0 * area_m2;
    if discriminant <= 0.0 {
        return area_m2.max(0.0).sqrt();
    }
    // The smaller root of x² - half x + area, in the form that stays accurate for thin strips.
    2.0 * area_m2 / (half + discriminant.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rectangle(x: f64, y: f64, width: f64, height: f64) -> Vec<Point> {
        [(x, y), (x + width, y), (x + width, y + height), (x, y + height)].map(|(x, y)| Point::new(x, y)).to_vec()
    }

    #[test]
    fn a_strip_has_its_width_as_depth() {
        let region = shared([&rectangle(0.0, 0.0, 5.0, 4.0)], [&rectangle(4.8, 0.0, 5.0, 4.0)]).expect("they overlap");
        assert!((region.area_m2 - 0.8).abs() < 1e-6, "{region:?}");
        assert!((region.depth_m - 0.2).abs() < 1e-6, "{region:?}");
        assert!(region.at.distance(Point::new(4.9, 2.0)) < 1e-6, "{region:?}");
    }

    #[test]
    fn a_strip_round_a_corner_has_its_width_as_depth() {
        // Two rooms, one offset from the other's notch by 10 cm in both directions.
        let angle = [(0.0, 0.0), (5.0, 0.0), (5.0, 0.1), (0.1, 0.1), (0.1, 4.0), (0.0, 4.0)];
        let angle: Vec<Point> = angle.map(|(x, y)| Point::new(x, y)).to_vec();
        let region = shared([&angle], [&rectangle(-1.0, -1.0, 9.0, 9.0)]).expect("they overlap");
        assert!((region.depth_m - 0.1).abs() < 0.01, "{region:?}");
    }

    #[test]
    fn what_only_touches_shares_nothing() {
        let left = rectangle(0.0, 0.0, 5.0, 4.0);
        assert_eq!(shared([&left], [&rectangle(5.0, 0.0, 5.0, 4.0)]), None);
        assert_eq!(outside([&rectangle(1.0, 1.0, 1.0, 1.0)], [&left]), None);
        assert!(outside([&rectangle(4.5, 1.0, 1.0, 1.0)], [&left]).is_some_and(|region| region.area_m2 > 0.49));
    }
}
