//! Buildings of several storeys: the plans that name one building, from the lowest storey up.

use std::collections::BTreeMap;

use super::{PlanRow, Workspace};
use crate::base::natural_order::NaturalKey;
use crate::formats::building_name;
use crate::labels::Typology;

/// The plans that name one building.
#[derive(Clone, Debug, PartialEq)]
pub struct Building {
    /// As its first plan spells it.
    pub name: String,
    pub typology: Option<Typology>,
    /// From the lowest storey up; those of which nobody knows how high they are come last.
    pub storeys: Vec<PlanRow>,
}

/// Which storey a text means, counted from the ground floor, 0: 'basement' is -1, '2nd floor' and 'p2' are 2, 'mezzanine'
/// is between 0 and 1; `None` if it does not say. Numbers are taken as they are written, wherever they begin.
pub fn level(storey: &str) -> Option<f64> {
    const WORDS: [(&str, f64); 33] = [
        ("sub basement", -2.0),
        ("basement", -1.0),
        ("cellar", -1.0),
        ("interrato", -1.0),
        ("seminterrato", -0.5),
        ("keller", -1.0),
        ("lower", -0.5),
        ("ground", 0.0),
        ("terra", 0.0),
        ("pt", 0.0),
        ("eg", 0.0),
        ("erdgeschoss", 0.0),
        ("main", 0.25),
        ("rialzato", 0.25),
        ("mezzanine", 0.5),
        ("middle", 0.75),
        ("first", 1.0),
        ("primo", 1.0),
        ("second", 2.0),
        ("secondo", 2.0),
        ("third", 3.0),
        ("terzo", 3.0),
        ("fourth", 4.0),
        ("quarto", 4.0),
        ("fifth", 5.0),
        ("sixth", 6.0),
        ("seventh", 7.0),
        ("eighth", 8.0),
        ("ninth", 9.0),
        ("tenth", 10.0),
        ("upper", 50.0),
        ("top", 100.0),
        ("attic", 101.0),
    ];
    let text = storey.trim().to_lowercase();
    let digits = |from: &str| {
        let end = from.find(|c: char| !c.is_ascii_digit()).unwrap_or(from.len());
        from[..end].parse::<f64>().ok()
    };
    if let Some(at) = text.find(|c: char| c.is_ascii_digit()) {
        let number = digits(&text[at..])?;
        let before = text[..at].trim_end();
        let is_below = before.ends_with(['-', '−', '–']) && before.len() <= 3
            || before.ends_with("basement")
            || before.ends_with("ug")
            || before == "b";
        return Some(if is_below { -number } else { number });
    }
    let words: Vec<&str> = text.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty()).collect();
    WORDS.iter().find(|(word, _)| words.contains(word) || text == *word).map(|(_, level)| *level)
}

/// A storey as a whole number to sort by; the highest for one that does not say.
pub fn level_key(storey: &str) -> i64 {
    level(storey).map_or(i64::MAX, |level| (level * 1000.0) as i64)
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn storeys_stand_from_the_lowest_up() {
        let storeys = [
            "2nd basement",
            "-1",
            "basement",
            "ground floor",
            "mezzanine",
            "first floor",
            "1",
            "p2",
            "2nd floor",
            "level 3",
            "10",
            "top",
            "attic",
            "west wing",
        ];
        let levels: Vec<Option<f64>> = storeys.iter().skip(1).map(|storey| level(storey)).collect();
        let known: Vec<f64> = levels.iter().flatten().copied().collect();
        assert!(known.is_sorted(), "{levels:?}");
        assert_eq!(known.len(), storeys.len() - 2);
        assert_eq!(level("piano terra"), Some(0.0));
        assert_eq!(level("piano secondo"), Some(2.0));
        assert_eq!(level("EG"), Some(0.0));
        assert_eq!(level(""), None);
        assert_eq!(level("terrace"), None);
    }
}
