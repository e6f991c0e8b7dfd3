use crate::geometry::{Point, Vector};

/// A position and heading: a rigid motion of the plane.
///
/// A pose named `world_from_robot` maps points in the robot's frame (x ahead, y to the left) to the
/// world's frame; [`Pose::compose`] chains such names as they read:
/// `world_from_robot.compose(robot_from_scanner)` is `world_from_scanner`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pose {
    pub x_m: f64,
    pub y_m: f64,
    /// Counter-clockwise from the x axis, in (-π, π].
    pub heading_rad: f64,
}

impl Pose {
    /// At the origin, facing along the x axis.
    pub const IDENTITY: Self = Self { x_m: 0.0, y_m: 0.0, heading_rad: 0.0 };

    /// The heading may be any angle; it is wrapped into (-π, π].
    pub fn new(x_m: f64, y_m: f64, heading_rad: f64) -> Self {
        Self { x_m, y_m, heading_rad: wrapped_rad(heading_rad) }
    }

    pub fn position(self) -> Point {
        Point::new(self.x_m, self.y_m)
    }

    pub fn is_finite(self) -> bool {
        self.x_m.is_finite() && self.y_m.is_finite() && self.heading_rad.is_finite()
    }

    /// This pose followed by `next`, which is relative to this pose.
    #[must_use]
    pub fn compose(self, next: Self) -> Self {
        let at = self.apply(next.position());
        Self::new(at.x, at.y, self.heading_rad + next.heading_rad)
    }

    /// The inverse: composed with this pose on either side it gives the identity.
    #[must_use]
    pub fn inverse(self) -> Self {
        let back = Vector::new(-self.x_m, -self.y_m).rotated(-self.heading_rad);
        Self::new(back.x, back.y, -self.heading_rad)
    }

    /// `other` relative to this pose: `self.compose(self.between(other))` is `other`.
    #[must_use]
    pub fn between(self, other: Self) -> Self {
        let way = (other.position() - self.position()).rotated(-self.heading_rad);
        Self::new(way.x, way.y, other.heading_rad - self.heading_rad)
    }

    /// Maps a point from this pose's frame to the outer frame.
    pub fn apply(self, point: Point) -> Point {
        self.position() + self.rotate(Vector::new(point.x, point.y))
    }

    /// Maps a direction from this pose's frame to the outer frame.
    pub fn rotate(self, vector: Vector) -> Vector {
        vector.rotated(self.heading_rad)
    }
}

/// The angle wrapped into (-π, π].
pub fn wrapped_rad(angle_rad: f64) -> f64 {
    use std::f64::consts::{PI, TAU};
    if angle_rad > -PI && angle_rad <= PI {
        return angle_rad;
    }
    let turned = angle_rad.rem_euclid(TAU);
    if turned > PI { turned - TAU } else { turned }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn pose() -> impl Strategy<Value = Pose> {
        (-1e3..1e3, -1e3..1e3, -10.0..10.0).prop_map(|(x, y, heading)| Pose::new(x, y, heading))
    }

    fn close(a: Pose, b: Pose) -> bool {
        a.position().distance(b.position()) < 1e-9 && wrapped_rad(a.heading_rad - b.heading_rad).abs() < 1e-9
    }

    proptest! {
        #[test]
        fn poses_are_a_group(a in pose(), b in pose(), c in pose()) {
            prop_assert!(close(a.compose(b).compose(c), a.compose(b.compose(c))));
            prop_assert!(close(a.compose(a.inverse()), Pose::IDENTITY));
            prop_assert!(close(a.compose(a.between(b)), b));
            prop_assert!(a.heading_rad > -std::f64::consts::PI && a.heading_rad <= std::f64::consts::PI);
        }

        #[test]
        fn composing_is_applying_one_after_the_other(a in pose(), b in pose(), x in -10.0..10.0, y in -10.0..10.0) {
            let point = Point::new(x, y);
            prop_assert!(a.compose(b).apply(point).distance(a.apply(b.apply(point))) < 1e-9);
        }
    }
}
