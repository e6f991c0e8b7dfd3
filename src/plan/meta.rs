use super::Extra;
use crate::labels::Typology;

/// Metadata of a plan. Empty text means unknown.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Meta {
    /// The plan's name, as shown in lists and titles.
    pub name: String,
    /// The building this storey belongs to: the unit that cross-validation must never split.
    pub building: String,
    /// The storey of the building, as written on the drawing ('ground floor', '2').
    pub storey: String,
    pub typology: Option<Typology>,
    pub scale: Scale,
    /// Where the plan comes from: a file, a book, an address.
    pub source: String,
    /// The licence under which the source may be used.
    pub licence: String,
    /// Fields from a newer file version, kept for saving.
    pub extra: Extra,
}

impl Meta {
    /// The building; where none is stated, the plan is one of its own.
    pub fn building_or_name(&self) -> &str {
        if self.building.is_empty() { &self.name } else { &self.building }
    }
}

/// How the plan got its scale. Scale is uncertain in real plans, so its origin is kept with it and shown.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scale {
    pub origin: ScaleOrigin,
    /// Metres per unit of the source (a pixel, a drawing unit), if it had one.
    pub metres_per_unit: Option<f64>,
    /// How it was found or repaired, in words.
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
    /// Estimated from usual sizes (door widths, sanitary rooms), by the source or by Enfilade.
    Estimated,
}

impl ScaleOrigin {
    pub const ALL: [Self; 5] = [Self::Unknown, Self::Drawn, Self::Measured, Self::Imported, Self::Estimated];

    /// Its name in files and in the interface.
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
