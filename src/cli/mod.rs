//! The command line. One file per subcommand, and one line in `SUBCOMMANDS` to register it.

mod batch;
mod call;
mod check;
mod classify;
mod collect;
#[cfg(feature = "gui")]
mod commands;
mod completions;
mod dataset;
mod door;
mod evaluate;
mod explore;
mod export;
mod features;
mod import;
mod inputs;
mod label;
mod man;
mod manifest;
mod map;
mod mistyped;
mod models;
mod numbers;
mod open;
mod outputs;
mod predictions;
mod progress;
mod render;
mod repeats;
#[cfg(feature = "gui")]
mod replay;
mod scales;
