//! The difference between two plans, with the changed elements in their disk form: what the journal keeps
//! of an edit.

use super::super::json_text;
use super::*;
use crate::plan::{ChangeKind, Difference};

/// The changed elements in their new state, the ids of removed ones, and what else changed.
#[derive(Default, Serialize, Deserialize)]
#[serde(expecting = "a change of a plan", deny_unknown_fields)]
struct DiskChange {
    #[serde(skip_serializing_if = "Option::is_none")]
    meta: Option<DiskMeta>,
    /// At most one element: the new backdrop, or null for none. Empty if it did not change.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    backdrop: Vec<Option<DiskBackdrop>>,
    /// All guide lines, if they changed.
    #[serde(skip_serializing_if = "Option::is_none")]
    guides: Option<Vec<DiskGuide>>,
    /// All ignored findings, if they changed.
    #[serde(skip_serializing_if = "Option::is_none")]
    ignored: Option<Vec<DiskIgnored>>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    corners: Vec<DiskCorner>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    walls: Vec<DiskWall>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    rooms: Vec<DiskRoom>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    openings: Vec<DiskOpening>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    dimensions: Vec<DiskDimension>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    gone: Vec<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    extra: Option<Map<String, Value>>,
}

/// The change from one plan to another, as JSON on one line. Its size and cost depend only on the
/// difference.
pub(crate) fn change_to_bytes(before: &Plan, after: &Plan) -> Vec<u8> {
    let difference = Difference::between(before, after);
    let mut disk = DiskChange {
        meta: difference.meta.then(|| DiskMeta::of(&after.meta)),
        guides: difference.guides.then(|| after.guides().iter().map(DiskGuide::of).collect()),
        ignored: difference.ignored.then(|| after.ignored().iter().map(DiskIgnored::of).collect()),
        extra: difference.extra.then(|| fields(&after.extra)),
        ..DiskChange::default()
    };
    if difference.backdrop {
        disk.backdrop.push(after.backdrop().map(DiskBackdrop::of));
    }
    for (&element, &kind) in &difference.elements {
        if kind == ChangeKind::Removed {
            disk.gone.push(element.to_string());
            continue;
        }
        match element {
            ElementId::Corner(id) => disk.corners.extend(after.corner(id).map(|corner| DiskCorner::of(id, corner))),
            ElementId::Wall(id) => disk.walls.extend(after.wall(id).map(|wall| DiskWall::of(id, wall))),
            ElementId::Room(id) => disk.rooms.extend(after.room(id).map(|room| DiskRoom::of(id, room))),
            ElementId::Opening(id) => {
                disk.openings.extend(after.opening(id).map(|opening| DiskOpening::of(id, opening)));
            }
            ElementId::Dimension(id) => {
                disk.dimensions.extend(after.dimension(id).map(|dimension| DiskDimension::of(id, dimension)));
            }
        }
    }
    json_text::compact(&disk).into_bytes()
}

/// Applies a change to a plan. The invariants are not checked.
///
/// # Errors
/// When the bytes are not a change; the error says why.
pub(crate) fn apply_change(plan: &Plan, bytes: &[u8]) -> Result<Plan, String> {
    let disk: DiskChange = serde_json::from_slice(bytes).map_err(|error| error.to_string())?;
    let mut plan = plan.clone();
    if let Some(meta) = disk.meta {
        plan.meta = Arc::new(meta.live());
    }
    if let Some(backdrop) = disk.backdrop.into_iter().next() {
        plan.backdrop = backdrop.map(|backdrop| Arc::new(backdrop.live()));
    }
    if let Some(guides) = disk.guides {
        plan.guides = guides::sorted(guides.into_iter().take(guides::MOST_GUIDES).map(DiskGuide::live));
    }
    if let Some(ignored) = disk.ignored {
        plan.ignored = ignored::sorted(ignored.into_iter().take(ignored::MOST_IGNORED).map(DiskIgnored::live));
    }
    if let Some(extra) = disk.extra {
        plan.extra = kept(extra);
    }
    for id in disk.gone {
        let unknown = || format!("'{id}' is no id");
        match id.as_bytes().first() {
            Some(b'c') => drop(plan.corners.remove(&id.parse::<CornerId>().map_err(|_| unknown())?)),
            Some(b'w') => drop(plan.walls.remove(&id.parse::<WallId>().map_err(|_| unknown())?)),
            Some(b'r') => drop(plan.rooms.remove(&id.parse::<RoomId>().map_err(|_| unknown())?)),
            Some(b'o') => drop(plan.openings.remove(&id.parse::<OpeningId>().map_err(|_| unknown())?)),
            Some(b'd') => drop(plan.dimensions.remove(&id.parse::<DimensionId>().map_err(|_| unknown())?)),
            _ => return Err(unknown()),
        }
    }
    for corner in disk.corners {
        let position = Point::new(corner.x.0, corner.y.0);
        plan.corners.insert(corner.id.0, Corner { position, extra: kept(corner.extra) });
    }
    for wall in disk.walls {
        let (from, to, thickness_m) = (wall.from.0, wall.to.0, wall.thickness.0);
        plan.walls.insert(wall.id.0, Wall { from, to, thickness_m, extra: kept(wall.extra) });
    }
    for room in disk.rooms {
        plan.rooms.insert(room.id.0, Arc::new(room.live()));
    }
    for opening in disk.openings {
        let id = opening.id.0;
        let opening = opening.live().map_err(|(what, _)| format!("the opening {id} {what}"))?;
        plan.openings.insert(id, Arc::new(opening));
    }
    for dimension in disk.dimensions {
        let id = dimension.id.0;
        let dimension = dimension.live().map_err(|(what, _)| format!("the dimension {id}: {what}"))?;
        plan.dimensions.insert(id, Arc::new(dimension));
    }
    Ok(plan)
}
