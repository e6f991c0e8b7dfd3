//! Generated arrangements of segments, the same on every machine: integers only, in steps of the
//! 0.1 mm grid.

/// Two ends: x, y, x, y.
pub type Ends = [i32; 4];

/// A family of arrangements by its name.
pub struct Family {
    pub name: &'static str,
    /// The most segments that GEOS gets done: where many overlap on a line it takes time and memory
    /// (gigabytes at 10,000) in proportion to the square of their number.
    #[allow(dead_code, reason = "of use to the benchmark only")]
    pub geos_limit: usize,
    /// Whether its segments run through the corners of pixels, where GEOS decides by rounding: compared
    /// with snap rounding in rational arithmetic instead.
    #[allow(dead_code, reason = "of use to the benchmark only")]
    pub by_rationals: bool,
    pub make: fn(usize, &mut Random) -> Vec<Ends>,
}

pub const FAMILIES: [Family; 8] = [
    Family { name: "short", geos_limit: usize::MAX, by_rationals: false, make: short },
    Family { name: "grid", geos_limit: usize::MAX, by_rationals: false, make: grid },
    Family { name: "building", geos_limit: usize::MAX, by_rationals: false, make: building },
    Family { name: "long", geos_limit: usize::MAX, by_rationals: false, make: long },
    Family { name: "pixels", geos_limit: usize::MAX, by_rationals: true, make: pixels },
    Family { name: "line", geos_limit: 1_000, by_rationals: false, make: line },
    Family { name: "parallel", geos_limit: 1_000, by_rationals: false, make: parallel },
    Family { name: "fan", geos_limit: 1_000, by_rationals: false, make: fan },
];

/// `count` segments of a family.
pub fn segments(family: &Family, count: usize) -> Vec<Ends> {
    let mut ends = (family.make)(count, &mut Random(count as u64));
    ends.truncate(count);
    assert_eq!(ends.len(), count, "{} makes enough segments", family.name);
    ends
}

/// Splitmix64 (Steele, Lea, Flood 2014).
pub struct Random(pub u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// An integer from `low` to `high`, both included.
    pub fn within(&mut self, low: i32, high: i32) -> i32 {
        low + (self.next() % (i64::from(high) - i64::from(low) + 1) as u64) as i32
    }
}

/// The integer square root.
fn root(value: usize) -> usize {
    let mut root = 0;
    while (root + 1) * (root + 1) <= value {
        root += 1;
    }
    root
}

/// Segments up to 3 m long, anywhere in a square that grows with their number: each crosses about
/// three others.
fn short(count: usize, random: &mut Random) -> Vec<Ends> {
    let side = (root(count) * 10_000) as i32;
    (0..count)
        .map(|_| {
            let (x, y) = (random.within(0, side), random.within(0, side));
            [x, y, x + random.within(-20_000, 20_000), y + random.within(-20_000, 20_000)]
        })
        .collect()
}

/// A square grid of 3 m whose lines are broken at every node. Each end is moved on its own by up to
/// 0.3 mm across its line, and along it from 0.2 mm short to 2 mm beyond the node: what should meet
/// crosses near the node, or misses it by a hair. A tenth of the segments is missing.
fn grid(count: usize, random: &mut Random) -> Vec<Ends> {
    let side = root(count * 5 / 8) as i32 + 2;
    let mut made = Vec::new();
    for row in 0..side {
        for column in 0..side {
            for (right, up) in [(1, 0), (0, 1)] {
                let mut end = |x: i32, y: i32, outward: i32| {
                    let (along, across) = (outward * random.within(-2, 20), random.within(-3, 3));
                    (x * 30_000 + right * along + up * across, y * 30_000 + up * along + right * across)
                };
                let (ax, ay) = end(column, row, -1);
                let (bx, by) = end(column + right, row + up, 1);
                if random.within(0, 9) > 0 {
                    made.push([ax, ay, bx, by]);
                }
            }
        }
    }
    made
}

/// Storeys beside each other, turned by several angles: rooms along a corridor with the walls between
/// them drawn once, twice, or overlapping, corners that miss each other by up to 2 mm or overshoot by
/// up to 0.2 m, free columns, doors' leaves that dangle, and segments without length.
fn building(count: usize, random: &mut Random) -> Vec<Ends> {
    // Rational turns: (3, 4, 5) and (5, 12, 13) triangles and none.
    let turns = [(1, 0, 1), (4, 3, 5), (12, 5, 13), (0, 1, 1)];
    let mut made = Vec::new();
    let per_row = root(count / 200) as i32 + 1;
    let mut storey = 0;
    while made.len() < count {
        let (cos, sin, unit) = turns[(storey % 4) as usize];
        let (left, low) = (storey % per_row * 900_000, storey / per_row * 900_000);
        storey += 1;
        let mut draw = |ax: i32, ay: i32, bx: i32, by: i32| {
            let turned = |x: i32, y: i32| (left + (x * cos - y * sin) / unit, low + (x * sin + y * cos) / unit);
            let ((ax, ay), (bx, by)) = (turned(ax, ay), turned(bx, by));
            made.push([ax, ay, bx, by]);
        };
        let rooms = 16;
        let (width, depth, corridor) = (35_000, 50_000, 24_000);
        let length = rooms * width;
        for y in [0, depth, depth + corridor, 2 * depth + corridor] {
            draw(0, y, length, y);
        }
        for room in 0..=rooms {
            let x = room * width + if room % rooms == 0 { 0 } else { random.within(-8_000, 8_000) };
            for (from, to) in [(0, depth), (depth + corridor, 2 * depth + corridor)] {
                match random.within(0, 5) {
                    // Twice, the second a little off at one end.
                    0 => {
                        draw(x, from, x, to);
                        draw(x, from, x + random.within(-20, 20), to);
                    }
                    // In two overlapping parts.
                    1 => {
                        draw(x, from, x, from + 30_000);
                        draw(x, to, x, from + 20_000);
                    }
                    // Overshooting into the corridor.
                    2 => draw(x, from - random.within(0, 2_000), x, to + random.within(0, 2_000)),
                    // Falling short or overshooting by up to 2 mm.
                    3 => draw(x, from + random.within(-20, 20), x, to + random.within(-20, 20)),
                    _ => draw(x, from, x, to),
                }
                // A door's leaf, hinged on the corridor's wall.
                let hinge = if from == 0 { depth } else { depth + corridor };
                let leaf = if from == 0 { -9_000 } else { 9_000 };
                draw(x + 12_000, hinge, x + 12_000 + random.within(-200, 9_000), hinge + leaf);
            }
            // A column in the corridor, free or touching its wall.
            if room % 3 == 1 {
                let (x, y, size) = (room * width, depth + random.within(0, 1) * 10_000, 3_000);
                let ring = [(x, y), (x + size, y), (x + size, y + size), (x, y + size)];
                for side in 0..4 {
                    let ((ax, ay), (bx, by)) = (ring[side], ring[(side + 1) % 4]);
                    draw(ax, ay, bx, by);
                }
            }
            if room % 8 == 0 {
                draw(x, depth / 2, x, depth / 2);
            }
        }
    }
    made
}

/// As many segments as the root of the count run from one side of a square to the opposite one; the
/// others are short.
fn long(count: usize, random: &mut Random) -> Vec<Ends> {
    let side = (root(count) * 20_000) as i32;
    let across = root(count);
    (0..count)
        .map(|i| {
            let (p, q) = (random.within(0, side), random.within(0, side));
            match i {
                _ if i >= across => [p, q, p + random.within(-20_000, 20_000), q + random.within(-20_000, 20_000)],
                _ if i % 2 == 0 => [0, p, side, q],
                _ => [p, 0, q, side],
            }
        })
        .collect()
}

/// Segments of up to 20 grid steps, so close that most nodes come from rounding.
fn pixels(count: usize, random: &mut Random) -> Vec<Ends> {
    let side = root(count) as i32 * 10;
    (0..count)
        .map(|_| {
            let (x, y) = (random.within(0, side), random.within(0, side));
            [x, y, x + random.within(-20, 20), y + random.within(-20, 20)]
        })
        .collect()
}

/// Half of the segments overlap on one sloping line, the other half run across it.
fn line(count: usize, random: &mut Random) -> Vec<Ends> {
    let length = count as i32 * 500;
    (0..count)
        .map(|i| {
            let at = random.within(0, length);
            if i % 2 == 0 {
                let end = random.within(0, length);
                [4 * at, 3 * at, 4 * end, 3 * end]
            } else {
                let (x, y) = (4 * at + random.within(-9_000, 9_000), 3 * at + random.within(-9_000, 9_000));
                [x, y, x + random.within(-9_000, 9_000), y + random.within(-9_000, 9_000)]
            }
        })
        .collect()
}

/// Long sloping segments side by side, a millimetre or more apart, nine in ten; the others cross some
/// of them.
fn parallel(count: usize, random: &mut Random) -> Vec<Ends> {
    (0..count as i32)
        .map(|i| {
            let x = 30 * i;
            if i % 10 == 0 {
                let y = random.within(0, 7_000_000);
                let x = x + y / 7 * 10;
                [x - random.within(1, 90), y + random.within(1, 90), x + random.within(1, 90), y - random.within(1, 90)]
            } else {
                [x, random.within(-90, 0), x + 10_000_000 + random.within(0, 9), 7_000_000 + random.within(0, 90)]
            }
        })
        .collect()
}

/// Spokes from one point, and a rim: two in three segments are spokes, one in three joins the ends of
/// neighbours.
fn fan(count: usize, random: &mut Random) -> Vec<Ends> {
    let spokes = count * 2 / 3 + 1;
    let ends: Vec<(i32, i32)> = (0..spokes as i32)
        .map(|i| (1_000_000 + random.within(0, 90), 30 * (i - spokes as i32 / 2) + random.within(-9, 9)))
        .collect();
    let spokes = ends.iter().map(|&(x, y)| [0, 0, x, y]);
    let rim = ends.windows(2).step_by(2).map(|pair| [pair[0].0, pair[0].1, pair[1].0, pair[1].1]);
    spokes.chain(rim).collect()
}
