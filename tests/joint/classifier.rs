use std::sync::atomic::AtomicBool;

use enfilade::base::random::Random;
use enfilade::base::units::Units;
use enfilade::base::work::Work;
use enfilade::classify::joint::{Joint, JointTrainError, cross_validate};
use enfilade::dataset::{Form, RoomNetwork};
use enfilade::geometry::Point;
use enfilade::labels::{Label, Schemes, Typology};
use enfilade::plan::{Builder, Meta, Room};
use proptest::prelude::*;
use serde_json::Value;

use super::generated::{floor, join, network, room};

fn trained() -> (Vec<RoomNetwork>, Joint) {
    let networks: Vec<RoomNetwork> = (0..10).map(|building| floor(building, 1)).collect();
    let joint = Joint::train(&networks.iter().collect::<Vec<_>>(), 1, &Work::quiet()).unwrap();
    (networks, joint)
}

#[test]
fn sizes_are_learned_in_relation_to_the_plan() {
    let networks: Vec<RoomNetwork> = (0..12).map(|building| floor(building, 1)).collect();
    let networks: Vec<&RoomNetwork> = networks.iter().collect();
    let validated = cross_validate(&networks, 4, 1, &Work::quiet()).unwrap();
    assert!(validated.scores.accuracy > 0.97, "{}", validated.scores.accuracy);
    assert!(validated.scores.calibration_error < 0.1, "{}", validated.scores.calibration_error);
    assert_eq!(validated.places.len(), networks.iter().map(|network| network.rooms.len()).sum::<usize>());
    assert!(cross_validate(&networks, 13, 1, &Work::quiet()).is_err(), "there are 12 buildings");
}

#[test]
fn the_same_on_any_number_of_threads_and_after_storing() {
    let (networks, joint) = trained();
    let networks: Vec<&RoomNetwork> = networks.iter().collect();
    assert_eq!(Joint::train(&networks, 1, &Work::quiet().on_threads(1)).unwrap(), joint);
    assert_ne!(Joint::train(&networks, 2, &Work::quiet()).unwrap(), joint);
    let text = joint.to_value().to_string();
    assert_eq!(Joint::from_value(&serde_json::from_str(&text).unwrap()).unwrap(), joint);
}

#[test]
fn known_labels_are_evidence_for_other_rooms_only() {
    let (networks, joint) = trained();
    let network = &networks[0];
    let nothing = joint.predict(network, &[]);
    let mut known = vec![None; network.rooms.len()];
    known[0] = Some(Label::BigRoom);
    let told = joint.predict(network, &known);
    assert_eq!(told[0], nothing[0]);
    assert_ne!(told, nothing);
    assert_eq!(joint.predict(network, &vec![None; network.rooms.len()]), nothing);
}

#[test]
fn a_reason_names_what_mattered() {
    let (networks, joint) = trained();
    let network = &networks[3];
    let predictions = joint.predict(network, &[]);
    for (index, prediction) in predictions.iter().enumerate() {
        let explanation = joint.explain(network, &[], index).unwrap();
        assert_eq!(explanation.label, prediction.label());
        assert_eq!(explanation.distribution, *prediction);
        let words = explanation.why(Units::Metric).sentences();
        assert!(words.contains(explanation.label.name()) && words.ends_with('.'), "{words}");
        assert_eq!(explanation.neighbours.len(), if index == 0 { network.rooms.len() - 1 } else { 1 });
    }
    assert_eq!(joint.explain(network, &[], network.rooms.len()), None);
}

#[test]
fn poor_data_teach_little_but_break_nothing() {
    let work = Work::quiet();
    assert_eq!(Joint::train(&[], 1, &work), Err(JointTrainError::NoLabelledRooms));
    let unlabelled = network("b", "school", vec![room("r", None, 2.0, 2.0)]);
    assert_eq!(Joint::train(&[&unlabelled], 1, &work), Err(JointTrainError::NoLabelledRooms));
    let cancelled = AtomicBool::new(true);
    let watched = work.watched(&|_, _| {}, &cancelled);
    assert_eq!(Joint::train(&[&floor(0, 1)], 1, &watched), Err(JointTrainError::Cancelled));

    let (_, taught) = trained();
    let one_room = network("b", "school", vec![room("r", Some(Label::Hall), 2.0, 2.0)]);
    let apart = network("c", "school", vec![room("r", Some(Label::Hall), 2.0, 2.0), room("s", None, 3.0, 2.0)]);
    let mut twice = vec![room("r", Some(Label::Hall), 2.0, 2.0), room("s", Some(Label::Hall), 1e-9, 1e9)];
    join(&mut twice, 0, 1);
    join(&mut twice, 0, 1);
    let twice = network("d", "school", twice);
    let empty = network("e", "school", Vec::new());
    let poor = [&one_room, &apart, &twice, &empty];
    let of_one_room = Joint::train(&[&one_room, &empty], 1, &work).unwrap();
    let of_one_label = Joint::train(&poor, 1, &work).unwrap();
    assert!(of_one_label.predict(&twice, &[]).iter().all(|said| said.label() == Label::Hall));
    for joint in [&taught, &of_one_room, &of_one_label] {
        for network in poor {
            let said = joint.predict(network, &[Some(Label::Hall)]);
            assert_eq!(said.len(), network.rooms.len());
            for (index, said) in said.iter().enumerate() {
                assert!((said.probabilities().iter().sum::<f64>() - 1.0).abs() < 1e-9);
                joint.explain(network, &[], index).unwrap();
            }
        }
    }
}

/// Every value below a JSON value, by pointer.
fn pointers(value: &Value, at: String, found: &mut Vec<String>) {
    match value {
        Value::Object(members) => {
            for (name, member) in members {
                pointers(member, format!("{at}/{name}"), found);
            }
        }
        Value::Array(elements) => {
            for (index, element) in elements.iter().enumerate().take(40) {
                pointers(element, format!("{at}/{index}"), found);
            }
        }
        _ => {}
    }
    found.push(at);
}

#[test]
fn a_damaged_model_is_refused_or_harmless() {
    let networks: Vec<RoomNetwork> = (0..2).map(|building| floor(building, 1)).collect();
    let joint = Joint::train(&networks.iter().collect::<Vec<_>>(), 1, &Work::quiet()).unwrap();
    let whole = joint.to_value();
    let mut places = Vec::new();
    pointers(&whole, String::new(), &mut places);
    let (mut random, mut refused) = (Random::new(1), 0);
    for place in (0..400).map(|_| &places[random.below(places.len())]) {
        for bad in [Value::Null, Value::from(-7), Value::from(1e300), Value::from("x"), Value::Array(Vec::new())] {
            let mut damaged = whole.clone();
            *damaged.pointer_mut(place).unwrap() = bad;
            match Joint::from_value(&damaged) {
                Ok(joint) => drop(joint.predict(&networks[0], &[])),
                Err(error) => {
                    assert!(!error.at.is_empty() && error.to_string().contains("train it again"), "{error}");
                    refused += 1;
                }
            }
        }
    }
    assert!(refused > 1000, "{refused} of 2000");
}

/// An L-shaped room, a square one and a long one, each point sent through `placed`.
fn turned(placed: impl Fn(f64, f64) -> Point) -> RoomNetwork {
    let mut builder = Builder::new(Meta { typology: Typology::new("house"), ..Meta::default() });
    let rooms: [&[(f64, f64)]; 3] = [
        &[(0.0, 0.0), (4.0, 0.0), (4.0, 1.0), (1.0, 1.0), (1.0, 3.0), (0.0, 3.0)],
        &[(1.0, 1.0), (4.0, 1.0), (4.0, 3.0), (1.0, 3.0)],
        &[(0.0, 3.0), (4.0, 3.0), (4.0, 3.5), (0.0, 3.5)],
    ];
    for (index, corners) in rooms.iter().enumerate() {
        let outer = builder.ring(corners.iter().map(|&(x, y)| placed(x, y)));
        builder.room(&format!("{index}"), Room { outer, name: format!("{index}"), ..Room::default() });
    }
    RoomNetwork::new(&builder.finish().unwrap(), &Schemes::bundled())
}

#[test]
fn moved_turned_and_mirrored_plans_look_the_same() {
    let (_, joint) = trained();
    let plain = turned(Point::new);
    let l = plain.rooms[0].form;
    let expected = Form { perimeter_m: 14.0, walls: 6, length_m: 4.0, width_m: 3.0, convexity: 6.0 / 9.0 };
    assert_eq!((l.perimeter_m, l.walls, l.length_m, l.width_m), (14.0, 6, 4.0, 3.0));
    assert!((l.convexity - expected.convexity).abs() < 1e-9 && (l.fill(6.0) - 0.5).abs() < 1e-9);
    for other in [
        turned(|x, y| Point::new(x + 1234.5, y - 77.7)),
        turned(|x, y| Point::new(-y, x)),
        turned(|x, y| Point::new(-x, y)),
        turned(|x, y| Point::new(0.6 * x - 0.8 * y, 0.8 * x + 0.6 * y)),
    ] {
        for (one, other) in joint.predict(&plain, &[]).iter().zip(joint.predict(&other, &[])) {
            for (p, q) in one.probabilities().iter().zip(other.probabilities()) {
                assert!((p - q).abs() < 1e-9);
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// The order of a plan's rooms does not matter.
    #[test]
    fn rooms_may_stand_in_any_order(building in 0usize..1000, seed in 0u64..1000) {
        static TRAINED: std::sync::OnceLock<Joint> = std::sync::OnceLock::new();
        let joint = TRAINED.get_or_init(|| trained().1);
        let mut network = floor(building, 5);
        let last = network.rooms.len() - 1;
        join(&mut network.rooms, 1, last);
        join(&mut network.rooms, 2, last);
        let mut order: Vec<usize> = (0..network.rooms.len()).collect();
        Random::new(seed).shuffle(&mut order);
        let mut shuffled = network.clone();
        shuffled.rooms = order.iter().map(|&room| network.rooms[room].clone()).collect();
        for door in shuffled.rooms.iter_mut().flat_map(|room| &mut room.doors) {
            door.to = door.to.and_then(|to| order.iter().position(|&room| room == to));
        }
        let known: Vec<Option<Label>> =
            network.rooms.iter().enumerate().map(|(index, room)| room.label.filter(|_| index % 3 == 0)).collect();
        let shuffled_known: Vec<Option<Label>> = order.iter().map(|&room| known[room]).collect();
        let plain = joint.predict(&network, &known);
        for (said, &room) in joint.predict(&shuffled, &shuffled_known).iter().zip(&order) {
            for (p, q) in said.probabilities().iter().zip(plain[room].probabilities()) {
                prop_assert!((p - q).abs() < 1e-9);
            }
        }
    }
}
