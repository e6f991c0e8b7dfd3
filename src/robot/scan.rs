use super::Pose;
use crate::geometry::Point;

/// One sweep of one laser scanner: readings at equal angles, counter-clockwise.
#[derive(Clone, Debug, PartialEq)]
pub struct Scan {
    /// Distance in metres along each beam. Values outside `0..max_range_m`, including NaN, mean no
    /// return: see [`Scan::range_m`].
    pub ranges_m: Vec<f64>,
    /// Direction of the first beam in the scanner's frame.
    pub start_rad: f64,
    /// Angle from one beam to the next.
    pub step_rad: f64,
    /// Readings from here on mean no return.
    pub max_range_m: f64,
    /// The pose of the scanner on the robot.
    pub robot_from_scanner: Pose,
}

impl Scan {
    /// The reading of a beam in metres, or `None` if there was no return.
    pub fn range_m(&self, beam: usize) -> Option<f64> {
        self.ranges_m.get(beam).copied().filter(|range| *range > 0.0 && *range < self.max_range_m)
    }

    /// Direction of a beam in the scanner's frame.
    pub fn angle_rad(&self, beam: usize) -> f64 {
        self.start_rad + self.step_rad * beam as f64
    }

    /// Where the beam hit, in the scanner's frame.
    pub fn point(&self, beam: usize) -> Option<Point> {
        let range = self.range_m(beam)?;
        let (sin, cos) = self.angle_rad(beam).sin_cos();
        Some(Point::new(range * cos, range * sin))
    }

    /// All hits in the scanner's frame with their beam indices, in beam order.
    pub fn points(&self) -> impl Iterator<Item = (usize, Point)> + '_ {
        (0..self.ranges_m.len()).filter_map(|beam| Some((beam, self.point(beam)?)))
    }
}
