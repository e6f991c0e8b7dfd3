//! Numbers about numbers: means, medians, quantiles.

/// The mean; `None` of nothing.
pub fn mean(numbers: impl IntoIterator<Item = f64>) -> Option<f64> {
    let (count, sum) = numbers.into_iter().fold((0_u32, 0.0), |(count, sum), number| (count + 1, sum + number));
    (count > 0).then(|| sum / f64::from(count))
}

/// The middle value; of an even number, the lower of the two in the middle. `None` of nothing. The values
/// change their order.
pub fn lower_median(values: &mut [f64]) -> Option<f64> {
    let middle = values.len().checked_sub(1)? / 2;
    Some(*values.select_nth_unstable_by(middle, f64::total_cmp).1)
}

/// The middle value; of an even number, the upper of the two in the middle. `None` of nothing. The values
/// change their order.
pub fn upper_median(values: &mut [f64]) -> Option<f64> {
    let middle = values.len() / 2;
    if values.is_empty() { None } else { Some(*values.select_nth_unstable_by(middle, f64::total_cmp).1) }
}

/// The number below which this share of sorted numbers lies, between neighbours in proportion; 0 of none.
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
