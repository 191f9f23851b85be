//! The load on the body's moving surface.

use crate::operators::basis::Shapes;
use crate::state::grid::Grid;
use crate::state::nodes::{Nodes, Support};
use crate::state::points::Points;
use oedometer_problem::method::Basis;
use oedometer_soil::elementary;
use oedometer_soil::tensor::Vector;

/// Variation of a load along the surface.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum LoadShape {
    /// A uniform load.
    #[default]
    Uniform,
    /// `cos(πx/L)` of the initial place `x` along the first direction.
    Cosine {
        /// Half a wave's length `L`, m.
        length: f64,
    },
}

impl LoadShape {
    /// The shape at an initial distance along the surface, m.
    #[inline]
    fn at(self, distance: f64) -> f64 {
        match self {
            Self::Uniform => 1.0,
            Self::Cosine { length } => elementary::cos(std::f64::consts::PI * distance / length),
        }
    }
}

/// A pressure on the upper outline of the material.
///
/// The load acts at the outer edge of the outermost points' domains and is spread with the weights of the
/// basis there. A load left on a node errs once the top cell empties; spread over the top point, it costs
/// percents of settlement.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadedSurface<const D: usize> {
    /// Load `q`, Pa, compression positive, carried by the total stress.
    pub load: f64,
    /// Places where the load acts.
    spots: Vec<Spot>,
    /// Sum of the squares of the spots' shapes.
    squares: f64,
    /// Basis whose weights spread the load.
    basis: Basis,
    /// Held faces, beyond which no node carries any of it.
    support: Support<D>,
    /// Whether the edge follows the volume of the points because their domains do not.
    stretches: bool,
}

/// One of the places where the load acts: a Gauss point of the outer edge of a topmost point's
/// domain, so that the nodal forces of a load that varies are those of its integral with the hats.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Spot {
    /// The point.
    point: usize,
    /// Place along the edge, from −1 to 1.
    along: f64,
    /// Load over that of the surface.
    shape: f64,
}

/// Gauss points of an edge: exact for the hats times a line.
const EDGE_SPOTS: [f64; 2] = [-0.577_350_269_189_625_8, 0.577_350_269_189_625_8];

impl<const D: usize> LoadedSurface<D> {
    /// The surface of a lattice: the highest points of the initial configuration.
    pub fn new(points: &Points<D>, load: f64) -> Self {
        let height = |point: usize| points.initial_position[point][D - 1];
        let highest = (0..points.len()).map(height).fold(f64::NEG_INFINITY, f64::max);
        let tolerance = 1e-9 * highest.abs();
        let top_points = (0..points.len()).filter(|point| height(*point) > highest - tolerance);
        // A column's edge is a point.
        let places = if D == 1 { &[0.0][..] } else { &EDGE_SPOTS };
        let spots: Vec<Spot> = top_points
            .flat_map(|point| places.iter().map(move |along| Spot { point, along: *along, shape: 1.0 }))
            .collect();
        Self {
            load,
            squares: spots.len() as f64,
            spots,
            basis: Basis::Hat,
            support: Support::free(),
            stretches: false,
        }
    }

    /// The surface under a load that varies along it.
    #[must_use]
    pub fn shaped(mut self, shape: LoadShape, points: &Points<D>) -> Self {
        for spot in &mut self.spots {
            let reach = spot.along * points.half_length[spot.point][0];
            spot.shape = shape.at(points.initial_position[spot.point][0] + reach);
        }
        self.squares = self.spots.iter().map(|spot| spot.shape * spot.shape).sum();
        self
    }

    /// The surface of points whose domains keep their length: the material's edge still follows.
    #[must_use]
    pub fn stretching(self, stretches: bool) -> Self {
        Self { stretches, ..self }
    }

    /// Place of a spot on the upper edge of its point's share of the material.
    #[inline]
    fn place(&self, points: &Points<D>, spot: &Spot) -> Vector<D> {
        let point = spot.point;
        let mut place = points.position[point];
        if D > 1 {
            place[0] += spot.along * points.half_length[point][0];
        }
        // An oedometer strains vertically only: its stretch is the volume ratio.
        let stretch = if self.stretches { points.volume_ratio[point] } else { 1.0 };
        place[D - 1] += stretch * points.half_length[point][D - 1];
        place
    }

    /// The surface of a body with a basis: its load is spread with the weights of that basis, and
    /// with hats where domains smear them.
    #[must_use]
    pub fn spread_by(self, basis: Basis, support: Support<D>) -> Self {
        Self { basis, support, ..self }
    }

    /// Visits the nodes that carry each spot of the surface, with their weights.
    #[inline]
    fn visit(&self, grid: &Grid<D>, points: &Points<D>, mut visitor: impl FnMut(&Spot, usize, f64)) {
        for spot in &self.spots {
            let mut place = grid.held_in_cells(&self.place(points, spot));
            if self.basis == Basis::Hat {
                // The edge may lie in the cell above that of its point, whose upper node hats give no mass and no force:
                // a share of the load put there would be lost.
                let cell = grid.cell_of(&points.position[spot.point])[D - 1];
                place[D - 1] = place[D - 1].min((cell + 1) as f64);
            }
            self.basis.visit_surface(grid, &self.support, &place, |node, weight| visitor(spot, node, weight));
        }
    }

    /// Ends splines at the surface where the points have carried it, and returns the faces with that end.
    ///
    /// A spline whose support the surface has all but left keeps its share of the load and loses the
    /// points that would carry it: their pores close. It then follows the line of those inside (extended
    /// B-splines, Höllig, Reif & Wipper 2001; for material points Yamaguchi, Moriguchi & Terada 2021).
    pub fn end_splines(&mut self, grid: &Grid<D>, points: &Points<D>) -> Support<D> {
        let height = |spot| grid.held_in_cells(&self.place(points, spot))[D - 1];
        let highest = self.spots.iter().map(height).fold(0.0, f64::max);
        self.support.outermost = self.basis.outermost_node(highest);
        self.support
    }

    /// Height of the surface now, m, as much of it as has the load's shape: the mean over the
    /// width under a uniform load.
    pub fn height(&self, points: &Points<D>) -> f64 {
        let sum: f64 = self.spots.iter().map(|spot| spot.shape * self.place(points, spot)[D - 1]).sum();
        sum / self.squares
    }

    /// Work, J, of the present load along a settlement, m, as it is measured by [`height`](Self::height).
    pub fn work(&self, points: &Points<D>, settlement: f64) -> f64 {
        let share = if D == 1 { 1.0 } else { 1.0 / EDGE_SPOTS.len() as f64 };
        let width = |spot: &Spot| spot.shape * spot.shape * width_of(points, spot.point);
        self.load * settlement * share * self.spots.iter().map(width).sum::<f64>()
    }

    /// Height of the lowest place of the surface now, m.
    pub fn lowest(&self, points: &Points<D>) -> f64 {
        let height = |spot| self.place(points, spot)[D - 1];
        self.spots.iter().map(height).fold(f64::INFINITY, f64::min)
    }

    /// Height of the surface over a place now, m: that of its nearest topmost point.
    pub fn height_over(&self, points: &Points<D>, place: &Vector<D>) -> f64 {
        let distance = |spot: &Spot| {
            let along = &points.position[spot.point][..D - 1];
            along.iter().zip(place).map(|(there, here)| (there - here) * (there - here)).sum::<f64>()
        };
        let nearest = self.spots.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
        nearest.map_or(f64::INFINITY, |spot| self.place(points, spot)[D - 1])
    }

    /// Adds the load to the external force of the mixture at the nodes.
    pub fn apply(&self, grid: &Grid<D>, points: &Points<D>, nodes: &mut Nodes<D>) {
        nodes.external_force.fill([0.0; D]);
        let share = if D == 1 { 1.0 } else { 1.0 / EDGE_SPOTS.len() as f64 };
        self.visit(grid, points, |spot, node, weight| {
            let width = width_of(points, spot.point);
            nodes.external_force[node][D - 1] += weight * (-self.load * spot.shape * share * width);
        });
    }

    /// Presses on the surface with a pressure, Pa, on mixture and pore water alike: free water above it.
    pub fn press(&self, pressure: f64, grid: &Grid<D>, points: &Points<D>, nodes: &mut Nodes<D>) {
        let share = if D == 1 { 1.0 } else { 1.0 / EDGE_SPOTS.len() as f64 };
        self.visit(grid, points, |spot, node, weight| {
            let force = weight * pressure * share * width_of(points, spot.point);
            nodes.mixture_force[node][D - 1] -= force;
            nodes.water_force[node][D - 1] -= force;
        });
    }

    /// Nodes that span the surface, with the weights of [`amplitude_of`](Self::amplitude_of).
    pub fn weights(&self, grid: &Grid<D>, points: &Points<D>) -> Vec<(usize, f64)> {
        self.shares(grid, points, |spot| spot.shape / self.squares)
    }

    /// Nodes that span the surface, with the weights of [`mean_of`](Self::mean_of).
    pub fn mean_weights(&self, grid: &Grid<D>, points: &Points<D>) -> Vec<(usize, f64)> {
        self.shares(grid, points, |_| 1.0 / self.spots.len() as f64)
    }

    fn shares(&self, grid: &Grid<D>, points: &Points<D>, share: impl Fn(&Spot) -> f64) -> Vec<(usize, f64)> {
        let mut weights = Vec::new();
        self.visit(grid, points, |spot, node, weight| weights.push((node, share(spot) * weight)));
        weights
    }

    /// Vertical component of a nodal vector field on the surface, as much of it as has the load's
    /// shape: the mean under a uniform load, the amplitude of the cosine under a cosine.
    pub fn amplitude_of(&self, grid: &Grid<D>, points: &Points<D>, field: &[Vector<D>]) -> f64 {
        let mut sum = 0.0;
        self.visit(grid, points, |spot, node, weight| sum += spot.shape * weight * field[node][D - 1]);
        sum / self.squares
    }

    /// Mean over the surface of a nodal vector field's vertical component.
    pub fn mean_of(&self, grid: &Grid<D>, points: &Points<D>, field: &[Vector<D>]) -> f64 {
        let mut sum = 0.0;
        self.visit(grid, points, |_, node, weight| sum += weight * field[node][D - 1]);
        sum / self.spots.len() as f64
    }
}

/// Width of a point's domain, m; one in one dimension.
#[inline]
fn width_of<const D: usize>(points: &Points<D>, point: usize) -> f64 {
    points.half_length[point][..D - 1].iter().map(|half| 2.0 * half).product()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nodal_forces_sum_to_the_load_and_act_at_the_surface() {
        let grid = Grid::new(0.1, [12]);
        let mut points = Points::lattice(0.1, [10], 2);
        let surface = LoadedSurface::new(&points, 5.0);
        let mut nodes = Nodes::new(&grid, &Support::oedometer(), 1.0);
        surface.apply(&grid, &points, &mut nodes);
        let top = grid.flat_node(&[12]);
        assert!(
            (nodes.external_force[top][0] + 5.0).abs() < 1e-9,
            "all on the node that lies in the surface"
        );
        // The surface sinks by a quarter of a cell: the node below takes a quarter.
        for place in &mut points.position {
            place[0] -= 0.025;
        }
        surface.apply(&grid, &points, &mut nodes);
        assert!((nodes.external_force[top][0] + 3.75).abs() < 1e-9);
        assert!((nodes.external_force[top - 1][0] + 1.25).abs() < 1e-9);
        assert!((surface.height(&points) - 0.975).abs() < 1e-12);
    }

    #[test]
    fn hats_carry_the_load_of_shifted_points_on_nodes_with_mass() {
        let grid = Grid::new(0.1, [12]);
        let mut points = Points::lattice(0.1, [10], 1);
        for place in &mut points.position {
            place[0] += 0.048;
        }
        let forces = |basis| {
            let mut nodes = Nodes::new(&grid, &Support::oedometer(), 1.0);
            let surface = LoadedSurface::new(&points, 5.0).spread_by(basis, Support::oedometer());
            surface.apply(&grid, &points, &mut nodes);
            [12, 13].map(|node| nodes.external_force[grid.flat_node(&[node])][0])
        };
        assert_eq!(forces(Basis::Hat), [-5.0, 0.0]);
        // Domains reach into the cell above, and the load acts at their edge.
        let [top, above] = forces(Basis::Cpgimp);
        assert!((top + 2.6).abs() < 1e-9 && (above + 2.4).abs() < 1e-9, "{top} {above}");
    }

    #[test]
    fn a_cosine_load_has_no_resultant_and_the_given_amplitude() {
        let grid = Grid::new(0.25, [4, 5]);
        let points = Points::<2>::lattice(0.25, [4, 4], 2);
        let surface = LoadedSurface::new(&points, 3.0).shaped(LoadShape::Cosine { length: 1.0 }, &points);
        let mut nodes = Nodes::new(&grid, &Support::oedometer(), 1.0);
        surface.apply(&grid, &points, &mut nodes);
        let force = |node: usize| nodes.external_force[node][1];
        let total: f64 = (0..nodes.len()).map(force).sum();
        assert!(total.abs() < 1e-12);
        // ∫ q cos(πx) · cos(πx) dx = q/2, up to the hats' interpolation of the second cosine.
        let moment: f64 = (0..nodes.len())
            .map(|node| force(node) * (std::f64::consts::PI * grid.node_position(node)[0]).cos())
            .sum();
        assert!((moment / 1.5 + 1.0).abs() < 0.06, "{moment}");
        let field: Vec<Vector<2>> = (0..nodes.len())
            .map(|node| [0.0, 7.0 * (std::f64::consts::PI * grid.node_position(node)[0]).cos() + 2.0])
            .collect();
        assert!((surface.amplitude_of(&grid, &points, &field) / 7.0 - 1.0).abs() < 0.06);
        assert!((surface.mean_of(&grid, &points, &field) - 2.0).abs() < 1e-12);
    }

    #[test]
    fn a_plane_surface_carries_load_times_width() {
        let grid = Grid::new(0.5, [2, 3]);
        let points = Points::<2>::lattice(0.5, [2, 2], 2);
        let surface = LoadedSurface::new(&points, 3.0);
        let mut nodes = Nodes::new(&grid, &Support::oedometer(), 1.0);
        surface.apply(&grid, &points, &mut nodes);
        let total: f64 = nodes.external_force.iter().map(|force| force[1]).sum();
        assert!((total + 3.0).abs() < 1e-12);
    }
}
