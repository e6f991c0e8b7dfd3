use enfilade::classify::unknown::Unknown;
use enfilade::dataset::RoomNetwork;
use enfilade::labels::Label;

use super::generated::{floor, network, room};

#[test]
fn behind_a_rooms_only_door_lies_the_corridor() {
    let networks: Vec<RoomNetwork> = (0..8).map(|building| floor(building, 1)).collect();
    let networks: Vec<&RoomNetwork> = networks.iter().collect();
    let unknown = Unknown::train(&networks);
    let known = [Some(Label::Corridor), Some(Label::Hall), Some(Label::SmallRoom)];
    let behind = unknown.predict(networks[0], &known, 2, 0).unwrap();
    assert!(behind.label() == Label::Corridor && behind.probability(Label::Corridor) > 0.9, "{behind:?}");
    assert_ne!(unknown.predict(networks[0], &known, 0, 0).unwrap().label(), Label::Corridor);
    let ignorant = unknown.predict(networks[0], &[], 2, 0).unwrap();
    assert!(ignorant.probability(Label::Corridor) < behind.probability(Label::Corridor));
    let scores = Unknown::score(&networks, 4, 1).unwrap();
    assert!(scores.scores.accuracy > scores.most_frequent + 0.2, "{scores:?}");
}

#[test]
fn nothing_seen_says_nothing() {
    let alone = network("a", "house", vec![room("r", Some(Label::Hall), 2.0, 2.0)]);
    let unknown = Unknown::train(&[&alone]);
    assert_eq!(unknown.predict(&alone, &[], 0, 0), None);
    assert_eq!(unknown.predict(&alone, &[], 7, 0), None);
    assert!(Unknown::score(&[&alone], 2, 1).is_err());
}
