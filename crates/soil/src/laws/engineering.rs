//! `engineering`: the modulus `E = E_0/J` with the engineering strain that it belongs to, `dσ' = (E_oed/J) dJ`, and
//! `k = k_0 J²`: the material of Xie & Leo by another way. `E_0/J` against `dJ` is `E_0` against `dJ/J`.

use crate::law_data::LawData;
use super::log_linear::LOG_LINEAR;

/// The law `engineering`.
pub static ENGINEERING: LawData = LOG_LINEAR;
