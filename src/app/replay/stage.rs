//! A running script: its window, its folders, and its failures.

use super::fault::Fault;
use std::path::PathBuf;

use egui::{Modifiers, Pos2};

use super::folders::Folders;
use super::words::{did_you_mean, in_quotes};
use crate::app::offscreen::{Offscreen, OffscreenOptions, controls::Control};
use crate::geometry::Point;
use crate::plan::{Plan, RoomId};

/// The largest side of a window in physical pixels: a snapshot takes 256 MiB.
const MOST_PX_A_SIDE: f32 = 8192.0;

/// A running script.
pub(super) struct Stage<'a> {
    pub window: Offscreen,
    pub folders: &'a Folders,
    /// Whether results become the new references.
    pub is_updating: bool,
    pub snapshots: usize,
    /// The references written.
    pub updated: Vec<PathBuf>,
    /// What the hand did since it was last asked to be counted.
    pub gestures: Gestures,
    /// Whether settings and journals are kept.
    keeps_settings: bool,
    keeps_journal: bool,
}

/// What a hand does: clicks count one, double clicks two, drags two (pressing and letting go), turns of the wheel one;
/// each key counts one, also those held with others or with a click, and each character typed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Gestures {
    pub clicks: usize,
    pub keys: usize,
}

impl Gestures {
    pub(super) fn click(&mut self, clicks: usize, modifiers: Modifiers) {
        self.clicks += clicks;
        self.keys += held(modifiers);
    }

    pub(super) fn key(&mut self, modifiers: Modifiers) {
        self.keys += 1 + held(modifiers);
    }
}

/// How many modifier keys are held.
fn held(modifiers: Modifiers) -> usize {
    let Modifiers { alt, ctrl, shift, command, .. } = modifiers;
    [alt, ctrl || command, shift].into_iter().filter(|is_held| *is_held).count()
}

/// The file of the settings that a script keeps.
pub(super) const SETTINGS: &str = "settings.json";

impl<'a> Stage<'a> {
    pub(super) fn new(folders: &'a Folders, is_updating: bool) -> Self {
        let mut window = Offscreen::new(OffscreenOptions::default());
        window.name_paths_from(&folders.work);
        let gestures = Gestures::default();
        let (keeps_settings, keeps_journal) = (false, false);
        Self {
            window,
            folders,
            is_updating,
            snapshots: 0,
            updated: Vec::new(),
            gestures,
            keeps_settings,
            keeps_journal,
        }
    }

    /// Changes the window's size, scale or theme.
    ///
    /// # Errors
    /// When a snapshot of it would be too large.
    pub(super) fn set_options(&mut self, options: OffscreenOptions) -> Result<(), Fault> {
        let side_px = |side: u32| side as f32 * options.scale;
        if side_px(options.width).max(side_px(options.height)) > MOST_PX_A_SIDE {
            let OffscreenOptions { width, height, scale, .. } = options;
            return Err(Fault::new(format!(
                "a window of {width}x{height} at scale {scale} has more than {MOST_PX_A_SIDE} pixels a side"
            )));
        }
        self.window.set_options(options);
        Ok(())
    }

    /// Keeps journals, in the script's working folder.
    pub(super) fn keep_journal(&mut self) {
        self.keeps_journal = true;
        self.window.use_journal(&self.folders.work.join("journal"));
    }

    /// Keeps settings, in the script's working folder.
    pub(super) fn keep_settings(&mut self) {
        self.keeps_settings = true;
        self.window.use_settings(&self.folders.work.join(SETTINGS));
    }

    /// Ends the program as in a power cut, and restarts it.
    pub(super) fn crash(&mut self) {
        self.keeps_journal = true;
        self.start_anew();
    }

    /// Closes the window and starts the program again.
    ///
    /// # Errors
    /// When the window asks something before it closes.
    pub(super) fn restart(&mut self) -> Result<(), Fault> {
        self.window.ask_to_close();
        let settled = self.window.settle();
        settled.map_err(|error| Fault::new(error.to_string()))?;
        if !self.window.is_closed() {
            return Err(Fault::new("the window did not close").hint("answer its question first: answer discard, say"));
        }
        self.start_anew();
        Ok(())
    }

    fn start_anew(&mut self) {
        self.window = Offscreen::new(self.window.options());
        self.window.name_paths_from(&self.folders.work);
        if self.keeps_settings {
            self.keep_settings();
        }
        if self.keeps_journal {
            self.keep_journal();
        }
    }

    /// The open plan.
    ///
    /// # Errors
    /// When none is open.
    pub(super) fn plan(&self) -> Result<&Plan, Fault> {
        let hint = "open one first: open-sample dwelling, or open PATH";
        self.window.app().plan().ok_or_else(|| Fault::new("no plan is open").hint(hint))
    }

    /// The room with a name or an id; if several share the name, the Nth by id.
    ///
    /// # Errors
    /// When there is none, or several and no number selects one.
    pub(super) fn room(&self, name: &str, number: Option<usize>) -> Result<RoomId, Fault> {
        let plan = self.plan()?;
        if let Ok(id) = name.parse::<RoomId>()
            && plan.room(id).is_some()
        {
            return Ok(id);
        }
        let named: Vec<RoomId> = plan.rooms().filter(|(_, room)| room.name == name).map(|(id, _)| id).collect();
        match (named.as_slice(), number) {
            ([], _) => {
                let names = plan.rooms().map(|(_, room)| room.name.as_str()).filter(|name| !name.is_empty());
                Err(Fault::new(format!("the plan has no room {}", in_quotes(name))).hint(did_you_mean(name, names)))
            }
            ([room], None) => Ok(*room),
            (rooms, Some(number)) => rooms.get(number - 1).copied().ok_or_else(|| {
                Fault::new(format!("the plan has {} of the name {}", count(rooms.len(), "room"), in_quotes(name)))
            }),
            (rooms, None) => {
                let ids: Vec<String> = rooms.iter().map(RoomId::to_string).collect();
                let what = format!("the plan has {} rooms of the name {}", rooms.len(), in_quotes(name));
                Err(Fault::new(what).hint(format!("number them from 1, or use an id: {}", ids.join(", "))))
            }
        }
    }

    /// The control with a name; of several the first, or the Nth.
    ///
    /// # Errors
    /// When there is none.
    pub(super) fn control(&self, name: &str, number: Option<usize>) -> Result<Control, Fault> {
        let controls = self.window.controls();
        let found = controls.iter().filter(|control| control.name == name).nth(number.unwrap_or(1) - 1);
        found.cloned().ok_or_else(|| {
            let (what, hint) = match controls.iter().filter(|control| control.name == name).count() {
                0 => {
                    let names = controls.iter().map(|control| control.name.as_str()).filter(|name| !name.is_empty());
                    ("no control".to_owned(), did_you_mean(name, names))
                }
                seen => (format!("only {}", count(seen, "control")), String::new()),
            };
            let hint = if hint.is_empty() { "what a list has scrolled away is not there".to_owned() } else { hint };
            Fault::new(format!("the window shows {what} {}", in_quotes(name))).hint(hint)
        })
    }

    /// The screen position of a point of the plan.
    ///
    /// # Errors
    /// When no plan is open, or the point is out of sight.
    pub(super) fn plan_point_on_screen(&self, point: Point) -> Result<Pos2, Fault> {
        self.plan()?;
        let app = self.window.app();
        let place = app.screen_position(point.x, point.y);
        place.filter(|place| app.canvas_rect().is_some_and(|rect| rect.contains(*place))).ok_or_else(|| {
            Fault::new(format!("the point {:.2},{:.2} of the plan is out of sight", point.x, point.y))
                .hint("fit shows the whole plan; or write pixel X,Y")
        })
    }
}

/// A count with its noun.
pub(super) fn count(number: usize, thing: &str) -> String {
    format!("{number} {thing}{}", if number == 1 { "" } else { "s" })
}
