//! The work at hand: the open plan and all that is done with it. It knows no canvas, tool, panel or command.

pub(crate) mod bulk;
pub(crate) mod document;
pub(crate) mod fields;
pub(crate) mod file_dialogs;
pub(crate) mod files;
pub(crate) mod ghost;
pub(crate) mod history;
pub(crate) mod jobs;
pub(crate) mod labelling;
pub(crate) mod layers;
pub(crate) mod messages;
pub(crate) mod origin;
pub(crate) mod picking;
pub(crate) mod plan_list;
pub(crate) mod predictions;
pub(crate) mod questions;
pub(crate) mod recovery;
pub(crate) mod selection;
pub(crate) mod settings;
pub(crate) mod tracing;
