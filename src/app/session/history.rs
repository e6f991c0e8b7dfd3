//! Editing. Every change goes through here and is a step of the history.

use super::Session;
use crate::app::session::fields::Field;
use crate::app::session::fields::FieldKind;
use crate::app::session::messages::{Lasts, Message, Remedy, Severity};
use crate::edit;
use crate::edit::EditError;
use crate::geometry::Bounds;
use crate::plan::ElementId;
use crate::plan::Meta;
use crate::plan::Plan;
impl Session {
    pub(crate) fn edit(&mut self, title: &str, change: impl FnOnce(&Plan) -> Result<Plan, EditError>) {
        if let Err(error) = self.try_edit(title, change) {
            self.say_refused(format!("Nothing changed: {error}"));
        }
    }

    /// Like [`App::edit`], but leaves it to the caller to report why nothing changed.
    pub(crate) fn try_edit(
        &mut self,
        title: &str,
        change: impl FnOnce(&Plan) -> Result<Plan, EditError>,
    ) -> Result<(), EditError> {
        let Some(document) = &mut self.document else { return Ok(()) };
        let before = document.plan();
        let edit::Settled { plan, fixed } = edit::settle_dimensions(before, change(before)?);
        document.history.push(title, plan);
        self.fresh = None;
        if fixed > 0 {
            let points = crate::base::wording::count(fixed, "point");
            let text = format!("{points} of dimensions lost what they measured and stay where they are");
            self.say(Severity::Info, text, "");
        }
        Ok(())
    }

    /// Like [`Self::try_edit`], of an edit that looks at nothing and changes nothing beyond the rooms that meet a box.
    pub(crate) fn try_edit_near(
        &mut self,
        title: &str,
        bounds: Bounds,
        change: impl Fn(&Plan) -> Result<Plan, EditError>,
    ) -> Result<(), EditError> {
        let Some(document) = &self.document else { return Ok(()) };
        let rooms = document.near(bounds);
        let whole = |bounds: Bounds, element: &ElementId| match element {
            ElementId::Room(_) => bounds.union(document.bounds_of(*element).unwrap_or(Bounds::EMPTY)),
            _ => bounds,
        };
        let around = rooms.iter().flatten().fold(bounds, whole);
        match document.near(around) {
            Some(near) => self.try_edit(title, |plan| edit::locally(plan, &near, around, change)),
            None => self.try_edit(title, change),
        }
    }

    /// Commits the text field's contents to the plan.
    pub(crate) fn commit_field(&mut self) {
        if let Some(field) = self.field.take() {
            self.keeping_fresh(|session| session.edit(field.title(), |plan| field.apply(plan)));
            // The field's room is the picked one: picking another ends the editing first.
            let (id, text) = field.as_command();
            if id == "set-function" {
                self.remember_function(&text);
            }
            self.note_executed(id, vec![text]);
        }
    }

    /// Sets a text of the picked room.
    pub(crate) fn write_field(&mut self, kind: FieldKind, text: &str) {
        let Some((room, _)) = self.picked_room() else { return };
        let field = Field::new(room, kind, text);
        self.keeping_fresh(|session| session.edit(field.title(), |plan| field.apply(plan)));
    }

    /// Changes the plan's metadata.
    pub(crate) fn change_meta(&mut self, title: &str, change: impl FnOnce(&mut Meta)) {
        self.edit(title, |plan| {
            let mut meta = plan.meta().clone();
            change(&mut meta);
            Ok(edit::set_meta(plan, meta))
        });
    }

    pub(crate) fn redo(&mut self) {
        self.fresh = None;
        if let Some(title) = self.document.as_mut().and_then(|document| document.history.redo()) {
            self.status = format!("Redone: {title}");
        }
    }

    /// Goes to a step of the history, counted from 0; the error says why if there is none.
    pub(crate) fn jump_to_step(&mut self, step: usize) -> Result<(), String> {
        let Some(document) = &mut self.document else { return Ok(()) };
        let number = document.history.steps().len();
        let Some(title) = document.history.steps().get(step).map(|step| step.title.clone()) else {
            return Err(format!("the history has {}", crate::base::wording::count(number, "step")));
        };
        document.history.jump_to(step);
        self.status = format!("Step {} of {number}: {title}", step + 1);
        Ok(())
    }

    /// Undoes the last change.
    pub(crate) fn undo(&mut self) {
        self.fresh = None;
        if let Some(title) = self.document.as_mut().and_then(|document| document.history.undo()) {
            self.status = format!("Undone: {title}");
        }
    }

    /// Deletes elements and what depends on them. Where a wall between two rooms went, offers to merge them.
    pub(crate) fn delete(&mut self, elements: &[ElementId]) {
        let before = self.plan().cloned();
        let title = match elements {
            [one] => format!("Delete {}", one.kind()),
            several => format!("Delete {} elements", several.len()),
        };
        self.edit(&title, |plan| edit::remove(plan, elements));
        let Some((before, after)) = before.zip(self.plan()) else { return };
        if let Some(rooms) = edit::rooms_joined_by(&before, after, elements) {
            let names = rooms.map(|id| after.room(id).map(|room| room.name.clone()).unwrap_or_default());
            let text = match names {
                [a, b] if !a.is_empty() && !b.is_empty() => format!("No wall separates {a} and {b} now"),
                _ => "No wall separates these two rooms now".to_owned(),
            };
            let remedies = vec![Remedy::MergeRooms(rooms)];
            let lasts = Lasts::Step(self.document.as_ref().map_or(0, |document| document.history.position()));
            self.add_message(Message::new(Severity::Info, text, "").with(remedies).lasting(lasts));
        }
    }
}
