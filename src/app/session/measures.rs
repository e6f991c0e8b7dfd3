//! Charts of the rooms at hand, and how well classifiers tell them: measured in the background.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

use egui::Context;

use super::Session;
use crate::app::session::at_hand::AtHand;
use crate::app::session::file_dialogs::Purpose;
use crate::app::session::jobs::{Kind, Wanted};
use crate::app::session::messages::Severity;
use crate::app::session::origin::file_name;
use crate::base::work::Work;
use crate::chart::Chart;
use crate::chart::rooms::{self, ChartKind};
use crate::classify::{Algorithm, Scores};
use crate::dataset::Statistics;
use crate::dataset::folds::{Grouping, building_of};
use crate::dataset::sets::STANDARD;
use crate::draw::{LabelColours, Palette, Theme, png, svg};
use crate::features::{Features, NeighbourLabels};
use crate::labels::Label;
use crate::store;
use crate::study::paper::PaperFigures;
use crate::study::{Condition, Curve, CurvePoint, Options, StudyError, Validation, learning_curve_telling, validate};

/// The name of the job, by which its progress is found.
const JOB: &str = "measure classifiers";

/// The size of an exported chart, in logical pixels, and physical pixels to each.
const EXPORT_PX: (f64, f64, f64) = (900.0, 540.0, 2.0);

/// Which chart, of which rooms.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct ChartWanted {
    pub kind: ChartKind,
    pub set: String,
    /// Features by their indices: across, and up for a scatter plot.
    pub across: usize,
    pub up: usize,
}

impl ChartWanted {
    /// As the options of a command: 'set=school across=a up=d'.
    pub(crate) fn words(&self) -> String {
        let mut words = vec![format!("set={}", self.set)];
        if matches!(self.kind, ChartKind::Histogram | ChartKind::Scatter) {
            words.push(format!("across={}", Features::NAMES[self.across]));
        }
        if self.kind == ChartKind::Scatter {
            words.push(format!("up={}", Features::NAMES[self.up]));
        }
        words.join(" ")
    }

    /// Reads such options.
    pub(crate) fn read(kind: ChartKind, words: &str, sets: &[String]) -> Result<Self, String> {
        let first = sets.first().cloned().unwrap_or_else(|| STANDARD.to_owned());
        let mut wanted = Self { kind, set: first, across: 0, up: 2 };
        for word in words.split_whitespace() {
            let feature = |name: &str| {
                Features::index(name)
                    .ok_or_else(|| format!("'{name}' is no feature; use one of {}", Features::NAMES.join(", ")))
            };
            match word.split_once('=') {
                Some(("set", set)) if sets.iter().any(|known| known == set) => set.clone_into(&mut wanted.set),
                Some(("set", set)) => return Err(format!("there is no set '{set}'; use one of {}", sets.join(", "))),
                Some(("across", name)) => wanted.across = feature(name)?,
                Some(("up", name)) => wanted.up = feature(name)?,
                _ => return Err(format!("'{word}' is not understood: expected set=, across= or up=")),
            }
        }
        Ok(wanted)
    }
}

/// How well a classifier tells the rooms of a set.
#[derive(Clone, Debug)]
pub(crate) struct Measured {
    pub algorithm: Algorithm,
    /// With folds by building.
    pub scores: Scores,
    /// Rooms learned from, accuracy and deviation.
    pub curve: Vec<[f64; 3]>,
    /// Of each building its rooms, and those that are right.
    pub buildings: Vec<(String, usize, usize)>,
}

/// What was measured, by set.
#[derive(Default)]
pub(crate) struct Measures {
    pub of_sets: BTreeMap<String, Vec<Measured>>,
    pub error: Option<String>,
    running: Option<Running>,
}

/// What is being measured.
struct Running {
    set: String,
    algorithm: Algorithm,
    /// The learning curve so far.
    curve: Arc<Mutex<Vec<[f64; 3]>>>,
    #[expect(dead_code, reason = "kept so that the job goes on")]
    job: Wanted,
}

impl Measures {
    pub(crate) fn is_measuring(&self) -> bool {
        self.running.is_some()
    }

    /// What is being measured.
    pub(crate) fn measuring(&self) -> Option<Algorithm> {
        self.running.as_ref().map(|running| running.algorithm)
    }

    /// The classifier that is being measured on a set and its learning curve so far, once there is something of it.
    fn so_far(&self, set: &str) -> Option<(Algorithm, Vec<[f64; 3]>)> {
        let running = self.running.as_ref().filter(|running| running.set == set)?;
        let curve = running.curve.lock().unwrap_or_else(PoisonError::into_inner).clone();
        (!curve.is_empty()).then_some((running.algorithm, curve))
    }

    /// The rooms are others now.
    pub(super) fn forget(&mut self) {
        *self = Self::default();
    }

    pub(crate) fn cancel(&mut self) {
        self.running = None;
    }
}

/// The paper's shares of the labels in a set, 0..=1.
pub(crate) fn paper_shares(set: &str) -> Option<[f64; 5]> {
    let figures = PaperFigures::bundled()?;
    let of_set = figures.rooms.get(set)?;
    let share = |label: Label| of_set.get(label.letter()).map_or(0.0, |rooms| rooms.share / 100.0);
    Some(Label::ALL.map(share))
}

/// A set's name in the titles of charts: 'schools' is not always right, so the word stands alone.
pub(crate) fn set_words(set: &str) -> String {
    if set == STANDARD { "all rooms".to_owned() } else { format!("{set} rooms") }
}

impl Session {
    /// A chart of the rooms at hand; `None` where there is nothing to show yet.
    pub(crate) fn chart(&self, at_hand: &AtHand, wanted: &ChartWanted) -> Option<Chart> {
        let ChartWanted { kind, set, across, up } = wanted;
        let rows = at_hand.rows_of(set);
        let of = set_words(set);
        let measured = self.measures.of_sets.get(set);
        Some(match kind {
            ChartKind::Balance => {
                let shares = paper_shares(set).map(|shares| ("the paper", shares));
                rooms::balance(&of, &Statistics::of(rows.iter().map(|(_, row)| *row)), shares)
            }
            ChartKind::Histogram => {
                let rows: Vec<_> = rows.into_iter().map(|(_, row)| row).collect();
                rooms::histogram(&of, &rows, *across)
            }
            ChartKind::Scatter => rooms::scatter(&of, &rows, *across, *up),
            ChartKind::LearningCurve => {
                let curve = |of: &Measured| (of.algorithm.learner().short_title().to_owned(), of.curve.clone());
                let so_far = self.measures.so_far(set).map(|(of, curve)| {
                    let name = format!("{} (so far)", of.learner().short_title());
                    (name, curve)
                });
                let measured = measured.map(Vec::as_slice).unwrap_or_default().iter().map(curve);
                let mut chart = rooms::learning_curves(&measured.chain(so_far.clone()).collect::<Vec<_>>());
                // Also of one alone it is said that it goes on.
                chart.has_legend |= so_far.is_some();
                chart
            }
            ChartKind::ByBuilding => rooms::by_building(&measured?.last()?.buildings),
        })
    }

    /// Whether there is something to show of how classifiers tell the rooms of a set.
    pub(crate) fn has_measured(&self, set: &str) -> bool {
        self.measures.of_sets.get(set).is_some_and(|of| !of.is_empty()) || self.measures.so_far(set).is_some()
    }

    /// Asks where a chart goes.
    pub(crate) fn ask_where_to_put_chart(&mut self, path: &Path) {
        let folder = path.parent().map(Path::to_owned).filter(|folder| folder.is_dir());
        self.ask_for_file(Purpose::Chart, folder, file_name(path));
    }

    /// Measures how well an algorithm tells the rooms of a set, in the background.
    pub(crate) fn measure(&mut self, set: &str, algorithm: Algorithm) {
        let Some(at_hand) = self.at_hand.read.clone() else { return };
        let set = set.to_owned();
        let (of_set, curve) = (set.clone(), Arc::new(Mutex::new(Vec::new())));
        let so_far = curve.clone();
        let kind = Kind::new(JOB).newest_of(JOB).if_broken(|session| session.measures.running = None);
        let job = self.jobs.start_wanted(kind, move |work| {
            let work = work.on_threads(work.threads().saturating_sub(1));
            let measured = measured(&at_hand, &set, algorithm, &so_far, &work);
            move |session: &mut Session, _: &Context| {
                session.measures.running = None;
                match measured {
                    Ok(measured) => {
                        let of_set = session.measures.of_sets.entry(set).or_default();
                        of_set.retain(|other| other.algorithm != algorithm);
                        of_set.push(measured);
                        session.measures.error = None;
                    }
                    Err(StudyError::Cancelled) => {}
                    Err(StudyError::Data(what)) => session.measures.error = Some(what),
                }
            }
        });
        self.measures.running = Some(Running { set: of_set, algorithm, curve, job });
    }

    /// The share of measuring that is done, 0..=1.
    pub(crate) fn measure_progress(&self) -> f64 {
        self.jobs.share_of(JOB)
    }

    /// Writes a chart as the file's ending says: PNG, SVG, or its data as CSV.
    ///
    /// # Errors
    /// When there are no rooms yet, or the options or the ending are wrong.
    pub(crate) fn export_chart(&mut self, kind: ChartKind, path: &Path, words: &str) -> Result<(), String> {
        let Some(at_hand) = self.at_hand.read.clone() else {
            return Err("open the dashboard first".to_owned());
        };
        let wanted = ChartWanted::read(kind, words, &at_hand.sets())?;
        let chart = self.chart(&at_hand, &wanted).filter(|chart| !chart.is_empty());
        let Some(chart) = chart else { return Err("there is nothing to draw; measure first".to_owned()) };
        let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase()).unwrap_or_default();
        let (width, height, pixel_ratio) = EXPORT_PX;
        let height = match kind {
            // A line for each building.
            ChartKind::ByBuilding => height.max(90.0 + 18.0 * at_hand.buildings as f64),
            _ => height,
        };
        let layout = chart.layout(width, height.min(3600.0));
        let palette = Palette::of(Theme::Light, LabelColours::Standard);
        let scene = |ratio: f64| chart.scene(palette, &layout, ratio, &Default::default());
        let told = |key: usize| -> Vec<String> {
            at_hand.rows.get(key).map_or_else(Vec::new, |row| {
                vec![row.file.clone(), row.id.clone(), row.building.clone(), row.room.clone(), row.function.clone()]
            })
        };
        let bytes = match ending.as_str() {
            "png" => png::png(&scene(pixel_ratio)).map_err(|error| error.to_string())?,
            "svg" => svg::svg(&scene(1.0)).into_bytes(),
            "csv" => {
                chart.csv(&["file", "id", "building", "room", "function"], &told).map_err(|error| error.to_string())?
            }
            _ => return Err(format!("{}: the ending must be .png, .svg or .csv", file_name(path))),
        };
        let path = path.to_owned();
        self.jobs.start(Kind::new("write a chart").must_end(), move |_| {
            let result = store::save_bytes(&path, &bytes);
            move |session: &mut Session, _: &Context| match result {
                Ok(()) => session.status = format!("Chart written to {}", session.shown_path(&path)),
                Err(error) => session.say(Severity::Error, "The chart was not written", error.to_string()),
            }
        });
        Ok(())
    }
}

/// The part of the progress until every building was left out once; the rest is the learning curve.
pub(crate) const TESTING_SHARE: f64 = 0.5;

/// Folds of the measurement.
const FOLDS: usize = 10;

/// Measures; tells of the learning curve so far.
fn measured(
    at_hand: &AtHand,
    set: &str,
    algorithm: Algorithm,
    so_far: &Mutex<Vec<[f64; 3]>>,
    work: &Work<'_>,
) -> Result<Measured, StudyError> {
    // As a new building is met, with a first guess at the neighbours' labels; a table holds the true ones.
    let modes = at_hand.collection.neighbour_modes();
    let neighbours = if modes.contains(&NeighbourLabels::Temporary) { NeighbourLabels::Temporary } else { modes[0] };
    let options = Options { folds: FOLDS, grouping: Grouping::Building, neighbours, ..Options::default() };
    let condition = Condition { by: Grouping::Building, neighbours };
    let test = |work: &Work<'_>| validate(&at_hand.collection, options, set, &[algorithm], &[condition], work);
    let Validation { cells, notes, predictions: said, .. } = work.within(0.0..TESTING_SHARE, test)?;
    let Some(cell) = cells.into_iter().next() else {
        let why = notes.into_iter().next().unwrap_or_else(|| "there are too few buildings".to_owned());
        return Err(StudyError::Data(why));
    };
    let point = |point: &CurvePoint| [point.training_rooms, point.accuracy, point.deviation];
    let points = |curve: Curve| curve.points.iter().map(point).collect::<Vec<_>>();
    let told = |curve: Curve| *so_far.lock().unwrap_or_else(PoisonError::into_inner) = points(curve);
    let learn = |work: &Work<'_>| learning_curve_telling(&at_hand.collection, options, set, algorithm, &told, work);
    let curve = work.within(TESTING_SHARE..1.0, learn)?.map(points).unwrap_or_default();
    let mut buildings: BTreeMap<String, (usize, usize)> = BTreeMap::new();
    for it in said.iter().filter(|it| it.set == set) {
        let Some(row) = at_hand.rows.get(it.row) else { continue };
        let of = buildings.entry(building_of(row).to_owned()).or_default();
        of.0 += 1;
        of.1 += usize::from(it.said.label() == row.label);
    }
    let buildings = buildings.into_iter().map(|(name, (rooms, right))| (name, rooms, right)).collect();
    Ok(Measured { algorithm, scores: cell.scores, curve, buildings })
}
