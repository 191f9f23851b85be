//! The material points: they carry skeleton and water and move with the skeleton.

use oedometer_soil::law::History;
use oedometer_soil::material::Material;
use oedometer_soil::tensor::{Tensor, Vector, identity};

/// State of the material points, structure of arrays; index = point.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Points<const D: usize> {
    /// Initial place, m.
    pub initial_position: Vec<Vector<D>>,
    /// Current place, m.
    pub position: Vec<Vector<D>>,
    /// Displacement of the skeleton, m.
    pub displacement: Vec<Vector<D>>,
    /// Half-lengths of the point's domain, m.
    pub half_length: Vec<Vector<D>>,
    /// Volume in the initial state, m^D.
    pub initial_volume: Vec<f64>,
    /// Volume of the grains `(1 − n_0) V_0`, m^D, which no deformation changes; of points that a body has
    /// [taken](Self::take_soils).
    pub grain_volume: Vec<f64>,
    /// Volume ratio `J`.
    pub volume_ratio: Vec<f64>,
    /// Volume that a point's stress fills over `J V_0`: what its domain has kept where the cells
    /// remember `J`, one elsewhere.
    pub stressed_share: Vec<f64>,
    /// Inverse `F⁻¹` of the deformation gradient, where weights stay on the initial configuration.
    pub inverse_deformation: Vec<Tensor<D>>,
    /// Velocity of the skeleton, m/s.
    pub solid_velocity: Vec<Vector<D>>,
    /// Velocity of the pore water, m/s; none where the water has points of its own.
    pub water_velocity: Vec<Vector<D>>,
    /// Effective Cauchy stress, Pa, tension positive.
    pub effective_stress: Vec<Tensor<D>>,
    /// Excess pore pressure, Pa, compression positive.
    pub pressure: Vec<f64>,
    /// Number of the point's soil among those of its body.
    pub soil: Vec<u8>,
    /// History variables of the points; empty in bodies whose laws have no history.
    pub history: Vec<History>,
}

impl<const D: usize> Points<D> {
    /// A block of `cells` square cells of edge `cell_size` (m) with its corner at the origin,
    /// `per_cell` equally spaced points per cell and direction, at rest and without stress.
    pub fn lattice(cell_size: f64, cells: [usize; D], per_cell: usize) -> Self {
        let along = cells.map(|count| count * per_cell);
        let count: usize = along.iter().product();
        let spacing = cell_size / per_cell as f64;
        let initial_position: Vec<Vector<D>> = (0..count)
            .map(|point| {
                let mut rest = point;
                std::array::from_fn(|direction| {
                    let index = rest % along[direction];
                    rest /= along[direction];
                    (index as f64 + 0.5) * spacing
                })
            })
            .collect();
        Self {
            position: initial_position.clone(),
            initial_position,
            displacement: vec![[0.0; D]; count],
            half_length: vec![[0.5 * spacing; D]; count],
            initial_volume: vec![(0..D).map(|_| spacing).product(); count],
            grain_volume: vec![0.0; count],
            volume_ratio: vec![1.0; count],
            stressed_share: vec![1.0; count],
            inverse_deformation: vec![identity(); count],
            solid_velocity: vec![[0.0; D]; count],
            water_velocity: vec![[0.0; D]; count],
            effective_stress: vec![[[0.0; D]; D]; count],
            pressure: vec![0.0; count],
            soil: vec![0; count],
            history: Vec::new(),
        }
    }

    /// Number of points.
    #[inline]
    pub fn len(&self) -> usize {
        self.pressure.len()
    }

    /// Whether the set is empty.
    pub fn is_empty(&self) -> bool {
        self.pressure.is_empty()
    }

    /// The points of a list of indices, in its order.
    #[must_use]
    pub fn select(&self, keep: &[usize]) -> Self {
        fn pick<T: Copy>(field: &[T], keep: &[usize]) -> Vec<T> {
            keep.iter().map(|point| field[*point]).collect()
        }
        Self {
            initial_position: pick(&self.initial_position, keep),
            position: pick(&self.position, keep),
            displacement: pick(&self.displacement, keep),
            half_length: pick(&self.half_length, keep),
            initial_volume: pick(&self.initial_volume, keep),
            grain_volume: pick(&self.grain_volume, keep),
            volume_ratio: pick(&self.volume_ratio, keep),
            stressed_share: pick(&self.stressed_share, keep),
            inverse_deformation: pick(&self.inverse_deformation, keep),
            solid_velocity: pick(&self.solid_velocity, keep),
            water_velocity: pick(&self.water_velocity, keep),
            effective_stress: pick(&self.effective_stress, keep),
            pressure: pick(&self.pressure, keep),
            soil: pick(&self.soil, keep),
            history: if self.history.is_empty() { Vec::new() } else { pick(&self.history, keep) },
        }
    }

    /// The soil of a point among those of its body.
    #[inline]
    pub fn soil_among<'a>(&self, soils: &'a [Material], point: usize) -> &'a Material {
        &soils[usize::from(self.soil[point])]
    }

    /// Takes the volumes of the grains from the soils of the points.
    pub fn take_soils(&mut self, soils: &[Material]) {
        let initial = self.initial_volume.iter().zip(&self.soil);
        let grains = initial.map(|(volume, soil)| volume * (1.0 - soils[usize::from(*soil)].porosity));
        self.grain_volume = grains.collect();
    }

    /// Whether the points began as a lattice that fills its cells: of one size, a whole number of domains from their edges.
    pub fn began_as_full_lattice(&self) -> bool {
        let on_lattice = |point: usize| {
            let half_length = &self.half_length[point];
            let domains = self.initial_position[point]
                .iter()
                .zip(half_length)
                .map(|(place, half)| 0.5 * (place / half - 1.0));
            *half_length == self.half_length[0]
                && domains.into_iter().all(|count| (count - count.round()).abs() < 1e-6)
        };
        (0..self.len()).all(on_lattice)
    }

    /// Volumes of the grains and of the pores of a point, m^D: grains fill `(1 − n) V = (1 − n_0) V_0`, water `n V`.
    #[inline]
    pub fn volumes_of_phases(&self, point: usize) -> [f64; 2] {
        let grains = self.grain_volume[point];
        [grains, self.volume(point) - grains]
    }

    /// Current volume of a point, m^D.
    #[inline]
    pub fn volume(&self, point: usize) -> f64 {
        self.initial_volume[point] * self.volume_ratio[point]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lattice_fills_its_block() {
        let points = Points::<2>::lattice(0.5, [2, 3], 2);
        assert_eq!(points.len(), 24);
        assert!((points.initial_volume.iter().sum::<f64>() - 1.5).abs() < 1e-15);
        assert_eq!(points.initial_position[0], [0.125, 0.125]);
        assert_eq!(points.initial_position[23], [0.875, 1.375]);
        assert!(points.began_as_full_lattice());
        let mut moved = points.clone();
        moved.initial_position[7][1] += 0.1;
        let mut halved = points;
        halved.half_length[23][1] *= 0.5;
        halved.initial_position[23][1] = 1.3125;
        assert!(![moved, halved].iter().any(Points::began_as_full_lattice));
    }
}
