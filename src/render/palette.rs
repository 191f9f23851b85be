//! The colours of figures, each with its counterpart on a dark screen. Figures are drawn in the light ones; a style sheet
//! exchanges them.

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
pub(crate) static SERIES: [Shade; 7] = [
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

#[cfg(test)]
mod tests {
    use super::*;

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
}
