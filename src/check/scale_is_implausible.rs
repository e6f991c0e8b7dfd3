use super::{Check, Context, Kind, Place, Severity};
use crate::base::numbers::lower_median;
use crate::base::wording::thousands;
use crate::check::likely_scale::{LikelyScale, likely_scale};
use crate::edit::{EditError, rescale};
use crate::plan::{MEDIAN_DOOR_M, Plan, ScaleOrigin};

/// Doors or rooms are so much larger or smaller than usual that the plan's scale is probably wrong.
#[derive(Clone, Debug, PartialEq)]
pub struct ScaleIsImplausible {
    /// How many times too long the plan's lengths seem, on all evidence.
    pub factor: f64,
    /// What its doors and rooms say, if they say anything.
    pub likely: Option<LikelyScale>,
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
        let likely = likely_scale(context);
        let median_room_m2 = if likely.is_none() { impossible_median_m2(context) } else { None };
        let by_median = median_room_m2.map(|area_m2| (area_m2 / USUAL_MEDIAN_M2).sqrt());
        let Some(factor) = likely.map(|likely| likely.factor()).or(by_median) else { return Vec::new() };
        if factor < IMPLAUSIBLE_FACTOR && factor > 1.0 / IMPLAUSIBLE_FACTOR {
            return Vec::new();
        }
        vec![Self { factor, likely, median_room_m2, origin: context.plan.meta().scale.origin }]
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
        if let Some(doors) = self.likely.and_then(|likely| likely.doors) {
            let width_m = doors.median_width_m;
            reasons.push(format!("its doors are {width_m:.2} m wide at the median instead of {MEDIAN_DOOR_M}"));
        }
        if let Some(rooms) = self.likely.and_then(|likely| likely.rooms) {
            let areas = rooms.factor * rooms.factor;
            reasons.push(format!("its rooms have {areas:.1} times the area usual for their labels"));
        }
        if let Some(area_m2) = self.median_room_m2 {
            let area = if area_m2 < 1.0 { format!("{area_m2:.4}") } else { thousands(area_m2.round() as u64) };
            reasons.push(format!("its median room has {area} m²"));
        }
        let (factor, way) = if self.factor > 1.0 { (self.factor, "long") } else { (1.0 / self.factor, "short") };
        format!("lengths seem {factor:.1} times too {way}: {} (scale {})", reasons.join(", "), self.origin.name())
    }

    fn fix_title(&self) -> Option<&'static str> {
        // Rooms alone say it less surely, and doors that contradict them may be gates.
        let is_sure = |likely: LikelyScale| likely.doors.is_some() && !likely.is_contradictory();
        self.likely.is_some_and(is_sure).then_some("Scale the plan by its doors")
    }

    fn fixed(&self, plan: &Plan) -> Result<Plan, EditError> {
        if self.fix_title().is_none() {
            return Err(EditError("there is no safe fix".to_owned()));
        }
        let how = format!("estimated from the widths of its doors, which were {:.1} times the usual", self.factor);
        rescale(plan, 1.0 / self.factor, &how)
    }

    fn figures(&self) -> Vec<(&'static str, f64)> {
        let doors = self.likely.and_then(|likely| likely.doors).map(|doors| ("door_width_m", doors.median_width_m));
        let rooms = self.likely.and_then(|likely| likely.rooms).map(|rooms| ("rooms_factor", rooms.factor));
        let range = self.likely.map(|likely| likely.range());
        let range = range.into_iter().flat_map(|(least, most)| [("factor_least", least), ("factor_most", most)]);
        let median = self.median_room_m2.map(|area_m2| ("median_room_m2", area_m2));
        [("factor", self.factor)].into_iter().chain(range).chain(doors).chain(rooms).chain(median).collect()
    }
}

/// The area of the median room in m², where no building has such rooms.
fn impossible_median_m2(context: &Context) -> Option<f64> {
    let areas = context.shapes().iter().map(|shape| shape.area_m2());
    let mut areas: Vec<f64> = areas.filter(|&area_m2| area_m2 > 0.0).collect();
    lower_median(&mut areas).filter(|area_m2| !ANY_MEDIAN_M2.contains(area_m2))
}
