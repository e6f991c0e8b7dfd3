//! `enfilade` without a subcommand: opens the window or, if there is no display, does the same job
//! headless.

use std::io::Write as _;
use std::path::Path;

use super::outputs::{Care, Outputs};
use super::{CliError, Outcome, Terminal};
use crate::dataset::{self, LeftOut, Row, Statistics};
use crate::draw::sheet::{self, Furniture, PageSize};
use crate::draw::{Style, png, svg};
use crate::features::NeighbourLabels;
use crate::formats;
use crate::pipeline::Pipeline;
use crate::plan::Plan;
use crate::store::bundled_plans;

/// The headless job's output folder, in the current folder.
const OUTPUT: &str = "enfilade-out";

/// The longer side of the headless job's pictures in pixels.
const PICTURE_PX: f64 = 1600.0;

/// Opens the window on a plan, or on a bundled one; without a display, runs the headless job.
pub fn open(plan: Option<&Path>, demo: bool, terminal: &mut Terminal) -> Result<Outcome, CliError> {
    if let Some(plan) = plan
        && !plan.exists()
    {
        return Err(CliError::new(format!("{}: no such file or folder; check the path", plan.display())));
    }
    let why = match window(plan, demo) {
        None => return Ok(Outcome::Done),
        Some(why) => why,
    };
    if demo {
        return Err(CliError::new(format!("{why}: the demonstration needs a window")));
    }
    writeln!(terminal.err, "{why}: doing the same work without a window, in ./{OUTPUT}")?;
    headless(plan, terminal)
}

#[cfg(feature = "gui")]
fn window(plan: Option<&Path>, demo: bool) -> Option<String> {
    let options = crate::app::WindowOptions { plan: plan.map(Path::to_owned), demo };
    crate::app::run_window(options).err().map(|error| error.to_string())
}

#[cfg(not(feature = "gui"))]
fn window(_plan: Option<&Path>, _demo: bool) -> Option<String> {
    Some("this build has no window (cargo feature 'gui')".to_owned())
}

/// Reads the plans, and writes pictures of each, and the features of all as a dataset.
fn headless(plan: Option<&Path>, terminal: &mut Terminal) -> Result<Outcome, CliError> {
    let plans: Vec<(String, Plan)> = match plan {
        Some(path) => {
            let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
            let stem = formats::file_stem(&name).to_owned();
            let import = formats::read_file(path)?;
            for note in &import.notes {
                writeln!(terminal.err, "{}: {note}", path.display())?;
            }
            let several = import.plans.len() > 1;
            let name = |storey: usize| if several { format!("{stem}-{}", storey + 1) } else { stem.clone() };
            import.plans.into_iter().enumerate().map(|(storey, plan)| (name(storey), plan)).collect()
        }
        None => bundled_plans()?.into_iter().map(|(name, plan)| (formats::file_stem(name).to_owned(), plan)).collect(),
    };
    let folder = Path::new(OUTPUT);
    let mut outputs = Outputs::new(terminal);
    outputs.folder(folder)?;
    let schemes = super::inputs::schemes(&[])?;
    let mut rows: Vec<Row> = Vec::new();
    let mut left_out = LeftOut::default();
    for (name, plan) in &plans {
        let style = Style::default();
        let furniture = Furniture { title: true, legend: true, scale: true };
        let scene =
            sheet::page(&Pipeline::new(plan, &schemes).drawing(None), &style, PageSize::Longest(PICTURE_PX), furniture);
        outputs.save(&folder.join(format!("{name}.png")), &png::png(&scene)?, Care::Fast, terminal)?;
        outputs.save(&folder.join(format!("{name}.svg")), svg::svg(&scene).as_bytes(), Care::Fast, terminal)?;
        let (rooms, openings) = (plan.rooms().len(), plan.openings().len());
        writeln!(terminal.out, "{OUTPUT}/{name}.png, .svg: {rooms} rooms, {openings} openings")?;
        rows.extend(dataset::rows(plan, &schemes, NeighbourLabels::True, &mut left_out));
    }
    let mut table = Vec::new();
    dataset::csv::write(&mut table, &rows)?;
    outputs.save(&folder.join("rooms.csv"), &table, Care::Fast, terminal)?;
    writeln!(terminal.out, "{OUTPUT}/rooms.csv: F_r and label of {} rooms", rows.len())?;
    super::collect::report_left_out(&left_out, terminal)?;
    writeln!(terminal.out, "\n{}", Statistics::of(&rows).table("All rooms").trim_end())?;
    Ok(Outcome::Done)
}
