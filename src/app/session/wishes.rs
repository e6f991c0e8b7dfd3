//! What the session asks of the rest of the window, which it does not know.

use std::any::Any;

use crate::app::session::questions::Intent;
use crate::app::value::Call;
use crate::geometry::{Bounds, Point};
use crate::plan::ElementId;

/// Something the rest of the window is to do.
#[derive(Debug)]
pub(crate) enum Wish {
    /// Another plan is shown: what belonged to the one before is forgotten.
    ForgetPlan,
    /// No plan is shown any more.
    ForgetDrawing,
    /// Move the view if need be, so that an element is seen.
    Reveal(ElementId),
    ZoomTo(Bounds),
    /// Show the whole plan.
    Fit,
    /// What was scaled about a point stays where it is on the screen.
    ScaleView {
        about: Point,
        factor: f64,
    },
    /// Offer what programs that crashed left behind.
    OfferRecovery,
    CloseRecovery,
    CloseDifferences,
    Run(Call),
    /// End the recording, then go on.
    EndRecording(Intent),
    /// Tell the recorder something that it alone knows how to read.
    Recording(Box<dyn Any + Send>),
}
