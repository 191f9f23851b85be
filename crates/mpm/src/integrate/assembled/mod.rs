//! The step of a body with frozen shape functions, as maps between grid arrays, in any dimension.
//!
//! Where weights are frozen and the material is linear, stresses are linear in the nodal displacements
//! that strained them, and velocities mapped to the grid are all that the points' velocities are needed
//! for:
//!
//! - `F_w = F_w0 − K_p U_f`, `F_m = F_m0 − K_σ U_s − K_p U_f`: forces (docs/theory.md, Eqs 1, 2 and 8),
//! - `v⁺ = v + Δt a(F_w, F_m, v)`: nodal velocities by forward Euler,
//! - `v̄ ← φ (v̄ + Δt P a) + (1 − φ) P v⁺` with `P = M⁻¹ Nᵀ m N`: mapped velocities,
//! - `U ← U + Δt v̄`, or `v⁺` without mapping back.
//!
//! The points are visited at outputs only. The point-wise step in `explicit` is the definition; tests
//! hold the two together to round-off. `operators` takes the maps from a body, `rows` stores them and
//! `step` goes through time.

mod constraints;
mod energy;
mod operators;
mod rows;
mod state;
pub mod step;
pub mod stiffness;
