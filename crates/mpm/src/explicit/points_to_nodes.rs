//! From points to nodes: masses, velocities and forces, each one pass over the points.

#![expect(clippy::inline_always, reason = "the innermost loops of the step")]

use crate::body::Body;
use crate::drag::drag_of_point;
use crate::state::points::Points;
use oedometer_soil::conductivity::ConductivityMean;
use oedometer_soil::material::Material;
use oedometer_soil::tensor::{Vector, product_with_transpose};

impl<const D: usize> Body<D> {
    /// Sums masses, volumes and drag of the points to the nodes.
    pub fn map_masses(&mut self) {
        let (soils, points) = (&self.soils[..], &self.points);
        let is_layered = self.is_layered();
        self.basis.sum_values(
            self.grid.node_stride(),
            #[inline(always)]
            |point| masses_of(points.soil_among(soils, point), points, point, is_layered),
            &mut self.nodes.sums.masses,
        );
        self.take_masses();
    }

    /// Maps the velocities of both phases from the points to the nodes, weighted with mass.
    pub fn map_velocities(&mut self) {
        let points = &self.points;
        self.basis.sum_values(
            self.grid.node_stride(),
            #[inline(always)]
            |point| momenta_of(points, point, points.volumes_of_phases(point)),
            &mut self.nodes.sums.phases,
        );
        self.take_velocities();
    }

    /// Maps masses and velocities in one pass.
    pub fn map_masses_and_velocities(&mut self) {
        let (soils, points) = (&self.soils[..], &self.points);
        let is_layered = self.is_layered();
        self.basis.sum_both(
            self.grid.node_stride(),
            #[inline(always)]
            |point| {
                let masses = masses_of(points.soil_among(soils, point), points, point, is_layered);
                (masses, momenta_of(points, point, [masses[0][0], masses[0][1]]))
            },
            &mut self.nodes.sums.masses,
            &mut self.nodes.sums.phases,
        );
        self.take_masses();
        self.take_velocities();
    }

    fn take_masses(&mut self) {
        self.nodes.take_masses(&self.material, self.is_layered());
        if self.material.conductivity_mean == ConductivityMean::Chord {
            self.take_chord_drag();
        }
    }

    fn take_velocities(&mut self) {
        self.add_velocity_gradients();
        self.nodes.take_velocities(&self.material);
        if let Some(plate) = &self.plate {
            plate.tie_velocities(&mut self.nodes);
        }
    }

    /// Forces on the mixture and on the water from the points' stresses (weak form, drained
    /// surface natural), and from what acts from outside.
    pub fn map_forces(&mut self) {
        let (points, is_pushed_forward) = (&self.points, self.is_pushed_forward);
        self.basis.sum_gradients(
            self.grid.node_stride(),
            #[inline(always)]
            |point| stresses_of(points, point, is_pushed_forward),
            &mut self.nodes.sums.phases,
        );
        self.add_stress_slopes();
        self.nodes.take_forces();
        if self.weight.is_some() {
            self.add_weight();
        }
        if self.forcing.is_some() {
            self.add_body_forces();
        }
    }
}

/// Volumes of grains and pores of a point, m^D, and its drag, N s/m; in layers that over its porosity, which the node's
/// replaces (docs/theory.md, Eq. 44).
#[inline(always)]
fn masses_of<const D: usize>(
    soil: &Material,
    points: &Points<D>,
    point: usize,
    is_layered: bool,
) -> [[f64; 4]; 1] {
    let [grains, pores] = points.volumes_of_phases(point);
    let resisting = if is_layered { grains + pores } else { pores };
    [[grains, pores, drag_of_point(soil, resisting, points.volume_ratio[point]), 0.0]]
}

/// Volume times velocity of both phases of a point.
#[inline(always)]
fn momenta_of<const D: usize>(points: &Points<D>, point: usize, volumes: [f64; 2]) -> [Vector<D>; 2] {
    // None where the water has points of its own.
    let water = points.water_velocity.get(point).unwrap_or(&[0.0; D]);
    let mut momenta = [points.solid_velocity[point], *water];
    for phase in 0..2 {
        for d in 0..D {
            momenta[phase][d] *= volumes[phase];
        }
    }
    momenta
}

/// What each unit of gradient gives to the mixture, `(p I − σ') V`, and to the water, `p V I`,
/// `[direction][phase][component]`.
#[inline(always)]
fn stresses_of<const D: usize>(
    points: &Points<D>,
    point: usize,
    is_pushed_forward: bool,
) -> [[Vector<D>; 2]; D] {
    let volume = points.volume(point) * points.stressed_share[point];
    let pressure = volume * points.pressure[point];
    let (mut mixture, mut water) = (points.effective_stress[point], [[0.0; D]; D]);
    for stress in mixture.as_flattened_mut() {
        *stress *= -volume;
    }
    for d in 0..D {
        mixture[d][d] += pressure;
        water[d][d] = pressure;
    }
    if is_pushed_forward {
        // Gradients on the initial configuration meet `σ F⁻ᵀ`.
        let inverse = &points.inverse_deformation[point];
        (mixture, water) =
            (product_with_transpose(&mixture, inverse), product_with_transpose(&water, inverse));
    }
    let mut given = [[[0.0; D]; 2]; D];
    for e in 0..D {
        for d in 0..D {
            given[e][0][d] = mixture[d][e];
            given[e][1][d] = water[d][e];
        }
    }
    given
}
