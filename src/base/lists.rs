//! Lists of numbers, one after the other in memory: quicker to make and to go through than a list of lists.

/// Lists of numbers, such as the neighbours of each room.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Lists {
    /// Where each list begins, and where the last one ends.
    starts: Vec<u32>,
    items: Vec<u32>,
}

impl Default for Lists {
    fn default() -> Self {
        Self { starts: vec![0], items: Vec::new() }
    }
}

impl Lists {
    /// No lists yet, with room for so many.
    pub fn with_capacity(lists: usize, items: usize) -> Self {
        let mut starts = Vec::with_capacity(lists + 1);
        starts.push(0);
        Self { starts, items: Vec::with_capacity(items) }
    }

    /// So many lists from pairs of a list and one of its numbers, which keep their order. `pairs` tells all of them, twice.
    pub fn of_pairs(lists: usize, pairs: impl Fn(&mut dyn FnMut(u32, u32))) -> Self {
        let mut starts = vec![0_u32; lists + 1];
        pairs(&mut |list, _| starts[list as usize + 1] += 1);
        for list in 0..lists {
            starts[list + 1] += starts[list];
        }
        let mut items = vec![0; starts[lists] as usize];
        let mut next = starts.clone();
        pairs(&mut |list, item| {
            let place = &mut next[list as usize];
            items[*place as usize] = item;
            *place += 1;
        });
        Self { starts, items }
    }

    /// Adds a list.
    pub fn push(&mut self, items: impl IntoIterator<Item = u32>) {
        self.items.extend(items);
        self.starts.push(self.items.len() as u32);
    }

    /// Adds a list of other numbers, sorted and each once.
    pub fn push_distinct(&mut self, items: impl IntoIterator<Item = u32>) {
        let from = self.items.len();
        self.items.extend(items);
        self.items[from..].sort_unstable();
        let mut kept = from;
        for at in from..self.items.len() {
            if at == from || self.items[at] != self.items[kept - 1] {
                self.items[kept] = self.items[at];
                kept += 1;
            }
        }
        self.items.truncate(kept);
        self.starts.push(kept as u32);
    }

    /// Removes all lists.
    pub fn clear(&mut self) {
        self.items.clear();
        self.starts.truncate(1);
    }

    /// How many lists there are.
    pub fn len(&self) -> usize {
        self.starts.len() - 1
    }

    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The list with this index, which must be there.
    pub fn of(&self, index: usize) -> &[u32] {
        &self.items[self.starts[index] as usize..self.starts[index + 1] as usize]
    }

    /// All lists.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &[u32]> {
        (0..self.len()).map(|index| self.of(index))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_are_kept_apart() {
        let mut lists = Lists::default();
        lists.push([3, 1]);
        lists.push_distinct([5, 2, 5, 2, 2, 9]);
        lists.push_distinct([]);
        lists.push([7]);
        assert_eq!(lists.iter().collect::<Vec<_>>(), [&[3, 1][..], &[2, 5, 9], &[], &[7]]);
        lists.clear();
        assert!(lists.is_empty());
        let pairs = [(2, 7), (0, 1), (2, 5)];
        assert_eq!(
            Lists::of_pairs(3, |tell| pairs.iter().for_each(|&(list, item)| tell(list, item)))
                .iter()
                .collect::<Vec<_>>(),
            [&[1][..], &[], &[7, 5]]
        );
    }
}
