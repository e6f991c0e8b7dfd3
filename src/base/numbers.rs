//! Statistics: means, medians, quantiles.

/// The mean; `None` if there are no numbers.
pub fn mean(numbers: impl IntoIterator<Item = f64>) -> Option<f64> {
    let (count, sum) = numbers.into_iter().fold((0_u32, 0.0), |(count, sum), number| (count + 1, sum + number));
    (count > 0).then(|| sum / f64::from(count))
}

/// The median; for an even count, the lower of the two middle values. `None` if empty. Reorders the
/// values.
pub fn lower_median(values: &mut [f64]) -> Option<f64> {
    let middle = values.len().checked_sub(1)? / 2;
    Some(*values.select_nth_unstable_by(middle, f64::total_cmp).1)
}

/// The median; for an even count, the upper of the two middle values. `None` if empty. Reorders the
/// values.
pub fn upper_median(values: &mut [f64]) -> Option<f64> {
    let middle = values.len() / 2;
    if values.is_empty() { None } else { Some(*values.select_nth_unstable_by(middle, f64::total_cmp).1) }
}

/// The quantile at `share` (0..=1) of sorted numbers, linearly interpolated; 0 if empty.
pub fn quantile(sorted: &[f64], share: f64) -> f64 {
    let Some(last) = sorted.len().checked_sub(1) else { return 0.0 };
    let at = share * last as f64;
    let below = at.floor() as usize;
    sorted[below] + (at - below as f64) * (sorted[(below + 1).min(last)] - sorted[below])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_few_and_of_none() {
        assert_eq!((mean([]), mean([1.0, 2.0])), (None, Some(1.5)));
        let mut four = [4.0, 1.0, 3.0, 2.0];
        assert_eq!((lower_median(&mut four), upper_median(&mut four)), (Some(2.0), Some(3.0)));
        assert_eq!((lower_median(&mut []), upper_median(&mut [])), (None, None));
        assert_eq!((quantile(&[], 0.5), quantile(&[1.0, 2.0], 0.25)), (0.0, 1.25));
    }
}
