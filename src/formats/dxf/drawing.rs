//! A plan as a DXF drawing.

use std::collections::BTreeMap;

use super::text::{Handle, Pairs};
use crate::base::units::Units;
use crate::draw::dimensions;
use crate::draw::{Drawing, Fill, Item, Layer as DrawnLayer, Layers, PlacedOpening, Style, View};
use crate::features::{Analysis, NeighbourLabels, analyse};
use crate::geometry::{Bounds, Point, Segment, Vector, raster};
use crate::labels::{Schemes, function_title};
use crate::plan::{OpeningKind, Plan};

/// A layer of the drawing: its name, colour (a number of AutoCAD's index) and line type.
struct Layer(&'static str, i64, &'static str);

const WALLS: &str = "A-WALL";
const WALL_OPENINGS: &str = "A-WALL-OPNG";
const DOORS: &str = "A-DOOR";
const WINDOWS: &str = "A-GLAZ";
const ROOMS: &str = "A-AREA";
const BOUNDARIES: &str = "A-AREA-BNDY";
const TEXTS: &str = "A-ANNO-TEXT";
const TITLE: &str = "A-ANNO-TTLB";
const DIMENSIONS: &str = "A-ANNO-DIMS";

const CONTINUOUS: &str = "Continuous";
const DASHED: &str = "DASHED";

/// The layers, in the order of their names.
const LAYERS: [Layer; 10] = [
    Layer("0", 7, CONTINUOUS),
    Layer(DIMENSIONS, 8, CONTINUOUS),
    Layer(TEXTS, 7, CONTINUOUS),
    Layer(TITLE, 8, CONTINUOUS),
    Layer(ROOMS, 3, CONTINUOUS),
    Layer(BOUNDARIES, 8, DASHED),
    Layer(DOORS, 30, CONTINUOUS),
    Layer(WINDOWS, 4, CONTINUOUS),
    Layer(WALLS, 7, CONTINUOUS),
    Layer(WALL_OPENINGS, 8, DASHED),
];

/// Height of the letters of names, areas, and of the title, in metres.
const NAME_M: f64 = 0.2;
const AREA_M: f64 = 0.15;
const TITLE_M: f64 = 0.35;

/// Half of a dimension's slash, in metres.
const SLASH_M: f64 = 0.08;

/// Thickness of a door leaf in metres.
const LEAF_M: f64 = 0.04;

/// The whole file.
pub(super) fn write(plan: &Plan, schemes: &Schemes, in_millimetres: bool) -> String {
    let analysis = analyse(plan, schemes, NeighbourLabels::True);
    let drawing = Drawing::new(plan, &analysis);
    let mut file = File::new(if in_millimetres { 1000.0 } else { 1.0 });
    file.walls(&drawing);
    file.rooms(plan, &analysis);
    file.dimensions(plan);
    for opening in drawing.placed_openings() {
        file.opening(&opening);
    }
    file.title(plan, drawing.bounds());
    file.finish(drawing.bounds(), in_millimetres)
}

/// A block: something drawn once and inserted many times.
struct Block {
    name: String,
    record: Handle,
    begin: Handle,
    end: Handle,
    entities: Pairs,
}

struct File {
    /// Units of the drawing in a metre.
    per_m: f64,
    entities: Pairs,
    model: Handle,
    paper: Handle,
    /// In the order in which they were first used; by name, the place in the list.
    blocks: Vec<Block>,
    by_name: BTreeMap<String, usize>,
}

impl File {
    fn new(per_m: f64) -> Self {
        let mut entities = Pairs::after(0x20);
        let (model, paper) = (entities.handle(), entities.handle());
        Self { per_m, entities, model, paper, blocks: Vec::new(), by_name: BTreeMap::new() }
    }

    fn placed(&self, point: Point) -> Point {
        Point::new(point.x * self.per_m, point.y * self.per_m)
    }

    fn polyline(&mut self, layer: &str, points: &[Point], closed: bool) {
        let points: Vec<Point> = points.iter().map(|&point| self.placed(point)).collect();
        polyline(&mut self.entities, self.model, layer, &points, closed);
    }

    /// Walls with the openings cut out, as closed outlines; those without thickness as lines.
    fn walls(&mut self, drawing: &Drawing) {
        // So close that nothing is left out, or drawn thicker, for being small on a screen.
        let view = View { width_px: 1.0, height_px: 1.0, px_per_m: 1e6, centre: Point::default(), pixel_ratio: 1.0 };
        let style = Style { fill: Fill::None, layers: Layers::default(), ..Style::default() };
        for (layer, name) in [(DrawnLayer::Walls, WALLS), (DrawnLayer::Boundaries, BOUNDARIES)] {
            for item in drawing.layer(layer, &style, &view).into_iter().flat_map(|group| group.items) {
                match item {
                    Item::Polygon { outer, holes, .. } => {
                        for ring in std::iter::once(&outer).chain(&holes) {
                            self.polyline(name, ring, true);
                        }
                    }
                    Item::Line { points, closed, .. } => self.polyline(name, &points, closed),
                    Item::Arc { .. } | Item::Disc { .. } | Item::Text(_) | Item::Picture(_) => {}
                }
            }
        }
    }

    /// The boundary of each room, with its name and area in its middle.
    fn rooms(&mut self, plan: &Plan, analysis: &Analysis) {
        for (shape, (id, room)) in analysis.shapes.all().iter().zip(plan.rooms()) {
            if shape.outer.is_empty() {
                continue;
            }
            for ring in std::iter::once(&shape.outer).chain(&shape.holes) {
                self.polyline(ROOMS, ring, true);
            }
            let middle = raster::centre(&shape.outer, &shape.holes);
            let function = function_title(&room.function);
            let name = if room.name.trim().is_empty() { function } else { room.name.trim().to_owned() };
            let area = analysis.net(id).map_or_else(String::new, |net| Units::Metric.area(net.area_m2));
            let lines = [(name, NAME_M, 0.05), (area, AREA_M, -0.05 - AREA_M)];
            for (text, height, above) in lines.into_iter().filter(|(text, ..)| !text.is_empty()) {
                self.text(TEXTS, &text, middle + Vector::new(0.0, above), height, true);
            }
        }
    }

    /// The dimension chains: lines, a slash at each point, and the figures.
    fn dimensions(&mut self, plan: &Plan) {
        for (_, line) in dimensions::lines(plan) {
            let Some(Segment { a, b }) = dimensions::segment(&line) else { continue };
            self.polyline(DIMENSIONS, &[a, b], false);
            let slash = (line.along + line.along.left()) * SLASH_M;
            for &(measured, on_line) in &line.ticks {
                self.polyline(DIMENSIONS, &[on_line + -slash, on_line + slash], false);
                if measured.distance(on_line) > SLASH_M {
                    self.polyline(DIMENSIONS, &[measured, on_line], false);
                }
            }
            for (pair, length_m) in line.ticks.windows(2).zip(line.lengths_m()) {
                let above = line.along.left() * (SLASH_M / 2.0 + AREA_M / 2.0);
                let middle = pair[0].1.midpoint(pair[1].1) + above + Vector::new(0.0, -AREA_M / 2.0);
                self.text(DIMENSIONS, &Units::Metric.dimension(length_m), middle, AREA_M, true);
            }
        }
    }

    /// A line of text on its baseline, centred about a point or starting there.
    fn text(&mut self, layer: &str, content: &str, at: Point, height_m: f64, is_centred: bool) {
        let (at, height) = (self.placed(at), height_m * self.per_m);
        entity(&mut self.entities, "TEXT", self.model, layer);
        self.entities.text(100, "AcDbText").point(10, at).number(40, height).text(1, content);
        if is_centred {
            self.entities.whole(72, 1).point(11, at);
        }
        self.entities.text(100, "AcDbText");
    }

    fn title(&mut self, plan: &Plan, bounds: Bounds) {
        let meta = plan.meta();
        let parts = [meta.name.trim(), meta.building.trim(), meta.storey.trim()];
        let mut lines: Vec<&str> = Vec::new();
        for part in parts.into_iter().filter(|part| !part.is_empty()) {
            if !lines.contains(&part) {
                lines.push(part);
            }
        }
        if !lines.is_empty() && !bounds.is_empty() {
            let at = Point::new(bounds.min.x, bounds.min.y - 3.0 * TITLE_M);
            self.text(TITLE, &lines.join(", "), at, TITLE_M, false);
        }
    }

    fn opening(&mut self, opening: &PlacedOpening) {
        let millimetres = |metres: f64| (metres * 1000.0).round() as i64;
        let width_m = opening.width_m;
        let depth_m = opening.left_m - opening.right_m;
        let start = opening.centre - opening.along * (width_m / 2.0);
        // On the axis of the wall, the middle between its faces.
        let on_axis = start + opening.along.left() * ((opening.left_m + opening.right_m) / 2.0);
        match (opening.kind, opening.leaves.as_slice()) {
            (OpeningKind::Door | OpeningKind::DoubleDoor, leaves) if !leaves.is_empty() => {
                for &[hinge, shut, tip] in leaves {
                    let leaf_m = hinge.distance(shut);
                    let name = format!("DOOR-{}", millimetres(leaf_m));
                    let block = self.block(&name, |pairs, record, per_m| door(pairs, record, leaf_m * per_m, per_m));
                    let towards = (shut - hinge).unit().unwrap_or(opening.along);
                    let is_mirrored = towards.cross(tip - hinge) < 0.0;
                    self.insert(DOORS, block, hinge, towards, is_mirrored);
                }
            }
            (OpeningKind::Door | OpeningKind::DoubleDoor, _) => {
                let name = format!("SLIDING-DOOR-{}", millimetres(width_m));
                let block = self.block(&name, |pairs, record, per_m| {
                    let (long, thick) = (width_m * 0.53 * per_m, LEAF_M * per_m);
                    for (from, low) in [(0.0, 0.0), (width_m * per_m - long, -thick)] {
                        rectangle(pairs, record, from, low, from + long, low + thick);
                    }
                });
                self.insert(DOORS, block, on_axis, opening.along, false);
            }
            (OpeningKind::Window, _) => {
                let name = format!("WINDOW-{}x{}", millimetres(width_m), millimetres(depth_m));
                let block = self.block(&name, |pairs, record, per_m| {
                    let (wide, half) = (width_m * per_m, depth_m / 2.0 * per_m);
                    rectangle(pairs, record, 0.0, -half, wide, half);
                    polyline(pairs, record, "0", &[Point::new(0.0, 0.0), Point::new(wide, 0.0)], false);
                });
                self.insert(WINDOWS, block, on_axis, opening.along, false);
            }
            (OpeningKind::Passage, _) => {
                let name = format!("PASSAGE-{}x{}", millimetres(width_m), millimetres(depth_m));
                let block = self.block(&name, |pairs, record, per_m| {
                    let (wide, half) = (width_m * per_m, depth_m / 2.0 * per_m);
                    for v in [-half, half] {
                        polyline(pairs, record, "0", &[Point::new(0.0, v), Point::new(wide, v)], false);
                    }
                });
                self.insert(WALL_OPENINGS, block, on_axis, opening.along, false);
            }
        }
    }

    /// The block of a name, drawn when it is first used.
    fn block(&mut self, name: &str, draw: impl FnOnce(&mut Pairs, Handle, f64)) -> usize {
        if let Some(&index) = self.by_name.get(name) {
            return index;
        }
        let (record, begin, end) = (self.entities.handle(), self.entities.handle(), self.entities.handle());
        let mut entities = Pairs::after(self.entities.last_handle());
        draw(&mut entities, record, self.per_m);
        // The handles of the block are taken: what follows goes on behind them.
        let mut following = Pairs::after(entities.last_handle());
        following.append(&self.entities);
        self.entities = following;
        self.by_name.insert(name.to_owned(), self.blocks.len());
        self.blocks.push(Block { name: name.to_owned(), record, begin, end, entities });
        self.blocks.len() - 1
    }

    fn insert(&mut self, layer: &str, block: usize, at: Point, along: Vector, is_mirrored: bool) {
        let at = self.placed(at);
        let name = self.blocks[block].name.clone();
        entity(&mut self.entities, "INSERT", self.model, layer);
        self.entities.text(100, "AcDbBlockReference").text(2, &name).point(10, at);
        if is_mirrored {
            self.entities.number(41, 1.0).number(42, -1.0).number(43, 1.0);
        }
        // To a ten-millionth of a degree.
        self.entities.number(50, along.y.atan2(along.x).to_degrees().rem_euclid(360.0));
    }

    fn finish(mut self, bounds: Bounds, in_millimetres: bool) -> String {
        let mut tables = Pairs::after(self.entities.last_handle());
        let (begin_model, end_model) = (tables.handle(), tables.handle());
        let (begin_paper, end_paper) = (tables.handle(), tables.handle());
        write_tables(&mut tables, &self);
        let mut blocks = Pairs::after(tables.last_handle());
        blocks.section("BLOCKS");
        let nothing = Pairs::after(0);
        write_block(&mut blocks, "*Model_Space", self.model, begin_model, end_model, &nothing);
        write_block(&mut blocks, "*Paper_Space", self.paper, begin_paper, end_paper, &nothing);
        for block in &self.blocks {
            write_block(&mut blocks, &block.name, block.record, block.begin, block.end, &block.entities);
        }
        blocks.end_section();
        let mut objects = Pairs::after(blocks.last_handle());
        objects.section("OBJECTS");
        let (root, groups) = (objects.handle(), objects.handle());
        objects.text(0, "DICTIONARY").refer(5, root).refer(330, Handle::default()).text(100, "AcDbDictionary");
        objects.whole(281, 1).text(3, "ACAD_GROUP").refer(350, groups);
        objects.text(0, "DICTIONARY").refer(5, groups).refer(330, root).text(100, "AcDbDictionary").whole(281, 1);
        objects.end_section();
        let seed = objects.handle();
        let mut file = Pairs::after(0);
        file.section("HEADER");
        file.text(9, "$ACADVER").text(1, "AC1015");
        file.text(9, "$DWGCODEPAGE").text(3, "ANSI_1252");
        // Insertion units: 6 metres, 4 millimetres.
        file.text(9, "$INSUNITS").whole(70, if in_millimetres { 4 } else { 6 });
        file.text(9, "$MEASUREMENT").whole(70, 1);
        file.text(9, "$LUNITS").whole(70, 2);
        file.text(9, "$AUNITS").whole(70, 0);
        file.text(9, "$LTSCALE").number(40, 1.0);
        let (low, high) = if bounds.is_empty() { Default::default() } else { (bounds.min, bounds.max) };
        let (low, high) = (self.placed(low), self.placed(high));
        file.text(9, "$EXTMIN").point(10, low);
        file.text(9, "$EXTMAX").point(10, high);
        file.text(9, "$HANDSEED").refer(5, seed);
        file.end_section();
        file.section("CLASSES");
        file.end_section();
        file.append(&tables);
        file.append(&blocks);
        file.section("ENTITIES");
        file.append(&std::mem::replace(&mut self.entities, Pairs::after(0)));
        file.end_section();
        file.append(&objects);
        file.text(0, "EOF");
        file.finish()
    }
}

/// The beginning of an entity: what all have in common.
fn entity(pairs: &mut Pairs, kind: &str, owner: Handle, layer: &str) {
    let handle = pairs.handle();
    pairs.text(0, kind).refer(5, handle).refer(330, owner).text(100, "AcDbEntity").text(8, layer);
}

fn polyline(pairs: &mut Pairs, owner: Handle, layer: &str, points: &[Point], closed: bool) {
    entity(pairs, "LWPOLYLINE", owner, layer);
    pairs.text(100, "AcDbPolyline").whole(90, points.len() as i64).whole(70, i64::from(closed));
    for point in points {
        pairs.number(10, point.x).number(20, point.y);
    }
}

fn rectangle(pairs: &mut Pairs, owner: Handle, left: f64, low: f64, right: f64, high: f64) {
    let corners = [(left, low), (right, low), (right, high), (left, high)].map(|(x, y)| Point::new(x, y));
    polyline(pairs, owner, "0", &corners, true);
}

/// A door leaf, hinged at the origin and open at 90 degrees to the left of its closed place along x, and its swing.
fn door(pairs: &mut Pairs, record: Handle, leaf: f64, per_m: f64) {
    rectangle(pairs, record, 0.0, 0.0, LEAF_M * per_m, leaf);
    entity(pairs, "ARC", record, "0");
    pairs.text(100, "AcDbCircle").point(10, Point::default()).number(40, leaf);
    pairs.text(100, "AcDbArc").number(50, 0.0).number(51, 90.0);
}

fn write_block(pairs: &mut Pairs, name: &str, record: Handle, begin: Handle, end: Handle, entities: &Pairs) {
    pairs.text(0, "BLOCK").refer(5, begin).refer(330, record).text(100, "AcDbEntity").text(8, "0");
    pairs.text(100, "AcDbBlockBegin").text(2, name).whole(70, 0).point(10, Point::default());
    pairs.text(3, name).text(1, "");
    pairs.append(entities);
    pairs.text(0, "ENDBLK").refer(5, end).refer(330, record).text(100, "AcDbEntity").text(8, "0");
    pairs.text(100, "AcDbBlockEnd");
}

/// A table: its name, and its entries, each written by `entry` with the table's handle and its own.
fn table<T>(pairs: &mut Pairs, name: &str, entries: &[T], mut entry: impl FnMut(&mut Pairs, Handle, &T)) {
    let table = pairs.handle();
    pairs.text(0, "TABLE").text(2, name).refer(5, table).refer(330, Handle::default());
    pairs.text(100, "AcDbSymbolTable").whole(70, entries.len() as i64);
    if name == "DIMSTYLE" {
        pairs.text(100, "AcDbDimStyleTable").whole(71, entries.len() as i64);
    }
    for one in entries {
        entry(pairs, table, one);
    }
    pairs.text(0, "ENDTAB");
}

/// The beginning of an entry of a table.
fn record(pairs: &mut Pairs, kind: &str, handle: Handle, table: Handle, class: &str, name: &str) {
    let code = if kind == "DIMSTYLE" { 105 } else { 5 };
    pairs.text(0, kind).refer(code, handle).refer(330, table).text(100, "AcDbSymbolTableRecord").text(100, class);
    pairs.text(2, name).whole(70, 0);
}

fn write_tables(pairs: &mut Pairs, file: &File) {
    pairs.section("TABLES");
    let none: [&str; 0] = [];
    table(pairs, "VPORT", &none, |_, _, _| {});
    table(pairs, "LTYPE", &["ByBlock", "ByLayer", CONTINUOUS, DASHED], |pairs, table, name| {
        let handle = pairs.handle();
        record(pairs, "LTYPE", handle, table, "AcDbLinetypeTableRecord", name);
        let dashes = if *name == DASHED { [0.2, -0.12].map(|length| length * file.per_m).to_vec() } else { Vec::new() };
        let about = if *name == DASHED { "Dashed __ __ __" } else { "" };
        pairs.text(3, about).whole(72, 65).whole(73, dashes.len() as i64);
        pairs.number(40, dashes.iter().map(|length| length.abs()).sum());
        for length in dashes {
            pairs.number(49, length).whole(74, 0);
        }
    });
    table(pairs, "LAYER", &LAYERS, |pairs, table, Layer(name, colour, line_type)| {
        let handle = pairs.handle();
        record(pairs, "LAYER", handle, table, "AcDbLayerTableRecord", name);
        pairs.whole(62, *colour).text(6, line_type);
    });
    table(pairs, "STYLE", &["Standard"], |pairs, table, name| {
        let handle = pairs.handle();
        record(pairs, "STYLE", handle, table, "AcDbTextStyleTableRecord", name);
        pairs.number(40, 0.0).number(41, 1.0).number(50, 0.0).whole(71, 0).number(42, NAME_M * file.per_m);
        pairs.text(3, "arial.ttf").text(4, "");
    });
    table(pairs, "VIEW", &none, |_, _, _| {});
    table(pairs, "UCS", &none, |_, _, _| {});
    table(pairs, "APPID", &["ACAD"], |pairs, table, name| {
        let handle = pairs.handle();
        record(pairs, "APPID", handle, table, "AcDbRegAppTableRecord", name);
    });
    table(pairs, "DIMSTYLE", &["Standard"], |pairs, table, name| {
        let handle = pairs.handle();
        record(pairs, "DIMSTYLE", handle, table, "AcDbDimStyleTableRecord", name);
    });
    let mut records = vec![("*Model_Space", file.model), ("*Paper_Space", file.paper)];
    records.extend(file.blocks.iter().map(|block| (block.name.as_str(), block.record)));
    table(pairs, "BLOCK_RECORD", &records, |pairs, table, (name, handle)| {
        pairs.text(0, "BLOCK_RECORD").refer(5, *handle).refer(330, table).text(100, "AcDbSymbolTableRecord");
        pairs.text(100, "AcDbBlockTableRecord").text(2, name);
    });
    pairs.end_section();
}
