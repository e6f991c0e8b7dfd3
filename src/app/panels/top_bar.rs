//! The top bar: menus, the plan's title, tools.

use egui::text::{LayoutJob, TextFormat};
use egui::{
    Align, Align2, Color32, Context, FontId, Layout, MenuBar, Response, Role, Sense, Stroke, Ui, UiBuilder, WidgetInfo,
    WidgetText, pos2, vec2,
};

use super::menus;
use crate::app::commands::{COMMANDS, Command, Menu};
use crate::app::look::theme;
use crate::app::look::widgets::{ROW, colours, focus_ring, icon_button, strong};
use crate::app::state::App;

pub(super) fn show(app: &mut App, ui: &mut Ui) {
    let bar = ui.max_rect();
    let mut menus = ui.new_child(UiBuilder::new().max_rect(bar).layout(Layout::left_to_right(Align::Center)));
    let left = MenuBar::new()
        .ui(&mut menus, |ui| {
            ui.spacing_mut().button_padding.x = 8.0;
            ui.spacing_mut().item_spacing.x = 2.0;
            let mut right = bar.left();
            for menu in Menu::ALL {
                let top = bar.bottom();
                let title = menu_title(ui, menu);
                let button = ui.menu_button(title, |ui| menus::menu(app, ui, menu, top)).response;
                menus::remember_button(app, menu, &button);
                focus_ring(ui, button.rect, &button);
                right = button.rect.right();
            }
            right
        })
        .inner;
    // Where the window is narrow, groups of tools give way to the menus, which have all of them.
    let groups = groups_within(bar.right() - left - SPARE);
    let right = bar.right() - tools_width(&groups);
    let place = bar.with_min_x(right);
    let mut tools = ui.new_child(UiBuilder::new().max_rect(place).layout(Layout::left_to_right(Align::Center)));
    tools.spacing_mut().item_spacing.x = SPACE;
    show_tools(app, &mut tools, &groups);
    title(app, ui, left + 16.0, right - 16.0);
}

/// The title of a menu, its letter underlined while Alt is held.
fn menu_title(ui: &Ui, menu: Menu) -> WidgetText {
    let title = menu.title();
    let (letter, _) = menus::letter(menu);
    let Some(at) = title.find(letter).filter(|_| menus::shows_letters(ui)) else { return title.into() };
    let font = FontId::proportional(theme::BODY);
    let plain = TextFormat::simple(font, Color32::PLACEHOLDER);
    let underlined = TextFormat { underline: Stroke::new(1.0, colours(ui).text), ..plain.clone() };
    let mut job = LayoutJob::default();
    let end = at + letter.len_utf8();
    job.append(&title[..at], 0.0, plain.clone());
    job.append(&title[at..end], 0.0, underlined);
    job.append(&title[end..], 0.0, plain);
    job.into()
}

/// Space between two tools, and on both sides of the line between two groups, in points.
const SPACE: f32 = 2.0;
const GROUP_SPACE: f32 = 6.0;

/// What is kept free between the menus and the tools, in points.
const SPARE: f32 = 8.0;

/// The groups of tools in the order in which they give way: the views and layers, which have keys and a panel, before
/// what is undone and the panels themselves.
const GIVE_WAY: [u8; 4] = [1, 2, 0, 3];

/// The groups of tools that fit within a width.
fn groups_within(width: f32) -> Vec<u8> {
    let mut groups: Vec<u8> = COMMANDS.iter().filter_map(|command| command.tool).map(|(_, group)| group).collect();
    groups.dedup();
    for group in GIVE_WAY {
        if tools_width(&groups) <= width {
            break;
        }
        groups.retain(|other| *other != group);
    }
    groups
}

/// The width of the tools of some groups.
fn tools_width(shown: &[u8]) -> f32 {
    let groups: Vec<u8> = COMMANDS
        .iter()
        .filter_map(|command| command.tool)
        .map(|(_, group)| group)
        .filter(|group| shown.contains(group))
        .collect();
    let lines = groups.windows(2).filter(|pair| pair[0] != pair[1]).count();
    let things = groups.len() + lines;
    groups.len() as f32 * ROW + lines as f32 * (2.0 * GROUP_SPACE + 1.0) + things.saturating_sub(1) as f32 * SPACE
}

/// The tools of some groups.
fn show_tools(app: &mut App, ui: &mut Ui, groups: &[u8]) {
    let mut group = None;
    for command in COMMANDS.iter() {
        let Some((icon, this)) = command.tool.filter(|(_, group)| groups.contains(group)) else { continue };
        if group.is_some_and(|group| group != this) {
            ui.add_space(GROUP_SPACE);
            let (rect, _) = ui.allocate_exact_size(vec2(1.0, 18.0), Sense::hover());
            ui.painter().vline(rect.center().x, rect.y_range(), Stroke::new(1.0, colours(ui).outline));
            ui.add_space(GROUP_SPACE);
        }
        group = Some(this);
        let is_on = command.is_on(app);
        let is_available = command.why_not(app).is_none();
        let response = ui.add_enabled_ui(is_available, |ui| icon_button(ui, icon, command.title, is_on)).inner;
        let response = with_tooltip(app, response, ui.ctx(), command);
        if response.clicked() {
            let context = ui.ctx().clone();
            app.run_command(command.id, &context);
        }
    }
}

/// A tooltip with a command's title, shortcut and help, and why it is unavailable.
pub(super) fn with_tooltip(app: &App, response: Response, context: &Context, command: &Command) -> Response {
    let keys = app.keys_text(command, context);
    let why_not = command.why_not(app);
    let show = |ui: &mut Ui| {
        ui.horizontal(|ui| {
            ui.label(strong(command.title, theme::BODY));
            ui.label(egui::RichText::new(&keys).color(colours(ui).text_weak));
        });
        ui.label(command.help);
        if let Some(why_not) = why_not {
            ui.label(egui::RichText::new(format!("Not available: {why_not}")).color(colours(ui).text_weak));
        }
    };
    response.on_hover_ui(show).on_disabled_hover_ui(show)
}

/// The plan's title in the middle of the window, as space permits.
fn title(app: &App, ui: &Ui, left: f32, right: f32) {
    // In less space only a letter or two would show.
    const LEAST_WIDTH: f32 = 80.0;
    let Some(document) = app.session.document.as_ref().filter(|_| right - left >= LEAST_WIDTH) else { return };
    let colours = colours(ui);
    let bar = ui.max_rect();
    let mut text = document.title();
    if document.is_changed() {
        text.insert_str(0, "• ");
    }
    let font = FontId::new(theme::BODY, theme::semibold());
    let mut job = egui::text::LayoutJob::simple_singleline(text.clone(), font, colours.text);
    let meta = document.plan().meta();
    if !meta.storey.is_empty() && !document.title().contains(&meta.storey) {
        let format = egui::TextFormat::simple(FontId::proportional(theme::BODY), colours.text_weak);
        job.append(&meta.storey, 8.0, format);
    }
    job.wrap.max_width = (right - left).max(0.0);
    job.wrap.max_rows = 1;
    job.wrap.break_anywhere = true;
    let galley = ui.painter().layout_job(job);
    let size = galley.rect.size();
    let start = (bar.center().x - size.x / 2.0).max(left).min((right - size.x).max(left));
    let rect = Align2::LEFT_CENTER.anchor_size(pos2(start.round(), bar.center().y.round()), size);
    let is_elided = galley.elided;
    ui.painter().galley(rect.min, galley, colours.text);
    let response = ui.interact(rect, ui.scope_id().with("title"), Sense::hover());
    let name = if document.is_changed() { format!("{}, changed", document.title()) } else { document.title() };
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, &name));
    match document.origin.path() {
        Some(path) => drop(response.on_hover_text(app.session.shown_path(path))),
        None if is_elided => drop(response.on_hover_text(text)),
        None => {}
    }
}
