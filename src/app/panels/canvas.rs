//! The canvas among the panels: shows it, and runs the commands for the user's actions there.

use egui::Ui;

use crate::app::canvas::{Act, Beginning, Under, rulers};
use crate::app::commands::{self, CommandError};
use crate::app::paint::places::canvas_id;
use crate::app::state::{App, Thing};
use crate::app::value::{Call, Value};
use crate::base::wording::sentence;
use crate::plan::ElementId;

/// Shows the canvas in the rest of `ui`.
pub(super) fn show(app: &mut App, ui: &mut Ui) {
    let keys = |id: &str| commands::find(id).map(|command| app.keys_text(command, ui.ctx())).unwrap_or_default();
    let beginning = Beginning {
        walls: keys("tool-walls"),
        fill: keys("fill-all"),
        rectangle: keys("tool-rectangle"),
        door: keys("tool-door"),
    };
    let App { session, canvas, tools, .. } = app;
    let mut backdrop = std::mem::take(&mut session.backdrop);
    let act = session
        .document
        .as_ref()
        .and_then(|document| canvas.show(ui, document, session, &mut backdrop, tools, &beginning));
    session.backdrop = backdrop;
    session.pointed = canvas.pointed;
    if let Some((centre, px_per_m)) = canvas.take_moved() {
        let numbers = [centre.x, centre.y, px_per_m];
        session.note_executed("view", numbers.map(|number| number.to_string()).to_vec());
    }
    let help = commands::find("add-guide").map_or("", |command| command.help);
    let guided = rulers::show(canvas, session, help, ui);
    for call in guided {
        app.act_on(call, ui.ctx());
    }
    match act {
        None => {}
        Some(Act::Calls(calls)) => run(app, calls, ui),
        Some(Act::Pick(element)) => app.act_on(Call::new("select", [Value::Elements(vec![element])]), ui.ctx()),
        Some(Act::PickNeighbour(step)) if app.session.pick_neighbour(step) => {
            app.session.note_executed(if step > 0 { "next-room" } else { "previous-room" }, Vec::new());
        }
        Some(Act::PickNeighbour(step)) => {
            let direction = if step > 0 { egui::FocusDirection::Next } else { egui::FocusDirection::Previous };
            ui.memory_mut(|memory| {
                memory.surrender_focus(canvas_id());
                memory.move_focus(direction);
            });
        }
        Some(Act::PickTowards(direction)) => {
            app.act_on(Call::new("pick-towards", [Value::word(direction)]), ui.ctx());
        }
        Some(Act::Rename) if app.session.accepts_by_enter() => drop(app.run_command("accept-prediction", ui.ctx())),
        Some(Act::Rename) => match app.picked() {
            Some(element @ (ElementId::Wall(_) | ElementId::Opening(_))) => app.change_here(element),
            _ => drop(app.run_command("rename", ui.ctx())),
        },
        Some(Act::Nudge(direction, distance_m)) => {
            run(app, vec![Call::new("nudge", [Value::word(direction), Value::Number(distance_m)])], ui);
        }
        Some(Act::Flip) if commands::find("flip").is_some_and(|flip| flip.why_not(app).is_none()) => {
            app.run_command("flip", ui.ctx());
        }
        Some(Act::Flip) => {}
        Some(Act::Menu(under, at)) => {
            let thing = match under {
                Under::Element(element) => Thing::Element(element),
                Under::Guide(axis, at_m) => Thing::Guide(axis, at_m),
                Under::Picture => Thing::Picture,
                Under::Nothing => Thing::Free,
            };
            app.open_context_menu(thing, at, ui.ctx());
        }
    }
}

/// Runs a tool's calls, and tells the tool if the plan rejects them.
fn run(app: &mut App, calls: Vec<Call>, ui: &Ui) {
    for call in calls {
        if let Err(error) = app.run_call(call, ui.ctx()) {
            app.tools.tool_mut().was_refused();
            app.session.status = match error {
                CommandError::NotNow { reason, .. } => sentence(&reason),
                other => other.to_string(),
            };
        }
    }
}
