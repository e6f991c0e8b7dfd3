//! Draws the plans that come with Enfilade and writes them to `plans/`, or to the folder given:
//!
//! ```text
//! cargo run --example draw_bundled_plans [FOLDER]
//! ```
//!
//! The drawings themselves are in `drawings/`; a test compares what they give with the files.

mod drawings;

use std::error::Error;
use std::io::Write as _;
use std::path::PathBuf;

use enfilade::store::save_plan;

fn main() -> Result<(), Box<dyn Error>> {
    let bundled = concat!(env!("CARGO_MANIFEST_DIR"), "/plans");
    let folder = std::env::args_os().nth(1).map_or_else(|| PathBuf::from(bundled), PathBuf::from);
    std::fs::create_dir_all(&folder)?;
    for (file, plan) in drawings::all()? {
        let path = folder.join(file);
        save_plan(&path, &plan)?;
        writeln!(
            std::io::stdout(),
            "{}: {} rooms, {} openings",
            path.display(),
            plan.rooms().len(),
            plan.openings().len()
        )?;
    }
    Ok(())
}
