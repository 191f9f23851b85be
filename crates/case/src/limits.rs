//! Combinations of inputs that are invalid although each input alone is valid, with the reason.

use crate::{Case, Task};
use oedometer_problem::integrator::IntegratorKind;
use oedometer_problem::method::{Basis, Configuration, Memory};
use oedometer_problem::time_step::TimeStep;
use oedometer_scenes::Scene;
use oedometer_scenes::limit::{Limit, Setup};
use oedometer_scenes::scene::{Body, LoadKind, Question};
use oedometer_soil::base::Drainage;
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

const OWN_BLOCK: &str = "give each integrator its own [[sweep]] block, or zip both axes with `path`";

impl Case {
    /// Every reason why the case cannot be.
    pub fn refusals(&self) -> impl Iterator<Item = Refusal> {
        let case = self.without_idle_choices();
        let Some(setup) = case.setup() else {
            let refusal = (case.task == Task::Stability).then_some(Refusal {
                key: "task",
                why: "the critical step of an attached solver cannot be determined",
                help: "name only methods of this program, or leave `task` out",
            });
            return refusal.into_iter().collect::<Vec<_>>().into_iter();
        };
        let rows = case.scene.limits.iter().chain(LIMITS).filter(|limit| (limit.refuses)(&setup));
        let two_sets = TWO_SETS.iter().filter(|_| setup.column.points.has_two_sets());
        let missed = two_sets.filter(|(refuses, ..)| refuses(case.scene, &setup)).take(1);
        let mut refusals = choices_outside_lists(case.scene, &setup);
        refusals.extend(rows.map(|limit| Refusal { key: limit.key, why: limit.why, help: limit.instead }));
        refusals.extend(missed.map(|(_, why, help)| Refusal { key: "sets", why, help }));
        refusals.into_iter()
    }

    /// The case as limits see it; none of an attached solver.
    fn setup(&self) -> Option<Setup<'_>> {
        let method = self.method.built_in()?;
        Some(Setup {
            column: &self.column,
            soil: &self.material,
            method,
            configuration: method.configuration_in(self.scene.configuration()),
            integrator: self.integrator,
            formulation: self.formulation,
            settings: &self.settings,
            time_step: self.time_step,
            cells: self.cells,
            is_search: self.task == Task::Stability,
        })
    }
}

/// Steps, integrators and formulations that are not in the lists of scene and integrator: of each the first list that lacks it.
fn choices_outside_lists(scene: &Scene, it: &Setup<'_>) -> Vec<Refusal> {
    let Setup { integrator, formulation, .. } = it;
    let by_integrator = "give each integrator its own [[sweep]] block, or leave `formulation` out";
    let searched = (it.is_search && *integrator != IntegratorKind::Explicit).then_some((
        "the critical step is determined with explicit steps",
        "use `integrator = [\"explicit\"]`, or leave the key out",
    ));
    let [integrators, formulations] = [
        (!scene.integrators.has(integrator)).then_some((scene.integrators.why, scene.integrators.instead)),
        (!scene.formulations.has(formulation))
            .then_some((scene.formulations.why, scene.formulations.instead)),
    ];
    let of_integrator = integrator.refuses_formulation(*formulation).map(|why| (why, by_integrator));
    let lists = [
        ("time_step", integrator.refuses_rule(it.time_step).map(|why| (why, OWN_BLOCK))),
        ("integrator", integrators.or(searched)),
        ("formulation", of_integrator.or(formulations)),
    ];
    let refusals = lists.into_iter().filter_map(|(key, refusal)| Some((key, refusal?)));
    refusals.map(|(key, (why, help))| Refusal { key, why, help }).collect()
}

/// Whether points in one set move by explicit steps.
fn moves_points_explicitly(it: &Setup<'_>) -> bool {
    let is_explicit = it.integrator == IntegratorKind::Explicit;
    is_explicit && it.configuration.moves_points() && !it.column.points.has_two_sets()
}

/// Whether the domains of such points follow them.
fn moves_domains_explicitly(it: &Setup<'_>) -> bool {
    moves_points_explicitly(it) && it.method.basis == Basis::Cpgimp
}

/// Limits of all scenes.
static LIMITS: &[Limit] = &[
    Limit {
        key: "affine",
        refuses: |it| it.settings.affine && !moves_points_explicitly(it),
        why: "APIC needs a single set of points that move by explicit steps: a case of this sweep has none",
        instead: "leave `affine` out there, or give those methods and integrators their own [[sweep]] block",
    },
    Limit {
        key: "stress_slopes",
        refuses: |it| it.settings.stress_slopes && !moves_domains_explicitly(it),
        why: "stress slopes need GIMP domains of a single set of points that move by explicit steps: a case \
              of this sweep has none",
        instead: "leave `stress_slopes` out there, or give those methods and integrators their own [[sweep]] block",
    },
    Limit {
        key: "time_step",
        refuses: |it| {
            let is_affine = it.settings.affine && moves_points_explicitly(it);
            let has_slopes = it.settings.stress_slopes && moves_domains_explicitly(it);
            matches!(it.time_step, TimeStep::Stable(_)) && (is_affine || has_slopes)
        },
        why: "the critical step with APIC or stress slopes is not predicted: `stable` cannot be used",
        instead: "name the step: `time_step = [{ courant = 0.4 }]`, or in seconds",
    },
    Limit {
        key: "offset",
        refuses: |it| it.column.self_weight && it.column.points.offset != 0.0,
        why: "domains shifted off their lattice do not integrate self-weight exactly: the column would flow \
              from the start",
        instead: "leave `offset` out, or use `self_weight = false`",
    },
    Limit {
        key: "alternating",
        refuses: |it| it.column.points.alternating && it.column.dimensions > 1,
        why: "cells can have unequal numbers of points only in a one-dimensional column",
        instead: "leave `alternating` out, or use a column with `dimensions = 1`",
    },
    Limit {
        key: "conductivity_mean",
        refuses: |it| it.soil.conductivity_mean == ConductivityMean::Chord && !it.column.soils.is_empty(),
        why: "the chord mean is taken along the compression of a single soil, but the column has layers",
        instead: "use `conductivity_mean = \"points\"`",
    },
];

/// A condition of two point sets that is missed, what it says, and what would be right.
type Missed = (fn(&Scene, &Setup<'_>) -> bool, &'static str, &'static str);

/// What two point sets need; the first that is missed is named.
static TWO_SETS: &[Missed] = &[
    (
        |_, it| it.integrator != IntegratorKind::Explicit,
        "double-point MPM is integrated explicitly only",
        "use the integrator \"explicit\", or `sets = 1`",
    ),
    (
        |_, it| it.configuration == Configuration::Total,
        "shape functions on the initial configuration stay with the skeleton, but a second point set does not",
        "use a method without the prefix TL-, or `sets = 1`",
    ),
    (
        |_, it| it.method.has_projection(),
        "the projection needs pressures at the points of the skeleton",
        "use the method \"VP\", or `sets = 1`",
    ),
    (
        |_, it| it.method.memory == Memory::Cells && it.configuration != Configuration::Frozen,
        "cell averages need points that carry both phases, but there are two point sets",
        "use a method without the suffix -cells, or `sets = 1`",
    ),
    (
        |_, it| {
            it.configuration == Configuration::Updated
                && !matches!(it.method.basis, Basis::Cpgimp | Basis::Cpdi)
        },
        "where points move, the domains of water points follow the water, but the domains of this basis do not",
        "use the basis \"cpgimp\" or \"cpdi\", or `sets = 1`",
    ),
    (
        |scene, _| scene.body == Body::Slab,
        "a rigid plate needs a single point set",
        "use another problem, or `sets = 1`",
    ),
    (
        |scene, _| scene.load == LoadKind::Pushed,
        "the water under a footing stays with its soil",
        "use another problem, or `sets = 1`",
    ),
    (
        |scene, it| scene.question == Question::Layers && scene.takes("soils") || !it.column.soils.is_empty(),
        "two point sets need a single soil",
        "use another problem, or `sets = 1`",
    ),
    (
        |_, it| it.column.self_weight,
        "the weight of a column needs points that carry both phases",
        "leave `self_weight` out, or use `sets = 1`",
    ),
    (
        |_, it| it.column.drainage == Drainage::Both,
        "water points leave only through the surface",
        "leave `drainage` out, or use `sets = 1`",
    ),
    (
        |_, it| it.soil.conductivity_mean == ConductivityMean::Chord,
        "the chord mean is taken over points that carry both phases",
        "use `conductivity_mean = \"points\"`, or `sets = 1`",
    ),
    (
        |_, it| it.column.points.jitter != 0.0 || it.column.points.offset != 0.0,
        "shifted domains of the water do not end where the soil does",
        "leave `offset` and `jitter` out, or use `sets = 1`",
    ),
];

#[cfg(test)]
mod tests {
    use super::*;
    use oedometer_problem::formulation::Formulation;
    use oedometer_problem::method::Method;
    use oedometer_problem::settings::Drag;
    use oedometer_scenes::column::Undrained;
    use oedometer_scenes::{DYNAMIC_COLUMN, FOOTING, LAYERED, SEALED_ELEMENT, TERZAGHI, XIE_LEO};
    use oedometer_soil::layers::{SoilLayer, SoilLayers};

    #[test]
    fn choices_of_moving_points_are_refused_where_points_move_and_the_solver_ignores_them() {
        use IntegratorKind::{Explicit, Implicit, SemiImplicit};
        // Scene, method, integrator, point sets; then whether APIC and stress slopes are taken there.
        for (scene, method, integrator, sets, takes_affine, takes_slopes) in [
            (&XIE_LEO, "GIMP", Explicit, 1, true, true),
            (&XIE_LEO, "GC-SRI-patch", Explicit, 1, true, true),
            (&XIE_LEO, "uGIMP", Explicit, 1, true, false),
            (&XIE_LEO, "MPM", Explicit, 1, true, false),
            (&XIE_LEO, "CPDI-SRI-patch", Explicit, 1, true, false),
            (&XIE_LEO, "GIMP", Explicit, 2, false, false),
            (&XIE_LEO, "GIMP", Implicit, 1, false, false),
            (&XIE_LEO, "GIMP", SemiImplicit, 1, false, false),
            (&XIE_LEO, "TL-GIMP", Explicit, 1, false, false),
        ] {
            let refused = |affine, stress_slopes, time_step| {
                let mut case = Case::seed(Task::Solve, scene);
                case.method = Method::named(method).expect("a method").into();
                (case.integrator, case.formulation) = (integrator, integrator.default_formulation());
                case.time_step = time_step;
                case.column.points.sets = sets;
                (case.settings.affine, case.settings.stress_slopes) = (affine, stress_slopes);
                case.refusals().map(|refusal| refusal.key).collect::<Vec<_>>()
            };
            let place = format!("{scene:?} {method} {integrator:?} {sets}");
            let (by_hand, by_limit) = (TimeStep::Seconds(1.0), TimeStep::Stable(0.5));
            for (rule, is_by_limit) in [(by_hand, false), (by_limit, true)] {
                for (affine, slopes) in [(false, false), (true, false), (false, true), (true, true)] {
                    let is_unpredicted = is_by_limit && (affine && takes_affine || slopes && takes_slopes);
                    let wanted: Vec<&str> = [
                        ("affine", affine && !takes_affine),
                        ("stress_slopes", slopes && !takes_slopes),
                        ("time_step", is_unpredicted),
                    ]
                    .into_iter()
                    .filter_map(|(key, is_refused)| is_refused.then_some(key))
                    .collect();
                    assert_eq!(refused(affine, slopes, rule), wanted, "{place} {affine} {slopes}");
                }
            }
        }
    }

    fn implicitly(case: &mut Case, formulation: Formulation) {
        (case.integrator, case.formulation) = (IntegratorKind::Implicit, formulation);
        case.time_step = TimeStep::Growth(0.1);
    }

    fn in_layers(case: &mut Case, mean: ConductivityMean) {
        let layer = SoilLayer { thickness: 0.5, ..SoilLayer::default() };
        case.column.soils = SoilLayers::from_slice(&[layer; 2]).expect("two are few");
        case.material.conductivity_mean = mean;
    }

    /// What is said of the cases of the table below that are refused, by their rows.
    const ALL_REFUSALS: &str = r#"
0 task: the critical step of an attached solver cannot be determined: name only methods of this program, or leave `task` out
1 time_step: the critical step with APIC or stress slopes is not predicted: `stable` cannot be used: name the step: `time_step = [{ courant = 0.4 }]`, or in seconds
2 time_step: the critical step with APIC or stress slopes is not predicted: `stable` cannot be used: name the step: `time_step = [{ courant = 0.4 }]`, or in seconds
3 sets: where points move, the domains of water points follow the water, but the domains of this basis do not: use the basis "cpgimp" or "cpdi", or `sets = 1`
4 sets: where points move, the domains of water points follow the water, but the domains of this basis do not: use the basis "cpgimp" or "cpdi", or `sets = 1`
8 sets: the projection needs pressures at the points of the skeleton: use the method "VP", or `sets = 1`
9 sets: cell averages need points that carry both phases, but there are two point sets: use a method without the suffix -cells, or `sets = 1`
10 sets: the chord mean is taken over points that carry both phases: use `conductivity_mean = "points"`, or `sets = 1`
11 sets: shifted domains of the water do not end where the soil does: leave `offset` and `jitter` out, or use `sets = 1`
12 sets: shifted domains of the water do not end where the soil does: leave `offset` and `jitter` out, or use `sets = 1`
14 sets: two point sets need a single soil: use another problem, or `sets = 1`
15 conductivity_mean: the chord mean is taken along the compression of a single soil, but the column has layers: use `conductivity_mean = "points"`
18 drag: explicit drag in a nearly impermeable soil needs steps below 1e-12 of the wave limit: use `drag = "implicit"`
21 formulation: the quasi-static formulation neglects the waves that this problem is about: use "v-w" or "u-p", or the problem "terzaghi"
23 alternating: cells can have unequal numbers of points only in a one-dimensional column: leave `alternating` out, or use a column with `dimensions = 1`
25 cells: an odd number of cells under a footing: half of it is solved, and its middle lies on a node: use an even number
26 plate_width: the layer ends under the footing: half of the footing must lie on it: make `length` more than half of `plate_width`: 2.5 times `plate_width` is enough
28 method: the composite gradient between domain ends has no separate volumetric part, which total stress needs: use another method, or `undrained = "two-phase"`
31 integrator: the critical step is determined with explicit steps: use `integrator = ["explicit"]`, or leave the key out
32 sets: water points leave only through the surface: leave `drainage` out, or use `sets = 1`
"#;

    #[test]
    fn each_refusal_has_its_key_sentence_and_help_and_near_combinations_are_accepted() {
        use Formulation::{QuasiStatic, UP};
        type Change = fn(&mut Case);
        let attached: Change = |case| {
            let ogs = crate::Attached::new("ogs", "0123456789abcdef").expect("a plain name");
            (case.method, case.task) = (crate::SolverName::Attached(ogs), Task::Stability);
        };
        let affine: Change = |case| (case.settings.affine, case.time_step) = (true, TimeStep::Stable(0.5));
        let slopes: Change =
            |case| (case.settings.stress_slopes, case.time_step) = (true, TimeStep::Stable(0.5));
        let two: Change = |case| case.column.points.sets = 2;
        let chord: Change = |case| {
            (case.column.points.sets, case.material.conductivity_mean) = (2, ConductivityMean::Chord);
        };
        let two_phase: Change = |case| case.column.footing.undrained = Undrained::TwoPhase;
        let unequal: Change = |case| (case.column.points.alternating, case.column.dimensions) = (true, 2);
        let table: [(&'static Scene, &str, Change); 33] = [
            (&TERZAGHI, "GIMP", attached),
            (&XIE_LEO, "GIMP", affine),
            (&XIE_LEO, "GIMP", slopes),
            (&XIE_LEO, "MPM", two),
            (&XIE_LEO, "uGIMP", two),
            (&XIE_LEO, "GIMP", two),
            (&XIE_LEO, "CPDI-SRI-patch", two),
            (&TERZAGHI, "MPM", two),
            (&TERZAGHI, "PPP", two),
            (&XIE_LEO, "GIMP-SRI-patch-cells", two),
            (&XIE_LEO, "GIMP", chord),
            (&TERZAGHI, "GIMP", |case| (case.column.points.sets, case.column.points.offset) = (2, -0.25)),
            (&TERZAGHI, "GIMP", |case| (case.column.points.sets, case.column.points.jitter) = (2, 0.25)),
            (&TERZAGHI, "GIMP", |case| (case.column.points.jitter, case.column.points.offset) = (0.2, 0.2)),
            (&LAYERED, "GIMP", two),
            (&XIE_LEO, "GIMP", |case| in_layers(case, ConductivityMean::Chord)),
            (&LAYERED, "GIMP", |case| in_layers(case, ConductivityMean::Points)),
            (&XIE_LEO, "GIMP", |case| case.material.conductivity_mean = ConductivityMean::Chord),
            (&SEALED_ELEMENT, "GIMP", |case| case.settings.drag = Drag::Explicit),
            (&SEALED_ELEMENT, "GIMP", |case| case.settings.drag = Drag::Centred),
            (&DYNAMIC_COLUMN, "GIMP", |case| implicitly(case, UP)),
            (&DYNAMIC_COLUMN, "GIMP", |case| implicitly(case, QuasiStatic)),
            (&TERZAGHI, "GIMP", |case| case.task = Task::Stability),
            (&TERZAGHI, "GIMP", unequal),
            (&FOOTING, "GIMP-SRI", two),
            (&FOOTING, "GIMP-SRI", |case| case.cells = 5),
            (&FOOTING, "GIMP-SRI", |case| case.column.footing.width = 5.0),
            (&FOOTING, "GIMP-SRI", |case| case.column.footing.width = 4.999),
            (&FOOTING, "CE-SRI-patch", |_| {}),
            (&FOOTING, "CE-SRI-patch", two_phase),
            (&FOOTING, "GC-SRI-patch", |_| {}),
            (&TERZAGHI, "GIMP", |case| {
                implicitly(case, QuasiStatic);
                case.task = Task::Stability;
            }),
            (&XIE_LEO, "GIMP", |case| {
                (case.column.points.sets, case.column.drainage) = (2, Drainage::Both);
            }),
        ];
        let mut listed = "\n".to_owned();
        for (place, (scene, method, change)) in table.into_iter().enumerate() {
            let mut case = Case { cells: 4, ..Case::seed(Task::Solve, scene) };
            case.method = Method::named(method).expect("a method").into();
            if case.is_explicit() {
                case.time_step = TimeStep::Courant(0.4);
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
            let mut case = Case::seed(Task::Solve, &TERZAGHI);
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
