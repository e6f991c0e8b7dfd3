//! The distance from every free cell to the nearest one that is not free, and that cell.

/// For every cell, in cells from centre to centre.
pub struct Distances {
    /// Squared distance; 0 if the cell is not free.
    pub squared: Vec<u32>,
    /// The nearest cell that is not free, as (x, y); cells just outside the grid count as not free.
    pub nearest: Vec<(i32, i32)>,
}

/// The exact Euclidean distance transform: columns first, then the lower envelope of parabolas along
/// each row (Felzenszwalb and Huttenlocher, Distance Transforms of Sampled Functions, 2012).
pub fn distances(free: &[bool], width: usize, height: usize) -> Distances {
    let mut above = vec![0i32; free.len()];
    for x in 0..width {
        // The row of the nearest occupied cell in the column at or above each cell, then the same from
        // below.
        let mut last = -1;
        for y in 0..height {
            if !free[y * width + x] {
                last = y as i32;
            }
            above[y * width + x] = last;
        }
        let mut next = height as i32;
        for y in (0..height).rev() {
            let cell = y * width + x;
            if !free[cell] {
                next = y as i32;
            }
            if next - (y as i32) < y as i32 - above[cell] {
                above[cell] = next;
            }
        }
    }
    let mut squared = vec![0u32; free.len()];
    let mut nearest = vec![(0, 0); free.len()];
    // Parabolas of the row's envelope: the column (including one outside on either side) and from where
    // each is lowest.
    let mut columns: Vec<i32> = Vec::with_capacity(width + 2);
    let mut from: Vec<f64> = Vec::with_capacity(width + 2);
    for y in 0..height {
        let row = &above[y * width..(y + 1) * width];
        let height_at = |x: i32| -> i64 {
            let Some(&row) = usize::try_from(x).ok().and_then(|x| row.get(x)) else { return 0 };
            let dy = i64::from(row) - y as i64;
            dy * dy
        };
        columns.clear();
        from.clear();
        for x in -1..=width as i32 {
            let this = height_at(x) + i64::from(x) * i64::from(x);
            while let (Some(&last), Some(&start)) = (columns.last(), from.last()) {
                let that = height_at(last) + i64::from(last) * i64::from(last);
                let meet = (this - that) as f64 / (2 * (x - last)) as f64;
                if meet <= start {
                    columns.pop();
                    from.pop();
                } else {
                    from.push(meet);
                    break;
                }
            }
            if columns.is_empty() {
                from.push(f64::NEG_INFINITY);
            }
            columns.push(x);
        }
        let mut current = 0;
        for x in 0..width {
            while from.get(current + 1).is_some_and(|&start| start < x as f64) {
                current += 1;
            }
            let column = columns[current];
            let dx = i64::from(column) - x as i64;
            let cell = y * width + x;
            squared[cell] = u32::try_from(dx * dx + height_at(column)).unwrap_or(u32::MAX);
            let at = usize::try_from(column).ok().and_then(|column| row.get(column));
            nearest[cell] = (column, at.map_or(y as i32, |&row| row));
        }
    }
    Distances { squared, nearest }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn distances_are_those_of_a_search_over_all_cells(
            width in 1usize..12, height in 1usize..12, seed in proptest::collection::vec(0u8..6, 144),
        ) {
            let free: Vec<bool> = (0..width * height).map(|cell| seed[cell] > 0).collect();
            let found = distances(&free, width, height);
            let taken: Vec<(i64, i64)> = (-1..=height as i64)
                .flat_map(|y| (-1..=width as i64).map(move |x| (x, y)))
                .filter(|&(x, y)| {
                    let inside = (0..width as i64).contains(&x) && (0..height as i64).contains(&y);
                    !inside || !free[y as usize * width + x as usize]
                })
                .collect();
            for cell in 0..free.len() {
                let (x, y) = ((cell % width) as i64, (cell / width) as i64);
                let best = taken.iter().map(|&(tx, ty)| (tx - x).pow(2) + (ty - y).pow(2)).min().unwrap();
                prop_assert_eq!(i64::from(found.squared[cell]), best);
                let (nx, ny) = found.nearest[cell];
                prop_assert!(taken.contains(&(i64::from(nx), i64::from(ny))));
                prop_assert_eq!((i64::from(nx) - x).pow(2) + (i64::from(ny) - y).pow(2), best);
            }
        }
    }
}
