//! The canvas: the plan, seen through a view that pans and zooms, and what can be picked on it.

pub(crate) mod dimensions;
pub(crate) mod guides;
pub(crate) mod rulers;

use crate::app::paint::places::canvas_id;
use crate::app::paint::places::plan_point;
use crate::app::session::Pointed;
use crate::app::tools::DrawOptions;
use crate::plan::titles::title_of;
use std::sync::Arc;

use egui::epaint::StrokeKind;
use egui::{
    Color32, CursorIcon, EventFilter, Key, MouseWheelUnit, Painter, PointerButton, Pos2, Rect, Response, Role, Sense,
    Shape, Stroke, Ui, Vec2, WidgetInfo, vec2,
};

use super::tools::{self, Input, Scope, Toolbox};
use super::value::{Call, Direction};
use crate::app::look::theme;
use crate::app::paint::backdrop::BackdropView;
use crate::app::paint::ghost::GhostPainter;
use crate::app::paint::pending::Pending;
use crate::app::paint::preview::{Look, Preview};
use crate::app::paint::{
    places::on_screen,
    scene_painter::{ScenePainter, earcut, outline_mesh, polygon_mesh},
};
use crate::app::session::Session;
use crate::app::session::document::{Derived, Document};
use crate::app::session::questions::Question;
use crate::base::units::{METRES_PER_FOOT, Units};
use crate::draw::{self, Layers, Palette, Style, View};
use crate::features::RoomStatus;
use crate::geometry::{Bounds, Point, Segment, Vector};
use crate::labels::normalised_function;
use crate::plan::{ElementId, GuideAxis, Plan};
use crate::topology::RoomShape;

/// What the canvas remembers from frame to frame.
#[derive(Default)]
pub(crate) struct Canvas {
    camera: Option<Camera>,
    /// A change of the view that waits for the size of the canvas.
    wish: Option<Wish>,
    /// The view of the last frame and where it was on the screen.
    seen: Option<(View, Rect)>,
    /// What a panel's row under the pointer stands for.
    pub hovered_in_panel: Option<ElementId>,
    /// What the pointer points at.
    pub pointed: Pointed,
    painter: ScenePainter,
    ghost: GhostPainter,
    /// What is not worked out yet.
    pending: Option<Pending>,
    /// The guide that is being dragged.
    pub guide_drag: Option<guides::Drag>,
    /// The triangles of the room whose fill marks it.
    marked: Option<(Arc<Derived>, ElementId, Vec<u32>)>,
    /// Whether the last turn of a wheel came from fingers on a touch pad.
    is_touch_pad: bool,
    /// Whether focus came by keyboard, so that it must be seen.
    shows_focus: bool,
    /// Whether the pointer moved the view in this frame.
    was_moved: bool,
    /// Whether a drag moves the view, however it goes on.
    is_panning: bool,
    /// Where the button was pressed: what the place snapped to, and the place itself.
    pressed_at: Option<(Point, Point)>,
    /// Where the pointer was last.
    last_pointer: Point,
}

/// Where the view stands.
#[derive(Clone, Copy, Debug)]
struct Camera {
    centre: Point,
    px_per_m: f64,
    /// Shows the whole plan, and goes on doing so when the window changes.
    is_fitted: bool,
}

#[derive(Clone, Copy, Debug)]
enum Wish {
    Fit,
    Zoom(Bounds),
    LookAt(Point, f64),
    By(f64),
    Reveal(ElementId),
}

/// Free space around a fitted plan, in points.
const FIT_MARGIN: f64 = 48.0;

/// A canvas on which nothing is drawn shows so many metres from side to side.
const EMPTY_WIDTH_M: f64 = 20.0;

/// Half a millimetre is as wide as a pixel: nothing smaller is drawn in a plan.
const MOST_PX_PER_M: f64 = 2000.0;

/// A hundred kilometres, the whole drawing area, fit a window.
const LEAST_PX_PER_M: f64 = 0.005;

/// Of more selected elements not all are marked: it would take longer than a frame.
const MOST_MARKED: usize = 2000;

/// How strongly a wheel zooms: egui's own measure for Ctrl and wheel.
const ZOOM_PER_POINT: f64 = 1.0 / 200.0;

/// What a person did on the canvas.
pub(crate) enum Act {
    /// What the tool in the hand does.
    Calls(Vec<Call>),
    Pick(ElementId),
    /// Pick the next or previous room; leave the canvas behind the last.
    PickNeighbour(isize),
    /// Pick the room nearest in a direction of the plan.
    PickTowards(Direction),
    Rename,
}

/// The keys of the tools one begins with, as people read them.
pub(crate) struct Beginning {
    pub walls: String,
    pub fill: String,
    pub rectangle: String,
    pub door: String,
}

impl Canvas {
    /// Forgets the plan that was shown.
    pub(crate) fn forget(&mut self) {
        *self = Self { is_touch_pad: self.is_touch_pad, ..Self::default() };
    }

    pub(crate) fn fit(&mut self) {
        self.wish = Some(Wish::Fit);
    }

    pub(crate) fn zoom_to(&mut self, bounds: Bounds) {
        self.wish = Some(Wish::Zoom(bounds));
    }

    pub(crate) fn look_at(&mut self, centre: Point, px_per_m: f64) {
        self.wish = Some(Wish::LookAt(centre, px_per_m));
    }

    pub(crate) fn zoom_by(&mut self, factor: f64) {
        self.wish = Some(Wish::By(factor));
    }

    /// Moves the view if need be, so that something is seen.
    pub(crate) fn reveal(&mut self, picked: ElementId) {
        self.wish = Some(Wish::Reveal(picked));
    }

    /// The view, unless it is the one that shows the whole plan: the point in the middle and points of
    /// the screen to the metre.
    pub(crate) fn free_view(&self) -> Option<(Point, f64)> {
        self.camera.filter(|camera| !camera.is_fitted).map(|camera| (camera.centre, camera.px_per_m))
    }

    /// Where the view was moved to by hand since the last call: the point in the middle and points of the
    /// screen to the metre.
    pub(crate) fn take_moved(&mut self) -> Option<(Point, f64)> {
        let was_moved = std::mem::take(&mut self.was_moved);
        self.camera.filter(|_| was_moved).map(|camera| (camera.centre, camera.px_per_m))
    }

    /// Moves the view at once, to a place nearby.
    pub(crate) fn set_view(&mut self, centre: Point, px_per_m: f64) {
        self.camera = Some(Camera { centre, px_per_m, is_fitted: false });
    }

    /// Keeps a point and all around it, which was scaled by a factor, where it is on the screen; a view of
    /// the whole plan goes by itself.
    pub(crate) fn scale_view(&mut self, about: Point, factor: f64) {
        if let Some((centre, px_per_m)) = self.free_view() {
            self.set_view(about + (centre - about) * factor, px_per_m / factor);
        }
    }

    /// The view of the last frame and where it was on the screen.
    pub(crate) fn seen(&self) -> Option<(View, Rect)> {
        self.seen
    }

    /// Where the canvas was in the last frame.
    pub(crate) fn seen_rect(&self) -> Option<Rect> {
        self.seen.map(|(_, rect)| rect)
    }

    /// How far from an opening a click picks it, in metres at the present zoom.
    pub(crate) fn pick_reach_m(&self) -> f64 {
        self.px_per_m().map_or(0.0, |px_per_m| tools::REACH_PX / px_per_m)
    }

    /// Points of the screen a metre of the plan is long.
    pub(crate) fn px_per_m(&self) -> Option<f64> {
        self.camera.map(|camera| camera.px_per_m)
    }

    pub(crate) fn screen_position(&self, point: Point) -> Option<Pos2> {
        self.seen.map(|(view, rect)| on_screen(rect, &view, point))
    }

    // The view.

    /// Where the view stands in a canvas of this size, wishes fulfilled.
    fn update_camera(&mut self, rect: Rect, document: &Document, shown: Option<&Derived>, backdrop: &BackdropView) {
        let (width_px, height_px) = (f64::from(rect.width()), f64::from(rect.height()));
        let bounds = shown.map_or_else(|| document.plan().bounds(), |derived| derived.drawing.bounds());
        let bounds = bounds.union(backdrop.bounds(document.plan().backdrop()));
        let bounds = self.ghost.bounds().filter(|_| bounds.is_empty()).unwrap_or(bounds);
        let fitting = |bounds: Bounds| {
            // A small canvas is for the plan, not for the space about it.
            let margin = FIT_MARGIN.min(width_px.min(height_px) / 8.0);
            let view = View::fitting(bounds, width_px, height_px, margin);
            Camera { centre: view.centre, px_per_m: view.px_per_m, is_fitted: false }
        };
        let whole = || match bounds.is_empty() {
            // Room for a house. What is drawn then does not move the view.
            true => {
                let px_per_m = width_px.max(1.0) / EMPTY_WIDTH_M;
                Camera { centre: Point::default(), px_per_m, is_fitted: false }
            }
            false => Camera { is_fitted: true, ..fitting(bounds) },
        };
        let mut camera = self.camera.filter(|camera| !camera.is_fitted).unwrap_or_else(whole);
        match self.wish.take() {
            None => {}
            Some(Wish::Fit) => camera = whole(),
            Some(Wish::Zoom(bounds)) => {
                // A third of the surroundings stays in sight.
                let around_m = bounds.width().max(bounds.height()) / 3.0;
                camera = fitting(bounds.inflated(around_m));
            }
            Some(Wish::LookAt(centre, px_per_m)) => camera = Camera { centre, px_per_m, is_fitted: false },
            Some(Wish::By(factor)) => {
                camera = Camera { px_per_m: camera.px_per_m * factor, is_fitted: false, ..camera };
            }
            Some(Wish::Reveal(picked)) => {
                let half = Vector::new(width_px, height_px) * (0.5 / camera.px_per_m);
                let seen = Bounds::of([camera.centre + half, camera.centre + -half]);
                if let Some(bounds) = document.bounds_of(picked)
                    && !(seen.contains(bounds.min) && seen.contains(bounds.max))
                {
                    let px_per_m = camera.px_per_m.min(fitting(bounds).px_per_m);
                    camera = Camera { centre: bounds.center(), px_per_m, is_fitted: false };
                }
            }
        }
        camera.px_per_m = camera.px_per_m.clamp(LEAST_PX_PER_M, MOST_PX_PER_M);
        self.camera = Some(camera);
    }

    fn view(&self, rect: Rect, pixels_per_point: f32) -> View {
        let camera = self.camera.unwrap_or(Camera { centre: Point::default(), px_per_m: 50.0, is_fitted: true });
        let view = View {
            width_px: f64::from(rect.width()),
            height_px: f64::from(rect.height()),
            px_per_m: camera.px_per_m,
            centre: camera.centre,
            pixel_ratio: f64::from(pixels_per_point),
        };
        on_whole_pixels(view, rect)
    }

    fn pan(&mut self, by: Vec2) {
        if let Some(camera) = &mut self.camera
            && by != Vec2::ZERO
        {
            let metres = Vector::new(-f64::from(by.x), f64::from(by.y)) * (1.0 / camera.px_per_m);
            camera.centre = camera.centre + metres;
            camera.is_fitted = false;
            self.was_moved = true;
        }
    }

    /// Zooms so that the point of the plan at a place of the screen stays there.
    fn zoom_at(&mut self, view: &View, rect: Rect, at: Pos2, factor: f64) {
        let Some(camera) = &mut self.camera else { return };
        let px_per_m = (camera.px_per_m * factor).clamp(LEAST_PX_PER_M, MOST_PX_PER_M);
        if px_per_m == camera.px_per_m {
            return;
        }
        let fixed = plan_point(view, rect, at);
        camera.centre = fixed + (camera.centre - fixed) * (camera.px_per_m / px_per_m);
        camera.px_per_m = px_per_m;
        camera.is_fitted = false;
        self.was_moved = true;
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
    }
}

/// Whether a turn of the wheel comes from fingers on a touch pad, which pan: they report points, or
/// fractions of a line, or go sideways. A wheel turns by whole lines up and down.
fn is_touch_pad(unit: MouseWheelUnit, delta: Vec2) -> bool {
    match unit {
        MouseWheelUnit::Point => true,
        MouseWheelUnit::Line => delta.x != 0.0 || delta.y.fract() != 0.0,
        MouseWheelUnit::Page => false,
    }
}

/// The view moved by less than a pixel, so that the plan's origin is on one: lines then look the same
/// wherever the plan is dragged.
fn on_whole_pixels(view: View, rect: Rect) -> View {
    let origin = view.screen_from_plan(Point::default());
    let rest = |place: f64, start: f32| {
        let pixels = (place + f64::from(start)) * view.pixel_ratio;
        (pixels - pixels.round()) / view.pixel_ratio
    };
    let (x, y) = (rest(origin.x, rect.min.x), rest(origin.y, rect.min.y));
    View { centre: view.centre + Vector::new(x, -y) * (1.0 / view.px_per_m), ..view }
}

impl Canvas {
    /// Shows the plan in all that is left of `ui`; gives what a person did there.
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
        // What was worked out for an earlier plan is better than nothing.
        let shown = fresh.or(document.last_derived().map(|(_, derived)| derived));
        self.update_camera(rect, document, shown.map(Arc::as_ref), backdrop);
        let response = ui.interact(rect, canvas_id(), Sense::click_and_drag());
        self.take_pointer(ui, &response, &self.view(rect, ui.pixels_per_point()));
        let view = self.view(rect, ui.pixels_per_point());
        self.seen = Some((view, rect));

        // While the plan is worked out anew after an edit, what was there before can still be picked:
        // pressing on a room may be what ended the edit of another's name.
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
        let scope = self.use_tool(ui, &response, document, shown, session, &options, toolbox, &view, &mut act);
        // With another tool in the hand the keyboard goes from room to room all the same.
        act = act.or(self.take_keys(ui, &response));

        let style = style(session, document.plan(), ui.visuals().dark_mode);
        let palette = style.palette();
        let painter = ui.painter_at(rect);
        painter.rect_filled(rect, 0.0, theme::colour(palette.paper));
        let placed = document.plan().backdrop().filter(|_| session.layers.backdrop);
        backdrop.paint(&painter, rect, &view, placed, session.background.is_inline());
        if let Some(derived) = shown {
            self.painter.paint(&painter, rect, derived, &style, &view);
        }
        self.ghost.paint(&painter, rect, session.shown_ghost(), &style, &view);
        match fresh {
            // Never a stale label as a fresh one.
            None => self.paint_pending(&painter, rect, &view, document, session, &style),
            Some(derived) => {
                let under_pointer = self.pointed.element.filter(|_| toolbox.is_selecting());
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
            dimensions::paint(&painter, rect, &view, session, derived, || self.painter.text_boxes(rect, &view));
        }
        let tool = toolbox.tool();
        let mut preview = Preview::default();
        preview_question(session, document.plan(), &mut preview);
        tool.preview(&scope, &mut preview);
        preview.paint(&painter, rect, &view, palette);
        if tool.snaps() && self.pointed.at.is_some() {
            tools::paint_snap(&painter, rect, &view, palette, &scope.snap);
        }
        paint_typed(&painter, rect, &view, palette, &scope, &toolbox.typed);
        let is_blank =
            document.plan().is_empty() && document.plan().backdrop().is_none() && session.ghost_plan().is_none();
        if is_blank && toolbox.is_selecting() {
            paint_beginning(&painter, rect, palette, beginning);
        }
        paint_scale_bar(&painter, rect, &view, palette, session.units());
        if response.has_focus() && self.shows_focus {
            let colours = theme::colours(ui.visuals());
            painter.rect_stroke(rect.shrink(1.0), 0.0, Stroke::new(2.0, colours.accent), StrokeKind::Inside);
        }
        let description = describe(document, session.picked());
        response.widget_info(|| WidgetInfo::labeled(Role::Canvas, true, &description));
        self.tell_screen_reader(ui, rect, &view, document, fresh, session).or(act)
    }

    /// Shows what changed since everything was worked out last.
    fn paint_pending(
        &mut self,
        painter: &Painter,
        rect: Rect,
        view: &View,
        document: &Document,
        session: &Session,
        style: &Style,
    ) {
        let Some((earlier, _)) = document.last_derived() else { return };
        let plan = document.plan();
        if !self.pending.as_ref().is_some_and(|pending| pending.is_between(earlier, plan)) {
            self.pending = Some(Pending::new(earlier, plan));
        }
        if let Some(pending) = &self.pending {
            pending.paint(painter, rect, view, style, &session.schemes);
        }
    }

    /// Lets the tool in the hand see what the pointer and the keys do.
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
        // A picture's walls do not stand on the grid.
        let grid_m = (!is_over_picture(session, document.plan()) && session.layers.grid).then(|| {
            session.settings.grid_m().unwrap_or(match session.units() {
                Units::Metric => 1.0,
                Units::Imperial => METRES_PER_FOOT,
            })
        });
        let (lines, points) = more_to_snap_to(session, view, pointer);
        let ground = tools::Ground {
            index,
            seen: view.bounds(),
            px_per_m: view.px_per_m,
            modifiers,
            lines: &lines,
            points: &points,
            options: options,
            grid_m,
            is_seen: self.pointed.at.is_some(),
        };
        let snap = toolbox.snap(&ground, pointer);
        let mut scope = Scope {
            plan: document.plan(),
            derived: shown,
            gaps: document.derived().map_or(&[], |derived| derived.gaps.as_slice()),
            selection: &session.selection,
            options: options,
            layers: &session.layers,
            copied: session.copied.as_ref(),
            units: session.units(),
            pointer,
            snap,
            px_per_m: view.px_per_m,
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
                inputs.push(Input::SecondaryClick);
            }
        }
        let mut calls = Vec::new();
        for input in inputs {
            let was_snapping = toolbox.tool().snaps();
            calls.extend(toolbox.tool_mut().take(input, &scope));
            // What it snaps to depends on what was begun.
            if toolbox.tool().snaps() != was_snapping || !calls.is_empty() {
                scope.snap = toolbox.snap(&ground, pointer);
            }
        }
        if !calls.is_empty() {
            *act = Some(Act::Calls(calls));
        }
        toolbox.hint = toolbox.tool().hint(&scope);
        if response.contains_pointer() && !self.is_panning && !is_space_held(ui) {
            ui.ctx().set_cursor_icon(toolbox.tool().cursor(&scope));
        }
        scope
    }

    /// With the keyboard on the canvas: Tab goes from room to room, arrows to the next room that way.
    fn take_keys(&mut self, ui: &Ui, response: &Response) -> Option<Act> {
        if response.gained_focus() {
            self.shows_focus = ui.input(|input| !input.pointer.any_pressed() && !input.pointer.any_released());
        }
        if !response.has_focus() {
            return None;
        }
        let filter = EventFilter { tab: true, horizontal_arrows: true, vertical_arrows: true, escape: false };
        ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, filter));
        if response.gained_focus() {
            // The key that brought the focus here is used up.
            return None;
        }
        ui.input(|input| {
            input.events.iter().find_map(|event| {
                let egui::Event::Key { key, pressed: true, modifiers, .. } = event else { return None };
                match key {
                    Key::Tab => Some(Act::PickNeighbour(if modifiers.shift { -1 } else { 1 })),
                    Key::ArrowLeft => Some(Act::PickTowards(Direction::Left)),
                    Key::ArrowRight => Some(Act::PickTowards(Direction::Right)),
                    Key::ArrowUp => Some(Act::PickTowards(Direction::Up)),
                    Key::ArrowDown => Some(Act::PickTowards(Direction::Down)),
                    Key::Enter => Some(Act::Rename),
                    _ => None,
                }
            })
        })
    }

    /// Marks a room or an opening.
    fn mark(
        &mut self,
        painter: &Painter,
        rect: Rect,
        view: &View,
        plan: &Plan,
        derived: &Arc<Derived>,
        marked: ElementId,
        mark: &Mark,
    ) {
        match marked {
            ElementId::Room(id) => {
                let Some(shape) = derived.analysis.shapes.get(id).filter(|shape| !shape.outer.is_empty()) else {
                    return;
                };
                if mark.fill != Color32::TRANSPARENT {
                    let is_known =
                        self.marked.as_ref().is_some_and(|(of, room, _)| Arc::ptr_eq(of, derived) && *room == marked);
                    if !is_known {
                        self.marked = Some((derived.clone(), marked, earcut(&shape.outer, &shape.holes)));
                    }
                    if let Some((_, _, triangles)) = &self.marked {
                        let mesh = polygon_mesh(rect, view, &shape.outer, &shape.holes, triangles, mark.fill);
                        painter.add(Shape::mesh(mesh));
                    }
                }
                for ring in shape.rings() {
                    let stroke = Stroke::new(mark.width, mark.line);
                    painter.add(Shape::mesh(outline_mesh(rect, view, ring, stroke)));
                }
            }
            ElementId::Corner(id) => {
                let Some(place) = plan.position(id).map(|point| on_screen(rect, view, point)) else { return };
                let square = Rect::from_center_size(place, Vec2::splat(8.0));
                painter.rect(
                    square,
                    1.0,
                    mark.line.gamma_multiply(0.35),
                    Stroke::new(mark.width, mark.line),
                    StrokeKind::Middle,
                );
            }
            ElementId::Wall(id) => {
                let Some(wall) = plan.wall(id) else { return };
                let Some(segment) = plan.wall_segment(wall) else { return };
                let ends = [segment.a, segment.b].map(|point| on_screen(rect, view, point));
                let width = (wall.thickness_m * view.px_per_m) as f32;
                painter.line_segment(ends, Stroke::new(width.max(2.0) + 4.0, mark.line.gamma_multiply(0.45)));
                painter.line_segment(ends, Stroke::new(mark.width, mark.line));
            }
            ElementId::Opening(id) => {
                let segment = plan.opening(id).and_then(|opening| plan.opening_segment(opening));
                let Some(segment) = segment else { return };
                let ends = [segment.a, segment.b].map(|point| on_screen(rect, view, point));
                let middle = ends[0] + (ends[1] - ends[0]) / 2.0;
                let half = (ends[1] - ends[0]) / 2.0;
                // Never so small that it is not seen.
                let half = if half.length() < 4.0 { vec2(4.0, 0.0) } else { half };
                let (from, to) = (middle - half, middle + half);
                let band = mark.width + 6.0;
                painter.line_segment([from, to], Stroke::new(band, mark.line.gamma_multiply(0.35)));
                painter.line_segment([from, to], Stroke::new(mark.width + 1.0, mark.line));
                for end in [from, to] {
                    painter.circle_filled(end, mark.width + 1.5, mark.line);
                }
            }
        }
    }

    /// Rooms as nodes of the accessibility tree, for screen readers and scripts. Painted things are
    /// invisible to them otherwise. Gives what they ask for.
    fn tell_screen_reader(
        &self,
        ui: &Ui,
        rect: Rect,
        view: &View,
        document: &Document,
        fresh: Option<&Arc<Derived>>,
        session: &Session,
    ) -> Option<Act> {
        if !ui.ctx().has_accesskit_node(canvas_id()) {
            return None;
        }
        let mut act = None;
        let derived = fresh?;
        for shape in derived.analysis.shapes.all().iter().filter(|shape| !shape.outer.is_empty()) {
            let corners = [shape.bounds.min, shape.bounds.max].map(|point| on_screen(rect, view, point));
            let bounds = Rect::from_two_pos(corners[0], corners[1]);
            if !bounds.intersects(rect) {
                continue;
            }
            let this = ElementId::Room(shape.id);
            let id = canvas_id().with(shape.id);
            let response = ui.interact(bounds.intersect(rect), id, Sense::hover());
            let label = title_of(document.plan(), this);
            response.widget_info(|| {
                WidgetInfo::selected(Role::ListBoxOption, true, session.picked() == Some(this), &label)
            });
            let said = said_of_room(document.plan(), derived, shape, session.units());
            ui.ctx().accesskit_node_builder(id, |node| {
                node.add_action(egui::accesskit::Action::Click);
                node.set_description(said);
            });
            if ui.input(|input| input.has_accesskit_action_request(id, egui::accesskit::Action::Click)) {
                act = Some(Act::Pick(this));
            }
        }
        act
    }
}

/// What an open question is about.
fn preview_question(session: &Session, plan: &Plan, preview: &mut Preview) {
    match &session.question {
        Some(Question::Delete { gone, .. }) => {
            for &element in gone.iter().take(MOST_MARKED) {
                match element {
                    ElementId::Room(id) => {
                        let points = plan.room(id).map(|room| plan.ring_points(&room.outer)).unwrap_or_default();
                        preview.fill(points, Vec::new(), Look::Danger);
                    }
                    ElementId::Wall(id) => {
                        let wall = plan.wall(id).and_then(|wall| Some((plan.wall_segment(wall)?, wall.thickness_m)));
                        if let Some((segment, thickness_m)) = wall {
                            preview.wall(segment, thickness_m, Look::Danger);
                        }
                    }
                    ElementId::Opening(id) => {
                        let segment = plan.opening(id).and_then(|opening| plan.opening_segment(opening));
                        if let Some(segment) = segment {
                            preview.line(vec![segment.a, segment.b], false, Look::Danger);
                        }
                    }
                    ElementId::Corner(_) => {}
                }
            }
        }
        Some(Question::Change(change)) => {
            for mark in change.marks.iter().take(MOST_MARKED) {
                preview.line(vec![mark.a, mark.b], false, Look::Danger);
                preview.handle(mark.b, Look::Danger);
            }
        }
        _ => {}
    }
}

/// Guide lines, and what lies near the pointer of the storey below.
fn more_to_snap_to(session: &Session, view: &View, pointer: Point) -> (Vec<Segment>, Vec<Point>) {
    let seen = view.bounds();
    let mut lines: Vec<Segment> = session
        .guides()
        .iter()
        .map(|guide| match guide.axis {
            GuideAxis::Horizontal => {
                Segment::new(Point::new(seen.min.x, guide.at_m), Point::new(seen.max.x, guide.at_m))
            }
            GuideAxis::Vertical => Segment::new(Point::new(guide.at_m, seen.min.y), Point::new(guide.at_m, seen.max.y)),
        })
        .collect();
    // As far as something attracts, and more.
    let near = Bounds::of([pointer]).inflated(GHOST_REACH_PX / view.px_per_m);
    let below: Vec<Segment> = session.ghost_segments().iter().copied().filter(|line| near.meets(*line)).collect();
    let points = below.iter().flat_map(|line| [line.a, line.b]).collect();
    lines.extend(below);
    (lines, points)
}

/// The storey below attracts from this far away, in points.
const GHOST_REACH_PX: f64 = 16.0;

/// Whether the key is held that makes every drag move the view.
fn is_space_held(ui: &Ui) -> bool {
    !ui.ctx().text_edit_focused() && ui.input(|input| input.key_down(Key::Space))
}

/// What has been typed for the tool, beside the pointer.
fn paint_typed(painter: &Painter, rect: Rect, view: &View, palette: &Palette, scope: &Scope<'_>, typed: &str) {
    if typed.is_empty() {
        return;
    }
    let at = on_screen(rect, view, scope.at()) + vec2(14.0, 40.0);
    let ink = theme::colour(palette.ink);
    tools::tag(painter, at, egui::Align2::LEFT_TOP, &format!("{typed}|   Enter"), ink, palette);
}

/// How something is marked.
struct Mark {
    line: Color32,
    width: f32,
    fill: Color32,
}

impl Mark {
    fn hover(palette: &Palette) -> Self {
        Self { line: theme::colour(palette.hover), width: 2.0, fill: Color32::TRANSPARENT }
    }

    fn picked(palette: &Palette) -> Self {
        let line = theme::colour(palette.selection);
        Self { line, width: 2.5, fill: line.gamma_multiply(0.16) }
    }
}

/// Whether a picture is shown under the plan.
fn is_over_picture(session: &Session, plan: &Plan) -> bool {
    session.layers.backdrop && plan.backdrop().is_some()
}

/// How the plan is drawn now.
fn style(session: &Session, plan: &Plan, is_dark: bool) -> Style {
    let layers = session.layers;
    let is_over_picture = is_over_picture(session, plan);
    Style {
        theme: if is_dark { draw::Theme::Dark } else { draw::Theme::Light },
        fill: layers.fill,
        label_colours: layers.colours,
        // The picture must be seen through the rooms.
        fill_opacity: if is_over_picture { 0.55 } else { 1.0 },
        halo: is_over_picture,
        text_px: 12.5,
        units: session.units(),
        grid_m: session.settings.grid_m(),
        layers: Layers {
            // Over a picture its lines would be taken for walls.
            grid: layers.grid && !is_over_picture,
            rooms: !(is_over_picture && layers.fill == draw::Fill::None),
            walls: true,
            openings: true,
            graph: layers.graph,
            names: layers.names,
            areas: layers.names,
        },
    }
}

/// What the canvas shows, in a sentence.
fn describe(document: &Document, picked: Option<ElementId>) -> String {
    let plan = document.plan();
    let mut text = format!("Plan {}, {} rooms", document.title(), plan.rooms().len());
    if let Some(picked) = picked {
        text.push_str(&format!("; picked: {}", title_of(plan, picked)));
    }
    text
}

/// A room's label and area, in words.
fn said_of_room(plan: &Plan, derived: &Derived, shape: &RoomShape, units: Units) -> String {
    let status = derived.analysis.room(shape.id).map(|room| room.status);
    let label = match status {
        Some(RoomStatus::Labelled(label)) => label.name(),
        Some(RoomStatus::NotClassified) => "not classified",
        Some(RoomStatus::Unlabelled) | None => "no label",
    };
    let function = plan.room(shape.id).map(|room| room.function.trim()).unwrap_or_default();
    let function = if function.is_empty() { String::new() } else { format!(", {}", normalised_function(function)) };
    format!("{label}{function}, {}", units.area(shape.area_m2()))
}

/// A bar of a round length in the lower left corner.
fn paint_scale_bar(painter: &Painter, rect: Rect, view: &View, palette: &Palette, units: Units) {
    // The longest round length that is at most as long as this, in points.
    const LONGEST: f64 = 120.0;
    let length_m = units.round_length_at_most(LONGEST / view.px_per_m);
    let width = (length_m * view.px_per_m) as f32;
    let left = rect.left_bottom() + vec2(16.0, -18.0);
    let ink = theme::colour(palette.ink_muted);
    let text = units.round_length(length_m);
    let galley = painter.layout_no_wrap(text, egui::FontId::proportional(theme::SMALL), ink);
    let ground = Rect::from_min_max(left + vec2(-6.0, -8.0), left + vec2(width + 12.0 + galley.rect.width(), 8.0));
    painter.rect_filled(ground, 4.0, theme::colour(palette.paper).gamma_multiply(0.85));
    let stroke = Stroke::new(1.5, ink);
    painter.line_segment([left, left + vec2(width, 0.0)], stroke);
    for end in [left, left + vec2(width, 0.0)] {
        painter.line_segment([end + vec2(0.0, -4.0), end + vec2(0.0, 4.0)], stroke);
    }
    let beside = left + vec2(width + 6.0, -galley.rect.height() / 2.0);
    painter.galley(beside, galley, ink);
}

#[cfg(test)]
mod tests {
    use egui::pos2;

    use super::*;

    #[test]
    fn wheels_zoom_and_fingers_pan() {
        assert!(!is_touch_pad(MouseWheelUnit::Line, vec2(0.0, -1.0)));
        assert!(is_touch_pad(MouseWheelUnit::Line, vec2(0.0, -0.3)));
        assert!(is_touch_pad(MouseWheelUnit::Line, vec2(1.0, 0.0)));
        assert!(is_touch_pad(MouseWheelUnit::Point, vec2(0.0, -12.0)));
    }

    #[test]
    fn zooming_keeps_the_point_under_the_pointer() {
        let rect = Rect::from_min_size(pos2(40.0, 20.0), vec2(400.0, 300.0));
        let camera = Camera { centre: Point::new(3.0, 4.0), px_per_m: 30.0, is_fitted: true };
        let mut canvas = Canvas { camera: Some(camera), ..Canvas::default() };
        let at = pos2(111.0, 77.0);
        let view = canvas.view(rect, 1.0);
        let before = plan_point(&view, rect, at);
        canvas.zoom_at(&view, rect, at, 2.5);
        let after = plan_point(&canvas.view(rect, 1.0), rect, at);
        // Half a pixel of 75 to the metre.
        assert!(before.distance(after) <= 0.5f64.hypot(0.5) / 75.0 + 1e-9, "{before:?} {after:?}");
        for factor in [1e9, 1e-9] {
            canvas.zoom_at(&view, rect, at, factor);
            let px_per_m = canvas.px_per_m().expect("has a camera");
            assert!((LEAST_PX_PER_M..=MOST_PX_PER_M).contains(&px_per_m));
        }
    }
}

/// What to do with an empty plan: the tools one begins with, by their keys.
fn paint_beginning(painter: &Painter, rect: Rect, palette: &Palette, beginning: &Beginning) {
    let lines = [
        ("Nothing is drawn yet".to_owned(), theme::TITLE, palette.ink),
        (
            format!("{}   Draw walls, then {} makes rooms of what they enclose", beginning.walls, beginning.fill),
            theme::BODY,
            palette.ink_muted,
        ),
        (format!("{}   Draw rooms as rectangles", beginning.rectangle), theme::BODY, palette.ink_muted),
        (format!("{}   Put doors in", beginning.door), theme::BODY, palette.ink_muted),
        ("Or drop a picture of a plan here, to trace it".to_owned(), theme::BODY, palette.ink_muted),
    ];
    const LINE: f32 = 26.0;
    // Of a small canvas the hints would hide all.
    if rect.width() < 420.0 || rect.height() < 240.0 {
        return;
    }
    let mut at = rect.center() - vec2(0.0, LINE * lines.len() as f32 / 2.0);
    for (text, size, colour) in lines {
        painter.text(at, egui::Align2::CENTER_TOP, text, egui::FontId::proportional(size), theme::colour(colour));
        at.y += LINE;
    }
}
