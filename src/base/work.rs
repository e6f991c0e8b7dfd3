//! Work split into independent parts, run on any number of threads with the same result.

use std::num::NonZeroUsize;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, OnceLock};

/// How to run work: on how many threads, and who watches and may cancel it.
#[derive(Clone, Copy)]
pub struct Work<'a> {
    threads: usize,
    progress: &'a (dyn Fn(usize, usize) + Sync),
    rounds: &'a (dyn Fn(Round) + Sync),
    cancelled: &'a AtomicBool,
}

/// A round over all examples of something that learns in rounds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Round {
    /// From 0; learning begins anew with 0.
    pub round: usize,
    /// The mean loss over the examples learned from, as they were met in this round.
    pub loss: f64,
    /// The mean loss over examples held out, after the round, if there are any.
    pub held_out_loss: Option<f64>,
}

/// The work was cancelled; there is no result.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cancelled;

impl std::fmt::Display for Cancelled {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("cancelled")
    }
}

impl std::error::Error for Cancelled {}

/// What the progress of [`Work::within`] counts.
const THOUSANDTHS: usize = 1000;

/// The flag of [`Work::quiet`]: never set.
static NEVER: AtomicBool = AtomicBool::new(false);

impl Work<'static> {
    /// Unwatched work, on as many threads as the machine has processors.
    pub fn quiet() -> Self {
        // Asked once: the answer takes a tenth of a millisecond, since it is read from files.
        static THREADS: OnceLock<usize> = OnceLock::new();
        let threads = *THREADS.get_or_init(|| std::thread::available_parallelism().map_or(1, NonZeroUsize::get));
        Self { threads, progress: &|_, _| {}, rounds: &|_| {}, cancelled: &NEVER }
    }
}

impl<'a> Work<'a> {
    /// The same with this many threads; 1 starts none.
    #[must_use]
    pub fn on_threads(self, threads: usize) -> Self {
        Self { threads: threads.max(1), ..self }
    }

    /// The number of threads.
    pub fn threads(&self) -> usize {
        self.threads
    }

    /// With a watcher: `progress` is called with the parts done and their total, from any thread and not
    /// always in order; once `cancelled` is set, no further part starts.
    #[must_use]
    pub fn watched(self, progress: &'a (dyn Fn(usize, usize) + Sync), cancelled: &'a AtomicBool) -> Self {
        Self { progress, cancelled, ..self }
    }

    /// With another watcher of the progress; cancelled as before.
    #[must_use]
    pub fn telling(self, progress: &'a (dyn Fn(usize, usize) + Sync)) -> Self {
        Self { progress, ..self }
    }

    /// With somebody who hears of the rounds of learning, from any thread: also of those in parts of the work.
    #[must_use]
    pub fn hearing(self, rounds: &'a (dyn Fn(Round) + Sync)) -> Self {
        Self { rounds, ..self }
    }

    /// Tells of a round of learning. Whether somebody hears changes nothing of what is learned.
    pub fn tell_round(&self, round: Round) {
        (self.rounds)(round);
    }

    /// For a part of other work: single-threaded, cancelled with the whole, without progress of its own.
    #[must_use]
    pub fn alone(self) -> Self {
        Self { threads: 1, progress: &|_, _| {}, ..self }
    }

    /// Says how far the work is: so many parts of their total are done.
    pub fn tell(&self, done: usize, count: usize) {
        (self.progress)(done, count);
    }

    /// A part of this work that takes it from one share to another, 0..=1: the progress of the part becomes that of the
    /// whole, in thousandths, so that it never starts again.
    pub fn within<T>(&self, shares: Range<f64>, part: impl FnOnce(&Work<'_>) -> T) -> T {
        let progress = |done: usize, count: usize| {
            let of_part = done as f64 / count.max(1) as f64;
            let share = shares.start + (shares.end - shares.start) * of_part;
            (self.progress)((share * THOUSANDTHS as f64).round() as usize, THOUSANDTHS);
        };
        part(&self.telling(&progress))
    }

    /// Checks for cancellation: call between steps, and now and then in long work that has no parts.
    ///
    /// # Errors
    /// When the work is cancelled.
    pub fn goes_on(&self) -> Result<(), Cancelled> {
        if self.cancelled.load(Ordering::Relaxed) { Err(Cancelled) } else { Ok(()) }
    }

    /// For sequential steps: reports how many of `count` are done, before the next one.
    ///
    /// # Errors
    /// When cancelled: the next step must not start.
    pub fn step(&self, done: usize, count: usize) -> Result<(), Cancelled> {
        (self.progress)(done, count);
        if self.cancelled.load(Ordering::Relaxed) { Err(Cancelled) } else { Ok(()) }
    }

    /// Runs `count` parts and returns their results in order.
    ///
    /// # Errors
    /// When cancelled before all parts were done.
    pub fn map<T: Send>(&self, count: usize, part: impl Fn(usize) -> T + Sync) -> Result<Vec<T>, Cancelled> {
        let next = AtomicUsize::new(0);
        let done = AtomicUsize::new(0);
        let results: Mutex<Vec<Option<T>>> = Mutex::new((0..count).map(|_| None).collect());
        let worker = || {
            while !self.cancelled.load(Ordering::Relaxed) {
                let index = next.fetch_add(1, Ordering::Relaxed);
                if index >= count {
                    return;
                }
                let result = part(index);
                if let Ok(mut results) = results.lock() {
                    results[index] = Some(result);
                }
                (self.progress)(done.fetch_add(1, Ordering::Relaxed) + 1, count);
            }
        };
        let threads = self.threads.min(count);
        if threads <= 1 {
            worker();
        } else {
            std::thread::scope(|scope| {
                for _ in 0..threads {
                    scope.spawn(worker);
                }
            });
        }
        let results = results.into_inner().unwrap_or_default();
        let results: Vec<T> = results.into_iter().flatten().collect();
        if results.len() == count { Ok(results) } else { Err(Cancelled) }
    }
}

#[cfg(test)]
mod tests {
    use crate::base::work::*;

    #[test]
    fn results_stand_in_order_on_any_number_of_threads() {
        let square = |i: usize| i * i;
        let expected: Vec<usize> = (0..100).map(square).collect();
        for threads in [0, 1, 2, 7, 300] {
            assert_eq!(Work::quiet().on_threads(threads).map(100, square), Ok(expected.clone()));
        }
        assert_eq!(Work::quiet().map(0, square), Ok(Vec::new()));
    }

    #[test]
    fn the_progress_of_parts_never_starts_again() {
        let seen = Mutex::new(Vec::new());
        let progress = |done: usize, count: usize| seen.lock().unwrap().push((done, count));
        let work = Work::quiet().on_threads(1).watched(&progress, &NEVER);
        let all = work.within(0.5..1.0, |work| {
            work.within(0.0..0.5, |work| work.map(2, |i| i)).unwrap();
            work.within(0.5..1.0, |work| work.map(1, |i| i))
        });
        assert_eq!(all, Ok(vec![0]));
        assert_eq!(*seen.lock().unwrap(), [(625, 1000), (750, 1000), (1000, 1000)]);
    }

    #[test]
    fn progress_is_told_and_cancelling_stops() {
        let cancelled = AtomicBool::new(false);
        let seen = AtomicUsize::new(0);
        let progress = |done: usize, count: usize| {
            assert_eq!(count, 50);
            seen.fetch_max(done, Ordering::Relaxed);
            if done == 20 {
                cancelled.store(true, Ordering::Relaxed);
            }
        };
        let work = Work::quiet().on_threads(1).watched(&progress, &cancelled);
        assert_eq!(work.map(50, |i| i), Err(Cancelled));
        assert_eq!(seen.load(Ordering::Relaxed), 20);
    }
}
