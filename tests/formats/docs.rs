//! The examples in the documents match what the program writes and reads.

use enfilade::formats::plan_json::{from_bytes, to_bytes};

use super::geojson::{kept, read, written};

/// The first block of JSON in a document.
fn example(document: &str) -> &str {
    let (_, rest) = document.split_once("```json\n").unwrap();
    rest.split_once("```").unwrap().0
}

#[test]
fn the_examples_are_one_plan() {
    let plan_file = example(include_str!("../../docs/plan-file.md"));
    let plan = from_bytes(plan_file.as_bytes()).map_err(|error| error.to_string()).unwrap();
    assert_eq!(String::from_utf8(to_bytes(&plan)).unwrap(), plan_file);
    let geojson = example(include_str!("../../docs/geojson.md"));
    assert_eq!(written(&plan), geojson);
    let import = read(geojson);
    assert_eq!(import.notes, []);
    assert_eq!(kept(&import.plans[0]), kept(&plan));
}
