use std::io::Write as _;
use std::path::PathBuf;

use serde_json::{Value, json};

use super::door::{Paint, one_line};
use super::progress::with_progress;
use super::{CliError, Outcome, Subcommand, Terminal, inputs};
use crate::base::wording::{count, or_list, shortened};
use crate::classify::models::Models;
use crate::features::RoomStatus;
use crate::formats::{self, building_name};
use crate::labels::Typology;
use crate::store::{self, IndexError, IndexFile};
use crate::topology::vertical::{self, VerticalLink};
use crate::workspace::buildings::{Building, buildings};
use crate::workspace::index::{self, Recipe};
use crate::workspace::query::{self, Order, PlanColumn, Query, RoomColumn};
use crate::workspace::{Content, PlanEntry, PlanFile, PlanRow, RoomRow, Workspace};

/// `enfilade workspace`: all plans and rooms of a folder.
#[derive(clap::Args)]
pub struct WorkspaceCommand {
    /// Folder of plans
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// List rooms instead of plans
    #[arg(long, conflicts_with = "buildings")]
    rooms: bool,
    /// List buildings with their storeys from the lowest up, and the stairs and lifts that join them
    #[arg(long)]
    buildings: bool,
    /// Only what has these words in a function, name or label, or in what its plan is called; 'function:office' in one
    #[arg(long, value_name = "TEXT", default_value = "")]
    find: String,
    /// Only plans of this typology; 'unknown' for those without
    #[arg(long, value_name = "TYPOLOGY")]
    typology: Option<String>,
    /// Only plans of this building
    #[arg(long, value_name = "NAME")]
    building: Option<String>,
    /// Only plans with errors or warnings, or that cannot be read
    #[arg(long)]
    problems: bool,
    /// Only plans with rooms that want a label, or such rooms
    #[arg(long)]
    unlabelled: bool,
    /// Only plans with rooms whose label is not the predicted one, or such rooms
    #[arg(long)]
    disagreeing: bool,
    /// Sort by this column; with a minus before it, the largest first (as --sort=-rooms)
    #[arg(long, value_name = "COLUMN", allow_hyphen_values = true)]
    sort: Option<String>,
    /// Do not predict labels: the first time is much quicker
    #[arg(long)]
    no_predictions: bool,
    /// Neither use nor keep what was found out the last time
    #[arg(long)]
    no_index: bool,
    /// Print JSON (docs/json/workspace.md describes it)
    #[arg(long)]
    json: bool,
    /// Label scheme to add to the bundled ones (can be repeated)
    #[arg(long, value_name = "FILE.scheme.toml")]
    scheme: Vec<PathBuf>,
}

/// How a table is sorted.
enum Sorted {
    Plans(Order<PlanColumn>),
    Rooms(Order<RoomColumn>),
}

impl Subcommand for WorkspaceCommand {
    const NAME: &'static str = "workspace";
    const ABOUT: &'static str = "List the plans, rooms or buildings of a folder";
    const EXAMPLE: &'static str = "enfilade workspace plans --rooms --find \"function:office\" --sort=-area";

    fn more_help() -> String {
        let words = |columns: Vec<&str>| columns.join(", ");
        format!(
            "Columns of plans: {}\nColumns of rooms: {}",
            words(PlanColumn::ALL.iter().map(|column| column.word()).collect()),
            words(RoomColumn::ALL.iter().map(|column| column.word()).collect())
        )
    }

    fn run(self, terminal: &mut Terminal) -> Result<Outcome, CliError> {
        let sorted = self.sorted()?;
        if !self.folder.is_dir() {
            return Err(CliError::new(format!("{}: is no folder; name a folder of plans", self.folder.display())));
        }
        let recipe = Recipe::new(std::sync::Arc::new(inputs::schemes(&self.scheme)?), &Models::bundled());
        let workspace = self.read(&recipe, terminal)?;
        if workspace.plan_rows().next().is_none() {
            return Err(CliError::new(format!("{}: no plan files in this folder", self.folder.display())));
        }
        let query = self.query();
        let work = crate::base::work::Work::quiet();
        match sorted {
            _ if self.buildings => self.print_buildings(&workspace, &query, terminal)?,
            Sorted::Plans(order) => {
                let rows = query::plans(&workspace, &query, order, &work)?;
                if self.json {
                    self.json_plans(&workspace, &rows, terminal)?
                } else {
                    print_plans(&workspace, &rows, terminal)?
                }
            }
            Sorted::Rooms(order) => {
                let rows = query::rooms(&workspace, &query, order, &work)?;
                if self.json {
                    self.json_rooms(&workspace, &rows, terminal)?
                } else {
                    print_rooms(&workspace, &rows, terminal)?
                }
            }
        }
        for file in workspace.files() {
            if let Content::Broken(what) = &file.content {
                terminal.error(format!("{}: {what}", workspace.path_of(file).display()))?;
            }
        }
        Ok(if workspace.totals().broken == 0 { Outcome::Done } else { Outcome::InputWrong })
    }
}

impl WorkspaceCommand {
    fn sorted(&self) -> Result<Sorted, CliError> {
        let word = self.sort.as_deref().unwrap_or("");
        let (is_descending, word) = word.strip_prefix('-').map_or((false, word), |word| (true, word));
        let none = |words: Vec<&str>| {
            CliError::call(format!("--sort {word}: there is no such column; use {}", or_list(&words)))
        };
        if self.rooms {
            let by = if word.is_empty() { Some(RoomColumn::Plan) } else { RoomColumn::of_word(word) };
            let by = by.ok_or_else(|| none(RoomColumn::ALL.iter().map(|column| column.word()).collect()))?;
            return Ok(Sorted::Rooms(Order { by, is_descending }));
        }
        let by = if word.is_empty() { Some(PlanColumn::File) } else { PlanColumn::of_word(word) };
        let by = by.ok_or_else(|| none(PlanColumn::ALL.iter().map(|column| column.word()).collect()))?;
        Ok(Sorted::Plans(Order { by, is_descending }))
    }

    fn query(&self) -> Query {
        let typology = self.typology.as_deref();
        Query {
            text: self.find.clone(),
            typology: typology.map(|word| Typology::new(word).filter(|typology| typology.as_str() != "unknown")),
            building: self.building.clone(),
            has_problems: self.problems,
            is_unlabelled: self.unlabelled,
            disagrees: self.disagreeing,
        }
    }

    /// Everything that is to be known of the folder: from the index, and from the files that are not as they were.
    fn read(&self, recipe: &Recipe, terminal: &mut Terminal) -> Result<Workspace, CliError> {
        let cache = if self.no_index { None } else { store::cache_folder() };
        let known = match cache.map(|cache| IndexFile::open(&cache, &self.folder)) {
            None => None,
            Some(Ok(known)) => Some(known),
            Some(Err(error)) => {
                let what = match error {
                    IndexError::InUse => "another Enfilade uses the index of this folder".to_owned(),
                    IndexError::Other(what) => format!("the index of this folder cannot be kept ({what})"),
                };
                terminal.detail(format!("{what}: all plans are read"))?;
                None
            }
        };
        let (index, files, broken) =
            known.map_or((None, Vec::new(), None), |known| (Some(known.index), known.files, known.broken));
        if let Some(what) = broken {
            terminal.remark(format!("the index of this folder could not be used and is made anew ({what})"))?;
        }
        let listed = with_progress("listing", None, terminal, |work| index::list(&self.folder, &files, recipe, work))?;
        drop(files);
        let mut workspace = listed.workspace;
        let predicts = !self.no_predictions;
        let mut paths = listed.to_read;
        if predicts {
            let new: std::collections::BTreeSet<_> = paths.iter().cloned().collect();
            paths.extend(index::to_predict(&workspace).into_iter().filter(|path| !new.contains(path)));
        }
        let mut gone = listed.gone;
        // What was found is kept now and then: whoever stops this goes on from there.
        const AT_ONCE: usize = 256;
        let all = paths.len();
        for (round, chunk) in paths.chunks(AT_ONCE).enumerate() {
            let title =
                if all > AT_ONCE { format!("reading {} of {all}", round * AT_ONCE) } else { "reading".to_owned() };
            let read = with_progress(&title, Some(chunk.len()), terminal, |work| {
                work.map(chunk.len(), |at| {
                    let known = workspace.find(&chunk[at]).map(|file| &*workspace.files()[file]);
                    index::read(&self.folder, &chunk[at], known, recipe, predicts)
                })
            })?;
            if let Some(index) = &index {
                let found: Vec<(String, Vec<u8>)> = read.iter().map(|file| index::to_keep(file, recipe)).collect();
                let _ = index.keep(&found, &std::mem::take(&mut gone));
            }
            workspace.put(read);
        }
        if let Some(index) = index.filter(|_| !gone.is_empty()) {
            let _ = index.keep(&[], &gone);
        }
        Ok(workspace)
    }

    fn json_plans(&self, workspace: &Workspace, rows: &[PlanRow], terminal: &mut Terminal) -> Result<(), CliError> {
        let plans: Vec<Value> = rows.iter().filter_map(|row| json_plan(workspace, *row)).collect();
        self.write(workspace, "plans", plans, terminal)
    }

    fn json_rooms(&self, workspace: &Workspace, rows: &[RoomRow], terminal: &mut Terminal) -> Result<(), CliError> {
        let rooms: Vec<Value> = rows.iter().filter_map(|row| json_room(workspace, *row)).collect();
        self.write(workspace, "rooms", rooms, terminal)
    }

    fn write(
        &self,
        workspace: &Workspace,
        name: &str,
        rows: Vec<Value>,
        terminal: &mut Terminal,
    ) -> Result<(), CliError> {
        let totals = workspace.totals();
        let report = json!({
            "version": 1,
            "folder": self.folder.display().to_string(),
            "totals": {
                "plans": totals.plans,
                "rooms": totals.rooms,
                "rooms_to_label": totals.to_label,
                "rooms_labelled": totals.labelled,
                "files_unreadable": totals.broken,
            },
            name: rows,
        });
        serde_json::to_writer_pretty(&mut terminal.out, &report)?;
        writeln!(terminal.out)?;
        Ok(())
    }

    fn print_buildings(&self, workspace: &Workspace, query: &Query, terminal: &mut Terminal) -> Result<(), CliError> {
        let wanted = query::plans(workspace, query, Order::by(PlanColumn::File), &crate::base::work::Work::quiet())?;
        let wanted: std::collections::BTreeSet<PlanRow> = wanted.into_iter().collect();
        let mut found = buildings(workspace);
        found.retain(|building| building.storeys.iter().any(|row| wanted.contains(row)));
        if let Some(name) = &self.building {
            found.retain(|building| building_name::key(&building.name) == building_name::key(name));
        }
        let mut json_buildings = Vec::new();
        for building in &found {
            let links = links(workspace, building);
            if self.json {
                json_buildings.push(json_building(workspace, building, &links));
            } else {
                print_building(workspace, building, &links, terminal)?;
            }
        }
        if self.json { self.write(workspace, "buildings", json_buildings, terminal) } else { Ok(()) }
    }
}

/// The links between each storey and the next; none where a file cannot be read any more.
fn links(workspace: &Workspace, building: &Building) -> Vec<Vec<VerticalLink>> {
    if building.storeys.len() < 2 {
        return Vec::new();
    }
    let plans: Vec<_> = building
        .storeys
        .iter()
        .map(|row| {
            let (file, _) = workspace.plan(*row)?;
            let import = formats::read_file(&workspace.path_of(file)).ok()?;
            import.plans.into_iter().nth(row.plan? as usize)
        })
        .collect();
    let between = |pair: &[Option<crate::plan::Plan>]| match pair {
        [Some(lower), Some(upper)] => vertical::vertical_links(lower, upper),
        _ => Vec::new(),
    };
    plans.windows(2).map(between).collect()
}

fn told(workspace: &Workspace, row: PlanRow) -> (String, String) {
    let Some((file, plan)) = workspace.plan(row) else { return Default::default() };
    (file.path.to_string(), plan.map(|plan| plan.storey.to_string()).unwrap_or_default())
}

fn room_title(workspace: &Workspace, row: PlanRow, id: crate::plan::RoomId) -> String {
    let room = workspace.plan(row).and_then(|(_, plan)| plan?.rooms.iter().find(|room| room.id == id));
    let name = room.map(|room| room.name.to_string()).unwrap_or_default();
    if name.is_empty() { id.to_string() } else { name }
}

fn print_building(
    workspace: &Workspace,
    building: &Building,
    links: &[Vec<VerticalLink>],
    terminal: &mut Terminal,
) -> Result<(), CliError> {
    let typology = building.typology.as_ref().map_or("no typology", Typology::as_str);
    let storeys = count(building.storeys.len(), "storey");
    writeln!(terminal.out, "{}: {typology}, {storeys}", one_line(&building.name))?;
    for (at, row) in building.storeys.iter().enumerate() {
        let (file, storey) = told(workspace, *row);
        let storey = if storey.is_empty() { "–".to_owned() } else { storey };
        writeln!(terminal.out, "  {:<16} {}", one_line(&shortened(&storey, 16)), one_line(&file))?;
        let Some(next) = building.storeys.get(at + 1) else { continue };
        for link in links.get(at).into_iter().flatten() {
            let (lower, upper) = (room_title(workspace, *row, link.lower), room_title(workspace, *next, link.upper));
            let shaft = link.shaft.name();
            writeln!(
                terminal.out,
                "    ↕ {shaft} {} – {} ({:.0} % over each other)",
                one_line(&lower),
                one_line(&upper),
                100.0 * link.overlap
            )?;
        }
    }
    Ok(())
}

fn json_building(workspace: &Workspace, building: &Building, links: &[Vec<VerticalLink>]) -> Value {
    let storeys: Vec<Value> = building
        .storeys
        .iter()
        .map(|row| {
            let (file, storey) = told(workspace, *row);
            json!({ "file": file, "plan_in_file": row.plan.unwrap_or(0) + 1, "storey": storey })
        })
        .collect();
    let edges: Vec<Value> = links
        .iter()
        .enumerate()
        .flat_map(|(at, links)| {
            links.iter().map(move |link| {
                json!({
                    "kind": link.shaft.name(),
                    "lower_storey": at,
                    "lower_room": link.lower.to_string(),
                    "upper_room": link.upper.to_string(),
                    "overlap": (link.overlap * 1e4).round() / 1e4,
                })
            })
        })
        .collect();
    json!({
        "building": building.name,
        "typology": building.typology.as_ref().map(Typology::as_str),
        "storeys": storeys,
        "vertical_links": edges,
    })
}

fn status_word(status: RoomStatus) -> Option<&'static str> {
    match status {
        RoomStatus::Labelled(label) => Some(label.letter()),
        RoomStatus::NotClassified => Some("not classified"),
        RoomStatus::Unlabelled => None,
    }
}

fn json_plan(workspace: &Workspace, row: PlanRow) -> Option<Value> {
    let (file, plan) = workspace.plan(row)?;
    let Some(plan) = plan else {
        let error = if let Content::Broken(what) = &file.content { what.as_str() } else { "not read" };
        return Some(json!({ "file": &*file.path, "error": error }));
    };
    let (same, both) = plan.agreement();
    Some(json!({
        "file": &*file.path,
        "plan_in_file": row.plan.unwrap_or(0) + 1,
        "name": &*plan.name,
        "typology": plan.typology.as_ref().map(Typology::as_str),
        "building": &*plan.building,
        "storey": &*plan.storey,
        "rooms": plan.rooms.len(),
        "openings": plan.openings,
        "rooms_to_label": plan.to_label,
        "rooms_labelled": plan.labelled,
        "errors": plan.problems.errors,
        "warnings": plan.problems.warnings,
        "infos": plan.problems.infos,
        "rooms_compared": if plan.is_predicted { Some(both) } else { None },
        "rooms_as_predicted": if plan.is_predicted { Some(same) } else { None },
        "changed_ns": file.state.modified_ns,
    }))
}

fn json_room(workspace: &Workspace, row: RoomRow) -> Option<Value> {
    let (file, plan, room) = workspace.room(row)?;
    let rounded = |value: f32| (f64::from(value) * 1e4).round() / 1e4;
    Some(json!({
        "file": &*file.path,
        "plan_in_file": row.plan + 1,
        "id": room.id.to_string(),
        "name": &*room.name,
        "function": &*room.function,
        "label": status_word(room.status),
        "label_origin": room.origin.map(crate::plan::LabelOrigin::name),
        "area_m2": rounded(room.area_m2),
        "predicted": room.prediction.map(|(label, _)| label.letter()),
        "predicted_probability": room.prediction.map(|(_, probability)| rounded(probability)),
        "plan": file.title_of(plan),
        "building": &*plan.building,
        "typology": plan.typology.as_ref().map(Typology::as_str),
    }))
}

/// A share in whole per cent; a dash where there is nothing to count.
fn percent(part: usize, whole: usize) -> String {
    if whole == 0 { "–".to_owned() } else { format!("{:.0} %", 100.0 * part as f64 / whole as f64) }
}

/// Lines of cells, each column as wide as its widest cell; figures stand at the right.
fn print_table(head: &[(&str, bool)], lines: &[Vec<String>], terminal: &mut Terminal) -> Result<(), CliError> {
    let wide = |column: usize| {
        let cells = lines.iter().filter_map(|line| line.get(column)).map(|cell| cell.chars().count());
        cells.max().unwrap_or(0).max(head.get(column).map_or(0, |(title, _)| title.chars().count()))
    };
    let widths: Vec<usize> = (0..head.len()).map(wide).collect();
    let line = |cells: Vec<&str>| {
        let padded: Vec<String> = cells
            .iter()
            .zip(&widths)
            .zip(head)
            .map(|((cell, wide), (_, is_figure))| {
                let blanks = " ".repeat(wide.saturating_sub(cell.chars().count()));
                if *is_figure { format!("{blanks}{cell}") } else { format!("{cell}{blanks}") }
            })
            .collect();
        padded.join("  ").trim_end().to_owned()
    };
    writeln!(terminal.out, "{}", line(head.iter().map(|(title, _)| *title).collect()))?;
    for cells in lines {
        writeln!(terminal.out, "{}", line(cells.iter().map(String::as_str).collect()))?;
    }
    Ok(())
}

/// So wide is a cell with a text of a plan.
const WIDE: usize = 32;

fn cell(text: &str) -> String {
    let text = one_line(text);
    if text.is_empty() { "–".to_owned() } else { shortened(&text, WIDE) }
}

fn typology_of(plan: &PlanEntry) -> String {
    plan.typology.as_ref().map_or_else(|| "–".to_owned(), |typology| cell(typology.as_str()))
}

fn print_plans(workspace: &Workspace, rows: &[PlanRow], terminal: &mut Terminal) -> Result<(), CliError> {
    let line = |row: &PlanRow| {
        let (file, plan) = workspace.plan(*row)?;
        let name = one_line(&file.path);
        let Some(plan) = plan else {
            return Some(vec![name, Paint::Error.on("cannot be read")]);
        };
        let (same, both) = plan.agreement();
        let agreement = if plan.is_predicted { percent(same, both) } else { "–".to_owned() };
        let numbered = if file.plans().len() > 1 { format!("{name} [{}]", row.plan.unwrap_or(0) + 1) } else { name };
        Some(vec![
            numbered,
            typology_of(plan),
            cell(&plan.building),
            cell(&plan.storey),
            plan.rooms.len().to_string(),
            percent(plan.labelled, plan.to_label),
            plan.problems.errors.to_string(),
            plan.problems.warnings.to_string(),
            agreement,
        ])
    };
    let lines: Vec<Vec<String>> = rows.iter().filter_map(line).collect();
    let head = [
        ("file", false),
        ("typology", false),
        ("building", false),
        ("storey", false),
        ("rooms", true),
        ("labelled", true),
        ("errors", true),
        ("warnings", true),
        ("agreement", true),
    ];
    print_table(&head, &lines, terminal)?;
    let found: Vec<&PlanEntry> =
        rows.iter().filter_map(|row| workspace.plan(*row).and_then(|(_, plan)| plan)).collect();
    let rooms: usize = found.iter().map(|plan| plan.rooms.len()).sum();
    writeln!(terminal.out, "\n{}, {}", count(found.len(), "plan"), count(rooms, "room"))?;
    Ok(())
}

fn print_rooms(workspace: &Workspace, rows: &[RoomRow], terminal: &mut Terminal) -> Result<(), CliError> {
    let line = |row: &RoomRow| {
        let (file, _, room): (&PlanFile, _, _) = workspace.room(*row)?;
        let (predicted, probability) = room.prediction.map_or(("–", "–".to_owned()), |(label, probability)| {
            (label.name(), format!("{:.0} %", 100.0 * probability))
        });
        Some(vec![
            one_line(&file.path),
            room.id.to_string(),
            cell(&room.name),
            cell(&room.function),
            room.label().map_or_else(|| status_word(room.status).unwrap_or("–"), |label| label.name()).to_owned(),
            format!("{:.1}", room.area_m2),
            predicted.to_owned(),
            probability,
        ])
    };
    let lines: Vec<Vec<String>> = rows.iter().filter_map(line).collect();
    let head = [
        ("file", false),
        ("id", false),
        ("room", false),
        ("function", false),
        ("label", false),
        ("m²", true),
        ("predicted", false),
        ("sure", true),
    ];
    print_table(&head, &lines, terminal)?;
    writeln!(terminal.out, "\n{}", count(rows.len(), "room"))?;
    Ok(())
}
