//! Drawing: walls, rooms, openings.

use super::*;

pub(super) const COMMANDS: &[Command] = &[];
