//! `oedometer exact`: an exact solution as numbers.

use crate::cli::exit::{Ended, Exit};
use crate::cli::output::{csv_of, json_of};
use crate::cli::overrides;
use crate::cli::overrides::StudyLines;
use crate::cli::stream::{print_data, say};
use crate::study::check::Purpose;
use clap::ValueEnum;
use oedometer_exact::consolidation;
use oedometer_exact::cosine_layer::LayerFields;
use oedometer_exact::field_values::Accuracy;
use oedometer_exact::mandel::Mandel;
use oedometer_exact::manufactured::PlaneValues;
use oedometer_exact::parameters::ColumnParameters;
use oedometer_exact::reference::{Reference, ReferenceKind};
use oedometer_mpm::scene::SceneKind;
use oedometer_mpm::scene::column::column_parameters;

/// Distances from the middle of a slab printed where none are asked for.
const DEFAULT_DISTANCES: &str = "0,0.25,0.5,0.75,1";
/// Depths printed where none are asked for.
const DEFAULT_DEPTHS: &str = "0,0.1,0.2,0.3,0.4,0.5,0.6,0.7,0.8,0.9,1";

/// Output format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Format {
    /// One row a time factor and depth, 17 significant digits.
    Csv,
    /// The same with terms used and tail bounds.
    Json,
}

/// What round-off does to the fields over the load: 7.5e-15 is the most seen against values of 40 digits.
const ROUND_OFF: f64 = 1e-14;

/// Arguments of `exact`.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Exact solution: terzaghi (compressible water), terzaghi-incompressible, single-mode, …
    scene: String,
    /// Time factors `T_v` = `c_v` t/H², comma-separated
    #[arg(long, default_value = "0.05,0.1,0.2,0.5,1.0", value_name = "LIST", allow_hyphen_values = true)]
    time_factor: String,
    /// Time factors at which these degrees of consolidation (by settlement) are reached, instead
    #[arg(long, value_name = "LIST", conflicts_with = "time_factor", allow_hyphen_values = true)]
    degree: Option<String>,
    /// Lagrangian depths ζ below the drained surface, comma-separated
    #[arg(long, default_value = DEFAULT_DEPTHS, value_name = "LIST", allow_hyphen_values = true)]
    zeta: String,
    /// Distances x/L from the crest of a layer's cosine load, comma-separated: adds columns; x/a from the
    /// middle of Mandel's slab
    #[arg(long, value_name = "LIST", allow_hyphen_values = true)]
    x: Option<String>,
    /// Older name of --x, under which the column is called xi
    #[arg(long, value_name = "LIST", hide = true, conflicts_with = "x", allow_hyphen_values = true)]
    along: Option<String>,
    /// Set a dotted key of a study file, like material.porosity=0.45
    #[arg(long = "set", value_name = "KEY=VALUE")]
    assignments: Vec<String>,
    /// Output format
    #[arg(long, value_enum, default_value_t = Format::Csv)]
    format: Format,
}

/// One printed row: names of columns with their numbers.
struct PrintedRow(Vec<(&'static str, f64)>);

impl serde::Serialize for PrintedRow {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().copied())
    }
}

/// The same of a motion that was chosen, over the side of its square and the amplitude of its pressure.
fn motion_columns(fields: &PlaneValues, parameters: &ColumnParameters) -> [(&'static str, f64); 5] {
    let [[xx, xy], [_, yy]] = fields.effective_stress.map(|row| row.map(|stress| stress / parameters.load));
    let [horizontal, vertical] = fields.displacement.map(|component| component / parameters.height);
    [
        ("horizontal_displacement_ratio", horizontal),
        ("vertical_displacement_ratio", vertical),
        ("effective_stress_ratio_xx", xx),
        ("effective_stress_ratio_yy", yy),
        ("effective_stress_ratio_xy", xy),
    ]
}

/// What `--x` adds: the distance, displacements over the height, effective stresses over the load.
fn plane_columns(fields: &LayerFields, parameters: &ColumnParameters) -> [(&'static str, f64); 5] {
    let [xx, yy, _, xy] = fields.effective_stress.map(|stress| stress / parameters.load);
    let [horizontal, vertical] = fields.displacement.map(|component| component / parameters.height);
    [
        ("horizontal_displacement_ratio", horizontal),
        ("vertical_displacement_ratio", vertical),
        ("effective_stress_ratio_xx", xx),
        ("effective_stress_ratio_yy", yy),
        ("effective_stress_ratio_xy", xy),
    ]
}

/// Places along a layer, with the name of their column.
struct Distances {
    /// As it is called in the header.
    column: &'static str,
    /// `x/L` from the crest of the load.
    ratios: Vec<f64>,
}

impl Distances {
    /// Those that were asked for, of a solution that has them.
    fn of(arguments: &Arguments, kind: ReferenceKind) -> anyhow::Result<Option<Self>> {
        let (option, column, typed) = match (&arguments.x, &arguments.along) {
            (Some(typed), _) => ("--x", "x", typed),
            (None, Some(typed)) => ("--along", "xi", typed),
            (None, None) => return Ok(None),
        };
        let is_layer = matches!(kind, ReferenceKind::CosineLayer | ReferenceKind::CosineLayerIncompressible);
        if !is_layer && !kind.is_manufactured() {
            return Err(Ended::usage(format!(
                "`{option}` is of a layer: `{kind}` depends on the depth alone; leave it out, or ask for `{}` or `{}`",
                ReferenceKind::CosineLayer,
                ReferenceKind::Mandel
            )));
        }
        Ok(Some(Self { column, ratios: overrides::numbers(option, typed)? }))
    }
}

/// Truncation at one time factor.
#[derive(serde::Serialize)]
struct Truncation {
    time_factor: f64,
    terms: usize,
    tail_bound: f64,
    /// What round-off does to the fields over the load.
    round_off: f64,
}

impl Truncation {
    fn of(time_factor: f64, accuracy: Accuracy) -> Self {
        let Accuracy { terms, tail_bound, phase_bound } = accuracy;
        Self { time_factor, terms, tail_bound, round_off: ROUND_OFF.max(phase_bound) }
    }
}

#[derive(serde::Serialize)]
struct ExactJson<'a> {
    reference: &'a str,
    rows: &'a [PrintedRow],
    accuracy: &'a [Truncation],
}

/// Evaluates and prints.
pub fn run(arguments: &Arguments) -> anyhow::Result<Exit> {
    let kind: ReferenceKind = arguments.scene.parse().map_err(|_| {
        let names: Vec<&str> = ReferenceKind::ALL.iter().map(|kind| kind.name()).collect();
        Ended::usage(format!(
            "no exact solution is called `{}`; there are {}",
            arguments.scene,
            names.join(", ")
        ))
    })?;
    let (parameters, kind) = parameters_of(kind, &arguments.assignments)?;
    let depths = overrides::numbers("--zeta", &arguments.zeta)?;
    let time_factors = match &arguments.degree {
        Some(degrees) => time_factors_of(kind, &parameters, &overrides::numbers("--degree", degrees)?)?,
        None => overrides::numbers("--time-factor", &arguments.time_factor)?,
    };
    if kind == ReferenceKind::Mandel {
        let (rows, accuracy) = slab_rows(&Mandel::new(&parameters)?, &time_factors, arguments)?;
        return print(kind.name(), &rows, &accuracy, arguments.format);
    }
    let distances = Distances::of(arguments, kind)?;
    let reference = Reference::new(kind, &parameters, &time_factors)?;
    let mut rows = Vec::new();
    let mut accuracy = Vec::new();
    for time_factor in time_factors {
        let settlement = reference.settlement(time_factor)?;
        let degree = reference.degree_of_consolidation(time_factor)?;
        let row = |zeta: f64, pressure: f64| {
            vec![
                ("time_factor", time_factor),
                ("zeta", zeta),
                ("pressure_ratio", pressure / parameters.load),
                ("settlement_ratio", settlement / parameters.height),
                ("degree_of_consolidation", degree),
            ]
        };
        let state = if distances.is_some() { reference.plane_state(time_factor)? } else { None };
        for zeta in &depths {
            let fields = reference.fields(time_factor, *zeta)?;
            if let (Some(motion), Some(distances)) = (reference.manufactured(), &distances) {
                for ratio in &distances.ratios {
                    let at = motion.plane_fields(time_factor, [*ratio, 1.0 - zeta])?;
                    let mut columns = row(*zeta, at.pressure);
                    columns.push((distances.column, *ratio));
                    columns.extend(motion_columns(&at, &parameters));
                    rows.push(PrintedRow(columns));
                }
                continue;
            }
            let (Some(state), Some(distances)) = (&state, &distances) else {
                rows.push(PrintedRow(row(*zeta, fields.pressure)));
                continue;
            };
            for ratio in &distances.ratios {
                let at = state.fields(ratio * parameters.length, (1.0 - zeta) * parameters.height)?;
                let mut columns = row(*zeta, at.pressure);
                columns.push((distances.column, *ratio));
                columns.extend(plane_columns(&at, &parameters));
                rows.push(PrintedRow(columns));
            }
        }
        let truncation = reference.accuracy(time_factor)?;
        accuracy.push(Truncation::of(time_factor, truncation));
    }
    print(reference.name(), &rows, &accuracy, arguments.format)
}

/// The rows of Mandel's slab, which depend on the distance from its middle.
fn slab_rows(
    slab: &Mandel,
    time_factors: &[f64],
    arguments: &Arguments,
) -> anyhow::Result<(Vec<PrintedRow>, Vec<Truncation>)> {
    if arguments.zeta != DEFAULT_DEPTHS || arguments.along.is_some() {
        return Err(Ended::usage(
            "the fields of `mandel` depend on the distance from the middle: give it by `--x`",
        ));
    }
    let distances = overrides::numbers("--x", arguments.x.as_deref().unwrap_or(DEFAULT_DISTANCES))?;
    let (mut rows, mut accuracy) = (Vec::new(), Vec::new());
    for &time_factor in time_factors {
        for &distance in &distances {
            let ratios = slab.ratios(time_factor, distance)?;
            rows.push(PrintedRow(vec![
                ("time_factor", time_factor),
                ("x", distance),
                ("pressure_ratio", ratios.pressure),
                ("stress_ratio", ratios.stress),
                ("displacement_ratio", ratios.displacement),
                ("strain_ratio", ratios.strain),
            ]));
        }
        accuracy.push(Truncation::of(time_factor, slab.accuracy(time_factor)?));
    }
    Ok((rows, accuracy))
}

/// Prints rows, and how far they can be trusted.
fn print(name: &str, rows: &[PrintedRow], accuracy: &[Truncation], format: Format) -> anyhow::Result<Exit> {
    match format {
        Format::Csv => {
            print_data(&rows_csv(rows)?)?;
            for one in accuracy {
                say!(
                    "T_v = {}: {} terms, tail below {:.1e}, round-off below {:.0e}",
                    one.time_factor,
                    one.terms,
                    one.tail_bound,
                    one.round_off
                );
            }
        }
        Format::Json => {
            let json = ExactJson { reference: name, rows, accuracy };
            print_data(&json_of(&json)?)?;
        }
    }
    Ok(Exit::Pass)
}

/// The column of the seed with the assignments, judged as a study's, and the reference with the
/// equations that they choose.
pub fn parameters_of(
    kind: ReferenceKind,
    assignments: &[String],
) -> anyhow::Result<(ColumnParameters, ReferenceKind)> {
    let scene = SceneKind::of_solution(kind);
    let mut lines = StudyLines::of("exact", scene.name(), "the solution's name")?;
    lines.assign(assignments)?;
    lines.refuse_without_effect(&overrides::OF_RUNS)?;
    let study = lines.study_for(Purpose::Theory, ["method = [\"MPM\"]", "cells = [1]"].map(str::to_owned))?;
    let Some(planned) = study.planned.first() else {
        return Err(Ended::usage("the assignments leave no column"));
    };
    let soil = &planned.case.material;
    Ok((column_parameters(&planned.case.column, soil), kind.of_soil(soil)))
}

/// Time factors at which degrees of consolidation are reached.
fn time_factors_of(
    kind: ReferenceKind,
    parameters: &ColumnParameters,
    degrees: &[f64],
) -> anyhow::Result<Vec<f64>> {
    let storage = match kind {
        ReferenceKind::Terzaghi => parameters.storage_ratio(),
        // Xie & Leo's degree by settlement is Terzaghi's.
        ReferenceKind::TerzaghiIncompressible | ReferenceKind::XieLeo => 1.0,
        _ => return Err(Ended::usage(format!("`{kind}` has no time factor for a degree in closed form"))),
    };
    // By settlement: degree = 1 − B + B U(B T_v); the first 1 − B is there at once.
    let one = |degree: &f64| {
        // No sign at zero.
        let at_once = 1.0 - storage + 0.0;
        if !(*degree >= at_once && *degree < 1.0) {
            return Err(Ended::usage(format!(
                "a degree of consolidation of {degree} has no time factor: it must be at least {at_once:.3e}, \
                 which is there at once, and below 1, which is never reached"
            )));
        }
        let drained = (degree - (1.0 - storage)) / storage;
        Ok(consolidation::time_factor_for_degree(drained)? / storage)
    };
    degrees.iter().map(one).collect()
}

/// The rows as CSV: what was asked for as it is, what was found with 17 significant digits.
fn rows_csv(rows: &[PrintedRow]) -> anyhow::Result<String> {
    let names = rows.first().into_iter().flat_map(|row| row.0.iter().map(|(name, _)| *name));
    let fields = |row: &PrintedRow| {
        let field = |(place, (_, number)): (usize, &(&str, f64))| {
            if place < 2 { number.to_string() } else { format!("{number:.16e}") }
        };
        row.0.iter().enumerate().map(field).collect()
    };
    csv_of(names, rows.iter().map(fields))
}
