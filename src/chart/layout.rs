//! Where everything of a chart lies in a picture of a size, and the picture as a scene.

use std::collections::BTreeSet;

use super::{Axis, Chart, Marks, Scale, Series, Tick, ticks};
use crate::draw::font::{CAP_HEIGHT, Font};
use crate::draw::{Anchor, Dash, Frame, Group, Item, Layer, Length, Palette, Rgba, Scene, Text, View, Weight};
use crate::geometry::{Point, Vector};

/// Sizes of texts, in logical pixels.
const TITLE_PX: f64 = 14.0;
const TEXT_PX: f64 = 11.5;

/// Space between things, in logical pixels.
const GAP: f64 = 8.0;

/// The least height above the plot of a chart with a title: charts side by side begin alike, and a window has room for a button there.
const LEAST_TOP_PX: f64 = 46.0;

/// The widest that names beside the upright axis may be.
const WIDEST_NAME_PX: f64 = 190.0;

/// With more dots, they are smaller.
const MANY_DOTS: usize = 1200;

/// A line through more points than this shows no dots.
const MOST_DOTS: usize = 40;

/// The golden ratio's fraction: its multiples spread evenly between 0 and 1.
const SPREAD: f64 = 0.618_033_988_749_895;

/// Where a chart lies in a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Layout {
    pub width_px: f64,
    pub height_px: f64,
    /// The corners of the area between the axes: upper left, lower right.
    pub plot: [Point; 2],
    across: Ends,
    up: Ends,
    across_ticks: Vec<Tick>,
    up_ticks: Vec<Tick>,
}

/// The ends of an axis, and how values lie between them.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Ends {
    from: f64,
    to: f64,
    is_log: bool,
}

impl Ends {
    fn of(axis: &Axis, values: impl Iterator<Item = f64>) -> Self {
        let is_log = axis.scale == Scale::Log;
        let usable = |value: &f64| value.is_finite() && (!is_log || *value > 0.0);
        let (mut from, mut to) = values
            .filter(usable)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(from, to), value| (from.min(value), to.max(value)));
        match (&axis.scale, axis.range) {
            (_, Some([first, last])) => (from, to) = (first, last),
            (Scale::Named(names), None) => (from, to) = (-0.5, names.len().max(1) as f64 - 0.5),
            _ if from > to => (from, to) = if is_log { (1.0, 10.0) } else { (0.0, 1.0) },
            (Scale::Log, None) => (from, to) = (from / 1.15, to * 1.15),
            (Scale::Whole, None) => (from, to) = (from - 0.5, to + 0.5),
            (Scale::Share, None) => (from, to) = (from.min(0.0), to.max(0.01)),
            (Scale::Linear, None) => {
                let margin = 0.04 * (to - from);
                (from, to) = (if from >= 0.0 && from < 0.3 * to { 0.0 } else { from - margin }, to + margin);
            }
        }
        if to <= from {
            (from, to) = if is_log { (from / 2.0, from * 2.0) } else { (from - 0.5, from + 0.5) };
        }
        Self { from, to, is_log }
    }

    /// A value as a share of the axis: 0 at its start, 1 at its end.
    fn share(&self, value: f64) -> f64 {
        let share = if self.is_log {
            (value.max(f64::MIN_POSITIVE) / self.from).ln() / (self.to / self.from).ln()
        } else {
            (value - self.from) / (self.to - self.from)
        };
        if share.is_finite() { share.clamp(-0.05, 1.05) } else { 0.0 }
    }

    fn value(&self, share: f64) -> f64 {
        if self.is_log {
            self.from * (self.to / self.from).powf(share)
        } else {
            self.from + share * (self.to - self.from)
        }
    }
}

impl Chart {
    /// The values on both axes that the ends must span.
    fn values(&self) -> (Vec<f64>, Vec<f64>) {
        let (mut across, mut up) = (Vec::new(), Vec::new());
        for series in &self.series {
            match &series.marks {
                Marks::Bars(bars) | Marks::Levels(bars) => {
                    across.extend(bars.iter().flat_map(|bar| bar.across));
                    up.extend(bars.iter().flat_map(|bar| bar.up));
                }
                Marks::Dots(dots) => {
                    across.extend(dots.iter().map(|dot| dot.across));
                    up.extend(dots.iter().map(|dot| dot.up));
                }
                Marks::Line(points) => {
                    across.extend(points.iter().map(|point| point.across));
                    up.extend(points.iter().flat_map(|point| [point.up - point.deviation, point.up + point.deviation]));
                }
            }
        }
        (across, up)
    }

    /// Lays the chart out in a picture of a size in logical pixels.
    pub fn layout(&self, width_px: f64, height_px: f64) -> Layout {
        let (width_px, height_px) = (width_px.max(60.0), height_px.max(60.0));
        let (across, up) = self.values();
        let (across, up) = (Ends::of(&self.across, across.into_iter()), Ends::of(&self.up, up.into_iter()));
        let font = Font::of(Weight::Regular);
        let mut top = GAP;
        if !self.title.is_empty() {
            top += TITLE_PX + GAP;
        }
        if self.has_legend {
            top += self.legend(width_px).last().map_or(0.0, |(at, _)| at.y + TEXT_PX) + GAP;
        }
        if !self.up.title.is_empty() {
            // Level above the axis, where it is read without turning the head.
            top += TEXT_PX + 6.0;
        }
        if !self.title.is_empty() {
            top = top.max(LEAST_TOP_PX);
        }
        let bottom = height_px - GAP - (TEXT_PX + 7.0) - if self.across.title.is_empty() { 0.0 } else { TEXT_PX + 6.0 };
        let mut up_ticks = ticks(&self.up.scale, up.from, up.to, ((bottom - top) / 36.0).max(2.0) as usize);
        for tick in &mut up_ticks {
            tick.text = elided(&tick.text, WIDEST_NAME_PX.min(0.4 * width_px), font);
        }
        let widest = up_ticks.iter().map(|tick| font.width_px(&tick.text, TEXT_PX)).fold(0.0, f64::max);
        let plot = [Point::new((GAP + widest + 7.0).round(), top.round()), Point::new(width_px - 18.0, bottom.round())];
        let room = plot[1].x - plot[0].x;
        let mut across_ticks = ticks(&self.across.scale, across.from, across.to, (room / 56.0).max(2.0) as usize);
        if matches!(self.across.scale, Scale::Named(_)) {
            let each = room / across_ticks.len().max(1) as f64 - 6.0;
            for tick in &mut across_ticks {
                tick.text = elided(&tick.text, each, font);
            }
        }
        Layout { width_px, height_px, plot, across, up, across_ticks, up_ticks }
    }

    /// Where the names of the series stand, below the title, from the legend's top; and which.
    fn legend(&self, width_px: f64) -> Vec<(Point, usize)> {
        let font = Font::of(Weight::Regular);
        let (mut at, mut placed) = (Point::new(GAP, 0.0), Vec::new());
        // Bars at named places are named there.
        let is_named = [&self.across, &self.up].iter().any(|axis| matches!(axis.scale, Scale::Named(_)));
        let is_told = |series: &Series| !(is_named && matches!(series.marks, Marks::Bars(_)));
        for (index, series) in self.series.iter().enumerate().filter(|(_, series)| is_told(series)) {
            let width = 16.0 + font.width_px(&series.name, TEXT_PX) + 16.0;
            if at.x > GAP && at.x + width > width_px {
                at = Point::new(GAP, at.y + TEXT_PX + 6.0);
            }
            placed.push((at, index));
            at.x += width;
        }
        placed
    }

    /// The chart as a picture of a size in logical pixels. The dots with the keys `marked` stand out, if there are any.
    pub fn scene(&self, palette: &Palette, layout: &Layout, pixel_ratio: f64, marked: &BTreeSet<usize>) -> Scene {
        let view = View {
            width_px: layout.width_px,
            height_px: layout.height_px,
            px_per_m: 1.0,
            centre: Point::default(),
            pixel_ratio,
        };
        let mut groups = vec![self.frame(palette, layout)];
        for series in &self.series {
            let colour = series.ink.colour(palette);
            match &series.marks {
                Marks::Bars(bars) => groups.extend(bars.iter().map(|bar| {
                    let [p, q] = [layout.at(bar.across[0], bar.up[0]), layout.at(bar.across[1], bar.up[1])];
                    let outer = vec![p, Point::new(q.x, p.y), q, Point::new(p.x, q.y)];
                    let item = Item::Polygon { outer, holes: Vec::new(), colour };
                    Group { title: bar.said.clone(), ..group(vec![item]) }
                })),
                Marks::Levels(bars) => groups.extend(bars.iter().map(|bar| {
                    let points = vec![layout.at(bar.across[0], bar.up[1]), layout.at(bar.across[1], bar.up[1])];
                    Group { title: bar.said.clone(), ..group(vec![line(points, palette.ink, 2.0)]) }
                })),
                Marks::Dots(dots) => {
                    let radius = if dots.len() > MANY_DOTS { 1.8 } else { 2.8 };
                    let faded = if marked.is_empty() { 0.75 } else { 0.22 };
                    let mut items = Vec::with_capacity(dots.len());
                    let mut above = Vec::new();
                    for dot in dots {
                        let centre = self.place(layout, dot);
                        if marked.contains(&dot.key) {
                            let rim = Some((palette.ink, Length::Px(1.0)));
                            above.push(disc(centre, radius + 0.8, colour, rim));
                        } else {
                            items.push(disc(centre, radius, colour.with_alpha((255.0 * faded) as u8), None));
                        }
                    }
                    groups.push(group(items));
                    groups.push(group(above));
                }
                Marks::Line(points) => {
                    let at: Vec<Point> = points.iter().map(|point| layout.at(point.across, point.up)).collect();
                    let mut items = Vec::new();
                    for point in points.iter().filter(|point| point.deviation > 0.0) {
                        let ends = [point.up - point.deviation, point.up + point.deviation];
                        // No share is above all, whatever its deviation.
                        let ends = ends.map(|up| up.clamp(layout.up.from, layout.up.to));
                        items.push(line(
                            ends.map(|up| layout.at(point.across, up)).to_vec(),
                            colour.with_alpha(0x90),
                            1.0,
                        ));
                    }
                    if at.len() > 1 {
                        items.push(line(at.clone(), colour, 2.0));
                    }
                    // Dots that touch each other hide the line.
                    let dots = if at.len() > MOST_DOTS { Vec::new() } else { at };
                    items.extend(dots.into_iter().map(|centre| disc(centre, 3.0, colour, None)));
                    groups.push(group(items));
                }
            }
        }
        groups.retain(|group| !group.items.is_empty());
        Scene { view, background: palette.paper, groups }
    }

    /// Where a dot is drawn: on an axis of counts a little beside its value, always the same way.
    pub fn place(&self, layout: &Layout, dot: &super::Dot) -> Point {
        let shift = |axis: &Axis, turn: f64| match axis.scale {
            Scale::Whole => 0.7 * (((dot.key + 1) as f64 * turn).fract() - 0.5),
            Scale::Linear | Scale::Share | Scale::Log | Scale::Named(_) => 0.0,
        };
        layout.at(dot.across + shift(&self.across, SPREAD), dot.up + shift(&self.up, SPREAD * SPREAD))
    }

    /// Title, legend, axes and ticks.
    fn frame(&self, palette: &Palette, layout: &Layout) -> Group {
        let [start, end] = layout.plot;
        let mut items = Vec::new();
        let mut y = GAP;
        if !self.title.is_empty() {
            let content = elided(&self.title, layout.width_px - 2.0 * GAP, Font::of(Weight::SemiBold));
            let at = Point::new(GAP, y + TITLE_PX * 0.85);
            let text = text(at, content, palette.ink, Anchor::Start);
            items.push(Item::Text(Text { size_px: TITLE_PX, weight: Weight::SemiBold, ..text }));
            y += TITLE_PX + GAP;
        }
        if self.has_legend {
            for (at, index) in self.legend(layout.width_px) {
                let series = &self.series[index];
                let middle = y + at.y + TEXT_PX / 2.0;
                let colour = series.ink.colour(palette);
                match series.marks {
                    Marks::Levels(_) => {
                        let ends = [at.x, at.x + 10.0].map(|x| Point::new(x, middle)).to_vec();
                        items.push(line(ends, palette.ink, 2.0));
                    }
                    _ => items.push(disc(Point::new(at.x + 5.0, middle), 4.5, colour, None)),
                }
                let baseline = middle + TEXT_PX * CAP_HEIGHT / 2.0;
                let at = Point::new(at.x + 16.0, baseline);
                items.push(Item::Text(text(at, series.name.clone(), palette.ink_muted, Anchor::Start)));
            }
        }
        for tick in &layout.up_ticks {
            let y = layout.at(0.0, tick.at).y;
            if !matches!(self.up.scale, Scale::Named(_)) {
                items.push(line(vec![Point::new(start.x, y), Point::new(end.x, y)], palette.grid_major, 1.0));
            }
            let at = Point::new(start.x - 7.0, y + TEXT_PX * CAP_HEIGHT / 2.0);
            items.push(Item::Text(text(at, tick.text.clone(), palette.ink_muted, Anchor::End)));
        }
        for tick in &layout.across_ticks {
            let x = layout.at(tick.at, 0.0).x;
            if !matches!(self.across.scale, Scale::Named(_)) {
                items.push(line(vec![Point::new(x, end.y), Point::new(x, end.y + 4.0)], palette.boundary, 1.0));
            }
            let at = Point::new(x, end.y + 7.0 + TEXT_PX * CAP_HEIGHT);
            items.push(Item::Text(text(at, tick.text.clone(), palette.ink_muted, Anchor::Middle)));
        }
        items.push(line(vec![Point::new(start.x, end.y), Point::new(end.x, end.y)], palette.boundary, 1.0));
        if !self.across.title.is_empty() {
            let at = Point::new(end.x, layout.height_px - GAP - 1.0);
            items.push(Item::Text(text(at, self.across.title.clone(), palette.ink, Anchor::End)));
        }
        if !self.up.title.is_empty() {
            let at = Point::new(GAP, start.y - 9.0);
            items.push(Item::Text(text(at, self.up.title.clone(), palette.ink, Anchor::Start)));
        }
        if matches!(self.up.scale, Scale::Named(_)) {
            items.push(line(vec![start, Point::new(start.x, end.y)], palette.boundary, 1.0));
        }
        group(items)
    }
}

impl Layout {
    /// Where a pair of values lies, in logical pixels from the upper left corner of the picture.
    pub fn at(&self, across: f64, up: f64) -> Point {
        let [start, end] = self.plot;
        Point::new(
            start.x + self.across.share(across) * (end.x - start.x),
            end.y - self.up.share(up) * (end.y - start.y),
        )
    }

    /// The values at a position, across and up; beyond the axes those beyond their ends.
    pub fn values_at(&self, point: Point) -> (f64, f64) {
        let [start, end] = self.plot;
        let across = (point.x - start.x) / (end.x - start.x);
        let up = (end.y - point.y) / (end.y - start.y);
        (self.across.value(across), self.up.value(up))
    }
}

fn group(items: Vec<Item>) -> Group {
    Group::new(Layer::Sheet, Frame::Screen, items)
}

fn line(points: Vec<Point>, colour: Rgba, width_px: f64) -> Item {
    Item::Line { points, closed: false, colour, width: Length::Px(width_px), dash: None::<Dash> }
}

fn disc(centre: Point, radius_px: f64, fill: Rgba, outline: Option<(Rgba, Length)>) -> Item {
    Item::Disc { centre, radius: Length::Px(radius_px), fill: Some(fill), outline }
}

fn text(at: Point, content: String, colour: Rgba, anchor: Anchor) -> Text {
    Text {
        at,
        offset_px: Vector::default(),
        content,
        size_px: TEXT_PX,
        weight: Weight::Regular,
        colour,
        halo: None,
        anchor,
        upright: false,
    }
}

/// A text cut with an ellipsis at a width.
fn elided(text: &str, width_px: f64, font: &Font) -> String {
    if font.width_px(text, TEXT_PX) <= width_px {
        return text.to_owned();
    }
    let mut kept = String::new();
    for character in text.chars() {
        kept.push(character);
        if font.width_px(&kept, TEXT_PX) + font.width_px("…", TEXT_PX) > width_px {
            kept.pop();
            break;
        }
    }
    format!("{}…", kept.trim_end())
}

#[cfg(test)]
mod tests {
    use super::super::{Dot, Ink};
    use super::*;

    fn dots(scale: Scale, values: &[(f64, f64)]) -> Chart {
        let dots = values.iter().enumerate().map(|(key, &(across, up))| Dot { across, up, key }).collect();
        Chart {
            title: "A title".to_owned(),
            note: String::new(),
            across: Axis::new("Area (m²)", scale),
            up: Axis::new("Openings", Scale::Whole),
            series: vec![Series { name: "rooms".to_owned(), ink: Ink::Accent, marks: Marks::Dots(dots) }],
            has_legend: true,
        }
    }

    #[test]
    fn values_and_places_are_inverse_on_every_scale() {
        for scale in [Scale::Linear, Scale::Log] {
            let chart = dots(scale, &[(3.0, 1.0), (250.0, 9.0)]);
            let layout = chart.layout(400.0, 300.0);
            let (across, up) = layout.values_at(layout.at(40.0, 3.0));
            assert!((across - 40.0).abs() < 1e-9 && (up - 3.0).abs() < 1e-9, "{across} {up}");
        }
    }

    #[test]
    fn what_is_not_a_number_does_no_harm() {
        let chart = dots(Scale::Log, &[(f64::NAN, 1.0), (0.0, f64::INFINITY), (-4.0, 2.0)]);
        for (width, height) in [(400.0, 300.0), (0.0, 0.0)] {
            let layout = chart.layout(width, height);
            let scene =
                chart.scene(Palette::of(Default::default(), Default::default()), &layout, 1.0, &BTreeSet::new());
            for item in scene.groups.iter().flat_map(|group| &group.items) {
                if let Item::Disc { centre, .. } = item {
                    assert!(centre.x.is_finite() && centre.y.is_finite());
                }
            }
        }
    }
}
