//! Expectations and snapshots.

use std::path::{Path, PathBuf};

use super::{Group, Verb};
use crate::app::commands::{self, COMMANDS};
use crate::app::offscreen::controls::Control;
use crate::app::replay::act::Act;
use crate::app::replay::fault::Fault;
use crate::app::replay::snapshot::{self, Look, Region};
use crate::app::replay::stage::{Gestures, Stage, count};
use crate::app::replay::verbs::window::{is_dark, scale, size};
use crate::app::replay::words::{Words, did_you_mean, in_quotes, told, written};
use crate::base::file_name::inner_path;
use crate::features::{NeighbourLabels, RoomStatus};
use crate::formats::{self, plan_json};
use crate::labels::{Label, Schemes};
use crate::plan::{ElementId, OpeningKind, RoomId};
use crate::store::save_bytes_fast;
use crate::topology::RoomShapes;

pub(super) const GROUP: Group = Group {
    title: "Checks and pictures",
    verbs: &[
        Verb {
            name: "expect",
            form: "expect WHAT",
            help: "Says what must be so now; see below.",
            parse: |words| {
                let name = words.text("what is expected")?;
                let known = EXPECTATIONS.iter().find(|expectation| expectation.name == name);
                let Some(expectation) = known else {
                    let near = did_you_mean(name, EXPECTATIONS.iter().map(|expectation| expectation.name));
                    let near = if near.is_empty() { near } else { format!(" ({near})") };
                    return Err(format!("{} is nothing that can be expected{near}", told(name)));
                };
                (expectation.parse)(words).map_err(|what| format!("{what}, as in expect {}", expectation.form))
            },
        },
        Verb {
            name: "count-gestures",
            form: "count-gestures",
            help: "Counts clicks and keys from here on, for `expect gestures`.",
            parse: |_| {
                Ok(Box::new(|stage| {
                    stage.gestures = Gestures::default();
                    Ok(())
                }))
            },
        },
        Verb {
            name: "snapshot",
            form: "snapshot NAME [--region all|canvas|middle|dialog|panel|list] [--size WIDTHxHEIGHT] [--scale NUMBER] \
                   [--theme light|dark]",
            help: "Compares the window with the picture NAME.png, pixel for pixel; all of it, the canvas, the canvas \
                   with its rulers and the messages over it (middle), the dialog, palette or menu in front, the panel \
                   on the right, or the list on the left. Size, scale and theme are for the picture only.",
            parse: snapshot,
        },
    ],
};

/// A kind of expectation.
pub(super) struct Expectation {
    name: &'static str,
    /// Its syntax after `expect`.
    pub form: &'static str,
    pub help: &'static str,
    parse: fn(&mut Words<'_>) -> Result<Act, String>,
}

/// All kinds of expectation.
pub(super) const EXPECTATIONS: &[Expectation] = &[
    Expectation {
        name: "rooms",
        form: "rooms N",
        help: "so many rooms",
        parse: |words| {
            let expected = words.count("the number of rooms")?;
            Ok(Box::new(move |stage| same_number("room", expected, stage.plan()?.rooms().len())))
        },
    },
    Expectation {
        name: "openings",
        form: "openings N",
        help: "so many doors and passages, windows not counted",
        parse: |words| {
            let expected = words.count("the number of openings")?;
            Ok(Box::new(move |stage| {
                let passable = stage.plan()?.openings().filter(|(_, opening)| opening.kind != OpeningKind::Window);
                same_number("opening", expected, passable.count())
            }))
        },
    },
    Expectation {
        name: "walls",
        form: "walls N",
        help: "so many walls",
        parse: |words| {
            let expected = words.count("the number of walls")?;
            Ok(Box::new(move |stage| same_number("wall", expected, stage.plan()?.walls().len())))
        },
    },
    Expectation {
        name: "areas",
        form: "areas TEXT",
        help: "the areas of all rooms along the axes of their walls, ascending, in m² with two decimals and a blank \
               between",
        parse: |words| {
            let expected = words.text("the areas")?.to_owned();
            Ok(Box::new(move |stage| {
                let shapes = RoomShapes::new(stage.plan()?);
                let mut areas: Vec<f64> = shapes.all().iter().map(|shape| shape.area_m2()).collect();
                areas.sort_by(f64::total_cmp);
                let found: Vec<String> = areas.into_iter().map(|area_m2| format!("{area_m2:.2}")).collect();
                same("the areas", &expected, &found.join(" "))
            }))
        },
    },
    Expectation {
        name: "label",
        form: "label ROOM LABEL",
        help: "the room's label, its own or by its function: small, medium, big, corridor, hall, none, or unclassified \
               where the scheme leaves it blank",
        parse: |words| {
            let room = words.text("the room")?.to_owned();
            let expected = status(words.text("the label")?)?;
            Ok(Box::new(move |stage| {
                let id = stage.room(&room, None)?;
                let found = stage.window.app().status_of(id).map_or("none", status_name);
                same(&format!("the label of {}", in_quotes(&room)), status_name(expected), found)
            }))
        },
    },
    Expectation {
        name: "function",
        form: "function ROOM TEXT",
        help: "what the room is for",
        parse: |words| {
            let (room, expected) = (words.text("the room")?.to_owned(), words.text("the function")?.to_owned());
            Ok(Box::new(move |stage| {
                let id = stage.room(&room, None)?;
                let found = stage.plan()?.room(id).map(|room| room.function.clone()).unwrap_or_default();
                same(&format!("the function of {}", in_quotes(&room)), &expected, &found)
            }))
        },
    },
    Expectation {
        name: "room",
        form: "room ROOM present|absent",
        help: "whether there is a room of this name or id",
        parse: |words| {
            let room = words.text("the room")?.to_owned();
            let is_expected = present(words)?;
            Ok(Box::new(move |stage| {
                let found = stage.room(&room, Some(1));
                match (is_expected, found) {
                    (true, Err(fault)) => Err(Fault { goes_on: true, ..fault }),
                    (false, Ok(_)) => Err(Fault::unmet(format!("expected no room {}, found one", in_quotes(&room)))),
                    _ => Ok(()),
                }
            }))
        },
    },
    Expectation {
        name: "clear",
        form: "clear ROOM TEXT",
        help: "the room's clear area, between wall faces, as it is shown: '12.0 m²'",
        parse: |words| {
            let (room, expected) = (words.text("the room")?.to_owned(), words.text("the area")?.to_owned());
            Ok(Box::new(move |stage| {
                let id = stage.room(&room, None)?;
                let analysis = crate::features::analyse(stage.plan()?, &Schemes::bundled(), NeighbourLabels::True);
                let net_m2 = analysis.net(id).map_or(0.0, |net| net.area_m2);
                let found = stage.window.app().units().area(net_m2);
                same(&format!("the clear area of {}", in_quotes(&room)), &expected, &found)
            }))
        },
    },
    Expectation {
        name: "dimension",
        form: "dimension TEXT",
        help: "the figures of a dimension chain in order, as '1.43 + 0.90'; 'none' where there is no chain",
        parse: |words| {
            let expected = words.text("the figures")?.to_owned();
            Ok(Box::new(move |stage| {
                let units = stage.window.app().units();
                let figures = |line: crate::plan::DimensionLine| {
                    line.lengths_m().map(|length_m| units.dimension(length_m)).collect::<Vec<String>>().join(" + ")
                };
                let found: Vec<String> =
                    crate::draw::dimensions::lines(stage.plan()?).into_iter().map(|(_, line)| figures(line)).collect();
                let is_so = found.contains(&expected) || (found.is_empty() && expected == "none");
                let found = if found.is_empty() { "none".to_owned() } else { in_quotes(&found.join(" / ")) };
                if is_so {
                    Ok(())
                } else {
                    Err(Fault::unmet(format!("expected the dimension {expected}, found {found}")))
                }
            }))
        },
    },
    Expectation {
        name: "picked",
        form: "picked ROOM | opening | wall | corner | dimension | nothing",
        help: "the one thing that is selected",
        parse: |words| {
            let word = words.next().ok_or("what is picked is missing")?.clone();
            Ok(Box::new(move |stage| picked(stage, &word.text, word.is_quoted)))
        },
    },
    Expectation {
        name: "status",
        form: "status TEXT",
        help: "the status line holds this text",
        parse: |words| {
            let expected = words.text("the text")?.to_owned();
            Ok(Box::new(move |stage| holds("the status line", &expected, &stage.window.app().status_text())))
        },
    },
    Expectation {
        name: "message",
        form: "message TEXT",
        help: "a message over the canvas holds this text",
        parse: |words| {
            let expected = words.text("the text")?.to_owned();
            Ok(Box::new(move |stage| {
                let messages = stage.window.app().messages();
                let texts: Vec<String> =
                    messages.iter().map(|message| format!("{} {}", message.text, message.detail)).collect();
                if texts.iter().any(|text| text.contains(&expected)) {
                    return Ok(());
                }
                let found = if texts.is_empty() { "none".to_owned() } else { in_quotes(&texts.join(" / ")) };
                Err(Fault::unmet(format!("expected a message with {}, found {found}", in_quotes(&expected))))
            }))
        },
    },
    Expectation {
        name: "messages",
        form: "messages N",
        help: "so many messages stand over the canvas",
        parse: |words| {
            let expected = words.count("the number of messages")?;
            Ok(Box::new(move |stage| same_number("message", expected, stage.window.app().messages().len())))
        },
    },
    Expectation {
        name: "gestures",
        form: "gestures CLICKS KEYS",
        help: "so many clicks and keys since `count-gestures`, or the start; a double click and a drag count two, a turn \
               of the wheel one, a key held with others one, and each character typed",
        parse: |words| {
            let (clicks, keys) = (words.count("the number of clicks")?, words.count("the number of keys")?);
            Ok(Box::new(move |stage| {
                let Gestures { clicks: found_clicks, keys: found_keys } = stage.gestures;
                same("what the hand did", &format!("{clicks} {keys}"), &format!("{found_clicks} {found_keys}"))
            }))
        },
    },
    Expectation {
        name: "title",
        form: "title TEXT",
        help: "the window's title holds this text",
        parse: |words| {
            let expected = words.text("the text")?.to_owned();
            Ok(Box::new(move |stage| holds("the title", &expected, stage.window.app().window_title())))
        },
    },
    Expectation {
        name: "control",
        form: "control NAME [present|absent|enabled|disabled|on|off]",
        help: "whether a control is on the screen, can be used, is on",
        parse: control,
    },
    Expectation {
        name: "command",
        form: "command ID available|unavailable",
        help: "whether a command can be done now",
        parse: |words| {
            let id = words.text("the command")?;
            let Some(command) = commands::find(id) else {
                let near = did_you_mean(id, COMMANDS.iter().map(|command| command.id));
                return Err(format!("{} is no command ({near})", told(id)).replace(" ()", ""));
            };
            let word = words.text("available or unavailable")?;
            let expected = choice(word, [("available", true), ("unavailable", false)])?;
            Ok(Box::new(move |stage| {
                let why_not = command.why_not(stage.window.app());
                match (expected, why_not) {
                    (true, Some(why)) => {
                        Err(Fault::unmet(format!("the command {}: expected available, found: {why}", command.id)))
                    }
                    (false, None) => same(&format!("the command {}", command.id), "unavailable", "available"),
                    _ => Ok(()),
                }
            }))
        },
    },
    Expectation {
        name: "unsaved",
        form: "unsaved yes|no",
        help: "whether the plan has changes that are in no file",
        parse: |words| {
            let expected = yes(words)?;
            Ok(Box::new(move |stage| {
                same("unsaved changes", yes_no(expected), yes_no(stage.window.app().has_unsaved_changes()))
            }))
        },
    },
    Expectation {
        name: "closed",
        form: "closed yes|no",
        help: "whether the window has closed",
        parse: |words| {
            let expected = yes(words)?;
            Ok(Box::new(move |stage| same("closed", yes_no(expected), yes_no(stage.window.is_closed()))))
        },
    },
    Expectation {
        name: "clipboard",
        form: "clipboard TEXT",
        help: "what was copied holds this text",
        parse: |words| {
            let expected = words.text("the text")?.to_owned();
            Ok(Box::new(move |stage| holds("the clipboard", &expected, stage.window.clipboard())))
        },
    },
    Expectation {
        name: "plan",
        form: "plan equals FILE | none",
        help: "the plan, as a plan file, is byte for byte this file beside the script; or none is open",
        parse: |words| {
            if words.keyword("none") {
                return Ok(Box::new(|stage| match stage.window.app().plan() {
                    None => Ok(()),
                    Some(_) => Err(Fault::unmet("expected no plan, found one open")),
                }));
            }
            let reference = equals(words)?;
            Ok(Box::new(move |stage| {
                let bytes = plan_json::to_bytes(stage.plan()?);
                same_bytes(stage, "the plan", &reference, &bytes)
            }))
        },
    },
    Expectation {
        name: "file",
        form: "file PATH exists|missing|equals FILE",
        help: "whether the script saved a file, and whether it is byte for byte that one beside the script",
        parse: file,
    },
];

fn picked(stage: &Stage<'_>, expected: &str, is_quoted: bool) -> Result<(), Fault> {
    let found = stage.window.app().picked();
    let name = match found {
        None => "nothing".to_owned(),
        Some(ElementId::Opening(_)) => "opening".to_owned(),
        Some(ElementId::Room(id)) => room_name(stage, id),
        Some(ElementId::Wall(_)) => "wall".to_owned(),
        Some(ElementId::Corner(_)) => "corner".to_owned(),
        Some(ElementId::Dimension(_)) => "dimension".to_owned(),
    };
    let is_so = match (expected, is_quoted) {
        ("nothing", false) => found.is_none(),
        ("opening", false) => matches!(found, Some(ElementId::Opening(_))),
        ("wall", false) => matches!(found, Some(ElementId::Wall(_))),
        ("corner", false) => matches!(found, Some(ElementId::Corner(_))),
        ("dimension", false) => matches!(found, Some(ElementId::Dimension(_))),
        (room, _) => {
            matches!(found, Some(ElementId::Room(id)) if room_name(stage, id) == room || id.to_string() == room)
        }
    };
    if is_so {
        return Ok(());
    }
    Err(Fault::unmet(format!("expected picked {}, found {}", written(expected), written(&name))))
}

/// A room's name or, without one, its id.
fn room_name(stage: &Stage<'_>, id: RoomId) -> String {
    let name = stage.window.app().plan().and_then(|plan| plan.room(id)).map(|room| room.name.clone());
    name.filter(|name| !name.is_empty()).unwrap_or_else(|| id.to_string())
}

fn control(words: &mut Words<'_>) -> Result<Act, String> {
    let name = words.text("the control's name")?.to_owned();
    let state = if words.is_empty() { "present" } else { words.text("its state")? };
    type IsSo = fn(&Control) -> bool;
    let is_so: Option<IsSo> = choice(
        state,
        [
            ("present", Some((|_| true) as IsSo)),
            ("absent", None),
            ("enabled", Some(|control| control.is_enabled)),
            ("disabled", Some(|control| !control.is_enabled)),
            ("on", Some(|control| control.is_on == Some(true))),
            ("off", Some(|control| control.is_on == Some(false))),
        ],
    )?;
    let state = state.to_owned();
    Ok(Box::new(move |stage| {
        let found = stage.control(&name, None);
        match (is_so, found) {
            (None, Err(_)) => Ok(()),
            (None, Ok(_)) => Err(Fault::unmet(format!("expected no control {}, found one", in_quotes(&name)))),
            (Some(_), Err(fault)) => Err(Fault { goes_on: true, ..fault }),
            (Some(is_so), Ok(control)) if is_so(&control) => Ok(()),
            (Some(_), Ok(control)) => {
                let enabled = if control.is_enabled { "enabled" } else { "disabled" };
                let on = control.is_on.map_or("", |is_on| if is_on { " and on" } else { " and off" });
                let name = in_quotes(&name);
                Err(Fault::unmet(format!("expected the control {name} to be {state}, found it {enabled}{on}")))
            }
        }
    }))
}

fn file(words: &mut Words<'_>) -> Result<Act, String> {
    let path = words.text("the path")?.to_owned();
    if words.peek() == Some("equals") {
        let reference = equals(words)?;
        return Ok(Box::new(move |stage| {
            let bytes = formats::read_bytes(&stage.folders.to_write(&path)?)
                .map_err(|_| Fault::unmet(format!("expected the file {}, found none", written(&path))))?;
            same_bytes(stage, &format!("the file {}", written(&path)), &reference, &bytes)
        }));
    }
    let expected = choice(words.text("exists or missing")?, [("exists", true), ("missing", false)])?;
    Ok(Box::new(move |stage| {
        let word = |is: bool| if is { "exists" } else { "missing" };
        let found = stage.folders.to_write(&path)?.exists();
        same(&format!("the file {}", written(&path)), word(expected), word(found))
    }))
}

fn snapshot(words: &mut Words<'_>) -> Result<Act, String> {
    let name = words.text("the picture's name")?;
    let is_plain = |letter: char| letter.is_alphanumeric() || letter == '-' || letter == '_';
    if name.is_empty() || !name.chars().all(is_plain) {
        return Err(format!("a picture's name is letters, digits, - and _, not {}", told(name)));
    }
    let name = name.to_owned();
    let mut look = Look::default();
    while let Some(word) = words.next() {
        match word.text.as_str() {
            "--region" => {
                let region = words.text("the region")?;
                look.region = choice(region, Region::ALL.map(|region| (region.name(), region)))?;
            }
            "--size" => look.size = Some(size(words)?),
            "--scale" => look.scale = Some(scale(words)?),
            "--theme" => look.is_dark = Some(is_dark(words)?),
            other => return Err(format!("{} is no option of a snapshot", told(other))),
        }
    }
    Ok(Box::new(move |stage| snapshot::take(stage, &name, &look)))
}

// Words with few values.

fn choice<T: Clone, const N: usize>(word: &str, choices: [(&str, T); N]) -> Result<T, String> {
    match choices.iter().find(|(name, _)| *name == word) {
        Some((_, value)) => Ok(value.clone()),
        None => {
            let names: Vec<&str> = choices.iter().map(|(name, _)| *name).collect();
            Err(format!("{} is none of {}", told(word), names.join(", ")))
        }
    }
}

fn yes(words: &mut Words<'_>) -> Result<bool, String> {
    choice(words.text("yes or no")?, [("yes", true), ("no", false)])
}

fn yes_no(is: bool) -> &'static str {
    if is { "yes" } else { "no" }
}

fn present(words: &mut Words<'_>) -> Result<bool, String> {
    choice(words.text("present or absent")?, [("present", true), ("absent", false)])
}

/// The file behind `equals`, from the script's folder.
fn equals(words: &mut Words<'_>) -> Result<PathBuf, String> {
    if words.keyword("equals") {
        // It is written with --update: nowhere but beside the script.
        inner_path(words.text("the file")?)
            .map_err(|error| format!("{error}; what is expected lies beside the script, or in a folder there"))
    } else {
        Err("equals and a file are missing".to_owned())
    }
}

/// The labels, and other statuses of a room, with their names in scripts.
const STATUSES: [(&str, RoomStatus); 7] = [
    ("small", RoomStatus::Labelled(Label::SmallRoom)),
    ("medium", RoomStatus::Labelled(Label::MediumRoom)),
    ("big", RoomStatus::Labelled(Label::BigRoom)),
    ("corridor", RoomStatus::Labelled(Label::Corridor)),
    ("hall", RoomStatus::Labelled(Label::Hall)),
    ("none", RoomStatus::Unlabelled),
    ("unclassified", RoomStatus::NotClassified),
];

fn status(word: &str) -> Result<RoomStatus, String> {
    match Label::ALL.into_iter().find(|label| label.letter() == word || label.name() == word) {
        Some(label) => Ok(RoomStatus::Labelled(label)),
        None => choice(word, STATUSES),
    }
}

fn status_name(status: RoomStatus) -> &'static str {
    STATUSES.iter().find(|(_, known)| *known == status).map_or("none", |(name, _)| name)
}

// Actual values.

fn same_number(thing: &str, expected: usize, found: usize) -> Result<(), Fault> {
    if expected == found {
        return Ok(());
    }
    Err(Fault::unmet(format!("expected {}, found {found}", count(expected, thing))))
}

fn same(what: &str, expected: &str, found: &str) -> Result<(), Fault> {
    if expected == found {
        return Ok(());
    }
    Err(Fault::unmet(format!("{what}: expected {}, found {}", written(expected), written(found))))
}

fn holds(what: &str, expected: &str, found: &str) -> Result<(), Fault> {
    if found.contains(expected) {
        return Ok(());
    }
    Err(Fault::unmet(format!("{what}: expected {}, found {}", in_quotes(expected), in_quotes(found))))
}

/// Compares bytes with a file beside the script. If they differ, they are written beside it, as
/// `….out.…`.
fn same_bytes(stage: &mut Stage<'_>, what: &str, reference: &Path, found: &[u8]) -> Result<(), Fault> {
    let path = stage.folders.script.join(reference);
    let out = snapshot::beside(&path, "out");
    let save = |path: &Path| save_bytes_fast(path, found).map_err(|error| Fault::new(error.to_string()));
    let expected = formats::read_bytes(&path).ok();
    if expected.as_deref() == Some(found) {
        // A file left by an earlier run is stale.
        let _ = std::fs::remove_file(&out);
        return Ok(());
    }
    if stage.is_updating {
        save(&path)?;
        let _ = std::fs::remove_file(&out);
        stage.updated.push(path);
        return Ok(());
    }
    save(&out)?;
    let name = written(&reference.display().to_string());
    let (difference, hint) = match expected {
        None => (format!("there is no file {name}"), "look at what was written; --update makes it the reference"),
        Some(expected) => {
            let line = 1 + expected.iter().zip(found).take_while(|(p, q)| p == q).filter(|(p, _)| **p == b'\n').count();
            (format!("differs from {name} in line {line}"), "compare the two; --update makes it the reference")
        }
    };
    let what = if difference.starts_with("there") { difference } else { format!("{what} {difference}") };
    Err(Fault::unmet(what).hint(hint).files(vec![out]))
}
