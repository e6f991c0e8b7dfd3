//! `enfilade` without a subcommand: opens the window or, if there is no display, does the same job
//! headless.

use std::collections::BTreeSet;
use std::io::Write as _;
use std::path::{Path, PathBuf};

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

/// Opens the window on some plans; without a display, runs the headless job on them or, if there are none, on the bundled ones.
pub fn open(plans: &[PathBuf], demo: bool, terminal: &mut Terminal) -> Result<Outcome, CliError> {
    if let Some(plan) = plans.iter().find(|plan| !plan.exists()) {
        return Err(CliError::new(format!("{}: no such file or folder; check the path", plan.display())));
    }
    let why = match window(plans, demo) {
        None => return Ok(Outcome::Done),
        Some(why) => why,
    };
    if demo {
        return Err(CliError::new(format!("{why}: the demonstration needs a window")));
    }
    writeln!(terminal.err, "{why}: doing the same work without a window, in ./{OUTPUT}")?;
    headless(plans, terminal)
}

#[cfg(feature = "gui")]
fn window(plans: &[PathBuf], demo: bool) -> Option<String> {
    let options = crate::app::WindowOptions { plans: plans.to_vec(), demo };
    crate::app::run_window(options).err().map(|error| error.to_string())
}

#[cfg(not(feature = "gui"))]
fn window(_plans: &[PathBuf], _demo: bool) -> Option<String> {
    Some("this build has no window (cargo feature 'gui')".to_owned())
}

/// Reads the plans, and writes pictures of each, and the features of all as a dataset.
fn headless(files: &[PathBuf], terminal: &mut Terminal) -> Result<Outcome, CliError> {
    let mut plans: Vec<(String, Plan)> = Vec::new();
    for path in files {
        let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        let stem = formats::file_stem(&name).to_owned();
        let import = formats::read_file(path)?;
        for note in &import.notes {
            writeln!(terminal.err, "{}: {note}", path.display())?;
        }
        let several = import.plans.len() > 1;
        let name = |storey: usize| if several { format!("{stem}-{}", storey + 1) } else { stem.clone() };
        plans.extend(import.plans.into_iter().enumerate().map(|(storey, plan)| (name(storey), plan)));
    }
    if files.is_empty() {
        plans = bundled_plans()?.into_iter().map(|(name, plan)| (formats::file_stem(name).to_owned(), plan)).collect();
    }
    tell_apart(&mut plans);
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

/// Numbers the names that stand more than once: two files of one name, in two folders, must not overwrite each other.
fn tell_apart(plans: &mut [(String, Plan)]) {
    let mut taken = BTreeSet::new();
    for (name, _) in plans {
        let number = (2..).find(|number| !taken.contains(&format!("{name} {number}"))).unwrap_or(2);
        if taken.contains(name.as_str()) {
            *name = format!("{name} {number}");
        }
        taken.insert(name.clone());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plans_of_one_name_are_told_apart() {
        let mut plans: Vec<_> = ["a", "a", "a 2", "b", "a"].map(|name| (name.to_owned(), Plan::default())).into();
        tell_apart(&mut plans);
        let names: Vec<&str> = plans.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, ["a", "a 2", "a 2 2", "b", "a 3"]);
    }
}
