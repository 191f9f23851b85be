//! A method in words: what each of its parts does, and who published it.

use oedometer_problem::method::{
    Basis, Configuration, FULL_PROJECTION, Memory, Method, PressureIntegration, Quadrature, Recovery,
    StrainGradient,
};

/// One part of a method.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MethodPart {
    /// What the part is, as a study file names the choice: `basis`, `strain`, …
    pub choice: &'static str,
    /// The choice in the word of a study file.
    pub word: &'static str,
    /// What it does, a clause without a full stop.
    pub description: &'static str,
    /// Who published it; empty for what every method has.
    pub source: &'static str,
}

/// The method of a name in one line; `None` if no method has it.
pub fn method_words(name: &str) -> Option<String> {
    let method = Method::named(name)?;
    Some(parts(&method).iter().map(|part| part.description).collect::<Vec<_>>().join("; "))
}

/// The parts of a method, from the shape functions to the configuration.
pub fn parts(method: &Method) -> Vec<MethodPart> {
    let part = |choice, word, (description, source)| MethodPart { choice, word, description, source };
    let mut parts = vec![
        part("basis", method.basis.name(), of_basis(method.basis)),
        part("strain", method.strain.name(), of_strain(method.strain)),
        part("pressure", method.pressure.name(), of_pressure(method.pressure)),
    ];
    if (method.pressure, method.recovery) != (PressureIntegration::Points, Recovery::Constant) {
        parts.push(part("recovery", method.recovery.name(), of_recovery(method.recovery)));
    }
    if method.quadrature == Quadrature::Moments {
        let fitted = "integration volumes of the points integrate constant and linear fields exactly, \
                      wherever the points lie in the cell";
        parts.push(part("quadrature", method.quadrature.name(), (fitted, "Müller, Kummer & Oberlack 2013")));
    }
    if method.memory == Memory::Cells {
        let cells = "stress, pressure and volume of moving points follow the parabola through the means of \
                     the surrounding cells";
        parts.push(part("memory", method.memory.name(), (cells, "this program")));
    }
    if (method.strain, method.recovery) == (StrainGradient::Bbar, Recovery::Nodal) {
        let hybrid = "the combination is a hybrid found in no source: the published averaging over nodes \
                      cures locking, but is not a pressure field";
        parts.push(part("hybrid", "", (hybrid, "cf. Zhao, Jiang & Choo 2023")));
    }
    if let Some(configuration) = method.configuration {
        parts.push(part("configuration", configuration.name(), of_configuration(configuration)));
    }
    if method.projection != FULL_PROJECTION {
        let scaled = "the parameter of the pressure projection is scaled from its published value";
        parts.push(part("projection", "", (scaled, "")));
    }
    parts
}

fn of_basis(basis: Basis) -> (&'static str, &'static str) {
    match basis {
        Basis::Hat => {
            ("each point has no extent; shape functions are linear", "Sulsky, Chen & Schreyer 1994")
        }
        Basis::Ugimp => (
            "each point has a domain of fixed length, over which the linear shape functions are averaged",
            "Bardenhagen & Kober 2004",
        ),
        Basis::Cpgimp => (
            "each point has a domain that stretches with the soil, over which the linear shape functions are averaged",
            "Bardenhagen & Kober 2004",
        ),
        Basis::Cpdi => (
            "linear shape functions are averaged over the corners of domains that stretch, rotate and shear with the soil",
            "Sadeghirad, Brannon & Burghardt 2011",
        ),
        Basis::Bspline2 => (
            "shape functions are quadratic B-splines, evaluated at the points",
            "Steffen, Kirby & Berzins 2008",
        ),
        Basis::Bspline3 => {
            ("shape functions are cubic B-splines, evaluated at the points", "Steffen, Kirby & Berzins 2008")
        }
    }
}

fn of_strain(strain: StrainGradient) -> (&'static str, &'static str) {
    const BBAR: &str = "Hughes 1980; de Souza Neto et al. 1996; Coombs et al. 2018";
    match strain {
        StrainGradient::Standard => ("strains come from the gradient of the shape functions", ""),
        StrainGradient::Cmpm => (
            "strains come from a cubic through the nodes of the cell and its neighbours (composite MPM)",
            "González Acosta, Vardon & Hicks 2017",
        ),
        StrainGradient::CmpmEnds => (
            "strains come from the composite cubic between the ends of the point's CPDI domain (not GIMP), \
             so that they add up to the displacement of the surface",
            "after González Acosta, Vardon & Hicks 2017",
        ),
        StrainGradient::Bbar => {
            ("the skeleton uses the volumetric strain that drives the pore pressure (B-bar)", BBAR)
        }
        StrainGradient::CmpmBbar => (
            "strains come from the composite cubic, but their volumetric part is the one that drives the \
             pore pressure (B-bar)",
            "González Acosta, Vardon & Hicks 2017; Hughes 1980; Coombs et al. 2018",
        ),
    }
}

fn of_pressure(pressure: PressureIntegration) -> (&'static str, &'static str) {
    match pressure {
        PressureIntegration::Points => {
            ("the pore pressure follows from the divergence at each point (full integration)", "")
        }
        PressureIntegration::Sri => (
            "the pore pressure follows from the divergence at the cell centre (selective reduced integration)",
            "Zheng et al. 2021",
        ),
        PressureIntegration::Mean => (
            "the pore pressure follows from the mean divergence over the points of a cell",
            "Mast et al. 2012",
        ),
    }
}

fn of_recovery(recovery: Recovery) -> (&'static str, &'static str) {
    match recovery {
        Recovery::Constant => ("every point gets the pressure increment of its cell", ""),
        Recovery::Patch => (
            "pressure increments are recovered at the points from a plane fitted to the surrounding cells \
             (moving least squares)",
            "Zienkiewicz & Zhu 1992; Zheng et al. 2021",
        ),
        Recovery::PatchSoils => (
            "the fitted plane uses only surrounding cells with the soil of the point",
            "after Zheng et al. 2021",
        ),
        Recovery::Nodal => (
            "the pressure is averaged to the nodes and interpolated back to the points",
            "Detournay & Dzik 2006; Chen et al. 2018",
        ),
        Recovery::NullSpace => (
            "the part of the pressure that causes no nodal force is removed",
            "Gritton & Berzins 2017; Tran & Sołowski 2019",
        ),
        Recovery::Ppp => (
            "the pressure is a nodal field, stabilised by polynomial pressure projection",
            "Dohrmann & Bochev 2004; White & Borja 2008",
        ),
    }
}

fn of_configuration(configuration: Configuration) -> (&'static str, &'static str) {
    match configuration {
        Configuration::Updated => ("points move through the mesh, and shape functions follow them", ""),
        Configuration::Total => (
            "shape functions stay on the initial configuration: the mesh follows the soil (total Lagrangian)",
            "de Vaucorbeil, Nguyen & Hutchinson 2020",
        ),
        Configuration::Frozen => ("nothing moves: infinitesimal strain on the initial configuration", ""),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_named_method_has_words_and_each_of_its_operators_one_part() {
        for name in Method::names() {
            let parts = parts(&Method::named(&name).expect("a known name"));
            assert!(parts.iter().all(|part| part.description.len() > 20), "{name}");
            let choices: Vec<&str> = parts.iter().map(|part| part.choice).collect();
            assert_eq!(choices[..3], ["basis", "strain", "pressure"], "{name}");
            assert_eq!(choices.contains(&"configuration"), name.starts_with("TL-"), "{name}");
        }
        let method = Method::named("GC-SRI-patch").expect("a known name");
        let words: Vec<&str> = parts(&method).iter().map(|part| part.word).collect();
        assert_eq!(words, ["cpgimp", "cmpm", "sri", "patch"]);
    }
}
