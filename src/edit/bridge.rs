//! Closing gaps in walls with walls and openings.

use std::collections::BTreeSet;

use crate::edit::draw::{add_walls, divide_rooms, edges_of};
use crate::edit::overlay::{Overlay, overlay_paths};
use crate::edit::split::nearest_part;
use crate::edit::{self, EditError, fail};
use crate::plan::{CornerId, Opening, OpeningId, OpeningKind, Plan};
use crate::topology::Gap;

/// Closes gaps with walls, each as thick as the thicker of its two neighbours, and puts an opening of the
/// gap's width into each; returns the openings in the order of the gaps. Rooms are split as by
/// [`crate::edit::draw_walls`].
///
/// # Errors
/// When no gap is given, a gap no longer exists, or a wall cannot be drawn.
pub fn bridge_gaps(plan: &Plan, gaps: &[Gap], kind: OpeningKind) -> Result<(Plan, Vec<OpeningId>), EditError> {
    if gaps.is_empty() {
        return fail("no gap between walls in line is 0.30 to 1.50 m wide");
    }
    let (mut paths, mut thicknesses_m) = (Vec::new(), Vec::new());
    for gap in gaps {
        let ([Some(a), Some(b)], [Some(first), Some(second)]) =
            (gap.ends.map(|end| plan.position(end)), gap.walls.map(|wall| plan.wall(wall)))
        else {
            return fail("the gap is gone");
        };
        paths.push(vec![a, b]);
        thicknesses_m.push(first.thickness_m.max(second.thickness_m));
    }
    let Overlay { plan: overlaid, chains } = overlay_paths(plan, &paths)?;
    let along: Vec<(&[CornerId], f64)> = chains.iter().map(Vec::as_slice).zip(thicknesses_m).collect();
    let (next, walls) = add_walls(&overlaid, &along)?;
    if walls.len() < gaps.len() {
        return fail("a wall stands in the gap already");
    }
    let edges: BTreeSet<[CornerId; 2]> = chains.iter().flat_map(|chain| edges_of(chain)).collect();
    let (mut next, _) = divide_rooms(&next, &edges, None)?;
    let mut openings = Vec::new();
    for (gap, chain) in gaps.iter().zip(&chains) {
        // Something may cross the gap: the opening goes on the piece below its middle.
        let Some(place) = nearest_part(&next, chain, gap.segment.midpoint(), gap.width_m) else {
            return fail("a wall stands in the gap already");
        };
        let (with_opening, id) = edit::add_opening(&next, Opening::new(kind, place))?;
        next = with_opening;
        openings.push(id);
    }
    Ok((next, openings))
}
