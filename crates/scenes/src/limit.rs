//! What cannot be together: rows of a scene, and of all scenes.

use crate::column::Column;
use oedometer_problem::formulation::Formulation;
use oedometer_problem::integrator::IntegratorKind;
use oedometer_problem::method::{Configuration, Method};
use oedometer_problem::settings::ExplicitSettings;
use oedometer_problem::time_step::TimeStep;
use oedometer_soil::material::Material;

/// A combination of choices that no run can be made of.
pub struct Limit {
    /// Key that the refusal points at.
    pub key: &'static str,
    /// Whether it is such.
    pub refuses: fn(&Setup<'_>) -> bool,
    /// Why it cannot be.
    pub why: &'static str,
    /// What would be right.
    pub instead: &'static str,
}

/// A case as limits see it: solved by a method of this program.
pub struct Setup<'a> {
    /// Geometry and load.
    pub column: &'a Column,
    /// Soil.
    pub soil: &'a Material,
    /// Operators.
    pub method: Method,
    /// Configuration of the shape functions.
    pub configuration: Configuration,
    /// Integrator.
    pub integrator: IntegratorKind,
    /// Accelerations that the balances keep.
    pub formulation: Formulation,
    /// Choices of the explicit integrator.
    pub settings: &'a ExplicitSettings,
    /// Step size.
    pub time_step: TimeStep,
    /// Cells over the height.
    pub cells: usize,
    /// Whether its critical step is searched.
    pub is_search: bool,
}

/// A method that a scene cannot take, whatever else is chosen.
pub struct MethodLimit {
    /// Whether it is such.
    pub refuses: fn(Method) -> bool,
    /// Why it cannot be.
    pub why: &'static str,
}

/// A rigid plate at small strain needs weights that stay, at nodes whose coefficients are values.
pub(crate) const PLATE_HOLDS_NODES: MethodLimit = MethodLimit {
    refuses: |method| {
        let configuration = method.configuration_in(Configuration::Frozen);
        method.basis.is_spline() || configuration != Configuration::Frozen
    },
    why: "a rigid plate holds the nodes of a face: it needs shape functions that stay on the initial \
          configuration (`frozen`), linear or with domains; coefficients of splines are not nodal values",
};
