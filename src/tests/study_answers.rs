//! What the checker makes of studies with one edit each: the cases and expectations it reads, or its whole complaint. And which
//! key each scene takes, in its table and in a sweep.

use crate::case::Case;
use crate::case::keys::{KEYS, Key, Kind, Range};
use crate::case::work_estimate::{estimated_seconds, estimated_steps, estimated_updates, seconds_per_step};
use crate::study::check::Study;
use crate::study::file::StudySource;
use crate::study::overrides::{numbers, step_rule};
use crate::study::units::{has_unit, in_si, leading_number};
use crate::tests::assert_snapshot;
use oedometer_problem::integrator::IntegratorKind;
use oedometer_problem::method::Method;
use oedometer_scenes::SCENES;
use oedometer_wording::rounded;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

/// What is read of a study, in a few lines.
fn told(name: &str, text: &str) -> String {
    let source = StudySource { name: name.to_owned(), text: text.to_owned() };
    let study = match Study::check(&source) {
        Ok(study) => study,
        Err(error) => return error.to_string(),
    };
    let mut lines = vec![format!(
        "{} \"{}\" \"{}\" {} {:?}, {} s a case, {} timed, race {}",
        study.name,
        study.title,
        study.summary,
        study.scene.name,
        study.references,
        study.case_seconds,
        study.timing_repeats,
        study.is_race
    )];
    for planned in &study.planned {
        let case = &planned.case;
        let values = KEYS.iter().filter(|key| key.get(case) != key.get(&study.planned[0].case));
        let values: Vec<_> = values.map(|key| format!("{} {}", key.name, key.get(case))).collect();
        lines.push(format!(
            "case {} ({:?}): {} at {:?}",
            case.label(),
            planned.tier,
            values.join(", "),
            case.time_factors
        ));
    }
    lines.extend(study.expectations.iter().map(|one| {
        let measure = &one.measure;
        format!("series {:?} {measure:?} {:?} {:?} {:?}", one.selection, one.axis, one.demand, one.tier)
    }));
    lines.extend(
        study.case_expectations.iter().map(|one| {
            format!("single {:?} {:?} {:?} line {}", one.selection, one.demand, one.tier, one.line)
        }),
    );
    lines.extend(study.solvers.iter().map(|solver| format!("{solver:?}")));
    lines.extend(study.not_applicable.iter().map(|(name, why)| format!("not applicable: {name}: {why}")));
    lines.extend(study.warnings.iter().map(|warning| format!("warning {warning}")));
    lines.join("\n")
}

/// What is read of a study as it is, and what each edit changes in that: the complaint, or the lines that go and come.
fn edits(text: &mut String, name: &str, study: &str, edits: &[(&str, &str)]) {
    let whole = told(name, study);
    writeln!(text, "## as it is\n{whole}\n").expect("memory");
    for (from, to) in edits {
        assert!(study.contains(from), "{from}");
        let said = told(name, &study.replacen(from, to, 1));
        let said = if said.starts_with("error") { said } else { changed_lines(&whole, &said) };
        writeln!(text, "## {from:?} → {to:?}\n{said}\n").expect("memory");
    }
}

/// Lines of a text that another lacks, and those that it has besides.
fn changed_lines(before: &str, after: &str) -> String {
    let lacking = |text: &str, other: &str, sign: &str| -> Vec<String> {
        let other: Vec<&str> = other.lines().collect();
        text.lines().filter(|line| !other.contains(line)).map(|line| format!("{sign} {line}")).collect()
    };
    let changed = [lacking(before, after, "-"), lacking(after, before, "+")].concat();
    if changed.is_empty() { "as before".to_owned() } else { changed.join("\n") }
}

const COLUMN: &str = r#"title = "a column"
summary = "why"
scene = "terzaghi"
case_seconds = 90.0
column = { height = 2.5, load = 40.0 }
material = { youngs_modulus = 3.2e6, porosity = 0.37 }
timing.repeats = 3
output = { time_factors = [0.3, 0.07], references = ["terzaghi-incompressible", "terzaghi"] }

[[sweep]]
method = ["MPM", "GC-SRI-patch"]
integrator = ["implicit"]
cells = [4, 8, 16]
points_per_cell = [2, 3]
time_step = [{ growth = 0.05 }]

[[expect]]
method = "MPM"
points_per_cell = 2
time_factor = 0.07
order = { value = 2.0 }

[[expect_case]]
method = "GC-SRI-patch"
status = "ok"
"#;

/// The lines of the column that most edits are about.
const ORDER: &str = "order = { value = 2.0 }";
const CASE: &str = "status = \"ok\"";

/// Edits of the column.
const FOR_COLUMNS: &[(&str, &str)] = &[
    // The head.
    ("title = \"a column\"\n", ""),
    ("summary = \"why\"\n", "sumary = \"why\"\n"),
    ("\"terzaghi\"\ncase", "\"terzagi\"\ncase"),
    ("\"terzaghi\"\ncase", "\"xie-leo\"\ncase"),
    ("\"terzaghi\"\ncase", "\"at-rest\"\ncase"),
    ("\"terzaghi\"\ncase", "\"cosine-layer\"\ncase"),
    ("case_seconds = 90.0", "case_seconds = 0.0"),
    ("case_seconds = 90.0", "case_seconds = \"2 min\""),
    ("case_seconds = 90.0", "task = \"stability\""),
    ("case_seconds = 90.0\n", ""),
    ("repeats = 3", "repeats = 1001"),
    ("timing.repeats = 3\n", ""),
    ("title", "= title"),
    // The column and the soil.
    ("height = 2.5", "height = \"250 cm\""),
    ("height = 2.5", "height = \"2.5 kPa\""),
    ("height = 2.5", "height = 0.0"),
    ("height = 2.5", "height = [2.5]"),
    ("height = 2.5", "heigth = 2.5"),
    ("load = 40.0", "strain = 0.1"),
    ("load = 40.0", "strain = 1.0"),
    ("load = 40.0", "strain = 0.0"),
    ("load = 40.0", "load = 40.0, strain = 0.1"),
    ("load = 40.0", "load = 40.0, loading_time = 3.0"),
    ("load = 40.0", "load = 40.0, self_weight = true"),
    ("load = 40.0", "load = 40.0, initial_stress = 3.0"),
    ("load = 40.0", "load = 40.0, dimensions = 2"),
    ("load = 40.0", "load = 40.0, dimensions = 3"),
    ("load = 40.0", "load = 40.0, soils = [{ thickness = 2.5 }]"),
    ("load = 40.0", "load = 2e5"),
    ("youngs_modulus = 3.2e6", "youngs_modulus = 3.2"),
    ("youngs_modulus = 3.2e6", "youngs_modulus = 99.9"),
    ("youngs_modulus = 3.2e6", "youngs_modulus = 100.0"),
    ("youngs_modulus = 3.2e6", "water_bulk_modulus = 999.0"),
    ("youngs_modulus = 3.2e6", "water_bulk_modulus = 1000.0"),
    ("youngs_modulus = 3.2e6", "grain_density = 2.65"),
    ("youngs_modulus = 3.2e6", "grain_density = 26.5"),
    ("youngs_modulus = 3.2e6", "water_density = 1.0"),
    ("youngs_modulus = 3.2e6", "poissons_ratio = 25.0"),
    ("youngs_modulus = 3.2e6", "porosity_0 = 0.2"),
    ("youngs_modulus = 3.2e6", "undrained_strength = 3e3"),
    ("youngs_modulus = 3.2e6", "reload_modulus = 3e6"),
    ("youngs_modulus = 3.2e6", "law = \"neo-hookean\""),
    ("youngs_modulus = 3.2e6", "law = \"von-mises\""),
    ("youngs_modulus = 3.2e6", "conductivity_mean = \"chord\""),
    ("youngs_modulus = 3.2e6", "continuity = \"constant-porosity-gradient\""),
    ("porosity = 0.37", "porosity = 37.0"),
    // Outputs.
    ("time_factors = [0.3, 0.07]", "time_factors = []"),
    ("time_factors = [0.3, 0.07]", "time_factors = [0.3, 0.07, 0.3, -0.0]"),
    ("time_factors = [0.3, 0.07]", "time_factors = [0.07, 101.0]"),
    ("time_factors = [0.3, 0.07]", "time_factors = [0.07, -1e-7]"),
    ("time_factors = [0.3, 0.07]", "time_factors = [0.07, 1e-16]"),
    ("time_factors = [0.3, 0.07]", "time_factors = [0.07, \"late\"]"),
    ("time_factors = [0.3, 0.07], ", ""),
    ("\"terzaghi-incompressible\", \"terzaghi\"]", "\"terzaghi-incompressible\"]"),
    ("\"terzaghi-incompressible\", \"terzaghi\"]", "\"terzaghi\", \"terzaghi\"]"),
    ("\"terzaghi-incompressible\", \"terzaghi\"]", "\"terzaghi\", \"mandel\"]"),
    ("\"terzaghi-incompressible\", \"terzaghi\"]", "]"),
    // Sweeps.
    ("method = [\"MPM\", \"GC-SRI-patch\"]", "method = \"MPM\""),
    ("method = [\"MPM\", \"GC-SRI-patch\"]", "method = [\"MPM\", \"GC-SRI-pach\"]"),
    ("method = [\"MPM\", \"GC-SRI-patch\"]", "method = [\"MPM\", \"TL-GIMP-SRI\"]"),
    ("method = [\"MPM\", \"GC-SRI-patch\"]", "method = [\"race\"]"),
    ("method = [\"MPM\", \"GC-SRI-patch\"]", "method = [\"race\", \"MPM\"]"),
    ("method = [\"MPM\", \"GC-SRI-patch\"]\nintegrator", "integrator"),
    ("cells = [4, 8, 16]\n", ""),
    ("cells = [4, 8, 16]", "cells = []"),
    ("cells = [4, 8, 16]", "cells = [4, 8, 100001]"),
    ("cells = [4, 8, 16]", "cells = [4, 8, 16.5]"),
    ("cells = [4, 8, 16]", "cells = [16, 8, 4, 8]"),
    ("cells = [4, 8, 16]", "cells = [8]"),
    ("cells = [4, 8, 16]", "cells = [4, 8]"),
    ("cells = [4, 8, 16]", "cells = [4, 8, 100000]\nporosity = [0.3, 0.4]"),
    ("points_per_cell = [2, 3]", "points_per_cell = [17]"),
    ("points_per_cell = [2, 3]", "points_per_cell = [2, 3]\nwater_per_cell = [2]"),
    ("points_per_cell = [2, 3]", "points_per_cell = [2, 3]\nsets = [2]\nwater_per_cell = [2, 4]"),
    ("points_per_cell = [2, 3]", "points_per_cell = [2, 3]\nheight = [1.0, 2.0]"),
    ("points_per_cell = [2, 3]", "points_per_cell = [2, 3]\nlength = [1.0, 2.0]"),
    ("points_per_cell = [2, 3]", "points_per_cell = [2, 3]\nplate_width = [1.0, 2.0]"),
    ("points_per_cell = [2, 3]", "points_per_cell = [2, 3]\ntier = \"full\""),
    ("points_per_cell = [2, 3]", "points_per_cell = [2, 3]\ntier = \"all\""),
    ("points_per_cell = [2, 3]", "points_per_cell = [2, 3]\ntime_factors = [0.07]"),
    ("points_per_cell = [2, 3]", "points_per_cell = [2, 3]\npath = [\"cells\", \"points_per_cell\"]"),
    ("points_per_cell = [2, 3]", "points_per_cell = [2, 3, 2]\npath = [\"cells\", \"points_per_cell\"]"),
    ("points_per_cell = [2, 3]", "points_per_cell = [2, 3]\npath = []"),
    ("points_per_cell = [2, 3]", "points_per_cell = [2, 3]\npath = [\"cell\"]"),
    ("points_per_cell = [2, 3]", "points_per_cell = [2, 3]\njitter = [0.1]\noffset = [0.6]"),
    ("integrator = [\"implicit\"]", "integrator = [\"implicit\", \"explict\"]"),
    ("integrator = [\"implicit\"]", "integrator = [\"explicit\"]"),
    ("integrator = [\"implicit\"]", "drag = [\"implicit\", \"explicit\"]"),
    ("integrator = [\"implicit\"]\n", ""),
    ("time_step = [{ growth = 0.05 }]", "time_step = [{ growth = 0.05, seconds = 1.0 }]"),
    ("time_step = [{ growth = 0.05 }]", "time_step = [{}]"),
    ("time_step = [{ growth = 0.05 }]", "time_step = [{ growth = 1.5 }]"),
    ("time_step = [{ growth = 0.05 }]", "time_step = [{ growth = 1e-10 }]"),
    ("time_step = [{ growth = 0.05 }]", "time_step = [{ tolerance = 1e-13 }]"),
    (
        "time_step = [{ growth = 0.05 }]",
        "time_step = [{ tolerance = 1e-4 }, { seconds = \"2 min\" }, { stable = 0.5 }]",
    ),
    ("time_step = [{ growth = 0.05 }]", "time_step = [{ courant = -0.5 }]"),
    ("time_step = [{ growth = 0.05 }]\n", ""),
    // Expectations of series.
    ("method = \"MPM\"\npoints", "method = \"VP\"\npoints"),
    ("method = \"MPM\"\npoints", "method = \"MPM\"\nporosity = 0.3\npoints"),
    ("points_per_cell = 2\ntime", "points_per_cell = 5\ntime"),
    ("points_per_cell = 2\ntime", "time"),
    ("time_factor = 0.07\n", ""),
    ("time_factor = 0.07", "time_factor = 0.1"),
    ("time_factor = 0.07", "time_factor = 0.07\nquantity = \"settlement\""),
    ("time_factor = 0.07", "time_factor = 0.07\nquantity = \"settlement\"\nnorm = \"l1\""),
    ("time_factor = 0.07", "time_factor = 0.07\nquantity = \"settlement\"\nsample = \"nodes\""),
    ("time_factor = 0.07", "time_factor = 0.07\nquantity = \"load_factor\"\nsample = \"nodes\""),
    (
        "time_factor = 0.07",
        "time_factor = 0.07\nquantity = \"displacement\"\nnorm = \"linf\"\nsample = \"nodes\"",
    ),
    ("time_factor = 0.07", "time_factor = 0.07\nsample = \"surface\""),
    ("time_factor = 0.07", "time_factor = 0.07\nnorm = \"relative\""),
    ("time_factor = 0.07", "time_factor = 0.07\nreference = \"terzaghi-incompressible\"\ntier = \"full\""),
    ("time_factor = 0.07", "time_factor = 0.07\nreference = \"mandel\""),
    ("time_factor = 0.07", "time_factor = 0.07\nreference = \"next-finer\""),
    ("time_factor = 0.07", "time_factor = 0.07\nreference = \"none\""),
    ("time_factor = 0.07", "time_factor = 0.07\nreference = \"none\"\nprobe = 0.5"),
    ("time_factor = 0.07", "time_factor = 0.07\nreference = \"none\"\nprobe = 1.0"),
    ("time_factor = 0.07", "time_factor = 0.07\nreference = \"none\"\nprobe = 0.0"),
    ("time_factor = 0.07", "time_factor = 0.07\nprobe = 0.5"),
    ("time_factor = 0.07", "time_factor = 0.07\naxis = \"points_per_cell\""),
    ("time_factor = 0.07", "time_factor = 0.07\naxis = \"time_step\""),
    ("time_factor = 0.07", "time_factor = 0.07\naxis = \"cell\""),
    (ORDER, "class = \"asymptotic\""),
    (ORDER, "class = \"asymptotical\""),
    (ORDER, "class = \"not-evaluable\""),
    (ORDER, "order = { value = 2.0, minus = 0.3, plus = 0.4 }"),
    (ORDER, "order = { value = -2.0 }"),
    (ORDER, "order = { value = 2.0, minus = -0.1 }"),
    (ORDER, "order = 2.0"),
    (ORDER, "at = { cells = 8, below = 0.1 }"),
    (ORDER, "at = { cells = 8, below = 0.1, above = 0.01 }"),
    (ORDER, "at = { cells = 8, below = 0.1, above = 0.2 }"),
    (ORDER, "at = { cells = 9, below = 0.1 }"),
    (ORDER, "at = { points_per_cell = 2, below = 0.1 }"),
    (ORDER, "at = { cells = 8 }"),
    (ORDER, "spread = { cells = 8, below = 0.1 }"),
    (ORDER, "spread = { cells = 8, below = -0.1 }"),
    (ORDER, "floor = { below = 0.1 }"),
    (ORDER, "floor = { above = 0.1 }"),
    (ORDER, "floor = { above = 0.2, below = 0.1 }"),
    (ORDER, "oscillation = { below = 0.1 }"),
    (ORDER, "uncertainty = { below = 0.1 }"),
    (ORDER, "uncertainty = { below = 0.1 }\nreference = \"none\"\nprobe = 0.25"),
    (ORDER, "at = { cells = 8, below = 0.1 }\nreference = \"none\"\nprobe = 0.25"),
    (ORDER, "oscillation = { below = 0.1 }\nreference = \"none\"\nprobe = 0.25"),
    (ORDER, "order = { value = 2.0 }\nxfail = { reason = \"known\" }"),
    (ORDER, "order = { value = 2.0 }\nxfail = { reason = \"known\", strict = false }"),
    (ORDER, "order = { value = 2.0 }\nxfail = { reason = \" \" }"),
    (ORDER, ""),
    // Expectations of single cases.
    (CASE, "status = \"unstable\""),
    (CASE, "status = \"fine\""),
    (CASE, ""),
    (
        CASE,
        "critical_step_within = 0.02\nsolid_drift_below = 1e-9\nwater_drift_below = 1e-8\nwater_left_within = 0.1\none_set_within = 1e-3",
    ),
    (CASE, "critical_step_within = 0.0"),
    (
        CASE,
        "pore_water = { above = 0.1, below = 0.2 }\nlargest_pressure = { below = 3.0 }\npeak_time_factor = { above = 0.1 }\npeak_pressure = { below = 2.0 }",
    ),
    (CASE, "pore_water = { above = 0.2, below = 0.2 }"),
    (CASE, "spurious_velocity = { below = 0.1 }"),
    (CASE, "error = { below = 0.1 }"),
    (CASE, "error = { below = 0.1 }\ntime_factor = 0.1"),
    (
        CASE,
        "error = { below = 0.1, above = 0.01 }\ntime_factor = 0.3\nquantity = \"settlement\"\ntier = \"smoke\"",
    ),
    (CASE, "error = { below = 0.1 }\ntime_factor = 0.3\nquantity = \"settlement\"\nnorm = \"l2\""),
    (
        CASE,
        "error = { below = 0.1 }\ntime_factor = 0.3\nreference = \"terzaghi-incompressible\"\nsample = \"centres\"\nnorm = \"l1\"",
    ),
    (CASE, "status = \"ok\"\ncells = 5"),
];

/// Edits of the layers of soil.
const OF_SOIL_LAYERS: &[(&str, &str)] = &[
    ("thickness = 1.5", "thickness = 1.4"),
    ("thickness = 1.5", "thickness = 5.0"),
    ("thickness = 1.5", "thickness = -1.5"),
    ("thickness = 1.5\n", ""),
    ("thickness = 1.5", "thickness = 1.5\nyoungs_modulus = 0.0"),
    ("thickness = 1.5", "thickness = 1.5\nhydraulic_conductivity = \"1 cm/s\""),
    ("load = 40.0\n", "strain = 0.1\n"),
    ("\"layered\"", "\"terzaghi\""),
];

#[test]
fn studies_of_columns_with_one_edit() {
    let mut text = String::new();
    let soils = "\n[[column.soils]]\nthickness = 1.0\n[[column.soils]]\nthickness = 1.5\nporosity = 0.5\n";
    let layered = COLUMN
        .replace("\"terzaghi\"\ncase", "\"layered\"\ncase")
        .replace("[\"terzaghi-incompressible\", \"terzaghi\"]", "[]");
    let layered = layered
        .replace("column = { height = 2.5, load = 40.0 }\n", "")
        .replace(ORDER, "reference = \"none\"\nquantity = \"settlement\"\nuncertainty = { below = 0.1 }");
    let layered = layered + "\n[column]\nheight = 2.5\nload = 40.0\n" + soils;
    edits(&mut text, "t.toml", COLUMN, FOR_COLUMNS);
    edits(&mut text, "t.toml", &layered, OF_SOIL_LAYERS);
    assert_snapshot("study_columns", &text);
}

const LAYER: &str = r#"title = "a layer"
scene = "cosine-layer"
layer = { length = 2.0, height = 1.0, load = 30.0, base = "smooth" }
output.time_factors = [0]

[[sweep]]
method = ["GIMP-SRI"]
integrator = ["implicit"]
cells = [2, 4, 8]
time_step = [{ seconds = 0.1 }]

[[expect]]
method = "GIMP-SRI"
time_factor = 0
order = { value = 1.0 }
"#;

/// Edits of the layer.
const OF_LAYERS: &[(&str, &str)] = &[
    ("length = 2.0", "length = 2.3"),
    ("length = 2.0", "plate_width = 2.0"),
    ("base = \"smooth\"", "base = \"wet\""),
    ("layer = {", "column = {"),
    ("output", "manufactured.frequency = 2.0\noutput"),
    ("time_factor = 0\n", "time_factor = 0\noscillation = { below = 0.1 }\n"),
    ("time_factor = 0\n", "time_factor = 0\noscillation = { below = 0.1 }\nsample = \"nodes\"\n"),
    ("time_factor = 0\n", "time_factor = 0\nreference = \"none\"\nquantity = \"displacement\"\n"),
    ("\"cosine-layer\"", "\"mandel\""),
];

/// Edits of the footing.
const OF_FOOTINGS: &[(&str, &str)] = &[
    ("plate = \"rough\"", "load = 3.0"),
    ("plate = \"rough\"", "undrained = \"two-phase\""),
    ("cells = [2, 4, 8]", "cells = [2, 4, 8]\nundrained_strength = [3e3, 5e3]"),
    ("output", "points.offset = 0.1\noutput"),
    ("quantity = \"load_factor\"\n", ""),
];

/// Edits of the square.
const OF_SQUARES: &[(&str, &str)] = &[
    ("amplitude = 0.5", "amplitude_x = 0.5"),
    ("amplitude = 0.5", "frequency = 0.0"),
    ("amplitude = 0.5", "amplitude = 4.5"),
    ("manufactured = {", "column.strain = 0.1\nmanufactured = {"),
    ("manufactured = {", "points.jitter = 0.1\nmanufactured = {"),
    ("manufactured = {", "task = \"stability\"\nmanufactured = {"),
    ("manufactured = {", "material.conductivity_mean = \"chord\"\nmanufactured = {"),
    ("cells = [2, 4, 8]", "cells = [2, 4, 8]\njitter = [0.1]\nheight = [2.0]"),
    ("\"GIMP-SRI\"]", "\"TL-GIMP-SRI\"]"),
];

/// Edits of the yield front.
const OF_FRONTS: &[(&str, &str)] = &[
    ("[0.0002]", "[0.0002, 0.5]"),
    ("load = 40.0", "load = 4000.0, initial_stress = 3e3"),
    ("porosity = 0.37", "porosity = 0.37, preconsolidation = 5e4, reload_modulus = 1e7"),
    ("porosity = 0.37", "porosity = 0.37, preconsolidation = 1.0, reload_modulus = 1e5"),
];

/// Edits of the column at large strain.
const OF_LARGE_STRAINS: &[(&str, &str)] = &[
    ("load = 40.0", "load = 4e6"),
    ("load = 40.0", "strain = 0.2"),
    ("load = 40.0", "strain = 0.5"),
    ("load = 40.0", "loading_time = 5.0"),
    ("porosity = 0.37", "porosity = 0.37, conductivity_mean = \"chord\""),
    ("porosity = 0.37", "porosity = 0.37, law = \"log-linear\""),
    ("[\"MPM\", \"GC-SRI-patch\"]", "[\"MPM\", \"GC-SRI-patch\", \"TL-GIMP-SRI\", \"uGIMP-SRI\"]"),
];

#[test]
fn studies_of_other_bodies_with_one_edit() {
    let mut text = String::new();
    edits(&mut text, "t.toml", LAYER, OF_LAYERS);
    let footing = LAYER
        .replace("cosine-layer", "footing")
        .replace("[0]", "[1.0]")
        .replace("factor = 0", "factor = 1.0");
    let footing = footing.replace(
        "length = 2.0, height = 1.0, load = 30.0, base = \"smooth\"",
        "plate_width = 3.0, plate = \"rough\"",
    );
    let footing = footing.replace(
        "time_factor = 1.0\n",
        "time_factor = 1.0\nquantity = \"load_factor\"\nat = { cells = 4, below = 0.3 }\n",
    );
    let footing = footing.replace("{ seconds = 0.1 }", "{ growth = 0.1 }");
    edits(&mut text, "t.toml", &footing, OF_FOOTINGS);
    let square = LAYER
        .replace("cosine-layer", "manufactured-vortex")
        .replace("[0]", "[0.5]")
        .replace("factor = 0", "factor = 0.5");
    let square = square.replace(
        "layer = { length = 2.0, height = 1.0, load = 30.0, base = \"smooth\" }",
        "manufactured = { amplitude = 0.5, pressure = 3.0 }",
    );
    let square =
        square.replace("integrator = [\"implicit\"]\n", "").replace("{ seconds = 0.1 }", "{ courant = 0.4 }");
    edits(&mut text, "t.toml", &square, OF_SQUARES);
    let front = COLUMN
        .replace("\"terzaghi\"\ncase", "\"yield-front\"\ncase")
        .replace(", references = [\"terzaghi-incompressible\", \"terzaghi\"]", "");
    let front = front.replace("[0.3, 0.07]", "[0.0002]").replace("0.07", "0.0002");
    edits(&mut text, "t.toml", &front, OF_FRONTS);
    let large = COLUMN
        .replace("\"terzaghi\"\ncase", "\"xie-leo\"\ncase")
        .replace(", references = [\"terzaghi-incompressible\", \"terzaghi\"]", "");
    edits(&mut text, "t.toml", &large, OF_LARGE_STRAINS);
    assert_snapshot("study_bodies", &text);
}

const ATTACHED: &str = r#"title = "attached"
scene = "terzaghi"
output.time_factors = [0.1]

[[solver]]
name = "theirs"
command = ["python3", "adapter.py", "{case}", "{out}", "{cells}"]
result = "{out}/result.csv"

[[result]]
name = "left"
files = ["left-{cells}.csv"]
cells = [4, 8]

[[sweep]]
method = ["theirs", "MPM"]
integrator = ["implicit"]
cells = [4, 8]
time_step = [{ growth = 0.05 }]
"#;

/// The line of the attached solver that most edits are about.
const RESULT: &str = "result = \"{out}/result.csv\"";

/// Edits of the study with an attached solver.
const OF_ATTACHED: &[(&str, &str)] = &[
    ("name = \"theirs\"", "name = \"MPM\""),
    ("name = \"theirs\"", "name = \"left\""),
    ("name = \"theirs\"", "name = \"their,s\""),
    ("name = \"theirs\"", "name = \"\""),
    ("name = \"left\"", "name = \"theirs\""),
    ("command = [\"python3\", \"adapter.py\", \"{case}\", \"{out}\", \"{cells}\"]", "command = []"),
    ("\"{cells}\"]", "\"{cell}\"]"),
    ("\"{cells}\"]", "\"a\\u0000b\"]"),
    ("\"{cells}\"]", "\"other.py\"]"),
    (RESULT, "result = \"result.csv\""),
    (RESULT, "result = \"{out}/../result.csv\""),
    (RESULT, "result = \"{out}/\""),
    (RESULT, "result = \"{out}/r-{point}.csv\""),
    (
        RESULT,
        "result = \"{out}/result.csv\"\nversion = [\"python3\", \"--version\"]\ntimeout = \"2 min\"\nrepeats = 3\nat_once = 2",
    ),
    (RESULT, "result = \"{out}/result.csv\"\nversion = [\"{out}\"]"),
    (RESULT, "result = \"{out}/result.csv\"\ntimeout = -1.0\nrepeats = 101\nat_once = 1025"),
    (RESULT, "result = \"{out}/result.csv\"\nrepeats = 0\nat_once = 0\nwarm_up = true\ntime_step = 0.5"),
    (
        RESULT,
        "result = \"{out}/result.csv\"\npreset = \"ogs\"\nmapping = \"map.toml\"\nfiles = [\"other.py\"]",
    ),
    (
        RESULT,
        "result = \"{out}/result.csv\"\npreset = \"oggs\"\nmapping = \"none.toml\"\nfiles = [\"none.py\"]",
    ),
    (RESULT, "result = \"{out}/result.csv\"\nsolve_seconds = \"took ([0-9.]+)\"\nsolve_unit = \"ms\""),
    (RESULT, "result = \"{out}/result.csv\"\nsolve_seconds = \"took [0-9.]+\"\nsolve_unit = \"y\""),
    (RESULT, "result = \"{out}/result.csv\"\nsolve_seconds = \"took (\""),
    (RESULT, "result = \"{out}/result.csv\"\nsolve_unit = \"ms\""),
    (RESULT, "result = \"{out}/result.csv\"\nenv = { A = \"1\", B = \"{cells}\" }"),
    (RESULT, "result = \"{out}/result.csv\"\nenv = { \"A=B\" = \"1\", C = \"{no}\" }"),
    ("files = [\"left-{cells}.csv\"]", "files = []"),
    ("files = [\"left-{cells}.csv\"]", "files = [\"left.csv\"]"),
    ("files = [\"left-{cells}.csv\"]", "files = [\"left-{out}.csv\"]"),
    ("cells = [4, 8]\n\n[[sweep]]", "cells = []\n\n[[sweep]]"),
    ("cells = [4, 8]\n\n[[sweep]]", "cells = [4, 0]\n\n[[sweep]]"),
    (
        "cells = [4, 8]\n\n[[sweep]]",
        "cells = [4]\ntier = \"full\"\ntime_step = 0.25\nmapping = \"map.toml\"\n\n[[sweep]]",
    ),
    ("method = [\"theirs\", \"MPM\"]", "method = [\"thers\", \"MPM\"]"),
    ("\"terzaghi\"", "\"manufactured-box\""),
];

#[test]
fn studies_of_attached_solvers_with_one_edit() {
    let folder = tempfile::TempDir::new().expect("a folder");
    for name in ["adapter.py", "map.toml", "left-4.csv", "left-8.csv", "other.py"] {
        std::fs::write(folder.path().join(name), name).expect("a file");
    }
    let name = folder.path().join("t.toml").display().to_string();
    let mut text = String::new();
    edits(&mut text, &name, ATTACHED, OF_ATTACHED);
    let text = text.replace(&folder.path().display().to_string(), "FOLDER");
    assert_snapshot("study_attached", &text);
}

/// Values that a key may be given: of a word all, of a number one inside its range.
fn values(kind: Kind) -> Vec<String> {
    match kind {
        Kind::Word(words) => words.iter().map(|word| format!("\"{word}\"")).collect(),
        Kind::Flag => vec!["true".to_owned(), "false".to_owned()],
        Kind::Count(_) => vec!["2".to_owned()],
        Kind::Number(Range::Between(least, most) | Range::Within(least, most, ..)) => {
            vec![format!("{:?}", least + 0.3 * (most - least))]
        }
        Kind::Number(_) => vec!["0.75".to_owned()],
        Kind::TimeStep => vec!["{ growth = 0.1 }".to_owned()],
        Kind::Method => vec!["\"GIMP\"".to_owned()],
    }
}

/// The first complaint about a study, and how many there are.
fn complaint(text: &str) -> String {
    let source = StudySource { name: "t.toml".to_owned(), text: text.to_owned() };
    match Study::check(&source) {
        Ok(_) => "taken".to_owned(),
        Err(error) => {
            let first = &error.diagnostics[0];
            format!("{} ({})", first.message, first.help.as_deref().unwrap_or_default())
        }
    }
}

#[test]
fn every_scene_takes_its_keys_and_says_why_it_refuses_others() {
    let mut text = String::new();
    for scene in SCENES {
        writeln!(text, "## {}", scene.name).expect("memory");
        let head = format!("title = 't'\nscene = '{}'\noutput.time_factors = [0.0002]\n", scene.name);
        let mut told: BTreeMap<String, Vec<String>> = BTreeMap::new();
        for key in KEYS {
            for value in values(key.kind) {
                for table in key.tables {
                    let (place, given) = match *table {
                        "sweep" => (format!("{} = [{value}]\n", key.name), ""),
                        table => (String::new(), table),
                    };
                    let given = if given.is_empty() {
                        String::new()
                    } else {
                        format!("{given}.{} = {value}\n", key.name)
                    };
                    let method = if key.name == "method" { "" } else { "method = ['GIMP-SRI']\n" };
                    let step =
                        if key.name == "time_step" { "" } else { "time_step = [{ seconds = 0.01 }]\n" };
                    let cells = if key.name == "cells" { "" } else { "cells = [4]\n" };
                    let study = format!("{head}{given}[[sweep]]\n{method}{cells}{step}{place}");
                    told.entry(complaint(&study)).or_default().push(format!("{table}.{} {value}", key.name));
                }
            }
        }
        for (what, keys) in told {
            writeln!(text, "{what}:\n    {}", keys.join(", ")).expect("memory");
        }
    }
    assert_snapshot("study_keys_of_scenes", &text);
}

#[test]
fn every_shipped_study_is_read_as_it_was() {
    let mut text = String::new();
    for name in crate::study::shipped::shipped_names() {
        let source = crate::study::shipped::shipped_study(&name).expect("it is shipped");
        let study = Study::check(&source).expect("a sound study");
        let own = Path::new(&source.name).file_stem().expect("a name").to_string_lossy().into_owned();
        let [smoke, ci, full] =
            [crate::Tier::Smoke, crate::Tier::Ci, crate::Tier::Full].map(|tier| study.cases(tier).len());
        let warnings = study.warnings.len();
        writeln!(
            text,
            "{own}: {} cases {smoke}/{ci}/{full}, {} series, {} single, left out {:?}, {warnings} warnings",
            study.scene.name,
            study.expectations.len(),
            study.case_expectations.len(),
            study.not_applicable
        )
        .expect("memory");
        let last = study.planned.last().expect("a case");
        let [first, last] = [&study.planned[0].case, &last.case].map(Case::label);
        writeln!(text, "    {first} … {last}").expect("memory");
        for case in [&study.planned[0].case, &study.planned.last().expect("a case").case] {
            writeln!(
                text,
                "    {} steps, {} updates, {} s a step, {} s, {} bytes",
                rounded(estimated_steps(case)),
                estimated_updates(case),
                rounded(seconds_per_step(case)),
                rounded(estimated_seconds(case)),
                rounded(case.estimated_bytes())
            )
            .expect("memory");
        }
    }
    assert_snapshot("study_shipped", &text);
}

#[test]
fn options_that_exclude_each_other_say_why() {
    let mut seed = 20_261_126_u64;
    let mut place = |below: usize| {
        seed = seed * 48_271 % 2_147_483_647;
        usize::try_from(seed).expect("small") / 11 % below
    };
    let methods = Method::names();
    let own = "{ basis = 'bspline2', strain = 'standard', pressure = 'sri', recovery = 'patch' }";
    let keys: Vec<_> = Key::in_table("sweep")
        .filter(|key| !["method", "integrator", "cells", "time_step", "height", "load"].contains(&key.name))
        .collect();
    let mut told: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for _ in 0..1500 {
        let scene = SCENES[place(SCENES.len())].name;
        let method = match place(8) {
            0 => own.to_owned(),
            _ => format!("'{}'", methods[place(methods.len())]),
        };
        let integrator = IntegratorKind::NAMES[place(IntegratorKind::NAMES.len())];
        let mut lines = vec![format!("method = [{method}]"), format!("integrator = ['{integrator}']")];
        for _ in 0..=place(3) {
            let key = keys[place(keys.len())];
            let all = values(key.kind);
            let line = format!("{} = [{}]", key.name, all[place(all.len())]);
            if !lines.iter().any(|other| other.starts_with(&format!("{} =", key.name))) {
                lines.push(line);
            }
        }
        let step =
            ["growth = 0.1", "stable = 0.8", "seconds = 0.01", "tolerance = 1e-3", "courant = 0.5"][place(5)];
        lines.push(format!("time_step = [{{ {step} }}]"));
        let head = format!("title = 't'\nscene = '{scene}'\noutput.time_factors = [0.0002]\n");
        let study = format!("{head}[[sweep]]\ncells = [4]\n{}\n", lines.join("\n"));
        told.entry(complaint(&study)).or_default().push(format!("{scene}: {}", lines.join(", ")));
    }
    let mut text = String::new();
    for (what, cases) in told {
        writeln!(text, "{what}: {} times\n    {}", cases.len(), cases[..cases.len().min(3)].join("\n    "))
            .expect("memory");
    }
    assert_snapshot("study_options", &text);
}

/// Numbers with and without units, and what is none.
const TYPED: &[&str] = &[
    "50 kPa",
    "50kPa",
    "50",
    "5 MPa",
    "2.2 GPa",
    "1 bar",
    "3 N/m²",
    "3 kN/m2",
    "7 mPa",
    "1e3 Pa",
    "-4 Pa",
    "5 m",
    "50 cm",
    "50 mm",
    "5 µm",
    "5 um",
    "5 km",
    "2 days",
    "1 day",
    "3 h",
    "90 min",
    "1 year",
    "5 ms",
    "12 s",
    "1 m/day",
    "1 cm/s",
    "1 m/year",
    "2650 kg/m³",
    "2.65 g/cm³",
    "2.65 t/m3",
    "9.81 m/s²",
    "9.81 m s^-2",
    "9.81 m*s-2",
    "10 kN/m³",
    "30 deg",
    "0.5 rad",
    "2 rad/s",
    "5 foo",
    "kPa",
    "",
    " 5  kPa ",
    "5 m^10",
    "1,5 m",
    "5 m/s/s",
    "inf m",
    "nan Pa",
    "0x10 m",
];

#[test]
fn numbers_with_units_are_read_as_they_were() {
    let mut text = String::new();
    for si in ["Pa", "m", "s", "m/s", "kg/m³", "m/s²", "rad", "rad/s", "N/m³", ""] {
        for typed in TYPED {
            if let Ok(value) = in_si(typed, si) {
                writeln!(text, "{typed:?} as {si}: {value:e}").expect("memory");
            }
        }
    }
    for typed in TYPED {
        writeln!(
            text,
            "{typed:?}: {:?} {} {:?}",
            leading_number(typed),
            has_unit(typed),
            in_si(typed, "Pa").err()
        )
        .expect("memory");
    }
    for typed in [
        "growth=0.1",
        "seconds=1e-3",
        "seconds=2 min",
        "stable",
        "stable=",
        "stable=x",
        "step=0.1",
        "growth = 0.1",
        "tolerance=1e-4",
    ] {
        writeln!(text, "{typed:?}: {:?}", step_rule(typed).map_err(|error| error.to_string()))
            .expect("memory");
    }
    for typed in ["0.1", "0.1,0.2", "0.1, 0.2", "0.1,,0.2", "", "a", "1e-3,nan", "0.2,0.1", "1..3"] {
        writeln!(text, "{typed:?}: {:?}", numbers("--zeta", typed).map_err(|error| error.to_string()))
            .expect("memory");
    }
    assert_snapshot("study_units", &text);
}
