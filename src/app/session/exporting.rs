//! Writing the plan in other formats, printing it, and what a sheet will look like.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use egui::{ColorImage, Context};

use super::Session;
use crate::app::session::document::Document;
use crate::app::session::file_dialogs::{Dialogs, Purpose};
use crate::app::session::jobs::{Kind, Wanted};
use crate::app::session::messages::Severity;
use crate::app::session::origin::file_name;
use crate::draw::png;
use crate::formats::registry::ending_of;
use crate::formats::sheets;
use crate::formats::{Exporter, FORMATS, Format, NamedPlan, Options};
use crate::labels::Schemes;
use crate::plan::Plan;
use crate::store;

/// A format that can be written, and its writer.
pub(crate) type Writable = (&'static Format, &'static dyn Exporter);

/// The formats that are offered: those that are for people first.
pub(crate) fn writable() -> Vec<Writable> {
    let writable = FORMATS.iter().filter_map(|format| Some((*format, format.exporter?)));
    let (sheets, others): (Vec<Writable>, Vec<Writable>) = writable.partition(|(format, _)| is_sheet(format));
    sheets.into_iter().chain(others).collect()
}

/// Whether a format writes sheets of paper.
pub(crate) fn is_sheet(format: &Format) -> bool {
    [sheets::PDF.id, sheets::SVG.id, sheets::PNG.id].contains(&format.id)
}

/// The format of a file by its name.
///
/// # Errors
/// When no format that can be written has its ending; the text lists the endings.
fn format_of(path: &Path) -> Result<Writable, String> {
    let name = file_name(path);
    writable().into_iter().find(|(format, _)| ending_of(&name, format.endings).is_some()).ok_or_else(|| {
        let endings: Vec<String> =
            writable().iter().flat_map(|(format, _)| format.endings).map(|ending| format!(".{ending}")).collect();
        format!("the file's ending gives the format: {}", endings.join(", "))
    })
}

/// Reads options as they are written in commands: `paper=A3 scale=1:100`, or 'default' for none.
fn options_of(exporter: &dyn Exporter, words: &str) -> Result<Options, String> {
    let pairs: Vec<String> =
        words.split_whitespace().filter(|word| *word != DEFAULT_OPTIONS).map(str::to_owned).collect();
    Options::check_names(exporter.options(), &pairs)
        .and_then(|()| Options::parse(exporter.options(), &pairs))
        .map_err(|error| error.to_string())
}

/// The word for no options.
pub(crate) const DEFAULT_OPTIONS: &str = "default";

/// A sheet to look at.
#[derive(Clone)]
pub(crate) struct Shown {
    pub pixels: Arc<ColorImage>,
    /// Paper and scale: 'A3 landscape, 1:100'.
    pub words: String,
}

/// What a preview shows.
#[derive(Clone)]
struct Asked {
    plan: Plan,
    format: &'static str,
    options: Options,
    width_px: u32,
}

/// The preview of a sheet, for the dialogs that write one.
#[derive(Default)]
pub(crate) struct SheetPreview {
    asked: Option<Asked>,
    result: Option<Result<Shown, String>>,
    job: Option<Wanted>,
}

impl SheetPreview {
    /// What was made of the last request; `None` while it is in the making.
    pub(crate) fn result(&self) -> Option<&Result<Shown, String>> {
        self.result.as_ref()
    }
}

impl Session {
    /// The plan to write, with the stem for its files.
    fn to_write(&self) -> Option<(Plan, String)> {
        let document = self.document.as_ref()?;
        Some((document.plan().clone(), document.origin.stem()))
    }

    /// Where an export goes unless told otherwise: beside the plan's file.
    pub(crate) fn export_path(&self, format: &Format) -> PathBuf {
        let stem = self.document.as_ref().map_or_else(|| "plan".to_owned(), |document| document.origin.stem());
        let ending = format.endings.first().copied().unwrap_or_default();
        self.export_folder().join(format!("{stem}.{ending}"))
    }

    /// The folder of the plan's file, or the person's own.
    pub(crate) fn export_folder(&self) -> PathBuf {
        let own = self.document.as_ref().and_then(|document| document.origin.folder()).map(Path::to_owned);
        let folder = own.or_else(|| self.list.folder.clone()).or_else(|| self.named_from.clone());
        folder.or_else(|| etcetera::home_dir().ok()).unwrap_or_default()
    }

    /// The file that a typed text means, see [`Self::typed_path`]; `None` if it is none.
    pub(crate) fn typed_file(&self, text: &str) -> Option<PathBuf> {
        let text = text.trim();
        if text.is_empty() || text.ends_with(['/', '\\']) {
            return None;
        }
        Some(self.typed_path(text)).filter(|path| path.file_name().is_some())
    }

    /// Asks where to export to.
    pub(crate) fn ask_where_to_export(&mut self, path: &Path) {
        let folder = path.parent().map(Path::to_owned).filter(|folder| folder.is_dir());
        self.ask_for_file(Purpose::Export, folder, file_name(path));
    }

    /// The preview that was made last.
    pub(crate) fn preview(&self) -> &SheetPreview {
        &self.preview
    }

    /// Makes the preview of a sheet, unless it is made or in the making.
    pub(crate) fn preview_sheet(&mut self, (format, exporter): Writable, words: &str, width_px: u32) {
        let Some(plan) = self.plan().cloned() else { return };
        let options = match options_of(exporter, words) {
            Ok(options) => options,
            Err(error) => {
                self.preview = SheetPreview { result: Some(Err(error)), ..SheetPreview::default() };
                return;
            }
        };
        let is_it = |asked: &Asked| {
            asked.format == format.id
                && asked.options == options
                && asked.width_px == width_px
                && asked.plan.is_same_value(&plan)
        };
        if self.preview.asked.as_ref().is_some_and(is_it) {
            return;
        }
        self.preview.asked = Some(Asked { plan: plan.clone(), format: format.id, options: options.clone(), width_px });
        let schemes = self.schemes.clone();
        let kind = Kind::new("draw the sheet").newest_of("sheet preview");
        let job = self.jobs.start_wanted(kind, move |_| {
            let shown = picture_of(exporter, &plan, &schemes, &options, width_px);
            move |session: &mut Session, context: &Context| {
                session.preview.result = Some(shown);
                session.preview.job = None;
                context.request_repaint();
            }
        });
        self.preview.job = Some(job);
    }

    /// Writes the plan to a file whose ending says the format, replacing what is there. `words`: options, as
    /// `NAME=VALUE` parted by blanks.
    ///
    /// # Errors
    /// When the ending or an option is not known.
    pub(crate) fn export(&mut self, path: PathBuf, words: &str) -> Result<(), String> {
        let writable = format_of(&path)?;
        let options = options_of(writable.1, words)?;
        let Some((plan, _)) = self.to_write() else { return Ok(()) };
        let schemes = self.schemes.clone();
        let shown_path = self.shown_path(&path);
        self.jobs.start(Kind::new("export the plan").must_end(), move |_| {
            let written = write(writable, &plan, &schemes, &options, &path);
            move |session: &mut Session, _: &Context| session.was_exported(writable.0, &path, &shown_path, written)
        });
        Ok(())
    }

    fn was_exported(&mut self, format: &Format, path: &Path, shown_path: &str, written: Result<Vec<String>, String>) {
        match written {
            Ok(lost) => {
                self.status = format!("Exported as {}", file_name(path));
                if !lost.is_empty() {
                    let text = format!("{} does not keep {}", format.name, lost.join(", "));
                    self.say(Severity::Info, text, shown_path);
                }
            }
            Err(error) => self.say(Severity::Error, format!("{} was not written", file_name(path)), error),
        }
    }

    /// Makes a PDF of the plan and opens it with the desktop's viewer, which prints.
    ///
    /// # Errors
    /// When an option is not known, or there is nowhere to put the file.
    pub(crate) fn print(&mut self, words: &str) -> Result<(), String> {
        let exporter = sheets::PDF_WRITER;
        let options = options_of(exporter, words)?;
        let Some((plan, stem)) = self.to_write() else { return Ok(()) };
        // A script's files stay in its folder, and no window of another program opens.
        let is_shown = matches!(self.dialogs, Dialogs::System { .. });
        let folder = if is_shown { store::print_folder() } else { self.named_from.clone() };
        let folder = folder.ok_or("there is no folder for files to print; export a PDF instead")?;
        let path = folder.join(format!("{stem}.pdf"));
        let schemes = self.schemes.clone();
        self.jobs.start(Kind::new("print the plan"), move |_| {
            let made = std::fs::create_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()));
            let written =
                made.and_then(|()| write((&sheets::PDF, exporter), &plan, &schemes, &options, &path).map(drop));
            let opened = match (&written, is_shown) {
                (Ok(()), true) => store::show_in_viewer(&path),
                _ => Ok(()),
            };
            move |session: &mut Session, _: &Context| match (written, opened) {
                (Ok(()), Ok(())) if is_shown => {
                    session.status = format!("{} is open in your viewer; print it there", file_name(&path));
                }
                (Ok(()), Ok(())) => session.status = format!("Made {} to print", file_name(&path)),
                (Ok(()), Err(error)) => {
                    let detail = format!("{error}\n{}", path.display());
                    session.say(Severity::Warning, "The PDF was made, but no viewer opened it", detail);
                }
                (Err(error), _) => session.say(Severity::Error, "The plan was not printed", error),
            }
        });
        Ok(())
    }
}

/// Writes the plan, and gives what the format does not keep.
fn write(
    (_, exporter): Writable,
    plan: &Plan,
    schemes: &Schemes,
    options: &Options,
    path: &Path,
) -> Result<Vec<String>, String> {
    let name = file_name(path);
    let stem = crate::formats::file_stem(&name);
    let export = exporter.write(&[NamedPlan { stem, plan }], schemes, options).map_err(|error| error.to_string())?;
    match export.files.as_slice() {
        [file] => store::save_bytes(path, &file.bytes).map_err(|error| error.to_string())?,
        files => return Err(format!("the format needs {} files; use 'enfilade export'", files.len())),
    }
    Ok(export.lost.into_iter().map(|lost| lost.what).collect())
}

/// A sheet as pixels of a width, and its paper and scale in words.
fn picture_of(
    exporter: &dyn Exporter,
    plan: &Plan,
    schemes: &Schemes,
    options: &Options,
    width_px: u32,
) -> Result<Shown, String> {
    let laid = exporter.sheet(plan, schemes, options).ok_or("the format has no sheets")?;
    let laid = laid.map_err(|refused| refused.to_string())?;
    let words = laid.in_words();
    let mut scene = laid.scene;
    // The longer side as wide as asked, so that turning the paper does not change its size.
    let longest = scene.view.width_px.max(scene.view.height_px);
    scene.view.pixel_ratio = f64::from(width_px) / longest;
    let pixmap = png::paint(&scene).map_err(|error| error.to_string())?;
    let size = [pixmap.width() as usize, pixmap.height() as usize];
    let pixels = ColorImage::from_rgba_premultiplied(size, pixmap.data());
    Ok(Shown { pixels: Arc::new(pixels), words })
}

impl Document {
    /// Whether a path is the plan's own file, which an export must not replace with less.
    pub(crate) fn is_in(&self, path: &Path) -> bool {
        self.origin.path() == Some(path)
    }
}
