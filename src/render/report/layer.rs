//! A plane layer: pressure fields beside the exact one, and errors and oscillation against the stiffness of the water and
//! of the skeleton; of a footing the load-settlement curves of all methods.

use crate::judge::blocks::fields::{FieldFinding, FieldsFinding, LoadCurves, SHOWN_CELLS};
use crate::judge::comparison::stiffness_sweep::{Showing, StiffnessSweep, SweptStiffness};
use crate::judge::study_results::StudyResults;
use crate::render::chart::{Chart, ChartAxis, ColourField, Rule, Series, Size, Style};
use crate::render::number;
use crate::render::page::{Block, Figure};
use crate::render::report::figure_of;
use crate::render::table::{Cell, Table, TableColumn, columns};
use oedometer_exact::exact_error::ExactError;
use oedometer_mpm::scene::SceneKind;

/// Fields and sweeps of a study of a layer; empty for a column.
///
/// # Errors
/// When a reference refuses a case.
pub fn blocks(results: &StudyResults<'_>, fields: Option<&FieldsFinding>) -> Result<Vec<Block>, ExactError> {
    let scene = results.study.scene;
    if !scene.has_plane_fields() || scene == SceneKind::Footing {
        return Ok(Vec::new());
    }
    let mut blocks = Vec::new();
    if let Some(found) = fields {
        let ratio = found.poissons_ratio;
        blocks.push(Block::Heading(format!(
            "Pressure at the points, {SHOWN_CELLS} cells over the height, ν = {ratio}"
        )));
        let drawn = found.fields.iter().map(|field| figure(results, field, found.time_factor));
        blocks.push(Block::Figures(drawn.collect()));
    }
    blocks.extend(sweep_blocks(results)?);
    Ok(blocks)
}

fn figure(results: &StudyResults<'_>, found: &FieldFinding, time_factor: f64) -> Figure {
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
    figure_of(results, &format!("field-{name}"), chart, caption)
}

/// Figures of the last output and, behind a click, every number.
fn sweep_blocks(results: &StudyResults<'_>) -> Result<Vec<Block>, ExactError> {
    let mut blocks = Vec::new();
    for stiffness in SweptStiffness::ALL {
        let Some(sweep) = StiffnessSweep::of(results.study, results.records, stiffness)? else { continue };
        let Some(last) = sweep.time_factors.last().copied() else { continue };
        // Two values are no line, and the start has a section of its own.
        if sweep.values.len() < 3 || last <= 0.0 {
            continue;
        }
        blocks.push(Block::Heading(words_of(stiffness).0.to_owned()));
        blocks.push(Block::Paragraph(format!(
            "{} cells over the height, T_v = {last}. The line of a method that the stiffness does not affect is level. Methods \
             that agree hide each other; the tables have them all.",
            sweep.cells
        )));
        let figures =
            Showing::ALL.iter().map(|showing| sweep_figure(results, &sweep, last, *showing)).collect();
        blocks.push(Block::Figures(figures));
        let tables = sweep.time_factors.iter().flat_map(|time_factor| {
            Showing::ALL.iter().map(|showing| Block::Table(sweep_table(&sweep, *time_factor, *showing)))
        });
        blocks.push(Block::Details {
            summary: "All numbers at all times".to_owned(),
            blocks: tables.collect(),
        });
    }
    Ok(blocks)
}

/// The heading of the figures of a stiffness, and one word for the names of their files.
fn words_of(stiffness: SweptStiffness) -> (&'static str, &'static str) {
    match stiffness {
        SweptStiffness::Water => ("Stiff water, through consolidation", "water"),
        SweptStiffness::Skeleton => ("Nearly incompressible skeleton, through consolidation", "skeleton"),
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

fn sweep_figure(
    results: &StudyResults<'_>,
    sweep: &StiffnessSweep,
    time_factor: f64,
    showing: Showing,
) -> Figure {
    let x = match sweep.stiffness {
        SweptStiffness::Water => ChartAxis::log10("K_w/E (–)"),
        SweptStiffness::Skeleton => ChartAxis::log10("Poisson's ratio ν (–), spaced as 1 − 2ν")
            .inverted()
            .with_labelled_ticks(sweep.values.iter().map(|ratio| (1.0 - 2.0 * ratio, ratio.to_string()))),
    };
    let (subject, word) = subject(showing);
    let title = format!("{subject}, T_v = {}", number::time_factor(time_factor));
    let label = match showing {
        Showing::Displacement | Showing::Pressure => "relative L_2 error (–)",
        Showing::Oscillation => "total variation over the exact one's (–)",
    };
    let mut chart = Chart::new(title.clone(), x, ChartAxis::log10(label));
    chart.size = Size::PANEL;
    for row in sweep.at(time_factor) {
        let points = sweep.values.iter().zip(&row.found).filter_map(|(value, found)| {
            let found = found[showing as usize]?;
            // An oscillation shows as a ratio of variations above one.
            let found = if showing == Showing::Oscillation { 1.0 + found } else { found };
            let is_skeleton = sweep.stiffness == SweptStiffness::Skeleton;
            Some((if is_skeleton { 1.0 - 2.0 * value } else { *value }, found))
        });
        chart.series.push(Series::new(row.method.to_string(), points.collect()));
    }
    if showing == Showing::Oscillation {
        chart.rules.push(Rule { at: 1.0, label: "theory".to_owned() });
    }
    let name = format!("{word}-{}", words_of(sweep.stiffness).1);
    figure_of(results, &name, chart, format!("{title}."))
}

fn sweep_table(sweep: &StiffnessSweep, time_factor: f64, showing: Showing) -> Table {
    let header = |value: &f64| match sweep.stiffness {
        SweptStiffness::Water => format!("K_w/E = {value}"),
        SweptStiffness::Skeleton => format!("ν = {value}"),
    };
    let mut columns = columns("method");
    columns.extend(sweep.values.iter().map(|value| TableColumn::number(header(value))));
    let cell = |value: Option<f64>| match (value, showing) {
        (None, _) => Cell::missing("not run"),
        (Some(value), Showing::Oscillation) => Cell::Number(value),
        (Some(value), _) => Cell::Error(value),
    };
    let rows = sweep.at(time_factor).map(|row| {
        let cells = row.found.iter().map(|found| cell(found[showing as usize]));
        std::iter::once(Cell::Code(row.method.to_string())).chain(cells).collect()
    });
    let note = (showing == Showing::Oscillation)
        .then(|| "Total variation over the exact one's, minus one.".to_owned());
    Table::of(format!("{}, T_v = {}", subject(showing).0, number::time_factor(time_factor)), columns, rows)
        .notes(note)
}

/// Top of the figure of loads, over the exact collapse load.
const HIGHEST: f64 = 2.5;

/// Load over settlement of a footing; empty for other scenes.
pub fn load_settlement(results: &StudyResults<'_>, loads: Option<&LoadCurves>) -> Vec<Block> {
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
        Block::Figures(vec![figure_of(results, "load-settlement", chart, caption)]),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::{failed_at, records_of, solved, study_of};
    use crate::case::SolverName;
    use crate::case::planned::Tier;
    use crate::judge::blocks::fields::shown_records;
    use crate::judge::comparison::stiffness_sweep::SweepRow;
    use crate::measure::fields::PlaneField;
    use crate::record::HistoryRow;
    use crate::record::Record;
    use oedometer_mpm::method::Method;
    use oedometer_mpm::scene::column::Undrained;

    fn curves_of(study: &crate::study::check::Study, records: &[Record]) -> Vec<Block> {
        let results = StudyResults::new(study, records, Tier::Full);
        load_settlement(&results, LoadCurves::new(&results).as_ref())
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
        let fields = FieldsFinding::new(&results).expect("theory");
        let found = blocks(&results, fields.as_ref()).expect("theory");
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
            figure(&results, &FieldFinding::new(&field, values, run), 0.2)
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
        let text = "title = 't'\nscene = 'cosine-layer'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['GIMP']\n\
                    integrator = ['implicit']\ncells = [2]\n";
        let study = study_of("s", text);
        let results = StudyResults::new(&study, &[], Tier::Full);
        let row = |time_factor: f64, off: f64| SweepRow {
            method: SolverName::Own(Method::named("GIMP").expect("a method")),
            time_factor,
            found: vec![[Some(0.1 + off), Some(0.2 + off), Some(0.3 + off)], [None; 3]],
            failed: vec![None; 2],
        };
        let sweep = |stiffness: SweptStiffness| StiffnessSweep {
            stiffness,
            cells: 2,
            values: vec![0.25, 0.49],
            time_factors: vec![0.1, 0.2],
            rows: vec![row(0.1, 5.0), row(0.2, 0.0)],
        };
        for (stiffness, word, at, header) in [
            (SweptStiffness::Skeleton, "skeleton", 0.5, "ν = 0.49"),
            (SweptStiffness::Water, "water", 0.25, "K_w/E = 0.49"),
        ] {
            for (showing, subject, kind, value) in [
                (Showing::Displacement, "Displacement at the nodes", "displacement", 0.1),
                (Showing::Pressure, "Pressure at the points", "pressure", 0.2),
                (Showing::Oscillation, "Oscillation of the pressure", "oscillation", 0.3),
            ] {
                let is_ratio = showing == Showing::Oscillation;
                let drawn = sweep_figure(&results, &sweep(stiffness), 0.2, showing);
                assert_eq!(
                    (drawn.name, drawn.caption),
                    (format!("s-{kind}-{word}"), format!("{subject}, T_v = 0.2."))
                );
                // An oscillation of nothing is a ratio of one.
                let up = if is_ratio { 1.0 + value } else { value };
                let points: Vec<_> = drawn.chart.series.iter().map(|one| one.points.clone()).collect();
                assert_eq!(points, [vec![(at, up)]], "nothing is drawn where nothing was found");
                assert_eq!(drawn.chart.rules.len(), usize::from(is_ratio));
                assert_eq!(drawn.chart.x.inverted, stiffness == SweptStiffness::Skeleton);
                let table = sweep_table(&sweep(stiffness), 0.2, showing);
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
