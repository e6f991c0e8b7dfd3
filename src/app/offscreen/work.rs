//! Work in the background: how it runs, and which is held until a test lets it end.

use super::*;

impl Offscreen {
    /// Works beside the frames on threads, as the window on a screen does: what is seen when then depends
    /// on how fast the machine is.
    pub fn working_beside(mut self) -> Self {
        self.app.session.jobs = Jobs::new(Mode::Threads(self.context.clone()));
        self
    }

    /// Runs a job of the work beside the frames in each of them, as where there are no threads.
    pub fn working_in_slices(mut self) -> Self {
        self.app.session.jobs = Jobs::new(Mode::Sliced);
        self
    }

    /// Holds back all work beside the frames until [`Self::end_job`] or [`Self::break_job`] is called.
    pub fn holding_jobs(mut self) -> Self {
        self.app.session.jobs = Jobs::new(Mode::Held);
        self
    }

    /// What the jobs do that are held back, the one that was started first in front.
    pub fn held_jobs(&self) -> Vec<&'static str> {
        self.app.session.jobs.held()
    }

    /// What the jobs do that somebody waits for, and how far each is: parts done, of how many, where it tells.
    pub fn jobs(&self) -> Vec<(&'static str, Option<(usize, usize)>)> {
        self.app.session.jobs.progress()
    }

    /// Runs the first job that does this and is held back; a frame takes its outcome. Gives whether there is one.
    pub fn end_job(&mut self, name: &str) -> bool {
        self.run_held(name, false)
    }

    /// As [`Self::end_job`], but the job breaks, as by a bug.
    pub fn break_job(&mut self, name: &str) -> bool {
        self.run_held(name, true)
    }

    /// As [`Self::end_job`], by its place in [`Self::held_jobs`].
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

    /// Whether something is being worked out beside the frames.
    pub fn is_working(&self) -> bool {
        self.app.session.jobs.is_busy()
    }
}
