//! Drawing: walls, rooms, openings.

use super::*;
use crate::edit;
use crate::edit::{Built, Lies};
use crate::geometry::GRID_M;
use crate::plan::{DimensionAlong, OpeningId, OpeningKind};

const PATH: Arg<Vec<Point>> =
    needed("POINTS", points(2), "points in metres, such as '0,0 4.2,0'; the last may be the first");
const RING: Arg<Vec<Point>> = needed("CORNERS", points(3), "corners in metres, such as '0,0 4,0 4,3 0,3'");
const PLACE: Arg<Point> = needed("PLACE", POINT, "a point in metres, such as '2,1.5'");
/// For what makes boundaries: how thick the walls along them are.
const NEW_WALLS: Arg<Option<f64>> = optional(
    "THICKNESS",
    length(0.0, 10.0),
    "of walls along new boundaries, 0 for none; the thickness set for new walls without it",
);
const THICKNESS: Arg<Option<f64>> =
    optional("THICKNESS", length(0.0, 10.0), "of walls; the thickness set for new walls without it");

fn outcome(edited: Result<(), EditError>) -> Outcome {
    edited.map_or_else(|error| Outcome::Refused(error.to_string()), |()| Outcome::Done)
}

/// Applies an edit; if the edit is refused, so is the command.
pub(super) fn edited(app: &mut App, title: &str, change: impl FnOnce(&Plan) -> Result<Plan, EditError>) -> Outcome {
    outcome(app.session.try_edit(title, change))
}

/// The same for an edit that touches only the rooms that meet a box.
pub(super) fn edited_near(
    app: &mut App,
    title: &str,
    bounds: Bounds,
    change: impl Fn(&Plan) -> Result<Plan, EditError>,
) -> Outcome {
    outcome(app.session.try_edit_near(title, bounds, change))
}

/// The same for an edit that may have had to fit openings anew: says so.
pub(super) fn edited_fitting_near(
    app: &mut App,
    title: &str,
    bounds: Bounds,
    change: impl Fn(&Plan) -> Result<edit::Changed, EditError>,
) -> Outcome {
    let refitted = std::cell::RefCell::new(Vec::new());
    let ran = edited_near(app, title, bounds, |plan| {
        let changed = change(plan)?;
        refitted.replace(changed.refitted);
        Ok(changed.plan)
    });
    app.say_refitted(&refitted.into_inner());
    ran
}

/// How far from a path what it meets may lie, in metres: far more than any line is bent to meet another.
pub(super) const REACH_OF_WALLS_M: f64 = 0.5;

/// The same for an edit that may have had to fit openings anew: says so.
pub(super) fn edited_fitting(
    app: &mut App,
    title: &str,
    change: impl FnOnce(&Plan) -> Result<edit::Changed, EditError>,
) -> Outcome {
    let mut refitted = Vec::new();
    let ran = edited(app, title, |plan| {
        let changed = change(plan)?;
        refitted = changed.refitted;
        Ok(changed.plan)
    });
    app.say_refitted(&refitted);
    ran
}

pub(super) const COMMANDS: &[Command] = &[
    with(
        "fill-all",
        "Fill all",
        "Make a room wherever walls enclose space that no room covers",
        has_walls,
        &given0(|app, _| {
            let mut filled = 0;
            let ran = edited(app, "Fill all", |plan| {
                let all = edit::fill_all(plan)?;
                filled = all.rooms.len();
                Ok(all.plan)
            });
            if filled == 0 && ran == Outcome::Done {
                return Outcome::Refused("walls enclose nothing that has no room yet".to_owned());
            }
            app.session.status = format!("Made {}", crate::base::wording::count(filled, "room"));
            ran
        }),
        None,
    )
    .keys(&[shift(Key::E)])
    .menu(Menu::Draw, 3)
    .on(&[On::FreeSpace]),
    switch(
        "right-angles",
        "Right angles",
        "Draw at right angles only; hold Shift to draw freely",
        always,
        |app| app.tools.options.right_angles,
        |app, is_on| app.tools.options.right_angles = is_on,
    )
    .keys(&[key(Key::F8)])
    .menu(Menu::Draw, 4),
    switch(
        "snapping",
        "Snap to the drawing",
        "Snap to corners, crossings, midpoints, axes and faces of walls, and alignments; hold Alt to suspend it, \
         press Tab for the next snap",
        always,
        |app| app.tools.options.snaps,
        |app, is_on| app.tools.options.snaps = is_on,
    )
    .keys(&[key(Key::F3)])
    .menu(Menu::Draw, 4),
    switch(
        "snap-to-grid",
        "Snap to the grid",
        "Snap to the grid and to round lengths while the grid is shown and no picture is",
        always,
        |app| app.tools.options.snaps_to_grid,
        |app, is_on| app.tools.options.snaps_to_grid = is_on,
    )
    .keys(&[key(Key::F9)])
    .menu(Menu::Draw, 4),
    switch(
        "walls-with-rooms",
        "With walls",
        "Draw walls along every new boundary: of rooms, of splits, of courtyards, and where a room comes away from \
         its neighbours",
        always,
        |app| app.tools.options.walls_with_rooms,
        |app, is_on| app.tools.options.walls_with_rooms = is_on,
    )
    .menu(Menu::Draw, 4),
    switch(
        "clear-sizes",
        "Clear sizes",
        "Draw rooms by their clear size, between wall faces, instead of by the axes of their walls",
        always,
        |app| app.tools.options.clear_sizes,
        |app, is_on| app.tools.options.clear_sizes = is_on,
    )
    .menu(Menu::Draw, 4),
    switch(
        "rooms-from-walls",
        "Rooms from closed walls",
        "Make a room as soon as walls are closed; on for new plans",
        has_plan,
        |app| app.session.closes_rooms(),
        |app, is_on| app.session.set_closes_rooms(is_on),
    )
    .menu(Menu::Draw, 4),
    switch(
        "over-rooms",
        "Over rooms",
        "Let new rooms lie over others, such as a niche or a corridor inside another room",
        always,
        |app| app.tools.options.over_rooms,
        |app, is_on| app.tools.options.over_rooms = is_on,
    )
    .keys(&[key(Key::F7)])
    .menu(Menu::Draw, 4),
    with(
        "wall-thickness",
        "Wall thickness…",
        "Set the thickness of new walls",
        always,
        &given1(needed("THICKNESS", length(0.0, 10.0), "of new walls"), |app, thickness_m, _| {
            app.tools.options.thickness_m = thickness_m;
            Outcome::Done
        }),
        None,
    )
    .menu(Menu::Draw, 4),
    with(
        "wall-side",
        "Wall side…",
        "Choose the side of the line that new walls lie on: left, centre or right; press S while drawing for the next",
        always,
        &given1(optional("SIDE", one_of::<Lies>(), "left, centre or right; without it, the next"), |app, lies, _| {
            let lies = lies.unwrap_or(app.tools.options.lies.next());
            app.tools.options.lies = lies;
            app.session.status = format!("New walls lie {}", said_of(lies));
            Outcome::Done
        }),
        None,
    )
    .menu(Menu::Draw, 4),
    with(
        "opening-width",
        "Opening width…",
        "Set the width of new doors, passages and windows; double doors are twice as wide",
        always,
        &given1(needed("WIDTH", length(0.1, 100.0), "of new openings"), |app, width_m, _| {
            app.tools.options.opening_width_m = width_m;
            Outcome::Done
        }),
        None,
    )
    .menu(Menu::Draw, 4),
    with(
        "arc-tolerance",
        "Arc tolerance…",
        "Set how closely straight pieces follow an arc; press A while drawing for an arc",
        always,
        &given1(
            needed("TOLERANCE", length(0.0005, 10.0), "how far a straight piece may be from its arc"),
            |app, tolerance_m, _| {
                app.tools.options.arc_tolerance_m = tolerance_m;
                Outcome::Done
            },
        ),
        None,
    )
    .menu(Menu::Draw, 4),
    // The actions of the tools, for scripts.
    with(
        "draw-walls",
        "Draw walls",
        "Draw a chain of walls from point to point; rooms that they cross are split",
        has_plan,
        &given5(
            PATH,
            THICKNESS,
            optional("SIDE", one_of::<Lies>(), "the side of the line they lie on; centre by default"),
            optional("DRAWN-THICKNESS", length(0.0, 10.0), "of the first wall, if it exists already"),
            optional("DRAWN-SIDE", one_of::<Lies>(), "of the first wall, if it exists already"),
            |app, points, thickness_m, lies, drawn_m, drawn_lies, _| {
                let thickness_m = thickness_m.unwrap_or(app.tools.options.thickness_m);
                let built = Built { thickness_m, lies: lies.unwrap_or_default() };
                let drawn = drawn_m.zip(drawn_lies).map(|(thickness_m, lies)| Built { thickness_m, lies });
                let draw = |plan: &Plan| edit::draw_walls_beside(plan, &points, built, drawn);
                if !app.session.closes_rooms() {
                    // Beside a line, and on to where faces join.
                    let reach_m = REACH_OF_WALLS_M + 7.0 * thickness_m.max(drawn_m.unwrap_or(0.0));
                    let around = Bounds::of(points.iter().copied()).inflated(reach_m);
                    return edited_near(app, "Draw wall", around, |plan| Ok(draw(plan)?.plan));
                }
                let mut made = 0;
                let ran = edited(app, "Draw wall", |plan| {
                    let drawn = draw(plan)?;
                    // Walls that meet too often to say what they enclose are drawn all the same.
                    let closed = edit::fill_closed(plan, &drawn.plan, &drawn.walls).ok();
                    Ok(closed.map_or(drawn.plan, |closed| {
                        made = closed.rooms.len();
                        closed.plan
                    }))
                });
                if made > 0 {
                    app.session.status =
                        format!("The walls are closed: made {}", crate::base::wording::count(made, "room"));
                }
                ran
            },
        ),
        None,
    ),
    command(
        "dimension-rooms",
        "Dimension rooms",
        "Draw chains of the clear width and depth of the selected rooms",
        has_rooms_selected,
        |app, _| {
            let rooms: Vec<RoomId> = app.selection().rooms().collect();
            app.session.edit("Dimension rooms", |plan| {
                rooms.iter().try_fold(plan.clone(), |plan, &room| edit::dimension_room(&plan, room))
            });
        },
    )
    .menu(Menu::Draw, 4),
    with(
        "dimension-outside",
        "Dimension the outside",
        "Draw the usual chains along each side of the building: openings and offsets, and the whole length",
        has_plan,
        &given0(|app, _| {
            let mut drawn = 0;
            let ran = edited(app, "Dimension the outside", |plan| {
                let (plan, number) = edit::dimension_outside(plan)?;
                drawn = number;
                Ok(plan)
            });
            if ran == Outcome::Done {
                app.session.layers.dimensions = true;
                app.session.status = match drawn {
                    0 => "All sides have their chains already".to_owned(),
                    drawn => format!("Drew {}", crate::base::wording::count(drawn, "dimension chain")),
                };
            }
            ran
        }),
        None,
    )
    .menu(Menu::Draw, 4)
    .on(&[On::FreeSpace]),
    with(
        "draw-dimension",
        "Draw a dimension chain",
        "Draw a dimension chain from point to point that follows what it measures",
        has_plan,
        &given3(
            needed("POINTS", points(2), "what to measure: points in metres, such as '0,0 4.2,0'"),
            needed("ALONG", one_of::<DimensionAlong>(), "horizontal, vertical or aligned"),
            needed("THROUGH", POINT, "where the line lies: a point in metres, such as '2,-1'"),
            |app, points, along, through, _| {
                edited(app, "Draw dimension", |plan| Ok(edit::draw_dimension(plan, &points, along, through)?.0))
            },
        ),
        None,
    ),
    with(
        "draw-room",
        "Draw a room",
        "Draw a room with these corners",
        has_plan,
        &given3(
            RING,
            optional(
                "SPACE",
                one_of::<Space>(),
                "exact (default) for this boundary, free for the part of it that no room covers",
            ),
            THICKNESS,
            |app, points, space, thickness_m, context| {
                let thickness_m = app.new_walls_m(thickness_m);
                let (mut said, mut made) = (String::new(), Vec::new());
                let units = app.units();
                let ran = edited(app, "Draw room", |plan| {
                    if space == Some(Space::Free) {
                        let gap_m = edit::GAP_BETWEEN_ROOMS_M;
                        let drawn = edit::draw_room_in_free_space(plan, &points, thickness_m, gap_m)?;
                        said = pieces_said(&drawn, units);
                        made = drawn.rooms;
                        Ok(drawn.plan)
                    } else {
                        let (plan, room) = edit::draw_room(plan, &points, thickness_m)?;
                        made = vec![room];
                        Ok(plan)
                    }
                });
                app.session.status = said;
                app.has_drawn_rooms(&made, context);
                ran
            },
        ),
        None,
    ),
    with(
        "fill-at",
        "Fill at a place",
        "Make a room of what encloses a point",
        has_plan,
        &given1(PLACE, |app, point, context| {
            let mut made = Vec::new();
            let ran = edited(app, "Fill", |plan| {
                let filled = edit::fill_at(plan, point)?;
                made = filled.rooms;
                Ok(filled.plan)
            });
            app.has_drawn_rooms(&made, context);
            ran
        }),
        None,
    ),
    with(
        "split-rooms",
        "Split rooms along a line",
        "Split the rooms that a line crosses from boundary to boundary",
        has_rooms,
        &given2(PATH, NEW_WALLS, |app, points, thickness_m, _| {
            let thickness_m = app.new_walls_m(thickness_m);
            edited(app, "Split", |plan| edit::split_rooms(plan, &points, thickness_m).map(|split| split.0))
        }),
        None,
    ),
    with(
        "cut-out",
        "Cut out a courtyard",
        "Cut an area out of the room that it lies in",
        has_rooms,
        &given2(RING, NEW_WALLS, |app, points, thickness_m, _| {
            let thickness_m = app.new_walls_m(thickness_m);
            edited(app, "Cut out", |plan| {
                edit::cut_out_by(plan, edit::room_around(plan, &points)?, &points, thickness_m)
            })
        }),
        None,
    ),
    with(
        "add-opening",
        "Add an opening",
        "Place an opening in the wall or boundary at a point",
        has_plan,
        &given4(
            needed("KIND", one_of::<OpeningKind>(), "door, double-door, passage or window"),
            PLACE,
            optional("WIDTH", length(0.01, 1000.0), "the width; the width set for new openings without it"),
            optional("TOWARDS", POINT, "a point on the side that a door swings to"),
            |app, kind, at, width_m, towards, _| {
                let width_m = width_m.unwrap_or(app.tools.options.opening_width_m);
                let mut made = None;
                let ran = edited(app, &format!("Add {}", kind.name()), |plan| {
                    let (next, id) = edit::place_opening(plan, kind, at, width_m, OPENING_REACH_M, towards)?;
                    made = Some(id);
                    Ok(next)
                });
                app.say_narrower(width_m, made.as_slice());
                app.session.has_drawn(made.map(ElementId::Opening));
                ran
            },
        ),
        None,
    ),
];

impl App {
    /// Records the rooms that were just drawn: of one, the next key means it, wherever the pointer stands.
    fn has_drawn_rooms(&mut self, rooms: &[RoomId], context: &Context) {
        let &[room] = rooms else { return };
        self.session.has_drawn(Some(ElementId::Room(room)));
        if self.session.status.is_empty() {
            let keys =
                |id: &str| super::super::find(id).map(|command| self.keys_text(command, context)).unwrap_or_default();
            let [function, name] = ["set-function", "rename"].map(keys);
            self.session.status = format!("Label keys apply to the new room · {function}: function · {name}: name");
        }
    }

    /// The thickness of walls along new boundaries: as given, or as set; `None` for no walls.
    fn new_walls_m(&self, given_m: Option<f64>) -> Option<f64> {
        let options = &self.tools.options;
        let own_m = options.walls_with_rooms.then_some(options.thickness_m);
        given_m.or(own_m).filter(|thickness_m| *thickness_m > 0.0)
    }

    /// Says what became of openings that no longer fitted where they were.
    pub(super) fn say_refitted(&mut self, refitted: &[edit::Refitted]) {
        let units = self.units();
        let said = match refitted {
            [] => return,
            [edit::Refitted { kind, how, .. }] => {
                let kind = crate::base::wording::sentence(kind.name());
                match *how {
                    edit::Refit::Moved { by_m } => format!("{kind} moved by {} to fit", units.length(by_m)),
                    edit::Refit::Narrowed { from_m, to_m } => {
                        let [from, to] = [from_m, to_m].map(|width_m| units.length(width_m));
                        format!("{kind} made narrower to fit its wall: {to} wide, not {from}")
                    }
                    edit::Refit::LeftOut => format!("{kind} left out: another opening is there"),
                }
            }
            several => {
                let number = |is_it: fn(&edit::Refit) -> bool| several.iter().filter(|one| is_it(&one.how)).count();
                let counts = [
                    (number(|how| matches!(how, edit::Refit::Moved { .. })), "moved to fit"),
                    (number(|how| matches!(how, edit::Refit::Narrowed { .. })), "made narrower"),
                    (number(|how| matches!(how, edit::Refit::LeftOut)), "left out, because others are there"),
                ];
                let counts = counts.into_iter().filter(|(number, _)| *number > 0);
                let said: Vec<String> = counts
                    .map(|(number, what)| format!("{} {what}", crate::base::wording::count(number, "opening")))
                    .collect();
                crate::base::wording::sentence(&said.join(" · "))
            }
        };
        self.session.status = said;
    }

    /// Says where openings became narrower than was wanted, for their walls are no longer.
    pub(super) fn say_narrower(&mut self, wanted_m: f64, openings: &[OpeningId]) {
        let Some(plan) = self.plan() else { return };
        let widths_m = openings.iter().filter_map(|&id| Some(plan.opening_segment(plan.opening(id)?)?.length()));
        let narrowest_m = widths_m.fold(f64::INFINITY, f64::min);
        // Half of the grid is rounding, at whatever angle the wall stands.
        if narrowest_m < wanted_m - 1.5 * GRID_M {
            let [narrowest, wanted] = [narrowest_m, wanted_m].map(|width_m| self.units().length(width_m));
            self.session.status = format!("The wall is no longer: {narrowest} wide, not {wanted}");
        }
    }
}

fn said_of(lies: Lies) -> &'static str {
    match lies {
        Lies::Left => "left of the line: it is their right face",
        Lies::Centre => "centred on the line",
        Lies::Right => "right of the line: it is their left face",
    }
}

/// What is to be said of a room that came in pieces; nothing of one that did not.
fn pieces_said(drawn: &edit::DrawnInFreeSpace, units: Units) -> String {
    let left_out = if drawn.left_out_m2 > 0.0 {
        format!("; {} in small pieces are left free", units.area(drawn.left_out_m2))
    } else {
        String::new()
    };
    match drawn.rooms.len() {
        1 if left_out.is_empty() => String::new(),
        1 => format!("Made a room of the largest piece that is free{left_out}"),
        number => format!("Made {number} rooms: what is free here lies in pieces{left_out}"),
    }
}

/// An opening goes into a wall this near to the point that a script names: points are rounded, and a
/// drawing is not known to the millimetre.
const OPENING_REACH_M: f64 = 0.1;

fn has_rooms_selected(app: &App) -> Availability {
    has_plan(app)?;
    when(app.selection().rooms().next().is_some(), "select a room first")
}

fn has_walls(app: &App) -> Availability {
    has_plan(app)?;
    when(app.plan().is_some_and(|plan| plan.walls().len() > 0), "the plan has no walls")
}
