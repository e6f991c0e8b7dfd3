//! Changing all that is selected: what it becomes, and what would change, counted first.

use egui::{Align2, ComboBox, Id, TextEdit, Ui, WidgetInfo};

use crate::app::look::theme;
use crate::app::look::widgets::{caption, colours, focus_ring, right, strong, text_button};
use crate::app::session::workspace::OpenWorkspace;
use crate::app::session::workspace::shows::Shows;
use crate::app::state::App;
use crate::base::wording::{count, sentence};
use crate::labels::{Label, Typology};
use crate::workspace::change::{Change, Planned, planned};

/// What is changed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Property {
    #[default]
    Building,
    Typology,
    Function,
    Label,
}

impl Property {
    const OF_PLANS: [Self; 2] = [Self::Building, Self::Typology];
    const OF_ROOMS: [Self; 4] = [Self::Label, Self::Function, Self::Building, Self::Typology];

    const fn title(self) -> &'static str {
        match self {
            Self::Building => "Building",
            Self::Typology => "Typology",
            Self::Function => "Function",
            Self::Label => "Label",
        }
    }
}

/// The form below the table.
#[derive(Default)]
pub(super) struct Form {
    property: Property,
    /// Whether the table of rooms was shown.
    is_of_rooms: bool,
    text: String,
    label: Option<Label>,
    typology: Option<Typology>,
    /// What was counted last, and for what.
    counted: Option<(u64, u64, Change, Planned)>,
}

impl Form {
    fn change(&self) -> Change {
        match self.property {
            Property::Building => Change::Building(self.text.trim().to_owned()),
            Property::Typology => Change::Typology(self.typology.clone()),
            Property::Function => Change::Function(self.text.trim().to_owned()),
            Property::Label => Change::Label(self.label),
        }
    }

    /// What would change; counted again only where something is another.
    fn planned(&mut self, workspace: &OpenWorkspace) -> Planned {
        let change = self.change();
        let (revision, selection) = (workspace.revision, workspace.view.selection);
        match &self.counted {
            Some((at, of, by, planned)) if (*at, *of) == (revision, selection) && *by == change => planned.clone(),
            _ => {
                let planned = planned(&workspace.now, &workspace.view.selected, &change);
                self.counted = Some((revision, selection, change, planned.clone()));
                planned
            }
        }
    }

    pub(super) fn show(&mut self, app: &mut App, ui: &mut Ui) {
        let Some(workspace) = &app.session.workspace else { return };
        let is_rooms = workspace.view.shows == Shows::Rooms;
        let properties: &[Property] = if is_rooms { &Property::OF_ROOMS } else { &Property::OF_PLANS };
        if self.is_of_rooms != is_rooms {
            (self.is_of_rooms, self.property) = (is_rooms, properties[0]);
            self.text.clear();
        }
        let schemes = app.session.schemes.clone();
        let is_empty = workspace.view.selected.is_empty();
        let is_writing = app.session.changing_shown().is_some();
        let mut wanted = None;
        ui.horizontal(|ui| {
            caption(ui, "Change");
            let shown =
                ComboBox::from_id_salt("property").width(96.0).selected_text(self.property.title()).show_ui(ui, |ui| {
                    for property in properties {
                        if ui.selectable_label(self.property == *property, property.title()).clicked() {
                            self.property = *property;
                            self.text.clear();
                        }
                    }
                });
            focus_ring(ui, shown.response.rect, &shown.response);
            let title = self.property.title();
            shown.response.widget_info(|| WidgetInfo::labeled(egui::Role::ComboBox, true, format!("Change: {title}")));
            match self.property {
                Property::Building | Property::Function => {
                    let hint =
                        if self.property == Property::Building { "Name of the building" } else { "New function" };
                    let field = TextEdit::singleline(&mut self.text)
                        .id(Id::unique("workspace change"))
                        .hint_text(hint)
                        .desired_width(180.0)
                        .align(Align2::LEFT_CENTER);
                    ui.add(field).accessible_name(hint);
                }
                Property::Typology => {
                    let title = |typology: &Option<Typology>| {
                        typology.as_ref().map_or_else(|| "No typology".to_owned(), Typology::title)
                    };
                    let list = ComboBox::from_id_salt("new typology").width(150.0).selected_text(title(&self.typology));
                    let shown = list.show_ui(ui, |ui| {
                        let known = schemes.typologies().cloned().map(Some).chain([None]);
                        for typology in known {
                            if ui.selectable_label(self.typology == typology, title(&typology)).clicked() {
                                self.typology = typology;
                            }
                        }
                    });
                    focus_ring(ui, shown.response.rect, &shown.response);
                    let current = title(&self.typology);
                    shown.response.widget_info(|| {
                        WidgetInfo::labeled(egui::Role::ComboBox, true, format!("New typology: {current}"))
                    });
                }
                Property::Label => {
                    let title = |label: Option<Label>| label.map_or("By function", Label::name);
                    let list =
                        ComboBox::from_id_salt("new label").width(150.0).selected_text(sentence(title(self.label)));
                    let shown = list.show_ui(ui, |ui| {
                        for label in Label::ALL.into_iter().map(Some).chain([None]) {
                            if ui.selectable_label(self.label == label, sentence(title(label))).clicked() {
                                self.label = label;
                            }
                        }
                    });
                    focus_ring(ui, shown.response.rect, &shown.response);
                    let current = title(self.label);
                    shown.response.widget_info(|| {
                        WidgetInfo::labeled(egui::Role::ComboBox, true, format!("New label: {current}"))
                    });
                }
            }
            let Some(workspace) = &app.session.workspace else { return };
            let change = self.change();
            let needs_text = matches!(self.property, Property::Building | Property::Function);
            let needs_text = needs_text && self.text.trim().is_empty();
            let (said, number) = if is_empty {
                let thing = if is_rooms { "rooms" } else { "plans" };
                (format!("Select {thing} to change them together."), 0)
            } else if needs_text {
                let what =
                    if change.is_of_plans() { "Type the building's name." } else { "Type what the rooms are for." };
                (what.to_owned(), 0)
            } else {
                let planned = self.planned(workspace);
                (format!("{}.", planned.said(&change)), planned.changed)
            };
            right(ui, |ui| {
                let thing = if change.is_of_plans() { "plan" } else { "room" };
                let title = if number > 0 { format!("Change {}", count(number, thing)) } else { "Change".to_owned() };
                if ui.add_enabled_ui(number > 0 && !is_writing, |ui| text_button(ui, &title, false)).inner.clicked() {
                    wanted = Some(change.clone());
                }
                ui.with_layout(egui::Layout::left_to_right(egui::Align::Center), |ui| {
                    let colour = if number > 0 { colours(ui).text } else { colours(ui).text_weak };
                    ui.add(egui::Label::new(strong(said, theme::SMALL).color(colour)).truncate());
                });
            });
        });
        if let Some(change) = wanted
            && let Err(what) = app.session.change_in_workspace(&change)
        {
            app.session.status = sentence(&what);
        }
    }
}
