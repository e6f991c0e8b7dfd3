//! Every edit: by example, by random sequences with undo and redo (the invariants hold after each,
//! undo returns exactly the former plan, and what an edit refuses leaves no trace), and on real plans.
//! `PROPTEST_CASES=10000 cargo test --release --test edits` runs a campaign.
#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]
#![allow(clippy::print_stdout, reason = "says why it was skipped")]

#[path = "edits/areas.rs"]
mod areas;
#[path = "edits/changing.rs"]
mod changing;
#[path = "edits/drawing.rs"]
mod drawing;
#[path = "edits/laws.rs"]
mod laws;
#[path = "edits/real.rs"]
mod real;
#[path = "edits/sequences.rs"]
mod sequences;
#[path = "edits/support.rs"]
mod support;
