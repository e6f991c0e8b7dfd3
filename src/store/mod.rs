//! Plan files on disk: loading, and saving without ever losing what was there.

mod bundled;
mod plan_file;
mod save;

pub use bundled::{BUNDLED, bundled_plans};
pub use plan_file::{load_plan, save_plan};
pub use save::{SaveError, save_bytes, save_bytes_fast};
