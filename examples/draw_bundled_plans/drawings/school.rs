//! A school storey: a hall round a planted court, and two corridors that both aim at the court's
//! middle. The wing of classrooms is turned towards the forecourt by the angle of the triangle 7,
//! 24, 25, so that the hall widens to the north, where the canteen looks into the garden.

use enfilade::plan::Plan;

use super::meta;
use super::sheet::Hinge::{East, North, South, West};
use super::sheet::{OUTSIDE, Sheet, Thickness, between, rect};

pub fn draw() -> Result<Plan, String> {
    let thickness = Thickness { exterior_m: 0.4, partition_m: 0.15, parapet_m: 0.1 };
    let mut school = Sheet::new(meta("School round a court", "School round a court", "Level 1", "school"), thickness);

    // The hall. Its west side and that of the court follow the turned wing.
    let court = vec![(5.6, 4.2), (14.4, 4.2), (14.4, 12.6), (3.15, 12.6)];
    school.room_around(
        "1.01 Hall",
        "hall",
        &[(0.0, 0.0), (19.2, 0.0), (19.2, 16.8), (-4.9, 16.8)],
        std::slice::from_ref(&court),
    );
    school.outdoors("Court", "courtyard", &court);
    school.room("1.02 Entrance", "entrance", &rect(1.2, -3.0, 4.8, 0.0));

    // Administration, beside the entrance.
    school.room("1.03 Office", "small administrative", &rect(6.0, -3.6, 12.0, 0.0));
    school.room("1.04 Head", "small administrative", &rect(6.0, -7.2, 9.0, -3.6));
    school.room("1.05 First aid", "sick room", &rect(9.0, -7.2, 12.0, -3.6));
    school.room(
        "1.06 Staff room",
        "staff room",
        &[(12.0, -4.2), (13.8, -4.2), (13.8, -7.2), (19.2, -7.2), (19.2, 0.0), (12.0, 0.0)],
    );
    school.room("1.07 WC", "washroom", &rect(12.0, -7.2, 13.8, -4.2));

    // North: kitchen and canteen.
    school.room(
        "1.08 Kitchen",
        "kitchen",
        &[(-4.9, 16.8), (7.2, 16.8), (7.2, 22.2), (-2.2, 22.2), (-2.2, 19.5), (-4.9, 19.5)],
    );
    school.room("1.09 Cold store", "closet", &rect(-4.9, 19.5, -2.2, 22.2));
    let apse = [(19.2, 22.2), (15.6, 25.8), (10.8, 25.8), (7.2, 22.2)];
    school.room("1.10 Canteen", "canteen", &[(7.2, 16.8), (19.2, 16.8), apse[0], apse[1], apse[2], apse[3]]);

    // The east wing: library and laboratory.
    school.room("1.11 Corridor", "corridor", &rect(19.2, 7.0, 36.0, 9.8));
    school.room("1.12 Library", "library", &rect(19.2, 0.0, 32.4, 7.0));
    school.room("1.13 Stairs", "stairs", &rect(32.4, 0.0, 36.0, 7.0));
    school.room("1.14 WC", "washroom", &rect(19.2, 9.8, 21.9, 12.2));
    school.room("1.15 Lift", "elevator", &rect(19.2, 12.2, 21.9, 14.5));
    school.room("1.16 Cleaner", "closet", &rect(19.2, 14.5, 21.9, 16.8));
    school.room("1.17 Laboratory", "lab", &rect(21.9, 9.8, 33.6, 16.8));
    school.room("1.18 Preparation", "small", &rect(33.6, 9.8, 36.0, 16.8));

    // The west wing: classrooms, drawn in its own frame.
    school.set_frame((0.0, 0.0), (24.0, 7.0));
    school.room("1.20 Corridor", "corridor", &rect(-24.6, 7.35, 0.0, 10.15));
    school.room("1.21 Classroom", "classroom", &rect(-8.2, 10.15, 0.0, 17.5));
    school.room("1.22 Classroom", "classroom", &rect(-16.4, 10.15, -8.2, 17.5));
    school.room("1.23 Classroom", "classroom", &rect(-24.6, 10.15, -16.4, 17.5));
    school.room("1.24 Stairs", "stairs", &rect(-24.6, 0.0, -21.2, 7.35));
    school.room("1.25 Classroom", "classroom", &rect(-21.2, 0.0, -13.0, 7.35));
    school.room("1.26 Classroom", "classroom", &rect(-13.0, 0.0, -4.8, 7.35));
    school.room("1.27 Materials", "closet", &rect(-4.8, 0.0, 0.0, 2.6));
    school.room("1.28 Boys", "washroom", &rect(-4.8, 2.6, -2.4, 7.35));
    school.room("1.29 Girls", "washroom", &rect(-2.4, 2.6, 0.0, 7.35));

    school.wall_line(0.24, &[(-24.6, 7.35), (0.0, 7.35)]);
    school.wall_line(0.24, &[(-24.6, 10.15), (0.0, 10.15)]);
    for x in [-16.4, -8.2] {
        school.wall_line(0.24, &[(x, 10.15), (x, 17.5)]);
    }
    for x in [-21.2, -13.0, -4.8] {
        school.wall_line(0.24, &[(x, 0.0), (x, 7.35)]);
    }
    school.wall_line(0.3, &[(0.0, 0.0), (0.0, 17.5)]);

    school.passage((0.0, 8.75), 2.2);
    school.double_door((-24.6, 8.75), 1.8, OUTSIDE);
    school.door((-1.1, 10.15), 1.0, "1.21 Classroom", East);
    school.door((-15.3, 10.15), 1.0, "1.22 Classroom", West);
    school.door((-17.5, 10.15), 1.0, "1.23 Classroom", East);
    school.door((-22.3, 7.35), 1.0, "1.24 Stairs", East);
    school.door((-24.6, 1.2), 1.0, OUTSIDE, South);
    school.door((-14.1, 7.35), 1.0, "1.25 Classroom", East);
    school.door((-11.9, 7.35), 1.0, "1.26 Classroom", West);
    school.door((-4.8, 1.3), 0.9, "1.27 Materials", South);
    school.door((-3.2, 7.35), 0.9, "1.28 Boys", East);
    school.door((-1.6, 7.35), 0.9, "1.29 Girls", West);

    for x in [-24.6, -16.4, -8.2] {
        school.windows((x + 0.4, 17.5), (x + 7.8, 17.5), 3, 2.0);
    }
    for x in [-21.2, -13.0] {
        school.windows((x + 0.4, 0.0), (x + 7.8, 0.0), 3, 2.0);
    }
    school.window((-22.9, 0.0), 1.8);
    school.window((-2.4, 0.0), 1.6);

    // The rest is drawn in the plan's own frame.
    school.set_frame((0.0, 0.0), (1.0, 0.0));
    school.wall_line(0.24, &[(19.2, -7.2), (19.2, 16.8)]);
    school.wall_line(0.4, &[(19.2, -7.2), (19.2, 0.0)]);
    school.wall_line(0.24, &[(6.0, 0.0), (19.2, 0.0)]);
    school.wall_line(0.24, &[(1.2, 0.0), (4.8, 0.0)]);
    school.wall_line(0.24, &[(12.0, -7.2), (12.0, 0.0)]);
    school.wall_line(0.24, &[(-4.9, 16.8), (19.2, 16.8)]);
    school.wall_line(0.24, &[(7.2, 16.8), (7.2, 22.2)]);
    school.wall_line(0.24, &[(19.2, 7.0), (36.0, 7.0)]);
    school.wall_line(0.24, &[(19.2, 9.8), (36.0, 9.8)]);
    school.wall_line(0.24, &[(32.4, 0.0), (32.4, 7.0)]);
    school.wall_line(0.3, &[court[0], court[1], court[2], court[3], court[0]]);

    // Columns along the court's turned side, a metre and a half from it and in line with its piers.
    for fraction in [0.06, 0.353, 0.647, 0.94] {
        let (x, y) = between((4.16, 3.78), (1.71, 12.18), fraction);
        school.pier(0.35, (x + 0.049, y - 0.168), (x - 0.049, y + 0.168));
    }

    // Ways in and out.
    school.double_door((3.0, -3.0), 1.8, OUTSIDE);
    school.double_door((3.0, 0.0), 1.8, "1.02 Entrance");
    school.double_door((36.0, 8.4), 1.8, OUTSIDE);
    school.double_door((13.2, 25.8), 1.8, OUTSIDE);
    school.double_door((10.0, 4.2), 1.8, "Court");
    school.double_door((14.4, 8.4), 1.8, "Court");
    school.door((-4.9, 18.2), 1.0, OUTSIDE, North);
    school.door((36.0, 1.2), 1.0, OUTSIDE, South);

    school.door((8.0, 0.0), 1.0, "1.03 Office", West);
    school.door((7.0, -3.6), 0.9, "1.04 Head", West);
    school.door((11.1, -3.6), 0.9, "1.05 First aid", East);
    school.door((14.0, 0.0), 1.0, "1.06 Staff room", West);
    school.door((12.9, -4.2), 0.9, "1.07 WC", West);

    school.door((-3.4, 16.8), 1.0, "1.08 Kitchen", West);
    school.door((-2.2, 20.9), 1.0, "1.09 Cold store", North);
    school.passage((7.2, 19.5), 2.4);
    school.double_door((10.2, 16.8), 1.8, "1.01 Hall");
    school.double_door((16.2, 16.8), 1.8, "1.01 Hall");

    school.passage((19.2, 8.4), 2.2);
    school.door((20.6, 7.0), 1.0, "1.12 Library", West);
    school.door((31.0, 7.0), 1.0, "1.12 Library", East);
    school.door((33.6, 7.0), 1.0, "1.13 Stairs", West);
    school.door((20.4, 9.8), 0.9, "1.14 WC", West);
    school.passage((19.2, 13.35), 1.1);
    school.door((19.2, 15.65), 0.9, "1.16 Cleaner", North);
    school.door((23.1, 9.8), 1.0, "1.17 Laboratory", West);
    school.door((33.6, 11.2), 0.9, "1.18 Preparation", South);

    // Glass round the court.
    school.windows((6.2, 4.2), (8.6, 4.2), 1, 1.8);
    school.windows((11.4, 4.2), (13.8, 4.2), 1, 1.8);
    school.windows((14.4, 4.8), (14.4, 7.0), 1, 1.8);
    school.windows((14.4, 9.8), (14.4, 12.0), 1, 1.8);
    school.windows((4.0, 12.6), (13.6, 12.6), 4, 1.9);
    school.windows(between(court[0], court[3], 0.06), between(court[0], court[3], 0.94), 3, 2.1);
    // South.
    school.windows((6.1, -7.2), (8.9, -7.2), 1, 1.8);
    school.window((10.5, -7.2), 1.8);
    school.windows((14.2, -7.2), (18.8, -7.2), 2, 1.8);
    school.window((6.0, -1.8), 1.8);
    school.windows((19.2, -6.8), (19.2, -0.4), 2, 1.8);
    school.windows((19.8, 0.0), (32.0, 0.0), 5, 1.9);
    school.window((34.2, 0.0), 1.8);
    // North.
    school.windows((-1.8, 22.2), (6.8, 22.2), 3, 1.8);
    school.window(between(apse[0], apse[1], 0.5), 3.4);
    school.window((11.6, 25.8), 0.8);
    school.window((14.8, 25.8), 0.8);
    school.window(between(apse[2], apse[3], 0.5), 3.4);
    school.window((19.2, 19.5), 3.6);
    school.windows((22.2, 16.8), (33.3, 16.8), 5, 1.8);
    school.window((34.8, 16.8), 1.2);

    school.finish()
}
