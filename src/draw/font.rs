//! The bundled font: Inter 3.19, SIL Open Font License 1.1 (`assets/fonts/Inter.OFL.txt`). The window and
//! exported pictures use it, so that text looks the same on every machine.

use std::sync::OnceLock;

use ttf_parser::{Face, GlyphId, OutlineBuilder};

use super::scene::Weight;

/// The bytes of Inter Regular, for the window.
pub const REGULAR: &[u8] = include_bytes!("../../assets/fonts/Inter-Regular.otf");

/// The bytes of Inter SemiBold, for the window.
pub const SEMIBOLD: &[u8] = include_bytes!("../../assets/fonts/Inter-SemiBold.otf");

/// Height of capitals, as a fraction of the font size (Inter's OS/2 table: 2048 of 2816).
pub const CAP_HEIGHT: f64 = 0.727;

/// Depth of the longest descender below the baseline, as a fraction of the font size.
pub const DESCENT: f64 = 0.21;

/// Baseline to baseline, as a fraction of the font size: tight, since a room has few lines of text.
pub const LINE_HEIGHT: f64 = 1.22;

/// A step of a glyph's outline, in fractions of the font size, x to the right and y up from the origin on
/// the baseline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step {
    Move(f32, f32),
    Line(f32, f32),
    Quad(f32, f32, f32, f32),
    Cubic(f32, f32, f32, f32, f32, f32),
    Close,
}

/// A weight of the bundled font.
pub struct Font {
    face: Option<Face<'static>>,
    units_per_em: f32,
    /// Advances of the ASCII characters, which are most of what is measured.
    ascii: [f32; 128],
}

impl Font {
    /// The font with this weight.
    pub fn of(weight: Weight) -> &'static Self {
        static FONTS: OnceLock<[Font; 2]> = OnceLock::new();
        let fonts = FONTS.get_or_init(|| {
            [REGULAR, SEMIBOLD].map(|bytes| {
                // The bundled bytes parse (tested); if they were broken, text would be boxes.
                let face = Face::parse(bytes, 0).ok();
                let units_per_em = face.as_ref().map_or(1000.0, |face| f32::from(face.units_per_em()));
                let mut font = Font { face, units_per_em, ascii: [0.0; 128] };
                font.ascii = std::array::from_fn(|code| font.looked_up_advance(code as u8 as char));
                font
            })
        });
        match weight {
            Weight::Regular => &fonts[0],
            Weight::SemiBold => &fonts[1],
        }
    }

    /// Whether the font has a glyph for a character; others are drawn as boxes.
    pub fn has(&self, character: char) -> bool {
        self.glyph(character).is_some()
    }

    /// Width of a text in pixels at a font size in pixels. No kerning, no ligatures: so every painter can
    /// place a text the same way.
    pub fn width_px(&self, text: &str, size_px: f64) -> f64 {
        text.chars().map(|character| f64::from(self.advance(character))).sum::<f64>() * size_px
    }

    /// The advance width of a character, in fractions of the font size.
    pub fn advance(&self, character: char) -> f32 {
        self.ascii.get(character as usize).copied().unwrap_or_else(|| self.looked_up_advance(character))
    }

    fn looked_up_advance(&self, character: char) -> f32 {
        let advance = self.glyph(character).and_then(|glyph| self.face.as_ref()?.glyph_hor_advance(glyph));
        advance.map_or(BOX_ADVANCE, |units| f32::from(units) / self.units_per_em)
    }

    /// The outline of a character; a box if the font does not have it.
    pub fn outline(&self, character: char) -> Vec<Step> {
        let Some((face, glyph)) = self.face.as_ref().zip(self.glyph(character)) else { return missing_glyph() };
        let mut outline = Outline { steps: Vec::new(), scale: 1.0 / self.units_per_em };
        // `None` for a glyph without an outline, such as a space.
        let _ = face.outline_glyph(glyph, &mut outline);
        outline.steps
    }

    /// The number of a character's glyph in the font file; `None` if the font does not have it.
    pub(super) fn glyph_number(&self, character: char) -> Option<u16> {
        self.glyph(character).map(|glyph| glyph.0)
    }

    fn glyph(&self, character: char) -> Option<GlyphId> {
        self.face.as_ref()?.glyph_index(character)
    }
}

const BOX_ADVANCE: f32 = 0.68;

/// The box drawn for a character the font does not have ('tofu').
fn missing_glyph() -> Vec<Step> {
    let frame = |inset: f32| {
        let (left, right, bottom, top) = (0.06 + inset, BOX_ADVANCE - 0.06 - inset, inset, 0.727 - inset);
        (left, right, bottom, top)
    };
    let (left, right, bottom, top) = frame(0.0);
    let (inner_left, inner_right, inner_bottom, inner_top) = frame(0.06);
    vec![
        Step::Move(left, bottom),
        Step::Line(right, bottom),
        Step::Line(right, top),
        Step::Line(left, top),
        Step::Close,
        // In the opposite direction, so that the non-zero rule leaves it empty.
        Step::Move(inner_left, inner_bottom),
        Step::Line(inner_left, inner_top),
        Step::Line(inner_right, inner_top),
        Step::Line(inner_right, inner_bottom),
        Step::Close,
    ]
}

struct Outline {
    steps: Vec<Step>,
    scale: f32,
}

impl OutlineBuilder for Outline {
    fn move_to(&mut self, x: f32, y: f32) {
        self.steps.push(Step::Move(x * self.scale, y * self.scale));
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.steps.push(Step::Line(x * self.scale, y * self.scale));
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        let s = self.scale;
        self.steps.push(Step::Quad(x1 * s, y1 * s, x * s, y * s));
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        let s = self.scale;
        self.steps.push(Step::Cubic(x1 * s, y1 * s, x2 * s, y2 * s, x * s, y * s));
    }

    fn close(&mut self) {
        self.steps.push(Step::Close);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_weights_hold_what_plans_and_the_window_write() {
        let needed = "ABCXYZabcxyz0123456789 äöüßñéèàçøåčšžőłĞİş ΑΒΓΩαβγω АБВЯабвя m²m³°′″'\"–—…·×÷±≈≤≥←→↑↓✓✗∅½€⌘⇧▲●○";
        for weight in [Weight::Regular, Weight::SemiBold] {
            let missing: String = needed.chars().filter(|&character| !Font::of(weight).has(character)).collect();
            assert_eq!(missing, "", "{weight:?}");
        }
    }

    #[test]
    fn a_character_it_does_not_have_is_a_box() {
        let font = Font::of(Weight::Regular);
        assert!(!font.has('和'));
        assert_eq!(font.outline('和').len(), 10);
        assert!((font.width_px("和室", 10.0) - 13.6).abs() < 1e-4);
        assert!(font.outline(' ').is_empty());
    }

    #[test]
    fn metrics_are_the_fonts() {
        let face = Face::parse(REGULAR, 0).expect("the bundled font parses");
        let em = f64::from(face.units_per_em());
        assert!((f64::from(face.capital_height().expect("OS/2")) / em - CAP_HEIGHT).abs() < 0.001);
        let lowest = face.glyph_bounding_box(face.glyph_index('g').expect("g")).expect("outline").y_min;
        assert!((f64::from(-lowest) / em - DESCENT).abs() < 0.01, "{lowest}");
    }
}
