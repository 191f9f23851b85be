//! Likely mistakes behind the numbers of an external result.
//!
//! An explanation is a world (one input of the solver, or the meaning of places and times, changed) with a reading of
//! each column (its unit, sign or offset). It is named only where it makes all columns agree with the exact ones that
//! did not agree before, and no column worse: so a cause that one quantity excludes is not offered for another, and a
//! solver that is merely inaccurate is told nothing.

mod clock;
mod given;
mod patterns;
mod readings;
mod world;

use crate::import::SampledState;
use crate::import::mapping::Mapping;
use crate::score::coverage::SAME_PLACE;
use given::{Column, Field, Given};
use oedometer_exact::{ColumnParameters, ExactError, Reference, ReferenceKind};
use oedometer_soil::elementary::{ln, powi};
use oedometer_soil::wording::short;
use readings::Reading;
use world::{Coupling, Ends, Predicted, World, with_soils};

/// Relative errors below this are not taken for a mistake.
const NOTICED: f64 = 2e-3;
/// Relative error that a corrected result may have.
const CORRECTED: f64 = 0.1;
/// Share of its former error that a corrected result may have.
const IMPROVED: f64 = 0.1;
/// [`IMPROVED`] where a number was fitted.
const IMPROVED_BY_FIT: f64 = 0.12;
/// Former errors from which on a coarse result may keep more of its error, how much, and what it may have left.
const COARSE: [f64; 3] = [0.1, 0.3, 0.05];
/// Exact values above this share of the load's are not zero.
const NOTABLE: f64 = 1e-3;
/// Errors up to this are equal.
const ROUND_OFF: f64 = 1e-9;
/// An error below which one explanation is no better than another.
const SETTLED: f64 = 1e-5;
/// Factor by which an explanation with one mistake more must be better.
const PENALTY: f64 = 1.2;
/// Multiple of its former error that a column may have in a world.
const WORSE: f64 = 1.5;
/// Samples of a state that are looked at where there are more than twice as many, and in the trials of a fit.
const SAMPLES: [usize; 2] = [5000, 24];
/// Difference over the final settlement from which on the top of a column is not plane.
const UNEVEN_TOP: f64 = 0.02;
/// Share of an error below which what is left of it is nothing.
const CLEAR: f64 = 1e-4;
/// Largest relative difference of one factor in several columns.
const COMMON: f64 = 0.05;
/// Share of its distance from one by which factors may differ that are the load's: pressures of 1.01 beside exact displacements
/// have a factor of their own.
const SHARED: f64 = 0.25;
/// Words of a question about one column, where the others match.
const ONLY: &str = "and only it: ";
/// A time factor before anything drains.
const EARLY: f64 = 1e-6;

/// A world with the reading of each column in it.
struct Explanation {
    world: World,
    readings: Vec<Reading>,
}

impl Explanation {
    /// The best readings in a world.
    fn of(world: World, given: &Given<'_>, with_patterns: bool) -> Option<Self> {
        let predicted = world.predict(given)?;
        Some(Self::by(world, &predicted, given, with_patterns))
    }

    fn by(world: World, predicted: &Predicted, given: &Given<'_>, with_patterns: bool) -> Self {
        let is_own = world.count == 0;
        let of = |column: &Column| readings::best(column, predicted, given, [with_patterns, is_own]);
        let readings = given.columns.iter().map(of).collect();
        Self { world, readings }
    }

    /// The largest error that is left.
    fn left(&self, given: &Given<'_>) -> f64 {
        let shown = self.readings.iter().zip(&given.columns).filter(|(_, column)| !column.shows_nothing());
        shown.map(|(reading, _)| reading.left).fold(0.0, f64::max)
    }

    fn count(&self) -> usize {
        self.world.count + self.readings.iter().map(|reading| reading.count).sum::<usize>()
    }

    /// The errors that are left, with a penalty for every mistake: of two explanations the simpler one.
    fn cost(&self, given: &Given<'_>) -> f64 {
        let shown = self.readings.iter().zip(&given.columns).filter(|(_, column)| !column.shows_nothing());
        shown.map(|(reading, _)| cost(reading.left, 0)).sum::<f64>() + cost(1.0, self.count())
    }
}

/// The logarithm of an error with a penalty for each mistake.
fn cost(left: f64, count: usize) -> f64 {
    ln((left + SETTLED) * powered(count))
}

/// The penalty of so many mistakes.
fn powered(count: usize) -> f64 {
    powi(PENALTY, i32::try_from(count).unwrap_or(i32::MAX))
}

/// Whether what is left of an error makes a correction likely.
fn convinces(before: f64, left: f64, is_fitted: bool) -> bool {
    let share = if is_fitted { IMPROVED_BY_FIT } else { IMPROVED };
    let [from, coarse_share, coarse_left] = COARSE;
    let is_clear = left <= CORRECTED.min(share * before);
    let is_coarse = before > from && left <= coarse_left && left <= coarse_share * before;
    before > NOTICED && (is_clear || is_coarse)
}

/// Sentences on what seems to be wrong with the numbers of a result, compared with a reference.
///
/// # Errors
/// When the reference refuses the result's own times.
pub fn diagnosis(
    parameters: &ColumnParameters,
    reference: ReferenceKind,
    states: &[SampledState],
    mapping: &Mapping,
) -> Result<Vec<String>, ExactError> {
    let times: Vec<f64> = states.iter().map(|state| parameters.time_factor(state.time)).collect();
    let solution = Reference::new(reference, parameters, &times)?;
    let [whole, thin] = SAMPLES.map(|most| {
        let mut given = Given::of(parameters, reference, states, mapping, most);
        given.solution = Some(solution.clone());
        let own = World::own(&given).predict_by(&solution, &given);
        if let Some(own) = &own {
            given.hold_against(own);
            let common = common_factor(&given, own).filter(|_| !reference.is_manufactured());
            given.has_common_factor =
                common.is_some_and(|(factor, spread)| spread <= SHARED * (factor - 1.0).abs());
        }
        own.map(|own| (given, own))
    });
    let (Some((mut whole, own)), Some((mut thin, own_thin))) = (whole, thin) else { return Ok(Vec::new()) };
    let mut sentences = Vec::new();
    if whole.columns.iter().any(|column| !column.shows_nothing()) {
        let base = Explanation::by(World::own(&whole), &own, &whole, true);
        let is_explained = base.left(&whole) <= CORRECTED;
        let other = other_worlds(&thin, &own_thin);
        let alone = if other.is_none() && !is_explained { of_most(&mut thin, &own_thin) } else { None };
        if let Some((_, place)) = &alone {
            whole.columns[*place].is_left_out = true;
        }
        let best = other.or(alone.map(|(best, _)| best)).unwrap_or(base);
        sentences = sentences_of(&best, &whole);
        let left_out = whole.columns.iter().filter(|column| column.is_left_out);
        sentences.extend(
            left_out.map(|column| format!("your {} does not match that: it is wrong by itself", column.name)),
        );
    }
    sentences.extend(exchanged_axes(&whole).filter(|_| sentences.is_empty()));
    sentences.extend(uneven_top(&whole, solution.is_plane()));
    Ok(sentences)
}

/// The best explanation of all columns but one, which is wrong by itself, and the place of that one; two and more must
/// agree.
fn of_most(given: &mut Given<'_>, own: &Predicted) -> Option<(Explanation, usize)> {
    let shown = |given: &Given<'_>| given.columns.iter().filter(|column| !column.shows_nothing()).count();
    if shown(given) <= 2 {
        return None;
    }
    let mut all: Vec<(Explanation, usize, f64)> = Vec::new();
    for place in 0..given.columns.len() {
        if given.columns[place].shows_nothing() {
            continue;
        }
        given.columns[place].is_left_out = true;
        all.extend(other_worlds(given, own).map(|found| {
            let left = found.left(given);
            (found, place, left)
        }));
        given.columns[place].is_left_out = false;
    }
    let best = all.into_iter().min_by(|a, b| a.2.total_cmp(&b.2));
    best.map(|(found, place, _)| (found, place))
}

/// The best explanation in another world, where one convinces more than readings alone.
fn other_worlds(given: &Given<'_>, own: &Predicted) -> Option<Explanation> {
    let base = Explanation::by(World::own(given), own, given, false);
    let raw: Vec<f64> = given
        .columns
        .iter()
        .map(|column| column.misfit_as_given(&column.exact(own).collect::<Vec<f64>>()))
        .collect();
    let worst = |explanation: &Explanation| explanation.left(given);
    let before = worst(&base);
    if !(before > NOTICED || base.count() > 1) {
        return None;
    }
    let is_accepted = |one: &Explanation| {
        let left = worst(one);
        let is_better = convinces(before, left, one.world.is_fitted);
        let is_simpler =
            one.count() < base.count() && left <= WORSE * before + ROUND_OFF && before <= CORRECTED;
        let spoils = (one.readings.iter().zip(&raw).zip(&given.columns)).any(|((reading, raw), column)| {
            !column.shows_nothing() && reading.is_plain() && reading.left > NOTICED.max(WORSE * raw)
        });
        (is_better || is_simpler) && !spoils
    };
    let limit = base.cost(given);
    let mut best: Option<Explanation> = None;
    for stage in STAGES {
        let explanations =
            worlds(given, stage).into_iter().filter_map(|world| Explanation::of(world, given, false));
        let better = explanations.filter(|one| is_accepted(one) && one.cost(given) < limit);
        best = best.into_iter().chain(better).min_by(|a, b| a.cost(given).total_cmp(&b.cost(given)));
        // A name that leaves next to nothing, or a factor of the time that all columns have: nothing more is needed. Times
        // that are late may be a ramp.
        let is_enough = |best: &Explanation| {
            let is_late = stage == Stage::Clock && best.world.clock[1] < 0.0;
            let is_common = stage != Stage::Named && !is_late && best.readings.iter().all(Reading::is_plain);
            is_common || (stage == Stage::Named && worst(best) <= CLEAR * before)
        };
        if best.as_ref().is_some_and(is_enough) {
            break;
        }
    }
    best
}

/// The stages of the search, the cheap ones first.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Stage {
    /// Worlds with nothing fitted.
    Named,
    /// A fitted factor or offset of the times.
    Clock,
    /// A load that rises over a fitted time.
    Ramp,
    /// A fitted stiffness.
    Stiffness,
    /// A fitted factor of the times of a result that is upside down.
    Turned,
}

const STAGES: [Stage; 5] = [Stage::Named, Stage::Clock, Stage::Ramp, Stage::Stiffness, Stage::Turned];

/// The other worlds of a stage.
fn worlds(given: &Given<'_>, stage: Stage) -> Vec<World> {
    let own = World::own(given);
    match stage {
        Stage::Named => {
            let parts = [places(given, &own), loads(given, &own), waters(given, &own), soils(given, &own)];
            parts.into_iter().flatten().chain(problems(given, &own)).collect()
        }
        Stage::Clock => clock::clocks(given, &own),
        Stage::Ramp => clock::ramp(given, &own).into_iter().collect(),
        Stage::Stiffness => clock::stiffness(given, &own).into_iter().collect(),
        Stage::Turned => {
            let turned = places(given, &own).into_iter().filter(|world| world.ends == Ends::UpsideDown);
            turned.flat_map(|world| clock::clocks(given, &world)).collect()
        }
    }
}

/// Places that are read otherwise, and water that leaves elsewhere.
fn places(given: &Given<'_>, own: &World) -> Vec<World> {
    let at = |ends: Ends, said: &str, asked: &str| World { ends, ..own.clone().with(said, asked) };
    let mut all = Vec::new();
    let is_column = own.is_a_column();
    let turned = if is_column && !given.moves() && given.parameters.soils.is_empty() {
        "is `y` counted from the other end? Or is the base drained in place of the surface?"
    } else {
        "is `y` counted from the other end?"
    };
    let turned =
        if given.kind == ReferenceKind::Mandel { "does `x` count from the drained side?" } else { turned };
    let said = if given.kind == ReferenceKind::Mandel { " with x turned" } else { " upside down" };
    all.push(at(Ends::UpsideDown, said, turned));
    if is_column {
        let base = "is the base drained in place of the surface?";
        all.push(at(Ends::DrainedBase, " of a column that drains at its base", base));
        if given.parameters.soils.is_empty() {
            let both = "is the base drained, too?";
            all.push(at(Ends::BothDrained, " of a column that drains at both ends", both));
        }
    }
    if given.kind == ReferenceKind::Mandel {
        let asked = "are the axes exchanged? Of `mandel` x runs along the drained direction, from the middle, and y across";
        all.push(at(Ends::AxesExchanged, " with x and y exchanged", asked));
    }
    if given.kind_is_plane() {
        all.push(at(Ends::OtherSide, " with x turned", "does `x` count from the other end?"));
    }
    all
}

/// Another load: a factor with a name, or one that all columns have.
fn loads(given: &Given<'_>, own: &World) -> Vec<World> {
    let shown = given.columns.iter().filter(|column| !column.shows_nothing()).count();
    // At small strain one column alone cannot tell the load from a factor.
    let is_linear = !matches!(own.kind, ReferenceKind::LargeStrain(_) | ReferenceKind::XieLeo);
    if (shown < 2 && is_linear) || own.kind.is_manufactured() {
        return Vec::new();
    }
    let with = |factor: f64| {
        let mut world = own.clone();
        if is_linear && !own.parameters.self_weight {
            world.load = factor;
        } else {
            world.parameters.load *= factor;
        }
        let said = readings::short_factor(readings::rounded(factor));
        let asked = format!("is the load {said} × that of the scene?");
        world.with(&format!(" of {said} × the load"), asked)
    };
    let tens = [10.0, 0.1, 1e3, 1e-3, 1e6, 1e-6].into_iter().filter(|_| given.moves() && given.is_stressed());
    let few = [3.0, 4.0, 5.0].into_iter().flat_map(|factor| [factor, 1.0 / factor]).filter(|_| !is_linear);
    let named = [2.0, 0.5].into_iter().chain(few).chain(tens).map(with);
    let common = own.predict(given).and_then(|predicted| common_factor(given, &predicted));
    // A factor without a name counts twice.
    named.chain(common.map(|(factor, _)| World { is_fitted: true, count: 2, ..with(factor) })).collect()
}

/// The factor that all columns have, where stresses and displacements agree on it, and how far the furthest is from it.
fn common_factor(given: &Given<'_>, predicted: &Predicted) -> Option<(f64, f64)> {
    if !(given.moves() && given.is_stressed()) {
        return None;
    }
    let of = |column: &Column| {
        let (mut both, mut square) = (0.0, 0.0);
        for ((computed, exact), weight) in
            column.computed.iter().zip(column.exact(predicted)).zip(&column.weights)
        {
            both += weight * computed / column.scale * (exact / column.scale);
            square += weight * powi(exact / column.scale, 2);
        }
        both / square
    };
    let factors: Vec<f64> = given.columns.iter().filter(|column| !column.shows_nothing()).map(of).collect();
    let first = *factors.first()?;
    let are_one = factors.iter().all(|factor| (factor / first - 1.0).abs() <= COMMON);
    let mean = factors.iter().sum::<f64>() / factors.len() as f64;
    let spread = factors.iter().fold(0.0, |most: f64, factor| most.max((factor - mean).abs()));
    (are_one && first > 0.0).then_some((mean, spread))
}

/// Water that is incompressible, or stores where it should not.
fn waters(given: &Given<'_>, own: &World) -> Vec<World> {
    use ReferenceKind::{CosineLayer, CosineLayerIncompressible, Terzaghi, TerzaghiIncompressible};
    let stiffer = |factor: f64| {
        with_soils(&own.parameters, |layer| {
            layer.water_bulk_modulus = layer.water_bulk_modulus.map(|modulus| factor * modulus);
        })
    };
    let with = |parameters: ColumnParameters, said: &str, asked: &str| {
        World { parameters, ..own.clone() }.with(said, asked)
    };
    let porosity = given.parameters.soil.porosity;
    let mut all = vec![
        with(
            stiffer(1e9),
            " of incompressible water",
            "is the storage of the water, n/K_w, missing from the mass balance?",
        ),
        with(stiffer(porosity), " of water softer by n", "is K_w taken for K_w/n?"),
    ];
    let compressible = match own.kind {
        TerzaghiIncompressible => Some(Terzaghi),
        CosineLayerIncompressible => Some(CosineLayer),
        _ => None,
    };
    all.extend(compressible.map(|kind| {
        let asked = format!(
            "does the water of your solver store, so that `--reference {}` is the right one?",
            kind.name()
        );
        World { kind, ..own.clone() }.with(" of compressible water", asked)
    }));
    all
}

/// A stiffness that is taken for another one.
fn soils(given: &Given<'_>, own: &World) -> Vec<World> {
    if !own.is_slow() {
        return Vec::new();
    }
    let of = |(ratio, asked): (f64, &str)| {
        let (said, or) = clock::with_modulus(given, ratio);
        clock::stiffer(own, ratio).with(&said, format!("{asked}{or}"))
    };
    let mut all: Vec<World> = clock::moduli(given).into_iter().map(of).collect();
    if given.kind_is_plane() || given.kind == ReferenceKind::Mandel {
        let exchanged = with_soils(&own.parameters, |layer| {
            let (young, nu) = (layer.youngs_modulus.unwrap_or(1.0), layer.poissons_ratio.unwrap_or(0.25));
            let shear = young / (2.0 * (1.0 + nu));
            let lame = young * nu / ((1.0 + nu) * (1.0 - 2.0 * nu));
            // λ for μ and μ for λ.
            layer.youngs_modulus = Some(lame * (3.0 * shear + 2.0 * lame) / (shear + lame));
            layer.poissons_ratio = Some(shear / (2.0 * (shear + lame)));
        });
        let world = World { parameters: exchanged, ..own.clone() };
        all.push(world.with(" of another stiffness", "are λ and μ exchanged?"));
    }
    all
}

/// Another problem: nothing drains, the skeleton does not feel the pressure, the plate bends.
fn problems(given: &Given<'_>, own: &World) -> Vec<World> {
    let mut all = Vec::new();
    if !own.is_slow() {
        return all;
    }
    // Of a column at its start the pressure alone is the total stress.
    if given.moves() || given.kind == ReferenceKind::Mandel {
        for ends in [Ends::Own, Ends::Closed] {
            let still = World { clock: [0.0, 0.0], ends, ..own.clone() };
            all.push(still.with(" of the start at all times", "does nothing drain: is the surface closed?"));
        }
    }
    if given.moves() && given.has_pressure() {
        let drained = World { coupling: Coupling::WithoutPressure, ..own.clone() };
        let asked = "is the pore pressure missing from the momentum balance, so that the skeleton carries the load at once?";
        all.push(drained.with(" of a skeleton without the pressure", asked));
    }
    if given.kind == ReferenceKind::Mandel && !given.moves() {
        let slab = Reference::new(ReferenceKind::Mandel, given.parameters, &[]).ok();
        let start = slab.and_then(|slab| slab.fields(EARLY, 1.0).ok()).map(|start| start.pressure);
        all.extend(start.map(|start| {
            let kind = ReferenceKind::TerzaghiIncompressible;
            let pressure = start / given.parameters.load;
            let said = " of a slab whose load does not move to its middle";
            World { kind, pressure, ..own.clone().with(said, "is the top held plane by a rigid plate?") }
        }));
    }
    all
}

/// The sentences of an explanation, one for all columns that are read alike.
fn sentences_of(explanation: &Explanation, given: &Given<'_>) -> Vec<String> {
    let Explanation { world, readings } = explanation;
    let mut groups: Vec<(&Reading, Vec<&str>)> = Vec::new();
    for (reading, column) in readings.iter().zip(&given.columns) {
        if column.shows_nothing() || (reading.is_plain() && world.count == 0) {
            continue;
        }
        let like = |group: &&mut (&Reading, Vec<&str>)| {
            (&group.0.begin, &group.0.asked) == (&reading.begin, &reading.asked)
        };
        match groups.iter_mut().find(like) {
            Some((_, columns)) => columns.push(column.name),
            None => groups.push((reading, vec![column.name])),
        }
    }
    let mut shown = readings.iter().zip(&given.columns).filter(|(_, column)| !column.shows_nothing());
    let others_match = shown.all(|(reading, _)| reading.left <= CORRECTED);
    // What all columns share first, and its questions once.
    groups.sort_by_key(|(reading, _)| reading.count);
    let of = |(place, (reading, columns)): (usize, (&Reading, Vec<&str>))| {
        let questions = reading.asked.iter().chain(world.asked.iter().filter(|_| place == 0));
        let mut asked = questions.cloned().collect::<Vec<_>>().join(" And ");
        if !others_match {
            asked = asked.replace(ONLY, "");
        }
        let who = match columns.split_last() {
            Some((last, others)) if !others.is_empty() => {
                format!("each of your {} and {last}", others.join(", "))
            }
            _ => format!("your {}", columns.concat()),
        };
        format!("{who} {}{}: {asked}", reading.begin, world.said)
    };
    groups.into_iter().enumerate().map(of).collect()
}

/// A sentence about a slab whose pressure varies across the drained direction alone.
fn exchanged_axes(given: &Given<'_>) -> Option<String> {
    let pressure = given.columns.iter().find(|column| column.field == Field::Pressure)?;
    if given.kind != ReferenceKind::Mandel || pressure.distances.len() != pressure.computed.len() {
        return None;
    }
    let scale = pressure.computed.iter().copied().map(f64::abs).fold(0.0, f64::max);
    // The largest difference of two neighbours along one direction, at one time and one place across it.
    let largest = |across: &[f64], along: &[f64]| {
        let mut order: Vec<usize> = (0..across.len()).collect();
        let key = |place: usize| (pressure.states[place], across[place], along[place]);
        order.sort_by(|a, b| {
            let (a, b) = (key(*a), key(*b));
            a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)).then(a.2.total_cmp(&b.2))
        });
        let pairs = order.windows(2).filter(|pair| {
            let (a, b) = (key(pair[0]), key(pair[1]));
            a.0 == b.0 && a.1 == b.1
        });
        pairs.map(|pair| (pressure.computed[pair[0]] - pressure.computed[pair[1]]).abs()).fold(0.0, f64::max)
    };
    let along_x = largest(&pressure.distances, &pressure.heights);
    let along_y = largest(&pressure.heights, &pressure.distances);
    (along_x <= ROUND_OFF * scale && along_y > NOTABLE * scale).then(|| {
        "your p varies along y alone: are the axes exchanged? Of `mandel` x runs along the drained direction, from the \
         middle, and y across"
            .to_owned()
    })
}

/// A sentence about the top of a column that does not stay plane: samples of its highest row that settle differently.
fn uneven_top(given: &Given<'_>, is_plane: bool) -> Option<String> {
    if is_plane || given.kind == ReferenceKind::Mandel {
        return None;
    }
    let settled = given.parameters.final_settlement();
    let last = given.states.last().filter(|state| state.displacement.len() == state.initial_height.len())?;
    let highest = last.initial_height.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let is_top = |y: f64| highest - y <= SAME_PLACE * given.parameters.height;
    let top = last.initial_height.iter().zip(&last.displacement).filter(|(y, _)| is_top(**y));
    let moved = top.map(|(_, moved)| *moved);
    let [least, most] = moved
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], moved| [least.min(moved), most.max(moved)]);
    (most - least > UNEVEN_TOP * settled.abs()).then(|| {
        format!(
            "your top is not plane: at y = {} m u_y lies between {} and {} m: are the sides on rollers, and does the \
             load press evenly?",
            short(highest),
            short(least),
            short(most)
        )
    })
}

#[cfg(test)]
mod tests;
