//! The table of plans and the table of rooms. Only the rows on the screen are laid out.

use egui::{Color32, FontId, Modifiers, Rect, Response, Role, ScrollArea, Sense, Ui, WidgetInfo, pos2, vec2};

use super::cells::{self, columns};
use super::{Act, Table, nothing, plan_in_words};
use crate::app::look::theme;
use crate::app::look::widgets::{colours, focus_ring, put_line, swatch};
use crate::app::session::workspace::OpenWorkspace;
use crate::app::session::workspace::shows::Shows;
use crate::app::state::App;
use crate::workspace::query::{Order, PlanColumn, RoomColumn};
use crate::workspace::{Content, PlanRow, RoomRow};

const ROW: f32 = 28.0;

/// The picture at the start of a plan's row.
const PICTURE: f32 = 40.0;

/// Between the text of a cell and the next column.
const GAP: f32 = 12.0;

/// Width that the scroll bar takes.
const BAR: f32 = 12.0;

pub(super) fn show(table: &mut Table, app: &mut App, ui: &mut Ui) -> Option<Act> {
    let OpenWorkspace { view, .. } = app.session.workspace.as_mut()?;
    let (shows, length, cursor) = (view.shows, view.len(), view.cursor);
    let is_rooms = shows == Shows::Rooms;
    let (head, _) = ui.allocate_exact_size(vec2(ui.available_width(), 24.0), Sense::hover());
    let lead = if is_rooms { 8.0 } else { PICTURE + 12.0 };
    let (left, right) = (head.left() + lead, head.right() - BAR);
    if is_rooms {
        let placed = columns(cells::ROOMS, left, right);
        let order = view.room_order;
        if let Some(by) = header(ui, head, &placed, order, |column| (column.title(), column.help())) {
            view.sort_rooms(by);
        }
    } else {
        let placed = columns(cells::PLANS, left, right);
        let order = view.plan_order;
        if let Some(by) = header(ui, head, &placed, order, |column| (column.title(), column.help())) {
            view.sort_plans(by);
        }
    }
    if length == 0 {
        nothing(app, ui);
        return None;
    }
    let mut act = None;
    let height = ui.available_height();
    table.rows_seen = (height / ROW) as usize;
    let mut area = ScrollArea::vertical().id_salt(("rows", is_rooms)).auto_shrink(false);
    if table.follows_cursor {
        area = followed(area, ui, is_rooms, cursor, height);
    }
    let revision = app.session.workspace.as_ref().map_or(0, |workspace| workspace.revision);
    let output = area.show_rows(ui, ROW, length, |ui, range| {
        for row in range {
            let (rect, response) =
                ui.allocate_exact_size(vec2(ui.available_width().min(right - head.left()), ROW), Sense::click());
            let is_selected = app.session.workspace.as_ref().is_some_and(|workspace| workspace.view.is_selected(row));
            ground(ui, rect, &response, is_selected, row == cursor);
            if is_rooms {
                let found = app.session.workspace.as_ref().and_then(|it| it.view.rows.rooms.get(row).copied());
                if let Some(found) = found {
                    room_row(app, ui, rect, found, (left, right), &response, is_selected);
                }
            } else {
                let found = app.session.workspace.as_ref().and_then(|it| it.view.rows.plans.get(row).copied());
                if let Some(found) = found {
                    plan_row(table, app, ui, rect, found, (left, right), revision, &response, is_selected);
                }
            }
            act = clicked(app, ui, &response, row).or(act.take());
        }
    });
    remember(ui, is_rooms, output.state.clamped_offset().y);
    act
}

/// Where the rows were scrolled to, to follow the cursor from there.
fn remember(ui: &Ui, is_rooms: bool, offset: f32) {
    ui.data_mut(|data| data.insert_temp(egui::Id::unique(("rows scrolled", is_rooms)), offset));
}

fn followed(area: ScrollArea, ui: &Ui, is_rooms: bool, cursor: usize, height: f32) -> ScrollArea {
    let offset: f32 = ui.data(|data| data.get_temp(egui::Id::unique(("rows scrolled", is_rooms)))).unwrap_or_default();
    let top = cursor as f32 * ROW;
    area.vertical_scroll_offset(offset.clamp((top + ROW - height).max(0.0), top))
}

/// Opens a row that was clicked twice, or puts the cursor on one that was clicked.
pub(super) fn clicked(app: &mut App, ui: &Ui, response: &Response, row: usize) -> Option<Act> {
    let view = &mut app.session.workspace.as_mut()?.view;
    if response.double_clicked() {
        return Some(Act::Open(row));
    }
    if response.clicked() {
        let Modifiers { command, shift, .. } = ui.input(|input| input.modifiers);
        view.choose(row, command, shift);
        // The arrows go on from here.
        ui.memory_mut(|memory| memory.surrender_focus(response.id));
    }
    None
}

pub(super) fn ground(ui: &Ui, rect: Rect, response: &Response, is_selected: bool, has_cursor: bool) {
    let colours = colours(ui);
    let ground = if is_selected {
        colours.accent_soft
    } else if response.hovered() {
        colours.hover
    } else {
        Color32::TRANSPARENT
    };
    ui.painter().rect_filled(rect, theme::RADIUS, ground);
    if has_cursor {
        let stroke = egui::Stroke::new(1.0, colours.accent);
        ui.painter().rect_stroke(rect, theme::RADIUS, stroke, egui::epaint::StrokeKind::Inside);
    }
    focus_ring(ui, rect, response);
}

/// The headings. Returns the column of one that was clicked.
fn header<C: Copy + PartialEq>(
    ui: &mut Ui,
    rect: Rect,
    placed: &[(C, bool, f32, f32)],
    order: Order<C>,
    told: impl Fn(C) -> (&'static str, &'static str),
) -> Option<C> {
    let colours = colours(ui);
    let mut chosen = None;
    for (column, is_figure, start, end) in placed {
        let (title, help) = told(*column);
        let cell = Rect::from_min_max(pos2(*start - 4.0, rect.top()), pos2(*end - GAP + 4.0, rect.bottom()));
        let response = ui.interact(cell, ui.scope_id().with(("heading", title)), Sense::click());
        let is_on = order.by == *column;
        if response.hovered() {
            ui.painter().rect_filled(cell, theme::RADIUS, colours.hover);
        }
        let mark = match (is_on, order.is_descending) {
            (false, _) => "",
            (true, false) => " ↑",
            (true, true) => " ↓",
        };
        let text = format!("{title}{mark}");
        let font = FontId::new(theme::SMALL, theme::semibold());
        let colour = if is_on { colours.text } else { colours.text_weak };
        put(ui, &text, font, colour, cell.shrink2(vec2(4.0, 0.0)), *is_figure);
        focus_ring(ui, cell, &response);
        let way = if is_on && !order.is_descending {
            ", ascending"
        } else if is_on {
            ", descending"
        } else {
            ""
        };
        response.widget_info(|| WidgetInfo::selected(Role::Button, true, is_on, format!("Sort by {title}{way}")));
        if response.on_hover_text(help).clicked() {
            chosen = Some(*column);
        }
    }
    chosen
}

/// A line of text in a cell, at its left or its right end.
fn put(ui: &Ui, text: &str, font: FontId, colour: Color32, cell: Rect, is_figure: bool) {
    if !is_figure {
        return put_line(ui, text, font, colour, cell);
    }
    let galley = ui.painter().layout_no_wrap(text.to_owned(), font.clone(), colour);
    if galley.size().x > cell.width() {
        return put_line(ui, text, font, colour, cell);
    }
    let left = cell.right() - galley.size().x;
    crate::app::look::widgets::put(ui, galley, left, cell.center().y);
}

fn plan_row(
    table: &mut Table,
    app: &App,
    ui: &Ui,
    rect: Rect,
    row: PlanRow,
    (left, right): (f32, f32),
    revision: u64,
    response: &Response,
    is_selected: bool,
) {
    let Some(OpenWorkspace { view, .. }) = &app.session.workspace else { return };
    let Some((file, plan)) = view.rows.of.plan(row) else { return };
    let colours = colours(ui);
    let picture = Rect::from_min_size(rect.left_top() + vec2(6.0, 2.0), vec2(PICTURE, ROW - 4.0));
    if let (Some(plan), Some(key)) = (plan, view.rows.of.plan_key(row)) {
        table.thumbnails.paint(ui, picture, &key, plan, app.session.palette(ui), revision);
    }
    for (column, is_figure, start, end) in columns(cells::PLANS, left, right) {
        let text = cells::of_plan(&app.session, file, plan, column);
        let cell = Rect::from_min_max(pos2(start, rect.top()), pos2(end - GAP, rect.bottom()));
        let colour = match column {
            PlanColumn::Problems if plan.is_some_and(|plan| plan.problems.errors > 0) => colours.error,
            PlanColumn::Problems if plan.is_some_and(|plan| plan.problems.warnings > 0) => colours.warning,
            PlanColumn::Name if plan.is_some() => colours.text,
            PlanColumn::Rooms | PlanColumn::Labelled | PlanColumn::Agreement => colours.text,
            _ => colours.text_weak,
        };
        put(ui, &text, FontId::proportional(theme::BODY), colour, cell, is_figure);
    }
    if let Content::Broken(what) = &file.content {
        // Across the columns that only a plan has.
        let from = columns(cells::PLANS, left, right).iter().find(|it| it.0 == PlanColumn::Typology).map(|it| it.2);
        let place =
            Rect::from_min_max(pos2(from.unwrap_or(left + 160.0), rect.top()), pos2(right - 90.0, rect.bottom()));
        let text = format!("Cannot be read: {what}");
        put_line(ui, &text, FontId::proportional(theme::BODY), colours.error, place);
    }
    let (name, said) = plan_in_words(app, row);
    describe(response, is_selected, &name, &said);
    hover(response, &name, &said);
}

fn room_row(
    app: &App,
    ui: &Ui,
    rect: Rect,
    row: RoomRow,
    (left, right): (f32, f32),
    response: &Response,
    is_selected: bool,
) {
    let Some(OpenWorkspace { view, .. }) = &app.session.workspace else { return };
    let Some((file, plan, room)) = view.rows.of.room(row) else { return };
    let colours = colours(ui);
    let palette = app.session.palette(ui);
    let mut parts = Vec::new();
    for (column, is_figure, start, end) in columns(cells::ROOMS, left, right) {
        let text = cells::of_room(&app.session, file, plan, room, column);
        let mut cell = Rect::from_min_max(pos2(start, rect.top()), pos2(end - GAP, rect.bottom()));
        let differs = room.agrees() == Some(false);
        let mut colour = match column {
            RoomColumn::Name | RoomColumn::Function | RoomColumn::Area => colours.text,
            RoomColumn::Label if room.label().is_some() => colours.text,
            RoomColumn::Prediction if differs => colours.warning,
            _ => colours.text_weak,
        };
        let coloured = match column {
            RoomColumn::Label => Some(palette.status(room.status)),
            RoomColumn::Prediction => room.prediction.map(|(label, _)| palette.label(label)),
            _ => None,
        };
        if let Some(fill) = coloured {
            swatch(ui, pos2(cell.left() + 6.0, cell.center().y), theme::colour(fill));
            cell.min.x += 18.0;
        }
        let (mut shown, is_unnamed) = (text.clone(), text.is_empty() && column == RoomColumn::Name);
        if is_unnamed {
            "Unnamed".clone_into(&mut shown);
            colour = colours.text_weak;
        }
        put(ui, &shown, FontId::proportional(theme::BODY), colour, cell, is_figure);
        if !text.is_empty() && column != RoomColumn::Name {
            parts.push(if column == RoomColumn::Prediction { format!("predicted {text}") } else { text });
        }
    }
    let name = if room.name.is_empty() { "Unnamed room".to_owned() } else { room.name.to_string() };
    describe(response, is_selected, &name, &parts.join(", "));
}

/// What screen readers say of a row.
pub(super) fn describe(response: &Response, is_selected: bool, name: &str, said: &str) {
    response.widget_info(|| WidgetInfo::selected(Role::ListBoxOption, true, is_selected, name));
    response.ctx.accesskit_node_builder(response.id, |node| node.set_description(said));
}

fn hover(response: &Response, name: &str, said: &str) {
    // Only what is not in the row anyway: why a file cannot be read.
    if said.starts_with("cannot be read") && response.hovered() {
        let text = format!("{name} {said}");
        response.clone().on_hover_text(text);
    }
}
