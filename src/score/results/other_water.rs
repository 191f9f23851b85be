//! Errors that do not converge against a reference, and do against that of water of the other kind.

use crate::score::results::Results;
use crate::score::score_series::{ScoredSeries, series_of};
use crate::score::{Score, score};
use oedometer_convergence::Class;
use oedometer_exact::{ExactError, ReferenceKind};
use oedometer_wording::{count_of, rounded};

/// Share of its error on the finest mesh that a series has left against the right reference, at most.
const LEFT: f64 = 0.5;

/// The reference with compressible water for that with incompressible water, and the other way round.
fn with_other_water(kind: ReferenceKind) -> Option<ReferenceKind> {
    use ReferenceKind::{CosineLayer, CosineLayerIncompressible, Terzaghi, TerzaghiIncompressible};
    match kind {
        Terzaghi => Some(TerzaghiIncompressible),
        TerzaghiIncompressible => Some(Terzaghi),
        CosineLayer => Some(CosineLayerIncompressible),
        CosineLayerIncompressible => Some(CosineLayer),
        _ => None,
    }
}

impl Results<'_> {
    /// Adds to the diagnosis of the finest mesh that the other water explains the series, where it explains all that do not
    /// converge and nothing else was found.
    ///
    /// # Errors
    /// When the other reference refuses the column.
    pub fn diagnose_water(&mut self, series: &[ScoredSeries]) -> Result<(), ExactError> {
        let Some(declared) = self.comparison.references.first().copied() else { return Ok(()) };
        let Some(finest) = self.order.last().copied() else { return Ok(()) };
        if let Some(other) = with_other_water(declared)
            && self.all[finest].score.diagnosis.is_empty()
        {
            let sentence = self.explained_by(declared, other, series)?;
            self.all[finest].score.diagnosis.extend(sentence);
        }
        Ok(())
    }

    /// The sentence about a reference that explains what another one does not.
    fn explained_by(
        &self,
        own: ReferenceKind,
        other: ReferenceKind,
        series: &[ScoredSeries],
    ) -> Result<Option<String>, ExactError> {
        let converges =
            |series: &ScoredSeries| matches!(series.classification.class, Class::Asymptotic | Class::Exact);
        let of_own: Vec<&ScoredSeries> =
            series.iter().filter(|series| series.measure.reference == own.name()).collect();
        let open: Vec<&ScoredSeries> = of_own.iter().copied().filter(|series| !converges(series)).collect();
        if open.is_empty() {
            return Ok(None);
        }
        let comparison = self.comparison;
        let of_place = |place: &usize| {
            let run = &self.all[*place].run;
            let scored = score(&comparison.parameters, &[other], &run.states, comparison.mapping.sample)?;
            Ok((run.cells.unwrap_or_default(), scored))
        };
        let scores = self.order.iter().map(of_place).collect::<Result<Vec<(usize, Score)>, ExactError>>()?;
        let levels: Vec<(usize, &Score)> = scores.iter().map(|(cells, score)| (*cells, score)).collect();
        let others = series_of(&levels, &self.times, comparison.case.column.height);
        let finest = |series: &ScoredSeries| series.series.levels().last().and_then(|level| level.error);
        let explained = open.iter().map(|series| {
            let what = |series: &ScoredSeries| {
                let of = &series.measure;
                (series.group, of.quantity, of.sample, of.norm)
            };
            let twin = others.iter().find(|twin| what(twin) == what(series))?;
            let is_smaller = finest(twin)? <= LEFT * finest(series)?;
            (converges(twin) && is_smaller).then_some(twin)
        });
        let Some(explained) = explained.collect::<Option<Vec<&ScoredSeries>>>() else { return Ok(None) };
        let Some((first, order)) =
            explained.iter().find_map(|series| Some((series, series.classification.order?)))
        else {
            return Ok(None);
        };
        let asked = match other {
            ReferenceKind::TerzaghiIncompressible | ReferenceKind::CosineLayerIncompressible => {
                "is the water of your solver incompressible, n/K_w = 0?"
            }
            _ => "is the water of your solver compressible, n/K_w > 0?",
        };
        Ok(Some(format!(
            "{} of {} not converge against `{own}`, and all do against `{other}` ({} at T_v = {} at order {order:.2}): {asked} \
             Then `--reference {other}` is the right one",
            open.len(),
            count_of(of_own.len(), "series does", "series do"),
            first.measure.quantity.name(),
            rounded(first.measure.time_factor),
        )))
    }
}
