//! Questions to the user, the effect of each answer, and what waits for it.

use std::collections::BTreeSet;
use std::path::PathBuf;

use super::Session;
use crate::app::session::document::{Expected, Opened};
use crate::app::session::origin::file_name;
use crate::app::session::picture_change::PictureChange;
use crate::base::wording::count;
use crate::edit::DrawingMoves;
use crate::geometry::Segment;
use crate::plan::{ElementId, Plan};

/// An action that would lose unsaved work.
#[derive(Debug)]
pub(crate) enum Intent {
    /// Show another plan, already read.
    Show(Box<Opened>),
    /// Recover the contents of a journal.
    Recover(PathBuf),
    /// Close the open plan of this number.
    Close(u64),
    /// Close the window. `agreed`: the plans whose unsaved changes are to be given up.
    Quit { agreed: Vec<u64> },
}

impl Intent {
    /// Close the window, after asking about each plan with unsaved changes.
    pub(crate) const QUIT: Self = Self::Quit { agreed: Vec::new() };
}

/// A question that must be answered before anything else.
pub(crate) struct Question {
    /// The question, in a sentence.
    pub(crate) title: String,
    pub(crate) text: String,
    /// What it shows on the plan.
    pub(crate) shown: Shown,
    /// The answers, the main one first.
    answers: Vec<Answer>,
    /// What waits for the answer.
    then: Option<Intent>,
}

/// What a question shows on the plan.
pub(crate) enum Shown {
    Nothing,
    /// Elements that would be removed.
    Gone(BTreeSet<ElementId>),
    /// Places that would change; a point is a segment without length.
    Marks(Vec<Segment>),
}

struct Answer {
    /// Its name in scripts.
    word: &'static str,
    /// The title of its button.
    title: &'static str,
    effect: Effect,
}

/// The effect of an answer; returns whether it did not have to ask for more.
type Effect = Box<dyn FnOnce(&mut Session, Reply) -> bool>;

/// What comes with an answer.
struct Reply {
    word: &'static str,
    /// The file to save in, if a dialog would otherwise ask for it.
    path: Option<PathBuf>,
    /// What was waiting.
    then: Option<Intent>,
}

/// The answer, present in every question, that Escape and a click outside give: nothing is done.
pub(crate) const CANCEL: &str = "cancel";

impl Question {
    fn new(title: impl Into<String>, text: impl Into<String>) -> Self {
        let (title, text) = (title.into(), text.into());
        Self { title, text, shown: Shown::Nothing, answers: Vec::new(), then: None }
    }

    fn answer(
        mut self,
        (word, title): (&'static str, &'static str),
        effect: impl FnOnce(&mut Session, Reply) -> bool + 'static,
    ) -> Self {
        self.answers.push(Answer { word, title, effect: Box::new(effect) });
        self
    }

    /// An answer that needs nothing else.
    fn simply(self, named: (&'static str, &'static str), effect: impl FnOnce(&mut Session) + 'static) -> Self {
        self.answer(named, |session, _| {
            effect(session);
            true
        })
    }

    fn cancel(self) -> Self {
        self.simply((CANCEL, "Cancel"), |_| {})
    }

    /// The answers with their button titles, the main one first.
    pub(crate) fn answers(&self) -> Vec<(&'static str, &'static str)> {
        self.answers.iter().map(|answer| (answer.word, answer.title)).collect()
    }

    /// The plan has unsaved changes: save, discard, or keep working?
    pub(crate) fn unsaved(plan: &str, intent: Intent) -> Self {
        let text = "Save them before the plan is closed, or you will lose them.";
        let asked = Self { then: Some(intent), ..Self::new(format!("Save changes to {plan}?"), text) };
        asked
            .answer(("save", "Save"), |session, reply| {
                if reply.path.is_none() && session.has_own_file() {
                    return session.save(reply.then);
                }
                session.save_by(reply)
            })
            .answer(("discard", "Don't save"), |session, reply| {
                match reply.then {
                    // Given up for good only when every other plan has been asked about.
                    Some(Intent::Quit { mut agreed }) => {
                        agreed.extend(session.document.as_ref().map(|document| document.number));
                        session.request(Intent::Quit { agreed });
                    }
                    then => then.into_iter().for_each(|intent| session.perform(intent)),
                }
                true
            })
            .cancel()
    }

    /// More would be removed than is selected: delete it all?
    pub(crate) fn delete(selected: Vec<ElementId>, gone: BTreeSet<ElementId>) -> Self {
        let title = match selected.as_slice() {
            [one] => format!("Delete the {} and what depends on it?", one.kind()),
            all => format!("Delete {} elements and what depends on them?", all.len()),
        };
        let others = |kind: &str| {
            let is_it = |element: &&ElementId| element.kind() == kind && !selected.contains(element);
            gone.iter().filter(is_it).count()
        };
        let counts = ["room", "wall", "opening"].map(|kind| (others(kind), kind));
        let said: Vec<String> =
            counts.iter().filter(|(number, _)| *number > 0).map(|(number, kind)| count(*number, kind)).collect();
        let text = format!("This also deletes {}, shown in red on the plan.", said.join(", "));
        let asked = Self { shown: Shown::Gone(gone), ..Self::new(title, text) };
        asked.simply(("delete", "Delete"), move |session| session.delete(&selected)).cancel()
    }

    /// A large change is about to be made: do it? `step`: its title in the history.
    pub(crate) fn change(
        title: &str,
        text: String,
        answer: (&'static str, &'static str),
        step: &'static str,
        plan: Plan,
        marks: Vec<Segment>,
    ) -> Self {
        let asked = Self { shown: Shown::Marks(marks), ..Self::new(title, text) };
        asked.simply(answer, move |session| session.edit(step, |_| Ok(plan))).cancel()
    }

    /// The file to be saved has other contents: replace it?
    pub(crate) fn replace(path: PathBuf, is_changed_since: bool, then: Option<Intent>) -> Self {
        let text = match is_changed_since {
            true => {
                "Someone else has changed the file since you opened it. If you overwrite it, their changes are \
                     lost."
            }
            false => "A file with this name exists. If you overwrite it, its contents are lost.",
        };
        Self { then, ..Self::new(format!("Replace {}?", file_name(&path)), text) }
            .answer(("elsewhere", "Save as…"), Session::save_by)
            .answer(("replace", "Replace"), |session, reply| {
                session.save_to(path, Expected::Anything, reply.then);
                true
            })
            .cancel()
    }

    /// Discard a journal left behind by a program?
    pub(crate) fn discard(path: PathBuf, plan: &str) -> Self {
        let text = "They are not saved anywhere, and you cannot get them back.";
        Self::new(format!("Discard the changes to {plan}?"), text)
            .cancel()
            .simply(("discard", "Discard"), move |session| session.discard_leftover(&path))
    }

    /// The backdrop is about to be scaled or rotated: should the drawing follow?
    pub(crate) fn drawing(change: PictureChange) -> Self {
        let title = match change {
            PictureChange::Measurements(_) => "Scale the drawing along with the picture?",
            PictureChange::Turn { .. } => "Turn the drawing along with the picture?",
        };
        let text = "What you traced from the picture should move with it. What already had the right size should stay.";
        let alone = change.clone();
        Self::new(title, text)
            .simply(("along", "Drawing too"), move |session| {
                session.apply_picture_change(&change, DrawingMoves::Along);
            })
            .simply(("stays", "Picture only"), move |session| {
                session.apply_picture_change(&alone, DrawingMoves::Stays);
            })
            .cancel()
    }
}

impl Session {
    /// Asks: nothing else happens until this is answered.
    pub(crate) fn ask(&mut self, question: Question) {
        self.question = Some(question);
    }

    /// Answers the current question. `path`: the file to save in, if one is needed; without it a dialog
    /// asks. Returns whether it did not have to ask.
    pub(crate) fn answer(&mut self, word: &'static str, path: Option<PathBuf>) -> bool {
        let Some(Question { answers, then, .. }) = self.question.take() else { return true };
        match answers.into_iter().find(|answer| answer.word == word) {
            Some(answer) => (answer.effect)(self, Reply { word, path, then }),
            // An unknown answer: nothing is done.
            None => true,
        }
    }

    /// Saves in the file that came with the answer, or asks for one. Returns whether it did not have to
    /// ask.
    fn save_by(&mut self, reply: Reply) -> bool {
        let Reply { word, path, then } = reply;
        match path {
            Some(path) => {
                self.save_in(path, then);
                true
            }
            None => {
                self.ask_where_to_save(then, Some(word));
                false
            }
        }
    }
}
