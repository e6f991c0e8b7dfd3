//! Every edit: by example, by random sequences with undo and redo (the invariants hold after each, undo
//! restores exactly the previous plan, and a refused edit leaves no trace), and on real plans.
//! `PROPTEST_CASES=10000 PROPTEST_RNG_SEED=7 cargo test --test library edits::unharmed` runs a campaign; another seed, other cases.
#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]
#![allow(clippy::print_stdout, reason = "says why it was skipped")]

mod along;
mod areas;
mod changing;
mod drawing;
mod houses;
mod laws;
mod real;
mod sequences;
mod support;
mod unharmed;
