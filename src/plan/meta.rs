use super::Extra;
use crate::labels::Typology;

/// What is known of a plan as a whole. Empty text means unknown.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Meta {
    /// The plan's name, as shown in lists and titles.
    pub name: String,
    /// The building this storey belongs to: the unit that cross-validation must never split.
    pub building: String,
    /// Which storey of the building, as written on the drawing ('ground floor', '2').
    pub storey: String,
    pub typology: Option<Typology>,
    pub scale: Scale,
    /// Where the plan comes from: a file, a book, an address.
    pub source: String,
    /// The licence under which the source may be used.
    pub licence: String,
    /// Fields of a newer file, kept.
    pub extra: Extra,
}

/// How the plan came by its metres. Scale is a doubtful quantity in real plans, so its origin stays
/// with it and is shown.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scale {
    pub origin: ScaleOrigin,
    /// Metres that one unit of the source (a pixel, a drawing unit) stands for, where there was one.
    pub metres_per_unit: Option<f64>,
    /// How it was found or healed, in words.
    pub note: String,
}

/// Where a scale comes from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ScaleOrigin {
    /// Nothing is known.
    #[default]
    Unknown,
    /// Drawn in metres from the start.
    Drawn,
    /// Measured on a backdrop between points of known distance.
    Measured,
    /// Stated by the imported file.
    Imported,
    /// Estimated from what is usual (door widths, sanitary rooms), by the source or by us.
    Estimated,
}

impl ScaleOrigin {
    pub const ALL: [Self; 5] = [Self::Unknown, Self::Drawn, Self::Measured, Self::Imported, Self::Estimated];

    /// The word for files and for people.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Unknown => "unknown",
            Self::Drawn => "drawn",
            Self::Measured => "measured",
            Self::Imported => "imported",
            Self::Estimated => "estimated",
        }
    }
}
