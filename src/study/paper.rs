//! The figures reported in the paper, from `assets/paper_figures.toml`, to print beside ours.

use std::collections::BTreeMap;

use serde::Deserialize;

use crate::labels::Label;

/// The paper's figures. Percentages, as printed.
#[derive(Debug, Deserialize)]
pub struct PaperFigures {
    /// Fig. 4, by set (`house`, `school`, `office`, `standard`).
    pub accuracy: BTreeMap<String, Accuracy>,
    confusion: Confusions,
    /// Table 2, by set and the label's letter.
    pub rooms: BTreeMap<String, BTreeMap<String, Rooms>>,
    /// Accuracy of one typology's classifiers on another's rooms, by `<data>_by_<model>`, then by
    /// algorithm or `average`: mean and deviation.
    cross: BTreeMap<String, BTreeMap<String, [f64; 2]>>,
}

/// Accuracy and its deviation, averaged over the algorithms.
#[derive(Clone, Copy, Debug, Deserialize)]
pub struct Accuracy {
    pub mean: f64,
    pub deviation: f64,
}

#[derive(Debug, Deserialize)]
struct Confusions {
    /// The order of rows and columns.
    labels: Vec<String>,
    #[serde(flatten)]
    of_set: BTreeMap<String, Confusion>,
}

/// One matrix of Table 1, in the order that the file states.
#[derive(Debug, Deserialize)]
struct Confusion {
    rows: [[f64; 5]; 5],
    true_negatives: [f64; 5],
    false_negatives: [f64; 5],
}

/// One matrix of Table 1, in the order of [`Label::ALL`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PaperConfusion {
    pub rows: [[f64; 5]; 5],
    pub true_negatives: [f64; 5],
    pub false_negatives: [f64; 5],
}

/// One line of Table 2.
#[derive(Clone, Copy, Debug, Deserialize)]
pub struct Rooms {
    pub share: f64,
    /// Mean and deviation.
    pub area_m2: [f64; 2],
    /// Mean and deviation.
    pub doors: [f64; 2],
    pub axes_ratio: f64,
}

impl PaperFigures {
    /// The bundled figures; `None` if the asset cannot be read, which a test rules out.
    pub fn bundled() -> Option<Self> {
        toml::from_str(include_str!("../../assets/paper_figures.toml")).ok()
    }

    /// Table 1 for a set.
    pub fn confusion(&self, set: &str) -> Option<PaperConfusion> {
        let printed = self.confusion.of_set.get(set)?;
        let mut place = [0; 5];
        for label in Label::ALL {
            place[label.index()] = self.confusion.labels.iter().position(|letter| letter == label.letter())?;
        }
        Some(PaperConfusion {
            rows: std::array::from_fn(|row| std::array::from_fn(|column| printed.rows[place[row]][place[column]])),
            true_negatives: std::array::from_fn(|label| printed.true_negatives[place[label]]),
            false_negatives: std::array::from_fn(|label| printed.false_negatives[place[label]]),
        })
    }

    /// Accuracy of the classifiers of `model` on the rooms of `data`: mean and deviation. `algorithm` is
    /// an algorithm's name or `average`.
    pub fn cross(&self, data: &str, model: &str, algorithm: &str) -> Option<[f64; 2]> {
        self.cross.get(&format!("{data}_by_{model}"))?.get(algorithm).copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bundled_figures_read() {
        let figures = PaperFigures::bundled().expect("the asset reads");
        assert_eq!(figures.accuracy["standard"].mean, 73.6);
        let confusion = figures.confusion("house").expect("Table 1 has houses");
        assert_eq!(confusion.rows[Label::SmallRoom.index()][Label::MediumRoom.index()], 4.5);
        assert_eq!(confusion.true_negatives[Label::Hall.index()], 98.5);
        assert_eq!(figures.cross("house", "school", "knn"), Some([41.2, 0.4]));
        assert_eq!(figures.rooms["office"]["B"].area_m2, [31.3, 12.2]);
    }
}
