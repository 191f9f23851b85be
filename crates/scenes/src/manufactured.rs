//! Motions of a square that are written down, and made by body forces and a source of water: large strain in the
//! plane against exact fields. Points cross cells in both directions and come back.

#![expect(clippy::inline_always, reason = "formulas run in registers of four only where they are inlined")]

use crate::column::{Column, Shape, column_parameters};
use crate::scene::{Allowed, Body, Check, Clock, Laws, Question, Scene};
use oedometer_exact::exact_error::ExactError;
use oedometer_exact::manufactured::Manufactured;
use oedometer_exact::manufactured::dual::{Four, PLACES};
use oedometer_exact::manufactured::motion::ManufacturedModel;
use oedometer_exact::manufactured::motion::{Spot, Spots};
use oedometer_exact::manufactured::motion_state::Inertia;
use oedometer_problem::forcing::{BodyForces, Forcing};
use oedometer_problem::formulation::Formulation;
use oedometer_problem::integrator::IntegratorKind;
use oedometer_problem::problem::{MakeForcing, Strain};
use oedometer_problem::settings::{Drag, ExplicitSettings, Scheme};
use oedometer_soil::material::Material;
use oedometer_soil::motion::MotionParameters;
use oedometer_soil::wide::wide;
use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

/// What the motions have in common: at the start there is no displacement, pressure or velocity.
pub(crate) const OF_ALL: Scene = Scene {
    question: Question::MovingPoints,
    body: Body::Square,
    strain: Strain::Large,
    waves: true,
    laws: Laws::AlongMotion,
    // Of second order in the step, for a smooth motion is compared with exact fields.
    settings: || ExplicitSettings {
        scheme: Scheme::Leapfrog,
        drag: Drag::Centred,
        ..ExplicitSettings::default()
    },
    integrators: Allowed {
        list: &[IntegratorKind::Explicit, IntegratorKind::Implicit],
        why: "body forces and source of a manufactured solution act at the stages of explicit and implicit \
              steps, but a semi-implicit step uses stress and pressure at different times",
        instead: "use `integrator = [\"explicit\"]`, or leave the key out",
    },
    clock: Clock::Motion,
    outputs: |_, _| vec![0.1, 0.2, 0.3, 0.4],
    unjudged: &[
        (Check::Unbalanced, "the body forces that make the motion start suddenly"),
        (Check::Equilibrium, "a motion caused by body forces does not balance a load"),
        (Check::Pressure, "body forces cause the pressure"),
    ],
    ..Scene::COLUMN
};

/// A soil whose groups are of order one: `λ = μ = 0.4`, `K_w = 20 E`, `γ_w/k_0 = 10`, and so many pores that volumes
/// may halve.
pub(crate) fn soil() -> Material {
    Material {
        youngs_modulus: 1.0,
        poissons_ratio: 0.25,
        porosity: 0.6,
        grain_density: 1.0,
        water_density: 0.5,
        water_bulk_modulus: 20.0,
        hydraulic_conductivity: 0.5,
        gravity: 10.0,
        ..Material::default()
    }
}

/// The unit square with the amplitudes of a motion: of the stretches along x and y, and of a vortex.
pub(crate) fn square([amplitude_x, amplitude_y, amplitude]: [f64; 3]) -> Column {
    let motion = MotionParameters { amplitude_x, amplitude_y, amplitude, frequency: FRAC_PI_2 };
    Column { shape: Shape::Square { motion, pressure: 0.2 }, dimensions: 2, load: 0.0, ..Column::default() }
}

/// The exact solution, as it acts on a body whose points are known.
#[derive(Clone, Debug)]
struct MadeMotion {
    solution: Manufactured,
    /// Functions of the points' initial places in the formulas, `[point]`.
    spots: Vec<Spot>,
}

/// Body forces and sources of a prescribed motion, for a square and its soil.
///
/// # Errors
/// When the parameters are impossible.
pub(crate) fn forcing(
    model: ManufacturedModel,
    square: &Column,
    soil: &Material,
) -> Result<MakeForcing, ExactError> {
    let model = ManufacturedModel { law: soil.law, ..model };
    let solution = Manufactured::new(model, &column_parameters(square, soil))?;
    Ok(Arc::new(move |places| {
        let spots = places.iter().map(|place| Spot::new(*place)).collect();
        Arc::new(MadeMotion { solution, spots })
    }))
}

impl MadeMotion {
    /// Functions of a place in the formulas: those kept of the point of this number, where the place is that point's.
    #[inline(always)]
    fn spot(&self, number: usize, place: [f64; 2]) -> Spot {
        match self.spots.get(number) {
            Some(spot) if spot.place == place => *spot,
            _ => Spot::new(place),
        }
    }

    /// The same of the places of four sites.
    #[inline(always)]
    fn spots_of(&self, places: &[[f64; 2]], sites: &[usize; PLACES]) -> Spots {
        let spot = |site: usize| self.spot(site, places[site]);
        Spots::new(&[spot(sites[0]), spot(sites[1]), spot(sites[2]), spot(sites[3])])
    }
}

/// Takes sites four at a time; the last of them stand in for those that there are not.
#[inline(always)]
fn by_fours(sites: &mut dyn Iterator<Item = usize>, mut take: impl FnMut(&[usize; PLACES], usize)) {
    while let Some(first) = sites.next() {
        let (mut four, mut count) = ([first; PLACES], 1);
        while count < PLACES
            && let Some(site) = sites.next()
        {
            four[count..].fill(site);
            count += 1;
        }
        take(&four, count);
    }
}

/// Accelerations that the balances of a formulation keep.
fn inertia_of(formulation: Formulation) -> Inertia {
    match formulation {
        Formulation::QuasiStatic => Inertia::None,
        Formulation::UP => Inertia::Skeleton,
        Formulation::VW => Inertia::Both,
    }
}

impl Forcing<2> for MadeMotion {
    fn body_forces(
        &self,
        formulation: Formulation,
        places: &[[f64; 2]],
        time: f64,
        forces: &mut [BodyForces<2>],
    ) {
        let (moment, inertia) = (self.solution.moment(time), inertia_of(formulation));
        wide!(by_fours(
            &mut (0..places.len()),
            #[inline(always)]
            |sites, count| {
                let states = self.solution.states_at(&self.spots_of(places, sites), &moment);
                let [mixture, water] = states.body_forces(inertia);
                for place in 0..count {
                    let at = |force: [Four; 2]| [force[0].0[place], force[1].0[place]];
                    forces[sites[place]] = [at(mixture), at(water)];
                }
            }
        ));
    }

    fn sources(
        &self,
        places: &[[f64; 2]],
        sites: &mut dyn Iterator<Item = usize>,
        time: f64,
        sources: &mut [f64],
    ) {
        let moment = self.solution.moment(time);
        wide!(by_fours(
            sites,
            #[inline(always)]
            |sites, count| {
                let states = self.solution.states_at(&self.spots_of(places, sites), &moment);
                let of_each = states.source();
                for place in 0..count {
                    sources[sites[place]] = of_each.0[place];
                }
            }
        ));
    }

    fn material_places(
        &self,
        present: &dyn Fn(usize) -> [f64; 2],
        sites: &mut dyn Iterator<Item = usize>,
        time: f64,
        places: &mut [[f64; 2]],
    ) {
        let moment = self.solution.moment(time);
        wide!(by_fours(
            sites,
            #[inline(always)]
            |sites, count| {
                let guesses = sites.map(|site| places[site]);
                let there = sites.map(present);
                let material = self.solution.material_places(&there, &moment, &guesses);
                for place in 0..count {
                    places[sites[place]] = material[place];
                }
            }
        ));
    }
}
