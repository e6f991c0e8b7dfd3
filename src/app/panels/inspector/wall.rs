//! Picked walls and corners: their measures, each of which can be changed.

use super::*;
use crate::app::paint::preview::angle;
use crate::app::tools::TOOLS;
use crate::edit::End;
use crate::geometry::Segment as Line;
use crate::plan::{CornerId, Wall, WallId};

/// The names of a segment's ends as one sees them on the screen: left and right or, where it rather stands, lower and
/// upper.
pub(super) fn names_of_ends(line: Line) -> [&'static str; 2] {
    let way = line.vector();
    match (way.x.abs() >= way.y.abs(), way.x >= 0.0, way.y >= 0.0) {
        (true, true, _) => ["left", "right"],
        (true, false, _) => ["right", "left"],
        (false, _, true) => ["lower", "upper"],
        (false, _, false) => ["upper", "lower"],
    }
}

impl Inspected<'_> {
    pub(super) fn wall(&self, ui: &mut Ui, id: WallId, wall: &Wall) -> Option<Act> {
        let segment = self.plan.wall_segment(wall)?;
        let icon = TOOLS.iter().find(|tool| tool.id == "tool-walls").and_then(|tool| tool.strip).map(|(icon, _)| icon);
        header(ui, None, icon, "Wall", "Along its centre line");
        ui.add_space(6.0);
        let end = self.moving_end(ui, id, wall);
        let names = names_of_ends(segment);
        let word = if end == End::End { "end" } else { "start" };
        let mut act = self.length(ui, "Length", segment.length(), 0.001..=1e5, "set-wall-length", &[word]);
        // Which end goes, while a length is typed.
        self.marked.set(ui.ctx().text_edit_focused().then(|| end.of(segment)));
        let ends = [("start", sentence(names[0])), ("end", sentence(names[1]))];
        if let Some(Act::Choose(_, words)) = self.choice(ui, "End that moves", word, &ends, "") {
            let end = if words.iter().any(|word| word == "end") { End::End } else { End::Start };
            ui.data_mut(|data| data.insert_temp(end_id(id), end == End::End));
        }
        act = act.or(self.length(ui, "Thickness", wall.thickness_m, 0.0..=10.0, "set-thickness", &[]));
        if let Some(faces) = self.document.derived().and_then(|derived| derived.index.faces_of(id)) {
            // Which is which, a person sees on the plan, where each length stands beside its face.
            let mut lengths_m = [faces.left.length(), faces.right.length()];
            lengths_m.sort_by(f64::total_cmp);
            value(ui, "Along faces", &lengths_m.map(|length_m| self.app.units().length(length_m)).join(", "));
        }
        value(ui, "Direction", &angle(segment.vector())).on_hover_text("Counter-clockwise from the right");
        act
    }

    /// Which end of a wall moves when its length changes: the one chosen or, until then, the one where it is freer.
    fn moving_end(&self, ui: &Ui, id: WallId, wall: &Wall) -> End {
        if let Some(is_end) = ui.data(|data| data.get_temp::<bool>(end_id(id))) {
            return if is_end { End::End } else { End::Start };
        }
        let met_at = |corner: CornerId| {
            self.plan.walls().filter(|(_, other)| other.from == corner || other.to == corner).count()
        };
        if met_at(wall.from) < met_at(wall.to) { End::Start } else { End::End }
    }

    /// The walls among what is selected.
    pub(super) fn walls(&self, ui: &mut Ui, common: &InCommon) -> Option<Act> {
        if common.walls == 0 {
            return None;
        }
        value(ui, "Length together", &self.app.units().length(common.walls_m));
        self.length(ui, "Thickness", common.thickness_m?, 0.0..=10.0, "set-thickness", &[])
    }

    pub(super) fn corner(&self, ui: &mut Ui, id: CornerId) -> Option<Act> {
        let place = self.plan.position(id)?;
        header(ui, None, None, "Corner", "What shares it follows");
        ui.add_space(6.0);
        let mut act = None;
        for (name, now_m) in [("To the right", place.x), ("Up", place.y)] {
            let changed = self.length(ui, name, now_m, -1e6..=1e6, "move-corner", &[]);
            let Some(Act::Choose(command, words)) = changed else { continue };
            let length = words.first().cloned().unwrap_or_default();
            let to = if name == "Up" { format!("{},{length}", place.x) } else { format!("{length},{}", place.y) };
            act = Some(Act::Choose(command, vec![id.to_string(), to]));
        }
        act
    }
}

fn end_id(wall: WallId) -> Id {
    Id::unique(("end of the wall that moves", wall))
}
