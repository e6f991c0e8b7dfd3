//! A line on the terminal that says how far long work is.

use std::io::Write as _;
use std::sync::Mutex;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use super::Terminal;
use crate::base::work::Work;

/// How often the line changes at most.
const STEP: Duration = Duration::from_millis(200);

/// Does work while a line on stderr, if that is a terminal, tells how much is done and how long the
/// rest will take. Ctrl+C ends the program at once: nothing is written before all work is done.
pub fn with_progress<T>(
    title: &str,
    threads: Option<usize>,
    terminal: &Terminal,
    work: impl FnOnce(&Work<'_>) -> T,
) -> T {
    let quiet = match threads {
        Some(threads) => Work::quiet().on_threads(threads),
        None => Work::quiet(),
    };
    if !terminal.is_interactive {
        return work(&quiet);
    }
    #[expect(clippy::disallowed_methods, reason = "the time left is for a person to read; no result depends on it")]
    let start = Instant::now();
    let last: Mutex<Duration> = Mutex::new(Duration::ZERO);
    let progress = |done: usize, count: usize| {
        let now = start.elapsed();
        let Ok(mut last) = last.try_lock() else { return };
        if now.saturating_sub(*last) < STEP && done < count {
            return;
        }
        *last = now;
        let left = now.mul_f64((count - done) as f64 / done.max(1) as f64);
        let percent = 100 * done / count.max(1);
        // Whoever closed stderr does not read it.
        let _ = write!(std::io::stderr(), "\r{title}: {percent} %, {} left \x1b[K", in_words(left));
    };
    let never = AtomicBool::new(false);
    let result = work(&quiet.watched(&progress, &never));
    let _ = write!(std::io::stderr(), "\r\x1b[K");
    result
}

/// A duration as people say it: '45 s', '3 min'.
fn in_words(duration: Duration) -> String {
    let seconds = duration.as_secs_f64().ceil();
    if seconds < 100.0 { format!("{seconds} s") } else { format!("{} min", (seconds / 60.0).ceil()) }
}
