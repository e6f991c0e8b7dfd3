//! The robot: logs, grid maps, exploration.

mod explore;
mod logs;
mod maps;
