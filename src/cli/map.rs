use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::builder::PossibleValuesParser;

use super::classify::PredictorOptions;
use super::explore::rooms_scene;
use super::inputs::from_stdin;
use super::outputs::{Outputs, must_be_folder};
use super::progress::with_progress;
use super::{CliError, Outcome, Subcommand, Terminal};
use crate::base::wording::count;
use crate::draw::line_map::LineMapDrawing;
use crate::draw::{Theme, png, svg};
use crate::geometry::{Point, trim_m};
use crate::plan::{Meta, Scale, ScaleOrigin};
use crate::predict::explored::labelled;
use crate::robot::carmen::Log;
use crate::robot::log_map::{MappedLog, map_log, surroundings};
use crate::robot::{LineMap, MapperOptions, Pose};
use crate::store::{checked_bytes, load_log};

/// `enfilade map`: a robot's laser log to a line map and a plan.
#[derive(clap::Args)]
pub struct MapCommand {
    /// A CARMEN log, .log or .log.gz
    #[arg(value_name = "LOG")]
    log: PathBuf,
    /// The folder to write to
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Do not recognise places seen before; the path drifts
    #[arg(long)]
    no_loop_closing: bool,
    #[command(flatten)]
    predictor: PredictorOptions,
    /// Dark on light, or light on dark
    #[arg(long, value_name = "THEME", default_value = "light",
          value_parser = PossibleValuesParser::new(Theme::ALL.map(Theme::name)))]
    theme: String,
}

impl Subcommand for MapCommand {
    const NAME: &'static str = "map";
    const ABOUT: &'static str = "Build a line map from a robot's laser log, and find its rooms";
    const EXAMPLE: &'static str = "enfilade map intel.log.gz -o intel   # map, plan, pictures, poses.csv";

    fn run(self, terminal: &mut Terminal) -> Result<Outcome, CliError> {
        must_be_folder(&self.output)?;
        let mut outputs = Outputs::new(terminal);
        let loaded = load_log(&from_stdin(&self.log))?;
        for note in &loaded.log.notes {
            terminal.remark(format!("{}: {note}", self.log.display()))?;
        }
        if let Some(broken_off) = &loaded.broken_off {
            terminal.remark(format!("{}: {broken_off}; read up to there", self.log.display()))?;
        }
        let log = loaded.log;
        if !log.has_odometry {
            terminal.remark(format!(
                "{}: the odometry never moves; scans are matched with one another only",
                self.log.display()
            ))?;
        }
        let options = MapperOptions { closes_loops: !self.no_loop_closing, ..MapperOptions::default() };
        let (predictor, models) = self.predictor.read(terminal)?;
        let mapped = with_progress("mapping", Some(1), terminal, |work| map_log(&log, &options, work))?;

        let name = log_name(&self.log);
        outputs.folder(&self.output)?;
        let mut write = |name: &str, bytes: &[u8]| outputs.save_in(&self.output, name, bytes, terminal);
        write("poses.csv", poses_csv(&log, &mapped).as_bytes())?;
        write(&format!("{name}.lines.json"), lines_json(&mapped.map, &options).as_bytes())?;
        let path: Vec<Point> = mapped.poses.iter().map(|pose| pose.position()).collect();
        let seen = surroundings(&log, &mapped);
        let segments = &seen.segments;
        // The parser only accepts names of the table.
        let theme = Theme::ALL.into_iter().find(|theme| theme.name() == self.theme).unwrap_or_default();
        let drawing = LineMapDrawing { segments, free: seen.free.shapes(), path: &path };
        let scene = drawing.page(theme, PICTURE_SIDE_PX, &name);
        write(&format!("{name}.map.png"), &png::png(&scene)?)?;
        write(&format!("{name}.map.svg"), svg::svg(&scene).as_bytes())?;

        // A log may be anything: where its rooms make no plan, the map is there all the same.
        match labelled(&seen.found, &seen.frontiers, Pose::IDENTITY, meta(&name), &predictor, &models) {
            Ok(made) => {
                let plan = made.explored.plan;
                let plan_name = format!("{name}.plan.json");
                write(&plan_name, &checked_bytes(&self.output.join(&plan_name), &plan)?)?;
                let scene = rooms_scene(&plan, theme, PICTURE_SIDE_PX);
                write(&format!("{name}.rooms.png"), &png::png(&scene)?)?;
            }
            Err(error) => terminal.remark(format!("{}: no plan: {error}", self.log.display()))?,
        }

        let scans = log.readings.iter().filter(|reading| !reading.scans.is_empty()).count();
        let (closures, doubted) = mapped.closures;
        let metres: f64 = segments.iter().map(|segment| segment.length()).sum();
        let doubted = if doubted > 0 { format!(", {doubted} of them rejected") } else { String::new() };
        terminal.report(format!(
            "{}: {scans} scans, {} lines of {metres:.0} m, {closures} places recognised{doubted}, {}, {}",
            self.output.display(),
            segments.len(),
            count(seen.found.rooms.len(), "room"),
            count(seen.found.doorways.len(), "doorway"),
        ))?;
        Ok(Outcome::Done)
    }
}

/// The longer side of the picture, in pixels.
const PICTURE_SIDE_PX: f64 = 2000.0;

/// The metadata of a log's plan.
fn meta(name: &str) -> Meta {
    let note = "measured by a robot's laser scanner".to_owned();
    let scale = Scale { origin: ScaleOrigin::Measured, note, ..Scale::default() };
    Meta { name: name.to_owned(), scale, source: format!("{name}.log"), ..Meta::default() }
}

/// A log's name without its extensions.
fn log_name(path: &Path) -> String {
    let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let stem = name.strip_suffix(".gz").unwrap_or(&name);
    let stem = stem.strip_suffix(".log").unwrap_or(stem);
    if stem.is_empty() || stem == "-" { "map".to_owned() } else { stem.to_owned() }
}

/// `t,x,y,theta` of every reading, in seconds, metres and radians.
fn poses_csv(log: &Log, mapped: &MappedLog) -> String {
    let mut csv = String::from("t,x,y,theta\n");
    for (reading, pose) in log.readings.iter().zip(&mapped.poses) {
        // Angles to a hundredth of a milliradian: half a millimetre at 50 m. `+ 0.0` drops the sign of
        // zero.
        let heading = (pose.heading_rad * 1e5).round() / 1e5 + 0.0;
        let _ = writeln!(csv, "{},{},{},{heading}", reading.time_s, trim_m(pose.x_m), trim_m(pose.y_m));
    }
    csv
}

/// The lines, one per row, each with its standard deviations.
fn lines_json(map: &LineMap, options: &MapperOptions) -> String {
    let mut json = String::from(
        "{\"enfilade_line_map\":1,\"frame\":\"the first scan's robot: x ahead, y to the left; metres and radians; \
         seen from the left of the way from start to end\",\"lines\":[",
    );
    for (index, line) in map.lines().enumerate() {
        let (start, end) = (line.line.start.trimmed(), line.line.end.trimmed());
        let covariance = line.line.covariance(options.fusion.sigma_m);
        let deviation = |variance: f64| (variance.sqrt() * 1e6).round() / 1e6;
        let _ = write!(
            json,
            "{}\n{{\"start\":[{},{}],\"end\":[{},{}],\"sightings\":{},\"offset_deviation_m\":{},\"angle_deviation_rad\":{}}}",
            if index == 0 { "" } else { "," },
            start.x,
            start.y,
            end.x,
            end.y,
            line.sightings,
            deviation(covariance[(0, 0)]),
            deviation(covariance[(1, 1)])
        );
    }
    json.push_str("\n]}\n");
    json
}
