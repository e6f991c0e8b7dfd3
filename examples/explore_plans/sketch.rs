//! The picture of an exploration's outcome: what was found in colour over the true rooms' outlines.

use enfilade::draw::scene::{Anchor, Frame, Group, Item, Layer, Length, Scene, Text, View, Weight};
use enfilade::draw::{Rgba, png};
use enfilade::geometry::areas::{self, Shapes};
use enfilade::geometry::{Point, Segment, Vector};
use enfilade::picture::png::PictureError;
use enfilade::plan::Joint;
use enfilade::robot::World;
use enfilade::robot::rooms::FoundRooms;
use enfilade::robot::score::{Fate, Score};

/// What to draw, in the world's frame.
pub struct Outcome<'a> {
    pub world: &'a World,
    pub score: &'a Score,
    pub walls: Vec<Segment>,
    pub free: Shapes,
    pub rooms: Vec<Shapes>,
    pub found: &'a FoundRooms,
    /// The doorways found.
    pub doorways: Vec<Segment>,
}

const SIDE_PX: f64 = 1600.0;

/// Fills of rooms in turn.
const FILLS: [u32; 8] = [0xbcd8f0, 0xf5d6b0, 0xc9e6c3, 0xe6c9e3, 0xf3eaa5, 0xb9e4e0, 0xf2c4c4, 0xd5d0f0];

impl Outcome<'_> {
    /// The picture: found rooms filled, walls of the map black, free floor that is no room grey; outlines of true rooms
    /// green if found, red if not, thin grey if out of reach; doorways blue, red where they join what is not joined;
    /// doors that were not found magenta.
    pub fn png(&self) -> Result<Vec<u8>, PictureError> {
        let bounds = self.world.bounds();
        let scale = SIDE_PX / bounds.width().max(bounds.height()).max(1.0);
        let side = |metres: f64| (metres * scale).ceil() + 40.0;
        let view = View::fitting(bounds, side(bounds.width()), side(bounds.height()), 20.0);
        let line = |points: Vec<Point>, closed, colour, px| Item::Line {
            points,
            closed,
            colour: Rgba::hex(colour),
            width: Length::Px(px),
            dash: None,
        };
        let filled = |shapes: &Shapes, colour| -> Vec<Item> {
            let pieces = areas::pieces(shapes).into_iter();
            pieces.map(|(outer, holes)| Item::Polygon { outer, holes, colour: Rgba::hex(colour) }).collect()
        };
        let mut items = filled(&self.free, 0xe4e4e4);
        for (index, room) in self.rooms.iter().enumerate() {
            items.extend(filled(room, FILLS[index % FILLS.len()]));
        }
        items.extend(self.walls.iter().map(|wall| line(vec![wall.a, wall.b], false, 0x000000, 1.5)));
        let mut texts = Vec::new();
        for room in self.world.rooms() {
            let of_room = self.score.rooms.iter().find(|score| score.id == room.id);
            let (colour, px) = match of_room.map(|score| score.fate) {
                Some(Fate::Found) => (0x2a8a2a, 1.0),
                Some(_) => (0xd02020, 3.0),
                None => (0xa0a0a0, 1.0),
            };
            for ring in room.floor.iter().flatten() {
                items.push(line(areas::points(ring), true, colour, px));
            }
            if let Some(score) = of_room
                && let Some(ring) = room.floor.iter().flatten().next()
            {
                let at = enfilade::geometry::polygon::centroid(&areas::points(ring));
                let content = match score.fate {
                    Fate::Found => room.id.to_string(),
                    fate => format!("{} {} {:.2}", room.id, fate.name(), score.iou),
                };
                texts.push(Item::Text(Text {
                    at,
                    offset_px: Vector::new(0.0, 0.0),
                    content,
                    size_px: 13.0,
                    weight: Weight::SemiBold,
                    colour: Rgba::hex(colour),
                    halo: Some(Rgba::hex(0xffffff)),
                    anchor: Anchor::Middle,
                    upright: false,
                }));
            }
        }
        for opening in self.world.openings() {
            if let [Joint::Room(p), Joint::Room(q)] = opening.sides {
                let pair = (p.min(q), p.max(q));
                if self.score.true_edges.contains(&pair) && !self.score.right_edges.contains(&pair) {
                    items.push(line(vec![opening.segment.a, opening.segment.b], false, 0xe000e0, 7.0));
                }
            }
        }
        for (doorway, sides) in self.doorways.iter().zip(&self.found.sides) {
            let is_wrong = match sides {
                [Some(p), Some(q)] => self.score.wrong_pairs.contains(&(*p.min(q), *p.max(q))),
                _ => false,
            };
            let colour = if is_wrong { 0xff0000 } else { 0x1040ff };
            items.push(line(vec![doorway.a, doorway.b], false, colour, 4.0));
        }
        let groups = vec![Group::new(Layer::Rooms, Frame::Plan, items), Group::new(Layer::Names, Frame::Plan, texts)];
        png::png(&Scene { view, background: Rgba::hex(0xffffff), groups })
    }
}
