/// A colour: sRGB with straight (not premultiplied) alpha, one byte each.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Rgba {
    pub r: u8,
    pub g: u8,
    pub b: u8,
    /// 0 (invisible) to 255 (opaque).
    pub a: u8,
}

impl Rgba {
    /// An opaque colour from its CSS digits: `0x1c2026` is `#1c2026`.
    pub const fn hex(rgb: u32) -> Self {
        Self { r: (rgb >> 16) as u8, g: (rgb >> 8) as u8, b: rgb as u8, a: 255 }
    }

    /// The same colour with another alpha.
    pub const fn with_alpha(self, a: u8) -> Self {
        Self { a, ..self }
    }

    /// The same colour with its alpha multiplied by `opacity`, 0 to 1.
    pub fn faded(self, opacity: f64) -> Self {
        Self { a: (f64::from(self.a) * opacity.clamp(0.0, 1.0)).round() as u8, ..self }
    }

    /// The opaque colour a fraction `t` of the way to `other`, mixed as sRGB bytes.
    pub fn mixed(self, other: Self, t: f64) -> Self {
        let mix = |p: u8, q: u8| (f64::from(p) + (f64::from(q) - f64::from(p)) * t.clamp(0.0, 1.0)).round() as u8;
        Self { r: mix(self.r, other.r), g: mix(self.g, other.g), b: mix(self.b, other.b), a: 255 }
    }

    /// The CSS form `#rrggbb`, without the alpha.
    pub fn css(self) -> String {
        format!("#{:02x}{:02x}{:02x}", self.r, self.g, self.b)
    }

    /// Contrast ratio of two opaque colours, 1 to 21 (Web Content Accessibility Guidelines 2.1,
    /// 'contrast ratio').
    pub fn contrast(self, other: Self) -> f64 {
        let (p, q) = (self.luminance(), other.luminance());
        (p.max(q) + 0.05) / (p.min(q) + 0.05)
    }

    /// Relative luminance, 0 to 1 (same source).
    fn luminance(self) -> f64 {
        let [r, g, b] = [self.r, self.g, self.b].map(linear);
        0.2126 * r + 0.7152 * g + 0.0722 * b
    }
}

/// An sRGB byte as linear light, 0 to 1 (IEC 61966-2-1).
pub(super) fn linear(byte: u8) -> f64 {
    let value = f64::from(byte) / 255.0;
    if value <= 0.040_45 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contrast_of_black_and_white_is_21() {
        assert!((Rgba::hex(0).contrast(Rgba::hex(0xff_ffff)) - 21.0).abs() < 1e-9);
        assert_eq!(Rgba::hex(0x1c_2026).css(), "#1c2026");
        assert_eq!(Rgba::hex(0).mixed(Rgba::hex(0xff_ffff), 0.5), Rgba::hex(0x80_8080));
    }
}
