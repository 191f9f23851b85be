//! The search: the explanation, a world with a reading of each column, that leaves least for the fewest mistakes.

use super::columns::{Column, Field, Given};
use super::fits::{self, AS_WELL};
use super::hypotheses::{CHANGES, Change, FAMILIES, Fitted};
use super::patterns;
use super::readings::{Exact, Held, Reading, accepted};
use super::world::{Ends, Predicted, World};
use oedometer_soil::elementary::ln;

/// A column with at most this residual is right, and never explained.
const RIGHT: f64 = 1e-3;
/// Share of its residual that a correction may leave; where the mesh explains it, or values are few; and at most.
const SHARE: f64 = 0.1;
const CLEAN: f64 = 0.02;
const MOST: f64 = 0.1;
const FEW: usize = 8;
/// Multiple of the residual of a right column that a correction of another may leave.
const AS_OTHERS: f64 = 30.0;
/// Share of its own residual that another column has that is right beside it, and at most.
const BESIDE: [f64; 2] = [0.1, 0.03];
/// Multiple of the limit of a column that an output may have.
const OF_OUTPUT: f64 = 3.0;
/// Multiple of its residual that a right column may have in another world, and the least that it may have.
const SPOILT: [f64; 2] = [3.0, 3e-4];
/// Multiple of its residual that a column which is not explained may have in another world.
const KEPT: f64 = 1.5;
/// Errors below it do not tell explanations apart.
pub const FLOOR: f64 = 1e-5;
/// Logarithm of how much better an explanation must be for a mistake more, and for a fitted number more.
const PER_MISTAKE: f64 = 1.1;
const PER_FIT: f64 = 0.9;
/// Mistakes of a column, its world's included; signs are free.
const MISTAKES: usize = 2;
/// Relative distance of two factors of the time that are one.
const NEAR: f64 = 0.05;
/// What is left of an error is next to nothing.
const CLEAR: f64 = 1e-3;

/// The residual that a right column may have in another world.
pub fn spoils(residual: f64) -> f64 {
    SPOILT[1].max(SPOILT[0] * residual)
}

impl Column {
    /// Whether it is right, so that nothing of it is explained.
    pub fn is_right(&self) -> bool {
        self.residual <= RIGHT
    }

    /// Whether its mesh explains what is wrong.
    pub fn is_as_good_as_its_mesh(&self) -> bool {
        self.residual <= RIGHT.max(self.mesh)
    }
}

/// What a correction of a column may leave.
pub struct Limit {
    pub of: f64,
    /// What one may leave that is as good as exact.
    pub clean: f64,
    /// Whether another column is right.
    pub is_other_right: bool,
}

impl Limit {
    pub fn of(column: &Column, given: &Given<'_>) -> Self {
        let others = given.columns.iter().filter(|other| other.name != column.name);
        let least = others.map(|other| other.residual).fold(f64::INFINITY, f64::min);
        let is_other_right = least <= RIGHT.max(BESIDE[1].min(BESIDE[0] * column.residual));
        let clean = CLEAN * column.residual;
        let is_fine = column.residual < column.mesh || column.values.len() < FEW;
        let share = if is_fine { clean } else { SHARE * column.residual };
        let right = given.columns.iter().filter(|column| column.is_right()).map(|column| column.residual);
        let most = right.reduce(f64::max).map_or(MOST, |worst| MOST.min(CLEAN.max(AS_OTHERS * worst)));
        Self { of: share.min(most), clean, is_other_right }
    }

    /// The error that a hypothesis with a factor of the file leaves, if that is little in all and at every output.
    pub fn accepts(&self, column: &Column, held: &Held, factor: f64, is_itself: bool) -> Option<f64> {
        let Held { values: held, varying } = held;
        let left = column.misfit(held, varying, factor, is_itself);
        let is_even =
            |output: usize| column.misfit_of(output, held, varying, factor, is_itself) <= OF_OUTPUT * self.of;
        (left <= self.of && column.own_outputs().into_iter().all(is_even)).then_some(left)
    }
}

/// A world with the reading of each column in it; none of one that is not explained.
pub struct Explanation {
    pub world: World,
    pub readings: Vec<Option<Reading>>,
    /// The largest error that is left of a column that was wrong.
    pub left: f64,
    mistakes: usize,
    fitted: usize,
    open: usize,
}

impl Explanation {
    fn of(world: World, given: &Given<'_>, readings: Vec<Option<Reading>>) -> Self {
        let wrong = || readings.iter().zip(&given.columns).filter(|(_, column)| !column.is_right());
        let left = wrong().filter_map(|(reading, _)| Some(reading.as_ref()?.left)).reduce(f64::max);
        let mut once: Vec<(&str, usize, usize)> =
            readings.iter().flatten().map(|reading| (&*reading.key, reading.count, reading.fitted)).collect();
        once.sort_unstable();
        once.dedup_by_key(|reading| reading.0);
        Self {
            mistakes: world.count + once.iter().map(|reading| reading.1).sum::<usize>(),
            fitted: world.fitted + once.iter().map(|reading| reading.2).sum::<usize>(),
            open: wrong().filter(|(reading, _)| reading.is_none()).count(),
            left: left.unwrap_or(1.0),
            world,
            readings,
        }
    }

    /// Its cost, without what round-off tells apart.
    fn cost(&self) -> f64 {
        (1e6 * cost(self.left, self.mistakes, self.fitted)).round()
    }

    /// Whether another one is as good, with as many mistakes.
    fn is_tied(&self, other: &Self) -> bool {
        // Of worlds that leave a column open, none is an alternative to what explains each column by itself.
        let is_as_whole = other.open == 0 || other.world.count == self.world.count;
        (other.open, other.mistakes, other.fitted) == (self.open, self.mistakes, self.fitted)
            && is_as_whole
            && other.left <= AS_WELL * self.left + FLOOR * 1e-4
    }

    /// Whether every column that was wrong is explained.
    pub fn is_closed(&self) -> bool {
        self.open == 0
    }

    /// Whether a column is wrong and not explained.
    pub fn leaves(&self, field: Field, given: &Given<'_>) -> bool {
        let mut columns = self.readings.iter().zip(&given.columns);
        columns.any(|(reading, column)| column.field == field && reading.is_none())
    }

    /// Whether nothing is left to be explained.
    fn is_enough(&self) -> bool {
        self.open == 0 && self.left <= CLEAR && self.mistakes <= 1 && self.world.clock[0] > 0.0
    }
}

fn cost(left: f64, mistakes: usize, fitted: usize) -> f64 {
    ln(left + FLOOR) + PER_MISTAKE * mistakes as f64 + PER_FIT * fitted as f64
}

/// What is found: the best explanation, and the questions of those that are as good.
pub struct Found {
    pub best: Explanation,
    pub alternatives: Vec<String>,
}

/// The best explanation of some of the samples; `whole` has all of them, for patterns. Of outputs that are only some of
/// the file the soil and the load are those of the others.
pub fn explanation(given: &Given<'_>, whole: &Given<'_>, are_all_outputs: bool) -> Option<Found> {
    let own = World::own(given);
    let mut all: Vec<Explanation> =
        judged(own.clone(), &given.own, given, Some(whole), false).into_iter().collect();
    let add = |all: &mut Vec<Explanation>, worlds: Vec<World>| {
        let of = |world: World| judged(world.clone(), &world.predict(given)?, given, None, false);
        all.extend(worlds.into_iter().filter_map(of));
        all.sort_by(|a, b| a.open.cmp(&b.open).then(a.cost().total_cmp(&b.cost())));
    };
    let is_enough = |all: &[Explanation]| all.first().is_some_and(Explanation::is_enough);
    let family = |kinds: &[Fitted], base: &World, in_units: bool| -> Vec<World> {
        let of = FAMILIES.iter().filter(|family| kinds.contains(&family.kind));
        of.flat_map(|family| fits::worlds(family, given, base, in_units)).collect()
    };
    if are_all_outputs {
        let changes = CHANGES.iter().filter(|change| (change.is_possible)(given, &own));
        add(&mut all, changes.map(|change| changed(change, given, &own)).collect());
        add(&mut all, family(&[Fitted::Load], &own, false));
    }
    if !is_enough(&all) {
        add(&mut all, family(&[Fitted::Clock], &own, false));
    }
    if all.first().is_none_or(|best| best.open > 0 || best.mistakes > 1) {
        add(&mut all, family(&[Fitted::Clock], &own, true));
    }
    if !is_enough(&all) && are_all_outputs {
        add(&mut all, family(&[Fitted::Stiffness], &own, false));
        add(&mut all, family(&[Fitted::Moment, Fitted::Ramp], &own, true));
    }
    // A reading of other times is looked for last: it asks for the exact fields many times.
    if !is_enough(&all) {
        let slow = judged(own.clone(), &given.own, given, Some(whole), true);
        all.retain(|candidate| candidate.world.count > 0);
        all.splice(0..0, slow);
        add(&mut all, Vec::new());
    }
    if are_all_outputs && all.first().is_none_or(|best| best.open > 0) {
        let turned = CHANGES.iter().map(|change| changed(change, given, &own));
        let turned = turned.filter(|world| world.ends == Ends::UpsideDown && world.clock == [1.0, 0.0]);
        let both = turned.take(1).flat_map(|world| family(&[Fitted::Clock], &world, true)).collect();
        add(&mut all, both);
    }
    let mut all = all.into_iter();
    let best = all.next()?;
    if best.open == given.columns.iter().filter(|column| !column.is_right()).count() {
        return None;
    }
    // Two minima of one clock are no alternatives.
    let [at, _] = best.world.clock;
    let is_near = |clock: f64| at != 1.0 && (clock / at - 1.0).abs() < NEAR;
    let ties = all.filter(|other| best.is_tied(other) && !is_near(other.world.clock[0]));
    let mut alternatives: Vec<String> = Vec::new();
    for asked in ties.map(|other| asked_of(&other)) {
        if !asked.is_empty() && asked != asked_of(&best) && !alternatives.contains(&asked) {
            alternatives.push(asked);
        }
    }
    alternatives.truncate(2);
    Some(Found { best, alternatives })
}

/// What an explanation asks of all columns; of the scene's own world, of the readings.
fn asked_of(explanation: &Explanation) -> String {
    if explanation.world.count > 0 {
        return explanation.world.asked.join(" And ");
    }
    let mut asked: Vec<&str> = explanation
        .readings
        .iter()
        .flatten()
        .flat_map(|reading| &reading.asked)
        .map(|asked| &**asked)
        .collect();
    asked.dedup();
    asked.join(" And ")
}

fn changed(change: &Change, given: &Given<'_>, own: &World) -> World {
    (change.of)(given, own.clone()).with(change.said, change.asked)
}

/// The best readings in a world; `None` where it spoils a column that is right, or explains too little.
fn judged(
    world: World,
    predicted: &Predicted,
    given: &Given<'_>,
    whole: Option<&Given<'_>>,
    is_slow_wanted: bool,
) -> Option<Explanation> {
    let is_own = world.count == 0;
    let mut readings: Vec<Vec<Reading>> = Vec::new();
    let mut kept = 0;
    for column in &given.columns {
        let own = column.exact(predicted);
        if column.is_right() {
            let here = column.own_residual(&own);
            if !is_own && here > spoils(column.residual) {
                return None;
            }
            readings.push(vec![Reading::plain(here)]);
            continue;
        }
        let limit = Limit::of(column, given);
        let plain = if is_own { None } else { limit.accepts(column, &Held::itself(&own), 1.0, true) };
        if let Some(left) = plain {
            readings.push(vec![Reading::plain(left)]);
            continue;
        }
        let misfit = column.misfit(&own, &own, 1.0, true);
        kept += usize::from(column.residual <= MOST && misfit <= KEPT * column.residual);
        // A displacement that has a factor of its own, and a stiffness, cancel.
        let is_stiff = world.parameters.soil.youngs_modulus != given.parameters.soil.youngs_modulus;
        if column.is_zero() || (is_stiff && !column.field.is_stress()) {
            readings.push(Vec::new());
            continue;
        }
        let x = Exact { given, world: &world, predicted, column, own };
        let mut all = accepted(&x, &limit, is_own, is_slow_wanted);
        all.retain(|reading| world.count + reading.count - reading.signs <= MISTAKES);
        if let Some(whole) = whole {
            all.extend(patterns::of(column.field, whole, &limit, all.is_empty()));
        }
        readings.push(all);
    }
    let open = readings.iter().filter(|all| all.is_empty()).count();
    let plain = readings
        .iter()
        .zip(&given.columns)
        .filter(|(all, column)| !column.is_right() && all.first().is_some_and(|reading| reading.count == 0));
    let plain = plain.count();
    if !is_own && open > 0 && !(plain > 0 && kept == open) && (plain < 2 || open > 1) {
        return None;
    }
    let chosen: Vec<Option<Reading>> = (0..readings.len()).map(|place| chosen(&readings, place)).collect();
    Some(Explanation::of(world, given, chosen))
}

/// The best of the readings of a column, with the questions of others that are as good. What another column has too
/// counts half, since both are one mistake.
fn chosen(all: &[Vec<Reading>], place: usize) -> Option<Reading> {
    let is_shared = |reading: &Reading| {
        let others = all.iter().enumerate().filter(|(other, _)| *other != place);
        others.flat_map(|(_, readings)| readings).any(|other| other.key == reading.key)
    };
    let cost_of = |reading: &Reading| {
        let weight = if is_shared(reading) { 0.5 } else { 1.0 };
        ln(reading.left + FLOOR) + weight * (cost(1.0, reading.count, reading.fitted) - cost(1.0, 0, 0))
    };
    let mut best = all[place].iter().min_by(|a, b| cost_of(a).total_cmp(&cost_of(b)))?.clone();
    let is_tied = |other: &&Reading| {
        (other.count, other.fitted) == (best.count, best.fitted)
            && is_shared(other) == is_shared(&best)
            && other.asked != best.asked
            && other.left <= AS_WELL * best.left + FLOOR * 1e-4
    };
    let others: Vec<String> =
        all[place].iter().filter(is_tied).take(2).map(|other| other.asked.join(" And ")).collect();
    if !others.is_empty() {
        best.asked = vec![format!("{} Or {}", best.asked.join(" And "), others.join(" Or "))];
    }
    Some(best)
}
