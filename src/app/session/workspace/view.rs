//! What the table of a workspace shows: which rows, in which order, which of them are selected. Rows are found beside the
//! frames; the last ones stay until the next are there.

use std::sync::Arc;

use egui::Context;

use super::OpenWorkspace;
use crate::app::session::Session;
use crate::app::session::jobs::{Kind, Wanted};
use crate::app::session::workspace::shows::Shows;
use crate::workspace::change::Selected;
use crate::workspace::query::{self, Order, PlanColumn, Query, RoomColumn};
use crate::workspace::{PlanRow, RoomRow, Workspace};

/// What is asked of a workspace.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Question {
    revision: u64,
    shows: Shows,
    query: Query,
    plans: Order<PlanColumn>,
    rooms: Order<RoomColumn>,
}

/// Rows of a value of the workspace.
#[derive(Clone, Debug, Default)]
pub(crate) struct Rows {
    pub of: Arc<Workspace>,
    pub plans: Vec<PlanRow>,
    pub rooms: Vec<RoomRow>,
}

/// What is shown of a workspace.
pub(crate) struct View {
    pub shows: Shows,
    pub query: Query,
    pub plan_order: Order<PlanColumn>,
    pub room_order: Order<RoomColumn>,
    /// What was last found; replaced as a whole.
    pub rows: Rows,
    pub selected: Selected,
    /// Another whenever something else is selected.
    pub selection: u64,
    /// The row with the cursor, and the one where a selection over several began.
    pub cursor: usize,
    pub anchor: usize,
    answered: Option<Question>,
    asked: Option<(Question, Wanted)>,
}

impl Default for View {
    fn default() -> Self {
        Self {
            shows: Shows::default(),
            query: Query::default(),
            plan_order: Order::by(PlanColumn::Name),
            room_order: Order::by(RoomColumn::Plan),
            rows: Rows::default(),
            selected: Selected::default(),
            selection: 0,
            cursor: 0,
            anchor: 0,
            answered: None,
            asked: None,
        }
    }
}

impl View {
    /// How many rows there are.
    pub(crate) fn len(&self) -> usize {
        if self.shows == Shows::Rooms { self.rows.rooms.len() } else { self.rows.plans.len() }
    }

    /// Whether a row is selected.
    pub(crate) fn is_selected(&self, row: usize) -> bool {
        match self.shows {
            Shows::Rooms => {
                let key = self.rows.rooms.get(row).and_then(|row| self.rows.of.room_key(*row));
                key.is_some_and(|key| self.selected.rooms.contains(&key))
            }
            Shows::Plans | Shows::Grid => {
                let key = self.rows.plans.get(row).and_then(|row| self.rows.of.plan_key(*row));
                key.is_some_and(|key| self.selected.plans.contains(&key))
            }
        }
    }

    /// Puts the cursor on a row and selects it: alone, in addition to what is selected (or no more, if it was), or with
    /// all from where the selection began.
    pub(crate) fn choose(&mut self, row: usize, adds: bool, extends: bool) {
        let was_selected = self.is_selected(row);
        self.cursor = row;
        self.selection += 1;
        if !adds {
            self.selected = Selected::default();
        }
        if extends {
            self.mark(self.anchor.min(row)..self.anchor.max(row) + 1);
        } else {
            self.anchor = row;
            if adds && was_selected { self.unmark(row) } else { self.mark(row..row + 1) }
        }
    }

    /// Selects everything that is shown.
    pub(crate) fn choose_all(&mut self) {
        self.selection += 1;
        self.selected = Selected::default();
        self.mark(0..self.len());
    }

    fn mark(&mut self, rows: std::ops::Range<usize>) {
        let of = &self.rows.of;
        if self.shows == Shows::Rooms {
            let rows = self.rows.rooms.get(rows.start..rows.end.min(self.rows.rooms.len())).unwrap_or_default();
            self.selected.rooms.extend(rows.iter().filter_map(|row| of.room_key(*row)));
        } else {
            let rows = self.rows.plans.get(rows.start..rows.end.min(self.rows.plans.len())).unwrap_or_default();
            self.selected.plans.extend(rows.iter().filter_map(|row| of.plan_key(*row)));
        }
    }

    fn unmark(&mut self, row: usize) {
        let of = &self.rows.of;
        if let Some(key) =
            self.rows.rooms.get(row).filter(|_| self.shows == Shows::Rooms).and_then(|row| of.room_key(*row))
        {
            self.selected.rooms.remove(&key);
        } else if let Some(key) = self.rows.plans.get(row).and_then(|row| of.plan_key(*row)) {
            self.selected.plans.remove(&key);
        }
    }

    /// Shows it another way; what is selected there is of another kind.
    pub(crate) fn show(&mut self, shows: Shows) {
        let is_other_kind = (self.shows == Shows::Rooms) != (shows == Shows::Rooms);
        self.shows = shows;
        if is_other_kind {
            self.selection += 1;
            self.selected = Selected::default();
            (self.cursor, self.anchor) = (0, 0);
        }
    }

    /// Sorts by a column, the other way round if it is sorted by it already.
    pub(crate) fn sort_plans(&mut self, by: PlanColumn) {
        let is_descending = self.plan_order.by == by && !self.plan_order.is_descending;
        self.plan_order = Order { by, is_descending };
    }

    /// The same for rooms.
    pub(crate) fn sort_rooms(&mut self, by: RoomColumn) {
        let is_descending = self.room_order.by == by && !self.room_order.is_descending;
        self.room_order = Order { by, is_descending };
    }

    /// Whether rows are being found, so that those shown are not those that are asked for.
    pub(crate) fn is_behind(&self, revision: u64) -> bool {
        self.answered.as_ref() != Some(&self.question(revision))
    }

    fn question(&self, revision: u64) -> Question {
        Question {
            revision,
            shows: self.shows,
            query: self.query.clone(),
            plans: self.plan_order,
            rooms: self.room_order,
        }
    }

    fn answer(&mut self, question: Question, rows: Rows) {
        // What a person selected is what was seen: of other rows nothing.
        let is_other = self.answered.as_ref().is_none_or(|before| {
            (before.query.clone(), before.shows == Shows::Rooms)
                != (question.query.clone(), question.shows == Shows::Rooms)
        });
        self.rows = rows;
        if is_other {
            self.selection += 1;
            (self.cursor, self.anchor) = (0, 0);
            self.selected = Selected::default();
        }
        let last = self.len().saturating_sub(1);
        (self.cursor, self.anchor) = (self.cursor.min(last), self.anchor.min(last));
        self.answered = Some(question);
    }
}

impl Session {
    /// Finds the rows that are asked for, beside the frames, unless they are there.
    pub(crate) fn find_workspace_rows(&mut self) {
        let Some(OpenWorkspace { now, revision, view, .. }) = &mut self.workspace else { return };
        let question = view.question(*revision);
        let is_asked = match &view.asked {
            // One at a time while plans come in; what a person asks for does not wait.
            Some((asked, _)) => Question { revision: *revision, ..asked.clone() } == question,
            None => false,
        };
        if is_asked || view.answered.as_ref() == Some(&question) {
            return;
        }
        let (of, asked) = (now.clone(), question.clone());
        let kind = Kind::new("find rows of a workspace").newest_of("workspace rows").if_broken(|session| {
            if let Some(workspace) = &mut session.workspace {
                workspace.view.asked = None;
            }
        });
        let job = self.jobs.start_wanted(kind, move |work| {
            let mut rows = Rows { of, ..Rows::default() };
            let Question { shows, query, plans, rooms, .. } = &question;
            let found = match shows {
                Shows::Rooms => query::rooms(&rows.of, query, *rooms, work).map(|found| rows.rooms = found),
                Shows::Plans | Shows::Grid => {
                    query::plans(&rows.of, query, *plans, work).map(|found| rows.plans = found)
                }
            };
            move |session: &mut Session, _: &Context| {
                let Some(workspace) = &mut session.workspace else { return };
                workspace.view.asked = None;
                if found.is_ok() {
                    workspace.view.answer(question, rows);
                }
            }
        });
        if let Some(workspace) = &mut self.workspace {
            workspace.view.asked = Some((asked, job));
        }
    }
}
