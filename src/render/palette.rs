//! The colours of figures, each with its counterpart on a dark screen, and which colour and marker a method has: the same in
//! every figure. Figures are drawn in the light colours; a style sheet exchanges them.

use plotters::style::RGBColor;
use std::fmt::Write as _;

/// A colour on a light and on a dark screen.
pub(crate) struct Shade {
    /// On white.
    pub light: RGBColor,
    /// On [`DARK_SCREEN`].
    dark: RGBColor,
}

const fn shade(light: u32, dark: u32) -> Shade {
    #[expect(clippy::cast_possible_truncation, reason = "a byte each")]
    const fn colour(code: u32) -> RGBColor {
        RGBColor((code >> 16) as u8, (code >> 8) as u8, code as u8)
    }
    Shade { light: colour(light), dark: colour(dark) }
}

/// Lines, markers and names of series: dark enough for text, and told apart by the colour-blind beside their markers (after
/// Okabe and Ito 2008).
pub(crate) static SERIES: [Shade; COLOURS] = [
    shade(0x00_72_B2, 0x5A_B4_F0),
    shade(0xB8_4A_00, 0xF2_8E_4E),
    shade(0x00_78_5A, 0x3E_C9_9C),
    shade(0xA0_3A_78, 0xE8_97_C6),
    shade(0x80_60_00, 0xE3_B5_48),
    shade(0x5B_4F_B0, 0xAE_A6_F2),
    shade(0x66_66_66, 0xB4_B4_B4),
];
/// The theory.
pub(crate) static THEORY: Shade = shade(0x1A_1A_1A, 0xF4_F4_F4);
/// Titles and labels.
pub(crate) static TEXT: Shade = shade(0x26_26_26, 0xE4_E7_EA);
/// Notes and rules.
pub(crate) static QUIET: Shade = shade(0x5F_5F_5F, 0xA8_B0_B8);
/// Frames of plots, and series that are coloured in another panel.
pub(crate) static FRAME: Shade = shade(0x8A_8A_8A, 0x7C_82_88);
/// Lines of the grid.
pub(crate) static GRID: Shade = shade(0xDC_DC_DC, 0x3A_40_46);
/// Finer lines of the grid.
pub(crate) static FINE_GRID: Shade = shade(0xF0_F0_F0, 0x26_2A_2E);
/// What is behind, and the edges of markers.
pub(crate) static SCREEN: Shade = shade(0xFF_FF_FF, 0x18_18_18);

/// The rules of a style sheet that exchange the colours of figures below a selector where the reader's screen is dark.
pub(crate) fn dark_rules(selector: &str) -> String {
    let hex = |RGBColor(red, green, blue): RGBColor| format!("#{red:02X}{green:02X}{blue:02X}");
    let others = [&THEORY, &TEXT, &QUIET, &FRAME, &GRID, &FINE_GRID, &SCREEN];
    let mut out = "@media (prefers-color-scheme: dark) {\n".to_owned();
    for shade in SERIES.iter().chain(others) {
        let (light, dark) = (hex(shade.light), hex(shade.dark));
        let _ = writeln!(
            out,
            "{selector} [fill=\"{light}\"] {{ fill: {dark}; }} {selector} [stroke=\"{light}\"] {{ stroke: {dark}; }}"
        );
    }
    out + "}\n"
}

/// Methods with a slot of their own; each pair of colour and marker is another. Colours follow the families of methods, as far as
/// there are colours: blue for B-bar, vermilion for selective reduced integration, green where the mesh follows the soil.
const METHODS: [(&str, usize); 19] = [
    ("GC-Bbar-patch", 0),
    ("GIMP-Bbar-patch", 7),
    ("GIMP-Bbar", 14),
    ("GC-SRI-patch", 1),
    ("GIMP-SRI", 8),
    ("TL-GC-Bbar-patch", 2),
    ("TL-GC-SRI-patch", 9),
    ("TL-GIMP-SRI-patch", 16),
    ("CE-SRI-patch-cells", 3),
    ("CE-SRI-patch", 10),
    ("MPM-SRI-patch-moments", 4),
    ("VP-Bbar", 11),
    ("VP", 18),
    ("GIMP-SRI-patch", 5),
    ("PPP", 12),
    ("B2-Bbar-patch", 19),
    ("MPM", 6),
    ("GIMP", 13),
    ("GIMP-null-space", 20),
];

/// What stands between the name of a series and that of another with the same points.
pub(crate) const TWIN: &str = " = ";

/// Numbers of colours and of shapes of markers.
pub(crate) const COLOURS: usize = 7;

/// The colour and the shape of the marker of a slot: all pairs are passed through before one comes again, and neighbours differ
/// in both. The shape is hollow in every second round.
pub(crate) fn colour_and_shape(slot: usize) -> (usize, usize, bool) {
    let round = slot / COLOURS;
    (slot % COLOURS, (slot + round) % COLOURS, round % 2 == 1)
}

/// The slot of each of these names, which are all different. A name may go on after its method, `GC-SRI-patch, implicit`. Names
/// without a slot of their own take free ones in their order, of other colours as long as there are some; beside a method none
/// that belongs to another method.
pub fn slots(names: &[&str]) -> Vec<usize> {
    let mut slots: Vec<Option<usize>> = Vec::with_capacity(names.len());
    for name in names {
        let method = name.split(", ").next().unwrap_or(name);
        let method = method.split(TWIN).next().unwrap_or(method);
        let reserved = METHODS.iter().find(|(known, _)| *known == method).map(|(_, slot)| *slot);
        slots.push(reserved.filter(|slot| !slots.contains(&Some(*slot))));
    }
    let has_methods = slots.iter().any(Option::is_some);
    let is_reserved = |slot: usize| has_methods && METHODS.iter().any(|(_, reserved)| *reserved == slot);
    for place in 0..slots.len() {
        if slots[place].is_none() {
            let taken = |slot: usize| slots.contains(&Some(slot));
            let worn = |slot: usize| slots.iter().flatten().any(|other| other % COLOURS == slot % COLOURS);
            let mut free = (0..).filter(|slot| !is_reserved(*slot) && !taken(*slot));
            let others = free.clone().take(2 * COLOURS);
            let new_colour = others.into_iter().find(|slot| !worn(*slot));
            slots[place] = new_colour.or_else(|| free.next());
        }
    }
    slots.into_iter().flatten().collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::contender::CONTENDERS;
    use std::collections::BTreeSet;

    /// Contrast of two colours (WCAG 2.1, 1.4.3).
    fn contrast(a: RGBColor, b: RGBColor) -> f64 {
        let linear = |part: u8| {
            let share = f64::from(part) / 255.0;
            if share <= 0.04045 { share / 12.92 } else { ((share + 0.055) / 1.055).powf(2.4) }
        };
        let luminance = |RGBColor(red, green, blue): RGBColor| {
            0.2126 * linear(red) + 0.7152 * linear(green) + 0.0722 * linear(blue)
        };
        let (a, b) = (luminance(a), luminance(b));
        (a.max(b) + 0.05) / (a.min(b) + 0.05)
    }

    #[test]
    fn text_has_a_contrast_of_four_and_a_half_and_lines_of_three_on_both_screens() {
        let texts = SERIES.iter().chain([&THEORY, &TEXT, &QUIET]).map(|shade| (shade, 4.5));
        for (shade, least) in texts.chain([(&FRAME, 3.0)]) {
            for found in [contrast(shade.light, SCREEN.light), contrast(shade.dark, SCREEN.dark)] {
                assert!(found >= least, "{:?}: {found:.2}", shade.light);
            }
        }
    }

    #[test]
    fn a_dark_screen_exchanges_every_colour() {
        let rules = dark_rules(".card");
        assert!(rules.contains(".card [stroke=\"#0072B2\"] { stroke: #5AB4F0; }"), "{rules}");
        assert_eq!(rules.matches("[fill=").count(), SERIES.len() + 7);
    }

    #[test]
    fn every_contender_of_the_race_has_a_look_of_its_own() {
        let slot = |name: &str| METHODS.iter().find(|(known, _)| *known == name).map(|(_, slot)| *slot);
        let looks: BTreeSet<(usize, usize)> = CONTENDERS
            .iter()
            .map(|contender| slot(contender.name).expect(contender.name))
            .map(|slot| (colour_and_shape(slot).0, colour_and_shape(slot).1))
            .collect();
        assert_eq!(looks.len(), CONTENDERS.len());
    }

    #[test]
    fn a_method_has_its_colour_in_any_company() {
        let cases: [(&[&str], &[usize]); 6] = [
            (&["GC-SRI-patch", "MPM"], &[1, 6]),
            (&["MPM", "GC-SRI-patch, implicit"], &[6, 1]),
            (&["10 cells", "20 cells", "40 cells"], &[0, 1, 2]),
            (&["uGIMP", "GC-Bbar-patch", "PPP"], &[15, 0, 12]),
            (&["MPM, explicit", "MPM, implicit", "MPM-cells"], &[6, 15, 17]),
            (&["a", "b", "c", "d", "e", "f", "g", "h", "MPM"], &[15, 17, 21, 23, 25, 26, 22, 24, 6]),
        ];
        for (names, expected) in cases {
            assert_eq!(slots(names), expected, "{names:?}");
        }
    }
}
