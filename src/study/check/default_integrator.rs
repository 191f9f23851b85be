//! The integrator where nothing names one: explicit, as the paper has it, unless that takes minutes where no wave
//! asks for short steps.

use crate::case::keys::{Key, Value};
use crate::case::work_estimate::estimated_seconds;
use crate::case::{Case, Task};
use crate::mpm::run::integrator::IntegratorKind;
use crate::study::check::checker::{Checker, Common};
use crate::study::diagnostic::Diagnostic;
use crate::study::file::SweepTable;
use crate::study::sweep::{Sweep, SweptKey};
use crate::wording::duration;

/// Estimated seconds of a case, on the machine of the constants, from which on nobody waits for a choice that
/// nobody made. Every shipped study whose sweeps name no integrator stays below it.
const LONGEST_BY_DEFAULT: f64 = 120.0;

/// Keys that say how steps are taken: who names one of them has chosen.
const CHOICES_OF_STEPS: [&str; 9] = [
    "integrator",
    "drag",
    "flip",
    "mapping_back",
    "affine",
    "stress_slopes",
    "formulation",
    "scheme",
    "time_step",
];

impl Checker<'_> {
    /// Takes the implicit integrator for a sweep that names none, where the explicit one would take minutes and
    /// nothing of the study asks for it. All cases of the sweep change, so that a series stays of one kind.
    pub(crate) fn default_integrator(
        &mut self,
        table: &SweepTable,
        start: usize,
        common: &Common,
        base: &Case,
        sweep: &mut Sweep,
    ) {
        let is_named = |key: &&str| {
            table.typed(key).is_some() || common.given.iter().any(|(given, _)| given.name == *key)
        };
        let Case { task, scene, .. } = *base;
        let key = Key::named("integrator", "sweep").filter(|_| task == Task::Solve && !scene.has_waves());
        let Some(key) = key.filter(|_| !CHOICES_OF_STEPS.iter().any(is_named)) else { return };
        let slowest =
            |sweep: &Sweep| sweep.cases(base).map(|case| estimated_seconds(&case)).fold(0.0, f64::max);
        let explicit = slowest(sweep);
        if explicit < LONGEST_BY_DEFAULT {
            return;
        }
        let place = sweep.keys.iter().position(|swept| swept.key.name != "method").unwrap_or(0);
        let implicit = IntegratorKind::Implicit.name();
        sweep.keys.insert(place, SweptKey { key, values: vec![Value::Word(implicit)] });
        let diagnostic = Diagnostic::at(
            start..start + 1,
            format!(
                "the sweep names no integrator, and `explicit` would take {} for its longest case: `{implicit}` is \
                 taken, {}",
                duration(explicit),
                duration(slowest(sweep)),
            ),
            format!(
                "write `integrator = [\"{implicit}\"]` to say so, or `integrator = [\"explicit\"]` to have it all the same"
            ),
        );
        self.warnings.push(diagnostic.warning(&self.source.name, &self.source.text));
    }
}
