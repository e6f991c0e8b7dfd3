//! Background work: how it runs, and holding it back in tests.

use super::*;

impl Offscreen {
    /// Runs background work on threads, as the window on a screen does: the timing then depends on the
    /// machine's speed.
    pub fn working_beside(mut self) -> Self {
        self.app.session.jobs = Jobs::new(Mode::Threads(self.context.clone()));
        self
    }

    /// Runs one background job in each frame, as where there are no threads.
    pub fn working_in_slices(mut self) -> Self {
        self.app.session.jobs = Jobs::new(Mode::Sliced);
        self
    }

    /// Holds back all background work until [`Self::end_job`] or [`Self::break_job`] is called.
    pub fn holding_jobs(mut self) -> Self {
        self.app.session.jobs = Jobs::new(Mode::Held);
        self
    }

    /// The next job of a name, after so many others of it, stops at a percentage of its progress, 0 before it starts, until
    /// [`Self::let_jobs_go`].
    pub fn stop_job(&mut self, name: &str, percent: usize, passing: usize) {
        self.app.session.jobs.stop_at(name, percent, passing);
    }

    /// The name of the job that is to stop and has not started yet.
    pub fn job_to_stop(&self) -> Option<&str> {
        self.app.session.jobs.stops_next()
    }

    /// Lets the jobs that stopped go on, to another percentage of their progress or to their ends. Returns how many there were.
    pub fn let_jobs_go(&mut self, percent: Option<usize>) -> usize {
        let jobs = self.app.session.jobs.let_go(percent);
        self.frame(Vec::new(), Vec::new(), false);
        jobs
    }

    /// The names of all jobs that have started, in the order of the alphabet.
    pub fn job_names(&self) -> Vec<&'static str> {
        self.app.session.jobs.names().collect()
    }

    /// The names of the held jobs, in the order they were started.
    pub fn held_jobs(&self) -> Vec<&'static str> {
        self.app.session.jobs.held()
    }

    /// The jobs that are being waited for, and the progress of each that reports it: parts done, and
    /// their total.
    pub fn jobs(&self) -> Vec<(&'static str, Option<(usize, usize)>)> {
        self.app.session.jobs.progress()
    }

    /// Runs the first held job with this name; a frame takes its outcome. Returns whether there is one.
    pub fn end_job(&mut self, name: &str) -> bool {
        self.run_held(name, false)
    }

    /// Like [`Self::end_job`], but the job panics, as if by a bug.
    pub fn break_job(&mut self, name: &str) -> bool {
        self.run_held(name, true)
    }

    /// Like [`Self::end_job`], by its index in [`Self::held_jobs`].
    pub fn end_job_at(&mut self, index: usize) -> bool {
        self.run_held_at(index, false)
    }

    fn run_held(&mut self, name: &str, breaks: bool) -> bool {
        let index = self.held_jobs().iter().position(|held| *held == name);
        index.is_some_and(|index| self.run_held_at(index, breaks))
    }

    fn run_held_at(&mut self, index: usize, breaks: bool) -> bool {
        let is_there = self.app.session.jobs.run_held(index, breaks);
        self.frame(Vec::new(), Vec::new(), false);
        is_there
    }

    /// Whether any background work is running.
    pub fn is_working(&self) -> bool {
        self.app.session.jobs.is_busy()
    }
}
