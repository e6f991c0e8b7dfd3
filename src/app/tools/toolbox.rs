//! The active tool, the text typed for it, and snapping.

use egui::{Context, Event, Key};

use super::TOOLS;
use super::input::{DrawOptions, Ground, Input};
use super::tool::{Entry, TakenBack, Tool};
use super::typing;
use crate::app::paint::places::canvas_id;
use crate::base::units::Units;
use crate::geometry::Point;
use crate::snapping::{self, PlanIndex, Query, Snap};

/// The active tool and its surroundings.
pub(crate) struct Toolbox {
    entry: &'static Entry,
    tool: Box<dyn Tool>,
    /// The text typed for the tool.
    pub typed: String,
    /// Keys that were pressed since the canvas was last shown.
    pending: Vec<Input>,
    /// How often Tab was pressed here, to cycle through snap targets.
    cycled: usize,
    cycled_at: Option<Point>,
    /// Whether the pointer is snapped to something now: Tab then goes to the next.
    attracts: bool,
    /// The tool's last hint.
    pub hint: String,
    /// The options for drawing.
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

/// Tab starts over when the pointer has moved this far, in points.
const SAME_PLACE_PX: f64 = 4.0;

/// Snapping radius in points: about as much as a finger trembles, and the usual value in CAD programs
/// (AutoCAD's aperture is 10 pixels).
const SNAP_RADIUS_PX: f64 = 10.0;

/// The minimum spacing of the snapping grid, in points.
const FINEST_GRID_PX: f64 = 8.0;

impl Toolbox {
    /// Activates a tool by its id.
    pub(crate) fn take_up(&mut self, id: &str) {
        if let Some(entry) = TOOLS.iter().find(|entry| entry.id == id) {
            self.entry = entry;
            self.drop_work();
        }
    }

    /// Cancels the work in progress.
    pub(crate) fn drop_work(&mut self) {
        self.tool = (self.entry.make)();
        self.typed.clear();
        self.pending.clear();
        self.cycled = 0;
        self.attracts = false;
        self.hint.clear();
    }

    /// Whether this tool is active.
    pub(crate) fn is(&self, id: &str) -> bool {
        self.entry.id == id
    }

    pub(crate) fn is_selecting(&self) -> bool {
        self.is(TOOLS[0].id)
    }

    pub(crate) fn tool(&self) -> &dyn Tool {
        self.tool.as_ref()
    }

    pub(crate) fn tool_mut(&mut self) -> &mut dyn Tool {
        self.tool.as_mut()
    }

    /// The active tool's entry in the list.
    pub(crate) fn entry(&self) -> &'static Entry {
        self.entry
    }

    pub(crate) fn take_back(&mut self) -> TakenBack {
        self.typed.clear();
        self.tool.take_back()
    }

    /// Takes the keys that are for the tool out of the input, and gives what is for the clipboard.
    pub(crate) fn take_keys(&mut self, context: &Context, units: Units) -> Vec<Event> {
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
    pub(crate) fn take_pending(&mut self) -> Vec<Input> {
        std::mem::take(&mut self.pending)
    }

    /// What a position currently snaps to.
    pub(crate) fn snap(&mut self, ground: &Ground<'_>, pointer: Point) -> Snap {
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
        // The last one is the position itself.
        self.attracts = is_seen && self.tool.snaps() && found.len() > 1;
        found.swap_remove(self.cycled % found.len())
    }
}

/// The snapping grid: a tenth, a half or the whole of the visible spacing, as fine as one can still aim
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
}
