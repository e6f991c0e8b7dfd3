//! Dimension chains as draughtsmen draw them: a line, a slash at each measured point, thin lines to what is measured,
//! and the figures above the line, to be read from below or from the right.

use super::font::Font;
use super::scene::{Anchor, Frame, Group, Item, Layer, Length, Text, View, Weight};
use super::{Rgba, SMALLEST_TEXT_PX, Style};
use crate::geometry::{Bounds, Point, Segment, Vector};
use crate::plan::{DimensionId, DimensionLine, Plan};

/// Half of a slash, and how far lines go beyond it, in pixels.
const SLASH_PX: f64 = 4.5;

/// From what is measured to where its line begins, in pixels.
const GAP_PX: f64 = 4.0;

/// Between the line and the figures, in pixels.
const FIGURE_PX: f64 = 3.5;

/// Size of the figures as a share of that of room names.
const FIGURE_SIZE: f64 = 0.85;

/// Figures nearer to level or upright than this, as a sine, stand along the line; others stay level.
const SQUARE: f64 = 1e-6;

/// All chains of a plan that measure something.
pub fn lines(plan: &Plan) -> Vec<(DimensionId, DimensionLine)> {
    plan.dimensions().filter_map(|(id, dimension)| Some((id, plan.dimension_line(dimension)?))).collect()
}

/// The line of a chain, from its first slash to its last.
pub fn segment(line: &DimensionLine) -> Option<Segment> {
    Some(Segment::new(line.ticks.first()?.1, line.ticks.last()?.1))
}

/// The box of chains with room for their figures, in metres.
pub(super) fn bounds(lines: &[(DimensionId, DimensionLine)]) -> Bounds {
    // As much as a figure is high on a page.
    const FIGURES_M: f64 = 0.3;
    let on_line = lines.iter().flat_map(|(_, line)| line.ticks.iter().map(|(_, on_line)| *on_line));
    let bounds = Bounds::of(on_line);
    if bounds.is_empty() { bounds } else { bounds.inflated(FIGURES_M) }
}

/// Chains in a view, a group each.
pub fn groups(lines: &[(DimensionId, DimensionLine)], style: &Style, view: &View) -> Vec<Group> {
    if !style.layers.dimensions {
        return Vec::new();
    }
    lines.iter().map(|(id, line)| group(*id, line, style.palette().ink, style, view)).collect()
}

/// A chain in a view, in a colour.
pub fn group(id: DimensionId, line: &DimensionLine, ink: Rgba, style: &Style, view: &View) -> Group {
    let px = |length_px: f64| length_px / view.px_per_m;
    let stroke = |points: Vec<Point>, width_px: f64| Item::Line {
        points,
        closed: false,
        colour: ink,
        width: Length::Px(width_px),
        dash: None,
    };
    let along = reading_direction(line.along);
    let above = along.left();
    let beyond = along * px(SLASH_PX);
    let mut items = Vec::new();
    if let Some(Segment { a, b }) = segment(line) {
        let (a, b) = if along.dot(line.along) > 0.0 { (a, b) } else { (b, a) };
        items.push(stroke(vec![a + -beyond, b + beyond], 1.0));
    }
    for &(measured, on_line) in &line.ticks {
        let way = on_line - measured;
        if let Some(towards) = way.unit()
            && way.length() > px(GAP_PX)
        {
            items.push(stroke(vec![measured + towards * px(GAP_PX), on_line + towards * px(SLASH_PX)], 0.75));
        }
        let slash = (along + above) * px(SLASH_PX);
        items.push(stroke(vec![on_line + -slash, on_line + slash], 1.75));
    }
    items.extend(figures(line, ink, style, view.px_per_m).into_iter().map(Item::Text));
    let title =
        format!("Dimension: {}", line.lengths_m().map(|m| style.units.dimension(m)).collect::<Vec<_>>().join(" + "));
    Group { element: id.to_string(), title, ..Group::new(Layer::Dimensions, Frame::Plan, items) }
}

/// The figures of a chain, one a stretch.
fn figures(line: &DimensionLine, ink: Rgba, style: &Style, px_per_m: f64) -> Vec<Text> {
    let along = reading_direction(line.along);
    let size_px = (style.text_px * FIGURE_SIZE).max(SMALLEST_TEXT_PX.min(style.text_px));
    let mut is_raised = false;
    let stretches = line.ticks.windows(2).zip(line.lengths_m());
    let placed = stretches.map(|(pair, length_m)| {
        let content = style.units.dimension(length_m);
        let width_px = Font::of(Weight::Regular).width_px(&content, size_px);
        let is_tight = width_px + 2.0 > length_m * px_per_m;
        // Between slashes that are close the figure stands higher, and every other one higher still.
        let level = if !is_tight { 0.0 } else { 1.0 + f64::from(u8::from(is_raised)) };
        is_raised = is_tight && !is_raised;
        figure(pair[0].1.midpoint(pair[1].1), along, level, content, size_px, ink, style)
    });
    placed.collect()
}

/// The stretch of a chain whose figure is at a point, in order along the line.
pub fn figure_at(line: &DimensionLine, point: Point, style: &Style, px_per_m: f64) -> Option<usize> {
    figures(line, style.palette().ink, style, px_per_m).iter().position(|text| {
        // On the screen, y down, from the text's anchor: the middle of its baseline.
        let way = (point - text.at) * px_per_m;
        let off = Vector::new(way.x, -way.y) - text.offset_px;
        let (across_px, up_px) = if text.upright { (off.y, -off.x) } else { (off.x, -off.y) };
        let half_px = Font::of(text.weight).width_px(&text.content, text.size_px) / 2.0;
        across_px.abs() <= half_px + NEAR_PX && (-NEAR_PX..=text.size_px + NEAR_PX).contains(&up_px)
    })
}

/// A click so near to a figure is on it, in pixels.
const NEAR_PX: f64 = 2.0;

/// The direction in which figures on a line are read: to the right, or upwards.
fn reading_direction(along: Vector) -> Vector {
    if along.x > SQUARE || (along.x > -SQUARE && along.y > 0.0) { along } else { -along }
}

/// A figure above the middle of its stretch, `level` lines of text further away.
fn figure(at: Point, along: Vector, level: f64, content: String, size_px: f64, ink: Rgba, style: &Style) -> Text {
    let off_px = FIGURE_PX + level * size_px;
    let upright = along.x.abs() <= SQUARE;
    let is_level = along.y.abs() <= SQUARE;
    // On screen y points down; the text's anchor is on its baseline.
    let offset_px = if upright {
        Vector::new(-off_px, 0.0)
    } else if is_level {
        Vector::new(0.0, -off_px)
    } else {
        // Level beside an oblique line: its middle as far away as half its height.
        let above = along.left();
        let centre = Vector::new(above.x, -above.y) * (off_px + size_px);
        Vector::new(centre.x, centre.y + size_px * 0.35)
    };
    Text {
        at,
        offset_px,
        content,
        size_px,
        weight: Weight::Regular,
        colour: ink,
        // Raised figures may stand on the lines to what is measured.
        halo: (style.halo || level > 0.0 || !(upright || is_level)).then(|| style.palette().halo),
        anchor: Anchor::Middle,
        upright,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_are_read_from_below_or_from_the_right() {
        for (x, y, read_x, read_y) in [
            (1.0, 0.0, 1.0, 0.0),
            (-1.0, 0.0, 1.0, 0.0),
            (0.0, -1.0, 0.0, 1.0),
            (0.0, 1.0, 0.0, 1.0),
            (-0.6, 0.8, 0.6, -0.8),
        ] {
            assert_eq!(reading_direction(Vector::new(x, y)), Vector::new(read_x, read_y), "{x}, {y}");
        }
    }
}
