//! What a result is compared with: a scene, or a textbook problem, with its numbers; inputs that it does not read are refused.

use crate::case::{Case, Key};
use crate::study::Study;
use crate::study::overrides::{
    Assignments, Outputs, OverrideError, StudyLines, assignment, refused_quantity,
};
use crate::study::synonyms::read_as;
use crate::study::units::in_si;
use oedometer_exact::{AddedKey, ColumnParameters, ReferenceKind, TextbookParameters, TextbookProblem};
use oedometer_scenes::Scene;
use oedometer_scenes::column::column_parameters;
use oedometer_soil::continuity::Continuity;
use oedometer_soil::law::Law;

/// What a result is compared with: a scene, or a textbook problem, with its numbers.
pub struct Asked {
    /// The scene with its column as a study of one case; of a textbook problem the column that it is told in.
    pub study: Study,
    /// Parameters of the references.
    pub parameters: ColumnParameters,
    /// References, the scene's own first.
    pub references: Vec<ReferenceKind>,
    /// Requested time factors; all if empty.
    pub requested: Vec<f64>,
}

impl Asked {
    /// The scene or problem of a name.
    ///
    /// # Errors
    /// What is wrong with the scene or an assignment.
    pub fn of_scene(scene: &str, outputs: &Outputs) -> Result<Self, OverrideError> {
        let scene = read_as(scene);
        let kind = scene.parse::<ReferenceKind>().ok();
        let of_textbook = kind.filter(|kind| is_of_textbook(*kind));
        let mut outputs = outputs.clone();
        let mut textbook = TextbookParameters::default();
        if let Some(kind) = kind {
            (outputs.set, textbook) = outputs.set.of_problem(kind)?;
        }
        if let Some(kind) = of_textbook {
            outputs.set.refuse_ignored(kind, false)?;
            if let Some(other) = outputs.reference.take().filter(|other| other != scene) {
                return Err(OverrideError::Typed(format!(
                    "`{scene}` has no reference `{other}`: it is its own"
                )));
            }
        }
        let name = of_textbook.map_or(scene, |kind| Scene::of_solution(kind).name);
        let mut lines = StudyLines::of("score", name, "`--scene`")?;
        lines.give_outputs(&outputs)?;
        let is_requested = lines.has("output.time_factors") || lines.has("output.times");
        let study = lines.theory_study()?;
        let case = &study.planned[0].case;
        let references = study.references.iter().map(|kind| kind.for_soil(&case.material)).collect();
        Ok(Self {
            parameters: ColumnParameters { textbook, ..column_parameters(&case.column, &case.material) },
            references: of_textbook.map_or(references, |kind| vec![kind]),
            requested: if is_requested { case.time_factors.to_vec() } else { Vec::new() },
            study,
        })
    }

    /// The default column of a solution with assignments; its reference is that for the equations that they choose.
    ///
    /// # Errors
    /// What is wrong with an assignment.
    pub fn of_solution(kind: ReferenceKind, set: &Assignments) -> Result<Self, OverrideError> {
        let (set, textbook) = set.of_problem(kind)?;
        if is_of_textbook(kind) {
            set.refuse_ignored(kind, false)?;
        }
        let mut lines = StudyLines::of("exact", Scene::of_solution(kind).name, "the solution's name")?;
        lines.assign(&set)?;
        let study = lines.theory_study()?;
        let case = &study.planned[0].case;
        set.refuse_ignored(kind, case.column.self_weight)?;
        let is_its_own =
            case.material.law == Law::LogLinear && case.material.continuity == Continuity::Conservative;
        if kind == ReferenceKind::XieLeo && !is_its_own {
            let key = if case.material.law == Law::LogLinear { "continuity" } else { "law" };
            let key = format!("material.{key}");
            return Err(without_effect(&key, kind, why_ignored(kind, &key)));
        }
        Ok(Self {
            parameters: ColumnParameters { textbook, ..column_parameters(&case.column, &case.material) },
            references: vec![kind.for_soil(&case.material)],
            requested: Vec::new(),
            study,
        })
    }

    /// The case.
    pub fn case(&self) -> &Case {
        &self.study.planned[0].case
    }
}

impl Assignments {
    /// What is set of the inputs that no scene has, and the assignments that are a column's.
    pub fn of_problem(&self, kind: ReferenceKind) -> Result<(Self, TextbookParameters), OverrideError> {
        let (mut others, mut set) = (Self::default(), TextbookParameters::default());
        for typed in &self.assignments {
            let (key, value) = assignment(typed)?;
            match AddedKey::ALL.iter().find(|added| added.key == key) {
                Some(added) if kind.takes(added) => (added.set)(&mut set, number_of(added, &key, &value)?),
                // A column may have a key of the same name.
                Some(added) if is_of_textbook(kind) || column_key(&key).is_none() => {
                    let textbook = TextbookProblem::ALL.map(ReferenceKind::Textbook).into_iter();
                    let takers = textbook.chain(ReferenceKind::ALL).filter(|other| other.takes(added));
                    let takers: Vec<_> = takers.map(|kind| format!("`{kind}`")).collect();
                    return Err(without_effect(&key, kind, &format!("it is for {}", takers.join(", "))));
                }
                _ => others.assignments.push(typed.clone()),
            }
        }
        Ok((others, set))
    }

    /// Refuses inputs that a solution does not read, so that no input is ignored. Unknown keys are left to the
    /// checker of studies.
    fn refuse_ignored(&self, kind: ReferenceKind, has_weight: bool) -> Result<(), OverrideError> {
        let inputs = kind.inputs(has_weight);
        for typed in &self.assignments {
            let (key, _) = assignment(typed)?;
            let is_read = column_key(&key)
                .is_some_and(|key| inputs.contains(&key.name) || inputs.contains(&key.in_place_of))
                || (key == "column.soils" && inputs.contains(&"soils"))
                || key == "column.strain";
            if !is_read {
                return Err(without_effect(&key, kind, why_ignored(kind, &key)));
            }
        }
        Ok(())
    }
}

fn is_of_textbook(kind: ReferenceKind) -> bool {
    matches!(kind, ReferenceKind::Textbook(_))
}

/// The key of a body or its material by its dotted name.
fn column_key(key: &str) -> Option<&'static Key> {
    let (table, name) = key.split_once('.')?;
    ["column", "layer", "manufactured", "material"].contains(&table).then(|| Key::named(name, table))?
}

fn without_effect(key: &str, kind: ReferenceKind, why: &str) -> OverrideError {
    OverrideError::typed(format!("`--set {key}` has no effect in `{kind}`: {why}"))
}

/// The value of a key that no scene has, in SI units.
fn number_of(added: &AddedKey, key: &str, value: &str) -> Result<f64, OverrideError> {
    if added.unit.is_empty() {
        return value
            .parse()
            .map_err(|_| OverrideError::typed(format!("`{key}` must be a number, got {value}")));
    }
    let typed = value.trim_matches(['"', '\'']);
    typed.parse().or_else(|_| in_si(typed, added.unit)).map_err(|problem| refused_quantity(key, problem))
}

/// Why a solution does not read a key.
fn why_ignored(kind: ReferenceKind, key: &str) -> &'static str {
    let of_large_strain = "`large-strain` takes it";
    match (key, kind) {
        (
            "material.law"
            | "material.continuity"
            | "material.water_bulk_modulus"
            | "column.soils"
            | "column.loading_time",
            ReferenceKind::XieLeo,
        ) => of_large_strain,
        ("material.law", _) => "the problem has its own law",
        ("material.water_bulk_modulus", kind) if kind.inputs(false).contains(&"hydraulic_conductivity") => {
            "its water is incompressible"
        }
        ("material.porosity", kind) if kind.inputs(false).contains(&"hydraulic_conductivity") => {
            "its water is incompressible, so the porosity has no effect"
        }
        ("material.continuity", _) => "at small strain both forms are the same",
        ("column.loading_time", ReferenceKind::Textbook(_)) => "its load acts at once, or in waves",
        ("column.loading_time", _) => "its load acts at once",
        ("column.self_weight", _) => "it has no weight",
        ("column.drainage", _) => "its base is impermeable",
        ("material.grain_density", _) => "it has no inertia, and no weight without `column.self_weight=true`",
        ("output.time_factors", _) => "`--time-factor` has the times",
        ("output.times", _) => "`--time` has them",
        _ => "the printed values do not depend on it",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::keys::{KEYS, Kind};
    use oedometer_exact::Reference;

    #[test]
    fn what_is_compared_is_for_the_equations_that_the_assignments_choose() {
        use oedometer_exact::large_strain::diffusion::{LargeStrainModel, Water};
        use oedometer_exact::manufactured::motion::{ManufacturedModel, Motion};
        use oedometer_soil::continuity::Continuity;
        use oedometer_soil::law::Law;
        let set =
            |typed: &[&str]| Assignments { assignments: typed.iter().map(|one| (*one).to_owned()).collect() };
        let large = |law, continuity| {
            ReferenceKind::LargeStrain(LargeStrainModel { law, continuity, water: Water::Compressible })
        };
        let swirl = |law| {
            ReferenceKind::Manufactured(ManufacturedModel {
                law,
                ..ManufacturedModel::with_default_law(Motion::Vortex)
            })
        };
        let [dropped, other_law] =
            ["material.continuity=constant-porosity-gradient", "material.law=porosity-dependent"];
        for (kind, typed, wanted) in [
            (LargeStrainModel::XIE_LEO, &[][..], large(Law::LogLinear, Continuity::Conservative)),
            (
                LargeStrainModel::XIE_LEO,
                &[other_law],
                large(Law::PorosityDependent, Continuity::Conservative),
            ),
            (
                LargeStrainModel::XIE_LEO,
                &[dropped],
                large(Law::LogLinear, Continuity::ConstantPorosityGradient),
            ),
        ]
        .map(|(model, typed, wanted)| (ReferenceKind::LargeStrain(model), typed, wanted))
        .into_iter()
        .chain(
            [
                (swirl(Law::Linear), &["material.law=neo-hookean"], swirl(Law::NeoHookean)),
                (ReferenceKind::Terzaghi, &["material.porosity=0.4"], ReferenceKind::Terzaghi),
            ]
            .map(|(kind, typed, wanted)| (kind, &typed[..], wanted)),
        ) {
            let asked = Asked::of_solution(kind, &set(typed)).expect("a column");
            assert_eq!(asked.references, [wanted], "{typed:?}");
        }
        let outputs = |typed: &[&str], time_factor: Option<&str>| Outputs {
            set: set(typed),
            time_factor: time_factor.map(str::to_owned),
            ..Outputs::default()
        };
        for (typed, law) in [(&[][..], Law::LogLinear), (&[other_law], Law::PorosityDependent)] {
            let asked = Asked::of_scene("xie-leo", &outputs(typed, None)).expect("a scene");
            assert!(
                asked.references.contains(&large(law, Continuity::Conservative)),
                "{:?}",
                asked.references
            );
            assert_eq!((asked.case().material.law, asked.requested.len()), (law, 0), "no time is asked for");
        }
        let asked = Asked::of_scene("terzaghi", &outputs(&["column.load=5 kPa"], Some("0.3,0.2")));
        let asked = asked.expect("a scene");
        assert_eq!((asked.parameters.load, asked.references[0]), (5e3, ReferenceKind::Terzaghi));
        assert_eq!(asked.requested, [0.2, 0.3]);
    }

    #[test]
    fn what_is_set_of_a_textbook_problem_is_what_it_is_scored_against_and_printed_with() {
        let usual = TextbookParameters::default();
        let drain = |drain_radius| TextbookParameters { drain_radius, ..usual };
        let wave = |wave_period| TextbookParameters { wave_period, ..usual };
        let grains = |modulus| TextbookParameters { grain_bulk_modulus: Some(modulus), ..usual };
        let start = |stress| TextbookParameters { initial_stress: Some(stress), ..usual };
        for (problem, typed, wanted) in [
            ("barron", "column.load=1", usual),
            ("barron", "drain.radius=0.125", drain(0.125)),
            ("barron", "drain.radius=\"10 cm\"", drain(0.1)),
            ("barron-free-strain", "drain.radius=0.125", drain(0.125)),
            ("seabed", "wave.period=2 min", wave(120.0)),
            (
                "cryer",
                "material.biot_coefficient=0.75",
                TextbookParameters { biot_coefficient: Some(0.75), ..usual },
            ),
            ("cryer", "material.grain_bulk_modulus=3 GPa", grains(3e9)),
            ("injection", "material.grain_bulk_modulus=3e9", grains(3e9)),
            ("davis-raymond", "column.initial_stress=5 kPa", start(5e3)),
        ] {
            let kind: ReferenceKind = problem.parse().expect("a problem");
            let set = Assignments {
                assignments: vec![typed.to_owned(), "material.hydraulic_conductivity=0.002".to_owned()],
            };
            let outputs = Outputs { set: set.clone(), ..Outputs::default() };
            for asked in [Asked::of_scene(problem, &outputs), Asked::of_solution(kind, &set)] {
                let asked = asked.expect(problem);
                assert_eq!(asked.parameters.textbook, wanted, "{problem} {typed}");
                assert_eq!(asked.references, [kind], "{problem} {typed}");
                assert_eq!(asked.case().material.hydraulic_conductivity, 0.002, "{problem} {typed}");
            }
        }
        // A column has nothing of them, whatever it is set to.
        let outputs = Outputs::default();
        assert_eq!(Asked::of_scene("terzaghi", &outputs).expect("a scene").parameters.textbook, usual);
    }

    /// Another value of a key than it has.
    fn another(key: &Key, case: &Case) -> Vec<String> {
        match key.kind {
            Kind::Word(words) => {
                let has = key.get(case).to_string();
                words.iter().filter(|word| **word != has).map(|word| (*word).to_owned()).collect()
            }
            Kind::Flag => vec![if key.get(case).to_string() == "true" { "false" } else { "true" }.to_owned()],
            Kind::Count(_) => vec!["2".to_owned()],
            Kind::Number(_) => {
                let has: f64 = key.get(case).to_string().parse().unwrap_or(0.0);
                let others =
                    [1.37 * has, 0.93 * has, has + 0.1, has + 3e5].into_iter().filter(|other| *other != has);
                others.map(|other| format!("{other:e}")).collect()
            }
            Kind::Method | Kind::TimeStep => Vec::new(),
        }
    }

    /// All that `exact` gives of a solution with an assignment; nothing where it is refused.
    fn given(kind: ReferenceKind, assignments: &[String]) -> Option<Vec<u64>> {
        let asked = Asked::of_solution(kind, &Assignments { assignments: assignments.to_vec() }).ok()?;
        let times = if kind == ReferenceKind::YieldFront { [1e-3, 2e-3] } else { [0.07, 0.4] };
        let reference = Reference::new(asked.references[0], &asked.parameters, &times).ok()?;
        let mut numbers: Vec<f64> = reference.least_porosity().into_iter().collect();
        for time in times {
            if kind.has_time() {
                numbers.push(asked.parameters.time(time));
            }
            numbers.push(reference.settlement(time).expect("a time"));
            if let Some(motion) = reference.manufactured() {
                let fields = motion.plane_fields(time, [0.25, 0.65]).expect("inside");
                numbers
                    .extend(fields.effective_stress.as_flattened().iter().map(|s| s / asked.parameters.load));
                numbers.extend(fields.displacement);
            }
            if let Ok(fields) = reference.fields(time, 0.35) {
                // What a row has: ratios.
                numbers.extend([
                    fields.pressure / asked.parameters.load,
                    fields.effective_stress / asked.parameters.load,
                    fields.displacement / asked.parameters.height,
                ]);
            }
        }
        Some(numbers.into_iter().map(f64::to_bits).collect())
    }

    #[test]
    fn a_key_changes_what_a_solution_gives_or_is_refused() {
        let mut told = Vec::new();
        for kind in ReferenceKind::all() {
            let usual = given(kind, &[]).unwrap_or_else(|| panic!("{kind} by itself"));
            let case = Case::seed(crate::case::Task::Solve, Scene::of_solution(kind));
            let added = AddedKey::ALL.iter().map(|added| {
                let values = ["0.77", "0.91", "1e7", "0.2"].map(str::to_owned).to_vec();
                (added.key.to_owned(), values)
            });
            let keys = KEYS.iter().flat_map(|key| {
                let tables = key.tables.iter().filter(|table| **table != "sweep");
                let case = &case;
                tables.map(move |table| (format!("{table}.{}", key.name), another(key, case)))
            });
            let others =
                ["column.soils", "output.time_factors", "output.references", "timing.repeats", "summary"]
                    .map(|key| {
                        (key.to_owned(), vec!["[{thickness=0.4},{thickness=0.6,porosity=0.4}]".to_owned()])
                    });
            for (key, values) in added.chain(keys).chain(others) {
                for value in values {
                    let set = format!("{key}={value}");
                    // The same material as the log-linear one, in other words.
                    if set != "material.law=engineering"
                        && given(kind, std::slice::from_ref(&set)).is_some_and(|numbers| numbers == usual)
                    {
                        told.push(format!("{kind}: {set}"));
                    }
                }
            }
            // What it names is refused for some values at most. Of motions each has amplitudes of its own.
            let tables = ["column", "layer", "manufactured", "material"];
            let others = ["law", "loading_time", "continuity"];
            for name in kind.inputs(false).into_iter().filter(|name| !others.contains(name)) {
                let keys: Vec<_> =
                    tables.iter().filter_map(|table| Some((table, Key::named(name, table)?))).collect();
                let takes = |(table, key): &(&&str, &Key)| {
                    let values = another(key, &case);
                    values.iter().any(|value| given(kind, &[format!("{table}.{name}={value}")]).is_some())
                };
                if !keys.is_empty() && !keys.iter().any(takes) && !kind.is_manufactured() {
                    told.push(format!("{kind} names `{name}` and takes no value of it"));
                }
            }
        }
        assert!(told.is_empty(), "{}", told.join("\n"));
    }

    #[test]
    fn what_is_ignored_is_refused_with_what_takes_it() {
        for (kind, typed, told) in [
            ("xie-leo", "material.law=porosity-dependent", "`xie-leo`: `large-strain` takes it"),
            (
                "xie-leo",
                "material.continuity=constant-porosity-gradient",
                "`xie-leo`: `large-strain` takes it",
            ),
            ("xie-leo", "material.water_bulk_modulus=1e9", "`xie-leo`: `large-strain` takes it"),
            ("terzaghi-incompressible", "material.water_bulk_modulus=1e9", "its water is incompressible"),
            ("cosine-layer-incompressible", "material.porosity=0.4", "its water is incompressible"),
            ("terzaghi", "material.grain_density=2700", "no weight without `column.self_weight=true`"),
            ("terzaghi", "material.biot_coefficient=0.6", "`seabed`, `injection`, `mandel`"),
            ("terzaghi", "points.offset=0.1", "do not depend on it"),
            ("sealed-element", "material.gravity=1.6", "do not depend on it"),
        ] {
            let set = Assignments { assignments: vec![typed.to_owned()] };
            let error = Asked::of_solution(kind.parse().expect("a solution"), &set)
                .err()
                .map(|error| error.to_string());
            assert!(error.as_ref().is_some_and(|error| error.contains(told)), "{kind} {typed}: {error:?}");
        }
        let set = ["column.self_weight=true", "material.grain_density=2700"].map(str::to_owned).to_vec();
        assert!(Asked::of_solution(ReferenceKind::Terzaghi, &Assignments { assignments: set }).is_ok());
    }

    #[test]
    fn a_textbook_problem_refuses_what_it_does_not_heed_and_takes_what_it_does() {
        const WEIGHT: &str = "column.self_weight=true";
        const WATER: &str = "material.water_bulk_modulus=1e9";
        const LAW: &str = "material.law=linear";
        let length = "write a plain number in m, or one with its unit in quotes, like \"10 m\": m, cm, mm";
        let wide = format!("`drain.radius`: `wide` is not a number with a unit: {length}");
        let second = format!("`drain.radius`: `s` is not a unit for a quantity in m: {length}");
        for (problem, typed, told) in [
            ("barron", WEIGHT, Some("it has no weight")),
            ("cryer", WEIGHT, Some("it has no weight")),
            ("cryer", LAW, Some("the problem has its own law")),
            ("cryer", "column.loading_time=1", Some("its load acts at once, or in waves")),
            ("barron", WATER, Some("its water is incompressible")),
            ("davis-raymond", WATER, Some("its water is incompressible")),
            ("cryer", WATER, None),
            ("seabed", WATER, None),
            ("cryer", "drain.radius=0.1", Some("it is for `barron`, `barron-free-strain`")),
            ("barron", "wave.period=1", Some("it is for `seabed`")),
            ("barron", "drain.radius=wide", Some(&*wide)),
            ("barron", "drain.radius=1 s", Some(&*second)),
            (
                "cryer",
                "material.biot_coefficient=1 m",
                Some("`material.biot_coefficient` must be a number, got \"1 m\""),
            ),
        ] {
            let set = Assignments { assignments: vec![typed.to_owned()] };
            let kind: ReferenceKind = problem.parse().expect("a problem");
            let of = set.of_problem(kind).and_then(|(others, _)| {
                others.refuse_ignored(kind, false)?;
                Ok(others.assignments)
            });
            let others = of.map_err(|error| error.to_string());
            let key = typed.split('=').next().unwrap_or_default();
            let wanted = match told {
                None => Ok(set.assignments),
                Some(whole) if whole.starts_with('`') => Err(whole.to_owned()),
                Some(why) => Err(format!("`--set {key}` has no effect in `{problem}`: {why}")),
            };
            assert_eq!(others, wanted, "{problem} {typed}");
        }
        for (reference, is_taken) in [("barron", true), ("barron-free-strain", false), ("terzaghi", false)] {
            let outputs = Outputs { reference: Some(reference.to_owned()), ..Outputs::default() };
            let told = Asked::of_scene("barron", &outputs).err().map(|error| error.to_string());
            let wanted = format!("`barron` has no reference `{reference}`: it is its own");
            assert_eq!(told, (!is_taken).then_some(wanted), "{reference}");
        }
    }
}
