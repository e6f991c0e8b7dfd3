//! Thumbnails of the bundled plans.

use std::sync::Arc;

use crate::app::paint::scene_painter::ScenePainter;
use crate::app::session::document::derived_sample;
use crate::pipeline::Derived;
use crate::plan::Plan;

/// The samples' thumbnails, made when first shown.
#[derive(Default)]
pub(crate) struct Samples(Vec<Option<Sample>>);

pub(crate) struct Sample {
    pub derived: Arc<Derived>,
    pub painter: ScenePainter,
}

impl Samples {
    pub(crate) fn get(&mut self, index: usize, plan: &Plan) -> &mut Sample {
        if self.0.len() <= index {
            self.0.resize_with(index + 1, || None);
        }
        self.0[index]
            .get_or_insert_with(|| Sample { derived: derived_sample(index, plan), painter: ScenePainter::default() })
    }
}
