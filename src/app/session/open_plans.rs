//! Several open plans: one is shown, the others wait, each with its own history, selection and view.

use std::path::Path;

use egui::Context;

use super::Session;
use crate::app::session::document::{Document, Opened};
use crate::app::session::ghost::Ghost;
use crate::app::session::origin::Origin;
use crate::app::session::questions::{Intent, Question};
use crate::app::session::safety::OfPlan;
use crate::app::session::selection::Selection;
use crate::app::session::wishes::Wish;
use crate::geometry::Point;
use crate::store::Draft;

/// The middle of a view, and screen points per metre.
pub(crate) type PlanView = (Point, f64);

/// An open plan that is not shown.
pub(crate) struct Waiting {
    document: Document,
    selection: Selection,
    ghost: Option<Ghost>,
    own: OfPlan,
    /// Where its view was; `None` for all of the plan.
    view: Option<PlanView>,
    /// What was being drawn.
    draft: Option<Draft>,
    /// Whether its journal holds all that it has.
    is_noted: bool,
}

/// A line of the list of open plans.
pub(crate) struct OpenPlan {
    /// Its document's number.
    pub number: u64,
    /// Its title, with a number behind it where several have the same.
    pub title: String,
    pub is_changed: bool,
    pub is_shown: bool,
}

impl Waiting {
    pub(super) fn document(&self) -> &Document {
        &self.document
    }
}

impl Session {
    /// All open plans, to change what is known of them.
    pub(super) fn documents_mut(&mut self) -> impl Iterator<Item = &mut Document> {
        self.waiting_plans.iter_mut().map(|waiting| &mut waiting.document).chain(&mut self.document)
    }

    pub(super) fn documents(&self) -> impl Iterator<Item = &Document> {
        self.waiting_plans.iter().map(|waiting| &waiting.document).chain(&self.document)
    }

    /// The open plans in the order in which they were opened.
    pub(crate) fn open_plans(&self) -> Vec<OpenPlan> {
        let mut documents: Vec<&Document> = self.documents().collect();
        documents.sort_by_key(|document| document.number);
        let shown = self.document.as_ref().map(|document| document.number);
        let mut listed: Vec<(String, OpenPlan)> = Vec::new();
        for document in documents {
            let title = document.title();
            let same = listed.iter().filter(|(other, _)| *other == title).count();
            let told = if same == 0 { title.clone() } else { format!("{title} {}", same + 1) };
            let (number, is_changed) = (document.number, document.is_changed());
            listed.push((title, OpenPlan { number, title: told, is_changed, is_shown: shown == Some(number) }));
        }
        listed.into_iter().map(|(_, plan)| plan).collect()
    }

    /// Where an open plan lies.
    pub(crate) fn origin_of_open(&self, number: u64) -> Option<&Origin> {
        self.documents().find(|document| document.number == number).map(|document| &document.origin)
    }

    pub(crate) fn is_open(&self, number: u64) -> bool {
        self.documents().any(|document| document.number == number)
    }

    /// Whether more than one plan is open.
    pub(crate) fn has_several_open(&self) -> bool {
        self.documents().nth(1).is_some()
    }

    /// The open plan of an origin.
    pub(crate) fn open_of(&self, origin: &Origin) -> Option<u64> {
        self.documents().find(|document| document.origin.is_same(origin)).map(|document| document.number)
    }

    /// Shows another open plan.
    pub(crate) fn show_open(&mut self, number: u64) {
        let is_shown = self.document.as_ref().is_some_and(|document| document.number == number);
        if is_shown || !self.is_open(number) {
            return;
        }
        self.put_aside();
        let Some(view) = self.bring_back(number) else { return };
        self.safety.own.is_shown_again();
        self.wishes.push(Wish::ForgetPlan);
        if let Some((centre, px_per_m)) = view {
            self.wishes.push(Wish::LookAt { centre, px_per_m });
        }
        self.wishes.extend(self.draft.clone().map(Wish::Resume));
        self.status.clear();
        let folder = self.document.as_ref().and_then(|document| document.origin.folder()).map(Path::to_owned);
        if let Some((folder, depth)) = folder.map(|folder| self.list.listed_for(folder)) {
            self.list_folder(folder, depth);
        }
    }

    /// Records that the plan shown is, by its title: elsewhere others may be open.
    pub(crate) fn note_shown(&mut self) {
        let shown = self.open_plans().into_iter().find(|plan| plan.is_shown);
        self.note_executed("show-plan", shown.map(|plan| plan.title).into_iter().collect());
    }

    /// Shows the plan some places after this one, the first after the last.
    pub(crate) fn show_next_open(&mut self, step: isize) {
        let plans = self.open_plans();
        let Some(at) = plans.iter().position(|plan| plan.is_shown) else { return };
        let next = (at as isize + step).rem_euclid(plans.len() as isize) as usize;
        if let Some(plan) = plans.get(next) {
            self.show_open(plan.number);
            self.note_shown();
        }
    }

    /// Puts the plan shown aside, as it is.
    pub(super) fn put_aside(&mut self) {
        self.commit_field();
        let Some(mut document) = self.document.take() else { return };
        document.rests();
        self.waiting_plans.push(Waiting {
            document,
            selection: std::mem::take(&mut self.selection),
            ghost: self.ghost.take(),
            own: std::mem::take(&mut self.safety.own),
            view: self.view.take(),
            draft: self.draft.take(),
            is_noted: false,
        });
    }

    /// Makes a plan that waits the one shown, where none is. Gives its view.
    fn bring_back(&mut self, number: u64) -> Option<Option<PlanView>> {
        let index = self.waiting_plans.iter().position(|waiting| waiting.document.number == number)?;
        let waiting = self.waiting_plans.remove(index);
        self.document = Some(waiting.document);
        self.selection = waiting.selection;
        self.ghost = waiting.ghost;
        self.safety.own = waiting.own;
        self.view = waiting.view;
        self.draft = waiting.draft;
        (self.fresh, self.nudged) = (None, None);
        Some(waiting.view)
    }

    /// Does something to an open plan as if it were shown. Returns nothing if it is not open any more.
    pub(super) fn in_plan<T>(&mut self, number: u64, act: impl FnOnce(&mut Self) -> T) -> Option<T> {
        let shown = self.document.as_ref().map(|document| document.number);
        if shown == Some(number) {
            return Some(act(self));
        }
        if !self.is_open(number) {
            return None;
        }
        let field = self.field.take();
        self.put_aside();
        self.bring_back(number)?;
        let done = act(self);
        self.put_aside();
        if let Some(shown) = shown {
            self.bring_back(shown);
        }
        self.field = field;
        Some(done)
    }

    /// Keeps the journals of the plans that wait.
    pub(super) fn keep_waiting_journals(&mut self, context: &Context) {
        while let Some(waiting) = self.waiting_plans.iter_mut().find(|waiting| !waiting.is_noted) {
            waiting.is_noted = true;
            let number = waiting.document.number;
            self.in_plan(number, |session| session.keep_own_journal(context));
            // It was put aside anew.
            if let Some(waiting) = self.waiting_plans.iter_mut().find(|waiting| waiting.document.number == number) {
                waiting.is_noted = true;
            }
        }
    }

    // Leaving.

    /// Makes room for another plan: this one waits, unless nothing was done to it and it is in no file.
    pub(super) fn make_room(&mut self) {
        let is_blank = self.document.as_ref().is_some_and(|document| {
            document.origin == Origin::Untitled && document.history.steps().len() == 1 && !document.is_changed()
        });
        if is_blank {
            self.drop_shown();
        } else {
            self.put_aside();
        }
    }

    /// Ends the plan shown: its changes are saved, or given up.
    fn drop_shown(&mut self) {
        self.end_journal();
        let number = self.document.as_ref().map(|document| document.number);
        self.messages.retain(|message| message.plan.is_none() || message.plan != number);
        self.document = None;
        self.selection = Selection::default();
        self.ghost = None;
        self.view = None;
        self.draft = None;
    }

    /// Closes the plan shown, and shows the one after it, or before it.
    pub(super) fn close_shown(&mut self, number: u64) {
        if self.document.as_ref().is_none_or(|document| document.number != number) {
            return;
        }
        self.remember_view();
        self.drop_shown();
        self.wishes.push(Wish::ForgetDrawing);
        let numbers: Vec<u64> = self.open_plans().iter().map(|plan| plan.number).collect();
        let next = numbers.iter().find(|&&other| other > number).or(numbers.last());
        if let Some(&next) = next {
            self.show_open(next);
        }
    }

    /// Closes an open plan, after asking if that would lose unsaved work.
    pub(crate) fn close_plan(&mut self, number: u64) {
        self.commit_field();
        let is_shown = self.document.as_ref().is_some_and(|document| document.number == number);
        let waits_unchanged = |waiting: &Waiting| waiting.document.number == number && !waiting.document.is_changed();
        if !is_shown && let Some(index) = self.waiting_plans.iter().position(waits_unchanged) {
            let waiting = self.waiting_plans.remove(index);
            self.remember_view_of(&waiting.document.origin, waiting.view);
            self.keep_settings();
            waiting.own.end();
            return;
        }
        self.request(Intent::Close(number));
    }

    /// Asks about the next plan with unsaved changes before the window closes; without one, says that it can.
    /// `agreed`: those whose changes are to be given up.
    pub(super) fn can_quit(&mut self, agreed: &[u64]) -> bool {
        let is_to_ask = |plan: &OpenPlan| plan.is_changed && !agreed.contains(&plan.number);
        let Some(plan) = self.open_plans().into_iter().find(is_to_ask) else { return true };
        self.show_open(plan.number);
        self.ask(Question::unsaved(&plan.title, Intent::Quit { agreed: agreed.to_vec() }));
        false
    }

    /// Ends all journals: everything is saved, or given up. Where each plan was looked at is remembered.
    pub(super) fn end_journals(&mut self) {
        self.end_journal();
        for waiting in std::mem::take(&mut self.waiting_plans) {
            self.remember_view_of(&waiting.document.origin, waiting.view);
            waiting.own.end();
        }
        self.keep_settings();
    }

    /// Closes a plan that waits and was never changed; says nothing of it.
    pub(super) fn close_untouched(&mut self, number: u64) {
        let is_untouched = |waiting: &Waiting| {
            waiting.document.number == number
                && waiting.document.history.steps().len() == 1
                && !waiting.document.is_changed()
        };
        if let Some(index) = self.waiting_plans.iter().position(is_untouched) {
            self.waiting_plans.remove(index).own.end();
        }
    }

    /// Closes a plan that was only looked at, now that another is shown.
    pub(super) fn close_looked_at(&mut self, looked_at: Option<u64>) {
        let Some(number) = looked_at else { return };
        let is_untouched = |waiting: &Waiting| {
            waiting.document.number == number
                && waiting.document.history.steps().len() == 1
                && !waiting.document.is_changed()
        };
        let Some(index) = self.waiting_plans.iter().position(is_untouched) else { return };
        let titles = self.open_plans();
        let title = titles.into_iter().find(|plan| plan.number == number).map(|plan| plan.title).unwrap_or_default();
        self.waiting_plans.remove(index).own.end();
        self.note_executed("close", vec![title]);
    }

    /// Shows a plan that was read, or the open one of the same origin.
    pub(super) fn show_read(&mut self, opened: Opened) {
        match self.open_of(&opened.origin) {
            Some(number) => {
                self.show_open(number);
                if let Some(folder) = opened.listed {
                    self.list_folder(folder, crate::app::session::plan_list::Depth::All);
                }
            }
            None => self.show(opened),
        }
    }
}
