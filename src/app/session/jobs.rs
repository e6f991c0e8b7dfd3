//! Work off the frame's path: a job runs on a thread of its own and its outcome arrives in a later
//! frame. Offscreen the same jobs run at once, so that a replayed session never waits for a clock.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{Receiver, Sender, channel};

/// Runs jobs and collects their outcomes.
pub(crate) struct Background<T> {
    sender: Sender<Outcome<T>>,
    receiver: Receiver<Outcome<T>>,
    running: usize,
    mode: Mode,
}

/// Where jobs run.
pub(crate) enum Mode {
    /// On threads; the context is asked for a frame when one ends.
    Threads(egui::Context),
    /// Within the call that starts them.
    Inline,
}

/// How a job ended: `None` when it panicked, which is a bug of ours, not to take the window down.
type Outcome<T> = Option<T>;

impl<T: Send + 'static> Background<T> {
    pub(crate) fn new(mode: Mode) -> Self {
        let (sender, receiver) = channel();
        Self { sender, receiver, running: 0, mode }
    }

    /// Starts a job.
    pub(crate) fn start(&mut self, job: impl FnOnce() -> T + Send + 'static) {
        self.running += 1;
        let sender = self.sender.clone();
        match &self.mode {
            Mode::Inline => deliver(job, &sender),
            Mode::Threads(context) => {
                let context = context.clone();
                std::thread::spawn(move || {
                    deliver(job, &sender);
                    context.request_repaint();
                });
            }
        }
    }

    /// The outcomes that arrived since the last call; `None` for a job that broke.
    pub(crate) fn take(&mut self) -> Vec<Option<T>> {
        let arrived: Vec<Outcome<T>> = self.receiver.try_iter().collect();
        self.running -= arrived.len();
        arrived
    }

    /// Asks for the frame that takes the next outcome.
    pub(crate) fn request_frame(&self, context: &egui::Context) {
        match self.mode {
            Mode::Inline => context.request_repaint(),
            // A thread asks when it is done; in between, what waits may say so.
            Mode::Threads(_) => context.request_repaint_after(std::time::Duration::from_millis(100)),
        }
    }

    /// Whether jobs run within the call that starts them.
    pub(crate) fn is_inline(&self) -> bool {
        matches!(self.mode, Mode::Inline)
    }

    /// Whether a job has not been taken yet.
    pub(crate) fn is_busy(&self) -> bool {
        self.running > 0
    }
}

fn deliver<T>(job: impl FnOnce() -> T, sender: &Sender<Outcome<T>>) {
    let outcome = catch_unwind(AssertUnwindSafe(job)).ok();
    // The receiver is gone only when the window is: nobody waits for the outcome then.
    let _ = sender.send(outcome);
}

#[cfg(test)]
mod tests {
    use crate::app::session::jobs::*;

    #[test]
    fn outcomes_arrive_and_a_broken_job_is_told_apart() {
        let mut inline = Background::new(Mode::Inline);
        inline.start(|| 1);
        inline.start(|| panic!("a bug"));
        assert!(inline.is_busy());
        assert_eq!(inline.take(), [Some(1), None]);
        assert!(!inline.is_busy());
        let mut threads = Background::new(Mode::Threads(egui::Context::default()));
        threads.start(|| 2);
        while threads.is_busy() {
            for outcome in threads.take() {
                assert_eq!(outcome, Some(2));
            }
            std::thread::yield_now();
        }
    }
}
