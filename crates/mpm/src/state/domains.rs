//! Domains of points that turn and shear with the material: parallelograms, each spanned by two vectors from its
//! point (CPDI, Sadeghirad, Brannon & Burghardt 2011; for skeleton and water Zheng, Gao, Zhang & Wang 2013).

use crate::method::{Basis, Configuration, Method};
use crate::state::points::Points;
use oedometer_soil::tensor::{Tensor, Vector, inverse};

/// Half-edges of the points' domains.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Domains<const D: usize> {
    /// Half-lengths at the start of the run along the axes, m, `[point][direction]`.
    initial: Vec<Vector<D>>,
    /// Vectors from each point to the middles of its domain's edges, m, `[point][edge][component]`.
    pub half_edges: Vec<Tensor<D>>,
}

impl<const D: usize> Domains<D> {
    /// Those of points, where a method has domains that turn: in the plane, where points move. Elsewhere domains keep
    /// their axes, and a parallelogram is the product of its sides.
    pub fn of(method: Method, configuration: Configuration, points: &Points<D>) -> Option<Self> {
        let turns = method.basis == Basis::Cpdi && D == 2 && configuration.moves_points();
        turns.then(|| {
            let mut domains = Self { initial: points.half_length.clone(), half_edges: Vec::new() };
            domains.half_edges.resize(points.len(), [[0.0; D]; D]);
            domains.follow(&points.inverse_deformation);
            domains
        })
    }

    /// Takes the edges of the deformation since the start of the run, by its inverses: `r_i = F r_i0`.
    pub fn follow(&mut self, inverse_deformation: &[Tensor<D>]) {
        let lengths = self.initial.iter().zip(inverse_deformation);
        for (edges, (lengths, back)) in self.half_edges.iter_mut().zip(lengths) {
            let deformation = inverse(back).0;
            for edge in 0..D {
                for component in 0..D {
                    edges[edge][component] = deformation[component][edge] * lengths[edge];
                }
            }
        }
    }

    /// Takes a point's edges with the deformation of a step.
    pub fn carry(&mut self, point: usize, deformation: &Tensor<D>) {
        for edge in &mut self.half_edges[point] {
            let before = *edge;
            *edge = std::array::from_fn(|i| (0..D).map(|j| deformation[i][j] * before[j]).sum());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use oedometer_soil::tensor::product;

    #[test]
    fn edges_follow_the_deformation_at_once_and_step_by_step_and_their_area_the_volume() {
        let mut points = Points::<2>::lattice(0.5, [2, 1], 2);
        let method = Method::named("CPDI-SRI-patch").expect("a method");
        let mut stepwise = Domains::of(method, Configuration::Updated, &points).expect("domains that turn");
        assert_eq!(stepwise.half_edges[3], [[0.125, 0.0], [0.0, 0.125]]);
        let mut whole = stepwise.clone();
        // Sheared by a half, and turned by a right angle.
        let [shear, turn] = [[[1.0, 0.5], [0.0, 0.8]], [[0.0, -1.0], [1.0, 0.0]]];
        for step in [shear, turn] {
            (0..points.len()).for_each(|point| stepwise.carry(point, &step));
        }
        points.inverse_deformation.fill(inverse(&product(&turn, &shear)).0);
        whole.follow(&points.inverse_deformation);
        for domains in [stepwise, whole] {
            let [[ax, ay], [bx, by]] = domains.half_edges[3];
            for (got, exact) in [(ax, 0.0), (ay, 0.125), (bx, -0.1), (by, 0.0625)] {
                assert!((got - exact).abs() < 1e-16, "{got} for {exact}");
            }
            // 4 |r_1 × r_2| = J V_0
            assert!((4.0 * (ax * by - ay * bx) - 0.8 * points.initial_volume[3]).abs() < 1e-16);
        }
    }

    #[test]
    fn only_cpdi_on_moving_points_in_the_plane_turns_its_domains() {
        let named = |name| Method::named(name).expect("a method");
        let (plane, column) = (Points::<2>::lattice(1.0, [1, 1], 1), Points::<1>::lattice(1.0, [1], 1));
        assert!(Domains::of(named("CE-SRI-patch"), Configuration::Updated, &plane).is_some());
        assert!(Domains::of(named("GIMP-SRI-patch"), Configuration::Updated, &plane).is_none());
        assert!(Domains::of(named("CPDI-SRI-patch"), Configuration::Total, &plane).is_none());
        assert!(Domains::of(named("CPDI-SRI-patch"), Configuration::Updated, &column).is_none());
    }
}
