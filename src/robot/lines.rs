//! Fits straight lines to noisy points: total least squares with covariance.

use nalgebra::{Matrix2, Vector2};

use super::Pose;
use crate::geometry::{Point, Segment, Vector};

/// Count, centroid and scatter of points: all that is needed to fit a line. The moments of two sets add
/// up to those of their union, so fusing segments equals fitting all their points at once.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Moments {
    /// Number of points, or their total weight.
    pub weight: f64,
    pub centroid: Point,
    /// Sums of squares and products about the centroid, in m²: xx, xy, yy.
    pub scatter: [f64; 3],
}

impl Moments {
    pub fn of(points: impl IntoIterator<Item = Point>) -> Self {
        points.into_iter().fold(Self::default(), Self::with)
    }

    /// These moments plus one more point.
    #[must_use]
    pub fn with(self, point: Point) -> Self {
        self.and(Self { weight: 1.0, centroid: point, scatter: [0.0; 3] })
    }

    /// The moments of the union (Chan, Golub and LeVeque 1983: without cancellation far from the origin).
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        let weight = self.weight + other.weight;
        if weight <= 0.0 {
            return self;
        }
        let way = other.centroid - self.centroid;
        let shared = self.weight * other.weight / weight;
        let [xx, xy, yy] = self.scatter;
        let [other_xx, other_xy, other_yy] = other.scatter;
        Self {
            weight,
            centroid: self.centroid + way * (other.weight / weight),
            scatter: [
                xx + other_xx + shared * way.x * way.x,
                xy + other_xy + shared * way.x * way.y,
                yy + other_yy + shared * way.y * way.y,
            ],
        }
    }

    /// The moments rescaled as if there were fewer or more points: every sum times `factor`.
    #[must_use]
    pub fn scaled(self, factor: f64) -> Self {
        Self { weight: self.weight * factor, centroid: self.centroid, scatter: self.scatter.map(|sum| sum * factor) }
    }

    /// The moments of the points transformed to the outer frame of `pose`.
    #[must_use]
    pub fn moved(self, pose: Pose) -> Self {
        let (sin, cos) = pose.heading_rad.sin_cos();
        let [xx, xy, yy] = self.scatter;
        Self {
            weight: self.weight,
            centroid: pose.apply(self.centroid),
            scatter: [
                cos * cos * xx - 2.0 * sin * cos * xy + sin * sin * yy,
                sin * cos * (xx - yy) + (cos * cos - sin * sin) * xy,
                sin * sin * xx + 2.0 * sin * cos * xy + cos * cos * yy,
            ],
        }
    }

    /// Direction of the total-least-squares line, a unit vector of arbitrary sign.
    pub fn direction(self) -> Vector {
        let [xx, xy, yy] = self.scatter;
        // The axis of the larger eigenvalue (Deriche, Vaillant and Faugeras 1992).
        let angle = 0.5 * (2.0 * xy).atan2(xx - yy);
        Vector::new(angle.cos(), angle.sin())
    }

    /// Sums of squares along and across the line, in m²: the eigenvalues of the scatter matrix.
    pub fn spread_m2(self) -> (f64, f64) {
        let [xx, xy, yy] = self.scatter;
        let mean = 0.5 * (xx + yy);
        let radius = (0.5 * (xx - yy)).hypot(xy);
        (mean + radius, (mean - radius).max(0.0))
    }

    /// Root mean square distance of the points from their line, in metres.
    pub fn residual_m(self) -> f64 {
        if self.weight > 0.0 { (self.spread_m2().1 / self.weight).sqrt() } else { 0.0 }
    }
}

/// A line segment with its uncertainty. It runs in the scanner's sweep direction: the observer was to the
/// left of the direction from `start` to `end`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineSegment {
    pub start: Point,
    pub end: Point,
    /// Those of the points it was fitted to.
    pub moments: Moments,
}

impl LineSegment {
    /// The total-least-squares line through points in sweep order, ending at the projections of its
    /// outermost points; `None` for fewer than two distinct points.
    pub fn fitted(points: &[Point]) -> Option<Self> {
        let (first, last) = (*points.first()?, *points.last()?);
        let moments = Moments::of(points.iter().copied());
        Self::along(moments, last - first, points.iter().copied())
    }

    /// The line of `moments`, in the direction that agrees with `towards`, long enough for the
    /// projections of all `reaching` points.
    pub fn along(moments: Moments, towards: Vector, reaching: impl IntoIterator<Item = Point>) -> Option<Self> {
        let mut direction = moments.direction();
        if direction.dot(towards) < 0.0 {
            direction = -direction;
        }
        let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
        for point in reaching {
            let at = (point - moments.centroid).dot(direction);
            least = least.min(at);
            most = most.max(at);
        }
        (most > least && (most - least).is_finite()).then(|| Self {
            start: moments.centroid + direction * least,
            end: moments.centroid + direction * most,
            moments,
        })
    }

    pub fn segment(self) -> Segment {
        Segment::new(self.start, self.end)
    }

    /// Length in metres.
    pub fn length(self) -> f64 {
        self.start.distance(self.end)
    }

    /// Unit vector from start to end.
    pub fn direction(self) -> Vector {
        (self.end - self.start).unit().unwrap_or(Vector::new(1.0, 0.0))
    }

    /// Unit vector towards the side it was seen from.
    pub fn normal(self) -> Vector {
        self.direction().left()
    }

    /// The segment in the outer frame of `pose`.
    #[must_use]
    pub fn moved(self, pose: Pose) -> Self {
        Self { start: pose.apply(self.start), end: pose.apply(self.end), moments: self.moments.moved(pose) }
    }

    /// Covariance of the line, given the standard deviation `sigma_m` of each point across it: of its
    /// offset at the centroid of its points (m²), and of its angle (rad²). About the centroid the two are
    /// independent: σ²/n and σ²/Σs² (Arras and Siegwart 1997, for equal weights).
    pub fn covariance(self, sigma_m: f64) -> Matrix2<f64> {
        let variance = sigma_m * sigma_m;
        let along = self.moments.spread_m2().0;
        Matrix2::from_diagonal(&Vector2::new(
            variance / self.moments.weight.max(f64::MIN_POSITIVE),
            variance / along.max(f64::MIN_POSITIVE),
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn points() -> impl Strategy<Value = Vec<Point>> {
        prop::collection::vec((-5.0..5.0, -0.02..0.02).prop_map(|(x, y)| Point::new(x, y)), 3..60)
    }

    proptest! {
        /// The line of the union is the same whether its points come at once or in two sets, and
        /// moving the points moves the line.
        #[test]
        fn moments_add_up_and_move(a in points(), b in points(), x in -200.0..200.0, heading in -3.0..3.0) {
            let pose = Pose::new(x, -x, heading);
            let at_once = Moments::of(a.iter().chain(&b).map(|point| pose.apply(*point)));
            let in_two = Moments::of(a).and(Moments::of(b)).moved(pose);
            prop_assert!(at_once.centroid.distance(in_two.centroid) < 1e-9);
            for (one, two) in at_once.scatter.iter().zip(in_two.scatter) {
                prop_assert!((one - two).abs() < 1e-7);
            }
        }
    }

    /// Lines through noisy points vary as their covariance says.
    #[test]
    fn covariance_is_that_of_repeated_fits() {
        let mut random = crate::base::random::Random::new(3);
        let sigma = 0.03;
        let (mut offset, mut angle, mut expected) = (0.0, 0.0, Matrix2::zeros());
        let fits = 4000;
        for _ in 0..fits {
            // A uniform distribution with standard deviation sigma.
            let half = sigma * 3.0_f64.sqrt();
            let points: Vec<Point> =
                (0..20).map(|i| Point::new(0.1 * f64::from(i), half * (2.0 * random.unit() - 1.0))).collect();
            let line = LineSegment::fitted(&points).unwrap();
            let tilt = line.direction().angle_rad();
            offset += line.moments.centroid.y.powi(2) / f64::from(fits);
            angle += tilt.powi(2) / f64::from(fits);
            expected = line.covariance(sigma);
        }
        assert!((offset / expected[(0, 0)] - 1.0).abs() < 0.1, "{offset} against {expected}");
        assert!((angle / expected[(1, 1)] - 1.0).abs() < 0.1, "{angle} against {expected}");
    }
}
