//! `oedometer exact`: an exact solution as numbers.

use crate::api::exact::{MOST_TAIL, Place, accuracy_of, degree_of, places_of};
use crate::api::scene_of;
use crate::cli::exit::{Ended, Exit};
use crate::cli::output::{csv_of, json_of, print_data, say};
use crate::cli::study_files::tell_warnings;
use crate::study::asked::Asked;
use crate::study::overrides::{Assignments, numbers, times};
use clap::ValueEnum;
use oedometer_exact::exact_error::ExactError;
use oedometer_exact::footing::LOAD_FACTOR;
use oedometer_exact::mandel::Mandel;
use oedometer_exact::parameters::ColumnParameters;
use oedometer_exact::reference::{Reference, ReferenceKind};
use oedometer_exact::{Accuracy, TextbookProblem, consolidation};
use oedometer_scenes::scene::Clock;
use oedometer_wording::{count_of, typed};

/// Distances from the middle of a slab if none are given.
const DEFAULT_DISTANCES: &str = "0,0.25,0.5,0.75,1";
/// Distance from the wall of a motion if none is given: on the wall a vortex moves nothing.
const DISTANCE_IN_MOTION: &str = "0.25";
/// Depths if none are given.
const DEFAULT_DEPTHS: &str = "0,0.1,0.2,0.3,0.4,0.5,0.6,0.7,0.8,0.9,1";
/// Time factors if none are given; a yield front has its scene's.
const DEFAULT_TIMES: [f64; 5] = [0.05, 0.1, 0.2, 0.5, 1.0];

/// Output format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Format {
    /// One row per time factor and depth, 17 significant digits
    Csv,
    /// Also print the terms used and the tail bounds
    Json,
}

/// Arguments of `exact`.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Exact solution: terzaghi (compressible water), terzaghi-incompressible, single-mode, …
    #[arg(value_name = "SOLUTION")]
    scene: String,
    /// Time factors `T_v` = `c_v` t/H², comma-separated [default: 0.05,0.1,0.2,0.5,1.0]
    #[arg(long, value_name = "LIST", allow_hyphen_values = true)]
    time_factor: Option<String>,
    /// Times, comma-separated: in s, or with a unit, like 30d or "1 year"
    #[arg(long = "time", value_name = "LIST", conflicts_with = "time_factor", allow_hyphen_values = true)]
    times: Option<String>,
    /// Degrees of consolidation (by settlement) whose time factors are computed, instead of --time-factor
    #[arg(long, value_name = "LIST", conflicts_with_all = ["time_factor", "times"], allow_hyphen_values = true)]
    degree: Option<String>,
    /// Lagrangian depths ζ below the drained surface, comma-separated
    #[arg(long, default_value = DEFAULT_DEPTHS, value_name = "LIST", allow_hyphen_values = true)]
    zeta: String,
    /// Distances x/L from the crest of a layer's cosine load, comma-separated: adds columns; x/a from the
    /// middle of Mandel's slab
    #[arg(long, value_name = "LIST", allow_hyphen_values = true)]
    x: Option<String>,
    #[command(flatten)]
    set: Assignments,
    /// Output format
    #[arg(long, value_enum, default_value_t = Format::Csv)]
    format: Format,
}

/// One printed row: names of columns with their numbers; empty where a number means nothing.
struct PrintedRow(Vec<(&'static str, Option<f64>)>);

impl PrintedRow {
    fn of(columns: &[(&'static str, f64)]) -> Self {
        Self(columns.iter().map(|(name, number)| (*name, Some(*number))).collect())
    }
}

impl serde::Serialize for PrintedRow {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().copied())
    }
}

/// Truncation and round-off at one time factor, with what has units.
#[derive(serde::Serialize)]
struct Truncation {
    time_factor: f64,
    terms: usize,
    tail_bound: f64,
    /// Effect of round-off on the fields over the load.
    round_off: f64,
    /// Time, s, where there is one.
    seconds: Option<f64>,
    /// Settlement, m.
    settlement: f64,
}

impl Truncation {
    fn of(
        reference: &Reference,
        parameters: &ColumnParameters,
        time_factor: f64,
    ) -> Result<Self, ExactError> {
        let accuracy = accuracy_of(reference, time_factor)?;
        let Accuracy { terms, tail_bound, .. } = accuracy;
        Ok(Self {
            time_factor,
            terms,
            tail_bound,
            round_off: accuracy.round_off(),
            seconds: reference.kind().has_time().then(|| parameters.time(time_factor)),
            settlement: reference.settlement(time_factor)?,
        })
    }

    /// As a line of text.
    fn sentence(&self) -> String {
        let Self { time_factor, terms, tail_bound, round_off, seconds, settlement } = self;
        let seconds = seconds.map_or(String::new(), |seconds| format!("t = {seconds:.6e} s, "));
        let terms = count_of(*terms, "term", "terms");
        format!(
            "T_v = {time_factor}: {seconds}s = {settlement:.6e} m, {terms}, tail below {tail_bound:.1e}, \
             round-off below {round_off:.0e}"
        )
    }
}

#[derive(serde::Serialize)]
struct ExactJson<'a> {
    reference: &'a str,
    rows: &'a [PrintedRow],
    accuracy: &'a [Truncation],
    /// Least porosity of all places and times, where it bounds what is possible.
    #[serde(skip_serializing_if = "Option::is_none")]
    least_porosity: Option<f64>,
}

/// Evaluates and prints.
pub fn run(arguments: &Arguments) -> anyhow::Result<Exit> {
    let (kind, _) = scene_of(&arguments.scene).map_err(|why| Ended::usage(why.to_string()))?;
    let asked = Asked::of_solution(kind, &arguments.set)?;
    tell_warnings(&asked.study);
    let (parameters, kind) = (asked.parameters, asked.references[0]);
    // These have none of their own at the usual times.
    let has_other_times = matches!(asked.study.scene.clock, Clock::HalfSpace | Clock::Wave);
    let time_factors = match (&arguments.degree, &arguments.times, &arguments.time_factor) {
        (Some(degrees), ..) => time_factors_of(kind, &parameters, &numbers("--degree", degrees)?)?,
        (_, Some(typed), _) => time_factors_at(kind, &parameters, &times("--time", typed)?)?,
        (_, _, Some(typed)) => numbers("--time-factor", typed)?,
        _ if has_other_times => {
            let case = &asked.study.planned[0].case;
            (case.scene.outputs)(&case.column, &case.material)
        }
        _ => DEFAULT_TIMES.to_vec(),
    };
    let reference = Reference::new(kind, &parameters, &time_factors)?;
    let rows = match kind {
        ReferenceKind::Mandel => slab_rows(&parameters, &time_factors, arguments)?,
        // The load at collapse, whatever the settlement.
        ReferenceKind::Footing => time_factors
            .iter()
            .map(|time| PrintedRow::of(&[("time_factor", *time), ("load_factor", LOAD_FACTOR)]))
            .collect(),
        _ => column_rows(&reference, &parameters, &time_factors, arguments)?,
    };
    let accuracy = time_factors.iter().map(|time| Truncation::of(&reference, &parameters, *time));
    let accuracy = accuracy.collect::<Result<Vec<_>, ExactError>>()?;
    print(&reference, &rows, &accuracy, arguments.format)?;
    for Truncation { time_factor, tail_bound, .. } in accuracy.iter().filter(|of| of.tail_bound > MOST_TAIL) {
        say!("warning: at T_v = {time_factor} the solution may be off by {tail_bound:.1e} of the load");
    }
    Ok(Exit::Pass)
}

/// The rows over times and depths, and with `--x` over distances.
fn column_rows(
    reference: &Reference,
    parameters: &ColumnParameters,
    time_factors: &[f64],
    arguments: &Arguments,
) -> anyhow::Result<Vec<PrintedRow>> {
    let kind = reference.kind();
    let mut depths = numbers("--zeta", &arguments.zeta)?;
    if kind == ReferenceKind::Textbook(TextbookProblem::Injection) && arguments.zeta == DEFAULT_DEPTHS {
        // The source itself, where the pressure is infinite.
        depths.retain(|zeta| *zeta < 1.0);
    }
    let of_motion = kind.is_manufactured().then_some(DISTANCE_IN_MOTION);
    let distances = arguments.x.as_deref().or(of_motion).map(|typed| numbers("--x", typed)).transpose()?;
    let is_layer = matches!(kind, ReferenceKind::CosineLayer | ReferenceKind::CosineLayerIncompressible);
    if distances.is_some() && !is_layer && !kind.is_manufactured() {
        return Err(Ended::usage(format!(
            "`--x` is for layers, and `{kind}` depends only on depth: omit it, or ask for `{}` or `{}`",
            ReferenceKind::CosineLayer,
            ReferenceKind::Mandel
        )));
    }
    // Where what is typed changes the stress alone, it is printed.
    let has_stress = matches!(kind, ReferenceKind::Textbook(_)) || parameters.self_weight;
    let mut rows = Vec::new();
    for &time_factor in time_factors {
        let settlement = reference.settlement(time_factor)?;
        let degree = degree_of(reference, time_factor)?;
        let places = places_of(reference, parameters, time_factor, &depths, distances.as_deref())?;
        for Place { zeta, x, pressure, effective_stress: [xx, yy, xy], displacement } in
            places.into_iter().flatten()
        {
            let mut row = PrintedRow::of(&[
                ("time_factor", time_factor),
                ("zeta", zeta),
                ("pressure_ratio", pressure / parameters.load),
                ("settlement_ratio", settlement / parameters.height),
            ]);
            row.0.push(("degree_of_consolidation", degree));
            let further = if let Some(x) = x {
                PrintedRow::of(&[
                    ("x", x),
                    ("horizontal_displacement_ratio", displacement[0] / parameters.height),
                    ("vertical_displacement_ratio", displacement[1] / parameters.height),
                    ("effective_stress_ratio_xx", xx / parameters.load),
                    ("effective_stress_ratio_yy", yy / parameters.load),
                    ("effective_stress_ratio_xy", xy / parameters.load),
                ])
            } else if has_stress {
                PrintedRow::of(&[
                    ("effective_stress_ratio", yy / parameters.load),
                    ("displacement_ratio", displacement[1] / parameters.height + 0.0),
                ])
            } else {
                PrintedRow::of(&[])
            };
            row.0.extend(further.0);
            rows.push(row);
        }
    }
    Ok(rows)
}

/// The rows of Mandel's slab, which depend on the distance from its middle.
fn slab_rows(
    parameters: &ColumnParameters,
    time_factors: &[f64],
    arguments: &Arguments,
) -> anyhow::Result<Vec<PrintedRow>> {
    if arguments.zeta != DEFAULT_DEPTHS {
        return Err(Ended::usage(
            "the fields of `mandel` depend on the distance from the middle: give it by `--x`",
        ));
    }
    let slab = Mandel::new(parameters)?;
    let distances = numbers("--x", arguments.x.as_deref().unwrap_or(DEFAULT_DISTANCES))?;
    let mut rows = Vec::new();
    for &time_factor in time_factors {
        for &distance in &distances {
            let ratios = slab.ratios(time_factor, distance)?;
            rows.push(PrintedRow::of(&[
                ("time_factor", time_factor),
                ("x", distance),
                ("pressure_ratio", ratios.pressure),
                ("stress_ratio", ratios.stress),
                ("displacement_ratio", ratios.displacement),
                ("strain_ratio", ratios.strain),
            ]));
        }
    }
    Ok(rows)
}

/// Prints rows and their accuracy.
fn print(
    reference: &Reference,
    rows: &[PrintedRow],
    accuracy: &[Truncation],
    format: Format,
) -> anyhow::Result<()> {
    let least_porosity = reference.least_porosity();
    if format == Format::Json {
        let json = ExactJson { reference: reference.name(), rows, accuracy, least_porosity };
        return print_data(&json_of(&json)?);
    }
    print_data(&rows_csv(rows)?)?;
    for of in accuracy {
        say!("{}", of.sentence());
    }
    if let Some(porosity) = least_porosity {
        say!("the porosity stays above {porosity:.6e}");
    }
    Ok(())
}

/// Time factors of times, s.
fn time_factors_at(
    kind: ReferenceKind,
    parameters: &ColumnParameters,
    times: &[f64],
) -> anyhow::Result<Vec<f64>> {
    if !kind.has_time() {
        return Err(Ended::usage(format!("`{kind}` has no time: leave `--time` out")));
    }
    match times.iter().find(|time| !(time.is_finite() && **time >= 0.0)) {
        Some(time) => Err(Ended::usage(format!(
            "a time of {} s is invalid: 0 is the undrained start, later times are positive",
            typed(*time)
        ))),
        None => Ok(times.iter().map(|time| parameters.time_factor(*time)).collect()),
    }
}

/// Time factors at which degrees of consolidation are reached.
fn time_factors_of(
    kind: ReferenceKind,
    parameters: &ColumnParameters,
    degrees: &[f64],
) -> anyhow::Result<Vec<f64>> {
    let storage = match kind {
        ReferenceKind::Terzaghi => parameters.storage_ratio(),
        // Xie & Leo's degree by settlement equals Terzaghi's.
        ReferenceKind::TerzaghiIncompressible | ReferenceKind::XieLeo => 1.0,
        _ => return Err(Ended::usage(format!("`{kind}` has no time factor for a degree in closed form"))),
    };
    // By settlement: degree = 1 − B + B U(B T_v); the first 1 − B is there at once.
    let factor_of = |degree: &f64| {
        // No sign at zero.
        let at_once = 1.0 - storage + 0.0;
        if !(*degree >= at_once && *degree < 1.0) {
            return Err(Ended::usage(format!(
                "a degree of consolidation of {degree} has no time factor: it must be at least \
                 {at_once:.3e}, the degree at the start, and below 1"
            )));
        }
        let drained = (degree - (1.0 - storage)) / storage;
        Ok(consolidation::time_factor_for_degree(drained)? / storage)
    };
    degrees.iter().map(factor_of).collect()
}

/// The rows as CSV: the first two columns as requested, results with 17 significant digits.
fn rows_csv(rows: &[PrintedRow]) -> anyhow::Result<String> {
    let names = rows.first().into_iter().flat_map(|row| row.0.iter().map(|(name, _)| *name));
    let fields = |row: &PrintedRow| {
        let field = |(place, (_, number)): (usize, &(&str, Option<f64>))| match number {
            Some(number) if place < 2 => number.to_string(),
            Some(number) => format!("{number:.16e}"),
            None => String::new(),
        };
        row.0.iter().enumerate().map(field).collect()
    };
    csv_of(names, rows.iter().map(fields))
}
