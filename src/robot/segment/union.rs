//! Union-find.

/// A disjoint-set forest over numbers from 0.
#[derive(Clone, Debug, Default)]
pub struct Union {
    parents: Vec<u32>,
}

impl Union {
    /// `count` singleton sets.
    pub fn of(count: usize) -> Self {
        Self { parents: (0..count as u32).collect() }
    }

    /// A new number in a set of its own.
    pub fn add(&mut self) -> u32 {
        let new = self.parents.len() as u32;
        self.parents.push(new);
        new
    }

    /// The representative of the set containing `number`.
    pub fn find(&mut self, mut number: u32) -> u32 {
        while self.parents[number as usize] != number {
            let parent = self.parents[number as usize];
            self.parents[number as usize] = self.parents[parent as usize];
            number = self.parents[number as usize];
        }
        number
    }

    /// Merges two sets, given by their representatives; `keep` represents the result.
    pub fn join(&mut self, keep: u32, go: u32) {
        self.parents[go as usize] = keep;
    }
}
