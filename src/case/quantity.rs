//! Measured quantities and the places where they are sampled.

use oedometer_mpm::run::results::snapshot::{Samples, Snapshot};
use oedometer_soil::wording::words;

/// A measured quantity.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Quantity {
    /// Excess pore pressure.
    #[default]
    Pressure,
    /// Vertical effective stress.
    EffectiveStress,
    /// Vertical displacement of the skeleton.
    Displacement,
    /// Settlement of the surface.
    Settlement,
    /// Load of a footing over its width and the strength of the soil.
    LoadFactor,
}

words!(
    Quantity:
    Pressure "pressure", EffectiveStress "effective_stress", Displacement "displacement",
    Settlement "settlement", LoadFactor "load_factor",
);

impl Quantity {
    /// Whether it is one number, of the surface.
    pub fn is_of_surface(self) -> bool {
        matches!(self, Self::Settlement | Self::LoadFactor)
    }

    /// Its field among samples; `None` for what is of the surface.
    pub fn field(self, samples: &Samples) -> Option<&[f64]> {
        match self {
            Self::Pressure => Some(&samples.pressure),
            Self::EffectiveStress => Some(&samples.effective_stress),
            Self::Displacement => Some(&samples.displacement),
            Self::Settlement | Self::LoadFactor => None,
        }
    }
}

/// Where a quantity is sampled: it decides the order that is seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
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

words!(Sample: Points "points", Centres "centres", Nodes "nodes", Surface "surface");

impl Sample {
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
