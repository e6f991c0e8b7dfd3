//! A step of a script, read and ready.

use super::fault::Fault;
use super::stage::Stage;

/// What a step does.
pub(super) type Act = Box<dyn Fn(&mut Stage<'_>) -> Result<(), Fault> + Send + Sync>;
