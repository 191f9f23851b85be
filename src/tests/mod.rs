//! Tests of the library that take several rooms together; those of one room stand beside its code, or in
//! a file here that the room names.

mod architecture;
mod case_work_estimate;
mod dead_links;
mod distinct_numbers;
mod documented_tables;
mod golden_and_history;
mod judge_permuted_lists;
mod judge_reductions;
mod judge_verdicts;
mod measure_of_runs;
mod measure_pressure_peak;
mod option_pairs;
mod page_numbers;
mod paper;
mod record_tables;
mod records_of_programs;
mod release_metadata;
mod runs_cosine_layer;
mod runs_large_strain;
mod runs_manufactured;
mod source_order;
mod study_answers;
mod study_complaints;
mod study_limits;
mod study_reading;
mod whole_pages;
mod whole_records;

/// Holds a text against its snapshot in `tests/snapshots`.
fn assert_snapshot(name: &str, text: &str) {
    insta::with_settings!({
        snapshot_path => "../../tests/snapshots", prepend_module_to_snapshot => false, omit_expression => true
    }, { insta::assert_snapshot!(name, text) });
}

/// Plain data on one line: numbers with the digits that every machine has in common, round-off as 0, long lists by their ends.
fn told(data: &impl serde::Serialize) -> String {
    fn line(value: &serde_json::Value) -> String {
        use serde_json::Value;
        let joined = |part: &[Value]| part.iter().map(line).collect::<Vec<_>>().join(" ");
        match value {
            Value::Number(number) => match number.as_f64().expect("a number") {
                tiny if tiny.abs() < 1e-11 => "0".to_owned(),
                number => oedometer_wording::rounded(number),
            },
            Value::Array(all) if all.len() > 12 => {
                format!("[{} … {}, {} in all]", joined(&all[..3]), joined(&all[all.len() - 3..]), all.len())
            }
            Value::Array(all) => format!("[{}]", joined(all)),
            Value::Object(all) => {
                let part = |(name, value): (&String, &Value)| format!("{name} {}", line(value));
                format!("{{{}}}", all.iter().map(part).collect::<Vec<_>>().join(", "))
            }
            Value::String(text) => text.clone(),
            other => other.to_string(),
        }
    }
    line(&serde_json::to_value(data).expect("plain data"))
}
