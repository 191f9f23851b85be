//! What is measured, and where.

use crate::mpm::run::snapshot::{Samples, Snapshot};
use serde::{Deserialize, Serialize};

/// A measured quantity.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize, schemars::JsonSchema,
)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// Excess pore pressure.
    Pressure,
    /// Vertical effective stress.
    EffectiveStress,
    /// Vertical displacement of the skeleton.
    Displacement,
    /// Settlement of the surface.
    Settlement,
}

impl Quantity {
    /// Every quantity.
    pub const ALL: [Self; 4] = [Self::Pressure, Self::EffectiveStress, Self::Displacement, Self::Settlement];

    /// Name in study files, records and tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Pressure => "pressure",
            Self::EffectiveStress => "effective_stress",
            Self::Displacement => "displacement",
            Self::Settlement => "settlement",
        }
    }

    /// Its field among samples; a settlement is none.
    pub fn field(self, samples: &Samples) -> Option<&[f64]> {
        match self {
            Self::Pressure => Some(&samples.pressure),
            Self::EffectiveStress => Some(&samples.effective_stress),
            Self::Displacement => Some(&samples.displacement),
            Self::Settlement => None,
        }
    }
}

/// Where a quantity is sampled: it decides the order that is seen.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize, schemars::JsonSchema,
)]
#[serde(rename_all = "snake_case")]
pub enum Sample {
    /// At the material points.
    Points,
    /// Means of cells at their centres.
    Centres,
    /// At the nodes.
    Nodes,
    /// At the loaded surface.
    Surface,
}

impl Sample {
    /// Every sample.
    pub const ALL: [Self; 4] = [Self::Points, Self::Centres, Self::Nodes, Self::Surface];

    /// Name in study files, records and tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Points => "points",
            Self::Centres => "centres",
            Self::Nodes => "nodes",
            Self::Surface => "surface",
        }
    }

    /// The samples of a state; the surface has none but its settlement.
    pub fn of(self, snapshot: &Snapshot) -> Option<&Samples> {
        match self {
            Self::Points => Some(&snapshot.points),
            Self::Centres => Some(&snapshot.centres),
            Self::Nodes => Some(&snapshot.nodes),
            Self::Surface => None,
        }
    }
}
