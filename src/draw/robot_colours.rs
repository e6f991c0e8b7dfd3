//! Colours of a robot's map. Known floor is lighter than the unknown in both themes, as in Fig. 2 of the
//! paper.

use super::{Rgba, Theme};

/// The colours of what a robot knows. The three paths differ in lightness and in how they are drawn, too:
/// colour alone does not tell them apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RobotColours {
    /// Floor not seen yet; mixed over the plan, which shows through faintly.
    pub unknown: Rgba,
    /// Known floor.
    pub free: Rgba,
    /// Obstacles, as line segments.
    pub obstacle: Rgba,
    /// The laser's fan and its hits.
    pub laser: Rgba,
    /// The robot, and its path as estimated: solid.
    pub estimate: Rgba,
    /// The true path: dashed.
    pub truth: Rgba,
    /// The path by odometry alone: dotted.
    pub odometry: Rgba,
    pub frontier: Rgba,
    pub doorway: Rgba,
    /// Segments directly visible from a point (Fig. 3).
    pub visible: Rgba,
}

/// Hues from Okabe and Ito (2008), 'Color universal design', darkened where they would be faint on white.
const LIGHT: RobotColours = RobotColours {
    unknown: Rgba::hex(0xd9_dce1),
    free: Rgba::hex(0xff_ffff),
    obstacle: Rgba::hex(0x1c_2026),
    laser: Rgba::hex(0x2f_8fd0),
    estimate: Rgba::hex(0x00_5f9e),
    truth: Rgba::hex(0x1c_2026),
    odometry: Rgba::hex(0xd5_5e00),
    frontier: Rgba::hex(0xc4_5a00),
    doorway: Rgba::hex(0x00_8060),
    visible: Rgba::hex(0xc6_2828),
};

const DARK: RobotColours = RobotColours {
    unknown: Rgba::hex(0x0c_0e11),
    free: Rgba::hex(0x26_2b33),
    obstacle: Rgba::hex(0xe3_e7ed),
    laser: Rgba::hex(0x6c_c4ff),
    estimate: Rgba::hex(0x56_b4e9),
    truth: Rgba::hex(0xf2_f4f7),
    odometry: Rgba::hex(0xf0_8a3c),
    frontier: Rgba::hex(0xf5_ac45),
    doorway: Rgba::hex(0x2f_d0a2),
    visible: Rgba::hex(0xff_7369),
};

impl RobotColours {
    pub const fn of(theme: Theme) -> &'static Self {
        match theme {
            Theme::Light => &LIGHT,
            Theme::Dark => &DARK,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_seen_on_known_floor() {
        for theme in Theme::ALL {
            let colours = RobotColours::of(theme);
            for line in [
                colours.obstacle,
                colours.estimate,
                colours.truth,
                colours.odometry,
                colours.frontier,
                colours.doorway,
                colours.visible,
            ] {
                assert!(line.contrast(colours.free) >= 3.0, "{} of {theme:?}", line.css());
            }
            // The paths in grey: the estimate is told from the other two by its lightness or its line.
            assert!(colours.truth.contrast(colours.estimate) >= 1.5, "{theme:?}");
            assert!(colours.free.contrast(colours.unknown) >= 1.25, "{theme:?}");
        }
    }
}
