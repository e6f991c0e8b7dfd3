//! Small pictures of plans: the outlines of their rooms, filled by their labels.

use std::collections::BTreeMap;
use std::sync::Arc;

use egui::epaint::{Mesh, Vertex, WHITE_UV};
use egui::{Color32, Pos2, Rect, Shape, Stroke, Ui, pos2};

use crate::app::look::{theme, widgets::colours};
use crate::app::paint::scene_painter::earcut;
use crate::draw::Palette;
use crate::geometry::Point;
use crate::workspace::{PlanEntry, PlanKey};

/// A room of a picture, in steps of the outlines.
struct Piece {
    rings: Vec<Vec<[u8; 2]>>,
    triangles: Vec<u32>,
}

/// The pictures that were shown last.
#[derive(Default)]
pub(super) struct Thumbnails {
    pieces: BTreeMap<PlanKey, Arc<Vec<Piece>>>,
    /// The value of the workspace that they are of.
    revision: u64,
}

/// So many are kept: more than are seen at once.
const MOST: usize = 600;

impl Thumbnails {
    /// Paints a plan into a rectangle, as large as fits.
    pub(super) fn paint(
        &mut self,
        ui: &Ui,
        rect: Rect,
        key: &PlanKey,
        plan: &PlanEntry,
        palette: &Palette,
        revision: u64,
    ) {
        if self.revision != revision || self.pieces.len() > MOST {
            self.pieces.clear();
            self.revision = revision;
        }
        let pieces = self.pieces.entry(key.clone()).or_insert_with(|| Arc::new(pieces(plan))).clone();
        let corners = || pieces.iter().flat_map(|piece| piece.rings.iter().flatten());
        let (Some(right), Some(bottom)) = (corners().map(|it| it[0]).max(), corners().map(|it| it[1]).max()) else {
            return;
        };
        let (wide, high) = (f32::from(right).max(1.0), f32::from(bottom).max(1.0));
        let scale = (rect.width() / wide).min(rect.height() / high);
        let start = rect.center() - egui::vec2(wide, high) * scale / 2.0;
        let place = |[x, y]: [u8; 2]| pos2(start.x + f32::from(x) * scale, start.y + f32::from(y) * scale);
        let mut mesh = Mesh::default();
        let mut lines = Vec::new();
        let ink = colours(ui).text_weak;
        let stroke = Stroke::new(if scale > 0.35 { 1.0 } else { 0.6 }, ink);
        for (piece, room) in pieces.iter().zip(&plan.rooms) {
            let colour = theme::colour(palette.status(room.status));
            fill(&mut mesh, piece, colour, &place);
            for ring in &piece.rings {
                lines.push(Shape::closed_line(ring.iter().map(|corner| place(*corner)).collect(), stroke));
            }
        }
        ui.painter().add(mesh);
        ui.painter().extend(lines);
    }
}

fn pieces(plan: &PlanEntry) -> Vec<Piece> {
    let piece = |rings: Vec<Vec<[u8; 2]>>| {
        let points = |ring: &Vec<[u8; 2]>| -> Vec<Point> {
            ring.iter().map(|[x, y]| Point::new(f64::from(*x), f64::from(*y))).collect()
        };
        let mut all = rings.iter().map(points);
        let outer = all.next().unwrap_or_default();
        let holes: Vec<Vec<Point>> = all.collect();
        let triangles = if outer.is_empty() { Vec::new() } else { earcut(&outer, &holes) };
        Piece { rings, triangles }
    };
    plan.outlines.rooms().into_iter().map(|room| piece(room.rings)).collect()
}

fn fill(mesh: &mut Mesh, piece: &Piece, colour: Color32, place: &impl Fn([u8; 2]) -> Pos2) {
    let first = mesh.vertices.len() as u32;
    let vertex = |corner: &[u8; 2]| Vertex { pos: place(*corner), uv: WHITE_UV, color: colour };
    mesh.vertices.extend(piece.rings.iter().flatten().map(vertex));
    mesh.indices.extend(piece.triangles.iter().map(|corner| first + corner));
}
