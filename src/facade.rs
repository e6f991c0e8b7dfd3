//! The short way to results, for programs that use this library: open a plan, ask what follows from it.

use std::fmt;
use std::path::Path;
use std::sync::Arc;

use crate::classify::model_file::ModelFileError;
use crate::classify::models::Models;
use crate::draw::sheet::{self, Furniture, PageSize};
use crate::draw::{Style, png, svg};
use crate::features::Analysis;
use crate::formats::{self, FileError, Note};
use crate::labels::Schemes;
use crate::picture::png::PictureError;
use crate::pipeline::{Asked, Pipeline};
use crate::plan::Plan;
use crate::predict::Predictions;
use crate::store::{self, ModelError, SaveError, SchemeFileError};

/// Opens a plan file of any known format.
///
/// ```
/// let plan = enfilade::open("plans/office.plan.json")?;
/// let features = plan.analyse();
/// let labels = plan.classify()?;
/// for (id, room) in plan.plan().rooms() {
///     let area_m2 = features.room(id).and_then(|of_room| of_room.features).map(|f| f.area_m2);
///     println!("{}: {area_m2:?} m², {:?}", room.name, labels.label(id));
/// }
/// # assert!(plan.plan().rooms().all(|(id, _)| features.room(id).is_some_and(|of_room| of_room.features.is_some())));
/// # assert!(plan.plan().rooms().any(|(id, _)| labels.label(id).is_some()));
/// # Ok::<(), enfilade::Error>(())
/// ```
///
/// # Errors
/// When the file cannot be read, is of no known format, or holds several plans: those are for [`open_all`].
///
/// ```
/// let error = enfilade::open("plans/no_such.plan.json").unwrap_err();
/// assert!(error.to_string().contains("no_such.plan.json"));
/// ```
pub fn open(path: impl AsRef<Path>) -> Result<OpenPlan, Error> {
    let path = path.as_ref();
    let mut all = open_all(path)?;
    match (all.len(), all.pop()) {
        (1, Some(plan)) => Ok(plan),
        (plans, _) => Err(Error::Several { path: path.to_owned(), plans }),
    }
}

/// Opens all plans of a file, the storeys of a building say.
///
/// ```
/// for storey in enfilade::open_all("plans/school.plan.json")? {
///     println!("{}: {} rooms", storey.plan().meta().name, storey.plan().rooms().len());
/// }
/// # Ok::<(), enfilade::Error>(())
/// ```
///
/// # Errors
/// When the file cannot be read or is of no known format.
pub fn open_all(path: impl AsRef<Path>) -> Result<Vec<OpenPlan>, Error> {
    let import = formats::read_file(path.as_ref())?;
    let open = |plan| OpenPlan { plan, notes: import.notes.clone(), schemes: Schemes::bundled() };
    Ok(import.plans.into_iter().map(open).collect())
}

/// A plan, and by which label schemes its rooms are read.
#[derive(Clone, Debug)]
pub struct OpenPlan {
    plan: Plan,
    notes: Vec<Note>,
    schemes: Schemes,
}

impl OpenPlan {
    /// A plan that was made in memory, by the bundled schemes.
    pub fn new(plan: Plan) -> Self {
        Self { plan, notes: Vec::new(), schemes: Schemes::bundled() }
    }

    /// The same plan, by the bundled schemes extended by a file.
    ///
    /// # Errors
    /// When the file cannot be read or is no label scheme.
    pub fn with_scheme(self, path: impl AsRef<Path>) -> Result<Self, Error> {
        Ok(Self { schemes: store::with_scheme_file(self.schemes, path.as_ref())?, ..self })
    }

    /// Its rooms, walls and openings.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// What its file's reader mended or left out.
    pub fn notes(&self) -> &[Note] {
        &self.notes
    }

    /// Areas, graph, and the features `F_r` of each room.
    pub fn analyse(&self) -> Arc<Analysis> {
        Pipeline::new(&self.plan, &self.schemes).into_analysis()
    }

    /// The label of each room by the bundled models of the plan's typology, which is inferred where it states none.
    ///
    /// # Errors
    /// When a bundled model cannot be read, which the tests exclude.
    pub fn classify(&self) -> Result<Predictions, Error> {
        self.classify_as(&Asked { models: Models::bundled(), ..Asked::default() })
    }

    /// The label of each room, with a choice of models.
    ///
    /// ```
    /// use enfilade::pipeline::Asked;
    /// let plan = enfilade::open("plans/dwelling.plan.json")?;
    /// // As if nobody had labelled a room.
    /// let labels = plan.classify_as(&Asked { hides_labels: true, ..Asked::default() })?;
    /// println!("{}", labels.agreement());
    /// # assert!(labels.agreement().known > labels.agreement().right);
    /// # Ok::<(), enfilade::Error>(())
    /// ```
    ///
    /// # Errors
    /// When a bundled model cannot be read, which the tests exclude.
    pub fn classify_as(&self, asked: &Asked) -> Result<Predictions, Error> {
        Ok(Pipeline::new(&self.plan, &self.schemes).predictions(asked)?)
    }

    /// The plan as an SVG picture, `longest_px` pixels along the longer side.
    ///
    /// ```
    /// let plan = enfilade::open("plans/dwelling.plan.json")?;
    /// assert!(plan.svg(800.0).starts_with("<svg"));
    /// # Ok::<(), enfilade::Error>(())
    /// ```
    pub fn svg(&self, longest_px: f64) -> String {
        svg::svg(&self.scene(longest_px))
    }

    /// The plan as a PNG picture, `longest_px` pixels along the longer side.
    ///
    /// # Errors
    /// When a picture of that size cannot be drawn.
    pub fn png(&self, longest_px: f64) -> Result<Vec<u8>, Error> {
        Ok(png::png(&self.scene(longest_px))?)
    }

    fn scene(&self, longest_px: f64) -> crate::draw::Scene {
        let drawing = Pipeline::new(&self.plan, &self.schemes).drawing(None);
        sheet::page(&drawing, &Style::default(), PageSize::Longest(longest_px), Furniture::default())
    }

    /// Saves the plan as a plan file; what is there is replaced, whole or not at all.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        Ok(store::save_plan(path.as_ref(), &self.plan)?)
    }
}

/// Why there is no result, in words for people.
#[derive(Debug)]
#[non_exhaustive]
pub enum Error {
    /// A plan file cannot be read.
    Read(FileError),
    /// A file holds more plans than the one that was asked for, or none.
    Several { path: std::path::PathBuf, plans: usize },
    /// A label scheme cannot be read.
    Scheme(SchemeFileError),
    /// A model's file cannot be read.
    Model(ModelError),
    /// A bundled model cannot be read.
    BundledModel(ModelFileError),
    /// A picture cannot be drawn.
    Picture(PictureError),
    /// A file cannot be written.
    Save(SaveError),
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Read(error) => error.fmt(f),
            Self::Several { path, plans } => write!(f, "{}: holds {plans} plans; use open_all", path.display()),
            Self::Scheme(error) => error.fmt(f),
            Self::Model(error) => error.fmt(f),
            Self::BundledModel(error) => error.fmt(f),
            Self::Picture(error) => error.fmt(f),
            Self::Save(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for Error {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Read(error) => Some(error),
            Self::Several { .. } => None,
            Self::Scheme(error) => Some(error),
            Self::Model(error) => Some(error),
            Self::BundledModel(error) => Some(error),
            Self::Picture(error) => Some(error),
            Self::Save(error) => Some(error),
        }
    }
}

macro_rules! from {
    ($($error:ty => $kind:ident),* $(,)?) => {
        $(impl From<$error> for Error {
            fn from(error: $error) -> Self {
                Self::$kind(error)
            }
        })*
    };
}

from! {
    FileError => Read,
    SchemeFileError => Scheme,
    ModelError => Model,
    ModelFileError => BundledModel,
    PictureError => Picture,
    SaveError => Save,
}
