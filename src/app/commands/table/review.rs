//! The review of labels.

use super::*;

fn done(result: Result<(), String>) -> Outcome {
    result.map_or_else(Outcome::Refused, |()| Outcome::Done)
}

fn is_reviewing(app: &App) -> Availability {
    when(app.session.is_reviewing(), "start a review of the labels first")
}

fn can_review(app: &App) -> Availability {
    when(app.session.can_review(), "open a folder of plans first")
}

fn can_go_back(app: &App) -> Availability {
    when(app.session.review.can_go_back(), "nothing was decided in a review yet")
}

impl App {
    /// Shows the panel of the review: what it does is seen there.
    fn show_review_panel(&mut self) {
        self.panels.set_shown(panels::REVIEW, true);
    }
}

pub(super) const COMMANDS: &[Command] = &[
    with(
        "review-labels",
        "Review the labels…",
        "Go through the rooms of all plans in the open folder, those first whose labels are most likely wrong",
        can_review,
        &given0(|app, _| {
            app.show_review_panel();
            done(app.session.review_labels())
        }),
        None,
    )
    .menu(Menu::Dataset, 3),
    with(
        "review-differences",
        "Compare with another person's labels…",
        "Go through the rooms that somebody else labelled otherwise, in another folder with plans of the same names",
        can_review,
        &given1(needed("FOLDER", PLAN_FILE, "the folder of the other person's plans"), |app, folder, _| {
            app.show_review_panel();
            done(app.session.review_differences(folder))
        }),
        None,
    )
    .menu(Menu::Dataset, 3),
    with(
        "review-accept",
        "Keep the label",
        "In a review: the label is right as it is now; go on with the next room",
        is_reviewing,
        &given0(|app, _| done(app.session.review_accept())),
        None,
    )
    .keys(&[key(Key::Y)])
    .menu(Menu::Dataset, 3),
    with(
        "review-correct",
        "Correct the label",
        "In a review: give the room the likelier label, or the one named; go on with the next room",
        is_reviewing,
        &given1(optional("LABEL", one_of::<Label>(), "the right label"), |app, label, _| {
            done(app.session.review_correct(label))
        }),
        None,
    )
    .keys(&[shift(Key::Y)])
    .menu(Menu::Dataset, 3),
    with(
        "review-skip",
        "Skip the room",
        "In a review: leave the room for later, after all others",
        is_reviewing,
        &given0(|app, _| done(app.session.review_skip())),
        None,
    )
    .keys(&[key(Key::U)])
    .menu(Menu::Dataset, 3),
    with(
        "review-back",
        "Back in the review",
        "In a review: return to the last room and take back what was done to it, in whichever plan it is",
        can_go_back,
        &given0(|app, _| done(app.session.review_back())),
        None,
    )
    .keys(&[shift(Key::U)])
    .menu(Menu::Dataset, 3),
    with(
        "review-note",
        "Note about the room…",
        "In a review: write something about the room, kept with the decisions",
        is_reviewing,
        &given1(needed("NOTE", TEXT, "what to write; empty removes the note"), |app, note, _| {
            done(app.session.review_note(&note))
        }),
        None,
    )
    .keys(&[key(Key::I)])
    .menu(Menu::Dataset, 3),
    with(
        "review-stop",
        "End the review",
        "End the review; what was decided is kept, and the next review goes on from there",
        always,
        &given0(|app, _| {
            app.session.cancel_review();
            Outcome::Done
        }),
        None,
    )
    .menu(Menu::Dataset, 3),
];
