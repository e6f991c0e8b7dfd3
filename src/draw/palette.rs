//! The single definition of all colours, for window, PNG and SVG.

use std::collections::BTreeMap;

use super::Rgba;
use crate::features::RoomStatus;
use crate::labels::{Colour, Label, normalised_function};

/// Dark on light, or light on dark.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Theme {
    #[default]
    Light,
    Dark,
}

impl Theme {
    pub const ALL: [Self; 2] = [Self::Light, Self::Dark];

    /// Its name on the command line and in the interface.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Light => "light",
            Self::Dark => "dark",
        }
    }
}

/// The five colours used for the labels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum LabelColours {
    /// The paper's (Fig. 1): corridor green, small room yellow, medium room brown, big room red; we added
    /// blue for the hall.
    #[default]
    Standard,
    /// Distinguishable with any kind of colour blindness: based on Okabe and Ito (2008), 'Color universal
    /// design', with lightness spread further.
    ColourBlindSafe,
}

impl LabelColours {
    pub const ALL: [Self; 2] = [Self::Standard, Self::ColourBlindSafe];

    /// Its name on the command line and in the interface.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Standard => "standard",
            Self::ColourBlindSafe => "colour-blind-safe",
        }
    }
}

/// All colours of a theme.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Palette {
    pub theme: Theme,
    /// The background.
    pub paper: Rgba,
    /// Names, title.
    pub ink: Rgba,
    /// Areas, legend, scale.
    pub ink_muted: Rgba,
    /// Behind letters on a busy background (a backdrop).
    pub halo: Rgba,
    /// Walls cut by the plan (poché).
    pub wall: Rgba,
    /// A room's boundary without a wall, railings, thresholds, a passage's lintel.
    pub boundary: Rgba,
    /// A door's leaf, a window's frame.
    pub leaf: Rgba,
    /// The arc of a door's swing.
    pub swing: Rgba,
    /// A window's panes.
    pub glass: Rgba,
    pub grid: Rgba,
    /// Every fifth or tenth line of the grid.
    pub grid_major: Rgba,
    pub graph_edge: Rgba,
    /// A graph node; its rim is `paper`.
    pub graph_node: Rgba,
    /// A selected element.
    pub selection: Rgba,
    /// The element under the pointer.
    pub hover: Rgba,
    /// The marker of a snap target.
    pub snap: Rgba,
    /// `check` findings that must be fixed.
    pub error: Rgba,
    /// `check` findings worth a look.
    pub warning: Rgba,
    /// `check` findings for information.
    pub info: Rgba,
    /// Fill of a room without a label.
    pub unlabelled: Rgba,
    /// Fill of a room that the scheme leaves blank.
    pub not_classified: Rgba,
    /// Fills by label, in the order of [`Label::ALL`]; `ink` is legible on all of them.
    pub labels: [Rgba; 5],
    /// The same hues, strong enough for dots, lines and small markers on `paper`.
    pub labels_strong: [Rgba; 5],
    functions: [Rgba; FUNCTION_COLOURS],
}

impl Palette {
    pub const fn of(theme: Theme, labels: LabelColours) -> &'static Self {
        match (theme, labels) {
            (Theme::Light, LabelColours::Standard) => &LIGHT,
            (Theme::Light, LabelColours::ColourBlindSafe) => &LIGHT_SAFE,
            (Theme::Dark, LabelColours::Standard) => &DARK,
            (Theme::Dark, LabelColours::ColourBlindSafe) => &DARK_SAFE,
        }
    }

    /// Fill of rooms with a label.
    pub const fn label(&self, label: Label) -> Rgba {
        self.labels[label.index()]
    }

    /// Colour of dots and lines for a label.
    pub const fn label_strong(&self, label: Label) -> Rgba {
        self.labels_strong[label.index()]
    }

    /// Fill of a room by the status of its label.
    pub const fn status(&self, status: RoomStatus) -> Rgba {
        match status {
            RoomStatus::Labelled(label) => self.label(label),
            RoomStatus::NotClassified => self.not_classified,
            RoomStatus::Unlabelled => self.unlabelled,
        }
    }

    /// Fills by function, keyed by [`normalised_function`]. A function's colour is derived from its name,
    /// so that it is the same in most plans; if two in one plan collide, the alphabetically later one
    /// takes the next free colour. Colours repeat only in plans with more than 24 functions. The empty
    /// function is left out.
    pub fn functions<'a>(&self, functions: impl IntoIterator<Item = &'a str>) -> BTreeMap<String, Rgba> {
        let mut slots: BTreeMap<String, usize> = BTreeMap::new();
        for function in functions {
            let key = normalised_function(function);
            if !key.is_empty() {
                slots.insert(key, 0);
            }
        }
        let mut taken = [false; FUNCTION_COLOURS];
        for (function, slot) in &mut slots {
            if taken.iter().all(|&taken| taken) {
                taken = [false; FUNCTION_COLOURS];
            }
            let wanted = (crate::plan::name_bits(function) % FUNCTION_COLOURS as u64) as usize;
            let free = (0..FUNCTION_COLOURS).map(|step| (wanted + step) % FUNCTION_COLOURS).find(|&slot| !taken[slot]);
            *slot = free.unwrap_or(wanted);
            taken[*slot] = true;
        }
        slots.into_iter().map(|(function, slot)| (function, self.functions[slot])).collect()
    }
}

impl Palette {
    /// A colour that somebody chose, as near to it as `ink` is legible on.
    pub fn legible(&self, [r, g, b]: Colour) -> Rgba {
        let chosen = Rgba { r, g, b, a: 255 };
        let steps = (0..=20).map(|step| chosen.mixed(self.paper, f64::from(step) / 20.0));
        steps.into_iter().find(|colour| self.ink.contrast(*colour) >= 5.0).unwrap_or(self.paper)
    }
}

const FUNCTION_COLOURS: usize = 24;

/// Fills of labels on paper. In Oklab (Ottosson 2020) the standard ones have lightness 0.80 to 0.94 and
/// chroma 0.05 to 0.08; the safe ones were found by maximising the minimum difference under simulated
/// protanopia, deuteranopia and tritanopia (Machado et al. 2009). The tests below enforce both.
const LIGHT_LABELS: [Rgba; 5] =
    [Rgba::hex(0xfb_f1b6), Rgba::hex(0xde_c09e), Rgba::hex(0xf9_bbb4), Rgba::hex(0xc3_ebca), Rgba::hex(0xbb_dcf8)];
const LIGHT_STRONG: [Rgba; 5] =
    [Rgba::hex(0xa1_8400), Rgba::hex(0x8f_5f30), Rgba::hex(0xd3_3a3c), Rgba::hex(0x2a_904b), Rgba::hex(0x0f_74c5)];
const LIGHT_LABELS_SAFE: [Rgba; 5] =
    [Rgba::hex(0xf4_f2bb), Rgba::hex(0xfe_c766), Rgba::hex(0xdf_8661), Rgba::hex(0x68_c1aa), Rgba::hex(0xbc_e5ff)];
/// Okabe and Ito's own, darkened where they would be invisible on white.
const LIGHT_STRONG_SAFE: [Rgba; 5] =
    [Rgba::hex(0xa8_9c00), Rgba::hex(0xe6_9f00), Rgba::hex(0xb8_4a00), Rgba::hex(0x00_7a59), Rgba::hex(0x38_9fdc)];
const DARK_LABELS: [Rgba; 5] =
    [Rgba::hex(0x63_5a28), Rgba::hex(0x4f_3a2a), Rgba::hex(0x74_343a), Rgba::hex(0x29_523a), Rgba::hex(0x25_4a72)];
const DARK_STRONG: [Rgba; 5] =
    [Rgba::hex(0xe8_cf4a), Rgba::hex(0xc9_966a), Rgba::hex(0xf0_6a66), Rgba::hex(0x5f_c97f), Rgba::hex(0x5a_a9f0)];
const DARK_LABELS_SAFE: [Rgba; 5] =
    [Rgba::hex(0x69_6602), Rgba::hex(0x76_532e), Rgba::hex(0x5a_1a02), Rgba::hex(0x20_4234), Rgba::hex(0x31_5c8a)];
const DARK_STRONG_SAFE: [Rgba; 5] =
    [Rgba::hex(0xf0_e442), Rgba::hex(0xe6_9f00), Rgba::hex(0xe0_6a1a), Rgba::hex(0x1f_b88d), Rgba::hex(0x7c_c8f5)];

const LIGHT: Palette = Palette {
    theme: Theme::Light,
    paper: Rgba::hex(0xff_ffff),
    ink: Rgba::hex(0x1c_2026),
    ink_muted: Rgba::hex(0x4f_5661),
    halo: Rgba::hex(0xff_ffff).with_alpha(0xd8),
    wall: Rgba::hex(0x2b_3038),
    boundary: Rgba::hex(0x80_8791),
    leaf: Rgba::hex(0x2b_3038),
    swing: Rgba::hex(0x7c_838d),
    glass: Rgba::hex(0x4a_8fc0),
    grid: Rgba::hex(0xea_ecef),
    grid_major: Rgba::hex(0xd7_dbe0),
    graph_edge: Rgba::hex(0x3b_3f8f),
    graph_node: Rgba::hex(0x3b_3f8f),
    selection: Rgba::hex(0x0b_6bcb),
    hover: Rgba::hex(0x58_a6ee),
    snap: Rgba::hex(0xd0_1c8b),
    error: Rgba::hex(0xc6_2828),
    warning: Rgba::hex(0xb2_6a00),
    info: Rgba::hex(0x15_65a8),
    unlabelled: Rgba::hex(0xec_edf0),
    not_classified: Rgba::hex(0xf6_f6f4),
    labels: LIGHT_LABELS,
    labels_strong: LIGHT_STRONG,
    functions: LIGHT_FUNCTIONS,
};

const LIGHT_SAFE: Palette = Palette { labels: LIGHT_LABELS_SAFE, labels_strong: LIGHT_STRONG_SAFE, ..LIGHT };

const DARK: Palette = Palette {
    theme: Theme::Dark,
    paper: Rgba::hex(0x15_181d),
    ink: Rgba::hex(0xee_f1f5),
    ink_muted: Rgba::hex(0xb4_bbc6),
    halo: Rgba::hex(0x15_181d).with_alpha(0xd8),
    wall: Rgba::hex(0xb6_bdc8),
    boundary: Rgba::hex(0x7d_8591),
    leaf: Rgba::hex(0xb6_bdc8),
    swing: Rgba::hex(0x86_8e9a),
    glass: Rgba::hex(0x7f_bfe8),
    grid: Rgba::hex(0x21_252c),
    grid_major: Rgba::hex(0x2e_343d),
    graph_edge: Rgba::hex(0xb9_b5ff),
    graph_node: Rgba::hex(0xb9_b5ff),
    selection: Rgba::hex(0x5c_b3ff),
    hover: Rgba::hex(0x2f_7fc4),
    snap: Rgba::hex(0xff_6ac1),
    error: Rgba::hex(0xff_7369),
    warning: Rgba::hex(0xf0_b040),
    info: Rgba::hex(0x64_b5f6),
    unlabelled: Rgba::hex(0x2b_3037),
    not_classified: Rgba::hex(0x1f_2329),
    labels: DARK_LABELS,
    labels_strong: DARK_STRONG,
    functions: DARK_FUNCTIONS,
};

const DARK_SAFE: Palette = Palette { labels: DARK_LABELS_SAFE, labels_strong: DARK_STRONG_SAFE, ..DARK };

/// 24 Oklab hues, 15 degrees apart, alternating in lightness (0.89 and 0.82, chroma 0.075), ordered so
/// that neighbours in the table are seven steps apart.
const LIGHT_FUNCTIONS: [Rgba; FUNCTION_COLOURS] = table([
    0xff_c7cf, 0xc2_ca96, 0xa2_e7fd, 0xdc_b5dd, 0xfb_d3a5, 0x94_d3c1, 0xd0_d6ff, 0xee_b3ad, 0xca_e5b1, 0x98_cceb,
    0xfe_c8ea, 0xd9_c190, 0xa0_ebe6, 0xc7_bced, 0xff_cbb6, 0xa8_d1a9, 0xb6_dfff, 0xea_b2c6, 0xe6_dda3, 0x8d_d2da,
    0xea_ceff, 0xe9_b999, 0xb0_ebca, 0xae_c4f3,
]);

/// The same hues at lightness 0.43 and 0.35, chroma 0.07 and 0.06.
const DARK_FUNCTIONS: [Rgba; FUNCTION_COLOURS] = table([
    0x71_3f47, 0x3a_3e16, 0x15_586a, 0x4a_2f4c, 0x68_4821, 0x0c_4539, 0x48_4b76, 0x56_2d2a, 0x43_572d, 0x15_3f55,
    0x69_405c, 0x49_3810, 0x0e_5c58, 0x3d_3456, 0x70_4232, 0x25_4326, 0x30_5275, 0x53_2d3c, 0x59_511e, 0x00_4349,
    0x5c_456d, 0x52_311a, 0x28_5c42, 0x2b_3a5a,
]);

const fn table(values: [u32; FUNCTION_COLOURS]) -> [Rgba; FUNCTION_COLOURS] {
    let mut colours = [Rgba::hex(0); FUNCTION_COLOURS];
    let mut i = 0;
    while i < FUNCTION_COLOURS {
        colours[i] = Rgba::hex(values[i]);
        i += 1;
    }
    colours
}

#[cfg(test)]
mod tests {
    use super::super::colour::linear;
    use super::*;

    fn all() -> impl Iterator<Item = &'static Palette> {
        Theme::ALL.into_iter().flat_map(|theme| LabelColours::ALL.map(|labels| Palette::of(theme, labels)))
    }

    #[test]
    fn text_is_legible_on_every_fill() {
        // 4.5: level AA of the Web Content Accessibility Guidelines for small text.
        for palette in all() {
            let grounds = palette.labels.iter().chain(&palette.functions).chain([
                &palette.paper,
                &palette.unlabelled,
                &palette.not_classified,
            ]);
            for &ground in grounds {
                assert!(palette.ink.contrast(ground) >= 5.0, "ink on {} of {:?}", ground.css(), palette.theme);
            }
            assert!(palette.ink_muted.contrast(palette.paper) >= 4.5);
        }
    }

    #[test]
    fn marks_are_seen_on_paper() {
        // 3: the same guidelines, for graphical objects. In the safe palette, being distinguishable takes
        // priority over this for orange and yellow.
        for palette in all() {
            for colour in [palette.wall, palette.swing, palette.graph_edge, palette.selection, palette.error] {
                assert!(colour.contrast(palette.paper) >= 3.0, "{} of {:?}", colour.css(), palette.theme);
            }
            for &colour in &palette.labels_strong {
                assert!(colour.contrast(palette.paper) >= 2.2, "{} of {:?}", colour.css(), palette.theme);
            }
        }
    }

    /// Full colour blindness of each kind as matrices on linear light (Machado, Oliveira, Fernandes
    /// 2009, table 1, severity 1.0); the identity first.
    const VISION: [[[f64; 3]; 3]; 4] = [
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
        [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]],
        [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900]],
    ];

    /// CIE L*a*b* (D65) of a colour as seen with this kind of vision.
    fn lab(colour: Rgba, vision: &[[f64; 3]; 3]) -> [f64; 3] {
        let rgb = [colour.r, colour.g, colour.b].map(linear);
        let [r, g, b] =
            vision.map(|row| row.iter().zip(rgb).map(|(weight, c)| weight * c).sum::<f64>().clamp(0.0, 1.0));
        let f = |t: f64| if t > 216.0 / 24389.0 { t.cbrt() } else { (24389.0 / 27.0 * t + 16.0) / 116.0 };
        let x = f((0.4124 * r + 0.3576 * g + 0.1805 * b) / 0.95047);
        let y = f(0.2126 * r + 0.7152 * g + 0.0722 * b);
        let z = f((0.0193 * r + 0.1192 * g + 0.9505 * b) / 1.08883);
        [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
    }

    fn smallest_difference(colours: &[Rgba], vision: &[[f64; 3]; 3]) -> f64 {
        let labs: Vec<[f64; 3]> = colours.iter().map(|&colour| lab(colour, vision)).collect();
        let mut least = f64::INFINITY;
        for (i, p) in labs.iter().enumerate() {
            for q in &labs[..i] {
                least = least.min(p.iter().zip(q).map(|(p, q)| (p - q) * (p - q)).sum::<f64>().sqrt());
            }
        }
        least
    }

    #[test]
    fn labels_are_told_apart_by_every_eye_in_the_safe_palette() {
        // A difference of 2.3 is just noticeable (Mahy et al. 1994); 15 is obvious across a picture.
        for theme in Theme::ALL {
            let safe = Palette::of(theme, LabelColours::ColourBlindSafe);
            for vision in &VISION {
                let difference = smallest_difference(&safe.labels, vision);
                assert!(difference >= 15.0, "{theme:?}: {difference}");
            }
            let standard = Palette::of(theme, LabelColours::Standard);
            assert!(smallest_difference(&standard.labels, &VISION[0]) >= 17.0, "{theme:?}");
        }
    }

    #[test]
    fn functions_of_a_plan_have_different_colours_that_follow_from_their_names() {
        let palette = Palette::of(Theme::Light, LabelColours::Standard);
        let names: Vec<String> = (0..24).map(|i| format!("Function {i}")).collect();
        let colours = palette.functions(names.iter().map(String::as_str));
        let distinct: std::collections::BTreeSet<Rgba> = colours.values().copied().collect();
        assert_eq!(distinct.len(), 24);
        let alone = palette.functions(["KITCHEN", "kitchen", ""]);
        assert_eq!(alone.len(), 1);
        assert_eq!(alone["kitchen"], palette.functions(["kitchen"])["kitchen"]);
    }
}
