//! The active tool, the text typed for it, and snapping.

use egui::{Context, Event, Key};

use super::TOOLS;
use super::input::{DrawOptions, Ground, Input, Scope};
use super::tool::{Entry, TakenBack, Tool};
use super::typing;
use crate::app::paint::places::canvas_id;
use crate::base::units::Units;
use crate::geometry::Point;
use crate::snapping::{self, PlanIndex, Query, Snap, SnapKind};
use crate::store::Draft;

/// The active tool and its surroundings.
pub(crate) struct Toolbox {
    entry: &'static Entry,
    tool: Box<dyn Tool>,
    /// The text typed for the tool.
    pub typed: String,
    /// Why that is not taken; empty while nothing is wrong.
    pub refused: String,
    /// Keys that were pressed since the canvas was last shown.
    pending: Vec<Input>,
    /// How often Tab was pressed here, to cycle through snap targets.
    cycled: usize,
    cycled_at: Option<Point>,
    /// Where the last frame showed that a click would go.
    shown: Option<Point>,
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
            refused: String::new(),
            pending: Vec::new(),
            cycled: 0,
            cycled_at: None,
            shown: None,
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

/// How far alignment with far corners pulls over a picture, in points and in metres: its lines are what is meant, and
/// 5 cm is less than the wall of any of them.
const OVER_PICTURE_PX: f64 = 3.0;
const OVER_PICTURE_M: f64 = 0.05;

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
        self.clear_typed();
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

    /// What is half drawn, to be kept.
    pub(crate) fn draft(&self) -> Option<Draft> {
        let points: Vec<[f64; 2]> = self.tool.draft().into_iter().map(|point| [point.x, point.y]).collect();
        (!points.is_empty()).then(|| Draft { tool: self.entry.id.to_owned(), points })
    }

    /// Goes on with what was half drawn when the program ended.
    pub(crate) fn resume(&mut self, draft: Draft) {
        self.take_up(&draft.tool);
        if self.is(&draft.tool) {
            self.tool.resume(draft.points.into_iter().map(|[x, y]| Point::new(x, y)).collect());
        }
    }

    fn clear_typed(&mut self) {
        self.typed.clear();
        self.refused.clear();
    }

    pub(crate) fn take_back(&mut self) -> TakenBack {
        self.clear_typed();
        self.tool.take_back()
    }

    /// What can be done now, or why what was typed is not taken.
    pub(crate) fn hint(&self, scope: &Scope<'_>) -> String {
        if self.refused.is_empty() { self.tool.hint(scope) } else { self.refused.clone() }
    }

    /// Takes the keys that are for the tool out of the input, and gives what is for the clipboard.
    ///
    /// While something is drawn or typed every letter, figure and sign is for what is typed: none reaches a
    /// shortcut, and none is passed over.
    pub(crate) fn take_keys(&mut self, context: &Context, units: Units) -> Vec<Event> {
        // Tab is for the next thing to snap to only where something attracts a drawing tool, and the keyboard
        // is not in a panel.
        let has_keyboard = context.memory(|memory| memory.focused().is_none_or(|id| id == canvas_id()));
        let takes_tab = self.entry.id != TOOLS[0].id && self.attracts && has_keyboard;
        let was_typing = !self.typed.is_empty();
        let cycled_before = self.cycled;
        let mut clipboard = Vec::new();
        context.input_mut(|input| {
            input.events.retain(|event| match event {
                Event::Paste(text) if !self.typed.is_empty() => {
                    self.type_text(text.trim());
                    false
                }
                Event::Copy | Event::Cut | Event::Paste(_) => {
                    clipboard.push(event.clone());
                    false
                }
                Event::Text(text) => !self.takes_text(text),
                Event::Key { key, pressed: true, modifiers, .. } if modifiers.is_none() || modifiers.shift_only() => {
                    !self.takes_key(*key, units, takes_tab)
                }
                _ => true,
            });
        });
        if self.cycled != cycled_before || was_typing {
            // The keyboard stays where it is.
            context.memory_mut(|memory| memory.move_focus(egui::FocusDirection::None));
        }
        clipboard
    }

    /// Takes a text that was typed, where it is for the tool.
    fn takes_text(&mut self, text: &str) -> bool {
        if self.tool.typing().is_none() {
            return false;
        }
        if self.typed.is_empty() {
            let is_busy = self.tool.is_busy();
            // The text of a letter that the tool itself asks for, and of the key that moves the view.
            let is_letter = |key: &Key| key.name().eq_ignore_ascii_case(text);
            if text.trim().is_empty() || (is_busy && self.tool.keys().iter().any(is_letter)) {
                return is_busy;
            }
            if !is_busy && !typing::begins(text) {
                return false;
            }
        }
        self.type_text(text);
        true
    }

    fn type_text(&mut self, text: &str) {
        self.typed.push_str(text);
        self.refused.clear();
    }

    /// Takes a key that was pressed, where it is for the tool.
    fn takes_key(&mut self, key: Key, units: Units, takes_tab: bool) -> bool {
        let is_busy = self.tool.is_busy();
        let is_typed = !self.typed.is_empty();
        match key {
            Key::Backspace if is_typed => {
                self.typed.pop();
                self.refused.clear();
            }
            Key::Escape if is_typed => self.clear_typed(),
            Key::Escape if is_busy => self.pending.push(Input::Escape),
            Key::Enter | Key::Tab if is_typed => self.enter(key, units),
            Key::Enter if is_busy => self.pending.push(Input::Enter),
            Key::Tab if takes_tab => self.cycled += 1,
            key if is_busy && !is_typed && self.tool.keys().contains(&key) => self.pending.push(Input::Key(key)),
            // Their text is taken; a shortcut they are not.
            key if self.tool.typing().is_some() => {
                return if is_typed || is_busy { typing::writes(key) } else { typing::begins_by(key) };
            }
            // Nothing can be typed, but something is begun that another tool would drop.
            key => return self.tool.is_drawing() && typing::writes_letter(key),
        }
        true
    }

    /// Takes what was typed, or says why not.
    fn enter(&mut self, key: Key, units: Units) {
        let Some(typing) = self.tool.typing() else { return self.clear_typed() };
        if key == Key::Tab && typing::needs_other_side(typing, &self.typed) {
            self.typed.push('x');
            return;
        }
        match typing::read(typing, &self.typed, units) {
            Ok(value) => {
                self.clear_typed();
                self.pending.push(Input::Typed(value));
            }
            Err(why) => self.refused = why,
        }
    }

    /// What is understood of what was typed, as lengths are shown; empty where that is nothing yet.
    pub(crate) fn understood(&self, units: Units) -> String {
        self.tool.typing().map(|typing| typing::understood(typing, &self.typed, units)).unwrap_or_default()
    }

    /// The keys taken since the canvas was last shown.
    pub(crate) fn take_pending(&mut self) -> Vec<Input> {
        std::mem::take(&mut self.pending)
    }

    /// What a position currently snaps to.
    pub(crate) fn snap(&mut self, ground: &Ground<'_>, pointer: Point) -> Snap {
        let &Ground { index, seen, px_per_m, modifiers, lines, points, options, grid_m, is_seen, .. } = ground;
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
            alignment_m: match ground.is_over_picture {
                true => (OVER_PICTURE_PX / px_per_m).min(OVER_PICTURE_M),
                false => SNAP_RADIUS_PX / px_per_m,
            },
            seen,
            from: anchor.map(|anchor| anchor.from),
            along: anchor.and_then(|anchor| anchor.along),
            right_angles: anchor.is_some_and(|anchor| anchor.right_angles)
                && options.right_angles
                && !modifiers.shift
                && self.tool.snaps(),
            objects: options.snaps && !is_free,
            faces: self.tool.faces(options),
            grid_m: grid_m
                .filter(|_| options.snaps_to_grid && !is_free)
                .map(|shown_m| attracting_grid_m(shown_m, px_per_m)),
            points: &points,
            lines,
        };
        let mut found = snapping::candidates(index.unwrap_or(&empty), &query);
        // The last one is the position itself.
        self.attracts = is_seen && self.tool.snaps() && found.len() > 1;
        let free = found.last().cloned();
        let snap = found.swap_remove(self.cycled % found.len());
        // What comes of something far away is taken only where it has been seen.
        let is_unseen = snap.kind == SnapKind::Alignment
            && ground.is_pressing
            && self.shown.is_none_or(|shown| shown.distance(snap.point) > 1e-9);
        if let Some(free) = free.filter(|_| is_unseen) {
            return free;
        }
        self.shown = Some(snap.point).filter(|_| is_seen);
        snap
    }
}

/// The snapping grid: a tenth, a half or the whole of the visible spacing, as fine as one can still aim
/// at.
pub(crate) fn attracting_grid_m(shown_m: f64, px_per_m: f64) -> f64 {
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
