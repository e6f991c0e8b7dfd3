//! Makes a room of what walls enclose.

use egui::{Key, KeyboardShortcut, Modifiers};

use std::cell::RefCell;

use super::tool::Group;
use super::{Call, Entry, Input, Scope, Tool, Value};
use crate::app::look::icons::{Icon, Part};
use crate::app::paint::preview::{Look, Preview};
use crate::geometry::{Point, polygon};
use crate::plan::Plan;
use crate::topology::{PlanFace, PlanFaces, net_of};

pub(super) const ENTRY: Entry = Entry {
    id: "tool-fill",
    title: "Fill",
    help: "Click inside closed walls to make a room",
    keys: &[KeyboardShortcut::new(Modifiers::NONE, Key::E)],
    strip: Some((
        Icon::Drawn(&[
            Part::Loop(&[(7.2, 2.6), (12.6, 8.0), (7.4, 13.2), (2.0, 7.8)]),
            Part::Fill(&[(2.0, 7.8), (12.6, 8.0), (7.4, 13.2)]),
            Part::Line(&[(14.0, 10.0), (14.0, 13.4)]),
        ]),
        Group::Draw,
    )),
    options: &[],
    make: || Box::new(Fill::default()),
};

#[derive(Default)]
struct Fill {
    /// The faces of a plan: computed once per plan, when the pointer is first over it.
    faces: RefCell<Option<(Plan, Vec<PlanFace>)>>,
}

impl Fill {
    /// Calls `then` with the free face around a point.
    fn with_face<R>(&self, scope: &Scope<'_>, point: Point, then: impl FnOnce(&PlanFace) -> R) -> Option<R> {
        let mut known = self.faces.borrow_mut();
        if !known.as_ref().is_some_and(|(plan, _)| plan.is_same_value(scope.plan)) {
            let faces = PlanFaces::new(scope.plan).map(|faces| faces.all().to_vec()).unwrap_or_default();
            *known = Some((scope.plan.clone(), faces));
        }
        let (_, faces) = known.as_ref()?;
        let around = |face: &&PlanFace| {
            polygon::bounds(&face.outer).contains(point)
                && polygon::locate(&face.outer, &face.holes, point) == polygon::Location::Inside
        };
        faces.iter().filter(|face| face.rooms.is_empty()).find(around).map(then)
    }
}

impl Tool for Fill {
    fn take(&mut self, input: Input, scope: &Scope<'_>) -> Vec<Call> {
        match input {
            Input::Click => vec![Call::new("fill-at", [Value::point(scope.pointer)])],
            _ => Vec::new(),
        }
    }

    fn hint(&self, scope: &Scope<'_>) -> String {
        match self.with_face(scope, scope.pointer, |face| clear_area(scope, face)) {
            Some(area) => format!("Click to make a room of {area}"),
            None => "Fill: point inside closed walls where there is no room yet · Shift+E fills all".to_owned(),
        }
    }

    fn preview(&self, scope: &Scope<'_>, preview: &mut Preview) {
        self.with_face(scope, scope.pointer, |face| {
            preview.fill(face.outer.clone(), face.holes.clone(), Look::New);
            preview.line(face.outer.clone(), true, Look::New);
            preview.label(scope.pointer, clear_area(scope, face), Look::New);
        });
    }

    fn snaps(&self) -> bool {
        false
    }
}

/// The clear area of what would be filled, in words.
fn clear_area(scope: &Scope<'_>, face: &PlanFace) -> String {
    let net = net_of(scope.plan, &face.outer, &face.holes);
    let clear = if net.has_walls { " clear" } else { "" };
    format!("{}{clear}", scope.units.area(net.area_m2))
}
