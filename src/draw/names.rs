//! Names and areas inside the rooms: as large as fits, wrapped, shortened, or omitted; never over a wall
//! or each other.

use super::elements::{NODE_RADIUS_PX, RoomDrawing};
use super::font::{self, Font};
use super::openings::OpeningDrawing;
use super::scene::{Anchor, Frame, Group, Item, Layer, Text, View, Weight};
use super::walls::Faces;
use super::{Rgba, SMALLEST_TEXT_PX, Style};
use crate::geometry::raster::Raster;
use crate::geometry::{Bounds, Point, Segment, Vector, polygon};
use crate::labels::function_title;

/// A summed-area table over a raster: the sum of any box takes four look-ups.
struct Sums {
    width: usize,
    sums: Vec<u32>,
}

impl Sums {
    fn new(raster: &Raster, value: impl Fn(usize) -> u32) -> Self {
        let width = raster.width + 1;
        let mut sums = vec![0; width * (raster.height + 1)];
        for row in 0..raster.height {
            let mut line = 0;
            for column in 0..raster.width {
                line += value(row * raster.width + column);
                sums[(row + 1) * width + column + 1] = sums[row * width + column + 1] + line;
            }
        }
        Self { width, sums }
    }

    fn of(&self, column: usize, row: usize, columns: usize, rows: usize) -> u32 {
        let at = |column: usize, row: usize| self.sums[row * self.width + column];
        at(column + columns, row + rows) + at(column, row) - at(column + columns, row) - at(column, row + rows)
    }
}

/// Lines of text in a room.
struct Block {
    lines: Vec<Line>,
    width_px: f64,
    height_px: f64,
    /// Turned 90 degrees to the left.
    upright: bool,
}

struct Line {
    text: String,
    size_px: f64,
    weight: Weight,
}

impl Block {
    fn new(lines: Vec<Line>, upright: bool) -> Self {
        let width_px =
            lines.iter().map(|line| Font::of(line.weight).width_px(&line.text, line.size_px)).fold(0.0, f64::max);
        // From the top of the first line's capitals to the last line's descenders.
        let between: f64 = lines.iter().skip(1).map(|line| line.size_px * font::LINE_HEIGHT).sum();
        let first = lines.first().map_or(0.0, |line| line.size_px * font::CAP_HEIGHT);
        let last = lines.last().map_or(0.0, |line| line.size_px * font::DESCENT);
        let height_px = first + between + last;
        Self { lines, width_px, height_px, upright }
    }

    /// Width and height on screen.
    fn extent_px(&self) -> (f64, f64) {
        if self.upright { (self.height_px, self.width_px) } else { (self.width_px, self.height_px) }
    }

    /// The texts, centred on a point of the plan.
    fn texts(&self, at: Point, halo: Option<Rgba>, style: &Style) -> Vec<Item> {
        let palette = style.palette();
        let upright = self.upright;
        let mut baseline = -self.height_px / 2.0;
        let mut items = Vec::new();
        for (i, line) in self.lines.iter().enumerate() {
            baseline += line.size_px * if i == 0 { font::CAP_HEIGHT } else { font::LINE_HEIGHT };
            items.push(Item::Text(Text {
                at,
                offset_px: if upright { Vector::new(baseline, 0.0) } else { Vector::new(0.0, baseline) },
                content: line.text.clone(),
                size_px: line.size_px,
                weight: line.weight,
                colour: palette.ink,
                halo,
                anchor: Anchor::Middle,
                upright,
            }));
        }
        items
    }
}

/// Padding between text and what surrounds it, in pixels.
const PADDING_PX: f64 = 3.0;

/// Font size of areas as a fraction of that of names.
const AREA_SIZE: f64 = 0.88;

/// A name's surroundings; indices of rooms and openings refer to these.
pub(super) struct Around<'a> {
    pub rooms: &'a [RoomDrawing],
    pub openings: &'a [OpeningDrawing],
    pub faces: &'a Faces,
}

/// The name of a room with this floor colour; `None` if it fits nowhere.
pub(super) fn group(around: &Around<'_>, room: usize, floor: Rgba, style: &Style, view: &View) -> Option<Group> {
    let items = place(around, room, style, view, floor)?;
    Some(Group { element: around.rooms[room].id.to_string(), ..Group::new(Layer::Names, Frame::Plan, items) })
}

/// Whether the smallest text could fit into the bounding box of a room.
pub(super) fn may_fit(room: &RoomDrawing, view: &View) -> bool {
    view.px_per_m >= fits_from_px_per_m(room.bounds)
}

/// The zoom, in pixels a metre, from which on the smallest text could fit into a box.
pub(super) fn fits_from_px_per_m(bounds: Bounds) -> f64 {
    let (width_m, height_m) = (bounds.width(), bounds.height());
    (2.0 * SMALLEST_TEXT_PX / width_m.max(height_m)).max(SMALLEST_TEXT_PX / width_m.min(height_m))
}

/// The text of a room where it fits best; `None` if it fits nowhere.
fn place(around: &Around<'_>, index: usize, style: &Style, view: &View, floor: Rgba) -> Option<Vec<Item>> {
    let room = &around.rooms[index];
    let space = Space::new(around, index, style, view);
    if let Some(at) = room.text_at {
        return placed_by_hand(room, at, &space, style, floor);
    }
    for blocks in blocks(room, style) {
        // Clear of door swings if possible; otherwise a halo keeps the letters clear of the arcs.
        for may_be_swept in [false, true] {
            for block in &blocks {
                if let Some(at) = space.place(block, may_be_swept) {
                    let halo = if style.halo {
                        Some(style.palette().halo)
                    } else {
                        (may_be_swept || style.layers.graph).then_some(floor)
                    };
                    return Some(block.texts(at, halo, style));
                }
            }
        }
    }
    None
}

/// The text of a room at the place that a person gave it: as large as is free there or, where nothing is, as small as
/// can be read.
fn placed_by_hand(room: &RoomDrawing, at: Point, space: &Space, style: &Style, floor: Rgba) -> Option<Vec<Item>> {
    let [all, ..] = blocks(room, style);
    // No upright text: what is placed by hand is read where it is.
    let level = || all.iter().filter(|block| !block.upright);
    let fits = level().find(|block| space.is_free(block, at));
    let block = fits.or_else(|| level().min_by(|p, q| p.width_px.total_cmp(&q.width_px)))?;
    let is_inside =
        room.rings().filter(|ring| polygon::locate_in_ring(ring, at) == polygon::Location::Inside).count() == 1;
    let ground = if is_inside { floor } else { style.palette().paper };
    let halo = if style.halo { style.palette().halo } else { ground };
    Some(block.texts(at, Some(halo), style))
}

/// The texts to try in a room, best first: with everything, the name alone, part of the name.
fn blocks(room: &RoomDrawing, style: &Style) -> [Vec<Block>; 3] {
    let name = if !style.layers.names {
        String::new()
    } else if room.name.is_empty() {
        function_title(&room.function)
    } else {
        room.name.split_whitespace().collect::<Vec<_>>().join(" ")
    };
    let area = if style.layers.areas && room.clear_m2 > 0.0 { style.units.area(room.clear_m2) } else { String::new() };
    let wraps: Vec<Vec<String>> = if name.is_empty() { vec![Vec::new()] } else { wrapped(&name) };
    let mut sizes = Vec::new();
    for factor in [1.0, 0.86, 0.74] {
        let size = (style.text_px * factor).max(SMALLEST_TEXT_PX.min(style.text_px));
        if sizes.last() != Some(&size) {
            sizes.push(size);
        }
    }
    let line = |text: &str, size_px: f64| Line { text: text.to_owned(), size_px, weight: Weight::SemiBold };
    let area_line = |size: f64| Line {
        text: area.clone(),
        size_px: (size * AREA_SIZE).max(SMALLEST_TEXT_PX.min(style.text_px)),
        weight: Weight::Regular,
    };
    let add = |blocks: &mut Vec<Block>, names: &[String], size: f64, with_area: bool, upright: bool| {
        let mut lines: Vec<Line> = names.iter().map(|name| line(name, size)).collect();
        if with_area && !area.is_empty() {
            lines.push(area_line(size));
        }
        if !lines.is_empty() {
            blocks.push(Block::new(lines, upright));
        }
    };
    // Tall and narrow: the text may read from bottom to top.
    let is_tall = room.bounds.height() > 1.8 * room.bounds.width();
    let all = |with_area: bool| {
        let mut blocks = Vec::new();
        for &size in &sizes {
            for names in &wraps {
                add(&mut blocks, names, size, with_area, false);
            }
        }
        for &size in sizes.iter().filter(|_| is_tall) {
            add(&mut blocks, &wraps[0], size, with_area, true);
        }
        blocks
    };
    let mut short = Vec::new();
    let least = sizes.last().copied().unwrap_or(style.text_px);
    for name in shortened(&name) {
        add(&mut short, &[name], least, false, false);
    }
    [all(true), if name.is_empty() { Vec::new() } else { all(false) }, short]
}

/// A name on one line, and broken between words into two and three lines of similar width.
fn wrapped(name: &str) -> Vec<Vec<String>> {
    let words: Vec<&str> = name.split(' ').collect();
    let mut ways = vec![vec![name.to_owned()]];
    let width = |words: &[&str]| words.join(" ").chars().count();
    for lines in 2..=words.len().min(3) {
        let mut best: Option<(usize, Vec<String>)> = None;
        let mut consider = |cuts: &[usize]| {
            let mut from = 0;
            let mut pieces = Vec::new();
            for &cut in cuts.iter().chain([&words.len()]) {
                pieces.push(&words[from..cut]);
                from = cut;
            }
            let widest = pieces.iter().map(|piece| width(piece)).max().unwrap_or(0);
            if best.as_ref().is_none_or(|(least, _)| widest < *least) {
                best = Some((widest, pieces.iter().map(|piece| piece.join(" ")).collect()));
            }
        };
        // Room names are short; of a long text the first words decide.
        let reach = words.len().min(12);
        for first in 1..reach {
            if lines == 2 {
                consider(&[first]);
            }
            for second in (first + 1..reach).take(usize::from(lines == 3) * reach) {
                consider(&[first, second]);
            }
        }
        ways.extend(best.map(|(_, lines)| lines));
    }
    ways
}

/// A name cut off with an ellipsis, longest first, with at least four letters: fewer mean nothing.
fn shortened(name: &str) -> Vec<String> {
    let letters: Vec<char> = name.chars().collect();
    [12, 9, 7, 5, 4]
        .into_iter()
        .filter(|&kept| kept + 1 < letters.len())
        .map(|kept| letters[..kept].iter().collect::<String>().trim_end().to_owned() + "…")
        .collect()
}

/// The space available for text in a room.
struct Space {
    raster: Raster,
    blocked: Sums,
    /// Cells under door swings: better left free.
    swept: Sums,
    px_per_m: f64,
    target: Point,
}

impl Space {
    fn new(around: &Around<'_>, index: usize, style: &Style, view: &View) -> Self {
        let room = &around.rooms[index];
        let rings: Vec<&[Point]> = room.rings().map(Vec::as_slice).collect();
        // A third of the text's height: so the raster wastes less than the height of a letter's stroke.
        let mut raster = Raster::new(room.bounds, (style.text_px * 0.3).max(1.5) / view.px_per_m);
        raster.keep_inside(&rings);
        for edge in rings.iter().flat_map(|ring| polygon::edges(ring)) {
            raster.block_along(edge);
        }
        if style.layers.walls {
            for face in around.faces.near(room.bounds) {
                raster.block_along(face);
            }
        }
        // Rooms inside or over this one are drawn above it.
        for &other in &room.above {
            let rings: Vec<&[Point]> = around.rooms[other].rings().map(Vec::as_slice).collect();
            raster.keep_outside(&rings);
        }
        if style.layers.graph {
            // The graph node, as an octagon around it.
            let r = (NODE_RADIUS_PX + 1.0) / view.px_per_m;
            let k = r * std::f64::consts::FRAC_1_SQRT_2;
            let node: Vec<Point> = [(r, 0.0), (k, k), (0.0, r), (-k, k), (-r, 0.0), (-k, -k), (0.0, -r), (k, -k)]
                .into_iter()
                .map(|(x, y)| room.centre + Vector::new(x, y))
                .collect();
            raster.keep_outside(&[&node]);
        }
        let mut swept = vec![0; raster.blocked.len()];
        if style.layers.openings {
            let openings = room.openings.iter().map(|&opening| &around.openings[opening]);
            for [hinge, shut, tip] in openings.flat_map(|opening| opening.sweeps()) {
                // The quarter disc, as its bounding square less the far corner.
                let far = shut + (tip - hinge) * 0.4;
                let far_tip = tip + (shut - hinge) * 0.4;
                let region = [hinge, shut, far, far_tip, tip];
                raster.block_along(Segment::new(hinge, tip));
                raster.inside(&[&region], |row, columns| swept[row * raster.width..][columns].fill(1));
            }
        }
        let blocked = Sums::new(&raster, |i| u32::from(raster.blocked[i]));
        let swept = Sums::new(&raster, |i| swept[i]);
        Self { raster, blocked, swept, px_per_m: view.px_per_m, target: room.centre }
    }

    /// Where to centre the label: clear of obstacles and, if possible, of door swings.
    fn place(&self, block: &Block, may_be_swept: bool) -> Option<Point> {
        let (width_px, height_px) = block.extent_px();
        let cell_px = self.raster.cell * self.px_per_m;
        let cells = |length_px: f64| ((length_px + 2.0 * PADDING_PX) / cell_px).ceil() as usize;
        let (columns, rows) = (cells(width_px), cells(height_px));
        if columns > self.raster.width || rows > self.raster.height {
            return None;
        }
        let half = Vector::new(columns as f64 * self.raster.cell / 2.0, rows as f64 * self.raster.cell / 2.0);
        let area = (columns * rows) as f64;
        let mut best: Option<(f64, Point)> = None;
        for row in 0..=self.raster.height - rows {
            for column in 0..=self.raster.width - columns {
                if self.blocked.of(column, row, columns, rows) > 0 {
                    continue;
                }
                let corner = Vector::new(column as f64 * self.raster.cell, row as f64 * self.raster.cell);
                let at = self.raster.origin + corner + half;
                let swept = f64::from(self.swept.of(column, row, columns, rows)) / area;
                if swept > 0.0 && !may_be_swept {
                    continue;
                }
                // A text fully on a door swing costs as much as being ten lines away.
                let cost = at.distance(self.target) * self.px_per_m + swept * 10.0 * height_px;
                if best.is_none_or(|(least, _)| cost < least - 1e-9) {
                    best = Some((cost, at));
                }
            }
        }
        let (_, at) = best?;
        // Cells are coarse: if the exact target fits, use it.
        let offset = self.target - at;
        let within = offset.x.abs() <= self.raster.cell && offset.y.abs() <= self.raster.cell;
        Some(if within && self.fits_at(self.target, columns, rows, may_be_swept) { self.target } else { at })
    }

    /// Whether a label around a point covers nothing but door swings.
    fn is_free(&self, block: &Block, at: Point) -> bool {
        let (width_px, height_px) = block.extent_px();
        let cell_px = self.raster.cell * self.px_per_m;
        let cells = |length_px: f64| ((length_px + 2.0 * PADDING_PX) / cell_px).ceil() as usize;
        let (columns, rows) = (cells(width_px), cells(height_px));
        columns <= self.raster.width && rows <= self.raster.height && self.fits_at(at, columns, rows, true)
    }

    /// Whether a box of this many cells, plus one for being off the raster, is free around a point.
    fn fits_at(&self, middle: Point, columns: usize, rows: usize, may_be_swept: bool) -> bool {
        let start = |place: f64, count: usize| place - count as f64 / 2.0;
        let (left, bottom) =
            (start(self.raster.column(middle.x), columns).floor(), start(self.raster.row(middle.y), rows).floor());
        left >= 0.0
            && bottom >= 0.0
            && left as usize + columns < self.raster.width
            && bottom as usize + rows < self.raster.height
            && self.blocked.of(left as usize, bottom as usize, columns + 1, rows + 1) == 0
            && (may_be_swept || self.swept.of(left as usize, bottom as usize, columns + 1, rows + 1) == 0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_break_evenly_at_words() {
        assert_eq!(wrapped("Sala riunioni grande")[1], ["Sala riunioni", "grande"]);
        assert_eq!(wrapped("Sala riunioni grande")[2], ["Sala", "riunioni", "grande"]);
        assert_eq!(wrapped("Library").len(), 1);
        assert_eq!(shortened("Laboratory"), ["Laborat…", "Labor…", "Labo…"]);
        assert!(shortened("WC").is_empty());
    }
}
