//! What is drawn: shapes with units and colours, in painting order. The painters ([`super::png`],
//! [`super::svg`], the window) know nothing of plans.

use std::sync::Arc;

use super::Rgba;
use crate::geometry::{Bounds, Point, Vector};
use crate::picture::PictureLevels;

/// Shapes in painting order, and the view they were laid out for.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    pub view: View,
    /// Painted first, over the whole view; transparent for none.
    pub background: Rgba,
    pub groups: Vec<Group>,
}

/// A view of a plan: which part, at what size.
///
/// Pixels here are logical ones: the unit of text and line widths. Where the screen has `pixel_ratio`
/// physical pixels to each, painters multiply.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    pub width_px: f64,
    pub height_px: f64,
    /// Logical pixels per metre.
    pub px_per_m: f64,
    /// The point of the plan in the middle of the view.
    pub centre: Point,
    /// Physical pixels per logical one: 1, or 2 on a high-density screen.
    pub pixel_ratio: f64,
}

impl View {
    /// The view that shows `bounds` as large as possible, centred, with `margin_px` free on every side.
    pub fn fitting(bounds: Bounds, width_px: f64, height_px: f64, margin_px: f64) -> Self {
        let (free_width, free_height) = ((width_px - 2.0 * margin_px).max(1.0), (height_px - 2.0 * margin_px).max(1.0));
        // An empty plan, or one without extent, is shown at 50 px per metre: a room fills a window.
        let scale = (free_width / bounds.width()).min(free_height / bounds.height());
        let px_per_m = if scale.is_finite() && scale > 0.0 { scale } else { 50.0 };
        let centre = if bounds.is_empty() { Point::default() } else { bounds.center() };
        Self { width_px, height_px, px_per_m, centre, pixel_ratio: 1.0 }
    }

    /// Where a point of the plan appears: logical pixels from the upper left corner, y down.
    pub fn screen_from_plan(&self, point: Point) -> Point {
        Point::new(
            self.width_px / 2.0 + (point.x - self.centre.x) * self.px_per_m,
            self.height_px / 2.0 - (point.y - self.centre.y) * self.px_per_m,
        )
    }

    /// The point of the plan at a position in the view.
    pub fn plan_from_screen(&self, screen: Point) -> Point {
        Point::new(
            self.centre.x + (screen.x - self.width_px / 2.0) / self.px_per_m,
            self.centre.y - (screen.y - self.height_px / 2.0) / self.px_per_m,
        )
    }

    /// The visible part of the plan.
    pub fn bounds(&self) -> Bounds {
        Bounds::of([
            self.plan_from_screen(Point::default()),
            self.plan_from_screen(Point::new(self.width_px, self.height_px)),
        ])
    }

    /// A length in logical pixels.
    pub fn px(&self, length: Length) -> f64 {
        match length {
            Length::Metres(metres) => metres * self.px_per_m,
            Length::Px(px) => px,
        }
    }
}

/// A length in the plan, which scales with zoom, or on the screen, which does not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Length {
    Metres(f64),
    /// Logical pixels.
    Px(f64),
}

/// What a group of shapes belongs to. In painting order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Layer {
    /// The backdrop.
    Picture,
    Grid,
    /// Rooms' fills; one group per room.
    Rooms,
    /// Boundaries between rooms without a wall.
    Boundaries,
    Walls,
    /// Doors, passages and windows; one group per opening.
    Openings,
    Graph,
    /// Dimension chains; one group per chain.
    Dimensions,
    /// Names and areas; one group per room.
    Names,
    /// Title, legend, scale bar.
    Sheet,
}

impl Layer {
    pub const ALL: [Self; 10] = [
        Self::Picture,
        Self::Grid,
        Self::Rooms,
        Self::Boundaries,
        Self::Walls,
        Self::Openings,
        Self::Graph,
        Self::Dimensions,
        Self::Names,
        Self::Sheet,
    ];

    /// Its name in files and in the interface.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Picture => "picture",
            Self::Grid => "grid",
            Self::Rooms => "rooms",
            Self::Boundaries => "boundaries",
            Self::Walls => "walls",
            Self::Openings => "openings",
            Self::Graph => "graph",
            Self::Dimensions => "dimensions",
            Self::Names => "names",
            Self::Sheet => "sheet",
        }
    }
}

/// The coordinate system of a group's points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Frame {
    /// Metres, y up.
    Plan,
    /// Logical pixels from the upper left corner, y down. Lengths in metres have no meaning here.
    Screen,
}

/// Shapes that belong together.
#[derive(Clone, Debug, PartialEq)]
pub struct Group {
    pub layer: Layer,
    pub frame: Frame,
    /// The id of the element it shows (`r…`, `o…`); empty if none.
    pub element: String,
    /// A description for tooltips and screen readers; empty if none.
    pub title: String,
    pub items: Vec<Item>,
}

impl Group {
    /// A group that shows no element.
    pub fn new(layer: Layer, frame: Frame, items: Vec<Item>) -> Self {
        Self { layer, frame, element: String::new(), title: String::new(), items }
    }
}

/// A shape.
#[derive(Clone, Debug, PartialEq)]
pub enum Item {
    /// A filled polygon with holes.
    Polygon {
        outer: Vec<Point>,
        holes: Vec<Vec<Point>>,
        colour: Rgba,
    },
    /// A line through points. Joins are mitred; ends are butt caps.
    Line {
        points: Vec<Point>,
        closed: bool,
        colour: Rgba,
        width: Length,
        dash: Option<Dash>,
    },
    /// A circular arc of at most half a turn about `centre`, the short way from `from` to `to`.
    Arc {
        centre: Point,
        from: Point,
        to: Point,
        colour: Rgba,
        width: Length,
    },
    /// A disc, filled, outlined, or both.
    Disc {
        centre: Point,
        radius: Length,
        fill: Option<Rgba>,
        outline: Option<(Rgba, Length)>,
    },
    /// A line of text.
    Text(Text),
    Picture(PlacedPicture),
}

/// A picture with its placement.
#[derive(Clone, Debug)]
pub struct PlacedPicture {
    pub levels: Arc<PictureLevels>,
    /// Its upper left, upper right and lower left corners, in the group's frame.
    pub corners: [Point; 3],
    /// From 0, invisible, to 1, opaque.
    pub opacity: f64,
}

impl PartialEq for PlacedPicture {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.levels, &other.levels) && self.corners == other.corners && self.opacity == other.opacity
    }
}

impl PlacedPicture {
    /// The point of the frame at a position in the picture, in pixels of its full size.
    pub fn at(&self, x_px: f64, y_px: f64) -> Point {
        let [width, height] = self.levels.size_px().map(f64::from);
        let [start, right, below] = self.corners;
        start + (right - start) * (x_px / width) + (below - start) * (y_px / height)
    }

    /// Its bounding box.
    pub fn bounds(&self) -> Bounds {
        let [start, right, below] = self.corners;
        Bounds::of([start, right, below, right + (below - start)])
    }
}

/// A dashed line's lengths, starting with the dash.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dash {
    pub dash: Length,
    pub gap: Length,
}

/// A line of text. Painters put its baseline on a whole physical pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct Text {
    /// A point in the group's frame; the text's anchor is at an offset of `offset_px` from it.
    pub at: Point,
    /// From `at` to the anchor on the baseline, in logical pixels, x right and y down, in the plan's
    /// frame too.
    pub offset_px: Vector,
    pub content: String,
    /// Font size in logical pixels.
    pub size_px: f64,
    pub weight: Weight,
    pub colour: Rgba,
    /// The colour of an outline behind the letters, for busy backgrounds.
    pub halo: Option<Rgba>,
    pub anchor: Anchor,
    /// Turned 90 degrees to the left about its anchor: reads from bottom to top.
    pub upright: bool,
}

/// Which point of a text's baseline the anchor is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    Start,
    Middle,
    End,
}

/// A weight of the bundled font.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Weight {
    Regular,
    SemiBold,
}

/// `1 + 2^halvings` points along a circular arc of at most half a turn, both ends included, for painters
/// without arcs. Halves chords, so that no platform's sine function decides a pixel.
pub fn arc_points(centre: Point, from: Point, to: Point, halvings: u32) -> Vec<Point> {
    let radius = from.distance(centre);
    let mut points = vec![from, to];
    for _ in 0..halvings.min(10) {
        let mut finer = Vec::with_capacity(points.len() * 2);
        for pair in points.windows(2) {
            finer.push(pair[0]);
            let bisector = (pair[0] - centre) + (pair[1] - centre);
            // Half a turn has no bisector: go left.
            let direction = bisector.unit().or_else(|| (pair[0] - centre).left().unit());
            finer.push(direction.map_or(centre, |direction| centre + direction * radius));
        }
        finer.push(to);
        points = finer;
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plan_and_screen_are_inverse() {
        let view =
            View { width_px: 640.0, height_px: 480.0, px_per_m: 37.0, centre: Point::new(3.0, -7.0), pixel_ratio: 2.0 };
        let point = Point::new(1.25, -4.5);
        assert!(view.plan_from_screen(view.screen_from_plan(point)).distance(point) < 1e-12);
        assert_eq!(view.screen_from_plan(view.centre), Point::new(320.0, 240.0));
    }

    #[test]
    fn fitting_shows_all_and_survives_nothing() {
        let bounds = Bounds::of([Point::new(0.0, 0.0), Point::new(10.0, 2.0)]);
        let view = View::fitting(bounds, 220.0, 100.0, 10.0);
        assert_eq!(view.px_per_m, 20.0);
        for bounds in [Bounds::EMPTY, Bounds::of([Point::new(1.0, 1.0)])] {
            assert_eq!(View::fitting(bounds, 100.0, 100.0, 10.0).px_per_m, 50.0);
        }
    }

    #[test]
    fn arc_points_lie_on_the_circle() {
        let points = arc_points(Point::new(1.0, 1.0), Point::new(2.0, 1.0), Point::new(1.0, 2.0), 3);
        assert_eq!(points.len(), 9);
        assert!(points.iter().all(|p| (p.distance(Point::new(1.0, 1.0)) - 1.0).abs() < 1e-12));
        assert!((points[4].x - points[4].y).abs() < 1e-12);
    }
}
