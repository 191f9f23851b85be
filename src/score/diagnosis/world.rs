//! Worlds: what the exact solution would be with one input of the solver, or one meaning of places and times, changed.
//!
//! A world predicts every column of a result at once, so a cause that one column excludes is never named for another.

use super::columns::{Given, Set};
use crate::measure::fields::{ExactFields, SamplePlaces};
use oedometer_exact::row::{Axis, Changes};
use oedometer_exact::{ColumnParameters, Drainage, Reference, ReferenceKind};
use oedometer_soil::layers::{SoilLayer, SoilLayers};
use oedometer_soil::material::Material;

/// Time factors before which nothing has drained that samples show, and after which nothing changes.
pub const EDGES: [f64; 2] = [1e-8, 10.0];

/// Parts of an integral over time.
const PARTS: u32 = 10;

/// Values of each [`Field`](super::columns::Field) in its order, at all samples of all sets.
pub type Fields = [Vec<f64>; 5];

/// Where places lie in the body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ends {
    /// As in the scene.
    Own,
    /// The file counts heights from the other end.
    UpsideDown,
    /// Water leaves at the base in place of the surface.
    DrainedBase,
    /// The file's x and y are exchanged.
    AxesExchanged,
    /// The file counts distances along a layer from the other end.
    OtherSide,
}

/// One changed input or meaning.
#[derive(Clone, Debug)]
pub struct World {
    pub kind: ReferenceKind,
    pub parameters: ColumnParameters,
    /// Factor of the times, and what is added to them, s.
    pub clock: [f64; 2],
    pub ends: Ends,
    /// Whether the skeleton feels the pressure; else it carries the load at once.
    pub is_coupled: bool,
    /// How long the load rises, s, in place of being there at once.
    pub ramp: f64,
}

impl World {
    /// A scene as it is.
    pub fn own(kind: ReferenceKind, parameters: &ColumnParameters) -> Self {
        let parameters = *parameters;
        Self { kind, parameters, clock: [1.0, 0.0], ends: Ends::Own, is_coupled: true, ramp: 0.0 }
    }

    /// This world with all its soils changed: that of the column, and those of its layers.
    #[must_use]
    pub fn with_soils(mut self, change: impl Fn(&mut Material)) -> Self {
        let soil = self.parameters.soil;
        change(&mut self.parameters.soil);
        let changed = |layer: &SoilLayer| {
            let mut soil = layer.soil(&soil);
            change(&mut soil);
            let [young, nu, water] =
                [soil.youngs_modulus, soil.poissons_ratio, soil.water_bulk_modulus].map(Some);
            SoilLayer { youngs_modulus: young, poissons_ratio: nu, water_bulk_modulus: water, ..*layer }
        };
        let layers: Vec<SoilLayer> = self.parameters.soils.iter().map(changed).collect();
        self.parameters.soils = SoilLayers::from_slice(&layers).unwrap_or(self.parameters.soils);
        self
    }

    /// Whether the times mean what a diffusion makes of them.
    pub fn is_slow(&self) -> bool {
        self.kind.row().changes == Changes::Diffuses
    }

    /// Whether the body is a slab between plates.
    pub fn is_slab(&self) -> bool {
        self.kind.row().axis == Axis::AlongSlab
    }

    /// Whether the body is a column that strains along its height alone.
    pub fn is_column(&self) -> bool {
        self.is_slow() && self.kind.row().axis == Axis::OverDepth && !self.parameters.self_weight
    }

    /// The time factor of a time, s, that the file has.
    fn time_factor(&self, seconds: f64) -> f64 {
        let factor = self.parameters.time_factor(self.clock[0] * seconds + self.clock[1]).max(0.0);
        let own = self.parameters.time_factor(seconds);
        let [first, last] = [EDGES[0].min(own), EDGES[1].max(own)];
        if self.is_slow() && factor > 0.0 { factor.clamp(first, last) } else { factor }
    }

    /// What the world predicts for the samples of a result at times of its outputs, s; `None` where it has no solution.
    /// Where a drained end has the pressure of before the start or of after, as the file may, it is not a number.
    pub fn predict(&self, given: &Given<'_>, times: &[f64]) -> Option<Fields> {
        let factors: Vec<f64> = times.iter().map(|time| self.time_factor(*time)).collect();
        let solution = Reference::for_lines(self.kind, &self.parameters, &factors).ok()?;
        let mut all = Fields::default();
        for set in &given.sets {
            let mut here = Fields::default();
            for (share, age) in self.parts_of_load(times[set.output]) {
                for (sum, part) in here.iter_mut().zip(self.state(&solution, self.time_factor(age), set)?) {
                    sum.resize(part.len(), 0.0);
                    sum.iter_mut().zip(part).for_each(|(sum, part)| *sum += share * part);
                }
            }
            all.iter_mut().zip(here).for_each(|(all, here)| all.extend(here));
        }
        Some(all)
    }

    /// Shares of the load with their ages, s: all of it, or of a rising load some.
    fn parts_of_load(&self, seconds: f64) -> Vec<(f64, f64)> {
        if self.ramp == 0.0 {
            return vec![(1.0, seconds)];
        }
        let youngest = (seconds - self.ramp).max(0.0);
        let span = seconds - youngest;
        early_parts().map(|(place, weight)| (span * weight / self.ramp, youngest + span * place)).collect()
    }

    /// The fields at the places of a set under the whole load.
    fn state(&self, solution: &Reference, time: f64, set: &Set) -> Option<Fields> {
        let (height, length) = (self.parameters.height, self.parameters.length);
        let place = |(place, y): (usize, &f64)| {
            let (x, y) = (set.distances.get(place).copied().unwrap_or(0.0), *y);
            match self.ends {
                Ends::Own => (x, y),
                Ends::UpsideDown | Ends::DrainedBase => (x, height - y),
                Ends::AxesExchanged => (y, x),
                Ends::OtherSide => (length - x, y),
            }
        };
        let (x, heights): (Vec<f64>, Vec<f64>) = set.heights.iter().enumerate().map(place).unzip();
        let distances = if set.distances.is_empty() { &[][..] } else { &x };
        let places = SamplePlaces { height, heights: &heights, distances };
        let at = |time: f64| ExactFields::of(solution, time, places).ok();
        let ExactFields { mut pressure, effective_stress, mut displacement, mut horizontal_displacement } =
            at(if self.is_coupled { time } else { EDGES[1] })?;
        if !self.is_coupled {
            pressure = at(time)?.pressure;
        }
        let settlement = solution.settlement(time).ok()?;
        match self.ends {
            // A strain that is mirrored adds up from the other end.
            Ends::DrainedBase => displacement.iter_mut().for_each(|up| *up = -settlement - *up),
            Ends::OtherSide => horizontal_displacement.iter_mut().for_each(|along| *along = -*along),
            _ => {}
        }
        let is_both = self.parameters.drainage == Drainage::Both;
        let is_drained = |y: f64| y >= height || is_both && y <= 0.0;
        if time == 0.0 {
            let torn = pressure.iter_mut().zip(&heights).filter(|(_, y)| is_drained(**y));
            torn.for_each(|(pressure, _)| *pressure = f64::NAN);
        }
        let settled = vec![settlement; heights.len()];
        Some([pressure, effective_stress, displacement, horizontal_displacement, settled])
    }
}

/// Shares of a time with their weights in a mean over it: most are early, as most happens then, as the root of the time.
pub fn early_parts() -> impl Iterator<Item = (f64, f64)> {
    let part = |number: u32| (f64::from(number) + 0.5) / f64::from(PARTS);
    (0..PARTS).map(part).map(|place| (place * place, 2.0 * place / f64::from(PARTS)))
}
