use super::{Check, Context, Kind, Place, Severity};
use crate::edit::{self, EditError};
use crate::geometry::Point;
use crate::plan::{ElementId, Plan, WallId};

/// A wall whose two corners coincide.
#[derive(Clone, Debug, PartialEq)]
pub struct WallHasNoLength {
    pub wall: WallId,
    pub at: Point,
}

impl Check for WallHasNoLength {
    const KIND: Kind = Kind {
        name: "wall_has_no_length",
        title: "Wall has no length",
        severity: Severity::Error,
        remedy: "delete it, or weld its corners",
    };

    fn find(context: &Context) -> Vec<Self> {
        let walls = context.plan.walls();
        walls
            .filter_map(|(id, wall)| Some((id, context.plan.wall_segment(wall).filter(|wall| wall.a == wall.b)?)))
            .map(|(wall, segment)| Self { wall, at: segment.a })
            .collect()
    }

    fn place(&self) -> Place<'_> {
        Place { elements: vec![ElementId::Wall(self.wall)], rooms: Vec::new(), at: Some(self.at) }
    }

    fn fix_title(&self) -> Option<&'static str> {
        Some("Delete the wall without length")
    }

    fn fixed(&self, plan: &Plan) -> Result<Plan, EditError> {
        edit::remove(plan, &[ElementId::Wall(self.wall)])
    }

    fn what(&self) -> String {
        "a wall begins where it ends".to_owned()
    }
}
