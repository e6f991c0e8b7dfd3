//! The 56 files of the paper's authors, if available: compared with this test's own counts, made by plain
//! text search, and with recorded areas.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use enfilade::features::{NeighbourLabels, analyse};
use enfilade::formats::{self, Import};
use enfilade::labels::Schemes;
use enfilade::plan::{Joint, Plan, ScaleOrigin};

/// The authors' files by path; none where they are not there.
#[expect(clippy::print_stdout, reason = "tells why the tests have nothing to do")]
pub fn files() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/authors");
    let mut files: Vec<PathBuf> = ["school", "office"]
        .into_iter()
        .filter_map(|folder| std::fs::read_dir(root.join(folder)).ok())
        .flatten()
        .map(|entry| entry.unwrap().path())
        .collect();
    files.sort();
    if files.is_empty() {
        println!("skipped: ../shared/data/authors is not there");
    }
    files
}

/// A file that was read.
struct File {
    path: PathBuf,
    text: String,
    import: Import,
}

impl File {
    /// Its one storey.
    fn plan(&self) -> &Plan {
        let [plan] = self.import.plans.as_slice() else { panic!("{} is one storey", self.path.display()) };
        plan
    }
}

/// All files, read once.
fn read() -> &'static [File] {
    static FILES: LazyLock<Vec<File>> = LazyLock::new(|| {
        let read = |path: PathBuf| File {
            text: std::fs::read_to_string(&path).unwrap(),
            import: formats::read_file(&path).unwrap_or_else(|error| panic!("{error}")),
            path,
        };
        files().into_iter().map(read).collect()
    });
    &FILES
}

fn name_of(path: &Path) -> String {
    path.file_name().unwrap().to_string_lossy().into_owned()
}

/// What stands between two words, each time they come.
fn between<'a>(text: &'a str, from: &str, to: &str) -> Vec<&'a str> {
    text.split(from).skip(1).filter_map(|rest| Some(rest.split_once(to)?.0)).collect()
}

#[test]
fn every_room_and_opening_arrives() {
    let mut counts: BTreeMap<(&str, &str), usize> = BTreeMap::new();
    for file in read() {
        let folder = if file.path.to_string_lossy().contains("office") { "office" } else { "school" };
        let plan = file.plan();
        assert_eq!(plan.meta().typology.as_ref().unwrap().as_str(), folder);
        assert_eq!(plan.meta().scale.origin, ScaleOrigin::Imported);
        let mut add = |what, count| *counts.entry((folder, what)).or_default() += count;
        add("rooms", plan.rooms().len());
        add("openings", plan.openings().len());
        add("rooms without a boundary", plan.rooms().filter(|(_, room)| !room.has_boundary()).count());
        add("rooms without a function", plan.rooms().filter(|(_, room)| room.function.is_empty()).count());
        add(
            "openings without a room",
            plan.openings().filter(|(_, o)| o.pinned.is_none_or(|sides| sides.contains(&Joint::Outside))).count(),
        );
    }
    if counts.is_empty() {
        return;
    }
    let expected = [
        (("office", "openings"), 764),
        (("office", "openings without a room"), 0),
        (("office", "rooms"), 696),
        (("office", "rooms without a boundary"), 0),
        (("office", "rooms without a function"), 0),
        (("school", "openings"), 1532),
        (("school", "openings without a room"), 0),
        (("school", "rooms"), 1342),
        (("school", "rooms without a boundary"), 1),
        (("school", "rooms without a function"), 0),
    ];
    assert_eq!(counts.into_iter().collect::<Vec<_>>(), expected);
}

/// The line segment and the two rooms of each opening that a file states.
fn stated_connections(text: &str) -> Vec<[String; 3]> {
    let mut connections: Vec<[String; 3]> = between(text, "<portal>", "</portal>")
        .into_iter()
        .map(|portal| {
            let segment = between(portal, "<linesegment>", "<")[0].trim().to_owned();
            let mut rooms: Vec<String> =
                between(portal, "<id>", "<").into_iter().map(|id| id.trim().to_owned()).collect();
            rooms.sort();
            [segment, rooms[0].clone(), rooms[1].clone()]
        })
        .collect();
    connections.sort();
    // Each stands in both its rooms.
    assert!(connections.len().is_multiple_of(2));
    connections.chunks(2).map(|pair| pair[0].clone()).collect()
}

#[test]
fn every_stated_connection_is_pinned() {
    for file in read() {
        let (text, plan) = (&file.text, file.plan());
        let mut pinned: Vec<[String; 3]> = plan
            .openings()
            .map(|(_, opening)| {
                let mut rooms =
                    opening.pinned.unwrap().map(|side| plan.room(side.room().unwrap()).unwrap().source_id.clone());
                rooms.sort();
                let [a, b] = rooms;
                [opening.source_id.clone(), a, b]
            })
            .collect();
        pinned.sort();
        assert_eq!(pinned, stated_connections(text), "{}", file.path.display());
    }
}

#[test]
fn rooms_keep_their_functions_and_groups() {
    for file in read() {
        let (text, plan) = (&file.text, file.plan());
        let mut stated: Vec<(String, String)> = between(text, "<space id=\"", "</labels>")
            .into_iter()
            .map(|space| {
                let function = between(space, "<label>", "<")[0].trim();
                (space.split('"').next().unwrap().to_owned(), function.to_owned())
            })
            .collect();
        let mut arrived: Vec<(String, String)> =
            plan.rooms().map(|(_, room)| (room.source_id.clone(), room.function.clone())).collect();
        stated.sort();
        arrived.sort();
        assert_eq!(arrived, stated, "{}", file.path.display());
        let groups = plan.meta().extra.as_ref().and_then(|extra| extra.get("authors_groups")?.as_array().cloned());
        let members: usize = groups.iter().flatten().map(|group| group["rooms"].as_array().unwrap().len()).sum();
        assert_eq!(members, text.matches("<space>").count(), "{}", file.path.display());
    }
}

#[test]
fn areas_equal_recorded_ones() {
    let recorded = include_str!("areas.csv");
    let mut lines = recorded.lines().filter(|line| !line.starts_with('#')).skip(1);
    for file in read() {
        let analysis = analyse(file.plan(), &Schemes::bundled(), NeighbourLabels::True);
        let areas: Vec<f64> = analysis.shapes.all().iter().map(|shape| shape.area_m2()).collect();
        let (total_m2, largest_m2) = (areas.iter().sum::<f64>(), areas.iter().copied().fold(0.0, f64::max));
        // File names hold no comma.
        let line: Vec<&str> = lines.next().unwrap().split(',').collect();
        assert_eq!(line[0], name_of(&file.path));
        assert_eq!(line[1], analysis.rooms.len().to_string(), "{}", line[0]);
        for (found, recorded) in [(total_m2, line[2]), (largest_m2, line[3])] {
            let recorded: f64 = recorded.parse().unwrap();
            assert!((found / recorded - 1.0).abs() < 1e-3, "{}: {found} m², recorded {recorded} m²", line[0]);
        }
    }
}

/// The middle of an opening lies where the file draws it: within what its two rooms differ by, and
/// the 1.5 pixels that portals lie beside their walls.
#[test]
fn openings_lie_where_they_are_drawn() {
    for file in read() {
        let (text, plan) = (&file.text, file.plan());
        let metres = plan.meta().scale.metres_per_unit.unwrap();
        let mut points: BTreeMap<&str, Vec<(f64, f64)>> = BTreeMap::new();
        for segment in
            between(text, "<linesegment id=\"", "</linesegment>").into_iter().filter(|s| s.contains("PORTAL"))
        {
            let number = |name: &str| between(segment, name, "\"")[0].parse::<f64>().unwrap();
            points.entry(segment.split('"').next().unwrap()).or_default().push((number(" x=\""), number(" y=\"")));
        }
        for (id, opening) in plan.openings() {
            let Some(points) = points.get(opening.source_id.as_str()) else { continue };
            let middle = plan.opening_segment(opening).unwrap().midpoint();
            let off = |&(x, y): &(f64, f64)| (middle.x / metres - x).hypot(-middle.y / metres - y);
            let nearest = points.iter().map(off).fold(f64::INFINITY, f64::min);
            let spread = points
                .iter()
                .flat_map(|p| points.iter().map(move |q| (p.0 - q.0).hypot(p.1 - q.1)))
                .fold(0.0, f64::max);
            // A door in a corner moves along the wall by half its width.
            let most = 0.45 / metres + spread.min(2.0 * 0.9 / metres) / 2.0 + 1.5;
            assert!(
                nearest <= most,
                "{}: {id} ({}) is {nearest:.1} pixels off",
                file.path.display(),
                opening.source_id
            );
        }
    }
}

#[test]
fn storeys_of_a_building_share_its_name() {
    let mut by_building: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for file in read() {
        let meta = file.plan().meta().clone();
        by_building.entry(meta.building).or_default().push(meta.storey);
    }
    if by_building.is_empty() {
        return;
    }
    by_building.retain(|_, storeys| storeys.len() > 1);
    let found: Vec<String> =
        by_building.into_iter().map(|(name, storeys)| format!("{name}: {}", storeys.join(", "))).collect();
    assert_eq!(
        found,
        [
            "Sabadell: 1, 2, 3",
            "Valleceppi: p0, p1",
            "VarzeaPaulistaFDE: 1, 2",
            "Vipiteno: 1, 2",
            "floorplan: lower, main",
            "plans: 1, 2",
            "rock island: ground floor, second floor",
            "scuola sconosciuta: 2, 3, ",
            "south mountain school: 1, 2",
        ]
    );
}
