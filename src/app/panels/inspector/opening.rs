//! A picked opening: its kind, its measures, how a door hangs, and what it joins.

use super::wall::names_of_ends;
use super::*;
use crate::edit::change_swing;
use crate::plan::LeafSide;
use crate::topology::sides_by_geometry;

impl Inspected<'_> {
    pub(super) fn opening(
        &self,
        ui: &mut Ui,
        id: OpeningId,
        opening: &Opening,
        hovered: &mut Option<ElementId>,
    ) -> Option<Act> {
        let subtitle = match opening.place {
            Place::Hosted { .. } => "In a wall",
            Place::Free { .. } => "Not in a wall",
        };
        header(ui, None, Some(opening_icon(opening.kind)), &sentence(opening.kind.name()), subtitle);
        ui.add_space(6.0);
        let kinds: Vec<(&str, String)> =
            [("door", "Door"), ("double-door", "Double"), ("passage", "Passage"), ("window", "Window")]
                .map(|(word, title)| (word, title.to_owned()))
                .into();
        let kind = opening.kind.name().replace(' ', "-");
        let mut act = self.kinds(ui, &kind, &kinds);
        if let Some(segment) = self.plan.opening_segment(opening) {
            act = act.or(self.length(ui, "Width", segment.length(), 0.01..=1000.0, "set-opening-width", &[]));
            let names = names_of_ends(segment);
            for ((beside, name), word) in
                self.app.session.beside_opening(id).into_iter().flatten().zip(names).zip(["start", "end"])
            {
                let to = if beside.is_opening { "next" } else { "wall" };
                let name = format!("{} to {to}", sentence(name));
                let range_m = 0.0..=1000.0;
                act = act.or(self.length(ui, &name, beside.distance_m, range_m, "set-opening-distance", &[word]));
            }
            act = act.or(self.swing(ui, id, opening, names));
        }
        if !opening.kind.is_passable() {
            caption(ui, "Windows do not connect rooms.");
            return act;
        }
        hairline(ui);
        section(ui, "Joins");
        let joins = self.document.derived().and_then(|derived| {
            let connections = derived.analysis.graph.connections();
            Some((derived, connections.iter().find(|connection| connection.opening == id)?))
        });
        let Some((derived, connection)) = joins else { return act };
        unindented(ui, |ui| {
            ui.spacing_mut().item_spacing.y = 0.0;
            for (side, joint) in connection.sides.into_iter().enumerate() {
                match joint {
                    Joint::Outside => drop(Row::new(Lead::Icon(Icon::Outside), "Outside").inset(8.0).show_only(ui)),
                    Joint::Room(room) => {
                        let target = ElementId::Room(room);
                        let status = derived.analysis.room(room).map_or(RoomStatus::Unlabelled, |room| room.status);
                        let colour = theme::colour(self.palette.status(status));
                        let text = title_of(self.plan, target);
                        let row = Row::new(Lead::Swatch(colour), &text);
                        let response = ui.push_id(side, |ui| row.button(ui, Role::Link)).inner;
                        if response.hovered() || response.has_focus() {
                            *hovered = Some(target);
                        }
                        if response.clicked() {
                            act = Some(Act::Pick(target));
                        }
                    }
                }
            }
        });
        ui.add_space(4.0);
        caption(ui, if connection.pinned { "Set by the file or by hand" } else { "Found from its position" });
        if connection.joins_nothing() {
            ui.label(RichText::new("Both sides are the same room, so it connects nothing.").color(colours(ui).warning));
        }
        act
    }

    /// The kinds of openings, over the whole width.
    fn kinds(&self, ui: &mut Ui, now: &str, kinds: &[(&str, String)]) -> Option<Act> {
        let segments: Vec<Segment<'_>> = kinds
            .iter()
            .map(|(word, title)| Segment { text: title, name: title, help: title, is_on: now == *word, colour: None })
            .collect();
        let chosen = segmented(ui, &segments);
        ui.add_space(2.0);
        chosen
            .and_then(|index| kinds.get(index))
            .map(|(word, _)| Act::Choose("set-opening-kind", vec![(*word).to_owned()]))
    }

    /// How a door hangs: at which end, and to which side it opens.
    fn swing(&self, ui: &mut Ui, id: OpeningId, opening: &Opening, names: [&str; 2]) -> Option<Act> {
        let derived = self.document.derived()?;
        let swing = derived.drawing.swing_of(id)?;
        // Only of what has leaves.
        change_swing(self.plan, id, swing, |swing| swing).ok()?;
        let mut act = None;
        if opening.kind == OpeningKind::Door {
            let ends = [("start", sentence(names[0])), ("end", sentence(names[1]))];
            let now = if swing.hinge_at_start { "start" } else { "end" };
            act = self.choice(ui, "Hinge", now, &ends, "set-hinge");
        }
        let [left, right] = sides_by_geometry(self.plan, &derived.analysis.shapes, opening).map(|joint| match joint {
            Joint::Outside => "Outside".to_owned(),
            Joint::Room(room) => title_of(self.plan, ElementId::Room(room)),
        });
        let (left, right) = if left == right { ("One side".to_owned(), "The other".to_owned()) } else { (left, right) };
        let now = if swing.side == LeafSide::Left { "left" } else { "right" };
        act.or(self.choice(ui, "Opens to", now, &[("left", left), ("right", right)], "set-side"))
    }

    /// The openings among what is selected.
    pub(super) fn openings(&self, ui: &mut Ui, common: &InCommon) -> Option<Act> {
        self.length(ui, "Width", common.width_m?, 0.01..=1000.0, "set-opening-width", &[])
    }
}
