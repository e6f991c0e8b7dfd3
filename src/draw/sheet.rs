//! A plan on a page: title above, scale bar and legend below, nothing over the plan. Plans do not tell where north is,
//! so neither does the page.

use super::drawing::Drawing;
use super::font::{CAP_HEIGHT, Font, LINE_HEIGHT};
use super::scene::{Anchor, Frame, Group, Item, Layer, Length, Scene, Text, View, Weight};
use super::{Fill, Layers, Palette, Rgba, Style};
use crate::geometry::{Bounds, Point, Vector};
use crate::labels::function_title;
use crate::labels::{Label, normalised_function};

/// The size of a page in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PageSize {
    /// The longer side; the other depends on the plan.
    Longest(f64),
    /// Width and height.
    Exact(f64, f64),
}

/// What a page shows beside the plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Furniture {
    pub title: bool,
    pub legend: bool,
    /// The scale bar.
    pub scale: bool,
}

impl Default for Furniture {
    fn default() -> Self {
        Self { title: true, legend: true, scale: true }
    }
}

/// A page whose longer side is shorter than this, in pixels, shows the plan alone.
const SMALLEST_PAGE_PX: f64 = 320.0;

/// A page whose longer side is shorter than this, in pixels, shows no names.
const SMALLEST_NAMED_PAGE_PX: f64 = 200.0;

/// The font size of title and legend in pixels: it grows with the page, so that a larger picture shows
/// the same in more detail.
pub(super) fn sheet_text_px(longest_px: f64) -> f64 {
    (longest_px / 130.0).clamp(11.0, 64.0)
}

/// The font size of room names in pixels: larger where rooms are large on the page.
fn name_text_px(drawing: &Drawing, px_per_m: f64, sheet_text_px: f64) -> f64 {
    let mut sides_px: Vec<f64> = drawing.rooms.iter().map(|room| room.area_m2.sqrt() * px_per_m).collect();
    sides_px.sort_by(f64::total_cmp);
    let median_px = sides_px.get(sides_px.len() / 2).copied().unwrap_or(0.0);
    // Ten letters take a third of a room's width.
    (median_px / 16.0).clamp(sheet_text_px, 1.5 * sheet_text_px).round()
}

/// The scene of a plan on a page. Text sizes come from the page, not the style.
pub fn page(drawing: &Drawing, style: &Style, size: PageSize, furniture: Furniture) -> Scene {
    let longest = match size {
        PageSize::Longest(longest) => longest,
        PageSize::Exact(width, height) => width.max(height),
    };
    let furniture =
        if longest < SMALLEST_PAGE_PX { Furniture { title: false, legend: false, scale: false } } else { furniture };
    let text = sheet_text_px(longest);
    let bare = !(furniture.title || furniture.legend || furniture.scale);
    let margin = if bare { (longest * 0.03).max(2.0) } else { 2.0 * text };
    let bounds = drawing.bounds();
    let (plan_width, plan_height) = (bounds.width().max(0.1), bounds.height().max(0.1));

    let title = if furniture.title { title_lines(drawing, style) } else { Vec::new() };
    let top = if title.is_empty() { margin } else { margin + title_height(&title, text) + 0.9 * text };
    let entries = if furniture.legend { legend_entries(drawing, style) } else { Vec::new() };
    let bottom = |width: f64| {
        let band = Band::new(&entries, width, margin, text, furniture.scale);
        if band.height > 0.0 { band.height + 1.2 * text + margin } else { margin }
    };

    let (width, height) = match size {
        PageSize::Exact(width, height) => (width, height),
        PageSize::Longest(longest) => {
            let height = (longest - 2.0 * margin) * plan_height / plan_width + top + bottom(longest);
            if height <= longest {
                // A long narrow building still gets a page of reasonable proportions.
                (longest, height.max(longest * 0.3).round())
            } else {
                let narrow = |width: f64| (longest - top - bottom(width)) * plan_width / plan_height + 2.0 * margin;
                let width = narrow(longest);
                // The bands below may need more rows on the narrower page: repeat with those.
                let width = narrow(width.clamp(longest * 0.5, longest));
                (width.clamp(longest * 0.5, longest).round(), longest)
            }
        }
    };
    let band = Band::new(&entries, width, margin, text, furniture.scale);
    let bottom = bottom(width);
    let free = Bounds { min: Point::new(margin, top), max: Point::new(width - margin, height - bottom) };
    let fitted = View::fitting(bounds, free.width().max(1.0), free.height().max(1.0), 0.0);
    // The middle of the page's free part shows the middle of the plan.
    let shift = Point::new(width / 2.0, height / 2.0) - free.center();
    let centre = fitted.centre + Vector::new(shift.x, -shift.y) * (1.0 / fitted.px_per_m);
    let view = View { width_px: width, height_px: height, centre, ..fitted };

    // On a thumbnail names would be unreadable.
    let layers = if longest < SMALLEST_NAMED_PAGE_PX {
        Layers { names: false, areas: false, ..style.layers }
    } else {
        style.layers
    };
    let style = &Style { text_px: name_text_px(drawing, view.px_per_m, text), layers, ..style.clone() };
    let mut scene = drawing.scene(style, &view);
    if style.layers.grid {
        // Under the plan only, and a little beyond it.
        let beyond = bounds.inflated(margin / 2.0 / view.px_per_m);
        scene.groups.retain(|group| group.layer != Layer::Grid);
        let first = scene.groups.iter().take_while(|group| group.layer < Layer::Grid).count();
        scene.groups.splice(first..first, super::drawing::grid(style, view.px_per_m, beyond));
    }
    let mut items = Vec::new();
    let palette = style.palette();
    let mut baseline = margin;
    for (i, (line, weight, factor)) in title.into_iter().enumerate() {
        let size = text * factor;
        baseline += size * if i == 0 { CAP_HEIGHT } else { LINE_HEIGHT * 1.1 };
        let content = fitted_text(&line, weight, size, width - 2.0 * margin);
        let colour = if i == 0 { palette.ink } else { palette.ink_muted };
        items.push(text_item(Point::new(margin, baseline), content, size, weight, colour, Anchor::Start));
    }
    let foot = height - margin;
    if furniture.scale && !drawing.bounds().is_empty() {
        items.extend(scale_bar(palette, &view, Point::new(margin, foot), text));
    }
    items.extend(legend(palette, &entries, &band, width - margin, foot, text));
    if !items.is_empty() {
        scene.groups.push(Group::new(Layer::Sheet, Frame::Screen, items));
    }
    scene
}

pub(super) fn text_item(
    at: Point,
    content: String,
    size_px: f64,
    weight: Weight,
    colour: Rgba,
    anchor: Anchor,
) -> Item {
    Item::Text(Text {
        at,
        offset_px: Vector::default(),
        content,
        size_px,
        weight,
        colour,
        halo: None,
        anchor,
        upright: false,
    })
}

/// A text cut with an ellipsis if it is wider than `width_px`.
pub(super) fn fitted_text(text: &str, weight: Weight, size_px: f64, width_px: f64) -> String {
    let font = Font::of(weight);
    if font.width_px(text, size_px) <= width_px {
        return text.to_owned();
    }
    let mut kept = String::new();
    let mut used = font.width_px("…", size_px);
    for letter in text.chars() {
        used += f64::from(font.advance(letter)) * size_px;
        if used > width_px {
            break;
        }
        kept.push(letter);
    }
    kept.truncate(kept.trim_end().len());
    kept + "…"
}

/// The title and the lines below it, each with its weight and relative size.
fn title_lines(drawing: &Drawing, style: &Style) -> Vec<(String, Weight, f64)> {
    let meta = &drawing.meta;
    let name = [&meta.name, &meta.building].into_iter().map(|text| text.trim()).find(|text| !text.is_empty());
    let Some(name) = name else { return Vec::new() };
    let mut details: Vec<String> = Vec::new();
    for text in [meta.building.trim(), meta.storey.trim()] {
        if !text.is_empty() && text != name && !details.iter().any(|detail| detail == text) {
            details.push(text.to_owned());
        }
    }
    details.extend(meta.typology.as_ref().map(crate::labels::Typology::title));
    if style.layers.areas && drawing.rooms.iter().any(|room| room.has_walls) {
        details.push("clear areas, between wall faces".to_owned());
    }
    let mut lines = vec![(name.to_owned(), Weight::SemiBold, 1.6)];
    if !details.is_empty() {
        lines.push((details.join(" · "), Weight::Regular, 1.0));
    }
    if !drawing.caveat.is_empty() {
        lines.push((drawing.caveat.clone(), Weight::Regular, 1.0));
    }
    lines
}

fn title_height(lines: &[(String, Weight, f64)], text: f64) -> f64 {
    lines
        .iter()
        .enumerate()
        .map(|(i, (_, _, factor))| text * factor * if i == 0 { CAP_HEIGHT } else { LINE_HEIGHT * 1.1 })
        .sum()
}

pub(super) struct Entry {
    pub colour: Rgba,
    pub text: String,
}

/// The meanings of the fills, with the number of rooms of each.
pub(super) fn legend_entries(drawing: &Drawing, style: &Style) -> Vec<Entry> {
    let palette = style.palette();
    match style.fill {
        Fill::None => Vec::new(),
        Fill::Label | Fill::Prediction => {
            let is_predicted = style.fill == Fill::Prediction;
            let (labelled, unlabelled, not_classified) =
                if is_predicted { drawing.predicted_counts() } else { drawing.counts() };
            let unlabelled_name = if is_predicted { "no prediction" } else { "no label" };
            let named = Label::ALL
                .into_iter()
                .map(|label| (palette.label(label), label.name(), labelled[label.index()]))
                .chain([
                    (palette.unlabelled, unlabelled_name, unlabelled),
                    (palette.not_classified, "not classified", not_classified),
                ]);
            named
                .filter(|&(_, _, count)| count > 0)
                .map(|(colour, name, count)| Entry { colour, text: format!("{} {count}", function_title(name)) })
                .collect()
        }
        Fill::Function => {
            let colours = drawing.function_colours(palette);
            let mut counts: Vec<(String, usize)> = Vec::new();
            for function in colours.keys() {
                let count =
                    drawing.rooms.iter().filter(|room| normalised_function(&room.function) == *function).count();
                counts.push((function.clone(), count));
            }
            // Most frequent first; ties stay alphabetical.
            counts.sort_by_key(|&(_, count)| std::cmp::Reverse(count));
            counts
                .into_iter()
                .map(|(function, count)| Entry {
                    colour: colours.get(&function).copied().unwrap_or(palette.unlabelled),
                    text: format!("{} {count}", function_title(&function)),
                })
                .collect()
        }
    }
}

/// Height of a legend row, height of the scale bar with its figures, and width reserved for the bar, as
/// factors of the text size.
pub(super) const ROW: f64 = 1.7;
pub(super) const SCALE_HEIGHT: f64 = 2.4;
const SCALE_WIDTH: f64 = 15.0;

/// The most rows in a legend; the rest is counted in a last entry.
const MOST_ROWS: usize = 4;

/// Width of an entry: swatch, text, and the gap to the next.
fn entry_width(entry: &str, text: f64) -> f64 {
    1.9 * text + Font::of(Weight::Regular).width_px(entry, text) + 1.5 * text
}

/// The layout of scale and legend below the plan: side by side, or on a narrow page the legend above the
/// scale.
pub(super) struct Band {
    pub height: f64,
    /// Left edge of the legend.
    left: f64,
    /// Height of the legend's last line above the foot of the page.
    lift: f64,
    /// Indices of the legend's entries, row by row.
    rows: Vec<Vec<usize>>,
}

impl Band {
    pub fn new(entries: &[Entry], width: f64, margin: f64, text: f64, has_scale: bool) -> Self {
        let scale_width = if has_scale { (SCALE_WIDTH + 3.0) * text } else { 0.0 };
        let scale_height = if has_scale { SCALE_HEIGHT * text } else { 0.0 };
        // Whether there is room for an entry or two.
        let is_stacked = has_scale && !entries.is_empty() && width - 2.0 * margin - scale_width < 22.0 * text;
        let left = if is_stacked { margin } else { margin + scale_width };
        let rows = legend_rows(entries, width - margin - left, text);
        let legend_height = rows.len() as f64 * ROW * text;
        if is_stacked {
            let lift = scale_height + 0.8 * text;
            Self { height: legend_height + lift, left, lift, rows }
        } else {
            Self { height: legend_height.max(scale_height), left, lift: 0.0, rows }
        }
    }
}

/// The entries' indices, row by row.
pub(super) fn legend_rows(entries: &[Entry], free: f64, text: f64) -> Vec<Vec<usize>> {
    let mut rows: Vec<Vec<usize>> = Vec::new();
    let mut used = f64::INFINITY;
    for (i, entry) in entries.iter().enumerate() {
        // The gap after the last entry of a row may run over.
        let needed = entry_width(&entry.text, text);
        if used + needed - 1.5 * text > free {
            if rows.len() == MOST_ROWS {
                break;
            }
            rows.push(Vec::new());
            used = 0.0;
        }
        if let Some(row) = rows.last_mut() {
            row.push(i);
        }
        used += needed;
    }
    rows
}

/// The legend: right-aligned, or left-aligned if above the scale.
pub(super) fn legend(palette: &Palette, entries: &[Entry], band: &Band, right: f64, foot: f64, text: f64) -> Vec<Item> {
    let rows = &band.rows;
    let shown: usize = rows.iter().map(Vec::len).sum();
    let widest = rows
        .iter()
        .map(|row| row.iter().map(|&i| entry_width(&entries[i].text, text)).sum::<f64>() - 1.5 * text)
        .fold(0.0, f64::max);
    let left = if band.lift > 0.0 { band.left } else { (right - widest).max(band.left) };
    let mut items = Vec::new();
    let last_row = rows.len().saturating_sub(1);
    for (i, row) in rows.iter().enumerate() {
        let baseline = foot - band.lift - (last_row - i) as f64 * ROW * text - 0.2 * text;
        let mut x = left;
        for (j, &index) in row.iter().enumerate() {
            let entry = &entries[index];
            let is_last = i == last_row && j + 1 == row.len() && shown < entries.len();
            let (top, low) = (baseline - 0.85 * text, baseline + 0.12 * text);
            let swatch: Vec<Point> = [(x, top), (x + 1.4 * text, top), (x + 1.4 * text, low), (x, low)]
                .into_iter()
                .map(|(x, y)| Point::new(x.round(), y.round()))
                .collect();
            let content = if is_last {
                format!("and {} more", entries.len() - shown + 1)
            } else {
                items.push(Item::Polygon { outer: swatch.clone(), holes: Vec::new(), colour: entry.colour });
                let rim = swatch.iter().map(|corner| Point::new(corner.x + 0.5, corner.y + 0.5)).collect();
                items.push(Item::Line {
                    points: rim,
                    closed: true,
                    colour: palette.boundary,
                    width: Length::Px(1.0),
                    dash: None,
                });
                entry.text.clone()
            };
            items.push(text_item(
                Point::new(x + 1.9 * text, baseline),
                content,
                text,
                Weight::Regular,
                palette.ink,
                Anchor::Start,
            ));
            x += entry_width(&entry.text, text);
        }
    }
    items
}

/// A round length in metres (1, 2 or 5 times a power of ten) that is at most `longest_px` long.
pub fn scale_bar_m(px_per_m: f64, longest_px: f64) -> f64 {
    let longest_m = longest_px / px_per_m;
    // From 1 cm to 500 km: covers any possible view.
    let mut best = 0.01;
    let mut decade = 0.01;
    for _ in 0..8 {
        for factor in [1.0, 2.0, 5.0] {
            if decade * factor <= longest_m {
                best = decade * factor;
            }
        }
        decade *= 10.0;
    }
    best
}

/// A bar in four pieces, every other one filled, with figures above; `foot` is its lower left corner.
pub(super) fn scale_bar(palette: &Palette, view: &View, foot: Point, text: f64) -> Vec<Item> {
    let length_m = scale_bar_m(view.px_per_m, (SCALE_WIDTH - 2.5) * text);
    let length = length_m * view.px_per_m;
    let height = (0.45 * text).round().max(3.0);
    let (left, low) = (foot.x.round(), foot.y.round());
    let top = low - height;
    let at = |share: f64| left + length * share;
    let mut items = Vec::new();
    for (from, to) in [(0.0, 0.25), (0.5, 0.75)] {
        let outer = vec![
            Point::new(at(from), top),
            Point::new(at(to), top),
            Point::new(at(to), low),
            Point::new(at(from), low),
        ];
        items.push(Item::Polygon { outer, holes: Vec::new(), colour: palette.ink });
    }
    let rim = [(0.0, top), (1.0, top), (1.0, low), (0.0, low)];
    items.push(Item::Line {
        points: rim.iter().map(|&(share, y)| Point::new(at(share), y)).collect(),
        closed: true,
        colour: palette.ink,
        width: Length::Px(1.0),
        dash: None,
    });
    let (figure, unit) = if length_m >= 1.0 { (length_m, "m") } else { (length_m * 100.0, "cm") };
    let size = text * 0.88;
    for (share, content) in
        [(0.0, "0".to_owned()), (0.5, plain_number(figure / 2.0)), (1.0, format!("{} {unit}", plain_number(figure)))]
    {
        let anchor = if share == 0.0 { Anchor::Start } else { Anchor::Middle };
        let place = Point::new(at(share), top - 0.45 * text);
        items.push(text_item(place, content, size, Weight::Regular, palette.ink_muted, anchor));
    }
    items
}

fn plain_number(value: f64) -> String {
    let text = format!("{value:.2}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scale_bars_have_round_lengths() {
        for (px_per_m, longest_px, expected_m) in
            [(33.0, 170.0, 5.0), (10.0, 200.0, 20.0), (0.5, 100.0, 200.0), (400.0, 100.0, 0.2), (1e9, 1.0, 0.01)]
        {
            assert_eq!(scale_bar_m(px_per_m, longest_px), expected_m, "{px_per_m}");
        }
    }

    #[test]
    fn long_titles_are_cut_off() {
        let short = fitted_text("A very long title of a plan", Weight::SemiBold, 20.0, 120.0);
        assert!(short.ends_with('…') && Font::of(Weight::SemiBold).width_px(&short, 20.0) <= 120.0, "{short}");
        assert_eq!(fitted_text("Short", Weight::Regular, 10.0, 120.0), "Short");
    }
}
