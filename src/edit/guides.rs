//! Adding, moving and removing guide lines.

use crate::edit::EditError;
use crate::geometry::{COORDINATE_LIMIT_M, trim_m};
use crate::plan::guides::MOST_GUIDES;
use crate::plan::{Guide, GuideAxis, Plan};

/// Adds a guide line; if it already exists, nothing changes.
///
/// # Errors
/// When it lies outside the drawing area, or there are already [`MOST_GUIDES`].
pub fn add_guide(plan: &Plan, axis: GuideAxis, at_m: f64) -> Result<Plan, EditError> {
    if !(at_m.is_finite() && at_m.abs() <= COORDINATE_LIMIT_M) {
        return Err(EditError(format!("{at_m} m lies outside the drawing area of ±{COORDINATE_LIMIT_M} m")));
    }
    if plan.guides.len() >= MOST_GUIDES {
        return Err(EditError(format!("there are {MOST_GUIDES} guides already")));
    }
    Ok(plan.with_guides(plan.guides.iter().cloned().chain([Guide::new(axis, at_m)])))
}

/// Removes a guide line.
///
/// # Errors
/// When there is none at this position.
pub fn remove_guide(plan: &Plan, axis: GuideAxis, at_m: f64) -> Result<Plan, EditError> {
    let kept: Vec<Guide> = plan.guides.iter().filter(|guide| !guide.is_at(axis, at_m)).cloned().collect();
    if kept.len() == plan.guides.len() {
        return Err(EditError(format!("there is no {axis} guide at {} m", trim_m(at_m))));
    }
    Ok(plan.with_guides(kept))
}

/// Moves a guide line along its normal; its unknown fields from a file move with it.
///
/// # Errors
/// As [`remove_guide`] and [`add_guide`].
pub fn move_guide(plan: &Plan, axis: GuideAxis, from_m: f64, to_m: f64) -> Result<Plan, EditError> {
    let moved = plan.guides.iter().find(|guide| guide.is_at(axis, from_m)).cloned();
    let without = remove_guide(plan, axis, from_m)?;
    // Checks the position.
    add_guide(&without, axis, to_m)?;
    let moved = moved.map(|guide| Guide { at_m: trim_m(to_m), ..guide });
    Ok(without.with_guides(without.guides.iter().cloned().chain(moved)))
}

/// Removes all guide lines.
pub fn clear_guides(plan: &Plan) -> Plan {
    plan.with_guides([])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn guides_are_sorted_unique_and_on_the_grid() {
        let plan = Plan::default();
        let plan = add_guide(&plan, GuideAxis::Vertical, 3.0).unwrap();
        let plan = add_guide(&plan, GuideAxis::Vertical, 1.000_04).unwrap();
        let plan = add_guide(&plan, GuideAxis::Horizontal, 7.0).unwrap();
        let again = add_guide(&plan, GuideAxis::Vertical, 1.0).unwrap();
        assert_eq!(again, plan);
        let places: Vec<_> = plan.guides().iter().map(|guide| (guide.axis.name(), guide.at_m)).collect();
        assert_eq!(places, [("horizontal", 7.0), ("vertical", 1.0), ("vertical", 3.0)]);
        let moved = move_guide(&plan, GuideAxis::Vertical, 1.0, 4.0).unwrap();
        assert_eq!(moved.guides().iter().map(|guide| guide.at_m).collect::<Vec<_>>(), [7.0, 3.0, 4.0]);
        assert!(remove_guide(&plan, GuideAxis::Horizontal, 1.0).is_err());
        assert!(add_guide(&plan, GuideAxis::Horizontal, f64::NAN).is_err());
        assert!(move_guide(&plan, GuideAxis::Vertical, 1.0, 1e9).is_err());
        assert_eq!(clear_guides(&plan).guides(), []);
        assert_eq!(remove_guide(&plan, GuideAxis::Vertical, 3.0).unwrap().guides().len(), 2);
    }
}
