//! Combinations of inputs that are invalid although each input alone is valid, with the reason.

use crate::{Case, Task};
use oedometer_problem::integrator::{Formulation, IntegratorKind};
use oedometer_problem::method::{Basis, Configuration, Memory, Method};
use oedometer_problem::settings::Drag;
use oedometer_problem::time_step::TimeStepRule;
use oedometer_scenes::SceneKind;
use oedometer_scenes::column::Undrained;
use oedometer_soil::conductivity::ConductivityMean;

/// Why a case cannot be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Refusal {
    /// The input to blame, by its key.
    pub key: &'static str,
    /// A sentence.
    pub why: &'static str,
    /// What would be possible.
    pub help: &'static str,
}

const OWN_BLOCK: &str = "give each integrator a [[sweep]] block of its own, or zip both axes with `path`";
const NAME_THE_STEP: &str = "name the step: `time_step = [{ courant = 0.4 }]`, or in seconds";

/// A refusal with its reason, if there is one.
fn refusal(key: &'static str, why: Option<&'static str>, help: &'static str) -> Option<Refusal> {
    why.map(|why| Refusal { key, why, help })
}

/// A refusal if a condition holds.
fn refusal_if(key: &'static str, is_so: bool, why: &'static str, help: &'static str) -> Option<Refusal> {
    refusal(key, is_so.then_some(why), help)
}

impl Case {
    /// Every reason why the case cannot be.
    pub fn refusals(&self) -> impl Iterator<Item = Refusal> {
        let case = self.without_idle_choices();
        let Some(method) = case.method.built_in() else {
            let refusal = refusal_if(
                "task",
                case.task == Task::Stability,
                "the critical step of an attached solver cannot be searched",
                "name methods of this program alone, or leave `task` out",
            );
            return vec![refusal].into_iter().flatten();
        };
        let choices = Choices::new(&case, method);
        let mut refusals = choices.refusals_of_scheme().to_vec();
        refusals.extend(choices.refusals_of_points());
        refusals.extend(choices.refusals_of_two_sets());
        refusals.extend(choices.refusals_of_footing());
        refusals.extend(choices.refusals_of_soils());
        refusals.into_iter().flatten()
    }
}

/// The choices of a case that is solved by a method of this program. Its functions are tables: one row per limit.
struct Choices<'a> {
    case: &'a Case,
    method: Method,
    configuration: Configuration,
    is_explicit: bool,
    has_two_sets: bool,
}

impl<'a> Choices<'a> {
    fn new(case: &'a Case, method: Method) -> Self {
        Self {
            case,
            method,
            configuration: method.configuration_in(case.scene.configuration()),
            is_explicit: case.integrator == IntegratorKind::Explicit,
            has_two_sets: case.column.points.has_two_sets(),
        }
    }

    /// Time steps, integrators and formulations that a case cannot have.
    fn refusals_of_scheme(&self) -> [Option<Refusal>; 6] {
        let Case { scene, integrator, formulation, settings, .. } = self.case;
        let no_inertia = scene.needs_inertia() && *formulation == Formulation::QuasiStatic;
        [
            refusal("time_step", integrator.refuses_rule(self.case.time_step), OWN_BLOCK),
            refusal(
                "integrator",
                scene.refuses_integrator(*integrator),
                "take `integrator = [\"explicit\"]`, or leave the key out",
            ),
            refusal_if(
                "integrator",
                self.case.task == Task::Stability && !self.is_explicit,
                "the critical step is searched with explicit steps",
                "take `integrator = [\"explicit\"]`, or leave the key out",
            ),
            refusal(
                "formulation",
                integrator.refuses_formulation(*formulation),
                "give each integrator a [[sweep]] block of its own, or leave `formulation` out",
            ),
            refusal_if(
                "formulation",
                no_inertia,
                "the quasi-static formulation leaves out the waves that this scene is about",
                "take \"v-w\" or \"u-p\", or the scene \"terzaghi\"",
            ),
            refusal_if(
                "drag",
                *scene == SceneKind::SealedElement
                    && *integrator == IntegratorKind::Explicit
                    && settings.drag == Drag::Explicit,
                "explicit drag in a nearly impermeable soil needs steps below 1e-12 of those of the waves",
                "take `drag = \"implicit\"`",
            ),
        ]
    }

    /// Features of explicitly moving points, and arrangements of points.
    fn refusals_of_points(&self) -> [Option<Refusal>; 6] {
        let Case { settings, column, time_step, .. } = self.case;
        let (points, by_limit) = (&column.points, matches!(time_step, TimeStepRule::Stable(_)));
        let has_moving_points = self.is_explicit && self.configuration.moves_points() && !self.has_two_sets;
        let has_domains = has_moving_points && self.method.basis == Basis::Cpgimp;
        [
            refusal_if(
                "affine",
                settings.affine && !has_moving_points,
                "APIC needs points that move by explicit steps, in one set: a case of this sweep has none",
                "leave `affine` out there, or give those methods and integrators a [[sweep]] block of their own",
            ),
            refusal_if(
                "affine",
                settings.affine && has_moving_points && by_limit,
                "the critical step with APIC is not predicted: `stable` cannot be used",
                NAME_THE_STEP,
            ),
            refusal_if(
                "stress_slopes",
                settings.stress_slopes && !has_domains,
                "stress slopes need GIMP domains that follow points which move by explicit steps, in one set: a case \
                 of this sweep has no such domains",
                "leave `stress_slopes` out there, or give those methods and integrators a [[sweep]] block of their own",
            ),
            refusal_if(
                "stress_slopes",
                settings.stress_slopes && has_domains && by_limit,
                "the critical step with stress slopes is not predicted: `stable` cannot be used",
                NAME_THE_STEP,
            ),
            refusal_if(
                "offset",
                column.self_weight && points.offset != 0.0,
                "domains shifted off their lattice do not integrate a weight exactly: the column would flow from the \
                 start",
                "leave `offset` out, or take `self_weight = false`",
            ),
            refusal_if(
                "alternating",
                points.alternating && column.dimensions > 1,
                "cells with unequal numbers of points are those of a column in one dimension",
                "leave `alternating` out, or take a column with `dimensions = 1`",
            ),
        ]
    }

    /// Methods and scenes that two point sets exclude.
    fn refusals_of_two_sets(&self) -> [Option<Refusal>; 7] {
        let &Self { case: Case { scene, .. }, method, configuration, is_explicit, has_two_sets: two } = self;
        let moves = configuration == Configuration::Updated;
        [
            refusal_if(
                "sets",
                two && !is_explicit,
                "double-point MPM is integrated explicitly only",
                "take the integrator \"explicit\", or `sets = 1`",
            ),
            refusal_if(
                "sets",
                two && configuration == Configuration::Total,
                "shape functions on the initial configuration stay with the skeleton, and a second point set does not",
                "take a method without the prefix TL-, or `sets = 1`",
            ),
            refusal_if(
                "sets",
                two && method.has_projection(),
                "the projection needs pressures at the points of the skeleton",
                "take the method \"VP\", or `sets = 1`",
            ),
            refusal_if(
                "sets",
                two && method.memory == Memory::Cells && configuration != Configuration::Frozen,
                "cell averages need points that carry both phases, and here are two point sets",
                "take a method without the suffix -cells, or `sets = 1`",
            ),
            refusal_if(
                "sets",
                two && moves && !matches!(method.basis, Basis::Cpgimp | Basis::Cpdi),
                "the domains of water points follow the water where points move, and the domains of this basis do not",
                "take the basis \"cpgimp\" or \"cpdi\", or `sets = 1`",
            ),
            refusal_if(
                "sets",
                two && *scene == SceneKind::Mandel,
                "a rigid plate is tied to one point set",
                "take another scene, or `sets = 1`",
            ),
            refusal_if(
                "sets",
                two && *scene == SceneKind::Footing,
                "the water under a footing stays with its soil",
                "take another scene, or `sets = 1`",
            ),
        ]
    }

    /// Limits of the footing.
    fn refusals_of_footing(&self) -> [Option<Refusal>; 4] {
        let (Case { scene, formulation, column, cells, .. }, method) = (self.case, self.method);
        [
            refusal_if(
                "cells",
                *scene == SceneKind::Footing && cells % 2 == 1,
                "an odd number of cells under a footing: half of it is solved, and its middle lies on a node",
                "take an even number",
            ),
            refusal_if(
                "plate_width",
                *scene == SceneKind::Footing && column.footing.width >= 2.0 * column.extent(),
                "the layer ends under the footing: half of the footing lies on it",
                "make `length` more than half of `plate_width`: 2.5 times `plate_width` is enough",
            ),
            refusal_if(
                "formulation",
                *scene == SceneKind::Footing && *formulation != Formulation::QuasiStatic,
                "a footing is quasi-static: it has no inertia",
                "leave `formulation` out",
            ),
            refusal_if(
                "method",
                *scene == SceneKind::Footing
                    && column.footing.undrained == Undrained::TotalStress
                    && method.strain.with_bbar().is_none(),
                "the composite gradient between domain ends has no volume of its own: total stress needs one",
                "take another method, or `undrained = \"two-phase\"`",
            ),
        ]
    }

    /// Limits of layers, self-weight and the chord mean, alone and with two point sets.
    fn refusals_of_soils(&self) -> [Option<Refusal>; 5] {
        let (Case { scene, column, material, .. }, two) = (self.case, self.has_two_sets);
        let chord = material.conductivity_mean == ConductivityMean::Chord;
        let off_lattice = column.points.jitter != 0.0 || column.points.offset != 0.0;
        [
            refusal_if(
                "conductivity_mean",
                chord && !column.soils.is_empty(),
                "the chord mean is taken along the compression of one soil, and the column has layers",
                "take `conductivity_mean = \"points\"`",
            ),
            refusal_if(
                "sets",
                two && (*scene == SceneKind::Layered || !column.soils.is_empty()),
                "two point sets take one soil",
                "take another scene, or `sets = 1`",
            ),
            refusal_if(
                "sets",
                two && column.self_weight,
                "the weight of a column needs points that carry both phases",
                "leave `self_weight` out, or take `sets = 1`",
            ),
            refusal_if(
                "sets",
                two && chord,
                "the chord mean is taken over points that carry both phases",
                "take `conductivity_mean = \"points\"`, or `sets = 1`",
            ),
            refusal_if(
                "sets",
                two && off_lattice,
                "shifted domains of the water do not end where the soil does",
                "leave `offset` and `jitter` out, or take `sets = 1`",
            ),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use oedometer_soil::layers::{SoilLayer, SoilLayers};

    #[test]
    fn choices_of_moving_points_are_refused_where_points_move_and_the_solver_ignores_them() {
        use IntegratorKind::{Explicit, Implicit, SemiImplicit};
        use SceneKind::XieLeo;
        // Scene, method, integrator, point sets; then whether APIC and stress slopes are taken there.
        for (scene, method, integrator, sets, takes_affine, takes_slopes) in [
            (XieLeo, "GIMP", Explicit, 1, true, true),
            (XieLeo, "GC-SRI-patch", Explicit, 1, true, true),
            (XieLeo, "uGIMP", Explicit, 1, true, false),
            (XieLeo, "MPM", Explicit, 1, true, false),
            (XieLeo, "CPDI-SRI-patch", Explicit, 1, true, false),
            (XieLeo, "GIMP", Explicit, 2, false, false),
            (XieLeo, "GIMP", Implicit, 1, false, false),
            (XieLeo, "GIMP", SemiImplicit, 1, false, false),
            (XieLeo, "TL-GIMP", Explicit, 1, false, false),
        ] {
            let refused = |affine, stress_slopes, time_step| {
                let mut case = Case::seed(Task::Solve, scene);
                case.method = Method::named(method).expect("a method").into();
                (case.integrator, case.formulation) = (integrator, integrator.default_formulation());
                case.time_step = time_step;
                case.column.points.sets = sets;
                (case.settings.affine, case.settings.stress_slopes) = (affine, stress_slopes);
                let with_step_named = |refusal: Refusal| (refusal.key, refusal.help == NAME_THE_STEP);
                case.refusals().map(with_step_named).collect::<Vec<_>>()
            };
            let place = format!("{scene:?} {method} {integrator:?} {sets}");
            let (by_hand, by_limit) = (TimeStepRule::Seconds(1.0), TimeStepRule::Stable(0.5));
            let wanted = |key, is_taken: bool, is_by_limit: bool| {
                (!is_taken || is_by_limit).then_some((key, is_taken)).into_iter().collect::<Vec<_>>()
            };
            for (rule, is_by_limit) in [(by_hand, false), (by_limit, true)] {
                assert_eq!(refused(false, false, rule), [], "{place}");
                let affine = wanted("affine", takes_affine, is_by_limit);
                let slopes = wanted("stress_slopes", takes_slopes, is_by_limit);
                assert_eq!(refused(true, false, rule), affine, "{place}");
                assert_eq!(refused(false, true, rule), slopes, "{place}");
                assert_eq!(refused(true, true, rule), [affine, slopes].concat(), "{place}");
            }
        }
    }

    fn implicitly(case: &mut Case, formulation: Formulation) {
        (case.integrator, case.formulation) = (IntegratorKind::Implicit, formulation);
        case.time_step = TimeStepRule::Growth(0.1);
    }

    fn in_layers(case: &mut Case, mean: ConductivityMean) {
        let layer = SoilLayer { thickness: 0.5, ..SoilLayer::default() };
        case.column.soils = SoilLayers::from_slice(&[layer; 2]).expect("two are few");
        case.material.conductivity_mean = mean;
    }

    /// What is said of the cases of the table below that are refused, by their rows.
    const ALL_REFUSALS: &str = r#"
0 task: the critical step of an attached solver cannot be searched: name methods of this program alone, or leave `task` out
1 affine: the critical step with APIC is not predicted: `stable` cannot be used: name the step: `time_step = [{ courant = 0.4 }]`, or in seconds
2 stress_slopes: the critical step with stress slopes is not predicted: `stable` cannot be used: name the step: `time_step = [{ courant = 0.4 }]`, or in seconds
3 sets: the domains of water points follow the water where points move, and the domains of this basis do not: take the basis "cpgimp" or "cpdi", or `sets = 1`
4 sets: the domains of water points follow the water where points move, and the domains of this basis do not: take the basis "cpgimp" or "cpdi", or `sets = 1`
8 sets: the projection needs pressures at the points of the skeleton: take the method "VP", or `sets = 1`
9 sets: cell averages need points that carry both phases, and here are two point sets: take a method without the suffix -cells, or `sets = 1`
10 sets: the chord mean is taken over points that carry both phases: take `conductivity_mean = "points"`, or `sets = 1`
11 sets: shifted domains of the water do not end where the soil does: leave `offset` and `jitter` out, or take `sets = 1`
12 sets: shifted domains of the water do not end where the soil does: leave `offset` and `jitter` out, or take `sets = 1`
14 sets: two point sets take one soil: take another scene, or `sets = 1`
15 conductivity_mean: the chord mean is taken along the compression of one soil, and the column has layers: take `conductivity_mean = "points"`
18 drag: explicit drag in a nearly impermeable soil needs steps below 1e-12 of those of the waves: take `drag = "implicit"`
21 formulation: the quasi-static formulation leaves out the waves that this scene is about: take "v-w" or "u-p", or the scene "terzaghi"
23 alternating: cells with unequal numbers of points are those of a column in one dimension: leave `alternating` out, or take a column with `dimensions = 1`
25 cells: an odd number of cells under a footing: half of it is solved, and its middle lies on a node: take an even number
26 plate_width: the layer ends under the footing: half of the footing lies on it: make `length` more than half of `plate_width`: 2.5 times `plate_width` is enough
28 method: the composite gradient between domain ends has no volume of its own: total stress needs one: take another method, or `undrained = "two-phase"`
31 integrator: the critical step is searched with explicit steps: take `integrator = ["explicit"]`, or leave the key out
"#;

    #[test]
    fn each_refusal_has_its_key_sentence_and_help_and_near_combinations_are_accepted() {
        use Formulation::{QuasiStatic, UP};
        use SceneKind::{DynamicColumn, Footing, Layered, SealedElement, Terzaghi, XieLeo};
        type Change = fn(&mut Case);
        let attached: Change = |case| {
            let ogs = crate::Attached::new("ogs", "0123456789abcdef").expect("a plain name");
            (case.method, case.task) = (crate::SolverName::Attached(ogs), Task::Stability);
        };
        let affine: Change =
            |case| (case.settings.affine, case.time_step) = (true, TimeStepRule::Stable(0.5));
        let slopes: Change =
            |case| (case.settings.stress_slopes, case.time_step) = (true, TimeStepRule::Stable(0.5));
        let two: Change = |case| case.column.points.sets = 2;
        let chord: Change = |case| {
            (case.column.points.sets, case.material.conductivity_mean) = (2, ConductivityMean::Chord);
        };
        let two_phase: Change = |case| case.column.footing.undrained = Undrained::TwoPhase;
        let unequal: Change = |case| (case.column.points.alternating, case.column.dimensions) = (true, 2);
        let table: [(SceneKind, &str, Change); 32] = [
            (Terzaghi, "GIMP", attached),
            (XieLeo, "GIMP", affine),
            (XieLeo, "GIMP", slopes),
            (XieLeo, "MPM", two),
            (XieLeo, "uGIMP", two),
            (XieLeo, "GIMP", two),
            (XieLeo, "CPDI-SRI-patch", two),
            (Terzaghi, "MPM", two),
            (Terzaghi, "PPP", two),
            (XieLeo, "GIMP-SRI-patch-cells", two),
            (XieLeo, "GIMP", chord),
            (Terzaghi, "GIMP", |case| (case.column.points.sets, case.column.points.offset) = (2, -0.25)),
            (Terzaghi, "GIMP", |case| (case.column.points.sets, case.column.points.jitter) = (2, 0.25)),
            (Terzaghi, "GIMP", |case| (case.column.points.jitter, case.column.points.offset) = (0.2, 0.2)),
            (Layered, "GIMP", two),
            (XieLeo, "GIMP", |case| in_layers(case, ConductivityMean::Chord)),
            (Layered, "GIMP", |case| in_layers(case, ConductivityMean::Points)),
            (XieLeo, "GIMP", |case| case.material.conductivity_mean = ConductivityMean::Chord),
            (SealedElement, "GIMP", |case| case.settings.drag = Drag::Explicit),
            (SealedElement, "GIMP", |case| case.settings.drag = Drag::Centred),
            (DynamicColumn, "GIMP", |case| implicitly(case, UP)),
            (DynamicColumn, "GIMP", |case| implicitly(case, QuasiStatic)),
            (Terzaghi, "GIMP", |case| case.task = Task::Stability),
            (Terzaghi, "GIMP", unequal),
            (Footing, "GIMP-SRI", two),
            (Footing, "GIMP-SRI", |case| case.cells = 5),
            (Footing, "GIMP-SRI", |case| case.column.footing.width = 5.0),
            (Footing, "GIMP-SRI", |case| case.column.footing.width = 4.999),
            (Footing, "CE-SRI-patch", |_| {}),
            (Footing, "CE-SRI-patch", two_phase),
            (Footing, "GC-SRI-patch", |_| {}),
            (Terzaghi, "GIMP", |case| {
                implicitly(case, QuasiStatic);
                case.task = Task::Stability;
            }),
        ];
        let mut listed = "\n".to_owned();
        for (place, (scene, method, change)) in table.into_iter().enumerate() {
            let mut case = Case { cells: 4, ..Case::seed(Task::Solve, scene) };
            case.method = Method::named(method).expect("a method").into();
            if case.is_explicit() {
                case.time_step = TimeStepRule::Courant(0.4);
            }
            change(&mut case);
            let lines = case
                .refusals()
                .map(|refusal| format!("{place} {}: {}: {}\n", refusal.key, refusal.why, refusal.help));
            listed.extend(lines);
        }
        assert_eq!(listed, ALL_REFUSALS);
    }

    #[test]
    fn where_nothing_moves_choices_of_moving_points_are_accepted_and_named_as_idle() {
        let seed = |integrator: IntegratorKind| {
            let mut case = Case::seed(Task::Solve, SceneKind::Terzaghi);
            (case.integrator, case.formulation) = (integrator, integrator.default_formulation());
            case.time_step = integrator.default_rule();
            case
        };
        let plain = seed(IntegratorKind::Implicit);
        let mut idle = plain.clone();
        idle.method = Method::named("TL-GC-SRI-patch").expect("a method").into();
        (idle.settings.affine, idle.settings.stress_slopes) = (true, true);
        idle.material.conductivity_mean = ConductivityMean::Chord;
        idle.column.points.sets = 2;
        assert_eq!(idle.refusals().next(), None);
        assert_eq!(
            (plain.idle_choices().len(), idle.idle_choices().len()),
            (0, 5),
            "{:?}",
            idle.idle_choices()
        );
        let run = idle.without_idle_choices();
        assert_eq!(Case { method: plain.method, ..run }, plain);
        // Explicit steps show that two alike sets are one; unequal ones are a choice of their own.
        let explicit = Case { column: idle.column.clone(), ..seed(IntegratorKind::Explicit) };
        assert!(explicit.without_idle_choices().column.points.has_two_sets());
        idle.column.points.water_per_cell = idle.points_per_cell;
        let explicit = Case { column: idle.column.clone(), ..explicit };
        assert_eq!(
            [&idle, &explicit].map(Case::expected_points),
            [1, 2].map(|sets| sets * plain.expected_points())
        );
        idle.column.points.water_per_cell = idle.points_per_cell + 1;
        assert_eq!(idle.refusals().map(|refusal| refusal.key).collect::<Vec<_>>(), ["sets"]);
    }
}
