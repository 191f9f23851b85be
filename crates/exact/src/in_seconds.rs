//! Adapts solutions in seconds to time factors and relative depths.

use crate::exact_error::{ExactError, checked_depth, checked_time_factor};
use crate::field_values::{Accuracy, FieldValues};
use crate::layered::LayeredColumn;
use crate::parameters::ColumnParameters;
use crate::yield_front::YieldFront;

/// A column by time factor and depth; time factors are those of the soil of the column.
#[derive(Clone, Debug)]
pub struct ColumnInSeconds {
    column: Column,
    height: f64,
    /// Seconds per unit of the time factor.
    seconds: f64,
    /// Effective stress of the start, compression positive, Pa.
    uniform_stress: f64,
}

#[derive(Clone, Debug)]
enum Column {
    Layered(LayeredColumn),
    YieldFront(Box<YieldFront>),
    /// Undrained for ever: pressure, Pa, and share of the height that it gets shorter by.
    Sealed {
        pressure: f64,
        effective_stress: f64,
        strain: f64,
    },
}

impl ColumnInSeconds {
    fn of(parameters: &ColumnParameters, column: Column) -> Self {
        Self {
            column,
            height: parameters.height,
            seconds: parameters.time(1.0),
            uniform_stress: parameters.uniform_stress,
        }
    }

    /// A column of layers; of one where it has none.
    ///
    /// # Errors
    /// When a parameter is impossible, or the layers do not fill the column.
    pub fn layered(parameters: &ColumnParameters) -> Result<Self, ExactError> {
        parameters.validate()?;
        let height = parameters.height;
        if let Some(sum) = parameters.soils.misses(height) {
            return Err(ExactError::LayersDoNotFill { sum, height });
        }
        let soil = parameters.soil;
        let mut layers = Vec::with_capacity(parameters.soils.len().max(1));
        for layer in parameters.soils.iter() {
            let soil = layer.soil(&soil);
            ColumnParameters { soil, ..*parameters }.validate()?;
            layers.push((layer.thickness, soil));
        }
        if layers.is_empty() {
            layers.push((height, soil));
        }
        Ok(Self::of(parameters, Column::Layered(LayeredColumn::new(parameters.load, &layers)?)))
    }

    /// A column into which a yield front runs.
    ///
    /// # Errors
    /// When a parameter is impossible, or no front runs.
    pub fn yield_front(parameters: &ColumnParameters) -> Result<Self, ExactError> {
        Ok(Self::of(parameters, Column::YieldFront(Box::new(YieldFront::new(parameters)?))))
    }

    /// A column that no water leaves: `p = q/(1 + n E_oed/K_w)` for ever.
    ///
    /// # Errors
    /// When a parameter is impossible.
    pub fn sealed(parameters: &ColumnParameters) -> Result<Self, ExactError> {
        parameters.validate()?;
        let share = parameters.immediate_ratio();
        let column = Column::Sealed {
            pressure: parameters.load * parameters.storage_ratio(),
            effective_stress: -parameters.load * share,
            strain: parameters.load * share / parameters.soil.oedometric_modulus(),
        };
        Ok(Self::of(parameters, column))
    }

    /// Pressure, effective stress and displacement at the relative depth `zeta`.
    ///
    /// # Errors
    /// When `time_factor` is negative or not finite, or `zeta` outside [0, 1].
    pub fn fields(&self, time_factor: f64, zeta: f64) -> Result<FieldValues, ExactError> {
        let seconds = checked_time_factor(time_factor)? * self.seconds;
        let zeta = checked_depth(zeta)?;
        match &self.column {
            Column::Layered(column) => column.fields(seconds, (1.0 - zeta) * self.height),
            Column::YieldFront(front) => {
                // Counted from the stress of the start.
                let fields = front.fields(seconds, zeta)?;
                let effective_stress = fields.effective_stress + self.uniform_stress;
                Ok(FieldValues { effective_stress, ..fields })
            }
            Column::Sealed { pressure, effective_stress, strain } => Ok(FieldValues {
                pressure: *pressure,
                effective_stress: *effective_stress,
                displacement: -strain * (1.0 - zeta) * self.height,
            }),
        }
    }

    /// Settlement of the surface, downward positive, m.
    ///
    /// # Errors
    /// When `time_factor` is negative or not finite.
    pub fn settlement(&self, time_factor: f64) -> Result<f64, ExactError> {
        let seconds = checked_time_factor(time_factor)? * self.seconds;
        match &self.column {
            Column::Layered(column) => column.settlement(seconds),
            Column::YieldFront(front) => front.settlement(seconds),
            Column::Sealed { strain, .. } => Ok(strain * self.height),
        }
    }

    /// Settlement of the column when all excess pressure is gone, m. The solution of a front is that of a half-space,
    /// which settles without end.
    pub fn final_settlement(&self) -> f64 {
        match &self.column {
            Column::Layered(column) => column.final_settlement(),
            Column::YieldFront(front) => front.final_settlement(),
            Column::Sealed { strain, .. } => strain * self.height,
        }
    }

    /// Settlement over that of the end.
    ///
    /// # Errors
    /// When `time_factor` is negative or not finite.
    pub fn degree_of_consolidation(&self, time_factor: f64) -> Result<f64, ExactError> {
        Ok(self.settlement(time_factor)? / self.final_settlement())
    }

    /// Terms used at a time factor, and what bounds the pressure's error over the load.
    ///
    /// # Errors
    /// When `time_factor` is negative or not finite.
    pub fn accuracy(&self, time_factor: f64) -> Result<Accuracy, ExactError> {
        let seconds = checked_time_factor(time_factor)? * self.seconds;
        match &self.column {
            Column::Layered(column) => column.accuracy(seconds),
            Column::YieldFront(front) => front.accuracy(seconds),
            Column::Sealed { .. } => Ok(Accuracy::of(1, 0.0)),
        }
    }
}
