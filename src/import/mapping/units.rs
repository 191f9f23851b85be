//! Units, signs and origins of columns in the words of a mapping file.

use crate::wording::words;

use serde::Deserialize;

/// A unit of time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum TimeUnit {
    /// Second.
    #[default]
    S,
    /// Minute.
    Min,
    /// Hour.
    H,
    /// Day.
    D,
    /// Year of 365.25 days.
    A,
    /// Time factor `T_v`.
    TimeFactor,
}

/// A unit of length.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, schemars::JsonSchema)]
pub enum LengthUnit {
    /// Metre.
    #[default]
    #[serde(rename = "m")]
    Metre,
    /// Centimetre.
    #[serde(rename = "cm")]
    Centimetre,
    /// Millimetre.
    #[serde(rename = "mm")]
    Millimetre,
}

/// A unit of stress.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, schemars::JsonSchema)]
pub enum StressUnit {
    /// Pascal.
    #[serde(rename = "Pa")]
    Pascal,
    /// Kilopascal.
    #[serde(rename = "kPa")]
    Kilopascal,
    /// Megapascal.
    #[serde(rename = "MPa")]
    Megapascal,
}

/// A vertical direction.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum VerticalSense {
    /// Against gravity.
    #[default]
    Up,
    /// With gravity.
    Down,
}

/// A horizontal direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum HorizontalSense {
    /// Away from the scene's `x = 0`: the crest of a layer's load.
    Right,
    /// Towards it.
    Left,
}

/// Which stress counts as positive.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum StressSign {
    /// Soil mechanics.
    CompressionPositive,
    /// Continuum mechanics.
    TensionPositive,
}

/// A configuration.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum StatedPlace {
    /// Places before the load came.
    #[default]
    Reference,
    /// Places at the time of the row.
    Current,
}

words!(TimeUnit: S "s", Min "min", H "h", D "d", A "a", TimeFactor "time-factor");

impl TimeUnit {
    /// Seconds of a time in this unit, with the seconds of `T_v = 1`.
    pub fn seconds(self, time: f64, seconds_per_time_factor: f64) -> f64 {
        time * match self {
            Self::S => 1.0,
            Self::Min => 60.0,
            Self::H => 3600.0,
            Self::D => 86_400.0,
            Self::A => 365.25 * 86_400.0,
            Self::TimeFactor => seconds_per_time_factor,
        }
    }
}

words!(LengthUnit: Metre "m", Centimetre "cm", Millimetre "mm");

impl LengthUnit {
    /// Metres of one.
    pub fn metres(self) -> f64 {
        match self {
            Self::Metre => 1.0,
            Self::Centimetre => 1e-2,
            Self::Millimetre => 1e-3,
        }
    }
}

words!(StressUnit: Pascal "Pa", Kilopascal "kPa", Megapascal "MPa");

impl StressUnit {
    /// Pascals of one.
    pub fn pascals(self) -> f64 {
        match self {
            Self::Pascal => 1.0,
            Self::Kilopascal => 1e3,
            Self::Megapascal => 1e6,
        }
    }
}
