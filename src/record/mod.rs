//! The record of one case: all that judgements, tables and reports are made from.
//!
//! A record is plain data on disk. Tables, plots, verdicts and goldens read records and never a
//! live solver, so that a report can be made again without solving.

pub mod atomic_file;
pub mod calibration;
pub mod csv;
pub mod field_files;
pub mod named_cases;
pub mod pack;
pub mod printed;
pub mod provenance;
pub mod race_errors;
pub mod store;

pub use crate::case::outcome::{AttachedRun, Status, WallSample};
use crate::case::{Case, Norm, Quantity, Sample};
pub use oedometer_problem::critical_step::{CriticalStep, Probe};
use oedometer_problem::outcome::{Counters, Energy, StepSizes};
use oedometer_problem::snapshot::Snapshot;
pub use provenance::{Origins, Provenance};
use serde::{Deserialize, Serialize};
pub use store::{Found, RecordStore};

/// Version of the record's layout.
pub const SCHEMA: u32 = 2;

/// Dimensionless groups that say which theory can hold.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Groups {
    /// `n E_oed/K_w`: share of the water's storage.
    pub storage: f64,
    /// `m_vl q`: finite strain.
    pub finite_strain: f64,
    /// `c_v/(H V)` with the undrained wave's speed `V`: inertia.
    pub inertia: f64,
    /// Largest step over the predicted critical one.
    pub step_over_limit: f64,
}

/// What the start must be, and is.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct StartChecks {
    /// Points there are.
    pub points: usize,
    /// Points there should be: cells times points per cell.
    pub points_expected: usize,
    /// Volume over that of the column, minus one.
    pub volume_error: f64,
    /// Mean pore pressure at the start over `q/(1 + n E_oed/K_w)`, minus one; for a scene without
    /// load over its own start.
    pub undrained_pressure_error: f64,
    /// Largest unbalanced nodal force of the start over the load.
    pub unbalanced_force: f64,
}

/// Balances at one output.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Balance {
    /// Time factor.
    pub time_factor: f64,
    /// Mass of the grains on the grid over its start, minus one.
    pub solid_mass_drift: f64,
    /// Water that left less the loss of pore space and the water's expansion, over what the load presses
    /// out in the end, `m_v q H`.
    pub water_imbalance: f64,
    /// Sum of internal forces over the sum of their sizes.
    pub internal_force_imbalance: f64,
    /// Root mean square of `(σ' − p + q)/q` over the points.
    pub equilibrium_residual: f64,
    /// Distance of the settlement at this output from the settlement curve, over the final
    /// settlement, beyond what interpolation between the curve's rows explains.
    pub settlement_curve_gap: f64,
    /// Largest nodal velocity of either phase over the hydraulic conductivity, what flows under a unit gradient,
    /// in a scene in which nothing may move.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spurious_velocity: Option<f64>,
    /// Pores and water, where two point sets move.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub layers: Option<LayerBalance>,
}

/// Pores and water of two point sets at one output.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct LayerBalance {
    /// Water there is in the soil over the pores there are, minus one: an identity with one point set, and with two the
    /// detector of a wrong continuity.
    pub pore_water: f64,
    /// Share of the water's mass that has left the soil.
    pub water_left: f64,
    /// That share less `s/(n_0 H)`, which it is where grains and water are incompressible.
    pub water_left_error: f64,
    /// Water points that are in the soil still.
    pub water_points: usize,
    /// Largest size of the pressure of any water point since the start, between outputs too, over the load: what has
    /// burst and rung down again by an output is seen here.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub largest_pressure: Option<f64>,
}

/// A quantity that is measured beside errors of fields, with its exact value.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct MeasureRow {
    /// Name, a word of the field.
    pub name: String,
    /// Time factor of the output; none where it is of the whole run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub time_factor: Option<f64>,
    /// Reference that it is compared with.
    pub reference: ReferenceName,
    /// Value of the run.
    pub found: f64,
    /// Exact value.
    pub exact: f64,
}

impl MeasureRow {
    /// Its fields in the order of [`ERROR_COLUMNS`]: a value of the surface, and no error.
    pub fn csv_fields(&self) -> [String; 6] {
        let time_factor = self.time_factor.map_or(String::new(), |factor| factor.to_string());
        let [surface, value] = ["surface", "value"].map(str::to_owned);
        [
            time_factor,
            self.name.clone(),
            surface,
            value,
            self.reference.clone(),
            format!("{:.16e}", self.found),
        ]
    }

    /// Error, relative where the exact value is not zero.
    pub fn error(&self) -> f64 {
        if self.exact == 0.0 { self.found } else { self.found / self.exact - 1.0 }
    }
}

/// One measured error.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct ErrorRow {
    /// Time factor.
    pub time_factor: f64,
    /// What.
    pub quantity: Quantity,
    /// Where.
    pub sample: Sample,
    /// In which norm.
    pub norm: Norm,
    /// Reference.
    pub reference: ReferenceName,
    /// Relative error; settlement with its sign.
    pub value: f64,
    /// Absolute error over the load, or over the final settlement.
    pub absolute: f64,
}

/// Columns of the errors in the CSV of `solve` and `score`.
pub const ERROR_COLUMNS: [&str; 6] = ["time_factor", "quantity", "sample", "norm", "reference", "value"];

impl ErrorRow {
    /// Its fields in the order of `ERROR_COLUMNS`.
    pub fn csv_fields(&self) -> [String; 6] {
        [
            self.time_factor.to_string(),
            self.quantity.name().to_owned(),
            self.sample.name().to_owned(),
            self.norm.name().to_owned(),
            self.reference.clone(),
            format!("{:.16e}", self.value),
        ]
    }
}

/// A reference by its name: records outlive the enumeration.
pub type ReferenceName = String;

/// Settlement over time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct HistoryRow {
    /// Time factor.
    pub time_factor: f64,
    /// Settlement over the final settlement of the scene's own reference.
    pub degree_of_consolidation: f64,
    /// Load of a footing over its width and the strength of the soil.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub load_factor: Option<f64>,
    /// Energy, where waves run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub energy: Option<Energy>,
}

/// How far a reference itself can be trusted.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct ReferenceUse {
    /// Name.
    pub name: ReferenceName,
    /// Most terms used at any output.
    pub terms: usize,
    /// Largest tail bound at any output, over the load.
    pub tail_bound: f64,
    /// The bound at each output, where outputs differ in it by more than round-off.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub tail_bounds: Vec<f64>,
    /// Why it does not hold for the case, where it does not: then no error is computed from it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub does_not_hold: Option<String>,
}

impl ReferenceUse {
    /// The bound at an output of a case, over the load.
    pub fn bound_at(&self, case: &Case, time_factor: f64) -> f64 {
        let place = case.time_factors.iter().position(|time| *time == time_factor);
        place.and_then(|place| self.tail_bounds.get(place)).copied().unwrap_or(self.tail_bound)
    }
}

/// Everything known of one case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Record {
    /// Version of this layout.
    pub schema: u32,
    /// Identity of the case.
    pub hash: String,
    /// All inputs.
    pub case: Case,
    /// How it ended.
    pub status: Status,
    /// Work done.
    pub counters: Counters,
    /// Step sizes, s.
    pub step_sizes: StepSizes,
    /// Wall times, all of them: kept beside the record and not in it, for they change from day to
    /// day and the record does not.
    #[serde(skip)]
    pub wall: Vec<WallSample>,
    /// The critical step, where that was the question.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stability: Option<CriticalStep>,
    /// Dimensionless groups.
    pub groups: Groups,
    /// Start checks, where the start was reached.
    pub start: Option<StartChecks>,
    /// Balances at each output.
    pub balance: Vec<Balance>,
    /// Errors with each reference of the scene.
    pub errors: Vec<ErrorRow>,
    /// What is measured beside errors of fields: peaks, and what moves where nothing may.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub measures: Vec<MeasureRow>,
    /// Settlement over time.
    pub history: Vec<HistoryRow>,
    /// References used.
    pub references: Vec<ReferenceUse>,
    /// State at each output.
    pub snapshots: Vec<Snapshot>,
    /// What is known of the run of another program.
    #[serde(default, skip_serializing_if = "Option::is_none", rename = "attached")]
    pub outside: Option<AttachedRun>,
    /// What made this record.
    pub provenance: Provenance,
    /// Hash over all the text before it, on disk only: a record with another one was damaged.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub digest: String,
}

impl Record {
    /// The record of a text, its seal with it.
    ///
    /// # Errors
    /// What the text does not have of a record.
    pub fn from_json(text: &str) -> serde_json::Result<Self> {
        serde_json::from_str(text)
    }

    /// The error of a quantity, where it was measured.
    pub fn error(
        &self,
        quantity: Quantity,
        sample: Sample,
        norm: Norm,
        reference: &str,
        time_factor: f64,
    ) -> Option<&ErrorRow> {
        self.errors.iter().find(|row| {
            row.quantity == quantity
                && row.sample == sample
                && row.norm == norm
                && row.reference == reference
                && row.time_factor == time_factor
        })
    }

    /// The state at the output of a time factor, where the run came to it.
    pub fn snapshot(&self, time_factor: f64) -> Option<&Snapshot> {
        let index = self.case.time_factors.iter().position(|factor| *factor == time_factor)?;
        self.snapshots.get(index)
    }

    /// The same, made by a run outside of this program.
    #[must_use]
    pub fn made_outside(self, run: AttachedRun) -> Self {
        Self { outside: Some(run), ..self }
    }

    /// What is known of the run outside of this program that made it.
    pub fn outside_run(&self) -> Option<&AttachedRun> {
        self.outside.as_ref()
    }

    /// Whether this program can make it again from its case, with all that a record leaves out.
    pub fn can_be_made_again(&self) -> bool {
        self.outside.is_none()
    }

    /// Kind of places whose errors stand for the case: the points, or what its solver has instead.
    pub fn main_sample(&self) -> Sample {
        self.outside_run().and_then(|run| run.sample).unwrap_or(Sample::Points)
    }

    /// Wall times of runs that had the machine to themselves, s.
    pub fn wall_alone(&self) -> Vec<f64> {
        self.wall.iter().filter(|sample| sample.alone).map(|sample| sample.seconds).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_record_finds_each_error_by_all_that_names_it_and_each_state_by_its_time() {
        let mut record = crate::campaign::runner::records_of(
            "title = 't'\nscene = 'terzaghi'\noutput.time_factors = [0.1, 0.3]\n[[sweep]]\nmethod = ['MPM']\ncells = [2]\n\
             integrator = ['implicit']\n",
        )
        .remove(0);
        let of = |row: &ErrorRow, record: &Record| {
            record.error(row.quantity, row.sample, row.norm, &row.reference, row.time_factor).cloned()
        };
        let rows = record.errors.clone();
        for row in &rows {
            assert_eq!(of(row, &record).as_ref(), Some(row));
            let mut without = record.clone();
            without.errors.retain(|one| one != row);
            assert_eq!(of(row, &without), None, "none but that one");
        }
        let times = [0.1, 0.3].map(|factor| record.snapshot(factor).expect("an output").time);
        assert!((times[0] - 8.175).abs() < 1e-9 && (times[1] - 24.525).abs() < 1e-9, "{times:?}");
        assert!(record.snapshot(0.2).is_none());
        record.snapshots.pop();
        assert!(record.snapshot(0.1).is_some() && record.snapshot(0.3).is_none(), "it did not come to it");
        assert_eq!(record.main_sample(), Sample::Points);
        record = record.made_outside(AttachedRun { sample: Some(Sample::Nodes), ..AttachedRun::default() });
        assert_eq!(record.main_sample(), Sample::Nodes);
        record = record.made_outside(AttachedRun::default());
        assert_eq!(record.main_sample(), Sample::Points);
    }
}
