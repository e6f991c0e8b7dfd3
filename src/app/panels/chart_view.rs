//! A chart in a panel: pointing at a mark tells what it is; where it is wanted, dragging brushes dots, or a box that the arrow keys
//! move.

use std::collections::BTreeSet;

use egui::{EventFilter, Id, Key, Pos2, Rect, Response, Role, Sense, Stroke, StrokeKind, Ui, Vec2, WidgetInfo, vec2};

use crate::app::look::theme;
use crate::app::look::widgets::{colours, focus_ring};
use crate::app::paint::chart::{paint, place};
use crate::chart::{Chart, Layout, Marks};
use crate::draw::Palette;
use crate::geometry::Point;

/// How near a dot the pointer must be, in points.
const NEAR: f32 = 7.0;

/// What was done with a chart.
pub(super) struct Seen {
    pub response: Response,
    /// The dots of a brush that has ended; empty where it had none.
    pub brushed: Option<BTreeSet<usize>>,
    /// The dot that was clicked.
    pub clicked: Option<usize>,
}

/// Shows a chart over the width that is left. `told` says what a dot is; without it, dots are not brushed.
pub(super) fn show(
    ui: &mut Ui,
    palette: &Palette,
    chart: &Chart,
    height: f32,
    marked: &BTreeSet<usize>,
    told: Option<&dyn Fn(usize) -> String>,
) -> Seen {
    let sense = if told.is_some() { Sense::click_and_drag() } else { Sense::hover() };
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), height), sense);
    let said = chart.said();
    response.widget_info(|| WidgetInfo::labeled(Role::Image, ui.is_enabled(), &said));
    let mut seen = Seen { response, brushed: None, clicked: None };
    if !ui.is_rect_visible(rect) {
        return seen;
    }
    let layout = chart.layout(f64::from(rect.width()), f64::from(rect.height()));
    let scene = chart.scene(palette, &layout, f64::from(ui.pixels_per_point()), marked);
    let painter = ui.painter().with_clip_rect(rect.intersect(ui.clip_rect()));
    painter.rect_filled(rect, theme::RADIUS, theme::colour(palette.paper));
    paint(&painter, rect, &scene);
    painter.rect_stroke(rect, theme::RADIUS, Stroke::new(1.0, colours(ui).border), StrokeKind::Inside);
    focus_ring(ui, rect, &seen.response);
    let pointer = seen.response.hover_pos();
    if told.is_some() {
        brush(ui, rect, chart, &layout, &mut seen);
        brush_by_keys(ui, rect, chart, &layout, &mut seen);
    }
    if let Some(pointer) = pointer {
        let at = Point::new(f64::from(pointer.x - rect.left()), f64::from(pointer.y - rect.top()));
        let text = under(chart, &layout, at, told);
        if let Some((text, key)) = text {
            if seen.response.clicked() {
                seen.clicked = key;
            }
            seen.response = seen.response.on_hover_text_at_pointer(text);
        }
    }
    seen
}

/// What is under a point of the chart: what it says, and of a dot its key.
fn under(
    chart: &Chart,
    layout: &Layout,
    at: Point,
    told: Option<&dyn Fn(usize) -> String>,
) -> Option<(String, Option<usize>)> {
    let mut nearest: Option<(f64, usize)> = None;
    for series in chart.series.iter().rev() {
        match &series.marks {
            Marks::Bars(bars) => {
                for bar in bars {
                    let (p, q) = (layout.at(bar.across[0], bar.up[0]), layout.at(bar.across[1], bar.up[1]));
                    let is_in = (p.x..=q.x).contains(&at.x) && (q.y..=p.y).contains(&at.y);
                    if is_in && !bar.said.is_empty() {
                        return Some((bar.said.clone(), None));
                    }
                }
            }
            Marks::Dots(dots) => {
                for dot in dots {
                    let distance = chart.place(layout, dot).distance(at);
                    if distance <= f64::from(NEAR) && nearest.is_none_or(|(least, _)| distance < least) {
                        nearest = Some((distance, dot.key));
                    }
                }
            }
            Marks::Line(points) => {
                let near = points.iter().find(|it| layout.at(it.across, it.up).distance(at) <= f64::from(NEAR));
                if let Some(point) = near {
                    let spread = if point.deviation > 0.0 {
                        format!(" ± {:.1}", 100.0 * point.deviation)
                    } else {
                        String::new()
                    };
                    let text = format!("{}: {:.1}{spread} % at {:.0}", series.name, 100.0 * point.up, point.across);
                    return Some((text, None));
                }
            }
            Marks::Levels(_) => {}
        }
    }
    let (_, key) = nearest?;
    Some((told?(key), Some(key)))
}

/// Draws the brush, and takes what it holds when it ends.
fn brush(ui: &Ui, rect: Rect, chart: &Chart, layout: &Layout, seen: &mut Seen) {
    let id = Id::unique(("brush", seen.response.id));
    if seen.response.drag_started()
        && let Some(start) = seen.response.interact_pointer_pos()
    {
        let start = ui.input(|input| input.pointer.press_origin()).unwrap_or(start);
        ui.data_mut(|data| data.insert_temp(id, start));
    }
    let start: Option<egui::Pos2> = ui.data(|data| data.get_temp(id));
    let (Some(start), Some(end)) = (start, seen.response.interact_pointer_pos()) else { return };
    let brushed = Rect::from_two_pos(start, end);
    if seen.response.dragged() {
        paint_brush(ui, rect, brushed);
    }
    if seen.response.drag_stopped() {
        ui.data_mut(|data| data.remove::<Pos2>(id));
        seen.brushed = Some(dots_in(rect, chart, layout, brushed));
    }
}

/// How far an arrow key moves or stretches the box of the keyboard, in points.
const STEP: f32 = 8.0;

/// The side of that box at first, in points.
const SIDE: f32 = 48.0;

/// The same without a pointer: while the chart has the keyboard, arrows move a box, Shift and arrows stretch it, Enter picks the
/// dots in it.
fn brush_by_keys(ui: &Ui, rect: Rect, chart: &Chart, layout: &Layout, seen: &mut Seen) {
    if !seen.response.has_focus() || seen.response.dragged() {
        return;
    }
    // Arrows would go to the next control otherwise.
    let arrows = EventFilter { horizontal_arrows: true, vertical_arrows: true, ..EventFilter::default() };
    ui.memory_mut(|memory| memory.set_focus_lock_filter(seen.response.id, arrows));
    let id = Id::unique(("brush by keys", seen.response.id));
    // Kept from the chart's corner: the chart may move.
    let middle = Rect::from_center_size((rect.size() / 2.0).to_pos2(), Vec2::splat(SIDE));
    let mut held = ui.data(|data| data.get_temp(id)).unwrap_or(middle);
    let (moved, stretched, picks) = ui.input(|input| {
        let along = |less: Key, more: Key| {
            let pressed = |key| input.num_presses(key) as f32;
            STEP * (pressed(more) - pressed(less))
        };
        let way = vec2(along(Key::ArrowLeft, Key::ArrowRight), along(Key::ArrowUp, Key::ArrowDown));
        let (moved, stretched) = if input.modifiers.shift { (Vec2::ZERO, way) } else { (way, Vec2::ZERO) };
        (moved, stretched, input.key_pressed(Key::Enter) || input.key_pressed(Key::Space))
    });
    held = held.translate(moved);
    held.max = (held.max + stretched).max(held.min + Vec2::splat(STEP));
    // Never wholly outside.
    let within = Rect::from_min_size(Pos2::ZERO, rect.size());
    let over = held.center() - within.clamp(held.center());
    held = held.translate(-over);
    ui.data_mut(|data| data.insert_temp(id, held));
    let brushed = held.translate(rect.min.to_vec2());
    paint_brush(ui, rect, brushed);
    if picks {
        seen.brushed = Some(dots_in(rect, chart, layout, brushed));
    }
}

fn paint_brush(ui: &Ui, rect: Rect, brushed: Rect) {
    let colours = colours(ui);
    let painter = ui.painter().with_clip_rect(rect);
    painter.rect_filled(brushed, 0.0, colours.accent.gamma_multiply(0.14));
    painter.rect_stroke(brushed, 0.0, Stroke::new(1.0, colours.accent), StrokeKind::Inside);
}

/// The keys of the dots in a part of a chart.
fn dots_in(rect: Rect, chart: &Chart, layout: &Layout, part: Rect) -> BTreeSet<usize> {
    let mut keys = BTreeSet::new();
    for series in &chart.series {
        if let Marks::Dots(dots) = &series.marks {
            let is_in = |dot: &&crate::chart::Dot| part.contains(place(rect, chart.place(layout, dot)));
            keys.extend(dots.iter().filter(is_in).map(|dot| dot.key));
        }
    }
    keys
}
