//! A family house on one level: two wings at a right angle round a terrace, the living rooms in a
//! row along it. From the study one looks through hall, dining room and living room out of the bay
//! window: the enfilade. Crossing it, from the porch through the hall to the terrace.

use enfilade::plan::Plan;

use super::meta;
use super::sheet::Hinge::{East, North, South, West};
use super::sheet::{OUTSIDE, Sheet, Thickness, between, rect};

pub fn draw() -> Result<Plan, String> {
    let thickness = Thickness { exterior_m: 0.36, partition_m: 0.12, parapet_m: 0.1 };
    let mut house =
        Sheet::new(meta("House with an enfilade", "House with an enfilade", "Ground floor", "house"), thickness);

    // The hall at the joint of the wings, with a niche for coats beside the porch.
    house.room(
        "Entrance hall",
        "entrance",
        &[(4.5, 7.8), (8.1, 7.8), (8.1, 13.6), (6.1, 13.6), (6.1, 15.0), (4.5, 15.0)],
    );
    house.outdoors("Porch", "porch", &rect(6.1, 13.6, 8.1, 15.0));

    // The wing along the street: living rooms to the south, kitchen to the north.
    house.room("Study", "study", &rect(0.0, 7.8, 4.5, 11.9));
    house.room("WC", "toilet", &rect(2.4, 11.9, 4.5, 13.4));
    house.room(
        "Utility",
        "utility room",
        &[(0.0, 11.9), (2.4, 11.9), (2.4, 13.4), (4.5, 13.4), (4.5, 15.0), (0.0, 15.0)],
    );
    house.room("Dining room", "dining", &rect(8.1, 7.8, 13.7, 12.2));
    house.room("Kitchen", "kitchen", &rect(8.1, 12.2, 13.7, 15.0));
    let bay = [(19.1, 8.3), (20.2, 9.0), (20.2, 10.6), (19.1, 11.3)];
    house.room(
        "Living room",
        "living room",
        &[(13.7, 7.8), (19.1, 7.8), bay[0], bay[1], bay[2], bay[3], (19.1, 15.0), (13.7, 15.0)],
    );

    // The wing along the garden: bedrooms to the west, a gallery to the terrace.
    house.room("Gallery", "corridor", &rect(4.5, 0.5, 6.1, 7.8));
    house.room("Bedroom", "bedroom", &rect(0.0, 4.2, 4.5, 7.8));
    house.room("Bathroom", "bathroom", &rect(0.0, 2.2, 4.5, 4.2));
    house.room("En suite", "bathroom", &rect(0.0, 0.5, 2.6, 2.2));
    house.room("Dressing", "dressing room", &rect(2.6, 0.5, 4.5, 2.2));
    house.room("Main bedroom", "bedroom", &rect(0.0, -3.4, 6.1, 0.5));

    let garden_edge = [(6.1, 0.5), (10.4, 0.5), (18.7, 4.5), (18.7, 7.8)];
    house.outdoors("Terrace", "terrace", &[garden_edge[0], garden_edge[1], garden_edge[2], garden_edge[3], (6.1, 7.8)]);

    // Bearing walls.
    house.wall_line(0.24, &[(4.5, 0.5), (4.5, 15.0)]);
    house.wall_line(0.24, &[(8.1, 7.8), (8.1, 13.6)]);
    house.wall_line(0.24, &[(13.7, 7.8), (13.7, 15.0)]);
    house.wall_line(0.24, &[(0.0, 7.8), (6.1, 7.8)]);
    house.wall_line(0.24, &[(0.0, 0.5), (6.1, 0.5)]);
    // The porch is open to the street.
    house.wall_line(0.0, &[(6.1, 15.0), (8.1, 15.0)]);
    // The fireplace.
    house.pier(0.6, (15.7, 14.6), (17.3, 14.6));

    // The two axes.
    house.door((4.5, 9.8), 0.9, "Study", North);
    house.double_door((8.1, 9.8), 1.6, "Dining room");
    house.double_door((13.7, 9.8), 1.6, "Living room");
    house.door((7.1, 13.6), 1.0, "Entrance hall", East);
    house.door((7.1, 7.8), 1.0, OUTSIDE, East);

    house.door((4.5, 12.75), 0.8, "WC", North);
    house.door((4.5, 14.2), 0.8, "Utility", North);
    house.door((8.1, 12.85), 0.9, "Kitchen", North);
    house.passage((10.9, 12.2), 2.0);
    house.passage((5.3, 7.8), 1.0);
    house.door((4.5, 5.0), 0.9, "Bedroom", South);
    house.door((4.5, 3.2), 0.8, "Bathroom", South);
    house.door((5.3, 0.5), 0.9, "Main bedroom", East);
    house.door((2.0, 0.5), 0.8, "En suite", East);
    house.door((3.3, 0.5), 0.8, "Dressing", West);
    house.double_door((10.9, 7.8), 1.8, OUTSIDE);
    house.double_door((16.4, 7.8), 1.8, OUTSIDE);
    house.passage(between(garden_edge[1], garden_edge[2], 0.5), 2.4);
    house.passage((7.1, 15.0), 1.4);

    // West.
    house.window((0.0, 9.8), 1.8);
    house.window((0.0, 13.4), 1.2);
    house.window((0.0, 6.0), 1.8);
    house.window((0.0, 3.2), 0.8);
    house.window((0.0, 1.35), 0.8);
    house.window((0.0, -1.45), 1.6);
    // North.
    house.window((5.3, 15.0), 0.6);
    house.window((10.9, 15.0), 2.6);
    house.window((14.7, 15.0), 0.6);
    house.window((18.1, 15.0), 0.6);
    // East and the bay.
    house.window((19.1, 13.0), 1.8);
    house.window(between(bay[0], bay[1], 0.5), 0.7);
    house.window(between(bay[1], bay[2], 0.5), 1.0);
    house.window(between(bay[2], bay[3], 0.5), 0.7);
    house.window((6.1, -1.45), 1.2);
    // To the terrace and the garden.
    house.windows((6.1, 0.5), (6.1, 7.8), 3, 1.6);
    house.window((9.2, 7.8), 0.9);
    house.window((12.6, 7.8), 0.9);
    house.window((14.7, 7.8), 0.9);
    house.window((18.1, 7.8), 0.9);
    house.window((3.05, -3.4), 2.4);

    house.finish()
}
