//! The points of the water in double-point MPM: they carry its mass and its pressure, and move with it. Their porosity is
//! that of the soil where they are, and their domains are as large as the pores that their mass fills.
//!
//! ```text
//! n_w = Σ_i N_iw n_i / Σ_i N_iw       V_w = m_w/(ρ_w(p) n_w),   ρ_w = ρ_w0 exp(p/K_w)
//! ```
//!
//! over the nodes with soil. Water stands still above the soil while the soil sinks under it: only the share of a
//! domain that lies below the surface of the soil counts, and a point without one is out.

use crate::state::points::Points;
use oedometer_soil::material::Material;
use oedometer_soil::tensor::{Tensor, Vector};

/// State of the water points, structure of arrays; index = point. A point that has left the soil is removed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WaterPoints<const D: usize> {
    /// Mass of the water, for ever, kg.
    pub mass: Vec<f64>,
    /// Middle of the whole domain, m.
    pub position: Vec<Vector<D>>,
    /// Half-lengths of the whole domain, m.
    pub half_length: Vec<Vector<D>>,
    /// Velocity of the water, m/s.
    pub velocity: Vec<Vector<D>>,
    /// Excess pore pressure, Pa, compression positive.
    pub pressure: Vec<f64>,
    /// Slope of the pressure over the domain, Pa/m; zero where points know no more than their cell's pressure.
    pub slope: Vec<Vector<D>>,
    /// Porosity of the soil there.
    pub porosity: Vec<f64>,
    /// Volume of soil whose pores the water fills, of the whole domain, m^D.
    pub volume: Vec<f64>,
    /// Share of the domain that lies below the surface of the soil: only that counts.
    pub share: Vec<f64>,
    /// Middle of that share, m.
    pub place: Vec<Vector<D>>,
    /// Its half-lengths, m.
    pub reach: Vec<Vector<D>>,
    /// Mass of the points that have left, kg.
    pub left_mass: f64,
}

impl<const D: usize> WaterPoints<D> {
    /// The water in the pores of a lattice: its pressures and velocities, and where points move, displaced by a
    /// uniform gradient with the soil.
    pub fn new(lattice: &Points<D>, soil: &Material, gradient: Option<&Tensor<D>>) -> Self {
        let (mut position, mut half_length) = (lattice.position.clone(), lattice.half_length.clone());
        let mut stretch = 1.0;
        if let Some(gradient) = gradient {
            for (place, half) in position.iter_mut().zip(&mut half_length) {
                let before = *place;
                for d in 0..D {
                    place[d] += (0..D).map(|e| gradient[d][e] * before[e]).sum::<f64>();
                    half[d] *= 1.0 + gradient[d][d];
                }
            }
            stretch = (0..D).map(|d| 1.0 + gradient[d][d]).product();
        }
        let initial = &lattice.initial_volume;
        Self {
            mass: initial.iter().map(|volume| soil.porosity * soil.water_density * volume).collect(),
            velocity: lattice.water_velocity.clone(),
            pressure: lattice.pressure.clone(),
            slope: vec![[0.0; D]; lattice.len()],
            porosity: vec![soil.porosity_at(stretch); lattice.len()],
            volume: initial.iter().map(|volume| stretch * volume).collect(),
            share: vec![1.0; lattice.len()],
            place: position.clone(),
            reach: half_length.clone(),
            position,
            half_length,
            left_mass: 0.0,
        }
    }

    /// Number of points in the soil.
    #[inline]
    pub fn len(&self) -> usize {
        self.mass.len()
    }

    /// Removes a point that has left the soil; the order of the others stays.
    pub fn remove(&mut self, point: usize) {
        self.left_mass += self.mass.remove(point);
        for field in [&mut self.position, &mut self.half_length, &mut self.velocity] {
            field.remove(point);
        }
        for field in [&mut self.place, &mut self.reach, &mut self.slope] {
            field.remove(point);
        }
        for field in [&mut self.pressure, &mut self.porosity, &mut self.volume, &mut self.share] {
            field.remove(point);
        }
    }

    /// Volume of soil below the surface that a point's water fills, m^D.
    #[inline]
    pub fn volume_inside(&self, point: usize) -> f64 {
        self.volume[point] * self.share[point]
    }

    /// Mass of its water there, kg.
    #[inline]
    pub fn mass_inside(&self, point: usize) -> f64 {
        self.mass[point] * self.share[point]
    }

    /// Volume of the water below the surface, m^D, and pressure, Pa, of every point.
    pub fn volumes_and_pressures(&self) -> impl Iterator<Item = (f64, f64)> {
        (0..self.len()).map(|point| (self.porosity[point] * self.volume_inside(point), self.pressure[point]))
    }
}
