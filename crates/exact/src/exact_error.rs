//! Errors of the exact solutions, as sentences.

use oedometer_wording::typed;
use thiserror::Error;

/// Why an exact solution gives no number.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ExactError {
    /// A quantity that must be positive is zero, negative or not finite.
    #[error("the {quantity} must be positive and finite, got {}", typed(*value))]
    NotPositive {
        /// Name of the quantity.
        quantity: &'static str,
        /// Value that was given.
        value: f64,
    },
    /// Porosity outside the open interval (0, 1).
    #[error("the porosity must lie between 0 and 1, got {0}")]
    Porosity(f64),
    /// Poisson's ratio outside (−1, ½).
    #[error("Poisson's ratio must lie between -1 and 0.5, got {0}")]
    PoissonsRatio(f64),
    /// Negative or non-finite time factor.
    #[error("the time factor must be finite and not negative, got {0}")]
    TimeFactor(f64),
    /// Relative depth outside [0, 1].
    #[error("the relative depth must lie between 0 (drained surface) and 1 (base), got {0}")]
    Depth(f64),
    /// Relative distance outside [0, 1].
    #[error("the distance x/a must lie between 0 (middle) and 1 (drained side), got {0}")]
    Distance(f64),
    /// Degree of consolidation outside [0, 1).
    #[error("the degree of consolidation must be at least 0 and below 1, got {0}")]
    Degree(f64),
    /// A name that is no reference.
    #[error("there is no reference named `{0}`")]
    UnknownReference(String),
    /// A load under which large-strain consolidation would end with a negative porosity.
    #[error(
        "the load would expel more water than the pores hold: m_v q = {load} must stay below \
         -ln(1 - n) = {limit} for a porosity of {porosity}"
    )]
    LoadClosesPores {
        /// `m_v q`.
        load: f64,
        /// `−ln(1 − n_0)`.
        limit: f64,
        /// Initial porosity `n_0`.
        porosity: f64,
    },
    /// A load that grows, where the solution's acts at once.
    #[error(
        "Xie & Leo's load is sudden, but this one grows over {loading_time} s: use the reference \
         `large-strain`, whose load may grow"
    )]
    LoadGrows {
        /// Time over which the load grows, s.
        loading_time: f64,
    },
    /// A load under which another soil law would end with a negative porosity.
    #[error(
        "the load would expel more water than the pores hold: the volume would shrink by \
         {shrinkage}, which must stay below the porosity {porosity}"
    )]
    PoresClose {
        /// `1 − J` at the end.
        shrinkage: f64,
        /// Initial porosity `n_0`.
        porosity: f64,
    },
    /// A law whose stresses are not known along a motion.
    #[error(
        "the stresses of the law `{law}` are not known in closed form along the motion `{motion}`: \
         `neo-hookean` works for every motion, `log-linear` for `manufactured-box`, where there is no shear"
    )]
    LawOfMotion {
        /// Name of the law.
        law: &'static str,
        /// Name of the motion.
        motion: &'static str,
    },
    /// A law that has no closed form in a column.
    #[error("the law `{law}` has no closed form in a column: it belongs to the manufactured solutions")]
    LawOfColumn {
        /// Name of the law.
        law: &'static str,
    },
    /// A motion that takes more volume than the pores have.
    #[error(
        "the motion would close the pores: the volume ratio J falls to {least} somewhere, but must stay \
         above the volume fraction {grains} of the grains; use smaller amplitudes or a larger porosity"
    )]
    MotionClosesPores {
        /// Least volume ratio.
        least: f64,
        /// `1 − n_0`.
        grains: f64,
    },
    /// A quantity of either sign that is not finite.
    #[error("the {quantity} must be finite, got {value}")]
    NotFinite {
        /// Name of the quantity.
        quantity: &'static str,
        /// Value that was given.
        value: f64,
    },
    /// A point above or below a layer.
    #[error("the point at {y} lies outside the layer, whose height is {height}")]
    OutsideLayer {
        /// Place over the base, m.
        y: f64,
        /// Height of the layer, m.
        height: f64,
    },
    /// A layer so long that its waves cannot be told from a uniform load.
    #[error("the layer's length is {ratio} times its height: too long to be solved as a wave")]
    LayerSingular {
        /// `L/H`.
        ratio: f64,
    },
    /// Fields of a problem in which only the load is unique.
    #[error("only the collapse load of a footing is unique: its fields are not, and have no exact solution")]
    NoFields,
    /// Layers that do not fill the column.
    #[error("the layers are {sum} m thick together, but the column is {height} m high: they must fill it")]
    LayersDoNotFill {
        /// Sum of the thicknesses, m.
        sum: f64,
        /// Height of the column, m.
        height: f64,
    },
    /// Layers of soil where the solution has none.
    #[error("a column of layers {0}")]
    Layers(&'static str),
    /// A drained base where the solution's is impermeable.
    #[error(
        "the base of `{0}` is impermeable: a column drained at both ends belongs to `terzaghi`, `xie-leo` and `layered`"
    )]
    Drainage(&'static str),
    /// Reloading softer than first loading.
    #[error(
        "the unloading–reloading modulus, {reload} Pa, is below the modulus of first loading, {virgin} Pa: \
         a soil is stiffer below its preconsolidation stress"
    )]
    ReloadModulus {
        /// `E₂`, Pa.
        reload: f64,
        /// `E₁`, Pa.
        virgin: f64,
    },
    /// A load that never makes the soil yield, or makes it yield at once.
    #[error(
        "no yield front advances through the column: the preconsolidation {preconsolidation} Pa must lie \
         between the initial undrained effective stress, {start} Pa, and the final one, {end} Pa"
    )]
    NoYieldFront {
        /// `σ'_pc`, Pa.
        preconsolidation: f64,
        /// `σ'_0 + q − p_0`, Pa.
        start: f64,
        /// `σ'_0 + q`, Pa.
        end: f64,
    },
    /// A Biot coefficient that no porous body has.
    #[error(
        "the Biot coefficient must lie between the porosity {porosity} and 1, got {alpha}: grains are \
         stiffer than the skeleton that they form"
    )]
    BiotCoefficient {
        /// `α`.
        alpha: f64,
        /// `n`.
        porosity: f64,
    },
    /// Grains softer than the skeleton that they make.
    #[error(
        "the bulk modulus of the grains, {grains} Pa, is below that of the drained skeleton, {bulk} Pa: \
         grains are stiffer than the skeleton that they form"
    )]
    SoftGrains {
        /// `K_s`, Pa.
        grains: f64,
        /// `K`, Pa.
        bulk: f64,
    },
    /// A time at which a series has too few terms.
    #[error(
        "the time factor {time_factor} is too early for a series of {terms} terms: ask for 0, or for a later time"
    )]
    TooEarly {
        /// Time factor.
        time_factor: f64,
        /// Terms that are known.
        terms: usize,
    },
    /// A time at which the base is felt, of a solution that is that of a half-space.
    #[error(
        "the solution is for a half-space, but at T_v = {time_factor} the base may change the pressures by \
         {bound:.1e} of the load: ask for earlier time factors"
    )]
    BaseFelt {
        /// Time factor.
        time_factor: f64,
        /// What the base may change, over the load.
        bound: f64,
    },
    /// A time at which a series is not known well enough to be worth anything.
    #[error(
        "at T_v = {time_factor} the solution may be off by {bound:.1e} of the load, which is useless: ask \
         for another time factor"
    )]
    Inaccurate {
        /// Time factor.
        time_factor: f64,
        /// What the terms left out may add, over the load.
        bound: f64,
    },
    /// The place of a source.
    #[error("the pressure at the source itself is infinite: ask for places away from it, ζ below 1")]
    AtTheSource,
    /// A numerical reference that does not settle under refinement.
    #[error(
        "the large-strain reference did not converge: two resolutions still differ by {difference} \
         of the load"
    )]
    NotConverged {
        /// Largest difference of the pressure over the load; not finite where no solution was found.
        difference: f64,
    },
}

/// Passes a positive finite `value` on, refuses any other.
pub(crate) fn positive(quantity: &'static str, value: f64) -> Result<f64, ExactError> {
    if value.is_finite() && value > 0.0 {
        Ok(value)
    } else {
        Err(ExactError::NotPositive { quantity, value })
    }
}

/// Passes a positive `value` on that has all its digits, refuses any other.
///
/// # Errors
/// [`ExactError::NotPositive`] where it is not positive, not finite, or so small that digits are lost.
pub fn normal(quantity: &'static str, value: f64) -> Result<f64, ExactError> {
    if value.is_normal() && value > 0.0 {
        Ok(value)
    } else {
        Err(ExactError::NotPositive { quantity, value })
    }
}

/// Passes a finite `time_factor ≥ 0` on, refuses any other.
pub(crate) fn checked_time_factor(time_factor: f64) -> Result<f64, ExactError> {
    if time_factor.is_finite() && time_factor >= 0.0 {
        Ok(time_factor)
    } else {
        Err(ExactError::TimeFactor(time_factor))
    }
}

/// Share of a height by which round-off may put a place of a body outside of it: a place is a sum of cells, and each
/// product of a cell's size loses half of its last bit.
const EDGE_TOLERANCE: f64 = 1e-12;

/// Passes a relative depth `0 ≤ zeta ≤ 1` on, moves a depth outside by round-off to the edge, and refuses any other.
pub(crate) fn checked_depth(zeta: f64) -> Result<f64, ExactError> {
    held_within(zeta, 1.0).ok_or(ExactError::Depth(zeta))
}

/// A place between 0 and a height; a place outside by round-off is moved to the edge, any other gives `None`.
pub(crate) fn held_within(place: f64, height: f64) -> Option<f64> {
    let tolerance = EDGE_TOLERANCE * height;
    (-tolerance..=height + tolerance).contains(&place).then(|| place.clamp(0.0, height))
}
