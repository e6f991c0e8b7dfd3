//! Making a photographed drawing flat: four corners of a rectangle of it say how it was seen.

use crate::edit::{DrawingMoves, EditError, fail, set_backdrop, set_measurements};
use crate::geometry::homography::side_ratio;
use crate::geometry::{Bounds, Homography, Point, Vector};
use crate::plan::{Backdrop, Measurement, Plan, Rectification};

/// The corners lie at least so far apart on the picture, in pixels: a click is no more precise than two.
const SHORTEST_SIDE_PX: f64 = 8.0;

/// How far the picture that is shown reaches beyond the rectangle, in its longer sides: further off a photograph shows
/// nothing that could be traced.
const BEYOND: f64 = 2.0;

/// The most pixels of the picture that is shown, for each pixel of its file.
const MOST_PIXELS: f64 = 2.0;

/// The longest side of the picture that is shown, in pixels.
const LONGEST_SIDE_PX: f64 = 16_000.0;

/// Makes the picture under the plan flat, so that four of its points are the corners of a rectangle with sides along
/// the axes. What is drawn stays.
///
/// `corners`: points of the plan, in any order. `sides_m`: the true width and height of the rectangle, which set the
/// scale as well; without them the ratio is estimated from the picture, and the rectangle stays about as large as it
/// is. `source_px`: width and height of the picture in its file.
///
/// # Errors
/// When there is no picture, the points are no corners of a rectangle seen in perspective, or a side has no length.
pub fn rectify_picture(
    plan: &Plan,
    corners: [Point; 4],
    sides_m: Option<[f64; 2]>,
    source_px: [u32; 2],
) -> Result<Plan, EditError> {
    let Some(backdrop) = plan.backdrop() else { return fail("the plan has no picture under it") };
    if sides_m.is_some_and(|sides| sides.iter().any(|side| !(*side > 0.0 && side.is_finite()))) {
        return fail("the sides of the rectangle are above 0");
    }
    let corners = in_order(corners)?;
    let on_source = corners_on_source(backdrop, corners)?;
    let [upper, right, lower, left] = [0, 1, 2, 3].map(|i| on_source[i].distance(on_source[(i + 1) % 4]));
    if upper.min(right).min(lower).min(left) < SHORTEST_SIDE_PX {
        return fail("the corners are too close together; use a larger rectangle");
    }
    let [width, height] = source_px.map(f64::from);
    let ratio = match sides_m {
        Some([width_m, height_m]) => width_m / height_m,
        None => side_ratio(on_source, Point::new(width / 2.0, height / 2.0)),
    };
    let size = size_of(upper.max(lower), left.max(right), ratio);
    let rectification = framed(on_source, size, source_px)?;
    let rectangle_px = rectification.rectangle[1] - rectification.rectangle[0];
    let mean_m = (corners[0].distance(corners[1]) + corners[3].distance(corners[2])) / 2.0;
    let metres_per_pixel = sides_m.map_or(mean_m, |sides| sides[0]) / rectangle_px.x;
    let mut measurements = measured_on(backdrop, &rectification)?;
    if let Some([width_m, height_m]) = sides_m {
        let [upper_left, upper_right, _, lower_left] = rectification.shown_corners();
        measurements.push(Measurement { from: upper_left, to: upper_right, length_m: width_m });
        measurements.push(Measurement { from: upper_left, to: lower_left, length_m: height_m });
    }
    let middle = corners.iter().fold(Vector::default(), |sum, corner| sum + (*corner - Point::default()) * 0.25);
    let flat = Backdrop {
        metres_per_pixel,
        rotation_rad: 0.0,
        rectification: Some(rectification.clone()),
        measurements: measurements.clone(),
        ..backdrop.clone()
    };
    let mut next = set_backdrop(plan, Some(flat));
    if sides_m.is_some() {
        next = set_measurements(&next, measurements, DrawingMoves::Stays)?;
    }
    // The middle of the rectangle stays in place.
    let Some(flat) = next.backdrop().cloned() else { return Ok(next) };
    let middle_px = rectification.rectangle[0] + rectangle_px * 0.5;
    let origin = Point::default() + middle + Vector::new(-middle_px.x, middle_px.y) * flat.metres_per_pixel;
    let flat = Backdrop { origin, ..flat };
    if let Some(what) = flat.fault() {
        return fail(format!("the picture {what}"));
    }
    Ok(set_backdrop(&next, Some(flat)))
}

/// Shows the picture under the plan as it is in its file, about where it is. What is drawn stays.
///
/// # Errors
/// When it is shown as it is.
pub fn unrectify_picture(plan: &Plan) -> Result<Plan, EditError> {
    let Some((backdrop, rectification)) =
        plan.backdrop().and_then(|backdrop| Some((backdrop, backdrop.rectification.as_ref()?)))
    else {
        return fail("the picture is shown as it is in its file");
    };
    let Some(source_from_shown) = rectification.source_from_shown() else {
        return fail("the corners are no rectangle's");
    };
    let on_source = |point: Point| source_from_shown.apply(point);
    let measurements = backdrop.measurements.iter().filter_map(|one| {
        Some(Measurement { from: on_source(one.from)?, to: on_source(one.to)?, length_m: one.length_m })
    });
    let [upper_left, upper_right, lower_right, _] = rectification.corners;
    let shown_m = (rectification.rectangle[1].x - rectification.rectangle[0].x) * backdrop.metres_per_pixel;
    let metres_per_pixel = shown_m / upper_left.distance(upper_right);
    let middle = upper_left.midpoint(lower_right);
    let middle_m = backdrop.plan_from_picture(rectification.rectangle[0].midpoint(rectification.rectangle[1]));
    let origin = middle_m + Vector::new(-middle.x, middle.y) * metres_per_pixel;
    let measurements = measurements.collect();
    let shown =
        Backdrop { origin, metres_per_pixel, rotation_rad: 0.0, measurements, rectification: None, ..backdrop.clone() };
    match shown.fault() {
        Some(what) => fail(format!("the picture {what}")),
        None => Ok(set_backdrop(plan, Some(shown))),
    }
}

/// Corners from the upper left one on, clockwise.
///
/// # Errors
/// When they are not those of a convex quadrilateral.
pub fn in_order(corners: [Point; 4]) -> Result<[Point; 4], EditError> {
    let middle = corners.iter().fold(Vector::default(), |sum, corner| sum + (*corner - Point::default()) * 0.25);
    let mut around = corners;
    // Clockwise: by falling angle about the middle.
    around.sort_by(|p, q| {
        let angle_rad = |point: &Point| (*point - Point::default() - middle).angle_rad();
        angle_rad(q).total_cmp(&angle_rad(p))
    });
    let turns = [0, 1, 2, 3].map(|i| {
        let [a, b, c] = [around[i], around[(i + 1) % 4], around[(i + 2) % 4]];
        (b - a).cross(c - b) / (a.distance(b) * b.distance(c))
    });
    // A corner that is all but straight is none.
    if !turns.iter().all(|turn| *turn < -0.02) {
        return fail("these are not the corners of a rectangle; click its four corners");
    }
    let upper_left = (0..4).min_by(|&i, &j| {
        let across = |i: usize| around[i].x - around[i].y;
        across(i).total_cmp(&across(j))
    });
    around.rotate_left(upper_left.unwrap_or_default());
    Ok(around)
}

/// Points of the plan on the picture in its file.
fn corners_on_source(backdrop: &Backdrop, corners: [Point; 4]) -> Result<[Point; 4], EditError> {
    let shown = corners.map(|corner| backdrop.picture_from_plan(corner));
    let Some(before) = &backdrop.rectification else { return Ok(shown) };
    let source_from_shown = before.source_from_shown();
    let on_source = |point: Point| source_from_shown.as_ref().and_then(|map| map.apply(point));
    let found: Vec<Point> = shown.iter().filter_map(|&point| on_source(point)).collect();
    found.try_into().map_err(|_| EditError("the corners lie beyond the picture".to_owned()))
}

/// The measurements of a picture on the picture that will be shown.
fn measured_on(backdrop: &Backdrop, after: &Rectification) -> Result<Vec<Measurement>, EditError> {
    let before = match &backdrop.rectification {
        Some(before) => before.source_from_shown(),
        None => None,
    };
    let Some(shown_from_source) = after.source_from_shown().and_then(|map| map.inverse()) else {
        return fail("these are not the corners of a rectangle");
    };
    let moved = |point: Point| {
        let on_source = before.as_ref().map_or(Some(point), |map| map.apply(point))?;
        shown_from_source.apply(on_source)
    };
    let all = backdrop.measurements.iter();
    Ok(all.filter_map(|one| Some(Measurement { from: moved(one.from)?, to: moved(one.to)?, ..one.clone() })).collect())
}

/// Width and height of the rectangle in pixels of the picture that is shown: no side loses pixels.
fn size_of(width_px: f64, height_px: f64, ratio: f64) -> Vector {
    let width = width_px.max(height_px * ratio);
    Vector::new(width, width / ratio)
}

/// The picture to be shown, with a rectangle of a size in it and all that lies around it.
fn framed(corners: [Point; 4], size: Vector, source_px: [u32; 2]) -> Result<Rectification, EditError> {
    let wrong = || EditError("these are not the corners of a rectangle seen in perspective".to_owned());
    let at = |size: Vector| [(0.0, 0.0), (size.x, 0.0), (size.x, size.y), (0.0, size.y)].map(|(x, y)| Point::new(x, y));
    let shown_from_source = Homography::between(corners, at(size)).ok_or_else(wrong)?;
    let whole = Bounds::of(at(size));
    let reach = whole.inflated(BEYOND * size.x.max(size.y));
    let side = shown_from_source.side(corners[0]);
    if corners.iter().any(|&corner| shown_from_source.side(corner) != side) {
        return Err(wrong());
    }
    // What of the picture's edge lies this side of the horizon, and not too far off; beyond, the frame ends.
    let [width, height] = source_px.map(f64::from);
    let edge = (0..=64).flat_map(|i| {
        let share = f64::from(i) / 64.0;
        [(share, 0.0), (share, 1.0), (0.0, share), (1.0, share)].map(|(x, y)| Point::new(x * width, y * height))
    });
    let seen = edge.filter(|&point| shown_from_source.side(point) == side);
    let seen = seen.filter_map(|point| shown_from_source.apply(point));
    let seen = seen.fold(whole, |all, point| all.union(Bounds::of([clamped(point, reach)])));
    let area = seen.width() * seen.height();
    let most = MOST_PIXELS * width * height;
    let longest = seen.width().max(seen.height());
    let scale = (most.max(1.0) / area).sqrt().min(LONGEST_SIDE_PX / longest).min(1.0);
    let (min, max) = (seen.min, seen.max);
    let min = Point::new((min.x * scale).floor(), (min.y * scale).floor());
    let rectangle =
        [Point::default() - (min - Point::default()), Point::default() + (size * scale - (min - Point::default()))];
    let pixels = |from: f64, to: f64| (to * scale - from).ceil().clamp(1.0, 65_535.0) as u32;
    let size_px = [pixels(min.x, max.x), pixels(min.y, max.y)];
    Ok(Rectification { corners, rectangle, size_px })
}

fn clamped(point: Point, bounds: Bounds) -> Point {
    Point::new(point.x.clamp(bounds.min.x, bounds.max.x), point.y.clamp(bounds.min.y, bounds.max.y))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(list: [(f64, f64); 4]) -> [Point; 4] {
        list.map(|(x, y)| Point::new(x, y))
    }

    /// A photograph of 4000 by 3000 pixels, a centimetre each.
    fn photographed() -> Plan {
        let picture = Backdrop { metres_per_pixel: 0.01, ..Backdrop::new("photo.jpg", "") };
        set_backdrop(&Plan::default(), Some(picture))
    }

    const SOURCE_PX: [u32; 2] = [4000, 3000];

    fn seen() -> [Point; 4] {
        points([(10.0, -8.0), (30.0, -7.0), (34.0, -24.0), (6.0, -22.0)])
    }

    #[test]
    fn corners_in_any_order_are_those_of_one_rectangle() {
        let expected = seen();
        for order in [[0, 1, 2, 3], [2, 0, 3, 1], [3, 2, 1, 0], [1, 3, 0, 2]] {
            assert_eq!(in_order(order.map(|i| expected[i])), Ok(expected));
        }
        for wrong in [
            [(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (1.0, 5.0)],
            [(0.0, 0.0), (4.0, 0.0), (2.0, 1.0), (2.0, 4.0)],
            [(0.0, 0.0); 4],
        ] {
            assert!(in_order(points(wrong)).is_err(), "{wrong:?}");
        }
    }

    #[test]
    fn the_rectangle_has_its_sides_and_its_place() {
        let plan = photographed();
        let flat = rectify_picture(&plan, seen(), Some([8.0, 6.0]), SOURCE_PX).expect("it is made flat");
        let backdrop = flat.backdrop().expect("a picture");
        assert_eq!(backdrop.fault(), None);
        let rectification = backdrop.rectification.as_ref().expect("it is flat");
        // The corners in the file are where they were clicked.
        for (corner, expected) in rectification.corners.iter().zip(seen()) {
            assert!(corner.distance(Point::new(expected.x * 100.0, -expected.y * 100.0)) < 1e-6, "{corner:?}");
        }
        let corners = rectification.shown_corners().map(|corner| backdrop.plan_from_picture(corner));
        assert!((corners[0].distance(corners[1]) - 8.0).abs() < 1e-9, "{corners:?}");
        assert!((corners[1].distance(corners[2]) - 6.0).abs() < 1e-9, "{corners:?}");
        assert!((corners[0].y - corners[1].y).abs() < 1e-9 && (corners[1].x - corners[2].x).abs() < 1e-9);
        let middle = corners[0].midpoint(corners[2]);
        let was = seen().iter().fold((0.0, 0.0), |sum, p| (sum.0 + p.x / 4.0, sum.1 + p.y / 4.0));
        assert!(middle.distance(Point::new(was.0, was.1)) < 1e-9, "{middle:?}");
        assert_eq!(backdrop.measurements.len(), 2);
        assert!(u64::from(rectification.size_px[0]) * u64::from(rectification.size_px[1]) <= 24_100_000);
    }

    #[test]
    fn it_can_be_done_again_and_taken_back() {
        let flat = rectify_picture(&photographed(), seen(), None, SOURCE_PX).expect("it is made flat");
        let backdrop = flat.backdrop().expect("a picture");
        let first = backdrop.rectification.clone().expect("it is flat");
        // The same corners once more: where they are now.
        let now = first.shown_corners().map(|corner| backdrop.plan_from_picture(corner));
        let again = rectify_picture(&flat, now, Some([8.0, 6.0]), SOURCE_PX).expect("it is made flat");
        let second = again.backdrop().and_then(|backdrop| backdrop.rectification.clone()).expect("it is flat");
        for (p, q) in first.corners.iter().zip(second.corners) {
            assert!(p.distance(q) < 1e-6, "{p:?} {q:?}");
        }
        let back = unrectify_picture(&again).expect("it is taken back");
        let shown = back.backdrop().expect("a picture");
        assert_eq!((shown.rectification.clone(), shown.fault()), (None, None));
        let measured = &shown.measurements[0];
        assert!(measured.from.distance(first.corners[0]) < 1e-6, "{measured:?}");
        assert!(unrectify_picture(&back).is_err());
    }

    #[test]
    fn what_makes_no_rectangle_is_refused() {
        let plan = photographed();
        let tiny = seen().map(|point| Point::new(point.x * 1e-3, point.y * 1e-3));
        assert!(rectify_picture(&plan, tiny, None, SOURCE_PX).is_err());
        assert!(rectify_picture(&plan, seen(), Some([0.0, 3.0]), SOURCE_PX).is_err());
        assert!(rectify_picture(&plan, seen(), Some([f64::NAN, 3.0]), SOURCE_PX).is_err());
        assert!(rectify_picture(&Plan::default(), seen(), None, SOURCE_PX).is_err());
        // A rectangle that reaches almost to the horizon: the picture ends before it.
        let steep = points([(18.0, -1.0), (22.0, -1.0), (40.0, -29.0), (0.0, -29.0)]);
        let flat = rectify_picture(&plan, steep, None, SOURCE_PX).expect("it is made flat");
        let size_px = flat.backdrop().and_then(|backdrop| backdrop.rectification.clone()).expect("it is flat").size_px;
        assert!(size_px.iter().all(|side| (1..=16_001).contains(side)), "{size_px:?}");
    }
}
