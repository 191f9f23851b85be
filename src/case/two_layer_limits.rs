//! What does not go with two layers of points, and why.

use crate::case::Case;
use oedometer_mpm::method::{Basis, Configuration, Memory};
use oedometer_mpm::scene::SceneKind;
use oedometer_soil::conductivity_mean::ConductivityMean;

impl Case {
    /// Why its water cannot have a layer of points of its own, where it is to have one; with what would be right.
    pub fn refuses_two_layers(&self) -> Option<(&'static str, &'static str)> {
        let (points, method) = (&self.column.points, &self.method);
        if !points.has_two_layers() {
            return None;
        }
        let configuration = method.configuration_or(self.scene.configuration());
        let moves = configuration == Configuration::Updated;
        [
            (
                !self.is_explicit(),
                "two layers of points are integrated explicitly alone",
                "take the integrator \"explicit\", or `layers = 1`",
            ),
            (
                configuration == Configuration::Total,
                "weights on the initial configuration stay with the skeleton, and the water of a second layer does not",
                "take a method without the prefix TL-, or `layers = 1`",
            ),
            (
                method.memory == Memory::Cells,
                "cells remember what one layer carries, and here are two",
                "take a method without the suffix -cells, or `layers = 1`",
            ),
            (
                moves && !matches!(method.basis, Basis::Cpgimp | Basis::Cpdi),
                "the domains of water points follow their water where points move, and this basis has none that follow",
                "take the basis \"cpgimp\" or \"cpdi\", or `layers = 1`",
            ),
            (
                self.scene == SceneKind::Mandel,
                "a rigid plate is tied to one layer of points",
                "take another scene, or `layers = 1`",
            ),
            (
                self.column.self_weight,
                "the weight of a column is carried by one layer of points",
                "leave `self_weight` out, or take `layers = 1`",
            ),
            (
                self.material.conductivity_mean == ConductivityMean::Chord,
                "the chord mean is taken over points that carry both phases",
                "take `conductivity_mean = \"points\"`, or `layers = 1`",
            ),
            (
                points.jitter != 0.0 || points.offset != 0.0,
                "shifted domains of the water do not end where the soil does",
                "leave `offset` and `jitter` out, or take `layers = 1`",
            ),
        ]
        .into_iter()
        .find_map(|(is_so, why, help)| is_so.then_some((why, help)))
    }

    /// Why a column of this case cannot carry its weight, and what would do, or nothing where it can.
    pub fn refuses_own_weight(&self) -> Option<(&'static str, &'static str)> {
        (self.column.self_weight && self.column.points.offset != 0.0).then_some((
            "domains shifted off their lattice integrate no weight exactly: the column would flow from the start",
            "leave `offset` out, or take `self_weight = false`",
        ))
    }
}
