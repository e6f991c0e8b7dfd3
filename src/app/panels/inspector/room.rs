//! A picked room: its texts, label, prediction, features and neighbours.

use super::*;
use crate::app::look::text::{select_all, select_when_entered};

impl Inspected<'_> {
    pub(super) fn room(
        &self,
        ui: &mut Ui,
        id: RoomId,
        room: &Room,
        hovered: &mut Option<ElementId>,
        evidence: &mut Option<Marks>,
    ) -> Option<Act> {
        let derived = self.document.derived();
        let analysed = derived.and_then(|derived| derived.analysis.room(id));
        let status = RoomStatus::of(self.plan, &self.app.session.schemes, room);
        let colour = self.palette.status(status);
        let letter = status.label().map_or("–", Label::letter);
        let subtitle = match status {
            RoomStatus::Labelled(label) => sentence(label.name()),
            RoomStatus::NotClassified => "Not classified".to_owned(),
            RoomStatus::Unlabelled => "No label".to_owned(),
        };
        header(
            ui,
            Some((theme::colour(colour), letter, theme::colour(self.palette.ink))),
            None,
            &room_title(room),
            &subtitle,
        );
        ui.add_space(6.0);
        let mut act = self.field(ui, id, FieldKind::Name, &room.name, "Unnamed");
        act = Act::both(act, self.field(ui, id, FieldKind::Function, &room.function, "Unknown"));
        act = Act::both(act, self.proposed_function(ui, id));
        act = Act::both(act, self.field(ui, id, FieldKind::Note, &room.note, "None"));
        ui.add_space(4.0);
        if let Some(net) = derived.and_then(|derived| derived.analysis.net(id)) {
            let units = self.app.units();
            value(ui, "Clear area", &units.area(net.area_m2)).on_hover_text(CLEAR);
            value(ui, "Clear perimeter", &units.length(net.perimeter_m())).on_hover_text(CLEAR);
            ui.add_space(4.0);
        }
        act = act.or(self.label(ui, room, status));
        hairline(ui);
        let is_known = |derived: &Derived| derived.predictions.as_ref().is_some_and(|of| of.distribution(id).is_some());
        let said = self.document.derived_or_last().filter(|(derived, is_fresh)| *is_fresh || is_known(derived));
        if let Some((derived, is_fresh)) = said {
            // While the plan is analysed after an edit, what was said stays where it is, faint.
            let of_derived = |ui: &mut Ui| self.predicted(ui, id, status, derived, evidence);
            act = act.or(ui.add_enabled_ui(is_fresh, of_derived).inner);
            hairline(ui);
        }
        section(ui, "Features");
        match analysed {
            None if self.app.session.document.as_ref().is_some_and(|document| !document.is_awaited()) => {
                caption(ui, "Could not be computed");
            }
            None => drop(caption(ui, "Computing…")),
            Some(analysed) => {
                let perimeter_m =
                    derived.and_then(|derived| derived.analysis.shapes.get(id)).map(RoomShape::perimeter_m);
                features(ui, analysed, perimeter_m, self.app.units());
            }
        }
        if let Some(derived) = derived {
            hairline(ui);
            act = act.or(self.neighbours(ui, id, derived, hovered));
        }
        act
    }

    pub(super) fn predicted(
        &self,
        ui: &mut Ui,
        id: RoomId,
        status: RoomStatus,
        derived: &Derived,
        evidence: &mut Option<Marks>,
    ) -> Option<Act> {
        let predictions = derived.predictions.as_ref()?;
        let why = derived.why(id, self.app.units());
        prediction::of_room(ui, self.app, self.palette, predictions, id, status, why.as_deref(), evidence).map(Act::of)
    }

    /// An editable text of a room.
    pub(super) fn field(&self, ui: &mut Ui, room: RoomId, kind: FieldKind, current: &str, hint: &str) -> Option<Act> {
        let name = match kind {
            FieldKind::Name => "Name",
            FieldKind::Function => "Function",
            FieldKind::Note => "Note",
        };
        let typed = self.app.session.field.as_ref().filter(|field| field.room == room && field.kind == kind);
        let mut text = typed.map_or(current, |field| &field.text).to_owned();
        let mut act = None;
        ui.horizontal(|ui| {
            let (rect, _) = ui.allocate_exact_size(vec2(64.0, 28.0), Sense::hover());
            let font = egui::FontId::proportional(theme::BODY);
            ui.painter().text(rect.left_center(), egui::Align2::LEFT_CENTER, name, font, colours(ui).text_weak);
            let id = Id::unique(("room field", room, name));
            let edit = TextEdit::singleline(&mut text)
                .id(id)
                .hint_text(RichText::new(hint).color(colours(ui).text_weak))
                .desired_width(ui.available_width())
                .align(egui::Align2::LEFT_CENTER);
            let response = ui.add(edit);
            let response = response.accessible_name(name);
            follow_focus(&response);
            if self.app.panels.focus == Some(kind) {
                response.request_focus();
                select_all(ui.ctx(), id, &text);
            }
            select_when_entered(ui, &response, &text);
            let written = response.changed().then(|| Field { room, kind, text: text.clone() });
            let chosen = if kind == FieldKind::Function {
                self.suggestions(ui, &response, &text, typed.is_some())
            } else {
                None
            };
            match chosen {
                Some(Suggested::Chosen(function)) => {
                    act = Some(Act::Type(Field { room, kind, text: function }));
                    response.surrender_focus();
                }
                Some(Suggested::Choosing) => act = written.map(Act::Type),
                None if response.lost_focus() => {
                    let is_escape = ui.input(|input| input.key_pressed(Key::Escape));
                    act = Some(if is_escape { Act::Revert } else { Act::Commit(written) });
                }
                None if written.is_some() => act = written.map(Act::Type),
                // A function was chosen, or its list was left.
                None if typed.is_some() && !response.has_focus() => act = Some(Act::Commit(None)),
                None => {}
            }
        });
        act
    }

    /// The scheme's functions, below the field being edited.
    pub(super) fn suggestions(
        &self,
        ui: &Ui,
        response: &egui::Response,
        text: &str,
        is_typed: bool,
    ) -> Option<Suggested> {
        let typology = self.plan.meta().typology.as_ref()?;
        let wanted = normalised_function(text);
        // All until something is typed; then those that match.
        let fits = |function: &str| !is_typed || (function.contains(&wanted) && function != wanted);
        let functions: Vec<(&str, Meaning)> =
            self.app.session.schemes.functions(typology).filter(|(function, _)| fits(function)).collect();
        let id = response.id.with("suggestions");
        let was_open = Popup::is_id_open(ui.ctx(), id);
        let pressed_inside = was_open
            && ui.input(|input| input.pointer.any_down() || input.pointer.any_released())
            && ui
                .ctx()
                .memory(|memory| memory.area_rect(id))
                .is_some_and(|area| ui.input(|input| input.pointer.interact_pos()).is_some_and(|at| area.contains(at)));
        let is_open = (response.has_focus() || pressed_inside) && !functions.is_empty();
        if is_open != was_open {
            if is_open { Popup::open_id(ui.ctx(), id) } else { Popup::close_id(ui.ctx(), id) }
        }
        let mut chosen = None;
        Popup::from_response(response)
            .id(id)
            .open_memory(None)
            .width(response.rect.width())
            .gap(4.0)
            .close_behavior(PopupCloseBehavior::IgnoreClicks)
            .show(|ui| {
                ui.spacing_mut().item_spacing.y = 0.0;
                ScrollArea::vertical().max_height(224.0).auto_shrink([false, true]).show(ui, |ui| {
                    for (function, meaning) in functions {
                        let status = match meaning {
                            Meaning::Labelled(label) => RoomStatus::Labelled(label),
                            Meaning::NotClassified => RoomStatus::NotClassified,
                        };
                        let colour = theme::colour(self.palette.status(status));
                        let row = Row::new(Lead::Swatch(colour), function);
                        if row.button(ui, Role::ListBoxOption).clicked() {
                            chosen = Some(function.to_owned());
                        }
                    }
                });
            });
        match chosen {
            Some(function) => {
                Popup::close_id(ui.ctx(), id);
                Some(Suggested::Chosen(function))
            }
            None if pressed_inside => Some(Suggested::Choosing),
            None => None,
        }
    }

    /// The five labels side by side; returns one that was clicked.
    pub(super) fn label_segments(&self, ui: &mut Ui, current: Option<Label>) -> Option<Label> {
        let typology = self.plan.meta().typology.as_ref();
        let about = Label::ALL.map(|label| self.app.session.schemes.about(label, typology, self.app.units()));
        let segments: Vec<Segment<'_>> = Label::ALL
            .into_iter()
            .zip(LABEL_COMMANDS)
            .filter_map(|(label, id)| {
                let command = commands::find(id)?;
                Some(Segment {
                    text: label.letter(),
                    name: command.title,
                    help: &about[label.index()],
                    is_on: current == Some(label),
                    colour: Some(theme::colour(self.palette.label(label))),
                })
            })
            .collect();
        segmented(ui, &segments).map(|index| Label::ALL[index])
    }

    pub(super) fn label(&self, ui: &mut Ui, room: &Room, status: RoomStatus) -> Option<Act> {
        let mut act = self.label_segments(ui, status.label()).map(|label| Act::Label(Some(label)));
        caption(ui, self.label_origin(room, status));
        if room.label.is_some() && link(ui, "Clear label").clicked() {
            act = Some(Act::Label(None));
        }
        if room.label.is_none() {
            act = act.or(self.typology_choice(ui));
        }
        act
    }

    /// Where the room's label comes from.
    pub(super) fn label_origin(&self, room: &Room, status: RoomStatus) -> String {
        if let Some(given) = room.label {
            return match given.origin {
                LabelOrigin::Person => "Set by hand".to_owned(),
                LabelOrigin::Imported => "From the imported file".to_owned(),
                LabelOrigin::AcceptedPrediction => "An accepted prediction".to_owned(),
                LabelOrigin::Prediction => "A prediction, not accepted yet".to_owned(),
            };
        }
        let typology = self.plan.meta().typology.as_ref();
        match (status, typology) {
            (RoomStatus::Labelled(_) | RoomStatus::NotClassified, Some(typology)) => {
                format!("From its function, as the label scheme for {typology} says")
            }
            (_, None) => "Its function gives it no label, because the plan has no typology.".to_owned(),
            (_, Some(_)) if room.function.trim().is_empty() => "No label: it has no function".to_owned(),
            (_, Some(typology)) => format!("The label scheme for {typology} does not know this function"),
        }
    }

    pub(super) fn neighbours(
        &self,
        ui: &mut Ui,
        id: RoomId,
        derived: &Derived,
        hovered: &mut Option<ElementId>,
    ) -> Option<Act> {
        let neighbours: Vec<(OpeningId, Joint)> = derived.analysis.neighbours(id).collect();
        section(ui, "Neighbours");
        if neighbours.is_empty() {
            caption(ui, "No opening leads here.");
        }
        if let Some(below) = self.app.session.shown_ghost() {
            for link in below.links_to(self.plan).iter().filter(|link| link.upper == id) {
                let other = title_of(&below.plan, ElementId::Room(link.lower));
                caption(ui, format!("Leads down to {other} of {}", below.title));
            }
        }
        let mut act = None;
        ui.add_space(-2.0);
        ui.spacing_mut().item_spacing.y = 0.0;
        unindented(ui, |ui| {
            for (opening_id, joint) in neighbours {
                let Some(opening) = self.plan.opening(opening_id) else { continue };
                let kind = opening.kind.name();
                let (text, target) = match joint {
                    Joint::Room(other) if other == id => ("Itself".to_owned(), ElementId::Opening(opening_id)),
                    Joint::Room(other) => (title_of(self.plan, ElementId::Room(other)), ElementId::Room(other)),
                    Joint::Outside => ("Outside".to_owned(), ElementId::Opening(opening_id)),
                };
                let trail = match self.plan.opening_segment(opening) {
                    Some(segment) => format!("{kind} {}", self.app.units().length(segment.length())),
                    None => kind.to_owned(),
                };
                let row = Row::new(Lead::Icon(opening_icon(opening.kind)), &text).trail(&trail);
                let response = ui.push_id(opening_id, |ui| row.button(ui, Role::Link)).inner;
                if response.hovered() || response.has_focus() {
                    *hovered = Some(target);
                }
                if response.clicked() {
                    act = Some(Act::Pick(target));
                }
            }
        });
        act
    }
}
