//! The editor of label schemes: which function of a room means which label, in each typology.

use std::collections::{BTreeMap, BTreeSet};

use egui::{FontId, Role, ScrollArea, Sense, Ui, vec2};

use super::forms;
use super::forms::text;
use crate::app::look::search::Search;
use crate::app::look::theme;
use crate::app::look::widgets::{
    Lead, ROW, Row, Segment, caption, colours, main_button, put_line, right, section, segmented, strong, text_button,
};
use crate::app::state::{After, App, Dialog, Entry, dialogs};
use crate::app::value::{Call, Value};
use crate::base::wording::{count, sentence};
use crate::draw::Palette;
use crate::labels::scheme_file::{Changes, changes_words};
use crate::labels::{Colour, Label, Meaning, Typology, normalised_function};

pub(super) const ENTRY: Entry =
    Entry { id: dialogs::SCHEMES, make: |app, _| Box::new(Schemes::new(app)), is_of_plan: false };

/// The largest size of the dialog, in points.
const LARGEST: [f32; 2] = [860.0, 680.0];

/// Width of the list of typologies.
const LIST: f32 = 216.0;

struct Schemes {
    typology: Option<Typology>,
    /// Typologies that were added here.
    added: BTreeSet<Typology>,
    /// Changes that are not saved yet, by typology.
    changes: BTreeMap<Typology, Changes>,
    search: String,
    new_typology: String,
    is_shown: bool,
}

impl Schemes {
    fn new(app: &App) -> Self {
        let of_plan = app.plan().and_then(|plan| plan.meta().typology.clone());
        let typology = of_plan.or_else(|| app.session.schemes.typologies().next().cloned());
        Self {
            typology,
            added: BTreeSet::new(),
            changes: BTreeMap::new(),
            search: String::new(),
            new_typology: String::new(),
            is_shown: false,
        }
    }
}

enum End {
    Leave,
    Save,
}

impl Dialog for Schemes {
    fn show(&mut self, app: &mut App, ui: &mut Ui) -> After {
        if app.session.question.is_some() {
            return After::Close;
        }
        if !self.is_shown {
            self.is_shown = true;
            let source = app.session.usual_source();
            app.session.read_rooms(source, true);
        }
        let response = forms::large_dialog(ui, "schemes", LARGEST, |ui| self.contents(app, ui));
        // A click beside the dialog, or Escape, must not throw changes away.
        let is_closed = response.should_close() && self.changes.is_empty();
        match response.inner.or(is_closed.then_some(End::Leave)) {
            None => After::Stay,
            Some(End::Leave) => After::Close,
            Some(End::Save) => {
                for (typology, changes) in std::mem::take(&mut self.changes) {
                    let values = [Value::Text(typology.as_str().to_owned()), Value::Text(changes_words(&changes))];
                    app.act_on(Call::new("save-scheme", values), ui.ctx());
                }
                After::Close
            }
        }
    }
}

impl Schemes {
    fn contents(&mut self, app: &App, ui: &mut Ui) -> Option<End> {
        ui.label(strong("Label schemes", theme::TITLE));
        ui.add_space(2.0);
        caption(
            ui,
            "A scheme says which label a room gets by its function. Your changes are kept in your own scheme file; the \
             schemes that come with Enfilade stay as they are.",
        );
        ui.add_space(8.0);
        let foot = 66.0;
        let height = (ui.available_height() - foot).max(120.0);
        ui.horizontal_top(|ui| {
            ui.allocate_ui(vec2(LIST, height), |ui| ui.vertical(|ui| self.typologies(app, ui, height)));
            ui.add_space(8.0);
            ui.vertical(|ui| {
                ui.set_height(height);
                if let Some(typology) = self.typology.clone() {
                    self.functions(app, ui, &typology);
                }
            });
        });
        ui.add_space(6.0);
        self.foot(app, ui)
    }

    fn typologies(&mut self, app: &App, ui: &mut Ui, height: f32) {
        section(ui, "Typologies");
        let known: BTreeSet<Typology> = app.session.schemes.typologies().chain(&self.added).cloned().collect();
        ui.spacing_mut().item_spacing.y = 2.0;
        ScrollArea::vertical().id_salt("typologies").max_height(height - 96.0).auto_shrink([false, true]).show(
            ui,
            |ui| {
                for typology in known {
                    let is_changed = self.changes.contains_key(&typology);
                    let title = typology.title();
                    let trail = if is_changed { "changed" } else { "" };
                    let row =
                        Row::new(Lead::None, &title).trail(trail).selected(self.typology.as_ref() == Some(&typology));
                    if row.button(ui, Role::ListBoxOption).clicked() {
                        self.typology = Some(typology);
                        self.search.clear();
                    }
                }
            },
        );
        ui.add_space(6.0);
        let new = Typology::new(&self.new_typology);
        let (mut is_entered, mut is_clicked) = (false, false);
        ui.horizontal(|ui| {
            let response = text(ui, "New typology", &mut self.new_typology, LIST - 82.0, "New typology");
            is_entered = response.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter));
            is_clicked = ui.add_enabled_ui(new.is_some(), |ui| text_button(ui, "Add", false)).inner.clicked();
        });
        if let Some(new) = new.filter(|_| is_clicked || is_entered) {
            self.new_typology.clear();
            self.added.insert(new.clone());
            self.typology = Some(new);
        }
    }

    /// The functions of a typology: those of the plans at hand that the scheme does not know come first.
    fn functions(&mut self, app: &App, ui: &mut Ui, typology: &Typology) {
        let palette = app.session.palette(ui);
        let mut meanings: BTreeMap<String, Option<Meaning>> = BTreeMap::new();
        let mut rooms: BTreeMap<String, usize> = BTreeMap::new();
        if let Some(at_hand) = &app.session.at_hand.read {
            for ((of, function), plans) in &at_hand.by_scheme {
                if of == typology {
                    rooms.insert(function.clone(), plans.values().sum());
                    meanings.insert(function.clone(), app.session.schemes.meaning(Some(typology), function));
                }
            }
        }
        for (function, meaning) in app.session.schemes.functions(typology) {
            meanings.insert(function.to_owned(), Some(meaning));
        }
        if let Some(changes) = self.changes.get(typology) {
            meanings.extend(changes.meanings.iter().map(|(function, meaning)| (function.clone(), *meaning)));
        }
        ui.horizontal(|ui| {
            let width = (ui.available_width() - 81.0).max(80.0);
            let response = text(ui, "Function", &mut self.search, width, "Find a function, or type a new one");
            let typed = normalised_function(&self.search);
            let is_new = !typed.is_empty() && !meanings.contains_key(&typed) && !typed.contains([';', '=']);
            let is_entered = response.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter));
            let is_clicked = ui.add_enabled_ui(is_new, |ui| text_button(ui, "Add", false)).inner.clicked();
            if is_new && (is_clicked || is_entered) {
                let meaning = Some(Meaning::Labelled(Label::MediumRoom));
                self.changes.entry(typology.clone()).or_default().meanings.insert(typed, meaning);
            }
        });
        ui.add_space(4.0);
        let mut search = Search::new(&self.search);
        let mut shown: Vec<(String, Option<Meaning>)> = meanings
            .into_iter()
            .filter(|(function, _)| self.search.trim().is_empty() || search.hit(function).is_some())
            .collect();
        // What nobody has decided yet stands first, the most frequent on top.
        shown.sort_by_key(|(function, meaning)| {
            (meaning.is_some(), if meaning.is_none() { usize::MAX - rooms.get(function).unwrap_or(&0) } else { 0 })
        });
        let mut set: Vec<(String, Chosen)> = Vec::new();
        let mut colours: BTreeMap<String, Option<Colour>> =
            app.session.schemes.colours(Some(typology)).into_iter().map(|(of, colour)| (of, Some(colour))).collect();
        if let Some(changes) = self.changes.get(typology) {
            colours.extend(changes.colours.clone());
        }
        let usual = palette.functions(shown.iter().map(|(function, _)| function.as_str()));
        ui.spacing_mut().item_spacing.y = 3.0;
        let area = ScrollArea::vertical().id_salt("functions").auto_shrink(false);
        area.show_rows(ui, ROW, shown.len().max(1), |ui, range| {
            if shown.is_empty() {
                caption(ui, "No functions yet. Type one above, such as ‘ward’, and add it.");
            }
            for (function, meaning) in shown.get(range).unwrap_or_default() {
                let number = rooms.get(function).copied().unwrap_or_default();
                let own = colours.get(function).copied().flatten();
                let colour = own.unwrap_or_else(|| usual.get(function).map_or([128; 3], |it| [it.r, it.g, it.b]));
                if let Some(chosen) = function_row(ui, palette, function, *meaning, number, colour) {
                    set.push((function.clone(), chosen));
                }
            }
        });
        for (function, chosen) in set {
            match chosen {
                Chosen::Meaning(meaning) => self.change(app, typology, function, Some(meaning)),
                Chosen::Colour(colour) => {
                    self.changes.entry(typology.clone()).or_default().colours.insert(function, Some(colour));
                }
            }
        }
    }

    /// Notes a change; one back to what the scheme says is none.
    fn change(&mut self, app: &App, typology: &Typology, function: String, meaning: Option<Meaning>) {
        let known = app.session.schemes.functions(typology).find(|(of, _)| *of == function).map(|(_, meaning)| meaning);
        let of_typology = self.changes.entry(typology.clone()).or_default();
        if known == meaning {
            of_typology.meanings.remove(&function);
        } else {
            of_typology.meanings.insert(function, meaning);
        }
        self.changes.retain(|_, changes| !changes.is_empty());
    }

    fn foot(&self, app: &App, ui: &mut Ui) -> Option<End> {
        let (mut rooms, mut plans) = (0, 0);
        for (typology, changes) in &self.changes {
            if let Some((_, affected)) = app.session.scheme_preview(typology, changes) {
                rooms += affected.rooms;
                // A plan has one typology.
                plans += affected.plans;
            }
        }
        let changes: usize = self.changes.values().map(Changes::len).sum();
        let told = if changes == 0 {
            let of = app.session.source_title(&app.session.usual_source());
            format!("Functions with a number occur in {of}.")
        } else {
            let verb = if rooms == 1 { "changes its label" } else { "change their label" };
            format!("{}: {} in {} {verb}.", count(changes, "change"), count(rooms, "room"), count(plans, "plan"))
        };
        ui.add(egui::Label::new(strong(told, theme::BODY)).wrap());
        let mut act = None;
        ui.horizontal(|ui| {
            right(ui, |ui| {
                if main_button(ui, "Save", changes > 0) {
                    act = Some(End::Save);
                }
                let title = if changes > 0 { "Discard" } else { "Close" };
                if text_button(ui, title, false).clicked() {
                    act = Some(End::Leave);
                }
            });
        });
        act
    }
}

/// What was chosen for a function.
enum Chosen {
    Meaning(Meaning),
    Colour(Colour),
}

/// A function with the choice of its colour and its label. Gives one that was chosen.
fn function_row(
    ui: &mut Ui,
    palette: &Palette,
    function: &str,
    meaning: Option<Meaning>,
    rooms: usize,
    mut colour: Colour,
) -> Option<Chosen> {
    let mut chosen = None;
    let choices = 268.0f32.min(ui.available_width() * 0.55);
    ui.horizontal(|ui| {
        let picker =
            ui.color_edit_button_srgb(&mut colour).on_hover_text("Its colour where rooms are filled by function");
        let is_picked = picker.changed();
        picker.accessible_name(format!("{function}: colour"));
        if is_picked {
            chosen = Some(Chosen::Colour(colour));
        }
        let width = (ui.available_width() - choices - 8.0).max(60.0);
        let (rect, response) = ui.allocate_exact_size(vec2(width, ROW), Sense::hover());
        let number = if rooms > 0 { count(rooms, "room") } else { String::new() };
        let colour = if meaning.is_none() { colours(ui).warning } else { colours(ui).text };
        let title = sentence(function);
        put_line(ui, &title, FontId::proportional(theme::BODY), colour, rect.with_max_x(rect.right() - 70.0));
        let small = FontId::proportional(theme::SMALL);
        let galley = ui.painter().layout_no_wrap(number, small, colours(ui).text_weak);
        crate::app::look::widgets::put(ui, galley.clone(), rect.right() - galley.rect.width() - 6.0, rect.center().y);
        response.on_hover_text(if meaning.is_none() { format!("{title}: not in the scheme yet") } else { title });
        let names: Vec<String> = Label::ALL.iter().map(|label| format!("{function}: {}", label.name())).collect();
        let mut segments: Vec<Segment<'_>> = Label::ALL
            .into_iter()
            .zip(&names)
            .map(|(label, name)| Segment {
                text: label.letter(),
                name,
                help: label.name(),
                is_on: meaning == Some(Meaning::Labelled(label)),
                colour: Some(theme::colour(palette.label(label))),
            })
            .collect();
        let none = format!("{function}: not classified");
        segments.push(Segment {
            text: "None",
            name: &none,
            help: "Not classified: the rooms count as none, such as shafts and balconies",
            is_on: meaning == Some(Meaning::NotClassified),
            colour: None,
        });
        let clicked = ui.allocate_ui(vec2(choices, ROW), |ui| segmented(ui, &segments)).inner;
        if let Some(index) = clicked {
            let meaning = Label::ALL.get(index).map_or(Meaning::NotClassified, |&it| Meaning::Labelled(it));
            chosen = Some(Chosen::Meaning(meaning));
        }
    });
    chosen
}
