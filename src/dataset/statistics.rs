use std::fmt::Write as _;

use super::Row;
use crate::labels::Label;

/// Mean and deviation of a feature.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Moments {
    pub mean: f64,
    /// Sample standard deviation (n - 1 in the denominator); 0 for fewer than two values.
    pub deviation: f64,
}

impl Moments {
    /// The moments of values, by Welford's method (1962), which is numerically stable.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Self {
        let (mut count, mut mean, mut squares) = (0.0, 0.0, 0.0);
        for value in values {
            count += 1.0;
            let off = value - mean;
            mean += off / count;
            squares += off * (value - mean);
        }
        Self { mean, deviation: if count > 1.0 { f64::sqrt(squares / (count - 1.0)) } else { 0.0 } }
    }
}

/// One line of the paper's Table 2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LabelStatistics {
    pub label: Label,
    pub rooms: usize,
    /// Share of all rooms, 0..=1.
    pub share: f64,
    pub area_m2: Moments,
    pub doors: Moments,
    pub axes_ratio: Moments,
}

/// The paper's Table 2 for a set of rows.
#[derive(Clone, Debug, PartialEq)]
pub struct Statistics {
    pub rooms: usize,
    pub buildings: usize,
    /// In the order of [`Label::ALL`].
    pub labels: [LabelStatistics; 5],
}

impl Statistics {
    pub fn of<'a>(rows: impl IntoIterator<Item = &'a Row>) -> Self {
        let rows: Vec<&Row> = rows.into_iter().collect();
        let mut buildings: Vec<(&str, &str)> = rows
            .iter()
            .map(|row| (row.typology.as_ref().map_or("", crate::labels::Typology::as_str), row.building.as_str()))
            .collect();
        buildings.sort_unstable();
        buildings.dedup();
        let labels = Label::ALL.map(|label| {
            let of_label: Vec<&Row> = rows.iter().copied().filter(|row| row.label == label).collect();
            LabelStatistics {
                label,
                rooms: of_label.len(),
                share: of_label.len() as f64 / rows.len().max(1) as f64,
                area_m2: Moments::of(of_label.iter().map(|row| row.features.area_m2)),
                doors: Moments::of(of_label.iter().map(|row| f64::from(row.features.doors))),
                axes_ratio: Moments::of(of_label.iter().map(|row| row.features.axes_ratio)),
            }
        });
        Self { rooms: rows.len(), buildings: buildings.len(), labels }
    }

    /// The table as text, in the columns of the paper's Table 2, under a title.
    pub fn table(&self, title: &str) -> String {
        let mut text = format!("{title}: {} rooms in {} buildings\n", self.rooms, self.buildings);
        text.push_str("  label          rooms      %    area a (m²)       doorways d     rt = M/m\n");
        text.push_str("                                  µ        σ       µ       σ          µ\n");
        for line in &self.labels {
            let name = format!("{} {}", line.label.letter(), line.label.name());
            // Writing to a String cannot fail.
            let _ = write!(text, "  {name:<13} {:>6} {:>6.1}", line.rooms, 100.0 * line.share);
            if line.rooms == 0 {
                text.push_str("        –        –       –       –          –\n");
                continue;
            }
            let (a, d) = (line.area_m2, line.doors);
            let rt = line.axes_ratio.mean;
            let _ =
                writeln!(text, " {:>8.1} {:>8.1} {:>7.1} {:>7.1} {rt:>10.1}", a.mean, a.deviation, d.mean, d.deviation);
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments() {
        let moments = Moments::of([2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0]);
        assert_eq!(moments.mean, 5.0);
        // Sum of squares 32 over 7.
        assert!((moments.deviation - (32.0_f64 / 7.0).sqrt()).abs() < 1e-12);
        assert_eq!(Moments::of([]), Moments::default());
    }
}
