//! The window, clicked and typed at without a display: one module a subject, its files beside it.

mod commands;
mod recovery;
mod support;
mod tracing;
mod window;
