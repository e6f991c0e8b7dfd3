use super::{Check, Context, Kind, Place, Severity};

/// The plan has no rooms: there is nothing to classify.
#[derive(Clone, Debug, PartialEq)]
pub struct PlanHasNoRooms {
    pub walls: usize,
}

impl Check for PlanHasNoRooms {
    const KIND: Kind = Kind {
        name: "plan_has_no_rooms",
        title: "The plan has no rooms",
        severity: Severity::Warning,
        remedy: "draw rooms, or fill the areas its walls enclose",
    };

    fn find(context: &Context) -> Vec<Self> {
        if context.shapes().is_empty() { vec![Self { walls: context.plan.walls().len() }] } else { Vec::new() }
    }

    fn place(&self) -> Place<'_> {
        Place::default()
    }

    fn what(&self) -> String {
        match self.walls {
            0 => "nothing is drawn".to_owned(),
            walls => format!("there are walls ({walls}), but no rooms"),
        }
    }
}
