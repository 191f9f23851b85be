//! Which method should I take? One row per situation, chosen from the records by a stated rule.

use crate::case::quantity::{Quantity, Sample};
use crate::judge::comparison::locking::{Standing, standings};
use crate::judge::comparison::work_precision::WorkPrecision;
use crate::judge::paths::Path;
use crate::render::answers::regime::{MethodPath, Regime};
use crate::render::answers::{Answer, Links, Question, short};
use crate::render::number;
use crate::render::page::Block;
use crate::render::report::StudyResults;
use crate::render::report::labels::{first_measure, is_settled, order_or_class};
use crate::render::report::layer::keeps_errors;
use crate::render::table::{Cell, Table, columns};
use crate::study::expectation::{Axis, NEXT_FINER};
use oedometer_convergence::Class;
use oedometer_exact::exact_error::ExactError;

const QUESTION: Question = Question { heading: "Which method should I take?", id: "choice" };

/// Situations of columns, as the head of a row and as the end of a sentence.
const SMALL: (&str, &str) = ("Small strain", "at small strain");
const CROSSING: (&str, &str) =
    ("Large strain: points cross cells", "at large strain where points cross cells");
const TOTAL: (&str, &str) = (
    "Large strain: total Lagrangian (shape functions of the initial configuration)",
    "at large strain where shape functions of the initial configuration suffice",
);

/// A situation with the method to take, the reason, and the study that shows it.
struct Advice {
    situation: &'static str,
    place: &'static str,
    take: String,
    evidence: String,
    study: String,
}

/// One row per situation.
pub fn answer(
    results: &[StudyResults<'_>],
    small: Option<&Regime<'_>>,
    large: Option<&Regime<'_>>,
    links: Links<'_>,
) -> Result<Answer, ExactError> {
    let mut all: Vec<Advice> = Vec::new();
    all.extend(small.and_then(|regime| of_regime(results, regime, SMALL, &|_| true)));
    let stays = |one: &MethodPath<'_>| one.method.starts_with("TL-");
    all.extend(large.and_then(|regime| of_regime(results, regime, CROSSING, &|one| !stays(one))));
    all.extend(large.and_then(|regime| of_regime(results, regime, TOTAL, &stays)));
    for one in results.iter().filter(|one| one.study.scene.shows_locking()) {
        let standings = standings(one.study, one.records)?;
        all.extend(of_stiff_skeleton(&one.study.name, &standings));
    }
    all.extend(of_waves(results));
    if all.is_empty() {
        return Ok(QUESTION.open("several methods on the same column or layer"));
    }
    let rows = all.iter().map(|advice| {
        vec![
            advice.situation.into(),
            Cell::Code(advice.take.clone()),
            advice.evidence.as_str().into(),
            Cell::Link { words: advice.study.clone(), target: links(&advice.study) },
        ]
    });
    let table = Table::of("", columns("situation | take | because | study"), rows).note(
        "The rule: of the methods tried on the same column, the one with the smallest largest error of pressure, effective \
         stress and settlement on the finest common mesh. Words beside an order mean that it is not settled. The study has \
         the other methods.",
    );
    let taken: Vec<String> = all.iter().map(|advice| format!("`{}` {}", advice.take, advice.place)).collect();
    let sentence = format!("Take {}.", taken.join("; "));
    Ok(QUESTION.told(sentence, vec![Block::Table(short(table, "in the studies"))]))
}

/// The method with the smallest largest error of pressure, effective stress and settlement on the finest common mesh, with
/// its orders.
fn of_regime(
    results: &[StudyResults<'_>],
    regime: &Regime<'_>,
    (situation, place): (&'static str, &'static str),
    fits: &dyn Fn(&MethodPath<'_>) -> bool,
) -> Option<Advice> {
    let tried: Vec<(&MethodPath<'_>, f64)> = regime
        .methods
        .iter()
        .filter(|one| fits(one))
        .filter_map(|one| Some((one, regime.largest_error(one)?)))
        .collect();
    let (one, error) = tried.iter().min_by(|a, b| a.1.total_cmp(&b.1))?;
    let order = |(name, quantity, sample)| {
        format!("{name} {}", order_or_class(&regime.summary(one, quantity, sample).classification))
    };
    let orders = [
        ("p", Quantity::Pressure, Sample::Points),
        ("σ′", Quantity::EffectiveStress, Sample::Points),
        ("s", Quantity::Settlement, Sample::Surface),
    ]
    .map(order);
    let cheapest = cheapest_words(results, &one.method);
    Some(Advice {
        situation,
        place,
        take: one.method.clone(),
        evidence: format!(
            "order {}; largest error {} on {} cells, the best of {} tried{cheapest}",
            orders.join(", "),
            number::percent(*error),
            regime.finest_cells,
            tried.len()
        ),
        study: one.study.to_owned(),
    })
}

/// The cost of an error of 0.1 % with a method, if runs were timed.
fn cheapest_words(results: &[StudyResults<'_>], method: &str) -> String {
    let timed = results.iter().filter(|one| one.study.timing_repeats > 1);
    let run = timed.filter_map(|one| {
        let precision = WorkPrecision::of(one.records, one.study.references.first()?.name())?;
        let fits = precision
            .runs
            .iter()
            .find(|run| run.error <= 1e-3 && run.record.case.method.to_string() == method)?;
        Some((fits.wall.median, fits.record.case.integrator.name()))
    });
    run.min_by(|a, b| a.0.total_cmp(&b.0))
        .map_or(String::new(), |(seconds, name)| format!("; 0.1 % in {}, {name}", number::seconds(seconds)))
}

/// The method with the smallest pressure error that keeps its errors where the skeleton is nearly incompressible.
fn of_stiff_skeleton(study: &str, standings: &[Standing]) -> Option<Advice> {
    let holds = |one: &&Standing| one.class != Some(Class::Locked) && keeps_errors(one);
    let tried = standings.iter().filter(|one| one.stiff_skeleton_pressure.is_some()).count();
    let holding: Vec<&Standing> = standings.iter().filter(holds).collect();
    let best = holding.iter().min_by(|a, b| {
        let error = |one: &Standing| one.stiff_skeleton_pressure.unwrap_or(f64::INFINITY);
        error(a).total_cmp(&error(b))
    })?;
    Some(Advice {
        situation: "Skeleton nearly incompressible",
        place: "where the skeleton is nearly incompressible",
        take: best.method.to_string(),
        evidence: format!(
            "errors of the undrained start at the largest Poisson's ratio: displacement {}, pressure {}; {} of {tried} methods \
             keep both below twice their errors in the usual soil",
            best.stiff_skeleton.map_or_else(String::new, number::error),
            best.stiff_skeleton_pressure.map_or_else(String::new, number::error),
            holding.len()
        ),
        study: study.to_owned(),
    })
}

/// The integrator with the highest settled order in the time step, for the same wave.
fn of_waves(results: &[StudyResults<'_>]) -> Option<Advice> {
    let mut best: Option<(f64, f64, String, &str)> = None;
    let mut tried = 0;
    for one in results.iter().filter(|one| one.study.scene.has_waves() && one.asks_for(NEXT_FINER)) {
        for path in one.paths.along(Axis::TimeStep) {
            let Some((order, error)) = step_order(path) else { continue };
            tried += 1;
            if best
                .as_ref()
                .is_none_or(|(known, smallest, _, _)| (order.round(), -error) > (known.round(), -smallest))
            {
                best = Some((order, error, scheme_of(path), &one.study.name));
            }
        }
    }
    let (order, _, take, study) = best?;
    Some(Advice {
        situation: "Waves matter",
        place: "for waves",
        take,
        evidence: format!(
            "order {} in the time step, the highest of {tried} time-stepping schemes tried",
            number::order(order)
        ),
        study: study.to_owned(),
    })
}

/// The method of a path and how it steps, without the mesh on which it was tried.
fn scheme_of(path: &Path<'_>) -> String {
    let case = &path.records[0].case;
    let parts = [case.method.to_string(), case.integrator.name().to_owned(), case.variant()];
    parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(", ")
}

/// The settled order of the pressure in the step, and the error of the coarsest step.
fn step_order(path: &Path<'_>) -> Option<(f64, f64)> {
    let time = *path.records[0].case.time_factors.last()?;
    let summary = path.summary(&first_measure(Quantity::Pressure, Sample::Points, NEXT_FINER, time));
    let found = &summary.classification;
    let coarsest = summary.series.levels().first()?.error?;
    Some((found.order.filter(|_| is_settled(found.class))?, coarsest))
}
