//! Exporting the plan, and printing it: the format, its options, a preview of the sheet, and where it goes.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

use egui::epaint::StrokeKind;
use egui::{
    Align2, Color32, ColorImage, ComboBox, FontId, Id, Modal, Rect, Role, ScrollArea, Sense, Stroke, TextEdit,
    TextureHandle, TextureOptions, Ui, Vec2, WidgetInfo, pos2, vec2,
};

use crate::app::look::{
    theme,
    widgets::{
        Segment, caption, colours, dialog_frame, focus_ring, main_button, right, section, segmented, strong,
        text_button, toggle,
    },
};
use crate::app::session::exporting::{DEFAULT_OPTIONS, Shown, Writable, is_sheet, writable};
use crate::app::state::{After, App, Dialog, Entry, Purpose, dialogs};
use crate::app::value::{Call, Value};
use crate::base::units::Units;
use crate::base::wording::sentence;
use crate::formats::registry::ending_of;
use crate::formats::{FormatOption, sheets};

pub(super) const ENTRY: Entry =
    Entry { id: dialogs::EXPORT, make: |app, purpose| Box::new(Export::new(app, &purpose)), is_of_plan: true };

/// Width of the options, and of the preview beside them, in points.
const OPTIONS_WIDTH: f32 = 330.0;
const PREVIEW_WIDTH: f32 = 470.0;

/// Width of the captions before the options.
const NAMES: f32 = 92.0;

struct Export {
    is_to_print: bool,
    format: Writable,
    /// What is set, by the format's id and the option's name; without an entry the default.
    values: BTreeMap<(&'static str, &'static str), String>,
    /// Where it goes, as typed.
    path: String,
    /// Whether the path was typed or chosen: it then stays when the format changes, but for its ending.
    is_own_path: bool,
    texture: Option<(Arc<ColorImage>, TextureHandle)>,
}

impl Export {
    fn new(app: &App, purpose: &Purpose) -> Self {
        let is_to_print = matches!(purpose, Purpose::Print);
        let all = writable();
        let (last, remembered) = &app.panels.export;
        let wanted = if is_to_print { sheets::PDF.id } else { last.unwrap_or(sheets::PDF.id) };
        let format = all.iter().find(|(format, _)| format.id == wanted).or(all.first()).copied();
        let format = format.unwrap_or((&sheets::PDF, sheets::PDF_WRITER));
        let mut values = BTreeMap::new();
        for (other, exporter) in &all {
            for option in exporter.options() {
                let told = remembered.get(other.id).and_then(|words| {
                    let mut pairs = words.split_whitespace().filter_map(|pair| pair.split_once('='));
                    pairs.find(|(name, _)| *name == option.name()).map(|(_, value)| value.to_owned())
                });
                // As the window shows lengths, unless told otherwise.
                let is_units = is_sheet(other) && option.name() == "units";
                let usual = (is_units && app.units() == Units::Imperial).then(|| "imperial".to_owned());
                if let Some(value) = told.or(usual) {
                    values.insert((other.id, option.name()), value);
                }
            }
        }
        let path = app.session.shown_path(&app.session.export_path(format.0));
        Self { is_to_print, format, values, path, is_own_path: false, texture: None }
    }

    /// The options as words: those that are not the default.
    fn words(&self) -> String {
        let (format, exporter) = self.format;
        let told = exporter.options().iter().filter_map(|option| {
            let value = self.values.get(&(format.id, option.name()))?;
            (*value != option.default_in_words()).then(|| format!("{}={value}", option.name()))
        });
        let words = told.collect::<Vec<_>>().join(" ");
        if words.is_empty() { DEFAULT_OPTIONS.to_owned() } else { words }
    }

    /// The file, if the text is one.
    fn target(&self, app: &App) -> Option<PathBuf> {
        let path = app.session.typed_file(&self.path)?;
        let name = path.file_name()?.to_string_lossy().into_owned();
        let endings = self.format.0.endings;
        Some(match ending_of(&name, endings) {
            Some(_) => path,
            None => path.with_file_name(format!("{name}.{}", endings.first()?)),
        })
    }
}

/// How the dialog was closed.
enum End {
    Cancel,
    Do(Call),
}

impl Dialog for Export {
    fn show(&mut self, app: &mut App, ui: &mut Ui) -> After {
        if app.session.question.is_some() || app.session.document.is_none() {
            return After::Close;
        }
        if let Some(path) = app.session.chosen_file.take() {
            self.path = app.session.shown_path(&path);
            self.is_own_path = true;
        }
        let response = Modal::new(Id::unique("export")).frame(dialog_frame(ui)).show(ui.ctx(), |ui| {
            let window = ui.ctx().content_rect().size();
            let width = (OPTIONS_WIDTH + PREVIEW_WIDTH + 20.0).min(window.x - 80.0);
            ui.set_width(width);
            ui.label(strong(if self.is_to_print { "Print the plan" } else { "Export the plan" }, theme::TITLE));
            ui.add_space(6.0);
            if !self.is_to_print {
                self.formats(app, ui);
                ui.add_space(8.0);
            }
            let height = (window.y - 330.0).clamp(160.0, 380.0);
            let beside = (width - OPTIONS_WIDTH - 20.0).max(120.0);
            if is_sheet(self.format.0) {
                let width_px = (f64::from(beside) * f64::from(ui.pixels_per_point())).round() as u32;
                let words = self.words();
                app.session.preview_sheet(self.format, &words, width_px.max(64));
            }
            let shown = is_sheet(self.format.0).then(|| app.session.preview().result().cloned()).flatten();
            ui.horizontal_top(|ui| {
                ui.spacing_mut().item_spacing.x = 20.0;
                ui.vertical(|ui| {
                    ui.set_width(OPTIONS_WIDTH.min(width));
                    ScrollArea::vertical().id_salt("options").auto_shrink(false).max_height(height).show(ui, |ui| {
                        self.options(ui);
                    });
                });
                self.preview(ui, shown.as_ref(), vec2(beside, height));
            });
            ui.add_space(8.0);
            let problem = match &shown {
                Some(Err(error)) => Some(error.clone()),
                _ => None,
            };
            if self.is_to_print { self.print_foot(ui, problem) } else { self.foot(app, ui, problem) }
        });
        let is_closed = response.should_close();
        match response.inner.or(is_closed.then_some(End::Cancel)) {
            None => After::Stay,
            Some(End::Cancel) => After::Close,
            Some(End::Do(call)) => {
                let words = self.words();
                app.panels.export.1.insert(self.format.0.id, words);
                if !self.is_to_print {
                    app.panels.export.0 = Some(self.format.0.id);
                }
                app.act_on(call, ui.ctx());
                After::Close
            }
        }
    }
}

impl Export {
    fn formats(&mut self, app: &App, ui: &mut Ui) {
        let all = writable();
        let segments: Vec<Segment<'_>> = all
            .iter()
            .map(|(format, _)| Segment {
                text: format.name,
                name: format.name,
                help: format.about,
                is_on: format.id == self.format.0.id,
                colour: None,
            })
            .collect();
        let Some(&chosen) = segmented(ui, &segments).and_then(|index| all.get(index)) else { return };
        let before = self.format;
        self.format = chosen;
        let ending = chosen.0.endings.first().copied().unwrap_or_default();
        if !self.is_own_path {
            self.path = app.session.shown_path(&app.session.export_path(chosen.0));
        } else if let Some(old) = ending_of(&self.path, before.0.endings) {
            let stem = self.path.len() - old.len();
            self.path.truncate(stem);
            self.path.push_str(ending);
        }
    }

    fn options(&mut self, ui: &mut Ui) {
        let (format, exporter) = self.format;
        ui.spacing_mut().item_spacing.y = 5.0;
        let mut switches = Vec::new();
        for option in exporter.options() {
            let key = (format.id, option.name());
            let value = self.values.get(&key).cloned().unwrap_or_else(|| option.default_in_words());
            let set = match option {
                FormatOption::Switch(_) => {
                    switches.push((key, value, option.help()));
                    None
                }
                FormatOption::Choice(choice) => line(ui, option.name(), |ui| {
                    let words = choice.words;
                    choose(ui, option.name(), option.help(), words, &value)
                }),
                FormatOption::Number(_) => line(ui, option.name(), |ui| {
                    let mut text = value.clone();
                    let edit = TextEdit::singleline(&mut text).desired_width(72.0).align(Align2::LEFT_CENTER);
                    let response = ui.add(edit).accessible_name(title(option.name()));
                    let is_changed = response.changed();
                    response.on_hover_text(option.help());
                    is_changed.then_some(text)
                }),
            };
            if let Some(set) = set {
                self.values.insert(key, set);
            }
        }
        if !switches.is_empty() {
            line(ui, "Show", |ui| {
                ui.spacing_mut().item_spacing = vec2(6.0, 2.0);
                ui.horizontal_wrapped(|ui| {
                    for (key, value, help) in switches {
                        let is_on = value == "yes";
                        if toggle(ui, &title(key.1), is_on).on_hover_text(help).clicked() {
                            self.values.insert(key, if is_on { "no" } else { "yes" }.to_owned());
                        }
                    }
                });
                None
            });
        }
        ui.add_space(4.0);
        caption(ui, format!("{}.", format.about));
    }

    /// The sheet, or what is known of a format without sheets.
    fn preview(&mut self, ui: &mut Ui, shown: Option<&Result<Shown, String>>, size: Vec2) {
        let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
        let ground = colours(ui).field;
        ui.painter().rect_filled(rect, theme::RADIUS, ground);
        let said = match shown {
            Some(Ok(shown)) => {
                self.paint(ui, rect, shown);
                format!("Preview: {}", shown.words)
            }
            Some(Err(_)) => {
                note(ui, rect, "The plan does not fit this sheet.");
                "Preview: the plan does not fit this sheet".to_owned()
            }
            None if is_sheet(self.format.0) => {
                note(ui, rect, "Drawing the sheet…");
                "Preview: drawing the sheet".to_owned()
            }
            None => {
                let text = format!("{} has no preview: the plan is written at its true size.", self.format.0.name);
                note(ui, rect, &text);
                text
            }
        };
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, &said));
    }

    fn paint(&mut self, ui: &Ui, rect: Rect, shown: &Shown) {
        let is_new = self.texture.as_ref().is_none_or(|(pixels, _)| !Arc::ptr_eq(pixels, &shown.pixels));
        if is_new {
            let texture = ui.ctx().load_texture("sheet", shown.pixels.clone(), TextureOptions::LINEAR);
            self.texture = Some((shown.pixels.clone(), texture));
        }
        let Some((_, texture)) = &self.texture else { return };
        let [width, height] = shown.pixels.size.map(|side| side as f32);
        let room = rect.shrink2(vec2(10.0, 10.0)).with_max_y(rect.bottom() - 28.0);
        let scale = (room.width() / width).min(room.height() / height);
        // On whole pixels: fine lines stay even.
        let on_pixel = |value: f32| (value * ui.pixels_per_point()).round() / ui.pixels_per_point();
        let size = vec2(on_pixel(width * scale), on_pixel(height * scale));
        let left = pos2(on_pixel(room.center().x - size.x / 2.0), on_pixel(room.center().y - size.y / 2.0));
        let sheet = Rect::from_min_size(left, size);
        let all = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
        ui.painter().image(texture.id(), sheet, all, Color32::WHITE);
        ui.painter().rect_stroke(sheet, 0.0, Stroke::new(1.0, colours(ui).outline), StrokeKind::Outside);
        let font = FontId::proportional(theme::SMALL);
        let at = pos2(rect.center().x, rect.bottom() - 12.0);
        ui.painter().text(at, Align2::CENTER_CENTER, &shown.words, font, colours(ui).text_weak);
    }

    fn foot(&mut self, app: &mut App, ui: &mut Ui, problem: Option<String>) -> Option<End> {
        let mut act = None;
        section(ui, "File");
        ui.add_space(2.0);
        ui.horizontal(|ui| {
            let edit = TextEdit::singleline(&mut self.path)
                .id(Id::unique("export path"))
                .desired_width(ui.available_width() - 100.0)
                .align(Align2::LEFT_CENTER);
            let response = ui.add(edit).accessible_name("File");
            self.is_own_path |= response.changed();
            if text_button(ui, "Choose…", false).clicked() {
                let path = self.target(app).unwrap_or_else(|| app.session.export_path(self.format.0));
                app.session.ask_where_to_export(&path);
            }
        });
        let target = self.target(app);
        let exists = target.as_ref().is_some_and(|path| path.is_file());
        let is_own = target.as_ref().zip(app.session.document.as_ref()).is_some_and(|(path, plan)| plan.is_in(path));
        let is_missing_folder = target.as_ref().and_then(|path| path.parent()).is_some_and(|folder| !folder.is_dir());
        let said = match (&problem, &target) {
            (Some(problem), _) => Err(sentence(&format!("{problem}."))),
            (None, None) => Err("Give the file a name.".to_owned()),
            (None, Some(_)) if is_own => {
                Err("This is the plan's own file. Save the plan instead, or choose another name.".to_owned())
            }
            (None, Some(_)) if is_missing_folder => Err("This folder does not exist.".to_owned()),
            (None, Some(path)) if exists => {
                let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
                Ok(format!("{name} exists and will be overwritten."))
            }
            (None, Some(_)) => Ok(String::new()),
        };
        told(ui, &said);
        ui.horizontal(|ui| {
            right(ui, |ui| {
                let title = if exists { "Replace" } else { "Export" };
                let is_done = main_button(ui, title, said.is_ok());
                if let Some(path) = target.filter(|_| is_done) {
                    let values = [Value::Path(path), Value::Text(self.words())];
                    act = Some(End::Do(Call::new("export", values)));
                }
                if text_button(ui, "Cancel", false).clicked() {
                    act = Some(End::Cancel);
                }
            });
        });
        act
    }

    fn print_foot(&self, ui: &mut Ui, problem: Option<String>) -> Option<End> {
        let mut act = None;
        let said =
            match problem {
                Some(problem) => Err(sentence(&format!("{problem}."))),
                None => Ok("Makes a PDF and opens it in your viewer. Print it there at actual size to keep the scale."
                    .to_owned()),
            };
        told(ui, &said);
        ui.horizontal(|ui| {
            right(ui, |ui| {
                if main_button(ui, "Open to print", said.is_ok()) {
                    act = Some(End::Do(Call::new("print", [Value::Text(self.words())])));
                }
                if text_button(ui, "Cancel", false).clicked() {
                    act = Some(End::Cancel);
                }
            });
        });
        act
    }
}

/// What is to be known before, or why it cannot be done.
pub(super) fn told(ui: &mut Ui, said: &Result<String, String>) {
    let (text, colour) = match said {
        Ok(said) => (said, colours(ui).text_weak),
        Err(error) => (error, colours(ui).error),
    };
    ui.add_space(2.0);
    // As high as two lines, so that the buttons stay where they are.
    let height = 34.0;
    let rich = egui::RichText::new(text).size(theme::SMALL).color(colour);
    ui.vertical(|ui| {
        ui.set_min_height(height);
        ui.add(egui::Label::new(rich).wrap());
    });
}

fn note(ui: &Ui, rect: Rect, text: &str) {
    let font = FontId::proportional(theme::BODY);
    let galley = ui.painter().layout(text.to_owned(), font, colours(ui).text_weak, rect.width() - 60.0);
    let at = rect.center() - galley.rect.size() / 2.0;
    ui.painter().galley(at, galley, colours(ui).text_weak);
}

/// The name of an option as people read it: 'Title block'.
fn title(name: &str) -> String {
    match name {
        "dpi" => "Dots per inch".to_owned(),
        "colour" => "Coloured by".to_owned(),
        _ => sentence(&name.replace('-', " ")),
    }
}

/// A line of the form: a caption, and the control in the rest.
fn line(ui: &mut Ui, name: &str, control: impl FnOnce(&mut Ui) -> Option<String>) -> Option<String> {
    ui.horizontal_top(|ui| {
        let (rect, _) = ui.allocate_exact_size(vec2(NAMES, 28.0), Sense::hover());
        let font = FontId::proportional(theme::BODY);
        ui.painter().text(rect.left_center(), Align2::LEFT_CENTER, title(name), font, colours(ui).text_weak);
        ui.vertical(control).inner
    })
    .inner
}

/// A choice of a word: side by side if there are few, else a list.
fn choose(ui: &mut Ui, name: &str, help: &str, words: &[&'static str], value: &str) -> Option<String> {
    const MOST_BESIDE: usize = 5;
    let is_short = words.len() <= MOST_BESIDE && words.iter().map(|word| word.len()).sum::<usize>() <= 30;
    let titles: Vec<String> =
        words.iter().map(|word| if word.contains(':') { (*word).to_owned() } else { sentence(word) }).collect();
    if is_short {
        let segments: Vec<Segment<'_>> = words
            .iter()
            .zip(&titles)
            .map(|(word, title)| Segment { text: title, name: title, help, is_on: *word == value, colour: None })
            .collect();
        return ui.push_id(name, |ui| segmented(ui, &segments)).inner.map(|index| words[index].to_owned());
    }
    let mut chosen = None;
    let current = words.iter().position(|word| *word == value).and_then(|index| titles.get(index));
    let current = current.cloned().unwrap_or_default();
    let list = ComboBox::from_id_salt(("export", name)).width(ui.available_width());
    let shown = list.selected_text(&current).show_ui(ui, |ui| {
        for (word, title) in words.iter().zip(&titles) {
            if ui.selectable_label(*word == value, title).clicked() {
                chosen = Some((*word).to_owned());
            }
        }
    });
    focus_ring(ui, shown.response.rect, &shown.response);
    let said = format!("{}: {current}", title(name));
    shown.response.widget_info(|| WidgetInfo::labeled(Role::ComboBox, true, &said));
    shown.response.on_hover_text(help);
    chosen
}
