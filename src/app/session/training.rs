//! Training in the background: its progress, its report, and what becomes of the models.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::ThreadId;

use egui::Context;

use super::Session;
use crate::app::session::at_hand::{AtHand, Source};
use crate::app::session::jobs::{Kind, Wanted};
use crate::app::session::messages::Severity;
use crate::base::file_name::component;
use crate::base::wording::count;
use crate::base::work::{Round, Work};
use crate::classify::models::StoredModel;
use crate::classify::{Method, Scores};
use crate::dataset::folds::Grouping;
use crate::dataset::sets::STANDARD;
use crate::features::NeighbourLabels;
use crate::store::{self, MODEL_ENDING};
use crate::study::FoldTold;
use crate::training::{self, Made, Order, TrainError, Watcher};

/// The name of the job.
const JOB: &str = "train models";

/// What the progress of the whole job counts.
const PARTS: usize = 1000;

/// What is to be trained, as the form says it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Wish {
    /// `None` for all of them and their blend.
    pub method: Option<Method>,
    /// A typology, or [`STANDARD`]; `None` for each, and all together.
    pub set: Option<String>,
    pub folds: usize,
    pub groupings: Vec<Grouping>,
    pub neighbours: Option<NeighbourLabels>,
}

impl Default for Wish {
    fn default() -> Self {
        let method = Some(Method::Each(crate::classify::Algorithm::ALL[1]));
        Self { method, set: None, folds: 10, groupings: vec![Grouping::Building], neighbours: None }
    }
}

impl Wish {
    /// As the options of a command: 'algorithm=tree typology=school by=building folds=10 neighbours=predicted'.
    pub(crate) fn words(&self) -> String {
        let by = match self.groupings.as_slice() {
            [one] => one.name(),
            _ => "both",
        };
        let mut words = vec![format!("algorithm={}", self.method.map_or("all", Method::name))];
        // A typology's name may hold blanks, which separate options.
        words.extend(self.set.as_ref().map(|set| format!("typology={}", set.replace(' ', "_"))));
        words.push(format!("by={by}"));
        words.push(format!("folds={}", self.folds));
        words.extend(self.neighbours.map(|neighbours| format!("neighbours={}", neighbours.name())));
        words.join(" ")
    }

    /// Reads such options.
    pub(crate) fn read(words: &str) -> Result<Self, String> {
        let mut wish = Self::default();
        for word in words.split_whitespace() {
            match word.split_once('=') {
                Some(("algorithm", "all")) => wish.method = None,
                Some(("algorithm", name)) => {
                    wish.method =
                        Some(name.parse().map_err(|error: crate::classify::UnknownAlgorithm| error.to_string())?);
                }
                Some(("typology", name)) => wish.set = Some(name.replace('_', " ")),
                Some(("by", "both")) => wish.groupings = Grouping::ALL.to_vec(),
                Some(("by", name)) => {
                    let by = Grouping::ALL.into_iter().find(|by| by.name() == name);
                    wish.groupings = vec![by.ok_or("folds are by=room, by=building or by=both")?];
                }
                Some(("folds", number)) => {
                    let folds = number.parse().ok().filter(|folds| *folds != 1 && *folds <= 100);
                    wish.folds = folds.ok_or("folds=N takes a number from 2 to 100, or 0 for no validation")?;
                }
                Some(("neighbours", name)) => {
                    let mode = NeighbourLabels::ALL.into_iter().find(|mode| mode.name() == name);
                    wish.neighbours = Some(mode.ok_or("neighbours are true, temporary or predicted")?);
                }
                _ => {
                    return Err(format!(
                        "'{word}' is not understood: expected algorithm=, typology=, by=, folds= or neighbours="
                    ));
                }
            }
        }
        Ok(wish)
    }
}

/// How far a training is.
#[derive(Clone, Debug, Default)]
pub(crate) struct Live {
    /// What is being done: 'testing on school plans'.
    pub step: String,
    /// The number of this step from 1, and of all.
    pub step_number: usize,
    pub steps: usize,
    /// Parts of this step that are done, and all.
    pub done: usize,
    pub count: usize,
    /// The set that is validated, or was last.
    pub set: String,
    /// Its folds.
    pub fold_count: usize,
    /// The accuracy of each of its folds so far, by classifier.
    pub folds: Vec<(String, Vec<f64>)>,
    /// The rounds so far of a net that is learning, or learned last.
    pub rounds: Vec<Round>,
    /// Where that net learns: others may beside it.
    learns_on: Option<ThreadId>,
}

impl Live {
    /// The share that is done, 0..=1.
    pub(crate) fn share(&self) -> f64 {
        let of_step = if self.count > 0 { self.done as f64 / self.count as f64 } else { 0.0 };
        let before = self.step_number.saturating_sub(1) as f64;
        ((before + of_step) / self.steps.max(1) as f64).clamp(0.0, 1.0)
    }

    /// Takes in a round. Of nets that learn beside each other one is followed.
    fn hear(&mut self, round: Round) {
        let here = std::thread::current().id();
        if *self.learns_on.get_or_insert(here) != here {
            return;
        }
        if round.round == 0 {
            self.rounds.clear();
        }
        self.rounds.push(round);
    }
}

/// A model that was trained, with what became of the one before.
#[derive(Clone)]
pub(crate) struct Report {
    pub set: String,
    pub method: Method,
    pub scores: Vec<(Grouping, Scores)>,
    pub bytes: Arc<Vec<u8>>,
    pub model: Arc<StoredModel>,
    /// How the one trained before did, or else the one at hand: its name, and its scores.
    pub before: Option<Before>,
}

/// What a new model is compared with.
#[derive(Clone)]
pub(crate) struct Before {
    pub name: String,
    /// Accuracy and log loss, by what the folds did not split.
    pub figures: Vec<(String, f64, f64)>,
    /// All its scores, where it was trained here.
    pub scores: Vec<(Grouping, Scores)>,
}

/// The training, and what was trained last.
#[derive(Default)]
pub(crate) struct Training {
    job: Option<Wanted>,
    live: Arc<Mutex<Live>>,
    /// What is to be trained once its rooms are read.
    waiting: Option<(Source, Wish)>,
    pub reports: Vec<Report>,
    /// The reports of earlier trainings, by set and method: the latest.
    earlier: BTreeMap<(String, String), Report>,
    pub remarks: Vec<String>,
    pub error: Option<String>,
    /// What was trained on, in words, and the name offered for models.
    pub of: String,
    /// The names under which models of the last training are at hand, by their place among the reports.
    pub names: Vec<String>,
}

impl Training {
    pub(crate) fn is_running(&self) -> bool {
        self.job.is_some()
    }

    pub(crate) fn live(&self) -> Live {
        self.live.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

/// Tells the window how far it is.
struct Teller<'a> {
    live: Arc<Mutex<Live>>,
    work: Work<'a>,
    made: Vec<Made>,
    remarks: Vec<String>,
}

fn with(live: &Mutex<Live>, change: impl FnOnce(&mut Live)) {
    change(&mut live.lock().unwrap_or_else(PoisonError::into_inner));
}

impl Watcher for Teller<'_> {
    type Error = TrainError;

    fn step<T>(&mut self, what: &str, step: impl FnOnce(&Work<'_>) -> T) -> T {
        with(&self.live, |live| {
            what.clone_into(&mut live.step);
            live.step_number += 1;
            live.steps = live.steps.max(live.step_number);
            (live.done, live.count, live.learns_on) = (0, 0, None);
        });
        let (live, whole) = (&self.live, &self.work);
        let progress = |done: usize, count: usize| {
            let mut share = 0.0;
            with(live, |live| {
                (live.done, live.count) = (if live.count == count { live.done.max(done) } else { done }, count);
                share = live.share();
            });
            whole.tell((share * PARTS as f64) as usize, PARTS);
        };
        let rounds = |round: Round| with(live, |live| live.hear(round));
        step(&self.work.telling(&progress).hearing(&rounds))
    }

    fn remark(&mut self, what: &str) -> Result<(), TrainError> {
        self.remarks.push(what.to_owned());
        Ok(())
    }

    fn made(&mut self, model: Made) -> Result<(), TrainError> {
        self.made.push(model);
        self.work.goes_on().map_err(Into::into)
    }

    fn folds(&self, set: &str) -> Arc<dyn Fn(FoldTold) + Send + Sync> {
        let live = self.live.clone();
        with(&live, |live| {
            set.clone_into(&mut live.set);
            live.folds.clear();
        });
        Arc::new(move |told: FoldTold| {
            let title = match told.method {
                Method::Each(algorithm) => algorithm.learner().short_title(),
                whole => whole.title(),
            };
            let name = format!("{title}, by {}", told.condition.by.name());
            with(&live, |live| match live.folds.iter_mut().find(|(of, _)| *of == name) {
                Some((_, folds)) => folds.push(told.score.accuracy()),
                None => live.folds.push((name, vec![told.score.accuracy()])),
            });
        })
    }
}

impl Session {
    /// Trains models on the rooms of a source, in the background.
    ///
    /// # Errors
    /// When a training is running.
    pub(crate) fn train(&mut self, source: Source, wish: Wish) -> Result<(), String> {
        if self.training.is_running() {
            return Err("models are being trained already".to_owned());
        }
        if wish.method == Some(Method::Blend) {
            return Err("a blend is made of other models; train all of them".to_owned());
        }
        let at_hand = self.at_hand.read.clone().filter(|at_hand| at_hand.source == source);
        let Some(at_hand) = at_hand else {
            return Err("the rooms are still being read; wait a moment".to_owned());
        };
        let of = self.source_title(&source);
        let path = match &source {
            Source::Folder(path) | Source::Table(path) => self.shown_path(path),
            Source::OpenPlans => String::new(),
        };
        let live = Arc::new(Mutex::new(Live::default()));
        for report in std::mem::take(&mut self.training.reports) {
            self.training.earlier.insert((report.set.clone(), report.method.name().to_owned()), report);
        }
        (self.training.error, self.training.remarks, self.training.names) = (None, Vec::new(), Vec::new());
        (self.training.live, self.training.of) = (live.clone(), of);
        let kind = Kind::new(JOB).if_broken(|session| {
            session.training.job = None;
            session.training.error = Some("something went wrong inside Enfilade".to_owned());
        });
        let job = self.jobs.start_wanted(kind, move |work| {
            // One processor is left to the window.
            let work = work.on_threads(work.threads().saturating_sub(1));
            let mut teller = Teller { live, work, made: Vec::new(), remarks: Vec::new() };
            let result = run(&at_hand, &wish, &path, &mut teller);
            let Teller { made, remarks, .. } = teller;
            move |session: &mut Session, _: &Context| {
                session.training.job = None;
                session.training.remarks = remarks;
                match result {
                    Ok(()) => session.was_trained(made),
                    Err(TrainError::Cancelled) => {}
                    Err(TrainError::Data(what)) => session.training.error = Some(what),
                }
            }
        });
        self.training.job = Some(job);
        Ok(())
    }

    /// Trains as soon as the rooms of the source are read.
    ///
    /// # Errors
    /// As [`Self::train`].
    pub(crate) fn train_when_read(&mut self, source: Source, wish: Wish) -> Result<(), String> {
        if self.at_hand.is_reading() && !self.training.is_running() {
            self.training.waiting = Some((source, wish));
            return Ok(());
        }
        self.train(source, wish)
    }

    /// Goes on with a training that waited for its rooms.
    pub(super) fn train_what_waits(&mut self) {
        let Some((source, wish)) = self.training.waiting.take() else { return };
        if let Err(error) = self.train(source, wish) {
            // The form says it, not the report of an earlier training.
            self.train_again();
            self.training.error = Some(self.at_hand.error.clone().unwrap_or(error));
        }
    }

    /// Gives up the training; nothing of it is kept.
    pub(crate) fn cancel_training(&mut self) {
        if self.training.job.take().is_some() {
            self.status = "The training was cancelled".to_owned();
        }
    }

    /// Forgets the last report, to train anew; it stays what the next is compared with.
    pub(crate) fn train_again(&mut self) {
        for report in std::mem::take(&mut self.training.reports) {
            self.training.earlier.insert((report.set.clone(), report.method.name().to_owned()), report);
        }
        self.training.error = None;
    }

    fn was_trained(&mut self, made: Vec<Made>) {
        let reports: Vec<Report> = made
            .into_iter()
            .map(|made| {
                let before = self.before(&made);
                let Made { set, method, bytes, scores, model } = made;
                Report { set, method, scores, bytes: Arc::new(bytes), model, before }
            })
            .collect();
        self.status = format!("{} trained", count(reports.len(), "model"));
        self.training.names = reports.iter().map(|report| report.model.name.clone()).collect();
        self.training.reports = reports;
        let base = self.offered_model_name();
        self.name_trained(&base);
    }

    /// What a model is compared with: the one trained before, or else the one at hand of its set and method.
    fn before(&self, made: &Made) -> Option<Before> {
        if let Some(earlier) = self.training.earlier.get(&(made.set.clone(), made.method.name().to_owned())) {
            let figure = |(by, scores): &(Grouping, Scores)| (by.name().to_owned(), scores.accuracy, scores.log_loss);
            let figures = earlier.scores.iter().map(figure).collect();
            return Some(Before { name: "the training before".to_owned(), figures, scores: earlier.scores.clone() });
        }
        let model = self.models.find(&made.set, made.method).ok()?;
        let figures: Vec<(String, f64, f64)> =
            model.about.scores.iter().map(|of| (of.folds_by.clone(), of.accuracy, of.log_loss)).collect();
        let whose = if model.path.is_some() {
            format!("your model {}", model.name)
        } else {
            format!("the bundled {}", model.name)
        };
        Some(Before { name: whose, figures, scores: Vec::new() })
    }

    /// A name for the models trained last: after their data.
    pub(crate) fn offered_model_name(&self) -> String {
        let of = &self.training.of;
        let last = of.trim_end_matches(['/', '\\']).rsplit(['/', '\\']).next().unwrap_or(of);
        let last = last.trim_end_matches(".csv");
        let plain: String = last.chars().map(|c| if c.is_alphanumeric() { c } else { '-' }).collect();
        let plain = plain.trim_matches('-').to_lowercase();
        let plain = if plain.is_empty() { "my".to_owned() } else { plain };
        match self.training.reports.as_slice() {
            [one] if one.set == STANDARD || plain.contains(&one.set) => format!("{plain}-{}", one.method.name()),
            [one] => format!("{plain}-{}-{}", one.set, one.method.name()),
            _ => plain,
        }
    }

    /// Makes the models trained last available under names: one model under the name itself, several under it with their
    /// set and method.
    pub(crate) fn name_trained(&mut self, base: &str) {
        let names = self.names_of_trained(base);
        let own: Vec<StoredModel> = self
            .models
            .own()
            .iter()
            .filter(|model| model.path.is_some() || !self.training.names.contains(&model.name))
            .map(|model| (**model).clone())
            .collect();
        let trained = self.training.reports.iter().zip(&names).map(|(report, name)| StoredModel {
            name: name.clone(),
            path: None,
            ..(*report.model).clone()
        });
        let own: Vec<StoredModel> = own.into_iter().chain(trained).collect();
        let defaults = self.models.defaults().clone();
        self.models = crate::classify::models::Models::bundled().with(own).with_defaults(defaults);
        self.training.names = names;
        self.predict_anew();
    }

    /// The names of the models trained last, by a name for all.
    pub(crate) fn names_of_trained(&self, base: &str) -> Vec<String> {
        match self.training.reports.as_slice() {
            [_] => vec![base.to_owned()],
            several => several.iter().map(|it| format!("{base}-{}-{}", it.set, it.method.name())).collect(),
        }
    }

    /// The folder where models are kept unless told otherwise.
    pub(crate) fn kept_models_folder(&self) -> Option<PathBuf> {
        // A script's models stay in its own folder.
        self.named_from.as_ref().map(|folder| folder.join("models")).or_else(store::models_folder)
    }

    /// Keeps the models trained last in a folder, under a name; and, if wanted, as the defaults of what they learned from.
    ///
    /// # Errors
    /// When the name cannot be a file's.
    pub(crate) fn keep_trained(&mut self, base: &str, folder: &Path, as_default: bool) -> Result<(), String> {
        if self.training.reports.is_empty() {
            return Err("train a model first".to_owned());
        }
        component(base).map_err(|error| format!("the name cannot be a file's: {error}"))?;
        self.name_trained(base);
        let files: Vec<(PathBuf, Arc<Vec<u8>>)> = self
            .training
            .reports
            .iter()
            .zip(&self.training.names)
            .map(|(report, name)| (folder.join(format!("{name}{MODEL_ENDING}")), report.bytes.clone()))
            .collect();
        // A blend names its parts, which are looked for beside it.
        let has_blend = self.training.reports.iter().any(|report| report.method == Method::Blend);
        let parts: Vec<(PathBuf, Arc<Vec<u8>>)> = self
            .training
            .reports
            .iter()
            .filter(|report| has_blend && report.method != Method::Blend)
            .map(|report| {
                let name = format!("{}-{}{MODEL_ENDING}", report.set, report.method.name());
                (folder.join(name), report.bytes.clone())
            })
            .collect();
        let chosen = self.chosen_defaults();
        let folder = folder.to_owned();
        self.jobs.start(Kind::new("keep models").must_end(), move |_| {
            let keep = || -> Result<Vec<StoredModel>, String> {
                std::fs::create_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
                for (path, bytes) in parts.iter().chain(&files) {
                    store::save_bytes(path, bytes).map_err(|error| error.to_string())?;
                }
                if as_default {
                    for (set, name) in &chosen {
                        store::set_default_model(&folder, set, Some(name)).map_err(|error| error.to_string())?;
                    }
                }
                let load =
                    |(path, _): &(PathBuf, Arc<Vec<u8>>)| store::load_model(path).map_err(|error| error.to_string());
                parts.iter().chain(&files).map(load).collect()
            };
            let kept = keep();
            move |session: &mut Session, _: &Context| match kept {
                Err(error) => session.say(Severity::Error, "The models were not kept", error),
                Ok(kept) => {
                    let text = format!("{} kept in {}", count(files.len(), "model"), session.shown_path(&folder));
                    let detail = if as_default { defaults_told(&chosen) } else { String::new() };
                    session.models = session.models.with(kept);
                    if as_default {
                        let mut defaults = session.models.defaults().clone();
                        defaults.extend(chosen);
                        session.models = session.models.with_defaults(defaults);
                    }
                    session.status.clone_from(&text);
                    session.say(Severity::Info, text, detail);
                    session.predict_anew();
                }
            }
        });
        Ok(())
    }

    /// For each set the model that would be its default: the blend, or else the most accurate.
    pub(crate) fn chosen_defaults(&self) -> Vec<(String, String)> {
        let mut best: BTreeMap<&str, (f64, &str)> = BTreeMap::new();
        for (report, name) in self.training.reports.iter().zip(&self.training.names) {
            let of_scores = report.scores.iter().map(|(_, scores)| scores.accuracy).fold(0.0, f64::max);
            let worth = if report.method == Method::Blend { 2.0 } else { of_scores };
            let entry = best.entry(report.set.as_str()).or_insert((worth, name));
            if worth > entry.0 {
                *entry = (worth, name);
            }
        }
        best.into_iter().map(|(set, (_, name))| (set.to_owned(), name.to_owned())).collect()
    }

    /// Predicts all open plans anew: models or label schemes have changed.
    pub(crate) fn predict_anew(&mut self) {
        for document in self.documents_mut() {
            document.forget_derived();
        }
    }
}

fn defaults_told(chosen: &[(String, String)]) -> String {
    let told: Vec<String> = chosen
        .iter()
        .map(|(set, name)| {
            let of = if set == STANDARD { "other plans" } else { set };
            format!("{name} predicts {of} from now on")
        })
        .collect();
    told.join("\n")
}

/// Trains.
fn run(at_hand: &AtHand, wish: &Wish, path: &str, teller: &mut Teller<'_>) -> Result<(), TrainError> {
    let collection = &at_hand.collection;
    if at_hand.rows.is_empty() {
        return Err(TrainError::Data(
            "there are no labelled rooms to learn from; label some rooms, or add plans".to_owned(),
        ));
    }
    let parts = training::parts(collection, wish.set.as_deref())?;
    let methods = training::methods(collection, wish.method)?;
    let each = methods.iter().filter(|method| matches!(method, Method::Each(_))).count();
    let validations = usize::from(each > 0) + usize::from(methods.contains(&Method::Joint));
    // A blend has a committee of its own.
    let committees = usize::from(wish.method.is_none() && !collection.networks().is_empty());
    let steps = parts.len() * (methods.len() + committees + if wish.folds > 0 { validations } else { 0 });
    with(&teller.live, |live| (live.steps, live.fold_count) = (steps, wish.folds));
    let order = Order {
        method: wish.method,
        typology: wish.set.clone(),
        neighbours: wish.neighbours,
        folds: wish.folds,
        groupings: wish.groupings.clone(),
        given: None,
        seed: 1,
        licence: String::new(),
        call: format!("enfilade train {path}").trim_end().to_owned(),
        folds_word: wish.folds.to_string(),
    };
    training::train(collection, &parts, &methods, &order, teller).map(drop)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_wished_can_be_said_and_read() {
        let wish = Wish {
            method: Some(Method::Joint),
            set: Some("fire station".to_owned()),
            folds: 5,
            groupings: Grouping::ALL.to_vec(),
            neighbours: Some(NeighbourLabels::True),
        };
        for wish in [wish, Wish::default(), Wish { method: None, folds: 0, ..Wish::default() }] {
            assert_eq!(Wish::read(&wish.words()), Ok(wish));
        }
        for wrong in ["algorithm=magic", "folds=1", "folds=many", "by=street", "neighbours=nice", "tree"] {
            assert!(Wish::read(wrong).is_err(), "{wrong}");
        }
    }
}
