//! A progress line on the terminal.

use std::io::Write as _;
use std::sync::Mutex;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use super::Terminal;
use super::door::one_line;
use crate::base::work::Work;

/// The minimum time between updates.
const STEP: Duration = Duration::from_millis(200);

/// The line: on stderr, if that is a terminal.
pub struct Progress {
    title: String,
    count: usize,
    is_shown: bool,
    start: Instant,
    last: Mutex<Duration>,
    /// For [`Work::watched`]: Ctrl+C ends the program at once, and nothing else cancels.
    pub never: AtomicBool,
}

impl Progress {
    /// Starts at 0 of `count` parts.
    pub fn new(title: &str, count: usize, terminal: &Terminal) -> Self {
        #[expect(clippy::disallowed_methods, reason = "the time left is for a person to read; no result depends on it")]
        let start = Instant::now();
        let (title, last, never) = (one_line(title), Mutex::new(Duration::ZERO), AtomicBool::new(false));
        Self { title, count, is_shown: terminal.is_interactive, start, last, never }
    }

    /// Reports the number of parts done.
    pub fn tell(&self, done: usize) {
        self.tell_of(done, self.count);
    }

    fn tell_of(&self, done: usize, count: usize) {
        if !self.is_shown {
            return;
        }
        let now = self.start.elapsed();
        let Ok(mut last) = self.last.try_lock() else { return };
        if now.saturating_sub(*last) < STEP && done < count {
            return;
        }
        *last = now;
        let left = now.mul_f64(count.saturating_sub(done) as f64 / done.max(1) as f64);
        let percent = 100 * done / count.max(1);
        // Whoever closed stderr does not read it.
        let _ = write!(std::io::stderr(), "\r{}: {percent} %, {} left \x1b[K", self.title, in_words(left));
    }

    /// Clears the line, for other text.
    pub fn clear(&self) {
        if self.is_shown {
            let _ = write!(std::io::stderr(), "\r\x1b[K");
        }
    }
}

/// Runs work while a line on stderr, if that is a terminal, shows progress and the estimated time left.
/// Ctrl+C ends the program at once: nothing is written before all work is done.
pub fn with_progress<T>(
    title: &str,
    threads: Option<usize>,
    terminal: &Terminal,
    work: impl FnOnce(&Work<'_>) -> T,
) -> T {
    let quiet = match threads.or(terminal.call.jobs) {
        Some(threads) => Work::quiet().on_threads(threads),
        None => Work::quiet(),
    };
    let line = Progress::new(title, 0, terminal);
    let told = |done: usize, count: usize| line.tell_of(done, count);
    let result = work(&quiet.watched(&told, &line.never));
    line.clear();
    result
}

/// A readable duration: '45 s', '3 min'.
fn in_words(duration: Duration) -> String {
    let seconds = duration.as_secs_f64().ceil();
    if seconds < 100.0 { format!("{seconds} s") } else { format!("{} min", (seconds / 60.0).ceil()) }
}
