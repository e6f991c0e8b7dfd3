//! Labels that are worked out from those before an edit are those that would be worked out anew, to the last bit, and those
//! that `enfilade classify` prints for the saved file.

use enfilade::base::random::Random;
use enfilade::base::units::Units;
use enfilade::classify::Method;
use enfilade::classify::models::Models;
use enfilade::edit;
use enfilade::features::NeighbourLabels;
use enfilade::geometry::Vector;
use enfilade::labels::Schemes;
use enfilade::pipeline::{Labelled, LabelledBy, SecondOpinion};
use enfilade::plan::{ElementId, OpeningId, Plan, RoomId};
use enfilade::predict::{ModelSet, Predictions, Predictor};
use enfilade::store::bundled_plans;
use proptest::prelude::*;

use super::{assert_same, edited};
use crate::support::is_whole;
use crate::support::large_school::large_school;

/// An edit like those a person does, or one taken back.
fn next(plan: &Plan, before: &Plan, random: &mut Random) -> Plan {
    let openings: Vec<OpeningId> = plan.openings().map(|(id, _)| id).collect();
    let rooms: Vec<RoomId> = plan.rooms().map(|(id, _)| id).collect();
    let away = |random: &mut Random, most_m: f64| {
        Vector::new(most_m * (2.0 * random.unit() - 1.0), most_m * (2.0 * random.unit() - 1.0))
    };
    let result = match random.below(8) {
        0 if !openings.is_empty() => {
            let id = openings[random.below(openings.len())];
            let at = plan.opening(id).and_then(|opening| plan.opening_segment(opening)).map(|it| it.midpoint());
            edit::slide_opening(plan, id, at.unwrap_or_default() + away(random, 6.0))
        }
        1 if !openings.is_empty() => {
            edit::resize_opening(plan, openings[random.below(openings.len())], 0.6 + random.unit())
        }
        2 if rooms.len() > 3 => edit::remove(plan, &[ElementId::Room(rooms[random.below(rooms.len())])]),
        3 if !rooms.is_empty() => {
            let room = [ElementId::Room(rooms[random.below(rooms.len())])].into();
            edit::fragment(plan, &room).and_then(|part| {
                let by = enfilade::geometry::Transform::translation(away(random, 40.0));
                edit::insert(plan, &part, by).map(|(plan, _)| plan)
            })
        }
        4 => Ok(before.clone()),
        _ => Ok(edited(plan, random)),
    };
    result.unwrap_or_else(|_| plan.clone())
}

fn assert_equal(live: &Predictions, anew: &Predictions, what: &str) {
    assert_eq!(live.network.rooms, anew.network.rooms, "{what}");
    assert_eq!(live.choice, anew.choice, "{what}");
    assert_eq!(live.model.name, anew.model.name, "{what}");
    assert_eq!(live.result, anew.result, "{what}");
}

/// Edits a plan, and compares the labels after each edit.
fn edits(mut plan: Plan, by: &LabelledBy, edits: usize, random: &mut Random) -> Plan {
    let (schemes, models) = (Schemes::bundled(), Models::bundled());
    let by = Some((by, &models));
    let mut before = plan.clone();
    let mut live = Labelled::new(&plan, &schemes, by, None);
    for step in 0..edits {
        let after = next(&plan, &before, random);
        before = std::mem::replace(&mut plan, after);
        live = Labelled::new(&plan, &schemes, by, Some(&live));
        let anew = Labelled::new(&plan, &schemes, by, None);
        let what = format!("after {} edits", step + 1);
        for (live, anew) in [(&live.predictions, &anew.predictions), (&live.second, &anew.second)] {
            assert_eq!(live.is_some(), anew.is_some(), "{what}");
            if let Some((live, anew)) = live.as_ref().zip(anew.as_ref()) {
                assert_equal(live, anew, &what);
                if let Some(room) = live.network.rooms.first() {
                    assert_eq!(live.why(room.id, Units::Metric), anew.why(room.id, Units::Metric), "{what}");
                }
            }
        }
        assert_eq!(live.analysis.graph.connections(), anew.analysis.graph.connections(), "{what}");
        assert_eq!(live.analysis.shapes.all(), anew.analysis.shapes.all(), "{what}");
    }
    plan
}

proptest! {
    #![proptest_config(ProptestConfig { cases: if is_whole() { 200 } else { 5 }, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn live_labels_are_those_of_the_saved_file(seed in any::<u64>(), which in 0..3_usize) {
        let (_, plan) = bundled_plans().unwrap().swap_remove(which);
        let plan = edits(plan, &LabelledBy::default(), 6, &mut Random::new(seed));
        let folder = tempfile::tempdir().unwrap();
        assert_same(&plan, folder.path(), &format!("seed {seed}"));
    }
}

#[test]
fn labels_of_a_large_plan_and_by_other_methods_follow_edits() {
    let mut random = Random::new(5);
    let rooms = if is_whole() { 1200 } else { 155 };
    let many = if is_whole() { 60 } else { 4 };
    edits(large_school(rooms), &LabelledBy::default(), many, &mut random);
    let methods = [(ModelSet::Auto, "joint", "knn"), (ModelSet::OfPlan, "tree", "blend")];
    for (set, method, second) in methods {
        let predictor = Predictor { set, method: method.parse().unwrap() };
        let method: Method = second.parse().unwrap();
        let second = Some(SecondOpinion { method, neighbours: Some(NeighbourLabels::Predicted) });
        let (_, plan) = bundled_plans().unwrap().swap_remove(2);
        edits(plan, &LabelledBy { predictor, second }, 3, &mut random);
    }
}
