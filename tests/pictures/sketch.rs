//! Small plans in a concise notation.

use enfilade::features::{Analysis, NeighbourLabels, analyse};
use enfilade::geometry::Point;
use enfilade::labels::{Schemes, Typology};
use enfilade::plan::{Builder, CornerId, LeafSide, Meta, Opening, OpeningKind, Place, Plan, Room, Swing};

/// A plan being sketched: an office, so that functions have labels.
pub struct Sketch {
    builder: Builder,
}

impl Sketch {
    pub fn new() -> Self {
        Self { builder: Builder::new(Meta { typology: Typology::new("office"), ..Meta::default() }) }
    }

    pub fn titled(name: &str, building: &str, storey: &str) -> Self {
        let meta = Meta {
            name: name.to_owned(),
            building: building.to_owned(),
            storey: storey.to_owned(),
            typology: Typology::new("office"),
            ..Meta::default()
        };
        Self { builder: Builder::new(meta) }
    }

    fn corner(&mut self, (x, y): (f64, f64)) -> CornerId {
        self.builder.corner(Point::new(x, y))
    }

    /// Walls of one thickness along a line through points.
    pub fn walls(mut self, thickness_m: f64, points: &[(f64, f64)]) -> Self {
        for pair in points.windows(2) {
            let (from, to) = (self.corner(pair[0]), self.corner(pair[1]));
            self.builder.wall(from, to, thickness_m);
        }
        self
    }

    /// A room through points.
    pub fn room(self, function: &str, points: &[(f64, f64)]) -> Self {
        self.room_with_holes(function, "", points, &[])
    }

    pub fn named_room(self, function: &str, name: &str, points: &[(f64, f64)]) -> Self {
        self.room_with_holes(function, name, points, &[])
    }

    pub fn room_with_holes(
        mut self,
        function: &str,
        name: &str,
        points: &[(f64, f64)],
        holes: &[&[(f64, f64)]],
    ) -> Self {
        let mut ring = |points: &[(f64, f64)]| self.builder.ring(points.iter().map(|&(x, y)| Point::new(x, y)));
        let outer = ring(points);
        let holes = holes.iter().map(|hole| ring(hole)).collect();
        let (function, name) = (function.to_owned(), name.to_owned());
        self.builder.room("", Room { outer, holes, function, name, ..Room::default() });
        self
    }

    /// A room from its lower left and upper right corner.
    pub fn rectangle(self, function: &str, low: (f64, f64), high: (f64, f64)) -> Self {
        self.room(function, &[low, (high.0, low.1), high, (low.0, high.1)])
    }

    /// An opening of a kind and width on an edge, its middle so far from the edge's start.
    pub fn opening(self, kind: OpeningKind, edge: [(f64, f64); 2], at_m: f64, width_m: f64) -> Self {
        self.hung(kind, edge, at_m, width_m, None)
    }

    pub fn swung(self, edge: [(f64, f64); 2], at_m: f64, hinge_at_start: bool, side: LeafSide) -> Self {
        self.hung(OpeningKind::Door, edge, at_m, 0.9, Some(Swing { hinge_at_start, side }))
    }

    fn hung(mut self, kind: OpeningKind, edge: [(f64, f64); 2], at_m: f64, width_m: f64, swing: Option<Swing>) -> Self {
        let [from, to] = edge.map(|point| self.corner(point));
        let opening = Opening::new(kind, Place::Hosted { from, to, at_m, width_m });
        self.builder.opening("", Opening { swing, ..opening });
        self
    }

    /// An opening with no host, between two points.
    pub fn free(mut self, kind: OpeningKind, from: (f64, f64), to: (f64, f64)) -> Self {
        let place = Place::Free { from: Point::new(from.0, from.1), to: Point::new(to.0, to.1) };
        self.builder.opening("", Opening::new(kind, place));
        self
    }

    pub fn plan(self) -> (Plan, Analysis) {
        let plan = self.builder.finish().expect("a sketch is a valid plan");
        let analysis = analyse(&plan, &Schemes::bundled(), NeighbourLabels::True);
        (plan, analysis)
    }
}
