//! Never losing work: journals and recovery from them, a program killed at any moment, full disks.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]
#![allow(clippy::disallowed_methods, reason = "a test's files are no user's")]
#![allow(clippy::print_stdout, reason = "says why it was skipped, and what it measured")]

mod full_disk;
mod journals;
mod killed;
mod window;

use enfilade::plan::Plan;
use enfilade::store::bundled_plans;

/// The bundled house.
fn house() -> Plan {
    let plans = bundled_plans().unwrap();
    plans.into_iter().find(|(name, _)| name.starts_with("dwelling")).unwrap().1
}
