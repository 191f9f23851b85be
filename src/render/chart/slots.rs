//! Which colour, dashes and marker a name gets: a method the same in every figure.

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
pub(super) const TWIN: &str = " = ";

/// Numbers of colours and of shapes of markers.
pub(super) const COLOURS: usize = 7;

/// The colour and the shape of the marker of a slot: all pairs are passed through before one comes again, and neighbours differ
/// in both. The shape is hollow in every second round.
pub(super) fn colour_and_shape(slot: usize) -> (usize, usize, bool) {
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
