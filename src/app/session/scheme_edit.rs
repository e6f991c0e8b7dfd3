//! Label schemes of one's own: what would change, and saving them.

use std::path::PathBuf;
use std::sync::Arc;

use egui::Context;

use super::Session;
use crate::app::session::at_hand::Affected;
use crate::app::session::jobs::Kind;
use crate::app::session::messages::Severity;
use crate::base::file_name::component;
use crate::base::wording::count;
use crate::labels::{Schemes, Typology, scheme_file};
use crate::store::{self, SCHEME_ENDING};

impl Session {
    /// The folder of the user's own schemes.
    pub(crate) fn own_schemes_folder(&self) -> Option<PathBuf> {
        // A script's schemes stay in its own folder.
        self.named_from.as_ref().map(|folder| folder.join("schemes")).or_else(store::schemes_folder)
    }

    /// The schemes with changes to a typology, and what would change in the rooms at hand.
    pub(crate) fn scheme_preview(
        &self,
        typology: &Typology,
        changes: &scheme_file::Changes,
    ) -> Option<(Schemes, Affected)> {
        let text = scheme_file::with_changes(None, typology, changes).ok()?;
        let after = (*self.schemes).clone().extended_by(&text).ok()?;
        let affected = self.at_hand.read.as_ref().map(|at_hand| at_hand.affected(typology, &self.schemes, &after));
        Some((after, affected.unwrap_or_default()))
    }

    /// Saves changes to a typology's scheme, and uses it from then on.
    ///
    /// # Errors
    /// When the changes are not understood, or there is no folder for schemes.
    pub(crate) fn save_scheme(&mut self, typology: &Typology, changes: &str) -> Result<(), String> {
        let changes = scheme_file::read_changes(changes).map_err(|error| error.to_string())?;
        let folder = self.own_schemes_folder().ok_or("this system has no folder for your own schemes")?;
        component(typology.as_str()).map_err(|error| format!("the typology cannot be a file's name: {error}"))?;
        let affected = self.scheme_preview(typology, &changes).map(|(_, affected)| affected).unwrap_or_default();
        let (path, typology) = (folder.join(format!("{typology}{SCHEME_ENDING}")), typology.clone());
        self.jobs.start(Kind::new("save a label scheme").must_end(), move |_| {
            let save = || -> Result<Schemes, String> {
                std::fs::create_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
                let before = match std::fs::read_to_string(&path) {
                    Ok(text) => Some(text),
                    Err(error) if error.kind() == std::io::ErrorKind::NotFound => None,
                    Err(error) => return Err(format!("{}: {error}", path.display())),
                };
                let text = scheme_file::with_changes(before.as_deref(), &typology, &changes)
                    .map_err(|error| format!("{}: {error}", path.display()))?;
                store::save_bytes(&path, text.as_bytes()).map_err(|error| error.to_string())?;
                Ok(store::schemes_in(&folder).0)
            };
            let saved = save();
            move |session: &mut Session, _: &Context| match saved {
                Err(error) => session.say(Severity::Error, "The label scheme was not saved", error),
                Ok(schemes) => {
                    session.schemes = Arc::new(schemes);
                    session.predict_anew();
                    let text = format!("The label scheme of {typology} was saved");
                    session.status.clone_from(&text);
                    let Affected { rooms, plans } = affected;
                    let detail = if rooms > 0 {
                        let verb = if rooms == 1 { "changes its label" } else { "change their label" };
                        format!("{} in {} {verb}.", count(rooms, "room"), count(plans, "plan"))
                    } else {
                        String::new()
                    };
                    session.say(
                        Severity::Info,
                        text,
                        format!("{detail}\n{}", session.shown_path(&path)).trim().to_owned(),
                    );
                    session.read_rooms_again();
                }
            }
        });
        Ok(())
    }
}
