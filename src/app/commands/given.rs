//! Typed arguments: an argument's name, kind, parsing and resulting type are declared in one place, so
//! that a wrong index or a wrong kind does not compile.

use std::marker::PhantomData;
use std::path::PathBuf;

use egui::Context;

use super::{Argument, ArgumentKind, Outcome};
use crate::app::look::keys::Keys;
use crate::app::state::App;
use crate::app::value::{Value, Values, Worded};
use crate::classify::Method;
use crate::geometry::Point;
use crate::labels::Typology;
use crate::plan::{ElementId, OpeningId, RoomId};
use crate::predict::ModelSet;

/// A type that a command can get from a value.
pub(super) trait OfValue: Sized + 'static {
    /// `None` if the value is of another kind.
    fn of(value: &Value) -> Option<Self>;
}

/// Implements `OfValue` for one kind of value.
macro_rules! of_value {
    ($($type:ty: $variant:ident;)*) => {$(
        impl OfValue for $type {
            fn of(value: &Value) -> Option<Self> {
                match value {
                    Value::$variant(value) => Some(value.clone()),
                    _ => None,
                }
            }
        }
    )*};
}

of_value! {
    PathBuf: Path;
    String: Text;
    f64: Number;
    usize: Count;
    RoomId: Room;
    OpeningId: Opening;
    Vec<ElementId>: Elements;
    Vec<Point>: Points;
    Option<Typology>: Typology;
    ModelSet: ModelSet;
    Method: Method;
    bool: Switch;
    &'static str: Word;
    Keys: Keys;
}

/// The first of some points.
impl OfValue for Point {
    fn of(value: &Value) -> Option<Self> {
        match value {
            Value::Points(points) => points.first().copied(),
            _ => None,
        }
    }
}

/// A command's id.
pub(super) struct CommandId(pub &'static str);

impl OfValue for CommandId {
    fn of(value: &Value) -> Option<Self> {
        match value {
            Value::Command(id) => Some(Self(id)),
            _ => None,
        }
    }
}

/// The number of an open plan's document.
pub(super) struct OpenPlanNumber(pub u64);

impl OfValue for OpenPlanNumber {
    fn of(value: &Value) -> Option<Self> {
        match value {
            Value::OpenPlan(number) => Some(Self(*number)),
            _ => None,
        }
    }
}

/// The id of a panel at a side of the canvas.
pub(super) struct SidePanelId(pub &'static str);

impl OfValue for SidePanelId {
    fn of(value: &Value) -> Option<Self> {
        match value {
            Value::SidePanel(id) => Some(Self(id)),
            _ => None,
        }
    }
}

/// The index of a plan that comes with the program.
pub(super) struct Sample(pub usize);

impl OfValue for Sample {
    fn of(value: &Value) -> Option<Self> {
        match value {
            Value::Sample(index) => Some(Self(*index)),
            _ => None,
        }
    }
}

impl<T: Worded> OfValue for T {
    fn of(value: &Value) -> Option<Self> {
        match value {
            Value::Word(word) => T::of_its_word(word),
            _ => None,
        }
    }
}

/// The kind of an argument, and the type a command gets from it.
pub(super) struct Kind<T> {
    kind: ArgumentKind,
    of: PhantomData<fn() -> T>,
}

const fn kind<T>(kind: ArgumentKind) -> Kind<T> {
    Kind { kind, of: PhantomData }
}

pub(super) const PLAN_FILE: Kind<PathBuf> = kind(ArgumentKind::PlanFile);
pub(super) const NEW_PLAN_FILE: Kind<PathBuf> = kind(ArgumentKind::NewPlanFile);
pub(super) const NEW_FILE: Kind<PathBuf> = kind(ArgumentKind::NewFile);
pub(super) const PICTURE_FILE: Kind<PathBuf> = kind(ArgumentKind::PictureFile);
pub(super) const LOG_FILE: Kind<PathBuf> = kind(ArgumentKind::LogFile);
pub(super) const RECENT_FILE: Kind<PathBuf> = kind(ArgumentKind::RecentFile);
pub(super) const OPEN_PLAN: Kind<OpenPlanNumber> = kind(ArgumentKind::OpenPlan);
pub(super) const TEXT: Kind<String> = kind(ArgumentKind::Text);
pub(super) const FUNCTION: Kind<String> = kind(ArgumentKind::Function);
pub(super) const COUNT: Kind<usize> = kind(ArgumentKind::Count);
pub(super) const A_ROOM: Kind<RoomId> = kind(ArgumentKind::Room);
pub(super) const OPENING: Kind<OpeningId> = kind(ArgumentKind::Opening);
pub(super) const ELEMENTS: Kind<Vec<ElementId>> = kind(ArgumentKind::Elements);
pub(super) const POINT: Kind<Point> = kind(ArgumentKind::Points { least: 1 });
pub(super) const TYPOLOGY: Kind<Option<Typology>> = kind(ArgumentKind::Typology);
pub(super) const MODEL_SET: Kind<ModelSet> = kind(ArgumentKind::ModelSet);
pub(super) const METHOD: Kind<Method> = kind(ArgumentKind::Method);
pub(super) const SAMPLE: Kind<Sample> = kind(ArgumentKind::Sample);
pub(super) const ON_OR_OFF: Kind<bool> = kind(ArgumentKind::Switch);
pub(super) const ANSWER: Kind<&'static str> = kind(ArgumentKind::Answer);
pub(super) const A_COMMAND: Kind<CommandId> = kind(ArgumentKind::Command);
pub(super) const PANEL: Kind<SidePanelId> = kind(ArgumentKind::SidePanel);
pub(super) const PERCENT: Kind<f64> = kind(ArgumentKind::Percent);
pub(super) const KEYS: Kind<Keys> = kind(ArgumentKind::Keys);

/// A number of what is neither a length nor an angle nor a share: what it counts, with a blank before, and its range.
pub(super) const fn number(unit: &'static str, least: f64, most: f64) -> Kind<f64> {
    kind(ArgumentKind::Number { unit, least, most })
}

/// A place on an axis, in scripts in metres whatever is set.
pub(super) const fn coordinate(least_m: f64, most_m: f64) -> Kind<f64> {
    kind(ArgumentKind::Coordinate { least_m, most_m })
}

/// A length in the current units, or with its own.
pub(super) const fn length(least_m: f64, most_m: f64) -> Kind<f64> {
    kind(ArgumentKind::Length { least_m, most_m })
}

/// An angle; what a command gets is in degrees.
pub(super) const fn angle(least_deg: f64, most_deg: f64) -> Kind<f64> {
    kind(ArgumentKind::Angle { least_deg, most_deg })
}

/// A factor.
pub(super) const fn ratio(least: f64, most: f64) -> Kind<f64> {
    kind(ArgumentKind::Ratio { least, most })
}

/// A whole number from 0 on.
pub(super) const fn whole(most: usize) -> Kind<usize> {
    kind(ArgumentKind::Whole { most })
}

/// At least so many points.
pub(super) const fn points(least: usize) -> Kind<Vec<Point>> {
    kind(ArgumentKind::Points { least })
}

/// One of several named things.
pub(super) const fn one_of<T: Worded>() -> Kind<T> {
    assert!(T::WORDS.len() == T::ALL.len(), "a word for each");
    kind(ArgumentKind::Word(T::WORDS))
}

/// How to get an argument from a value, or from none.
type Get<T> = fn(Option<&Value>) -> Option<T>;

/// An argument of a command, and the type it gets.
pub(super) struct Arg<T> {
    argument: Argument,
    get: Get<T>,
}

/// A required argument.
pub(super) const fn needed<T: OfValue>(name: &'static str, kind: Kind<T>, help: &'static str) -> Arg<T> {
    Arg { argument: Argument { name, kind: kind.kind, is_optional: false, help }, get: |value| T::of(value?) }
}

/// An optional argument.
pub(super) const fn optional<T: OfValue>(name: &'static str, kind: Kind<T>, help: &'static str) -> Arg<Option<T>> {
    Arg {
        argument: Argument { name, kind: kind.kind, is_optional: true, help },
        get: |value| match value {
            None => Some(None),
            Some(value) => T::of(value).map(Some),
        },
    }
}

impl<T> Arg<T> {
    pub(super) const fn argument(&self) -> Argument {
        self.argument
    }
}

/// What a command does with its arguments.
pub(super) trait Run: Sync {
    fn run(&self, app: &mut App, values: &Values, context: &Context) -> Outcome;
}

/// The arguments, how to get each, and the function to run.
pub(super) struct Given<const N: usize, G, F> {
    pub arguments: [Argument; N],
    get: G,
    run: F,
}

/// Values have already been checked against the arguments, so this is never shown.
const MISFIT: &str = "an argument is of another kind than the command takes";

macro_rules! given {
    ($($name:ident $n:literal: $($a:ident $T:ident),*;)*) => {$(
        pub(super) const fn $name<$($T),*>(
            $($a: Arg<$T>,)*
            run: fn(&mut App, $($T,)* &Context) -> Outcome,
        ) -> Given<$n, ($(Get<$T>,)*), fn(&mut App, $($T,)* &Context) -> Outcome> {
            Given { arguments: [$($a.argument),*], get: ($($a.get,)*), run }
        }

        impl<$($T),*> Run for Given<$n, ($(Get<$T>,)*), fn(&mut App, $($T,)* &Context) -> Outcome> {
            fn run(&self, app: &mut App, values: &Values, context: &Context) -> Outcome {
                let ($($a,)*) = self.get;
                let mut values = values.0.iter();
                let ($(Some($a),)*) = ($($a(values.next()),)*) else { return Outcome::Refused(MISFIT.to_owned()) };
                (self.run)(app, $($a,)* context)
            }
        }
    )*};
}

given! {
    given1 1: a A;
    given2 2: a A, b B;
    given3 3: a A, b B, c C;
    given4 4: a A, b B, c C, d D;
    given5 5: a A, b B, c C, d D, e E;
    given6 6: a A, b B, c C, d D, e E, f F;
}

/// A command without arguments.
pub(super) const fn given0(run: fn(&mut App, &Context) -> Outcome) -> Given<0, (), fn(&mut App, &Context) -> Outcome> {
    Given { arguments: [], get: (), run }
}

impl Run for Given<0, (), fn(&mut App, &Context) -> Outcome> {
    fn run(&self, app: &mut App, _: &Values, context: &Context) -> Outcome {
        (self.run)(app, context)
    }
}

#[cfg(test)]
mod tests {
    use crate::app::session::{bulk::Order, selection::SelectMode};
    use crate::app::value::{Boxed, Direction, Space, Value, Worded};
    use crate::edit::{Alignment, DrawingMoves, End, storey::Keep};
    use crate::plan::{GuideAxis, LeafSide, OpeningKind};

    fn assert_has_words<T: Worded + PartialEq + std::fmt::Debug>() {
        assert_eq!(T::WORDS.len(), T::ALL.len());
        for (&thing, (word, _)) in T::ALL.iter().zip(T::WORDS) {
            assert_eq!(T::of_its_word(word), Some(thing));
            assert!(matches!(Value::word(thing), Value::Word(own) if own == *word), "{word}");
        }
        assert_eq!(T::of_its_word("trapdoor"), None);
    }

    #[test]
    fn every_word_means_one_thing() {
        assert_has_words::<OpeningKind>();
        assert_has_words::<End>();
        assert_has_words::<LeafSide>();
        assert_has_words::<SelectMode>();
        assert_has_words::<GuideAxis>();
        assert_has_words::<Keep>();
        assert_has_words::<DrawingMoves>();
        assert_has_words::<Order>();
        assert_has_words::<Alignment>();
        assert_has_words::<Space>();
        assert_has_words::<Boxed>();
        assert_has_words::<Direction>();
        // As they are called everywhere else.
        for axis in GuideAxis::ALL {
            assert_eq!(GuideAxis::of_its_word(axis.name()), Some(axis));
        }
    }
}
