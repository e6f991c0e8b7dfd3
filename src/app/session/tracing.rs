//! The user's actions on the backdrop. Every change is a step of the history.

use super::wishes::Wish;
use crate::app::session::Session;
use crate::app::session::picture_change::{PictureChange, PictureUse};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::app::paint::backdrop::{Read, Wanted, read};
use crate::app::session::{
    file_dialogs::Purpose,
    jobs::Kind,
    messages::{Message, Remedy, Severity},
    origin::file_name,
    questions::Question,
};
use crate::edit::{self, DrawingMoves};
use crate::geometry::{Point, Vector};
use crate::plan::{Backdrop, OpeningId, Plan};
use crate::store::pictures::{self, LoadedPicture, PictureError};

impl Session {
    // Reading.

    /// Starts loading the plan's backdrop, unless that is done.
    pub(crate) fn refresh_backdrop(&mut self) {
        let Some(document) = &self.document else { return };
        let (backdrop, folder) = (document.plan().backdrop(), document.origin.folder());
        let Some(wanted) = self.backdrop.wanted(backdrop, folder) else { return };
        let Some(backdrop) = backdrop.cloned() else { return };
        let folder = folder.map(Path::to_owned);
        let kind = Kind::new("read the picture under the plan").newest_of("picture under the plan").if_broken({
            let wanted = wanted.clone();
            move |session| {
                let (what, hint) = ("could not be read", "use another picture, and report this one");
                let error = PictureError { what: what.to_owned(), hint: hint.to_owned() };
                session.backdrop_was_read(wanted, &Read::Missing { error, candidate: None });
            }
        });
        let allowed = self.pictures_allowed.clone();
        self.jobs.start(kind, move |work| {
            let read = read(&wanted, &backdrop, folder.as_deref(), &allowed, work);
            move |session: &mut Session, _: &_| session.backdrop_was_read(wanted, &read)
        });
    }

    pub(crate) fn backdrop_was_read(&mut self, wanted: Wanted, read: &Read) {
        if !self.backdrop.set_read(wanted.clone(), read) {
            return;
        }
        let shown = self.shown_path(&wanted.path);
        let (severity, text, detail, remedy) = match read {
            Read::Shown { picture, found_at: None } => {
                if wanted.content_hash.is_empty() || wanted.content_hash == picture.content_hash {
                    return;
                }
                let text = "The picture under the plan has changed".to_owned();
                let detail = format!("Check that your drawing still fits it.\n{shown}");
                (Severity::Warning, text, detail, Remedy::KeepPicture)
            }
            Read::Shown { found_at: Some(path), .. } => {
                let text = format!("The picture under the plan has moved; it was found at {}", self.shown_path(path));
                let detail = format!("The plan expects it at {shown}");
                (Severity::Info, text, detail, Remedy::KeepPicture)
            }
            Read::Missing { error, candidate } => {
                let is = if wanted.path.exists() { "not shown" } else { "missing" };
                let text = format!("The picture under the plan is {is}: {} {}", file_name(&wanted.path), error.what);
                let also = candidate.as_ref().map_or(String::new(), |candidate| {
                    format!("\nThere is another picture of this name: {}", self.shown_path(candidate))
                });
                (Severity::Warning, text, format!("{shown}{also}"), Remedy::RelinkPicture)
            }
            Read::Outside => {
                let text = format!(
                    "The picture under the plan is hidden: {} lies outside the plan's folder",
                    file_name(&wanted.path)
                );
                let detail = format!(
                    "A plan from someone else could refer to any file. Show the picture if you trust the \
                             plan.\n{shown}"
                );
                (Severity::Warning, text, detail, Remedy::ShowPicture)
            }
        };
        let lasts = self.while_this_picture();
        self.add_message(Message::new(severity, text, detail).with(vec![remedy]).lasting(lasts));
    }

    /// Shows the picture though it lies outside the plan's folder, until the window closes.
    pub(crate) fn allow_picture(&mut self) {
        let Some(document) = &self.document else { return };
        let Some(backdrop) = document.plan().backdrop() else { return };
        let path = pictures::resolved_path(&backdrop.path, document.origin.folder());
        self.messages.retain(|message| !message.remedies.contains(&Remedy::ShowPicture));
        self.allow_path(&path);
        self.backdrop.forget();
    }

    fn allow_path(&mut self, path: &Path) {
        if let Ok(path) = path.canonicalize()
            && !self.pictures_allowed.contains(&path)
        {
            self.pictures_allowed.push(path);
        }
    }

    /// Asks which picture to use.
    pub(crate) fn choose_picture(&mut self, use_: PictureUse) {
        let folder = self.document.as_ref().and_then(|document| document.origin.folder()).map(Path::to_owned);
        self.ask_for_file(Purpose::Picture(use_), folder, String::new());
    }

    /// Loads a picture and makes it the backdrop.
    pub(crate) fn use_picture(&mut self, use_: PictureUse, path: PathBuf, page: u32) {
        if self.document.is_none() {
            self.new_plan();
        }
        let Some(document) = self.document.as_ref().map(|document| document.number) else { return };
        self.reading_picture = Some(file_name(&path));
        let kind = Kind::new("read a picture").if_broken(|session| session.reading_picture = None);
        // Who names it wants it.
        self.allow_path(&path);
        let rectification = match use_ {
            PictureUse::Relink => {
                self.plan().and_then(Plan::backdrop).and_then(|backdrop| backdrop.rectification.clone())
            }
            PictureUse::Add => None,
        };
        self.jobs.start(kind, move |work| {
            let mut page = page;
            let load = |page| pictures::load_backdrop_while(&path, page, rectification.as_ref(), work);
            let mut result = load(page);
            // The page was another file's: a scan in place of a document has one.
            if use_ == PictureUse::Relink && page > 1 && result.as_ref().is_err_and(PictureError::lacks_page) {
                page = 1;
                result = load(page);
            }
            let result = result.map(Box::new);
            move |session: &mut Session, _: &_| session.picture_was_read(document, use_, &path, page, result)
        });
    }

    pub(crate) fn picture_was_read(
        &mut self,
        number: u64,
        use_: PictureUse,
        path: &Path,
        page: u32,
        result: Result<Box<LoadedPicture>, PictureError>,
    ) {
        self.reading_picture = None;
        let Some(document) = self.document.as_ref().filter(|document| document.number == number) else { return };
        let picture = match result {
            Ok(picture) => picture,
            Err(error) => {
                let text = format!("{} cannot be used: it {}", file_name(path), error.what);
                let detail = format!("What to do: {}.\n{}", error.hint, self.shown_path(path));
                let lasts = self.while_this_picture();
                self.add_message(Message::new(Severity::Error, text, detail).lasting(lasts));
                return;
            }
        };
        let folder = document.origin.folder().map(Path::to_owned);
        let stated = pictures::relative_path(path, folder.as_deref());
        let hash = picture.content_hash.clone();
        let before = document.plan().backdrop().cloned();
        let [width, height] = picture.levels.size_px();
        let (title, backdrop) = match (use_, before) {
            (PictureUse::Relink, Some(before)) => {
                self.messages.retain(|message| {
                    !message.remedies.iter().any(|remedy| {
                        matches!(remedy, Remedy::RelinkPicture | Remedy::KeepPicture | Remedy::ShowPicture)
                    })
                });
                if !before.content_hash.is_empty() && before.content_hash != hash {
                    self.say(
                        Severity::Warning,
                        "This is not the picture that was under the plan",
                        "Place and scale are kept. Check that your drawing fits it.",
                    );
                }
                ("Relink picture", Backdrop { path: stated, content_hash: hash, page, ..before })
            }
            // The scale belongs to the other picture, but opacity is a preference.
            (_, before) => {
                let opacity = before.map_or(NEW_OPACITY, |before| before.opacity);
                ("Add picture", Backdrop { page, opacity, ..Backdrop::new(stated, hash) })
            }
        };
        let wanted = Wanted::of(&backdrop, folder.as_deref());
        self.backdrop.set_shown(wanted, Arc::from(picture));
        self.layers.backdrop = true;
        let is_new = use_ == PictureUse::Add;
        self.edit(title, |plan| Ok(edit::set_backdrop(plan, Some(backdrop))));
        if is_new {
            // Wherever one looked: all of it is seen, and what is drawn.
            self.wishes.push(Wish::Fit);
        }
        self.status = format!("{} has {width} x {height} pixels", file_name(path));
    }

    /// The path of the picture shown, to make it the plan's backdrop.
    pub(crate) fn shown_picture_path(&self) -> Option<PathBuf> {
        self.backdrop.shown_path().map(ToOwned::to_owned)
    }

    // Changing.

    /// Changes the plan's backdrop.
    pub(crate) fn change_backdrop(&mut self, title: &str, change: impl FnOnce(&mut Backdrop)) {
        self.edit(title, |plan| {
            let mut backdrop = plan.backdrop().cloned();
            if let Some(backdrop) = &mut backdrop {
                change(backdrop);
            }
            Ok(edit::set_backdrop(plan, backdrop))
        });
    }

    pub(crate) fn remove_picture(&mut self) {
        self.messages.retain(|message| {
            !message
                .remedies
                .iter()
                .any(|remedy| matches!(remedy, Remedy::RelinkPicture | Remedy::KeepPicture | Remedy::ShowPicture))
        });
        self.edit("Remove picture", |plan| Ok(edit::set_backdrop(plan, None)));
    }

    /// Adds a known length between two points of the plan to the measurements that determine the scale.
    ///
    /// # Errors
    /// When it is not a valid measurement.
    pub(crate) fn add_measurement(
        &mut self,
        from: Point,
        to: Point,
        length_m: f64,
        drawing: Option<DrawingMoves>,
    ) -> Result<(), String> {
        let Some(backdrop) = self.plan().and_then(Plan::backdrop) else { return Ok(()) };
        let added = backdrop.measurement(from, to, length_m).map_err(|error| error.to_string())?;
        let mut measurements = backdrop.measurements.clone();
        measurements.push(added);
        self.change_picture(PictureChange::Measurements(measurements), drawing);
        Ok(())
    }

    /// Adds the width of a door that was drawn over the backdrop.
    ///
    /// # Errors
    /// When there is no such opening, or it is not a valid measurement.
    pub(crate) fn measure_opening(
        &mut self,
        opening: OpeningId,
        width_m: f64,
        drawing: Option<DrawingMoves>,
    ) -> Result<(), String> {
        let segment =
            self.plan().and_then(|plan| plan.opening(opening).and_then(|opening| plan.opening_segment(opening)));
        let Some(segment) = segment else { return Err("the opening has no place".to_owned()) };
        self.add_measurement(segment.a, segment.b, width_m, drawing)
    }

    /// Removes the measurement with an index.
    ///
    /// # Errors
    /// When there are not that many.
    pub(crate) fn remove_measurement(&mut self, index: usize, drawing: Option<DrawingMoves>) -> Result<(), String> {
        let Some(backdrop) = self.plan().and_then(Plan::backdrop) else { return Ok(()) };
        let mut measurements = backdrop.measurements.clone();
        if index >= measurements.len() {
            return Err(format!("there are {} measurements", measurements.len()));
        }
        measurements.remove(index);
        self.change_picture(PictureChange::Measurements(measurements), drawing);
        Ok(())
    }

    /// Rotates the backdrop so that a line between two points of the plan follows the nearest axis.
    ///
    /// # Errors
    /// When both points are the same.
    pub(crate) fn straighten(&mut self, from: Point, to: Point, drawing: Option<DrawingMoves>) -> Result<(), String> {
        let angle_rad = edit::straightening_rad(to - from).ok_or("the two points are the same")?;
        self.change_picture(PictureChange::Turn { about: from.midpoint(to), angle_rad }, drawing);
        Ok(())
    }

    /// Rotates the backdrop about the middle of its visible part.
    pub(crate) fn turn_picture(&mut self, angle_deg: f64, drawing: Option<DrawingMoves>) {
        let Some(backdrop) = self.plan().and_then(Plan::backdrop) else { return };
        let bounds = self.backdrop.bounds(Some(backdrop));
        let about = if bounds.is_empty() { backdrop.origin } else { bounds.center() };
        self.change_picture(PictureChange::Turn { about, angle_rad: angle_deg.to_radians() }, drawing);
    }

    /// Makes the picture flat, so that four points of the plan become the corners of a rectangle; see
    /// [`edit::rectify_picture`].
    ///
    /// # Errors
    /// When they are no corners of a rectangle, or the picture is not there to be measured.
    pub(crate) fn rectify_picture(&mut self, corners: [Point; 4], sides_m: Option<[f64; 2]>) -> Result<(), String> {
        let Some(source_px) = self.backdrop.source_px() else { return Err("the picture is not shown".to_owned()) };
        let ran = self.try_edit("Make picture flat", |plan| edit::rectify_picture(plan, corners, sides_m, source_px));
        ran.map_err(|error| error.to_string())?;
        if let (Some(_), Some(backdrop)) = (sides_m, self.plan().and_then(Plan::backdrop)) {
            self.status = format!("1 pixel of the picture is {}", millimetres(backdrop.metres_per_pixel));
        }
        Ok(())
    }

    /// Shows the picture as it is in its file.
    ///
    /// # Errors
    /// When it is shown so.
    pub(crate) fn unrectify_picture(&mut self) -> Result<(), String> {
        self.try_edit("Show picture as taken", edit::unrectify_picture).map_err(|error| error.to_string())
    }

    pub(crate) fn move_picture(&mut self, by: Vector) {
        self.edit("Move picture", |plan| edit::move_picture(plan, by));
    }

    /// Changes the backdrop; if there is a drawing and its fate was not stated, asks.
    fn change_picture(&mut self, change: PictureChange, drawing: Option<DrawingMoves>) {
        let Some(plan) = self.plan() else { return };
        let drawing = match drawing {
            Some(drawing) => drawing,
            None if plan.is_empty() || !moves_picture(plan, &change) => DrawingMoves::Along,
            None => {
                self.ask(Question::drawing(change));
                return;
            }
        };
        self.apply_picture_change(&change, drawing);
    }

    pub(crate) fn apply_picture_change(&mut self, change: &PictureChange, drawing: DrawingMoves) {
        let placed = |app: &Self| {
            app.plan().and_then(Plan::backdrop).map(|backdrop| (backdrop.origin, backdrop.metres_per_pixel))
        };
        let before = placed(self);
        self.edit(change.title(), |plan| change.apply(plan, drawing));
        let (Some((_, before)), Some((origin, after))) = (before, placed(self)) else { return };
        let factor = after / before;
        // The backdrop and everything that follows it stays in place on the screen.
        if drawing == DrawingMoves::Along && factor != 1.0 {
            self.wishes.push(Wish::ScaleView { about: origin, factor });
        }
        if let PictureChange::Measurements(_) = change {
            self.status = format!("1 pixel of the picture is {}", millimetres(after));
        }
    }
}

/// Whether a change affects the position of points already traced.
fn moves_picture(plan: &Plan, change: &PictureChange) -> bool {
    let after = change.apply(plan, DrawingMoves::Stays);
    let placed = |plan: &Plan| plan.backdrop().map(|b| (b.metres_per_pixel, b.rotation_rad, b.origin));
    after.is_ok_and(|after| placed(&after) != placed(plan))
}

/// A plan as saved in a folder: the backdrop's path is relative to it.
pub(crate) fn plan_in_folder(plan: &Plan, from: Option<&Path>, to: Option<&Path>) -> Plan {
    match (plan.backdrop(), to) {
        (Some(backdrop), Some(to)) if from != Some(to) => {
            edit::set_backdrop(plan, Some(pictures::relocated(backdrop, from, to)))
        }
        _ => plan.clone(),
    }
}

/// How strongly a new picture is seen: what is drawn over it stands out.
const NEW_OPACITY: f64 = 0.5;

/// A pixel size, for display.
pub(crate) fn millimetres(metres: f64) -> String {
    let mm = metres * 1000.0;
    let decimals = if mm < 10.0 { 2 } else { 1 };
    format!("{mm:.decimals$} mm")
}
