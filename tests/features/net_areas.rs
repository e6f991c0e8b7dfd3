//! Clear areas equal those of an independent computation: `net_areas.py`, with Shapely, made `net_areas.csv`. The
//! command is in its first lines.

use enfilade::geometry::polygon;
use enfilade::plan::RoomId;

/// A thousandth of the clear area.
const MOST_OFF: f64 = 1e-3;

#[test]
fn clear_areas_of_the_bundled_plans_equal_shapelys() {
    let table = include_str!("net_areas.csv");
    let (mut rooms, mut worst) = (0, (0.0, String::new()));
    let mut reader = csv::Reader::from_reader(table.as_bytes());
    for row in reader.records().map(Result::unwrap) {
        let [path, id, name, along_m2, clear_m2] = [0, 1, 2, 3, 4].map(|column| row[column].to_owned());
        let plan = enfilade::open(&path).unwrap();
        let analysis = plan.analyse();
        let id: RoomId = id.parse().unwrap();
        let net = analysis.net(id).unwrap();
        let [along_m2, clear_m2]: [f64; 2] = [along_m2, clear_m2].map(|text| text.parse().unwrap());
        let features = analysis.room(id).unwrap().features.unwrap();
        // The paper's area is what it was.
        assert!((features.area_m2 - along_m2).abs() < 1e-5, "{path}: {name}: a is {}", features.area_m2);
        let off = (net.area_m2 - clear_m2).abs() / clear_m2;
        assert!(off < MOST_OFF, "{path}: {name}: {} m², Shapely says {clear_m2} m²", net.area_m2);
        let of_pieces: f64 = net.pieces.iter().map(|(outer, holes)| polygon::area(outer, holes)).sum();
        assert!((of_pieces - net.area_m2).abs() < 1e-6, "{path}: {name}");
        if off > worst.0 {
            worst = (off, format!("{path}: {name}"));
        }
        rooms += 1;
    }
    println!("{rooms} rooms, at most {:.4} % off: {}", worst.0 * 100.0, worst.1);
    let all: usize = ["dwelling", "office", "school"]
        .map(|name| enfilade::open(format!("plans/{name}.plan.json")).unwrap().plan().rooms().len())
        .iter()
        .sum();
    assert_eq!(rooms, all, "run the command in net_areas.py again");
}
