//! The storey below: another plan, drawn faintly under the open one.

use crate::app::session::Session;
use crate::app::session::origin::file_name;
use std::cell::RefCell;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::app::session::words::Choice;
use crate::app::session::{
    document::{self, Derived, Opened},
    jobs::Kind,
    messages::Severity,
    origin::Origin,
};
use crate::formats::{self, FileError, building_name};
use crate::geometry::{Segment, polygon};
use crate::labels::Schemes;
use crate::plan::Plan;
use crate::topology::vertical::{VerticalLink, vertical_links};

/// The plan shown below the open one.
pub(crate) struct Ghost {
    pub plan: Plan,
    /// Its title.
    pub title: String,
    /// Where it was read from; `None` for a plan that was copied.
    pub origin: Option<Origin>,
    pub(crate) derived: Arc<Derived>,
    segments: Vec<Segment>,
    /// The links last found, and the plan above that they lead to.
    links: RefCell<Option<(Plan, Arc<[VerticalLink]>)>>,
}

impl Ghost {
    pub(crate) fn new(plan: Plan, origin: Option<Origin>, schemes: &Schemes) -> Self {
        let derived = Arc::new(Derived::new(&plan, schemes, None));
        let walls = plan.walls().filter_map(|(_, wall)| plan.wall_segment(wall));
        let rings = derived.analysis.shapes.all().iter().flat_map(crate::topology::RoomShape::rings);
        let edges = rings.flat_map(|ring| polygon::edges(ring));
        let openings = plan.openings().filter_map(|(_, opening)| plan.opening_segment(opening));
        let segments = walls.chain(edges).chain(openings).collect();
        let name = plan.meta().name.clone();
        let title = origin.as_ref().filter(|_| name.is_empty()).map_or(name, Origin::title);
        Self { plan, title, origin, derived, segments, links: RefCell::default() }
    }

    /// Its stairs and lifts that lead to those of the plan above: found anew only when that plan has changed.
    pub(crate) fn links_to(&self, above: &Plan) -> Arc<[VerticalLink]> {
        let mut known = self.links.borrow_mut();
        match known.as_ref() {
            Some((plan, links)) if plan.is_same_value(above) => links.clone(),
            _ => {
                let links: Arc<[VerticalLink]> = vertical_links(&self.plan, above).into();
                *known = Some((above.clone(), links.clone()));
                links
            }
        }
    }
}

impl Session {
    /// The plan of the storey shown below, if any, for snapping.
    pub fn ghost_plan(&self) -> Option<&Plan> {
        self.shown_ghost().map(|ghost| &ghost.plan)
    }

    /// The centre lines of walls, edges of rooms, and openings of the storey shown below.
    pub fn ghost_segments(&self) -> &[Segment] {
        self.shown_ghost().map_or(&[], |ghost| &ghost.segments)
    }

    pub(crate) fn shown_ghost(&self) -> Option<&Ghost> {
        self.ghost.as_ref().filter(|_| self.layers.ghost)
    }

    /// Reads a plan and shows it below the open one. Without a storey, the first in the file; for the
    /// open file the one before the open one or, if there is none, the one after.
    pub(crate) fn read_ghost(&mut self, path: PathBuf, storey: Option<usize>) {
        let open = self.document.as_ref().map(|document| &document.origin);
        let storey = storey.unwrap_or_else(|| match open {
            Some(Origin::File { path: open, storey }) if *open == path => storey.checked_sub(1).unwrap_or(1),
            _ => 0,
        });
        let origin = Origin::File { path, storey };
        let schemes = self.schemes.clone();
        self.jobs.start(Kind::new("read the storey below").newest_of("storey below"), move |_| {
            let read = document::open(origin.clone()).map(|Opened { origin, mut storeys, .. }| {
                let storey = if let Origin::File { storey, .. } = origin { storey } else { 0 };
                let number = storeys.len();
                let plan =
                    if storeys.is_empty() { Plan::default() } else { storeys.swap_remove(storey.min(number - 1)) };
                Ghost::new(plan, Some(origin), &schemes)
            });
            move |session: &mut Session, _: &_| session.ghost_was_read(&origin, read)
        });
    }

    pub(crate) fn ghost_was_read(&mut self, origin: &Origin, result: Result<Ghost, FileError>) {
        match result {
            Ok(ghost) => {
                let links = self.plan().map_or(0, |plan| ghost.links_to(plan).len());
                let joined = if links == 0 { String::new() } else { format!("; stairs and lifts joined: {links}") };
                self.status = format!("Below: {}{joined}", ghost.title);
                self.show_ghost(Some(ghost));
            }
            Err(FileError { path, error }) => {
                let text = format!("Cannot read {} to show it below", origin.title());
                self.say(Severity::Error, text, format!("{error}\n{}", self.shown_path(&path)));
            }
        }
    }

    pub(crate) fn show_ghost(&mut self, ghost: Option<Ghost>) {
        self.ghost = ghost;
        self.layers.ghost = true;
    }

    /// The plans that may be shown below: those of the folder, those of the same building first.
    pub(crate) fn ghost_choices(&self) -> Vec<Choice> {
        let Some(document) = &self.document else { return Vec::new() };
        let building = |stem: &str| building_name::key(&building_name::split(stem).building);
        let meta = document.plan().meta();
        let own = if meta.building.is_empty() {
            building(&document.origin.stem())
        } else {
            building_name::key(&meta.building)
        };
        let is_same = |path: &PathBuf| {
            let name = file_name(path);
            !own.is_empty() && building(formats::file_stem(&name)) == own
        };
        let is_open = |path: &Path| document.origin.path() == Some(path);
        // A file with one plan cannot be below itself.
        let files = self.list.files.iter().filter(|path| !is_open(path) || document.storeys.len() > 1);
        let mut files: Vec<(bool, &PathBuf)> = files.map(|path| (is_open(path) || is_same(path), path)).collect();
        files.sort_by_key(|(is_same, _)| !is_same);
        let choice = |(is_same, path): (bool, &PathBuf)| Choice {
            word: path.to_string_lossy().into_owned(),
            title: file_name(path),
            detail: match (is_open(path), is_same) {
                (true, _) => "another storey of the open file".to_owned(),
                (false, true) => "of the same building, by its name".to_owned(),
                (false, false) => String::new(),
            },
            trail: String::new(),
            status: None,
        };
        files.into_iter().map(choice).collect()
    }
}
