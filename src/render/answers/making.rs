//! How the report was made: on top, not at the end.

use crate::record::provenance::Origins;
use crate::record::provenance::Provenance;
use crate::render::report::StudyResults;
use oedometer_soil::wording::count_of;

/// When, where and by which command a report was made.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Making {
    /// Day, as 2026-11-22.
    pub date: String,
    /// The processor, with the number of its threads.
    pub processor: String,
    /// The command, as it was typed.
    pub command: String,
    /// What it took, s.
    pub seconds: f64,
    /// Cases that were run for this report; the others had their records.
    pub cases_run: usize,
    /// Cases of the studies that have no record: those of a larger tier.
    pub left_out: usize,
}

impl Making {
    /// The line of provenance: program, commit, day, processor, time, command.
    pub fn words(&self, results: &[StudyResults<'_>]) -> String {
        let mut origins = Origins::default();
        let records = results.iter().flat_map(|one| one.records);
        let count = records.clone().count();
        records.for_each(|record| origins.add(&record.provenance));
        let program = origins.main().map_or_else(String::new, program_of);
        let several = origins.several_programs().map_or_else(String::new, |programs| {
            format!(" The records are of more than one program: {programs}.")
        });
        let run = match self.cases_run {
            0 => format!("rendered in {:.1} s from {count} records", self.seconds),
            run => format!("{:.1} s with {run} of {count} cases run", self.seconds),
        };
        let left_out = match self.left_out {
            0 => String::new(),
            cases => format!(
                " {} of the full tier not run; `oedometer report --tier full` runs {}.",
                count_of(cases, "case", "cases"),
                if cases == 1 { "it" } else { "them" }
            ),
        };
        format!(
            "{program} · {} · {} · {run} · `{}`{several}{left_out}",
            self.date, self.processor, self.command
        )
    }
}

/// Version, commit or sources, compiler and profile.
fn program_of(origin: &Provenance) -> String {
    let commit = match (origin.commit.is_empty(), origin.dirty) {
        (true, _) => String::new(),
        (false, false) => format!("commit `{}`, ", origin.commit),
        (false, true) => format!("commit `{}` with changes, ", origin.commit),
    };
    format!(
        "oedometer {} · {commit}sources `{}` · {}, {} profile",
        origin.version, origin.sources, origin.compiler, origin.profile
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_report_from_records_alone_says_so() {
        let making = Making { seconds: 1.25, command: "oedometer report".to_owned(), ..Making::default() };
        assert!(making.words(&[]).contains("rendered in 1.2 s from 0 records"), "{}", making.words(&[]));
        let run = Making { cases_run: 3, ..making };
        assert!(run.words(&[]).contains("with 3 of 0 cases run"));
    }
}
