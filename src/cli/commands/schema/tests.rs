use super::*;
use crate::campaign::runner::{RunOptions, run_study};
use crate::case::planned::Tier;
use crate::judge::study_results::StudyResults;
use crate::questions::answers;
use crate::questions::finding::{Place, findings_json};
use crate::study::check::Study;
use crate::study::file::StudySource;
use crate::study::shipped::shipped_studies;

/// The first way in which a value breaks a schema made of the few words used here.
fn breach(schema: &Value, value: &Value, at: &str) -> Option<String> {
    if let Some(choices) = schema.get("anyOf").or(schema.get("oneOf")).and_then(Value::as_array) {
        let breaches: Vec<String> =
            choices.iter().map(|choice| breach(choice, value, at)).collect::<Option<_>>()?;
        return Some(breaches.join(" and "));
    }
    if let Some(word) = schema.get("const") {
        return (word != value).then(|| format!("{at}: {value} is not {word}"));
    }
    if let Some(words) = schema.get("enum").and_then(Value::as_array) {
        return (!words.contains(value)).then(|| format!("{at}: {value} is none of {words:?}"));
    }
    let is = |kind: &Value| match kind.as_str() {
        Some("boolean") => value.is_boolean(),
        Some("integer") => value.is_i64() || value.is_u64(),
        Some("number") => value.is_number(),
        Some("string") => value.is_string(),
        Some("null") => value.is_null(),
        Some("array") => value.is_array(),
        Some("object") => value.is_object(),
        other => panic!("no type {other:?}"),
    };
    let fits = match schema.get("type") {
        None => true,
        Some(Value::Array(kinds)) => kinds.iter().any(is),
        Some(kind) => is(kind),
    };
    if !fits {
        return Some(format!("{at}: {value} is no {}", schema["type"]));
    }
    if let (Some(items), Some(values)) = (schema.get("items"), value.as_array()) {
        return values.iter().enumerate().find_map(|(i, one)| breach(items, one, &format!("{at}[{i}]")));
    }
    let (Some(properties), Some(fields)) = (schema.get("properties"), value.as_object()) else { return None };
    let required = schema["required"].as_array().expect("a list");
    if let Some(missing) =
        required.iter().find(|name| !fields.contains_key(name.as_str().unwrap_or_default()))
    {
        return Some(format!("{at}: {missing} is missing"));
    }
    fields.iter().find_map(|(name, one)| match properties.get(name) {
        Some(schema) => breach(schema, one, &format!("{at}.{name}")),
        None => Some(format!("{at}: {name} is not known")),
    })
}

fn study_value(text: &str) -> Value {
    serde_json::to_value(toml::from_str::<toml::Table>(text).expect("TOML")).expect("JSON")
}

#[test]
fn every_shipped_study_keeps_to_the_schema() {
    let schema = schema_of(Document::Study);
    for source in shipped_studies() {
        assert_eq!(breach(&schema, &study_value(&source.text), &source.name), None);
    }
}

#[test]
fn what_the_program_refuses_the_schema_refuses() {
    let schema = schema_of(Document::Study);
    let sound = "title = \"t\"\nscene = \"terzaghi\"\n[[sweep]]\nmethod = [\"GIMP\"]\ncells = [5]\n";
    assert_eq!(breach(&schema, &study_value(sound), ""), None);
    for (from, to) in [
        ("scene = \"terzaghi\"", "scene = \"terzagi\""),
        ("scene = \"terzaghi\"\n", ""),
        ("cells = [5]", "cell = [5]"),
        ("cells = [5]", "cells = 5"),
        ("cells = [5]", "cells = [5.5]"),
        ("[\"GIMP\"]", "[{ basis = \"hat\", colour = 1 }]"),
    ] {
        let text = sound.replace(from, to);
        assert!(breach(&schema, &study_value(&text), "").is_some(), "{text}");
        let source = StudySource { name: "s.toml".to_owned(), text: text.clone() };
        assert!(Study::check(&source).is_err(), "{text}");
    }
}

#[test]
fn the_schema_has_the_keys_and_the_words_of_the_code() {
    let schema = schema_of(Document::Study);
    let sweep = &schema["properties"]["sweep"]["items"]["properties"];
    let keys: Vec<&String> = sweep.as_object().expect("an object").keys().collect();
    // The parser itself lists the keys that it knows.
    let source = StudySource {
        name: "s.toml".to_owned(),
        text: "title = \"t\"\nscene = \"terzaghi\"\n[[sweep]]\nzzzzzz = 1\n".to_owned(),
    };
    let told = Study::check(&source).expect_err("an unknown key").diagnostics;
    let told = told[0].help.as_deref().expect("help");
    let listed = told.split("the keys here are ").nth(1).expect("a list of keys");
    let mut known: Vec<&str> = listed.split_whitespace().map(|key| key.trim_end_matches(',')).collect();
    known.sort_unstable();
    assert_eq!(keys, known);
    let required = &schema["required"];
    assert_eq!(required, &json!(["title", "scene"]));
    assert_eq!(sweep["tier"]["enum"], json!(["smoke", "ci", "full"]));
    assert!(sweep["method"]["items"]["anyOf"][0]["enum"].as_array().is_some_and(|names| names.len() > 5));
}

/// Keys without a description, of the key or of its single choice.
fn undescribed(schema: &Value, at: &str, missing: &mut Vec<String>) {
    let is_told = |schema: &Value| schema["description"].as_str().is_some_and(|text| text.len() > 3);
    for (name, property) in schema["properties"].as_object().into_iter().flatten() {
        if !is_told(property) && !is_told(schema) {
            missing.push(format!("{at}.{name}"));
        }
        undescribed(property, &format!("{at}.{name}"), missing);
    }
    let choices = ["anyOf", "oneOf"].into_iter().filter_map(|word| schema[word].as_array()).flatten();
    for part in choices.chain(schema.get("items")) {
        undescribed(part, at, missing);
    }
}

#[test]
fn every_key_of_every_schema_has_a_description() {
    for document in [Document::Study, Document::Record, Document::Mapping, Document::Case, Document::Findings]
    {
        let mut missing = Vec::new();
        undescribed(&schema_of(document), "", &mut missing);
        assert!(missing.is_empty(), "{document:?}: {missing:?}");
    }
}

#[test]
fn the_findings_of_a_study_keep_to_their_schema() {
    let (study, mut records) = crate::campaign::runner::solved(
        "s",
        "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['MPM', 'GIMP']\n\
         integrator = ['implicit']\ncells = [2, 4, 8]\nporosity = [0.3, 0.4]\n",
    );
    records[0].status = crate::campaign::runner::failed_at(1);
    let results = [StudyResults::new(&study, &records, Tier::Full)];
    for place in [Place::Study, Place::Report] {
        let mut found = findings_json(&answers(&results, place).expect("sound cases"));
        assert!(found["findings"].as_array().is_some_and(|all| !all.is_empty()), "{found}");
        assert_eq!(breach(&schema_of(Document::Findings), &found, "findings"), None);
        found["findings"][0]["more"] = json!(1);
        assert!(breach(&schema_of(Document::Findings), &found, "findings").is_some());
    }
}

#[test]
fn every_record_keeps_to_the_schema_and_misses_nothing() {
    let text = "title = \"t\"\nscene = \"terzaghi\"\noutput.time_factors = [0.01]\n[[sweep]]\n\
                method = [\"GC-SRI-patch\", \"MPM\"]\ncells = [3]\ntime_step = [{ stable = 0.8 }, { stable = 1.3 }]\n";
    let study =
        Study::check(&StudySource { name: "s.toml".to_owned(), text: text.to_owned() }).expect("sound");
    let options = RunOptions::whole(Tier::Full, 1);
    let records = run_study(&study, &options, None, &|_| {}).records;
    assert!(records.iter().any(|record| matches!(record.status, crate::record::Status::Failed(_))));
    let schema = schema_of(Document::Record);
    for record in &records {
        let value = serde_json::to_value(PrintedRecord::of(record)).expect("JSON");
        assert_eq!(breach(&schema, &value, "record"), None);
        for name in schema["properties"].as_object().expect("an object").keys() {
            // The digest is made as a record is written; limits are for studies of stability, and peaks and what moves at
            // rest belong to other scenes.
            let elsewhere = ["digest", "stability", "attached", "measures"];
            let is_there = value.get(name).is_some() || elsewhere.contains(&name.as_str());
            assert!(is_there, "`{name}` is in the schema and in no record");
        }
        let mut other = value.clone();
        other["counters"]["steps"] = json!("many");
        assert!(breach(&schema, &other, "record").is_some());
    }
}

#[test]
fn a_case_file_keeps_to_its_schema() {
    let schema = schema_of(Document::Case);
    for scene in oedometer_scenes::SCENES {
        let case = crate::case::Case { cells: 4, ..crate::case::Case::seed(crate::case::Task::Solve, scene) };
        let value = serde_json::to_value(CaseFile::of(&case)).expect("JSON");
        assert_eq!(breach(&schema, &value, "case"), None, "{scene:?}");
    }
}

#[test]
fn the_convention_of_a_mapping_keeps_to_the_schema() {
    let schema = schema_of(Document::Mapping);
    for text in [crate::import::mapping::preset::CONVENTION, crate::import::mapping::preset::PLANE_CONVENTION]
    {
        assert_eq!(breach(&schema, &study_value(text), "mapping"), None);
    }
    assert!(schema["properties"]["origin"]["description"].is_string());
    assert_eq!(schema["required"], json!([]), "what is left out is that of the convention");
}
