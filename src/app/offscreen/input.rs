//! User input to the window: pointer, wheel, keys, dropped files.

use super::*;

impl Offscreen {
    /// Feeds an egui event.
    pub fn event(&mut self, event: Event) {
        match &mut self.gathered {
            Some(gathered) => gathered.push(event),
            None => self.frame(vec![event], Vec::new(), false),
        }
    }

    /// From now on the machine is slow: what is typed and clicked waits until [`Self::be_quick`].
    pub fn be_slow(&mut self) {
        self.gathered.get_or_insert_default();
        self.frame_secs = SLOW_FRAME_SECS;
    }

    /// All that was typed and clicked since [`Self::be_slow`] comes within one frame of half a second; then the machine
    /// is quick again.
    pub fn be_quick(&mut self) {
        let events = self.gathered.take().unwrap_or_default();
        self.frame(events, Vec::new(), false);
        while self.app.has_arrivals() && !self.is_closed {
            self.frame(Vec::new(), Vec::new(), false);
        }
        self.frame_secs = FRAME_SECS;
    }

    /// The pointer's position.
    pub fn pointer(&self) -> Pos2 {
        self.pointer
    }

    /// Holds modifier keys down, instead of those held before.
    pub fn hold_modifiers(&mut self, modifiers: Modifiers) {
        if self.modifiers != modifiers {
            self.modifiers = modifiers;
            self.event(Event::ModifiersChanged(modifiers));
        }
    }

    /// The modifier keys held down.
    pub fn modifiers(&self) -> Modifiers {
        self.modifiers
    }

    /// Moves the pointer.
    pub fn move_to(&mut self, at: Pos2) {
        self.pointer = at;
        self.event(Event::PointerMoved(at));
    }

    /// Presses or releases a pointer button.
    pub fn button(&mut self, button: PointerButton, pressed: bool) {
        self.event(Event::PointerButton { pos: self.pointer, button, pressed, modifiers: self.modifiers });
    }

    /// Clicks at a place.
    pub fn click(&mut self, at: Pos2) {
        self.clicks(PointerButton::Primary, at, 1);
    }

    /// Clicks a position this many times in quick succession.
    pub fn clicks(&mut self, button: PointerButton, at: Pos2, count: usize) {
        self.move_to(at);
        for _ in 0..count {
            self.button(button, true);
            self.button(button, false);
        }
        // So that the next click does not make a double click.
        if self.gathered.is_none() {
            self.advance(CLICK_GAP_SECS);
        }
    }

    /// Drags from one position to another.
    pub fn drag(&mut self, button: PointerButton, from: Pos2, to: Pos2) {
        self.drag_along(button, &[from, from + (to - from) / 2.0, to]);
    }

    /// Drags from the first position via the others to the last.
    pub fn drag_along(&mut self, button: PointerButton, places: &[Pos2]) {
        for (index, &place) in places.iter().enumerate() {
            self.move_to(place);
            if index == 0 {
                self.button(button, true);
            }
        }
        self.button(button, false);
    }

    /// Scrolls the wheel by lines, away from the user when positive.
    pub fn wheel(&mut self, lines: f32) {
        self.scroll(MouseWheelUnit::Line, vec2(0.0, lines));
    }

    /// Scrolls with two fingers on a touch pad, in logical pixels.
    pub fn swipe(&mut self, by: Vec2) {
        self.scroll(MouseWheelUnit::Point, by);
    }

    fn scroll(&mut self, unit: MouseWheelUnit, delta: Vec2) {
        let modifiers = self.modifiers;
        let source = MouseWheelSource::Unknown;
        self.event(Event::MouseWheel { unit, delta, phase: TouchPhase::Move, source, modifiers });
    }

    /// Presses and releases a key, with modifiers in addition to those held down. Ctrl with C, X and V
    /// are copy, cut and paste, as in window systems.
    pub fn key(&mut self, modifiers: Modifiers, key: Key) {
        let held = self.modifiers;
        let modifiers = held.plus(modifiers);
        self.hold_modifiers(modifiers);
        let clipboard_event = match key {
            _ if !modifiers.matches_exact(Modifiers::COMMAND) => None,
            Key::C => Some(Event::Copy),
            Key::X => Some(Event::Cut),
            Key::V => Some(Event::Paste(self.clipboard.clone())),
            _ => None,
        };
        match clipboard_event {
            Some(event) => self.event(event),
            None => {
                for pressed in [true, false] {
                    self.event(Event::Key { key, physical_key: None, pressed, repeat: false, modifiers });
                }
            }
        }
        self.hold_modifiers(held);
    }

    /// Holds a key down or releases it.
    pub fn hold(&mut self, key: Key, pressed: bool) {
        let modifiers = self.modifiers;
        self.event(Event::Key { key, physical_key: None, pressed, repeat: false, modifiers });
    }

    /// Types a text.
    pub fn text(&mut self, text: &str) {
        self.event(Event::Text(text.to_owned()));
    }

    /// Hovers a file over the window, or takes it away.
    pub fn hover_file(&mut self, path: Option<&Path>) {
        let hovered = path.map(|path| egui::HoveredFile { path: Some(path.to_owned()), ..Default::default() });
        self.hovered_files = hovered.into_iter().collect();
        self.frame(Vec::new(), Vec::new(), false);
    }

    /// Drops a file on the window.
    pub fn drop_file(&mut self, path: &Path) {
        self.hovered_files.clear();
        self.frame(Vec::new(), vec![Arc::new(Dropped(path.to_owned()))], false);
    }

    /// Asks the window to close, like its title bar's button.
    pub fn ask_to_close(&mut self) {
        self.frame(Vec::new(), Vec::new(), true);
    }

    /// Changes the size of the window, in logical pixels.
    pub fn resize(&mut self, width: u32, height: u32) {
        self.set_options(OffscreenOptions { width, height, ..self.options });
    }
}
