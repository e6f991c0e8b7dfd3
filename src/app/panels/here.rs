//! A thing changed where it is: a small form beside it, with its name or its measures.

use egui::{Align2, Area, Frame, Id, Key, Margin, Order, RichText, TextEdit, Ui, vec2};

use crate::app::look::text::{select_all, select_when_entered};
use crate::app::look::{
    length_field::LengthField,
    theme,
    widgets::{colours, strong},
};
use crate::app::state::{App, Here};
use crate::geometry::trim_m;
use crate::plan::{ElementId, Plan, titles::title_of};

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
        let Some(at) = self.session.pointed.at.or_else(middle) else { return };
        let texts = texts_of(plan, element);
        self.panels.here = Some(Here { element, at, before: texts.clone(), texts, is_shown: false });
    }
}

fn texts_of(plan: &Plan, element: ElementId) -> Vec<String> {
    let ElementId::Room(id) = element else { return Vec::new() };
    plan.room(id).map(|room| vec![room.name.clone(), room.function.clone(), room.note.clone()]).unwrap_or_default()
}

/// What is measured of an element: the name, the length in metres, its range, and the command that sets it.
type Measure = (&'static str, f64, std::ops::RangeInclusive<f64>, &'static str);

fn measures_of(plan: &Plan, element: ElementId) -> Vec<Measure> {
    match element {
        ElementId::Wall(id) => {
            let found = plan.wall(id).and_then(|wall| Some((plan.wall_segment(wall)?.length(), wall.thickness_m)));
            found.map_or_else(Vec::new, |(length_m, thickness_m)| {
                vec![
                    ("Length", length_m, 0.001..=1e5, "set-wall-length"),
                    ("Thickness", thickness_m, 0.0..=10.0, "set-thickness"),
                ]
            })
        }
        ElementId::Opening(id) => {
            let segment = plan.opening(id).and_then(|opening| plan.opening_segment(opening));
            segment
                .map_or_else(Vec::new, |segment| vec![("Width", segment.length(), 0.01..=1000.0, "set-opening-width")])
        }
        ElementId::Room(_) | ElementId::Corner(_) | ElementId::Dimension(_) => Vec::new(),
    }
}

/// Shows the form, if one is open.
pub(super) fn show(app: &mut App, ui: &mut Ui) {
    let Some(mut here) = app.panels.here.take() else { return };
    let is_there = app.plan().is_some_and(|plan| plan.has(here.element)) && app.picked() == Some(here.element);
    let Some(canvas) = app.canvas.seen_rect().filter(|_| is_there) else { return };
    let Some(place) = app.screen_position(here.at.x, here.at.y) else { return };
    let measures = app.plan().map(|plan| measures_of(plan, here.element)).unwrap_or_default();
    if measures.is_empty() && here.texts.is_empty() {
        return;
    }
    let title = app.plan().map(|plan| title_of(plan, here.element)).unwrap_or_default();
    let frame = Frame::popup(ui.style()).inner_margin(Margin::symmetric(12, 10));
    let area = Area::new(Id::unique("changed here")).order(Order::Middle).constrain_to(canvas.shrink(4.0));
    let mut calls: Vec<(&str, String)> = Vec::new();
    let (mut is_entered, mut has_focus) = (false, false);
    let shown = area.pivot(Align2::LEFT_TOP).fixed_pos(place + vec2(BESIDE, BESIDE)).show(ui.ctx(), |ui| {
        frame.show(ui, |ui| {
            ui.spacing_mut().item_spacing = vec2(8.0, 6.0);
            ui.label(strong(&title, theme::BODY));
            let mut refused = String::new();
            for (index, (name, now_m, range_m, command)) in measures.into_iter().enumerate() {
                let units = app.units();
                let field =
                    LengthField { name, now_m: trim_m(now_m), range_m, units, width: FIELDS, name_width: Some(NAMES) };
                let takes_focus = index == 0 && !here.is_shown;
                let shown =
                    ui.push_id(("here", here.element), |ui| ui.horizontal(|ui| field.show_in(ui, takes_focus)).inner);
                let (entered, response) = shown.inner;
                has_focus |= response.has_focus();
                is_entered |= response.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
                if let Some(length_m) = entered.length_m {
                    calls.push((command, format!("{length_m}m")));
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
        calls.extend(changed.map(|((text, _), (_, command))| (command, text.clone())));
    }
    let context = ui.ctx().clone();
    for (command, word) in calls {
        app.act(command, &[&word], &context);
    }
    if !ends {
        app.panels.here = Some(here);
    }
}
