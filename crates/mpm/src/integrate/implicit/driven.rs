//! A rigid plate pushed into a yielding soil: small strain, no inertia, undrained.
//!
//! At the end of a step of the plate the forces on all free nodes vanish,
//!
//! ```text
//! Σ V ∇N (σ'(Δε) − p 1) = 0,   Δε = G Δu,   p = p_n − R Q D Δu
//! ```
//!
//! with the operators `G`, `D` and `R` of the method, and what they leave at the nodes of the plate is its force. Newton's
//! iteration takes the consistent tangent of each point (Simo & Taylor 1985) as its stiffness. In total stress there is no
//! `p`, and the problem's method takes the volume of `Δε` by `R D` as B-bar does.

use crate::direct_solver::system::{Factors, SystemMatrix};
use crate::integrate::assembled::stiffness::{NodeBlocks, StrainEntry, pressure_stiffness};
use crate::integrate::implicit::no_pivot;
use crate::integrate::implicit::unknowns::Unknowns;
use crate::integrate::run_plan::Plan;
use crate::integrate::stepper::{EqualSteps, StepFailure, Stepper, Work};
use crate::kernel::body::{Body, DrivenPlate};
use crate::state::points::Points;
use crate::time_limit::TimeLimit;
use oedometer_problem::outcome::FailureKind;
use oedometer_problem::snapshot::Snapshot;
use oedometer_soil::law::StrainIncrement;
use oedometer_soil::plasticity::Tangent;
use oedometer_soil::tensor::{Tensor, Vector};

/// Most iterations of a step.
const MOST_ITERATIONS: usize = 20;
/// Times that a step is halved before the run ends.
const MOST_HALVINGS: u32 = 8;
/// Largest force that is left on a free node, over that of the strength on a cell.
const TOLERANCE: f64 = 1e-8;
/// Halvings of a correction that does not bring the forces down.
const MOST_CUTS: u32 = 4;

/// Stepper of a body under a plate.
pub struct DrivenStepper<const D: usize> {
    body: Body<D>,
    start: Points<D>,
    /// Points of the accepted state.
    anchor: Points<D>,
    plate: DrivenPlate,
    /// Nodes of the plate.
    under_plate: Vec<usize>,
    unknowns: Unknowns<D>,
    /// The gradient at each point as a row.
    strains: Vec<Vec<StrainEntry<D>>>,
    /// Consistent tangents of the points, Pa.
    tangents: Vec<Tangent>,
    /// `A Q D`, N/m; empty in total stress.
    pressure_stiffness: NodeBlocks<D>,
    stiffness: NodeBlocks<D>,
    matrix: SystemMatrix,
    factors: Factors,
    time_limit: TimeLimit,
    /// Force that is left on a free node when a step is solved, N.
    tolerance: f64,
    /// Displacements of the nodes in a step, m, and of the last one a second.
    increment: Vec<Vector<D>>,
    rate: Option<Vec<Vector<D>>>,
    /// Forces on the unknowns, N.
    forces: Vec<f64>,
    settlement: f64,
    plate_force: f64,
    work: Work,
}

impl<const D: usize> DrivenStepper<D> {
    /// A body at its start.
    pub fn new(body: Body<D>, plate: DrivenPlate, plan: &Plan<'_>) -> Self {
        let mut rows = body.volumetric_rows();
        if !plate.has_water {
            rows.coupling.fill(0.0);
        }
        let pressure_stiffness = if plate.has_water {
            pressure_stiffness(&body.coupled_pressure_forces(&rows), &rows.divergence)
        } else {
            NodeBlocks::zero(body.nodes.len())
        };
        let strains: Vec<_> = (0..body.points.len()).map(|point| body.strain_row(point, &rows)).collect();
        let tangents = vec![[[0.0; 4]; 4]; body.points.len()];
        let mut stiffness = pressure_stiffness.clone();
        add_tangents(&mut stiffness, &body, &strains, &tangents);
        let unknowns = Unknowns::of_displacements(&body, rows);
        let matrix = SystemMatrix::spanning(&unknowns.positions, unknowns.border, |visitor| {
            unknowns.visit_places(&stiffness, visitor);
        });
        let held = body.support().plate;
        let is_under = |node: &usize| held.is_some_and(|plate| plate.holds(&body.grid, *node));
        let face: f64 = (1..D).map(|_| body.grid.cell_size).product();
        Self {
            start: body.points.clone(),
            anchor: body.points.clone(),
            plate,
            under_plate: (0..body.nodes.len()).filter(is_under).collect(),
            strains,
            tangents,
            pressure_stiffness,
            stiffness,
            factors: Factors::of_shape(&matrix, plan.schedule.threads, plan.schedule.time_limit),
            matrix,
            time_limit: plan.schedule.time_limit,
            tolerance: TOLERANCE * plan.pressure_scale * face,
            increment: vec![[0.0; D]; body.nodes.len()],
            rate: None,
            forces: vec![0.0; unknowns.count],
            unknowns,
            settlement: 0.0,
            plate_force: 0.0,
            work: Work::default(),
            body,
        }
    }

    /// Takes a step, in halves where the iteration does not converge.
    fn step_within(&mut self, dt: f64, halvings: u32) -> Result<(), StepFailure> {
        match self.try_step(dt) {
            Err(failure) if halvings > 0 && failure.kind == FailureKind::NotConverged => {
                self.work.rejected_steps += 1;
                self.step_within(0.5 * dt, halvings - 1)?;
                self.step_within(0.5 * dt, halvings - 1)
            }
            done => done,
        }
    }

    fn try_step(&mut self, dt: f64) -> Result<(), StepFailure> {
        self.guess(dt)?;
        let mut left = self.strain_and_balance();
        for _ in 0..MOST_ITERATIONS {
            if left <= self.tolerance {
                self.accept(dt);
                return Ok(());
            }
            self.factor_tangent()?;
            let mut correction = self.forces.clone();
            self.factors.solve(&mut correction);
            left = self.correct(&correction, left);
            self.work.iterations += 1;
        }
        Err(StepFailure {
            kind: FailureKind::NotConverged,
            reason: format!(
                "a force of {left:.3e} N is left on a node after {MOST_ITERATIONS} iterations; {:.3e} N are allowed",
                self.tolerance
            ),
        })
    }

    /// Moves the plate, and the nodes by their last rates; in the first step by those of the elastic body.
    fn guess(&mut self, dt: f64) -> Result<(), StepFailure> {
        if let Some(rate) = &self.rate {
            for (increment, rate) in self.increment.iter_mut().zip(rate) {
                *increment = rate.map(|component| dt * component);
            }
            return Ok(());
        }
        self.increment.fill([0.0; D]);
        self.strain_and_balance();
        for node in &self.under_plate {
            self.increment[*node][D - 1] = -dt * self.plate.velocity;
        }
        self.factor_tangent()?;
        let pushed = self.stiffness.product(&self.increment);
        let mut moved = vec![0.0; self.unknowns.count];
        self.unknowns.visit_numbers(|node, d, number| moved[number] -= pushed[node][d]);
        self.factors.solve(&mut moved);
        self.add(&moved, 1.0);
        Ok(())
    }

    /// Adds a correction of the unknowns, or as much of it as brings the forces down; the largest force that is left, N.
    fn correct(&mut self, correction: &[f64], before: f64) -> f64 {
        let mut share = 1.0;
        self.add(correction, share);
        let mut left = self.strain_and_balance();
        for _ in 0..MOST_CUTS {
            if left < before {
                break;
            }
            self.add(correction, -0.5 * share);
            share *= 0.5;
            left = self.strain_and_balance();
        }
        left
    }

    /// Adds so much of a correction of the unknowns to the displacements.
    fn add(&mut self, correction: &[f64], share: f64) {
        let increment = &mut self.increment;
        self.unknowns.visit_numbers(|node, d, number| increment[node][d] += share * correction[number]);
    }

    /// Strains the points by the present increment, and puts their forces on the nodes; the largest one on a free node, N.
    fn strain_and_balance(&mut self) -> f64 {
        let (body, rows) = (&mut self.body, &self.unknowns.rows);
        for (point, entries) in self.strains.iter().enumerate() {
            let (mut gradient, mut dilation) = ([[0.0; D]; D], 0.0);
            for entry in entries {
                let displacement = &self.increment[entry.node];
                entry.add_to(&mut gradient, displacement);
                dilation += (0..D).map(|d| entry.dilation[d] * displacement[d]).sum::<f64>();
            }
            let strain = StrainIncrement { gradient, dilation, volume_ratio: [1.0; 2] };
            let (mut stress, mut history) = (self.anchor.effective_stress[point], self.anchor.history[point]);
            let law = body.stress_law_of(point);
            if let Some(tangent) = law.update_plastic(&mut stress, &mut history, &strain.components()) {
                self.tangents[point] = tangent;
            }
            (body.points.effective_stress[point], body.points.history[point]) = (stress, history);
        }
        if self.plate.has_water {
            let mut pressures = rows.at_sites(&self.increment);
            for (pressure, coupling) in pressures.iter_mut().zip(&rows.coupling) {
                *pressure *= -coupling;
            }
            let changes = rows.at_points(&pressures);
            for (point, change) in changes.into_iter().enumerate() {
                body.points.pressure[point] = self.anchor.pressure[point] + change;
            }
        }
        body.map_forces();
        let (forces, mixture) = (&mut self.forces, &body.nodes.mixture_force);
        self.unknowns.visit_numbers(|node, d, number| forces[number] = mixture[node][d]);
        // NaN is more than any tolerance.
        forces.iter().fold(0.0, |most: f64, force| if most > force.abs() { most } else { force.abs() })
    }

    /// Assembles and factors the stiffness at the present strains.
    fn factor_tangent(&mut self) -> Result<(), StepFailure> {
        if self.time_limit.is_over() {
            return Err(StepFailure::out_of_time());
        }
        for (row, constant) in self.stiffness.rows.iter_mut().zip(&self.pressure_stiffness.rows) {
            let mut constant = constant.iter().peekable();
            for (column, block) in row {
                let next = constant.next_if(|(other, _)| other == column);
                *block = next.map_or([[0.0; D]; D], |(_, block)| *block);
            }
        }
        add_tangents(&mut self.stiffness, &self.body, &self.strains, &self.tangents);
        self.matrix.clear();
        let matrix = &mut self.matrix;
        self.unknowns.visit_blocks(&self.stiffness, |row, column, value| matrix.add(row, column, value));
        self.work.factorisations += 1;
        let factored = self.factors.factor(&self.matrix);
        factored.map_err(|singular| no_pivot("the tangent", singular, self.time_limit))
    }

    /// Makes the present state the accepted one.
    fn accept(&mut self, dt: f64) {
        let body = &mut self.body;
        let stride = *body.grid.node_stride();
        for point in 0..body.points.len() {
            let of_basis = body.operators.basis.value(&stride, point, &self.increment);
            let moved = body.carrying(point, &self.increment, of_basis);
            for d in 0..D {
                body.points.displacement[point][d] += moved[d];
            }
        }
        let rate = self.rate.get_or_insert_with(Vec::new);
        rate.clear();
        for (total, increment) in body.nodes.displacement.iter_mut().zip(&self.increment) {
            rate.push(increment.map(|component| component / dt));
            for d in 0..D {
                total[d] += increment[d];
            }
        }
        self.anchor.clone_from(&body.points);
        self.settlement += dt * self.plate.velocity;
        self.plate_force = self.under_plate.iter().map(|node| body.nodes.mixture_force[*node][D - 1]).sum();
    }
}

/// Adds the stiffness of points with tangents of their own.
fn add_tangents<const D: usize>(
    stiffness: &mut NodeBlocks<D>,
    body: &Body<D>,
    strains: &[Vec<StrainEntry<D>>],
    tangents: &[Tangent],
) {
    let stress = |point: usize, gradient: &Tensor<D>, dilation: f64| {
        let strain = StrainIncrement { gradient: *gradient, dilation, volume_ratio: [1.0; 2] }.components();
        let component = |i: usize| (0..4).map(|j| tangents[point][i][j] * strain[j]).sum::<f64>();
        let place = |d: usize, e: usize| if d == e { usize::from(d == D - 1) } else { 3 };
        std::array::from_fn(|d| std::array::from_fn(|e| component(place(d, e))))
    };
    body.add_stiffness(stiffness, |point| &strains[point][..], stress);
}

impl<const D: usize> Stepper for DrivenStepper<D> {
    fn advance(&mut self, steps: &EqualSteps, _: f64) -> Result<f64, StepFailure> {
        (0..steps.count).try_for_each(|_| self.step_within(steps.dt, MOST_HALVINGS))?;
        Ok(0.0)
    }

    fn settlement(&self) -> f64 {
        self.settlement
    }

    fn settlement_rate(&self) -> Option<f64> {
        Some(self.plate.velocity)
    }

    fn plate_force(&self) -> Option<f64> {
        Some(self.plate_force)
    }

    fn snapshot(&self, time: f64) -> Snapshot {
        let mut body = self.body.clone();
        if !self.plate.has_water {
            // Of one phase the mean stress is the pressure.
            for point in 0..body.points.len() {
                let stress = &mut body.points.effective_stress[point];
                let in_plane = stress[0][0] + stress[D - 1][D - 1];
                let pressure = -(in_plane + body.points.history[point].lateral_stress) / 3.0;
                body.points.pressure[point] = pressure;
                for d in 0..D {
                    stress[d][d] += pressure;
                }
            }
        }
        Snapshot { plate_force: Some(self.plate_force), ..body.snapshot(time, self.settlement, &self.start) }
    }

    fn work(&self) -> Work {
        self.work
    }
}

#[cfg(test)]
mod tests;
