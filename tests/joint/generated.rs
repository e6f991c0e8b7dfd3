//! Generated networks: floors with a corridor, whose rooms can only be told apart by their relative size,
//! since every building has its own scale.

use enfilade::base::random::Random;
use enfilade::dataset::fingerprint::RoomPrint;
use enfilade::dataset::{Form, NetworkDoor, NetworkRoom, RoomNetwork};
use enfilade::labels::{Label, Typology};
use enfilade::plan::{OpeningId, OpeningKind, RoomId};

/// A rectangular room.
pub fn room(key: &str, label: Option<Label>, length_m: f64, width_m: f64) -> NetworkRoom {
    NetworkRoom {
        id: RoomId::of_key(key),
        key: key.to_owned(),
        name: String::new(),
        function: String::new(),
        label,
        label_origin: None,
        is_repeat: false,
        fold: None,
        print: RoomPrint::default(),
        temporary: Label::MediumRoom,
        area_m2: length_m * width_m,
        axes_ratio: length_m / width_m,
        form: Form { perimeter_m: 2.0 * (length_m + width_m), walls: 4, length_m, width_m, convexity: 1.0 },
        doors: Vec::new(),
    }
}

/// Joins two rooms by a door.
pub fn join(rooms: &mut [NetworkRoom], a: usize, b: usize) {
    let key = format!("{} {} {}", rooms[a].key, rooms[b].key, rooms[a].doors.len());
    let door = |to| NetworkDoor { opening: OpeningId::of_key(&key), kind: OpeningKind::Door, to: Some(to) };
    rooms[a].doors.push(door(b));
    rooms[b].doors.push(door(a));
}

pub fn network(building: &str, typology: &str, rooms: Vec<NetworkRoom>) -> RoomNetwork {
    RoomNetwork {
        file: String::new(),
        plan: building.to_owned(),
        building: building.to_owned(),
        group: building.to_owned(),
        storey: String::new(),
        typology: Typology::new(typology),
        rooms,
        left_out: Default::default(),
        flats: Default::default(),
    }
}

/// A floor of 8 to 15 rooms along a corridor, every length times a random scale. A third of the rooms
/// are small, the rest medium, the hall is at the corridor's end.
pub fn floor(building: usize, seed: u64) -> RoomNetwork {
    let mut random = Random::new(seed.wrapping_add(building as u64 * 7919));
    let scale = 0.5 + 2.0 * random.unit();
    let count = 8 + random.below(8);
    let mut rooms = vec![
        room("corridor", Some(Label::Corridor), scale * count as f64 * 2.0, scale * 2.0),
        room("hall", Some(Label::Hall), scale * 9.0, scale * 7.0),
    ];
    for index in 0..count {
        let (label, side) =
            if index % 3 == 0 { (Label::SmallRoom, 2.0) } else { (Label::MediumRoom, 4.0 + random.unit()) };
        rooms.push(room(
            &format!("room {index}"),
            Some(label),
            scale * side * (1.0 + random.unit() / 4.0),
            scale * side,
        ));
    }
    for index in 1..rooms.len() {
        join(&mut rooms, 0, index);
    }
    network(&format!("building {building}"), "school", rooms)
}

/// A dwelling: few rooms, one hall in the middle.
pub fn dwelling(building: usize) -> RoomNetwork {
    let mut random = Random::new(building as u64);
    let mut rooms = vec![room("living", Some(Label::BigRoom), 5.0 + random.unit(), 4.0)];
    for index in 0..3 + random.below(3) {
        rooms.push(room(&format!("room {index}"), Some(Label::SmallRoom), 2.0 + random.unit(), 1.5));
        join(&mut rooms, 0, index + 1);
    }
    network(&format!("house {building}"), "house", rooms)
}
