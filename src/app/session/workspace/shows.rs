/// How the workspace is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Shows {
    /// A row a plan.
    #[default]
    Plans,
    /// A picture a plan.
    Grid,
    /// A row a room.
    Rooms,
}

impl Shows {
    pub(crate) const WORDS: &'static [(&'static str, &'static str)] =
        &[("plans", "List of plans"), ("grid", "Pictures of plans"), ("rooms", "Table of rooms")];
}
