//! The same room read twice counts once, whatever files and plans are called; near twins stay in one fold; folds go out and come back.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use enfilade::edit;
use enfilade::edit::storey::{Keep, copied};
use enfilade::geometry::{Point, Transform, Vector};
use enfilade::labels::Label;
use enfilade::plan::{ElementId, LabelOrigin, Meta, Plan, RoomLabel};
use enfilade::store::{save_bytes, save_plan};
use enfilade::topology::vertical::vertical_links;

use super::{PLANS, bundled, enfilade, folder, text_of};

/// A row by its columns.
type Row = BTreeMap<String, String>;

fn rows(csv: &str) -> Vec<Row> {
    let mut reader = csv::Reader::from_reader(csv.as_bytes());
    let heads = reader.headers().unwrap().clone();
    let row =
        |record: csv::StringRecord| heads.iter().map(str::to_owned).zip(record.iter().map(str::to_owned)).collect();
    reader.records().map(|record| row(record.unwrap())).collect()
}

/// What `enfilade dataset` prints of some paths, and what it says.
fn dataset(arguments: &[&str]) -> (Vec<Row>, String) {
    let (code, out, err) = enfilade([&["dataset"], arguments].concat());
    assert_eq!(code, 0, "{err}");
    (rows(&out), err)
}

fn moved(plan: &Plan, way: Transform) -> Plan {
    let elements: BTreeSet<ElementId> = plan.elements().collect();
    edit::move_elements(plan, &elements, way).unwrap()
}

/// The three plans, their exports as GeoJSON, a copy under another name, a moved one, one that was turned and mirrored and lost
/// its names, and one file named twice.
#[test]
fn each_room_counts_once() {
    let folder = folder();
    let path = |name: &str| folder.path().join(name);
    for name in ["dwelling", "office", "school"] {
        std::fs::copy(format!("{PLANS}/{name}.plan.json"), path(&format!("{name}.plan.json"))).unwrap();
    }
    let (once, err) = dataset(&[text_of(folder.path())]);
    assert!(once.len() > 70 && !err.contains("twice"), "{} rooms: {err}", once.len());
    let (code, _, err) = enfilade(["export", text_of(folder.path()), "-o", text_of(&path("out"))]);
    assert_eq!(code, 0, "{err}");
    std::fs::copy(path("office.plan.json"), path("another name.plan.json")).unwrap();
    let office = bundled("office");
    let meta = Meta { name: "Moved".to_owned(), building: "Elsewhere".to_owned(), ..office.meta().clone() };
    let away = moved(&edit::set_meta(&office, meta), Transform::translation(Vector::new(800.25, -13.0)));
    save_plan(&path("moved.plan.json"), &away).unwrap();
    let school = bundled("school");
    let meta = Meta { name: "Turned".to_owned(), building: "Nowhere".to_owned(), ..school.meta().clone() };
    let turned = moved(&edit::set_meta(&school, meta), Transform::rotation(Point::new(0.0, 0.0), 0.7));
    let turned = moved(&turned, Transform::reflection(Point::new(0.0, 0.0), Point::new(1.0, 3.0)).unwrap());
    save_plan(&path("turned.plan.json"), &turned).unwrap();
    let (twice, err) = dataset(&[text_of(folder.path()), text_of(&path("office.plan.json"))]);
    assert_eq!(twice.len(), once.len(), "{err}");
    let keys: BTreeSet<(&str, &str)> = twice.iter().map(|row| (row["file"].as_str(), row["id"].as_str())).collect();
    assert_eq!(keys.len(), twice.len(), "file and id are the key");
    for said in [" read twice; each counts once:", "moved.plan.json is ", "turned.plan.json is ", "office.geojson is "]
    {
        assert!(err.contains(said), "{said}: {err}");
    }
    // So do the other subcommands that learn, and `check` says it.
    let model = path("x.model.json");
    let (code, _, err) = enfilade([
        "train",
        text_of(folder.path()),
        "--typology",
        "office",
        "--algorithm",
        "tree",
        "--folds",
        "0",
        "-o",
        text_of(&model),
    ]);
    assert!(code == 0 && err.contains(" read twice; each counts once:"), "{err}");
    let json: serde_json::Value = serde_json::from_slice(&std::fs::read(&model).unwrap()).unwrap();
    let offices = once.iter().filter(|row| row["typology"] == "office").count();
    assert_eq!(json["about"]["data"]["rooms"].as_u64(), Some(offices as u64));
    let (_, out, _) = enfilade(["check", text_of(folder.path())]);
    assert!(out.contains("moved.plan.json is ") && out.contains("read twice"), "{out}");
    let (kept, err) = dataset(&[text_of(folder.path()), "--keep-repeats"]);
    assert!(kept.len() > 2 * once.len() && err.contains("kept anyway"), "{err}");
}

/// A copy in which labels were changed: the first reading counts, and the rooms are named.
#[test]
fn contradictions_between_two_readings_are_named() {
    let folder = folder();
    let office = bundled("office");
    save_plan(&folder.path().join("a.plan.json"), &office).unwrap();
    let (id, _) = office.rooms().find(|(_, room)| room.name == "Meeting 2").unwrap();
    let label = Some(RoomLabel { label: Label::Hall, origin: LabelOrigin::Person });
    save_plan(&folder.path().join("b.plan.json"), &edit::set_label(&office, id, label).unwrap()).unwrap();
    let (rows, err) = dataset(&[text_of(folder.path())]);
    assert!(err.contains("1 room with another label there, the first is taken: Meeting 2 (M, there H)"), "{err}");
    let meeting = rows.iter().find(|row| row["room"] == "Meeting 2").unwrap();
    assert_eq!((meeting["label"].as_str(), meeting["label_origin"].as_str()), ("M", "scheme"));
}

/// Two storeys of one drawing, called after different buildings, are twins: all their rooms count, in one fold.
#[test]
fn near_twins_are_never_split() {
    let folder = folder();
    let office = bundled("office");
    let rooms: Vec<_> = office.rooms().map(|(id, _)| id).collect();
    // Every third room of the other storey is gone.
    let elements: Vec<ElementId> = rooms.iter().step_by(3).map(|&id| ElementId::Room(id)).collect();
    let other = edit::remove(&office, &elements).unwrap();
    let named = |plan: &Plan, building: &str, storey: &str| {
        let meta = Meta {
            name: format!("{building} {storey}"),
            building: building.to_owned(),
            storey: storey.to_owned(),
            ..plan.meta().clone()
        };
        edit::set_meta(plan, meta)
    };
    save_plan(&folder.path().join("1.plan.json"), &named(&office, "Tower", "ground floor")).unwrap();
    save_plan(&folder.path().join("2.plan.json"), &named(&other, "Tower", "first floor")).unwrap();
    let (rows, err) = dataset(&[text_of(folder.path())]);
    assert!(rows.len() > 60 && err.contains("near twins, kept in one fold"), "{}: {err}", rows.len());
    // A building of another name, with half of its rooms after the same drawing.
    let meta = Meta { name: "Annex".to_owned(), building: "Annex".to_owned(), ..other.meta().clone() };
    let mut annex = edit::set_meta(&other, meta);
    for (index, (_, corner)) in other.corners().enumerate() {
        // A third of the corners lie elsewhere by a hand's breadth.
        if index % 3 == 0 {
            let id = annex.corners().find(|(_, it)| it.position == corner.position).map(|(id, _)| id);
            let to = corner.position + Vector::new(0.11, 0.07);
            annex = id.and_then(|id| edit::move_corners(&annex, &[(id, to)]).ok()).unwrap_or(annex);
        }
    }
    save_plan(&folder.path().join("3.plan.json"), &annex).unwrap();
    std::fs::copy(format!("{PLANS}/school.plan.json"), folder.path().join("school.plan.json")).unwrap();
    let (rows, err) = dataset(&[text_of(folder.path()), "--folds", "2"]);
    let groups: BTreeSet<&str> =
        rows.iter().filter(|row| row["typology"] == "office").map(|row| row["group"].as_str()).collect();
    assert_eq!(groups, BTreeSet::from(["Tower + Annex"]), "{err}");
}

/// The edges of a building of two storeys: its openings, and its stairs and lifts that lie over each other.
#[test]
fn a_dataset_holds_the_ways_within_and_between_storeys() {
    let folder = folder();
    let path = |name: &str| folder.path().join(name);
    let of_school = |plan: &Plan, storey: &str| {
        let meta = Meta { building: "School".to_owned(), storey: storey.to_owned(), ..plan.meta().clone() };
        edit::set_meta(plan, meta)
    };
    let below = of_school(&bundled("school"), "ground floor");
    let above = of_school(&copied(&below, "first floor", Keep::All), "first floor");
    // By their names the upper one is read first.
    save_plan(&path("a.plan.json"), &above).unwrap();
    save_plan(&path("b.plan.json"), &below).unwrap();
    let csv = path("rooms.csv");
    let (code, _, err) = enfilade(["dataset", text_of(folder.path()), "-o", text_of(&csv)]);
    assert_eq!(code, 0, "{err}");
    let text = std::fs::read_to_string(path("rooms.edges.csv")).unwrap();
    let (between, within): (Vec<Row>, Vec<Row>) = rows(&text).into_iter().partition(|row| !row["overlap"].is_empty());
    let links = vertical_links(&below, &above);
    assert!(links.len() > 1, "the school has stairs");
    let link = |row: &Row| [&row["kind"], &row["from_id"], &row["to_id"]].map(String::clone);
    let expected: Vec<[String; 3]> =
        links.iter().map(|it| [it.shaft.name().to_owned(), it.lower.to_string(), it.upper.to_string()]).collect();
    assert_eq!(between.iter().map(link).collect::<Vec<_>>(), expected);
    for row in &between {
        assert!(row["from_file"].ends_with("b.plan.json") && row["to_file"].ends_with("a.plan.json"), "{row:?}");
        assert_eq!(
            [&row["from_storey"], &row["to_storey"], &row["building"]],
            ["ground floor", "first floor", "School"]
        );
    }
    // Each opening counts once for each room that it leads to, and has one edge.
    let rooms = rows(&std::fs::read_to_string(&csv).unwrap());
    let leads: usize = rooms
        .iter()
        .flat_map(|row| ["l_S", "l_M", "l_B", "l_C", "l_H"].map(|name| row[name].parse::<usize>().unwrap()))
        .sum();
    assert!(within.len() * 2 == leads && leads > 0, "{} edges, {leads} ways", within.len());
    assert!(within.iter().all(|row| row["from_file"] == row["to_file"] && row["from_id"] != row["to_id"]));
    let schema: serde_json::Value =
        serde_json::from_slice(&std::fs::read(path("rooms.edges.schema.json")).unwrap()).unwrap();
    let names: Vec<&str> =
        schema["fields"].as_array().unwrap().iter().map(|field| field["name"].as_str().unwrap()).collect();
    assert_eq!(text.lines().next().unwrap(), names.join(","));
    let manifest: serde_json::Value =
        serde_json::from_slice(&std::fs::read(path("rooms.manifest.json")).unwrap()).unwrap();
    assert_eq!(manifest["edges"]["rows"].as_u64(), Some((between.len() + within.len()) as u64));
}

/// Folds of a dataset are those that are read back; a table that lacks a room, or splits a building, is refused.
#[test]
fn folds_go_out_and_come_back() {
    let folder = folder();
    let path = |name: &str| folder.path().join(name);
    let csv = path("rooms.csv");
    let (code, _, err) = enfilade(["dataset", PLANS, "-o", text_of(&csv), "--by", "room", "--folds", "3"]);
    assert_eq!(code, 0, "{err}");
    let text = std::fs::read_to_string(&csv).unwrap();
    let of = rows(&text);
    assert_eq!(of.iter().map(|row| row["fold"].as_str()).collect::<BTreeSet<_>>(), BTreeSet::from(["1", "2", "3"]));
    for column in
        ["file", "id", "building", "typology", "plan", "room", "function", "label", "label_origin", "fold", "group"]
    {
        assert!(of.iter().all(|row| !row[column].is_empty()), "{column}");
    }
    let schema: serde_json::Value = serde_json::from_slice(&std::fs::read(path("rooms.schema.json")).unwrap()).unwrap();
    let fields = schema["fields"].as_array().unwrap();
    assert_eq!(fields.len(), text.lines().next().unwrap().split(',').count());
    let manifest: serde_json::Value =
        serde_json::from_slice(&std::fs::read(path("rooms.manifest.json")).unwrap()).unwrap();
    assert_eq!(manifest["counts"]["rooms"].as_u64(), Some(of.len() as u64));
    assert_eq!(manifest["sources"].as_array().unwrap().len(), 3);
    assert!(manifest["command"].as_str().unwrap().starts_with("enfilade dataset "), "{manifest}");
    assert_eq!(manifest["table"]["sha256"].as_str().unwrap().len(), 64);
    // The same folds, given or dealt, give the same report but for what it says of them.
    let predictions = |folds: &str| {
        let said = path(&format!("said-{}.csv", folds.len()));
        let (code, _, err) = enfilade([
            "evaluate",
            PLANS,
            "--folds",
            folds,
            "-o",
            text_of(&path("report")),
            "--predictions",
            text_of(&said),
        ]);
        assert_eq!(code, 0, "{err}");
        rows(&std::fs::read_to_string(said).unwrap())
    };
    let (dealt, given) = (predictions("3"), predictions(text_of(&csv)));
    assert!(dealt == given && !dealt.is_empty());
    for row in &dealt {
        let sum: f64 = ["p_S", "p_M", "p_B", "p_C", "p_H"].iter().map(|name| row[*name].parse::<f64>().unwrap()).sum();
        assert!((sum - 1.0).abs() < 1e-4 && !row["fold"].is_empty(), "{row:?}");
    }
    let folds_of = |rows: &[Row]| -> BTreeSet<(String, String)> {
        rows.iter().map(|row| (row["id"].clone(), row["fold"].clone())).collect()
    };
    assert_eq!(folds_of(&dealt), folds_of(&of));
    let short: Vec<&str> = text.lines().take(40).collect();
    save_bytes(&path("short.csv"), short.join("\n").as_bytes()).unwrap();
    let (code, _, err) =
        enfilade(["evaluate", PLANS, "--folds", text_of(&path("short.csv")), "-o", text_of(&path("none"))]);
    assert!(code == 1 && err.contains("short.csv: no fold for "), "{err}");
    let none = path("none");
    let by_building = ["evaluate", PLANS, "--folds", text_of(&csv), "--by", "building", "-o", text_of(&none)];
    let (code, _, err) = enfilade(by_building);
    assert!(code == 1 && err.contains("splits a building"), "{err}");
}

/// A model knows the plan it learned from, says so, and says what it was worth without it.
#[test]
fn a_model_says_that_it_learned_from_a_plan() {
    let folder = folder();
    let model = folder.path().join("x.model.json");
    let arguments = ["train", PLANS, "--typology", "standard", "--algorithm", "tree", "--folds", "3"];
    let (code, _, err) = enfilade([&arguments[..], &["-o", text_of(&model)]].concat());
    assert_eq!(code, 0, "{err}");
    let moved = folder.path().join("moved.plan.json");
    save_plan(&moved, &self::moved(&bundled("office"), Transform::rotation(Point::new(5.0, 5.0), 1.0))).unwrap();
    let (_, out, _) = enfilade(["classify", text_of(&moved), "--model", text_of(&model)]);
    let said = "the model learned from this plan, so agreement proves nothing; without these rooms it predicts ";
    assert!(out.contains(said), "{out}");
    let (_, out, _) = enfilade(["classify", text_of(&moved), "--model", text_of(&model), "--json"]);
    let json: serde_json::Value = serde_json::from_str(&out).unwrap();
    let learned = &json["plans"][0]["learned_from"];
    assert!(learned["rooms"].as_u64() >= Some(37), "{learned}");
    let share = learned["out_of_fold_agreement"].as_f64().unwrap();
    assert!((0.2..0.95).contains(&share), "{learned}");
    // Older models know of no rooms.
    let old = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/classify/tree.model.json");
    let (code, out, _) = enfilade(["classify", text_of(&moved), "--model", text_of(&old), "--json"]);
    let json: serde_json::Value = serde_json::from_str(&out).unwrap();
    assert!(code == 0 && json["plans"][0]["learned_from"].is_null(), "{out}");
}

/// Corrections are applied as the table says; lines that are not clear are refused, with their numbers.
#[test]
fn corrections_are_applied() {
    let folder = folder();
    let path = |name: &str| folder.path().join(name);
    for name in ["a", "b"] {
        std::fs::create_dir(path(name)).unwrap();
        std::fs::copy(format!("{PLANS}/office.plan.json"), path(name).join("office.plan.json")).unwrap();
    }
    std::fs::copy(format!("{PLANS}/school.plan.json"), path("school.plan.json")).unwrap();
    let office = bundled("office");
    let id = |name: &str| office.rooms().find(|(_, room)| room.name == name).unwrap().0.to_string();
    let text = format!(
        "file,id,label,function\n\
         a/office.plan.json,{},H,\n\
         office.plan.json,{},S,\n\
         {}/a/office.plan.json,Phone 1,,storage\n\
         a/office.plan.json,r000000000000,S,\n\
         a/office.plan.json,{},X,\n\
         a/office.plan.json,{},S,\n\
         a/office.plan.json,{},M,\n\
         a/office.plan.json,{},C,\n\
         school.plan.json,,S,\n",
        id("Meeting 2"),
        id("Meeting 2"),
        text_of(folder.path()),
        id("Direction"),
        id("Cafeteria"),
        id("Cafeteria"),
        id("Corridor east"),
    );
    let fixes = path("fixes.csv");
    save_bytes(&fixes, text.as_bytes()).unwrap();
    let before = std::fs::read(path("a/office.plan.json")).unwrap();
    let call = ["label", text_of(folder.path()), "--from", text_of(&fixes)];
    let (code, out, _) = enfilade([&call[..], &["--dry-run"]].concat());
    assert!(
        code == 1 && out.contains("2 rooms in 1 file would be changed; 1 as said already; 6 lines refused"),
        "{out}"
    );
    assert_eq!(std::fs::read(path("a/office.plan.json")).unwrap(), before, "a dry run wrote");
    let (code, out, err) = enfilade(call);
    assert!(code == 1 && out.contains("2 rooms in 1 file changed"), "{out}");
    for (line, why) in [
        (3, "several files are called office.plan.json"),
        (5, "no room of "),
        (6, "unknown label 'X'"),
        (7, "lines 7 and 8 contradict each other about one room"),
        (8, "lines 7 and 8 contradict each other about one room"),
        (10, "has no file and id"),
    ] {
        assert!(err.contains(&format!("line {line}: refused: {why}")), "{line}: {err}");
    }
    let after = enfilade::store::load_plan(&path("a/office.plan.json")).unwrap();
    let room = |name: &str| after.rooms().find(|(_, room)| room.name == name).unwrap().1.clone();
    let label = room("Meeting 2").label.unwrap();
    assert_eq!((label.label, label.origin), (Label::Hall, LabelOrigin::Person));
    assert_eq!(room("Phone 1").function, "storage");
    assert_eq!(room("Corridor east").label, None, "a label that follows from the function is not pinned");
    assert_eq!(std::fs::read(path("b/office.plan.json")).unwrap(), before);
    let (_, out, _) = enfilade(call);
    assert!(out.contains("0 rooms in 0 files changed; 3 as said already"), "{out}");
}
