//! The window's controls as screen readers and scripts find them: by role and name.

use std::collections::HashMap;

use egui::accesskit::{Action, Node, NodeId, Role, Toggled, TreeUpdate};
use egui::{Pos2, Rect};

/// A control visible to screen readers.
#[derive(Clone, Debug, PartialEq)]
pub struct Control {
    pub name: String,
    /// Its description besides the name: a room's label and area; may be empty.
    pub description: String,
    /// What is written in it, if it is a text field.
    pub value: String,
    pub role: Role,
    /// In logical pixels.
    pub rect: Rect,
    pub is_enabled: bool,
    /// Whether it is on, if it can be.
    pub is_on: Option<bool>,
    /// Whether it can get the keyboard.
    pub takes_focus: bool,
    /// Whether it can be pressed.
    pub takes_clicks: bool,
    pub(crate) id: NodeId,
}

/// The controls of an accessibility tree that have a place on the screen, parents before their children,
/// children in the order they were shown. `scale` is pixels per point.
pub(crate) fn of_tree(tree: &TreeUpdate, scale: f32) -> Vec<Control> {
    // Looked up only by id: its order does not matter.
    let nodes: HashMap<NodeId, &Node> = tree.nodes.iter().map(|(id, node)| (*id, node)).collect();
    let mut controls = Vec::new();
    let mut pending: Vec<NodeId> = tree.tree.as_ref().map(|tree| tree.root).into_iter().collect();
    while let Some(id) = pending.pop() {
        let Some(node) = nodes.get(&id) else { continue };
        pending.extend(node.children().iter().rev());
        let Some(bounds) = node.bounds() else { continue };
        let corner = |x: f64, y: f64| Pos2::new(x as f32 / scale, y as f32 / scale);
        controls.push(Control {
            // Plain text has its content as its value.
            name: node.label().or(node.value()).unwrap_or_default().to_owned(),
            description: node.description().unwrap_or_default().to_owned(),
            value: node.value().unwrap_or_default().to_owned(),
            role: node.role(),
            rect: Rect::from_min_max(corner(bounds.x0, bounds.y0), corner(bounds.x1, bounds.y1)),
            is_enabled: !node.is_disabled(),
            is_on: node.is_selected().or(node.toggled().map(|toggled| toggled == Toggled::True)),
            takes_focus: node.supports_action(Action::Focus),
            takes_clicks: node.supports_action(Action::Click),
            id,
        });
    }
    controls
}
