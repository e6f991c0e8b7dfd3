//! An office storey: a ring of corridor round a core of lifts, stairs and washrooms, offices along
//! the facades, and an end cut by a street that runs at the angle of the triangle 7, 24, 25.

use enfilade::plan::Plan;

use super::meta;
use super::sheet::Hinge::{East, North, South, West};
use super::sheet::{OUTSIDE, Sheet, Thickness, rect};

/// Where the oblique facade stands at a distance from the south facade.
fn street(y: f64) -> (f64, f64) {
    (33.6 + y * 7.0 / 24.0, y)
}

pub fn draw() -> Result<Plan, String> {
    let thickness = Thickness { exterior_m: 0.36, partition_m: 0.1, parapet_m: 0.1 };
    let mut office = Sheet::new(meta("Office on a corner", "Office on a corner", "Level 1", "office"), thickness);

    // The core, and the corridor round it.
    office.room_around("Corridor", "corridor", &rect(8.4, 5.4, 30.0, 15.0), &[rect(10.2, 7.2, 28.2, 13.2)]);
    office.room("Stairs 1", "stairs", &rect(10.2, 7.2, 13.0, 13.2));
    office.room("Accessible WC", "washroom", &rect(13.0, 7.2, 16.2, 9.4));
    office.room("Lift 1", "elevator", &rect(16.2, 7.2, 18.2, 9.4));
    office.room("Lift 2", "elevator", &rect(18.2, 7.2, 20.2, 9.4));
    office.room("Lift 3", "elevator", &rect(20.2, 7.2, 22.2, 9.4));
    office.room("Copies", "closet", &rect(22.2, 7.2, 25.4, 9.4));
    office.room("Cleaner", "closet", &rect(13.0, 9.4, 15.0, 13.2));
    office.room("Women", "washroom", &rect(15.0, 9.4, 18.0, 13.2));
    office.room("Store", "storage", &rect(18.0, 9.4, 20.4, 13.2));
    office.room("Men", "washroom", &rect(20.4, 9.4, 23.4, 13.2));
    office.room("Server", "server room", &rect(23.4, 9.4, 25.4, 13.2));
    office.room("Stairs 2", "stairs", &rect(25.4, 7.2, 28.2, 13.2));

    // South, along the main street.
    office.room("Room 1.01", "office", &rect(0.0, 0.0, 4.5, 5.4));
    office.room("Room 1.02", "office", &rect(4.5, 0.0, 8.4, 5.4));
    office.room("Meeting 1", "meeting room", &rect(8.4, 0.0, 11.1, 5.4));
    office.room("Reception", "reception", &rect(11.1, 0.0, 14.7, 5.4));
    office.room("Lobby", "lobby", &rect(14.7, 0.0, 23.7, 5.4));
    office.room("Entrance", "entrance", &rect(17.4, -2.1, 21.0, 0.0));
    office.room("Cloakroom", "cloakroom", &rect(23.7, 0.0, 25.2, 5.4));
    office.room("Post room", "medium service", &rect(25.2, 0.0, 28.2, 5.4));
    office.room("Conference", "conference room", &[(28.2, 0.0), street(0.0), street(5.4), (28.2, 5.4)]);

    // West.
    office.room("Corridor west", "corridor", &rect(0.0, 5.4, 8.4, 7.2));
    office.room("Team 1", "shared office", &rect(0.0, 7.2, 8.4, 12.3));
    office.room(
        "Cafeteria",
        "cafeteria",
        &[(0.0, 12.3), (8.4, 12.3), (8.4, 17.4), (4.2, 17.4), (4.2, 16.2), (0.0, 16.2)],
    );
    office.room("Kitchen", "kitchen", &rect(4.2, 17.4, 8.4, 20.4));
    office.outdoors("Terrace", "terrace", &rect(0.4, 16.2, 4.2, 20.0));

    // North.
    let mut x = 8.4;
    for (name, function, width_m) in [
        ("Room 1.03", "office", 3.6),
        ("Room 1.04", "office", 3.6),
        ("Meeting 2", "meeting room", 4.8),
        ("Room 1.05", "office", 3.0),
        ("Room 1.06", "office", 3.0),
        ("Room 1.07", "office", 3.6),
    ] {
        office.room(name, function, &rect(x, 15.0, x + width_m, 20.4));
        x += width_m;
    }

    // East, along the oblique street.
    office.room("Phone 1", "phone booth", &rect(30.0, 5.4, 31.5, 7.2));
    office.room("Phone 2", "phone booth", &rect(31.5, 5.4, 33.0, 7.2));
    office.room(
        "Open space",
        "openspace",
        &[(30.0, 7.2), (33.0, 7.2), (33.0, 5.4), street(5.4), street(13.2), (30.0, 13.2)],
    );
    office.room("Corridor east", "corridor", &[(30.0, 13.2), street(13.2), street(15.0), (30.0, 15.0)]);
    office.room("Assistant", "office", &rect(30.0, 15.0, 33.0, 20.4));
    office.room("Direction", "executive office", &[(33.0, 15.0), street(15.0), street(20.4), (33.0, 20.4)]);

    // Bearing walls: the core, and its two stairs.
    let core = rect(10.2, 7.2, 28.2, 13.2);
    office.wall_line(0.24, &[core[0], core[1], core[2], core[3], core[0]]);
    office.wall_line(0.24, &[(13.0, 7.2), (13.0, 13.2)]);
    office.wall_line(0.24, &[(25.4, 7.2), (25.4, 13.2)]);
    office.wall_line(0.24, &[(13.0, 9.4), (25.4, 9.4)]);
    for x in [16.2, 18.2, 20.2, 22.2] {
        office.wall_line(0.2, &[(x, 7.2), (x, 9.4)]);
    }
    office.wall_line(0.24, &[(17.4, 0.0), (21.0, 0.0)]);
    office.pier(0.4, (17.4, 2.5), (17.4, 2.9));
    office.pier(0.4, (21.0, 2.5), (21.0, 2.9));

    // One axis: entrance, lobby, lifts.
    office.double_door((19.2, -2.1), 1.8, OUTSIDE);
    office.double_door((19.2, 0.0), 1.8, "Entrance");
    office.passage((19.2, 5.4), 4.2);
    for x in [17.2, 19.2, 21.2] {
        office.passage((x, 7.2), 1.0);
    }

    // The core.
    office.door((11.2, 7.2), 1.0, "Stairs 1", West);
    office.door((27.2, 13.2), 1.0, "Stairs 2", East);
    office.door((13.9, 7.2), 0.9, "Accessible WC", West);
    office.door((24.7, 7.2), 0.9, "Copies", East);
    office.door((14.0, 13.2), 0.8, "Cleaner", West);
    office.door((15.9, 13.2), 0.9, "Women", West);
    office.door((19.2, 13.2), 0.9, "Store", East);
    office.door((22.5, 13.2), 0.9, "Men", East);
    office.door((24.4, 13.2), 0.8, "Server", East);

    // South.
    office.door((3.8, 5.4), 0.9, "Room 1.01", East);
    office.door((5.2, 5.4), 0.9, "Room 1.02", West);
    office.door((10.4, 5.4), 0.9, "Meeting 1", East);
    office.passage((14.7, 2.7), 2.4);
    office.door((11.8, 5.4), 0.9, "Reception", West);
    office.door((23.7, 4.7), 0.9, "Cloakroom", North);
    office.door((25.9, 5.4), 0.9, "Post room", West);
    office.door((29.0, 5.4), 0.9, "Conference", West);

    // West.
    office.passage((8.4, 6.3), 1.4);
    office.door((0.0, 6.3), 1.0, OUTSIDE, North);
    office.door((8.4, 8.0), 0.9, "Team 1", South);
    office.double_door((8.4, 13.65), 1.6, "Cafeteria");
    office.passage((6.3, 17.4), 1.8);
    office.double_door((2.3, 16.2), 1.8, OUTSIDE);
    office.passage((0.4, 18.1), 1.2);

    // North.
    office.door((11.3, 15.0), 0.9, "Room 1.03", East);
    office.door((12.7, 15.0), 0.9, "Room 1.04", West);
    office.door((19.7, 15.0), 0.9, "Meeting 2", East);
    office.door((22.7, 15.0), 0.9, "Room 1.05", East);
    office.door((24.1, 15.0), 0.9, "Room 1.06", West);
    office.door((29.3, 15.0), 0.9, "Room 1.07", East);

    // East.
    office.passage((30.0, 14.1), 1.4);
    office.door(street(14.1), 1.0, OUTSIDE, North);
    office.double_door((30.0, 10.2), 1.6, "Open space");
    office.door((30.75, 7.2), 0.8, "Phone 1", West);
    office.door((32.25, 7.2), 0.8, "Phone 2", East);
    office.door((30.8, 15.0), 0.9, "Assistant", West);
    office.door((33.0, 16.0), 0.9, "Direction", South);
    office.door((34.6, 15.0), 0.9, "Direction", East);

    // Windows, leaving piers of half a metre beside each partition.
    for (x0, x1) in [(0.0, 4.5), (4.5, 8.4), (8.4, 11.1), (11.1, 14.7), (25.2, 28.2)] {
        office.window(((x0 + x1) / 2.0, 0.0), x1 - x0 - 1.0);
    }
    office.window((16.05, 0.0), 1.7);
    office.window((22.35, 0.0), 1.7);
    office.window((17.4, -1.05), 1.2);
    office.window((21.0, -1.05), 1.2);
    office.windows((28.4, 0.0), (33.4, 0.0), 2, 1.8);
    office.window((0.0, 2.7), 2.4);
    office.windows((0.0, 7.3), (0.0, 12.2), 2, 1.8);
    office.window((0.0, 14.25), 2.4);
    office.window((6.3, 20.4), 2.6);
    office.window((4.2, 18.9), 1.8);
    for (x0, x1) in [(8.4, 12.0), (12.0, 15.6), (20.4, 23.4), (23.4, 26.4), (26.4, 30.0), (30.0, 33.0)] {
        office.window(((x0 + x1) / 2.0, 20.4), x1 - x0 - 1.0);
    }
    office.windows((15.7, 20.4), (20.3, 20.4), 2, 1.8);
    office.windows((33.1, 20.4), (39.0, 20.4), 2, 1.8);
    office.windows(street(0.3), street(5.2), 2, 1.8);
    office.windows(street(5.5), street(13.1), 3, 1.9);
    office.windows(street(15.1), street(20.2), 2, 1.8);

    office.finish()
}
