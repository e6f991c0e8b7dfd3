//! The list of plans: the open ones, those of the folder, and the bundled ones.

use std::path::Path;

use egui::{Rect, Response, Role, ScrollArea, Ui, UiBuilder, pos2};

use crate::app::commands;
use crate::app::look::{
    icons::Icon,
    widgets::{Lead, ROW, Row, icon_button, right, section},
};
use crate::app::session::open_plans::OpenPlan;
use crate::app::session::origin::{Origin, bundled, file_name};
use crate::app::state::{App, Height, Side, SidePanel, Thing, panels};
use crate::app::value::{Call, Value};

/// A row of the list.
enum Entry {
    Title(String),
    Open(OpenPlan),
    Plan { origin: Origin, text: String },
    Storey { origin: Origin, text: String },
}

/// Minimum height in points above the layers: its title and two plans.
const LEAST_HEIGHT: f32 = 110.0;

pub(super) const PANEL: SidePanel = SidePanel {
    id: panels::PLANS,
    title: "Plans",
    help: "The open plans, the plans in the folder, and the samples",
    side: Side::Left,
    height: Height::Rest { least: LEAST_HEIGHT },
    is_shown_at_first: true,
    needs_plan: false,
    has_own_command: true,
    show,
};

fn show(app: &mut App, ui: &mut Ui) {
    let entries = entries(app);
    ui.horizontal(|ui| {
        section(ui, "Plans");
        right(ui, |ui| {
            ui.spacing_mut().item_spacing.x = 0.0;
            if let Some(command) = commands::find("open")
                && icon_button(ui, Icon::Plus, command.title, None).on_hover_text(command.help).clicked()
            {
                let context = ui.ctx().clone();
                app.run_command(command.id, &context);
            }
        });
    });
    let current = app.session.document.as_ref().map(|document| document.origin.clone());
    let (mut wanted, mut asked, mut act) = (None, None, None);
    ui.spacing_mut().item_spacing.y = 0.0;
    ScrollArea::vertical().auto_shrink([false, false]).show_rows(ui, ROW, entries.len(), |ui, range| {
        for entry in &entries[range] {
            match entry {
                Entry::Title(text) => {
                    ui.allocate_ui(egui::vec2(ui.available_width(), ROW), |ui| {
                        ui.set_min_height(ROW);
                        Row::new(Lead::None, text).muted().indent(8.0).show_only(ui);
                    });
                }
                Entry::Open(plan) => {
                    let (response, chosen) = open_row(ui, plan);
                    act = chosen.or(act.take());
                    if let Some(origin) = current.as_ref().filter(|_| plan.is_shown) {
                        asked = asked.take().or(asks(&response, origin));
                    }
                }
                Entry::Plan { origin, text } => {
                    let is_current = current.as_ref().is_some_and(|current| is_same_file(current, origin));
                    let row = Row::new(Lead::Icon(Icon::Plan), text).selected(is_current);
                    let response = row.button(ui, Role::ListBoxOption);
                    asked = asked.take().or(asks(&response, origin));
                    if response.clicked() && current.as_ref() != Some(origin) {
                        wanted = Some(origin.clone());
                    }
                }
                Entry::Storey { origin, text } => {
                    let row = Row::new(Lead::None, text).indent(24.0).selected(current.as_ref() == Some(origin));
                    let response = row.button(ui, Role::ListBoxOption);
                    asked = asked.take().or(asks(&response, origin));
                    if response.clicked() && current.as_ref() != Some(origin) {
                        wanted = Some(origin.clone());
                    }
                }
            }
        }
    });
    let context = ui.ctx().clone();
    if let Some((origin, at)) = asked {
        app.open_context_menu(Thing::Listed(origin), at, &context);
    }
    if let Some(origin) = wanted {
        app.open_listed(&origin, &context);
    }
    if let Some((id, number)) = act {
        app.act_on(Call::new(id, [Value::OpenPlan(number)]), &context);
    }
}

/// A row of an open plan: shows it, or closes it. Unsaved changes are marked.
fn open_row(ui: &mut Ui, plan: &OpenPlan) -> (Response, Option<(&'static str, u64)>) {
    let text = if plan.is_changed { format!("• {}", plan.title) } else { plan.title.clone() };
    let row = Row::new(Lead::Icon(Icon::Plan), &text).selected(plan.is_shown).inset_end(ROW - 8.0);
    let response = row.button(ui, Role::ListBoxOption);
    let place = Rect::from_min_max(pos2(response.rect.right() - ROW, response.rect.top()), response.rect.max);
    let mut end = ui.new_child(UiBuilder::new().max_rect(place).id_salt(("close", plan.number)));
    let name = format!("Close {}", plan.title);
    if icon_button(&mut end, Icon::Close, &name, None).on_hover_text("Close this plan").clicked() {
        return (response, Some(("close", plan.number)));
    }
    let shows = (response.clicked() && !plan.is_shown).then_some(("show-plan", plan.number));
    (response, shows)
}

/// The plan of a row whose menu is asked for, and where.
fn asks(row: &Response, origin: &Origin) -> Option<(Origin, egui::Pos2)> {
    let at = row.interact_pointer_pos().unwrap_or(row.rect.center());
    row.secondary_clicked().then(|| (origin.clone(), at))
}

fn entries(app: &App) -> Vec<Entry> {
    let mut entries = Vec::new();
    let document = app.session.document.as_ref();
    let open = app.session.open_plans();
    if !open.is_empty() {
        entries.push(Entry::Title("Open".to_owned()));
    }
    entries.extend(open.into_iter().map(Entry::Open));
    if let Some(folder) = &app.session.list.folder
        && !app.session.list.files.is_empty()
    {
        entries.push(Entry::Title(folder_name(folder)));
        for path in &app.session.list.files {
            let origin = Origin::File { path: path.clone(), storey: 0 };
            let open = document.filter(|document| document.origin.path() == Some(path) && document.storeys.len() > 1);
            // Of plans in folders below, the way there as well.
            let within = path.strip_prefix(folder).map_or_else(|_| file_name(path), |way| way.display().to_string());
            entries.push(Entry::Plan { text: within, origin });
            for (storey, plan) in open.iter().flat_map(|document| document.storeys.iter().enumerate()) {
                let name = if plan.meta().storey.is_empty() { &plan.meta().name } else { &plan.meta().storey };
                let text = if name.is_empty() { format!("Plan {}", storey + 1) } else { name.clone() };
                entries.push(Entry::Storey { origin: Origin::File { path: path.clone(), storey }, text });
            }
        }
    }
    if !bundled().is_empty() {
        entries.push(Entry::Title("Samples".to_owned()));
    }
    for (index, (_, plan)) in bundled().iter().enumerate() {
        entries.push(Entry::Plan { origin: Origin::Bundled(index), text: plan.meta().name.clone() });
    }
    entries
}

fn is_same_file(p: &Origin, q: &Origin) -> bool {
    match (p, q) {
        (Origin::Bundled(p), Origin::Bundled(q)) => p == q,
        _ => p.path().is_some() && p.path() == q.path(),
    }
}

fn folder_name(folder: &Path) -> String {
    if folder.as_os_str().is_empty() { "This folder".to_owned() } else { file_name(folder) }
}
