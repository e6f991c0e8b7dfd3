use std::sync::Arc;

use super::{CornerId, Extra, RoomId};
use crate::geometry::{Homography, Point, Vector, trim_m};
use crate::labels::Label;

/// A point shared by walls and room boundaries.
#[derive(Clone, Debug, PartialEq)]
pub struct Corner {
    /// On the 0.1 mm grid.
    pub position: Point,
    pub extra: Extra,
}

/// A straight piece between two corners.
#[derive(Clone, Debug, PartialEq)]
pub struct Wall {
    pub from: CornerId,
    pub to: CornerId,
    /// In metres, 0 (a line) or more; centred on the line between the corners.
    pub thickness_m: f64,
    pub extra: Extra,
}

/// An area bounded by corners. Its identity survives edits.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Room {
    /// The outer boundary: at least three corners in either direction, the first not repeated. Empty for
    /// a room that a file names without a boundary.
    pub outer: Arc<[CornerId]>,
    /// Holes (courtyards, shafts, islands): rings inside the outer one.
    pub holes: Vec<Arc<[CornerId]>>,
    /// What the room is for, as the source or the user wrote it; empty when unknown.
    pub function: String,
    /// A label given to this room itself; without one, the label scheme's label for the function applies.
    pub label: Option<RoomLabel>,
    /// What is written in the room ('1.23', 'Library'); empty when unnamed.
    pub name: String,
    pub note: String,
    /// Where its name and its area are written, from the middle of its bounding box, in metres; `None` leaves the place
    /// to the drawing code.
    pub text_offset: Option<Vector>,
    /// The room's id in the file it was imported from (a UUID, 'R12'); empty when drawn here. Lets a row
    /// of a dataset be traced back to its source.
    pub source_id: String,
    pub extra: Extra,
}

impl Room {
    /// All rings, the outer one first.
    pub fn rings(&self) -> impl Iterator<Item = &Arc<[CornerId]>> {
        std::iter::once(&self.outer).chain(&self.holes)
    }

    /// Its own label; a prediction that nobody has accepted is none.
    pub fn given_label(&self) -> Option<RoomLabel> {
        self.label.filter(|given| given.origin != LabelOrigin::Prediction)
    }

    /// Whether the room has a boundary at all.
    pub fn has_boundary(&self) -> bool {
        !self.outer.is_empty()
    }
}

/// A label and who gave it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RoomLabel {
    pub label: Label,
    pub origin: LabelOrigin,
}

/// Who gave a label.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LabelOrigin {
    /// A person, in Enfilade.
    Person,
    /// The imported file stated it.
    Imported,
    /// A prediction that a person accepted.
    AcceptedPrediction,
    /// A classifier's prediction that nobody has reviewed: shown as such, never taken as ground truth.
    Prediction,
}

impl LabelOrigin {
    pub const ALL: [Self; 4] = [Self::Person, Self::Imported, Self::AcceptedPrediction, Self::Prediction];

    /// Its name in files and in the interface.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Person => "person",
            Self::Imported => "imported",
            Self::AcceptedPrediction => "accepted prediction",
            Self::Prediction => "prediction",
        }
    }
}

/// What an opening is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum OpeningKind {
    /// A doorway with one leaf.
    Door,
    /// A doorway with two leaves.
    DoubleDoor,
    /// A passage without a door.
    Passage,
    /// A window: for drawing only, it joins nothing and does not count in `d`.
    Window,
}

impl OpeningKind {
    pub const ALL: [Self; 4] = [Self::Door, Self::DoubleDoor, Self::Passage, Self::Window];

    /// Its name in files and in the interface.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Door => "door",
            Self::DoubleDoor => "double door",
            Self::Passage => "passage",
            Self::Window => "window",
        }
    }

    /// Whether one can walk through it: true for all but windows.
    pub const fn is_passable(self) -> bool {
        !matches!(self, Self::Window)
    }
}

/// A doorway, free passage or window.
#[derive(Clone, Debug, PartialEq)]
pub struct Opening {
    pub kind: OpeningKind,
    pub place: Place,
    /// How a door's leaf opens; `None` lets the drawing choose.
    pub swing: Option<Swing>,
    /// The two sides it joins, if a file or the user states them; `None` when they follow from geometry.
    pub pinned: Option<[Joint; 2]>,
    /// Like [`Room::source_id`].
    pub source_id: String,
    pub extra: Extra,
}

/// Where an opening is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Place {
    /// On the edge between two corners, part of a wall or a room's boundary.
    Hosted {
        from: CornerId,
        to: CornerId,
        /// Distance in metres from the corner `from` to the opening's middle, along the edge.
        at_m: f64,
        /// Clear width in metres, above 0.
        width_m: f64,
    },
    /// A segment of its own, when an import gives no host.
    Free { from: Point, to: Point },
}

/// One side of a pinned opening.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Joint {
    Room(RoomId),
    Outside,
}

impl Joint {
    pub const fn room(self) -> Option<RoomId> {
        match self {
            Self::Room(id) => Some(id),
            Self::Outside => None,
        }
    }
}

/// How a door's leaf opens, seen along its segment from its first end to its second.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Swing {
    /// Whether the hinge is at the first end of the segment (else at the second). A double door has
    /// one at each.
    pub hinge_at_start: bool,
    /// The side into which the leaf opens.
    pub side: LeafSide,
}

/// A side of a directed segment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LeafSide {
    Left,
    Right,
}

impl LeafSide {
    /// The opposite side.
    pub const fn other(self) -> Self {
        match self {
            Self::Left => Self::Right,
            Self::Right => Self::Left,
        }
    }
}

/// A backdrop: a picture under the plan, to trace over.
#[derive(Clone, Debug, PartialEq)]
pub struct Backdrop {
    /// Path relative to the plan's file, with forward slashes; absolute while the plan is unsaved.
    pub path: String,
    /// Hash of the picture's bytes (`sha256:` and 64 hexadecimal digits), to find it again after it
    /// moves; empty when unknown.
    pub content_hash: String,
    /// The page of the document, from 1; 1 for pictures.
    pub page: u32,
    /// The position of the picture's upper left corner in the plan.
    pub origin: Point,
    /// Size of a pixel in metres.
    pub metres_per_pixel: f64,
    /// Counter-clockwise rotation about `origin` in radians.
    pub rotation_rad: f64,
    /// From 0, invisible, to 1, opaque.
    pub opacity: f64,
    /// The measurements that gave its scale.
    pub measurements: Vec<Measurement>,
    /// How a photographed drawing is made flat; `None` for a picture that is shown as it is. All other places on the
    /// picture, such as its measurements, are places on what is shown.
    pub rectification: Option<Rectification>,
    pub extra: Extra,
}

/// How a photographed drawing is made flat: by four corners of a rectangle of the drawing. The file stays as it is.
#[derive(Clone, Debug, PartialEq)]
pub struct Rectification {
    /// The corners on the picture in its file, in pixels from its upper left corner, x to the right and y down: the
    /// upper left, upper right, lower right and lower left one.
    pub corners: [Point; 4],
    /// The same rectangle on the picture that is shown: its upper left and its lower right corner, in pixels.
    pub rectangle: [Point; 2],
    /// Width and height of the picture that is shown, in pixels.
    pub size_px: [u32; 2],
}

impl Rectification {
    /// The corners on the picture that is shown, in the order of `corners`.
    pub const fn shown_corners(&self) -> [Point; 4] {
        let [min, max] = self.rectangle;
        [min, Point::new(max.x, min.y), max, Point::new(min.x, max.y)]
    }

    /// Where the places of the picture that is shown lie in its file; `None` where the corners make no rectangle.
    pub fn source_from_shown(&self) -> Option<Homography> {
        Homography::between(self.shown_corners(), self.corners)
    }
}

/// A known length on the backdrop.
#[derive(Clone, Debug, PartialEq)]
pub struct Measurement {
    /// Its ends in pixels from the picture's upper left corner, x to the right, y down.
    pub from: Point,
    pub to: Point,
    /// Its true length in metres, above 0.
    pub length_m: f64,
}

impl Measurement {
    /// The distance between its ends in pixels of the picture.
    pub fn length_px(&self) -> f64 {
        self.from.distance(self.to)
    }
}

impl Opening {
    /// An opening of a kind at a place; nothing pinned, its swing left to the drawing code.
    pub const fn new(kind: OpeningKind, place: Place) -> Self {
        Self { kind, place, swing: None, pinned: None, source_id: String::new(), extra: None }
    }

    /// The same opening with its lengths rounded to the 0.1 mm grid.
    pub fn trimmed(mut self) -> Self {
        self.place = match self.place {
            Place::Hosted { from, to, at_m, width_m } => {
                Place::Hosted { from, to, at_m: trim_m(at_m), width_m: trim_m(width_m) }
            }
            Place::Free { from, to } => Place::Free { from: from.trimmed(), to: to.trimmed() },
        };
        self
    }
}
