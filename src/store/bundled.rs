use crate::formats::{ReadError, plan_json};
use crate::plan::Plan;

/// The bundled plans: the name of each one's file in `plans/`, and its text.
pub const BUNDLED: [(&str, &str); 3] = [
    ("office.plan.json", include_str!("../../plans/office.plan.json")),
    ("school.plan.json", include_str!("../../plans/school.plan.json")),
    ("dwelling.plan.json", include_str!("../../plans/dwelling.plan.json")),
];

/// The bundled plans with the names of their files; the first is the one to show first.
///
/// # Errors
/// When one cannot be read, which the tests rule out.
pub fn bundled_plans() -> Result<Vec<(&'static str, Plan)>, ReadError> {
    BUNDLED.into_iter().map(|(name, text)| Ok((name, plan_json::from_bytes(text.as_bytes())?))).collect()
}
