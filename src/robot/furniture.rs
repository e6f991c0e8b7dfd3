//! Furniture for simulated worlds: a readable catalogue of sizes, scattered by a seed.

use serde::Deserialize;

use crate::base::random::Random;
use crate::geometry::{Bounds, Point, Vector, areas, polygon};

/// A kind of furniture.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Piece {
    pub name: String,
    /// Metres; along the wall if it stands against one.
    #[serde(rename = "length")]
    pub length_m: f64,
    #[serde(rename = "width")]
    pub width_m: f64,
    pub at: Standing,
    pub seen: Seen,
    /// Relative frequency.
    pub weight: u32,
}

/// Where a kind of furniture goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Standing {
    /// Against a wall.
    Wall,
    /// Anywhere in the room.
    Room,
}

/// What a scanner 0.3 m above the floor sees of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Seen {
    /// Its outline.
    Box,
    /// Four legs.
    Legs,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Catalogue {
    piece: Vec<Piece>,
}

/// The bundled catalogue, `assets/robot/furniture.toml`.
pub fn bundled_furniture() -> Vec<Piece> {
    // A test reads it; if it failed, rooms would stay empty.
    read_furniture(include_str!("../../assets/robot/furniture.toml")).unwrap_or_default()
}

/// Reads a catalogue of furniture.
///
/// # Errors
/// When the text is invalid; the error is a sentence that says why.
pub fn read_furniture(text: &str) -> Result<Vec<Piece>, String> {
    let catalogue: Catalogue = toml::from_str(text).map_err(|error| error.to_string())?;
    for piece in &catalogue.piece {
        let is_sound = |side_m: f64| (0.05..=10.0).contains(&side_m);
        if !(is_sound(piece.length_m) && is_sound(piece.width_m)) {
            return Err(format!("{}: length and width must lie between 0.05 and 10 m", piece.name));
        }
    }
    Ok(catalogue.piece)
}

/// Side in metres of a leg of a table or chair.
const LEG_M: f64 = 0.05;

/// Clearance of furniture from doorways, in metres: for a door's leaf and a person.
const CLEAR_OF_DOORS_M: f64 = 0.9;

/// Gap between two pieces, and between a free-standing piece and a wall, in metres: so that a robot
/// clearly fits through.
const PASSAGE_M: f64 = 0.7;

/// Distance of a piece from the wall behind it, in metres: skirting boards and habit.
const BEHIND_M: f64 = 0.03;

/// Attempts to place a piece before the room counts as full.
const TRIES: usize = 30;

/// The outlines of up to `count` pieces of furniture in a room, counter-clockwise, as a scanner sees
/// them: one ring for a box, four for a piece with legs. `doors` are points to keep clear of.
pub fn furnish(
    outer: &[Point],
    holes: &[Vec<Point>],
    doors: &[Point],
    catalogue: &[Piece],
    count: usize,
    random: &mut Random,
) -> Vec<Vec<Point>> {
    let total: u32 = catalogue.iter().map(|piece| piece.weight).sum();
    let walls: Vec<_> = polygon::edges(outer).filter(|edge| edge.length() > 0.5).collect();
    if total == 0 || walls.is_empty() {
        return Vec::new();
    }
    let shape: areas::Shapes = vec![
        std::iter::once(areas::directed(outer, true)).chain(holes.iter().map(|h| areas::directed(h, false))).collect(),
    ];
    let bounds = Bounds::of(outer.iter().copied());
    let turned = if polygon::signed_area(outer) < 0.0 { -1.0 } else { 1.0 };
    let mut placed: Vec<Vec<Point>> = Vec::new();
    let mut seen: Vec<Vec<Point>> = Vec::new();
    for _ in 0..count {
        let mut draw = random.below(total as usize) as u32;
        let piece = catalogue.iter().find(|piece| {
            let is_drawn = draw < piece.weight;
            draw = draw.saturating_sub(piece.weight);
            is_drawn
        });
        let Some(piece) = piece else { continue };
        for _ in 0..TRIES {
            let wall = walls[random.below(walls.len())];
            let Some(along) = wall.vector().unit() else { continue };
            let inward = along.left() * turned;
            let (at, along) = match piece.at {
                Standing::Wall => {
                    let free_m = wall.length() - piece.length_m;
                    if free_m <= 0.0 {
                        continue;
                    }
                    let from_m = piece.length_m / 2.0 + random.unit() * free_m;
                    (wall.a + along * from_m + inward * (piece.width_m / 2.0 + BEHIND_M), along)
                }
                Standing::Room => {
                    let at = Point::new(
                        bounds.min.x + random.unit() * bounds.width(),
                        bounds.min.y + random.unit() * bounds.height(),
                    );
                    // Mostly aligned with the walls, sometimes askew.
                    let askew = if random.unit() < 0.3 { random.unit() * std::f64::consts::PI } else { 0.0 };
                    (at, along.rotated(askew))
                }
            };
            let outline = rectangle(at, along, piece.length_m, piece.width_m);
            let margin_m = if piece.at == Standing::Wall { 0.0 } else { PASSAGE_M };
            let needed = rectangle(at, along, piece.length_m + 2.0 * margin_m, piece.width_m + 2.0 * margin_m);
            let is_clear = inside(&needed, &shape)
                && doors.iter().all(|&door| distance_m(&outline, door) >= CLEAR_OF_DOORS_M)
                && placed.iter().all(|other| apart_m(&outline, other) >= PASSAGE_M);
            if is_clear {
                match piece.seen {
                    Seen::Box => seen.push(outline.clone()),
                    Seen::Legs => seen.extend(outline.iter().map(|&corner| {
                        let leg = corner + (at - corner).unit().unwrap_or(along) * LEG_M;
                        rectangle(leg, along, LEG_M, LEG_M)
                    })),
                }
                placed.push(outline);
                break;
            }
        }
    }
    seen
}

/// A counter-clockwise rectangle about a point, its length along a unit vector.
pub(super) fn rectangle(at: Point, along: Vector, length_m: f64, width_m: f64) -> Vec<Point> {
    let (u, v) = (along * (length_m / 2.0), along.left() * (width_m / 2.0));
    vec![at - u - v, at + u - v, at + u + v, at - u + v]
}

/// Whether a convex ring lies within an area.
fn inside(ring: &[Point], shape: &areas::Shapes) -> bool {
    let outside = areas::without(vec![vec![areas::ring(ring)]], &shape.concat());
    areas::area_m2(&outside) < 1e-6
}

fn distance_m(ring: &[Point], point: Point) -> f64 {
    if polygon::locate_in_ring(ring, point) != polygon::Location::Outside {
        return 0.0;
    }
    polygon::edges(ring).map(|edge| edge.distance(point)).fold(f64::INFINITY, f64::min)
}

/// The distance between two convex rings, in metres; 0 if they meet.
fn apart_m(one: &[Point], other: &[Point]) -> f64 {
    let nearest = |ring: &[Point], of: &[Point]| of.iter().map(|&p| distance_m(ring, p)).fold(f64::INFINITY, f64::min);
    nearest(one, other).min(nearest(other, one))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn furniture_stands_in_the_room_and_clear_of_its_door() {
        let room = [(0.0, 0.0), (6.0, 0.0), (6.0, 4.0), (0.0, 4.0)].map(|(x, y)| Point::new(x, y));
        let door = Point::new(3.0, 0.0);
        let catalogue = bundled_furniture();
        assert!(catalogue.len() >= 10);
        let furnish = |seed| furnish(&room, &[], &[door], &catalogue, 6, &mut Random::new(seed));
        for seed in 0..50 {
            let seen = furnish(seed);
            assert_eq!(seen, furnish(seed), "the same for the same seed");
            for ring in &seen {
                assert!(ring.iter().all(|&corner| polygon::locate_in_ring(&room, corner) == polygon::Location::Inside));
                assert!(distance_m(ring, door) >= CLEAR_OF_DOORS_M);
            }
        }
        assert!((0..50).any(|seed| furnish(seed).len() > 4));
    }

    #[test]
    fn a_wrong_catalogue_is_refused() {
        assert!(read_furniture("[[piece]]\nname = 'x'").unwrap_err().contains("missing field"));
        let huge = "[[piece]]\nname='x'\nlength=100.0\nwidth=1.0\nat='wall'\nseen='box'\nweight=1";
        assert!(read_furniture(huge).unwrap_err().contains("between"));
    }
}
