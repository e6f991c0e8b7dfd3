//! The storey below, faint.

use std::sync::Arc;

use egui::{Painter, Rect};

use crate::app::paint::scene_painter::ScenePainter;
use crate::draw::{Fill, Layers, Style, View};
use crate::geometry::Bounds;
use crate::pipeline::Derived;

/// How strongly the storey below is drawn, from 0 to 1: over the rooms, whose fills would hide it, and yet
/// behind them to the eye.
const OPACITY: f32 = 0.24;

/// Paints the storey below, keeping what can be used again.
#[derive(Default)]
pub(crate) struct GhostPainter {
    painter: ScenePainter,
    bounds: Option<Bounds>,
}

impl GhostPainter {
    /// The box of the storey that was painted last: what is seen where nothing is drawn above it yet.
    pub(crate) fn bounds(&self) -> Option<Bounds> {
        self.bounds
    }

    /// Paints it in the style of the plan above: its walls and openings, faint.
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
            // The view may go by it.
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
