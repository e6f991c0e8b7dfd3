//! The five labels, typologies, and label schemes: the tables from functions to labels.

mod about;
mod expectations;
mod label;
mod names;
mod scheme;
pub mod scheme_file;
mod typology;

pub use expectations::{TemporaryRule, UsualArea};
pub use label::Label;
pub use scheme::{Colour, Meaning, SchemeError, Schemes, function_title, normalised_function};
pub use typology::Typology;
