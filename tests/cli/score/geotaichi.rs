//! `GeoTaichi`: files written by the program.

use crate::score::real_files::{are, score, values};

#[test]
fn geo_taichi_has_its_displacements_from_the_first_state_and_points_missing() {
    let load = ["--preset", "geotaichi", "--set", "column.load=1000"];
    for (file, step) in [("geotaichi/particles/*.npz", None), ("geotaichi/*.vtu", Some("2.04166"))] {
        let step = step.map_or(vec![], |step| vec!["--set-time-step", step]);
        let told = score(&[&[file], &load[..], &step].concat());
        let found = values(&told, ",pressure,points,l2,");
        assert!(are(&found[2..], &["6.5e-2"]), "{file}: {found:?}");
        let moved = values(&told, ",displacement,points,l2,");
        assert!(moved.last().is_some_and(|error| *error < 0.1), "{file}: {moved:?}");
        assert!(
            told.err.contains("volume-differs") && told.err.contains("1.84 % are missing"),
            "{}",
            told.err
        );
        assert_eq!(told.err.contains("`state_vars`"), step.is_empty(), "the pickled member: {}", told.err);
    }
    let told = score(&[&["geotaichi/particles/MPMParticle000002.npz"], &load[..]].concat());
    assert!(told.code == 0 && told.err.contains("give the first state too"), "{}", told.err);
    assert!(!told.out.contains("displacement"), "{}", told.out);
}
