//! Openings after their walls have changed: they stay where they are in the plan, and where they no longer
//! fit they are moved to fit, and the edit says so.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::edit::openings::{beside_others, fitted, run_of};
use crate::edit::{EditError, fail};
use crate::geometry::{GRID_M, Point, Segment, trim_m};
use crate::plan::{CornerId, Opening, OpeningId, OpeningKind, Place, Plan};

/// The result of an edit that may have had to fit openings anew.
#[derive(Clone, Debug)]
pub struct Changed {
    pub plan: Plan,
    /// What became of openings that no longer fitted where they were, by id.
    pub refitted: Vec<Refitted>,
}

/// An opening that no longer fitted where it was.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Refitted {
    pub opening: OpeningId,
    pub kind: OpeningKind,
    pub how: Refit,
}

/// What was done with it. Lengths are in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Refit {
    /// It was moved along its wall.
    Moved { by_m: f64 },
    /// Its wall is no longer, so it is narrower.
    Narrowed { from_m: f64, to_m: f64 },
    /// Another opening stands where it would be.
    LeftOut,
}

impl Changed {
    /// A plan in which every opening fits as before.
    pub(super) fn plainly(plan: Plan) -> Self {
        Self { plan, refitted: Vec::new() }
    }
}

/// No opening is made narrower than this, in metres: a slit is no window.
const NARROWEST_M: f64 = 0.3;

/// An opening reaches beyond its edge where it does so by more than this, in metres: a wall that is divided beside an
/// opening may leave it a hair too short.
const OVER_M: f64 = 0.003;

/// An opening is moved where its middle changes by more than this, in metres: less is rounding.
const MOVED_M: f64 = 0.002;

/// Puts openings whose edges changed at the places wanted for their middles, as near as their walls allow: on
/// their own edge or one in line with it that is long enough, beside other openings. An opening that reached
/// beyond its edge in `before` may still do so.
///
/// # Errors
/// When an opening's edge has no length or leaves it no space.
pub(super) fn refit(
    before: &Plan,
    after: Plan,
    wanted: &BTreeMap<OpeningId, Point>,
) -> Result<(Plan, Vec<Refitted>), EditError> {
    let mut next = after;
    let mut refitted = Vec::new();
    let mut waiting: Vec<(OpeningId, Arc<Opening>, Point)> = Vec::new();
    for (&id, &middle) in wanted {
        // None is in the way of another before each has its place.
        if let Some(opening) = next.openings.remove(&id) {
            waiting.push((id, opening, middle));
        }
    }
    for (id, mut opening, middle) in waiting {
        if let Place::Hosted { from, to, at_m, width_m } = opening.place {
            let place = place_near(&next, &opening, middle, reaches_over(before, id))?;
            if let Place::Hosted { from: host, to: end, at_m: now_m, width_m: now_wide_m } = place {
                let is_same = (host, end) == (from, to)
                    && (now_m - at_m).abs() < 1.5 * GRID_M
                    && (now_wide_m - width_m).abs() < 1.5 * GRID_M;
                if !is_same {
                    Arc::make_mut(&mut opening).place = place;
                }
                let stands = next.opening_segment(&opening).map(Segment::midpoint);
                let by_m = stands.map_or(0.0, |stands| along_distance(&next, (host, end), stands, middle));
                let kind = opening.kind;
                if now_wide_m < width_m - OVER_M {
                    let how = Refit::Narrowed { from_m: width_m, to_m: now_wide_m };
                    refitted.push(Refitted { opening: id, kind, how });
                } else if by_m > MOVED_M {
                    refitted.push(Refitted { opening: id, kind, how: Refit::Moved { by_m } });
                }
            }
        }
        next.openings.insert(id, opening);
    }
    Ok((next, refitted))
}

/// How far apart two points are along an edge, in metres.
fn along_distance(plan: &Plan, (from, to): (CornerId, CornerId), a: Point, b: Point) -> f64 {
    let along = plan.position(from).zip(plan.position(to)).and_then(|(from, to)| (to - from).unit());
    along.map_or(0.0, |along| (b - a).dot(along).abs())
}

/// Whether an opening reaches beyond its edge: over edges in line with it.
fn reaches_over(plan: &Plan, id: OpeningId) -> bool {
    let Some(Place::Hosted { from, to, at_m, width_m }) = plan.opening(id).map(|opening| opening.place) else {
        return false;
    };
    let length_m = plan.position(from).zip(plan.position(to)).map_or(0.0, |(a, b)| a.distance(b));
    at_m - width_m / 2.0 < -OVER_M || at_m + width_m / 2.0 > length_m + OVER_M
}

/// The place of a hosted opening with its middle as near to a point as its walls allow.
fn place_near(plan: &Plan, opening: &Opening, middle: Point, reaches_over: bool) -> Result<Place, EditError> {
    let Place::Hosted { from, to, width_m, .. } = opening.place else { return Ok(opening.place) };
    let name = opening.kind.name();
    let edge = |(a, b): (CornerId, CornerId)| Some(Segment::new(plan.position(a)?, plan.position(b)?));
    if edge((from, to)).is_none_or(|edge| edge.length() <= 0.0) {
        return fail(format!("the wall of a {name} would lose its length"));
    }
    let run = run_of(plan, from, to);
    if reaches_over {
        let nearest = run.iter().filter_map(|&host| Some((edge(host)?.distance(middle), host)));
        let host = nearest.min_by(|p, q| p.0.total_cmp(&q.0)).map_or((from, to), |(_, host)| host);
        return match over_run(plan, &run, host, middle, width_m) {
            Some(place) => Ok(place),
            None => fitted(plan, host, middle, width_m),
        };
    }
    // By how far the middle would move, its own edge first where that is the same.
    let off = |host: (CornerId, CornerId)| -> Option<(f64, (CornerId, CornerId))> {
        let edge = edge(host).filter(|edge| edge.length() + OVER_M >= width_m)?;
        let (along, half_m) = (edge.vector().unit()?, (width_m / 2.0).min(edge.length() / 2.0));
        let at_m = (middle - edge.a).dot(along);
        Some(((at_m - at_m.clamp(half_m, edge.length() - half_m)).abs(), host))
    };
    let own = off((from, to)).into_iter().chain(run.iter().filter_map(|&host| off(host)));
    let hosts = own.fold(None, |best: Option<(f64, (CornerId, CornerId))>, one| match best {
        Some(best) if best.0 <= one.0 + GRID_M => Some(best),
        _ => Some(one),
    });
    let (host, width_m) = match hosts {
        Some((_, host)) => {
            // Rounded down: what is wider than its edge by a grid step would reach over the next.
            let length_m = edge(host).map_or(0.0, Segment::length);
            (host, if width_m <= length_m { width_m } else { trim_m((length_m / GRID_M).floor() * GRID_M) })
        }
        None => {
            let length_m = edge((from, to)).map_or(0.0, Segment::length);
            // Rounded down, so that it is no longer than the wall.
            let width_m = (length_m / GRID_M).floor() * GRID_M;
            if width_m < NARROWEST_M {
                return fail(format!("no space would be left for a {name}: move or delete it first"));
            }
            ((from, to), trim_m(width_m))
        }
    };
    beside_others(plan, fitted(plan, host, middle, width_m)?)
        .map_err(|_| EditError(format!("a {name} would meet another opening: move or narrow one of them first")))
}

/// The place on an edge of a run with this middle, if the opening fits on the run as a whole.
fn over_run(
    plan: &Plan,
    run: &[(CornerId, CornerId)],
    host: (CornerId, CornerId),
    middle: Point,
    width_m: f64,
) -> Option<Place> {
    let edge = Segment::new(plan.position(host.0)?, plan.position(host.1)?);
    let along = edge.vector().unit()?;
    let at = |point: Point| (point - edge.a).dot(along);
    let ends = run.iter().flat_map(|&(a, b)| [a, b]).filter_map(|corner| plan.position(corner)).map(at);
    let (start_m, end_m) = ends.fold((0.0, edge.length()), |(start, end): (f64, f64), at| (start.min(at), end.max(at)));
    let at_m = at(middle).clamp(0.0, edge.length());
    let fits = at_m - width_m / 2.0 >= start_m - OVER_M && at_m + width_m / 2.0 <= end_m + OVER_M;
    fits.then_some(Place::Hosted { from: host.0, to: host.1, at_m: trim_m(at_m), width_m })
}

/// Where the middles of openings belong once corners have moved: where they are, unless their wall itself
/// moves, which is when both of its ends do; then they keep their place along it.
pub(super) fn wanted_middles(plan: &Plan, moved: &BTreeMap<CornerId, Point>) -> BTreeMap<OpeningId, Point> {
    let mut wanted = BTreeMap::new();
    for (id, opening) in plan.openings() {
        let Place::Hosted { from, to, at_m, .. } = opening.place else { continue };
        let (start, end) = (moved.get(&from), moved.get(&to));
        if start.is_none() && end.is_none() {
            continue;
        }
        let (Some(a), Some(b)) = (plan.position(from), plan.position(to)) else { continue };
        let Some(middle) = plan.opening_segment(opening).map(Segment::midpoint) else { continue };
        let by = match (start, end) {
            (Some(&start), Some(&end)) => {
                // The ends may slide along what they stand on: only the way across counts.
                let (from_start, from_end) = (start - a, end - b);
                let length_m = a.distance(b);
                let share = if length_m > 0.0 { at_m / length_m } else { 0.0 };
                let mean = from_start * (1.0 - share) + from_end * share;
                // A wall that is as long as before moved or turned as a whole.
                if (start.distance(end) - length_m).abs() <= 2.0 * GRID_M {
                    mean
                } else {
                    (b - a).left().unit().map_or(mean, |across| across * mean.dot(across))
                }
            }
            _ => crate::geometry::Vector::new(0.0, 0.0),
        };
        wanted.insert(id, middle + by);
    }
    wanted
}

/// Moves the openings of `which` that another one overlaps beside it; those that find no place are taken out.
pub(super) fn beside_each_other(plan: Plan, which: impl IntoIterator<Item = OpeningId>) -> (Plan, Vec<Refitted>) {
    let mut next = plan;
    let mut refitted = Vec::new();
    for id in which {
        let Some(opening) = next.openings.get(&id).cloned() else { continue };
        let Place::Hosted { from, to, at_m, width_m } = opening.place else { continue };
        let length_m = next.position(from).zip(next.position(to)).map_or(0.0, |(a, b)| a.distance(b));
        let others = next.openings().filter(|(other, _)| *other != id).filter_map(|(_, other)| match other.place {
            Place::Hosted { from: p, to: q, at_m, width_m } if [p, q] == [from, to] => Some((at_m, width_m)),
            Place::Hosted { from: p, to: q, at_m, width_m } if [p, q] == [to, from] => Some((length_m - at_m, width_m)),
            _ => None,
        });
        let is_met = others
            .into_iter()
            .any(|(other_m, wide_m)| (other_m - at_m).abs() < (wide_m + width_m) / 2.0 - 1.5 * GRID_M);
        if !is_met {
            continue;
        }
        let mut without = next.clone();
        without.openings.remove(&id);
        let how = match beside_others(&without, opening.place) {
            Ok(place @ Place::Hosted { at_m: now_m, .. }) => {
                let mut moved = opening.clone();
                Arc::make_mut(&mut moved).place = place;
                without.openings.insert(id, moved);
                Refit::Moved { by_m: (now_m - at_m).abs() }
            }
            _ => Refit::LeftOut,
        };
        next = without;
        refitted.push(Refitted { opening: id, kind: opening.kind, how });
    }
    (next, refitted)
}
