//! The storey below, drawn faintly.

use std::sync::Arc;

use egui::{Painter, Rect};

use crate::app::paint::scene_painter::ScenePainter;
use crate::draw::{Fill, Layers, Style, View};
use crate::geometry::Bounds;
use crate::pipeline::Derived;

/// Opacity of the storey below, 0 to 1: drawn over the rooms, whose fills would hide it, yet looking as
/// if behind them.
const OPACITY: f32 = 0.24;

/// Paints the storey below, with caching.
#[derive(Default)]
pub(crate) struct GhostPainter {
    painter: ScenePainter,
    bounds: Option<Bounds>,
}

impl GhostPainter {
    /// The bounding box of the storey last painted: shown when nothing is drawn above it yet.
    pub(crate) fn bounds(&self) -> Option<Bounds> {
        self.bounds
    }

    /// Paints it in the style of the plan above, faintly: its walls and openings.
    pub(crate) fn paint(
        &mut self,
        painter: &Painter,
        rect: Rect,
        below: Option<&Arc<Derived>>,
        style: &Style,
        view: &View,
    ) {
        let bounds = below.map(|below| below.drawing.bounds());
        if std::mem::replace(&mut self.bounds, bounds) != bounds {
            // The view may depend on it.
            painter.ctx().request_repaint();
        }
        let Some(below) = below else { return };
        let layers = Layers { grid: false, rooms: false, graph: false, names: false, areas: false, ..style.layers };
        let style = Style { fill: Fill::None, layers, ..style.clone() };
        let mut faint = painter.clone();
        faint.multiply_opacity(OPACITY);
        self.painter.paint(&faint, rect, below, &style, view);
    }
}
