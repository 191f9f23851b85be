//! The finishing line: where a method brings its errors below a tolerance and keeps them there, what that costs, and why it
//! does not reach the tolerance where it does not.

use crate::record::race_errors::{ARRIVED, ERRORS, LOOSEST, ROUGH, ReadOut, RunErrors, SMALLEST};
use oedometer_convergence::reached;
use oedometer_soil::elementary;

/// Other tolerances that an answer is tried at.
pub const OTHER_TOLERANCES: [f64; 3] = [SMALLEST, 2e-2, LOOSEST];
/// Share of the exact settlement below which a body locks.
const LOCKED: f64 = 0.9;
/// Order below which an error hardly falls any more.
const FLAT: f64 = 0.4;
/// By how much an error must rise with half the step to grow, and not to lie beside the tolerance.
const GROWS: f64 = 2.0;

/// What an error is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RaceQuantity {
    /// Pore pressure.
    Pressure,
    /// Effective stress.
    Stress,
    /// Displacement of the points, or the load of a footing.
    Displacement,
    /// The largest of those that exist.
    All,
}

impl RaceQuantity {
    /// Each quantity, and all together last.
    pub const EACH: [Self; ERRORS + 1] = [Self::Pressure, Self::Stress, Self::Displacement, Self::All];

    /// Its word in tables.
    pub fn name(self) -> &'static str {
        ["pressure", "stress", "displacement", "all"][self as usize]
    }
}

/// How much work a method may spend.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Budget {
    /// The mesh before that of the budget.
    Half,
    /// The last mesh of a situation but one.
    Whole,
    /// The last mesh, which also confirms the one before.
    Twice,
}

/// What is asked of a method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Terms {
    /// Where fields are read.
    pub read_out: ReadOut,
    /// What has to be accurate.
    pub quantity: RaceQuantity,
    /// The output alone, by its place; all where none is named.
    pub output: Option<usize>,
    /// How accurate.
    pub tolerance: f64,
    /// For how much work.
    pub budget: Budget,
}

impl Terms {
    /// One per cent of everything at every output, within the budget.
    pub fn usual(read_out: ReadOut) -> Self {
        let (quantity, budget) = (RaceQuantity::All, Budget::Whole);
        Self { read_out, quantity, output: None, tolerance: ARRIVED, budget }
    }

    fn error_in(&self, errors: &RunErrors) -> Option<f64> {
        let quantity = (self.quantity != RaceQuantity::All).then_some(self.quantity as usize);
        errors.largest(self.read_out, quantity, self.output)
    }
}

/// A method on one mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Level {
    /// Cells over the height.
    pub cells: usize,
    /// The rule of its steps.
    pub step: String,
    /// Counted work by the calibration, s.
    pub cost: f64,
    /// Measured seconds of the processor, if the system reports it.
    pub seconds: Option<f64>,
    /// Errors with the race's step.
    pub errors: RunErrors,
    /// Errors with half and a quarter of it, where those ran.
    pub shorter: Vec<RunErrors>,
}

impl Level {
    /// The error that is asked.
    pub fn error(&self, terms: &Terms) -> Option<f64> {
        terms.error_in(&self.errors)
    }

    fn is_within(&self, terms: &Terms) -> bool {
        let is_within = |errors| terms.error_in(errors).is_some_and(|error| error <= terms.tolerance);
        is_within(&self.errors) && self.shorter.iter().all(is_within)
    }
}

/// Where a method reaches the tolerance.
#[derive(Clone, Debug, PartialEq)]
pub struct Arrival {
    /// Cells of the coarsest mesh from which on all stay within the tolerance, by half the step too where that ran.
    pub cells: usize,
    /// Its rule of steps.
    pub step: String,
    /// Counted work to the tolerance, s: between this mesh and the one before by powers of error and work.
    pub cost: f64,
    /// Measured seconds to the same.
    pub seconds: Option<f64>,
    /// Whether a finer mesh confirms it.
    pub confirmed: bool,
}

/// Where some levels reach the tolerance on at most so many cells.
pub fn arrival(levels: &[Level], terms: &Terms, most_cells: usize) -> Option<Arrival> {
    let is_within: Vec<bool> = levels.iter().map(|level| level.is_within(terms)).collect();
    let at = reached(&is_within).filter(|at| levels[at.place].cells <= most_cells)?;
    let level = &levels[at.place];
    let before = at.place.checked_sub(1).map(|place| &levels[place]);
    let between = |cost: &dyn Fn(&Level) -> Option<f64>| {
        let fine = cost(level)?;
        let coarse = before.and_then(|before| Some((cost(before)?, before.error(terms)?)));
        let Some((coarse, error)) = coarse.filter(|(cost, error)| *cost > 0.0 && *error > terms.tolerance)
        else {
            return Some(fine);
        };
        // An error of nothing has no logarithm.
        let least = level.error(terms)?.max(f64::MIN_POSITIVE);
        let share = elementary::ln(error / terms.tolerance) / elementary::ln(error / least);
        Some(coarse * elementary::powf(fine / coarse, share))
    };
    Some(Arrival {
        cells: level.cells,
        step: level.step.clone(),
        cost: between(&|level| Some(level.cost))?,
        seconds: between(&|level| level.seconds),
        confirmed: at.confirmed,
    })
}

/// Why a method does not reach the tolerance: each measured on its finest mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reason {
    /// The meshes end while its error falls with this order.
    Budget(f64),
    /// Its error stays at this height.
    Plateau(f64),
    /// It settles far less than the soil.
    Locks,
    /// Half and a quarter of the step grow too, from errors that were small; or half the step undoes what the step reached.
    Unstable,
    /// Its error is large and does not fall, or ends the run.
    Inaccurate,
    /// The method or the program refuses the situation.
    NotApplicable,
    /// It has no record.
    NotRun,
}

impl Reason {
    /// Its word in tables.
    pub fn word(self) -> &'static str {
        match self {
            Self::Budget(_) => "budget",
            Self::Plateau(_) => "plateau",
            Self::Locks => "locks",
            Self::Unstable => "unstable",
            Self::Inaccurate => "inaccurate",
            Self::NotApplicable => "not applicable",
            Self::NotRun => "not run",
        }
    }

    /// Its word on pages, where a budget would read as cheap.
    pub fn shown(self) -> &'static str {
        match self {
            Self::Budget(_) => "too costly",
            Self::NotApplicable => "n/a",
            other => other.word(),
        }
    }

    /// The order or the height that was measured.
    pub fn value(self) -> Option<f64> {
        match self {
            Self::Budget(value) | Self::Plateau(value) => Some(value),
            _ => None,
        }
    }
}

/// Why levels do not reach the tolerance; `stiffness` is what the finest settles over what the soil does.
pub fn reason_of(levels: &[Level], terms: &Terms, stiffness: Option<f64>) -> Reason {
    let Some(finest) = levels.last() else { return Reason::NotRun };
    let Some(error) = finest.error(terms) else {
        let is_small = |errors: &RunErrors| {
            let before = errors.largest_reached(terms.read_out, None, None);
            !errors.is_whole && before.is_some_and(|error| error <= ROUGH)
        };
        let grows = finest.shorter.len() > 1 && finest.shorter.iter().chain([&finest.errors]).all(is_small);
        return if grows { Reason::Unstable } else { Reason::Inaccurate };
    };
    if stiffness.is_some_and(|stiffness| stiffness < LOCKED) {
        return Reason::Locks;
    }
    let is_undone = |level: &Level| {
        let most = GROWS * terms.tolerance;
        let is_within = level.error(terms).is_some_and(|error| error <= terms.tolerance);
        is_within
            && level.shorter.iter().any(|errors| terms.error_in(errors).is_none_or(|error| error > most))
    };
    if levels.iter().any(is_undone) {
        return Reason::Unstable;
    }
    let before = levels.len().checked_sub(2).map(|place| &levels[place]);
    let order = before.and_then(|before| {
        let finer = finest.cells as f64 / before.cells as f64;
        Some(elementary::ln(before.error(terms)? / error) / elementary::ln(finer))
    });
    match order {
        Some(order) if order >= FLAT && error <= 1.0 => Reason::Budget(order),
        Some(_) if error <= ROUGH => Reason::Plateau(error),
        _ => Reason::Inaccurate,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TERMS: Terms = Terms {
        read_out: ReadOut::Points,
        quantity: RaceQuantity::All,
        output: None,
        tolerance: 0.01,
        budget: Budget::Whole,
    };

    fn errors(error: Option<f64>) -> RunErrors {
        let at = vec![[error.map(|error| 0.5 * error), None, error]];
        RunErrors { at: [at, vec![[Some(9.0); 3]]], is_whole: error.is_some() }
    }

    /// Meshes of 4, 8, 16, 32 cells that cost 1, 8, 27, 64 s.
    fn levels(given: &[Option<f64>]) -> Vec<Level> {
        let level = |((error, cost), cells): ((&Option<f64>, f64), usize)| Level {
            cells,
            cost,
            seconds: Some(2.0 * cost),
            errors: errors(*error),
            ..Level::default()
        };
        given.iter().zip([1.0, 8.0, 27.0, 64.0]).zip([4, 8, 16, 32]).map(level).collect()
    }

    #[test]
    fn the_cost_of_a_tolerance_lies_between_two_meshes_and_only_where_finer_ones_and_shorter_steps_stay_within()
     {
        let cost = |given: &[Option<f64>], tolerance| {
            let found = arrival(&levels(given), &Terms { tolerance, ..TERMS }, 16)?;
            Some((found.cells, (1e9 * found.cost).round() / 1e9, found.confirmed))
        };
        let falling = [Some(0.1), Some(0.01), Some(0.004)];
        assert_eq!(cost(&falling, 0.2), Some((4, 1.0, true)), "the coarsest mesh is good enough");
        assert_eq!(cost(&falling, 0.01), Some((8, 8.0, true)));
        // From 0.1 at 1 s to 0.01 at 8 s: a share of log10 2 of the way.
        let half = 1e-9 * (1e9 * 8.0_f64.powf(2.0_f64.log10())).round();
        assert_eq!(cost(&falling, 0.05), Some((8, half, true)));
        assert_eq!(cost(&falling, 0.004), Some((16, 27.0, false)), "nobody confirms it");
        assert_eq!(cost(&falling, 0.003), None);
        // An accident on a coarse mesh does not count, nor a mesh that a finer one undoes or fails after.
        assert_eq!(cost(&[Some(0.001), Some(0.1), Some(0.01)], 0.01), Some((16, 27.0, false)));
        assert_eq!(cost(&[Some(0.1), Some(0.001), Some(0.02)], 0.01), None);
        assert_eq!(cost(&[Some(0.1), Some(0.001), None], 0.01), None);
        assert_eq!(
            cost(&[None, Some(0.001), Some(0.0)], 0.01),
            Some((8, 8.0, true)),
            "nothing to interpolate from"
        );
        // The budget ends before.
        assert_eq!(cost(&[Some(0.1), Some(0.1), Some(0.1), Some(0.001)], 0.01), None);
        // Half the step undoes an arrival; the next mesh counts in full.
        let mut undone = levels(&[Some(0.1), Some(0.009), Some(0.004), Some(0.002)]);
        undone[1].shorter = vec![errors(Some(0.3))];
        assert_eq!(arrival(&undone, &TERMS, 16).map(|one| (one.cells, one.cost)), Some((16, 27.0)));
        undone.truncate(2);
        assert_eq!(reason_of(&undone, &TERMS, None), Reason::Unstable);
        // Half the error of the others: the pressure reaches the tolerance earlier. There is no stress.
        let of = |quantity| arrival(&levels(&falling), &Terms { quantity, tolerance: 0.05, ..TERMS }, 16);
        assert_eq!(of(RaceQuantity::Pressure).map(|one| one.seconds), Some(Some(2.0)));
        assert_eq!(of(RaceQuantity::Stress), None);
        let centres = Terms { read_out: ReadOut::Centres, ..TERMS };
        assert_eq!(arrival(&levels(&falling), &centres, 16), None);
    }

    #[test]
    fn who_does_not_arrive_has_the_reason_that_was_measured() {
        let reason = |given: &[Option<f64>], stiffness| reason_of(&levels(given), &TERMS, stiffness);
        let order = 3.0_f64.ln() / 2.0_f64.ln();
        assert_eq!(
            reason(&[Some(0.3), Some(0.1)], Some(0.95)).value().map(|value| (value - order).abs() < 1e-12),
            Some(true)
        );
        assert_eq!(reason(&[Some(0.3), Some(0.1)], Some(0.85)), Reason::Locks);
        assert_eq!(reason(&[Some(0.03), Some(0.025)], None), Reason::Plateau(0.025));
        assert_eq!(reason(&[Some(0.3), Some(0.25)], None), Reason::Inaccurate);
        assert_eq!(reason(&[], None), Reason::NotRun);
        assert_eq!(reason(&[Some(0.3), None], None), Reason::Inaccurate, "no shorter step was tried");
        // It grows from small errors with any step; or its errors were large before it ended.
        for (before, wanted) in [(0.02, Reason::Unstable), (0.5, Reason::Inaccurate)] {
            let ended = RunErrors { is_whole: false, ..errors(Some(before)) };
            let mut grown = levels(&[Some(0.3), None]);
            grown[1].errors = ended.clone();
            grown[1].shorter = vec![ended.clone(), ended];
            assert_eq!(reason_of(&grown, &TERMS, None), wanted, "{before}");
        }
    }
}
