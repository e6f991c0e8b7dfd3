/// A set of rows, one bit each, so that counting which rooms a list of rules covers, and how many of them
/// correctly, takes a few operations on words.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Bits(Vec<u64>);

impl Bits {
    /// The empty set of rows `0..rows`.
    pub fn none(rows: usize) -> Self {
        Self(vec![0; rows.div_ceil(64)])
    }

    /// The rows of `0..rows` for which the condition holds.
    pub fn of(rows: usize, holds: impl Fn(usize) -> bool) -> Self {
        let mut bits = Self::none(rows);
        for row in (0..rows).filter(|&row| holds(row)) {
            bits.insert(row as u32);
        }
        bits
    }

    pub fn insert(&mut self, row: u32) {
        self.0[row as usize / 64] |= 1 << (row % 64);
    }

    pub fn contains(&self, row: u32) -> bool {
        self.0[row as usize / 64] >> (row % 64) & 1 == 1
    }

    pub fn count(&self) -> u32 {
        self.0.iter().map(|word| word.count_ones()).sum()
    }

    /// Number of rows in both sets.
    pub fn count_and(&self, other: &Self) -> u32 {
        self.0.iter().zip(&other.0).map(|(p, q)| (p & q).count_ones()).sum()
    }

    /// Number of rows in all three sets.
    pub fn count_and_and(&self, other: &Self, third: &Self) -> u32 {
        self.0.iter().zip(&other.0).zip(&third.0).map(|((p, q), r)| (p & q & r).count_ones()).sum()
    }

    /// Removes the rows of another set.
    pub fn subtract(&mut self, other: &Self) {
        for (p, q) in self.0.iter_mut().zip(&other.0) {
            *p &= !q;
        }
    }

    /// Removes the rows of another set; returns how many were removed, and how many of these are in a
    /// third.
    pub fn take(&mut self, other: &Self, third: &Self) -> (u32, u32) {
        let (mut taken, mut in_third) = (0, 0);
        for ((p, q), r) in self.0.iter_mut().zip(&other.0).zip(&third.0) {
            taken += (*p & q).count_ones();
            in_third += (*p & q & r).count_ones();
            *p &= !q;
        }
        (taken, in_third)
    }

    /// The rows of the set, ascending.
    pub fn rows(&self) -> impl Iterator<Item = u32> + '_ {
        self.0.iter().enumerate().flat_map(|(index, &word)| {
            let mut left = word;
            std::iter::from_fn(move || {
                let bit = left.trailing_zeros();
                left &= left.checked_sub(1)?;
                Some(index as u32 * 64 + bit)
            })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::Bits;

    #[test]
    fn behaves_as_a_set() {
        let mut threes = Bits::of(200, |row| row % 3 == 0);
        let twos = Bits::of(200, |row| row % 2 == 0);
        assert_eq!((threes.count(), threes.count_and(&twos)), (67, 34));
        assert_eq!(threes.count_and_and(&twos, &Bits::of(200, |row| row < 7)), 2);
        let taken = threes.clone().take(&twos, &Bits::of(200, |row| row < 7));
        assert_eq!(taken, (34, 2));
        threes.subtract(&twos);
        assert_eq!(threes.rows().take(3).collect::<Vec<_>>(), [3, 9, 15]);
        assert!(threes.contains(195) && !threes.contains(198));
        assert_eq!(Bits::none(0).rows().count(), 0);
    }
}
