//! Placing the backdrop: its scale from lengths measured on it, straightening, moving.
//!
//! Measurements are kept in pixels of the picture, so that they stay valid when it is moved, rotated or
//! scaled, and more can be added at any time.

use std::sync::Arc;

use crate::edit::{EditError, checked_position, fail, set_backdrop, set_meta};
use crate::geometry::{Point, Vector, trim_m};
use crate::plan::{Backdrop, DimensionHost, METRES_PER_PIXEL, Measurement, Place, Plan, Scale, ScaleOrigin};

/// Size of a pixel in metres for a backdrop without a measured scale: a hundred pixels per metre, about
/// what a scan of a 1:100 drawing at 250 dpi has.
pub const UNMEASURED_METRES_PER_PIXEL: f64 = 0.01;

/// The shortest distance, in pixels of the picture, that can be measured: a click is no more precise.
const SHORTEST_PX: f64 = 2.0;

impl Backdrop {
    /// A new backdrop: its upper left corner at the origin, not rotated, of unknown scale.
    pub fn new(path: impl Into<String>, content_hash: impl Into<String>) -> Self {
        Self {
            path: path.into(),
            content_hash: content_hash.into(),
            page: 1,
            origin: Point::default(),
            metres_per_pixel: UNMEASURED_METRES_PER_PIXEL,
            rotation_rad: 0.0,
            opacity: 1.0,
            measurements: Vec::new(),
            rectification: None,
            extra: None,
        }
    }

    /// The plan position of a point of the picture. `pixel` counts from the picture's upper left corner,
    /// x to the right and y down.
    pub fn plan_from_picture(&self, pixel: Point) -> Point {
        self.origin + (Vector::new(pixel.x, -pixel.y) * self.metres_per_pixel).rotated(self.rotation_rad)
    }

    /// The picture position of a point of the plan, in pixels as in [`Backdrop::plan_from_picture`].
    pub fn picture_from_plan(&self, point: Point) -> Point {
        let turned = (point - self.origin).rotated(-self.rotation_rad) * (1.0 / self.metres_per_pixel);
        Point::new(turned.x, -turned.y)
    }

    /// A length between two points of the plan, as a measurement of the picture.
    ///
    /// # Errors
    /// When the points are too close, or the length is not a valid length.
    pub fn measurement(&self, from: Point, to: Point, length_m: f64) -> Result<Measurement, EditError> {
        // A hundredth of a pixel is finer than any click, and keeps files small.
        let rounded = |point: Point| Point::new((point.x * 100.0).round() / 100.0, (point.y * 100.0).round() / 100.0);
        let [from, to] = [from, to].map(|point| rounded(self.picture_from_plan(point)));
        let measurement = Measurement { from, to, length_m };
        if !(length_m > 0.0 && length_m.is_finite()) {
            return fail(format!("a measured length is above 0, not {length_m} m"));
        }
        if !(measurement.length_px() >= SHORTEST_PX && measurement.length_px().is_finite()) {
            return fail("the two points lie too close to measure a length: take points further apart");
        }
        Ok(measurement)
    }

    /// Whether its scale has been measured.
    pub fn is_measured(&self) -> bool {
        !self.measurements.is_empty()
    }
}

/// The scale that fits several measurements best.
#[derive(Clone, Debug, PartialEq)]
pub struct Calibration {
    pub metres_per_pixel: f64,
    /// By how much each length at this scale exceeds the stated one, as a share of the stated one; in the
    /// order of the measurements.
    pub residuals: Vec<f64>,
    /// Index of the measurement that fits worst; `None` if there are fewer than two.
    pub worst: Option<usize>,
}

impl Calibration {
    /// The best scale for the measurements; `None` if there are none.
    ///
    /// The uncertain part is where the points were clicked, by as many pixels for a long length as for a
    /// short one, not the length written on the drawing. So the scale `k` in pixels per metre minimises
    /// the sum of `(p - k L)²` over the lengths `L` and their pixels `p`: `k = Σ p L / Σ L²` (linear
    /// regression through the origin). Long lengths count more.
    pub fn of(measurements: &[Measurement]) -> Option<Self> {
        let products: f64 = measurements.iter().map(|one| one.length_px() * one.length_m).sum();
        let squares: f64 = measurements.iter().map(|one| one.length_m * one.length_m).sum();
        let metres_per_pixel = squares / products;
        if !METRES_PER_PIXEL.contains(&metres_per_pixel) {
            return None;
        }
        let residual = |one: &Measurement| one.length_px() * metres_per_pixel / one.length_m - 1.0;
        let residuals: Vec<f64> = measurements.iter().map(residual).collect();
        let worst = (0..residuals.len()).max_by(|&a, &b| residuals[a].abs().total_cmp(&residuals[b].abs()));
        Some(Self { metres_per_pixel, worst: worst.filter(|_| residuals.len() > 1), residuals })
    }

    /// The root mean square of the residuals.
    pub fn spread(&self) -> f64 {
        let squares: f64 = self.residuals.iter().map(|residual| residual * residual).sum();
        (squares / self.residuals.len().max(1) as f64).sqrt()
    }

    /// How the scale was found, for [`Scale::note`].
    fn note(&self) -> String {
        match self.residuals.len() {
            1 => "one length measured on the picture".to_owned(),
            count => format!(
                "{count} lengths measured on the picture, which agree within {:.1} %",
                self.residuals.iter().fold(0.0, |most: f64, residual| most.max(residual.abs())) * 100.0
            ),
        }
    }
}

/// What happens to the drawing when the backdrop is scaled or rotated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DrawingMoves {
    /// It was traced from the picture: it follows it.
    Along,
    /// It is right as it is and stays.
    Stays,
}

impl DrawingMoves {
    /// Words for commands, with titles.
    pub const WORDS: &'static [(&'static str, &'static str)] = &[("along", "With the picture"), ("stays", "Stays")];

    /// Parses a word.
    pub fn of_word(word: &str) -> Self {
        if word == "stays" { Self::Stays } else { Self::Along }
    }
}

fn backdrop_of(plan: &Plan) -> Result<&Backdrop, EditError> {
    plan.backdrop().ok_or_else(|| EditError("the plan has no picture under it".to_owned()))
}

/// Replaces the list of measurements and sets the scale that fits them best. The picture's upper left
/// corner stays in place. Without measurements the scale is unchanged.
///
/// # Errors
/// When there is no backdrop, no plausible scale fits, or the drawing would leave the drawing area.
pub fn set_measurements(plan: &Plan, measurements: Vec<Measurement>, drawing: DrawingMoves) -> Result<Plan, EditError> {
    let backdrop = backdrop_of(plan)?;
    if measurements.is_empty() {
        return Ok(set_backdrop(plan, Some(Backdrop { measurements, ..backdrop.clone() })));
    }
    let Some(calibration) = Calibration::of(&measurements) else {
        return fail(
            "no scale of a plan fits these lengths: a pixel would be smaller than a nanometre or larger than a kilometre",
        );
    };
    let metres_per_pixel = calibration.metres_per_pixel;
    let factor = metres_per_pixel / backdrop.metres_per_pixel;
    let next = match drawing {
        DrawingMoves::Along => transformed(plan, backdrop.origin, factor, 0.0, Vector::default())?,
        DrawingMoves::Stays => plan.clone(),
    };
    let mut meta = plan.meta().clone();
    meta.scale =
        Scale { origin: ScaleOrigin::Measured, metres_per_unit: Some(metres_per_pixel), note: calibration.note() };
    let backdrop = Backdrop { metres_per_pixel, measurements, ..backdrop.clone() };
    Ok(set_backdrop(&set_meta(&next, meta), Some(backdrop)))
}

/// The rotation in radians, counter-clockwise and at most 45 degrees, that brings a direction onto the
/// nearest axis; `None` for a zero vector.
pub fn straightening_rad(direction: Vector) -> Option<f64> {
    use std::f64::consts::FRAC_PI_2;
    direction.unit()?;
    let angle_rad = direction.angle_rad();
    Some((angle_rad / FRAC_PI_2).round() * FRAC_PI_2 - angle_rad)
}

/// Rotates the backdrop counter-clockwise about a point of the plan.
///
/// # Errors
/// When there is no backdrop, or the drawing would leave the drawing area.
pub fn turn_picture(plan: &Plan, about: Point, angle_rad: f64, drawing: DrawingMoves) -> Result<Plan, EditError> {
    let backdrop = backdrop_of(plan)?;
    let next = match drawing {
        DrawingMoves::Along => transformed(plan, about, 1.0, angle_rad, Vector::default())?,
        DrawingMoves::Stays => plan.clone(),
    };
    let origin = about + (backdrop.origin - about).rotated(angle_rad);
    let rotation_rad = normalised_rad(backdrop.rotation_rad + angle_rad);
    Ok(set_backdrop(&next, Some(Backdrop { origin, rotation_rad, ..backdrop.clone() })))
}

/// Normalises an angle to plus or minus half a turn; a negligible one becomes 0.
pub(super) fn normalised_rad(angle_rad: f64) -> f64 {
    use std::f64::consts::{PI, TAU};
    let angle_rad = angle_rad - TAU * (angle_rad / TAU).round();
    if angle_rad.abs() < 1e-12 { 0.0 } else { angle_rad.clamp(-PI, PI) }
}

/// Moves the backdrop; the drawing stays.
///
/// # Errors
/// When there is no backdrop, or it would leave the drawing area.
pub fn move_picture(plan: &Plan, by: Vector) -> Result<Plan, EditError> {
    let backdrop = backdrop_of(plan)?;
    let origin = checked_position(backdrop.origin + by)?;
    Ok(set_backdrop(plan, Some(Backdrop { origin, ..backdrop.clone() })))
}

/// Scales the whole plan about the origin, its backdrop with it. Its scale becomes an estimate; `how` says in words how
/// it was found.
///
/// # Errors
/// When something would leave the drawing area or lose its length, or the factor is not a number above 0.
pub fn rescale(plan: &Plan, factor: f64, how: &str) -> Result<Plan, EditError> {
    if !(factor > 0.0 && factor.is_finite()) {
        return fail(format!("a plan is scaled by a factor above 0, not {factor}"));
    }
    let mut next = transformed(plan, Point::default(), factor, 0.0, Vector::default())?;
    if let Some(backdrop) = plan.backdrop() {
        let origin = checked_position(Point::default() + (backdrop.origin - Point::default()) * factor)?;
        let metres_per_pixel = backdrop.metres_per_pixel * factor;
        if !METRES_PER_PIXEL.contains(&metres_per_pixel) {
            return fail("the picture under the plan would become too small or too large");
        }
        // Its measurements said otherwise.
        let measurements = Vec::new();
        next = set_backdrop(&next, Some(Backdrop { origin, metres_per_pixel, measurements, ..backdrop.clone() }));
    }
    let scale = &plan.meta().scale;
    let metres_per_unit = scale.metres_per_unit.map(|metres| metres * factor).filter(|metres| metres.is_finite());
    let scale = Scale { origin: ScaleOrigin::Estimated, metres_per_unit, note: how.to_owned() };
    Ok(set_meta(&next, crate::plan::Meta { scale, ..plan.meta().clone() }))
}

/// Scales and rotates all that is drawn about a point, and then moves it; the backdrop stays.
///
/// # Errors
/// When something would leave the drawing area or lose its length.
pub(super) fn transformed(
    plan: &Plan,
    about: Point,
    factor: f64,
    angle_rad: f64,
    by: Vector,
) -> Result<Plan, EditError> {
    let moved = |point: Point| checked_position(about + ((point - about) * factor).rotated(angle_rad) + by);
    let mut next = plan.clone();
    for (id, corner) in plan.corners() {
        if let Some(target) = next.corners.get_mut(&id) {
            target.position = moved(corner.position)?;
        }
    }
    for (id, wall) in plan.walls() {
        if let Some(target) = next.walls.get_mut(&id) {
            target.thickness_m = trim_m(wall.thickness_m * factor);
        }
    }
    for (id, opening) in plan.openings() {
        let place = match opening.place {
            Place::Free { from, to } => Place::Free { from: moved(from)?, to: moved(to)? },
            Place::Hosted { from, to, at_m, width_m } => {
                let edge = next.position(from).zip(next.position(to)).map_or(0.0, |(a, b)| a.distance(b));
                Place::Hosted { from, to, at_m: trim_m((at_m * factor).min(edge)), width_m: trim_m(width_m * factor) }
            }
        };
        if let Some(target) = next.openings.get_mut(&id) {
            Arc::make_mut(target).place = place;
        }
    }
    for (id, dimension) in plan.dimensions() {
        let mut chain = dimension.clone();
        chain.along = dimension.along.turned(Vector::new(1.0, 0.0).rotated(angle_rad));
        // The line stays on its side of what it measures, whichever is the left now.
        let sides = dimension.along.direction().zip(chain.along.direction());
        let is_turned = sides.is_some_and(|(before, after)| before.rotated(angle_rad).dot(after) < 0.0);
        chain.offset_m = trim_m(dimension.offset_m * if is_turned { -factor } else { factor });
        for point in &mut chain.points {
            point.last = moved(point.last)?;
            if let Some(DimensionHost::Wall { at_m, .. }) = &mut point.on {
                *at_m = trim_m(*at_m * factor);
            }
        }
        next.dimensions.insert(id, Arc::new(chain));
    }
    // A drawing made a thousand times smaller may collapse on the 0.1 mm grid.
    match next.violations().first() {
        Some(violation) if plan.violations().is_empty() => {
            fail(format!("the drawing would become too small: {violation}"))
        }
        _ => Ok(next),
    }
}

#[cfg(test)]
mod tests {
    use crate::edit::calibration::*;
    use crate::plan::{Builder, Meta, Opening, OpeningKind, Room};

    fn measurement(length_px: f64, length_m: f64) -> Measurement {
        Measurement { from: Point::new(10.0, 10.0), to: Point::new(10.0, 10.0 + length_px), length_m }
    }

    #[test]
    fn one_length_is_taken_as_it_is_and_several_balance() {
        assert_eq!(Calibration::of(&[]), None);
        let one = Calibration::of(&[measurement(500.0, 10.0)]).expect("a length");
        assert!((one.metres_per_pixel - 0.02).abs() < 1e-15 && one.residuals[0].abs() < 1e-12 && one.worst.is_none());
        // The same error of four pixels: the long length dominates.
        let two = Calibration::of(&[measurement(1004.0, 10.0), measurement(96.0, 1.0)]).expect("lengths");
        let k = (1004.0 * 10.0 + 96.0) / 101.0;
        assert!((two.metres_per_pixel - 1.0 / k).abs() < 1e-15);
        assert_eq!(two.worst, Some(1));
        assert!((two.residuals[1] - (96.0 / k - 1.0)).abs() < 1e-12 && two.residuals[1] < -0.04);
        assert!(two.residuals[0] > 0.0 && two.spread() > two.residuals[0]);
    }

    #[test]
    fn plan_and_picture_are_inverse() {
        let backdrop = Backdrop {
            origin: Point::new(3.0, -2.0),
            metres_per_pixel: 0.013,
            rotation_rad: 0.7,
            ..Backdrop::new("a.png", "")
        };
        let pixel = Point::new(123.0, 456.5);
        assert!(backdrop.picture_from_plan(backdrop.plan_from_picture(pixel)).distance(pixel) < 1e-9);
        let upright = Backdrop::new("a.png", "");
        assert_eq!(upright.plan_from_picture(Point::new(100.0, 50.0)), Point::new(1.0, -0.5));
    }

    fn traced() -> Plan {
        let mut builder = Builder::new(Meta::default());
        let ring = builder.ring([(0.0, 0.0), (6.0, 0.0), (6.0, -4.0), (0.0, -4.0)].map(|(x, y)| Point::new(x, y)));
        builder.wall(ring[0], ring[1], 0.1);
        let place = Place::Hosted { from: ring[0], to: ring[1], at_m: 2.0, width_m: 0.8 };
        builder.opening("door", Opening::new(OpeningKind::Door, place));
        builder.room("room", Room { outer: ring, ..Room::default() });
        builder.set_backdrop(Backdrop::new("scan.png", ""));
        builder.finish().expect("a plan")
    }

    /// A room's boundary in pixels of the picture: what was traced.
    fn on_picture(plan: &Plan) -> Vec<Point> {
        let backdrop = plan.backdrop().expect("a picture");
        let rings = plan.rooms().flat_map(|(_, room)| plan.ring_points(&room.outer));
        rings.map(|point| backdrop.picture_from_plan(point)).collect()
    }

    #[test]
    fn the_drawing_stays_on_its_lines_or_where_it_is() {
        let plan = traced();
        let backdrop = plan.backdrop().expect("a picture");
        let measured = backdrop.measurement(Point::new(0.0, 0.0), Point::new(6.0, 0.0), 12.0).expect("a length");
        let along = set_measurements(&plan, vec![measured.clone()], DrawingMoves::Along).expect("it scales");
        assert_eq!(along.violations(), []);
        assert_eq!(along.backdrop().map(|backdrop| backdrop.metres_per_pixel), Some(0.02));
        assert_eq!(along.meta().scale.origin, ScaleOrigin::Measured);
        for (before, after) in on_picture(&plan).into_iter().zip(on_picture(&along)) {
            assert!(before.distance(after) < 1e-6, "{before:?} {after:?}");
        }
        let (_, wall) = along.walls().next().expect("a wall");
        let (_, opening) = along.openings().next().expect("a door");
        assert_eq!(wall.thickness_m, 0.2);
        assert!(matches!(opening.place, Place::Hosted { at_m: 4.0, width_m: 1.6, .. }));
        let stays = set_measurements(&plan, vec![measured], DrawingMoves::Stays).expect("it scales");
        assert_eq!(stays.bounds(), plan.bounds());
        // Rotating with the picture keeps it on the same lines.
        let turned = turn_picture(&along, Point::new(1.0, 1.0), 0.3, DrawingMoves::Along).expect("it turns");
        for (before, after) in on_picture(&plan).into_iter().zip(on_picture(&turned)) {
            assert!(before.distance(after) < 0.01, "{before:?} {after:?}");
        }
    }

    #[test]
    fn a_plan_is_scaled_with_its_picture() {
        let plan = traced();
        let twice = rescale(&plan, 2.0, "by its doors").expect("it scales");
        assert_eq!(twice.violations(), []);
        for (before, after) in on_picture(&plan).into_iter().zip(on_picture(&twice)) {
            assert!(before.distance(after) < 1e-6, "{before:?} {after:?}");
        }
        let (_, opening) = twice.openings().next().expect("a door");
        assert!(matches!(opening.place, Place::Hosted { at_m: 4.0, width_m: 1.6, .. }));
        assert_eq!(
            (twice.meta().scale.origin, twice.meta().scale.note.as_str()),
            (ScaleOrigin::Estimated, "by its doors")
        );
        for factor in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e9, 1e-9] {
            assert!(rescale(&plan, factor, "").is_err(), "{factor}");
        }
    }

    #[test]
    fn what_measures_nothing_is_refused() {
        let plan = traced();
        let backdrop = plan.backdrop().expect("a picture");
        let here = Point::new(1.0, 1.0);
        assert!(backdrop.measurement(here, Point::new(1.01, 1.0), 1.0).is_err(), "a pixel apart");
        assert!(backdrop.measurement(here, Point::new(3.0, 1.0), 0.0).is_err());
        let tiny = vec![measurement(1e5, 1e-6)];
        assert!(set_measurements(&plan, tiny, DrawingMoves::Along).is_err());
        let collapsing = vec![measurement(1000.0, 1e-4)];
        let error = set_measurements(&plan, collapsing, DrawingMoves::Along).expect_err("nothing is left of it");
        assert!(error.0.contains("too small"), "{error}");
        assert!(move_picture(&plan, Vector::new(1e9, 0.0)).is_err());
    }

    #[test]
    fn straightening_takes_the_nearest_axis() {
        for (direction, expected_deg) in
            [((1.0, 0.1), -5.71), ((-1.0, 0.1), 5.71), ((0.1, 1.0), 5.71), ((0.1, -1.0), -5.71)]
        {
            let turn_rad = straightening_rad(Vector::new(direction.0, direction.1)).expect("a direction");
            assert!((turn_rad.to_degrees() - expected_deg).abs() < 0.01, "{direction:?} {}", turn_rad.to_degrees());
        }
        assert_eq!(straightening_rad(Vector::new(0.0, 0.0)), None);
    }
}
