//! Plans, models and label schemes on disk: loading, saving without ever losing the previous file, and a
//! journal of unsaved changes.

mod bundled;
mod file_state;
#[cfg(feature = "pictures")]
mod grid_maps;
mod index_file;
mod journal;
mod logs;
mod made;
mod models;
#[cfg(feature = "pictures")]
pub mod pictures;
mod plan_file;
mod plan_folder;
mod save;
mod schemes;
mod stamp;
mod viewer;

pub use bundled::{BUNDLED, bundled_plans};
pub use file_state::FileState;
#[cfg(feature = "pictures")]
pub use grid_maps::{MapFileError, is_map_yaml, load_map, load_picture_as_map};
pub use index_file::{CACHE_VARIABLE, IndexError, IndexFile, cache_folder};
pub use journal::{
    Draft, Journal, JournalFailure, JournalStart, Leftover, Predecessor, Recovered, STATE_VARIABLE, journal_folder,
    leftovers, read_journal,
};
pub use logs::{LoadedLog, load_log, read_log};
pub use made::MadeFiles;
pub use models::{
    LARGEST_BYTES, MODEL_ENDING, MODELS_VARIABLE, ModelError, default_models, load_model, models_folder, models_in,
    set_default_model,
};
pub use plan_file::{checked_bytes, load_plan, save_plan};
pub use plan_folder::{FoundPlan, plans_below};
pub use save::{SaveError, save_bytes, save_bytes_fast};
pub use schemes::{SCHEME_ENDING, SCHEMES_VARIABLE, SchemeFileError, schemes_folder, schemes_in, with_scheme_file};
pub use stamp::{Stamp, content_of};
pub use viewer::{print_folder, show_in_viewer};
