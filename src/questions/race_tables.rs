//! The race as tables for programs: `race.csv` and `profile.csv`.

use crate::race::RaceFindings;
use crate::race::finish::{Budget, OTHER_TOLERANCES, RaceQuantity, Reason, Terms};
use crate::race::group::{Group, races};
use crate::race::profile::Profile;
use crate::race::situation::{Entry, Situation};
use crate::render::table::{Cell, Table, columns};

/// The columns of `race.csv`: first those of the contract, then what the sentences rest on too.
const HEADER: &str = "group|family|situation|method|readout|time|cells|cost_1_percent|cost_seconds|confirmed|error_finest|\
                      cells_finest|reason|step_rule|budget_cells|reason_value|cost_half_percent|cost_2_percent|\
                      cost_5_percent|cost_half_budget|cost_twice_budget|cost_pressure|cost_stress|cost_displacement";
/// What stands for all outputs together.
const ALL_TIMES: &str = "all";
/// The reason of a method that has none.
const REACHED: &str = "reached";

/// Every method in every problem, by group, read-out and output.
pub fn whole_table(findings: &RaceFindings) -> Table {
    let rows = races().flat_map(|(group, read_out)| {
        let situations = findings.situations.iter().filter(move |one| group.has(one));
        situations.flat_map(move |situation| {
            let entries = situation.entries.iter().filter(move |entry| group.takes(&entry.contender));
            entries.flat_map(move |entry| {
                let outputs = (0..situation.outputs.len()).map(Some);
                std::iter::once(None).chain(outputs).map(move |output| {
                    row(group, situation, entry, &Terms { output, ..Terms::usual(read_out) })
                })
            })
        })
    });
    Table::of("", columns(HEADER), rows)
}

fn row(group: Group, situation: &Situation, entry: &Entry, terms: &Terms) -> Vec<Cell> {
    let number = |value: Option<f64>| Cell::of(value, Cell::Number, "");
    let count = |value: Option<usize>| value.map_or(Cell::missing(""), |value| Cell::Count(value as u64));
    let cost = |terms: Terms| number(situation.arrival(entry, &terms).map(|one| one.cost));
    let (arrival, reason) = (situation.arrival(entry, terms), situation.reason(entry, terms));
    let finest = entry.levels.last();
    let step = arrival.as_ref().map(|one| &one.step).or(finest.map(|level| &level.step));
    let mut row: Vec<Cell> = vec![
        group.name().into(),
        situation.family.as_str().into(),
        situation.name.as_str().into(),
        entry.contender.as_str().into(),
        terms.read_out.name().into(),
        terms.output.map_or(ALL_TIMES, |output| &situation.outputs[output]).into(),
        count(arrival.as_ref().map(|one| one.cells)),
        number(arrival.as_ref().map(|one| one.cost)),
        number(arrival.as_ref().and_then(|one| one.seconds)),
        count(arrival.as_ref().map(|one| usize::from(one.confirmed))),
        number(finest.and_then(|level| level.error(terms))),
        count(finest.map(|level| level.cells)),
        reason.map_or(REACHED, Reason::word).into(),
        step.map_or("", String::as_str).into(),
        count(Some(situation.most_cells(Budget::Whole))),
        number(reason.and_then(Reason::value)),
    ];
    row.extend(OTHER_TOLERANCES.map(|tolerance| cost(Terms { tolerance, ..*terms })));
    row.extend([Budget::Half, Budget::Twice].map(|budget| cost(Terms { budget, ..*terms })));
    row.extend(RaceQuantity::EACH[..3].iter().map(|quantity| cost(Terms { quantity: *quantity, ..*terms })));
    row
}

/// The performance profiles: the share of problems at each multiple of the least cost.
pub fn profile_table(findings: &RaceFindings) -> Table {
    let rows = races().flat_map(|(group, read_out)| {
        RaceQuantity::EACH.into_iter().flat_map(move |quantity| {
            let profiles = findings.profiles(group, read_out, quantity).into_iter();
            profiles.flat_map(move |Profile { method, steps }| {
                steps.into_iter().map(move |(tau, share)| {
                    vec![
                        group.name().into(),
                        read_out.name().into(),
                        quantity.name().into(),
                        method.as_str().into(),
                        Cell::Number(tau),
                        Cell::Number(share),
                    ]
                })
            })
        })
    });
    Table::of("", columns("group|readout|quantity|method|tau|share"), rows)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::solved;
    use crate::case::contender::CONTENDERS;
    use crate::render::number;

    const SMALL: &str = "title = 'Race: small'\nscene = 'mandel'\noutput.time_factors = [0.1, 0.2]\n[[sweep]]\n\
        method = ['race']\nintegrator = ['implicit']\ncells = [10, 20, 40]\ntime_step = [{ growth = 0.2 }]\n";

    #[test]
    fn the_tables_have_the_columns_of_the_contract_and_a_row_for_every_method_read_out_and_time() {
        let (study, records) = solved("race-layer-small", SMALL);
        let findings = RaceFindings::from_studies([(&study, records.as_slice())]).expect("a race");
        let csv = whole_table(&findings).to_plain_csv().expect("a table");
        let lines: Vec<&str> = csv.lines().collect();
        assert!(
            lines[0].starts_with(
                "group,family,situation,method,readout,time,cells,cost_1_percent,cost_seconds,confirmed,error_finest,\
                 cells_finest,reason,step_rule,budget_cells"
            ),
            "{}",
            lines[0]
        );
        let updated = CONTENDERS.iter().filter(|one| !one.is_total()).count();
        assert_eq!(lines.len(), 1 + 2 * 3 * updated);
        let of = |start: &str| *lines.iter().find(|line| line.starts_with(start)).expect(start);
        assert!(
            of("rest,layer,layer-small,B2-Bbar-patch,points,all,").contains(",,,,,,,not applicable,,20,")
        );
        // One of the arrivals and its run, as any program finds them in the record.
        let line = of("rest,layer,layer-small,GC-SRI-patch,points,0.2,");
        let finest = records
            .iter()
            .filter(|record| record.case.method.to_string() == "GC-SRI-patch")
            .max_by_key(|record| record.case.cells)
            .expect("it ran");
        let rows = finest.errors.iter().filter(|row| {
            row.time_factor == 0.2
                && row.norm.name() == "l2"
                && row.sample.name() == "points"
                && row.reference == "mandel"
        });
        let error = rows.map(|row| row.value).fold(0.0, f64::max);
        assert!(
            line.contains(&format!(",{},{},reached,growth=0.2,20,", number::exact(error), finest.case.cells)),
            "{line} {error}"
        );
        let profile = profile_table(&findings).to_plain_csv().expect("a table");
        assert!(profile.starts_with("group,readout,quantity,method,tau,share\nmoving,points,"), "{profile}");
        for tau in ["1.0", "1.3", "2.0", "5.0", "10.0", "100.0"] {
            assert!(profile.contains(&format!("rest,centres,all,GC-SRI-patch,{tau},")), "{tau}");
        }
    }
}
