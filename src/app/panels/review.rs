//! The review: why the room in the view is worth a look, what classifiers say of it, and what to decide. All by keys: see the
//! buttons.

use egui::{Id, Key, Label, Margin, Rect, RichText, Role, ScrollArea, Sense, TextEdit, Ui, WidgetInfo, vec2};

use crate::app::commands;
use crate::app::look::{
    theme,
    widgets::{caption, colours, link, progress_bar, right, section, strong, text_button},
};
use crate::app::panels::prediction::bar;
use crate::app::session::review::{Progress, READING_SHARE, Shown};
use crate::app::state::{App, Height, Side, SidePanel, panels};
use crate::app::value::{Call, Value};
use crate::base::wording::{count, percent_done, sentence, shortened, unbroken};
use crate::labels::Label as RoomLabel;
use crate::plan::titles::printable;
use crate::review::{Entry, Reason};

/// Height in points: the initial one, and the minimum.
const USUAL_HEIGHT: f32 = 400.0;
const LEAST_HEIGHT: f32 = 200.0;

pub(super) const PANEL: SidePanel = SidePanel {
    id: panels::REVIEW,
    title: "Review",
    help: "The rooms whose labels are most worth a look, one after the other",
    side: Side::Right,
    height: Height::Dragged { usual: USUAL_HEIGHT, least: LEAST_HEIGHT },
    is_shown_at_first: false,
    needs_plan: false,
    has_own_command: false,
    show,
};

/// What the panel keeps between frames: the note being written, and of which room.
#[derive(Clone, Default)]
struct Note {
    of: String,
    text: String,
    kept: String,
}

fn show(app: &mut App, ui: &mut Ui) {
    let margin = Margin { left: 16, right: 16, top: 10, bottom: 8 };
    let mut asked: Option<Call> = None;
    egui::Frame::new().inner_margin(margin).show(ui, |ui| {
        let progress = app.session.review_progress();
        ui.horizontal(|ui| {
            section(ui, if app.session.review.is_comparison() { "Differences" } else { "Review" });
            right(ui, |ui| {
                if progress.rooms > 0 {
                    caption(ui, format!("{} of {} decided", progress.decided(), progress.rooms))
                        .on_hover_text(app.session.review_in_words());
                }
            });
        });
        if progress.rooms > 0 {
            bar_of(ui, progress);
        }
        ui.add_space(4.0);
        asked = match app.session.review_shown() {
            Shown::Idle => idle(ui, app),
            Shown::Making(share) => making(ui, app, share),
            Shown::Failed(why) => failed(ui, app, why),
            Shown::Finished => finished(ui, app, progress),
            Shown::Room(entry) => {
                let entry = entry.clone();
                room(ui, app, &entry)
            }
        };
        // As high as with a room, or the panel would shrink and stay so.
        ui.take_available_space();
    });
    if let Some(call) = asked {
        app.act_on(call, ui.ctx());
    }
}

/// Text in the usual size that wraps.
fn text(ui: &mut Ui, text: impl Into<String>) {
    let colour = colours(ui).text;
    ui.add(Label::new(RichText::new(unbroken(&text.into())).color(colour)).wrap());
}

/// How far the review is: accepted and corrected rooms of all.
fn bar_of(ui: &mut Ui, progress: Progress) {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), 8.0), Sense::hover());
    let track = rect.shrink2(vec2(0.0, 2.0));
    let colours = colours(ui);
    let share = progress.decided() as f32 / progress.rooms.max(1) as f32;
    ui.painter().rect_filled(track, 2.0, colours.field);
    let width = if progress.decided() > 0 { (track.width() * share).max(4.0) } else { 0.0 };
    ui.painter().rect_filled(Rect::from_min_size(track.min, vec2(width, track.height())), 2.0, colours.accent);
    let name = format!("{} of {} rooms decided", progress.decided(), progress.rooms);
    response.widget_info(|| WidgetInfo::labeled(Role::ProgressIndicator, true, &name));
}

fn idle(ui: &mut Ui, app: &App) -> Option<Call> {
    text(ui, "Goes through the rooms of all plans in the open folder, those first whose labels are most likely wrong.");
    ui.add_space(6.0);
    if !app.session.can_review() {
        caption(ui, "Open a folder with labelled plans first.");
        return None;
    }
    text_button(ui, "Review the labels", true).clicked().then(|| Call::new("review-labels", []))
}

fn making(ui: &mut Ui, app: &App, share: f64) -> Option<Call> {
    let is_comparison = app.session.review.is_comparison();
    let said = match is_comparison || share < READING_SHARE {
        true => "Reading the plans",
        false => "Judging the rooms",
    };
    ui.horizontal(|ui| {
        ui.label(said);
        right(ui, |ui| drop(caption(ui, percent_done(share))));
    });
    progress_bar(ui, share, &format!("{said}: {}", percent_done(share)));
    let help = if is_comparison {
        "Rooms that the other person labelled otherwise come one after the other. You can go on working."
    } else {
        "Classifiers learn from some buildings and judge the others, in turn. You can go on working."
    };
    caption(ui, help);
    ui.add_space(6.0);
    text_button(ui, "Stop", false).clicked().then(|| Call::new("review-stop", []))
}

fn failed(ui: &mut Ui, app: &App, why: &str) -> Option<Call> {
    text(ui, format!("There is nothing to review: {why}."));
    ui.add_space(6.0);
    let again = app.session.can_review() && text_button(ui, "Try again", false).clicked();
    again.then(|| Call::new("review-labels", []))
}

fn finished(ui: &mut Ui, app: &App, progress: Progress) -> Option<Call> {
    if progress.rooms == 0 {
        text(ui, app.session.review.notes().first().map_or("No room has a label.", String::as_str));
        return None;
    }
    text(
        ui,
        format!("All rooms are decided: {} kept, {} corrected.", count(progress.accepted, "label"), progress.corrected),
    );
    caption(ui, "Plans with corrections stay open until you save them.");
    ui.add_space(6.0);
    let back = app.session.review.can_go_back() && button(ui, app, "Back", "review-back", false);
    back.then(|| Call::new("review-back", []))
}

/// A button with the keys of its command behind its title.
fn button(ui: &mut Ui, app: &App, title: &str, id: &'static str, is_main: bool) -> bool {
    let keys = app.session.settings.keys_of(id).first().map(|keys| keys.text(ui.ctx())).unwrap_or_default();
    let help = commands::find(id).map(|command| command.help).unwrap_or_default();
    let response = text_button(ui, &format!("{title}  {keys}"), is_main);
    response.on_hover_text(help).clicked()
}

fn room(ui: &mut Ui, app: &mut App, entry: &Entry) -> Option<Call> {
    let mut asked = None;
    let row = &entry.row;
    let now = app.session.reviewed_label();
    let name = if row.room.is_empty() { row.id.clone() } else { shortened(&printable(&row.room), 40) };
    ui.add(Label::new(strong(name, theme::TITLE)).truncate());
    let plan = if row.plan.is_empty() { &row.file } else { &row.plan };
    let function = if row.function.is_empty() { "no function".to_owned() } else { printable(&row.function) };
    ui.add(
        Label::new(RichText::new(format!("{function} in {}", printable(plan))).color(colours(ui).text_weak)).truncate(),
    );
    ui.add_space(6.0);
    // What to decide first, so that it is seen however long the reasons are.
    let other = entry.other();
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing = vec2(6.0, 6.0);
        let right_title = match now {
            Some(label) if label != row.label => format!("Keep {label}"),
            _ => format!("{} is right", sentence(row.label.name())),
        };
        if button(ui, app, &right_title, "review-accept", true) {
            asked = Some(Call::new("review-accept", []));
        }
        if now == Some(row.label)
            && other != row.label
            && button(ui, app, &sentence(other.name()), "review-correct", false)
        {
            asked = Some(Call::new("review-correct", []));
        }
        if button(ui, app, "Skip", "review-skip", false) {
            asked = Some(Call::new("review-skip", []));
        }
        if app.session.review.can_go_back() && button(ui, app, "Back", "review-back", false) {
            asked = Some(Call::new("review-back", []));
        }
    });
    caption(ui, "Another label: 1 to 5. Another function: F4. Then keep it.");
    ui.add_space(4.0);
    // Above the reasons, which may be long: it is never scrolled out of sight.
    asked = note(ui, app, entry).or(asked.take());
    ui.add_space(6.0);
    ScrollArea::vertical().id_salt("review").auto_shrink(false).show(ui, |ui| {
        if !app.session.review.is_comparison() {
            let palette = app.session.palette(ui);
            ui.spacing_mut().item_spacing.y = 0.0;
            for label in RoomLabel::ALL {
                bar(ui, palette, label, entry.said.probability(label), label == row.label);
            }
            ui.spacing_mut().item_spacing.y = 4.0;
            caption(ui, format!("Bold: the label given. {}", by_whom(entry)));
            ui.add_space(4.0);
        }
        section(ui, "Why it is here");
        for reason in &entry.reasons {
            // A sentence a line, so that a long reason is read at a glance.
            for sentence in reason.words().split_inclusive(". ") {
                text(ui, sentence.trim_end().to_owned());
                ui.add_space(4.0);
            }
        }
        if entry.reasons.is_empty() {
            text(ui, "Nothing speaks against its label; it comes late in the queue.");
        }
        for note in app.session.review.notes() {
            caption(ui, note.as_str());
        }
    });
    asked
}

fn by_whom(entry: &Entry) -> &'static str {
    let is_unlikely = entry.reasons.iter().any(|reason| matches!(reason, Reason::Unlikely { .. }));
    if is_unlikely { "The bars: what is said without this room." } else { "The bars agree with it." }
}

/// The field for a note about the room; what was written is kept when the field is left.
fn note(ui: &mut Ui, app: &App, entry: &Entry) -> Option<Call> {
    let id = Id::unique("note of the review");
    let mut note = ui.data_mut(|data| data.get_temp::<Note>(id)).unwrap_or_default();
    let kept = app.session.review.note();
    if note.of != entry.row.id || note.kept != kept {
        note = Note { of: entry.row.id.clone(), text: kept.to_owned(), kept: kept.to_owned() };
    }
    let edit = TextEdit::singleline(&mut note.text)
        .id(Id::unique("review note"))
        .hint_text("Note")
        .desired_width(ui.available_width() - 8.0);
    let response = ui.add(edit).accessible_name("Note about the room");
    let escape = ui.input(|input| input.key_pressed(Key::Escape));
    let mut asked = None;
    if response.lost_focus() {
        if escape {
            note.text.clone_from(&note.kept);
        } else if note.text.trim() != note.kept {
            asked = Some(Call::new("review-note", [Value::Text(note.text.trim().to_owned())]));
        }
    }
    if !kept.is_empty() && link(ui, "Remove the note").clicked() {
        asked = Some(Call::new("review-note", [Value::Text(String::new())]));
    }
    ui.data_mut(|data| data.insert_temp(id, note));
    asked
}
