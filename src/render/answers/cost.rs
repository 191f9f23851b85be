//! What does accuracy cost? Error over wall time with the front named, other programs' measured points, and a comparison
//! on the same number of cells.

use crate::case::contender::PAPERS;
use crate::judge::comparison::peers;
use crate::judge::comparison::work_precision::{TimedRun, WorkPrecision};
use crate::judge::study_results::StudyResults;
use crate::render::answers::{Answer, Question, study_with_most};
use crate::render::number;
use crate::render::page::{Block, Figure};
use crate::render::report::cost;

const QUESTION: Question = Question { heading: "What does accuracy cost?", id: "cost" };

/// Sentence, figure and the other programs.
pub fn answer(results: &[StudyResults<'_>]) -> Answer {
    let (one, precision) = study_with_most(results, |one| {
        let own = one.study.references.first().filter(|_| one.study.timing_repeats > 1)?;
        let precision = WorkPrecision::of(one.records, own.name())?;
        Some((precision.runs.len(), precision))
    })?;
    let figure = Figure::new("readme-cost", cost::chart_of(&precision), cost::caption(&precision));
    let mut blocks = vec![Block::Figure(figure)];
    if peers::solve_their_column(&precision.runs) {
        blocks.extend(equal_cells(&precision).map(Block::Paragraph));
    }
    Some(QUESTION.told(&sentence(&precision), [one.study.name.as_str()], blocks))
}

/// The cheapest way to each tolerance.
fn sentence(precision: &WorkPrecision<'_>) -> String {
    let ways = precision.cheapest.iter().map(|cheapest| {
        let tolerance = number::percent(cheapest.tolerance);
        cheapest.run.as_ref().map_or(format!("no timed run is within {tolerance}"), |run| {
            let seconds = number::seconds(run.wall.median);
            format!("{tolerance} costs {seconds} (`{}`)", run.record.case.label())
        })
    });
    format!("Cost of an error of the pressure: {}.", ways.collect::<Vec<_>>().join("; "))
}

/// The errors of the best implicit run of the paper's method on a mesh, measured like those of the other programs.
fn on_cells(precision: &WorkPrecision<'_>, cells: usize) -> Option<[Option<f64>; 3]> {
    let fits = |run: &&TimedRun<'_>| {
        let case = &run.record.case;
        case.cells == cells && case.method.to_string() == PAPERS && !case.is_explicit()
    };
    let best = precision.runs.iter().filter(fits).min_by(|a, b| a.error.total_cmp(&b.error))?;
    Some(peers::comparable_errors(best))
}

/// Where the other programs are ahead on the same number of cells and with a time scheme of the same kind; `None` where no
/// run of the paper's method can be compared.
fn equal_cells(precision: &WorkPrecision<'_>) -> Option<String> {
    let (mut compared, mut ahead) = (0, Vec::new());
    for peer in peers::PEERS.iter().filter(|peer| peer.time_scheme.starts_with("SDIRK")) {
        let Some(own) = on_cells(precision, peer.cells) else { continue };
        let pairs = peer.errors().into_iter().zip(own).zip(peers::TIME_FACTORS);
        let pairs: Vec<_> = pairs.filter_map(|((theirs, own), time)| Some((theirs, own?, time))).collect();
        compared += pairs.len();
        // One time of each shows it; the page of the study has the others.
        ahead.extend(pairs.iter().find(|(theirs, own, _)| theirs < own).map(|(theirs, own, time)| {
            let (theirs, own) = (number::error(*theirs), number::error(*own));
            format!("{} on {} cells {theirs} against {own} at T_v = {time}", peer.name, peer.cells)
        }));
    }
    if compared == 0 {
        return None;
    }
    if ahead.is_empty() {
        return Some(format!(
            "On equal cells and with like time steps no other program has a smaller pressure error than `{PAPERS}`."
        ));
    }
    Some(format!(
        "**On equal cells and with like time steps mixed elements have a smaller pressure error than `{PAPERS}`**: {}. \
         The figure shows the time that an error costs.",
        ahead.join("; ")
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::records_of;
    use crate::case::SolverName;
    use crate::judge::comparison::work_precision::Cheapest;
    use crate::measure::statistics::spread;
    use crate::record::Record;
    use oedometer_mpm::method::Method;
    use oedometer_mpm::run::integrator::IntegratorKind;

    const STUDY: &str = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.05, 0.2, 1.0]\n[[sweep]]\n\
        method = ['GC-SRI-patch']\nintegrator = ['implicit']\ncells = [10]\n";

    fn precision<'a>(records: &'a [Record], errors: &[f64]) -> WorkPrecision<'a> {
        let wall = spread(&[1.0, 1.0]).expect("two samples");
        let run =
            |(record, error): (&'a Record, &f64)| TimedRun { record, error: *error, wall, on_front: false };
        let runs = records.iter().zip(errors).map(run).collect();
        WorkPrecision { runs, cheapest: Vec::new(), noise_floor: None }
    }

    #[test]
    fn other_programs_stand_beside_the_best_implicit_run_of_the_paper_s_method_on_as_many_cells() {
        let seed = records_of(STUDY).remove(0);
        let with = |change: &dyn Fn(&mut Record), error: f64| {
            let mut record = seed.clone();
            change(&mut record);
            record.errors.iter_mut().for_each(|row| row.value = error);
            record
        };
        let mpm = SolverName::Own(Method::named("MPM").expect("a method"));
        // The smaller the error, the less it may be taken.
        let others = [
            with(&|one| one.case.integrator = IntegratorKind::Explicit, 1e-5),
            with(&|one| one.case.method = mpm, 1e-6),
            with(&|one| one.case.cells = 20, 1e-7),
        ];
        let own = [with(&|_| (), 0.03), with(&|_| (), 0.02), with(&|_| (), 0.04)];
        let records = [others.clone(), own].concat();
        let errors = [1e-5, 1e-6, 1e-7, 0.03, 0.02, 0.04];
        let found = precision(&records, &errors);
        assert_eq!(on_cells(&found, 10), Some([Some(0.02); 3]));
        assert_eq!(on_cells(&found, 20), Some([Some(1e-7); 3]));
        assert_eq!(on_cells(&found, 40), None);
        assert_eq!(on_cells(&precision(&others, &errors), 10), None, "none of the others is comparable");
        // Where ours is worse, the programs that step alike are named with both errors, and no others.
        let told = equal_cells(&found).expect("runs to compare");
        let like = peers::PEERS.iter().find(|peer| peer.time_scheme.starts_with("SDIRK") && peer.cells == 10);
        let like = like.expect("such a program");
        let both =
            format!("{} against {} at T_v = 0.05", number::error(like.errors()[0]), number::error(0.02));
        assert!(told.starts_with("**On equal cells") && told.contains(&both), "{told}");
        assert!(
            told.contains(&like.name) && !told.contains("Kratos") && !told.contains("on 20 cells"),
            "{told}"
        );
        assert!(told.ends_with(". The figure shows the time that an error costs."), "{told}");
        let good = [with(&|_| (), 1e-9)];
        assert_eq!(
            equal_cells(&precision(&good, &errors)).as_deref(),
            Some(
                "On equal cells and with like time steps no other program has a smaller pressure error than `GC-SRI-patch`."
            )
        );
        let run = |seconds: f64| TimedRun { wall: spread(&[seconds]).expect("one"), ..found.runs[3].clone() };
        let way = |tolerance: f64, seconds: Option<f64>| Cheapest { tolerance, run: seconds.map(run) };
        let cheapest = vec![way(1e-2, Some(0.02)), way(1e-3, None), way(1e-4, Some(3.0))];
        let label = records[3].case.label();
        assert_eq!(
            sentence(&WorkPrecision { cheapest, ..precision(&records, &errors) }),
            format!(
                "Cost of an error of the pressure: 1.00 % costs 20.0 ms (`{label}`); no timed run is within 0.10 %; 0.0100 % \
                 costs 3.00 s (`{label}`)."
            )
        );
        assert_eq!(
            equal_cells(&precision(&others[..2], &errors)),
            None,
            "nothing is said of what was not compared"
        );
    }
}
