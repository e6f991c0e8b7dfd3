//! Work split into independent parts, run on any number of threads with the same result.

use std::num::NonZeroUsize;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// How to run work: on how many threads, and who watches and may cancel it.
#[derive(Clone, Copy)]
pub struct Work<'a> {
    threads: usize,
    progress: &'a (dyn Fn(usize, usize) + Sync),
    cancelled: &'a AtomicBool,
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

/// The flag of [`Work::quiet`]: never set.
static NEVER: AtomicBool = AtomicBool::new(false);

impl Work<'static> {
    /// Unwatched work, on as many threads as the machine has processors.
    pub fn quiet() -> Self {
        let threads = std::thread::available_parallelism().map_or(1, NonZeroUsize::get);
        Self { threads, progress: &|_, _| {}, cancelled: &NEVER }
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

    /// For a part of other work: single-threaded, cancelled with the whole, without progress of its own.
    #[must_use]
    pub fn alone(self) -> Self {
        Self { threads: 1, progress: &|_, _| {}, ..self }
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
