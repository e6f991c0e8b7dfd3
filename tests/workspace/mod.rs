//! A folder of plans as a dataset: listed, kept in an index, searched, sorted, changed; buildings and their storeys.

use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, SystemTime};

use enfilade::base::work::Work;
use enfilade::classify::models::Models;
use enfilade::edit;
use enfilade::edit::storey::{Keep, copied, laid_over};
use enfilade::geometry::{Point, Transform, Vector};
use enfilade::labels::{Label, Schemes, Typology};
use enfilade::plan::storeys::level;
use enfilade::plan::{ElementId, Meta, Plan};
use enfilade::store::{FileState, IndexFile, bundled_plans, load_plan, save_plan};
use enfilade::topology::vertical::{Shaft, common_points, vertical_links};
use enfilade::workspace::buildings::buildings;
use enfilade::workspace::change::{Change, Selected, changed, planned};
use enfilade::workspace::index::{self, Recipe};
use enfilade::workspace::query::{self, Order, PlanColumn, Query, RoomColumn};
use enfilade::workspace::{Content, PlanFile, Workspace};
use serde_json::Value;

use crate::support::enfilade;

fn recipe() -> Recipe {
    Recipe::new(Arc::new(Schemes::bundled()), &Models::bundled())
}

/// Gives a file a time long ago, so that it counts as settled.
fn settle(path: &Path) {
    std::fs::File::open(path).unwrap().set_modified(SystemTime::UNIX_EPOCH + Duration::from_secs(1_000_000)).unwrap();
}

fn bundled(name: &str) -> Plan {
    bundled_plans().unwrap().into_iter().find(|(file, _)| file.starts_with(name)).unwrap().1
}

/// A folder with the bundled plans, a second storey of the school, a broken plan, and a file that is none.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("more")).unwrap();
    for (name, plan) in bundled_plans().unwrap() {
        save_plan(&folder.path().join(name), &plan).unwrap();
    }
    let school = bundled("school");
    save_plan(&folder.path().join("more/school first floor.plan.json"), &copied(&school, "first floor", Keep::All))
        .unwrap();
    std::fs::write(folder.path().join("broken.plan.json"), "{ \"format\": ").unwrap();
    std::fs::write(folder.path().join("picture.xml"), "<svg xmlns=\"http://www.w3.org/2000/svg\"/>").unwrap();
    folder
}

/// All that is known of a folder without an index.
fn read(folder: &Path, predicts: bool) -> Workspace {
    let listed = index::list(folder, &[], &recipe(), &Work::quiet()).unwrap();
    let mut workspace = listed.workspace;
    let files: Vec<PlanFile> =
        listed.to_read.iter().map(|path| index::read(folder, path, None, &recipe(), predicts)).collect();
    workspace.put(files);
    workspace
}

#[test]
fn an_index_is_used_where_files_are_as_they_were_and_nowhere_else() {
    let (folder, cache) = (folder(), tempfile::tempdir().unwrap());
    let recipe = recipe();
    let open = || {
        let known = IndexFile::open(cache.path(), folder.path()).unwrap();
        let listed = index::list(folder.path(), &known.files, &recipe, &Work::quiet()).unwrap();
        (known.index, listed)
    };
    let go = |predicts: bool| {
        let (index, mut listed) = open();
        let found: Vec<PlanFile> = listed
            .to_read
            .iter()
            .map(|path| {
                let known = listed.workspace.find(path).map(|at| &*listed.workspace.files()[at]);
                index::read(folder.path(), path, known, &recipe, predicts)
            })
            .collect();
        let kept: Vec<_> = found.iter().map(|file| index::to_keep(file, &recipe)).collect();
        index.keep(&kept, &listed.gone).unwrap();
        listed.workspace.put(found);
        (listed.workspace, listed.to_read.len(), listed.gone)
    };
    let (first, to_read, _) = go(false);
    assert_eq!(to_read, first.files().len());
    let school = folder.path().join("school.plan.json");
    // Just written: the time alone does not tell whether it is the same.
    let (again, to_read, _) = go(false);
    assert_eq!((again.files(), to_read > 0), (first.files(), true));
    for file in first.files() {
        settle(&first.path_of(file));
    }
    let (settled, _, _) = go(false);
    let (known, to_read, _) = go(false);
    assert_eq!((to_read, known.files()), (0, settled.files()));
    let contents =
        |workspace: &Workspace| workspace.files().iter().map(|file| file.content.clone()).collect::<Vec<_>>();
    assert_eq!(contents(&known), contents(&first));
    // Touched, and the same: nothing is found out anew.
    std::fs::File::open(&school)
        .unwrap()
        .set_modified(SystemTime::UNIX_EPOCH + Duration::from_secs(2_000_000))
        .unwrap();
    let (touched, to_read, _) = go(false);
    assert_eq!((to_read, contents(&touched)), (1, contents(&first)));
    // Changed and removed.
    let plan = load_plan(&school).unwrap();
    let renamed = edit::set_meta(&plan, Meta { building: "Elsewhere".to_owned(), ..plan.meta().clone() });
    save_plan(&school, &renamed).unwrap();
    std::fs::remove_file(folder.path().join("broken.plan.json")).unwrap();
    let (changed, to_read, gone) = go(false);
    assert_eq!((to_read, gone), (1, vec!["broken.plan.json".to_owned()]));
    let at = changed.find("school.plan.json").unwrap();
    assert_eq!(&*changed.files()[at].plans()[0].building, "Elsewhere");
    let (_, _, gone) = go(false);
    assert_eq!(gone, Vec::<String>::new());
    // Other schemes: everything is found out anew.
    let text = "version = 1\n[school]\nS = [\"dungeon\"]\n";
    let other = Recipe::new(Arc::new(Schemes::bundled().extended_by(text).unwrap()), &Models::bundled());
    let known = IndexFile::open(cache.path(), folder.path()).unwrap();
    let listed = index::list(folder.path(), &known.files, &other, &Work::quiet()).unwrap();
    assert_eq!(listed.to_read.len(), listed.workspace.files().len());
    // Beside the plans nothing is written.
    let names: BTreeSet<String> = std::fs::read_dir(folder.path())
        .unwrap()
        .map(|it| it.unwrap().file_name().to_string_lossy().into_owned())
        .collect();
    assert!(
        names.iter().all(|name| name.ends_with(".plan.json") || name == "more" || name == "picture.xml"),
        "{names:?}"
    );
}

#[test]
fn what_is_known_of_a_plan_is_what_the_other_subcommands_say() {
    let folder = folder();
    let workspace = read(folder.path(), true);
    let totals = workspace.totals();
    let plans = bundled_plans().unwrap().len() + 1;
    assert_eq!((totals.plans, totals.broken, totals.pending), (plans, 1, 0));
    // A file that is none of ours is passed over in silence.
    let at = workspace.find("picture.xml").unwrap();
    assert!(matches!(workspace.files()[at].content, Content::Foreign(_)));
    assert!(!workspace.plan_rows().any(|row| row.file as usize == at));
    for path in ["school.plan.json", "office.plan.json"] {
        let at = folder.path().join(path);
        let file = &workspace.files()[workspace.find(path).unwrap()];
        let entry = &file.plans()[0];
        assert_eq!(file.state.size, FileState::of(&at).unwrap().size);
        let (_, out, _) = enfilade(["check", "--json", at.to_str().unwrap()]);
        let checked: Value = serde_json::from_str(&out).unwrap();
        let found = |severity: &str| checked["totals"][severity].as_u64().unwrap() as u32;
        assert_eq!(entry.problems.errors, found("error"), "{path}");
        assert_eq!(entry.problems.warnings, found("warning"), "{path}");
        let (_, out, _) = enfilade(["classify", "--json", at.to_str().unwrap()]);
        let classified: Value = serde_json::from_str(&out).unwrap();
        let rooms = classified["plans"][0]["rooms"].as_array().unwrap_or_else(|| panic!("{out}"));
        for room in rooms {
            let id = room["id"].as_str().unwrap();
            let known = entry.rooms.iter().find(|known| known.id.to_string() == id).unwrap();
            let (label, probability) = known.prediction.unwrap();
            assert_eq!(room["predicted"].as_str().unwrap(), label.letter(), "{path} {id}");
            let told = room["probabilities"][label.letter()].as_f64().unwrap();
            assert!((told - f64::from(probability)).abs() < 1e-3, "{path} {id}: {told} {probability}");
        }
        assert_eq!(rooms.len(), entry.rooms.iter().filter(|room| room.prediction.is_some()).count());
    }
    let query = Query { disagrees: true, ..Query::default() };
    for row in query::rooms(&workspace, &query, Order::by(RoomColumn::Name), &Work::quiet()).unwrap() {
        assert_eq!(workspace.room(row).unwrap().2.agrees(), Some(false));
    }
}

#[test]
fn plans_and_rooms_are_searched_filtered_and_sorted() {
    let folder = folder();
    let workspace = read(folder.path(), false);
    let quiet = Work::quiet();
    let plans = |query: &Query, order| query::plans(&workspace, query, order, &quiet).unwrap();
    let rooms = |query: &Query, order| query::rooms(&workspace, query, order, &quiet).unwrap();
    let all = Query::default();
    let listed = workspace.plan_rows().count();
    for &by in PlanColumn::ALL {
        for is_descending in [false, true] {
            let mut rows = plans(&all, Order { by, is_descending });
            assert_eq!(rows, plans(&all, Order { by, is_descending }));
            rows.sort_unstable();
            rows.dedup();
            assert_eq!(rows.len(), listed, "{by:?}");
        }
        assert_eq!(PlanColumn::of_word(by.word()), Some(by));
    }
    let count = |rows: &[enfilade::workspace::PlanRow]| -> Vec<usize> {
        rows.iter().map(|row| workspace.plan(*row).unwrap().1.map_or(0, |plan| plan.rooms.len())).collect()
    };
    assert!(count(&plans(&all, Order::by(PlanColumn::Rooms))).is_sorted());
    let areas: Vec<f32> = rooms(&all, Order { by: RoomColumn::Area, is_descending: true })
        .iter()
        .map(|row| workspace.room(*row).unwrap().2.area_m2)
        .collect();
    assert!(areas.is_sorted_by(|p, q| p >= q) && areas.len() == workspace.totals().rooms);
    // The broken file comes first among problems, and only it stands for no plan.
    let worst = plans(&all, Order { by: PlanColumn::Problems, is_descending: true })[0];
    assert!(matches!(workspace.plan(worst).unwrap().0.content, Content::Broken(_)));
    // By words of functions, names, labels, and of plans.
    let named = |text: &str| Query { text: text.to_owned(), ..Query::default() };
    for row in rooms(&named("CORRIDOR"), Order::by(RoomColumn::Name)) {
        let room = workspace.room(row).unwrap().2;
        let text = format!("{} {}", room.name, room.function).to_lowercase();
        assert!(text.contains("corridor") || room.label() == Some(Label::Corridor));
    }
    let stairs = rooms(&named("function:stairs first floor"), Order::by(RoomColumn::Name));
    let of = |row: &enfilade::workspace::RoomRow| workspace.room(*row).unwrap();
    assert!(!stairs.is_empty());
    assert!(stairs.iter().all(|row| of(row).2.function.contains("stairs") && of(row).0.path.contains("first floor")));
    assert_eq!(plans(&named("function:stairs first floor"), Order::by(PlanColumn::Name)).len(), 1);
    assert_eq!(plans(&named("label:nothing"), Order::by(PlanColumn::Name)), []);
    let school = Query { typology: Some(Typology::new("school")), ..Query::default() };
    let found = plans(&school, Order::by(PlanColumn::Name));
    assert!(!found.is_empty());
    assert!(found.iter().all(|row| workspace.plan(*row).unwrap().1.unwrap().typology == Typology::new("school")));
    let wrong = Query { has_problems: true, ..Query::default() };
    assert!(plans(&wrong, Order::by(PlanColumn::Name)).iter().any(|row| row.plan.is_none()));
}

#[test]
fn a_change_of_many_is_counted_first_and_then_made() {
    let folder = folder();
    let workspace = read(folder.path(), false);
    let rows = query::rooms(
        &workspace,
        &Query { text: "function:stairs".to_owned(), ..Query::default() },
        Order::by(RoomColumn::Plan),
        &Work::quiet(),
    )
    .unwrap();
    let selected = Selected::rooms_in(&workspace, &rows);
    let change = Change::Label(Some(Label::Corridor));
    let plan = planned(&workspace, &selected, &change);
    assert_eq!((plan.changed, plan.same, plan.unwritable), (rows.len(), 0, 0));
    let files = plan.files.len();
    assert!(plan.said(&change).ends_with("get the label corridor"), "{}", plan.said(&change));
    for (path, plans) in &plan.files {
        let before = load_plan(&folder.path().join(&**path)).unwrap();
        let after = changed(&before, &plans[&0], &change).unwrap();
        for (id, room) in after.rooms() {
            let is_meant = plans[&0].contains(&id);
            assert_eq!(room.label.map(|it| it.label) == Some(Label::Corridor) && is_meant, is_meant);
            assert!(is_meant || before.room(id) == Some(room));
        }
        save_plan(&folder.path().join(&**path), &after).unwrap();
    }
    assert!(files > 1);
    let workspace = read(folder.path(), false);
    let again = planned(&workspace, &selected, &change);
    assert_eq!((again.changed, again.same), (0, rows.len()));
    // Of rooms, the plans that they are in.
    let building = Change::Building("New wing".to_owned());
    let of_plans = planned(&workspace, &selected, &building);
    assert_eq!((of_plans.changed, of_plans.files.len()), (files, files));
}

/// The school and a storey above it that was drawn elsewhere and turned.
fn turned(by_rad: f64) -> (Plan, Plan) {
    let below = bundled("school");
    let above = copied(&below, "first floor", Keep::All);
    let a = Point::new(0.0, 0.0);
    let transform = Transform::rotation(a, by_rad).then(Transform::translation(Vector::new(31.0, -12.5)));
    let points = [a, Point::new(10.0, 0.0)];
    let above = laid_over(&above, points, points.map(|point| transform.point(point))).unwrap();
    (below, above)
}

#[test]
fn stairs_and_lifts_over_each_other_are_joined_once_storeys_have_one_origin() {
    let below = bundled("school");
    let shafts: Vec<_> =
        below.rooms().filter(|(_, room)| Shaft::of_function(&room.function).is_some()).map(|(id, _)| id).collect();
    assert!(shafts.len() > 1, "the school has stairs");
    for turn_rad in [0.0, 0.35, std::f64::consts::PI] {
        let (below, above) = turned(turn_rad);
        assert_eq!(vertical_links(&below, &above), []);
        let points = common_points(&above, &below).unwrap();
        assert_eq!((points.joined, points.of), (shafts.len(), shafts.len()));
        assert!(points.mismatch_m() < 0.01, "{points:?}");
        let laid = laid_over(&above, points.here, points.below).unwrap();
        let links = vertical_links(&below, &laid);
        let joined: Vec<_> = links.iter().map(|link| (link.lower, link.upper)).collect();
        assert_eq!(joined, shafts.iter().map(|id| (*id, *id)).collect::<Vec<_>>(), "turned by {turn_rad}");
        let function = |id| &below.room(id).unwrap().function;
        assert!(
            links
                .iter()
                .all(|link| link.overlap > 0.95 && Shaft::of_function(function(link.lower)) == Some(link.shaft))
        );
    }
    // Nothing in common, nothing proposed.
    let dwelling = bundled("dwelling");
    let bare = dwelling.rooms().filter(|(_, room)| Shaft::of_function(&room.function).is_some()).map(|(id, _)| id);
    let bare: Vec<ElementId> = bare.map(ElementId::Room).collect();
    if bare.is_empty() {
        assert_eq!(common_points(&dwelling, &below), None);
    }
}

#[test]
fn a_building_is_the_plans_that_name_it_from_the_lowest_storey_up() {
    let folder = tempfile::tempdir().unwrap();
    let school = bundled("school");
    for (file, storey, building) in [
        ("a", "2nd floor", "North School"),
        ("b", "basement", "north school"),
        ("c", "ground floor", "North School"),
        ("d", "first floor", "NorthSchool"),
        ("e", "", "North School"),
        ("f", "1", "South School"),
        ("g", "", ""),
    ] {
        let meta = Meta { storey: storey.to_owned(), building: building.to_owned(), ..school.meta().clone() };
        save_plan(&folder.path().join(format!("{file}.plan.json")), &edit::set_meta(&school, meta)).unwrap();
    }
    let workspace = read(folder.path(), false);
    let found = buildings(&workspace);
    let storeys = |at: usize| -> Vec<&str> {
        found[at].storeys.iter().map(|row| workspace.plan(*row).unwrap().0.name().split('.').next().unwrap()).collect()
    };
    let at = |name: &str| found.iter().position(|building| building.name.starts_with(name)).unwrap();
    assert_eq!(storeys(at("North School")), ["b", "c", "d", "a", "e"]);
    assert_eq!(storeys(at("South")), ["f"]);
    assert_eq!(found.len(), 3);
    assert_eq!(level("2nd floor"), Some(2.0));
    let (code, out, _) = enfilade([
        "workspace",
        "--no-index",
        "--no-predictions",
        "--buildings",
        "--json",
        folder.path().to_str().unwrap(),
    ]);
    assert_eq!(code, 0);
    let told: Value = serde_json::from_str(&out).unwrap();
    let north = told["buildings"].as_array().unwrap().iter().find(|it| it["building"] == "North School").unwrap();
    assert_eq!(north["storeys"].as_array().unwrap().len(), 5);
    // Each storey lies over the one before: all its stairs are joined, between each two.
    let stairs = school.rooms().filter(|(_, room)| Shaft::of_function(&room.function).is_some()).count();
    assert_eq!(north["vertical_links"].as_array().unwrap().len(), 4 * stairs);
}

#[test]
fn the_subcommand_lists_plans_and_rooms_and_says_what_cannot_be_read() {
    let folder = folder();
    let path = folder.path().to_str().unwrap();
    let (code, out, err) = enfilade(["workspace", "--no-index", path, "--sort=-rooms"]);
    assert_eq!(code, 1);
    assert!(err.contains("broken.plan.json"), "{err}");
    assert!(out.starts_with("file ") && out.contains("cannot be read"), "{out}");
    assert!(out.contains("school first floor.plan.json"), "{out}");
    let (_, out, _) = enfilade(["workspace", "--no-index", "--json", "--rooms", "--find", "function:stairs", path]);
    let told: Value = serde_json::from_str(&out).unwrap();
    let rooms = told["rooms"].as_array().unwrap();
    assert!(!rooms.is_empty() && rooms.iter().all(|room| room["function"] == "stairs"), "{out}");
    assert!(rooms[0]["predicted_probability"].as_f64().is_some());
    let (code, _, err) = enfilade(["workspace", "--no-index", path, "--sort", "colour"]);
    assert_eq!(code, 2);
    assert!(err.contains("use 'name', 'file'"), "{err}");
}
