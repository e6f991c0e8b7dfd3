//! A field for a length: what is typed is taken with Enter, with Tab, or when the keyboard leaves it; never before,
//! and never in part.

use std::ops::RangeInclusive;

use egui::{Align2, CursorIcon, FontId, Key, Response, Sense, TextEdit, Ui, vec2};

use crate::app::look::{text::select_all, theme, widgets::colours};
use crate::base::units::Units;

/// A length that can be typed, or dragged by its name.
pub(crate) struct LengthField<'a> {
    pub name: &'a str,
    pub now_m: f64,
    pub range_m: RangeInclusive<f64>,
    pub units: Units,
    /// Width of the field in points.
    pub width: f32,
    /// Width that the name takes, in points; as it comes without.
    pub name_width: Option<f32>,
}

/// What became of a field in a frame.
#[derive(Default)]
pub(crate) struct Entered {
    /// A new length in metres.
    pub length_m: Option<f64>,
    /// Why what stands in the field is not taken; empty while nothing is wrong.
    pub refused: String,
}

/// What is being typed.
#[derive(Clone, Default, PartialEq)]
struct Draft {
    text: String,
    refused: String,
    /// What the field is about: with another length or in other units it is forgotten.
    about: String,
}

/// A length grows by so much for a point of the way that its name is dragged, in metres.
const DRAG_M_PER_POINT: f64 = 0.005;

impl LengthField<'_> {
    /// Shows the name and the field behind it.
    pub(crate) fn show(self, ui: &mut Ui) -> Entered {
        self.show_in(ui, false).0
    }

    /// The same; gives the field, too, which may be told to take the keyboard.
    pub(crate) fn show_in(self, ui: &mut Ui, takes_focus: bool) -> (Entered, Response) {
        let Self { name, now_m, range_m, units, width, name_width } = self;
        // Painted, so that of two controls of one name the field is the one that is told of.
        let font = FontId::proportional(theme::BODY);
        let text = ui.painter().layout_no_wrap(name.to_owned(), font, colours(ui).text_weak);
        let size = vec2(name_width.unwrap_or(text.size().x), text.size().y);
        let (rect, label) = ui.allocate_exact_size(size, Sense::DRAG);
        ui.painter().galley(rect.min, text, colours(ui).text_weak);
        let label = label.on_hover_cursor(CursorIcon::ResizeHorizontal);
        let mut entered = Entered::default();
        if label.dragged() {
            let by_m = f64::from(label.drag_delta().x) * DRAG_M_PER_POINT;
            let dragged_m = (now_m + by_m).clamp(*range_m.start(), *range_m.end());
            entered.length_m = Some(dragged_m).filter(|dragged_m| *dragged_m != now_m);
        }
        let id = ui.scope_id().with(("length", name));
        let shown = units.exact_length(now_m);
        let draft: Option<Draft> = ui.data(|data| data.get_temp(id)).filter(|draft: &Draft| draft.about == shown);
        let mut draft =
            draft.unwrap_or_else(|| Draft { text: shown.clone(), about: shown.clone(), ..Draft::default() });
        let ink = if draft.refused.is_empty() { colours(ui).text } else { colours(ui).error };
        let edit = TextEdit::singleline(&mut draft.text).id(id).desired_width(width).text_color(ink);
        let response = ui.add(edit.align(Align2::LEFT_CENTER)).accessible_name(name);
        if takes_focus {
            response.request_focus();
            select_all(ui.ctx(), id, &draft.text);
        }
        if response.gained_focus() {
            select_all(ui.ctx(), id, &draft.text);
        }
        if response.changed() {
            draft.refused.clear();
        }
        if response.lost_focus() {
            let was_pressed = |key: Key| ui.input(|input| input.key_pressed(key));
            if was_pressed(Key::Escape) || draft.text.trim() == shown {
                draft = Draft::default();
            } else {
                match read(&draft.text, units, &range_m) {
                    Ok(length_m) => {
                        entered.length_m = Some(length_m);
                        draft = Draft::default();
                    }
                    Err(why) => {
                        draft.refused = format!("{name}: {why}");
                        // To be mended where it stands.
                        if was_pressed(Key::Enter) {
                            response.request_focus();
                        }
                    }
                }
            }
        }
        entered.refused.clone_from(&draft.refused);
        ui.data_mut(|data| match draft.about.is_empty() {
            true => data.remove::<Draft>(id),
            false => drop(data.insert_temp(id, draft)),
        });
        (entered, response)
    }
}

/// A length in metres.
fn read(text: &str, units: Units, range_m: &RangeInclusive<f64>) -> Result<f64, String> {
    let length_m = units.parse_length(text).map_err(|error| error.to_string())?;
    if range_m.contains(&length_m) {
        return Ok(length_m);
    }
    let [least, most] = [range_m.start(), range_m.end()].map(|end| units.exact_length(*end));
    Err(format!("{} is not from {least} to {most}", units.exact_length(length_m)))
}
