//! The picture under the plan, to trace over.

use super::*;

pub(super) const COMMANDS: &[Command] = &[];
