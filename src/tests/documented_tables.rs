//! The tables and lists of the manual that say what the code has are made of the code: keys, methods, scenes, columns.
//!
//! One stands in `docs/` behind a line `<!-- made of the code: NAME -->` and ends with an empty line.
//! `MANUAL_UPDATE=always cargo test documented_tables` writes them anew.

use crate::case::keys::{KEYS, Key, Kind, Range, Value};
use crate::case::{Case, Task};
use crate::cli::commands::schema::{Document, schema_of};
use crate::record::csv::long_tables::columns_csv;
use crate::tests::assert_snapshot;
use oedometer_problem::formulation::Formulation;
use oedometer_problem::integrator::IntegratorKind;
use oedometer_problem::method::Method;
use oedometer_problem::quantity::Quantity;
use oedometer_scenes::{COSINE_LAYER, MANUFACTURED_BOX, SCENES, Scene, TERZAGHI};
use oedometer_wording::typed;
use serde_json::Value as Json;
use std::collections::BTreeSet;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

/// What a line before a table begins with, and what ends it.
const MARK: [&str; 2] = ["<!-- made of the code: ", " -->"];
/// The keys of an expectation in the schema.
const EXPECT: &str = "/properties/expect/items/properties";
/// Most choices of a key that its row lists.
const MOST_CHOICES: usize = 6;
/// Variable with which the tables are written instead of compared.
const UPDATE: &str = "MANUAL_UPDATE";

/// A table by its name, as Markdown.
fn table(name: &str) -> Option<String> {
    Some(match name {
        "methods" => methods(),
        "scenes" => scenes(),
        "columns" => columns(""),
        "columns of profiles" => columns("profiles"),
        "keys of a study" => own_keys("/properties"),
        _ => match name.strip_prefix("keys of ")? {
            "[[sweep]]" => inputs("sweep") + &own_keys("/properties/sweep/items/properties"),
            "[[expect]]" => own_keys(EXPECT),
            // What both take is said once.
            "[[expect_case]]" => {
                let shared = own_of(EXPECT);
                let rows = own_of("/properties/expect_case/items/properties");
                list(rows.into_iter().filter(|row| !shared.contains(row)))
            }
            "[output]" => own_keys("/properties/output/properties"),
            "[timing]" => own_keys("/properties/timing/properties"),
            "time_step" => own_keys("/properties/sweep/items/properties/time_step/items/properties"),
            "[column]" => inputs("column") + &own_keys("/properties/column/properties"),
            of => {
                let table = of.strip_prefix('[')?.strip_suffix(']')?;
                Key::in_table(table).next()?;
                inputs(table)
            }
        },
    })
}

fn code(word: &str) -> String {
    format!("`{word}`")
}

/// The inputs of a case that a table takes: meaning, values and what is taken where one is left out.
fn inputs(table: &str) -> String {
    let scene = match table {
        "layer" => &COSINE_LAYER,
        "manufactured" => &MANUFACTURED_BOX,
        _ => &TERZAGHI,
    };
    let seed = Case::seed(Task::Solve, scene);
    // A sweep takes the keys of the other tables too, which have them on the same page.
    let is_own = |key: &&Key| table != "sweep" || key.tables.len() == 1 || key.name == "cells";
    let rows = Key::in_table(table).filter(is_own).map(|key| {
        let left_out = match key.name {
            "method" | "cells" => "required".to_owned(),
            "time_step" => "the integrator's own".to_owned(),
            "formulation" => "the integrator's and problem's own".to_owned(),
            "law" => "the problem's own".to_owned(),
            "length" | "base" if table == "sweep" => "the layer's".to_owned(),
            "amplitude_x" | "amplitude_y" | "amplitude" | "frequency" | "pressure" => match (table, key.name)
            {
                ("sweep", _) => "the motion's".to_owned(),
                (_, "amplitude_y") => "0.25, shear -0.2".to_owned(),
                (_, "amplitude") => "1.5".to_owned(),
                (_, "frequency") => "π/2".to_owned(),
                _ => value_of(key, &seed),
            },
            _ if !key.in_place_of.is_empty() => "none".to_owned(),
            _ => value_of(key, &seed),
        };
        let values = format!("{} {}", values(key), key.unit);
        [code(key.name), format!("{}; {} ({left_out})", key.meaning, values.trim_end())]
    });
    list(rows)
}

fn value_of(key: &Key, seed: &Case) -> String {
    match key.get(seed) {
        // Zero stands for nothing where a value must be positive.
        Value::Count(0) => "none".to_owned(),
        Value::Number(0.0) if matches!(key.kind, Kind::Number(Range::Positive)) => "none".to_owned(),
        Value::Number(number) => {
            let plain = typed(number);
            if plain.len() > 6 { format!("{number:e}") } else { plain }
        }
        other => other.to_string(),
    }
}

/// What values a key takes.
fn values(key: &Key) -> String {
    match key.kind {
        Kind::Method => "[a name, or a table](methods.md)".to_owned(),
        Kind::TimeStep => "[a rule](methods.md#steps-in-time)".to_owned(),
        Kind::Word(words) => words.iter().copied().map(code).collect::<Vec<_>>().join(", "),
        Kind::Flag => "`true`, `false`".to_owned(),
        Kind::Count(most) => format!("1 … {most}"),
        Kind::Number(Range::Positive) => "> 0".to_owned(),
        Kind::Number(Range::NotNegative) => "≥ 0".to_owned(),
        Kind::Number(Range::Between(least, most)) => format!("> {least}, < {most}"),
        Kind::Number(Range::Within(least, most, ..)) => {
            if least == f64::MIN_POSITIVE {
                format!("> 0, ≤ {most}")
            } else {
                format!("{least} … {most}")
            }
        }
    }
}

/// The keys of a table beside inputs and tables: name, and what the schema says of it with its choices.
fn own_of(pointer: &str) -> Vec<[String; 2]> {
    let schema = schema_of(Document::Study);
    let properties = schema.pointer(pointer).and_then(Json::as_object).expect(pointer);
    // At the top stand the tables themselves, whose keys follow.
    let is_own = |name: &str, value: &Json| match pointer {
        "/properties" => !["object", "array"].iter().any(|kind| value["type"] == **kind),
        _ => !KEYS.iter().any(|key| key.name == name),
    };
    let own = properties.iter().filter(|(name, value)| is_own(name, value));
    own.map(|(name, value)| {
        let meaning = value["description"].as_str().unwrap_or_default().trim_end_matches('.');
        let words = value["enum"].as_array().filter(|words| words.len() <= MOST_CHOICES);
        let words: Vec<String> = words.into_iter().flatten().filter_map(Json::as_str).map(code).collect();
        let colon = if words.is_empty() { "" } else { ": " };
        [code(name), format!("{meaning}{colon}{}", words.join(", "))]
    })
    .collect()
}

fn own_keys(pointer: &str) -> String {
    list(own_of(pointer))
}

/// Names and meanings, one a line.
fn list(rows: impl IntoIterator<Item = [String; 2]>) -> String {
    let line = |[name, meaning]: [String; 2]| format!("- {name}: {meaning}\n");
    rows.into_iter().map(line).collect()
}

fn methods() -> String {
    let row = |name: String| [code(&name), code(&Method::named(&name).expect("a method").choices())];
    // Prefixes and suffixes are explained beside the list.
    let names = Method::names().into_iter();
    let plain =
        names.filter(|name| !name.starts_with('u') && !name.starts_with("TL-") && !name.ends_with("-cells"));
    list(plain.map(row))
}

fn scenes() -> String {
    let row = |scene: &'static Scene| {
        let references = scene.reference_kinds().into_iter().map(|kind| code(kind.name()));
        let references = references.collect::<Vec<_>>().join(", ");
        [code(scene.name), format!("{}; {references}", scene.summary)]
    };
    list(SCENES.into_iter().map(row))
}

fn columns(of: &str) -> String {
    let text = columns_csv().expect("a table");
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let rows: Vec<csv::StringRecord> = reader.records().map(|row| row.expect("a row")).collect();
    // Inputs are keys, which have a page of their own.
    let is_key = |name: &str| KEYS.iter().any(|key| key.name == name);
    let rows = rows.iter().filter(|row| &row[0] == of && !(of.is_empty() && is_key(&row[1])));
    let meaning = |row: &csv::StringRecord| [&row[3], &row[2]].map(str::to_owned).join(", ");
    list(rows.map(|row| [code(&row[1]), meaning(row).trim_end_matches(", ").to_owned()]))
}

/// The pages of the manual.
fn pages() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs");
    let mut pages: Vec<PathBuf> =
        fs::read_dir(folder).expect("docs/").map(|entry| entry.expect("a page").path()).collect();
    pages.retain(|path| path.extension().is_some_and(|kind| kind == "md"));
    pages.sort();
    pages
}

/// A page with its tables as the code has them, and their names.
fn made_anew(text: &str, page: &Path) -> (String, Vec<String>) {
    let (mut made, mut names) = (String::new(), Vec::new());
    let mut lines = text.lines();
    while let Some(line) = lines.next() {
        let _ = writeln!(made, "{line}");
        let Some(name) = line.strip_prefix(MARK[0]).and_then(|rest| rest.strip_suffix(MARK[1])) else {
            continue;
        };
        let of_the_code = table(name).unwrap_or_else(|| panic!("{}: no table `{name}`", page.display()));
        let _ = writeln!(made, "\n{of_the_code}");
        names.push(name.to_owned());
        // The empty line, the table or list and the empty line behind it.
        let rest: Vec<&str> = lines.clone().collect();
        let old = rest.iter().skip(1).take_while(|line| line.starts_with(['|', '-'])).count();
        let old = if old == 0 { rest.iter().take_while(|line| line.is_empty()).count() } else { old + 2 };
        for _ in 0..old {
            lines.next();
        }
    }
    (made, names)
}

#[test]
fn the_tables_of_the_manual_are_those_of_the_code() {
    let mut names = BTreeSet::new();
    for page in pages() {
        let text = fs::read_to_string(&page).expect("a page");
        let (made, own) = made_anew(&text, &page);
        names.extend(own);
        if std::env::var(UPDATE).is_ok_and(|value| value == "always") {
            fs::write(&page, &made).expect("written");
        } else if made != text {
            let place = made.lines().zip(text.lines()).position(|(made, text)| made != text);
            let of = |text: &str| text.lines().nth(place.unwrap_or_default()).unwrap_or_default().to_owned();
            panic!(
                "{}:{}: the code has\n{}\nand the page\n{}\n{UPDATE}=always cargo test documented_tables",
                page.display(),
                place.map_or(0, |place| place + 1),
                of(&made),
                of(&text)
            );
        }
    }
    // Every table of a study file, and what else there is to choose from.
    let tables: BTreeSet<&str> = KEYS.iter().flat_map(|key| key.tables).copied().collect();
    for table in tables.into_iter().filter(|table| *table != "sweep") {
        let name = format!("keys of [{table}]");
        assert!(
            names.contains(&name),
            "`{}{name}{}` is on no page: add it to docs/keys.md",
            MARK[0],
            MARK[1]
        );
    }
    for name in
        ["methods", "scenes", "columns", "keys of [[sweep]]", "keys of [[expect]]", "keys of [[expect_case]]"]
    {
        assert!(names.contains(name), "{name} is on no page");
    }
}

/// A default that a scene takes over is seen here.
#[test]
fn scenes_with_all_their_fields() {
    fn names<T: Copy>(list: &[T], name: impl Fn(T) -> &'static str) -> String {
        list.iter().copied().map(name).collect::<Vec<_>>().join(", ")
    }
    let mut text = String::new();
    for scene in SCENES {
        let (column, soil) = ((scene.column)(), (scene.soil)());
        let flags = [
            (scene.waves, "waves"),
            (scene.locks, "locks"),
            (scene.sealed, "sealed"),
            (scene.motion.is_some(), "motion"),
            (scene.start_is_solved(), "start solved"),
            (scene.final_settlement.is_some(), "final settlement"),
        ];
        let flags: Vec<&str> = flags.into_iter().filter_map(|(is_so, word)| is_so.then_some(word)).collect();
        let references = scene.references.iter().map(|reference| {
            let differs = (reference.differs)(&soil).map_or(String::new(), |what| format!(" without {what}"));
            let growing = if reference.holds_growing { "" } else { ", of sudden loads" };
            format!("{}{differs}{growing}", reference.kind.name())
        });
        let references: Vec<String> = references.collect();
        let methods: Vec<&str> = scene.methods.iter().map(|limit| limit.why).collect();
        let limits: Vec<String> = scene
            .limits
            .iter()
            .map(|limit| format!("{}: {} ({})", limit.key, limit.why, limit.instead))
            .collect();
        let unjudged: Vec<String> =
            scene.unjudged.iter().map(|(check, why)| format!("{check:?}: {why}")).collect();
        let outputs = (scene.outputs)(&column, &soil);
        let lines = [
            ("axes", scene.axes.to_owned()),
            ("question, clock", format!("{:?}, {:?}", scene.question, scene.clock)),
            ("body, strain, load", format!("{:?}, {:?}, {:?}", scene.body, scene.strain, scene.load)),
            ("has", flags.join(", ")),
            ("takes", scene.takes.join(", ")),
            ("law", soil.law.name().to_owned()),
            ("integrators", names(scene.integrators.list, IntegratorKind::name)),
            ("formulations", names(scene.formulations.list, Formulation::name)),
            ("outputs", format!("{outputs:?}")),
            ("references", references.join("; ")),
            ("quantities", names(scene.quantities, Quantity::name)),
            ("not judged", unjudged.join("; ")),
            ("methods refused", methods.join("; ")),
            ("limits", limits.join("; ")),
        ];
        let _ = writeln!(text, "{}: {}", scene.name, scene.summary);
        for (what, said) in lines.into_iter().filter(|(_, said)| !said.is_empty()) {
            let _ = writeln!(text, "    {what}: {said}");
        }
    }
    assert_snapshot("scenes_with_all_their_fields", &text);
}
