use std::fmt;

use serde::de::Visitor;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::value::RawValue;
use serde_json::{Map, Value};

use super::coordinates::{Coordinates, Position};
use crate::formats::json_text::Number;
use crate::formats::plan_json::{DiskHinge, DiskSide};

/// The whole file; its features stay text, so that each knows its line.
#[derive(Deserialize)]
pub(super) struct DiskCollection<'a> {
    #[serde(rename = "type")]
    pub kind: Option<Words>,
    #[serde(borrow)]
    pub features: Option<Vec<&'a RawValue>>,
    pub crs: Option<Value>,
    pub units: Option<Words>,
    #[serde(flatten)]
    pub meta: DiskMeta,
}

/// The metadata of the plan in the file.
#[derive(Serialize, Deserialize)]
pub(super) struct DiskMeta {
    #[serde(default, skip_serializing_if = "Words::is_empty")]
    pub name: Words,
    #[serde(default, skip_serializing_if = "Words::is_empty")]
    pub building: Words,
    #[serde(default, skip_serializing_if = "Words::is_empty")]
    pub storey: Words,
    #[serde(default, skip_serializing_if = "Words::is_empty")]
    pub typology: Words,
    #[serde(default, skip_serializing_if = "Words::is_empty")]
    pub scale: Words,
    #[serde(default, skip_serializing_if = "Words::is_empty")]
    pub scale_origin: Words,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub metres_per_unit: Option<Number>,
    #[serde(default, skip_serializing_if = "Words::is_empty")]
    pub source: Words,
    #[serde(default, skip_serializing_if = "Words::is_empty")]
    pub licence: Words,
    #[serde(flatten)]
    pub other: Map<String, Value>,
}

/// A feature as it is read: its properties are looked at one by one, see [`super::properties`].
#[derive(Deserialize)]
#[serde(expecting = "a feature")]
pub(super) struct ReadFeature {
    #[serde(default)]
    pub id: Words,
    pub geometry: Option<DiskGeometry>,
    pub properties: Option<Value>,
}

/// A feature as it is written.
#[derive(Serialize)]
pub(super) struct DiskFeature {
    #[serde(rename = "type")]
    pub kind: Words,
    pub id: Words,
    pub geometry: Option<DiskGeometry>,
    pub properties: Option<DiskProperties>,
}

#[derive(Serialize, Deserialize)]
#[serde(expecting = "a geometry")]
pub(super) struct DiskGeometry {
    #[serde(rename = "type", default)]
    pub kind: Words,
    pub coordinates: Option<Coordinates>,
    /// Of a GeometryCollection; never written.
    #[serde(skip_serializing)]
    pub geometries: Option<Vec<DiskGeometry>>,
}

#[derive(Default, Serialize)]
pub(super) struct DiskProperties {
    #[serde(skip_serializing_if = "Words::is_empty")]
    pub kind: Words,
    #[serde(skip_serializing_if = "Words::is_empty")]
    pub function: Words,
    #[serde(skip_serializing_if = "Words::is_empty")]
    pub label: Words,
    #[serde(skip_serializing_if = "Words::is_empty")]
    pub label_origin: Words,
    #[serde(skip_serializing_if = "Words::is_empty")]
    pub name: Words,
    #[serde(skip_serializing_if = "Words::is_empty")]
    pub note: Words,
    /// The kind of an opening.
    #[serde(skip_serializing_if = "Words::is_empty")]
    pub opening: Words,
    /// Feature ids of the rooms an opening joins; null is the outside.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rooms: Option<Vec<Option<Words>>>,
    /// False if `rooms` follow from geometry and are only for the reader's convenience.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pinned: Option<bool>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub host: Option<DiskHost>,
    /// True if an opening has no host although it lies on an edge.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub free: Option<bool>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hinge: Option<DiskHinge>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub opens: Option<DiskSide>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub thickness_m: Option<Number>,
    #[serde(skip_serializing_if = "Words::is_empty")]
    pub source_id: Words,
    #[serde(flatten)]
    pub other: Map<String, Value>,
}

/// The edge an opening lies on.
#[derive(Serialize, Deserialize)]
#[serde(expecting = "an edge with from, to, at_m and width_m")]
pub(super) struct DiskHost {
    pub from: Position,
    pub to: Position,
    pub at_m: Number,
    pub width_m: Number,
}

/// A text. Other programs also write ids and names as numbers; null counts as empty.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) struct Words(pub String);

impl Words {
    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    pub(super) fn as_str(&self) -> &str {
        &self.0
    }
}

impl From<&str> for Words {
    fn from(text: &str) -> Self {
        Self(text.to_owned())
    }
}

impl Serialize for Words {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&self.0)
    }
}

impl<'de> Deserialize<'de> for Words {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct WordsVisitor;
        impl Visitor<'_> for WordsVisitor {
            type Value = Words;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a text")
            }

            fn visit_str<E>(self, text: &str) -> Result<Words, E> {
                Ok(Words(text.to_owned()))
            }

            fn visit_string<E>(self, text: String) -> Result<Words, E> {
                Ok(Words(text))
            }

            fn visit_i64<E>(self, number: i64) -> Result<Words, E> {
                Ok(Words(number.to_string()))
            }

            fn visit_u64<E>(self, number: u64) -> Result<Words, E> {
                Ok(Words(number.to_string()))
            }

            fn visit_f64<E>(self, number: f64) -> Result<Words, E> {
                Ok(Words(number.to_string()))
            }

            fn visit_bool<E>(self, truth: bool) -> Result<Words, E> {
                Ok(Words(truth.to_string()))
            }

            fn visit_unit<E>(self) -> Result<Words, E> {
                Ok(Words::default())
            }
        }
        deserializer.deserialize_any(WordsVisitor)
    }
}
