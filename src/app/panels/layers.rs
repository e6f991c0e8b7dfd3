//! The visible layers of the plan, and the legend of its colours.

use egui::{Role, ScrollArea, Ui};

use crate::app::commands::{self, COMMANDS, Menu};
use crate::app::look::{
    theme,
    widgets::{Lead, ROW, Row, Segment, caption, hairline, section, segmented},
};
use crate::app::session::document::Document;
use crate::app::state::{App, Height, Side, SidePanel, panels};
use crate::base::wording::{sentence, thousands};
use crate::draw::{self, Fill};
use crate::features::RoomStatus;
use crate::labels::Label;

/// The section of the view menu with the layers.
const LAYERS: (Menu, u8) = (Menu::View, 2);

/// Layers listed only if the plan has them.
const RARE: [&str; 2] = ["guides", "ghost-layer"];

/// Initial height in points.
const USUAL_HEIGHT: f32 = 360.0;

pub(super) const PANEL: SidePanel = SidePanel {
    id: panels::LAYERS,
    title: "Layers",
    help: "What the plan shows, and what its colours mean",
    side: Side::Left,
    height: Height::Content { usual: USUAL_HEIGHT },
    is_shown_at_first: true,
    needs_plan: false,
    has_own_command: true,
    show,
};

fn show(app: &mut App, ui: &mut Ui) {
    hairline(ui);
    section(ui, "Fill");
    let fills = [
        ("fill-label", "Label"),
        ("fill-function", "Function"),
        ("fill-prediction", "Predicted"),
        ("fill-none", "None"),
    ];
    let segments: Vec<Segment<'_>> = fills
        .into_iter()
        .filter_map(|(id, text)| {
            let command = commands::find(id)?;
            let is_on = command.is_on(app) == Some(true);
            Some(Segment { text, name: command.title, help: command.help, is_on, colour: None })
        })
        .collect();
    let context = ui.ctx().clone();
    if let Some(index) = segmented(ui, &segments) {
        app.run_command(fills[index].0, &context);
    }
    if let Some(document) = &app.session.document {
        legend(ui, app, document);
    }
    hairline(ui);
    section(ui, "Layers");
    ui.add_space(2.0);
    ui.spacing_mut().item_spacing.y = 0.0;
    for command in COMMANDS.iter().filter(|command| command.menu == Some(LAYERS)) {
        let is_on = command.is_on(app) == Some(true);
        let shortcut = app.keys_text(command, &context);
        let is_available = command.why_not(app).is_none();
        // Layers that most plans lack take no space in the list.
        if !is_available && RARE.contains(&command.id) {
            continue;
        }
        let row = Row::new(Lead::Eye(is_on), command.title).trail(&shortcut).on(is_on);
        let response = ui.add_enabled_ui(is_available, |ui| row.button(ui, Role::CheckBox)).inner;
        if response.on_hover_text(command.help).clicked() {
            app.run_command(command.id, &context);
        }
    }
}

/// The legend: each colour's meaning, and the number of rooms.
fn legend(ui: &mut Ui, app: &App, document: &Document) {
    // While the plan is analysed after an edit, the rows stay where they are, without numbers.
    let Some((derived, is_fresh)) = document.derived_or_last() else { return };
    let (fill, palette) = (app.session.layers.fill, app.session.palette(ui));
    // Colour, name, number, and what the name means.
    let mut rows: Vec<(draw::Rgba, String, usize, String)> = Vec::new();
    let mut note = None;
    match fill {
        Fill::None => {}
        Fill::Label | Fill::Prediction => {
            let is_predicted = fill == Fill::Prediction;
            let (labelled, unlabelled, not_classified) =
                if is_predicted { derived.drawing.predicted_counts() } else { derived.drawing.counts() };
            for label in Label::ALL {
                let name = sentence(label.name());
                let about = app.session.schemes.about(label, document.plan().meta().typology.as_ref(), app.units());
                rows.push((palette.label(label), name, labelled[label.index()], about));
            }
            let unlabelled_name = if is_predicted { "No prediction" } else { "No label" };
            let without = "Set a function that the label scheme knows, or a label, or accept the prediction.";
            let outside =
                "The label scheme leaves these rooms out, such as balconies and shafts: they count as outside.";
            let others = [
                (RoomStatus::Unlabelled, unlabelled_name, unlabelled, without),
                (RoomStatus::NotClassified, "Not classified", not_classified, outside),
            ];
            for (status, name, number, about) in others.into_iter().filter(|(_, _, number, _)| *number > 0) {
                rows.push((palette.status(status), name.to_owned(), number, about.to_owned()));
            }
            note = (is_predicted && is_fresh && derived.drawing.missed() > 0)
                .then(|| format!("{} with another known label, hatched in its colour", derived.drawing.missed()));
        }
        Fill::Function => {
            let number = |function: &str| derived.functions.get(function).copied().unwrap_or_default();
            for (function, colour) in derived.drawing.function_colours(palette) {
                rows.push((colour, sentence(&function), number(&function), String::new()));
            }
            if number("") > 0 {
                rows.push((palette.unlabelled, "No function".to_owned(), number(""), String::new()));
            }
        }
    }
    ui.spacing_mut().item_spacing.y = 0.0;
    ui.add_space(6.0);
    // A long legend leaves space for the list of plans.
    let most = (ui.ctx().content_rect().height() * 0.25).max(4.0 * ROW);
    let height = (rows.len() as f32 * 22.0).min(most);
    // As high as necessary, however high the panel was before.
    let area = ScrollArea::vertical().id_salt("legend").min_scrolled_height(height).max_height(height);
    area.auto_shrink([false, true]).show(ui, |ui| {
        for (colour, name, number, about) in &rows {
            let trail = match number {
                _ if !is_fresh => "…".to_owned(),
                0 => "–".to_owned(),
                number => thousands(*number as u64),
            };
            let row = Row::new(Lead::Swatch(theme::colour(*colour)), name).trail(&trail).indent(8.0).inset(8.0);
            let response = row.show_only(ui);
            if !about.is_empty() {
                response.on_hover_text(about);
            }
        }
    });
    if let Some(note) = note {
        caption(ui, note);
    }
}
