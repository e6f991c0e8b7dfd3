//! The features `F_r = <a, rt, d, l_S, l_M, l_B, l_C, l_H>` of every room (paper, section 3.2).

mod analysis;
pub mod temporary;

pub use analysis::{Analysis, RoomAnalysis, RoomStatus, analyse};

use crate::labels::Label;

/// `F_r`: what a classifier knows of a room.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Features {
    /// `a`: area in m², holes taken off.
    pub area_m2: f64,
    /// `rt = M / m`: the axes ratio.
    pub axes_ratio: f64,
    /// `d`: number of openings, those to the outside or to unlabelled space included.
    pub doors: u32,
    /// `l_s`: number of openings that lead to a room labelled s, in the order of [`Label::ALL`].
    pub doors_to: [u32; 5],
}

impl Features {
    /// Names of the eight features in their fixed order, as in files and the paper.
    pub const NAMES: [&'static str; 8] = ["a", "rt", "d", "l_S", "l_M", "l_B", "l_C", "l_H"];

    /// The position of a feature's name in [`Features::NAMES`].
    pub fn index(name: &str) -> Option<usize> {
        Self::NAMES.iter().position(|feature| *feature == name)
    }

    /// The eight values in the order of [`Features::NAMES`].
    pub fn values(&self) -> [f64; 8] {
        let l = self.doors_to.map(f64::from);
        [self.area_m2, self.axes_ratio, f64::from(self.doors), l[0], l[1], l[2], l[3], l[4]]
    }

    /// Number of openings that lead to a room with this label.
    pub fn doors_to(&self, label: Label) -> u32 {
        self.doors_to[label.index()]
    }
}

/// Which labels of its neighbours a room's features count.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum NeighbourLabels {
    /// The true label where there is one, else the temporary label of the naive classifier: the
    /// paper's way. Flatters a classifier, since in use the true labels are not known.
    #[default]
    True,
    /// The temporary label of the naive classifier for every neighbour.
    Temporary,
    /// The label that a classifier predicts for the neighbour, where none is known; predictions are
    /// repeated until none changes. Needs a classifier: features alone are those of the first round,
    /// the same as with [`NeighbourLabels::True`].
    Predicted,
}

impl NeighbourLabels {
    pub const ALL: [Self; 3] = [Self::True, Self::Temporary, Self::Predicted];

    /// Those that need no classifier.
    pub const WITHOUT_CLASSIFIER: [Self; 2] = [Self::True, Self::Temporary];

    /// The word for files and for people.
    pub const fn name(self) -> &'static str {
        match self {
            Self::True => "true",
            Self::Temporary => "temporary",
            Self::Predicted => "predicted",
        }
    }
}
