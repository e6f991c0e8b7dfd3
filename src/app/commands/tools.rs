//! The active tool, for keys and commands.

use egui::{Context, Event};

use crate::app::state::App;
use crate::app::tools::TOOLS;

impl App {
    /// Takes the keys meant for the active tool.
    pub(in crate::app) fn take_tool_keys(&mut self, context: &Context) {
        let is_typing = self.was_typing || context.text_edit_focused();
        let is_covered =
            self.session.question.is_some() || self.dialogs.is_any_open() || egui::Popup::is_any_open(context);
        if is_typing || is_covered || self.session.document.is_none() {
            return;
        }
        let units = self.units();
        for event in self.tools.take_keys(context, units) {
            match event {
                Event::Copy => {
                    self.run_command("copy", context);
                }
                Event::Cut => {
                    self.run_command("cut", context);
                }
                Event::Paste(text) => {
                    self.take_pasted(&text);
                    self.run_command("paste", context);
                }
                _ => {}
            }
        }
    }

    /// Puts the tool away: first cancels what was started, then returns to selecting.
    pub(in crate::app) fn put_tool_away(&mut self) {
        if self.tools.tool().is_busy() {
            self.tools.drop_work();
        } else {
            self.tools.take_up(TOOLS[0].id);
        }
    }
}
