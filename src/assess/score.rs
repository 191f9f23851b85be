//! Somebody else's result held against the references of a scene.

use super::class::{Classification, Context};
use super::classify::classify;
use super::measure::{FieldError, resolution, settlement_error};
use super::norms::Norm;
use super::orders::{FinestOrder, finest_order};
use super::places::contributions;
use super::series::{ErrorSeries, Level, Undefined};
use crate::exact::{ColumnParameters, ExactError, Reference, ReferenceKind};
use crate::import::SampledState;
use crate::record::{ErrorRow, Quantity, Sample};

/// Norms of a field's error.
/// Share of the height within which a sample counts as the surface.
const SURFACE: f64 = 1e-6;
/// Errors up to this are round-off of a written number.
const ROUND_OFF: f64 = 1e-12;

/// The place that carries most of a field's error.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct WorstPlace {
    /// Time factor.
    pub time_factor: f64,
    /// What.
    pub quantity: Quantity,
    /// Initial depth over the height.
    pub zeta: f64,
    /// What the result has there.
    pub computed: f64,
    /// What the first reference has there.
    pub exact: f64,
    /// Its share of the squared L2 error.
    pub share: f64,
}

/// A result with its errors.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Score {
    /// Samples at each time factor.
    pub samples: Vec<(f64, usize)>,
    /// Errors against every reference.
    pub errors: Vec<ErrorRow>,
    /// Worst places against the first reference.
    pub worst: Vec<WorstPlace>,
    /// What has no relative error, for the exact value is zero or below round-off.
    pub unresolved: Vec<Unresolved>,
}

/// A quantity that cannot be held against a reference at a time.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Unresolved {
    /// Time factor.
    pub time_factor: f64,
    /// What.
    pub quantity: Quantity,
    /// Where.
    pub sample: Sample,
    /// Which reference.
    pub reference: String,
}

/// Holds states against references.
///
/// # Errors
/// When a reference refuses the column or a time.
pub fn score(
    parameters: &ColumnParameters,
    references: &[ReferenceKind],
    states: &[SampledState],
    sample: Sample,
) -> Result<Score, ExactError> {
    let times: Vec<f64> = states.iter().map(|state| parameters.time_factor(state.time)).collect();
    let references: Vec<Reference> =
        references.iter().map(|kind| Reference::new(*kind, parameters, &times)).collect::<Result<_, _>>()?;
    let mut score =
        Score { samples: Vec::new(), errors: Vec::new(), worst: Vec::new(), unresolved: Vec::new() };
    for (state, time_factor) in states.iter().zip(times) {
        score.samples.push((time_factor, state.initial_height.len()));
        for (place, reference) in references.iter().enumerate() {
            score.add(parameters, reference, state, time_factor, sample, place == 0)?;
        }
    }
    Ok(score)
}

impl Score {
    /// Adds the errors of one state against one reference.
    fn add(
        &mut self,
        parameters: &ColumnParameters,
        reference: &Reference,
        state: &SampledState,
        time_factor: f64,
        sample: Sample,
        first: bool,
    ) -> Result<(), ExactError> {
        let zeta = |height: f64| (1.0 - height / parameters.height).clamp(0.0, 1.0);
        let exact = state
            .initial_height
            .iter()
            .map(|height| reference.fields(time_factor, zeta(*height)))
            .collect::<Result<Vec<_>, _>>()?;
        let settled = parameters.final_settlement();
        let fields = [
            (
                Quantity::Pressure,
                &state.pressure,
                parameters.load,
                exact.iter().map(|f| f.pressure).collect(),
            ),
            (
                Quantity::EffectiveStress,
                &state.effective_stress,
                parameters.load,
                exact.iter().map(|f| f.effective_stress).collect(),
            ),
            (
                Quantity::Displacement,
                &state.displacement,
                settled,
                exact.iter().map(|f| f.displacement).collect::<Vec<f64>>(),
            ),
        ];
        for (quantity, computed, scale, exact) in &fields {
            if computed.is_empty() {
                continue;
            }
            let field = FieldError {
                time_factor,
                quantity: *quantity,
                sample,
                reference: reference.name(),
                scale: *scale,
                resolution: resolution(reference, time_factor),
            };
            let known = self.errors.len();
            self.errors.extend(field.rows(computed, exact, &state.volume));
            if self.errors.len() == known {
                let reference = reference.name().to_owned();
                self.unresolved.push(Unresolved { time_factor, quantity: *quantity, sample, reference });
            }
            let worst = contributions(computed, exact, &state.volume).first().copied();
            if let Some(worst) = worst.filter(|_| first) {
                self.worst.push(WorstPlace {
                    time_factor,
                    quantity: *quantity,
                    zeta: zeta(state.initial_height[worst.index]),
                    computed: computed[worst.index],
                    exact: exact[worst.index],
                    share: worst.share,
                });
            }
        }
        let surface = state
            .initial_height
            .iter()
            .position(|height| *height > (1.0 - SURFACE) * parameters.height)
            .and_then(|place| state.displacement.get(place));
        if let Some(displacement) = surface {
            match settlement_error(reference, time_factor, -displacement, settled)? {
                Some(row) => self.errors.push(row),
                None => self.unresolved.push(Unresolved {
                    time_factor,
                    quantity: Quantity::Settlement,
                    sample: Sample::Surface,
                    reference: reference.name().to_owned(),
                }),
            }
        }
        Ok(())
    }

    /// The error of a kind, where it is defined.
    pub fn error(&self, like: &ErrorRow) -> Option<&ErrorRow> {
        self.errors.iter().find(|row| {
            (row.quantity, row.sample, row.norm, &row.reference)
                == (like.quantity, like.sample, like.norm, &like.reference)
                && (row.time_factor - like.time_factor).abs() <= 1e-9 * like.time_factor.abs()
        })
    }
}

/// A series of one error over results on finer and finer meshes, with its class.
#[derive(Clone, Debug)]
pub struct ScoredSeries {
    /// What the errors are of; its value is that on the coarsest mesh.
    pub measure: ErrorRow,
    /// Cell sizes, m, and errors.
    pub series: ErrorSeries,
    /// Order on the finest window.
    pub finest: Result<FinestOrder, Undefined>,
    /// Class with its reason.
    pub classification: Classification,
}

/// The series over results with numbers of cells over the height, the main norm of each quantity.
/// An error that a level lacks leaves a hole, and a series with a hole is not evaluable.
pub fn series_of(levels: &[(usize, Score)], height: f64) -> Vec<ScoredSeries> {
    let Some((_, first)) = levels.iter().min_by_key(|(cells, _)| *cells) else { return Vec::new() };
    let main = |row: &&ErrorRow| matches!(row.norm, Norm::L2 | Norm::Relative);
    let series = first.errors.iter().filter(main).map(|measure| {
        let level = |(cells, score): &(usize, Score)| Level {
            size: height / *cells as f64,
            error: score.error(measure).map(|row| row.value.abs()),
        };
        let series = ErrorSeries::new(levels.iter().map(level).collect());
        // A settlement's error has a sign; levels are put from coarse to fine as the series is.
        let mut signed: Vec<(usize, f64)> = match measure.norm {
            Norm::Relative => {
                let value = |(cells, score): &(usize, Score)| Some((*cells, score.error(measure)?.value));
                levels.iter().filter_map(value).collect()
            }
            _ => Vec::new(),
        };
        signed.sort_by_key(|(cells, _)| *cells);
        let signed = signed.into_iter().map(|(_, value)| value).collect();
        let context = Context { round_off: Some(ROUND_OFF), signed, ..Context::default() };
        ScoredSeries {
            measure: measure.clone(),
            finest: finest_order(&series),
            classification: classify(&series, &context),
            series,
        }
    });
    series.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assess::class::Class;

    /// The exact fields on places, the pressure off by `error(ζ)`.
    fn state(places: usize, time_factor: f64, error: impl Fn(f64) -> f64) -> SampledState {
        let column = ColumnParameters::default();
        let reference = Reference::new(ReferenceKind::Terzaghi, &column, &[]).expect("the seed column");
        let mut state = SampledState { time: column.time(time_factor), ..SampledState::default() };
        for place in 0..=places {
            let zeta = 1.0 - place as f64 / places as f64;
            let fields = reference.fields(time_factor, zeta).expect("inside");
            state.initial_height.push(1.0 - zeta);
            state.volume.push(1.0);
            state.pressure.push(fields.pressure + error(zeta));
            state.displacement.push(fields.displacement);
        }
        state
    }

    fn scored(states: &[SampledState]) -> Score {
        score(&ColumnParameters::default(), &[ReferenceKind::Terzaghi], states, Sample::Nodes)
            .expect("a score")
    }

    #[test]
    fn the_exact_solution_scores_round_off_and_a_wrong_place_is_named() {
        let clean = scored(&[state(20, 0.1, |_| 0.0)]);
        assert!(clean.errors.iter().all(|row| row.value.abs() < 1e-9), "{clean:?}");
        assert!(clean.errors.iter().any(|row| row.quantity == Quantity::Settlement));
        assert!(clean.errors.iter().all(|row| row.quantity != Quantity::EffectiveStress), "no such column");
        let off = scored(&[state(20, 0.1, |zeta| if (zeta - 0.25).abs() < 0.01 { 0.1 } else { 0.0 })]);
        assert!((off.worst[0].zeta - 0.25).abs() < 1e-12 && off.worst[0].share > 0.999_999);
    }

    #[test]
    fn what_the_reference_does_not_resolve_is_listed_and_has_no_error() {
        let late = scored(&[state(20, 50.0, |_| 1e-13)]);
        assert!(late.errors.iter().all(|row| row.quantity != Quantity::Pressure), "{:?}", late.errors);
        let pressure: Vec<_> = late.unresolved.iter().map(|one| (one.quantity, one.time_factor)).collect();
        assert_eq!(pressure.len(), 1);
        assert_eq!(pressure[0].0, Quantity::Pressure);
        assert!((pressure[0].1 - 50.0).abs() < 1e-9);
        assert_eq!(scored(&[state(20, 0.1, |_| 0.0)]).unresolved, []);
    }

    #[test]
    fn results_on_finer_meshes_have_an_order_and_a_missing_time_none() {
        let level = |cells: usize| {
            let error = (cells as f64).powi(-2);
            (cells, scored(&[state(4 * cells, 0.1, |_| error)]))
        };
        let levels: Vec<_> = [10, 20, 40].into_iter().map(level).collect();
        let series = series_of(&levels, 1.0);
        let pressure = &series[0];
        assert_eq!(pressure.classification.class, Class::Asymptotic, "{:?}", pressure.classification);
        assert!((pressure.classification.order.expect("an order") - 2.0).abs() < 0.05);
        let holes = [levels[0].clone(), levels[1].clone(), (40, scored(&[state(160, 0.2, |_| 0.0)]))];
        let series = series_of(&holes, 1.0);
        assert_eq!(series[0].classification.class, Class::NotEvaluable);
    }
}
