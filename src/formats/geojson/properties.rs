//! A feature's properties, read one by one: one that cannot be read costs that property, not the feature.
//! Other programs change them on the way: a column in which some rows lack a truth comes back as numbers, a
//! list as text.

use serde::de::DeserializeOwned;
use serde_json::{Map, Value};

use super::disk::DiskHost;
use crate::formats::plan_json::{DiskHinge, DiskSide};

/// What the properties of a feature say; empty and `None` where they say nothing.
#[derive(Default)]
pub(super) struct Properties {
    pub kind: String,
    pub function: String,
    pub label: String,
    pub label_origin: String,
    pub name: String,
    pub note: String,
    pub opening: String,
    /// Feature ids; `None` among them is the outside.
    pub rooms: Option<Vec<Option<String>>>,
    pub pinned: Option<bool>,
    pub host: Option<DiskHost>,
    pub free: Option<bool>,
    pub hinge: Option<DiskHinge>,
    pub opens: Option<DiskSide>,
    pub thickness_m: Option<f64>,
    pub source_id: String,
    /// The id, where a program moved it from the feature to its properties. It stays among the others.
    pub id: String,
    /// What has no meaning here, to be written again.
    pub other: Map<String, Value>,
    /// What could not be read, in words.
    pub passed_over: Vec<String>,
}

impl Properties {
    /// Reads the member `properties` of a feature.
    pub(super) fn of(member: Option<Value>) -> Self {
        let other = match member {
            None | Some(Value::Null) => Map::new(),
            Some(Value::Object(map)) => map,
            Some(value) => {
                let what = format!("its properties are {}, not an object; read without them", shown(&value));
                return Self { passed_over: vec![what], ..Self::default() };
            }
        };
        let mut found = Self { other, ..Self::default() };
        found.kind = found.text("kind").trim().to_lowercase();
        found.function = found.text("function");
        found.label = found.text("label");
        found.label_origin = found.text("label_origin");
        found.name = found.text("name");
        found.note = found.text("note");
        found.opening = found.text("opening");
        found.source_id = found.text("source_id");
        found.rooms = found.take("rooms", "a list of two ids", rooms);
        found.pinned = found.take("pinned", "true or false", truth);
        found.free = found.take("free", "true or false", truth);
        found.host = found.take("host", "an edge with from, to, at_m and width_m", object);
        found.hinge = found.take("hinge", "'start' or 'end'", object);
        found.opens = found.take("opens", "'left' or 'right'", object);
        found.thickness_m = found.take("thickness_m", "a number of metres", number);
        found.id = found.other.get("id").and_then(text).unwrap_or_default();
        found
    }

    /// A property that is a text.
    fn text(&mut self, name: &str) -> String {
        self.take(name, "a text", |value| text(&value)).unwrap_or_default()
    }

    /// A property, taken out of the others; `None` where it is missing, null, empty, or cannot be read.
    fn take<T>(&mut self, name: &str, wanted: &str, read: impl FnOnce(Value) -> Option<T>) -> Option<T> {
        // The others keep their order.
        let value = self.other.shift_remove(name)?;
        let is_blank = value.as_str().is_some_and(|text| text.trim().is_empty());
        let words = shown(&value);
        if value.is_null() {
            return None;
        }
        let found = read(value);
        if found.is_none() && !is_blank {
            self.passed_over.push(format!("its property '{name}' is {words}, not {wanted}; passed over"));
        }
        found
    }
}

/// The start of a value, for people.
fn shown(value: &Value) -> String {
    const MOST: usize = 40;
    let text = value.to_string();
    match text.char_indices().nth(MOST) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text,
    }
}

/// A text; other programs write names and ids as numbers too.
fn text(value: &Value) -> Option<String> {
    match value {
        Value::String(text) => Some(text.clone()),
        Value::Bool(truth) => Some(truth.to_string()),
        Value::Number(number) if number.is_f64() => number.as_f64().map(|number| number.to_string()),
        Value::Number(number) => Some(number.to_string()),
        _ => None,
    }
}

/// A truth, also as 0 and 1 and as a word.
#[expect(clippy::needless_pass_by_value, reason = "the signature of every reader")]
fn truth(value: Value) -> Option<bool> {
    match &value {
        Value::Bool(truth) => Some(*truth),
        Value::Number(number) => match number.as_f64() {
            Some(0.0) => Some(false),
            Some(1.0) => Some(true),
            _ => None,
        },
        Value::String(word) => match word.trim().to_lowercase().as_str() {
            "true" | "yes" | "t" | "1" | "1.0" => Some(true),
            "false" | "no" | "f" | "0" | "0.0" => Some(false),
            _ => None,
        },
        _ => None,
    }
}

/// A number, also as text.
#[expect(clippy::needless_pass_by_value, reason = "the signature of every reader")]
fn number(value: Value) -> Option<f64> {
    match &value {
        Value::Number(number) => number.as_f64(),
        Value::String(text) => text.trim().parse().ok().filter(|number: &f64| number.is_finite()),
        _ => None,
    }
}

/// Something of a type of ours, also as the text of JSON, which GIS programs make of objects.
fn object<T: DeserializeOwned>(value: Value) -> Option<T> {
    match &value {
        Value::String(text) if text.trim_start().starts_with('{') => serde_json::from_str(text).ok(),
        _ => serde_json::from_value(value).ok(),
    }
}

/// The ids of rooms; null is the outside. Also as the text of JSON, and as GDAL writes lists: `(2:a,b)`.
fn rooms(value: Value) -> Option<Vec<Option<String>>> {
    let items = match value {
        Value::Array(items) => items,
        Value::String(text) => {
            let text = text.trim();
            let inner = text.strip_prefix('(').and_then(|rest| rest.strip_suffix(')'));
            match inner.and_then(|inner| inner.split_once(':')) {
                Some((count, list)) if count.parse::<usize>().is_ok() => {
                    list.split(',').map(|id| Value::String(id.trim().to_owned())).collect()
                }
                _ => serde_json::from_str(text).ok()?,
            }
        }
        _ => return None,
    };
    let id = |item: &Value| match item {
        Value::Null => Some(None),
        item => text(item).map(|id| (!id.is_empty()).then_some(id)),
    };
    items.iter().map(id).collect()
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn what_other_programs_make_of_our_properties_is_read() {
        for (value, expected) in [(json!(0.0), false), (json!(1), true), (json!("False"), false), (json!(true), true)] {
            let found = Properties::of(Some(json!({"pinned": value})));
            assert_eq!((found.pinned, found.passed_over.len()), (Some(expected), 0), "{value}");
        }
        let two = Some(vec![Some("a".to_owned()), None]);
        for value in [json!(["a", null]), json!("[\"a\", null]"), json!("(2:a,)")] {
            assert_eq!(Properties::of(Some(json!({"rooms": value}))).rooms, two, "{value}");
        }
        let host = r#"{"from": [0, 0], "to": [4, 0], "at_m": 1, "width_m": 0.9}"#;
        assert!(Properties::of(Some(json!({"host": host}))).host.is_some());
        let null = Properties::of(Some(json!({"pinned": null, "rooms": null, "hinge": "", "name": null})));
        assert_eq!((null.pinned, null.rooms, null.passed_over.len()), (None, None, 0));
    }

    #[test]
    fn what_cannot_be_read_is_named_and_costs_nothing_else() {
        let found = Properties::of(Some(json!({"kind": "room", "name": ["a"], "pinned": 2, "colour": [1]})));
        assert_eq!(found.kind, "room");
        assert_eq!(
            found.passed_over,
            [
                "its property 'name' is [\"a\"], not a text; passed over",
                "its property 'pinned' is 2, not true or false; passed over"
            ]
        );
        assert_eq!(found.other.keys().collect::<Vec<_>>(), ["colour"]);
        let found = Properties::of(Some(json!("kitchen")));
        assert_eq!(found.passed_over, ["its properties are \"kitchen\", not an object; read without them"]);
    }
}
