//! What is told of the run of an attached solver below the table of its case.

use crate::measure::statistics::spread;
use crate::record::{Record, WallSample};
use crate::render::tables::attached_runs::is_busy;
use oedometer_soil::wording::{count_of, short};

/// Sentences on the run of an attached solver: how it failed, what it is, what it took; none for other cases.
pub fn notes_of(record: &Record) -> Vec<String> {
    let Some(about) = &record.attached else { return Vec::new() };
    let mut notes: Vec<String> = record.status.failure().map(ToString::to_string).into_iter().collect();
    let version =
        about.version.as_ref().map_or(String::new(), |version| format!(", which says of itself: {version}"));
    notes.push(if about.command.is_empty() {
        "read from files that were there already; nothing was run".to_owned()
    } else {
        format!("run by `{}`{version}", about.command.join(" "))
    });
    notes.extend(times(&record.wall));
    notes.extend(
        about
            .repeats_differ_by
            .map(|most| format!("results of its repeats differ by {} at most", short(most))),
    );
    notes.extend(about.notes.iter().cloned());
    notes.extend(about.taken.iter().map(|taken| format!("taken: {taken}")));
    notes
}

/// Wall times with what goes beside them.
fn times(samples: &[WallSample]) -> Option<String> {
    let wall = spread(&samples.iter().map(|sample| sample.seconds).collect::<Vec<_>>())?;
    let of =
        |field: fn(&WallSample) -> Option<f64>| spread(&samples.iter().filter_map(field).collect::<Vec<_>>());
    let mut parts = vec![format!(
        "wall time {} s at least, {} s as the median of {}",
        short(wall.minimum),
        short(wall.median),
        count_of(wall.count, "run", "runs")
    )];
    parts.push(match of(|sample| sample.cpu_seconds) {
        Some(cpu) => format!("processor {} s", short(cpu.median)),
        None => "the system tells no processor time".to_owned(),
    });
    parts.push(match of(|sample| sample.peak_memory.map(|bytes| 1e-6 * bytes as f64)) {
        Some(memory) => format!("memory {} MB at most", short(memory.maximum)),
        None => "the system tells no memory".to_owned(),
    });
    parts.extend(
        of(|sample| sample.own_seconds).map(|own| format!("of its own account {} s", short(own.median))),
    );
    parts.extend(of(|sample| sample.load).map(|load| format!("load of the machine {}", short(load.maximum))));
    if is_busy(samples) {
        parts.push("the machine was busy, or it waited: compare processor times".to_owned());
    }
    Some(parts.join(", "))
}
