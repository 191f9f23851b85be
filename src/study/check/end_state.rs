//! The state that a load leads to: the load that brings a strain about, and pores that must stay open.

use crate::case::Case;
use crate::study::check::checker::{Checker, Purpose};
use crate::study::file::StudyFile;
use oedometer_soil::wording::short;
use std::ops::Range;

impl Checker<'_> {
    /// The strain that a study gives in place of its load.
    pub(crate) fn given_strain(&mut self, file: &StudyFile, seed: &Case) -> Option<f64> {
        let typed = file.column.strain.as_ref()?;
        let strain = *typed.get_ref();
        if file.column.typed("load").is_some()
            || file.sweep.iter().any(|block| block.get_ref().typed("load").is_some())
        {
            self.complain(
                typed.span(),
                "the column has a `load` and a `strain`",
                "leave one of them out: the load follows from the strain",
            );
        } else if !seed.scene.is_loaded() {
            let message =
                format!("nothing loads the scene `{}`: no strain is brought about", seed.scene.name());
            self.complain(typed.span(), message, "leave `strain` out");
        } else if strain > 0.0 && strain < 1.0 {
            return Some(strain);
        } else {
            self.complain(
                typed.span(),
                format!("`column.strain` is {strain}"),
                "it is the share by which the column gets shorter: between 0 and 1, both excluded",
            );
        }
        None
    }

    /// Complains of the first case whose pores would close before its end: it has no end state, and its run would
    /// fail.
    pub(crate) fn pores_stay_open(&mut self, place: Range<usize>, mut cases: impl Iterator<Item = Case>) {
        if self.purpose != Purpose::Solving || !self.diagnostics.is_empty() {
            return;
        }
        let moves = |case: &Case| case.scene.refuses_motion(&case.column, &case.material);
        let closes = |case: &Case| {
            let is_loaded = case.scene.is_large_strain() && !case.scene.is_manufactured();
            is_loaded && final_strain(case) >= case.material.porosity || moves(case).is_some()
        };
        let Some(case) = cases.find(closes) else { return };
        if let Some(error) = moves(&case) {
            self.complain(
                place,
                error.to_string(),
                "the case cannot be: see the tables [manufactured] and [material]",
            );
            return;
        }
        let soil = &case.material;
        self.complain(
            place,
            format!(
                "with E = {} Pa, ν = {} and n = {} the load {} Pa strains the column by {}: the pores close at {}",
                short(soil.youngs_modulus),
                soil.poissons_ratio,
                soil.porosity,
                short(case.column.load),
                short(final_strain(&case)),
                soil.porosity
            ),
            format!(
                "load less than {} Pa, or write `strain` in [column] for the load, below {}",
                short(load_of(soil.porosity, &case)),
                soil.porosity
            ),
        );
    }
}

/// Load, Pa, under which a case ends with a vertical strain, by the law of its soil.
pub(crate) fn load_of(strain: f64, case: &Case) -> f64 {
    let soil = &case.material;
    let compression =
        if case.scene.is_large_strain() { -soil.law.uniaxial_stress_ratio(-strain) } else { strain };
    soil.oedometric_modulus() * compression
}

/// Vertical strain at the end of a case, by the law of its soil.
fn final_strain(case: &Case) -> f64 {
    case.material.law.shrinkage(case.column.load / case.material.oedometric_modulus())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::check::Study;
    use crate::study::file::StudySource;

    fn checked(column: &str, sweep: &str) -> Result<Study, String> {
        let text = format!(
            "title = \"t\"\nscene = \"xie-leo\"\n[column]\n{column}\n[[sweep]]\nmethod = [\"MPM\"]\n\
             integrator = [\"implicit\"]\ncells = [4]\n{sweep}\n"
        );
        Study::check(&StudySource { name: "t.toml".to_owned(), text }).map_err(|error| error.to_string())
    }

    #[test]
    fn a_strain_gives_each_case_the_load_of_its_own_soil() {
        let study = checked(
            "strain = 0.2",
            "law = [\"log-linear\", \"porosity-dependent\"]\nyoungs_modulus = [1e6, 2e6]",
        );
        let study = study.expect("sound");
        assert_eq!(study.planned.len(), 4);
        for planned in &study.planned {
            let case = &planned.case;
            assert!((final_strain(case) - 0.2).abs() < 1e-14, "{}", case.label());
        }
        // Of the logarithmic law: σ = E_oed ln(1/J), E_oed = 1.2 E at ν = 0.25.
        let load = study.planned[0].case.column.load;
        assert!((load - 1.2e6 * 1.25_f64.ln()).abs() < 1e-6 * load, "{load}");
    }

    #[test]
    fn a_strain_beyond_the_pores_or_beside_a_load_is_refused() {
        let refused = |column: &str, sweep: &str| checked(column, sweep).expect_err("refused");
        assert!(refused("strain = 0.3\nload = 1e5", "").contains("a `load` and a `strain`"));
        assert!(refused("strain = 1.2", "").contains("`column.strain` is 1.2"));
        // The seed's porosity is 0.3.
        for (strain, line) in [("0.35", 4), ("0.3", 4)] {
            let told = refused(&format!("strain = {strain}"), "");
            assert!(
                told.contains(&format!("a strain of {strain} leaves no pores: the porosity is 0.3")),
                "{told}"
            );
            assert!(
                told.contains(&format!("t.toml:{line}:")) && told.contains("a `porosity` above"),
                "{told}"
            );
        }
        assert!(checked("strain = 0.25", "").is_ok());
        // One of the swept soils is too soft for the load, though the study's own is not.
        let told = refused("load = 2e5", "youngs_modulus = [1e6, 3e5]");
        assert!(told.contains("E = 300000 Pa") || told.contains("E = 3e5 Pa"), "{told}");
        assert!(checked("load = 2e5", "youngs_modulus = [1e6, 7e5]").is_ok());
    }
}
