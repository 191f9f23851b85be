//! The frozen step of whichever dimension: a banded map for a column, sparse maps above.

use crate::mpm::assembled::column::AssembledColumn;
use crate::mpm::assembled::plane::AssembledPlane;
use crate::mpm::body::{Body, ShapeFunction};
use crate::mpm::explicit::ExplicitSettings;

/// A frozen body with its step assembled.
#[derive(Clone, Debug)]
pub enum FrozenStep<const D: usize> {
    /// One dimension.
    Column(Box<AssembledColumn>),
    /// More.
    Plane(Box<AssembledPlane<D>>),
}

impl<const D: usize> FrozenStep<D> {
    /// Assembles the step of a body on its present operators.
    pub fn new<const W: usize, S: ShapeFunction<W>>(body: &Body<D, W, S>) -> Self {
        match AssembledColumn::new(body) {
            Some(column) => Self::Column(Box::new(column)),
            None => Self::Plane(Box::new(AssembledPlane::new(body))),
        }
    }

    /// Fixes the duration of a kick and the drag. Call before a step.
    pub fn set_step(&mut self, kick: f64, settings: &ExplicitSettings) {
        match self {
            Self::Column(column) => column.set_step(kick, settings),
            Self::Plane(plane) => plane.set_step(kick, settings),
        }
    }

    /// Lets a share of the load act that was there at the assembly.
    pub fn set_load_share(&mut self, share: f64) {
        match self {
            Self::Column(column) => column.set_load_share(share),
            Self::Plane(plane) => plane.set_load_share(share),
        }
    }

    /// One step whose velocities advance by `kick` seconds, and all that they carry by `dt`; nothing
    /// is allocated.
    #[inline]
    pub fn kick_and_drift(&mut self, kick: f64, dt: f64, settings: &ExplicitSettings) {
        match self {
            Self::Column(column) => column.kick_and_drift(kick, dt, settings),
            Self::Plane(plane) => plane.kick_and_drift(kick, dt, settings),
        }
    }

    /// Largest nodal velocity, m/s: infinite where one is not finite.
    pub fn largest_velocity(&self) -> f64 {
        match self {
            Self::Column(column) => column.largest_velocity(),
            Self::Plane(plane) => plane.largest_velocity(),
        }
    }

    /// Displacement of the loaded surface since the assembly, m.
    pub fn surface_displacement(&self) -> f64 {
        match self {
            Self::Column(column) => column.surface_displacement(),
            Self::Plane(plane) => plane.surface_displacement(),
        }
    }

    /// The body at the present state, from the body that was assembled.
    pub fn body_now<const W: usize, S: ShapeFunction<W>>(&self, initial: &Body<D, W, S>) -> Body<D, W, S> {
        match self {
            Self::Column(column) => column.body_now(initial),
            Self::Plane(plane) => plane.body_now(initial),
        }
    }
}
