//! A plane layer: pressure fields beside the exact one, and errors and oscillation against the stiffness of the water and
//! of the skeleton; of a footing the load-settlement curves of all methods.

use crate::case::grouping::grouped;
use crate::questions::blocks::fields::{FieldFinding, LoadCurves};
use crate::questions::findings::{StiffnessFinding, StiffnessValue, Swept};
use crate::questions::sentence;
use crate::questions::study_findings::StudyFindings;
use crate::render::chart::{Chart, ChartAxis, ColourField, Rule, Series, Size, Style};
use crate::render::page::{Block, Figure};
use crate::render::table::{Cell, Table, TableColumn, columns};
use crate::render::{RenderError, number};
use crate::report::blocks::figure_of;

/// Loads, fields and sweeps of a study in the plane; empty for a column.
///
/// # Errors
/// If a template cannot be filled.
pub fn blocks(study: &StudyFindings) -> Result<Vec<Block>, RenderError> {
    let found = &study.plain.blocks;
    let mut blocks = load_settlement(&study.name, found.loads.as_ref());
    if let Some(found) = &found.fields {
        let (cells, ratio) = (found.cells, found.poissons_ratio);
        blocks.push(Block::Heading(format!(
            "Pressure at the points, {cells} cells over the height, ν = {ratio}"
        )));
        let drawn = found.fields.iter().map(|field| figure(&study.name, field, found.time_factor));
        blocks.push(Block::Figures(drawn.collect()));
    }
    if study.shows_sweeps {
        blocks.extend(sweep_blocks(&study.name, &study.plain.stiffness)?);
    }
    Ok(blocks)
}

fn figure(study: &str, found: &FieldFinding, time_factor: f64) -> Figure {
    let name = found.method.as_deref().unwrap_or("Exact");
    let mut chart = Chart::new(
        name.to_owned(),
        ChartAxis::linear("x/H (–)"),
        ChartAxis::linear("height above the base y/H (–)"),
    );
    // All fields share their size and their colours, which reach a little beyond the exact values.
    chart.field = Some(ColourField {
        label: "p/q (–)".to_owned(),
        reach: Some(found.reach),
        x_edges: found.x_edges.clone(),
        y_edges: found.y_edges.clone(),
        values: found.values.clone(),
    });
    chart.size = Size { width: 380.0, plot_height: 240.0, equal_units: true };
    let beyond = if found.largest > found.reach {
        format!(" Values reach {}, beyond the common scale.", number::number(found.largest))
    } else {
        String::new()
    };
    let time = number::time_factor(time_factor);
    let caption = match found.oscillation {
        None => format!("Theory at T_v = {time}. All these fields share one scale."),
        Some(index) => {
            format!("{name} at T_v = {time}: oscillation index {}.{beyond}", number::fixed(index, 2))
        }
    };
    figure_of(study, &format!("field-{name}"), chart, caption)
}

/// Figures of the last output and, behind a click, every number.
fn sweep_blocks(study: &str, found: &[StiffnessFinding]) -> Result<Vec<Block>, RenderError> {
    let mut blocks = Vec::new();
    for (swept, rows) in grouped(found, |row| row.swept) {
        let times = grouped(rows, |row| row.time_factor.to_bits());
        let times: Vec<Vec<&StiffnessFinding>> = times.into_iter().map(|(_, rows)| rows).collect();
        let Some(last) = times.last() else { continue };
        // Two values are no line, and the start has a section of its own.
        if last[0].values.len() < 3 || last[0].time_factor <= 0.0 {
            continue;
        }
        blocks.push(Block::Heading(words_of(swept).0.to_owned()));
        blocks.push(Block::Paragraph(sentence::sentence("sweep", last[0])?));
        let figures = Showing::ALL.map(|showing| sweep_figure(study, last, showing));
        blocks.push(Block::Figures(figures.into()));
        let tables = times
            .iter()
            .flat_map(|rows| Showing::ALL.map(|showing| Block::Table(sweep_table(rows, showing))));
        blocks.push(Block::Details {
            summary: "All numbers at all times".to_owned(),
            blocks: tables.collect(),
        });
    }
    Ok(blocks)
}

/// The heading of the figures of a stiffness, and one word for the names of their files.
fn words_of(swept: Swept) -> (&'static str, &'static str) {
    match swept {
        Swept::Water => ("Stiff water, through consolidation", "water"),
        Swept::Skeleton => ("Nearly incompressible skeleton, through consolidation", "skeleton"),
    }
}

/// What a figure shows of each run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Showing {
    Displacement,
    Pressure,
    Oscillation,
}

impl Showing {
    const ALL: [Self; 3] = [Self::Displacement, Self::Pressure, Self::Oscillation];

    fn shown_in(self, value: &StiffnessValue) -> Option<f64> {
        match self {
            Self::Displacement => value.displacement,
            Self::Pressure => value.pressure,
            Self::Oscillation => value.oscillation,
        }
    }
}

/// The subject of a figure, and one word for the name of its file.
fn subject(showing: Showing) -> (&'static str, &'static str) {
    match showing {
        Showing::Displacement => ("Displacement at the nodes", "displacement"),
        Showing::Pressure => ("Pressure at the points", "pressure"),
        Showing::Oscillation => ("Oscillation of the pressure", "oscillation"),
    }
}

/// One number of all methods at a time.
fn sweep_figure(study: &str, rows: &[&StiffnessFinding], showing: Showing) -> Figure {
    let swept = rows[0].swept;
    let x = match swept {
        Swept::Water => ChartAxis::log10("K_w/E (–)"),
        Swept::Skeleton => {
            let ratios = rows[0].values.iter().map(|one| one.value);
            ChartAxis::log10("Poisson's ratio ν (–), spaced as 1 − 2ν")
                .inverted()
                .with_labelled_ticks(ratios.map(|ratio| (1.0 - 2.0 * ratio, ratio.to_string())))
        }
    };
    let (subject, word) = subject(showing);
    let title = format!("{subject}, T_v = {}", number::time_factor(rows[0].time_factor));
    let label = match showing {
        Showing::Displacement | Showing::Pressure => "relative L_2 error (–)",
        Showing::Oscillation => "total variation over the exact one's (–)",
    };
    let mut chart = Chart::new(title.clone(), x, ChartAxis::log10(label));
    chart.size = Size::PANEL;
    for row in rows {
        let points = row.values.iter().filter_map(|one| {
            let found = showing.shown_in(one)?;
            // An oscillation shows as a ratio of variations above one.
            let found = if showing == Showing::Oscillation { 1.0 + found } else { found };
            Some((if swept == Swept::Skeleton { 1.0 - 2.0 * one.value } else { one.value }, found))
        });
        chart.series.push(Series::new(row.method.clone(), points.collect()));
    }
    if showing == Showing::Oscillation {
        chart.rules.push(Rule { at: 1.0, label: "theory".to_owned() });
    }
    let name = format!("{word}-{}", words_of(swept).1);
    figure_of(study, &name, chart, format!("{title}."))
}

fn sweep_table(rows: &[&StiffnessFinding], showing: Showing) -> Table {
    let header = |one: &StiffnessValue| match rows[0].swept {
        Swept::Water => format!("K_w/E = {}", one.value),
        Swept::Skeleton => format!("ν = {}", one.value),
    };
    let mut columns = columns("method");
    columns.extend(rows[0].values.iter().map(|one| TableColumn::number(header(one))));
    let cell = |value: Option<f64>| match (value, showing) {
        (None, _) => Cell::missing("not run"),
        (Some(value), Showing::Oscillation) => Cell::Number(value),
        (Some(value), _) => Cell::Error(value),
    };
    let note = (showing == Showing::Oscillation)
        .then(|| "Total variation over the exact one's, minus one.".to_owned());
    let title = format!("{}, T_v = {}", subject(showing).0, number::time_factor(rows[0].time_factor));
    let rows = rows.iter().map(|row| {
        let cells = row.values.iter().map(|one| cell(showing.shown_in(one)));
        std::iter::once(Cell::Code(row.method.clone())).chain(cells).collect()
    });
    Table::of(title, columns, rows).notes(note)
}

/// Top of the figure of loads, over the exact collapse load.
const HIGHEST: f64 = 2.5;

/// Load over settlement of a footing; empty for other scenes.
fn load_settlement(study: &str, loads: Option<&LoadCurves>) -> Vec<Block> {
    let Some(found) = loads else { return Vec::new() };
    let mut chart = Chart::new(
        "Load and settlement of the plate",
        ChartAxis::linear("settlement over the width u/B (–)"),
        ChartAxis::linear("load factor F/(B c_u) (–)").between(0.0, HIGHEST * found.exact),
    );
    chart.size = Size::PANEL;
    for run in &found.runs {
        let series = Series::new(run.method.as_str(), run.points.clone());
        chart.series.push(series.style(Style::Line).slot(run.place));
    }
    chart.series.push(Series::theory("2 + π", vec![(0.0, found.exact), (found.end, found.exact)]));
    let caption = format!(
        "{} cells under the plate, undrained by {}. The line of a method that locks leaves the figure at its top.",
        found.cells,
        found.undrained.replace('-', " ")
    );
    vec![
        Block::Heading("Load and settlement".to_owned()),
        Block::Figures(vec![figure_of(study, "load-settlement", chart, caption)]),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::{failed_at, records_of, solved, study_of};
    use crate::case::planned::Tier;
    use crate::measure::fields::PlaneField;
    use crate::questions::blocks::fields::shown_records;
    use crate::questions::study_results::StudyResults;
    use crate::record::HistoryRow;
    use crate::record::Record;
    use oedometer_problem::method::Method;
    use oedometer_scenes::column::Undrained;

    fn curves_of(study: &crate::study::check::Study, records: &[Record]) -> Vec<Block> {
        let results = StudyResults::new(study, records, Tier::Full);
        load_settlement("s", LoadCurves::new(&results).as_ref())
    }

    #[test]
    fn fields_share_the_reach_of_the_exact_one_and_say_what_lies_beyond() {
        let text = "title = 't'\nscene = 'cosine-layer'\noutput.time_factors = [0.1, 0.2]\n[[sweep]]\n\
                    method = ['GIMP-SRI', 'GIMP']\nintegrator = ['implicit']\ncells = [4, 8]\npoints_per_cell = [2, 3]\n\
                    time_step = [{ growth = 0.5 }]\n[[sweep]]\nmethod = ['MPM']\nintegrator = ['implicit']\ncells = [8]\n\
                    poissons_ratio = [0.3]\ntime_step = [{ growth = 0.5 }]\n";
        let (study, records) = solved("s", text);
        let results = StudyResults::new(&study, &records, Tier::Full);
        let shown: Vec<_> = shown_records(&records)
            .iter()
            .map(|record| (record.case.method.to_string(), record.case.cells, record.case.points_per_cell))
            .collect();
        assert_eq!(
            shown,
            [("GIMP-SRI".to_owned(), 8, 2), ("GIMP".to_owned(), 8, 2)],
            "the first run of each"
        );
        let found = blocks(&results.findings().expect("theory")).expect("filled");
        assert_eq!(
            found[0],
            Block::Heading("Pressure at the points, 8 cells over the height, ν = 0.25".to_owned())
        );
        let Block::Figures(figures) = &found[1] else { panic!("{found:?}") };
        let names: Vec<&str> = figures.iter().map(|figure| figure.name.as_str()).collect();
        assert_eq!(names, ["s-field-exact", "s-field-gimp-sri", "s-field-gimp"]);
        assert_eq!(figures[0].caption, "Theory at T_v = 0.1. All these fields share one scale.");
        // The largest exact value is 2, so that the colours reach to 2.5.
        let field = PlaneField {
            columns: 2,
            x_edges: vec![0.0, 0.5, 1.0],
            y_edges: vec![0.0, 1.0],
            computed: vec![-2.6, 1.0],
            exact: vec![-2.0, 1.0],
        };
        let drawn = |values: &[f64], index: Option<f64>| {
            let run = index.map(|index| ("GIMP".to_owned(), index));
            figure("s", &FieldFinding::new(&field, values, run), 0.2)
        };
        let beyond = drawn(&field.computed, Some(0.456));
        let caption = "GIMP at T_v = 0.2: oscillation index 0.46. Values reach 2.6, beyond the common scale.";
        assert_eq!(beyond.caption, caption);
        assert_eq!(drawn(&[2.5, -1.0], Some(1.0)).caption, "GIMP at T_v = 0.2: oscillation index 1.00.");
        let of = |figure: &Figure| {
            let field = figure.chart.field.as_ref().expect("a field");
            (field.reach, field.values.clone(), figure.chart.size.width)
        };
        assert_eq!(of(&beyond), (Some(2.5), field.computed.clone(), 380.0));
        assert_eq!(of(&drawn(&field.exact, None)), (Some(2.5), field.exact.clone(), 380.0));
    }

    #[test]
    fn each_figure_and_table_of_a_sweep_shows_its_own_quantity_over_the_stiffness() {
        let value = |value: f64, found: Option<f64>| StiffnessValue {
            value,
            displacement: found,
            pressure: found.map(|found| found + 0.1),
            oscillation: found.map(|found| found + 0.2),
            failed: None,
        };
        let sweep = |swept: Swept| StiffnessFinding {
            swept,
            method: "GIMP".to_owned(),
            cells: 2,
            time_factor: 0.2,
            values: vec![value(0.25, Some(0.1)), value(0.49, None)],
            lost_from: None,
        };
        for (stiffness, word, at, header) in
            [(Swept::Skeleton, "skeleton", 0.5, "ν = 0.49"), (Swept::Water, "water", 0.25, "K_w/E = 0.49")]
        {
            for (showing, subject, kind, value) in [
                (Showing::Displacement, "Displacement at the nodes", "displacement", 0.1),
                (Showing::Pressure, "Pressure at the points", "pressure", 0.1 + 0.1),
                (Showing::Oscillation, "Oscillation of the pressure", "oscillation", 0.1 + 0.2),
            ] {
                let is_ratio = showing == Showing::Oscillation;
                let drawn = sweep_figure("s", &[&sweep(stiffness)], showing);
                assert_eq!(
                    (drawn.name, drawn.caption),
                    (format!("s-{kind}-{word}"), format!("{subject}, T_v = 0.2."))
                );
                // An oscillation of nothing is a ratio of one.
                let up = if is_ratio { 1.0 + value } else { value };
                let points: Vec<_> = drawn.chart.series.iter().map(|one| one.points.clone()).collect();
                assert_eq!(points, [vec![(at, up)]], "nothing is drawn where nothing was found");
                assert_eq!(drawn.chart.rules.len(), usize::from(is_ratio));
                assert_eq!(drawn.chart.x.inverted, stiffness == Swept::Skeleton);
                let table = sweep_table(&[&sweep(stiffness)], showing);
                let cell = if is_ratio { Cell::Number(value) } else { Cell::Error(value) };
                let name = Cell::Code("GIMP".to_owned());
                assert_eq!(table.rows, [vec![name, cell, Cell::missing("not run")]]);
                assert_eq!(
                    (table.title, table.columns[2].header.as_str()),
                    (format!("{subject}, T_v = 0.2"), header)
                );
                assert_eq!(table.notes.len(), usize::from(is_ratio));
            }
        }
    }

    #[test]
    fn load_and_settlement_are_drawn_on_the_finest_mesh_of_most_methods() {
        let text = |scene: &str| {
            format!(
                "title = 't'\nscene = '{scene}'\n[[sweep]]\nmethod = ['GIMP']\nintegrator = ['implicit']\ncells = [2]\n"
            )
        };
        let [study, column] = ["footing", "terzaghi"].map(|scene| study_of("s", &text(scene)));
        let one = records_of(&(text("terzaghi").replace("[[", "output.time_factors = [0.1]\n[["))).remove(0);
        // Each curve ends at the settlement of its number of cells.
        let run = |(name, cells): &(&str, usize)| {
            let mut record = one.clone();
            (record.case.method, record.case.cells) = (Method::named(name).expect("a method").into(), *cells);
            let row = |time_factor: f64, load_factor: Option<f64>| HistoryRow {
                time_factor,
                degree_of_consolidation: 0.0,
                load_factor,
            };
            record.history = vec![row(0.5, Some(3.0)), row(9.0, None), row(*cells as f64, Some(5.0))];
            record
        };
        let drawn = |study: &_, records: &[Record]| {
            let blocks = curves_of(study, records);
            let Some(Block::Figures(figures)) = blocks.get(1) else { return (String::new(), Vec::new()) };
            let curve = |one: &Series| (one.name.clone(), one.points.last().map_or(0.0, |last| last.0));
            (figures[0].caption.clone(), figures[0].chart.series.iter().map(curve).collect())
        };
        let told = |runs: &[(&str, usize)]| drawn(&study, &runs.iter().map(run).collect::<Vec<_>>());
        let (a, b, c) = ("GIMP", "MPM", "VP");
        for (runs, cells, methods) in [
            (&[(a, 4), (a, 8), (b, 8), (b, 16), (c, 8)][..], 8, &[a, b, c][..]),
            (&[(b, 16), (b, 8), (a, 8), (a, 4), (c, 4), (c, 8)], 8, &[b, a, c]),
            (&[(a, 4), (b, 4), (b, 16), (c, 4), (c, 8)], 4, &[a, b, c]),
            (&[(a, 4), (a, 16), (b, 4), (b, 8)], 4, &[a, b]),
            (&[(a, 4), (b, 8), (c, 8)], 8, &[b, c]),
            (&[(a, 4), (b, 8)], 8, &[b]),
            (&[(a, 4)], 4, &[a]),
        ] {
            let (caption, curves) = told(runs);
            assert!(
                caption.starts_with(&format!("{cells} cells under the plate, undrained by total stress.")),
                "{caption}"
            );
            let wanted = methods.iter().chain([&"2 + π"]).map(|name| ((*name).to_owned(), f64::from(cells)));
            assert_eq!(curves, wanted.collect::<Vec<_>>(), "{runs:?}");
        }
        // Neither what failed nor what is undrained otherwise counts; of several runs the first is drawn.
        let mut records = [(a, 4), (a, 8), (b, 4), (b, 8), (b, 4)].map(|one| run(&one)).to_vec();
        records[1].status = failed_at(1);
        records[3].case.column.footing.undrained = Undrained::TwoPhase;
        records[4].history.clear();
        let (caption, curves) = drawn(&study, &records);
        assert!(caption.starts_with("4 cells") && curves.len() == 3, "{caption} {curves:?}");
        assert!(curves.iter().all(|(_, end)| *end == 4.0), "{curves:?}");
        for (study, records) in [(&study, &[][..]), (&study, &records[1..2]), (&column, &records)] {
            assert_eq!(curves_of(study, records), []);
        }
    }
}
