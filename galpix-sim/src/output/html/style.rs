//! Colours by role, in a light and a dark scheme, and the style sheet made of them.

use std::fmt::Write;

/// What a colour stands for. A plot is drawn in the light colours; the style sheet turns them into the reader's scheme.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ink {
    /// What galpix shows.
    Galpix,
    /// Sample-and-hold.
    Hold,
    /// The cells that a galpixel reached; the mean.
    Known,
    /// A certified bound.
    Bound,
    /// A constant to compare with.
    Guide,
    /// Holes.
    Holes,
    /// Filled holes.
    Filled,
    /// Galpixels that left the map.
    Lost,
    /// Galpixels that met a nearer one.
    Collided,
    /// Axes.
    Axis,
    /// Lines behind the data.
    Grid,
    /// Figures at the axes.
    Label,
}

/// Role, name in the style sheet, light colour, dark colour. The light colours identify the roles: no two are equal.
const INKS: [(Ink, &str, u32, u32); 12] = [
    (Ink::Galpix, "galpix", 0x1F5FD0, 0x7AA8FF),
    (Ink::Hold, "hold", 0xC0620C, 0xF0A04B),
    (Ink::Known, "known", 0x0F8577, 0x4FD1BE),
    (Ink::Bound, "bound", 0xC22F45, 0xFF8294),
    (Ink::Guide, "guide", 0x8A8F9C, 0x7A8090),
    (Ink::Holes, "holes", 0x7A45C4, 0xBE96FF),
    (Ink::Filled, "filled", 0x2E8B3D, 0x7DD68A),
    (Ink::Lost, "lost", 0xB7540F, 0xF2A65A),
    (Ink::Collided, "collided", 0x59606F, 0xA9B0C0),
    (Ink::Axis, "axis", 0x9AA0AD, 0x5C6373),
    (Ink::Grid, "grid", 0xE3E6EC, 0x2C313D),
    (Ink::Label, "label", 0x4B5162, 0xB4BAC8),
];

impl Ink {
    fn entry(self) -> (&'static str, u32) {
        INKS.iter().find(|entry| entry.0 == self).map_or(("label", 0), |&(_, name, light, _)| (name, light))
    }

    /// Returns the name of the role's custom property in the style sheet, without the dashes.
    pub fn name(self) -> &'static str {
        self.entry().0
    }

    /// Returns the colour in the light scheme: red, green, blue.
    pub fn light(self) -> [u8; 3] {
        let [_, r, g, b] = self.entry().1.to_be_bytes();
        [r, g, b]
    }
}

/// Returns the style sheet of the page.
pub fn sheet() -> String {
    let mut sheet = String::new();
    let scheme = |dark: bool| {
        let pairs = INKS.iter().map(|&(_, name, light, night)| (name, if dark { night } else { light }));
        pairs.map(|(name, colour)| format!("--{name}:#{colour:06X};")).collect::<String>()
    };
    let _ = writeln!(sheet, ":root{{{}}}", scheme(false));
    let _ = writeln!(sheet, "@media (prefers-color-scheme:dark){{:root{{{}}}}}", scheme(true));
    for (_, name, light, _) in INKS {
        let _ = writeln!(sheet, "svg [stroke=\"#{light:06X}\"]{{stroke:var(--{name})}}");
        let _ = writeln!(sheet, "svg [fill=\"#{light:06X}\"]{{fill:var(--{name})}}");
    }
    sheet + include_str!("style.css")
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn every_role_has_its_own_light_colour_and_name() {
        assert_eq!(INKS.iter().map(|entry| entry.2).collect::<HashSet<_>>().len(), INKS.len());
        assert_eq!(INKS.iter().map(|entry| entry.1).collect::<HashSet<_>>().len(), INKS.len());
        assert!(INKS.iter().all(|entry| entry.0.entry() == (entry.1, entry.2)));
    }
}
