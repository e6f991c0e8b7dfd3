//! The robot: logs, grid maps, exploration.

mod explore;
mod hostile;
mod logs;
mod maps;
mod properties;
mod splitting;
mod strange_plans;
