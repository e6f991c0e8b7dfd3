//! Which plans and rooms of a workspace are shown, and in which order.

use std::cmp::Ordering;

use super::{Content, PlanEntry, PlanFile, PlanRow, RoomEntry, RoomRow, Workspace};
use crate::base::natural_order::NaturalKey;
use crate::base::work::{Cancelled, Work};
use crate::features::RoomStatus;
use crate::labels::{Label, Typology};
use crate::plan::storeys::level_key;

/// What is wanted. Without anything, all.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Query {
    /// Words that have to stand in a room's name, function or label, or in what its plan is called. A word behind
    /// `name:`, `function:`, `label:`, `plan:`, `building:` or `typology:` has to stand there.
    pub text: String,
    /// Of this typology; the inner `None` for plans that state none.
    pub typology: Option<Option<Typology>>,
    /// Of the building of this name, in any spelling ([`crate::formats::building_name::key`]).
    pub building: Option<String>,
    /// Plans with errors or warnings, or that cannot be read.
    pub has_problems: bool,
    /// Plans with rooms that want a label; rooms that do.
    pub is_unlabelled: bool,
    /// Plans with rooms whose label is not the predicted one; such rooms.
    pub disagrees: bool,
}

/// Declares the columns of a table: each with a word for scripts and the command line, and a title.
macro_rules! columns {
    ($(#[$doc:meta])* $name:ident: $($(#[$column_doc:meta])* $column:ident $word:literal $title:literal $help:literal;)*) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
        pub enum $name {
            $($(#[$column_doc])* $column,)*
        }

        impl $name {
            pub const ALL: &'static [Self] = &[$(Self::$column,)*];

            /// Its word on the command line and in scripts.
            pub const fn word(self) -> &'static str {
                match self { $(Self::$column => $word,)* }
            }

            /// Its heading.
            pub const fn title(self) -> &'static str {
                match self { $(Self::$column => $title,)* }
            }

            /// What stands in it.
            pub const fn help(self) -> &'static str {
                match self { $(Self::$column => $help,)* }
            }

            /// The column of a word.
            pub fn of_word(word: &str) -> Option<Self> {
                Self::ALL.iter().copied().find(|column| column.word() == word)
            }
        }
    };
}

columns! {
    /// A column of the table of plans.
    PlanColumn:
    Name "name" "Plan" "The plan's name, or its file's";
    File "file" "File" "The file, below the folder";
    Typology "typology" "Typology" "What the building is for, as the plan says";
    Building "building" "Building" "The building that the plan names";
    Storey "storey" "Storey" "The storey of the building, from the lowest up";
    Rooms "rooms" "Rooms" "Number of rooms";
    Labelled "labelled" "Labelled" "Share of the rooms to be labelled that have a label";
    Problems "problems" "Problems" "Errors and warnings of the check";
    Agreement "agreement" "Agreement" "Share of the labelled rooms for which the same label is predicted";
    Changed "changed" "Changed" "When the file was last changed";
}

columns! {
    /// A column of the table of rooms.
    RoomColumn:
    Name "name" "Room" "What is written in the room";
    Function "function" "Function" "What the room is for";
    Label "label" "Label" "The room's label, its own or by its function";
    Area "area" "Area" "Its area";
    Prediction "prediction" "Predicted" "The label that is predicted for it";
    Probability "probability" "Sure" "How probable the predicted label is";
    Plan "plan" "Plan" "The plan it is in";
    Building "building" "Building" "The building that the plan names";
    Typology "typology" "Typology" "What the building is for, as the plan says";
}

/// By which column rows are sorted. Rows that are equal in it stand by plan and room in natural order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Order<C> {
    pub by: C,
    pub is_descending: bool,
}

impl<C> Order<C> {
    /// Ascending by a column.
    pub const fn by(by: C) -> Self {
        Self { by, is_descending: false }
    }

    const fn apply(&self, order: Ordering) -> Ordering {
        if self.is_descending { order.reverse() } else { order }
    }
}

/// Where a word of a query has to stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum In {
    Anything,
    Name,
    Function,
    Label,
    Plan,
    Building,
    Typology,
}

/// A query, ready to be asked of many rooms.
struct Wanted<'a> {
    query: &'a Query,
    words: Vec<(In, String)>,
    building: Option<String>,
}

impl<'a> Wanted<'a> {
    fn new(query: &'a Query) -> Self {
        const PLACES: [(&str, In); 6] = [
            ("name:", In::Name),
            ("function:", In::Function),
            ("label:", In::Label),
            ("plan:", In::Plan),
            ("building:", In::Building),
            ("typology:", In::Typology),
        ];
        let place = |word: &str| {
            let word = word.to_lowercase();
            let found = PLACES.iter().find_map(|(before, place)| Some((*place, word.strip_prefix(before)?.to_owned())));
            found.unwrap_or((In::Anything, word))
        };
        let words = query.text.split_whitespace().map(place).collect();
        Self { query, words, building: query.building.as_deref().map(crate::formats::building_name::key) }
    }

    /// Whether a plan is of the typology and the building.
    fn takes(&self, plan: &PlanEntry) -> bool {
        self.query.typology.as_ref().is_none_or(|typology| *typology == plan.typology)
            && self
                .building
                .as_ref()
                .is_none_or(|key| *key == crate::formats::building_name::key(plan.building_or_name()))
    }

    /// The words that do not stand in what a plan is called.
    fn left_of(&self, file: &PlanFile, plan: Option<&PlanEntry>) -> Vec<&(In, String)> {
        let stands = |(place, word): &(In, String)| {
            let typology = plan.and_then(|plan| plan.typology.as_ref()).map_or("", Typology::as_str);
            let (name, building, storey) =
                plan.map_or(("", "", ""), |plan| (&*plan.name, &*plan.building, &*plan.storey));
            match place {
                In::Anything => [name, building, storey, typology, &*file.path].iter().any(|it| has(it, word)),
                In::Plan => has(name, word) || has(&file.path, word),
                In::Building => has(building, word),
                In::Typology => has(typology, word),
                In::Name | In::Function | In::Label => false,
            }
        };
        self.words.iter().filter(|word| !stands(word)).collect()
    }
}

fn stands_in_room(room: &RoomEntry, (place, word): &(In, String)) -> bool {
    let label = room.label().map_or("", Label::name);
    match place {
        In::Anything => has(&room.name, word) || has(&room.function, word) || has(label, word),
        In::Name => has(&room.name, word),
        In::Function => has(&room.function, word),
        In::Label => has(label, word) || room.label().is_some_and(|it| it.letter().eq_ignore_ascii_case(word)),
        In::Plan | In::Building | In::Typology => false,
    }
}

/// Whether a text holds a word in lower case, in any case.
fn has(text: &str, word: &str) -> bool {
    if !text.is_ascii() {
        return text.to_lowercase().contains(word);
    }
    let (text, word) = (text.as_bytes(), word.as_bytes());
    let Some(&first) = word.first() else { return true };
    if text.len() < word.len() {
        return false;
    }
    (0..=text.len() - word.len())
        .any(|at| text[at].to_ascii_lowercase() == first && text[at..at + word.len()].eq_ignore_ascii_case(word))
}

fn is_unlabelled(room: &RoomEntry) -> bool {
    room.status == RoomStatus::Unlabelled && room.area_m2 > 0.0
}

/// So many rows are looked at before it is asked whether to go on.
const AT_ONCE: usize = 4096;

/// The plans that a query wants, in an order; files that are not read yet or cannot be are among them where nothing is
/// asked that only a plan can answer.
///
/// # Errors
/// When cancelled.
pub fn plans(
    workspace: &Workspace,
    query: &Query,
    order: Order<PlanColumn>,
    work: &Work<'_>,
) -> Result<Vec<PlanRow>, Cancelled> {
    let wanted = Wanted::new(query);
    let mut rows = Vec::new();
    for (at, row) in workspace.plan_rows().enumerate() {
        if at % AT_ONCE == 0 {
            work.goes_on()?;
        }
        let Some((file, plan)) = workspace.plan(row) else { continue };
        let is_wanted = match plan {
            None => {
                let is_asked_of_plans = query.typology.is_some()
                    || query.building.is_some()
                    || query.is_unlabelled
                    || query.disagrees
                    || (query.has_problems && file.content == Content::Pending);
                !is_asked_of_plans && wanted.left_of(file, None).is_empty()
            }
            Some(plan) => {
                wanted.takes(plan)
                    && (!query.has_problems || plan.problems.total() > 0)
                    && (!query.is_unlabelled || plan.labelled < plan.to_label)
                    && (!query.disagrees || plan.rooms.iter().any(|room| room.agrees() == Some(false)))
                    && {
                        let left = wanted.left_of(file, Some(plan));
                        left.is_empty()
                            || plan.rooms.iter().any(|room| left.iter().all(|word| stands_in_room(room, word)))
                    }
            }
        };
        if is_wanted {
            rows.push(row);
        }
    }
    work.goes_on()?;
    sort_plans(workspace, &mut rows, order);
    Ok(rows)
}

/// The rooms that a query wants, in an order.
///
/// # Errors
/// When cancelled.
pub fn rooms(
    workspace: &Workspace,
    query: &Query,
    order: Order<RoomColumn>,
    work: &Work<'_>,
) -> Result<Vec<RoomRow>, Cancelled> {
    let wanted = Wanted::new(query);
    let mut rows = Vec::new();
    for (at, file) in workspace.files().iter().enumerate() {
        if at % 256 == 0 {
            work.goes_on()?;
        }
        for (index, plan) in file.plans().iter().enumerate() {
            if !wanted.takes(plan) || (query.has_problems && plan.problems.total() == 0) {
                continue;
            }
            let left = wanted.left_of(file, Some(plan));
            for (room, entry) in plan.rooms.iter().enumerate() {
                if (!query.is_unlabelled || is_unlabelled(entry))
                    && (!query.disagrees || entry.agrees() == Some(false))
                    && left.iter().all(|word| stands_in_room(entry, word))
                {
                    rows.push(RoomRow { file: at as u32, plan: index as u32, room: room as u32 });
                }
            }
        }
    }
    work.goes_on()?;
    sort_rooms(workspace, &mut rows, order);
    Ok(rows)
}

/// Sorts by a key that is made once a row; the numbers of rows decide between equal ones.
fn sort_by_key<R: Copy, C: Copy, K: Ord>(rows: &mut [R], order: Order<C>, key: impl Fn(R) -> K) {
    let mut keyed: Vec<(K, usize)> = rows.iter().enumerate().map(|(at, row)| (key(*row), at)).collect();
    keyed.sort_unstable_by(|p, q| order.apply(p.0.cmp(&q.0)).then(p.1.cmp(&q.1)));
    let before = rows.to_vec();
    for (row, (_, at)) in rows.iter_mut().zip(keyed) {
        *row = before[at];
    }
}

/// A number as a key: what is missing comes first.
fn number(value: Option<f64>) -> i64 {
    // Shares and areas differ by more than a millionth where anybody sees it.
    value.map_or(i64::MIN, |value| (value * 1e6) as i64)
}

fn sort_plans(workspace: &Workspace, rows: &mut [PlanRow], order: Order<PlanColumn>) {
    let text = |rows: &mut [PlanRow], order, of: &dyn Fn(&PlanFile, Option<&PlanEntry>) -> String| {
        sort_by_key(rows, order, |row| workspace.plan(row).map(|(file, plan)| NaturalKey::of(&of(file, plan))));
    };
    let figure = |rows: &mut [PlanRow], of: &dyn Fn(&PlanFile, &PlanEntry) -> i64| {
        sort_by_key(rows, order, |row| match workspace.plan(row) {
            Some((file, Some(plan))) => of(file, plan),
            _ => i64::MIN,
        });
    };
    // Ties by file.
    if order.by != PlanColumn::File {
        text(rows, Order::by(PlanColumn::File), &|file, _| file.path.to_string());
    }
    match order.by {
        PlanColumn::Name => {
            text(rows, order, &|file, plan| plan.map_or(file.name(), |plan| file.title_of(plan)).to_owned());
        }
        PlanColumn::File => text(rows, order, &|file, _| file.path.to_string()),
        PlanColumn::Typology => text(rows, order, &|_, plan| {
            plan.and_then(|plan| plan.typology.as_ref()).map(ToString::to_string).unwrap_or_default()
        }),
        PlanColumn::Building => {
            // Storeys of a building stand in their order.
            figure(rows, &|_, plan| level_key(&plan.storey));
            text(rows, order, &|_, plan| plan.map(|plan| plan.building.to_string()).unwrap_or_default());
        }
        PlanColumn::Storey => figure(rows, &|_, plan| level_key(&plan.storey)),
        PlanColumn::Rooms => figure(rows, &|_, plan| plan.rooms.len() as i64),
        PlanColumn::Labelled => figure(rows, &|_, plan| number(plan.share_labelled())),
        PlanColumn::Problems => sort_by_key(rows, order, |row| match workspace.plan(row) {
            Some((PlanFile { content: Content::Broken(_), .. }, _)) => (u32::MAX, 0, 0),
            Some((_, Some(plan))) => (plan.problems.errors, plan.problems.warnings, plan.problems.infos),
            _ => (0, 0, 0),
        }),
        PlanColumn::Agreement => figure(rows, &|_, plan| {
            let (same, all) = plan.agreement();
            number((all > 0).then(|| same as f64 / all as f64))
        }),
        PlanColumn::Changed => {
            sort_by_key(rows, order, |row| workspace.plan(row).map_or(0, |(file, _)| file.state.modified_ns));
        }
    }
}

fn sort_rooms(workspace: &Workspace, rows: &mut [RoomRow], order: Order<RoomColumn>) {
    let text = |rows: &mut [RoomRow], of: &dyn Fn(&PlanFile, &PlanEntry, &RoomEntry) -> String| {
        sort_by_key(rows, order, |row| {
            workspace.room(row).map(|(file, plan, room)| NaturalKey::of(&of(file, plan, room)))
        });
    };
    let figure = |rows: &mut [RoomRow], of: &dyn Fn(&RoomEntry) -> i64| {
        sort_by_key(rows, order, |row| workspace.room(row).map(|(_, _, room)| of(room)));
    };
    match order.by {
        RoomColumn::Name => text(rows, &|_, _, room| room.name.to_string()),
        RoomColumn::Function => text(rows, &|_, _, room| room.function.to_string()),
        RoomColumn::Label => figure(rows, &|room| match room.status {
            RoomStatus::Labelled(label) => label.index() as i64,
            RoomStatus::NotClassified => -2,
            RoomStatus::Unlabelled => -1,
        }),
        RoomColumn::Area => figure(rows, &|room| number(Some(f64::from(room.area_m2)))),
        RoomColumn::Prediction => figure(rows, &|room| room.prediction.map_or(-1, |(label, _)| label.index() as i64)),
        RoomColumn::Probability => {
            figure(rows, &|room| number(room.prediction.map(|(_, probability)| f64::from(probability))));
        }
        RoomColumn::Plan => text(rows, &|file, plan, _| file.title_of(plan).to_owned()),
        RoomColumn::Building => text(rows, &|_, plan, _| plan.building.to_string()),
        RoomColumn::Typology => {
            text(rows, &|_, plan, _| plan.typology.as_ref().map(ToString::to_string).unwrap_or_default())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::has;

    #[test]
    fn words_are_found_in_any_case() {
        assert!(has("Meeting Room", "room") && has("Büro", "bü") && has("ÜBUNG", "üb") && has("x", ""));
        assert!(!has("room", "rooms") && !has("", "a"));
    }
}
