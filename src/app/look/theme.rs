//! The window's own design: colours, type, spacing, radii; light and dark.

use std::sync::Arc;

use egui::epaint::text::{FontData, FontTweak};
use egui::epaint::{CornerRadius, Margin, Shadow};
use egui::style::{ScrollAnimation, ScrollStyle, Selection, WidgetVisuals, Widgets};
use egui::{Color32, Context, FontDefinitions, FontFamily, FontId, Stroke, Style, TextStyle, Theme, Visuals, vec2};

use crate::draw::{self, LabelColours, Palette, Rgba, font};

/// Size of room names on the canvas, in points.
pub(crate) const PLAN_TEXT: f64 = 12.5;

/// Which theme is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ThemeChoice {
    /// As the system.
    #[default]
    System,
    Light,
    Dark,
}

impl ThemeChoice {
    /// Its word in the settings.
    pub(crate) const fn word(self) -> &'static str {
        match self {
            Self::System => "system",
            Self::Light => "light",
            Self::Dark => "dark",
        }
    }

    /// The choice with a word.
    pub(crate) fn of_word(word: &str) -> Option<Self> {
        [Self::System, Self::Light, Self::Dark].into_iter().find(|choice| choice.word() == word)
    }

    /// Applies it to egui.
    pub(crate) fn apply(self, context: &Context) {
        context.set_theme(match self {
            Self::System => egui::ThemePreference::System,
            Self::Light => egui::ThemePreference::Light,
            Self::Dark => egui::ThemePreference::Dark,
        });
    }
}

/// Whether there are animations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Motion {
    Smooth,
    /// Nothing moves and the cursor does not blink: snapshots do not depend on their timing.
    Still,
}

/// The colours of the window. Those of the plan come from [`crate::draw`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Colours {
    /// Background of panels.
    pub panel: Color32,
    /// Background of fields and chips.
    pub field: Color32,
    /// Background of popups and dialogs.
    pub raised: Color32,
    /// Background under the pointer.
    pub hover: Color32,
    /// Background when pressed.
    pub pressed: Color32,
    /// Hairlines between panels.
    pub border: Color32,
    /// Outlines of fields and popups.
    pub outline: Color32,
    pub text: Color32,
    /// Secondary text; readable on `panel`, `field` and `raised` (contrast 4.5 or more).
    pub text_weak: Color32,
    /// Marks the selection and the main action.
    pub accent: Color32,
    pub on_accent: Color32,
    /// Background of the selected row in a list.
    pub accent_soft: Color32,
    pub error: Color32,
    pub error_soft: Color32,
    pub warning: Color32,
    pub warning_soft: Color32,
    pub info_soft: Color32,
    pub shadow: Color32,
}

const LIGHT_PLAN: &Palette = Palette::of(draw::Theme::Light, LabelColours::Standard);
const DARK_PLAN: &Palette = Palette::of(draw::Theme::Dark, LabelColours::Standard);

const LIGHT: Colours = Colours {
    panel: hex(0xf7f8f9),
    field: hex(0xeceef1),
    raised: hex(0xffffff),
    hover: hex(0xeaecf0),
    pressed: hex(0xdfe3e8),
    border: hex(0xe1e4e8),
    outline: hex(0xd3d7dd),
    text: opaque(LIGHT_PLAN.ink),
    text_weak: hex(0x5c6370),
    accent: opaque(LIGHT_PLAN.selection),
    on_accent: hex(0xffffff),
    accent_soft: hex(0xdceafa),
    error: hex(0xb3261e),
    error_soft: hex(0xfdeceb),
    warning: hex(0x8a5200),
    warning_soft: hex(0xfdf2dc),
    info_soft: hex(0xe6f0fb),
    shadow: Color32::from_black_alpha(30),
};

const DARK: Colours = Colours {
    panel: hex(0x1c2026),
    field: hex(0x292e36),
    raised: hex(0x252a32),
    hover: hex(0x2a3038),
    pressed: hex(0x363d48),
    border: hex(0x2b3139),
    outline: hex(0x3b424d),
    text: opaque(DARK_PLAN.ink),
    text_weak: hex(0xa5adb9),
    accent: opaque(DARK_PLAN.selection),
    on_accent: hex(0x10151b),
    accent_soft: hex(0x1d3a57),
    error: hex(0xff8a80),
    error_soft: hex(0x43211f),
    warning: hex(0xf2c066),
    warning_soft: hex(0x3d3118),
    info_soft: hex(0x1f3348),
    shadow: Color32::from_black_alpha(120),
};

/// An opaque colour from its CSS digits.
const fn hex(rgb: u32) -> Color32 {
    Color32::from_rgb((rgb >> 16) as u8, (rgb >> 8) as u8, rgb as u8)
}

/// An opaque colour of the plan's palette.
const fn opaque(rgba: Rgba) -> Color32 {
    Color32::from_rgb(rgba.r, rgba.g, rgba.b)
}

/// The colours of the current theme.
pub(crate) fn colours(visuals: &Visuals) -> &'static Colours {
    if visuals.dark_mode { &DARK } else { &LIGHT }
}

/// A colour of the plan's drawing, for egui.
pub(crate) fn colour(rgba: Rgba) -> Color32 {
    Color32::from_rgba_unmultiplied(rgba.r, rgba.g, rgba.b, rgba.a)
}

/// The font family of the semibold weight.
pub(crate) fn semibold() -> FontFamily {
    FontFamily::Name("semibold".into())
}

/// Body text, in points.
pub(crate) const BODY: f32 = 13.0;
/// Secondary text.
pub(crate) const SMALL: f32 = 11.5;
/// Title of the selection.
pub(crate) const TITLE: f32 = 15.0;
/// The welcome.
pub(crate) const DISPLAY: f32 = 24.0;

/// Radius of buttons, fields and rows, in points.
pub(crate) const RADIUS: u8 = 6;
/// Radius of popups and dialogs.
pub(crate) const RADIUS_LARGE: u8 = 10;

/// Sets fonts, styles and behaviour of a context.
pub(crate) fn install(context: &Context, motion: Motion) {
    context.set_fonts(fonts());
    context.set_style_of(Theme::Light, style(&LIGHT, false, motion));
    context.set_style_of(Theme::Dark, style(&DARK, true, motion));
    context.options_mut(|options| {
        options.fallback_theme = Theme::Light;
        // Commands use these keys.
        options.zoom_with_keyboard = false;
        options.quit_shortcuts.clear();
        options.warn_on_id_clash = cfg!(debug_assertions);
    });
}

fn fonts() -> FontDefinitions {
    let mut fonts = FontDefinitions::empty();
    let mut add = |name: &str, bytes: &'static [u8]| {
        let data = FontData::from_static(bytes).tweak(FontTweak::default());
        fonts.font_data.insert(name.to_owned(), Arc::new(data));
    };
    add("Inter", font::REGULAR);
    add("Inter SemiBold", font::SEMIBOLD);
    for family in [FontFamily::Proportional, FontFamily::Monospace] {
        fonts.families.insert(family, vec!["Inter".to_owned()]);
    }
    fonts.families.insert(semibold(), vec!["Inter SemiBold".to_owned()]);
    fonts
}

fn style(colours: &Colours, dark: bool, motion: Motion) -> Style {
    let mut style = Style { visuals: visuals(colours, dark), ..Style::default() };
    style.text_styles = [
        (TextStyle::Small, FontId::proportional(SMALL)),
        (TextStyle::Body, FontId::proportional(BODY)),
        (TextStyle::Button, FontId::proportional(BODY)),
        (TextStyle::Monospace, FontId::proportional(BODY)),
        (TextStyle::Heading, FontId::new(TITLE, semibold())),
    ]
    .into();
    let spacing = &mut style.spacing;
    spacing.item_spacing = vec2(8.0, 6.0);
    spacing.button_padding = vec2(10.0, 4.0);
    spacing.interact_size = vec2(28.0, 28.0);
    spacing.menu_margin = Margin::same(5);
    spacing.menu_width = 260.0;
    spacing.window_margin = Margin::same(20);
    spacing.icon_spacing = 6.0;
    spacing.tooltip_width = 320.0;
    spacing.scroll = ScrollStyle { bar_width: 8.0, floating_width: 4.0, ..ScrollStyle::floating() };
    spacing.scroll.fade.size = 16.0;
    style.interaction.selectable_labels = false;
    style.interaction.tooltip_delay = 0.45;
    style.wrap_mode = None;
    style.compact_menu_style = false;
    style.scroll_animation = ScrollAnimation::none();
    match motion {
        Motion::Smooth => style.animation_time = 0.08,
        Motion::Still => {
            style.animation_time = 0.0;
            style.visuals.text_cursor.blink = false;
        }
    }
    style
}

fn visuals(colours: &Colours, dark: bool) -> Visuals {
    let base = if dark { Visuals::dark() } else { Visuals::light() };
    let radius = CornerRadius::same(RADIUS);
    let widget = |fill: Color32, stroke: Color32, text: Color32| WidgetVisuals {
        bg_fill: fill,
        weak_bg_fill: fill,
        bg_stroke: Stroke::new(1.0, stroke),
        corner_radius: radius,
        fg_stroke: Stroke::new(1.0, text),
        expansion: 0.0,
    };
    let mut visuals = Visuals {
        widgets: Widgets {
            noninteractive: widget(colours.panel, colours.border, colours.text),
            inactive: widget(colours.raised, colours.outline, colours.text),
            hovered: widget(colours.hover, colours.outline, colours.text),
            active: widget(colours.pressed, colours.accent, colours.text),
            open: widget(colours.hover, colours.outline, colours.text),
        },
        selection: Selection { bg_fill: colours.accent_soft, stroke: Stroke::new(1.5, colours.accent) },
        hyperlink_color: colours.accent,
        faint_bg_color: colours.field,
        extreme_bg_color: colours.field,
        text_edit_bg_color: Some(colours.field),
        code_bg_color: colours.field,
        warn_fg_color: colours.warning,
        error_fg_color: colours.error,
        weak_text_color: Some(colours.text_weak),
        window_corner_radius: CornerRadius::same(RADIUS_LARGE),
        window_fill: colours.raised,
        window_stroke: Stroke::new(1.0, colours.outline),
        window_shadow: Shadow { offset: [0, 12], blur: 36, spread: 0, color: colours.shadow },
        popup_shadow: Shadow { offset: [0, 4], blur: 16, spread: 0, color: colours.shadow },
        menu_corner_radius: CornerRadius::same(RADIUS + 2),
        panel_fill: colours.panel,
        ..base
    };
    visuals.text_cursor.stroke = Stroke::new(1.5, colours.accent);
    visuals.disabled_alpha = 0.45;
    visuals
}

#[cfg(test)]
mod tests {
    use crate::app::look::theme::*;

    fn rgba(colour: Color32) -> Rgba {
        Rgba { r: colour.r(), g: colour.g(), b: colour.b(), a: 255 }
    }

    /// Text of 13 points needs a contrast of 4.5 (Web Content Accessibility Guidelines 2.1, AA).
    #[test]
    fn text_is_readable_on_every_ground() {
        for colours in [LIGHT, DARK] {
            let grounds = [colours.panel, colours.field, colours.raised, colours.hover, colours.accent_soft];
            for ground in grounds {
                for text in [colours.text, colours.text_weak] {
                    let contrast = rgba(text).contrast(rgba(ground));
                    assert!(contrast >= 4.5, "{text:?} on {ground:?}: {contrast:.2}");
                }
            }
            for (text, ground) in [
                (colours.on_accent, colours.accent),
                (colours.error, colours.error_soft),
                (colours.warning, colours.warning_soft),
                (colours.text, colours.error_soft),
                (colours.accent, colours.panel),
            ] {
                let contrast = rgba(text).contrast(rgba(ground));
                assert!(contrast >= 4.5, "{text:?} on {ground:?}: {contrast:.2}");
            }
        }
    }
}
