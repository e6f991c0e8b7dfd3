//! Snapshots of the window, compared with references.

use std::io::Cursor;
use std::path::{Path, PathBuf};

use egui::Rect;

use super::fault::Fault;
use super::stage::{Stage, count};
use crate::app::offscreen::OffscreenOptions;
use crate::picture::Picture;
use crate::store::save_bytes_fast;

/// The part and settings of a snapshot, where they differ from the window's.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Look {
    pub region: Region,
    /// In logical pixels.
    pub size: Option<(u32, u32)>,
    pub scale: Option<f32>,
    pub is_dark: Option<bool>,
}

/// A part of the window.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Region {
    #[default]
    All,
    Canvas,
    /// The canvas with its rulers, and the messages above it.
    Middle,
    /// The front dialog, palette or menu.
    Dialog,
    /// The inspector on the right.
    Panel,
    /// Plans and layers on the left.
    List,
}

impl Region {
    pub(super) const ALL: [Self; 6] = [Self::All, Self::Canvas, Self::Middle, Self::Dialog, Self::Panel, Self::List];

    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::All => "all",
            Self::Canvas => "canvas",
            Self::Middle => "middle",
            Self::Dialog => "dialog",
            Self::Panel => "panel",
            Self::List => "list",
        }
    }

    /// Its place on the screen; `None` if it is not shown.
    fn rect(self, stage: &Stage<'_>) -> Option<Rect> {
        match self {
            Self::All => Some(Rect::EVERYTHING),
            Self::Canvas => stage.window.app().canvas_rect(),
            Self::Middle => stage.window.app().panels.middle_rect,
            Self::Dialog => stage.window.front_rect(),
            Self::Panel => stage.window.app().panels.right_rect,
            Self::List => stage.window.app().panels.left_rect,
        }
    }
}

/// The most pixels of a reference: those of the largest window at the largest scale.
const MOST_PIXELS: usize = 1 << 28;

/// Takes a snapshot and compares it with the reference of this name.
pub(super) fn take(stage: &mut Stage<'_>, name: &str, look: &Look) -> Result<(), Fault> {
    let picture = picture(stage, look)?;
    stage.snapshots += 1;
    compare(stage, name, &picture)
}

fn picture(stage: &mut Stage<'_>, look: &Look) -> Result<Picture, Fault> {
    let before = stage.window.options();
    let (width, height) = look.size.unwrap_or((before.width, before.height));
    let options = OffscreenOptions {
        width,
        height,
        scale: look.scale.unwrap_or(before.scale),
        is_dark: look.is_dark.unwrap_or(before.is_dark),
    };
    set_options(stage, options)?;
    let rect = look.region.rect(stage);
    let picture = rect.map(|rect| stage.window.picture_of(rect));
    set_options(stage, before)?;
    picture
        .filter(|picture| !picture.rgba.is_empty())
        .ok_or_else(|| Fault::new(format!("the window does not show the region {} now", look.region.name())))
}

fn set_options(stage: &mut Stage<'_>, options: OffscreenOptions) -> Result<(), Fault> {
    if options == stage.window.options() {
        return Ok(());
    }
    stage.set_options(options)?;
    stage.window.settle().map_err(|error| Fault::new(error.to_string()))
}

fn compare(stage: &mut Stage<'_>, name: &str, picture: &Picture) -> Result<(), Fault> {
    let reference = stage.folders.snapshots.join(format!("{name}.png"));
    let (out, diff) = (beside(&reference, "out"), beside(&reference, "diff"));
    for stale in [&out, &diff] {
        // Usually there is none.
        let _ = std::fs::remove_file(stale);
    }
    if let Some(folder) = &stage.folders.kept_pictures {
        save(&folder.join(format!("{name}.png")), picture)?;
    }
    let expected = match std::fs::File::open(&reference) {
        Ok(file) => Picture::from_png(std::io::BufReader::new(file), MOST_PIXELS),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Err(String::new()),
        Err(error) => Err(error.to_string()),
    };
    let difference = match &expected {
        Ok(expected) => match expected.difference(picture) {
            None => return Ok(()),
            difference => difference,
        },
        Err(_) => None,
    };
    if stage.is_updating {
        save(&reference, picture)?;
        stage.updated.push(reference);
        return Ok(());
    }
    save(&out, picture)?;
    let hint = "look at what was written; --update makes it the reference";
    match (expected, difference) {
        (Ok(expected), Some(difference)) => {
            save(&diff, &difference.picture)?;
            let size = |picture: &Picture| format!("{}x{}", picture.width_px, picture.height_px);
            let what = if size(&expected) == size(picture) {
                let pixels = count(difference.pixels, "pixel");
                let differ = if difference.pixels == 1 { "differs" } else { "differ" };
                format!("snapshot {name}: {pixels} {differ}, by {} of 255 at most", difference.largest)
            } else {
                format!("snapshot {name}: expected {} pixels, found {}", size(&expected), size(picture))
            };
            Err(Fault::unmet(what).hint(hint).files(vec![out, diff]))
        }
        (expected, _) => {
            let why = expected.err().filter(|why| !why.is_empty()).map(|why| format!(" ({why})")).unwrap_or_default();
            let what = format!("snapshot {name}: no reference picture {name}.png to compare with{why}");
            Err(Fault::unmet(what).hint(hint).files(vec![out]))
        }
    }
}

fn save(path: &Path, picture: &Picture) -> Result<(), Fault> {
    let fail = |what: String| Fault::new(format!("{}: {what}", path.display()));
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder).map_err(|error| fail(error.to_string()))?;
    }
    let bytes = picture.to_png().map_err(|error| fail(error.to_string()))?;
    // An identical reference keeps its bytes and its date.
    let is_same = std::fs::read(path).ok().and_then(|old| Picture::from_png(Cursor::new(old), MOST_PIXELS).ok());
    if is_same.as_ref() == Some(picture) {
        return Ok(());
    }
    save_bytes_fast(path, &bytes).map_err(|error| fail(error.to_string()))
}

/// The path of a related file: `name.out.png` beside `name.png`.
pub(super) fn beside(path: &Path, what: &str) -> PathBuf {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let (stem, ending) = name.split_once('.').unwrap_or((&name, ""));
    path.with_file_name(format!("{stem}.{what}.{ending}"))
}
