//! The features `F_r = <a, rt, d, l_S, l_M, l_B, l_C, l_H>` of every room (paper, section 3.2).

mod analysis;
pub mod temporary;

pub use analysis::{Analysis, RoomAnalysis, RoomStatus, analyse, analyse_after};

use crate::labels::Label;

/// `F_r`: a classifier's input for a room.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Features {
    /// `a`: area in m², less holes.
    pub area_m2: f64,
    /// `rt = M / m`: the axes ratio.
    pub axes_ratio: f64,
    /// `d`: number of openings, including those to the outside or to unlabelled space.
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

/// Which labels of its neighbours count in a room's features.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum NeighbourLabels {
    /// The true label if there is one, else the naive classifier's temporary label: the paper's way.
    /// Flatters a classifier, since in use the true labels are not known.
    #[default]
    True,
    /// The naive classifier's temporary label for every neighbour.
    Temporary,
    /// The known label or, if there is none, the one a classifier predicts; repeated until no prediction
    /// changes. Needs a classifier: features alone are those of the first round, the same as with
    /// [`NeighbourLabels::True`].
    Predicted,
}

impl NeighbourLabels {
    pub const ALL: [Self; 3] = [Self::True, Self::Temporary, Self::Predicted];

    /// Those that need no classifier.
    pub const WITHOUT_CLASSIFIER: [Self; 2] = [Self::True, Self::Temporary];

    /// Its name in files and in the interface.
    pub const fn name(self) -> &'static str {
        match self {
            Self::True => "true",
            Self::Temporary => "temporary",
            Self::Predicted => "predicted",
        }
    }
}
