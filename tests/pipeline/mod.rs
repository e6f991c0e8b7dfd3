//! The single way from a plan to its labels: the command line prints what the window shows.
#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod live;

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use enfilade::base::random::Random;
use enfilade::base::units::Units;
use enfilade::base::work::{Cancelled, Work};
use enfilade::edit;
use enfilade::formats::plan_json;
use enfilade::geometry::Vector;
use enfilade::labels::{Label, Schemes, Typology};
use enfilade::pipeline::{Derived, Labelled};
use enfilade::plan::{ElementId, LabelOrigin, Meta, Plan, RoomId, RoomLabel};
use enfilade::predict::Predictor;
use enfilade::store::bundled_plans;
use serde_json::{Value, json};

use super::support::enfilade;

/// What `enfilade classify` is to say of the rooms, from what the window holds.
fn held(plan: &Plan) -> Vec<Value> {
    let derived = Derived::new(
        plan,
        &Schemes::bundled(),
        Some((Predictor::default(), enfilade::classify::models::Models::bundled())),
    );
    let predictions = derived.predictions.as_ref().unwrap();
    let rooms = predictions.network.rooms.iter().map(|room| {
        let said = predictions.distribution(room.id).unwrap();
        let probabilities: serde_json::Map<String, Value> = Label::ALL
            .into_iter()
            .map(|label| (label.letter().to_owned(), json!((said.probability(label) * 1e4).round() / 1e4)))
            .collect();
        json!({
            "room": room.key,
            "id": room.id.to_string(),
            "function": room.function,
            "label": room.label.map(Label::letter),
            "predicted": said.label().letter(),
            "probabilities": probabilities,
            "reason": derived.why(room.id, Units::Metric).map(|why| why.sentences()),
            "evidence": derived.why(room.id, Units::Metric).map(|why| why.to_value()),
        })
    });
    rooms.collect()
}

/// What it says.
fn printed(path: &Path) -> Vec<Value> {
    let (code, out, err) = enfilade(["classify".as_ref(), path.as_os_str(), "--json".as_ref()]);
    assert_eq!((code, err.as_str()), (0, ""));
    let printed: Value = serde_json::from_str(&out).unwrap();
    printed["plans"][0]["rooms"].as_array().unwrap().clone()
}

#[expect(clippy::disallowed_methods, reason = "a test's output is no user's file")]
fn assert_same(plan: &Plan, folder: &Path, what: &str) {
    let path = folder.join("edited.plan.json");
    std::fs::write(&path, plan_json::to_bytes(plan)).unwrap();
    assert_eq!(printed(&path), held(plan), "{what}");
}

/// An edit like those a person does; the plan itself where it is refused.
fn edited(plan: &Plan, random: &mut Random) -> Plan {
    let rooms: Vec<RoomId> = plan.rooms().map(|(id, _)| id).collect();
    if rooms.is_empty() {
        return plan.clone();
    }
    let room = rooms[random.below(rooms.len())];
    let result = match random.below(6) {
        0 => {
            let label = Label::ALL[random.below(5)];
            edit::set_label(plan, room, Some(RoomLabel { label, origin: LabelOrigin::Person }))
        }
        1 => edit::set_label(plan, room, None),
        2 => edit::set_function(plan, room, ["corridor", "office", "bathroom", "nonsense", ""][random.below(5)]),
        3 => {
            let openings: Vec<ElementId> = plan.openings().map(|(id, _)| ElementId::Opening(id)).collect();
            match openings.len() {
                0 => Ok(plan.clone()),
                count => edit::remove(plan, &[openings[random.below(count)]]),
            }
        }
        4 => {
            let corners: Vec<_> = plan.corners().map(|(id, corner)| (id, corner.position)).collect();
            let (id, at) = corners[random.below(corners.len())];
            edit::move_corners(plan, &[(id, at + Vector::new(random.unit() - 0.5, random.unit() - 0.5))])
        }
        _ => {
            let typology = ["school", "office", "house", ""][random.below(4)];
            Ok(edit::set_meta(plan, Meta { typology: Typology::new(typology), ..plan.meta().clone() }))
        }
    };
    result.unwrap_or_else(|_| plan.clone())
}

#[test]
fn what_classify_prints_is_what_the_window_holds() {
    let folder = tempfile::tempdir().unwrap();
    let mut random = Random::new(11);
    for (name, plan) in bundled_plans().unwrap() {
        assert!(!held(&plan).is_empty());
        assert_same(&plan, folder.path(), name);
        let mut plan = plan;
        for step in 0..24 {
            plan = edited(&plan, &mut random);
            if step % 4 == 3 {
                assert_same(&plan, folder.path(), &format!("{name} after {} edits", step + 1));
            }
        }
    }
}

#[test]
fn what_is_outdated_is_given_up() {
    let (_, plan) = bundled_plans().unwrap().remove(0);
    let schemes = Schemes::bundled();
    let outdated = AtomicBool::new(true);
    let work = Work::quiet().watched(&|_, _| {}, &outdated);
    let labelled = || Arc::new(Labelled::new(&plan, &schemes, None, None));
    assert_eq!(Derived::by_steps(labelled(), &work).err(), Some(Cancelled));
    let derived = Derived::by_steps(labelled(), &Work::quiet()).unwrap();
    assert!(derived.predictions.is_none());
    assert_eq!(derived.reading_order().len(), plan.rooms().filter(|(_, room)| room.has_boundary()).count());
}
