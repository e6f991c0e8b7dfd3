//! How the window looks: theme, icons, controls, keys as people read them.

pub(crate) mod icons;
pub(crate) mod keys;
pub(crate) mod search;
pub(crate) mod theme;
pub(crate) mod widgets;
