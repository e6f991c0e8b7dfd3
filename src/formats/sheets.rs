//! A plan to scale on a sheet of paper, as PDF, SVG or PNG: three formats with the same options.

use super::options::{Choice, Number, Switch};
use super::registry::Refused;
use super::{Export, Exporter, Format, FormatOption, Lost, NamedBytes, NamedPlan, Options};
use crate::base::units::Units;
use crate::draw::font::Font;
use crate::draw::paper::{Laid, Orientation, PX_PER_MM, Paper, Sheet, laid_out};
use crate::draw::pdf::{Facts, pdf};
use crate::draw::{Drawing, Fill, Item, LabelColours, Layers, Scene, Style, png, svg};
use crate::features::{NeighbourLabels, analyse};
use crate::labels::Schemes;
use crate::plan::Plan;

/// A sheet as PDF: vector shapes, and text that can be searched.
pub const PDF: Format = Format {
    id: "pdf",
    name: "PDF",
    endings: &["pdf"],
    about: "A sheet to scale with title block, legend and scale bar, for printing and sending",
    importer: None,
    exporter: Some(PDF_WRITER),
};

/// The writer of PDF, for printing.
pub const PDF_WRITER: &dyn Exporter = &Kind::Pdf;

/// A sheet as SVG, in millimetres.
pub const SVG: Format = Format {
    id: "svg",
    name: "SVG",
    endings: &["svg"],
    about: "The same sheet for drawing programs and web pages; each room and opening is a group of its own",
    importer: None,
    exporter: Some(&Kind::Svg),
};

/// A sheet as pixels.
pub const PNG: Format = Format {
    id: "png",
    name: "PNG",
    endings: &["png"],
    about: "The same sheet as a picture",
    importer: None,
    exporter: Some(&Kind::Png),
};

static PAPER: Choice = Choice { name: "paper", words: &["A4", "A3", "A2", "A1", "A0"], help: "The size of the paper" };

static ORIENTATION: Choice = Choice {
    name: "orientation",
    words: &["auto", "landscape", "portrait"],
    help: "The orientation of the paper; 'auto' takes the one that shows the plan larger",
};

static SCALE: Choice = Choice {
    name: "scale",
    words: &[
        "fit", "1:20", "1:25", "1:50", "1:75", "1:100", "1:125", "1:150", "1:200", "1:250", "1:500", "1:1000", "1:2000",
    ],
    help: "The scale; 'fit' takes the largest of these at which the plan fits the paper",
};

static COLOURED_BY: Choice =
    Choice { name: "colour", words: &["label", "function", "none"], help: "What the colours of the rooms show" };

static PALETTE: Choice =
    Choice { name: "palette", words: &["standard", "colour-blind-safe"], help: "Colours of the labels" };

static UNITS: Choice =
    Choice { name: "units", words: &["metric", "imperial"], help: "The units of areas and dimensions" };

static TITLE_BLOCK: Switch = Switch { name: "title-block", default: true, help: "Draw the frame and the title block" };
static LEGEND: Switch = Switch { name: "legend", default: true, help: "Draw the legend of the colours" };
static SCALE_BAR: Switch = Switch { name: "scale-bar", default: true, help: "Draw a scale bar" };
static DIMENSIONS: Switch =
    Switch { name: "dimensions", default: true, help: "Draw the overall width and height beside the plan" };
static NAMES: Switch = Switch { name: "names", default: true, help: "Show the names of rooms" };
static AREAS: Switch = Switch { name: "areas", default: true, help: "Show the areas of rooms" };
static GRAPH: Switch = Switch { name: "graph", default: false, help: "Draw which rooms the openings connect" };

static DPI: Number =
    Number { name: "dpi", default: Some(150.0), least: 36.0, most: 600.0, help: "Dots per inch of paper" };

const OPTIONS: [FormatOption; 13] = [
    FormatOption::Choice(&PAPER),
    FormatOption::Choice(&ORIENTATION),
    FormatOption::Choice(&SCALE),
    FormatOption::Choice(&COLOURED_BY),
    FormatOption::Choice(&PALETTE),
    FormatOption::Choice(&UNITS),
    FormatOption::Switch(&TITLE_BLOCK),
    FormatOption::Switch(&LEGEND),
    FormatOption::Switch(&SCALE_BAR),
    FormatOption::Switch(&DIMENSIONS),
    FormatOption::Switch(&NAMES),
    FormatOption::Switch(&AREAS),
    FormatOption::Switch(&GRAPH),
];

const PNG_OPTIONS: [FormatOption; 14] = {
    let mut options = [FormatOption::Number(&DPI); 14];
    let mut index = 0;
    while index < OPTIONS.len() {
        options[index] = OPTIONS[index];
        index += 1;
    }
    options
};

/// In which form a sheet is written.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Pdf,
    Svg,
    Png,
}

impl Exporter for Kind {
    fn options(&self) -> &'static [FormatOption] {
        if *self == Self::Png { &PNG_OPTIONS } else { &OPTIONS }
    }

    fn sheet(&self, plan: &Plan, schemes: &Schemes, options: &Options) -> Option<Result<Laid, Refused>> {
        Some(sheet_of(plan, schemes, options))
    }

    fn write(&self, plans: &[NamedPlan<'_>], schemes: &Schemes, options: &Options) -> Result<Export, Refused> {
        let mut export = Export::default();
        for NamedPlan { stem, plan } in plans {
            let laid = sheet_of(plan, schemes, options)?;
            let missing = missing_letters(&laid.scene);
            let picture = plan.backdrop().map(|_| "the traced picture".to_owned());
            let letters = (!missing.is_empty()).then(|| {
                let letters: Vec<String> = missing.iter().take(10).map(char::to_string).collect();
                format!("letters that its font lacks, drawn as boxes: {}", letters.join(" "))
            });
            let lost = picture.into_iter().chain(letters);
            export.lost.extend(lost.map(|what| Lost { stem: (*stem).to_owned(), what }));
            let (ending, bytes) = match self {
                Self::Pdf => ("pdf", pdf(&laid.scene, Facts { title: title(plan, stem), subject: &laid.in_words() })),
                Self::Svg => ("svg", svg::svg_in_mm(&laid.scene, laid.size_mm).into_bytes()),
                Self::Png => ("png", pixels(laid, options)?),
            };
            export.files.push(NamedBytes { name: format!("{stem}.{ending}"), bytes });
        }
        Ok(export)
    }
}

fn title<'a>(plan: &'a Plan, stem: &'a str) -> &'a str {
    let name = plan.meta().name.trim();
    if name.is_empty() { stem } else { name }
}

fn sheet_of(plan: &Plan, schemes: &Schemes, options: &Options) -> Result<Laid, Refused> {
    let of = |choice: &Choice| options.choice(choice);
    let sheet = Sheet {
        paper: Paper::ALL.into_iter().find(|paper| paper.name() == of(&PAPER)).unwrap_or_default(),
        orientation: Orientation::ALL.into_iter().find(|turn| turn.name() == of(&ORIENTATION)).unwrap_or_default(),
        scale: of(&SCALE).strip_prefix("1:").and_then(|scale| scale.parse().ok()),
        title_block: options.switch(&TITLE_BLOCK),
        legend: options.switch(&LEGEND),
        scale_bar: options.switch(&SCALE_BAR),
        dimensions: options.switch(&DIMENSIONS),
    };
    let layers = Layers {
        names: options.switch(&NAMES),
        areas: options.switch(&AREAS),
        graph: options.switch(&GRAPH),
        ..Layers::default()
    };
    let style = Style {
        fill: Fill::ALL.into_iter().find(|fill| fill.name() == of(&COLOURED_BY)).unwrap_or_default(),
        label_colours: LabelColours::ALL.into_iter().find(|it| it.name() == of(&PALETTE)).unwrap_or_default(),
        units: if of(&UNITS) == "imperial" { Units::Imperial } else { Units::Metric },
        layers,
        ..Style::default()
    };
    let analysis = analyse(plan, schemes, NeighbourLabels::True);
    laid_out(&Drawing::new(plan, &analysis), &style, &sheet).map_err(Refused)
}

/// The sheet as a PNG file that says how large a dot is.
fn pixels(mut laid: Laid, options: &Options) -> Result<Vec<u8>, Refused> {
    let dpi = options.number(&DPI).unwrap_or(150.0);
    laid.scene.view.pixel_ratio = dpi / 96.0;
    let [width, height] = laid.size_mm.map(|side| side * PX_PER_MM * dpi / 96.0);
    let longest = width.max(height);
    if longest > f64::from(png::LARGEST_SIDE_PX) {
        let most = (dpi * f64::from(png::LARGEST_SIDE_PX) / longest).floor();
        return Err(Refused(format!(
            "{} at {dpi} dots to the inch is {longest:.0} pixels wide, more than {}; take up to dpi={most}, or PDF",
            laid.paper.name(),
            png::LARGEST_SIDE_PX
        )));
    }
    png::png_to_print(&laid.scene, (dpi / 0.0254).round() as u32).map_err(|error| Refused(error.to_string()))
}

/// The letters of a scene that the bundled font lacks, and that are drawn as boxes; each once, in order.
pub fn missing_letters(scene: &Scene) -> Vec<char> {
    let mut missing: Vec<char> = Vec::new();
    for item in scene.groups.iter().flat_map(|group| &group.items) {
        if let Item::Text(text) = item {
            missing.extend(text.content.chars().filter(|&letter| !Font::of(text.weight).has(letter)));
        }
    }
    missing.sort_unstable();
    missing.dedup();
    missing
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draw::paper::SCALES;

    #[test]
    fn the_words_are_those_of_the_sheet() {
        let scales: Vec<String> = SCALES.iter().map(|scale| format!("1:{scale}")).collect();
        assert_eq!(SCALE.words[1..], scales);
        assert_eq!(PAPER.words, Paper::ALL.map(Paper::name));
        assert_eq!(ORIENTATION.words, Orientation::ALL.map(Orientation::name));
        assert!(COLOURED_BY.words.iter().all(|word| Fill::ALL.iter().any(|fill| fill.name() == *word)));
        assert_eq!(PALETTE.words, LabelColours::ALL.map(LabelColours::name));
    }
}
