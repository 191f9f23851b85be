//! Checks when results are kept and judged: time factors, and times in units of the clock.

use crate::case::complete_states::SAME_TIME;
use crate::case::{Case, PlannedCase, Shared};
use crate::study::check::Checker;
use crate::study::check::doubts::Basis;
use crate::study::expectation::Selection;
use crate::study::reading::{Placed, Typed};
use oedometer_wording::{clock_time, count_of, duration, typed};
use std::ops::{Range, RangeInclusive};

/// Least time factor beside the undrained start: of shorter times steps no longer advance the sum.
const LEAST_TIME_FACTOR: f64 = 1e-15;
/// Time factors that a case may reach; a column is consolidated at 2.
const TIME_FACTORS: RangeInclusive<f64> = LEAST_TIME_FACTOR..=100.0;

/// When a block of cases keeps its results.
pub(super) struct Outputs {
    /// `T_v = c_v t/H²`, in ascending order.
    factors: Shared<Vec<f64>>,
    /// Times, s, with their places; each case has its time factors for them.
    times: Vec<(Range<usize>, f64)>,
}

impl Outputs {
    /// Outputs at time factors alone.
    pub(super) fn at_factors(factors: Vec<f64>) -> Self {
        Self { factors: factors.into(), times: Vec::new() }
    }

    /// The time factors at which a case keeps its results.
    pub(super) fn of_case(&self, case: &Case) -> Shared<Vec<f64>> {
        if self.times.is_empty() {
            return self.factors.clone();
        }
        let from_times = self.times.iter().map(|(_, time)| factor_of(*time, case));
        in_order(self.factors.iter().copied().chain(from_times).collect()).into()
    }
}

/// The time factor of a case at a time, s.
fn factor_of(time: f64, case: &Case) -> f64 {
    time / case.seconds_per_time_factor() + 0.0
}

/// The output that a typed time factor stands for, which may have fewer digits: the same one, or else the only one within
/// [`SAME_TIME`] of it; the typed one where there is none or more than one.
pub fn output_at<'a>(typed: f64, cases: impl Iterator<Item = &'a Case>) -> f64 {
    let outputs = in_order(cases.flat_map(|case| case.time_factors.iter().copied()).collect());
    let is_near = |output: &f64| (output - typed).abs() <= SAME_TIME * typed;
    match outputs.iter().filter(|output| is_near(output)).collect::<Vec<_>>()[..] {
        [only] => *only,
        _ => typed,
    }
}

fn in_order(mut factors: Vec<f64>) -> Vec<f64> {
    factors.sort_by(f64::total_cmp);
    factors.dedup();
    factors
}

impl Checker<'_> {
    /// The outputs that a table names; none where it names neither time factors nor times.
    #[expect(clippy::ref_option, reason = "as the file of a study has it")]
    pub(super) fn outputs(
        &mut self,
        factors: &Typed<Vec<Placed<f64>>>,
        times: &Typed<Vec<Placed<f64>>>,
    ) -> Option<Outputs> {
        if factors.is_none() && times.is_none() {
            return None;
        }
        let factors = factors.as_ref().map(|list| self.time_factors(list)).unwrap_or_default();
        let times = times.as_ref().map(|list| self.times(list)).unwrap_or_default();
        Some(Outputs { factors: factors.into(), times })
    }

    fn time_factors(&mut self, list: &Placed<Vec<Placed<f64>>>) -> Vec<f64> {
        if list.is_empty() {
            self.complain(list.span(), "no time factor", "name at least one, like [0.05, 0.1, 0.2]");
        }
        let mut factors = Vec::new();
        for typed in list.iter() {
            let factor = **typed;
            if factor == 0.0 || TIME_FACTORS.contains(&factor) {
                factors.push(factor + 0.0);
                continue;
            }
            let help = if factor > 0.0 && factor < 1.0 {
                format!("it is too early for any step: use 0, or {LEAST_TIME_FACTOR:e} and later")
            } else {
                "T_v = c_v t/H² lies between 0 and 100; at 2 the column is consolidated".to_owned()
            };
            let is_short = (1e-6..1e16).contains(&factor.abs());
            let size = if is_short { factor.to_string() } else { format!("{factor:?}") };
            self.complain(typed.span(), format!("a time factor of {size}"), help);
        }
        in_order(factors)
    }

    fn times(&mut self, list: &Placed<Vec<Placed<f64>>>) -> Vec<(Range<usize>, f64)> {
        if list.is_empty() {
            self.complain(list.span(), "no time", "name at least one, like [\"30 days\", \"1 year\"]");
        }
        let mut times = Vec::new();
        for time in list.iter() {
            if **time >= 0.0 && time.is_finite() {
                times.push((time.span(), **time));
            } else {
                let message = format!("a time of {} s", typed(**time));
                self.complain(time.span(), message, "0 is the undrained start, later times are positive");
            }
        }
        times
    }

    /// Complains of times that lie before or beyond what a case can reach: at the first one, with the number of the others.
    pub(super) fn times_are_possible(&mut self, outputs: &Outputs, cases: impl Iterator<Item = Case>) {
        for case in cases {
            let factor = |time: f64| factor_of(time, &case);
            let is_impossible = |time: f64| time > 0.0 && !TIME_FACTORS.contains(&factor(time));
            let mut impossible = outputs.times.iter().filter(|(_, time)| is_impossible(*time));
            let Some((place, time)) = impossible.next() else { continue };
            let others = match impossible.count() {
                0 => String::new(),
                count => {
                    format!(", and {} impossible too", count_of(count, "other time is", "other times are"))
                }
            };
            let unit = case.seconds_per_time_factor();
            let message =
                format!("{} ({} s) is T_v = {:.3e}{others}", clock_time(*time), typed(*time), factor(*time));
            let whose = if case.column.soils.is_empty() {
                "for this soil and height"
            } else {
                "for the soil of [material] over the whole height: give the soil of a typical layer there, too"
            };
            let help = format!(
                "T_v = c_v t/H² lies between 0 and 100, and T_v = 1 is {} ({unit:.3e} s) {whose}",
                duration(unit)
            );
            self.complain(place.clone(), message, help);
            return;
        }
    }

    /// The time factor that an expectation names, by itself or by a time; none, with a diagnostic, where it names
    /// neither, both, or a time that is several time factors.
    pub(super) fn expected_time_factor(
        &mut self,
        [factor, time]: [&Typed<f64>; 2],
        place: Range<usize>,
        (selection, axis): (&Selection, &str),
        planned: &[PlannedCase],
    ) -> Option<f64> {
        let time = match (factor, time) {
            (Some(factor), None) => {
                let cases = planned.iter().map(|planned| &planned.case);
                return Some(output_at(**factor, cases.filter(|case| selection.fits_along(axis, case))));
            }
            (None, Some(time)) => time,
            (None, None) => {
                let help = "add `time_factor = 0.1`, or a time like `time = \"30 days\"`";
                self.complain_by(Basis::Lack("time"), place, "the expectation names no time factor", help);
                return None;
            }
            (Some(_), Some(time)) => {
                self.complain(
                    time.span(),
                    "the expectation names both a time and a time factor",
                    "name one of them",
                );
                return None;
            }
        };
        let cases = planned.iter().map(|planned| &planned.case);
        let cases = cases.filter(|case| selection.fits_along(axis, case));
        let factors = in_order(cases.map(|case| factor_of(**time, case)).collect());
        match factors.as_slice() {
            [factor] => Some(*factor),
            // That no case is named has a diagnostic of its own.
            [] => Some(f64::NAN),
            [first, .., last] => {
                self.complain_by(
                    Basis::Times,
                    time.span(),
                    format!(
                        "{} s is T_v = {first:.3e} to {last:.3e} in the cases of this expectation",
                        typed(**time)
                    ),
                    "name the soil and height that are meant, or the `time_factor`",
                );
                None
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::study::Study;
    use crate::study::file::StudySource;

    /// A study with an output table, a sweep and the rest of the file.
    fn checked(output: &str, sweep: &str, rest: &str) -> Result<Study, String> {
        let text = format!(
            "title = 't'\nscene = 'terzaghi'\n[material]\nhydraulic_conductivity = '1e-9 m/s'\n[output]\n{output}\n\
             [[sweep]]\nmethod = ['MPM']\nintegrator = ['implicit']\ncells = [5, 10, 20]\n{sweep}\n{rest}"
        );
        let source = StudySource { name: "t.toml".to_owned(), text };
        Study::check(&source).map_err(|error| {
            error
                .diagnostics
                .iter()
                .map(|complaint| {
                    format!("{}; {}", complaint.message, complaint.help.clone().unwrap_or_default())
                })
                .collect::<Vec<_>>()
                .join("\n")
        })
    }

    #[test]
    fn times_are_time_factors_of_each_soil() {
        // c_v = k E_oed/γ_w of E = 1 MPa, ν = 0.25: 1.2e6/9810 k.
        let per_day = 86_400.0 * 1e-9 * 1.2e6 / 9810.0;
        let study = checked("times = ['30 days', 86400]\ntime_factors = [0, 0.5]", "", "").expect("a study");
        let factors = study.planned[0].case.time_factors.to_vec();
        for (factor, right) in factors.iter().zip([0.0, per_day, 30.0 * per_day, 0.5]) {
            assert!((factor - right).abs() <= 1e-14 * right, "{factors:?}");
        }
        assert_eq!(factors.len(), 4);
        let study =
            checked("times = ['1 day']", "hydraulic_conductivity = [1e-9, 2e-9]", "").expect("a study");
        let mut factors: Vec<f64> =
            study.planned.iter().flat_map(|planned| planned.case.time_factors.to_vec()).collect();
        factors.sort_by(f64::total_cmp);
        factors.dedup();
        assert!(factors.len() == 2 && (factors[1] / factors[0] - 2.0).abs() < 1e-14, "{factors:?}");
        let study = checked("time_factors = [0.3]", "times = ['1 d']", "").expect("a study");
        assert!((study.planned[0].case.time_factors[0] - per_day).abs() < 1e-15);
    }

    #[test]
    fn an_expectation_names_its_time_and_an_error_in_per_cent() {
        let at = "[[expect]]\nmethod = 'MPM'\ntime = '30 days'\nat = { cells = 20, below = '2.5 %' }";
        let study = checked("times = ['30 days']", "", at).expect("a study");
        let expectation = &study.expectations[0];
        assert!(study.planned[0].case.time_factors.contains(&expectation.measure.time_factor));
        assert_eq!(expectation.demand.at.map(|bound| bound.below), Some(0.025));
        // Of several soils and meshes that of the one that it selects, whichever axis its series runs along.
        for (place, soil) in [1e-9, 2e-9].into_iter().enumerate() {
            let at = format!(
                "[[expect]]\nmethod = 'MPM'\nhydraulic_conductivity = {soil}\ntime = '30 days'\n\
                 order = {{ value = 1.0 }}"
            );
            let study = checked("times = ['30 days']", "hydraulic_conductivity = [1e-9, 2e-9]", &at);
            let found = study.expect("one soil").expectations[0].measure.time_factor;
            let right = 30.0 * 86_400.0 * soil * 1.2e6 / 9810.0;
            assert!((found / right - 1.0).abs() < 1e-14, "{place}: {found} for {right}");
        }
    }

    /// 30 days are `T_v` = 0.31706; two outputs within a thousandth of each other are told apart by all digits only.
    #[test]
    fn a_time_factor_of_few_digits_names_the_output_near_it() {
        let per_day = 86_400.0 * 1e-9 * 1.2e6 / 9810.0;
        let expect = |factor: &str| {
            format!("[[expect]]\nmethod = 'MPM'\ntime_factor = {factor}\nat = {{ cells = 20, below = 0.1 }}")
        };
        for (output, factor, right) in [
            ("times = ['30 days']", "0.3171", Some(30.0 * per_day)),
            ("times = ['30 days']", "0.318", None),
            ("time_factors = [0.1, 0.10005]", "0.10005", Some(0.10005)),
            ("time_factors = [0.1, 0.10005]", "0.1", Some(0.1)),
            ("time_factors = [0.1, 0.10005]", "0.10002", None),
            ("time_factors = [0]", "0", Some(0.0)),
        ] {
            let study = checked(output, "", &expect(factor));
            match (study, right) {
                (Ok(study), Some(right)) => {
                    let found = study.expectations[0].measure.time_factor;
                    assert!((found - right).abs() <= 1e-14 * right, "{factor}: {found}");
                    assert!(study.planned[0].case.time_factors.contains(&found), "{factor}");
                }
                (Err(told), None) => assert!(told.contains("no case has an output at T_v"), "{told}"),
                (study, _) => panic!("{output}, {factor}: {:?}", study.map(|_| "sound")),
            }
        }
    }

    #[test]
    fn times_that_cannot_be_are_refused_with_what_would_be_right() {
        let expect = |time: &str| format!("[[expect]]\nmethod = 'MPM'\n{time}\norder = {{ value = 1.0 }}");
        for (output, sweep, rest, said) in [
            ("times = []", "", String::new(), "no time; name at least one"),
            ("times = ['30 kPa']", "", String::new(), "is not a unit for a quantity in s"),
            ("times = [-5.0]", "", String::new(), "a time of -5 s; 0 is the undrained start"),
            (
                "times = ['9000 years']",
                "",
                String::new(),
                "T_v = 3.474e4; T_v = c_v t/H² lies between 0 and 100",
            ),
            (
                "times = ['1 day', '9000 years', '9999 years']",
                "",
                String::new(),
                "(284018400000 s) is T_v = 3.474e4, and 1 other time is impossible too; T_v",
            ),
            ("times = ['1 day']", "", expect("time = '2 days'"), "no case has an output at T_v"),
            (
                "times = ['1 day']",
                "",
                expect("time = '1 day'\ntime_factor = 0.1"),
                "names both a time and a time factor",
            ),
            ("times = ['1 day']", "", expect(""), "names no time factor; add `time_factor = 0.1`, or a time"),
            (
                "times = ['1 day']",
                "hydraulic_conductivity = [1e-9, 2e-9]",
                expect("time = '1 day'"),
                "name the soil",
            ),
            (
                "time_factors = [0.1]",
                "",
                expect("time_factor = 0.1\nat = { cells = 20, below = '1 kPa' }"),
                "not a percentage",
            ),
        ] {
            let complaints = checked(output, sweep, &rest).map(|_| ()).expect_err(output);
            assert!(complaints.contains(said), "{output} {sweep} {rest}: {complaints}");
        }
    }
}
