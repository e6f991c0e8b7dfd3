//! Unsaved work of a program that crashed: a picture of each plan, and what to do with it.

use crate::app::state::dialogs;
use crate::app::value::{Call, Value};
use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;
use std::time::SystemTime;

use egui::{Id, Label, Modal, RichText, ScrollArea, Ui, vec2};

use super::plan_picture::{MarkKind, PlanPicture, legend};
use crate::app::look::{
    theme,
    widgets::{caption, colours, dialog_frame, right, strong, text_button},
};
use crate::app::session::recovery::Offered;
use crate::app::state::App;
use crate::app::state::{After, Dialog, Entry};
use crate::base::wording::count;
use crate::geometry::Point;

/// Size of a thumbnail, in points.
const PICTURE: egui::Vec2 = vec2(300.0, 190.0);

#[derive(Clone, Copy)]
enum Act {
    Recover(usize),
    Discard(usize),
    Later,
}

pub(super) const ENTRY: Entry = Entry { id: ID, make: |_, _| Box::new(Recovery::default()), is_of_plan: false };

pub(crate) const ID: &str = dialogs::RECOVERY;

#[derive(Default)]
struct Recovery {
    /// Thumbnails of what would be recovered, with changes marked, by journal.
    pictures: BTreeMap<PathBuf, PlanPicture>,
}

impl Dialog for Recovery {
    fn show(&mut self, app: &mut App, ui: &mut Ui) -> After {
        if !app.session.safety.leftovers.is_empty() {
            self.draw(&app.session.safety.leftovers);
            show(&mut self.pictures, app, ui);
        }
        After::Stay
    }
}

impl Recovery {
    /// Draws the new ones.
    fn draw(&mut self, leftovers: &[Offered]) {
        for Offered { leftover, derived } in leftovers {
            if let (Ok(recovered), Some(derived)) = (&leftover.content, derived)
                && !self.pictures.contains_key(&leftover.path)
            {
                let (base, plan) = (recovered.base(), recovered.history.plan());
                let draft = recovered.draft.iter().flat_map(|draft| &draft.points);
                let draft: Vec<Point> = draft.map(|&[x, y]| Point::new(x, y)).collect();
                let picture = PlanPicture::new(base, plan, derived.clone(), &BTreeSet::new()).with_draft(&draft);
                self.pictures.insert(leftover.path.clone(), picture);
            }
        }
    }
}

/// The button, and other ways to close it, run the command, so that this is recorded.
fn show(pictures: &mut BTreeMap<PathBuf, PlanPicture>, app: &mut App, ui: &Ui) {
    let leftovers = std::mem::take(&mut app.session.safety.leftovers);
    let now = app.session.safety.clock.map(|clock| clock());
    let response = Modal::new(Id::unique("recovery")).frame(dialog_frame(ui)).show(ui.ctx(), |ui| {
        ui.set_width(680.0_f32.min(ui.ctx().content_rect().width() - 80.0).max(0.0));
        ui.label(strong("Recover unsaved work", theme::TITLE));
        let text = "Enfilade closed before these changes were saved. Recover opens them as they were; your files do \
                    not change until you save.";
        ui.add(Label::new(RichText::new(text).color(colours(ui).text_weak)).wrap());
        ui.add_space(10.0);
        let mut act = None;
        let height = (ui.ctx().content_rect().height() - 260.0).clamp(120.0, 620.0);
        ScrollArea::vertical().max_height(height).auto_shrink([false, true]).show(ui, |ui| {
            for (index, offered) in leftovers.iter().enumerate() {
                if index > 0 {
                    ui.add_space(14.0);
                }
                let picture = pictures.get_mut(&offered.leftover.path);
                act = ui.push_id(index, |ui| one(app, ui, index + 1, offered, picture, now)).inner.or(act.take());
            }
        });
        ui.add_space(12.0);
        ui.horizontal(|ui| {
            let all = MarkKind::ALL.into_iter();
            let used = |kind: &MarkKind| {
                leftovers
                    .iter()
                    .filter_map(|offered| pictures.get(&offered.leftover.path))
                    .any(|picture| picture.kinds().any(|k| k == *kind))
            };
            legend(ui, all.filter(used));
            right(ui, |ui| {
                let hint = "You can recover them later from the File menu, and when Enfilade starts";
                if text_button(ui, "Later", false).on_hover_text(hint).clicked() {
                    act = Some(Act::Later);
                }
            });
        });
        act
    });
    app.session.safety.leftovers = leftovers;
    match response.inner.or(response.should_close().then_some(Act::Later)) {
        None => {}
        Some(Act::Recover(number)) => app.act_on(Call::new("recover", [Value::Count(number)]), ui.ctx()),
        Some(Act::Discard(number)) => {
            app.act_on(Call::new("discard-recovered", [Value::Count(number)]), ui.ctx());
        }
        Some(Act::Later) => app.act_on(Call::new("recovery", [Value::Switch(false)]), ui.ctx()),
    }
}

fn one(
    app: &App,
    ui: &mut Ui,
    number: usize,
    offered: &Offered,
    picture: Option<&mut PlanPicture>,
    now: Option<SystemTime>,
) -> Option<Act> {
    let title = offered.title();
    let mut act = None;
    ui.horizontal_top(|ui| {
        ui.spacing_mut().item_spacing.x = 18.0;
        match picture {
            Some(picture) => picture.show(ui, PICTURE, &format!("Unsaved work on {title}")),
            None => {
                ui.allocate_space(vec2(PICTURE.x, 90.0));
            }
        }
        ui.vertical(|ui| {
            ui.add_space(4.0);
            ui.add(Label::new(strong(&title, theme::BODY)).wrap());
            match &offered.leftover.content {
                Err(what) => {
                    let text = RichText::new(format!("Cannot be read: {what}.")).color(colours(ui).error);
                    ui.add(Label::new(text).wrap());
                    caption(ui, app.session.shown_path(&offered.leftover.path));
                }
                Ok(recovered) => {
                    let file = recovered.start.file.as_deref();
                    let place = file.map_or("Never saved".to_owned(), |path| app.session.shown_path(path));
                    ui.add(Label::new(RichText::new(place).size(theme::SMALL).color(colours(ui).text_weak)).wrap());
                    ui.add_space(4.0);
                    let changes = match (recovered.history.position(), &recovered.draft) {
                        (0, Some(_)) => "An unfinished drawing".to_owned(),
                        (number, _) => count(number.max(1), "change"),
                    };
                    let age = now.zip(offered.leftover.modified).and_then(|(now, then)| age(now, then));
                    ui.label(age.map_or(changes.clone(), |age| format!("{changes}, {age}")));
                    let position = recovered.history.position();
                    if let Some(step) = recovered.history.steps().get(position).filter(|_| position > 0) {
                        caption(ui, format!("Last change: {}", step.title));
                    }
                    if recovered.draft.is_some() && position > 0 {
                        caption(ui, "The unfinished drawing is there too.");
                    }
                    if recovered.unsound.is_some() {
                        caption(ui, "One change is damaged; it and the changes after it are left out.");
                    } else if recovered.is_cut {
                        caption(ui, "The last change was cut off and is left out.");
                    }
                }
            }
            ui.add_space(10.0);
            ui.horizontal(|ui| {
                ui.spacing_mut().item_spacing.x = 8.0;
                if offered.leftover.content.is_ok() && text_button(ui, "Recover", true).clicked() {
                    act = Some(Act::Recover(number));
                }
                if text_button(ui, "Discard…", false).clicked() {
                    act = Some(Act::Discard(number));
                }
            });
        });
    });
    act
}

/// How long ago something was, in words; `None` if the clock went backwards.
fn age(now: SystemTime, then: SystemTime) -> Option<String> {
    let minutes = now.duration_since(then).ok()?.as_secs() / 60;
    Some(match minutes {
        0 => "just now".to_owned(),
        1..60 => format!("{} ago", count(minutes as usize, "minute")),
        60..1440 => format!("{} ago", count(minutes as usize / 60, "hour")),
        _ => format!("{} ago", count(minutes as usize / 1440, "day")),
    })
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    #[test]
    fn ages_read_well() {
        let then = SystemTime::UNIX_EPOCH;
        let at = |secs: u64| age(then + Duration::from_secs(secs), then);
        assert_eq!(at(59).as_deref(), Some("just now"));
        assert_eq!(at(60).as_deref(), Some("1 minute ago"));
        assert_eq!(at(7200).as_deref(), Some("2 hours ago"));
        assert_eq!(at(100_000).as_deref(), Some("1 day ago"));
        assert_eq!(age(then, then + Duration::from_secs(1)), None);
    }
}
