//! Which colour, dashes and marker a name gets: a method of the front page the same in every figure.

/// Methods with a slot of their own, which is their place here: those that the front page names.
const METHODS: [&str; 6] =
    ["GC-Bbar-patch", "GC-SRI-patch", "CE-SRI-patch-cells", "GIMP-SRI-patch", "VP-Bbar", "MPM"];

/// As many names as this can be told apart by colour.
const COLOURS: usize = 7;

/// The slot of each of these names, which are all different. A name may go on after its method, `GC-SRI-patch, implicit`; the
/// total Lagrangian form of a method looks like the method. Names without a slot of their own take the free ones in their
/// order; where there are more names than colours, all of them do.
pub fn slots(names: &[&str]) -> Vec<usize> {
    if names.len() > COLOURS {
        return (0..names.len()).collect();
    }
    let mut slots: Vec<Option<usize>> = Vec::with_capacity(names.len());
    for name in names {
        let method = name.split(", ").next().map(|method| method.trim_start_matches("TL-"));
        let reserved = METHODS.iter().position(|known| method == Some(*known));
        slots.push(reserved.filter(|slot| !slots.contains(&Some(*slot))));
    }
    let mut free = (0..COLOURS).filter(|slot| !slots.contains(&Some(*slot))).collect::<Vec<_>>().into_iter();
    slots.into_iter().map(|slot| slot.or_else(|| free.next()).unwrap_or_default()).collect()
}

#[cfg(test)]
mod tests {
    use super::slots;

    #[test]
    fn the_methods_with_a_colour_are_those_that_the_front_page_names() {
        let profile = include_str!("../../../report/figures/race-profile-moving-all.svg");
        for method in super::METHODS {
            assert!(profile.contains(&format!(">{method}<")), "{method}");
        }
        // And the title.
        assert_eq!(profile.matches("font-weight=\"bold\"").count(), super::METHODS.len() + 1);
    }

    #[test]
    fn a_method_of_the_front_page_has_its_colour_in_any_company() {
        let many: Vec<String> = (0..8).map(|place| format!("MPM, {place} cells")).collect();
        let many: Vec<&str> = many.iter().map(String::as_str).collect();
        let cases: [(&[&str], &[usize]); 7] = [
            (&["GC-SRI-patch", "MPM"], &[1, 5]),
            (&["MPM", "GC-SRI-patch, implicit"], &[5, 1]),
            (&["10 cells", "20 cells", "40 cells"], &[0, 1, 2]),
            (&["GIMP-SRI", "GC-Bbar-patch", "PPP"], &[1, 0, 2]),
            (&["MPM, explicit", "MPM, implicit", "MPM-cells"], &[5, 0, 1]),
            (&["TL-GC-SRI-patch", "MPM", "TL-MPM"], &[1, 5, 0]),
            (&many, &[0, 1, 2, 3, 4, 5, 6, 7]),
        ];
        for (names, expected) in cases {
            assert_eq!(slots(names), expected, "{names:?}");
        }
    }
}
