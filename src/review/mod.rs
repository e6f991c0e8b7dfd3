//! Reviewing labels: where a person's look is worth most, what was decided, and how far two people agree. For readers in
//! `docs/review.md`.

pub mod agreement;
pub mod compare;
mod decisions;
mod material;
mod queue;

pub use decisions::{Decision, Decisions, FILE_NAME, Key, ReadDecisions, Verdict};
pub use material::{FileSeen, Material};
pub use queue::{Entry, Queue, Reason, differences, queue};
