//! Buildings of several storeys: the plans that name one building, from the lowest storey up.

use std::collections::BTreeMap;

use super::{PlanRow, Workspace};
use crate::base::natural_order::NaturalKey;
use crate::formats::building_name;
use crate::labels::Typology;
use crate::plan::storeys::level_key;

/// The plans that name one building.
#[derive(Clone, Debug, PartialEq)]
pub struct Building {
    /// As its first plan spells it.
    pub name: String,
    pub typology: Option<Typology>,
    /// From the lowest storey up; those of which nobody knows how high they are come last.
    pub storeys: Vec<PlanRow>,
}

/// The buildings of a workspace in natural order of their names. Spellings of one name are one building, and so are plans
/// of one typology only, as folds take them; a plan that names no building is one of its own.
pub fn buildings(workspace: &Workspace) -> Vec<Building> {
    type Key = (Option<Typology>, String, Option<PlanRow>);
    let mut found: BTreeMap<Key, Building> = BTreeMap::new();
    for row in workspace.plan_rows() {
        let Some((file, Some(plan))) = workspace.plan(row) else { continue };
        let key = building_name::key(&plan.building);
        let alone = key.is_empty().then_some(row);
        let building = found.entry((plan.typology.clone(), key, alone)).or_insert_with(|| Building {
            name: if plan.building.is_empty() { file.title_of(plan).to_owned() } else { plan.building.to_string() },
            typology: plan.typology.clone(),
            storeys: Vec::new(),
        });
        building.storeys.push(row);
    }
    let mut buildings: Vec<Building> = found.into_values().collect();
    for building in &mut buildings {
        building.storeys.sort_by_cached_key(|row| {
            let plan = workspace.plan(*row).and_then(|(_, plan)| plan);
            plan.map(|plan| (level_key(&plan.storey), NaturalKey::of(&plan.storey), NaturalKey::of(&plan.name), *row))
        });
    }
    buildings.sort_by_cached_key(|building| (NaturalKey::of(&building.name), building.storeys.first().copied()));
    buildings
}

/// The building of a plan.
pub fn building_of(workspace: &Workspace, row: PlanRow) -> Option<Building> {
    buildings(workspace).into_iter().find(|building| building.storeys.contains(&row))
}
