//! Who reaches the tolerance in one problem of the race, for its page.

use crate::case::contender::CONTENDERS;
use crate::questions::choice::reason_words;
use crate::questions::study_findings::StudyFindings;
use crate::race::finish::Terms;
use crate::record::race_errors::{ARRIVED, ReadOut};
use crate::render::number;
use crate::render::page::Block;
use crate::render::table::{Cell, Table, columns};

/// Who reaches the tolerance in the problem of a page; empty for any other study.
pub fn blocks(study: &StudyFindings) -> Vec<Block> {
    let Some(situation) = study.plain.race.as_ref().filter(|one| !one.is_property) else {
        return Vec::new();
    };
    let entries = CONTENDERS.iter().filter_map(|one| situation.entry(one.name));
    let rows = entries.map(|entry| {
        let mut row = vec![Cell::Code(entry.contender.clone())];
        for read_out in ReadOut::BOTH {
            let terms = Terms::usual(read_out);
            let arrival = situation.arrival(entry, &terms);
            row.push(arrival.as_ref().map_or(
                Cell::Text(situation.reason(entry, &terms).map_or(String::new(), reason_words)),
                |one| Cell::Count(one.cells as u64),
            ));
            row.push(Cell::of(arrival.map(|one| one.cost), Cell::Seconds, "not reached"));
        }
        row
    });
    let heads = "method | > cells, read at points | > work | > cells, read at cell means | > work";
    let table = Table::of("Where each method reaches 1 %", columns(heads), rows);
    let note = format!(
        "{} of pressure, effective stress and displacement at every output, confirmed by the finer meshes and half the step; \
         work: counted operations times their calibrated times",
        number::percent(ARRIVED)
    );
    vec![Block::Heading("Every method".to_owned()), Block::Table(table.note(note))]
}
