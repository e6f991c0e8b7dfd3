//! Pointer actions.

use egui::{Event, Modifiers, PointerButton, Pos2, vec2};

use super::{Group, Verb};
use crate::app::replay::act::Act;
use crate::app::replay::fault::Fault;
use crate::app::replay::place::Place;
use crate::app::replay::stage::Stage;
use crate::app::replay::verbs::keyboard::modifiers_of;
use crate::app::replay::words::{Words, written};

pub(super) const GROUP: Group = Group {
    title: "Pointer",
    verbs: &[
        Verb {
            name: "move",
            form: "move PLACE",
            help: "Moves the pointer.",
            parse: |words| {
                let place = Place::take(words)?;
                Ok(Box::new(move |stage| {
                    let at = place.on_screen(stage)?;
                    stage.window.move_to(at);
                    Ok(())
                }))
            },
        },
        Verb {
            name: "click",
            form: "click [BUTTON] PLACE [with Ctrl+Shift+Alt]",
            help: "Clicks; the button is left, right or middle.",
            parse: |words| clicks(words, 1),
        },
        Verb {
            name: "double-click",
            form: "double-click [BUTTON] PLACE [with Ctrl+Shift+Alt]",
            help: "Clicks twice.",
            parse: |words| clicks(words, 2),
        },
        Verb {
            name: "triple-click",
            form: "triple-click [BUTTON] PLACE [with Ctrl+Shift+Alt]",
            help: "Clicks three times.",
            parse: |words| clicks(words, 3),
        },
        Verb {
            name: "right-click",
            form: "right-click PLACE [with Ctrl+Shift+Alt]",
            help: "Clicks with the right button.",
            parse: |words| clicks_with(words, PointerButton::Secondary, 1),
        },
        Verb {
            name: "drag",
            form: "drag [BUTTON] PLACE [via PLACE]... to PLACE [with Ctrl+Shift+Alt]",
            help: "Drags from a place by way of others to another. All are meant in the view before.",
            parse: drag,
        },
        Verb {
            name: "press",
            form: "press [BUTTON]",
            help: "Presses a button where the pointer is.",
            parse: |words| Ok(press(button(words), true)),
        },
        Verb {
            name: "release",
            form: "release [BUTTON]",
            help: "Lets go of a button.",
            parse: |words| Ok(press(button(words), false)),
        },
        Verb {
            name: "leave",
            form: "leave",
            help: "Takes the pointer out of the window.",
            parse: |_| {
                Ok(Box::new(|stage| {
                    stage.window.event(Event::PointerGone);
                    Ok(())
                }))
            },
        },
        Verb {
            name: "scroll",
            form: "scroll LINES [PLACE] [with Ctrl+Shift+Alt]",
            help: "Turns the wheel by lines, away from the person when positive.",
            parse: |words| {
                let lines = words.number("the number of lines", -1000.0, 1000.0)? as f32;
                over_place(words, move |stage| stage.window.wheel(lines))
            },
        },
        Verb {
            name: "swipe",
            form: "swipe X,Y [PLACE] [with Ctrl+Shift+Alt]",
            help: "Moves two fingers on a touch pad by so many logical pixels.",
            parse: |words| {
                let (x, y) = words.pair("the way of the fingers")?;
                over_place(words, move |stage| stage.window.swipe(vec2(x as f32, y as f32)))
            },
        },
        Verb {
            name: "pinch",
            form: "pinch FACTOR [PLACE]",
            help: "Spreads two fingers on a touch pad: above 1 enlarges.",
            parse: |words| {
                let factor = words.number("the factor", 0.01, 100.0)? as f32;
                over_place(words, move |stage| stage.window.event(Event::Zoom(factor)))
            },
        },
    ],
};

/// The name of a button, if one follows; otherwise the left one.
fn button(words: &mut Words<'_>) -> PointerButton {
    let named = BUTTONS.into_iter().find(|(name, _)| words.keyword(name));
    named.map_or(PointerButton::Primary, |(_, button)| button)
}

/// The pointer buttons by name.
pub(in crate::app::replay) const BUTTONS: [(&str, PointerButton); 5] = [
    ("left", PointerButton::Primary),
    ("right", PointerButton::Secondary),
    ("middle", PointerButton::Middle),
    ("back", PointerButton::Extra1),
    ("forward", PointerButton::Extra2),
];

fn clicks(words: &mut Words<'_>, count: usize) -> Result<Act, String> {
    let button = button(words);
    clicks_with(words, button, count)
}

fn clicks_with(words: &mut Words<'_>, button: PointerButton, count: usize) -> Result<Act, String> {
    let place = Place::take(words)?;
    let modifiers = with(words)?;
    Ok(Box::new(move |stage| {
        let at = place.on_screen(stage)?;
        stage.gestures.click(count, modifiers);
        holding(stage, modifiers, |stage| stage.window.clicks(button, at, count));
        Ok(())
    }))
}

fn drag(words: &mut Words<'_>) -> Result<Act, String> {
    let button = button(words);
    let mut places = vec![Place::take(words)?];
    while words.keyword("via") {
        places.push(Place::take(words)?);
    }
    if !words.keyword("to") {
        return Err(match words.next() {
            Some(word) => format!("to is missing before {}", written(&word.text)),
            None => "to and where to are missing".to_owned(),
        });
    }
    places.push(Place::take(words)?);
    let modifiers = with(words)?;
    Ok(Box::new(move |stage| {
        let mut way: Vec<Pos2> = places.iter().map(|place| place.on_screen(stage)).collect::<Result<_, Fault>>()?;
        if let [from, to] = way[..] {
            // A hand does not jump: code that follows the pointer must see it move.
            way.insert(1, from + (to - from) / 2.0);
        }
        stage.gestures.click(2, modifiers);
        holding(stage, modifiers, |stage| stage.window.drag_along(button, &way));
        Ok(())
    }))
}

fn press(button: PointerButton, pressed: bool) -> Act {
    Box::new(move |stage| {
        stage.gestures.click(1, Modifiers::NONE);
        stage.window.button(button, pressed);
        Ok(())
    })
}

/// An action at a place, or at the pointer's position.
fn over_place(words: &mut Words<'_>, act: impl Fn(&mut Stage<'_>) + Send + Sync + 'static) -> Result<Act, String> {
    let has_place = words.peek().is_some_and(|word| word != "with");
    let place = if has_place { Some(Place::take(words)?) } else { None };
    let modifiers = with(words)?;
    Ok(Box::new(move |stage| {
        if let Some(place) = &place {
            let at = place.on_screen(stage)?;
            stage.window.move_to(at);
        }
        stage.gestures.click(1, modifiers);
        holding(stage, modifiers, &act);
        Ok(())
    }))
}

/// The modifiers after `with`.
fn with(words: &mut Words<'_>) -> Result<Modifiers, String> {
    if words.keyword("with") { modifiers_of(words.text("the modifier keys")?) } else { Ok(Modifiers::NONE) }
}

fn holding(stage: &mut Stage<'_>, modifiers: Modifiers, act: impl Fn(&mut Stage<'_>)) {
    let held = stage.window.modifiers();
    stage.window.hold_modifiers(held.plus(modifiers));
    act(stage);
    stage.window.hold_modifiers(held);
}
