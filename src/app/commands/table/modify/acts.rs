//! The actions of the commands that select and change things, where they take more than a line.

use super::*;
use crate::draw::dimensions::segment;

/// The line to mirror across.
#[derive(Clone, Copy)]
pub(super) enum Mirror {
    LeftRight,
    UpDown,
}

impl Worded for Mirror {
    const WORDS: &'static [(&'static str, &'static str)] =
        &[("left-right", "Left and right"), ("up-down", "Up and down")];
    const ALL: &'static [Self] = &[Self::LeftRight, Self::UpDown];
}

/// The direction in which to space things equally.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Way {
    Across,
    Up,
}

impl Worded for Way {
    const WORDS: &'static [(&'static str, &'static str)] = &[("across", "Side by side"), ("up", "Above each other")];
    const ALL: &'static [Self] = &[Self::Across, Self::Up];
}

/// A label to search for, or none.
#[derive(Clone, Copy)]
pub(super) struct Wanted(pub Option<Label>);

impl Worded for Wanted {
    const WORDS: &'static [(&'static str, &'static str)] = &[
        ("small", "Small room"),
        ("medium", "Medium room"),
        ("big", "Big room"),
        ("corridor", "Corridor"),
        ("hall", "Hall"),
        ("none", "No label"),
    ];
    const ALL: &'static [Self] = &[
        Self(Some(Label::SmallRoom)),
        Self(Some(Label::MediumRoom)),
        Self(Some(Label::BigRoom)),
        Self(Some(Label::Corridor)),
        Self(Some(Label::Hall)),
        Self(None),
    ];
}

pub(super) const NO_GAPS: &str = "there is no gap of 30 to 150 cm between aligned walls";

/// Moves, turns, mirrors or scales the selection, or a copy of it.
pub(super) fn transformed(app: &mut App, title: &str, transform: Transform, copy: Option<MoveOrCopy>) -> Outcome {
    let selected = app.session.selection.elements().clone();
    let own_walls = app.tools.options.walls_with_rooms;
    let mut made = BTreeSet::new();
    let ran = edited_fitting(app, title, |plan| {
        if copy != Some(MoveOrCopy::Copy) {
            return edit::transform_elements(plan, &selected, transform, own_walls);
        }
        let (plan, placed, refitted) = edit::insert_fitted(plan, &edit::fragment(plan, &selected)?, transform)?;
        made = placed;
        Ok(edit::Changed { plan, refitted })
    });
    select_made(app, &made);
    ran
}

/// Copies the selection and selects the copies.
pub(super) fn copied(app: &mut App, array: Array) -> Outcome {
    let selected = app.session.selection.elements().clone();
    let mut made = BTreeSet::new();
    let ran = edited_fitting(app, "Array", |plan| {
        let (plan, copies, refitted) = edit::array_fitted(plan, &selected, array)?;
        made = copies;
        Ok(edit::Changed { plan, refitted })
    });
    select_made(app, &made);
    ran
}

/// Selects what was made, except corners.
pub(super) fn select_made(app: &mut App, made: &BTreeSet<ElementId>) {
    let made: Vec<ElementId> =
        made.iter().copied().filter(|element| !matches!(element, ElementId::Corner(_))).collect();
    if !made.is_empty() {
        app.session.select(made, SelectMode::Replace);
    }
}

pub(super) fn has_copied(app: &App) -> Availability {
    has_plan(app)?;
    when(app.session.copied.is_some(), "nothing was copied yet")
}

pub(super) fn has_opening(app: &App) -> Availability {
    has_picked(app)?;
    when(app.session.selection.openings().next().is_some(), "select a door or another opening first")
}

pub(super) fn has_dimension(app: &App) -> Availability {
    has_plan(app)?;
    when(matches!(app.picked(), Some(ElementId::Dimension(_))), "select one dimension chain first")
}

pub(super) fn has_wall(app: &App) -> Availability {
    has_plan(app)?;
    when(matches!(app.picked(), Some(ElementId::Wall(_))), "select one wall first")
}

/// Doors are selected, or one was just placed.
pub(super) fn has_door(app: &App) -> Availability {
    has_plan(app)?;
    when(!app.doors_to_flip().is_empty(), "select a door first")
}

pub(super) fn is_labelled(status: RoomStatus, wanted: Option<Label>) -> bool {
    match status {
        RoomStatus::Labelled(label) => wanted == Some(label),
        RoomStatus::Unlabelled => wanted.is_none(),
        RoomStatus::NotClassified => false,
    }
}

/// Selects the search results.
pub(super) fn select_found(app: &mut App, found: Vec<ElementId>, mode: Option<SelectMode>) -> Outcome {
    if found.is_empty() {
        return Outcome::Refused("there is no such room".to_owned());
    }
    app.session.status = format!("Found {}", crate::base::wording::count(found.len(), "room"));
    app.session.select(found, mode.unwrap_or(SelectMode::Replace));
    Outcome::Done
}

pub(super) fn has_drawing(app: &App) -> Availability {
    has_plan(app)?;
    when(app.plan().is_some_and(|plan| !plan.is_empty()), "nothing is drawn yet")
}

/// Corners are only selected by hand: they are part of everything else.
pub(super) fn is_selectable(app: &App, element: ElementId) -> bool {
    !matches!(element, ElementId::Corner(_)) && !app.session.layers.is_locked(element)
}

impl App {
    /// The elements inside a box, or also those touching it.
    pub(super) fn elements_in(&self, bounds: Bounds, touches: bool) -> Vec<ElementId> {
        let Some(plan) = self.plan() else { return Vec::new() };
        let is_in = |points: &[Point]| !points.is_empty() && points.iter().all(|&point| bounds.contains(point));
        let is_met = |points: &[Point], closed: bool| {
            let closing = points.last().zip(points.first()).filter(|_| closed);
            let pairs = points.windows(2).map(|pair| (&pair[0], &pair[1])).chain(closing);
            pairs.into_iter().any(|(a, b)| bounds.meets(Segment::new(*a, *b)))
        };
        let is_chosen = |element: &ElementId| match *element {
            ElementId::Room(id) => plan.room(id).is_some_and(|room| {
                let points = plan.ring_points(&room.outer);
                let is_around = || polygon::locate_in_ring(&points, bounds.center()) == polygon::Location::Inside;
                is_in(&points) || (touches && (is_met(&points, true) || is_around()))
            }),
            ElementId::Wall(_) | ElementId::Opening(_) => {
                let segment = match *element {
                    ElementId::Wall(id) => plan.wall(id).and_then(|wall| plan.wall_segment(wall)),
                    ElementId::Opening(id) => plan.opening(id).and_then(|opening| plan.opening_segment(opening)),
                    _ => None,
                };
                let ends = segment.map(|segment| [segment.a, segment.b]);
                ends.is_some_and(|ends| is_in(&ends) || (touches && is_met(&ends, false)))
            }
            // Below, by their lines.
            ElementId::Corner(_) | ElementId::Dimension(_) => false,
        };
        let near = self.session.document.as_ref().and_then(|document| document.near(bounds));
        let mut found: Vec<ElementId> = match near {
            Some(near) => near.into_iter().filter(is_chosen).collect(),
            None => plan.elements().filter(is_chosen).collect(),
        };
        let dimensions = crate::draw::dimensions::lines(plan).into_iter().filter(|_| self.session.layers.dimensions);
        found.extend(dimensions.filter_map(|(id, line)| {
            let Segment { a, b } = segment(&line)?;
            (is_in(&[a, b]) || (touches && is_met(&[a, b], false))).then_some(ElementId::Dimension(id))
        }));
        found.retain(|&element| is_selectable(self, element));
        found
    }

    /// Reports why an action was refused, when there is no command to do so.
    pub(super) fn report(&mut self, act: impl FnOnce(&mut Self) -> Outcome) {
        if let Outcome::Refused(reason) = act(self) {
            self.session.status = reason;
        }
    }

    /// The point given by an argument, or the middle of the selection.
    pub(super) fn centre_of_selection(&self, named: Option<Point>) -> Point {
        named.unwrap_or_else(|| {
            let document = self.session.document.as_ref();
            let bounds = self.session.selection.iter().filter_map(|element| document?.bounds_of(element));
            bounds.reduce(Bounds::union).map_or(Point::default(), Bounds::center)
        })
    }

    /// Copies the selection, here and to the system's clipboard.
    pub(super) fn copy_selected(&mut self, context: &Context) -> Outcome {
        let Some(plan) = self.plan() else { return Outcome::Done };
        match edit::fragment(plan, self.session.selection.elements()) {
            Ok(fragment) => {
                let text = String::from_utf8_lossy(&crate::formats::plan_json::to_bytes(&fragment)).into_owned();
                context.copy_text(text);
                self.session.status = format!("Copied {} elements", self.session.selection.len());
                self.session.copied = Some(fragment);
                Outcome::Done
            }
            Err(error) => Outcome::Refused(error.to_string()),
        }
    }

    /// Takes the contents of the system's clipboard, if that is part of a plan.
    pub(crate) fn take_pasted(&mut self, text: &str) {
        if let Ok(plan) = crate::formats::plan_json::from_bytes(text.as_bytes())
            && (!plan.is_empty() || plan.dimensions().len() > 0)
        {
            self.session.copied = Some(plan);
        }
    }

    pub(super) fn paste_at(&mut self, at: Point) -> Outcome {
        let Some(fragment) = self.session.copied.clone() else { return Outcome::Done };
        let by = at - edit::middle_of(&fragment);
        let mut made = BTreeSet::new();
        let ran = edited_fitting(self, "Paste", |plan| {
            let (plan, elements, refitted) = edit::insert_fitted(plan, &fragment, Transform::translation(by))?;
            made = elements;
            Ok(edit::Changed { plan, refitted })
        });
        select_made(self, &made);
        ran
    }

    /// Shows which corners would be welded, and asks.
    pub(super) fn ask_to_weld(&mut self, tolerance_m: f64) -> Outcome {
        let Some(plan) = self.plan() else { return Outcome::Done };
        match edit::weld(plan, tolerance_m) {
            Err(error) => Outcome::Refused(error.to_string()),
            Ok(weld) if weld.is_empty() => {
                Outcome::Refused(format!("no corners are within {}", self.units().length(tolerance_m)))
            }
            Ok(weld) => {
                let place = |id| plan.position(id).unwrap_or_default();
                let mut marks: Vec<Segment> =
                    weld.merged.iter().map(|&(from, to)| Segment::new(place(from), place(to))).collect();
                marks.extend(weld.onto_edges.iter().map(|&(corner, _)| Segment::new(place(corner), place(corner))));
                let count = crate::base::wording::count;
                let (corners, edges) = (count(weld.merged.len(), "corner"), count(weld.onto_edges.len(), "edge"));
                let text = format!(
                    "{corners} would join another within {}, and {edges} would be split at a corner, as marked on the \
                     plan.",
                    self.units().length(tolerance_m)
                );
                let answer = ("weld", "Weld");
                self.session.ask(Question::change("Weld these corners?", text, answer, "Weld", weld.plan, marks));
                Outcome::Asks
            }
        }
    }

    /// Shows the gaps in walls, and asks.
    pub(super) fn ask_to_bridge(&mut self) -> Outcome {
        let Some(plan) = self.plan() else { return Outcome::Done };
        let gaps = topology::gaps(plan);
        if gaps.is_empty() {
            return Outcome::Refused(NO_GAPS.to_owned());
        }
        match edit::bridge_gaps(plan, &gaps, OpeningKind::Door) {
            Err(error) => Outcome::Refused(error.to_string()),
            Ok((next, _)) => {
                let gaps_said = crate::base::wording::count(gaps.len(), "gap");
                let (title, answer) = ("Place doors in these gaps?", ("bridge", "Place doors"));
                let text = format!("{gaps_said} between aligned walls, 30 to 150 cm wide, marked on the plan.");
                let marks = gaps.into_iter().map(|gap| gap.segment).collect();
                self.session.ask(Question::change(title, text, answer, "Bridge gaps", next, marks));
                Outcome::Asks
            }
        }
    }

    /// Draws walls parallel to the selection.
    pub(super) fn offset_selected(&mut self, distance_m: f64, named: Option<Point>) -> Outcome {
        let towards = named.or(self.session.pointed.at).unwrap_or_default();
        let walls: Vec<_> = self.session.selection.walls().collect();
        let room = self.session.selection.rooms().next();
        let thickness_m = self.tools.options.thickness_m;
        edited(self, "Offset", |plan| match (walls.is_empty(), room) {
            (false, _) => Ok(edit::offset_walls(plan, &walls, distance_m, towards)?.plan),
            (true, Some(room)) => {
                let points = plan.room(room).map(|room| plan.ring_points(&room.outer)).unwrap_or_default();
                let is_inside = polygon::locate_in_ring(&points, towards) != polygon::Location::Outside;
                Ok(edit::offset_room(plan, room, distance_m, is_inside, thickness_m)?.plan)
            }
            (true, None) => Err(EditError("select walls or a room first".to_owned())),
        })
    }

    /// Changes the selected openings; the change receives the swing of each as drawn.
    pub(super) fn change_openings(
        &mut self,
        title: &str,
        change: impl Fn(&Plan, OpeningId, Swing) -> Result<Plan, EditError>,
    ) -> Outcome {
        let derived = self.session.document.as_ref().and_then(Document::derived).cloned();
        let drawn = |id: OpeningId| derived.as_ref().and_then(|derived| derived.drawing.swing_of(id));
        let openings: Vec<(OpeningId, Swing)> = self
            .session
            .selection
            .openings()
            .map(|id| (id, drawn(id).unwrap_or(Swing { hinge_at_start: true, side: LeafSide::Left })))
            .collect();
        edited(self, title, |plan| {
            openings.iter().try_fold(plan.clone(), |plan, &(id, swing)| change(&plan, id, swing))
        })
    }

    /// The selected doors or, where nothing is selected, the one just placed.
    pub(crate) fn doors_to_flip(&self) -> Vec<OpeningId> {
        let Some(plan) = self.plan() else { return Vec::new() };
        let fresh = self.session.fresh_opening().filter(|_| self.session.selection.is_empty());
        let is_door = |id: &OpeningId| {
            let kind = plan.opening(*id).map(|opening| opening.kind);
            matches!(kind, Some(OpeningKind::Door | OpeningKind::DoubleDoor))
        };
        self.session.selection.openings().chain(fresh).filter(is_door).collect()
    }

    /// Hangs them the next way.
    pub(super) fn flip_doors(&mut self) -> Outcome {
        let doors = self.doors_to_flip();
        let derived = self.session.document.as_ref().and_then(Document::derived).cloned();
        let mut ran = Outcome::Done;
        self.session.keeping_fresh(|session| {
            let flipped = session.try_edit("Flip", |plan| {
                doors.iter().try_fold(plan.clone(), |plan, &id| {
                    let shown = derived.as_ref().and_then(|derived| derived.drawing.swing_of(id));
                    let shown = shown.unwrap_or(Swing { hinge_at_start: true, side: LeafSide::Left });
                    let kind = plan.opening(id).map_or(OpeningKind::Door, |opening| opening.kind);
                    edit::change_swing(&plan, id, shown, |swing| edit::next_swing(kind, swing))
                })
            });
            if let Err(error) = flipped {
                ran = Outcome::Refused(error.to_string());
            }
        });
        ran
    }

    /// Moves the selection a little; an opening along its wall, where that goes.
    pub(super) fn nudge(&mut self, direction: Direction, distance_m: f64) -> Outcome {
        let by = direction.vector() * distance_m;
        let position = |app: &Self| app.session.document.as_ref().map(|document| document.history.position());
        let before = position(self);
        let ran = match self.picked() {
            Some(ElementId::Corner(corner)) => edited(self, "Nudge", |plan| {
                let Some(place) = plan.position(corner) else { return Ok(plan.clone()) };
                edit::settle(&edit::move_corners(plan, &[(corner, place + by)])?, &BTreeSet::from([corner]))
            }),
            Some(ElementId::Opening(opening)) => edited(self, "Nudge", |plan| {
                let segment = plan.opening(opening).and_then(|opening| plan.opening_segment(opening));
                let Some(segment) = segment else { return Ok(plan.clone()) };
                if segment.vector().unit().is_none_or(|along| along.dot(direction.vector()).abs() < 0.1) {
                    return Err(EditError("an opening moves only along its wall".to_owned()));
                }
                edit::slide_opening(plan, opening, segment.midpoint() + by)
            }),
            _ => {
                let selected = self.session.selection.elements().clone();
                let own_walls = self.tools.options.walls_with_rooms;
                edited_fitting(self, "Nudge", |plan| {
                    edit::move_picked(plan, &selected, by, edit::Reach::default(), own_walls)
                })
            }
        };
        // Going on in the same way is one step: it is undone at once.
        if ran == Outcome::Done
            && position(self) != before
            && let Some(document) = &mut self.session.document
        {
            if self.session.nudged.is_some() && self.session.nudged == before {
                document.history.join_with_previous();
            }
            self.session.nudged = Some(document.history.position());
        }
        ran
    }

    /// Deletes the selection; asks first if more would be deleted with it.
    pub(super) fn delete_selected(&mut self) -> Outcome {
        let Some(plan) = self.plan() else { return Outcome::Done };
        let selected: Vec<ElementId> = self.session.selection.iter().collect();
        let gone = edit::removed_with(plan, &selected);
        // Corners that become unused are no loss, and openings go with their walls.
        let own = edit::Part::of(plan, self.session.selection.elements()).map(|part| part.openings).unwrap_or_default();
        let is_loss = |element: &ElementId| match element {
            ElementId::Corner(_) => false,
            ElementId::Opening(id) if own.contains(id) => false,
            element => !self.session.selection.contains(*element),
        };
        if gone.iter().any(is_loss) {
            self.session.ask(Question::delete(selected, gone));
            return Outcome::Asks;
        }
        self.session.delete(&selected);
        Outcome::Done
    }
}
