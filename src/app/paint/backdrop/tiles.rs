//! The backdrop as tiles at several sizes: visible ones are uploaded to the display, a few per frame, and
//! dropped when no longer visible.

use std::collections::BTreeMap;

use egui::epaint::{Mesh, Vertex};
use egui::{Color32, ColorImage, Context, Painter, Pos2, Rect, Shape, TextureHandle, TextureOptions, pos2};

use crate::app::paint::places::on_screen;
use crate::draw::View;
use crate::geometry::{Bounds, Point};
use crate::picture::{Level, PictureLevels, Samples};
use crate::plan::Backdrop;

/// Side of a tile in pixels, without the border of one pixel shared with neighbours that hides seams.
const TILE_PX: u32 = 512;

/// The most tiles kept on the display while fewer are visible: 1 MB each. A screen of 3840 by 2160 pixels
/// shows at most 77.
const KEPT_TILES: usize = 128;

/// A tile's position: level, column, row.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Key {
    level: usize,
    column: u32,
    row: u32,
}

struct Tile {
    texture: TextureHandle,
    /// The frame in which it was last visible.
    seen: u64,
}

/// The tiles of a picture on the display.
#[derive(Default)]
pub(crate) struct Tiles {
    tiles: BTreeMap<Key, Tile>,
    frame: u64,
}

/// How a picture is shown: where, and at what opacity.
pub(crate) struct Shown<'a> {
    pub levels: &'a PictureLevels,
    pub backdrop: &'a Backdrop,
    pub opacity: f64,
}

impl Tiles {
    /// Paints the visible part of the picture. Uploads at most `most_new` tiles, and asks for another
    /// frame if more are missing: a smaller level of the picture is shown there in the meantime.
    pub(crate) fn paint(&mut self, painter: &Painter, rect: Rect, view: &View, shown: &Shown<'_>, most_new: usize) {
        self.frame += 1;
        let screen_px_per_pixel = shown.backdrop.metres_per_pixel * view.px_per_m * view.pixel_ratio;
        if !(screen_px_per_pixel > 0.0 && screen_px_per_pixel.is_finite()) {
            return;
        }
        let index = shown.levels.index_for(screen_px_per_pixel);
        let keys = seen_tiles(view, shown, index);
        // The smallest level first, so that no place is empty.
        let smallest = Key { level: shown.levels.all().len().saturating_sub(1), column: 0, row: 0 };
        let mut missing = 0;
        for key in std::iter::once(smallest).chain(keys.iter().copied()) {
            if self.tiles.contains_key(&key) {
                continue;
            }
            if missing < most_new
                && let Some(level) = shown.levels.all().get(key.level)
            {
                self.tiles.insert(key, Tile { texture: upload(painter.ctx(), level, key), seen: self.frame });
            }
            missing += 1;
        }
        if missing > most_new {
            painter.ctx().request_repaint();
        }
        let tint = Color32::WHITE.gamma_multiply(shown.opacity.clamp(0.0, 1.0) as f32);
        for key in &keys {
            // This tile, or the matching part of a larger one at a smaller level.
            let sizes = key.level..shown.levels.all().len();
            let held = sizes.map(|level| {
                let halvings = (level - key.level) as u32;
                Key { level, column: key.column >> halvings, row: key.row >> halvings }
            });
            for source in held {
                let Some(tile) = self.tiles.get_mut(&source) else { continue };
                tile.seen = self.frame;
                painter.add(Shape::mesh(mesh(rect, view, shown, *key, source, &tile.texture, tint)));
                break;
            }
        }
        if let Some(tile) = self.tiles.get_mut(&smallest) {
            tile.seen = self.frame;
        }
        self.drop_unseen();
    }

    /// Drops the least recently visible tiles until within budget.
    fn drop_unseen(&mut self) {
        let excess = self.tiles.len().saturating_sub(KEPT_TILES);
        if excess == 0 {
            return;
        }
        let mut unseen: Vec<(u64, Key)> =
            self.tiles.iter().filter(|(_, tile)| tile.seen < self.frame).map(|(key, tile)| (tile.seen, *key)).collect();
        unseen.sort_unstable();
        for (_, key) in unseen.into_iter().take(excess) {
            self.tiles.remove(&key);
        }
    }
}

/// Pixels of the full picture per pixel of a level, along a side.
fn stride(level: usize) -> f64 {
    (level as f64).exp2()
}

/// The visible tiles of a level, middle ones first.
fn seen_tiles(view: &View, shown: &Shown<'_>, index: usize) -> Vec<Key> {
    let Some(level) = shown.levels.all().get(index) else { return Vec::new() };
    let bounds = view.bounds();
    let corners =
        [bounds.min, Point::new(bounds.max.x, bounds.min.y), bounds.max, Point::new(bounds.min.x, bounds.max.y)];
    let seen = Bounds::of(corners.map(|corner| shown.backdrop.picture_from_plan(corner)));
    let tile_px = f64::from(TILE_PX) * stride(index);
    let range = |from_px: f64, to_px: f64, side_px: u32| {
        let count = side_px.div_ceil(TILE_PX);
        // `as` saturates at 0 and the largest number.
        let (from, to) = ((from_px / tile_px).floor() as u32, (to_px / tile_px).floor() as i64);
        from..(to + 1).clamp(0, i64::from(count)) as u32
    };
    let columns = range(seen.min.x, seen.max.x, level.width_px);
    let rows = range(seen.min.y, seen.max.y, level.height_px);
    let mut keys: Vec<Key> =
        rows.flat_map(|row| columns.clone().map(move |column| Key { level: index, column, row })).collect();
    let middle = seen.center();
    let distance = |key: &Key| {
        let of = |index: u32| (f64::from(index) + 0.5) * tile_px;
        Point::new(of(key.column), of(key.row)).distance(middle)
    };
    keys.sort_by(|a, b| distance(a).total_cmp(&distance(b)).then(a.cmp(b)));
    keys
}

/// Uploads a tile.
fn upload(context: &Context, level: &Level, key: Key) -> TextureHandle {
    let name = format!("backdrop {} {} {}", key.level, key.column, key.row);
    context.load_texture(name, tile_image(level, key), TextureOptions::LINEAR)
}

/// A tile's pixels with its border.
fn tile_image(level: &Level, key: Key) -> ColorImage {
    let (left, top) = (key.column * TILE_PX, key.row * TILE_PX);
    let width = level.width_px.saturating_sub(left).min(TILE_PX);
    let height = level.height_px.saturating_sub(top).min(TILE_PX);
    let bytes = level.samples.bytes();
    let row_bytes = level.width_px as usize * bytes;
    // Indices of the columns; the border repeats the nearest.
    let last = level.width_px.saturating_sub(1);
    let columns: Vec<usize> = (0..width + 2).map(|x| (left + x).saturating_sub(1).min(last) as usize * bytes).collect();
    let mut pixels = Vec::with_capacity((width as usize + 2) * (height as usize + 2));
    for y in 0..height + 2 {
        let y = (top + y).saturating_sub(1).min(level.height_px.saturating_sub(1)) as usize;
        let row = &level.data[y * row_bytes..(y + 1) * row_bytes];
        match level.samples {
            Samples::Grey => pixels.extend(columns.iter().map(|&x| Color32::from_gray(row[x]))),
            Samples::Rgb => pixels.extend(columns.iter().map(|&x| Color32::from_rgb(row[x], row[x + 1], row[x + 2]))),
            Samples::Rgba => pixels.extend(
                columns.iter().map(|&x| Color32::from_rgba_unmultiplied(row[x], row[x + 1], row[x + 2], row[x + 3])),
            ),
        }
    }
    ColorImage::new([width as usize + 2, height as usize + 2], pixels)
}

/// The area of a tile, painted with what is available for it.
fn mesh(
    rect: Rect,
    view: &View,
    shown: &Shown<'_>,
    key: Key,
    source: Key,
    texture: &TextureHandle,
    tint: Color32,
) -> Mesh {
    let [width_px, height_px] = shown.levels.size_px().map(f64::from);
    let tile_px = f64::from(TILE_PX) * stride(key.level);
    let side = |index: u32, most_px: f64| {
        let from_px = f64::from(index) * tile_px;
        [from_px, (from_px + tile_px).min(most_px)]
    };
    let (xs, ys) = (side(key.column, width_px), side(key.row, height_px));
    let [texture_width, texture_height] = texture.size().map(|side| side as f64);
    let uv = |x: f64, y: f64| -> Pos2 {
        let within = |at: f64, index: u32, side: f64| {
            ((at / stride(source.level) - f64::from(index * TILE_PX) + 1.0) / side) as f32
        };
        pos2(within(x, source.column, texture_width), within(y, source.row, texture_height))
    };
    let mut mesh = Mesh::with_texture(texture.id());
    for (x, y) in [(xs[0], ys[0]), (xs[1], ys[0]), (xs[0], ys[1]), (xs[1], ys[1])] {
        let pos = on_screen(rect, view, shown.backdrop.plan_from_picture(Point::new(x, y)));
        mesh.vertices.push(Vertex { pos, uv: uv(x, y), color: tint });
    }
    mesh.indices = vec![0, 1, 2, 2, 1, 3];
    mesh
}

#[cfg(test)]
mod tests {
    use crate::app::paint::backdrop::tiles::*;

    #[test]
    fn only_what_is_seen_is_painted() {
        let full = Level { width_px: 2000, height_px: 1200, samples: Samples::Grey, data: vec![9; 2000 * 1200] };
        let levels = PictureLevels::new(full);
        let backdrop = Backdrop::new("scan.png", "");
        let shown = Shown { levels: &levels, backdrop: &backdrop, opacity: 1.0 };
        // At one pixel per pixel: 300 by 200 pixels around the pixel (600, 500).
        let view = View {
            width_px: 300.0,
            height_px: 200.0,
            px_per_m: 100.0,
            centre: Point::new(6.0, -5.0),
            pixel_ratio: 1.0,
        };
        let keys = seen_tiles(&view, &shown, 0);
        let places: Vec<(u32, u32)> = keys.iter().map(|key| (key.column, key.row)).collect();
        assert_eq!(places, [(1, 0), (1, 1), (0, 0), (0, 1)], "the middle first");
        let whole = View { px_per_m: 1.0, ..view };
        assert_eq!(seen_tiles(&whole, &shown, 3).len(), 1);
        assert_eq!(seen_tiles(&whole, &shown, 0).len(), 12);
        let beside = View { centre: Point::new(-600.0, 500.0), ..view };
        assert_eq!(seen_tiles(&beside, &shown, 0), []);
        let far = View { centre: Point::new(1e5, 1e5), ..view };
        assert_eq!(seen_tiles(&far, &shown, 0), []);
    }

    #[test]
    fn tiles_share_their_rims() {
        let data: Vec<u8> = (0..600u32 * 3).map(|i| (i % 600 / 3) as u8).collect();
        let level = Level { width_px: 600, height_px: 3, samples: Samples::Grey, data };
        let [left, right] = [0, 1].map(|column| tile_image(&level, Key { level: 0, column, row: 0 }));
        assert_eq!((left.size, right.size), ([514, 5], [90, 5]));
        assert_eq!(left.pixels[513], right.pixels[1], "the pixel 512");
        assert_eq!(left.pixels[512], right.pixels[0], "the pixel 511");
        assert_eq!(right.pixels[88], right.pixels[89], "beyond the side, the last one");
    }
}
