//! Worlds: what the exact solution would be with one input of the solver, or one reading of times and places, changed.
//!
//! A world predicts every column of a result at once, so a cause that one column excludes is never named for another.

use super::given::Given;
use crate::import::SampledState;
use crate::measure::fields::{ExactFields, SamplePlaces};
use oedometer_exact::{ColumnParameters, Reference, ReferenceKind, ShelfProblem};
use oedometer_soil::layers::{SoilLayer, SoilLayers};

/// Time factors after which nothing changes.
const LAST: f64 = 40.0;
/// [`LAST`] of solutions that are computed step by step.
const LAST_STEPPED: f64 = 5.0;
/// Time factor before which nothing has drained that samples show.
const FIRST: f64 = 1e-9;
/// [`FIRST`] of solutions that are computed step by step.
const FIRST_STEPPED: f64 = 1e-8;

/// Share of the height at which nothing of a drained surface is seen at the start.
const JUST_BELOW: f64 = 1e-9;

/// Places in [0, 1] and weights of Gauss' rule of six points.
const GAUSS: [(f64, f64); 6] = [
    (0.033_765_242_898_423_97, 0.085_662_246_189_585_17),
    (0.169_395_306_766_867_76, 0.180_380_786_524_069_3),
    (0.380_690_406_958_401_56, 0.233_956_967_286_345_53),
    (0.619_309_593_041_598_4, 0.233_956_967_286_345_53),
    (0.830_604_693_233_132_2, 0.180_380_786_524_069_3),
    (0.966_234_757_101_576, 0.085_662_246_189_585_17),
];

/// Fields at all samples of all states, one after the other, and the settlement of each state.
#[derive(Clone, Debug, Default)]
pub struct Predicted {
    pressure: Vec<f64>,
    effective_stress: Vec<f64>,
    up: Vec<f64>,
    along: Vec<f64>,
    settlement: Vec<f64>,
}

impl Predicted {
    /// The values of a field.
    pub fn field(&self, field: super::given::Field) -> &[f64] {
        use super::given::Field;
        match field {
            Field::Pressure => &self.pressure,
            Field::EffectiveStress => &self.effective_stress,
            Field::Up => &self.up,
            Field::Along => &self.along,
            Field::Settlement => &self.settlement,
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

/// Which terms couple skeleton and water.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coupling {
    /// Both.
    Whole,
    /// The pressure is missing from the momentum balance: the skeleton carries the load at once.
    WithoutPressure,
}

/// One changed input or reading.
#[derive(Clone, Debug)]
pub struct World {
    pub kind: ReferenceKind,
    pub parameters: ColumnParameters,
    /// Factor of the times, and what is added to them, s.
    pub clock: [f64; 2],
    pub ends: Ends,
    pub coupling: Coupling,
    /// Factor of the pressure, where a problem has another start.
    pub pressure: f64,
    /// Factor of all fields, of another load at small strain.
    pub load: f64,
    /// How a sentence goes on after "the exact one".
    pub said: String,
    /// The questions to ask.
    pub asked: Vec<String>,
    /// How long the load rises, s, in place of being there at once.
    pub ramp: f64,
    /// Number of single mistakes in it.
    pub count: usize,
    /// Whether a number of it was fitted.
    pub is_fitted: bool,
}

impl World {
    /// The scene as it is.
    pub fn own(given: &Given<'_>) -> Self {
        Self {
            kind: given.kind,
            parameters: *given.parameters,
            clock: [1.0, 0.0],
            ends: Ends::Own,
            coupling: Coupling::Whole,
            pressure: 1.0,
            load: 1.0,
            ramp: 0.0,
            said: String::new(),
            asked: Vec::new(),
            count: 0,
            is_fitted: false,
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

    /// Whether the times mean what a diffusion makes of them.
    pub fn is_slow(&self) -> bool {
        use ReferenceKind::{AtRest, DynamicColumn, DynamicSingleMode, Footing, SealedElement, StandingWave};
        let still = [AtRest, SealedElement, Footing];
        let waves = [DynamicColumn, DynamicSingleMode, StandingWave];
        !(self.kind.is_manufactured() || still.contains(&self.kind) || waves.contains(&self.kind))
    }

    /// Whether a load in parts has the sum of what each part does.
    pub fn adds_up(&self) -> bool {
        use ReferenceKind::{CosineLayer, CosineLayerIncompressible, Layered, Mandel, Shelf, Terzaghi};
        use ShelfProblem::{Barron, BarronFreeStrain, BiotColumn, Cryer};
        matches!(
            self.kind,
            Terzaghi
                | ReferenceKind::TerzaghiIncompressible
                | Layered
                | CosineLayer
                | CosineLayerIncompressible
                | Mandel
                | Shelf(BiotColumn | Cryer | Barron | BarronFreeStrain)
        )
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
            ReferenceKind::LargeStrain(_) if factor > 0.0 => factor.clamp(FIRST_STEPPED, LAST_STEPPED),
            _ if self.is_slow() && factor > 0.0 => factor.clamp(FIRST.min(own), LAST.max(own)),
            _ => factor,
        }
    }

    /// The time factors of all states of a result.
    pub fn time_factors(&self, given: &Given<'_>) -> Vec<f64> {
        given.states.iter().map(|state| self.time_factor(state.time)).collect()
    }

    /// The solution, ready for all states of a result at some factors of the times.
    pub fn solution(&self, given: &Given<'_>, factors: &[f64]) -> Option<Reference> {
        let at = |factor: &f64| {
            let world = Self { clock: [factor * self.clock[0], self.clock[1]], ..self.clone() };
            world.time_factors(given)
        };
        let is_timed = !self.is_slow() || matches!(self.kind, ReferenceKind::LargeStrain(_));
        let is_own = self.kind == given.kind && self.parameters == *given.parameters;
        if let Some(own) = given.solution.as_ref().filter(|_| is_own && !is_timed) {
            return Some(own.clone());
        }
        let times: Vec<f64> = factors.iter().flat_map(at).collect();
        Reference::for_lines(self.kind, &self.parameters, &times).ok()
    }

    /// What the world predicts for the samples of a result.
    pub fn predict(&self, given: &Given<'_>) -> Option<Predicted> {
        let world = self.of_half();
        let own_is_enough = self.clock == [1.0, 0.0] && matches!(self.kind, ReferenceKind::LargeStrain(_));
        let solution = if own_is_enough {
            Reference::new(world.kind, &world.parameters, &world.time_factors(given)).ok()?
        } else {
            world.solution(given, &[1.0])?
        };
        self.predict_by(&solution, given)
    }

    /// As [`predict`](Self::predict), by a solution that is ready.
    pub fn predict_by(&self, solution: &Reference, given: &Given<'_>) -> Option<Predicted> {
        let world = self.of_half();
        let mut all = Predicted::default();
        for state in &given.states {
            let places = Places::of(self, &world, state);
            let (fields, settlement) = self.under_its_load(&world, solution, state.time, &places)?;
            let loaded = |value: &f64| self.load * value;
            all.pressure.extend(fields.pressure.iter().map(|p| self.pressure * loaded(p)));
            all.effective_stress.extend(fields.effective_stress.iter().map(loaded));
            all.up.extend(fields.displacement.iter().map(loaded));
            all.along.extend(fields.horizontal_displacement.iter().map(loaded));
            let halves = if self.ends == Ends::BothDrained { 2.0 } else { 1.0 };
            all.settlement.push(halves * loaded(&settlement));
        }
        Some(all)
    }

    /// The fields and the settlement of a state, at once or as the sum of what each part of a rising load does.
    fn under_its_load(
        &self,
        half: &Self,
        solution: &Reference,
        seconds: f64,
        places: &Places,
    ) -> Option<(ExactFields, f64)> {
        let at = |seconds: f64| {
            let time = half.time_factor(seconds);
            Some((self.fields(solution, time, places)?, solution.settlement(time).ok()?))
        };
        if self.ramp <= 0.0 {
            return at(seconds);
        }
        let mut sum: Option<(ExactFields, f64)> = None;
        // Ages of the load's parts; most happens when they are young, as the root of the age.
        let youngest = (seconds - self.ramp).max(0.0);
        for (place, weight) in GAUSS {
            let share = 2.0 * (seconds - youngest) * place * weight / self.ramp;
            let (part, settlement) = at(youngest + (seconds - youngest) * place * place)?;
            let (fields, so_far) = sum.get_or_insert_with(|| (of_zeros(&part), 0.0));
            *so_far += share * settlement;
            for (list, part) in lists_of(fields).into_iter().zip(lists_of(&mut part.clone())) {
                list.iter_mut().zip(part).for_each(|(value, part)| *value += share * *part);
            }
        }
        sum
    }

    /// The half of a column that is drained at both ends.
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

    /// The fields of a state.
    fn fields(&self, solution: &Reference, time: f64, places: &Places) -> Option<ExactFields> {
        let at = |time: f64| ExactFields::of(solution, time, places.samples()).ok();
        let mut fields = at(time)?;
        if self.coupling == Coupling::WithoutPressure {
            let drained = at(LAST)?;
            fields = ExactFields { pressure: fields.pressure, ..drained };
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

/// Fields of 0 at as many places.
fn of_zeros(fields: &ExactFields) -> ExactFields {
    let mut zeros = fields.clone();
    lists_of(&mut zeros).into_iter().flatten().for_each(|value| *value = 0.0);
    zeros
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
    let mut changed = *parameters;
    let mut layer = SoilLayer {
        thickness: parameters.height,
        youngs_modulus: Some(parameters.soil.youngs_modulus),
        poissons_ratio: Some(parameters.soil.poissons_ratio),
        porosity: Some(parameters.soil.porosity),
        water_bulk_modulus: Some(parameters.soil.water_bulk_modulus),
        hydraulic_conductivity: Some(parameters.soil.hydraulic_conductivity),
    };
    change(&mut layer);
    changed.soil = layer.soil(&parameters.soil);
    let of_layer = |layer: &SoilLayer| {
        let soil = layer.soil(&parameters.soil);
        let mut whole = SoilLayer {
            thickness: layer.thickness,
            youngs_modulus: Some(soil.youngs_modulus),
            poissons_ratio: Some(soil.poissons_ratio),
            porosity: Some(soil.porosity),
            water_bulk_modulus: Some(soil.water_bulk_modulus),
            hydraulic_conductivity: Some(soil.hydraulic_conductivity),
        };
        change(&mut whole);
        whole
    };
    let layers: Vec<SoilLayer> = parameters.soils.iter().map(of_layer).collect();
    changed.soils = SoilLayers::from_slice(&layers).unwrap_or(parameters.soils);
    changed
}
