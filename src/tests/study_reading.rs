//! Tests of the messages about mistakes, and of numbers with units.

use crate::cli::commands::schema::{Document, schema_of};
use crate::study::check::Study;
use crate::study::file::StudySource;
use oedometer_input::synonyms::{FIELD_TERMS, KEY_NAMES, read_as};
use oedometer_soil::laws::Law;

const SOUND: &str = "title = \"t\"\nscene = \"terzaghi\"\n[material]\nporosity = 0.3\n\
                     [[sweep]]\nmethod = [\"GIMP\"]\ncells = [4, 8]\n";

fn refusal(text: &str) -> String {
    let source = StudySource { name: "t.toml".to_owned(), text: text.to_owned() };
    Study::check(&source).expect_err(text).to_string()
}

/// The only complaint about a text: its line, what is wrong, and what would be right.
fn complaint(text: &str) -> (usize, String, String) {
    let source = StudySource { name: "t.toml".to_owned(), text: text.to_owned() };
    let mut found = Study::check(&source).expect_err(text).diagnostics;
    assert_eq!(found.len(), 1, "{found:?}");
    let one = found.remove(0);
    let start = one.span.expect("a place").start;
    (text[..start].matches('\n').count() + 1, one.message, one.help.expect("help"))
}

/// What stands in the sound study and what in its place, with ⏎ for the end of a line; the line of the mistake, what is
/// wrong, and what would be right.
const MISTAKES: &str = r#"
porosity = 0.3 ¦ porosty = 0.3 ¦ 4 ¦ unknown key `porosty` ¦ did you mean `porosity`?
porosity = 0.3 ¦ cells = 3 ¦ 4 ¦ unknown key `cells` ¦ `cells` belongs to [[sweep]]: `sweep.cells`
porosity = 0.3 ¦ loading_time = 3 ¦ 4 ¦ unknown key `loading_time` ¦ `loading_time` belongs to [column]: `column.loading_time`
porosity = 0.3 ¦ flip = 3 ¦ 4 ¦ unknown key `flip` ¦ `flip` belongs to [integrator]: `integrator.flip`
[material] ¦ [timing]⏎colour = 3⏎[material] ¦ 4 ¦ unknown key `colour` ¦ the keys here are repeats
porosity = 0.3 ¦ porosity = 30 % ¦ 4 ¦ `30 %` is not a plain number ¦ write a number in SI units (m, s, Pa), or with a unit in quotes, like "50 kPa"; a fraction like 0.3
porosity = 0.3 ¦ load = 5 kPa ¦ 4 ¦ `5 kPa` needs quotes ¦ write `load = "5 kPa"`
porosity = 0.3 ¦ law = linear ¦ 4 ¦ `linear` needs quotes ¦ write `law = "linear"`
porosity = 0.3 ¦ porosity = "0.3" ¦ 4 ¦ `porosity` takes a number, not `"0.3"` ¦ write it without quotes: `porosity = 0.3`
porosity = 0.3 ¦ porosity = "30 %" ¦ 4 ¦ `porosity` takes a number, not `"30 %"` ¦ it has no unit: write it as a plain number without quotes, like `porosity = 0.1`
porosity = 0.3 ¦ porosity = true ¦ 4 ¦ `porosity` takes a number, not `true` ¦ write it like `porosity = 0.1`
porosity = 0.3 ¦ porosity = 2026-01-01 ¦ 4 ¦ `porosity` takes a number, not `2026-01-01` ¦ write it like `porosity = 0.1`
porosity = 0.3 ¦ porosity = [0.3] ¦ 4 ¦ `porosity` takes a number, not `[0.3]` ¦ several values belong in a [[sweep]]: `porosity = [0.3]`
porosity = 0.3 ¦ law = "linaer" ¦ 4 ¦ no law is called `linaer` ¦ did you mean `linear`? It can be {laws}
porosity = 0.3 ¦ law = 3 ¦ 4 ¦ `law` takes a word in quotes, not `3` ¦ write it like `law = "linear"`
[material] ¦ integrator.mapping_back = 1⏎[material] ¦ 3 ¦ `mapping_back` takes true or false, not `1` ¦ write it like `mapping_back = true`
[material] ¦ output.references = "terzaghi"⏎[material] ¦ 3 ¦ `references` takes a list, not `"terzaghi"` ¦ write `references = ["terzaghi"]`
[4, 8] ¦ 4 ¦ 7 ¦ `cells` takes a list, not `4` ¦ write `cells = [4]`
[4, 8] ¦ 4, 8 ¦ 7 ¦ `4, 8` is neither a number nor a list ¦ write `cells = [4, 8]`
[4, 8] ¦ [4.5] ¦ 7 ¦ `cells` takes a whole number, not `4.5` ¦ write it like `cells = [10]`
[4, 8] ¦ ["8"] ¦ 7 ¦ `cells` takes a whole number, not `"8"` ¦ write it without quotes: `cells = [8]`
[4, 8] ¦ "four" ¦ 7 ¦ `cells` takes a list, not `"four"` ¦ write it like `cells = [10]`
[4, 8] ¦ [4, 8]⏎time_step = [0.1] ¦ 8 ¦ `time_step` takes a table, not `0.1` ¦ write it like `time_step = [{ courant = 0.1 }]`
[[sweep]] ¦ [sweep] ¦ 5 ¦ `sweep` takes a list, not `[sweep]` ¦ a block that may be repeated has double brackets: [[sweep]]
title = "t"⏎ ¦  ¦ 1 ¦ `title` is missing in the study ¦ add `title = "..."`
["GIMP"] ¦ ["TL-PPP-step"] ¦ 6 ¦ no method is called `TL-PPP-step` ¦ version 0.3 removed it: use `TL-PPP`
[4, 8] ¦ [4, 8]⏎layers = [2] ¦ 8 ¦ unknown key `layers` ¦ it is now called `sets`
[4, 8] ¦ [4, 8]⏎[[expect_case]]⏎one_layer_within = 1 ¦ 9 ¦ unknown key `one_layer_within` ¦ it is now called `one_set_within`
[4, 8] ¦ [4, 8]⏎[[expect]]⏎time_factor = 0.1⏎order = { minus = 1 } ¦ 10 ¦ `value` is missing in order ¦ add `value = 0.1`
[4, 8] ¦ [4, 8]⏎[[result]]⏎name = "a"⏎files = ["b"] ¦ 8 ¦ `cells` is missing in result ¦ add `cells = [10]`
[4, 8] ¦ [4, 8]⏎[[solver]]⏎name = "a"⏎result = "b" ¦ 8 ¦ `command` is missing in solver ¦ add `command = ["..."]`
"#;

#[test]
fn every_mistake_is_told_at_its_line_with_what_to_write() {
    let laws = Law::NAMES.map(|law| format!("`{law}`")).join(", ");
    for row in MISTAKES.trim().lines() {
        let row = row.replace("{laws}", &laws).replace('⏎', "\n");
        let fields: Vec<&str> = row.split(" ¦ ").collect();
        let [from, to, line, message, help] = &fields[..] else { panic!("{row}") };
        assert!(SOUND.contains(from), "{row}");
        let (at, told, right) = complaint(&SOUND.replacen(from, to, 1));
        assert_eq!((&*at.to_string(), &*told, &*right), (*line, *message, *help), "{to}");
    }
    for (table, parts) in [
        ("material", ["`material` takes a table", "single brackets: [material]"]),
        ("layer", ["`layer` takes a table", "the layers of a column are [[column.soils]]"]),
        ("layers", ["unknown key `layers`", "the layers of a column are [[column.soils]]"]),
        ("soils", ["unknown key `soils`", "the layers of a column are [[column.soils]]"]),
        ("column.layers", ["unknown key `layers`", "did you mean `soils`?"]),
    ] {
        let told = refusal(&SOUND.replacen("[material]", &format!("[[{table}]]"), 1));
        assert!(parts.iter().all(|part| told.contains(part)), "{told}");
    }
}

/// Keys and words of other programs and of textbooks: the line that is sound, what is typed instead, and the help.
const SYNONYMS: &str = r"
porosity = 0.3 ¦ permeability = 1e-9 ¦ did you mean `hydraulic_conductivity`?
porosity = 0.3 ¦ k = 1e-9 ¦ did you mean `hydraulic_conductivity`?
porosity = 0.3 ¦ kf = 1e-9 ¦ did you mean `hydraulic_conductivity`?
porosity = 0.3 ¦ K_sat = 1e-9 ¦ did you mean `hydraulic_conductivity`?
porosity = 0.3 ¦ E = 2e6 ¦ did you mean `youngs_modulus`?
porosity = 0.3 ¦ youngs = 2e6 ¦ did you mean `youngs_modulus`?
porosity = 0.3 ¦ elastic_modulus = 2e6 ¦ did you mean `youngs_modulus`?
porosity = 0.3 ¦ nu = 0.3 ¦ did you mean `poissons_ratio`?
porosity = 0.3 ¦ poisson = 0.3 ¦ did you mean `poissons_ratio`?
porosity = 0.3 ¦ porosity0 = 0.3 ¦ did you mean `porosity`?
porosity = 0.3 ¦ n0 = 0.3 ¦ did you mean `porosity`?
porosity = 0.3 ¦ n = 0.3 ¦ did you mean `porosity`?
porosity = 0.3 ¦ bulk_modulus_water = 2e9 ¦ did you mean `water_bulk_modulus`?
porosity = 0.3 ¦ K_w = 2e9 ¦ did you mean `water_bulk_modulus`?
porosity = 0.3 ¦ rho_s = 2650.0 ¦ did you mean `grain_density`?
porosity = 0.3 ¦ cohesion = 1e4 ¦ did you mean `undrained_strength`?
porosity = 0.3 ¦ void_ratio = 1.0 ¦ give the porosity instead, n = e/(1 + e): `porosity`
porosity = 0.3 ¦ e = 1.0 ¦ give the porosity instead, n = e/(1 + e): `porosity`
porosity = 0.3 ¦ c_v = 1e-7 ¦ did you mean `coefficient_of_consolidation`?
porosity = 0.3 ¦ E_oed = 2e6 ¦ did you mean `oedometric_modulus`?
porosity = 0.3 ¦ G = 2e6 ¦ give `youngs_modulus` and `poissons_ratio` instead: E = 9KG/(3K + G), ν = (3K − 2G)/(6K + 2G)
porosity = 0.3 ¦ thickness = 5.0 ¦ `height` belongs to [column]: `column.height`
porosity = 0.3 ¦ ppc = 2 ¦ `points_per_cell` belongs to [[sweep]]: `sweep.points_per_cell`
[material] ¦ [column]⏎H = 5.0⏎[material] ¦ did you mean `height`?
[material] ¦ [column]⏎thickness = 5.0⏎[material] ¦ did you mean `height`?
[material] ¦ [column]⏎surcharge = 5.0⏎[material] ¦ did you mean `load`?
[material] ¦ [column]⏎permeability = 1e-9⏎[material] ¦ `hydraulic_conductivity` belongs to [material]: `material.hydraulic_conductivity`
porosity = 0.3 ¦ time_factors = [0.1] ¦ `time_factors` belongs to [output]: `output.time_factors`
porosity = 0.3 ¦ output_times = [0.1] ¦ `times` belongs to [output]: `output.times`
porosity = 0.3 ¦ repeats = 3 ¦ `repeats` belongs to [timing]: `timing.repeats`
[material] ¦ [output]⏎output_times = [1.0]⏎[material] ¦ did you mean `times`?
cells = [4, 8] ¦ mesh = [4, 8] ¦ did you mean `cells`?
cells = [4, 8] ¦ elements = [4, 8] ¦ did you mean `cells`?
cells = [4, 8] ¦ n-cells = [4, 8] ¦ did you mean `cells`?
cells = [4, 8] ¦ cells = [4, 8]⏎ppc = [2] ¦ did you mean `points_per_cell`?
cells = [4, 8] ¦ cells = [4, 8]⏎particles_per_cell = [2] ¦ did you mean `points_per_cell`?
cells = [4, 8] ¦ cells = [4, 8]⏎dt = [{ seconds = 0.1 }] ¦ did you mean `time_step`?
cells = [4, 8] ¦ cells = [4, 8]⏎timestep = [{ seconds = 0.1 }] ¦ did you mean `time_step`?
cells = [4, 8] ¦ cells = [4, 8]⏎cell_size = [0.1] ¦ give the number of cells over the height, `cells`, or the height of the column, `height`
cells = [4, 8] ¦ cells = [4, 8]⏎E = [1e6, 2e6] ¦ did you mean `youngs_modulus`?
cells = [4, 8] ¦ cells = [4, 8]⏎end_time = [5.0] ¦ a run ends at its last output: set `times` or `time_factors`
";

#[test]
fn a_synonym_is_answered_with_the_key_and_makes_no_other_mistake() {
    for row in SYNONYMS.trim().lines() {
        let fields: Vec<String> = row.split(" ¦ ").map(|field| field.replace('⏎', "\n")).collect();
        let [from, to, help] = &fields[..] else { panic!("{row}") };
        let text = SOUND.replacen(from, to, 1);
        // A sweep without its cells lacks them whatever stands there instead.
        let mut told = Study::check(&StudySource { name: "t.toml".to_owned(), text: text.clone() })
            .expect_err(to)
            .diagnostics;
        told.retain(|one| one.message != "the sweep names no cells");
        assert_eq!(told.len(), 1, "{to}: {told:?}");
        assert_eq!(told[0].help.as_deref(), Some(help.as_str()), "{to}");
    }
    // Each names a key that a study has, once.
    let schema = schema_of(Document::Study).to_string();
    let mut names: Vec<&str> = Vec::new();
    for (others, key) in KEY_NAMES {
        assert!(schema.contains(&format!("\"{key}\":{{")), "{key}");
        names.extend(*others);
    }
    let all = names.len();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), all, "a name stands for two keys");
}

#[test]
fn a_word_of_another_program_is_answered_with_the_word() {
    for (from, to, word) in [
        ("\"terzaghi\"", "\"consolidation\"", "terzaghi"),
        ("\"terzaghi\"", "\"finite strain\"", "xie-leo"),
        ("[4, 8]", "[4, 8]\nintegrator = [\"backward Euler\"]", "implicit"),
        (
            "[4, 8]",
            "[4, 8]\n[[expect]]\nquantity = \"pore_pressure\"\ntime_factor = 0.1\norder = { value = 2.0 }",
            "pressure",
        ),
    ] {
        let told = refusal(&SOUND.replacen(from, to, 1));
        assert!(told.contains(&format!("did you mean `{word}`?")), "{told}");
    }
}

/// Keys and words of a study, in which each term of the field has its place.
const IN_OUR_WORDS: &str = r#"
title = "t"
scene = "single-mode"
integrator = { mapping_back = false }
[[sweep]]
method = ["GIMP"]
cells = [4, 8, 16]
path = ["cells", "time_step"]
tier = "full"
time_step = [{ stable = 0.5 }, { stable = 0.4 }, { stable = 0.3 }]
[[sweep]]
method = ["MPM"]
integrator = ["implicit"]
cells = [5, 10, 20]
time_step = [{ growth = 0.5 }]
[[expect]]
method = "MPM"
quantity = "pressure"
time_factor = 0.1
floor = { below = 1e-2 }
"#;

#[test]
fn terms_of_the_field_are_read_as_the_keys_and_words_they_stand_for() {
    let read = |text: &str| {
        let source = StudySource { name: "t.toml".to_owned(), text: text.to_owned() };
        let study = Study::check(&source).unwrap_or_else(|error| panic!("{error}"));
        let cases: Vec<_> = study.planned.iter().map(|one| (one.case.hash(), one.tier)).collect();
        (cases, format!("{:?}", study.expectations))
    };
    let as_before = read(IN_OUR_WORDS);
    let mut all = IN_OUR_WORDS.to_owned();
    let mut replaced = 0;
    for (term, word) in FIELD_TERMS {
        assert_eq!(read_as(term), word);
        let places = [format!("\n{word} = "), format!("{{ {word} = "), format!("\"{word}\"")];
        for place in places.iter().filter(|place| IN_OUR_WORDS.contains(*place)) {
            replaced += 1;
            let text = IN_OUR_WORDS.replace(place, &place.replace(word, term));
            assert_eq!(read(&text), as_before, "{term}");
            all = all.replace(place, &place.replace(word, term));
        }
    }
    assert_eq!((replaced, read(&all)), (8, as_before));
    let twice = IN_OUR_WORDS.replace("tier = ", "test_level = \"ci\"\ntier = ");
    assert!(
        refusal(&twice).contains("it is another name of `tier`: leave one of them out"),
        "{}",
        refusal(&twice)
    );
}

#[test]
fn numbers_with_units_make_the_cases_of_plain_numbers() {
    let study = |text: &str| {
        let source = StudySource { name: "t.toml".to_owned(), text: text.to_owned() };
        Study::check(&source).unwrap_or_else(|error| panic!("{error}"))
    };
    let more = |material: &str, sweep: &str| {
        let text = SOUND.replace("porosity = 0.3", material);
        format!("case_seconds = {}\n{text}{sweep}", if sweep.contains('"') { "\"2 min\"" } else { "120" })
    };
    let plain = study(&more(
        "porosity = 0.3\nyoungs_modulus = 1e6",
        "hydraulic_conductivity = [1e-9, 1e-4]\ntime_step = [{ seconds = 120.0 }]\nload = [5e4]\n",
    ));
    let with_units = study(&more(
        "porosity = 0.3\nyoungs_modulus = \"1 MPa\"",
        "hydraulic_conductivity = [\"1e-9 m/s\", 1e-4]\ntime_step = [{ seconds = \"2 min\" }]\n\
         load = [\"50 kPa\"]\n",
    ));
    assert_eq!(with_units.planned, plain.planned);
    assert_eq!((with_units.planned.len(), with_units.case_seconds), (4, 120.0));
    let told = refusal(&SOUND.replace("porosity = 0.3", "youngs_modulus = \"5 m\""));
    let parts = ["t.toml:4:18", "^^^^^", "`m` is not a unit for a quantity in Pa", "\"10 kPa\""];
    assert!(parts.iter().all(|part| told.contains(part)), "{told}");
    let told = refusal(&SOUND.replace("[4, 8]", "[4, 8]\nload = [5.0, \"2 days\"]"));
    assert!(told.contains("t.toml:8:14") && told.contains("not a unit"), "{told}");
}

#[test]
fn several_mistakes_are_told_at_once() {
    let text = SOUND.replace("porosity", "porosty").replace("[4, 8]", "[4.5, \"8\"]");
    let told = refusal(&text);
    assert_eq!(told.matches("error: ").count(), 3, "{told}");
}
