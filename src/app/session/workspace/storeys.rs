//! The storeys of the building that the plan shown is of: going through them, and laying them over each other.

use std::path::PathBuf;

use crate::app::session::Session;
use crate::app::session::document::Document;
use crate::app::session::origin::{Origin, file_name};
use crate::app::session::wishes::Wish;
use crate::base::natural_order::NaturalKey;
use crate::edit::storey;
use crate::formats::{self, building_name};
use crate::geometry::Point;
use crate::plan::storeys::level_key;
use crate::topology::vertical::{self, CommonPoints};
use crate::workspace::buildings;

/// A storey of the building of the plan shown.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Storey {
    pub origin: Origin,
    /// What it is called.
    pub title: String,
    pub is_shown: bool,
}

impl Session {
    /// The storeys of the building that the plan shown is of, from the lowest up: by what plans of the open workspace say;
    /// or else the plans of its file, or those beside it whose names say that they are of one building. None where only
    /// this one is known.
    pub(crate) fn storeys(&self) -> Vec<Storey> {
        let Some(document) = &self.document else { return Vec::new() };
        let found = self.storeys_of_workspace(document).or_else(|| self.storeys_by_name(document)).unwrap_or_default();
        let is_one_of_several = found.len() > 1 && found.iter().any(|(origin, _)| *origin == document.origin);
        let shown = |origin: &Origin| *origin == document.origin;
        let storey = |(origin, title): (Origin, String)| Storey { is_shown: shown(&origin), origin, title };
        if is_one_of_several { found.into_iter().map(storey).collect() } else { Vec::new() }
    }

    fn storeys_of_workspace(&self, document: &Document) -> Option<Vec<(Origin, String)>> {
        let workspace = self.workspace.as_ref()?;
        let building = buildings::building_of(&workspace.now, workspace.row_of(&document.origin)?)?;
        let storey = |row| {
            let (file, plan) = workspace.now.plan(row)?;
            let plan = plan?;
            let title = if plan.storey.is_empty() { file.title_of(plan) } else { &*plan.storey };
            let origin = workspace.origin_of(&workspace.now.plan_key(row)?);
            // As the plan shown was opened, by whatever path.
            let own = workspace.row_of(&document.origin) == Some(row);
            Some((if own { document.origin.clone() } else { origin }, title.to_owned()))
        };
        let storeys: Vec<_> = building.storeys.into_iter().filter_map(storey).collect();
        (storeys.len() > 1).then_some(storeys)
    }

    fn storeys_by_name(&self, document: &Document) -> Option<Vec<(Origin, String)>> {
        let Origin::File { path, .. } = &document.origin else { return None };
        if document.storeys.len() > 1 {
            let title = |(at, plan): (usize, &crate::plan::Plan)| {
                let meta = plan.meta();
                let title = [&meta.storey, &meta.name].into_iter().find(|it| !it.is_empty()).cloned();
                (Origin::File { path: path.clone(), storey: at }, title.unwrap_or_else(|| (at + 1).to_string()))
            };
            return Some(document.storeys.iter().enumerate().map(title).collect());
        }
        let named = |path: &PathBuf| building_name::split(formats::file_stem(&file_name(path)));
        let own = named(path);
        let key = building_name::key(&own.building);
        if own.storey.is_empty() || key.is_empty() {
            return None;
        }
        let mut storeys: Vec<(String, &PathBuf)> = self
            .list
            .files
            .iter()
            .filter(|file| file.parent() == path.parent())
            .map(|file| (named(file), file))
            .filter(|(name, _)| !name.storey.is_empty() && building_name::key(&name.building) == key)
            .map(|(name, file)| (name.storey, file))
            .collect();
        storeys.sort_by_cached_key(|(storey, _)| (level_key(storey), NaturalKey::of(storey)));
        Some(storeys.into_iter().map(|(title, path)| (Origin::File { path: path.clone(), storey: 0 }, title)).collect())
    }

    /// Opens the storey so many above the one shown, with the one below it as its ghost. Returns whether there is one.
    pub(crate) fn show_storey(&mut self, up: isize) -> bool {
        let storeys = self.storeys();
        let Some(at) = storeys.iter().position(|storey| storey.is_shown) else { return false };
        let Some(next) = at.checked_add_signed(up).filter(|next| *next < storeys.len()) else {
            let end = if up > 0 { "highest" } else { "lowest" };
            self.status =
                format!("This is the {end} storey of {}", crate::base::wording::count(storeys.len(), "storey"));
            return true;
        };
        let origin = storeys[next].origin.clone();
        let below = next.checked_sub(1).map(|below| storeys[below].origin.clone());
        self.awaited_ghost = below.map(|below| (origin.clone(), below));
        self.browses = true;
        self.open(origin);
        true
    }

    /// Shows the storey below, once its plan is there.
    pub(crate) fn show_awaited_ghost(&mut self) {
        let Some((origin, below)) = &self.awaited_ghost else { return };
        let wanted = self.open_of(origin);
        if self.document.as_ref().is_none_or(|document| wanted != Some(document.number)) {
            return;
        }
        let is_there = self.ghost.as_ref().is_some_and(|ghost| ghost.origin.as_ref() == Some(below));
        let below = below.clone();
        self.awaited_ghost = None;
        if let (Origin::File { path, storey }, false) = (below, is_there) {
            self.read_ghost(path, Some(storey));
        }
    }

    /// The points that this storey and the one below probably have in common: their stairs and lifts.
    pub(crate) fn proposed_common_points(&self) -> Option<CommonPoints> {
        vertical::common_points(self.plan()?, self.ghost_plan()?)
    }

    /// Lays the plan over the storey below: by two points of it and the same two of that storey; without, by its stairs
    /// and lifts.
    ///
    /// # Errors
    /// When no storey is shown below, the two have no stairs or lifts in common, or the points do not fit.
    pub(crate) fn lay_over_storey_below(&mut self, points: Option<[Point; 4]>) -> Result<(), String> {
        if self.ghost_plan().is_none() {
            return Err("show a storey below first".to_owned());
        }
        let (here, below, said) = match points {
            Some([a, b, p, q]) => ([a, b], [p, q], "two points".to_owned()),
            None => {
                let Some(points) = self.proposed_common_points() else {
                    return Err("the two storeys have no stairs or lifts in common; give two points of each".to_owned());
                };
                let said = format!("{} of {} stairs and lifts", points.joined, points.of);
                (points.here, points.below, said)
            }
        };
        let mismatch_m = (here[0].distance(here[1]) - below[0].distance(below[1])).abs();
        self.try_edit("Lay over the storey below", |plan| storey::laid_over(plan, here, below))
            .map_err(|error| error.to_string())?;
        let off =
            if mismatch_m < 0.005 { String::new() } else { format!(", {mismatch_m:.2} m apart at the second point") };
        self.status = format!("Laid over the storey below by {said}{off}");
        // It may have come from far away.
        self.wishes.push(Wish::Fit);
        Ok(())
    }
}
