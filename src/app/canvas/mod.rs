//! The canvas: the plan in a view that pans and zooms, and what can be picked on it.

mod accessibility;
mod camera;
pub(crate) mod dimensions;
mod evidence;
pub(crate) mod guides;
mod live;
mod marks;
pub(crate) mod rulers;
mod storeys;

use std::sync::Arc;

use egui::epaint::StrokeKind;
use egui::{CursorIcon, EventFilter, Key, PointerButton, Rect, Response, Role, Sense, Stroke, Ui, WidgetInfo};

use self::accessibility::describe;
use self::camera::{Camera, Wish, is_touch_pad};
use self::marks::{
    MOST_MARKED, Mark, is_over_picture, more_to_snap_to, paint_beginning, paint_scale_bar, paint_typed,
    preview_question, scale_bar,
};
use crate::app::look::theme;
use crate::app::paint::backdrop::BackdropView;
use crate::app::paint::ghost::GhostPainter;
use crate::app::paint::pending::Pending;
use crate::app::paint::places::{canvas_id, plan_point};
use crate::app::paint::preview::{Look, Preview};
use crate::app::paint::robot::painter::RobotPainter;
use crate::app::paint::scene_painter::{ScenePainter, paint_group};
use crate::app::session::document::{Derived, Document};
use crate::app::session::{Pointed, Session};
use crate::app::tools::{self, DrawOptions, Input, Scope, Toolbox};
use crate::app::value::{Call, Direction};
use crate::base::units::{METRES_PER_FOOT, Units};
use crate::draw::{self, Layers, Style, View};
use crate::geometry::{Bounds, Point};
use crate::plan::{ElementId, GuideAxis, Plan};
use crate::predict::Marks;

/// The state of the canvas between frames.
#[derive(Default)]
pub(crate) struct Canvas {
    camera: Option<Camera>,
    /// A change of the view waiting for the size of the canvas to be known.
    wish: Option<Wish>,
    /// The view of the last frame and its place on the screen.
    seen: Option<(View, Rect)>,
    /// The element of the row hovered in a panel.
    pub hovered_in_panel: Option<ElementId>,
    /// What the point of a reason is about that is hovered in a panel.
    pub evidence: Option<Marks>,
    /// The box around the picture under the plan, where one is shown.
    picture_bounds: Option<Bounds>,
    /// The place that a field of a panel is about.
    pub marked_in_panel: Option<Point>,
    /// The end that moves when what is typed in the form beside a thing is taken.
    pub marked_here: Option<Point>,
    /// What is under the pointer.
    pub pointed: Pointed,
    painter: ScenePainter,
    ghost: GhostPainter,
    robot: RobotPainter,
    /// The edits not yet analysed.
    pending: Option<Pending>,
    /// The guide that is being dragged.
    pub guide_drag: Option<guides::Drag>,
    /// The triangles of the room that is marked by a fill.
    marked: Option<(Arc<Derived>, ElementId, Vec<u32>)>,
    /// Whether the last scrolling came from a touch pad.
    is_touch_pad: bool,
    /// Whether focus came by keyboard, so that it must be visible.
    shows_focus: bool,
    /// Whether the pointer moved the view in this frame.
    was_moved: bool,
    /// Whether the current drag pans, however it continues.
    is_panning: bool,
    /// Where the button was pressed: the snapped point, and the exact one.
    pressed_at: Option<(Point, Point)>,
    /// The last pointer position.
    last_pointer: Point,
    /// How far an arrow key moves what is selected, in metres.
    nudge_m: f64,
    /// Whether letting go of Space flips a door: nothing has been panned since it went down.
    space_flips: bool,
}

/// A pointer that has moved by no more than this has stayed where it was, in points: the width of a fingertip.
const STAYS_PX: f64 = 24.0;

/// Zoom per point of scrolling: the same as egui's for Ctrl and wheel.
const ZOOM_PER_POINT: f64 = 1.0 / 200.0;

/// A user action on the canvas.
pub(crate) enum Act {
    /// The calls of the active tool.
    Calls(Vec<Call>),
    Pick(ElementId),
    /// Pick the next or previous room; leave the canvas after the last.
    PickNeighbour(isize),
    /// Pick the room nearest in a direction of the plan.
    PickTowards(Direction),
    /// Move what is selected by so many metres.
    Nudge(Direction, f64),
    /// Hang doors the next way.
    Flip,
    /// Show what can be done with what is under the pointer.
    Menu(Under, egui::Pos2),
    Rename,
}

/// What is under the pointer, for a menu of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Under {
    Element(ElementId),
    /// A guide line: its direction and its place in metres.
    Guide(GuideAxis, f64),
    /// The picture under the plan, where nothing is drawn.
    Picture,
    Nothing,
}

/// The keys of the tools to begin with, in readable form.
pub(crate) struct Beginning {
    pub walls: String,
    pub fill: String,
    pub rectangle: String,
    pub door: String,
}

impl Canvas {
    /// Forgets the previous plan.
    pub(crate) fn forget(&mut self) {
        *self = Self { is_touch_pad: self.is_touch_pad, ..Self::default() };
    }

    /// The view of the last frame and its place on the screen.
    pub(crate) fn seen(&self) -> Option<(View, Rect)> {
        self.seen
    }

    /// Where the canvas was in the last frame.
    pub(crate) fn seen_rect(&self) -> Option<Rect> {
        self.seen.map(|(_, rect)| rect)
    }

    /// How close to an opening a click must be to pick it, in metres at the current zoom.
    pub(crate) fn pick_reach_m(&self) -> f64 {
        self.px_per_m().map_or(0.0, |px_per_m| tools::REACH_PX / px_per_m)
    }

    fn take_pointer(&mut self, ui: &Ui, response: &Response, view: &View) {
        let rect = response.rect;
        let space = is_space_held(ui);
        let is_panning = response.dragged_by(PointerButton::Middle)
            || response.dragged_by(PointerButton::Secondary)
            || (response.dragged_by(PointerButton::Primary) && (space || self.is_panning));
        self.is_panning = is_panning;
        if is_panning {
            self.pan(response.drag_delta());
        }
        if response.contains_pointer() || is_panning {
            if is_panning {
                ui.ctx().set_cursor_icon(CursorIcon::Grabbing);
            } else if space {
                ui.ctx().set_cursor_icon(CursorIcon::Grab);
            }
        }
        let pointer = ui.input(|input| input.pointer.hover_pos()).filter(|_| response.contains_pointer());
        if let Some(at) = pointer {
            let (scroll, zoom) = ui.input(|input| {
                for event in &input.events {
                    if let egui::Event::MouseWheel { unit, delta, .. } = event {
                        self.is_touch_pad = is_touch_pad(*unit, *delta);
                    }
                }
                (input.smooth_scroll_delta(), f64::from(input.zoom_delta()))
            });
            if zoom != 1.0 {
                self.zoom_at(view, rect, at, zoom);
            } else if self.is_touch_pad || scroll.x != 0.0 {
                self.pan(scroll);
            } else if scroll.y != 0.0 {
                self.zoom_at(view, rect, at, (f64::from(scroll.y) * ZOOM_PER_POINT).exp());
            }
        }
        self.pointed.at = pointer.map(|at| plan_point(view, rect, at));
        self.pointed.near_m = STAYS_PX / view.px_per_m;
    }

    /// Shows the plan in the rest of `ui`; returns the user's action.
    pub(crate) fn show(
        &mut self,
        ui: &mut Ui,
        document: &Document,
        session: &Session,
        backdrop: &mut BackdropView,
        toolbox: &mut Toolbox,
        beginning: &Beginning,
    ) -> Option<Act> {
        let rect = rulers::canvas_rect(session, ui.available_rect_before_wrap());
        let fresh = document.derived();
        // The results for an earlier plan are better than nothing.
        let shown = document.derived_or_last().map(|(derived, _)| derived);
        self.update_camera(rect, document, shown.map(Arc::as_ref), backdrop);
        let response = ui.interact(rect, canvas_id(), Sense::click_and_drag());
        self.take_pointer(ui, &response, &self.view(rect, ui.pixels_per_point()));
        let view = self.view(rect, ui.pixels_per_point());
        self.seen = Some((view, rect));

        // While the plan is reanalysed after an edit, the previous elements can still be picked: pressing
        // on a room may be what ended the edit of another's name.
        let (plan, px_per_m) = (document.plan(), view.px_per_m);
        let at = |point: Point| {
            shown.map(|derived| tools::hit(derived, plan, &session.layers, point, px_per_m)).unwrap_or_default()
        };
        self.pointed.element =
            self.pointed.at.filter(|_| !response.dragged()).and_then(|point| at(point).first().copied());
        if response.clicked_by(PointerButton::Primary) {
            response.request_focus();
            self.shows_focus = false;
        }
        let mut act = None;
        let options = toolbox.options;
        let placed = document.plan().backdrop().filter(|_| session.layers.backdrop);
        self.picture_bounds = Some(backdrop.bounds(placed)).filter(|bounds| !bounds.is_empty());
        let scope = self.use_tool(ui, &response, document, shown, session, &options, toolbox, &view, &mut act);
        // With any other tool, the keyboard still goes from room to room.
        let by_keys = self.take_keys(ui, &response, session);
        act = act.or(by_keys);

        let style = style(session, document.plan(), ui.visuals().dark_mode);
        let palette = style.palette();
        let painter = ui.painter_at(rect);
        painter.rect_filled(rect, 0.0, theme::colour(palette.paper));
        let placed = document.plan().backdrop().filter(|_| session.layers.backdrop);
        backdrop.paint(&painter, rect, &view, placed, session.jobs.is_inline());
        if let Some(derived) = shown {
            self.painter.paint(&painter, rect, derived, &style, &view);
        }
        // Those of the plan as it is now: they follow an edit at once.
        for group in draw::dimensions::groups(&draw::dimensions::lines(plan), &style, &view) {
            paint_group(&painter, rect, &view, &group);
        }
        self.ghost.paint(&painter, rect, session.shown_ghost().map(|ghost| &ghost.derived), &style, &view);
        if let Some((below, derived)) = session.shown_ghost().zip(shown) {
            let above = &derived.analysis.shapes;
            storeys::paint_links(&painter, rect, &view, document.plan(), above, below, palette);
        }
        if let Some(seen) = session.robot_seen() {
            self.robot.paint(&painter, rect, &view, palette, session.units(), &seen, self.pointed.at);
        }
        match fresh {
            // Never show a stale label as current.
            None => self.paint_pending(&painter, rect, &view, document, session, &style),
            Some(derived) => {
                let is_watched = session.demo.is_some();
                let under_pointer = self.pointed.element.filter(|_| toolbox.is_selecting() && !is_watched);
                let hovered = under_pointer.or(self.hovered_in_panel);
                let hovered = hovered.filter(|hovered| !session.selection.contains(*hovered));
                if let Some(hovered) = hovered {
                    self.mark(&painter, rect, &view, document.plan(), derived, hovered, &Mark::hover(palette));
                }
                for picked in session.selection.iter().take(MOST_MARKED) {
                    self.mark(&painter, rect, &view, document.plan(), derived, picked, &Mark::picked(palette));
                }
            }
        }
        guides::paint(&painter, rect, &view, session, self.guide_drag);
        if let Some(derived) = fresh {
            // Dimensions would hide what a reason is about.
            if self.evidence.is_some() {
                self.paint_evidence(&painter, rect, &view, document.plan(), derived, session.units(), palette);
            } else {
                // Those of the selection would stand in the way of what another tool shows.
                let is_in_the_way = toolbox.tool().is_busy() && !toolbox.is_selecting();
                let taken = || {
                    let scale_bar = scale_bar(rect, &view, session.units());
                    let mut taken = self.painter.text_boxes(rect, &view);
                    taken.push(scale_bar.ground);
                    taken
                };
                if !is_in_the_way {
                    dimensions::paint(&painter, rect, &view, session, derived, taken);
                }
            }
        }
        // Below all that a tool shows.
        paint_scale_bar(&painter, rect, &view, palette, session.units());
        let tool = toolbox.tool();
        let mut preview = Preview::default();
        preview_question(session, document.plan(), &mut preview);
        for place in self.marked_in_panel.into_iter().chain(self.marked_here) {
            preview.handle(place, Look::Danger);
        }
        if session.watches_labels()
            && let Some(next) = tool.would_be(&scope)
        {
            self.paint_would_be(&painter, rect, &view, session, &next, palette);
        } else if let Some(derived) = fresh {
            self.paint_second_opinion(&painter, rect, &view, session, derived, palette);
        }
        tool.preview(&scope, &mut preview);
        preview.paint(&painter, rect, &view, palette);
        if tool.snaps() && self.pointed.at.is_some() {
            tools::paint_snap(&painter, rect, &view, palette, &scope.snap);
        }
        paint_typed(&painter, rect, &view, palette, &scope, toolbox);
        let is_blank = session.shown_run().is_none()
            && session.demo.is_none()
            && document.plan().is_empty()
            && document.plan().backdrop().is_none()
            && session.ghost_plan().is_none();
        if is_blank && toolbox.is_selecting() {
            paint_beginning(&painter, rect, palette, beginning);
        }
        if response.has_focus() && self.shows_focus {
            let colours = theme::colours(ui.visuals());
            painter.rect_stroke(rect.shrink(1.0), 0.0, Stroke::new(2.0, colours.accent), StrokeKind::Inside);
        }
        let description = describe(document, session.picked());
        response.widget_info(|| WidgetInfo::labeled(Role::Canvas, true, &description));
        self.tell_screen_reader(ui, rect, &view, document, fresh, session).or(act)
    }

    /// Passes pointer and keyboard input to the active tool.
    fn use_tool<'a>(
        &mut self,
        ui: &Ui,
        response: &Response,
        document: &'a Document,
        shown: Option<&'a Arc<Derived>>,
        session: &'a Session,
        options: &'a DrawOptions,
        toolbox: &mut Toolbox,
        view: &View,
        act: &mut Option<Act>,
    ) -> Scope<'a> {
        let pointer = self.pointed.at.unwrap_or(self.last_pointer);
        self.last_pointer = pointer;
        let modifiers = ui.input(|input| input.modifiers);
        let index = shown.map(|derived| &derived.index);
        // The walls in a backdrop are not on the grid.
        let grid_m = (!is_over_picture(session, document.plan()) && session.layers.grid).then(|| {
            session.settings.grid_m().unwrap_or(match session.units() {
                Units::Metric => 1.0,
                Units::Imperial => METRES_PER_FOOT,
            })
        });
        let nudge_m = match grid_m.filter(|_| options.snaps_to_grid) {
            Some(grid_m) => tools::attracting_grid_m(grid_m, view.px_per_m),
            None if session.units() == Units::Imperial => METRES_PER_FOOT / 12.0,
            None => 0.01,
        };
        self.nudge_m = nudge_m;
        let (lines, points) = more_to_snap_to(session, view, pointer);
        let ground = tools::Ground {
            index,
            seen: view.bounds(),
            px_per_m: view.px_per_m,
            modifiers,
            lines: &lines,
            points: &points,
            options,
            grid_m,
            is_seen: self.pointed.at.is_some(),
            is_over_picture: is_over_picture(session, document.plan()),
            is_pressing: ui.input(|input| input.pointer.any_pressed() || input.pointer.any_released()),
        };
        let snap = toolbox.snap(&ground, pointer);
        let mut scope = Scope {
            plan: document.plan(),
            derived: shown,
            gaps: document.derived().map_or(&[], |derived| derived.gaps.as_slice()),
            selection: &session.selection,
            options,
            layers: &session.layers,
            copied: session.copied.as_ref(),
            below: session.ghost_plan(),
            units: session.units(),
            pointer,
            snap,
            px_per_m: view.px_per_m,
            nudge_m,
            is_nudging: session.nudged == Some(document.history.position()),
            text: match session.picked() {
                Some(ElementId::Room(id)) => self.painter.text_of(id, response.rect, view),
                _ => None,
            },
            modifiers,
        };
        let mut inputs = toolbox.take_pending();
        let is_primary = |input: &egui::InputState| input.pointer.button_pressed(PointerButton::Primary);
        if response.contains_pointer() && ui.input(is_primary) {
            self.pressed_at = Some((scope.at(), pointer));
        }
        if !self.is_panning {
            if response.drag_started_by(PointerButton::Primary)
                && let Some((at, pointer)) = self.pressed_at
            {
                inputs.push(Input::DragStart { at, pointer });
            } else if response.dragged_by(PointerButton::Primary) {
                inputs.push(Input::Drag);
            }
            if response.drag_stopped_by(PointerButton::Primary) {
                inputs.push(Input::Drop);
            }
            if response.clicked_by(PointerButton::Primary) {
                inputs.push(Input::Click);
            }
            if response.double_clicked_by(PointerButton::Primary) {
                inputs.push(Input::DoubleClick);
            }
            if response.secondary_clicked() {
                // What is being drawn ends; otherwise there is something to be asked about the thing under the pointer.
                if toolbox.tool().is_busy() {
                    inputs.push(Input::SecondaryClick);
                } else if let Some(at) = ui.input(|input| input.pointer.interact_pos()) {
                    // The handle of a corner lies over all else.
                    let reach_m = scope.metres(tools::REACH_PX);
                    let handle = tools::handle_at(scope.plan, scope.selection, pointer, reach_m);
                    let corner = handle.map(|(corner, _)| ElementId::Corner(corner));
                    *act = Some(Act::Menu(self.under(session, view, response.rect, corner, pointer), at));
                }
            }
        }
        let mut calls = Vec::new();
        for input in inputs {
            let was_snapping = toolbox.tool().snaps();
            calls.extend(toolbox.tool_mut().take(input, &scope));
            // Snapping depends on what has been started.
            if toolbox.tool().snaps() != was_snapping || !calls.is_empty() {
                scope.snap = toolbox.snap(&ground, pointer);
            }
        }
        if !calls.is_empty() {
            *act = Some(Act::Calls(calls));
        }
        toolbox.hint = toolbox.hint(&scope);
        if response.contains_pointer() && !self.is_panning && !is_space_held(ui) {
            ui.ctx().set_cursor_icon(toolbox.tool().cursor(&scope));
        }
        scope
    }

    /// What a menu at the pointer is about. A guide lies over rooms, which are nearly everywhere, and below all else.
    fn under(&self, session: &Session, view: &View, rect: Rect, corner: Option<ElementId>, pointer: Point) -> Under {
        let element = corner.or(self.pointed.element);
        if matches!(element, None | Some(ElementId::Room(_)))
            && let Some((axis, at_m)) = guides::guide_at(rect, view, session, pointer)
        {
            return Under::Guide(axis, at_m);
        }
        match element {
            Some(element) => Under::Element(element),
            None if self.picture_bounds.is_some_and(|bounds| bounds.contains(pointer)) => Under::Picture,
            None => Under::Nothing,
        }
    }

    /// With the keyboard on the canvas: Tab goes from room to room, arrows move what is selected, with Ctrl they go
    /// to the next room in that direction, and Space flips a door. Arrows and Space also do so where nothing has the
    /// keyboard.
    fn take_keys(&mut self, ui: &Ui, response: &Response, session: &Session) -> Option<Act> {
        if response.gained_focus() {
            self.shows_focus = ui.input(|input| !input.pointer.any_pressed() && !input.pointer.any_released());
        }
        let has_none = |memory: &egui::Memory| memory.focused().is_none() && memory.top_modal_layer().is_none();
        let is_free = ui.memory(has_none) && !egui::Popup::is_any_open(ui.ctx());
        if !response.has_focus() && !is_free {
            return None;
        }
        let has_focus = response.has_focus();
        if has_focus {
            let filter = EventFilter { tab: true, horizontal_arrows: true, vertical_arrows: true, escape: false };
            ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, filter));
        }
        if response.gained_focus() {
            // The key that brought the focus here is used up.
            return None;
        }
        if self.is_panning {
            self.space_flips = false;
        }
        let is_selected = !session.selection.is_empty();
        let events = ui.input(|input| input.events.clone());
        events.iter().find_map(|event| {
            let egui::Event::Key { key, pressed, repeat, modifiers, .. } = event else { return None };
            if *key == Key::Space && !repeat {
                return std::mem::replace(&mut self.space_flips, *pressed).then_some(Act::Flip).filter(|_| !pressed);
            }
            let direction = match key {
                Key::ArrowLeft => Some(Direction::Left),
                Key::ArrowRight => Some(Direction::Right),
                Key::ArrowUp => Some(Direction::Up),
                Key::ArrowDown => Some(Direction::Down),
                _ => None,
            };
            match (key, direction) {
                _ if !pressed => None,
                (_, Some(direction)) if is_selected && !modifiers.command => {
                    let times = match (modifiers.shift, modifiers.alt) {
                        (true, _) => tools::NUDGES_MORE,
                        (false, true) => 1.0 / tools::NUDGES_MORE,
                        (false, false) => 1.0,
                    };
                    Some(Act::Nudge(direction, self.nudge_m * times))
                }
                (_, Some(direction)) if has_focus => Some(Act::PickTowards(direction)),
                (Key::Tab, _) if has_focus => Some(Act::PickNeighbour(if modifiers.shift { -1 } else { 1 })),
                (Key::Enter, _) if has_focus => Some(Act::Rename),
                _ => None,
            }
        })
    }
}

/// Whether the key that makes every drag pan is held.
fn is_space_held(ui: &Ui) -> bool {
    !ui.ctx().text_edit_focused() && ui.input(|input| input.key_down(Key::Space))
}

/// The current style of the plan.
fn style(session: &Session, plan: &Plan, is_dark: bool) -> Style {
    let layers = session.layers;
    let is_over_picture = is_over_picture(session, plan);
    Style {
        theme: if is_dark { draw::Theme::Dark } else { draw::Theme::Light },
        fill: layers.fill,
        label_colours: layers.colours,
        // The backdrop must show through the rooms.
        fill_opacity: if is_over_picture { 0.55 } else { 1.0 },
        halo: is_over_picture,
        text_px: theme::PLAN_TEXT,
        units: session.units(),
        grid_m: session.settings.grid_m(),
        layers: Layers {
            // Over a backdrop its lines could be taken for walls.
            grid: layers.grid && !is_over_picture,
            rooms: !(is_over_picture && layers.fill == draw::Fill::None),
            walls: true,
            openings: true,
            graph: layers.graph,
            dimensions: layers.dimensions,
            names: layers.names,
            areas: layers.names,
        },
    }
}
