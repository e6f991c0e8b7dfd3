//! Everything that can be wrong with a plan: one file per check, named after its finding.
//!
//! [`check`] is a pure function that returns all findings, typed, each with its place and what to do
//! about it. To add a check, write a file, its `mod` line (outside the macro, where every tool can follow
//! it) and one line in the list below. What each check says, and how often it fires on real plans, is in
//! `docs/checks.md`.

mod axes_ratio_is_implausible;
mod context;
mod corners_nearly_coincide;
mod finding;
mod function_is_unknown;
mod invariant_is_broken;
pub mod likely_scale;
mod opening_contradicts_its_place;
mod opening_is_far_from_its_rooms;
mod opening_is_wider_than_its_wall;
mod opening_joins_a_room_to_itself;
mod opening_joins_nothing;
mod openings_overlap;
mod overlaps;
mod plan_has_no_openings;
mod plan_has_no_rooms;
mod plan_has_no_typology;
mod rings;
mod room_area_is_unusual;
mod room_boundary_crosses_itself;
mod room_boundary_encloses_nothing;
mod room_boundary_touches_itself;
mod room_has_no_boundary;
mod room_has_no_function;
mod room_has_no_opening;
mod room_hole_is_not_inside;
mod room_hole_lies_along_its_boundary;
mod room_holes_overlap;
mod room_is_drawn_twice;
mod room_lies_inside_another;
mod room_name_repeats;
mod rooms_are_cut_off;
mod rooms_leave_a_gap;
mod rooms_overlap;
mod scale_is_implausible;
mod sizes;
mod typology_has_no_scheme;
mod wall_ends_freely;
mod wall_has_no_length;
mod wall_stands_in_an_opening;
mod walls_overlap;

pub use context::Context;
pub use finding::{Check, Kind, Place, Severity};

use crate::edit::EditError;
use crate::features::Analysis;
use crate::labels::Schemes;
use crate::plan::{Ignored, Plan};

/// Declares the checks: one variant of [`Finding`] per check.
macro_rules! checks {
    ($($module:ident :: $finding:ident),* $(,)?) => {
        $(pub use $module::$finding;)*

        /// Something wrong with a plan, or worth a look.
        #[derive(Clone, Debug, PartialEq)]
        pub enum Finding {
            $(#[doc = concat!("See [`", stringify!($finding), "`].")] $finding($finding),)*
        }

        impl Finding {
            /// Every kind of finding, in the order they are reported.
            pub const KINDS: &[&Kind] = &[$(&$finding::KIND),*];

            /// The kind of finding.
            pub fn kind(&self) -> &'static Kind {
                match self { $(Self::$finding(_) => &$finding::KIND,)* }
            }

            /// The severity.
            pub fn severity(&self) -> Severity {
                match self { $(Self::$finding(finding) => finding.severity(),)* }
            }

            /// Where it is.
            pub fn place(&self) -> Place<'_> {
                match self { $(Self::$finding(finding) => finding.place(),)* }
            }

            /// What was found, in words, without a full stop.
            pub fn what(&self) -> String {
                match self { $(Self::$finding(finding) => finding.what(),)* }
            }

            /// What to do about it, in words, without a full stop.
            pub fn remedy(&self) -> &'static str {
                self.kind().remedy
            }

            /// What can be done about it without a doubt, as the title of a step; `None` where a person has to decide.
            pub fn fix_title(&self) -> Option<&'static str> {
                match self { $(Self::$finding(finding) => finding.fix_title(),)* }
            }

            /// The plan with that done; `plan` is the one that was checked.
            ///
            /// # Errors
            /// When it has no fix, or the edit is refused.
            pub fn fixed(&self, plan: &Plan) -> Result<Plan, EditError> {
                match self { $(Self::$finding(finding) => finding.fixed(plan),)* }
            }

            /// The measured figures, for machines; names include the unit.
            pub fn figures(&self) -> Vec<(&'static str, f64)> {
                match self { $(Self::$finding(finding) => finding.figures(),)* }
            }
        }

        fn find_all(context: &Context) -> Vec<Finding> {
            let mut found = Vec::new();
            $({
                let mut of_kind = $finding::find(context);
                of_kind.sort_by(finding::worst_first);
                of_kind.truncate(FINDINGS_LIMIT);
                found.extend(of_kind.into_iter().map(Finding::$finding));
            })*
            found
        }
    };
}

checks! {
    invariant_is_broken::InvariantIsBroken,
    plan_has_no_rooms::PlanHasNoRooms,
    room_has_no_boundary::RoomHasNoBoundary,
    room_boundary_encloses_nothing::RoomBoundaryEnclosesNothing,
    room_boundary_crosses_itself::RoomBoundaryCrossesItself,
    room_boundary_touches_itself::RoomBoundaryTouchesItself,
    room_hole_is_not_inside::RoomHoleIsNotInside,
    room_hole_lies_along_its_boundary::RoomHoleLiesAlongItsBoundary,
    room_holes_overlap::RoomHolesOverlap,
    room_is_drawn_twice::RoomIsDrawnTwice,
    room_lies_inside_another::RoomLiesInsideAnother,
    rooms_overlap::RoomsOverlap,
    rooms_leave_a_gap::RoomsLeaveAGap,
    opening_joins_nothing::OpeningJoinsNothing,
    opening_joins_a_room_to_itself::OpeningJoinsARoomToItself,
    opening_is_far_from_its_rooms::OpeningIsFarFromItsRooms,
    opening_contradicts_its_place::OpeningContradictsItsPlace,
    opening_is_wider_than_its_wall::OpeningIsWiderThanItsWall,
    openings_overlap::OpeningsOverlap,
    plan_has_no_openings::PlanHasNoOpenings,
    room_has_no_opening::RoomHasNoOpening,
    rooms_are_cut_off::RoomsAreCutOff,
    plan_has_no_typology::PlanHasNoTypology,
    typology_has_no_scheme::TypologyHasNoScheme,
    function_is_unknown::FunctionIsUnknown,
    room_has_no_function::RoomHasNoFunction,
    scale_is_implausible::ScaleIsImplausible,
    axes_ratio_is_implausible::AxesRatioIsImplausible,
    room_area_is_unusual::RoomAreaIsUnusual,
    room_name_repeats::RoomNameRepeats,
    wall_has_no_length::WallHasNoLength,
    walls_overlap::WallsOverlap,
    wall_stands_in_an_opening::WallStandsInAnOpening,
    wall_ends_freely::WallEndsFreely,
    corners_nearly_coincide::CornersNearlyCoincide,
}

/// The most findings of a kind returned for a plan, so that a damaged file (a thousand rooms in one
/// place) costs neither memory nor patience. Real plans have at most a few dozen.
pub const FINDINGS_LIMIT: usize = 1000;

/// Everything wrong with a plan, or worth a look: errors first, then by kind in the order of
/// [`Finding::KINDS`], then worst first, then in reading order from the top left. The same plan always
/// gives the same findings.
///
/// `analysis` must be that of the plan under the same schemes.
pub fn check(plan: &Plan, analysis: &Analysis, schemes: &Schemes) -> Vec<Finding> {
    let mut found = find_all(&Context::new(plan, analysis, schemes));
    // Stable: keeps the order of the checks within a severity.
    found.sort_by_key(|finding| std::cmp::Reverse(finding.severity()));
    found
}

impl Finding {
    /// What a plan keeps of it when it is ignored: its kind and elements, and the reason.
    pub fn as_ignored(&self, reason: &str) -> Ignored {
        Ignored::new(self.kind().name, self.place().elements, reason)
    }

    /// What the plan says if the finding is ignored.
    pub fn ignored_in<'p>(&self, plan: &'p Plan) -> Option<&'p Ignored> {
        if plan.ignored().is_empty() {
            return None;
        }
        let own = self.as_ignored("");
        plan.ignored().iter().find(|ignored| ignored.is_about(&own))
    }
}

impl std::fmt::Display for Finding {
    /// One sentence: what was found, where, and what to do.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.what())?;
        if let Some(at) = self.place().at {
            write!(f, " at ({:.2}, {:.2})", at.x, at.y)?;
        }
        write!(f, ": {}", self.remedy())
    }
}
