//! The features of a plan's rooms, one row after the other.

/// A row of numbers for each room.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Rows {
    /// Numbers in a row.
    width: usize,
    values: Vec<f32>,
}

impl Rows {
    /// No rows yet, with room for so many of this width, which must not be 0.
    pub fn with_capacity(width: usize, rows: usize) -> Self {
        Self { width, values: Vec::with_capacity(width * rows) }
    }

    /// Adds a row of so many numbers.
    pub fn push(&mut self, row: impl IntoIterator<Item = f32>) {
        self.values.extend(row);
        debug_assert_eq!(self.values.len() % self.width, 0, "a row is as wide as the others");
    }

    pub fn len(&self) -> usize {
        self.values.len() / self.width.max(1)
    }

    pub const fn width(&self) -> usize {
        self.width
    }

    /// The row of a room.
    pub fn of(&self, room: usize) -> &[f32] {
        &self.values[room * self.width..(room + 1) * self.width]
    }

    pub fn of_mut(&mut self, room: usize) -> &mut [f32] {
        &mut self.values[room * self.width..(room + 1) * self.width]
    }

    pub fn iter(&self) -> impl ExactSizeIterator<Item = &[f32]> {
        self.values.chunks_exact(self.width.max(1))
    }

    pub fn iter_mut(&mut self) -> impl ExactSizeIterator<Item = &mut [f32]> {
        self.values.chunks_exact_mut(self.width.max(1))
    }
}
