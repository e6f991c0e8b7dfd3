//! The view: panning, zooming, interpreting the wheel.

use egui::{MouseWheelUnit, Pos2, Rect, Vec2};

use super::Canvas;
use crate::app::paint::backdrop::BackdropView;
use crate::app::paint::places::{on_screen, plan_point};
use crate::app::session::document::{Derived, Document};
use crate::draw::View;
use crate::geometry::{Bounds, Point, Vector};
use crate::plan::{ElementId, Plan};

/// The position of the view.
#[derive(Clone, Debug)]
pub(super) struct Camera {
    centre: Point,
    px_per_m: f64,
    /// What it shows all of, and goes on to when the window changes.
    fitted: Option<Fitted>,
}

/// What a view shows all of.
#[derive(Clone, Debug)]
struct Fitted {
    /// The plan as it was then. What is drawn later does not move the view.
    plan: Plan,
    /// What there was to be seen of it: more becomes known of the same plan, such as the picture under it.
    bounds: Bounds,
}

#[derive(Clone, Copy, Debug)]
pub(super) enum Wish {
    Fit,
    Zoom(Bounds),
    LookAt(Point, f64),
    By(f64),
    Reveal(ElementId),
}

/// Margin around a fitted plan, in points.
const FIT_MARGIN: f64 = 48.0;

/// Width in metres shown by an empty canvas.
const EMPTY_WIDTH_M: f64 = 20.0;

/// Maximum zoom: a pixel is half a millimetre, and nothing smaller is drawn in a plan.
const MOST_PX_PER_M: f64 = 2000.0;

/// Minimum zoom: a hundred kilometres, the whole drawing area, fit a window.
const LEAST_PX_PER_M: f64 = 0.005;

impl Canvas {
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

    /// Moves the view if necessary, so that an element is visible.
    pub(crate) fn reveal(&mut self, picked: ElementId) {
        self.wish = Some(Wish::Reveal(picked));
    }

    /// The view, unless it shows the whole plan: the point in the middle, and screen points per metre.
    pub(crate) fn free_view(&self) -> Option<(Point, f64)> {
        let free = self.camera.as_ref().filter(|camera| camera.fitted.is_none());
        free.map(|camera| (camera.centre, camera.px_per_m))
    }

    /// The view if it was moved by hand since the last call: the point in the middle, and screen points
    /// per metre.
    pub(crate) fn take_moved(&mut self) -> Option<(Point, f64)> {
        let was_moved = std::mem::take(&mut self.was_moved);
        self.camera.as_ref().filter(|_| was_moved).map(|camera| (camera.centre, camera.px_per_m))
    }

    /// Moves the view at once, to somewhere nearby.
    pub(crate) fn set_view(&mut self, centre: Point, px_per_m: f64) {
        self.camera = Some(Camera { centre, px_per_m, fitted: None });
    }

    /// Keeps a point and its surroundings, which were scaled by a factor, in place on the screen.
    pub(crate) fn scale_view(&mut self, about: Point, factor: f64) {
        let camera = self.camera.as_ref().map(|camera| (camera.centre, camera.px_per_m));
        if let Some((centre, px_per_m)) = camera {
            self.set_view(about + (centre - about) * factor, px_per_m / factor);
        }
    }

    /// Screen points per metre of the plan.
    pub(crate) fn px_per_m(&self) -> Option<f64> {
        self.camera.as_ref().map(|camera| camera.px_per_m)
    }

    pub(crate) fn screen_position(&self, point: Point) -> Option<Pos2> {
        self.seen.map(|(view, rect)| on_screen(rect, &view, point))
    }

    // The view.

    /// The view in a canvas of this size, after applying pending requests.
    pub(super) fn update_camera(
        &mut self,
        rect: Rect,
        document: &Document,
        shown: Option<&Derived>,
        backdrop: &BackdropView,
    ) {
        let (width_px, height_px) = (f64::from(rect.width()), f64::from(rect.height()));
        let bounds = shown.map_or_else(|| document.plan().bounds(), |derived| derived.drawing.bounds());
        let bounds = bounds.union(backdrop.bounds(document.plan().backdrop()));
        let bounds = self.ghost.bounds().filter(|_| bounds.is_empty()).unwrap_or(bounds);
        let fitting = |bounds: Bounds| {
            // A small canvas is for the plan, not for its margin.
            let margin = FIT_MARGIN.min(width_px.min(height_px) / 8.0);
            let view = View::fitting(bounds, width_px, height_px, margin);
            Camera { centre: view.centre, px_per_m: view.px_per_m, fitted: None }
        };
        let plan = document.plan();
        let whole = || match bounds.is_empty() {
            // Room for a house. What is then drawn does not move the view.
            true => {
                let px_per_m = width_px.max(1.0) / EMPTY_WIDTH_M;
                Camera { centre: Point::default(), px_per_m, fitted: None }
            }
            false => Camera { fitted: Some(Fitted { plan: plan.clone(), bounds }), ..fitting(bounds) },
        };
        let mut camera = match self.camera.take() {
            None => whole(),
            Some(Camera { fitted: Some(fitted), .. }) if fitted.plan.is_same_value(plan) => whole(),
            // The plan has been changed since: only the window moves the view.
            Some(Camera { fitted: Some(fitted), .. }) => {
                let same = fitting(fitted.bounds);
                Camera { fitted: Some(fitted), ..same }
            }
            Some(free) => free,
        };
        match self.wish.take() {
            None => {}
            Some(Wish::Fit) => camera = whole(),
            Some(Wish::Zoom(bounds)) => {
                // A third of the surroundings stays visible.
                let around_m = bounds.width().max(bounds.height()) / 3.0;
                camera = fitting(bounds.inflated(around_m));
            }
            Some(Wish::LookAt(centre, px_per_m)) => camera = Camera { centre, px_per_m, fitted: None },
            Some(Wish::By(factor)) => {
                camera = Camera { px_per_m: camera.px_per_m * factor, fitted: None, ..camera };
            }
            Some(Wish::Reveal(picked)) => {
                let half = Vector::new(width_px, height_px) * (0.5 / camera.px_per_m);
                let seen = Bounds::of([camera.centre + half, camera.centre + -half]);
                if let Some(bounds) = document.bounds_of(picked)
                    && !(seen.contains(bounds.min) && seen.contains(bounds.max))
                {
                    let px_per_m = camera.px_per_m.min(fitting(bounds).px_per_m);
                    camera = Camera { centre: bounds.center(), px_per_m, fitted: None };
                }
            }
        }
        camera.px_per_m = camera.px_per_m.clamp(LEAST_PX_PER_M, MOST_PX_PER_M);
        self.camera = Some(camera);
    }

    pub(super) fn view(&self, rect: Rect, pixels_per_point: f32) -> View {
        let (centre, px_per_m) =
            self.camera.as_ref().map_or((Point::default(), 50.0), |camera| (camera.centre, camera.px_per_m));
        let view = View {
            width_px: f64::from(rect.width()),
            height_px: f64::from(rect.height()),
            px_per_m,
            centre,
            pixel_ratio: f64::from(pixels_per_point),
        };
        on_whole_pixels(view, rect)
    }

    pub(super) fn pan(&mut self, by: Vec2) {
        if let Some(camera) = &mut self.camera
            && by != Vec2::ZERO
        {
            let metres = Vector::new(-f64::from(by.x), f64::from(by.y)) * (1.0 / camera.px_per_m);
            camera.centre = camera.centre + metres;
            camera.fitted = None;
            self.was_moved = true;
        }
    }

    /// Zooms so that the point of the plan at a screen position stays there.
    pub(super) fn zoom_at(&mut self, view: &View, rect: Rect, at: Pos2, factor: f64) {
        let Some(camera) = &mut self.camera else { return };
        let px_per_m = (camera.px_per_m * factor).clamp(LEAST_PX_PER_M, MOST_PX_PER_M);
        if px_per_m == camera.px_per_m {
            return;
        }
        let fixed = plan_point(view, rect, at);
        camera.centre = fixed + (camera.centre - fixed) * (camera.px_per_m / px_per_m);
        camera.px_per_m = px_per_m;
        camera.fitted = None;
        self.was_moved = true;
    }
}

/// Whether a scroll event comes from a touch pad, which pans: they report points or fractions of a line,
/// or scroll sideways. A wheel reports whole lines up and down.
pub(super) fn is_touch_pad(unit: MouseWheelUnit, delta: Vec2) -> bool {
    match unit {
        MouseWheelUnit::Point => true,
        MouseWheelUnit::Line => delta.x != 0.0 || delta.y.fract() != 0.0,
        MouseWheelUnit::Page => false,
    }
}

/// The view shifted by less than a pixel so that the plan's origin is on a whole pixel: lines then look
/// the same wherever the plan is dragged.
fn on_whole_pixels(view: View, rect: Rect) -> View {
    let origin = view.screen_from_plan(Point::default());
    let rest = |place: f64, start: f32| {
        let pixels = (place + f64::from(start)) * view.pixel_ratio;
        (pixels - pixels.round()) / view.pixel_ratio
    };
    let (x, y) = (rest(origin.x, rect.min.x), rest(origin.y, rect.min.y));
    View { centre: view.centre + Vector::new(x, -y) * (1.0 / view.px_per_m), ..view }
}

#[cfg(test)]
mod tests {
    use egui::{pos2, vec2};

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
        let camera = Camera { centre: Point::new(3.0, 4.0), px_per_m: 30.0, fitted: None };
        let mut canvas = Canvas { camera: Some(camera), ..Canvas::default() };
        let at = pos2(111.0, 77.0);
        let view = canvas.view(rect, 1.0);
        let before = plan_point(&view, rect, at);
        canvas.zoom_at(&view, rect, at, 2.5);
        let after = plan_point(&canvas.view(rect, 1.0), rect, at);
        // Half a pixel at 75 per metre.
        assert!(before.distance(after) <= 0.5f64.hypot(0.5) / 75.0 + 1e-9, "{before:?} {after:?}");
        for factor in [1e9, 1e-9] {
            canvas.zoom_at(&view, rect, at, factor);
            let px_per_m = canvas.px_per_m().expect("has a camera");
            assert!((LEAST_PX_PER_M..=MOST_PX_PER_M).contains(&px_per_m));
        }
    }
}
