//! Tools: what the pointer does on the canvas. One file each, one line in [`TOOLS`].
//!
//! A tool is a state machine. It receives pointer actions, already snapped, and responds with command
//! calls: so drawing by hand and drawing by script are the same. Between calls it only shows a preview.

mod array;
mod calibrate;
mod common_points;
mod cut_out;
mod dimension;
mod fill;
mod ghost;
mod input;
mod measure;
mod moving;
mod number;
mod offset;
mod opening;
mod opening_grips;
mod paste;
mod path;
mod rectangle;
mod rectify;
mod room;
mod select;
mod split;
mod straighten;
mod tool;
mod toolbox;
mod transform;
mod typing;
mod walls;

pub(crate) use crate::app::paint::preview::{paint_snap, tag};
pub(crate) use crate::app::value::{Call, Value};
pub(crate) use array::{ARRAY, POLAR_ARRAY};
pub(crate) use calibrate::{BY_DOOR as CALIBRATE_BY_DOOR, BY_LENGTH as CALIBRATE_BY_LENGTH};
pub(crate) use common_points::ENTRY as COMMON_POINTS;
pub(crate) use input::{Anchor, DrawOptions, Ground, Input, NUDGES_MORE, Scope};
pub(crate) use number::ENTRY as NUMBER;
pub(crate) use offset::OFFSET;
pub(crate) use paste::ENTRY as PASTE;
pub(crate) use rectify::ENTRY as RECTIFY;
pub(crate) use select::{REACH_PX, handle_at, hit};
pub(crate) use straighten::ENTRY as STRAIGHTEN;
pub(crate) use tool::{Entry, Group, TakenBack, Tool, ToolOption};
pub(crate) use toolbox::{Toolbox, attracting_grid_m};
pub(crate) use transform::{MIRROR, ROTATE, SCALE};
pub(crate) use typing::{Typed, Typing};

/// Every tool. The first one is the default.
pub(crate) const TOOLS: &[Entry] = &[
    select::ENTRY,
    walls::ENTRY,
    rectangle::ENTRY,
    room::ENTRY,
    fill::ENTRY,
    split::ENTRY,
    cut_out::ENTRY,
    opening::DOOR,
    opening::DOUBLE_DOOR,
    opening::PASSAGE,
    opening::WINDOW,
    measure::ENTRY,
    dimension::ENTRY,
    number::ENTRY,
    paste::ENTRY,
    transform::MIRROR,
    transform::ROTATE,
    transform::SCALE,
    array::ARRAY,
    array::POLAR_ARRAY,
    offset::OFFSET,
    calibrate::BY_LENGTH,
    calibrate::BY_DOOR,
    straighten::ENTRY,
    rectify::ENTRY,
    common_points::ENTRY,
];

/// Positions and lengths of the backdrop: a hundredth of a millimetre in the plan is below any pixel.
fn picture_numbers<const N: usize>(values: [f64; N]) -> [Value; N] {
    values.map(|value| Value::Number((value * 1e5).round() / 1e5))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_tool_has_a_word_of_its_own() {
        let mut ids: Vec<&str> = TOOLS.iter().map(|entry| entry.id).collect();
        ids.sort_unstable();
        ids.dedup();
        assert_eq!(ids.len(), TOOLS.len());
    }
}
