//! The plans that come with Enfilade, as drawn.

mod dwelling;
mod office;
mod school;
mod sheet;

use enfilade::labels::Typology;
use enfilade::plan::{Meta, Plan, Scale, ScaleOrigin};

/// A plan and the name of its file.
pub type Drawing = (&'static str, Plan);

/// All bundled plans, each with the name of its file.
///
/// # Errors
/// What does not fit in a drawing, in words.
pub fn all() -> Result<Vec<Drawing>, String> {
    Ok(vec![
        ("dwelling.plan.json", named("dwelling", dwelling::draw())?),
        ("office.plan.json", named("office", office::draw())?),
        ("school.plan.json", named("school", school::draw())?),
    ])
}

fn named(name: &str, drawn: Result<Plan, String>) -> Result<Plan, String> {
    drawn.map_err(|problems| format!("{name}:\n{problems}"))
}

/// What is known of a plan of ours.
fn meta(name: &str, building: &str, storey: &str, typology: &str) -> Meta {
    Meta {
        name: name.to_owned(),
        building: building.to_owned(),
        storey: storey.to_owned(),
        typology: Typology::new(typology),
        scale: Scale { origin: ScaleOrigin::Drawn, ..Scale::default() },
        source: "Drawn for Enfilade".to_owned(),
        licence: "MIT OR Apache-2.0".to_owned(),
        extra: None,
    }
}
