//! Shapes as triangles with soft edges, in egui's points relative to the view's centre.

use super::*;

pub(super) struct Chunk {
    pub(super) mesh: Mesh,
    pub(super) bounds: Rect,
}

impl Chunk {
    /// The triangles moved and scaled; `None` if out of view.
    pub(super) fn placed(&self, origin: Pos2, scale: f32, clip: Rect) -> Option<Shape> {
        let bounds =
            Rect::from_min_max(origin + self.bounds.min.to_vec2() * scale, origin + self.bounds.max.to_vec2() * scale);
        if !bounds.intersects(clip) {
            return None;
        }
        let moved = |vertex: &Vertex| Vertex { pos: origin + vertex.pos.to_vec2() * scale, ..*vertex };
        let vertices = self.mesh.vertices.iter().map(moved).collect();
        Some(Shape::mesh(Mesh { indices: self.mesh.indices.clone(), vertices, texture_id: self.mesh.texture_id }))
    }
}

/// The vertices of a polygon's triangles, as indices into its points, ring after ring.
pub(crate) fn earcut(outer: &[Point], holes: &[Vec<Point>]) -> Vec<u32> {
    let mut starts: Vec<u32> = Vec::new();
    let mut count = outer.len();
    for hole in holes {
        starts.push(count as u32);
        count += hole.len();
    }
    let points = outer.iter().chain(holes.iter().flatten()).map(|point| [point.x, point.y]);
    let mut triangles = Vec::new();
    earcut::Earcut::new().earcut(points, &starts, &mut triangles);
    triangles
}

/// A polygon with holes as a mesh with soft edges, for markers over the plan.
pub(crate) fn polygon_mesh(
    rect: Rect,
    view: &View,
    outer: &[Point],
    holes: &[Vec<Point>],
    triangles: &[u32],
    colour: Color32,
) -> Mesh {
    let mut writer = Writer::new(view);
    writer.polygon(outer, holes, triangles, colour);
    let mut mesh = Mesh::default();
    for chunk in writer.finish() {
        mesh.append(chunk.mesh);
    }
    mesh.translate(on_screen(rect, view, view.centre).to_vec2());
    mesh
}

/// The outline of a ring as a mesh, for markers over the plan.
pub(crate) fn outline_mesh(rect: Rect, view: &View, ring: &[Point], stroke: Stroke) -> Mesh {
    let mut writer = Writer::new(view);
    let points = ring.iter().map(|&point| writer.place(point)).collect();
    writer.path(points, true, stroke);
    let mut mesh = writer.mesh;
    mesh.translate(on_screen(rect, view, view.centre).to_vec2());
    mesh
}

/// Converts shapes to triangles with feathered edges. Coordinates are in egui's points relative to the
/// view's centre.
pub(super) struct Writer<'a> {
    pub(super) view: &'a View,
    pub(super) tessellator: Tessellator,
    /// Width of the soft edges: one physical pixel.
    pub(super) feather: f32,
    pub(super) mesh: Mesh,
    pub(super) chunks: Vec<Chunk>,
}

impl<'a> Writer<'a> {
    pub(super) fn new(view: &'a View) -> Self {
        let pixels_per_point = view.pixel_ratio as f32;
        let options = TessellationOptions {
            // The position on the screen is not known yet.
            round_line_segments_to_pixels: false,
            round_rects_to_pixels: false,
            prerasterized_discs: false,
            coarse_tessellation_culling: false,
            ..TessellationOptions::default()
        };
        let tessellator = Tessellator::new(pixels_per_point, options, [1, 1], Vec::new());
        Self { view, tessellator, feather: 1.0 / pixels_per_point, mesh: Mesh::default(), chunks: Vec::new() }
    }

    pub(super) fn finish(mut self) -> Vec<Chunk> {
        self.end_chunk();
        self.chunks
    }

    pub(super) fn end_chunk(&mut self) {
        let mesh = std::mem::take(&mut self.mesh);
        if !mesh.is_empty() {
            self.chunks.push(Chunk { bounds: mesh.calc_bounds(), mesh });
        }
    }

    pub(super) fn place(&self, point: Point) -> Pos2 {
        let from_centre = (point - self.view.centre) * self.view.px_per_m;
        pos2(from_centre.x as f32, -from_centre.y as f32)
    }

    pub(super) fn stroke(&self, width: Length, colour: Rgba) -> Stroke {
        Stroke::new(self.view.px(width) as f32, theme::colour(colour))
    }

    pub(super) fn item(&mut self, item: &Item) {
        match item {
            // Polygons have their own triangles, texts are painted every frame, and the window shows the
            // backdrop in its own tiles.
            Item::Polygon { .. } | Item::Text(_) | Item::Picture(_) => {}
            Item::Line { points, closed, colour, width, dash } => {
                let mut points: Vec<Pos2> = points.iter().map(|&point| self.place(point)).collect();
                let stroke = self.stroke(*width, *colour);
                match dash {
                    None => self.path(points, *closed, stroke),
                    Some(dash) => {
                        if *closed {
                            points.extend(points.first().copied());
                        }
                        let (length, gap) = (self.view.px(dash.dash) as f32, self.view.px(dash.gap) as f32);
                        // Dashes shorter than a pixel look like a line; no need for a million of them.
                        if length < self.feather {
                            self.path(points, false, stroke);
                        } else {
                            for shape in Shape::dashed_line(&points, stroke, length, gap.max(self.feather)) {
                                if let Shape::LineSegment { points, stroke } = shape {
                                    self.path(points.to_vec(), false, stroke);
                                }
                            }
                        }
                    }
                }
            }
            Item::Arc { centre, from, to, colour, width } => {
                let radius_px = centre.distance(*from) * self.view.px_per_m;
                // Chords within a tenth of a pixel of the arc: their number grows with the square root of
                // the radius.
                let halvings = ((radius_px.max(1.0).sqrt() * 4.0).log2().ceil() as u32).clamp(2, 7);
                let points = arc_points(*centre, *from, *to, halvings);
                let points = points.into_iter().map(|point| self.place(point)).collect();
                let stroke = self.stroke(*width, *colour);
                self.path(points, false, stroke);
            }
            Item::Disc { centre, radius, fill, outline } => {
                let shape = CircleShape {
                    center: self.place(*centre),
                    radius: self.view.px(*radius) as f32,
                    fill: fill.map_or(Color32::TRANSPARENT, theme::colour),
                    stroke: outline.map_or(Stroke::NONE, |(colour, width)| self.stroke(width, colour)),
                };
                self.tessellator.tessellate_circle(shape, &mut self.mesh);
            }
        }
        if self.mesh.vertices.len() > CHUNK_VERTICES {
            self.end_chunk();
        }
    }

    /// A line along points, with soft sides. Corners are mitred; sharp ones, and the hairpins that joined
    /// walls may have, are cut off.
    pub(super) fn path(&mut self, mut points: Vec<Pos2>, closed: bool, stroke: Stroke) {
        if stroke.width <= 0.0 || stroke.color == Color32::TRANSPARENT {
            return;
        }
        // Points closer than a hundredth of a pixel have no meaningful direction.
        points.dedup_by(|p, q| p.distance(*q) < self.feather * 0.01);
        let closed = closed && points.len() > 2;
        if closed && points.first().zip(points.last()).is_some_and(|(p, q)| p.distance(*q) < self.feather * 0.01) {
            points.pop();
        }
        let n = points.len();
        if n < 2 {
            return;
        }
        // A line thinner than a pixel is drawn one pixel wide but fainter.
        let colour = stroke.color.gamma_multiply((stroke.width / self.feather).min(1.0));
        let outer = stroke.width.max(self.feather) / 2.0 + self.feather / 2.0;
        let inner = outer - self.feather;
        let normal = |i: usize| (points[(i + 1) % n] - points[i % n]).normalized().rot90();
        let first = self.mesh.vertices.len() as u32;
        let mut stations = 0;
        let mut station = |mesh: &mut Mesh, at: Pos2, across: Vec2| {
            for (distance, color) in
                [(-outer, Color32::TRANSPARENT), (-inner, colour), (inner, colour), (outer, Color32::TRANSPARENT)]
            {
                mesh.vertices.push(Vertex { pos: at + across * distance, uv: WHITE_UV, color });
            }
            stations += 1;
        };
        for (i, &point) in points.iter().enumerate() {
            let (before, after) = match (closed, i) {
                (false, 0) => (normal(0), normal(0)),
                (false, i) if i == n - 1 => (normal(i - 1), normal(i - 1)),
                (_, i) => (normal(i + n - 1), normal(i)),
            };
            let cosine = before.dot(after);
            if cosine > SHARPEST_MITRE {
                station(&mut self.mesh, point, (before + after) / (1.0 + cosine));
            } else {
                station(&mut self.mesh, point, before);
                station(&mut self.mesh, point, after);
            }
        }
        let pieces = if closed { stations } else { stations - 1 };
        for piece in 0..pieces {
            let (p, q) = (first + 4 * piece, first + 4 * ((piece + 1) % stations));
            for strip in 0..3 {
                let (a, b) = (p + strip, q + strip);
                self.mesh.indices.extend([a, b, a + 1, a + 1, b, b + 1]);
            }
        }
    }

    /// Part of a plan seen from afar: fills without soft edges, which walls cover, and lines.
    pub(super) fn piece_from_afar(&mut self, piece: FromAfar<'_>) {
        match piece {
            FromAfar::Fill { outer, holes, colour } => {
                let first = self.mesh.vertices.len() as u32;
                let color = theme::colour(colour);
                for &point in outer.iter().chain(holes.iter().flatten()) {
                    self.mesh.vertices.push(Vertex { pos: self.place(point), uv: WHITE_UV, color });
                }
                // True for nearly all rooms.
                if outer.len() == 4 && holes.is_empty() && is_convex(outer) {
                    self.mesh.indices.extend([0, 1, 2, 0, 2, 3].map(|corner| first + corner));
                } else {
                    self.mesh.indices.extend(earcut(outer, holes).into_iter().map(|corner| first + corner));
                }
            }
            FromAfar::Line { segment, colour, width_px } => {
                let stroke = self.stroke(Length::Px(width_px), colour);
                self.line_from_afar(self.place(segment.a), self.place(segment.b), stroke);
            }
        }
    }

    /// A line that fades from its middle to both sides, with two thirds of the vertices of a full one; it
    /// is as opaque as its width suggests.
    pub(super) fn line_from_afar(&mut self, from: Pos2, to: Pos2, stroke: Stroke) {
        let across = (to - from).normalized().rot90() * stroke.width.max(self.feather);
        let color = stroke.color.gamma_multiply((stroke.width / self.feather).min(1.0));
        let first = self.mesh.vertices.len() as u32;
        for at in [from, to] {
            for (side, color) in [(-1.0, Color32::TRANSPARENT), (0.0, color), (1.0, Color32::TRANSPARENT)] {
                self.mesh.vertices.push(Vertex { pos: at + across * side, uv: WHITE_UV, color });
            }
        }
        self.mesh.indices.extend([0, 3, 1, 1, 3, 4, 1, 4, 2, 2, 4, 5].map(|corner| first + corner));
    }

    /// A filled polygon: its triangles, inset by half a pixel, and a rim that fades out.
    pub(super) fn polygon(&mut self, outer: &[Point], holes: &[Vec<Point>], triangles: &[u32], colour: Color32) {
        self.polygon_cut(outer, holes, triangles, colour, &|_, _| false);
    }

    /// The same for a piece of a polygon, without a rim where it `is_cut` from the next piece.
    pub(super) fn polygon_cut(
        &mut self,
        outer: &[Point],
        holes: &[Vec<Point>],
        triangles: &[u32],
        colour: Color32,
        is_cut: &dyn Fn(Point, Point) -> bool,
    ) {
        if colour == Color32::TRANSPARENT {
            return;
        }
        let first = self.mesh.vertices.len() as u32;
        let rings = std::iter::once(outer).chain(holes.iter().map(Vec::as_slice));
        // The inner and outer rim vertices of a corner are consecutive.
        for (index, ring) in rings.enumerate() {
            let points: Vec<Pos2> = ring.iter().map(|&point| self.place(point)).collect();
            let cut: Vec<bool> = (0..ring.len()).map(|i| is_cut(ring[i], ring[(i + 1) % ring.len()])).collect();
            let mut outward = outward_normals(&points, index > 0);
            if cut.contains(&true) {
                keep_on_cuts(&mut outward, &points, &cut);
            }
            let start = self.mesh.vertices.len() as u32;
            for (&point, normal) in points.iter().zip(outward) {
                let half = normal * (self.feather / 2.0);
                self.mesh.vertices.push(Vertex { pos: point - half, uv: WHITE_UV, color: colour });
                self.mesh.vertices.push(Vertex { pos: point + half, uv: WHITE_UV, color: Color32::TRANSPARENT });
            }
            let count = points.len() as u32;
            for i in (0..count).filter(|&i| !cut[i as usize]) {
                let (a, b) = (start + 2 * i, start + 2 * ((i + 1) % count));
                self.mesh.indices.extend([a, b, a + 1, a + 1, b, b + 1]);
            }
        }
        self.mesh.indices.extend(triangles.iter().map(|corner| first + 2 * corner));
        if self.mesh.vertices.len() > CHUNK_VERTICES {
            self.end_chunk();
        }
    }
}

/// For each corner of a ring the outward direction, scaled so that the rim is a pixel wide along both
/// edges; at sharp corners at most twice that.
pub(super) fn outward_normals(ring: &[Pos2], is_hole: bool) -> Vec<Vec2> {
    let n = ring.len();
    let twice_area: f32 = (0..n).map(|i| cross(ring[i].to_vec2(), ring[(i + 1) % n].to_vec2())).sum();
    // With y down, a positive area means clockwise: outside is on the left.
    let side = if (twice_area > 0.0) == is_hole { -1.0 } else { 1.0 };
    let edge_normal = |i: usize| {
        let edge = ring[(i + 1) % n] - ring[i % n];
        let length = edge.length();
        if length > 0.0 { vec2(edge.y, -edge.x) * (side / length) } else { Vec2::ZERO }
    };
    (0..n)
        .map(|i| {
            let (before, after) = (edge_normal(i + n - 1), edge_normal(i));
            // An edge without length has no direction: use the other's.
            if before == Vec2::ZERO || after == Vec2::ZERO {
                return before + after;
            }
            let sum = before + after;
            sum / (1.0 + before.dot(after)).max(0.5)
        })
        .collect()
}

/// At corners where a polygon was cut, turns the outward directions along the cut, so that both pieces
/// end at the same place: half a pixel from the real edge.
pub(super) fn keep_on_cuts(outward: &mut [Vec2], ring: &[Pos2], cut: &[bool]) {
    let n = ring.len();
    for i in 0..n {
        let (before, after) = ((i + n - 1) % n, i);
        let along = match (cut[before], cut[after]) {
            (false, false) => continue,
            (true, true) => {
                outward[i] = Vec2::ZERO;
                continue;
            }
            (true, false) => ring[i] - ring[before],
            (false, true) => ring[(i + 1) % n] - ring[i],
        };
        let edge = if cut[before] { ring[(i + 1) % n] - ring[i] } else { ring[i] - ring[before] };
        let (along, edge) = (along.normalized(), edge.normalized());
        let sine = cross(edge, along);
        // Outwards is the side of the edge that the direction was on before.
        let side = if cross(edge, outward[i]) < 0.0 { -1.0 } else { 1.0 };
        outward[i] = if sine.abs() < 0.1 { Vec2::ZERO } else { along * (side / sine) };
    }
}

/// Whether a ring turns only one way.
pub(super) fn is_convex(ring: &[Point]) -> bool {
    let n = ring.len();
    let turn = |i: usize| (ring[(i + 1) % n] - ring[i]).cross(ring[(i + 2) % n] - ring[(i + 1) % n]);
    (0..n).all(|i| turn(i) >= 0.0) || (0..n).all(|i| turn(i) <= 0.0)
}

pub(super) fn cross(p: Vec2, q: Vec2) -> f32 {
    p.x * q.y - p.y * q.x
}

#[cfg(test)]
mod tests {
    use super::{cross, outward_normals};
    use crate::app::paint::scene_painter::*;

    fn view() -> View {
        View { width_px: 100.0, height_px: 100.0, px_per_m: 10.0, centre: Point::default(), pixel_ratio: 1.0 }
    }

    /// Twice the area of a mesh's opaque triangles.
    fn twice_solid_area(mesh: &Mesh) -> f32 {
        let solid = |corner: &u32| mesh.vertices[*corner as usize].color == Color32::WHITE;
        mesh.triangles()
            .filter(|triangle| triangle.iter().all(solid))
            .map(|triangle| {
                let [a, b, c] = triangle.map(|corner| mesh.vertices[corner as usize].pos);
                cross(b - a, c - a).abs()
            })
            .sum()
    }

    #[test]
    fn a_polygon_with_a_hole_is_half_a_pixel_smaller_inside_its_soft_rim() {
        let square =
            |side: f64| [(0.0, 0.0), (side, 0.0), (side, side), (0.0, side)].map(|(x, y)| Point::new(x, y)).to_vec();
        let outer = square(4.0);
        for reversed in [false, true] {
            let mut hole: Vec<Point> = square(2.0).iter().map(|p| Point::new(p.x + 1.0, p.y + 1.0)).collect();
            if reversed {
                hole.reverse();
            }
            let holes = vec![hole];
            let triangles = earcut(&outer, &holes);
            let view = view();
            let mut writer = Writer::new(&view);
            writer.polygon(&outer, &holes, &triangles, Color32::WHITE);
            let chunks = writer.finish();
            // 40 by 40 points minus 20 by 20, each side inset by half a point.
            let expected = 39.0 * 39.0 - 21.0 * 21.0;
            assert_eq!(twice_solid_area(&chunks[0].mesh) / 2.0, expected, "{reversed}");
        }
    }

    #[test]
    fn lines_are_as_wide_as_they_say_and_hairpins_do_not_shoot_out() {
        let view = view();
        let mut writer = Writer::new(&view);
        writer.path(vec![pos2(0.0, 0.0), pos2(10.0, 0.0)], false, Stroke::new(3.0, Color32::WHITE));
        // The solid core is a pixel narrower than the line with its two soft sides.
        assert_eq!(twice_solid_area(&writer.mesh) / 2.0, 10.0 * 2.0);
        let mut writer = Writer::new(&view);
        let hairpin = vec![pos2(0.0, 0.0), pos2(10.0, 0.0), pos2(0.0, 1e-4), pos2(0.0, 5.0)];
        writer.path(hairpin, true, Stroke::new(2.0, Color32::WHITE));
        assert!(Rect::from_min_max(pos2(-3.0, -3.0), pos2(13.0, 8.0)).contains_rect(writer.mesh.calc_bounds()));
        writer.path(vec![pos2(1.0, 1.0); 5], true, Stroke::new(2.0, Color32::WHITE));
        assert!(writer.mesh.vertices.iter().all(|vertex| vertex.pos.is_finite()));
    }

    #[test]
    fn rings_with_repeated_points_stay_finite() {
        let ring = [pos2(0.0, 0.0), pos2(0.0, 0.0), pos2(9.0, 0.0), pos2(9.0, 9.0), pos2(0.0, 0.0)];
        assert!(outward_normals(&ring, false).iter().all(|normal| normal.is_finite() && normal.length() < 3.0));
        assert!(outward_normals(&[], false).is_empty());
    }
}
