use std::collections::{BTreeMap, BTreeSet};

use rstar::primitives::GeomWithData;
use rstar::{AABB, RTree};

use super::{Check, Context, FINDINGS_LIMIT, Kind, Place, Severity};
use crate::edit::{EditError, weld_corners};
use crate::geometry::{GRID_M, Point};
use crate::plan::{CornerId, ElementId, Plan};

/// Two corners of different walls or rooms so close that they were meant to be one: moving one of them
/// moves only part of what meets there.
#[derive(Clone, Debug, PartialEq)]
pub struct CornersNearlyCoincide {
    pub corners: [CornerId; 2],
    pub distance_m: f64,
    pub at: Point,
}

/// Corners closer than this, in metres, are meant to be one: less than any wall finish is thick, more
/// than rounding leaves.
const NEAR_M: f64 = 0.01;

impl Check for CornersNearlyCoincide {
    const KIND: Kind = Kind {
        name: "corners_nearly_coincide",
        title: "Corners nearly coincide",
        severity: Severity::Info,
        remedy: "weld them",
    };

    fn find(context: &Context) -> Vec<Self> {
        let plan = context.plan;
        // What each corner belongs to: fine details within one room are fine.
        let mut owners: BTreeMap<CornerId, BTreeSet<ElementId>> = BTreeMap::new();
        for (id, room) in plan.rooms() {
            for corner in room.rings().flat_map(|ring| ring.iter()) {
                owners.entry(*corner).or_default().insert(ElementId::Room(id));
            }
        }
        for (id, wall) in plan.walls() {
            for corner in [wall.from, wall.to] {
                owners.entry(corner).or_default().insert(ElementId::Wall(id));
            }
        }
        let corners: Vec<(CornerId, Point)> = owners.keys().filter_map(|&id| Some((id, plan.position(id)?))).collect();
        let points = corners.iter().map(|&(id, at)| GeomWithData::new([at.x, at.y], id)).collect();
        let tree: RTree<GeomWithData<[f64; 2], CornerId>> = RTree::bulk_load(points);
        let mut found = Vec::new();
        for &(id, at) in &corners {
            let box_around = AABB::from_corners([at.x - NEAR_M, at.y - NEAR_M], [at.x + NEAR_M, at.y + NEAR_M]);
            let mut near: Vec<(CornerId, f64)> = tree
                .locate_in_envelope(box_around)
                .map(|other| (other.data, at.distance(Point::new(other.geom()[0], other.geom()[1]))))
                .filter(|&(other, distance_m)| other > id && distance_m <= NEAR_M)
                .collect();
            near.sort_by_key(|&(other, _)| other);
            for (other, distance_m) in near {
                if owners[&id].is_disjoint(&owners[&other]) {
                    found.push(Self { corners: [id, other], distance_m, at });
                }
                if found.len() >= FINDINGS_LIMIT {
                    return found;
                }
            }
        }
        found
    }

    fn place(&self) -> Place<'_> {
        Place { elements: self.corners.map(ElementId::Corner).to_vec(), rooms: Vec::new(), at: Some(self.at) }
    }

    fn fix_title(&self) -> Option<&'static str> {
        Some("Weld the corners")
    }

    fn fixed(&self, plan: &Plan) -> Result<Plan, EditError> {
        // A hair more than they are apart, for rounding.
        weld_corners(plan, &BTreeSet::from(self.corners), self.distance_m.max(GRID_M) * 1.01)
    }

    fn what(&self) -> String {
        format!("two corners lie {:.1} mm apart", 1000.0 * self.distance_m)
    }

    fn figures(&self) -> Vec<(&'static str, f64)> {
        vec![("distance_m", self.distance_m)]
    }
}
