//! The critical time step of a problem, predicted from its own operators.

use crate::entries::of_dimension;
use crate::integrate::assembled::step::AssembledStep;
use crate::integrate::critical_step::known::{Limit, key_of, known_or};
use crate::integrate::critical_step::spectral_radius;
use crate::integrate::critical_step::spectral_radius::{GROWTH_TOLERANCE, SLOW_GROWTH};
use crate::kernel::body::{Body, Discrete};
use crate::state::grid::Grid;
use oedometer_problem::method::{PressureIntegration, Recovery};
use oedometer_problem::settings::ExplicitSettings;
use oedometer_problem::wave_speeds;
use oedometer_soil::elementary;
use oedometer_soil::material::Material;
use std::fmt;

/// Cells of the column for which the critical step of a run is computed.
const FEW_CELLS: usize = 12;
/// Cells along each side of the corner of a plane whose step operator is squared.
const MOST_ACROSS: usize = 8;
/// Share of the formula's step at which the growth of a mode that grows under any step is reported.
const FAR_BELOW: f64 = 0.1;

/// Growth of a mode over a whole run from which on the run is not made: from a hundredth of the solution to all of it.
const MOST_GROWTH: f64 = 100.0;
/// Rate at which anything may grow at the critical step, over that of what grows under any step.
const FASTER: f64 = 2.0;

/// A predicted critical step, with what it was predicted from.
#[derive(Clone, Debug)]
pub struct Prediction<const D: usize> {
    /// Largest stable step, s. Where a mode grows under any step, the largest under which nothing grows much faster; that of
    /// the formula where there is none.
    pub critical_step: f64,
    /// A mode that grows under any step, where there is one: then no limit is known for runs in which it grows far.
    pub growing: Option<GrowingMode>,
    /// Whether every growth under the critical step is too slow to count.
    is_bounded: bool,
    assembled: AssembledStep<D>,
    settings: ExplicitSettings,
}

/// A mode that grows under any step that was tried.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GrowingMode {
    /// The critical step of the prediction, s; one far below the formula's where nothing is slow enough for it.
    pub step: f64,
    /// Growth per such step.
    pub growth: f64,
}

impl GrowingMode {
    /// Whether the mode stays small in a run of so many seconds. It is a short wave, at the start a small part of what moves;
    /// where it is more than that, the energy that it gains without work ends the run.
    pub fn stays_small_for(&self, seconds: f64) -> bool {
        elementary::ln(self.growth) / self.step * seconds <= elementary::ln(MOST_GROWTH)
    }
}

impl fmt::Display for GrowingMode {
    /// Says that the limit is unknown.
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (step, rate) = (self.step, (self.growth - 1.0) / self.step);
        write!(out, "no limit is known: ")?;
        write!(
            out,
            "even with steps of {step:.2e} s a mode grows by {rate:.2e} 1/s, from the eigenvalues of the step"
        )
    }
}

impl<const D: usize> Prediction<D> {
    /// The critical step, s, where a limit is known.
    pub fn known_step(&self) -> Option<f64> {
        self.growing.is_none().then_some(self.critical_step)
    }

    /// Largest step, s, under which no mode grows by more than `growth` per step.
    pub fn critical_step_for(&self, growth: f64) -> f64 {
        let safe = self.critical_step;
        spectral_radius::critical_step(&self.assembled, &self.settings, safe, growth, true).unwrap_or(safe)
    }

    /// Factor by which the fastest mode grows in a run of so many seconds under steps of a size. None where it may be
    /// round-off: a growth per step up to [`GROWTH_TOLERANCE`], and up to [`SLOW_GROWTH`] in a run too short for a mode to
    /// double at that. None, too, where the operator is too large for its eigenvalues.
    pub fn growth_over(&self, seconds: f64, step: f64) -> Option<f64> {
        let steps = seconds / step;
        let may_double = D > 1 && steps * SLOW_GROWTH > std::f64::consts::LN_2;
        if self.is_bounded && !may_double {
            return None;
        }
        let per_step = spectral_radius::growth_by_parts(&self.assembled, step, &self.settings)?;
        let growth = elementary::powf(per_step, steps).min(f64::MAX);
        (per_step > 1.0 + GROWTH_TOLERANCE).then_some(growth)
    }

    /// Largest growth per step of any mode under steps of a size; none where the operator is too large.
    pub fn growth(&self, step: f64) -> Option<f64> {
        spectral_radius::growth(&self.assembled, step, &self.settings)
    }
}

/// Critical step, s, of the explicit integrator on a problem's initial configuration.
///
/// Computed from the problem's own operators. A long column is shortened in its middle, which changes the limit by less
/// than a percent; a wide layer is cut to six by six cells.
pub fn predicted_critical_step<const D: usize>(problem: &Discrete<D>, settings: &ExplicitSettings) -> f64 {
    predict_for_run(problem, settings).critical_step
}

/// The prediction of [`predicted_critical_step`].
pub fn predict_for_run<const D: usize>(problem: &Discrete<D>, settings: &ExplicitSettings) -> Prediction<D> {
    let Entry(predicted) = of_dimension::<Entry<D>>(&LINE, &PLANE);
    predicted(problem, settings)
}

/// What other crates call of the prediction.
struct Entry<const D: usize>(fn(&Discrete<D>, &ExplicitSettings) -> Prediction<D>);

static LINE: Entry<1> = Entry(|problem, settings| predict(problem, settings, FEW_CELLS));
static PLANE: Entry<2> = Entry(|problem, settings| predict(problem, settings, FEW_CELLS));

/// Largest growth per step of any mode of a whole problem in a plane under steps of a size, s; none in one dimension and
/// where the problem is too large.
pub fn whole_growth<const D: usize>(
    problem: &Discrete<D>,
    settings: &ExplicitSettings,
    step: f64,
) -> Option<f64> {
    if D == 1 {
        return None;
    }
    spectral_radius::growth(&AssembledStep::new(&Body::new(one_point_set(problem))), step, settings)
}

/// The prediction from at most so many cells.
pub fn predict<const D: usize>(
    problem: &Discrete<D>,
    settings: &ExplicitSettings,
    most_cells: usize,
) -> Prediction<D> {
    let limit = |soil: &Material| wave_speeds::combined_limit(soil, problem.grid.cell_size, settings.drag);
    let safe = problem.least_of_soils(limit);
    let problem = &one_point_set(problem);
    let is_narrow = problem.grid.cells[..D - 1].iter().all(|cells| *cells == 1);
    let problem = if problem.soils.len() > 1 {
        // Every cell may be the one that sets the limit.
        problem.clone()
    } else if is_narrow {
        without_middle(problem, most_cells)
    } else {
        corner(problem, (most_cells / 2).min(MOST_ACROSS))
    };
    let assembled = AssembledStep::new(&Body::new(problem));
    let sharp = most_cells > FEW_CELLS;
    let far_below = FAR_BELOW * safe;
    // A column's limit is searched with a stricter tolerance: a mode that grows this slowly does not make it unknown.
    let is_slow = |growth: f64| growth - 1.0 <= FAR_BELOW * SLOW_GROWTH;
    let search = || {
        let limit = spectral_radius::critical_step(&assembled, settings, safe, GROWTH_TOLERANCE, sharp);
        if limit.is_some() {
            return Limit { step: limit, growth: None };
        }
        let growth = |step: f64| spectral_radius::growth(&assembled, step, settings).unwrap_or(f64::NAN);
        let slow = growth(far_below);
        if is_slow(slow) {
            return Limit { step: None, growth: None };
        }
        let rate = FASTER * elementary::ln(slow) / far_below;
        let critical = spectral_radius::step_of_growth(&assembled, settings, safe, rate);
        Limit { step: critical, growth: Some(critical.map_or(slow, growth)) }
    };
    let Limit { step: critical, growth } = if D > 1 && assembled.unknowns() <= spectral_radius::MOST_SQUARED {
        known_or(key_of(&assembled, settings, safe, sharp), search)
    } else {
        search()
    };
    let growing = growth.map(|growth| GrowingMode { step: critical.unwrap_or(far_below), growth });
    Prediction {
        critical_step: critical.unwrap_or(safe),
        growing,
        is_bounded: critical.is_some() && growing.is_none(),
        assembled,
        settings: *settings,
    }
}

/// The problem with one point set, that of the phase with more points: equal point sets have the limit of one, and unequal
/// ones a limit between those of one point set with the points of either. Where points move, the cells press with their
/// constant pressure, and have the limit of that.
pub(crate) fn one_point_set<const D: usize>(problem: &Discrete<D>) -> Discrete<D> {
    let mut single = problem.clone();
    // Forces from outside do not change the limit.
    single.forcing = None;
    let moves = single.configuration.moves_points();
    if single.water.is_some() && moves && single.method.pressure == PressureIntegration::Sri {
        single.method.recovery = Recovery::Constant;
    }
    if let Some(water) = single.water.take().filter(|water| water.len() > single.points.len()) {
        single.points = water;
    }
    single
}

/// The problem on so many cells of its lower corner, with the load on their top: the sides stay fixed, the top stays
/// free.
fn corner<const D: usize>(problem: &Discrete<D>, most: usize) -> Discrete<D> {
    let mut cut = problem.clone();
    let extent = most as f64 * problem.grid.cell_size;
    let is_kept = |point: &usize| problem.points.position[*point].iter().all(|place| *place < extent);
    let keep: Vec<usize> = (0..cut.points.len()).filter(is_kept).collect();
    if keep.len() < cut.points.len() {
        cut.points = cut.points.select(&keep);
        let mut cells = problem.grid.cells;
        for across in &mut cells[..D - 1] {
            *across = (*across).min(most);
        }
        cut.grid = Grid::new(problem.grid.cell_size, cells);
    }
    cut
}

/// The problem without the surplus cells of its middle: base and surface, where it is special, stay as they are.
fn without_middle<const D: usize>(problem: &Discrete<D>, most_cells: usize) -> Discrete<D> {
    let up = D - 1;
    let cell_size = problem.grid.cell_size;
    let mut cut = problem.clone();
    let first = problem.grid.cell_of(&[0.0; D])[up];
    let rows: Vec<usize> =
        cut.points.position.iter().map(|place| problem.grid.cell_of(place)[up] - first).collect();
    let cells = rows.iter().max().map_or(0, |top| top + 1);
    if cells <= most_cells {
        return cut;
    }
    let (below, removed) = (most_cells / 2, cells - most_cells);
    let keep: Vec<usize> =
        (0..rows.len()).filter(|point| rows[*point] < below || rows[*point] >= below + removed).collect();
    for point in keep.iter().filter(|point| rows[**point] >= below) {
        let down = removed as f64 * cell_size;
        cut.points.position[*point][up] -= down;
        cut.points.initial_position[*point][up] -= down;
    }
    cut.points = cut.points.select(&keep);
    let mut extent = problem.grid.cells;
    extent[up] -= removed;
    cut.grid = Grid::new(cell_size, extent);
    cut
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::column_problem;
    use oedometer_problem::arrangement::Arrangement;
    use oedometer_problem::method::Method;
    use oedometer_problem::settings::Drag;
    use oedometer_scenes::column::Column;
    use oedometer_scenes::{COSINE_LAYER, LAYERED, Scene, TERZAGHI, XIE_LEO};
    use oedometer_soil::layers::{SoilLayer, SoilLayers};
    use oedometer_soil::material::Material;

    #[test]
    fn a_column_without_its_middle_has_the_limit_of_the_whole() {
        let settings = ExplicitSettings { drag: Drag::Implicit, ..ExplicitSettings::default() };
        for (name, filling) in [("GIMP", 1.0), ("GC-SRI-patch", 1.0), ("GIMP-SRI-patch", 0.1)] {
            let points = Arrangement { filling, ..Arrangement::default() };
            let column = Column { points, ..Column::default() };
            let method = Method::named(name).expect("a known method");
            let problem = column_problem::<1>(&TERZAGHI, &column, &Material::default(), method, 14, 2)
                .expect("the seed column");
            let uncut = predict(&problem, &settings, 14).critical_step;
            let cut = predict(&problem, &settings, FEW_CELLS).critical_step;
            assert!((cut / uncut - 1.0).abs() < 0.01, "{name} {filling}: {cut} for {uncut}");
            let points = without_middle(&problem, FEW_CELLS).points;
            assert_eq!(points.initial_position, points.position, "a column that has not moved");
        }
    }

    #[test]
    fn a_column_of_layers_keeps_its_middle() {
        let layer = SoilLayer { thickness: 0.4, ..SoilLayer::default() };
        let stiff = SoilLayer { thickness: 0.2, youngs_modulus: Some(1e9), ..SoilLayer::default() };
        let column = Column {
            soils: SoilLayers::from_slice(&[layer, stiff, layer]).expect("three"),
            ..Column::default()
        };
        let soft_water = Material { water_bulk_modulus: 2e6, ..Material::default() };
        let method = Method::named("GIMP-SRI").expect("a known method");
        let problem = column_problem::<1>(&LAYERED, &column, &soft_water, method, 16, 2);
        let problem = problem.expect("a column of layers");
        let limit = |most| predict(&problem, &ExplicitSettings::default(), most).critical_step;
        assert_eq!(limit(FEW_CELLS), limit(16));
    }

    #[test]
    fn of_two_point_sets_the_larger_one_gives_the_limit() {
        let method = Method::named("GIMP-SRI").expect("a known method");
        let of = |per_cell| {
            let (column, soil) = (Column::default(), Material::default());
            column_problem::<1>(&TERZAGHI, &column, &soil, method, 4, per_cell).expect("a column")
        };
        for [solid, water] in [[2, 3], [3, 2]] {
            let problem = Discrete { water: Some(of(water).points), ..of(solid) };
            assert_eq!(one_point_set(&problem).points.len(), 12, "{solid} {water}");
        }
    }

    #[test]
    fn cells_of_one_pressure_rate_have_the_limit_of_constant_recovery() {
        let settings = ExplicitSettings { drag: Drag::Implicit, ..ExplicitSettings::default() };
        let limit = |name: &str, scene: &'static Scene, sets: usize| {
            let points = Arrangement { sets, ..Arrangement::default() };
            let column = Column { points, load: 2e5, ..Column::default() };
            let law = (scene.soil)().law;
            let soil = Material { law, ..Material::default() };
            let method = Method::named(name).expect("a known method");
            let problem = column_problem::<1>(scene, &column, &soil, method, 8, 4).expect("a column");
            predicted_critical_step(&problem, &settings)
        };
        let moving = |name, layers| limit(name, &XIE_LEO, layers);
        assert_eq!(moving("GIMP-SRI-patch", 2), moving("GIMP-SRI", 1));
        assert!(moving("GIMP-SRI-patch", 1) > 1.04 * moving("GIMP-SRI", 1));
        let frozen = |name, layers| limit(name, &TERZAGHI, layers);
        assert_eq!(frozen("GIMP-SRI-patch", 2), frozen("GIMP-SRI-patch", 1));
    }

    #[test]
    fn a_mode_stays_small_while_it_grows_by_less_than_a_hundred_times() {
        // ln 100/r = 0.921 s at r = 5 1/s.
        let mode = GrowingMode { step: 2e-3, growth: 0.01_f64.exp() };
        for (seconds, is_small) in [(0.0, true), (0.921, true), (0.922, false), (1e3, false)] {
            assert_eq!(mode.stays_small_for(seconds), is_small, "{seconds} s");
        }
        let unknown = GrowingMode { growth: f64::NAN, ..mode };
        assert!(!unknown.stays_small_for(1e-9), "no number is no small growth");
    }

    #[test]
    fn where_a_mode_grows_under_any_step_the_critical_one_makes_nothing_grow_much_faster() {
        let settings = ExplicitSettings { drag: Drag::Implicit, ..ExplicitSettings::default() };
        let method = Method::named("GC-SRI-patch").expect("a known method");
        // With more drag the growth rises with the step, and ends it before the waves do.
        for (conductivity, ends_early) in [(0.1, false), (0.01, true)] {
            let soil = Material { hydraulic_conductivity: conductivity, ..Material::default() };
            let problem =
                column_problem::<2>(&COSINE_LAYER, &Column::layer(), &soil, method, 6, 2).expect("a layer");
            let prediction = predict(&problem, &settings, FEW_CELLS);
            let mode = prediction.growing.expect("patch rates grow with little drag");
            let rate = |step: f64| (prediction.growth(step).expect("a small plane")).ln() / step;
            let safe = wave_speeds::combined_limit(&soil, problem.grid.cell_size, settings.drag);
            let most = 2.0 * rate(0.1 * safe);
            assert!(most > 0.0 && rate(mode.step) <= most * (1.0 + 1e-6), "{conductivity}");
            assert_eq!(
                [Some(mode.growth), Some(mode.step)],
                [prediction.growth(mode.step), Some(prediction.critical_step)]
            );
            assert_eq!(mode.step < safe, ends_early, "{conductivity}");
            let beyond = if ends_early { 1.02 } else { 4.0 };
            assert!(rate(beyond * mode.step) > most, "{conductivity}: beyond the limit");
        }
    }

    #[test]
    fn the_message_of_a_growing_mode_gives_its_growth_per_second() {
        let sentence = GrowingMode { step: 2e-3, growth: 1.5 }.to_string();
        let wanted = "no limit is known: even with steps of 2.00e-3 s a mode grows by 2.50e2 1/s, from the \
                      eigenvalues of the step";
        assert_eq!(sentence, wanted);
    }
}
