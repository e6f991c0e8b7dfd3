//! The selection: elements of the plan that the next command applies to.

use std::collections::BTreeSet;
use std::sync::Arc;

use crate::plan::{CornerId, DimensionId, ElementId, OpeningId, Plan, RoomId, WallId};

/// A set of elements, cheap to clone and to compare with a clone.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Selection {
    elements: Arc<BTreeSet<ElementId>>,
}

/// What happens to the previous selection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SelectMode {
    /// It is replaced.
    Replace,
    Add,
    /// Elements selected again are deselected.
    Toggle,
}

impl Selection {
    /// A selection of exactly these elements.
    pub fn of(elements: impl IntoIterator<Item = ElementId>) -> Self {
        Self { elements: Arc::new(elements.into_iter().collect()) }
    }

    pub fn is_empty(&self) -> bool {
        self.elements.is_empty()
    }

    pub fn len(&self) -> usize {
        self.elements.len()
    }

    pub fn contains(&self, element: ElementId) -> bool {
        self.elements.contains(&element)
    }

    /// The element, if exactly one is selected.
    pub fn one(&self) -> Option<ElementId> {
        (self.elements.len() == 1).then(|| self.elements.first().copied()).flatten()
    }

    /// All elements, sorted.
    pub fn elements(&self) -> &BTreeSet<ElementId> {
        &self.elements
    }

    pub fn iter(&self) -> impl ExactSizeIterator<Item = ElementId> + '_ {
        self.elements.iter().copied()
    }

    pub fn rooms(&self) -> impl Iterator<Item = RoomId> + '_ {
        self.iter().filter_map(|element| if let ElementId::Room(id) = element { Some(id) } else { None })
    }

    pub fn walls(&self) -> impl Iterator<Item = WallId> + '_ {
        self.iter().filter_map(|element| if let ElementId::Wall(id) = element { Some(id) } else { None })
    }

    pub fn openings(&self) -> impl Iterator<Item = OpeningId> + '_ {
        self.iter().filter_map(|element| if let ElementId::Opening(id) = element { Some(id) } else { None })
    }

    pub fn corners(&self) -> impl Iterator<Item = CornerId> + '_ {
        self.iter().filter_map(|element| if let ElementId::Corner(id) = element { Some(id) } else { None })
    }

    pub fn dimensions(&self) -> impl Iterator<Item = DimensionId> + '_ {
        self.iter().filter_map(|element| if let ElementId::Dimension(id) = element { Some(id) } else { None })
    }

    /// Selects elements.
    pub fn select(&mut self, elements: impl IntoIterator<Item = ElementId>, mode: SelectMode) {
        match mode {
            SelectMode::Replace => *self = Self::of(elements),
            SelectMode::Add => Arc::make_mut(&mut self.elements).extend(elements),
            SelectMode::Toggle => {
                let selected = Arc::make_mut(&mut self.elements);
                for element in elements {
                    if !selected.remove(&element) {
                        selected.insert(element);
                    }
                }
            }
        }
    }

    /// Deselects elements that are not in a plan.
    pub fn keep_what_is_in(&mut self, plan: &Plan) {
        if self.elements.iter().any(|&element| !plan.has(element)) {
            Arc::make_mut(&mut self.elements).retain(|&element| plan.has(element));
        }
    }
}
