//! The operators of a method, each sparse between points, nodes and cell centres: functions of state alone.

pub mod basis;
pub mod corners;
pub mod recovery;
pub mod row;
pub mod sparse_rows;
pub mod stacked_points;
pub mod stencil;
pub mod strain_gradient;

use crate::operators::basis::Shapes;
use crate::operators::corners::{Domains, corner_stencils};
use crate::operators::recovery::RecoveryOperator;
use crate::operators::stencil::PointStencils;
use crate::operators::strain_gradient::StrainOperator;
use crate::state::grid::Grid;
use crate::state::points::Points;
use oedometer_problem::method::{Configuration, Method};

/// The operators of a method on a body's points.
#[derive(Clone, Debug)]
pub struct Operators<const D: usize> {
    /// `N` and `∇N` between points and nodes.
    pub basis: PointStencils<D>,
    /// `G` where it is not the gradient of the basis.
    pub strain: StrainOperator<D>,
    /// Domains of the points where they turn with the material.
    pub domains: Option<Domains<D>>,
    /// `R`, from the sites of the divergence to the points.
    pub recovery: RecoveryOperator<D>,
}

impl<const D: usize> Operators<D> {
    /// Room for those of a method; they are built where the points are.
    pub fn new(method: Method, configuration: Configuration, grid: &Grid<D>, points: &Points<D>) -> Self {
        let count = points.len();
        let domains = Domains::for_method(method, configuration, points);
        Self {
            basis: if domains.is_some() { corner_stencils(count) } else { method.basis.stencils(count) },
            strain: StrainOperator::new(method.strain, count),
            domains,
            recovery: RecoveryOperator::new(method, grid, count),
        }
    }
}
