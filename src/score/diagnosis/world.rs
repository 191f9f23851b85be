//! Worlds: what the exact solution would be with one input of the solver, or one meaning of places and times, changed.
//!
//! A world predicts every column of a result at once, so a cause that one column excludes is never named for another.

use super::columns::{Field, Given};
use crate::import::SampledState;
use crate::measure::fields::{ExactFields, SamplePlaces};
use oedometer_exact::row::Changes;
use oedometer_exact::{ColumnParameters, Reference, ReferenceKind};
use oedometer_soil::layers::{SoilLayer, SoilLayers};

/// Time factors before which nothing has drained that samples show, and after which nothing changes.
const EDGES: [f64; 2] = [1e-9, 40.0];
/// [`EDGES`] of solutions that are computed step by step.
const STEPPED_EDGES: [f64; 2] = [1e-8, 5.0];
/// Share of the height at which nothing of a drained surface is seen at the start.
const JUST_BELOW: f64 = 1e-9;

/// Places in [0, 1] and weights of Gauss' rule of six points.
pub const GAUSS: [(f64, f64); 6] = [
    (0.033_765_242_898_423_97, 0.085_662_246_189_585_17),
    (0.169_395_306_766_867_76, 0.180_380_786_524_069_3),
    (0.380_690_406_958_401_56, 0.233_956_967_286_345_53),
    (0.619_309_593_041_598_4, 0.233_956_967_286_345_53),
    (0.830_604_693_233_132_2, 0.180_380_786_524_069_3),
    (0.966_234_757_101_576, 0.085_662_246_189_585_17),
];

/// Fields at all samples of all sets, one after the other, and the settlement of each output.
#[derive(Clone, Debug, Default)]
pub struct Predicted {
    fields: ExactFields,
    settlement: Vec<f64>,
}

impl Predicted {
    /// The values of a field.
    pub fn field(&self, field: Field) -> &[f64] {
        match field {
            Field::Pressure => &self.fields.pressure,
            Field::EffectiveStress => &self.fields.effective_stress,
            Field::Up => &self.fields.displacement,
            Field::Along => &self.fields.horizontal_displacement,
            Field::Settlement => &self.settlement,
        }
    }

    fn lists(&mut self) -> [&mut Vec<f64>; 5] {
        let ExactFields { pressure, effective_stress, displacement, horizontal_displacement } =
            &mut self.fields;
        [pressure, effective_stress, displacement, horizontal_displacement, &mut self.settlement]
    }

    /// Adds a multiple of another prediction of the same samples.
    fn add(&mut self, share: f64, mut other: Self) {
        for (list, other) in self.lists().into_iter().zip(other.lists()) {
            list.resize(other.len(), 0.0);
            list.iter_mut().zip(other).for_each(|(value, other)| *value += share * *other);
        }
    }
}

/// Where places lie, and where water leaves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ends {
    /// As in the scene.
    Own,
    /// The file counts heights from the other end.
    UpsideDown,
    /// Water leaves at the base in place of the surface.
    DrainedBase,
    /// Water leaves at both ends.
    BothDrained,
    /// Water leaves nowhere.
    Closed,
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
    /// Factor of the pressure, where a problem has another start.
    pub pressure: f64,
    /// Factor of all fields, of another load at small strain.
    pub load: f64,
    /// How long the load rises, s, in place of being there at once.
    pub ramp: f64,
    /// How a sentence goes on after "the exact one".
    pub said: String,
    /// The questions to ask.
    pub asked: Vec<String>,
    /// Number of single mistakes in it, and how many of its numbers were fitted.
    pub count: usize,
    pub fitted: usize,
}

impl World {
    /// The scene as it is.
    pub fn own(given: &Given<'_>) -> Self {
        Self {
            kind: given.kind,
            parameters: *given.parameters,
            clock: [1.0, 0.0],
            ends: Ends::Own,
            is_coupled: true,
            pressure: 1.0,
            load: 1.0,
            ramp: 0.0,
            said: String::new(),
            asked: Vec::new(),
            count: 0,
            fitted: 0,
        }
    }

    /// This world with one mistake more.
    #[must_use]
    pub fn with(mut self, said: &str, asked: impl Into<String>) -> Self {
        self.said = format!("{}{said}", self.said);
        self.asked.push(asked.into());
        self.count += 1;
        self
    }

    /// [`with`](Self::with) of a number that was fitted.
    #[must_use]
    pub fn fitted(self, said: &str, asked: impl Into<String>) -> Self {
        Self { fitted: self.fitted + 1, ..self.with(said, asked) }
    }

    /// This world under another load: a factor of all fields, or another input where they do not grow with it.
    #[must_use]
    pub fn loaded(mut self, factor: f64, given: &Given<'_>) -> Self {
        if given.is_linear() && !self.parameters.self_weight {
            self.load = factor;
        } else {
            self.parameters.load *= factor;
        }
        self
    }

    /// This world with a skeleton that is stiffer by a factor: slower to move, and less.
    #[must_use]
    pub fn stiffer(self, factor: f64) -> Self {
        let parameters = with_soils(&self.parameters, |layer| {
            layer.youngs_modulus = layer.youngs_modulus.map(|modulus| factor * modulus);
        });
        Self { parameters, ..self }
    }

    /// Whether the times mean what a diffusion makes of them.
    pub fn is_slow(&self) -> bool {
        self.kind.row().changes == Changes::Diffuses
    }

    /// Whether a load in parts has the sum of what each part does.
    pub fn adds_up(&self) -> bool {
        self.kind.row().adds_up
    }

    /// Whether the body is one column of soil, or of layers, that strains along its height alone and has no weight.
    pub fn is_a_column(&self) -> bool {
        use ReferenceKind::{Layered, Terzaghi, TerzaghiIncompressible, XieLeo};
        let is_large = matches!(self.kind, ReferenceKind::LargeStrain(_));
        let is_plain = [Terzaghi, TerzaghiIncompressible, XieLeo, Layered].contains(&self.kind) || is_large;
        is_plain && !self.parameters.self_weight
    }

    /// The time factor of a time, s, that the file has.
    fn time_factor(&self, seconds: f64) -> f64 {
        let factor = self.parameters.time_factor(self.clock[0] * seconds + self.clock[1]);
        let own = self.parameters.time_factor(seconds);
        match self.kind {
            ReferenceKind::LargeStrain(_) if factor > 0.0 => factor.clamp(STEPPED_EDGES[0], STEPPED_EDGES[1]),
            _ if self.is_slow() && factor > 0.0 => factor.clamp(EDGES[0].min(own), EDGES[1].max(own)),
            _ => factor,
        }
    }

    /// The time factors of times.
    pub fn time_factors(&self, times: &[f64]) -> Vec<f64> {
        times.iter().map(|time| self.time_factor(*time)).collect()
    }

    /// The solution, ready for times at some factors of them.
    pub fn solution(&self, given: &Given<'_>, times: &[f64], factors: &[f64]) -> Option<Reference> {
        let at = |factor: &f64| {
            let world = Self { clock: [factor * self.clock[0], self.clock[1]], ..self.clone() };
            world.time_factors(times)
        };
        let is_timed = !self.is_slow() || matches!(self.kind, ReferenceKind::LargeStrain(_));
        if self.kind == given.kind && self.parameters == *given.parameters && !is_timed {
            return Some(given.solution.clone());
        }
        let times: Vec<f64> = factors.iter().flat_map(at).collect();
        Reference::for_lines(self.kind, &self.parameters, &times).ok()
    }

    /// What the world predicts for the samples of a result.
    pub fn predict(&self, given: &Given<'_>) -> Option<Predicted> {
        self.predict_at(given, &given.times)
    }

    /// As [`predict`](Self::predict), at other times of its outputs.
    pub fn predict_at(&self, given: &Given<'_>, times: &[f64]) -> Option<Predicted> {
        let solution = self.of_half().solution(given, times, &[1.0])?;
        self.predict_by(&solution, given, times)
    }

    /// As [`predict_at`](Self::predict_at), by a solution that is ready: at once, or as the sum of what each part of a
    /// rising load does.
    pub fn predict_by(&self, solution: &Reference, given: &Given<'_>, times: &[f64]) -> Option<Predicted> {
        let mut all = Predicted::default();
        for (output, seconds) in times.iter().enumerate() {
            let sets = || given.sets.iter().filter(|(of, _)| *of == output).map(|(_, set)| &**set);
            let mut here = Predicted::default();
            if self.ramp > 0.0 {
                // Ages of the load's parts; most happens when they are young, as the root of the age.
                let youngest = (seconds - self.ramp).max(0.0);
                for (place, weight) in GAUSS {
                    let share = 2.0 * (seconds - youngest) * place * weight / self.ramp;
                    let age = youngest + (seconds - youngest) * place * place;
                    here.add(share, self.state(solution, age, sets())?);
                }
            } else {
                here = self.state(solution, *seconds, sets())?;
            }
            here.fields.pressure.iter_mut().for_each(|pressure| *pressure *= self.pressure);
            for (list, here) in all.lists().into_iter().zip(here.lists()) {
                list.extend(here.iter().map(|value| self.load * value));
            }
        }
        Some(all)
    }

    /// The fields at the places of an output under the whole load.
    fn state<'b>(
        &self,
        solution: &Reference,
        seconds: f64,
        sets: impl Iterator<Item = &'b SampledState>,
    ) -> Option<Predicted> {
        let half = self.of_half();
        let time = half.time_factor(seconds);
        let halves = if self.ends == Ends::BothDrained { 2.0 } else { 1.0 };
        let settlement = solution.settlement(time).ok()?;
        let mut all = Predicted { settlement: vec![halves * settlement], ..Predicted::default() };
        for set in sets {
            let mut fields = self.fields(solution, time, &Places::of(self, &half, set))?;
            for (list, here) in all.lists().into_iter().zip(lists_of(&mut fields)) {
                list.append(here);
            }
        }
        Some(all)
    }

    /// The body whose solution is asked: half of a column that is drained at both ends, one on its head.
    fn of_half(&self) -> Self {
        let mut world = self.clone();
        if self.ends == Ends::BothDrained {
            world.parameters.height *= 0.5;
        }
        if self.ends == Ends::DrainedBase {
            world.parameters.soils = turned(&self.parameters.soils);
        }
        world
    }

    /// The fields at places.
    fn fields(&self, solution: &Reference, time: f64, places: &Places) -> Option<ExactFields> {
        let at = |time: f64| ExactFields::of(solution, time, places.samples()).ok();
        let mut fields = at(time)?;
        if !self.is_coupled {
            fields = ExactFields { pressure: fields.pressure, ..at(EDGES[1])? };
        }
        // A strain that is mirrored adds up from the other end.
        let top = solution.settlement(time).ok()?;
        for (up, is_mirrored) in fields.displacement.iter_mut().zip(&places.mirrored) {
            match self.ends {
                Ends::DrainedBase => *up = -top - *up,
                Ends::BothDrained if *is_mirrored => *up = -top - *up,
                Ends::BothDrained => *up -= top,
                _ => {}
            }
        }
        if self.ends == Ends::OtherSide {
            fields.horizontal_displacement.iter_mut().for_each(|along| *along = -*along);
        }
        Some(fields)
    }
}

fn lists_of(fields: &mut ExactFields) -> [&mut Vec<f64>; 4] {
    let ExactFields { pressure, effective_stress, displacement, horizontal_displacement } = fields;
    [pressure, effective_stress, displacement, horizontal_displacement]
}

/// The places of a state in the body of a world.
struct Places {
    height: f64,
    heights: Vec<f64>,
    distances: Vec<f64>,
    /// Whether the sample lies in the lower half of a column that is drained at both ends.
    mirrored: Vec<bool>,
}

impl Places {
    fn of(world: &World, half: &World, state: &SampledState) -> Self {
        let (height, length) = (world.parameters.height, world.parameters.length);
        let middle = half.parameters.height;
        let heights = &state.initial_height;
        let is_low = |y: &f64| world.ends == Ends::BothDrained && *y < middle;
        let of_height = |y: &f64| match world.ends {
            Ends::UpsideDown | Ends::DrainedBase => (height - y).max(0.0),
            Ends::BothDrained => (y - middle).abs().min(middle),
            // What holds just below the surface holds at a closed one.
            Ends::Closed => y.min((1.0 - JUST_BELOW) * height),
            _ => *y,
        };
        let own = || state.initial_distance.clone();
        let (heights_here, distances) = match world.ends {
            Ends::AxesExchanged => (own(), heights.clone()),
            Ends::OtherSide => (heights.clone(), own().iter().map(|x| (length - x).max(0.0)).collect()),
            _ => (heights.iter().map(of_height).collect(), own()),
        };
        let mirrored = heights.iter().map(is_low).collect();
        Self { height: middle, heights: heights_here, distances, mirrored }
    }

    fn samples(&self) -> SamplePlaces<'_> {
        SamplePlaces { height: self.height, heights: &self.heights, distances: &self.distances }
    }
}

/// The layers of a column that stands on its head.
fn turned(layers: &SoilLayers) -> SoilLayers {
    let turned: Vec<SoilLayer> = layers.iter().rev().copied().collect();
    SoilLayers::from_slice(&turned).unwrap_or(*layers)
}

/// The soils of a column with all their values changed: that of the column, and those of its layers.
pub fn with_soils(parameters: &ColumnParameters, change: impl Fn(&mut SoilLayer)) -> ColumnParameters {
    let changed = |thickness: f64, soil: &oedometer_soil::material::Material| {
        let mut layer = SoilLayer {
            thickness,
            youngs_modulus: Some(soil.youngs_modulus),
            poissons_ratio: Some(soil.poissons_ratio),
            porosity: Some(soil.porosity),
            water_bulk_modulus: Some(soil.water_bulk_modulus),
            hydraulic_conductivity: Some(soil.hydraulic_conductivity),
        };
        change(&mut layer);
        layer
    };
    let soil = &parameters.soil;
    let layers: Vec<SoilLayer> =
        parameters.soils.iter().map(|layer| changed(layer.thickness, &layer.soil(soil))).collect();
    ColumnParameters {
        soil: changed(parameters.height, soil).soil(soil),
        soils: SoilLayers::from_slice(&layers).unwrap_or(parameters.soils),
        ..*parameters
    }
}
