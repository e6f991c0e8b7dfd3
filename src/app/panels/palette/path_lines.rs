//! Where a path is typed: what the folder offers, and what follows from a choice.

use std::path::PathBuf;

use super::*;
use crate::app::session::paths::{InFolder, PathUse, listed, split_typed};

/// What a folder offered when it was last looked at: looked at once, however much is typed.
#[derive(Default)]
pub(super) struct Listing {
    of: Option<(PathBuf, bool)>,
    entries: Vec<InFolder>,
}

impl Listing {
    fn look(&mut self, folder: PathBuf, use_: PathUse, is_dotted: bool) -> &[InFolder] {
        let of = Some((folder, is_dotted));
        if self.of != of {
            self.entries = of.as_ref().map(|(folder, _)| listed(folder, use_, is_dotted)).unwrap_or_default();
            self.of = of;
        }
        &self.entries
    }
}

/// The lines for a path that is being typed.
pub(super) fn path_lines(app: &App, typed: &str, use_: PathUse, listing: &mut Listing) -> Vec<Line> {
    let (folder, part) = split_typed(typed);
    let place = app.session.typed_path(folder);
    let entries = listing.look(place.clone(), use_, part.starts_with('.'));
    let mut search = Search::new(part);
    let mut found: Vec<(std::cmp::Reverse<(bool, u32)>, Line)> = Vec::new();
    for entry in entries {
        let Some(hit) = search.hit(&entry.name) else { continue };
        let begins = entry.name.to_lowercase().starts_with(&part.to_lowercase());
        let title = if entry.is_folder { format!("{}/", entry.name) } else { entry.name.clone() };
        let (lead, taken) = match (entry.is_folder, use_) {
            (true, _) => (LineLead::Icon(Icon::Folder), Taken::Typed(format!("{folder}{}/", entry.name))),
            // The name of a new file: chosen once more, it is replaced.
            (false, PathUse::New) => (LineLead::None, Taken::Typed(format!("{folder}{}", entry.name))),
            (false, _) => (LineLead::Icon(Icon::Plan), Taken::Argument(format!("{folder}{}", entry.name))),
        };
        let line = Line { lead, ..plain(title, hit.characters, taken) };
        found.push((std::cmp::Reverse((begins, hit.score)), line));
    }
    // Stable: what fits as well stays in the folder's order.
    if !search.is_empty() {
        found.sort_by_key(|(rank, _)| *rank);
    }
    let mut lines: Vec<Line> = found.into_iter().map(|(_, line)| line).collect();
    if use_ == PathUse::New && !part.is_empty() {
        let is_there = place.join(part).is_file();
        let detail = if is_there { "overwrites the file with this name" } else { "" }.to_owned();
        let line = plain(format!("Save as ‘{part}’"), Vec::new(), Taken::Argument(typed.to_owned()));
        lines.insert(0, Line { detail, lead: LineLead::Icon(Icon::Save), ..line });
    }
    if part.is_empty() {
        if use_ == PathUse::Plan && entries.iter().any(|entry| !entry.is_folder) && !folder.is_empty() {
            let line = plain("Open the whole folder".to_owned(), Vec::new(), Taken::Argument(typed.to_owned()));
            lines.push(Line { detail: "its first plan, and all below it in the list".to_owned(), ..line });
        }
        let above = folder.trim_end_matches('/').rfind('/').map(|at| folder[..=at].to_owned());
        if let Some(above) = above {
            let line = plain("..".to_owned(), Vec::new(), Taken::Typed(above));
            lines.push(Line { lead: LineLead::Icon(Icon::Folder), detail: "the folder above".to_owned(), ..line });
        }
    }
    lines
}

fn plain(title: String, characters: Vec<u32>, taken: Taken) -> Line {
    let (detail, trail, lead) = (String::new(), String::new(), LineLead::None);
    Line { title, characters, detail, trail, lead, is_available: true, taken }
}

/// What is wrong with a path that was entered, if anything.
pub(super) fn path_problem(app: &App, typed: &str, use_: PathUse) -> Option<String> {
    let path = app.session.typed_path(typed);
    let name = typed.trim();
    match use_ {
        _ if name.is_empty() => Some("type the path of a file".to_owned()),
        PathUse::New if path.is_dir() => Some(format!("{name} is a folder: add a name for the file")),
        PathUse::New if path.parent().is_some_and(|folder| !folder.is_dir()) => {
            Some("this folder does not exist".to_owned())
        }
        PathUse::New => None,
        PathUse::Plan if path.is_dir() => None,
        _ if path.is_dir() => Some(format!("{name} is a folder: choose a file in it")),
        _ if !path.is_file() => Some(format!("there is no file {name}")),
        _ => None,
    }
}
