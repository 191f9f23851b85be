//! The limit of semi-implicit steps from the stiffness and the masses of a body's own nodes, wherever its points lie.

use crate::integrate::assembled::stiffness::NodeBlocks;
use crate::kernel::body::{Body, Discrete};
use crate::kernel::volumetric::VolumetricRows;
use oedometer_problem::wave_speeds::skeleton_limit;

/// Iterations that sharpen the bound: a mode of one node beside a smooth one is found in a few.
const SHARPENINGS: usize = 64;

/// A free component of a node: what resists its motion.
#[derive(Clone, Copy, Debug)]
struct Component {
    node: usize,
    direction: usize,
    /// Inertia, kg, and damping, N s/m, where water moves against the skeleton and keeps its volume.
    against: [f64; 2],
    /// Mass of both phases, kg, where motions move both together.
    together: Option<f64>,
}

impl Component {
    /// Largest step, s, for a stiffness, N/m.
    fn limit(&self, stiffness: f64) -> f64 {
        let [inertia, damping] = self.against;
        let against = skeleton_limit(stiffness, inertia, damping);
        self.together.map_or(against, |mass| against.min(skeleton_limit(stiffness, mass, 0.0)))
    }
}

/// Largest semi-implicit step, s, under which the explicit stresses of a problem make no mode grow.
///
/// The formula (docs/theory.md, Eq. 45) with the masses, the drag and the stiffness of each node in place of those of a cell.
/// For any positive `x` the stiffness `Σ_j |K_ij| x_j/x_i` that gives the smallest step bounds all modes (Collatz 1942); an
/// iteration of `x` sharpens the bound.
pub fn semi_implicit_limit<const D: usize>(problem: &Discrete<D>) -> f64 {
    let body = Body::new(Discrete { forcing: None, ..problem.clone() });
    let rows = body.volumetric_rows();
    let stiffness = body.skeleton_stiffness(&rows);
    let components = components(&body, &rows);
    let mut amplitude = vec![[0.0; D]; body.nodes.len()];
    for component in &components {
        amplitude[component.node][component.direction] = 1.0;
    }
    let mut largest = 0.0_f64;
    for _ in 0..SHARPENINGS {
        let stiffnesses: Vec<f64> =
            components.iter().map(|component| stiffness_felt(&stiffness, component, &amplitude)).collect();
        let limits =
            components.iter().zip(&stiffnesses).map(|(component, stiffness)| component.limit(*stiffness));
        let step = limits.fold(f64::INFINITY, f64::min);
        largest = largest.max(step);
        for (component, stiffness) in components.iter().zip(&stiffnesses) {
            // A component that could take larger steps moves less in the stiffest mode.
            let ratio = step / component.limit(*stiffness);
            amplitude[component.node][component.direction] *= 0.5 * (1.0 + ratio * ratio);
        }
    }
    largest
}

/// The free components of the nodes of a body.
fn components<const D: usize>(body: &Body<D>, rows: &VolumetricRows<D>) -> Vec<Component> {
    let nodes = &body.nodes;
    let are_undamped = D > 1 || body.method.has_projection();
    // The volume at a node that no pressure resists changes as that of both phases does.
    let mut is_resisted = vec![false; nodes.len()];
    for (node, _) in rows.divergence.iter().flatten().filter(|(_, gradient)| *gradient != [0.0; D]) {
        is_resisted[*node] = true;
    }
    let is_resisted = &is_resisted;
    let of_node = |node: usize| {
        let (porosity, masses) = (nodes.porosity[node], [nodes.solid_mass[node], nodes.water_mass[node]]);
        let per_skeleton = (1.0 - porosity) / porosity;
        (0..D).filter(move |direction| nodes.free[node][*direction] > 0.0).map(move |direction| Component {
            node,
            direction,
            against: [masses[0] + per_skeleton * per_skeleton * masses[1], nodes.drag[node] / porosity],
            together: (are_undamped || !is_resisted[node]).then(|| masses[0] + masses[1]),
        })
    };
    nodes.active.iter().flat_map(|node| of_node(*node)).collect()
}

/// `Σ_j |K_ij| x_j/x_i`, N/m.
fn stiffness_felt<const D: usize>(
    stiffness: &NodeBlocks<D>,
    component: &Component,
    amplitude: &[[f64; D]],
) -> f64 {
    let of_block = |(column, block): &(usize, [[f64; D]; D])| -> f64 {
        let products = block[component.direction].iter().zip(&amplitude[*column]);
        products.map(|(entry, amplitude)| entry.abs() * amplitude).sum()
    };
    let sum: f64 = stiffness.rows[component.node].iter().map(of_block).sum();
    sum / amplitude[component.node][component.direction]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::column_problem;
    use oedometer_problem::arrangement::Arrangement;
    use oedometer_problem::method::Method;
    use oedometer_problem::wave_speeds;
    use oedometer_scenes::column::Column;
    use oedometer_scenes::{COSINE_LAYER, TERZAGHI};
    use oedometer_soil::material::Material;

    fn problem<const D: usize>(name: &str, soil: &Material, points: Arrangement) -> Discrete<D> {
        let method = Method::named(name).expect("a known method");
        let (scene, column) = match D {
            1 => (&TERZAGHI, Column::default()),
            _ => (&COSINE_LAYER, Column::layer()),
        };
        column_problem::<D>(scene, &Column { points, ..column }, soil, method, 12, 4).expect("a column")
    }

    #[test]
    fn on_a_full_lattice_the_limit_of_the_nodes_is_that_of_the_formula() {
        for conductivity in [1e-5, 1.0] {
            let soil = Material { hydraulic_conductivity: conductivity, ..Material::default() };
            for name in ["MPM", "GIMP", "GC-SRI-patch", "PPP"] {
                let line = problem::<1>(name, &soil, Arrangement::default());
                let formula = wave_speeds::semi_implicit_limit(&soil, line.grid.cell_size, name == "PPP");
                let ratio = semi_implicit_limit(&line) / formula;
                assert!((ratio - 1.0).abs() < 0.01, "{name} {conductivity}: {ratio}");
            }
            let plane = problem::<2>("GIMP", &soil, Arrangement::default());
            let formula = wave_speeds::semi_implicit_limit(&soil, plane.grid.cell_size, true);
            let ratio = semi_implicit_limit(&plane) / formula;
            assert!((0.5..1.01).contains(&ratio), "{conductivity}: {ratio}");
        }
    }
}
