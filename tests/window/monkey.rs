//! Random input: nothing panics, the window settles, and the plan keeps its invariants.

use egui::{Event, Key, Modifiers, MouseWheelSource, MouseWheelUnit, PointerButton, TouchPhase, pos2, vec2};
use enfilade::app::commands::COMMANDS;
use enfilade::app::{Offscreen, OffscreenOptions};
use proptest::prelude::*;

#[derive(Clone, Debug)]
enum Deed {
    Command(usize),
    Move(f32, f32),
    Button(u8, bool),
    Wheel(f32, f32, bool),
    Pinch(f32),
    Key(usize, u8),
    Text(String),
    Resize(u32, u32),
    Close,
    Settle,
}

const KEYS: [Key; 14] = [
    Key::Tab,
    Key::Enter,
    Key::Escape,
    Key::Space,
    Key::ArrowLeft,
    Key::ArrowDown,
    Key::F2,
    Key::Z,
    Key::Y,
    Key::A,
    Key::S,
    Key::Delete,
    Key::PageDown,
    Key::CloseBracket,
];

fn deed() -> impl Strategy<Value = Deed> {
    prop_oneof![
        3 => (0..COMMANDS.len()).prop_map(Deed::Command),
        4 => (-50.0f32..1400.0, -50.0f32..900.0).prop_map(|(x, y)| Deed::Move(x, y)),
        4 => (0u8..3, any::<bool>()).prop_map(|(button, pressed)| Deed::Button(button, pressed)),
        2 => (-30.0f32..30.0, -30.0f32..30.0, any::<bool>()).prop_map(|(x, y, lines)| Deed::Wheel(x, y, lines)),
        1 => (0.01f32..100.0).prop_map(Deed::Pinch),
        4 => (0..KEYS.len(), 0u8..8).prop_map(|(key, modifiers)| Deed::Key(key, modifiers)),
        2 => "\\PC{0,12}".prop_map(Deed::Text),
        1 => (1u32..2000, 1u32..1200).prop_map(|(width, height)| Deed::Resize(width, height)),
        1 => Just(Deed::Close),
        2 => Just(Deed::Settle),
    ]
}

fn modifiers(bits: u8) -> Modifiers {
    let on = |bit: u8| bits & bit != 0;
    Modifiers { ctrl: on(1), command: on(1), shift: on(2), alt: on(4), mac_cmd: false }
}

fn perform(window: &mut Offscreen, deed: &Deed) {
    match deed {
        Deed::Command(index) => {
            window.run_command(COMMANDS[*index].id);
        }
        Deed::Move(x, y) => window.move_to(pos2(*x, *y)),
        Deed::Button(button, pressed) => {
            let button =
                [PointerButton::Primary, PointerButton::Middle, PointerButton::Secondary][usize::from(*button)];
            window.button(button, *pressed);
        }
        Deed::Wheel(x, y, lines) => window.event(Event::MouseWheel {
            unit: if *lines { MouseWheelUnit::Line } else { MouseWheelUnit::Point },
            delta: vec2(*x, *y),
            phase: TouchPhase::Move,
            source: MouseWheelSource::Unknown,
            modifiers: Modifiers::NONE,
        }),
        Deed::Pinch(factor) => window.event(Event::Zoom(*factor)),
        Deed::Key(key, bits) => window.key(modifiers(*bits), KEYS[*key]),
        Deed::Text(text) => window.text(text),
        Deed::Resize(width, height) => window.resize(*width, *height),
        Deed::Close => window.ask_to_close(),
        Deed::Settle => window.settle().expect("the window comes to rest"),
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, ..ProptestConfig::default() })]

    #[test]
    fn any_input_does_no_harm(plan in 0usize..4, deeds in prop::collection::vec(deed(), 1..60)) {
        let mut window = Offscreen::new(OffscreenOptions::default());
        if let Some(stem) = ["office", "school", "dwelling"].get(plan) {
            window.open_bundled(stem);
        }
        for deed in &deeds {
            perform(&mut window, deed);
            if let Some(plan) = window.app().plan() {
                prop_assert_eq!(plan.violations(), Vec::new(), "after {:?}", deed);
            }
        }
        window.settle().expect("the window comes to rest");
        window.picture();
    }
}
