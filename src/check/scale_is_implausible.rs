use super::{Check, Context, Kind, Place, Severity};
use crate::base::numbers::lower_median;
use crate::base::wording::thousands;
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
    /// Area of its median room in m², where nothing else tells and no building has such rooms.
    pub median_room_m2: Option<f64>,
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

/// The median room of a plan has an area in m² within this range, whatever the building: of 56 schools and
/// offices the medians lie between 2 and 140. Beyond, millimetres were taken for metres or the like.
const ANY_MEDIAN_M2: std::ops::RangeInclusive<f64> = 0.1..=10_000.0;

/// What a median room has, in m².
const USUAL_MEDIAN_M2: f64 = 30.0;

impl Check for ScaleIsImplausible {
    const KIND: Kind = Kind {
        name: "scale_is_implausible",
        title: "The plan's scale is implausible",
        severity: Severity::Warning,
        remedy: "measure something of known length and set the scale again",
    };

    fn find(context: &Context) -> Vec<Self> {
        let door_width_m = door_width_m(context);
        let rooms_factor = context.length_factor.map(|(factor, _)| factor);
        let mut factors: Vec<f64> =
            door_width_m.map(|width_m| width_m / DEFAULT_DOOR_WIDTH_M).into_iter().chain(rooms_factor).collect();
        let median_room_m2 = if factors.is_empty() { impossible_median_m2(context) } else { None };
        factors.extend(median_room_m2.map(|area_m2| (area_m2 / USUAL_MEDIAN_M2).sqrt()));
        if factors.is_empty() {
            return Vec::new();
        }
        // The geometric mean: contradictory evidence cancels out.
        let factor = (factors.iter().map(|factor| factor.ln()).sum::<f64>() / factors.len() as f64).exp();
        if factor < IMPLAUSIBLE_FACTOR && factor > 1.0 / IMPLAUSIBLE_FACTOR {
            return Vec::new();
        }
        vec![Self { factor, door_width_m, rooms_factor, median_room_m2, origin: context.plan.meta().scale.origin }]
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
        if let Some(area_m2) = self.median_room_m2 {
            let area = if area_m2 < 1.0 { format!("{area_m2:.4}") } else { thousands(area_m2.round() as u64) };
            reasons.push(format!("its median room has {area} m²"));
        }
        let (factor, way) = if self.factor > 1.0 { (self.factor, "long") } else { (1.0 / self.factor, "short") };
        format!("lengths seem {factor:.1} times too {way}: {} (scale {})", reasons.join(", "), self.origin.name())
    }

    fn figures(&self) -> Vec<(&'static str, f64)> {
        let door = self.door_width_m.map(|width_m| ("door_width_m", width_m));
        let rooms = self.rooms_factor.map(|factor| ("rooms_factor", factor));
        let median = self.median_room_m2.map(|area_m2| ("median_room_m2", area_m2));
        [("factor", self.factor)].into_iter().chain(door).chain(rooms).chain(median).collect()
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

/// The area of the median room in m², where no building has such rooms.
fn impossible_median_m2(context: &Context) -> Option<f64> {
    let areas = context.shapes().iter().map(|shape| shape.area_m2());
    let mut areas: Vec<f64> = areas.filter(|&area_m2| area_m2 > 0.0).collect();
    lower_median(&mut areas).filter(|area_m2| !ANY_MEDIAN_M2.contains(area_m2))
}
