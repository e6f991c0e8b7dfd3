use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::builder::PossibleValuesParser;

use super::batch::{self, Input};
use super::classify::PredictorOptions;
use super::outputs::{Care, Outputs, is_stdout};
use super::{CliError, Outcome, Subcommand, Terminal, inputs};
use crate::draw::{
    Fill, LabelColours, Layers, Scene, Style, Theme, png,
    sheet::{self, Furniture, PageSize},
    svg,
};
use crate::formats::Import;
use crate::labels::Schemes;
use crate::picture::PictureLevels;
use crate::pipeline::{Asked, Pipeline};
use crate::plan::{Backdrop, Plan};
use crate::predict::Predictions;
use crate::store::pictures;

/// `enfilade render`: plans as pictures.
#[derive(clap::Args)]
pub struct RenderCommand {
    /// Plans, or folders of plans, of any known format
    #[arg(required = true, value_name = "PLAN")]
    plans: Vec<PathBuf>,
    /// The picture to write, .png or .svg; for several plans the folder
    #[arg(short, long, value_name = "FILE|DIR")]
    output: PathBuf,
    /// Pixels of the longer side, or WIDTHxHEIGHT
    #[arg(long, value_name = "PIXELS", default_value = "1600", value_parser = page_size)]
    size: PageSize,
    /// What the colours of the rooms show; with 'prediction', a room with another known label is hatched
    #[arg(long, alias = "color", value_name = "BY", default_value = "label",
          value_parser = PossibleValuesParser::new(Fill::ALL.map(Fill::name)))]
    colour: String,
    #[command(flatten)]
    predictor: PredictorOptions,
    /// Draw the graph of rooms and openings
    #[arg(long)]
    graph: bool,
    /// Draw a grid of metres
    #[arg(long)]
    grid: bool,
    /// Dark on light, or light on dark
    #[arg(long, value_name = "THEME", default_value = "light",
          value_parser = PossibleValuesParser::new(Theme::ALL.map(Theme::name)))]
    theme: String,
    /// Colours of the labels
    #[arg(long, value_name = "PALETTE", default_value = "standard",
          value_parser = PossibleValuesParser::new(LabelColours::ALL.map(LabelColours::name)))]
    palette: String,
    /// Leave out the picture under the plan
    #[arg(long)]
    no_picture: bool,
    /// Also read pictures from this folder and below, not only from each plan's own (can be repeated)
    #[arg(long, value_name = "DIR")]
    pictures_from: Vec<PathBuf>,
    /// Leave out the rooms' names and areas
    #[arg(long)]
    no_names: bool,
    /// Leave out title, legend and scale bar
    #[arg(long)]
    bare: bool,
    /// Format of pictures written to a folder or to stdout
    #[arg(long, value_name = "ENDING", default_value = "png", value_parser = ["png", "svg"])]
    format: String,
    /// Label scheme to add to the bundled ones (can be repeated)
    #[arg(long, value_name = "FILE.scheme.toml")]
    scheme: Vec<PathBuf>,
}

impl Subcommand for RenderCommand {
    const NAME: &'static str = "render";
    const ABOUT: &'static str = "Draw plans as PNG or SVG pictures";
    const EXAMPLE: &'static str = "enfilade render plans/office.plan.json -o office.png --size 2000 --graph";

    fn run(self, terminal: &mut Terminal) -> Result<Outcome, CliError> {
        let to_stdout = is_stdout(&self.output);
        let single = picture_ending(&self.output).filter(|_| !self.output.is_dir());
        if single.is_none() && self.output.extension().is_some() && !self.output.is_dir() {
            return Err(CliError::call(format!(
                "{}: not a folder and not a picture; pictures end in .png or .svg",
                self.output.display()
            )));
        }
        let schemes = inputs::schemes(&self.scheme)?;
        let (predictor, models) = self.predictor.read(terminal)?;
        let asked = Asked::by(&predictor, &models);
        let is_single = to_stdout || single.is_some();
        let files = batch::inputs_into(&self.plans, (!is_single).then_some(self.output.as_path()));
        if is_single && files.len() > 1 {
            return Err(CliError::call(format!(
                "-o {}: is a single picture, but there are {} plans to draw; name a folder",
                self.output.display(),
                files.len()
            )));
        }
        let style = self.style();
        let ending = single.unwrap_or(&self.format);
        let mut outputs = Outputs::new(terminal);
        let work = |input: &Input, import: Import| -> Vec<Picture> {
            import
                .plans
                .iter()
                .map(|plan| self.picture_of(plan, &input.path, &schemes, &asked, &style, ending))
                .collect()
        };
        let mut not_drawn = 0;
        let failed = batch::for_each_import(&files, "drawing", terminal, work, |input, pictures, terminal| {
            for (storey, picture) in pictures.into_iter().enumerate() {
                let target = match is_single {
                    true => self.output.clone(),
                    false => input.mirrored(&self.output, storey, ending, &outputs),
                };
                if let Some(warning) = picture.warning {
                    terminal.remark(warning)?;
                }
                let bytes = match picture.bytes {
                    Ok(bytes) => bytes,
                    Err(error) => {
                        not_drawn += 1;
                        terminal.error(format!("{}: {}", input.path.display(), error.message))?;
                        continue;
                    }
                };
                if let (false, Some(folder)) = (is_single, target.parent()) {
                    outputs.folder(folder)?;
                }
                outputs.save_from(&target, &bytes, Care::Fast, &input.path, terminal)?;
                if !to_stdout {
                    terminal.report(target.display())?;
                }
            }
            Ok(())
        })?;
        let failed = failed + not_drawn;
        Ok(if failed == 0 { Outcome::Done } else { Outcome::InputWrong })
    }
}

impl RenderCommand {
    fn style(&self) -> Style {
        // The parser only accepts names of the tables.
        Style {
            theme: Theme::ALL.into_iter().find(|theme| theme.name() == self.theme).unwrap_or_default(),
            label_colours: LabelColours::ALL
                .into_iter()
                .find(|colours| colours.name() == self.palette)
                .unwrap_or_default(),
            fill: Fill::ALL.into_iter().find(|fill| fill.name() == self.colour).unwrap_or_default(),
            layers: Layers {
                graph: self.graph,
                grid: self.grid,
                names: !self.no_names,
                areas: !self.no_names,
                ..Layers::default()
            },
            ..Style::default()
        }
    }

    /// `file` is the plan's file: its backdrop is relative to it.
    fn picture_of(
        &self,
        plan: &Plan,
        file: &Path,
        schemes: &Schemes,
        asked: &Asked,
        style: &Style,
        ending: &str,
    ) -> Picture {
        let mut warning = None;
        let backdrop = plan.backdrop().filter(|_| !self.no_picture);
        let traced = backdrop.and_then(|backdrop| {
            let path = pictures::resolved_path(&backdrop.path, file.parent());
            if !pictures::is_allowed(&path, file.parent(), &self.pictures_from) {
                let what = pictures::is_outside().what;
                let hint = "allow its folder with --pictures-from if you trust the plan";
                warning = Some(format!("{}: left out: the picture {what}; {hint}", path.display()));
                return None;
            }
            match pictures::load_backdrop(&path, backdrop) {
                Ok(loaded) => Some((Arc::new(loaded.levels), backdrop)),
                // The plan can be drawn all the same.
                Err(error) => {
                    warning = Some(format!("{}: left out: {error}", path.display()));
                    None
                }
            }
        });
        let picture = self.picture(plan, traced, schemes, asked, style, ending);
        let (bytes, remark) = match picture {
            Ok((bytes, remark)) => (Ok(bytes), remark),
            Err(error) => (Err(error), None),
        };
        Picture { bytes, warning: warning.or(remark) }
    }

    /// The picture, and what is to be said of it. `traced`: the picture under the plan.
    fn picture(
        &self,
        plan: &Plan,
        traced: Option<(Arc<PictureLevels>, &Backdrop)>,
        schemes: &Schemes,
        asked: &Asked,
        style: &Style,
        ending: &str,
    ) -> Result<(Vec<u8>, Option<String>), CliError> {
        let pipeline = Pipeline::new(plan, schemes);
        let furniture = Furniture { title: !self.bare, legend: !self.bare, scale: !self.bare };
        let asked = (style.fill == Fill::Prediction).then_some(asked);
        let predictions = asked.map(|asked| pipeline.predictions(asked)).transpose()?;
        let known = predictions.as_ref().and_then(Predictions::acquaintance);
        let mut drawing = pipeline.drawing(predictions.as_ref());
        if let Some(known) = known {
            drawing = drawing.with_caveat(&known.short_words());
        }
        let mut style = style.clone();
        if let Some((levels, backdrop)) = traced {
            drawing = drawing.with_picture(levels, backdrop);
            // As in the window: the backdrop shows through the rooms.
            style.fill_opacity = OVER_PICTURE;
            style.halo = true;
            style.layers.rooms = style.fill != Fill::None;
        }
        let style = &style;
        let remark = drawing.remark();
        let scene: Scene = sheet::page(&drawing, style, self.size, furniture);
        Ok((if ending == "svg" { svg::svg(&scene).into_bytes() } else { png::png(&scene)? }, remark))
    }
}

/// A plan's rendering as a file's bytes, or why there is none.
struct Picture {
    bytes: Result<Vec<u8>, CliError>,
    /// What was left out.
    warning: Option<String>,
}

/// Opacity of rooms over a backdrop.
const OVER_PICTURE: f64 = 0.55;

/// The extension of a picture's file name, if it has one.
fn picture_ending(path: &Path) -> Option<&'static str> {
    let extension = path.extension()?.to_string_lossy().to_lowercase();
    ["png", "svg"].into_iter().find(|known| *known == extension)
}

/// Parses `1600` or `2000x1500`.
fn page_size(text: &str) -> Result<PageSize, String> {
    let (least, most) = (SMALLEST_SIDE_PX, png::LARGEST_SIDE_PX);
    let side = |text: &str| {
        let side: u32 = text.trim().parse().map_err(|_| format!("'{text}' is not a number of pixels"))?;
        if (least..=most).contains(&side) {
            Ok(f64::from(side))
        } else {
            Err(format!("{side} pixels is not between {least} and {most}"))
        }
    };
    match text.split_once(['x', 'X', '×']) {
        Some((width, height)) => Ok(PageSize::Exact(side(width)?, side(height)?)),
        None => Ok(PageSize::Longest(side(text)?)),
    }
}

/// The minimum side in pixels: a smaller picture shows nothing.
const SMALLEST_SIDE_PX: u32 = 16;
