use super::Plan;

/// A plan and the edit that led to it.
#[derive(Clone, Debug)]
pub struct Step {
    /// What was done, in the imperative ('Move corner'); the first step says where the plan came from.
    pub title: String,
    pub plan: Plan,
}

/// Undo and redo as a list of plans: nothing is ever computed backwards. Plans share structure, so a step
/// costs only what changed.
#[derive(Clone, Debug)]
pub struct History {
    steps: Vec<Step>,
    current: usize,
}

impl History {
    /// A history that starts with `plan`.
    pub fn new(title: impl Into<String>, plan: Plan) -> Self {
        Self { steps: vec![Step { title: title.into(), plan }], current: 0 }
    }

    /// A history of steps, one of them current; an index past the end means the last. `None` if there are
    /// no steps.
    pub fn of_steps(steps: Vec<Step>, current: usize) -> Option<Self> {
        let last = steps.len().checked_sub(1)?;
        Some(Self { steps, current: current.min(last) })
    }

    /// The current plan.
    pub fn plan(&self) -> &Plan {
        &self.steps[self.current].plan
    }

    /// All steps, undone ones included, oldest first.
    pub fn steps(&self) -> &[Step] {
        &self.steps
    }

    /// Index of the current step in [`History::steps`].
    pub fn position(&self) -> usize {
        self.current
    }

    /// Makes `plan` the current one and drops undone steps; an edit that changed nothing adds no step.
    pub fn push(&mut self, title: impl Into<String>, plan: Plan) {
        if plan == *self.plan() {
            return;
        }
        self.steps.truncate(self.current + 1);
        self.steps.push(Step { title: title.into(), plan });
        self.current += 1;
    }

    /// Makes one step of the current one and the one before: undoing goes back behind both.
    pub fn join_with_previous(&mut self) {
        if self.current > 1 {
            self.steps.remove(self.current - 1);
            self.current -= 1;
        }
    }

    pub fn can_undo(&self) -> bool {
        self.current > 0
    }

    pub fn can_redo(&self) -> bool {
        self.current + 1 < self.steps.len()
    }

    /// Goes back one step and returns the title of the edit undone.
    pub fn undo(&mut self) -> Option<&str> {
        self.current = self.current.checked_sub(1)?;
        Some(&self.steps[self.current + 1].title)
    }

    /// Goes forward one step and returns the title of the edit redone.
    pub fn redo(&mut self) -> Option<&str> {
        if !self.can_redo() {
            return None;
        }
        self.current += 1;
        Some(&self.steps[self.current].title)
    }

    /// Applies a change to every plan: for changes that are not edits, such as a picture's path becoming
    /// relative to another folder.
    pub fn rewrite(&mut self, change: impl Fn(&Plan) -> Plan) {
        for step in &mut self.steps {
            step.plan = change(&step.plan);
        }
    }

    /// Jumps to a step; an index past the end goes to the last.
    pub fn jump_to(&mut self, position: usize) {
        self.current = position.min(self.steps.len() - 1);
    }
}
