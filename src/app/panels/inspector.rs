//! What is known of what is picked: a room, an opening, or the plan as a whole.

mod opening;
mod proposals;
mod room;
mod wall;

use std::cell::Cell;
use std::ops::RangeInclusive;

use egui::{Id, Key, Popup, PopupCloseBehavior, RichText, Role, ScrollArea, Sense, TextEdit, Ui, WidgetInfo, vec2};

use super::picture::{self, PictureAct};
use super::prediction;
use crate::app::commands;
use crate::app::look::{
    icons::Icon,
    length_field::LengthField,
    theme,
    widgets::{
        Lead, ROW, Row, Segment, caption, colours, follow_focus, hairline, link, section, segmented, strong,
        text_button, value,
    },
};
use crate::app::session::document::{Derived, Document};
use crate::app::session::fields::{Field, FieldKind};
use crate::app::session::kept::InCommon;
use crate::app::state::{App, Height, Side, SidePanel, panels};
use crate::base::{
    units::Units,
    wording::{count, sentence, thousands},
};
use crate::draw::Palette;
use crate::features::{Features, RoomAnalysis, RoomStatus};
use crate::geometry::{Point, trim_m};
use crate::labels::{Label, Meaning, normalised_function};
use crate::plan::{
    ElementId, Joint, LabelOrigin, Opening, OpeningId, OpeningKind, Place, Plan, Room, RoomId, ScaleOrigin,
    titles::{room_title, title_of},
};
use crate::predict::Marks;
use crate::topology::RoomShape;

/// A user action in the inspector.
enum Act {
    Pick(ElementId),
    Label(Option<Label>),
    Type(Field),
    /// What was written last, if anything, and all before it, is taken.
    Commit(Option<Field>),
    Revert,
    ShowNotes,
    Command(&'static str),
    /// A command with its arguments.
    Choose(&'static str, Vec<String>),
    Picture(PictureAct),
    /// One after the other: a field is left and the next one written in, in one frame.
    All(Vec<Act>),
}

impl Act {
    /// Both, what is taken before what is typed.
    fn both(one: Option<Self>, other: Option<Self>) -> Option<Self> {
        let acts = one.into_iter().chain(other).flat_map(|act| match act {
            Self::All(acts) => acts,
            act => vec![act],
        });
        let mut acts: Vec<Self> = acts.collect();
        acts.sort_by_key(|act| matches!(act, Self::Type(_)));
        if acts.len() > 1 { Some(Self::All(acts)) } else { acts.pop() }
    }

    fn of(asked: prediction::Asked) -> Self {
        match asked {
            (id, Some(word)) => Self::Choose(id, vec![word]),
            (id, None) => Self::Command(id),
        }
    }
}

/// Minimum height in points above the history.
const LEAST_HEIGHT: f32 = 160.0;

pub(super) const PANEL: SidePanel = SidePanel {
    id: panels::INSPECTOR,
    title: "Inspector",
    help: "The properties of the selection",
    side: Side::Right,
    height: Height::Rest { least: LEAST_HEIGHT },
    is_shown_at_first: true,
    needs_plan: true,
    has_own_command: true,
    show,
};

fn show(app: &mut App, ui: &mut Ui) {
    let mut act = None;
    let mut hovered = None;
    let mut evidence = None;
    let marked = Cell::new(None);
    ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| {
        let margin = egui::Margin { left: 16, right: 16, top: 14, bottom: 16 };
        egui::Frame::new().inner_margin(margin).show(ui, |ui| {
            ui.spacing_mut().item_spacing.y = 4.0;
            let Some(document) = &app.session.document else { return };
            let palette = app.session.palette(ui);
            let inspected = Inspected { app, document, plan: document.plan(), palette, marked: &marked };
            act = match app.picked() {
                Some(ElementId::Room(id)) => {
                    document.plan().room(id).and_then(|room| inspected.room(ui, id, room, &mut hovered, &mut evidence))
                }
                Some(ElementId::Opening(id)) => {
                    document.plan().opening(id).and_then(|opening| inspected.opening(ui, id, opening, &mut hovered))
                }
                Some(ElementId::Wall(id)) => document.plan().wall(id).and_then(|wall| inspected.wall(ui, id, wall)),
                Some(ElementId::Corner(id)) => inspected.corner(ui, id),
                Some(ElementId::Dimension(_)) => inspected.several(ui),
                None if app.selection().is_empty() => inspected.plan(ui),
                None => inspected.several(ui),
            };
        });
    });
    app.canvas.hovered_in_panel = hovered;
    app.canvas.evidence = evidence;
    app.canvas.marked_in_panel = marked.get();
    app.panels.focus = None;
    if let Some(act) = act {
        perform(app, ui, act);
    }
}

fn perform(app: &mut App, ui: &Ui, act: Act) {
    match act {
        Act::All(acts) => acts.into_iter().for_each(|act| perform(app, ui, act)),
        Act::Pick(ElementId::Room(room)) => {
            let word = app.plan().map(|plan| commands::room_word(plan, room)).unwrap_or_default();
            app.act("find-room", &[&word], ui.ctx());
        }
        Act::Pick(ElementId::Wall(_) | ElementId::Corner(_) | ElementId::Dimension(_)) => {}
        Act::Pick(ElementId::Opening(opening)) => app.act("pick-opening", &[&opening.to_string(), "on"], ui.ctx()),
        Act::Label(label) => {
            let id = label.map_or("label-by-function", |label| LABEL_COMMANDS[label.index()]);
            app.act(id, &[], ui.ctx());
        }
        Act::Type(field) => app.session.field = Some(field),
        Act::Commit(written) => {
            app.session.field = written.or(app.session.field.take());
            app.session.commit_field();
        }
        Act::Revert => drop(app.session.field.take()),
        Act::Picture(PictureAct::Opacity(opacity)) => app.session.backdrop.opacity = Some(opacity),
        Act::Picture(PictureAct::Command(id, arguments)) => {
            app.session.backdrop.opacity = None;
            let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
            app.act(id, &arguments, ui.ctx());
        }
        Act::Command(id) => app.act(id, &[], ui.ctx()),
        Act::Choose(id, words) => {
            let words: Vec<&str> = words.iter().map(String::as_str).collect();
            app.act(id, &words, ui.ctx());
        }
        Act::ShowNotes => app.act("import-notes", &["on"], ui.ctx()),
    }
}

/// The command that gives each label, in the labels' order.
const LABEL_COMMANDS: [&str; 5] = ["label-small", "label-medium", "label-big", "label-corridor", "label-hall"];

struct Inspected<'a> {
    app: &'a App,
    document: &'a Document,
    plan: &'a Plan,
    palette: &'static Palette,
    /// The place on the plan that a field is about.
    marked: &'a Cell<Option<Point>>,
}

impl Inspected<'_> {
    // A room.

    // Several elements.

    fn several(&self, ui: &mut Ui) -> Option<Act> {
        let common = self.app.session.in_common();
        let counts = [
            (common.rooms, "room"),
            (common.walls, "wall"),
            (common.openings, "opening"),
            (common.corners, "corner"),
            (common.dimensions, "dimension"),
        ];
        let said: Vec<String> =
            counts.iter().filter(|(number, _)| *number > 0).map(|(number, thing)| count(*number, thing)).collect();
        header(ui, None, None, &said.join(", "), "Selected");
        ui.add_space(6.0);
        let mut act = None;
        if common.rooms > 0 {
            act = self.label_segments(ui, common.label).map(|label| Act::Label(Some(label)));
            ui.horizontal(|ui| {
                ui.spacing_mut().item_spacing.x = 12.0;
                for (text, id) in [("Set function", "set-function"), ("Name", "name-rooms"), ("Change", "change-rooms")]
                {
                    if link(ui, text).clicked() {
                        act = Some(Act::Command(id));
                    }
                }
            });
            ui.add_space(4.0);
        }
        act = act.or_else(|| self.walls(ui, &common));
        act = act.or_else(|| self.openings(ui, &common));
        let together = self.document.derived().and_then(|derived| self.app.session.rooms_together(derived));
        if let Some(together) = together {
            value(ui, "Clear area together", &self.app.units().area(together.clear_m2));
        }
        act
    }

    /// A length of what is selected, which a command with this and more arguments changes.
    fn length(
        &self,
        ui: &mut Ui,
        name: &str,
        now_m: f64,
        range_m: RangeInclusive<f64>,
        command: &'static str,
        more: &[&str],
    ) -> Option<Act> {
        // What stands in the field is in line with the values below and above.
        let name_width = Some(name_width(ui) - 10.0);
        let field =
            LengthField { name, now_m: trim_m(now_m), range_m, units: self.app.units(), width: 100.0, name_width };
        // Of another wall or door, what was begun is forgotten.
        let entered = ui.push_id(self.app.selection().elements(), |ui| ui.horizontal(|ui| field.show(ui)).inner).inner;
        if !entered.refused.is_empty() {
            ui.label(RichText::new(&entered.refused).size(theme::SMALL).color(colours(ui).error));
        }
        let words = |length_m: f64| {
            std::iter::once(format!("{length_m}m")).chain(more.iter().map(|word| (*word).to_owned())).collect()
        };
        entered.length_m.map(|length_m| Act::Choose(command, words(length_m)))
    }

    /// One of a few alternatives of what is selected, which a command chooses: each with its word and its name.
    fn choice(
        &self,
        ui: &mut Ui,
        name: &str,
        now: &str,
        choices: &[(&str, String)],
        command: &'static str,
    ) -> Option<Act> {
        let shown: Vec<String> = choices.iter().map(|(_, title)| format!("{name}: {title}")).collect();
        let segments: Vec<Segment<'_>> = choices
            .iter()
            .zip(&shown)
            .map(|((word, title), name)| Segment { text: title, name, help: name, is_on: now == *word, colour: None })
            .collect();
        let chosen = ui.horizontal(|ui| {
            let (rect, _) = ui.allocate_exact_size(vec2(name_width(ui) - 10.0, ROW), Sense::hover());
            let font = egui::FontId::proportional(theme::BODY);
            ui.painter().text(rect.left_center(), egui::Align2::LEFT_CENTER, name, font, colours(ui).text_weak);
            segmented(ui, &segments)
        });
        chosen
            .inner
            .and_then(|index| choices.get(index))
            .map(|(word, _)| Act::Choose(command, vec![(*word).to_owned()]))
    }

    // The plan.

    fn plan(&self, ui: &mut Ui) -> Option<Act> {
        let meta = self.plan.meta();
        let typology = meta.typology.as_ref().map_or("Typology unknown".to_owned(), crate::labels::Typology::title);
        header(ui, None, Some(Icon::Plan), &self.document.title(), &typology);
        ui.add_space(6.0);
        let chosen = self.typology_choice(ui);
        let mut row = |name: &str, text: &str| {
            if !text.is_empty() {
                value(ui, name, text);
            }
        };
        row("Building", &meta.building);
        row("Storey", &meta.storey);
        row("Source", &meta.source);
        row("Licence", &meta.licence);
        let scale = match meta.scale.origin {
            ScaleOrigin::Unknown => "Unknown".to_owned(),
            origin => sentence(origin.name()),
        };
        let response = value(ui, "Scale", &scale);
        if !meta.scale.note.is_empty() {
            drop(response);
            caption(ui, &meta.scale.note);
        }
        let mut act = chosen;
        if let Some(backdrop) = self.plan.backdrop() {
            hairline(ui);
            act = act.or(picture::show(ui, self.app, backdrop).map(Act::Picture));
        }
        hairline(ui);
        section(ui, "Contents");
        let contents = self.app.session.contents();
        value(ui, "Rooms", &thousands(self.plan.rooms().len() as u64));
        value(ui, "Openings", &thousands(contents.passable as u64));
        value(ui, "Windows", &thousands(contents.windows as u64));
        if let Some((derived, is_fresh)) = self.document.derived_or_last() {
            // While the plan is analysed after an edit, what was known stays where it is, faint.
            let of_derived = |ui: &mut Ui| {
                let areas = self.app.session.areas(derived);
                value(ui, "Clear area", &self.app.units().area(areas.clear_m2)).on_hover_text(CLEAR);
                value(ui, "Along axes", &self.app.units().area(areas.along_m2)).on_hover_text(ALONG);
                self.gaps(ui, derived);
                let predictions = derived.predictions.as_ref().filter(|it| !it.network.rooms.is_empty())?;
                hairline(ui);
                prediction::of_plan(ui, self.app, predictions).map(Act::of)
            };
            act = act.or(ui.add_enabled_ui(is_fresh, of_derived).inner);
        }
        if !self.document.notes.is_empty() {
            hairline(ui);
            section(ui, "Import");
            caption(ui, crate::app::session::origin::notes_in_words(&self.document.notes));
            if link(ui, "Show notes").clicked() {
                act = Some(Act::ShowNotes);
            }
        }
        ui.add_space(10.0);
        caption(ui, "Click a room or a door to see its properties.");
        act
    }

    /// What is missing until every room has a label.
    fn gaps(&self, ui: &mut Ui, derived: &Derived) {
        let unlabelled = derived.analysis.rooms.iter().filter(|room| room.status == RoomStatus::Unlabelled);
        let mut unknown = std::collections::BTreeSet::new();
        let mut number = 0;
        for room in unlabelled {
            number += 1;
            let function = self.plan.room(room.id).map(|room| room.function.trim()).unwrap_or_default();
            if !function.is_empty() {
                unknown.insert(function);
            }
        }
        if number == 0 {
            return;
        }
        value(ui, "Without label", &count(number, "room"));
        if !unknown.is_empty() {
            let list: Vec<&str> = unknown.into_iter().collect();
            caption(ui, format!("The label scheme does not know: {}", list.join(", ")));
        }
    }
}

/// The width of the names on the left, in points: that of [`value`].
fn name_width(ui: &Ui) -> f32 {
    (ui.available_width() * 0.42).min(110.0)
}

/// An event in the list of suggestions.
enum Suggested {
    /// The pointer is pressed on it.
    Choosing,
    Chosen(String),
}

/// Lets rows extend outwards by their padding, so that their text lines up with the rest.
fn unindented(ui: &mut Ui, contents: impl FnOnce(&mut Ui)) {
    let margin = egui::Margin { left: -8, right: -8, top: 0, bottom: 0 };
    egui::Frame::new().outer_margin(margin).show(ui, contents);
}

/// A title with something coloured or drawn beside it.
fn header(
    ui: &mut Ui,
    tile: Option<(egui::Color32, &str, egui::Color32)>,
    icon: Option<Icon>,
    title: &str,
    subtitle: &str,
) {
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 12.0;
        let (rect, _) = ui.allocate_exact_size(vec2(36.0, 36.0), Sense::hover());
        let (ground, ink) = match tile {
            Some((ground, _, ink)) => (ground, ink),
            None => (colours(ui).field, colours(ui).text),
        };
        ui.painter().rect_filled(rect, 8.0, ground);
        let rim = egui::Stroke::new(1.0, colours(ui).text.gamma_multiply(0.12));
        ui.painter().rect_stroke(rect, 8.0, rim, egui::epaint::StrokeKind::Inside);
        if let Some((_, letter, _)) = tile {
            let font = egui::FontId::new(theme::TITLE, theme::semibold());
            ui.painter().text(rect.center(), egui::Align2::CENTER_CENTER, letter, font, ink);
        }
        if let Some(icon) = icon {
            icon.paint(ui.painter(), egui::Rect::from_center_size(rect.center(), vec2(18.0, 18.0)), ink);
        }
        ui.vertical(|ui| {
            ui.spacing_mut().item_spacing.y = 1.0;
            let title = strong(title, theme::TITLE).color(colours(ui).text);
            ui.add(egui::Label::new(title).truncate());
            let subtitle = RichText::new(subtitle).color(colours(ui).text_weak);
            ui.add(egui::Label::new(subtitle).truncate());
        });
    });
}

/// What a clear area is.
const CLEAR: &str = "Between wall faces, without piers and other walls inside: the net floor area";

/// What the other one is.
const ALONG: &str = "Within the boundary: to the axes of the walls, or as drawn or imported";

/// `F_r` with readable names.
fn features(ui: &mut Ui, analysed: &RoomAnalysis, perimeter_m: Option<f64>, units: Units) {
    let Some(features) = &analysed.features else {
        let why = if analysed.status == RoomStatus::NotClassified {
            "None: the label scheme leaves this room out, so it counts as outside."
        } else {
            "The room encloses no area."
        };
        caption(ui, why);
        return;
    };
    ui.spacing_mut().item_spacing.y = 0.0;
    let axes = analysed.axes.map(|axes| {
        let extent = if axes.minor_is_extent { " (extent: no wall is perpendicular)" } else { "" };
        let [major, minor] = [axes.major_m, axes.minor_m].map(|length_m| units.length(length_m));
        format!("Longest wall {major}, longest wall perpendicular to it {minor}{extent}")
    });
    let names = Features::NAMES;
    let around = perimeter_m.map(|perimeter_m| format!("{ALONG}. Perimeter {}", units.length(perimeter_m)));
    feature(ui, "Area along axes", names[0], &units.area(features.area_m2), false, around.as_deref());
    feature(ui, "Axes ratio", names[1], &format!("{:.2}", features.axes_ratio), false, axes.as_deref());
    feature(ui, "Openings", names[2], &features.doors.to_string(), features.doors == 0, None);
    for label in Label::ALL {
        let number = features.doors_to(label);
        let name = format!("to {}s", label.name());
        feature(ui, &name, names[3 + label.index()], &number.to_string(), number == 0, None);
    }
    if let Some(temporary) = analysed.temporary {
        ui.add_space(4.0);
        caption(ui, format!("From area, ratio and openings alone: {temporary}"))
            .on_hover_text("The temporary label that counts for its neighbours while the room has no label");
    }
}

fn feature(ui: &mut Ui, name: &str, symbol: &str, number: &str, is_zero: bool, help: Option<&str>) {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), 22.0), Sense::hover());
    let colours = colours(ui);
    let colour = if is_zero { colours.text_weak } else { colours.text };
    let body = egui::FontId::proportional(theme::BODY);
    let middle = rect.center().y;
    let painter = ui.painter();
    painter.text(rect.left_center(), egui::Align2::LEFT_CENTER, name, body.clone(), colour);
    // The symbol with its index as a subscript, as in the paper.
    let (letter, index) = symbol.split_once('_').unwrap_or((symbol, ""));
    let small = egui::FontId::proportional(theme::SMALL);
    let at = egui::pos2(rect.left() + 142.0, middle);
    let drawn = painter.text(at, egui::Align2::LEFT_CENTER, letter, small, colours.text_weak);
    let tiny = egui::FontId::proportional(9.0);
    painter.text(drawn.right_center() + vec2(1.0, 3.0), egui::Align2::LEFT_CENTER, index, tiny, colours.text_weak);
    let font = if is_zero { body } else { egui::FontId::new(theme::BODY, theme::semibold()) };
    painter.text(rect.right_center(), egui::Align2::RIGHT_CENTER, number, font, colour);
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, format!("{name}: {number}")));
    if let Some(help) = help {
        response.on_hover_text(help);
    }
}

pub(super) fn opening_icon(kind: OpeningKind) -> Icon {
    match kind {
        OpeningKind::Door => Icon::Door,
        OpeningKind::DoubleDoor => Icon::DoubleDoor,
        OpeningKind::Passage => Icon::Passage,
        OpeningKind::Window => Icon::Window,
    }
}
