//! Background work: a job runs elsewhere and returns a closure, which a later frame runs on the session.
//! Offscreen the same jobs run at once, so that a replay never waits for a clock; a script can stop one part-way,
//! see [`Jobs::stop_at`], and tests hold them back and end them in any order.

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::thread::JoinHandle;

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
    /// Parts done, and their total; zeros if it reports none.
    progress: Mutex<(usize, usize)>,
    /// Where it stops, if it is to.
    gate: Option<Gate>,
}

impl Watched {
    fn is_cancelled(&self) -> bool {
        self.0.cancelled.load(Ordering::Relaxed)
    }

    fn cancel(&self) {
        self.0.cancelled.store(true, Ordering::Relaxed);
        self.0.gate.iter().for_each(Gate::open);
    }

    /// Parts done, and their total; `None` for a job that reports none.
    fn progress(&self) -> Option<(usize, usize)> {
        let (done, count) = *self.0.progress.lock().unwrap_or_else(PoisonError::into_inner);
        (count > 0).then(|| (done.min(count), count))
    }

    /// Takes the progress in; waits if the job is to stop here.
    fn tell(&self, done: usize, count: usize) {
        {
            let mut progress = self.0.progress.lock().unwrap_or_else(PoisonError::into_inner);
            // Threads may tell of their parts out of order; another total is another step.
            let before = if progress.1 == count { progress.0 } else { 0 };
            *progress = (done.max(before), count);
        }
        if let Some(gate) = self.0.gate.as_ref().filter(|gate| done * 100 >= gate.percent() * count) {
            gate.wait();
        }
    }
}

/// Where a job stops, until it is let go.
struct Gate {
    /// Of its progress, 0..=100; 0 is before it starts.
    percent: AtomicUsize,
    at: Mutex<At>,
    changed: Condvar,
}

/// Where a job with a gate is.
#[derive(Clone, Copy, PartialEq, Eq)]
enum At {
    Before,
    Waiting,
    /// It ended, or goes on to its end.
    Open,
}

impl Gate {
    fn new(percent: usize) -> Self {
        Self { percent: AtomicUsize::new(percent), at: Mutex::new(At::Before), changed: Condvar::new() }
    }

    fn percent(&self) -> usize {
        self.percent.load(Ordering::Relaxed)
    }

    /// Lets the job go on until it stops at another percentage, or ends before.
    fn move_to(&self, percent: usize) {
        self.percent.store(percent, Ordering::Relaxed);
        self.set(At::Before, |at| at == At::Waiting);
        self.wait_while(|at| at == At::Before);
    }

    fn set(&self, to: At, if_at: impl Fn(At) -> bool) {
        let mut at = self.at.lock().unwrap_or_else(PoisonError::into_inner);
        if if_at(*at) {
            *at = to;
            self.changed.notify_all();
        }
    }

    /// The job is here: it waits until the gate is open.
    fn wait(&self) {
        self.set(At::Waiting, |at| at == At::Before);
        self.wait_while(|at| at == At::Waiting);
    }

    /// Lets the job go on to its end.
    fn open(&self) {
        self.set(At::Open, |_| true);
    }

    fn wait_while(&self, goes_on: impl Fn(At) -> bool) {
        let at = self.at.lock().unwrap_or_else(PoisonError::into_inner);
        drop(self.changed.wait_while(at, |at| goes_on(*at)));
    }

    fn is_open(&self) -> bool {
        *self.at.lock().unwrap_or_else(PoisonError::into_inner) == At::Open
    }
}

/// A job that stopped part-way, on a thread of its own.
struct Stopped {
    watched: Watched,
    thread: Option<JoinHandle<()>>,
}

impl Stopped {
    fn is_open(&self) -> bool {
        self.watched.0.gate.as_ref().is_none_or(Gate::is_open)
    }
}

impl Drop for Stopped {
    /// Waits for its end.
    fn drop(&mut self) {
        if !self.is_open() {
            self.watched.cancel();
        }
        if let Some(thread) = self.thread.take() {
            // It catches what its job does.
            let _ = thread.join();
        }
    }
}

/// Which job is to stop, and where.
struct StopAt {
    name: String,
    percent: usize,
    /// So many of its name pass before.
    passing: usize,
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
    /// The next that is to stop part-way, and those that have.
    stop_at: Option<StopAt>,
    stopped: Vec<Stopped>,
    /// The names of all that have started.
    names: BTreeSet<&'static str>,
}

impl Jobs {
    pub(crate) fn new(mode: Mode) -> Self {
        let (sender, receiver) = channel();
        let (running, queued, stopped) = (BTreeMap::new(), VecDeque::new(), Vec::new());
        Self { sender, receiver, running, queued, started: 0, mode, stop_at: None, stopped, names: BTreeSet::new() }
    }

    /// The next job of a name, after so many others of it, stops at this percentage of its progress; at 0 before it
    /// starts. It runs on one thread, so that it has always done the same by then. Only where jobs run inline.
    pub(crate) fn stop_at(&mut self, name: &str, percent: usize, passing: usize) {
        self.stop_at = Some(StopAt { name: name.to_owned(), percent, passing });
    }

    /// The name of the job that is to stop and has not started yet.
    pub(crate) fn stops_next(&self) -> Option<&str> {
        self.stop_at.as_ref().map(|wanted| wanted.name.as_str())
    }

    /// The names of all jobs that have started.
    pub(crate) fn names(&self) -> impl Iterator<Item = &'static str> {
        self.names.iter().copied()
    }

    /// Lets all stopped jobs go on, to another percentage of their progress or to their ends, and waits for that. Returns how
    /// many there were.
    pub(crate) fn let_go(&mut self, percent: Option<usize>) -> usize {
        if let Some(percent) = percent {
            self.stopped
                .iter()
                .filter_map(|stopped| stopped.watched.0.gate.as_ref())
                .for_each(|it| it.move_to(percent));
            return self.stopped.len();
        }
        let stopped: Vec<Stopped> = std::mem::take(&mut self.stopped);
        stopped.iter().filter_map(|stopped| stopped.watched.0.gate.as_ref()).for_each(Gate::open);
        stopped.len()
    }

    /// The gate of a job that starts now, if it is the one that is to stop.
    fn gate_of(&mut self, name: &str) -> Option<Gate> {
        let is_inline = matches!(self.mode, Mode::Inline);
        let wanted = self.stop_at.as_mut().filter(|wanted| is_inline && wanted.name == name)?;
        if wanted.passing > 0 {
            wanted.passing -= 1;
            return None;
        }
        self.stop_at.take().map(|wanted| Gate::new(wanted.percent))
    }

    /// Runs a job on a thread of its own until it stops, or ends before.
    fn run_to_gate(&mut self, queued: Queued) {
        let (watched, sender) = (queued.watched.clone(), self.sender.clone());
        let thread = std::thread::spawn({
            let watched = watched.clone();
            move || {
                let gate = watched.0.gate.as_ref();
                gate.filter(|gate| gate.percent() == 0).into_iter().for_each(Gate::wait);
                run(queued, Work::quiet().on_threads(1), &sender);
                gate.into_iter().for_each(Gate::open);
            }
        });
        watched.0.gate.iter().for_each(|gate| gate.wait_while(|at| at == At::Before));
        let stopped = Stopped { watched, thread: Some(thread) };
        // One that ended is waited for here.
        if !stopped.is_open() {
            self.stopped.push(stopped);
        }
    }

    /// On how many threads a job runs: what is dealt out by it is the same on every machine where nothing runs beside
    /// the frames.
    pub(crate) fn threads(&self) -> usize {
        if self.is_inline() { 1 } else { Work::quiet().threads() }
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
        let gate = self.gate_of(kind.name);
        let watched = Watched(Arc::new(State { gate, ..State::default() }));
        self.started += 1;
        self.names.insert(kind.name);
        let queued = Queued { number: self.started, job, watched: watched.clone() };
        self.running.insert(self.started, Running { kind, watched: watched.clone() });
        match &self.mode {
            Mode::Inline if watched.0.gate.is_some() => self.run_to_gate(queued),
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

    /// The progress of the running job of a name, if one runs and reports it.
    pub(crate) fn progress_of(&self, name: &str) -> Option<(usize, usize)> {
        self.progress().into_iter().find(|(of, _)| *of == name)?.1
    }

    /// The share of the running job of a name that is done, 0..=1; 0 where that is not known.
    pub(crate) fn share_of(&self, name: &str) -> f64 {
        self.progress_of(name).map_or(0.0, |(done, count)| done as f64 / count as f64)
    }

    /// The jobs that ended since the last call.
    fn arrived(&mut self) -> Vec<Ended> {
        if matches!(self.mode, Mode::Sliced) {
            self.run_held(0, false);
        }
        // Those that were cancelled: their ends are waited for.
        self.stopped.retain(|stopped| !stopped.is_open());
        self.receiver.try_iter().collect()
    }

    /// Asks for the frame that takes the next outcome.
    pub(crate) fn request_frame(&self, context: &Context) {
        match self.mode {
            // They end when told to.
            Mode::Held if self.queued.len() == self.running.len() => {}
            Mode::Inline if self.stopped.iter().filter(|it| !it.is_open()).count() == self.running.len() => {}
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
    let progress = |done: usize, count: usize| watched.tell(done, count);
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
