use super::Plan;

/// A plan and the edit that led to it.
#[derive(Clone, Debug)]
pub struct Step {
    /// What was done, in the imperative ('Move corner'); the first step's is how the plan came.
    pub title: String,
    pub plan: Plan,
}

/// Undo and redo as a list of plans: nothing is ever computed backwards. Plans share structure, so
/// a step costs what changed.
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

    /// A history of steps of which one is current; an index beyond the last means the last. `None` without
    /// steps.
    pub fn of_steps(steps: Vec<Step>, current: usize) -> Option<Self> {
        let last = steps.len().checked_sub(1)?;
        Some(Self { steps, current: current.min(last) })
    }

    /// The plan as it is now.
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

    /// Makes `plan` the current one. Undone steps are dropped; an edit that changed nothing leaves
    /// no step.
    pub fn push(&mut self, title: impl Into<String>, plan: Plan) {
        if plan == *self.plan() {
            return;
        }
        self.steps.truncate(self.current + 1);
        self.steps.push(Step { title: title.into(), plan });
        self.current += 1;
    }

    pub fn can_undo(&self) -> bool {
        self.current > 0
    }

    pub fn can_redo(&self) -> bool {
        self.current + 1 < self.steps.len()
    }

    /// Goes back one step and gives the title of the edit undone.
    pub fn undo(&mut self) -> Option<&str> {
        self.current = self.current.checked_sub(1)?;
        Some(&self.steps[self.current + 1].title)
    }

    /// Goes forward one step and gives the title of the edit redone.
    pub fn redo(&mut self) -> Option<&str> {
        if !self.can_redo() {
            return None;
        }
        self.current += 1;
        Some(&self.steps[self.current].title)
    }

    /// Replaces every plan by what it becomes: for what is no edit, such as the path of a picture that
    /// starts at another folder from now on.
    pub fn rewrite(&mut self, change: impl Fn(&Plan) -> Plan) {
        for step in &mut self.steps {
            step.plan = change(&step.plan);
        }
    }

    /// Jumps to a step; an index beyond the last goes to the last.
    pub fn jump_to(&mut self, position: usize) {
        self.current = position.min(self.steps.len() - 1);
    }
}
