//! The bands of a frozen column, from the operators of its body.

use crate::mpm::assembled::column::{BAND, NodeRow, REACH};
use crate::mpm::body::{Body, ShapeFunction};

/// `K_σ = Σ V ∇N ⊗ E_oed G`, `K_p = Σ V ∇N ⊗ R Q D`, `P = M⁻¹ Σ N m ⊗ N`.
pub(crate) fn assemble_bands<const D: usize, const W: usize, S: ShapeFunction<W>>(
    body: &Body<D, W, S>,
    rows: &mut [NodeRow],
) {
    let stride = body.grid.node_stride();
    let modulus = body.material.oedometric_modulus();
    let bulk = body.stiffness.lame + 2.0 / 3.0 * body.stiffness.shear;
    let volumetric = body.volumetric_rows();
    for point in 0..body.points.len() {
        let volume = body.points.volume(point);
        let solid =
            body.points.initial_volume[point] * (1.0 - body.material.porosity) * body.material.grain_density;
        let strain = body.strain_row(point, &volumetric);
        let mut touched = [(0, 0.0, 0.0); 4];
        let mut count = 0;
        body.basis.visit(stride, point, |node, weight, gradient| {
            touched[count] = (node, weight, gradient[0]);
            count += 1;
        });
        for (node, weight, gradient) in &touched[..count] {
            // A weight that is round-off may reach further than the band; its row is at rest.
            let place = |column: usize| (column + REACH).checked_sub(*node).filter(|place| *place < BAND);
            let row = &mut rows[*node];
            for entry in &strain {
                if let Some(place) = place(entry.node) {
                    row.skeleton_stiffness[place] +=
                        volume * gradient * (modulus * entry.gradient[0] + bulk * entry.dilation[0]);
                }
            }
            for (site, share) in &volumetric.recovery[point] {
                for (column, coefficient) in &volumetric.divergence[*site] {
                    if let Some(place) = place(*column) {
                        row.pressure_stiffness[place] +=
                            volume * gradient * share * volumetric.coupling[*site] * coefficient[0];
                    }
                }
            }
            for (column, value, _) in &touched[..count] {
                if let Some(place) = place(*column) {
                    row.projection[place] += row.free * weight * solid * value * row.per_solid_mass;
                }
            }
        }
    }
}
