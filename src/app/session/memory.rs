//! What is remembered from one run of the program to the next, in the settings file: the theme, the window, the
//! panels, the files opened last, the last folder, and where each plan was looked at.
//!
//! Whatever of it cannot be understood is as if it had never been kept.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::Session;
use crate::app::session::jobs::Kind;
use crate::app::session::open_plans::PlanView;
use crate::app::session::origin::{Origin, absolute};
use crate::app::session::settings::Settings;
use crate::app::session::wishes::Wish;
use crate::geometry::{COORDINATE_LIMIT_M, Point};

/// How many files opened last are offered: a list that is read at a glance.
const MOST_RECENT: usize = 12;

/// How many plans' views are remembered.
const MOST_VIEWS: usize = 200;

/// The window's size and place on the screen, in logical pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct WindowPlace {
    pub size: [f32; 2],
    /// Its upper left corner; `None` where the system does not say.
    pub at: Option<[f32; 2]>,
    pub is_maximized: bool,
}

/// The sides that a remembered window may have, in logical pixels.
const SIDES: std::ops::RangeInclusive<f64> = 320.0..=16_384.0;

/// The zooms that a remembered view may have, in screen points per metre.
const SCALES: std::ops::RangeInclusive<f64> = 0.001..=1e4;

impl WindowPlace {
    /// Reads it from a settings file's text; `None` where there is none that makes sense.
    pub(crate) fn of_text(text: &str) -> Option<Self> {
        Self::of_value(serde_json::from_str::<Value>(text).ok()?.get("window")?)
    }

    fn of_value(value: &Value) -> Option<Self> {
        let number = |name: &str| value.get(name).and_then(Value::as_f64);
        let side = |name: &str| number(name).filter(|side| SIDES.contains(side)).map(|side| side as f32);
        let place = |name: &str| number(name).filter(|place| place.abs() <= *SIDES.end()).map(|place| place as f32);
        Some(Self {
            size: [side("width")?, side("height")?],
            at: place("x").zip(place("y")).map(|(x, y)| [x, y]),
            is_maximized: value.get("maximized").and_then(Value::as_bool).unwrap_or_default(),
        })
    }
}

impl Settings {
    /// The word of the theme chosen last.
    pub(crate) fn theme(&self) -> Option<&str> {
        self.value("theme")?.as_str()
    }

    pub(crate) fn set_theme(&mut self, word: &str) {
        self.set_value("theme", json!(word));
    }

    pub(crate) fn set_window(&mut self, place: WindowPlace) {
        let mut window = json!({"width": place.size[0], "height": place.size[1], "maximized": place.is_maximized});
        if let (Some([x, y]), Some(fields)) = (place.at, window.as_object_mut()) {
            fields.insert("x".to_owned(), json!(x));
            fields.insert("y".to_owned(), json!(y));
        }
        self.set_value("window", window);
    }

    /// Whether a panel was shown when last changed; `None` if it never was.
    pub(crate) fn is_panel_shown(&self, id: &str) -> Option<bool> {
        self.value("panels")?.get(id)?.as_bool()
    }

    pub(crate) fn set_panel_shown(&mut self, id: &str, is_shown: bool) {
        let mut panels = self.value("panels").and_then(Value::as_object).cloned().unwrap_or_default();
        panels.insert(id.to_owned(), json!(is_shown));
        self.set_value("panels", Value::Object(panels));
    }

    /// The files opened or saved last, the latest first.
    pub(crate) fn recent(&self) -> Vec<PathBuf> {
        let listed = self.value("recent").and_then(Value::as_array).into_iter().flatten();
        let paths = listed.filter_map(Value::as_str).filter(|path| !path.is_empty()).map(PathBuf::from);
        paths.take(MOST_RECENT).collect()
    }

    fn add_recent(&mut self, path: &Path) {
        let mut recent = self.recent();
        recent.retain(|other| other != path);
        recent.insert(0, path.to_owned());
        recent.truncate(MOST_RECENT);
        let paths: Vec<&str> = recent.iter().filter_map(|path| path.to_str()).collect();
        self.set_value("recent", json!(paths));
    }

    fn forget_recent(&mut self) {
        self.set_value("recent", json!([]));
    }

    /// The folder that a file was last chosen in.
    pub(crate) fn folder(&self) -> Option<PathBuf> {
        self.value("folder")?.as_str().map(PathBuf::from)
    }

    fn set_folder(&mut self, folder: &Path) {
        if let Some(folder) = folder.to_str() {
            self.set_value("folder", json!(folder));
        }
    }

    /// Whether what walls close becomes a room in a plan; `None` if that was never set.
    fn closes_rooms(&self, path: &str) -> Option<bool> {
        self.value("rooms_from_walls")?.get(path)?.as_bool()
    }

    fn set_closes_rooms(&mut self, path: &str, closes: bool) {
        let mut plans = self.value("rooms_from_walls").and_then(Value::as_object).cloned().unwrap_or_default();
        plans.shift_remove(path);
        plans.insert(path.to_owned(), json!(closes));
        while plans.len() > MOST_VIEWS {
            let Some(first) = plans.keys().next().cloned() else { break };
            plans.shift_remove(&first);
        }
        self.set_value("rooms_from_walls", Value::Object(plans));
    }

    /// Where a plan was looked at when it was last closed.
    fn view_of(&self, path: &str, storey: usize) -> Option<PlanView> {
        let views = self.value("views").and_then(Value::as_array)?;
        let view = views.iter().find(|view| is_view_of(view, path, storey))?;
        let number = |name: &str| view.get(name).and_then(Value::as_f64);
        let place = |name: &str| number(name).filter(|place| place.abs() <= COORDINATE_LIMIT_M);
        let px_per_m = number("px_per_m").filter(|px_per_m| SCALES.contains(px_per_m))?;
        Some((Point::new(place("x_m")?, place("y_m")?), px_per_m))
    }

    fn set_view_of(&mut self, path: &str, storey: usize, view: Option<PlanView>) {
        let mut views = self.value("views").and_then(Value::as_array).cloned().unwrap_or_default();
        views.retain(|view| !is_view_of(view, path, storey));
        if let Some((centre, px_per_m)) = view {
            let new = json!({"path": path, "storey": storey, "x_m": centre.x, "y_m": centre.y, "px_per_m": px_per_m});
            views.insert(0, new);
        }
        views.truncate(MOST_VIEWS);
        self.set_value("views", Value::Array(views));
    }
}

fn is_view_of(view: &Value, path: &str, storey: usize) -> bool {
    view.get("path").and_then(Value::as_str) == Some(path)
        && view.get("storey").and_then(Value::as_u64).unwrap_or_default() == storey as u64
}

/// The path under which something is remembered.
fn remembered(origin: &Origin) -> Option<(PathBuf, usize)> {
    let Origin::File { path, storey } = origin else { return None };
    Some((absolute(path), *storey))
}

impl Session {
    /// Remembers that a file was opened, or saved.
    pub(super) fn remember_opened(&mut self, origin: &Origin) {
        let Some((path, _)) = remembered(origin) else { return };
        self.settings.add_recent(&path);
        if let Some(folder) = path.parent() {
            self.settings.set_folder(folder);
        }
        self.missing.remove(&path);
        self.keep_settings();
    }

    /// Remembers the folder in which a file was chosen.
    pub(super) fn remember_folder(&mut self, path: &Path) {
        let path = absolute(path);
        if let Some(folder) = path.parent() {
            self.settings.set_folder(folder);
        }
    }

    /// Remembers where the plan shown is looked at.
    pub(crate) fn remember_view(&mut self) {
        if let Some(origin) = self.document.as_ref().map(|document| document.origin.clone()) {
            self.remember_view_of(&origin, self.view);
            self.keep_settings();
        }
    }

    /// The same of any plan; the settings are not written yet.
    pub(super) fn remember_view_of(&mut self, origin: &Origin, view: Option<PlanView>) {
        if let Some((path, storey)) = remembered(origin)
            && let Some(path) = path.to_str().filter(|_| self.settings.is_kept())
        {
            self.settings.set_view_of(path, storey, view);
        }
    }

    /// Looks at a plan that was opened as when it was last closed.
    pub(super) fn look_as_remembered(&mut self, origin: &Origin) {
        let remembered = remembered(origin).filter(|_| self.settings.is_kept());
        let view = remembered.and_then(|(path, storey)| self.settings.view_of(path.to_str()?, storey));
        if let Some((centre, px_per_m)) = view {
            self.wishes.push(Wish::LookAt { centre, px_per_m });
        }
    }

    /// Whether what walls close in the plan becomes a room.
    pub(crate) fn closes_rooms(&self) -> bool {
        self.document.as_ref().is_some_and(|document| document.closes_rooms)
    }

    pub(crate) fn set_closes_rooms(&mut self, closes: bool) {
        if let Some(document) = &mut self.document {
            document.closes_rooms = closes;
        }
        self.remember_closes_rooms();
    }

    /// Remembers whether walls become rooms in the plan, where it is in a file.
    pub(super) fn remember_closes_rooms(&mut self) {
        let Some(document) = &self.document else { return };
        let (closes, place) = (document.closes_rooms, remembered(&document.origin));
        if let Some(path) = place.as_ref().and_then(|(path, _)| path.to_str()).filter(|_| self.settings.is_kept()) {
            self.settings.set_closes_rooms(path, closes);
            self.keep_settings();
        }
    }

    /// Sets what is remembered of a plan that was opened.
    pub(super) fn set_as_remembered(&mut self) {
        let Some(document) = &mut self.document else { return };
        let place = remembered(&document.origin).filter(|_| self.settings.is_kept());
        let closes = place.and_then(|(path, _)| self.settings.closes_rooms(path.to_str()?));
        document.closes_rooms = closes.unwrap_or(document.closes_rooms);
    }

    /// Writes the settings, or says why they cannot be kept.
    pub(crate) fn keep_settings(&mut self) {
        if let Err(problem) = self.settings.write() {
            self.add_message(problem);
        }
    }

    /// Empties the list of files opened last.
    pub(crate) fn forget_recent(&mut self) {
        self.settings.forget_recent();
        self.keep_settings();
    }

    /// Looks which of the files opened last are not there.
    pub(crate) fn look_for_recent(&mut self) {
        let recent = self.settings.recent();
        self.jobs.start(Kind::new("look for the files opened last").newest_of("recent files"), move |_| {
            let missing = recent.into_iter().filter(|path| !path.exists()).collect();
            move |session: &mut Self, _: &_| session.missing = missing
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_window_that_makes_no_sense_is_as_none() {
        let place = |text: &str| WindowPlace::of_text(text);
        let good = r#"{"window": {"width": 1000, "height": 700.5, "x": -20, "y": 30, "maximized": true}}"#;
        let expected = WindowPlace { size: [1000.0, 700.5], at: Some([-20.0, 30.0]), is_maximized: true };
        assert_eq!(place(good), Some(expected));
        for wrong in [
            "",
            "{",
            "[]",
            r#"{"window": 3}"#,
            r#"{"window": {"width": 1000}}"#,
            r#"{"window": {"width": 0, "height": 0}}"#,
            r#"{"window": {"width": 1e300, "height": 700}}"#,
            r#"{"window": {"width": "wide", "height": 700}}"#,
        ] {
            assert_eq!(place(wrong), None, "{wrong}");
        }
        let nowhere = place(r#"{"window": {"width": 1000, "height": 700, "x": 1e9, "y": 0}}"#);
        assert_eq!(nowhere.and_then(|place| place.at), None);
    }
}
