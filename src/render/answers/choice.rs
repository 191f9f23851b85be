//! Which method should one take? One row a situation, chosen from the records by a rule that is stated.

use crate::case::quantity::{Quantity, Sample};
use crate::judge::comparison::locking::{Standing, standings};
use crate::judge::comparison::work_precision::WorkPrecision;
use crate::judge::paths::Path;
use crate::render::answers::question::{Answer, Links, Question, link_cell, short};
use crate::render::answers::regime::{MethodPath, Regime};
use crate::render::number;
use crate::render::page::Block;
use crate::render::report::StudyResults;
use crate::render::report::labels::first_measure;
use crate::render::table::{Cell, Table, columns};
use crate::study::expectation::{Axis, NEXT_FINER};
use oedometer_convergence::Class;
use oedometer_exact::exact_error::ExactError;

/// The question.
pub const QUESTION: Question = Question { heading: "Which method should I take?", id: "choice" };

/// Errors of a stiff skeleton may be this many times those of the usual one.
const KEEPS: f64 = 2.0;

/// Situations of columns, as a row and as the end of a sentence.
const SMALL: (&str, &str) = ("Small strain: nothing moves far", "while nothing moves far");
const CROSSING: (&str, &str) =
    ("Large strain: points cross cells", "at large strain where points cross cells");
const TOTAL: (&str, &str) = (
    "Large strain: shape functions of the initial configuration (total Lagrangian) will do",
    "at large strain where shape functions of the initial configuration will do",
);

/// A situation with the method to take: what is measured of it, and the study that carries it.
struct Advice {
    situation: &'static str,
    place: &'static str,
    take: String,
    evidence: String,
    study: String,
}

/// One row a situation.
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
            link_cell(links, &advice.study),
        ]
    });
    let table = Table::of("", columns("situation | take | because | study"), rows).note(
        "The rule: of the methods tried on the same column, the one whose largest error (pressure, effective stress, \
         settlement) on the finest common mesh is smallest. The study has the others.",
    );
    let taken: Vec<String> = all.iter().map(|advice| format!("`{}` {}", advice.take, advice.place)).collect();
    let sentence = format!("Take {}.", taken.join("; "));
    Ok(QUESTION.told(sentence, vec![Block::Table(short(table, "in the studies"))]))
}

/// The method whose largest error of pressure, effective stress and settlement on the finest common mesh is the
/// smallest, with its orders.
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
    let order = |name: &str, quantity, sample| {
        let class = regime.summary(one, quantity, sample).classification;
        class
            .order
            .map_or(format!("{name} {}", class.class), |order| format!("{name} {}", number::order(order)))
    };
    let orders = [
        order("p", Quantity::Pressure, Sample::Points),
        order("σ′", Quantity::EffectiveStress, Sample::Points),
        order("s", Quantity::Settlement, Sample::Surface),
    ];
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

/// What a tenth of a percent costs with a method, where runs were timed.
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

/// The method that keeps its errors where the skeleton hardly compresses, and who locks.
fn of_stiff_skeleton(study: &str, standings: &[Standing]) -> Option<Advice> {
    let keeps = |stiff: Option<f64>, plain: Option<f64>| {
        stiff.zip(plain).is_some_and(|(stiff, plain)| stiff < KEEPS * plain)
    };
    let holds = |one: &&Standing| {
        one.class != Some(Class::Locked)
            && keeps(one.stiff_skeleton, one.displacement)
            && keeps(one.stiff_skeleton_pressure, one.pressure)
    };
    let tried = standings.iter().filter(|one| one.stiff_skeleton_pressure.is_some()).count();
    let holding: Vec<&Standing> = standings.iter().filter(holds).collect();
    let best = holding.iter().min_by(|a, b| {
        let error = |one: &Standing| one.stiff_skeleton_pressure.unwrap_or(f64::INFINITY);
        error(a).total_cmp(&error(b))
    })?;
    Some(Advice {
        situation: "Skeleton nearly incompressible",
        place: "where the skeleton hardly compresses",
        take: best.method.to_string(),
        evidence: format!(
            "errors of the undrained start at the largest Poisson's ratio: displacement {}, pressure {}; {} of {tried} methods keep both \
             within twice those of the usual soil",
            best.stiff_skeleton.map_or_else(String::new, number::error),
            best.stiff_skeleton_pressure.map_or_else(String::new, number::error),
            holding.len()
        ),
        study: study.to_owned(),
    })
}

/// The integrator whose errors fall with the highest settled order in the step, for the same wave.
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

/// The method of a path and how it steps: what one takes over, and not the mesh that it was tried on.
fn scheme_of(path: &Path<'_>) -> String {
    let case = &path.records[0].case;
    let parts = [case.method.to_string(), case.integrator.name().to_owned(), case.variant()];
    parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(", ")
}

/// The settled order of the pressure in the step, and the error of the coarsest step.
fn step_order(path: &Path<'_>) -> Option<(f64, f64)> {
    let time = *path.records[0].case.time_factors.last()?;
    let summary = path.summary(&first_measure(Quantity::Pressure, Sample::Points, NEXT_FINER, time));
    let is_settled = matches!(summary.classification.class, Class::Asymptotic | Class::Superconvergent);
    let coarsest = summary.series.levels().first()?.error?;
    Some((summary.classification.order.filter(|_| is_settled)?, coarsest))
}
