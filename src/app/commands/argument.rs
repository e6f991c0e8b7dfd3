//! Command arguments: files, rooms, functions, numbers. Each kind parses its text and, where possible,
//! offers choices.
//!
//! One file, though a long one: how a kind is read, taken, written and offered stands side by side, so that a new kind
//! forgets none of them.

use crate::classify::Method;
use crate::predict::ModelSet;
use std::path::PathBuf;

use crate::app::look::keys::NoKeys;
use crate::app::session::questions::Question;
use crate::app::session::words::Choice;
use crate::app::session::{
    open_plans::OpenPlan,
    origin::{Origin, bundled, file_name},
    paths::PathUse,
    settings::Keyed,
};
use crate::app::state::{App, SidePanel};
use crate::app::value::{
    UNKNOWN, Value, element, elements_word, is_own_word, point_in, points_word, room, room_word, sample_word,
    switch_word,
};
use crate::base::{
    units::{NotUnderstood, Units, parse_angle_deg, parse_number, parse_percent, parse_ratio},
    wording::{or_list, sentence, similar},
};
use crate::features::RoomStatus;
use crate::formats;
use crate::geometry::{COORDINATE_LIMIT_M, Point, trim_m};
use crate::labels::Typology;
use crate::plan::{ElementId, Joint, Opening, OpeningId, Plan, RoomId, titles::room_title};

/// An argument of a command.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Argument {
    /// In capitals, as in a command's usage: 'ROOM'.
    pub name: &'static str,
    pub kind: ArgumentKind,
    /// Whether it may be omitted.
    pub is_optional: bool,
    /// A phrase for the manual, and the hint in its text field.
    pub help: &'static str,
}

impl Argument {
    /// What it is, with the unit of numbers that are typed without one.
    pub(crate) fn asked(&self, units: Units) -> String {
        let unit = match units {
            Units::Metric => "metres",
            Units::Imperial => "feet",
        };
        match self.kind {
            ArgumentKind::Length { .. } | ArgumentKind::Coordinate { .. } | ArgumentKind::Points { .. } => {
                // What is written in scripts is in metres whatever is set; what is typed here is not.
                let help = self.help.replace(", in metres", "").replace(" in metres", "");
                format!("{help}, in {unit} or with a unit")
            }
            _ => self.help.to_owned(),
        }
    }
}

/// What an argument can be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ArgumentKind {
    /// A file with a plan, or a folder of them.
    PlanFile,
    /// A file to write a plan to.
    NewPlanFile,
    /// A file to write something else to.
    NewFile,
    /// A file with a picture.
    PictureFile,
    /// A file with a robot's laser log.
    LogFile,
    /// A file that was opened or saved before.
    RecentFile,
    /// An open plan: its title.
    OpenPlan,
    /// Any text, empty included.
    Text,
    /// A length, typed in the units that are set or with its own; see [`crate::base::units`].
    Length { least_m: f64, most_m: f64 },
    /// A place on an axis, or a way along one: in scripts in metres whatever is set, as points are.
    Coordinate { least_m: f64, most_m: f64 },
    /// An angle in degrees, or with its unit.
    Angle { least_deg: f64, most_deg: f64 },
    /// A factor: a number, or one with a percent sign.
    Ratio { least: f64, most: f64 },
    /// A number of percent.
    Percent,
    /// A number of something that is neither a length nor an angle nor a share.
    Number { unit: &'static str, least: f64, most: f64 },
    /// A whole number from 0 on.
    Whole { most: usize },
    /// 1, 2, 3, …
    Count,
    /// A room of the open plan: its name, if unique, or its id.
    Room,
    /// An opening of the open plan: its id.
    Opening,
    /// Elements of the open plan: their ids separated by spaces; for a room, also its name if that is one
    /// word.
    Elements,
    /// Points of the plan: `X,Y` in metres, separated by spaces.
    Points { least: usize },
    /// What a room is for: a function of the plan's label scheme, or any other text.
    Function,
    /// A typology that has a label scheme, or 'unknown'.
    Typology,
    /// Which models predict, see [`ModelSet`].
    ModelSet,
    /// A way to classify: its word.
    Method,
    /// A bundled plan: its file's name without the extension.
    Sample,
    /// 'on' or 'off'.
    Switch,
    /// A button of the current question.
    Answer,
    /// A menu command: its id.
    Command,
    /// A side panel without a command of its own: its id.
    SidePanel,
    /// Keys pressed together: 'Ctrl+Shift+K'.
    Keys,
    /// One of several words, each with its title.
    Word(&'static [(&'static str, &'static str)]),
}

/// The most suggestions in an error message.
const MOST_SIMILAR: usize = 3;

impl ArgumentKind {
    /// What is expected, for an error message: 'a length from 0 m to 10 m'.
    pub fn expected(self) -> String {
        self.expected_in(Units::Metric)
    }

    /// The same with lengths in some units.
    pub(crate) fn expected_in(self, units: Units) -> String {
        match self {
            Self::PlanFile => "a file with a plan, or a folder".to_owned(),
            Self::NewPlanFile => "a file to write the plan to".to_owned(),
            Self::NewFile => "a file to write".to_owned(),
            Self::PictureFile => "a file with a picture".to_owned(),
            Self::LogFile => "a file with a laser log".to_owned(),
            Self::RecentFile => "a recent file".to_owned(),
            Self::OpenPlan => "an open plan".to_owned(),
            Self::Text => "a text".to_owned(),
            Self::Number { unit, least, most } => format!("a number{unit} from {least} to {most}"),
            // Beyond the drawing area nothing is limited any more.
            Self::Length { least_m, most_m } if most_m >= COORDINATE_LIMIT_M => match least_m > 0.0 {
                true => format!("a length of at least {}", units.exact_length(least_m)),
                false => "a length".to_owned(),
            },
            Self::Length { least_m, most_m } => {
                format!("a length from {} to {}", units.exact_length(least_m), units.exact_length(most_m))
            }
            Self::Coordinate { least_m, most_m } => format!("a number of metres from {least_m} to {most_m}"),
            Self::Angle { least_deg, most_deg } => format!("an angle from {least_deg}° to {most_deg}°"),
            Self::Ratio { least, most } => format!("a number from {least} to {most}"),
            Self::Percent => "a number of percent from 0 to 100".to_owned(),
            Self::Whole { most } => format!("a whole number from 0 to {most}"),
            Self::Count => "1, 2, 3, …".to_owned(),
            Self::Room => "the name of a room of this plan, or its id".to_owned(),
            Self::Opening => "the id of an opening of this plan".to_owned(),
            Self::Elements => "ids of elements of this plan, separated by blanks".to_owned(),
            Self::Points { least: 1 } => "points of the plan in metres, such as '0,0 4.2,0'".to_owned(),
            Self::Points { least } => format!("at least {least} points of the plan in metres, such as '0,0 4.2,0'"),
            Self::Function => "what a room is for".to_owned(),
            Self::Typology => "a typology, or 'unknown'".to_owned(),
            Self::ModelSet => "'plan', 'auto', or available models".to_owned(),
            Self::Method => "an algorithm".to_owned(),
            Self::Sample => "one of the sample plans".to_owned(),
            Self::Switch => "'on' or 'off'".to_owned(),
            Self::Answer => "a button of the question".to_owned(),
            Self::Command => "the id of a command in a menu".to_owned(),
            Self::SidePanel => "a panel without a command of its own".to_owned(),
            Self::Keys => NoKeys.to_string(),
            Self::Word(words) => {
                let words: Vec<&str> = words.iter().map(|(word, _)| *word).collect();
                or_list(&words)
            }
        }
    }

    /// What its path is for, if it is one that is typed.
    pub(crate) const fn path_use(self) -> Option<PathUse> {
        match self {
            Self::PlanFile => Some(PathUse::Plan),
            Self::PictureFile => Some(PathUse::Picture),
            Self::LogFile => Some(PathUse::Log),
            Self::NewPlanFile | Self::NewFile => Some(PathUse::New),
            _ => None,
        }
    }

    /// Whether it can be something other than its choices.
    pub(crate) const fn is_open(self) -> bool {
        matches!(self, Self::Function)
    }

    /// The current choice, for settings whose choices menus show directly.
    pub(in crate::app) fn current(self, app: &App) -> Option<&str> {
        match self {
            Self::ModelSet => Some(app.session.predictor.set.name()),
            Self::Method => Some(app.session.predictor.method.name()),
            _ => None,
        }
    }

    /// Reads an argument as a person types it where it is asked for: numbers of points and coordinates, too, are in
    /// the units that are set. Gives it as it is written in a call.
    ///
    /// # Errors
    /// What is expected instead.
    pub(crate) fn read_typed(self, app: &App, text: &str) -> Result<String, String> {
        let value = match self {
            Self::Points { least } => self.points(app, text, app.units(), least),
            Self::Coordinate { .. } => self.number(app, app.units().parse_length(text)),
            // As it was typed: what is shown of it is then not another's spelling.
            _ => return self.read(app, text).map(|_| text.to_owned()),
        };
        value.map(|value| self.write(app, &value))
    }

    /// A number that was read, where it is within its limits.
    fn number(self, app: &App, read: Result<f64, NotUnderstood>) -> Result<Value, String> {
        let number = read.map_err(|error| error.to_string())?;
        self.take(app, Value::Number(number))
    }

    fn points(self, app: &App, text: &str, units: Units, least: usize) -> Result<Value, String> {
        let found: Option<Vec<Point>> = text.split_whitespace().map(|word| point_in(word, units)).collect();
        found.filter(|found| found.len() >= least).map(Value::Points).ok_or_else(|| self.wrong(app))
    }

    /// Why something else is not taken.
    fn wrong(self, app: &App) -> String {
        format!("expected {}", self.expected_in(app.units()))
    }

    /// Reads an argument.
    ///
    /// # Errors
    /// What is not understood, or what is expected instead, as a clause: 'expected 1, 2, 3, …'.
    pub(crate) fn read(self, app: &App, text: &str) -> Result<Value, String> {
        let with_choices = |wrong: String| {
            let choices = self.choices(app).unwrap_or_default();
            let similar = similar(text, choices.iter().map(|choice| choice.word.as_str()), MOST_SIMILAR);
            match (similar.is_empty(), choices.len()) {
                (false, _) => format!("{wrong}; did you mean {}?", or_list(&similar)),
                (true, 1..=8) => {
                    let words: Vec<&str> = choices.iter().map(|choice| choice.word.as_str()).collect();
                    format!("{wrong}: {}", or_list(&words))
                }
                (true, _) => wrong,
            }
        };
        match self {
            Self::PlanFile
            | Self::NewPlanFile
            | Self::NewFile
            | Self::PictureFile
            | Self::LogFile
            | Self::RecentFile
                if text.is_empty() =>
            {
                Err(self.wrong(app))
            }
            Self::OpenPlan => {
                let plans = app.session.open_plans();
                let found = plans.iter().find(|plan| plan.title == text.trim());
                found.map(|plan| Value::OpenPlan(plan.number)).ok_or_else(|| with_choices(self.wrong(app)))
            }
            Self::PlanFile
            | Self::NewPlanFile
            | Self::NewFile
            | Self::PictureFile
            | Self::LogFile
            | Self::RecentFile => Ok(Value::Path(PathBuf::from(text))),
            Self::Text | Self::Function => Ok(Value::Text(text.trim().to_owned())),
            Self::Length { .. } => self.number(app, app.units().parse_length(text)),
            Self::Coordinate { .. } => {
                let number = Units::Metric.parse_length(text).map_err(|_| self.wrong(app))?;
                self.take(app, Value::Number(number))
            }
            Self::Angle { .. } => self.number(app, parse_angle_deg(text)),
            Self::Ratio { .. } => self.number(app, parse_ratio(text)),
            Self::Percent => self.number(app, parse_percent(text)),
            Self::Number { .. } => self.number(app, parse_number(text)),
            Self::Whole { most } => {
                let number = text.trim().parse::<usize>().ok().filter(|number| *number <= most);
                number.map(Value::Count).ok_or_else(|| self.wrong(app))
            }
            Self::Count => {
                let count = text.trim().parse::<usize>().ok().filter(|count| *count > 0);
                count.map(Value::Count).ok_or_else(|| self.wrong(app))
            }
            Self::Room => {
                let plan = app.plan().ok_or_else(|| self.wrong(app))?;
                room(plan, text.trim())
                    .map(Value::Room)
                    .map_err(|several| several.unwrap_or_else(|| with_choices(self.wrong(app))))
            }
            Self::Opening => {
                let id = text.trim().parse::<OpeningId>().ok();
                let id = id.filter(|&id| app.plan().is_some_and(|plan| plan.opening(id).is_some()));
                id.map(Value::Opening).ok_or_else(|| self.wrong(app))
            }
            Self::Elements => {
                let plan = app.plan().ok_or_else(|| self.wrong(app))?;
                let found: Option<Vec<ElementId>> = text.split_whitespace().map(|word| element(plan, word)).collect();
                found.filter(|found| !found.is_empty()).map(Value::Elements).ok_or_else(|| self.wrong(app))
            }
            Self::Points { least } => self.points(app, text, Units::Metric, least),
            Self::Typology if text.trim().eq_ignore_ascii_case(UNKNOWN) => Ok(Value::Typology(None)),
            Self::Typology => {
                let wanted = text.trim();
                let found =
                    app.session.schemes.typologies().find(|typology| typology.as_str().eq_ignore_ascii_case(wanted));
                found.cloned().map(|found| Value::Typology(Some(found))).ok_or_else(|| with_choices(self.wrong(app)))
            }
            Self::ModelSet => {
                let set = ModelSet::read(text, &app.session.models).ok();
                set.map(Value::ModelSet).ok_or_else(|| with_choices(self.wrong(app)))
            }
            Self::Method => text.parse().map(Value::Method).map_err(|_| with_choices(self.wrong(app))),
            Self::Sample => {
                let wanted = text.trim();
                let index = bundled().iter().position(|(name, _)| formats::file_stem(name) == wanted);
                index.map(Value::Sample).ok_or_else(|| with_choices(self.wrong(app)))
            }
            Self::Switch => match text.trim() {
                "on" => Ok(Value::Switch(true)),
                "off" => Ok(Value::Switch(false)),
                _ => Err(self.wrong(app)),
            },
            Self::Answer => {
                let answers = answers(app);
                let found = answers.iter().find(|(word, _)| *word == text.trim());
                found.map(|&(word, _)| Value::Word(word)).ok_or_else(|| with_choices(self.wrong(app)))
            }
            Self::Command => {
                let mut commands = app.session.settings.commands().iter();
                let command = commands.find(|command| command.id == text.trim() && command.menu.is_some());
                command.map(|command| Value::Command(command.id)).ok_or_else(|| with_choices(self.wrong(app)))
            }
            Self::SidePanel => {
                let panel = app.panels.others().find(|panel| panel.id == text.trim());
                panel.map(|panel| Value::SidePanel(panel.id)).ok_or_else(|| with_choices(self.wrong(app)))
            }
            Self::Keys => text.parse().map(Value::Keys).map_err(|error: NoKeys| format!("expected {error}")),
            Self::Word(words) => {
                let found = words.iter().find(|(word, _)| *word == text.trim());
                found.map(|(word, _)| Value::Word(word)).ok_or_else(|| self.wrong(app))
            }
        }
    }

    /// Checks a value given directly rather than as text.
    ///
    /// # Errors
    /// When it does not fit; the error says what is expected.
    pub(crate) fn take(self, app: &App, value: Value) -> Result<Value, String> {
        let has = |element: ElementId| app.plan().is_some_and(|plan| plan.has(element));
        let is_in_reach = |point: &Point| {
            point.is_finite() && point.x.abs() <= COORDINATE_LIMIT_M && point.y.abs() <= COORDINATE_LIMIT_M
        };
        let is_taken = match (self, &value) {
            (
                Self::PlanFile
                | Self::NewPlanFile
                | Self::NewFile
                | Self::PictureFile
                | Self::LogFile
                | Self::RecentFile,
                Value::Path(path),
            ) => !path.as_os_str().is_empty(),
            (Self::OpenPlan, Value::OpenPlan(number)) => app.session.is_open(*number),
            (
                Self::Number { least, most, .. }
                | Self::Ratio { least, most }
                | Self::Angle { least_deg: least, most_deg: most }
                | Self::Coordinate { least_m: least, most_m: most },
                Value::Number(number),
            ) => (least..=most).contains(number),
            (Self::Percent, Value::Number(number)) => (0.0..=100.0).contains(number),
            (Self::Whole { most }, Value::Count(count)) => *count <= most,
            (Self::Length { least_m, most_m }, Value::Number(length_m)) => {
                let length_m = trim_m(*length_m);
                return if (least_m..=most_m).contains(&length_m) {
                    Ok(Value::Number(length_m))
                } else {
                    Err(self.wrong(app))
                };
            }
            (Self::Count, Value::Count(count)) => *count > 0,
            (Self::Room, Value::Room(id)) => has(ElementId::Room(*id)),
            (Self::Opening, Value::Opening(id)) => has(ElementId::Opening(*id)),
            (Self::Elements, Value::Elements(elements)) => {
                !elements.is_empty() && elements.iter().all(|&element| has(element))
            }
            (Self::Points { least }, Value::Points(points)) => points.len() >= least && points.iter().all(is_in_reach),
            (Self::Sample, Value::Sample(index)) => *index < bundled().len(),
            (Self::Word(words), Value::Word(word)) => words.iter().any(|(own, _)| own == word),
            (Self::Text | Self::Function, Value::Text(_))
            | (Self::Typology, Value::Typology(_))
            | (Self::ModelSet, Value::ModelSet(_))
            | (Self::Method, Value::Method(_))
            | (Self::Switch, Value::Switch(_))
            | (Self::Answer, Value::Word(_))
            | (Self::Command, Value::Command(_))
            | (Self::SidePanel, Value::SidePanel(_))
            | (Self::Keys, Value::Keys(_)) => true,
            _ => false,
        };
        if is_taken { Ok(value) } else { Err(self.wrong(app)) }
    }

    /// An argument as text, such that parsing it gives the same value.
    pub(crate) fn write(self, app: &App, value: &Value) -> String {
        match value {
            Value::Path(path) => path.to_string_lossy().into_owned(),
            Value::Text(text) => text.clone(),
            // With its unit: for someone else, numbers without one may mean feet.
            Value::Number(number) if matches!(self, Self::Length { .. }) => format!("{number}m"),
            Value::Number(number) => number.to_string(),
            Value::Count(count) => count.to_string(),
            Value::Room(id) => app.plan().map_or_else(|| id.to_string(), |plan| room_word(plan, *id)),
            Value::Opening(id) => id.to_string(),
            Value::Elements(elements) => elements_word(elements.iter().copied()),
            Value::Points(points) => points_word(points),
            Value::Typology(typology) => typology.as_ref().map_or(UNKNOWN, Typology::as_str).to_owned(),
            Value::ModelSet(set) => set.name().to_owned(),
            Value::Method(method) => method.name().to_owned(),
            Value::Sample(index) => sample_word(*index).to_owned(),
            Value::OpenPlan(number) => {
                let plans = app.session.open_plans().into_iter();
                plans.filter(|plan| plan.number == *number).map(|plan| plan.title).next().unwrap_or_default()
            }
            Value::Switch(is_on) => switch_word(*is_on).to_owned(),
            Value::Word(word) => (*word).to_owned(),
            Value::Command(id) | Value::SidePanel(id) => (*id).to_owned(),
            Value::Keys(keys) => keys.to_string(),
        }
    }

    /// All possible values of the argument; `None` if there is no such list. Rooms come in reading order,
    /// from the top left.
    pub(crate) fn choices(self, app: &App) -> Option<Vec<Choice>> {
        let plain = |word: &str, title: &str| Choice {
            word: word.to_owned(),
            title: title.to_owned(),
            detail: String::new(),
            trail: String::new(),
            status: None,
        };
        Some(match self {
            Self::PlanFile
            | Self::NewPlanFile
            | Self::NewFile
            | Self::PictureFile
            | Self::LogFile
            | Self::Text
            | Self::Number { .. }
            | Self::Length { .. }
            | Self::Coordinate { .. }
            | Self::Angle { .. }
            | Self::Ratio { .. }
            | Self::Percent
            | Self::Whole { .. }
            | Self::Count
            | Self::Keys
            | Self::Elements
            | Self::Points { .. } => return None,
            Self::RecentFile => {
                let choice = |path: PathBuf| {
                    let folder = path.parent().map(|folder| app.session.shown_path(folder)).unwrap_or_default();
                    let is_missing = app.session.missing.contains(&path);
                    let trail = if is_missing { "missing".to_owned() } else { String::new() };
                    let word = path.to_string_lossy().into_owned();
                    Choice { detail: folder, trail, ..plain(&word, &file_name(&path)) }
                };
                app.session.settings.recent().into_iter().map(choice).collect()
            }
            Self::OpenPlan => {
                let choice = |plan: OpenPlan| {
                    let title = if plan.is_changed { format!("• {}", plan.title) } else { plan.title.clone() };
                    let path = app.session.origin_of_open(plan.number).and_then(Origin::path);
                    let place = path.map_or("not saved yet".to_owned(), |path| app.session.shown_path(path));
                    Choice { detail: place, ..plain(&plan.title, &title) }
                };
                app.session.open_plans().into_iter().map(choice).collect()
            }
            Self::Room => room_choices(app),
            Self::Opening => opening_choices(app),
            Self::Function => app.session.function_choices(),
            Self::Typology => {
                let known =
                    app.session.schemes.typologies().map(|typology| plain(typology.as_str(), &typology.title()));
                known.chain([plain(UNKNOWN, "Unknown")]).collect()
            }
            Self::ModelSet => {
                let choice = |set: ModelSet| Choice { detail: set.help(), ..plain(set.name(), &set.title()) };
                ModelSet::all(&app.session.models).into_iter().map(choice).collect()
            }
            Self::Method => {
                let help = |method: Method| format!("Predict by {}", method.help());
                let choice =
                    |method: Method| Choice { detail: help(method), ..plain(method.name(), method.short_title()) };
                Method::ALL.into_iter().map(choice).collect()
            }
            Self::Sample => {
                let choice = |(name, plan): &(&str, Plan)| Choice {
                    detail: crate::base::wording::count(plan.rooms().len(), "room"),
                    ..plain(formats::file_stem(name), &plan.meta().name)
                };
                bundled().iter().map(choice).collect()
            }
            Self::Command => {
                let choice = |command: &Keyed| {
                    let title = command.title.trim_end_matches('…');
                    Some(Choice { detail: command.menu?.to_owned(), ..plain(command.id, title) })
                };
                app.session.settings.commands().iter().filter_map(choice).collect()
            }
            Self::SidePanel => {
                let choice =
                    |panel: &SidePanel| Choice { detail: panel.help.to_owned(), ..plain(panel.id, panel.title) };
                app.panels.others().map(choice).collect()
            }
            Self::Switch => vec![plain("on", "On"), plain("off", "Off")],
            Self::Answer => {
                let answers = answers(app);
                answers.iter().map(|(word, title)| plain(word, title)).collect()
            }
            Self::Word(words) => words.iter().map(|(word, title)| plain(word, title)).collect(),
        })
    }
}

fn room_choices(app: &App) -> Vec<Choice> {
    let Some(document) = &app.session.document else { return Vec::new() };
    let plan = document.plan();
    let mut ids: Vec<RoomId> = document.derived().map(|derived| derived.reading_order().to_vec()).unwrap_or_default();
    let is_listed: std::collections::BTreeSet<RoomId> = ids.iter().copied().collect();
    ids.extend(plan.rooms().map(|(id, _)| id).filter(|id| !is_listed.contains(id)));
    let mut names: std::collections::BTreeMap<String, usize> = std::collections::BTreeMap::new();
    for (_, room) in plan.rooms() {
        *names.entry(room.name.to_lowercase()).or_default() += 1;
    }
    let choice = |id: RoomId| {
        let room = plan.room(id)?;
        let status = RoomStatus::of(plan, &app.session.schemes, room);
        let is_unique = !room.name.is_empty() && names.get(&room.name.to_lowercase()) == Some(&1);
        // Like `room_word`, but faster for thousands of rooms.
        let word = if is_unique && is_own_word(&room.name) { room.name.clone() } else { id.to_string() };
        let area = document.derived().and_then(|derived| derived.analysis.net(id));
        let area = area.map(|net| app.units().area(net.area_m2));
        let detail = [status.label().map(|label| label.name().to_owned()), area];
        let detail: Vec<String> = detail.into_iter().flatten().collect();
        Some(Choice {
            word,
            title: room_title(room),
            detail: detail.join(", "),
            trail: String::new(),
            status: Some(status),
        })
    };
    ids.into_iter().filter_map(choice).collect()
}

fn opening_choices(app: &App) -> Vec<Choice> {
    let Some(document) = &app.session.document else { return Vec::new() };
    let plan = document.plan();
    let connections = document.derived().map(|derived| derived.analysis.graph.connections()).unwrap_or_default();
    let sides: std::collections::BTreeMap<OpeningId, &[Joint; 2]> =
        connections.iter().map(|connection| (connection.opening, &connection.sides)).collect();
    let name = |joint: &Joint| match joint {
        Joint::Outside => "outside".to_owned(),
        Joint::Room(id) => plan.room(*id).map(room_title).unwrap_or_default(),
    };
    let choice = |(id, opening): (OpeningId, &Opening)| {
        let detail = sides.get(&id).map(|sides| sides.each_ref().map(name).join(" – "));
        Choice {
            word: id.to_string(),
            title: sentence(opening.kind.name()),
            detail: detail.unwrap_or_default(),
            trail: String::new(),
            status: None,
        }
    };
    plan.openings().map(choice).collect()
}

/// The answers to the current question with their button titles; empty if there is none.
fn answers(app: &App) -> Vec<(&'static str, &'static str)> {
    app.session.question.as_ref().map(Question::answers).unwrap_or_default()
}
