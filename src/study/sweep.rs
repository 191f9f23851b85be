//! Sweeps: lists of choices, multiplied out or tied to a path.

use crate::mpm::explicit::Drag;
use crate::mpm::explicit::scheme::Scheme;
use crate::mpm::method::Method;
use crate::mpm::run::TimeStepRule;
use crate::mpm::run::integrator::{Formulation, IntegratorKind};
use crate::soil::continuity::Continuity;
use crate::soil::law::Law;

/// One block of a study, checked.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    pub method: Vec<Method>,
    pub integrator: Vec<IntegratorKind>,
    /// Formulations; none where the integrator's own holds.
    pub formulation: Vec<Option<Formulation>>,
    pub cells: Vec<usize>,
    pub points_per_cell: Vec<usize>,
    /// Step rules; none where the integrator's own holds.
    pub time_step: Vec<Option<TimeStepRule>>,
    pub scheme: Vec<Scheme>,
    pub drag: Vec<Drag>,
    pub flip: Vec<f64>,
    pub mapping_back: Vec<bool>,
    pub law: Vec<Law>,
    pub continuity: Vec<Continuity>,
    pub porosity: Vec<f64>,
    pub hydraulic_conductivity: Vec<f64>,
    pub water_bulk_modulus: Vec<f64>,
    pub offset: Vec<f64>,
    pub poissons_ratio: Vec<f64>,
    /// Axes that step together, by key.
    pub path: Vec<String>,
}

/// Keys that a path can tie.
pub const AXES: [&str; 17] = [
    "method",
    "integrator",
    "cells",
    "points_per_cell",
    "time_step",
    "drag",
    "flip",
    "mapping_back",
    "law",
    "continuity",
    "formulation",
    "scheme",
    "porosity",
    "hydraulic_conductivity",
    "water_bulk_modulus",
    "offset",
    "poissons_ratio",
];

/// One combination of a sweep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Combination {
    pub method: Method,
    pub integrator: IntegratorKind,
    pub formulation: Formulation,
    pub cells: usize,
    pub points_per_cell: usize,
    pub time_step: TimeStepRule,
    pub scheme: Scheme,
    pub drag: Drag,
    pub flip: f64,
    pub mapping_back: bool,
    pub law: Law,
    pub continuity: Continuity,
    pub porosity: f64,
    pub hydraulic_conductivity: f64,
    pub water_bulk_modulus: f64,
    pub offset: f64,
    pub poissons_ratio: f64,
}

impl Sweep {
    fn lengths(&self) -> [usize; AXES.len()] {
        [
            self.method.len(),
            self.integrator.len(),
            self.cells.len(),
            self.points_per_cell.len(),
            self.time_step.len(),
            self.drag.len(),
            self.flip.len(),
            self.mapping_back.len(),
            self.law.len(),
            self.continuity.len(),
            self.formulation.len(),
            self.scheme.len(),
            self.porosity.len(),
            self.hydraulic_conductivity.len(),
            self.water_bulk_modulus.len(),
            self.offset.len(),
            self.poissons_ratio.len(),
        ]
    }

    /// Axes of a path that are not as long as its first: a path has one length.
    pub fn uneven_path(&self) -> Option<(String, usize, usize)> {
        let length = |key: &String| AXES.iter().position(|axis| axis == key).map(|axis| self.lengths()[axis]);
        let first = self.path.first().and_then(length)?;
        self.path.iter().find_map(|key| {
            let own = length(key)?;
            (own != first).then(|| (key.clone(), own, first))
        })
    }

    fn is_tied(&self, axis: usize) -> bool {
        self.path.iter().any(|key| key == AXES[axis])
    }

    /// The axis at whose place the path counts as one: its first member.
    fn leader(&self) -> Option<usize> {
        (0..AXES.len()).find(|axis| self.is_tied(*axis))
    }

    /// Axes that turn on their own, the slowest first.
    fn turning(&self) -> Vec<usize> {
        let leader = self.leader();
        (0..AXES.len()).filter(|axis| !self.is_tied(*axis) || Some(*axis) == leader).collect()
    }

    /// How many combinations there are; none where no machine could count them.
    pub fn count(&self) -> Option<usize> {
        let lengths = self.lengths();
        self.turning().into_iter().try_fold(1_usize, |count, axis| count.checked_mul(lengths[axis]))
    }

    /// Every combination, the first axis slowest. The axes of a path step together. None at all where
    /// they cannot be counted.
    pub fn combinations(&self) -> impl Iterator<Item = Combination> {
        let (lengths, turning, leader) = (self.lengths(), self.turning(), self.leader());
        (0..self.count().unwrap_or(0)).map(move |number| {
            let mut at = [0; AXES.len()];
            let mut rest = number;
            for axis in turning.iter().rev() {
                at[*axis] = rest % lengths[*axis];
                rest /= lengths[*axis];
            }
            if let Some(leader) = leader {
                for axis in (0..AXES.len()).filter(|axis| self.is_tied(*axis)) {
                    at[axis] = at[leader];
                }
            }
            self.combination(at)
        })
    }

    /// The combination at a place on every axis, in the order of [`AXES`].
    fn combination(&self, at: [usize; AXES.len()]) -> Combination {
        Combination {
            method: self.method[at[0]],
            integrator: self.integrator[at[1]],
            cells: self.cells[at[2]],
            points_per_cell: self.points_per_cell[at[3]],
            time_step: self.time_step[at[4]].unwrap_or_else(|| self.integrator[at[1]].default_rule()),
            drag: self.drag[at[5]],
            flip: self.flip[at[6]],
            mapping_back: self.mapping_back[at[7]],
            law: self.law[at[8]],
            continuity: self.continuity[at[9]],
            formulation: self.formulation[at[10]]
                .unwrap_or_else(|| self.integrator[at[1]].default_formulation()),
            scheme: self.scheme[at[11]],
            porosity: self.porosity[at[12]],
            hydraulic_conductivity: self.hydraulic_conductivity[at[13]],
            water_bulk_modulus: self.water_bulk_modulus[at[14]],
            offset: self.offset[at[15]],
            poissons_ratio: self.poissons_ratio[at[16]],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sweep(path: &[&str]) -> Sweep {
        Sweep {
            method: ["GIMP", "GC-SRI-patch"].iter().filter_map(|name| Method::named(name)).collect(),
            integrator: vec![IntegratorKind::Explicit],
            cells: vec![5, 10, 20],
            points_per_cell: vec![2],
            time_step: [4e-6, 2e-6, 1e-6].map(|step| Some(TimeStepRule::Seconds(step))).to_vec(),
            scheme: vec![Scheme::ForwardEuler],
            drag: vec![Drag::Explicit],
            flip: vec![1.0],
            mapping_back: vec![true],
            law: vec![Law::Linear],
            continuity: vec![Continuity::Conservative],
            porosity: vec![0.3],
            hydraulic_conductivity: vec![1e-4],
            water_bulk_modulus: vec![2.2e9],
            offset: vec![0.0],
            poissons_ratio: vec![0.25],
            formulation: vec![None],
            path: path.iter().map(|key| (*key).to_owned()).collect(),
        }
    }

    #[test]
    fn a_product_has_every_combination_once() {
        let all: Vec<Combination> = sweep(&[]).combinations().collect();
        assert_eq!(all.len(), 2 * 3 * 3);
        for (index, one) in all.iter().enumerate() {
            assert!(!all[..index].contains(one));
        }
    }

    #[test]
    fn a_path_steps_its_axes_together() {
        let all: Vec<Combination> = sweep(&["cells", "time_step"]).combinations().collect();
        assert_eq!(all.len(), 2 * 3);
        assert_eq!(sweep(&["cells", "time_step"]).count(), Some(2 * 3));
        for one in all {
            let place = [5, 10, 20].iter().position(|cells| *cells == one.cells);
            let steps = sweep(&[]).time_step;
            assert_eq!(place.and_then(|place| steps[place]), Some(one.time_step));
        }
    }

    #[test]
    fn more_combinations_than_can_be_counted_are_none_and_no_few() {
        let many = |length: usize| Sweep {
            cells: vec![5; length],
            porosity: vec![0.3; length],
            flip: vec![1.0; length],
            offset: vec![0.0; length],
            poissons_ratio: vec![0.25; length],
            water_bulk_modulus: vec![2.2e9; length],
            hydraulic_conductivity: vec![1e-4; length],
            mapping_back: vec![true; length],
            ..sweep(&["time_step", "method"])
        };
        // Eight axes of 256 values wrap a product of 64 bits to nothing.
        assert_eq!(many(256).count(), None);
        assert_eq!(many(256).combinations().count(), 0);
        assert_eq!(many(2).count(), Some(256 * 2));
    }

    #[test]
    fn an_uneven_path_is_named() {
        let mut uneven = sweep(&["cells", "time_step"]);
        uneven.time_step.pop();
        assert_eq!(uneven.uneven_path(), Some(("time_step".to_owned(), 2, 3)));
        assert_eq!(sweep(&["cells", "time_step"]).uneven_path(), None);
    }
}
