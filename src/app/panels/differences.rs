//! The differences between the open plan and its file, changed by somebody else: both drawn side by side,
//! with what each side changed since they were the same.

use crate::app::state::dialogs;
use crate::app::value::{Call, Value};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use egui::{Id, Label, Modal, RichText, ScrollArea, Ui, vec2};

use super::plan_picture::{MarkKind, PlanPicture, legend};
use crate::app::look::{
    theme,
    widgets::{caption, colours, dialog_frame, right, section, strong, text_button},
};
use crate::app::session::document::Derived;
use crate::app::state::App;
use crate::app::state::{After, Dialog, Entry};
use crate::plan::{ChangeKind, Difference, ElementId, Plan, titles::title_of};

/// The most lines shown; the number of the rest is stated.
const MOST_LINES: usize = 200;

/// What is shown, cached while neither side changes.
pub(crate) struct Shown {
    mine: (Plan, Arc<Derived>),
    theirs: Plan,
    pictures: [PlanPicture; 2],
    lines: [Vec<(MarkKind, String)>; 2],
}

impl Shown {
    fn new(base: &Plan, mine: (Plan, Arc<Derived>), theirs: (&Plan, &Arc<Derived>)) -> Self {
        let sides = [&mine.0, theirs.0].map(|plan| {
            let difference = Difference::between(base, plan);
            (difference.seen(base, plan), difference)
        });
        let both: BTreeSet<ElementId> =
            sides[0].0.keys().filter(|element| sides[1].0.contains_key(element)).copied().collect();
        let pictures = [
            PlanPicture::new(base, &mine.0, mine.1.clone(), &both),
            PlanPicture::new(base, theirs.0, theirs.1.clone(), &both),
        ];
        let lines = [(&mine.0, &sides[0]), (theirs.0, &sides[1])]
            .map(|(plan, (seen, difference))| lines_of(base, plan, seen, difference, &both));
        let theirs = theirs.0.clone();
        Self { mine, theirs, pictures, lines }
    }

    fn is_of(&self, mine: &Plan, theirs: &Plan) -> bool {
        self.mine.0.is_same_value(mine) && self.theirs.is_same_value(theirs)
    }
}

/// What one side changed, one line each.
fn lines_of(
    base: &Plan,
    plan: &Plan,
    seen: &BTreeMap<ElementId, ChangeKind>,
    difference: &Difference,
    both: &BTreeSet<ElementId>,
) -> Vec<(MarkKind, String)> {
    let parts = [
        (difference.meta, "Plan details"),
        (difference.backdrop, "The picture under the plan"),
        (difference.guides, "The guide lines"),
        (difference.extra, "Fields of another version"),
    ];
    let parts = parts.into_iter().filter(|(differs, _)| *differs);
    let mut lines: Vec<(MarkKind, String)> = parts.map(|(_, text)| (MarkKind::Changed, text.to_owned())).collect();
    // Changes on both sides first: there the user has to choose.
    let mut elements: Vec<(bool, &ElementId, &ChangeKind)> =
        seen.iter().map(|(element, kind)| (!both.contains(element), element, kind)).collect();
    elements.sort();
    lines.extend(elements.into_iter().map(|(_, &element, &kind)| {
        let (of, mark) = match kind {
            ChangeKind::Added => (plan, MarkKind::Added),
            ChangeKind::Changed => (plan, MarkKind::Changed),
            ChangeKind::Removed => (base, MarkKind::Removed),
        };
        let mark = if both.contains(&element) { MarkKind::Both } else { mark };
        (mark, format!("{} {}", title_of(of, element), kind.name()))
    }));
    counted(lines)
}

/// The same lines, with consecutive identical ones merged and counted.
fn counted(lines: Vec<(MarkKind, String)>) -> Vec<(MarkKind, String)> {
    let of_one = |same: &[(MarkKind, String)]| match same {
        [(mark, text)] => (*mark, text.clone()),
        _ => (same[0].0, format!("{} ({})", same[0].1, same.len())),
    };
    lines.chunk_by(|p, q| p == q).map(of_one).collect()
}

pub(super) const ENTRY: Entry = Entry { id: ID, make: |_, _| Box::new(Differences::default()), is_of_plan: true };

pub(crate) const ID: &str = dialogs::DIFFERENCES;

#[derive(Default)]
struct Differences {
    shown: Option<Shown>,
}

impl Dialog for Differences {
    fn show(&mut self, app: &mut App, ui: &mut Ui) -> After {
        self.show_in(app, ui);
        After::Stay
    }
}

impl Differences {
    /// The button, and other ways to close it, run the command, so that this is recorded.
    fn show_in(&mut self, app: &mut App, ui: &Ui) {
        let Some((theirs, document)) = app.session.their_plan().zip(app.session.document.as_ref()) else { return };
        let Some(derived) = document.derived().cloned() else { return };
        let mine = document.plan().clone();
        if !self.shown.as_ref().is_some_and(|shown| shown.is_of(&mine, theirs.0)) {
            let base = document.saved().cloned().unwrap_or_default();
            let new = Shown::new(&base, (mine, derived), theirs);
            self.shown = Some(new);
        }
        let file = document.origin.title();
        let Some(shown) = &mut self.shown else { return };
        let response = Modal::new(Id::unique("differences")).frame(dialog_frame(ui)).show(ui.ctx(), |ui| {
            let window = ui.ctx().content_rect().size();
            let width = 980.0_f32.min(window.x - 80.0);
            ui.set_width(width);
            ui.label(strong(format!("{file}: here and in the file"), theme::TITLE));
            let text = "What each side has changed.";
            ui.add(Label::new(RichText::new(text).color(colours(ui).text_weak)).wrap());
            ui.add_space(10.0);
            let gap = 16.0;
            let side = (width - gap) / 2.0;
            let list_height = (window.y * 0.18).clamp(60.0, 150.0);
            let picture = vec2(side, (side * 0.66).min(window.y - list_height - 300.0).max(120.0));
            ui.horizontal_top(|ui| {
                ui.spacing_mut().item_spacing.x = gap;
                for (index, title) in ["Yours, not saved", "In the file"].into_iter().enumerate() {
                    ui.vertical(|ui| {
                        ui.set_width(side);
                        section(ui, title);
                        ui.add_space(4.0);
                        shown.pictures[index].show(ui, picture, title);
                        ui.add_space(6.0);
                        ScrollArea::vertical()
                            .id_salt(index)
                            .max_height(list_height)
                            .min_scrolled_height(list_height)
                            .auto_shrink(false)
                            .show(ui, |ui| {
                                list(ui, &shown.lines[index]);
                            });
                    });
                }
            });
            ui.add_space(12.0);
            let mut act = None;
            ui.horizontal(|ui| {
                let kinds = MarkKind::ALL.into_iter();
                let used =
                    |kind: &MarkKind| shown.pictures.iter().any(|picture| picture.kinds().any(|used| used == *kind));
                legend(ui, kinds.filter(used));
                right(ui, |ui| {
                    let close = text_button(ui, "Close", false).clicked().then(closed);
                    let hint = "Saving then overwrites what someone else saved";
                    let keep = text_button(ui, "Keep mine", false).on_hover_text(hint).clicked();
                    let hint = "You can undo it";
                    let load = text_button(ui, "Load the file", true).on_hover_text(hint).clicked();
                    act = close
                        .or(keep.then(|| Call::new("keep-mine", [])))
                        .or(load.then(|| Call::new("load-theirs", [])));
                });
            });
            act
        });
        let is_closed = response.should_close();
        match response.inner.or(is_closed.then(closed)) {
            None => {}
            Some(call) => app.act_on(call, ui.ctx()),
        }
    }
}

fn list(ui: &mut Ui, lines: &[(MarkKind, String)]) {
    ui.spacing_mut().item_spacing.y = 2.0;
    if lines.is_empty() {
        caption(ui, "Nothing changed");
    }
    for (kind, text) in lines.iter().take(MOST_LINES) {
        let colour = if *kind == MarkKind::Both { colours(ui).error } else { colours(ui).text };
        let text = if *kind == MarkKind::Both { format!("{text}, on both sides") } else { text.clone() };
        ui.add(Label::new(RichText::new(text).size(theme::SMALL).color(colour)).wrap());
    }
    if lines.len() > MOST_LINES {
        caption(ui, format!("and {} more", lines.len() - MOST_LINES));
    }
}

/// The call that closes the dialog: a command, so that it is recorded.
fn closed() -> Call {
    Call::new("differences", [Value::Switch(false)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::{Builder, Room};

    #[test]
    fn summaries_read_well() {
        let mut builder = Builder::default();
        let rooms = ["a", "b"].map(|key| ElementId::Room(builder.room(key, Room::default())));
        let seen = |rooms: &[ElementId]| rooms.iter().map(|&room| (room, ChangeKind::Added)).collect();
        let difference = |meta| Difference { meta, elements: seen(&rooms), ..Difference::default() };
        assert_eq!(difference(false).in_words(&seen(&rooms)), "2 rooms differ");
        assert_eq!(difference(false).in_words(&seen(&rooms[..1])), "1 room differs");
        assert_eq!(difference(true).in_words(&seen(&rooms)), "2 rooms and what is known of the plan differ");
        let meta = Difference { meta: true, ..Difference::default() };
        assert_eq!(meta.in_words(&BTreeMap::new()), "what is known of the plan differs");
        assert_eq!(Difference::default().in_words(&BTreeMap::new()), "nothing differs");
    }
}
