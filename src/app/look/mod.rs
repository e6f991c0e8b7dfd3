//! The look of the window: theme, icons, controls, readable keys.

pub(crate) mod icons;
pub(crate) mod keys;
pub(crate) mod length_field;
pub(crate) mod search;
pub(crate) mod text;
pub(crate) mod theme;
pub(crate) mod widgets;
