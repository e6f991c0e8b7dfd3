//! Selecting and changing what is drawn.

use super::*;

pub(super) const COMMANDS: &[Command] = &[];
