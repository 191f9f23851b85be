//! Points that are lost: their pores closed, or they left the grid.

use crate::integrate::stepper::StepFailure;
use crate::kernel::body::Body;
use oedometer_problem::outcome::FailureKind;

impl<const D: usize> Body<D> {
    /// A point whose pores closed, where there is one.
    pub(crate) fn closed_pores(&self) -> Option<StepFailure> {
        let grains = |point: usize| 1.0 - self.soil_of(point).porosity;
        let ratios = &self.points.volume_ratio;
        let most_grains = self.soils.iter().map(|soil| 1.0 - soil.porosity).fold(0.0, f64::max);
        if ratios.iter().all(|ratio| *ratio > most_grains) {
            return None;
        }
        let is_closed = |point: &usize| ratios[*point] <= grains(*point) || ratios[*point].is_nan();
        let point = (0..ratios.len()).find(is_closed)?;
        Some(pores_closed(point, ratios[point], grains(point)))
    }
}

/// A point whose pores closed or that left the grid, where there is one.
pub fn lost_point<const D: usize>(body: &Body<D>) -> Option<StepFailure> {
    let points = &body.points;
    if let Some(closed) = body.closed_pores() {
        return Some(closed);
    }
    let outside = points.position.iter().position(|position| !body.grid.holds(position))?;
    let reason = format!("point {outside} is at {:?} m", points.position[outside]);
    Some(StepFailure { kind: FailureKind::LeftGrid, reason })
}

/// The end of a run one of whose points has the volume ratio of its grains, or less.
pub fn pores_closed(point: usize, ratio: f64, grains: f64) -> StepFailure {
    let reason = format!("point {point} has J = {ratio:.4}, its grains alone fill {grains:.4}");
    StepFailure { kind: FailureKind::PoresClosed, reason }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::column_problem;
    use oedometer_problem::method::Method;
    use oedometer_scenes::TERZAGHI;
    use oedometer_scenes::column::Column;
    use oedometer_soil::material::Material;

    #[test]
    fn a_point_outside_the_grid_is_lost_whichever_and_on_either_side() {
        let method = Method::named("GIMP").expect("known");
        let problem = column_problem::<1>(&TERZAGHI, &Column::default(), &Material::default(), method, 4, 2)
            .expect("a column");
        let sound = Body::new(problem);
        assert!(lost_point(&sound).is_none());
        for point in [0, 3, 7] {
            for place in [-1e3, 1e3] {
                let mut body = sound.clone();
                body.points.position[point] = [place];
                let lost = lost_point(&body).expect("a point that left");
                assert!(
                    lost.kind == FailureKind::LeftGrid && lost.reason.contains(&format!("point {point} "))
                );
            }
        }
    }
}
