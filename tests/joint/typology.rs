use std::collections::BTreeSet;

use enfilade::classify::typology::{NoTypologies, TypologyModel, cross_validate};
use enfilade::dataset::RoomNetwork;
use enfilade::labels::Label;
use serde_json::Value;

use crate::generated::{dwelling, floor, network, room};

fn networks() -> Vec<RoomNetwork> {
    (0..12).map(|building| floor(building, 1)).chain((0..30).map(dwelling)).collect()
}

#[test]
fn a_plan_tells_its_typology_and_why() {
    let networks = networks();
    let networks: Vec<&RoomNetwork> = networks.iter().collect();
    for inferred in cross_validate(&networks, &networks, &BTreeSet::new(), 5, 1) {
        assert_eq!(inferred.posterior[0].0, inferred.truth, "{inferred:?}");
        let sum: f64 = inferred.posterior.iter().map(|(_, probability)| probability).sum();
        assert!((sum - 1.0).abs() < 1e-9);
    }
    let model = TypologyModel::train(&networks).unwrap();
    let reasons = model.reasons(networks[0], &[]);
    assert!(reasons.iter().any(|reason| reason.contains("rooms")), "{reasons:?}");
    let text = model.to_value().to_string();
    assert_eq!(TypologyModel::from_value(&serde_json::from_str(&text).unwrap()), Ok(model));
}

#[test]
fn known_labels_count() {
    let networks = networks();
    let model = TypologyModel::train(&networks.iter().collect::<Vec<_>>()).unwrap();
    // Two rooms of which the shape says little.
    let doubtful = network("x", "", vec![room("a", None, 4.0, 3.0), room("b", None, 4.0, 3.0)]);
    let probability = |known: &[Option<Label>], typology: &str| {
        let posterior = model.posterior(&doubtful, known);
        posterior.into_iter().find(|(of, _)| of.as_str() == typology).unwrap().1
    };
    // Only the schools have medium rooms.
    let medium = [Some(Label::MediumRoom), Some(Label::MediumRoom)];
    assert!(probability(&medium, "school") > probability(&[], "school"));
    assert!(probability(&[Some(Label::BigRoom)], "house") > probability(&[], "house"));
}

#[test]
fn poor_plans_get_an_answer() {
    assert_eq!(TypologyModel::train(&[]), Err(NoTypologies));
    let empty = network("e", "school", Vec::new());
    assert_eq!(TypologyModel::train(&[&empty]), Err(NoTypologies));
    let single = network("s", "castle", vec![room("a", None, 1e-9, 1e9)]);
    let only = TypologyModel::train(&[&single]).unwrap();
    assert_eq!(only.posterior(&empty, &[])[0].1, 1.0);
    assert!(only.reasons(&single, &[]).is_empty());
    let networks = networks();
    let both: Vec<&RoomNetwork> = networks.iter().chain([&single]).collect();
    let model = TypologyModel::train(&both).unwrap();
    for network in [&empty, &single] {
        for (_, probability) in model.posterior(network, &[]) {
            assert!((0.0..=1.0).contains(&probability));
        }
    }
}

#[test]
fn a_damaged_model_is_refused() {
    let networks = networks();
    let whole = TypologyModel::train(&networks.iter().collect::<Vec<_>>()).unwrap().to_value();
    for place in [
        "/typologies",
        "/typologies/0/typology",
        "/typologies/0/plans",
        "/typologies/0/mean/rooms",
        "/typologies/0/labels",
        "/typologies/0/labels/3",
        "/typologies/1/typology",
        "/covariance",
        "/covariance/2",
        "/covariance/0/rooms",
        "/without",
        "/temperature",
    ] {
        for bad in [Value::Null, Value::from(-7), Value::from("school"), Value::Array(Vec::new())] {
            let mut damaged = whole.clone();
            *damaged.pointer_mut(place).unwrap() = bad.clone();
            // No group of measures left out is what 'without' holds.
            let is_same = damaged == whole;
            let read = TypologyModel::from_value(&damaged);
            assert!(is_same || read.is_err() || place == "/typologies/1/typology", "{place}: {bad}");
        }
    }
}
