//! A robot's map drawn as in the paper (Fig. 2): known free space white, unknown space grey, obstacles
//! black, the path red.

use super::scene::{Frame, Group, Item, Layer, Length, Scene, View};
use super::{LabelColours, Palette, Theme};
use crate::geometry::areas::{self, Shapes};
use crate::geometry::{Bounds, Point, Segment};

/// What to draw, in map coordinates.
#[derive(Clone, Copy, Debug)]
pub struct LineMapDrawing<'a> {
    /// Obstacles.
    pub segments: &'a [Segment],
    /// Known free space; empty if unknown.
    pub free: &'a Shapes,
    /// The robot's path.
    pub path: &'a [Point],
}

/// Margin around the map, in pixels.
const MARGIN_PX: f64 = 24.0;
const LINE_PX: f64 = 1.6;
const PATH_PX: f64 = 1.2;

impl LineMapDrawing<'_> {
    /// The scene, with its longer side `longest_px` pixels.
    pub fn scene(&self, theme: Theme, longest_px: f64) -> Scene {
        let palette = Palette::of(theme, LabelColours::Standard);
        let ends = self.segments.iter().flat_map(|segment| [segment.a, segment.b]);
        let bounds = Bounds::of(ends.chain(self.path.iter().copied()));
        let (width, height) = (bounds.width().max(1e-3), bounds.height().max(1e-3));
        let free_px = (longest_px - 2.0 * MARGIN_PX).max(1.0);
        let scale = free_px / width.max(height);
        let side = |length: f64| (length * scale).ceil() + 2.0 * MARGIN_PX;
        let view = View::fitting(bounds, side(width), side(height), MARGIN_PX);
        let free = self.free.iter().filter_map(|shape| {
            let (outer, holes) = shape.split_first()?;
            let holes = holes.iter().map(areas::points).collect();
            Some(Item::Polygon { outer: areas::points(outer), holes, colour: palette.paper })
        });
        let obstacles = self.segments.iter().map(|segment| Item::Line {
            points: vec![segment.a, segment.b],
            closed: false,
            colour: palette.wall,
            width: Length::Px(LINE_PX),
            dash: None,
        });
        let path = Item::Line {
            points: self.path.to_vec(),
            closed: false,
            colour: palette.error,
            width: Length::Px(PATH_PX),
            dash: None,
        };
        // Without free space the background is paper: an all-grey map says nothing.
        let background = if self.free.is_empty() { palette.paper } else { palette.not_classified };
        let group = |layer, items| Group::new(layer, Frame::Plan, items);
        let groups = vec![
            group(Layer::Rooms, free.collect()),
            group(Layer::Graph, if self.path.len() > 1 { vec![path] } else { Vec::new() }),
            group(Layer::Walls, obstacles.collect()),
        ];
        Scene { view, background, groups }
    }
}
