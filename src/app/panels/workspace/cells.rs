//! What stands in the columns of the tables, and how wide they are.

use std::time::{Duration, SystemTime};

use crate::app::session::Session;
use crate::base::wording::count;
use crate::features::RoomStatus;
use crate::workspace::query::{PlanColumn, RoomColumn};
use crate::workspace::{PlanEntry, PlanFile, Problems, RoomEntry};

/// A column as it is shown: its share of the width, whether its figures stand at the right, and the least width of the
/// table in points at which it is shown.
pub(super) struct Shape<C> {
    pub column: C,
    pub share: f32,
    pub is_figure: bool,
    pub from: f32,
}

const fn shape<C>(column: C, share: f32, is_figure: bool, from: f32) -> Shape<C> {
    Shape { column, share, is_figure, from }
}

pub(super) const PLANS: &[Shape<PlanColumn>] = &[
    shape(PlanColumn::Name, 2.4, false, 0.0),
    shape(PlanColumn::File, 2.0, false, 820.0),
    shape(PlanColumn::Typology, 1.0, false, 560.0),
    shape(PlanColumn::Building, 1.6, false, 640.0),
    shape(PlanColumn::Storey, 1.1, false, 720.0),
    shape(PlanColumn::Rooms, 0.7, true, 0.0),
    shape(PlanColumn::Labelled, 0.9, true, 0.0),
    shape(PlanColumn::Problems, 0.9, true, 0.0),
    shape(PlanColumn::Agreement, 1.05, true, 480.0),
    shape(PlanColumn::Changed, 1.0, true, 900.0),
];

pub(super) const ROOMS: &[Shape<RoomColumn>] = &[
    shape(RoomColumn::Name, 1.6, false, 0.0),
    shape(RoomColumn::Function, 1.6, false, 0.0),
    shape(RoomColumn::Label, 1.2, false, 0.0),
    shape(RoomColumn::Area, 0.95, true, 560.0),
    shape(RoomColumn::Prediction, 1.4, false, 480.0),
    shape(RoomColumn::Probability, 0.6, true, 480.0),
    shape(RoomColumn::Plan, 2.0, false, 0.0),
    shape(RoomColumn::Building, 1.6, false, 1000.0),
    shape(RoomColumn::Typology, 1.0, false, 760.0),
];

/// The columns that are shown in a table of some width, each with its left and right end.
pub(super) fn columns<C: Copy>(shapes: &[Shape<C>], left: f32, right: f32) -> Vec<(C, bool, f32, f32)> {
    let shown: Vec<&Shape<C>> = shapes.iter().filter(|shape| shape.from <= right - left).collect();
    let all: f32 = shown.iter().map(|shape| shape.share).sum();
    let mut at = left;
    let place = |shape: &&Shape<C>| {
        let start = at;
        at += (right - left) * shape.share / all.max(0.1);
        (shape.column, shape.is_figure, start.round(), at.round())
    };
    shown.iter().map(place).collect()
}

/// A share in whole per cent: 100 only for all of it, 0 only for nothing.
pub(super) fn percent(part: usize, whole: usize) -> String {
    if whole == 0 {
        return "–".to_owned();
    }
    let percent = (100.0 * part as f64 / whole as f64).round() as usize;
    let percent = percent.clamp(usize::from(part > 0), if part < whole { 99 } else { 100 });
    format!("{percent} %")
}

/// What stands in a cell of a plan's row; of a file that is not read or cannot be, in its first column why.
pub(super) fn of_plan(session: &Session, file: &PlanFile, plan: Option<&PlanEntry>, column: PlanColumn) -> String {
    let Some(plan) = plan else {
        return match column {
            PlanColumn::Name => file.name().to_owned(),
            PlanColumn::File => file.path.to_string(),
            PlanColumn::Changed => changed(session, file),
            _ => String::new(),
        };
    };
    match column {
        PlanColumn::Name => file.title_of(plan).to_owned(),
        PlanColumn::File => file.path.to_string(),
        PlanColumn::Typology => plan.typology.as_ref().map(ToString::to_string).unwrap_or_default(),
        PlanColumn::Building => plan.building.to_string(),
        PlanColumn::Storey => plan.storey.to_string(),
        PlanColumn::Rooms => plan.rooms.len().to_string(),
        PlanColumn::Labelled => percent(plan.labelled, plan.to_label),
        PlanColumn::Problems => problems(&plan.problems),
        PlanColumn::Agreement if !plan.is_predicted => "…".to_owned(),
        PlanColumn::Agreement => {
            let (same, all) = plan.agreement();
            percent(same, all)
        }
        PlanColumn::Changed => changed(session, file),
    }
}

/// What stands in a cell of a room's row.
pub(super) fn of_room(
    session: &Session,
    file: &PlanFile,
    plan: &PlanEntry,
    room: &RoomEntry,
    column: RoomColumn,
) -> String {
    match column {
        RoomColumn::Name => room.name.to_string(),
        RoomColumn::Function => room.function.to_string(),
        RoomColumn::Label => label(room.status),
        RoomColumn::Area if room.area_m2 <= 0.0 => "–".to_owned(),
        RoomColumn::Area => session.units().area(f64::from(room.area_m2)),
        RoomColumn::Prediction => room.prediction.map(|(label, _)| label.name().to_owned()).unwrap_or_default(),
        RoomColumn::Probability => room.prediction.map(|(_, it)| format!("{:.0} %", 100.0 * it)).unwrap_or_default(),
        RoomColumn::Plan => file.title_of(plan).to_owned(),
        RoomColumn::Building => plan.building.to_string(),
        RoomColumn::Typology => plan.typology.as_ref().map(ToString::to_string).unwrap_or_default(),
    }
}

/// A room's label in words.
pub(super) fn label(status: RoomStatus) -> String {
    match status {
        RoomStatus::Labelled(label) => label.name().to_owned(),
        RoomStatus::NotClassified => "not classified".to_owned(),
        RoomStatus::Unlabelled => "no label".to_owned(),
    }
}

/// Errors and warnings, in figures.
fn problems(problems: &Problems) -> String {
    match (problems.errors, problems.warnings) {
        (0, 0) => "–".to_owned(),
        (errors, 0) => errors.to_string(),
        (0, warnings) => warnings.to_string(),
        (errors, warnings) => format!("{errors} + {warnings}"),
    }
}

/// The same in words.
pub(super) fn problems_in_words(problems: &Problems) -> String {
    match (problems.errors as usize, problems.warnings as usize) {
        (0, 0) => "no problems".to_owned(),
        (errors, 0) => count(errors, "error"),
        (0, warnings) => count(warnings, "warning"),
        (errors, warnings) => format!("{}, {}", count(errors, "error"), count(warnings, "warning")),
    }
}

/// When a file was last changed: how long ago, or the day.
fn changed(session: &Session, file: &PlanFile) -> String {
    let at = SystemTime::UNIX_EPOCH + Duration::from_nanos(file.state.modified_ns);
    // Without a clock nobody knows what time it is now.
    let Some(age) = session.safety.clock.and_then(|clock| clock().duration_since(at).ok()) else {
        return String::new();
    };
    let minutes = age.as_secs() / 60;
    match minutes {
        0..2 => "just now".to_owned(),
        2..60 => format!("{minutes} min ago"),
        60..1440 => format!("{} h ago", minutes / 60),
        1440..43200 => format!("{} d ago", minutes / 1440),
        _ => date(file.state.modified_ns / 86_400_000_000_000),
    }
}

/// The date of a day counted from 1970 (Hinnant, 'chrono-compatible low-level date algorithms', `civil_from_days`).
fn date(days: u64) -> String {
    let days = days + 719_468;
    let era = days / 146_097;
    let of_era = days % 146_097;
    let year_of_era = (of_era - of_era / 1460 + of_era / 36_524 - of_era / 146_096) / 365;
    let of_year = of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let month_from_march = (5 * of_year + 2) / 153;
    let day = of_year - (153 * month_from_march + 2) / 5 + 1;
    let month = if month_from_march < 10 { month_from_march + 3 } else { month_from_march - 9 };
    let year = year_of_era + era * 400 + u64::from(month <= 2);
    format!("{year}-{month:02}-{day:02}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn days_have_dates_and_shares_do_not_round_to_all_or_nothing() {
        assert_eq!(date(0), "1970-01-01");
        assert_eq!(date(19_782), "2024-02-29");
        assert_eq!(date(20_784), "2026-11-27");
        assert_eq!(percent(999, 1000), "99 %");
        assert_eq!(percent(1, 1000), "1 %");
        assert_eq!(percent(0, 0), "–");
        assert_eq!(percent(7, 7), "100 %");
    }
}
