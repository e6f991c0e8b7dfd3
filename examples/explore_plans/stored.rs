//! What an exploration saw, kept in a file, so that rooms can be found in it again without exploring.

use std::error::Error;
use std::path::Path;

use enfilade::geometry::areas::Shapes;
use enfilade::geometry::{Point, Segment};
use serde_json::{Value, json};

/// What is kept of an exploration, in the map's frame but for the start.
pub struct Stored {
    /// In the world's frame.
    pub start: Point,
    /// The lines of the map that rooms are found by.
    pub walls: Vec<Segment>,
    pub free: Shapes,
    pub gave_up: bool,
    /// Processor time of the exploration.
    pub seconds: f64,
}

impl Stored {
    pub fn read(path: &Path) -> Result<Self, Box<dyn Error>> {
        let value: Value = serde_json::from_slice(&std::fs::read(path)?)?;
        let [x, y]: [f64; 2] = serde_json::from_value(value["start"].clone())?;
        let walls: Vec<[[f64; 2]; 2]> = serde_json::from_value(value["walls"].clone())?;
        let wall = |[a, b]: [[f64; 2]; 2]| Segment::new(Point::new(a[0], a[1]), Point::new(b[0], b[1]));
        Ok(Self {
            start: Point::new(x, y),
            walls: walls.into_iter().map(wall).collect(),
            free: serde_json::from_value(value["free"].clone())?,
            gave_up: value["gave_up"].as_bool().unwrap_or_default(),
            seconds: value["seconds"].as_f64().unwrap_or_default(),
        })
    }

    pub fn write(&self, path: &Path) -> Result<(), Box<dyn Error>> {
        let walls: Vec<[[f64; 2]; 2]> = self.walls.iter().map(|s| [[s.a.x, s.a.y], [s.b.x, s.b.y]]).collect();
        let Self { start, free, gave_up, seconds, .. } = self;
        let value = json!({
            "start": [start.x, start.y], "walls": walls, "free": free, "gave_up": gave_up, "seconds": seconds,
        });
        Ok(std::fs::write(path, serde_json::to_vec(&value)?)?)
    }
}
