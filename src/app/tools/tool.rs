//! What a tool is: a state machine, and its entry in the list of tools.

use egui::{CursorIcon, Key};

use super::input::{Anchor, Input, Scope};
use super::path::Path;
use super::typing::Typing;
use crate::app::paint::preview::Preview;
use crate::geometry::Point;

/// A tool as the table has it.
pub(crate) struct Entry {
    /// Its word; the command that takes it up is `tool-…`.
    pub id: &'static str,
    pub make: fn() -> Box<dyn Tool>,
}

/// A command to run: its id and its arguments.
pub(crate) type Call = (&'static str, Vec<String>);

/// What undo does to a tool at work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum TakenBack {
    /// Nothing: the plan's last step is undone.
    Nothing,
    /// A corner that is not part of the plan yet.
    Corner,
    /// A corner that is: the plan's last step is undone as well.
    CornerAndStep,
}

/// A state machine.
pub(crate) trait Tool {
    /// What a person does, and the commands that follow.
    fn take(&mut self, input: Input, scope: &Scope<'_>) -> Vec<Call>;

    /// What can be done now, for the status line.
    fn hint(&self, scope: &Scope<'_>) -> String;

    /// What is in the making.
    fn preview(&self, scope: &Scope<'_>, preview: &mut Preview);

    fn cursor(&self, _scope: &Scope<'_>) -> CursorIcon {
        CursorIcon::Crosshair
    }

    /// The corners in the making, where it draws one after the other: what follows is then as they say.
    fn path(&self) -> Option<&Path> {
        None
    }

    fn path_mut(&mut self) -> Option<&mut Path> {
        None
    }

    /// Whether something is begun that Escape drops.
    fn is_busy(&self) -> bool {
        self.path().is_some_and(|path| !path.is_empty())
    }

    /// Whether places snap.
    fn snaps(&self) -> bool {
        true
    }

    fn anchor(&self) -> Option<Anchor> {
        self.path()?.anchor()
    }

    /// Points in the making that attract like corners.
    fn points(&self) -> Vec<Point> {
        Vec::new()
    }

    /// What can be typed now.
    fn typing(&self) -> Option<Typing> {
        self.path().filter(|path| !path.is_empty()).map(|_| Typing::Length)
    }

    /// Letters that it takes while it is busy.
    fn keys(&self) -> &'static [Key] {
        &[]
    }

    /// The plan did not take what it called for last.
    fn was_refused(&mut self) {}

    fn take_back(&mut self) -> TakenBack {
        let was_there = self.path_mut().is_some_and(|path| path.take_back().0);
        if was_there { TakenBack::Corner } else { TakenBack::Nothing }
    }
}
