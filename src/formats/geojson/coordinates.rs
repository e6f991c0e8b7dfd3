use std::fmt;

use serde::de::{Error, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::formats::json_text::Number;
use crate::geometry::Point;

/// The `coordinates` of a geometry of any type, read without knowing the type, since `type` may come
/// after it.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Coordinates {
    Empty,
    /// Of a Point.
    Position(Position),
    /// Of a LineString or MultiPoint.
    Line(Vec<Position>),
    /// Of a Polygon or MultiLineString.
    Rings(Vec<Vec<Position>>),
    /// Of a MultiPolygon.
    Polygons(Vec<Vec<Vec<Position>>>),
}

/// A GeoJSON position; its height is read and dropped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Position(pub Point);

impl Serialize for Position {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        [Number(self.0.x), Number(self.0.y)].serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Position {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct PositionVisitor;
        impl<'de> Visitor<'de> for PositionVisitor {
            type Value = Position;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a position of two numbers")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<Position, A::Error> {
                let x: Number = items.next_element()?.ok_or_else(|| A::Error::custom(TOO_SHORT))?;
                finish_position(x.0, items)
            }
        }
        deserializer.deserialize_seq(PositionVisitor)
    }
}

const TOO_SHORT: &str = "a position has fewer than two numbers";

/// The position that starts with `x`, already taken from `items`.
fn finish_position<'de, A: SeqAccess<'de>>(x: f64, mut items: A) -> Result<Position, A::Error> {
    let y: Number = items.next_element()?.ok_or_else(|| A::Error::custom(TOO_SHORT))?;
    while items.next_element::<Number>()?.is_some() {}
    Ok(Position(Point::new(x, y.0)))
}

/// A member of a list of coordinates: the first one determines what the others must be.
enum Member {
    Number(f64),
    List(Coordinates),
}

impl<'de> Deserialize<'de> for Member {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct MemberVisitor;
        impl<'de> Visitor<'de> for MemberVisitor {
            type Value = Member;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("coordinates: a number or a list")
            }

            fn visit_f64<E>(self, value: f64) -> Result<Member, E> {
                Ok(Member::Number(value))
            }

            fn visit_i64<E>(self, value: i64) -> Result<Member, E> {
                Ok(Member::Number(value as f64))
            }

            fn visit_u64<E>(self, value: u64) -> Result<Member, E> {
                Ok(Member::Number(value as f64))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<Member, A::Error> {
                Ok(Member::List(match items.next_element()? {
                    None => Coordinates::Empty,
                    Some(Member::Number(x)) => Coordinates::Position(finish_position(x, items)?),
                    Some(Member::List(first)) => match first {
                        Coordinates::Empty => return Err(A::Error::custom("an empty list among the coordinates")),
                        Coordinates::Position(first) => Coordinates::Line(rest_of(first, items)?),
                        Coordinates::Line(first) => Coordinates::Rings(rest_of(first, items)?),
                        Coordinates::Rings(first) => Coordinates::Polygons(rest_of(first, items)?),
                        Coordinates::Polygons(_) => {
                            return Err(A::Error::custom("coordinates are nested deeper than those of a MultiPolygon"));
                        }
                    },
                }))
            }
        }
        deserializer.deserialize_any(MemberVisitor)
    }
}

fn rest_of<'de, T: Deserialize<'de>, A: SeqAccess<'de>>(first: T, mut items: A) -> Result<Vec<T>, A::Error> {
    let mut all = vec![first];
    while let Some(item) = items.next_element()? {
        all.push(item);
    }
    Ok(all)
}

impl<'de> Deserialize<'de> for Coordinates {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        match Member::deserialize(deserializer)? {
            Member::List(coordinates) => Ok(coordinates),
            Member::Number(number) => Err(D::Error::custom(format_args!("coordinates are a number, {number}"))),
        }
    }
}

impl Serialize for Coordinates {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Empty => [(); 0].serialize(serializer),
            Self::Position(position) => position.serialize(serializer),
            Self::Line(line) => line.serialize(serializer),
            Self::Rings(rings) => rings.serialize(serializer),
            Self::Polygons(polygons) => polygons.serialize(serializer),
        }
    }
}
