//! Tools: what the pointer does on the canvas. One file each, one line in [`TOOLS`].
//!
//! A tool is a state machine. It sees what the pointer does, already snapped, and answers with calls of
//! commands: what is drawn by hand is what a script draws. Between two calls it only shows a preview.

mod calibrate;
mod cut_out;
mod fill;
mod measure;
mod number;
mod opening;
mod paste;
mod path;
mod rectangle;
mod room;
mod select;
mod split;
mod straighten;
mod typing;
mod walls;

use std::sync::Arc;

use egui::{Context, CursorIcon, Event, Key, Modifiers};

pub(super) use crate::app::paint::preview::{Preview, paint_snap, tag};
use path::Path;
pub(super) use select::{REACH_PX, hit};
pub(super) use typing::Typed;

use super::commands::points_word;
use crate::app::paint::places::canvas_id;
use crate::app::session::{document::Derived, layers::LayerSettings, selection::Selection};
use crate::app::state::App;
use crate::base::units::Units;
use crate::geometry::{Bounds, Point, Segment, Vector};
use crate::plan::{DEFAULT_DOOR_WIDTH_M, DEFAULT_WALL_THICKNESS_M, Plan};
use crate::snapping::{self, PlanIndex, Query, Snap};
use crate::topology::Gap;

/// A tool as the table has it.
pub(crate) struct Entry {
    /// Its word; the command that takes it up is `tool-…`.
    pub id: &'static str,
    make: fn() -> Box<dyn Tool>,
}

/// Every tool. The first one is in the hand when nothing else is.
pub(crate) const TOOLS: &[Entry] = &[
    select::ENTRY,
    walls::ENTRY,
    rectangle::ENTRY,
    room::ENTRY,
    fill::ENTRY,
    split::ENTRY,
    cut_out::ENTRY,
    opening::DOOR,
    opening::DOUBLE_DOOR,
    opening::PASSAGE,
    opening::WINDOW,
    measure::ENTRY,
    number::ENTRY,
    paste::ENTRY,
    calibrate::BY_LENGTH,
    calibrate::BY_DOOR,
    straighten::ENTRY,
];

/// A command to run: its id and its arguments.
pub(crate) type Call = (&'static str, Vec<String>);

/// What is drawn next, and how.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct DrawOptions {
    /// Thickness of new walls in metres.
    pub thickness_m: f64,
    /// Whether walls are drawn along the boundaries of new rooms.
    pub walls_with_rooms: bool,
    /// Whether new rooms take what other rooms cover too.
    pub over_rooms: bool,
    /// Clear width of new openings in metres.
    pub opening_width_m: f64,
    /// Arcs are drawn as chords that stay this near to them, in metres.
    pub arc_tolerance_m: f64,
    /// Whether lines keep to right angles unless Shift is held.
    pub right_angles: bool,
    /// Whether corners, walls and alignments attract.
    pub snaps: bool,
    /// Whether the grid attracts.
    pub snaps_to_grid: bool,
}

/// A hand's breadth of a curtain wall's facets: 2 cm is what a drawing at 1:100 shows as the width of a line.
const ARC_TOLERANCE_M: f64 = 0.02;

impl DrawOptions {
    /// The call that draws a room with these corners.
    fn draw_room(&self, corners: &[Point]) -> Call {
        let thickness_m = if self.walls_with_rooms { self.thickness_m } else { 0.0 };
        // Along rooms that are there the boundary need not be drawn exactly: it may run through them.
        let space = if self.over_rooms { "exact" } else { "free" };
        ("draw-room", vec![points_word(corners), space.to_owned(), thickness_m.to_string()])
    }
}

impl Default for DrawOptions {
    fn default() -> Self {
        Self {
            thickness_m: DEFAULT_WALL_THICKNESS_M,
            walls_with_rooms: true,
            over_rooms: false,
            opening_width_m: DEFAULT_DOOR_WIDTH_M,
            arc_tolerance_m: ARC_TOLERANCE_M,
            right_angles: true,
            snaps: true,
            snaps_to_grid: true,
        }
    }
}

/// What a tool sees.
pub(crate) struct Scope<'a> {
    pub plan: &'a Plan,
    /// What follows from the plan, or from an earlier one while that is worked out anew.
    pub derived: Option<&'a Arc<Derived>>,
    /// The doorways left open in the plan's walls; none while they are looked for anew.
    pub gaps: &'a [Gap],
    pub selection: &'a Selection,
    pub options: &'a DrawOptions,
    pub layers: &'a LayerSettings,
    /// What was copied.
    pub copied: Option<&'a Plan>,
    pub units: Units,
    /// Where the pointer is in the plan, in metres; the last place when it has left the canvas.
    pub pointer: Point,
    /// What it snaps to.
    pub snap: Snap,
    pub px_per_m: f64,
    pub modifiers: Modifiers,
}

impl Scope<'_> {
    /// The point that is meant.
    pub(super) fn at(&self) -> Point {
        self.snap.point
    }

    /// A length on the screen, in metres of the plan.
    pub(super) fn metres(&self, px: f64) -> f64 {
        px / self.px_per_m
    }
}

/// What a person does.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Input {
    /// The primary button was pressed and let go at one place.
    Click,
    /// It was pressed twice in quick succession; follows a click.
    DoubleClick,
    /// The secondary button was clicked.
    SecondaryClick,
    /// It was pressed here and the pointer has moved on: what it snapped to then, and the place itself.
    DragStart { at: Point, pointer: Point },
    /// The pointer moves while the button is down.
    Drag,
    /// The button was let go after a drag.
    Drop,
    /// Enter, with nothing typed.
    Enter,
    /// Enter or Tab behind something typed.
    Typed(Typed),
    /// A letter that the tool asks for.
    Key(Key),
    /// Escape.
    Escape,
}

/// Where lines are measured from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Anchor {
    pub from: Point,
    /// The direction of the line drawn before.
    pub along: Option<Vector>,
    /// Whether the line from here keeps to right angles.
    pub right_angles: bool,
}

/// What can be typed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Typing {
    /// A length, or a length and an angle: '3.2', '3.2<45'.
    Length,
    /// Two sides: '4x3'.
    Size,
    /// A width.
    Width,
}

/// What undo does to a tool at work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum TakenBack {
    /// Nothing: the plan's last step is undone.
    Nothing,
    /// A corner that is not part of the plan yet.
    Corner,
    /// A corner that is: the plan's last step is undone as well.
    CornerAndStep,
}

/// A state machine.
pub(super) trait Tool {
    /// What a person does, and the commands that follow.
    fn take(&mut self, input: Input, scope: &Scope<'_>) -> Vec<Call>;

    /// What can be done now, for the status line.
    fn hint(&self, scope: &Scope<'_>) -> String;

    /// What is in the making.
    fn preview(&self, scope: &Scope<'_>, preview: &mut Preview);

    fn cursor(&self, _scope: &Scope<'_>) -> CursorIcon {
        CursorIcon::Crosshair
    }

    /// The corners in the making, where it draws one after the other: what follows is then as they say.
    fn path(&self) -> Option<&Path> {
        None
    }

    fn path_mut(&mut self) -> Option<&mut Path> {
        None
    }

    /// Whether something is begun that Escape drops.
    fn is_busy(&self) -> bool {
        self.path().is_some_and(|path| !path.is_empty())
    }

    /// Whether places snap.
    fn snaps(&self) -> bool {
        true
    }

    fn anchor(&self) -> Option<Anchor> {
        self.path()?.anchor()
    }

    /// Points in the making that attract like corners.
    fn points(&self) -> Vec<Point> {
        Vec::new()
    }

    /// What can be typed now.
    fn typing(&self) -> Option<Typing> {
        self.path().filter(|path| !path.is_empty()).map(|_| Typing::Length)
    }

    /// Letters that it takes while it is busy.
    fn keys(&self) -> &'static [Key] {
        &[]
    }

    /// The plan did not take what it called for last.
    fn was_refused(&mut self) {}

    fn take_back(&mut self) -> TakenBack {
        let was_there = self.path_mut().is_some_and(|path| path.take_back().0);
        if was_there { TakenBack::Corner } else { TakenBack::Nothing }
    }
}

/// What places can snap to.
#[derive(Clone, Copy)]
pub(crate) struct Ground<'a> {
    pub index: Option<&'a PlanIndex>,
    pub seen: Bounds,
    pub px_per_m: f64,
    pub modifiers: Modifiers,
    /// Guide lines, and lines of the storey below.
    pub lines: &'a [Segment],
    /// Corners of the storey below.
    pub points: &'a [Point],
    pub options: &'a DrawOptions,
    /// Spacing of the grid that is shown, in metres; `None` where it does not attract.
    pub grid_m: Option<f64>,
    /// Whether the pointer is on the canvas.
    pub is_seen: bool,
}

/// The tool in the hand.
pub(crate) struct Toolbox {
    entry: &'static Entry,
    tool: Box<dyn Tool>,
    /// What has been typed for the tool.
    pub typed: String,
    /// Keys that were pressed since the canvas was last shown.
    pending: Vec<Input>,
    /// How often Tab was pressed here, for the next thing to snap to.
    cycled: usize,
    cycled_at: Option<Point>,
    /// Whether something attracts the pointer now: Tab goes on to the next.
    attracts: bool,
    /// What the tool said last.
    pub hint: String,
    /// What is drawn next, and how.
    pub options: DrawOptions,
}

impl Default for Toolbox {
    fn default() -> Self {
        let entry = &TOOLS[0];
        Self {
            entry,
            tool: (entry.make)(),
            typed: String::new(),
            pending: Vec::new(),
            cycled: 0,
            cycled_at: None,
            attracts: false,
            hint: String::new(),
            options: DrawOptions::default(),
        }
    }
}

/// Tab starts anew when the pointer has moved so far, in points.
const SAME_PLACE_PX: f64 = 4.0;

/// Something attracts from this far away, in points: the length of a finger's tremble, and what CAD
/// programs take (AutoCAD's aperture is 10 pixels).
const SNAP_RADIUS_PX: f64 = 10.0;

/// The grid that attracts is never finer than this, in points.
const FINEST_GRID_PX: f64 = 8.0;

impl Toolbox {
    /// Takes up a tool by its word.
    pub(super) fn take_up(&mut self, id: &str) {
        if let Some(entry) = TOOLS.iter().find(|entry| entry.id == id) {
            self.entry = entry;
            self.drop_work();
        }
    }

    /// Drops what is in the making.
    pub(super) fn drop_work(&mut self) {
        self.tool = (self.entry.make)();
        self.typed.clear();
        self.pending.clear();
        self.cycled = 0;
        self.attracts = false;
        self.hint.clear();
    }

    /// Whether this tool is in the hand.
    pub(super) fn is(&self, id: &str) -> bool {
        self.entry.id == id
    }

    pub(super) fn is_selecting(&self) -> bool {
        self.is(TOOLS[0].id)
    }

    pub(super) fn tool(&self) -> &dyn Tool {
        self.tool.as_ref()
    }

    pub(super) fn tool_mut(&mut self) -> &mut dyn Tool {
        self.tool.as_mut()
    }

    /// The word of the tool in the hand.
    pub(super) fn id(&self) -> &'static str {
        self.entry.id
    }

    pub(super) fn take_back(&mut self) -> TakenBack {
        self.typed.clear();
        self.tool.take_back()
    }

    /// Takes the keys that are for the tool out of the input, and gives what is for the clipboard.
    pub(super) fn take_keys(&mut self, context: &Context, units: Units) -> Vec<Event> {
        let typing = self.tool.typing();
        let is_busy = self.tool.is_busy();
        let letters = if is_busy { self.tool.keys() } else { &[] };
        let cycled_before = self.cycled;
        let (typed, pending, cycled) = (&mut self.typed, &mut self.pending, &mut self.cycled);
        // Tab is for the next thing to snap to only where something attracts a drawing tool, and the keyboard
        // is not in a panel.
        let has_keyboard = context.memory(|memory| memory.focused().is_none_or(|id| id == canvas_id()));
        let takes_tab = self.entry.id != TOOLS[0].id && self.attracts && has_keyboard;
        let mut clipboard = Vec::new();
        context.input_mut(|input| {
            input.events.retain(|event| match event {
                Event::Copy | Event::Cut | Event::Paste(_) => {
                    clipboard.push(event.clone());
                    false
                }
                Event::Text(text) if typing.is_some() => {
                    let is_for_tool = typing::is_part(typed, text);
                    if is_for_tool {
                        typed.push_str(text);
                    }
                    !is_for_tool
                }
                Event::Key { key, pressed: true, modifiers, .. } if modifiers.is_none() || modifiers.shift_only() => {
                    match key {
                        Key::Backspace if !typed.is_empty() => {
                            typed.pop();
                            false
                        }
                        Key::Escape if !typed.is_empty() => {
                            typed.clear();
                            false
                        }
                        Key::Escape if is_busy => {
                            pending.push(Input::Escape);
                            false
                        }
                        Key::Enter if !typed.is_empty() => {
                            if let Some(value) = typing.and_then(|typing| typing::read(typing, typed, units)) {
                                typed.clear();
                                pending.push(Input::Typed(value));
                            }
                            false
                        }
                        Key::Enter if is_busy => {
                            pending.push(Input::Enter);
                            false
                        }
                        Key::Tab if takes_tab => {
                            *cycled += 1;
                            false
                        }
                        key if letters.contains(key) && typed.is_empty() => {
                            pending.push(Input::Key(*key));
                            false
                        }
                        // Their text is taken; a shortcut they are not.
                        key if typing.is_some() && typing::is_key(typed, *key) => false,
                        _ => true,
                    }
                }
                _ => true,
            });
        });
        if self.cycled != cycled_before {
            // The keyboard stays where it is.
            context.memory_mut(|memory| memory.move_focus(egui::FocusDirection::None));
        }
        clipboard
    }

    /// The keys taken since the canvas was last shown.
    pub(super) fn take_pending(&mut self) -> Vec<Input> {
        std::mem::take(&mut self.pending)
    }

    /// What a place snaps to now.
    pub(super) fn snap(&mut self, ground: &Ground<'_>, pointer: Point) -> Snap {
        let &Ground { index, seen, px_per_m, modifiers, lines, points, options, grid_m, is_seen } = ground;
        let empty = PlanIndex::default();
        let anchor = self.tool.anchor();
        if self.cycled_at.is_none_or(|at| at.distance(pointer) * px_per_m > SAME_PLACE_PX) {
            self.cycled = 0;
        }
        if self.cycled == 0 {
            self.cycled_at = Some(pointer);
        }
        let is_free = modifiers.alt || !self.tool.snaps();
        let points: Vec<Point> = self.tool.points().into_iter().chain(points.iter().copied()).collect();
        let query = Query {
            pointer,
            radius_m: SNAP_RADIUS_PX / px_per_m,
            seen,
            from: anchor.map(|anchor| anchor.from),
            along: anchor.and_then(|anchor| anchor.along),
            right_angles: anchor.is_some_and(|anchor| anchor.right_angles)
                && options.right_angles
                && !modifiers.shift
                && self.tool.snaps(),
            objects: options.snaps && !is_free,
            grid_m: grid_m
                .filter(|_| options.snaps_to_grid && !is_free)
                .map(|shown_m| attracting_grid_m(shown_m, px_per_m)),
            points: &points,
            lines,
        };
        let mut found = snapping::candidates(index.unwrap_or(&empty), &query);
        // The last one is the place itself.
        self.attracts = is_seen && self.tool.snaps() && found.len() > 1;
        found.swap_remove(self.cycled % found.len())
    }
}

/// The grid that attracts: a tenth, a half or the whole of what is shown, as fine as can still be aimed
/// at.
fn attracting_grid_m(shown_m: f64, px_per_m: f64) -> f64 {
    let finest_m = FINEST_GRID_PX / px_per_m;
    let mut spacing_m = shown_m / 100.0;
    for factor in [5.0, 2.0].into_iter().cycle().take(24) {
        if spacing_m >= finest_m {
            break;
        }
        spacing_m *= factor;
    }
    spacing_m
}

impl App {
    /// Takes the keys that are for the tool in the hand.
    pub(super) fn take_tool_keys(&mut self, context: &Context) {
        let is_typing = self.was_typing || context.text_edit_focused();
        let is_covered =
            self.session.question.is_some() || self.dialogs.is_any_open() || egui::Popup::is_any_open(context);
        if is_typing || is_covered || self.session.document.is_none() {
            return;
        }
        let units = self.units();
        for event in self.tools.take_keys(context, units) {
            match event {
                Event::Copy => {
                    self.run_command("copy", context);
                }
                Event::Cut => {
                    self.run_command("cut", context);
                }
                Event::Paste(text) => {
                    self.take_pasted(&text);
                    self.run_command("paste", context);
                }
                _ => {}
            }
        }
    }

    /// Puts the tool away: what was begun is dropped first, then selecting is taken up again.
    pub(super) fn put_tool_away(&mut self) {
        if self.tools.tool().is_busy() {
            self.tools.drop_work();
        } else {
            self.tools.take_up(TOOLS[0].id);
        }
    }
}

/// A point as a command's word.
pub(crate) fn word(point: Point) -> String {
    points_word(&[point])
}

/// Places and lengths of a picture as a command's words: a hundredth of a millimetre of the plan is less
/// than any pixel.
fn picture_words<const N: usize>(values: [f64; N]) -> Vec<String> {
    values.map(|value| ((value * 1e5).round() / 1e5).to_string()).to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_grid_that_attracts_can_be_aimed_at() {
        for px_per_m in [0.5, 3.0, 20.0, 50.0, 333.0, 2000.0] {
            let spacing_m = attracting_grid_m(1.0, px_per_m);
            assert!((FINEST_GRID_PX..=FINEST_GRID_PX * 5.0).contains(&(spacing_m * px_per_m)) || spacing_m == 0.01);
        }
        assert_eq!(attracting_grid_m(1.0, 50.0), 0.5);
    }

    #[test]
    fn every_tool_has_a_word_of_its_own() {
        let mut ids: Vec<&str> = TOOLS.iter().map(|entry| entry.id).collect();
        ids.sort_unstable();
        ids.dedup();
        assert_eq!(ids.len(), TOOLS.len());
    }
}
