//! Plans and models on disk: loading, and saving without ever losing what was there.

mod bundled;
mod models;
pub mod pictures;
mod plan_file;
mod save;

pub use bundled::{BUNDLED, bundled_plans};
pub use models::{
    LARGEST_BYTES, MODEL_ENDING, MODELS_VARIABLE, ModelError, StoredModel, bundled_model, bundled_sets,
    bundled_typologies, bundled_unknown, load_model, models_folder, models_in, set_name,
};
pub use plan_file::{load_plan, save_plan};
pub use save::{SaveError, save_bytes, save_bytes_fast};
