//! Background work: a job runs elsewhere and returns a closure, which a later frame runs on the session.
//! Offscreen the same jobs run at once, so that a replay never waits for a clock; tests hold them back
//! and end them in any order.

use std::collections::{BTreeMap, VecDeque};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};

use egui::Context;

use crate::app::session::Session;
use crate::app::session::messages::Severity;
use crate::base::work::Work;

/// The outcome of a job: what to do with the session once it has ended.
pub(crate) type Outcome = Box<dyn FnOnce(&mut Session, &Context) + Send>;

type Job = Box<dyn FnOnce(&Work<'_>) -> Outcome + Send>;

/// What its owner does if a job panics.
type Broken = Box<dyn FnOnce(&mut Session) + Send>;

/// Where jobs run.
pub(crate) enum Mode {
    /// On threads; the context is asked for a frame when one ends.
    Threads(Context),
    /// Inside the call that starts them.
    Inline,
    /// When told to, one by one: see [`Jobs::run_held`].
    Held,
    /// One per frame, inside it: where there are no threads.
    Sliced,
}

/// The properties of a job.
pub(crate) struct Kind {
    /// Its name, in words: 'open a plan'.
    name: &'static str,
    /// A later job with the same key replaces it.
    key: Option<&'static str>,
    must_end: bool,
    broken: Option<Broken>,
}

impl Kind {
    pub(crate) const fn new(name: &'static str) -> Self {
        Self { name, key: None, must_end: false, broken: None }
    }

    /// Only the newest job with this key counts: an older one is cancelled, and its outcome dropped.
    pub(crate) fn newest_of(self, key: &'static str) -> Self {
        Self { key: Some(key), ..self }
    }

    /// Actions that could lose work wait for its end: closing, or showing another plan.
    pub(crate) fn must_end(self) -> Self {
        Self { must_end: true, ..self }
    }

    /// What its owner does if it panics instead of returning an outcome.
    pub(crate) fn if_broken(self, broken: impl FnOnce(&mut Session) + Send + 'static) -> Self {
        Self { broken: Some(Box::new(broken)), ..self }
    }
}

/// The progress of a job, and whether it should continue.
#[derive(Clone, Default)]
struct Watched(Arc<State>);

#[derive(Default)]
struct State {
    cancelled: AtomicBool,
    done: AtomicUsize,
    count: AtomicUsize,
}

impl Watched {
    fn is_cancelled(&self) -> bool {
        self.0.cancelled.load(Ordering::Relaxed)
    }

    fn cancel(&self) {
        self.0.cancelled.store(true, Ordering::Relaxed);
    }

    /// Parts done, and their total; `None` for a job that reports none.
    fn progress(&self) -> Option<(usize, usize)> {
        let count = self.0.count.load(Ordering::Relaxed);
        (count > 0).then(|| (self.0.done.load(Ordering::Relaxed).min(count), count))
    }
}

/// A job that is wanted as long as this is kept: when dropped, it is cancelled, and so is its outcome.
pub(crate) struct Wanted(Watched);

impl Drop for Wanted {
    fn drop(&mut self) {
        self.0.cancel();
    }
}

struct Running {
    kind: Kind,
    watched: Watched,
}

/// How a job ended: `None` if it panicked, which is a bug but must not take the window down.
struct Ended {
    number: u64,
    outcome: Option<Outcome>,
}

struct Queued {
    number: u64,
    job: Job,
    watched: Watched,
}

/// Runs jobs and collects their outcomes.
pub(crate) struct Jobs {
    sender: Sender<Ended>,
    receiver: Receiver<Ended>,
    /// By number: those whose outcomes have not been taken.
    running: BTreeMap<u64, Running>,
    /// Those that have not started, if they have to wait.
    queued: VecDeque<Queued>,
    started: u64,
    mode: Mode,
}

impl Jobs {
    pub(crate) fn new(mode: Mode) -> Self {
        let (sender, receiver) = channel();
        Self { sender, receiver, running: BTreeMap::new(), queued: VecDeque::new(), started: 0, mode }
    }

    /// Starts a job: its outcome runs in a later frame.
    pub(crate) fn start<O>(&mut self, kind: Kind, job: impl FnOnce(&Work<'_>) -> O + Send + 'static)
    where
        O: FnOnce(&mut Session, &Context) + Send + 'static,
    {
        self.begin(kind, Box::new(move |work| Box::new(job(work))));
    }

    /// Like [`Self::start`]; the job is cancelled when the returned value is dropped.
    pub(crate) fn start_wanted<O>(&mut self, kind: Kind, job: impl FnOnce(&Work<'_>) -> O + Send + 'static) -> Wanted
    where
        O: FnOnce(&mut Session, &Context) + Send + 'static,
    {
        Wanted(self.begin(kind, Box::new(move |work| Box::new(job(work)))))
    }

    fn begin(&mut self, kind: Kind, job: Job) -> Watched {
        if kind.key.is_some() {
            self.running.values().filter(|running| running.kind.key == kind.key).for_each(|old| old.watched.cancel());
        }
        let watched = Watched::default();
        self.started += 1;
        let queued = Queued { number: self.started, job, watched: watched.clone() };
        self.running.insert(self.started, Running { kind, watched: watched.clone() });
        match &self.mode {
            Mode::Inline => run(queued, Work::quiet(), &self.sender),
            Mode::Threads(context) => {
                let (sender, context) = (self.sender.clone(), context.clone());
                std::thread::spawn(move || {
                    run(queued, Work::quiet(), &sender);
                    context.request_repaint();
                });
            }
            Mode::Held | Mode::Sliced => self.queued.push_back(queued),
        }
        watched
    }

    /// Runs the job at an index in the queue, or makes it panic. Returns whether there is one.
    pub(crate) fn run_held(&mut self, index: usize, breaks: bool) -> bool {
        let Some(queued) = self.queued.remove(index) else { return false };
        if breaks {
            deliver(queued.number, None, &self.sender);
        } else {
            run(queued, Work::quiet().on_threads(1), &self.sender);
        }
        true
    }

    /// The names of the jobs that have not started, in queue order.
    pub(crate) fn held(&self) -> Vec<&'static str> {
        let name = |queued: &Queued| self.running.get(&queued.number).map(|running| running.kind.name);
        self.queued.iter().filter_map(name).collect()
    }

    /// The names of the running jobs, and the progress of each that reports it: parts done, and their
    /// total.
    pub(crate) fn progress(&self) -> Vec<(&'static str, Option<(usize, usize)>)> {
        let wanted = self.running.values().filter(|running| !running.watched.is_cancelled());
        wanted.map(|running| (running.kind.name, running.watched.progress())).collect()
    }

    /// The jobs that ended since the last call.
    fn arrived(&mut self) -> Vec<Ended> {
        if matches!(self.mode, Mode::Sliced) {
            self.run_held(0, false);
        }
        self.receiver.try_iter().collect()
    }

    /// Asks for the frame that takes the next outcome.
    pub(crate) fn request_frame(&self, context: &Context) {
        match self.mode {
            // They end when told to.
            Mode::Held if self.queued.len() == self.running.len() => {}
            Mode::Inline | Mode::Held | Mode::Sliced => context.request_repaint(),
            // A thread asks when it is done; in between, progress can be shown.
            Mode::Threads(_) => context.request_repaint_after(std::time::Duration::from_millis(100)),
        }
    }

    /// Whether no threads run in the background.
    pub(crate) fn is_inline(&self) -> bool {
        !matches!(self.mode, Mode::Threads(_))
    }

    /// Whether any job's outcome has not been taken yet.
    pub(crate) fn is_busy(&self) -> bool {
        !self.running.is_empty()
    }

    /// Whether a job is running that must end first, such as a save.
    pub(crate) fn is_one_to_end(&self) -> bool {
        self.running.values().any(|running| running.kind.must_end)
    }
}

fn run(queued: Queued, work: Work<'_>, sender: &Sender<Ended>) {
    let Queued { number, job, watched } = queued;
    let progress = |done: usize, count: usize| {
        watched.0.done.fetch_max(done, Ordering::Relaxed);
        watched.0.count.store(count, Ordering::Relaxed);
    };
    let work = work.watched(&progress, &watched.0.cancelled);
    let outcome = catch_unwind(AssertUnwindSafe(|| job(&work))).ok();
    deliver(number, outcome, sender);
}

fn deliver(number: u64, outcome: Option<Outcome>, sender: &Sender<Ended>) {
    // The receiver is gone only when the window is: then nobody waits for the outcome.
    let _ = sender.send(Ended { number, outcome });
}

impl Session {
    /// Runs the outcomes of the jobs that ended since the last call.
    pub(crate) fn take_outcomes(&mut self, context: &Context) {
        for Ended { number, outcome } in self.jobs.arrived() {
            let Some(Running { kind, watched }) = self.jobs.running.remove(&number) else { continue };
            match outcome {
                Some(outcome) if !watched.is_cancelled() => outcome(self, context),
                Some(_) => {}
                None => {
                    if let Some(broken) = kind.broken.filter(|_| !watched.is_cancelled()) {
                        broken(self);
                    }
                    self.say_of_program(
                        Severity::Error,
                        "Something went wrong inside Enfilade",
                        "Your plan has not changed. Please report what you did.",
                    );
                }
            }
        }
    }
}
