//! The structure of a result: what times and values are by themselves, before anything is fitted and after nothing fits.

use super::columns::{Column, Given};
use super::fits;
use super::search::Limit;
use super::world::World;
use oedometer_soil::elementary::{exp, ln};
use oedometer_soil::wording::short;

/// Time factors between which the times of outputs are looked for, trials over them, and how often these are refined.
const TIME_FACTORS: [f64; 2] = [1e-6, 10.0];
const TRIALS: usize = 50;
const REFINEMENTS: usize = 6;
/// Error that outputs at times of their own may leave.
const LEFT: f64 = 0.02;
/// Share of an error that sits in one place.
const IN_ONE_PLACE: f64 = 0.8;
/// Residual from which on the place of one that nothing explains is told, and the share of it that another output has.
const TOLD: f64 = 0.1;
const ELSEWHERE: f64 = 0.1;
/// Correlation below which a column does not vary as the exact one.
const UNLIKE: f64 = 0.5;
const FEWEST: usize = 8;

/// Times that count outputs, and the time factors that the columns are at.
pub fn step_numbers(given: &Given<'_>) -> Option<String> {
    let seconds = given.mapping.units.time.seconds(1.0, given.parameters.time(1.0));
    let numbers: Vec<f64> = given.times.iter().map(|time| time / seconds).collect();
    let first = *numbers.first().filter(|first| is_near(**first, 0.0) || is_near(**first, 1.0))?;
    let are_counted = numbers.windows(2).all(|pair| is_near(pair[1] - pair[0], 1.0));
    if !(are_counted && numbers.len() > 2) {
        return None;
    }
    let at = free_times(given)?;
    let counted: Vec<String> = numbers.iter().take(3).map(|number| short(number.round())).collect();
    let who = if given.columns.len() == 1 {
        "it matches the exact one"
    } else {
        "all columns match the exact ones"
    };
    (first >= 0.0).then(|| {
        format!(
            "your times count outputs ({}, …): are they step numbers instead of times? At T_v = {} {who}",
            counted.join(", "),
            factors(given, &at)
        )
    })
}

fn is_near(number: f64, other: f64) -> bool {
    (number - other).abs() < 1e-6
}

fn factors(given: &Given<'_>, times: &[f64]) -> String {
    let factor = |time: &f64| short(fits::rounded(given.parameters.time_factor(*time)));
    times.iter().map(factor).collect::<Vec<_>>().join(", ")
}

/// One state at all outputs.
pub fn same_state(given: &Given<'_>) -> Option<String> {
    let is_still =
        |column: &Column| column.stands_still() && !column.is_right() && content(column, given).is_none();
    if !given.columns.iter().all(is_still) {
        return None;
    }
    let of = free_times(given).map_or(String::new(), |at| {
        format!(", that of {} s (T_v = {})", short(fits::rounded(at[0])), factors(given, &at[..1]))
    });
    Some(format!("all outputs hold the same state{of}: is the same state written, or read, every time?"))
}

/// A time for each output at which all columns match, where the file's own times say nothing.
fn free_times(given: &Given<'_>) -> Option<Vec<f64>> {
    let world = World::own(given);
    if !world.is_slow() || given.kind.row().is_prepared {
        return None;
    }
    let count = given.times.len();
    let errors = |powers: &[f64]| -> Option<Vec<f64>> {
        let times: Vec<f64> = powers.iter().map(|power| given.parameters.time(exp(*power))).collect();
        let predicted = world.predict_at(given, &times)?;
        let of_column = |column: &Column, output: usize| {
            let exact = column.exact(&predicted);
            let has = column.outputs.contains(&output);
            if has { column.misfit_of(output, &exact, &exact, 1.0, true) } else { 0.0 }
        };
        let of_output =
            |output| given.columns.iter().map(|column| of_column(column, output)).fold(0.0, f64::max);
        Some((0..count).map(of_output).collect())
    };
    let [low, high] = TIME_FACTORS.map(ln);
    let (mut centre, mut width, mut trials) =
        (vec![f64::midpoint(low, high); count], 0.5 * (high - low), TRIALS);
    let mut least = vec![f64::INFINITY; count];
    for _ in 0..=REFINEMENTS {
        let before = centre.clone();
        for trial in 0..=trials {
            let share = 2.0 * trial as f64 / trials as f64 - 1.0;
            let powers: Vec<f64> = before.iter().map(|centre| centre + share * width).collect();
            for (output, error) in errors(&powers)?.into_iter().enumerate() {
                if error < least[output] {
                    (least[output], centre[output]) = (error, powers[output]);
                }
            }
        }
        width *= 2.0 / trials as f64;
        trials = 8;
    }
    let left = least.iter().copied().fold(0.0, f64::max);
    let before = given.columns.iter().map(|column| column.residual).fold(f64::INFINITY, f64::min);
    (left <= LEFT.min(0.1 * before))
        .then(|| centre.into_iter().map(|power| given.parameters.time(exp(power))).collect())
}

/// What a column holds that no reading explains: zeros, a constant, numbers in order, nothing like the exact one.
pub fn content(column: &Column, given: &Given<'_>) -> Option<String> {
    let name = column.name;
    let (first, values) = (column.values[0], &column.values);
    let another = "is it the wrong array?";
    if column.is_zero() {
        let or = match column.field.is_stress() {
            true if !given.moves() => {
                " Or has everything drained before the first time (is k, or are the times, far too large)?"
            }
            false if !given.is_stressed() => " Or is the surface closed, so that nothing drains?",
            _ => "",
        };
        return Some(format!("your {name} is 0 everywhere: {another}{or}"));
    }
    let largest = column.values.iter().copied().map(f64::abs).fold(0.0, f64::max);
    if values.len() > 1 && values.iter().all(|value| (value - first).abs() <= 1e-9 * largest) {
        let like = names(given).into_iter().find(|(_, number)| (first / number - 1.0).abs() < 1e-6);
        let like = like.map_or(String::new(), |(name, _)| format!(", as {name}"));
        return Some(format!("your {name} is {} at all places and times{like}: {another}", short(first)));
    }
    let counts = |output: usize| {
        let here = column.at_output(output);
        here.len() > 2
            && here.windows(2).all(|pair| (pair[1] - pair[0]).abs() == 1.0)
            && here[0].fract() == 0.0
    };
    if column.own_outputs().into_iter().all(counts) {
        let from = short(first);
        return Some(format!("your {name} counts from {from} by ones: are these node or cell numbers?"));
    }
    let is_other_right = Limit::of(column, given).is_other_right;
    if column.stands_still() && is_other_right {
        return Some(format!(
            "your {name} is the same at all outputs and unlike the exact one at any time: is it the wrong \
             array, or the same state written every time?"
        ));
    }
    let alike = correlation(column, &column.exact(&given.own));
    let is_unlike = alike.is_some_and(|alike| alike < UNLIKE) && place(column, given).is_none();
    (is_other_right && values.len() >= FEWEST && is_unlike).then(|| {
        let [least, most] =
            [f64::min, f64::max].map(|of| short(values.iter().copied().reduce(of).unwrap_or(0.0)));
        format!("your {name} (from {least} to {most}) does not vary as the exact one: {another}")
    })
}

/// Numbers of the scene that stand for themselves.
fn names(given: &Given<'_>) -> [(&'static str, f64); 8] {
    let soil = &given.parameters.soil;
    [
        ("the porosity", soil.porosity),
        ("the load", given.parameters.load),
        ("the hydraulic conductivity", soil.hydraulic_conductivity),
        ("E", soil.youngs_modulus),
        ("E_oed", soil.oedometric_modulus()),
        ("ν", soil.poissons_ratio),
        ("γ_w", soil.unit_weight_of_water()),
        ("the height", given.parameters.height),
    ]
}

/// The size of the correlation of a column with others.
fn correlation(column: &Column, others: &[f64]) -> Option<f64> {
    let about = |values: &[f64]| -> Vec<f64> {
        let mean = column.mean(values);
        values.iter().map(|value| value - mean).collect()
    };
    let (own, others) = (about(&column.values), about(others));
    let both = column.factor(&own, &others).abs() * column.size(&others) / column.size(&own);
    both.is_finite().then_some(both)
}

/// The outputs at which columns are right, and those at which one is wrong; `None` where they are not apart.
pub fn apart(columns: &[&Column], given: &Given<'_>) -> Option<[Vec<usize>; 2]> {
    let misfit = |output: usize| {
        let of = columns.iter().filter(|column| column.outputs.contains(&output)).map(|column| {
            let exact = column.exact(&given.own);
            column.misfit_of(output, &exact, &exact, 1.0, true)
        });
        of.fold(0.0, f64::max)
    };
    let all: Vec<(usize, f64)> = (0..given.times.len()).map(|output| (output, misfit(output))).collect();
    let worst = all.iter().map(|(_, misfit)| *misfit).fold(0.0, f64::max);
    let allowed = 1e-3_f64.max(0.03_f64.min(ELSEWHERE * worst));
    let numbers = |is_right: bool| -> Vec<usize> {
        all.iter().filter(|(_, misfit)| (*misfit <= allowed) == is_right).map(|(output, _)| *output).collect()
    };
    let (right, wrong) = (numbers(true), numbers(false));
    (!right.is_empty() && !wrong.is_empty()).then_some([right, wrong])
}

/// Whether a residual is so large that its place is told without a cause.
pub fn is_told(column: &Column) -> bool {
    column.residual > TOLD.max(column.mesh)
}

/// Whether that of some outputs is.
pub fn is_told_at(column: &Column, given: &Given<'_>, outputs: &[usize]) -> bool {
    let exact = column.exact(&given.own);
    outputs.iter().any(|output| column.misfit_of(*output, &exact, &exact, 1.0, true) > TOLD)
}

/// Where a residual without a cause sits, if it sits in one place.
pub fn place(column: &Column, given: &Given<'_>) -> Option<String> {
    let off = column.beyond(&column.exact(&given.own), 1.0);
    let power: Vec<f64> = off.iter().map(|off| (off / column.scale) * (off / column.scale)).collect();
    let all: f64 = power.iter().sum();
    let share = |is_there: &dyn Fn(f64) -> bool| {
        let there = power.iter().zip(&column.heights).filter(|(_, y)| is_there(**y));
        there.map(|(power, _)| power).sum::<f64>() / all
    };
    let height = given.parameters.height;
    let mut rows = crate::score::coverage::lines(&column.heights, height);
    rows.retain(|row| share(&|y| (y - row).abs() < 1e-6 * height) > IN_ONE_PLACE);
    let of = |what: String| {
        let percent = short(fits::rounded((100.0 * column.residual).round()));
        format!("your {} is off by {percent} %, and no known mistake explains it: {what}", column.name)
    };
    let first = column.at_output(column.outputs[0]).len();
    let outputs = column.own_outputs();
    let is_same = outputs.len() > 1 && off.len() == first * outputs.len() && {
        let differs: Vec<f64> =
            off.iter().enumerate().map(|(place, value)| value - off[place % first]).collect();
        column.size(&differs) <= LEFT * column.size(&off)
    };
    if column.heights.len() < FEWEST {
        None
    } else if let Some(row) = rows.first() {
        Some(of(format!("nearly all of it sits at y = {} m", short(*row))))
    } else {
        is_same.then(|| of("the difference is the same at all outputs".to_owned()))
    }
}
