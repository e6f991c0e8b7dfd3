//! A picture seen through a projective map.

use super::{Level, Samples};
use crate::base::work::{Cancelled, Work};
use crate::geometry::{Homography, Point};

/// The picture of this size whose every pixel shows what lies at `source_from_shown` of it on `source`: between four
/// pixels their mean, by nearness; outside, nothing.
///
/// # Errors
/// When the work is cancelled.
#[cfg_attr(not(feature = "pictures"), expect(dead_code, reason = "those who read pictures use it"))]
pub(crate) fn warped(
    source: &Level,
    source_from_shown: &Homography,
    size_px: [u32; 2],
    work: &Work<'_>,
) -> Result<Level, Cancelled> {
    let [width_px, height_px] = size_px;
    let (width, height) = (f64::from(source.width_px), f64::from(source.height_px));
    // What lies in the middle of the picture lies on the right side of the horizon.
    let side = source_from_shown.side(Point::new(f64::from(width_px) / 2.0, f64::from(height_px) / 2.0));
    let mut data = Vec::with_capacity(width_px as usize * height_px as usize * 4);
    for y in 0..height_px {
        work.goes_on()?;
        for x in 0..width_px {
            let shown = Point::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
            let at = source_from_shown.apply(shown).filter(|_| source_from_shown.side(shown) == side);
            let inside = at.filter(|at| (0.0..=width).contains(&at.x) && (0.0..=height).contains(&at.y));
            data.extend_from_slice(&inside.map_or([0; 4], |at| sampled(source, at)));
        }
    }
    Ok(Level { width_px, height_px, samples: Samples::Rgba, data }.simplified())
}

/// The colour at a point of a picture, in pixels from its upper left corner.
fn sampled(source: &Level, at: Point) -> [u8; 4] {
    let (x, y) = (at.x - 0.5, at.y - 0.5);
    let (left, top) = (x.floor(), y.floor());
    let (right_share, lower_share) = (x - left, y - top);
    let pixel = |dx: i64, dy: i64| source.pixel(left as i64 + dx, top as i64 + dy).map(f64::from);
    let [upper_left, upper_right, lower_left, lower_right] = [pixel(0, 0), pixel(1, 0), pixel(0, 1), pixel(1, 1)];
    std::array::from_fn(|channel| {
        let upper = upper_left[channel] + (upper_right[channel] - upper_left[channel]) * right_share;
        let lower = lower_left[channel] + (lower_right[channel] - lower_left[channel]) * right_share;
        (upper + (lower - upper) * lower_share).round() as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_is_moved_turned_and_cut() {
        // Four pixels by two: 10, 20, 30, 40 and 50, 60, 70, 80.
        let data = vec![10, 20, 30, 40, 50, 60, 70, 80];
        let source = Level { width_px: 4, height_px: 2, samples: Samples::Grey, data };
        let square = |x: f64, y: f64, side: f64| {
            [(0.0, 0.0), (side, 0.0), (side, side), (0.0, side)].map(|(dx, dy)| Point::new(x + dx, y + dy))
        };
        let same = Homography::between(square(0.0, 0.0, 2.0), square(0.0, 0.0, 2.0)).expect("a map");
        assert_eq!(warped(&source, &same, [4, 2], &Work::quiet()), Ok(source.clone()));
        let moved = Homography::between(square(0.0, 0.0, 2.0), square(1.0, 0.0, 2.0)).expect("a map");
        let shown = warped(&source, &moved, [4, 1], &Work::quiet()).expect("it goes on");
        assert_eq!([0, 1, 2, 3].map(|x| shown.pixel(x, 0)[0]), [20, 30, 40, 0]);
        assert_eq!(shown.pixel(3, 0)[3], 0, "beyond the picture there is nothing");
        let larger = Homography::between(square(0.0, 0.0, 4.0), square(0.0, 0.0, 2.0)).expect("a map");
        let shown = warped(&source, &larger, [8, 4], &Work::quiet()).expect("it goes on");
        assert_eq!([1, 2, 3].map(|x| shown.pixel(x, 0)[0]), [13, 18, 23]);
    }
}
