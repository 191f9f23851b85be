//! Every balance of the manufactured solutions, by finite differences on the current configuration through the
//! inverted motion: nothing of the arithmetic with derivatives is used, but the fields themselves.

use super::*;
use crate::manufactured::dual::Four;
use crate::manufactured::motion::Motion;
use crate::manufactured::motion_state::Inertia;
use crate::parameters::MotionParameters;
use oedometer_soil::law::Law;
use oedometer_soil::material::Material;

/// Step of the differences, m and s: of the eighth order, truncation and round-off are both below 1e-11.
const STEP: f64 = 2.5e-3;
/// Weights of the central difference of eighth order.
const WEIGHTS: [f64; 4] = [4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0];
/// Largest accepted residual; the terms are of order 1.
const RESIDUAL: f64 = 1e-11;

fn parameters(amplitudes: [f64; 3]) -> ColumnParameters {
    let [amplitude_x, amplitude_y, amplitude] = amplitudes;
    ColumnParameters {
        soil: Material {
            youngs_modulus: 1.0,
            poissons_ratio: 0.25,
            porosity: 0.6,
            grain_density: 1.0,
            water_density: 0.5,
            water_bulk_modulus: 20.0,
            hydraulic_conductivity: 0.5,
            gravity: 10.0,
            ..Material::default()
        },
        load: 0.2,
        motion: MotionParameters { amplitude_x, amplitude_y, amplitude, frequency: 0.5 * PI },
        ..ColumnParameters::default()
    }
}

fn solutions() -> Vec<Manufactured> {
    let solution = |motion, law, amplitudes| {
        Manufactured::new(ManufacturedModel { motion, law }, &parameters(amplitudes)).expect("possible")
    };
    vec![
        solution(Motion::Box, Law::LogLinear, [0.25, 0.25, 0.0]),
        solution(Motion::Box, Law::NeoHookean, [0.3, -0.2, 0.0]),
        solution(Motion::Shear, Law::NeoHookean, [0.25, -0.2, 0.0]),
        solution(Motion::Vortex, Law::NeoHookean, [0.0, 0.0, 1.5]),
    ]
}

/// Places and times without pattern, within the disc of the vortex and away from its rim.
fn samples() -> impl Iterator<Item = ([f64; 2], f64)> {
    (0..12).map(|i| {
        let share = |factor: f64| (0.5 + factor * f64::from(i)).fract();
        let (radius, angle) = (0.42 * share(0.618_033_988_7), 2.0 * PI * share(0.414_213_562_4));
        let place = [0.5 + radius * angle.cos(), 0.5 + radius * angle.sin()];
        (place, 0.1 + 1.8 * share(0.732_050_807_6))
    })
}

/// Derivative at zero.
fn derivative(function: impl Fn(f64) -> f64) -> f64 {
    let terms = WEIGHTS.iter().zip(1..).map(|(weight, i)| {
        let step = f64::from(i) * STEP;
        weight * (function(step) - function(-step))
    });
    terms.sum::<f64>() / STEP
}

struct Here<'a> {
    solution: &'a Manufactured,
    place: [f64; 2],
    time: f64,
}

impl Here<'_> {
    fn now(&self) -> State {
        self.solution.state_at(self.place, self.time)
    }

    /// State of the point that is at a position.
    fn at(&self, position: [f64; 2], time: f64) -> State {
        let (places, guesses) = ([position; PLACES], [self.place; PLACES]);
        let [material, ..] = self.solution.material_places(&places, &self.solution.moment(time), &guesses);
        self.solution.state_at(material, time)
    }

    /// Derivative along a direction of the current configuration.
    fn along(&self, direction: usize, quantity: &dyn Fn(&State) -> f64) -> f64 {
        let position = self.now().position();
        derivative(|step| {
            let mut moved = position;
            moved[direction] += step;
            quantity(&self.at(moved, self.time))
        })
    }

    /// Rate that follows the skeleton.
    fn rate(&self, quantity: &dyn Fn(&State) -> f64) -> f64 {
        derivative(|step| quantity(&self.solution.state_at(self.place, self.time + step)))
    }

    fn divergence(&self, quantity: &dyn Fn(&State) -> [f64; 2]) -> f64 {
        (0..2).map(|d| self.along(d, &|state| quantity(state)[d])).sum()
    }
}

fn everywhere(check: impl Fn(&Here<'_>)) {
    for solution in &solutions() {
        for (place, time) in samples() {
            check(&Here { solution, place, time });
        }
    }
}

fn vanishes(residual: f64, what: &str, here: &Here<'_>) {
    let model = here.solution.model;
    assert!(
        residual.abs() <= RESIDUAL,
        "{what}: {residual:e} of {model:?} at {:?}, t = {}",
        here.place,
        here.time
    );
}

#[test]
fn the_momentum_of_mixture_and_water_is_balanced() {
    everywhere(|here| {
        let (now, soil) = (here.now(), here.solution.parameters);
        let n = now.porosity();
        let [mixture, water] = now.body_forces(Inertia::Both);
        for i in 0..2 {
            let solid = soil.soil.grain_density * here.rate(&|state| state.solid_velocity()[i]);
            let of_water = soil.soil.water_density * here.rate(&|state| state.water_velocity()[i]);
            let stress = here.divergence(&|state| state.effective_stress()[i]);
            let pressure = here.along(i, &State::pressure);
            vanishes((1.0 - n) * solid + n * of_water - stress + pressure - mixture[i], "mixture", here);
            let ratio = now.volume_ratio();
            let drag =
                n * soil.soil.unit_weight_of_water() / (soil.soil.hydraulic_conductivity * ratio * ratio);
            let relative = now.water_velocity()[i] - now.solid_velocity()[i];
            vanishes(of_water + pressure + drag * relative - water[i], "water", here);
        }
    });
}

#[test]
fn balances_without_all_accelerations_have_their_own_forces() {
    everywhere(|here| {
        let (now, soil) = (here.now(), here.solution.parameters);
        let n = now.porosity();
        for i in 0..2 {
            let still =
                here.along(i, &State::pressure) - here.divergence(&|state| state.effective_stress()[i]);
            let [mixture, water] = now.body_forces(Inertia::None);
            vanishes(still - mixture[i], "mixture at rest", here);
            assert_eq!(water[i], 0.0);
            let acceleration = here.rate(&|state| state.solid_velocity()[i]);
            let density = (1.0 - n) * soil.soil.grain_density + n * soil.soil.water_density;
            let [mixture, water] = now.body_forces(Inertia::Skeleton);
            vanishes(density * acceleration + still - mixture[i], "mixture as one", here);
            vanishes(soil.soil.water_density * acceleration - water[i], "water with the skeleton", here);
        }
    });
}

#[test]
fn water_and_grains_are_conserved() {
    everywhere(|here| {
        let (now, soil) = (here.now(), here.solution.parameters);
        let flux = |state: &State| -> [f64; 2] {
            let (solid, water) = (state.solid_velocity(), state.water_velocity());
            std::array::from_fn(|d| solid[d] + state.porosity() * (water[d] - solid[d]))
        };
        let stored = now.porosity() / soil.soil.water_bulk_modulus * here.rate(&State::pressure);
        vanishes(stored + here.divergence(&flux) - now.source(), "water's volume", here);
        // Grains, at a place that stays: ∂(1 − n)/∂t + div((1 − n) v_s) = 0.
        let position = now.position();
        let local = derivative(|step| 1.0 - here.at(position, here.time + step).porosity());
        let carried = here.divergence(&|state| state.solid_velocity().map(|v| (1.0 - state.porosity()) * v));
        vanishes(local + carried, "grains", here);
    });
}

#[test]
fn velocity_and_stress_follow_from_the_motion() {
    everywhere(|here| {
        let now = here.now();
        let gradient: [[f64; 2]; 2] = std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                derivative(|step| {
                    let mut moved = here.place;
                    moved[j] += step;
                    here.solution.state_at(moved, here.time).position()[i]
                })
            })
        });
        let [[a, b], [c, d]] = gradient;
        let ratio = a * d - b * c;
        vanishes(now.volume_ratio() - ratio, "J", here);
        for i in 0..2 {
            vanishes(now.solid_velocity()[i] - here.rate(&|state| state.position()[i]), "v_s", here);
        }
        let (lame, shear) = (0.4, 0.4);
        let expected = if here.solution.model.law == Law::NeoHookean {
            let volumetric = lame * ratio.ln() - shear;
            let off = shear * (a * c + b * d) / ratio;
            [
                [(shear * (a * a + b * b) + volumetric) / ratio, off],
                [off, (shear * (c * c + d * d) + volumetric) / ratio],
            ]
        } else {
            [[2.0 * shear * a.ln() + lame * ratio.ln(), 0.0], [0.0, 2.0 * shear * d.ln() + lame * ratio.ln()]]
        };
        for (got, exact) in now.effective_stress().iter().flatten().zip(expected.iter().flatten()) {
            vanishes(got - exact, "stress", here);
        }
    });
}

#[test]
fn the_walls_stay_without_shear_and_nothing_flows_through_them() {
    for solution in &solutions() {
        for (wall, normal, tangent) in [(0.0, 0, 1), (1.0, 0, 1), (0.0, 1, 0), (1.0, 1, 0)] {
            for along in [0.0, 0.13, 0.5, 0.77] {
                let mut place = [along; 2];
                place[normal] = wall;
                let state = solution.state_at(place, 0.7);
                assert!((state.position()[normal] - wall).abs() < 1e-15);
                assert!(state.effective_stress()[normal][tangent].abs() < 1e-15);
                let relative = state.water_velocity()[normal] - state.solid_velocity()[normal];
                assert!(relative.abs() < 1e-15 && state.solid_velocity()[normal].abs() < 1e-15);
            }
        }
    }
}

/// Figures of the published forms by hand: x = X + A g sin(πX)/π at X = 1/2, ωt = 3π/8.
#[test]
fn places_and_pressures_are_those_of_the_formulas() {
    let solutions = solutions();
    let growth = (3.0 * PI / 8.0).sin().powi(2);
    let fields = solutions[0].plane_fields(0.375, [0.5, 0.25]).expect("inside");
    assert!((fields.displacement[0] - 0.25 * growth / PI).abs() < 1e-16);
    assert!((fields.displacement[1] - 0.25 * growth * 0.5_f64.sqrt() / PI).abs() < 1e-16);
    let pressure = solutions[0].plane_fields(0.375, [0.25, 0.0]).expect("inside").pressure;
    assert!((pressure - 0.2 * (0.75 * PI).sin() * 0.5_f64.sqrt()).abs() < 1e-16);
    // A quarter of the radius from the middle: turned by A g (3/4)⁴ about it.
    let turned = solutions[3].plane_fields(0.375, [0.75, 0.5]).expect("inside");
    let angle = 1.5 * growth * 0.75_f64.powi(4);
    assert!((turned.displacement[0] - 0.25 * (angle.cos() - 1.0)).abs() < 1e-15);
    assert!((turned.displacement[1] - 0.25 * angle.sin()).abs() < 1e-15);
    assert!((solutions[3].state_at([0.6, 0.7], 0.75).volume_ratio() - 1.0).abs() < 1e-14);
    assert!((solutions[0].displacement_scale().expect("a scale") - 0.25 / PI).abs() < 1e-16);
}

#[test]
fn impossible_motions_are_refused_in_a_sentence() {
    let refused = |model, parameters: &ColumnParameters| {
        Manufactured::new(model, parameters).expect_err("no solution").to_string()
    };
    let model = |motion, law| ManufacturedModel { motion, law };
    let plain = parameters([0.25, 0.25, 0.0]);
    assert!(refused(model(Motion::Shear, Law::LogLinear), &plain).contains("not known in closed form"));
    assert!(refused(model(Motion::Box, Law::Linear), &plain).contains("not known in closed form"));
    // J = (1 − 0.5)² = 0.25 < 1 − n_0 = 0.4
    let wide = parameters([0.5, 0.5, 0.0]);
    assert!(
        refused(ManufacturedModel::with_default_law(Motion::Box), &wide).contains("would close the pores")
    );
    let still = ColumnParameters { motion: MotionParameters::default(), ..plain };
    assert!(refused(ManufacturedModel::with_default_law(Motion::Box), &still).contains("frequency"));
    let sound = &solutions()[0];
    assert!(sound.fields(-1.0, 0.5).is_err() && sound.fields(0.1, 1.5).is_err());
    assert!(sound.plane_fields(0.1, [f64::NAN, 0.5]).is_err());
}

#[test]
fn four_places_have_the_bits_of_each_alone() {
    // In the disc, outside it and at its rim.
    let places = [[0.5, 0.62], [0.03, 0.98], [0.21, 0.4], [0.71, 0.111]];
    for solution in solutions() {
        let motion = solution.model;
        let moment = solution.moment(0.55);
        let together = solution.states_at(&Spots::new(&places.map(Spot::new)), &moment);
        let [forces, source] = [together.body_forces(Inertia::Both).concat(), vec![together.source()]];
        let guesses = places.map(|[x, y]| [x + 0.01, y - 0.02]);
        let material = solution.material_places(&places, &moment, &guesses);
        for (lane, place) in places.into_iter().enumerate() {
            let alone = solution.state_at(place, 0.55);
            let lane_values =
                |fours: &[Four]| -> Vec<f64> { fours.iter().map(|four| four.0[lane]).collect() };
            assert_eq!(
                lane_values(&forces),
                alone.body_forces(Inertia::Both).concat(),
                "{motion:?}, {place:?}"
            );
            assert_eq!(lane_values(&source), [alone.source()], "{motion:?}, {place:?}");
            assert_eq!(
                material[lane],
                solution.material_places(&[place; PLACES], &moment, &[guesses[lane]; PLACES])[0],
                "{motion:?}, {place:?}"
            );
            if motion.motion == Motion::Vortex {
                let is_inside = (place[0] - 0.5).hypot(place[1] - 0.5) < 0.5;
                assert_eq!(alone.position() != place, is_inside, "{place:?}");
            }
            let back = solution.state_at(material[lane], 0.55).position();
            assert!((back[0] - place[0]).abs() + (back[1] - place[1]).abs() < 1e-13, "{motion:?}, {place:?}");
        }
    }
}
