//! Does it converge, how fast, and to what? Of a study every method on its meshes; of several the columns that tell most at small
//! and at large strain.

use crate::case::contender::PAPERS;
use crate::case::grouping::grouped;
use crate::case::{Case, Quantity, Sample};
use crate::judge::paths::Path;
use crate::judge::study_results::StudyResults;
use crate::measure::statistics::larger;
use crate::questions::finding::{Finding, Place, Question, best};
use crate::questions::published_equations::QUOTED_CELLS;
use crate::questions::series::{Series, SeriesTable};
use crate::questions::series_figure::{figure, figures};
use crate::render::page::Block;
use crate::study::expectation::Axis;
use oedometer_convergence::Class;
use oedometer_exact::ExactError;
use oedometer_soil::elementary;
use serde::Serialize;

/// Does it converge, how fast, and to what?
pub static CONVERGENCE: Question = Question {
    id: "convergence",
    heading: "Does it converge, how fast, and to what?",
    template: include_str!("convergence.md"),
    places: &[Place::Terminal, Place::Study, Place::Report],
    ask,
};

/// Methods of a study that are enough to compare.
const ENOUGH_METHODS: usize = 3;

/// Methods of a study beside others in the table of a report.
const MOST_METHODS: usize = 5;

/// Every number and name of the sentence.
#[derive(Serialize)]
struct Facts {
    /// A study's own, or a column at small and one at large strain, as far as there are studies of them.
    columns: Vec<ColumnFacts>,
}

/// A method on several meshes.
#[derive(Serialize)]
struct ColumnFacts {
    /// Final strain of a column at large strain.
    final_strain: Option<f64>,
    /// The paper's method, or the first, with what tells its runs from the others.
    method: String,
    /// Reference.
    reference: String,
    /// Time factor, and what it is called.
    time_factor: f64,
    factor_name: &'static str,
    /// Whether the order of each quantity no longer changes from mesh to mesh.
    is_settled: bool,
    /// The orders.
    orders: Vec<OrderFacts>,
    /// Cells of the finest mesh.
    cells: usize,
    /// The error of the first quantity there.
    error: Option<f64>,
}

/// The order of a quantity.
#[derive(Serialize)]
struct OrderFacts {
    /// Quantity.
    quantity: Quantity,
    /// Class of the series; none of two meshes.
    class: Option<Class>,
    /// Order that the class allows; of two meshes that between them.
    order: Option<f64>,
}

fn ask(studies: &[StudyResults<'_>]) -> Result<Option<Finding>, ExactError> {
    if let [one] = studies {
        let Some(found) = SeriesTable::new(one, Axis::Cells) else { return Ok(None) };
        let (facts, file) = (Facts { columns: vec![facts_of(&found)] }, CONVERGENCE.id);
        let finding = CONVERGENCE
            .answer([one.study.name.as_str()], &facts)
            .with(Block::Table(found.table(file)))
            .with(Block::Figures(figures(&found)));
        let floors = found.floors().map(|table| table.file("floors"));
        let details = floors.map(|table| Block::Details {
            summary: "What limits errors".to_owned(),
            blocks: vec![Block::Table(table)],
        });
        return Ok(Some(details.into_iter().fold(finding, Finding::with)));
    }
    let is_small = |case: &Case| {
        let scene = case.scene;
        !scene.is_large_strain() && !scene.waves && !scene.body.is_plane() && scene.is_loaded()
    };
    let is_large = |case: &Case| case.scene.is_large_strain();
    let columns = [
        (refined_column(studies, &is_small)?, "convergence"),
        (refined_column(studies, &is_large)?, "convergence-large-strain"),
    ];
    let columns: Vec<_> = columns.into_iter().filter_map(|(found, name)| Some((found?, name))).collect();
    if columns.is_empty() {
        return Ok(None);
    }
    let facts = Facts { columns: columns.iter().map(|((_, found), _)| facts_of(found)).collect() };
    let names = columns.iter().map(|((study, _), _)| study.as_str());
    let mut finding = CONVERGENCE.answer(names, &facts);
    for ((_, found), name) in &columns {
        let drawn = figure(found, (Quantity::Pressure, Sample::Points)).into_iter();
        let drawn = drawn.map(|mut figure| {
            (*name).clone_into(&mut figure.name);
            figure
        });
        finding = finding.with(Block::Table(found.table(name))).with(Block::Figures(drawn.collect()));
    }
    Ok(Some(finding))
}

/// The column of the study that tells most about the paper's method and some others: its study and its series.
fn refined_column<'a>(
    studies: &[StudyResults<'a>],
    fits: &dyn Fn(&Case) -> bool,
) -> Result<Option<(String, SeriesTable<'a>)>, ExactError> {
    let most = best(studies, |one| {
        let paths = plain_paths(one, fits);
        let papers = paths.iter().find(|path| method_of(path) == PAPERS);
        let is_quoted =
            papers.is_some_and(|path| path.records.iter().any(|one| one.case.cells == QUOTED_CELLS));
        let levels = papers.or(paths.first()).map_or(0, |path| path.records.len());
        // Where another error limits that of the mesh, it does not show how fast that falls.
        let is_of_mesh = papers.is_some_and(|path| settles(one, path));
        let worth = (papers.is_some(), is_quoted, is_of_mesh, paths.len().min(ENOUGH_METHODS), levels);
        Ok(Some((worth, paths)).filter(|(_, paths)| !paths.is_empty()))
    })?;
    let Some((one, paths)) = most else { return Ok(None) };
    Ok(SeriesTable::of_paths(one, &ranked(one, paths), Axis::Cells)
        .map(|table| (one.study.name.clone(), table)))
}

/// Whether the orders along a path have settled.
fn settles(results: &StudyResults<'_>, path: &Path<'_>) -> bool {
    let found = SeriesTable::of_paths(results, std::slice::from_ref(path), Axis::Cells);
    found.is_some_and(|found| found.series.iter().all(|one| one.class().is_some_and(Class::is_settled)))
}

fn method_of(path: &Path<'_>) -> String {
    path.records[0].case.method.to_string()
}

/// The plain runs of a study in one dimension, on the column of the first of them: of each method those on most meshes.
fn plain_paths<'a>(results: &StudyResults<'a>, fits: impl Fn(&Case) -> bool) -> Vec<Path<'a>> {
    let mut paths = results.refined(Axis::Cells);
    paths.retain(|path| {
        let case = &path.records[0].case;
        case.column.dimensions == 1 && fits(case) && is_plain(case)
    });
    let Some(first) = paths.first().map(|path| path.records[0]) else { return paths };
    paths.retain(|path| {
        let case = &path.records[0].case;
        case.column == first.case.column
            && case.material == first.case.material
            && case.points_per_cell == first.case.points_per_cell
    });
    let of_method = grouped(paths, method_of).into_iter();
    let most = |a: Path<'a>, b: Path<'a>| if b.records.len() > a.records.len() { b } else { a };
    of_method.filter_map(|(_, paths)| paths.into_iter().reduce(most)).collect()
}

/// The paper's method first, then those with the smallest of the largest errors on their finest mesh, as many as a report shows.
fn ranked<'a>(results: &StudyResults<'a>, mut paths: Vec<Path<'a>>) -> Vec<Path<'a>> {
    let found = SeriesTable::of_paths(results, &paths, Axis::Cells);
    let error = |path: &Path<'_>| {
        let is_of =
            |one: &&Series<'_>| one.summary.path.records[0].case.method == path.records[0].case.method;
        let all = found.iter().flat_map(|found| &found.series).filter(is_of);
        all.filter_map(|one| Some(one.ends()?[1].1)).reduce(larger).unwrap_or(f64::INFINITY)
    };
    paths.sort_by(|a, b| {
        let is_papers = |path: &Path<'_>| method_of(path) == PAPERS;
        is_papers(b).cmp(&is_papers(a)).then(error(a).total_cmp(&error(b)))
    });
    paths.truncate(MOST_METHODS);
    paths
}

/// What the sentence says: of the paper's method, or of the first.
fn facts_of(found: &SeriesTable<'_>) -> ColumnFacts {
    let is_papers = |one: &&Series<'_>| method_of(&one.summary.path) == PAPERS;
    let chosen = found.series.iter().find(is_papers).unwrap_or(&found.series[0]);
    let of_chosen =
        found.series.iter().filter(|one| one.label == chosen.label && one.measured.1 != Sample::Centres);
    let orders: Vec<OrderFacts> = of_chosen
        .map(|one| OrderFacts { quantity: one.measured.0, class: one.class(), order: one.order() })
        .collect();
    let case = &chosen.summary.path.records[0].case;
    let strain = || 1.0 - elementary::exp(-case.column.load / case.material.oedometric_modulus());
    let finest = chosen.ends().map(|ends| ends[1]);
    ColumnFacts {
        final_strain: case.scene.is_large_strain().then(strain),
        method: chosen.label.clone(),
        reference: found.reference.to_owned(),
        time_factor: found.time_factor,
        factor_name: case.scene.clock.factor_name(),
        is_settled: orders.iter().all(|one| one.class.is_some_and(Class::is_settled)),
        orders,
        cells: finest.map_or(0, |(place, _)| found.levels[place].1.case.cells),
        error: finest.map(|(_, error)| error),
    }
}

/// Whether a case is of the scene's own equations, on regular points, however it is integrated.
fn is_plain(case: &Case) -> bool {
    let variant = case.variant();
    variant.is_empty() || variant.split(", ").all(|part| part.ends_with(" drag"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::{records_of, study_of};
    use crate::case::planned::Tier;
    use crate::record::Record;

    const STUDY: &str = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\n\
        method = ['GIMP', 'GC-SRI-patch', 'MPM']\nintegrator = ['implicit']\ncells = [5, 10, 20]\n[[sweep]]\n\
        method = ['MPM']\nintegrator = ['implicit']\ncells = [40]\n";

    /// Errors of second order, by their sizes on twenty cells: of GIMP, the paper's method and MPM.
    fn records(errors: [f64; 3]) -> Vec<Record> {
        let mut records = records_of(STUDY);
        for record in &mut records {
            let name = record.case.method.to_string();
            let place = ["GIMP", PAPERS, "MPM"].iter().position(|one| *one == name).expect("one of them");
            let coarse = 400.0 / (record.case.cells * record.case.cells) as f64;
            record.errors.iter_mut().for_each(|row| row.value = -coarse * errors[place]);
        }
        records
    }

    #[test]
    fn the_paper_s_method_is_told_and_leads_the_table_and_the_others_follow_by_their_largest_error() {
        let (study, records) = (study_of("s", STUDY), records([0.3, 0.4, 0.1]));
        let other = study_of("other", &STUDY.replace(", 10, 20", ", 12, 20"));
        let none: Vec<Record> = Vec::new();
        let results =
            [StudyResults::new(&other, &none, Tier::Full), StudyResults::new(&study, &records, Tier::Full)];
        let found = ask(&results).expect("sound cases").expect("three methods");
        assert_eq!(found.studies, ["s"]);
        // A finer study in which another error takes over tells less.
        let text = STUDY.replace("5, 10, 20", "5, 10, 20, 40, 80").replace("[40]", "[160]");
        let (finer, mut level) = (study_of("finer", &text), records_of(&text));
        level.iter_mut().flat_map(|record| &mut record.errors).for_each(|row| row.value = 0.1);
        let both =
            [StudyResults::new(&finer, &level, Tier::Full), StudyResults::new(&study, &records, Tier::Full)];
        assert_eq!(ask(&both).expect("sound cases").expect("an answer").studies, ["s"]);
        let told = "`GC-SRI-patch` converges to Terzaghi's solution with compressible water at T_v = 0.1: order 2.00 in the pore \
                    pressure, order 2.00 in the effective stress, order 2.00 in the settlement; the error \
                    of the pore pressure is 40.0 % on 20 cells.";
        assert_eq!(found.sentence().expect("a sentence"), told);
        let tables = found.tables();
        let shown: Vec<String> = tables[0].rows.iter().step_by(3).map(|row| row[0].show()).collect();
        // MPM on 40 cells is off by 2.5 %.
        assert_eq!(shown, [PAPERS, "MPM", "GIMP"]);
        // One study alone tells its methods in their own order.
        let alone = ask(&results[1..]).expect("sound cases").expect("three methods");
        let shown: Vec<String> = alone.tables()[0].rows.iter().step_by(3).map(|row| row[0].show()).collect();
        assert_eq!(
            (shown, alone.sentence().expect("a sentence").as_str()),
            (vec!["GIMP".to_owned(), PAPERS.to_owned(), "MPM".to_owned()], told)
        );
    }

    #[test]
    fn two_meshes_have_one_order_and_no_class() {
        let text = STUDY.replace("[5, 10, 20]", "[5, 10]").replace("cells = [40]", "cells = [20]");
        let study = study_of("s", &text);
        let mut records = records([0.3, 0.4, 0.1]);
        records.retain(|record| record.case.cells <= 10);
        let results = [StudyResults::new(&study, &records, Tier::Full)];
        let found = ask(&results).expect("sound cases").expect("three methods");
        assert!(found.facts["columns"][0]["orders"][0]["class"].is_null());
        let table = found.tables()[0];
        assert_eq!(table.rows[0].last().map(crate::render::table::Cell::show).as_deref(), Some("2.00"));
        assert_eq!(table.notes, ["all implicit, growth=0.05, 2 points per cell; order between two meshes"]);
    }
}
