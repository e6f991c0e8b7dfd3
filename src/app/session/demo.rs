//! The demonstration: a school that nobody has labelled is revealed room by room and labelled as it grows, reasons are shown,
//! and a door is dragged until a label flips. Any click or key ends it; the plan stays as it is then.
//!
//! All of it follows from the time since it began. What it says of the plan is read off the predictions of the moment, and the
//! door is looked for: the one whose move changes a label most surely, so that it holds for other models too.

mod flip;

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use egui::Context;

use self::flip::{Dragged, Flip, find_flip};
use super::Session;
use crate::app::session::document::Opened;
use crate::app::session::jobs::{Kind, Wanted};
use crate::app::session::origin::bundled;
use crate::app::session::questions::Intent;
use crate::app::session::selection::Selection;
use crate::app::session::wishes::Wish;
use crate::base::wording::{count, sentence};
use crate::classify::why::Why;
use crate::draw::Fill;
use crate::edit;
use crate::geometry::{Bounds, Point, Vector};
use crate::labels::{Label, Schemes};
use crate::plan::titles::room_title;
use crate::plan::{ElementId, Meta, Plan, RoomId};
use crate::predict::{Marks, Predictor};

/// How long each part takes, in seconds.
const BEGINNING_S: f64 = 3.5;
const ROOM_S: f64 = 0.55;
const ALL_ROOMS_S: f64 = 1.5;
const REASON_S: f64 = 4.6;
const POINTING_S: f64 = 2.4;
const DRAGGING_S: f64 = 4.2;
const FLIPPED_S: f64 = 4.4;
const END_S: f64 = 5.0;

/// Rooms whose reasons are shown.
const REASONS: usize = 3;

/// The time between two frames where nobody looks, in seconds.
const STILL_FRAME_S: f64 = 0.5;

/// The demonstration.
pub(crate) struct Demo {
    /// The number of the document it is shown in.
    document: u64,
    school: Plan,
    /// The rooms in the order they are revealed.
    order: Vec<RoomId>,
    /// So many of them are there.
    revealed: usize,
    /// When it began, and the time since, in seconds.
    began_s: Option<f64>,
    pub(crate) time_s: f64,
    /// The rooms whose reasons are shown; chosen once all rooms are there.
    explained: Option<Vec<RoomId>>,
    /// The reason that is shown, with its room.
    why: Option<(RoomId, Arc<Why>)>,
    flip: Search,
    /// How far the drag has come, 0..=1; `None` before it.
    dragged: Option<f64>,
}

/// The search for a label that flips.
enum Search {
    Running(#[expect(dead_code, reason = "kept so that the job goes on")] Option<Wanted>),
    /// `None`: no label of the school flips.
    Found(Option<Box<Flip>>),
}

/// The part of the demonstration that is shown.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Act {
    Beginning,
    /// Rooms are revealed.
    Revealing,
    /// All rooms are there.
    Whole,
    /// The reason of the room with this index.
    Reason(usize),
    /// The thing to be dragged is pointed at.
    Pointing,
    /// It is dragged; the share of the way, 0..=1.
    Dragging(f64),
    Flipped,
    End,
    Over,
}

/// What is said of what is shown.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Caption {
    pub title: String,
    pub text: String,
    /// How far the demonstration has come, 0..=1.
    pub share: f64,
}

impl Session {
    /// Starts the demonstration in a plan of its own.
    pub(crate) fn start_demo(&mut self) {
        let Some(school) = unlabelled_school() else { return };
        let empty = edit::set_meta(&Plan::default(), school.meta().clone());
        let opened = Opened { storeys: vec![empty], ..Opened::untitled() };
        let before = self.documents;
        self.opening = None;
        self.request(Intent::Show(Box::new(opened)));
        let Some(document) = self.document.as_mut().filter(|document| document.number > before) else {
            return;
        };
        document.closes_rooms = false;
        let number = document.number;
        self.layers.fill = Fill::Prediction;
        self.predictor = Predictor::default();
        let bounds = school.bounds();
        // What is said stands below. Zooming to something leaves a third around it, which is too much here.
        let seen = Bounds::of([bounds.min - Vector::new(0.0, 0.3 * bounds.height()), bounds.max]);
        self.wishes.push(Wish::ZoomTo(seen.inflated(-0.17 * seen.width().max(seen.height()))));
        let (schemes, models, plan) = (self.schemes.clone(), self.models.clone(), school.clone());
        let kind = Kind::new("look for a label that flips").newest_of("demonstration").if_broken(|session| {
            if let Some(demo) = &mut session.demo {
                demo.flip = Search::Found(None);
            }
        });
        self.demo = Some(Demo {
            document: number,
            order: in_order(&school),
            school,
            revealed: 0,
            began_s: None,
            time_s: 0.0,
            explained: None,
            why: None,
            flip: Search::Running(None),
            dragged: None,
        });
        let job = self.jobs.start_wanted(kind, move |work| {
            let flip = find_flip(&plan, &schemes, &models, work);
            move |session: &mut Session, _: &_| {
                if let Some(demo) = &mut session.demo {
                    demo.flip = Search::Found(flip.map(Box::new));
                }
            }
        });
        if let Some(Demo { flip: search @ Search::Running(_), .. }) = &mut self.demo {
            *search = Search::Running(Some(job));
        }
    }

    /// Ends the demonstration; the plan stays as it is.
    pub(crate) fn stop_demo(&mut self) {
        if let Some(demo) = self.demo.take() {
            self.selection = Selection::of(None);
            self.status = match demo.revealed {
                0 => "The demonstration has ended".to_owned(),
                _ => "The demonstration has ended; the plan is yours to try things on".to_owned(),
            };
        }
    }

    /// Brings the plan and the selection to where the demonstration is by now.
    pub(crate) fn play_demo(&mut self, context: &Context) {
        let now_s = context.input(|input| input.time);
        let Some(mut demo) = self.demo.take() else { return };
        if self.document.as_ref().is_none_or(|document| document.number != demo.document) {
            self.status = "The demonstration ended with its plan".to_owned();
            return;
        }
        let began_s = *demo.began_s.get_or_insert(now_s);
        demo.time_s = now_s - began_s;
        let act = demo.act();
        if act == Act::Over {
            self.demo = Some(demo);
            self.stop_demo();
            return;
        }
        self.reveal(&mut demo, act);
        self.explain_in(&mut demo, act);
        self.drag_in(&mut demo, act);
        self.demo = Some(demo);
        match self.jobs.is_inline() {
            true => context.request_repaint_after_secs(STILL_FRAME_S as f32),
            false => context.request_repaint(),
        }
    }

    /// Reveals the rooms that are there by now.
    fn reveal(&mut self, demo: &mut Demo, act: Act) {
        let wanted = match act {
            Act::Beginning => 0,
            Act::Revealing => ((demo.time_s - BEGINNING_S) / ROOM_S).floor() as usize + 1,
            _ => demo.order.len(),
        };
        let Some(document) = &mut self.document else { return };
        while demo.revealed < wanted.min(demo.order.len()) {
            demo.revealed += 1;
            let is_all = demo.revealed == demo.order.len();
            let plan = if is_all { demo.school.clone() } else { demo.part() };
            let last = demo.school.room(demo.order[demo.revealed - 1]).map(room_title).unwrap_or_default();
            document.history.push(format!("Reveal {last}"), plan.clone());
            // It is nobody's work that could be lost.
            document.stands_in_file(Some(plan), None);
        }
    }

    /// Chooses rooms whose reasons are worth showing, and shows them.
    fn explain_in(&mut self, demo: &mut Demo, act: Act) {
        let Act::Reason(index) = act else {
            if demo.why.take().is_some() {
                self.selection = Selection::of(None);
            }
            return;
        };
        if demo.explained.is_none() {
            demo.explained = Some(self.worth_explaining());
        }
        let Some(&room) = demo.explained.as_ref().and_then(|rooms| rooms.get(index)) else { return };
        if demo.why.as_ref().is_none_or(|(of, _)| *of != room) {
            let units = self.units();
            let why = self.document.as_ref().and_then(|document| document.derived()?.why(room, units));
            demo.why = why.map(|why| (room, why));
            self.selection = Selection::of(Some(ElementId::Room(room)));
        }
    }

    /// The surest room of each label, of those labels that are surest.
    fn worth_explaining(&self) -> Vec<RoomId> {
        let Some(predictions) = self.predictions() else { return Vec::new() };
        let mut best: BTreeMap<Label, (f64, RoomId)> = BTreeMap::new();
        for (room, said) in predictions.network.rooms.iter().zip(&predictions.result.distributions) {
            let (label, sure) = said.likeliest();
            let best = best.entry(label).or_insert((sure, room.id));
            if sure > best.0 {
                *best = (sure, room.id);
            }
        }
        let mut rooms: Vec<(f64, RoomId)> = best.into_values().collect();
        rooms.sort_by(|p, q| q.0.total_cmp(&p.0).then(p.1.cmp(&q.1)));
        rooms.into_iter().take(REASONS).map(|(_, room)| room).collect()
    }

    /// Drags the door.
    fn drag_in(&mut self, demo: &mut Demo, act: Act) {
        let Search::Found(Some(flip)) = &demo.flip else { return };
        let share = match act {
            Act::Pointing => 0.0,
            Act::Dragging(share) => share,
            Act::Flipped | Act::End => 1.0,
            _ => return,
        };
        self.selection = Selection::of((act != Act::End).then(|| flip.dragged.element()));
        if demo.dragged == Some(share) || (share == 0.0 && demo.dragged.is_none()) {
            return;
        }
        let Some(document) = &mut self.document else { return };
        if let Some(plan) = flip.dragged.apply(&demo.school, share) {
            // One step, however many frames.
            if demo.dragged.is_some() {
                document.history.undo();
            }
            document.history.push("Drag in the demonstration", plan.clone());
            document.stands_in_file(Some(plan), None);
            demo.dragged = Some(share);
        }
    }

    /// What is marked on the plan for the reason that is told just now.
    pub(crate) fn demo_evidence(&self) -> Option<Marks> {
        let demo = self.demo.as_ref()?;
        let (room, why) = demo.why.as_ref()?;
        let point = why.points.get(demo.point_of(why))?;
        Some(self.predictions()?.marks(*room, &point.on_plan))
    }

    /// What is said just now.
    pub(crate) fn demo_caption(&self) -> Option<Caption> {
        let demo = self.demo.as_ref()?;
        let share = (demo.time_s / demo.length_s()).clamp(0.0, 1.0);
        let name = |room: RoomId| demo.school.room(room).map(room_title).unwrap_or_default();
        let (title, text) = match demo.act() {
            Act::Beginning => (
                "A school that nobody has labelled".to_owned(),
                "Enfilade looks at a floor plan room by room: its area, its shape, its doors and where they lead. Nobody \
                 tells it what the rooms are for."
                    .to_owned(),
            ),
            Act::Revealing if demo.revealed * 2 < demo.order.len() => (
                "Each room gets a label as soon as it is drawn".to_owned(),
                "The colour is the label, fainter where it is unsure. The more of the building is known, the better each \
                 room can be told: labels change as others appear."
                    .to_owned(),
            ),
            Act::Revealing => (
                "The kind of building is found as well".to_owned(),
                "The bar weighs what this could be after every change, by the number of rooms, their areas and their doors. \
                 It decides which models label the rooms."
                    .to_owned(),
            ),
            Act::Whole => {
                let rooms = self.predictions().map_or(0, |predictions| predictions.network.rooms.len());
                ("All rooms are labelled".to_owned(), format!("{}, none labelled by a person.", sentence(&count(rooms, "room"))))
            }
            Act::Reason(_) => match &demo.why {
                Some((room, why)) => (
                    format!("Why {} is a {}", name(*room), why.label),
                    why.points.get(demo.point_of(why)).map_or_else(|| why.conclusion.clone(), |point| format!("{}.", sentence(&point.seen))),
                ),
                None => (String::new(), String::new()),
            },
            act @ (Act::Pointing | Act::Dragging(_) | Act::Flipped) => {
                let Search::Found(Some(flip)) = &demo.flip else { return None };
                let thing = match flip.dragged {
                    Dragged::Door { .. } => "door",
                    Dragged::Wall { .. } => "wall",
                };
                let (before, after) = (flip.changed.before.0, flip.changed.after.0);
                let room = name(flip.changed.room);
                match act {
                    Act::Flipped => (
                        format!("{room} is a {after} now"),
                        format!(
                            "It was a {before}, {:.0} % sure; it is a {after}, {:.0} % sure. Every label is worked out again \
                             after every change.",
                            100.0 * flip.changed.before.1,
                            100.0 * flip.changed.after.1
                        ),
                    ),
                    _ => (
                        format!("Now one {thing} moves"),
                        format!("Watch {room}, a {before} so far. Labels follow while the {thing} is dragged."),
                    ),
                }
            }
            Act::End | Act::Over => (
                "The plan is yours".to_owned(),
                "Drag a door, delete a wall, pick a room to read why it has its label, or accept the labels. Then open a \
                 plan of your own."
                    .to_owned(),
            ),
        };
        Some(Caption { title, text, share })
    }

    /// The room that flips, with the labels before and now, while that is shown.
    pub(crate) fn demo_flip(&self) -> Option<(RoomId, Label, Label)> {
        let demo = self.demo.as_ref()?;
        let Search::Found(Some(flip)) = &demo.flip else { return None };
        let is_shown = matches!(demo.act(), Act::Pointing | Act::Dragging(_) | Act::Flipped);
        let now = self.predictions()?.label(flip.changed.room)?;
        is_shown.then_some((flip.changed.room, flip.changed.before.0, now))
    }

    /// Where the hand is that drags, and whether it presses.
    pub(crate) fn demo_hand(&self) -> Option<(Point, bool)> {
        let demo = self.demo.as_ref()?;
        let Search::Found(Some(flip)) = &demo.flip else { return None };
        match demo.act() {
            Act::Pointing => Some((flip.dragged.held(0.0), false)),
            Act::Dragging(share) => Some((flip.dragged.held(share), true)),
            Act::Flipped => Some((flip.dragged.held(1.0), false)),
            _ => None,
        }
    }
}

impl Demo {
    /// The rooms that are there, as a plan.
    fn part(&self) -> Plan {
        let rooms: BTreeSet<ElementId> =
            self.order.iter().take(self.revealed).map(|&room| ElementId::Room(room)).collect();
        let part = edit::fragment(&self.school, &rooms).unwrap_or_default();
        edit::set_meta(&part, self.school.meta().clone())
    }

    fn reasons_s(&self) -> f64 {
        self.explained.as_ref().map_or(REASONS, Vec::len) as f64 * REASON_S
    }

    fn has_flip(&self) -> bool {
        !matches!(self.flip, Search::Found(None))
    }

    fn length_s(&self) -> f64 {
        let drag_s = if self.has_flip() { POINTING_S + DRAGGING_S + FLIPPED_S } else { 0.0 };
        BEGINNING_S + ROOM_S * self.order.len() as f64 + ALL_ROOMS_S + self.reasons_s() + drag_s + END_S
    }

    /// The part that is shown now.
    fn act(&self) -> Act {
        let mut left_s = self.time_s;
        let mut passed = |part_s: f64| {
            let is_past = left_s >= part_s;
            if is_past {
                left_s -= part_s;
            }
            is_past
        };
        if !passed(BEGINNING_S) {
            return Act::Beginning;
        }
        if !passed(ROOM_S * self.order.len() as f64) {
            return Act::Revealing;
        }
        if !passed(ALL_ROOMS_S) {
            return Act::Whole;
        }
        if !passed(self.reasons_s()) {
            return Act::Reason((left_s / REASON_S) as usize);
        }
        if self.has_flip() {
            if !passed(POINTING_S) {
                return Act::Pointing;
            }
            if !passed(DRAGGING_S) {
                // It starts and ends gently.
                let share = left_s / DRAGGING_S;
                return Act::Dragging(share * share * (3.0 - 2.0 * share));
            }
            if !passed(FLIPPED_S) {
                return Act::Flipped;
            }
        }
        if passed(END_S) { Act::Over } else { Act::End }
    }

    /// The point of a reason that is told now: the first for half the time, then the second.
    fn point_of(&self, why: &Why) -> usize {
        let since_s = self.time_s - BEGINNING_S - ROOM_S * self.order.len() as f64 - ALL_ROOMS_S;
        let is_late = (since_s / REASON_S).fract() >= 0.5;
        usize::from(is_late && why.points.len() > 1)
    }
}

/// The bundled school without its labels, functions and typology.
pub(crate) fn unlabelled_school() -> Option<Plan> {
    let (_, school) = bundled().iter().find(|(name, _)| name.starts_with("school"))?;
    let bare = school.rooms().try_fold(school.clone(), |plan, (id, _)| {
        let plan = edit::set_function(&plan, id, "")?;
        edit::set_label(&plan, id, None)
    });
    let bare = bare.ok()?;
    let meta = Meta { name: "A school, not labelled".to_owned(), typology: None, ..bare.meta().clone() };
    Some(edit::set_meta(&bare, meta))
}

/// The rooms from the one with most doors outwards, each beside one that is there; those that no door leads to come last.
fn in_order(plan: &Plan) -> Vec<RoomId> {
    let analysis = crate::features::analyse(plan, &Schemes::bundled(), crate::features::NeighbourLabels::True);
    let graph = &analysis.graph;
    let doors = |index: usize| graph.of_room(index).len();
    let rooms = analysis.shapes.all();
    let mut waiting: Vec<usize> = (0..rooms.len()).collect();
    waiting.sort_by_key(|&index| (std::cmp::Reverse(doors(index)), rooms[index].id));
    let mut order: Vec<usize> = Vec::new();
    let mut seen: BTreeSet<usize> = BTreeSet::new();
    for start in waiting {
        if !seen.insert(start) {
            continue;
        }
        let first = order.len();
        order.push(start);
        let mut next = first;
        while let Some(&room) = order.get(next) {
            next += 1;
            let mut beside: Vec<usize> = analysis
                .neighbours(rooms[room].id)
                .filter_map(|(_, joint)| analysis.shapes.index_of(joint.room()?))
                .filter(|other| !seen.contains(other))
                .collect();
            // Along the corridor, one after the other.
            beside.sort_by(|&p, &q| {
                let (p, q) = (rooms[p].bounds.center(), rooms[q].bounds.center());
                p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y))
            });
            order.extend(beside.into_iter().filter(|&other| seen.insert(other)));
        }
    }
    order.into_iter().map(|index| rooms[index].id).collect()
}
