use super::{Check, Context, Kind, Place, Severity};
use crate::base::numbers::lower_median;
use crate::plan::{DEFAULT_DOOR_WIDTH_M, OpeningKind, ScaleOrigin};

/// Doors or rooms are so much larger or smaller than usual that the plan's scale is probably wrong.
#[derive(Clone, Debug, PartialEq)]
pub struct ScaleIsImplausible {
    /// How many times too long the plan's lengths seem, on all evidence.
    pub factor: f64,
    /// Median width of its doors in metres, if the source gives widths.
    pub door_width_m: Option<f64>,
    /// How many times too long its lengths seem, judging by its rooms' areas.
    pub rooms_factor: Option<f64>,
    pub origin: ScaleOrigin,
}

/// Lengths that seem too long or too short by this factor are reported. Measured on the authors' 40
/// schools against the median area of their classrooms: differences between buildings move the estimate
/// by up to 1.45 where classrooms have a usual size; beyond 1.5, classrooms have 24 m² or 130 to 200 m².
const IMPLAUSIBLE_FACTOR: f64 = 1.5;

/// A scale wrong by this factor is a unit error (2.54 is an inch for a centimetre), whatever the
/// building.
const CERTAIN_FACTOR: f64 = 2.5;

/// Fewer doors than this say nothing about the scale: one may be a gate.
const DOORS_FOR_SCALE: usize = 3;

impl Check for ScaleIsImplausible {
    const KIND: Kind = Kind {
        name: "scale_is_implausible",
        title: "The plan's scale is implausible",
        severity: Severity::Warning,
        remedy: "measure something of known length and set the scale anew",
    };

    fn find(context: &Context) -> Vec<Self> {
        let door_width_m = door_width_m(context);
        let rooms_factor = context.length_factor.map(|(factor, _)| factor);
        let factors: Vec<f64> =
            door_width_m.map(|width_m| width_m / DEFAULT_DOOR_WIDTH_M).into_iter().chain(rooms_factor).collect();
        if factors.is_empty() {
            return Vec::new();
        }
        // The geometric mean: contradictory evidence cancels out.
        let factor = (factors.iter().map(|factor| factor.ln()).sum::<f64>() / factors.len() as f64).exp();
        if factor < IMPLAUSIBLE_FACTOR && factor > 1.0 / IMPLAUSIBLE_FACTOR {
            return Vec::new();
        }
        vec![Self { factor, door_width_m, rooms_factor, origin: context.plan.meta().scale.origin }]
    }

    fn severity(&self) -> Severity {
        let certain = self.factor > CERTAIN_FACTOR || self.factor < 1.0 / CERTAIN_FACTOR;
        if certain { Severity::Error } else { Severity::Warning }
    }

    fn place(&self) -> Place<'_> {
        Place::default()
    }

    fn what(&self) -> String {
        let mut reasons = Vec::new();
        if let Some(width_m) = self.door_width_m {
            reasons.push(format!("its doors are {width_m:.2} m wide instead of {DEFAULT_DOOR_WIDTH_M}"));
        }
        if let Some(factor) = self.rooms_factor {
            let areas = factor * factor;
            reasons.push(format!("its rooms have {areas:.1} times the area usual for their labels"));
        }
        let (factor, way) = if self.factor > 1.0 { (self.factor, "long") } else { (1.0 / self.factor, "short") };
        format!("lengths seem {factor:.1} times too {way}: {} (scale {})", reasons.join(", "), self.origin.name())
    }

    fn figures(&self) -> Vec<(&'static str, f64)> {
        let door = self.door_width_m.map(|width_m| ("door_width_m", width_m));
        let rooms = self.rooms_factor.map(|factor| ("rooms_factor", factor));
        [("factor", self.factor)].into_iter().chain(door).chain(rooms).collect()
    }
}

/// The median width of single doors in metres, if the source gives widths. A door of exactly the default
/// width may have been given it by an import: if most are, they say nothing (and if they are real,
/// nothing is wrong).
fn door_width_m(context: &Context) -> Option<f64> {
    let doors = context.openings.iter().filter(|placed| placed.opening.kind == OpeningKind::Door);
    let widths: Vec<f64> = doors.map(|placed| placed.segment.length()).collect();
    let is_given = |width_m: &f64| (width_m - DEFAULT_DOOR_WIDTH_M).abs() > crate::geometry::GRID_M;
    let mut given: Vec<f64> = widths.iter().copied().filter(is_given).collect();
    if given.len() < DOORS_FOR_SCALE || 2 * given.len() < widths.len() {
        return None;
    }
    lower_median(&mut given)
}
