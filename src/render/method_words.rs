//! What the names of methods mean, in words.

use oedometer_mpm::method::{
    Basis, Configuration, Memory, Method, PressureIntegration, Quadrature, Recovery, StrainGradient,
};

/// The method of a name in words; `None` where it is no method's.
pub fn method_words(name: &str) -> Option<String> {
    let method = Method::named(name)?;
    let basis = match method.basis {
        Basis::Hat => "linear hat functions",
        Basis::Ugimp => "GIMP with domains of fixed length",
        Basis::Cpgimp => "GIMP with domains that follow the deformation",
        Basis::Cpdi => "CPDI: domains that turn and shear with the soil",
        Basis::Bspline2 => "quadratic B-splines",
        Basis::Bspline3 => "cubic B-splines",
    };
    let strain = match method.strain {
        StrainGradient::Standard => None,
        StrainGradient::Cmpm => Some("composite strain gradient (CMPM) at the points"),
        StrainGradient::CmpmEnds => Some("composite strain gradient (CMPM) between the ends of the domains"),
        StrainGradient::Bbar => Some("B-bar volumetric strain"),
        StrainGradient::CmpmBbar => Some("composite strain gradient (CMPM) with B-bar volumetric strain"),
    };
    let pressure = match method.pressure {
        PressureIntegration::Points => "pressure at the points",
        PressureIntegration::Sri => "pressure at the cell centres (selective reduced integration)",
        PressureIntegration::Mean => "pressure from the mean strain of each cell",
    };
    let recovery = match method.recovery {
        Recovery::Constant if method.pressure == PressureIntegration::Points => None,
        Recovery::Constant => Some("constant per cell"),
        Recovery::Patch => Some("recovered to the points by a patch fit (MLSA)"),
        Recovery::PatchSoils => Some("recovered by a patch fit within each soil"),
        Recovery::Nodal => Some("averaged at the nodes"),
        Recovery::NullSpace => Some("filtered of the null space of the grid"),
        Recovery::Ppp | Recovery::PppStep | Recovery::PppMonotone => {
            Some("a nodal field with polynomial pressure projection")
        }
    };
    let configuration = match method.configuration {
        Some(Configuration::Total) => Some("total Lagrangian: the mesh follows the soil"),
        _ => None,
    };
    let memory = (method.memory == Memory::Cells).then_some("state kept by cells");
    let quadrature = (method.quadrature == Quadrature::Moments).then_some("volumes fitted to the moments of each cell");
    let parts = [configuration, Some(basis), strain, Some(pressure), recovery, memory, quadrature];
    Some(parts.into_iter().flatten().collect::<Vec<_>>().join("; "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_part_of_a_name_has_its_words() {
        assert_eq!(
            method_words("TL-GC-Bbar-patch").as_deref(),
            Some(
                "total Lagrangian: the mesh follows the soil; GIMP with domains that follow the deformation; composite \
                 strain gradient (CMPM) with B-bar volumetric strain; pressure at the cell centres (selective reduced \
                 integration); recovered to the points by a patch fit (MLSA)"
            )
        );
        assert_eq!(method_words("MPM").as_deref(), Some("linear hat functions; pressure at the points"));
        assert_eq!(method_words("growth"), None);
        // Different methods have different words, so that no part is left out.
        let all: Vec<String> = Method::names().iter().filter_map(|name| method_words(name)).collect();
        assert_eq!(all.len(), Method::names().len());
    }
}
