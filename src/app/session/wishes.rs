//! Requests of the session to the rest of the window, which it does not know.

use std::any::Any;

use crate::app::session::origin::Origin;
use crate::app::session::questions::Intent;
use crate::app::value::Call;
use crate::geometry::{Bounds, Point};
use crate::plan::ElementId;
use crate::store::Draft;

/// Something for the rest of the window to do.
#[derive(Debug)]
pub(crate) enum Wish {
    /// Another plan is shown: drop what belonged to the previous one.
    ForgetPlan,
    /// No plan is shown any more.
    ForgetDrawing,
    /// Move the view if necessary, so that an element is visible.
    Reveal(ElementId),
    ZoomTo(Bounds),
    /// Show a point in the middle, a metre so many screen points long.
    LookAt {
        centre: Point,
        px_per_m: f64,
    },
    /// Show the whole plan.
    Fit,
    /// Keep what was scaled about a point in place on the screen.
    ScaleView {
        about: Point,
        factor: f64,
    },
    /// Offer the journals left behind by crashed programs.
    OfferRecovery,
    CloseRecovery,
    CloseDifferences,
    Run(Call),
    /// Open a plan to look at, as from the list.
    OpenListed(Origin),
    /// Ask for the path that a command takes, beginning with a text.
    TypePath {
        command: &'static str,
        text: String,
    },
    /// Go on with what was half drawn.
    Resume(Draft),
    /// End the recording, then go on.
    EndRecording(Intent),
    /// Pass the recorder a message that only it can read.
    Recording(Box<dyn Any + Send>),
}
