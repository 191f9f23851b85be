//! What reaches a bound: for each quantity the cheapest choice of method, mesh and step whose error stays within it at every
//! output, in every problem of the study, on this mesh and all finer ones.

use crate::case::grouping::{distinct, grouped};
use crate::case::{Case, Quantity, Sample};
use crate::judge::recommendation::QuotedRuns;
use crate::judge::study_results::StudyResults;
use crate::questions::finding::{Finding, Place, Question};
use crate::questions::words;
use crate::record::calibration::cost_of;
use crate::record::{ErrorRow, Record};
use crate::render::number;
use crate::render::page::Block;
use crate::render::table::{Cell, Mood, Table, columns};
use crate::study::check::Study;
use oedometer_problem::time_step::TimeStep;
use oedometer_wording::duration;
use serde::Serialize;

/// What comes within a bound, and at what cost?
pub static WITHIN: Question = Question {
    id: "within",
    heading: "What does it take to meet a tolerance?",
    template: include_str!("within.md"),
    places: &[Place::Terminal, Place::Study],
    ask: |studies| Ok(ask(studies)),
};

/// Every number and name of the sentence.
#[derive(Serialize)]
struct Facts<'a> {
    /// The larger bound.
    bound: f64,
    /// Number of problems.
    problems: usize,
    /// The cheapest choice for each quantity that a run keeps within it.
    reached: Vec<&'a WithinFinding>,
    /// For each of the others the choice with the least error.
    missed: Vec<&'a WithinFinding>,
}

fn ask(studies: &[StudyResults<'_>]) -> Option<Finding> {
    let [one] = studies else { return None };
    let found = (!one.study.is_race).then(|| within(one.study, one.records))?;
    answer(&one.study.name, &found)
}

fn answer(study: &str, all: &[QuantityWithin]) -> Option<Finding> {
    let facts = Facts {
        bound: BOUNDS[0],
        problems: all.first()?.problems,
        reached: all.iter().filter_map(|asked| asked.choices[0].as_ref()).collect(),
        missed: all.iter().filter(|asked| asked.choices[0].is_none()).map(|asked| &asked.best).collect(),
    };
    Some(WITHIN.answer([study], &facts).with(Block::Table(table(all))))
}

/// A row per quantity and bound: the cheapest choice, or where none stays within, the one with the least error. Integrators stand
/// in the title where all are the same, and numbers of points in a cell where the method has runs with others.
fn table(all: &[QuantityWithin]) -> Table {
    let mut shown: Vec<(f64, &WithinFinding, bool)> = Vec::new();
    for QuantityWithin { choices, best, .. } in all {
        for (bound, choice) in BOUNDS.into_iter().zip(choices) {
            // What misses the larger bound misses the smaller one.
            if choice.is_some() || choices[0].is_some() || bound == BOUNDS[0] {
                shown.push((bound, choice.as_ref().unwrap_or(best), choice.is_some()));
            }
        }
    }
    let integrators = distinct(shown.iter().map(|(_, choice, _)| choice.integrator));
    let shared = if let [only] = integrators[..] { Some(only) } else { None };
    let has_points = shown.iter().any(|(_, choice, _)| choice.has_other_points);
    let rows: Vec<Vec<Cell>> = shown
        .iter()
        .map(|(bound, choice, is_within)| row(*bound, choice, *is_within, [shared.is_none(), has_points]))
        .collect();
    let has = |mark: &str| rows.iter().flatten().any(|cell: &Cell| cell.show().starts_with(mark));
    let notes = [
        has("✗").then(|| "✗: no sound run is within the bound; the smallest error is shown".to_owned()),
        has("•").then(|| "•: not confirmed by a finer mesh".to_owned()),
        has("≥").then(|| "≥: no longer step was tried".to_owned()),
    ];
    let notes: Vec<String> = notes.into_iter().flatten().collect();
    let everywhere =
        if all[0].problems > 1 { format!(" in all {} problems", all[0].problems) } else { String::new() };
    let with_integrator = if shared.is_none() { " | integrator" } else { "" };
    let with_points = if has_points { " | > points per cell" } else { "" };
    let header = format!(
        "error of | > bound | method{with_integrator} | > cells{with_points} | > step | > largest | > at {}",
        all[0].best.factor_name
    );
    let is_counted = all.iter().all(|asked| asked.best.cost > 0.0);
    let least = if is_counted { "Least counted work" } else { "Coarsest mesh" };
    let integrator = shared.filter(|name| !name.is_empty()).map_or(String::new(), |name| format!(", {name}"));
    let title = format!("{least} within a bound at every output{everywhere}{integrator}");
    Table::of(title, columns(&header), rows).notes(notes).file(WITHIN.id)
}

/// The cells of a choice.
fn row(
    bound: f64,
    choice: &WithinFinding,
    is_within: bool,
    [has_integrator, has_points]: [bool; 2],
) -> Vec<Cell> {
    let method = choice.method.clone();
    let integrator = match choice.integrator {
        "" => Cell::missing("another program's"),
        integrator => integrator.into(),
    };
    let step = match choice.largest_step {
        step if step <= 0.0 && choice.integrator.is_empty() => Cell::missing("another program's"),
        step if step <= 0.0 => Cell::missing("no step was needed"),
        step if choice.is_longest_tried => format!("≥ {}", duration(step)).into(),
        step => duration(step).into(),
    };
    let mut row = vec![
        words::quantity(choice.quantity).into(),
        Cell::Text(number::bound(bound)),
        match (is_within, choice.is_confirmed) {
            (false, _) => Cell::Verdict(Mood::Fail, method),
            (true, false) => Cell::Verdict(Mood::Note, method),
            (true, true) => Cell::Code(method),
        },
    ];
    row.extend(has_integrator.then_some(integrator));
    row.push(Cell::Count(choice.cells as u64));
    row.extend(has_points.then_some(Cell::Count(choice.points_per_cell as u64)));
    row.extend([step, Cell::Percent(choice.error), Cell::Text(number::time_factor(choice.time_factor))]);
    row
}

/// Bounds for which the cheapest choice is looked for.
const BOUNDS: [f64; 2] = [0.01, 0.001];

/// The quantities that a user asks for, in their order; a displacement only where nothing settles.
const ASKED: [Quantity; 5] = [
    Quantity::Settlement,
    Quantity::LoadFactor,
    Quantity::Displacement,
    Quantity::Pressure,
    Quantity::EffectiveStress,
];

/// A quantity and what it takes to come within bounds of its error.
#[derive(Clone, Debug, PartialEq)]
pub struct QuantityWithin {
    /// Problems that every choice solves: soils, loads and geometries.
    pub problems: usize,
    /// The cheapest choice within each bound, where one stays within it.
    pub choices: [Option<WithinFinding>; BOUNDS.len()],
    /// The choice with the least error.
    pub best: WithinFinding,
}

/// Method, mesh and step, with the largest error over all outputs and problems.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WithinFinding {
    /// Quantity.
    pub quantity: Quantity,
    /// Method, or name of another solver.
    pub method: String,
    /// Integrator; empty where another program solved.
    #[serde(skip)]
    pub integrator: &'static str,
    /// Cells over the height.
    pub cells: usize,
    /// Points in a cell, and whether there are runs of the same method and integrator with others.
    #[serde(skip)]
    pub points_per_cell: usize,
    #[serde(skip)]
    pub has_other_points: bool,
    /// Largest step of the run with the largest error, s; 0 where another program solved.
    #[serde(skip)]
    pub largest_step: f64,
    /// Whether no run of the same method on the same mesh took larger steps: the limit may be larger.
    #[serde(skip)]
    pub is_longest_tried: bool,
    /// Whether a finer mesh stays within the bound too, in every problem.
    #[serde(skip)]
    pub is_confirmed: bool,
    /// Largest error.
    pub error: f64,
    /// Time factor of the output that has it, and what it counts.
    pub time_factor: f64,
    pub factor_name: &'static str,
    /// Time of that output, s.
    pub seconds: f64,
    /// Counted work of the run with the largest error, s.
    #[serde(skip)]
    pub cost: f64,
    /// Hash of that run's case.
    #[serde(skip)]
    pub case: String,
}

/// What it takes in a study, for each quantity that has errors against the scene's own reference.
pub fn within(study: &Study, records: &[Record]) -> Vec<QuantityWithin> {
    let Some(reference) = study.references.first() else { return Vec::new() };
    let mut found: Vec<QuantityWithin> = Vec::new();
    for quantity in ASKED {
        if quantity == Quantity::Displacement && !found.is_empty() {
            continue;
        }
        found.extend(quantity_within(study, records, quantity, reference.name()));
    }
    found
}

fn quantity_within(
    study: &Study,
    records: &[Record],
    quantity: Quantity,
    reference: &str,
) -> Option<QuantityWithin> {
    let rows = |record: &Record| {
        let is_of = |row: &&ErrorRow| {
            row.quantity == quantity && row.norm == quantity.first_norm() && row.reference == reference
        };
        record.errors.iter().filter(is_of).cloned().collect::<Vec<_>>()
    };
    let main = records.first()?.main_sample();
    let samples: Vec<Sample> = records.iter().flat_map(rows).map(|row| row.sample).collect();
    let sample = samples.iter().copied().find(|sample| *sample == main).or(samples.first().copied())?;
    // The largest error of a run that has one at every output.
    let largest = |record: &Record| {
        let rows: Vec<ErrorRow> = rows(record).into_iter().filter(|row| row.sample == sample).collect();
        let is_whole = record.status.failure().is_none()
            && rows.len() == record.case.time_factors.len()
            && rows.iter().all(|row| row.value.is_finite());
        rows.into_iter().max_by(|a, b| a.value.abs().total_cmp(&b.value.abs())).filter(|_| is_whole)
    };
    let problems = grouped(records, |record| problem(&record.case)).len();
    let choices: Vec<(WithinFinding, Vec<&Record>)> = grouped(records, |record| choice(&record.case))
        .into_iter()
        .filter(|(_, runs)| grouped(runs, |record| problem(&record.case)).len() == problems)
        .filter_map(|(_, runs)| {
            let all = runs.iter().map(|record| Some((*record, largest(record)?)));
            let all: Vec<(&Record, ErrorRow)> = all.collect::<Option<_>>()?;
            let (record, row) = all.into_iter().max_by(|a, b| a.1.value.abs().total_cmp(&b.1.value.abs()))?;
            let found = WithinFinding {
                is_longest_tried: is_longest_tried(record, records),
                has_other_points: has_other_points(record, records),
                ..WithinFinding::new(record, &row)
            };
            Some((found, runs))
        })
        .collect();
    let quoted =
        QuotedRuns::new(records, &study.case_expectations, |record| largest(record).map(|row| row.value));
    // A choice is within a bound where each of its runs is.
    let within = |bound: f64| -> Vec<WithinFinding> {
        let reaching = quoted.reaching(bound);
        let within = choices.iter().filter_map(|(choice, runs)| {
            let confirmed = runs.iter().map(|record| reaching.get(record.hash.as_str()).copied());
            let confirmed: Vec<bool> = confirmed.collect::<Option<_>>()?;
            let is_confirmed = confirmed.into_iter().all(|is_confirmed| is_confirmed);
            Some(WithinFinding { is_confirmed, ..choice.clone() })
        });
        within.collect()
    };
    let is_quoted = |runs: &[&Record]| runs.iter().all(|record| quoted.quotes(record));
    // Where a check of every run fails, the least error is told all the same: nothing is recommended by it.
    let best = choices.iter().min_by(|(a, of_a), (b, of_b)| {
        is_quoted(of_b).cmp(&is_quoted(of_a)).then(a.error.total_cmp(&b.error))
    });
    let best = best?.0.clone();
    let is_counted = choices.iter().all(|(choice, _)| choice.cost > 0.0);
    let choices = BOUNDS.map(|bound| cheapest(within(bound), is_counted));
    Some(QuantityWithin { problems, choices, best })
}

/// The cheapest choice; beside another program, whose work is not counted, the one on the coarsest mesh.
fn cheapest(fits: Vec<WithinFinding>, is_counted: bool) -> Option<WithinFinding> {
    let cost = |choice: &WithinFinding| if is_counted { choice.cost } else { 0.0 };
    fits.into_iter().min_by(|a, b| cost(a).total_cmp(&cost(b)).then(a.cells.cmp(&b.cells)))
}

impl WithinFinding {
    fn new(record: &Record, row: &ErrorRow) -> Self {
        let case = &record.case;
        Self {
            quantity: row.quantity,
            method: case.method.to_string(),
            integrator: if case.has_integrator() { case.integrator.name() } else { "" },
            cells: case.cells,
            points_per_cell: case.points_per_cell,
            has_other_points: false,
            largest_step: if case.has_integrator() { record.step_sizes.largest } else { 0.0 },
            is_longest_tried: false,
            is_confirmed: false,
            error: row.value.abs(),
            time_factor: row.time_factor,
            factor_name: case.scene.clock.factor_name(),
            seconds: row.time_factor * case.seconds_per_time_factor(),
            // What another program costs is not counted.
            cost: if case.has_integrator() { cost_of(record) } else { 0.0 },
            case: record.hash.clone(),
        }
    }
}

/// Whether a run of the same method and integrator has other points in a cell.
fn has_other_points(record: &Record, records: &[Record]) -> bool {
    let solver = |record: &Record| (record.case.method.to_string(), record.case.integrator.name());
    let mut alike = records.iter().filter(|other| solver(other) == solver(record));
    alike.any(|other| other.case.points_per_cell != record.case.points_per_cell)
}

/// Whether no run of the same method and integrator on the same mesh of the same problem took larger steps.
fn is_longest_tried(record: &Record, records: &[Record]) -> bool {
    let what = |record: &Record| {
        let case = &record.case;
        let solver = (case.method.to_string(), case.integrator.name());
        (solver, case.cells, case.points_per_cell, problem(case))
    };
    let alike = records.iter().filter(|other| what(other) == what(record));
    alike.map(|other| other.step_sizes.largest).fold(0.0, f64::max) <= record.step_sizes.largest
}

/// A number for what is solved, whoever solves it and on whatever mesh.
pub(crate) fn problem(case: &Case) -> u64 {
    case.number_with(|case| {
        let seed = Case::seed(case.task, case.scene);
        (case.method, case.integrator, case.formulation) = (seed.method, seed.integrator, seed.formulation);
        (case.settings, case.cells, case.points_per_cell) = (seed.settings, seed.cells, seed.points_per_cell);
        (case.time_step, case.time_factors) = (seed.time_step, seed.time_factors);
    })
}

/// A number for who solves it, on which mesh and by which steps, whatever the problem.
pub(crate) fn choice(case: &Case) -> u64 {
    case.number_with(|case| {
        let seed = Case::seed(case.task, case.scene);
        (case.column, case.material, case.time_factors) = (seed.column, seed.material, seed.time_factors);
        if let TimeStep::Seconds(_) = case.time_step {
            case.time_step = seed.time_step;
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::{failed_at, solved};

    /// Errors are laid down; the cost is counted, so that 4 cells are cheaper than 8 and those than 16.
    #[test]
    fn the_cheapest_choice_is_within_the_bound_at_every_output_and_in_every_soil() {
        let text = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1, 0.5]\n[[sweep]]\nmethod = ['MPM']\n\
                    integrator = ['implicit']\ncells = [4, 8, 16]\nyoungs_modulus = [1e6, 1e7]\n";
        let (study, mut records) = solved("s", text);
        let mut lay = |errors: [f64; 3], odd: Option<(usize, f64)>| {
            for (place, record) in records.iter_mut().enumerate() {
                let level = [4, 8, 16].iter().position(|cells| *cells == record.case.cells).expect("a mesh");
                for row in &mut record.errors {
                    let is_odd = odd.filter(|(at, _)| *at == place && row.time_factor == 0.5);
                    row.value = is_odd.map_or(errors[level], |(_, value)| value);
                }
            }
            within(&study, &records)
        };
        let cells = |found: &[QuantityWithin]| {
            [0, 1].map(|place| found[0].choices[place].as_ref().map(|choice| choice.cells))
        };
        let found = lay([0.05, -0.008, 0.0009], None);
        let asked: Vec<_> = found.iter().map(|one| one.best.quantity).collect();
        assert_eq!(asked, [Quantity::Settlement, Quantity::Pressure, Quantity::EffectiveStress]);
        assert_eq!(cells(&found), [Some(8), Some(16)]);
        assert_eq!(found[0].best.cells, 16);
        // One soil, one time: beyond the bound in one of them is beyond it.
        let of_eight = [2, 3].map(|place| cells(&lay([0.05, 0.008, 0.0009], Some((place, 0.02)))));
        assert!(of_eight.contains(&[Some(16), Some(16)]), "{of_eight:?}");
        let confirmed = |found: &[QuantityWithin]| {
            found[0].choices[0].as_ref().map(|choice| (choice.cells, choice.is_confirmed))
        };
        assert_eq!(confirmed(&lay([0.05, 0.008, 0.009], None)), Some((8, true)));
        assert_eq!(confirmed(&lay([0.0065, 0.12, 0.009], None)), Some((16, false)), "nothing finer");
        assert_eq!(confirmed(&lay([0.0065, 0.12, 0.25], None)), None, "it diverges");
        // Coarse and right in both soils, fine and wrong in one of them.
        assert_eq!(confirmed(&lay([0.005; 3], Some((4, 0.02)))), None);
        let found = lay([0.05, 0.02, 0.011], None);
        assert_eq!((cells(&found), found[0].best.error), ([None, None], 0.011));
        // An expectation of a case that is not met speaks against its run, and so does a failed check.
        let mut strict = study.clone();
        let expectation = "[[expect_case]]\ncells = 4\nwater_drift_below = 1e-30\n";
        strict.case_expectations = solved("s", &(text.to_owned() + expectation)).0.case_expectations;
        records.iter_mut().flat_map(|record| &mut record.errors).for_each(|row| row.value = 0.005);
        let coarsest = |study: &Study, records: &[Record]| cells(&within(study, records))[0];
        assert_eq!([&study, &strict].map(|study| coarsest(study, &records)), [Some(4), Some(8)]);
        let mut unsound = records.clone();
        unsound[5].balance[0].solid_mass_drift = 0.164;
        assert_eq!(coarsest(&study, &unsound), None);
        for record in &mut records {
            record.status = failed_at(1);
        }
        assert_eq!(within(&study, &records), [], "nothing is said of runs that failed");
    }

    /// Errors of half a per cent everywhere; four cells are the cheapest.
    fn within_one_percent(text: &str, change: impl Fn(&mut Record)) -> Option<WithinFinding> {
        let (study, mut records) = solved("s", text);
        for record in &mut records {
            record.errors.iter_mut().for_each(|row| row.value = 0.005);
            change(record);
        }
        within(&study, &records)[0].choices[0].clone()
    }

    /// MPM within 1 % with the shorter steps alone, or with the longer ones too; VP nowhere.
    #[test]
    fn the_longest_step_tried_is_told() {
        let text = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['MPM', 'VP']\n\
                    integrator = ['implicit']\ncells = [4]\ntime_step = [{ growth = 0.05 }, { growth = 0.1 }]\n";
        let (study, mut records) = solved("s", text);
        for (allowed, is_longest) in [(0.1, true), (0.05, false)] {
            for record in &mut records {
                let is_within = record.case.label().contains(&format!("growth={allowed}"));
                let error = match (&*record.case.method.to_string(), is_within) {
                    ("VP", _) => 0.3,
                    (_, is_within) => [0.5, 0.005][usize::from(is_within)],
                };
                record.errors.iter_mut().for_each(|row| row.value = error);
            }
            let answer = &within(&study, &records)[0];
            let choice = answer.choices[0].as_ref().expect("within");
            assert_eq!((&*choice.method, choice.is_longest_tried, answer.problems), ("MPM", is_longest, 1));
            assert_eq!(answer.choices[1], None);
        }
    }

    #[test]
    fn points_in_a_cell_and_integrators_have_a_column_where_runs_have_others() {
        for (points, told) in
            [("[2]", &["MPM", "4"][..]), ("[2, 3]", &["MPM", "4", "2"]), ("[3, 2]", &["MPM", "4", "2"])]
        {
            let text = format!(
                "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['MPM']\n\
                 integrator = ['implicit']\ncells = [4, 8]\npoints_per_cell = {points}\n"
            );
            let (study, mut records) = solved("s", &text);
            records.iter_mut().flat_map(|record| &mut record.errors).for_each(|row| row.value = 1e-4);
            let mut all = within(&study, &records);
            let shown = |table: Table| table.rows[0].iter().skip(2).map(Cell::show).collect::<Vec<_>>();
            assert_eq!(shown(table(&all))[..told.len()], *told, "{points}");
            all[0].choices[1].as_mut().expect("within").integrator = "explicit";
            let two = table(&all);
            assert_eq!(two.columns[3].header, "integrator");
            assert_eq!(shown(two)[..2], ["MPM", "implicit"], "{points}");
        }
    }

    #[test]
    fn one_problem_at_two_lists_of_times_does_not_stand_for_another_problem() {
        let sweep = |cells: usize, rest: &str| {
            format!("[[sweep]]\nmethod = ['MPM']\nintegrator = ['implicit']\ncells = [{cells}]\n{rest}\n")
        };
        let head = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1, 0.5]\n";
        let both = sweep(8, "youngs_modulus = [1e6, 1e7]");
        let twice = |modulus: &str| {
            let again = format!("youngs_modulus = [{modulus}]\ntime_factors = [0.2]");
            sweep(4, "youngs_modulus = [1e6]") + &sweep(4, &again)
        };
        for (modulus, cells) in [("1e6", 8), ("1e7", 4)] {
            let found = within_one_percent(&format!("{head}{both}{}", twice(modulus)), |_| ());
            assert_eq!(found.map(|choice| choice.cells), Some(cells), "{modulus}");
        }
    }

    #[test]
    fn beside_a_program_whose_work_is_not_counted_the_coarsest_mesh_stands_first() {
        let text = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['MPM']\n\
                    integrator = ['implicit']\ncells = [4, 8, 16]\n";
        let other = crate::case::solver::Attached::new("other", "0123456789abcdef").expect("a name");
        for outside in [4, 8, 16] {
            let found = within_one_percent(text, |record| {
                if record.case.cells == outside {
                    record.case.method = crate::case::SolverName::Attached(other);
                }
            });
            let found = found.expect("a choice");
            assert_eq!(found.cells, 4, "{outside} cells are another program's");
            // The steps of another program are not known.
            let has = [found.largest_step > 0.0, !found.integrator.is_empty()];
            assert_eq!(has, [outside != 4; 2], "{outside} cells are another program's");
        }
    }
}
