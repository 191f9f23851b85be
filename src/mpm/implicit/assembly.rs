//! The frozen body as a linear system of differential and algebraic equations.
//!
//! With the displacement `U` of the skeleton since the start and the change `π` of the pressures,
//!
//! - mixture, at every free component of a node: `K_σ U − A π = F_0`,
//! - storage, at every site: `(n/K_w) π̇ + D U̇ + D n d⁻¹ A π = −D n d⁻¹ F_w0`,
//!
//! with the operators of the explicit step: `K_σ = Σ V ∇N C G`, `A = Σ V ∇N R`, the divergence `D`
//! and recovery `R` of the method, and the lumped nodal drag `d`, through which the water's
//! relative velocity is eliminated. In short `C ẋ + K x = g`, `C` zero in the rows of the mixture.

use crate::mpm::assembled::stiffness::StrainEntry;
use crate::mpm::body::Body;
use crate::mpm::implicit::banded::Banded;
use crate::mpm::implicit::sparse::{SparseRows, accumulate};
use crate::mpm::implicit::unknowns::Unknowns;
use crate::mpm::operators::basis::ShapeFunction;
use crate::soil::continuity::Continuity;

/// Scales that make the unknowns and the equations pure numbers of like size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scales {
    /// Displacement of one, m: the cell.
    pub length: f64,
    /// Pressure of one, Pa: the oedometric modulus.
    pub pressure: f64,
    /// Force of one, N: that pressure on the face of a cell.
    pub force: f64,
}

impl Scales {
    /// The scales of a body.
    pub fn of<const D: usize, const W: usize, S: ShapeFunction<W>>(body: &Body<D, W, S>) -> Self {
        let (length, pressure) = (body.grid.cell_size, body.material.oedometric_modulus());
        let face: f64 = (1..D).map(|_| length).product();
        Self { length, pressure, force: pressure * face }
    }
}

/// `C ẋ + K x = g` of a frozen body, scaled.
#[derive(Clone, Debug)]
pub struct LinearSystem<const D: usize> {
    /// Numbering of `x`.
    pub unknowns: Unknowns<D>,
    /// Scales of `x` and of the rows.
    pub scales: Scales,
    /// What a step's matrix has whatever its size: `K` in the mixture's rows, `C` in the others.
    pub fixed: Banded,
    /// What it has in proportion to its size: `K` in the storage's rows, 1/s.
    pub proportional: Banded,
    /// Rows of `C`, one a site.
    pub capacity: SparseRows,
    /// `g − K x` at the start, where `x` is zero; 1/s in the storage's rows.
    pub start_residual: Vec<f64>,
    /// Vertical displacement of the loaded surface, as much of it as has the load's shape, as a row
    /// times `x`, m.
    pub surface_displacement: SparseRows,
    /// Its mean over the surface, as a row times `x`, m.
    pub mean_displacement: SparseRows,
    /// Mean over the surface of the relative flux `n (v_w − v_s)`, as a row times `x`, m/s.
    pub surface_outflow: SparseRows,
    /// The same at the start.
    pub start_outflow: f64,
}

/// Entry of the system: row, column, part in `fixed`, part in `proportional`.
type Entry = (usize, usize, f64, f64);

impl<const D: usize> LinearSystem<D> {
    /// Assembles a body on its present operators and stresses.
    pub fn of<const W: usize, S: ShapeFunction<W>>(body: &Body<D, W, S>) -> Self {
        let unknowns = Unknowns::of(body);
        let scales = Scales::of(body);
        let forces = pressure_forces(body, &unknowns);
        let mobility = nodal_mobility(body);
        let visit = |visitor: &mut dyn FnMut(Entry)| {
            mixture_entries(body, &unknowns, &scales, &forces, visitor);
            storage_entries(body, &unknowns, &scales, &forces, &mobility, visitor);
        };
        let (mut lower, mut upper) = (0, 0);
        visit(&mut |(row, column, _, _)| {
            lower = lower.max(row.saturating_sub(column));
            upper = upper.max(column.saturating_sub(row));
        });
        let mut fixed = Banded::zeros(unknowns.count, lower, upper);
        let mut proportional = fixed.clone();
        visit(&mut |(row, column, constant, rate)| {
            fixed.add(row, column, constant);
            proportional.add(row, column, rate);
        });
        let capacity = capacity_rows(body, &unknowns, &scales);
        let start = Start::of(body, &unknowns, &scales, &mobility);
        let [surface_displacement, mean_displacement, surface_outflow] =
            surface_rows(body, &unknowns, &scales, &forces, &mobility);
        Self {
            fixed,
            proportional,
            capacity,
            start_residual: start.residual,
            surface_displacement,
            mean_displacement,
            surface_outflow,
            start_outflow: start.outflow,
            unknowns,
            scales,
        }
    }
}

/// Rows of `A`, by node and component: force of a unit pressure change at each site, m^(D−1).
fn pressure_forces<const D: usize, const W: usize, S: ShapeFunction<W>>(
    body: &Body<D, W, S>,
    unknowns: &Unknowns<D>,
) -> Vec<[Vec<(usize, f64)>; D]> {
    let mut forces = vec![std::array::from_fn(|_| Vec::new()); body.nodes.len()];
    for point in 0..body.points.len() {
        let volume = body.points.volume(point);
        body.basis.visit(body.grid.node_stride(), point, |node, _, gradient| {
            unknowns.visit_recovery(point, |site, weight| {
                for direction in (0..D).filter(|d| gradient[*d] != 0.0) {
                    accumulate(&mut forces[node][direction], site, volume * weight * gradient[direction]);
                }
            });
        });
    }
    forces
}

/// Relative velocity that a unit of water force makes, by node: one over the drag, m/(N s).
fn nodal_mobility<const D: usize, const W: usize, S: ShapeFunction<W>>(body: &Body<D, W, S>) -> Vec<f64> {
    let drag = |node: usize| body.nodes.drag[node];
    (0..body.nodes.len())
        .map(|node| if body.nodes.is_active(node) && drag(node) > 0.0 { 1.0 / drag(node) } else { 0.0 })
        .collect()
}

/// Porosity that goes with the relative velocity of a node in the storage at a site: the node's
/// own in the conservative form, the site's where its gradient is dropped.
fn porosity_of_flux<const D: usize, const W: usize, S: ShapeFunction<W>>(
    body: &Body<D, W, S>,
    unknowns: &Unknowns<D>,
    site: usize,
    node: usize,
) -> f64 {
    match body.material.continuity {
        Continuity::Conservative => body.nodes.porosity[node],
        Continuity::ConstantPorosityGradient => unknowns.porosity(body, site),
    }
}

fn mixture_entries<const D: usize, const W: usize, S: ShapeFunction<W>>(
    body: &Body<D, W, S>,
    unknowns: &Unknowns<D>,
    scales: &Scales,
    forces: &[[Vec<(usize, f64)>; D]],
    visitor: &mut dyn FnMut(Entry),
) {
    let stride = body.grid.node_stride();
    let (lame, shear) = (body.stiffness.lame, body.stiffness.shear);
    for point in 0..body.points.len() {
        let straining = body.strain_row(point, &unknowns.rows);
        let factor = body.points.volume(point) * scales.length / scales.force;
        body.basis.visit(stride, point, |node, _, force| {
            for i in 0..D {
                let Some(row) = unknowns.displacement[node][i] else { continue };
                for StrainEntry { node: other, gradient: strain, dilation } in &straining {
                    let along: f64 = (0..D).map(|d| force[d] * strain[d]).sum();
                    for j in 0..D {
                        let Some(column) = unknowns.displacement[*other][j] else { continue };
                        let mut entry = lame * force[i] * strain[j] + shear * force[j] * strain[i];
                        entry += (lame + 2.0 / 3.0 * shear) * force[i] * dilation[j];
                        if i == j {
                            entry += shear * along;
                        }
                        if entry != 0.0 {
                            visitor((row, column, factor * entry, 0.0));
                        }
                    }
                }
            }
        });
    }
    for (node, components) in forces.iter().enumerate() {
        for (direction, sites) in components.iter().enumerate() {
            let Some(row) = unknowns.displacement[node][direction] else { continue };
            for (site, force) in sites {
                visitor((row, unknowns.pressure[*site], -force * scales.pressure / scales.force, 0.0));
            }
        }
    }
}

fn storage_entries<const D: usize, const W: usize, S: ShapeFunction<W>>(
    body: &Body<D, W, S>,
    unknowns: &Unknowns<D>,
    scales: &Scales,
    forces: &[[Vec<(usize, f64)>; D]],
    mobility: &[f64],
    visitor: &mut dyn FnMut(Entry),
) {
    let capacity = capacity_rows(body, unknowns, scales);
    for site in 0..unknowns.sites.len() {
        let row = unknowns.pressure[site];
        for (column, value) in capacity.row(site) {
            visitor((row, column, value, 0.0));
        }
        unknowns.visit_divergence(site, |node, divergence| {
            let flux_of_force = porosity_of_flux(body, unknowns, site, node) * mobility[node];
            for direction in 0..D {
                // Where the water is held, nothing flows; on a rough base it slides.
                if body.nodes.water_free[node][direction] == 0.0 {
                    continue;
                }
                for (other, force) in &forces[node][direction] {
                    let rate = divergence[direction] * flux_of_force * force * scales.pressure;
                    visitor((row, unknowns.pressure[*other], 0.0, rate));
                }
            }
        });
    }
}

fn capacity_rows<const D: usize, const W: usize, S: ShapeFunction<W>>(
    body: &Body<D, W, S>,
    unknowns: &Unknowns<D>,
    scales: &Scales,
) -> SparseRows {
    let mut rows = SparseRows::new();
    for site in 0..unknowns.sites.len() {
        let storage = unknowns.porosity(body, site) / body.material.water_bulk_modulus;
        let mut row = vec![(unknowns.pressure[site], storage * scales.pressure)];
        unknowns.visit_divergence(site, |node, divergence| {
            for direction in 0..D {
                if let Some(column) = unknowns.displacement[node][direction] {
                    accumulate(&mut row, column, divergence[direction] * scales.length);
                }
            }
        });
        rows.push_row(row);
    }
    rows
}

/// What the stresses of the start do.
struct Start {
    residual: Vec<f64>,
    outflow: f64,
}

impl Start {
    fn of<const D: usize, const W: usize, S: ShapeFunction<W>>(
        body: &Body<D, W, S>,
        unknowns: &Unknowns<D>,
        scales: &Scales,
        mobility: &[f64],
    ) -> Self {
        let mut loaded = body.clone();
        loaded.map_forces();
        let nodes = &loaded.nodes;
        let mut residual = vec![0.0; unknowns.count];
        let mut outflow = vec![[0.0; D]; nodes.len()];
        for node in 0..nodes.len() {
            for d in 0..D {
                if let Some(row) = unknowns.displacement[node][d] {
                    residual[row] = nodes.mixture_force[node][d] / scales.force;
                }
                if nodes.water_free[node][d] > 0.0 {
                    outflow[node][d] = nodes.porosity[node] * mobility[node] * nodes.water_force[node][d];
                }
            }
        }
        for site in 0..unknowns.sites.len() {
            let mut rate = 0.0;
            unknowns.visit_divergence(site, |node, divergence| {
                let flux_of_force = porosity_of_flux(body, unknowns, site, node) * mobility[node];
                for d in (0..D).filter(|d| nodes.water_free[node][*d] > 0.0) {
                    rate += divergence[d] * flux_of_force * nodes.water_force[node][d];
                }
            });
            residual[unknowns.pressure[site]] = -rate;
        }
        Self { residual, outflow: body.surface.mean_of(&body.grid, &body.points, &outflow) }
    }
}

/// Rows of the surface's displacement as it settles, of its mean, and of the mean relative flux through
/// it.
fn surface_rows<const D: usize, const W: usize, S: ShapeFunction<W>>(
    body: &Body<D, W, S>,
    unknowns: &Unknowns<D>,
    scales: &Scales,
    forces: &[[Vec<(usize, f64)>; D]],
    mobility: &[f64],
) -> [SparseRows; 3] {
    let (mut settled, mut moved, mut outflow) = (Vec::new(), Vec::new(), Vec::new());
    for (node, weight) in body.surface.weights(&body.grid, &body.points) {
        let Some(unknown) = unknowns.displacement[node][D - 1] else { continue };
        accumulate(&mut settled, unknown, weight * scales.length);
    }
    for (node, weight) in body.surface.mean_weights(&body.grid, &body.points) {
        let Some(unknown) = unknowns.displacement[node][D - 1] else { continue };
        accumulate(&mut moved, unknown, weight * scales.length);
        let flux_of_force = weight * body.nodes.porosity[node] * mobility[node];
        for (site, force) in &forces[node][D - 1] {
            accumulate(&mut outflow, unknowns.pressure[*site], flux_of_force * force * scales.pressure);
        }
    }
    let row = |entries: Vec<(usize, f64)>| {
        let mut rows = SparseRows::new();
        rows.push_row(entries);
        rows
    };
    [row(settled), row(moved), row(outflow)]
}
