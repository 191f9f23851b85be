//! A method is a choice of four independent operators and of the configuration they live on.

use oedometer_soil::material::Material;
use oedometer_wording::{is_default, words};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::sync::LazyLock;

/// Shape functions between points and nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Basis {
    /// Piecewise linear hat functions: the original MPM.
    Hat,
    /// GIMP with point domains that keep their length.
    Ugimp,
    /// GIMP with point domains that follow the deformation.
    Cpgimp,
    /// Hat functions averaged over the ends of domains that follow the deformation, in the plane over the corners
    /// of parallelograms that turn and shear with it (CPDI, Sadeghirad, Brannon & Burghardt 2011): domains that
    /// tile the material keep tiling it.
    Cpdi,
    /// Quadratic B-splines at the points (Steffen, Kirby & Berzins 2008).
    Bspline2,
    /// Cubic B-splines at the points.
    Bspline3,
}

words!(Basis: Hat "hat", Ugimp "ugimp", Cpgimp "cpgimp", Cpdi "cpdi", Bspline2 "bspline2", Bspline3 "bspline3");

impl Basis {
    /// Whether the basis reaches beyond walls and free surfaces, with coefficients that are not nodal values.
    pub fn is_spline(self) -> bool {
        matches!(self, Self::Bspline2 | Self::Bspline3)
    }
}

/// Gradient that gives the strain for the effective stress.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StrainGradient {
    /// The gradient of the basis.
    Standard,
    /// Lagrange interpolant through the nodes of the cell and of its neighbours.
    Cmpm,
    /// The same interpolant between the ends of the point's domain, which it also carries: strains
    /// add up to the surface's displacement wherever the points are.
    CmpmEnds,
    /// The gradient of the basis with its trace replaced by the method's own volumetric rate, the
    /// one that drives the pressure: B-bar by cells (Hughes 1980), in the rate form F-bar (de Souza
    /// Neto et al. 1996; Coombs et al. 2018 for material points; with means at the nodes Zhao, Jiang & Choo 2023).
    Bbar,
    /// The composite gradient with its trace replaced so.
    CmpmBbar,
}

words!(StrainGradient: Standard "standard",
    Cmpm "cmpm",
    CmpmEnds "cmpm-ends",
    Bbar "bbar",
    CmpmBbar "cmpm-bbar",);

impl StrainGradient {
    /// Whether the Lagrange interpolant is taken, at the points or between the ends of their domains.
    #[inline]
    pub fn is_composite(self) -> bool {
        matches!(self, Self::Cmpm | Self::CmpmEnds | Self::CmpmBbar)
    }

    /// Whether the skeleton's volumetric strain goes the way of the water's.
    #[inline]
    pub fn is_bbar(self) -> bool {
        matches!(self, Self::Bbar | Self::CmpmBbar)
    }

    /// The same with the volumetric strain of the pressure's divergence, where there is one.
    pub fn with_bbar(self) -> Option<Self> {
        match self {
            Self::Standard | Self::Bbar => Some(Self::Bbar),
            Self::Cmpm | Self::CmpmBbar => Some(Self::CmpmBbar),
            Self::CmpmEnds => None,
        }
    }
}

/// Sites of the divergence that drives the pore pressure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PressureIntegration {
    /// At the points: full integration.
    Points,
    /// At the cell centres: selective reduced integration.
    Sri,
    /// Mean over the points of a cell, weighted with their volumes: strain smoothing by cells (Mast,
    /// Mackenzie-Helnwein, Arduino, Miller & Shin 2012).
    Mean,
}

words!(PressureIntegration: Points "points", Sri "sri", Mean "mean");

impl PressureIntegration {
    /// Whether there is one value a cell.
    #[inline]
    pub fn is_by_cells(self) -> bool {
        self != Self::Points
    }
}

/// Recovery of pressure increments at the points from those at the cell centres.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Recovery {
    /// Each point takes its cell's increment.
    Constant,
    /// Moving least squares over the surrounding block of cells (MLSA).
    Patch,
    /// Moving least squares over those cells around that hold the soil of the point; points of a cell that an interface
    /// cuts share one vertical stress.
    PatchSoils,
    /// Means at the nodes, interpolated to the points: of the cells around a node, nodal averaging of the
    /// volumetric rate (Detournay & Dzik 2006; Jassim, Stolle & Vermeer 2013); of the points around it,
    /// pressure as a nodal field of its own (Chen, Zhang, Sze, Kan & Qiu 2018).
    Nodal,
    /// Of values at the points, without the part that no nodal force feels: null-space filter by
    /// cells (Gritton & Berzins 2017; Tran & Sołowski 2019).
    NullSpace,
    /// A nodal field stabilised by polynomial pressure projection (Dohrmann & Bochev 2004), with the parameter
    /// `1/(2G)` (White & Borja 2008).
    Ppp,
}

words!(Recovery: Constant "constant",
    Patch "patch",
    PatchSoils "patch-soils",
    Nodal "nodal",
    NullSpace "null-space",
    Ppp "ppp",);

impl Recovery {
    /// Why a recovery does not go with a place of the divergence or a strain gradient, where it does not.
    pub fn refuses(self, pressure: PressureIntegration, strain: StrainGradient) -> Option<&'static str> {
        if self.is_projected() && pressure.is_by_cells() {
            return Some(
                "the projection is for a pressure at the nodes, whose divergence is evaluated at the points",
            );
        }
        if self.is_projected() && strain.is_bbar() {
            return Some(
                "B-bar uses the volumetric rate of a point or cell, but a projection has it at the nodes",
            );
        }
        match (self, pressure.is_by_cells()) {
            (Self::NullSpace, true) => Some("a single value in a cell has no null space"),
            (Self::Patch | Self::PatchSoils, false) => {
                Some("values at the points need no recovery from cells")
            }
            _ => None,
        }
    }

    /// Whether it is a stabilised nodal field.
    pub fn is_projected(self) -> bool {
        self == Self::Ppp
    }
}

/// Where stress, pressure and volume are kept while points move through the mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Memory {
    /// Each point keeps its whole history.
    #[default]
    Points,
    /// The cells: within a cell the points follow the parabola through the means of its
    /// neighbourhood. What no equation of the grid sees is forgotten.
    Cells,
}

words!(Memory: Points "points", Cells "cells");

/// Volume of the initial configuration that a point integrates.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Quadrature {
    /// The volume of its domain.
    #[default]
    Volumes,
    /// The volume with which the points of a cell integrate constant and linear fields exactly, wherever they lie in it: moment
    /// fitting (Müller, Kummer & Oberlack 2013).
    Moments,
}

words!(Quadrature: Volumes "volumes", Moments "moments");

impl Quadrature {
    /// Why it does not go with a basis, where it does not.
    pub fn refuses(self, basis: Basis) -> Option<&'static str> {
        (self == Self::Moments && basis != Basis::Hat).then_some(
            "moments are fitted over cells, but the domains or splines of this basis reach beyond them",
        )
    }
}

/// Configuration on which shape functions are built.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Configuration {
    /// Points move and shape functions follow them.
    Updated,
    /// Finite strain with shape functions that stay on the initial configuration: gradients are pushed
    /// forward by the inverse deformation gradient.
    Total,
    /// Nothing moves: infinitesimal strain on the initial configuration.
    Frozen,
}

words!(Configuration: Updated "updated", Total "total", Frozen "frozen");

impl Configuration {
    /// Whether points change place and weights follow.
    #[inline]
    pub fn moves_points(self) -> bool {
        self == Self::Updated
    }

    /// Whether volumes, porosities and conductivities follow the deformation.
    #[inline]
    pub fn deforms(self) -> bool {
        self != Self::Frozen
    }
}

/// The four operators of a method; `configuration` is left to the scene where it is `None`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Method {
    /// Shape functions between points and nodes.
    pub basis: Basis,
    /// Strain gradient for the effective stress.
    pub strain: StrainGradient,
    /// Place of the pressure divergence.
    pub pressure: PressureIntegration,
    /// Way of the pressure increment back to the points; full integration needs none.
    pub recovery: Recovery,
    /// Memory of the state while points move.
    #[serde(default, skip_serializing_if = "is_default")]
    pub memory: Memory,
    /// Volume that a point integrates.
    #[serde(default, skip_serializing_if = "is_default")]
    pub quadrature: Quadrature,
    /// Parameter of a pressure projection over that of its source, in thousandths.
    #[serde(default = "full_projection", skip_serializing_if = "is_full_projection")]
    pub projection: u32,
    /// Configuration of the shape functions, where the method insists on one.
    pub configuration: Option<Configuration>,
}

/// The projection's own parameter, in thousandths.
pub const FULL_PROJECTION: u32 = 1000;

fn full_projection() -> u32 {
    FULL_PROJECTION
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "the signature that serde asks for")]
fn is_full_projection(thousandths: &u32) -> bool {
    *thousandths == FULL_PROJECTION
}

/// The paper's ladder of methods and others beside it, without prefixes: one line a method.
const NAMED: &[(&str, Basis, StrainGradient, PressureIntegration, Recovery)] = {
    use Basis::{Bspline2, Bspline3, Cpdi, Cpgimp, Hat};
    use PressureIntegration::{Mean, Points, Sri};
    use Recovery::{Constant, Nodal, NullSpace, Patch, PatchSoils, Ppp};
    use StrainGradient::{Bbar, Cmpm, CmpmBbar, CmpmEnds, Standard};
    &[
        ("MPM", Hat, Standard, Points, Constant),
        ("MPM-SRI-patch", Hat, Standard, Sri, Patch),
        ("GIMP", Cpgimp, Standard, Points, Constant),
        ("GIMP-SRI", Cpgimp, Standard, Sri, Constant),
        ("GIMP-SRI-patch", Cpgimp, Standard, Sri, Patch),
        ("GIMP-SRI-patch-soils", Cpgimp, Standard, Sri, PatchSoils),
        ("GC-SRI-patch", Cpgimp, Cmpm, Sri, Patch),
        ("CPDI", Cpdi, Standard, Points, Constant),
        ("CPDI-SRI-patch", Cpdi, Standard, Sri, Patch),
        ("CE-SRI-patch", Cpdi, CmpmEnds, Sri, Patch),
        ("GIMP-null-space", Cpgimp, Standard, Points, NullSpace),
        ("GIMP-mean", Cpgimp, Standard, Mean, Constant),
        ("GIMP-SRI-nodal", Cpgimp, Standard, Sri, Nodal),
        ("VP", Cpgimp, Standard, Points, Nodal),
        ("PPP", Cpgimp, Standard, Points, Ppp),
        ("VP-Bbar", Cpgimp, Bbar, Points, Nodal),
        ("GIMP-Bbar", Cpgimp, Bbar, Sri, Constant),
        ("GIMP-Bbar-patch", Cpgimp, Bbar, Sri, Patch),
        ("GC-Bbar-patch", Cpgimp, CmpmBbar, Sri, Patch),
        ("B2", Bspline2, Standard, Points, Constant),
        ("B2-SRI-patch", Bspline2, Standard, Sri, Patch),
        ("B2-Bbar-patch", Bspline2, Bbar, Sri, Patch),
        ("B3-SRI-patch", Bspline3, Standard, Sri, Patch),
    ]
};

/// Every method that has a name, with its first one: every line of a plan and of a table asks.
static KNOWN: LazyLock<Vec<(Method, String)>> = LazyLock::new(|| {
    let with_method = |name: String| Some((Method::named(&name)?, name));
    Method::names().into_iter().filter_map(with_method).collect()
});

/// Prefix of the names of methods with shape functions on the initial configuration.
const TOTAL_PREFIX: &str = "TL-";
/// Suffix of the names of methods with the cell-averaged projection.
const CELLS_SUFFIX: &str = "-cells";
/// Suffix of the names of methods with moment-fitted volumes.
const MOMENTS_SUFFIX: &str = "-moments";

impl Method {
    /// The original MPM: hat functions, everything at the points.
    pub const STANDARD: Self = Self {
        basis: Basis::Hat,
        strain: StrainGradient::Standard,
        pressure: PressureIntegration::Points,
        recovery: Recovery::Constant,
        memory: Memory::Points,
        quadrature: Quadrature::Volumes,
        projection: FULL_PROJECTION,
        configuration: None,
    };

    /// The method of a name, bare, with the prefix `u` for fixed domains, with the prefix `TL-` for
    /// shape functions on the initial configuration, with the suffix `-cells` for the cell-averaged projection, or with
    /// the suffix `-moments` for moment-fitted volumes.
    pub fn named(name: &str) -> Option<Self> {
        if let Some(bare) = name.strip_suffix(CELLS_SUFFIX) {
            let method = Self::named(bare).filter(|method| method.configuration.is_none())?;
            return (method.memory == Memory::Points).then_some(Self { memory: Memory::Cells, ..method });
        }
        if let Some(bare) = name.strip_prefix(TOTAL_PREFIX) {
            let method = Self::named(bare).filter(|method| method.configuration.is_none())?;
            // Domains on the initial configuration have nothing to follow.
            let total = Self { configuration: Some(Configuration::Total), ..method };
            return (method.basis != Basis::Ugimp).then_some(total);
        }
        if let Some(bare) = name.strip_suffix(MOMENTS_SUFFIX) {
            let quadrature = Quadrature::Moments;
            let method = Self::named(bare).filter(|method| quadrature.refuses(method.basis).is_none())?;
            return (method.quadrature == Quadrature::Volumes).then_some(Self { quadrature, ..method });
        }
        let (bare, fixed_domains) = match name.strip_prefix('u') {
            Some(rest) => (rest, true),
            None => (name, false),
        };
        let (_, basis, strain, pressure, recovery) = *NAMED.iter().find(|row| row.0 == bare)?;
        let basis = match (fixed_domains, basis) {
            (false, basis) => basis,
            (true, Basis::Cpgimp) => Basis::Ugimp,
            (true, _) => return None,
        };
        Some(Self { basis, strain, pressure, recovery, ..Self::STANDARD })
    }

    /// Every name that `named` knows.
    pub fn names() -> Vec<String> {
        let bare = NAMED.iter().map(|row| row.0.to_owned());
        let fixed = NAMED.iter().filter(|row| row.1 == Basis::Cpgimp).map(|row| format!("u{}", row.0));
        let total = NAMED.iter().map(|row| format!("{TOTAL_PREFIX}{}", row.0));
        let cells = NAMED.iter().filter(|row| row.4 == Recovery::Patch);
        let cells = cells.map(|row| format!("{}{CELLS_SUFFIX}", row.0));
        let fitted = NAMED.iter().filter(|row| Quadrature::Moments.refuses(row.1).is_none());
        let fitted: Vec<String> = fitted.map(|row| format!("{}{MOMENTS_SUFFIX}", row.0)).collect();
        let fitted_total: Vec<String> = fitted.iter().map(|name| format!("{TOTAL_PREFIX}{name}")).collect();
        bare.chain(fixed).chain(total).chain(cells).chain(fitted).chain(fitted_total).collect()
    }

    /// The operators in the words of a study file: `basis+strain+pressure+recovery`.
    pub fn choices(&self) -> String {
        let mut choices = format!("{}+{}+{}", self.basis.name(), self.strain.name(), self.pressure.name());
        if (self.pressure, self.recovery) != (PressureIntegration::Points, Recovery::Constant) {
            choices = format!("{choices}+{}", self.recovery.name());
        }
        if self.projection != FULL_PROJECTION {
            choices = format!("{choices}({})", f64::from(self.projection) / f64::from(FULL_PROJECTION));
        }
        if self.quadrature == Quadrature::Moments {
            choices = format!("{choices}+{}", self.quadrature.name());
        }
        match self.memory {
            Memory::Points => choices,
            Memory::Cells => format!("{choices}+{}", self.memory.name()),
        }
    }

    /// Whether increments come back from the cells by a patch.
    pub fn uses_patch(&self) -> bool {
        self.pressure.is_by_cells() && matches!(self.recovery, Recovery::Patch | Recovery::PatchSoils)
    }

    /// Whether the pressure is a nodal field of its own.
    pub fn has_nodal_pressure(&self) -> bool {
        self.pressure == PressureIntegration::Points
            && (self.recovery == Recovery::Nodal || self.recovery.is_projected())
    }

    /// Whether the pressure is a nodal field with a stabilised storage: its sites are nodes.
    pub fn has_projection(&self) -> bool {
        self.pressure == PressureIntegration::Points && self.recovery.is_projected()
    }

    /// Whether the domains of the points follow the deformation.
    pub fn domains_follow(&self) -> bool {
        matches!(self.basis, Basis::Cpgimp | Basis::Cpdi)
    }

    /// Configuration of the shape functions in a scene with a configuration of its own. Where nothing moves, shape functions
    /// on the initial configuration (`TL-`) are those of the scene.
    pub fn configuration_in(&self, scene: Configuration) -> Configuration {
        match (self.configuration, scene) {
            (Some(Configuration::Total), Configuration::Frozen) => scene,
            (chosen, scene) => chosen.unwrap_or(scene),
        }
    }
}

impl fmt::Display for Method {
    /// The name where there is one, the four choices otherwise.
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name_of = |method: Self| KNOWN.iter().find(|(known, _)| *known == method).map(|(_, name)| name);
        if let Some(name) = name_of(*self) {
            return out.write_str(name);
        }
        match (name_of(Self { configuration: None, ..*self }), self.configuration) {
            (Some(name), None) => write!(out, "{name}"),
            (Some(name), Some(configuration)) => write!(out, "{name} ({})", configuration.name()),
            (None, None) => write!(out, "{}", self.choices()),
            (None, Some(configuration)) => write!(out, "{} ({})", self.choices(), configuration.name()),
        }
    }
}

impl Method {
    /// Parameter `τ` of the projection in a soil, 1/Pa: `1/(2G)` (White & Borja 2008).
    pub fn projection_parameter(&self, soil: &Material) -> f64 {
        let source =
            if self.has_projection() { (1.0 + soil.poissons_ratio) / soil.youngs_modulus } else { 0.0 };
        source * f64::from(self.projection) / f64::from(FULL_PROJECTION)
    }

    /// Speed of the longest wave of a column of so many cells, `4H`, over that without a projection: the projection adds
    /// `τ (κh)²/12` to the storage `n/K_w` of a wave of number `κ`. One for a method without it.
    pub fn share_of_wave_speed(&self, soil: &Material, cells: usize) -> f64 {
        if !self.has_projection() {
            return 1.0;
        }
        let per_cell = 0.5 * std::f64::consts::PI / cells as f64;
        let storage = soil.porosity / soil.water_bulk_modulus;
        let added = self.projection_parameter(soil) * per_cell * per_cell / 12.0;
        let modulus = |storage: f64| soil.oedometric_modulus() + 1.0 / storage;
        (modulus(storage + added) / modulus(storage)).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_named_method_is_displayed_by_its_name() {
        for name in Method::names() {
            assert_eq!(Method::named(&name).map(|method| method.to_string()), Some(name));
        }
    }

    #[test]
    fn unknown_names_are_refused() {
        for name in [
            "",
            "uMPM",
            "gimp",
            "GC-SRI",
            "uuGIMP",
            "TL-",
            "TL-uGIMP",
            "TL-TL-GIMP",
            "TL-GIMP-cells",
            "GIMP-cells-cells",
            "GIMP-moments",
            "MPM-moments-moments",
        ] {
            assert_eq!(Method::named(name), None, "{name}");
        }
    }

    #[test]
    fn a_free_combination_is_displayed_by_its_choices() {
        let method = Method {
            basis: Basis::Hat,
            strain: StrainGradient::Cmpm,
            pressure: PressureIntegration::Sri,
            recovery: Recovery::Patch,
            memory: Memory::Points,
            quadrature: Quadrature::Volumes,
            projection: FULL_PROJECTION,
            configuration: Some(Configuration::Updated),
        };
        assert_eq!(method.to_string(), "hat+cmpm+sri+patch (updated)");
        let weaker = Method { projection: 125, ..Method::named("PPP").expect("a known method") };
        assert_eq!(weaker.to_string(), "cpgimp+standard+points+ppp(0.125)");
        let fitted = Method { quadrature: Quadrature::Moments, configuration: None, ..method };
        assert_eq!(fitted.to_string(), "hat+cmpm+sri+patch+moments");
    }
}
