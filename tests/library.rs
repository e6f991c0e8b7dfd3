//! The library and its subcommands, with no window: one module a subject, its files beside it.

mod backdrop;
mod bundled_plans;
mod check;
mod classify;
mod edits;
mod faces;
mod features;
mod formats;
mod house;
mod import;
mod joint;
mod pictures;
mod pipeline;
mod study;
mod support;
