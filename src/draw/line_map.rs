//! A robot's map drawn as in the paper (Fig. 2): known free space white, unknown space grey, obstacles
//! black, the path red.

use super::font::CAP_HEIGHT;
use super::scene::{Anchor, Frame, Group, Item, Layer, Length, Scene, View, Weight};
use super::sheet::{Band, Entry, fitted_text, legend, scale_bar, sheet_text_px, text_item};
use super::{LabelColours, Palette, Rgba, Theme};
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

/// The colour of unknown space.
fn unknown(palette: &Palette) -> Rgba {
    palette.grid_major
}

impl LineMapDrawing<'_> {
    /// What it covers.
    fn bounds(&self) -> Bounds {
        let ends = self.segments.iter().flat_map(|segment| [segment.a, segment.b]);
        Bounds::of(ends.chain(self.path.iter().copied()))
    }

    /// The scene, with its longer side `longest_px` pixels.
    pub fn scene(&self, theme: Theme, longest_px: f64) -> Scene {
        let bounds = self.bounds();
        let (width, height) = (bounds.width().max(1e-3), bounds.height().max(1e-3));
        let free_px = (longest_px - 2.0 * MARGIN_PX).max(1.0);
        let scale = free_px / width.max(height);
        let side = |length: f64| (length * scale).ceil() + 2.0 * MARGIN_PX;
        let view = View::fitting(bounds, side(width), side(height), MARGIN_PX);
        self.scene_in(theme, view)
    }

    /// The scene on a page with a title, a legend and a scale bar, its longer side `longest_px` pixels.
    pub fn page(&self, theme: Theme, longest_px: f64, title: &str) -> Scene {
        let palette = Palette::of(theme, LabelColours::Standard);
        let text = sheet_text_px(longest_px);
        let margin = 2.0 * text;
        let title_px = 1.6 * text;
        let entry = |colour, text: &str| Entry { colour, text: text.to_owned() };
        let mut entries = vec![entry(palette.wall, "Wall")];
        if self.path.len() > 1 {
            entries.push(entry(palette.error, "Path"));
        }
        if !self.free.is_empty() {
            entries.extend([entry(palette.paper, "Free"), entry(unknown(palette), "Unknown")]);
        }
        let bounds = self.bounds();
        let (wide_m, high_m) = (bounds.width().max(1e-3), bounds.height().max(1e-3));
        let above = margin + title_px * CAP_HEIGHT + text;
        let below = |width: f64| Band::new(&entries, width, margin, text, true).height + text + margin;
        let narrowest = 0.5 * longest_px;
        let high = (longest_px - above - below(narrowest)) / high_m;
        let scale = ((longest_px - 2.0 * margin) / wide_m).min(high).max(1e-6);
        let width = (wide_m * scale + 2.0 * margin).max(narrowest).round();
        let below = below(width);
        let height = (high_m * scale + above + below).max(0.3 * longest_px).round();
        let fitted = View::fitting(bounds, width - 2.0 * margin, height - above - below, 0.0);
        // The middle of the page's free part shows the middle of the map.
        let up_m = (above - below) / 2.0 / fitted.px_per_m;
        let centre = Point::new(fitted.centre.x, fitted.centre.y + up_m);
        let view = View { width_px: width, height_px: height, centre, ..fitted };
        let mut scene = self.scene_in(theme, view);

        let baseline = Point::new(margin, margin + title_px * CAP_HEIGHT);
        let title = fitted_text(title, Weight::SemiBold, title_px, width - 2.0 * margin);
        let mut items = vec![text_item(baseline, title, title_px, Weight::SemiBold, palette.ink, Anchor::Start)];
        let foot = height - margin;
        items.extend(scale_bar(palette, &view, Point::new(margin, foot), text));
        let band = Band::new(&entries, width, margin, text, true);
        items.extend(legend(palette, &entries, &band, width - margin, foot, text));
        scene.groups.push(Group::new(Layer::Sheet, Frame::Screen, items));
        scene
    }

    fn scene_in(&self, theme: Theme, view: View) -> Scene {
        let palette = Palette::of(theme, LabelColours::Standard);
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
        let background = if self.free.is_empty() { palette.paper } else { unknown(palette) };
        let group = |layer, items| Group::new(layer, Frame::Plan, items);
        let groups = vec![
            group(Layer::Rooms, free.collect()),
            group(Layer::Graph, if self.path.len() > 1 { vec![path] } else { Vec::new() }),
            group(Layer::Walls, obstacles.collect()),
        ];
        Scene { view, background, groups }
    }
}
