//! Colours, markers and dashes by number: any two of the first six series differ in all three, so
//! that they are told apart by the colour-blind and on grey paper.
use crate::render::chart::canvas::{Canvas, Ink, Px, Rgb};

/// Okabe and Ito (2008), without the yellow that vanishes on white; black belongs to the theory.
const COLOURS: [Rgb; 7] = [
    Rgb(0x00, 0x72, 0xB2),
    Rgb(0xD5, 0x5E, 0x00),
    Rgb(0x00, 0x9E, 0x73),
    Rgb(0xCC, 0x79, 0xA7),
    Rgb(0xE6, 0x9F, 0x00),
    Rgb(0x56, 0xB4, 0xE9),
    Rgb(0x7A, 0x7A, 0x7A),
];

pub(crate) const DARK: Rgb = Rgb(0x1A, 0x1A, 0x1A);
pub(crate) const TEXT: Rgb = Rgb(0x26, 0x26, 0x26);
pub(crate) const QUIET: Rgb = Rgb(0x5F, 0x5F, 0x5F);
pub(crate) const FRAME: Rgb = Rgb(0x8A, 0x8A, 0x8A);
pub(crate) const MAJOR: Rgb = Rgb(0xDC, 0xDC, 0xDC);
pub(crate) const MINOR: Rgb = Rgb(0xF0, 0xF0, 0xF0);
pub(crate) const WHITE: Rgb = Rgb(0xFF, 0xFF, 0xFF);

/// Lengths of dashes and gaps in drawing units.
const DASHES: [Option<&str>; 7] = [
    None,
    Some("75 35"),
    Some("22 28"),
    Some("95 30 22 30"),
    Some("105 25"),
    Some("60 25 20 25 20 25"),
    Some("40 30"),
];

pub(crate) fn colour(slot: usize) -> Rgb {
    COLOURS[slot % COLOURS.len()]
}

pub(crate) fn dash(slot: usize) -> Option<&'static str> {
    DASHES[slot % DASHES.len()]
}

/// Outline of a marker of unit size; the disc is none.
fn outline(shape: usize) -> Vec<Px> {
    match shape {
        1 => vec![(-0.88, -0.88), (0.88, -0.88), (0.88, 0.88), (-0.88, 0.88)],
        2 => vec![(0.0, -1.2), (1.1, 0.8), (-1.1, 0.8)],
        3 => vec![(0.0, -1.3), (1.05, 0.0), (0.0, 1.3), (-1.05, 0.0)],
        4 => vec![(0.0, 1.2), (1.1, -0.8), (-1.1, -0.8)],
        5 => four_arms([(-0.36, -1.2), (0.36, -1.2), (0.36, -0.36)]),
        6 => four_arms([(-1.1, -0.6), (-0.6, -1.1), (0.0, -0.5)]),
        _ => Vec::new(),
    }
}

/// An arm and the same turned by one, two and three right angles.
fn four_arms(arm: [Px; 3]) -> Vec<Px> {
    let turned = |arm: &[Px; 3]| Some(arm.map(|(x, y)| (-y, x)));
    std::iter::successors(Some(arm), turned).take(4).flatten().collect()
}

/// Draws a marker. Beyond the seven full ones come the same shapes, hollow.
pub(crate) fn marker(canvas: &mut Canvas, at: Px, slot: usize, radius: f64, ink: Rgb) {
    let shape = outline(slot % 7);
    let hollow = (slot / 7) % 2 == 1;
    // A thin white edge keeps neighbours apart.
    let layers: [(f64, Ink); 3] =
        [(radius + 0.7, Ink(WHITE, 0.9)), (radius, ink.into()), (radius * 0.55, WHITE.into())];
    for (r, ink) in layers.into_iter().take(if hollow { 3 } else { 2 }) {
        if shape.is_empty() {
            canvas.disc(at, r, ink);
        } else {
            let corners: Vec<Px> = shape.iter().map(|(x, y)| (at.0 + r * x, at.1 + r * y)).collect();
            canvas.polygon(&corners, ink);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_slots_differ_in_colour_dash_and_shape() {
        for a in 0..7 {
            for b in 0..a {
                assert_ne!(colour(a), colour(b));
                assert_ne!(dash(a), dash(b));
                assert_ne!(outline(a), outline(b));
            }
        }
        assert_eq!(colour(0), colour(COLOURS.len()));
    }
}
