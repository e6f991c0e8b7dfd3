//! A thing changed where it is: a small form beside it, with its name or its measures.

use egui::{Align2, Area, Frame, Id, Key, Margin, Order, RichText, TextEdit, Ui, vec2};

use crate::app::look::text::{select_all, select_when_entered};
use crate::app::look::{
    length_field::LengthField,
    theme,
    widgets::{colours, strong},
};
use crate::app::paint::places::plan_point;
use crate::app::state::{App, Here, Thing};
use crate::draw::{Style, dimensions::figure_at};
use crate::edit::{self, End, StretchChange};
use crate::geometry::{Point, Segment, trim_m};
use crate::plan::{DimensionId, ElementId, Plan, titles::title_of};

/// Widths of the names and of the fields, in points.
const NAMES: f32 = 74.0;
const FIELDS: f32 = 150.0;

/// What is changed by a text.
const TEXTS: [(&str, &str); 3] = [("Name", "rename"), ("Function", "set-function"), ("Note", "set-note")];

/// How far beside the pointer the form is, in points.
const BESIDE: f32 = 14.0;

impl App {
    /// Shows the form for an element, at the pointer or in its middle.
    pub(crate) fn change_here(&mut self, element: ElementId) {
        let Some(plan) = self.plan() else { return };
        let middle = || self.session.document.as_ref()?.bounds_of(element).map(|bounds| bounds.center());
        // From its context menu: where that was opened.
        let menu = self.panels.context_menu.as_ref().filter(|(thing, ..)| *thing == Thing::Element(element));
        let of_menu = menu.and_then(|(_, at, _)| self.canvas.seen().map(|(view, rect)| plan_point(&view, rect, *at)));
        let Some(at) = of_menu.or(self.session.pointed.at).or_else(middle) else { return };
        let texts = texts_of(plan, element);
        if let ElementId::Dimension(id) = element
            && measures_of(plan, element, at, self.canvas.px_per_m().unwrap_or(1.0)).is_empty()
        {
            let fixed = "This length is between corners or fixed points: drag those";
            let has = plan.dimension(id).is_some();
            self.session.status = if has { fixed.to_owned() } else { String::new() };
            return;
        }
        self.panels.here = Some(Here { element, at, before: texts.clone(), texts, is_shown: false });
    }
}

fn texts_of(plan: &Plan, element: ElementId) -> Vec<String> {
    let ElementId::Room(id) = element else { return Vec::new() };
    plan.room(id).map(|room| vec![room.name.clone(), room.function.clone(), room.note.clone()]).unwrap_or_default()
}

/// What is measured of an element.
struct Measure {
    name: &'static str,
    now_m: f64,
    range_m: std::ops::RangeInclusive<f64>,
    /// The command that sets it, with what stands before and after the length.
    command: &'static str,
    before: Vec<String>,
    after: Vec<String>,
    /// Which end moves when it is set.
    moves: Option<Point>,
}

impl Measure {
    const fn new(
        name: &'static str,
        now_m: f64,
        range_m: std::ops::RangeInclusive<f64>,
        command: &'static str,
    ) -> Self {
        Self { name, now_m, range_m, command, before: Vec::new(), after: Vec::new(), moves: None }
    }
}

/// The measures of an element; of a dimension chain those of the stretch at a point.
fn measures_of(plan: &Plan, element: ElementId, at: Point, px_per_m: f64) -> Vec<Measure> {
    match element {
        ElementId::Wall(id) => {
            let found = plan.wall(id).and_then(|wall| Some((plan.wall_segment(wall)?.length(), wall.thickness_m)));
            found.map_or_else(Vec::new, |(length_m, thickness_m)| {
                vec![
                    Measure::new("Length", length_m, 0.001..=1e5, "set-wall-length"),
                    Measure::new("Thickness", thickness_m, 0.0..=10.0, "set-thickness"),
                ]
            })
        }
        ElementId::Opening(id) => {
            let segment = plan.opening(id).and_then(|opening| plan.opening_segment(opening));
            segment.map_or_else(Vec::new, |segment| {
                vec![Measure::new("Width", segment.length(), 0.01..=1000.0, "set-opening-width")]
            })
        }
        ElementId::Dimension(id) => stretch_of(plan, id, at, px_per_m).unwrap_or_default(),
        ElementId::Room(_) | ElementId::Corner(_) => Vec::new(),
    }
}

/// The ways to change the stretch of a chain at a point, by its figure or else by its line.
fn stretch_of(plan: &Plan, id: DimensionId, at: Point, px_per_m: f64) -> Option<Vec<Measure>> {
    let line = plan.dimension_line(plan.dimension(id)?)?;
    let style = Style { text_px: theme::PLAN_TEXT, ..Style::default() };
    let nearest = || {
        let distance = |pair: &[(Point, Point)]| match pair {
            [p, q] => Segment::new(p.1, q.1).distance(at),
            _ => f64::INFINITY,
        };
        let stretches = line.ticks.windows(2).enumerate();
        stretches.min_by(|p, q| distance(p.1).total_cmp(&distance(q.1))).map(|(index, _)| index)
    };
    let index = figure_at(&line, at, &style, px_per_m).or_else(nearest)?;
    let (now_m, changes) = edit::dimension_stretch(plan, id, index)?;
    let ends = Segment::new(line.ticks.get(index)?.1, line.ticks.get(index + 1)?.1);
    let is_level = ends.vector().x.abs() >= ends.vector().y.abs();
    let has_both = changes.len() > 1;
    let measures = changes.into_iter().map(|change| {
        let name = match (change, change.end()) {
            (StretchChange::Width(_), _) => "Width",
            (StretchChange::Thickness(_), _) => "Thickness",
            (_, Some(end)) if has_both => match (is_level, end.of(ends) == leftmost(ends)) {
                (true, true) => "Left moves",
                (true, false) => "Right moves",
                (false, true) => "Lower moves",
                (false, false) => "Upper moves",
            },
            _ => "Distance",
        };
        Measure {
            before: vec![(index + 1).to_string()],
            after: change
                .end()
                .map(|end| if end == End::End { "end" } else { "start" }.to_owned())
                .into_iter()
                .collect(),
            moves: change.end().map(|end| end.of(ends)),
            ..Measure::new(name, now_m, 0.0001..=1e5, "set-dimension")
        }
    });
    Some(measures.collect())
}

/// The end of a line on the left or, of one that stands, the lower one.
fn leftmost(line: Segment) -> Point {
    let way = line.vector();
    let is_first = if way.x.abs() >= way.y.abs() { way.x >= 0.0 } else { way.y >= 0.0 };
    if is_first { line.a } else { line.b }
}

/// Shows the form, if one is open.
pub(super) fn show(app: &mut App, ui: &mut Ui) {
    let before_moves = app.canvas.marked_here.take();
    let Some(mut here) = app.panels.here.take() else { return };
    let is_there = app.plan().is_some_and(|plan| plan.has(here.element)) && app.picked() == Some(here.element);
    let Some(canvas) = app.canvas.seen_rect().filter(|_| is_there) else { return };
    let Some(place) = app.screen_position(here.at.x, here.at.y) else { return };
    let px_per_m = app.canvas.px_per_m().unwrap_or(1.0);
    let measures = app.plan().map(|plan| measures_of(plan, here.element, here.at, px_per_m)).unwrap_or_default();
    if measures.is_empty() && here.texts.is_empty() {
        return;
    }
    let title = app.plan().map(|plan| title_of(plan, here.element)).unwrap_or_default();
    let frame = Frame::popup(ui.style()).inner_margin(Margin::symmetric(12, 10));
    let area = Area::new(Id::unique("changed here")).order(Order::Middle).constrain_to(canvas.shrink(4.0));
    let mut calls: Vec<(&str, Vec<String>)> = Vec::new();
    let mut moves = None;
    let (mut is_entered, mut has_focus) = (false, false);
    let shown = area.pivot(Align2::LEFT_TOP).fixed_pos(place + vec2(BESIDE, BESIDE)).show(ui.ctx(), |ui| {
        frame.show(ui, |ui| {
            ui.spacing_mut().item_spacing = vec2(8.0, 6.0);
            ui.label(strong(&title, theme::BODY));
            let mut refused = String::new();
            for (index, measure) in measures.into_iter().enumerate() {
                let Measure { name, now_m, range_m, command, before, after, moves: end } = measure;
                let units = app.units();
                let field =
                    LengthField { name, now_m: trim_m(now_m), range_m, units, width: FIELDS, name_width: Some(NAMES) };
                let takes_focus = index == 0 && !here.is_shown;
                let shown =
                    ui.push_id(("here", here.element), |ui| ui.horizontal(|ui| field.show_in(ui, takes_focus)).inner);
                let (entered, response) = shown.inner;
                has_focus |= response.has_focus();
                if response.has_focus() {
                    moves = end;
                }
                is_entered |= response.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
                if let Some(length_m) = entered.length_m {
                    let words = before.into_iter().chain([format!("{length_m}m")]).chain(after);
                    calls.push((command, words.collect()));
                }
                if !entered.refused.is_empty() {
                    refused = entered.refused;
                }
            }
            for (index, (text, (name, _))) in here.texts.iter_mut().zip(TEXTS).enumerate() {
                ui.horizontal(|ui| {
                    let (rect, _) = ui.allocate_exact_size(vec2(NAMES, 24.0), egui::Sense::hover());
                    let font = egui::FontId::proportional(theme::BODY);
                    ui.painter().text(rect.left_center(), Align2::LEFT_CENTER, name, font, colours(ui).text_weak);
                    let id = Id::unique(("changed here", name));
                    let edit = TextEdit::singleline(text).id(id).desired_width(FIELDS).align(Align2::LEFT_CENTER);
                    let response = ui.add(edit).accessible_name(format!("{name} here"));
                    if index == 0 && !here.is_shown {
                        response.request_focus();
                        select_all(ui.ctx(), id, text);
                    }
                    select_when_entered(ui, &response, text);
                    has_focus |= response.has_focus();
                    is_entered |= response.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
                });
            }
            if !refused.is_empty() {
                ui.label(RichText::new(refused).size(theme::SMALL).color(colours(ui).error));
                is_entered = false;
            }
        });
    });
    let was_shown = std::mem::replace(&mut here.is_shown, true);
    let is_left = ui.input(|input| input.key_pressed(Key::Escape));
    // A press elsewhere ends it, and takes what was typed.
    let is_elsewhere = was_shown
        && ui.input(|input| {
            input.pointer.any_pressed()
                && input.pointer.interact_pos().is_some_and(|at| !shown.response.rect.contains(at))
        });
    let ends = is_entered || is_left || is_elsewhere || (was_shown && !has_focus);
    if ends && !is_left {
        let changed = here.texts.iter().zip(&here.before).zip(TEXTS).filter(|((text, before), _)| text != before);
        calls.extend(changed.map(|((text, _), (_, command))| (command, vec![text.clone()])));
    }
    // Which end goes, while a length is typed.
    if moves != before_moves {
        ui.ctx().request_repaint();
    }
    app.canvas.marked_here = moves.filter(|_| !ends);
    let context = ui.ctx().clone();
    for (command, words) in calls {
        app.act(command, &words.iter().map(String::as_str).collect::<Vec<_>>(), &context);
    }
    if !ends {
        app.panels.here = Some(here);
    }
}
