//! Names and areas inside the rooms: as large as fits, wrapped, shortened, or left out, never over a
//! wall or each other.

use super::drawing::{Drawing, NODE_RADIUS_PX, RoomDrawing};
use super::font::{self, Font};
use super::scene::{Anchor, Frame, Group, Item, Layer, Text, View, Weight};
use super::{Rgba, SMALLEST_TEXT_PX, Style};
use crate::geometry::{Bounds, Point, Segment, Vector, polygon};

/// A function as written in a file, for people: 'LIVING_ROOM' and 'living room' become 'Living room'.
pub fn sentence_case(function: &str) -> String {
    let words = crate::labels::normalised_function(function);
    let mut letters = words.chars();
    letters.next().map(|first| first.to_uppercase().chain(letters).collect()).unwrap_or_default()
}

/// The middle of a polygon where it is widest: the middle of the largest inscribed circle, and where
/// many are nearly as large (a corridor), the one nearest to the centre of area. On a raster of 40
/// cells along the longer side, which is fine enough for a name. Of a convex polygon the centre of area.
pub(super) fn centre(outer: &[Point], holes: &[Vec<Point>]) -> Point {
    let bounds = polygon::bounds(outer);
    if bounds.is_empty() {
        return Point::default();
    }
    if holes.is_empty() && is_convex(outer) {
        return polygon::centroid(outer);
    }
    let cell = bounds.width().max(bounds.height()) / 40.0;
    if cell <= 0.0 {
        return bounds.center();
    }
    let mut raster = Raster::new(bounds, cell);
    let rings: Vec<&[Point]> = std::iter::once(outer).chain(holes.iter().map(Vec::as_slice)).collect();
    raster.keep_inside(&rings);
    let depths = raster.depths();
    let deepest = depths.iter().copied().max().unwrap_or(0);
    let middle = polygon::centroid(outer);
    let mut best: Option<(f64, Point)> = None;
    for (i, &depth) in depths.iter().enumerate() {
        // Nearly as deep: within a seventh.
        if depth == 0 || u32::from(depth) * 7 < u32::from(deepest) * 6 {
            continue;
        }
        let at = raster.cell_centre(i % raster.width, i / raster.width);
        let distance = at.distance(middle);
        if best.is_none_or(|(least, _)| distance < least - 1e-9) {
            best = Some((distance, at));
        }
    }
    match best {
        // The centre of area itself where it serves: a rectangle's middle is not on the raster.
        Some((distance, _))
            if distance <= cell && polygon::locate(outer, holes, middle) == polygon::Location::Inside =>
        {
            middle
        }
        Some((_, at)) => at,
        None => middle,
    }
}

/// Whether a ring turns one way only, once around.
fn is_convex(ring: &[Point]) -> bool {
    let n = ring.len();
    let turns = || (0..n).map(|i| polygon::orientation(ring[i], ring[(i + 1) % n], ring[(i + 2) % n]));
    let one_way = turns().all(|turn| turn >= 0.0) || turns().all(|turn| turn <= 0.0);
    // Once around it goes right once and left once; a star, drawn in one go, more often.
    let rightward: Vec<bool> =
        polygon::edges(ring).map(|edge| edge.b.x - edge.a.x).filter(|&x| x != 0.0).map(|x| x > 0.0).collect();
    let reversals = (0..rightward.len()).filter(|&i| rightward[i] != rightward[(i + 1) % rightward.len()]).count();
    one_way && reversals == 2
}

/// Square cells over a box, each free or not, each with a price for standing there.
struct Raster {
    origin: Point,
    cell: f64,
    width: usize,
    height: usize,
    blocked: Vec<bool>,
}

/// No raster has more cells: a room that fills the view many times over gets coarser ones.
const MOST_CELLS: f64 = 200_000.0;

impl Raster {
    fn new(bounds: Bounds, cell: f64) -> Self {
        let cell = cell.max((bounds.width() * bounds.height() / MOST_CELLS).sqrt());
        // Also for boxes that are long and thin.
        let cell = cell.max(bounds.width().max(bounds.height()) / MOST_CELLS);
        let count = |length: f64| (length / cell).ceil().max(1.0) as usize;
        let (width, height) = (count(bounds.width()), count(bounds.height()));
        Self { origin: bounds.min, cell, width, height, blocked: vec![false; width * height] }
    }

    fn cell_centre(&self, column: usize, row: usize) -> Point {
        self.origin + Vector::new((column as f64 + 0.5) * self.cell, (row as f64 + 0.5) * self.cell)
    }

    fn column(&self, x: f64) -> f64 {
        (x - self.origin.x) / self.cell
    }

    fn row(&self, y: f64) -> f64 {
        (y - self.origin.y) / self.cell
    }

    /// Calls `visit` with the runs of cells (row, columns) whose centres lie inside the rings by the
    /// even-odd rule.
    fn inside(&self, rings: &[&[Point]], mut visit: impl FnMut(usize, std::ops::Range<usize>)) {
        let mut crossings: Vec<Vec<f64>> = vec![Vec::new(); self.height];
        for edge in rings.iter().flat_map(|ring| polygon::edges(ring)) {
            let (low, high) = if edge.a.y < edge.b.y { (edge.a, edge.b) } else { (edge.b, edge.a) };
            // Rows whose middle lies in low.y..high.y.
            let first = (self.row(low.y) - 0.5).ceil().max(0.0) as usize;
            let end = ((self.row(high.y) - 0.5).ceil().max(0.0) as usize).min(self.height);
            for (row, crossings) in crossings.iter_mut().enumerate().take(end).skip(first) {
                let y = self.origin.y + (row as f64 + 0.5) * self.cell;
                crossings.push(low.x + (high.x - low.x) * (y - low.y) / (high.y - low.y));
            }
        }
        for (row, mut crossings) in crossings.into_iter().enumerate() {
            crossings.sort_by(f64::total_cmp);
            for pair in crossings.chunks_exact(2) {
                let from = (self.column(pair[0]) - 0.5).ceil().max(0.0) as usize;
                let to = ((self.column(pair[1]) - 0.5).ceil().max(0.0) as usize).min(self.width);
                if from < to {
                    visit(row, from..to);
                }
            }
        }
    }

    /// Blocks every cell whose middle lies outside the rings.
    fn keep_inside(&mut self, rings: &[&[Point]]) {
        let mut blocked = vec![true; self.blocked.len()];
        self.inside(rings, |row, columns| {
            blocked[row * self.width..][columns].fill(false);
        });
        for (before, now) in self.blocked.iter_mut().zip(blocked) {
            *before |= now;
        }
    }

    /// Blocks every cell whose middle lies inside the rings.
    fn keep_outside(&mut self, rings: &[&[Point]]) {
        let mut blocked = std::mem::take(&mut self.blocked);
        self.inside(rings, |row, columns| {
            blocked[row * self.width..][columns].fill(true);
        });
        self.blocked = blocked;
    }

    /// Blocks the cells a segment passes through.
    fn block_along(&mut self, segment: Segment) {
        // Half a cell a step meets every cell but those whose tip is just touched.
        let steps = (segment.length() / (self.cell * 0.5)).ceil().clamp(1.0, 4.0 * MOST_CELLS) as usize;
        for i in 0..=steps {
            let point = segment.a.lerp(segment.b, i as f64 / steps as f64);
            let (column, row) = (self.column(point.x).floor(), self.row(point.y).floor());
            if column >= 0.0 && row >= 0.0 && (column as usize) < self.width && (row as usize) < self.height {
                self.blocked[row as usize * self.width + column as usize] = true;
            }
        }
    }

    /// For each cell a measure of how far the nearest blocked one is, in thirds of a cell: the chamfer
    /// distance 3-4 (Borgefors 1986). The rim of the raster counts as blocked.
    fn depths(&self) -> Vec<u16> {
        let (width, height) = (self.width, self.height);
        let mut depth: Vec<u16> = self.blocked.iter().map(|&blocked| if blocked { 0 } else { u16::MAX / 2 }).collect();
        let at = |depth: &[u16], column: i64, row: i64| {
            if column < 0 || row < 0 || column >= width as i64 || row >= height as i64 {
                0
            } else {
                depth[row as usize * width + column as usize]
            }
        };
        let mut pass = |rows: &mut dyn Iterator<Item = i64>, sign: i64| {
            for row in rows {
                for step in 0..width as i64 {
                    let column = if sign > 0 { step } else { width as i64 - 1 - step };
                    let least = (at(&depth, column - sign, row) + 3)
                        .min(at(&depth, column, row - sign) + 3)
                        .min(at(&depth, column - 1, row - sign) + 4)
                        .min(at(&depth, column + 1, row - sign) + 4);
                    let here = &mut depth[row as usize * width + column as usize];
                    *here = (*here).min(least);
                }
            }
        };
        pass(&mut (0..height as i64), 1);
        pass(&mut (0..height as i64).rev(), -1);
        depth
    }
}

/// Sums over a raster, so that any box costs four look-ups.
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
    /// Turned a quarter to the left.
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

    /// Width and height on the screen.
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

/// Free space in pixels between text and what bounds it.
const PADDING_PX: f64 = 3.0;

/// The areas' font size, as a fraction of the names'.
const AREA_SIZE: f64 = 0.88;

/// The names of all rooms that are seen.
pub(super) fn groups(drawing: &Drawing, style: &Style, view: &View) -> Vec<Group> {
    let floors = drawing.fills(style);
    let rooms = drawing.rooms_to_name(view).into_iter();
    rooms.filter_map(|room| group(drawing, room, floors[room], style, view)).collect()
}

/// The name of a room on a floor of this colour; `None` where it fits nowhere.
pub(super) fn group(drawing: &Drawing, room: usize, floor: Rgba, style: &Style, view: &View) -> Option<Group> {
    let items = place(drawing, room, style, view, floor)?;
    Some(Group { element: drawing.rooms[room].id.to_string(), ..Group::new(Layer::Names, Frame::Plan, items) })
}

/// Whether the least text there is fits into the box of a room.
pub(super) fn may_fit(room: &RoomDrawing, view: &View) -> bool {
    let (width_px, height_px) = (room.bounds.width() * view.px_per_m, room.bounds.height() * view.px_per_m);
    width_px.max(height_px) >= 2.0 * SMALLEST_TEXT_PX && width_px.min(height_px) >= SMALLEST_TEXT_PX
}

/// The text of a room where it fits best; `None` where it fits nowhere.
fn place(drawing: &Drawing, index: usize, style: &Style, view: &View, floor: Rgba) -> Option<Vec<Item>> {
    let room = &drawing.rooms[index];
    let space = Space::new(drawing, index, style, view);
    for blocks in blocks(room, style) {
        // Off the doors' ways if it can be; else the letters stand clear of the arcs by a halo.
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

/// What may be written in a room, the best first: with everything, with the name alone, with a part of
/// the name.
fn blocks(room: &RoomDrawing, style: &Style) -> [Vec<Block>; 3] {
    let name = if !style.layers.names {
        String::new()
    } else if room.name.is_empty() {
        sentence_case(&room.function)
    } else {
        room.name.split_whitespace().collect::<Vec<_>>().join(" ")
    };
    let area = if style.layers.areas && room.area_m2 > 0.0 { style.units.area(room.area_m2) } else { String::new() };
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
    // Tall and narrow: may read from bottom to top.
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

/// A name in one line, and broken at its words into two and three lines of most even width.
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
        // Names of rooms are short; of a long text the first words decide enough.
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

/// A name cut off with an ellipsis, longest first, at least four letters long: fewer say nothing.
fn shortened(name: &str) -> Vec<String> {
    let letters: Vec<char> = name.chars().collect();
    [12, 9, 7, 5, 4]
        .into_iter()
        .filter(|&kept| kept + 1 < letters.len())
        .map(|kept| letters[..kept].iter().collect::<String>().trim_end().to_owned() + "…")
        .collect()
}

/// Where text may stand in a room.
struct Space {
    raster: Raster,
    blocked: Sums,
    /// Cells that doors swing over: better left free.
    swept: Sums,
    px_per_m: f64,
    target: Point,
}

impl Space {
    fn new(drawing: &Drawing, index: usize, style: &Style, view: &View) -> Self {
        let room = &drawing.rooms[index];
        let rings: Vec<&[Point]> = room.rings().map(Vec::as_slice).collect();
        // A third of the text's height: what is lost to the raster is less than a letter's stroke is high.
        let mut raster = Raster::new(room.bounds, (style.text_px * 0.3).max(1.5) / view.px_per_m);
        raster.keep_inside(&rings);
        for edge in rings.iter().flat_map(|ring| polygon::edges(ring)) {
            raster.block_along(edge);
        }
        if style.layers.walls {
            for face in drawing.faces.near(room.bounds) {
                raster.block_along(face);
            }
        }
        // Rooms that lie in or over this one are drawn above it.
        for &other in &room.above {
            let rings: Vec<&[Point]> = drawing.rooms[other].rings().map(Vec::as_slice).collect();
            raster.keep_outside(&rings);
        }
        if style.layers.graph {
            // The node, as an octagon around it.
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
            let openings = room.openings.iter().map(|&opening| &drawing.openings[opening]);
            for [hinge, shut, tip] in openings.flat_map(|opening| opening.sweeps()) {
                // The quarter disc as the square it lies in, less the far corner.
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

    /// The middle of the best place for a block: free, near the room's middle, off the doors' ways as far
    /// as it may not, or need not, stand there.
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
                // A text wholly on a door's way may as well stand ten lines off.
                let cost = at.distance(self.target) * self.px_per_m + swept * 10.0 * height_px;
                if best.is_none_or(|(least, _)| cost < least - 1e-9) {
                    best = Some((cost, at));
                }
            }
        }
        let (_, at) = best?;
        // Cells are coarse: where the very middle serves, it is taken.
        let offset = self.target - at;
        let within = offset.x.abs() <= self.raster.cell && offset.y.abs() <= self.raster.cell;
        Some(if within && self.fits_at(self.target, columns, rows, may_be_swept) { self.target } else { at })
    }

    /// Whether a box of so many cells, and one more for being off the raster, is free about a point.
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

    fn ring(points: &[(f64, f64)]) -> Vec<Point> {
        points.iter().map(|&(x, y)| Point::new(x, y)).collect()
    }

    #[test]
    fn the_middle_lies_in_the_widest_part() {
        let square = ring(&[(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)]);
        assert_eq!(centre(&square, &[]), Point::new(2.0, 2.0));
        let corridor = ring(&[(0.0, 0.0), (20.0, 0.0), (20.0, 2.0), (0.0, 2.0)]);
        assert!(centre(&corridor, &[]).distance(Point::new(10.0, 1.0)) < 0.4);
        let l_shape = ring(&[(0.0, 0.0), (10.0, 0.0), (10.0, 2.0), (4.0, 2.0), (4.0, 6.0), (0.0, 6.0)]);
        let middle = centre(&l_shape, &[]);
        assert!(middle.x < 3.0 && middle.y > 1.0, "{middle:?}");
        let ring_room = centre(
            &ring(&[(0.0, 0.0), (9.0, 0.0), (9.0, 9.0), (0.0, 9.0)]),
            &[ring(&[(2.0, 2.0), (7.0, 2.0), (7.0, 7.0), (2.0, 7.0)])],
        );
        assert!(!(2.0..=7.0).contains(&ring_room.x) || !(2.0..=7.0).contains(&ring_room.y), "{ring_room:?}");
        assert_eq!(centre(&[], &[]), Point::default());
    }

    #[test]
    fn names_break_evenly_at_words() {
        assert_eq!(wrapped("Sala riunioni grande")[1], ["Sala riunioni", "grande"]);
        assert_eq!(wrapped("Sala riunioni grande")[2], ["Sala", "riunioni", "grande"]);
        assert_eq!(wrapped("Library").len(), 1);
        assert_eq!(shortened("Laboratory"), ["Laborat…", "Labor…", "Labo…"]);
        assert!(shortened("WC").is_empty());
    }

    #[test]
    fn functions_read_as_sentences() {
        assert_eq!(sentence_case("LIVING_DINING"), "Living dining");
    }
}
