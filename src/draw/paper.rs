//! A plan to scale on a sheet of paper: frame, title block, legend and scale bar around it, and the overall
//! dimensions. One logical pixel is 1/96 inch of paper.

use super::drawing::Drawing;
use super::font::Font;
use super::scene::{Anchor, Frame, Group, Item, Layer, Length, Scene, Text, View, Weight};
use super::sheet::{Entry, ROW, SCALE_HEIGHT, fitted_text, legend_entries, scale_bar, text_item};
use super::{Layers, Palette, Rgba, Style};
use crate::base::units::Units;
use crate::base::wording::count;
use crate::geometry::{Bounds, Point, Vector};

/// Logical pixels in a millimetre of paper.
pub const PX_PER_MM: f64 = 96.0 / 25.4;

/// A size of paper (ISO 216).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Paper {
    #[default]
    A4,
    A3,
    A2,
    A1,
    A0,
}

impl Paper {
    pub const ALL: [Self; 5] = [Self::A4, Self::A3, Self::A2, Self::A1, Self::A0];

    /// Its name on the command line and in the interface.
    pub const fn name(self) -> &'static str {
        match self {
            Self::A4 => "A4",
            Self::A3 => "A3",
            Self::A2 => "A2",
            Self::A1 => "A1",
            Self::A0 => "A0",
        }
    }

    /// Its shorter and its longer side in millimetres.
    pub const fn sides_mm(self) -> [f64; 2] {
        match self {
            Self::A4 => [210.0, 297.0],
            Self::A3 => [297.0, 420.0],
            Self::A2 => [420.0, 594.0],
            Self::A1 => [594.0, 841.0],
            Self::A0 => [841.0, 1189.0],
        }
    }
}

/// How the paper is turned.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Orientation {
    /// The way that shows the plan larger; landscape if both do.
    #[default]
    Auto,
    Landscape,
    Portrait,
}

impl Orientation {
    pub const ALL: [Self; 3] = [Self::Auto, Self::Landscape, Self::Portrait];

    /// Its name on the command line and in the interface.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Landscape => "landscape",
            Self::Portrait => "portrait",
        }
    }

    /// The ways to turn the paper that it allows.
    const fn turns(self) -> &'static [Self] {
        match self {
            Self::Auto => &[Self::Landscape, Self::Portrait],
            Self::Landscape => &[Self::Landscape],
            Self::Portrait => &[Self::Portrait],
        }
    }
}

/// The scales offered, as how many metres a metre of paper shows: the usual ones of architects, largest scale first.
pub const SCALES: [u32; 12] = [20, 25, 50, 75, 100, 125, 150, 200, 250, 500, 1000, 2000];

/// What is put on a sheet.
#[derive(Clone, Debug, PartialEq)]
pub struct Sheet {
    pub paper: Paper,
    pub orientation: Orientation,
    /// How many metres a metre of paper shows; `None` for the largest scale of [`SCALES`] that fits.
    pub scale: Option<u32>,
    pub title_block: bool,
    pub legend: bool,
    pub scale_bar: bool,
    /// The overall width and height, outside the plan.
    pub dimensions: bool,
}

impl Default for Sheet {
    fn default() -> Self {
        Self {
            paper: Paper::default(),
            orientation: Orientation::default(),
            scale: None,
            title_block: true,
            legend: true,
            scale_bar: true,
            dimensions: true,
        }
    }
}

/// A sheet as it will be printed.
#[derive(Clone, Debug)]
pub struct Laid {
    pub scene: Scene,
    pub paper: Paper,
    pub is_landscape: bool,
    /// Width and height of the paper in millimetres.
    pub size_mm: [f64; 2],
    /// How many metres a metre of paper shows.
    pub scale: u32,
}

impl Laid {
    /// Paper and scale in words: 'A3 landscape, 1:100'.
    pub fn in_words(&self) -> String {
        format!("{} {}, 1:{}", self.paper.name(), turn_name(self.is_landscape), self.scale)
    }
}

const fn turn_name(is_landscape: bool) -> &'static str {
    if is_landscape { "landscape" } else { "portrait" }
}

/// Distance of the frame from the edge of the paper: what printers can print, and room for a punch.
const MARGIN_MM: f64 = 10.0;

/// Space around the plan within the frame.
const AROUND_MM: f64 = 6.0;

/// Space for a chain of dimensions beside the plan.
const CHAIN_MM: f64 = 9.0;

/// The title block: its largest width, and its height.
const BLOCK_WIDTH_MM: f64 = 180.0;
const BLOCK_HEIGHT_MM: f64 = 30.0;

/// The least width beside the title block for legend and scale bar; with less they stand above it.
const BESIDE_MM: f64 = 85.0;

/// Letters of legend and title block, and of the names of rooms: 2.6 and 2.9 mm.
const TEXT_PX: f64 = 10.0;
const NAMES_PX: f64 = 11.0;

/// Where everything goes on a sheet, in millimetres from the upper left corner of the paper.
struct Layout {
    size_mm: [f64; 2],
    is_landscape: bool,
    /// The part of the paper for the plan.
    plan: Bounds,
    block: Option<Bounds>,
    /// Legend and scale bar.
    band: Option<Bounds>,
    rows: Vec<Vec<usize>>,
}

impl Layout {
    fn new(sheet: &Sheet, entries: &[Entry], paper: Paper, turn: Orientation) -> Self {
        let [short, long] = paper.sides_mm();
        let is_landscape = turn != Orientation::Portrait;
        let size_mm = if is_landscape { [long, short] } else { [short, long] };
        let frame = Bounds {
            min: Point::new(MARGIN_MM, MARGIN_MM),
            max: Point::new(size_mm[0] - MARGIN_MM, size_mm[1] - MARGIN_MM),
        };
        let block_width = if frame.width() - BLOCK_WIDTH_MM < BESIDE_MM && !is_landscape {
            frame.width()
        } else {
            BLOCK_WIDTH_MM.min(frame.width())
        };
        let block = sheet.title_block.then(|| Bounds {
            min: Point::new(frame.max.x - block_width, frame.max.y - BLOCK_HEIGHT_MM),
            max: frame.max,
        });
        let has_band = sheet.scale_bar || (sheet.legend && !entries.is_empty());
        let pad = if sheet.title_block { 4.0 } else { 0.0 };
        let beside = frame.width() - block.map_or(0.0, |block| block.width());
        let is_beside = block.is_none() || beside >= BESIDE_MM;
        let band_width = if is_beside { beside } else { frame.width() } - 2.0 * pad;
        let rows = if sheet.legend { rows_of(entries, band_width) } else { Vec::new() };
        let text_mm = TEXT_PX / PX_PER_MM;
        let bar = if sheet.scale_bar { SCALE_HEIGHT * text_mm } else { 0.0 };
        let gap = if sheet.scale_bar && !rows.is_empty() { 2.0 } else { 0.0 };
        let needed = bar + gap + rows.len() as f64 * ROW * text_mm;
        let foot = match (block, is_beside) {
            (Some(block), false) => block.min.y,
            _ => frame.max.y,
        };
        let band = has_band.then(|| Bounds {
            min: Point::new(frame.min.x + pad, foot - needed - pad),
            max: Point::new(frame.min.x + pad + band_width, foot - pad),
        });
        let low = [block.map(|block| block.min.y), band.map(|band| band.min.y)];
        let low = low.into_iter().flatten().fold(frame.max.y, f64::min);
        let around = if sheet.title_block { AROUND_MM } else { 0.0 };
        let chain = if sheet.dimensions { CHAIN_MM } else { 0.0 };
        let plan = Bounds {
            min: Point::new(frame.min.x + around + chain, frame.min.y + around),
            max: Point::new(frame.max.x - around, low - AROUND_MM - chain),
        };
        Self { size_mm, is_landscape, plan, block, band, rows }
    }

    /// Whether a plan of a size in metres fits at a scale.
    fn fits(&self, size_m: [f64; 2], scale: u32) -> bool {
        let mm = |metres: f64| metres * 1000.0 / f64::from(scale);
        // A hundredth of a millimetre is no reason to refuse.
        mm(size_m[0]) <= self.plan.width() + 0.01 && mm(size_m[1]) <= self.plan.height() + 0.01
    }
}

/// The indices of the legend's entries, row by row.
fn rows_of(entries: &[Entry], width_mm: f64) -> Vec<Vec<usize>> {
    super::sheet::legend_rows(entries, width_mm * PX_PER_MM, TEXT_PX)
}

/// A plan on a sheet of paper. Text sizes come from the paper, not the style.
///
/// # Errors
/// When the plan is too large for the paper at the scale; the text says which scale or paper fits.
pub fn laid_out(drawing: &Drawing, style: &Style, sheet: &Sheet) -> Result<Laid, String> {
    let entries = if sheet.legend { legend_entries(drawing, style) } else { Vec::new() };
    let bounds = drawing.bounds();
    let size_m = if bounds.is_empty() { [0.0; 2] } else { [bounds.width(), bounds.height()] };
    let layouts = |paper: Paper| {
        let turns = sheet.orientation.turns().iter();
        turns.map(move |&turn| (paper, turn)).collect::<Vec<_>>()
    };
    let layout = |(paper, turn): (Paper, Orientation)| Layout::new(sheet, &entries, paper, turn);
    let best = |paper: Paper| {
        let all: Vec<Layout> = layouts(paper).into_iter().map(layout).collect();
        SCALES.into_iter().find(|&scale| all.iter().any(|layout| layout.fits(size_m, scale)))
    };
    let wanted = sheet.scale.or_else(|| best(sheet.paper));
    let found = wanted.and_then(|scale| {
        layouts(sheet.paper).into_iter().map(layout).find(|layout| layout.fits(size_m, scale)).map(|it| (it, scale))
    });
    let Some((layout, scale)) = found else {
        return Err(too_small(sheet, size_m, &layout((sheet.paper, sheet.orientation)), best));
    };
    Ok(paint(drawing, style, sheet, &entries, layout, scale))
}

/// Why a plan does not fit, and what does.
fn too_small(sheet: &Sheet, size_m: [f64; 2], layout: &Layout, best: impl Fn(Paper) -> Option<u32>) -> String {
    let shown = |scale: u32| size_m.map(|side| (side * 1000.0 / f64::from(scale)).ceil());
    let paper = sheet.paper.name();
    let turned =
        if sheet.orientation == Orientation::Auto { String::new() } else { format!(" {}", sheet.orientation.name()) };
    let (free_width, free_height) = (layout.plan.width().max(0.0).floor(), layout.plan.height().max(0.0).floor());
    let Some(scale) = sheet.scale else {
        let [width, height] = size_m;
        return match Paper::ALL.into_iter().filter(|&other| other > sheet.paper).find(|&other| best(other).is_some()) {
            Some(other) => {
                format!("the plan does not fit {paper}{turned} at any scale down to 1:2000; use {}", other.name())
            }
            None => format!("the plan of {width:.0} x {height:.0} m fits no sheet up to A0 at 1:2000"),
        };
    };
    let [width, height] = shown(scale);
    let fitting_scale = best(sheet.paper).filter(|&other| other > scale).map(|other| format!("1:{other}"));
    let fitting_paper = Paper::ALL
        .into_iter()
        .filter(|&other| other > sheet.paper)
        .find(|&other| best(other).is_some_and(|most| most <= scale))
        .map(|other| other.name().to_owned());
    let remedy = match (fitting_scale, fitting_paper) {
        (Some(scale), Some(paper)) => format!("use {scale} or {paper}"),
        (Some(one), None) | (None, Some(one)) => format!("take {one}"),
        (None, None) => "no scale and no paper up to A0 fits".to_owned(),
    };
    format!(
        "at 1:{scale} the plan is {width:.0} x {height:.0} mm, and {paper}{turned} has {free_width:.0} x \
         {free_height:.0} mm for it; {remedy}"
    )
}

fn px(mm: f64) -> f64 {
    mm * PX_PER_MM
}

fn paint(drawing: &Drawing, style: &Style, sheet: &Sheet, entries: &[Entry], layout: Layout, scale: u32) -> Laid {
    let Layout { size_mm, is_landscape, plan, block, band, rows } = layout;
    let px_per_m = 1000.0 / f64::from(scale) * PX_PER_MM;
    let bounds = drawing.bounds();
    let middle = if bounds.is_empty() { Point::default() } else { bounds.center() };
    // The middle of the plan's part of the paper shows the middle of the plan.
    let shift = Vector::new(size_mm[0] / 2.0 - plan.center().x, size_mm[1] / 2.0 - plan.center().y);
    let centre = middle + Vector::new(px(shift.x), -px(shift.y)) * (1.0 / px_per_m);
    let view = View { width_px: px(size_mm[0]), height_px: px(size_mm[1]), px_per_m, centre, pixel_ratio: 1.0 };
    let layers = Layers { grid: false, ..style.layers };
    let style = Style { text_px: NAMES_PX, layers, ..style.clone() };
    let palette = style.palette();
    let mut scene = drawing.scene(&style, &view);
    let mut items = Vec::new();
    if sheet.dimensions && !bounds.is_empty() {
        overall(&mut items, palette, &view, bounds, drawing.built_bounds(), style.units);
    }
    if sheet.title_block {
        let frame = Bounds {
            min: Point::new(MARGIN_MM, MARGIN_MM),
            max: Point::new(size_mm[0] - MARGIN_MM, size_mm[1] - MARGIN_MM),
        };
        items.push(outline(frame, palette.ink, 1.5));
    }
    if let Some(block) = block {
        let paper = format!("{} {}", sheet.paper.name(), turn_name(is_landscape));
        title_block(&mut items, drawing, palette, block, &paper, scale, style.units);
    }
    if let Some(band) = band {
        legend(&mut items, palette, entries, &rows, band);
        if sheet.scale_bar && !bounds.is_empty() {
            items.extend(scale_bar(palette, &view, Point::new(px(band.min.x), px(band.max.y)), TEXT_PX));
        }
    }
    if !items.is_empty() {
        scene.groups.push(Group::new(Layer::Sheet, Frame::Screen, items));
    }
    Laid { scene, paper: sheet.paper, is_landscape, size_mm, scale }
}

fn line(from: Point, to: Point, colour: Rgba, width_px: f64) -> Item {
    Item::Line { points: vec![from, to], closed: false, colour, width: Length::Px(width_px), dash: None }
}

/// The outline of a box given in millimetres.
fn outline(of: Bounds, colour: Rgba, width_px: f64) -> Item {
    let Bounds { min, max } = of;
    let corners = [(min.x, min.y), (max.x, min.y), (max.x, max.y), (min.x, max.y)];
    let points = corners.map(|(x, y)| Point::new(px(x), px(y))).to_vec();
    Item::Line { points, closed: true, colour, width: Length::Px(width_px), dash: None }
}

/// The overall width below the plan and height to its left: over the outer faces of the walls.
fn overall(items: &mut Vec<Item>, palette: &Palette, view: &View, around: Bounds, built: Bounds, units: Units) {
    let [low, high] = [built.min, built.max].map(|point| view.screen_from_plan(point));
    let (left, right, top, bottom) = (low.x, high.x, high.y, low.y);
    // Beside the dimension chains of the plan.
    let beside = view.screen_from_plan(around.min);
    let ink = palette.ink;
    let (offset, beyond, tick) = (px(6.0), px(1.5), px(1.2));
    let mut chain = |from: Point, to: Point, out: Vector, length_m: f64| {
        if length_m <= 0.0 {
            return;
        }
        let (a, b) = (from + out * offset, to + out * offset);
        items.push(line(a, b, ink, 0.75));
        for (foot, end) in [(from, a), (to, b)] {
            items.push(line(foot + out * beyond, end + out * beyond, palette.ink_muted, 0.5));
            // An architect's tick, rising to the right.
            items.push(line(end + Vector::new(-tick, tick), end + Vector::new(tick, -tick), ink, 1.25));
        }
        let upright = out.y == 0.0;
        let middle = a.lerp(b, 0.5);
        items.push(Item::Text(Text {
            at: if upright { middle + Vector::new(-px(0.9), 0.0) } else { middle + Vector::new(0.0, -px(0.9)) },
            offset_px: Vector::default(),
            content: units.length(length_m),
            size_px: TEXT_PX,
            weight: Weight::Regular,
            colour: ink,
            halo: None,
            anchor: Anchor::Middle,
            upright,
        }));
    };
    chain(Point::new(left, beside.y), Point::new(right, beside.y), Vector::new(0.0, 1.0), built.width());
    chain(Point::new(beside.x, bottom), Point::new(beside.x, top), Vector::new(-1.0, 0.0), built.height());
}

/// What the plan is, its scale and its size.
fn title_block(
    items: &mut Vec<Item>,
    drawing: &Drawing,
    palette: &Palette,
    block: Bounds,
    paper: &str,
    scale: u32,
    units: Units,
) {
    let (ink, muted) = (palette.ink, palette.ink_muted);
    items.push(outline(block, ink, 1.5));
    // Four cells at the right, two by two.
    let cell_width = if block.width() >= 150.0 { 32.0 } else { 26.0 };
    let cells_left = block.max.x - 2.0 * cell_width;
    let middle_y = (block.min.y + block.max.y) / 2.0;
    let at = |x: f64, y: f64| Point::new(px(x), px(y));
    items.push(line(at(cells_left, block.min.y), at(cells_left, block.max.y), ink, 0.75));
    items.push(line(at(cells_left + cell_width, block.min.y), at(cells_left + cell_width, block.max.y), ink, 0.75));
    items.push(line(at(cells_left, middle_y), at(block.max.x, middle_y), ink, 0.75));
    let area_m2: f64 = drawing.rooms.iter().map(|room| room.area_m2).sum();
    let cells = [
        (0.0, block.min.y, "Scale", format!("1:{scale}")),
        (1.0, block.min.y, "Sheet", paper.to_owned()),
        (0.0, middle_y, "Rooms", drawing.rooms.len().to_string()),
        (1.0, middle_y, "Area of rooms", units.area(area_m2)),
    ];
    let width = px(cell_width - 5.0);
    for (column, top, caption, value) in cells {
        let left = cells_left + column * cell_width + 2.5;
        let (small, large) = (9.0, 13.0);
        items.push(text_item(at(left, top + 4.6), caption.to_owned(), small, Weight::Regular, muted, Anchor::Start));
        let value = fitted_text(&value, Weight::SemiBold, large, width);
        items.push(text_item(at(left, top + 11.2), value, large, Weight::SemiBold, ink, Anchor::Start));
    }
    // The name, what it is part of, and where it comes from.
    let meta = &drawing.meta;
    let left = block.min.x + 3.5;
    let width = px(cells_left - left - 2.0);
    let name = [&meta.name, &meta.building].into_iter().map(|text| text.trim()).find(|text| !text.is_empty());
    let name = name.unwrap_or("Untitled plan");
    let mut put = |y: f64, text: &str, size: f64, weight: Weight, colour: Rgba| {
        let content = fitted_text(text, weight, size, width);
        items.push(text_item(at(left, block.min.y + y), content, size, weight, colour, Anchor::Start));
    };
    put(8.6, name, 18.0, Weight::SemiBold, ink);
    let mut details: Vec<String> = Vec::new();
    for text in [meta.building.trim(), meta.storey.trim()] {
        if !text.is_empty() && text != name && !details.iter().any(|detail| detail == text) {
            details.push(text.to_owned());
        }
    }
    details.extend(meta.typology.as_ref().map(crate::labels::Typology::title));
    put(14.4, &details.join(" · "), 11.0, Weight::Regular, ink);
    let origin: Vec<&str> =
        [meta.source.trim(), meta.licence.trim()].into_iter().filter(|text| !text.is_empty()).collect();
    put(20.6, &origin.join(" · "), 9.0, Weight::Regular, muted);
    let openings = count(drawing.openings.iter().filter(|opening| opening.is_passable()).count(), "opening");
    put(
        26.4,
        &format!("Lengths in {} · {openings} · drawn with Enfilade", unit_name(units)),
        9.0,
        Weight::Regular,
        muted,
    );
}

const fn unit_name(units: Units) -> &'static str {
    match units {
        Units::Metric => "metres",
        Units::Imperial => "feet and inches",
    }
}

/// The legend, from the upper left corner of the band.
fn legend(items: &mut Vec<Item>, palette: &Palette, entries: &[Entry], rows: &[Vec<usize>], band: Bounds) {
    let text = TEXT_PX;
    let shown: usize = rows.iter().map(Vec::len).sum();
    for (i, row) in rows.iter().enumerate() {
        let baseline = px(band.min.y) + (i as f64 + 0.75) * ROW * text;
        let mut x = px(band.min.x);
        for (j, &index) in row.iter().enumerate() {
            let entry = &entries[index];
            let is_last = i + 1 == rows.len() && j + 1 == row.len() && shown < entries.len();
            let content = if is_last {
                format!("and {} more", entries.len() - shown + 1)
            } else {
                let (top, low) = (baseline - 0.85 * text, baseline + 0.12 * text);
                let corners = [(x, top), (x + 1.4 * text, top), (x + 1.4 * text, low), (x, low)];
                let swatch: Vec<Point> = corners.into_iter().map(|(x, y)| Point::new(x, y)).collect();
                items.push(Item::Polygon { outer: swatch.clone(), holes: Vec::new(), colour: entry.colour });
                items.push(Item::Line {
                    points: swatch,
                    closed: true,
                    colour: palette.boundary,
                    width: Length::Px(0.75),
                    dash: None,
                });
                entry.text.clone()
            };
            let width = Font::of(Weight::Regular).width_px(&content, text);
            let place = Point::new(x + 1.9 * text, baseline);
            items.push(text_item(place, content, text, Weight::Regular, palette.ink, Anchor::Start));
            x += 1.9 * text + width + 1.5 * text;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::features::{NeighbourLabels, analyse};
    use crate::labels::Schemes;
    use crate::plan::Builder;

    /// An empty plan with two corners so far apart.
    fn drawing(width_m: f64, height_m: f64) -> Drawing {
        let mut builder = Builder::default();
        builder.corner(Point::new(0.0, 0.0));
        builder.corner(Point::new(width_m, height_m));
        let plan = builder.plan();
        Drawing::new(plan, &analyse(plan, &Schemes::bundled(), NeighbourLabels::True))
    }

    #[test]
    fn a_metre_is_as_long_as_the_scale_says() {
        for scale in [50, 100, 200] {
            let sheet = Sheet { paper: Paper::A0, scale: Some(scale), ..Sheet::default() };
            let laid = laid_out(&drawing(10.0, 8.0), &Style::default(), &sheet).unwrap();
            let mm = laid.scene.view.px_per_m / PX_PER_MM;
            assert!((mm - 1000.0 / f64::from(scale)).abs() < 1e-9, "{mm}");
        }
    }

    #[test]
    fn the_largest_scale_that_fits_is_taken_and_the_paper_turned() {
        let laid = |width, height, sheet: &Sheet| laid_out(&drawing(width, height), &Style::default(), sheet).unwrap();
        let wide = laid(20.0, 10.0, &Sheet::default());
        assert_eq!((wide.scale, wide.is_landscape), (100, true), "{}", wide.in_words());
        let tall = laid(10.0, 20.0, &Sheet::default());
        assert!(!tall.is_landscape && tall.scale == 100, "{}", tall.in_words());
        let turned = laid(10.0, 20.0, &Sheet { orientation: Orientation::Landscape, ..Sheet::default() });
        assert!(turned.is_landscape && turned.scale > 100);
        // Nothing is drawn: any scale fits.
        assert_eq!(laid(0.0, 0.0, &Sheet::default()).scale, 20);
    }

    #[test]
    fn a_sheet_too_small_is_refused_with_what_fits() {
        let sheet = Sheet { scale: Some(50), ..Sheet::default() };
        let refused = laid_out(&drawing(30.0, 15.0), &Style::default(), &sheet).unwrap_err();
        assert!(refused.starts_with("at 1:50 the plan is 600 x 300 mm, and A4 has"), "{refused}");
        assert!(refused.ends_with("use 1:125 or A1"), "{refused}");
        let refused = laid_out(&drawing(9000.0, 9000.0), &Style::default(), &Sheet::default()).unwrap_err();
        assert!(refused.contains("fits no sheet up to A0 at 1:2000"), "{refused}");
    }
}
