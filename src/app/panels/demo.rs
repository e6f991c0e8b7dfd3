//! What is said while the demonstration runs: a card below the plan, the hand that drags, and the label that flips.

use egui::{
    Align2, Color32, Context, Event, FontId, Frame, Id, Key, Label, LayerId, Margin, Order, Pos2, Rect, RichText, Role,
    Sense, Shape, Stroke, Ui, WidgetInfo, pos2, vec2,
};

use super::live::kind_bar;
use crate::app::look::theme;
use crate::app::look::widgets::{colours, strong};
use crate::app::paint::preview::tag;
use crate::app::state::App;

/// Size of the card, at most, and its distance from the lower end of the canvas, in points.
const WIDTH: f32 = 760.0;
const HEIGHT: f32 = 128.0;
const BELOW: f32 = 28.0;

/// Width of the part with the kinds of building.
const KINDS: f32 = 210.0;

/// Ends the demonstration at the first click or key; a key that ends it does nothing else.
pub(crate) fn take_input(app: &mut App, context: &Context) {
    if app.session.demo.is_none() {
        return;
    }
    let is_taken_over = context.input(|input| {
        input.events.iter().any(|event| {
            matches!(
                event,
                Event::PointerButton { pressed: true, .. }
                    | Event::MouseWheel { .. }
                    | Event::Key { pressed: true, .. }
            )
        })
    });
    if is_taken_over {
        context.input_mut(|input| input.events.retain(|event| !matches!(event, Event::Key { key: Key::Escape, .. })));
        app.session.stop_demo();
    }
}

/// Shows what is said.
pub(super) fn show(app: &mut App, ui: &mut Ui) {
    let Some(caption) = app.session.demo_caption() else { return };
    let Some(canvas) = app.canvas.seen_rect() else { return };
    let palette = app.session.palette(ui);
    let painter =
        ui.ctx().layer_painter(LayerId::new(Order::Middle, Id::unique("demonstration"))).with_clip_rect(canvas);
    // The label that flips.
    if let Some((room, before, now)) = app.session.demo_flip() {
        let middle =
            app.session.document.as_ref().and_then(|document| {
                document.bounds_of(crate::plan::ElementId::Room(room)).map(|bounds| bounds.center())
            });
        if let Some(at) = middle.and_then(|middle| app.screen_position(middle.x, middle.y)) {
            let text = if before == now { before.to_string() } else { format!("{before} → {now}") };
            let ink = theme::colour(if before == now { palette.ink } else { palette.selection });
            tag(&painter, at + vec2(0.0, 30.0), Align2::CENTER_CENTER, &text, ink, palette);
        }
    }
    if let Some((at, presses)) = app.session.demo_hand()
        && let Some(at) = app.screen_position(at.x, at.y)
    {
        hand(&painter, at, presses, theme::colour(palette.selection));
    }
    let width = (canvas.width() - 32.0).clamp(200.0, WIDTH);
    let card = Rect::from_min_size(
        pos2(canvas.center().x - width / 2.0, canvas.bottom() - BELOW - HEIGHT),
        vec2(width, HEIGHT),
    );
    let area = egui::Area::new(Id::unique("demonstration card")).order(Order::Foreground).fixed_pos(card.min);
    area.constrain_to(canvas).show(ui.ctx(), |ui| {
        let frame = Frame::popup(ui.style()).inner_margin(Margin { left: 20, right: 20, top: 14, bottom: 12 });
        frame.show(ui, |ui| {
            ui.set_min_size(vec2(width - 40.0, HEIGHT - 26.0));
            ui.set_max_width(width - 40.0);
            let has_kinds = width > 520.0;
            ui.horizontal_top(|ui| {
                let text_width = if has_kinds { width - 40.0 - KINDS - 28.0 } else { width - 40.0 };
                ui.vertical(|ui| {
                    ui.set_width(text_width);
                    ui.spacing_mut().item_spacing.y = 4.0;
                    ui.add(Label::new(strong(&caption.title, theme::TITLE).color(colours(ui).text)).wrap());
                    ui.add(Label::new(RichText::new(&caption.text).color(colours(ui).text)).wrap());
                });
                if has_kinds {
                    ui.add_space(20.0);
                    ui.vertical(|ui| {
                        ui.set_width(KINDS);
                        if let Some(choice) = app.session.kind_of_building() {
                            kind_bar(ui, palette, &choice.posterior);
                        }
                    });
                }
            });
            let said = ui.interact(ui.min_rect(), ui.scope_id().with("said"), Sense::hover());
            said.widget_info(|| {
                WidgetInfo::labeled(Role::Status, true, format!("{}. {}", caption.title, caption.text))
            });
        });
        // How far it has come, along the lower edge, and how to end it.
        let rect = ui.min_rect();
        let line = Rect::from_min_max(
            pos2(rect.left() + 20.0, rect.bottom() - 24.0),
            pos2(rect.right() - 20.0, rect.bottom() - 22.0),
        );
        let own = colours(ui);
        ui.painter().rect_filled(line, 1.0, own.field);
        let come = line.with_max_x(line.left() + line.width() * caption.share as f32);
        ui.painter().rect_filled(come, 1.0, own.accent);
        let hint = "Click anywhere or press Esc to take over";
        let font = FontId::proportional(theme::SMALL);
        ui.painter().text(pos2(line.right(), line.bottom() + 4.0), Align2::RIGHT_TOP, hint, font, own.text_weak);
    });
}

/// A pointer, with a ring where it presses.
fn hand(painter: &egui::Painter, at: Pos2, presses: bool, colour: Color32) {
    if presses {
        painter.circle(at, 15.0, colour.gamma_multiply(0.18), Stroke::new(2.0, colour));
    } else {
        painter.circle_stroke(at, 15.0, Stroke::new(1.5, colour.gamma_multiply(0.6)));
    }
    let outline = [(0.0, 0.0), (0.0, 17.0), (4.2, 13.2), (7.0, 19.6), (9.8, 18.4), (7.0, 12.2), (12.6, 12.0)];
    let points: Vec<Pos2> = outline.iter().map(|&(x, y)| at + vec2(x, y)).collect();
    // Not convex: two pieces filled, one outline.
    let fill = Color32::WHITE;
    painter.add(Shape::convex_polygon(vec![points[0], points[1], points[2], points[6]], fill, Stroke::NONE));
    painter.add(Shape::convex_polygon(vec![points[2], points[3], points[4], points[5]], fill, Stroke::NONE));
    painter.add(Shape::closed_line(points, Stroke::new(1.25, Color32::from_gray(30))));
}
