//! Exact results with one change, on scenes and soils of all kinds: each is named, and nothing that the data exclude.

#![expect(
    clippy::items_after_statements,
    clippy::needless_for_each,
    clippy::semicolon_if_nothing_returned,
    clippy::too_many_lines,
    clippy::type_complexity,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "one table of all changes, each a closure"
)]

use super::super::world::World;
use super::super::*;
use crate::import::mapping::Mapping;
use crate::import::mapping::preset::{CONVENTION, PLANE_CONVENTION};
use crate::measure::fields::{ExactFields, SamplePlaces};
use crate::study::file::StudySource;
use oedometer_exact::Reference;
use oedometer_soil::layers::{SoilLayer, SoilLayers};
use oedometer_soil::material::Material;

/// A problem with a soil of its own.
#[derive(Clone)]
struct Scene {
    kind: ReferenceKind,
    parameters: ColumnParameters,
    times: &'static [f64],
}

/// Scenes whose lengths, loads and soils all differ.
fn scenes() -> Vec<Scene> {
    let soil = |young: f64, nu: f64, n: f64, k: f64| Material {
        youngs_modulus: young,
        poissons_ratio: nu,
        porosity: n,
        hydraulic_conductivity: k,
        ..Material::default()
    };
    let column = |height: f64, length: f64, load: f64, soil: Material| ColumnParameters {
        height,
        length,
        load,
        soil,
        ..ColumnParameters::default()
    };
    let layer = |thickness: f64, young: f64, nu: f64, n: f64, water: f64, k: f64| SoilLayer {
        thickness,
        youngs_modulus: Some(young),
        poissons_ratio: Some(nu),
        porosity: Some(n),
        water_bulk_modulus: Some(water),
        hydraulic_conductivity: Some(k),
    };
    let layers = [
        layer(0.8, 2e6, 0.3, 0.35, 2.2e9, 3e-8),
        layer(1.5, 6e6, 0.2, 0.45, 1.1e9, 1e-7),
        layer(0.7, 1e6, 0.35, 0.4, 4e8, 2e-8),
    ];
    let soils = SoilLayers::from_slice(&layers).expect("three are few");
    let layered = ColumnParameters { soils, ..column(3.0, 1.0, 4e4, soil(2e6, 0.3, 0.35, 3e-8)) };
    let of = |kind, parameters, times| Scene { kind, parameters, times };
    use ReferenceKind::{CosineLayer, Layered, Mandel, Terzaghi, TerzaghiIncompressible, XieLeo};
    vec![
        of(Terzaghi, column(4.0, 1.0, 5e4, soil(3e6, 0.3, 0.45, 2e-8)), &[0.05, 0.1, 0.2, 0.5]),
        of(TerzaghiIncompressible, column(0.5, 1.0, 2e4, soil(8e5, 0.2, 0.38, 1e-6)), &[0.1, 0.4]),
        of(XieLeo, column(2.0, 1.0, 8e4, soil(5e5, 0.3, 0.6, 1e-8)), &[0.05, 0.15, 0.4]),
        of(Layered, layered, &[0.1, 0.2, 0.5]),
        of(CosineLayer, column(1.5, 4.0, 2e4, soil(1.5e6, 0.35, 0.42, 5e-8)), &[0.05, 0.2]),
        of(Mandel, column(2.0, 0.7, 3e4, soil(2.5e6, 0.2, 0.33, 4e-8)), &[0.02, 0.1, 0.3]),
    ]
}

impl Scene {
    fn is_plane(&self) -> bool {
        self.kind == ReferenceKind::CosineLayer
    }

    /// Rows of cells: fewer where a solution takes long.
    fn rows(&self) -> u32 {
        if self.is_plane() || self.kind == ReferenceKind::Layered { 10 } else { 20 }
    }

    fn is_column(&self) -> bool {
        !self.is_plane() && self.kind != ReferenceKind::Mandel
    }

    /// The times of the outputs, s, of the scene as it is.
    fn seconds(&self) -> Vec<f64> {
        self.times.iter().map(|time| self.parameters.time(*time)).collect()
    }

    /// What a solver writes that solves with other parameters, at `clock(t)` in place of `t`.
    fn solved(&self, parameters: &ColumnParameters, clock: &dyn Fn(f64) -> f64) -> Vec<SampledState> {
        self.solved_as(self.kind, parameters, clock)
    }

    fn solved_as(
        &self,
        kind: ReferenceKind,
        parameters: &ColumnParameters,
        clock: &dyn Fn(f64) -> f64,
    ) -> Vec<SampledState> {
        let (height, length) = (self.parameters.height, self.parameters.length);
        let has_x = self.is_plane() || self.kind == ReferenceKind::Mandel;
        let along: Vec<f64> =
            if has_x { (0..=4).map(|i| length * f64::from(i) / 4.0).collect() } else { vec![0.0] };
        let rows = self.rows();
        let of = |seconds: &f64| {
            let time = parameters.time_factor(clock(*seconds)).min(400.0);
            let reference = Reference::new(kind, parameters, &[time]).expect("possible");
            let places = (0..=rows)
                .flat_map(|j| along.iter().map(move |x| (*x, height * f64::from(j) / f64::from(rows))));
            let (x, y): (Vec<f64>, Vec<f64>) = places.unzip();
            let places = SamplePlaces {
                height: parameters.height,
                heights: &y,
                distances: if has_x { &x } else { &[] },
            };
            let fields = ExactFields::of(&reference, time, places).expect("inside");
            SampledState {
                time: *seconds,
                volume: vec![1.0; y.len()],
                pressure: fields.pressure,
                displacement: fields.displacement,
                initial_height: y,
                initial_distance: if has_x { x } else { Vec::new() },
                ..SampledState::default()
            }
        };
        self.seconds().iter().map(of).collect()
    }

    fn own(&self) -> Vec<SampledState> {
        self.solved(&self.parameters, &|time| time)
    }

    fn told(&self, states: &[SampledState]) -> Vec<String> {
        let text = if self.is_plane() { PLANE_CONVENTION } else { CONVENTION }.to_owned();
        let mapping = Mapping::read(&StudySource { name: "map.toml".to_owned(), text }).expect("a mapping");
        diagnosis(&self.parameters, self.kind, states, &mapping)
    }
}

/// A change of an exact result.
struct Change {
    name: String,
    /// What it makes of a scene; none where a scene has no such thing.
    of: Box<dyn Fn(&Scene) -> Option<Vec<SampledState>>>,
    /// Words that must be told, each with its alternatives.
    words: Vec<&'static str>,
    /// Kinds of causes that may be offered, by pressure and displacement together, and by each alone; where no kind is
    /// named the change cannot be seen by these columns, or is not told by them.
    kinds: [&'static str; 3],
}

/// Columns of a result: pressure and displacement, and each alone.
const COLUMNS: [&str; 3] = ["pu", "p", "u"];
/// Errors of an inaccurate solver on top.
const NOISES: [f64; 2] = [5e-4, 0.03];

/// Words of a sentence that offer a cause of a kind.
const OFFERS: [(&str, &str); 30] = [
    ("E_oed", "stiffness"),
    ("is E ", "stiffness"),
    ("stiffness of each layer", "stiffness"),
    ("λ and μ", "stiffness"),
    ("is k", "clock"),
    ("are times", "clock"),
    ("another moment", "moment"),
    ("is the load", "load"),
    ("load rise", "ramp"),
    ("sign declared", "sign"),
    ("is it in ", "unit"),
    ("a head", "head"),
    ("absolute", "constant"),
    ("is a constant", "constant"),
    ("hydrostatic", "hydrostatic"),
    ("total head", "elevation"),
    ("y` counted from the other end", "end"),
    ("count from the drained side", "end"),
    ("`x` count from the other end", "side"),
    ("base drained instead", "base"),
    ("drained too", "both"),
    ("wrong array", "array"),
    ("momentum", "coupling"),
    ("mass balance, so", "coupling"),
    ("storage of the water", "storage"),
    ("checkerboard", "checkerboard"),
    ("earlier stage", "stage"),
    ("axes exchanged", "axes"),
    ("where it is written", "factor"),
    ("nothing drain", "closed"),
];

fn change(
    name: &str,
    words: &[&'static str],
    kinds: [&'static str; 3],
    of: impl Fn(&Scene) -> Option<Vec<SampledState>> + 'static,
) -> Change {
    Change { name: name.to_owned(), of: Box::new(of), words: words.to_vec(), kinds }
}

/// Every state of the scene's own result, changed.
fn written(
    name: &str,
    words: &[&'static str],
    kinds: [&'static str; 3],
    edit: impl Fn(&Scene, &mut SampledState) + 'static,
) -> Change {
    change(name, words, kinds, move |scene| {
        let mut states = scene.own();
        states.iter_mut().for_each(|state| edit(scene, state));
        Some(states)
    })
}

fn times(list: &mut [f64], factor: f64) {
    list.iter_mut().for_each(|value| *value *= factor);
}

fn changes() -> Vec<Change> {
    let weight = 9810.0;
    const CLOCK: [&str; 3] = ["clock", "clock stiffness", "clock"];
    const EDGE: [&str; 3] =
        ["clock coupling closed", "clock closed stiffness array", "clock coupling closed"];
    const P: [&str; 3] = ["head constant hydrostatic elevation", "head constant hydrostatic elevation", ""];
    let clock = |factor: f64, words: &[&'static str]| {
        let kinds = if (0.1..1e3).contains(&factor) { CLOCK } else { EDGE };
        change(&format!("k x {factor:.3e}"), words, kinds, move |scene| {
            Some(scene.solved(&scene.parameters, &|time| factor * time))
        })
    };
    let young = |factor: f64, words: &[&'static str]| {
        change(
            &format!("E x {factor}"),
            words,
            ["stiffness", "clock stiffness closed", "stiffness"],
            move |scene| {
                let own = World::own(scene.kind, &scene.parameters);
                let changed = own.with_soils(|soil| soil.youngs_modulus *= factor).parameters;
                (scene.kind != ReferenceKind::XieLeo || factor > 1.0)
                    .then(|| scene.solved(&changed, &|time| time))
            },
        )
    };
    let load = |factor: f64, words: &[&'static str]| {
        change(&format!("load x {factor}"), words, ["load", "load factor", "load factor"], move |scene| {
            let changed = ColumnParameters { load: factor * scene.parameters.load, ..scene.parameters };
            Some(scene.solved(&changed, &|time| time))
        })
    };
    let modulus = |name: &str, words: &[&'static str], ratio: fn(&Material) -> f64| {
        change(name, words, ["stiffness", "stiffness", "stiffness"], move |scene| {
            if !scene.is_column() || !scene.parameters.soils.is_empty() {
                return None;
            }
            let mut changed = scene.parameters;
            changed.soil.youngs_modulus *= ratio(&changed.soil);
            Some(scene.solved(&changed, &|time| time))
        })
    };
    let ratio = |soil: &Material| soil.youngs_modulus / soil.oedometric_modulus();
    vec![
        clock(1.03, &["1.03 × the time", "is k"]),
        clock(0.97, &["0.97 × the time", "is k"]),
        clock(5.0, &["5 × the time", "is k"]),
        clock(0.137, &["0.137 × the time", "is k"]),
        clock(9.81, &["9.81 × the time", "without g"]),
        clock(1.0 / 9.81, &["0.102 × the time", "g once too often"]),
        clock(10.0, &["10 × the time", "power of ten"]),
        clock(0.01, &["0.01 × the time", "power of ten"]),
        clock(1.0 / 60.0, &["m/min"]),
        clock(1.0 / 3600.0, &["m/hour"]),
        clock(1.0 / 86400.0, &["m/day|far too small"]),
        clock(1.0 / 9810.0, &["k/γ_w|far too small"]),
        clock(86400.0, &["has everything drained", "day|far too large"]),
        clock(9810.0, &["has everything drained", "k/γ_w|far too large"]),
        young(1.7, &["E_oed|stiffness"]),
        young(1e-3, &["power of ten|E_oed"]),
        load(2.0, &["is the load 2 ×"]),
        load(0.5, &["is the load 0.5 ×"]),
        load(3.0, &["is the load 3 ×"]),
        modulus("E for E_oed", &["is E taken for E_oed"], |soil| {
            soil.youngs_modulus / soil.oedometric_modulus()
        }),
        modulus("E_oed given as E", &["is E_oed given as E"], |soil| {
            soil.oedometric_modulus() / soil.youngs_modulus
        }),
        change(
            "λ and μ exchanged",
            &["are λ and μ exchanged"],
            ["stiffness", "stiffness", "stiffness"],
            |scene| {
                if !scene.parameters.soils.is_empty() {
                    return None;
                }
                let soil = scene.parameters.soil;
                let mu = soil.youngs_modulus / (2.0 * (1.0 + soil.poissons_ratio));
                let lambda = 2.0 * mu * soil.poissons_ratio / (1.0 - 2.0 * soil.poissons_ratio);
                let mut changed = scene.parameters;
                changed.soil.youngs_modulus = lambda * (3.0 * mu + 2.0 * lambda) / (mu + lambda);
                changed.soil.poissons_ratio = 0.5 * mu / (mu + lambda);
                Some(scene.solved(&changed, &|time| time))
            },
        ),
        change(
            "times in minutes",
            &["are times in min where s is declared"],
            ["clock", "clock stiffness", "clock"],
            |scene| {
                let mut states = scene.own();
                states.iter_mut().for_each(|state| state.time /= 60.0);
                Some(states)
            },
        ),
        change(
            "times in days",
            &["the time or more|are times in d where s is declared"],
            ["clock coupling", "clock", "clock coupling"],
            |scene| {
                let mut states = scene.own();
                states.iter_mut().for_each(|state| state.time /= 86_400.0);
                Some(states)
            },
        ),
        change(
            "times late",
            &["do your times start at another moment"],
            ["moment ramp", "moment ramp", "moment ramp"],
            |scene| {
                let late = 0.3 * scene.seconds()[0];
                Some(scene.solved(&scene.parameters, &|time| time - late))
            },
        ),
        change("a ramp of the load", &["does your load rise"], ["ramp", "ramp", "ramp"], |scene| {
            // The mean of many loads that come one after the other, up to the second time.
            let length = scene.seconds()[1];
            let count = if scene.is_plane() || scene.kind == ReferenceKind::Layered { 40 } else { 200 };
            let mut sum = scene.own();
            sum.iter_mut().for_each(|state| {
                times(&mut state.pressure, 0.0);
                times(&mut state.displacement, 0.0);
            });
            for part in 0..count {
                let begin = length * (f64::from(part) + 0.5) / f64::from(count);
                let states = scene.solved(&scene.parameters, &|time| (time - begin).max(0.0));
                for (all, one) in sum.iter_mut().zip(states).filter(|(all, _)| all.time > begin) {
                    let lists =
                        [(&mut all.pressure, one.pressure), (&mut all.displacement, one.displacement)];
                    for (all, one) in lists {
                        all.iter_mut().zip(one).for_each(|(all, one)| *all += one / f64::from(count));
                    }
                }
            }
            (scene.kind != ReferenceKind::XieLeo).then_some(sum)
        }),
        written("p as head", &["your p", "head"], P, move |_, state| {
            times(&mut state.pressure, 1.0 / weight)
        }),
        written("p absolute", &["your p", "absolute"], P, |_, state| {
            state.pressure.iter_mut().for_each(|p| *p += 101_325.0);
        }),
        written(
            "hydrostatic",
            &["your p", "the weight of the water", "hydrostatic part left in"],
            P,
            move |scene, state| {
                for (p, y) in state.pressure.iter_mut().zip(&state.initial_height) {
                    *p += weight * (scene.parameters.height - y);
                }
            },
        ),
        written(
            "hydrostatic and absolute",
            &["hydrostatic part left in", "absolute"],
            P,
            move |scene, state| {
                for (p, y) in state.pressure.iter_mut().zip(&state.initial_height) {
                    *p += weight * (scene.parameters.height - y) + 101_325.0;
                }
            },
        ),
        written("total head", &["total head"], P, move |_, state| {
            for (p, y) in state.pressure.iter_mut().zip(&state.initial_height) {
                *p = *p / weight + y;
            }
        }),
        written("p halved", &["your p is 0.5 ×", "halved"], ["factor", "factor load", ""], |_, state| {
            times(&mut state.pressure, 0.5)
        }),
        written("u doubled", &["is 2 ×", "doubled"], ["factor", "", "factor load"], |_, state| {
            times(&mut state.displacement, 2.0)
        }),
        written("p in kPa", &["your p is 0.001 ×", "kPa"], ["unit", "unit", ""], |_, state| {
            times(&mut state.pressure, 1e-3)
        }),
        written(
            "u in mm with the other sign",
            &["−1000 ×", "mm", "sign"],
            ["unit sign side", "", "unit sign side"],
            |_, state| {
                times(&mut state.displacement, -1e3);
            },
        ),
        change(
            "u with E for E_oed alone",
            &["is E taken for E_oed where displacements"],
            ["stiffness", "", "stiffness"],
            move |scene| {
                let is_plain = scene.is_column() && scene.parameters.soils.is_empty();
                let factor = 1.0 / ratio(&scene.parameters.soil);
                is_plain.then(|| {
                    let mut states = scene.own();
                    states.iter_mut().for_each(|state| times(&mut state.displacement, factor));
                    states
                })
            },
        ),
        written(
            "an array of zeros",
            &["your p is 0 everywhere", "wrong array"],
            ["array", "array clock", ""],
            |_, state| times(&mut state.pressure, 0.0),
        ),
        written(
            "a checkerboard",
            &["your p", "checkerboard"],
            ["checkerboard", "checkerboard", ""],
            |scene, state| {
                let cell = scene.parameters.height / f64::from(scene.rows());
                for (p, y) in state.pressure.iter_mut().zip(&state.initial_height) {
                    *p *= 1.0 + if ((y / cell).round() as usize).is_multiple_of(2) { 0.15 } else { -0.15 };
                }
            },
        ),
        written("an earlier stage", &["earlier stage"], ["stage", "", "stage"], |scene, state| {
            for (u, y) in state.displacement.iter_mut().zip(&state.initial_height) {
                *u -= 0.4 * scene.parameters.final_settlement() * y / scene.parameters.height;
            }
        }),
        written(
            "upside down",
            &["upside down|x turned", "counted from the other end|count from the drained side"],
            ["end", "end base", "end"],
            |scene, state| {
                state.initial_height.iter_mut().for_each(|y| *y = scene.parameters.height - *y);
            },
        ),
        change(
            "drained at the base",
            &["is the base drained instead of the surface"],
            ["base", "base end", "base"],
            |scene| {
                scene.is_column().then(|| {
                    // Of layers, the column on its head.
                    let turned: Vec<SoilLayer> = scene.parameters.soils.iter().rev().copied().collect();
                    let soils = SoilLayers::from_slice(&turned).expect("as many");
                    let mut states =
                        scene.solved(&ColumnParameters { soils, ..scene.parameters }, &|time| time);
                    for state in &mut states {
                        state.pressure.reverse();
                        let top = state.displacement.last().copied().expect("a top");
                        state.displacement.reverse();
                        state.displacement.iter_mut().for_each(|u| *u = top - *u);
                    }
                    states
                })
            },
        ),
        change("drained at both ends", &["is the base drained too"], ["both", "both", "both"], |scene| {
            (scene.is_column() && scene.parameters.soils.is_empty()).then(|| {
                let (height, half) = (scene.parameters.height, 0.5 * scene.parameters.height);
                let parameters = ColumnParameters { height: half, ..scene.parameters };
                let of = |seconds: &f64| {
                    let time = parameters.time_factor(*seconds);
                    let reference = Reference::new(scene.kind, &parameters, &[time]).expect("possible");
                    let at = |y: f64| {
                        reference.fields(time, (1.0 - (y - half).abs() / half).max(0.0)).expect("inside")
                    };
                    let top = at(height).displacement;
                    let heights: Vec<f64> = (0..=20).map(|j| height * f64::from(j) / 20.0).collect();
                    let moved = |y: &f64| {
                        if *y < half { top - at(*y).displacement } else { top + at(*y).displacement }
                    };
                    SampledState {
                        time: *seconds,
                        volume: vec![1.0; 21],
                        pressure: heights.iter().map(|y| at(*y).pressure).collect(),
                        displacement: heights.iter().map(moved).collect(),
                        initial_height: heights,
                        ..SampledState::default()
                    }
                };
                scene.seconds().iter().map(of).collect()
            })
        }),
        change(
            "p missing from momentum",
            &["missing from the momentum balance"],
            ["coupling", "", "coupling clock"],
            |scene| {
                let late = scene.solved(&scene.parameters, &|_| 20.0 * scene.parameters.time(1.0));
                let mut states = scene.own();
                for (state, late) in states.iter_mut().zip(late) {
                    state.displacement = late.displacement;
                }
                Some(states)
            },
        ),
        change(
            "nothing drains",
            &["nothing drains"],
            ["closed clock", "closed clock", "closed clock array"],
            |scene| (scene.kind != ReferenceKind::XieLeo).then(|| scene.solved(&scene.parameters, &|_| 0.0)),
        ),
        change(
            "a closed surface",
            &["nothing drains"],
            ["closed clock", "closed clock array", "closed clock array"],
            |scene| {
                (scene.is_column() && scene.parameters.soils.is_empty()).then(|| {
                    let mut states = scene.solved(&scene.parameters, &|_| 0.0);
                    for state in &mut states {
                        let inside = state.pressure[1];
                        state.pressure.iter_mut().for_each(|p| *p = inside);
                        let base = state.displacement[0];
                        let slope = (state.displacement[1] - base) / state.initial_height[1];
                        let heights = state.initial_height.iter();
                        state.displacement = heights.map(|y| base + slope * y).collect();
                    }
                    states
                })
            },
        ),
        written("p as head in cm", &["your p", "a head in cm"], P, move |_, state| {
            times(&mut state.pressure, 100.0 / weight)
        }),
        change("p of the output before", &["your p", "previous output"], ["behind", "", ""], |scene| {
            let mut states = scene.own();
            let times = scene.seconds();
            for place in (1..states.len()).rev() {
                let before = scene.solved(&scene.parameters, &|_| times[place - 1]);
                states[place].pressure.clone_from(&before[0].pressure);
            }
            let start = scene.solved(&scene.parameters, &|_| 0.0);
            states[0].pressure.clone_from(&start[0].pressure);
            Some(states)
        }),
        change("u per output", &["is it the increment"], ["increment", "", "increment"], |scene| {
            let mut states = scene.own();
            for place in (1..states.len()).rev() {
                let before = states[place - 1].displacement.clone();
                states[place].displacement.iter_mut().zip(before).for_each(|(u, before)| *u -= before);
            }
            Some(states)
        }),
        written("p in bar", &["your p", "in bar"], ["unit", "unit", ""], |_, state| {
            times(&mut state.pressure, 1e-5);
        }),
        change("x and y exchanged", &["axes exchanged"], ["axes", "axes", ""], |scene| {
            (scene.kind == ReferenceKind::Mandel).then(|| {
                let mut states = scene.own();
                for state in &mut states {
                    state.displacement.clear();
                    std::mem::swap(&mut state.initial_height, &mut state.initial_distance);
                }
                states
            })
        }),
    ]
}

/// The result as an inaccurate solver would have it: waves that no mistake looks like, of one seed a column.
fn inaccurate(states: &mut [SampledState], noise: f64, height: f64) {
    for (number, state) in states.iter_mut().enumerate() {
        for (place, y) in state.initial_height.iter().enumerate() {
            let wave = |seed: f64| 1.0 + noise * (seed * y / height + 2.3 * number as f64 + seed).sin() * 1.4;
            if let Some(p) = state.pressure.get_mut(place) {
                *p *= wave(7.0);
            }
            if let Some(u) = state.displacement.get_mut(place) {
                *u *= wave(5.0);
            }
        }
    }
}

/// What is told of a change by some of the columns; `None` where they do not show it.
fn told_of(scene: &Scene, change: &Change, columns: usize, noise: f64) -> Option<Vec<String>> {
    let mut states = (change.of)(scene)?;
    for state in &mut states {
        match COLUMNS[columns] {
            "p" => state.displacement.clear(),
            "u" => state.pressure.clear(),
            _ => {}
        }
    }
    if states.iter().all(|state| state.pressure.is_empty() && state.displacement.is_empty()) {
        return None;
    }
    inaccurate(&mut states, noise, scene.parameters.height);
    Some(scene.told(&states))
}

/// The words that are missing, and the causes that are offered beside those of the change.
fn faults_of(change: &Change, columns: usize, noise: f64, told: &[String]) -> Vec<String> {
    let all = told.join(" || ");
    let kinds: Vec<&str> = change.kinds[columns].split_whitespace().collect();
    let is_told = |word: &str| word.split('|').any(|word| all.contains(word));
    let must = !kinds.is_empty() && noise < NOISES[1];
    let missing =
        change.words.iter().filter(|word| must && !is_told(word)).map(|word| format!("missing {word}"));
    let offered = OFFERS.iter().filter(|(words, kind)| all.contains(words) && !kinds.contains(kind));
    missing.chain(offered.map(|(words, kind)| format!("offers {words} ({kind})"))).collect()
}

/// All changes by pressure and displacement, and in turn by one of them and of inaccurate results.
fn every_change_is_named_of(kind: ReferenceKind) {
    let (number, scene) =
        (scenes().into_iter().enumerate()).find(|(_, scene)| scene.kind == kind).expect("a scene");
    let others = [(1, 0.0), (0, NOISES[0]), (2, 0.0), (0, NOISES[1])];
    // Of layers, whose solution takes long, what they have of their own: soils, their order, and where water leaves.
    let of_layers = ["k x 5.000e0", "E x 1.7", "drained at the base", "nothing drains"];
    let is_whole = |change: &Change| kind != ReferenceKind::Layered || of_layers.contains(&&*change.name);
    let every_other = match kind {
        ReferenceKind::Layered => usize::MAX,
        ReferenceKind::CosineLayer => 3,
        _ => 1,
    };
    let mut wrong = Vec::new();
    for (place, change) in changes().into_iter().enumerate() {
        let turn = number + place;
        for (columns, noise) in [(0, 0.0), others[turn % 4]] {
            let is_first = (columns, noise) == (0, 0.0);
            if !(is_whole(&change) && (is_first || place.is_multiple_of(every_other))) {
                continue;
            }
            let Some(told) = told_of(&scene, &change, columns, noise) else {
                continue;
            };
            let faults = faults_of(&change, columns, noise, &told);
            if !faults.is_empty() {
                let name = COLUMNS[columns];
                wrong.push(format!("{} [{name}] {noise} {}: {faults:?}: {told:?}", scene.kind, change.name));
            }
        }
    }
    assert!(wrong.is_empty(), "{} wrong:\n{}", wrong.len(), wrong.join("\n"));
}

#[test]
fn every_change_of_a_column_is_named_and_no_cause_that_the_data_exclude() {
    every_change_is_named_of(ReferenceKind::Terzaghi);
}

#[test]
fn every_change_of_a_column_of_incompressible_water_is_named() {
    every_change_is_named_of(ReferenceKind::TerzaghiIncompressible);
}

#[test]
fn every_change_at_large_strain_is_named() {
    every_change_is_named_of(ReferenceKind::XieLeo);
}

#[test]
fn every_change_of_layers_is_named() {
    every_change_is_named_of(ReferenceKind::Layered);
}

#[test]
fn every_change_under_a_cosine_load_is_named() {
    every_change_is_named_of(ReferenceKind::CosineLayer);
}

#[test]
fn every_change_of_a_slab_is_named() {
    every_change_is_named_of(ReferenceKind::Mandel);
}
