//! Which steps are stable? Critical steps of a study whose task is stability, predicted and observed: maps over the parameter
//! that varies, a curve for each method, and every case.

use crate::case::Case;
use crate::judge::paths::grouped;
use crate::judge::study_results::StudyResults;
use crate::measure::statistics::largest;
use crate::questions::finding::{Finding, Place, Question};
use crate::record::{CriticalStep, Probe, Record};
use crate::render::chart::{Chart, ChartAxis, Series, Size, Style};
use crate::render::page::{Block, Figure, slug};
use crate::render::table::{Cell, Mood, Table, columns};

/// Which steps are stable?
pub static STABILITY: Question = Question {
    id: "stability",
    heading: "Which steps are stable?",
    template: include_str!("stability.md"),
    places: &[Place::Study],
    ask: |studies| Ok(ask(studies)),
};

/// Every number of the sentence.
#[derive(serde::Serialize)]
struct Facts {
    /// Cases whose critical step was searched.
    cases: usize,
    /// Those of which a step was predicted and observed.
    compared: usize,
    /// The largest difference of observed from predicted, relative.
    largest_deviation: f64,
}

fn ask(studies: &[StudyResults<'_>]) -> Option<Finding> {
    let [one] = studies else { return None };
    let searched: Vec<&CriticalStep> =
        one.records.iter().filter_map(|record| record.stability.as_ref()).collect();
    if searched.is_empty() {
        return None;
    }
    // Below the resolution of the search, that.
    let difference = |found: &&CriticalStep| found.known().and(found.within().or(found.deviation()));
    let deviations = || searched.iter().filter_map(difference);
    let facts = Facts {
        cases: searched.len(),
        compared: deviations().count(),
        largest_deviation: largest(deviations().map(f64::abs)).unwrap_or(0.0),
    };
    let maps = maps_of(one.records).iter().map(figure).collect();
    let summary = "Every case with the runs just below and above its limit".to_owned();
    let finding = STABILITY.answer([one.study.name.as_str()], &facts).with(Block::Figures(maps));
    Some(finding.with(Block::Details { summary, blocks: vec![Block::Table(table(one.records))] }))
}

/// How the axis of a map is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum MapScale {
    /// Logarithmic.
    Log,
    /// Linear.
    Linear,
    /// Linear with a tick at every small whole number.
    Counts,
}

/// What a map is drawn over.
#[derive(Debug)]
struct MapAxis {
    label: &'static str,
    scale: MapScale,
    of: fn(&Case) -> f64,
}

/// One case of a map; steps over `h/c`.
#[derive(Clone, Copy, Debug, PartialEq)]
struct MapPoint {
    /// Place on the axis.
    at: f64,
    /// Predicted critical step.
    predicted: f64,
    /// Observed one.
    observed: Option<f64>,
}

/// The cases of one method.
#[derive(Clone, Debug, PartialEq)]
struct MapCurve {
    /// Method.
    name: String,
    /// Its cases along the axis.
    points: Vec<MapPoint>,
}

/// A map.
#[derive(Clone, Debug, PartialEq)]
struct StabilityMap {
    /// What it is drawn over, with its unit.
    over: &'static str,
    /// How its axis is drawn.
    scale: MapScale,
    /// What its cases have in common besides the method, in words.
    shared: String,
    /// One curve for each method.
    curves: Vec<MapCurve>,
}

static AXES: [MapAxis; 6] = [
    MapAxis {
        label: "hydraulic conductivity k (m/s)",
        scale: MapScale::Log,
        of: |case| case.material.hydraulic_conductivity,
    },
    MapAxis {
        label: "stiffness of the water K_w/E (–)",
        scale: MapScale::Log,
        of: |case| case.material.water_bulk_modulus / case.material.youngs_modulus,
    },
    MapAxis { label: "porosity n (–)", scale: MapScale::Log, of: |case| case.material.porosity },
    MapAxis {
        label: "points per cell (–)", scale: MapScale::Counts, of: |case| case.points_per_cell as f64
    },
    MapAxis {
        label: "shift of the points, in spacings (–)",
        scale: MapScale::Linear,
        of: |case| case.column.points.offset,
    },
    MapAxis { label: "FLIP share (–)", scale: MapScale::Linear, of: |case| case.settings.flip },
];

/// The maps of records: over the one parameter that takes most values, one map for every choice of the
/// integrator.
fn maps_of(records: &[Record]) -> Vec<StabilityMap> {
    let Some(axis) = widest_axis(records) else { return Vec::new() };
    let searched = records.iter().filter_map(|record| Some((&record.case, record.stability.as_ref()?)));
    let map = |(shared, cases): (String, Vec<(&Case, &CriticalStep)>)| {
        let curve = |(name, cases): (String, Vec<(&Case, &CriticalStep)>)| {
            let point = |(case, found): (&Case, &CriticalStep)| MapPoint {
                at: (axis.of)(case),
                predicted: found.predicted / found.wave_limit,
                observed: found.observed.map(|observed| observed / found.wave_limit),
            };
            let mut points: Vec<MapPoint> = cases.into_iter().map(point).collect();
            points.sort_by(|a, b| a.at.total_cmp(&b.at));
            MapCurve { name, points }
        };
        let curves = grouped(cases, |(case, _)| case.method.to_string()).into_iter().map(curve).collect();
        StabilityMap { over: axis.label, scale: axis.scale, shared, curves }
    };
    grouped(searched, |(case, _)| settings_of(case)).into_iter().map(map).collect()
}

/// The parameter that takes most values, two at least.
fn widest_axis(records: &[Record]) -> Option<&'static MapAxis> {
    let values = |axis: &MapAxis| {
        let mut values: Vec<f64> = records.iter().map(|record| (axis.of)(&record.case)).collect();
        values.sort_by(f64::total_cmp);
        values.dedup();
        values.len()
    };
    AXES.iter().filter(|axis| values(axis) > 1).max_by_key(|axis| values(axis))
}

/// The choices of the integrator, in words.
fn settings_of(case: &Case) -> String {
    let settings = &case.settings;
    let mapping = if settings.mapping_back { "" } else { ", no mapping back" };
    let scheme =
        if settings.scheme.is_paper() { String::new() } else { format!(", {}", settings.scheme.name()) };
    let slopes = if settings.affine { ", APIC" } else { "" };
    let stresses = if settings.stress_slopes { ", stress slopes" } else { "" };
    format!("{} drag{mapping}{slopes}{stresses}{scheme}", settings.drag.name())
}

/// Ratio of the largest to the least step from which on an axis is logarithmic.
const WIDE: f64 = 20.0;

fn figure(map: &StabilityMap) -> Figure {
    let steps = || map.curves.iter().flat_map(|curve| &curve.points).map(|point| point.predicted);
    let (least, most) = (steps().fold(f64::INFINITY, f64::min), steps().fold(0.0, f64::max));
    let label = "critical step over h/c (–)";
    let y = if most > WIDE * least { ChartAxis::log10(label) } else { ChartAxis::linear(label) };
    let x = match map.scale {
        MapScale::Counts => ChartAxis::linear(map.over).with_ticks((1..=5).map(f64::from).collect()),
        MapScale::Linear => ChartAxis::linear(map.over),
        MapScale::Log => ChartAxis::log10(map.over),
    };
    let mut chart = Chart::new(format!("Critical step, {}", map.shared), x, y);
    chart.size = Size::PANEL;
    for (slot, curve) in map.curves.iter().enumerate() {
        let predicted = curve.points.iter().map(|point| (point.at, point.predicted)).collect();
        let observed = curve.points.iter().filter_map(|point| Some((point.at, point.observed?))).collect();
        let lines = [("predicted", predicted, Style::Line), ("observed", observed, Style::Markers)];
        chart.series.extend(lines.map(|(what, points, style)| {
            Series::new(format!("{}, {what}", curve.name), points).style(style).slot(slot)
        }));
    }
    Figure::new(
        slug(&map.shared),
        chart,
        "Lines: spectral radius of the step operator. Marks: bisection of runs.",
    )
}

/// One row per case: predicted and observed critical step, and what the runs beside the limit did.
pub fn table(records: &[Record]) -> Table {
    let header = "case | > predicted [s] | > observed [s] | > difference | > over h/c | > slow growth from [s] | at 0.97 \
                  | at 1.03";
    let rows = records.iter().filter_map(row_of);
    Table::of("Critical time step, predicted and observed", columns(header), rows)
        .file("critical-steps")
        .note(
            "predicted: from the spectral radius of the step operator on the case's own grid; observed: by \
         bisection over runs without the prediction, and in a plane of up to 8 × 8 cells over the \
         eigenvalues of its own step, which show a doubling in 10 000 steps; where points deform, the \
         smallest step predicted during the run and the largest fraction of it with which `solve` succeeds; \
         c: the fastest undamped wave",
        )
}

fn row_of(record: &Record) -> Option<Vec<Cell>> {
    let found = record.stability.as_ref()?;
    let predicted = found.known();
    let (no_limit, not_stable) = ("no limit is known: something grows under any step", "no step was stable");
    let why = if predicted.is_none() { no_limit } else { not_stable };
    let mut row = vec![
        Cell::Code(record.case.label_without_step()),
        Cell::of(predicted, Cell::Error, no_limit),
        Cell::of(found.observed, Cell::Error, not_stable),
        match predicted.and(found.within()) {
            Some(within) => Cell::Text(format!("within {:.2} %", 100.0 * within)),
            None => Cell::of(predicted.and(found.deviation()), Cell::Percent, why),
        },
        Cell::Number(found.predicted / found.wave_limit),
        found.creeping_from.map_or(Cell::Text("–".to_owned()), Cell::Error),
    ];
    row.extend(
        found.probes.iter().map(|probe| Cell::Verdict(Mood::of(probe.is_as_predicted()), probe_words(probe))),
    );
    Some(row)
}

fn probe_words(probe: &Probe) -> String {
    let Some(failure) = &probe.failure else {
        let end = if probe.reaches_end { " to the end" } else { "" };
        return format!("runs {} steps{end}", probe.steps);
    };
    let growth = failure.growth.map_or(String::new(), |seen| {
        let predicted = probe.predicted_growth.map(|predicted| format!(" ({predicted:.4} predicted)"));
        format!(", grows by {seen:.4} a step{}", predicted.unwrap_or_default())
    });
    format!("{} at step {}{growth}", failure.kind.name(), failure.step)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::runner::{records_of, solved};
    use crate::case::planned::Tier;
    use oedometer_problem::outcome::{Failure, FailureKind};
    use oedometer_problem::settings::Drag;
    use oedometer_problem::settings::Scheme;

    #[test]
    fn a_map_is_drawn_over_what_takes_most_values_wherever_its_axis_stands() {
        let axis = |sweep: &str| {
            let records = records_of(&format!(
                "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['MPM']\nintegrator = ['implicit']\n\
                 time_step = [{{ growth = 0.5 }}]\ncells = [2]\n{sweep}"
            ));
            widest_axis(&records).map(|axis| axis.label)
        };
        let (conductivity, porosity) = ("hydraulic conductivity k (m/s)", "porosity n (–)");
        let sweep = |k: &str, n: &str| format!("hydraulic_conductivity = [{k}]\nporosity = [{n}]\n");
        assert_eq!(axis(&sweep("1e-4, 1e-5", "0.3, 0.4, 0.5")), Some(porosity));
        assert_eq!(axis(&sweep("1e-4, 1e-5, 1e-6", "0.3, 0.4")), Some(conductivity));
        assert_eq!(axis(&sweep("1e-4", "0.3, 0.4")), Some(porosity));
        assert_eq!(axis(""), None);
    }

    #[test]
    fn the_largest_deviation_counts_on_both_sides_wherever_it_stands() {
        let (study, records) = solved(
            "s",
            "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['MPM']\n\
             integrator = ['implicit']\ncells = [2]\nhydraulic_conductivity = [1e-4, 1e-5, 1e-6]\n",
        );
        for (place, worst) in (0..3).flat_map(|place| [(place, 0.6), (place, 1.4)]) {
            let mut records = records.clone();
            for (number, record) in records.iter_mut().enumerate() {
                record.stability = Some(CriticalStep {
                    predicted: 2.0,
                    creeping_from: None,
                    unknown: None,
                    observed: Some(2.0 * if number == place { worst } else { 0.9 }),
                    wave_limit: 4.0,
                    drag_limit: 8.0,
                    combined_limit: 3.0,
                    probes: Vec::new(),
                    resolution: None,
                    asymmetry: None,
                });
            }
            let found = ask(&[StudyResults::new(&study, &records, Tier::Full)]).expect("searched");
            let told = "3 of 3 cases have both a predicted and an observed critical step; they differ by at \
                        most 40.00 %.";
            assert_eq!(found.sentence().expect("a sentence"), told, "{worst} at {place}");
        }
    }

    #[test]
    fn curves_lie_along_the_axis_of_their_map_with_steps_over_that_of_the_wave() {
        use MapScale::{Counts, Linear, Log};
        for (key, values, label, scale, places) in [
            ("hydraulic_conductivity", "1e-4, 1e-6", "hydraulic conductivity k (m/s)", Log, [1e-6, 1e-4]),
            ("water_bulk_modulus", "4e9, 2e9", "stiffness of the water K_w/E (–)", Log, [2e3, 4e3]),
            ("porosity", "0.4, 0.2", "porosity n (–)", Log, [0.2, 0.4]),
            ("points_per_cell", "3, 2", "points per cell (–)", Counts, [2.0, 3.0]),
            ("offset", "0.25, -0.25", "shift of the points, in spacings (–)", Linear, [-0.25, 0.25]),
            ("flip", "1.0, 0.5", "FLIP share (–)", Linear, [0.5, 1.0]),
        ] {
            let mut records = records_of(&format!(
                "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [1e-4]\n[[sweep]]\nmethod = ['MPM', 'GIMP']\n\
                 integrator = ['explicit']\ncells = [2]\n{key} = [{values}]\n"
            ));
            for record in &mut records {
                record.stability = Some(CriticalStep {
                    predicted: 2.0,
                    observed: (record.case.method.to_string() == "MPM").then_some(1.0),
                    wave_limit: 4.0,
                    drag_limit: 8.0,
                    combined_limit: 3.0,
                    ..CriticalStep::default()
                });
            }
            // A record whose step was not searched is on no map.
            let not_searched = Record { stability: None, ..records[0].clone() };
            let maps = maps_of(&[&records[..], &[not_searched]].concat());
            let [map] = &maps[..] else { panic!("{maps:?}") };
            assert_eq!((map.over, map.scale, &*map.shared), (label, scale, "explicit drag"));
            let point = |observed: Option<f64>| move |at: f64| MapPoint { at, predicted: 0.5, observed };
            let curve = |name: &str, observed: Option<f64>| MapCurve {
                name: name.to_owned(),
                points: places.map(point(observed)).to_vec(),
            };
            assert_eq!(map.curves, [curve("MPM", Some(0.25)), curve("GIMP", None)], "{key}");
            // Another choice of the integrator is another map.
            records[0].case.settings.mapping_back = false;
            let shared: Vec<String> = maps_of(&records).into_iter().map(|map| map.shared).collect();
            assert_eq!(shared, ["explicit drag, no mapping back", "explicit drag"], "{key}");
            let settings = &mut records[0].case.settings;
            (settings.drag, settings.scheme) = (Drag::Centred, Scheme::Leapfrog);
            (settings.affine, settings.stress_slopes) = (true, true);
            let all = "centred drag, no mapping back, APIC, stress slopes, leapfrog";
            assert_eq!(settings_of(&records[0].case), all);
        }
    }

    #[test]
    fn a_limit_that_is_not_known_has_no_difference_and_a_run_beside_it_is_told_by_its_end() {
        let probe = |steps: u64, growth: Option<f64>| Probe {
            share: 1.03,
            step: 0.5,
            steps,
            reaches_end: steps == 7,
            failure: growth.map(|_| {
                let kind = FailureKind::Unstable;
                Failure { kind, step: steps, time: 1.0, growth, reason: String::new() }
            }),
            predicted_growth: (steps == 9).then_some(1.0625),
        };
        let probes = [probe(7, None), probe(8, None), probe(9, Some(1.125)), probe(10, Some(1.25))];
        let words = probes.each_ref().map(probe_words);
        assert_eq!(
            words,
            [
                "runs 7 steps to the end",
                "runs 8 steps",
                "unstable at step 9, grows by 1.1250 a step (1.0625 predicted)",
                "unstable at step 10, grows by 1.2500 a step"
            ]
        );
        let found = |observed: Option<f64>, unknown: Option<&str>| {
            let text = "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1]\n[[sweep]]\nmethod = ['MPM']\n\
                        integrator = ['implicit']\ncells = [2]\n";
            let mut record = records_of(text).remove(0);
            record.stability = Some(CriticalStep {
                predicted: 0.5,
                observed,
                wave_limit: 0.25,
                drag_limit: 1.0,
                combined_limit: 1.0,
                unknown: unknown.map(str::to_owned),
                probes: probes[..2].to_vec(),
                ..CriticalStep::default()
            });
            table(&[record]).rows.remove(0)
        };
        let shown: Vec<String> = found(Some(0.75), None).iter().map(Cell::show).collect();
        assert_eq!(shown[1..6], ["5.00e-1", "7.50e-1", "50.0 %", "2", "–"]);
        let none = Cell::missing("no step was stable");
        assert_eq!(found(None, None)[2..4], [none.clone(), none]);
        let unknown = found(Some(0.75), Some("a reason"));
        let nothing = "no limit is known: something grows under any step";
        assert_eq!((&unknown[1], &unknown[2]), (&Cell::missing(nothing), &Cell::Error(0.75)));
        assert_eq!(unknown[3], Cell::missing(nothing), "a step was stable");
    }
}
