//! The integrator where nothing names one: explicit, as the paper has it, unless that takes minutes where no wave
//! asks for short steps.

use crate::case::keys::{Key, Value};
use crate::case::work_estimate::estimated_seconds;
use crate::case::{Case, Task};
use crate::study::check::checker::{Checker, Common};
use crate::study::diagnostic::Diagnostic;
use crate::study::file::SweepTable;
use crate::study::sweep::{Sweep, SweptKey};
use oedometer_mpm::run::integrator::IntegratorKind;
use oedometer_soil::wording::duration;

/// Estimated seconds of a case, on the machine of the constants, from which on nobody waits for a choice that
/// nobody made. Every shipped study whose sweeps name no integrator stays below it.
const LONGEST_BY_DEFAULT: f64 = 120.0;

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
        // Who says how steps are taken has chosen.
        let is_chosen =
            Key::of("sweep").filter(|key| key.is_of_integrator() || key.name == "time_step").any(|key| {
                table.typed(key.name).is_some()
                    || common.given.iter().any(|(given, _)| given.name == key.name)
            });
        let Case { task, scene, .. } = *base;
        let key = Key::named("integrator", "sweep").filter(|_| task == Task::Solve && !scene.has_waves());
        let Some(key) = key.filter(|_| !is_chosen) else { return };
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
