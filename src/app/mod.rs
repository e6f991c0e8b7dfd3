//! The window: canvas, commands, tools, panels, theme.
