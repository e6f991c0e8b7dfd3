use std::collections::BTreeSet;

use enfilade::base::units::Units;
use enfilade::classify::typology::{NoTypologies, TypologyModel, cross_validate};
use enfilade::dataset::RoomNetwork;
use enfilade::labels::{Label, Typology};
use serde_json::Value;

use super::generated::{dwelling, floor, network, room};

fn networks() -> Vec<RoomNetwork> {
    (0..12).map(|building| floor(building, 1)).chain((0..30).map(dwelling)).collect()
}

#[test]
fn a_plan_tells_its_typology_and_why() {
    let networks = networks();
    let networks: Vec<&RoomNetwork> = networks.iter().collect();
    for inferred in cross_validate(&networks, &BTreeSet::new(), 5, 1) {
        assert_eq!(inferred.posterior[0].0, inferred.truth, "{inferred:?}");
        let sum: f64 = inferred.posterior.iter().map(|(_, probability)| probability).sum();
        assert!((sum - 1.0).abs() < 1e-9);
    }
    let model = TypologyModel::train(&networks).unwrap();
    let reasons = model.reasons(networks[0], &[]);
    assert!(reasons.iter().any(|reason| reason.words(Units::Metric).contains("rooms")), "{reasons:?}");
    let text = model.to_value().to_string();
    assert_eq!(TypologyModel::from_value(&serde_json::from_str(&text).unwrap()), Ok(model));
}

#[test]
fn known_labels_count() {
    // The same plans twice, as houses and as schools: only the labels differ.
    let houses: Vec<RoomNetwork> = (0..10).map(dwelling).collect();
    let schools = houses.iter().cloned().map(|mut network| {
        network.typology = Typology::new("school");
        for room in &mut network.rooms {
            room.label = Some(Label::MediumRoom);
        }
        network
    });
    let all: Vec<RoomNetwork> = houses.iter().cloned().chain(schools).collect();
    let model = TypologyModel::train(&all.iter().collect::<Vec<_>>()).unwrap();
    let probability = |known: &[Option<Label>], typology: &str| {
        let posterior = model.posterior(&houses[0], known);
        posterior.into_iter().find(|(of, _)| of.as_str() == typology).unwrap().1
    };
    assert!((probability(&[], "school") - 0.5).abs() < 1e-9);
    assert!(probability(&[Some(Label::MediumRoom)], "school") > 0.6);
    assert!(probability(&[None, Some(Label::SmallRoom)], "house") > 0.6);
    let reasons = model.reasons(&houses[0], &[Some(Label::MediumRoom)]);
    let words: Vec<String> = reasons.iter().map(|reason| reason.words(Units::Metric)).collect();
    assert_eq!(words, ["one of its rooms has a label that fits"]);
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
            let is_sound = match place {
                "/typologies/0/mean/rooms" => bad.is_number(),
                _ => is_same,
            };
            assert_eq!(read.is_err(), !is_sound, "{place}: {bad}");
        }
    }
}
