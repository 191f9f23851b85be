//! Checks `[[sweep]]` blocks: their axes, the cases they multiply out to, and the integrators and labels of these. Sweeps are
//! lists of choices, multiplied out or tied to a path.

use crate::case::contender::{CONTENDERS, Contender, RACE};
use crate::case::work_estimate::estimated_seconds;
use crate::case::{Case, Key, PlannedCase, Task, Value};
use crate::study::Purpose;
use crate::study::check::doubts::{Basis, Complaint};
use crate::study::check::{Checker, Common};
use crate::study::diagnostic::Diagnostic;
use crate::study::file::{COMMAND_LINE, StudyFile, SweepTable};
use crate::study::inputs::{One, TypedInput};
use crate::study::reading::Placed;
use oedometer_problem::integrator::IntegratorKind;
use oedometer_scenes::scene::Body;
use oedometer_wording::duration;
use std::collections::HashMap;
use std::hash::{DefaultHasher, Hasher};
use std::ops::Range;
use std::sync::Arc;

/// Cases that a study may have, counted as its sweeps multiply out: as many as fit in memory and are still meant.
const MOST_CASES: usize = 1_000_000;
/// Memory that a case may ask for, bytes: a workstation's.
const MOST_BYTES: f64 = 32e9;
/// Estimated seconds of a case, on the machine of the constants, beyond which the explicit integrator is not chosen by
/// default. Every shipped study whose sweeps name no integrator stays below it.
const LONGEST_BY_DEFAULT: f64 = 120.0;

impl Checker<'_> {
    /// Runs a check of a block: once, or for every method where the block names the race. A method that the check
    /// refuses cannot run in this study, with the reason; a block that no method can run is a mistake of its own.
    pub(super) fn for_each_entry(
        &mut self,
        table: &SweepTable,
        mut check: impl FnMut(&mut Self, Option<&'static Contender>),
    ) {
        let is_race = |method: &One| matches!(&**method, TypedInput::MethodName(name) if name == RACE);
        if !matches!(table.inputs.list("method"), [method] if is_race(method)) {
            check(self, None);
            return;
        }
        self.is_race = true;
        let before = self.complaints.len();
        let mut refused: Vec<(&'static str, Vec<Complaint>)> = Vec::new();
        for contender in CONTENDERS.iter() {
            check(self, Some(contender));
            let complaints = self.complaints.split_off(before);
            if !complaints.is_empty() {
                refused.push((contender.name, complaints));
            }
        }
        if refused.len() == CONTENDERS.len() {
            self.complaints.extend(refused.swap_remove(0).1);
            return;
        }
        for (name, complaints) in refused {
            self.leave_out(
                name,
                complaints[0].diagnostic.message.split(": a case").next().unwrap_or_default(),
            );
        }
    }

    /// Leaves a method out of the race, with the first reason.
    pub(super) fn leave_out(&mut self, name: &'static str, why: &str) {
        if self.not_applicable.iter().all(|(known, _)| *known != name) {
            self.not_applicable.push((name, why.to_owned()));
        }
    }

    /// A block of cases, its axes checked one by one; the methods of a race are those of an entry.
    pub(super) fn sweep(
        &mut self,
        table: &SweepTable,
        start: &Range<usize>,
        common: &Common,
        entry: Option<&Contender>,
    ) -> Option<Sweep> {
        let scene = common.base.scene;
        let before = self.complaints.len();
        for (name, example) in [("method", "[\"GC-SRI-patch\"]"), ("cells", "[5, 10, 20]")] {
            if table.inputs.typed(name).is_none() {
                let message = format!("the sweep names no {name}");
                self.complain_by(
                    Basis::Lack(name),
                    start.clone(),
                    message,
                    format!("add `{name} = {example}`"),
                );
            }
        }
        let mut keys = Vec::new();
        for key in Key::in_table("sweep") {
            if let Some(value) =
                entry.filter(|_| key.name == "method").map(|entry| Value::Method(entry.method()))
            {
                let place = table.inputs.span(key.name).unwrap_or(start.clone());
                keys.extend(
                    self.entered(value, place, scene).map(|value| SweptKey { key, values: vec![value] }),
                );
            } else if let Some(typed) = table.inputs.typed(key.name) {
                self.is_filled(key.name, typed.span(), table.inputs.list(key.name).len());
                let value = |value: &One| self.input(key, value, key.name, &common.seed);
                let values = table.inputs.list(key.name).iter().filter_map(value).collect();
                keys.push(SweptKey { key, values });
            } else if let Some((_, value)) = common.given.iter().find(|(given, _)| *given == key) {
                // The study's own values stand with what is swept: an integrator would bring its own formulation.
                keys.push(SweptKey { key, values: vec![*value] });
            }
        }
        self.problem_takes(&table.inputs, scene);
        let names: Vec<&str> = Key::in_table("sweep").map(|key| key.name).collect();
        let mut path = Vec::new();
        if let Some(typed) = &table.path {
            self.is_filled("path", typed.span(), typed.len());
            path.extend(
                typed.iter().filter_map(|word| Some(names[self.word(word, "axis", &names)?].to_owned())),
            );
        }
        let sweep = Sweep { keys, path };
        if let (Some((key, length, first)), Some(path)) = (sweep.uneven_path(), &table.path) {
            self.complain(
                path.span(),
                format!(
                    "the zipped lists differ in length: `{key}` has {length} values, another has {first}"
                ),
                "lists in `path` are combined element by element: give them equal lengths",
            );
        }
        let is_sound = self.complaints.len() == before && self.can_be_multiplied_out(start, &sweep);
        is_sound.then_some(sweep)
    }

    fn is_filled(&mut self, name: &str, place: Range<usize>, length: usize) {
        if length == 0 {
            let help = "give at least one value, or leave the key out";
            self.complain(place, format!("`{name}` is empty"), help);
        }
    }

    /// Whether the sweeps so far have no more cases than a study may; a diagnostic where they do, before any is made.
    fn can_be_multiplied_out(&mut self, start: &Range<usize>, sweep: &Sweep) -> bool {
        let count = sweep.count();
        let so_far = self.multiplied_out;
        self.multiplied_out = count.map_or(usize::MAX, |count| so_far.saturating_add(count));
        if self.multiplied_out <= MOST_CASES {
            return true;
        }
        let others =
            if so_far > 0 { format!(", with {so_far} of the sweeps before it") } else { String::new() };
        let count =
            count.map_or("more cases than can be counted".to_owned(), |count| format!("{count} cases"));
        self.complain(
            start.clone(),
            format!("the sweep has {count}{others}"),
            format!(
                "a study has at most {MOST_CASES}: shorten its lists, zip axes with `path`, or split it into several"
            ),
        );
        false
    }

    /// Complains of cases that cannot be, of each reason once: where the input stands that is to blame.
    pub(super) fn cases_are_possible(
        &mut self,
        file: &StudyFile,
        (table, start): (&SweepTable, &Range<usize>),
        cases: impl Iterator<Item = Case>,
    ) {
        let place = |key: &str| {
            let of_study =
                [&file.points.inputs, &file.integrator.inputs, &file.material.inputs, &file.column.inputs];
            let of_study = || of_study.iter().find_map(|inputs| inputs.span(key));
            table.inputs.span(key).or_else(of_study)
        };
        let of_load = || ["load", "porosity", "youngs_modulus"].into_iter().find_map(place);
        let of_load = file.column.strain.as_ref().map(Placed::span).or_else(of_load);
        let of_load = of_load.unwrap_or(start.clone());
        let is_solved = self.purpose == Purpose::Solving;
        let mut refused: Vec<&str> = Vec::new();
        let mut gaps: HashMap<usize, String> = HashMap::new();
        let (mut has_water_points, mut has_end) = (false, true);
        let mut largest: Option<Case> = None;
        for case in cases {
            has_water_points |= case.column.points.has_two_sets();
            for refusal in case.refusals() {
                if !refused.contains(&refusal.why) {
                    refused.push(refusal.why);
                    self.complain(place(refusal.key).unwrap_or(start.clone()), refusal.why, refusal.help);
                }
            }
            if is_solved && has_end && self.complaints.is_empty() {
                has_end = !self.has_no_end(start, &of_load, &case);
            }
            if !is_solved || !case.has_integrator() {
                continue;
            }
            if case.column.cells_across(case.cells).is_none() {
                gaps.entry(case.cells).or_insert_with(|| gap_of(&case));
            }
            if largest.as_ref().is_none_or(|other| other.estimated_bytes() < case.estimated_bytes()) {
                largest = Some(case);
            }
        }
        for typed in table.inputs.list("cells") {
            let TypedInput::Count(cells) = **typed else { continue };
            if let Some(gap) = usize::try_from(cells).ok().and_then(|cells| gaps.get(&cells)) {
                let help = "use a number of cells that divides both sides into squares, or change a side";
                self.complain(typed.span(), gap.as_str(), help);
            }
        }
        let bytes = largest.as_ref().map_or(0.0, Case::estimated_bytes);
        if let Some(case) = largest.filter(|_| bytes > MOST_BYTES) {
            self.complain(
                place("cells").unwrap_or(start.clone()),
                format!(
                    "{} cells over the height with {} points per cell need about {:.0} GB of memory",
                    case.cells,
                    case.points_per_cell,
                    1e-9 * bytes
                ),
                format!("use fewer: {:.0} GB are the maximum", 1e-9 * MOST_BYTES),
            );
        }
        if let Some(place) = place("water_per_cell").filter(|_| !has_water_points) {
            self.complain(
                place,
                "`water_per_cell` needs two point sets, and every case has one set for both phases",
                "add `sets = 2`, or leave `water_per_cell` out",
            );
        }
    }

    /// Takes the implicit integrator for a sweep that names none, where the explicit one would take minutes and
    /// nothing in the study asks for it. All cases of the sweep change, so that a series stays of one kind.
    pub(super) fn default_integrator(
        &mut self,
        (table, start): (&SweepTable, &Range<usize>),
        common: &Common,
        complete: &dyn Fn(Case) -> Case,
        sweep: &mut Sweep,
    ) {
        // Who says how steps are taken has chosen.
        let is_chosen = Key::in_table("sweep")
            .filter(|key| key.is_of_integrator() || key.name == "time_step")
            .any(|key| {
                table.inputs.typed(key.name).is_some()
                    || common.given.iter().any(|(given, _)| given.name == key.name)
            });
        let Case { task, scene, .. } = common.base;
        let key = Key::named("integrator", "sweep").filter(|_| task == Task::Solve && !scene.waves);
        let Some(key) = key.filter(|_| !is_chosen && self.purpose == Purpose::Solving) else { return };
        let slowest = |sweep: &Sweep| {
            let cases = sweep.cases(&common.base);
            cases.map(|case| estimated_seconds(&complete(case))).fold(0.0, f64::max)
        };
        let explicit = slowest(sweep);
        if explicit < LONGEST_BY_DEFAULT {
            return;
        }
        let place = sweep.keys.iter().position(|swept| swept.key.name != "method").unwrap_or(0);
        let implicit = IntegratorKind::Implicit.name();
        sweep.keys.insert(place, SweptKey { key, values: vec![Value::Word(implicit)] });
        if self.source.name == COMMAND_LINE {
            let note =
                format!("no --integrator given; using {implicit} (explicit: about {})", duration(explicit));
            self.warnings.push(format!("note: {note}"));
            return;
        }
        self.warn(&Diagnostic::at(
            start.clone(),
            format!(
                "no integrator is given, and `explicit` would take {} for its longest case: `{implicit}` \
                 is used, {}",
                duration(explicit),
                duration(slowest(sweep)),
            ),
            format!(
                "write `integrator = [\"{implicit}\"]` to confirm it, or `integrator = [\"explicit\"]` to solve explicitly"
            ),
        ));
    }
}

/// What is said of cells that do not fill the width.
fn gap_of(case: &Case) -> String {
    let (column, size) = (&case.column, case.column.height / case.cells as f64);
    let side = if case.scene.body == Body::Layer { "length" } else { "width" };
    format!("square cells of {size} m do not fill a {side} of {} m", column.extent())
}

/// Makes every case name the inputs that only tell some of them apart by their hashes. Golden values, tables and
/// `explain` know a case by its label.
pub(super) fn tell_apart(planned: &mut [PlannedCase]) {
    // By the hash of its label: two labels with one hash make a name longer and no case another.
    let mut first_with: HashMap<u64, usize> = HashMap::new();
    // What is given in other words would tell the same twice.
    let own = || Key::in_table("sweep").filter(|key| key.in_place_of.is_empty());
    let mut alike_so_far: Vec<&Key> = own().collect();
    for (place, PlannedCase { case, .. }) in planned.iter().enumerate() {
        let mut hasher = DefaultHasher::new();
        hasher.write(case.label().as_bytes());
        let first = *first_with.entry(hasher.finish()).or_insert(place);
        if first != place {
            alike_so_far.retain(|key| key.get(&planned[first].case) == key.get(case));
        }
    }
    let differ = own().filter(|key| !alike_so_far.contains(key));
    let names: Arc<[&'static str]> = differ.map(|key| key.name).collect();
    for planned in planned {
        planned.case.swept = Arc::clone(&names);
    }
}

/// The place of the first letter of a block.
pub(super) fn start_of<T>(block: &Placed<T>) -> Range<usize> {
    let start = block.span().start;
    start..start + 1
}

/// The values of one key in a sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct SweptKey {
    /// The key.
    pub key: &'static Key,
    /// Its values in turn.
    pub values: Vec<Value>,
}

/// One block of a study, checked.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    /// What is varied, in the order of the table of keys: the slowest first.
    pub keys: Vec<SweptKey>,
    /// Keys that step together, by name.
    pub path: Vec<String>,
}

impl Sweep {
    /// A key of a path that has not as many values as its first, with both numbers: a path has one length.
    pub fn uneven_path(&self) -> Option<(String, usize, usize)> {
        let length = |name: &String| {
            self.keys.iter().find(|swept| swept.key.name == name).map_or(1, |swept| swept.values.len())
        };
        let first = length(self.path.first()?);
        self.path.iter().find_map(|name| {
            let values = length(name);
            (values != first).then(|| (name.clone(), values, first))
        })
    }

    fn is_tied(&self, at: usize) -> bool {
        self.path.iter().any(|name| name == self.keys[at].key.name)
    }

    /// The key at whose place the path counts as one: its first member.
    fn leader(&self) -> Option<usize> {
        (0..self.keys.len()).find(|at| self.is_tied(*at))
    }

    /// Keys that turn on their own, the slowest first.
    fn turning(&self) -> Vec<usize> {
        let leader = self.leader();
        (0..self.keys.len()).filter(|at| !self.is_tied(*at) || Some(*at) == leader).collect()
    }

    /// How many combinations there are; none where no machine could count them.
    pub fn count(&self) -> Option<usize> {
        let length = |at: usize| self.keys[at].values.len();
        self.turning().into_iter().try_fold(1_usize, |count, at| count.checked_mul(length(at)))
    }

    /// A case for every combination, the first key slowest; other inputs are those of `base`. The keys of a path
    /// vary together. `None` if they cannot be counted.
    pub fn cases(&self, base: &Case) -> impl Iterator<Item = Case> {
        let (turning, leader) = (self.turning(), self.leader());
        (0..self.count().unwrap_or(0)).map(move |number| {
            let mut place = vec![0; self.keys.len()];
            let mut rest = number;
            for at in turning.iter().rev() {
                place[*at] = rest % self.keys[*at].values.len();
                rest /= self.keys[*at].values.len();
            }
            let mut case = base.clone();
            for (at, swept) in self.keys.iter().enumerate() {
                let tied = leader.filter(|_| self.is_tied(at));
                swept.key.set(&mut case, swept.values[tied.map_or(place[at], |leader| place[leader])]);
            }
            case
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::Task;
    use oedometer_problem::method::Method;
    use oedometer_problem::time_step::TimeStep;
    use oedometer_scenes::TERZAGHI;

    const STEPS: [f64; 3] = [4e-6, 2e-6, 1e-6];

    fn swept(name: &str, values: Vec<Value>) -> SweptKey {
        SweptKey { key: Key::named(name, "sweep").expect("a key"), values }
    }

    fn sweep(path: &[&str]) -> Sweep {
        let methods = ["GIMP", "GC-SRI-patch"].iter().filter_map(|name| Method::named(name));
        Sweep {
            keys: vec![
                swept("method", methods.map(|method| Value::Method(method.into())).collect()),
                swept("cells", [5, 10, 20].map(Value::Count).to_vec()),
                swept("time_step", STEPS.map(|s| Value::TimeStep(TimeStep::Seconds(s))).to_vec()),
            ],
            path: path.iter().map(|key| (*key).to_owned()).collect(),
        }
    }

    fn cases(sweep: &Sweep) -> Vec<Case> {
        sweep.cases(&Case::seed(Task::Solve, &TERZAGHI)).collect()
    }

    #[test]
    fn a_product_has_every_combination_once() {
        let all = cases(&sweep(&[]));
        assert_eq!(all.len(), 2 * 3 * 3);
        for (index, case) in all.iter().enumerate() {
            assert!(!all[..index].contains(case));
        }
    }

    #[test]
    fn a_path_steps_its_axes_together() {
        let tied = sweep(&["cells", "time_step"]);
        assert_eq!(cases(&tied).len(), 2 * 3);
        assert_eq!(tied.count(), Some(2 * 3));
        for case in cases(&tied) {
            let place = [5, 10, 20].iter().position(|cells| *cells == case.cells);
            assert_eq!(place.map(|place| TimeStep::Seconds(STEPS[place])), Some(case.time_step));
        }
    }

    #[test]
    fn more_combinations_than_can_be_counted_are_none_and_no_few() {
        let many = |length: usize| {
            let mut many = sweep(&["time_step", "method"]);
            many.keys[1].values = vec![Value::Count(5); length];
            for name in ["porosity", "flip", "offset", "poissons_ratio", "water_bulk_modulus", "gravity"] {
                many.keys.push(swept(name, vec![Value::Number(0.3); length]));
            }
            many.keys.push(swept("mapping_back", vec![Value::Flag(true); length]));
            many
        };
        // Eight axes of 256 values wrap a product of 64 bits to nothing.
        assert_eq!(many(256).count(), None);
        assert_eq!(cases(&many(256)).len(), 0);
        assert_eq!(many(2).count(), Some(256 * 2));
    }

    #[test]
    fn an_uneven_path_is_named() {
        let mut uneven = sweep(&["cells", "time_step"]);
        uneven.keys[2].values.pop();
        assert_eq!(uneven.uneven_path(), Some(("time_step".to_owned(), 2, 3)));
        uneven.path.reverse();
        assert_eq!(uneven.uneven_path(), Some(("cells".to_owned(), 3, 2)), "the longer list second");
        assert_eq!(sweep(&["cells", "time_step"]).uneven_path(), None);
    }

    /// Integrators of the cases of a sweep, and what is warned of.
    fn integrators(sweep: &str, tables: &str) -> (Vec<IntegratorKind>, String) {
        let text = format!(
            "title = \"t\"\nscene = \"terzaghi\"\n{tables}\n[[sweep]]\nmethod = [\"MPM\"]\n{sweep}\n"
        );
        let source = crate::study::file::StudySource { name: "t.toml".to_owned(), text };
        let study = crate::study::check::Study::check(&source).expect("sound");
        let all = study.planned.iter().map(|planned| planned.case.integrator).collect();
        (all, study.warnings.join("\n"))
    }

    #[test]
    fn one_case_that_would_take_minutes_makes_its_whole_sweep_implicit_wherever_it_stands() {
        use IntegratorKind::{Explicit, Implicit};
        let told = |warnings: &str| warnings.contains("no integrator is given");
        for list in ["[640, 5, 10]", "[5, 640, 10]", "[5, 10, 640]"] {
            let (found, warnings) = integrators(&format!("cells = {list}"), "");
            assert_eq!(found, [Implicit; 3], "{list}");
            assert!(told(&warnings), "{warnings}");
        }
        let (found, warnings) = integrators("cells = [5, 10, 20]", "");
        assert_eq!(found, [Explicit; 3]);
        assert!(!told(&warnings), "{warnings}");
        // By another axis than the cells, and from either end of its list.
        for list in ["[1e-9, 1e-3]", "[1e-3, 1e-9]"] {
            let (found, warnings) =
                integrators(&format!("cells = [40]\nhydraulic_conductivity = {list}"), "");
            assert_eq!((found.len(), told(&warnings)), (2, true), "{list}: {warnings}");
            assert!(found.iter().all(|kind| *kind == Implicit), "{list}: {found:?}");
        }
        // Who says how steps are taken has chosen.
        for (sweep, tables) in [
            ("integrator = [\"explicit\"]", ""),
            ("time_step = [{ stable = 0.5 }]", ""),
            ("drag = [\"explicit\"]", ""),
            ("", "integrator.flip = 0.9"),
        ] {
            let (found, warnings) = integrators(&format!("cells = [5, 640]\n{sweep}"), tables);
            assert_eq!(found, [Explicit; 2], "{sweep}{tables}");
            assert!(!told(&warnings), "{sweep}{tables}: {warnings}");
        }
    }
}
