//! Selecting and changing what is drawn.

use super::draw::edited;
use super::*;
use crate::app::{Question, SelectMode};
use crate::plan::{ElementId, edit};

const MODE: Argument = optional("MODE", ArgumentKind::Word(SelectMode::WORDS), "replace (without), add or toggle");

pub(super) const COMMANDS: &[Command] = &[
    command("select-all", "Select all", "Select everything that is not locked", has_drawing, |app, _| {
        let Some(plan) = app.plan() else { return };
        let all: Vec<ElementId> = plan.elements().filter(|&element| is_selectable(app, element)).collect();
        app.select(all, SelectMode::Replace);
    })
    .keys(&[ctrl(Key::A)])
    .menu(Menu::Modify, 0),
    with(
        "select-by-label",
        "Select by label…",
        "Select all rooms with a label",
        has_rooms,
        &[needed("LABEL", ArgumentKind::Word(LABELS), "small, medium, big, corridor, hall or none"), MODE],
        |app, values, _| {
            let wanted = values.word(0).copied().unwrap_or_default();
            let Some(plan) = app.plan() else { return Ran::Done };
            let found: Vec<ElementId> = plan
                .rooms()
                .filter(|(_, room)| label_word(RoomStatus::of(plan, &app.schemes, room)) == wanted)
                .map(|(id, _)| ElementId::Room(id))
                .collect();
            select_found(app, found, values)
        },
        None,
    )
    .menu(Menu::Modify, 0),
    with(
        "select-by-function",
        "Select by function…",
        "Select all rooms that are for something",
        has_rooms,
        &[needed("FUNCTION", ArgumentKind::Function, "what the rooms are for"), MODE],
        |app, values, _| {
            let wanted = normalised_function(values.text(0).unwrap_or_default());
            let Some(plan) = app.plan() else { return Ran::Done };
            let found: Vec<ElementId> = plan
                .rooms()
                .filter(|(_, room)| normalised_function(&room.function) == wanted)
                .map(|(id, _)| ElementId::Room(id))
                .collect();
            select_found(app, found, values)
        },
        None,
    )
    .menu(Menu::Modify, 0),
    with(
        "delete",
        "Delete",
        "Delete what is selected, and what cannot stand without it",
        has_picked,
        &[],
        |app, _, _| app.delete_selected(),
        None,
    )
    .keys(&[key(Key::Delete)])
    .menu(Menu::Modify, 1),
    switch(
        "lock-rooms",
        "Lock rooms",
        "Let the pointer neither select nor move rooms",
        always,
        |app| app.layers.locked.rooms,
        |app, is_on| app.layers.locked.rooms = is_on,
    )
    .menu(Menu::Modify, 9),
    switch(
        "lock-walls",
        "Lock walls",
        "Let the pointer neither select nor move walls",
        always,
        |app| app.layers.locked.walls,
        |app, is_on| app.layers.locked.walls = is_on,
    )
    .menu(Menu::Modify, 9),
    switch(
        "lock-openings",
        "Lock openings",
        "Let the pointer neither select nor move openings",
        always,
        |app| app.layers.locked.openings,
        |app, is_on| app.layers.locked.openings = is_on,
    )
    .menu(Menu::Modify, 9),
    // What the pointer does, for scripts.
    with(
        "select-box",
        "Select in a box",
        "Select what lies in a box, or also what it touches",
        has_plan,
        &[
            needed("CORNERS", ArgumentKind::Points { least: 2 }, "two opposite corners of the box"),
            optional(
                "HOW",
                ArgumentKind::Word(&[("inside", "Inside"), ("touching", "Touching")]),
                "inside (without) or touching",
            ),
            MODE,
        ],
        |app, values, _| {
            let bounds = Bounds::of(values.points(0).unwrap_or_default().iter().copied());
            let touches = values.word(1) == Some(&"touching");
            let found = app.elements_in(bounds, touches);
            let mode = SelectMode::of_word(values.word(2).copied().unwrap_or("replace"));
            app.select(found, mode);
            Ran::Done
        },
        None,
    ),
    with(
        "move",
        "Move",
        "Move what is selected; what shares its corners follows",
        has_picked,
        &[needed("BY", ArgumentKind::Points { least: 1 }, "how far right and up, in metres, as '0.5,-1'")],
        |app, values, _| {
            let by = values.points(0).and_then(|points| points.first()).copied().unwrap_or_default() - Point::default();
            let corners = crate::app::tools::corners_of(app.plan().unwrap_or(&Plan::default()), &app.selection);
            edited(app, "Move", |plan| {
                let targets: Vec<_> = corners.iter().filter_map(|&id| Some((id, plan.position(id)? + by))).collect();
                edit::move_corners(plan, &targets)
            })
        },
        None,
    ),
    with(
        "move-corner",
        "Move a corner",
        "Move a corner; everything that shares it follows",
        has_plan,
        &[
            needed("CORNER", ArgumentKind::Elements, "the corner's id"),
            needed("TO", ArgumentKind::Points { least: 1 }, "where to, in metres"),
        ],
        |app, values, _| {
            let to = values.points(1).and_then(|points| points.first()).copied().unwrap_or_default();
            let Some(ElementId::Corner(corner)) = values.elements(0).and_then(|elements| elements.first()).copied()
            else {
                return Ran::Refused("this is no corner".to_owned());
            };
            edited(app, "Move corner", |plan| edit::move_corners(plan, &[(corner, to)]))
        },
        None,
    ),
    with(
        "slide-opening",
        "Slide an opening",
        "Slide an opening along its wall, as near to a point as the wall lets it",
        has_openings,
        &[
            needed("OPENING", ArgumentKind::Opening, "the opening's id"),
            needed("TOWARDS", ArgumentKind::Points { least: 1 }, "a point, in metres"),
        ],
        |app, values, _| {
            let towards = values.points(1).and_then(|points| points.first()).copied().unwrap_or_default();
            let Some(&opening) = values.opening(0) else { return Ran::Done };
            edited(app, "Slide opening", |plan| edit::slide_opening(plan, opening, towards))
        },
        None,
    ),
];

/// The labels as words, and rooms without one.
const LABELS: &[(&str, &str)] = &[
    ("small", "Small room"),
    ("medium", "Medium room"),
    ("big", "Big room"),
    ("corridor", "Corridor"),
    ("hall", "Hall"),
    ("none", "No label"),
];

fn label_word(status: RoomStatus) -> &'static str {
    match status {
        RoomStatus::Labelled(label) => LABELS[label.index()].0,
        RoomStatus::Unlabelled => "none",
        RoomStatus::NotClassified => "",
    }
}

/// Selects what was looked for.
fn select_found(app: &mut App, found: Vec<ElementId>, values: &Values) -> Ran {
    if found.is_empty() {
        return Ran::Refused("there is no such room".to_owned());
    }
    app.status = format!("Found {}", crate::app::panels::status::count(found.len(), "room"));
    app.select(found, SelectMode::of_word(values.word(1).copied().unwrap_or("replace")));
    Ran::Done
}

fn has_drawing(app: &App) -> Availability {
    has_plan(app)?;
    when(app.plan().is_some_and(|plan| !plan.is_empty()), "nothing is drawn yet")
}

/// Corners are selected by hand only: they are part of everything else.
fn is_selectable(app: &App, element: ElementId) -> bool {
    !matches!(element, ElementId::Corner(_)) && !app.layers.is_locked(element)
}

impl App {
    /// What lies in a box, or also what it touches.
    fn elements_in(&self, bounds: Bounds, touches: bool) -> Vec<ElementId> {
        let Some(plan) = self.plan() else { return Vec::new() };
        let is_in = |points: &[Point]| !points.is_empty() && points.iter().all(|&point| bounds.contains(point));
        let is_met = |points: &[Point], closed: bool| {
            let closing = points.last().zip(points.first()).filter(|_| closed);
            let pairs = points.windows(2).map(|pair| (&pair[0], &pair[1])).chain(closing);
            pairs.into_iter().any(|(a, b)| bounds.meets(Segment::new(*a, *b)))
        };
        let mut found = Vec::new();
        for (id, room) in plan.rooms() {
            let points = plan.ring_points(&room.outer);
            let is_around = || polygon::locate_in_ring(&points, bounds.center()) == polygon::Location::Inside;
            if is_in(&points) || (touches && (is_met(&points, true) || is_around())) {
                found.push(ElementId::Room(id));
            }
        }
        let walls = plan.walls().filter_map(|(id, wall)| Some((ElementId::Wall(id), plan.wall_segment(wall)?)));
        let openings =
            plan.openings().filter_map(|(id, opening)| Some((ElementId::Opening(id), plan.opening_segment(opening)?)));
        for (element, segment) in walls.chain(openings) {
            let ends = [segment.a, segment.b];
            if is_in(&ends) || (touches && is_met(&ends, false)) {
                found.push(element);
            }
        }
        found.retain(|&element| is_selectable(self, element));
        found
    }

    /// Deletes what is selected; asks first where more would go with it.
    fn delete_selected(&mut self) -> Ran {
        let Some(plan) = self.plan() else { return Ran::Done };
        let selected: Vec<ElementId> = self.selection.iter().collect();
        let gone = edit::removed_with(plan, &selected);
        // Corners that nothing uses any more are no loss.
        let is_loss =
            |element: &ElementId| !self.selection.contains(*element) && !matches!(element, ElementId::Corner(_));
        if gone.iter().any(is_loss) {
            self.question = Some(Question::Delete { selected, gone });
            return Ran::Asks;
        }
        self.delete(&selected);
        Ran::Done
    }

    /// Deletes elements and what depends on them.
    pub(in crate::app) fn delete(&mut self, elements: &[ElementId]) {
        let title = match elements {
            [one] => format!("Delete {}", one.kind()),
            several => format!("Delete {} elements", several.len()),
        };
        self.edit(&title, |plan| edit::remove(plan, elements));
    }
}
