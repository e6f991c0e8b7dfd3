use super::{Check, Context, Kind, Place, Severity};
use crate::geometry::Point;
use crate::labels::Label;
use crate::plan::ElementId;
use crate::plan::titles::RoomName;

/// A room whose axes ratio `rt` no room has: its boundary has a spike or a cut corner that is taken for one
/// of its walls, or it is a gap between rooms that was filled.
#[derive(Clone, Debug, PartialEq)]
pub struct AxesRatioIsImplausible {
    pub room: RoomName,
    pub axes_ratio: f64,
    /// `M` and `m` in metres.
    pub major_m: f64,
    pub minor_m: f64,
    pub at: Point,
}

/// Of 7,392 real rooms the longest corridor has 19.5; twice that is beyond any.
const LONGEST_CORRIDOR: f64 = 40.0;

/// Of the real rooms that are known to be no corridors the longest, an entrance, has 17.8.
const LONGEST_ROOM: f64 = 20.0;

impl Check for AxesRatioIsImplausible {
    const KIND: Kind = Kind {
        name: "axes_ratio_is_implausible",
        title: "Room's axes ratio is implausible",
        severity: Severity::Warning,
        remedy: "look for a spike or a cut corner in its boundary, or a gap drawn as a room",
    };

    fn find(context: &Context) -> Vec<Self> {
        let rooms = context.analysis.rooms.iter().zip(context.shapes()).enumerate();
        rooms
            .filter_map(|(index, (room, shape))| {
                let axes = room.axes?;
                let most = match room.status.label() {
                    None | Some(Label::Corridor) => LONGEST_CORRIDOR,
                    Some(_) => LONGEST_ROOM,
                };
                (axes.ratio() > most && context.is_classified(index)).then(|| Self {
                    room: context.name(index),
                    axes_ratio: axes.ratio(),
                    major_m: axes.major_m,
                    minor_m: axes.minor_m,
                    at: shape.bounds.center(),
                })
            })
            .collect()
    }

    fn size(&self) -> f64 {
        self.axes_ratio
    }

    fn place(&self) -> Place<'_> {
        Place { elements: vec![ElementId::Room(self.room.id)], rooms: vec![&self.room], at: Some(self.at) }
    }

    fn what(&self) -> String {
        format!(
            "{} is {:.0} times as long as wide, by walls of {:.2} m and {:.2} m",
            self.room, self.axes_ratio, self.major_m, self.minor_m
        )
    }

    fn figures(&self) -> Vec<(&'static str, f64)> {
        vec![("axes_ratio", self.axes_ratio), ("major_m", self.major_m), ("minor_m", self.minor_m)]
    }
}
