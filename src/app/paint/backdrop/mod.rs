//! The backdrop: loaded in the background, and painted in tiles at its position.

mod load;
mod tiles;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use egui::{Key, Painter, Rect};

pub(crate) use load::{Read, Wanted, read};

use crate::app::paint::backdrop::tiles::{Shown, Tiles};

use crate::draw::View;
use crate::geometry::{Bounds, Point};
use crate::plan::Backdrop;
use crate::store::pictures::{self, LoadedPicture, PictureError};

/// While this is held, the backdrop is hidden, to see the drawing alone.
const HIDING_KEY: Key = Key::Backtick;

/// The most tiles uploaded per frame: each takes about a millisecond.
const TILES_A_FRAME: usize = 4;

/// The state of the backdrop.
#[derive(Default)]
pub(crate) struct BackdropView {
    state: State,
    tiles: Tiles,
    /// The opacity while its slider is being dragged.
    pub opacity: Option<f64>,
    /// Whether it was visible in the last frame.
    is_seen: bool,
}

#[derive(Default)]
enum State {
    #[default]
    None,
    Loading(Wanted),
    Shown {
        wanted: Wanted,
        picture: Arc<LoadedPicture>,
        found_at: Option<PathBuf>,
    },
    Missing {
        wanted: Wanted,
        error: PictureError,
    },
}

/// The state of the plan's backdrop.
pub(crate) enum Known<'a> {
    Loading,
    Shown(&'a LoadedPicture),
    Missing(&'a PictureError),
}

impl BackdropView {
    /// The picture to load for a plan whose file is in this folder: `None` if it is already shown,
    /// loading or missing.
    pub(crate) fn wanted(&mut self, backdrop: Option<&Backdrop>, folder: Option<&Path>) -> Option<Wanted> {
        let Some(backdrop) = backdrop else {
            *self = Self::default();
            return None;
        };
        let wanted = Wanted::of(backdrop, folder);
        if self.known().is_some_and(|known| *known == wanted) {
            return None;
        }
        if let State::Shown { wanted: known, picture, found_at } = &mut self.state
            && picture.content_hash == wanted.content_hash
            && known.page == wanted.page
            && known.rectification == wanted.rectification
        {
            // The same picture at another path: relinked, or its plan was saved elsewhere.
            *known = wanted;
            *found_at = None;
            return None;
        }
        *self = Self { state: State::Loading(wanted.clone()), ..Self::default() };
        Some(wanted)
    }

    fn known(&self) -> Option<&Wanted> {
        match &self.state {
            State::None => None,
            State::Loading(wanted) | State::Shown { wanted, .. } | State::Missing { wanted, .. } => Some(wanted),
        }
    }

    /// Takes the loaded picture. Returns whether it is still wanted.
    pub(crate) fn set_read(&mut self, wanted: Wanted, read: &Read) -> bool {
        if self.known() != Some(&wanted) {
            return false;
        }
        self.tiles = Tiles::default();
        self.state = match read {
            Read::Shown { picture, found_at } => {
                State::Shown { wanted, picture: picture.clone(), found_at: found_at.clone() }
            }
            Read::Missing { error, .. } => State::Missing { wanted, error: error.clone() },
            Read::Outside => State::Missing { wanted, error: pictures::is_outside() },
        };
        true
    }

    /// Has the picture read again.
    pub(crate) fn forget(&mut self) {
        *self = Self::default();
    }

    /// Shows a picture that was read for the plan before the plan asks for it.
    pub(crate) fn set_shown(&mut self, wanted: Wanted, picture: Arc<LoadedPicture>) {
        // A view of everything, asked for at once, counts it.
        let is_seen = true;
        *self = Self { state: State::Shown { wanted, picture, found_at: None }, is_seen, ..Self::default() };
    }

    /// The state of the backdrop; `None` if the plan has none.
    pub(crate) fn state(&self) -> Option<Known<'_>> {
        match &self.state {
            State::None => None,
            State::Loading(_) => Some(Known::Loading),
            State::Shown { picture, .. } => Some(Known::Shown(picture)),
            State::Missing { error, .. } => Some(Known::Missing(error)),
        }
    }

    /// The number of pages in its file; 1 while unknown.
    pub(crate) fn pages(&self) -> u32 {
        match &self.state {
            State::Shown { picture, .. } => picture.pages,
            _ => 1,
        }
    }

    /// Width and height of the picture in its file, if it is shown.
    pub(crate) fn source_px(&self) -> Option<[u32; 2]> {
        match &self.state {
            State::Shown { picture, .. } => Some(picture.source_px),
            _ => None,
        }
    }

    /// Whether it is loading.
    pub(crate) fn is_loading(&self) -> bool {
        matches!(self.state, State::Loading(_))
    }

    /// The file shown.
    pub(crate) fn shown_path(&self) -> Option<&Path> {
        match &self.state {
            State::Shown { wanted, found_at, .. } => Some(found_at.as_deref().unwrap_or(&wanted.path)),
            _ => None,
        }
    }

    /// The bounding box of the picture, if shown; otherwise empty.
    pub(crate) fn bounds(&self, backdrop: Option<&Backdrop>) -> Bounds {
        match (&self.state, backdrop) {
            (State::Shown { picture, .. }, Some(backdrop)) if self.is_seen => {
                let [width, height] = picture.levels.size_px().map(f64::from);
                let corners = [(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)];
                Bounds::of(corners.map(|(x, y)| backdrop.plan_from_picture(Point::new(x, y))))
            }
            _ => Bounds::EMPTY,
        }
    }

    /// Paints the picture at its position in a view, unless a held key hides it. `is_still`: frames do
    /// not follow a clock, so paint all of it at once.
    pub(crate) fn paint(
        &mut self,
        painter: &Painter,
        rect: Rect,
        view: &View,
        backdrop: Option<&Backdrop>,
        is_still: bool,
    ) {
        let State::Shown { picture, .. } = &self.state else { return };
        let was_seen = std::mem::replace(&mut self.is_seen, backdrop.is_some());
        if self.is_seen != was_seen {
            // A view of everything may now be different.
            painter.ctx().request_repaint();
        }
        let context = painter.ctx();
        let is_hidden = !context.text_edit_focused() && context.input(|input| input.key_down(HIDING_KEY));
        let Some(backdrop) = backdrop.filter(|_| !is_hidden) else { return };
        if !context.input(|input| input.pointer.any_down()) {
            self.opacity = None;
        }
        let opacity = self.opacity.unwrap_or(backdrop.opacity);
        let shown = Shown { levels: &picture.levels, backdrop, opacity };
        self.tiles.paint(painter, rect, view, &shown, if is_still { usize::MAX } else { TILES_A_FRAME });
    }
}
