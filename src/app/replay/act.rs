//! A step of a script, parsed and ready to run.

use super::fault::Fault;
use super::stage::Stage;

/// The action of a step.
pub(super) type Act = Box<dyn Fn(&mut Stage<'_>) -> Result<(), Fault> + Send + Sync>;
